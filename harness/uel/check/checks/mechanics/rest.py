# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rest: no forces without displacements, loads and fields."""

from __future__ import annotations

from typing import Final

import numpy as np

from uel.check.finding import Finding, failed, not_applicable, passed
from uel.check.rigid_motions import AT_REST
from uel.check.subject import Subject
from uel.check.tie_breaking import exceeds, first_largest
from uel.model.arrays import FloatArray

TOLERANCE: Final = 1e-9
"""Tolerance relative to the forces that the displacements of the run cause."""

MECHANICAL: Final = 6
"""Largest dof whose reaction is a force or a moment."""


def check(subject: Subject) -> Finding:
    """Check RHS with U = 0 and DU = 0 at the start of the analysis."""
    states = [state for state in subject.resting if state.call.predefined is None]
    mechanical = subject.dofs <= MECHANICAL
    if not states or not mechanical.any():
        return not_applicable(AT_REST if mechanical.any() else "no displacements or rotations among the dofs")
    if subject.carries_on:
        return not_applicable("UEXTERNALDB hands data on: here they are those of the end of the run")
    figure, message = 0.0, ""
    for state in states:
        forces = np.where(mechanical, np.abs(state.still().evaluate().rhs[0]), 0.0)
        row = first_largest(forces)
        ratio = float(forces[row]) / _usual(subject.stiffness(state), subject.scales)
        if exceeds(ratio, figure):
            figure = ratio
            message = f"{state}: RHS({row + 1}) has a magnitude of {forces[row]:.4g} with U = 0, DU = 0 and no loads"
    if figure <= TOLERANCE:
        return passed(f"no forces without displacements, to {figure:.1e}", figure, TOLERANCE)
    advice = (
        "Forces at rest move the model before it is loaded. Look for initial values that are not yet in SVARS in the "
        "first call (SVARS are zero then), and for body forces or stresses that always act; initial stresses that are "
        "meant to act fail here and are right."
    )
    return failed(message, advice, figure=figure, limit=TOLERANCE)


def _usual(stiffness: FloatArray, scales: FloatArray) -> float:
    """Return the largest force caused by the displacements of the run."""
    return float((stiffness @ scales).max()) or 1.0
