# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Parts of the interface elements of a job: those that share nodes, and each of several on the same nodes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from uel.model.arrays import IntArray


def parts(faces: IntArray, nodes: int) -> list[NDArray[np.bool_]]:
    """Return masks (m,) of the elements of each part, in the order of their first elements.

    Elements that share a node are one part. Where several have the same nodes, as those of two laws side by side, they
    belong to different parts.

    Parameters
    ----------
    faces
        (m, k) nodes of the elements on one side of the interface.
    nodes
        Nodes of the model.
    """
    found = []
    layers = _layers(faces)
    for layer in range(int(layers.max(initial=-1)) + 1):
        own = np.flatnonzero(layers == layer)
        rows = np.repeat(np.arange(len(own)), faces.shape[1])
        touching = coo_array((np.ones(rows.size), (rows, faces[own].ravel())), shape=(len(own), nodes)).tocsr()
        count, member = connected_components(touching @ touching.T, directed=False)
        for number in range(count):
            mask = np.zeros(len(faces), dtype=bool)
            mask[own[member == number]] = True
            found.append(mask)
    return sorted(found, key=lambda mask: int(np.argmax(mask)))


def _layers(faces: IntArray) -> IntArray:
    """Return how many elements before each one (m,) have the same nodes."""
    _, same = np.unique(np.sort(faces, axis=1), axis=0, return_inverse=True)
    return occurrences(same.ravel())


def occurrences(numbers: IntArray) -> IntArray:
    """Return how many equal numbers come before each one (m,)."""
    order = np.argsort(numbers, kind="stable")
    starts = np.flatnonzero(np.diff(numbers[order], prepend=numbers[order[:1]] - 1))
    before = np.empty(len(numbers), dtype=np.int64)
    before[order] = np.arange(len(numbers)) - np.repeat(starts, np.diff(np.append(starts, len(numbers))))
    return before
