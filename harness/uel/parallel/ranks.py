# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Communication between the ranks of a job. All of them call each of these functions, in the same order.

Only rank 0 writes files and prints. An error of one rank is raised on all of them, so that they end together.
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
"""Errors of one rank that are raised on all of them."""


class Ranks:
    """Single process, which is all ranks.

    rank, size  number of this rank, from 0, and of all of them
    token       name of the run, the same on all ranks
    """

    rank = 0
    size = 1
    token = ""

    def sum(self, values: FloatArray) -> FloatArray:
        """Sum an array over the ranks, to the same bits on all of them; a single process returns the array itself."""
        return values

    def largest(self, values: FloatArray) -> FloatArray:
        """Return the largest value of each entry of an array (k,) over the ranks."""
        largest: FloatArray = self.sum(self.stacked(values)).reshape(self.size, -1).max(axis=0)
        return largest

    def stacked(self, values: FloatArray) -> FloatArray:
        """Return values (k,) in an array (size k) of zeros, whose `sum` has those of all ranks one after another."""
        rows = np.zeros((self.size, len(values)))
        rows[self.rank] = values
        return rows.ravel()

    def allgather(self, value: _T) -> list[_T]:
        """Gather the values of all ranks, in order, on each of them."""
        return [value]

    def gather(self, value: _T) -> list[_T]:
        """Gather the values of all ranks, in order, on rank 0; the others get an empty list."""
        return [value]

    def broadcast(self, value: _T) -> _T:
        """Return the value of rank 0 on all ranks."""
        return value

    def exchange(self, parts: Sequence[np.ndarray[Any, np.dtype[_A]]]) -> list[np.ndarray[Any, np.dtype[_A]]]:
        """Send parts[k] to rank k; return the arrays received, in the order of the ranks."""
        return list(parts)

    def exchange_known(
        self, parts: Sequence[np.ndarray[Any, np.dtype[_A]]], incoming: IntArray
    ) -> list[np.ndarray[Any, np.dtype[_A]]]:
        """Exchange arrays as in `exchange`; incoming: known lengths of those received."""
        return list(parts)

    def agree(self, act: Callable[[], _T], order: Callable[[Exception], float] = lambda _: math.inf) -> _T:
        """Call a function on each rank; if it raises an error on any of them, raise that error on all.

        Parameters
        ----------
        act
            Function that each rank calls by itself.
        order
            If several ranks raise errors, the one with the smallest value counts, then that of the lowest rank.

        Returns
        -------
        T
            Result of `act` on this rank.
        """
        return act()

    def on_rank_0(self, act: Callable[[], _T]) -> _T:
        """Call a function on rank 0; return its result, which is not None, or raise its error, on all ranks."""
        return act()

    def in_turn(self, act: Callable[[], _T]) -> _T:
        """Call a function on rank 0 first, then on the others; errors as in `agree`."""
        return act()

    def lead(self, act: Callable[[], None], help_out: Callable[[], object]) -> None:
        """Call `act` on rank 0; when it calls `call_helpers`, the others call `help_out`. Errors as in `agree`."""
        act()

    def call_helpers(self) -> None:
        """Let the other ranks call `help_out` of `lead`."""

    def ended(self, error: BaseException | None) -> bool:
        """Wait for the other ranks at the end of the job; return whether all of them have come there.

        Parameters
        ----------
        error
            Error that ends the job, None if it is complete. If only this rank has met it, the others do not come: after
            some seconds this one goes on alone.
        """
        return True

    def before_end(self, act: Callable[[], None]) -> None:
        """Register a function that `close` calls once before it ends MPI, if all ranks come to the end."""

    def close(self) -> None:
        """End MPI, as the last act of all ranks."""


ALONE: Final = Ranks()
"""A job in one process."""
