# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Cells that stand for elements in field output, and what is known in each.

Which cell an element becomes:

- an interface of the project, or a cohesive element: a line of 2 or 3 nodes along its bottom edge, or its bottom face;
  a continuum element of the project: its outline;
- a built-in element, or a user's own element: by its number of nodes, with the node order of Abaqus' own elements
  (2D: 3, 4, 6, 8 nodes; 3D: 4, 6, 8, 10, 15, 20; a line of 2 or 3). Abaqus does not know either what a user element
  looks like;
- a user element with any other number of nodes: a vertex at each of its nodes, all with the values of the element.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.arrays import FloatArray, IntArray
from harness.model.mesh import ElementGroup
from harness.model.model import Model
from harness.model.records import ElementState, PointVariables
from harness.output.points import point_values

_PLANE = {1: "vertex", 2: "line", 3: "triangle", 4: "quad", 6: "triangle6", 8: "quad8"}
_SOLID = {
    1: "vertex",
    2: "line",
    3: "line3",
    4: "tetra",
    6: "wedge",
    8: "hexahedron",
    10: "tetra10",
    15: "wedge15",
    20: "hexahedron20",
}
_FACE = {2: "line", 3: "line3", 4: "quad"}
_COORDINATES = ("X", "Y", "Z")


@dataclass(frozen=True, slots=True)
class Cells:
    """Cells of one group: type as meshio names it, nodes (cells, nodes), and the element each cell belongs to."""

    type: str
    nodes: IntArray
    element: IntArray


def cells_of(group: ElementGroup, variables: PointVariables | None, *, solid: bool) -> Cells:
    """Cells of a group; `solid`: the model is three-dimensional."""
    nodes = group.nodes
    if variables is not None and variables.kind == "interface":
        nodes = nodes[:, list(variables.bottom)]
        return Cells(_FACE[nodes.shape[1]], nodes, np.arange(len(nodes)))
    if variables is not None and variables.outline:
        nodes = nodes[:, list(variables.outline)]
    elements, count = nodes.shape
    kind = (_SOLID if solid and nodes is group.nodes else _PLANE).get(count)
    if kind is None:
        return Cells("vertex", nodes.reshape(-1, 1), np.repeat(np.arange(elements), count))
    return Cells(kind, nodes, np.arange(elements))


def is_solid(model: Model) -> bool:
    """True if the nodes do not all lie in one plane z = constant."""
    z = model.mesh.coordinates[:, 2]
    return bool(len(z)) and bool(np.ptp(z) > 0.0)


def cell_values(states: tuple[ElementState, ...], cells: tuple[Cells, ...]) -> dict[str, list[FloatArray]]:
    """Means over the integration points, by variable, an array for each group; NaN where a group lacks the variable.

    Coordinates of the points are left out: the cell is in its place already.
    """
    known: dict[str, dict[int, FloatArray]] = {}
    for state in states:
        if state.variables is None:
            continue
        means = point_values(state, state.variables).mean(axis=1)
        for k, name in enumerate(state.variables.names):
            if name not in _COORDINATES:
                known.setdefault(name, {})[state.group] = means[cells[state.group].element, k]
    return {
        name: [values.get(k, np.full(len(group.nodes), np.nan)) for k, group in enumerate(cells)]
        for name, values in known.items()
    }
