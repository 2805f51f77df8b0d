# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Amplitudes by UAMP (User Subroutines Guide, UAMP).

UAMP is called at the start of each step, with a time increment of zero, and before each attempt, for its end; its state
variables are kept if the attempt converges. Sensors have their values at the end of the last increment.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from uel.assembly import DofMap
from uel.errors import DeckError
from uel.model.amplitude import UserAmplitude
from uel.model.arrays import FloatArray
from uel.model.model import Model
from uel.model.nodal_variables import COMPONENTS
from uel.model.steps import Step
from uel.model.user_values import AskedAmplitude, GivesValues


class NodalState(Protocol):
    """Nodal values at the end of the last increment, as `ConvergedState` has them, and the total time."""

    displacement: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    reaction: FloatArray
    load: FloatArray
    total_time: float


@dataclass(slots=True)
class _UserCurve:
    """Amplitude by UAMP through the steps.

    kept   number of rows of its table from converged increments
    state  state variables at the end of the last increment
    trial  state variables of the current attempt
    """

    amplitude: UserAmplitude
    state: FloatArray
    trial: FloatArray
    kept: int = 0


class UserAmplitudes:
    """User amplitudes of all steps."""

    def __init__(self, model: Model) -> None:
        named = {a.name: a for step in model.steps for a in step.amplitudes if isinstance(a, UserAmplitude)}
        self._curves = {name: _UserCurve(a, np.zeros(a.variables), np.zeros(a.variables)) for name, a in named.items()}
        for amplitude in named.values():
            amplitude.table.clear()
        self._active: set[str] = set()

    @property
    def exist(self) -> bool:
        """True if UAMP defines any amplitude of the model."""
        return bool(self._curves)

    def start_step(self, step: Step, dofs: DofMap, nodal: NodalState, user: GivesValues) -> StepAmplitudes:
        """Begin a step with the amplitudes that it names, and those of earlier steps that continue in total time.

        Raises DeckError without UAMP, and for a sensor of a dof that no element uses.
        """
        continuing = {name for name in self._active if self._curves[name].amplitude.total_time}
        self._active = continuing | {a.name for a in step.amplitudes if isinstance(a, UserAmplitude)}
        curves = [self._curves[name] for name in sorted(self._active)]
        if curves and user.uamp is None:
            source = curves[0].amplitude.source
            raise DeckError(source, "*AMPLITUDE, DEFINITION=USER needs UAMP, which the job does not have")
        sensors = {}
        for request in step.output.history_nodes if curves else ():
            if request.sensor:
                quantity, dof = COMPONENTS[request.variables[0]]
                sensors[request.sensor] = quantity, int(dofs.find(request.nodes, dof)[0])
                if sensors[request.sensor][1] < 0:
                    name = dofs.mesh.name(int(request.nodes[0]))
                    message = f"sensor {request.sensor}: no element uses dof {dof} of node {name}"
                    raise DeckError(step.source, message)
        started = StepAmplitudes(step.number, curves, sensors, nodal, user)
        started.attempt(0, (0.0, nodal.total_time), 0.0, 0)
        started.converged()
        started.concluded = False
        return started


@dataclass(slots=True)
class StepAmplitudes:
    """User amplitudes of one step.

    sensors    name of the array of `nodal`, and unknown, of each sensor
    concluded  True if UAMP ends the step with the current increment
    """

    step: int
    curves: list[_UserCurve]
    sensors: dict[str, tuple[str, int]]
    nodal: NodalState
    user: GivesValues
    concluded: bool = False

    def attempt(self, increment: int, end: tuple[float, float], size: float, cutbacks: int) -> None:
        """Call UAMP for the values at the end of an increment, a step and a total time. Raises UelError."""
        self.concluded = False
        sensors = {name: float(getattr(self.nodal, array)[k]) for name, (array, k) in self.sensors.items()}
        for curve in self.curves:
            amplitude = curve.amplitude
            del amplitude.table[curve.kept :]
            answer = self.user.user_amplitude(
                AskedAmplitude(
                    name=amplitude.name,
                    old=amplitude.table[-1][1] if amplitude.table else 0.0,
                    step=self.step,
                    increment=increment,
                    time=end,
                    size=size,
                    cutbacks=cutbacks,
                    properties=amplitude.data,
                    state=curve.state,
                    sensors=sensors,
                )
            )
            amplitude.table.append((end[1], answer.value))
            curve.trial = answer.state
            self.concluded = self.concluded or answer.concludes

    def converged(self) -> None:
        """Keep the values of the last attempt."""
        for curve in self.curves:
            curve.state, curve.kept = curve.trial, len(curve.amplitude.table)
