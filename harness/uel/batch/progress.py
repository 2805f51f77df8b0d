# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Progress of a batch: n of N, and the time left.

The estimate of `rich` counts what has ended in the last half a minute, in which no run of a large model ends; and it
takes all runs for equally long. Here the runs that are left take as long, for their work, as those that have ended.
"""

from __future__ import annotations

from datetime import timedelta

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    Task,
    TextColumn,
    TimeElapsedColumn,
)
from rich.text import Text


def time_left(elapsed: float, done: float, left: float) -> float | None:
    """Estimate the seconds for the work that is left, at the pace so far; None: unknown.

    Until a hundredth is done it is: the seconds are those of starting, more than of working.
    """
    if left == 0.0:
        return 0.0
    return elapsed * left / done if done >= 0.01 * (done + left) else None


def clock(seconds: float | None) -> str:
    """Format seconds as H:MM:SS."""
    return "-:--:--" if seconds is None else str(timedelta(seconds=round(max(seconds, 0.0))))


class TimeLeft(ProgressColumn):
    """The time left, as of the run that ended last, less the time since."""

    def render(self, task: Task) -> Text:
        """Render the column."""
        left = task.fields["left"]
        since = (task.elapsed or 0.0) - task.fields["at"]
        return Text(clock(left if left is None else left - since), style="progress.remaining")


class BatchProgress:
    """A bar on a terminal, and a line for each run that has ended.

    Parameters
    ----------
    console
        Gets both.
    total, known
        Number of runs, and of those that need not run.
    work
        Work of all runs still to be made, in any unit.
    workers
        Runs at a time.
    """

    def __init__(self, console: Console, total: int, known: int, work: float, workers: int) -> None:
        self._work = work
        self._workers = workers
        self._done = 0.0
        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
        times = (TextColumn("{task.fields[running]} running"), TimeElapsedColumn(), TextColumn("left"), TimeLeft())
        self._progress = Progress(*columns, *times, console=console)
        self._task = self._progress.add_task(
            "runs",
            total=total,
            completed=known,
            running=min(workers, total - known),
            left=time_left(0.0, 0.0, work),
            at=0.0,
        )

    def __enter__(self) -> BatchProgress:
        self._progress.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._progress.stop()

    def ended(self, work: float, line: str) -> None:
        """Count a run of so much work as ended; `line` says how, none if empty."""
        self._done += work
        task = self._progress.tasks[self._task]
        elapsed = task.elapsed or 0.0
        missing = round((task.total or 0.0) - task.completed) - 1
        # a sum less its terms is not 0
        left = time_left(elapsed, self._done, self._work - self._done if missing else 0.0)
        self._progress.update(self._task, advance=1, running=min(self._workers, missing), left=left, at=elapsed)
        if line:
            count = f"{task.completed:.0f} of {task.total:.0f}, {clock(left)} left"
            self._progress.console.print(f"{count}: {line}", highlight=False, markup=False, soft_wrap=True)
