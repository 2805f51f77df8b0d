# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Main surfaces of faces of elements, and the piece that is nearest to a node."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.contact.main_surface import EQUAL, Place
from uel.contact.shape_functions import monomials, weights_of
from uel.model.arrays import FloatArray, IntArray
from uel.model.contact import Pieces

STEPS: Final = 20
"""Most iterations of Newton's method for the point of a piece that is nearest to a node."""

FLAT: Final = 1e-14
"""Area of a piece, squared, over its size to the fourth power, that counts as none."""

NEAREST: Final = 4
"""Nodes of the main surface whose pieces are tried for a node whose piece is not known."""

WALK: Final = 50
"""Pieces that a node may pass in one iteration."""

BEYOND: Final = {3: 0.125, 4: 0.0, 8: 1.0}
"""Distance by which a piece may leave the box of its nodes, over the size of the box, by the number of its monomials:
the largest sum of the negative shape functions. Those of a line with a middle node are -1/8 in the middle of a half,
those of the corners of a quadrilateral with middle nodes -1/4 in its middle.
"""

ROUNDED: Final = 1e-6
"""Error of angles that is rounding."""


@dataclass(frozen=True, slots=True)
class _Present:
    """All pieces of a surface in a present place, and bounds that spare most projections.

    polynomials  (p, q, d) coefficients of the monomials
    sizes        (p,) as of `Surface`
    low, high    (p, d) corners of boxes that hold the pieces
    axes         (p, d) around which the normals of a piece are, within angles (p,)
    """

    polynomials: FloatArray
    sizes: FloatArray
    low: FloatArray
    high: FloatArray
    axes: FloatArray
    angles: FloatArray

    @classmethod
    def of(cls, pieces: Pieces, places: FloatArray) -> _Present:
        """Make the pieces from the places (nodes, d) of all nodes of the model."""
        corners = places[pieces.nodes]
        polynomials = _polynomials(pieces.shapes, corners)
        count = polynomials.shape[1]
        low, high = corners.min(axis=1), corners.max(axis=1)
        beyond = BEYOND[count] * (high - low)
        ends = np.stack(np.meshgrid(*[[0, 1]] * pieces.low.shape[1]), axis=-1).reshape(-1, pieces.low.shape[1])
        normals = np.stack([_place(polynomials, np.where(end, pieces.high, pieces.low)).normal for end in ends], axis=1)
        axes = normals.sum(axis=1)
        axes /= np.maximum(np.linalg.norm(axes, axis=1), EQUAL)[:, None]
        cosine = np.einsum("ped,pd->pe", normals, axes).min(axis=1)
        # normals of curved faces may be outside those of their corners
        bounded = (cosine > EQUAL) & (count <= 4)
        angles = np.where(bounded, np.arccos(np.clip(cosine, -1.0, 1.0)), np.inf)
        return cls(polynomials, _sizes(corners), low - beyond, high + beyond, axes, angles)

    def at(self, piece: IntArray, natural: FloatArray) -> Place:
        """Return points of pieces, see `Surface.at`."""
        return _place(self.polynomials[piece], natural)

    def least(self, points: FloatArray, looks: FloatArray, candidates: IntArray, facing: float) -> FloatArray:
        """Return (m, c) lower bounds of the distances of points from candidates;
        infinite if none of the normals faces the point.
        """
        beside = np.maximum(self.low[candidates] - points[:, None], points[:, None] - self.high[candidates])
        beside = np.maximum(beside, 0.0)
        least = np.sqrt(np.einsum("mcd,mcd->mc", beside, beside))
        cosine = np.einsum("mcd,md->mc", self.axes[candidates], looks)
        away = np.arccos(np.clip(cosine, -1.0, 1.0)) + self.angles[candidates] < np.arccos(facing) - ROUNDED
        return np.where(away & np.asarray(looks.any(axis=1))[:, None], np.inf, least)


