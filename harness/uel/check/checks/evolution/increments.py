# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Dependence on the size of the increments."""

from __future__ import annotations

from typing import Final

import numpy as np

from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed, not_applicable, passed
from uel.check.split_increment import subdivide
from uel.check.subject import NOT_MOVING, Subject
from uel.model.arrays import FloatArray

PARTS: Final = 1, 2, 8, 16
"""Numbers of parts in which the increment is made."""

CLOSER: Final = 0.75
"""Limit of the last difference relative to the first: above it, nothing converges."""

DYNAMIC: Final = "a dynamic step, whose forces include inertia: take a deck with a static step"

TOLERANCE: Final = 1e-6
"""Tolerance relative to the largest force: smaller differences count as zero."""

LATER: Final = 3
"""Number by which KINC is changed."""


def check(subject: Subject) -> Finding:
    """Check that the forces of 16 and 8 increments differ by less than those of 2 and 1."""
    states = [state for state in subject.states if state.du.any() and not state.dynamic and state.call.time_increment]
    if not states:
        moves = any(state.du.any() for state in subject.states)
        return not_applicable(DYNAMIC if moves else NOT_MOVING)
    if (counted := next(filter(_depends_on_number, states), None)) is not None:
        return failed(
            f"{counted}: RHS changes if KINC is larger by {LATER} and all else is the same",
            "KINC counts increments, whatever their size, and starts again in each step: use TIME, or a state in "
            "SVARS. A test for the first increment, KINC = 1, has to hold in the first step only.",
        )
    largest = 0.0
    for state in states:
        once, twice, eight, sixteen = (_final_forces(state, parts) for parts in PARTS)
        size = max(float(np.abs(once).max()), float(np.abs(sixteen).max()), 1e-300)
        first, last = (float(np.abs(pair).max()) / size for pair in (twice - once, sixteen - eight))
        largest = max(largest, first)
        if last > max(CLOSER * first, TOLERANCE):
            message = (
                f"{state}: the forces change by {100 * first:.3g} % if the increment is made in 2 parts instead of 1, "
                f"and by {100 * last:.3g} % if it is made in 16 instead of 8"
            )
            advice = (
                "Smaller increments have to converge to one solution. Look for something that is added in every call "
                "regardless of DU and DTIME, for a rate without DTIME, and for SVARS on entry that are not those of "
                "the last increment."
            )
            return failed(message, advice, figure=last, limit=CLOSER * first)
    return passed(f"forces change by {100 * largest:.2g} % when the increment is halved, then by less", largest)


def _depends_on_number(state: ElementState) -> bool:
    """Return whether RHS depends on KINC beyond the first increment, which an element may treat differently."""
    if state.call.increment < 2:
        return False
    later = state.called(increment=state.call.increment + LATER)
    return not np.array_equal(later.evaluate(matrix=False).rhs, state.evaluate(matrix=False).rhs)


def _final_forces(state: ElementState, parts: int) -> FloatArray:
    """Return the forces at the end of the increment, divided into equal parts."""
    *_, last = subdivide(state, [k / parts for k in range(1, parts + 1)])
    return np.asarray(last.rhs[0])
