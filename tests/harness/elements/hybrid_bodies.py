# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Bodies of hybrid elements with closed forms: a thick-walled cylinder, a cube that is pulled."""

import numpy as np
from small_decks import body_lines

from uel.model.element_types import CONTINUUM

INNER, OUTER = 1.0, 2.0


def grid(element_type, nodes_of_lines):
    """Nodes and elements of a rectangle mapped by a function of a unit square, of 4 or 8 nodes each."""
    count, place = nodes_of_lines
    quadratic = CONTINUUM[element_type].nodes == 8
    columns, rows = 2 * count[0] + 1, 2 * count[1] + 1
    numbers, nodes, elements = {}, [], []

    def node(i, j):
        if (i, j) not in numbers:
            numbers[i, j] = len(nodes)
            nodes.append(place(i / (columns - 1), j / (rows - 1)))
        return numbers[i, j]

    for j in range(0, rows - 2, 2):
        for i in range(0, columns - 2, 2):
            corners = [(i, j), (i + 2, j), (i + 2, j + 2), (i, j + 2)]
            middles = [(i + 1, j), (i + 2, j + 1), (i + 1, j + 2), (i, j + 1)]
            elements.append([node(*at) for at in (corners + middles if quadratic else corners)])
    return np.array(nodes), elements


def cylinder(element_type, material, *, step="*STEP", static="*STATIC\n1., 1.", load, count=8):
    """A slice of a thick-walled cylinder in plane strain: axisymmetric elements held along the axis."""
    nodes, elements = grid(element_type, ((count, 1), lambda s, t: [INNER + s * (OUTER - INNER), 0.2 * t]))
    lines = body_lines(element_type, nodes, elements)
    inside = [k for k, x in enumerate(nodes, start=1) if x[0] == INNER]
    lines += ["*NSET, NSET=INSIDE", *map(str, inside), "*ELSET, ELSET=FIRST", "1"]
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "", "*MATERIAL, NAME=M", material, step, static]
    lines += ["*BOUNDARY", "ALL, 2, 2", *load, "*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "U, RF"]
    return [*lines, "*OUTPUT, FIELD", "*ELEMENT OUTPUT", "S", "*END STEP"], nodes


def radial(history, nodes, what):
    """Last values of a component along the radius of all nodes."""
    return np.array([history[f"{what}1[ALL:{k}]"][-1] for k in range(1, len(nodes) + 1)])


CUBE_LINES = ["*BOUNDARY", "1, 1, 3", "4, 1", "5, 1", "8, 1", "2, 2", "5, 2", "6, 2", "2, 3", "3, 3", "4, 3"]


def cube(element_type, keyword, stretches, *, more=(), static="*STATIC\n0.1, 1., 1e-4, 0.25", step="*STEP, NLGEOM"):
    """A unit cube that is pulled along 1, and along 2 if there are two stretches, and free along the others."""
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
    lines = body_lines(element_type, corners, [range(8)])
    controls = ["*SECTION CONTROLS, NAME=C, HOURGLASS=ENHANCED"] if element_type == "C3D8RH" else []
    section = ", CONTROLS=C" if controls else ""
    lines += [f"*SOLID SECTION, ELSET=BODY, MATERIAL=M{section}", "", "*MATERIAL, NAME=M", keyword, *controls, *more]
    lines += [step, static, "*CONTROLS, PARAMETERS=FIELD", "1e-9, 1e-9", *CUBE_LINES]
    for direction, (stretch, nodes) in enumerate(zip(stretches, ((2, 3, 6, 7), (3, 4, 7, 8)), strict=False), start=1):
        lines += [f"{node}, {direction}, {direction}, {stretch - 1}" for node in nodes]
    lines += ["*OUTPUT, FIELD", "*ELEMENT OUTPUT", "S", "*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "U, RF"]
    return [*lines, "*END STEP"]
