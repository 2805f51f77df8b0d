# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""First estimate of an increment from those before it in the step."""

from __future__ import annotations

from harness.model.arrays import FloatArray


class Extrapolation:
    """EXTRAPOLATION= of *STEP: LINEAR (the default), PARABOLIC, NO.

    Nothing is extrapolated into the first increment of a step. PARABOLIC is linear after one increment.
    """

    def __init__(self, mode: str) -> None:
        self._mode = mode
        self._last: tuple[FloatArray, float] | None = None
        self._before: tuple[FloatArray, float] | None = None

    def guess(self, size: float) -> FloatArray | None:
        """Estimate of an increment of this size; None: start from zero."""
        if self._last is None or self._mode == "NO":
            return None
        last, h1 = self._last
        if self._mode != "PARABOLIC" or self._before is None:
            return last * (size / h1)
        before, h2 = self._before
        # a t + b t^2 through the last three states, t = 0 at the latest
        b = (last / h1 - (last + before) / (h1 + h2)) / h2
        a = last / h1 + b * h1
        return a * size + b * size**2

    def converged(self, increment: FloatArray, size: float) -> None:
        """Keep a converged increment."""
        self._last, self._before = (increment, size), self._last
