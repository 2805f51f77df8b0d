# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Solids and their faces as arrays, and cuts of the mesh along faces.

A node is duplicated where the solids around it are no longer connected through uncut faces at the node. Nodes inside a
cut are thus duplicated, nodes at its ends and along a crack front are not, and intersections of cuts get a node for
each connected component.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import Family

WIDEST = 8
"""Nodes of the largest face."""
NONE = -1
"""Padding of rows of nodes."""


@dataclass(frozen=True, slots=True)
class Cells:
    """Solids of one family: their numbers (m,) among all solids, and nodes (m, nodes)."""

    family: Family
    numbers: IntArray
    nodes: IntArray


class Solids:
    """Solids of a mesh; faces are numbered by family, then by side.

    points     (nodes, 3) coordinates
    cells      solids by family
    element    (faces,) number of the solid of the face
    side       (faces,) number of the face in the solid, from 0
    nodes      (faces, 8) nodes: corners, then midside nodes, padded with -1
    positions  (faces, 8) positions of these nodes in the concatenated connectivity of all solids
    corners    (faces,) number of corners
    sizes      (faces,) number of nodes
    pairs      (pairs, 2) coincident faces of two solids
    """

    def __init__(self, points: FloatArray, cells: Sequence[Cells]) -> None:
        self.points = points
        self.cells = cells
        self.count = sum(len(group.numbers) for group in cells)
        element, side, nodes, positions, corners = [], [], [], [], []
        start = 0
        for group in cells:
            numbers = start + np.arange(group.nodes.size).reshape(group.nodes.shape)
            start += group.nodes.size
            for number, face in enumerate(group.family.faces):
                rows, position = np.full((2, len(group.nodes), WIDEST), NONE)
                rows[:, : len(face)] = group.nodes[:, list(face)]
                position[:, : len(face)] = numbers[:, list(face)]
                positions.append(position)
                element.append(group.numbers)
                side.append(np.full(len(rows), number))
                nodes.append(rows)
                corners.append(np.full(len(rows), group.family.face_family(face).corners))
        self.element, self.side, self.corners = (_joined(arrays) for arrays in (element, side, corners))
        self.nodes, self.positions = (
            np.concatenate([*rows, np.zeros((0, WIDEST), dtype=np.int64)]) for rows in (nodes, positions)
        )
        self.sizes = (self.nodes != NONE).sum(axis=1)
        self._order, self._starts = _equal_rows(self._keys())
        lengths = np.diff([*self._starts, len(self._order)])
        first = self._starts[lengths == 2]
        self.pairs = np.sort(np.stack([self._order[first], self._order[first + 1]], axis=1), axis=1)
        self.manifold = bool(np.all(lengths <= 2))

    @cached_property
    def centroids(self) -> FloatArray:
        """Means (solids, 3) of the corners."""
        means = np.zeros((self.count, 3))
        for group in self.cells:
            means[group.numbers] = self.points[group.nodes[:, : group.family.corners]].mean(axis=1)
        return means

    @cached_property
    def families(self) -> IntArray:
        """Family number (solids,) of each solid."""
        numbers = np.zeros(self.count, dtype=np.int64)
        for group in self.cells:
            numbers[group.numbers] = group.family.number
        return numbers

    def shared_by_three(self) -> IntArray:
        """Return three solids with a common face."""
        lengths = np.diff([*self._starts, len(self._order)])
        start = int(self._starts[np.argmax(lengths > 2)])
        return self.element[self._order[start : start + 3]]

    def faces_at(self, corners: IntArray) -> IntArray:
        """Find the face with the corners in each row (rows, corners), -1 without one."""
        rows = np.full((len(corners), 4), NONE)
        rows[:, : corners.shape[1]] = corners
        rows = np.sort(rows, axis=1)
        order, starts = _equal_rows(np.concatenate([self._keys(), rows]))
        faces = np.full(len(rows), NONE)
        lengths = np.diff([*starts, len(order)])
        groups = np.repeat(np.arange(len(starts)), lengths)
        queries = order >= len(self.element)
        # the order is stable: faces precede queries
        first = order[starts][groups[queries]]
        faces[order[queries] - len(self.element)] = np.where(first < len(self.element), first, NONE)
        return faces

    def _keys(self) -> IntArray:
        """Return the sorted corners of each face."""
        corners = np.where(np.arange(4) < self.corners[:, None], self.nodes[:, :4], NONE)
        return np.sort(corners, axis=1)


