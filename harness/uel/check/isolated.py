# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks in a separate process: if user code ends it, the findings so far are kept.

The process (worker.py) writes its findings to a file before each task, so that only the current check is lost.
"""

from __future__ import annotations

import pickle
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, TypeVar

from uel.check.examine import Examination, examine
from uel.check.finding import failed
from uel.check.progress import Running, Snapshot
from uel.check.worker import INTERRUPTED
from uel.errors import UelError
from uel.running import sanitizer
from uel.running.isolation import run_isolated

CALL_LIMIT: Final = 60.0
"""Seconds that a call of a user routine may take."""

ADVICE: Final = (
    "The element ended the process, as it would end that of Abaqus. The Fortran library does so when an input or "
    "output statement fails (a missing file), the system when memory is damaged: look at the check 'outside'. With "
    "--skip the checks after this one run."
)

INTERRUPTION: Final = "The checks after this one did not run."

T = TypeVar("T")


class EndedError(UelError):
    """User code ended the process, or a user interrupted it; snapshot has the findings so far."""

    def __init__(self, reason: str, snapshot: Snapshot, *, interrupted: bool = False) -> None:
        super().__init__(reason)
        self.snapshot = snapshot
        self.interrupted = interrupted


ShowProgress = Callable[[str], None]
"""Function that is told now and then what is being done."""


def examine_isolated(
    deck: Path, user: list[Path], *, call_limit: float = CALL_LIMIT, show: ShowProgress | None = None, **options: Any
) -> Examination:
    """Run `examine` in a separate process; if user code ends it, keep the findings and fail the current check.

    call_limit: seconds that one call of a user routine may take. Raises UelError, also if no check had begun.
    """
    sanitized = sanitizer.applies_to(user)
    try:
        return call_isolated(examine, deck, user, call_limit=call_limit, show=show, sanitized=sanitized, **options)
    except EndedError as end:
        running, outcome = end.snapshot.running, end.snapshot.outcome
        if running is None or not running.check:
            raise
        examination: Examination = outcome
        advice = INTERRUPTION if end.interrupted else ADVICE
        examination.types[-1].findings[running.check] = failed(str(end), advice)
        return examination


def call_isolated(
    function: Callable[..., T],
    *arguments: Any,
    call_limit: float = CALL_LIMIT,
    show: ShowProgress | None = None,
    sanitized: bool = False,
    **options: Any,
) -> T:
    """Call a function in a separate process; it takes `progress`. Raises UelError, and EndedError.

    sanitized: debug builds have AddressSanitizer, where that is possible.
    """
    with tempfile.TemporaryDirectory() as folder:
        file, messages = Path(folder) / "snapshot", Path(folder) / "messages"
        task = Path(folder) / "task"
        task.write_bytes(pickle.dumps((function, arguments, options, call_limit)))

        def meanwhile() -> None:
            running = _snapshot(file).running
            if show is not None and running is not None:
                show(str(running))

        with messages.open("w", encoding="utf-8") as stream:
            words = [str(task), str(file)]
            look = meanwhile if show else None
            end = run_isolated(
                "uel.check.worker", words, call_limit, sanitized=sanitized, errors=stream, meanwhile=look
            )
        sys.stderr.write(messages.read_text("utf-8", errors="replace"))
        snapshot = _snapshot(file)
    if snapshot.running is None:
        if snapshot.error:
            failure = UelError(snapshot.error)
            for note in snapshot.notes:
                failure.add_note(note)
            raise failure
        result: T = snapshot.outcome
        return result
    interrupted = end.interrupted or end.code == INTERRUPTED
    why = "interrupted" if interrupted else end.reason
    location = f"; {end.location}" if end.location else ""
    raise EndedError(f"the process was {why} during {snapshot.running}{location}", snapshot, interrupted=interrupted)


def _snapshot(file: Path) -> Snapshot:
    """Read the progress of the separate process."""
    if not file.exists():
        return Snapshot(Running("its start"))
    snapshot: Snapshot = pickle.loads(file.read_bytes())
    return snapshot
