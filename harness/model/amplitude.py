# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*AMPLITUDE: the factor of a load or prescribed value as a function of time."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from harness.errors import Source
from harness.model.arrays import FloatArray


class AmplitudeType(StrEnum):
    """DEFINITION= of *AMPLITUDE."""

    TABULAR = "TABULAR"
    SMOOTH_STEP = "SMOOTH STEP"
    PERIODIC = "PERIODIC"
    DECAY = "DECAY"


@dataclass(frozen=True, slots=True)
class Amplitude:
    """One amplitude curve.

    data        TABULAR, SMOOTH STEP: (k, 2) of time and value. PERIODIC: rows (omega, t0), (A0, 0), then (An, Bn).
                DECAY: rows (A0, A), (t0, td)
    total_time  TIME=TOTAL TIME; step time otherwise
    absolute    VALUE=ABSOLUTE: the curve is the magnitude itself
    """

    name: str
    type: AmplitudeType
    data: FloatArray
    source: Source
    total_time: bool = False
    absolute: bool = False

    def value(self, step_time: float, total_time: float) -> float:
        """Factor at a time; constant outside the table, A0 before t0 of PERIODIC and DECAY."""
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

    def _periodic(self, time: float) -> float:
        omega, start = self.data[0]
        mean = self.data[1, 0]
        if time < start:
            return float(mean)
        n = np.arange(1, len(self.data) - 1)
        phase = n * omega * (time - start)
        return float(mean + self.data[2:, 0] @ np.cos(phase) + self.data[2:, 1] @ np.sin(phase))
