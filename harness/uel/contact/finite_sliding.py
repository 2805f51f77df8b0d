# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Motion of contact points in finite sliding: over a main surface, in its present place, from one piece to the next.

The point opposite a node x is the nearest one X of the surface: x - X = g n. With W the motion of the node against that
point of the main surface, tau the tangents, and G = d tau / du at fixed natural coordinates xi,

    dg = n W du,    (tau_a tau_b - g n tau_ab) dxi_b = tau_a W du + g n G_a du,
    dn = -tau^a (n G_a du + n tau_ab dxi_b)

(P. Wriggers, Computational Contact Mechanics, 2nd edition (2006), chapter 4). Forces go to the nodes of the piece by
shares of their own, which differ from W where the surface is smoothed. The slip of an increment is the motion of the
node against the point of the main surface that is opposite it at the end. It is taken in the place of both at the start
of the increment, together with the elastic slip, which turns there with the normal, and goes with the surface to its
present place: bodies that move together do not slip.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uel.contact.face_surface import FaceSurface
from uel.contact.kinematics import Clearances, Slips
from uel.contact.main_surface import EQUAL, Place, Surface
from uel.contact.rigid_surface import RigidSurface
from uel.elements.contributor import Find
from uel.model.arrays import FloatArray, IntArray
from uel.model.contact import Pieces, RigidProfile, SlidingPair
from uel.model.restart import Saved


@dataclass(frozen=True, slots=True)
class Opposition:
    """Places of p points and of the main surface opposite them, with derivatives by the unknowns (u) of both.

    place    of the main surface opposite the points
    value    (p,) clearances
    against  (p, d, u) motions of the points against the main surface at fixed natural coordinates
    turning  (p, a, d, u) derivatives of the tangents
    carried  (p, d, u) motions along which forces do work
    sliding  (p, a, d, u) their derivatives along the surface, apart from the sign
    twice    (p, d, u, u) their derivatives by the unknowns, apart from the sign; None: zero
    glide    (p, a, u) derivatives of the natural coordinates
    """

    place: Place
    value: FloatArray
    against: FloatArray
    turning: FloatArray
    carried: FloatArray
    sliding: FloatArray
    twice: FloatArray | None
    glide: FloatArray

    @property
    def gradient(self) -> FloatArray:
        """Gradients (p, u) of the clearances."""
        return np.asarray(np.einsum("md,mdu->mu", self.place.normal, self.against))

    def swing(self, points: IntArray, forces: FloatArray) -> FloatArray:
        """Return the derivatives (r, u, u) of the nodal forces that forces (r, d) on these points (r,) cause."""
        pulled = np.einsum("md,madu->mau", forces, self.sliding[points])
        found = -np.einsum("mau,mav->muv", pulled, self.glide[points])
        if self.twice is not None:
            found -= np.einsum("md,mduv->muv", forces, self.twice[points])
        return np.asarray(found)

    def curvature(self, points: IntArray, force: FloatArray) -> FloatArray:
        """Return the derivatives (r, u, u) for contact forces (r,), which turn with the normals."""
        place = self.place.take(points)
        across = np.einsum("md,madu->mau", place.normal, self.turning[points])
        bent = np.einsum("md,mabd->mab", place.normal, place.second)
        tilt = np.linalg.solve(place.metric, across + np.einsum("mab,mbu->mau", bent, self.glide[points]))
        tilted = np.einsum("mad,mau->mdu", place.tangents, tilt)
        along = np.einsum("mdu,mdv->muv", self.carried[points], tilted)
        return np.asarray(self.swing(points, force[:, None] * place.normal) - force[:, None, None] * along)


