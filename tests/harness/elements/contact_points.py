# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The block of points of a pair in finite sliding, alone, with a dense matrix."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from uel.contact import ContactBlock
from uel.elements import CurrentPass, Flags, Request
from uel.errors import Source
from uel.model.mesh import ElementGroup, Mesh
from uel.model.model import Model
from uel.model.properties import UserProperty

SOURCE = Source("test.inp", 1)


class Points:
    """A block whose unknowns are these dofs of each node, node by node, then the multipliers.

    first, second  calls of a first pass and of the one after a solve
    """

    def __init__(self, call, pair, coordinates, dofs):
        n, self.dofs = len(coordinates), dofs
        mesh = Mesh(np.arange(1, n + 1), coordinates, ("",) * n)
        group = ElementGroup("U1", np.array([1]), np.array([[0, 1]]), "", UserProperty("ALL", SOURCE), None, SOURCE)
        self.block = ContactBlock(Model(Path("test.inp"), "", mesh, (group,), ()), pair)
        m = len(pair.secondary) * self.block.direct
        self.size = n * len(dofs) + m
        self.block.number(self._find, n * len(dofs) + np.arange(len(pair.secondary), dtype=np.int32)[:, None])
        self._bind()
        self.multipliers = slice(n * len(dofs), self.size)
        self.first, self.second = (replace(call, iteration=k, flags=Flags(1, True)) for k in range(2))

    def _find(self, nodes, dof):
        return np.asarray(nodes) * len(self.dofs) + np.searchsorted(self.dofs, dof)

    def _bind(self):
        size = self.size
        self.block.locate(size * np.arange(size + 1, dtype=np.int32), np.tile(np.arange(size, dtype=np.int32), size))

    def evaluate(self, call, u, du):
        """Residual and matrix of a pass."""
        data = np.zeros(len(u) ** 2)
        data[:: len(u) + 1] = 7.0
        now = CurrentPass(call, u, du, np.zeros((1, len(u))), data)
        if not self.block.track(now):
            self._bind()
        self.block.contribute(now)
        data[:: len(u) + 1] -= 7.0
        return now.columns[0], data.reshape(len(u), len(u))

    def forces(self, u, du):
        """Residual of a trial pass."""
        now = CurrentPass(self.second.asking(Request.RESIDUAL), u, du, np.zeros((1, len(u))), None)
        self.block.track(now)
        self.block.contribute(now)
        return now.columns[0]

    def check_matrix(self, start, du):
        """The matrix by differences, after an increment to `start` that leaves an elastic slip; returns it."""
        still = np.zeros(self.size)
        self.evaluate(self.first, still, still)
        self.evaluate(self.second, start, start)
        self.block.commit()
        self.evaluate(self.first, start, still)
        u = start + du
        _, found = self.evaluate(self.second, u, du)
        assert (self.block.output[1] > 0.0).sum() > 1
        step = 1e-6
        ways = step * np.eye(self.size)
        wanted = [(self.forces(u - way, du - way) - self.forces(u + way, du + way)) / (2 * step) for way in ways]
        wanted = np.stack(wanted, axis=1)
        np.testing.assert_allclose(found, wanted, atol=1e-6 * max(1.0, np.abs(wanted).max()))
        return found


def rotation_of(angle, dimension):
    """About the axis of the plane, or (1, 2, 2) / 3, by the formula of Rodrigues."""
    if dimension == 2:
        return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    axis = np.array([1.0, 2.0, 2.0]) / 3.0
    skew = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew
