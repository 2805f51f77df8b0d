# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Anchor points of contact in small sliding: where the main surface faces each node of the secondary surface.

The anchor point of a node is that of the main surface whose normal goes through the node. The normal varies smoothly
over the surface: that of a node is the mean of those of its faces, and between nodes it is interpolated (Abaqus
Analysis User's Guide, "Contact formulations in Abaqus/Standard", small-sliding tracking).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from uel.model.arrays import FloatArray, IntArray
from uel.model.face_shapes import natural_gradients, shape_functions

CANDIDATES: Final = 12
"""Nearest faces that are tried for a node."""
STEPS: Final = 25
"""Most iterations of Newton's method for the anchor point on a face."""
EDGE: Final = 1e-6
"""Tolerance of natural coordinates, from -1 to 1, for a point on an edge of a face."""
EQUAL: Final = 1e-9
"""Relative difference of clearances, over the face size, that is rounding."""
CHUNK: Final = 2**22
"""Distances of nodes and faces per chunk."""


@dataclass(frozen=True, slots=True)
class Anchors:
    """Anchor points of m nodes.

    facing      (m,) whether the main surface faces the node; other values are undefined without
    faces       (m, k) nodes of the face, padded with the first one
    weights     (m, k) of these nodes
    slopes      (m, k, 2) their derivatives by the natural coordinates, of which a line has one
    normals     (m, 3) unit vectors
    clearances  (m,) along the normals, 0 where they are rounding
    """

    facing: np.ndarray
    faces: IntArray
    weights: FloatArray
    slopes: FloatArray
    normals: FloatArray
    clearances: FloatArray


def find_anchors(
    points: FloatArray,
    outward: FloatArray,
    faces: Sequence[tuple[IntArray, FloatArray]],
    coordinates: FloatArray,
    *,
    along: bool = False,
) -> Anchors:
    """Find the anchor points of nodes on the main surface.

    Parameters
    ----------
    points
        (m, 3) coordinates of the nodes.
    outward
        (m, 3) outward normals at the nodes; the normal at the anchor point must be opposite. Zero: any.
    faces
        Lines, triangles or quadrilaterals, by kind: nodes (f, corners), and outward unit normals (f, 3).
    coordinates
        (n, 3) of all nodes.
    along
        Project along `outward`, whose opposite is the normal at the anchor point.
    """
    nodal = nodal_normals(faces, coordinates)
    width = max(nodes.shape[1] for nodes, _ in faces)
    best = Anchors(
        np.zeros(len(points), dtype=np.bool_),
        np.zeros((len(points), width), dtype=np.int64),
        np.zeros((len(points), width)),
        np.zeros((len(points), width, 2)),
        np.zeros_like(points),
        np.full(len(points), np.inf),
    )
    for nodes, _ in faces:
        step = max(1, CHUNK // len(nodes))
        for start in range(0, len(points), step):
            rows = slice(start, start + step)
            chunk = points[rows], outward[rows]
            _improve(best, rows, chunk, nodes, coordinates[nodes], nodal[nodes], along=along)
    return best


def nodal_normals(faces: Sequence[tuple[IntArray, FloatArray]], coordinates: FloatArray) -> FloatArray:
    """Return (n, 3) mean unit normals of the faces at each node; zero at the other nodes."""
    nodal = np.zeros_like(coordinates)
    for nodes, normals in faces:
        for corner in nodes.T:
            np.add.at(nodal, corner, normals)
    length = np.linalg.norm(nodal, axis=1)[:, None]
    nodal /= np.where(length > 0.0, length, 1.0)
    return nodal


def _improve(
    best: Anchors,
    span: slice,
    chunk: tuple[FloatArray, FloatArray],
    nodes: IntArray,
    corners: FloatArray,
    normals: FloatArray,
    *,
    along: bool,
) -> None:
    """Update the anchor points with nearer ones on faces of one kind."""
    points, outward = chunk
    centres = corners.mean(axis=1)
    sizes = np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1)
    distance = np.linalg.norm(points[:, None] - centres, axis=2) - sizes
    count = min(CANDIDATES, len(nodes))
    chosen = np.sort(np.argpartition(distance, count - 1, axis=1)[:, :count], axis=1)
    projection = np.broadcast_to(-outward[:, None, None], corners[chosen].shape) if along else normals[chosen]
    natural, clearance = _project(points[:, None], corners[chosen], projection)
    weights = shape_functions(natural, nodes.shape[1])
    facing = np.einsum("mck,mckd,md->mc", weights, normals[chosen], outward) <= 0.0
    normal = np.einsum("mck,mckd->mcd", weights, projection)
    length = np.linalg.norm(normal, axis=2)
    clearance = clearance * length
    gap = np.einsum("mck,mckd->mcd", weights, corners[chosen]) + clearance[..., None] * normal / length[..., None]
    size = sizes[chosen]
    hit = np.linalg.norm(points[:, None] - gap, axis=2) <= EDGE * size
    hit &= (weights >= -EDGE).all(axis=2) & facing
    distance = np.where(hit, np.abs(clearance), np.inf)
    nearest = distance.min(axis=1, keepdims=True)
    # of equally near faces the first one, independent of rounding
    k = np.argmax(distance <= nearest + EQUAL * size, axis=1)
    rows = np.arange(len(points))
    better = hit[rows, k] & (nearest[:, 0] < np.abs(best.clearances[span]))
    rows, k = rows[better], k[better]
    target = np.arange(best.clearances.size)[span][better]
    width = nodes.shape[1]
    best.facing[target] = True
    best.faces[target] = nodes[chosen[rows, k]][:, :1]
    best.faces[target, :width] = nodes[chosen[rows, k]]
    best.weights[target] = 0.0
    best.weights[target, :width] = weights[rows, k]
    slopes = natural_gradients(natural, width)[rows, k]
    best.slopes[target] = 0.0
    best.slopes[target, :width, : slopes.shape[2]] = slopes
    best.normals[target] = (normal / length[..., None])[rows, k]
    gaps = clearance[rows, k]
    best.clearances[target] = np.where(np.abs(gaps) <= EQUAL * size[rows, k], 0.0, gaps)


def _project(points: FloatArray, corners: FloatArray, normals: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return natural coordinates (m, c, 1 or 2) of anchor points and distances (m, c) in multiples of the interpolated
    normals. Newton's method solves X(place) + distance N(place) = point.
    """
    pairs, count = corners.shape[:2], corners.shape[2]
    along = 1 if count == 2 else 2
    points = np.broadcast_to(points, (*pairs, 3)).reshape(-1, 3)
    corners, normals = (np.reshape(values, (-1, count, 3)) for values in (corners, normals))
    natural = np.zeros((len(points), along)) + (1 / 3 if count == 3 else 0.0)
    distance, rows = np.zeros(len(points)), np.arange(len(points))
    size = np.linalg.norm(corners - corners.mean(axis=1, keepdims=True), axis=2).max(axis=1)
    for _ in range(STEPS):
        shapes, slopes = shape_functions(natural[rows], count), natural_gradients(natural[rows], count)
        normal = np.einsum("pk,pkd->pd", shapes, normals[rows])
        residual = points[rows] - np.einsum("pk,pkd->pd", shapes, corners[rows]) - distance[rows, None] * normal
        offset = corners[rows] + distance[rows, None, None] * normals[rows]
        # lines are in the plane: no third coordinate
        matrix = np.zeros((len(rows), 3, 3))
        matrix[:, 2, 2] = 1.0
        matrix[..., :along] = np.einsum("pka,pkd->pda", slopes, offset)
        matrix[..., along] = normal
        if along == 1:
            matrix[:, 2, :2] = residual[:, 2] = 0.0
        usable = np.abs(np.linalg.det(matrix)) > EQUAL * size[rows] ** along
        change = np.linalg.solve(np.where(usable[:, None, None], matrix, np.eye(3)), residual[..., None])[..., 0]
        change[~usable] = 0.0
        last = natural[rows]
        natural[rows] = np.clip(last + change[:, :along], -3.0, 3.0)
        distance[rows] += change[:, along]
        # convergence is quadratic: the next error is rounding
        moves = np.abs(natural[rows] - last).max(axis=1) > EQUAL
        rows = rows[moves | (np.abs(change[:, along]) > EQUAL * size[rows])]
        if not len(rows):
            break
    return natural.reshape(*pairs, along), distance.reshape(pairs)
