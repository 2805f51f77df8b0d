# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*VISCO: elements integrate creep and viscoelasticity; the step limits the error of the integration (CETOL)."""

from __future__ import annotations

import math

from uel.procedures.context import StepContext
from uel.procedures.general.incrementation import Accuracy
from uel.procedures.general.step_parts import Part
from uel.solver.newton import Iterate

CHANGES_TOO_FAST = "THE RATE OF A CREEP OR VISCOUS STRAIN CHANGES BY MORE THAN CETOL OVER THE INCREMENT."


class ViscousStrain(Part):
    """Limit of the change of viscous strain rates in an increment."""

    def __init__(self, context: StepContext, tolerance: float) -> None:
        self._system, self._tolerance = context.system, tolerance

    def accuracy(self, last: Iterate, size: float) -> Accuracy | None:
        """Return the change over CETOL."""
        if math.isinf(self._tolerance):
            return None
        return Accuracy(self._system.viscous_change() / self._tolerance, CHANGES_TOO_FAST)
