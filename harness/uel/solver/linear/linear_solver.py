# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Base of linear solvers: symbolic work once, then factorisations and solutions."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from functools import cached_property
from typing import ClassVar, Final

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from uel.model.arrays import FloatArray, IntArray
from uel.solver.linear.singular import refuse_singular

SUSPICIOUS: Final = 1e-9
"""Ratio of the smallest pivot, or an estimate of it, to the largest diagonal entry below which a matrix is examined."""

ACCURATE: Final = 1e-10
"""Backward error of a solution above which factors renewed in part are rejected.

Relative to the right-hand side, or to the terms of each row. Measured: below 2e-13 of the right-hand side.
"""

LARGEST_PART: Final = 0.4
"""Share of changed entries above which factorising in part saves no time with any solver."""

SYMMETRIC: Final = 1e-13
"""Difference of a_ij and a_ji, over the root of |a_ii a_jj|, that counts as rounding.

It is the backward error of a factorisation. Measured: 3e-15 in elastic bodies, 5e-2 with stabilised elements.
"""

CHUNK: Final = 2**20
"""Entries compared at a time, so that copies take little memory."""


def in_chunks(count: int) -> Iterator[slice]:
    """Return the slices of `CHUNK` entries."""
    return (slice(start, start + CHUNK) for start in range(0, count, CHUNK))


@dataclass(frozen=True)
class Pattern:
    """Sparsity of a square matrix with symmetric pattern.

    indptr, indices  CSR, int32, columns ascending in each row
    coordinates      (n, 3) of the node of each unknown, for orderings and multigrid; None if not known
    dofs             (n,) as Abaqus numbers them, for multigrid; None if not known
    """

    indptr: NDArray[np.int32]
    indices: NDArray[np.int32]
    coordinates: FloatArray | None = None
    dofs: IntArray | None = None

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return len(self.indptr) - 1

    @property
    def in_space(self) -> bool:
        """True unless the nodes lie in one coordinate plane or have no coordinates."""
        return self.size > 0 and self.coordinates is not None and bool((np.ptp(self.coordinates, axis=0) > 0.0).all())

    @property
    def rows(self) -> NDArray[np.int32]:
        """Row (nnz,) of each entry."""
        return np.repeat(np.arange(self.size, dtype=np.int32), np.diff(self.indptr))

    @property
    def upper(self) -> NDArray[np.int32]:
        """Positions of the entries on and above the diagonal."""
        return np.flatnonzero(self.indices >= self.rows).astype(np.int32)

    @cached_property
    def diagonal(self) -> IntArray:
        """Positions (n,) of the diagonal entries among all entries."""
        return np.flatnonzero(self.rows == self.indices)

    @cached_property
    def transposed(self) -> NDArray[np.int32]:
        """Position (nnz,) of entry (j, i) for each entry (i, j)."""
        positions = np.arange(len(self.indices), dtype=np.int32)
        # the conversion sorts entries of a column by row
        return np.asarray(sparse.csr_array((positions, self.indices, self.indptr), (self.size,) * 2).tocsc().data)

    def matrix(self, data: FloatArray) -> sparse.csr_array:
        """Return the matrix with these values (nnz,), not copied."""
        return sparse.csr_array((data, self.indices, self.indptr), shape=(self.size, self.size))

    def rows_of(self, entries: IntArray) -> IntArray:
        """Return the rows of the entries at some positions."""
        return np.searchsorted(self.indptr, entries, side="right") - 1

    def is_symmetric(self, data: FloatArray, entries: IntArray | None = None) -> bool:
        """Report whether a matrix is symmetric to rounding, `SYMMETRIC`.

        Parameters
        ----------
        data
            (nnz,) values.
        entries
            Positions to compare; None: all.
        """
        size = np.sqrt(np.abs(data[self.diagonal]))
        if entries is None:
            # A x - A^T x detects most unsymmetric matrices without the positions of all transposed entries
            x = np.where(np.random.default_rng(0).random(self.size) < 0.5, -1.0, 1.0)
            matrix = self.matrix(data)
            bound = 2.0 * SYMMETRIC * size * size.max(initial=0.0) * np.diff(self.indptr)
            if (np.abs(matrix @ x - x @ matrix) > bound).any():
                return False
        count = len(data) if entries is None else len(entries)
        for part in in_chunks(count):
            some = np.arange(*part.indices(count))
            if entries is not None:
                some = entries[some]
            differences = np.abs(data[some] - data[self.transposed[some]])
            if not (differences <= SYMMETRIC * size[self.rows_of(some)] * size[self.indices[some]]).all():
                return False
        return True


