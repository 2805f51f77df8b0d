# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Constraints with rigid arms in large displacements: T and P follow the rotations.

Their transposes pass on moments about the global axes, which are not the derivatives by rotation vectors.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy import sparse

from uel.assembly.constraints import Constraints, products, reduced_pattern
from uel.assembly.kinematic_couplings import Arms
from uel.assembly.prescribed_followers import COLUMNS
from uel.assembly.system import System
from uel.errors import Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.model import Arm, Equation

MASSLESS = 1e-10
"""Mass over the largest one of a reference node below which a movement of it has none."""

ANGLE = 1e-5
"""Rotation in radians over which T is differenced: its error is the square of that."""


class TurningConstraints(Constraints):
    """Constraints of which some have finite rotations; T and P are those of the last `follow`."""

    def __init__(
        self,
        system: System,
        prescribed: IntArray,
        equations: Sequence[Equation],
        places: Mapping[int, Source],
        arms: Sequence[Arm],
        start: FloatArray | None = None,
    ) -> None:
        """Prepare the constraints; arguments as in `Constraints`, and those of `Arms`; start: zero by default.

        Raises DeckError, also if nodes of arms have other constraints.
        """
        n = len(system)
        start = np.zeros(n) if start is None else start
        self._turning = turning = Arms(system.dofs, arms, prescribed, start, system.of_elements)
        super().__init__(system, prescribed, turning.replace_held(equations), places)
        self._equations, self.arms = tuple(equations), tuple(arms)
        apart = np.concatenate([self.free, self.prescribed, turning.eliminated])
        turning.check(np.setdiff1d(np.arange(n), apart), equations)
        rows, columns, steady = np.broadcast_arrays(
            turning.rows[:, :, None], turning.row_sources[:, None, :], turning.steady[:, None, :]
        )
        self._chosen = (rows >= 0) & (columns >= 0)
        where = rows[self._chosen], columns[self._chosen]
        self._t, self._of_free = _with_entries(self._t, self.free, *where)
        self._p, self._of_prescribed = _with_entries(self._p, self.prescribed, *where)
        self._moving = ~steady[self._chosen]
        self._find_pattern()
        self.follow(start, np.zeros(n))

    def _find_pattern(self) -> None:
        """Do the symbolic work as `Constraints` does, and find the entries of T and P that change."""
        super()._find_pattern()
        if not self.arms:
            # T is not complete yet
            return
        assert self._t is not None
        left, right, entry = products(self._system, self._t)
        # which product each value of the map is: it has one
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
        """Return whether these constraints serve, as in `Constraints`, and would be built alike at the start: so that a
        restart of the step builds the same.
        """
        return super().matches(prescribed, equations, arms, start) and self._turning.suit(start)

    def place(self, start: FloatArray, increment: FloatArray) -> FloatArray:
        """Return an increment (n,) with the arms at their finite rotations."""
        return self._turning.place(start, increment)

    def follow(
        self, u: FloatArray, residual: FloatArray, increment: FloatArray | None = None, weight: float = 1.0
    ) -> None:
        """Update T, P and their tangent, see `Constraints.follow`."""
        self._follow_pattern()
        assert self._t is not None
        self._acting = u if increment is None else u - (1.0 - weight) * increment
        self._set(self._turning.levers(self._acting))
        self._t_transposed, self._p_transposed = self._t.T.tocsr(), self._p.T.tocsr()
        left = self._t.data[self._left]
        slopes = self._turning.slopes(u)
        self._set(slopes)
        self._map.data[self._changing] = left * self._t.data[self._right]
        self._curvature = weight * self._turning.curvature(self._acting, residual, slopes)[self._curved[0]]

    def inertia(self, mass: sparse.csr_array) -> sparse.csr_array:
        """Return the part of the mass between reference nodes and dependent nodes, also those without an arm;
        see `Constraints.inertia`.
        """
        moving = np.zeros(mass.shape[0])
        moving[np.unique(self._of_bodies()[0].indices)] = 1.0
        chosen = sparse.dia_array((moving[None, :], [0]), shape=mass.shape)
        found = (chosen @ mass @ chosen).tocsr()
        found.eliminate_zeros()
        return found

    def tangential(self, velocity: FloatArray, inertia: sparse.csr_array) -> FloatArray:
        """Return velocities as `Constraints.tangential`, each body by itself:
        consistent masses between bodies are left out.
        """
        following = self.along(velocity)
        moving, columns, body, own = self._of_bodies()
        units = self._turning.units
        masses = (moving.T @ (inertia @ moving)).tocoo()
        same = body[masses.row] == body[masses.col]
        row, column = masses.row[same], masses.col[same]
        of_bodies = np.zeros((len(units), COLUMNS, COLUMNS))
        of_bodies[body[row], own[row], own[column]] = masses.data[same]
        of_bodies *= units[:, :, None] * units[:, None, :]
        momenta = np.zeros(units.shape)
        momenta[body, own] = moving.T @ (inertia @ (velocity - following))
        # no momentum tells a velocity about a line on which all masses of a body lie
        inverse = np.linalg.pinv(of_bodies, MASSLESS, hermitian=True)
        changes = units * np.einsum("mab,mb->ma", inverse, units * momenta)
        rates = np.zeros(len(self.free) + len(self.prescribed))
        rates[columns] = changes[body, own]
        found = following + self.expand(*np.split(rates, [len(self.free)]))
        found[self.prescribed] = velocity[self.prescribed]
        return found

    def _of_bodies(self) -> tuple[sparse.csc_array, IntArray, IntArray, IntArray]:
        """Return the columns of (T P) that move bodies, their numbers, and row and column of each in `units`.

        Those of prescribed rotations count: the velocities that an integration gives them and nodes on arms differ by
        the error of chords for arcs. Those of prescribed displacements do not, of which the others are sums.
        """
        number = np.full(len(self._system) + 1, -1)
        turns = np.isin(self.prescribed, self._turning.rotations)
        number[self.prescribed] = np.where(turns, len(self.free) + np.arange(len(turns)), -1)
        number[self.free] = np.arange(len(self.free))
        columns = number[self._turning.sources[:, :COLUMNS]]
        body, own = np.nonzero(columns >= 0)
        both = sparse.hstack([self._t, self._p]).tocsc()
        return both[:, columns[body, own]], columns[body, own], body, own

    def convective(self, u: FloatArray, velocity: FloatArray) -> FloatArray:
        """Compute centripetal accelerations, by central differences of T and P, which are those of u afterwards;
        see `Constraints.convective`.
        """
        zero = np.zeros_like(u)
        spin = float(np.abs(velocity[self._turning.rotations]).max(initial=0.0))
        if not spin:
            return zero
        time = ANGLE / spin
        self.follow(u + time * velocity, zero)
        ahead = self.along(velocity)
        self.follow(u - time * velocity, zero)
        behind = self.along(velocity)
        self.follow(u, zero)
        return np.asarray((ahead - behind) / (2.0 * time))

    def reduce_tangent(self, data: FloatArray) -> FloatArray:
        """Reduce a tangent and add the stiffness of the arms, see `Constraints.reduce_tangent`."""
        reduced = self.reduce(data)
        np.add.at(reduced, self._curved[1], self._curvature)
        return reduced

    def refuse_unbalanced(self, residual: FloatArray) -> None:
        """Refuse moments that nothing balances, see `Constraints.refuse_unbalanced`."""
        self._turning.refuse_idle_moments(self._acting, residual)

    @property
    def overconstraints(self) -> list[tuple[int, Source]]:
        """Overconstraints, see `Constraints`, with prescribed displacements of nodes on arms."""
        return super().overconstraints + self._turning.redundant

    def _excesses(self, u: FloatArray) -> list[float]:
        """Return the errors of the redundant equations, then those of the arms."""
        own: list[float] = self._turning.excesses(u).tolist()
        return super()._excesses(u) + own

    def _set(self, by_reference: FloatArray) -> None:
        """Set the entries of T and P that arms determine, from their `levers` or `slopes`."""
        assert self._t is not None
        chosen = self._turning.coefficients(by_reference)[self._chosen]
        for matrix, (own, places) in ((self._t, self._of_free), (self._p, self._of_prescribed)):
            matrix.data[places] = chosen[own]

    def _find_curved(self) -> tuple[tuple[IntArray, ...], IntArray]:
        """Find pairs of unknowns of a reference node with a stiffness of arms: in `Arms.curvature`, and in T^T K T."""
        number = np.full(len(self._system) + 1, -1)
        number[self.free] = np.arange(len(self.free))
        turns = number[self._turning.curved]
        rows, columns = np.broadcast_arrays(turns[:, :, None], turns[:, None, :])
        pairs = np.nonzero((rows >= 0) & (columns >= 0))
        size = len(self.free)
        keys = np.repeat(np.arange(size), np.diff(self.reduced_indptr)) * size + self.reduced_indices
        return pairs, np.searchsorted(keys, rows[pairs] * size + columns[pairs])


def _with_entries(
    matrix: sparse.csr_array, chosen: IntArray, rows: IntArray, columns: IntArray
) -> tuple[sparse.csr_array, tuple[IntArray, IntArray]]:
    """Return a matrix of columns `chosen` with entries of unknowns (rows, columns) added to its pattern.

    Also returns which of the entries it has, and where.
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
