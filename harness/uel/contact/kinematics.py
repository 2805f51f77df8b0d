# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Motion of contact points in small sliding: clearances and slips, with their derivatives by the displacements.

The clearance of a point is g = n . d: d from the anchor point to the secondary node, n the normal of the tangent plane.
Without NLGEOM both are those of the mesh, and g is linear. With NLGEOM the plane goes with the face: n = v / |v|, and v
has constant components along the tangents a1, a2 of the face at the anchor point and their product. The slip is what d
has along directions e1, e2 that turn with n, so that bodies that move together do not slip, whatever their clearance.
What g and the slip lose to the turning face are moments: their derivatives move the forces along the face to where the
node is.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from uel.contact.frames import TURN, Jet, components, make_variables, turning_axes
from uel.elements.contributor import Find
from uel.model.arrays import FloatArray, IntArray, flat_rows
from uel.model.contact import ContactPair
from uel.model.restart import Saved


@dataclass(frozen=True, slots=True)
class Clearances:
    """Clearances of m points.

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
    """Motion of the points of a pair.

    nodes      (m, n) secondary node of each point, then those that move it, which may change
    components of the slip
    """

    nodes: IntArray
    components: int

    @property
    def above(self) -> NDArray[np.bool_]:
        """Mask (m,) of the points that face the main surface."""

    @property
    def areas(self) -> FloatArray:
        """Areas (m,) of the secondary surface that belong to the points."""

    def unknowns_of(self, count: int) -> tuple[tuple[int, int], ...]:
        """Return (local node, dof) of each unknown of a point that has this number of nodes."""

    def start(self) -> FloatArray:
        """Return (m,) clearances before the analysis."""

    def track(self, u: FloatArray, du: FloatArray, find: Find, *, first: bool) -> None:
        """Find the places opposite the points at displacements u, du after the start of an increment (n,).

        find: numbers of the unknowns; first: in an increment.
        """

    @property
    def known(self) -> bool:
        """Whether `links` has the present nodes of each point."""

    def reach(self) -> None:
        """Update `links` to the present nodes."""

    def links(self) -> tuple[IntArray, IntArray]:
        """Return points (r,) and nodes (r, n) that are linked, or may soon be."""

    def clearances(self, moved: FloatArray, *, nlgeom: bool) -> Clearances:
        """Compute the clearances at unknowns (m, u) of the points."""

    def slips(self, moved: FloatArray, change: FloatArray, elastic: FloatArray) -> Slips:
        """Compute the slips at unknowns (m, u), changed in the increment,
        which began with this elastic slip (m, components).
        """

    def commit(self) -> None:
        """Commit the trial state at the end of a converged increment."""

    def kept(self) -> Saved:
        """Return the committed state, not copied."""

    def resume(self, saved: Saved) -> None:
        """Restore the state that `kept` returned."""


def displacements(count: int, dimension: int) -> tuple[tuple[int, int], ...]:
    """Return (local node, dof) of the displacements of some nodes, one after the other."""
    return tuple((node, dof) for node in range(count) for dof in range(1, dimension + 1))


class SmallSliding:
    """The points of a pair move with the same nodes all the time; displacements (m, u) are those of one node after the
    other.
    """

    known = True

    def __init__(self, pair: ContactPair, coordinates: FloatArray) -> None:
        """Prepare the sums over nodes; coordinates (nodes, 3) are those of all nodes of the model."""
        dimension = pair.dimension
        self.nodes = pair.nodes
        self.components, self.areas = dimension - 1, pair.areas
        self.above = np.ones(len(pair.nodes), dtype=np.bool_)
        self._shape = *pair.nodes.shape, dimension
        self._clearances = pair.clearances
        self._places = coordinates[pair.nodes][:, :, :dimension]
        self._normals = pair.normals[:, :dimension]
        # the tangents of the face and d are these sums over the nodes
        sums = np.concatenate([pair.slopes[..., : dimension - 1], pair.shares[..., None]], axis=2)
        self._sums = np.einsum("mna,de->madne", sums, np.eye(dimension)).reshape(
            len(sums), dimension**2, sums.shape[1] * dimension
        )
        base = self._base(self._vectors(self._places)[:-1])
        self._parts = np.asarray(np.linalg.solve(base, self._normals[..., None])[..., 0], dtype=np.float64)
        self._first = np.asarray(np.linalg.solve(base, self._first_direction()[..., None])[..., 0], dtype=np.float64)
        directions = [axis.value for axis in self._axes(self._places, constant=True)[0][1:]]
        self._tangents = np.stack([self._along(direction) for direction in directions], axis=1)
        self._now: Jet | None = None

    def unknowns_of(self, count: int) -> tuple[tuple[int, int], ...]:
        """Return the displacements of one node after the other."""
        return displacements(count, self._shape[2])

    def start(self) -> FloatArray:
        """Return (m,) clearances before the analysis."""
        return self._clearances

    def track(self, u: FloatArray, du: FloatArray, find: Find, *, first: bool) -> None:
        """Do nothing: the anchor points stay in place."""

    def reach(self) -> None:
        """Do nothing: the nodes of a point never change."""

    def links(self) -> tuple[IntArray, IntArray]:
        """Return points (m,) and their nodes (m, n)."""
        return np.arange(len(self.nodes)), self.nodes

    def clearances(self, moved: FloatArray, *, nlgeom: bool) -> Clearances:
        """Compute the clearances at displacements."""
        self._now = None
        return self.finite(moved) if nlgeom else self.linear(moved)

    def slips(self, moved: FloatArray, change: FloatArray, elastic: FloatArray) -> Slips:
        """Compute the slips, after `clearances`. With NLGEOM they change by the change in the increment of the parts of
        d along axes that turn with the face, without it by the displacement along the axes of the mesh.
        """
        axes = np.broadcast_to(np.eye(self.components), (len(change), self.components, self.components))
        now = self._now
        if now is None:
            tangents = self._tangents
            return Slips(elastic + np.einsum("mtu,mu->mt", tangents, change), tangents, tangents, None, axes)
        then = components(*self._axes(self._at(moved - change), constant=True))
        by = np.einsum("mtk,mku->mtu", now.first[:, 1:], self._sums)

        def turned(points: IntArray, forces: FloatArray) -> FloatArray:
            return self._curved(points, np.einsum("mt,mtkl->mkl", forces, now.second[points, 1:]))

        return Slips(elastic + now.value[:, 1:] - then.value[:, 1:], by, by, turned, axes)

    def commit(self) -> None:
        """Do nothing: there is no history."""

    def kept(self) -> Saved:
        """Return nothing: there is no history."""
        return {}

    def resume(self, saved: Saved) -> None:
        """Do nothing: there is no history."""

    def linear(self, moved: FloatArray) -> Clearances:
        """Compute the clearances in small displacements."""
        gradient = self._along(self._normals)
        value = self._clearances + np.einsum("mu,mu->m", gradient, moved)
        return Clearances(value, gradient, gradient, None, float(np.finfo(float).eps * np.abs(moved).max()))

    def finite(self, moved: FloatArray) -> Clearances:
        """Compute the clearances in large displacements."""
        places = self._at(moved)
        self._now = now = components(*self._axes(places))
        gradient = np.einsum("mk,mku->mu", now.first[:, 0], self._sums)

        def bent(points: IntArray, force: FloatArray) -> FloatArray:
            return self._curved(points, force[:, None, None] * now.second[points, 0])

        rounding = float(np.finfo(float).eps) * float(np.abs(places).max())
        return Clearances(now.value[:, 0], gradient, gradient, bent, rounding)

    def _curved(self, points: IntArray, matrix: FloatArray) -> FloatArray:
        """Return (r, u, u) derivatives by the displacements from those (r, k, k) by tangents and d."""
        sums = self._sums[points]
        return np.asarray(np.einsum("mku,mkv->muv", sums, np.einsum("mkl,mlv->mkv", matrix, sums)))

    def _at(self, moved: FloatArray) -> FloatArray:
        """Return (m, n, dimension) places of the nodes at displacements."""
        return np.asarray(self._places + moved.reshape(self._shape))

    def _vectors(self, places: FloatArray) -> list[FloatArray]:
        """Return the tangents (m, dimension) of the face at the anchor point, then d."""
        m, dimension = self._shape[0], self._shape[2]
        found = np.einsum("mku,mu->mk", self._sums, flat_rows(places)).reshape(m, dimension, dimension)
        return [found[:, number] for number in range(found.shape[1])]

    def _axes(self, places: FloatArray, *, constant: bool = False) -> tuple[list[Jet], Jet]:
        """Return normal and directions of slip, and d; constant: without derivatives."""
        *tangents, apart = make_variables(self._vectors(places), constant=constant)
        return turning_axes(tangents, self._parts, self._first), apart

    def _first_direction(self) -> FloatArray:
        """Return the (m, dimension) first direction of slip before the analysis.

        It is the projection of the global 1-axis, or of the 3-axis where the 1-axis is within 0.1 degrees of the normal
        (Abaqus Analysis User's Guide, "Conventions"). In the plane it follows from the normal.
        """
        if self._shape[2] == 2:
            return np.zeros_like(self._normals)
        steep = np.abs(self._normals[:, 0]) > np.cos(np.radians(0.1))
        return _across(np.where(steep[:, None], np.eye(3)[2], np.eye(3)[0]), self._normals)

    def _along(self, direction: FloatArray) -> FloatArray:
        """Return the (m, u) derivative of d along a direction (m, dimension)."""
        dimension = self._shape[2]
        return np.asarray(np.einsum("md,mdu->mu", direction, self._sums[:, -dimension:]))

    def _base(self, tangents: list[FloatArray]) -> FloatArray:
        """Return (m, dimension, dimension) the tangents and the normal to them, in columns."""
        normal = tangents[0] @ TURN.T if len(tangents) == 1 else np.cross(tangents[0], tangents[1])
        return np.stack([*tangents, normal], axis=2)


def _across(vectors: FloatArray, normals: FloatArray) -> FloatArray:
    """Return the parts of vectors (m, 3) across normals (m, 3), scaled to length one."""
    found = vectors - np.einsum("md,md->m", normals, vectors)[:, None] * normals
    return np.asarray(found / np.linalg.norm(found, axis=1)[:, None])
