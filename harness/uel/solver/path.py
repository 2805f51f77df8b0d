# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Newton's method with the load factor lam as a further unknown: loads and prescribed values are proportional to it.

Each iteration solves for two right-hand sides with one factorisation, k du_r = r and k du_lam = f_ref. The correction
is ddu = du_r + dlam du_lam, lam grows by dlam, and dlam follows from one more equation, the `Control`.

Symbols beside those of `newton`:

lam, dlam  change of the load factor in the increment so far, and its correction by an iteration
f_ref      (n,) change of f_ext per unit of lam; column 2 of RHS and the prescribed values, through k, add to it
u_ref      (n_p,) change of each prescribed unknown per unit of lam
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from uel.assembly import Constraints, System
from uel.elements import Call
from uel.model.arrays import FloatArray
from uel.solver.newton import DependentLoads, Factoriser, Iterate


@dataclass(frozen=True, slots=True)
class PathIncrement:
    """Definition of an increment along a path.

    call       arguments of the passes; the first one has LFLAGS(5) = 1 if there is a guess
    u          (n,) displacements at the start
    guess      (n,) extrapolated increment, and its lam; None: start from du = 0
    f_ext      (n,) external load at the start
    dependent  returns the loads at displacements (n,) and lam, in place of those of the call; None: there are none
    nrhs       NRHS of the passes
    """

    call: Call
    u: FloatArray
    guess: tuple[FloatArray, float] | None
    f_ext: FloatArray
    f_ref: FloatArray
    u_ref: FloatArray
    dependent: Callable[[FloatArray, float], DependentLoads] | None = None
    nrhs: int = 1


@dataclass(frozen=True, slots=True)
class PathIterate(Iterate):
    """An iterate with lam.

    df_ext  (n,) change with lam of the dependent loads and of those that elements report; None: there are none
    """

    lam: float = 0.0
    df_ext: FloatArray | None = None


@dataclass(frozen=True, slots=True)
class Directions:
    """Solutions of one iteration, (n,) each.

    du_r    correction at a fixed load factor
    du_lam  correction per unit of the load factor
    """

    du_r: FloatArray
    du_lam: FloatArray


class Control(Protocol):
    """The equation that fixes the load factor."""

    def change(self, state: PathIterate, directions: Directions, reaction: Reaction) -> float:
        """Return dlam of the iteration that follows `state`."""


class Reaction(Protocol):
    """Linearised reactions."""

    def __call__(self, ddu: FloatArray, dlam: float) -> FloatArray:
        """Return the change (n,) of the reactions by a correction of displacements and load factor."""


class PathFollower:
    """Newton iterations with a load factor."""

    def __init__(self, system: System, constraints: Constraints, solver: Factoriser) -> None:
        self._system = system
        self._constraints = constraints
        self._solver = solver

    def iterates(self, increment: PathIncrement, control: Control) -> Iterator[PathIterate]:
        """Iterate without end, as `Newton.iterates`; lam of each iterate satisfies the control."""
        first = increment.call
        du, lam = np.zeros_like(increment.u), 0.0
        if increment.guess is not None:
            du, lam = increment.guess
            first = first.extrapolated
        state = self._evaluate(first, increment, 0, du, np.zeros_like(du), lam)
        yield state
        while True:
            directions = self._directions(increment, state)
            dlam = control.change(state, directions, self._reaction(increment, state))
            ddu = directions.du_r + dlam * directions.du_lam
            state = self._evaluate(
                increment.call, increment, state.iteration + 1, state.du + ddu, ddu, state.lam + dlam
            )
            yield state

    def _evaluate(
        self, call: Call, increment: PathIncrement, iteration: int, du: FloatArray, ddu: FloatArray, lam: float
    ) -> PathIterate:
        call = replace(call, iteration=iteration)
        du = self._constraints.satisfy(increment.u, du)
        u, f_ext = increment.u + du, increment.f_ext + lam * increment.f_ref
        dependent = increment.dependent(u, lam) if increment.dependent is not None else None
        if dependent is not None:
            call, f_ext = replace(call, distributed=dependent.distributed), f_ext + dependent.f_ext
        evaluation = self._system.evaluate(call, u, du, nrhs=increment.nrhs)
        df_ext = evaluation.load
        if dependent is not None and dependent.df_ext is not None:
            df_ext = dependent.df_ext if df_ext is None else df_ext + dependent.df_ext
        r = evaluation.residual + f_ext
        self._constraints.update(u, r)
        r_q = self._constraints.reduce_vector(r)
        return PathIterate(iteration, du, ddu, r, r_q, evaluation, lam=lam, df_ext=df_ext)

    def _directions(self, increment: PathIncrement, state: PathIterate) -> Directions:
        k, constraints = state.evaluation.data, self._constraints
        assert k is not None
        self._solver.factorise(constraints.reduce_tangent(k))
        # prescribed values are proportional to lam, except for rounding
        ddu_p = state.lam * increment.u_ref - state.du[constraints.prescribed]
        r = state.r - constraints.prescribed_residual(k, ddu_p)
        du_r = constraints.expand(self._solver.solve(constraints.reduce_vector(r)), ddu_p)
        f_ref = self._reference_load(increment, state) - constraints.prescribed_residual(k, increment.u_ref)
        du_lam = constraints.expand(self._solver.solve(constraints.reduce_vector(f_ref)), increment.u_ref)
        return Directions(du_r, du_lam)

    @staticmethod
    def _reference_load(increment: PathIncrement, state: PathIterate) -> FloatArray:
        """Return the load (n,) per unit of lam, including the loads that elements report."""
        if state.df_ext is None or state.lam == 0.0:
            return increment.f_ref
        return increment.f_ref + state.df_ext / state.lam

    def _reaction(self, increment: PathIncrement, state: PathIterate) -> Reaction:
        k = state.evaluation.data
        assert k is not None

        # the next pass overwrites k; the function is called only before it
        def change(ddu: FloatArray, dlam: float) -> FloatArray:
            return self._constraints.reactions(dlam * increment.f_ref - self._system.product(k, ddu))

        return change
