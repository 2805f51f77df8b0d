# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Consistent nodal forces of loads on faces and volumes of built-in continuum elements, in their initial shape."""

from __future__ import annotations

from itertools import product
from typing import Final

import numpy as np

from harness.elements.solid import section_depth, solid_of
from harness.errors import DeckError
from harness.model.arrays import FloatArray, IntArray
from harness.model.mesh import ElementGroup
from harness.model.properties import SolidSection
from harness.model.steps import ElementLoad, LoadKind

SMALLEST_SINE: Final = 1e-10
"""Sine of the angle between a direction and a face's normal below which the direction has no part in the face."""

_LINE = ((-1,), (1,), (0,))
_QUAD = ((-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0))
_HEX = (
    *((-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)),
    *((0, -1, -1), (1, 0, -1), (0, 1, -1), (-1, 0, -1), (0, -1, 1), (1, 0, 1), (0, 1, 1), (-1, 0, 1)),
    *((-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)),
)
NODES: Final = {1: np.array(_LINE), 2: np.array(_QUAD), 3: np.array(_HEX)}
"""Parent coordinates of the nodes, by dimension: corners, then the middles of the edges."""


def unit_forces(
    group: ElementGroup, rows: IntArray, load: ElementLoad, coordinates: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Nodal forces (elements, points, nodes of the face or element, dimension) for magnitudes of one at each point.

    rows are elements of the group. Returns the coordinates of the points (elements, points, 3) too. Raises DeckError
    where the load makes no sense there.
    """
    section = group.section
    assert isinstance(section, SolidSection)
    kind = solid_of(group)
    dimension = kind.dimension
    local = list(load.type.face) or list(range(group.nodes.shape[1]))
    nodes = group.nodes[rows]
    x = coordinates[nodes[:, local], :dimension]
    along = dimension - 1 if load.type.face else dimension
    shapes, derivatives, weights = _rule(along, len(local), axisymmetric=kind.axisymmetric)
    # (elements, points, dimension, along) derivatives of the position
    tangents = np.einsum("mkd,pka->mpda", x, derivatives)
    scale = section_depth(group, section) if dimension == 2 else 1.0
    if load.type.kind is LoadKind.GRAVITY:
        if not section.material.density:
            raise DeckError(load.source, f"GRAV needs *DENSITY, which material {section.material.name} does not have")
        scale *= section.material.density
    if not load.type.face:
        force = np.linalg.det(tangents)[:, :, None] * np.array(load.type.direction)[:dimension]
    else:
        centre = coordinates[nodes, :dimension].mean(axis=1)
        force = _traction(load, _outward(tangents, x.mean(axis=1) - centre))
    places = np.einsum("pk,mkd->mpd", shapes, coordinates[nodes[:, local]])
    if kind.axisymmetric:
        force = places[:, :, :1] * force
    return scale * np.einsum("p,pk,mpd->mpkd", weights, shapes, force), places


def outward_sign(group: ElementGroup, row: int, face: tuple[int, ...], coordinates: FloatArray) -> int:
    """1 where the normal of the order of a face's nodes, to the right of an edge, points out of an element, else -1."""
    dimension = solid_of(group).dimension
    nodes = group.nodes[row]
    x = coordinates[nodes[list(face)], :dimension]
    _, derivatives, _ = _rule(dimension - 1, len(face), axisymmetric=False)
    area = _normal(np.einsum("kd,pka->pda", x, derivatives)).sum(axis=0)
    return 1 if area @ (x.mean(axis=0) - coordinates[nodes, :dimension].mean(axis=0)) > 0 else -1


def _traction(load: ElementLoad, area: FloatArray) -> FloatArray:
    """Force per parent area of a load on a face, from the outward normal (..., dimension) times area."""
    if load.type.kind is LoadKind.PRESSURE:
        return -area
    size = np.linalg.norm(area, axis=-1, keepdims=True)
    direction = np.broadcast_to(np.array(load.type.direction)[: area.shape[-1]], area.shape)
    if load.type.kind is LoadKind.SHEAR:
        normal = area / size
        direction = direction - (direction * normal).sum(axis=-1, keepdims=True) * normal
        length = np.linalg.norm(direction, axis=-1, keepdims=True)
        if (length < SMALLEST_SINE).any():
            raise DeckError(load.source, "TRSHR: the direction is normal to the surface")
        direction = direction / length
    traction: FloatArray = size * direction
    return traction


def _outward(tangents: FloatArray, outside: FloatArray) -> FloatArray:
    """Outward normal times area (..., dimension) of faces; outside: from elements' centres to those of faces."""
    area = _normal(tangents)
    outward: FloatArray = area * np.sign((area * outside[:, None, :]).sum(axis=-1, keepdims=True))
    return outward


def _normal(tangents: FloatArray) -> FloatArray:
    """Normal times area (..., dimension) of faces, from the derivatives of the position."""
    if tangents.shape[-1] == 1:
        return np.stack([tangents[..., 1, 0], -tangents[..., 0, 0]], axis=-1)
    return np.asarray(np.cross(tangents[..., 0], tangents[..., 1]))


def _rule(dimension: int, nodes: int, *, axisymmetric: bool) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Shape functions (points, nodes), derivatives (points, nodes, dimension), weights of a line, face or volume.

    Axisymmetric triangles of 3 nodes have points for a force that varies as the radius does.
    """
    if dimension == 2 and (nodes == 6 or (nodes == 3 and axisymmetric)):
        return _triangle(nodes)
    if nodes == dimension + 1 and dimension > 1:
        derivatives = np.vstack([-np.ones(dimension), np.eye(dimension)])
        return np.full((1, nodes), 1.0 / nodes), derivatives[None], np.array([1.0 / (2 if dimension == 2 else 6)])
    middle = nodes > 2**dimension
    places, line = np.polynomial.legendre.leggauss(3 if middle else 2)
    # counted along the first direction first
    points = np.array(list(product(places, repeat=dimension)))[:, ::-1]
    weights = np.array([np.prod(w) for w in product(line, repeat=dimension)])
    shapes, derivatives = _serendipity(NODES[dimension][:nodes], points, middle=middle)
    return shapes, derivatives, weights


def _triangle(nodes: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Linear or quadratic functions at three points, for which integrals of quadratic ones are exact."""
    slope = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
    area = np.full((3, 3), 1 / 6) + np.eye(3) / 2
    weights = np.full(3, 1 / 6)
    if nodes == 3:
        return area, np.tile(slope, (3, 1, 1)), weights
    following = np.roll(area, -1, axis=1)
    shapes = np.hstack([area * (2 * area - 1), 4 * area * following])
    corners = (4 * area - 1)[:, :, None] * slope
    middles = 4 * (area[:, :, None] * np.roll(slope, -1, axis=0) + following[:, :, None] * slope)
    return shapes, np.concatenate([corners, middles], axis=1), weights


def _serendipity(nodes: FloatArray, points: FloatArray, *, middle: bool) -> tuple[FloatArray, FloatArray]:
    """Functions of the serendipity family: a product over the directions, times a sum in the corners if `middle`."""
    x, a = points[:, None, :], nodes[None].astype(np.float64)
    factor = np.where(a == 0, 1 - x**2, (1 + a * x) / 2)
    slope = np.where(a == 0, -2 * x, a / 2)
    corner = middle & (nodes != 0).all(axis=1)
    total = np.where(corner, (a * x).sum(axis=-1) - (nodes.shape[1] - 1), 1.0)
    derivatives = np.empty((len(points), *nodes.shape))
    for k in range(nodes.shape[1]):
        others = np.delete(factor, k, axis=-1).prod(axis=-1)
        derivatives[..., k] = others * (slope[..., k] * total + np.where(corner, factor[..., k] * a[..., k], 0.0))
    return factor.prod(axis=-1) * total, derivatives
