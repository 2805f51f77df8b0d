# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Patch test: displacements that are linear in space leave no force at an interior node of the mesh."""

from __future__ import annotations

from typing import Final

import numpy as np

from harness.check.finding import Finding, failed, not_applicable, passed
from harness.check.rigid_motions import INERTIA, NO_BODY, Body, body_of, makes_inertia
from harness.check.state import ElementState
from harness.check.subject import Subject
from harness.check.ties import exceeds
from harness.model.arrays import FloatArray

TOLERANCE: Final = 1e-8
"""Of the forces that the single elements exert there."""


def check(subject: Subject) -> Finding:
    """At nodes of the deck, from rest, with every displacement gradient as large as the strains of the run."""
    if not subject.patches:
        return not_applicable(
            "no node is surrounded by elements of the type: take a deck with, for example, a patch of four quads"
        )
    if any(state.call.predefined is not None for patch in subject.patches for state in patch.states):
        return not_applicable("predefined fields, which cause forces of their own: take a deck without them")
    figure, message = 0.0, ""
    for patch in subject.patches:
        bodies = [body_of(subject, state) for state in patch.states]
        if any(body is None or body.coincident for body in bodies):
            return not_applicable(NO_BODY)
        if any(makes_inertia(state, body) for state, body in zip(patch.states, bodies, strict=True) if body):
            return not_applicable(INERTIA)
        members = [(state, body) for state, body in zip(patch.states, bodies, strict=True) if body is not None]
        first = members[0][1]
        strain = float(subject.scales[first.displacement].max()) / first.size
        for i, j in np.ndindex(first.dimensions, first.dimensions):
            forces = [_forces(*member, patch.node, (i, j), strain) for member in members]
            size = float(np.abs(forces).max()) or 1.0
            ratio = float(np.abs(np.sum(forces, axis=0)).max()) / size
            if exceeds(ratio, figure):
                figure = ratio
                name = subject.recording.model.mesh.name(patch.node)
                message = (
                    f"node {name}, {patch.states[0].origin}: the forces of its {len(forces)} elements do not balance "
                    f"for u{i + 1} = x{j + 1} times a constant: {100 * ratio:.3g} % is left"
                )
    if figure <= TOLERANCE:
        return passed(f"forces balance at {len(subject.patches)} nodes, to {figure:.1e}", figure, TOLERANCE)
    advice = (
        "An element that does not pass does not converge to the solution. Check the Jacobian (the elements are "
        "distorted), the weights and positions of the integration points and, with incompatible modes, their "
        "correction."
    )
    return failed(message, advice, figure=figure, limit=TOLERANCE)


def _forces(state: ElementState, body: Body, node: int, gradient: tuple[int, int], strain: float) -> FloatArray:
    """Forces of an element at a node for one component of the displacement gradient."""
    i, j = gradient
    moved = body.displacement & (body.axis == i)
    field = np.zeros(len(body.axis))
    field[moved] = strain * body.points[body.local[moved], j]
    still = state.still().quiet()
    rhs = still.moved(field).evaluate().rhs[0] - still.evaluate().rhs[0]
    mine = body.displacement & (state.single.block.group.nodes[0][body.local] == node)
    return np.array([rhs[mine & (body.axis == direction)].sum() for direction in range(body.dimensions)])
