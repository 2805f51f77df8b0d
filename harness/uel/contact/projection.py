# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Closest point projection onto the faces of a surface, by Newton's method; contact and *TIE use it.

A piece is a face, or a part of one, whose coordinates are polynomials of its natural coordinates.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from uel.contact.main_surface import EQUAL, SurfacePoints
from uel.contact.shape_functions import monomials
from uel.model.arrays import FloatArray, IntArray
from uel.model.contact import Pieces

STEPS: Final = 20
"""Largest number of Newton iterations of a projection."""

FLAT: Final = 1e-14
"""Squared area of a piece over its size to the fourth power that is rounding."""

BEYOND: Final = {3: 0.125, 4: 0.0, 8: 1.0}
"""Largest distance of a piece from the bounding box of its nodes, over the box size, by number of monomials: the
largest sum of negative shape functions, -1/8 on a quadratic line and 4 times -1/4 at the centre of a quadratic
quadrilateral.
"""

ROUNDED: Final = 1e-6
"""Rounding error of angles."""


@dataclass(frozen=True, slots=True)
class CurrentPieces:
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
    def of(cls, pieces: Pieces, coordinates: FloatArray) -> CurrentPieces:
        """Make the pieces from the current coordinates (nodes, d) of all nodes."""
        corners = coordinates[pieces.nodes]
        polynomials = polynomials_of(pieces.shapes, corners)
        count = polynomials.shape[1]
        low, high = corners.min(axis=1), corners.max(axis=1)
        beyond = BEYOND[count] * (high - low)
        ends = np.stack(np.meshgrid(*[[0, 1]] * pieces.low.shape[1]), axis=-1).reshape(-1, pieces.low.shape[1])
        normals = np.stack(
            [evaluate(polynomials, np.where(end, pieces.high, pieces.low)).normal for end in ends], axis=1
        )
        axes = normals.sum(axis=1)
        axes /= np.maximum(np.linalg.norm(axes, axis=1), EQUAL)[:, None]
        cosine = np.einsum("ped,pd->pe", normals, axes).min(axis=1)
        # normals of curved faces may be outside the cone of the corners
        bounded = (cosine > EQUAL) & (count <= 4)
        angles = np.where(bounded, np.arccos(np.clip(cosine, -1.0, 1.0)), np.inf)
        return cls(polynomials, sizes_of(corners), low - beyond, high + beyond, axes, angles)

    def at(self, piece: IntArray, natural: FloatArray) -> SurfacePoints:
        """Return points of pieces, see `Surface.at`."""
        return evaluate(self.polynomials[piece], natural)

    def least(self, points: FloatArray, outward: FloatArray, candidates: IntArray, facing: float) -> FloatArray:
        """Return (m, c) lower bounds of the distances from candidates; infinite if no normal faces the point."""
        beside = np.maximum(self.low[candidates] - points[:, None], points[:, None] - self.high[candidates])
        beside = np.maximum(beside, 0.0)
        least = np.sqrt(np.einsum("mcd,mcd->mc", beside, beside))
        cosine = np.einsum("mcd,md->mc", self.axes[candidates], outward)
        away = np.arccos(np.clip(cosine, -1.0, 1.0)) + self.angles[candidates] < np.arccos(facing) - ROUNDED
        return np.where(away & np.asarray(outward.any(axis=1))[:, None], np.inf, least)


def project(pieces: Pieces, current: CurrentPieces, piece: IntArray, points: FloatArray) -> FloatArray:
    """Return natural coordinates of the projections of points onto extended pieces, by Newton's method."""
    low, high = pieces.low[piece], pieces.high[piece]
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


def inside(pieces: Pieces, piece: IntArray, natural: FloatArray) -> FloatArray:
    """Return natural coordinates clipped to the piece."""
    end = np.clip(natural, pieces.low[piece], pieces.high[piece])
    over = np.maximum(end.sum(axis=1) - pieces.total[piece], 0.0)[:, None]
    return np.asarray(np.clip(end - over / end.shape[1], pieces.low[piece], pieces.high[piece]))


def polynomials_of(shapes: FloatArray, coordinates: FloatArray) -> FloatArray:
    """Return (m, p, d) coefficients of the monomials, for nodes at coordinates (m, k, d) with shapes (m, k, p)."""
    return np.asarray(np.einsum("mkp,mkd->mpd", shapes, coordinates))


def sizes_of(coordinates: FloatArray) -> FloatArray:
    """Return (m,) largest distances of nodes, at coordinates (m, k, d), from their centroid."""
    return np.asarray(np.linalg.norm(coordinates - coordinates.mean(axis=1, keepdims=True), axis=2).max(axis=1))


def evaluate(polynomials: FloatArray, natural: FloatArray) -> SurfacePoints:
    """Evaluate polynomials (m, p, d) at natural coordinates."""
    values, first, second = monomials(natural, polynomials.shape[1])
    return SurfacePoints(
        np.einsum("mp,mpd->md", values, polynomials),
        np.einsum("mpa,mpd->mad", first, polynomials),
        np.einsum("mpab,mpd->mabd", second, polynomials),
    )
