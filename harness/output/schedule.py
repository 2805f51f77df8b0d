# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""When an increment is written: every k-th of a step, or the first in each part of it, and the last one."""

from __future__ import annotations

import math

from harness.model.records import IncrementDone
from harness.model.steps import Step


class Schedule:
    """Decides for one file; remembers what was written, so that the last increment is not written twice."""

    def __init__(self) -> None:
        self._written = (0, 0)
        # step, and how many of its parts have been written
        self._parts = (0, 0)

    def due(self, frequency: int, record: IncrementDone, *, last: bool) -> bool:
        """True if the increment must be written now; `last`: no increment of the step follows."""
        place = (record.step, record.increment)
        if frequency < 1 or place == self._written or not (last or record.increment % frequency == 0):
            return False
        self._written = place
        return True

    def due_field(self, step: Step, record: IncrementDone, *, last: bool) -> bool:
        """`due` of the field output of a step."""
        parts = step.output.field_intervals
        # the sum of the increments may be a little short of the end of a part
        done = (record.step, math.floor(parts * record.step_time / step.procedure.period + 1e-9))
        reached = done > max(self._parts, (record.step, 0))
        if reached:
            self._parts = done
        if reached or (parts and last):
            return self.due(1, record, last=last)
        return self.due(step.output.field_frequency, record, last=last)
