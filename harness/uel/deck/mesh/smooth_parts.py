# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Smooth parts of a surface, separated at sharp edges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from uel.contact import FACING
from uel.deck.contact.sliding_surfaces import face_normals
from uel.model.arrays import FloatArray, IntArray


@dataclass(frozen=True, slots=True)
class SmoothParts:
    """The m corners of the smooth parts of a surface.

    nodes    (m,) node of each corner, repeated at sharp edges
    corners  (f, k) corner numbers of faces, by kind
    """

    nodes: IntArray
    corners: tuple[IntArray, ...]


def smooth_parts(faces: Sequence[IntArray], coordinates: FloatArray) -> SmoothParts:
    """Split a surface where the normals of adjacent faces differ by too much.

    Parameters
    ----------
    faces
        Lines, triangles or quadrilaterals, by kind, as `wound` returns them.
    coordinates
        (n, 3) of all nodes.
    """
    size = len(coordinates)
    normals = np.concatenate([face_normals(coordinates[nodes]) for nodes in faces])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    part = _parts(_edges(faces, size), normals)
    keys, first = [], 0
    for nodes in faces:
        keys.append(part[first : first + len(nodes), None] * size + nodes)
        first += len(nodes)
    unique_keys = np.unique(np.concatenate([face_keys.ravel() for face_keys in keys]))
    return SmoothParts(unique_keys % size, tuple(np.searchsorted(unique_keys, face_keys) for face_keys in keys))


def _edges(faces: Sequence[IntArray], size: int) -> IntArray:
    """Return (e, 2) pairs of faces that share an edge."""
    keys, owners, first = [], [], 0
    for nodes in faces:
        lines = nodes.shape[1] == 2
        other = nodes if lines else np.roll(nodes, -1, axis=1)
        keys.append((np.minimum(nodes, other) * size + np.maximum(nodes, other)).ravel())
        owners.append(np.repeat(first + np.arange(len(nodes)), nodes.shape[1]))
        first += len(nodes)
    key, owner = np.concatenate(keys), np.concatenate(owners)
    order = np.argsort(key, kind="stable")
    key, owner = key[order], owner[order]
    same = np.flatnonzero(key[1:] == key[:-1])
    return np.stack([owner[same], owner[same + 1]], axis=1)


def _parts(edges: IntArray, normals: FloatArray) -> IntArray:
    """Return (f,) number of the smooth part of each face."""
    smooth = np.einsum("ed,ed->e", normals[edges[:, 0]], normals[edges[:, 1]]) > FACING
    ends = edges[smooth]
    graph = sparse.coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(len(normals),) * 2)
    from scipy.sparse.csgraph import connected_components  # noqa: PLC0415 (few decks have contact)

    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)
