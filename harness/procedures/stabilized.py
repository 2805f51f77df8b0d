# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""STABILIZE: viscous forces c M v on an artificial mass M of unit density, v the increment over its time.

Abaqus Analysis User's Guide, "Automatic stabilization of unstable problems". What the guide leaves open: the first
increment runs without damping, and c is such that it would have dissipated the given fraction of what its internal
energy changed by. Where ALLSD exceeds ALLSDTOL times ALLSE, c is reduced in that ratio. User elements have no
artificial mass.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from harness.assembly import System
from harness.model.model import Model
from harness.model.records import IncrementDone, Noted, Record, Warned
from harness.model.steps import Step
from harness.procedures.state import State
from harness.procedures.static import Reached, StaticStep, UserRoutines
from harness.solver.newton import Increment, Iterate

NOTHING_DAMPED = "STABILIZE HAS NO EFFECT: THE MODEL HAS NO BUILT-IN ELEMENTS WITH A MASS"


class StabilizedStep(StaticStep):
    """One static step with viscous forces."""

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
        assert step.procedure.stabilize is not None
        self._given_damping = step.procedure.stabilize
        self._factor = self._given_damping.factor
        self._mass = system.artificial_mass(self._call(1, 0.0, 0.0, self._start))
        self._force = np.zeros(len(system))
        self._notes: list[str] = []

    def run(self) -> Iterator[Record]:
        """Records of the step, with the damping factor where it is chosen."""
        if not self._mass.any():
            yield Warned(NOTHING_DAMPED)
        elif self._factor:
            yield Noted(f"STABILIZE: THE DAMPING FACTOR IS {self._factor:.4g}")
        for record in super().run():
            yield record
            if isinstance(record, IncrementDone):
                yield from map(Noted, self._notes)
                self._notes = []

    def _given(self, increment: int, size: float) -> Increment:
        given = super()._given(increment, size)
        if not self._factor:
            return given
        return replace(given, damping=self._factor / size * self._mass)

    def _reach(self, last: Iterate, size: float) -> Reached:
        flow = self._system.matrix(self._mass) @ last.increment / size
        force = self._factor * flow
        state = self._state
        # the trapezoidal rule of the external work
        state.stabilization += 0.5 * float((self._force + force) @ last.increment)
        self._force = force
        elastic, change = last.evaluation.energy[1], last.evaluation.energy - state.energy
        if not self._factor:
            self._choose(float(abs(change[1:7].sum())), float(flow @ last.increment))
        elif self._given_damping.limit and state.stabilization > self._given_damping.limit * elastic > 0.0:
            self._change(self._factor * self._given_damping.limit * float(elastic) / state.stabilization)
        return super()._reach(last, size)

    def _choose(self, energy: float, dissipated: float) -> None:
        """Factor from the first increment: its internal energy, and what it would dissipate with a factor of one."""
        if energy > 0.0 and dissipated > 0.0:
            self._change(self._given_damping.fraction * energy / dissipated)

    def _change(self, factor: float) -> None:
        self._factor = factor
        self._notes.append(f"STABILIZE: THE DAMPING FACTOR IS {factor:.4g} FROM THE NEXT INCREMENT ON")
