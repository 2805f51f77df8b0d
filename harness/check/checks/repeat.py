# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The same input gives the same output, whatever was called in between."""

from __future__ import annotations

from harness.check.finding import Finding, failed, passed
from harness.check.single import first_difference
from harness.check.subject import Subject
from harness.errors import KernelError


def check(subject: Subject) -> Finding:
    """As in the iterations of an increment: other U in between, SVARS on entry always those of its start."""
    others = subject.states[0], subject.states[-1], *subject.random[:2]
    for state, first in zip(subject.states, subject.returned, strict=True):
        for between in others:
            try:
                between.evaluate()
            except KernelError:
                continue
        difference = first_difference(first, state.evaluate())
        if difference:
            message = f"{state}: the same call returns other values after others than in the run: {difference}"
            advice = (
                "Every iteration starts from the SVARS at the start of the increment, so what a call returns may "
                "depend on its arguments alone. Look for SAVE, COMMON, module variables, local variables with an "
                "initial value in their declaration (which are saved) or without any value, and for sums over "
                "iterations; keep in SVARS what an element has to remember."
            )
            return failed(message, advice)
    return passed(f"the same bits as in the run at {len(subject.states)} states, after other calls")
