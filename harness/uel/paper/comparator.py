# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks that compare the interface elements with Abaqus' own, COH2D4 and COH3D8 (N, mm, MPa).

One element opened in mixed mode, and the fixed-ratio mixed-mode specimen with the layup [0/90], between CPS4 quads.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uel.delamination import flexure, specimens
from uel.delamination.blocks import BY_EQUATION_21, Interface, Specimen, cohesive_section, interface_values
from uel.delamination.kernels import uel_property, user_element
from uel.delamination.keywords import keyword, node_block, number, table, text
from uel.delamination.materials import PLY_0, PLY_90, TABLE_2
from uel.delamination.steps import Increments

ETA = 2.0
POWER = 1.5
MIXES = {"bk": Interface("U2", TABLE_2, law=2, eta=ETA), "power": Interface("U2", TABLE_2, law=2, power=POWER)}
"""Fracture energy in mixed mode."""

SIDE = 0.5
PATH = 0.06
"""Size of the single element; its separation at the end (mm), opening and sliding in equal parts, beyond failure."""
ELEMENTS = ("COH2D4", "COH3D8", "U2")

LAW = replace(MIXES["bk"], newton_cotes=True)
INTERFACES = {"coh2d4": replace(LAW, type="COH2D4"), "u2": LAW, "u4": replace(LAW, type="U4", beta=BY_EQUATION_21)}
"""Interfaces of the specimen by the end of the deck's name."""
NAMES = {
    "coh2d4": "cohesive elements of Abaqus",
    "u2": "standard elements",
    "u4": "consistent elements",
}


def element_deck(element: str, mix: str) -> str:
    """Write one element whose top moves away along the bisector of normal and tangent, all nodes prescribed."""
    interface = replace(MIXES[mix], type=element)
    lines = ["*HEADING", f"One element {element}, opening and sliding in equal parts, {mix.upper()} criterion"]
    lines.append("** written by python -m uel.paper.decks; units N, mm, MPa")
    face = np.array([[0.0, 0.0], [SIDE, 0.0]])
    if element == "COH3D8":
        face = SIDE * np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    top = face if element == "COH3D8" else face[::-1]
    count = 2 * len(face)
    labels = np.arange(1, count + 1)
    lines += node_block(labels, np.concatenate([face, top]))
    lines += [keyword("NSET", "GENERATE", NSET="BOTTOM"), *table([(1, count // 2, 1)])]
    lines += [keyword("NSET", "GENERATE", NSET="TOP"), *table([(count // 2 + 1, count, 1)])]
    if not interface.built_in:
        lines += user_element(2)
    lines += [keyword("ELEMENT", TYPE=element, ELSET="INTERFACE"), *table([[1, *labels.tolist()]])]
    if interface.built_in:
        lines += cohesive_section(interface, SIDE)
    else:
        specimen = Specimen("element", specimens.patch_mesh(0.0), interface, SIDE, PLY_0, PLY_0)
        lines += uel_property(2, "INTERFACE", interface_values(specimen))
    normal = 3 if element == "COH3D8" else 2
    step = 1.0 / 2000.0
    distance = PATH * np.sqrt(0.5)
    lines += ["*STEP, INC=2000, UNSYMM=YES", "*STATIC, DIRECT", *table([(step, 1.0)])]
    lines += ["*BOUNDARY", f"BOTTOM, 1, {normal}"]
    lines += [f"TOP, {dof}, {dof}, {number(distance)}" for dof in (1, normal)]
    lines += ["TOP, 2, 2"] if element == "COH3D8" else []
    lines += ["*OUTPUT, FIELD, FREQUENCY=500", "*NODE OUTPUT", "U, RF", "*OUTPUT, HISTORY", "*ENERGY OUTPUT"]
    lines += ["ALLSE, ALLDMD, ALLCD, ALLWK, ETOTAL" if interface.built_in else "ALLSE, ALLPD, ALLVD, ALLWK, ETOTAL"]
    return text([*lines, "*END STEP"])


INCREMENTS = Increments(initial=0.05, smallest=1e-7, largest=0.05, limit=1000, discontinuous=True, line_search=5)
END = 4.4
"""Displacement at the end (mm), shortly before the crack snaps: rounding decides the moment of a snap."""


def comparator_files() -> dict[str, str]:
    """Write the decks and mesh files of abaqus_inputs/cohesive."""
    files = {f"{element.lower()}_{mix}.inp": element_deck(element, mix) for element in ELEMENTS for mix in MIXES}
    mesh = flexure.frmm_mesh(0.25)
    files |= specimens.mesh_files("frmm", mesh, (4, 8))
    for kind, interface in INTERFACES.items():
        specimen = Specimen("frmm", mesh, interface, specimens.WIDTH, PLY_90, PLY_0, "CPS4")
        title = f"Fixed-ratio mixed mode, [0/90], {NAMES[kind]}, BK criterion"
        files[f"frmm_{kind}.inp"] = flexure.frmm_deck(title, specimen, END, INCREMENTS, 5)
    return files
