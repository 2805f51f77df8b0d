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
"""Seconds for which a rank that waits for others polls without a pause."""

_PAUSE: Final = 2e-4
"""Seconds of the pauses after that."""

_HELP: Final[tuple[bool, Any]] = (True, None)
"""Message of `call_helpers` to the other ranks in `lead`."""

_TOGETHER: Final = 10.0
"""Seconds to wait at the end after an error: if only one rank has met it, the others do not come."""


def begin(launch: Launch) -> Ranks:
    """Return the ranks to which this process belongs. Raises UsageError without what several ranks need."""
    return ALONE if launch.size == 1 else MpiRanks(launch)


class MpiRanks(Ranks):
    """The processes that `mpiexec` has started.

    A sum is formed on rank 0 and broadcast, so that all ranks have the same bits. MPI adds in the same order in each
    run on as many ranks.
    """

    token = ""

    def __init__(self, launch: Launch) -> None:
        """Start MPI. Raises UsageError without mpi4py, and where its MPI is not that of `mpiexec`."""
        # MPICH polls for messages without a pause; let it yield the core while there are none
        os.environ.setdefault("MPIR_CVAR_POLLS_BEFORE_YIELD", "1")
        try:
            import mpi4py  # noqa: PLC0415

            # `close` finalises, once all ranks are at the end: a rank that has failed would wait for the others
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
        self.token = self.broadcast(secrets.token_hex(4))
        slate = own_slate()
        if slate is not None:
            slate.token = self.token.encode()

    def sum(self, values: FloatArray) -> FloatArray:
        """Sum an array over the ranks, see `Ranks`."""
        total = np.empty_like(values)
        self._barrier()
        self.comm.Reduce(values, None if self.rank else total, self._mpi.SUM, 0)
        self.comm.Bcast(total, 0)
        return total

    def allgather(self, value: _T) -> list[_T]:
        """Gather the values of all ranks on each of them, see `Ranks`."""
        self._barrier()
        return list(self.comm.allgather(value))

    def gather(self, value: _T) -> list[_T]:
        """Gather the values of all ranks on rank 0, see `Ranks`; only this rank's where the others have ended."""
        if self._together is False:
            return [value]
        self._barrier()
        return self.comm.gather(value, 0) or []

    def broadcast(self, value: _T) -> _T:
        """Return the value of rank 0 on all ranks, see `Ranks`."""
        packed = np.frombuffer(pickle.dumps(value), dtype=np.uint8) if not self.rank else np.zeros(0, dtype=np.uint8)
        size = np.array([len(packed)])
        self._wait(self.comm.Ibcast(size, 0))
        packed = np.resize(packed, size[0])
        self._wait(self.comm.Ibcast(packed, 0))
        received: _T = pickle.loads(packed.tobytes())
        return received

    def exchange(self, parts: Sequence[np.ndarray[Any, np.dtype[_A]]]) -> list[np.ndarray[Any, np.dtype[_A]]]:
        """Send an array to each rank, see `Ranks`."""
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
        self._barrier()
        self.comm.Alltoallv((sent, counts), (received, incoming))
        return np.split(received, np.cumsum(incoming)[:-1])

    def agree(self, act: Callable[[], _T], order: Callable[[Exception], float] = lambda _: math.inf) -> _T:
        """Call a function on each rank, and raise an error of one on all of them, see `Ranks`."""
        failure: Exception | None = None
        try:
            result = act()
        except FAILURES as error:
            if error is self._known:
                # an inner `agree` has raised it on the other ranks too
                raise
            failure = error
        if not self.sum(np.array([float(failure is not None)]))[0]:
            return result
        own = None if failure is None else (order(failure), self.rank, _packed(failure))
        first = min((one for one in self.allgather(own) if one is not None), key=lambda one: one[:2])
        self._raise(first[2])
        raise AssertionError("unreachable")

    def on_rank_0(self, act: Callable[[], _T]) -> _T:
        """Call a function on rank 0 and broadcast its result or error, see `Ranks`."""
        failure: Exception | None = None
        result: _T | None = None
        try:
            result = None if self.rank else act()
        except FAILURES as error:
            failure = error
        packed, result = self.broadcast((_packed(failure), result))
        self._raise(packed)
        assert result is not None
        return result

    def _raise(self, packed: _Packed | None) -> None:
        """Raise a packed error, if there is one."""
        if packed is None:
            return
        kind, arguments, attributes = packed
        # not by the constructor, whose arguments differ from `args` of the error
        known: Exception = kind.__new__(kind, *arguments)
        known.__dict__.update(attributes)
        self._known = known
        raise known

    def in_turn(self, act: Callable[[], _T]) -> _T:
        """Call a function on rank 0, then on the others, see `Ranks`."""
        first = self.agree(lambda: None if self.rank else act())
        others = self.agree(lambda: act() if self.rank else None)
        result = others if self.rank else first
        assert result is not None
        return result

    def lead(self, act: Callable[[], None], help_out: Callable[[], object]) -> None:
        """Call `act` on rank 0 while the others help, see `Ranks`; rank 0 is alone where the others have ended."""
        if self._together is False:
            if not self.rank:
                act()
            return
        failure: Exception | None = None
        if self.rank:
            while (message := self.broadcast(_HELP))[0]:
                help_out()
            self._raise(message[1])
            return
        try:
            act()
        except FAILURES as error:
            if error is self._known:
                # `help_out` has raised it on the other ranks too
                raise
            failure = error
        self.broadcast((False, _packed(failure)))
        if failure is not None:
            self._known = failure
            raise failure

    def call_helpers(self) -> None:
        """Let the other ranks help, see `Ranks`. Raises OSError where they have ended."""
        if self._together is False:
            raise OSError("the other ranks have ended")
        self.broadcast(_HELP)

    def ended(self, error: BaseException | None) -> bool:
        """Return whether all ranks come to the end, see `Ranks`."""
        if self._together is None:
            self._together = not isinstance(error, KeyboardInterrupt) and self._all_end(wait=error is None)
        return self._together

    def before_end(self, act: Callable[[], None]) -> None:
        """Register a function for the end of MPI, see `Ranks`."""
        if act not in self._before_end:
            self._before_end.append(act)

    def close(self) -> None:
        """End MPI, see `Ranks`."""
        if self._together:
            for act in self._before_end:
                act()
            self._mpi.Finalize()

    def _all_end(self, *, wait: bool) -> bool:
        """Return whether all ranks come here; wait: for them without a limit of time."""
        request, until = self._at_end.Ibarrier(), time.monotonic() + _TOGETHER
        while not request.Test():
            if not wait and time.monotonic() > until:
                return False
            time.sleep(_PAUSE)
        return True

    def _barrier(self) -> None:
        """Wait until all ranks are here, since messages progress only while ranks poll for them."""
        self._wait(self.comm.Ibarrier())

    def _wait(self, request: Any) -> None:
        """Wait for a request with pauses between polls, since the ranks work for different times."""
        until = time.perf_counter() + _SPIN
        while not request.Test():
            if time.perf_counter() > until:
                time.sleep(_PAUSE)


_Packed = tuple[type[Exception], tuple[Any, ...], dict[str, Any]]
"""Class, arguments and attributes of an error."""


def _packed(error: Exception | None) -> _Packed | None:
    """Pack what another rank needs to raise this error."""
    return None if error is None else (type(error), error.args, dict(vars(error)))
