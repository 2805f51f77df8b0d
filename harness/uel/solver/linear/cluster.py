# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""PARDISO for clusters (oneMKL): all ranks factorise one matrix, whose rows are distributed.

libmkl_rt, which pypardiso loads, does not contain it: the parts of oneMKL are loaded one by one, after MPI, so that
each finds the symbols of earlier ones.
"""

from __future__ import annotations

import ctypes
import os
from functools import cache
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray
from uel.parallel.ranks import Ranks
from uel.solver.linear.distributed_rows import DistributedRows

NAME: Final = "cluster"
"""Name by which `--solver` requests it."""

_DISTRIBUTION: Final = "mkl"
_LIBRARIES: Final = ("libmkl_core", "libmkl_sequential", "libmkl_intel_lp64", "libmkl_blacs_intelmpi_lp64")
"""Libraries in the order of loading; the last one needs MPICH or Intel MPI."""

_SYMMETRIC, _UNSYMMETRIC = -2, 1
"""MTYPE: symmetric, definite or not; unsymmetric with a symmetric pattern."""

_ANALYSE, _FACTORISE, _SOLVE, _RELEASE = 11, 22, 33, -1
"""Phases."""

_PARAMETERS: Final = {
    0: 1,  # these values replace the defaults
    1: 2,  # nested dissection
    9: 13,  # pivots below 1e-13 are replaced
    20: 1,  # pivots of symmetric matrices: Bunch and Kaufman
    34: 1,  # indices start at 0
    39: 2,  # rows of matrix, right-hand side and solution are shared out
}
"""Entries of IPARM, from 0, that are not 0."""

_REPLACED: Final = 13
_FIRST, _LAST = 40, 41
"""Entries of IPARM: first and last row of this rank; `_REPLACED`: number of replaced pivots."""


class ClusterError(Exception):
    """Error code of the solver, or pivots that it has replaced."""


@cache
def obstacle() -> str:
    """Return the reason why this process cannot use the solver, '' if it can."""
    try:
        loaded()
    except PackageNotFoundError:
        return f"{_DISTRIBUTION} is not installed; pip install .[mpi]"
    except (OSError, AttributeError) as error:
        return f"{_DISTRIBUTION} does not load: {error}"
    return ""


def version() -> str:
    """Return the version of oneMKL, '' without it."""
    try:
        return distribution(_DISTRIBUTION).version
    except PackageNotFoundError:
        return ""


@cache
def loaded() -> ctypes.CDLL:
    """Load the library that has the solver. Raises OSError."""
    files = {path.name.partition(".")[0]: path for path in distribution(_DISTRIBUTION).files or ()}
    libraries = [Path(str(files[name].locate())) for name in _LIBRARIES if name in files]
    if len(libraries) < len(_LIBRARIES):
        raise OSError("this version lacks parts for clusters")
    from mpi4py import MPI  # noqa: PLC0415 (only in a job on several ranks)

    # symbols of a loaded library are visible to later ones
    ctypes.CDLL(_library_of_mpi(MPI.Get_library_version()), mode=ctypes.RTLD_GLOBAL)
    process = ctypes.CDLL(None)
    process.dlopen.restype = ctypes.c_void_p
    for path in libraries:
        # lazy binding, because they need each other; ctypes would bind all symbols at once
        if not process.dlopen(os.fsencode(path), os.RTLD_LAZY | os.RTLD_GLOBAL):
            raise OSError(f"cannot load {path}")
    process.cluster_sparse_solver  # noqa: B018 (AttributeError without it)
    return process


def _library_of_mpi(version: str) -> str:
    if not version.startswith(("MPICH", "Intel")):
        raise OSError(f"it needs MPICH or Intel MPI, found {version.partition(',')[0]}")
    return "libmpi.so.12"


class Cluster:
    """Solver for matrices of one pattern.

    largest_diagonal  largest magnitude on the diagonal of the last matrix
    """

    def __init__(self, ranks: Ranks, rows: DistributedRows) -> None:
        """Start the solver; rows: those of this rank, with columns ascending."""
        self._ranks, self._rows = ranks, rows
        self._row = np.repeat(np.arange(len(rows.indptr) - 1, dtype=np.int64), np.diff(rows.indptr)) + rows.first
        self._diagonal = np.flatnonzero(self._row == rows.indices)
        self._matrix: _Matrix | None = None
        self.largest_diagonal = 0.0

    def factorise(self, data: FloatArray, *, symmetric: bool) -> bool:
        """Factorise the sum of the parts (nnz,) of the ranks; False: in full. Raises ClusterError on all ranks."""
        values = self._rows.assemble(data)
        own = np.array([np.abs(values[self._diagonal]).max(initial=0.0)])
        self.largest_diagonal = float(self._ranks.largest(own)[0])
        kind = _SYMMETRIC if symmetric else _UNSYMMETRIC
        if self._matrix is not None and self._matrix.kind != kind:
            self.release()
        if self._matrix is None:
            self._matrix = _Matrix(self._ranks, self._rows, self._row, kind)
        self._matrix.factorise(values)
        return False

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve for a right-hand side (n,) that all ranks have. Raises ClusterError on all ranks."""
        assert self._matrix is not None
        rows = self._rows
        own = rows.order[rows.first : rows.first + len(rows.indptr) - 1]
        solution = np.zeros_like(rhs)
        solution[own] = self._matrix.solve(rhs[own])
        return self._ranks.sum(solution)

    def release(self) -> None:
        """Free the memory of the factors; all ranks call this together."""
        if self._matrix is not None:
            self._matrix.release()
        self._matrix = None


