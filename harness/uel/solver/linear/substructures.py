# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Substructures: each rank eliminates its interior unknowns, and rank 0 solves for the shared ones.

With I the interior unknowns, of one rank alone, and B the boundary unknowns that it shares with others, the Schur
complement of a rank is K_BB - K_BI K_II^-1 K_IB (Przemieniecki, AIAA J. 1 (1963) 138-147), which PARDISO returns with
the factors of K_II. Rank 0 factorises the sum of all of them. A rank whose part has not changed, as far from a crack,
keeps its factors.
"""

from __future__ import annotations

import ctypes
import weakref
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.linalg import lapack

from uel.model.arrays import FloatArray, IntArray
from uel.parallel.ranks import Ranks
from uel.solver.linear.cluster import ClusterError, loaded
from uel.solver.linear.linear_solver import Pattern
from uel.solver.linear.pardiso import (
    ANALYSE,
    FACTORISE,
    PARAMETERS,
    RELEASE,
    REPLACED,
    SYMMETRIC,
    UNSYMMETRIC,
    PardisoError,
    Type,
    call,
    upper_triangle,
)

NAME: Final = "substructures"
"""Name by which `--solver` requests it."""

MOST_SHARED: Final = 3000
"""Shared unknowns up to which `auto` takes this solver: their dense matrix takes 72 MB and 18e9 operations."""

SHIFT: Final = 1e-8
"""Stiffness over the largest diagonal entry of a rank, added to the boundary unknowns and subtracted again.

PARDISO counts a zero on the diagonal of a boundary unknown as a replaced pivot, as behind a crack on the rank without
the solid. The two operations leave an error of 1e-8 of the last bit of the largest entry.
"""

_CHANGES: Final = {
    20: 0,  # pivots from the diagonal alone, in two thirds of the time; the residual of a solution verifies them
    35: 2,  # return the Schur complement of the unknowns marked in PERM, and keep the factors of the others
}
"""Entries of IPARM, from 0, that differ from those of one process."""

_FORWARD, _BACKWARD = 331, 333
"""Phases of a solution: forward to the right-hand side of the boundary unknowns, and back from their solution."""


class Substructures:
    """Solver for matrices of one pattern.

    usable            True if each rank has interior and shared unknowns
    shared            unknowns of several ranks, the same array on all of them
    largest_diagonal  largest magnitude on the diagonal of the last matrix
    """

    def __init__(self, ranks: Ranks, pattern: Pattern, owners: IntArray) -> None:
        """Do the symbolic work.

        Parameters
        ----------
        ranks
            All of them call each function of this class together.
        pattern
            Pattern of this rank's part of the matrix; all ranks number the unknowns alike.
        owners
            (n,) one of the ranks that have each unknown; the same array on all ranks.
        """
        self._ranks, self._size, self._diagonal = ranks, pattern.size, pattern.diagonal
        self._used = np.diff(pattern.indptr) > 1
        common = ranks.sum(self._used.astype(np.float64)) > 1.0
        self.shared = np.flatnonzero(common)
        self._interior, boundary = np.flatnonzero((owners == ranks.rank) & ~common), np.flatnonzero(common & self._used)
        self.usable = not ranks.largest(np.array([float(not (len(self._interior) and len(boundary)))]))[0]
        # for each rank, positions of its unknowns among the shared ones
        self._positions = ranks.allgather(np.searchsorted(self.shared, boundary))
        self._here = np.concatenate([self._interior, boundary])
        self._owned = owners[self._here] == ranks.rank
        numbers = np.arange(len(pattern.indices), dtype=np.int32)
        entries = sparse.csr_array((numbers, pattern.indices, pattern.indptr), (pattern.size,) * 2)
        local = sparse.csr_array(entries[self._here][:, self._here])
        local.sort_indices()
        self._take = local.data
        self._pattern = Pattern(local.indptr.astype(np.int32), local.indices.astype(np.int32))
        self._values = np.zeros(0)
        self._matrix: _Matrix | None = None
        self._complements = [np.zeros((0, 0))] * ranks.size
        self._shift = 0.0
        self._factors = np.zeros((0, 0)), np.zeros(0, dtype=np.int32)
        self.largest_diagonal = 0.0

    def factorise(self, data: FloatArray, *, symmetric: bool) -> bool:
        """Factorise the sum of the parts (nnz,) of the ranks.

        Returns
        -------
        bool
            Whether a rank kept its factors.

        Raises
        ------
        ClusterError
            On all ranks: a pivot is too small.
        """
        values = self._taken(data)
        kind = SYMMETRIC if symmetric else UNSYMMETRIC
        new = self._matrix is None or self._matrix.kind is not kind or not np.array_equal(values, self._values)
        self._values = values
        sound, complement = True, None
        if new:
            try:
                complement = self._eliminate(kind)
            except PardisoError:
                sound = False
        self._send_to_rank_0(complement)
        if not self._ranks.rank and sound:
            sound = self._factorise_complement()
        failures, kept = self._ranks.sum(np.array([float(not sound), float(not new)]))
        if failures:
            raise ClusterError("a pivot is too small")
        return bool(kept)

    def _taken(self, data: FloatArray) -> FloatArray:
        """Return the values of the matrix of this rank.

        A rank may have only the diagonal entry of a row, as of a spring to the ground; this entry goes to the owner.
        """
        diagonal = data[self._diagonal]
        both = self._ranks.sum(np.concatenate([diagonal, np.where(self._used, 0.0, diagonal)]))
        self.largest_diagonal = float(np.abs(both[: self._size]).max(initial=0.0))
        values: FloatArray = data[self._take]
        positions = self._pattern.diagonal
        values[positions] = np.where(self._used[self._here], values[positions], 0.0)
        values[positions] += np.where(self._owned, both[self._size :][self._here], 0.0)
        self._shift = SHIFT * float(np.abs(values[positions]).max())
        values[positions[len(self._interior) :]] += self._shift
        return values

    def _eliminate(self, kind: Type) -> FloatArray:
        """Return the Schur complement of this rank. Raises PardisoError."""
        matrix, self._matrix = self._matrix, None
        if matrix is None or matrix.kind is not kind:
            # free the old factors first
            matrix = None
            matrix = _Matrix(self._pattern, len(self._interior), kind)
        complement = matrix.factorise(self._values)
        complement[np.diag_indices(len(complement))] -= self._shift
        self._matrix = matrix
        return complement

    def _send_to_rank_0(self, complement: FloatArray | None) -> None:
        """Send the Schur complement of this rank to rank 0; None: that of the last matrix stays."""
        sent = [np.zeros(0)] * self._ranks.size
        if complement is not None and self._ranks.rank:
            sent[0] = complement.ravel()
        elif complement is not None:
            self._complements[0] = complement
        for rank, received in enumerate(self._ranks.exchange(sent)):
            if len(received):
                self._complements[rank] = received.reshape((len(self._positions[rank]),) * 2)

    def _factorise_complement(self) -> bool:
        """Factorise the sum of the Schur complements on rank 0; return whether it is regular."""
        total = np.zeros((len(self.shared),) * 2)
        for positions, own in zip(self._positions, self._complements, strict=True):
            # a rank that has failed may have sent none
            if len(own):
                total[np.ix_(positions, positions)] += own
        factors, pivots, info = lapack.dgetrf(total, overwrite_a=True)
        self._factors = factors, pivots
        return not info

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve for a right-hand side (n,) that all ranks have; all get the same solution (n,)."""
        assert self._matrix is not None
        interior, positions = len(self._interior), self._positions[self._ranks.rank]
        own_rhs = np.zeros(len(self._here))
        own_rhs[:interior] = rhs[self._interior]
        forward = self._matrix.solve(_FORWARD, own_rhs)
        reduced = np.zeros(len(self.shared))
        reduced[positions] = forward[interior:]
        reduced = self._ranks.sum(reduced) + rhs[self.shared]
        boundary = np.zeros(len(self.shared))
        if not self._ranks.rank:
            boundary, _ = lapack.dgetrs(*self._factors, reduced)
        boundary = self._ranks.sum(boundary)
        forward[interior:] = boundary[positions]
        solution = np.zeros(self._size)
        solution[self._interior] = self._matrix.solve(_BACKWARD, forward)[:interior]
        solution = self._ranks.sum(solution)
        solution[self.shared] = boundary
        return solution

    def release(self) -> None:
        """Free the memory of the factors."""
        self._matrix = None


