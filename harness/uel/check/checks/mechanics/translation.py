# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rigid translation: no forces."""

from __future__ import annotations

from itertools import product
from typing import Final

import numpy as np

from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed, not_applicable, passed
from uel.check.rigid_motions import NO_BODY, body_of
from uel.check.subject import Subject
from uel.check.tie_breaking import exceeds, first_largest
from uel.model.arrays import FloatArray

TOLERANCE: Final = 1e-8
"""Tolerance relative to the sum of |stiffness| |translation|: the force of the motion if nothing cancelled."""


def check(subject: Subject) -> Finding:
    """Check that RHS does not change in translations by the element's size and by its deformation in the run."""
    figure, message = 0.0, ""
    for state in map(subject.quiet, subject.all_states):
        body = body_of(subject, state)
        if body is None:
            return not_applicable(NO_BODY)
        deformation = float(subject.scales[body.displacement].max())
        for direction, distance in product(range(body.dimensions), (body.size, deformation)):
            ratio, row, change = _added(subject, state, distance * body.translation(direction))
            if exceeds(ratio, figure):
                figure = ratio
                message = (
                    f"{state}: RHS({row + 1}) changes by {change:.4g}, {100 * ratio:.3g} % of what the stiffness would "
                    f"make of it, when the element moves by {distance:.4g} in direction {direction + 1}"
                )
    if figure <= TOLERANCE:
        return passed(f"forces unchanged to {figure:.1e}", figure, TOLERANCE)
    advice = (
        "Internal forces must depend on differences of displacements only: look for a node or a shape function that "
        "is left out (the derivatives of the shape functions sum to zero), and for U where a difference belongs. "
        "Elements that are attached to the ground (a foundation, a spring to a fixed point) or axisymmetric fail here "
        "and are right."
    )
    return failed(message, advice, figure=figure, limit=TOLERANCE)


def _added(subject: Subject, state: ElementState, motion: FloatArray) -> tuple[float, int, float]:
    """Return the largest added force, over the sum of |stiffness| |motion|; its row; the force."""
    here = state.evaluate()
    # in dynamics an element may compute inertia from DU: then it was elsewhere from the start
    moved = state.carried(motion) if state.dynamic else state.moved(motion)
    change = moved.evaluate().rhs[0] - here.rhs[0]
    ratio, row = relative(np.abs(change), subject.stiffness(state), motion)
    return ratio, row, float(change[row])


def relative(change: FloatArray, stiffness: FloatArray, motion: FloatArray) -> tuple[float, int]:
    """Return the largest change of RHS over the sum of |stiffness| |motion|, and its row."""
    cost = float((stiffness @ np.abs(motion)).max())
    row = first_largest(change)
    return float(change[row]) / cost if cost else float(change[row] > 0.0), row
