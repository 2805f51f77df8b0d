# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Blocks in plain numpy, so that assembly is tested without compiled elements."""

from collections import Counter
from collections.abc import Callable

import numpy as np
import pytest

from uel.assembly import Contributors
from uel.elements import FIELD_NAMES, BlockReport, Call, Contributor, ElementBlock, Flags
from uel.errors import Source
from uel.model.mesh import ElementGroup, Mesh
from uel.model.properties import UserProperty
from uel.usersub._binding import scatter_map

PLACE = Source("fake.inp", 1)


class LinearBlock(Contributor):
    """Elements with constant matrices (m, k, k): RHS = -K u."""

    names = ()

    def __init__(self, nodes, unknowns, matrices):
        nodes = np.asarray(nodes)
        labels = np.arange(1, len(nodes) + 1)
        self.group = ElementGroup("U1", labels, nodes, "", UserProperty("ALL", PLACE), None, PLACE)
        self.first, self.rows = 0, np.arange(len(nodes))
        self.unknowns = tuple(unknowns)
        self.matrices = np.asarray(matrices)
        self.commits = 0

    @property
    def nodes(self):
        return self.group.nodes

    def locate(self, indptr, indices):
        self.scatter = scatter_map(self.couplings(), indptr, indices)

    def contribute(self, now):
        forces = -np.einsum("eij,ej->ei", self.matrices, now.u[self.couplings()])
        np.add.at(now.columns[0], self.couplings(), forces)
        if now.data is not None:
            np.add.at(now.data, self.scatter, self.matrices)
        flux, count = np.zeros(len(FIELD_NAMES)), np.zeros(len(FIELD_NAMES), dtype=np.int64)
        flux[0], count[0] = np.abs(forces).sum(), forces.size
        return BlockReport(flux, count, 0.5 + 0.1 * len(self.rows), np.arange(8.0))

    def commit(self):
        self.commits += 1

    def kept(self):
        return {}

    def resume(self, saved):
        pass


@pytest.fixture
def call() -> Call:
    return Call(Flags(1), 1, 1, 1.0, 1.0, 1.0, 1.0)


@pytest.fixture
def make_mesh() -> Callable[..., Mesh]:
    def make(n: int) -> Mesh:
        """Nodes 10, 20, ... in a row."""
        coordinates = np.zeros((n, 3))
        coordinates[:, 0] = np.arange(n)
        return Mesh(10 * np.arange(1, n + 1), coordinates, ("",) * n)

    return make


@pytest.fixture
def springs(make_mesh) -> Callable[..., tuple[Mesh, Contributors]]:
    def make(n: int) -> tuple[Mesh, Contributors]:
        """A chain of n nodes with springs of stiffness 1, 2, 3, ... along dof 1."""
        nodes = np.column_stack([np.arange(n - 1), np.arange(1, n)])
        stiffness = np.arange(1.0, n)
        matrices = stiffness[:, None, None] * np.array([[1.0, -1.0], [-1.0, 1.0]])
        return make_mesh(n), Contributors([LinearBlock(nodes, [(0, 1), (1, 1)], matrices)])

    return make


@pytest.fixture
def two_blocks(make_mesh) -> tuple[Mesh, Contributors]:
    """Unsymmetric quads with dofs 1 and 2 and triangles with dofs 1 at two nodes and 11 at the third, random values."""
    rng = np.random.default_rng(7)
    quads = LinearBlock(
        [[0, 1, 4, 3], [1, 2, 5, 4]], [(k, dof) for k in range(4) for dof in (1, 2)], rng.normal(size=(2, 8, 8))
    )
    triangles = LinearBlock([[5, 4, 6], [2, 5, 6]], [(0, 1), (1, 1), (2, 11)], rng.normal(size=(2, 3, 3)))
    return make_mesh(8), Contributors([quads, triangles])


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """Passes over the blocks of each element type."""
    counted: Counter[str] = Counter()
    ordinary = ElementBlock.evaluate

    def evaluate(self, *arguments, **options):
        counted[self.group.type] += 1
        return ordinary(self, *arguments, **options)

    monkeypatch.setattr(ElementBlock, "evaluate", evaluate)
    return counted
