# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Model of a deck, flattened and resolved: no names are left to look up."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from uel.errors import Source
from uel.model.arrays import IntArray
from uel.model.contact import ContactPair, SlidingPair
from uel.model.couplings import Distributing
from uel.model.mesh import ElementGroup, Mesh
from uel.model.steps import Boundary, InitialSolution, InitialStress, InitialValue, Step


@dataclass(frozen=True, slots=True)
class PhysicalConstants:
    """*PHYSICAL CONSTANTS.

    absolute_zero     on the scale of the temperatures
    stefan_boltzmann  constant of radiation, 0 if the deck does not set it
    """

    absolute_zero: float = 0.0
    stefan_boltzmann: float = 0.0


@dataclass(frozen=True, slots=True)
class Equation:
    """*EQUATION: sum of coefficient x u(node, dof) = 0; the first term is eliminated unless it is prescribed."""

    terms: tuple[tuple[int, int, float], ...]
    source: Source


@dataclass(frozen=True, slots=True)
class Arm:
    """A node (index) that follows a reference node as a rigid body; equations say it to first order."""

    node: int
    reference: int
    source: Source


@dataclass(frozen=True, slots=True)
class Model:
    """A whole deck.

    nsets      node indices of each set; a set of an instance is also there as INSTANCE.NAME
    elsets     element positions of each set (position in the groups walked in order)
    boundaries *BOUNDARY before the first step
    arms       equations that have finite rotations with NLGEOM
    couplings  distributing ones that are no equations, as a step has NLGEOM
    initial_velocities    *INITIAL CONDITIONS, TYPE=VELOCITY
    initial_temperatures  TYPE=TEMPERATURE, for unknowns that are temperatures, and as a predefined field
    initial_concentrations  TYPE=CONCENTRATION
    initial_fields        TYPE=FIELD and TYPE=PRESSURE STRESS; their dof is the number of the field
    initial_solutions     TYPE=SOLUTION
    initial_stresses      TYPE=STRESS
    constants  *PHYSICAL CONSTANTS
    parameters  values of parameters that replace those in the deck: listed in .dat
    ignored    keywords that cannot change the solution, with file and line: listed once in .dat
    warnings   file:line and reason where the deck is odd but understood
    differences  what Abaqus would do differently with the deck; warnings without an effect on this run
    """

    deck: Path
    heading: str
    mesh: Mesh
    groups: tuple[ElementGroup, ...]
    steps: tuple[Step, ...]
    nsets: dict[str, IntArray] = field(default_factory=dict)
    elsets: dict[str, IntArray] = field(default_factory=dict)
    boundaries: tuple[Boundary, ...] = ()
    equations: tuple[Equation, ...] = ()
    contacts: tuple[ContactPair | SlidingPair, ...] = ()
    arms: tuple[Arm, ...] = ()
    couplings: tuple[Distributing, ...] = ()
    initial_velocities: tuple[InitialValue, ...] = ()
    initial_temperatures: tuple[InitialValue, ...] = ()
    initial_concentrations: tuple[InitialValue, ...] = ()
    initial_fields: tuple[InitialValue, ...] = ()
    initial_solutions: tuple[InitialSolution, ...] = ()
    initial_stresses: tuple[InitialStress, ...] = ()
    constants: PhysicalConstants = PhysicalConstants()
    parameters: dict[str, float] = field(default_factory=dict)
    ignored: tuple[tuple[str, Source], ...] = ()
    warnings: tuple[str, ...] = ()
    differences: tuple[str, ...] = ()

    @property
    def diffusive(self) -> bool:
        """Whether its steps are *MASS DIFFUSION, so that nodes have concentrations."""
        return any(step.procedure.concentrations for step in self.steps)


def constraints_with_multipliers(model: Model) -> list[tuple[str, Source]]:
    """Return the keywords, with file and line, that Lagrange multipliers or stiffnesses between nodes enforce."""
    contacts = [(f"*{pair.keyword}", pair.source) for pair in model.contacts]
    return contacts + [("*DISTRIBUTING with NLGEOM", coupling.source) for coupling in model.couplings]
