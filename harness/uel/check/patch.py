# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Patches of the patch test: nodes of the deck surrounded by elements of one type."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Final

from uel.model.element_types import FAMILIES
from uel.model.model import Model

CORNERS: Final = {(2, 3): 3, (2, 4): 4, (2, 6): 3, (2, 8): 4, (2, 9): 4, (3, 4): 4, (3, 8): 8, (3, 10): 4, (3, 20): 8}
"""Corner nodes, which come first as in Abaqus' own elements, by dimensions and nodes."""


def patches_of(model: Model, kind: str, dimensions: int) -> Iterator[tuple[int, list[int]]]:
    """Yield interior corner nodes of elements of a type with equal properties, with the positions of these elements.

    All edges or faces at such a node belong to two elements. Elements of other types on the same nodes do not count.
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
            for local in FAMILIES[dimensions, corners].faces:
                face = id(group.section), frozenset(nodes[k] for k in local)
                shared[face] += 1
                for k in local:
                    faces.setdefault(nodes[k], []).append(face)
            for node in nodes[:corners]:
                around.setdefault(node, []).append(position)
    for node, positions in around.items():
        if all(shared[face] == 2 for face in faces[node]):
            yield node, positions
