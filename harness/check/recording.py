# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the elements of a deck are called with: the passes of an ordinary run, kept so that they can be made again."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from harness import usersub
from harness.assembly import Evaluation, System
from harness.deck import read_deck
from harness.elements import Block, Call, Motion, build_blocks
from harness.errors import ConvergenceError
from harness.model.arrays import FloatArray, IntArray
from harness.model.model import Model
from harness.model.records import IncrementDone
from harness.procedures import run_steps
from harness.solver.threads import one_blas_thread
from harness.usersub import Library


@dataclass(frozen=True, slots=True)
class Pass:
    """One call of all elements: U, DU, V and A (n,) of the system, whether AMATRX was wanted, and NRHS."""

    call: Call
    u: FloatArray
    du: FloatArray
    matrix: bool
    nrhs: int
    motion: Motion | None


@dataclass(frozen=True, slots=True)
class Commit:
    """End of a converged increment."""


@dataclass(frozen=True, slots=True)
class External:
    """A call of UEXTERNALDB."""

    lop: int
    lrestart: int
    time: tuple[float, float]
    dtime: float
    step: int
    increment: int


Event = Pass | Commit | External


@dataclass(frozen=True, slots=True)
class Recording:
    """A run of a deck, as the user routines saw it.

    user        the user's file, None for the project's elements
    events      in the order in which they happened
    equations   (m, unknowns of an element) position in U of each element unknown, per group
    increments  that converged
    stopped     why the run ended before the increments asked for; '' if it did not
    """

    model: Model
    user: Path | None
    events: tuple[Event, ...]
    equations: tuple[IntArray, ...]
    increments: int
    stopped: str


@contextmanager
def opened(model: Model, user: Path | None) -> Iterator[Library]:
    """The user routines, freshly loaded; what they print goes to a folder that is removed."""
    with tempfile.TemporaryDirectory() as folder:
        library = usersub.load(user, job=model.deck.stem, output_dir=Path(folder), deck=model.deck)
        try:
            yield library
        finally:
            library.close()


def record(deck: Path, user: Path | None, increments: int) -> Recording:
    """Run the first increments of a deck in Abaqus' order.

    A run that ends without convergence is recorded up to there. Raises the other errors of a run.
    """
    model = read_deck(deck)
    events: list[Event] = []
    done, stopped = 0, ""
    with opened(model, user) as library, one_blas_thread():
        system = _RecordedSystem(model, build_blocks(model, library), events)
        try:
            for happened in run_steps(system, model, _RecordedRoutines(library, events)):
                done += isinstance(happened, IncrementDone)
                if done == increments:
                    break
        except ConvergenceError as error:
            stopped = str(error)
        equations = tuple(system.dofs.equations_of(block).astype(np.int64) for block in system.blocks)
    return Recording(model, user, tuple(events), equations, done, stopped)


class _RecordedSystem(System):
    """A system that keeps what its elements are called with."""

    def __init__(self, model: Model, blocks: Sequence[Block], events: list[Event]) -> None:
        super().__init__(model.mesh, blocks, model.equations)
        self._events = events

    def evaluate(
        self,
        call: Call,
        u: FloatArray,
        du: FloatArray,
        *,
        matrix: bool = True,
        nrhs: int = 1,
        motion: Motion | None = None,
    ) -> Evaluation:
        self._events.append(Pass(call, u.copy(), du.copy(), matrix, nrhs, motion))
        return super().evaluate(call, u, du, matrix=matrix, nrhs=nrhs, motion=motion)

    def commit(self) -> None:
        self._events.append(Commit())
        super().commit()


class _RecordedRoutines:
    """User routines that a procedure calls, kept likewise."""

    def __init__(self, library: Library, events: list[Event]) -> None:
        self._library = library
        self._events = events

    def external_database(
        self, lop: int, lrestart: int, time: tuple[float, float], dtime: float, step: int, increment: int
    ) -> None:
        self._events.append(External(lop, lrestart, time, dtime, step, increment))
        self._library.external_database(lop, lrestart, time, dtime, step, increment)
