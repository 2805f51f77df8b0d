# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rigid-body motions of an element."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations
from typing import Final

import numpy as np

from uel.check.element_calls import ElementState
from uel.check.finding import Finding, not_applicable
from uel.check.subject import Subject, diagonal
from uel.model.arrays import FloatArray

PLANES: Final = {2: ((0, 1),), 3: ((1, 2), (2, 0), (0, 1))}
"""Axes that a rotation turns into each other, by axis of rotation, for two and three dimensions."""

ROTATIONS: Final = (4, 5, 6)
"""Dofs of rotations."""

ALIKE: Final = 1e-6
"""Limit relative to the forces that the displacements would cause one by one: smaller forces cancel."""


@dataclass(frozen=True, slots=True)
class Body:
    """Element whose nodes have displacements.

    points        (nodes, dimensions) coordinates
    displacement  (n,) True where an unknown is a displacement
    local, axis   (n,) local node of each unknown, and its direction from 0 (of displacements)
    turning       (rotations, n) values of the other unknowns in unit rotations: 1 for rotations
    """

    points: FloatArray
    displacement: np.ndarray
    local: np.ndarray
    axis: np.ndarray
    turning: FloatArray

    @property
    def dimensions(self) -> int:
        """Number of displacement directions."""
        return int(self.points.shape[1])

    @property
    def size(self) -> float:
        """Diagonal of the element; 1 if all nodes coincide."""
        return diagonal(self.points)

    @property
    def coincident(self) -> bool:
        """True if nodes with displacements coincide, as in interface elements."""
        points = np.unique(self.points[np.unique(self.local[self.displacement])].round(12), axis=0)
        return len(points) < len(set(self.local[self.displacement].tolist()))

    def translation(self, direction: int) -> FloatArray:
        """Return the unit displacement (n,) in a direction."""
        return np.where(self.displacement & (self.axis == direction), 1.0, 0.0)

    def small_rotations(self) -> list[FloatArray]:
        """Return displacements (n,) of unit rotations about the nodes' centre, without second-order terms."""
        arms = self.points - self.points.mean(axis=0)
        motions = []
        for number, (i, j) in enumerate(PLANES.get(self.dimensions, ())):
            motion = self.turning[number].copy()
            here_i, here_j = (self.displacement & (self.axis == k) for k in (i, j))
            motion[here_i] = -arms[self.local[here_i], j]
            motion[here_j] = arms[self.local[here_j], i]
            motions.append(motion)
        return motions

    def rotations(self, angle: float) -> list[tuple[FloatArray, FloatArray]]:
        """Return displacements (n,) of finite rotations, each with the matrix (n, n) that turns the forces."""
        arms = self.points - self.points.mean(axis=0)
        motions = []
        for number, (i, j) in enumerate(PLANES.get(self.dimensions, ())):
            turn = plane_rotation(self.dimensions, i, j, angle)
            moved = arms @ turn.T - arms
            motion = angle * self.turning[number]
            motion[self.displacement] = moved[self.local[self.displacement], self.axis[self.displacement]]
            same_node = self.local[:, None] == self.local[None, :]
            both = self.displacement[:, None] & self.displacement[None, :] & same_node
            axes = np.where(self.displacement, self.axis, 0)
            forces = np.where(both, turn[axes[:, None], axes[None, :]], 0.0)
            forces[~self.displacement, ~self.displacement] = 1.0
            motions.append((motion, forces))
        return motions


def plane_rotation(dimensions: int, i: int, j: int, angle: float) -> FloatArray:
    """Return the rotation (dimensions, dimensions) of axis i towards axis j (rad)."""
    rotation = np.eye(dimensions)
    rotation[[i, i, j, j], [i, j, i, j]] = np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle)
    return rotation


