# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Progress display on a terminal; none on other output."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.console import Console

from uel.model.model import Model
from uel.model.records import (
    AttemptAbandoned,
    AttemptStarted,
    FieldCheck,
    IncrementDone,
    IterationDone,
    Record,
    StepStarted,
)
from uel.output.step_header import controls_of

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID


class ProgressDisplay:
    """Line on the current step: time, increment, iteration, residual over tolerance, cutbacks."""

    def __init__(self, model: Model, *, quiet: bool, console: Console | None = None) -> None:
        console = console or Console(stderr=True)
        self._model = model
        self._progress: Progress | None = None
        self._task: TaskID | None = None
        self._step = 1
        self._cutbacks = 0
        if quiet or not console.is_terminal:
            return
        from rich.progress import (  # noqa: PLC0415 (jobs without a terminal do not wait for it)
            BarColumn,
            Progress,
            TextColumn,
            TimeElapsedColumn,
        )

        self._progress = Progress(
            TextColumn("Step {task.fields[step]}"),
            BarColumn(bar_width=10),
            TextColumn("{task.fields[what]} {task.completed:.4g}/{task.total:.4g}"),
            TextColumn("inc {task.fields[increment]} iter {task.fields[iteration]}"),
            TextColumn("r/tol {task.fields[ratio]}"),
            TextColumn("cutbacks {task.fields[cutbacks]}"),
            TimeElapsedColumn(),
            console=console,
            refresh_per_second=5,
        )
        self._progress.start()

    def write(self, record: Record) -> None:
        """Show a record."""
        if self._progress is None:
            return
        if isinstance(record, StepStarted):
            self._step = record.step
            self._cutbacks = 0
            what, total = self._model.steps[record.step - 1].procedure.extent
            self._task = self._progress.add_task(
                "", total=total, what=what, step=record.step, increment=1, iteration=0, ratio="-", cutbacks=0
            )
        if self._task is None:
            return
        match record:
            case AttemptStarted():
                self._progress.update(self._task, increment=record.increment, iteration=0)
            case IterationDone():
                self._progress.update(self._task, iteration=record.iteration, ratio=self._ratio(record.checks))
            case AttemptAbandoned():
                self._cutbacks += 1
                self._progress.update(self._task, cutbacks=self._cutbacks)
            case IncrementDone():
                linear = self._model.steps[record.step - 1].procedure.linear
                self._progress.update(self._task, completed=record.increment if linear else record.step_time)

    def close(self) -> None:
        """Leave the last state on the terminal."""
        if self._progress is not None:
            self._progress.stop()

    def _ratio(self, checks: tuple[FieldCheck, ...]) -> str:
        """Return the largest ratio of residual to tolerance over all fields, as a text."""
        controls = self._model.steps[self._step - 1].controls
        ratios = [
            abs(check.residual.value) / (controls_of(check.field, controls).r_n * check.time_average_flux)
            for check in checks
            if check.time_average_flux > 0.0
        ]
        return f"{max(ratios):.1e}" if ratios else "-"
