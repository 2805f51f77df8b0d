# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*HEAT TRANSFER and *COUPLED TEMPERATURE-DISPLACEMENT.

Elements integrate over time themselves; the step limits the change of temperature in an increment.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from harness.elements import FIELD_NAMES
from harness.model.procedures import HeatTransfer
from harness.model.records import Record
from harness.model.restart import Saved
from harness.procedures.context import StepContext
from harness.procedures.incrementation import Accuracy
from harness.procedures.step_parts import Part
from harness.solver.newton import Iterate

CHANGES_TOO_FAST = "THE TEMPERATURE CHANGES BY MORE THAN DELTMX IN THE INCREMENT."

_TEMPERATURE = FIELD_NAMES.index("temperature")


class TemperatureChange(Part):
    """Limits of the change of temperature: in an increment, and at the end of the step."""

    def __init__(self, context: StepContext, procedure: HeatTransfer) -> None:
        self._procedure = procedure
        free = context.constraints.free
        self._temperatures = free[context.system.dofs.field[free] == _TEMPERATURE]
        self._rate = math.inf

    def _warming(self, last: Iterate) -> float:
        """Largest change of a temperature that is not prescribed."""
        return float(np.abs(last.increment[self._temperatures]).max(initial=0.0))

    def accuracy(self, last: Iterate, size: float) -> Accuracy | None:
        """The change over DELTMX."""
        if self._procedure.steady or math.isinf(self._procedure.largest_change):
            return None
        return Accuracy(self._warming(last) / self._procedure.largest_change, CHANGES_TOO_FAST)

    def converged(self, last: Iterate, size: float) -> Iterable[Record]:
        """The rate that END=SS looks at."""
        self._rate = self._warming(last) / size
        return ()

    def kept(self) -> Saved:
        """The rate."""
        return {"rate": self._rate}

    def resume(self, saved: Saved) -> None:
        """Go on from what `kept` returned."""
        self._rate = saved["rate"]

    @property
    def finished(self) -> bool:
        """With END=SS: whether the temperatures are steady."""
        return self._rate < self._procedure.end_change
