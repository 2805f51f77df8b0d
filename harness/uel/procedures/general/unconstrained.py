# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Models with an unconstrained part on which no force acts in the direction in which it is free to move.

Abaqus warns of a numerical singularity and goes on. So does a step here: of all solutions, which differ by free
motions, it takes one with small displacements. If a force acts in a free direction there is no solution, and the step
ends with the error of the linear solver. Forces that the convergence criteria count as zero (R_l) do not matter: those
of an increment that the extrapolation has solved are rounding alone, of which no solution balances any part.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from scipy import sparse

from uel.errors import SingularMatrixError
from uel.model.arrays import FloatArray
from uel.solver.linear import LinearSolver, StepSolver

SHIFT = 1e-10
"""Stiffness that is added where there is none, as a fraction of the largest entry of each row."""

LOADED = 1e-6
"""Fraction of a right-hand side that no solution balances, above which the singular matrix is an error."""

REFINEMENTS = 3
"""Number of corrections of a solution for the added stiffness, which affects a soft, constrained part more."""

Renew = Callable[[], LinearSolver | None]

UNLOADED = "{}. NO FORCE ACTS ON THE FREE PART, WHICH GETS SMALL DISPLACEMENTS"


class UnconstrainedSolver(StepSolver):
    """A linear solver that accepts singular matrices if the right-hand side has a solution all the same."""

    def __init__(self, solver: LinearSolver, renew: Renew | None = None) -> None:
        """Prepare the solver; renew: gives another one where the pattern of the matrices has changed, else None."""
        self._solver, self._renew = solver, renew
        self.name, self.reason, self.advice = solver.name, solver.reason, solver.advice
        self._singular: SingularMatrixError | None = None
        self._matrix = sparse.csr_array((0, 0))
        self._stand_ins: Iterator[FloatArray] = iter(())

    def factorise(self, data: FloatArray) -> None:
        """Take the CSR values of the reduced matrix. Raises SingularMatrixError if it has no stiffness at all."""
        self._singular = self.free = None
        if self._renew is not None:
            self._solver = self._renew() or self._solver
        self._matrix = self._solver.pattern.matrix(data)
        self._stand_ins = self._stiffnesses()
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
                # some solvers notice only now
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
        """Factorise with the first stiffness that makes the matrix regular."""
        self._singular = self._singular or error
        self.free = str(self._singular)
        for stiffness in self._stand_ins:
            shifted = self._matrix.data.copy()
            shifted[self._solver.pattern.diagonal] += stiffness
            try:
                return self._solver.factorise(shifted)
            except SingularMatrixError:
                continue
        raise error

    def _stiffnesses(self) -> Iterator[FloatArray]:
        """Yield stiffnesses to add: first only for unknowns without any stiffness, where its size does not matter."""
        largest = abs(self._matrix).max(axis=1).toarray().ravel()
        empty = np.where(largest > 0.0, 0.0, largest.max(initial=0.0))
        if empty.any():
            yield empty
        yield empty + SHIFT * largest
