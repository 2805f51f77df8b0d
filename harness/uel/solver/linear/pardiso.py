# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Intel MKL PARDISO through pypardiso."""

from __future__ import annotations

import ctypes
import os
import weakref
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, ClassVar, Final

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray, IntArray
from uel.solver.linear.linear_solver import LinearSolver, Pattern


@dataclass(frozen=True, slots=True)
class Type:
    """Type of matrix in PARDISO.

    number      its MTYPE
    parameters  entries of IPARM, from 0, that differ from `PARAMETERS`
    """

    number: int
    parameters: dict[int, int] = field(default_factory=dict)


SYMMETRIC: Final = Type(-2)
"""Symmetric, definite or not: 0.6 to 0.9 of the time and 0.6 of the memory of unsymmetric matrices."""
UNSYMMETRIC: Final = Type(1)
"""Symmetric pattern."""
PIVOTED: Final = Type(11, {10: 1, 12: 1})
"""Unsymmetric, scaled and permuted so that large entries come to the diagonal (IPARM(11) and (13)). With zeros on the
diagonal, as with Lagrange multipliers, the other types replace pivots and may return anything.
"""

ANALYSE, FACTORISE, SOLVE, RELEASE = 11, 22, 33, -1
"""PARDISO's phases."""

NO_MEMORY: Final = -2
"""PARDISO's error if memory cannot be allocated."""

PARAMETERS: Final = {
    0: 1,  # these values replace the defaults, which refine each solution twice, at twice its cost
    1: 2,  # nested dissection
    7: 0,  # two steps of refinement if pivots were replaced, none otherwise
    9: 13,  # pivots below 1e-13 are replaced: with the 1e-8 of symmetric matrices a stiff interface would be changed
    17: -1,  # report the entries of the factors
    20: 1,  # pivots of symmetric matrices: Bunch and Kaufman
    23: 0,  # the factorisation that is right on any number of threads
    34: 1,  # indices start at 0
}
"""Entries of IPARM, from 0, that are not 0."""

RENEWABLE: Final = {23: 10}
"""IPARM(24): the factorisation that can be renewed in part, on one thread without OpenMP. On several threads, or with
OpenMP, it ends in a segmentation fault or returns wrong factors (oneMKL 2025.3 to 2026.2).
"""

THREADS: Final = "MKL_NUM_THREADS"
"""Variable with the number of threads; one if it is not set."""

_SEQUENTIAL: Final = 1
"""MKL's number of the threading layer without OpenMP."""

REPLACED: Final = 13
"""Entry of IPARM: number of pivots that were replaced because they were small."""

IN_PART: Final = 38
"""Entry of IPARM: renew the factors where the entries listed in PERM differ."""

LARGEST_SHARE: Final = 0.2
"""Largest share of the entries that may change for the factors to be renewed in part.

30,000 unknowns of bricks: 0.33 s in full; in part 0.06 s for 1 % of the entries, 0.13 for 10 %, 0.41 for 50 %.
"""


class PardisoSolver(LinearSolver):
    """PARDISO, with one analysis for all factorisations, and factors renewed in part if few entries change.

    Matrices are treated as symmetric until the first that is not, and permuted from the first on that needs pivoting.
    """

    name = "pardiso"
    module: ClassVar[str] = "pypardiso"
    distribution: ClassVar[str] = "pypardiso"
    widest_band: ClassVar[tuple[int, int]] = (40, 300)

    def __init__(self, pattern: Pattern, name_of: Callable[[int], tuple[str, int]] | None = None) -> None:
        super().__init__(pattern, name_of)
        self._type = SYMMETRIC
        self._matrix: _Matrix | None = None

    def forget(self) -> None:
        """Discard earlier matrices; the next one may be of another type."""
        super().forget()
        self._type, self._matrix = SYMMETRIC, None

    def _factorise(self, data: FloatArray) -> float | None:
        if self._type is SYMMETRIC and not self.pattern.is_symmetric(data):
            self._type, self._matrix = UNSYMMETRIC, None
        try:
            # the permutation depends on the values
            if self._matrix is None or self._type is PIVOTED:
                # free the old factors first
                self._matrix = None
                self._matrix = _Matrix(self.pattern, data, self._type)
            self._matrix.factorise(data)
        except PardisoError:
            return 0.0
        if self._matrix.replaced and self._type is not PIVOTED:
            self._type, self._matrix = PIVOTED, None
            return self._factorise(data)
        return None

    def _update(self, data: FloatArray, changed: IntArray) -> float | None:
        if (
            self._matrix is None
            or not self._matrix.renewable
            or len(changed) > LARGEST_SHARE * len(data)
            or (self._type is SYMMETRIC and not self.pattern.is_symmetric(data, changed))
        ):
            return self._factorise(data)
        try:
            self._matrix.factorise(data, changed)
        except PardisoError:
            return self._factorise(data)
        if self._matrix.replaced:
            return self._factorise(data)
        self.effort.in_part += 1
        self._unverified = True
        return None

    def _solve(self, rhs: FloatArray) -> FloatArray:
        assert self._matrix is not None
        return self._matrix.solve(rhs)


