# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Values of unknowns at a time of a step: ramps, amplitudes and prescribed rates.

`Variation.at` serves prescribed values, loads, predefined fields and heat loads alike. How they continue from step to
step is in `nodal.py`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uel.model.amplitude import Amplitude
from uel.model.arrays import FloatArray, IntArray

SAMPLES = 501
"""Number of sampling points of the integral of a velocity."""


@dataclass(frozen=True, slots=True)
class ScaledUnknowns:
    """Unknowns whose values are `magnitude` times an amplitude."""

    unknowns: IntArray
    magnitude: float
    amplitude: Amplitude

    def value(self, step_time: float, total_time: float) -> float:
        """Return the value at a time."""
        factor = self.amplitude.value(step_time, total_time)
        return factor if self.amplitude.absolute else self.magnitude * factor

    def without(self, unknowns: IntArray) -> ScaledUnknowns:
        """Return this curve for fewer unknowns."""
        return ScaledUnknowns(self.unknowns[~np.isin(self.unknowns, unknowns)], self.magnitude, self.amplitude)


@dataclass(frozen=True, slots=True)
class PrescribedRate:
    """Unknowns whose rate is `magnitude` times an amplitude, or constant; `start` are their values at the start.

    begin  total time at the start of the step
    """

    unknowns: IntArray
    magnitude: float
    amplitude: Amplitude | None
    start: FloatArray
    begin: float

    def value(self, step_time: float) -> FloatArray:
        """Return the values at a step time: those at the start plus the integral of the rate."""
        if self.amplitude is None:
            return self.start + self.magnitude * step_time
        scale = 1.0 if self.amplitude.absolute else self.magnitude
        times, factors = self._sampled(self.amplitude, step_time)
        return self.start + scale * float(np.trapezoid(factors, times))

    def continued(self, period: float, displacement: FloatArray, total_time: float) -> PrescribedRate:
        """Return the continuation in the next step, at the final rate or along an amplitude in total time."""
        amplitude, magnitude = self.amplitude, self.magnitude
        if amplitude is not None and not amplitude.total_time:
            factor = amplitude.value(period, total_time)
            magnitude, amplitude = factor if amplitude.absolute else magnitude * factor, None
        return PrescribedRate(self.unknowns, magnitude, amplitude, displacement[self.unknowns], total_time)

    def without(self, unknowns: IntArray) -> PrescribedRate:
        """Return this rate for fewer unknowns."""
        kept = ~np.isin(self.unknowns, unknowns)
        return PrescribedRate(self.unknowns[kept], self.magnitude, self.amplitude, self.start[kept], self.begin)

    def _sampled(self, amplitude: Amplitude, step_time: float) -> tuple[FloatArray, FloatArray]:
        """Sample the amplitude evenly and at the corners of a table, for which the trapezoidal rule is then exact."""
        corners = amplitude.corners(self.begin)
        times = np.union1d(np.linspace(0.0, step_time, SAMPLES), corners[(corners > 0) & (corners < step_time)])
        return times, np.array([amplitude.value(time, self.begin + time) for time in times.tolist()])


@dataclass(frozen=True, slots=True)
class Variation:
    """Values of all unknowns over one step: base + slope t/T + curves; rates have zero base and slope."""

    base: FloatArray
    slope: FloatArray
    period: float
    curves: tuple[ScaledUnknowns, ...] = ()
    rates: tuple[PrescribedRate, ...] = ()

    def at(self, step_time: float, total_time: float) -> FloatArray:
        """Return the values (n,) at a time."""
        values = self.base + self.slope * (step_time / self.period)
        for curve in self.curves:
            values[curve.unknowns] += curve.value(step_time, total_time)
        for rate in self.rates:
            values[rate.unknowns] = rate.value(step_time)
        return values
