# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rigid rotation: no forces, or forces that rotate with the element."""

from __future__ import annotations

from typing import Final

import numpy as np

from uel.check.checks.mechanics.translation import relative
from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed, not_applicable, passed
from uel.check.rigid_motions import AT_REST, INERTIA, NO_BODY, Body, body_of, makes_inertia
from uel.check.subject import Subject
from uel.errors import KernelError
from uel.model.arrays import FloatArray

TOLERANCE: Final = 1e-6
"""Tolerance relative to the sum of |stiffness| |motion|."""

TINY: Final = 1e-7
"""Angle of a rotation whose terms of second order are below the tolerance."""

ANGLE: Final = np.pi / 6
"""Angle of the finite rotation (rad)."""


def check(subject: Subject) -> Finding:
    """Rotate from the start of the analysis, with linear kinematics, or finite ones where the step has NLGEOM."""
    states = subject.resting
    bodies = [body_of(subject, state) for state in states]
    pairs = [(state, body) for state, body in zip(states, bodies, strict=True) if body is not None]
    if not pairs:
        return not_applicable(NO_BODY if states else AT_REST)
    if pairs[0][1].dimensions == 1:
        return not_applicable("one dimension: it is for elements that can rotate, with COORDINATES=2 or 3")
    if any(makes_inertia(*pair) for pair in pairs):
        return not_applicable(INERTIA)
    first, small = (max(_linear(subject, *pair, angle) for pair in pairs) for angle in (TINY, None))
    return _judge(states[0], first, small, max(_finite(subject, *pair) for pair in pairs))


def _judge(state: ElementState, first: float, small: float, finite: float) -> Finding:
    """Judge the largest relative forces of infinitesimal, small and finite rotations."""
    nlgeom = state.call.flags.nlgeom
    degrees = round(float(np.degrees(ANGLE)))
    if finite <= TOLERANCE:
        return passed(f"a rotation by {degrees} degrees turns the forces with it, to {finite:.1e}", finite, TOLERANCE)
    if small <= TOLERANCE and not nlgeom:
        return passed(f"linear kinematics, forces unchanged to {small:.1e}", small, TOLERANCE)
    if small <= TOLERANCE:
        message = (
            f"{state}: the step has NLGEOM, but a rotation by {degrees} degrees {_effect(finite)}; the kinematics are "
            "linear"
        )
        advice = (
            "The element has linear kinematics: run it without NLGEOM, or have it respond to LFLAGS(2) = 1 with a "
            "strain that is zero in rotations (Green-Lagrange, a corotational frame)."
        )
        return failed(message, advice, figure=finite if np.isfinite(finite) else None, limit=TOLERANCE)
    if first <= TOLERANCE:
        message = (
            f"{state}: a rotation by {degrees} degrees in one increment {_effect(finite)}, an infinitesimal one causes "
            "none"
        )
        advice = (
            "The strain is right for small increments of rotation only. Use one that no rotation changes "
            "(Green-Lagrange, logarithmic by polar decomposition); integrate a rate of deformation with the "
            "gradient at the middle of the increment, and rotate stresses (Hughes and Winget, ROTSIG)."
        )
        return failed(message, advice, figure=finite if np.isfinite(finite) else None, limit=TOLERANCE)
    message = (
        f"{state}: a small rigid rotation {_effect(first)}, and one by {degrees} degrees, with its second-order "
        f"terms, {_effect(finite)}"
    )
    advice = (
        "Check the strain-displacement matrix: shear takes both derivatives, du/dy + dv/dx, the shape functions sum "
        "to one, nodal rotations are those of the displacements, and a local frame is orthogonal; in a finite-strain "
        "element, stress and strain have to refer to the same configuration. Interface elements with thickness, "
        "springs with a fixed direction, and axisymmetric elements fail here and are right."
    )
    return failed(message, advice, figure=min(first, finite), limit=TOLERANCE)


def _effect(share: float) -> str:
    """Describe the effect of a rotation, as the end of a sentence."""
    if not np.isfinite(share):
        return "ends the analysis"
    return f"causes forces of {100 * share:.3g} % of what the stiffness would make of it"


def _forces(state: ElementState) -> FloatArray:
    """Return RHS (n,) without loads, which need not rotate with the element."""
    return np.asarray(state.called(distributed=None).evaluate().rhs[0])


def _linear(subject: Subject, state: ElementState, body: Body, angle: float | None) -> float:
    """Return the largest relative force of rotations without second-order terms, by default of the run's strains."""
    here, largest = _forces(state), 0.0
    angle = angle or float(subject.scales[body.displacement].max()) / body.size
    for motion in body.small_rotations():
        change = np.abs(_forces(state.moved(angle * motion)) - here)
        largest = max(largest, relative(change, subject.stiffness(state), angle * motion)[0])
    return largest


def _finite(subject: Subject, state: ElementState, body: Body) -> float:
    """Return the largest relative deviation of forces from rotated ones, for finite rotations; or infinity."""
    here, largest = _forces(state), 0.0
    for motion, rotation in body.rotations(float(ANGLE)):
        try:
            rotated = _forces(state.moved(motion))
        except KernelError:
            # with linear kinematics this is a large strain, which a material may refuse
            return np.inf
        change = np.abs(rotated - rotation @ here)
        largest = max(largest, relative(change, subject.stiffness(state), motion)[0])
    return largest
