# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rigid arms in large displacements: nodes that follow the finite rotation of a reference node.

With the rotation vector theta of the reference node, dofs 4 to 6, its displacement u_R and the arm r before any
displacement,

    u = u_R + (R(theta) - 1) r,    du = du_R - [R r]x H(theta) dtheta,

where H dtheta is the spin (Abaqus Theory Guide, Rotation variables; J. Argyris, Computer Methods in Applied Mechanics
and Engineering 32 (1982) 85). Forces f pass on moments R r x f about the global axes, as Abaqus has them in *CLOAD and
RM: no derivatives by theta, so that matrices are not symmetric where rotations about several axes are large. In the
plane theta is dof 6 alone.

Where a displacement of a node is prescribed, its equation eliminates an unknown of the reference node
(`held_followers.py`): with x the six of them, dx = Q dx' + Q_p dp, x' those that are left.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from uel.assembly.dofs import DofMap
from uel.assembly.prescribed_followers import COLUMNS, SMALLEST, HeldFollowers, choose
from uel.elements import PERMUTATION, rotation_matrices, spin_matrices
from uel.errors import DeckError, SingularMatrixError, Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.dofs import DISPLACEMENTS, ROTATIONS
from uel.model.model import Arm, Equation

IMAGINARY = 1e-30
"""Step of derivatives: the imaginary part of a function of theta + i h has no cancellation."""

ITERATIONS = 30
"""Newton iterations for the eliminated rotations of a reference node; those of displacements alone are exact."""

PLACED = 1e-14
"""Error of a prescribed displacement, over the lengths that it is computed from, at which those iterations end."""

STRAIGHT = 1e-12
"""Square of the width over that of the length below which nodes lie on a line."""

UNBALANCED = 1e-6
"""Moment that nothing balances, over the moments that forces on the arms can have: that of rounding is smaller."""

UNREACHABLE = "no position of it gives the prescribed displacements of the nodes that follow it"

_DISPLACEMENTS, _ROTATIONS = np.array(DISPLACEMENTS), np.array(ROTATIONS)
_MOVES, _TURNS = slice(0, 3), slice(3, 6)


