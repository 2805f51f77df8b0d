# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""PETSc through petsc4py: MUMPS on all ranks, or the solver that PETSC_OPTIONS selects.

The options have the prefix `uel_`: PETSC_OPTIONS="-uel_ksp_type cg -uel_pc_type gamg" selects multigrid, with the rigid
body modes as its near null space.
"""

from __future__ import annotations

from functools import cache
from importlib.metadata import PackageNotFoundError
from importlib.metadata import version as version_of
from typing import Any, Final

import numpy as np

from uel.model.arrays import FloatArray, IntArray
from uel.parallel.ranks import Ranks
from uel.solver.linear.cluster import ClusterError
from uel.solver.linear.distributed_rows import DistributedRows
from uel.solver.linear.linear_solver import ACCURATE, Pattern

NAME: Final = "petsc"
"""Name by which `--solver` requests it."""

PREFIX: Final = "uel_"
"""Prefix of its options among those of PETSc."""

_TOLERANCE: Final = 1e-2 * ACCURATE
"""Residual over the right-hand side at which iterations end."""

_INDEPENDENT: Final = 1e-10
"""Smallest over largest eigenvalue of the Gram matrix of independent modes."""

_ROTATIONS: Final = (4, 5, 6)
"""Dofs of rotations."""


@cache
def obstacle(size: int) -> str:
    """Return the reason why this process, one of `size` ranks, cannot use PETSc, '' if it can."""
    try:
        petsc = _loaded()
    except ImportError as error:
        return f"petsc4py does not load: {str(error).partition(chr(10))[0]}"
    if petsc.COMM_WORLD.size != size:
        return "petsc4py is of another MPI than mpi4py"
    if petsc.ScalarType is not np.float64:
        return "PETSc has other numbers than real ones of double precision"
    return "" if petsc.Sys.hasExternalPackage("mumps") else "PETSc has been built without MUMPS"


def version() -> str:
    """Return the version of petsc4py, '' without it."""
    try:
        return version_of("petsc4py")
    except PackageNotFoundError:
        return ""


@cache
def _loaded() -> Any:
    """Load the module, after MPI has started, with options from PETSC_OPTIONS and not from this command."""
    import petsc4py  # noqa: PLC0415 (need not be installed)

    petsc4py.init([])
    from petsc4py import PETSc  # noqa: PLC0415

    return PETSc


class Petsc:
    """Solver for matrices of one pattern.

    largest_diagonal  largest magnitude on the diagonal of the last matrix
    """

    def __init__(self, ranks: Ranks, rows: DistributedRows, pattern: Pattern) -> None:
        """Start PETSc; rows: those of this rank; pattern: with coordinates and dofs of all unknowns, if known."""
        self._ranks, self._petsc = ranks, _loaded()
        ranks.before_end(self._petsc._finalize)
        self._size = len(rows.indptr) - 1
        self._rows, self._own = rows, rows.order[rows.first : rows.first + self._size]
        row = np.repeat(np.arange(self._size), np.diff(rows.indptr)) + rows.first
        self._diagonal = np.flatnonzero(row == rows.indices)
        # near null space, orthonormal as PETSc requires
        self._modes: list[FloatArray] = []
        if pattern.coordinates is not None and pattern.dofs is not None:
            modes = rigid_modes(pattern.coordinates, pattern.dofs)[self._own]
            weights, axes = np.linalg.eigh(ranks.sum(modes.T @ modes))
            kept = weights > _INDEPENDENT * weights[-1]
            self._modes = list(np.ascontiguousarray((modes @ axes[:, kept] / np.sqrt(weights[kept])).T))
        integers = self._petsc.IntType
        self._indptr, self._indices = rows.indptr.astype(integers), rows.indices.astype(integers)
        self._matrix: Any = None
        self._solver: Any = None
        self._symmetric = False
        self.largest_diagonal = 0.0

    def factorise(self, data: FloatArray, *, symmetric: bool) -> bool:
        """Factorise the sum of the parts (nnz,) of the ranks; False: in full. Raises ClusterError on all ranks."""
        values = self._rows.assemble(data)
        own = np.array([np.abs(values[self._diagonal]).max(initial=0.0)])
        self.largest_diagonal = float(self._ranks.largest(own)[0])
        if self._matrix is not None and self._symmetric != symmetric:
            self.release()
        try:
            if self._matrix is None:
                self._begin(values, symmetric=symmetric)
            else:
                self._matrix.setValuesCSR(self._indptr, self._indices, values)
                self._matrix.assemble()
            self._solver.setOperators(self._matrix)
            self._solver.setUp()
        except self._petsc.Error as error:
            raise ClusterError(str(error)) from None
        return False

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve for a right-hand side (n,) that all ranks have; NaN if the solver fails."""
        b, x = self._matrix.createVecs("left"), self._matrix.createVecs("right")
        b.array[:] = rhs[self._own]
        solution = np.zeros_like(rhs)
        self._solver.solve(b, x)
        # all ranks have the same reason
        solution[self._own] = x.array if self._solver.getConvergedReason() > 0 else np.nan
        for vector in (b, x):
            vector.destroy()
        return self._ranks.sum(solution)

    def release(self) -> None:
        """Free the memory of the factors; all ranks call this together."""
        if self._matrix is not None:
            self._solver.destroy()
            self._matrix.destroy()
        self._matrix = self._solver = None

    def _begin(self, values: FloatArray, *, symmetric: bool) -> None:
        """Create matrix and solver, with the options."""
        petsc, self._symmetric = self._petsc, symmetric
        size = (self._size, len(self._rows.order))
        self._matrix = petsc.Mat().createAIJ((size, size), csr=(self._indptr, self._indices, values))
        self._matrix.setOption(petsc.Mat.Option.SYMMETRIC, symmetric)
        vectors = [petsc.Vec().createWithArray(mode, size) for mode in self._modes]
        if vectors:
            self._matrix.setNearNullSpace(petsc.NullSpace().create(vectors=vectors))
        self._solver = petsc.KSP().create()
        self._solver.setOptionsPrefix(PREFIX)
        self._solver.setType("preonly")
        self._solver.setTolerances(rtol=_TOLERANCE)
        factors = self._solver.getPC()
        factors.setType("cholesky" if symmetric else "lu")
        factors.setFactorSolverType("mumps")
        self._solver.setFromOptions()


def rigid_modes(coordinates: FloatArray, dofs: IntArray) -> FloatArray:
    """Return the rigid body modes and the constant modes of other dofs.

    Parameters
    ----------
    coordinates
        (n, 3) of the node of each unknown.
    dofs
        (n,) as Abaqus numbers them: 1 to 3 displacements, 4 to 6 rotations.

    Returns
    -------
    FloatArray
        (n, modes): three translations, three rotations about the middle over the size of the body, and one for each
        other dof there is.
    """
    centred = coordinates - coordinates.mean(axis=0)
    size = np.abs(centred).max(initial=0.0) or 1.0
    unit = np.eye(3)
    others = np.unique(dofs[dofs > _ROTATIONS[-1]])
    modes = np.zeros((len(dofs), 6 + len(others)))
    for dof in range(1, 4):
        moved = dofs == dof
        modes[moved, dof - 1] = 1.0
        modes[moved, 3:6] = np.cross(unit, centred[moved, None])[:, :, dof - 1] / size
        modes[dofs == dof + 3, dof + 2] = 1.0 / size
    modes[:, 6:] = dofs[:, None] == others
    return modes
