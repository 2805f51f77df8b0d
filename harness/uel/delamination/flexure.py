# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""End-notched flexure (mode II) and fixed-ratio mixed-mode specimens, sections 4.3 and 4.4 (N, mm, MPa).

The crack faces of an end-notched flexure specimen are in contact above the left support. There are no elements between
them; *EQUATION couples their deflections above the support, where beam theory transmits the load. Both arms then have
the same end deflection under one load each and so, as beams, equal deflections along the whole crack.
"""

from __future__ import annotations

import numpy as np

from uel.delamination.blocks import Specimen
from uel.delamination.keywords import node_set, table, text
from uel.delamination.mesh import TwoArmMesh, crack_columns, two_arms
from uel.delamination.specimens import ARM_HEIGHT, CRACK, deck_head
from uel.delamination.steps import Increments, step_block

SPAN = 100.0
FRMM_LENGTH = 50.0


def enf_mesh(size: float = 0.25, bump: float = 0.0) -> TwoArmMesh:
    """Mesh with columns of `size` (mm) over the whole span and four quads over the height of an arm."""
    x = np.round(np.linspace(0.0, SPAN, round(SPAN / size) + 1), 6)
    return two_arms(x, ARM_HEIGHT, 4, CRACK, bump)


def frmm_mesh(size: float = 0.125, bump: float = 0.0, crack: float = CRACK) -> TwoArmMesh:
    """Mesh with columns of `size` (mm) from the crack tip to 0.5 mm before the clamp.

    The length scales with `crack` (mm) from that of the paper.
    """
    start, length = crack - 1.5, FRMM_LENGTH * crack / CRACK
    x = crack_columns(length, (start, length), size, ratio=1.15, largest=(0.5, 0.5))
    return two_arms(x, ARM_HEIGHT, 4, crack, bump)


def enf_deck(title: str, specimen: Specimen, deflection: float, increments: Increments, field_every: int) -> str:
    """Write the end-notched flexure: supported at both ends, mid-span of the upper face pushed by `deflection` (mm)."""
    lines = flexure_head(title, "mid-span pushed down", specimen)
    lines += step_block(
        f"Deflection of {deflection:g} mm at mid-span",
        increments,
        [("MIDSPAN", 2, -deflection)],
        ["MIDSPAN"],
        field_every=field_every,
        built_in=specimen.interface.built_in,
    )
    return text(lines)


def flexure_head(title: str, load: str, specimen: Specimen) -> list[str]:
    """Write the end-notched flexure with its supports, before the steps; load: in a few words, for a comment."""
    comment = f"simply supported; {load}; the crack's faces have one deflection above the left support"
    mesh = specimen.mesh
    middle = int(np.argmin(np.abs(mesh.x - 0.5 * SPAN)))
    low, high = (int(line[0]) for line in mesh.interface_lines)
    return [
        *deck_head(title, [comment], specimen),
        *node_set("MIDSPAN", mesh.top_line[middle : middle + 1]),
        *node_set("SUPPORT_LEFT", mesh.line(1)[:1]),
        *node_set("SUPPORT_RIGHT", mesh.line(1)[-1:]),
        *["*EQUATION", "2", *table([(high, 2, 1.0, low, 2, -1.0)])],
        *["*BOUNDARY", "SUPPORT_LEFT, 2, 2", "SUPPORT_RIGHT, 1, 2"],
    ]


def frmm_deck(title: str, specimen: Specimen, opening: float, increments: Increments, field_every: int) -> str:
    """Write the fixed-ratio mixed mode: right end clamped, the upper arm's left corner pulled up by `opening` (mm)."""
    lines = deck_head(title, ["right end clamped; upper left corner pulled up, the lower arm is free"], specimen)
    lines += ["*BOUNDARY", "RIGHT, 1, 2"]
    lines += step_block(
        f"Opening to {opening:g} mm",
        increments,
        [("LOAD_TOP", 2, opening)],
        ["LOAD_TOP"],
        field_every=field_every,
        built_in=specimen.interface.built_in,
    )
    return text(lines)


def lever(node: int, loads: tuple[float, float], roller: int, end: int, half: float) -> list[str]:
    """Write the rigid lever of mixed-mode bending, with small rotations: its node and its equation.

    Parameters
    ----------
    node
        Label of its end, which carries the load.
    loads
        Distance of the load from mid-span, and its height (mm).
    roller, end
        Nodes of the upper arm at mid-span, on which the lever rolls, and at its end, which the lever holds.
    half
        Half of the span (mm).
    """
    length, height = loads
    lines = ["*NODE", *table([[node, half + length, height]])]
    return [*lines, "*EQUATION", *lever_rows((roller, node, end), 2, half / (half + length))]


def lever_rows(nodes: tuple[int, int, int], dof: int, ratio: float) -> list[str]:
    """Write the data lines of *EQUATION of a lever: roller, loaded and held end; ratio: arm of the roller over all."""
    roller, loaded, held = nodes
    return ["3", *table([(roller, dof, 1.0, loaded, dof, -ratio, held, dof, ratio - 1.0)])]
