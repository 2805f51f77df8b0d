# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Cells that represent elements in field output, and their values.

Cell of each kind of element:

- an interface of the project, or a cohesive element: a line of 2 or 3 nodes along its bottom edge, or its bottom face;
  a continuum element of the project: its outline;
- a built-in continuum element or beam: the cell of its family (harness/uel/model/element_types.py);
- a user element, a truss or a spring: by its number of nodes, the cell of a family in the plane or in space, or
  otherwise a line, with the node order of Abaqus' elements. Abaqus does not know the shape of a user element either;
- a user element with any other number of nodes: a vertex at each of its nodes, all with the values of the element.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import FAMILIES, BeamType, CohesiveType, Family, SolidType
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.records import ElementState, PointVariables
from uel.output.points import point_values
from uel.usersub.layout import element_layouts

_COORDINATES = ("X", "Y", "Z")


@dataclass(frozen=True, slots=True)
class Cells:
    """Cells of one group: type by meshio's name, nodes (cells, nodes), and the element of each cell."""

    type: str
    nodes: IntArray
    element: IntArray


def cells_of(group: ElementGroup, variables: PointVariables | None, *, solid: bool) -> Cells:
    """Return the cells of a group; `solid`: the model is three-dimensional."""
    nodes, kind = group.nodes, group.built_in
    if isinstance(kind, SolidType):
        family: Family | None = kind.family
    elif isinstance(kind, BeamType):
        nodes = nodes[:, list(kind.order)]
        family = kind.family
    elif variables is not None and variables.kind == "interface":
        nodes = nodes[:, list(variables.bottom)]
        family = _face_of(group, nodes.shape[1])
    elif variables is not None and variables.outline:
        nodes = nodes[:, list(variables.outline)]
        family = _family(nodes.shape[1], 2)
    else:
        family = _family(nodes.shape[1], 3 if solid else 2, 1)
    elements, count = nodes.shape
    if family is None:
        return Cells("vertex", nodes.reshape(-1, 1), np.repeat(np.arange(elements), count))
    return Cells(family.cell, nodes, np.arange(elements))


def _face_of(group: ElementGroup, nodes: int) -> Family | None:
    """Return the family of the faces of interface elements: three nodes are a line in the plane, else a triangle."""
    if isinstance(group.built_in, CohesiveType):
        return group.built_in.face
    assert group.definition is not None
    return _family(nodes, element_layouts()[group.definition.number].dimension - 1)


def _family(nodes: int, *dimensions: int) -> Family | None:
    """Return the family of a number of nodes, in the first of the dimensions that has one."""
    return next((FAMILIES[dimension, nodes] for dimension in dimensions if (dimension, nodes) in FAMILIES), None)


def is_solid(model: Model) -> bool:
    """Return whether the nodes do not all lie in one plane z = constant."""
    z = model.mesh.coordinates[:, 2]
    return bool(len(z)) and bool(np.ptp(z) > 0.0)


def cell_values(states: Sequence[ElementState], cells: tuple[Cells, ...]) -> dict[str, list[FloatArray]]:
    """Return means over the integration points, by variable, an array for each group; NaN without the variable.

    Coordinates of the points, which the cell shows, and variables without a name are left out. Variables at section
    points are those of the first and the last point of shells, with _SNEG and _SPOS in the name, and of all points of
    beams, with _SP and their number.
    """
    known: dict[str, dict[int, FloatArray]] = {}
    for state in states:
        if state.variables is None:
            continue
        elements, sections = cells[state.group].element, state.variables.sections
        values = point_values(state, state.variables)
        # (elements, section points, variables)
        means = values.reshape(len(values), values.shape[1] // sections, sections, values.shape[2]).mean(axis=1)
        for k, name in enumerate(state.variables.names):
            if not name or name in _COORDINATES:
                continue
            sides = {name: 0}
            if state.variables.sides and name not in state.variables.whole:
                sides = {name + suffix: position for suffix, _, position in state.variables.sides}
            for side, section in sides.items():
                known.setdefault(side, {})[state.group] = means[elements, section, k]
    return {
        name: [values.get(k, np.full(len(group.nodes), np.nan)) for k, group in enumerate(cells)]
        for name, values in known.items()
    }