@dataclass(slots=True)
class Effort:
    """Work of a linear solver.

    factorisations  number of factorisations
    in_part         factorisations that renewed the factors only where the matrix had changed
    refused         factorisations in part that were repeated in full because a solution was not accurate
    solutions       right-hand sides
    factorising, solving  CPU seconds
    """

    factorisations: int = 0
    in_part: int = 0
    refused: int = 0
    solutions: int = 0
    factorising: float = 0.0
    solving: float = 0.0

    def __sub__(self, earlier: Effort) -> Effort:
        return Effort(*(getattr(self, one.name) - getattr(earlier, one.name) for one in fields(self)))


def is_accurate(residual: FloatArray, rhs: FloatArray, terms: Callable[[], FloatArray]) -> bool:
    """Return whether the backward error of a solution is at most `ACCURATE`; a solution with NaN passes.

    Parameters
    ----------
    residual, rhs
        (n,) residual of the solution, and right-hand side.
    terms
        Returns the sum (n,) of the magnitudes of the terms of each row.
    """
    error = np.abs(residual)
    if not error.max() > ACCURATE * np.abs(rhs).max():
        return True
    # in a stiff part the residual is as large as the rounding error of its terms
    return not (error > ACCURATE * (terms() + np.abs(rhs))).any()


class StepSolver(ABC):
    """Linear solver of a general step, in one process or on all ranks; it may accept singular matrices.

    name         name by which a user requests the solver
    reason       reason why this solver was chosen, a phrase for the message file
    advice       sentence that names a faster solver; '' if there is none
    free         message on an unconstrained part of the model, if the solver accepts it; None without one
    negligible   returns the force on such a part that counts as zero in the current step
    """

    name: str
    reason: str = "requested"
    advice: str = ""
    free: str | None = None
    negligible: Callable[[], float] = float

    @abstractmethod
    def factorise(self, data: FloatArray) -> None:
        """Factorise the matrix with these CSR values. Raises SingularMatrixError."""

    @abstractmethod
    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve for one right-hand side (n,). Raises SingularMatrixError."""

    def forget(self) -> None:  # noqa: B027
        """Discard earlier matrices, except the symbolic work, so that no bit of later solutions depends on them."""

    def release(self) -> None:  # noqa: B027
        """Free the memory of the factors, if the end of the solver does not."""


class LinearSolver(StepSolver):
    """Solver that factorises matrices of one pattern.

    module, distribution  module that the solver imports, and the package that provides it
    widest_band  half bandwidths, in the plane and in space, up to which the band solver beats it, see `choice`
    effort       counts and times of its work so far
    """

    module: ClassVar[str] = "scipy"
    distribution: ClassVar[str] = "scipy"
    widest_band: ClassVar[tuple[int, int]] = (0, 0)

    def __init__(self, pattern: Pattern, name_of: Callable[[int], tuple[str, int]] | None = None) -> None:
        """Do the symbolic work.

        Parameters
        ----------
        pattern
            Pattern of all matrices.
        name_of
            Returns node name and dof of an unknown, for the message of a singular matrix; None: the message has the
            number of the unknown.
        """
        self.pattern = pattern
        self.effort = Effort()
        self._name_of = name_of or (lambda unknown: (f"of unknown {unknown}", 0))
        self._scale = 0.0
        self._data = np.zeros(0)
        self._pivot: float | None = None
        self._probed = False
        # the factors belong to the data, and the matrix has not turned out singular
        self._regular = False
        self._passed = SUSPICIOUS
        # the next solution verifies the factors; if they are inaccurate, all later factorisations are in full
        self._unverified = False
        self._trusted = True

    def factorise(self, data: FloatArray) -> None:
        """Factorise the matrix with these CSR values, where they differ from the last ones.

        Parameters
        ----------
        data
            (nnz,) in the order of the pattern.

        Raises
        ------
        SingularMatrixError
            The matrix is singular.
        """
        if not self.pattern.size:
            return
        changed: IntArray | None = None
        if self._regular:
            different = data != self._data
            count = np.count_nonzero(different)
            if not count:
                return
            if self._trusted and count <= LARGEST_PART * len(data):
                changed = np.flatnonzero(different)
        self._regular = self._unverified = False
        if len(self._data):
            self._data[:] = data
        else:
            self._data = data.copy()
        self._scale = float(np.abs(data[self.pattern.diagonal]).max(initial=0.0))
        start = time.process_time()
        self._pivot = self._factorise(self._data) if changed is None else self._update(self._data, changed)
        self.effort.factorising += time.process_time() - start
        self.effort.factorisations += 1
        if self._pivot is not None:
            self._examine(self._pivot)
        elif not self._probed:
            self._probed = True
            # a random right-hand side reveals an unconstrained body even if no load moves it
            self.solve(np.where(np.random.default_rng(0).random(self.pattern.size) < 0.5, -1.0, 1.0))
        self._regular = True

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve for one right-hand side (n,). Raises SingularMatrixError."""
        if not self.pattern.size:
            return np.zeros(0)
        start, factorising = time.process_time(), self.effort.factorising
        solution = self._solve(rhs)
        if self._unverified:
            self._unverified = False
            self._trusted = self._is_accurate(solution, rhs)
            if not self._trusted:
                self._repeat_in_full()
                solution = self._solve(rhs)
        self.effort.solving += time.process_time() - start - (self.effort.factorising - factorising)
        self.effort.solutions += 1
        if self._pivot is None:
            largest = float(np.abs(solution).max())
            self._examine(float(np.abs(rhs).max()) / largest if largest else np.inf)
        return solution

    def forget(self) -> None:
        """Discard earlier matrices, see `StepSolver`."""
        self._regular = self._unverified = self._probed = False
        self._trusted, self._passed = True, SUSPICIOUS

    def _is_accurate(self, solution: FloatArray, rhs: FloatArray) -> bool:
        """Return whether a solution is accurate, see `is_accurate`."""
        matrix = self.pattern.matrix(self._data)
        return is_accurate(rhs - matrix @ solution, rhs, lambda: abs(matrix) @ np.abs(solution))

    def _repeat_in_full(self) -> None:
        """Factorise the whole matrix, after inaccurate factors in part. Raises SingularMatrixError."""
        start = time.process_time()
        self._pivot = self._factorise(self._data)
        self.effort.factorising += time.process_time() - start
        self.effort.refused += 1
        if self._pivot is not None:
            self._examine(self._pivot)

    def _examine(self, pivot: float) -> None:
        """Raise SingularMatrixError if the matrix is singular; `pivot` is its smallest pivot or an estimate."""
        ratio = pivot / self._scale if self._scale else 0.0
        if ratio > self._passed or not np.isfinite(self._data).all():
            return
        self._regular = False
        refuse_singular(self.pattern.matrix(self._data), self._name_of, certain=pivot == 0.0)
        self._regular = True
        # stiff but regular, as with an interface stiffness of 1e12: similar matrices are not examined again
        self._passed = 1e-2 * ratio

    @abstractmethod
    def _factorise(self, data: FloatArray) -> float | None:
        """Factorise the matrix with these CSR values; replaces earlier factors.

        Parameters
        ----------
        data
            (nnz,) in the order of the pattern, not empty. They stay until the next factorisation.

        Returns
        -------
        float | None
            Magnitude of the smallest pivot of the unscaled matrix; 0.0 if one is zero or the factorisation fails. None
            if the solver does not report it: then solutions are examined.
        """

    def _update(self, data: FloatArray, changed: IntArray) -> float | None:
        """Factorise a matrix that differs from the last one in some entries; `_unverified` is set if that is a risk.

        Parameters
        ----------
        data
            As for `_factorise`.
        changed
            Positions of the entries, ascending, at least one.

        Returns
        -------
        float | None
            As that of `_factorise`.
        """
        return self._factorise(data)

    @abstractmethod
    def _solve(self, rhs: FloatArray) -> FloatArray:
        """Solve with the last factors for one right-hand side (n,), which is not changed."""
