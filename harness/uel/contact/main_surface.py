# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Interface of the main surfaces of finite sliding: where they are, how they move with the unknowns, and which point is
nearest.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray, IntArray

EQUAL: Final = 1e-9
"""Difference of distances, over the size of a piece, that counts as none, and of natural coordinates."""


@dataclass(frozen=True, slots=True)
class Place:
    """Points of a main surface.

    at       (m, d)
    tangents (m, a, d) by the natural coordinates
    second   (m, a, a, d) their derivatives
    """

    at: FloatArray
    tangents: FloatArray
    second: FloatArray

    @property
    def metric(self) -> FloatArray:
        """Products (m, a, a) of the tangents, with an inverse also where an extended face has no area."""
        found = np.einsum("mad,mbd->mab", self.tangents, self.tangents)
        size = np.trace(found, axis1=1, axis2=2)[:, None, None]
        return np.asarray(found + EQUAL**2 * size * np.eye(found.shape[1]))

    def take(self, points: IntArray) -> Place:
        """Return some of the points."""
        return Place(self.at[points], self.tangents[points], self.second[points])

    @property
    def normal(self) -> FloatArray:
        """Outward normals (m, d) of length one."""
        first = self.tangents[:, 0]
        if self.at.shape[1] == 2:
            found = np.stack([first[:, 1], -first[:, 0]], axis=1)
        elif self.tangents.shape[1] == 1:
            # a line in space has none
            found = np.zeros_like(first)
        else:
            found = np.cross(first, self.tangents[:, 1])
        length = np.linalg.norm(found, axis=1)[:, None]
        return np.asarray(found / np.where(length > 0.0, length, 1.0))


class Surface(Protocol):
    """A main surface; moved: values (nodes, dofs) of these dofs of all nodes of the model.

    dofs      displacements, then rotations
    unknowns  (local node, dof) of those of its nodes, which follow the secondary node
    """

    dofs: tuple[int, ...]
    unknowns: tuple[tuple[int, int], ...]

    def nodes_of(self, piece: IntArray) -> IntArray:
        """Return (m, k) nodes of pieces (m,)."""

    def ring_of(self, piece: IntArray) -> IntArray:
        """Return (m, r) neighbours of pieces (m,), and themselves."""

    def sizes(self, piece: IntArray, moved: FloatArray) -> FloatArray:
        """Return (m,) about half of the lengths of pieces (m,)."""

    def at(self, piece: IntArray, natural: FloatArray, moved: FloatArray) -> Place:
        """Return the points (m,) of pieces at their natural coordinates (m, a)."""

    def by_unknowns(self, piece: IntArray, natural: FloatArray, moved: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the derivatives of points (m, d, u) and tangents (m, a, d, u) by the unknowns."""

    def loaded(
        self, piece: IntArray, natural: FloatArray, moved: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray | None]:
        """Return motions (m, d, u) along which forces on points do work, their derivatives (m, a, d, u) along the
        surface and (m, d, u, u) by the unknowns; None: zero.
        """

    def track(
        self, points: FloatArray, looks: FloatArray, moved: FloatArray, before: IntArray, *, everywhere: bool
    ) -> tuple[IntArray, FloatArray, NDArray[np.bool_]]:
        """Find the pieces nearest to points (m, d), the natural coordinates (m, a) there,
        and whether points are above them.

        Parameters
        ----------
        points
            (m, d) places of the secondary nodes.
        looks
            (m, d) normals of their own surface: pieces that do not look the other way are left out; zero: none.
        moved
            (nodes, dofs).
        before
            (m,) pieces so far; where others are as near, these stay.
        everywhere
            Search the whole surface, else from these pieces to their neighbours.
        """
