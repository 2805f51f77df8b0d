# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The specimens: patch test with a horizontal interface, and double cantilever beams (N, mm, MPa)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uel.delamination.blocks import Interface, Specimen, element_blocks
from uel.delamination.keywords import integer_table, keyword, node_block, node_set, text
from uel.delamination.materials import PLY_0, TABLE_2
from uel.delamination.mesh import TwoArmMesh, crack_columns, two_arms
from uel.delamination.steps import Increments, step_block
from uel.delamination.theory import Arms

ARM_HEIGHT = 1.55
LENGTH = 150.0
CRACK = 35.0
WIDTH = 20.0
ARMS = Arms(WIDTH, ARM_HEIGHT, PLY_0.e1, PLY_0.e2, PLY_0.g12)

# section 4.1: stiff in compression, soft in sliding. With alpha_tau = 10 N/mm^3 the strength of table 2 is reached at a
# sliding of 6 mm, beyond the end of softening for G_IIc of table 2: there is no such law. The patch is compressed and
# never slides that far, so a larger G_IIc has no effect on the results.
PATCH_LAW = replace(TABLE_2, stiffness_normal=1.0e8, stiffness_shear=10.0, toughness_2=1000.0)
PATCH_BETA = 3.0e6
PATCH_BUMP = -0.003


def patch_mesh(bump: float) -> TwoArmMesh:
    """Mesh with 10 x 10 quads on a square of 1 mm, interface at mid-height."""
    return two_arms(np.linspace(0.0, 1.0, 11), 0.5, 5, crack=0.0, bump=bump)


def dcb_mesh(size: float = 0.125, bump: float = 0.0) -> TwoArmMesh:
    """Mesh with quads of `size` (mm) along the crack path (up to 3 mm of opening), 0.5 mm before, 1 mm behind."""
    x = crack_columns(LENGTH, (33.5, 61.0), size, ratio=1.15, largest=(0.5, 1.0))
    return two_arms(x, ARM_HEIGHT, 4, CRACK, bump)


def dcb_ref_mesh() -> TwoArmMesh:
    """Mesh with 600 x 8 quads of 0.25 x 0.3875 mm."""
    return two_arms(np.linspace(0.0, LENGTH, 601), ARM_HEIGHT, 4, CRACK)


def mesh_files(name: str, mesh: TwoArmMesh, interfaces: tuple[int, ...]) -> dict[str, str]:
    """Write the include files of a specimen: nodes and sets; quads; interface elements by number of nodes."""
    nodes = [*node_block(*mesh.nodes()), *node_set("RIGHT", mesh.edge(-1))]
    nodes += node_set("LOAD_TOP", mesh.top_line[:1]) + node_set("LOAD_BOTTOM", mesh.line(1)[:1])
    quads = np.concatenate([mesh.quads("lower"), mesh.quads("upper")])
    files = {f"{name}_nodes.inp": text(nodes), f"{name}_quads.inp": integer_table(quads)}
    connectivity = {4: mesh.interface4, 8: mesh.interface8}
    return files | {f"{name}_interface{n}.inp": integer_table(connectivity[n]()) for n in interfaces}


def deck_head(title: str, comments: list[str], specimen: Specimen) -> list[str]:
    """Write the heading with comments, nodes, elements and the set TIP of the first interface element."""
    lines = ["*HEADING", title, *(f"** {comment}" for comment in comments)]
    lines.append("** written by python -m uel.paper.decks; units N, mm, MPa")
    lines += ["** nodes", keyword("INCLUDE", INPUT=f"{specimen.name}_nodes.inp")]
    lines += element_blocks(specimen)
    first = int(specimen.mesh.interface_labels[0])
    return [*lines, "*ELSET, ELSET=TIP", str(first)]


def dcb_deck(title: str, specimen: Specimen, opening: float, increments: Increments, field_every: int) -> str:
    """Write the double cantilever beam: right end clamped, left corners pulled apart by `opening` each (mm)."""
    lines = deck_head(
        title, ["right end clamped; outer left corners pulled apart, the crack runs to the right"], specimen
    )
    lines += ["*BOUNDARY", "RIGHT, 1, 2"]
    prescribed = [("LOAD_TOP", 2, opening), ("LOAD_BOTTOM", 2, -opening)]
    lines += step_block(
        f"Opening to {opening:g} mm each arm",
        increments,
        prescribed,
        ["LOAD_TOP", "LOAD_BOTTOM"],
        field_every=field_every,
        built_in=specimen.interface.built_in,
    )
    return text(lines)


def patch_deck(title: str, specimen: Specimen, displacement: float, increments: Increments, *, slide: bool) -> str:
    """Write the square compressed from above by `displacement` (mm); with `slide`, its bottom is free laterally."""
    note = "bottom edge free to slide but for its left end" if slide else "bottom edge held in both directions"
    lines = deck_head(title, [f"square of 1 mm pressed from above; {note}"], specimen)
    mesh = specimen.mesh
    lines += node_set("BASE", mesh.line(1)) + node_set("CROWN", mesh.top_line) + node_set("CORNER", mesh.line(1)[:1])
    lines += ["*BOUNDARY", "BASE, 2, 2", "CORNER, 1, 1"] if slide else ["*BOUNDARY", "BASE, 1, 2"]
    lines += step_block(
        f"Compression by {-displacement:g} mm",
        increments,
        [("CROWN", 2, displacement)],
        ["LOAD_TOP"],
        field_every=1,
        built_in=specimen.interface.built_in,
    )
    return text(lines)


def patch_specimen(name: str, mesh: TwoArmMesh, kind: str, beta: float) -> Specimen:
    """Describe the patch of [0/0] with the standard element (U2) or the paper's (U3, U4)."""
    return Specimen(name, mesh, Interface(kind, PATCH_LAW, beta=beta, consistent=False), 1.0, PLY_0, PLY_0)


def dcb_specimen(name: str, mesh: TwoArmMesh, interface: Interface, quads: str = "U1") -> Specimen:
    """Describe the double cantilever beam of [0/0]."""
    return Specimen(name, mesh, interface, WIDTH, PLY_0, PLY_0, quads)
