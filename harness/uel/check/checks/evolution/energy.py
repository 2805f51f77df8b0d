# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""ENERGY against the work of the forces."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from uel.check.checks.mechanics.rest import MECHANICAL
from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed, not_applicable, passed
from uel.check.subject import NOT_MOVING, Subject
from uel.check.tie_breaking import exceeds

FRACTIONS: Final = 1.0, 0.1, 0.01, 0.001
"""Fractions of the increment: the work is from the trapezoidal rule, which is accurate for small increments."""

STEPS: Final = tuple(10.0 ** (-0.5 * k) for k in range(15, -1, -1))
"""Fractions of a share for a second trapezoidal sum, for stiff interfaces that are damaged early in it."""

TOLERANCE: Final = 1e-2
"""Tolerance relative to the work."""

LEAST: Final = 1e-8
"""Smallest work above rounding, relative to sum |force| |displacement|."""

INSTANT: Final = 1e-6
"""Part of the increment in which nothing happens."""

STORED: Final = slice(0, 7)
"""Entries of ENERGY that add up to the internal energy; ENERGY(8) is the work of loads."""


ADVICE_ON_ENTRY: Final = (
    "An increment without displacements must not change ENERGY: set the elastic energy, do not add it to the value "
    "on entry, and add only what this increment dissipates."
)


ADVICE_ON_TIME: Final = (
    "The energy is that on entry if TIME(1) is the total time: TIME(1) starts again in each step, and the element with "
    "it. What ages goes by TIME(2)."
)


def check(subject: Subject) -> Finding:
    """Check that the increase of the sum of ENERGY(1) to ENERGY(7) is the work of the internal forces."""
    reason = _reason_against(subject)
    if reason:
        return not_applicable(reason)
    pairs = [_on_entry(state) for state in subject.states]
    if any(_depends_on_time(state) for state in subject.all_states):
        return _lost(subject, pairs) or not_applicable(
            "the forces depend on DTIME: take properties without viscosity, if possible"
        )
    if (lost := _lost(subject, pairs)) is not None:
        return lost
    figure, message, judged = 0.0, "", 0
    for state in subject.all_states:
        pairs_at = [pair for fraction in FRACTIONS for pair in _stored_and_work(state, fraction)]
        if not pairs_at:
            continue
        judged += 1
        stored, work = min(pairs_at, key=_deviation)
        if exceeds(_deviation((stored, work)), figure):
            figure = _deviation((stored, work))
            message = f"{state}: ENERGY(1) to (7) grow by {stored:.5g}, the work of the forces is {work:.5g}"
    if not judged:
        return not_applicable(f"no work is done at the states; {NOT_MOVING}")
    if figure <= TOLERANCE:
        return passed(
            f"ENERGY grows by the work of the forces at {judged} states, to {100 * figure:.1e} %", figure, TOLERANCE
        )
    advice = (
        "ENERGY(2) is elastic strain energy (1/2 stress times strain, times volume); (3) to (6) hold what creep, "
        "plasticity, viscosity and stabilisation have dissipated since the start: add the part of this increment to "
        "the value on entry. A factor of 2 is a forgotten 1/2. Forces from elsewhere (bulk elements beside an "
        "interface) are not stored here."
    )
    return failed(message, advice, figure=figure, limit=TOLERANCE)


def _reason_against(subject: Subject) -> str:
    """Return the reason why work and ENERGY cannot be compared, '' if they can."""
    states = subject.all_states
    if (subject.dofs > MECHANICAL).any():
        return "dofs other than displacements and rotations, whose work is unknown: it is for mechanical elements"
    if any(state.dynamic for state in states):
        return "a dynamic step, in which RHS includes inertia: take a deck with a static step"
    if any(state.call.distributed is not None or state.call.predefined is not None for state in states):
        return "distributed loads or predefined fields, whose work is unknown: take a deck without them"
    if not any(state.evaluate().energy[STORED].any() for state in states):
        return "ENERGY is not set, or zero: it is for elements that set it, in a deck that deforms them"
    return ""


def _on_entry(state: ElementState) -> tuple[float, float]:
    """Return the energy on entry, and after a call at the increment's start: no displacements, nearly no time.

    An ageing element loses energy with time, and a viscous one turns it into another kind.
    """
    call = state.call
    rest = (1.0 - INSTANT) * call.time_increment
    still = state.part(0.0).called(
        time_increment=INSTANT * call.time_increment,
        step_time=call.step_time - rest,
        total_time=call.total_time - rest,
    )
    return float(state.single.energy[STORED].sum()), float(still.evaluate().energy[STORED].sum())


def _lost(subject: Subject, pairs: list[tuple[float, float]]) -> Finding | None:
    """Return a finding if a call without displacement increments changes the energy."""
    rounding = 1e-10 * max(abs(energy) for pair in pairs for energy in pair)
    for state, (entry, start) in zip(subject.states, pairs, strict=True):
        if abs(start - entry) > TOLERANCE * max(abs(start), abs(entry)) + rounding:
            message = f"{state}: ENERGY(1) to (7) are {start:.5g} with DU = 0, and {entry:.5g} on entry"
            _, by_total = _on_entry(state.called(step_time=state.call.total_time))
            of_step = abs(by_total - entry) <= TOLERANCE * max(abs(by_total), abs(entry)) + rounding
            advice = ADVICE_ON_TIME if of_step else ADVICE_ON_ENTRY
            return failed(message, advice, figure=abs(start - entry), limit=TOLERANCE * abs(entry))
    return None


def _depends_on_time(state: ElementState) -> bool:
    here = state.evaluate().rhs[0]
    slower = state.called(time_increment=3.0 * state.call.time_increment).evaluate().rhs[0]
    return bool(np.abs(slower - here).max() > 1e-9 * np.abs(here).max())


def _stored_and_work(state: ElementState, fraction: float) -> Iterator[tuple[float, float]]:
    """Yield the increase of energy over parts of the increment, and the work of the internal forces by two sums.

    Parts in which both are zero are left out.
    """
    start, end = state.part(0.0).evaluate(), state.part(fraction).evaluate()
    stored = float(end.energy[STORED].sum() - start.energy[STORED].sum())
    rounding = 1e-10 * float(np.abs(start.energy[STORED]).sum())
    forces, motion = -0.5 * (start.rhs[0] + end.rhs[0]), fraction * state.du
    least = LEAST * float(np.abs(forces) @ np.abs(motion)) + rounding
    by_step = [-float(state.part(step * fraction).evaluate().rhs[0] @ motion) for step in STEPS]
    at_start = -float(start.rhs[0] @ motion)
    for work in (float(forces @ motion), float(np.trapezoid([at_start, *by_step], [0.0, *STEPS]))):
        if max(abs(work), abs(stored)) > least:
            yield stored, work


def _deviation(pair: tuple[float, float]) -> float:
    return abs(pair[0] - pair[1]) / max(abs(pair[0]), abs(pair[1]))
