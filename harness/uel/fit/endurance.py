# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Endurance limit and slope of the S-N line of CF20 (fortran/laws.md, Fatigue)."""

from __future__ import annotations

from typing import Final

import numpy as np

from uel.model.arrays import FloatArray

CYCLES: Final = 1e7
"""Life at the endurance limit."""
DECADES: Final = 7.0
"""Its decimal logarithm."""
LESS_IN_SHEAR: Final = 0.42
"""Part by which the endurance limit of mode II is less than that of mode I."""
ENDURANCE, BRITTLENESS = 0.2, 0.95
"""Values that 0 stands for in a deck."""


def endurance_limit(
    ratio: FloatArray | float,
    shear: FloatArray | float,
    endurance: float = ENDURANCE,
    brittleness: float = BRITTLENESS,
) -> tuple[FloatArray, FloatArray]:
    """Return E, the endurance limit over the strength, and b, the exponent of the S-N line.

    Parameters
    ----------
    ratio
        Load ratio R.
    shear
        Share B of mode II in the energy.
    endurance, brittleness
        ENDURANCE and BRITTLENESS.
    """
    reversed_limit = endurance * (1.0 - LESS_IN_SHEAR * np.asarray(shear))
    limit = 2.0 * reversed_limit / (reversed_limit + 1.0 + ratio * (reversed_limit - 1.0))
    return limit, -DECADES * brittleness / np.log10(limit)
