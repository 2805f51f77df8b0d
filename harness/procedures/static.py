# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*STATIC and *VISCO: increments of a step by Newton's method; the other procedures are variants of it."""

from __future__ import annotations

from collections.abc import Generator, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Protocol

import numpy as np

from harness.assembly import Constraints, System
from harness.elements import Call
from harness.errors import ConvergenceError, DeckError, DistortionError, IncrementsUsedUpError, SingularMatrixError
from harness.model.arrays import FloatArray
from harness.model.model import Model
from harness.model.records import (
    AttemptAbandoned,
    AttemptStarted,
    FieldCheck,
    IncrementDone,
    IterationDone,
    Noted,
    Record,
    SearchHelped,
    StepDone,
    Verdict,
    Warned,
)
from harness.model.steps import Step
from harness.model.user_values import GivesValues, UserValues
from harness.procedures.checks import Checker, length_of_moments
from harness.procedures.extrapolation import Extrapolation
from harness.procedures.incrementation import (
    DISTORTED,
    TOO_MANY_INCREMENTS,
    Abandoned,
    Accuracy,
    IncrementControl,
    refused,
)
from harness.procedures.limit import PASSED, LimitLoad
from harness.procedures.loads import fading_forces
from harness.procedures.state import State
from harness.procedures.unheld import UNLOADED, UnheldSolver
from harness.solver.descent import ITERATIONS, SINGULAR, Descent
from harness.solver.linear import LinearSolver, choose
from harness.solver.newton import Increment, Iterate, Newton

SEARCH_TOO_LONG = f"THE DESCENT SEARCH HAS NOT CONVERGED IN {ITERATIONS} ITERATIONS."

SMALL_FLUX = (
    "THE AVERAGE {1} FLUX {0.average_flux:.3G} COUNTS AS ZERO BESIDE {0.time_average_flux:G}, WHICH IS TAKEN FOR "
    "ITS TIME AVERAGE UNTIL A LARGER ONE IS SEEN, AS IN ABAQUS: THE LARGEST RESIDUAL {0.residual.value:.3G} IS "
    "ACCEPTED. OTHER UNITS, OR AN INITIAL TIME AVERAGE FLUX (*CONTROLS, PARAMETERS=FIELD), MAKE RESULTS ACCURATE"
)

NORMAL, MASS = 1, 4
"""LFLAGS(3): a normal call, and the mass matrix alone."""


class UserRoutines(GivesValues, Protocol):
    """The part of a loaded library that a procedure calls; sdvini: its address, None without the routine."""

    sdvini: int | None

    def external_database(
        self, lop: int, lrestart: int, time: tuple[float, float], dtime: float, step: int, increment: int
    ) -> None:
        """Call UEXTERNALDB if there is one."""


@dataclass(frozen=True, slots=True)
class Reached:
    """End of a converged increment.

    load, released  (n,) loads and fading forces
    size            change of the step time
    load_factor     where it is part of the solution
    """

    load: FloatArray
    released: FloatArray
    step_time: float
    total_time: float
    size: float
    load_factor: float | None = None


