# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Mass matrix of a rotated element: part of `requests`."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed
from uel.check.rigid_motions import PLANES, ROTATIONS, Body, body_of, plane_rotation
from uel.check.subject import Subject
from uel.check.tie_breaking import first_largest
from uel.model.arrays import FloatArray

ANGLE: Final = 0.5
"""Angle of the rotation (rad): no symmetry of an element."""

SEED: Final = 1
"""Seed of the random displacements."""

TOLERANCE: Final = 1e-8
"""Tolerance relative to the largest force, or entry of the mass matrix."""

ADVICE: Final = (
    "The forces of the element turn with it, the mass matrix does not: it is in the element's local axes. Turn it to "
    "global axes as the stiffness, T^T M T, also where it is lumped with different rotational inertia about each axis."
)


def check_rotated_mass(subject: Subject, state: ElementState, asking: ElementState) -> Finding | None:
    """Return a finding if the forces rotate with the coordinates of the element and the mass matrix does not.

    state: with internal forces in RHS; asking: with the request of the mass matrix.
    """
    body = body_of(subject, state)
    if body is None or body.dimensions == 1 or not _complete(subject, body):
        return None
    mass = asking.evaluate().amatrx
    size = float(np.abs(mass).max())
    motion = subject.scales * np.random.default_rng(SEED).uniform(-1.0, 1.0, len(subject.scales))
    for i, j in PLANES[body.dimensions]:
        rotation = plane_rotation(body.dimensions, i, j, ANGLE)
        transformation = _transformation(subject, body, rotation)
        forces = _forces(state, motion)
        rotated_forces = _forces(_rotated(subject, state, rotation), transformation @ motion)
        if np.abs(rotated_forces - transformation @ forces).max() > TOLERANCE * np.abs(forces).max():
            # fixed directions: axisymmetric, on a foundation, or with axes from the global ones
            continue
        expected = transformation @ mass @ transformation.T
        rotated_mass = _rotated(subject, asking, rotation).evaluate().amatrx
        row, column = np.unravel_index(first_largest(np.abs(rotated_mass - expected)), mass.shape)
        deviation = float(abs(rotated_mass[row, column] - expected[row, column]))
        if deviation > TOLERANCE * size:
            axis = next(k for k in range(3) if k not in (i, j))
            return failed(
                f"{asking}: if the element is turned about axis {axis + 1} by {np.degrees(ANGLE):.0f} degrees, entry "
                f"({row + 1},{column + 1}) of its mass matrix is {rotated_mass[row, column]:.6g}, and has to be "
                f"{expected[row, column]:.6g}",
                ADVICE,
                figure=deviation / size,
                limit=TOLERANCE,
            )
    return None


def _complete(subject: Subject, body: Body) -> bool:
    """Return whether all other unknowns are nodal rotations about all axes."""
    rotations = np.isin(subject.dofs, ROTATIONS)
    if not (body.displacement | rotations).all():
        return False
    counts = [np.count_nonzero(subject.dofs == dof) for dof in ROTATIONS]
    return counts[:2] == [0, 0] if body.dimensions == 2 else len(set(counts)) == 1


def _transformation(subject: Subject, body: Body, rotation: FloatArray) -> FloatArray:
    """Return the matrix (n, n) that rotates nodal displacements, rotations, and forces."""
    dofs, local = subject.dofs, subject.local_nodes
    rotations = np.isin(dofs, ROTATIONS)
    axes = np.where(rotations, dofs - ROTATIONS[0], np.where(body.displacement, body.axis, 0))
    alike = (local[:, None] == local[None, :]) & (rotations[:, None] == rotations[None, :])
    if body.dimensions == 2:
        # nodes rotate about the axis of rotation
        axes = np.where(rotations, 0, axes)
        return np.where(alike, np.where(rotations[:, None], 1.0, rotation[axes[:, None], axes[None, :]]), 0.0)
    return np.where(alike, rotation[axes[:, None], axes[None, :]], 0.0)


def _rotated(subject: Subject, state: ElementState, rotation: FloatArray) -> ElementState:
    """Return the state of an element with rotated coordinates."""
    coordinates = subject.recording.model.mesh.coordinates.copy()
    count = len(rotation)
    coordinates[:, :count] = coordinates[:, :count] @ rotation.T
    return replace(state, single=state.single.placed(coordinates))


def _forces(state: ElementState, motion: FloatArray) -> FloatArray:
    """Return the RHS (n,) of displacements at the start of the increment."""
    still = state.still().quiet()
    return np.asarray(still.moved(motion).evaluate().rhs[0] - still.evaluate().rhs[0])
