# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surface-to-surface contact in small sliding: clearances are means over the region of a secondary node.

The clearance of a node is the mean over the points of its faces, weighted by its shape function; forces on both
surfaces have the same weights. The patch test passes where the points integrate the shape functions of both surfaces:
in the plane, since segments end at the ends of main faces; in space, with 36 points per face, where the meshes match.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import sparse

from uel.contact import square_samples, triangle_samples
from uel.deck.contact.anchor_points import EDGE, EQUAL, find_anchors, nodal_normals
from uel.model.arrays import FloatArray, IntArray
from uel.model.face_shapes import natural_gradients, shape_functions

ALONG: Final = 6
"""Points of a face along each direction in space; a segment of a line has half of them."""

Faces = Sequence[tuple[IntArray, FloatArray]]


@dataclass(frozen=True, slots=True)
class Averages:
    """Mean clearances of m nodes.

    nodes   (m, n) nodes of each mean, padded
    shares  (m, n) weights of the nodes in the clearance, negative on the main surface
    slopes  (m, n, 1 or 2) weights of the nodes in the tangents of the secondary surface
    normals (m, 3) towards the secondary surface
    facing  (m,) whether the main surface faces the region; other values are undefined without
    """

    nodes: IntArray
    shares: FloatArray
    slopes: FloatArray
    normals: FloatArray
    facing: np.ndarray


def average(secondary: Faces, main: Faces, depth: FloatArray, coordinates: FloatArray) -> tuple[Averages, FloatArray]:
    """Compute the mean clearances of the nodes of a surface, and their tributary areas.

    Parameters
    ----------
    secondary, main
        Lines, triangles or quadrilaterals, by kind: nodes (f, corners), and outward unit normals (f, 3).
    depth
        (n,) factor from the length or area of faces to area, at all nodes.
    coordinates
        (n, 3) of all nodes.
    """
    size = len(coordinates)
    surface_nodes = np.unique(np.concatenate([faces.ravel() for faces, _ in secondary]))
    outward = nodal_normals(secondary, coordinates)
    coefficients = sparse.csr_array((size, size))
    areas = np.zeros(size)
    for faces, normals in secondary:
        face, natural, weight = _points(faces, normals, main, coordinates)
        nodes, shapes = faces[face], shape_functions(natural, faces.shape[1])
        points = np.einsum("pk,pkd->pd", shapes, coordinates[nodes])
        weight = weight * np.einsum("pk,pk->p", shapes, depth[nodes])
        looks = np.einsum("pk,pkd->pd", shapes, outward[nodes])
        anchors = find_anchors(points, looks, main, coordinates, along=True)
        weight = np.where(anchors.facing, weight, 0.0)
        np.add.at(areas, nodes, weight[:, None] * shapes)
        weighted = weight[:, None] * shapes
        coefficients += _products(nodes, weighted, nodes, shapes, size)
        coefficients -= _products(nodes, weighted, anchors.faces, anchors.weights, size)
    facing = areas[surface_nodes] > EQUAL * areas.max(initial=0.0)
    nodes, rows = _rows(coefficients.tocsr(), surface_nodes, np.where(areas > 0.0, areas, 1.0))
    ours = np.isin(nodes, surface_nodes) & (rows > 0.0)
    slopes = _slopes(coordinates[nodes], ours, outward[surface_nodes], lines=secondary[0][0].shape[1] == 2)
    return Averages(nodes, rows, slopes, -outward[surface_nodes], facing), areas[surface_nodes]


