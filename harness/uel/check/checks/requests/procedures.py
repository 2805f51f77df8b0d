# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Requests by LFLAGS(3) that occur in the procedures of the deck."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from uel.check.checks.requests.capacity import TRANSIENT, check_capacity
from uel.check.checks.requests.damping import check_damping
from uel.check.checks.requests.perturbation import check_perturbation
from uel.check.checks.requests.rotated_mass import check_rotated_mass
from uel.check.element_calls import DYNAMIC, ElementState
from uel.check.finding import Finding, Verdict, failed, not_applicable, passed
from uel.check.recording import Pass
from uel.check.subject import Subject
from uel.check.tie_breaking import first_largest
from uel.elements import Damping, Flags, Motion, Request
from uel.model.arrays import FloatArray
from uel.model.perturbations import Frequency, SteadyState
from uel.usersub import UNSET, guard_values, watched_inputs

PERTURBATIONS: Final = Frequency().lflag, SteadyState().lflag
"""LFLAGS(1) of procedures that ask for the mass matrix alone."""

TOLERANCE: Final = 1e-9
"""Tolerance relative to the largest entry."""

LINEAR: Final = 1e-6
"""Tolerance of differences by accelerations, and of half increments, relative to the largest entry."""


def check(subject: Subject) -> Finding:
    """Check that the result of each request agrees with normal calls."""
    findings = list(_findings(subject))
    wrong = next((finding for finding in findings if finding.verdict is Verdict.FAILED), None)
    if wrong is not None:
        return wrong
    if not findings:
        return not_applicable(
            "the procedures of the deck use calls with LFLAGS(3) = 1 only: *DYNAMIC uses 4, 5 and 6 as well, "
            "*CONTROLS, PARAMETERS=LINE SEARCH 5, *FREQUENCY 2 and 4"
        )
    return passed(f"LFLAGS(3): {', '.join(finding.message for finding in findings)}")


def _findings(subject: Subject) -> Iterator[Finding]:
    all_flags = [event.call.flags for event in subject.recording.events if isinstance(event, Pass)]
    # the first pass of an increment, and the two of damping, make the same request as the others
    distinct = list(dict.fromkeys(replace(flags, extrapolated=False, damping=Damping.NONE) for flags in all_flags))
    requests = {(flags.procedure, flags.request) for flags in distinct}
    moving = [state for state in subject.states if state.dynamic]
    static = [state for state in subject.all_states if not state.dynamic]
    if static and any(request is Request.RESIDUAL and kind not in DYNAMIC for kind, request in requests):
        yield _residual(static)
    transient = next((state for state in static if state.call.flags.procedure in TRANSIENT), None)
    if transient is not None and (finding := check_capacity(subject, transient)) is not None:
        yield finding
    if moving:
        yield _mass(subject, moving[0])
        if (finding := _written(moving)) is not None:
            yield finding
        if moving[0].call.params[0]:
            yield _weights(subject, moving)
        if any((kind, Request.RESIDUAL) in requests for kind in DYNAMIC):
            yield _half_increment(subject, moving[0])
    # perturbations start from the last state of the steps before
    base = [state.part(0.0) for state in subject.states if not state.dynamic][-1:]
    for flags in distinct:
        request = flags.request
        if flags.linear and request in (Request.NORMAL, Request.PERTURBATION):
            yield check_perturbation(subject, static, flags)
        if base and request is Request.STIFFNESS:
            yield _stiffness(base[0], flags)
        if base and request is Request.MASS and flags.procedure in PERTURBATIONS:
            yield _mass_alone(subject, base[0], flags)
        if base and request is Request.DAMPING:
            yield check_damping(subject, base[0], moving[0] if moving else None, flags)


def _residual(states: list[ElementState]) -> Finding:
    """Check the residual alone in a static step."""
    for state in states:
        normal = state.evaluate().rhs[0]
        with guard_values({UNSET: float("nan")}):
            alone = state.asked(Request.RESIDUAL).evaluate(matrix=False).rhs[0]
        deviation = np.abs(alone - normal)
        row = first_largest(deviation)
        if deviation[row] > TOLERANCE * max(float(np.abs(normal).max()), 1e-300):
            return failed(
                f"{state}: RHS({row + 1}) is {alone[row]:.6g} with LFLAGS(3) = 5, {normal[row]:.6g} with 1",
                "With LFLAGS(3) = 5 Abaqus asks for RHS only; in a static step (line search) it is the same as with 1.",
                figure=float(deviation[row]),
            )
    return passed("residual only (5)")


