# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Mean normals at the nodes of shells and beams."""

from __future__ import annotations

from typing import Final

import numpy as np

from uel.model.arrays import FloatArray, IntArray

LARGEST_ANGLE: Final = 20.0
"""Largest angle, in degrees, between normals at a node that are averaged."""


def mean_normals(nodes: IntArray, normals: FloatArray, given: FloatArray | None) -> FloatArray:
    """Average the unit normals (k, 3) at the nodes of elements.

    Parameters
    ----------
    nodes
        (k,) nodes of all elements.
    normals
        (k, 3) normals of the elements there, unit vectors or zero. Those within 20 degrees are averaged (Analysis
        User's Guide, Defining the initial geometry of conventional shell elements; Beam element cross-section
        orientation).
    given
        (n, 3) normals of the deck by node, in place of the mean; zero or None without.
    """
    order = np.argsort(nodes, kind="stable")
    sorted_nodes = nodes[order]
    begin, count = np.unique(sorted_nodes, return_index=True, return_counts=True)[1:]
    mean = np.zeros_like(normals)
    # nodes with the same number of elements together
    for k in np.unique(count).tolist():
        rows = order[begin[count == k][:, None] + np.arange(k)]
        here = normals[rows]
        alike = np.einsum("nad,nbd->nab", here, here) > np.cos(np.radians(LARGEST_ANGLE))
        mean[rows] = np.einsum("nab,nbd->nad", alike, here)
    if given is not None:
        of_node = given[nodes]
        mean = np.where(of_node.any(axis=-1, keepdims=True), of_node, mean)
    size = np.linalg.norm(mean, axis=-1, keepdims=True)
    return np.asarray(mean / np.where(size > 0, size, 1.0))
