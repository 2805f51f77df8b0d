# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tables of *NODE PRINT and *EL PRINT in the .dat file, laid out as Abaqus prints them.

Lines whose values are all zero are left out of a table, as Abaqus does, but count for MAXIMUM and MINIMUM.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.arrays import FloatArray, IntArray, first_largest
from harness.model.mesh import ElementGroup, Mesh
from harness.model.model import Model
from harness.model.nodal import NodalIndex
from harness.model.records import ElementState, Solution
from harness.model.steps import ElementRequest, NodeRequest
from harness.output.formats import general
from harness.output.points import point_values

COLUMNS = 9  # of a table of Abaqus
_SUFFIXES = ("11", "22", "33", "12", "13", "23")


@dataclass(frozen=True, slots=True)
class _Table:
    """Columns of values (rows, columns) with the heads of lines and columns."""

    title: str
    head: str
    indent: int
    names: list[str]
    lines: list[str]
    labels: list[str]
    values: FloatArray
    where: str
    totals: bool = False

    def __str__(self) -> str:
        if not len(self.values) or not self.values.any():
            return f"\n\n{self.title}\n\n          ALL VALUES IN THIS TABLE ARE ZERO\n"
        text = f"\n\n{self.title}\n\n{self.head}\n\n"
        for line, values in zip(self.lines, self.values.tolist(), strict=True):
            if any(values):
                text += line + _row(values) + "\n"
        for name, best in (
            ("MAXIMUM", first_largest(self.values)),
            ("MINIMUM", first_largest(-self.values)),
        ):
            extremes = np.take_along_axis(self.values, best[None, :], axis=0)[0]
            text += f"\n{f' {name}':<{self.indent}}{_row(extremes.tolist())}\n"
            text += f"{f' {self.where}':<{self.indent - 1}}" + "".join(f"{self.labels[k]:>12}" for k in best) + "\n"
        if self.totals:
            text += f"\n{' TOTAL':<{self.indent}}{_row(self.values.sum(axis=0).tolist())}\n"
        return text


def node_tables(request: NodeRequest, model: Model, solution: Solution, index: NodalIndex) -> str:
    """Tables of one *NODE PRINT request; of each variable the components that the nodes have."""
    components = index.components(request.variables, request.nodes, harmonic=solution.imaginary is not None)
    title = "   THE FOLLOWING TABLE IS PRINTED FOR " + (
        f"NODES BELONGING TO NODE SET {request.nset}" if request.nset else "ALL NODES"
    )
    labels = [_label(model.mesh, node) for node in request.nodes.tolist()]
    text = ""
    for first in range(0, len(components), COLUMNS):
        part = components[first : first + COLUMNS]
        values = np.zeros((len(request.nodes), len(part)))
        for k, component in enumerate(part):
            position = index.find(request.nodes, component.dof)
            values[:, k] = np.append(component.values(solution), 0.0)[position]
        text += str(
            _Table(
                title,
                "       NODE FOOT-   " + "".join(f"{component.name:<12}" for component in part) + "\n            NOTE",
                15,
                [component.name for component in part],
                [f"{label:>11}    " for label in labels],
                labels,
                values,
                "AT NODE",
                request.totals,
            )
        )
    return text


def element_tables(request: ElementRequest, model: Model, solution: Solution) -> str:
    """Tables of one *EL PRINT request, one for each element type that keeps any of the variables."""
    text = ""
    for group, inside, state in _chosen(request, model, solution):
        for names, values in _element_values(state, inside, request.variables):
            text += _element_table(request, group, inside, names, values)
    return text


def missing_variables(
    request: NodeRequest | ElementRequest, model: Model, solution: Solution, index: NodalIndex
) -> list[str]:
    """Variables of a request that none of its nodes or elements has."""
    if isinstance(request, NodeRequest):
        harmonic = solution.imaginary is not None
        return [name for name in request.variables if not index.components((name,), request.nodes, harmonic=harmonic)]
    chosen = _chosen(request, model, solution)
    return [
        name
        for name in request.variables
        if not any(_element_values(state, inside, (name,)) for _, inside, state in chosen)
    ]


def _chosen(
    request: ElementRequest, model: Model, solution: Solution
) -> list[tuple[ElementGroup, IntArray, ElementState]]:
    """Groups with elements of the request, which of their elements, and their state."""
    states = {state.group: state for state in solution.elements}
    chosen = []
    first = 0
    for k, group in enumerate(model.groups):
        inside = request.elements[(request.elements >= first) & (request.elements < first + len(group.labels))] - first
        first += len(group.labels)
        if len(inside) and k in states:
            chosen.append((group, inside, states[k]))
    return chosen


def _element_table(
    request: ElementRequest, group: ElementGroup, inside: IntArray, names: list[str], values: FloatArray
) -> str:
    """Tables of values (elements, points, names)."""
    labels = group.labels[inside].tolist()
    points = range(1, values.shape[1] + 1)
    title = f"   THE FOLLOWING TABLE IS PRINTED FOR ELEMENTS WITH TYPE {group.type} AT THE INTEGRATION POINTS" + (
        f" AND BELONGING TO ELEMENT SET {request.elset}" if request.elset else ""
    )
    text = ""
    for start in range(0, len(names), COLUMNS):
        part = names[start : start + COLUMNS]
        text += str(
            _Table(
                title,
                "    ELEMENT  PT FOOT-" + "".join(f"{name:>10}  " for name in part) + "\n                NOTE",
                22,
                part,
                [f"{label:12d}{point:4d}      " for label in labels for point in points],
                [str(label) for label in labels for _ in points],
                values[:, :, start : start + COLUMNS].reshape(-1, len(part)),
                "ELEMENT",
            )
        )
    return text


def _element_values(
    state: ElementState, inside: IntArray, variables: tuple[str, ...]
) -> list[tuple[list[str], FloatArray]]:
    """Names and values (elements, points, names) of the variables that the elements keep.

    SDV are the SVARS of a user element, one line an element; other names (S, S11, DAMAGE, ...) are values at the
    points and need elements whose SVARS are known.
    """
    svars = state.svars[inside]
    found: list[tuple[list[str], FloatArray]] = []
    if state.variables is not None:
        known = {name: k for k, name in enumerate(state.variables.names)}
        known |= {name: known[own] for name, own in state.variables.aliases}
        names = [name for variable in variables for name in known if _asked(variable, name)]
        if names:
            values = point_values(state, state.variables)[inside]
            found.append((names, values[:, :, [known[name] for name in names]]))
    names = [f"SDV{k}" for k in range(1, svars.shape[1] + 1)]
    names = [name for variable in variables for name in names if variable in ("SDV", name)]
    if names:
        found.append((names, svars[:, None, [int(name[3:]) - 1 for name in names]]))
    return found


def _asked(variable: str, name: str) -> bool:
    """True if a variable as asked for (S, E, S11) takes in a component (S11)."""
    return name == variable or (name.startswith(variable) and name[len(variable) :] in _SUFFIXES)


def _row(values: list[float]) -> str:
    return "".join(general(value, 12, 4) for value in values)


def _label(mesh: Mesh, node: int) -> str:
    """Number of a node; a table has no room for the name of its instance."""
    return str(int(mesh.labels[node]))
