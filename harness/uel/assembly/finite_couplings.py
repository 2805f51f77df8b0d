# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Kinematic couplings in large displacements: nodes that follow the finite rotation of a reference node by rigid arms.

With the rotation vector theta of the reference node, dofs 4 to 6, its displacement u_R and the arm r before any
displacement,

    u = u_R + (R(theta) - 1) r,    du = du_R - [R r]x H(theta) dtheta,

where H dtheta is the spin (Abaqus Theory Guide, Rotation variables; J. Argyris, Computer Methods in Applied Mechanics
and Engineering 32 (1982) 85). Forces f pass on moments R r x f about the global axes, as Abaqus has them in *CLOAD and
RM: no derivatives by theta, so that matrices are not symmetric where rotations about several axes are large. In the
plane theta is dof 6 alone.

Where a displacement of a node is prescribed, its equation eliminates an unknown of the reference node
(`prescribed_followers.py`): with x the six of them, dx = Q dx' + Q_p dp, where x' are the others.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from uel.assembly.dofs import DofMap
from uel.assembly.prescribed_followers import COLUMNS, SMALLEST, PrescribedFollowers, choose_eliminated
from uel.elements import PERMUTATION, rotation_matrices, spin_matrices
from uel.errors import DeckError, SingularMatrixError, Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.dofs import DISPLACEMENTS, ROTATIONS
from uel.model.model import Arm, Equation

IMAGINARY = 1e-30
"""Step of derivatives: the imaginary part of a function of theta + i h has no cancellation."""

ITERATIONS = 30
"""Newton iterations for the eliminated rotations of a reference node; those of displacements alone are exact."""

CLOSED = 1e-14
"""Error of a prescribed displacement, over the lengths that it is computed from, at which those iterations end."""

STRAIGHT = 1e-12
"""Square of the width over that of the length below which nodes lie on a line."""

UNBALANCED = 1e-6
"""Unbalanced moment over the moments that forces on the arms can have: rounding gives less."""

UNREACHABLE = "no position of it gives the prescribed displacements of the nodes that follow it"

_DISPLACEMENTS, _ROTATIONS = np.array(DISPLACEMENTS), np.array(ROTATIONS)
_U, _THETA = slice(0, 3), slice(3, 6)


