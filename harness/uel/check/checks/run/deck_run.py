# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Completion of the requested increments of the deck."""

from __future__ import annotations

from typing import Final

from uel.check.finding import Finding, failed, not_applicable, passed
from uel.check.subject import Subject
from uel.errors import ConvergenceError, ElementError, SingularMatrixError, UelError
from uel.model.model import Model

ELEMENT_FAILED: Final = (
    "Run the deck with `uel run` and look at the printed messages. NaN usually comes from a division by zero or "
    "the root of a negative number at a state far from equilibrium: return PNEWDT < 1 there, and Abaqus tries a "
    "smaller increment."
)

SINGULAR: Final = (
    "AMATRX of the elements there is zero, or does not restrain the node. Look for a factor that is zero: a misspelt "
    "variable (IMPLICIT NONE, gfortran -Wall), a property that *UEL PROPERTY does not give, a thickness or weight; "
    "then check *BOUNDARY of the deck."
)

DIVERGED: Final = (
    "If `tangent` fails, fix AMATRX first. Else look at PNEWDT, at the state with which increments begin (check "
    "`state`), and whether the deck asks for more than the element can do: `uel run` writes the residuals of all "
    "iterations to .msg."
)

OTHER: Final = "Run the deck with `uel run`: it has to complete before more can be said."


def check(subject: Subject) -> Finding:
    """Check that the run converged in all requested increments, or all of the deck, and in at least one."""
    recording = subject.recording
    failure, done = recording.failure or recording.ending, recording.increments
    if failure is None and done:
        more = f"; the deck allows no more: {recording.stopped}" if recording.stopped else ""
        return passed(f"{done} increments of the deck{more}", float(done))
    if failure is None:
        return failed("the deck has no increment", "Give it a step with an increment that moves the elements.")
    if not _concerns(failure, subject.type, recording.model):
        return not_applicable(f"another type of element ended it, fix that first: {failure}")
    if isinstance(failure, ElementError) and failure.element_type == subject.type:
        return failed(str(failure), ELEMENT_FAILED)
    advice = OTHER
    if isinstance(failure, SingularMatrixError):
        advice = SINGULAR
    elif isinstance(failure, ConvergenceError):
        advice = DIVERGED
    return failed(f"the run of the deck ended after {done} increments: {failure}", advice, figure=float(done))


def _concerns(failure: UelError, kind: str, model: Model) -> bool:
    """Return whether the failure is attributed to this element type; without attribution, to all types."""
    blamed = _blamed(failure, model) & {group.type for group in model.groups if group.definition is not None}
    return not blamed or kind in blamed


def _blamed(failure: UelError, model: Model) -> set[str]:
    """Return the type of the failed element, or the types at the unconstrained node and dof."""
    if isinstance(failure, ElementError):
        return {failure.element_type}
    if not isinstance(failure, SingularMatrixError):
        return set()
    types = set()
    for group in model.groups:
        for local, dof in group.definition.dofs if group.definition else ():
            if dof == failure.dof and failure.node in map(model.mesh.name, group.nodes[:, local].tolist()):
                types.add(group.type)
    return types