def _half_increment(subject: Subject, state: ElementState) -> Finding:
    """Check the residual at half an increment of a dynamic step: with U and A it changes like that of a normal call.

    Both hold -M A + (1 + alpha) G(U); terms of earlier increments differ, and are the same before and after a change.
    """
    alone = state.asked(Request.RESIDUAL)
    # no rigid-body motion
    uneven = np.linspace(-1.0, 1.0, len(subject.scales))
    shift, accelerations = uneven * subject.scales, uneven * _accelerations(subject, state)
    for name, changed in (
        ("U", lambda one: replace(one, u=one.u + shift, du=one.du + shift)),
        ("A", lambda one: _accelerated(one, accelerations)),
    ):
        normal = changed(state).evaluate().rhs[0] - state.evaluate().rhs[0]
        with guard_values({UNSET: float("nan")}):
            half = changed(alone).evaluate(matrix=False).rhs[0] - alone.evaluate(matrix=False).rhs[0]
        row = first_largest(np.abs(half - normal))
        if abs(half[row] - normal[row]) > LINEAR * max(float(np.abs(normal).max()), 1e-300):
            return failed(
                f"{state}: when {name} changes, RHS({row + 1}) changes by {half[row]:.6g} with LFLAGS(3) = 5, by "
                f"{normal[row]:.6g} with 1",
                "In *DYNAMIC, LFLAGS(3) = 5 asks for the residual at half the increment, -M A + (1 + alpha) G - "
                "alpha/2 times the sum of G at the start of this increment and of the one before; PARAMS(1) is alpha. "
                "From it Abaqus chooses the next increment (HAFTOL, HALFINC SCALE FACTOR).",
                figure=float(abs(half[row] - normal[row])),
            )
    return passed("half-increment residual (5)")


def _weights(subject: Subject, states: list[ElementState]) -> Finding:
    """Check the weights of the operator of Hilber, Hughes and Taylor: (1 + alpha) G - alpha G_old.

    G changes with U as RHS with LFLAGS(3) = 6 does; elements that do not answer that request are not judged.
    """
    shift = subject.scales * np.linspace(-1.0, 1.0, len(subject.scales))
    for state in states:
        alpha = state.call.params[0]
        here = replace(state.quiet(), du=np.zeros_like(state.u)).called(distributed=None)
        there = here.carried(shift)
        initial = (
            there.asked(Request.INITIAL_ACCELERATION).evaluate().rhs[0]
            - here.asked(Request.INITIAL_ACCELERATION).evaluate().rhs[0]
        )
        if not np.abs(initial).max() > LINEAR * float(np.abs(there.evaluate().rhs[0]).max()):
            continue
        normal = there.evaluate().rhs[0] - here.evaluate().rhs[0]
        settled = there.settled().evaluate().rhs[0] - here.settled().evaluate().rhs[0]
        for change, factor, when in (
            (normal, 1.0 + alpha, "in the increment in which U changes"),
            (settled, 1.0, "in the increment after that"),
        ):
            row = first_largest(np.abs(change - factor * initial))
            deviation = float(abs(change[row] - factor * initial[row]))
            if deviation > LINEAR * float(np.abs(initial).max()):
                return failed(
                    f"{state}: {when}, RHS({row + 1}) of a normal call changes by {change[row]:.6g}, not by "
                    f"{factor * initial[row]:.6g}; alpha is {alpha:g}",
                    "RHS of *DYNAMIC is -M A + (1 + alpha) G - alpha times the G of the last increment, which SVARS "
                    "keep; PARAMS(1) is alpha. With LFLAGS(3) = 6 it is G, the static residual.",
                    figure=deviation,
                )
    return passed("weights of alpha")


def _mass(subject: Subject, state: ElementState) -> Finding:
    """Check the mass matrix of a dynamic step: -dRHS/dA, with either request."""
    with guard_values({UNSET: float("nan")}):
        mass = state.asked(Request.MASS).evaluate().amatrx
        initial = state.asked(Request.INITIAL_ACCELERATION).evaluate().amatrx
    heaviest = max(float(np.abs(mass).max()), float(np.abs(initial).max()))
    inertia = _inertia(subject, state, heaviest)
    size = float(np.abs(inertia).max())
    if not heaviest and not size:
        return passed("no mass (4 and 6)")
    if not mass.any():
        return failed(
            f"{state}: AMATRX is zero with LFLAGS(3) = 4",
            "Return the mass matrix with LFLAGS(3) = 4 and 6; otherwise the element has no inertia in *DYNAMIC.",
        )
    if np.abs(mass - initial).max() > TOLERANCE * np.abs(mass).max():
        return failed(
            f"{state}: AMATRX differs between LFLAGS(3) = 4 and 6 by {np.abs(mass - initial).max():.4g}",
            "Both ask for the mass matrix; 6 also asks for the residual, for the initial accelerations.",
        )
    row, column = np.unravel_index(first_largest(np.abs(mass - inertia)), mass.shape)
    deviation = float(abs(mass[row, column] - inertia[row, column]))
    wrong = _indefinite(state, mass) or check_rotated_mass(subject, state, state.asked(Request.MASS))
    if wrong is None and deviation > LINEAR * max(size, float(np.abs(mass).max())):
        return failed(
            f"{state}: AMATRX({row + 1},{column + 1}) is {mass[row, column]:.6g} with LFLAGS(3) = 4; "
            f"-dRHS({row + 1})/dA({column + 1}) of a normal call is {inertia[row, column]:.6g}",
            "In *DYNAMIC, RHS of a normal call includes -M A, with the mass matrix M that LFLAGS(3) = 4 and 6 return.",
            figure=deviation,
        )
    return wrong or passed("mass (4 and 6)")


