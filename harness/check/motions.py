# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rigid-body motions of an element."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from harness.check.state import State
from harness.check.subject import Subject, diagonal
from harness.model.arrays import FloatArray

PLANES: Final = {2: ((0, 1),), 3: ((1, 2), (2, 0), (0, 1))}
"""Axes that a rotation turns into each other, per axis of rotation, for two and three dimensions."""

ROTATIONS: Final = (4, 5, 6)
"""Dofs of rotations."""


@dataclass(frozen=True, slots=True)
class Body:
    """An element whose nodes have displacements.

    points        (nodes, dimensions) coordinates
    displacement  (n,) True where an unknown is a displacement
    local, axis   (n,) local node of each unknown, and its direction from 0 (of displacements)
    dofs          (n,) as Abaqus numbers them
    """

    points: FloatArray
    displacement: np.ndarray
    local: np.ndarray
    axis: np.ndarray
    dofs: np.ndarray

    @property
    def dimensions(self) -> int:
        """Directions in which the nodes move."""
        return int(self.points.shape[1])

    @property
    def size(self) -> float:
        """Diagonal of the element; 1 where all nodes are in one place."""
        return diagonal(self.points)

    @property
    def coincident(self) -> bool:
        """Nodes with displacements lie on each other, as those of interface elements do."""
        points = np.unique(self.points[np.unique(self.local[self.displacement])].round(12), axis=0)
        return len(points) < len(set(self.local[self.displacement].tolist()))

    def translation(self, direction: int) -> FloatArray:
        """(n,) unit displacement in a direction."""
        return np.where(self.displacement & (self.axis == direction), 1.0, 0.0)

    def small_rotations(self) -> list[FloatArray]:
        """(n,) displacements of unit rotations about the middle of the nodes, without the terms of second order."""
        arms = self.points - self.points.mean(axis=0)
        found = []
        for number, (i, j) in enumerate(PLANES.get(self.dimensions, ())):
            motion = np.zeros(len(self.axis))
            here_i, here_j = (self.displacement & (self.axis == k) for k in (i, j))
            motion[here_i] = -arms[self.local[here_i], j]
            motion[here_j] = arms[self.local[here_j], i]
            motion[self.dofs == self._rotation_dof(number)] = 1.0
            found.append(motion)
        return found

    def rotations(self, angle: float) -> list[tuple[FloatArray, FloatArray]]:
        """Of finite rotations: displacements (n,), and the matrix (n, n) that turns the forces."""
        arms = self.points - self.points.mean(axis=0)
        found = []
        for number, (i, j) in enumerate(PLANES.get(self.dimensions, ())):
            turn = np.eye(self.dimensions)
            turn[[i, i, j, j], [i, j, i, j]] = np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle)
            moved = arms @ turn.T - arms
            motion = np.zeros(len(self.axis))
            motion[self.displacement] = moved[self.local[self.displacement], self.axis[self.displacement]]
            motion[self.dofs == self._rotation_dof(number)] = angle
            same_node = self.local[:, None] == self.local[None, :]
            both = self.displacement[:, None] & self.displacement[None, :] & same_node
            axes = np.where(self.displacement, self.axis, 0)
            forces = np.where(both, turn[axes[:, None], axes[None, :]], 0.0)
            forces[~self.displacement, ~self.displacement] = 1.0
            found.append((motion, forces))
        return found

    def _rotation_dof(self, number: int) -> int:
        """Dof of the rotation in a plane of PLANES; the only one in two dimensions is that about the third axis."""
        return ROTATIONS[number if self.dimensions == 3 else 2]


def body_of(subject: Subject, state: State) -> Body | None:
    """The element of a state as a body; None where fewer than two nodes move in all COORDINATES= directions."""
    points = subject.coordinates(state)
    dofs, local = subject.dofs, subject.local_nodes
    dimensions = points.shape[1]
    displacement = dofs <= dimensions
    counts = [len(np.unique(local[dofs == direction + 1])) for direction in range(dimensions)]
    if not 1 <= dimensions <= 3 or min(counts, default=0) < 2 or len(set(counts)) > 1:
        return None
    return Body(points, displacement, local, np.where(displacement, dofs - 1, -1), dofs)


NO_BODY: Final = "fewer than two nodes with displacements in all directions of COORDINATES="

AT_REST: Final = "the run has no state without displacements"
