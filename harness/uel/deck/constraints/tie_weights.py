# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surface-to-surface ties: the weights with which secondary nodes follow the nodes of faces that do not match.

A secondary node follows the mean of the main surface over its own faces, weighted by its dual shape function psi, which
is biorthogonal to the shape functions N of each face (B.I. Wohlmuth, SIAM Journal on Numerical Analysis 38 (2000),
989-1012):

    u_s = sum over m of c_sm u_m,    c_sm = integral of psi_s N_m / integral of N_s.

The sum of psi is 1, so that a constant traction gives the main nodes the forces that it has on their faces; and psi_s
reproduces linear functions at the node, so that both surfaces follow any linear displacement. Constant stress thus
passes between any faces. A node at which faces meet at an edge follows its nearest point, and the other nodes of its
faces make up for what that leaves (`_moves`). The integrals are exact on flat faces: Gauss points of the parts that
two faces share.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import sparse

from uel.contact import FaceSurface, monomials
from uel.deck.contact.sliding_surfaces import whole_pieces
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import Family

Faces = Mapping[Family, IntArray]
"""Nodes (f, k) of the faces of a surface, by family."""

NATURAL: Final = {
    (1, 2): np.array([[-1.0], [1.0]]),
    (2, 3): np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
    (2, 4): np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]),
}
"""Natural coordinates of the corners of faces, by dimension and number."""
STEEPEST: Final = 0.5
"""Smallest cosine between the normals of two faces that are tied to each other."""
COVERED: Final = 0.01
"""Part of a face that may be without a main face, or have two, as at the edges of curved surfaces."""
SMALL: Final = 1e-9
"""Part of a face, or weight, that is rounding."""
NONE: Final = 1e-3
"""Integral of a shape function over its node's faces, over their area, that has no dual one (corners of six-node
triangles): such a node carries no force of a constant traction."""

SINGULAR: Final = 1e10
"""Condition of the products of the shape functions of a face that has no dual ones."""
LARGEST: Final = 10.0
"""Sum of the magnitudes of weights from which on faces are so distorted that their dual functions mean nothing."""


EDGE: Final = float(np.cos(np.radians(15.0)))
"""Cosine between the normal of a face and the mean at a node beyond which faces meet at an edge there."""
CHUNK: Final = 2**14
"""Pairs of cells that are looked at together."""
AFFINE: Final = 1e-12
"""Distance of a face from a parallelogram, over its size, that is rounding."""


