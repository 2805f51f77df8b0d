# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""SuperLU, the sparse solver of scipy, which is always available."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar, Final

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, SuperLU, gmres, splu

from uel.model.arrays import FloatArray, IntArray
from uel.solver.linear.linear_solver import LinearSolver, Pattern

SMALL_PIVOT: Final = 1e-6
"""Diagonal entry over the largest entry of its row below which it cannot be a pivot."""
MANY: Final = 0.01
"""Share of such entries above which an ordering by A + A^T does not bound the fill."""

FILL_PER_ITERATION: Final = 40
"""Mean number of entries of a column of the factors for which GMRES is allowed an iteration.

With 650 entries a column (27,000 unknowns of bricks) a factorisation takes as long as 47 solutions, with 120 (163,000
unknowns of quads) as 14. So GMRES ends after at most half of that time.
"""
FEWEST: Final = 8
"""Allowed iterations below which the matrix is factorised at once."""
LARGEST_SHARE: Final = 0.05
"""Largest share of changed entries for which the factors of an earlier matrix are kept."""
RESIDUAL: Final = 1e-11
"""Residual of GMRES over the right-hand side, a tenth of `ACCURATE`."""


class SuperLUSolver(LinearSolver):
    """SuperLU with a minimum degree ordering of A + A^T in symmetric mode, computed once.

    If many diagonal entries cannot be pivots, as with Lagrange multipliers, columns are ordered by COLAMD and any row
    may be the pivot: 12,000 unknowns of a public mixed element take 0.7 s instead of minutes in symmetric mode, with
    a seventh of the entries.

    Small panels (4 columns) and supernodes suit the small fronts of two-dimensional meshes. 12,000 unknowns of a double
    cantilever beam take 12 ms, with scipy's default ordering and panels 17 ms; 39,000 of a square 163 and 431 ms.

    In space, where a factorisation takes as long as dozens of solutions, the factors are kept if few entries change,
    and precondition GMRES with the new matrix. If it does not converge, the matrix is factorised.
    """

    name = "superlu"
    widest_band: ClassVar[tuple[int, int]] = (200, 600)

    def __init__(self, pattern: Pattern, name_of: Callable[[int], tuple[str, int]] | None = None) -> None:
        super().__init__(pattern, name_of)
        self._order: IntArray = np.zeros(0, dtype=np.int64)
        self._on_diagonal = True
        # the factors belong to an earlier matrix; allowed iterations
        self._behind, self._most = False, 0

    def forget(self) -> None:
        """Discard earlier matrices and their ordering."""
        super().forget()
        self._order = np.zeros(0, dtype=np.int64)

    def _factorise(self, data: FloatArray) -> float | None:
        try:
            if not len(self._order):
                self._on_diagonal = self._pivots_are_on_diagonal(data)
                ordering = "MMD_AT_PLUS_A" if self._on_diagonal else "COLAMD"
                indices, indptr = self.pattern.indices, self.pattern.indptr
                self._keep_order(_factors(data, indices, indptr, ordering, on_diagonal=self._on_diagonal))
            values = data[self._take]
            self._lu = _factors(values, self._indices, self._indptr, "NATURAL", on_diagonal=self._on_diagonal)
        except RuntimeError:
            return 0.0
        self._behind, self._most = False, int(self._lu.nnz / (self.pattern.size * FILL_PER_ITERATION))
        return None

    def _update(self, data: FloatArray, changed: IntArray) -> float | None:
        if self._most < FEWEST or len(changed) > LARGEST_SHARE * len(data):
            return self._factorise(data)
        self._behind = True
        self.effort.in_part += 1
        return None

    def _pivots_are_on_diagonal(self, data: FloatArray) -> bool:
        """Return whether few diagonal entries are small beside the largest one of their row."""
        largest = np.maximum.reduceat(np.abs(data), self.pattern.indptr[:-1])
        small = np.abs(self.pattern.matrix(data).diagonal()) < SMALL_PIVOT * largest
        return float(np.mean(small)) <= MANY

    def _keep_order(self, factors: SuperLU) -> None:
        """Renumber the pattern as SuperLU did, so that later factorisations need not order again."""
        order = np.empty(self.pattern.size, dtype=np.int64)
        order[factors.perm_c] = np.arange(self.pattern.size)
        entries = self.pattern.matrix(np.arange(len(self.pattern.indices), dtype=np.float64))
        ordered = sparse.csr_array(entries[order][:, order])
        ordered.sort_indices()
        self._order, self._take = order, ordered.data.astype(np.int64)
        self._indices, self._indptr = ordered.indices, ordered.indptr

    def _solve(self, rhs: FloatArray) -> FloatArray:
        if self._behind:
            last = LinearOperator((self.pattern.size,) * 2, matvec=self._solve_directly, dtype=np.float64)
            matrix = self.pattern.matrix(self._data)
            # a cycle of scipy ends by the preconditioned residual; a second, short one starts from the true residual
            solution, _ = gmres(matrix, rhs, M=last, rtol=RESIDUAL, restart=self._most, maxiter=2)
            if self._is_accurate(solution, rhs):
                return np.asarray(solution)
            self._repeat_in_full()
        return self._solve_directly(rhs)

    def _solve_directly(self, rhs: FloatArray) -> FloatArray:
        """Solve with the factors of this or an earlier matrix."""
        solution = np.empty_like(rhs)
        solution[self._order] = self._lu.solve(rhs[self._order], "T")
        return solution


def _factors(
    data: FloatArray, indices: NDArray[np.int32], indptr: NDArray[np.int32], ordering: str, *, on_diagonal: bool
) -> SuperLU:
    """Factorise A^T, whose columns are the rows of A, to save a conversion."""
    n = len(indptr) - 1
    return splu(
        sparse.csc_array((data, indices, indptr), shape=(n, n)),
        permc_spec=ordering,
        diag_pivot_thresh=0.01 if on_diagonal else 1.0,
        relax=4,
        panel_size=4,
        options={"SymmetricMode": on_diagonal},
    )
