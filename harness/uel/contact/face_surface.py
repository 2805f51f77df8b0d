# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Main surfaces of element faces, and the closest point projection onto them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.contact.main_surface import EQUAL, SurfacePoints
from uel.contact.shape_functions import monomials, weights_of
from uel.model.arrays import FloatArray, IntArray
from uel.model.contact import Pieces

STEPS: Final = 20
"""Largest number of Newton iterations of a projection."""

FLAT: Final = 1e-14
"""Squared area of a piece over its size to the fourth power that is rounding."""

NEAREST: Final = 4
"""Nearest main nodes whose pieces are tried in a global search."""

WALK: Final = 50
"""Largest number of pieces that a node passes in one iteration."""

BEYOND: Final = {3: 0.125, 4: 0.0, 8: 1.0}
"""Largest distance of a piece from the bounding box of its nodes, over the box size, by number of monomials: the
largest sum of negative shape functions, -1/8 on a quadratic line and 4 times -1/4 at the centre of a quadratic
quadrilateral.
"""

ROUNDED: Final = 1e-6
"""Rounding error of angles."""


@dataclass(frozen=True, slots=True)
class _Current:
    """Pieces of the current surface, with bounds that avoid most projections.

    polynomials  (p, q, d) coefficients of the monomials
    sizes        (p,) as in `Surface`
    low, high    (p, d) corners of bounding boxes
    axes, angles (p, d), (p,) cone of the normals of each piece
    """

    polynomials: FloatArray
    sizes: FloatArray
    low: FloatArray
    high: FloatArray
    axes: FloatArray
    angles: FloatArray

    @classmethod
    def of(cls, pieces: Pieces, coordinates: FloatArray) -> _Current:
        """Make the pieces from the current coordinates (nodes, d) of all nodes."""
        corners = coordinates[pieces.nodes]
        polynomials = _polynomials(pieces.shapes, corners)
        count = polynomials.shape[1]
        low, high = corners.min(axis=1), corners.max(axis=1)
        beyond = BEYOND[count] * (high - low)
        ends = np.stack(np.meshgrid(*[[0, 1]] * pieces.low.shape[1]), axis=-1).reshape(-1, pieces.low.shape[1])
        normals = np.stack(
            [_evaluate(polynomials, np.where(end, pieces.high, pieces.low)).normal for end in ends], axis=1
        )
        axes = normals.sum(axis=1)
        axes /= np.maximum(np.linalg.norm(axes, axis=1), EQUAL)[:, None]
        cosine = np.einsum("ped,pd->pe", normals, axes).min(axis=1)
        # normals of curved faces may be outside the cone of the corners
        bounded = (cosine > EQUAL) & (count <= 4)
        angles = np.where(bounded, np.arccos(np.clip(cosine, -1.0, 1.0)), np.inf)
        return cls(polynomials, _sizes(corners), low - beyond, high + beyond, axes, angles)

    def at(self, piece: IntArray, natural: FloatArray) -> SurfacePoints:
        """Return points of pieces, see `Surface.at`."""
        return _evaluate(self.polynomials[piece], natural)

    def least(self, points: FloatArray, outward: FloatArray, candidates: IntArray, facing: float) -> FloatArray:
        """Return (m, c) lower bounds of the distances from candidates; infinite if no normal faces the point."""
        beside = np.maximum(self.low[candidates] - points[:, None], points[:, None] - self.high[candidates])
        beside = np.maximum(beside, 0.0)
        least = np.sqrt(np.einsum("mcd,mcd->mc", beside, beside))
        cosine = np.einsum("mcd,md->mc", self.axes[candidates], outward)
        away = np.arccos(np.clip(cosine, -1.0, 1.0)) + self.angles[candidates] < np.arccos(facing) - ROUNDED
        return np.where(away & np.asarray(outward.any(axis=1))[:, None], np.inf, least)


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
        return _evaluate(_polynomials(self.pieces.shapes[piece], self._coordinates[nodes] + u[nodes]), natural)

    def sizes(self, piece: IntArray, u: FloatArray) -> FloatArray:
        """Return the sizes of pieces, see `Surface.sizes`: largest distances of nodes from their middle."""
        nodes = self.pieces.nodes[piece]
        return _sizes(self._coordinates[nodes] + u[nodes])

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
        current, nearest_piece = _Current.of(self.pieces, self._coordinates + u), before.copy()
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
        return np.asarray(np.linalg.norm(points - self.at(piece, self._inside(piece, natural), u).at, axis=1))

    def locate(self, piece: IntArray, points: FloatArray) -> FloatArray:
        """Return natural coordinates (m, a) of points (m, d) on pieces (m,), extended, before any displacement."""
        return self._project(_Current.of(self.pieces, self._coordinates), piece, points)

    def nearest(self, points: FloatArray) -> tuple[IntArray, FloatArray]:
        """Return the nodes (m, k) of the pieces nearest to points (m, d), undeformed, and their shape functions
        there.
        """
        zero = np.zeros_like(self._coordinates)
        before = np.zeros(len(points), dtype=np.int64)
        piece, natural, _ = self.track(points, np.zeros_like(points), zero, before, everywhere=True)
        factors = weights_of(self.pieces.shapes[piece], self._inside(piece, natural))[0]
        factors = np.where(np.abs(factors) <= EQUAL, 0.0, factors)
        return self.nodes_of(piece), factors / factors.sum(axis=1, keepdims=True)

    def _nearest(
        self, current: _Current, points: FloatArray, outward: FloatArray, candidates: IntArray
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
        self, current: _Current, points: FloatArray, outward: FloatArray, piece: IntArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return distances (m,) from pieces (m,), infinite if these do not face the point; natural coordinates (m,
        a).
        """
        natural = self._project(current, piece, points)
        point = current.at(piece, self._inside(piece, natural))
        away = np.einsum("md,md->m", point.normal, outward) > np.where(outward.any(axis=1), self._facing, np.inf)
        return np.where(away, np.inf, np.linalg.norm(points - point.at, axis=1)), natural

    def _inside(self, piece: IntArray, natural: FloatArray) -> FloatArray:
        """Return natural coordinates clipped to the piece."""
        pieces = self.pieces
        end = np.clip(natural, pieces.low[piece], pieces.high[piece])
        over = np.maximum(end.sum(axis=1) - pieces.total[piece], 0.0)[:, None]
        return np.asarray(np.clip(end - over / end.shape[1], pieces.low[piece], pieces.high[piece]))

    def _project(self, current: _Current, piece: IntArray, points: FloatArray) -> FloatArray:
        """Return natural coordinates of the projections of points onto extended pieces, by Newton's method."""
        low, high = self.pieces.low[piece], self.pieces.high[piece]
        natural, reach = 0.5 * (low + high), 2.0 * (high - low)
        rows = np.arange(len(piece))
        for _ in range(STEPS):
            point = current.at(piece[rows], natural[rows])
            gap = points[rows] - point.at
            metric = point.metric
            matrix = metric - np.einsum("mabd,md->mab", point.second, gap)
            # a descent direction: without the curvature far from a curved piece
            convex = np.linalg.det(matrix) > 0.1 * np.linalg.det(metric)
            convex &= np.trace(matrix, axis1=1, axis2=2) > 0.0
            matrix = np.where(convex[:, None, None], matrix, metric)
            # steepest descent on a degenerate piece
            trace = np.trace(metric, axis1=1, axis2=2)
            flat = np.linalg.det(metric) <= FLAT * trace ** metric.shape[1]
            steepest = np.maximum(trace, np.finfo(float).tiny)[:, None, None] * np.eye(metric.shape[1])
            matrix = np.where(flat[:, None, None], steepest, matrix)
            change = np.linalg.solve(matrix, np.einsum("mad,md->ma", point.tangents, gap)[..., None])[..., 0]
            last = natural[rows]
            natural[rows] = np.clip(last + change, low[rows] - reach[rows], high[rows] + reach[rows])
            # convergence is quadratic: the next error is rounding
            rows = rows[np.abs(natural[rows] - last).max(axis=1) > EQUAL]
            if not len(rows):
                break
        return natural


def _polynomials(shapes: FloatArray, coordinates: FloatArray) -> FloatArray:
    """Return (m, p, d) coefficients of the monomials, for nodes at coordinates (m, k, d) with shapes (m, k, p)."""
    return np.asarray(np.einsum("mkp,mkd->mpd", shapes, coordinates))


def _sizes(coordinates: FloatArray) -> FloatArray:
    """Return (m,) largest distances of nodes, at coordinates (m, k, d), from their centroid."""
    return np.asarray(np.linalg.norm(coordinates - coordinates.mean(axis=1, keepdims=True), axis=2).max(axis=1))


def _evaluate(polynomials: FloatArray, natural: FloatArray) -> SurfacePoints:
    """Evaluate polynomials (m, p, d) at natural coordinates."""
    values, first, second = monomials(natural, polynomials.shape[1])
    return SurfacePoints(
        np.einsum("mp,mpd->md", values, polynomials),
        np.einsum("mpa,mpd->mad", first, polynomials),
        np.einsum("mpab,mpd->mabd", second, polynomials),
    )
