# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Update of the state variables on which the forces depend."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import suppress
from itertools import chain, product
from typing import Final

import numpy as np

from uel.check.element_calls import CHANGES, ElementState
from uel.check.finding import Finding, Verdict, failed, not_applicable, passed
from uel.check.subject import Subject, diagonal
from uel.errors import KernelError
from uel.model.arrays import FloatArray

GROWTH: Final = 3.0
"""Growth factor of random displacements from increment to increment, from those of the run to the size of the element:
an element that yields or breaks at some strain does so at one of them.
"""

ENOUGH: Final = 0.1
"""Displacements over the size of the element for which a call has to return without asking for a smaller increment."""

FEWEST: Final = 4
"""Number of increments if the displacements of the run are large."""

PATHS: Final = 4
"""Number of random directions, half of them opposite to the others."""

MORE: Final = 16
"""Number of further directions before a state variable is said not to be written: one integration point may yield or
break much later than another."""

REACH: Final = 1000.0
"""Ratio of their largest displacements to the first paths': to break, a stiff and strong interface moves far."""

MOVES: Final = 3
"""Largest dof that is a displacement."""

SHOWN: Final = 6
"""Number of state variables that a message names."""


def check(subject: Subject) -> Finding:
    """Check that calls write some of the state variables on which RHS depends.

    Not necessarily all: one that stays the same here may change under other loads.
    """
    if subject.library.sdvini or subject.recording.model.initial_solutions:
        return not_applicable(
            "SVARS have initial values, which may be constants: take a deck without *INITIAL CONDITIONS, TYPE=SOLUTION"
        )
    unwritten, far = np.ones(subject.definition.variables, dtype=np.bool_), False
    finding = None
    for tried in (
        chain(_of_run(subject), _paths(subject, range(PATHS), 1.0)),
        _paths(subject, range(PATHS, PATHS + MORE), REACH),
    ):
        for state, large in tried:
            with suppress(KernelError):
                returned = state.evaluate(matrix=False)
                unwritten &= returned.svars.view(np.int64) == state.single.svars.view(np.int64)
                far |= large and returned.pnewdt >= 1.0
        if not unwritten.any():
            return passed("every state variable is written")
        if not far:
            return not_applicable(
                "no call returns with displacements large enough to change a state: take a deck in which these "
                "elements yield or break"
            )
        finding = _judge((subject.states[0], subject.states[-1], *subject.random[-1:]), unwritten)
        if finding.verdict is not Verdict.FAILED:
            break
    assert finding is not None
    return finding


def _judge(states: tuple[ElementState, ...], unwritten: np.ndarray) -> Finding:
    """Judge the state variables (nsvars,) that none of the calls has written."""
    if not any(state.depends_on(unwritten) for state in states):
        if any(state.depends_on(~unwritten) for state in states):
            return passed("RHS depends on state variables that are written")
        return passed("RHS depends on no state variable")
    alone = {index: np.arange(len(unwritten)) == index for index in np.flatnonzero(unwritten).tolist()}
    read = [index for index, chosen in alone.items() if any(state.depends_on(chosen) for state in states)]
    if any(_writes(state, read) for state in states):
        return passed("RHS depends on state variables that are written")
    names = tuple(f"SVARS({index + 1})" for index in read)
    more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
    message = f"RHS depends on {', '.join(names[:SHOWN])}{more} on entry, and no call writes any of them"
    advice = (
        "An increment starts from what the last converged call stored in SVARS: without that the element forgets what "
        "happened, and starts afresh in each increment. Store the state at the end of UEL, in the entry from which it "
        "is read. A constant that other decks give by *INITIAL CONDITIONS, TYPE=SOLUTION fails here and is right."
    )
    return failed(message, advice, entries=names)


def _of_run(subject: Subject) -> Iterator[tuple[ElementState, bool]]:
    """Yield states of the run with negative zeros, which any sum changes; their displacements are not large."""
    for state in subject.all_states:
        yield state.with_svars(_negative_zeros(state.single.svars)), False


def _paths(subject: Subject, numbers: Iterable[int], reach: float) -> Iterator[tuple[ElementState, bool]]:
    """Yield states with negative zeros on random paths, and whether displacements are large.

    They are increments of ever larger displacements, up to the size of the element times `reach`, the last of which are
    in a later step.
    """
    moves = subject.dofs <= MOVES
    for number, state in product(numbers, (subject.states[0], subject.states[-1])):
        direction = subject.scales * np.random.default_rng(number // 2).uniform(-1.0, 1.0, len(subject.scales))
        direction *= (-1.0) ** number
        size = diagonal(subject.coordinates(state))
        largest = float(np.abs(direction[moves]).max(initial=0.0)) or size
        count = max(FEWEST, int(np.ceil(np.log(reach * size / largest) / np.log(GROWTH))) + 1)
        on_path = state.part(0.0).with_svars(_negative_zeros(state.single.svars))
        for later, step in product((0, 1), range(count)):
            on_path = on_path.moved_on(GROWTH**step * direction).called(step=state.call.step + later)
            yield on_path, largest * GROWTH**step >= ENOUGH * size
            on_path.single.block.commit()
            on_path = on_path.with_svars(_negative_zeros(on_path.single.svars))


def _negative_zeros(svars: FloatArray) -> FloatArray:
    """Replace 0.0 by -0.0."""
    return np.where(svars == 0.0, -0.0, svars)


def _writes(state: ElementState, indices: list[int]) -> bool:
    """Return whether a call changes a state variable whose value on entry is far out of its range."""
    for index, value in product(indices, CHANGES):
        svars = state.single.svars
        svars[index] += value
        with suppress(KernelError):
            if (state.with_svars(svars).evaluate(matrix=False).svars[indices] != svars[indices]).any():
                return True
    return False
