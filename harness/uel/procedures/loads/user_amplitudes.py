# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Amplitudes that UAMP gives (User Subroutines Guide, UAMP).

It is called at the start of each step, with a time increment of zero, and before each attempt at an increment, for its
end; its state variables are kept if the attempt converges. Sensors have their values at the end of the last
increment.
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
class _Course:
    """An amplitude through the steps.

    kept         number of rows of its table from converged increments
    state, trial state variables at the end of the last increment, and of this attempt
    """

    amplitude: UserAmplitude
    state: FloatArray
    trial: FloatArray
    kept: int = 0


class UserAmplitudes:
    """User amplitudes of all steps."""

    def __init__(self, model: Model) -> None:
        named = {a.name: a for step in model.steps for a in step.amplitudes if isinstance(a, UserAmplitude)}
        self._courses = {name: _Course(a, np.zeros(a.variables), np.zeros(a.variables)) for name, a in named.items()}
        for amplitude in named.values():
            amplitude.table.clear()
        self._active: set[str] = set()

    @property
    def exist(self) -> bool:
        """True if UAMP gives any amplitude of the model."""
        return bool(self._courses)

    def start_step(self, step: Step, dofs: DofMap, nodal: NodalState, user: GivesValues) -> StepAmplitudes:
        """Take over a step's amplitudes: those it names, and those of earlier steps that continue in total time.

        Raises DeckError without UAMP, and for a sensor of a dof that no element uses.
        """
        going_on = {name for name in self._active if self._courses[name].amplitude.total_time}
        self._active = going_on | {a.name for a in step.amplitudes if isinstance(a, UserAmplitude)}
        courses = [self._courses[name] for name in sorted(self._active)]
        if courses and user.uamp is None:
            source = courses[0].amplitude.source
            raise DeckError(source, "*AMPLITUDE, DEFINITION=USER needs UAMP, which the job does not have")
        sensors = {}
        for request in step.output.history_nodes if courses else ():
            if request.sensor:
                quantity, dof = COMPONENTS[request.variables[0]]
                sensors[request.sensor] = quantity, int(dofs.find(request.nodes, dof)[0])
                if sensors[request.sensor][1] < 0:
                    name = dofs.mesh.name(int(request.nodes[0]))
                    message = f"sensor {request.sensor}: no element uses dof {dof} of node {name}"
                    raise DeckError(step.source, message)
        started = StepAmplitudes(step.number, courses, sensors, nodal, user)
        started.attempt(0, (0.0, nodal.total_time), 0.0, 0)
        started.converged()
        started.concluded = False
        return started


@dataclass(slots=True)
class StepAmplitudes:
    """User amplitudes of one step.

    sensors    array of `nodal` and unknown of each
    concluded  True if UAMP ends the step with the current increment
    """

    step: int
    courses: list[_Course]
    sensors: dict[str, tuple[str, int]]
    nodal: NodalState
    user: GivesValues
    concluded: bool = False

    def attempt(self, increment: int, end: tuple[float, float], size: float, cutbacks: int) -> None:
        """Ask for the values at the end of an increment, a step and a total time. Raises UelError from UAMP."""
        self.concluded = False
        sensors = {name: float(getattr(self.nodal, array)[k]) for name, (array, k) in self.sensors.items()}
        for course in self.courses:
            amplitude = course.amplitude
            del amplitude.table[course.kept :]
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
                    state=course.state,
                    sensors=sensors,
                )
            )
            amplitude.table.append((end[1], answer.value))
            course.trial = answer.state
            self.concluded = self.concluded or answer.concludes

    def converged(self) -> None:
        """Keep the values of the last attempt."""
        for course in self.courses:
            course.state, course.kept = course.trial, len(course.amplitude.table)
