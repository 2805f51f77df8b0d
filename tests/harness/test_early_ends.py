# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Names of jobs, and what a run says and leaves that ends early or does not begin."""

import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import meshio
import pytest
from small_decks import pulled, snapping

from uel.cli import main
from uel.output import Result
from uel.paper import demo
from uel.usersub.layout import element_layouts

DECKS = Path(__file__).parents[2] / "abaqus_inputs"
SPRINGS = Path(__file__).parent / "procedures" / "springs.f"
SPRING_IN_C = Path(__file__).parent / "usersub" / "spring.c"
FLAT = DECKS / "patch_horizontal" / "flat_u2.inp"


@pytest.mark.parametrize(
    ("static", "ended", "ways"),
    [
        (
            "*STATIC\n0.1, 1., 1e-5, 0.1\n",
            r"ended after increment \d+ of step 1 \(of 1\), step time 0\.66\d+ of 1; what was written is readable",
            "--fallback, .*; --control energy, .*; a smaller largest increment .*; more attempts .*; VISCOSITY .*",
        ),
        (
            "*STATIC, DIRECT\n0.1, 1.\n",
            "ended after increment 6 .*",
            r"--fallback, .*; --control energy, .*; \*STATIC without DIRECT, which cuts increments back; VISCOSITY .*",
        ),
    ],
)
def test_run_that_ends_early_says_where_and_what_may_help(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], static: str, ended: str, ways: str
) -> None:
    deck = snapping(tmp_path, static)
    assert main(["run", str(deck), "--user", str(SPRINGS), "--quiet", "--output-dir", str(tmp_path)]) == 1
    said = capsys.readouterr().err.splitlines()
    assert re.fullmatch(f"uel: snap {ended}", said[-2])
    assert re.fullmatch(f"uel: what may help: {ways}", said[-1])


