# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Calls before the first increment: KINC = 0, and DTIME = 0."""

from __future__ import annotations

from collections.abc import Callable

from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed, passed
from uel.check.subject import Subject
from uel.elements import Request
from uel.errors import KernelError, OutsideError
from uel.usersub import writes_outside


def check(subject: Subject) -> Finding:
    """Check that both calls return, with DU = 0: Abaqus makes such calls and ignores their results."""
    with writes_outside() as outside:
        return _check(subject, outside)


def _strict_unless_faulty(state: ElementState) -> ElementState:
    """Return the state with writes outside arrays as errors, unchanged if the normal call makes such a write."""
    strict = state.strictly()
    try:
        strict.evaluate()
    except OutsideError:
        return state
    return strict


def _check(subject: Subject, outside: Callable[[], dict[str, int]]) -> Finding:
    for state in subject.states:
        still, earlier = _strict_unless_faulty(state.part(0.0)), outside()
        still.evaluate()
        earlier |= outside()
        # in dynamic steps this is the call for the initial accelerations; AMATRX of other calls is divided by DTIME
        first = still.asked(Request.INITIAL_ACCELERATION) if state.dynamic else still
        for name, called in (
            ("DTIME = 0", first.called(time_increment=0.0)),
            ("KINC = 0", still.called(increment=0)),
        ):
            try:
                called.evaluate()
                reason = next(
                    (
                        f"writes outside {name}: entry {entry}"
                        for name, entry in outside().items()
                        if name not in earlier
                    ),
                    "",
                )
            except KernelError as error:
                reason = str(error)
            if reason:
                advice = (
                    f"Abaqus calls UEL with {name} before the first increment and discards the results: the call is "
                    "harmless unless a floating-point error stops the run, or something outlives the call. "
                    "Divide by DTIME only if it is above zero, and do not use KINC as an index."
                )
                return failed(f"called with {name} and DU = 0: {reason}", advice)
    return passed(f"calls with KINC = 0 and with DTIME = 0 return, at {len(subject.states)} states")
