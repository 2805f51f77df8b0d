# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Messages about wrong entries of the arrays of a user element."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from uel.errors import CallLimitError, DistortionError, ElementError, NotFiniteError, OutsideError
from uel.usersub.exchange import Outcome
from uel.usersub.faults import Fault

ERRORS: Final[Mapping[Fault, type[ElementError]]] = {
    Fault.ENDLESS: CallLimitError,
    Fault.NOT_FINITE: NotFiniteError,
    Fault.DISTORTED: DistortionError,
    Fault.OUTSIDE: OutsideError,
}
"""Errors that callers distinguish from a KernelError."""


def wrong_entry(outcome: Outcome, n: int) -> str:
    """Describe an entry of RHS or AMATRX that was not set, or is not a number; n: unknowns of the element."""
    column, row = divmod(outcome.item - 1, n)
    entry = f"RHS({outcome.item})"
    if outcome.array != "RHS" or column:
        entry = f"{outcome.array}({row + 1},{column + 1})"
    if outcome.fault is Fault.UNSET:
        half = outcome.array == "RHS" and outcome.item == n // 2 + 1 and n > 3
        hint = "; half of it is set, as if it were declared REAL (four bytes) instead of REAL*8" if half else ""
        why = "was not filled, or was added to without being set first (RHS and AMATRX are not zero on entry)"
        return f"{entry} {why}{hint}"
    return f"{entry} is NaN or infinite"


def material_point(outcome: Outcome) -> str:
    """Return the beginning of a message if a user routine of a point has ended the call, else ''."""
    return at_point(outcome.routine, outcome.item) if outcome.routine else ""


def at_point(routine: str, point: int) -> str:
    """Return the beginning of a message about a user routine of material points; point from 1."""
    return f"{routine} at integration point {point} "


def distortion(outcome: Outcome, points: int) -> str:
    """Describe the distortion of a built-in element: it is inside out, or crosses the axis (at -index).

    points: points of its stress; those of the volume, if there are more, are not named.
    """
    what = "turns inside out" if outcome.item > 0 else "crosses the axis"
    return f"{what} at its integration point {abs(outcome.item)}" if abs(outcome.item) <= points else what


def write_outside(outcome: Outcome, n: int, nrhs: int, sizes: Mapping[str, str]) -> str:
    """Describe a write outside an array; sizes: of arrays whose size does not follow from n unknowns and NRHS."""
    columns = str(n) if nrhs == 1 else f"{n * nrhs} ({n} x NRHS = {nrhs})"
    known = {"RHS": columns, "DU": columns, "ENERGY": "8", "AMATRX": f"{n * n} ({n} x {n})", **sizes}
    unknown = "" if outcome.position >= 0 else "; the element is unknown, because a repeated pass did not do it"
    return f"writes outside {outcome.array}: entry {outcome.item} of {known.get(outcome.array, str(n))}{unknown}"
