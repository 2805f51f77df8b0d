# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""How contact points move in finite sliding: over a main surface, in its present place, from one piece to the next.

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

import numpy as np
from numpy.typing import NDArray

from harness.elements.contact_kinematics import Clearances, Find, Slips
from harness.elements.contact_surface import EQUAL, FaceSurface, Place, Surface
from harness.elements.rigid_surface import RigidSurface
from harness.model.arrays import FloatArray, IntArray
from harness.model.contact import RigidProfile, SlidingPair
from harness.model.restart import Saved


class FiniteSliding:
    """The points of a pair, each with the piece of the main surface that is opposite it."""

    def __init__(self, pair: SlidingPair, coordinates: FloatArray) -> None:
        """Coordinates (nodes, 3) are those of all nodes of the model."""
        dimension, m = pair.dimension, len(pair.secondary)
        self._pair, self._dimension = pair, dimension
        self._coordinates = coordinates[:, :dimension]
        self._surface: Surface
        if isinstance(pair.main, RigidProfile):
            self._surface = RigidSurface(pair.main, self._coordinates)
        else:
            self._surface = FaceSurface(pair.main, self._coordinates, dimension)
        self.unknowns = tuple((0, dof) for dof in range(1, dimension + 1)) + self._surface.unknowns
        self.components = dimension
        self._numbers: IntArray | None = None
        still = np.zeros((len(coordinates), len(self._surface.dofs)))
        self._moved = self._moved_before = still
        self._looks = self._own_normals(still)
        self._piece, self._natural, self.above = np.zeros(m, dtype=np.int64), np.zeros((m, dimension - 1)), self._none
        self._search(everywhere=True)
        self._reachable = self._piece
        self.nodes = self._nodes_of(self._piece)
        start, size = self._clearances(), self._surface.sizes(self._piece, still)
        self._clearance = np.where(np.abs(start) <= EQUAL * size, 0.0, start)
        self._normal = self._normal_before = self._place().normal

    @property
    def _none(self) -> NDArray[np.bool_]:
        return np.zeros(len(self._pair.secondary), dtype=np.bool_)

    def _nodes_of(self, piece: IntArray) -> IntArray:
        return np.concatenate([self._pair.secondary[:, None], self._surface.nodes_of(piece)], axis=1)

    def _points(self) -> FloatArray:
        secondary = self._pair.secondary
        return np.asarray(self._coordinates[secondary] + self._moved[secondary, : self._dimension])

    def _search(self, *, everywhere: bool) -> None:
        found = self._surface.track(self._points(), self._looks, self._moved, self._piece, everywhere=everywhere)
        self._piece, self._natural, self.above = found

    def _place(self) -> Place:
        return self._surface.at(self._piece, self._natural, self._moved)

    def _clearances(self) -> FloatArray:
        """Those of points beside the surface are distances."""
        place = self._place()
        apart = self._points() - place.at
        along = np.einsum("md,md->m", apart, place.normal)
        return np.asarray(np.where(self.above, along, np.linalg.norm(apart, axis=1)))

    def _own_normals(self, moved: FloatArray) -> FloatArray:
        """(m, d) sums of the normals of the faces of the secondary nodes; zero of a surface of nodes."""
        places = self._coordinates + moved[:, : self._dimension]
        sums = np.zeros_like(places)
        for faces in self._pair.faces:
            corners = places[faces]
            first = corners[:, 1] - corners[:, 0]
            if self._dimension == 2:
                normals = np.stack([first[:, 1], -first[:, 0]], axis=1)
            else:
                normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, -1] - corners[:, 1])
            for nodes in faces.T:
                np.add.at(sums, nodes, normals)
        found = sums[self._pair.secondary]
        length = np.linalg.norm(found, axis=1)[:, None]
        return np.asarray(found / np.where(length > 0.0, length, 1.0))

    def start(self) -> FloatArray:
        """(m,) clearances before the analysis, 0 where rounding alone makes them different from 0."""
        return self._clearance

    @property
    def start_normals(self) -> FloatArray:
        """(m, d) outward normals of the main surface opposite to the points, before the analysis."""
        return self._normal

    def track(self, u: FloatArray, du: FloatArray, find: Find, *, first: bool) -> None:
        """Find the pieces that are opposite: in the first pass of an increment anywhere, then from those so far."""
        if self._numbers is None:
            self._numbers = find(np.arange(len(self._coordinates))[:, None], np.array(self._surface.dofs))
        self._moved, self._moved_before = (np.append(values, 0.0)[self._numbers] for values in (u, u - du))
        if first:
            self._looks = self._own_normals(self._moved)
        piece = self._piece
        self._search(everywhere=first)
        if not np.array_equal(piece, self._piece):
            self.nodes = self._nodes_of(self._piece)

    @property
    def known(self) -> bool:
        """Whether the pieces are neighbours of those from which `links` starts."""
        ring = self._surface.ring_of(self._reachable)
        return bool((ring == self._piece[:, None]).any(axis=1).all())

    def reach(self) -> None:
        """Let `links` start from the present pieces."""
        self._reachable = self._piece

    def links(self) -> tuple[IntArray, IntArray]:
        """Points with the nodes of their pieces, at the last `reach`, and of the neighbours of these."""
        ring = self._surface.ring_of(self._reachable)
        m, count = ring.shape
        nodes = self._surface.nodes_of(ring.ravel())
        return np.repeat(np.arange(m), count), np.concatenate(
            [np.repeat(self._pair.secondary, count)[:, None], nodes], axis=1
        )

    def clearances(self, moved: FloatArray, *, nlgeom: bool) -> Clearances:
        """In the present place of the surface, with NLGEOM or without."""
        del moved, nlgeom
        self._place_now = place = self._place()
        self._normal = normal = place.normal
        given = self._piece, self._natural, self._moved
        at, tangents = self._surface.by_unknowns(*given)
        m, dimension, _ = at.shape
        value = self._clearances()
        own = np.broadcast_to(np.eye(dimension), (m, dimension, dimension))
        against = np.concatenate([own, -at], axis=2)
        unmoved = np.zeros((m, dimension - 1, dimension, dimension))
        self._turning = turning = np.concatenate([unmoved, tangents], axis=3)
        loaded, sliding, turning_too = self._surface.loaded(*given)
        self._carried = carried = np.concatenate([own, -loaded], axis=2)
        apart = np.where(self.above, value, 0.0)
        across = np.einsum("md,madu->mau", normal, turning)
        bent = np.einsum("md,mabd->mab", normal, place.second)
        metric = place.metric
        right = np.einsum("mad,mdu->mau", place.tangents, against) + apart[:, None, None] * across
        curved = metric - apart[:, None, None] * bent
        # many points are opposite a node at the centre of a circle
        many = np.abs(np.linalg.det(curved)) <= EQUAL * np.linalg.det(metric)
        self._glide = glide = np.linalg.solve(np.where(many[:, None, None], metric, curved), right)
        tilt = np.linalg.solve(metric, across + np.einsum("mab,mbu->mau", bent, glide))
        self._tilt = -np.einsum("mad,mau->mdu", place.tangents, tilt)
        # derivatives of the motions that forces follow
        self._carried_by = -np.einsum("madu,mav->mduv", np.concatenate([unmoved, sliding], axis=3), glide)
        if turning_too is not None:
            self._carried_by[:, :, dimension:, dimension:] -= turning_too
        gradient, pushed = (np.einsum("md,mdu->mu", normal, along) for along in (against, carried))
        curvature = np.einsum("mdu,mdv->muv", carried, self._tilt)
        curvature += np.einsum("md,mduv->muv", normal, self._carried_by)
        rounding = float(np.finfo(float).eps * np.abs(self._coordinates + self._moved[:, :dimension]).max())
        return Clearances(value, gradient, pushed, curvature, rounding)

    def slips(self, moved: FloatArray, change: FloatArray, elastic: FloatArray) -> Slips:
        """In the present tangent plane, after `clearances`; components are those of the global axes."""
        del moved, change
        place, glide = self._place_now, self._glide
        then = self._surface.at(self._piece, self._natural, self._moved_before)
        # in the place of the surface at the start, with derivatives by the natural coordinates
        normal, before, metric = then.normal, self._normal_before, then.metric
        tilt = np.linalg.solve(metric, np.einsum("md,mabd->mab", normal, then.second))
        tilt = -np.einsum("mab,mad->mbd", tilt, then.tangents)
        secondary = self._pair.secondary
        apart = self._coordinates[secondary] + self._moved_before[secondary, : self._dimension] - then.at
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
        by += np.einsum("ma,madu->mdu", parts, self._turning)
        by += np.einsum("ma,mabd,mbu->mdu", parts, place.second, glide)
        return Slips(value, by, self._carried, self._carried_by, _axes(place))

    def commit(self) -> None:
        """The next increment begins with these normals."""
        self._normal_before = self._normal

    def kept(self) -> Saved:
        """Pieces and normals."""
        return {"piece": self._piece, "reachable": self._reachable, "normal": self._normal_before}

    def resume(self, saved: Saved) -> None:
        """Begin with what `kept` returned."""
        self._piece, self._reachable, self._normal_before = saved["piece"], saved["reachable"], saved["normal"]
        self.nodes = self._nodes_of(self._piece)


def _axes(place: Place) -> FloatArray:
    """(m, directions, d) along the first tangent and, in space, across it; in the plane the normal turned left."""
    first = place.tangents[:, 0]
    first = first / np.linalg.norm(first, axis=1)[:, None]
    if first.shape[1] == 2:
        return np.asarray(first[:, None])
    return np.stack([first, np.cross(place.normal, first)], axis=1)
