# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Double cantilever beam in space, as a public model with known results of Abaqus: COH3D8, U7 and U8."""

from __future__ import annotations

import numpy as np

from harness.delamination.kernels import uel_property, user_element
from harness.delamination.keywords import element_block, node_block, node_set, text
from harness.model.arrays import IntArray

LENGTH, WIDTH, HEIGHT, CRACK = 60.0, 4.0, 2.0, 20.0
"""Length, width, height of an arm and length of the crack, mm."""

BRICKS = (30, 2, 2)
"""Of an arm: along, across, through its height."""

STABILISED_BRICKS, FINE_BRICKS = (120, 2, 1), (240, 2, 2)
"""Of the decks of U8, and of the one that they are compared with."""

OPENING = 2.5
"""Distance of the tip lines at the end, mm; the step time is the opening."""

_AROUND = np.array([[0, 0], [0, 1], [1, 1], [1, 0]])
"""Corners of a face counter-clockwise, across and along."""


MODULUS, POISSON = 70000.0, 0.3
STIFFNESS, STRENGTH, TOUGHNESS = 1.0e4, 30.0, 0.5

_LAW = {"LAW": 2, "ETA": 1.0, "SIGMAMAX": STRENGTH, "TAUMAX": STRENGTH, "GIC": TOUGHNESS, "GIIC": TOUGHNESS}
_ISOTROPIC = {"E": MODULUS, "NU": POISSON, "G": MODULUS / (2.0 * (1.0 + POISSON))}
_MEMBERS = {"E": ("1", "2", "3"), "NU": ("12", "13", "23"), "G": ("12", "13", "23")}
_PLIES = {
    f"{name}{member} {side}": _ISOTROPIC[name]
    for name, members in _MEMBERS.items()
    for member in members
    for side in ("BOTTOM", "TOP")
}


def bricks_files() -> dict[str, str]:
    """The decks of the public model: with built-in elements, and with U7."""
    stiff = {"ALPHAN": STIFFNESS, "ALPHAT": STIFFNESS}
    return {
        "dcb_3d.inp": _deck("C3D8", "COH3D8", {}, BRICKS),
        "dcb_3d_u7.inp": _deck("C3D8", "U7", _LAW | stiff | {"INTEGRATION": 1}, BRICKS),
    }


def stabilised_bricks_files() -> dict[str, str]:
    """The specimen with U8 between incompatible bricks, at a stiffness of 1e8 N/mm^3 and an infinite one (0)."""
    consistent = _LAW | _PLIES | {"CLOSURE": 1, "BETAN": -1.0, "BETAT": -1.0}
    return {
        "dcb_3d_u8_1e8.inp": _deck("C3D8I", "U8", consistent | {"ALPHAN": 1.0e8, "ALPHAT": 1.0e8}, STABILISED_BRICKS),
        "dcb_3d_u8_infinite.inp": _deck("C3D8I", "U8", consistent, STABILISED_BRICKS),
        "dcb_3d_u8_fine.inp": _deck("C3D8I", "U8", consistent, FINE_BRICKS),
    }


def _deck(arm: str, kind: str, values: dict[str, float], bricks: tuple[int, int, int]) -> str:
    """The deck with a type of bricks and one of interface elements; values: properties of user elements."""
    along, across, height = bricks
    # by arm (bottom, top), height, width and length
    labels = 1 + np.arange(2 * (height + 1) * (across + 1) * (along + 1)).reshape(2, height + 1, across + 1, along + 1)
    axes = [np.linspace(0.0, size, count + 1) for size, count in zip((LENGTH, WIDTH, HEIGHT), bricks, strict=True)]
    z, y, x = np.meshgrid(*reversed(axes), indexing="ij")
    places = np.array([np.stack([x, y, z + shift], axis=-1) for shift in (-HEIGHT, 0.0)])
    arms = np.concatenate([np.hstack([_faces(arm[k]), _faces(arm[k + 1])]) for arm in labels for k in range(height)])
    tip = round(CRACK / LENGTH * along)
    # the layers of nodes that the interface elements have, from below
    layers = [labels[0, -1], labels[1, 0]] if kind != "U8" else [*labels[0, -2:], *labels[1, :2]]
    interface = np.hstack([_faces(layer[:, tip:]) for layer in layers])
    lines = [
        "*HEADING",
        f"Double cantilever beam of {arm} and {kind}, bilinear law with BK",
        "** right end clamped; the left ends of the outer faces are pulled apart, the crack runs to the right",
        "** written by python -m harness.delamination.decks; units N, mm, MPa",
        *node_block(labels.ravel(), places.reshape(-1, 3)),
        *element_block(arm, "ARMS", arms, 1),
        *(user_element(int(kind[1:]), "UNSYMM") if values else []),
        *element_block(kind, "INTERFACE", interface, 1 + len(arms)),
        *node_set("CLAMPED", labels[..., -1].ravel()),
        *node_set("TOP", labels[1, -1, :, 0]),
        *node_set("BOTTOM", labels[0, 0, :, 0]),
        "*SOLID SECTION, ELSET=ARMS, MATERIAL=ARM",
        "*MATERIAL, NAME=ARM",
        "*ELASTIC",
        f"{MODULUS:g}., {POISSON:g}",
        *(uel_property(int(kind[1:]), "INTERFACE", values) if values else _cohesive_section()),
        f"*STEP, INC=1000{', UNSYMM=YES' if values else ''}",
        "*STATIC",
        f"0.01, {OPENING}, 1.e-10, 0.1",
        "*BOUNDARY",
        "CLAMPED, 1, 3",
        f"TOP, 3, 3, {OPENING / 2}",
        f"BOTTOM, 3, 3, {-OPENING / 2}",
        "*OUTPUT, FIELD, FREQUENCY=10",
        "*NODE OUTPUT",
        "U, RF",
        "*ELEMENT OUTPUT",
        "S, SDEG",
        "*OUTPUT, HISTORY",
        "*NODE OUTPUT, NSET=TOP",
        "U3, RF3",
        "*ENERGY OUTPUT",
        "ALLIE, ALLDMD, ALLWK",
        "*END STEP",
    ]
    return text(lines)


def _cohesive_section() -> list[str]:
    """Section and material of COH3D8."""
    return [
        "*COHESIVE SECTION, ELSET=INTERFACE, MATERIAL=INTERFACE, RESPONSE=TRACTION SEPARATION",
        "*MATERIAL, NAME=INTERFACE",
        "*ELASTIC, TYPE=TRACTION",
        "1.e4, 1.e4, 1.e4",
        "*DAMAGE INITIATION, CRITERION=QUADS",
        "30., 30., 30.",
        "*DAMAGE EVOLUTION, TYPE=ENERGY, MIXED MODE BEHAVIOR=BK, POWER=1.",
        "0.5, 0.5, 0.5",
    ]


def _faces(layer: IntArray) -> IntArray:
    """Corners of the faces between the nodes of a layer (across, along), counter-clockwise from above."""
    across, along = layer.shape
    corners = [layer[j : across - 1 + j, i : along - 1 + i].ravel() for j, i in _AROUND]
    return np.stack(corners, axis=-1)
