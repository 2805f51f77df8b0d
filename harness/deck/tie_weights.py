# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surface-to-surface ties: the weights with which secondary nodes follow the nodes of faces that do not match.

A secondary node follows the mean of the main surface over its own faces, weighted by its dual shape function psi, which
is biorthogonal to the shape functions N of each face (B.I. Wohlmuth, SIAM Journal on Numerical Analysis 38 (2000),
989-1012):

    u_s = sum over m of c_sm u_m,    c_sm = integral of psi_s N_m / integral of N_s.

The sum of psi is 1, so that a constant traction gives the main nodes the forces that it has on their faces; and psi_s
reproduces linear functions at the node, so that both surfaces follow any linear displacement. Constant stress thus
passes between any faces. The integrals are exact on flat faces: Gauss points of the parts that two faces share.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import sparse

from harness.deck.pieces import whole_pieces
from harness.elements import FaceSurface, weights_of
from harness.model.arrays import FloatArray, IntArray
from harness.model.element_types import Family

Faces = Mapping[Family, IntArray]
"""Nodes (f, k) of the faces of a surface, by family."""

POINTS: Final = 4
"""Gauss points along each direction of a part, exact for products of two quadratic shape functions."""
STEEPEST: Final = 0.5
"""Smallest cosine between the normals of two faces that are tied to each other."""
COVERED: Final = 0.01
"""Part of a face that may be without a main face, or have two, as at the edges of curved surfaces."""
SMALL: Final = 1e-9
"""Part of a face, or weight, that is rounding."""
NONE: Final = 1e-3
"""Integral of a shape function over its node's faces, over their area, that has no dual one (corners of six-node
triangles): such a node carries no force of a constant traction."""

LARGEST: Final = 10.0
"""Sum of the magnitudes of weights from which on faces are so distorted that their dual functions mean nothing."""


@dataclass(frozen=True, slots=True)
class _Cells:
    """Lines or triangles into which faces are cut: corners (c, 2 or 3, d), and the face (c,) of each."""

    corners: FloatArray
    face: IntArray


def surface_weights(
    secondary: Faces, main: Faces, places: tuple[FloatArray, FloatArray], tolerance: float, *, round_axis: bool
) -> tuple[sparse.csr_array, np.ndarray]:
    """Compute the weights of main nodes for each secondary node.

    Parameters
    ----------
    secondary, main
        Faces of one dimension.
    places
        (n, d) of all nodes: for the secondary surface, and for the main one.
    tolerance
        Largest distance of faces that are tied to each other.
    round_axis
        Integrate over the circumference, whose radius is the first coordinate.

    Returns
    -------
    tuple[sparse.csr_array, ndarray]
        Weights (n, n), and the nodes (n,) for which they are valid: all of whose faces have a main face opposite.
    """
    own, others = (FaceSurface(whole_pieces(faces), at) for faces, at in zip((secondary, main), places, strict=True))
    cells, opposite = _cut(secondary, places[0]), _cut(main, places[1])
    pairs = _near(cells, opposite, tolerance)
    cut = _common_lines if cells.corners.shape[1] == 2 else _common_triangles
    row, points, weights = cut(cells.corners[pairs[0]], opposite.corners[pairs[1]])
    face, faced = cells.face[pairs[0]][row], opposite.face[pairs[1]][row]
    if round_axis:
        weights = weights * points[:, 0]
    shapes = weights_of(own.pieces.shapes[face], own.locate(face, points))[0]
    across = weights_of(others.pieces.shapes[faced], others.locate(faced, points))[0]
    area = _areas(cells, len(own.pieces.nodes), round_axis=round_axis)
    count, n = len(own.pieces.nodes), len(places[0])
    covered = np.asarray(np.abs(np.bincount(face, weights, count) - area) <= COVERED * area)
    nodes, integral, dual = (
        own.pieces.nodes,
        np.zeros((count, shapes.shape[1])),
        np.zeros((count, *[shapes.shape[1]] * 2)),
    )
    np.add.at(integral, face, weights[:, None] * shapes)
    np.add.at(dual, face, weights[:, None, None] * shapes[:, :, None] * shapes[:, None])
    # nodes that fill a row have no shape function
    filled = np.asarray(~own.pieces.shapes.any(axis=2))
    dual[filled[:, :, None] & np.eye(shapes.shape[1], dtype=np.bool_)] = 1.0
    dual[~covered] = np.eye(shapes.shape[1])
    dual = integral[:, :, None] * np.linalg.inv(dual)
    psi = np.einsum("pij,pj->pi", dual[face], shapes)
    weighted = weights[:, None] * psi
    rows = np.repeat(nodes[face], across.shape[1], axis=1).ravel()
    columns = np.tile(others.nodes_of(faced), (1, nodes.shape[1])).ravel()
    found = sparse.coo_array(((weighted[:, :, None] * across[:, None]).ravel(), (rows, columns)), shape=(n, n)).tocsr()
    total, size = np.zeros(n), np.zeros(n)
    np.add.at(total, nodes, integral)
    np.add.at(size, nodes, np.where(filled, 0.0, area[:, None]))
    valid = (size > 0.0) & (np.abs(total) > NONE * size)
    valid[nodes[~covered].ravel()] = False
    spread = np.abs(found).sum(axis=1)
    valid &= spread <= LARGEST * np.abs(total)
    scale = sparse.diags_array(np.where(valid, 1.0 / np.where(valid, total, 1.0), 0.0))
    return _rounded(sparse.csr_array(scale @ found)), valid


