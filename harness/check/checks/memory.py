# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What an element leaves unwritten, writes outside its arrays, and reads there."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager
from typing import Final

from harness.check.finding import Finding, failed, not_applicable, passed
from harness.check.single import first_difference
from harness.check.subject import Subject
from harness.errors import KernelError
from harness.usersub import UNSET, beyond_jprops, marks

READ: Final = "PROPS", "SVARS", "ENERGY", "COORDS", "U", "DU", "V", "A", "PREDEF"
"""Arrays beyond which an element might read."""

POISONS: Final = float("nan"), 7.3, -2.9e5
"""What is put there."""

INTEGERS: Final = 1, 7, -290000
"""What is put behind JPROPS, where there is 0 else."""


def check_filled(subject: Subject) -> Finding:
    """RHS and AMATRX hold NaN before the call, and none after it."""
    for state in subject.states:
        with marks({UNSET: float("nan")}):
            try:
                state.evaluate()
            except KernelError as error:
                advice = (
                    "Set RHS and AMATRX to zero at the beginning of UEL (do i = 1, ndofel; rhs(i,1) = 0; ...), then "
                    "add to them: Abaqus does not say what they hold on entry."
                )
                return failed(str(error), advice)
    return passed(f"RHS and AMATRX are set at {len(subject.states)} states")


def check_outside(subject: Subject) -> Finding:
    """Guards around each array are whole after the call."""
    for state in subject.states:
        try:
            state.strictly().evaluate()
        except KernelError as error:
            advice = (
                "In Abaqus this overwrites other data, and shows as wrong results or a segmentation fault elsewhere. "
                "Compare VARIABLES=, PROPERTIES= and the dofs of *USER ELEMENT with the largest indices that UEL uses."
            )
            return failed(str(error), advice)
    return passed(f"nothing is written outside the arrays at {len(subject.states)} states")


def check_undeclared(subject: Subject) -> Finding:
    """What lies beyond the declared ends of an array has no effect."""
    for state in subject.states:
        with beyond_jprops(0):
            expected = state.evaluate()
            if first_difference(expected, state.evaluate()):
                return not_applicable("the same call returns other values anyway")
            for array, poisoned in _poisons():
                with poisoned:
                    try:
                        difference = first_difference(expected, state.evaluate())
                    except KernelError as error:
                        difference = str(error)
                if difference:
                    message = f"{state}: what lies outside {array} changes the result: {difference}"
                    return _reads(subject, message, array)
    return passed(f"nothing outside the arrays has an effect at {len(subject.states)} states")


def _poisons() -> Iterator[tuple[str, AbstractContextManager[None]]]:
    """Arrays, with what lies around them."""
    for array in READ:
        for poison in POISONS:
            yield array, marks({array: poison})
    for number in INTEGERS:
        yield "JPROPS", beyond_jprops(number)


def _reads(subject: Subject, message: str, array: str) -> Finding:
    definition = subject.definition
    declared = {
        "PROPS": f"*USER ELEMENT has PROPERTIES={definition.properties}",
        "JPROPS": f"*USER ELEMENT has I PROPERTIES={definition.integer_properties}",
        "SVARS": f"*USER ELEMENT has VARIABLES={definition.variables}",
        "COORDS": f"*USER ELEMENT has COORDINATES={definition.coordinates} and NODES={definition.nodes}",
    }.get(array, f"the element has {len(definition.dofs)} unknowns")
    advice = f"UEL reads beyond {array}: {declared} ({definition.source}). Declare more, or read less."
    return failed(message, advice)
