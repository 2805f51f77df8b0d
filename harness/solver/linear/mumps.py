# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""MUMPS through python-mumps."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

import numpy as np

from harness.model.arrays import FloatArray
from harness.solver.linear.base import LinearSolver, Pattern


class MumpsSolver(LinearSolver):
    """MUMPS, the analysis kept between factorisations."""

    name: ClassVar[str] = "mumps"
    module: ClassVar[str] = "mumps"
    distribution: ClassVar[str] = "python-mumps"
    widest_band: ClassVar[tuple[int, int]] = (120, 300)

    def __init__(self, pattern: Pattern, name_of: Callable[[int], tuple[str, int]] | None = None) -> None:
        super().__init__(pattern, name_of)
        import mumps  # noqa: PLC0415 (need not be installed)

        self._error = mumps.MUMPSError
        self._context = mumps.Context()
        self._analysed = False

    def forget(self) -> None:
        """As that of other solvers; the analysis is made anew."""
        super().forget()
        self._analysed = False

    def _factorise(self, data: FloatArray) -> float | None:
        try:
            if not self._analysed:
                self._context.set_matrix(self.pattern.matrix(data.copy()))
                self._context.analyze()
                self._analysed = True
            # MUMPS reads the values in place: the array it was given, in the order of the pattern
            self._context.data[:] = data
            self._context.factor(reuse_analysis=True)
        except self._error:
            return 0.0
        return None

    def _solve(self, rhs: FloatArray) -> FloatArray:
        return np.asarray(self._context.solve(rhs))
