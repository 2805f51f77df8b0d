# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""AMATRX against differences of RHS."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from uel.check.differences import Differences
from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed, not_applicable, passed
from uel.check.subject import Subject
from uel.check.tie_breaking import exceeds, ranked
from uel.model.arrays import FloatArray

TOLERANCE: Final = 1e-5
"""Tolerance relative to the largest entry for the same kinds of dof; smaller errors need no more iterations."""

ALIKE: Final = 1e-3
"""Relative difference up to which a matrix counts as another one, to say what is wrong with it."""

SHOWN: Final = 6
"""Number of entries that a message names."""


@dataclass(frozen=True, slots=True)
class _Worst:
    """The state with the largest deviation: AMATRX, differences and (n, n) deviations over the scale of each entry."""

    state: ElementState
    amatrx: FloatArray
    differences: Differences
    deviation: FloatArray


def check(subject: Subject) -> Finding:
    """Check that every entry of AMATRX is -dRHS/dU, at all states where RHS has no kink."""
    worst: _Worst | None = None
    columns = 0
    for state in subject.all_states:
        amatrx = state.evaluate().amatrx
        quotients = subject.differences(state)
        columns += int(quotients.smooth.sum())
        scale = block_scales(np.maximum(np.abs(amatrx), np.abs(quotients.matrix)), subject.dofs)
        surplus = np.where(quotients.smooth, np.abs(amatrx - quotients.matrix) - 10.0 * quotients.error, 0.0)
        deviation = np.maximum(surplus, 0.0) / scale
        if worst is None or exceeds(float(deviation.max()), float(worst.deviation.max())):
            worst = _Worst(state, amatrx, quotients, deviation)
    if worst is None or not columns:
        return not_applicable(
            "RHS has a kink, or no value next to that of the run, at every state tried: take smaller increments, or "
            "more of them (--increments)"
        )
    figure = float(worst.deviation.max())
    if figure <= TOLERANCE:
        message = f"{columns} columns at {len(subject.all_states)} states agree, largest deviation {figure:.1e}"
        return passed(message, figure, TOLERANCE)
    wrong = np.argwhere(worst.deviation > TOLERANCE)
    order = ranked(worst.deviation[tuple(wrong.T)])
    entries = tuple(f"AMATRX({row + 1},{column + 1})" for row, column in wrong[order].tolist())
    row, column = wrong[order[0]].tolist()
    more = f" and {len(entries) - SHOWN} more" if len(entries) > SHOWN else ""
    message = (
        f"{worst.state}: {entries[0]} is {worst.amatrx[row, column]:.6g}, differences of RHS give "
        f"{worst.differences.matrix[row, column]:.6g}; {len(entries)} of {worst.amatrx.size} entries are wrong by up "
        f"to {100 * figure:.3g} % of the largest: {', '.join(entries[:SHOWN])}{more}"
    )
    return failed(message, _advice(worst, subject), figure=figure, limit=TOLERANCE, entries=entries)


def kinds(dofs: np.ndarray) -> np.ndarray:
    """Assign a number (n,) to each unknown by its unit: displacements 1, rotations 4, else the dof."""
    return np.where(dofs <= 3, 1, np.where(dofs <= 6, 4, dofs))


def block_scales(magnitude: FloatArray, dofs: np.ndarray) -> FloatArray:
    """Return the largest entry (n, n) among those of the same kinds of row and column; 1 where all are zero."""
    kind = kinds(dofs)
    scale = np.ones_like(magnitude)
    for row in np.unique(kind):
        for column in np.unique(kind):
            block = np.ix_(kind == row, kind == column)
            scale[block] = magnitude[block].max() or 1.0
    return scale


def _advice(worst: _Worst, subject: Subject) -> str:
    smooth = worst.differences.smooth
    amatrx, expected = worst.amatrx[:, smooth], worst.differences.matrix[:, smooth]
    size = float(np.abs(expected).max())
    # another matrix explains the deviation if it leaves far less of it
    limit = min(ALIKE * size, 0.1 * float(np.abs(amatrx - expected).max()))
    if np.abs(amatrx + expected).max() < limit:
        return "The sign is wrong: AMATRX is -dRHS/dU, and RHS is external minus internal force."
    if not amatrx.any():
        return _advice_on_zero(worst.state, subject)
    if smooth.all() and np.abs(amatrx.T - expected).max() < limit:
        return "AMATRX is transposed: AMATRX(i,j) is -dRHS(i)/dU(j), so row i belongs to the force."
    factor = float((amatrx * expected).sum() / max(float((expected**2).sum()), 1e-300))
    if np.abs(amatrx - factor * expected).max() < limit:
        return (
            f"AMATRX is {factor:.6g} times what it should be: look for a weight, thickness or Jacobian that only one "
            "of RHS and AMATRX has."
        )
    missing = _missing_coupling(amatrx, expected, subject.dofs, subject.dofs[smooth])
    if missing:
        return f"AMATRX is zero for {missing}: add the derivatives of these forces with respect to these unknowns."
    return (
        f"{_wrong_blocks(worst, subject.dofs)}Differentiate RHS again for these entries: what is missing is usually a "
        "term from DU, from the derivative of the state, or from SVARS that change within the increment. Newton's "
        "method needs the derivative of the RHS that this call returns; an approximate AMATRX costs iterations and "
        "cutbacks, not accuracy."
    )


def _wrong_blocks(worst: _Worst, dofs: np.ndarray) -> str:
    """Name the dofs to which the wrong entries belong, in a sentence; '' if these are all, or too many to name."""
    kind = kinds(dofs)
    rows, columns = np.nonzero(worst.deviation > TOLERANCE)
    pairs = sorted(set(zip(kind[rows].tolist(), kind[columns].tolist(), strict=True)))
    if len(pairs) == len(np.unique(kind)) ** 2 or len(pairs) > SHOWN // 2:
        return ""
    names = {1: "displacements", 4: "rotations"}
    of = [f"of {names.get(row, f'dof {row}')} by {names.get(column, f'dof {column}')}" for row, column in pairs]
    return f"All are derivatives of RHS: {' and '.join(of)}. "


def _advice_on_zero(state: ElementState, subject: Subject) -> str:
    if state.u.any() or not any(other.evaluate().amatrx.any() for other in subject.all_states):
        return "AMATRX is zero: fill it with -dRHS/dU if LFLAGS(3) is 1."
    return (
        "AMATRX is zero if U is zero, and not otherwise: look for a test for U = 0 after which UEL returns. The first "
        "calls of an analysis have U = 0, and their AMATRX is used."
    )


def _missing_coupling(amatrx: FloatArray, expected: FloatArray, rows: np.ndarray, columns: np.ndarray) -> str:
    """Name dofs between which AMATRX is zero and should not be, as the end of a sentence; '' if there are none."""
    for force in np.unique(rows):
        for unknown in np.unique(columns):
            block = np.ix_(rows == force, columns == unknown)
            if not amatrx[block].any() and np.abs(expected[block]).max() > ALIKE * np.abs(expected).max():
                return f"the forces at dof {force} and the unknowns at dof {unknown}"
    return ""
