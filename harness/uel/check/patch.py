# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Nodes of the deck that are surrounded by elements of one type: the patches of the patch test."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Final

from uel.model.model import Model

FACES: Final = {
    (2, 3): ((0, 1), (1, 2), (2, 0)),
    (2, 4): ((0, 1), (1, 2), (2, 3), (3, 0)),
    (3, 4): ((0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3)),
    (3, 8): (
        *((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4)),
        *((1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
    ),
}
"""Local corner nodes of the edges or faces of triangles, quads, tetrahedra and bricks, by dimensions and corners."""

CORNERS: Final = {(2, 3): 3, (2, 4): 4, (2, 6): 3, (2, 8): 4, (2, 9): 4, (3, 4): 4, (3, 8): 8, (3, 10): 4, (3, 20): 8}
"""Corner nodes, which come first as in Abaqus' own elements, by dimensions and nodes."""


def patches_of(model: Model, kind: str, dimensions: int) -> Iterator[tuple[int, list[int]]]:
    """Yield corner nodes around which all edges or faces are shared by two elements of a type with equal properties.

    Elements of other types on the same nodes, for plotting, do not count. Yields the node and the positions of its
    elements in the model.
    """
    shared: Counter[tuple[object, frozenset[int]]] = Counter()
    around: dict[int, list[int]] = {}
    faces: dict[int, list[tuple[object, frozenset[int]]]] = {}
    position = -1
    for group in model.groups:
        corners = CORNERS.get((dimensions, group.nodes.shape[1]))
        for nodes in group.nodes.tolist():
            position += 1
            if group.type != kind or corners is None:
                continue
            for local in FACES[dimensions, corners]:
                face = id(group.section), frozenset(nodes[k] for k in local)
                shared[face] += 1
                for k in local:
                    faces.setdefault(nodes[k], []).append(face)
            for node in nodes[:corners]:
                around.setdefault(node, []).append(position)
    for node, positions in around.items():
        if all(shared[face] == 2 for face in faces[node]):
            yield node, positions
