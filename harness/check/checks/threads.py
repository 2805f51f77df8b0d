# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Two elements do not write the same memory, as threads would at the same time."""

from __future__ import annotations

import numpy as np

from harness.check.finding import Finding, failed, not_applicable, passed
from harness.check.state import State
from harness.check.static_memory import Variable, variables_of
from harness.check.subject import Subject

Changes = dict[str, set[int]]
"""Bytes that calls have changed, by variable."""


def check(subject: Subject) -> Finding:
    """Calls of two elements change different bytes of the variables that outlive a call, or none."""
    variables = variables_of(subject.library)
    if variables is None:
        return not_applicable("the symbols of the library cannot be read")
    first = subject.states[0].single.name
    mine = [state for state in subject.all_states if state.single.name == first]
    theirs = [state for state in subject.all_states if state.single.name != first]
    changed, others = _changes(variables, mine, theirs or mine)
    if not changed and not others:
        return passed("no variable that outlives a call is changed by one")
    if not theirs:
        return not_applicable(f"calls change {', '.join(sorted(changed))}; there is no second element to compare with")
    common = sorted(name for name in changed if changed[name] & others.get(name, set()))
    if not common:
        return passed(f"elements change different parts of {', '.join(sorted({*changed, *others}))}")
    message = f"element {first} and others write the same memory: {', '.join(common)}"
    advice = (
        "With cpus= above 1 and threads Abaqus calls elements at the same time, and these variables get the values of "
        "either. Make them local, without initial value in the declaration, pass them as arguments, or keep them in "
        "SVARS; data that are only passed on to other routines belong into arrays by element number."
    )
    return failed(message, advice, entries=tuple(common))


def _changes(variables: list[Variable], mine: list[State], theirs: list[State]) -> tuple[Changes, Changes]:
    """What calls of either change after calls of the other."""
    changed: tuple[Changes, Changes] = {}, {}
    before = [variable.bytes() for variable in variables]
    for k in range(max(len(mine), len(theirs))):
        for side, states in enumerate((mine, theirs)):
            states[k % len(states)].evaluate()
            after = [variable.bytes() for variable in variables]
            for variable, old, new in zip(variables, before, after, strict=True):
                if places := np.flatnonzero(old != new).tolist():
                    changed[side].setdefault(variable.name, set()).update(places)
            before = after
    return changed
