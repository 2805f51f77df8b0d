# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tables of *NODE PRINT and *EL PRINT in the .dat file, in the layout of a public .dat file of Abaqus.

Lines whose values are all zero are left out of a table, as Abaqus does, but count for MAXIMUM and MINIMUM. Values at
nodes have eight significant digits, their extremes and all values of elements five or four.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uel.elements.extrapolation import at_centroid, at_nodes
from uel.model.arrays import FloatArray, IntArray, first_largest
from uel.model.mesh import ElementGroup, Mesh
from uel.model.model import Model
from uel.model.nodal_variables import NodalIndex
from uel.model.records import ElementState, Solution
from uel.model.steps import ElementRequest, NodeRequest, Position
from uel.output.cells import is_solid
from uel.output.formats import exponential, general
from uel.output.points import point_values

COLUMNS = 9  # of a table of Abaqus
_SUFFIXES = ("11", "22", "33", "12", "13", "23")
_NUMBERED = ("SDV", "UVARM", "SF", "SE", "HFL", "MFL", "EPG", "EFLX")
_COORDINATES = ("COOR1", "COOR2", "COOR3")


@dataclass(frozen=True, slots=True)
class _Table:
    """Values (rows, columns) with the heads of lines and columns, COLUMNS columns beside each other.

    head, width    head of the lines; of a name of a column
    note           line below the head
    indent, where  indent of the extremes, and head of the line below with their nodes or elements
    """

    title: str
    head: str
    width: int
    note: str
    indent: int
    names: list[str]
    lines: list[str]
    labels: list[str]
    values: FloatArray
    where: str
    number: Callable[[float], str]
    totals: bool = False

    def __str__(self) -> str:
        return "".join(self._part(slice(k, k + COLUMNS)) for k in range(0, len(self.names), COLUMNS))

    def _part(self, columns: slice) -> str:
        values = self.values[:, columns]
        if not values.any():
            return f"\n\n{self.title}\n\n          ALL VALUES IN THIS TABLE ARE ZERO\n"
        head = self.head + "".join(f"{name:<{self.width}}" for name in self.names[columns])
        text = f"\n\n{self.title}\n\n{head}\n{self.note}\n\n"
        for line, row in zip(self.lines, values.tolist(), strict=True):
            if any(row):
                text += line + "".join(map(self.number, row)) + "\n"
        for name, best in (("MAXIMUM", first_largest(values)), ("MINIMUM", first_largest(-values))):
            extremes = np.take_along_axis(values, best[None, :], axis=0)[0]
            text += f"\n{f' {name}':<{self.indent}}{_row(extremes.tolist())}\n"
            text += self.where + "".join(f"{self.labels[k]:>12}" for k in best) + "\n"
        if self.totals:
            text += f"\n{' TOTAL':<{self.indent}}{_row(values.sum(axis=0).tolist())}\n"
        return text


def used_nodes(model: Model) -> NDArray[np.bool_]:
    """Return the mask (nodes,) of the nodes of elements and constraints, which are part of the analysis."""
    used = np.zeros(len(model.mesh.labels), dtype=bool)
    for group in model.groups:
        used[group.nodes] = True
        if group.reference >= 0:
            used[group.reference] = True
    for equation in model.equations:
        used[[node for node, _, _ in equation.terms]] = True
    return used


def node_tables(request: NodeRequest, model: Model, solution: Solution, index: NodalIndex, *, nlgeom: bool) -> str:
    """Return the tables of one *NODE PRINT request, with the components of each variable that the nodes have.

    nlgeom: coordinates are those of displaced nodes.
    """
    title = "   THE FOLLOWING TABLE IS PRINTED FOR " + (
        f"NODES BELONGING TO NODE SET {request.nset}" if request.nset else "ALL NODES"
    )
    nodes = request.nodes[used_nodes(model)[request.nodes]]
    columns: dict[str, FloatArray] = {}
    for variable in request.variables:
        columns |= _node_values(variable, nodes, model, solution, index, nlgeom=nlgeom)
    if not columns:
        return ""
    labels = [_label(model.mesh, node) for node in nodes.tolist()]
    return str(
        _Table(
            title,
            "       NODE FOOT-  ",
            15,
            "            NOTE",
            15,
            list(columns),
            [f"{label:>11}    " for label in labels],
            labels,
            np.stack(list(columns.values()), axis=1),
            " AT NODE      ",
            exponential,
            request.totals,
        )
    )


