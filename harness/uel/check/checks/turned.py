# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The mass matrix of an element that stands in another direction: part of `requests`."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed
from uel.check.rigid_motions import PLANES, ROTATIONS, Body, body_of
from uel.check.subject import Subject
from uel.check.tie_breaking import first_largest
from uel.model.arrays import FloatArray

ANGLE: Final = 0.5
"""Angle of the turn (rad): no multiple of a symmetry."""

SEED: Final = 1
"""Seed of the random displacements."""

TOLERANCE: Final = 1e-8
"""Tolerance relative to the largest force, or entry of the mass matrix."""

ADVICE: Final = (
    "The forces of the element turn with it, the mass matrix does not: it is in the element's local axes. Turn it to "
    "global axes as the stiffness, T^T M T, also where it is lumped with different rotational inertia about each axis."
)


def check_turned(subject: Subject, state: ElementState, asking: ElementState) -> Finding | None:
    """Return a finding if the forces turn with the element's coordinates and the mass matrix does not.

    state: of a step in which RHS has internal forces; asking: of the call that asks for the mass matrix.
    """
    body = body_of(subject, state)
    if body is None or body.dimensions == 1 or not _complete(subject, body):
        return None
    mass = asking.evaluate().amatrx
    size = float(np.abs(mass).max())
    motion = subject.scales * np.random.default_rng(SEED).uniform(-1.0, 1.0, len(subject.scales))
    for i, j in PLANES[body.dimensions]:
        turn = np.eye(body.dimensions)
        turn[[i, i, j, j], [i, j, i, j]] = np.cos(ANGLE), -np.sin(ANGLE), np.sin(ANGLE), np.cos(ANGLE)
        unknowns = _of_unknowns(subject, body, turn)
        forces = _forces(state, motion)
        turned = _forces(_placed(subject, state, turn), unknowns @ motion)
        if np.abs(turned - unknowns @ forces).max() > TOLERANCE * np.abs(forces).max():
            # a fixed direction: axisymmetric, on a foundation, with axes that are chosen by global ones
            continue
        expected = unknowns @ mass @ unknowns.T
        found = _placed(subject, asking, turn).evaluate().amatrx
        row, column = np.unravel_index(first_largest(np.abs(found - expected)), mass.shape)
        deviation = float(abs(found[row, column] - expected[row, column]))
        if deviation > TOLERANCE * size:
            axis = next(k for k in range(3) if k not in (i, j))
            return failed(
                f"{asking}: if the element is turned about axis {axis + 1} by {np.degrees(ANGLE):.0f} degrees, entry "
                f"({row + 1},{column + 1}) of its mass matrix is {found[row, column]:.6g}, and has to be "
                f"{expected[row, column]:.6g}",
                ADVICE,
                figure=deviation / size,
                limit=TOLERANCE,
            )
    return None


def _complete(subject: Subject, body: Body) -> bool:
    """Report whether all other unknowns are rotations of nodes that have them about all axes."""
    rotations = np.isin(subject.dofs, ROTATIONS)
    if not (body.displacement | rotations).all():
        return False
    counts = [np.count_nonzero(subject.dofs == dof) for dof in ROTATIONS]
    return counts[:2] == [0, 0] if body.dimensions == 2 else len(set(counts)) == 1


def _of_unknowns(subject: Subject, body: Body, turn: FloatArray) -> FloatArray:
    """Return the matrix (n, n) that turns displacements and rotations of the nodes, and their forces."""
    dofs, local = subject.dofs, subject.local_nodes
    rotations = np.isin(dofs, ROTATIONS)
    axes = np.where(rotations, dofs - ROTATIONS[0], np.where(body.displacement, body.axis, 0))
    alike = (local[:, None] == local[None, :]) & (rotations[:, None] == rotations[None, :])
    if body.dimensions == 2:
        # nodes rotate about the axis of the turn
        axes = np.where(rotations, 0, axes)
        return np.where(alike, np.where(rotations[:, None], 1.0, turn[axes[:, None], axes[None, :]]), 0.0)
    return np.where(alike, turn[axes[:, None], axes[None, :]], 0.0)


def _placed(subject: Subject, state: ElementState, turn: FloatArray) -> ElementState:
    """Return the state of an element whose coordinates are turned about the origin."""
    coordinates = subject.recording.model.mesh.coordinates.copy()
    count = len(turn)
    coordinates[:, :count] = coordinates[:, :count] @ turn.T
    return replace(state, single=state.single.placed(coordinates))


def _forces(state: ElementState, motion: FloatArray) -> FloatArray:
    """Return RHS (n,) that displacements cause in the element at the start of its increment."""
    still = state.still().quiet()
    change: FloatArray = still.moved(motion).evaluate().rhs[0] - still.evaluate().rhs[0]
    return change
