# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Peel test: a film that is pulled off a rigid base at 90 degrees, with large displacements."""

from __future__ import annotations

import numpy as np

from harness.delamination.kernels import uel_property, user_element
from harness.delamination.keywords import element_block, keyword, node_block, node_set, number, text

LENGTH, THICKNESS, CRACK = 40.0, 0.4, 6.0
"""Of the film, and of its free end, mm; it is 1 mm wide."""

QUADS = (240, 2)
"""Along the film and through it."""

MODULUS, STIFFNESS, STRENGTH = 5000.0, 2000.0, 6.0
"""Of the film (MPa), of the interface (N/mm^3) and its strength (MPa)."""

TOUGHNESS = 0.5
"""N/mm: the force per width in steady state, where the film bends in a shape that moves along, and does not stretch."""

LAW = {
    "THICKNESS": 1.0,
    "ALPHAN": STIFFNESS,
    "ALPHAT": STIFFNESS,
    "SIGMAMAX": STRENGTH,
    "TAUMAX": STRENGTH,
    "GIC": TOUGHNESS,
    "GIIC": TOUGHNESS,
    "LAW": 2,
    "ETA": 1.0,
    "INTEGRATION": 1,
}
"""Properties of U2 that make it COH2D4: any mode mix has the same energy, points at the nodes."""

LIFT = 25.0
"""Of the free end, mm; it may move along the base."""


def peel_files() -> dict[str, str]:
    """The decks: with COH2D4, and with U2 in its place."""
    return {"peel.inp": _deck("COH2D4"), "peel_u2.inp": _deck("U2")}


def _deck(kind: str) -> str:
    """The deck with a type of interface element."""
    along, through = QUADS
    labels = 1 + np.arange((along + 1) * (through + 1)).reshape(through + 1, along + 1)
    y, x = np.meshgrid(np.linspace(0.0, THICKNESS, through + 1), np.linspace(0.0, LENGTH, along + 1), indexing="ij")
    first = round(CRACK / LENGTH * along)
    base = labels.max() + 1 + np.arange(along + 1 - first)
    places = np.column_stack([np.append(x, x[0, first:]), np.append(y, y[0, first:])])
    film = np.stack([labels[:-1, :-1], labels[:-1, 1:], labels[1:, 1:], labels[1:, :-1]], axis=-1).reshape(-1, 4)
    interface = np.stack([base[:-1], base[1:], labels[0, first + 1 :], labels[0, first:-1]], axis=-1)
    lines = [
        "*HEADING",
        f"Peel test at 90 degrees, CPS4R and {kind} with NLGEOM",
        "** the left end of the film is lifted, the crack runs to the right",
        "** written by python -m harness.delamination.decks; units N, mm, MPa",
        *node_block(np.append(labels, base), places),
        *element_block("CPS4R", "FILM", film, 1),
        *(user_element(2, "UNSYMM") if kind == "U2" else []),
        *element_block(kind, "INTERFACE", interface, 1 + len(film)),
        *node_set("BASE", base),
        *node_set("END", labels[through // 2, :1]),
        "*SECTION CONTROLS, NAME=BENDING, HOURGLASS=ENHANCED",
        "*SOLID SECTION, ELSET=FILM, MATERIAL=FILM, CONTROLS=BENDING",
        "1.",
        "*MATERIAL, NAME=FILM",
        "*ELASTIC",
        f"{number(MODULUS)}, 0.",
        *(uel_property(2, "INTERFACE", LAW) if kind == "U2" else _cohesive_section()),
        keyword("STEP", "NLGEOM", *(["UNSYMM=YES"] if kind == "U2" else []), INC=2000),
        "*STATIC",
        "0.005, 1., 1.e-7, 0.01",
        "*BOUNDARY",
        "BASE, 1, 2",
        f"END, 2, 2, {number(LIFT)}",
        "*OUTPUT, FIELD, FREQUENCY=10",
        "*NODE OUTPUT",
        "U, RF",
        "*ELEMENT OUTPUT",
        "S, SDEG",
        "*OUTPUT, HISTORY",
        "*NODE OUTPUT, NSET=END",
        "U1, U2, RF2",
        "*END STEP",
    ]
    return text(lines)


def _cohesive_section() -> list[str]:
    """Section and material of COH2D4."""
    return [
        "*COHESIVE SECTION, ELSET=INTERFACE, MATERIAL=INTERFACE, RESPONSE=TRACTION SEPARATION",
        "1.",
        "*MATERIAL, NAME=INTERFACE",
        "*ELASTIC, TYPE=TRACTION",
        ", ".join([number(STIFFNESS)] * 3),
        "*DAMAGE INITIATION, CRITERION=QUADS",
        ", ".join([number(STRENGTH)] * 3),
        "*DAMAGE EVOLUTION, TYPE=ENERGY",
        number(TOUGHNESS),
    ]
