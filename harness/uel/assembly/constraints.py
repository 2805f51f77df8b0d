# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Elimination of prescribed unknowns and of *EQUATION: u = T q + P p, solved in T^T K T."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from uel.assembly.equations import eliminate, named
from uel.assembly.system import System
from uel.errors import DeckError, Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.model import Arm, Equation
from uel.parallel.ranks import Ranks

CONSISTENT = 1e-6
"""Relative difference up to which two values of an unknown agree: decks have six digits."""


class Constraints:
    """The map between all unknowns u (n,), the free ones q and the prescribed ones p.

    prescribed       (n_p,) prescribed unknowns, in the caller's order
    free             (n_q,) free unknowns, ascending
    reduced_indptr, reduced_indices  CSR pattern of T^T K T, int32, columns ascending in each row

    arms             rigid arms with finite rotations

    The symbolic work is done once, and again when the pattern of the system changes. Keep the object while `matches`
    holds.
    """

    arms: tuple[Arm, ...] = ()

    def __init__(
        self,
        system: System,
        prescribed: IntArray,
        equations: Sequence[Equation] = (),
        sources: Mapping[int, Source] | None = None,
    ) -> None:
        """Do the symbolic work on a set of constraints.

        Parameters
        ----------
        system
            System that the constraints apply to.
        prescribed
            (n_p,) prescribed unknowns.
        equations
            The first term of each is eliminated, or another one if that is prescribed.
        sources
            Location in the deck of each prescribed unknown, for messages.

        Raises
        ------
        DeckError
            The model is over-constrained: the first term of an equation is also that of another one or depends on
            itself. Or its coefficient is zero, or the system does not have an unknown of an equation.
        ValueError
            Prescribed unknowns are repeated or negative.
        """
        n = len(system)
        self.prescribed = np.array(prescribed, dtype=np.int64)
        self._system = system
        self._equations = tuple(equations)
        kind = np.zeros(n, dtype=np.int8)
        kind[self.prescribed] = 1
        if np.count_nonzero(kind) < len(self.prescribed) or self.prescribed.min(initial=0) < 0:
            raise ValueError("prescribed unknowns must be distinct and not negative")
        self._sources = sources or {}
        dependent, coefficients, self._redundant = eliminate(system.dofs, equations, self.prescribed)
        kind[dependent] = 2
        self.free = np.flatnonzero(kind == 0)
        self._t: sparse.csr_array | None = None
        if len(dependent):
            self._t = _columns(n, self.free, dependent, coefficients)
            self._p = _columns(n, self.prescribed, dependent, coefficients)
            self._t_transposed, self._p_transposed = self._t.T.tocsr(), self._p.T.tocsr()
        self._find_pattern()

    def _find_pattern(self) -> None:
        """Do the symbolic work on the pattern of the system."""
        if self._t is not None:
            self.reduced_indptr, self.reduced_indices, self._map = reduced_pattern(self._system, self._t)
        else:
            self.reduced_indptr, self.reduced_indices, self._take = _take_pattern(self._system, self.free)
        self._reduced = np.zeros(len(self.reduced_indices))
        self._pattern = self._system.indices

    def _refresh_pattern(self) -> None:
        """Repeat the symbolic work if the system has another pattern."""
        if self._pattern is not self._system.indices:
            self._find_pattern()

    def matches(
        self, prescribed: IntArray, equations: Sequence[Equation], arms: Sequence[Arm], start: FloatArray
    ) -> bool:
        """Return whether these constraints can be reused for a step, so that symbolic work need not be repeated.

        Parameters
        ----------
        prescribed
            (n_p,) prescribed unknowns, compared in this order.
        equations
            Compared in this order, with their locations in the deck.
        arms
            Rigid arms with finite rotations.
        start
            (n,) unknowns at which a step begins.
        """
        same = self._equations == tuple(equations) and self.arms == tuple(arms)
        return same and np.array_equal(self.prescribed, prescribed)

    @property
    def overconstraints(self) -> list[tuple[int, Source]]:
        """Prescribed unknowns that a constraint determines too, from other prescribed ones, and this constraint."""
        return [(one.unknown, one.source) for one in self._redundant]

    def _redundancy_errors(self, u: FloatArray) -> list[float]:
        """Return the relative errors of the redundant equations."""
        return [one.error(u) for one in self._redundant]

    def refuse_contradictions(self, u: FloatArray, moment: str) -> None:
        """Raise DeckError where overconstraints contradict at unknowns u (n,); moment: step and increment, in words."""
        for (unknown, source), error in zip(self.overconstraints, self._redundancy_errors(u), strict=True):
            if error > CONSISTENT:
                where = f" at {self._sources[unknown]}" if unknown in self._sources else ""
                raise DeckError(
                    source,
                    f"over-constrained: {named(self._system.dofs, unknown)} is prescribed{where}, and other prescribed "
                    "values give it another value by this constraint: they differ by "
                    f"{error:.2g} of their size ({moment})",
                )

    def refuse_unbalanced(self, residual: FloatArray) -> None:
        """Raise DeckError if forces (n,) do work on a rotation without effect, in the state of the last `update`."""

    @property
    def ranks(self) -> Ranks:
        """Ranks of the system; each has the part of T^T K T that comes from its elements."""
        return self._system.ranks

    @property
    def coordinates(self) -> FloatArray:
        """Original coordinates (n_q, 3) of the nodes of the free unknowns, for orderings and multigrid."""
        return self._system.dofs.coordinates[self.free]

    @property
    def dofs(self) -> IntArray:
        """Dofs (n_q,) of the free unknowns."""
        return self._system.dofs.dof[self.free]

    def name(self, unknown: int) -> tuple[str, int]:
        """Return node name and dof of an unknown, for messages."""
        return self._system.dofs.name(unknown)

    def name_of(self, reduced: int) -> tuple[str, int]:
        """Return node name and dof of a free unknown, for messages.

        Parameters
        ----------
        reduced
            Its position in `free`, from 0.
        """
        return self._system.dofs.name(int(self.free[reduced]))

    def satisfy(self, start: FloatArray, increment: FloatArray) -> FloatArray:
        """Return an increment (n,) that fulfils the constraints; linear ones hold for sums of results of `expand`.

        Parameters
        ----------
        start
            (n,) unknowns at its start.
        increment
            (n,) increment that fulfils them to first order.

        Returns
        -------
        FloatArray
            (n,).
        """
        del start
        return increment

    def update(
        self, u: FloatArray, residual: FloatArray, increment: FloatArray | None = None, weight: float = 1.0
    ) -> None:
        """Update T and P to a state, and the stiffness that the change of T adds to the tangent.

        Parameters
        ----------
        u
            (n,) unknowns.
        residual
            (n,) external minus internal forces.
        increment
            (n,) increment of the unknowns; `residual` is a weighted mean of the forces at its end and at its start.
        weight
            Weight of the forces at its end, u. Constraints transfer the mean in the directions at the mean unknowns,
            u - (1 - weight) increment.
        """

    def expand(self, dq: FloatArray, dprescribed: FloatArray) -> FloatArray:
        """Compute du = T dq + P dp.

        Parameters
        ----------
        dq
            (n_q,) values of the free unknowns, in the order of `free`.
        dprescribed
            (n_p,) values of the prescribed ones, in the order of `prescribed`.

        Returns
        -------
        FloatArray
            (n,) values of all unknowns.
        """
        if self._t is not None:
            return np.asarray(self._t @ dq + self._p @ dprescribed)
        du = np.zeros(len(self._system))
        du[self.free] = dq
        du[self.prescribed] = dprescribed
        return du

    def project(self, direction: FloatArray) -> FloatArray:
        """Project a direction on the constraints in the state of the last `update`: free and prescribed unknowns stay.

        Parameters
        ----------
        direction
            (n,) changes of all unknowns.

        Returns
        -------
        FloatArray
            (n,); its product with forces is their work along the constraints.
        """
        return self.expand(direction[self.free], direction[self.prescribed])

    def inertia(self, mass: sparse.csr_array) -> sparse.csr_array:
        """Return the part of a mass matrix (n, n) that `project_velocity` uses."""
        return sparse.csr_array(mass.shape)

    def project_velocity(self, velocity: FloatArray, inertia: sparse.csr_array) -> FloatArray:
        """Project velocities on the constraints in the state of the last `update`, with the same momenta.

        Parameters
        ----------
        velocity
            (n,) velocities v, which fulfil them up to the error of an integration.
        inertia
            M, from `inertia`.

        Returns
        -------
        FloatArray
            (n,): w = T dq/dt + P dp/dt with T^T M w = T^T M v for the free unknowns of reference nodes, and P^T M w =
            P^T M v for their prescribed rotations as far as other nodes follow these. All other free unknowns, and the
            prescribed ones, keep their velocities.
        """
        del inertia
        return velocity

    def convective(self, u: FloatArray, velocity: FloatArray) -> FloatArray:
        """Return accelerations (n,) at unknowns u (n,) with velocities (n,) and no acceleration of the free and
        prescribed unknowns.
        """
        del velocity
        return np.zeros_like(u)

    def reduce_vector(self, vector: FloatArray) -> FloatArray:
        """Compute T^T r.

        Parameters
        ----------
        vector
            r: (n,) forces on all unknowns.

        Returns
        -------
        FloatArray
            (n_q,) forces on the free unknowns, with those that the equations transfer to them.
        """
        if self._t is None:
            return vector[self.free]
        return np.asarray(self._t_transposed @ vector)

    def reactions(self, residual: FloatArray) -> FloatArray:
        """Compute reaction forces, RF of Abaqus: -P^T r.

        Parameters
        ----------
        residual
            r: (n,) external minus internal force over all unknowns, concentrated loads included.

        Returns
        -------
        FloatArray
            (n,) in the order of all unknowns, zero where nothing is prescribed.
        """
        reaction = np.zeros(len(self._system))
        reaction[self.prescribed] = -residual[self.prescribed] if self._t is None else -(self._p_transposed @ residual)
        return reaction

    def reduce(self, data: FloatArray) -> FloatArray:
        """Compute the CSR values of T^T K T from those of K.

        Parameters
        ----------
        data
            (nnz,) in the pattern of the system.

        Returns
        -------
        FloatArray
            In the pattern of `reduced_indptr` and `reduced_indices`; overwritten by the next call.
        """
        self._refresh_pattern()
        if self._t is None:
            # 'clip' only because numpy buffers `out` in the checking mode; all positions are in range
            return np.take(data, self._take, out=self._reduced, mode="clip")
        self._reduced[:] = self._map @ data
        return self._reduced

    def reduce_tangent(self, data: FloatArray) -> FloatArray:
        """Reduce a tangent as `reduce` does, and add the stiffness of the constraints."""
        return self.reduce(data)

    def prescribed_residual(self, data: FloatArray, dprescribed: FloatArray) -> FloatArray:
        """Compute K P dp: internal force of prescribed increments, to be subtracted from the residual before solving.

        Parameters
        ----------
        data
            (nnz,) CSR values of K.
        dprescribed
            dp: (n_p,) in the order of `prescribed`.

        Returns
        -------
        FloatArray
            (n,) force on all unknowns.
        """
        if not np.any(dprescribed):
            return np.zeros(len(self._system))
        du = self.expand(np.zeros(len(self.free)), dprescribed)
        return self._system.product(data, du)


