# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A double cantilever beam whose resistance rises with the growth of its crack: fibre bridging, LAW 5."""

from __future__ import annotations

from dataclasses import replace

from uel.delamination.blocks import Interface
from uel.delamination.materials import TABLE_2
from uel.delamination.specimens import dcb_deck, mesh_files
from uel.delamination.steps import Increments
from uel.paper.cycled_specimens import beam_mesh, specimen

TIP, TOTAL = 0.26, 0.56
"""Resistance at the start and at the plateau (N/mm)."""
BRIDGING = {"SIGMABRIDGE": 1.5, "GIBRIDGE": TOTAL - TIP}
OPENING = 9.0
"""Displacement of each arm at the end (mm)."""


def bridging_files() -> dict[str, str]:
    """Write the deck."""
    law = replace(TABLE_2, stiffness_normal=0.0, stiffness_shear=0.0, toughness_1=TOTAL, toughness_2=TOTAL * 4.0)
    interface = Interface("U4", law, law=5, further=BRIDGING)
    beams = specimen("dcb", beam_mesh(35.0), interface)
    increments = Increments(initial=0.005, smallest=1e-6, largest=0.005, limit=1000)
    title = "Double cantilever beam with fibre bridging, 0.26 N/mm at the tip and 0.56 N/mm in all"
    return mesh_files("dcb", beams.mesh, (8,)) | {"dcb.inp": dcb_deck(title, beams, OPENING, increments, field_every=4)}
