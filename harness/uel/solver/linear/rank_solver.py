# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Linear solver of a job on several ranks, each of which has the part of the matrix from its elements.

All ranks factorise the matrix together: each its own substructure (substructures.py) or, if they share too many
unknowns, some rows each (cluster.py); PETSc (petsc.py) takes the place of oneMKL. Or rank 0 gathers the matrix and
factorises it as in a job in one process: in small models, messages cost more than two processes gain.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from importlib.util import find_spec
from typing import Final

import numpy as np

from uel.errors import SingularMatrixError, UsageError
from uel.model.arrays import FloatArray, IntArray
from uel.parallel.ranks import Ranks
from uel.solver.linear import cluster, petsc, substructures
from uel.solver.linear.choice import Availability, choose
from uel.solver.linear.cluster import Cluster, ClusterError, obstacle, version
from uel.solver.linear.distributed_rows import DistributedRows
from uel.solver.linear.linear_solver import SUSPICIOUS, Effort, LinearSolver, Pattern, StepSolver, is_accurate
from uel.solver.linear.petsc import Petsc
from uel.solver.linear.singular import refuse_singular
from uel.solver.linear.substructures import MOST_SHARED, Substructures

SMALLEST: Final = 30_000
"""Unknowns from which on `auto` takes a solver on all ranks."""


def with_ranks() -> list[Availability]:
    """Return the rows of the table of solvers for jobs on several ranks, without starting MPI."""
    missing = [name for name, release in (("mpi4py", find_spec("mpi4py")), ("mkl", version())) if not release]
    lack = f" ({' and '.join(missing)} not installed)" if missing else ""
    notes = {
        substructures.NAME: f"auto, with mpiexec from {SMALLEST} unknowns on, of which ranks share up to {MOST_SHARED}",
        cluster.NAME: "auto, with mpiexec where they share more; for less unknowns rank 0 takes one of the others",
    }
    rows = [Availability(name, not missing, version(), note + lack) for name, note in notes.items()]
    release = petsc.version()
    note = "auto, with mpiexec where mkl does not serve" + ("" if release else " (petsc4py not installed)")
    return [*rows, Availability(petsc.NAME, bool(release and find_spec("mpi4py")), release, note)]


NameOf = Callable[[int], tuple[str, int]]

_TOGETHER: Final = (substructures.NAME, cluster.NAME, petsc.NAME)
"""Solvers on all ranks."""


