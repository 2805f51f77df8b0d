# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Motion of contact points in surface-to-surface finite sliding: the clearance of a point is a mean over samples.

The clearance of a secondary node is the mean over samples of its faces, weighted by its shape function; forces on both
surfaces have the same weights. The patch test passes where the samples integrate the shape functions of both surfaces:
in the plane, since each increment samples the segments between the projections of main nodes. Weights are those of the
undeformed mesh. Samples are fixed on the secondary surface within an increment, so that derivatives of means are means.

The slip is that of the node, as in `finite_sliding`.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.contact.face_surface import FaceSurface
from uel.contact.finite_sliding import FiniteSliding, ProjectedPoints, normals_of, rounding_of, unit
from uel.contact.geometric_corrections import corrections
from uel.contact.kinematics import Clearances, Slips, displacements
from uel.contact.main_surface import EQUAL
from uel.contact.shape_functions import weights_of
from uel.elements.contributor import Find
from uel.model.arrays import FloatArray, IntArray, flat_rows
from uel.model.contact import Pieces, SurfacePair
from uel.model.restart import Saved
from uel.usersub import _contact
from uel.usersub.exchange import Int32Array

FACING: Final = 0.5
"""Cosine of the largest angle, 60 degrees, between normals of adjacent smooth faces, and of opposite faces."""

ALONG: Final = 4
"""Samples of a face along each direction, in space."""

SLIVER: Final = 0.01
"""Smallest fraction of the area of a node opposite the main surface for contact."""

NEARER: Final = 1e-6
"""Relative difference of distances that is rounding."""

_GAUSS: Final = np.polynomial.legendre.leggauss(3)
"""Points and weights on a segment, in the plane: exact for products of two shape functions and the clearance."""