class _Matrix:
    """Matrices of one pattern and type, as the solver holds them."""

    def __init__(self, ranks: Ranks, rows: DistributedRows, row: NDArray[np.int64], kind: int) -> None:
        from mpi4py import MPI  # noqa: PLC0415 (only in a job on several ranks)

        self.kind = kind
        self._ranks = ranks
        self._n = len(rows.order)
        entries = np.flatnonzero(rows.indices >= row) if kind == _SYMMETRIC else np.arange(len(row))
        self._entries = entries
        self._indices = np.ascontiguousarray(rows.indices[entries])
        self._indptr = np.searchsorted(entries, rows.indptr).astype(np.int32)
        self._values = np.zeros(len(entries))
        self._handle = np.zeros(64, dtype=np.int64)
        self._parameters = np.zeros(64, dtype=np.int32)
        for index, value in _PARAMETERS.items():
            self._parameters[index] = value
        self._parameters[_FIRST] = rows.first
        self._parameters[_LAST] = rows.first + len(rows.indptr) - 2
        self._comm = ctypes.c_int(MPI.COMM_WORLD.py2f())
        self._analysed = False

    def factorise(self, values: FloatArray) -> None:
        """Factorise the matrix with these values of all entries of the rows. Raises ClusterError."""
        self._values = values[self._entries]
        if not self._analysed:
            self._call(_ANALYSE)
            self._analysed = True
        self._call(_FACTORISE)
        if self._ranks.largest(np.array([float(self._parameters[_REPLACED])]))[0]:
            raise ClusterError("pivots were replaced")

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve for the right-hand side of the rows of this rank. Raises ClusterError."""
        return self._call(_SOLVE, rhs)

    def release(self) -> None:
        """Free the memory."""
        self._call(_RELEASE)

    def _call(self, phase: int, rhs: FloatArray | None = None) -> FloatArray:
        size = len(self._indptr) - 1
        rhs = np.zeros(size) if rhs is None else np.ascontiguousarray(rhs)
        solution, error = np.zeros(size), ctypes.c_int(0)
        one, permutation = ctypes.c_int(1), np.zeros(1, dtype=np.int32)
        number, silent = ctypes.c_int(self._n), ctypes.c_int(0)
        kind, step = ctypes.c_int(self.kind), ctypes.c_int(phase)
        arrays = self._values, self._indptr, self._indices, permutation
        loaded().cluster_sparse_solver(
            self._handle.ctypes,
            *map(ctypes.byref, (one, one, kind, step, number)),
            *(array.ctypes for array in arrays),
            ctypes.byref(one),
            self._parameters.ctypes,
            ctypes.byref(silent),
            rhs.ctypes,
            solution.ctypes,
            ctypes.byref(self._comm),
            ctypes.byref(error),
        )
        if self._ranks.largest(np.array([float(error.value != 0)]))[0]:
            raise ClusterError(f"phase {phase}: error {error.value}")
        return solution
