# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Constraints with kinematic couplings in large displacements: T and P depend on the rotations.

Their transposes transfer moments about the global axes, which are not derivatives with respect to rotation vectors.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy import sparse

from uel.assembly.constraints import Constraints, products, reduced_pattern
from uel.assembly.finite_couplings import KinematicCouplings
from uel.assembly.prescribed_followers import COLUMNS
from uel.assembly.system import System
from uel.errors import Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.model import Arm, Equation

MASSLESS = 1e-10
"""Mass over the largest one of a reference node below which a motion counts as massless."""

ANGLE = 1e-5
"""Rotation in radians of the differences of T, whose error is its square."""


class RotatingConstraints(Constraints):
    """Constraints some of which have finite rotations; T and P are those of the last `update`."""

    def __init__(
        self,
        system: System,
        prescribed: IntArray,
        equations: Sequence[Equation],
        sources: Mapping[int, Source],
        arms: Sequence[Arm],
        start: FloatArray | None = None,
    ) -> None:
        """Prepare the constraints; arguments as in `Constraints` and `KinematicCouplings`; start: zero by default.

        Raises DeckError, also if nodes of arms have other constraints.
        """
        n = len(system)
        start = np.zeros(n) if start is None else start
        self._couplings = couplings = KinematicCouplings(system.dofs, arms, prescribed, start, system.of_elements)
        super().__init__(system, prescribed, couplings.replace_prescribed(equations), sources)
        self._equations, self.arms = tuple(equations), tuple(arms)
        independent = np.concatenate([self.free, self.prescribed, couplings.eliminated])
        couplings.check(np.setdiff1d(np.arange(n), independent), equations)
        rows, columns, steady = np.broadcast_arrays(
            couplings.rows[:, :, None], couplings.row_sources[:, None, :], couplings.steady[:, None, :]
        )
        self._chosen = (rows >= 0) & (columns >= 0)
        where = rows[self._chosen], columns[self._chosen]
        self._t, self._of_free = _with_entries(self._t, self.free, *where)
        self._p, self._of_prescribed = _with_entries(self._p, self.prescribed, *where)
        self._moving = ~steady[self._chosen]
        self._find_pattern()
        self.update(start, np.zeros(n))

    def _find_pattern(self) -> None:
        """Do the symbolic work as `Constraints` does, and find the entries of T^T K T that depend on rotations."""
        super()._find_pattern()
        if not self.arms:
            # T is not complete yet
            return
        assert self._t is not None
        left, right, entry = products(self._system, self._t)
        # number of the product in each value of the map: each has one
        numbers = np.arange(len(entry), dtype=np.float64)
        order = reduced_pattern(self._system, self._t, numbers)[2].data.astype(np.int64)
        changing = np.zeros(self._t.nnz, dtype=bool)
        own, places = self._of_free
        changing[places[self._moving[own]]] = True
        self._changing = np.flatnonzero((changing[left] | changing[right])[order])
        self._left, self._right = (side[order][self._changing] for side in (left, right))
        self._curved = self._find_curved()
        self._curvature = np.zeros(len(self._curved[1]))

    def matches(
        self, prescribed: IntArray, equations: Sequence[Equation], arms: Sequence[Arm], start: FloatArray
    ) -> bool:
        """Return whether these constraints can be reused, as in `Constraints`, and would be the same if built at the
        start, as a restart of the step builds them.
        """
        return super().matches(prescribed, equations, arms, start) and self._couplings.eliminates_alike(start)

    def satisfy(self, start: FloatArray, increment: FloatArray) -> FloatArray:
        """Return an increment (n,) that fulfils the constraints at finite rotations."""
        return self._couplings.satisfy(start, increment)

    def update(
        self, u: FloatArray, residual: FloatArray, increment: FloatArray | None = None, weight: float = 1.0
    ) -> None:
        """Update T, P and their tangent, see `Constraints.update`."""
        self._refresh_pattern()
        assert self._t is not None
        self._u_forces = u if increment is None else u - (1.0 - weight) * increment
        self._set(self._couplings.levers(self._u_forces))
        self._t_transposed, self._p_transposed = self._t.T.tocsr(), self._p.T.tocsr()
        left = self._t.data[self._left]
        slopes = self._couplings.slopes(u)
        self._set(slopes)
        self._map.data[self._changing] = left * self._t.data[self._right]
        self._curvature = weight * self._couplings.curvature(self._u_forces, residual, slopes)[self._curved[0]]

    def inertia(self, mass: sparse.csr_array) -> sparse.csr_array:
        """Return the mass matrix of reference and dependent nodes, those without an arm included;
        see `Constraints.inertia`.
        """
        moving = np.zeros(mass.shape[0])
        moving[np.unique(self._of_bodies()[0].indices)] = 1.0
        chosen = sparse.dia_array((moving[None, :], [0]), shape=mass.shape)
        found = (chosen @ mass @ chosen).tocsr()
        found.eliminate_zeros()
        return found

    def project_velocity(self, velocity: FloatArray, inertia: sparse.csr_array) -> FloatArray:
        """Return velocities as `Constraints.project_velocity`, for each body alone: mass that couples two bodies is
        left out.
        """
        following = self.project(velocity)
        moving, columns, body, own = self._of_bodies()
        units = self._couplings.units
        masses = (moving.T @ (inertia @ moving)).tocoo()
        same = body[masses.row] == body[masses.col]
        row, column = masses.row[same], masses.col[same]
        of_bodies = np.zeros((len(units), COLUMNS, COLUMNS))
        of_bodies[body[row], own[row], own[column]] = masses.data[same]
        of_bodies *= units[:, :, None] * units[:, None, :]
        momenta = np.zeros(units.shape)
        momenta[body, own] = moving.T @ (inertia @ (velocity - following))
        # the momentum leaves the velocity about a line undetermined on which all masses of a body lie
        inverse = np.linalg.pinv(of_bodies, MASSLESS, hermitian=True)
        changes = units * np.einsum("mab,mb->ma", inverse, units * momenta)
        rates = np.zeros(len(self.free) + len(self.prescribed))
        rates[columns] = changes[body, own]
        found = following + self.expand(*np.split(rates, [len(self.free)]))
        found[self.prescribed] = velocity[self.prescribed]
        return found

    def _of_bodies(self) -> tuple[sparse.csc_array, IntArray, IntArray, IntArray]:
        """Return the columns of (T P) that move bodies, their numbers, and row and column of each in `units`.

        Columns of prescribed rotations are included: an integration gives them and the nodes on arms velocities that
        differ by the error of a chord for an arc. Prescribed displacements have no such error.
        """
        number = np.full(len(self._system) + 1, -1)
        turns = np.isin(self.prescribed, self._couplings.rotations)
        number[self.prescribed] = np.where(turns, len(self.free) + np.arange(len(turns)), -1)
        number[self.free] = np.arange(len(self.free))
        columns = number[self._couplings.sources[:, :COLUMNS]]
        body, own = np.nonzero(columns >= 0)
        both = sparse.hstack([self._t, self._p]).tocsc()
        return both[:, columns[body, own]], columns[body, own], body, own

    def convective(self, u: FloatArray, velocity: FloatArray) -> FloatArray:
        """Compute centripetal accelerations by central differences of T and P, and leave these at u;
        see `Constraints.convective`.
        """
        zero = np.zeros_like(u)
        spin = float(np.abs(velocity[self._couplings.rotations]).max(initial=0.0))
        if not spin:
            return zero
        time = ANGLE / spin
        self.update(u + time * velocity, zero)
        ahead = self.project(velocity)
        self.update(u - time * velocity, zero)
        behind = self.project(velocity)
        self.update(u, zero)
        return np.asarray((ahead - behind) / (2.0 * time))

    def reduce_tangent(self, data: FloatArray) -> FloatArray:
        """Reduce a tangent and add the stiffness of rotating arms, see `Constraints.reduce_tangent`."""
        reduced = self.reduce(data)
        np.add.at(reduced, self._curved[1], self._curvature)
        return reduced

    def refuse_unbalanced(self, residual: FloatArray) -> None:
        """Refuse unbalanced moments, see `Constraints.refuse_unbalanced`."""
        self._couplings.refuse_idle_moments(self._u_forces, residual)

    @property
    def overconstraints(self) -> list[tuple[int, Source]]:
        """Overconstraints, see `Constraints`, with prescribed displacements of nodes on arms."""
        return super().overconstraints + self._couplings.redundant

    def _redundancy_errors(self, u: FloatArray) -> list[float]:
        """Return the errors of the redundant equations, then those of the arms."""
        own: list[float] = self._couplings.redundancy_errors(u).tolist()
        return super()._redundancy_errors(u) + own

    def _set(self, by_reference: FloatArray) -> None:
        """Set the entries of T and P of nodes on arms, from `levers` or `slopes`."""
        assert self._t is not None
        chosen = self._couplings.coefficients(by_reference)[self._chosen]
        for matrix, (own, places) in ((self._t, self._of_free), (self._p, self._of_prescribed)):
            matrix.data[places] = chosen[own]

    def _find_curved(self) -> tuple[tuple[IntArray, ...], IntArray]:
        """Find the pairs of unknowns of a reference node to which `KinematicCouplings.curvature` adds stiffness.

        Returns their indices there, and their positions in T^T K T.
        """
        number = np.full(len(self._system) + 1, -1)
        number[self.free] = np.arange(len(self.free))
        turns = number[self._couplings.curved]
        rows, columns = np.broadcast_arrays(turns[:, :, None], turns[:, None, :])
        pairs = np.nonzero((rows >= 0) & (columns >= 0))
        size = len(self.free)
        keys = np.repeat(np.arange(size), np.diff(self.reduced_indptr)) * size + self.reduced_indices
        return pairs, np.searchsorted(keys, rows[pairs] * size + columns[pairs])


def _with_entries(
    matrix: sparse.csr_array, chosen: IntArray, rows: IntArray, columns: IntArray
) -> tuple[sparse.csr_array, tuple[IntArray, IntArray]]:
    """Return a matrix of columns `chosen` with entries of unknowns (rows, columns) added to its pattern.

    Also returns which of these entries it has, and their positions.
    """
    number = np.full(matrix.shape[0] + 1, -1)
    number[chosen] = np.arange(len(chosen))
    own = np.flatnonzero(number[columns] >= 0)
    new = rows[own] * len(chosen) + number[columns[own]]
    old = matrix.tocoo()
    keys = old.row.astype(np.int64) * len(chosen) + old.col
    every = np.union1d(keys, new)
    data = np.zeros(len(every))
    data[np.searchsorted(every, keys)] = old.data
    starts = np.concatenate([[0], np.cumsum(np.bincount(every // max(len(chosen), 1), minlength=matrix.shape[0]))])
    whole = sparse.csr_array((data, every % max(len(chosen), 1), starts), shape=matrix.shape)
    return whole, (own, np.searchsorted(every, new))
