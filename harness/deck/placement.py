# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rectangular systems: placements, as *INSTANCE, *NCOPY and *SYSTEM give them, and the axes of *ORIENTATION."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from harness.deck.blocks import Block, Row
from harness.deck.definitions import read_definitions
from harness.deck.error_report import Problems
from harness.deck.table import NAME, Keyword, Where, one_of, refused
from harness.model.arrays import FloatArray
from harness.model.properties import Orientation

SMALLEST_LENGTH = 1e-10
SMALLEST_SINE = 1e-10


@dataclass(frozen=True, slots=True)
class Placement:
    """x -> rotation (3, 3) x + shift (3,)."""

    rotation: FloatArray
    shift: FloatArray

    @property
    def rotates(self) -> bool:
        """True where directions change."""
        return not np.array_equal(self.rotation, np.eye(3))

    def move(self, points: FloatArray) -> FloatArray:
        """(n, 3) points in their new place."""
        return points @ self.rotation.T + self.shift

    def turn(self, directions: FloatArray) -> FloatArray:
        """(n, 3) directions, rotated."""
        return directions @ self.rotation.T


IDENTITY = Placement(np.eye(3), np.zeros(3))


def read_placement(block: Block) -> Placement:
    """Placement of the data lines: a translation, then two points of an axis and an angle in degrees."""
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
    """Placement of the nodes after *SYSTEM: origin a, point b on the local x-axis, point c of the local x-y plane."""
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
    """Point of the axis and rotation matrix (Rodrigues' formula)."""
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


def read_orientations(blocks: list[Block], problems: Problems) -> dict[str, Orientation]:
    """Orientations of *ORIENTATION."""
    return read_definitions(blocks, "ORIENTATION", _read_orientation, problems)


def _read_orientation(block: Block) -> Orientation:
    return Orientation(block.options.text("NAME"), _read_axes(block), block.source)


def _read_axes(block: Block) -> FloatArray:
    """Rows are the local directions: a on the first, b in the plane of the first two, c the origin."""
    rows = list(block.rows())
    if not 1 <= len(rows) <= 2:
        raise block.error("needs a data line with the points a, b and c, and may have one with a rotation")
    rows[0].at_most(9)
    a, b, c = np.array([rows[0].real(index, "coordinate", 0.0) for index in range(9)]).reshape(3, 3)
    third = np.cross(a - c, b - c)
    if np.linalg.norm(third) <= SMALLEST_SINE * np.linalg.norm(a - c) * np.linalg.norm(b - c):
        raise rows[0].error("the points a, b and c are collinear")
    axes = np.array([a - c, np.cross(third, a - c), third])
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    if len(rows) == 2:
        axis = rows[1].integer(0, "axis", 1)
        if axis not in (1, 2, 3):
            raise rows[1].error(f"axis {axis} is not 1, 2 or 3")
        angle = math.radians(rows[1].real(1, "angle", 0.0))
        first, second = axis % 3, (axis + 1) % 3
        turned = [math.cos(angle) * axes[first] + math.sin(angle) * axes[second]]
        turned += [-math.sin(angle) * axes[first] + math.cos(angle) * axes[second]]
        axes[first], axes[second] = turned
    return axes


KEYWORDS = (
    Keyword(
        "SYSTEM",
        "Rectangular system in which the nodes that follow are given; without data lines the global one.",
        Where.MODEL,
        data="origin, point on the local x-axis; then a point of the local x-y plane",
    ),
    Keyword(
        "ORIENTATION",
        "Local rectangular axes from three points, with an additional rotation.",
        Where.MODEL,
        (
            NAME,
            one_of("DEFINITION", "how the points are given", ("COORDINATES",), refused=("NODES", "OFFSET TO NODES")),
            one_of(
                "SYSTEM",
                "kind of axes",
                ("RECTANGULAR",),
                refused=("CYLINDRICAL", "SPHERICAL", "USER", "Z RECTANGULAR"),
            ),
            *refused("LOCAL DIRECTIONS"),
        ),
        "a (on the 1-axis), b (in the 1-2 plane), c (origin); then axis number and angle in degrees",
    ),
)