class FaceSurface:
    """A main surface of faces of elements."""

    def __init__(self, pieces: Pieces, coordinates: FloatArray, facing: float = EQUAL) -> None:
        """Prepare the surface; coordinates (nodes, d) are those of all nodes of the model. Pieces with a normal whose
        cosine with that of a point exceeds `facing` are not opposite it.
        """
        dimension = coordinates.shape[1]
        self.pieces, self._coordinates, self._dimension, self._facing = pieces, coordinates, dimension, facing
        self._along = pieces.low.shape[1]
        self.dofs = tuple(range(1, dimension + 1))
        self.unknowns = tuple((node, dof) for node in range(1, 1 + pieces.nodes.shape[1]) for dof in self.dofs)
        self._own = np.unique(pieces.nodes)
        order = np.argsort(pieces.nodes.ravel(), kind="stable")
        counts = np.bincount(np.searchsorted(self._own, pieces.nodes.ravel()))
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

    def at(self, piece: IntArray, natural: FloatArray, moved: FloatArray) -> Place:
        """Return points of pieces, see `Surface.at`."""
        nodes = self.pieces.nodes[piece]
        return _place(_polynomials(self.pieces.shapes[piece], self._coordinates[nodes] + moved[nodes]), natural)

    def sizes(self, piece: IntArray, moved: FloatArray) -> FloatArray:
        """Return the sizes of pieces, see `Surface.sizes`: largest distances of nodes from their middle."""
        nodes = self.pieces.nodes[piece]
        return _sizes(self._coordinates[nodes] + moved[nodes])

    def by_unknowns(self, piece: IntArray, natural: FloatArray, moved: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the derivatives of points and tangents, see `Surface.by_unknowns`."""
        del moved
        return self._spread(self.pieces.shapes[piece], natural)

    def loaded(
        self, piece: IntArray, natural: FloatArray, moved: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray | None]:
        """Return the motions along which forces do work and their derivatives, see `Surface.loaded`."""
        del moved
        return *self._spread(self.pieces.loads[piece], natural), None

    def _spread(self, shapes: FloatArray, natural: FloatArray) -> tuple[FloatArray, FloatArray]:
        m, dimension, eye = len(natural), self._dimension, np.eye(self._dimension)
        values, first, _ = weights_of(shapes, natural)
        unknowns = shapes.shape[1] * dimension
        at = np.einsum("mk,de->mdke", values, eye).reshape(m, dimension, unknowns)
        return at, np.einsum("mka,de->madke", first, eye).reshape(m, first.shape[2], dimension, unknowns)

    def track(
        self, points: FloatArray, looks: FloatArray, moved: FloatArray, before: IntArray, *, everywhere: bool
    ) -> tuple[IntArray, FloatArray, NDArray[np.bool_]]:
        """Find the nearest pieces, see `Surface.track`."""
        present, found = _Present.of(self.pieces, self._coordinates + moved), before.copy()
        if everywhere:
            places = self._coordinates[self._own] + moved[self._own]
            from scipy.spatial import KDTree  # noqa: PLC0415 (takes 0.1 s, and few decks have contact)

            _, near = KDTree(places).query(points, k=min(NEAREST, len(places)))
            count = near.size // max(len(points), 1)
            near = self._of_node[near.reshape(len(points), count)]
            near = near.reshape(len(points), count * near.shape[2])
            found = self._nearest(present, points, looks, np.concatenate([before[:, None], near], axis=1))[0]
        natural, above = np.zeros((len(points), self._along)), np.zeros(len(points), dtype=np.bool_)
        rows = np.arange(len(points))
        for _ in range(WALK):
            last = found[rows]
            candidates = np.concatenate([last[:, None], self.pieces.ring[last]], axis=1)
            nearest = self._nearest(present, points[rows], looks[rows], candidates)
            found[rows], natural[rows], above[rows] = nearest
            rows = rows[nearest[0] != last]
            if not len(rows):
                break
        return found, natural, above

    def distances(self, points: FloatArray, moved: FloatArray) -> FloatArray:
        """Return the distances (m,) of points (m, d) from the nearest piece, whatever its normal."""
        before, looks = np.zeros(len(points), dtype=np.int64), np.zeros_like(points)
        piece, natural, _ = self.track(points, looks, moved, before, everywhere=True)
        return np.asarray(np.linalg.norm(points - self.at(piece, self._inside(piece, natural), moved).at, axis=1))

    def locate(self, piece: IntArray, points: FloatArray) -> FloatArray:
        """Return natural coordinates (m, a) of points (m, d) on pieces (m,), extended, before any displacement."""
        return self._project(_Present.of(self.pieces, self._coordinates), piece, points)

    def nearest(self, points: FloatArray) -> tuple[IntArray, FloatArray]:
        """Return the nodes (m, k) of the pieces nearest to points (m, d) before any displacement, and their shape
        functions there, zero up to rounding.
        """
        still = np.zeros_like(self._coordinates)
        before = np.zeros(len(points), dtype=np.int64)
        piece, natural, _ = self.track(points, np.zeros_like(points), still, before, everywhere=True)
        shares = weights_of(self.pieces.shapes[piece], self._inside(piece, natural))[0]
        shares = np.where(np.abs(shares) <= EQUAL, 0.0, shares)
        return self.nodes_of(piece), shares / shares.sum(axis=1, keepdims=True)

    def _nearest(
        self, present: _Present, points: FloatArray, looks: FloatArray, candidates: IntArray
    ) -> tuple[IntArray, FloatArray, NDArray[np.bool_]]:
        """Find the nearest piece of candidates (m, c), as in `track`; of several as near the first.

        The one whose box is nearest comes first; others only if their boxes are not further away than it is.
        """
        pieces, rows = self.pieces, np.arange(len(candidates))
        least = present.least(points, looks, candidates, self._facing)
        first = least.argmin(axis=1)
        distance, natural = np.full(least.shape, np.inf), np.zeros((*least.shape, self._along))
        closest, natural[rows, first] = self._reach(present, points, looks, candidates[rows, first])
        distance[rows, first] = closest
        margin = EQUAL * present.sizes[candidates]
        # twice: rounding
        near = np.isfinite(least) & (least <= closest[:, None] + 2.0 * margin)
        # where all of them look the same way, it is the first one
        near[:, 0] |= np.isinf(closest)
        row, column = np.nonzero(near & (candidates != candidates[rows, first][:, None]))
        # candidates may be repeated
        total = len(pieces.nodes)
        pairs, place_of = np.unique(row * total + candidates[row, column], return_inverse=True)
        others, other = pairs // total, pairs % total
        apart, places = self._reach(present, points[others], looks[others], other)
        distance[row, column], natural[row, column] = apart[place_of], places[place_of]
        chosen = np.argmax(distance <= distance.min(axis=1, keepdims=True) + margin, axis=1)
        piece, place = candidates[rows, chosen], natural[rows, chosen]
        above = (place >= pieces.reach_low[piece] - EQUAL).all(axis=1)
        above &= (place <= pieces.reach_high[piece] + EQUAL).all(axis=1)
        above &= (place.sum(axis=1) <= pieces.reach_total[piece] + EQUAL) & np.isfinite(distance[rows, chosen])
        return piece, place, above

    def _reach(
        self, present: _Present, points: FloatArray, looks: FloatArray, piece: IntArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return distances (m,) of points from pieces (m,), infinite from those that do not face the point,
        and natural coordinates (m, a).
        """
        natural = self._project(present, piece, points)
        place = present.at(piece, self._inside(piece, natural))
        away = np.einsum("md,md->m", place.normal, looks) > np.where(looks.any(axis=1), self._facing, np.inf)
        return np.where(away, np.inf, np.linalg.norm(points - place.at, axis=1)), natural

    def _inside(self, piece: IntArray, natural: FloatArray) -> FloatArray:
        """Return natural coordinates of the nearest point that belongs to the piece."""
        pieces = self.pieces
        end = np.clip(natural, pieces.low[piece], pieces.high[piece])
        over = np.maximum(end.sum(axis=1) - pieces.total[piece], 0.0)[:, None]
        return np.asarray(np.clip(end - over / end.shape[1], pieces.low[piece], pieces.high[piece]))

    def _project(self, present: _Present, piece: IntArray, points: FloatArray) -> FloatArray:
        """Return natural coordinates where pieces, extended, are perpendicular to the way to points,
        by Newton's method.
        """
        low, high = self.pieces.low[piece], self.pieces.high[piece]
        natural, reach = 0.5 * (low + high), 2.0 * (high - low)
        rows = np.arange(len(piece))
        for _ in range(STEPS):
            place = present.at(piece[rows], natural[rows])
            apart = points[rows] - place.at
            metric = place.metric
            matrix = metric - np.einsum("mabd,md->mab", place.second, apart)
            # downhill: far from a curved piece only without its curvature
            convex = np.linalg.det(matrix) > 0.1 * np.linalg.det(metric)
            convex &= np.trace(matrix, axis1=1, axis2=2) > 0.0
            matrix = np.where(convex[:, None, None], matrix, metric)
            # where a piece has no area, along the steepest way
            trace = np.trace(metric, axis1=1, axis2=2)
            flat = np.linalg.det(metric) <= FLAT * trace ** metric.shape[1]
            steepest = np.maximum(trace, np.finfo(float).tiny)[:, None, None] * np.eye(metric.shape[1])
            matrix = np.where(flat[:, None, None], steepest, matrix)
            change = np.linalg.solve(matrix, np.einsum("mad,md->ma", place.tangents, apart)[..., None])[..., 0]
            last = natural[rows]
            natural[rows] = np.clip(last + change, low[rows] - reach[rows], high[rows] + reach[rows])
            # the method doubles the digits: the error is now that of rounding
            rows = rows[np.abs(natural[rows] - last).max(axis=1) > EQUAL]
            if not len(rows):
                break
        return natural


def _polynomials(shapes: FloatArray, places: FloatArray) -> FloatArray:
    """Return (m, p, d) coefficients of the monomials, for nodes at places (m, k, d) with shapes (m, k, p)."""
    return np.asarray(np.einsum("mkp,mkd->mpd", shapes, places))


def _sizes(places: FloatArray) -> FloatArray:
    """Return (m,) largest distances of nodes, at places (m, k, d), from their middle."""
    return np.asarray(np.linalg.norm(places - places.mean(axis=1, keepdims=True), axis=2).max(axis=1))


def _place(polynomials: FloatArray, natural: FloatArray) -> Place:
    """Evaluate polynomials (m, p, d) at natural coordinates."""
    values, first, second = monomials(natural, polynomials.shape[1])
    return Place(
        np.einsum("mp,mpd->md", values, polynomials),
        np.einsum("mpa,mpd->mad", first, polynomials),
        np.einsum("mpab,mpd->mabd", second, polynomials),
    )