@dataclass(frozen=True, slots=True)
class Cut:
    """A mesh after the cut.

    cells    solids with their nodes after the cut
    origins  (new nodes,) original of each new node; new nodes are numbered after the old ones
    towards  (old and new nodes, 3) direction from each node at the cut to its solids
    """

    cells: tuple[Cells, ...]
    origins: IntArray
    towards: FloatArray

    def copies(self, count: int) -> dict[int, list[int]]:
        """Return the new nodes of each duplicated node; count: number of old nodes."""
        copies_of: dict[int, list[int]] = {}
        for number, origin in enumerate(self.origins.tolist(), start=count):
            copies_of.setdefault(origin, []).append(number)
        return copies_of


def cut(solids: Solids, cuts: NDArray[np.bool_]) -> Cut:
    """Duplicate the nodes along faces.

    cuts: (pairs,) mask of the pairs of faces to separate. The connected component of the first solid at a node keeps
    the node, the other components get new ones.
    """
    touched = np.zeros(len(solids.points) + 1, dtype=bool)
    touched[solids.nodes[solids.pairs[cuts, 0]]] = True
    touched[NONE] = False
    node = _joined([group.nodes.ravel() for group in solids.cells])
    solid = _joined([np.repeat(group.numbers, group.nodes.shape[1]) for group in solids.cells])
    # positions of nodes at the cut, ordered by solid: components are numbered in this order
    positions = np.flatnonzero(touched[node])
    positions = positions[np.lexsort((solid[positions], node[positions]))]
    number = np.full(len(node), NONE)
    number[positions] = np.arange(len(positions))
    before = _components(_links(solids, number, np.ones(len(cuts), dtype=bool)), len(positions))
    components = _components(_links(solids, number, ~cuts), len(positions))
    # the component of the first solid keeps the node; before the cut there may be several, where a mesh touches itself
    stays = np.zeros(components.max(initial=NONE) + 1, dtype=bool)
    stays[components[np.unique(before, return_index=True)[1]]] = True
    news, first = np.unique(components[~stays[components]], return_index=True)
    origins = node[positions[~stays[components]][first]]
    count = len(solids.points)
    new_number = np.full(len(stays), NONE)
    new_number[news] = count + np.arange(len(news))
    changed = node.copy()
    changed[positions] = np.where(stays[components], node[positions], new_number[components])
    towards = np.zeros((count + len(news), 3))
    np.add.at(towards, changed[positions], solids.centroids[solid[positions]] - solids.points[node[positions]])
    cells, start = [], 0
    for group in solids.cells:
        cells.append(
            Cells(group.family, group.numbers, changed[start : start + group.nodes.size].reshape(group.nodes.shape))
        )
        start += group.nodes.size
    return Cut(tuple(cells), origins, towards)


def _links(solids: Solids, number: IntArray, which: NDArray[np.bool_]) -> IntArray:
    """Return pairs (links, 2) of numbered positions of a node in two solids with a common face."""
    pairs = solids.pairs[which]
    # both solids have the same nodes on a face, in a different order
    orders = np.argsort(solids.nodes[pairs], axis=2)
    positions = np.take_along_axis(solids.positions[pairs], orders, axis=2).transpose(0, 2, 1).reshape(-1, 2)
    numbers = np.where(positions == NONE, NONE, number[positions])
    return numbers[np.all(numbers != NONE, axis=1)]


def _components(links: IntArray, count: int) -> IntArray:
    """Return the number (count,) of the connected component of each position."""
    from scipy.sparse import coo_array  # noqa: PLC0415 (keeps the command quick)
    from scipy.sparse.csgraph import connected_components  # noqa: PLC0415

    graph = coo_array((np.ones(len(links)), (links[:, 0], links[:, 1])), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def _equal_rows(rows: IntArray) -> tuple[IntArray, IntArray]:
    """Return a stable order of rows that groups equal ones, and the start of each group."""
    order = np.lexsort(rows.T[::-1])
    ordered = rows[order]
    new = np.ones(len(rows), dtype=bool)
    new[1:] = np.any(ordered[1:] != ordered[:-1], axis=1)
    return order, np.flatnonzero(new)


def mask_of(indices: IntArray, count: int) -> NDArray[np.bool_]:
    """Return the mask (count,) of indices."""
    mask = np.zeros(count, dtype=bool)
    mask[indices] = True
    return mask


def _joined(arrays: Sequence[IntArray]) -> IntArray:
    return np.concatenate([*arrays, np.zeros(0, dtype=np.int64)])
