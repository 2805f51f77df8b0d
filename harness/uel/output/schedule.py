# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Increments to write, and the one to read.

A file gets every k-th increment of a step, or the first in each part of it, and the last one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from uel.errors import UelError
from uel.model.records import IncrementDone
from uel.model.steps import Step


class Schedule:
    """Schedule of one file, which records what has been written, so that the last increment is not written twice."""

    def __init__(self) -> None:
        self._written = (0, 0)
        # step, and how many of its parts have been written
        self._parts = (0, 0)

    def due(self, frequency: int, record: IncrementDone, *, last: bool) -> bool:
        """Return whether to write an increment now; last: no increment of the step follows."""
        entry = (record.step, record.increment)
        if frequency < 1 or entry == self._written or not (last or record.increment % frequency == 0):
            return False
        self._written = entry
        return True

    def due_field(self, step: Step, record: IncrementDone, *, last: bool) -> bool:
        """Return whether the field output of a step is `due`."""
        parts = step.output.field_intervals
        # the sum of the increments may be a little short of the end of a part
        done = (record.step, math.floor(parts * record.step_time / step.procedure.period + 1e-9))
        reached = done > max(self._parts, (record.step, 0))
        if reached:
            self._parts = done
        if reached or (parts and last):
            return self.due(1, record, last=last)
        return self.due(step.output.field_frequency, record, last=last)


def find_written(path: Path, what: str, entries: Sequence[tuple[int, int]], step: int | None, increment: int) -> int:
    """Return the index of a requested entry of a file.

    Parameters
    ----------
    path
        The file.
    what
        Kind of its entries, such as 'field output'.
    entries
        Step and increment of each entry, in the order in which they were written.
    step
        Number of the step; None: the last one that has the increment.
    increment
        Number of the increment in the step; -1: the last one written.

    Raises
    ------
    UelError
        There is no such entry.
    """
    wanted = [
        index
        for index, entry in enumerate(entries)
        if (step is None or entry[0] == step) and (increment < 1 or entry[1] == increment)
    ]
    if not wanted:
        named = ([] if step is None else [f"step {step}"]) + ([] if increment < 1 else [f"increment {increment}"])
        raise UelError(f"{path}: no {what}" + (f" of {', '.join(named)}" if named else ""))
    return wanted[-1]
