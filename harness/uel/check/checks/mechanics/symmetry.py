# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Symmetry of AMATRX against UNSYMM of *USER ELEMENT."""

from __future__ import annotations

from typing import Final

import numpy as np

from uel.check.checks.mechanics.tangent import block_scales
from uel.check.finding import Finding, failed, passed
from uel.check.subject import Subject
from uel.check.tie_breaking import exceeds, first_largest

TOLERANCE: Final = 1e-6
"""Tolerance relative to the largest entry for the same kinds of dof."""


def check(subject: Subject) -> Finding:
    """Check symmetry: without UNSYMM the solver symmetrises AMATRX except in coupled temperature-displacement steps."""
    figure, message, entry = 0.0, "", ""
    for state in subject.all_states:
        amatrx = state.evaluate().amatrx
        magnitude = np.maximum(np.abs(amatrx), np.abs(amatrx.T))
        deviation = np.abs(amatrx - amatrx.T) / block_scales(magnitude, subject.dofs)
        if exceeds(float(deviation.max()), figure):
            figure = float(deviation.max())
            row, column = np.unravel_index(first_largest(deviation), deviation.shape)
            entry = f"AMATRX({row + 1},{column + 1})"
            message = (
                f"{state}: {entry} is {amatrx[row, column]:.6g}, AMATRX({column + 1},{row + 1}) is "
                f"{amatrx[column, row]:.6g}, {100 * figure:.3g} % of the largest entry apart"
            )
    if figure <= TOLERANCE:
        unneeded = "; UNSYMM is not needed at these states" if subject.definition.unsymmetric else ""
        return passed(f"symmetric to {figure:.1e}{unneeded}", figure, TOLERANCE)
    if subject.definition.unsymmetric:
        return passed(f"unsymmetric, as UNSYMM says: {100 * figure:.3g} % of the largest entry", figure)
    if all(state.call.unsymmetric for state in subject.states):
        return passed(f"unsymmetric, which coupled temperature steps use as it is: {100 * figure:.3g} %", figure)
    location = subject.definition.source
    advice = (
        f"Add UNSYMM to *USER ELEMENT ({location}), or make AMATRX symmetric if it should be. Without UNSYMM Abaqus "
        "solves with the symmetric part only, and the rest of AMATRX is lost."
    )
    return failed(message, advice, figure=figure, limit=TOLERANCE, entries=(entry,))
