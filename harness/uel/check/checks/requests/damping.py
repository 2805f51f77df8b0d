# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Damping matrices, which *STEADY STATE DYNAMICS asks for with LFLAGS(3) = 3: part of `requests`."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed, passed
from uel.check.subject import Subject
from uel.check.tie_breaking import first_largest
from uel.elements import Damping, Flags, Motion, Request
from uel.model.arrays import FloatArray
from uel.usersub import UNSET, guard_values

TOLERANCE: Final = 1e-9
"""Tolerance relative to the largest entry."""

SLOPE: Final = 1e-6
"""Tolerance of central differences with respect to velocities, relative to the largest entry."""


def check_damping(subject: Subject, state: ElementState, moving: ElementState | None, flags: Flags) -> Finding:
    """Check the damping matrices in the base state, and against velocities in a state of *DYNAMIC, if there is one."""
    stiffness = state.evaluate().amatrx
    viscous, structural = (_matrix(state, flags, kind) for kind in (Damping.VISCOUS, Damping.STRUCTURAL))
    for kind, matrix in ((Damping.VISCOUS, viscous), (Damping.STRUCTURAL, structural)):
        if matrix.any() and _agree(matrix, stiffness):
            return failed(
                f"{state}: AMATRX with LFLAGS(3) = 3 and LFLAGS(7) = {kind} is the stiffness, as with 1",
                "Test LFLAGS(3) at the beginning of UEL: with 3, AMATRX is the damping matrix, or zero without any.",
            )
    if viscous.any() and _agree(viscous, structural):
        return failed(
            f"{state}: AMATRX with LFLAGS(3) = 3 is the same for LFLAGS(7) = 1 and 2",
            "Abaqus asks for the viscous (LFLAGS(7) = 1) and the structural damping matrix (2) and uses both: return "
            "zero for the one that the element does not have.",
        )
    for name, matrix in (("viscous", viscous), ("structural", structural)):
        values = np.linalg.eigvalsh(0.5 * (matrix + matrix.T))
        size = float(np.abs(matrix).max())
        if size and values[-1] <= TOLERANCE * size:
            return failed(
                f"{state}: the {name} damping matrix has no positive eigenvalue",
                "Check its sign: AMATRX is minus the derivative of the nodal forces with respect to the velocities.",
            )
    wrong = _against_velocities(subject, moving, flags) if moving is not None else None
    return wrong or passed("damping (3)" if viscous.any() or structural.any() else "no damping (3)")


def _against_velocities(subject: Subject, state: ElementState, flags: Flags) -> Finding | None:
    """Return a finding if the viscous matrix is not -dRHS/dV of a dynamic call over 1 + alpha."""
    viscous = _matrix(state, flags, Damping.VISCOUS)
    slope = _slope(subject, state) / (1.0 + state.call.params[0])
    row, column = np.unravel_index(first_largest(np.abs(viscous - slope)), slope.shape)
    deviation = float(abs(viscous[row, column] - slope[row, column]))
    if deviation <= SLOPE * max(float(np.abs(slope).max()), float(np.abs(viscous).max()), 1e-300):
        return None
    return failed(
        f"{state}: AMATRX({row + 1},{column + 1}) is {viscous[row, column]:.6g} with LFLAGS(3) = 3 and LFLAGS(7) = 1; "
        f"-dG({row + 1})/dV({column + 1}) of a call of *DYNAMIC is {slope[row, column]:.6g}",
        "RHS of *DYNAMIC is -M A + (1 + alpha) G - alpha G_old; the viscous damping matrix is -dG/dV.",
        figure=deviation,
    )


def _matrix(state: ElementState, flags: Flags, kind: Damping) -> FloatArray:
    with guard_values({UNSET: float("nan")}):
        return state.called(flags=flags.asking(Request.DAMPING, kind)).evaluate().amatrx


def _agree(one: FloatArray, other: FloatArray) -> bool:
    return bool(np.abs(one - other).max() <= TOLERANCE * np.abs(one).max())


def _slope(subject: Subject, state: ElementState) -> FloatArray:
    """Return -dRHS/dV (n, n)."""
    steps = subject.scales / max(state.call.time_increment, 1e-300)
    columns = [(_sped(state, -step) - _sped(state, step)) / (2 * step.sum()) for step in np.diag(steps)]
    return np.array(columns).T


def _sped(state: ElementState, shift: FloatArray) -> FloatArray:
    """Return RHS with only the velocities changed."""
    motion = Motion(state.motion.velocity + shift, state.motion.acceleration)
    return np.asarray(replace(state, motion=motion).evaluate(matrix=False).rhs[0])
