# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*HEAT TRANSFER, *COUPLED TEMPERATURE-DISPLACEMENT and *MASS DIFFUSION.

Elements integrate over time; the step limits the change of temperatures or concentrations in an increment.
"""

from __future__ import annotations

import math

import numpy as np

from uel.elements import FIELD_NAMES
from uel.model.procedures import Diffusive
from uel.model.restart import Saved
from uel.procedures.context import StepContext
from uel.procedures.general.incrementation import Accuracy
from uel.procedures.general.step_parts import Part, PartEnd
from uel.solver.newton import Iterate


class LimitedChange(Part):
    """Limits of the change of temperatures or concentrations: in an increment, and at the end of the step."""

    def __init__(self, context: StepContext, procedure: Diffusive) -> None:
        self._procedure = procedure
        free = context.constraints.free
        self._limited = free[context.system.dofs.field[free] == FIELD_NAMES.index(procedure.unknown)]
        self._rate = math.inf

    def _change(self, last: Iterate) -> float:
        """Return the largest change of a value that is not prescribed."""
        return float(np.abs(last.du[self._limited]).max(initial=0.0))

    def accuracy(self, last: Iterate, size: float) -> Accuracy | None:
        """Return the change over the largest one allowed."""
        if self._procedure.steady or math.isinf(self._procedure.largest_change):
            return None
        return Accuracy(self._change(last) / self._procedure.largest_change, self._procedure.complaint)

    def converged(self, last: Iterate, size: float) -> PartEnd:
        """Update the rate that END=SS tests."""
        self._rate = self._change(last) / size
        return PartEnd()

    def kept(self) -> Saved:
        """Return the rate."""
        return {"rate": self._rate}

    def resume(self, saved: Saved) -> None:
        """Restore what `kept` returned."""
        self._rate = saved["rate"]

    @property
    def finished(self) -> bool:
        """True if the state is steady, with END=SS."""
        return self._rate < self._procedure.end_change