class KinematicCouplings:
    """All rigid arms of a model.

    own        (k, 3) unknowns: the displacements of each node, -1 where there is none
    of         (k,) row of its reference node
    columns    (references, 6) unknowns of the reference nodes, -1 where there is none
    sources    (references, 6 + w) unknowns that determine those of each reference node: its own, -1 for those that are
               eliminated, then up to w prescribed displacements of nodes that follow
    followers  prescribed displacements of nodes that follow
    """

    def __init__(
        self,
        dofs: DofMap,
        arms: Sequence[Arm],
        prescribed: IntArray,
        start: FloatArray,
        stiff: NDArray[np.bool_],
    ) -> None:
        """Choose the unknowns of the reference nodes to eliminate.

        Parameters
        ----------
        dofs
            Numbers of the unknowns.
        arms
            All of the model.
        prescribed
            Unknowns with a given value.
        start
            (n,) unknowns at which the eliminated ones are chosen.
        stiff
            (n,) mask of the unknowns of elements.
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
        fixed = (self.own >= 0) & np.isin(self.own, prescribed)
        free = (self.columns >= 0) & ~np.isin(self.columns, prescribed)
        self._idle = self._find_idle(free & ~stiff[self.columns])
        free[self._idle] = False
        self._fixed, self._free = fixed, free
        self.followers = self._choose(start)
        self._follows = (self.own >= 0) & ~fixed
        solved = self.followers.solved
        width = max((len(equations) for _, equations in solved), default=0)
        self.sources = np.hstack([self.columns, np.full((len(self.references), width), -1)])
        self.sources[self._idle] = -1
        for row, equations in solved:
            self.sources[row, self.followers.eliminated[equations]] = -1
            self.sources[row, COLUMNS : COLUMNS + len(equations)] = self.followers.unknown[equations]

    def _choose(self, start: FloatArray) -> PrescribedFollowers:
        return choose_eliminated(self.slopes(start), self._length[self.of], self.own, self.of, self._fixed, self._free)

    def eliminates_alike(self, start: FloatArray) -> bool:
        """Return whether the choice of eliminated unknowns would be the same at unknowns (n,)."""
        return np.array_equal(self._choose(start).eliminated, self.followers.eliminated)

    @property
    def eliminated(self) -> IntArray:
        """Eliminated unknowns of reference nodes."""
        own = ~self.followers.redundant
        determined = self.columns[self.followers.reference[own], self.followers.eliminated[own]]
        return np.concatenate([determined, self.columns[self._idle]])

    @property
    def redundant(self) -> list[tuple[int, Source]]:
        """Prescribed displacements that follow from others, and the constraint by which they do."""
        followers, own = self.followers, np.flatnonzero(self.followers.redundant)
        return [(int(followers.unknown[k]), self._arms[followers.arm[k]].source) for k in own]

    @property
    def rotations(self) -> IntArray:
        """Unknowns that are rotations of reference nodes."""
        turns = self.columns[:, _THETA]
        return turns[turns >= 0]

    @property
    def units(self) -> FloatArray:
        """Scales (references, 6) with which rotations of reference nodes compare with displacements of their nodes."""
        found = np.ones(self.columns.shape)
        found[:, _THETA] = 1.0 / np.where(self._length > 0.0, self._length, 1.0)[:, None]
        return found

    @property
    def curved(self) -> IntArray:
        """Unknowns (references, 6) with entries in `curvature`, -1 for others."""
        found = self.sources[:, :COLUMNS].copy()
        steady = np.ones(len(found), dtype=np.bool_)
        steady[[row for row, _ in self.followers.solved]] = False
        found[steady, _U] = -1
        return found

    def _find_idle(self, free: NDArray[np.bool_]) -> tuple[IntArray, IntArray]:
        """Find rows and columns of rotations without effect, where all nodes lie on a line through the reference node.

        The component along the axis nearest to this line keeps its value. free: mask (references, 6) of the unknowns
        that nothing else determines.
        """
        square = np.zeros((len(self.references), 3, 3))
        np.add.at(square, self.of, self._arm[:, :, None] * self._arm[:, None, :])
        sizes, directions = np.linalg.eigh(square)
        along = np.abs(directions[:, :, 2])
        straight = (sizes[:, 1] <= STRAIGHT * sizes[:, 2]) & (free[:, _THETA] | (along <= SMALLEST)).all(axis=1)
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

    def replace_prescribed(self, equations: Sequence[Equation]) -> list[Equation]:
        """Replace the equations of prescribed displacements by ones that eliminate unknowns of reference nodes.

        `coefficients` supplies their coefficients. Equations that fix rotations without effect are added.
        """
        followers = self.followers
        prescribed = {(self._arms[arm].node, axis + 1) for arm, axis in zip(followers.arm, followers.axis, strict=True)}
        kept = [one for one in equations if one.terms[0][:2] not in prescribed]
        for k in np.flatnonzero(~followers.redundant):
            term = int(self.references[followers.reference[k]]), int(followers.eliminated[k]) + 1, 1.0
            kept.append(Equation((term,), self._arms[followers.arm[k]].source))
        for row, column in zip(*self._idle, strict=True):
            source = self._arms[int(np.flatnonzero(self.of == row)[0])].source
            kept.append(Equation(((int(self.references[row]), int(column) + 1, 1.0),), source))
        return kept

    def check(self, dependent: IntArray, equations: Sequence[Equation]) -> None:
        """Refuse couplings whose nodes have other constraints.

        Parameters
        ----------
        dependent
            Unknowns that equations eliminate, other than those of prescribed displacements.
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
        """Mask (k + references, 6 + w) of constant coefficients: those of displacements of reference nodes, where none
        is eliminated.
        """
        steady = np.zeros(self.sources.shape, dtype=np.bool_)
        steady[:, _U] = True
        steady[[row for row, _ in self.followers.solved]] = False
        return np.vstack([steady[self.of], steady])

    def satisfy(self, start: FloatArray, increment: FloatArray) -> FloatArray:
        """Return an increment (n,) with the dependent unknowns that follow from the others. Raises SingularMatrixError.

        Eliminated unknowns of reference nodes come first, then the nodes on arms.
        """
        u, satisfied = start + increment, increment.copy()
        for row, equations in self.followers.solved:
            own = self.columns[row, self.followers.eliminated[equations]]
            self._solve_eliminated(u, row, equations, own)
            satisfied[own] = u[own] - start[own]
        following = self._following(u)
        satisfied[self.own[self._follows]] = following[self._follows] - start[self.own[self._follows]]
        return satisfied

    def levers(self, u: FloatArray) -> FloatArray:
        """Return forces and global moments (k, 3, 6) on reference nodes per unit force on each node."""
        turned = np.einsum("kij,kj->ki", rotation_matrices(self._angles(u))[self.of], self._arm)
        return _with_translations(np.einsum("iab,ka->kbi", PERMUTATION, turned))

    def slopes(self, u: FloatArray) -> FloatArray:
        """Return derivatives (k, 3, 6) of the displacements of each node by the unknowns of its reference node."""
        levers = self.levers(u)
        return _with_translations(levers[:, :, _THETA] @ spin_matrices(self._angles(u))[self.of])

    def coefficients(self, by_reference: FloatArray) -> FloatArray:
        """Return coefficients (k + references, 6, 6 + w) of `rows` on `row_sources`, from `slopes` or `levers`."""
        reduction = self._reduction(by_reference)
        found = np.zeros((len(self.own) + len(self.references), COLUMNS, self.sources.shape[1]))
        found[: len(self.own), _U] = by_reference @ reduction[self.of]
        found[len(self.own) :] = reduction
        return found

    def curvature(self, u: FloatArray, residual: FloatArray, slopes: FloatArray) -> FloatArray:
        """Return the stiffness (references, 6, 6) of reference nodes due to forces (n,) on rotating arms.

        It includes the reactions of prescribed displacements of nodes that follow. The arms are those at unknowns u
        (n,), the rotations those of `slopes`.
        """
        levers = self.levers(u)
        force = np.where(self._follows, _gathered(residual, self.own), 0.0)
        total = _gathered(residual, self.columns)
        np.add.at(total, self.of, np.einsum("kac,ka->kc", levers, force))
        for row, equations in self.followers.solved:
            arm, axis = self.followers.arm[equations], self.followers.axis[equations]
            own = self.followers.eliminated[equations]
            force[arm, axis] = -np.linalg.solve(levers[arm, axis][:, own].T, total[row, own])
        left, right = (self._reduction(one)[:, _THETA, :COLUMNS] for one in (levers, slopes))
        return np.asarray(left.transpose(0, 2, 1) @ self._moment_stiffness(u, force) @ right, dtype=np.float64)

    def redundancy_errors(self, u: FloatArray) -> FloatArray:
        """Return the relative errors of the redundant prescribed displacements at unknowns u (n,)."""
        followers, own = self.followers, self.followers.redundant
        following, prescribed = self._following(u)[followers.arm, followers.axis][own], u[followers.unknown[own]]
        size = self._length[followers.reference[own]] + np.abs(following) + np.abs(prescribed)
        return np.asarray(np.abs(prescribed - following) / size, dtype=np.float64)

    def _following(self, u: FloatArray) -> FloatArray:
        """Return the displacements (k, 3) of the nodes from those of their reference nodes."""
        turned = np.einsum("kij,kj->ki", rotation_matrices(self._angles(u))[self.of], self._arm)
        return np.asarray(_gathered(u, self.columns[:, _U])[self.of] + turned - self._arm, dtype=np.float64)

    def _solve_eliminated(self, u: FloatArray, row: int, equations: IntArray, own: IntArray) -> None:
        """Solve for the eliminated unknowns of a reference node, in place in u (n,). Raises SingularMatrixError."""
        arm, axis = self.followers.arm[equations], self.followers.axis[equations]
        columns = self.followers.eliminated[equations]
        for _ in range(ITERATIONS):
            gap = u[self.followers.unknown[equations]] - self._following(u)[arm, axis]
            size = self._length[row] + np.abs(u[own]).max() + np.abs(u[self.followers.unknown[equations]]).max()
            if np.abs(gap).max() <= CLOSED * size:
                return
            try:
                u[own] += np.linalg.solve(self.slopes(u)[arm, axis][:, columns], gap)
            except np.linalg.LinAlgError:
                break
        raise SingularMatrixError(*self._dofs.name(int(own[0])), UNREACHABLE)

    def _reduction(self, by_reference: FloatArray) -> FloatArray:
        """Return Q and Q_p (references, 6, 6 + w)."""
        found = np.zeros((len(self.references), COLUMNS, self.sources.shape[1]))
        found[:, range(COLUMNS), range(COLUMNS)] = 1.0
        for row, equations in self.followers.solved:
            own = self.followers.eliminated[equations]
            rows = by_reference[self.followers.arm[equations], self.followers.axis[equations]]
            inverse = np.linalg.inv(rows[:, own])
            found[row, own, :COLUMNS] = -inverse @ rows
            found[row, own[:, None], own] = 0.0
            found[row, own, COLUMNS : COLUMNS + len(own)] = inverse
        return found

    def _moment_stiffness(self, u: FloatArray, force: FloatArray) -> FloatArray:
        """Return -dM/dtheta (references, 3, 3), M the moments of forces (k, 3) on the nodes."""
        moments = np.zeros((len(self.references), 3, 3))
        np.add.at(moments, self.of, force[:, :, None] * self._arm[:, None, :])
        angles = self._angles(u)
        found = np.empty_like(moments)
        for k in range(3):
            step = np.zeros(3, dtype=np.complex128)
            step[k] = 1j * IMAGINARY
            # sum of f x^T with the rotated arms x; the axial vector of its skew part is the moment
            now = moments @ rotation_matrices(angles + step).transpose(0, 2, 1)
            found[:, :, k] = -np.einsum("iab,mba->mi", PERMUTATION, now).imag / IMAGINARY
        return found

    def _angles(self, u: FloatArray) -> FloatArray:
        return _gathered(u, self.columns[:, _THETA])


def _with_translations(turning: FloatArray) -> FloatArray:
    """Prepend the unit derivatives by displacements to those by rotations (k, 3, 3): (k, 3, 6)."""
    moving = np.broadcast_to(np.eye(3), turning.shape)
    return np.concatenate([moving, turning], axis=2)


def _gathered(values: FloatArray, unknowns: IntArray) -> FloatArray:
    """Return the values of unknowns, zero for unknown -1."""
    return np.asarray(np.append(values, 0.0)[unknowns], dtype=np.float64)