class RankSolver(StepSolver):
    """Solver for matrices of one pattern, of which each rank has a part, on all ranks or on rank 0.

    effort  counts and times of rank 0
    """

    def __init__(
        self,
        ranks: Ranks,
        name: str,
        pattern: Pattern,
        name_of: NameOf,
        effort: Effort,
        wrap: Callable[[LinearSolver], StepSolver] = lambda chosen: chosen,
    ) -> None:
        """Do the symbolic work.

        Parameters
        ----------
        ranks
            All of them call each function of this class together.
        name
            'auto', 'substructures', 'cluster', or the solver with which rank 0 works.
        pattern
            Pattern of this rank's part of the matrix; all ranks number the unknowns alike.
        name_of
            Returns node name and dof of an unknown.
        effort
            The solver adds its work to it.
        wrap
            Wraps the linear solver of a gathered matrix, on rank 0.

        Raises
        ------
        UsageError
            The name is unknown, or what the solver needs is not installed.
        """
        self._ranks, self._pattern, self._name_of = ranks, pattern, name_of
        self._wanted = "auto" if name in _TOGETHER else name
        self.effort = effort
        self._wrap = wrap
        self._whole: DistributedRows | None = None
        self._chosen: LinearSolver | None = None
        self._inner: StepSolver | None = None
        self._singular: SingularMatrixError | None = None
        self._data: FloatArray | None = None
        self._symmetric, self._probed, self._unverified = True, False, False
        self._passed = SUSPICIOUS
        self._scale = 0.0
        self._together = self._choose_together(name)
        if self._together is None:
            self._gather()

    def factorise(self, data: FloatArray) -> None:
        """Factorise the sum of the parts (nnz,) of all ranks."""
        start = time.process_time()
        if self._together is not None:
            if not self._is_new(data):
                return
            self._unverified = True
            self._factorise_together(self._together, data)
        if self._together is None:
            self._factorise_whole(data)
        else:
            self.effort.factorising += time.process_time() - start
            self.effort.factorisations += 1

    def _is_new(self, data: FloatArray) -> bool:
        """Store a part, and return whether the part of any rank differs from the last one."""
        different = None if self._data is None else np.flatnonzero(data != self._data)
        new = different is None or len(different) > 0
        # after an unsymmetric part, later ones count as unsymmetric too
        symmetric = self._symmetric and (not new or self._pattern.is_symmetric(data, different))
        any_new, any_unsymmetric = self._ranks.largest(np.array([float(new), float(not symmetric)]))
        self._symmetric = not any_unsymmetric
        if self._data is None:
            self._data = data.copy()
        elif new:
            self._data[:] = data
        return bool(any_new)

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve for one right-hand side (n,); all ranks get the solution. Raises SingularMatrixError."""
        start = time.process_time()
        if self._together is not None:
            solution = self._together.solve(rhs)
            if self._is_sound(solution, rhs) and self._is_accurate(solution, rhs):
                self.effort.solving += time.process_time() - start
                self.effort.solutions += 1
                return solution
            assert self._data is not None
            self._fall_back()
            self._factorise_whole(self._data)
        return self._solve_whole(rhs)

    def release(self) -> None:
        """Free the memory of the factors."""
        if self._together is not None:
            self._together.release()
        self._together = self._inner = self._chosen = None

    def _choose_together(self, name: str) -> Cluster | Substructures | Petsc | None:
        """Return the solver on all ranks, and set name and reason; None: rank 0 alone. Raises UsageError."""
        ranks, pattern = self._ranks, self._pattern
        if name not in ("auto", *_TOGETHER) or (name == "auto" and pattern.size < SMALLEST):
            return None
        lack = "" if name == petsc.NAME else self._missing(name, obstacle())
        other = bool(lack) or name == petsc.NAME
        if other:
            lack = self._missing(name, petsc.obstacle(ranks.size))
        owners = _owners(ranks, pattern)
        # on tiny models a rank may have no row
        if lack or len(np.unique(owners)) < ranks.size:
            return None
        if name != cluster.NAME and not other:
            parts = Substructures(ranks, pattern, owners)
            shared = len(parts.shared)
            if parts.usable and (name == substructures.NAME or shared <= MOST_SHARED):
                self.name = substructures.NAME
                self.reason = f"{pattern.size} unknowns on {ranks.size} ranks, which share {shared} of them"
                return parts
        self.name = petsc.NAME if other else cluster.NAME
        self.reason = f"{pattern.size} unknowns on {ranks.size} ranks"
        rows = DistributedRows(ranks, pattern, owners)
        return Petsc(ranks, rows, pattern) if other else Cluster(ranks, rows)

    def _missing(self, name: str, mine: str) -> str:
        """Return what a rank lacks for a solver, '' for nothing. Raises UsageError if the user requests the solver."""
        reason = next(filter(None, self._ranks.allgather(mine)), "")
        if reason and name in _TOGETHER:
            raise UsageError(f"linear solver '{name}' cannot be used: {reason}")
        return reason

    def _factorise_together(self, solver: Cluster | Substructures | Petsc, data: FloatArray) -> None:
        """Factorise on all ranks, or fall back to rank 0 if that fails."""
        try:
            self.effort.in_part += solver.factorise(data, symmetric=self._symmetric)
        except ClusterError:
            return self._fall_back()
        self._scale = solver.largest_diagonal
        # a random right-hand side reveals an unconstrained body even if no load moves it
        if not self._probed:
            self._probed = True
            probe = np.where(np.random.default_rng(0).random(self._pattern.size) < 0.5, -1.0, 1.0)
            if not self._is_sound(solver.solve(probe), probe):
                self._fall_back()
        return None

    def _is_sound(self, solution: FloatArray, rhs: FloatArray) -> bool:
        """Return whether the matrix is regular by a solution, as in `LinearSolver`; all ranks have this solution."""
        if not np.isfinite(solution).all():
            return False
        largest = float(np.abs(solution).max(initial=0.0))
        ratio = float(np.abs(rhs).max(initial=0.0)) / (largest * self._scale) if largest and self._scale else np.inf
        if ratio > self._passed:
            return True
        rows = DistributedRows(self._ranks, self._pattern, np.zeros(self._pattern.size, dtype=np.int64))
        assert self._data is not None
        whole = Pattern(rows.indptr, rows.indices)
        values = rows.assemble(self._data)
        try:
            self._ranks.agree(
                lambda: None if self._ranks.rank else refuse_singular(whole.matrix(values), self._name_of)
            )
        except SingularMatrixError:
            return False
        self._passed = 1e-2 * ratio
        return True

    def _is_accurate(self, solution: FloatArray, rhs: FloatArray) -> bool:
        """Return whether the first solution with a matrix is accurate, see `is_accurate`; later ones pass."""
        if not self._unverified:
            return True
        self._unverified = False
        assert self._data is not None
        part = self._pattern.matrix(self._data)
        residual = rhs - self._ranks.sum(np.asarray(part @ solution))
        return is_accurate(residual, rhs, lambda: self._ranks.sum(np.asarray(abs(part) @ np.abs(solution))))

    def _fall_back(self) -> None:
        """Fall back to rank 0 for the rest of the step: it permutes, and accepts singular matrices."""
        assert self._together is not None
        self._together.release()
        self._together = None
        self.effort.refused += 1
        self._gather()

    def _gather(self) -> None:
        """Prepare to gather the whole matrix on rank 0. Raises UsageError."""
        self._whole = rows = DistributedRows(self._ranks, self._pattern, np.zeros(self._pattern.size, dtype=np.int64))

        def begin() -> tuple[str, str]:
            coordinates = self._pattern.coordinates
            self._chosen = choose(
                self._wanted, rows.indptr, rows.indices, coordinates=coordinates, name_of=self._name_of
            )
            self._chosen.effort = self.effort
            return self._chosen.name, f"on rank 0, {self._chosen.reason}"

        self.name, self.reason = self._ranks.on_rank_0(begin)

    def _factorise_whole(self, data: FloatArray) -> None:
        assert self._whole is not None
        values = self._whole.assemble(data)

        self._singular = None
        if self._chosen is None:
            return
        if self._inner is None:
            self._inner = self._wrap(self._chosen)
            # a later step that reuses the solver replaces `negligible`
            self._inner.negligible = lambda: self.negligible()  # noqa: PLW0108
        try:
            self._inner.factorise(values)
        except SingularMatrixError as error:
            # raised on all ranks by the next `solve`
            self._singular = error

    def _solve_whole(self, rhs: FloatArray) -> FloatArray:
        def work() -> tuple[FloatArray, str | None]:
            assert self._inner is not None
            if self._singular is not None:
                raise self._singular
            solution = self._inner.solve(rhs)
            return solution, self._inner.free

        solution, self.free = self._ranks.on_rank_0(work)
        return solution


def _owners(ranks: Ranks, pattern: Pattern) -> IntArray:
    """Return the rank of each unknown: the lowest one that has an element with it."""
    used = np.diff(pattern.indptr) > 1
    mine = np.where(used, float(ranks.size - ranks.rank), 0.0)
    lowest = ranks.size - ranks.largest(mine).astype(np.int64)
    return np.where(lowest == ranks.size, 0, lowest)
