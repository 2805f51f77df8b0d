# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""AMATRX from difference quotients of RHS."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from uel.check.element_calls import ElementState
from uel.errors import KernelError
from uel.model.arrays import FloatArray

STEPS: Final = 10.0 ** np.arange(-2, -9, -1)
"""Steps of the differences, over the scale of an unknown."""

KINK: Final = 1e-3
"""Limit relative to the largest entry of a column: forward and backward differences further apart span two branches."""


@dataclass(frozen=True, slots=True)
class Differences:
    """Differences: -dRHS/dU by central differences.

    matrix  (n, n), column j by unknown j
    error   (n, n) estimate of its error, from another step
    smooth  (n,) False for a column at which RHS has a kink (onset of damage, contact), or could not be evaluated
    """

    matrix: FloatArray
    error: FloatArray
    smooth: np.ndarray


def differences(state: ElementState, scales: FloatArray) -> Differences:
    """Difference RHS by every unknown, in steps of parts of its scale (n,). Raises KernelError at the state itself."""
    n = len(state.u)
    here = state.evaluate(matrix=False).rhs[0]
    matrix, error, smooth = np.zeros((n, n)), np.full((n, n), np.inf), np.zeros(n, dtype=np.bool_)
    for column in range(n):
        result = _column(state, here, column, float(scales[column]))
        if result is not None:
            matrix[:, column], error[:, column], smooth[column] = result
    return Differences(matrix, error, smooth)


def _column(
    state: ElementState, here: FloatArray, column: int, scale: float
) -> tuple[FloatArray, FloatArray, bool] | None:
    """Compute the column with several steps and return the one with the smallest error."""
    best, least, before = None, np.inf, None
    shift = np.zeros(len(state.u))
    for step in scale * STEPS:
        # so that the difference of the arguments is exactly representable
        shift[column] = (state.u[column] + step) - state.u[column]
        if not shift[column]:
            break
        try:
            plus = state.moved(shift).evaluate(matrix=False).rhs[0]
            minus = state.moved(-shift).evaluate(matrix=False).rhs[0]
        except KernelError:
            before = None
            continue
        now = (minus - plus) / (2.0 * shift[column])
        if before is not None:
            change = np.abs(now - before)
            largest = float(change.max())
            if largest < least:
                jump = float(np.abs(plus + minus - 2.0 * here).max()) / shift[column]
                kink = jump > KINK * max(float(np.abs(now).max()), 1e-300)
                rounding = 8.0 * np.finfo(float).eps * np.abs(here).max() / shift[column]
                best, least = (now, change + rounding, not kink), largest
            if least <= 1e-9 * float(np.abs(now).max()) or largest > 100.0 * least:
                break
        before = now
    return best
