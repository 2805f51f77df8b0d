# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Arrays: entries of RHS and AMATRX left unset, reads and writes outside the arguments."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager
from typing import Final

from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed, not_applicable, passed
from uel.check.single import first_difference
from uel.check.subject import Subject
from uel.elements import Request
from uel.errors import KernelError, OutsideError
from uel.usersub import UNSET, around, guard_values, room, writes_outside

READ: Final = "PROPS", "SVARS", "ENERGY", "COORDS", "U", "DU", "V", "A", "PREDEF"
"""Arrays beyond which an element might read."""

POISONS: Final = float("nan"), 7.3, -2.9e5
"""Values that are put there."""

REALS: Final = "TIME", "PARAMS", "ADLMAG", "DDLMAG"
INTEGER_ARRAYS: Final = "JPROPS", "LFLAGS", "JDLTYP"
"""Other arrays, otherwise surrounded by 0."""

INTEGERS: Final = 1, 7, -290000
"""Value that is put around integer arrays."""

REQUESTS: Final = (
    *(Request.STIFFNESS, Request.DAMPING, Request.MASS),
    *(Request.RESIDUAL, Request.INITIAL_ACCELERATION),
)
"""Requests of general steps besides normal calls."""

ROOM: Final = 20000
"""Entries after each array where writes are looked for: a write far beyond one array does not reach the next."""

OUTSIDE: Final = (
    "In Abaqus this overwrites other data, and shows up as wrong results or a segmentation fault elsewhere. "
    "Compare VARIABLES=, PROPERTIES= and the dofs of *USER ELEMENT with the largest indices that UEL uses."
)


def check_filled(subject: Subject) -> Finding:
    """Check that RHS and AMATRX, NaN on entry, hold no NaN after a call."""
    for state in subject.states:
        with guard_values({UNSET: float("nan")}):
            try:
                state.evaluate()
            except KernelError as error:
                advice = (
                    "Set RHS and AMATRX to zero at the beginning of UEL (do i = 1, ndofel; rhs(i,1) = 0; ...), then "
                    "add to them: Abaqus does not document what they hold on entry."
                )
                return failed(str(error), advice)
    return passed(f"RHS and AMATRX are set at {len(subject.states)} states")


def check_outside(subject: Subject) -> Finding:
    """Check that the guards around each argument are intact after calls with any request."""
    with room(ROOM), writes_outside() as written:
        for state in subject.states:
            for request, called in _requests(state.strictly()):
                try:
                    called.evaluate()
                except OutsideError as error:
                    return failed(f"{error}{request}", OUTSIDE)
                except KernelError as error:
                    # an element may refuse what it is not asked for in a run
                    if not request:
                        return failed(str(error), OUTSIDE)
                for name, entry in written().items():
                    size = _sizes(subject).get(name, "")
                    return failed(f"{state}{request}: writes outside {name}: entry {entry}{size}", OUTSIDE)
    return passed(f"nothing is written outside the arguments at {len(subject.states)} states")


def _requests(state: ElementState) -> Iterator[tuple[str, ElementState]]:
    """Yield the call, then all other requests of Abaqus with a description; for KINC = 0 see arguments/no_time.py."""
    yield "", state
    for request in REQUESTS:
        yield f" with LFLAGS(3) = {request}", state.asked(request)


def _sizes(subject: Subject) -> dict[str, str]:
    """Return the sizes of the arrays that do not depend on the unknowns of the element, for messages."""
    sizes = {"TIME": 2, "PARAMS": 3, "LFLAGS": 7, "JPROPS": subject.definition.integer_properties}
    return {name: f" of {size}" for name, size in sizes.items()}


def check_undeclared(subject: Subject) -> Finding:
    """Check that memory beyond the declared ends of an array has no effect."""
    for state in subject.states:
        with around({}):
            expected = state.evaluate()
            if first_difference(expected, state.evaluate()):
                return not_applicable("the same call returns different values anyway")
            for array, poisoned in _poisons():
                if difference := state.influence(poisoned, expected):
                    message = f"{state}: what lies outside {array} changes the result: {difference}"
                    return _reads(subject, message, array)
    return passed(f"nothing outside the arrays has an effect at {len(subject.states)} states")


def _poisons() -> Iterator[tuple[str, AbstractContextManager[None]]]:
    """Yield the arrays, with what lies around them."""
    for array in READ:
        for poison in POISONS:
            yield array, guard_values({array: poison})
    for array in REALS:
        for poison in POISONS:
            yield array, around({array: poison})
    for array in INTEGER_ARRAYS:
        for number in INTEGERS:
            yield array, around({array: number})


def _reads(subject: Subject, message: str, array: str) -> Finding:
    definition = subject.definition
    declared = {
        "PROPS": f"*USER ELEMENT has PROPERTIES={definition.properties}",
        "JPROPS": f"*USER ELEMENT has I PROPERTIES={definition.integer_properties}",
        "SVARS": f"*USER ELEMENT has VARIABLES={definition.variables}",
        "TIME": "it has 2 entries",
        "PARAMS": "it has 3 entries",
        "LFLAGS": "it has 7 entries here",
        **dict.fromkeys(("ADLMAG", "DDLMAG", "JDLTYP"), "it has MDLOAD rows, of which NDLOAD are loads"),
        "COORDS": f"*USER ELEMENT has COORDINATES={definition.coordinates} and NODES={definition.nodes}",
    }.get(array, f"the element has {len(definition.dofs)} unknowns")
    advice = f"UEL reads beyond {array}: {declared} ({definition.source}). Declare more entries, or read fewer."
    return failed(message, advice)
