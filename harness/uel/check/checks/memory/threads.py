# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Thread safety: no two elements write the same memory."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from typing import Final

import numpy as np

from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed, not_applicable, passed
from uel.check.static_memory import Variable, variables_of
from uel.check.subject import Subject
from uel.errors import KernelError

ROUNDS: Final = 8
"""Number of calls of each element."""

GROWTH: Final = 1.5
"""Growth of the displacements from call to call."""

WORD: Final = 4
"""Bytes of one value, or of half of it."""

Changes = dict[str, set[int]]
"""Words that calls have changed, by variable."""


def check(subject: Subject) -> Finding:
    """Check that calls of two elements change different bytes of static variables, or none."""
    variables = variables_of(subject.library)
    if variables is None:
        return not_applicable("the symbols of the library cannot be read (nm is missing, or the library is stripped)")
    first = subject.states[0].single.name
    mine = subject.states[0]
    theirs = next((state for state in subject.states if state.single.name != first), None)
    changed, others = _changes(variables, _growing(subject, mine, 1), _growing(subject, theirs or mine, 2))
    if not changed and not others:
        return passed("calls change no variable that outlives them")
    if theirs is None:
        return not_applicable(f"calls change {', '.join(sorted(changed))}; there is no second element to compare with")
    common = sorted(name for name in changed if changed[name] & others.get(name, set()))
    if not common:
        return passed(f"elements change different parts of {', '.join(sorted({*changed, *others}))}")
    message = f"element {first} and others write the same memory: {', '.join(common)}"
    advice = (
        "With threads (cpus= above 1) Abaqus calls elements at the same time, and these variables get the values of "
        "either. Make them local, without initial value in the declaration, pass them as arguments, or keep them in "
        "SVARS; data that are only passed on to other routines belong in arrays indexed by element number."
    )
    return failed(message, advice, entries=tuple(common))


def _growing(subject: Subject, state: ElementState, seed: int) -> Iterator[ElementState]:
    """Yield growing random displacements, so that a variable with the maximum over all calls changes too."""
    rng = np.random.default_rng(seed)
    for number in range(ROUNDS):
        shift = GROWTH**number * subject.scales * rng.uniform(-1.0, 1.0, len(subject.scales))
        # the same DTIME for both elements, as in a run: one that is kept shows as a change by the first of them
        yield state.moved(shift).called(time_increment=GROWTH**-number * state.call.time_increment)


def _changes(
    variables: list[Variable], mine: Iterator[ElementState], theirs: Iterator[ElementState]
) -> tuple[Changes, Changes]:
    """Find the words of memory that alternate calls of the two elements change."""
    changed: tuple[Changes, Changes] = {}, {}
    before = [variable.bytes() for variable in variables]
    for pair in zip(mine, theirs, strict=True):
        for side, state in enumerate(pair):
            with suppress(KernelError):
                state.evaluate()
            after = [variable.bytes() for variable in variables]
            for variable, old, new in zip(variables, before, after, strict=True):
                if words := (np.flatnonzero(old != new) // WORD).tolist():
                    changed[side].setdefault(variable.name, set()).update(words)
            before = after
    return changed
