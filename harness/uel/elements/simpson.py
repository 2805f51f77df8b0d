# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Simpson's rule through the thickness of a layer."""

from __future__ import annotations

import numpy as np

from uel.model.arrays import FloatArray


def simpson(points: int) -> tuple[FloatArray, FloatArray]:
    """Return positions, from 0 to 1, and weights of an odd number of points; a single one is in the middle."""
    if points == 1:
        return np.array([0.5]), np.ones(1)
    weight = np.where(np.arange(points) % 2, 4.0, 2.0) / (3 * (points - 1))
    weight[[0, -1]] /= 2
    return np.linspace(0, 1, points), weight