def _node_values(
    variable: str, nodes: IntArray, model: Model, solution: Solution, index: NodalIndex, *, nlgeom: bool
) -> dict[str, FloatArray]:
    """Return the values (nodes,) of the components of a variable by name; empty if no node has it."""
    axes = _COORDINATES[: 3 if is_solid(model) else 2]
    if variable in ("COORD", *axes):
        values = model.mesh.coordinates[nodes]
        if nlgeom:
            values = values + np.stack(
                [np.append(solution.displacement, 0.0)[index.find(nodes, dof)] for dof in (1, 2, 3)], axis=1
            )
        return {name: values[:, k] for k, name in enumerate(axes) if variable in ("COORD", name)}
    components = index.components((variable,), nodes, harmonic=solution.imaginary is not None)
    return {
        component.name: np.append(component.values(solution), 0.0)[index.find(nodes, component.dof)]
        for component in components
    }


def element_tables(request: ElementRequest, model: Model, solution: Solution) -> str:
    """Return the tables of one *EL PRINT request, one for each element type that keeps any of the variables."""
    text = ""
    for group, inside, state in chosen_elements(request.elements, model, solution):
        for names, values, sections in _element_values(group, state, inside, request.variables):
            text += _element_table(request, model.mesh, group, inside, names, values, sections)
    return text


ENERGIES = {
    "ALLSE": "RECOVERABLE STRAIN ENERGY",
    "ALLKE": "KINETIC ENERGY",
    "ALLWK": "EXTERNAL WORK",
    "ALLPD": "PLASTIC DISSIPATION",
    "ALLCD": "CREEP DISSIPATION",
    "ALLVD": "VISCOUS DISSIPATION (IN DAMPERS ETC)",
    "ALLSD": "STATIC DISSIPATION (STABILIZATION)",
    "ALLAE": "ENERGY TO CONTROL SPURIOUS MODES",
    "ALLDMD": "DAMAGE DISSIPATION",
    "ALLIE": "TOTAL STRAIN ENERGY (STRESS POWER)",
    "ETOTAL": "ENERGY BALANCE",
}
"""Energies of *ENERGY PRINT, in Abaqus' words and order."""


def energy_table(solution: Solution, moment: float, *, harmonic: bool = False) -> str:
    """Return the energies of the whole model, '' if the procedure has none.

    moment: total time; if `harmonic`, the frequency, and energies are means over a period.
    """
    names = [name for name in ENERGIES if name in solution.energies]
    if not names:
        return ""
    lines = [f"            {ENERGIES[name]:<43}{general(solution.energies[name], 13, 6)}" for name in names]
    at = f"{'FREQUENCY' if harmonic else 'T'} ={general(moment, 15, 6)}"
    totals = "MEAN ENERGIES OVER A PERIOD" if harmonic else "APPROXIMATE ENERGY TOTALS"
    return (
        f"\n\n            THE FOLLOWING TABLE IS PRINTED FOR THE WHOLE MODEL AT {at}\n\n\n"
        f"            {totals} -\n\n" + "\n".join(lines) + "\n"
    )


def missing_variables(
    request: NodeRequest | ElementRequest, model: Model, solution: Solution, index: NodalIndex
) -> list[str]:
    """Return the variables of a request that none of its nodes or elements has."""
    if isinstance(request, NodeRequest):
        return [
            name
            for name in request.variables
            if not _node_values(name, request.nodes, model, solution, index, nlgeom=False)
        ]
    chosen = chosen_elements(request.elements, model, solution)
    return [
        name
        for name in request.variables
        if not any(_element_values(group, state, inside, (name,)) for group, inside, state in chosen)
    ]


