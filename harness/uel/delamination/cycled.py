# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Delamination specimens under cycles of a load (N, mm, MPa); time is the number of cycles in their second step.

Two arms bent by end moments release an energy that does not depend on the length of the crack, in any mode mix
(B.F. Sorensen et al., Engineering Fracture Mechanics 73 (2006) 2642): with moments M_I of opposite sense and M_II of
the same sense in both arms, of width b and height h,

    G_I = 12 M_I^2/(b^2 E h^3),    G_II = 9 M_II^2/(b^2 E h^3).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from uel.delamination.blocks import Specimen
from uel.delamination.flexure import SPAN, flexure_head, lever
from uel.delamination.keywords import keyword, node_set, number, table, text
from uel.delamination.plates import Laminate, mesh_blocks, property_blocks
from uel.delamination.specimens import deck_head
from uel.delamination.steps import Output
from uel.model.arrays import IntArray

RISE = 10
"""Increments of the static step, in which the load rises to the greatest of a cycle."""


@dataclass(frozen=True, slots=True)
class Cycles:
    """Step of cycles, under the load at the end of the step before.

    count        cycles, the period of the step
    limit        increments allowed
    field_every  FREQUENCY of the field output
    """

    count: float
    limit: int = 10000
    field_every: int = 5


def end_moments(specimen: Specimen, release: float, shear: float) -> tuple[float, float]:
    """Return the moments (N mm) of the lower and the upper arm, counter-clockwise, at their left ends.

    Parameters
    ----------
    specimen
        Its arms have one height and one ply.
    release
        Energy release rate (N/mm).
    shear
        Share of mode II in it.
    """
    scale = specimen.width * math.sqrt(specimen.top.e1 * _height(specimen) ** 3)
    opening = scale * math.sqrt((1.0 - shear) * release / 12.0)
    sliding = scale * math.sqrt(shear * release / 9.0)
    return opening - sliding, -opening - sliding


def moments_deck(title: str, specimen: Specimen, moments: Sequence[float], cycles: Cycles) -> str:
    """Write two arms bent by end moments (lower, upper) as pairs of forces, and clamped at the right end."""
    mesh = specimen.mesh
    lines = deck_head(title, ["right end clamped; arms bent by pairs of forces at the left end"], specimen)
    below, _ = mesh.rows
    left = mesh.edge(0)
    loads = []
    for low, high, moment in zip((0, below + 1), (below, -1), moments, strict=True):
        force = moment / _height(specimen)
        loads += [(int(left[low]), 1, force), (int(left[high]), 1, -force)]
    lines += ["*BOUNDARY", "RIGHT, 1, 2"]
    forces = ["*CLOAD", *(f"{node}, {dof}, {number(force)}" for node, dof, force in loads)]
    return text([*lines, *_steps(forces, ["LOAD_TOP", "LOAD_BOTTOM"], cycles)])


def opening_deck(title: str, specimen: Specimen, opening: float, cycles: Cycles) -> str:
    """Write the double cantilever beam: outer left corners held apart by `opening` (mm) each, right end clamped."""
    lines = deck_head(title, ["right end clamped; outer left corners held apart"], specimen)
    lines += ["*BOUNDARY", "RIGHT, 1, 2"]
    held = ["*BOUNDARY", f"LOAD_TOP, 2, 2, {number(opening)}", f"LOAD_BOTTOM, 2, 2, {number(-opening)}"]
    return text([*lines, *_steps(held, ["LOAD_TOP", "LOAD_BOTTOM"], cycles)])


def flexure_deck(title: str, specimen: Specimen, force: float, cycles: Cycles) -> str:
    """Write the end-notched flexure under a force (N) at mid-span."""
    lines = flexure_head(title, "loaded at mid-span", specimen)
    return text([*lines, *_steps(["*CLOAD", f"MIDSPAN, 2, {number(-force)}"], ["MIDSPAN"], cycles)])


def bending_deck(title: str, specimen: Specimen, length: float, force: float, cycles: Cycles) -> str:
    """Write mixed-mode bending: a lever of a length (mm) from mid-span loads the flexure specimen by a force (N)."""
    mesh = specimen.mesh
    middle = int(np.argmin(np.abs(mesh.x - 0.5 * SPAN)))
    below, above = mesh.rows
    node = int(mesh.top_line[-1]) + 1
    end = int(mesh.edge(0)[below + 1 + above // 2])
    lines = deck_head(
        title, ["simply supported; a rigid lever pulls the upper arm up and presses on mid-span"], specimen
    )
    lines += lever(node, (length, float(mesh.upper[-1])), int(mesh.top_line[middle]), end, 0.5 * SPAN)
    lines += [*node_set("LEVER", np.array([node])), *node_set("SUPPORT_LEFT", mesh.line(1)[:1])]
    lines += [*node_set("SUPPORT_RIGHT", mesh.line(1)[-1:]), "*BOUNDARY", "SUPPORT_LEFT, 2, 2", "SUPPORT_RIGHT, 1, 2"]
    return text([*lines, *_steps(["*CLOAD", f"LEVER, 2, {number(-force)}"], ["LEVER"], cycles)])


def solid_deck(
    title: str,
    comment: str,
    laminate: Laminate,
    sets: Mapping[str, IntArray],
    boundary: Sequence[str],
    forces: Sequence[tuple[int, int, float]],
    cycles: Cycles,
) -> str:
    """Write bricks under forces at nodes.

    Parameters
    ----------
    title, comment, laminate
        Heading, a line about it, mesh with its properties.
    sets
        Node sets by name; history output is that of the first one.
    boundary
        Data lines of *BOUNDARY.
    forces
        Node, dof, force (N).
    cycles
        Step of the cycles.
    """
    lines = ["*HEADING", title, f"** {comment}"]
    lines += ["** written by python -m uel.paper.decks; units N, mm, MPa", *mesh_blocks(laminate)]
    for name, labels in sets.items():
        lines += node_set(name, labels)
    lines += [*property_blocks(laminate), "*BOUNDARY", *boundary]
    return text([*lines, *_steps(["*CLOAD", *table(forces)], [next(iter(sets))], cycles, "U3, RF3")])


def _height(specimen: Specimen) -> float:
    return float(specimen.mesh.lower[-1] - specimen.mesh.lower[0])


def _steps(load: Sequence[str], history: Sequence[str], cycles: Cycles, variables: str = "U2, RF2") -> list[str]:
    """Write the step in which the load rises, and that of its cycles, which keeps it."""
    rise = ("The greatest load of a cycle", RISE, (1.0 / RISE, 1.0, 1e-6, 1.0 / RISE), RISE, load)
    count = cycles.count
    held = ("Its cycles", cycles.limit, (1.0, count, 1e-6, count), cycles.field_every, ())
    lines = []
    for title, limit, static, every, loads in (rise, held):
        output = Output(
            when=f"FREQUENCY={every}",
            stresses=False,
            history=dict.fromkeys(history, variables),
            energies="ALLSE, ALLPD, ALLWK",
        )
        lines += [keyword("STEP", INC=limit, UNSYMM="YES"), title, "*STATIC", *table([static])]
        lines += [*loads, *output.lines(), "*END STEP"]
    return lines
