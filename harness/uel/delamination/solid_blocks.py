# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Blocks of continuum elements of any family on a grid of cells.

A cell of a grid is one quad or brick, two triangles, two wedges or six tetrahedra.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import CONTINUUM, Family

Corner = tuple[int, ...]

_TRIANGLES: tuple[tuple[Corner, ...], ...] = (((0, 0), (1, 0), (1, 1)), ((0, 0), (1, 1), (0, 1)))
_QUADRILATERAL: tuple[tuple[Corner, ...], ...] = (((0, 0), (1, 0), (1, 1), (0, 1)),)
_CUBE: tuple[tuple[Corner, ...], ...] = (
    ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)),
)
_WEDGES = tuple(tuple((*corner, height) for height in (0, 1) for corner in triangle) for triangle in _TRIANGLES)


def _paths() -> Iterator[tuple[Corner, ...]]:
    """Yield the tetrahedra along the edges from one corner of a cube to the opposite one, with positive volumes."""
    for order in itertools.permutations(range(3)):
        corners = np.array([[0, 0, 0], *np.cumsum(np.eye(3, dtype=int)[list(order)], axis=0)])
        if np.linalg.det(corners[1:]) < 0:
            corners = corners[[0, 2, 1, 3]]
        yield tuple(map(tuple, corners.tolist()))


_CELLS = {
    (2, 3): _TRIANGLES,
    (2, 4): _QUADRILATERAL,
    (3, 4): tuple(_paths()),
    (3, 6): _WEDGES,
    (3, 8): _CUBE,
}
"""Corners of the elements of a cell, 0 or 1 along each direction, by the dimension and the corners of an element."""


@dataclass(frozen=True, slots=True)
class SolidBlock:
    """Solids of one type: nodes (n, dimension), elements (m, nodes of the type) that count nodes from 0.

    cell  (m, dimension) cell of the grid that each element is in
    """

    nodes: FloatArray
    elements: IntArray
    cell: IntArray


def block(kind: str, edges: Sequence[FloatArray]) -> SolidBlock:
    """Fill a grid with elements of a type; edges: of the cells along each direction, ascending."""
    family = CONTINUUM[kind].family
    elements, cell = corner_elements(family, [len(values) - 1 for values in edges])
    nodes = np.stack([values.ravel(order="F") for values in np.meshgrid(*edges, indexing="ij")], axis=-1)
    return SolidBlock(*with_middles(family, nodes, elements), cell)


def corner_elements(family: Family, counts: Sequence[int]) -> tuple[IntArray, IntArray]:
    """Return corners (m, corners) of the elements of a grid, and their cells (m, dimension).

    Corners of the grid count from 0, first along the first direction.
    """
    strides = np.cumprod([1, *(np.asarray(counts[:-1]) + 1)])
    cells = np.array(list(itertools.product(*(range(count) for count in counts[::-1]))))[:, ::-1]
    pattern = np.array(_CELLS[family.dimension, family.corners])
    elements = ((cells[:, None, None, :] + pattern[None]) @ strides).reshape(-1, family.corners)
    return elements, np.repeat(cells, len(pattern), axis=0)


def with_middles(family: Family, nodes: FloatArray, elements: IntArray) -> tuple[FloatArray, IntArray]:
    """Add nodes in the middles of the edges, where a family has them; nodes (n, dimension), elements (m, corners)."""
    if family.nodes == family.corners:
        return nodes, elements
    edges = {}
    for face in family.faces:
        corners = len(face) // 2 if family.dimension == 3 else 2
        for k in range(corners if family.dimension == 3 else 1):
            edges[face[corners + k]] = face[k], face[(k + 1) % corners]
    pairs = np.sort(np.stack([elements[:, edges[node]] for node in sorted(edges)], axis=1), axis=2)
    ends, number = np.unique(pairs.reshape(-1, 2), axis=0, return_inverse=True)
    middles = len(nodes) + number.reshape(pairs.shape[:2])
    return np.concatenate([nodes, nodes[ends].mean(axis=1)]), np.concatenate([elements, middles], axis=1)
