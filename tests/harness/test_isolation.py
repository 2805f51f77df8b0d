# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""User code that ends its process: the message, the files so far, and the exit code of the command."""

import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from uel.output.files.sta_file import read_status
from uel.output.verdict import close_ended_run
from uel.running.isolation import supervise
from uel.shared_progress import Within, new_slate

CRASHES = Path(__file__).parent / "usersub" / "crashes.cpp"
LONG_RUN = Path(__file__).parents[2] / "abaqus_inputs" / "dcb" / "dcb_u4_1e8.inp"
USER = Path(__file__).parent / "usersub" / "crashes.f"
DECK = """\
*USER ELEMENT, TYPE=U1, NODES=2, I PROPERTIES=2
1
*NODE
1, 0.
2, 1.
*ELEMENT, TYPE=U1, ELSET=ALL
7, 1, 2
*UEL PROPERTY, ELSET=ALL
{way}, 0
*STEP
*STATIC, DIRECT
0.25, 1.
*BOUNDARY
1, 1
2, 1, 1, 1.
*END STEP
"""
WHERE = "in UEL for element 7, step 1, increment 2, iteration 0"
ENDLESS = r"in UEL, crashes.f line \d+.*: the call did not return within 2 s, the limit for one call \(--call-limit\)"
STOPPED = r"element 7 \(type U1\): stopped the analysis{} \(step 1, increment 2, iteration 0\)"
PLACE = STOPPED.format(": {}")


@pytest.mark.parametrize(
    ("way", "message"),
    [
        (1, PLACE.format(r"in UEL, crashes.f line \d+: segmentation fault: it reads or writes an invalid address.*")),
        pytest.param(
            2,
            PLACE.format(r"in UEL, crashes.f line \d+ \(ENDLESS\): segmentation fault: the stack is full.*"),
            marks=pytest.mark.long,
        ),
        pytest.param(
            3, PLACE.format(r"in UEL, crashes.f line \d+: division of an integer by zero"), marks=pytest.mark.long
        ),
        # 4 and 6 are also runs of a batch, in batch/test_command.py
        pytest.param(4, PLACE.format(ENDLESS), marks=pytest.mark.long),
        (5, r"uel: the run was ended by SIGABRT: abort, usually .*, " + WHERE + ": abort: memory is damaged"),
        pytest.param(
            6,
            r"uel: the run was ended by the Fortran library, .*; it looks up files from .*, "
            + WHERE
            + ": the process ends",
            marks=pytest.mark.long,
        ),
        pytest.param(7, PLACE.format("STOP 'enough'"), marks=pytest.mark.long),
        # inside a WRITE, whose unit stays locked
        pytest.param(8, PLACE.format(r"in UEL, crashes.f line \d+.*: segmentation fault: .*"), marks=pytest.mark.long),
        (9, STOPPED.format(r" \(XIT\) without a message") + r"\nuel: earlier warning: .* unit 6 or 7 locked"),
        pytest.param(10, PLACE.format("STOP 'no value'"), marks=pytest.mark.long),
        pytest.param(
            11, PLACE.format(r"in UEL, crashes.f line \d+.*: division of an integer by zero"), marks=pytest.mark.long
        ),
        pytest.param(12, PLACE.format(ENDLESS), marks=pytest.mark.long),
        # what it has printed before
        (13, STOPPED.format(r" \(XIT\); last printed: second / stiffness is negative / see page 7")),
        pytest.param(
            14,
            STOPPED.format(r" \(XIT\); last printed: no convergence of the local iteration"),
            marks=pytest.mark.long,
        ),
    ],
)
def test_the_end_is_reported(tmp_path: Path, way: int, message: str) -> None:
    deck = tmp_path / "crash.inp"
    deck.write_text(DECK.format(way=way))
    command = [sys.executable, "-m", "uel.cli", "run", "crash.inp", "--user", str(USER), "--call-limit", "2"]
    result = subprocess.run([*command, "--quiet"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert result.returncode == 1
    assert "Traceback" not in result.stderr
    assert re.search(message, result.stderr), result.stderr
    assert [row.increment for row in read_status(tmp_path / "crash.sta")] == [1]
    assert (tmp_path / "crash.sta").read_text().endswith(" THE ANALYSIS HAS NOT BEEN COMPLETED\n")
    assert "***ERROR" in (tmp_path / "crash.msg").read_text()


KILLED = r"uel: the run was {}, in UEL for element 7, step 1, increment 2, iteration 0; the output written so far"


def begin(folder: Path, user: Path, way: int, *words: str) -> subprocess.Popen[str]:
    """A run of the spring."""
    (folder / "crash.inp").write_text(DECK.format(way=way))
    command = [sys.executable, "-m", "uel.cli", "run", "crash.inp", "--user", str(user), "--quiet", *words]
    return subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True)


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("way", "message"),
    [
        (1, PLACE.format("an uncaught C.. exception: std::runtime_error: no such layer")),
        pytest.param(2, PLACE.format("an .*: .anonymous namespace.::own_exception"), marks=pytest.mark.long),
        (3, PLACE.format(r"exit\(0\)")),
        pytest.param(4, PLACE.format(r"_exit\(0\)"), marks=pytest.mark.long),
        # exit code 0, without the end of the run
        (5, KILLED.format(r"ended \(exit code 0\)")),
        pytest.param(
            6,
            KILLED.format(r"ended because a call of a user routine took longer than 1 s \(--call-limit\)"),
            marks=pytest.mark.long,
        ),
    ],
)
def test_ends_of_the_process_in_c(tmp_path: Path, way: int, message: str) -> None:
    process = begin(tmp_path, CRASHES, way, "--call-limit", "1")
    said = process.communicate()[1]
    assert process.returncode == 1
    assert re.search(message, said), said
    assert [row.increment for row in read_status(tmp_path / "crash.sta")] == [1]
    assert (tmp_path / "crash.sta").read_text().endswith(" THE ANALYSIS HAS NOT BEEN COMPLETED\n")
    assert re.search(r"\*\*\*ERROR: .*element 7", (tmp_path / "crash.msg").read_text(), re.DOTALL)


