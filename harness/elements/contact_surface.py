# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Main surfaces of finite sliding: where they are, how they move with the unknowns, and which point is nearest."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from harness.model.arrays import FloatArray, IntArray
from harness.model.contact import Pieces

STEPS: Final = 20
"""Of Newton's method, for the point of a piece that is nearest to a node."""

EQUAL: Final = 1e-9
"""Difference of distances, over the size of a piece, that counts as none, and of natural coordinates."""

NEAREST: Final = 4
"""Nodes of the main surface whose pieces are tried for a node whose piece is not known."""

WALK: Final = 50
"""Pieces that a node may pass in one iteration."""


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
        """(m, a, a) products of the tangents, with an inverse also where an extended face has no area."""
        found = np.einsum("mad,mbd->mab", self.tangents, self.tangents)
        size = np.trace(found, axis1=1, axis2=2)[:, None, None]
        return np.asarray(found + EQUAL**2 * size * np.eye(found.shape[1]))

    def take(self, points: IntArray) -> Place:
        """Some of the points."""
        return Place(self.at[points], self.tangents[points], self.second[points])

    @property
    def normal(self) -> FloatArray:
        """(m, d) outward, of length one."""
        first = self.tangents[:, 0]
        if self.at.shape[1] == 2:
            found = np.stack([first[:, 1], -first[:, 0]], axis=1)
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
        """(m, k) nodes of pieces (m,)."""

    def ring_of(self, piece: IntArray) -> IntArray:
        """(m, r) neighbours of pieces (m,), and themselves."""

    def sizes(self, piece: IntArray, moved: FloatArray) -> FloatArray:
        """(m,) about half of the lengths of pieces (m,)."""

    def at(self, piece: IntArray, natural: FloatArray, moved: FloatArray) -> Place:
        """Points (m,) of pieces, by their natural coordinates (m, a)."""

    def by_unknowns(self, piece: IntArray, natural: FloatArray, moved: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Derivatives of points (m, d, u) and tangents (m, a, d, u) by the unknowns."""

    def loaded(
        self, piece: IntArray, natural: FloatArray, moved: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray | None]:
        """Motions (m, d, u) along which forces on points do work, their derivatives (m, a, d, u) along the surface and
        (m, d, u, u) by the unknowns; None: zero.
        """

    def track(
        self, points: FloatArray, looks: FloatArray, moved: FloatArray, before: IntArray, *, everywhere: bool
    ) -> tuple[IntArray, FloatArray, NDArray[np.bool_]]:
        """The pieces nearest to points (m, d), the natural coordinates (m, a) there, and whether points are above them.

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


class FaceSurface:
    """A main surface of faces of elements."""

    def __init__(self, pieces: Pieces, coordinates: FloatArray, facing: float = EQUAL) -> None:
        """Coordinates (nodes, d) are those of all nodes of the model; pieces with a normal whose cosine with that of a
        point exceeds `facing` are not opposite it.
        """
        dimension = coordinates.shape[1]
        self.pieces, self._coordinates, self._dimension, self._facing = pieces, coordinates, dimension, facing
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
        """As of `Surface`."""
        return np.asarray(self.pieces.nodes[piece])

    def ring_of(self, piece: IntArray) -> IntArray:
        """As of `Surface`."""
        return np.asarray(self.pieces.ring[piece])

    def at(self, piece: IntArray, natural: FloatArray, moved: FloatArray) -> Place:
        """As of `Surface`."""
        nodes = self.pieces.nodes[piece]
        places = self._coordinates[nodes] + moved[nodes]
        found = [np.einsum("mk...,mkd->m...d", one, places) for one in weights_of(self.pieces.shapes[piece], natural)]
        return Place(*found)

    def sizes(self, piece: IntArray, moved: FloatArray) -> FloatArray:
        """As of `Surface`: largest distances of nodes from their middle."""
        nodes = self.pieces.nodes[piece]
        places = self._coordinates[nodes] + moved[nodes]
        return np.asarray(np.linalg.norm(places - places.mean(axis=1, keepdims=True), axis=2).max(axis=1))

    def by_unknowns(self, piece: IntArray, natural: FloatArray, moved: FloatArray) -> tuple[FloatArray, FloatArray]:
        """As of `Surface`."""
        del moved
        return self._spread(self.pieces.shapes[piece], natural)

    def loaded(
        self, piece: IntArray, natural: FloatArray, moved: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray | None]:
        """As of `Surface`."""
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
        """As of `Surface`."""
        found = before
        if everywhere:
            places = self._coordinates[self._own] + moved[self._own]
            from scipy.spatial import KDTree  # noqa: PLC0415 (takes 0.1 s, and few decks have contact)

            _, near = KDTree(places).query(points, k=min(NEAREST, len(places)))
            near = self._of_node[near.reshape(len(points), -1)].reshape(len(points), -1)
            found = self._nearest(points, looks, moved, np.concatenate([before[:, None], near], axis=1))[0]
        for _ in range(WALK):
            candidates = np.concatenate([found[:, None], self.pieces.ring[found]], axis=1)
            last, (found, natural, above) = found, self._nearest(points, looks, moved, candidates)
            if np.array_equal(last, found):
                break
        return found, natural, above

    def distances(self, points: FloatArray, moved: FloatArray) -> FloatArray:
        """(m,) of points (m, d) from the nearest piece, whatever its normal."""
        before, looks = np.zeros(len(points), dtype=np.int64), np.zeros_like(points)
        piece, natural, _ = self.track(points, looks, moved, before, everywhere=True)
        return np.asarray(np.linalg.norm(points - self.at(piece, self._inside(piece, natural), moved).at, axis=1))

    def nearest(self, points: FloatArray) -> tuple[IntArray, FloatArray]:
        """Nodes (m, k) of the pieces, before any displacement, that are nearest to points (m, d), and their shares
        there: those that are rounding are zero.
        """
        still = np.zeros_like(self._coordinates)
        before = np.zeros(len(points), dtype=np.int64)
        piece, natural, _ = self.track(points, np.zeros_like(points), still, before, everywhere=True)
        shares = weights_of(self.pieces.shapes[piece], self._inside(piece, natural))[0]
        shares = np.where(np.abs(shares) <= EQUAL, 0.0, shares)
        return self.nodes_of(piece), shares / shares.sum(axis=1, keepdims=True)

    def _nearest(
        self, points: FloatArray, looks: FloatArray, moved: FloatArray, candidates: IntArray
    ) -> tuple[IntArray, FloatArray, NDArray[np.bool_]]:
        """Of candidates (m, c) the nearest piece: as in `track`. Of some that are as near it is the first one."""
        m, total = len(candidates), len(self.pieces.nodes)
        # candidates may be repeated
        pairs, place_of = np.unique(np.arange(m)[:, None] * total + candidates, return_inverse=True)
        row, piece = pairs // total, pairs % total
        point = points[row]
        every = self._project(piece, point, moved)
        end = self._inside(piece, every)
        place = self.at(piece, end, moved)
        away = np.einsum("md,md->m", place.normal, looks[row]) > np.where(looks[row].any(axis=1), self._facing, np.inf)
        apart = np.where(away, np.inf, np.linalg.norm(point - place.at, axis=1))
        place_of = place_of.reshape(candidates.shape)
        distance, size, natural = apart[place_of], self.sizes(piece, moved)[place_of], every[place_of]
        chosen = np.argmax(distance <= distance.min(axis=1, keepdims=True) + EQUAL * size, axis=1)
        rows = np.arange(m), chosen
        piece, natural = candidates[rows], natural[rows]
        pieces = self.pieces
        above = (natural >= pieces.reach_low[piece] - EQUAL).all(axis=1)
        above &= (natural <= pieces.reach_high[piece] + EQUAL).all(axis=1)
        above &= (natural.sum(axis=1) <= pieces.reach_total[piece] + EQUAL) & np.isfinite(distance[rows])
        return piece, natural, above

    def _inside(self, piece: IntArray, natural: FloatArray) -> FloatArray:
        """Natural coordinates of the nearest point that belongs to the piece."""
        pieces = self.pieces
        end = np.clip(natural, pieces.low[piece], pieces.high[piece])
        over = np.maximum(end.sum(axis=1) - pieces.total[piece], 0.0)[:, None]
        return np.asarray(np.clip(end - over / end.shape[1], pieces.low[piece], pieces.high[piece]))

    def _project(self, piece: IntArray, points: FloatArray, moved: FloatArray) -> FloatArray:
        """Natural coordinates where pieces, extended, are perpendicular to the way to points, by Newton's method."""
        low, high = self.pieces.low[piece], self.pieces.high[piece]
        natural, reach = 0.5 * (low + high), 2.0 * (high - low)
        rows = np.arange(len(piece))
        for _ in range(STEPS):
            place = self.at(piece[rows], natural[rows], moved)
            apart = points[rows] - place.at
            metric = place.metric
            matrix = metric - np.einsum("mabd,md->mab", place.second, apart)
            # downhill: far from a curved piece only without its curvature
            convex = np.linalg.det(matrix) > 0.1 * np.linalg.det(metric)
            convex &= np.trace(matrix, axis1=1, axis2=2) > 0.0
            matrix = np.where(convex[:, None, None], matrix, metric)
            change = np.linalg.solve(matrix, np.einsum("mad,md->ma", place.tangents, apart)[..., None])[..., 0]
            last = natural[rows]
            natural[rows] = np.clip(last + change, low[rows] - reach[rows], high[rows] + reach[rows])
            # the method doubles the digits: the error is now that of rounding
            rows = rows[np.abs(natural[rows] - last).max(axis=1) > EQUAL]
            if not len(rows):
                break
        return natural


def weights_of(shapes: FloatArray, natural: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """N (m, k) of coefficients (m, k, p), and their first (m, k, a) and second derivatives (m, k, a, a)."""
    values, first, second = monomials(natural, shapes.shape[2])
    return (
        np.einsum("mkp,mp->mk", shapes, values),
        np.einsum("mkp,mpa->mka", shapes, first),
        np.einsum("mkp,mpab->mkab", shapes, second),
    )


def monomials(natural: FloatArray, count: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The first ones of 1, xi, xi^2 or 1, xi, eta, xi eta, xi^2, eta^2, xi^2 eta, xi eta^2, and their derivatives.

    Parameters
    ----------
    natural
        (m, 1 or 2) natural coordinates.
    count
        p of them: 3 on a line, 4 or 8 on an area.

    Returns
    -------
    tuple[FloatArray, FloatArray, FloatArray]
        (m, p), with first (m, p, a) and second derivatives (m, p, a, a).
    """
    m, along = natural.shape
    first, second = np.zeros((m, count, along)), np.zeros((m, count, along, along))
    values = np.ones((m, count))
    values[:, 1 : along + 1] = natural
    if along == 1:
        values[:, 2] = natural[:, 0] ** 2
        first[:, 1, 0], first[:, 2, 0], second[:, 2, 0, 0] = 1.0, 2.0 * natural[:, 0], 2.0
        return values, first, second
    xi, eta = natural.T
    values[:, 3] = xi * eta
    first[:, 1, 0] = first[:, 2, 1] = 1.0
    first[:, 3] = natural[:, ::-1]
    second[:, 3, 0, 1] = second[:, 3, 1, 0] = 1.0
    if count > 4:
        values[:, 4:] = np.stack([xi**2, eta**2, xi**2 * eta, xi * eta**2], axis=1)
        first[:, 4, 0], first[:, 5, 1] = 2.0 * xi, 2.0 * eta
        first[:, 6], first[:, 7] = np.stack([2.0 * xi * eta, xi**2], axis=1), np.stack([eta**2, 2.0 * xi * eta], axis=1)
        second[:, 4, 0, 0] = second[:, 5, 1, 1] = 2.0
        second[:, 6, 0, 0], second[:, 7, 1, 1] = 2.0 * eta, 2.0 * xi
        second[:, 6, 0, 1] = second[:, 6, 1, 0] = 2.0 * xi
        second[:, 7, 0, 1] = second[:, 7, 1, 0] = 2.0 * eta
    return values, first, second
