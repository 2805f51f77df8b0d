# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""MUMPS through python-mumps."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar, Final

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray
from uel.solver.linear.linear_solver import LinearSolver, Pattern

NO_MEMORY: Final = (-5, -7, -13)
"""MUMPS' errors in INFOG(1): the memory for the analysis or the factorisation cannot be allocated."""


class MumpsSolver(LinearSolver):
    """MUMPS, with one analysis for all factorisations.

    Matrices are treated as symmetric until the first that is not.
    """

    name = "mumps"
    module: ClassVar[str] = "mumps"
    distribution: ClassVar[str] = "python-mumps"
    widest_band: ClassVar[tuple[int, int]] = (120, 600)

    def __init__(self, pattern: Pattern, name_of: Callable[[int], tuple[str, int]] | None = None) -> None:
        super().__init__(pattern, name_of)
        import mumps  # noqa: PLC0415 (need not be installed)

        self._new_context, self._error = mumps.Context, mumps.MUMPSError
        self._context: Any = None
        self._symmetric = True
        # positions of the entries that MUMPS gets
        self._taken: NDArray[np.int32] | slice = slice(None)

    def forget(self) -> None:
        """Discard earlier matrices and their analysis; the next one may be symmetric again."""
        super().forget()
        self._context, self._symmetric = None, True

    def _factorise(self, data: FloatArray) -> float | None:
        if self._symmetric and not self.pattern.is_symmetric(data):
            self._context, self._symmetric = None, False
        try:
            if self._context is None:
                self._context = self._new_context()
                # of a symmetric matrix it takes the upper triangle, in the order of the pattern
                self._context.set_matrix(self.pattern.matrix(data.copy()), symmetric=self._symmetric)
                self._taken = self.pattern.upper if self._symmetric else slice(None)
                self._context.analyze()
            # MUMPS reads the values without a copy
            self._context.data[:] = data[self._taken]
            self._context.factor(reuse_analysis=True)
        except self._error as error:
            self._context = None
            if error.error in NO_MEMORY:
                raise MemoryError from error
            return 0.0
        return None

    def _solve(self, rhs: FloatArray) -> FloatArray:
        if self._context is None:
            # the matrix has entries that are not finite, and no factors
            return np.full_like(rhs, np.nan)
        return np.asarray(self._context.solve(rhs))
