# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A rigid translation adds no force."""

from __future__ import annotations

from typing import Final

import numpy as np

from harness.check.finding import Finding, failed, not_applicable, passed
from harness.check.motions import NO_BODY, body_of
from harness.check.state import State
from harness.check.subject import Subject
from harness.model.arrays import FloatArray

TOLERANCE: Final = 1e-8
"""Of the sum of |stiffness| |translation|: what the motion would cost if nothing of it cancelled."""


def check(subject: Subject) -> Finding:
    """RHS stays when the element moves by its own size in any direction."""
    figure, message = 0.0, ""
    for state in subject.all_states:
        body = body_of(subject, state)
        if body is None:
            return not_applicable(NO_BODY)
        for direction in range(body.dimensions):
            ratio, row = _added(subject, state, body.size * body.translation(direction))
            if ratio > figure:
                figure = ratio
                message = (
                    f"{state}: RHS({row + 1}) changes by {100 * ratio:.3g} % of what the stiffness would make of it "
                    f"when the element moves by {body.size:.4g} in direction {direction + 1}"
                )
    if figure <= TOLERANCE:
        return passed(f"forces stay to {figure:.1e}", figure, TOLERANCE)
    advice = (
        "Internal forces have to depend on differences of displacements: look for a node, or a shape function, that "
        "is left out (the derivatives of the shape functions sum up to zero), and for U used where a difference "
        "belongs. Elements that are fixed to the ground (a foundation, a spring to a fixed point) or axisymmetric "
        "fail here and are right."
    )
    return failed(message, advice, figure=figure, limit=TOLERANCE)


def _added(subject: Subject, state: State, motion: FloatArray) -> tuple[float, int]:
    """Largest force that a motion adds, over what the stiffness makes of its parts, and the row."""
    here = state.evaluate()
    # in dynamics an element that moves has inertia: then it was elsewhere all the time
    moved = state.carried(motion) if state.dynamic else state.moved(motion)
    change = np.abs(moved.evaluate().rhs[0] - here.rhs[0])
    return relative(change, subject.stiffness(state), motion)


def relative(change: FloatArray, stiffness: FloatArray, motion: FloatArray) -> tuple[float, int]:
    """Largest change of RHS over the sum of |stiffness| |motion|, and its row."""
    cost = float((stiffness @ np.abs(motion)).max())
    row = int(change.argmax())
    return float(change[row]) / cost if cost else float(change[row] > 0.0), row
