# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Input arguments of Abaqus."""

from __future__ import annotations

from typing import Final

from uel.check.finding import Finding, failed, passed
from uel.check.subject import Subject
from uel.usersub import Change, watched_inputs

SCALARS: Final = (
    *("NDOFEL", "NRHS", "NSVARS", "NPROPS", "MCRD", "NNODE", "JTYPE", "DTIME", "KSTEP", "KINC", "JELEM", "NDLOAD"),
    *("NPREDF", "MLVARX", "MDLOAD", "NJPROP", "PERIOD", "MATERIALLIB"),
)
"""Inputs that are scalars."""


def check(subject: Subject) -> Finding:
    """Check that a call leaves its inputs unchanged."""
    changes: dict[str, str] = {}
    with watched_inputs() as made:
        for state in subject.states:
            state.evaluate()
            for change in made():
                changes.setdefault(change.argument, f"{state}: {_described(change)}")
    if not changes:
        return passed(f"no input argument is changed at {len(subject.states)} states")
    first, *others = changes
    more = f"; also changed: {', '.join(others)}" if others else ""
    advice = (
        f"Abaqus passes {', '.join(changes)} in for information, and others use the same memory. Copy it to a local "
        "variable and change the copy. If UEL assigns nothing to it, look at the routines that get it as an argument, "
        "and at the declarations: an array declared larger than it is overlaps its neighbour."
    )
    return failed(f"{changes[first]}{more}", advice, entries=tuple(changes))


def _described(change: Change) -> str:
    name = change.argument if change.argument in SCALARS else f"entry {change.entry} of {change.argument}"
    return f"{name} is {change.before:.6g} before the call and {change.after:.6g} after it"
