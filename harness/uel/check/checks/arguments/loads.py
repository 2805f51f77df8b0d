# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Distributed loads of the deck."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed, not_applicable, passed
from uel.check.subject import Subject
from uel.errors import KernelError

TWICE: Final = 2.0
"""Factor of the load, with which RHS has to change."""


def check(subject: Subject) -> Finding:
    """Check that RHS changes with the magnitude of each load of type Un that the deck puts on an element."""
    changes: dict[int, bool] = {}
    where: dict[int, ElementState] = {}
    for state in subject.states:
        for kind in _kinds(state):
            changes[kind] = changes.get(kind, False) or _changes(state, kind)
            where.setdefault(kind, state)
    if not changes:
        return not_applicable(
            "no loads on the elements: if UEL takes loads of type Un, take a deck with *DLOAD that gives a magnitude"
        )
    unread = [kind for kind, changed in changes.items() if not changed]
    names = tuple(f"U{kind}" for kind in unread or changes)
    if not unread:
        return passed(f"RHS changes with the magnitude of {', '.join(names)}")
    message = f"{where[unread[0]]}: RHS does not change when the magnitude of {', '.join(names)} is doubled"
    advice = (
        "*DLOAD of type Un arrives as JDLTYP(k,1) = n with the magnitude ADLMAG(k,1), for k from 1 to NDLOAD; add its "
        "nodal forces to RHS, with a positive sign (DDLMAG is only the change of ADLMAG in this increment). Or remove "
        "the load from the deck."
    )
    return failed(message, advice, entries=names)


def _on_element(state: ElementState) -> np.ndarray:
    """Return the mask (loads,) of the loads on the state's element that have a magnitude."""
    loads = state.call.distributed
    if loads is None:
        return np.zeros(0, dtype=np.bool_)
    return np.asarray((loads.elements == state.single.block.first) & (loads.kinds > 0) & (loads.end != 0.0))


def _kinds(state: ElementState) -> list[int]:
    """Return the load types."""
    loads = state.call.distributed
    return [] if loads is None else sorted(set(loads.kinds[_on_element(state)].tolist()))


def _changes(state: ElementState, kind: int) -> bool:
    """Return whether RHS depends on loads of a type."""
    loads = state.call.distributed
    assert loads is not None
    # DDLMAG stays: the load is ADLMAG, not its change in this increment
    more = replace(loads, end=np.where(_on_element(state) & (loads.kinds == kind), TWICE, 1.0) * loads.end)
    try:
        rhs = state.called(distributed=more).evaluate(matrix=False).rhs
    except KernelError:
        return True
    return not np.array_equal(rhs, state.evaluate(matrix=False).rhs)
