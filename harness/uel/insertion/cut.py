# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Solids and their faces as arrays, and the mesh cut along some of them.

A node is doubled where the solids around it fall apart: two of them stay together if a chain of faces at the node that
are not cut connects them. So nodes inside a cut are doubled, those at its ends and along a crack front are not, and
where cuts meet, as many nodes arise as there are parts.
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
"""Number that fills rows of nodes that have fewer."""


@dataclass(frozen=True, slots=True)
class Cells:
    """Solids of one family: their numbers (m,) among all solids, and nodes (m, nodes)."""

    family: Family
    numbers: IntArray
    nodes: IntArray


class Solids:
    """All solids of a mesh; faces are numbered type by type and, within a type, face by face.

    points     (nodes, 3) coordinates
    cells      solids by family
    element    (faces,) number of the solid that has the face
    side       (faces,) which of its faces it is, from 0
    nodes      (faces, 8) nodes: corners, then middles of edges, filled with -1
    places     (faces, 8) where these nodes are in the list of the nodes of all solids, one after the other
    corners    (faces,) number of corners
    sizes      (faces,) number of nodes
    pairs      (pairs, 2) faces that two solids share
    """

    def __init__(self, points: FloatArray, cells: Sequence[Cells]) -> None:
        self.points = points
        self.cells = cells
        self.count = sum(len(group.numbers) for group in cells)
        element, side, nodes, places, corners = [], [], [], [], []
        start = 0
        for group in cells:
            own = start + np.arange(group.nodes.size).reshape(group.nodes.shape)
            start += group.nodes.size
            for number, face in enumerate(group.family.faces):
                rows, place = np.full((2, len(group.nodes), WIDEST), NONE)
                rows[:, : len(face)] = group.nodes[:, list(face)]
                place[:, : len(face)] = own[:, list(face)]
                places.append(place)
                element.append(group.numbers)
                side.append(np.full(len(rows), number))
                nodes.append(rows)
                corners.append(np.full(len(rows), group.family.face_family(face).corners))
        self.element, self.side, self.corners = (_joined(parts) for parts in (element, side, corners))
        self.nodes, self.places = (
            np.concatenate([*rows, np.zeros((0, WIDEST), dtype=np.int64)]) for rows in (nodes, places)
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
        found = np.zeros((self.count, 3))
        for group in self.cells:
            found[group.numbers] = self.points[group.nodes[:, : group.family.corners]].mean(axis=1)
        return found

    @cached_property
    def families(self) -> IntArray:
        """Number (solids,) of the family of each."""
        found = np.zeros(self.count, dtype=np.int64)
        for group in self.cells:
            found[group.numbers] = group.family.number
        return found

    def shared_by_three(self) -> IntArray:
        """Return the solids at a face that belongs to more than two."""
        lengths = np.diff([*self._starts, len(self._order)])
        start = int(self._starts[np.argmax(lengths > 2)])
        return self.element[self._order[start : start + 3]]

    def faces_at(self, corners: IntArray) -> IntArray:
        """Find the face with these corners for each row (rows, corners), -1 where there is none."""
        rows = np.full((len(corners), 4), NONE)
        rows[:, : corners.shape[1]] = corners
        rows = np.sort(rows, axis=1)
        order, starts = _equal_rows(np.concatenate([self._keys(), rows]))
        found = np.full(len(rows), NONE)
        lengths = np.diff([*starts, len(order)])
        groups = np.repeat(np.arange(len(starts)), lengths)
        wanted = order >= len(self.element)
        # the order is stable: faces come before the rows that look for them
        first = order[starts][groups[wanted]]
        found[order[wanted] - len(self.element)] = np.where(first < len(self.element), first, NONE)
        return found

    def _keys(self) -> IntArray:
        """Return the corners of each face in ascending order."""
        corners = np.where(np.arange(4) < self.corners[:, None], self.nodes[:, :4], NONE)
        return np.sort(corners, axis=1)


@dataclass(frozen=True, slots=True)
class Cut:
    """A mesh after the cut.

    cells    solids with their nodes after the cut
    origins  (new nodes,) the node of which each new one is the double; numbers of new nodes follow those of the old
    towards  (nodes, old and new, 3) direction from each node at the cut to the solids that have it now
    """

    cells: tuple[Cells, ...]
    origins: IntArray
    towards: FloatArray

    def copies(self, count: int) -> dict[int, list[int]]:
        """Return the new nodes of each node that has any; count: number of old nodes."""
        found: dict[int, list[int]] = {}
        for number, origin in enumerate(self.origins.tolist(), start=count):
            found.setdefault(origin, []).append(number)
        return found


def cut(solids: Solids, cuts: NDArray[np.bool_]) -> Cut:
    """Double the nodes along faces.

    Parameters
    ----------
    solids
        Of the mesh.
    cuts
        (pairs,) which of the pairs of faces are separated.

    Returns
    -------
    Cut
        Around each node, the part with the first of the solids keeps it; the others get new ones.
    """
    touched = np.zeros(len(solids.points) + 1, dtype=bool)
    touched[solids.nodes[solids.pairs[cuts, 0]]] = True
    touched[NONE] = False
    node = _joined([group.nodes.ravel() for group in solids.cells])
    solid = _joined([np.repeat(group.numbers, group.nodes.shape[1]) for group in solids.cells])
    # places in the list of nodes where one at the cut stands, by solids: parts are numbered in this order
    places = np.flatnonzero(touched[node])
    places = places[np.lexsort((solid[places], node[places]))]
    number = np.full(len(node), NONE)
    number[places] = np.arange(len(places))
    whole = _parts(_links(solids, number, np.ones(len(cuts), dtype=bool)), len(places))
    parts = _parts(_links(solids, number, ~cuts), len(places))
    # of the solids that were together at a node before, the part of the first keeps it: a mesh may touch itself there
    stays = np.zeros(parts.max(initial=NONE) + 1, dtype=bool)
    stays[parts[np.unique(whole, return_index=True)[1]]] = True
    news, first = np.unique(parts[~stays[parts]], return_index=True)
    origins = node[places[~stays[parts]][first]]
    count = len(solids.points)
    new_number = np.full(len(stays), NONE)
    new_number[news] = count + np.arange(len(news))
    changed = node.copy()
    changed[places] = np.where(stays[parts], node[places], new_number[parts])
    towards = np.zeros((count + len(news), 3))
    np.add.at(towards, changed[places], solids.centroids[solid[places]] - solids.points[node[places]])
    cells, start = [], 0
    for group in solids.cells:
        cells.append(
            Cells(group.family, group.numbers, changed[start : start + group.nodes.size].reshape(group.nodes.shape))
        )
        start += group.nodes.size
    return Cut(tuple(cells), origins, towards)


def _links(solids: Solids, number: IntArray, which: NDArray[np.bool_]) -> IntArray:
    """Return pairs (links, 2) of numbered places of a node, in two solids that share a face there."""
    pairs = solids.pairs[which]
    # a face has the same nodes in both solids, in another order
    orders = np.argsort(solids.nodes[pairs], axis=2)
    places = np.take_along_axis(solids.places[pairs], orders, axis=2).transpose(0, 2, 1).reshape(-1, 2)
    numbers = np.where(places == NONE, NONE, number[places])
    return numbers[np.all(numbers != NONE, axis=1)]


def _parts(links: IntArray, count: int) -> IntArray:
    """Return the number (count,) of the connected part of each place."""
    from scipy.sparse import coo_array  # noqa: PLC0415 (keeps the command quick)
    from scipy.sparse.csgraph import connected_components  # noqa: PLC0415

    graph = coo_array((np.ones(len(links)), (links[:, 0], links[:, 1])), shape=(count, count))
    found: IntArray = connected_components(graph, directed=False)[1].astype(np.int64)
    return found


def _equal_rows(rows: IntArray) -> tuple[IntArray, IntArray]:
    """Return the order in which equal rows follow each other, earlier ones first, and the start of each run of them."""
    order = np.lexsort(rows.T[::-1])
    ordered = rows[order]
    new = np.ones(len(rows), dtype=bool)
    new[1:] = np.any(ordered[1:] != ordered[:-1], axis=1)
    return order, np.flatnonzero(new)


def _joined(parts: Sequence[IntArray]) -> IntArray:
    return np.concatenate([*parts, np.zeros(0, dtype=np.int64)])
