# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Newton's method with the load factor as an unknown too: loads and prescribed values are proportional to it.

Each iteration solves for two right-hand sides with one factorisation, K c_r = r and K v = q, where q is the load per
unit of the factor (column 2 of RHS in it, and prescribed values through K). The correction is c_r + mu v, the factor
grows by mu, and mu follows from one more equation, the `Control`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from uel.assembly import Constraints, System
from uel.elements import Call
from uel.model.arrays import FloatArray
from uel.solver.newton import Acting, Factoriser, Iterate


@dataclass(frozen=True, slots=True)
class PathIncrement:
    """Definition of an increment along a path.

    call             of the passes after a solve
    displacement     (n,) at the start
    guess            (n,) extrapolated increment and its part of the factor; None: from the start state
    load             (n,) external load at the start
    load_rate        (n,) its change per unit of the factor
    prescribed_rate  (n_p,) change of each prescribed unknown per unit of the factor
    acting           what acts besides at displacements (n,) and a change of the factor, in place of the loads of the
                     call; None: nothing does
    nrhs             NRHS of the passes
    """

    call: Call
    displacement: FloatArray
    guess: tuple[FloatArray, float] | None
    load: FloatArray
    load_rate: FloatArray
    prescribed_rate: FloatArray
    acting: Callable[[FloatArray, float], Acting] | None = None
    nrhs: int = 1


@dataclass(frozen=True, slots=True)
class PathIterate(Iterate):
    """An iterate with the change of the load factor so far.

    added  (n,) by how much the loads that act besides, and those that elements apply, have changed with it; None: none
    """

    factor: float = 0.0
    added: FloatArray | None = None


@dataclass(frozen=True, slots=True)
class Directions:
    """Solutions of one iteration, (n,) each.

    particular  c_r, the correction at a fixed load factor
    tangent     v, per unit of the factor
    """

    particular: FloatArray
    tangent: FloatArray


class Control(Protocol):
    """The equation that fixes the load factor."""

    def change(self, state: PathIterate, directions: Directions, reaction: Reaction) -> float:
        """Return the change mu of the load factor in the iteration that follows `state`."""


class Reaction(Protocol):
    """Linearised reactions."""

    def __call__(self, correction: FloatArray, factor: float) -> FloatArray:
        """Return the change (n,) of the reactions by a correction and a change of the factor."""


class PathFollower:
    """Newton iterations with a load factor."""

    def __init__(self, system: System, constraints: Constraints, solver: Factoriser) -> None:
        self._system = system
        self._constraints = constraints
        self._solver = solver

    def iterates(self, given: PathIncrement, control: Control) -> Iterator[PathIterate]:
        """Iterate without end, as `Newton.iterates`; the factor of each iterate satisfies the control."""
        first = given.call
        increment, factor = np.zeros_like(given.displacement), 0.0
        if given.guess is not None:
            increment, factor = given.guess
            first = first.extrapolated
        state = self._evaluate(first, given, 0, increment, np.zeros_like(increment), factor)
        yield state
        while True:
            directions = self._directions(given, state)
            change = control.change(state, directions, self._reaction(given, state))
            correction = directions.particular + change * directions.tangent
            state = self._evaluate(
                given.call,
                given,
                state.iteration + 1,
                state.increment + correction,
                correction,
                state.factor + change,
            )
            yield state

    def _evaluate(
        self,
        call: Call,
        given: PathIncrement,
        iteration: int,
        increment: FloatArray,
        correction: FloatArray,
        factor: float,
    ) -> PathIterate:
        call = replace(call, iteration=iteration)
        increment = self._constraints.place(given.displacement, increment)
        at, load = given.displacement + increment, given.load + factor * given.load_rate
        acting = given.acting(at, factor) if given.acting is not None else None
        if acting is not None:
            call, load = replace(call, distributed=acting.distributed), load + acting.forces
        evaluation = self._system.evaluate(call, at, increment, nrhs=given.nrhs)
        added = evaluation.load
        if acting is not None and acting.change is not None:
            added = acting.change if added is None else added + acting.change
        residual = evaluation.residual + load
        self._constraints.follow(at, residual)
        reduced = self._constraints.reduce_vector(residual)
        return PathIterate(iteration, increment, correction, residual, reduced, evaluation, factor=factor, added=added)

    def _directions(self, given: PathIncrement, state: PathIterate) -> Directions:
        data, constraints = state.evaluation.data, self._constraints
        assert data is not None
        self._solver.factorise(constraints.reduce_tangent(data))
        # prescribed values follow the factor, except for rounding
        missing = state.factor * given.prescribed_rate - state.increment[constraints.prescribed]
        held = state.residual - constraints.prescribed_residual(data, missing)
        particular = constraints.expand(self._solver.solve(constraints.reduce_vector(held)), missing)
        pattern = self._load_rate(given, state) - constraints.prescribed_residual(data, given.prescribed_rate)
        tangent = constraints.expand(self._solver.solve(constraints.reduce_vector(pattern)), given.prescribed_rate)
        return Directions(particular, tangent)

    @staticmethod
    def _load_rate(given: PathIncrement, state: PathIterate) -> FloatArray:
        """Load per unit of the factor, including the loads that elements report."""
        if state.added is None or state.factor == 0.0:
            return given.load_rate
        return given.load_rate + state.added / state.factor

    def _reaction(self, given: PathIncrement, state: PathIterate) -> Reaction:
        data = state.evaluation.data
        assert data is not None

        # the next pass overwrites the values, but this is used only before it
        def change(correction: FloatArray, factor: float) -> FloatArray:
            return self._constraints.reactions(factor * given.load_rate - self._system.product(data, correction))

        return change
