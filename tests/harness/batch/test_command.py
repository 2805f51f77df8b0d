# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel batch`: what runs, what is kept and repeated, parts, the table, messages and exit codes."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from batch_decks import CRASHES, MESH, PULLED, SPRING

from uel.batch import command
from uel.batch.command import cores
from uel.cli import main
from uel.output.lock import locked

Results = Callable[[], list[dict[str, str]]]
UEL = [sys.executable, "-m", "uel", "batch"]


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Names of the runs that a batch of this process starts."""
    names: list[str] = []
    supervise = command.supervise

    def noted(words: list[str], stem: Path, *limits: float, **how: object) -> int:
        names.append(stem.name)
        return supervise(words, stem, *limits, **how)  # type: ignore[arg-type]

    monkeypatch.setattr(command, "supervise", noted)
    return names


def batch(*words: str) -> int:
    return main(["batch", *words])


def test_table_of_values(
    pulled: Path, results: Results, started: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    """The force on a spring of stiffness 1 is its elongation; a second batch runs what is new or has changed."""
    words = [str(pulled), "--table", "values.csv", "--user", str(SPRING)]
    Path("values.csv").write_text("job,pull\nsoft,0.25\nhard,-4\n")
    assert batch(*words) == 0
    assert capsys.readouterr() == ("batch/results.csv: 2 of 2 runs have completed\n", "")
    soft, hard = results()
    assert list(soft) == [
        *("job", "deck", "pull", "status", "reason", "increments", "iterations", "cutbacks", "processor time (s)"),
        *("files", "max U1[END]", "min U1[END]", "last U1[END]", "max RF1[END]", "min RF1[END]", "last RF1[END]"),
    ]
    assert [
        soft[name] for name in ("job", "deck", "pull", "status", "reason", "increments", "iterations", "cutbacks")
    ] == [
        *("soft", "pulled.inp", "0.25", "completed", "", "1", "1", "0"),
    ]
    assert float(soft["processor time (s)"]) > 0.0
    assert [float(row["last RF1[END]"]) for row in (soft, hard)] == pytest.approx([0.25, -4.0])
    assert soft["files"] == "soft/soft"
    assert Path("batch", f"{hard['files']}.sta").exists()
    assert "PARAMETERS GIVEN" in Path("batch/soft/soft.dat").read_text()
    assert sorted(started) == ["hard", "soft"]
    started.clear()
    Path("values.csv").write_text("job,pull\nnew,1\nsoft,0.5\nhard,-4\n")
    assert batch(*words, "--quiet") == 0
    assert capsys.readouterr() == ("", "")
    assert sorted(started) == ["new", "soft"]
    assert [float(row["last RF1[END]"]) for row in results()] == pytest.approx([1.0, 0.5, -4.0])


def test_folder(pulled: Path, results: Results, started: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    """A deck with a mistake does not end the others; it is repeated, unless nothing has changed and --keep-failed."""
    Path("wrong.inp").write_text("*HEADING\nwrong\n*NODDE\n1, 0.\n")
    Path("long.inp").write_text(
        PULLED.replace("1., 1.\n", "0.5, 1., 0.5, 0.5\n").replace("STEP\n*ST", "STEP, INC=1\n*ST")
    )
    words = [".", "--user", str(SPRING), "-o", "batch"]
    assert batch(*words) == 1
    said, errors = capsys.readouterr()
    assert said == "batch/results.csv: 1 of 3 runs have completed\n"
    first, second = errors.splitlines()
    assert re.fullmatch(r"uel: long: ended early: TOO MANY INCREMENTS NEEDED .* \(step 1, INC=1\)", first), first
    assert second.startswith("uel: wrong: failed: wrong.inp:3: unknown keyword *NODDE")
    early, good, wrong = results()
    assert (early["status"], early["increments"], float(early["max U1[END]"])) == (
        "ended early",
        "1",
        pytest.approx(0.05),
    )
    assert (good["status"], float(good["max RF1[END]"])) == ("completed", pytest.approx(0.1))
    assert (wrong["status"], wrong["increments"], wrong["max RF1[END]"]) == ("failed", "0", "")
    assert wrong["reason"].startswith("wrong.inp:3: unknown keyword *NODDE")
    assert sorted(started) == ["long", "pulled", "wrong"]
    started.clear()
    assert batch(*words, "--keep-failed") == 1
    assert started == []
    Path("wrong.inp").write_text(PULLED)
    assert batch(*words, "--keep-failed") == 1
    assert started == ["wrong"]
    assert batch(*words) == 1
    assert started == ["wrong", "long"]
    capsys.readouterr()


def test_runs_that_crash_do_not_end_the_others(
    crashing: Path, results: Results, capsys: pytest.CaptureFixture[str]
) -> None:
    """A segmentation fault, an endless loop, the Fortran library, XIT; and one that completes."""
    Path("ways.csv").write_text("way\n1\n4\n6\n9\n0\n")
    assert batch(str(crashing), "--table", "ways.csv", "--user", str(CRASHES), "--call-limit", "2") == 1
    rows = results()
    assert [row["status"] for row in rows] == [*["ended early"] * 4, "completed"]
    assert [row["increments"] for row in rows] == [*["1"] * 4, "4"]
    place = r"element 7 \(type U1\): stopped the analysis"
    for row, reason in zip(
        rows,
        (
            place + ".*segmentation fault: it reads or writes an invalid address",
            place + r".*the call did not return within 2 s, the limit for one call \(--call-limit\)",
            "the run was ended by the Fortran library, in an input or output statement of a user routine",
            place + r" \(XIT\)",
            "$",
        ),
        strict=True,
    ):
        assert re.match(reason, row["reason"]), row["reason"]
    *errors, last = capsys.readouterr().err.splitlines()
    assert len(errors) == 3
    assert last == "uel: and 1 more, see batch/results.csv"
    assert rows[2]["processor time (s)"] == ""
    assert "segmentation fault" in Path("batch/crash-1/crash-1.log").read_text()


@pytest.mark.long
def test_options_of_runs(pulled: Path, started: list[str]) -> None:
    """They reach the run, and other options are another run."""
    words = [str(pulled), "--user", str(SPRING), "--quiet"]
    assert batch(*words, "--fallback", "--solver", "superlu") == 0
    message = Path("batch/pulled/pulled.msg").read_text()
    assert "LINEAR SOLVER SUPERLU" in message
    assert batch(*words, "--solver=superlu", "--fallback", "--call-limit=9") == 0
    assert started == ["pulled"]
    assert batch(*words, "--linear", "U1") == 0
    assert batch(*words, "--linear", "U9") == 1
    assert started == ["pulled"] * 3
    entry = json.loads(Path("batch/pulled/pulled.json").read_text())["pulled"]["row"]
    assert entry["reason"] == "--linear U9: the deck has no elements of this type; its user elements are U1"


def test_user_file_is_compiled_once_and_first(
    pulled: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    started: list[str],
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    user = tmp_path / "user.c"
    user.write_text("int uel_(")
    Path("values.csv").write_text("pull\n1\n2\n3\n4\n")
    words = [str(pulled), "--table", "values.csv", "--user", str(user), "--cpus", "4"]
    assert batch(*words) == 1
    assert re.match(r"uel: .*user\.c: ", capsys.readouterr().err)
    assert started == []
    assert not Path("batch").exists()
    user.write_text(SPRING.read_text())
    assert batch(*words) == 0
    # a second compilation would have another name: a library contains its folder
    assert len(list((tmp_path / "cache").rglob("*.so"))) == 1


def test_parts(pulled: Path, results: Results, capsys: pytest.CaptureFixture[str]) -> None:
    """Two at once write one table, which has the runs of both whichever ends last."""
    words = [str(pulled), "--table", "values.csv", "--user", str(SPRING)]
    Path("values.csv").write_text("pull\n1\n2\n3\n")
    assert batch(*words, "--collect") == 1
    assert [row["status"] for row in results()] == ["not run"] * 3
    said = capsys.readouterr()
    assert said.out == "batch/results.csv: 0 of 3 runs have completed\n"
    assert said.err.splitlines()[0] == "uel: pulled-1: not run, or another batch runs it now"
    parts = [
        subprocess.Popen([*UEL, *words, "--part", part, "--cpus", "1"], stdout=subprocess.PIPE, text=True)
        for part in ("1/2", "2/2")
    ]
    texts = [part.communicate()[0] for part in parts]
    assert [part.returncode for part in parts] == [0, 0]
    assert texts == [
        "batch/results.csv: 2 of 2 runs of part 1 of 2 have completed\n",
        "batch/results.csv: 1 of 1 runs of part 2 of 2 have completed\n",
    ]
    assert [row["status"] for row in results()] == ["completed"] * 3
    assert [float(row["last RF1[END]"]) for row in results()] == pytest.approx([1.0, 2.0, 3.0])
    assert batch(*words, "--collect") == 0
    # with more parts than runs some have none
    assert batch(*words, "--part", "4/4") == 0


def test_run_that_another_batch_has(pulled: Path, started: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    """It is left alone; what another one has finished meanwhile is not run again."""
    words = [str(pulled), "--user", str(SPRING)]
    Path("batch/pulled").mkdir(parents=True)
    with locked(Path("batch/pulled/pulled.batch")):
        assert batch(*words) == 1
    assert capsys.readouterr().err == "uel: pulled: not run, or another batch runs it now\n"
    assert started == []
    assert batch(*words) == 0
    assert started == ["pulled"]


@pytest.mark.long
def test_entry_that_is_damaged(pulled: Path, started: list[str]) -> None:
    words = [str(pulled), "--user", str(SPRING), "--quiet"]
    for content in ("{", '{"pulled": {}}', '{"pulled": {"fingerprint": "", "row": {}}}'):
        Path("batch/pulled").mkdir(parents=True, exist_ok=True)
        Path("batch/pulled/pulled.json").write_text(content)
        assert batch(*words) == 0
    assert len(started) == 3


def wait_for(file: Path, text: str, process: subprocess.Popen[str]) -> None:
    """Wait until a file of a batch has a text."""
    began = time.monotonic()
    while not (file.exists() and text in file.read_text()):
        assert process.poll() is None, "the batch ended too soon"
        assert time.monotonic() - began < 120
        time.sleep(0.01)


def endless(crashing: Path) -> subprocess.Popen[str]:
    """A batch one of whose runs has completed, while the other does not end."""
    Path("ways.csv").write_text("job,way\ngood,0\nendless,4\n")
    words = [str(crashing), "--table", "ways.csv", "--user", str(CRASHES), "--call-limit", "0", "--cpus", "2"]
    process = subprocess.Popen([*UEL, *words], stderr=subprocess.PIPE, text=True, start_new_session=True)
    wait_for(Path("batch/good/good.json"), "completed", process)
    # its first increment is in the file
    wait_for(Path("batch/endless/endless.sta"), "\n   1     1", process)
    return process


def again(crashing: Path) -> int:
    """The same batch with a limit for each call."""
    return batch(str(crashing), "--table", "ways.csv", "--user", str(CRASHES), "--call-limit", "1")


def test_batch_that_is_killed(crashing: Path, results: Results, started: list[str]) -> None:
    """Its runs end with it; it goes on where it was, and loses what was running."""
    with endless(crashing) as process:
        process.kill()
    began = time.monotonic()
    while members(process.pid):
        assert time.monotonic() - began < 30
        time.sleep(0.05)
    assert not Path("batch/results.csv").exists()
    assert again(crashing) == 1
    assert started == ["endless"]
    assert [row["status"] for row in results()] == ["completed", "ended early"]


def members(group: int) -> list[str]:
    """Processes of a group, but those that have ended."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, its_group = stat.read_text().rpartition(")")[2].split()[:3]
        except (OSError, ValueError):
            continue
        if int(its_group) == group and state != "Z":
            found.append(stat.parent.name)
    return found


