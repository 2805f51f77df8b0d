# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The largest load on the path: an increment that passes it with the help of the descent search is taken in parts.

The search finds an equilibrium even where a structure snaps in the middle of an increment. It does not say when, and it
may find the equilibrium beyond a snap that lies just ahead: increments of a hundredth of the displacement leave the
peak load uncertain by a hundredth. So the peak, and only the peak, is approached in smaller steps.

The load of an increment is measured by its power: the external forces times the displacements' change per time.
"""

from __future__ import annotations

import math

from uel.model.arrays import FloatArray

BENT = 0.8
"""Slope of the load over that of the increment before, below which an increment passes the peak."""

PASSED = "THE DESCENT SEARCH PASSED THE LARGEST LOAD. THE INCREMENT IS TAKEN IN SMALLER PARTS."


class LimitLoad:
    """Monitor of the load of one step. Forces are external ones (n,), at the start and at the end of an increment."""

    def __init__(self) -> None:
        self._slope = 0.0
        self._largest = -math.inf
        self._at_largest = False

    def passed(self, before: FloatArray, after: FloatArray, increment: FloatArray, size: float) -> bool:
        """Report whether an increment (n,) of displacements in a time `size` starts at the largest load and bends."""
        return self._at_largest and float((after - before) @ increment) < BENT * self._slope * size**2

    def converged(self, before: FloatArray, after: FloatArray, increment: FloatArray, size: float) -> None:
        """Record an increment that is kept; arguments as those of `passed`."""
        load = float(after @ increment) / size
        self._slope = float((after - before) @ increment) / size**2
        self._at_largest = load >= self._largest
        self._largest = max(self._largest, load)
