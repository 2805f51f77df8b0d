# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""U3 and U10 with the quads or bricks whose stress they take, as one element with the nodes of U4 or U8."""

import itertools

import numpy as np

BOTTOM, TOP, INTERFACE = 11, 12, 400
OWNED = {3: [3, 2, 5, 4], 10: [4, 5, 6, 7, 8, 9, 10, 11]}  # nodes of U3 among those of U4, of U10 among those of U8
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
FACES = {
    3: [{0, 1}, {1, 2}, {2, 3}, {3, 0}],
    # of C3D8 (Abaqus Elements Guide)
    10: [{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 4, 5}, {1, 2, 5, 6}, {2, 3, 6, 7}, {3, 0, 7, 4}],
}
"""Nodes of the faces S1, S2, ..."""


def numberings(jtype):
    """Orders of the nodes of a quad or brick that turn it."""
    if jtype == 3:
        return [np.roll([0, 1, 2, 3], k) for k in range(4)]
    found = []
    for axes, signs in itertools.product(itertools.permutations(range(3)), itertools.product((1, -1), repeat=3)):
        turn = np.eye(3, dtype=int)[list(axes)] * np.array(signs)[:, None]
        if round(np.linalg.det(turn)) == 1:
            moved = ((2 * CORNERS - 1) @ turn.T + 1) // 2
            found.append(np.array([np.flatnonzero((corner == CORNERS).all(axis=1)).item() for corner in moved]))
    return found


class Sandwich:
    """The interface element U3 or U10 between two quads or bricks.

    orders   the numberings of the bottom and the top solid
    solids   properties of them
    """

    def __init__(self, make, jtype, coordinates, *, orders=None, faces=None, solids=None, material=None, **options):
        half = len(coordinates) // 2
        orders = orders or (np.arange(half),) * 2
        self.parts = [orders[0], half + np.array(orders[1])]
        self.owned = OWNED[jtype]
        self.shape = np.shape(coordinates)
        if faces is None:
            shared = [set(np.flatnonzero(np.isin(part, self.owned)).tolist()) for part in self.parts]
            faces = [1 + FACES[jtype].index(nodes) for nodes in shared]
        of_solid = {"material": material, **(solids or {})}
        self.solids = [
            make(1 if jtype == 3 else 9, coordinates[part], label=label, FACE=face, **of_solid)
            for part, label, face in zip(self.parts, (BOTTOM, TOP), faces, strict=True)
        ]
        offsets = {"OFFSETBOTTOM": BOTTOM - INTERFACE, "OFFSETTOP": TOP - INTERFACE}
        self.item = make(jtype, coordinates[self.owned], label=INTERFACE, **{**offsets, **options})

    def _call(self, method, u, **options):
        u = np.reshape(u, self.shape)
        for solid, part in zip(self.solids, self.parts, strict=True):
            getattr(solid, method)(u[part], **options)
        rhs, tangent = getattr(self.item, method)(u[self.owned], **options)
        dim = self.shape[1]
        dofs = np.add.outer(dim * np.array(self.owned), range(dim)).ravel()
        force, matrix = np.zeros(u.size), np.zeros((u.size,) * 2)
        force[dofs], matrix[np.ix_(dofs, dofs)] = rhs, tangent
        return force, matrix

    def evaluate(self, u, **options):
        """RHS and AMATRX of the interface element for all unknowns, with those of the solids that it does not own."""
        return self._call("evaluate", u, **options)

    def advance(self, u, **options):
        """A converged increment."""
        return self._call("advance", u, **options)

    @property
    def state(self):
        """Committed SVARS of the interface element by name, one value per point."""
        return self.item.state

    @property
    def energy(self):
        """Committed ENERGY(1:8) of the interface element."""
        return self.item.energy
