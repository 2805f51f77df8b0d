# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*HEAT TRANSFER and *COUPLED TEMPERATURE-DISPLACEMENT.

Elements integrate over time by themselves; the step limits the change of temperature in an increment.
"""

from __future__ import annotations

import math

import numpy as np

from harness.assembly import System
from harness.elements import FIELD_NAMES
from harness.model.model import Model
from harness.model.procedures import HeatTransfer
from harness.model.steps import Step
from harness.procedures.incrementation import Accuracy
from harness.procedures.stabilized import StabilizedStep
from harness.procedures.state import State
from harness.procedures.static import Reached, StaticStep, UserRoutines
from harness.solver.newton import Iterate

CHANGES_TOO_FAST = "THE TEMPERATURE CHANGES BY MORE THAN DELTMX IN THE INCREMENT."

_TEMPERATURE = FIELD_NAMES.index("temperature")


class HeatTransferStep(StaticStep):
    """One step with temperatures."""

    def __init__(
        self,
        system: System,
        model: Model,
        step: Step,
        state: State,
        solver: str,
        user: UserRoutines,
        *,
        fallback: bool = False,
    ) -> None:
        super().__init__(system, model, step, state, solver, user, fallback=fallback)
        assert state.constraints is not None
        assert isinstance(step.procedure, HeatTransfer)
        self._procedure = step.procedure
        free = state.constraints.free
        self._temperatures = free[system.dofs.field[free] == _TEMPERATURE]
        self._rate = math.inf

    def _warming(self, last: Iterate) -> float:
        """Largest change of a temperature that is not prescribed."""
        return float(np.abs(last.increment[self._temperatures]).max(initial=0.0))

    def _accuracy(self, last: Iterate, size: float) -> Accuracy | None:
        if self._procedure.steady or math.isinf(self._procedure.largest_change):
            return None
        return Accuracy(self._warming(last) / self._procedure.largest_change, CHANGES_TOO_FAST)

    def _reach(self, last: Iterate, size: float) -> Reached:
        self._rate = self._warming(last) / size
        return super()._reach(last, size)

    def _finished(self) -> bool:
        return super()._finished() or self._rate < self._procedure.end_change


class StabilizedHeatTransferStep(HeatTransferStep, StabilizedStep):
    """One step with temperatures and viscous forces."""