def test_last_lines_of_other_ends(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Too few increments; and a part that nothing holds, on which no force acts, in a run that completes."""
    deck = snapping(tmp_path, "*STATIC\n0.1, 1., 1e-5, 0.1\n")
    deck.write_text(deck.read_text().replace("INC=500", "INC=2"))
    words = ["run", str(deck), "--user", str(SPRINGS), "--output-dir", str(tmp_path)]
    assert main(words) == 1
    assert capsys.readouterr().err.endswith("uel: what may help: a larger INC on *STEP\n")
    deck = pulled(tmp_path)
    deck.write_text(deck.read_text().replace("*BOUNDARY\n1, 1\n2, 1, 1, 0.1\n", ""))
    assert main(["run", str(deck), "--user", str(SPRING_IN_C), "--output-dir", str(tmp_path)]) == 0
    first, _, counted, *_ = capsys.readouterr().out.splitlines()
    assert "check *BOUNDARY" in first
    assert counted == "  warnings in .dat and .msg: 1, above"


def test_run_that_does_not_begin_leaves_no_verdict_of_an_earlier_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The results that are not of this run stay."""
    deck = pulled(tmp_path)
    words = ["run", str(deck), "--user", str(SPRING_IN_C), "--quiet", "--output-dir", str(tmp_path)]
    assert main(words) == 0
    history = (tmp_path / "pulled_history.csv").read_text()
    user = tmp_path / "broken.c"
    user.write_text("int uel_(")
    assert main([*words, "--user", str(user)]) == 1
    for mistake in ("*NODDE\n1, 0.\n", ""):
        deck.write_text(mistake)
        assert main(words) == 1
        assert (tmp_path / "pulled.sta").read_text().endswith(" THE ANALYSIS HAS NOT BEEN COMPLETED\n")
        assert not Result(tmp_path / "pulled").completed
        assert Result(tmp_path / "pulled").status == []
        assert (tmp_path / "pulled.msg").read_text().startswith(" ***ERROR: ")
    assert (tmp_path / "pulled_history.csv").read_text() == history
    assert not list(tmp_path.glob("*.lck"))
    capsys.readouterr()


def test_second_run_of_a_name_in_a_folder_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The lock of a process that is gone holds nothing."""
    deck = pulled(tmp_path)
    words = ["run", str(deck), "--user", str(SPRING_IN_C), "--quiet", "--output-dir", str(tmp_path)]
    holder = "import sys; from pathlib import Path; from uel.output.lock import locked\n"
    holder += "with locked(Path(sys.argv[1])):\n print('held', flush=True)\n sys.stdin.read()"
    command = [sys.executable, "-c", holder, str(tmp_path / "pulled")]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "held\n"
        assert main(words) == 1
        said = capsys.readouterr().err
        expected = rf"uel: a job of this name runs in this folder: .*pulled.lck is held by process {process.pid} on .*"
        assert re.fullmatch(expected + r"; give another --job or --output-dir\n", said)
        assert not (tmp_path / "pulled.sta").exists()
        assert main([*words, "--job", "other"]) == 0
        process.kill()
    assert (tmp_path / "pulled.lck").exists()
    assert main(words) == 0
    assert not (tmp_path / "pulled.lck").exists()


@pytest.mark.parametrize("name", ["a/b", ".", "..", "/", ""])
def test_job_that_is_no_name(tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str) -> None:
    assert main(["run", str(pulled(tmp_path)), "--user", str(SPRING_IN_C), "--job", name]) == 2
    assert f"uel: '{name}' cannot be a job name: expected a file name without folders" in capsys.readouterr().err
    assert main(["law", "--job", name, "--output-dir", str(tmp_path)]) == 2
    assert f"uel: '{name}' cannot be a job name" in capsys.readouterr().err


def test_names_outside_ascii(tmp_path: Path) -> None:
    folder = tmp_path / "Prüfung \n'1'"
    assert (
        main(["run", str(pulled(tmp_path)), "--user", str(SPRING_IN_C), "--job", "zäh", f"--output-dir={folder}"]) == 0
    )
    assert Result(folder / "zäh").completed


def test_failed_job_keeps_its_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = FLAT.read_text().replace("30., 60., 0.26", "-30., 60., 0.26")
    for path in FLAT.parent.glob("flat_*.inp"):
        (tmp_path / path.name).write_text(path.read_text())
    deck = tmp_path / "negative.inp"
    deck.write_text(text)
    assert main(["run", str(deck), "--output-dir", str(tmp_path)]) == 1
    assert "SIGMAMAX" in capsys.readouterr().err
    assert "THE ANALYSIS HAS NOT BEEN COMPLETED" in (tmp_path / "negative.sta").read_text()
    assert "SIGMAMAX" in (tmp_path / "negative.msg").read_text()


@pytest.mark.sample(2)
@pytest.mark.parametrize("after", [0.0, 0.4])
def test_killed_run_leaves_readable_files(tmp_path: Path, after: float) -> None:
    """kill -9 in the middle of a run: every file reads, up to the last increment of the status file.

    The deck takes twenty times the increments, so that no run ends while this process waits for its turn.
    """
    deck = tmp_path / "dcb_u4_1e8.inp"
    for part in (DECKS / "dcb").glob("dcb_*.inp"):
        shutil.copy(part, tmp_path)
    text = deck.read_text()
    slow = text.replace("0.01, 1., 1e-07, 0.01\n", "0.0005, 1., 1e-07, 0.0005\n")
    assert slow != text
    deck.write_text(slow)
    command = [sys.executable, "-m", "uel.cli", "run", str(deck), "--output-dir", str(tmp_path), "--quiet"]
    process = subprocess.Popen(command)
    status = tmp_path / "dcb_u4_1e8.sta"
    started = time.monotonic()
    while not (status.exists() and len(status.read_text().splitlines()) > 18):
        assert process.poll() is None, "the run ended before it could be killed"
        assert time.monotonic() - started < 600
        time.sleep(0.01)
    time.sleep(after)
    process.send_signal(signal.SIGKILL)
    process.wait()

    result = Result(tmp_path / "dcb_u4_1e8")
    last = [row.increment for row in result.status if not row.cutback][-1]
    assert last >= 10
    assert not result.completed
    assert list(result.history["increment"][:last]) == list(range(1, last + 1))
    assert result.frames
    for frame in result.frames:
        mesh = meshio.read(frame.path)
        assert len(mesh.points)
    assert (tmp_path / "dcb_u4_1e8.msg").read_text().count("INCREMENT") >= last
    assert len(result.interface())


def test_demo_that_cannot_write_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").touch()
    assert demo.main(["--output-dir", str(tmp_path / "file")]) == 1
    assert capsys.readouterr().err == f"uel: {tmp_path}/file: File exists\n"


@pytest.mark.parametrize(
    ("old", "new", "note"),
    [
        (
            "",
            "",
            "no --user was given, so U1 is that of this project: continuum quad, .*4 nodes in the plane",
        ),
        ("U1", "U99", "no --user was given: name the file that has U99; this project itself has U1, U2, .*U2015$"),
    ],
)
def test_user_element_without_a_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, note: str
) -> None:
    """The deck's own U1 is a spring; without a file it would be the quad of the project, whose message tells little."""
    deck = pulled(tmp_path)
    deck.write_text(deck.read_text().replace(old, new) if old else deck.read_text())
    assert main(["run", str(deck), "--quiet", "--output-dir", str(tmp_path)]) == 1
    assert re.search(f"(?m)^uel: {note}", capsys.readouterr().err)
    # with a file nothing is said about that
    if not old:
        assert main(["run", str(deck), "--user", str(SPRINGS), "--quiet", "--output-dir", str(tmp_path)]) == 0
        assert "--user" not in capsys.readouterr().err


@pytest.mark.parametrize("number", sorted(element_layouts()))
def test_user_element_of_other_nodes_and_properties(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], number: int
) -> None:
    """The deck's own element has three nodes and one property; no element of the project has both."""
    layout = element_layouts()[number]
    deck = tmp_path / "other.inp"
    deck.write_text(f"""*NODE
1, 0., 0.
2, 1., 0.
3, 0., 1.
*USER ELEMENT, TYPE=U{number}, NODES=3, COORDINATES={layout.dimension}, PROPERTIES=1, VARIABLES=1
1, 2
*ELEMENT, TYPE=U{number}, ELSET=ALL
1, 1, 2, 3
*UEL PROPERTY, ELSET=ALL
1.
*STEP
*STATIC
1., 1.
*BOUNDARY
1, 1, 2
*END STEP
""")
    assert main(["run", str(deck), "--quiet", "--output-dir", str(tmp_path)]) == 1
    said = capsys.readouterr().err
    expected = f"U{number} element 1: (\\*USER ELEMENT has (NODES = 3|PROPERTIES = 1): expected|takes its stress from)"
    assert re.search(expected, said), said


