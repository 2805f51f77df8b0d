# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Local variables used before they are set."""

from __future__ import annotations

from typing import Final

from uel.check.finding import Finding, failed, not_applicable, passed
from uel.check.single import first_difference
from uel.check.subject import Subject
from uel.usersub import local_variables

NUMBERS: Final = float("nan"), 7.3, -2.9e5
"""Values they hold, one after the other; 0 is what they most often hold by chance."""


ADVICE: Final = (
    "A local variable is used before it has a value, and then holds whatever an earlier call has left: "
    "results differ from machine to machine and from run to run. IMPLICIT NONE finds misspelt names; "
    "gfortran -Wall -O2 names most of the others."
)


def check(subject: Subject) -> Finding:
    """Check that uninitialised local variables have no effect."""
    if error := subject.recording.unset:
        message = (
            f"the deck runs only if local variables without a value are zero, as in the other checks; else {error}"
        )
        return failed(message, ADVICE)
    for state in subject.states:
        with local_variables(0.0):
            expected = state.evaluate()
            if first_difference(expected, state.evaluate()):
                return not_applicable("the same call returns different values anyway")
        for number in NUMBERS:
            if difference := state.influence(local_variables(number), expected):
                message = f"{state}: leftovers in the memory of local variables change the result: {difference}"
                return failed(message, ADVICE)
    return passed(f"leftovers in memory have no effect at {len(subject.states)} states")