@dataclass(frozen=True, slots=True)
class _Side:
    """A surface, cut into lines or triangles between the corners of its faces.

    corners    (c, 2 or 3, d) of these cells
    natural    (c, 2 or 3, a) natural coordinates there, of the face
    face       (c,) that each is a part of
    affine     (f,) faces of which places are linear in the natural coordinates
    quadratic  whether faces have nodes between their corners
    """

    surface: FaceSurface
    corners: FloatArray
    natural: FloatArray
    face: IntArray
    affine: np.ndarray
    quadratic: bool

    @classmethod
    def of(cls, faces: Faces, places: FloatArray) -> _Side:
        """Cut faces whose nodes are at places (n, d)."""
        surface = FaceSurface(whole_pieces(faces), places)
        corners, natural, numbers, start = [], [], [], 0
        for family, nodes in faces.items():
            parts = [[0, 1, 2], [0, 2, 3]][: family.corners - 2] if family.dimension == 2 else [[0, 1]]
            for part in parts:
                corners.append(places[nodes[:, part]])
                own = NATURAL[family.dimension, family.corners][part]
                natural.append(np.broadcast_to(own, (len(nodes), *own.shape)))
                numbers.append(start + np.arange(len(nodes)))
            start += len(nodes)
        pieces = surface.pieces
        curved = np.einsum("fkp,fkd->fpd", pieces.shapes, places[pieces.nodes])[:, 1 + pieces.low.shape[1] :]
        size = surface.sizes(np.arange(start), np.zeros_like(places))
        affine = np.abs(curved).max(axis=(1, 2), initial=0.0) <= AFFINE * size
        quadratic = any(family.nodes > family.corners for family in faces)
        arrays = np.concatenate(corners), np.concatenate(natural), np.concatenate(numbers)
        return cls(surface, *arrays, np.asarray(affine), quadratic)

    @property
    def nodes(self) -> IntArray:
        """Nodes (f, k) of the faces; faces with fewer repeat the first one."""
        return np.asarray(self.surface.pieces.nodes)

    def areas(self, *, round_axis: bool) -> FloatArray:
        """Return (f,) lengths or areas of the faces; with `round_axis`, multiplied by the radius of their middle."""
        along = self.corners[:, 1:] - self.corners[:, :1]
        if along.shape[1] == 1:
            size = np.linalg.norm(along[:, 0], axis=1)
        else:
            size = 0.5 * np.linalg.norm(np.cross(along[:, 0], along[:, 1]), axis=1)
        if round_axis:
            size = size * self.corners[..., 0].mean(axis=1)
        return np.bincount(self.face, size, len(self.affine)).astype(np.float64)

    def edge_nodes(self, count: int) -> np.ndarray:
        """Return the mask (count,) of the nodes of the model at which faces meet at an angle."""
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
        # normals that all are within half of the angle of their mean
        middle = sums / np.maximum(np.linalg.norm(sums, axis=1), np.finfo(float).tiny)[:, None]
        off = np.einsum("ckd,cd->ck", middle[nodes], normals) < EDGE
        found = np.zeros(count, dtype=np.bool_)
        found[nodes[off]] = True
        return found

    def shapes_at(self, cell: IntArray, points: FloatArray) -> FloatArray:
        """Evaluate the (p, k) shape functions of the faces at points (p, d), each above a cell (p,)."""
        corners, face = self.corners[cell], self.face[cell]
        along = corners[:, 1:] - corners[:, :1]
        parts, left = np.zeros(along.shape[:2]), points - corners[:, 0]
        first, length = _unit(along[:, 0])
        if along.shape[1] == 2:
            slope = np.einsum("pd,pd->p", along[:, 1], first)
            second, height = _unit(along[:, 1] - slope[:, None] * first)
            parts[:, 1] = np.einsum("pd,pd->p", left, second) / height
            left = left - parts[:, 1:] * along[:, 1]
        parts[:, 0] = np.einsum("pd,pd->p", left, first) / length
        steps = self.natural[:, 1:] - self.natural[:, :1]
        natural = self.natural[cell, 0] + np.einsum("pa,pab->pb", parts, steps[cell])
        other = np.flatnonzero(~self.affine[face])
        if len(other):
            natural[other] = self.surface.locate(face[other], points[other])
        shapes = self.surface.pieces.shapes
        return np.asarray(np.einsum("pki,pi->pk", shapes[face], monomials(natural, shapes.shape[2])[0]))


