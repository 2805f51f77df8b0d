# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Specimens in 3D: double cantilever beam, end-notched flexure, mixed-mode bending, circular delamination.

The crack of the beams starts at x = 0 and grows along x; z is the normal of the interface. The decks differ only in
loads and supports; plies, mesh and interface elements are those of the laminate.

A beam is modelled as a whole, as the half on one side of its symmetry plane y = 0 (HALF), or in plane strain as a strip
with u_y = 0 (STRIP). Reactions are those of the modelled part. Field output is written every `every` increments.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from uel.delamination.flexure import lever_rows
from uel.delamination.keywords import node_set, number, table
from uel.delamination.plates import Laminate, mesh_blocks, property_blocks
from uel.delamination.steps import Output, static_step
from uel.model.arrays import IntArray

WHOLE, HALF, STRIP = "whole", "half", "strip"

Static = tuple[float, float, float, float]
"""Data line of *STATIC: initial increment, period, smallest and largest increment."""

ENERGIES = "ALLIE, ALLSE, ALLPD, ALLDMD, ALLWK"


def dcb_deck(
    title: str, laminate: Laminate, opening: float, static: Static, *, part: str = WHOLE, every: int = 10
) -> list[str]:
    """Write the double cantilever beam: end clamped, outer edges at x = 0 pulled apart by `opening` each (mm)."""
    bottom, top = laminate.mesh.labels
    sets = {
        "CLAMPED": np.concatenate([bottom[..., -1].ravel(), top[..., -1].ravel()]),
        "TOP": top[-1, :, 0],
        "BOTTOM": bottom[0, :, 0],
    }
    sets, boundary = _sides(laminate, part, sets)
    boundary = ["CLAMPED, 1, 3", *boundary]
    boundary += [f"TOP, 3, 3, {number(opening)}", f"BOTTOM, 3, 3, {number(-opening)}"]
    comment = "right end clamped; the left ends of the outer faces are pulled apart, the crack runs to the right"
    return _deck(title, comment, laminate, sets, [], boundary, {"TOP": "U3, RF3"}, static, every)


def enf_deck(
    title: str, laminate: Laminate, deflection: float, static: Static, *, part: str = WHOLE, every: int = 10
) -> list[str]:
    """Write the end-notched flexure: supports below both ends, mid-span of the upper face pushed by `deflection` (mm).

    *EQUATION couples the deflections of the crack faces above the left support, as in 2D.
    """
    bottom, top = laminate.mesh.labels
    middle = _column(laminate, 0.5 * float(laminate.mesh.x[-1]))
    sets = {"MIDSPAN": top[-1, :, middle], "LEFT": bottom[0, :, 0], "RIGHT": bottom[0, :, -1]}
    sets, boundary = _sides(laminate, part, sets, fixed=bottom[0, 0, -1])
    boundary = ["LEFT, 3, 3", "RIGHT, 1, 1", "RIGHT, 3, 3", *boundary, f"MIDSPAN, 3, 3, {number(-deflection)}"]
    equations = _equal(top[0, :, 0], bottom[-1, :, 0])
    comment = "simply supported; mid-span pushed down; the crack's faces have one deflection above the left support"
    return _deck(title, comment, laminate, sets, equations, boundary, {"MIDSPAN": "U3, RF3"}, static, every)


