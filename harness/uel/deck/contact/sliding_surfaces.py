# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Main surfaces of finite sliding from element faces, smoothed in the plane.

A parabola replaces the ends of two adjacent faces: it is tangent to them at a fraction of their lengths from the common
node (Abaqus Analysis User's Guide, "Contact formulations in Abaqus/Standard", smoothing deformable main surfaces).
Forces act on the nodes of one face, as there, so that constant pressures on matching nodes stay constant. Each parabola
is two pieces, one per face.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from scipy import sparse

from uel.contact import monomials, normals_of
from uel.model.arrays import FloatArray, IntArray
from uel.model.contact import Pieces
from uel.model.element_types import Family

Faces = Sequence[tuple[IntArray, FloatArray]]

_QUADRILATERAL = 0.25 * np.array([[1, -1, -1, 1], [1, 1, -1, -1], [1, 1, 1, 1], [1, -1, 1, -1]], dtype=float)
_TRIANGLE = np.array([[1, -1, -1, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 0]], dtype=float)


NATURAL: Final = {
    (1, 2): np.array([[-1.0], [1.0]]),
    (2, 3): np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
    (2, 4): np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]),
}
"""Natural coordinates of the corners of faces, by dimension and number of corners."""


def wound(faces: Faces, coordinates: FloatArray) -> list[IntArray]:
    """Return the corners of faces of each kind, ordered so that the tangents give the outward normals."""
    ordered = []
    for nodes, normals in faces:
        normal = face_normals(coordinates[nodes])
        reversed_faces = np.einsum("fd,fd->f", normal, normals) < 0.0
        ordered.append(np.where(reversed_faces[:, None], nodes[:, ::-1], nodes))
    return ordered


def face_normals(corners: FloatArray) -> FloatArray:
    """Return normals (f, 3) of faces (f, corners, 3) by the order of their corners, not normalized."""
    if corners.shape[1] == 2:
        return np.pad(normals_of(corners[..., :2]), ((0, 0), (0, 1)))
    return normals_of(corners)


def make_pieces(
    faces: Sequence[IntArray],
    coordinates: FloatArray,
    smooth: float,
    zone: float,
    corners: Sequence[IntArray] | None = None,
) -> Pieces:
    """Build the pieces of a surface.

    Parameters
    ----------
    faces
        Lines, triangles or quadrilaterals, by kind, as `wound` returns them.
    coordinates
        (n, 3) of all nodes.
    smooth
        Fraction of a line that a parabola replaces at each end, less than a half.
    zone
        Extension zone beyond free edges, over the length of a face.
    corners
        Corner numbers of the faces, equal where faces are continuous; None: the nodes.
    """
    numbers = faces if corners is None else corners
    if faces[0].shape[1] == 2:
        return _of_lines(faces[0], numbers[0], coordinates, smooth, zone)
    return _of_areas(faces, numbers, zone)


def whole_pieces(faces: Mapping[Family, IntArray]) -> Pieces:
    """Build the patches of a surface without smoothing and edges, from the nodes (f, k) of each family of faces."""
    width = max(family.nodes for family in faces)
    along = next(iter(faces)).dimension
    # pad the nodes with the first one
    nodes = [
        np.concatenate([part, np.repeat(part[:, :1], width - part.shape[1], axis=1)], axis=1) for part in faces.values()
    ]
    count = 3 if along == 1 else 4 if width <= 4 else 8
    shapes, low, total = [], [], []
    for family, part in faces.items():
        coefficients = np.zeros((width, count))
        coefficients[: family.nodes, : family.nodes] = _coefficients(family, count)
        triangle = family.dimension == 2 and family.corners == 3
        shapes.append(np.broadcast_to(coefficients, (len(part), width, count)))
        low.append(np.full((len(part), along), 0.0 if triangle else -1.0))
        total.append(np.full(len(part), 1.0 if triangle else np.inf))
    every, start, most = np.concatenate(nodes), np.concatenate(low), np.concatenate(total)
    without = np.full(start.shape, np.inf)
    all_shapes = np.concatenate(shapes)
    bounds = start, np.ones_like(start), most, -without, without, without[:, 0]
    return Pieces(every, all_shapes, all_shapes, *bounds, _ring(every))


def _coefficients(family: Family, count: int) -> FloatArray:
    """Return (k, k) coefficients of the first k monomials in the shape functions of a face, one row per node."""
    corners = NATURAL[family.dimension, family.corners]
    middles = 0.5 * (corners + np.roll(corners, -1, axis=0))
    points = np.concatenate([corners, middles])[: family.nodes]
    return np.asarray(np.linalg.inv(monomials(points, count)[0][:, : family.nodes]).T, dtype=np.float64)


