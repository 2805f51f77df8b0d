# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Geometric corrections of contact: surfaces whose faces approximate circles, surfaces of revolution, spheres and tori.

The distance of a point of a face from the centre, the axis or the circle of centres is corrected along the normal to
the interpolated distance of the nodes (Abaqus Analysis User's Guide, "Smoothing contact surfaces in Abaqus/Standard").
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from uel.contact.face_surface import FaceSurface
from uel.contact.shape_functions import weights_of
from uel.model.arrays import FloatArray, IntArray
from uel.model.contact import Pieces, Rounded


def corrections(
    rounded: Sequence[Rounded], pieces: Pieces, coordinates: FloatArray, points: tuple[IntArray, FloatArray]
) -> FloatArray:
    """Compute the distances of curved surfaces from points (m,) of their faces, undeformed.

    Parameters
    ----------
    rounded
        Curved surfaces of the pieces.
    pieces, coordinates
        Pieces of the surface, and (n, d) coordinates of all nodes.
    points
        Pieces (m,) and natural coordinates (m, a) of the points.
    """
    piece, natural = points
    values, surface = np.zeros(len(piece)), FaceSurface(pieces, coordinates)
    for shape in rounded:
        rows = np.flatnonzero(np.isin(piece, shape.pieces))
        at = surface.at(piece[rows], natural[rows], np.zeros_like(coordinates))
        weights = weights_of(pieces.shapes[piece[rows]], natural[rows])[0]
        of_nodes, _ = _distances(shape, coordinates[pieces.nodes[piece[rows]]])
        of_points, away = _distances(shape, at.at)
        deviation = np.einsum("mk,mk->m", weights, of_nodes) - of_points
        values[rows] = deviation * np.einsum("md,md->m", away, at.normal)
    return values


def _distances(shape: Rounded, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return distances (...,) of points (..., d) from the centre, axis or circle of centres,
    and their gradients (..., d).
    """
    offset = points - shape.centre
    height = offset @ shape.axis
    across = offset - height[..., None] * shape.axis
    outside = np.linalg.norm(across, axis=-1)
    outward = across / np.where(outside > 0.0, outside, 1.0)[..., None]
    if shape.radius is None:
        return outside, outward
    distance = np.hypot(outside - shape.radius, height)
    away = (outside - shape.radius)[..., None] * outward + height[..., None] * shape.axis
    return distance, away / np.where(distance > 0.0, distance, 1.0)[..., None]