def _rounded(weights: sparse.csr_array) -> sparse.csr_array:
    """Leave out weights that are rounding, and make the sum of the others 1 again."""
    weights.data[np.abs(weights.data) <= SMALL] = 0.0
    weights.eliminate_zeros()
    total = weights.sum(axis=1)
    return sparse.csr_array(sparse.diags_array(1.0 / np.where(total == 0.0, 1.0, total)) @ weights)


def _cut(faces: Faces, places: FloatArray) -> _Cells:
    """Cut faces into lines or triangles between their corners."""
    corners, numbers, start = [], [], 0
    for family, nodes in faces.items():
        parts = [[0, 1, 2], [0, 2, 3]][: family.corners - 2] if family.dimension == 2 else [[0, 1]]
        for part in parts:
            corners.append(places[nodes[:, part]])
            numbers.append(start + np.arange(len(nodes)))
        start += len(nodes)
    return _Cells(np.concatenate(corners), np.concatenate(numbers))


def _areas(cells: _Cells, count: int, *, round_axis: bool) -> FloatArray:
    """(count,) lengths or areas of faces, times the radius of their middle about an axis."""
    along = cells.corners[:, 1:] - cells.corners[:, :1]
    if along.shape[1] == 1:
        size = np.linalg.norm(along[:, 0], axis=1)
    else:
        size = 0.5 * np.linalg.norm(np.cross(along[:, 0], along[:, 1]), axis=1)
    if round_axis:
        size = size * cells.corners[..., 0].mean(axis=1)
    return np.bincount(cells.face, size, count).astype(np.float64)


def _near(cells: _Cells, others: _Cells, tolerance: float) -> tuple[IntArray, IntArray]:
    """Return pairs of cells whose boxes, `tolerance` larger, meet."""
    from scipy.spatial import cKDTree  # noqa: PLC0415 (takes 0.2 s, and few decks have ties)

    centres, sizes = [], []
    for one in (cells, others):
        centre = one.corners.mean(axis=1)
        centres.append(centre)
        sizes.append(np.linalg.norm(one.corners - centre[:, None], axis=2).max(axis=1))
    reach = sizes[0] + sizes[1].max() + tolerance
    near = cKDTree(centres[1]).query_ball_point(centres[0], reach)
    first = np.repeat(np.arange(len(near)), [len(found) for found in near])
    second = np.concatenate([np.asarray(found, dtype=np.int64) for found in near])
    low, high = ([of(one.corners, axis=1) for one in (cells, others)] for of in (np.min, np.max))
    meet = (low[0][first] - tolerance <= high[1][second]).all(axis=1)
    meet &= (low[1][second] - tolerance <= high[0][first]).all(axis=1)
    return first[meet], second[meet]


