# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Grids of solids of any family, as arrays and as decks."""

import itertools
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from small_decks import body_lines

from uel.delamination.solid_blocks import corner_elements, with_middles
from uel.insertion.command import insert
from uel.insertion.selection import CutRequest
from uel.model.element_types import CONTINUUM


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
    elements, cell = corner_elements(family, counts)
    steps = np.array(sizes) / counts
    nodes = places * steps
    inside = np.all((places > 0) & (places < counts), axis=1)
    nodes[inside] += np.random.default_rng(seed).uniform(-distort, distort, (inside.sum(), dimension)) * steps
    return Grid(kind, *with_middles(family, nodes, elements), cell)


LAW = ("SIGMAMAX=30", "TAUMAX=60", "GIC=0.26", "GIIC=1.")


def inserted(deck: Path, output: Path, values=LAW, *, files=(), **wanted):
    """Write a deck with elements inserted; keywords as of CutRequest and insert."""
    options = {name: wanted.pop(name) for name in ("element", "elset", "solids") if name in wanted}
    text, done = insert([*files, deck], CutRequest(**wanted), values=values, **options)
    output.write_text(text)
    return done
