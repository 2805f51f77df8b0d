# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The ranks of MPI, which is loaded only in a job that `mpiexec` has started."""

from __future__ import annotations

import math
import os
import pickle
import secrets
import time
from collections.abc import Callable, Sequence
from typing import Any, Final, TypeVar

import numpy as np

from uel.errors import UsageError
from uel.model.arrays import FloatArray, IntArray
from uel.parallel.launch import Launch
from uel.parallel.ranks import ALONE, FAILURES, Ranks
from uel.shared_progress import own_slate

_T = TypeVar("_T")
_A = TypeVar("_A", bound=np.generic)

_SPIN: Final = 2e-4
"""Seconds in which a rank that waits for others asks again and again; after that it sleeps in between."""

_NAP: Final = 2e-4
"""Seconds of such a sleep."""

_HELP: Final[tuple[bool, Any]] = (True, None)
"""Message of rank 0 to the others in `lead` when it asks for help."""

_TOGETHER: Final = 10.0
"""Seconds in which all ranks come to the end, unless only one of them has failed."""


def begin(launch: Launch) -> Ranks:
    """Return the ranks to which this process belongs. Raises UsageError without what several ranks need."""
    return ALONE if launch.size == 1 else MpiRanks(launch)


class MpiRanks(Ranks):
    """The processes that `mpiexec` has started.

    A sum goes to rank 0 and from there to all, so that no rank has other bits; MPI adds in the same order in each run
    on as many ranks.
    """

    token = ""

    def __init__(self, launch: Launch) -> None:
        """Start MPI. Raises UsageError without mpi4py, and where its MPI is not that of `mpiexec`."""
        # MPICH asks without end for messages; let it give up the core while there are none
        os.environ.setdefault("MPIR_CVAR_POLLS_BEFORE_YIELD", "1")
        try:
            import mpi4py  # noqa: PLC0415

            # only when all ranks have come to the end: a rank that has failed would wait for the others
            mpi4py.rc.finalize = False
            from mpi4py import MPI  # noqa: PLC0415
        except (ImportError, RuntimeError) as error:
            why = str(error).partition("\n")[0]
            raise UsageError(
                f"mpiexec has started {launch.size} ranks, which need mpi4py ({why}); pip install .[mpi]"
            ) from None
        self._mpi = MPI
        self.comm = MPI.COMM_WORLD
        self.rank, self.size = self.comm.rank, self.comm.size
        if self.size != launch.size:
            raise UsageError(
                f"mpiexec has started {launch.size} ranks, but MPI of mpi4py sees {self.size}: they are of different "
                "MPI libraries; take the mpiexec that belongs to it"
            )
        self._at_end = self.comm.Dup()
        self._together: bool | None = None
        self._known: Exception | None = None
        self._before_end: list[Callable[[], None]] = []
        self.token = self.from_first(secrets.token_hex(4))
        slate = own_slate()
        if slate is not None:
            slate.token = self.token.encode()

    def sum(self, values: FloatArray) -> FloatArray:
        """Sum an array over the ranks, see `Ranks`."""
        total = np.empty_like(values)
        self._meet()
        self.comm.Reduce(values, None if self.rank else total, self._mpi.SUM, 0)
        self.comm.Bcast(total, 0)
        return total

    def everyones(self, mine: _T) -> list[_T]:
        """Gather a value of each rank on all of them, see `Ranks`."""
        self._meet()
        return list(self.comm.allgather(mine))

    def collect(self, mine: _T) -> list[_T]:
        """Gather a value of each rank on rank 0, see `Ranks`; only this rank's where the others have ended."""
        if self._together is False:
            return [mine]
        self._meet()
        return self.comm.gather(mine, 0) or []

    def from_first(self, mine: _T) -> _T:
        """Broadcast a value from rank 0, see `Ranks`."""
        packed = np.frombuffer(pickle.dumps(mine), dtype=np.uint8) if not self.rank else np.zeros(0, dtype=np.uint8)
        size = np.array([len(packed)])
        self._wait(self.comm.Ibcast(size, 0))
        packed = np.resize(packed, size[0])
        self._wait(self.comm.Ibcast(packed, 0))
        found: _T = pickle.loads(packed.tobytes())
        return found

    def exchange(self, parts: Sequence[np.ndarray[Any, np.dtype[_A]]]) -> list[np.ndarray[Any, np.dtype[_A]]]:
        """Exchange arrays with all ranks, see `Ranks`."""
        counts = np.array([len(part) for part in parts])
        incoming = np.empty_like(counts)
        self._wait(self.comm.Ialltoall(counts, incoming))
        return self.exchange_known(parts, incoming)

    def exchange_known(
        self, parts: Sequence[np.ndarray[Any, np.dtype[_A]]], incoming: IntArray
    ) -> list[np.ndarray[Any, np.dtype[_A]]]:
        """Exchange arrays of known lengths, see `Ranks`."""
        sent = np.concatenate(parts)
        received = np.empty(incoming.sum(), dtype=sent.dtype)
        counts = np.array([len(part) for part in parts])
        self._meet()
        self.comm.Alltoallv((sent, counts), (received, incoming))
        return np.split(received, np.cumsum(incoming)[:-1])

    def agree(self, act: Callable[[], _T], order: Callable[[Exception], float] = lambda _: math.inf) -> _T:
        """Act on all ranks, and raise an error of one on all of them, see `Ranks`."""
        failure: Exception | None = None
        try:
            result = act()
        except FAILURES as error:
            if error is self._known:
                # the others have it too, from an agreement within this one
                raise
            failure = error
        if not self.sum(np.array([float(failure is not None)]))[0]:
            return result
        told = None if failure is None else (order(failure), self.rank, _packed(failure))
        found = min((one for one in self.everyones(told) if one is not None), key=lambda one: one[:2])
        self._raise(found[2])
        raise AssertionError("unreachable")

    def tell(self, act: Callable[[], _T]) -> _T:
        """Act on rank 0 and broadcast the result or the error, see `Ranks`."""
        failure: Exception | None = None
        result: _T | None = None
        try:
            result = None if self.rank else act()
        except FAILURES as error:
            failure = error
        told, result = self.from_first((_packed(failure), result))
        self._raise(told)
        assert result is not None
        return result

    def _raise(self, packed: _Packed | None) -> None:
        """Raise the error that another rank has packed, if there is one."""
        if packed is None:
            return
        kind, words, details = packed
        # constructors of errors take other arguments than those they keep
        known: Exception = kind.__new__(kind, *words)
        known.__dict__.update(details)
        self._known = known
        raise known

    def in_turn(self, act: Callable[[], _T]) -> _T:
        """Act on rank 0, then on the others, see `Ranks`."""
        first = self.agree(lambda: None if self.rank else act())
        others = self.agree(lambda: act() if self.rank else None)
        result = others if self.rank else first
        assert result is not None
        return result

    def lead(self, act: Callable[[], None], help_out: Callable[[], object]) -> None:
        """Act on rank 0 while the others wait to help, see `Ranks`; rank 0 acts alone where the others have ended."""
        if self._together is False:
            if not self.rank:
                act()
            return
        failure: Exception | None = None
        if self.rank:
            while (told := self.from_first(_HELP))[0]:
                help_out()
            self._raise(told[1])
            return
        try:
            act()
        except FAILURES as error:
            if error is self._known:
                # of a help, which the others have left with the same error
                raise
            failure = error
        self.from_first((False, _packed(failure)))
        if failure is not None:
            self._known = failure
            raise failure

    def ask(self) -> None:
        """Ask the other ranks for help, see `Ranks`. Raises OSError where the others have ended."""
        if self._together is False:
            raise OSError("the other ranks have ended")
        self.from_first(_HELP)

    def ended(self, error: BaseException | None) -> bool:
        """Report whether all ranks end together, see `Ranks`."""
        if self._together is None:
            self._together = not isinstance(error, KeyboardInterrupt) and self._all_end(wait=error is None)
        return self._together

    def before_end(self, act: Callable[[], None]) -> None:
        """Register an act for the end of the ranks, see `Ranks`."""
        if act not in self._before_end:
            self._before_end.append(act)

    def close(self) -> None:
        """End MPI, see `Ranks`."""
        if self._together:
            for act in self._before_end:
                act()
            self._mpi.Finalize()

    def _all_end(self, *, wait: bool) -> bool:
        """Report whether all ranks come here; wait: for as long as it takes."""
        request, until = self._at_end.Ibarrier(), time.monotonic() + _TOGETHER
        while not request.Test():
            if not wait and time.monotonic() > until:
                return False
            time.sleep(_NAP)
        return True

    def _meet(self) -> None:
        """Wait until all ranks are here: what they then tell each other moves on only while they ask for it."""
        self._wait(self.comm.Ibarrier())

    def _wait(self, request: Any) -> None:
        """Wait in sleep rather than by asking without end: the work of the ranks differs in length."""
        until = time.perf_counter() + _SPIN
        while not request.Test():
            if time.perf_counter() > until:
                time.sleep(_NAP)


_Packed = tuple[type[Exception], tuple[Any, ...], dict[str, Any]]


def _packed(error: Exception | None) -> _Packed | None:
    """Pack what another rank needs to raise this error."""
    return None if error is None else (type(error), error.args, dict(vars(error)))
