# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Progress of the checks, for messages if a check ends the process."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Running:
    """Running task: description, as the end of a sentence, and the check that fails if it ends the process.

    check is '' before the first element type.
    """

    activity: str
    check: str = ""

    def __str__(self) -> str:
        return self.activity


Progress = Callable[[Running, Any], None]
"""Function that is told what begins, and what has been found until then."""


def no_progress(running: Running, outcome: Any) -> None:
    """Ignore the progress."""


@dataclass(frozen=True, slots=True)
class Snapshot:
    """Progress of a process.

    running   current task; None at its end
    outcome   result, or the findings so far
    error     message of the UelError that ended the process; '' for none
    notes     of that error
    """

    running: Running | None
    outcome: Any = None
    error: str = ""
    notes: tuple[str, ...] = ()
