# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Communication between the ranks of a job. All of them call each of these functions, in the same order.

Rank 0 alone speaks: it writes the files and prints. What one rank cannot do, all of them learn of, so that they end
together.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, Final, TypeVar

import numpy as np

from uel.errors import UelError
from uel.model.arrays import FloatArray, IntArray

_T = TypeVar("_T")
_A = TypeVar("_A", bound=np.generic)

FAILURES: Final = (UelError, OSError, MemoryError)
"""Errors that one rank may meet and all of them have to learn of."""


class Ranks:
    """Single process, which is all ranks.

    rank, size  number of this rank, from 0, and of all of them
    token       by which the ranks know this run
    """

    rank = 0
    size = 1
    token = ""

    def sum(self, values: FloatArray) -> FloatArray:
        """Sum an array over the ranks, the same to the bit on all of them; not a copy on one rank."""
        return values

    def largest(self, values: FloatArray) -> FloatArray:
        """Return the largest value of each entry of an array (k,) over the ranks."""
        found: FloatArray = self.sum(self.apart(values)).reshape(self.size, -1).max(axis=0)
        return found

    def apart(self, values: FloatArray) -> FloatArray:
        """Return an array (k,) whose `sum` (size k) has the values of all ranks one after another."""
        places = np.zeros((self.size, len(values)))
        places[self.rank] = values
        return places.ravel()

    def everyones(self, mine: _T) -> list[_T]:
        """Gather a value of each rank, in their order, on all of them."""
        return [mine]

    def collect(self, mine: _T) -> list[_T]:
        """Gather a value of each rank, in their order, on rank 0; nothing on the others."""
        return [mine]

    def from_first(self, mine: _T) -> _T:
        """Broadcast a value from rank 0."""
        return mine

    def exchange(self, parts: Sequence[np.ndarray[Any, np.dtype[_A]]]) -> list[np.ndarray[Any, np.dtype[_A]]]:
        """Exchange arrays: return those of each rank for this one, in order; parts: those of this one for each."""
        return list(parts)

    def exchange_known(
        self, parts: Sequence[np.ndarray[Any, np.dtype[_A]]], incoming: IntArray
    ) -> list[np.ndarray[Any, np.dtype[_A]]]:
        """Exchange arrays as in `exchange`, where the lengths of what comes are known."""
        return list(parts)

    def agree(self, act: Callable[[], _T], order: Callable[[Exception], float] = lambda _: math.inf) -> _T:
        """Do something that may fail on one rank alone: it then fails on all, with the same error.

        Parameters
        ----------
        act
            What each rank does by itself.
        order
            Of the errors of several ranks the one with the smallest value counts, then that of the lowest rank.

        Returns
        -------
        T
            What `act` returns on this rank.
        """
        return act()

    def tell(self, act: Callable[[], _T]) -> _T:
        """Act on rank 0; return the result, which is not None, or raise the error, on all ranks."""
        return act()

    def in_turn(self, act: Callable[[], _T]) -> _T:
        """Do something on rank 0 first, then on the others; errors as in `agree`."""
        return act()

    def lead(self, act: Callable[[], None], help_out: Callable[[], object]) -> None:
        """Do something on rank 0, while the others do what it asks for by `ask`; errors as in `agree`."""
        act()

    def ask(self) -> None:
        """Let the other ranks do their part, within `lead`."""

    def ended(self, error: BaseException | None) -> bool:
        """Come to the end of the job; returns whether all ranks do.

        Parameters
        ----------
        error
            What ends it, None if it is complete. An error that only this rank has met lets the others hang: after some
            seconds this one goes on alone.
        """
        return True

    def before_end(self, act: Callable[[], None]) -> None:
        """Do something once before `close` ends MPI, on all ranks and only if all of them come to the end."""

    def close(self) -> None:
        """End the communication: the last thing that ranks do together."""


ALONE: Final = Ranks()
"""A job in one process."""
