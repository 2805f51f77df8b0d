# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The command: exit codes, messages without tracebacks, Abaqus' spelling, and what a killed run leaves."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from small_decks import pulled, snapping

import uel
from uel.cli import main
from uel.errors import UsageError
from uel.output import Result

DECKS = Path(__file__).parents[2] / "abaqus_inputs"
SPRINGS = Path(__file__).parent / "procedures" / "springs.f"
SPRING_IN_C = Path(__file__).parent / "usersub" / "spring.c"
FLAT = DECKS / "patch_horizontal" / "flat_u2.inp"


def test_run_writes_the_files_and_returns_zero(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(FLAT), "--output-dir", str(tmp_path)]) == 0
    assert "flat_u2: completed" in capsys.readouterr().out
    names = {path.name for path in tmp_path.iterdir()}
    expected = {"flat_u2.sta", "flat_u2.msg", "flat_u2.dat", "flat_u2_history.csv", "flat_u2_interface.csv"}
    assert names == expected | {"flat_u2.pvd", "flat_u2_vtu"}


def test_fallback_finishes_a_run_that_fails_without_it(tmp_path: Path) -> None:
    """A spring in series with one that fails at once: a snap, which Newton's method does not pass."""
    deck = snapping(tmp_path, "*STATIC\n0.1, 1., 1e-5, 0.1\n")
    words = ["run", str(deck), "--user", str(SPRINGS), "--quiet", "--output-dir", str(tmp_path)]
    assert main(words) == 1
    assert main([*words, "--fallback"]) == 0
    message = (tmp_path / "snap.msg").read_text()
    assert "EQUILIBRIUM FOUND WITH THE DESCENT SEARCH" in message
    assert "1  INCREMENTS THAT NEEDED THE DESCENT SEARCH" in message


def test_energy_control_traces_the_snap_back(tmp_path: Path) -> None:
    deck = snapping(tmp_path, "*STATIC\n0.05, 1., 1e-5, 0.05\n")
    words = ["run", str(deck), "--user", str(SPRINGS), "--quiet", "--output-dir", str(tmp_path)]
    assert main([*words, "--control", "energy"]) == 0
    assert "ENERGY CONTROL" in (tmp_path / "snap.msg").read_text()
    history = Result(tmp_path / "snap").history
    assert history["LPF"][-1] == 1.0
    assert (np.diff(history["LPF"]) < 0).any()
    assert (np.diff(history["time"]) > 0).all()


def test_fallback_and_energy_control_exclude_each_other(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["run", str(FLAT), "--fallback", "--control", "energy"])
    assert "not allowed with argument --fallback" in capsys.readouterr().err
    with pytest.raises(UsageError, match="fallback keeps the load, which energy_control looks for: expected one of"):
        uel.SolverOptions(fallback=True, energy_control=True)


def test_riks_in_all_files(tmp_path: Path) -> None:
    """A shallow truss under twice its limit load: the load factor falls and rises again."""
    deck = tmp_path / "snap.inp"
    deck.write_text(
        "*NODE\n1, 0.\n2, 1.\n*USER ELEMENT, TYPE=U7, NODES=2, COORDINATES=1, PROPERTIES=2, I PROPERTIES=1\n1\n"
        "*ELEMENT, TYPE=U7, ELSET=TRUSS\n1, 1, 2\n*UEL PROPERTY, ELSET=TRUSS\n1., 1., 0\n"
        "*STEP, INC=50\n*STATIC, RIKS\n0.05, 1., 1e-5, 0.1, 0.8\n*BOUNDARY\n1, 1\n*CLOAD\n2, 1, 0.77\n*END STEP\n"
    )
    assert main(["run", str(deck), "--user", str(SPRINGS), "--quiet", "--output-dir", str(tmp_path)]) == 0
    result = Result(tmp_path / "snap")
    factor = result.history["LPF"]
    assert factor[-1] >= 0.8
    assert factor.min() < 0.0 < factor[0]
    assert all(row.riks for row in result.status)
    assert [row.step_time for row in result.status if not row.cutback] == pytest.approx(factor, rel=5e-3)
    message = (tmp_path / "snap.msg").read_text()
    assert "AUTOMATIC ARC LENGTH CONTROL (RIKS METHOD)" in message
    assert "ARC LENGTH INCREMENT" in message
    assert "LOAD PROPORTIONALITY FACTOR" in message


def test_quiet_prints_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(FLAT), "--output-dir", str(tmp_path), "--quiet"]) == 0
    assert capsys.readouterr() == ("", "")


