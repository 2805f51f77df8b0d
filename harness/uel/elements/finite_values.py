# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks for NaN and infinity in PNEWDT, SVARS and ENERGY of user elements."""

from __future__ import annotations

import math

import numpy as np

from uel.elements.call import Call
from uel.model.arrays import FloatArray
from uel.model.mesh import ElementGroup
from uel.usersub import Library


class Watch:
    """Monitor of a block of user elements. It warns once of a value that is not finite; the run goes on."""

    def __init__(self, group: ElementGroup, library: Library) -> None:
        self._group = group
        self._library = library
        self._done = group.definition is None

    def pnewdt(self, call: Call, value: float) -> None:
        """Check PNEWDT of a pass."""
        if not (self._done or math.isfinite(value)):
            alone = len(self._group.labels) == 1
            place = f"step {call.step}, increment {call.increment}, iteration {call.iteration}"
            self._warn(int(self._group.labels[0]) if alone else None, f"PNEWDT is NaN or infinite ({place})")

    def state(self, call: Call | None, svars: FloatArray, energy: FloatArray) -> None:
        """Check SVARS and ENERGY (elements, entries) at the end of an increment."""
        for name, values in (("SVARS", svars), ("ENERGY", energy)):
            if self._done or call is None or np.isfinite(values).all():
                continue
            row, column = np.argwhere(~np.isfinite(values))[0].tolist()
            place = f"the end of step {call.step}, increment {call.increment}"
            self._warn(int(self._group.labels[row]), f"{name}({column + 1}) is NaN or infinite at {place}")

    def _warn(self, element: int | None, text: str) -> None:
        self._done = True
        name = "an element" if element is None else f"element {element}"
        self._library.warn(f"{name} (type {self._group.type}): {text}; the run goes on")
