# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Cook's tapered panel of an orthotropic ply at 30 degrees: general quads, rotated material, in-plane bending.

Contraction out of the plane is left out (nu13 = nu23 = 0): CalculiX expands CPS4 into a brick whose thickness follows
the plane nodes, so that plane stress holds only on average, and exactly if the third direction is decoupled.
"""

from __future__ import annotations

import numpy as np

from uel.delamination.kernels import uel_property, user_element
from uel.delamination.keywords import integer_table, keyword, node_block, node_set, table, text, wrapped
from uel.delamination.mesh import TwoArmMesh
from uel.model.arrays import FloatArray

N = 8
THICKNESS = 2.0
TRACTION = 0.1
CONSTANTS = (1000.0, 100.0, 100.0, 0.3, 0.0, 0.0, 50.0, 50.0, 50.0)
ANGLE = np.pi / 6.0
# Cook's corners: lower left, lower right, upper right, upper left (mm)
CORNERS = np.array([[0.0, 0.0], [48.0, 44.0], [48.0, 60.0], [0.0, 44.0]])


def cook_files() -> dict[str, str]:
    """Write the decks with CPS4 and U1, and the one for CalculiX with what both share."""
    # one arm of N rows: the second arm of the mesh is empty
    mesh = TwoArmMesh(np.linspace(0.0, 1.0, N + 1), np.linspace(0.0, 1.0, N + 1), np.array([1.0]), 0, np.zeros(N + 1))
    labels, unit = mesh.nodes()
    labels, unit = labels[: (N + 1) ** 2], unit[: (N + 1) ** 2]
    right = np.array([mesh.line(number)[-1] for number in range(1, N + 2)])
    left = np.array([mesh.line(number)[0] for number in range(1, N + 2)])
    nodes = [*node_block(labels, _taper(unit)), *node_set("LEFT", left)]
    nodes += [*node_set("CORNER_TOP", right[-1:]), *node_set("CORNER_BOTTOM", right[:1])]
    # equal forces of the elements' edges, as nodal forces
    share = np.full(N + 1, TRACTION * (CORNERS[2, 1] - CORNERS[1, 1]) / N)
    share[[0, -1]] *= 0.5
    loads = table((int(label), 2, float(force)) for label, force in zip(right, share, strict=True))
    return {
        "cook_nodes.inp": text(nodes),
        "cook_quads.inp": integer_table(mesh.quads("lower")),
        "cook_loads.inp": text(["*CLOAD", *loads]),
        "cook_cps4.inp": _deck("CPS4"),
        "cook_u1.inp": _deck("U1"),
        "cook_ccx.inp": _calculix(),
    }


def _taper(unit: FloatArray) -> FloatArray:
    """Map the unit square to the panel bilinearly, rounded to what the deck prints."""
    x, y = unit[:, :1], unit[:, 1:]
    low = (1.0 - x) * CORNERS[0] + x * CORNERS[1]
    high = (1.0 - x) * CORNERS[3] + x * CORNERS[2]
    return np.asarray(np.round((1.0 - y) * low + y * high, 9))


def _head(title: str) -> list[str]:
    return ["*HEADING", title, "** units N, mm, MPa", "*INCLUDE, INPUT=cook_nodes.inp"]


def _material() -> list[str]:
    axes = [np.cos(ANGLE), np.sin(ANGLE), 0.0, -np.sin(ANGLE), np.cos(ANGLE), 0.0]
    lines = ["*MATERIAL, NAME=PLY", "*ELASTIC, TYPE=ENGINEERING CONSTANTS", *wrapped(CONSTANTS)]
    return [*lines, "*ORIENTATION, NAME=PLY_AXES", *table([axes]), "3, 0."]


def _deck(quads: str) -> str:
    lines = _head(f"Cook's panel, orthotropic at 30 degrees, {quads}")
    if quads == "U1":
        lines += user_element(1, INTEGRATION=4, TENSOR="PSTRESS")
    lines += [keyword("ELEMENT", TYPE=quads, ELSET="QUADS", INPUT="cook_quads.inp"), *_material()]
    section = {"MATERIAL": "PLY", "ORIENTATION": "PLY_AXES"}
    if quads == "U1":
        lines += uel_property(1, "QUADS", {"THICKNESS": THICKNESS, "PLANE": 0, "FACE": 0}, **section)
    else:
        lines += [keyword("SOLID SECTION", ELSET="QUADS", **section), *wrapped([THICKNESS])]
    lines += ["*BOUNDARY", "LEFT, 1, 2", "*STEP, INC=1", "Shear on the right edge", "*STATIC", "1., 1., 1., 1."]
    lines += ["*INCLUDE, INPUT=cook_loads.inp", "*OUTPUT, FIELD, FREQUENCY=1", "*NODE OUTPUT", "U, RF"]
    lines.append("*OUTPUT, HISTORY, FREQUENCY=1")
    for name in ("CORNER_TOP", "CORNER_BOTTOM"):
        lines += [keyword("NODE OUTPUT", NSET=name), "U1, U2"]
    lines += ["*NODE OUTPUT, NSET=LEFT", "RF1, RF2", "*END STEP"]
    return text(lines)


def _calculix() -> str:
    lines = [*_head("Cook's panel for CalculiX: ccx cook_ccx"), "*ELEMENT, TYPE=CPS4, ELSET=QUADS"]
    lines += ["*INCLUDE, INPUT=cook_quads.inp", *_material()]
    lines += ["*SOLID SECTION, ELSET=QUADS, MATERIAL=PLY, ORIENTATION=PLY_AXES", *wrapped([THICKNESS])]
    lines += ["*BOUNDARY", "LEFT, 1, 2", "*STEP", "*STATIC", "1., 1.", "*INCLUDE, INPUT=cook_loads.inp"]
    for name in ("CORNER_TOP", "CORNER_BOTTOM"):
        lines += [keyword("NODE PRINT", NSET=name), "U"]
    return text([*lines, "*NODE PRINT, NSET=LEFT", "RF", "*END STEP"])