class Arms:
    """All arms of a model.

    own      (k, 3) unknowns: the displacements of each node, -1 where there is none
    of       (k,) row of its reference node
    columns  (references, 6) unknowns of the reference nodes, -1 where there is none
    sources  (references, 6 + w) unknowns from which those of each reference node follow: its own ones, -1 those that
             are eliminated, then up to w prescribed displacements of nodes that follow
    held     prescribed displacements of nodes that follow
    """

    def __init__(
        self,
        dofs: DofMap,
        arms: Sequence[Arm],
        prescribed: IntArray,
        start: FloatArray,
        stiff: NDArray[np.bool_],
    ) -> None:
        """Choose the unknowns of reference nodes that are eliminated.

        Parameters
        ----------
        dofs
            Numbers of the unknowns.
        arms
            All of the model.
        prescribed
            Unknowns with a given value.
        start
            (n,) unknowns, at which prescribed displacements choose what they eliminate.
        stiff
            (n,) whether an element has the unknown.
        """
        self._dofs, self._arms = dofs, arms
        nodes, references = (
            np.array([getattr(arm, name) for arm in arms], dtype=np.int64) for name in ("node", "reference")
        )
        self.references, self.of = np.unique(references, return_inverse=True)
        points = dofs.mesh.coordinates
        self._arm = points[nodes] - points[references]
        self.own = dofs.find(nodes[:, None], _DISPLACEMENTS)
        self.columns = dofs.find(self.references[:, None], np.concatenate([_DISPLACEMENTS, _ROTATIONS]))
        self._length = np.zeros(len(self.references))
        np.maximum.at(self._length, self.of, np.linalg.norm(self._arm, axis=1))
        held = (self.own >= 0) & np.isin(self.own, prescribed)
        free = (self.columns >= 0) & ~np.isin(self.columns, prescribed)
        self._idle = self._find_idle(free & ~stiff[self.columns])
        free[self._idle] = False
        self._held, self._free = held, free
        self.held = self._choose(start)
        self._follows = (self.own >= 0) & ~held
        solved = self.held.solved
        width = max((len(equations) for _, equations in solved), default=0)
        self.sources = np.hstack([self.columns, np.full((len(self.references), width), -1)])
        self.sources[self._idle] = -1
        for row, equations in solved:
            self.sources[row, self.held.eliminated[equations]] = -1
            self.sources[row, COLUMNS : COLUMNS + len(equations)] = self.held.unknown[equations]

    def _choose(self, start: FloatArray) -> HeldFollowers:
        return choose(self.slopes(start), self._length[self.of], self.own, self.of, self._held, self._free)

    def suit(self, start: FloatArray) -> bool:
        """Return whether prescribed displacements would choose the same unknowns to eliminate at unknowns (n,)."""
        return np.array_equal(self._choose(start).eliminated, self.held.eliminated)

    @property
    def eliminated(self) -> IntArray:
        """Unknowns of reference nodes that are not solved for."""
        own = ~self.held.redundant
        determined = self.columns[self.held.reference[own], self.held.eliminated[own]]
        return np.concatenate([determined, self.columns[self._idle]])

    @property
    def redundant(self) -> list[tuple[int, Source]]:
        """Prescribed displacements that follow from others, and the constraint by which they do."""
        held, own = self.held, np.flatnonzero(self.held.redundant)
        return [(int(held.unknown[k]), self._arms[held.arm[k]].source) for k in own]

    @property
    def rotations(self) -> IntArray:
        """Unknowns that are rotations of reference nodes."""
        turns = self.columns[:, _TURNS]
        return turns[turns >= 0]

    @property
    def units(self) -> FloatArray:
        """Units (references, 6) in which movements of reference nodes have the size of those of their nodes."""
        found = np.ones(self.columns.shape)
        found[:, _TURNS] = 1.0 / np.where(self._length > 0.0, self._length, 1.0)[:, None]
        return found

    @property
    def curved(self) -> IntArray:
        """Unknowns (references, 6) of `curvature` that are left, -1 for those between which it is always zero."""
        found = self.sources[:, :COLUMNS].copy()
        steady = np.ones(len(found), dtype=np.bool_)
        steady[[row for row, _ in self.held.solved]] = False
        found[steady, _MOVES] = -1
        return found

    def _find_idle(self, free: NDArray[np.bool_]) -> tuple[IntArray, IntArray]:
        """Find rows and columns of rotations without effect: all nodes lie on a line through the reference node.

        Of the rotation vectors that differ by turns about this line, the component along the nearest axis stays.
        free: (references, 6) where nothing else determines an unknown.
        """
        square = np.zeros((len(self.references), 3, 3))
        np.add.at(square, self.of, self._arm[:, :, None] * self._arm[:, None, :])
        sizes, directions = np.linalg.eigh(square)
        along = np.abs(directions[:, :, 2])
        straight = (sizes[:, 1] <= STRAIGHT * sizes[:, 2]) & (free[:, _TURNS] | (along <= SMALLEST)).all(axis=1)
        rows = np.flatnonzero(straight)
        return rows, 3 + np.asarray(along[rows].argmax(axis=1))

    def refuse_idle_moments(self, u: FloatArray, residual: FloatArray) -> None:
        """Raise DeckError if a moment acts about a line on which the nodes lie, at unknowns and with forces (n,)."""
        rows, columns = self._idle
        if not len(rows):
            return
        force = np.where(self._follows, _gathered(residual, self.own), 0.0)
        total, size = _gathered(residual, self.columns), np.abs(_gathered(residual, self.columns))
        each = np.einsum("kac,ka->kc", self.levers(u), force)
        np.add.at(total, self.of, each)
        np.add.at(size, self.of, np.linalg.norm(force, axis=1)[:, None] * self._length[self.of, None])
        unbalanced = np.flatnonzero(np.abs(total)[rows, columns] > UNBALANCED * size[rows, columns])
        if len(unbalanced):
            row = int(rows[unbalanced[0]])
            arm = self._arms[int(np.flatnonzero(self.of == row)[0])]
            name = self._dofs.mesh.name(arm.reference)
            message = f"a moment acts on reference node {name} about the line on which it and its nodes lie"
            raise DeckError(arm.source, f"{message}: nothing balances it")

    def replace_held(self, equations: Sequence[Equation]) -> list[Equation]:
        """Return the equations to first order, with those of prescribed displacements
        replaced by the unknowns they eliminate.

        The coefficients of these are those of `coefficients`. So do equations that hold rotations without effect.
        """
        held = self.held
        prescribed = {(self._arms[arm].node, axis + 1) for arm, axis in zip(held.arm, held.axis, strict=True)}
        kept = [one for one in equations if one.terms[0][:2] not in prescribed]
        for k in np.flatnonzero(~held.redundant):
            term = int(self.references[held.reference[k]]), int(held.eliminated[k]) + 1, 1.0
            kept.append(Equation((term,), self._arms[held.arm[k]].source))
        for row, column in zip(*self._idle, strict=True):
            source = self._arms[int(np.flatnonzero(self.of == row)[0])].source
            kept.append(Equation(((int(self.references[row]), int(column) + 1, 1.0),), source))
        return kept

    def check(self, dependent: IntArray, equations: Sequence[Equation]) -> None:
        """Refuse arms beside other constraints.

        Parameters
        ----------
        dependent
            Unknowns that equations eliminate, without those that prescribed displacements do.
        equations
            All of the model.

        Raises
        ------
        DeckError
            A reference node, or a node that follows, has another constraint.
        """
        constrained = np.asarray(np.isin(self.columns, dependent).any(axis=1))
        if constrained.any():
            arm = self._arms[int(np.flatnonzero(constrained[self.of])[0])]
            message = f"reference node {self._dofs.mesh.name(arm.reference)} has other constraints"
            raise DeckError(arm.source, f"{message}, which is not supported with NLGEOM")
        following = {arm.node for arm in self._arms}
        for equation in equations:
            for node, dof, _ in equation.terms[1:]:
                if node in following and dof <= _DISPLACEMENTS[-1]:
                    name = self._dofs.mesh.name(node)
                    message = f"node {name} follows a reference node, which is not supported with NLGEOM"
                    raise DeckError(equation.source, f"{message} beside another constraint")

    @property
    def rows(self) -> IntArray:
        """Unknowns (k + references, 6) that depend on others, of nodes and of reference nodes; -1 elsewhere."""
        nodes = np.where(self._follows, self.own, -1)
        gone = np.where(self.sources[:, :COLUMNS] < 0, self.columns, -1)
        gone[self._idle] = -1
        return np.vstack([np.hstack([nodes, np.full_like(nodes, -1)]), gone])

    @property
    def row_sources(self) -> IntArray:
        """Unknowns (k + references, 6 + w) on which these rows depend."""
        return np.vstack([self.sources[self.of], self.sources])

    @property
    def steady(self) -> NDArray[np.bool_]:
        """Mask (k + references, 6 + w) of coefficients that never change: those of displacements of reference nodes
        without an eliminated one.
        """
        steady = np.zeros(self.sources.shape, dtype=np.bool_)
        steady[:, _MOVES] = True
        steady[[row for row, _ in self.held.solved]] = False
        return np.vstack([steady[self.of], steady])

    def place(self, start: FloatArray, increment: FloatArray) -> FloatArray:
        """Return an increment (n,) completed by those of all dependent nodes. Raises SingularMatrixError.

        Those that are eliminated from reference nodes come first.
        """
        u, placed = start + increment, increment.copy()
        for row, equations in self.held.solved:
            own = self.columns[row, self.held.eliminated[equations]]
            self._settle(u, row, equations, own)
            placed[own] = u[own] - start[own]
        following = self._following(u)
        placed[self.own[self._follows]] = following[self._follows] - start[self.own[self._follows]]
        return placed

    def levers(self, u: FloatArray) -> FloatArray:
        """Return forces and moments (k, 3, 6) about the global axes by the forces on each node: force,
        then component.
        """
        turned = np.einsum("kij,kj->ki", rotation_matrices(self._angles(u))[self.of], self._arm)
        return _with_moves(np.einsum("iab,ka->kbi", PERMUTATION, turned))

    def slopes(self, u: FloatArray) -> FloatArray:
        """Return derivatives (k, 3, 6) of the displacements of each node by the unknowns of its reference node."""
        levers = self.levers(u)
        return _with_moves(levers[:, :, _TURNS] @ spin_matrices(self._angles(u))[self.of])

    def coefficients(self, by_reference: FloatArray) -> FloatArray:
        """Return coefficients (k + references, 6, 6 + w) of `rows` on `row_sources`, from `slopes` or `levers`."""
        reduction = self._reduction(by_reference)
        found = np.zeros((len(self.own) + len(self.references), COLUMNS, self.sources.shape[1]))
        found[: len(self.own), _MOVES] = by_reference @ reduction[self.of]
        found[len(self.own) :] = reduction
        return found

    def curvature(self, u: FloatArray, residual: FloatArray, slopes: FloatArray) -> FloatArray:
        """Return the stiffness (references, 6, 6) that forces (n,) add to reference nodes as their arms turn.

        Prescribed displacements of nodes that follow act with the forces that they pass on. The arms are those of
        unknowns u (n,), the turns are about the position of `slopes`.
        """
        levers = self.levers(u)
        force = np.where(self._follows, _gathered(residual, self.own), 0.0)
        total = _gathered(residual, self.columns)
        np.add.at(total, self.of, np.einsum("kac,ka->kc", levers, force))
        for row, equations in self.held.solved:
            arm, axis = self.held.arm[equations], self.held.axis[equations]
            own = self.held.eliminated[equations]
            force[arm, axis] = -np.linalg.solve(levers[arm, axis][:, own].T, total[row, own])
        left, right = (self._reduction(one)[:, _TURNS, :COLUMNS] for one in (levers, slopes))
        return np.asarray(left.transpose(0, 2, 1) @ self._turning(u, force) @ right, dtype=np.float64)

    def excesses(self, u: FloatArray) -> FloatArray:
        """Return the errors of the redundant prescribed displacements at unknowns u (n,),
        over the lengths that they are computed from.
        """
        held, own = self.held, self.held.redundant
        following, given = self._following(u)[held.arm, held.axis][own], u[held.unknown[own]]
        size = self._length[held.reference[own]] + np.abs(following) + np.abs(given)
        return np.asarray(np.abs(given - following) / size, dtype=np.float64)

    def _following(self, u: FloatArray) -> FloatArray:
        """Return the displacements (k, 3) of the nodes from those of their reference nodes."""
        turned = np.einsum("kij,kj->ki", rotation_matrices(self._angles(u))[self.of], self._arm)
        return np.asarray(_gathered(u, self.columns[:, _MOVES])[self.of] + turned - self._arm, dtype=np.float64)

    def _settle(self, u: FloatArray, row: int, equations: IntArray, own: IntArray) -> None:
        """Solve for the eliminated unknowns of a reference node, and set them in u (n,). Raises SingularMatrixError."""
        arm, axis = self.held.arm[equations], self.held.axis[equations]
        columns = self.held.eliminated[equations]
        for _ in range(ITERATIONS):
            missing = u[self.held.unknown[equations]] - self._following(u)[arm, axis]
            size = self._length[row] + np.abs(u[own]).max() + np.abs(u[self.held.unknown[equations]]).max()
            if np.abs(missing).max() <= PLACED * size:
                return
            try:
                u[own] += np.linalg.solve(self.slopes(u)[arm, axis][:, columns], missing)
            except np.linalg.LinAlgError:
                break
        raise SingularMatrixError(*self._dofs.name(int(own[0])), UNREACHABLE)

    def _reduction(self, by_reference: FloatArray) -> FloatArray:
        """Return Q and Q_p (references, 6, 6 + w)."""
        found = np.zeros((len(self.references), COLUMNS, self.sources.shape[1]))
        found[:, range(COLUMNS), range(COLUMNS)] = 1.0
        for row, equations in self.held.solved:
            own = self.held.eliminated[equations]
            rows = by_reference[self.held.arm[equations], self.held.axis[equations]]
            inverse = np.linalg.inv(rows[:, own])
            found[row, own, :COLUMNS] = -inverse @ rows
            found[row, own[:, None], own] = 0.0
            found[row, own, COLUMNS : COLUMNS + len(own)] = inverse
        return found

    def _turning(self, u: FloatArray, force: FloatArray) -> FloatArray:
        """Return the derivatives (references, 3, 3) of minus the moments of forces (k, 3) on the nodes by rotations."""
        moments = np.zeros((len(self.references), 3, 3))
        np.add.at(moments, self.of, force[:, :, None] * self._arm[:, None, :])
        angles = self._angles(u)
        found = np.empty_like(moments)
        for k in range(3):
            step = np.zeros(3, dtype=np.complex128)
            step[k] = 1j * IMAGINARY
            # sum of f x^T, x the arms then; the axial vector of its skew part is the moment
            now = moments @ rotation_matrices(angles + step).transpose(0, 2, 1)
            found[:, :, k] = -np.einsum("iab,mba->mi", PERMUTATION, now).imag / IMAGINARY
        return found

    def _angles(self, u: FloatArray) -> FloatArray:
        return _gathered(u, self.columns[:, _TURNS])


def _with_moves(turning: FloatArray) -> FloatArray:
    """Prepend the unit derivatives by displacements to those by rotations (k, 3, 3): (k, 3, 6)."""
    moving = np.broadcast_to(np.eye(3), turning.shape)
    return np.concatenate([moving, turning], axis=2)


def _gathered(values: FloatArray, unknowns: IntArray) -> FloatArray:
    """Return the values of unknowns, zero for unknown -1."""
    return np.asarray(np.append(values, 0.0)[unknowns], dtype=np.float64)
