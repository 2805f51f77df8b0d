# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Motion of contact points in surface-to-surface finite sliding: the clearance of a point is a mean over samples.

The clearance of a secondary node is the mean of those of samples of its faces, weighted by its shape function, and so
is the force on the nodes of both surfaces: a constant pressure gives each surface the forces that it has on it, where
the samples integrate the shape functions of both. In the plane they do: an increment begins with samples of the
segments into which nodes of the main surface cut the faces. Weights are those of the mesh. In an increment a sample
keeps its place on the secondary surface, so that the derivatives of the means are means.

The slip is that of the node itself, as in `contact_sliding`.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.contact.face_surface import FaceSurface
from uel.contact.finite_sliding import FiniteSliding, Opposites, normals_of, rounding_of, unit
from uel.contact.geometric_corrections import corrections
from uel.contact.kinematics import Clearances, Slips, displacements
from uel.contact.main_surface import EQUAL
from uel.contact.shape_functions import weights_of
from uel.elements.contributor import Find
from uel.model.arrays import FloatArray, IntArray
from uel.model.contact import Pieces, SurfacePair
from uel.model.restart import Saved

FACING: Final = 0.5
"""Cosine of the angle between normals, 60 degrees, up to which faces continue each other, and others are opposite."""

ALONG: Final = 4
"""Samples of a face along each direction, in space."""

SLIVER: Final = 0.01
"""Part of its area that must be opposite the main surface for a node to touch it."""

NEARER: Final = 1e-6
"""Relative difference of distances that is rounding."""

_GAUSS: Final = np.polynomial.legendre.leggauss(3)
"""Points and weights on a segment, in the plane: exact for products of two shape functions and the clearance."""


