# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""State at the end of increments and steps: displacements, forces, external work and other energies of the model.

`harness/uel/model/energies.py` gives the energies their names (ALLSE, ALLWK, ...).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import astuple, dataclass, field
from typing import Final, Self

import numpy as np

from uel.assembly import Constraints, DofMap, System
from uel.elements import FIELD_NAMES, Predefined
from uel.model.arrays import FloatArray
from uel.model.dofs import POTENTIAL
from uel.model.energies import energies_of_model, external_work
from uel.model.model import Model
from uel.model.records import Solution
from uel.model.restart import Saved
from uel.model.steps import Step
from uel.model.user_values import GivesValues
from uel.procedures.general.average_flux import FluxHistory
from uel.procedures.general.step_parts import InitialMotion, PartEnd
from uel.procedures.linear.modes import Modes
from uel.procedures.loads.element_loads import AllLoads, StepLoads
from uel.procedures.loads.nodal import Boundaries, fading_forces, initial_values
from uel.procedures.loads.predefined_fields import Conditions, StepConditions
from uel.procedures.loads.user_amplitudes import StepAmplitudes, UserAmplitudes
from uel.procedures.loads.variation import Variation
from uel.solver.descent import Majoriser
from uel.solver.linear import Effort, StepSolver
from uel.solver.newton import Iterate

ARRAYS: Final = ("displacement", "reaction", "load", "external", "velocity", "acceleration", "unbalanced", "energy")
_NUMBERS = ("total_time", "work", "damage", "stabilization")


@dataclass(slots=True)
class BegunStep:
    """General step that has begun: total time at its start, and `concluded`, its step time if it ended early."""

    number: int
    total_time: float
    concluded: float | None = None


@dataclass(frozen=True, slots=True)
class StepActions:
    """Prescribed values, loads and conditions of a general step, as functions of time.

    released  forces that fade in it
    """

    values: Variation
    loads: StepLoads
    conditions: StepConditions
    amplitudes: StepAmplitudes
    released: Variation


