# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Dependence on the size of the increments."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from harness.check.finding import Finding, failed, not_applicable, passed
from harness.check.state import State
from harness.check.subject import Subject
from harness.elements import Call
from harness.model.arrays import FloatArray

PIECES: Final = 1, 2, 8, 16
"""In how many parts the increment is made."""

CLOSER: Final = 0.75
"""The last difference over the first one, above which nothing converges."""

TOLERANCE: Final = 1e-6
"""Of the largest force: smaller differences are none."""


def check(subject: Subject) -> Finding:
    """Forces after 16 increments differ from those after 8 by less than those after 2 from those after one."""
    states = [state for state in subject.states if state.du.any() and not state.dynamic and state.call.time_increment]
    if not states:
        return not_applicable("a dynamic step" if subject.states[0].dynamic else "nothing moves within an increment")
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


def _in_pieces(state: State, pieces: int) -> FloatArray:
    """Forces at the end of the increment, made in equal parts from its start."""
    single = state.single.twin(strict=False)
    forces = np.zeros(0)
    for k in range(1, pieces + 1):
        done = k / pieces
        u = state.u - (1.0 - done) * state.du
        piece = replace(state, single=single, call=_call(state.call, k, pieces), u=u, du=state.du / pieces)
        forces = piece.evaluate().rhs[0]
        single.block.commit()
    return forces


def _call(call: Call, k: int, pieces: int) -> Call:
    """Of the k-th of some equal parts of an increment."""
    left = 1.0 - k / pieces
    loads, fields = call.distributed, call.predefined
    return replace(
        call,
        increment=call.increment + k - 1,
        time_increment=call.time_increment / pieces,
        step_time=call.step_time - left * call.time_increment,
        total_time=call.total_time - left * call.time_increment,
        distributed=loads
        and replace(loads, end=loads.end - left * loads.increment, increment=loads.increment / pieces),
        predefined=fields
        and replace(fields, end=fields.end - left * fields.increment, increment=fields.increment / pieces),
    )
