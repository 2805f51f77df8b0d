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
"""Relative difference up to which two values of an unknown are the same: decks have six digits."""


class Constraints:
    """The map between all unknowns u (n,), the free ones q and the prescribed ones p.

    prescribed       (n_p,) unknowns with a given value, in the caller's order
    free             (n_q,) unknowns that are solved for, ascending
    reduced_indptr, reduced_indices  CSR pattern of T^T K T, int32, columns ascending in each row

    arms             those of the equations with finite rotations

    Everything symbolic is done here once, and again where `reduce` finds that the system has another pattern; keep the
    object while `matches` holds.
    """

    arms: tuple[Arm, ...] = ()

    def __init__(
        self,
        system: System,
        prescribed: IntArray,
        equations: Sequence[Equation] = (),
        places: Mapping[int, Source] | None = None,
    ) -> None:
        """Do the symbolic work on a set of constraints.

        Parameters
        ----------
        system
            What the constraints apply to.
        prescribed
            (n_p,) unknowns with a given value.
        equations
            The first term of each is eliminated, or another one if that is prescribed.
        places
            Where the deck prescribes an unknown, for messages.

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
        self._places = places or {}
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

    def _follow_pattern(self) -> None:
        """Repeat the symbolic work if the system has another pattern."""
        if self._pattern is not self._system.indices:
            self._find_pattern()

    def matches(
        self, prescribed: IntArray, equations: Sequence[Equation], arms: Sequence[Arm], start: FloatArray
    ) -> bool:
        """Return whether these constraints also serve the given ones, so that symbolic work need not be repeated.

        Parameters
        ----------
        prescribed
            (n_p,) unknowns with a given value, compared in this order.
        equations
            Compared in this order, with their places in the deck.
        arms
            Those of the equations with finite rotations.
        start
            (n,) unknowns at which a step begins.
        """
        same = self._equations == tuple(equations) and self.arms == tuple(arms)
        return same and np.array_equal(self.prescribed, prescribed)

    @property
    def overconstraints(self) -> list[tuple[int, Source]]:
        """Prescribed unknowns that follow from other prescribed ones too, and the constraint by which they do."""
        return [(one.unknown, one.source) for one in self._redundant]

    def _excesses(self, u: FloatArray) -> list[float]:
        """Return the errors of the redundant equations, over the sums of the magnitudes of their terms."""
        return [one.excess(u) for one in self._redundant]

    def refuse_contradictions(self, u: FloatArray, moment: str) -> None:
        """Raise DeckError where two such values differ at unknowns u (n,); moment: step and increment, in words."""
        for (unknown, source), excess in zip(self.overconstraints, self._excesses(u), strict=True):
            if excess > CONSISTENT:
                where = f" at {self._places[unknown]}" if unknown in self._places else ""
                raise DeckError(
                    source,
                    f"over-constrained: {named(self._system.dofs, unknown)} is prescribed{where}, and other prescribed "
                    "values give it another value by this constraint: they differ by "
                    f"{excess:.2g} of their size ({moment})",
                )

    def refuse_unbalanced(self, residual: FloatArray) -> None:
        """Raise DeckError if forces (n,) work on a motion that moves nothing else, in the last state of `follow`."""

    @property
    def ranks(self) -> Ranks:
        """Ranks of the system: each has the part of T^T K T of its elements."""
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
            Its place in `free`, from 0.
        """
        return self._system.dofs.name(int(self.free[reduced]))

    def place(self, start: FloatArray, increment: FloatArray) -> FloatArray:
        """Return an increment (n,) that fulfils the constraints; if they are linear, sums of those of `expand` do.

        Parameters
        ----------
        start
            (n,) unknowns at its start.
        increment
            (n,) up to the order of the constraints.

        Returns
        -------
        FloatArray
            (n,).
        """
        del start
        return increment

    def follow(
        self, u: FloatArray, residual: FloatArray, increment: FloatArray | None = None, weight: float = 1.0
    ) -> None:
        """Update T and P to a state, and the stiffness that forces add to the tangent as T changes.

        Parameters
        ----------
        u
            (n,) unknowns.
        residual
            (n,) external minus internal forces.
        increment
            (n,) change of the unknowns over the time between the forces of which `residual` is the mean.
        weight
            Of the forces at u in this mean, the others are those at u - increment: the mean passes on in the directions
            of the mean unknowns, u - (1 - weight) increment.
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

    def along(self, direction: FloatArray) -> FloatArray:
        """Return the direction with the same free and prescribed unknowns, in the state of the last `follow`.

        Parameters
        ----------
        direction
            (n,) changes of all unknowns.

        Returns
        -------
        FloatArray
            (n,): its product with forces is their work on the path that fulfils the constraints.
        """
        return self.expand(direction[self.free], direction[self.prescribed])

    def inertia(self, mass: sparse.csr_array) -> sparse.csr_array:
        """Return the part of a mass matrix (n, n) that `tangential` uses."""
        return sparse.csr_array(mass.shape)

    def tangential(self, velocity: FloatArray, inertia: sparse.csr_array) -> FloatArray:
        """Return the velocities that fulfil the constraints in the state of the last `follow`, with the same momenta.

        Parameters
        ----------
        velocity
            (n,) velocities v that fulfil them up to the error of an integration.
        inertia
            M, from `inertia`.

        Returns
        -------
        FloatArray
            (n,): T dq/dt + P dp/dt, with T^T M times it equal to T^T M v for the free unknowns of reference nodes. So
            has P^T M with their prescribed rotations, about which the velocities of other nodes are not those of dp/dt.
            All other free unknowns and the prescribed ones have theirs.
        """
        del inertia
        return velocity

    def convective(self, u: FloatArray, velocity: FloatArray) -> FloatArray:
        """Return accelerations (n,) at unknowns u (n,) with velocities (n,),
        if the free and prescribed ones have none.
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
            (n_q,) forces on the free unknowns, with what the equations pass on to them.
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
        self._follow_pattern()
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
    """Return the (n, chosen) matrix that gives all unknowns from the chosen independent ones."""
    by_dependent = coefficients[:, chosen].tocoo()
    rows = np.concatenate([chosen, dependent[by_dependent.row]])
    columns = np.concatenate([np.arange(len(chosen)), by_dependent.col])
    values = np.concatenate([np.ones(len(chosen)), by_dependent.data])
    return sparse.coo_array((values, (rows, columns)), shape=(n, len(chosen))).tocsr()


