# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surface to surface contact in small sliding: clearances that are means over the region around a secondary node.

The clearance of a node is the mean of that of the points of its faces, weighted by its shape function, and so is the
force on the nodes of both surfaces. A constant pressure thus gives each surface the forces that it has on it, and the
patch test passes, where the points integrate the shape functions of both. In the plane they do, since the ends of faces
of the main surface end their segments; in space a face has 36 points, which are exact where the meshes match.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import sparse

from uel.deck.contact.anchor_points import EDGE, EQUAL, find_anchors, natural_gradients, nodal_normals, shape_functions
from uel.model.arrays import FloatArray, IntArray

ALONG: Final = 6
"""Points of a face along each direction, in space; half of them in a segment of a line."""

Faces = Sequence[tuple[IntArray, FloatArray]]


@dataclass(frozen=True, slots=True)
class Averages:
    """Mean clearances of m nodes.

    nodes   (m, n) nodes that take part, repeated to fill a row
    shares  (m, n) of them in the clearance, those of the main surface negative
    slopes  (m, n, 1 or 2) in the tangents of the secondary surface
    normals (m, 3) towards the secondary surface, thus opposite to its own
    found   (m,) whether the main surface faces any of the region; the other values are meaningless without
    """

    nodes: IntArray
    shares: FloatArray
    slopes: FloatArray
    normals: FloatArray
    found: np.ndarray


def average(secondary: Faces, main: Faces, depth: FloatArray, coordinates: FloatArray) -> tuple[Averages, FloatArray]:
    """Compute the mean clearances of the nodes of a surface, and their tributary areas.

    Parameters
    ----------
    secondary, main
        Of each kind, lines, triangles or quadrilaterals: their nodes (f, corners), and outward unit normals (f, 3).
    depth
        (n,) factor from the length or area of faces to area, at all nodes.
    coordinates
        (n, 3) of all nodes.
    """
    size = len(coordinates)
    own = np.unique(np.concatenate([faces.ravel() for faces, _ in secondary]))
    outward = nodal_normals(secondary, coordinates)
    shares = sparse.csr_array((size, size))
    areas = np.zeros(size)
    for faces, normals in secondary:
        face, place, weight = _points(faces, normals, main, coordinates)
        nodes, shapes = faces[face], shape_functions(place, faces.shape[1])
        points = np.einsum("pk,pkd->pd", shapes, coordinates[nodes])
        weight = weight * np.einsum("pk,pk->p", shapes, depth[nodes])
        looks = np.einsum("pk,pkd->pd", shapes, outward[nodes])
        anchors = find_anchors(points, looks, main, coordinates, along=True)
        weight = np.where(anchors.found, weight, 0.0)
        np.add.at(areas, nodes, weight[:, None] * shapes)
        weighted = weight[:, None] * shapes
        shares += _products(nodes, weighted, nodes, shapes, size)
        shares -= _products(nodes, weighted, anchors.faces, anchors.weights, size)
    found = areas[own] > EQUAL * areas.max(initial=0.0)
    nodes, rows = _rows(shares.tocsr(), own, np.where(areas > 0.0, areas, 1.0))
    ours = np.isin(nodes, own) & (rows > 0.0)
    slopes = _slopes(coordinates[nodes], ours, outward[own], lines=secondary[0][0].shape[1] == 2)
    return Averages(nodes, rows, slopes, -outward[own], found), areas[own]


