# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel batch`: run what has not run, several runs at a time, and write one table of all."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from rich.console import Console

from uel.batch.engine import complete
from uel.batch.records import Entry, Records, measure
from uel.batch.runs import BatchRun, Settings, list_runs
from uel.errors import tell, tell_error
from uel.interrupts import Interrupted, collected
from uel.output.lock import LockedError, locked
from uel.running.isolation import supervise
from uel.running.sanitizer import applies_to
from uel.solver.threads import one_thread_each

_STALE: Final = (".json", ".sta", ".msg")
"""Endings of a run's entry and of the files by which it is judged: earlier ones are removed before it begins."""

_MOST_TOLD: Final = 3
"""Runs that have not completed, of which the reasons are told."""


def batch(
    paths: Sequence[Path],
    folder: Path,
    settings: Settings,
    *,
    table: Path | None = None,
    part: tuple[int, int] = (1, 1),
    workers: int | None = None,
    keep_failed: bool = False,
    collect: bool = False,
    quiet: bool = False,
) -> bool:
    """Run the command; returns whether all runs of the part have completed.

    Parameters
    ----------
    paths
        Decks, and folders of decks.
    folder
        Gets a folder for each run, and the table of all runs, of other parts too.
    settings
        User files and options of the runs.
    table
        Values for the parameters of one deck, a row for each run.
    part
        (i, n): every n-th run, from the i-th on; i counts from 1.
    workers
        Runs at a time; one for each core that this process may use by default.
    keep_failed
        Runs that ended early or failed are not repeated as long as their inputs are the same.
    collect
        Run nothing.
    quiet
        Neither progress nor a summary.

    Raises
    ------
    UelError
        As `list_runs`.
    Interrupted
        A signal has ended the batch; what has run until then is kept.
    """
    runs = list_runs(paths, table, settings)
    first, count = part
    mine = runs[first - 1 :: count]
    records = Records(folder, keep_failed=keep_failed)
    if not collect:
        try:
            _run(mine, records, folder, settings, workers or cores(), quiet=quiet)
        except Interrupted:
            records.write_table(runs)
            raise
    path = records.write_table(runs)
    entries = {run: records.read(run) for run in mine}
    completed = [run for run, entry in entries.items() if entry is not None and entry.completed]
    if not quiet:
        whose = "" if count == 1 else f" of part {first} of {count}"
        tell(f"{path}: {len(completed)} of {len(mine)} runs{whose} have completed")
    _tell_others({run: entry for run, entry in entries.items() if run not in completed}, path)
    return len(completed) == len(mine)


def cores() -> int:
    """Return the cores that this process may use: a scheduler may grant less than the machine has."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _run(
    runs: Sequence[BatchRun], records: Records, folder: Path, settings: Settings, workers: int, *, quiet: bool
) -> None:
    """Run what the records do not have. Raises Interrupted, with all that has ended in the records."""
    console = Console(stderr=True)
    console.quiet = quiet or not console.is_terminal
    with collected() as signals, one_thread_each():
        runner = _Runner(records, settings, signals)
        complete(runs, records, runner, folder, workers=workers, console=console, describe=str, threads=True)
        if signals:
            error = Interrupted(signals[0])
            error.add_note("the runs that have ended are kept; the same command continues")
            raise error


class _Runner:
    """Runner of a deck by `uel run` in a process of its own, whatever happens to it."""

    def __init__(self, records: Records, settings: Settings, signals: Sequence[int]) -> None:
        self._records = records
        self._settings = settings
        self._signals = signals

    def __call__(self, run: BatchRun, folder: Path) -> Entry | None:
        """Return the entry of the run; None if the batch is interrupted, or if another one has this run."""
        own_folder = folder / run.name
        own_folder.mkdir(parents=True, exist_ok=True)
        stem = own_folder / run.name
        try:
            with locked(stem.with_name(f"{run.name}.batch")):
                # another batch may have run it since this one began
                known = self._records.get(run)
                return known if known is not None or self._signals else self._start(run, stem)
        except LockedError:
            return None

    def _start(self, run: BatchRun, stem: Path) -> Entry | None:
        for ending in _STALE:
            stem.with_name(stem.name + ending).unlink(missing_ok=True)
        settings = self._settings
        words = ["run", str(run.deck), f"--job={run.name}", f"--output-dir={stem.parent}", *settings.options]
        words += [f"--user={file}" for file in settings.user]
        words += [f"--parameter={name}={value}" for name, value in run.values]
        words += [f"--call-limit={settings.call_limit!r}"]
        log = stem.with_name(f"{stem.name}.log")
        with log.open("w", encoding="utf-8") as stream:
            code = supervise(
                words,
                stem,
                settings.call_limit,
                sanitized=settings.debug and applies_to(settings.user),
                log=stream,
                signals=self._signals,
            )
        # one that completed all the same is kept
        return None if code and self._signals else measure(stem, code, log)


def _tell_others(entries: dict[BatchRun, Entry | None], table: Path) -> None:
    """Say which runs have not completed, and why."""
    for run, entry in list(entries.items())[:_MOST_TOLD]:
        tell_error(f"{run.name}: {entry or 'not run, or another batch runs it now'}")
    if len(entries) > _MOST_TOLD:
        tell_error(f"and {len(entries) - _MOST_TOLD} more, see {table}")
