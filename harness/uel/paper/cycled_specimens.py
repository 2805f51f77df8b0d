# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks of delaminations under cycles: double cantilever beams, end-notched flexure, circular delamination."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from uel.delamination.blocks import Interface, Specimen
from uel.delamination.cycled import (
    Cycles,
    bending_deck,
    end_moments,
    flexure_deck,
    moments_deck,
    opening_deck,
    solid_deck,
)
from uel.delamination.flexure import SPAN
from uel.delamination.materials import PLY_0, TABLE_2
from uel.delamination.mesh import TwoArmMesh, crack_columns, two_arms
from uel.delamination.specimens import ARM_HEIGHT, CRACK, WIDTH, mesh_files
from uel.fit.endurance import BRITTLENESS, ENDURANCE, endurance_limit
from uel.model.arrays import FloatArray
from uel.paper.bridged_beam import bridged_beam
from uel.paper.literature import CIRCLE_LAW, circle_load, circular_plates, consistent

ETA = 2.73
"""Exponent of Benzeggagh and Kenane of the measured toughnesses."""
RATIO = 0.1
"""R."""
FATIGUE: Mapping[str, float] = {"FATIGUE": 2.0, "LOADRATIO": RATIO}
RIGID = replace(TABLE_2, stiffness_normal=0.0, stiffness_shear=0.0)
LENGTH, REFINED, SIZE = 100.0, 15.0, 0.25
"""Length of the double cantilever beams; length of the fine mesh from the tip on, and that of its elements (mm)."""
LEVEL = 0.6
"""G/G_c of the specimens under moments."""
OPENING = 1.2
"""Displacement of each arm of the beam that is held apart (mm): 0.85 of G_c at first."""
FORCE = 300.0
"""On the end-notched flexure (N)."""
LEVER = 0.8744 * 0.5 * SPAN
"""Length of the lever of mixed-mode bending (mm), for half of G in each mode by beam theory."""
BENDING_LEVEL = 0.4
"""G/G_c of mixed-mode bending at first."""
CIRCLE_SIZE, CIRCLE_FINE, CIRCLE_JUMP = 1.0, 26.0, 0.05
"""Squares of the circular delamination (mm), up to where, and its DAMAGEJUMP."""


def beam_mesh(refined: float = REFINED, size: float = SIZE, rows: int = 4) -> TwoArmMesh:
    """Mesh double cantilever beams with elements of `size` (mm) over the path of the crack."""
    x = crack_columns(LENGTH, (CRACK - 1.5, CRACK + refined), size, ratio=1.15, largest=(0.5, 1.0))
    return two_arms(x, ARM_HEIGHT, rows, CRACK)


def specimen(name: str, mesh: TwoArmMesh, interface: Interface, quads: str = "CPS4") -> Specimen:
    """Describe a specimen of the paper's composite, fibres along the crack."""
    return Specimen(name, mesh, interface, WIDTH, PLY_0, PLY_0, quads)


def toughness(shear: float) -> float:
    """Return G_c (N/mm) at a share of mode II."""
    return float(TABLE_2.toughness_1 + (TABLE_2.toughness_2 - TABLE_2.toughness_1) * shear**ETA)


def exponent(shear: float, endurance: float = ENDURANCE, brittleness: float = BRITTLENESS) -> float:
    """Return the exponent b of CF20 at RATIO."""
    return float(endurance_limit(RATIO, shear, endurance, brittleness)[1])


def fatigue_files() -> dict[str, str]:
    """Write the decks."""
    interface = Interface("U4", RIGID, law=2, eta=ETA, further=FATIGUE)
    beams, flexure = specimen("dcb", beam_mesh(), interface), specimen("enf", flexure_mesh(), interface)
    files = mesh_files("dcb", beams.mesh, (8,)) | mesh_files("enf", flexure.mesh, (8,))
    for name, shear, count in (("opened", 0.0, 12000.0), ("mixed", 0.5, 4000.0), ("slid", 1.0, 750.0)):
        moments = end_moments(beams, LEVEL * toughness(shear), shear)
        title = f"Arms bent by end moments under cycles, {LEVEL:g} of G_c, {shear:.0%} mode II"
        files[f"moments_{name}.inp"] = moments_deck(title, beams, moments, Cycles(count))
    title = "Double cantilever beam held apart under cycles"
    files["dcb.inp"] = opening_deck(title, beams, OPENING, Cycles(1e6))
    files["enf.inp"] = flexure_deck("End-notched flexure under cycles of a force", flexure, FORCE, Cycles(2400.0))
    title = "Mixed-mode bending under cycles of a force"
    files["mmb.inp"] = bending_deck(title, flexure, LEVER, bending_force(flexure), Cycles(5500.0))
    files |= {"circle.inp": circle(), "bridged.inp": bridged_beam()}
    return files


def circle() -> str:
    """Write a quarter of two plates with a circular delamination, whose middle a force pulls apart: LEVEL of G_c.

    G is that of thin plates, P^2/(16 pi^2 D), whatever the radius is.
    """
    interface = replace(consistent(CIRCLE_LAW), further={**FATIGUE, "DAMAGEJUMP": CIRCLE_JUMP})
    plates = circular_plates(CIRCLE_SIZE, CIRCLE_FINE, interface)
    both = plates.mesh.labels
    bottom, top = (labels[:, 0, 0] for labels in both)
    # without a reaction, since the forces are in balance
    sets = {"TOP": top, "BOTTOM": bottom, "HELD": both[0][-1, -1, -1:]}
    sets |= {"PLANE_X": np.concatenate([labels[:, :, 0].ravel() for labels in both])}
    sets |= {"PLANE_Y": np.concatenate([labels[:, 0, :].ravel() for labels in both])}
    # a quarter of the force, on the nodes through the height of each plate
    force = 0.25 * circle_load() * np.sqrt(LEVEL) / len(top)
    forces = [(node, 3, sign * force) for nodes, sign in ((top, 1.0), (bottom, -1.0)) for node in nodes.tolist()]
    title = f"Circular delamination under cycles of a central force, {LEVEL:g} of G_c"
    comment = "planes of symmetry x = 0 and y = 0; forces at the lines of nodes at x = y = 0"
    return solid_deck(
        title, comment, plates, sets, ["PLANE_X, 1, 1", "PLANE_Y, 2, 2", "HELD, 3, 3"], forces, Cycles(2400.0)
    )


def bending_force(specimen: Specimen) -> float:
    """Return the force (N) on the lever for BENDING_LEVEL at the initial crack, by beam theory.

    G_I = 3 (P a (3 c - L))^2/(4 b^2 h^3 L^2 E), G_II = 9 (P a (c + L))^2/(16 b^2 h^3 L^2 E), L half of the span (J.R.
    Reeder and J.H. Crews, AIAA Journal 28 (1990) 1270).
    """
    half = 0.5 * SPAN
    arm = specimen.top.e1 * specimen.width**2 * ARM_HEIGHT**3 * half**2
    parts = 0.75 * (3.0 * LEVER - half) ** 2, 0.5625 * (LEVER + half) ** 2
    wanted = BENDING_LEVEL * toughness(parts[1] / sum(parts))
    return float(np.sqrt(wanted * arm / sum(parts)) / CRACK)


def flexure_mesh() -> TwoArmMesh:
    """Mesh the end-notched flexure, fine from the crack to mid-span."""
    x: FloatArray = np.round(np.linspace(0.0, SPAN, round(SPAN / SIZE) + 1), 6)
    return two_arms(x, ARM_HEIGHT, 4, CRACK)
