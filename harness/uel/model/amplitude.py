# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*AMPLITUDE: the factor of a load or prescribed value as a function of time."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from uel.errors import Source
from uel.model.arrays import FloatArray


class AmplitudeType(StrEnum):
    """DEFINITION= of *AMPLITUDE."""

    TABULAR = "TABULAR"
    SMOOTH_STEP = "SMOOTH STEP"
    PERIODIC = "PERIODIC"
    DECAY = "DECAY"
    USER = "USER"


@dataclass(frozen=True, slots=True)
class Amplitude:
    """One amplitude curve.

    data        TABULAR, SMOOTH STEP: (k, 2) of time and value. PERIODIC: rows (omega, t0), (A0, 0), then (An, Bn).
                DECAY: rows (A0, A), (t0, td)
    total_time  TIME=TOTAL TIME; step time otherwise
    absolute    VALUE=ABSOLUTE: the curve is the magnitude itself
    smoothing   SMOOTH of a table, None without it: fraction of each interval that Abaqus rounds where it needs time
                derivatives of the curve; the value here is that of the table
    """

    name: str
    type: AmplitudeType
    data: FloatArray
    source: Source
    total_time: bool = False
    absolute: bool = False
    smoothing: float | None = None

    def value(self, step_time: float, total_time: float) -> float:
        """Return the factor at a time; constant outside the table, A0 before t0 of PERIODIC and DECAY."""
        time = total_time if self.total_time else step_time
        if self.type is AmplitudeType.PERIODIC:
            return self._periodic(time)
        if self.type is AmplitudeType.DECAY:
            (base, size), (start, constant) = self.data.tolist()
            return float(base + size * np.exp(-(time - start) / constant)) if time >= start else base
        times, values = self.data[:, 0], self.data[:, 1]
        if self.type is AmplitudeType.TABULAR or not times[0] < time < times[-1]:
            return float(np.interp(time, times, values))
        k = int(np.searchsorted(times, time, side="right")) - 1
        xi = (time - times[k]) / (times[k + 1] - times[k])
        # quintic with zero slope and curvature at both ends (Abaqus Analysis User's Guide, Amplitude curves)
        return float(values[k] + (values[k + 1] - values[k]) * xi**3 * (10 - 15 * xi + 6 * xi**2))

    def corners(self, begin: float) -> FloatArray:
        """Return the step times (k,) of the corners of a table, in a step that begins at a total time."""
        return self.data[:, 0] - (begin if self.total_time else 0.0)

    def _periodic(self, time: float) -> float:
        omega, start = self.data[0]
        mean = self.data[1, 0]
        if time < start:
            return float(mean)
        n = np.arange(1, len(self.data) - 1)
        phase = n * omega * (time - start)
        return float(mean + self.data[2:, 0] @ np.cos(phase) + self.data[2:, 1] @ np.sin(phase))


@dataclass(frozen=True, slots=True)
class UserAmplitude(Amplitude):
    """An amplitude that UAMP gives: a table over total time that grows with the analysis.

    data       (n,) properties (PROPERTIES=)
    variables  number of its state variables (VARIABLES=)
    table      total times and values so far; the last are those of the current attempt
    """

    variables: int = 1
    table: list[tuple[float, float]] = field(default_factory=list)

    def value(self, step_time: float, total_time: float) -> float:
        """Return the factor at a time: linear between the ends of increments; 0 before UAMP is called."""
        times, values = np.array(self.table or [(0.0, 0.0)]).T
        return float(np.interp(total_time, times, values))

    def corners(self, begin: float) -> FloatArray:
        """Return the step times (k,) at which increments ended."""
        return np.array([time for time, _ in self.table]) - begin
