# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Beams of two plies in space, in plane strain: [0/0] and [0/90], mesh lines along the front and turned against it.

HTA/6376C of the paper, U8 of infinite stiffness between C3D8I. All have one mesh, which the decks generate. In the
turned one the lines across are at 15 degrees to the front wherever the crack grows; the initial front, the supports and
the load stay straight.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from uel.delamination.blocks import Interface
from uel.delamination.keywords import text
from uel.delamination.materials import Cohesive, SolidPly
from uel.delamination.plate_specimens import STRIP, dcb_deck, enf_deck, mmb_deck
from uel.delamination.plates import Laminate, two_plates
from uel.delamination.theory import Arms
from uel.model.arrays import FloatArray

PLY_0 = SolidPly("PLY_0", (1.2e5, 1.05e4, 1.05e4), (0.3, 0.3, 0.51), (5.52e3, 5.52e3, 3.48e3))
PLIES = {"0_0": (PLY_0, PLY_0), "0_90": (PLY_0, replace(PLY_0, name="PLY_90", angle=90.0))}
"""Lower and upper arm."""

LENGTH, WIDTH, HEIGHT, CRACK = 80.0, 3.0, 1.5, 28.0
"""Length, width, height of an arm and length of the crack (mm); 0.7 of half the span, so that it grows steadily."""

ARMS = Arms(WIDTH, HEIGHT, 1.2e5 / (1.0 - 0.3**2 * 1.05 / 12.0), 1.05e4 / (1.0 - 0.51**2), 5.52e3)
"""Arms of [0/0] for beam theory: moduli of plane strain."""

FINE, SIZE, COARSE = (26.0, 40.0), 0.5, 2.0
"""Interval of the columns of length SIZE, and the length of the others (mm)."""

ACROSS, LAYERS = 6, 2
"""Bricks across the width, and through the height of an arm."""

TURN = 15.0
"""Degrees between the turned lines and the front."""

SLOPE = (28.0, 30.0, 36.0, 39.0), (0.0, 1.0, 1.0, 0.0)
"""Positions (mm) between which the slope of the lines across changes linearly, and its parts of the full one there."""

LAW = Cohesive(0.0, 0.0, 20.0, 60.0, 0.26, 1.002)
ETA = 2.0
"""Exponent of BK."""

INTERFACE = Interface("U8", LAW, law=2, eta=ETA)

LEVER = 35.0
"""Length of the lever of mixed-mode bending (mm)."""

DISPLACEMENTS = {
    ("dcb", "0_0"): 1.4,
    ("dcb", "0_90"): 3.1,
    ("enf", "0_0"): 2.1,
    ("mmb", "0_0"): 2.6,
}
"""Displacements of an arm's end, of mid-span, of the load (mm), by specimen and plies."""

STATIC = (0.025, 1.0, 1.0e-6, 0.025)


@dataclass(frozen=True, slots=True)
class SpaceBeam:
    """A deck: its key in DISPLACEMENTS, and whether the mesh lines are turned."""

    problem: str
    plies: str
    turned: bool

    @property
    def name(self) -> str:
        """Name of the deck."""
        return f"{self.problem}_{self.plies}" + ("_turned" if self.turned else "")

    def deck(self, generated: bool = True, static: tuple[float, float, float, float] = STATIC) -> str:
        """Write the deck; with its mesh generated, or written out; static: the data of *STATIC."""
        lines = "turned mesh lines" if self.turned else "mesh lines along the front"
        title = f"{self.problem.upper()} of [{self.plies.replace('_', '/')}] in plane strain, {lines}"
        laminate = replace(laminate_of(self), generated=generated)
        moved = DISPLACEMENTS[self.problem, self.plies]
        if self.problem == "mmb":
            return text(mmb_deck(title, laminate, LENGTH, LEVER, moved, static, part=STRIP, every=1))
        build = dcb_deck if self.problem == "dcb" else enf_deck
        return text(build(title, laminate, moved, static, part=STRIP, every=1))


CASES = [SpaceBeam(problem, plies, turned) for problem, plies in DISPLACEMENTS for turned in (False, True)]


def space_beam_files() -> dict[str, str]:
    """Write the decks."""
    return {f"{case.name}.inp": case.deck() for case in CASES}


def laminate_of(case: SpaceBeam) -> Laminate:
    """Build mesh and plies of a deck."""
    begin, end = FINE
    parts = ((0.0, begin, COARSE), (begin, end, SIZE), (end, LENGTH, COARSE))
    x = np.append(np.concatenate([np.arange(start, stop, size) for start, stop, size in parts]), LENGTH)
    y, z = np.linspace(0.0, WIDTH, ACROSS + 1), np.linspace(0.0, HEIGHT, LAYERS + 1)
    mesh = two_plates(x, y, z, CRACK)
    if case.turned:
        mesh = replace(mesh, moved=_turned(mesh.positions))
    lower, upper = PLIES[case.plies]
    return Laminate(mesh, INTERFACE, (lower,) * LAYERS, (upper,) * LAYERS, generated=True)


def _turned(positions: FloatArray) -> FloatArray:
    """Return the positions of nodes (..., 3) with the lines across turned."""
    x, y, z = np.moveaxis(positions, -1, 0)
    slope = np.tan(np.radians(TURN)) * np.interp(x, *SLOPE)
    return np.stack([np.round(x + slope * (y - 0.5 * WIDTH), 9), y, z], axis=-1)
