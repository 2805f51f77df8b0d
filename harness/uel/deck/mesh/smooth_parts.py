# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Smooth parts of a surface: faces that meet at an edge at a large angle belong to different ones."""

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

    nodes    (m,) at which they are, repeated where parts meet
    corners  of faces of each kind (f, k): which of them
    """

    nodes: IntArray
    corners: tuple[IntArray, ...]


def smooth_parts(faces: Sequence[IntArray], coordinates: FloatArray) -> SmoothParts:
    """Cut a surface where the normals of faces that share an edge, in the plane a node, differ by too much.

    Parameters
    ----------
    faces
        Of each kind, lines, triangles or quadrilaterals, as `wound` returns them.
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
    every = np.unique(np.concatenate([own.ravel() for own in keys]))
    return SmoothParts(every % size, tuple(np.searchsorted(every, own) for own in keys))


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
    return _components(graph)


def _components(graph: sparse.coo_array) -> IntArray:
    from scipy.sparse.csgraph import connected_components  # noqa: PLC0415 (few decks have contact)

    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)
