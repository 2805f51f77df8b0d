# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Peel test: a film that is pulled off a rigid base at 90 degrees, with large displacements."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uel.delamination.blocks import Interface, bending_section, cohesive_section, law_values
from uel.delamination.kernels import formulations, uel_property, user_element
from uel.delamination.keywords import element_block, node_block, node_set, number, text
from uel.delamination.materials import Cohesive
from uel.delamination.plates import faces
from uel.delamination.steps import Output, static_step

LENGTH, THICKNESS, CRACK = 40.0, 0.4, 6.0
"""Length of the film, its thickness, and length of its free end, mm; it is 1 mm wide."""

QUADS = (240, 2)
"""Along the film and through it."""

MODULUS, STIFFNESS, STRENGTH = 5000.0, 2000.0, 6.0
"""Young's modulus of the film (MPa), stiffness (N/mm^3) and strength (MPa) of the interface."""

TOUGHNESS = 0.5
"""N/mm: the force per width in steady state, where the film bends in a shape that moves along, and does not stretch."""

STANDARD = Interface(
    "U2",
    Cohesive(STIFFNESS, STIFFNESS, STRENGTH, STRENGTH, TOUGHNESS, TOUGHNESS),
    law=2,
    eta=1.0,
    newton_cotes=True,
)
"""U2 with the properties of COH2D4: any mode mix has the same energy, points at the nodes."""

CONSISTENT = replace(STANDARD, type="U4", cohesive=STANDARD.cohesive.with_stiffness(0.0), newton_cotes=False)
"""U4 with the consistent law and an infinite stiffness."""

BASE_MODULUS = 1.0e6 * MODULUS
"""Young's modulus of the quads in the base that U4 owns, MPa: a rigid body has no stress that could count."""

LIFT = 25.0
"""Displacement of the free end, mm; it may move along the base."""


def peel_files() -> dict[str, str]:
    """Write the decks: with COH2D4, and with U2 and U4 in its place."""
    standard = {"peel.inp": _deck(replace(STANDARD, type="COH2D4")), "peel_u2.inp": _deck(STANDARD)}
    return standard | {"peel_u4.inp": _deck(CONSISTENT)}


def _deck(interface: Interface) -> str:
    """Write the deck with an interface."""
    kind = interface.type
    along, through = QUADS
    labels = 1 + np.arange((along + 1) * (through + 1)).reshape(through + 1, along + 1)
    y, x = np.meshgrid(np.linspace(0.0, THICKNESS, through + 1), np.linspace(0.0, LENGTH, along + 1), indexing="ij")
    first = round(CRACK / LENGTH * along)
    bonded = x[0, first:]
    # the surface of the base, with U4 a line of nodes within it as well
    depths = np.array([0.0, THICKNESS / through][: 2 if kind == "U4" else 1])
    base = labels.max() + 1 + np.arange(len(depths) * len(bonded)).reshape(len(depths), len(bonded))
    within, beside = np.meshgrid(-depths, bonded, indexing="ij")
    places = np.column_stack([np.append(x, beside), np.append(y, within)])
    film = faces(labels)
    if kind == "U4":
        interface_nodes = np.hstack([faces(base[::-1]), faces(labels[:2, first:])])
    else:
        interface_nodes = faces(np.stack([base[0], labels[0, first:]]))
    lines = [
        "*HEADING",
        f"Peel test at 90 degrees, CPS4R and {kind} with NLGEOM",
        "** the left end of the film is lifted, the crack runs to the right",
        "** written by python -m uel.paper.decks; units N, mm, MPa",
        *node_block(np.append(labels, base), places),
        *element_block("CPS4R", "FILM", film, 1),
        *([] if interface.built_in else user_element(int(kind[1:]))),
        *element_block(kind, "INTERFACE", interface_nodes, 1 + len(film)),
        *node_set("BASE", base.ravel()),
        *node_set("END", labels[through // 2, :1]),
        *bending_section("FILM", "FILM", MODULUS),
        *_properties(interface),
        *static_step(
            (0.005, 1.0, 1.0e-7, 0.01),
            ["BASE, 1, 2", f"END, 2, 2, {number(LIFT)}"],
            Output(history={"END": "U1, U2, RF2"}),
            limit=2000,
            unsymmetric=not interface.built_in,
            nlgeom=True,
        ),
    ]
    return text(lines)


def _properties(interface: Interface) -> list[str]:
    """Write the properties of the interface, 1 mm wide."""
    if interface.built_in:
        return cohesive_section(interface, 1.0)
    moduli = {"BOTTOM": BASE_MODULUS, "TOP": MODULUS} if interface.type == "U4" else {}
    plies = {
        f"{name} {side}": share * modulus
        for side, modulus in moduli.items()
        for name, share in (("E1", 1.0), ("E2", 1.0), ("G12", 0.5))
    }
    return uel_property(
        int(interface.type[1:]), "INTERFACE", law_values(interface) | plies | formulations("CPS4R") | {"THICKNESS": 1.0}
    )
