# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Dependence on the size of the increments."""

from __future__ import annotations

from typing import Final

import numpy as np

from harness.check.finding import Finding, failed, not_applicable, passed
from harness.check.pieces import in_pieces
from harness.check.state import ElementState
from harness.check.subject import NOT_MOVING, Subject
from harness.model.arrays import FloatArray

PIECES: Final = 1, 2, 8, 16
"""In how many parts the increment is made."""

CLOSER: Final = 0.75
"""The last difference over the first one, above which nothing converges."""

DYNAMIC: Final = "a dynamic step, whose forces hold inertia: take a deck with a static step"

TOLERANCE: Final = 1e-6
"""Of the largest force: smaller differences are none."""


def check(subject: Subject) -> Finding:
    """Forces after 16 increments differ from those after 8 by less than those after 2 from those after one."""
    states = [state for state in subject.states if state.du.any() and not state.dynamic and state.call.time_increment]
    if not states:
        moves = any(state.du.any() for state in subject.states)
        return not_applicable(DYNAMIC if moves else NOT_MOVING)
    largest = 0.0
    for state in states:
        once, twice, eight, sixteen = (_in_pieces(state, pieces) for pieces in PIECES)
        size = max(float(np.abs(once).max()), float(np.abs(sixteen).max()), 1e-300)
        first, last = (float(np.abs(pair).max()) / size for pair in (twice - once, sixteen - eight))
        largest = max(largest, first)
        if last > max(CLOSER * first, TOLERANCE):
            message = (
                f"{state}: the forces change by {100 * first:.3g} % when the increment is made in two, and by "
                f"{100 * last:.3g} % when it is made in 16 and not in 8"
            )
            advice = (
                "Smaller increments have to lead to one solution. Look for something that is added in every call "
                "whatever DU and DTIME are, for a rate without DTIME, and for SVARS on entry that are not those of "
                "the last increment."
            )
            return failed(message, advice, figure=last, limit=CLOSER * first)
    return passed(f"forces change by {100 * largest:.2g} % when the increment is made in two, less in more", largest)


def _in_pieces(state: ElementState, pieces: int) -> FloatArray:
    """Forces at the end of the increment, made in equal parts from its start."""
    *_, last = in_pieces(state, [k / pieces for k in range(1, pieces + 1)])
    forces: FloatArray = last.rhs[0]
    return forces
