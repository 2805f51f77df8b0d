# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Intel MKL PARDISO through pypardiso."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import Any, ClassVar, Final

import numpy as np
from scipy import sparse

from harness.model.arrays import FloatArray
from harness.solver.linear.base import LinearSolver, Pattern

UNSYMMETRIC_VALUES: Final = 1
"""PARDISO's matrix type: real, unsymmetric values on a symmetric pattern."""

ANALYSE, FACTORISE, SOLVE, RELEASE = 11, 22, 33, -1
"""PARDISO's phases."""


class PardisoSolver(LinearSolver):
    """PARDISO, the analysis kept between factorisations."""

    name: ClassVar[str] = "pardiso"
    module: ClassVar[str] = "pypardiso"
    distribution: ClassVar[str] = "pypardiso"
    widest_band: ClassVar[int] = 75

    def __init__(self, pattern: Pattern, name_of: Callable[[int], tuple[str, int]] | None = None) -> None:
        super().__init__(pattern, name_of)
        from pypardiso import PyPardisoSolver  # noqa: PLC0415 (loads MKL, and need not be installed)
        from pypardiso.pardiso_wrapper import PyPardisoError  # noqa: PLC0415

        self._error = PyPardisoError
        self._pardiso = PyPardisoSolver(mtype=UNSYMMETRIC_VALUES)
        self._matrix = pattern.matrix(np.zeros(len(pattern.indices)))
        self._unused = np.zeros(pattern.size)
        self._analysed = False

    def _call(self, phase: int, rhs: FloatArray) -> FloatArray:
        self._pardiso.set_phase(phase)
        # the documented way to run a single phase; solve() compares and copies the whole matrix first
        return np.asarray(self._pardiso._call_pardiso(self._matrix, rhs))

    def _factorise(self, data: FloatArray) -> float | None:
        # PARDISO refines its solutions with the values, so they have to outlive the caller's
        self._matrix.data[:] = data
        try:
            if not self._analysed:
                self._call(ANALYSE, self._unused)
                self._analysed = True
                weakref.finalize(self, _release, self._pardiso, self._matrix)
            self._call(FACTORISE, self._unused)
        except self._error:
            return 0.0
        return None

    def _solve(self, rhs: FloatArray) -> FloatArray:
        return self._call(SOLVE, np.ascontiguousarray(rhs))


def _release(pardiso: Any, matrix: sparse.csr_array) -> None:
    """Give back what MKL holds outside Python's memory."""
    pardiso.set_phase(RELEASE)
    pardiso._call_pardiso(matrix, np.zeros(matrix.shape[0]))
