# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""User output variables (UVAR) of the points of a block, set by UVARM at the end of an increment."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uel.elements.array_mistakes import at_point
from uel.elements.call import Call
from uel.elements.routine import OutputVariables, Routine
from uel.errors import KernelError
from uel.model.arrays import FloatArray, IntArray
from uel.model.mesh import ElementGroup
from uel.usersub import Library, _points
from uel.usersub.exchange import BlockArrays


class UserVariables:
    """UVAR of the points of a block.

    values  (m, points, variables)
    """

    def __init__(self, uvarm: OutputVariables, routine: Routine, library: Library, count: int) -> None:
        """Set all to zero; count: number m of elements."""
        self.values = np.zeros((count, uvarm.points, uvarm.count))
        self._uvarm, self._routine, self._library = uvarm, routine, library
        self._coordinates = np.zeros(0)

    def keep(self, rows: IntArray) -> None:
        """Keep only these elements (rows from 0)."""
        self.values = self.values[rows]

    def move(self, call: Call, u: FloatArray, arrays: BlockArrays, unknowns: tuple[tuple[int, int], ...]) -> None:
        """Set the coordinates of the nodes for UVARM: displaced by u (n,) with NLGEOM; unknowns: of an element."""
        self._coordinates = arrays.coords
        if not call.flags.nlgeom:
            return
        # the driver counts from 1
        now, moved = arrays.coords.copy(), u[arrays.equations - 1]
        for k, (local, dof) in enumerate(unknowns):
            if local < now.shape[1] and dof <= now.shape[2]:
                now[:, local, dof - 1] += moved[:, k]
        self._coordinates = now

    def call(self, call: Call, group: ElementGroup, arrays: BlockArrays) -> None:
        """Call UVARM at all points, after a pass with this call. Raises KernelError if it ends the analysis."""
        uvarm, routine = self._uvarm, self._routine
        axes = uvarm.axes[None, None]
        if routine.axes is not None:
            # the current directions of the points, in rows
            axes = routine.axes.view(arrays.svars)[:, :, 1].swapaxes(-1, -2)
        element, point = _points.uvarm(
            uvarm.address,
            uvarm.names,
            axes,
            (routine.tensor, routine.statev, routine.family, int(uvarm.plastic)),
            (call.step, call.increment),
            (call.step_time - call.time_increment, call.total_time - call.time_increment, call.time_increment),
            replace(arrays, coords=self._coordinates),
            routine.hidden,
            self.values,
            local=routine.axes is not None,
        )
        if element:
            why = f"{at_point('UVARM', point)}{self._library.stop_reason()}"
            raise KernelError(element, group.type, f"{why} (step {call.step}, increment {call.increment})")