def uniform_strains(body: Body) -> FloatArray:
    """Return displacements (strains, n) of unit strains: normal, then engineering shear ones, without rotation."""
    fields = []
    for i, j in [(i, i) for i in range(body.dimensions)] + list(combinations(range(body.dimensions), 2)):
        field = np.zeros(len(body.axis))
        # half of each: without rotation
        for row, column in ((i, j), (j, i)):
            moved = body.displacement & (body.axis == row)
            field[moved] += 0.5 * body.points[body.local[moved], column]
        fields.append(field)
    return np.array(fields)


def body_of(subject: Subject, state: ElementState) -> Body | None:
    """Return the element of a state as a body; None if fewer than two nodes move in all COORDINATES= directions."""
    points = subject.coordinates(state)
    dofs, local = subject.dofs, subject.local_nodes
    dimensions = points.shape[1]
    displacement = dofs <= dimensions
    counts = [len(np.unique(local[dofs == direction + 1])) for direction in range(dimensions)]
    if not 1 <= dimensions <= 3 or min(counts, default=0) < 2 or len(set(counts)) > 1:
        return None
    # the only rotation in two dimensions is that about the third axis
    rotations = ROTATIONS if dimensions == 3 else ROTATIONS[2:]
    turning = np.array([np.where(dofs == dof, 1.0, 0.0) for dof in rotations[: len(PLANES.get(dimensions, ()))]])
    body = Body(points, displacement, local, np.where(displacement, dofs - 1, -1), turning)
    return body if dimensions != 2 else _with_own_rotations(subject, body)


def _with_own_rotations(subject: Subject, body: Body) -> Body:
    """Add the nodes' own rotations to a plane body, by a dof of the author's choice (as in Cosserat continua).

    That dof is one whose uniform value cancels the forces that a rotation of the displacements makes at rest.
    """
    rest = next(iter(subject.resting), None)
    others = np.unique(subject.dofs[~body.displacement & ~body.turning.any(axis=0)])
    if rest is None or not len(others):
        return body
    stiffness, (motion,) = subject.differences(rest).matrix, body.small_rotations()
    limit = ALIKE * float((np.abs(stiffness) @ np.abs(motion)).max())
    forces = stiffness @ motion
    for dof in others if np.abs(forces).max() > limit else ():
        uniform = np.where(subject.dofs == dof, 1.0, 0.0)
        answer = stiffness @ uniform
        share = -float(forces @ answer) / max(float(answer @ answer), 1e-300)
        if np.abs(forces + share * answer).max() <= limit:
            return replace(body, turning=body.turning + share * uniform)
    return body


def makes_inertia(state: ElementState, body: Body) -> bool:
    """Return whether a translation in a dynamic increment causes forces with V = A = 0: inertia from DU."""
    if not state.dynamic:
        return False
    here = state.quiet().evaluate(matrix=False).rhs[0]
    for direction in range(body.dimensions):
        motion = body.size * body.translation(direction)
        moved, carried = (moved.evaluate(matrix=False).rhs[0] for moved in _elsewhere(state.quiet(), motion))
        size = max(float(np.abs(here).max()), float(np.abs(moved).max()))
        if np.abs(moved - here).max() > ALIKE * size >= np.abs(carried - here).max():
            return True
    return False


def _elsewhere(state: ElementState, motion: FloatArray) -> tuple[ElementState, ElementState]:
    """Return the states of an element translated within the increment, and from the start."""
    return state.moved(motion), state.carried(motion)


NO_BODY: Final = "it is for elements with two or more nodes that have displacements in all directions of COORDINATES="

AT_REST: Final = "the run has no state without displacements: start the deck with an increment without loads"

INERTIA: Final = "the element computes inertia from DU, not from A: take a deck with a static step"


def body_at_rest(subject: Subject) -> tuple[ElementState, Body] | Finding:
    """Return the first state without displacements and its body, or a finding if there is none, or inertia from DU."""
    state = next(iter(subject.resting), None)
    if state is None:
        return not_applicable(AT_REST)
    body = body_of(subject, state)
    if body is None:
        return not_applicable(NO_BODY)
    return not_applicable(INERTIA) if makes_inertia(state, body) else (state, body)
