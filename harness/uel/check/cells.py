# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Integrals of the shape function gradients of common cells: nodal forces of a uniform stress."""

from __future__ import annotations

from itertools import product
from typing import Final

import numpy as np

from uel.check.subject import diagonal
from uel.model.arrays import FloatArray

POINTS: Final = 4
"""Integration points in each direction: exact to degree 7, more than any of these integrals needs."""

FLAT: Final = 1e-2
"""Volume, over that of a cube with the diagonal of the cell, below which four nodes in space are no tetrahedron but a
face that is not quite plane."""

_QUAD: Final = ((-1, -1), (1, -1), (1, 1), (-1, 1))
_BRICK: Final = (*((*corner, -1) for corner in _QUAD), *((*corner, 1) for corner in _QUAD))
_TRIANGLE: Final = ((0, 0), (1, 0), (0, 1))
_TETRAHEDRON: Final = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))

_RING: Final = ((0, 1), (1, 2), (2, 3), (3, 0))
_EDGES: Final = {
    (2, 6): ((0, 1), (1, 2), (2, 0)),
    (2, 8): _RING,
    (2, 9): _RING,
    (3, 10): ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
    (3, 20): (*_RING, *((i + 4, j + 4) for i, j in _RING), (0, 4), (1, 5), (2, 6), (3, 7)),
}
"""Corners between which the midside nodes are, in Abaqus' order, by dimensions and nodes."""

_CORNERS: Final = {
    (2, 3): _TRIANGLE,
    (2, 6): _TRIANGLE,
    (2, 4): _QUAD,
    (2, 8): _QUAD,
    (2, 9): _QUAD,
    (3, 4): _TETRAHEDRON,
    (3, 10): _TETRAHEDRON,
    (3, 8): _BRICK,
    (3, 20): _BRICK,
}
"""Natural coordinates of the corners."""


def gradient_integrals(points: FloatArray) -> FloatArray | None:
    """Return the integrals (nodes, dimensions) of dN/dx over the cell of nodes (nodes, dimensions) in Abaqus' order.

    Their products with a uniform stress are its nodal forces. None if the nodes are no known cell, or a degenerate or
    inverted one.
    """
    nodes, dimensions = points.shape
    key = dimensions, nodes
    if key not in _CORNERS:
        return None
    corners = np.array(_CORNERS[key], dtype=float)
    natural = np.array([*corners, *((corners[i] + corners[j]) / 2 for i, j in _EDGES.get(key, ()))])
    if key == (2, 9):
        natural = np.vstack([natural, np.zeros(2)])
    simplex = len(corners) == dimensions + 1
    powers = _powers(key, simplex=simplex)
    weights_of = np.linalg.inv(np.prod(natural[:, None, :] ** powers, axis=2))
    total, volume = np.zeros((nodes, dimensions)), 0.0
    for natural_point, weight in _rule(dimensions, simplex=simplex):
        slopes = weights_of.T @ _slopes(natural_point, powers)
        jacobian = points.T @ slopes
        size = float(np.linalg.det(jacobian))
        if size <= 0.0:
            return None
        total += weight * size * slopes @ np.linalg.inv(jacobian)
        volume += weight * size
    return None if volume < FLAT * (diagonal(points) / np.sqrt(dimensions)) ** dimensions else total


def _powers(key: tuple[int, int], *, simplex: bool) -> np.ndarray:
    """Return the exponents (nodes, dimensions) of the monomials of the shape functions."""
    dimensions, nodes = key
    quadratic = key in _EDGES
    every = np.array(list(product(range(3 if quadratic else 2), repeat=dimensions)))
    degree = every.sum(axis=1)
    if simplex:
        chosen = degree <= (2 if quadratic else 1)
    else:
        # serendipity: at most one factor is a square, and the other ones are linear
        chosen = (np.where(every > 1, every, 0).sum(axis=1) <= 2) | (nodes == 9)
    return np.asarray(every[chosen])


def _slopes(natural_point: FloatArray, powers: np.ndarray) -> FloatArray:
    """Return the derivatives (monomials, dimensions) of the monomials at a point."""
    columns = []
    for direction in range(len(natural_point)):
        lower = powers.copy()
        lower[:, direction] = np.maximum(lower[:, direction] - 1, 0)
        columns.append(powers[:, direction] * np.prod(natural_point**lower, axis=1))
    return np.array(columns).T


def _rule(dimensions: int, *, simplex: bool) -> list[tuple[FloatArray, float]]:
    """Return points and weights of an integration rule; for simplices that of the collapsed box."""
    gauss, weights = np.polynomial.legendre.leggauss(POINTS)
    rule = []
    for chosen in product(range(POINTS), repeat=dimensions):
        point, weight = gauss[list(chosen)], float(np.prod(weights[list(chosen)]))
        if simplex:
            remaining = 1.0
            point, weight = (point + 1.0) / 2.0, weight / 2.0**dimensions
            for direction in range(dimensions):
                weight *= remaining
                point[direction] *= remaining
                remaining -= point[direction]
        rule.append((point, weight))
    return rule
