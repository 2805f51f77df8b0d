# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""LFLAGS(3): what a call asks for, as far as the procedures of the deck do."""

from __future__ import annotations

from typing import Final

import numpy as np

from harness.check.finding import Finding, failed, not_applicable, passed
from harness.check.recording import Pass
from harness.check.state import State
from harness.check.subject import Subject
from harness.usersub import UNSET, marks

MASS: Final = 4
RESIDUAL: Final = 5
INITIAL: Final = 6
"""Mass and residual, for the accelerations at the start of a dynamic step."""

TOLERANCE: Final = 1e-9
"""Of the largest entry."""


def check(subject: Subject) -> Finding:
    """Residual only as in a normal call; mass symmetric, positive, and the same however it is asked for."""
    passes = [event for event in subject.recording.events if isinstance(event, Pass)]
    asked = {event.call.lflags[2] for event in passes}
    done: list[str] = []
    static = [state for state in subject.all_states if not state.dynamic]
    if RESIDUAL in asked and static:
        finding = _residual(static)
        if finding is not None:
            return finding
        done.append("residual only (5)")
    dynamic = [state for state in subject.states if state.dynamic]
    if dynamic:
        finding = _mass(dynamic[0])
        if finding is not None:
            return finding
        done.append("mass (4 and 6)")
    if not done:
        return not_applicable("the procedures of the deck use calls with LFLAGS(3) = 1 alone")
    return passed(f"LFLAGS(3): {', '.join(done)}")


def _residual(states: list[State]) -> Finding | None:
    """A finding where the residual alone is wrong; that of a dynamic step is another one, of half an increment."""
    for state in states:
        normal = state.evaluate().rhs[0]
        with marks({UNSET: float("nan")}):
            alone = state.asked(RESIDUAL).evaluate(matrix=False).rhs[0]
        deviation = np.abs(alone - normal)
        row = int(deviation.argmax())
        if deviation[row] > TOLERANCE * max(float(np.abs(normal).max()), 1e-300):
            return failed(
                f"{state}: RHS({row + 1}) is {alone[row]:.6g} with LFLAGS(3) = 5, {normal[row]:.6g} with 1",
                "With LFLAGS(3) = 5 Abaqus asks for RHS alone, in a static step (line search) the same as with 1.",
                figure=float(deviation[row]),
            )
    return None


def _mass(state: State) -> Finding | None:
    with marks({UNSET: float("nan")}):
        mass = state.asked(MASS).evaluate().amatrx
        initial = state.asked(INITIAL).evaluate().amatrx
    size = float(np.abs(mass).max())
    if not size:
        return failed(
            f"{state}: AMATRX is zero with LFLAGS(3) = 4",
            "Return the mass matrix with LFLAGS(3) = 4 and 6, or the element has no inertia in *DYNAMIC.",
        )
    if np.abs(mass - initial).max() > TOLERANCE * size:
        return failed(
            f"{state}: AMATRX differs between LFLAGS(3) = 4 and 6 by {np.abs(mass - initial).max():.4g}",
            "Both ask for the mass matrix; 6 asks for the residual as well, for the accelerations at the start.",
        )
    smallest = float(np.linalg.eigvalsh(0.5 * (mass + mass.T))[0]) / size
    if smallest < -TOLERANCE:
        return failed(
            f"{state}: the mass matrix has a negative eigenvalue, {smallest:.3g} of its largest entry",
            "A mass matrix has none: look at the sign, at the Jacobian, and whether the stiffness is returned instead.",
            figure=smallest,
            limit=-TOLERANCE,
        )
    return None
