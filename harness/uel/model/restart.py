# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*RESTART: increments after which a step keeps its state, the one from which a run resumes, and the kept state."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from uel.errors import Source

Saved = dict[str, Any]
"""A part of a state by name: arrays, numbers, texts, lists of them, and further parts."""


@dataclass(frozen=True, slots=True)
class RestartWrite:
    """*RESTART, WRITE: increments after which the state is kept, and always after the last one of the step.

    frequency  every k-th increment; 0 never
    intervals  the first increment that ends in or after each of so many equal parts of the step, instead of frequency
    overlay    only the last state of the step stays
    """

    frequency: int = 1
    intervals: int = 0
    overlay: bool = False

    @property
    def lrestart(self) -> int:
        """LRESTART of UEXTERNALDB in an increment after which the state is kept."""
        return 2 if self.overlay else 1

    def due(self, increment: int, before: float, after: float, *, last: bool) -> bool:
        """Return whether the state is kept after an increment.

        Parameters
        ----------
        increment
            Its number.
        before, after
            Step times of its start and end, over the period.
        last
            It ends the step.
        """
        if self.intervals:
            # the sum of the increments may be a little short of the end of a part
            parts = [math.floor(self.intervals * share + 1e-9) for share in (before, after)]
            return last or parts[1] > parts[0]
        return self.frequency > 0 and (last or increment % self.frequency == 0)


@dataclass(frozen=True, slots=True)
class RestartRead:
    """*RESTART, READ: where an analysis resumes.

    step, increment  None: the last of those that were kept
    end_step         the step ends there
    """

    step: int | None
    increment: int | None
    end_step: bool
    source: Source


@dataclass(frozen=True, slots=True)
class DeckPart:
    """One of the decks that a model comes from: that of the first job, and of each restart.

    path    absolute
    digest  of the deck and the files that it includes
    given   values of parameters that replace those in the deck
    steps   number of steps of the decks before it that stay
    """

    path: str
    digest: str
    given: dict[str, float]
    steps: int = 0


@dataclass(frozen=True, slots=True)
class KeptState:
    """A state as its file has it.

    step, increment  at the end of which it was kept
    decks            where its model comes from
    analysis         the state itself
    file             path of the file
    """

    step: int
    increment: int
    decks: tuple[DeckPart, ...]
    analysis: Saved
    file: str


@dataclass(frozen=True, slots=True)
class Resumption:
    """Kept state that an analysis resumes; end_step: its step ends there."""

    analysis: Saved
    file: str
    end_step: bool = False
