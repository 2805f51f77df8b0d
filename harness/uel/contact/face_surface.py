# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Main surfaces of element faces: the search for the nearest piece, and motions by the unknowns.

fortran/host/contact has the search and the closest point projection onto a piece.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.contact.main_surface import EQUAL, SurfacePoints
from uel.contact.shape_functions import weights_of
from uel.model.arrays import FloatArray, IntArray
from uel.model.contact import Pieces
from uel.usersub import _contact
from uel.usersub._contact import Hits

NEAREST: Final = 4
"""Nearest main nodes whose pieces are tried in a global search."""

WALK: Final = 50
"""Largest number of pieces that a node passes in one iteration."""


class FaceSurface:
    """A main surface of faces of elements."""

    def __init__(self, pieces: Pieces, coordinates: FloatArray, facing: float = EQUAL) -> None:
        """Prepare the surface; coordinates: (nodes, d) of all nodes; facing: as in `ProjectedPoints`."""
        dimension = coordinates.shape[1]
        self.pieces, self._coordinates, self._dimension, self._facing = pieces, coordinates, dimension, facing
        self.dofs = tuple(range(1, dimension + 1))
        self.unknowns = tuple((node, dof) for node in range(1, 1 + pieces.nodes.shape[1]) for dof in self.dofs)
        self._nodes = np.unique(pieces.nodes)
        order = np.argsort(pieces.nodes.ravel(), kind="stable")
        counts = np.bincount(np.searchsorted(self._nodes, pieces.nodes.ravel()))
        rank = np.arange(len(order)) - np.repeat(np.cumsum(counts) - counts, counts)
        # pieces of each node
        first = order[np.cumsum(counts) - counts] // pieces.nodes.shape[1]
        self._of_node = np.repeat(first[:, None], counts.max(), axis=1)
        self._of_node[np.repeat(np.arange(len(counts)), counts), rank] = order // pieces.nodes.shape[1]

    def nodes_of(self, piece: IntArray) -> IntArray:
        """Return the nodes of pieces, see `Surface.nodes_of`."""
        return np.asarray(self.pieces.nodes[piece])

    def ring_of(self, piece: IntArray) -> IntArray:
        """Return the neighbours of pieces, see `Surface.ring_of`."""
        return np.asarray(self.pieces.ring[piece])

    def at(self, piece: IntArray, natural: FloatArray, u: FloatArray) -> SurfacePoints:
        """Return points of pieces, see `Surface.at`."""
        return SurfacePoints(*_contact.feet(self.pieces, self._coordinates + u, piece, natural))

    def sizes(self, piece: IntArray, u: FloatArray) -> FloatArray:
        """Return the sizes of pieces, see `Surface.sizes`: largest distances of nodes from their middle."""
        return _contact.sizes(self.pieces.nodes[piece], self._coordinates + u)

    def by_unknowns(self, piece: IntArray, natural: FloatArray, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the derivatives of points and tangents, see `Surface.by_unknowns`."""
        del u
        return self._spread(self.pieces.shapes[piece], natural)

    def loaded(
        self, piece: IntArray, natural: FloatArray, u: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray | None]:
        """Return the motions conjugate to forces and their derivatives, see `Surface.loaded`."""
        del u
        return *self._spread(self.pieces.loads[piece], natural), None

    def _spread(self, shapes: FloatArray, natural: FloatArray) -> tuple[FloatArray, FloatArray]:
        m, dimension, eye = len(natural), self._dimension, np.eye(self._dimension)
        values, first = weights_of(shapes, natural)
        unknowns = shapes.shape[1] * dimension
        at = np.einsum("mk,de->mdke", values, eye).reshape(m, dimension, unknowns)
        return at, np.einsum("mka,de->madke", first, eye).reshape(m, first.shape[2], dimension, unknowns)

    def track(
        self, points: FloatArray, outward: FloatArray, u: FloatArray, before: IntArray, *, everywhere: bool
    ) -> tuple[IntArray, FloatArray, NDArray[np.bool_]]:
        """Find the nearest pieces, see `Surface.track`."""
        near = self.near(points, u) if everywhere else np.zeros((len(points), 0), dtype=np.int64)
        hits = self.search(points, outward, u, before, near)
        return hits.piece, hits.natural, hits.above

    def near(self, points: FloatArray, u: FloatArray) -> IntArray:
        """Return (m, c) pieces of the nodes nearest to points (m, d), among which the search starts."""
        from scipy.spatial import KDTree  # noqa: PLC0415 (takes 0.1 s, and few decks have contact)

        positions = self._coordinates[self._nodes] + u[self._nodes]
        _, nodes = KDTree(positions).query(points, k=min(NEAREST, len(positions)))
        near = self._of_node[nodes.reshape(len(points), nodes.size // max(len(points), 1))]
        return np.asarray(near.reshape(len(points), near.shape[1] * near.shape[2]))

    def search(self, points: FloatArray, outward: FloatArray, u: FloatArray, before: IntArray, near: IntArray) -> Hits:
        """Find the nearest pieces as `track` does, at first among those of `near` (m, c), if there are any."""
        positions = self._coordinates + u
        return _contact.search(self.pieces, positions, self._facing, (points, outward), before, near, WALK)

    def distances(self, points: FloatArray, u: FloatArray, near: IntArray) -> FloatArray:
        """Return the distances (m,) of points (m, d) from the nearest piece, whatever its normal; near: as `near`
        returns it.
        """
        return self.search(points, np.zeros_like(points), u, np.zeros(len(points), dtype=np.int64), near).distance

    def locate(self, piece: IntArray, points: FloatArray) -> FloatArray:
        """Return natural coordinates (m, a) of points (m, d) on pieces (m,), extended, before any displacement."""
        outward = np.zeros_like(points)
        hits = _contact.search(
            self.pieces, self._coordinates, self._facing, (points, outward), piece, piece[:, None], 0
        )
        return hits.natural

    def nearest(self, points: FloatArray) -> tuple[IntArray, FloatArray]:
        """Return the nodes (m, k) of the pieces nearest to points (m, d), undeformed, and their shape functions
        there.
        """
        zero = np.zeros_like(self._coordinates)
        before = np.zeros(len(points), dtype=np.int64)
        hits = self.search(points, np.zeros_like(points), zero, before, self.near(points, zero))
        factors = weights_of(self.pieces.shapes[hits.piece], hits.within)[0]
        factors = np.where(np.abs(factors) <= EQUAL, 0.0, factors)
        return self.nodes_of(hits.piece), factors / factors.sum(axis=1, keepdims=True)
