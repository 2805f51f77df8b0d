# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Main surfaces of element faces: the search for the nearest piece, and motions by the unknowns.

`projection` has the closest point projection onto a piece.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.contact.main_surface import EQUAL, SurfacePoints
from uel.contact.projection import CurrentPieces, evaluate, inside, polynomials_of, project, sizes_of
from uel.contact.shape_functions import weights_of
from uel.model.arrays import FloatArray, IntArray
from uel.model.contact import Pieces

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
        self._along = pieces.low.shape[1]
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
        nodes = self.pieces.nodes[piece]
        return evaluate(polynomials_of(self.pieces.shapes[piece], self._coordinates[nodes] + u[nodes]), natural)

    def sizes(self, piece: IntArray, u: FloatArray) -> FloatArray:
        """Return the sizes of pieces, see `Surface.sizes`: largest distances of nodes from their middle."""
        nodes = self.pieces.nodes[piece]
        return sizes_of(self._coordinates[nodes] + u[nodes])

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
        values, first, _ = weights_of(shapes, natural)
        unknowns = shapes.shape[1] * dimension
        at = np.einsum("mk,de->mdke", values, eye).reshape(m, dimension, unknowns)
        return at, np.einsum("mka,de->madke", first, eye).reshape(m, first.shape[2], dimension, unknowns)

    def track(
        self, points: FloatArray, outward: FloatArray, u: FloatArray, before: IntArray, *, everywhere: bool
    ) -> tuple[IntArray, FloatArray, NDArray[np.bool_]]:
        """Find the nearest pieces, see `Surface.track`."""
        current, nearest_piece = CurrentPieces.of(self.pieces, self._coordinates + u), before.copy()
        if everywhere:
            positions = self._coordinates[self._nodes] + u[self._nodes]
            from scipy.spatial import KDTree  # noqa: PLC0415 (takes 0.1 s, and few decks have contact)

            _, near = KDTree(positions).query(points, k=min(NEAREST, len(positions)))
            count = near.size // max(len(points), 1)
            near = self._of_node[near.reshape(len(points), count)]
            near = near.reshape(len(points), count * near.shape[2])
            nearest_piece = self._nearest(current, points, outward, np.concatenate([before[:, None], near], axis=1))[0]
        natural, above = np.zeros((len(points), self._along)), np.zeros(len(points), dtype=np.bool_)
        rows = np.arange(len(points))
        for _ in range(WALK):
            last = nearest_piece[rows]
            candidates = np.concatenate([last[:, None], self.pieces.ring[last]], axis=1)
            nearest = self._nearest(current, points[rows], outward[rows], candidates)
            nearest_piece[rows], natural[rows], above[rows] = nearest
            rows = rows[nearest[0] != last]
            if not len(rows):
                break
        return nearest_piece, natural, above

    def distances(self, points: FloatArray, u: FloatArray) -> FloatArray:
        """Return the distances (m,) of points (m, d) from the nearest piece, whatever its normal."""
        before, outward = np.zeros(len(points), dtype=np.int64), np.zeros_like(points)
        piece, natural, _ = self.track(points, outward, u, before, everywhere=True)
        return np.asarray(np.linalg.norm(points - self.at(piece, inside(self.pieces, piece, natural), u).at, axis=1))

    def locate(self, piece: IntArray, points: FloatArray) -> FloatArray:
        """Return natural coordinates (m, a) of points (m, d) on pieces (m,), extended, before any displacement."""
        return project(self.pieces, CurrentPieces.of(self.pieces, self._coordinates), piece, points)

    def nearest(self, points: FloatArray) -> tuple[IntArray, FloatArray]:
        """Return the nodes (m, k) of the pieces nearest to points (m, d), undeformed, and their shape functions
        there.
        """
        zero = np.zeros_like(self._coordinates)
        before = np.zeros(len(points), dtype=np.int64)
        piece, natural, _ = self.track(points, np.zeros_like(points), zero, before, everywhere=True)
        factors = weights_of(self.pieces.shapes[piece], inside(self.pieces, piece, natural))[0]
        factors = np.where(np.abs(factors) <= EQUAL, 0.0, factors)
        return self.nodes_of(piece), factors / factors.sum(axis=1, keepdims=True)

    def _nearest(
        self, current: CurrentPieces, points: FloatArray, outward: FloatArray, candidates: IntArray
    ) -> tuple[IntArray, FloatArray, NDArray[np.bool_]]:
        """Find the nearest piece of candidates (m, c), as in `track`; the first of equally near ones.

        The piece with the nearest box is tried first, others only if their boxes are not farther than this piece.
        """
        pieces, rows = self.pieces, np.arange(len(candidates))
        least = current.least(points, outward, candidates, self._facing)
        first = least.argmin(axis=1)
        distance, natural = np.full(least.shape, np.inf), np.zeros((*least.shape, self._along))
        closest, natural[rows, first] = self._reach(current, points, outward, candidates[rows, first])
        distance[rows, first] = closest
        margin = EQUAL * current.sizes[candidates]
        # twice the margin, for rounding
        near = np.isfinite(least) & (least <= closest[:, None] + 2.0 * margin)
        # no candidate faces the point: the first one
        near[:, 0] |= np.isinf(closest)
        row, column = np.nonzero(near & (candidates != candidates[rows, first][:, None]))
        # candidates may be repeated
        total = len(pieces.nodes)
        pairs, pair_of = np.unique(row * total + candidates[row, column], return_inverse=True)
        others, other = pairs // total, pairs % total
        distances, naturals = self._reach(current, points[others], outward[others], other)
        distance[row, column], natural[row, column] = distances[pair_of], naturals[pair_of]
        chosen = np.argmax(distance <= distance.min(axis=1, keepdims=True) + margin, axis=1)
        piece, xi = candidates[rows, chosen], natural[rows, chosen]
        above = (xi >= pieces.reach_low[piece] - EQUAL).all(axis=1)
        above &= (xi <= pieces.reach_high[piece] + EQUAL).all(axis=1)
        above &= (xi.sum(axis=1) <= pieces.reach_total[piece] + EQUAL) & np.isfinite(distance[rows, chosen])
        return piece, xi, above

    def _reach(
        self, current: CurrentPieces, points: FloatArray, outward: FloatArray, piece: IntArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return distances (m,) from pieces (m,), infinite if these do not face the point; natural coordinates (m,
        a).
        """
        natural = project(self.pieces, current, piece, points)
        point = current.at(piece, inside(self.pieces, piece, natural))
        away = np.einsum("md,md->m", point.normal, outward) > np.where(outward.any(axis=1), self._facing, np.inf)
        return np.where(away, np.inf, np.linalg.norm(points - point.at, axis=1)), natural
