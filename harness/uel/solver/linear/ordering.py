# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Numbering of unknowns for a narrow band."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import reverse_cuthill_mckee

from uel.model.arrays import FloatArray, IntArray
from uel.solver.linear.linear_solver import Pattern


@dataclass(frozen=True, slots=True)
class BandOrdering:
    """Position (n,) of each unknown in the band, the half bandwidth, and the method of the ordering."""

    position: IntArray
    width: int
    method: str


def narrowest(pattern: Pattern) -> BandOrdering:
    """Choose the narrower of reverse Cuthill-McKee and of sorting the nodes along each direction.

    Sorting along a slender body is about half as wide as Cuthill-McKee, whose levels are slanted.
    """
    if not pattern.size:
        return BandOrdering(np.zeros(0, dtype=np.int64), 0, "nothing to order")
    rows = pattern.rows
    graph = pattern.matrix(np.ones(len(pattern.indices)))
    orders = {"reverse Cuthill-McKee": np.asarray(reverse_cuthill_mckee(graph, symmetric_mode=True), dtype=np.int64)}
    if pattern.coordinates is not None:
        extent = np.ptp(pattern.coordinates, axis=0)
        means = graph @ pattern.coordinates / np.diff(pattern.indptr)[:, None]
        for axis in np.flatnonzero(extent > 0.0):
            orders[f"sorted along direction {axis + 1}"] = _sorted_along(pattern.coordinates, means, int(axis))
    best: BandOrdering | None = None
    for method, order in orders.items():
        position = np.empty(pattern.size, dtype=np.int64)
        position[order] = np.arange(pattern.size)
        width = int(np.abs(position[rows] - position[pattern.indices]).max(initial=0))
        if best is None or width < best.width:
            best = BandOrdering(position, width, method)
    assert best is not None
    return best


def _sorted_along(coordinates: FloatArray, means: FloatArray, axis: int) -> IntArray:
    """Order by one coordinate, then by the others, then by the mean of the neighbours for coincident nodes."""
    others = [k for k in range(coordinates.shape[1]) if k != axis]
    # lexsort compares by the last key first; it is stable, so the dofs of a node stay together
    keys = [*means[:, others].T, *coordinates[:, others].T, coordinates[:, axis]]
    return np.lexsort(keys).astype(np.int64)