def mmb_deck(
    title: str,
    laminate: Laminate,
    span: float,
    lever: float,
    displacement: float,
    static: Static,
    *,
    part: str = WHOLE,
    every: int = 10,
) -> list[str]:
    """Write the mixed-mode bending: a rigid lever on a roller at mid-span pulls the upper arm's end up.

    Parameters
    ----------
    title, laminate, static, part, every
        As in `dcb_deck`.
    span
        Distance 2 L of the supports below x = 0 and x = 2 L (mm).
    lever
        Distance c of the load from mid-span, on the side of the bonded end (mm).
    displacement
        Displacement of the load, downwards (mm).

    The rotations of the lever are small: with deflections w at the upper arm's end, at mid-span (M) and at the load
    (P), w_M = (L w_P + c w_end)/(L + c). Its node is LEVER, and the reaction there is the load.
    """
    mesh = laminate.mesh
    bottom, top = mesh.labels
    half = 0.5 * span
    middle, right = _column(laminate, half), _column(laminate, span)
    node = int(top.max()) + 1
    # the end of the arm is pulled at its middle, where it has the deflection of a beam
    end = top[np.argmin(np.abs(mesh.upper - np.mean(mesh.upper[[0, -1]]))), :, 0]
    sets = {"LEVER": np.array([node]), "END": end, "LEFT": bottom[0, :, 0], "RIGHT": bottom[0, :, right]}
    sets, boundary = _sides(laminate, part, sets, fixed=bottom[0, 0, right])
    boundary = ["LEFT, 3, 3", "RIGHT, 1, 1", "RIGHT, 3, 3", *boundary, f"LEVER, 3, 3, {number(-displacement)}"]
    equations = _equal(end[1:], np.full(len(end) - 1, end[0]))
    for roller in top[-1, :, middle].tolist():
        equations += lever_rows((roller, node, int(end[0])), 3, half / (half + lever))
    position = [half + lever, float(np.mean(mesh.y)), float(mesh.upper[-1])]
    comment = "a rigid lever pushes mid-span down and pulls the upper arm's left end up"
    extra = ["*NODE", *table([[node, *position]])]
    return _deck(title, comment, laminate, sets, [*extra, *equations], boundary, {"LEVER": "U3, RF3"}, static, every)


def circular_deck(title: str, laminate: Laminate, opening: float, static: Static, *, every: int = 10) -> list[str]:
    """Write a quarter of two plates, whose middle at x = y = 0 is pulled apart by `opening` each (mm)."""
    bottom, top = laminate.mesh.labels
    sets = {
        "PLANE_X": np.concatenate([labels[:, :, 0].ravel() for labels in (bottom, top)]),
        "PLANE_Y": np.concatenate([labels[:, 0, :].ravel() for labels in (bottom, top)]),
        "TOP": top[:, 0, 0],
        "BOTTOM": bottom[:, 0, 0],
    }
    boundary = ["PLANE_X, 1, 1", "PLANE_Y, 2, 2"]
    boundary += [f"TOP, 3, 3, {number(opening)}", f"BOTTOM, 3, 3, {number(-opening)}"]
    comment = "planes of symmetry x = 0 and y = 0; the lines of nodes at x = y = 0 are pulled apart"
    return _deck(title, comment, laminate, sets, [], boundary, {"TOP": "U3, RF3"}, static, every)


def _column(laminate: Laminate, x: float) -> int:
    """Return the column of nodes at x (mm)."""
    return int(np.argmin(np.abs(laminate.mesh.x - x)))


def _equal(nodes: IntArray, others: IntArray) -> list[str]:
    """Write *EQUATION: equal deflections of nodes and others; the keyword is written even without equations."""
    pairs = zip(nodes.tolist(), others.tolist(), strict=True)
    rows = [line for node, other in pairs for line in ("2", *table([(node, 3, 1.0, other, 3, -1.0)]))]
    return ["*EQUATION", *rows]


def _sides(
    laminate: Laminate, part: str, sets: dict[str, IntArray], fixed: int | None = None
) -> tuple[dict[str, IntArray], list[str]]:
    """Return node sets and boundary conditions with u_y = 0; fixed: the node fixed in an unclamped whole beam."""
    both = laminate.mesh.labels
    if part == HALF:
        return sets | {"SYMMETRY": np.concatenate([labels[:, 0].ravel() for labels in both])}, ["SYMMETRY, 2, 2"]
    if part == STRIP:
        return sets | {"PLANE": np.concatenate([labels.ravel() for labels in both])}, ["PLANE, 2, 2"]
    if fixed is None:
        return sets, []
    return sets | {"HELD": np.array([fixed])}, ["HELD, 2, 2"]


def _deck(
    title: str,
    comment: str,
    laminate: Laminate,
    sets: dict[str, IntArray],
    constraints: Sequence[str],
    boundary: Sequence[str],
    history: dict[str, str],
    static: Static,
    every: int,
) -> list[str]:
    lines = ["*HEADING", title, f"** {comment}"]
    lines += ["** written by python -m uel.paper.decks; units N, mm, MPa", *mesh_blocks(laminate)]
    for name, labels in sets.items():
        lines += node_set(name, labels, generate=laminate.generated)
    lines += [*constraints, *property_blocks(laminate)]
    output = Output(f"FREQUENCY={every}", history=history, energies=ENERGIES)
    return lines + static_step(static, boundary, output, unsymmetric=not laminate.interface.built_in)
