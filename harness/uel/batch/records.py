# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Records of a batch: an entry for each run, beside its files, and the table of all of them.

A run has a folder of its own, FOLDER/NAME, with the files of the job and the entry NAME.json, so that batches on
several machines may share FOLDER.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np

from uel.batch.engine import Store, StoredRow
from uel.batch.runs import BatchRun
from uel.errors import SPEAKER, UelError
from uel.output import Result
from uel.output.files.history import FIXED
from uel.output.lock import locked
from uel.output.results import Counts
from uel.running.sanitizer import NOT_USED

COMPLETED: Final = "completed"
ENDED_EARLY: Final = "ended early"
FAILED: Final = "failed"
NOT_RUN: Final = "not run"

TABLE: Final = "results.csv"
"""The table, in the folder of the batch."""

_COUNTS: Final = ("increments", "iterations", "cutbacks")
_OF_HISTORY: Final = ("max", "min", "last")


@dataclass(frozen=True, slots=True)
class Entry(StoredRow):
    """Ending of a run.

    status          COMPLETED, ENDED_EARLY after some increments, or FAILED before the first one was complete
    reason          why it did not complete: first line of its error
    increments, iterations, cutbacks  including the iterations of abandoned attempts
    processor_time  of the analysis, in seconds; None if it did not close its files itself
    history         columns of the history in their order: name; largest, smallest and last value
    """

    status: str
    reason: str = ""
    increments: int = 0
    iterations: int = 0
    cutbacks: int = 0
    processor_time: float | None = None
    history: list[tuple[str, list[float]]] = field(default_factory=list)

    @property
    def completed(self) -> bool:
        """True if the analysis has completed."""
        return self.status == COMPLETED

    def __str__(self) -> str:
        counts = Counts(self.increments, self.iterations, self.cutbacks)
        return f"{self.status}: {self.reason}" if self.reason else f"{self.status}, {counts}"


def measure(stem: Path, code: int, log: Path) -> Entry:
    """Return the entry of a run from its files; code: exit code of `uel run`, log: what it printed."""
    try:
        result = Result(stem)
    except UelError:
        return Entry(FAILED, _reason(log, code))
    counts = result.counts
    return Entry(
        status=COMPLETED if code == 0 else ENDED_EARLY if counts.increments else FAILED,
        reason="" if code == 0 else _reason(log, code),
        increments=counts.increments,
        iterations=counts.iterations,
        cutbacks=counts.cutbacks,
        processor_time=result.processor_time,
        history=_history(result) if counts.increments else [],
    )


def _reason(log: Path, code: int) -> str:
    """Return the first error that a run printed."""
    lines = log.read_text("utf-8", errors="replace").splitlines()
    said = [line.removeprefix(SPEAKER) for line in lines if line.startswith(SPEAKER)]
    errors = (text for text in said if not text.startswith(NOT_USED.partition(",")[0]))
    return next(errors, f"exit code {code}, see {log.name}")


def _history(result: Result) -> list[tuple[str, list[float]]]:
    """Return the largest, smallest and last value of the columns that have any."""
    known = {name: values[~np.isnan(values)] for name, values in result.history.items() if name not in FIXED}
    return [
        (name, [float(values.max()), float(values.min()), float(values[-1])])
        for name, values in known.items()
        if values.size
    ]


class Records:
    """Entries of runs in their folders.

    Parameters
    ----------
    folder
        Folder of the batch.
    keep_failed
        Runs that did not complete are not repeated.
    """

    def __init__(self, folder: Path, *, keep_failed: bool) -> None:
        self._folder = folder
        self._keep_failed = keep_failed

    def read(self, run: BatchRun) -> Entry | None:
        """Return the entry of a run; None if there is none of its present inputs."""
        try:
            return self._store(run).get(run)
        except (ValueError, LookupError, TypeError):
            # damaged, or from another version
            return None

    def get(self, run: BatchRun, /) -> Entry | None:
        """Return the entry of a run; None if it has to run."""
        entry = self.read(run)
        return entry if entry is not None and (entry.completed or self._keep_failed) else None

    def put(self, run: BatchRun, entry: Entry, /) -> None:
        """Keep an entry."""
        self._store(run).put(run, entry)

    def _store(self, run: BatchRun) -> Store[Entry]:
        return Store(self._folder / run.name / f"{run.name}.json", Entry.from_json)

    def write_table(self, runs: Sequence[BatchRun]) -> Path:
        """Write the table of these runs, a line for each, as a whole; returns its path.

        Of several batches that share the folder, the one that writes last has seen the entries of all.
        """
        path = self._folder / TABLE
        self._folder.mkdir(parents=True, exist_ok=True)
        with locked(path, wait=True):
            new = path.with_suffix(".new")
            new.write_text(_table(runs, [self.read(run) for run in runs]), encoding="utf-8")
            new.replace(path)
        return path


def _table(runs: Sequence[BatchRun], entries: Sequence[Entry | None]) -> str:
    """Return the names and values, how each run ended, its files, and its history; a cell without a value is empty."""
    parameters = dict.fromkeys(name for run in runs for name, _ in run.values)
    columns = dict.fromkeys(name for entry in entries if entry is not None for name, _ in entry.history)
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    head = ["job", "deck", *parameters, "status", "reason", *_COUNTS, "processor time (s)", "files"]
    writer.writerow([*head, *(f"{kind} {name}" for name in columns for kind in _OF_HISTORY)])
    for run, entry in zip(runs, entries, strict=True):
        values = dict(run.values)
        cells: list[object] = [run.name, run.deck, *(values.get(name, "") for name in parameters)]
        if entry is None:
            cells += [NOT_RUN, *[""] * (len(head) - len(cells) - 1)]
        else:
            cells += [entry.status, entry.reason, *(getattr(entry, name) for name in _COUNTS)]
            cells += ["" if entry.processor_time is None else entry.processor_time, f"{run.name}/{run.name}"]
        history = dict(entry.history) if entry is not None else {}
        cells += [cell for name in columns for cell in history.get(name, [""] * len(_OF_HISTORY))]
        writer.writerow(cells)
    return buffer.getvalue()
