# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What is kept of a run, from its files."""

import csv
import threading
import time
from pathlib import Path

import pytest

from uel.batch.records import Entry, Records, measure
from uel.batch.runs import BatchRun
from uel.output.files.sta_file import COMPLETED, NOT_COMPLETED, StatusRow, head
from uel.output.lock import locked
from uel.running.sanitizer import NOT_USED

CONVERGED = StatusRow(1, 1, 1, False, 3, 0.5, 0.5, 0.5)
CUT_BACK = StatusRow(1, 2, 1, True, 8, 0.5, 0.5, 0.5)
HISTORY = "step,increment,time,U1[END],RF1[END]\n1,1,0.5,0.1,\n1,2,0.75,0.3,-2.0\n1,3,1.0,0.2,-1.0\n"


def job(folder: Path, *rows: StatusRow, verdict: str, said: str = "") -> tuple[Path, Path]:
    """Files of a job, and what it printed."""
    stem = folder / "job"
    (folder / "job.sta").write_text(head() + "".join(f"{row}\n" for row in rows) + f"\n{verdict}\n")
    (folder / "job.msg").write_text(
        "     JOB TIME SUMMARY\n       TOTAL CPU TIME (SEC) =    12.500\n       WALLCLOCK TIME (SEC) =    20.0\n"
    )
    (folder / "job_history.csv").write_text(HISTORY)
    (folder / "job.log").write_text(said)
    return stem, folder / "job.log"


def test_run_that_completed(tmp_path: Path) -> None:
    stem, log = job(tmp_path, CONVERGED, CUT_BACK, CONVERGED, verdict=COMPLETED)
    entry = measure(stem, 0, log)
    history = [("U1[END]", [0.3, 0.1, 0.2]), ("RF1[END]", [-1.0, -2.0, -1.0])]
    assert entry == Entry("completed", "", 2, 14, 1, 12.5, history)
    assert str(entry) == "completed, 2 increments, 14 iterations, 1 cutback"


def test_run_that_ended_early(tmp_path: Path) -> None:
    """Its first error is the reason, not that a debug run has no sanitizer."""
    said = (
        f"hello\nuel: {NOT_USED.format(reason='it is not there')}\nuel: element 7: wrong\nuel: earlier warning: odd\n"
    )
    stem, log = job(tmp_path, CONVERGED, CUT_BACK, verdict=NOT_COMPLETED, said=said)
    entry = measure(stem, 1, log)
    assert (entry.status, entry.reason, entry.increments, entry.cutbacks) == ("ended early", "element 7: wrong", 1, 1)
    assert str(entry) == "ended early: element 7: wrong"


def test_run_that_failed(tmp_path: Path) -> None:
    """The history of an earlier one is not its own."""
    stem, log = job(tmp_path, CUT_BACK, verdict=NOT_COMPLETED)
    (tmp_path / "job.msg").unlink()
    assert measure(stem, 1, log) == Entry("failed", "exit code 1, see job.log", 0, 8, 1)
    (tmp_path / "job.sta").unlink()
    assert measure(stem, -9, log) == Entry("failed", "exit code -9, see job.log")


@pytest.fixture
def runs() -> list[BatchRun]:
    """Of one deck with a parameter, and of one with another."""
    first, second = Path("first.inp"), Path("second.inp")
    return [
        BatchRun("a", first, (("x", "1"),), (("deck", "1"),)),
        BatchRun("b", second, (("y", "2"),), (("deck", "2"),)),
        BatchRun("c", second, (("y", "3"),), (("deck", "3"),)),
    ]


def test_table_of_runs_with_other_columns(tmp_path: Path, runs: list[BatchRun]) -> None:
    """What a run does not have is empty."""
    records = Records(tmp_path, keep_failed=False)
    records.put(runs[0], Entry("completed", "", 2, 14, 1, 12.5, [("U1", [3.0, 1.0, 2.0])]))
    records.put(runs[1], Entry("ended early", 'a "reason", and more', 1, 4, 0, None, [("RF1", [6.0, 4.0, 5.0])]))
    path = records.write_table(runs)
    names, *rows = csv.reader(path.read_text().splitlines())
    counts = ["increments", "iterations", "cutbacks", "processor time (s)", "files"]
    history = ["max U1", "min U1", "last U1", "max RF1", "min RF1", "last RF1"]
    assert names == ["job", "deck", "x", "y", "status", "reason", *counts, *history]
    assert rows == [
        ["a", "first.inp", "1", "", "completed", "", "2", "14", "1", "12.5", "a/a", "3.0", "1.0", "2.0", "", "", ""],
        [
            *("b", "second.inp", "", "2", "ended early", 'a "reason", and more', "1", "4", "0", "", "b/b"),
            *("", "", "", "6.0", "4.0", "5.0"),
        ],
        ["c", "second.inp", "", "3", "not run", *[""] * 12],
    ]


def test_which_runs_are_repeated(tmp_path: Path, runs: list[BatchRun]) -> None:
    """Those with other inputs; those that did not complete only where that is wanted."""
    records = Records(tmp_path, keep_failed=False)
    patient = Records(tmp_path, keep_failed=True)
    first, second, _ = runs
    records.put(first, Entry("completed"))
    records.put(second, Entry("failed", "why"))
    assert (records.get(first), patient.get(first)) == (Entry("completed"), Entry("completed"))
    assert (records.get(second), patient.get(second)) == (None, Entry("failed", "why"))
    other = BatchRun(first.name, first.deck, first.values, (("deck", "9"),))
    assert (records.get(other), patient.get(other), records.read(other)) == (None, None, None)


def test_tables_are_written_one_after_the_other(tmp_path: Path, runs: list[BatchRun]) -> None:
    """The second one waits for the first, and then has what was kept meanwhile."""
    records = Records(tmp_path, keep_failed=False)
    table = tmp_path / "results.csv"
    with locked(table):
        thread = threading.Thread(target=records.write_table, args=[runs])
        thread.start()
        time.sleep(0.1)
        assert not table.exists()
        records.put(runs[0], Entry("completed"))
    thread.join(60)
    assert "a,first.inp,1,,completed" in table.read_text()
