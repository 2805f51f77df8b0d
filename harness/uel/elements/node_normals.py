# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Normals at nodes that shells, or beams, share."""

from __future__ import annotations

from typing import Final

import numpy as np

from uel.model.arrays import FloatArray, IntArray

LARGEST_ANGLE: Final = 20.0
"""Degrees between normals at a node whose mean is taken."""


def mean_normals(nodes: IntArray, normals: FloatArray, given: FloatArray | None) -> FloatArray:
    """Average the unit normals (k, 3) at the nodes of elements.

    Parameters
    ----------
    nodes
        (k,) of all elements.
    normals
        (k, 3) of the elements there, unit vectors or zero. The mean is that of those that are within 20 degrees
        (Analysis User's Guide, Defining the initial geometry of conventional shell elements; Beam element cross-section
        orientation).
    given
        (n, 3) normals of the deck by node, which take the place of the mean; zero or None: not given.
    """
    order = np.argsort(nodes, kind="stable")
    sorted_nodes = nodes[order]
    begin, count = np.unique(sorted_nodes, return_index=True, return_counts=True)[1:]
    found = np.zeros_like(normals)
    # nodes of as many elements together
    for k in np.unique(count).tolist():
        rows = order[begin[count == k][:, None] + np.arange(k)]
        here = normals[rows]
        alike = np.einsum("nad,nbd->nab", here, here) > np.cos(np.radians(LARGEST_ANGLE))
        found[rows] = np.einsum("nab,nbd->nad", alike, here)
    if given is not None:
        of_node = given[nodes]
        found = np.where(of_node.any(axis=-1, keepdims=True), of_node, found)
    size = np.linalg.norm(found, axis=-1, keepdims=True)
    return np.asarray(found / np.where(size > 0, size, 1.0))
