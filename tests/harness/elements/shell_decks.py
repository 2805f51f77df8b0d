# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks of shells on meshes with two parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from uel.model.element_types import SHELL

Place = Callable[[float, float], tuple[float, float, float]]


@dataclass
class ShellDeck:
    """A mesh of n x m cells on the unit square, with each cell a quadrilateral or two triangles.

    Numbers of corners come before those of the middles of sides.

    place     of a point of the unit square
    kind      element type
    moved     displacements of inner nodes in the unit square, by their indices
    """

    kind: str
    n: int
    m: int
    place: Place
    section: str
    material: str
    before: str = ""
    moved: dict[tuple[int, int], tuple[float, float]] = field(default_factory=dict)

    @property
    def quadratic(self) -> bool:
        """Whether there are nodes at the middles of sides."""
        return SHELL[self.kind].nodes == 8

    def node(self, i: float, j: float) -> int:
        """Number of a node: i from 0 to n, j from 0 to m; one of them is a half in the middle of a side."""
        corners = (self.n + 1) * (self.m + 1)
        if i % 1:
            return 1 + corners + int(i) + int(j) * self.n
        if j % 1:
            return 1 + corners + self.n * (self.m + 1) + int(i) + int(j) * (self.n + 1)
        return 1 + int(i) + int(j) * (self.n + 1)

    def side(self, *, i: int | None = None, j: int | None = None) -> list[int]:
        """Nodes of a line of the mesh, one after the other."""
        parts = 2 if self.quadratic else 1
        if i is not None:
            return [self.node(i, k / parts) for k in range(parts * self.m + 1)]
        assert j is not None
        return [self.node(k / parts, j) for k in range(parts * self.n + 1)]

    def shares(self, nodes: Sequence[int]) -> list[float]:
        """Parts of a constant force per length that nodes of a side with sections of the same length have."""
        parts = np.zeros(len(nodes))
        weights = [1 / 6, 2 / 3, 1 / 6] if self.quadratic else [1 / 2, 1 / 2]
        for k in range(0, len(nodes) - 1, len(weights) - 1):
            parts[k : k + len(weights)] += weights
        return (parts / parts.sum()).tolist()

    def _place(self, i: float, j: float) -> tuple[float, float, float]:
        ends = [(int(i), int(j)), (int(np.ceil(i)), int(np.ceil(j)))]
        di, dj = np.mean([self.moved.get(end, (0.0, 0.0)) for end in ends], axis=0)
        return self.place(i / self.n + di, j / self.m + dj)

    @property
    def coordinates(self) -> np.ndarray:
        """(nodes, 3), in the order of the numbers."""
        places = [self._place(i, j) for j in range(self.m + 1) for i in range(self.n + 1)]
        if self.quadratic:
            places += [self._place(i + 0.5, j) for j in range(self.m + 1) for i in range(self.n)]
            places += [self._place(i, j + 0.5) for j in range(self.m) for i in range(self.n + 1)]
        return np.array(places, dtype=float)

    def elements(self) -> list[tuple[int, ...]]:
        """Nodes of the elements."""
        cells = []
        for j in range(self.m):
            for i in range(self.n):
                a, b, c, d = self.node(i, j), self.node(i + 1, j), self.node(i + 1, j + 1), self.node(i, j + 1)
                middles = [(i + 0.5, j), (i + 1, j + 0.5), (i + 0.5, j + 1), (i, j + 0.5)] if self.quadratic else []
                whole = (a, b, c, d, *(self.node(*place) for place in middles))
                cells += [(a, b, c), (a, c, d)] if self.kind.startswith("S3") else [whole]
        return cells

    def text(self, step: str, sets: dict[str, Iterable[int]] | None = None) -> str:
        """The deck, with a step and node sets."""
        material = self.before + f"*MATERIAL, NAME=M\n{self.material.strip()}"
        return "\n".join([*_mesh_lines(self, sets), material, self.section, step, ""])


def values_of(evaluate, *names):
    """(points, names) committed values of the section points of the only element of a `response`."""
    evaluate.block.commit()
    state = evaluate.block.state(0)
    known = list(state.variables.names)
    return state.svars.reshape(-1, len(known))[:, [known.index(name) for name in names]]


@dataclass
class ThickDeck:
    """A mesh of n x m cells on the unit square with one or more elements across, of hexahedra or wedges.

    place     of a point of the unit square at a height from 0 to 1
    kind      element type
    across    elements across
    moved     displacements of inner pairs of nodes in the unit square, by their indices
    """

    kind: str
    n: int
    m: int
    place: Callable[[float, float, float], tuple[float, float, float]]
    section: str
    material: str
    across: int = 1
    moved: dict[tuple[int, int], tuple[float, float]] = field(default_factory=dict)

    def node(self, i: int, j: int, k: int) -> int:
        """Number of a node."""
        return 1 + i + (self.n + 1) * (j + (self.m + 1) * k)

    def line(self, *, i: int | None = None, j: int | None = None) -> list[int]:
        """Nodes at one index of the mesh, those at the bottom first."""
        first = range(self.n + 1) if i is None else (i,)
        second = range(self.m + 1) if j is None else (j,)
        return [self.node(a, b, k) for k in range(self.across + 1) for b in second for a in first]

    @property
    def coordinates(self) -> np.ndarray:
        """(nodes, 3), in the order of the numbers."""
        places = []
        for k in range(self.across + 1):
            for j in range(self.m + 1):
                for i in range(self.n + 1):
                    a, b = self.moved.get((i, j), (0.0, 0.0))
                    places.append(self.place(i / self.n + a, j / self.m + b, k / self.across))
        return np.array(places, dtype=float)

    def elements(self) -> list[tuple[int, ...]]:
        """Nodes of the elements."""
        cells = []
        for k in range(self.across):
            for j in range(self.m):
                for i in range(self.n):
                    around = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                    for part in ((0, 1, 2), (0, 2, 3)) if self.kind.startswith("SC6") else ((0, 1, 2, 3),):
                        cells.append(tuple(self.node(*around[p], k + side) for side in (0, 1) for p in part))
        return cells

    def text(self, step: str, sets: dict[str, Iterable[int]] | None = None) -> str:
        """The deck, with a step and node sets."""
        material = f"*MATERIAL, NAME=M\n{self.material.strip()}"
        return "\n".join([*_mesh_lines(self, sets), material, self.section, step, ""])


def _mesh_lines(deck: ShellDeck | ThickDeck, sets: dict[str, Iterable[int]] | None) -> list[str]:
    """Nodes, elements of the set SHELL, and node sets."""
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{k}, {x!r}, {y!r}, {z!r}" for k, (x, y, z) in enumerate(deck.coordinates.tolist(), 1)]
    lines += [f"*ELEMENT, TYPE={deck.kind}, ELSET=SHELL"]
    lines += [f"{k}, {', '.join(map(str, nodes))}" for k, nodes in enumerate(deck.elements(), 1)]
    for name, nodes in (sets or {}).items():
        lines += [f"*NSET, NSET={name}", *(f"{node}," for node in nodes)]
    return lines
