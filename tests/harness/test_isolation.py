# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""User code that ends its process: the message, the files so far, and the exit code of the command."""

import os
import re
import subprocess
import sys
import time
from pathlib import Path

import pytest

from harness.isolation import supervise
from harness.output.broken import close_broken
from harness.output.status import read_status

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
ENDLESS = r"in UEL: the call does not return within 4 s, the limit for one call \(--call-limit\)"
STOPPED = r"element 7 \(type U1\): stopped the analysis{} \(step 1, increment 2, iteration 0\)"
PLACE = STOPPED.format(": {}")


@pytest.mark.parametrize(
    ("way", "message"),
    [
        (1, PLACE.format("in UEL: segmentation fault: it reads or writes where no memory is.*")),
        pytest.param(2, PLACE.format("in UEL: segmentation fault: the stack is full.*"), marks=pytest.mark.long),
        pytest.param(3, PLACE.format("in UEL: division of an integer by zero"), marks=pytest.mark.long),
        (4, PLACE.format(ENDLESS)),
        (5, r"uel: the run was ended by SIGABRT: abort, mostly .*, " + WHERE + ": abort: memory is damaged"),
        (6, r"uel: the run was ended by the Fortran library, .*, " + WHERE + ": the process ends"),
        pytest.param(7, PLACE.format("STOP 'enough'"), marks=pytest.mark.long),
        # inside a WRITE, whose unit stays locked
        (8, PLACE.format("in UEL: segmentation fault: .*")),
        (9, STOPPED.format(r" \(XIT\) without a message") + r"\nuel: earlier warning: .* unit 6 or 7 locked"),
        pytest.param(10, PLACE.format("STOP 'no value'"), marks=pytest.mark.long),
        pytest.param(11, PLACE.format("in UEL: division of an integer by zero"), marks=pytest.mark.long),
        (12, PLACE.format(ENDLESS)),
        # what it has printed before
        (13, STOPPED.format(r" \(XIT\); last printed: second / stiffness is negative / see page 7")),
        (14, STOPPED.format(r" \(XIT\); last printed: no convergence of the local iteration")),
    ],
)
def test_the_end_is_reported(tmp_path: Path, way: int, message: str) -> None:
    deck = tmp_path / "crash.inp"
    deck.write_text(DECK.format(way=way))
    command = [sys.executable, "-m", "harness.cli", "run", "crash.inp", "--user", str(USER), "--call-limit", "4"]
    result = subprocess.run([*command, "--quiet"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert result.returncode == 1
    assert "Traceback" not in result.stderr
    assert re.search(message, result.stderr), result.stderr
    assert [row.increment for row in read_status(tmp_path / "crash.sta")] == [1]
    assert (tmp_path / "crash.sta").read_text().endswith(" THE ANALYSIS HAS NOT BEEN COMPLETED\n")
    assert "***ERROR" in (tmp_path / "crash.msg").read_text()


def test_process_that_is_killed_takes_the_other_along(tmp_path: Path) -> None:
    inner = "import time; print('begun', flush=True); time.sleep(60)"
    (tmp_path / "sleeper.py").write_text(f"def main(words):\n    {inner}\n")
    outer = "from harness.isolation import run_apart; run_apart('sleeper', [], 0.0)"
    command, environment = [sys.executable, "-c", outer], os.environ | {"PYTHONPATH": str(tmp_path)}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as process:
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
    close_broken(tmp_path / "crash", "nothing")
    close_broken(tmp_path / "absent", "nothing")
    assert (tmp_path / "crash.sta").read_text() == before
