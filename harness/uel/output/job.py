# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""All files of one job, written from the records of the run.

A record is in the files when `write` returns, and an increment is in NAME.sta only after all of its other output: a run
that is killed leaves files that are readable and complete up to the last line of NAME.sta.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from uel.errors import UelError
from uel.model.contact import CONTACT
from uel.model.couplings import COUPLING
from uel.model.model import Model
from uel.model.records import (
    AttemptAbandoned,
    AttemptEnded,
    AttemptStarted,
    BucklingFactors,
    Convergence,
    FieldCheck,
    HarmonicResponse,
    IncrementDone,
    IterationDone,
    Largest,
    ModesFound,
    ModeShape,
    Noted,
    Record,
    SearchHelped,
    StateKept,
    StepDone,
    StepStarted,
    Warned,
)
from uel.model.restart import DeckPart
from uel.output.files.dat_file import DataFile
from uel.output.files.field_output import FieldFiles
from uel.output.files.history import HistoryFile
from uel.output.files.interface import InterfaceFile
from uel.output.files.msg_file import MessageFile
from uel.output.files.sta_file import StatusFile, StatusRow
from uel.output.files.state_files import StateFiles
from uel.output.progress import ProgressDisplay

ERRORS = {CONTACT: ("penetration", "contact force error"), COUPLING: ("displacement error", "rotation error")}
"""Names of the errors in checks of constraints, in place of residual and correction."""


