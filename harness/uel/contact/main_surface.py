# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Interface of the main surfaces of finite sliding."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray, IntArray
from uel.usersub import _contact

EQUAL: Final = 1e-9
"""Difference of distances over the piece size, and of natural coordinates, that is rounding; `rounding` of
fortran/host/contact/faces.f90.
"""


@dataclass(frozen=True)
class SurfacePoints:
    """Points of a main surface.

    at       (m, d)
    tangents (m, a, d) by the natural coordinates
    second   (m, a, a, d) their derivatives
    """

    at: FloatArray
    tangents: FloatArray
    second: FloatArray

    @cached_property
    def _frames(self) -> tuple[FloatArray, FloatArray]:
        return _contact.frames(self.tangents)

    @property
    def normal(self) -> FloatArray:
        """Outward normals (m, d) of length one; zero on a line in space."""
        return self._frames[0]

    @property
    def metric(self) -> FloatArray:
        """Metric (m, a, a) of the tangents, regularized where an extended face has no area."""
        return self._frames[1]


class Surface(Protocol):
    """A main surface; u: values (nodes, dofs) of these dofs of all nodes of the model.

    dofs      displacements, then rotations
    unknowns  (local node, dof) of those of its nodes, which follow the secondary node
    """

    dofs: tuple[int, ...]
    unknowns: tuple[tuple[int, int], ...]

    def nodes_of(self, piece: IntArray) -> IntArray:
        """Return (m, k) nodes of pieces (m,)."""

    def ring_of(self, piece: IntArray) -> IntArray:
        """Return (m, r) neighbours of pieces (m,), and themselves."""

    def sizes(self, piece: IntArray, u: FloatArray) -> FloatArray:
        """Return (m,) about half of the lengths of pieces (m,)."""

    def at(self, piece: IntArray, natural: FloatArray, u: FloatArray) -> SurfacePoints:
        """Return the points (m,) of pieces at their natural coordinates (m, a)."""

    def by_unknowns(self, piece: IntArray, natural: FloatArray, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the derivatives of points (m, d, u) and tangents (m, a, d, u) by the unknowns."""

    def loaded(
        self, piece: IntArray, natural: FloatArray, u: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray | None]:
        """Return motions (m, d, u) conjugate to forces, and their derivatives (m, a, d, u) along the surface and
        (m, d, u, u) by the unknowns; None: zero.
        """

    def track(
        self, points: FloatArray, outward: FloatArray, u: FloatArray, before: IntArray, *, everywhere: bool
    ) -> tuple[IntArray, FloatArray, NDArray[np.bool_]]:
        """Return the nearest pieces, the natural coordinates (m, a) there, and the mask of points above them.

        Parameters
        ----------
        points
            (m, d) current coordinates.
        outward
            (m, d) normals of the secondary surface; pieces must face them. Zero: any piece.
        u
            (nodes, dofs).
        before
            (m,) current pieces, which stay if others are equally near.
        everywhere
            Search the entire surface, else from the current pieces to their neighbours.
        """
