# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""General steps: attempts at increments along a path, with the parts that the procedure adds."""

from __future__ import annotations

from collections.abc import Generator, Iterator, Sequence
from dataclasses import dataclass

from uel.errors import ConvergenceError, DistortionError, IncrementsUsedUpError, SingularMatrixError
from uel.interrupts import hold
from uel.model.records import (
    AttemptAbandoned,
    AttemptStarted,
    FieldCheck,
    IncrementDone,
    IterationDone,
    Noted,
    Record,
    SearchHelped,
    StateKept,
    StepDone,
    Warned,
)
from uel.model.restart import Saved
from uel.procedures.context import StepContext
from uel.procedures.general.convergence_checks import is_severe, was_linear
from uel.procedures.general.incrementation import (
    DISTORTED,
    TOO_MANY_INCREMENTS,
    Accuracy,
    Cutback,
    pnewdt_cutback,
    too_discontinuous,
)
from uel.procedures.general.largest_load import PASSED, LimitLoad
from uel.procedures.general.overconstraints import warn_overconstrained
from uel.procedures.general.path import Path
from uel.procedures.general.step_parts import Part
from uel.procedures.general.unconstrained import UNLOADED
from uel.solver.descent import ITERATIONS, SINGULAR
from uel.solver.newton import Iterate

SEARCH_TOO_LONG = f"THE DESCENT SEARCH HAS NOT CONVERGED IN {ITERATIONS} ITERATIONS."

SMALL_FLUX = (
    "THE AVERAGE {1} FLUX {0.average_flux:.3G} COUNTS AS ZERO BESIDE {0.time_average_flux:G}, WHICH IS TAKEN FOR "
    "ITS TIME AVERAGE UNTIL A LARGER ONE IS SEEN, AS IN ABAQUS: THE LARGEST RESIDUAL {0.residual.value:.3G} IS "
    "ACCEPTED. OTHER UNITS, OR AN INITIAL TIME AVERAGE FLUX (*CONTROLS, PARAMETERS=FIELD), MAKE RESULTS ACCURATE"
)


@dataclass(slots=True)
class IterationCounts:
    """Number of iterations of an attempt.

    severe        severe discontinuity iterations
    equilibrium   equilibrium iterations
    since_severe  equilibrium iterations since the last severe discontinuity iteration
    passes        passes that have begun
    """

    severe: int = 0
    equilibrium: int = 0
    since_severe: int = 0
    passes: int = 0

    @property
    def total(self) -> int:
        """Iterations of both kinds."""
        return self.severe + self.equilibrium

    def count(self, *, severe: bool) -> int:
        """Count an iteration; return its number among those of its kind."""
        if severe:
            self.severe, self.since_severe = self.severe + 1, 0
            return self.severe
        self.equilibrium, self.since_severe = self.equilibrium + 1, self.since_severe + 1
        return self.since_severe

    def count_unchecked(self) -> None:
        """Count the iteration whose pass ended the attempt; the first pass belongs to none."""
        self.equilibrium += self.passes - 1 > self.total


@dataclass(frozen=True, slots=True)
class Equilibrium:
    """End of an attempt that converged.

    last      state after the last iteration
    accuracy  accuracy of the integration over time; None: not measured
    checks    checks of the last iteration, all of which accept it
    """

    last: Iterate
    accuracy: Accuracy | None
    checks: Sequence[FieldCheck]