def _unit(vectors: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return vectors (p, d) over their lengths, and the lengths, which are not 0."""
    length = np.maximum(np.linalg.norm(vectors, axis=1), np.finfo(float).tiny)
    return vectors / length[:, None], np.asarray(length)


def surface_weights(
    secondary: Faces,
    main: Faces,
    places: tuple[FloatArray, FloatArray],
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
    places
        (n, d) of all nodes: for the secondary surface, and for the main one.
    nearest
        (n, n) weights of the points of the main surface nearest to secondary nodes.
    tolerance
        Largest distance of faces that are tied to each other.
    round_axis
        Integrate over the circumference, whose radius is the first coordinate.

    Returns
    -------
    tuple[sparse.csr_array, ndarray]
        Weights (n, n), and the nodes (n,) for which they are valid: all of whose faces have a main face opposite.
        Nodes at which faces meet at an edge are not: they follow the nearest points.
    """
    own, others = _Side.of(secondary, places[0]), _Side.of(main, places[1])
    pairs = _near(own, others, tolerance)
    parts = [
        _common(own, others, pairs[:, start : start + CHUNK], round_axis=round_axis)
        for start in range(0, max(pairs.shape[1], 1), CHUNK)
    ]
    face, faced, measure, integrals, squares, products = (
        np.concatenate(part) if len(parts) > 1 else part[0] for part in zip(*parts, strict=True)
    )
    count, n, nodes = len(own.nodes), len(places[0]), own.nodes
    area = own.areas(round_axis=round_axis)
    covered = np.asarray(np.abs(np.bincount(face, measure, count) - area) <= COVERED * area)
    integral, dual = np.zeros(nodes.shape), np.zeros((*nodes.shape, nodes.shape[1]))
    np.add.at(integral, face, integrals)
    np.add.at(dual, face, squares)
    # nodes that fill a row have no shape function
    filled = np.asarray(~own.surface.pieces.shapes.any(axis=2))
    dual += (area[:, None] * filled)[:, :, None] * np.eye(nodes.shape[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        covered &= np.linalg.cond(dual) < SINGULAR
    dual[~covered] = np.eye(nodes.shape[1])
    dual = integral[:, :, None] * np.linalg.inv(dual)
    edge = own.edge_nodes(len(places[0]))[nodes] & ~filled
    moves = _moves(integral, edge, edge | filled)
    entries = np.einsum("pij,pjk->pik", dual[face], products)
    entries += np.einsum("pij,pjk->pik", moves[face], entries)
    rows = np.broadcast_to(nodes[face][:, :, None], entries.shape)
    columns = np.broadcast_to(others.nodes[faced][:, None], entries.shape)
    found = sparse.coo_array((entries.ravel(), (rows.ravel(), columns.ravel())), shape=(n, n)).tocsr()
    moved = moves * integral[:, None]
    rows, columns = np.broadcast_to(nodes[:, :, None], moved.shape), np.broadcast_to(nodes[:, None], moved.shape)
    moved = sparse.coo_array((moved.ravel(), (rows.ravel(), columns.ravel())), shape=(n, n)).tocsr()
    found = found - moved @ nearest
    total, size = np.zeros(n), np.zeros(n)
    np.add.at(total, nodes, integral)
    np.add.at(size, nodes, np.where(filled, 0.0, area[:, None]))
    valid = (size > 0.0) & (np.abs(total) > NONE * size)
    valid[nodes[~covered].ravel()] = valid[nodes[edge]] = False
    spread = np.abs(found).sum(axis=1)
    valid &= spread <= LARGEST * np.abs(total)
    scale = sparse.diags_array(np.where(valid, 1.0 / np.where(valid, total, 1.0), 0.0))
    return _rounded(sparse.csr_array(scale @ found)), valid


def _moves(integral: FloatArray, edge: np.ndarray, other: np.ndarray) -> FloatArray:
    """Return the parts (f, k, k) of the weights of edge nodes that each node of a face receives.

    A node at which faces meet at an edge has a force of each of them, which one row of weights cannot pass on to both
    sides: it follows its nearest point. What a face misses by that, which is zero for linear displacements, goes to its
    other nodes. A face without any leaves it out.
    """
    takes = np.where(other, 0.0, np.abs(integral))
    total = takes.sum(axis=1, keepdims=True)
    takes = takes / np.where(total > 0.0, total, 1.0)
    return np.asarray(takes[:, :, None] * edge[:, None])


def _common(own: _Side, others: _Side, pairs: IntArray, *, round_axis: bool) -> tuple[np.ndarray, ...]:
    """Integrate over the common parts of pairs (2, p) of cells.

    Returns
    -------
    tuple[ndarray, ...]
        Of the pairs that have something in common: the two faces, its length or area, and the integrals of N_i, N_i N_j
        and N_i N_m, where j is a node of the secondary face and m one of the main face.
    """
    cut = _common_lines if own.corners.shape[1] == 2 else _common_triangles
    # Gauss points along each direction, exact for products of two shape functions
    rule = 4 if own.quadratic or others.quadratic else 3
    row, points, weights = cut(own.corners[pairs[0]], others.corners[pairs[1]], rule)
    if round_axis:
        weights = weights * points[:, 0]
    shapes, across = own.shapes_at(pairs[0][row], points), others.shapes_at(pairs[1][row], points)
    weighted = weights[:, None] * shapes
    # the points of a pair follow each other
    start = np.flatnonzero(np.diff(row, prepend=-1))

    def summed(values: FloatArray) -> FloatArray:
        return np.asarray(np.add.reduceat(values, start, axis=0)) if len(start) else values[:0]

    squares, products = (summed(weighted[:, :, None] * one[:, None]) for one in (shapes, across))
    pair = row[start]
    faces = own.face[pairs[0][pair]], others.face[pairs[1][pair]]
    return (*faces, summed(weights), summed(weighted), squares, products)


def _rounded(weights: sparse.csr_array) -> sparse.csr_array:
    """Remove weights that are rounding, and scale the others to a sum of 1."""
    weights.data[np.abs(weights.data) <= SMALL] = 0.0
    weights.eliminate_zeros()
    total = weights.sum(axis=1)
    return sparse.csr_array(sparse.diags_array(1.0 / np.where(total == 0.0, 1.0, total)) @ weights)


def _near(own: _Side, others: _Side, tolerance: float) -> IntArray:
    """Return pairs (2, p) of cells whose boxes, `tolerance` larger, meet."""
    from scipy.spatial import cKDTree  # noqa: PLC0415 (takes 0.2 s, and few decks have ties)

    centres, sizes = [], []
    for one in (own, others):
        centre = one.corners.mean(axis=1)
        centres.append(centre)
        sizes.append(np.linalg.norm(one.corners - centre[:, None], axis=2).max(axis=1))
    reach = sizes[0] + sizes[1].max() + tolerance
    near = cKDTree(centres[1]).query_ball_point(centres[0], reach)
    first = np.repeat(np.arange(len(near)), [len(found) for found in near])
    second = np.concatenate([np.asarray(found, dtype=np.int64) for found in near])
    low, high = ([of(one.corners, axis=1) for one in (own, others)] for of in (np.min, np.max))
    meet = (low[0][first] - tolerance <= high[1][second]).all(axis=1)
    meet &= (low[1][second] - tolerance <= high[0][first]).all(axis=1)
    return np.stack([first[meet], second[meet]])


def _common_lines(lines: FloatArray, others: FloatArray, rule: int) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return Gauss points of the common parts of pairs of lines (p, 2, d): row of the pair, place (g, d), weight."""
    along = lines[:, 1] - lines[:, 0]
    length = np.einsum("pd,pd->p", along, along)
    ends = np.einsum("pkd,pd->pk", others - lines[:, :1], along) / length[:, None]
    across = np.linalg.norm(others[:, 1] - others[:, 0], axis=1)
    level = np.abs(ends[:, 1] - ends[:, 0]) * np.sqrt(length) > STEEPEST * across
    low, high = np.clip(ends.min(axis=1), 0.0, 1.0), np.clip(ends.max(axis=1), 0.0, 1.0)
    row = np.flatnonzero(level & (high - low > SMALL))
    gauss, weight = np.polynomial.legendre.leggauss(rule)
    low, high = low[row, None], high[row, None]
    place = 0.5 * (low + high) + 0.5 * (high - low) * gauss
    points = lines[row, None, 0] + place[..., None] * along[row, None]
    weights = 0.5 * (high - low) * weight * np.sqrt(length[row, None])
    return np.repeat(row, rule), points.reshape(-1, lines.shape[2]), weights.ravel()


def _common_triangles(cells: FloatArray, others: FloatArray, rule: int) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return Gauss points of the common parts of pairs of triangles (p, 3, 3), in the plane of the first ones."""
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
    natural, weight = _triangle_points(rule)
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


def _triangle_points(rule: int) -> tuple[FloatArray, FloatArray]:
    """Return points (g, 2) and weights (g,) of the unit triangle: Gauss points of a square, collapsed."""
    gauss, weight = np.polynomial.legendre.leggauss(rule)
    half, by = 0.5 * (gauss + 1.0), 0.5 * weight
    x, y = np.meshgrid(half, half, indexing="ij")
    return np.stack([x, (1.0 - x) * y], axis=-1).reshape(-1, 2), (np.outer(by * (1.0 - half), by)).ravel()