class StaticStep:
    """One static step."""

    def __init__(
        self,
        system: System,
        model: Model,
        step: Step,
        state: State,
        solver: str,
        user: UserRoutines,
        *,
        fallback: bool = False,
    ) -> None:
        """Takes over the step's prescribed values and loads; symbolic work is done again only where they differ."""
        self._system = system
        self._step = step
        self._state = state
        self._user = user
        self._control = IncrementControl(step.procedure, step.controls.time)
        self._prescribed = state.boundaries.start_step(step, state.displacement, state.total_time)
        self._load = state.loads.start_step(step, state.total_time, user)
        self._conditions = state.conditions.start_step(step, state.total_time)
        self._amplitudes = state.amplitudes.start_step(step, system.dofs, state, user)
        unknowns = state.boundaries.unknowns
        if len(state.boundaries.by_user) and user.disp is None:
            source = state.boundaries.sources[int(state.boundaries.by_user[0])]
            raise DeckError(source, "*BOUNDARY, USER needs DISP, which the job does not have")
        self._released = fading_forces(state.reaction, unknowns, step, state.unbalanced)
        state.unbalanced = np.zeros_like(state.unbalanced)
        constraints = state.constraints
        self._choice = ""
        if constraints is None or state.solver is None or not constraints.matches(unknowns, model.equations):
            constraints = Constraints(system, unknowns, model.equations, state.boundaries.sources)
            chosen = choose_solver(solver, constraints)
            # the search has an answer of its own to a singular matrix
            state.solver = chosen if fallback else UnheldSolver(chosen)
            self._choice = f"LINEAR SOLVER {chosen.name.upper()}: {chosen.reason}"
            state.majoriser.use(system, constraints, partial(choose_solver, solver, constraints))
        state.constraints = constraints
        line_search = step.controls.line_search
        self._descent: Descent | None = None
        if fallback:
            self._descent = Descent(system, constraints, state.solver, line_search, state.majoriser)
        self._newton = Newton(system, constraints, state.solver, line_search)
        length = length_of_moments(system, model.mesh)
        self._checker = Checker(system.dofs, constraints, step.controls, state.flux, length)
        self._extrapolation = Extrapolation(step.extrapolation)
        self._limit = LimitLoad()
        # size of the last increment, where its response was linear
        self._linear: float | None = None
        self._start = state.total_time
        self._time = 0.0
        self._increment = 0
        self._warned = False
        self._small: set[str] = set()

    @property
    def reached(self) -> tuple[tuple[float, float], float, int, int]:
        """Step and total time, no time increment, step and increment, as UEXTERNALDB gets them at the end."""
        return (self._time, self._state.total_time), 0.0, self._step.number, self._increment

    @property
    def _times(self) -> tuple[float, float]:
        """Step and total time at the start of the increment."""
        return self._time, self._start + self._time

    def _finished(self) -> bool:
        """Whether the step is complete."""
        return self._control.finished(self._time) or self._amplitudes.concluded

    def run(self) -> Iterator[Record]:
        """Records of the step. Raises ConvergenceError, KernelError, SingularMatrixError."""
        cutbacks, iterations = 0, 0
        if self._choice:
            yield Noted(self._choice)
        while not self._finished():
            if self._increment == self._step.increments:
                limit = f"step {self._step.number}, INC={self._step.increments}"
                raise IncrementsUsedUpError(f"{TOO_MANY_INCREMENTS} ({limit})")
            self._increment += 1
            converged = False
            while not converged:
                converged, spent = yield from self._attempt(self._increment)
                cutbacks += not converged
                iterations += spent
        if self._amplitudes.concluded:
            for given in (self._state.boundaries, self._state.loads, self._state.conditions):
                given.conclude(self._time)
        self._state.flux = self._checker.histories(self._state.flux)
        yield StepDone(self._step.number, self._increment, cutbacks, iterations)

    def _attempt(self, increment: int) -> Generator[Record, None, tuple[bool, int]]:
        """One attempt at an increment; returns whether it converged, and its iterations."""
        number, size = self._step.number, self._control.attempt(self._time)
        times = self._times
        yield AttemptStarted(number, increment, self._control.attempts, *times, size)
        self._user.external_database(1, 0, times, size, number, increment)
        end = self._end(size)
        self._amplitudes.attempt(increment, (end, self._start + end), size, self._control.attempts - 1)
        iterates, extrapolated = self._begin(increment, size)
        iteration, passes, abandoned = 0, 0, None
        while abandoned is None:
            try:
                state = next(iterates)
            except DistortionError as error:
                # the solve before the pass that failed counts too
                iteration = passes
                yield Warned(f"EXCESSIVE DISTORTION IN SOLID (CONTINUUM) ELEMENTS: {error}")
                abandoned = Abandoned(self._step.controls.time.d_h, DISTORTED, str(error))
                break
            except SingularMatrixError:
                if not self._control.in_parts:
                    raise
                abandoned = Abandoned(self._step.controls.time.d_f, SINGULAR)
                break
            iteration, passes = state.iteration, passes + 1
            yield from self._unheld()
            abandoned = refused(state.evaluation.pnewdt)
            if abandoned is None and iteration == 0:
                self._checker.start(state, extrapolated=extrapolated)
            elif abandoned is None:
                checks = self._checker.check(state)
                yield IterationDone(iteration, checks, state.line_search)
                if all(check.verdict.accepted for check in checks):
                    accuracy = self._accuracy(state, size)
                    abandoned = self._control.too_inaccurate(accuracy) or self._passed_limit(state, size)
                    if abandoned is None:
                        yield from self._small_flux(checks)
                        yield from self._help(increment, iteration)
                        self._linear = size if _is_linear(checks) else None
                        yield self._converge(state, increment, size, accuracy)
                        return True, iteration
                else:
                    abandoned = self._give_up(iteration, checks)
        yield from self._abandon(abandoned, increment, iteration, size)
        return False, iteration

    def _unheld(self) -> Iterator[Warned]:
        """Say once in the step that a part of the model moves freely."""
        solver = self._state.solver
        if isinstance(solver, UnheldSolver) and solver.free is not None and not self._warned:
            self._warned = True
            yield Warned(UNLOADED.format(solver.free))

    def _small_flux(self, checks: Sequence[FieldCheck]) -> Iterator[Noted]:
        """Say once in the step that forces count as zero, and are in no equilibrium, for Abaqus' default alone."""
        for check in self._checker.accepted_as_zero(checks):
            if check.field not in self._small:
                self._small.add(check.field)
                yield Noted(SMALL_FLUX.format(check, check.field.upper()))

    def _accuracy(self, last: Iterate, size: float) -> Accuracy | None:
        """How accurate the integration over time is, None where nothing measures it."""
        return None

    @property
    def _search(self) -> Descent | None:
        """The fall-back; none in a part of an increment, where the equilibrium near by is wanted and no other."""
        return None if self._control.in_parts else self._descent

    @property
    def _helped(self) -> bool:
        """Whether the descent search took over in this attempt."""
        return self._search is not None and bool(self._search.reason)

    def _passed_limit(self, last: Iterate, size: float) -> Abandoned | None:
        """Take the increment in parts where the search passed the largest load in it."""
        external = -last.evaluation.residual
        if not self._helped or not self._limit.passed(self._state.external, external, last.increment, size):
            return None
        in_parts = self._control.part(self._time + size)
        return Abandoned(self._step.controls.time.d_f, PASSED) if in_parts else None

    def _give_up(self, iteration: int, checks: Sequence[FieldCheck]) -> Abandoned | None:
        """Whether to abandon the attempt; with the fall-back the search takes over instead, and is given its time."""
        if self._search is None:
            return self._checker.give_up(iteration, checks)
        if not self._search.reason:
            abandoned = self._checker.give_up(iteration, checks)
            if abandoned is not None:
                self._search.take_over(iteration + 1, abandoned.reason)
        return Abandoned(self._step.controls.time.d_c, SEARCH_TOO_LONG) if iteration >= ITERATIONS else None

    def _help(self, increment: int, iterations: int) -> Iterator[SearchHelped]:
        """Say that Newton's method alone did not do."""
        if self._search is not None and self._search.reason:
            since, reason = self._search.since, self._search.reason
            yield SearchHelped(self._step.number, increment, since, iterations, reason)

    def _begin(self, increment: int, size: float) -> tuple[Iterator[Iterate], bool]:
        """Iterates of an attempt, and whether they start from an extrapolation."""
        given = self._given(increment, size)
        if self._search is not None:
            return self._search.iterates(given), given.guess is not None
        # Abaqus does not form the matrix anew where the response was linear in the increment before; its public message
        # files show that for increments of one size
        again = self._linear == size and self._control.attempts == 1
        return self._newton.iterates(given, same_matrix=again), given.guess is not None

    def _given(self, increment: int, size: float) -> Increment:
        """What the end of the increment prescribes."""
        state = self._state
        end = self._end(size)
        total = self._start + end
        unknowns = state.boundaries.unknowns
        self._load.increment = increment
        return Increment(
            call=self._call(increment, size, end, total),
            displacement=state.displacement,
            guess=self._extrapolation.guess(size),
            prescribed=(self._prescribed_at(increment, end, total) - state.displacement)[unknowns],
            load=self._load.at(end, total) + self._released.at(end, total),
        )

    def _prescribed_at(self, increment: int, step_time: float, total_time: float) -> FloatArray:
        """Prescribed values (n,), those of DISP among them."""
        values, by_user = self._prescribed.at(step_time, total_time), self._state.boundaries.by_user
        if len(by_user):
            dofs = self._system.dofs
            nodes = dofs.node[by_user]
            places = np.stack([dofs.mesh.labels[nodes], dofs.dof[by_user]], axis=1).astype(np.int32)
            time, coords = (step_time, total_time), dofs.mesh.coordinates[nodes]
            asked = UserValues("DISP", self._step.number, increment, time, places, coords, values[by_user])
            values[by_user] = self._user.user_values(asked)
        return values

    def _call(self, increment: int, size: float, step_time: float, total_time: float) -> Call:
        """Arguments of the passes of an increment that ends at these times."""
        step = self._step
        end = step_time, total_time
        distributed, predefined = self._conditions.at(self._times, end)
        return Call(
            lflags=(step.procedure.lflag, int(step.nlgeom), NORMAL, 0, 0),
            step=step.number,
            increment=increment,
            step_time=step_time,
            total_time=total_time,
            time_increment=size,
            period=step.procedure.period,
            distributed=self._load.with_pressures(distributed, self._times, end),
            predefined=predefined,
            flux_floor=self._checker.flux_floor,
        )

    def _end(self, size: float) -> float:
        end = self._time + size
        return self._step.procedure.period if self._control.finished(end) else end

    def _reach(self, last: Iterate, size: float) -> Reached:
        """Where a converged increment ends."""
        end = self._end(size)
        total = self._start + end
        self._extrapolation.converged(last.increment, size)
        self._time = end
        return Reached(self._load.at(end, total), self._released.at(end, total), end, total, size)

    def _converge(self, last: Iterate, increment: int, size: float, accuracy: Accuracy | None) -> IncrementDone:
        """Commit what the last pass left, and choose the next increment."""
        number, attempt = self._step.number, self._control.attempts
        self._system.commit()
        reached = self._reach(last, size)
        self._limit.converged(self._state.external, -last.evaluation.residual, last.increment, size)
        self._state.accept(last, reached.load, reached.released)
        self._checker.converged()
        self._amplitudes.converged()
        self._control.converged(last.iteration, last.evaluation.pnewdt, searched=self._helped, accuracy=accuracy)
        self._state.total_time = reached.total_time
        self._state.predefined = self._conditions.at(self._times, self._times)[1]
        times = reached.step_time, reached.total_time
        self._user.external_database(2, 0, times, size, number, increment)
        return IncrementDone(
            number,
            increment,
            attempt,
            last.iteration,
            *times,
            reached.size,
            self._state.solution(self._system),
            0.0 if self._amplitudes.concluded else self._control.following(self._time),
            reached.load_factor,
        )

    def _abandon(self, abandoned: Abandoned, increment: int, iterations: int, size: float) -> Iterator[Record]:
        """Report the attempt; raise ConvergenceError where no other is left."""
        number, attempt = self._step.number, self._control.attempts
        following, error = self._control.abandon(abandoned)
        times = self._times
        yield AttemptAbandoned(number, increment, attempt, iterations, *times, size, following, abandoned.reason)
        if error:
            cause = f": {abandoned.cause}" if abandoned.cause else ""
            raise ConvergenceError(f"{error} (step {number}, increment {increment}, attempt {attempt}){cause}")


def _is_linear(checks: Sequence[FieldCheck]) -> bool:
    """Whether the response was linear in an increment that these checks accept: as far as there are fluxes."""
    verdicts = {check.verdict for check in checks}
    return Verdict.LINEAR in verdicts and verdicts <= {Verdict.LINEAR, Verdict.ZERO_FLUX}


def choose_solver(name: str, constraints: Constraints) -> LinearSolver:
    """Linear solver for the matrices of free unknowns; name as `harness.solver.linear.choose` takes it."""
    return choose(
        name,
        constraints.reduced_indptr,
        constraints.reduced_indices,
        coordinates=constraints.coordinates,
        name_of=constraints.name_of,
    )
