# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Values at the nodes and at the centroid of built-in continuum elements, from those at the integration points.

The Abaqus Analysis User's Guide says that values are extrapolated, and not how. Here it is the polynomial in parent
coordinates that has the values of the points: constant from one point, linear in each direction from two, quadratic
from three; linear from the three of a triangle.
"""

from __future__ import annotations

from itertools import product
from typing import Final

import numpy as np

from harness.elements.load_vectors import NODES
from harness.elements.solid import COUPLED, SOLIDS, Solid
from harness.model.arrays import FloatArray

_LINE: Final = {1: (0.0,), 2: (-1 / 3**0.5, 1 / 3**0.5), 3: (-(0.6**0.5), 0.0, 0.6**0.5)}
"""Integration points along a direction (fortran/host/host_shape.f90)."""
_TRIANGLE: Final = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])
_TRIANGLE_POINTS: Final = np.array([[1, 1], [4, 1], [1, 4]]) / 6
"""Parent coordinates of nodes and integration points."""


def at_nodes(type: str) -> FloatArray | None:
    """(nodes, points) matrix from values at the points of a type to those at the nodes; None for other elements."""
    kind = (SOLIDS | COUPLED).get(type)
    if kind is None:
        return None
    if kind.points == 1:
        return np.ones((kind.nodes, 1))
    return _interpolation(kind, _TRIANGLE if _is_triangle(kind) else NODES[kind.dimension][: kind.nodes])


def at_centroid(type: str) -> FloatArray | None:
    """(1, points) matrix from values at the points of a type to that at the centroid; None for other elements."""
    kind = (SOLIDS | COUPLED).get(type)
    if kind is None:
        return None
    if kind.points == 1:
        return np.ones((1, 1))
    return _interpolation(kind, np.full((1, 2), 1 / 3) if _is_triangle(kind) else np.zeros((1, kind.dimension)))


def _is_triangle(kind: Solid) -> bool:
    return kind.nodes == 6


def _interpolation(kind: Solid, places: FloatArray) -> FloatArray:
    """(places, points) values at places of the polynomials that are one at a point and zero at the others."""
    if _is_triangle(kind):
        points, powers = _TRIANGLE_POINTS, np.array([[0, 0], [1, 0], [0, 1]])
    else:
        along = round(kind.points ** (1 / kind.dimension))
        # counted along the first direction first
        points = np.array(list(product(_LINE[along], repeat=kind.dimension)))[:, ::-1]
        powers = np.array(list(product(range(along), repeat=kind.dimension)))
    return np.asarray(np.linalg.solve(_monomials(points, powers).T, _monomials(places, powers).T).T, dtype=np.float64)


def _monomials(places: FloatArray, powers: FloatArray) -> FloatArray:
    """(places, terms) products of powers of the coordinates."""
    terms: FloatArray = np.prod(np.asarray(places)[:, None, :] ** powers[None], axis=-1)
    return terms