class PardisoError(Exception):
    """PARDISO returns an error code."""


class _Matrix:
    """Matrices of one pattern and type, as PARDISO holds them."""

    def __init__(self, pattern: Pattern, data: FloatArray, kind: Type) -> None:
        """Analyse the pattern, with the values (nnz,) of the first matrix. Raises PardisoError."""
        from pypardiso import PyPardisoSolver  # noqa: PLC0415 (loads MKL, and need not be installed)

        self._handle = PyPardisoSolver(kind.number)
        self.renewable = kind is not PIVOTED and _without_openmp(self._handle)
        renewable = RENEWABLE if self.renewable else {}
        for index, value in (PARAMETERS | renewable | kind.parameters).items():
            self._handle.iparm[index] = value
        self._upper: NDArray[np.int32] | None = None
        self._pattern = pattern
        if kind is SYMMETRIC:
            self._upper, self._pattern = upper_triangle(pattern)
        self._values = self._taken(data)
        self._call(ANALYSE)
        weakref.finalize(self, call, self._handle, RELEASE, self._pattern, np.zeros(1), np.zeros(pattern.size))

    def factorise(self, data: FloatArray, changed: IntArray | None = None) -> None:
        """Factorise the matrix with these values (nnz,); changed: positions where they differ from the last ones.

        Raises PardisoError.
        """
        self._values = self._taken(data)
        self._handle.iparm[IN_PART] = changed is not None
        self._handle.perm = np.zeros(0 if changed is None else 1, dtype=np.int32)
        if changed is not None:
            if self._upper is not None:
                position = np.minimum(np.searchsorted(self._upper, changed), len(self._upper) - 1)
                changed = position[self._upper[position] == changed]
            pairs = np.column_stack([self._pattern.rows_of(changed), self._pattern.indices[changed]])
            self._handle.perm = np.concatenate([[len(pairs)], pairs.ravel()]).astype(np.int32)
        self._call(FACTORISE)

    @property
    def replaced(self) -> bool:
        """True if the last factorisation replaced small pivots."""
        return bool(self._handle.iparm[REPLACED])

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve for one right-hand side (n,). Raises PardisoError."""
        return self._call(SOLVE, np.ascontiguousarray(rhs))

    def _taken(self, data: FloatArray) -> FloatArray:
        return data if self._upper is None else data[self._upper]

    def _call(self, phase: int, rhs: FloatArray | None = None) -> FloatArray:
        rhs = np.zeros(self._pattern.size) if rhs is None else rhs
        return call(self._handle, phase, self._pattern, self._values, rhs)


def _without_openmp(handle: Any) -> bool:
    """Report whether MKL runs on one thread without OpenMP; decided by the first call of MKL in a process."""
    if os.environ.get(THREADS, "1") != "1":
        return False
    return bool(handle.libmkl.MKL_Set_Threading_Layer(_SEQUENTIAL) == _SEQUENTIAL)


def upper_triangle(pattern: Pattern) -> tuple[NDArray[np.int32], Pattern]:
    """Return the positions of the entries on and above the diagonal, and their pattern."""
    upper = pattern.upper
    indptr = np.searchsorted(upper, pattern.indptr).astype(np.int32)
    return upper, Pattern(indptr, pattern.indices[upper])


def call(
    handle: Any, phase: int, pattern: Pattern, values: FloatArray, rhs: FloatArray, solution: FloatArray | None = None
) -> FloatArray:
    """Run one phase of PARDISO, without pypardiso's own call, which copies all indices each time.

    Raises
    ------
    MemoryError
        There is not enough memory for the factors.
    PardisoError
        Any other error.
    """
    solution = np.zeros(pattern.size) if solution is None else solution
    error = ctypes.c_int32(0)
    integers, reals = ctypes.POINTER(ctypes.c_int32), ctypes.POINTER(ctypes.c_double)
    one, n = ctypes.c_int32(1), ctypes.c_int32(pattern.size)
    handle._mkl_pardiso(
        handle.pt.ctypes.data_as(ctypes.POINTER(ctypes.c_int64)),
        one,  # matrices kept
        one,  # number of this one
        ctypes.c_int32(handle.mtype),
        ctypes.c_int32(phase),
        n,
        values.ctypes.data_as(reals),
        pattern.indptr.ctypes.data_as(integers),
        pattern.indices.ctypes.data_as(integers),
        handle.perm.ctypes.data_as(integers),
        one,  # right-hand sides
        handle.iparm.ctypes.data_as(integers),
        ctypes.c_int32(0),  # no messages
        rhs.ctypes.data_as(reals),
        solution.ctypes.data_as(reals),
        error,
    )
    if error.value == NO_MEMORY:
        raise MemoryError
    if error.value:
        raise PardisoError(error.value)
    return solution
