# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Repeatability: equal input gives equal output, independent of calls in between."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from typing import Final

from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed, passed
from uel.check.single import first_difference
from uel.check.subject import Subject
from uel.elements import Request
from uel.errors import KernelError

ADVICE: Final = (
    "Every iteration starts from the SVARS at the start of the increment, so what a call returns may "
    "depend on its arguments alone. Look for SAVE, COMMON, module variables, local variables with an "
    "initial value in their declaration (which are saved) or without any value, and for sums over "
    "iterations; keep in SVARS what the element has to remember."
)

TIMES: Final = (
    "What a call returns depends on the time increment of the call before it: look for SAVE, COMMON or a module "
    "variable that keeps DTIME, or a rate, and is used before this call has set it. DTIME of the last increment is not "
    "passed to UEL: keep it in SVARS if a formula needs it."
)

OTHER: Final = 0.37
"""Factor of DTIME, as after a cutback."""

RESIDUALS: Final = (
    "Abaqus discards calls with LFLAGS(3) = 5 (line search, middle of an increment of *DYNAMIC): they must leave no "
    "trace, in SAVE, COMMON or modules either."
)


def check(subject: Subject) -> Finding:
    """Repeat calls as in the iterations of an increment: other U in between, SVARS on entry those of its start.

    If UEXTERNALDB passes data on, a call is compared with the same call just before the others.
    """
    carries_on = subject.carries_on
    others = subject.states[0], subject.states[-1], *subject.random[:2]
    alone = [other.asked(Request.RESIDUAL) for other in others]
    shorter = [other.called(time_increment=OTHER * other.call.time_increment) for other in others]
    for between, when, advice in (
        (others, "after calls other than in the run", ADVICE),
        (alone, "after calls with LFLAGS(3) = 5", RESIDUALS),
        (shorter, "after calls with another DTIME", TIMES),
    ):
        for state, returned in zip(subject.states, subject.returned, strict=True):
            first = state.evaluate() if carries_on else returned
            _call(between)
            if difference := first_difference(first, state.evaluate()):
                return failed(f"{state}: the same call returns different values {when}: {difference}", advice)
    before = "just before" if carries_on else "in the run"
    return passed(f"the same bits as {before} at {len(subject.states)} states after other calls")


def _call(states: Iterable[ElementState]) -> None:
    """Call the elements and ignore their results."""
    for state in states:
        with suppress(KernelError):
            state.evaluate()
