# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*MODAL DYNAMIC, and the base of all steps in which modes of *FREQUENCY respond.

With u = sum of phi_i q_i each mode has an equation of its own, m_i (q'' + 2 xi_i w_i q' + w_i^2 q) = phi_i^T p (Abaqus
Theory Guide, "Modal dynamic analysis"). Supports are those of *FREQUENCY. If they all move along a direction r with the
acceleration a, displacements are relative to them under the load -M r a ("Base motions in modal-based procedures").
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import replace

import numpy as np
from scipy.linalg import expm

from uel.assembly import Constraints
from uel.errors import DeckError
from uel.model.arrays import FloatArray
from uel.model.perturbations import ModalDynamic
from uel.model.records import AttemptStarted, IncrementDone, Noted, Record, Solution, StepDone
from uel.procedures.linear.linear_loads import step_at
from uel.procedures.linear.perturbation import PerturbationStep
from uel.procedures.step_setting import Setting


class ModalStep(PerturbationStep):
    """Step in which modes of an earlier *FREQUENCY respond."""

    def __init__(self, setting: Setting) -> None:
        modes = setting.state.modes
        if modes is None:
            message = f"*{setting.step.procedure.keyword} by modes needs a *FREQUENCY step before it in the same job"
            raise DeckError(setting.step.source, message)
        self._all_modes, self._superposition = modes, setting.step.procedure.superposition
        super().__init__(setting)
        self._numbers = self._superposition.modes(modes.frequencies)
        if not len(self._numbers):
            message = f"none of the {len(modes.values)} modes of *FREQUENCY, step {modes.step}, responds"
            raise DeckError(setting.step.source, message)
        self._modes = modes.chosen(self._numbers)

    def _constrain(self, setting: Setting) -> Constraints:
        """Return the constraints of the modes. Raises DeckError if the step has others."""
        constraints, step = self._all_modes.constraints, setting.step
        prescribed = setting.state.boundaries.in_perturbation(replace(step, new_boundary=True))
        own = constraints.prescribed
        if not (np.array_equal(prescribed, own) if step.new_boundary else np.isin(prescribed, own).all()):
            message = f"*BOUNDARY holds other dofs than the step of the modes, {self._all_modes.step}"
            raise DeckError(step.source, message)
        return constraints

    def run(self) -> Generator[Record, None, None]:
        """Run the step and yield its records. Raises KernelError, DeckError."""
        yield Noted(
            f"{len(self._numbers)} OF {len(self._all_modes.values)} MODES OF STEP {self._all_modes.step} RESPOND"
        )
        yield from self._increments()
        yield StepDone(self._step.number, self._increment, 0, self._increment)


class ModalDynamicStep(ModalStep):
    """Step of increments in which the forces vary linearly, so that the integration is exact.

    Rows of the states are q, q', the force over the generalized mass, and its rate.
    """

    def __init__(self, setting: Setting, procedure: ModalDynamic) -> None:
        super().__init__(setting)
        self._procedure = procedure
        modes, count = self._modes, len(self._numbers)
        self._viscous = self._superposition.viscous(self._numbers, modes.omega)
        # q'' = -w^2 q - 2 xi w q' + f, and f' is constant
        self._rates = np.zeros((count, 4, 4))
        self._rates[:, 0, 1] = self._rates[:, 1, 2] = self._rates[:, 2, 3] = 1.0
        self._rates[:, 1, 0], self._rates[:, 1, 1] = -modes.values, -self._viscous
        self._state_of_modes = np.zeros((count, 4))
        self._state_of_modes[:, 1] = modes.inertia @ self._state.velocity / modes.masses
        self._steps: dict[float, FloatArray] = {}

    def _increments(self) -> Iterator[Record]:
        number, begin, step_time = self._step.number, self._state.total_time, 0.0
        forces = self._forces(0.0)[0]
        for increment, end in enumerate(self._procedure.times, start=1):
            self._increment, size = increment, end - step_time
            yield AttemptStarted(number, increment, 1, step_time, begin + step_time, size)
            self._user.external_database(1, 0, (step_time, begin + step_time), size, number, increment)
            step_time = end
            before, (forces, load) = forces, self._forces(end)
            self._advance(size, self._modes.shapes @ before, self._modes.shapes @ forces)
            solution = self._superposed(forces, load)
            following = self._procedure.times[increment] - end if end < self._procedure.period else 0.0
            yield IncrementDone(number, increment, 1, 1, end, begin + end, size, solution, following)
            self._user.external_database(2, 0, (end, begin + end), size, number, increment)

    def _advance(self, size: float, before: FloatArray, after: FloatArray) -> None:
        """Integrate the modes over an increment with modal forces (modes,) linear from `before` to `after`."""
        if size not in self._steps:
            self._steps[size] = expm(size * self._rates)
        masses = self._modes.masses
        self._state_of_modes[:, 2], self._state_of_modes[:, 3] = before / masses, (after - before) / (size * masses)
        self._state_of_modes = np.einsum("mij,mj->mi", self._steps[size], self._state_of_modes)

    def _forces(self, step_time: float) -> tuple[FloatArray, FloatArray]:
        """Return forces (n,) at a step time: loads with base motions, and loads alone."""
        at = step_time, self._state.total_time + step_time
        ramp = step_time / self._procedure.period if self._step.amplitude == "RAMP" else 1.0
        load = self._loads(step_at(self._step, at, without=ramp))
        moved = [motion.value(*at) * self._modes.rigid[motion.dof - 1] for motion in self._superposition.base]
        return load - sum(moved), load

    def _superposed(self, forces: FloatArray, load: FloatArray) -> Solution:
        """Superpose the modes and return the state of all unknowns."""
        modes, in_global = self._modes, self._system.dofs.in_global
        position, rate, force = self._state_of_modes[:, :3].T
        acceleration = force - modes.values * position - self._viscous * rate
        change, velocity, elastic = position @ modes.shapes, rate @ modes.shapes, position @ modes.stiffness
        strain = 0.5 * float(change @ (self._state.signs * elastic))
        kinetic = 0.5 * float(velocity @ (rate @ modes.inertia))
        internal = elastic + acceleration @ modes.inertia
        return replace(
            self._solution(change, {"ALLSE": strain, "ALLKE": kinetic}),
            velocity=velocity,
            acceleration=acceleration @ modes.shapes,
            reaction=in_global(self._constraints.reactions(forces - internal)),
            load=in_global(load),
            elements=self._elements(change),
        )