class JobOutput:
    """Writer of NAME.sta, .msg, .dat, _history.csv, _interface.csv, .pvd with .vtu files, _restart, and of progress.

    Files of an earlier job of the same name are replaced.

    Parameters
    ----------
    model
        Model of the job.
    job
        Name of the files.
    directory
        Folder of the files, which exists.
    decks
        Decks of the model, which kept states name.
    quiet
        No progress display.

    Attributes
    ----------
    job, stem
        Name of the files, without and with their folder.
    """

    def __init__(
        self, model: Model, job: str, directory: Path, *, decks: Sequence[DeckPart] = (), quiet: bool = False
    ) -> None:
        self.stem = stem = Path(directory) / job
        self.job = job
        self._model = model
        self._pending: IncrementDone | None = None
        self._last: IncrementDone | None = None
        self._checks: tuple[FieldCheck, ...] = ()
        self._closed = False
        self._status = StatusFile(stem.with_name(f"{job}.sta"))
        self._message = MessageFile(stem.with_name(f"{job}.msg"), model)
        self._data = DataFile(stem.with_name(f"{job}.dat"), model)
        self._history = HistoryFile(stem.with_name(f"{job}_history.csv"), model)
        self._interface = InterfaceFile(stem.with_name(f"{job}_interface.csv"), model)
        self._fields = FieldFiles(stem.with_name(f"{job}.pvd"), model)
        self._states = StateFiles(stem, decks)
        self._progress = ProgressDisplay(model, quiet=quiet)

    def write(self, record: Record) -> None:
        """Write a record to the files.

        Parameters
        ----------
        record
            Next record of the run.

        Raises
        ------
        OSError
            A file cannot be written; others may have the record.
        """
        match record:
            case StepStarted():
                self._message.step_started(record)
                self._data.step_started(record)
            case AttemptStarted():
                self._checks = ()
                self._message.attempt_started(record)
            case IterationDone():
                self._checks = record.checks
                self._message.iteration(record)
            case AttemptAbandoned():
                self._abandoned(record)
            case SearchHelped():
                self._message.helped(record)
            case ModesFound() | BucklingFactors():
                self._modes(record)
            case ModeShape():
                self._requested(record, last=True)
            case IncrementDone():
                self._increment(record)
            case StepDone():
                self._finish_step()
                self._message.step_done(record)
            case StateKept():
                self._states.write(record)
            case Warned():
                self._message.remark("WARNING", record.message)
            case Noted():
                self._message.remark("NOTE", record.message)
        self._progress.write(record)

    def user_text(self, file: str, kind: str, text: str) -> None:
        """Write a text of a user routine.

        Parameters
        ----------
        file
            '.dat' or '.msg'.
        kind
            'print' for a text without a head; otherwise 'note', 'warning' or 'error', which is its head.
        text
            One or several lines.

        Raises
        ------
        OSError
            The file cannot be written.
        """
        target = self._data if file == ".dat" else self._message
        if kind == "print":
            target.text(text)
        else:
            target.remark(kind.upper(), text)

    @property
    def warnings(self) -> list[str]:
        """Warnings in the .dat file: about the deck, about its output requests; then those in the .msg file."""
        return [*self._data.warnings, *self._message.warnings]

    @property
    def reached(self) -> str:
        """Position of the run, as the end of a sentence."""
        steps, last = self._model.steps, self._last
        if last is None:
            return "before its first increment was complete"
        period = steps[last.step - 1].procedure.period
        moment = f"increment {last.increment} of step {last.step} (of {len(steps)})"
        return f"after {moment}, step time {last.step_time:g} of {period:g}"

    @property
    def unbalanced(self) -> list[str]:
        """Sentences on the largest errors of the last iteration, one per field that has not converged."""
        failed = []
        for check in self._checks:
            residual, correction = ERRORS.get(check.field, (f"residual {check.field}", "correction"))
            if check.verdict is Convergence.NOT_ACHIEVED:
                failed.append((residual, check.residual))
            elif not check.verdict.accepted:
                failed.append((correction, check.correction))
        return [
            f"last iteration: largest {what} {largest.value:.4g} {self._describe(largest)}"
            for what, largest in failed
            if largest.element or largest.node >= 0
        ]

    def _describe(self, largest: Largest) -> str:
        if largest.node < 0:
            return f"in element {largest.element}"
        node = f"at node {self._model.mesh.name(largest.node)}"
        if largest.element:
            return f"{node} of contact pair {largest.element}"
        return f"{node}, dof {largest.dof}" if largest.dof else f"{node}, of its distributing coupling"

    def close(self, error: UelError | None) -> None:
        """Write the remaining output of the last converged increment, and the verdict.

        A second call has no effect.

        Parameters
        ----------
        error
            Error that ended the run; None if it is complete.

        Raises
        ------
        OSError
            A file cannot be written; the others are closed nevertheless.
        UelError
            An element fails that is called for the output of the last increment.
        """
        if self._closed:
            return
        self._closed = True
        failed: list[Exception] = []
        owed = self._pending
        try:
            self._finish_step()
        except OSError as trouble:
            failed.append(trouble)
        except UelError as trouble:
            # after another error the states may belong to an increment that was not recorded
            if error is None:
                error = trouble
                failed.append(trouble)
        lost = owed if self._pending else None
        text = None if error is None else str(error)
        closing: list[Callable[[], None]] = [
            self._progress.close,
            lambda: self._message.close(text, lost),
            lambda: self._data.close(text, len(self._message.warnings)),
            self._history.close,
            self._interface.close,
        ]
        for act in closing:
            try:
                act()
            except OSError as trouble:
                failed.append(trouble)
        self._status.close(completed=error is None and not failed)
        if failed:
            raise failed[0]

    def _abandoned(self, record: AttemptAbandoned) -> None:
        self._message.abandoned(record)
        self._attempt(record)

    def _attempt(self, record: AttemptEnded, *, monitor: float | None = None) -> None:
        self._status.write(
            StatusRow(
                record.step,
                record.increment,
                record.attempt,
                isinstance(record, AttemptAbandoned),
                record.iterations,
                record.total_time,
                record.step_time,
                record.time_increment,
                monitor,
                record.severe,
                riks=self._model.steps[record.step - 1].procedure.riks is not None,
            )
        )

    def _modes(self, record: ModesFound | BucklingFactors) -> None:
        self._data.modes(record)
        size = self._model.steps[record.step - 1].procedure.period
        self._status.write(StatusRow(record.step, 1, 1, False, 1, record.total_time, size, size))

    def _increment(self, record: IncrementDone) -> None:
        procedure = self._model.steps[record.step - 1].procedure
        # the end of a path, or of a sequence of frequencies, is known only when its step is done
        timeless = procedure.riks is not None or isinstance(record, HarmonicResponse)
        last = not timeless and record.step_time >= procedure.period * (1.0 - 1e-9)
        # the increment before is complete, even if this one cannot be written
        self._pending = None
        self._requested(record, last=last)
        self._pending = self._last = record
        self._message.increment(record)
        self._attempt(record, monitor=self._monitored(record))

    def _finish_step(self) -> None:
        """Write the last increment of a step if the output frequency has skipped it."""
        if self._pending is not None:
            self._requested(self._pending, last=True)
            self._pending = None

    def _requested(self, record: IncrementDone, *, last: bool) -> None:
        self._fields.write(record, last=last)
        self._interface.write(record, last=last)
        self._history.write(record, last=last)
        for name in self._history.unavailable:
            self._data.remark("WARNING", f"HISTORY OUTPUT OF {name} IS NOT AVAILABLE AND IS LEFT OUT")
        self._history.unavailable.clear()
        self._data.increment(record, last=last)

    def _monitored(self, record: IncrementDone) -> float | None:
        """Return the value of the dof of *MONITOR."""
        monitor = self._model.steps[record.step - 1].output.monitor
        if monitor is None:
            return None
        solution = record.solution
        positions = np.flatnonzero((solution.node == monitor[0]) & (solution.dof == monitor[1]))
        return float(solution.displacement[positions[0]]) if len(positions) else None
