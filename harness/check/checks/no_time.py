# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Calls before the first increment: KINC = 0, and DTIME = 0."""

from __future__ import annotations

from harness.check.checks.requests import INITIAL
from harness.check.finding import Finding, failed, passed
from harness.check.subject import Subject
from harness.errors import KernelError


def check(subject: Subject) -> Finding:
    """Both with DU = 0: Abaqus makes such calls, and does not use what they return, but they have to return."""
    for state in subject.states:
        still = state.part(0.0)
        still.evaluate()
        # in dynamic steps that is the call for the accelerations at the start; AMATRX of others is divided by DTIME
        first = still.asked(INITIAL) if state.dynamic else still
        for name, called in (
            ("DTIME = 0", first.called(time_increment=0.0)),
            ("KINC = 0", still.called(increment=0)),
        ):
            try:
                called.evaluate()
            except KernelError as error:
                advice = (
                    f"Abaqus calls UEL with {name} before the first increment and throws the results away: they are "
                    "harmless unless floating-point errors stop the run, or something of them outlives the call. "
                    "Divide by DTIME only where it is above zero, and do not take KINC for an index."
                )
                return failed(f"called with {name} and DU = 0: {error}", advice)
    return passed(f"calls with KINC = 0 and with DTIME = 0 return, at {len(subject.states)} states")
