# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measured points that are compared in the logarithm: growth, lives."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from uel.fit.curve import Measurement
from uel.model.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class LogarithmicMeasurement(Measurement):
    """Measured points, y in the natural logarithm."""

    @property
    def logarithmic(self) -> bool:
        """True: powers are straight lines."""
        return True

    @property
    def difference(self) -> str:
        """Name of a difference of two y."""
        return f"change of ln({self.columns[1]})"

    @property
    def scale(self) -> float:
        """One: residuals are logarithms of factors."""
        return 1.0

    def distance(self, deviation: float) -> str:
        """Say how far a curve is from the points, by the root of the mean square."""
        return f"off by a factor of {math.exp(deviation):.4g}"

    def spread(self, deviation: float) -> str:
        """Describe the root of the mean square between curve and points."""
        return f"standard deviation from the measured {self.columns[1]}: a factor of {math.exp(deviation):.4g}"

    def change(self, largest: float) -> str:
        """Describe the largest change of the curve by a variable."""
        return f"changes {self.columns[1]} by up to {math.expm1(largest):.2%}"

    def written(self, values: FloatArray) -> FloatArray:
        """Return values (n,) such as y in the measure of the file."""
        return np.exp(values)