class Opposites:
    """Points of a secondary surface, each with the piece of the main surface that is opposite it.

    surface  the main surface
    piece, natural, above  of each point, as `Surface.track` returns them
    """

    def __init__(
        self, main: Pieces | RigidProfile, coordinates: FloatArray, nodes: IntArray, shapes: FloatArray, facing: float
    ) -> None:
        """Prepare points that are sums of nodes (p, k) times shapes (p, k).

        Parameters
        ----------
        main
            The main surface.
        coordinates
            (n, d) of all nodes of the model.
        nodes, shapes
            Of the points.
        facing
            Largest cosine of the angle between the normals of a point and of a piece opposite it.
        """
        self.surface: Surface
        if isinstance(main, RigidProfile):
            self.surface = RigidSurface(main, coordinates)
        else:
            self.surface = FaceSurface(main, coordinates, facing)
        self._coordinates, self._nodes, self._shapes = coordinates, nodes, shapes
        count, dimension = len(nodes), coordinates.shape[1]
        self.piece, self.natural = np.zeros(count, dtype=np.int64), np.zeros((count, dimension - 1))
        self.above = np.zeros(count, dtype=np.bool_)

    def points(self, moved: FloatArray) -> FloatArray:
        """Return (p, d) places of the points at displacements (n, dofs)."""
        dimension = self._coordinates.shape[1]
        places = self._coordinates[self._nodes] + moved[self._nodes, :dimension]
        return np.asarray(np.einsum("pk,pkd->pd", self._shapes, places))

    def search(self, moved: FloatArray, looks: FloatArray, *, everywhere: bool) -> None:
        """Find the pieces; looks: outward normals (p, d) at the points."""
        points = self.points(moved)
        self.piece, self.natural, self.above = self.surface.track(
            points, looks, moved, self.piece, everywhere=everywhere
        )

    def nodes_of(self) -> IntArray:
        """Return (p, k + l) nodes of the points and of the pieces opposite them."""
        return np.concatenate([self._nodes, self.surface.nodes_of(self.piece)], axis=1)

    def place(self, moved: FloatArray) -> Place:
        """Return the places opposite the points on the main surface."""
        return self.surface.at(self.piece, self.natural, moved)

    def values(self, moved: FloatArray) -> FloatArray:
        """Return the clearances; those of points beside the surface are distances."""
        place = self.place(moved)
        apart = self.points(moved) - place.at
        along = np.einsum("md,md->m", apart, place.normal)
        return np.asarray(np.where(self.above, along, np.linalg.norm(apart, axis=1)))

    def opposition(self, moved: FloatArray, chosen: IntArray) -> Opposition:
        """Return clearances and derivatives of some points."""
        given = self.piece[chosen], self.natural[chosen], moved
        place = self.surface.at(*given)
        at, tangents = self.surface.by_unknowns(*given)
        loaded, sliding, twice = self.surface.loaded(*given)
        m, dimension, _ = at.shape
        own = np.einsum("pk,de->pdke", self._shapes[chosen], np.eye(dimension))
        own = own.reshape(m, dimension, own.shape[2] * dimension)
        unmoved = np.zeros((m, dimension - 1, *own.shape[1:]))
        against = np.concatenate([own, -at], axis=2)
        turning = np.concatenate([unmoved, tangents], axis=3)
        value, above = self.values(moved)[chosen], self.above[chosen]
        apart = np.where(above, value, 0.0)
        across = np.einsum("md,madu->mau", place.normal, turning)
        bent = np.einsum("md,mabd->mab", place.normal, place.second)
        metric = place.metric
        right = np.einsum("mad,mdu->mau", place.tangents, against) + apart[:, None, None] * across
        curved = metric - apart[:, None, None] * bent
        # many points are opposite a node at the centre of a circle
        many = np.abs(np.linalg.det(curved)) <= EQUAL * np.linalg.det(metric)
        glide = np.linalg.solve(np.where(many[:, None, None], metric, curved), right)
        if twice is not None:
            first = own.shape[2]
            twice = np.pad(twice, ((0, 0), (0, 0), (first, 0), (first, 0)))
        return Opposition(
            place,
            value,
            against,
            turning,
            np.concatenate([own, -loaded], axis=2),
            np.concatenate([unmoved, sliding], axis=3),
            twice,
            glide,
        )