class SurfaceSliding:
    """Points of a surface-to-surface pair in finite sliding, with their samples."""

    def __init__(self, pair: SurfacePair, coordinates: FloatArray) -> None:
        """Prepare the surfaces; coordinates (nodes, 3) are those of all nodes of the model."""
        assert isinstance(pair.main, Pieces)
        self._pair, self._main, self._dimension = pair, pair.main, pair.dimension
        self._coordinates = coordinates[:, : pair.dimension]
        self._secondary = FaceSurface(pair.own, self._coordinates)
        self._surface = FaceSurface(pair.main, self._coordinates, -FACING)
        self._slip = FiniteSliding(pair, coordinates, -FACING)
        self.components = pair.dimension
        self._base = len(coordinates) + 1
        self._linked = np.zeros(0, dtype=np.int64)
        self._keys = self._linked
        self.known = False
        self.nodes = pair.secondary[:, None]
        self._moved = np.zeros_like(self._coordinates)
        # displacements at the last sampling
        self._sampled: FloatArray | None = self._moved
        # contact of the samples at the last mean, and nodes of the slips
        self._touched: tuple[NDArray[np.bool_], IntArray, IntArray] | None = None
        if pair.dimension == 3:
            self._place(*self._in_space())
        self._sample()
        self.reach()
        start, size = self._clearances, self._secondary.sizes(np.zeros(1, dtype=np.int64), self._moved)[0]
        self._start = np.where(np.abs(start) <= EQUAL * size, 0.0, start)

    @property
    def slip_nodes(self) -> IntArray:
        """Nodes (m, k) on which the slip of each point depends: its own and those of the piece opposite."""
        return self._slip.nodes

    def unknowns_of(self, count: int) -> tuple[tuple[int, int], ...]:
        """Return the displacements of one node after the other."""
        return displacements(count, self._dimension)

    def start(self) -> FloatArray:
        """Return (m,) clearances before the analysis, 0 if they differ from 0 by rounding alone."""
        return self._start

    def at_nodes(self) -> tuple[NDArray[np.bool_], FloatArray, FloatArray]:
        """Return the mask (m,) of points that can touch, and initial clearances (m,) and normals (m, d) at their
        nodes.
        """
        start = self._slip.start() - corrections(
            self._pair.rounded[1], self._main, self._coordinates, self._slip.foot_coordinates
        )
        return self.above & self._slip.above, start, self._slip.start_normals

    def track(self, u: FloatArray, du: FloatArray, find: Find, *, first: bool) -> None:
        """Project the samples; the first pass of an increment chooses new ones."""
        self._slip.track(u, du, find, first=first)
        self._moved = self._slip.moved
        if not first:
            self._projected.search(self._moved, self._outward(), everywhere=False)
            self._gaps = self._projected.values(self._moved)
            self._average()
        elif self._sampled is None or not np.array_equal(self._sampled, self._moved):
            self._sample()
        self._sampled = self._moved if first else None

    def _outward(self) -> FloatArray:
        """Return (q, d) normals of the secondary surface at the samples."""
        positions = self._coordinates + self._moved
        return unit(normals_of(positions[self._pair.own.nodes]))[self._face]

    def _place(self, face: IntArray, natural: FloatArray, part: FloatArray) -> None:
        """Set samples at natural coordinates of faces, with their weights in these."""
        pair, self._face, self._natural = self._pair, face, natural
        shapes = weights_of(pair.own.shapes[face], natural)[0]
        tangents = self._secondary.at(face, natural, np.zeros_like(self._moved)).tangents
        size = tangents[:, 0] if self._dimension == 2 else np.cross(tangents[:, 0], tangents[:, 1])
        area = part * np.linalg.norm(size, axis=1) * np.einsum("qk,qk->q", shapes, pair.depths[face])
        self._areas_of_samples, self._point = area[:, None] * shapes, pair.corners[face]
        self._total = _sums(self._point, self._areas_of_samples, len(pair.secondary))
        self._projected = ProjectedPoints(self._surface, self._coordinates, pair.own.nodes[face], shapes)

    def _sample(self) -> None:
        """Choose samples, and project them."""
        if self._dimension == 2:
            self._place(*self._in_plane())
        self._touched, projected, pair = None, self._projected, self._pair
        points = projected.points(self._moved)
        near, before = self._surface.near(points, self._moved), np.zeros(len(points), dtype=np.int64)
        hits = self._surface.search(points, self._outward(), self._moved, before, near)
        projected.piece, projected.natural, projected.above = hits.piece, hits.natural, hits.above
        self._gaps = projected.values(self._moved)
        self._unobstructed = self._find_unobstructed(points, near)
        sides = (pair.own, (self._face, self._natural)), (self._main, (projected.piece, projected.natural))
        self._outside = sum(
            corrections(rounded, pieces, self._coordinates, points)
            for rounded, (pieces, points) in zip(pair.rounded, sides, strict=True)
            if rounded
        )
        self._average()

    def _find_unobstructed(self, points: FloatArray, near: IntArray) -> NDArray[np.bool_]:
        """Return the mask (q,) of samples that face their pieces without obstruction: a penetrating sample is in the
        body of its piece, no other piece is nearer, and it is not at the far side of its own body.

        Arguments are coordinates (q, d) of the samples, and pieces (q, c) near them.
        """
        unobstructed = self._gaps >= -self._pair.deepest[self._face]
        behind = np.flatnonzero(unobstructed & (self._gaps < 0.0) & self._projected.above)
        if len(behind):
            nearest = self._surface.distances(points[behind], self._moved, near[behind])
            unobstructed[behind] = nearest >= -self._gaps[behind] * (1.0 - NEARER)
        return unobstructed

    def _in_plane(self) -> tuple[IntArray, FloatArray, FloatArray]:
        """Return faces, natural coordinates, and weights (in natural coordinates) of samples in the plane."""
        count = len(self._pair.own.nodes)
        cutting = np.unique(self._main.nodes)
        positions = self._coordinates[cutting] + self._moved[cutting]
        before = np.zeros(len(cutting), dtype=np.int64)
        outward = np.zeros_like(positions)
        piece, natural, _ = self._secondary.track(positions, outward, self._moved, before, everywhere=True)
        inside = np.abs(natural[:, 0]) < 1.0 - EQUAL
        faces = np.arange(count)
        face = np.concatenate([faces, faces, piece[inside]])
        xi = np.concatenate([np.full(count, -1.0), np.ones(count), natural[inside, 0]])
        order = np.lexsort((xi, face))
        face, xi = face[order], xi[order]
        start = np.flatnonzero((face[1:] == face[:-1]) & (xi[1:] - xi[:-1] > EQUAL))
        middle, half = 0.5 * (xi[start + 1] + xi[start]), 0.5 * (xi[start + 1] - xi[start])
        points = (middle[:, None] + half[:, None] * _GAUSS[0]).reshape(-1, 1)
        return np.repeat(face[start], 3), points, (half[:, None] * _GAUSS[1]).ravel()

    def _in_space(self) -> tuple[IntArray, FloatArray, FloatArray]:
        """Return the same as `_in_plane` in space: the samples are the centroids of equal parts."""
        four = np.isinf(self._pair.own.total)
        faces, points, parts = [], [], []
        for chosen, (natural, part) in ((np.flatnonzero(four), _SQUARE), (np.flatnonzero(~four), _TRIANGLE)):
            faces.append(np.repeat(chosen, len(natural)))
            points.append(np.tile(natural, (len(chosen), 1)))
            parts.append(np.full(len(faces[-1]), part))
        return np.concatenate(faces), np.concatenate(points), np.concatenate(parts)

    def _average(self) -> None:
        """Compute clearances and areas of the points, and the weights of the samples in them."""
        projected = self._projected
        here = projected.above & self._unobstructed
        touched = here, projected.piece, self._slip.nodes
        if self._touched is None or not all(map(np.array_equal, self._touched, touched)):
            self._touched = touched
            self._weigh(here)
        values = self._gaps - self._outside
        distances = np.where(here, values, np.abs(values))
        self._clearances = _sums(self._point, self._weights * distances[:, None], len(self._pair.secondary))

    def _weigh(self, here: NDArray[np.bool_]) -> None:
        """Compute the weights of the samples in the points: of those in the mask (q,) where they suffice."""
        m, weights, point = len(self._pair.secondary), self._areas_of_samples, self._point
        area = _sums(point, weights * here[:, None], m)
        self.above: NDArray[np.bool_] = area > SLIVER * self._total
        # without contact: the mean distance of all samples
        weights = np.where(self.above[point], weights * here[:, None], weights)
        self.areas = _sums(point, weights, m)
        self._weights = weights / self.areas[point]
        self._find_nodes()

    def _find_nodes(self) -> None:
        """Set the nodes of each point, which are those of its groups of samples and of its slip, and the positions of
        the former among them.

        Pairs of a sample and a point have a nonzero weight; a point without contact has its own node only.
        """
        pair, above = self._pair, self.above
        self._sample_of, corner = np.nonzero((self._weights > 0.0) & above[self._point])
        self._point_of, self._weight_of = self._point[self._sample_of, corner], self._weights[self._sample_of, corner]
        group = self._find_groups()
        self._corner_of = group[self._sample_of] * self._point.shape[1] + corner
        self._corners, touching = pair.corners[self._face[self._first_of_groups]], np.flatnonzero(above)
        own = np.arange(len(pair.secondary)) * self._base
        of_groups = self._key(self._corners[:, :, None], self._nodes_of_groups[:, None])
        of_slips = self._key(touching[:, None], self._slip.nodes[touching])
        keys = _distinct(own, of_groups[above[self._corners]], of_slips)
        if not np.array_equal(keys, self._keys):
            self._keys = keys
            self.nodes = self._rows(keys)[1]
            self.known = self._find_known()
        positions = np.searchsorted(keys, of_groups) - np.searchsorted(keys, own)[self._corners][:, :, None]
        self._positions = positions.reshape(-1, of_groups.shape[2])

    def _find_groups(self) -> IntArray:
        """Set the groups of samples with the same face and piece; return the group (q,) of each sample in a pair."""
        piece, group = self._projected.piece, np.zeros(len(self._face), dtype=np.int64)
        used = np.flatnonzero(np.bincount(self._sample_of, minlength=len(piece)))
        keys = self._face[used] * len(self._main.nodes) + piece[used]
        self._used, keys = used[np.argsort(keys, kind="stable")], np.sort(keys)
        starts = np.diff(keys, prepend=-1) > 0
        group[self._used] = np.cumsum(starts) - 1
        self._starts = np.append(np.flatnonzero(starts), len(keys))
        self._first_of_groups = self._used[self._starts[:-1]]
        self._nodes_of_groups = self._projected.nodes_of()[self._first_of_groups]
        return group

    def _key(self, point: IntArray, nodes: IntArray) -> IntArray:
        """Return a unique number for a point and a node, smallest for its own node."""
        own_node = nodes == self._pair.secondary[point]
        return np.asarray(point * self._base + np.where(own_node, 0, nodes + 1))

    def _rows(self, keys: IntArray) -> tuple[IntArray, IntArray]:
        """Return the points in sorted keys, and the nodes of each, padded with its own node."""
        point, node = keys // self._base, keys % self._base - 1
        points, first, counts = np.unique(point, return_index=True, return_counts=True)
        rows = np.repeat(self._pair.secondary[points][:, None], max(int(counts.max(initial=1)), 1), axis=1)
        inside = np.repeat(np.arange(len(points)), counts), np.arange(len(keys)) - np.repeat(first, counts)
        rows[inside] = np.where(node < 0, self._pair.secondary[point], node)
        return points, rows

    def _find_known(self) -> bool:
        return bool(np.isin(self._keys, self._linked).all())

    def reach(self) -> None:
        """Update `links` to the current nodes of each point, and those of neighbouring pieces."""
        self._slip.reach()
        surface, pieces = self._surface, self._projected.piece[self._first_of_groups]
        ring = surface.ring_of(pieces)
        nodes = surface.nodes_of(ring.ravel())
        around = self._key(self._corners[:, :, None], nodes.reshape(len(pieces), 1, ring.shape[1] * nodes.shape[1]))
        point, beside = self._slip.links()
        near = self.above[point]
        of_slips = self._key(point[near, None], beside[near])
        self._linked = _distinct(self._keys, around[self.above[self._corners]], of_slips)
        self.known = True

    def links(self) -> tuple[IntArray, IntArray]:
        """Return points and their nodes, at the last `reach`."""
        return self._rows(self._linked)

    def clearances(self, u: FloatArray, *, nlgeom: bool) -> Clearances:
        """Compute the clearances to the current surface, with or without NLGEOM."""
        self._slip.clearances(u, nlgeom=nlgeom)
        projected = self._projected
        samples = _contact.Samples(projected.shapes, projected.piece, projected.natural)
        pairs = self._sample_of, self._point_of, self._weight_of, self._corner_of
        gradients, self._shares = _contact.means(
            self._main, self._coordinates + self._moved, samples, pairs, self._positions, self.nodes.shape
        )
        gradient = flat_rows(gradients)
        rounding = rounding_of(self._coordinates, self._moved)
        return Clearances(self._clearances, gradient, gradient, rounding)

    def add_stiffness(
        self,
        points: IntArray,
        normal: FloatArray,
        friction: FloatArray,
        equations: Int32Array,
        matrix: _contact.SparseValues,
    ) -> None:
        """Add the derivatives of the nodal forces, see `Motion.add_stiffness`."""
        del equations
        forces = np.zeros((len(self.nodes), 1 + self._dimension))
        forces[points, 0], forces[points, 1:] = normal, friction
        q, used, projected = len(self._face), self._used, self._projected
        of_pairs = self._weight_of[:, None] * forces[self._point_of]
        of_samples = np.stack([_sums(self._sample_of, values, q) for values in of_pairs.T], axis=1)[used]
        samples = _contact.Samples(projected.shapes[used], projected.piece[used], projected.natural[used])
        unknowns = flat_rows(self._slip.numbers[self._nodes_of_groups]).astype(np.int32)
        _contact.add_stiffness(
            self._main,
            self._coordinates + self._moved,
            samples,
            (self._gaps[used], of_samples[:, 0], of_samples[:, 1:]),
            (self._starts, unknowns),
            matrix,
        )

    def slips(self, u: FloatArray, change: FloatArray, elastic: FloatArray) -> Slips:
        """Compute the slips of the nodes; friction forces are means over the samples."""
        slips = self._slip.slips(u, change, elastic)
        m, n, dimension = *self.nodes.shape, self._dimension
        conjugate = np.einsum("mn,td->mtnd", self._shares, np.eye(dimension)).reshape(m, dimension, n * dimension)
        return replace(slips, conjugate=conjugate)

    def commit(self) -> None:
        """Commit the slips at the end of a converged increment."""
        self._slip.commit()

    def kept(self) -> Saved:
        """Return the state to be saved: that of the slips, and the links."""
        return {"slip": self._slip.kept(), "linked": self._linked}

    def resume(self, saved: Saved) -> None:
        """Restore the state that `kept` returned."""
        self._slip.resume(saved["slip"])
        self._linked, self._sampled = saved["linked"], None
        self.known = self._find_known()


