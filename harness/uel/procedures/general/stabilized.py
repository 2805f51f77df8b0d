# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""STABILIZE: viscous forces c M v on an artificial mass M of unit density, v = du/dt.

Abaqus Analysis User's Guide, "Automatic stabilization of unstable problems". Beyond the guide: the first increment runs
without damping, and c is chosen so that it would have dissipated the given fraction of the change of its internal
energy. If ALLSD exceeds ALLSDTOL times ALLSE, c is reduced in that ratio. User elements have no artificial mass.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uel.model.procedures import Stabilize
from uel.model.records import Noted, Record, Warned
from uel.model.restart import Saved
from uel.procedures.context import StepContext
from uel.procedures.general.step_parts import Part, PartEnd, PartStart
from uel.solver.newton import Increment, Iterate

NOTHING_DAMPED = "STABILIZE HAS NO EFFECT: THE MODEL HAS NO BUILT-IN ELEMENTS WITH A MASS"


class ViscousForces(Part):
    """Viscous forces on the artificial mass."""

    def __init__(self, context: StepContext, damping: Stabilize) -> None:
        self._context = context
        self._damping = damping
        self._factor = damping.factor
        self._mass = context.system.artificial_mass(context.call(0.0, 0.0, context.start))
        self._force = np.zeros(len(context.system))

    def start(self) -> PartStart:
        """Note the damping factor if the deck gives it, or warn if nothing is damped."""
        if not self._context.system.sum(np.array([self._mass.any()], dtype=np.float64))[0]:
            return PartStart([Warned(NOTHING_DAMPED)])
        return PartStart([Noted(f"STABILIZE: THE DAMPING FACTOR IS {self._factor:.4g}")] if self._factor else [])

    def add_to(self, increment: Increment, size: float) -> Increment:
        """Add the viscous matrix."""
        if not self._factor:
            return increment
        return replace(increment, damping=self._factor / size * self._mass)

    def converged(self, last: Iterate, size: float) -> PartEnd:
        """Return the dissipated energy, and a note if the factor changes."""
        state = self._context.state
        unit_force = self._context.system.product(self._mass, last.du) / size
        force = self._factor * unit_force
        # by the trapezoidal rule, as the external work
        dissipated = 0.5 * float((self._force + force) @ last.du)
        total = state.stabilization + dissipated
        self._force = force
        elastic, change = last.evaluation.energy[1], last.evaluation.energy - state.energy
        limit = self._damping.limit
        remarks: list[Record] = []
        if not self._factor:
            remarks = self._choose(float(abs(change[1:7].sum())), float(unit_force @ last.du))
        elif limit and total > limit * elastic > 0.0:
            remarks = [self._change(self._factor * limit * float(elastic) / total)]
        return PartEnd(remarks, stabilization=dissipated)

    def kept(self) -> Saved:
        """Return the factor, and the forces at the end of the increment."""
        return {"factor": self._factor, "force": self._force}

    def resume(self, saved: Saved) -> None:
        """Restore what `kept` returned."""
        self._factor, self._force = saved["factor"], saved["force"]

    def _choose(self, energy: float, dissipated: float) -> list[Record]:
        """Choose the factor after the first increment from its internal energy and the dissipation at factor 1."""
        if energy > 0.0 and dissipated > 0.0:
            return [self._change(self._damping.fraction * energy / dissipated)]
        return []

    def _change(self, factor: float) -> Noted:
        self._factor = factor
        return Noted(f"STABILIZE: THE DAMPING FACTOR IS {factor:.4g} FROM THE NEXT INCREMENT ON")