def _mass_alone(subject: Subject, state: ElementState, flags: Flags) -> Finding:
    """Check the mass matrix for eigenfrequencies and harmonic responses."""
    asking = state.called(flags=flags)
    with guard_values({UNSET: float("nan")}):
        mass = asking.evaluate().amatrx
    if not mass.any():
        return passed("no mass (4)")
    if np.abs(mass - state.evaluate().amatrx).max() <= TOLERANCE * np.abs(mass).max():
        return failed(
            f"{state}: AMATRX with LFLAGS(3) = 4 is the stiffness, as with 1",
            "Test LFLAGS(3) at the beginning of UEL: with 4, AMATRX is the mass matrix, or zero without mass.",
        )
    return _indefinite(state, mass) or check_rotated_mass(subject, state, asking) or passed("mass (4)")


def _written(states: list[ElementState]) -> Finding | None:
    """Return a finding if calls of a dynamic step that do not end an increment write SVARS."""
    for state in states:
        for request in (Request.RESIDUAL, Request.MASS):
            with watched_inputs() as made:
                state.asked(request).evaluate(matrix=request is Request.MASS)
            for change in (change for change in made() if change.argument == "SVARS"):
                return failed(
                    f"{state}: SVARS({change.entry}) is {change.before:.6g} before a call with LFLAGS(3) = {request}, "
                    f"{change.after:.6g} after it",
                    "Write SVARS only with LFLAGS(3) = 1 and 6: they are the state at the end of an increment, and the "
                    "residual at half an increment (5) and the mass matrix (4) belong to no end. What such a call "
                    "stores is not kept; if RHS needs it, the formula is wrong.",
                    entries=(f"SVARS({change.entry})",),
                )
    return None


def _indefinite(state: ElementState, mass: FloatArray) -> Finding | None:
    """Return a finding if a mass matrix is not symmetric, or has negative eigenvalues."""
    size = float(np.abs(mass).max())
    if np.abs(mass - mass.T).max() > TOLERANCE * size:
        return failed(
            f"{state}: the mass matrix is not symmetric, by {np.abs(mass - mass.T).max():.4g}",
            "Inertia has a potential: M(i,j) is the integral of density times shape functions i and j.",
            figure=float(np.abs(mass - mass.T).max()),
        )
    smallest = float(np.linalg.eigvalsh(0.5 * (mass + mass.T))[0]) / size
    if smallest < -TOLERANCE:
        return failed(
            f"{state}: the mass matrix has a negative eigenvalue, {smallest:.3g} of its largest entry",
            "A mass matrix has none: check the sign, the Jacobian, and whether the stiffness is returned instead.",
            figure=smallest,
            limit=-TOLERANCE,
        )
    return None


def _stiffness(state: ElementState, flags: Flags) -> Finding:
    """Check the stiffness alone, for a perturbation of the state at the end of the earlier steps."""
    normal = state.evaluate().amatrx
    with guard_values({UNSET: float("nan")}):
        alone = state.called(flags=flags).evaluate().amatrx
    row, column = np.unravel_index(first_largest(np.abs(alone - normal)), alone.shape)
    deviation = float(abs(alone[row, column] - normal[row, column]))
    if deviation > TOLERANCE * max(float(np.abs(normal).max()), 1e-300):
        entry = f"AMATRX({row + 1},{column + 1})"
        return failed(
            f"{state}: {entry} is {alone[row, column]:.6g} with LFLAGS(3) = 2, {normal[row, column]:.6g} with 1",
            "With LFLAGS(3) = 2 Abaqus asks for the stiffness only, the AMATRX of a static call with DU = 0.",
            figure=deviation,
        )
    return passed("stiffness only (2)")


def _accelerations(subject: Subject, state: ElementState) -> FloatArray:
    """Return accelerations (n,) of the displacements of the run within an increment."""
    return subject.scales / max(state.call.time_increment, 1e-300) ** 2


def _accelerated(state: ElementState, shift: FloatArray) -> ElementState:
    """Return the state with a shift of only its accelerations."""
    return replace(state, motion=Motion(state.motion.velocity, state.motion.acceleration + shift))


def _inertia(subject: Subject, state: ElementState, heaviest: float) -> FloatArray:
    """Return -dRHS/dA (n, n), RHS being linear in A; heaviest: mass for which the change of RHS exceeds round-off."""
    here = state.evaluate().rhs[0]
    steps = np.maximum(_accelerations(subject, state), float(np.abs(here).max()) / heaviest if heaviest else 0.0)
    columns = [(here - _accelerated(state, step).evaluate().rhs[0]) / step.sum() for step in np.diag(steps)]
    return np.array(columns).T