@pytest.mark.parametrize("name", ["pulled", "my.job"])
def test_deck_by_the_name_of_its_job(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    pulled(tmp_path).rename(tmp_path / f"{name}.inp")
    monkeypatch.chdir(tmp_path)
    assert main(["run", name, "--user", str(SPRINGS)]) == 0
    assert Path(f"{name}.sta").exists()
    # a file of this very name counts first, and a missing one is called as it was given
    Path(name).write_text("*NODDE\n")
    assert main(["run", name]) == 1
    assert "unknown keyword *NODDE" in capsys.readouterr().err
    assert main(["run", "nope"]) == 1
    assert "uel: nope: cannot read the file: No such file or directory\n" in capsys.readouterr().err


def test_dat_counts_the_warnings_of_both_files(tmp_path: Path) -> None:
    """A part that nothing holds, on which no force acts: a singular matrix, of which .msg warns."""
    deck = pulled(tmp_path)
    deck.write_text(deck.read_text().replace("*BOUNDARY\n1, 1\n2, 1, 1, 0.1\n", ""))
    assert main(["run", str(deck), "--user", str(SPRINGS), "--quiet", "--output-dir", str(tmp_path)]) == 0
    counts = [(tmp_path / f"pulled{ending}").read_text().count("***WARNING") for ending in (".dat", ".msg")]
    assert counts[1] > 0
    printed = " ".join((tmp_path / "pulled.dat").read_text().split())
    assert f"WITH {counts[0]} WARNING MESSAGES ON THE DAT FILE AND {counts[1]} WARNING MESSAGES ON THE MSG" in printed