def not_extrapolated(request: ElementRequest, model: Model) -> list[str]:
    """Return element types with values at the integration points only, for a request of another position."""
    if request.position is Position.POINTS:
        return []
    first, types = 0, []
    for group in model.groups:
        inside = (request.elements >= first) & (request.elements < first + len(group.labels))
        first += len(group.labels)
        if inside.any() and at_nodes(group.type) is None:
            types.append(group.type)
    return list(dict.fromkeys(types))


def chosen_elements(
    elements: IntArray, model: Model, solution: Solution
) -> list[tuple[ElementGroup, IntArray, ElementState]]:
    """Return the groups that have some of the elements (positions in the model), these elements, and their state."""
    states = {state.group: state for state in solution.elements}
    chosen = []
    first = 0
    for k, group in enumerate(model.groups):
        inside = elements[(elements >= first) & (elements < first + len(group.labels))] - first
        first += len(group.labels)
        if len(inside) and k in states:
            chosen.append((group, inside, states[k]))
    return chosen


Sections = tuple[int, ...]
"""Numbers of the section points of each integration point; empty for values of the integration point itself."""


@dataclass(frozen=True, slots=True)
class _Layout:
    """Table of one position as Abaqus prints it: end of its title, head of the lines, note below it, and widths."""

    title: str
    head: str
    note: int
    indent: int
    where: str


_LAYOUTS = {
    Position.POINTS: _Layout("AT THE INTEGRATION POINTS", "    ELEMENT  PT FOOT-       ", 16, 22, " ELEMENT          "),
    Position.CENTROID: _Layout("AT THE CENTROID OF THE ELEMENT", "    ELEMENT  FOOT-   ", 13, 16, " ELEMENT       "),
    Position.NODES: _Layout("AT THE NODES", "    ELEMENT         ND   FOOT-   ", 25, 23, " ELEMENT              "),
    Position.AVERAGED: _Layout("AVERAGED AT THE NODES", "       NODE  FOOT-   ", 13, 16, "  NODE      "),
}

_SECTION_POINTS = _Layout("AT THE INTEGRATION POINTS", "    ELEMENT  PT SEC FOOT-   ", 20, 22, " ELEMENT          ")


def _element_table(
    request: ElementRequest,
    mesh: Mesh,
    group: ElementGroup,
    inside: IntArray,
    names: list[str],
    values: FloatArray,
    sections: Sections,
) -> str:
    """Return tables of values (elements, points, names), at the points or at the requested position."""
    position, lines, labels, values = _at_position(request.position, mesh, group, inside, values, sections)
    layout = _SECTION_POINTS if sections else _LAYOUTS[position]
    which = f"ELEMENTS WITH TYPE {group.type} {layout.title}"
    title = "   THE FOLLOWING TABLE IS PRINTED FOR " + (
        f"{which} AND BELONGING TO ELEMENT SET {request.elset}" if request.elset else f"ALL {which}"
    )
    return str(
        _Table(
            title,
            layout.head,
            12,
            f"{'':{layout.note}}NOTE",
            layout.indent,
            names,
            lines,
            labels,
            values,
            layout.where,
            _short,
        )
    )


