# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Forces go on across the end of an increment: the next one begins with the state that this one has left."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from harness.check.checks.tangent import kinds
from harness.check.choice import first_largest
from harness.check.finding import Finding, failed, not_applicable, passed
from harness.check.pieces import in_pieces
from harness.check.state import ElementState
from harness.check.subject import NOT_MOVING, Subject
from harness.errors import KernelError
from harness.model.arrays import FloatArray

PARTS: Final = 8, 128
"""In how many parts an increment is made."""

BEYOND: Final = 1e-3
"""Size of the part behind them, over that of the others."""

LARGER: Final = 1e-2
"""Another size of that part."""

TOLERANCE: Final = 1e-3
"""Of the largest force: what material laws that are solved by iterations may leave."""

CLOSER: Final = 0.5
"""Jump with many parts over that with few ones: those of right elements fall at least with the square root."""

STEEPER: Final = 3.0
"""Jump behind a smaller part over that behind a larger one: those of schemes that want equal steps grow."""

SLOWER: Final = 0.1
"""Part of DU and DTIME, by which no rate changes."""

SILENT: Final = 1e-6
"""Forces below this part of those of the run's displacements are none."""


@dataclass(frozen=True, slots=True)
class _Jump:
    """Change of forces across the end of an increment: the largest over the largest force of its kind, and its row."""

    ratio: float
    row: int
    before: float
    after: float


def check(subject: Subject) -> Finding:
    """What a small increment behind the last one changes gets smaller with the increments."""
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
            f"{state}: made in {PARTS[1]} parts, RHS({many.row + 1}) ends at {many.before:.6g}, and a part of a "
            f"thousandth of that size behind them, at the same rates, makes it {many.after:.6g}; in {PARTS[0]} parts "
            f"the change is {100 * few.ratio:.3g} % of the largest force, in {PARTS[1]} it is {100 * many.ratio:.3g} %"
        )
        advice = (
            "An increment has to begin with the forces with which the last one has ended, however small it is. Look "
            "for strains or stresses of DU alone where those of U belong; for a state to which the part of DU is "
            "added, and that is not stored in SVARS at the end, or not all of it, or with something added twice; and "
            "for SVARS that are read and written in different order."
        )
        return failed(message, advice, figure=many.ratio, limit=max(TOLERANCE, CLOSER * few.ratio))
    return passed(f"increments begin with the forces of the end of the last one, to {largest:.1e}", largest, TOLERANCE)


def _has_history(state: ElementState) -> bool:
    """Whether RHS depends on SVARS, in this increment or, as they are now, in the next one."""
    every = np.ones(len(state.single.svars))
    try:
        return state.depends_on(every) or state.later().depends_on(every)
    except KernelError:
        # no constants stand for the state there, and as it is it makes no sense
        return True


def _without_time(subject: Subject, state: ElementState) -> Finding | None:
    """A finding where forces depend on DU, which is no rate, and on no state to which it could be added."""
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
    # flows of an earlier time, as in the scheme of Crank and Nicolson, are those of U less a part of DU: less of DU
    # leads away from those at the start
    earlier = fast.carried(-state.du).evaluate(matrix=False).rhs[0] - before
    part = float(earlier @ change) / max(float(earlier @ earlier), 1e-300)
    if -1.0 < part < 0.0 and np.abs(change - part * earlier).max() <= TOLERANCE * size:
        return None
    message = (
        f"{state}: RHS({row + 1}) is {before[row]:.6g}, and {before[row] + change[row]:.6g} with DU and DTIME both a "
        "tenth of what they are, for the same U; it depends on no SVARS"
    )
    advice = (
        "DU gets smaller with the increments. Without a state in SVARS to which it is added, forces may depend on U, "
        "and on rates, which are DU over DTIME."
    )
    return failed(message, advice, figure=float(abs(change[row])) / size, limit=TOLERANCE)


def _without_history(state: ElementState) -> ElementState:
    """Without the forces of earlier increments, which *DYNAMIC weighs by alpha."""
    return state.called(params=(0.0, *state.call.params[1:]))


def _jump(subject: Subject, state: ElementState, parts: int, beyond: float) -> _Jump:
    """At the end of the increment, made in equal parts, with another part behind them."""
    *_, last, next_one = in_pieces(state, [*(k / parts for k in range(1, parts + 1)), 1.0 + beyond / parts])
    before, after = last.rhs[0], next_one.rhs[0]
    kind, least = kinds(subject.dofs), SILENT * subject.usual_forces
    worst = _Jump(0.0, 0, 0.0, 0.0)
    for one in np.unique(kind):
        mine = kind == one
        size = float(np.maximum(np.abs(before), np.abs(after))[mine].max())
        if size <= float(least[mine].max()):
            continue
        change: FloatArray = np.where(mine, np.abs(after - before), 0.0)
        row = first_largest(change)
        if change[row] > worst.ratio * size:
            worst = _Jump(float(change[row]) / size, row, float(before[row]), float(after[row]))
    return worst
