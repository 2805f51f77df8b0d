# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Newton's method for one attempt at an increment, with the passes over the elements that Abaqus makes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from uel.assembly import Constraints, Evaluation, System
from uel.elements import Call, Distributed, Motion, Request
from uel.model.arrays import FloatArray
from uel.model.steps import LineSearchControls
from uel.solver.linesearch import search

ROUNDING = 16 * float(np.finfo(float).eps)
"""Relative error of differences of prescribed displacements."""


class Factoriser(Protocol):
    """Interface of a linear solver that Newton's method needs."""

    def factorise(self, data: FloatArray) -> None:
        """Take the CSR values of the reduced matrix."""

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve for one right-hand side."""

    def forget(self) -> None:
        """Forget earlier matrices, so that later solutions do not depend on them, to the bit."""


@dataclass(frozen=True, slots=True)
class Acting:
    """Forces from outside at certain displacements, where they depend on these or on a load factor.

    forces       (n,) on the nodes
    distributed  on elements and faces
    change       (n,) of the forces in the increment
    """

    forces: FloatArray
    distributed: Distributed | None
    change: FloatArray | None = None


@dataclass(frozen=True, slots=True)
class Increment:
    """Definition of an increment.

    call          of the passes after a solve; the first pass carries LFLAGS(5) = 1 if it starts from an extrapolation
    displacement  (n,) at the start
    guess         (n,) extrapolated increment; None: from the start state
    prescribed    (n_p,) increment of each prescribed unknown
    load          (n,) external load at the end
    acting        what acts besides, at displacements (n,), in place of the loads of the call; None: nothing does
    weight        of the forces at the end in their mean with those at the start, which is in equilibrium: by it count
                  the forces that act besides, and constraints act in the directions of its time
    damping       (nnz,) CSR values of a matrix whose product with the increment is also a force; None: no such force
    motion        velocities and accelerations at the end that go with an increment (n,); None: at rest
    """

    call: Call
    displacement: FloatArray
    guess: FloatArray | None
    prescribed: FloatArray
    load: FloatArray
    motion: Callable[[FloatArray], Motion] | None = None
    damping: FloatArray | None = None
    acting: Callable[[FloatArray], Acting] | None = None
    weight: float = 1.0


@dataclass(frozen=True, slots=True)
class Iterate:
    """State after an iteration: one solve and one pass over the elements; iteration 0 is the pass before the first.

    increment    (n,) increment so far
    correction   (n,) its change by this iteration
    residual     (n,) load + RHS; equilibrium is T^T residual = 0
    reduced      (n_q,) T^T residual
    line_search  scales tried, none if the full correction was taken without a search
    """

    iteration: int
    increment: FloatArray
    correction: FloatArray
    residual: FloatArray
    reduced: FloatArray
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
        # values of the matrix that the solver has factorised, and whether the next solve reuses it
        self._factorised: FloatArray | None = None
        self._again = self._anew = False
        self._pattern = system.indices

    def kept(self) -> FloatArray | None:
        """Return the CSR values of the last solve's matrix, which the next may reuse: a restart continues with it."""
        return self._factorised

    def resume(self, factorised: FloatArray | None) -> None:
        """Go on like a new object that has solved with this matrix: so do a run that was kept and its restart."""
        self._factorised, self._anew = factorised, True
        self._pattern = self._system.indices
        self._solver.forget()

    def iterates(self, given: Increment, *, same_matrix: bool = False) -> Iterator[Iterate]:
        """Iterate without end; the caller stops when it accepts or abandons the attempt.

        The first pass is at the start state, or at the extrapolated one. Prescribed values are not written into it:
        their missing part enters the linear system of iteration 1, so that the correction of all unknowns includes it.
        With `same_matrix` the first solve reuses the matrix of the last one. Raises KernelError and
        SingularMatrixError.
        """
        call = given.call
        self._again = same_matrix and self._factorised is not None
        if given.guess is None:
            increment, first = np.zeros_like(given.displacement), call
        else:
            increment, first = self._rounded(given, given.guess), call.extrapolated
        state = self._evaluate(first, given, 0, increment, np.zeros_like(increment))
        yield state
        missing = given.prescribed - increment[self._constraints.prescribed]
        while True:
            state = self._advance(given, state, missing)
            yield state
            missing = np.zeros_like(missing)

    def _rounded(self, given: Increment, guess: FloatArray) -> FloatArray:
        """Return the guess with the prescribed values where it differs from them only by rounding of the displacements.

        Otherwise the last bits, and thus the units, would decide whether a part of them is missing.
        """
        prescribed = self._constraints.prescribed
        total = np.abs(given.displacement[prescribed]) + np.abs(given.prescribed)
        close = np.abs(given.prescribed - guess[prescribed]) <= ROUNDING * total
        rounded = guess.copy()
        rounded[prescribed[close]] = given.prescribed[close]
        return rounded

    def _advance(self, given: Increment, state: Iterate, missing: FloatArray) -> Iterate:
        """Return the next iterate: a solve, a pass, and a line search if one is requested."""
        correction = self._correction(state, missing)
        return self._taken(given, state, correction, searchable=not missing.any())

    def _taken(self, given: Increment, state: Iterate, correction: FloatArray, *, searchable: bool) -> Iterate:
        """Apply a correction and return the state; scaling one that introduces prescribed values would miss them."""
        new = self._evaluate(given.call, given, state.iteration + 1, state.increment + correction, correction)
        if self._line_search.n_ls > 0 and searchable and new.evaluation.pnewdt >= 1.0:
            return self._searched(given, state, new)
        return new

    def _evaluate(
        self, call: Call, given: Increment, iteration: int, increment: FloatArray, correction: FloatArray
    ) -> Iterate:
        increment = self._constraints.place(given.displacement, increment)
        evaluation, load = self._pass(replace(call, iteration=iteration), given, increment)
        residual = evaluation.residual + load
        self._constraints.follow(given.displacement + increment, residual, increment, given.weight)
        reduced = self._constraints.reduce_vector(residual)
        return Iterate(iteration, increment, correction, residual, reduced, evaluation)

    def _correction(self, state: Iterate, missing: FloatArray) -> FloatArray:
        again = self._again and self._pattern is self._system.indices
        if not again:
            assert state.evaluation.data is not None
            # the memory of the last matrix first; a copy, as a pass overwrites the values of the one before
            self._factorised = None
            self._factorised, self._pattern = state.evaluation.data.copy(), self._system.indices
        assert self._factorised is not None
        if self._anew or not again:
            self._solver.factorise(self._constraints.reduce_tangent(self._factorised))
        self._again = self._anew = False
        rhs = state.reduced
        if missing.any():
            rhs = rhs - self._constraints.reduce_vector(
                self._constraints.prescribed_residual(self._factorised, missing)
            )
        return self._constraints.expand(self._solver.solve(rhs), missing)

    def _trial(self, given: Increment, increment: FloatArray) -> tuple[Evaluation, FloatArray]:
        """Make a pass for the residual alone, to which the constraints are set; return it with that residual."""
        increment = self._constraints.place(given.displacement, increment)
        evaluation, load = self._pass(given.call.asking(Request.RESIDUAL), given, increment, matrix=False)
        residual = evaluation.residual + load
        self._constraints.follow(given.displacement + increment, residual, increment, given.weight)
        return evaluation, residual

    def _pass(
        self, call: Call, given: Increment, increment: FloatArray, *, matrix: bool = True
    ) -> tuple[Evaluation, FloatArray]:
        motion, load = given.motion and given.motion(increment), given.load
        if given.acting is not None:
            acting = given.acting(given.displacement + increment)
            call, load = replace(call, distributed=acting.distributed), load + given.weight * acting.forces
        evaluation = self._system.evaluate(
            call, given.displacement + increment, increment, matrix=matrix, motion=motion
        )
        if given.damping is not None:
            evaluation.residual[:] -= self._system.product(given.damping, increment)
            if evaluation.data is not None:
                evaluation.data[:] += given.damping
        return evaluation, load

    def _searched(self, given: Increment, before: Iterate, full: Iterate) -> Iterate:
        """Return the state at the scale that line search finds; the last pass is a normal one at that scale."""
        direction = full.correction

        def component(scale: float) -> float:
            _, residual = self._trial(given, before.increment + scale * direction)
            return float(self._constraints.along(direction) @ residual)

        at_zero = float(direction @ before.residual)
        at_one = float(self._constraints.along(direction) @ full.residual)
        scale, tried = search(component, at_zero, at_one, self._line_search)
        if len(tried) == 1:
            return replace(full, line_search=tried)
        correction = scale * direction
        found = self._evaluate(given.call, given, full.iteration, before.increment + correction, correction)
        return replace(found, line_search=tried)
