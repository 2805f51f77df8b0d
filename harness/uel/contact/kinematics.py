# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Motion of contact points in small sliding: clearances and slips, with their derivatives by the displacements.

The clearance of a point is g = n . d: d from the anchor point to the secondary node, n the normal of the tangent plane.
Without NLGEOM both are those of the mesh, and g is linear. With NLGEOM the plane moves with the face: n = v / |v|,
where v has constant components along the tangents a1, a2 of the face at the anchor point and their product. The slip is
the change of d along directions e1, e2 that rotate with n, so that bodies that move together do not slip. The
derivatives of g and slip by the rotation of the face are moments: they shift the forces along the face to the node.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from uel.contact.frames import TURN, Jet, components, make_variables, turning_axes
from uel.elements.contributor import Find
from uel.model.arrays import FloatArray, IntArray, flat_rows
from uel.model.contact import ContactPair
from uel.model.restart import Saved
from uel.usersub._contact import SparseValues, add_products
from uel.usersub.exchange import Int32Array


@dataclass(frozen=True, slots=True)
class Clearances:
    """Clearances of m points.

    value     (m,)
    gradient  (m, u)
    conjugate (m, u) nodal forces of a unit contact force
    rounding  rounding error
    """

    value: FloatArray
    gradient: FloatArray
    conjugate: FloatArray
    rounding: float


@dataclass(frozen=True, slots=True)
class Slips:
    """Elastic slips of m closed points, in t components.

    value    (m, t)
    by       (m, t, v) derivatives by the unknowns of `Motion.slip_nodes`
    conjugate  (m, t, u) the motions along which a friction force does work
    axes     (m, directions, t) local tangent directions
    """

    value: FloatArray
    by: FloatArray
    conjugate: FloatArray
    axes: FloatArray


