# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What every linear solver offers: symbolic work once, numeric factorisation and solution often."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from harness.model.arrays import FloatArray
from harness.solver.linear.singular import refuse_singular

SUSPICIOUS = 1e-9
"""Ratio of the smallest pivot, or an estimate of it, to the largest diagonal entry below which a matrix is examined."""


@dataclass(frozen=True, slots=True)
class Pattern:
    """Sparsity of a square matrix with symmetric pattern.

    indptr, indices  CSR, int32, columns ascending in each row
    coordinates      (n, 3) of the node of each unknown, None if unknown; only orderings look at them
    """

    indptr: NDArray[np.int32]
    indices: NDArray[np.int32]
    coordinates: FloatArray | None = None

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return len(self.indptr) - 1

    @property
    def rows(self) -> NDArray[np.int32]:
        """(nnz,) row of each entry."""
        return np.repeat(np.arange(self.size, dtype=np.int32), np.diff(self.indptr))

    def matrix(self, data: FloatArray) -> sparse.csr_array:
        """Matrix with the given values, not copied."""
        return sparse.csr_array((data, self.indices, self.indptr), shape=(self.size, self.size))


class LinearSolver(ABC):
    """Factorises matrices of one pattern.

    name         by which it is requested
    module, distribution  that it needs: to import, and to install
    widest_band  half bandwidth up to which the band solver beats it, measured as in `choice`
    reason       why this solver was chosen, a phrase for the message file
    """

    name: ClassVar[str]
    module: ClassVar[str] = "scipy"
    distribution: ClassVar[str] = "scipy"
    widest_band: ClassVar[int] = 0

    def __init__(self, pattern: Pattern, name_of: Callable[[int], tuple[str, int]] | None = None) -> None:
        """Symbolic work.

        Parameters
        ----------
        pattern
            Of all matrices to be factorised.
        name_of
            Gives node name and dof of an unknown, for the message of a singular matrix; without it unknowns are
            numbered.
        """
        self.pattern = pattern
        self.reason = "requested"
        self._name_of = name_of or (lambda unknown: (f"of unknown {unknown}", 0))
        self._diagonal = np.flatnonzero(pattern.rows == pattern.indices)
        self._scale = 0.0
        self._data = np.zeros(0)
        self._pivot: float | None = None
        self._probed = False
        # the factors are those of the data, and no solution has shown that the matrix is singular
        self._regular = False
        self._passed = SUSPICIOUS

    def factorise(self, data: FloatArray) -> None:
        """Numeric factorisation of the matrix with these CSR values; nothing is done if they are those of the last one.

        Parameters
        ----------
        data
            (nnz,) in the order of the pattern. Not copied: the values must not change before the last `solve`, which
            looks at them again if the matrix may be singular.

        Raises
        ------
        SingularMatrixError
            The matrix is singular.
        """
        if not self.pattern.size:
            return
        if self._regular and data is not self._data and np.array_equal(data, self._data):
            self._data = data
            return
        self._regular = False
        self._scale = float(np.abs(data[self._diagonal]).max(initial=0.0))
        self._data = data
        self._pivot = self._factorise(data)
        if self._pivot is not None:
            self._examine(self._pivot)
        elif not self._probed:
            self._probed = True
            # a right-hand side without equilibrium reveals an unconstrained body even if no load moves it
            self.solve(np.where(np.random.default_rng(0).random(self.pattern.size) < 0.5, -1.0, 1.0))
        self._regular = True

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solution (n,) for one right-hand side (n,). Raises SingularMatrixError."""
        if not self.pattern.size:
            return np.zeros(0)
        solution = self._solve(rhs)
        if self._pivot is None:
            largest = float(np.abs(solution).max())
            self._examine(float(np.abs(rhs).max()) / largest if largest else np.inf)
        return solution

    def _examine(self, pivot: float) -> None:
        """Raise SingularMatrixError if the matrix is singular; `pivot` is its smallest pivot or an estimate."""
        ratio = pivot / self._scale if self._scale else 0.0
        if ratio > self._passed or not np.isfinite(self._data).all():
            return
        self._regular = False
        refuse_singular(self.pattern.matrix(self._data), self._name_of, certain=pivot == 0.0)
        self._regular = True
        # stiff but regular, as with an interface stiffness of 1e12: matrices like it are not examined again
        self._passed = 1e-2 * ratio

    @abstractmethod
    def _factorise(self, data: FloatArray) -> float | None:
        """Factorise the matrix with these CSR values; replaces earlier factors.

        Parameters
        ----------
        data
            (nnz,) in the order of the pattern, not empty; to be copied where it is needed later.

        Returns
        -------
        float | None
            Magnitude of the smallest pivot of the matrix as it is, not scaled; 0.0 if one is zero or the factorisation
            fails. None if the solver does not tell: then solutions are examined.
        """

    @abstractmethod
    def _solve(self, rhs: FloatArray) -> FloatArray:
        """Solution (n,) with the last factors for one right-hand side (n,), which is not changed."""