class _Handle:
    """Data that PARDISO keeps of a matrix, and its function in the oneMKL of `loaded`."""

    def __init__(self, kind: Type, perm: NDArray[np.int32]) -> None:
        self.mtype, self.perm = kind.number, perm
        self.pt, self.iparm = np.zeros(64, dtype=np.int64), np.zeros(64, dtype=np.int32)
        for index, value in (PARAMETERS | _CHANGES).items():
            self.iparm[index] = value
        self._mkl_pardiso = loaded().pardiso
        integers, reals = ctypes.POINTER(ctypes.c_int32), ctypes.POINTER(ctypes.c_double)
        numbers = ctypes.POINTER(ctypes.c_int64)
        self._mkl_pardiso.argtypes = [numbers, *[integers] * 5, reals, *[integers] * 6, reals, reals, integers]
        self._mkl_pardiso.restype = None


class _Matrix:
    """Matrices of one pattern and type, as PARDISO holds them."""

    def __init__(self, pattern: Pattern, interior: int, kind: Type) -> None:
        """Prepare to eliminate the first `interior` unknowns; the others are boundary unknowns."""
        self.kind = kind
        self._boundary = pattern.size - interior
        self._upper: NDArray[np.int32] | None = None
        self._pattern = pattern
        if kind is SYMMETRIC:
            self._upper, self._pattern = upper_triangle(pattern)
        marked = np.zeros(pattern.size, dtype=np.int32)
        marked[interior:] = 1
        self._handle = _Handle(kind, marked)
        self._values: FloatArray | None = None
        weakref.finalize(self, call, self._handle, RELEASE, self._pattern, np.zeros(1), np.zeros(pattern.size))

    def factorise(self, values: FloatArray) -> FloatArray:
        """Return the Schur complement (boundary, boundary) for these values (nnz,). Raises PardisoError."""
        begun, nothing = self._values is not None, np.zeros(self._pattern.size)
        self._values = values if self._upper is None else values[self._upper]
        if not begun:
            call(self._handle, ANALYSE, self._pattern, self._values, nothing)
        complement = np.zeros((self._boundary,) * 2)
        call(self._handle, FACTORISE, self._pattern, self._values, nothing, complement)
        if self._handle.iparm[REPLACED]:
            raise PardisoError("pivots were replaced")
        return complement

    def solve(self, phase: int, rhs: FloatArray) -> FloatArray:
        """Return the result (n,) of a phase of the solution for one right-hand side (n,). Raises PardisoError."""
        assert self._values is not None
        return call(self._handle, phase, self._pattern, self._values, rhs)