class Motion(Protocol):
    """Motion of the points of a pair.

    nodes       (m, n) secondary node of each point, then main nodes, which may change
    components  number of components of the slip
    """

    nodes: IntArray
    components: int

    @property
    def slip_nodes(self) -> IntArray:
        """Nodes (m, k) on which the slip of each point depends."""

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
        """Project the points at u, du (n,); find: numbers of unknowns; first: first pass of an increment."""

    @property
    def known(self) -> bool:
        """Whether `links` has the current nodes of each point."""

    def reach(self) -> None:
        """Update `links` to the current nodes."""

    def links(self) -> tuple[IntArray, IntArray]:
        """Return points (r,) and nodes (r, n) that are coupled, or may be after small motions."""

    def clearances(self, u: FloatArray, *, nlgeom: bool) -> Clearances:
        """Compute the clearances at unknowns (m, u) of the points."""

    def slips(self, u: FloatArray, change: FloatArray, elastic: FloatArray) -> Slips:
        """Compute the slips at unknowns (m, u) with their increment, from an elastic slip (m, components) at the
        start.
        """

    def add_stiffness(
        self, points: IntArray, normal: FloatArray, friction: FloatArray, equations: Int32Array, matrix: SparseValues
    ) -> None:
        """Add the derivatives of the nodal forces at fixed contact and friction forces to the matrix, after `slips`.

        Parameters
        ----------
        points
            (r,) points with forces.
        normal, friction
            Contact forces (r,), and friction forces (r, t), which act the other way.
        equations
            (r, u) unknowns of the points.
        matrix
            Is changed.
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
    """Points of a pair in small sliding, with constant nodes; displacements (m, u) are ordered by node."""

    known = True

    def __init__(self, pair: ContactPair, coordinates: FloatArray) -> None:
        """Prepare the sums over nodes; coordinates (nodes, 3) are those of all nodes of the model."""
        dimension = pair.dimension
        self.nodes = self.slip_nodes = pair.nodes
        self.components, self.areas = dimension - 1, pair.areas
        self.above = np.ones(len(pair.nodes), dtype=np.bool_)
        self._shape = *pair.nodes.shape, dimension
        self._clearances = pair.clearances
        self._coordinates = coordinates[pair.nodes][:, :, :dimension]
        self._normals = pair.normals[:, :dimension]
        # the tangents of the face and d are linear in the nodal coordinates
        sums = np.concatenate([pair.slopes[..., : dimension - 1], pair.shares[..., None]], axis=2)
        self._sums = np.einsum("mna,de->madne", sums, np.eye(dimension)).reshape(
            len(sums), dimension**2, sums.shape[1] * dimension
        )
        base = self._base(self._vectors(self._coordinates)[:-1])
        self._normal_components = np.asarray(np.linalg.solve(base, self._normals[..., None])[..., 0], dtype=np.float64)
        self._first = np.asarray(np.linalg.solve(base, self._first_direction()[..., None])[..., 0], dtype=np.float64)
        directions = [axis.value for axis in self._axes(self._coordinates, constant=True)[0][1:]]
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

    def clearances(self, u: FloatArray, *, nlgeom: bool) -> Clearances:
        """Compute the clearances at displacements."""
        self._now = None
        return self.finite(u) if nlgeom else self.linear(u)

    def slips(self, u: FloatArray, change: FloatArray, elastic: FloatArray) -> Slips:
        """Compute the slips, after `clearances`: with NLGEOM from the change of d along axes that rotate with the
        face.
        """
        axes = np.broadcast_to(np.eye(self.components), (len(change), self.components, self.components))
        now = self._now
        if now is None:
            tangents = self._tangents
            return Slips(elastic + np.einsum("mtu,mu->mt", tangents, change), tangents, tangents, axes)
        then = components(*self._axes(self._positions(u - change), constant=True))
        by = np.einsum("mtk,mku->mtu", now.first[:, 1:], self._sums)
        return Slips(elastic + now.value[:, 1:] - then.value[:, 1:], by, by, axes)

    def add_stiffness(
        self, points: IntArray, normal: FloatArray, friction: FloatArray, equations: Int32Array, matrix: SparseValues
    ) -> None:
        """Add the derivatives of the nodal forces, see `Motion.add_stiffness`; none without NLGEOM."""
        if self._now is None:
            return
        sums, forces = self._sums[points], np.concatenate([-normal[:, None], friction], axis=1)
        # by the tangents and d
        by_vectors = np.einsum("mt,mtkl->mkl", forces, self._now.second[points])
        add_products(sums, equations, by_vectors @ sums, equations, matrix)

    def commit(self) -> None:
        """Do nothing: there is no history."""

    def kept(self) -> Saved:
        """Return nothing: there is no history."""
        return {}

    def resume(self, saved: Saved) -> None:
        """Do nothing: there is no history."""

    def linear(self, u: FloatArray) -> Clearances:
        """Compute the clearances in small displacements."""
        gradient = self._along(self._normals)
        value = self._clearances + np.einsum("mu,mu->m", gradient, u)
        return Clearances(value, gradient, gradient, float(np.finfo(float).eps * np.abs(u).max()))

    def finite(self, u: FloatArray) -> Clearances:
        """Compute the clearances in large displacements."""
        positions = self._positions(u)
        self._now = now = components(*self._axes(positions))
        gradient = np.einsum("mk,mku->mu", now.first[:, 0], self._sums)
        rounding = float(np.finfo(float).eps) * float(np.abs(positions).max())
        return Clearances(now.value[:, 0], gradient, gradient, rounding)

    def _positions(self, u: FloatArray) -> FloatArray:
        """Return (m, n, dimension) current coordinates of the nodes."""
        return np.asarray(self._coordinates + u.reshape(self._shape))

    def _vectors(self, positions: FloatArray) -> list[FloatArray]:
        """Return the tangents (m, dimension) of the face at the anchor point, then d."""
        m, dimension = self._shape[0], self._shape[2]
        vectors = np.einsum("mku,mu->mk", self._sums, flat_rows(positions)).reshape(m, dimension, dimension)
        return [vectors[:, number] for number in range(vectors.shape[1])]

    def _axes(self, positions: FloatArray, *, constant: bool = False) -> tuple[list[Jet], FloatArray]:
        """Return normal and directions of slip, and d (m, dimension); constant: without derivatives."""
        *tangents, gap = self._vectors(positions)
        jets = make_variables(tangents, constant=constant)
        return turning_axes(jets, self._normal_components, self._first), gap

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
    """Return the normalized parts of vectors (m, 3) perpendicular to normals (m, 3)."""
    across = vectors - np.einsum("md,md->m", normals, vectors)[:, None] * normals
    return np.asarray(across / np.linalg.norm(across, axis=1)[:, None])