def _points(
    faces: IntArray, normals: FloatArray, main: Faces, coordinates: FloatArray
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return face, natural coordinates (p, 1 or 2), and length or area of the points on faces of one kind."""
    corners = faces.shape[1]
    if corners == 2:
        return _on_lines(faces, normals, main, coordinates)
    natural, weight = square_samples(ALONG) if corners == 4 else triangle_samples(ALONG)
    face, natural = np.repeat(np.arange(len(faces)), len(natural)), np.tile(natural, (len(faces), 1))
    tangents = np.einsum("pka,pkd->pad", natural_gradients(natural, corners), coordinates[faces[face]])
    return face, natural, weight * np.linalg.norm(np.cross(tangents[:, 0], tangents[:, 1]), axis=1)


def _on_lines(
    faces: IntArray, normals: FloatArray, main: Faces, coordinates: FloatArray
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return the Gauss points of the segments between the projections of the main nodes onto lines."""
    cutting = np.unique(np.concatenate([nodes.ravel() for nodes, _ in main]))
    looks = nodal_normals(main, coordinates)[cutting]
    cuts = find_anchors(coordinates[cutting], looks, [(faces, normals)], coordinates)
    key = faces[:, 0] * len(coordinates) + faces[:, 1]
    order = np.argsort(key)
    facing = cuts.facing
    cut = order[np.searchsorted(key[order], cuts.faces[facing, 0] * len(coordinates) + cuts.faces[facing, 1])]
    count = np.arange(len(faces))
    face = np.concatenate([count, count, cut])
    fraction = np.concatenate([np.zeros(len(faces)), np.ones(len(faces)), np.clip(cuts.weights[facing, 1], 0.0, 1.0)])
    order = np.lexsort((fraction, face))
    face, fraction = face[order], fraction[order]
    start = np.flatnonzero((face[1:] == face[:-1]) & (fraction[1:] - fraction[:-1] > EDGE))
    gauss, weight = np.polynomial.legendre.leggauss(ALONG // 2)
    low, high = fraction[start], fraction[start + 1]
    middle = 0.5 * (low + high)[:, None] + 0.5 * (high - low)[:, None] * gauss
    length = np.linalg.norm(coordinates[faces[:, 1]] - coordinates[faces[:, 0]], axis=1)
    weights = 0.5 * ((high - low) * length[face[start]])[:, None] * weight
    return np.repeat(face[start], len(gauss)), 2 * middle.reshape(-1, 1) - 1, weights.ravel()


def _products(
    rows_at: IntArray, factors: FloatArray, columns_at: IntArray, values: FloatArray, size: int
) -> sparse.csr_array:
    """Sum over points the products of nodal functions (p, k) and (p, l) as a matrix."""
    rows = np.repeat(rows_at, columns_at.shape[1], axis=1).ravel()
    columns = np.tile(columns_at, (1, rows_at.shape[1])).ravel()
    entries = (factors[:, :, None] * values[:, None]).ravel()
    return sparse.coo_array((entries, (rows, columns)), shape=(size, size)).tocsr()


def _rows(coefficients: sparse.csr_array, surface_nodes: IntArray, areas: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return nodes and weights of each secondary node: itself, the others, then padding with zero weights."""
    chosen = coefficients[surface_nodes]
    counts = np.diff(chosen.indptr)
    rows = np.repeat(np.arange(len(surface_nodes)), counts)
    order = np.lexsort((chosen.indices, chosen.indices != surface_nodes[rows], rows))
    entries = rows, np.arange(len(rows)) - chosen.indptr[rows]
    nodes = np.repeat(surface_nodes[:, None], max(int(counts.max(initial=0)), 1), axis=1)
    values = np.zeros(nodes.shape)
    nodes[entries] = chosen.indices[order]
    values[entries] = chosen.data[order] / areas[surface_nodes][rows]
    return nodes, values


def _slopes(points: FloatArray, ours: np.ndarray, normals: FloatArray, *, lines: bool) -> FloatArray:
    """Return the weights of the surface nodes (ours) in the tangents of the best-fit plane."""
    directions = _directions(normals, lines=lines)
    weight = ours.astype(np.float64)
    centre = np.einsum("mn,mnd->md", weight, points) / np.maximum(weight.sum(axis=1), 1.0)[:, None]
    flat = weight[..., None] * np.einsum("mnd,mad->mna", points - centre[:, None], directions)
    inverse = np.linalg.pinv(np.einsum("mna,mnb->mab", flat, flat))
    return np.asarray(np.einsum("mna,mab->mnb", flat, inverse))


def _directions(normals: FloatArray, *, lines: bool) -> FloatArray:
    """Return (m, 1 or 2, 3) unit vectors perpendicular to the normals and to each other."""
    if lines:
        return np.stack([-normals[:, 1], normals[:, 0], normals[:, 2]], axis=1)[:, None]
    # the axis with the largest angle to the normal
    axes = np.eye(3)[np.abs(normals).argmin(axis=1)]
    first = np.cross(normals, axes)
    first /= np.linalg.norm(first, axis=1)[:, None]
    return np.stack([first, np.cross(normals, first)], axis=1)