@dataclass(slots=True)
class ConvergedState:
    """State at the end of the last converged increment; only its own methods set its attributes.

    displacement, reaction, load  (n,) U, RF, CF
    velocity, acceleration  (n,) V, A
    external   (n,) external forces on the nodes: load, fading forces, reaction
    unbalanced  (n,) forces that balance initial stresses, until they fade in the first step
    work       external work so far
    energy     (8,) sum of ENERGY
    damage     energy dissipated by damage of built-in elements
    stabilization  energy dissipated by *STATIC, STABILIZE
    flux       flux history by field
    predefined predefined fields, which are constant
    effort     counts and times of all linear solvers
    majoriser  matrix at the start of the analysis, for --fallback
    begun      general steps so far
    modes      modes of the last *FREQUENCY; None without one
    signs      (n,) sign of the work of forces: -1 for electric potentials, whose forces are minus charges
    """

    displacement: FloatArray
    reaction: FloatArray
    load: FloatArray
    external: FloatArray
    boundaries: Boundaries
    loads: AllLoads
    conditions: Conditions
    amplitudes: UserAmplitudes
    velocity: FloatArray
    acceleration: FloatArray
    unbalanced: FloatArray
    constraints: Constraints | None = None
    solver: StepSolver | None = None
    effort: Effort = field(default_factory=Effort)
    majoriser: Majoriser = field(default_factory=Majoriser)
    total_time: float = 0.0
    work: float = 0.0
    energy: FloatArray = field(default_factory=lambda: np.zeros(8))
    damage: float = 0.0
    predefined: Predefined | None = None
    stabilization: float = 0.0
    flux: list[FluxHistory] = field(default_factory=lambda: [FluxHistory() for _ in FIELD_NAMES])
    begun: list[BegunStep] = field(default_factory=list)
    modes: Modes | None = None
    signs: FloatArray = field(kw_only=True)

    @classmethod
    def start(cls, system: System, model: Model) -> Self:
        """Return the state before the first step."""
        zero = np.zeros(len(system))
        boundaries = Boundaries(system.dofs, model.boundaries)
        velocity = initial_values(system.dofs, model.initial_velocities)
        unknown = model.initial_concentrations if model.diffusive else model.initial_temperatures
        start = initial_values(system.dofs, unknown)
        loads = AllLoads(system, model)
        conditions = Conditions(model)
        actions = boundaries, loads, conditions, UserAmplitudes(model)
        charged = [group.nodes for group in model.groups if group.electrical]
        signs = np.ones(len(system))
        for nodes in charged:
            signs[system.dofs.find(nodes.ravel(), POTENTIAL)] = -1.0
        fields = conditions.initial()
        return cls(start, zero, zero, zero, *actions, velocity, zero, zero, predefined=fields, signs=signs)

    def hold(self, forces: FloatArray) -> None:
        """Set the forces (n,) that balance initial stresses until they fade in the first step."""
        self.unbalanced = self.external = forces

    def begin_step(self, step: Step, dofs: DofMap, user: GivesValues) -> StepActions:
        """Begin a general step with its prescribed values and loads. Raises DeckError."""
        self.begun.append(BegunStep(step.number, self.total_time))
        values = self.boundaries.start_step(step, self.displacement, self.total_time)
        loads = self.loads.start_step(step, self.total_time, user)
        conditions = self.conditions.start_step(step, self.total_time)
        amplitudes = self.amplitudes.start_step(step, dofs, self, user)
        released = fading_forces(self.reaction, self.boundaries.unknowns, step, self.unbalanced)
        self.unbalanced = np.zeros_like(self.unbalanced)
        return StepActions(values, loads, conditions, amplitudes, released)

    def use(self, constraints: Constraints, solver: StepSolver) -> None:
        """Set constraints and linear solver of the step that begins; the next step may reuse them."""
        self.constraints, self.solver = constraints, solver

    def set_in_motion(self, begun: InitialMotion) -> None:
        """Set the motion at the start of a dynamic step."""
        self.velocity, self.acceleration, self.displacement = begun.velocity, begun.acceleration, begun.displacement
        self.external, self.energy = begun.external, begun.energy

    def come_to_rest(self) -> None:
        """Set velocities and accelerations to zero, for a step without inertia."""
        self.velocity = self.acceleration = np.zeros_like(self.displacement)

    def kept(self) -> Saved:
        """Return arrays and numbers for *RESTART; prescribed values and loads follow from the steps so far."""
        saved = {name: getattr(self, name) for name in (*ARRAYS, *_NUMBERS)}
        return {
            **saved,
            "flux": [list(astuple(history)) for history in self.flux],
            "begun": [list(astuple(step)) for step in self.begun],
            "conditions": self.conditions.kept(),
        }

    def resume(self, saved: Saved) -> None:
        """Restore what `kept` returned. Raises ValueError if it belongs to another model."""
        for name in ARRAYS:
            if np.shape(saved[name]) != np.shape(getattr(self, name)):
                raise ValueError("degrees of freedom")
        for name in (*ARRAYS, *_NUMBERS):
            setattr(self, name, saved[name])
        self.flux = [FluxHistory(*history) for history in saved["flux"]]
        self.begun = [BegunStep(*step) for step in saved["begun"]]
        self.conditions.resume(saved["conditions"])

    def return_to(self, beginning: Mapping[str, FloatArray], total_time: float) -> None:
        """Set arrays and total time to the start of a resumed step. Raises ValueError as `resume` does."""
        for name, values in beginning.items():
            if len(values) != len(self.displacement):
                raise ValueError("degrees of freedom")
            setattr(self, name, values)
        self.total_time = total_time

    def repeat(self, step: Step, begun: BegunStep, user: GivesValues) -> None:
        """Process prescribed values and loads of a step that is over. Raises DeckError."""
        # displacements at the start matter only in the step itself
        self.boundaries.start_step(step, self.displacement, begun.total_time)
        self.loads.start_step(step, begun.total_time, user)
        self.conditions.start_step(step, begun.total_time)
        if begun.concluded is not None:
            self._conclude(begun.concluded)

    def end_step(self, flux: list[FluxHistory], concluded: float | None) -> None:
        """End a step with its flux histories; concluded: its step time if it ends before its period."""
        if concluded is not None:
            self._conclude(concluded)
        self.flux = flux

    def _conclude(self, step_time: float) -> None:
        """End the step before its period."""
        for actions in (self.boundaries, self.loads, self.conditions):
            actions.conclude(step_time)
        if self.begun:
            self.begun[-1].concluded = step_time

    def accept(self, converged: Iterate, load: FloatArray, released: FloatArray, ends: Iterable[PartEnd]) -> None:
        """Take over a converged increment.

        Parameters
        ----------
        converged
            State after the last iteration.
        load, released
            (n,) loads and fading forces at its end.
        ends
            Results of the parts of the step for this increment.
        """
        assert self.constraints is not None
        reaction = self.constraints.reactions(converged.r)
        external = load + released + reaction
        energy = converged.evaluation.energy
        self.work += external_work(self.external, external, self.signs * converged.du, energy)
        self.displacement = self.displacement + converged.du
        self.reaction, self.load, self.external, self.energy = reaction, load, external, energy
        self.damage = converged.evaluation.damage
        for end in ends:
            self.stabilization += end.stabilization
            if end.motion is not None:
                self.velocity, self.acceleration = end.motion.velocity, end.motion.acceleration

    def reach(self, total_time: float, predefined: Predefined | None) -> None:
        """Set total time and predefined fields at the end of an increment."""
        self.total_time, self.predefined = total_time, predefined

    def keep_modes(self, modes: Modes) -> None:
        """Store the modes of a *FREQUENCY step for later steps."""
        self.modes = modes

    def solution(self, system: System) -> Solution:
        """Return a copy of the state for output, whose committed element states are copied when they are read."""
        return Solution(
            node=system.dofs.node,
            dof=system.dofs.dof,
            displacement=self.displacement,
            reaction=system.dofs.in_global(self.reaction),
            load=system.dofs.in_global(self.load),
            velocity=self.velocity,
            acceleration=self.acceleration,
            energies=energies_of_model(self.energy, self.damage, self.stabilization, self.work),
            elements=system.states(),
            contact=system.contact_fields(),
        )