def _common_lines(lines: FloatArray, others: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return Gauss points of what pairs of lines (p, 2, d) have in common: row of the pair, place (g, d), weight."""
    along = lines[:, 1] - lines[:, 0]
    length = np.einsum("pd,pd->p", along, along)
    ends = np.einsum("pkd,pd->pk", others - lines[:, :1], along) / length[:, None]
    across = np.linalg.norm(others[:, 1] - others[:, 0], axis=1)
    level = np.abs(ends[:, 1] - ends[:, 0]) * np.sqrt(length) > STEEPEST * across
    low, high = np.clip(ends.min(axis=1), 0.0, 1.0), np.clip(ends.max(axis=1), 0.0, 1.0)
    row = np.flatnonzero(level & (high - low > SMALL))
    gauss, weight = np.polynomial.legendre.leggauss(POINTS)
    low, high = low[row, None], high[row, None]
    place = 0.5 * (low + high) + 0.5 * (high - low) * gauss
    points = lines[row, None, 0] + place[..., None] * along[row, None]
    weights = 0.5 * (high - low) * weight * np.sqrt(length[row, None])
    return np.repeat(row, POINTS), points.reshape(-1, lines.shape[2]), weights.ravel()


def _common_triangles(cells: FloatArray, others: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return Gauss points of what pairs of triangles (p, 3, 3) have in common in the plane of the first ones."""
    first, normal = cells[:, 1] - cells[:, 0], np.cross(cells[:, 1] - cells[:, 0], cells[:, 2] - cells[:, 0])
    facing = np.cross(others[:, 1] - others[:, 0], others[:, 2] - others[:, 0])
    size = np.linalg.norm(normal, axis=1) * np.linalg.norm(facing, axis=1)
    row = np.flatnonzero(np.abs(np.einsum("pd,pd->p", normal, facing)) > STEEPEST * size)
    cells, others, first, normal = cells[row], others[row], first[row], normal[row]
    axes = np.stack([first, np.cross(normal, first)], axis=1)
    axes /= np.linalg.norm(axes, axis=2)[:, :, None]
    own, polygon = (np.einsum("pad,pkd->pka", axes, part - cells[:, :1]) for part in (cells, others))
    scale = np.abs(own).max(axis=(1, 2))
    for edge in range(3):
        start, end = own[:, edge], own[:, (edge + 1) % 3]
        inward = np.stack([start[:, 1] - end[:, 1], end[:, 0] - start[:, 0]], axis=1)
        inward /= np.linalg.norm(inward, axis=1)[:, None]
        polygon = _clip(polygon, np.einsum("pa,pka->pk", inward, polygon - start[:, None]), scale)
    # a fan of triangles around the first corner; corners that are repeated leave triangles without area
    fan = np.stack([np.broadcast_to(polygon[:, :1], polygon[:, 1:-1].shape), polygon[:, 1:-1], polygon[:, 2:]], axis=2)
    fan_row = np.repeat(np.arange(len(row)), fan.shape[1])
    fan = fan.reshape(-1, 3, 2)
    sides = fan[:, 1:] - fan[:, :1]
    area = np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
    kept = area > SMALL * scale[fan_row] ** 2
    fan, area, fan_row = fan[kept], area[kept], fan_row[kept]
    natural, weight = _triangle_points()
    flat = fan[:, None, 0] + np.einsum("ga,fad->fgd", natural, fan[:, 1:] - fan[:, :1])
    points = cells[fan_row, None, 0] + np.einsum("fga,fad->fgd", flat, axes[fan_row])
    weights = area[:, None] * weight
    return np.repeat(row[fan_row], len(weight)), points.reshape(-1, 3), weights.ravel()


def _clip(polygon: FloatArray, inside: FloatArray, scale: FloatArray) -> FloatArray:
    """Cut polygons (p, k, 2) off where a linear function, (p, k) at their corners, is negative: (p, 2 k, 2).

    Each side gives two corners, its part inside; a side outside gives the last corner before it twice, and a polygon
    that is all outside has no area.
    """
    following, after = np.roll(polygon, -1, axis=1), np.roll(inside, -1, axis=1)
    gap = inside - after
    crosses = (inside * after < 0.0) & (np.abs(gap) > SMALL**2 * scale[:, None])
    share = np.where(crosses, inside / np.where(crosses, gap, 1.0), 0.0)
    cut = polygon + share[..., None] * (following - polygon)
    begins = np.where((inside >= 0.0)[..., None], polygon, np.where(crosses[..., None], cut, following))
    ends = np.where((after >= 0.0)[..., None], following, cut)
    outside = (inside < 0.0) & ~crosses & (after < 0.0)
    found = np.stack([begins, ends], axis=2).reshape(len(polygon), 2 * polygon.shape[1], 2)
    away = np.repeat(outside, 2, axis=1)
    # in place of corners outside: one that stays, whichever comes first
    first = np.argmax(~away, axis=1)
    anchor = found[np.arange(len(found)), first]
    order = np.maximum.accumulate(np.where(away, -1, np.arange(away.shape[1])), axis=1)
    filled = np.where(
        (order >= 0)[..., None], np.take_along_axis(found, np.maximum(order, 0)[..., None], 1), anchor[:, None]
    )
    filled[away.all(axis=1)] = 0.0
    return filled


def _triangle_points() -> tuple[FloatArray, FloatArray]:
    """Return points (g, 2) and weights (g,) of the unit triangle: Gauss points of a square, collapsed."""
    gauss, weight = np.polynomial.legendre.leggauss(POINTS)
    half, by = 0.5 * (gauss + 1.0), 0.5 * weight
    x, y = np.meshgrid(half, half, indexing="ij")
    return np.stack([x, (1.0 - x) * y], axis=-1).reshape(-1, 2), (np.outer(by * (1.0 - half), by)).ravel()