def _row_of_entries(system: System) -> IntArray:
    return np.repeat(np.arange(len(system)), np.diff(system.indptr))


def _take_pattern(system: System, free: IntArray) -> tuple[NDArray[np.int32], NDArray[np.int32], IntArray]:
    """Return the pattern of the rows and columns of free unknowns,
    and the positions of its entries in the full matrix.
    """
    number = np.full(len(system), -1, dtype=np.int32)
    number[free] = np.arange(len(free))
    row, column = number[_row_of_entries(system)], number[system.indices]
    take = np.flatnonzero((row >= 0) & (column >= 0))
    return _row_starts(row[take], len(free)), column[take], take


def reduced_pattern(
    system: System, t: sparse.csr_array, values: FloatArray | None = None
) -> tuple[NDArray[np.int32], NDArray[np.int32], sparse.csr_array]:
    """Return the pattern of T^T K T, and the matrix M that gives its values from those of K.

    Entry (i, j) of K contributes T[i, a] T[j, b] to entry (a, b), or `values` in place of these products.
    """
    left, right, entry = products(system, t)
    key = t.indices[left].astype(np.int64) * t.shape[1] + t.indices[right]
    unique, position = np.unique(key, return_inverse=True)
    values = t.data[left] * t.data[right] if values is None else values
    gather = sparse.coo_array((values, (position, entry)), shape=(len(unique), len(system.indices))).tocsr()
    return _row_starts(unique // t.shape[1], t.shape[1]), (unique % t.shape[1]).astype(np.int32), gather


def products(system: System, t: sparse.csr_array) -> tuple[IntArray, IntArray, IntArray]:
    """Return entries of T, left and right, whose product with an entry of K is a term of T^T K T; and that entry."""
    count = np.diff(t.indptr)
    row, column = _row_of_entries(system), system.indices
    terms = count[row] * count[column]
    entry = np.repeat(np.arange(len(row)), terms)
    nth = np.arange(len(entry)) - np.repeat(np.cumsum(terms) - terms, terms)
    row, column = row[entry], column[entry]
    return t.indptr[row] + nth // count[column], t.indptr[column] + nth % count[column], entry


def _row_starts(rows: NDArray[np.integer], n: int) -> NDArray[np.int32]:
    return np.concatenate([[0], np.cumsum(np.bincount(rows, minlength=n))]).astype(np.int32)