def _columns(n: int, chosen: IntArray, dependent: IntArray, coefficients: sparse.csr_array) -> sparse.csr_array:
    """Return the matrix (n, chosen) from the chosen independent unknowns to all unknowns."""
    by_dependent = coefficients[:, chosen].tocoo()
    rows = np.concatenate([chosen, dependent[by_dependent.row]])
    columns = np.concatenate([np.arange(len(chosen)), by_dependent.col])
    values = np.concatenate([np.ones(len(chosen)), by_dependent.data])
    return sparse.coo_array((values, (rows, columns)), shape=(n, len(chosen))).tocsr()


def _row_of_entries(system: System) -> IntArray:
    return np.repeat(np.arange(len(system)), np.diff(system.indptr))


def _take_pattern(system: System, free: IntArray) -> tuple[NDArray[np.int32], NDArray[np.int32], IntArray]:
    """Return the CSR pattern of the rows and columns of free unknowns, and its positions in the full matrix."""
    number = np.full(len(system), -1, dtype=np.int32)
    number[free] = np.arange(len(free))
    row, column = number[_row_of_entries(system)], number[system.indices]
    take = np.flatnonzero((row >= 0) & (column >= 0))
    return _row_starts(row[take], len(free)), column[take], take


def reduced_pattern(
    system: System, t: sparse.csr_array, values: FloatArray | None = None
) -> tuple[NDArray[np.int32], NDArray[np.int32], sparse.csr_array]:
    """Return the CSR pattern of T^T K T, and the matrix from the values of K to its values.

    Entry (i, j) of K contributes T[i, a] K[i, j] T[j, b] to entry (a, b); `values` replace the products of T.
    """
    left, right, entry = products(system, t)
    key = t.indices[left].astype(np.int64) * t.shape[1] + t.indices[right]
    unique, position = np.unique(key, return_inverse=True)
    values = t.data[left] * t.data[right] if values is None else values
    gather = sparse.coo_array((values, (position, entry)), shape=(len(unique), len(system.indices))).tocsr()
    return _row_starts(unique // t.shape[1], t.shape[1]), (unique % t.shape[1]).astype(np.int32), gather


def products(system: System, t: sparse.csr_array) -> tuple[IntArray, IntArray, IntArray]:
    """Return, for each term of T^T K T, the positions of its left entry of T, its right entry of T, and that of K."""
    count = np.diff(t.indptr)
    row, column = _row_of_entries(system), system.indices
    terms = count[row] * count[column]
    entry = np.repeat(np.arange(len(row)), terms)
    nth = np.arange(len(entry)) - np.repeat(np.cumsum(terms) - terms, terms)
    row, column = row[entry], column[entry]
    return t.indptr[row] + nth // count[column], t.indptr[column] + nth % count[column], entry


def _row_starts(rows: NDArray[np.integer], n: int) -> NDArray[np.int32]:
    return np.concatenate([[0], np.cumsum(np.bincount(rows, minlength=n))]).astype(np.int32)
