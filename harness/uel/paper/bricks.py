# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Double cantilever beam in space, as a public model with known results of Abaqus: COH3D8, U7 and U8."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uel.delamination.blocks import Interface
from uel.delamination.keywords import text
from uel.delamination.materials import Cohesive, isotropic
from uel.delamination.plate_specimens import dcb_deck
from uel.delamination.plates import Laminate, two_plates

LENGTH, WIDTH, HEIGHT, CRACK = 60.0, 4.0, 2.0, 20.0
"""Length, width, height of an arm and length of the crack, mm."""

BRICKS = (30, 2, 2)
"""Bricks of an arm: along, across, through its height."""

STABILISED_BRICKS, FINE_BRICKS = (120, 2, 1), (240, 2, 2)
"""Bricks of the decks of U8, and of the one that they are compared with."""

OPENING = 2.5
"""Distance of the tip lines at the end, mm; the step time is the opening."""

ARM = isotropic("ARM", 70000.0, 0.3)
LAW = Cohesive(1.0e4, 1.0e4, 30.0, 30.0, 0.5, 0.5)
STANDARD = Interface("U7", LAW, law=2, eta=1.0, newton_cotes=True)
CONSISTENT = Interface("U8", LAW, law=2, eta=1.0)


def bricks_files() -> dict[str, str]:
    """Write the decks of the public model: with built-in elements, and with U7."""
    return {
        "dcb_3d.inp": dcb_of_bricks("C3D8", replace(STANDARD, type="COH3D8"), BRICKS),
        "dcb_3d_u7.inp": dcb_of_bricks("C3D8", STANDARD, BRICKS),
    }


def stabilised_bricks_files() -> dict[str, str]:
    """Write the decks with U8 between incompatible bricks, at a stiffness of 1e8 N/mm^3 and an infinite one (0)."""
    stiff, infinite = (replace(CONSISTENT, cohesive=LAW.with_stiffness(stiffness)) for stiffness in (1.0e8, 0.0))
    return {
        "dcb_3d_u8_1e8.inp": dcb_of_bricks("C3D8I", stiff, STABILISED_BRICKS),
        "dcb_3d_u8_infinite.inp": dcb_of_bricks("C3D8I", infinite, STABILISED_BRICKS),
        "dcb_3d_u8_fine.inp": dcb_of_bricks("C3D8I", infinite, FINE_BRICKS),
    }


def dcb_of_bricks(bricks: str, interface: Interface, count: tuple[int, int, int]) -> str:
    """Write the deck with a type of bricks, an interface and a number of bricks."""
    x, y, z = (np.linspace(0.0, size, parts + 1) for size, parts in zip((LENGTH, WIDTH, HEIGHT), count, strict=True))
    mesh, plies = two_plates(x, y, z, CRACK), (ARM,) * count[2]
    title = f"Double cantilever beam of {bricks} and {interface.type}, bilinear law with BK"
    # the step time is the opening
    static = (0.01, OPENING, 1.0e-10, 0.1)
    return text(dcb_deck(title, Laminate(mesh, interface, plies, plies, bricks), OPENING / 2.0, static))
