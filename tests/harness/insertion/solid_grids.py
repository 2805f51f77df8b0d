# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Grids of solids of any family, as arrays and as decks."""

import itertools
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from small_decks import body_lines

from uel.insertion.command import insert
from uel.insertion.selection import CutRequest
from uel.model.element_types import CONTINUUM

# a square into two triangles, a cube into two wedges or six tetrahedra, by places 0 or 1 along each direction
_TRIANGLES = (((0, 0), (1, 0), (1, 1)), ((0, 0), (1, 1), (0, 1)))
_QUADRILATERAL = (((0, 0), (1, 0), (1, 1), (0, 1)),)
_CUBE = (((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)),)
_WEDGES = tuple(tuple((*corner, height) for height in (0, 1) for corner in triangle) for triangle in _TRIANGLES)


def _paths():
    """Tetrahedra along the edges from one corner of a cube to the opposite one, with positive volumes."""
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


@dataclass
class Grid:
    """Solids of one type in a block of cells: nodes (n, dimension), elements (m, nodes) that count nodes from 0.

    cell  (m, dimension) which cell of the block each element is in
    """

    kind: str
    nodes: np.ndarray
    elements: np.ndarray
    cell: np.ndarray
    sets: dict[str, np.ndarray] = field(default_factory=dict)
    node_sets: dict[str, np.ndarray] = field(default_factory=dict)

    @property
    def family(self):
        return CONTINUUM[self.kind].family

    def lines(self):
        """*NODE, *ELEMENT, *ELSET and *NSET; sets count from 0."""
        lines = body_lines(self.kind, self.nodes, self.elements)
        for name, elements in self.sets.items():
            lines += [f"*ELSET, ELSET={name}", *(str(k + 1) for k in np.flatnonzero(elements))]
        for name, nodes in self.node_sets.items():
            lines += [f"*NSET, NSET={name}", *(str(k + 1) for k in np.flatnonzero(nodes))]
        return lines

    def end(self, axis, side):
        """Nodes of one end of the block: side 0 or 1."""
        along = self.nodes[:, axis]
        return np.isclose(along, along.max() if side else along.min())


def grid(kind, counts, sizes, distort=0.0, seed=0):
    """A block of cells; inner nodes are moved by up to this part of a cell, straight planes of cells stay so."""
    family = CONTINUUM[kind].family
    dimension = family.dimension
    counts = np.array(counts)
    places = np.array(list(itertools.product(*(range(count + 1) for count in counts[::-1]))))[:, ::-1]
    strides = np.cumprod([1, *(counts[:-1] + 1)])
    cells = np.array(list(itertools.product(*(range(count) for count in counts[::-1]))))[:, ::-1]
    pattern = np.array(_CELLS[dimension, family.corners])
    elements = ((cells[:, None, None, :] + pattern[None]) @ strides).reshape(-1, family.corners)
    steps = np.array(sizes) / counts
    nodes = places * steps
    inside = np.all((places > 0) & (places < counts), axis=1)
    nodes[inside] += np.random.default_rng(seed).uniform(-distort, distort, (inside.sum(), dimension)) * steps
    if family.nodes > family.corners:
        nodes, elements = _with_middles(family, nodes, elements)
    return Grid(kind, nodes, elements, np.repeat(cells, len(pattern), axis=0))


def _with_middles(family, nodes, elements):
    """Nodes in the middles of the edges, and elements that have them."""
    edges = {}
    for face in family.faces:
        corners = len(face) // 2 if family.dimension == 3 else 2
        for k in range(corners if family.dimension == 3 else 1):
            edges[face[corners + k]] = face[k], face[(k + 1) % corners]
    pairs = np.sort(np.stack([elements[:, edges[node]] for node in sorted(edges)], axis=1), axis=2)
    found, number = np.unique(pairs.reshape(-1, 2), axis=0, return_inverse=True)
    middles = len(nodes) + number.reshape(pairs.shape[:2])
    return np.concatenate([nodes, nodes[found].mean(axis=1)]), np.concatenate([elements, middles], axis=1)


LAW = ("SIGMAMAX=30", "TAUMAX=60", "GIC=0.26", "GIIC=1.")


def inserted(deck: Path, output: Path, values=LAW, *, files=(), **wanted):
    """Write a deck with elements inserted; keywords as of CutRequest and insert."""
    options = {name: wanted.pop(name) for name in ("element", "elset", "solids") if name in wanted}
    text, done = insert([*files, deck], CutRequest(**wanted), values=values, **options)
    output.write_text(text)
    return done
