# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Analytical rigid surfaces in the plane: lines and arcs that move and rotate with a reference node."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from uel.contact.main_surface import EQUAL, SurfacePoints
from uel.model.arrays import FloatArray, IntArray
from uel.model.contact import RigidProfile

ROTATION = 6
"""Dof of the rotation in the plane."""


class RigidSurface:
    """Analytical rigid surface as the main surface of a pair; implements `surface.Surface`."""

    dofs: tuple[int, ...] = (1, 2, ROTATION)
    unknowns: tuple[tuple[int, int], ...] = tuple((1, dof) for dof in (1, 2, ROTATION))

    def __init__(self, profile: RigidProfile, coordinates: FloatArray) -> None:
        """Prepare the surface; coordinates (nodes, 2) are those of all nodes of the model."""
        self._profile, self._start = profile, coordinates[profile.reference]

    def nodes_of(self, piece: IntArray) -> IntArray:
        """Return the reference node for each piece, see `Surface.nodes_of`."""
        return np.full((len(piece), 1), self._profile.reference)

    def ring_of(self, piece: IntArray) -> IntArray:
        """Return all pieces as neighbours, as they have the same node."""
        count = len(self._profile.radius)
        return np.broadcast_to(np.arange(count), (len(piece), count))

    def sizes(self, piece: IntArray, u: FloatArray) -> FloatArray:
        """Return half of the lengths of pieces, see `Surface.sizes`."""
        del u
        profile = self._profile
        half = np.linalg.norm(profile.half, axis=1)
        return np.asarray(np.where(profile.radius > 0.0, profile.radius * np.abs(profile.half[:, 1]), half)[piece])

    def at(self, piece: IntArray, natural: FloatArray, u: FloatArray) -> SurfacePoints:
        """Return points of pieces, see `Surface.at`."""
        here = u[self._profile.reference]
        turn = _turn(here[2])
        at, tangents, second = self._initial(piece, natural[:, 0])
        return SurfacePoints(
            (at - self._start) @ turn.T + self._start + here[:2],
            (tangents @ turn.T)[:, None],
            (second @ turn.T)[:, None, None],
        )

    def _initial(self, piece: IntArray, natural: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return points, tangents and their derivatives (m, 2), undeformed."""
        profile = self._profile
        middle, half, radius = profile.middle[piece], profile.half[piece], profile.radius[piece][:, None]
        angle = half[:, 0] + natural * half[:, 1]
        out = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        round_, speed = radius > 0.0, half[:, 1:]
        at = np.where(round_, middle + radius * out, middle + natural[:, None] * half)
        along = radius * speed * np.stack([-out[:, 1], out[:, 0]], axis=1)
        return at, np.where(round_, along, half), np.where(round_, -radius * speed**2 * out, 0.0)

    def by_unknowns(self, piece: IntArray, natural: FloatArray, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the derivatives of points and tangents, see `Surface.by_unknowns`."""
        points, m = self.at(piece, natural, u), len(piece)
        arm = points.at - self._start - u[self._profile.reference, :2]
        at = np.concatenate([np.broadcast_to(np.eye(2), (m, 2, 2)), _left(arm)[:, :, None]], axis=2)
        tangents = np.concatenate([np.zeros((m, 1, 2, 2)), _left(points.tangents)[..., None]], axis=3)
        return at, tangents

    def loaded(self, piece: IntArray, natural: FloatArray, u: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the motions conjugate to forces and their derivatives, see `Surface.loaded`."""
        at, tangents = self.by_unknowns(piece, natural, u)
        second = np.zeros((len(piece), 2, 3, 3))
        # second derivative of a rotating arm
        second[:, :, 2, 2] = _left(at[:, :, 2])
        return at, tangents, second

    def track(
        self, points: FloatArray, outward: FloatArray, u: FloatArray, before: IntArray, *, everywhere: bool
    ) -> tuple[IntArray, FloatArray, NDArray[np.bool_]]:
        """Find the nearest pieces, see `Surface.track`, always on the entire surface."""
        del everywhere
        profile, m, count = self._profile, len(points), len(self._profile.radius)
        here = u[profile.reference]
        initial = (points - self._start - here[:2]) @ _turn(here[2]) + self._start
        local_outward = outward @ _turn(here[2])
        piece = np.tile(np.arange(count), m)
        from_middle = np.repeat(initial, count, axis=0) - profile.middle[piece]
        half, is_round = profile.half[piece], profile.radius[piece] > 0.0
        angle = np.arctan2(from_middle[:, 1], from_middle[:, 0]) - half[:, 0]
        angle = (angle + np.pi) % (2.0 * np.pi) - np.pi
        straight = np.einsum("md,md->m", from_middle, half) / np.einsum("md,md->m", half, half)
        natural = np.where(is_round, angle / np.where(is_round, half[:, 1], 1.0), straight)
        at, tangents, _ = self._initial(piece, np.clip(natural, -1.0, 1.0))
        away = np.einsum("md,md->m", -_left(tangents), np.repeat(local_outward, count, axis=0))
        away = away > EQUAL * np.linalg.norm(tangents, axis=1)
        distance = np.linalg.norm(np.repeat(initial, count, axis=0) - at, axis=1)
        distance = np.where(away, np.inf, distance).reshape(m, count)
        near = distance <= distance.min(axis=1, keepdims=True) + EQUAL * self.sizes(np.arange(count), u).max()
        rows = np.arange(m)
        chosen = np.where(near[rows, before], before, np.argmax(near, axis=1))
        natural = natural.reshape(m, count)[rows, chosen]
        above = np.isfinite(distance[rows, chosen])
        above &= (natural >= -1.0 - EQUAL) | ~profile.free[chosen, 0]
        above &= (natural <= 1.0 + EQUAL) | ~profile.free[chosen, 1]
        return chosen, natural[:, None], above


def _turn(angle: float) -> FloatArray:
    """Return the (2, 2) rotation by an angle."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def _left(vectors: FloatArray) -> FloatArray:
    """Return vectors (..., 2) turned by a right angle to the left."""
    return np.stack([-vectors[..., 1], vectors[..., 0]], axis=-1)
