# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Peak load: an increment in which the descent search passes it is divided into parts.

The search finds an equilibrium even if a structure snaps within an increment. It does not tell when that happens, and
may find the equilibrium beyond a snap that is still ahead: with increments of a hundredth of the displacement, the peak
load is uncertain by a hundredth. So the peak, and only the peak, is approached in smaller increments.

The measure of the load is its power: the external forces times the change of the displacements per time.
"""

from __future__ import annotations

import math

from uel.model.arrays import FloatArray

FLATTER = 0.8
"""Slope of the load over that of the last increment below which an increment passes the peak."""

PASSED = "THE DESCENT SEARCH PASSED THE LARGEST LOAD. THE INCREMENT IS TAKEN IN SMALLER PARTS."


class LimitLoad:
    """Monitor of the load in one step, from the external forces (n,) at the start and the end of increments."""

    def __init__(self) -> None:
        self._slope = 0.0
        self._largest = -math.inf
        self._at_largest = False

    def passed(self, before: FloatArray, after: FloatArray, increment: FloatArray, size: float) -> bool:
        """Return whether an increment (n,) in a time `size` starts at the largest load and passes it."""
        return self._at_largest and float((after - before) @ increment) < FLATTER * self._slope * size**2

    def converged(self, before: FloatArray, after: FloatArray, increment: FloatArray, size: float) -> None:
        """Record a converged increment; arguments as in `passed`."""
        load = float(after @ increment) / size
        self._slope = float((after - before) @ increment) / size**2
        self._at_largest = load >= self._largest
        self._largest = max(self._largest, load)
