# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Recording of a run, from which the calls of its elements can be repeated."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from uel import usersub
from uel.assembly import Contributors, Evaluation, System
from uel.deck import read_deck
from uel.elements import Call, Flags, Motion, Request
from uel.errors import (
    ConvergenceError,
    ElementError,
    IncrementsUsedUpError,
    KernelError,
    NotFiniteError,
    UelError,
    note_warnings,
)
from uel.model.arrays import FloatArray, IntArray
from uel.model.model import Model
from uel.model.procedures import Static
from uel.model.records import AttemptAbandoned, IncrementDone
from uel.output.earlier_jobs import EarlierJobs
from uel.procedures import run_steps
from uel.solver.threads import one_blas_thread
from uel.usersub import Library, names_line, trap


@dataclass(frozen=True, slots=True)
class Pass:
    """Pass over all elements: U, DU, V and A (n,) of the system, whether AMATRX is requested, and NRHS."""

    call: Call
    u: FloatArray
    du: FloatArray
    matrix: bool
    nrhs: int
    motion: Motion | None

    @property
    def normal(self) -> bool:
        """True if it requests RHS and AMATRX in an iteration of a general step; in a linear step RHS is a
        perturbation.
        """
        return self.call.flags.request is Request.NORMAL and not self.call.flags.linear and self.matrix


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
class Build:
    """Options for compiling the user's files, see `usersub.load`."""

    zero_locals: bool = False
    debug: bool = False


_ORDINARY: Final = Build()


@dataclass(frozen=True, slots=True)
class Recording:
    """A run of a deck as the user routines saw it.

    user        the user's files, none for the project's elements
    events      in chronological order
    equations   (m, unknowns of an element) position in U of each element unknown, per group
    increments  that converged
    stopped     reason for an end before the requested increments; '' if there is none or the deck has no more
    failure     error of an element that ended the run, None if none did
    ending      any error that ended the run; None if INC= of a step did and all attempts converged
    unset       error that ends a run with the previous contents in uninitialised local variables; '' if there is none,
                else these are zero in this run and in all further calls
    build       used to repeat the calls
    """

    model: Model
    user: tuple[Path, ...]
    events: tuple[Event, ...]
    equations: tuple[IntArray, ...]
    increments: int
    stopped: str
    failure: ElementError | None = None
    unset: str = ""
    ending: UelError | None = None
    build: Build = _ORDINARY


@contextmanager
def opened(model: Model, user: Sequence[Path], build: Build = _ORDINARY) -> Iterator[Library]:
    """Load the user routines anew, with their printed output in a temporary folder.

    The warnings of the deck and the compilers are added to an error as notes.
    """
    with tempfile.TemporaryDirectory() as folder:
        library = usersub.load(
            user or None,
            job=model.deck.stem,
            output_dir=Path(folder),
            deck=model.deck,
            zero_locals=build.zero_locals,
            debug=build.debug,
        )
        try:
            yield library
        except UelError as error:
            warnings = [message.text for message in library.messages() if message.kind == "warning"]
            note_warnings(error, [*model.warnings, *warnings])
            raise
        finally:
            library.close()


def record_leniently(deck: Path, user: Sequence[Path], increments: int) -> Recording:
    """Call `record`, not strict; repeat it with zero in local variables without a value if these make NaN."""
    recording, error = None, None
    try:
        recording = record(deck, user, increments, strict=False)
        error = recording.failure
    except KernelError as raised:
        error = raised
    if error is None or not user:
        assert recording is not None
        return recording
    if isinstance(error, NotFiniteError):
        with suppress(UelError):
            again = record(deck, user, increments, strict=False, build=Build(zero_locals=True))
            if again.failure is None:
                return replace(again, unset=str(error), build=Build(zero_locals=True))
    error = _with_location(error, deck, user, increments)
    if recording is None:
        raise error
    return replace(recording, failure=error, stopped=str(error))


