# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a run says of itself at its end: `uel run`, and what is read from the files later."""

import re
from pathlib import Path

import pytest
from small_decks import pulled, snapping

from uel.cli import main
from uel.output import Result
from uel.output.outcome import duration, ending

FOLDER = Path(__file__).parents[1]
SPRINGS = FOLDER / "procedures" / "springs.f"
SPRING_IN_C = FOLDER / "usersub" / "spring.c"


def exit_code(deck: Path, user: Path) -> int:
    return main(["run", str(deck), "--user", str(user), "--output-dir", str(deck.parent)])


def test_completed_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A spring of stiffness 1: the force is the displacement."""
    deck = pulled(tmp_path)
    text = deck.read_text().replace("*END STEP", "*OUTPUT, HISTORY\n*NODE OUTPUT\nU, RF\n*END STEP")
    deck.write_text(text)
    assert exit_code(deck, SPRING_IN_C) == 0
    how, load, files = capsys.readouterr().out.splitlines()
    assert re.fullmatch(r"pulled: completed, total time 1: 1 increment, 1 iteration, 0 cutbacks in .*", how)
    assert load == "  largest load: RF1[2] = 0.1 at U1[2] = 0.1, in the last increment"
    assert files == f"  written: {tmp_path}/pulled.sta .msg .dat _history.csv"


def test_warnings_of_both_files_are_counted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A boundary condition without effect, output that does not exist, a part that nothing holds."""
    deck = pulled(tmp_path)
    text = deck.read_text().replace("1, 1\n2, 1, 1, 0.1\n", "1, 2\n")
    requests = "*OUTPUT, HISTORY\n*NODE OUTPUT\nUU, U\n*NODE PRINT\nVOLT\n*END STEP"
    deck.write_text(text.replace("*END STEP", requests))
    assert exit_code(deck, SPRING_IN_C) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[:2] == [
        "warning: HISTORY OUTPUT OF UU of all nodes IS NOT AVAILABLE AND IS LEFT OUT",
        "warning: *NODE PRINT: VOLT IS NOT AVAILABLE AND IS LEFT OUT",
    ]
    assert f"{deck}:14: *BOUNDARY has no effect: no element uses dof 2 of node 1" in said[2]
    assert said[5] == "  warnings in .dat and .msg: 4, above"
    result = Result(tmp_path / "pulled")
    assert len(result.warnings) == 4
    assert [f"warning: {text}" for text in result.warnings[:2]] == said[:2]
    assert "check *BOUNDARY" in said[3]
    assert "check *BOUNDARY" in result.warnings[3]
    assert ending(result)[-1] == said[-1]


def test_run_that_ends_early(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A spring of stiffness 10 that fails at 0.1, thus at a force of 1, in series with one of 0.5: at 0.1 + 1/0.5."""
    assert exit_code(snapping(tmp_path, "*STATIC\n0.1, 1., 1e-5, 0.1\n"), SPRINGS) == 1
    error, unbalanced, how, ended, _ = capsys.readouterr().err.splitlines()
    assert "TOO MANY ATTEMPTS" in error
    assert re.fullmatch(r"uel: last iteration: largest (correction|residual force) \S+ at node \d, dof 1", unbalanced)
    load = r"largest load: RF1\[END\] = (\S+) at U1\[END\] = (\S+), in the last increment"
    found = re.fullmatch(rf"uel: \d+ increments, \d+ iterations, \d+ cutbacks; {load}", how)
    assert found is not None
    assert [float(number) for number in found.groups()] == pytest.approx([1.0, 2.1], rel=2e-3)
    assert ended.startswith("uel: snap ended after increment")


def test_way_out_of_too_many_attempts(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The smallest increment is named only where it was the limit."""
    assert exit_code(snapping(tmp_path, "*STATIC\n0.1, 1., 1e-5, 0.1\n"), SPRINGS) == 1
    assert "; a smaller largest increment (fourth number below *STATIC), which" in capsys.readouterr().err
    assert exit_code(snapping(tmp_path, "*STATIC\n0.1, 1., 1e-2, 0.1\n"), SPRINGS) == 1
    said = capsys.readouterr().err
    assert "TIME INCREMENT REQUIRED IS LESS THAN THE MINIMUM" in said
    assert "; a smaller minimum increment (third number below *STATIC); " in said


def test_first_of_many_warnings(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck = pulled(tmp_path)
    names = "\n".join(f"VOLT{k}" for k in range(9))
    deck.write_text(deck.read_text().replace("*END STEP", f"*NODE PRINT\n{names}\n*END STEP"))
    assert exit_code(deck, SPRING_IN_C) == 0
    said = capsys.readouterr().out
    assert said.count("warning: *NODE PRINT: VOLT") == 5
    assert "  warnings in .dat and .msg: 9, the first 5 above\n" in said


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (0.02, "less than 0.1 s"),
        (2.04, "2.0 s"),
        (59.4, "59 s"),
        (59.6, "1 min 0 s"),
        (3599.6, "1 h 0 min"),
        (7260.0, "2 h 1 min"),
    ],
)
def test_duration(seconds: float, text: str) -> None:
    assert duration(seconds) == text