@pytest.mark.long
def test_library_whose_loading_does_not_end(tmp_path: Path) -> None:
    user = tmp_path / "endless.cpp"
    user.write_text("#define ENDLESS\n" + CRASHES.read_text())
    process = begin(tmp_path, user, 0, "--call-limit", "1")
    said = process.communicate()[1]
    assert process.returncode == 1
    assert "ended because loading the library of user routines took longer than 1 s (--call-limit);" in said


@pytest.mark.parametrize(
    ("signum", "reason"),
    [
        (signal.SIGINT, r"interrupted \(SIGINT\)"),
        pytest.param(signal.SIGTERM, r"ended by a user or the system \(SIGTERM\)", marks=pytest.mark.long),
        pytest.param(signal.SIGHUP, r"ended because the terminal was closed \(SIGHUP\)", marks=pytest.mark.long),
    ],
)
def test_signal_to_the_parent_alone_ends_an_endless_loop(tmp_path: Path, signum: int, reason: str) -> None:
    process = begin(tmp_path, CRASHES, 7, "--call-limit", "0")
    wait_for(tmp_path / "crash.sta", "   1     1   1 ", process)
    process.send_signal(signum)
    said = process.communicate()[1]
    assert process.returncode == 1
    assert re.search(KILLED.format(reason), said), said
    assert (tmp_path / "crash.sta").read_text().endswith(" THE ANALYSIS HAS NOT BEEN COMPLETED\n")


def test_signal_between_calls_ends_the_run_at_once(tmp_path: Path) -> None:
    """The run writes its verdict itself."""
    command = [sys.executable, "-m", "uel.cli", "run", str(LONG_RUN), "--output-dir", str(tmp_path), "--quiet"]
    # in the folder of the deck: elsewhere Abaqus would not find the files it includes, of which a run warns
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, cwd=LONG_RUN.parent)
    wait_for(tmp_path / f"{LONG_RUN.stem}.sta", "   1     3   1 ", process)
    process.send_signal(signal.SIGTERM)
    said = process.communicate()[1]
    assert process.returncode == 1
    first, second = said.splitlines()
    assert first == "uel: ended by a user or the system (SIGTERM)"
    assert re.fullmatch(r"uel: \w+ ended after increment \d+ of step 1 .*; what was written is readable", second)
    assert (tmp_path / f"{LONG_RUN.stem}.sta").read_text().endswith(" THE ANALYSIS HAS NOT BEEN COMPLETED\n")
    assert "***ERROR: ended by a user or the system" in (tmp_path / f"{LONG_RUN.stem}.msg").read_text()


