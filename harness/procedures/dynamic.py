# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*DYNAMIC: implicit integration by the operator of Hilber, Hughes and Taylor, or by backward Euler.

Abaqus Theory Guide, "Implicit dynamic analysis": M a + (1 + alpha) (I - P) at the end - alpha (I - P) at the start = 0.
Elements put M a and their I with these weights into RHS, the step weights its loads P.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from harness.assembly import Evaluation, System
from harness.elements import Call, Motion
from harness.model.arrays import FloatArray
from harness.model.model import Model
from harness.model.procedures import Dynamic, Integrator
from harness.model.records import Record
from harness.model.steps import Step
from harness.procedures.incrementation import Accuracy
from harness.procedures.state import State
from harness.procedures.static import Reached, StaticStep, UserRoutines
from harness.solver.newton import RESIDUAL_ONLY, Increment, Iterate

INITIAL_ACCELERATION = 6
"""LFLAGS(3) of the pass for mass and residual at the start of the step."""

HALF_INCREMENT = "THE HALF-INCREMENT RESIDUAL IS LARGER THAN ITS TOLERANCE."


def advance(procedure: Dynamic, before: Motion, size: float, increment: FloatArray) -> Motion:
    """Velocities and accelerations at the end of an increment of displacement (n,), from those at its start."""
    velocity, acceleration = before.velocity, before.acceleration
    if procedure.integrator is Integrator.BACKWARD_EULER:
        new = increment / size
        return Motion(new, (new - velocity) / size)
    beta, gamma = procedure.beta, procedure.gamma
    after = (increment - size * velocity - (0.5 - beta) * size**2 * acceleration) / (beta * size**2)
    return Motion(velocity + size * ((1.0 - gamma) * acceleration + gamma * after), after)


class DynamicStep(StaticStep):
    """One dynamic step."""

    def __init__(
        self,
        system: System,
        model: Model,
        step: Step,
        procedure: Dynamic,
        state: State,
        solver: str,
        user: UserRoutines,
    ) -> None:
        super().__init__(system, model, step, state, solver, user)
        self._procedure = procedure
        self._previous_load = self._load_at(0.0)

    def run(self) -> Iterator[Record]:
        """Records of the step, after the accelerations at its start."""
        if self._procedure.initial_acceleration:
            self._accelerate()
        yield from super().run()

    def _accelerate(self) -> None:
        """Solve M a = P - I for the accelerations at the start; unknowns without mass have none."""
        state, constraints = self._state, self._state.constraints
        assert constraints is not None and state.solver is not None
        call = self._call(1, 0.0, 0.0, self._start)
        call = replace(call, lflags=(*call.lflags[:2], INITIAL_ACCELERATION, *call.lflags[3:]))
        motion = Motion(state.velocity, np.zeros_like(state.velocity))
        still = np.zeros_like(state.displacement)
        evaluation = self._system.evaluate(call, state.displacement, still, motion=motion)
        assert evaluation.data is not None
        load = self._load_at(0.0)
        mass = constraints.reduce(evaluation.data)
        reduced = constraints.reduce_vector(evaluation.residual + load)
        indptr, indices = constraints.reduced_indptr, constraints.reduced_indices
        row = np.repeat(np.arange(len(reduced)), np.diff(indptr))
        weightless = np.bincount(row, np.abs(mass), minlength=len(reduced)) == 0.0
        mass[(row == indices) & weightless[row]] = 1.0
        reduced[weightless] = 0.0
        state.solver.factorise(mass)
        state.acceleration = constraints.expand(state.solver.solve(reduced), np.zeros(len(constraints.prescribed)))
        self._system.commit()
        state.energy, state.external = evaluation.energy, load + state.reaction

    def _call(self, increment: int, size: float, step_time: float, total_time: float) -> Call:
        params = self._procedure.alpha, self._procedure.beta, self._procedure.gamma
        return replace(super()._call(increment, size, step_time, total_time), params=params)

    def _load_at(self, step_time: float) -> FloatArray:
        total = self._start + step_time
        return self._load.at(step_time, total) + self._released.at(step_time, total)

    def _motion(self, size: float, increment: FloatArray) -> Motion:
        before = Motion(self._state.velocity, self._state.acceleration)
        return advance(self._procedure, before, size, increment)

    def _given(self, increment: int, size: float) -> Increment:
        given = super()._given(increment, size)
        alpha, state = self._procedure.alpha, self._state
        load = (1.0 + alpha) * given.load - alpha * self._load_at(self._time)
        guess = given.guess
        if self._step.extrapolation == "VELOCITY PARABOLIC":
            guess = size * state.velocity + 0.5 * size**2 * state.acceleration
        return replace(given, guess=guess, load=load, motion=partial(self._motion, size))

    def _accuracy(self, last: Iterate, size: float) -> Accuracy | None:
        """The half-increment residual: forces out of balance in the middle of the increment."""
        procedure = self._procedure
        if not (procedure.half_force or np.isfinite(procedure.half_increment)):
            return None
        evaluation = self._half_increment(last, size)
        middle = self._time + 0.5 * size
        alpha = procedure.alpha
        start = self._load_at(self._time)
        load = (1.0 + alpha) * self._load_at(middle) - 0.5 * alpha * (start + self._previous_load)
        return Accuracy(self._checker.largest_ratio(evaluation.residual + load, self._tolerances()), HALF_INCREMENT)

    def _tolerances(self) -> dict[str, float]:
        """Tolerance of the half-increment residual by field; only forces and moments have one."""
        procedure = self._procedure
        means = {name: mean for name, mean in self._checker.time_averages().items() if name in ("force", "moment")}
        if procedure.half_force:
            return dict.fromkeys(means, procedure.half_force)
        return {name: procedure.half_increment * mean for name, mean in means.items()}

    def _half_increment(self, last: Iterate, size: float) -> Evaluation:
        """Pass at half the increment, over which accelerations are linear."""
        state, half = self._state, 0.5 * size
        end = self._motion(size, last.increment)
        # the cubic from the state at the start to the displacements at the end
        increment = last.increment / 8 + 0.375 * size * state.velocity + size**2 / 16 * state.acceleration
        velocity = 0.75 / size * last.increment + 0.25 * state.velocity - size / 8 * state.acceleration
        acceleration = 0.5 * (state.acceleration + end.acceleration)
        call = self._call(self._increment, size, self._time + half, self._start + self._time + half)
        call = replace(call, lflags=(*call.lflags[:2], RESIDUAL_ONLY, *call.lflags[3:]))
        motion = Motion(velocity, acceleration)
        return self._system.evaluate(call, state.displacement + increment, increment, matrix=False, motion=motion)

    def _reach(self, last: Iterate, size: float) -> Reached:
        self._previous_load = self._load_at(self._time)
        motion = self._motion(size, last.increment)
        reached = super()._reach(last, size)
        self._state.velocity, self._state.acceleration = motion.velocity, motion.acceleration
        return reached
