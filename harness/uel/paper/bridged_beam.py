# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Double cantilever beam with fibre bridging under cycles: the published example of CompDam (N, mm, MPa).

NASA's CompDam (nasa/CompDam_DGD) shows its fatigue law on a double cantilever beam in two laws side by side, a tall
narrow one and the tail of the bridging fibres, both with CF20. The beam is opened, and held under cycles. Its arms are
six continuum shells each; `bridged_shells` has them, for the load at the end of the opening.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from uel.delamination.kernels import uel_property, user_element
from uel.delamination.keywords import (
    element_block,
    integer_table,
    keyword,
    node_block,
    node_set,
    number,
    table,
    text,
    wrapped,
)
from uel.delamination.mesh import TwoArmMesh, crack_columns, two_arms
from uel.delamination.plates import two_plates
from uel.delamination.steps import Output

HEIGHT, CRACK, LENGTH = 2.25, 50.8, 100.0
"""Height of an arm, length of the crack and of the beam (mm). The last is not that of the source, where it is far."""
REFINED, SIZE, ROWS = 7.5, 0.1, 4
"""Length of the fine mesh ahead of the crack, that of its elements (mm), and quads through an arm."""
OPENING = 1.92
"""Opening of both arms together (mm)."""
RATIO, CYCLES, JUMP = 0.1, 1e5, 0.05
"""R, the number of cycles, and DAMAGEJUMP."""
MODULI, RATIOS, SHEAR = (
    (146671.0, 8703.0, 8703.0),
    (0.32, 0.32, 8703.0 / (2.0 * 3001.0) - 1.0),
    (5164.0, 5164.0, 3001.0),
)
LAWS: Mapping[str, Mapping[str, float]] = {
    "TALL": {"SIGMAMAX": 80.0, "TAUMAX": 99.0, "GIC": 0.214, "GIIC": 0.59, "ETA": 2.1, "ALPHAN": 2e5, "ALPHAT": 2e5},
    "TAIL": {"SIGMAMAX": 0.8, "TAUMAX": 1.0, "GIC": 0.140, "GIIC": 0.193, "ETA": 3.0, "ALPHAN": 2e3, "ALPHAT": 2e3},
}
"""Strengths, fracture energies, exponent of Benzeggagh and Kenane, and stiffness."""

# directions (two lines), material
_PLY = [
    *("*ORIENTATION, NAME=ALONG", "1., 0., 0., 0., 1., 0.", "*MATERIAL, NAME=PLY"),
    *("*ELASTIC, TYPE=ENGINEERING CONSTANTS", *wrapped([*MODULI, *RATIOS, *SHEAR])),
]


def mesh(size: float = SIZE, rows: int = ROWS) -> TwoArmMesh:
    """Mesh the beam with elements of `size` (mm) from the crack on."""
    x = crack_columns(LENGTH, (CRACK - 0.5, CRACK + REFINED), size, ratio=1.2, largest=(1.0, 1.0))
    return two_arms(x, HEIGHT, rows, CRACK)


