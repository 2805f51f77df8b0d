# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""How contact points move in small sliding: clearances and slips, with their derivatives by the displacements.

The clearance of a point is g = n . d: d from the anchor point to the secondary node, n the normal of the tangent plane.
Without NLGEOM both are those of the mesh, and g is linear. With NLGEOM the plane goes with the face: n = v / |v|, and v
has constant components along the tangents a1, a2 of the face at the anchor point and their product. What g loses to the
turning face are moments: the derivatives of g move the force along the face to where the node is.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from harness.elements.rotations import PERMUTATION
from harness.model.arrays import FloatArray, IntArray
from harness.model.contact import ContactPair
from harness.model.restart import Saved

Find = Callable[[IntArray, IntArray | int], IntArray]
"""Numbers of the unknowns of nodes and dofs, broadcast against each other; -1 for none."""

_TURN: Final = np.array([[0.0, -1.0], [1.0, 0.0]])
"""By a right angle, in the plane."""


@dataclass(frozen=True, slots=True)
class Clearances:
    """Of m points.

    value     (m,)
    gradient  (m, u)
    pushed    (m, u) forces on the unknowns for a contact force of one
    curvature gives their derivatives (r, u, u) for some points (r,) and their contact forces (r,); None: zero
    rounding  error that the arithmetic makes
    """

    value: FloatArray
    gradient: FloatArray
    pushed: FloatArray
    curvature: Callable[[IntArray, FloatArray], FloatArray] | None
    rounding: float


@dataclass(frozen=True, slots=True)
class Slips:
    """Elastic slips of m closed points, in t components.

    value    (m, t)
    by       (m, t, u) derivatives by the unknowns
    carried  (m, t, u) the motions along which a friction force does work
    turned   gives the derivatives (r, u, u) of what friction forces (r, t) on some points (r,) do; None: zero
    axes     (m, directions, t) local tangent directions
    """

    value: FloatArray
    by: FloatArray
    carried: FloatArray
    turned: Callable[[IntArray, FloatArray], FloatArray] | None
    axes: FloatArray


class Motion(Protocol):
    """How the points of a pair move.

    nodes      (m, n) secondary node of each point, then those that move it, which may change
    components of the slip
    """

    nodes: IntArray
    components: int

    @property
    def above(self) -> NDArray[np.bool_]:
        """(m,) whether the main surface is there."""

    @property
    def areas(self) -> FloatArray:
        """(m,) of the secondary surface that belong to the points."""

    def unknowns_of(self, count: int) -> tuple[tuple[int, int], ...]:
        """(local node, dof) of each unknown of a point that has this number of nodes."""

    def start(self) -> FloatArray:
        """(m,) clearances before the analysis."""

    def track(self, u: FloatArray, du: FloatArray, find: Find, *, first: bool) -> None:
        """Find what the points are opposite to at displacements u, du after the start of an increment (n,).

        find: numbers of the unknowns; first: in an increment.
        """

    @property
    def known(self) -> bool:
        """Whether `links` has the present nodes of each point."""

    def reach(self) -> None:
        """Let `links` have the present nodes."""

    def links(self) -> tuple[IntArray, IntArray]:
        """Points (r,) and nodes (r, n) that are linked, or may soon be."""

    def clearances(self, moved: FloatArray, *, nlgeom: bool) -> Clearances:
        """At unknowns (m, u) of the points."""

    def slips(self, moved: FloatArray, change: FloatArray, elastic: FloatArray) -> Slips:
        """At unknowns (m, u), changed in the increment, which began with this elastic slip (m, components)."""

    def commit(self) -> None:
        """End of a converged increment."""

    def kept(self) -> Saved:
        """Committed state, not copied."""

    def resume(self, saved: Saved) -> None:
        """Begin with what `kept` returned."""


def displacements(count: int, dimension: int) -> tuple[tuple[int, int], ...]:
    """(local node, dof) of the displacements of some nodes, one after the other."""
    return tuple((node, dof) for node in range(count) for dof in range(1, dimension + 1))


