# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""One built-in continuum element that is led through increments with NLGEOM."""

from dataclasses import replace

import numpy as np
from reference_cells import unit_cell

from uel.elements import Flags
from uel.model.element_types import CONTINUUM

SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1.2, 0.9, 0], [0.1, 1, 0]])
CUBE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
EIGHT = np.vstack([SQUARE, (SQUARE + np.roll(SQUARE, -1, axis=0)) / 2])
NODES = {"CPS3": SQUARE[:3], "CPE3": SQUARE[:3]}
SPACE = [name for name, kind in CONTINUUM.items() if kind.dimension == 3]
NODES |= {name: unit_cell(CONTINUUM[name].family.cell)[0] for name in SPACE} | dict.fromkeys(
    ("C3D8", "C3D8R", "C3D8I", "C3D8IH"), CUBE
)
NODES |= {"CAX3": SQUARE[:3], "CAX8": EIGHT, "CAX8R": EIGHT}
AXISYMMETRIC = ["CAX3", "CAX4", "CAX4R", "CAX8", "CAX8R"]
TYPES = ["CPS3", "CPS4", "CPS4R", "CPS4I", "CPE3", "CPE4", "CPE4R", "CPE4I", "CPE4IH", *SPACE]


class MovingElement:
    """Its block, with the tangent and the forces of the last pass, and the displacements of the last increment."""

    def __init__(self, block, matrix, nodes, call):
        self.block, self.matrix, self.nodes = block, matrix, nodes
        self.dimension = matrix.shape[0] // len(nodes)
        self.call = replace(call, flags=Flags(1, nlgeom=True))
        self.u = np.zeros(matrix.shape[0])

    def evaluate(self, u):
        residual = np.zeros(u.size)
        self.matrix.data[:] = 0
        report = self.block.evaluate(self.call, u, u - self.u, residual, self.matrix.data)
        return residual, report

    def move(self, f):
        """To x = F X."""
        d = self.dimension
        u = (self.nodes[:, :d] @ (np.asarray(f)[:d, :d] - np.eye(d)).T).ravel()
        residual, report = self.evaluate(u)
        self.block.commit()
        self.u = u
        return residual.reshape(-1, d), report

    def values(self):
        """Values (points, variables) of the points."""
        state = self.block.state(0)
        return state.svars.reshape(len(state.variables.names) and -1, len(state.variables.names))


def turn(angle):
    """Rotation about axis 3, radians."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