def bridged_beam(size: float = SIZE, rows: int = ROWS, quads: str = "CPE4I", *, large: bool = False) -> str:
    """Write the deck: quads of `size` (mm) and so many rows; large: NLGEOM."""
    grid = mesh(size, rows)
    lines = ["*HEADING", "Double cantilever beam with fibre bridging under cycles, after CompDam's example"]
    lines += ["** right end clamped; outer left corners held apart; two laws between the same nodes"]
    lines += ["** written by python -m uel.paper.decks; units N, mm, MPa"]
    lines += [*node_block(*grid.nodes()), *node_set("RIGHT", grid.edge(-1))]
    lines += node_set("TOP", grid.top_line[:1]) + node_set("BOTTOM", grid.line(1)[:1])
    lines += [keyword("ELEMENT", TYPE=quads, ELSET="QUADS")]
    lines += integer_table(np.concatenate([grid.quads("lower"), grid.quads("upper")])).splitlines()
    lines += ["*SOLID SECTION, ELSET=QUADS, MATERIAL=PLY, ORIENTATION=ALONG", "1."]
    lines += [*_PLY, *user_element(2)]
    faces = grid.interface4()[:, 1:]
    for k, (name, law) in enumerate(LAWS.items()):
        lines += element_block("U2", name, faces, int(grid.interface_labels[0]) + k * grid.stride)
        values = {"THICKNESS": 1.0, "LAW": 2, "FATIGUE": 2, "LOADRATIO": RATIO, "DAMAGEJUMP": JUMP, **law}
        lines += uel_property(2, name, values)
    lines += ["*BOUNDARY", "RIGHT, 1, 2"]
    opening = number(0.5 * OPENING)
    held = ["*BOUNDARY", f"TOP, 2, 2, {opening}", f"BOTTOM, 2, 2, -{opening}"]
    steps = (("Opening", 100, (0.1, 1.0, 1e-6, 0.1), 10, held), ("Cycles", 10000, (1.0, CYCLES, 1e-6, CYCLES), 20, ()))
    options = {"NLGEOM": "YES"} if large else {}
    for title, limit, static, every, loads in steps:
        output = Output(
            f"FREQUENCY={every}", stresses=False, history={"TOP": "U2, RF2"}, energies="ALLSE, ALLPD, ALLVD, ALLWK"
        )
        lines += [keyword("STEP", INC=limit, UNSYMM="YES", **options), title, "*STATIC", *table([static])]
        lines += [*loads, *output.lines(), *(f"*ENERGY OUTPUT, ELSET={name}\nALLPD" for name in LAWS), "*END STEP"]
    return text(lines)


def bridged_shells(shells: int = 6, across: int = 2) -> str:
    """Write the deck of the source's arms: SC8R, so many in an arm and over the width, opened with NLGEOM."""
    # the beam of the source ends 3 arms beyond the fine mesh
    x = crack_columns(
        CRACK + REFINED + 3.0 * HEIGHT, (CRACK - 0.5, CRACK + REFINED), SIZE, ratio=1.2, largest=(1.0, 1.0)
    )
    grid = two_plates(x, np.linspace(0.0, 1.0, across + 1), np.linspace(0.0, HEIGHT, shells + 1), CRACK)
    labels, points = grid.nodes()
    arms = np.concatenate([grid.bricks(plate, layer) for plate in (0, 1) for layer in range(shells)])
    lines = ["*HEADING", "Double cantilever beam with fibre bridging in continuum shells, after CompDam's example"]
    lines += [*node_block(labels, points), *element_block("SC8R", "ARMS", arms, 1), *user_element(7)]
    faces = grid.interface("U7")
    for k, (name, law) in enumerate(LAWS.items()):
        lines += element_block("U7", name, faces, 1 + len(arms) + k * len(faces))
        lines += uel_property(7, name, {"LAW": 2, **law})
    lines += ["*SHELL SECTION, ELSET=ARMS, MATERIAL=PLY, ORIENTATION=ALONG, STACK DIRECTION=3"]
    lines += [f"{number(HEIGHT / shells)}, 5", *_PLY[:2], "3, 0.", *_PLY[2:]]
    for name, face in (("TOP", grid.labels[1][-1]), ("BOTTOM", grid.labels[0][0])):
        lines += node_set(name, face[:, 0])
    opening = number(0.5 * OPENING)
    lines += ["*STEP, INC=100, UNSYMM=YES, NLGEOM=YES", "*STATIC", "0.1, 1., 1e-6, 0.1", "*BOUNDARY"]
    lines += ["TOP, 1, 2", "BOTTOM, 1, 2", f"TOP, 3, 3, {opening}", f"BOTTOM, 3, 3, -{opening}"]
    return text([*lines, "*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=TOP", "RF3, U3", "*END STEP"])