class FiniteSliding:
    """The points of a pair, each with the piece of the main surface that is opposite it."""

    def __init__(self, pair: SlidingPair, coordinates: FloatArray, facing: float = EQUAL) -> None:
        """Prepare the points; coordinates (nodes, 3) are those of all nodes of the model; facing: as in `Opposites`."""
        dimension, m = pair.dimension, len(pair.secondary)
        self._pair, self._dimension = pair, dimension
        self._coordinates = coordinates[:, :dimension]
        self._opposite = Opposites(pair.main, self._coordinates, pair.secondary[:, None], np.ones((m, 1)), facing)
        self._surface = self._opposite.surface
        self._unknowns = tuple((0, dof) for dof in range(1, dimension + 1)) + self._surface.unknowns
        self.components, self.areas = dimension, pair.areas
        self._numbers: IntArray | None = None
        still = np.zeros((len(coordinates), len(self._surface.dofs)))
        self._moved = self._moved_before = still
        self._looks = self._own_normals(still)
        self._opposite.search(still, self._looks, everywhere=True)
        self._reachable = self._opposite.piece
        self.nodes = self._opposite.nodes_of()
        start, size = self._opposite.values(still), self._surface.sizes(self._opposite.piece, still)
        self._clearance = np.where(np.abs(start) <= EQUAL * size, 0.0, start)
        self._normal = self._normal_before = self._opposite.place(still).normal

    @property
    def above(self) -> NDArray[np.bool_]:
        """Mask (m,) of the points that face the main surface."""
        return self._opposite.above

    def unknowns_of(self, count: int) -> tuple[tuple[int, int], ...]:
        """Return the unknowns of a point: those of the secondary node and of the main surface."""
        del count
        return self._unknowns

    def _own_normals(self, moved: FloatArray) -> FloatArray:
        """Return (m, d) mean unit normals of the faces of the secondary nodes; zero for a surface of nodes."""
        places = (self._coordinates + moved[:, : self._dimension])[self._pair.secondary]
        sums = np.zeros_like(places)
        for faces in self._pair.faces:
            normals = normals_of(places[faces])
            for nodes in faces.T:
                np.add.at(sums, nodes, normals)
        return unit(sums)

    def start(self) -> FloatArray:
        """Return (m,) clearances before the analysis, 0 if they differ from 0 by rounding alone."""
        return self._clearance

    @property
    def places(self) -> tuple[IntArray, FloatArray]:
        """Pieces (m,) of the main surface opposite to the points, and natural coordinates (m, a) there."""
        return self._opposite.piece, self._opposite.natural

    @property
    def start_normals(self) -> FloatArray:
        """Outward normals (m, d) of the main surface opposite the points, before the analysis."""
        return self._normal

    def track(self, u: FloatArray, du: FloatArray, find: Find, *, first: bool) -> None:
        """Find the pieces opposite the points: in the first pass of an increment anywhere,
        then from the present ones.
        """
        if self._numbers is None:
            self._numbers = find(np.arange(len(self._coordinates))[:, None], np.array(self._surface.dofs))
        self._moved, self._moved_before = (np.append(values, 0.0)[self._numbers] for values in (u, u - du))
        if first:
            self._looks = self._own_normals(self._moved)
        piece = self._opposite.piece
        self._opposite.search(self._moved, self._looks, everywhere=first)
        if not np.array_equal(piece, self._opposite.piece):
            self.nodes = self._opposite.nodes_of()

    @property
    def moved(self) -> FloatArray:
        """Displacements (nodes, dofs) of all nodes at the last `track`."""
        return self._moved

    @property
    def known(self) -> bool:
        """Whether the pieces are neighbours of those from which `links` starts."""
        ring = self._surface.ring_of(self._reachable)
        return bool((ring == self._opposite.piece[:, None]).any(axis=1).all())

    def reach(self) -> None:
        """Restart `links` from the present pieces."""
        self._reachable = self._opposite.piece

    def links(self) -> tuple[IntArray, IntArray]:
        """Return points with the nodes of their pieces, at the last `reach`, and of the neighbours of these."""
        ring = self._surface.ring_of(self._reachable)
        m, count = ring.shape
        nodes = self._surface.nodes_of(ring.ravel())
        return np.repeat(np.arange(m), count), np.concatenate(
            [np.repeat(self._pair.secondary, count)[:, None], nodes], axis=1
        )

    def clearances(self, moved: FloatArray, *, nlgeom: bool) -> Clearances:
        """Compute the clearances in the present place of the surface, with NLGEOM or without."""
        del moved, nlgeom
        self._now = now = self._opposite.opposition(self._moved, np.arange(len(self.nodes)))
        self._normal = normal = now.place.normal
        pushed = np.einsum("md,mdu->mu", normal, now.carried)
        rounding = rounding_of(self._coordinates, self._moved)
        return Clearances(now.value, now.gradient, pushed, now.curvature, rounding)

    def slips(self, moved: FloatArray, change: FloatArray, elastic: FloatArray) -> Slips:
        """Compute the slips in the present tangent plane, after `clearances`;
        components are those of the global axes.
        """
        del moved, change
        now = self._now
        place, glide = now.place, now.glide
        then = self._opposite.place(self._moved_before)
        # in the place of the surface at the start, with derivatives by the natural coordinates
        normal, before, metric = then.normal, self._normal_before, then.metric
        tilt = np.linalg.solve(metric, np.einsum("md,mabd->mab", normal, then.second))
        tilt = -np.einsum("mab,mad->mbd", tilt, then.tangents)
        apart = self._opposite.points(self._moved_before) - then.at
        height, height_by = np.einsum("md,md->m", apart, normal), np.einsum("md,mad->ma", apart, tilt)
        both = before + normal
        cosine = np.maximum(1.0 + np.einsum("md,md->m", before, normal), EQUAL)
        lean = np.einsum("md,md->m", elastic, normal) / cosine
        lean_by = np.einsum("mad,md->ma", tilt, elastic - lean[:, None] * before) / cosine[:, None]
        slip = elastic - lean[:, None] * both - apart + height[:, None] * normal
        slip_by = (height - lean)[:, None, None] * tilt + then.tangents
        slip_by += height_by[:, :, None] * normal[:, None] - lean_by[:, :, None] * both[:, None]
        # its parts along the tangents go with the surface
        parts = np.linalg.solve(metric, np.einsum("mad,md->ma", then.tangents, slip)[..., None])[..., 0]
        slip_by -= np.einsum("ma,mabd->mbd", parts, then.second)
        parts_by = np.linalg.solve(metric, np.einsum("mad,mbd->mab", then.tangents, slip_by))
        value = np.einsum("ma,mad->md", parts, place.tangents)
        by = np.einsum("mad,mab,mbu->mdu", place.tangents, parts_by, glide)
        by += np.einsum("ma,madu->mdu", parts, now.turning)
        by += np.einsum("ma,mabd,mbu->mdu", parts, place.second, glide)
        return Slips(value, by, now.carried, now.swing, _axes(place))

    def commit(self) -> None:
        """Store the present normals as those at the start of the next increment."""
        self._normal_before = self._normal

    def kept(self) -> Saved:
        """Return the state to be saved: pieces and normals."""
        return {"piece": self._opposite.piece, "reachable": self._reachable, "normal": self._normal_before}

    def resume(self, saved: Saved) -> None:
        """Restore the state that `kept` returned."""
        self._opposite.piece, self._reachable, self._normal_before = saved["piece"], saved["reachable"], saved["normal"]
        self.nodes = self._opposite.nodes_of()


def _axes(place: Place) -> FloatArray:
    """Return (m, directions, d) unit vectors along the first tangent and, in space, across it."""
    first = place.tangents[:, 0]
    first = first / np.linalg.norm(first, axis=1)[:, None]
    if first.shape[1] == 2:
        return np.asarray(first[:, None])
    return np.stack([first, np.cross(place.normal, first)], axis=1)


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


def rounding_of(coordinates: FloatArray, moved: FloatArray) -> float:
    """Return the rounding error of places (n, d) at displacements (n, dofs)."""
    places = coordinates + moved[:, : coordinates.shape[1]]
    return float(np.finfo(float).eps * np.abs(places).max())
