# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surface-to-surface ties: weights of main nodes for each secondary node on nonmatching faces.

A secondary node follows the mean of the main surface over its own faces, weighted by its dual shape function psi, which
is biorthogonal to the shape functions N of each face (B.I. Wohlmuth, SIAM Journal on Numerical Analysis 38 (2000),
989-1012):

    u_s = sum over m of c_sm u_m,    c_sm = integral of psi_s N_m / integral of N_s.

The sum of psi is 1, so that a constant traction has consistent forces at the main nodes; psi_s reproduces linear
functions at the node, so that linear displacements are compatible. The patch test thus passes for any faces. A node on
a sharp edge follows its nearest point, and the other nodes of its faces take the difference (`_moves`). Gauss points on
the intersections of faces make the integrals exact on flat faces. Points are projected onto faces as in contact
(`fortran/host/contact/faces.f90`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import sparse

from uel.contact import FaceSurface, monomials
from uel.deck.contact.sliding_surfaces import NATURAL, whole_pieces
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import Family

Faces = Mapping[Family, IntArray]
"""Nodes (f, k) of the faces of a surface, by family."""

STEEPEST: Final = 0.5
"""Smallest cosine between the normals of two tied faces."""
COVERED: Final = 0.01
"""Fraction of a face that may be uncovered, or covered twice, as at the edges of curved surfaces."""
SMALL: Final = 1e-9
"""Fraction of a face, or weight, that is rounding."""
NONE: Final = 1e-3
"""Relative integral of a shape function without a dual function (corners of six-node triangles): a constant traction
has no force at such a node."""

SINGULAR: Final = 1e10
"""Condition number of the mass matrix of a face without dual functions."""
LARGEST: Final = 10.0
"""Largest sum of absolute weights; dual functions of more distorted faces are useless."""


EDGE: Final = float(np.cos(np.radians(15.0)))
"""Cosine between the normal of a face and the nodal mean below which the node is on a sharp edge."""
CHUNK: Final = 2**14
"""Pairs of cells per chunk."""
AFFINE: Final = 1e-12
"""Relative deviation of a face from a parallelogram that is rounding."""


@dataclass(frozen=True, slots=True)
class _Side:
    """A surface, cut into lines or triangles between the corners of its faces.

    corners    (c, 2 or 3, d) of these cells
    natural    (c, 2 or 3, a) natural coordinates there, of the face
    face       (c,) face of each cell
    affine     (f,) faces with an affine map of the natural coordinates
    quadratic  whether faces have midside nodes
    """

    surface: FaceSurface
    corners: FloatArray
    natural: FloatArray
    face: IntArray
    affine: np.ndarray
    quadratic: bool

    @classmethod
    def of(cls, faces: Faces, points: FloatArray) -> _Side:
        """Cut faces into cells; points: (n, d) coordinates of all nodes."""
        surface = FaceSurface(whole_pieces(faces), points)
        corners, natural, numbers, start = [], [], [], 0
        for family, nodes in faces.items():
            cells = [[0, 1, 2], [0, 2, 3]][: family.corners - 2] if family.dimension == 2 else [[0, 1]]
            for cell in cells:
                corners.append(points[nodes[:, cell]])
                local = NATURAL[family.dimension, family.corners][cell]
                natural.append(np.broadcast_to(local, (len(nodes), *local.shape)))
                numbers.append(start + np.arange(len(nodes)))
            start += len(nodes)
        pieces = surface.pieces
        curved = np.einsum("fkp,fkd->fpd", pieces.shapes, points[pieces.nodes])[:, 1 + pieces.low.shape[1] :]
        size = surface.sizes(np.arange(start), np.zeros_like(points))
        affine = np.abs(curved).max(axis=(1, 2), initial=0.0) <= AFFINE * size
        quadratic = any(family.nodes > family.corners for family in faces)
        arrays = np.concatenate(corners), np.concatenate(natural), np.concatenate(numbers)
        return cls(surface, *arrays, np.asarray(affine), quadratic)

    @property
    def nodes(self) -> IntArray:
        """Nodes (f, k) of the faces, padded with the first one."""
        return np.asarray(self.surface.pieces.nodes)

    def areas(self, *, round_axis: bool) -> FloatArray:
        """Return (f,) lengths or areas of the faces, with `round_axis` times the radius of their centre."""
        along = self.corners[:, 1:] - self.corners[:, :1]
        if along.shape[1] == 1:
            size = np.linalg.norm(along[:, 0], axis=1)
        else:
            size = 0.5 * np.linalg.norm(np.cross(along[:, 0], along[:, 1]), axis=1)
        if round_axis:
            size = size * self.corners[..., 0].mean(axis=1)
        return np.bincount(self.face, size, len(self.affine)).astype(np.float64)

    def edge_nodes(self, count: int) -> np.ndarray:
        """Return the mask (count,) of the nodes of the model on sharp edges."""
        along = self.corners[:, 1:] - self.corners[:, :1]
        if along.shape[1] == 1:
            normals = np.stack([along[:, 0, 1], -along[:, 0, 0]], axis=1)
        else:
            normals = np.cross(along[:, 0], along[:, 1])
        normals /= np.maximum(np.linalg.norm(normals, axis=1), np.finfo(float).tiny)[:, None]
        nodes = self.nodes[self.face]
        sums, faces = np.zeros((count, normals.shape[1])), np.zeros(count)
        np.add.at(sums, nodes, normals[:, None])
        np.add.at(faces, nodes, 1.0)
        # mean of the normals at each node
        middle = sums / np.maximum(np.linalg.norm(sums, axis=1), np.finfo(float).tiny)[:, None]
        off = np.einsum("ckd,cd->ck", middle[nodes], normals) < EDGE
        mask = np.zeros(count, dtype=np.bool_)
        mask[nodes[off]] = True
        return mask

    def shapes_at(self, cell: IntArray, points: FloatArray) -> FloatArray:
        """Evaluate the (p, k) shape functions of the faces at points (p, d) of cells (p,)."""
        corners, face = self.corners[cell], self.face[cell]
        along = corners[:, 1:] - corners[:, :1]
        fractions, offset = np.zeros(along.shape[:2]), points - corners[:, 0]
        first, length = _unit(along[:, 0])
        if along.shape[1] == 2:
            slope = np.einsum("pd,pd->p", along[:, 1], first)
            second, height = _unit(along[:, 1] - slope[:, None] * first)
            fractions[:, 1] = np.einsum("pd,pd->p", offset, second) / height
            offset = offset - fractions[:, 1:] * along[:, 1]
        fractions[:, 0] = np.einsum("pd,pd->p", offset, first) / length
        steps = self.natural[:, 1:] - self.natural[:, :1]
        natural = self.natural[cell, 0] + np.einsum("pa,pab->pb", fractions, steps[cell])
        other = np.flatnonzero(~self.affine[face])
        if len(other):
            natural[other] = self.surface.locate(face[other], points[other])
        shapes = self.surface.pieces.shapes
        return np.asarray(np.einsum("pki,pi->pk", shapes[face], monomials(natural, shapes.shape[2])[0]))


def _unit(vectors: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return unit vectors (p, d) and the lengths, at least the smallest number."""
    length = np.maximum(np.linalg.norm(vectors, axis=1), np.finfo(float).tiny)
    return vectors / length[:, None], np.asarray(length)


def surface_weights(
    secondary: Faces,
    main: Faces,
    points: tuple[FloatArray, FloatArray],
    nearest: sparse.csr_array,
    tolerance: float,
    *,
    round_axis: bool,
) -> tuple[sparse.csr_array, np.ndarray]:
    """Compute the weights of main nodes for each secondary node.

    Parameters
    ----------
    secondary, main
        Faces of one dimension.
    points
        (n, d) coordinates of all nodes, for the secondary and for the main surface.
    nearest
        (n, n) weights of the nearest points on the main surface.
    tolerance
        Largest distance of tied faces.
    round_axis
        Integrate over the circumference; the radius is the first coordinate.

    Returns
    -------
    tuple[sparse.csr_array, ndarray]
        Weights (n, n), and the mask (n,) of valid ones: nodes with all faces covered, except those on sharp edges.
    """
    side, opposite = _Side.of(secondary, points[0]), _Side.of(main, points[1])
    pairs = _near(side, opposite, tolerance)
    integrated = [
        _common(side, opposite, pairs[:, start : start + CHUNK], round_axis=round_axis)
        for start in range(0, max(pairs.shape[1], 1), CHUNK)
    ]
    face, faced, measure, integrals, squares, products = (
        np.concatenate(arrays) if len(integrated) > 1 else arrays[0] for arrays in zip(*integrated, strict=True)
    )
    count, n, nodes = len(side.nodes), len(points[0]), side.nodes
    area = side.areas(round_axis=round_axis)
    covered = np.asarray(np.abs(np.bincount(face, measure, count) - area) <= COVERED * area)
    integral, dual = np.zeros(nodes.shape), np.zeros((*nodes.shape, nodes.shape[1]))
    np.add.at(integral, face, integrals)
    np.add.at(dual, face, squares)
    # padding nodes have no shape function
    filled = np.asarray(~side.surface.pieces.shapes.any(axis=2))
    dual += (area[:, None] * filled)[:, :, None] * np.eye(nodes.shape[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        covered &= np.linalg.cond(dual) < SINGULAR
    dual[~covered] = np.eye(nodes.shape[1])
    dual = integral[:, :, None] * np.linalg.inv(dual)
    edge = side.edge_nodes(len(points[0]))[nodes] & ~filled
    moves = _moves(integral, edge, edge | filled)
    entries = np.einsum("pij,pjk->pik", dual[face], products)
    entries += np.einsum("pij,pjk->pik", moves[face], entries)
    rows = np.broadcast_to(nodes[face][:, :, None], entries.shape)
    columns = np.broadcast_to(opposite.nodes[faced][:, None], entries.shape)
    weights = sparse.coo_array((entries.ravel(), (rows.ravel(), columns.ravel())), shape=(n, n)).tocsr()
    moved = moves * integral[:, None]
    rows, columns = np.broadcast_to(nodes[:, :, None], moved.shape), np.broadcast_to(nodes[:, None], moved.shape)
    moved = sparse.coo_array((moved.ravel(), (rows.ravel(), columns.ravel())), shape=(n, n)).tocsr()
    weights = weights - moved @ nearest
    total, size = np.zeros(n), np.zeros(n)
    np.add.at(total, nodes, integral)
    np.add.at(size, nodes, np.where(filled, 0.0, area[:, None]))
    valid = (size > 0.0) & (np.abs(total) > NONE * size)
    valid[nodes[~covered].ravel()] = valid[nodes[edge]] = False
    spread = np.abs(weights).sum(axis=1)
    valid &= spread <= LARGEST * np.abs(total)
    scale = sparse.diags_array(np.where(valid, 1.0 / np.where(valid, total, 1.0), 0.0))
    return _rounded(sparse.csr_array(scale @ weights)), valid


def _moves(integral: FloatArray, edge: np.ndarray, other: np.ndarray) -> FloatArray:
    """Return the fractions (f, k, k) of the weights of edge nodes that the other nodes of a face receive.

    A node on a sharp edge has forces of several faces, which one row of weights cannot distribute: it follows its
    nearest point. The difference, which is zero for linear displacements, goes to the other nodes of each face, if any.
    """
    takes = np.where(other, 0.0, np.abs(integral))
    total = takes.sum(axis=1, keepdims=True)
    takes = takes / np.where(total > 0.0, total, 1.0)
    return np.asarray(takes[:, :, None] * edge[:, None])


def _common(side: _Side, opposite: _Side, pairs: IntArray, *, round_axis: bool) -> tuple[np.ndarray, ...]:
    """Integrate over the common parts of pairs (2, p) of cells.

    Returns
    -------
    tuple[ndarray, ...]
        For pairs that intersect: the two faces, length or area of the intersection, and the integrals of N_i, N_i N_j
        and N_i N_m over it, with j on the secondary and m on the main face.
    """
    cut = _common_lines if side.corners.shape[1] == 2 else _common_triangles
    # Gauss points along each direction, exact for products of two shape functions
    rule = 4 if side.quadratic or opposite.quadratic else 3
    row, points, weights = cut(side.corners[pairs[0]], opposite.corners[pairs[1]], rule)
    if round_axis:
        weights = weights * points[:, 0]
    shapes, across = side.shapes_at(pairs[0][row], points), opposite.shapes_at(pairs[1][row], points)
    weighted = weights[:, None] * shapes
    # points of a pair are consecutive
    start = np.flatnonzero(np.diff(row, prepend=-1))

    def summed(values: FloatArray) -> FloatArray:
        return np.asarray(np.add.reduceat(values, start, axis=0)) if len(start) else values[:0]

    squares, products = (summed(weighted[:, :, None] * values[:, None]) for values in (shapes, across))
    pair = row[start]
    faces = side.face[pairs[0][pair]], opposite.face[pairs[1][pair]]
    return (*faces, summed(weights), summed(weighted), squares, products)


def _rounded(weights: sparse.csr_array) -> sparse.csr_array:
    """Drop weights that are rounding, and normalize the others to a sum of 1."""
    weights.data[np.abs(weights.data) <= SMALL] = 0.0
    weights.eliminate_zeros()
    total = weights.sum(axis=1)
    return sparse.csr_array(sparse.diags_array(1.0 / np.where(total == 0.0, 1.0, total)) @ weights)


def _near(side: _Side, opposite: _Side, tolerance: float) -> IntArray:
    """Return pairs (2, p) of cells whose bounding boxes, enlarged by `tolerance`, intersect."""
    from scipy.spatial import cKDTree  # noqa: PLC0415 (takes 0.2 s, and few decks have ties)

    centres, sizes = [], []
    for surface in (side, opposite):
        centre = surface.corners.mean(axis=1)
        centres.append(centre)
        sizes.append(np.linalg.norm(surface.corners - centre[:, None], axis=2).max(axis=1))
    reach = sizes[0] + sizes[1].max() + tolerance
    near = cKDTree(centres[1]).query_ball_point(centres[0], reach)
    first = np.repeat(np.arange(len(near)), [len(neighbours) for neighbours in near])
    second = np.concatenate([np.asarray(neighbours, dtype=np.int64) for neighbours in near])
    low, high = ([of(surface.corners, axis=1) for surface in (side, opposite)] for of in (np.min, np.max))
    meet = (low[0][first] - tolerance <= high[1][second]).all(axis=1)
    meet &= (low[1][second] - tolerance <= high[0][first]).all(axis=1)
    return np.stack([first[meet], second[meet]])


def _common_lines(lines: FloatArray, others: FloatArray, rule: int) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return Gauss points of the intersections of pairs of lines (p, 2, d): pair, coordinates (g, d), weight."""
    along = lines[:, 1] - lines[:, 0]
    length = np.einsum("pd,pd->p", along, along)
    ends = np.einsum("pkd,pd->pk", others - lines[:, :1], along) / length[:, None]
    across = np.linalg.norm(others[:, 1] - others[:, 0], axis=1)
    level = np.abs(ends[:, 1] - ends[:, 0]) * np.sqrt(length) > STEEPEST * across
    low, high = np.clip(ends.min(axis=1), 0.0, 1.0), np.clip(ends.max(axis=1), 0.0, 1.0)
    row = np.flatnonzero(level & (high - low > SMALL))
    gauss, weight = np.polynomial.legendre.leggauss(rule)
    low, high = low[row, None], high[row, None]
    fraction = 0.5 * (low + high) + 0.5 * (high - low) * gauss
    points = lines[row, None, 0] + fraction[..., None] * along[row, None]
    weights = 0.5 * (high - low) * weight * np.sqrt(length[row, None])
    return np.repeat(row, rule), points.reshape(-1, lines.shape[2]), weights.ravel()


def _common_triangles(cells: FloatArray, others: FloatArray, rule: int) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return Gauss points of the intersections of pairs of triangles (p, 3, 3), in the plane of the first ones."""
    first, normal = cells[:, 1] - cells[:, 0], np.cross(cells[:, 1] - cells[:, 0], cells[:, 2] - cells[:, 0])
    facing = np.cross(others[:, 1] - others[:, 0], others[:, 2] - others[:, 0])
    size = np.linalg.norm(normal, axis=1) * np.linalg.norm(facing, axis=1)
    row = np.flatnonzero(np.abs(np.einsum("pd,pd->p", normal, facing)) > STEEPEST * size)
    cells, others, first, normal = cells[row], others[row], first[row], normal[row]
    axes = np.stack([first, np.cross(normal, first)], axis=1)
    axes /= np.linalg.norm(axes, axis=2)[:, :, None]
    triangle, polygon = (np.einsum("pad,pkd->pka", axes, corners - cells[:, :1]) for corners in (cells, others))
    scale = np.abs(triangle).max(axis=(1, 2))
    for edge in range(3):
        start, end = triangle[:, edge], triangle[:, (edge + 1) % 3]
        inward = np.stack([start[:, 1] - end[:, 1], end[:, 0] - start[:, 0]], axis=1)
        inward /= np.linalg.norm(inward, axis=1)[:, None]
        polygon = _clip(polygon, np.einsum("pa,pka->pk", inward, polygon - start[:, None]), scale)
    # triangles around the first corner; repeated corners make triangles without area
    fan = np.stack([np.broadcast_to(polygon[:, :1], polygon[:, 1:-1].shape), polygon[:, 1:-1], polygon[:, 2:]], axis=2)
    fan_row = np.repeat(np.arange(len(row)), fan.shape[1])
    fan = fan.reshape(-1, 3, 2)
    sides = fan[:, 1:] - fan[:, :1]
    area = np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
    nonzero = area > SMALL * scale[fan_row] ** 2
    fan, area, fan_row = fan[nonzero], area[nonzero], fan_row[nonzero]
    natural, weight = _triangle_points(rule)
    flat = fan[:, None, 0] + np.einsum("ga,fad->fgd", natural, fan[:, 1:] - fan[:, :1])
    points = cells[fan_row, None, 0] + np.einsum("fga,fad->fgd", flat, axes[fan_row])
    weights = area[:, None] * weight
    return np.repeat(row[fan_row], len(weight)), points.reshape(-1, 3), weights.ravel()


def _clip(polygon: FloatArray, inside: FloatArray, scale: FloatArray) -> FloatArray:
    """Clip polygons (p, k, 2) where a linear function, (p, k) at their corners, is negative: (p, 2 k, 2).

    Each edge yields the two ends of its part inside; an edge outside repeats the last corner before it, and a polygon
    outside has no area.
    """
    following, after = np.roll(polygon, -1, axis=1), np.roll(inside, -1, axis=1)
    gap = inside - after
    crosses = (inside * after < 0.0) & (np.abs(gap) > SMALL**2 * scale[:, None])
    fraction = np.where(crosses, inside / np.where(crosses, gap, 1.0), 0.0)
    cut = polygon + fraction[..., None] * (following - polygon)
    begins = np.where((inside >= 0.0)[..., None], polygon, np.where(crosses[..., None], cut, following))
    ends = np.where((after >= 0.0)[..., None], following, cut)
    outside = (inside < 0.0) & ~crosses & (after < 0.0)
    corners = np.stack([begins, ends], axis=2).reshape(len(polygon), 2 * polygon.shape[1], 2)
    away = np.repeat(outside, 2, axis=1)
    # replace corners outside by a corner inside
    first = np.argmax(~away, axis=1)
    anchor = corners[np.arange(len(corners)), first]
    order = np.maximum.accumulate(np.where(away, -1, np.arange(away.shape[1])), axis=1)
    filled = np.where(
        (order >= 0)[..., None], np.take_along_axis(corners, np.maximum(order, 0)[..., None], 1), anchor[:, None]
    )
    filled[away.all(axis=1)] = 0.0
    return filled


def _triangle_points(rule: int) -> tuple[FloatArray, FloatArray]:
    """Return points (g, 2) and weights (g,) of the unit triangle: collapsed Gauss points of a square."""
    gauss, weight = np.polynomial.legendre.leggauss(rule)
    half, by = 0.5 * (gauss + 1.0), 0.5 * weight
    x, y = np.meshgrid(half, half, indexing="ij")
    return np.stack([x, (1.0 - x) * y], axis=-1).reshape(-1, 2), (np.outer(by * (1.0 - half), by)).ravel()