def _points(
    faces: IntArray, normals: FloatArray, main: Faces, coordinates: FloatArray
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return the integration points of faces of one kind: their face, natural coordinates (p, 1 or 2),
    and length or area.
    """
    corners = faces.shape[1]
    if corners == 2:
        return _on_lines(faces, normals, main, coordinates)
    middles = (np.arange(ALONG) + 0.5) / ALONG
    if corners == 4:
        x, y = np.meshgrid(2 * middles - 1, 2 * middles - 1)
        place, part = np.stack([x.ravel(), y.ravel()], axis=1), 4.0 / ALONG**2
    else:
        # of the triangles into which its sides are cut
        x, y = np.meshgrid(np.arange(ALONG), np.arange(ALONG))
        upward = np.stack([x, y], axis=-1)[x + y < ALONG] + 1 / 3
        downward = np.stack([x, y], axis=-1)[x + y < ALONG - 1] + 2 / 3
        place, part = np.concatenate([upward, downward]) / ALONG, 0.5 / ALONG**2
    face, place = np.repeat(np.arange(len(faces)), len(place)), np.tile(place, (len(faces), 1))
    tangents = np.einsum("pka,pkd->pad", natural_gradients(place, corners), coordinates[faces[face]])
    return face, place, part * np.linalg.norm(np.cross(tangents[:, 0], tangents[:, 1]), axis=1)


def _on_lines(
    faces: IntArray, normals: FloatArray, main: Faces, coordinates: FloatArray
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return the Gauss points of the segments into which the nodes of the main surface cut lines."""
    cutting = np.unique(np.concatenate([nodes.ravel() for nodes, _ in main]))
    looks = nodal_normals(main, coordinates)[cutting]
    cuts = find_anchors(coordinates[cutting], looks, [(faces, normals)], coordinates)
    key = faces[:, 0] * len(coordinates) + faces[:, 1]
    order = np.argsort(key)
    there = cuts.found
    cut = order[np.searchsorted(key[order], cuts.faces[there, 0] * len(coordinates) + cuts.faces[there, 1])]
    count = np.arange(len(faces))
    face = np.concatenate([count, count, cut])
    place = np.concatenate([np.zeros(len(faces)), np.ones(len(faces)), np.clip(cuts.weights[there, 1], 0.0, 1.0)])
    order = np.lexsort((place, face))
    face, place = face[order], place[order]
    start = np.flatnonzero((face[1:] == face[:-1]) & (place[1:] - place[:-1] > EDGE))
    gauss, weight = np.polynomial.legendre.leggauss(ALONG // 2)
    low, high = place[start], place[start + 1]
    middle = 0.5 * (low + high)[:, None] + 0.5 * (high - low)[:, None] * gauss
    length = np.linalg.norm(coordinates[faces[:, 1]] - coordinates[faces[:, 0]], axis=1)
    part = 0.5 * ((high - low) * length[face[start]])[:, None] * weight
    return np.repeat(face[start], len(gauss)), 2 * middle.reshape(-1, 1) - 1, part.ravel()


def _products(left: IntArray, by: FloatArray, right: IntArray, values: FloatArray, size: int) -> sparse.csr_array:
    """Sum over points the products of functions of nodes on the left (p, k) and on the right (p, l)."""
    rows = np.repeat(left, right.shape[1], axis=1).ravel()
    columns = np.tile(right, (1, left.shape[1])).ravel()
    entries = (by[:, :, None] * values[:, None]).ravel()
    return sparse.coo_array((entries, (rows, columns)), shape=(size, size)).tocsr()


def _rows(shares: sparse.csr_array, own: IntArray, areas: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return nodes and shares of each node of the surface: itself, the others, then itself with zero shares."""
    chosen = shares[own]
    counts = np.diff(chosen.indptr)
    rows = np.repeat(np.arange(len(own)), counts)
    order = np.lexsort((chosen.indices, chosen.indices != own[rows], rows))
    places = rows, np.arange(len(rows)) - chosen.indptr[rows]
    nodes = np.repeat(own[:, None], max(int(counts.max(initial=0)), 1), axis=1)
    values = np.zeros(nodes.shape)
    nodes[places] = chosen.indices[order]
    values[places] = chosen.data[order] / areas[own][rows]
    return nodes, values


def _slopes(places: FloatArray, ours: np.ndarray, normals: FloatArray, *, lines: bool) -> FloatArray:
    """Return the weights of the nodes of the surface (ours) in its tangents: those of the best-fit plane."""
    directions = _directions(normals, lines=lines)
    weight = ours.astype(np.float64)
    centre = np.einsum("mn,mnd->md", weight, places) / np.maximum(weight.sum(axis=1), 1.0)[:, None]
    flat = weight[..., None] * np.einsum("mnd,mad->mna", places - centre[:, None], directions)
    inverse = np.linalg.pinv(np.einsum("mna,mnb->mab", flat, flat))
    return np.asarray(np.einsum("mna,mab->mnb", flat, inverse))


def _directions(normals: FloatArray, *, lines: bool) -> FloatArray:
    """Return (m, 1 or 2, 3) unit vectors perpendicular to the normals and to each other."""
    if lines:
        return np.stack([-normals[:, 1], normals[:, 0], normals[:, 2]], axis=1)[:, None]
    # the axis least like the normal
    axes = np.eye(3)[np.abs(normals).argmin(axis=1)]
    first = np.cross(normals, axes)
    first /= np.linalg.norm(first, axis=1)[:, None]
    return np.stack([first, np.cross(normals, first)], axis=1)
