# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Extrapolation of an increment from earlier ones of the step."""

from __future__ import annotations

from uel.model.arrays import FloatArray
from uel.model.restart import Saved


class Extrapolation:
    """EXTRAPOLATION= of *STEP: LINEAR (the default), PARABOLIC, NO.

    There is none for the first increment of a step, nor for one shorter than `shortest` times the last one that
    converged (D_E of *CONTROLS). PARABOLIC is linear after one increment.
    """

    def __init__(self, mode: str, shortest: float) -> None:
        self._mode, self._shortest = mode, shortest
        self._last: tuple[FloatArray, float] | None = None
        self._before: tuple[FloatArray, float] | None = None

    def guess(self, size: float) -> FloatArray | None:
        """Return an estimate (n,) of an increment of this size; None: start from zero."""
        if self._last is None or self._mode == "NO":
            return None
        last, h1 = self._last
        if size < self._shortest * h1:
            return None
        if self._mode != "PARABOLIC" or self._before is None:
            return last * (size / h1)
        before, h2 = self._before
        # a t + b t^2 through the last three states, t = 0 at the latest
        b = (last / h1 - (last + before) / (h1 + h2)) / h2
        a = last / h1 + b * h1
        return a * size + b * size**2

    def kept(self) -> Saved:
        """Return the increments that it extrapolates from."""
        needed = {"LINEAR": 1, "PARABOLIC": 2}.get(self._mode, 0)
        return {"increments": [list(one) for one in (self._last, self._before)[:needed] if one is not None]}

    def resume(self, saved: Saved) -> None:
        """Restore what `kept` returned."""
        self._last, self._before = ([(one[0], one[1]) for one in saved["increments"]] + [None, None])[:2]

    def converged(self, increment: FloatArray, size: float) -> None:
        """Keep a converged increment."""
        self._last, self._before = (increment, size), self._last
