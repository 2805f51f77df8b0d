# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks of a beam of solids, the end of which follows a reference node."""

from small_decks import body_lines

LENGTH, HIGH, YOUNG, CELLS = 10.0, 0.5, 1e4, 20
OUTPUT = "*OUTPUT, FIELD\n*ELEMENT OUTPUT\nS\n*NODE OUTPUT\nU\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=REF\nU, UR, RM, RF"
COUPLING = "*SURFACE, NAME=END, TYPE=NODE\nEND\n*COUPLING, CONSTRAINT NAME=C, REF NODE=900, SURFACE=END\n*KINEMATIC"
DISTRIBUTING = COUPLING.replace("*KINEMATIC", "*DISTRIBUTING")


def beam(
    element_type="CPS8R", *, high=HIGH, reference=(LENGTH, HIGH / 2), constraint=COUPLING, held="START, 1\nMIDDLE, 2"
):
    """A row of elements along axis 1, the end of which follows node 900, or is free."""
    space = element_type.startswith("C3D")
    nodes, numbers, elements = [], {}, []
    for k in range(2 * CELLS + 1):
        for j in range(3):
            if k % 2 == 0 or j != 1:
                numbers[k, j] = len(nodes)
                nodes.append([LENGTH * k / (2 * CELLS), high * j / 2])
    if space:
        corners = [(0, 0), (2, 0), (2, 2), (0, 2)]
        layer = len(nodes)
        nodes = [[*x, z] for z in (0.0, high) for x in nodes]
        for c in range(CELLS):
            flat = [numbers[2 * c + i, j] for i, j in corners]
            elements.append([*flat, *(n + layer for n in flat)])
    else:
        around = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
        elements = [[numbers[2 * c + i, j] for i, j in around] for c in range(CELLS)]
    used = {n for element in elements for n in element}
    ends = {"START": 0.0, "END": LENGTH}
    lines = body_lines(element_type, nodes, elements)
    lines += ["*NODE, NSET=REF", "900, " + ", ".join(map(str, reference))]
    for name, x in ends.items():
        lines += [f"*NSET, NSET={name}", *(str(n + 1) for n in sorted(used) if nodes[n][0] == x)]
    middle = [n for n in sorted(used) if nodes[n][0] == 0 and nodes[n][1] == (0 if space else high / 2)]
    lines += ["*NSET, NSET=MIDDLE", *(str(n + 1) for n in middle)]
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "1.", "*MATERIAL, NAME=M", f"*ELASTIC\n{YOUNG}, 0."]
    lines += [constraint] if constraint else []
    return [*lines, "*BOUNDARY", held] if held else lines


def last(result, name):
    """Last value of the reference node."""
    return next(values[-1] for column, values in result.history.items() if column.startswith(f"{name}["))


def step(*loads, increments=10, how="*STATIC", name="*STEP, NLGEOM, INC=100"):
    times = f"{how}\n{1 / increments}, 1., 1e-6, {1 / increments}"
    return [name, times, *loads, OUTPUT, "*END STEP"]


def beam_of_quads(lines):
    """The corners of the elements alone."""
    found = []
    for line in lines:
        words = line.split(", ")
        found.append(", ".join(words[:5]) if len(words) == 9 else line)
    return found