class SurfaceSliding:
    """The points of a pair, with the samples over which they are means."""

    def __init__(self, pair: SurfacePair, coordinates: FloatArray) -> None:
        """Prepare the surfaces; coordinates (nodes, 3) are those of all nodes of the model."""
        assert isinstance(pair.main, Pieces)
        self._pair, self._main, self._dimension = pair, pair.main, pair.dimension
        self._coordinates = coordinates[:, : pair.dimension]
        self._own = FaceSurface(pair.own, self._coordinates)
        self._all = FaceSurface(pair.main, self._coordinates)
        self._slip = FiniteSliding(pair, coordinates, -FACING)
        self.components = pair.dimension
        self._base = len(coordinates) + 1
        self._linked = np.zeros(0, dtype=np.int64)
        self._keys = self._linked
        self.nodes = pair.secondary[:, None]
        self._moved = np.zeros_like(self._coordinates)
        # displacements at which the samples are new
        self._sampled: FloatArray | None = self._moved
        self._sample()
        self.reach()
        start, size = self._clearances, self._own.sizes(np.zeros(1, dtype=np.int64), self._moved)[0]
        self._start = np.where(np.abs(start) <= EQUAL * size, 0.0, start)

    def unknowns_of(self, count: int) -> tuple[tuple[int, int], ...]:
        """Return the displacements of one node after the other."""
        return displacements(count, self._dimension)

    def start(self) -> FloatArray:
        """Return (m,) clearances before the analysis, 0 if they differ from 0 by rounding alone."""
        return self._start

    def at_nodes(self) -> tuple[NDArray[np.bool_], FloatArray, FloatArray]:
        """Return, before the analysis, the mask (m,) of points that can touch, and clearances (m,) and normals (m,
        d) at their nodes.
        """
        start = self._slip.start() - corrections(
            self._pair.rounded[1], self._main, self._coordinates, self._slip.places
        )
        return self.above & self._slip.above, start, self._slip.start_normals

    def track(self, u: FloatArray, du: FloatArray, find: Find, *, first: bool) -> None:
        """Find the pieces opposite the samples; the first pass of an increment chooses new samples."""
        self._slip.track(u, du, find, first=first)
        self._moved = self._slip.moved
        if not first:
            self._opposite.search(self._moved, self._looks(), everywhere=False)
            self._average()
        elif self._sampled is None or not np.array_equal(self._sampled, self._moved):
            self._sample()
        self._sampled = self._moved if first else None

    def _looks(self) -> FloatArray:
        """Return (q, d) normals of the secondary surface at the samples."""
        places = self._coordinates + self._moved
        return unit(normals_of(places[self._pair.own.nodes]))[self._face]

    def _sample(self) -> None:
        """Choose samples, and find the pieces opposite them."""
        self._face, natural, share = self._in_plane() if self._dimension == 2 else self._in_space()
        pair, face = self._pair, self._face
        nodes = pair.own.nodes[face]
        shapes = weights_of(pair.own.shapes[face], natural)[0]
        tangents = self._own.at(face, natural, np.zeros_like(self._moved)).tangents
        size = tangents[:, 0] if self._dimension == 2 else np.cross(tangents[:, 0], tangents[:, 1])
        area = share * np.linalg.norm(size, axis=1) * np.einsum("qk,qk->q", shapes, pair.depths[face])
        self._parts, self._point = area[:, None] * shapes, pair.corners[face]
        self._opposite = Opposites(self._main, self._coordinates, nodes, shapes, -FACING)
        self._opposite.search(self._moved, self._looks(), everywhere=True)
        self._there = self._reaches()
        sides = (pair.own, (face, natural)), (self._main, (self._opposite.piece, self._opposite.natural))
        self._outside = sum(
            corrections(rounded, pieces, self._coordinates, place)
            for rounded, (pieces, place) in zip(pair.rounded, sides, strict=True)
        )
        self._average()

    def _reaches(self) -> NDArray[np.bool_]:
        """Return the mask (q,) of samples with nothing between them and the faces opposite them. A sample behind a face
        is in the body of this face, where no other face is nearer, and not at the far side of its own body.
        """
        values = self._opposite.values(self._moved)
        there = values >= -self._pair.deepest[self._face]
        behind = np.flatnonzero(there & (values < 0.0) & self._opposite.above)
        if len(behind):
            nearest = self._all.distances(self._opposite.points(self._moved)[behind], self._moved)
            there[behind] = nearest >= -values[behind] * (1.0 - NEARER)
        return there

    def _in_plane(self) -> tuple[IntArray, FloatArray, FloatArray]:
        """Return the faces of samples, their natural coordinates, and their parts of the lengths,
        in natural coordinates.
        """
        count = len(self._pair.own.nodes)
        cutting = np.unique(self._main.nodes)
        places = self._coordinates[cutting] + self._moved[cutting]
        before = np.zeros(len(cutting), dtype=np.int64)
        looks = np.zeros_like(places)
        piece, natural, _ = self._own.track(places, looks, self._moved, before, everywhere=True)
        inside = np.abs(natural[:, 0]) < 1.0 - EQUAL
        every = np.arange(count)
        face = np.concatenate([every, every, piece[inside]])
        place = np.concatenate([np.full(count, -1.0), np.ones(count), natural[inside, 0]])
        order = np.lexsort((place, face))
        face, place = face[order], place[order]
        start = np.flatnonzero((face[1:] == face[:-1]) & (place[1:] - place[:-1] > EQUAL))
        middle, half = 0.5 * (place[start + 1] + place[start]), 0.5 * (place[start + 1] - place[start])
        points = (middle[:, None] + half[:, None] * _GAUSS[0]).reshape(-1, 1)
        return np.repeat(face[start], 3), points, (half[:, None] * _GAUSS[1]).ravel()

    def _in_space(self) -> tuple[IntArray, FloatArray, FloatArray]:
        """Return the same as `_in_plane`, with areas: the samples are the middles of equal parts."""
        four = np.isinf(self._pair.own.total)
        faces, points, shares = [], [], []
        for chosen, (places, share) in ((np.flatnonzero(four), _SQUARE), (np.flatnonzero(~four), _TRIANGLE)):
            faces.append(np.repeat(chosen, len(places)))
            points.append(np.tile(places, (len(chosen), 1)))
            shares.append(np.full(len(faces[-1]), share))
        return np.concatenate(faces), np.concatenate(points), np.concatenate(shares)

    def _average(self) -> None:
        """Compute clearances and areas of the points, and the weights of the samples in them."""
        m, opposite = len(self._pair.secondary), self._opposite
        values = opposite.values(self._moved) - self._outside
        here = (opposite.above & self._there)[:, None]
        parts, point = self._parts, self._point
        whole, area = _sums(point, parts, m), _sums(point, parts * here, m)
        self.above: NDArray[np.bool_] = area > SLIVER * whole
        # those that touch nothing are as far away as their samples in the mean
        parts = np.where(self.above[point], parts * here, parts)
        self.areas = _sums(point, parts, m)
        self._weights = parts / self.areas[point]
        distances = np.where(here, values[:, None], np.abs(values)[:, None])
        self._clearances = _sums(point, self._weights * distances, m)
        self._find_nodes()

    def _find_nodes(self) -> None:
        """Find the nodes that move each point, and the places in them of the nodes of its samples and of its slip.

        Pairs of a sample and a point are those with a weight; a point that touches nothing has its own node alone.
        """
        row = np.arange(len(self._pair.secondary))
        sample, column = np.nonzero((self._weights > 0.0) & self.above[self._point])
        self._used, self._sample_of = np.unique(sample, return_inverse=True)
        self._point_of, self._weight_of = self._point[sample, column], self._weights[sample, column]
        self._touching = row[self.above]
        of_samples = self._key(self._point_of[:, None], self._opposite.nodes_of()[sample])
        of_slips = self._key(self._touching[:, None], self._slip.nodes[self._touching])
        keys = np.unique(np.concatenate([row * self._base, of_samples.ravel(), of_slips.ravel()]))
        first = np.searchsorted(keys, row * self._base)
        if not np.array_equal(keys, self._keys):
            self._keys = keys
            self.nodes = self._rows(keys)[1]
        self._places = np.searchsorted(keys, of_samples) - first[self._point_of][:, None]
        self._slip_places = np.searchsorted(keys, of_slips) - first[self._touching][:, None]

    def _key(self, point: IntArray, nodes: IntArray) -> IntArray:
        """Return one number for a point and a node, smallest for its own node."""
        own = nodes == self._pair.secondary[point]
        return np.asarray(point * self._base + np.where(own, 0, nodes + 1))

    def _rows(self, keys: IntArray) -> tuple[IntArray, IntArray]:
        """Return the points in sorted keys, and a row of nodes of each, filled up with its own node."""
        point, node = keys // self._base, keys % self._base - 1
        points, first, counts = np.unique(point, return_index=True, return_counts=True)
        rows = np.repeat(self._pair.secondary[points][:, None], max(int(counts.max(initial=1)), 1), axis=1)
        inside = np.repeat(np.arange(len(points)), counts), np.arange(len(keys)) - np.repeat(first, counts)
        rows[inside] = np.where(node < 0, self._pair.secondary[point], node)
        return points, rows

    @property
    def known(self) -> bool:
        """Whether all nodes that move a point are among those of `links`."""
        return bool(np.isin(self._keys, self._linked).all())

    def reach(self) -> None:
        """Update `links` to the nodes that move each point now, and those of neighbouring pieces."""
        self._slip.reach()
        surface, pieces = self._opposite.surface, self._opposite.piece[self._used]
        ring = surface.ring_of(pieces)
        nodes = surface.nodes_of(ring.ravel())
        around = nodes.reshape(len(pieces), ring.shape[1] * nodes.shape[1])[self._sample_of]
        point, beside = self._slip.links()
        near = self.above[point]
        both = self._key(self._point_of[:, None], around), self._key(point[near, None], beside[near])
        self._linked = np.unique(np.concatenate([self._keys, *(keys.ravel() for keys in both)]))

    def links(self) -> tuple[IntArray, IntArray]:
        """Return points and their nodes, at the last `reach`."""
        return self._rows(self._linked)

    def clearances(self, moved: FloatArray, *, nlgeom: bool) -> Clearances:
        """Compute the clearances in the present place of the surface, with NLGEOM or without."""
        self._slip.clearances(moved, nlgeom=nlgeom)
        self._now = now = self._opposite.opposition(self._moved, self._used)
        m, width = len(self.nodes), self.nodes.shape[1] * self._dimension
        places = self._point_of[:, None] * width + self._unknowns(self._places)
        parts = self._weight_of[:, None] * now.gradient[self._sample_of]
        gradient = _sums(places, parts, m * width).reshape(m, width)
        rounding = rounding_of(self._coordinates, self._moved)
        return Clearances(self._clearances, gradient, gradient, self._curvature, rounding)

    def _unknowns(self, places: IntArray) -> IntArray:
        """Return (r, u) places, among the unknowns of a point, of those of nodes at these places (r, n)."""
        dimension = self._dimension
        every = places[:, :, None] * dimension + np.arange(dimension)
        return np.asarray(every.reshape(len(places), places.shape[1] * dimension))

    def _spread(self, points: IntArray, forces: FloatArray) -> tuple[IntArray, IntArray, FloatArray]:
        """Return the pairs of samples and these points (r,), the point of each pair,
        and its part of the forces (r, ...).
        """
        place = np.full(len(self.nodes), -1)
        place[points] = np.arange(len(points))
        pairs = np.flatnonzero(place[self._point_of] >= 0)
        of_point = place[self._point_of[pairs]]
        return pairs, of_point, (self._weight_of[pairs] * forces[of_point].T).T

    def _gather(self, pairs: IntArray, of_point: IntArray, values: FloatArray, count: int) -> FloatArray:
        """Sum values (pairs, u, u) by points to (count, U, U)."""
        width, at = self.nodes.shape[1] * self._dimension, self._unknowns(self._places[pairs])
        places = (of_point[:, None, None] * width + at[:, :, None]) * width + at[:, None]
        return _sums(places, values, count * width * width).reshape(count, width, width)

    def _curvature(self, points: IntArray, force: FloatArray) -> FloatArray:
        """Return the derivatives (r, U, U) of the nodal forces that contact forces (r,) on these points cause."""
        pairs, of_point, parts = self._spread(points, force)
        return self._gather(pairs, of_point, self._now.curvature(self._sample_of[pairs], parts), len(points))

    def _turned(self, points: IntArray, force: FloatArray) -> FloatArray:
        """Return the derivatives (r, U, U) of the nodal forces that friction forces (r, d) on these points cause."""
        pairs, of_point, parts = self._spread(points, force)
        return self._gather(pairs, of_point, self._now.swing(self._sample_of[pairs], parts), len(points))

    def slips(self, moved: FloatArray, change: FloatArray, elastic: FloatArray) -> Slips:
        """Compute the slips of the nodes; friction forces are means over the samples."""
        found = self._slip.slips(moved, change, elastic)
        m, n, dimension = *self.nodes.shape, self._dimension
        # (m, n, d, t), then the directions t first
        by, carried = np.zeros((m, n, dimension, dimension)), np.zeros((m, n, dimension, dimension))
        local = found.by.reshape(m, dimension, self._slip.nodes.shape[1], dimension)[self._touching]
        np.add.at(by, (self._touching[:, None], self._slip_places), local.transpose(0, 2, 3, 1))
        along = self._now.carried.reshape(len(self._used), dimension, self._places.shape[1], dimension)
        along = self._weight_of[:, None, None, None] * along[self._sample_of]
        np.add.at(carried, (self._point_of[:, None], self._places), along.transpose(0, 2, 3, 1))
        first = [one.transpose(0, 3, 1, 2).reshape(m, dimension, n * dimension) for one in (by, carried)]
        return Slips(found.value, first[0], first[1], self._turned, found.axes)

    def commit(self) -> None:
        """Store the present normals as those at the start of the next increment."""
        self._slip.commit()

    def kept(self) -> Saved:
        """Return the state to be saved: that of the slips, and the links."""
        return {"slip": self._slip.kept(), "linked": self._linked}

    def resume(self, saved: Saved) -> None:
        """Restore the state that `kept` returned."""
        self._slip.resume(saved["slip"])
        self._linked, self._sampled = saved["linked"], None


def _sums(places: IntArray, values: FloatArray, count: int) -> FloatArray:
    """Sum values at places of the same shape to (count,)."""
    return np.bincount(places.ravel(), values.ravel(), count).astype(np.float64)


def _square() -> tuple[FloatArray, float]:
    """Return places and area of samples of a square from -1 to 1."""
    middles = (2.0 * np.arange(ALONG) + 1.0) / ALONG - 1.0
    x, y = np.meshgrid(middles, middles)
    return np.stack([x.ravel(), y.ravel()], axis=1), 4.0 / ALONG**2


def _triangle() -> tuple[FloatArray, float]:
    """Return places and area of samples of a triangle with sides of one: one sample in each of equal triangles."""
    x, y = np.meshgrid(np.arange(ALONG), np.arange(ALONG))
    upward = np.stack([x, y], axis=-1)[x + y < ALONG] + 1 / 3
    downward = np.stack([x, y], axis=-1)[x + y < ALONG - 1] + 2 / 3
    return np.concatenate([upward, downward]) / ALONG, 0.5 / ALONG**2


_SQUARE: Final = _square()
_TRIANGLE: Final = _triangle()
