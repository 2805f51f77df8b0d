# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Local systems of *ORIENTATION, whose directions may differ from point to point (Analysis User's Guide)."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from uel.model.arrays import FloatArray, IntArray

SMALLEST_SINE = 1e-10
"""Sine of the angle between two directions up to which they are parallel."""


class SystemKind(StrEnum):
    """SYSTEM= of *ORIENTATION."""

    RECTANGULAR = "RECTANGULAR"
    Z_RECTANGULAR = "Z RECTANGULAR"
    CYLINDRICAL = "CYLINDRICAL"
    SPHERICAL = "SPHERICAL"
    USER = "USER"


class UndefinedDirectionsError(ValueError):
    """Points that give no directions; row: the first one, (element,) or (element, point)."""

    def __init__(self, row: tuple[int, ...], message: str) -> None:
        super().__init__(message)
        self.row = row


@dataclass(frozen=True, slots=True)
class LocalSystem:
    """Points and angles of an orientation.

    kind    of the system
    points  (3, 3) a, b and c in rows, in global coordinates, or (n, 3, 3) for each element of the model
    nodes   local numbers, from 1, of the nodes that are these points instead (DEFINITION=OFFSET TO NODES); or none
    axis    1, 2 or 3, about which the additional rotation is
    angle   of this rotation, degrees, or (n,) for each element of the model
    """

    kind: SystemKind
    points: FloatArray
    nodes: tuple[int, ...] = ()
    axis: int = 1
    angle: float | FloatArray = 0.0

    @property
    def uniform(self) -> bool:
        """Whether the directions are the same everywhere."""
        rectangular = self.kind in (SystemKind.RECTANGULAR, SystemKind.Z_RECTANGULAR)
        return rectangular and not self.nodes and self.points.ndim == 2 and np.ndim(self.angle) == 0

    def axes(self, elements: IntArray, nodes: FloatArray, coordinates: FloatArray) -> FloatArray:
        """Compute the directions at the points of elements.

        Parameters
        ----------
        elements
            (m,) positions in the model.
        nodes
            (m, k, 3) coordinates of their nodes.
        coordinates
            (m, p, 3) coordinates of the points.

        Returns
        -------
        FloatArray
            (m, p, 3, 3) the directions are the rows.

        Raises
        ------
        UndefinedDirectionsError
            Points that define the system coincide or are collinear, or a point is on the polar axis.
        """
        points = nodes[:, np.array(self.nodes) - 1] if self.nodes else self.points
        if points.ndim == 3 and not self.nodes:
            points = points[elements]
        a, b, c = (np.broadcast_to(points[..., k, :], (len(elements), 3))[:, None] for k in range(3))
        match self.kind:
            case SystemKind.RECTANGULAR:
                axes = _frame(a - c, b - c)
            case SystemKind.Z_RECTANGULAR:
                # a is on the 3-axis, b in the plane of 3 and 1: 3, 1, 2 are right-handed too
                axes = _frame(a - c, b - c)[..., [1, 2, 0], :]
            case _:
                polar, radial = np.broadcast_to(b - a, coordinates.shape), coordinates - a
                _check_radii(polar, radial, np.linalg.norm(coordinates, axis=-1) + np.linalg.norm(a, axis=-1))
                around = _frame(polar, radial)[..., [1, 2, 0], :]
                if self.kind is SystemKind.CYLINDRICAL:
                    axes = around
                else:
                    outward = radial / np.linalg.norm(radial, axis=-1, keepdims=True)
                    axes = np.stack([outward, around[..., 1, :], np.cross(outward, around[..., 1, :])], axis=-2)
        angle = np.asarray(self.angle, dtype=np.float64)
        angle = angle if angle.ndim == 0 else angle[elements][:, None]
        return np.broadcast_to(rotated(axes, self.axis, angle), (*coordinates.shape, 3))


def _check_radii(polar: FloatArray, radial: FloatArray, sizes: FloatArray) -> None:
    """Raise UndefinedDirectionsError for a point on the polar axis, within rounding of coordinates of these sizes."""
    areas = np.linalg.norm(np.cross(polar, radial), axis=-1)
    wrong = np.argwhere(~(areas > SMALLEST_SINE * sizes * np.linalg.norm(polar, axis=-1)))
    if len(wrong):
        raise UndefinedDirectionsError(tuple(wrong[0].tolist()), "it is on the polar axis")


def _frame(first: FloatArray, second: FloatArray, fault: str = "the points a, b and c are collinear") -> FloatArray:
    """Return (..., 3, 3) right-handed directions: along the first vectors, in the plane with the second ones,
    normal to it.

    Raises UndefinedDirectionsError, with the fault as its message, where they are zero, parallel or no numbers.
    """
    third = np.cross(first, second)
    scale = np.linalg.norm(first, axis=-1) * np.linalg.norm(second, axis=-1)
    flat = np.argwhere(~(np.linalg.norm(third, axis=-1) > SMALLEST_SINE * scale))
    if len(flat):
        raise UndefinedDirectionsError(tuple(flat[0].tolist()), fault)
    axes = np.stack([first, np.cross(third, first), third], axis=-2)
    unit: FloatArray = axes / np.linalg.norm(axes, axis=-1, keepdims=True)
    return unit


def rotated(axes: FloatArray, axis: int, angle: float | FloatArray) -> FloatArray:
    """Turn directions (..., 3, 3), in rows, about one of them, 1 to 3, by an angle in degrees."""
    first, second = axis % 3, (axis + 1) % 3
    radians = np.radians(angle)
    c, s = np.cos(radians)[..., None], np.sin(radians)[..., None]
    turned = np.array(np.broadcast_to(axes, np.broadcast_shapes(axes.shape, (*np.shape(angle), 3, 3))))
    turned[..., first, :] = c * axes[..., first, :] + s * axes[..., second, :]
    turned[..., second, :] = c * axes[..., second, :] - s * axes[..., first, :]
    return turned


def orthonormal(directions: FloatArray) -> FloatArray:
    """Return directions (..., 3, 3) from the first two rows, as ORIENT gives them:
    the second is made normal to the first.

    Raises UndefinedDirectionsError for the first that are no numbers, zero or parallel.
    """
    return _frame(directions[..., 0, :], directions[..., 1, :], "ORIENT does not set two directions in T")