def _distinct(*keys: IntArray) -> IntArray:
    """Return the distinct ones of keys that are at least 0, in ascending order."""
    ordered = np.sort(np.concatenate([values.ravel() for values in keys]))
    return ordered[np.diff(ordered, prepend=-1) > 0]


def _sums(positions: IntArray, values: FloatArray, count: int) -> FloatArray:
    """Sum values at positions of the same shape to (count,)."""
    return np.bincount(positions.ravel(), values.ravel(), count).astype(np.float64)


def square_samples(along: int) -> tuple[FloatArray, float]:
    """Return natural coordinates and area of the centroids of along^2 parts of the square from -1 to 1."""
    middles = (2.0 * np.arange(along) + 1.0) / along - 1.0
    x, y = np.meshgrid(middles, middles)
    return np.stack([x.ravel(), y.ravel()], axis=1), 4.0 / along**2


def triangle_samples(along: int) -> tuple[FloatArray, float]:
    """Return natural coordinates and area of the centroids of along^2 parts of the unit triangle."""
    x, y = np.meshgrid(np.arange(along), np.arange(along))
    upward = np.stack([x, y], axis=-1)[x + y < along] + 1 / 3
    downward = np.stack([x, y], axis=-1)[x + y < along - 1] + 2 / 3
    return np.concatenate([upward, downward]) / along, 0.5 / along**2


_SQUARE: Final = square_samples(ALONG)
_TRIANGLE: Final = triangle_samples(ALONG)
