# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""When an increment is written: every k-th of a step, and the last one."""

from __future__ import annotations

from harness.model.records import IncrementDone


class Schedule:
    """Decides for one file; remembers what was written so that the last increment is not written twice."""

    def __init__(self) -> None:
        self._written = (0, 0)

    def due(self, frequency: int, record: IncrementDone, *, last: bool) -> bool:
        """True if the increment is to be written now; `last`: no increment of the step follows."""
        place = (record.step, record.increment)
        if frequency < 1 or place == self._written or not (last or record.increment % frequency == 0):
            return False
        self._written = place
        return True