class GeneralStep:
    """General step, with the path of its increments and the parts of its procedure."""

    def __init__(self, context: StepContext, path: Path, parts: Sequence[Part] = ()) -> None:
        self._context = context
        self._path = path
        self._parts = parts
        self._system, self._step, self._state = context.system, context.step, context.state
        self._user, self._checker, self._control = context.user, context.checker, path.control
        self._limit = LimitLoad()
        self._resumed = False
        self._warned = False
        self._small: set[str] = set()

    @property
    def reached(self) -> tuple[tuple[float, float], float, int, int]:
        """Step and total time, no time increment, step and increment, as UEXTERNALDB gets them at the end."""
        return self._context.times, 0.0, self._step.number, self._context.increment

    def run(self) -> Generator[Record, None, None]:
        """Run the step and yield its records. Raises ConvergenceError, KernelError, SingularMatrixError."""
        context, cutbacks, iterations = self._context, 0, 0
        if not self._resumed:
            yield from self._start()
        if self._keeps and self._obstacle:
            yield Warned(f"*RESTART, WRITE HAS NO EFFECT IN STEP {self._step.number}: {self._obstacle}")
        if context.choice:
            yield Noted(context.choice)
        yield from warn_overconstrained(context.constraints)
        if context.advice:
            yield Warned(context.advice)
        while not self.finished:
            if context.increment == self._step.increments:
                limit = f"step {self._step.number}, INC={self._step.increments}"
                raise IncrementsUsedUpError(f"{TOO_MANY_INCREMENTS} ({limit})")
            context.increment += 1
            converged = False
            while not converged:
                converged, counts = yield from self._attempt(context.increment)
                cutbacks += not converged
                iterations += counts.total
        self.end(early=context.amplitudes.concluded)
        yield context.times_of_solver.note()
        yield StepDone(self._step.number, context.increment, cutbacks, iterations)

    def _start(self) -> Iterator[Record]:
        """Begin the step with its parts and its path."""
        for part in self._parts:
            begun = part.start()
            if begun.motion is not None:
                self._state.set_in_motion(begun.motion)
            yield from begun.remarks
        yield from self._path.start()

    @property
    def finished(self) -> bool:
        """True if no increment is left."""
        return self._path.finished or any(part.finished for part in self._parts)

    def end(self, *, early: bool = False) -> None:
        """End the step in the state; early: before its period."""
        concluded = self._context.step_time if early else None
        self._state.end_step(self._checker.histories(self._state.flux), concluded)

    @property
    def _keeps(self) -> bool:
        """True if *RESTART, WRITE asks for any state."""
        restart = self._step.restart
        return restart is not None and bool(restart.frequency or restart.intervals)

    @property
    def _obstacle(self) -> str:
        """Reason why *RESTART, WRITE cannot keep states; '' if it can."""
        amplitudes = "UAMP gives amplitudes" if self._state.amplitudes.exist else ""
        return self._system.obstacle or amplitudes or self._path.obstacle

    def _is_due(self, size: float) -> bool:
        """Return whether *RESTART, WRITE keeps the state at the end of an increment of this size."""
        restart, period = self._step.restart, self._step.procedure.period
        if restart is None or self._obstacle:
            return False
        after = self._context.step_time / period
        return restart.due(self._context.increment, after - size / period, after, last=self.finished)

    def _kept(self) -> Saved:
        """Return the state between two increments, for *RESTART."""
        context = self._context
        return {
            "step": self._step.number,
            "increment": context.increment,
            "step_time": context.step_time,
            "finished": self.finished,
            "beginning": context.beginning,
            "state": self._state.kept(),
            "system": self._system.kept(),
            "checks": self._checker.kept(),
            "path": self._path.kept(),
            "parts": [part.kept() for part in self._parts],
        }

    def resume(self, saved: Saved) -> None:
        """Restore what `_kept` returned, in place of the start of the step. Raises ValueError, KernelError."""
        context, state = self._context, self._state
        context.increment, context.step_time = saved["increment"], saved["step_time"]
        state.resume(saved["state"])
        call = context.call(0.0, context.step_time, state.total_time)
        self._system.restore_matrices(call, state.displacement, saved["system"])
        state.reach(state.total_time, call.predefined)
        self._checker.resume(saved["checks"])
        self._path.resume(saved["path"])
        for part, own in zip(self._parts, saved["parts"], strict=True):
            part.resume(own)
        self._resumed = True

    def _attempt(self, increment: int) -> Generator[Record, None, tuple[bool, IterationCounts]]:
        """Attempt an increment; return whether it converged, and the numbers of iterations."""
        context, number, size = self._context, self._step.number, self._control.attempt(self._context.step_time)
        times = context.times
        yield AttemptStarted(number, increment, self._control.attempts, *times, size)
        self._user.external_database(1, 0, times, size, number, increment)
        end = self._path.end(size)
        context.amplitudes.attempt(increment, (end, context.start + end), size, self._control.attempts - 1)
        iterates, extrapolated = self._path.begin(size)
        counts = IterationCounts()
        outcome: Equilibrium | Cutback
        try:
            outcome = yield from self._iterate(iterates, size, counts, extrapolated=extrapolated)
        except DistortionError as error:
            counts.count_unchecked()
            yield Warned(f"EXCESSIVE DISTORTION IN SOLID (CONTINUUM) ELEMENTS: {error}")
            outcome = Cutback(self._step.controls.time.d_h, DISTORTED, str(error))
        except SingularMatrixError as error:
            # after an extrapolation or an iteration the iterate has no stiffness, not the model
            cut = (extrapolated or counts.total) and not self._step.procedure.direct
            if not (self._control.in_parts or cut):
                raise
            outcome = Cutback(self._step.controls.time.d_f, SINGULAR, str(error))
        if isinstance(outcome, Cutback):
            yield from self._cut_back(outcome, increment, counts, size)
            return False, counts
        yield from self._note_small_flux(outcome.checks)
        yield from self._report_search(increment, counts.total)
        yield from self._converge(outcome, size, counts)
        return True, counts

    def _iterate(
        self, iterates: Iterator[Iterate], size: float, counts: IterationCounts, *, extrapolated: bool
    ) -> Generator[Record, None, Equilibrium | Cutback]:
        """Iterate to an equilibrium that is accurate enough, or to a cutback.

        Makes all passes of an attempt. Raises DistortionError and SingularMatrixError, which end it too.
        """
        cutback: Cutback | None = None
        while cutback is None:
            counts.passes += 1
            state = next(iterates)
            yield from self._warn_unconstrained()
            cutback = pnewdt_cutback(state.evaluation.pnewdt)
            if cutback is not None:
                counts.count_unchecked()
            elif state.iteration == 0:
                self._checker.start(state, extrapolated=extrapolated)
            else:
                checks = self._checker.check(state)
                number_of_kind = counts.count(severe=is_severe(state))
                yield IterationDone(number_of_kind, checks, state.line_search, state.evaluation.contact)
                if all(check.verdict.accepted for check in checks):
                    accuracy = self._accuracy(state, size)
                    inaccurate = self._control.too_inaccurate(accuracy, linear=was_linear(checks))
                    cutback = inaccurate or self._passed_limit(state, size)
                    if cutback is None:
                        return Equilibrium(state, accuracy, checks)
                else:
                    cutback = self._find_cutback(counts, checks)
        return cutback

    def _warn_unconstrained(self) -> Iterator[Warned]:
        """Warn, once in the step, that a part of the model is unconstrained."""
        free = self._context.solver.free
        if free is not None and not self._warned:
            self._warned = True
            yield Warned(UNLOADED.format(free))

    def _note_small_flux(self, checks: Sequence[FieldCheck]) -> Iterator[Noted]:
        """Note, once in the step, that unbalanced forces count as zero only by Abaqus' default."""
        for check in self._checker.assumed_zero_flux(checks):
            if check.field not in self._small:
                self._small.add(check.field)
                yield Noted(SMALL_FLUX.format(check, check.field.upper()))

    def _accuracy(self, last: Iterate, size: float) -> Accuracy | None:
        """Return the worst accuracy of the integration over time of all parts; None if no part measures it."""
        try:
            measured = [accuracy for part in self._parts if (accuracy := part.accuracy(last, size)) is not None]
        except (DistortionError, SingularMatrixError):
            if not self._step.procedure.direct:
                raise
            # fixed increments are not cut back
            return None
        return max(measured, key=lambda accuracy: accuracy.measure, default=None)

    @property
    def _search_used(self) -> bool:
        """True if the descent search took over in this attempt."""
        return self._path.search is not None and bool(self._path.search.reason)

    def _passed_limit(self, last: Iterate, size: float) -> Cutback | None:
        """Divide the increment into parts if the search passed the largest load in it."""
        external = -last.evaluation.residual
        if not self._search_used or not self._limit.passed(self._state.external, external, last.du, size):
            return None
        in_parts = self._control.part(self._context.step_time + size)
        return Cutback(self._step.controls.time.d_f, PASSED) if in_parts else None

    def _find_cutback(self, counts: IterationCounts, checks: Sequence[FieldCheck]) -> Cutback | None:
        """Return a cutback or None; with --fallback the search takes over instead, with more iterations."""
        search = self._path.search
        if search is None:
            return self._cutback_by_checks(counts, checks)
        if not search.reason:
            cutback = self._cutback_by_checks(counts, checks)
            if cutback is not None:
                search.take_over(counts.total + 1, cutback.reason)
        return Cutback(self._step.controls.time.d_c, SEARCH_TOO_LONG) if counts.total >= ITERATIONS else None

    def _cutback_by_checks(self, counts: IterationCounts, checks: Sequence[FieldCheck]) -> Cutback | None:
        """Return the cutback by the checks, or by the number of severe discontinuity iterations after one of these."""
        if counts.severe and not counts.since_severe:
            return too_discontinuous(counts.severe, self._step.controls.time, convert=self._step.convert_sdi)
        return self._checker.find_cutback(counts.since_severe, checks)

    def _report_search(self, increment: int, iterations: int) -> Iterator[SearchHelped]:
        """Yield a record if the search took over from Newton's method."""
        search = self._path.search
        if search is not None and search.reason:
            yield SearchHelped(self._step.number, increment, search.since, iterations, search.reason)

    def _converge(self, outcome: Equilibrium, size: float, counts: IterationCounts) -> Iterator[Record]:
        """Commit the state of the last pass, record the increment, and choose the next size."""
        last = outcome.last
        context, number, attempt = self._context, self._step.number, self._control.attempts
        moment = f"step {number}, increment {context.increment}"
        context.constraints.refuse_contradictions(self._state.displacement + last.du, moment)
        context.constraints.refuse_unbalanced(last.r)
        # from here on the states of the last increment are lost, and those of this one not yet recorded
        hold()
        self._system.commit()
        ends = [part.converged(last, size) for part in self._parts]
        reached = self._path.reach(last, size, outcome.checks)
        self._limit.converged(self._state.external, -last.evaluation.residual, last.du, size)
        self._state.accept(last, reached.load, reached.released, ends)
        self._checker.converged()
        context.amplitudes.converged()
        self._control.converged(
            counts.equilibrium,
            last.evaluation.pnewdt,
            searched=self._search_used,
            accuracy=outcome.accuracy,
            disturbed=counts.severe > self._most_severe,
        )
        times = reached.step_time, reached.total_time
        _, predefined = context.conditions.at(times, times, context.increment, self._user, context.coordinates)
        self._state.reach(reached.total_time, predefined)
        yield IncrementDone(
            number,
            context.increment,
            attempt,
            counts.equilibrium,
            *times,
            reached.size,
            self._state.solution(self._system),
            0.0 if context.amplitudes.concluded else self._control.next_size(context.step_time),
            reached.load_factor,
            severe=counts.severe,
        )
        for part_end in ends:
            yield from part_end.remarks
        restart = self._step.restart if self._is_due(reached.size) else None
        lrestart = restart.lrestart if restart else 0
        # may end the analysis after this increment
        self._user.external_database(2, lrestart, times, size, number, context.increment)
        if restart:
            # user routines have written their data for a restart before the state is kept
            yield StateKept(number, context.increment, restart.overlay, self._kept())

    @property
    def _most_severe(self) -> int:
        """Largest number of severe discontinuity iterations of an increment that counts as easy."""
        controls = self._step.controls.time
        return controls.i_j_c if self._step.convert_sdi else controls.i_j

    def _cut_back(self, cutback: Cutback, increment: int, counts: IterationCounts, size: float) -> Iterator[Record]:
        """Record the abandoned attempt; raise ConvergenceError if none is left."""
        number, attempt = self._step.number, self._control.attempts
        following, error = self._control.cut_back(cutback)
        times = self._context.times
        numbers = number, increment, attempt, counts.equilibrium
        yield AttemptAbandoned(*numbers, *times, size, following, cutback.reason, severe=counts.severe)
        if error:
            cause = f": {cutback.cause}" if cutback.cause else ""
            raise ConvergenceError(f"{error} (step {number}, increment {increment}, attempt {attempt}){cause}")
