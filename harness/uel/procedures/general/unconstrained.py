# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Models with an unconstrained part on which no force acts in the directions in which it is free to move.

Abaqus warns of a numerical singularity and continues. So does a step here: of all solutions, which differ by free
motions, it takes one with small displacements. If a force acts in a free direction there is no solution, and the step
ends with the error of the linear solver. Forces that the convergence criteria count as zero (R_l) are neglected: after
an extrapolation that solves an increment, all forces are rounding errors, which no solution balances.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from scipy import sparse

from uel.errors import SingularMatrixError
from uel.model.arrays import FloatArray
from uel.solver.linear import LinearSolver, StepSolver

SHIFT = 1e-10
"""Stiffness added to each diagonal entry, over the largest entry of its row."""

LOADED = 1e-6
"""Unbalanced part of a right-hand side above which the singular matrix is an error."""

REFINEMENTS = 3
"""Corrections of a solution for the added stiffness, which matters more in soft, constrained parts."""

Renew = Callable[[], LinearSolver | None]

UNLOADED = "{}. NO FORCE ACTS ON THE FREE PART, WHICH GETS SMALL DISPLACEMENTS"


class UnconstrainedSolver(StepSolver):
    """Linear solver that accepts singular matrices if the right-hand side has a solution."""

    def __init__(self, solver: LinearSolver, renew: Renew | None = None) -> None:
        """Wrap a solver; renew: returns another one if the pattern of the matrices has changed, else None."""
        self._solver, self._renew = solver, renew
        self.name, self.reason, self.advice = solver.name, solver.reason, solver.advice
        self._singular: SingularMatrixError | None = None
        self._matrix = sparse.csr_array((0, 0))
        self._candidates: Iterator[FloatArray] = iter(())

    def factorise(self, data: FloatArray) -> None:
        """Factorise the reduced matrix with these CSR values. Raises SingularMatrixError if it is all zero."""
        self._singular = self.free = None
        if self._renew is not None:
            self._solver = self._renew() or self._solver
        self._matrix = self._solver.pattern.matrix(data)
        self._candidates = self._added_stiffnesses()
        try:
            self._solver.factorise(data)
        except SingularMatrixError as error:
            self._shift(error)

    def forget(self) -> None:
        """Forget earlier matrices, as the solver does."""
        self._solver.forget()

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve for one right-hand side. Raises SingularMatrixError if it has no solution."""
        while True:
            try:
                solution = self._solver.solve(rhs)
                break
            except SingularMatrixError as error:
                # some solvers detect a singular matrix only here
                self._shift(error)
        if self._singular is None:
            return solution
        small = self.negligible()
        if np.abs(rhs).max() <= small:
            return np.zeros_like(rhs)
        for _ in range(1 + REFINEMENTS):
            r = rhs - self._matrix @ solution
            if np.linalg.norm(r) <= LOADED * np.linalg.norm(rhs) or np.abs(r).max() <= small:
                return solution
            solution += self._solver.solve(r)
        raise self._singular

    def _shift(self, error: SingularMatrixError) -> None:
        """Factorise with the first added stiffness that makes the matrix regular."""
        self._singular = self._singular or error
        self.free = str(self._singular)
        for stiffness in self._candidates:
            shifted = self._matrix.data.copy()
            shifted[self._solver.pattern.diagonal] += stiffness
            try:
                return self._solver.factorise(shifted)
            except SingularMatrixError:
                continue
        raise error

    def _added_stiffnesses(self) -> Iterator[FloatArray]:
        """Yield stiffnesses to add: first for unknowns without any stiffness only, where their size does not matter."""
        largest = abs(self._matrix).max(axis=1).toarray().ravel()
        empty = np.where(largest > 0.0, 0.0, largest.max(initial=0.0))
        if empty.any():
            yield empty
        yield empty + SHIFT * largest
