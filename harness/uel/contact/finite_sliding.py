# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Motion of contact points in finite sliding: over the current main surface, from one piece to the next.

The foot point X of a node x is its closest point projection on the surface: x - X = g n, so that dg = n W du with the
motion W du of the node relative to the foot point; fortran/host/contact/derivatives.f90 has the derivatives of foot
point and normal. The weights of forces on the nodes of the piece differ from W where the surface is smoothed. The slip
of an increment is the motion of the node relative to its final foot point. It is computed in the configuration at the
start of the increment, where the elastic slip rotates with the normal, and is convected with the surface: bodies that
move together do not slip.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uel.contact.face_surface import FaceSurface
from uel.contact.kinematics import Clearances, Slips
from uel.contact.main_surface import EQUAL, Surface, SurfacePoints
from uel.contact.rigid_surface import RigidSurface
from uel.elements.contributor import Find
from uel.model.arrays import FloatArray, IntArray
from uel.model.contact import RigidProfile, SlidingPair
from uel.model.restart import Saved
from uel.usersub import _contact
from uel.usersub.exchange import Int32Array


@dataclass(frozen=True, slots=True)
class Projection:
    """Projections of p points onto the main surface, with derivatives by the unknowns (u) of both.

    foot             foot points
    value            (p,) clearances
    gradient         (p, u) of the clearances
    tangents_by      (p, a, d, u) derivatives of the tangents
    conjugate        (p, d, u) motions conjugate to forces
    conjugate_along  (p, a, d, u) their derivatives along the surface, apart from the sign
    conjugate_by     (p, d, u, u) their derivatives by the unknowns, apart from the sign; None: zero
    natural_by       (p, a, u) derivatives of the natural coordinates
    tilt             (p, a, u) components along the tangents of the derivatives of the normals, apart from the sign
    """

    foot: SurfacePoints
    value: FloatArray
    gradient: FloatArray
    tangents_by: FloatArray
    conjugate: FloatArray
    conjugate_along: FloatArray
    conjugate_by: FloatArray | None
    natural_by: FloatArray
    tilt: FloatArray

    def stiffness(self, points: IntArray, normal: FloatArray, friction: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return factors (r, k, u) whose products are the derivatives of nodal forces, see `Motion.add_stiffness`.

        The motions may be any here; fortran/host/contact/samples.f90 does the same with shares of nodes.
        """
        force = normal[:, None] * self.foot.normal[points] - friction
        turned = normal[:, None, None] * self.foot.tangents[points]
        left = [
            np.einsum("md,madu->mau", force, self.conjugate_along[points]),
            np.einsum("mad,mdu->mau", turned, self.conjugate[points]),
        ]
        right = [self.natural_by[points], self.tilt[points]]
        if self.conjugate_by is not None:
            left.append(np.einsum("md,mduv->mvu", force, self.conjugate_by[points]))
            right.append(np.broadcast_to(np.eye(left[-1].shape[2]), left[-1].shape))
        return np.concatenate(left, axis=1), np.concatenate(right, axis=1)


class ProjectedPoints:
    """Points of a secondary surface and their projections onto the main surface.

    surface  the main surface
    piece, natural, above  of each point, as `Surface.track` returns them
    """

    def __init__(self, surface: Surface, coordinates: FloatArray, nodes: IntArray, shapes: FloatArray) -> None:
        """Prepare points with nodes (p, k) and shape functions (p, k); coordinates: (n, d) of all nodes."""
        self.surface, self.shapes = surface, shapes
        self._coordinates, self._nodes = coordinates, nodes
        count, dimension = len(nodes), coordinates.shape[1]
        self.piece, self.natural = np.zeros(count, dtype=np.int64), np.zeros((count, dimension - 1))
        self.above = np.zeros(count, dtype=np.bool_)

    def points(self, u: FloatArray) -> FloatArray:
        """Return (p, d) current coordinates of the points at displacements (n, dofs)."""
        dimension = self._coordinates.shape[1]
        positions = self._coordinates[self._nodes] + u[self._nodes, :dimension]
        return np.asarray(np.einsum("pk,pkd->pd", self.shapes, positions))

    def search(self, u: FloatArray, outward: FloatArray, *, everywhere: bool) -> None:
        """Project the points; outward: (p, d) outward normals at the points."""
        points = self.points(u)
        self.piece, self.natural, self.above = self.surface.track(points, outward, u, self.piece, everywhere=everywhere)

    def nodes_of(self) -> IntArray:
        """Return (p, k + l) nodes of the points and of their pieces."""
        return np.concatenate([self._nodes, self.surface.nodes_of(self.piece)], axis=1)

    def foot(self, u: FloatArray) -> SurfacePoints:
        """Return the foot points."""
        return self.surface.at(self.piece, self.natural, u)

    def values(self, u: FloatArray) -> FloatArray:
        """Return the clearances; for points beside the surface the distances."""
        foot = self.foot(u)
        gap = self.points(u) - foot.at
        along = np.einsum("md,md->m", gap, foot.normal)
        return np.asarray(np.where(self.above, along, np.linalg.norm(gap, axis=1)))

    def project(self, u: FloatArray) -> Projection:
        """Return the projections with derivatives."""
        arguments = self.piece, self.natural, u
        foot = self.surface.at(*arguments)
        at, tangents = self.surface.by_unknowns(*arguments)
        loaded, conjugate_along, conjugate_by = self.surface.loaded(*arguments)
        m, dimension, _ = at.shape
        own = np.einsum("pk,de->pdke", self.shapes, np.eye(dimension))
        own = own.reshape(m, dimension, own.shape[2] * dimension)
        first = own.shape[2]
        relative = np.concatenate([own, -at], axis=2)
        zeros = np.zeros((m, dimension - 1, *own.shape[1:]))
        tangents_by = np.concatenate([zeros, tangents], axis=3)
        value = self.values(u)
        along = np.einsum("mad,mdu->mau", foot.tangents, relative)
        across = np.einsum("md,madu->mau", foot.normal, tangents_by)
        gap = np.where(self.above, value, 0.0)
        if conjugate_by is not None:
            conjugate_by = np.pad(conjugate_by, ((0, 0), (0, 0), (first, 0), (first, 0)))
        return Projection(
            foot,
            value,
            np.einsum("md,mdu->mu", foot.normal, relative),
            tangents_by,
            np.concatenate([own, -loaded], axis=2),
            np.concatenate([zeros, conjugate_along], axis=3),
            conjugate_by,
            *_contact.derivatives(foot.tangents, foot.second, gap, along, across),
        )


class FiniteSliding:
    """Points of a node-to-surface pair in finite sliding."""

    def __init__(self, pair: SlidingPair, coordinates: FloatArray, facing: float = EQUAL) -> None:
        """Prepare the points; coordinates (nodes, 3) are those of all nodes of the model; facing: as in
        `FaceSurface`.
        """
        dimension, m = pair.dimension, len(pair.secondary)
        self._pair, self._dimension = pair, dimension
        self._coordinates = coordinates[:, :dimension]
        self.surface: Surface
        if isinstance(pair.main, RigidProfile):
            self.surface = RigidSurface(pair.main, self._coordinates)
        else:
            self.surface = FaceSurface(pair.main, self._coordinates, facing)
        self._projected = ProjectedPoints(self.surface, self._coordinates, pair.secondary[:, None], np.ones((m, 1)))
        self._unknowns = tuple((0, dof) for dof in range(1, dimension + 1)) + self.surface.unknowns
        self.components, self.areas = dimension, pair.areas
        self.numbers = np.zeros((0, 0), dtype=np.int64)
        zero = np.zeros((len(coordinates), len(self.surface.dofs)))
        self._moved = self._moved_before = zero
        self._outward = self._secondary_normals(zero)
        self._projected.search(zero, self._outward, everywhere=True)
        self._reachable = self._projected.piece
        self.nodes = self._projected.nodes_of()
        start, size = self._projected.values(zero), self.surface.sizes(self._projected.piece, zero)
        self._clearance = np.where(np.abs(start) <= EQUAL * size, 0.0, start)
        self._normal = self._normal_before = self._projected.foot(zero).normal

    @property
    def above(self) -> NDArray[np.bool_]:
        """Mask (m,) of the points that face the main surface."""
        return self._projected.above

    @property
    def slip_nodes(self) -> IntArray:
        """Nodes (m, k) on which the slip of each point depends: all of its nodes."""
        return self.nodes

    def unknowns_of(self, count: int) -> tuple[tuple[int, int], ...]:
        """Return the unknowns of a point: those of the secondary node and of the main surface."""
        del count
        return self._unknowns

    def _secondary_normals(self, u: FloatArray) -> FloatArray:
        """Return (m, d) mean unit normals of the faces of the secondary nodes; zero for a surface of nodes."""
        positions = (self._coordinates + u[:, : self._dimension])[self._pair.secondary]
        sums = np.zeros_like(positions)
        for faces in self._pair.faces:
            normals = normals_of(positions[faces])
            for nodes in faces.T:
                np.add.at(sums, nodes, normals)
        return unit(sums)

    def start(self) -> FloatArray:
        """Return (m,) clearances before the analysis, 0 if they differ from 0 by rounding alone."""
        return self._clearance

    @property
    def foot_coordinates(self) -> tuple[IntArray, FloatArray]:
        """Pieces (m,) of the foot points, and their natural coordinates (m, a)."""
        return self._projected.piece, self._projected.natural

    @property
    def start_normals(self) -> FloatArray:
        """Outward normals (m, d) of the main surface at the foot points, before the analysis."""
        return self._normal

    def track(self, u: FloatArray, du: FloatArray, find: Find, *, first: bool) -> None:
        """Project the points: in the first pass of an increment onto the entire surface, then near the current
        pieces.
        """
        if not self.numbers.size:
            self.numbers = find(np.arange(len(self._coordinates))[:, None], np.array(self.surface.dofs))
        self._moved, self._moved_before = (np.append(values, 0.0)[self.numbers] for values in (u, u - du))
        if first:
            self._outward = self._secondary_normals(self._moved)
        piece = self._projected.piece
        self._projected.search(self._moved, self._outward, everywhere=first)
        if not np.array_equal(piece, self._projected.piece):
            self.nodes = self._projected.nodes_of()

    @property
    def moved(self) -> FloatArray:
        """Displacements (nodes, dofs) of all nodes at the last `track`."""
        return self._moved

    @property
    def known(self) -> bool:
        """Whether `links` has the nodes of the current pieces."""
        ring = self.surface.ring_of(self._reachable)
        return bool((ring == self._projected.piece[:, None]).any(axis=1).all())

    def reach(self) -> None:
        """Update `links` to the current pieces."""
        self._reachable = self._projected.piece

    def links(self) -> tuple[IntArray, IntArray]:
        """Return points with the nodes of their pieces at the last `reach`, and of neighbouring pieces."""
        ring = self.surface.ring_of(self._reachable)
        m, count = ring.shape
        nodes = self.surface.nodes_of(ring.ravel())
        return np.repeat(np.arange(m), count), np.concatenate(
            [np.repeat(self._pair.secondary, count)[:, None], nodes], axis=1
        )

    def clearances(self, u: FloatArray, *, nlgeom: bool) -> Clearances:
        """Compute the clearances to the current surface, with or without NLGEOM."""
        del u, nlgeom
        self._now = now = self._projected.project(self._moved)
        self._normal = normal = now.foot.normal
        conjugate = np.einsum("md,mdu->mu", normal, now.conjugate)
        rounding = rounding_of(self._coordinates, self._moved)
        return Clearances(now.value, now.gradient, conjugate, rounding)

    def slips(self, u: FloatArray, change: FloatArray, elastic: FloatArray) -> Slips:
        """Compute the slips in the current tangent plane, in global components, after `clearances`."""
        del u, change
        now = self._now
        foot, natural_by = now.foot, now.natural_by
        then = self._projected.foot(self._moved_before)
        # on the surface at the start, with derivatives by the natural coordinates
        normal, before, metric = then.normal, self._normal_before, then.metric
        tilt = np.linalg.solve(metric, np.einsum("md,mabd->mab", normal, then.second))
        tilt = -np.einsum("mab,mad->mbd", tilt, then.tangents)
        gap = self._projected.points(self._moved_before) - then.at
        height, height_by = np.einsum("md,md->m", gap, normal), np.einsum("md,mad->ma", gap, tilt)
        sum_ = before + normal
        cosine = np.maximum(1.0 + np.einsum("md,md->m", before, normal), EQUAL)
        shift = np.einsum("md,md->m", elastic, normal) / cosine
        shift_by = np.einsum("mad,md->ma", tilt, elastic - shift[:, None] * before) / cosine[:, None]
        slip = elastic - shift[:, None] * sum_ - gap + height[:, None] * normal
        slip_by = (height - shift)[:, None, None] * tilt + then.tangents
        slip_by += height_by[:, :, None] * normal[:, None] - shift_by[:, :, None] * sum_[:, None]
        # its components along the tangents are convected with the surface
        components = np.linalg.solve(metric, np.einsum("mad,md->ma", then.tangents, slip)[..., None])[..., 0]
        slip_by -= np.einsum("ma,mabd->mbd", components, then.second)
        components_by = np.linalg.solve(metric, np.einsum("mad,mbd->mab", then.tangents, slip_by))
        value = np.einsum("ma,mad->md", components, foot.tangents)
        by = np.einsum("mad,mab,mbu->mdu", foot.tangents, components_by, natural_by)
        by += np.einsum("ma,madu->mdu", components, now.tangents_by)
        by += np.einsum("ma,mabd,mbu->mdu", components, foot.second, natural_by)
        return Slips(value, by, now.conjugate, _axes(foot))

    def add_stiffness(
        self,
        points: IntArray,
        normal: FloatArray,
        friction: FloatArray,
        equations: Int32Array,
        matrix: _contact.SparseValues,
    ) -> None:
        """Add the derivatives of the nodal forces, see `Motion.add_stiffness`."""
        left, right = self._now.stiffness(points, normal, friction)
        _contact.add_products(left, equations, right, equations, matrix)

    def commit(self) -> None:
        """Commit the normals at the end of a converged increment."""
        self._normal_before = self._normal

    def kept(self) -> Saved:
        """Return the state to be saved: pieces and normals."""
        return {"piece": self._projected.piece, "reachable": self._reachable, "normal": self._normal_before}

    def resume(self, saved: Saved) -> None:
        """Restore the state that `kept` returned."""
        self._projected.piece, self._reachable, self._normal_before = (
            saved["piece"],
            saved["reachable"],
            saved["normal"],
        )
        self.nodes = self._projected.nodes_of()


def _axes(foot: SurfacePoints) -> FloatArray:
    """Return (m, directions, d) unit vectors along the first tangent and, in space, across it."""
    first = foot.tangents[:, 0]
    first = first / np.linalg.norm(first, axis=1)[:, None]
    if first.shape[1] == 2:
        return np.asarray(first[:, None])
    return np.stack([first, np.cross(foot.normal, first)], axis=1)


def normals_of(corners: FloatArray) -> FloatArray:
    """Return (f, d) normals of faces by their corners (f, k, d), not of length one."""
    first = corners[:, 1] - corners[:, 0]
    if corners.shape[2] == 2:
        return np.stack([first[:, 1], -first[:, 0]], axis=1)
    return np.cross(corners[:, 2] - corners[:, 0], corners[:, -1] - corners[:, 1])


def unit(vectors: FloatArray) -> FloatArray:
    """Return vectors (m, d) scaled to length one; zero ones stay zero."""
    length = np.linalg.norm(vectors, axis=1)[:, None]
    return np.asarray(vectors / np.where(length > 0.0, length, 1.0))


def rounding_of(coordinates: FloatArray, u: FloatArray) -> float:
    """Return the rounding error of coordinates (n, d) at displacements (n, dofs)."""
    positions = coordinates + u[:, : coordinates.shape[1]]
    return float(np.finfo(float).eps * np.abs(positions).max())