def _at_position(
    position: Position, mesh: Mesh, group: ElementGroup, inside: IntArray, values: FloatArray, sections: Sections
) -> tuple[Position, list[str], list[str], FloatArray]:
    """Return position, heads of lines, labels for extremes, and values (lines, names) of (elements, points, names).

    Values that are not extrapolated are those at the points.
    """
    elements, nodes = group.labels[inside].tolist(), group.nodes[inside]
    matrix = at_centroid(group.type) if position is Position.CENTROID else at_nodes(group.type)
    if position is Position.POINTS or matrix is None or sections:
        points = [f"{point:4d}       " for point in range(1, values.shape[1] + 1)]
        if sections:
            points = [f"{k // len(sections) + 1:4d}{sections[k % len(sections)]:4d}   " for k in range(values.shape[1])]
        lines = [f"{label:12d}{point}" for label in elements for point in points]
        labels = [str(label) for label in elements for _ in points]
        return Position.POINTS, lines, labels, values.reshape(-1, values.shape[2])
    values = np.einsum("np,epv->env", matrix, values)
    flat = values.reshape(-1, values.shape[2])
    if position is Position.CENTROID:
        return position, [f"{label:12d}     " for label in elements], [str(label) for label in elements], flat
    if position is Position.NODES:
        names = mesh.labels[nodes].tolist()
        lines = [f"{label:12d}{name:11d}       " for label, row in zip(elements, names, strict=True) for name in row]
        return position, lines, [str(label) for label in elements for _ in names[0]], flat
    used, positions = np.unique(nodes, return_inverse=True)
    mean = np.zeros((len(used), flat.shape[1]))
    np.add.at(mean, positions.ravel(), flat)
    mean /= np.bincount(positions.ravel())[:, None]
    order = np.argsort(mesh.labels[used], kind="stable")
    labels = [_label(mesh, node) for node in used[order].tolist()]
    return position, [f"{label:>12}     " for label in labels], labels, mean[order]


def _element_values(
    group: ElementGroup, state: ElementState, inside: IntArray, variables: tuple[str, ...]
) -> list[tuple[list[str], FloatArray, Sections]]:
    """Return names and values (elements, points, names) of the elements' variables, and the section points.

    Section points have a line where Abaqus prints them by default: the first and the last one of shells, some of beams.
    SDV are the SVARS of a user element, one line per element, and STATEV at the points of a built-in one; other names
    (S, S11, DAMAGE, ...) are values at the points and need elements whose SVARS are known.
    """
    svars = state.svars[inside]
    columns: list[tuple[list[str], FloatArray, Sections]] = []
    if state.variables is not None:
        known = {name: k for k, name in enumerate(state.variables.names)}
        known |= {name: known[own] for name, own in state.variables.aliases}
        names = [name for variable in variables for name in known if _includes(variable, name)]
        if names:
            values, count = point_values(state, state.variables)[inside], state.variables.sections
            of_section = values.reshape(len(values), values.shape[1] // count, count, values.shape[2])
            sides = state.variables.sides
            for some, section_points in (
                ([name for name in names if name not in state.variables.whole], sides),
                ([name for name in names if name in state.variables.whole], ()),
            ):
                chosen = of_section[:, :, [section_point for *_, section_point in section_points] or [0]][
                    ..., [known[name] for name in some]
                ]
                if some:
                    numbers = tuple(number for _, number, _ in section_points)
                    columns.append(
                        (some, chosen.reshape(len(values), chosen.shape[1] * chosen.shape[2], len(some)), numbers)
                    )
    if group.definition is None:
        return columns
    names = [f"SDV{k}" for k in range(1, svars.shape[1] + 1)]
    names = [name for variable in variables for name in names if variable in ("SDV", name)]
    if names:
        columns.append((names, svars[:, None, [int(name[3:]) - 1 for name in names]], ()))
    return columns


def _includes(variable: str, name: str) -> bool:
    """Return whether a requested variable (S, E, S11, SDV, SF, SE) includes a component (S11, SDV1, SF1, SM1, SK1)."""
    if (variable, name[:2]) in (("SF", "SM"), ("SE", "SK")):
        return True
    suffix = name.removeprefix(variable)
    return name == variable or (
        name.startswith(variable) and (suffix in _SUFFIXES or (variable in _NUMBERED and suffix.isdecimal()))
    )


def _row(values: list[float]) -> str:
    return "".join(map(_short, values))


def _short(value: float) -> str:
    return general(value, 12, 4)


def _label(mesh: Mesh, node: int) -> str:
    """Return the label of a node without the name of its instance, for which a table has no space."""
    return str(int(mesh.labels[node]))
