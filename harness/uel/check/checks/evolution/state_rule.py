# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Continuity of the forces: an increment starts from the state at the end of the previous one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from uel.check.checks.mechanics.tangent import kinds
from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed, not_applicable, passed
from uel.check.split_increment import subdivide
from uel.check.subject import NOT_MOVING, Subject
from uel.check.tie_breaking import first_largest
from uel.errors import KernelError
from uel.model.arrays import FloatArray

PARTS: Final = 8, 128
"""Numbers of parts in which an increment is made."""

BEYOND: Final = 1e-3
"""Size of the part after them, over that of the others."""

LARGER: Final = 1e-2
"""Larger size of that part, over that of the others."""

TOLERANCE: Final = 1e-3
"""Tolerance relative to the largest force: the error that material laws solved by iteration may leave."""

CLOSER: Final = 0.5
"""Jump with many parts over that with few: that of a right element falls at least with the square root."""

STEEPER: Final = 3.0
"""Jump after a smaller part over that after a larger one: that of schemes that need equal steps grows."""

SLOWER: Final = 0.1
"""Factor of both DU and DTIME, with which no rate changes."""

SILENT: Final = 1e-6
"""Smallest force relative to those of the run's displacements: less counts as zero."""

SMOOTH: Final = 10.0
"""Factor of the forces that the stiffness makes of the further part: a smaller change is that part's own. Where the
forces of the terms of an element cancel, the rest of its RHS is no scale for it."""


@dataclass(frozen=True, slots=True)
class _Jump:
    """Largest jump of the forces across the end of an increment, over the largest force of its kind; its row."""

    ratio: float
    row: int
    before: float
    after: float


def check(subject: Subject) -> Finding:
    """Check that the change by a small increment after the last one shrinks with the increments."""
    states = [
        _without_history(state.quiet()) for state in subject.states if state.du.any() and state.call.time_increment
    ]
    if not states:
        return not_applicable(NOT_MOVING)
    largest = 0.0
    for state in states:
        if (finding := _without_time(subject, state)) is not None:
            return finding
        few, many = (_jump(subject, state, parts, BEYOND) for parts in PARTS)
        largest = max(largest, many.ratio)
        if many.ratio <= max(TOLERANCE, CLOSER * few.ratio):
            continue
        larger = _jump(subject, state, PARTS[1], LARGER)
        if abs(many.after - many.before) > STEEPER * abs(larger.after - larger.before):
            continue
        message = (
            f"{state}: made in {PARTS[1]} parts, RHS({many.row + 1}) ends at {many.before:.6g}, and a further part a "
            f"thousandth of their size, at the same rates, makes it {many.after:.6g}; with {PARTS[0]} parts the change "
            f"is {100 * few.ratio:.3g} % of the largest force, with {PARTS[1]} it is {100 * many.ratio:.3g} %"
        )
        advice = (
            "An increment, however small, has to begin with the forces with which the last one ended. Look for strains "
            "or stresses from DU alone where U is needed; for a state to which the part from DU is added, but which is "
            "not stored in SVARS at the end, or only in part, or with something added twice; and for SVARS that are "
            "read and written in different order."
        )
        return failed(message, advice, figure=many.ratio, limit=max(TOLERANCE, CLOSER * few.ratio))
    return passed(f"increments begin with the forces of the end of the last one, to {largest:.1e}", largest, TOLERANCE)


def _has_history(state: ElementState) -> bool:
    """Return whether RHS depends on SVARS, in this increment or, with their present values, in the next one."""
    every = np.ones(len(state.single.svars))
    try:
        return state.depends_on(every) or state.later().depends_on(every)
    except KernelError:
        # there constants do not take the place of the state, and the state itself makes no sense
        return True


def _without_time(subject: Subject, state: ElementState) -> Finding | None:
    """Return a finding if forces depend on DU other than as a rate, without a state to add it to."""
    fast, slow = (
        replace(state, du=share * state.du).called(time_increment=share * state.call.time_increment)
        for share in (1.0, SLOWER)
    )
    before = fast.evaluate(matrix=False).rhs[0]
    change = slow.evaluate(matrix=False).rhs[0] - before
    row = first_largest(np.abs(change))
    size = max(float(np.abs(before).max()), SILENT * float(subject.usual_forces.max()))
    if abs(change[row]) <= TOLERANCE * size or _has_history(state):
        return None
    # fluxes at an earlier time, as in the Crank-Nicolson scheme, are those of U minus a part of DU: a smaller DU leads
    # away from those at the start
    earlier = fast.carried(-state.du).evaluate(matrix=False).rhs[0] - before
    fraction = float(earlier @ change) / max(float(earlier @ earlier), 1e-300)
    if -1.0 < fraction < 0.0 and np.abs(change - fraction * earlier).max() <= TOLERANCE * size:
        return None
    message = (
        f"{state}: RHS({row + 1}) is {before[row]:.6g}, and {before[row] + change[row]:.6g} with a tenth of DU and "
        "DTIME and the same U; it depends on no SVARS"
    )
    advice = (
        "DU gets smaller with the increments. Without a state in SVARS to which it is added, forces may depend only on "
        "U and on rates, DU over DTIME."
    )
    return failed(message, advice, figure=float(abs(change[row])) / size, limit=TOLERANCE)


def _without_history(state: ElementState) -> ElementState:
    """Drop the forces of earlier increments, which *DYNAMIC weights by alpha."""
    return state.called(params=(0.0, *state.call.params[1:]))


def _stiffness(subject: Subject, state: ElementState) -> FloatArray:
    """Return magnitudes (n, n) of the stiffness; in a dynamic step, where AMATRX includes mass, from differences."""
    return np.abs(subject.differences(state).matrix) if state.dynamic else subject.largest_stiffness


def _jump(subject: Subject, state: ElementState, parts: int, beyond: float) -> _Jump:
    """Compute the jump at the end of the increment, made in equal parts with another part after them."""
    *_, last, next_one = subdivide(state, [*(k / parts for k in range(1, parts + 1)), 1.0 + beyond / parts])
    before, after = last.rhs[0], next_one.rhs[0]
    kind, least = kinds(subject.dofs), SILENT * subject.usual_forces
    smooth_change = SMOOTH * beyond / parts * (_stiffness(subject, state) @ np.abs(state.du))
    worst = _Jump(0.0, 0, 0.0, 0.0)
    for unit in np.unique(kind):
        of_unit = kind == unit
        size = float(np.maximum(np.abs(before), np.abs(after))[of_unit].max())
        if size <= float(least[of_unit].max()):
            continue
        change: FloatArray = np.where(of_unit, np.abs(after - before), 0.0)
        row = first_largest(change)
        if change[row] > max(worst.ratio * size, float(smooth_change[of_unit].max())):
            worst = _Jump(float(change[row]) / size, row, float(before[row]), float(after[row]))
    return worst
