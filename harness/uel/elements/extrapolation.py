# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Values at the nodes and at the centroid of built-in continuum elements, from those at the integration points.

The Abaqus Analysis User's Guide says that values are extrapolated, but not how. Here the polynomial in parent
coordinates that interpolates the values of the points is extrapolated: constant for one point, linear for two points in
a direction, quadratic for three; linear for the three of a triangle and the four of a tetrahedron.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import BUILT_IN, Family, SolidType
from uel.usersub import _binding


def at_nodes(type: str) -> FloatArray | None:
    """Return the (nodes, points) matrix that extrapolates from the points of a type to the nodes;
    None for other elements.
    """
    kind = BUILT_IN.get(type)
    if not isinstance(kind, SolidType):
        return None
    return _interpolation(kind, _parent_coordinates(kind.family))


def at_centroid(type: str) -> FloatArray | None:
    """Return the (1, points) matrix from values at the points of a type to the centroid; None for other elements."""
    kind = BUILT_IN.get(type)
    if not isinstance(kind, SolidType):
        return None
    return _interpolation(kind, _parent_coordinates(kind.family)[: kind.corners].mean(axis=0, keepdims=True))


def _interpolation(kind: SolidType, coordinates: FloatArray) -> FloatArray:
    """Return (k, points) values, at k coordinates, of polynomials that are one at a point and zero at the others."""
    family = kind.family
    _, shapes, _ = _binding.integration_rule(family.number, kind.points, family.nodes, family.dimension)
    points, powers = shapes @ _parent_coordinates(family), _powers(family, kind.points)
    return np.asarray(
        np.linalg.solve(_monomials(points, powers).T, _monomials(coordinates, powers).T).T, dtype=np.float64
    )


def _parent_coordinates(family: Family) -> FloatArray:
    """Return (nodes, dimension) parent coordinates of the nodes."""
    square = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
    simplex = np.vstack([np.zeros(family.dimension), np.eye(family.dimension)])
    if family.corners == family.dimension + 1:
        corners = simplex
    elif family.dimension == 2:
        corners = square
    else:
        base = square if family.corners == 8 else simplex[:3, :2]
        corners = np.array([(*corner, side) for side in (-1.0, 1.0) for corner in base])
    coordinates = np.vstack([corners, np.zeros((family.nodes - family.corners, family.dimension))])
    for face in family.faces:
        ends = face[: family.face_family(face).corners]
        for k, middle in enumerate(face[len(ends) :]):
            coordinates[middle] = (coordinates[ends[k]] + coordinates[ends[(k + 1) % len(ends)]]) / 2
    return coordinates


def _powers(family: Family, points: int) -> IntArray:
    """Return (points, dimension) powers of the coordinates in the terms of the polynomial."""
    if family.corners == 2**family.dimension:
        return np.array(list(product(range(round(points ** (1 / family.dimension))), repeat=family.dimension)))
    if family.corners == family.dimension + 1:
        return np.vstack([np.zeros((1, family.dimension), dtype=np.int64), np.eye(family.dimension, dtype=np.int64)])[
            :points
        ]
    # a wedge: powers of the triangle, and across it
    of_triangle = [(0, 0), (1, 0), (0, 1)][: 3 if points > 2 else 1]
    return np.array([(*powers, k) for powers in of_triangle for k in range(points // len(of_triangle))])


def _monomials(coordinates: FloatArray, powers: IntArray) -> FloatArray:
    """Return (k, terms) products of powers of k coordinates."""
    terms: FloatArray = np.prod(np.asarray(coordinates)[:, None, :] ** powers[None], axis=-1)
    return terms