@pytest.mark.long
@pytest.mark.parametrize("way", ["one process", "all"])
def test_batch_that_is_interrupted(crashing: Path, results: Results, started: list[str], way: str) -> None:
    """By a user or a scheduler, which may send the signal to all processes."""
    process = endless(crashing)
    (os.kill if way == "one process" else os.killpg)(process.pid, signal.SIGTERM)
    said = process.communicate(timeout=60)[1]
    assert process.returncode == 1
    assert said.splitlines() == [
        "uel: ended by a user or the system (SIGTERM)",
        "uel: the runs that have ended are kept; the same command continues",
    ]
    assert Path("batch/endless/endless.sta").read_text().endswith(" THE ANALYSIS HAS NOT BEEN COMPLETED\n")
    assert [row["status"] for row in results()] == ["completed", "not run"]
    assert again(crashing) == 1
    assert started == ["endless"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("--part 0/4", "argument --part: expected I/N with I from 1 to N, such as 3/20, found '0/4'"),
        ("--part 5/4", "argument --part: expected I/N with I from 1 to N, such as 3/20, found '5/4'"),
        ("--part 1", "argument --part: expected I/N with I from 1 to N, such as 3/20, found '1'"),
        ("--part /4", "argument --part: expected I/N with I from 1 to N, such as 3/20, found '/4'"),
        ("--cpus 0", "argument --cpus: expected a whole number of 1 or more, found '0'"),
        ("--fallback --control energy", "not allowed with argument --fallback"),
    ],
)
def test_options_that_make_no_sense(words: str, message: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        batch("a.inp", *words.split())
    assert stop.value.code == 2
    assert message in capsys.readouterr().err


def test_wrong_usage(pulled: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Nothing has run, and nothing is written."""
    assert batch("none.inp") == 2
    assert capsys.readouterr().err == "uel: none.inp: no such deck or folder\n"
    Path("values.csv").write_text("push\n1\n")
    assert batch(str(pulled), "--table", "values.csv") == 1
    assert capsys.readouterr().err.startswith("uel: values.csv:1: column 'push': pulled.inp defines no parameter")
    assert not Path("batch").exists()


def test_progress_on_a_terminal(
    pulled: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TTY_COMPATIBLE", "1")
    monkeypatch.setenv("COLUMNS", "120")
    assert batch(str(pulled), "--user", str(SPRING)) == 0
    said = re.sub(r"\x1b\[[0-9;?]*[a-zA-Z]", "", capsys.readouterr().err)
    assert "pulled: completed, 1 increment, 1 iteration, 0 cutbacks" in said
    assert "1/1" in said
    assert batch(str(pulled), "--user", str(SPRING), "--quiet") == 0
    assert capsys.readouterr().err == ""


def test_each_run_has_one_thread(pulled: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever the surroundings say, which stay as they are."""
    names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
    monkeypatch.setenv(names[0], "7")
    monkeypatch.delenv(names[1], raising=False)
    before = {name: os.environ.get(name) for name in names}
    seen: list[list[str | None]] = []

    def noted(*_: object, **__: object) -> int:
        seen.append([os.environ.get(name) for name in names])
        return 1

    monkeypatch.setattr(command, "supervise", noted)
    assert batch(str(pulled)) == 1
    assert seen == [["1"] * 3]
    assert {name: os.environ.get(name) for name in names} == before


def test_cores() -> None:
    if hasattr(os, "sched_getaffinity"):
        assert cores() == len(os.sched_getaffinity(0))
    assert cores() >= 1


def test_folder_of_the_runs_is_a_file(pulled: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("batch").write_text(MESH)
    assert batch(str(pulled)) == 1
    assert re.match("uel: batch.*: (Not a directory|File exists)", capsys.readouterr().err)
