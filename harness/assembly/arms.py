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
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from harness.assembly.dofs import DofMap
from harness.elements import PERMUTATION, rotation_matrices, spin_matrices
from harness.errors import DeckError
from harness.model.arrays import FloatArray, IntArray
from harness.model.model import Arm, Equation

IMAGINARY = 1e-30
"""Step of derivatives: the imaginary part of a function of theta + i h has no cancellation."""

_DISPLACEMENTS, _ROTATIONS = np.array([1, 2, 3]), np.array([4, 5, 6])


class Arms:
    """All arms of a model.

    own, turns  unknowns: the displacements of each node (k, 3), and the rotations of its reference node (k, 3); -1
                where there is none
    """

    def __init__(self, dofs: DofMap, arms: Sequence[Arm], dependent: IntArray, equations: Sequence[Equation]) -> None:
        """Raises DeckError if a node of an arm has other constraints; dependent: unknowns that equations eliminate."""
        nodes, references = (
            np.array([getattr(arm, name) for arm in arms], dtype=np.int64) for name in ("node", "reference")
        )
        self._references, self._of = np.unique(references, return_inverse=True)
        points = dofs.mesh.coordinates
        self._arm = points[nodes] - points[references]
        self.own = dofs.find(nodes[:, None], _DISPLACEMENTS)
        self._moves = dofs.find(references[:, None], _DISPLACEMENTS)
        self.rotations = dofs.find(self._references[:, None], _ROTATIONS)
        self.turns = self.rotations[self._of]
        _check(dofs, arms, self.own, np.hstack([self._moves, self.turns]), dependent, equations)

    def place(self, start: FloatArray, increment: FloatArray) -> FloatArray:
        """An increment (n,) with those of all nodes that follow."""
        u, chosen, placed = start + increment, self.own >= 0, increment.copy()
        turned = np.einsum("kij,kj->ki", rotation_matrices(self._angles(u))[self._of], self._arm)
        following = _gathered(u, self._moves) + turned - self._arm
        placed[self.own[chosen]] = following[chosen] - start[self.own[chosen]]
        return placed

    def levers(self, u: FloatArray) -> FloatArray:
        """Moments (k, 3, 3) about the global axes by the forces on each node: force, then axis."""
        turned = np.einsum("kij,kj->ki", rotation_matrices(self._angles(u))[self._of], self._arm)
        found: FloatArray = np.einsum("iab,ka->kbi", PERMUTATION, turned)
        return found

    def slopes(self, u: FloatArray) -> FloatArray:
        """Derivatives (k, 3, 3) of the displacements of each node by the rotations of its reference node."""
        return np.asarray(self.levers(u) @ spin_matrices(self._angles(u))[self._of], dtype=np.float64)

    def curvature(self, u: FloatArray, force: FloatArray) -> FloatArray:
        """What forces (n,) on the nodes add to the stiffness (references, 3, 3) of the rotations, as arms turn."""
        moments = np.zeros((len(self._references), 3, 3))
        np.add.at(moments, self._of, _gathered(force, self.own)[:, :, None] * self._arm[:, None, :])
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
        return _gathered(u, self.rotations)


def _gathered(values: FloatArray, unknowns: IntArray) -> FloatArray:
    """Values of unknowns, zero where there is none."""
    return np.asarray(np.append(values, 0.0)[unknowns], dtype=np.float64)


def _check(
    dofs: DofMap,
    arms: Sequence[Arm],
    own: IntArray,
    others: IntArray,
    dependent: IntArray,
    equations: Sequence[Equation],
) -> None:
    """Raise DeckError where an arm is not the only constraint of its node, or its reference node has constraints."""
    for arm, unknowns in zip(arms, own, strict=True):
        if not np.isin(unknowns[unknowns >= 0], dependent).all():
            name = dofs.mesh.name(arm.node)
            message = f"node {name} follows a reference node with NLGEOM: none of its displacements can be prescribed"
            raise DeckError(arm.source, message)
    for arm, held in zip(arms, others, strict=True):
        if np.isin(held[held >= 0], dependent).any():
            message = f"reference node {dofs.mesh.name(arm.reference)} has other constraints"
            raise DeckError(arm.source, f"{message}, which is not supported with NLGEOM")
    following = {arm.node for arm in arms}
    for equation in equations:
        for node, dof, _ in equation.terms[1:]:
            if node in following and dof <= _DISPLACEMENTS[-1]:
                message = f"node {dofs.mesh.name(node)} follows a reference node, which is not supported with NLGEOM"
                raise DeckError(equation.source, f"{message} beside another constraint")