def _with_location(error: ElementError, deck: Path, user: Sequence[Path], increments: int) -> ElementError:
    """Add file and line to the error, if a build that stops at the first mistake tells them."""
    if names_line(str(error)):
        return error
    message_of_debug = ""
    trapping = trap(True)
    try:
        failure: UelError | None = record(deck, user, increments, strict=False, build=Build(debug=True)).failure
        message_of_debug = str(failure or "")
    except UelError as raised:
        message_of_debug = str(raised)
    finally:
        trap(trapping)
    if not names_line(message_of_debug):
        return error
    kind, number = error.element_type, error.element
    message = str(error).removeprefix(f"element {number} (type {kind}): ")
    placed = type(error)(number, kind, f"{message}; in a build with run-time checks: {message_of_debug}")
    for note in getattr(error, "__notes__", ()):
        placed.add_note(note)
    return placed


def record(
    deck: Path, user: Sequence[Path], increments: int, *, strict: bool = True, build: Build = _ORDINARY
) -> Recording:
    """Run the first increments of a deck in Abaqus' order.

    A run that ends without convergence is recorded up to there. Raises the other errors of a run; if not strict, only
    those before the first pass is complete, and writes outside arrays are not errors.
    """
    model = read_deck(deck, earlier=EarlierJobs([Path(), deck.parent]))
    events: list[Event] = []
    done, abandoned = 0, 0
    stopped = ""
    ending: UelError | None = None
    with opened(model, user, build) as library, one_blas_thread():
        system = _RecordedSystem(model, Contributors.of(model, library, strict=strict), events)
        try:
            for happened in run_steps(system, model, _RecordedRoutines(library, events)):
                done += isinstance(happened, IncrementDone)
                abandoned += isinstance(happened, AttemptAbandoned)
                if done == increments:
                    break
        except IncrementsUsedUpError as error:
            stopped, ending = str(error), error if abandoned else None
        except ConvergenceError as error:
            stopped, ending = str(error), error
        except UelError as error:
            if strict or not any(isinstance(event, Pass) and event.normal for event in events):
                raise
            stopped, ending = str(error), error
        equations = tuple(system.dofs.equations_of(block).astype(np.int64) for block in system.blocks)
    if not any(isinstance(event, Pass) and event.normal for event in events):
        events.append(_general(events))
    failure = ending if isinstance(ending, ElementError) else None
    return Recording(model, tuple(user), tuple(events), equations, done, stopped, failure, ending=ending)


def _general(events: Sequence[Event]) -> Pass:
    """Return a static call in the state of the last call, for decks whose steps are linear perturbations."""
    last = [event for event in events if isinstance(event, Pass)][-1]
    call = replace(last.call, flags=Flags(Static().lflag, last.call.flags.nlgeom))
    return replace(last, call=call, matrix=True, du=np.zeros_like(last.du), nrhs=1)


class _RecordedSystem(System):
    """System that records the arguments of its elements."""

    def __init__(self, model: Model, contributors: Contributors, events: list[Event]) -> None:
        super().__init__(model.mesh, contributors, model.equations)
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
        try:
            return super().evaluate(call, u, du, matrix=matrix, nrhs=nrhs, motion=motion)
        except KernelError:
            # only complete passes can be repeated
            self._events.pop()
            raise

    def commit(self) -> None:
        self._events.append(Commit())
        super().commit()


class _RecordedRoutines:
    """User routines that record the calls of a procedure."""

    def __init__(self, library: Library, events: list[Event]) -> None:
        self.sdvini, self.sigini, self.orient = library.sdvini, library.sigini, library.orient
        self.disp, self.dload, self.uamp = library.disp, library.dload, library.uamp
        self.utemp, self.ufield = library.utemp, library.ufield
        self.user_values, self.user_amplitude = library.user_values, library.user_amplitude
        self._library = library
        self._events = events

    def external_database(
        self, lop: int, lrestart: int, time: tuple[float, float], dtime: float, step: int, increment: int
    ) -> None:
        self._events.append(External(lop, lrestart, time, dtime, step, increment))
        self._library.external_database(lop, lrestart, time, dtime, step, increment)
