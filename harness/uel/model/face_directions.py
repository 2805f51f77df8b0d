# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Directions s and t in faces of interface elements in space, as the kernels have them (fortran/core/rotation.f90)."""

from __future__ import annotations

from typing import Final

import numpy as np

from uel.model.arrays import FloatArray

LEAST_DEGREES: Final = 5.0
"""Angle between a direction and the normal of a face below which the elements refuse it."""
ALIGNED: Final = 0.1
"""Angle, degrees, between x and the normal within which z takes its place."""


def face_directions(normals: FloatArray, directions: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the directions s and t (..., 3) at points of faces.

    Parameters
    ----------
    normals
        (..., 3) unit normals.
    directions
        (..., 3) directions, of any length, whose projections are s; zero for that of x, or of z where x is along the
        normal. Those along the normal count as zero.
    """
    instead = np.where(degrees_between(normals, np.eye(3)[0])[..., None] < ALIGNED, np.eye(3)[2], np.eye(3)[0])
    beside = np.where(degrees_between(normals, directions)[..., None] > 0.0, directions, instead)
    beside = beside / np.linalg.norm(beside, axis=-1, keepdims=True)
    s = beside - np.sum(beside * normals, axis=-1, keepdims=True) * normals
    s = s / np.linalg.norm(s, axis=-1, keepdims=True)
    return s, np.cross(normals, s)


def degrees_between(normals: FloatArray, directions: FloatArray) -> FloatArray:
    """Return the angles, from 0 to 90 degrees, between the lines of normals and of directions (..., 3); 0 for zeros."""
    across = np.linalg.norm(np.cross(normals, directions), axis=-1)
    return np.asarray(np.degrees(np.arctan2(across, np.abs(np.sum(normals * directions, axis=-1)))))
