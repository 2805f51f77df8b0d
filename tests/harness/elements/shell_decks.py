# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks of shells on meshes with two parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np

Place = Callable[[float, float], tuple[float, float, float]]


@dataclass
class ShellDeck:
    """A mesh of n x m cells on the unit square, with each cell a quadrilateral or two triangles.

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

    def node(self, i: int, j: int) -> int:
        """Number of a node: i from 0 to n, j from 0 to m."""
        return 1 + i + j * (self.n + 1)

    def side(self, *, i: int | None = None, j: int | None = None) -> list[int]:
        """Nodes of a line of the mesh."""
        if i is not None:
            return [self.node(i, k) for k in range(self.m + 1)]
        assert j is not None
        return [self.node(k, j) for k in range(self.n + 1)]

    @property
    def coordinates(self) -> np.ndarray:
        """(nodes, 3), in the order of the numbers."""
        places = []
        for j in range(self.m + 1):
            for i in range(self.n + 1):
                di, dj = self.moved.get((i, j), (0.0, 0.0))
                places.append(self.place(i / self.n + di, j / self.m + dj))
        return np.array(places, dtype=float)

    def elements(self) -> list[tuple[int, ...]]:
        """Nodes of the elements."""
        cells = []
        for j in range(self.m):
            for i in range(self.n):
                a, b, c, d = self.node(i, j), self.node(i + 1, j), self.node(i + 1, j + 1), self.node(i, j + 1)
                cells += [(a, b, c), (a, c, d)] if self.kind.startswith("S3") else [(a, b, c, d)]
        return cells

    def text(self, step: str, sets: dict[str, Iterable[int]] | None = None) -> str:
        """The deck, with a step and node sets."""
        lines = ["*NODE, NSET=ALL"]
        lines += [f"{k}, {x!r}, {y!r}, {z!r}" for k, (x, y, z) in enumerate(self.coordinates.tolist(), 1)]
        lines += [f"*ELEMENT, TYPE={self.kind}, ELSET=SHELL"]
        lines += [f"{k}, {', '.join(map(str, nodes))}" for k, nodes in enumerate(self.elements(), 1)]
        for name, nodes in (sets or {}).items():
            lines += [f"*NSET, NSET={name}", *(f"{node}," for node in nodes)]
        return "\n".join([*lines, self.before + f"*MATERIAL, NAME=M\n{self.material.strip()}", self.section, step, ""])