class SmallSliding:
    """The points of a pair move with the same nodes all the time; displacements (m, u) are those of one node after the
    other.
    """

    known = True

    def __init__(self, pair: ContactPair, coordinates: FloatArray) -> None:
        """Coordinates (nodes, 3) are those of all nodes of the model."""
        dimension = pair.dimension
        self.nodes = pair.nodes
        self.components, self.areas = dimension - 1, pair.areas
        self.above = np.ones(len(pair.nodes), dtype=np.bool_)
        self._shape = *pair.nodes.shape, dimension
        self._clearances = pair.clearances
        self._places = coordinates[pair.nodes][:, :, :dimension]
        self._shares, self._slopes = pair.shares, pair.slopes
        self._normals = pair.normals[:, :dimension]
        self._parts = np.linalg.solve(self._base(self._tangents_of(self._places)), self._normals[..., None])[..., 0]
        self._first = self._first_direction() if dimension == 3 else np.zeros(0)
        # derivatives of the slips by the displacements, those at the start of the increment
        self._tangents = self._directions(None)
        self._moved: FloatArray | None = None

    def unknowns_of(self, count: int) -> tuple[tuple[int, int], ...]:
        """Displacements of one node after the other."""
        return displacements(count, self._shape[2])

    def start(self) -> FloatArray:
        """(m,) clearances before the analysis."""
        return self._clearances

    def track(self, u: FloatArray, du: FloatArray, find: Find, *, first: bool) -> None:
        """They stay where they are."""

    def reach(self) -> None:
        """They have them."""

    def links(self) -> tuple[IntArray, IntArray]:
        """Points (m,) and their nodes (m, n)."""
        return np.arange(len(self.nodes)), self.nodes

    def clearances(self, moved: FloatArray, *, nlgeom: bool) -> Clearances:
        """At displacements."""
        self._moved = moved if nlgeom else None
        return self.finite(moved) if nlgeom else self.linear(moved)

    def slips(self, moved: FloatArray, change: FloatArray, elastic: FloatArray) -> Slips:
        """Along tangents of the face at the start of the increment."""
        del moved
        tangents = self._tangents
        axes = np.broadcast_to(np.eye(self.components), (len(change), self.components, self.components))
        return Slips(elastic + np.einsum("mtu,mu->mt", tangents, change), tangents, tangents, None, axes)

    def commit(self) -> None:
        """Slips follow the turned face."""
        if self._moved is not None:
            self._tangents = self._directions(self._moved)

    def kept(self) -> Saved:
        """Tangents."""
        return {"tangents": self._tangents}

    def resume(self, saved: Saved) -> None:
        """Begin with what `kept` returned."""
        self._tangents = saved["tangents"]

    def linear(self, moved: FloatArray) -> Clearances:
        """In small displacements."""
        gradient = self._along(self._normals)
        value = self._clearances + np.einsum("mu,mu->m", gradient, moved)
        return Clearances(value, gradient, gradient, None, float(np.finfo(float).eps * np.abs(moved).max()))

    def finite(self, moved: FloatArray) -> Clearances:
        """In large displacements."""
        m, n, dimension = self._shape
        places = self._places + moved.reshape(self._shape)
        tangents = self._tangents_of(places)
        turned, first = self._normal_of(tangents)
        length = np.linalg.norm(turned, axis=1)
        normal = turned / length[:, None]
        apart = np.einsum("mn,mnd->md", self._shares, places)
        value = np.einsum("md,md->m", normal, apart)
        # of d beside the normal, over |v|
        beside = (apart - value[:, None] * normal) / length[:, None]
        by_place = np.einsum("mn,de->mdne", self._shares, np.eye(dimension)).reshape(m, dimension, -1)
        gradient = np.einsum("md,mdu->mu", normal, by_place) + np.einsum("md,mdu->mu", beside, first)
        stretch = np.einsum("md,mdu->mu", normal, first) / length[:, None]
        normal_by = first / length[:, None, None] - normal[..., None] * stretch[:, None]
        beside_by = by_place - normal[..., None] * gradient[:, None] - value[:, None, None] * normal_by
        beside_by = beside_by / length[:, None, None] - beside[..., None] * stretch[:, None]
        curvature = np.einsum("mdu,mdv->muv", by_place, normal_by) + np.einsum("mdu,mdv->muv", first, beside_by)
        if dimension == 3:
            # v is quadratic in the places of the nodes
            twist = np.einsum("mn,mk->mnk", self._slopes[..., 0], self._slopes[..., 1])
            twist = self._parts[:, 2, None, None] * (twist - twist.transpose(0, 2, 1))
            second = np.einsum("mnk,md,dpq->mnpkq", twist, beside, PERMUTATION)
            curvature += second.reshape(m, n * dimension, -1)
        eps = float(np.finfo(float).eps)
        rounding = eps * float(np.abs(places).max())

        def bent(points: IntArray, force: FloatArray) -> FloatArray:
            return np.asarray(force[:, None, None] * curvature[points])

        return Clearances(value, gradient, gradient, bent, rounding)

    def _directions(self, moved: FloatArray | None) -> FloatArray:
        """(m, directions, u) derivatives of the slips along tangents of the face; moved: None where it is in its mesh
        position.
        """
        places = self._places if moved is None else self._places + moved.reshape(self._shape)
        tangents = self._tangents_of(places)
        turned, _ = self._normal_of(tangents)
        normal = turned / np.linalg.norm(turned, axis=1)[:, None]
        if self._shape[2] == 2:
            return self._along(normal @ _TURN.T)[:, None]
        first = _across(np.einsum("mde,me->md", self._base(tangents), self._first), normal)
        return np.stack([self._along(first), self._along(np.cross(normal, first))], axis=1)

    def _first_direction(self) -> FloatArray:
        """(m, 3) constant components of the first direction of slips along the tangents and their product.

        Before the analysis it is the projection of the global 1-axis, or of the 3-axis where the 1-axis is within 0.1
        degrees of the normal (Abaqus Analysis User's Guide, "Conventions").
        """
        steep = np.abs(self._normals[:, 0]) > np.cos(np.radians(0.1))
        first = _across(np.where(steep[:, None], np.eye(3)[2], np.eye(3)[0]), self._normals)
        return np.asarray(np.linalg.solve(self._base(self._tangents_of(self._places)), first[..., None])[..., 0])

    def _along(self, direction: FloatArray) -> FloatArray:
        """(m, u) derivative of d along a direction (m, dimension)."""
        return (self._shares[:, :, None] * direction[:, None]).reshape(len(direction), -1)

    def _tangents_of(self, places: FloatArray) -> FloatArray:
        """(m, 1 or 2, dimension) tangents of the face at the anchor point."""
        return np.asarray(np.einsum("mna,mnd->mad", self._slopes, places))

    def _base(self, tangents: FloatArray) -> FloatArray:
        """(m, dimension, dimension) the tangents and what is normal to them, in columns."""
        if tangents.shape[1] == 1:
            return np.stack([tangents[:, 0], tangents[:, 0] @ _TURN.T], axis=2)
        return np.stack([*tangents.transpose(1, 0, 2), np.cross(tangents[:, 0], tangents[:, 1])], axis=2)

    def _normal_of(self, tangents: FloatArray) -> tuple[FloatArray, FloatArray]:
        """v (m, dimension) and its derivatives (m, dimension, u)."""
        parts, (m, _, dimension) = self._parts, self._shape
        turned = np.einsum("mde,me->md", self._base(tangents), parts)
        if dimension == 2:
            by_tangent = parts[:, 0, None, None] * np.eye(2) + parts[:, 1, None, None] * _TURN
            return turned, np.einsum("mn,mde->mdne", self._slopes[..., 0], by_tangent).reshape(m, 2, -1)
        product = parts[:, 2, None, None, None]
        cross = product * np.stack(
            [
                np.einsum("rpq,mq->mrp", PERMUTATION, tangents[:, 1]),
                np.einsum("rpq,mp->mrq", PERMUTATION, tangents[:, 0]),
            ],
            axis=1,
        )
        by_tangents = parts[:, :2, None, None] * np.eye(3) + cross
        return turned, np.einsum("mna,made->mdne", self._slopes, by_tangents).reshape(m, 3, -1)


def _across(vectors: FloatArray, normals: FloatArray) -> FloatArray:
    """Parts of vectors (m, 3) across normals (m, 3), of length one."""
    found = vectors - np.einsum("md,md->m", normals, vectors)[:, None] * normals
    return np.asarray(found / np.linalg.norm(found, axis=1)[:, None])