LATE_SIGNAL = """
import os, signal, sys
from uel import cli, interrupts, output
interrupts.raise_interrupts()
close = output.JobOutput.close
def send():
    os.kill(os.getpid(), signal.SIGHUP)
def closing(job, error):
    close(job, error)
    {during}
output.JobOutput.close = closing
from uel.running import job
whole = job.Result
job.Result = lambda *args, **more: ({after}, whole(*args, **more))[1]
sys.exit(cli.main(["run", "--same-process", sys.argv[1], "--output-dir", sys.argv[2]]))
"""


@pytest.mark.parametrize(("during", "after"), [("send()", "None"), ("None", "send()")])
def test_signal_after_the_verdict_ends_nothing(tmp_path: Path, during: str, after: str) -> None:
    """The run has completed, as its files say."""
    deck = LONG_RUN.parents[1] / "patch_horizontal" / "flat_u2.inp"
    script = LATE_SIGNAL.format(during=during, after=after)
    command = [sys.executable, "-c", script, str(deck), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, "flat_u2: completed" in done.stdout + done.stderr) == (0, True), done.stderr
    assert (tmp_path / "flat_u2.sta").read_text().endswith(" THE ANALYSIS HAS COMPLETED SUCCESSFULLY\n")


def wait_for(file: Path, text: str, process: subprocess.Popen[str]) -> None:
    """Wait until a file of a run has a text."""
    began = time.monotonic()
    while not (file.exists() and text in file.read_text()):
        assert process.poll() is None, "the run ended too soon"
        assert time.monotonic() - began < 120
        time.sleep(0.01)


def test_process_that_is_killed_takes_the_other_along(tmp_path: Path) -> None:
    inner = "import time; print('begun', flush=True); time.sleep(60)"
    (tmp_path / "sleeper.py").write_text(f"def main(words):\n    {inner}\n")
    outer = "from uel.running.isolation import run_isolated; run_isolated('sleeper', [], 0.0)"
    with subprocess.Popen([sys.executable, "-c", outer], stdout=subprocess.PIPE, text=True, cwd=tmp_path) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "begun\n"
        killed = time.monotonic()
        process.kill()
        # the pipe is closed when the other process has ended too
        assert process.stdout.read() == ""
        assert time.monotonic() - killed < 30.0


def test_a_run_that_ends_well_or_closes_its_files_is_left_alone(tmp_path: Path) -> None:
    deck = tmp_path / "crash.inp"
    deck.write_text(DECK.format(way=0))
    assert supervise(["run", str(deck), "--user", str(USER), "--quiet", "--output-dir", str(tmp_path)], deck, 60.0) == 0
    before = (tmp_path / "crash.sta").read_text()
    close_ended_run(tmp_path / "crash", "nothing")
    close_ended_run(tmp_path / "absent", "nothing")
    assert (tmp_path / "crash.sta").read_text() == before


AGAIN = """\
import sys, uel
from uel.errors import UelError
try:
    uel.run("crash.inp", sys.argv[1], job="first")
except UelError as error:
    print(error)
result = uel.run("sound.inp", sys.argv[1])
print(result.completed, *result.warnings)
"""


def test_program_goes_on_after_a_call_was_left_inside_a_write(tmp_path: Path) -> None:
    """Without the units, and without waiting for them where it ends."""
    (tmp_path / "crash.inp").write_text(DECK.format(way=9))
    (tmp_path / "sound.inp").write_text(DECK.format(way=0))
    command = [sys.executable, "-c", AGAIN, str(USER)]
    result = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True, timeout=300)
    first, second = result.stdout.splitlines()
    assert "stopped the analysis (XIT)" in first
    assert re.fullmatch(
        "True an abandoned call inside a WRITE has .*since an earlier run: text printed there is lost", second
    )


@pytest.mark.parametrize(("routine", "location"), [(b"UMAT", "in UMAT for element 7"), (b"element", "in element 7")])
def test_location_of_the_last_call(routine: bytes, location: str) -> None:
    """A built-in element, which is not called by the name of a user routine."""
    _, slate = new_slate()
    assert slate.where() == ""
    slate.within, slate.routine, slate.location[:] = Within.CALL, routine, (7, 1, 2, 3)
    assert slate.where() == f"{location}, step 1, increment 2, iteration 3"
