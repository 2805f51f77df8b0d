# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Double cantilever beam with slender arms in large rotations."""

from __future__ import annotations

import numpy as np

from uel.delamination.blocks import bending_section
from uel.delamination.kernels import formulations, uel_property, user_element
from uel.delamination.keywords import element_block, node_block, node_set, number, text
from uel.delamination.plates import faces
from uel.delamination.steps import Output, static_step

LENGTH, HEIGHT, CRACK = 40.0, 0.4, 10.0
"""Length of the specimen, height of an arm, length of the crack, mm; the width is 1 mm."""

QUADS = (240, 2)
"""Quads of an arm: along, through its height."""

MODULUS = 50000.0
STRENGTH, TOUGHNESS = 6.0, 0.5

OPENING = 9.0
"""Distance of the ends, mm: about half of the crack's length then."""

_LAW = {"LAW": 1, "THICKNESS": 1.0, "SIGMAMAX": STRENGTH, "TAUMAX": STRENGTH, "GIC": TOUGHNESS, "GIIC": TOUGHNESS}
_PLY = {"E1": MODULUS, "E2": MODULUS, "G12": MODULUS / 2.0}
_SOLIDS = {f"{name} {side}": value for name, value in _PLY.items() for side in ("BOTTOM", "TOP")}
TYPES = {
    "U2": _LAW | {"ALPHAN": 1.0e4, "ALPHAT": 1.0e4, "INTEGRATION": 1},
    "U4": _LAW | _SOLIDS | formulations("CPS4R") | {"CLOSURE": 3, "BETAN": -1.0, "BETAT": -1.0},
}
"""Interface elements with their properties: the standard one, the consistent one with an infinite stiffness."""


def elastica_files() -> dict[str, str]:
    """Write the decks."""
    return {f"dcb_elastica_{kind.lower()}.inp": elastica_deck(kind) for kind in TYPES}


def elastica_deck(kind: str, largest: float = 0.02) -> str:
    """Write the deck with a type of interface element; largest: increment, in step time."""
    along, through = QUADS
    # by arm (bottom, top), height and length
    labels = 1 + np.arange(2 * (through + 1) * (along + 1)).reshape(2, through + 1, along + 1)
    heights, x = np.meshgrid(np.linspace(0.0, HEIGHT, through + 1), np.linspace(0.0, LENGTH, along + 1), indexing="ij")
    y = np.stack([heights - HEIGHT, heights])
    places = np.column_stack([np.tile(x.ravel(), 2), y.ravel()])
    first = round(CRACK / LENGTH * along)
    below, above = (faces(rows)[first:] for rows in (labels[0, -2:], labels[1, :2]))
    edges = np.column_stack([below[:, [3, 2]], above[:, [1, 0]]])
    interface = np.hstack([below, above]) if kind == "U4" else edges
    arms = np.concatenate([faces(arm) for arm in labels])
    lines = [
        "*HEADING",
        f"Double cantilever beam in large rotations, CPS4R and {kind} with NLGEOM",
        "** right end clamped; the left ends of the arms are pulled apart and may come closer to the tip",
        "** written by python -m uel.paper.decks; units N, mm, MPa",
        *node_block(labels.ravel(), places),
        *element_block("CPS4R", "ARMS", arms, 1),
        *user_element(int(kind[1:])),
        *element_block(kind, "INTERFACE", interface, 1 + len(arms)),
        *node_set("CLAMPED", labels[..., -1].ravel()),
        *node_set("LOAD_TOP", labels[1, through // 2, :1]),
        *node_set("LOAD_BOTTOM", labels[0, through // 2, :1]),
        *bending_section("ARMS", "ARM", MODULUS),
        *uel_property(int(kind[1:]), "INTERFACE", TYPES[kind]),
        *static_step(
            (min(0.01, largest), 1.0, 1.0e-7, largest),
            [
                "CLAMPED, 1, 2",
                f"LOAD_TOP, 2, 2, {number(OPENING / 2.0)}",
                f"LOAD_BOTTOM, 2, 2, {number(-OPENING / 2.0)}",
            ],
            Output(history={"LOAD_TOP": "U1, U2, RF2"}),
            limit=2000,
            nlgeom=True,
        ),
    ]
    return text(lines)
