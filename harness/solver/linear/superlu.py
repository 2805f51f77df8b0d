# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""SuperLU, the sparse solver of scipy: always there."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from harness.model.arrays import FloatArray
from harness.solver.linear.base import LinearSolver, Pattern


class SuperLUSolver(LinearSolver):
    """Minimum degree on the pattern of A + A^T in symmetric mode: half the time of the default column ordering."""

    name: ClassVar[str] = "superlu"

    def __init__(self, pattern: Pattern, name_of: Callable[[int], tuple[str, int]] | None = None) -> None:
        super().__init__(pattern, name_of)

    def _factorise(self, data: FloatArray) -> float | None:
        n = self.pattern.size
        # rows of A read as columns are A^T; solving with its transpose saves the conversion
        transposed = sparse.csc_array((data, self.pattern.indices, self.pattern.indptr), shape=(n, n))
        try:
            self._factors = splu(
                transposed, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.01, options={"SymmetricMode": True}
            )
        except RuntimeError:
            return 0.0
        return None

    def _solve(self, rhs: FloatArray) -> FloatArray:
        return np.asarray(self._factors.solve(rhs, "T"))
