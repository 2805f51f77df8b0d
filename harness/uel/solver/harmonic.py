# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Complex systems by real solvers: each entry a + ib becomes the block (a, -b; b, a).

The real and the imaginary part of an unknown are numbered one after the other, so that a band stays a band.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from uel.model.arrays import ComplexArray, FloatArray
from uel.solver.linear import choose


class ComplexSolver:
    """Solver of complex systems of one symmetric CSR pattern; arguments as those of `uel.solver.linear.choose`.

    real  solver of the real systems
    """

    def __init__(
        self,
        name: str,
        indptr: NDArray[np.int32],
        indices: NDArray[np.int32],
        *,
        coordinates: FloatArray,
        name_of: Callable[[int], tuple[str, int]],
    ) -> None:
        self._pattern = indptr, indices
        doubled = self._doubled(np.zeros(len(indices), dtype=np.complex128))
        self.real = choose(
            name,
            doubled.indptr,
            doubled.indices,
            coordinates=np.repeat(coordinates, 2, axis=0),
            name_of=lambda unknown: name_of(unknown // 2),
        )

    def solve(self, data: ComplexArray, rhs: ComplexArray) -> ComplexArray:
        """Solve the system with these CSR values (nnz,) for (n,). Raises SingularMatrixError."""
        self.real.factorise(self._doubled(data).data)
        return self.real.solve(rhs.view(np.float64)).view(np.complex128)

    def _doubled(self, data: ComplexArray) -> sparse.csr_array:
        """Build the real matrix of twice the size."""
        indptr, indices = self._pattern
        entries = np.array([[data.real, -data.imag], [data.imag, data.real]]).transpose(2, 0, 1)
        size = 2 * (len(indptr) - 1)
        return sparse.bsr_array((entries, indices, indptr), shape=(size, size)).tocsr()
