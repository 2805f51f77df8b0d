# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Newton's method for one attempt, with the passes over the elements that Abaqus makes.

Symbols here and in the other files of this folder:

u          (n,) unknowns at the start of the increment: displacements, rotations, ...
du, ddu    (n,) their increment so far, and its correction by an iteration
du_p       (n_p,) increments of the prescribed unknowns
f_ext      (n,) external load
r, r_q     (n,) residual f_ext + RHS, and (n_q,) its reduction T^T r to the free unknowns
k          (nnz,) CSR values of the tangent, -dRHS/du: `Evaluation.data`
lam        load factor
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from uel.assembly import Constraints, Evaluation, System
from uel.elements import Call, Distributed, Motion, Request
from uel.model.arrays import FloatArray
from uel.model.controls import LineSearchControls
from uel.solver.linesearch import search

ROUNDING = 16 * float(np.finfo(float).eps)
"""Relative rounding error of differences of prescribed displacements."""


class Factoriser(Protocol):
    """Interface of a linear solver that Newton's method needs."""

    def factorise(self, data: FloatArray) -> None:
        """Factorise the reduced matrix with these CSR values."""

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve for one right-hand side."""

    def forget(self) -> None:
        """Discard earlier matrices, so that no bit of later solutions depends on them."""


@dataclass(frozen=True, slots=True)
class DependentLoads:
    """Loads that depend on displacements or on the load factor, at one value of these.

    f_ext        (n,) on the nodes
    distributed  on elements and faces
    df_ext       (n,) change of f_ext with the load factor in the increment
    """

    f_ext: FloatArray
    distributed: Distributed | None
    df_ext: FloatArray | None = None


@dataclass(frozen=True, slots=True)
class Increment:
    """Definition of an increment.

    call       arguments of the passes; the first one has LFLAGS(5) = 1 if there is a guess
    u          (n,) displacements at the start
    guess      (n,) extrapolated increment; None: start from du = 0
    du_p       (n_p,) increment of each prescribed unknown
    f_ext      (n,) external load at the end
    dependent  returns the loads at displacements (n,), in place of those of the call; None: loads do not depend on them
    weight     weight of the end of the increment in the equilibrium (1 + alpha in *DYNAMIC, otherwise 1); it scales the
               dependent loads, and constraints have the directions at that time
    damping    (nnz,) CSR values of a matrix whose product with du is an internal force; None without damping
    motion     returns velocities and accelerations at the end from du (n,); None: at rest
    """

    call: Call
    u: FloatArray
    guess: FloatArray | None
    du_p: FloatArray
    f_ext: FloatArray
    motion: Callable[[FloatArray], Motion] | None = None
    damping: FloatArray | None = None
    dependent: Callable[[FloatArray], DependentLoads] | None = None
    weight: float = 1.0


@dataclass(frozen=True, slots=True)
class Iterate:
    """State after an iteration: one solve and one pass over the elements; iteration 0 is the pass before the first.

    du           (n,) increment so far
    ddu          (n,) its correction by this iteration
    r, r_q       (n,) residual, and (n_q,) T^T r, which is zero in equilibrium
    line_search  scales that a line search tried; empty without a search
    """

    iteration: int
    du: FloatArray
    ddu: FloatArray
    r: FloatArray
    r_q: FloatArray
    evaluation: Evaluation
    line_search: tuple[float, ...] = ()


class Newton:
    """Newton iterations on a constrained system."""

    def __init__(
        self, system: System, constraints: Constraints, solver: Factoriser, line_search: LineSearchControls
    ) -> None:
        self._system = system
        self._constraints = constraints
        self._solver = solver
        self._line_search = line_search
        self._factorised: FloatArray | None = None
        # the next solve reuses the last matrix; it factorises it again all the same, after a restart
        self._reuse = self._refactorise = False
        self._pattern = system.indices

    def kept(self) -> FloatArray | None:
        """Return the CSR values of the last matrix, which the next solve may reuse, for *RESTART."""
        return self._factorised

    def resume(self, factorised: FloatArray | None) -> None:
        """Continue as after a solve with this matrix, in a run that keeps a state and in its restart alike."""
        self._factorised, self._refactorise = factorised, True
        self._pattern = self._system.indices
        self._solver.forget()

    def iterates(self, increment: Increment, *, same_matrix: bool = False) -> Iterator[Iterate]:
        """Iterate without end; the caller stops when it accepts or abandons the attempt.

        The first pass is at the start state, or at an extrapolation. It does not impose the prescribed values: the rest
        of du_p enters the linear system of iteration 1, so that the correction of all unknowns includes it. With
        `same_matrix` the first solve reuses the last matrix. Raises KernelError and SingularMatrixError.
        """
        call = increment.call
        self._reuse = same_matrix and self._factorised is not None
        if increment.guess is None:
            du, first = np.zeros_like(increment.u), call
        else:
            du, first = self._rounded(increment, increment.guess), call.extrapolated
        state = self._evaluate(first, increment, 0, du, np.zeros_like(du))
        yield state
        ddu_p = increment.du_p - du[self._constraints.prescribed]
        while True:
            state = self._advance(increment, state, ddu_p)
            yield state
            ddu_p = np.zeros_like(ddu_p)

    def _rounded(self, increment: Increment, guess: FloatArray) -> FloatArray:
        """Return the guess with exact prescribed values where it differs from them only by rounding.

        Otherwise the last bits, and thus the units, would decide whether a correction of them remains.
        """
        prescribed = self._constraints.prescribed
        total = np.abs(increment.u[prescribed]) + np.abs(increment.du_p)
        close = np.abs(increment.du_p - guess[prescribed]) <= ROUNDING * total
        rounded = guess.copy()
        rounded[prescribed[close]] = increment.du_p[close]
        return rounded

    def _advance(self, increment: Increment, state: Iterate, ddu_p: FloatArray) -> Iterate:
        """Return the next iterate: a solve, a pass, and a line search if one is requested.

        ddu_p  (n_p,) correction of the prescribed unknowns
        """
        ddu = self._correction(state, ddu_p)
        return self._apply(increment, state, ddu, searchable=not ddu_p.any())

    def _apply(self, increment: Increment, state: Iterate, ddu: FloatArray, *, searchable: bool) -> Iterate:
        """Apply a correction; searchable: line search may scale it, as it contains no prescribed values."""
        new = self._evaluate(increment.call, increment, state.iteration + 1, state.du + ddu, ddu)
        if self._line_search.n_ls > 0 and searchable and new.evaluation.pnewdt >= 1.0:
            return self._searched(increment, state, new)
        return new

    def _evaluate(self, call: Call, increment: Increment, iteration: int, du: FloatArray, ddu: FloatArray) -> Iterate:
        du = self._constraints.satisfy(increment.u, du)
        evaluation, f_ext = self._pass(replace(call, iteration=iteration), increment, du)
        r = evaluation.residual + f_ext
        self._constraints.update(increment.u + du, r, du, increment.weight)
        return Iterate(iteration, du, ddu, r, self._constraints.reduce_vector(r), evaluation)

    def _correction(self, state: Iterate, ddu_p: FloatArray) -> FloatArray:
        """Solve k ddu = r with the prescribed part ddu_p (n_p,); return ddu (n,)."""
        reuse = self._reuse and self._pattern is self._system.indices
        if not reuse:
            assert state.evaluation.data is not None
            # release the last matrix first; copy, because the next pass overwrites the values
            self._factorised = None
            self._factorised, self._pattern = state.evaluation.data.copy(), self._system.indices
        assert self._factorised is not None
        if self._refactorise or not reuse:
            self._solver.factorise(self._constraints.reduce_tangent(self._factorised))
        self._reuse = self._refactorise = False
        rhs = state.r_q
        if ddu_p.any():
            rhs = rhs - self._constraints.reduce_vector(self._constraints.prescribed_residual(self._factorised, ddu_p))
        return self._constraints.expand(self._solver.solve(rhs), ddu_p)

    def _trial(self, increment: Increment, du: FloatArray) -> tuple[Evaluation, FloatArray]:
        """Make a pass for the residual alone, and update the constraints; return the evaluation and r (n,)."""
        du = self._constraints.satisfy(increment.u, du)
        evaluation, f_ext = self._pass(increment.call.asking(Request.RESIDUAL), increment, du, matrix=False)
        r = evaluation.residual + f_ext
        self._constraints.update(increment.u + du, r, du, increment.weight)
        return evaluation, r

    def _pass(
        self, call: Call, increment: Increment, du: FloatArray, *, matrix: bool = True
    ) -> tuple[Evaluation, FloatArray]:
        """Make a pass over the elements; return the evaluation and f_ext (n,)."""
        motion, f_ext = increment.motion and increment.motion(du), increment.f_ext
        if increment.dependent is not None:
            dependent = increment.dependent(increment.u + du)
            call, f_ext = replace(call, distributed=dependent.distributed), f_ext + increment.weight * dependent.f_ext
        evaluation = self._system.evaluate(call, increment.u + du, du, matrix=matrix, motion=motion)
        if increment.damping is not None:
            evaluation.residual[:] -= self._system.product(increment.damping, du)
            if evaluation.data is not None:
                evaluation.data[:] += increment.damping
        return evaluation, f_ext

    def _searched(self, increment: Increment, before: Iterate, full: Iterate) -> Iterate:
        """Return the state at the scale found by line search, after a normal pass at that scale."""
        direction = full.ddu

        def component(scale: float) -> float:
            _, r = self._trial(increment, before.du + scale * direction)
            return float(self._constraints.project(direction) @ r)

        at_zero = float(direction @ before.r)
        at_one = float(self._constraints.project(direction) @ full.r)
        scale, tried = search(component, at_zero, at_one, self._line_search)
        if len(tried) == 1:
            return replace(full, line_search=tried)
        ddu = scale * direction
        scaled = self._evaluate(increment.call, increment, full.iteration, before.du + ddu, ddu)
        return replace(scaled, line_search=tried)
