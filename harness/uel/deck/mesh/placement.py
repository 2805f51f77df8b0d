# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Placements of *INSTANCE, *NCOPY and *SYSTEM."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from uel.deck.language.blocks import Block, Row
from uel.deck.language.table import Keyword, Where
from uel.model.arrays import FloatArray

SMALLEST_LENGTH = 1e-10


@dataclass(frozen=True, slots=True)
class Placement:
    """Rigid motion x -> rotation (3, 3) x + shift (3,)."""

    rotation: FloatArray
    shift: FloatArray

    @property
    def rotates(self) -> bool:
        """Whether directions change."""
        return not np.array_equal(self.rotation, np.eye(3))

    def move(self, points: FloatArray) -> FloatArray:
        """Return (n, 3) moved points."""
        return points @ self.rotation.T + self.shift

    def turn(self, directions: FloatArray) -> FloatArray:
        """Return (n, 3) rotated directions."""
        return directions @ self.rotation.T


IDENTITY = Placement(np.eye(3), np.zeros(3))


def read_placement(block: Block) -> Placement:
    """Read a placement from the data lines: a translation, then two points of an axis and an angle in degrees."""
    rows = list(block.all_rows())
    if len(rows) > 2:
        raise rows[2].error("expected one line with a translation and one with a rotation")
    shift = np.zeros(3)
    if rows:
        rows[0].at_most(3)
        shift = np.array([rows[0].real(index, "translation", 0.0) for index in range(3)])
    if len(rows) < 2:
        return Placement(np.eye(3), shift)
    start, rotation = _read_rotation(rows[1])
    return Placement(rotation, rotation @ (shift - start) + start)


def read_system(block: Block) -> Placement:
    """Read *SYSTEM: origin a, point b on the local x-axis, point c in the local x-y plane."""
    rows = list(block.rows())
    if len(rows) > 2:
        raise rows[2].error("expected at most two data lines")
    if not rows:
        return IDENTITY
    rows[0].at_most(6)
    points = np.array([rows[0].real(index, "coordinate", 0.0) for index in range(6)]).reshape(2, 3)
    origin = points[0]
    if len(rows[0]) <= 3:
        return Placement(np.eye(3), origin)
    first = points[1] - origin
    # without a third point the z-axis stays
    third = np.array([0.0, 0.0, 1.0])
    if len(rows) == 2:
        rows[1].at_most(3)
        third = np.cross(first, [rows[1].real(index, "coordinate", 0.0) for index in range(3)] - origin)
    second = np.cross(third, first)
    lengths = np.array([np.linalg.norm(axis) for axis in (first, second, third)])
    if lengths.min() <= SMALLEST_LENGTH * np.linalg.norm(first):
        raise rows[0].error("the points of the system are collinear")
    rotation = np.stack([first, second, np.cross(first, second)])
    return Placement((rotation / np.linalg.norm(rotation, axis=1)[:, None]).T, origin)


def _read_rotation(row: Row) -> tuple[FloatArray, FloatArray]:
    """Read a point of the axis and the rotation matrix (Rodrigues' formula). Raises DeckError."""
    row.at_most(7)
    values = np.array([row.real(index, "rotation", 0.0) for index in range(6)])
    start, axis = values[:3], values[3:] - values[:3]
    length = float(np.linalg.norm(axis))
    if length == 0:
        raise row.error("the two points of the axis are the same")
    x, y, z = axis / length
    angle = math.radians(row.real(6, "angle", 0.0))
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return start, np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


KEYWORDS = (
    Keyword(
        "SYSTEM",
        "Rectangular system in which the nodes that follow are given; without data lines the global one.",
        Where.MODEL,
        data="origin, point on the local x-axis; then a point of the local x-y plane",
    ),
)