HALF_SET = """\
      include '{folder}/uel.inc'
      real zero(4)
      zero = 0.
      call clear(rhs, zero)
      amatrx = 0d0
      amatrx(1,1) = 1d0
      amatrx(2,2) = 1d0
      end
      subroutine clear(r, z)
      real r(4), z(4)
      r = z
      end
"""
HALF_SET_DECK = """\
*NODE
1, 0.
2, 1.
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1, VARIABLES=2
1, 2
*ELEMENT, TYPE=U1, ELSET=ALL
1, 1, 2
*UEL PROPERTY, ELSET=ALL
1.
*STEP
*STATIC, DIRECT
1., 1.
*BOUNDARY
1, 1, 2
2, 1, {last}
*END STEP
"""


@pytest.mark.nan
def test_warnings_are_told_at_the_end(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """With what the run ends by: a deck with a property too much, an element with REAL for REAL*8."""
    deck, user = tmp_path / "half.inp", tmp_path / "half.f"
    user.write_text(HALF_SET.format(folder=Path(__file__).parent))
    words = ["run", str(deck), "--user", str(user), "--output-dir", str(tmp_path)]
    deck.write_text(HALF_SET_DECK.format(last=2))
    assert main(words) == 0
    *warnings, completed, counted, _ = capsys.readouterr().out.splitlines()
    assert re.fullmatch(r"half: completed, total time 1: 1 increment, 1 iteration, 0 cutbacks in .*\d s", completed)
    assert counted == "  warnings in .dat and .msg: 2, above"
    assert [line.startswith("warning: ") for line in warnings] == [True, True]
    deck.write_text(HALF_SET_DECK.format(last=1))
    assert main(words) == 1
    first, second, third, last = capsys.readouterr().err.splitlines()
    assert "singular system matrix at node 2, dof 2" in first
    assert re.fullmatch(r"uel: earlier warning: .*half.inp:8: .* 1 values where U1 takes 0 .*", second)
    assert re.match("uel: earlier warning: element 1 .type U1.: RHS.3. was not filled, .*REAL .four bytes.", third)
    assert last == "uel: half ended before its first increment was complete; what was written is readable"


READS_OUTSIDE = """\
      include '{folder}/uel.inc'
      amatrx = 0d0
      do i = 1, ndofel
        rhs(i,1) = -u(i)*(1 + svars(3)){more}
        amatrx(i,i) = 1d0
      end do
      end
"""


@pytest.mark.nan
def test_run_goes_on_where_an_element_reads_outside_its_arrays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """With zeros there, and a warning that names the array; NaN of the element's own ends the run."""
    deck, user = tmp_path / "beyond.inp", tmp_path / "beyond.f"
    deck.write_text(HALF_SET_DECK.format(last=2).replace("ALL\n1.\n", "ALL\n"))
    words = ["run", str(deck), "--user", str(user), "--output-dir", str(tmp_path)]
    user.write_text(READS_OUTSIDE.format(folder=Path(__file__).parent, more=""))
    for _ in range(2):
        assert main(words) == 0
        assert "RHS(1) is NaN or infinite" in " ".join((tmp_path / "beyond.msg").read_text().split())
        assert "it reads outside SVARS, see uel check" in " ".join((tmp_path / "beyond.msg").read_text().split())
    user.write_text(READS_OUTSIDE.format(folder=Path(__file__).parent, more=" + sqrt(-1d0 - u(i)**2)"))
    assert main(words) == 1
    assert re.fullmatch(r"uel: element 1 .*: RHS\(1\) is NaN or infinite \(.*\)\n(uel: .*\n)+", capsys.readouterr().err)


def test_spelling_of_abaqus(tmp_path: Path) -> None:
    words = ["run", "job=pressed", f"input={FLAT}", "cpus=2", "interactive", "--quiet", f"--output-dir={tmp_path}"]
    assert main(words) == 0
    assert (tmp_path / "pressed.sta").exists()


@pytest.mark.parametrize("option", [("--user", "{}"), ("user={}",)])
def test_several_user_files(tmp_path: Path, option: tuple[str, ...]) -> None:
    database = tmp_path / "database.f90"
    database.write_text(
        "subroutine uexternaldb(lop)\n  if (lop == 3) call stdb_abqerr(1, 'at the end', (/0/), (/0d0/), (/' '/))\nend\n"
    )
    deck = pulled(tmp_path)
    files = [word.format(file) for file in (SPRING_IN_C, database) for word in option]
    assert main(["run", str(deck), *files, "--quiet", f"--output-dir={tmp_path}"]) == 0
    assert "at the end" in (tmp_path / "pulled.msg").read_text()


def test_parameter(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """In place of the deck's own value, in both spellings of the command, and named in .dat."""
    deck = pulled(tmp_path)
    output = "*OUTPUT, HISTORY\n*NODE OUTPUT\nRF1\n*END STEP"
    text = deck.read_text().replace("*END STEP", output).replace("1, 1, 0.1", "1, 1, <pull>")
    deck.write_text(f"*PARAMETER\npull = 0.1\n{text}")
    words = [f"--user={SPRING_IN_C}", "--quiet", f"--output-dir={tmp_path}"]
    for spelling in (str(deck), f"input={deck}"):
        assert main(["run", spelling, "--parameter", "pull=-3e-1", *words]) == 0
        assert Result(tmp_path / "pulled").history["RF1[2]"] == pytest.approx([-0.3])
        printed = " ".join((tmp_path / "pulled.dat").read_text().split())
        assert "PARAMETERS GIVEN IN PLACE OF THE VALUES IN THE DECK: pull = -0.3" in printed
    assert main(["run", str(deck), "--parameter", "push=1", *words]) == 2
    assert "uel: --parameter push: " in capsys.readouterr().err


@pytest.mark.parametrize("wrong", ["pull", "pull=", "pull=far", "pull=nan", "pull=1_0"])
def test_parameter_without_a_number(wrong: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["run", str(FLAT), "--parameter", wrong])
    assert f"argument --parameter: expected NAME=VALUE with a number, found '{wrong}'" in capsys.readouterr().err


def test_unknown_option_of_abaqus(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(["run", "job=a", "globalmodel=b"])
    assert stop.value.code == 2
    assert "unknown option 'globalmodel='" in capsys.readouterr().err


def test_folder_with_an_equals_sign_is_no_option(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck = tmp_path / "k=1" / "deck.inp"
    assert main(["run", str(deck)]) == 1
    assert f"{deck}: cannot read the file: No such file" in " ".join(capsys.readouterr().err.split())


def test_deck_error_is_one_line_with_its_place(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck = tmp_path / "bad.inp"
    deck.write_text("*HEADING\nbad\n*NODDE\n1, 0., 0.\n")
    assert main(["run", str(deck)]) == 1
    error = capsys.readouterr().err
    assert error.startswith(f"uel: {deck}:3: unknown keyword *NODDE")
    assert "Traceback" not in error


def test_body_that_is_not_held_names_step_node_and_dof(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck = tmp_path / "free.inp"
    deck.write_text(
        "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n*ELEMENT, TYPE=CPS4, ELSET=ALL\n1, 1, 2, 3, 4\n"
        "*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL\n1.\n*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n"
        "*STEP\n*STATIC\n1., 1.\n*CLOAD\n3, 2, 1.\n*END STEP\n"
    )
    assert main(["run", str(deck), "--output-dir", str(tmp_path)]) == 1
    assert f"{deck}:13: singular system matrix at node" in capsys.readouterr().err


def test_message_file_names_the_linear_solver(tmp_path: Path) -> None:
    assert main(["run", str(FLAT), "--output-dir", str(tmp_path), "--quiet"]) == 0
    message = (tmp_path / "flat_u2.msg").read_text()
    assert "LINEAR SOLVER BAND: half bandwidth" in message
    assert re.search(r"LINEAR SOLVER: \d+ FACTORISATIONS, \d+ ONLY WHERE", message)


def test_no_memory(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def exhausted(*_: object, **__: object) -> None:
        raise MemoryError

    monkeypatch.setattr("uel.running.job.run", exhausted)
    assert main(["run", str(FLAT)]) == 1
    assert "uel: not enough memory for this model" in capsys.readouterr().err


def test_missing_deck(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(tmp_path / "nothing.inp")]) == 1
    assert "nothing.inp" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("law --increments 0", "--increments: expected a whole number of 1 or more, found '0'"),
        ("law --increments=-5", "--increments: expected a whole number of 1 or more, found '-5'"),
        ("law --increments nan", "--increments: expected a whole number of 1 or more, found 'nan'"),
        ("law --unload 2 -1", "--unload/-u: expected a number from 0 to 1, found '2'"),
        ("law --unload nan", "--unload/-u: expected a number from 0 to 1, found 'nan'"),
        ("law --angles inf", "--angles/-a: expected a number, found 'inf'"),
        ("law --reach 0", "--reach: expected a number above 0, found '0'"),
        ("law --close=-inf", "--close: expected a number of 0 or more, found '-inf'"),
        ("law --duration a", "--duration: expected a number above 0, found 'a'"),
        ("run a.inp --call-limit nan", "--call-limit: expected a number of 0 or more, found 'nan'"),
        ("run a.inp --call-limit inf", "--call-limit: expected a number of 0 or more, found 'inf'"),
        ("run a.inp --call-limit=-1", "--call-limit: expected a number of 0 or more, found '-1'"),
        ("run a.inp --call-limit=--", "--call-limit: expected one argument, found '--'"),
        ("run a.inp --user=--", "--user: expected one argument, found '--'"),
        ("check a.inp --seed 0", "--seed: expected a whole number of 1 or more, found '0'"),
        ("check a.inp --seed 99999999999999", "--seed: expected a whole number of 1 or more, found '99999999999999'"),
        ("check a.inp --increments 1.5", "--increments: expected a whole number of 1 or more, found '1.5'"),
    ],
)
def test_numbers_that_make_no_sense(words: str, expected: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(words.split())
    assert stop.value.code == 2
    assert expected in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("law GIC=much", "'GIC=much': 'MUCH' is not a finite number"),
        ("law GIC=nan", "'GIC=nan': 'NAN' is not a finite number"),
        ("law LAW=1e400", "'LAW=1e400': '1E400' is not a finite number"),
        ("law LAW=1.5", "'LAW=1.5': '1.5' is not a whole number below 2147483648"),
        ("law LAW=99999999999999999999", "is not a whole number below 2147483648"),
        ("new 1st", "'1st' cannot be the name of an element"),
        ("check a.inp --skip tangents", "unknown check 'tangents'"),
    ],
)
def test_words_that_are_not_known(
    words: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Wrong usage, with the exit code of an option that is not known."""
    monkeypatch.chdir(tmp_path)
    assert main(words.split()) == 2
    assert message in capsys.readouterr().err


@pytest.mark.parametrize("name", ["SIGMAMAX", "TAUMAX", "GIC", "GIIC"])
def test_law_without_a_strength(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["law", f"{name}=0", "--output-dir", str(tmp_path)]) == 1
    assert f"uel: {name} = 0: expected a number above 0, which determines the reach" in capsys.readouterr().err


def test_solver_that_is_not_known(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["run", str(FLAT), "--solver", "lapack", "--quiet", "--output-dir", str(tmp_path)]
    assert main(words) == 2
    assert "unknown linear solver 'lapack'; expected one of auto" in capsys.readouterr().err


@pytest.mark.parametrize("path", ["nan,1", "inf,0", "1", "1,2,3", "a,b", ""])
def test_path_that_is_none(path: str, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main(["law", "--path", path, "--output-dir", str(tmp_path)]) == 2
    assert f"uel: '{path}': expected points NORMAL,TANGENTIAL with blanks between them" in capsys.readouterr().err


def test_command_loads_little_before_it_can_be_interrupted() -> None:
    """An interrupt in the imports would show a traceback."""
    program = (
        "import sys, uel.cli, uel.running.worker; uel.cli.build_parser();"
        "print([m for m in ('numpy', 'scipy', 'rich', 'shtab', 'uel.doctor') if m in sys.modules])"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert result.stdout == "[]\n"


def test_package_loads_nothing_before_interrupts_are_taken() -> None:
    """`uel.__main__` lets them end the process, but `uel` comes first."""
    program = "import sys; before = set(sys.modules); import uel; print(sorted(set(sys.modules) - before))"
    # an editable installation has a finder that loads more
    result = subprocess.run(
        [sys.executable, "-S", "-c", program],
        capture_output=True,
        text=True,
        check=True,
        cwd=Path(__file__).parents[2] / "harness",
    )
    assert result.stdout == "['uel']\n"


@pytest.mark.parametrize("late", [False, True], ids=["within an import", "elsewhere"])
def test_interrupt_within_an_import_ends_the_process(tmp_path: Path, late: bool) -> None:
    """There it would come out as any error, or with a traceback of Python's own."""
    (tmp_path / "slow.py").write_text(
        "import os, signal\n"
        "def interrupt(): os.kill(os.getpid(), signal.SIGINT); sum(range(1000))\n"
        "class Odd:\n"
        "    def __set_name__(self, owner, name):\n"
        f"        {'pass' if late else 'interrupt()'}\n"
        "class Owner: odd = Odd()\n"
    )
    program = (
        "import sys; from uel.interrupts import take_interrupts; take_interrupts()\n"
        "try:\n    import slow; slow.interrupt()\n"
        "except KeyboardInterrupt: print('caught', flush=True); sys.exit(3)\n"
    )
    command = [sys.executable, "-c", program]
    result = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    if late:
        assert (result.returncode, result.stdout) == (3, "caught\n")
    else:
        assert (result.returncode, result.stdout, result.stderr) == (1, "", "uel: interrupted\n")


def test_solvers(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["solvers"]) == 0
    printed = capsys.readouterr().out
    assert "band" in printed
    assert "superlu" in printed.lower()
    assert "CPU times in ms" in printed


def test_amalgamate(tmp_path: Path) -> None:
    target = tmp_path / "kernels.for"
    assert main(["amalgamate", "-o", str(target)]) == 0
    text = target.read_text().lower()
    assert "subroutine uel(" in text
    assert "subroutine uelmat(" in text


def test_amalgamate_into_a_missing_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["amalgamate", "-o", str(tmp_path / "no" / "kernels.for")]) == 1
    assert "No such file or directory" in capsys.readouterr().err