def _of_lines(lines: IntArray, ends: IntArray, coordinates: FloatArray, smooth: float, zone: float) -> Pieces:
    p, size = len(lines), int(lines.max()) + 1
    first, last = (np.bincount(column, minlength=size) for column in lines.T)
    middle = np.flatnonzero((first == 1) & (last == 1) & (smooth > 0.0))
    rounded, count = np.isin(lines, middle), len(middle)
    into, out = np.zeros(size, dtype=np.int64), np.zeros(size, dtype=np.int64)
    into[lines[:, 1]], out[lines[:, 0]] = lines[:, 0], lines[:, 1]
    corners = np.stack([middle, into[middle], out[middle]], axis=1)
    nodes = np.concatenate([filled([lines]), corners, corners])
    shapes, loads = np.zeros((len(nodes), 3, 3)), np.zeros((len(nodes), 3, 3))
    shapes[:p, 0, :2], shapes[:p, 1, :2] = (0.5, -0.5), (0.5, 0.5)
    before, after, unit = (
        smooth * np.array([1.0, -2.0, 1.0]),
        smooth * np.array([0.0, 0.0, 1.0]),
        np.array([1.0, 0, 0]),
    )
    shapes[p:] = np.stack([unit - before - after, before, after])
    loads[:p] = shapes[:p]
    # distances from the node over the lengths of the two faces
    length = np.linalg.norm(coordinates[corners[:, 1:]] - coordinates[middle][:, None], axis=2)
    ratio = length[:, 1] / length[:, 0]
    loads[p : p + count, 1] = before - ratio[:, None] * after
    loads[p + count :, 2] = after - before / ratio[:, None]
    loads[p:, 0] = unit - loads[p:, 1] - loads[p:, 2]
    low, high = np.zeros(len(nodes)), np.ones(len(nodes))
    low[:p], high[:p] = -1.0 + 2.0 * smooth * rounded[:, 0], 1.0 - 2.0 * smooth * rounded[:, 1]
    high[p : p + count] = low[p + count :] = 1.0 / (1.0 + np.sqrt(ratio))
    free = np.bincount(ends.ravel())[ends] == 1
    reach_low, reach_high = np.full(len(nodes), -np.inf), np.full(len(nodes), np.inf)
    reach_low[:p] = np.where(free[:, 0], -1.0 - 2.0 * zone, -np.inf)
    reach_high[:p] = np.where(free[:, 1], 1.0 + 2.0 * zone, np.inf)
    without = np.full(len(nodes), np.inf)
    bounds = (low[:, None], high[:, None], without, reach_low[:, None], reach_high[:, None], without)
    return Pieces(nodes, shapes, loads, *bounds, _ring(nodes))


def filled(faces: Sequence[IntArray]) -> IntArray:
    """Return corners (p, 4) of triangles and quadrilaterals, or (p, 3) of lines, padded as the nodes of `Pieces`."""
    if faces[0].shape[1] == 2:
        return np.asarray(faces[0][:, [0, 1, 1]])
    return np.concatenate([np.pad(part, ((0, 0), (0, 4 - part.shape[1])), mode="edge") for part in faces])


def _of_areas(faces: Sequence[IntArray], corners: Sequence[IntArray], zone: float) -> Pieces:
    nodes, numbers = filled(faces), filled(corners)
    four = np.concatenate([np.full(len(part), part.shape[1] == 4) for part in faces])
    # edges in the order of the ends: low eta, high xi, high eta, low xi; of a triangle low eta, the total, low xi
    edges = np.sort(
        np.stack([numbers, np.where(four[:, None], np.roll(numbers, -1, axis=1), numbers[:, [1, 2, 0, 0]])]), axis=0
    )
    keys = edges[0] * (int(numbers.max()) + 1) + edges[1]
    edge_keys = np.where(four[:, None] | (np.arange(4) < 3), keys, -1)
    _, index, count = np.unique(edge_keys, return_inverse=True, return_counts=True)
    free = (count[index.reshape(edge_keys.shape)] == 1) & (edge_keys >= 0)
    inside, step = np.where(four, -1.0, 0.0), np.where(four, 2.0, 1.0) * zone
    infinite = np.full(len(nodes), np.inf)
    low, high = np.stack([inside] * 2, axis=1), np.ones((len(nodes), 2))
    low_free = np.stack([np.where(four, free[:, 3], free[:, 2]), free[:, 0]], axis=1)
    high_free = np.stack([free[:, 1] & four, free[:, 2] & four], axis=1)
    shapes = np.where(four[:, None, None], _QUADRILATERAL, _TRIANGLE)
    return Pieces(
        nodes,
        shapes,
        shapes,
        low,
        high,
        np.where(four, infinite, 1.0),
        np.where(low_free, low - step[:, None], -np.inf),
        np.where(high_free, high + step[:, None], np.inf),
        np.where(free[:, 1] & ~four, 1.0 + step, np.inf),
        _ring(nodes),
    )


def _ring(nodes: IntArray) -> IntArray:
    """Return (p, r) the pieces with a common node, including the piece itself, padded with it."""
    p, k = nodes.shape
    of_node = sparse.csr_array((np.ones(p * k, dtype=np.bool_), (np.repeat(np.arange(p), k), nodes.ravel())))
    shared = sparse.csr_array(of_node @ of_node.T)
    shared.sort_indices()
    counts = np.diff(shared.indptr)
    rows = np.repeat(np.arange(p), counts)
    ring = np.repeat(np.arange(p)[:, None], counts.max(), axis=1)
    ring[rows, np.arange(len(rows)) - shared.indptr[rows]] = shared.indices
    return ring
