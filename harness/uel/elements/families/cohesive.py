# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in cohesive elements: properties, point variables and checks (fortran/host/elements/cohesive/cohesive.f90)."""

from __future__ import annotations

from typing import Final

from uel.elements.block import ElementBlock
from uel.elements.building import Building, nodal_block
from uel.elements.routine import Routine
from uel.errors import DeckError
from uel.model.arrays import FloatArray, IntArray
from uel.model.damage import Damage, DamageEvolution
from uel.model.element_types import COHESIVE, CohesiveType
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.properties import CohesiveSection
from uel.model.records import PointVariables
from uel.usersub import _binding, built_in

# in the order of the cases of fortran/host/materials/traction_separation.f90
_CRITERIA: Final = {"MAXS": 1, "QUADS": 2, "MAXE": 3, "QUADE": 4, "MAXU": 3, "QUADU": 4}
_EVOLUTIONS: Final = ("", "DISPLACEMENT", "ENERGY")
_SOFTENINGS: Final = ("", "LINEAR", "EXPONENTIAL", "TABULAR")
_MIXED_MODES: Final = ("", "BK", "POWER LAW")

Triple = tuple[float, float, float]


def cohesive_routine(model: Model, group: ElementGroup, section: CohesiveSection) -> Routine:
    """Build the routine of a group of cohesive elements. Raises DeckError."""
    kind = COHESIVE[group.type]
    dynamic = next((step for step in model.steps if step.procedure.inertia), None)
    hidden = 2 * kind.dimension * kind.nodes if dynamic is not None else 0
    reals, integers = cohesive_properties(section, kind)
    return Routine(
        address=_binding.address_of("cohesive"),
        jtype=kind.nodes,
        mcrd=kind.dimension,
        svars=kind.face.nodes * len(cohesive_variables(section, kind).names) + hidden,
        hidden=hidden,
        massive=bool(section.material.density),
        props=reals,
        jprops=integers,
        damages=True,
    )


def cohesive_variables(section: CohesiveSection, kind: CohesiveType) -> PointVariables:
    """Describe SVARS of a point: named as in the project's interface elements if they have a name,
    else as in Abaqus.
    """
    dimension = kind.dimension
    places = ("X", "Y", "Z")[:dimension]
    directions = ("N", "T") if dimension == 2 else ("N", "S", "T")
    tensor = ("22", "12") if dimension == 2 else ("33", "13", "23")
    damage = section.material.damage
    criterion = f"{damage.criterion if damage else 'DMI'}CRT"
    names = (
        *places,
        *(f"SEP{direction}" for direction in directions),
        *(f"T{direction}" for direction in directions),
        *("DAMAGE", *("DISSI", "DISSII", "DISSIII")[:dimension], "DISSV", "DMAX"),
        *(f"E{component}" for component in tensor),
        *(criterion, "STATUS"),
    )
    aliases = tuple((f"S{component}", f"T{direction}") for component, direction in zip(tensor, directions, strict=True))
    aliases += (("SDEG", "DAMAGE"),) + ((("DMICRT", criterion),) if damage else ())
    return PointVariables("interface", names, kind.face.nodes, bottom=kind.bottom, top=kind.top, aliases=aliases)


def cohesive_properties(section: CohesiveSection, kind: CohesiveType) -> tuple[FloatArray, IntArray]:
    """Return PROPS and JPROPS. Raises DeckError."""
    material, controls, dimension = section.material, section.controls, kind.dimension
    elastic, damage = material.elastic, material.damage
    assert elastic is not None
    moduli = directions(elastic.constants, dimension)
    if min(moduli) <= 0:
        message = f"*ELASTIC, TYPE=TRACTION: moduli must be positive, found {min(moduli):g}"
        raise DeckError(elastic.source, message)
    # the width has a meaning only in the plane
    width = section.width if dimension == 2 else 1.0
    viscosity = (damage.viscosity if damage else 0.0) if controls.viscosity is None else controls.viscosity
    reals, codes = law_properties(moduli, damage, dimension, section.thickness, (viscosity, controls.degradation))
    return (
        built_in.reals("cohesive", thickness=section.thickness, width=width, density=material.density, law=reals),
        built_in.integers("cohesive", family=kind.face.number, deletion=controls.deletion, law=codes),
    )


def law_properties(
    moduli: Triple, damage: Damage | None, dimension: int, thickness: float, limits: tuple[float, float]
) -> tuple[FloatArray, IntArray]:
    """Return PROPS and JPROPS of a traction-separation law (traction_separation in fortran/built_in.toml).

    The integers are the cases of fortran/host/materials/traction_separation.f90.

    Parameters
    ----------
    moduli
        Enn, Ess, Ett.
    damage
        Of the law, if any.
    dimension
        Directions that there are.
    thickness
        Separation over strain; 0: not known.
    limits
        Viscosity, largest damage.

    Raises
    ------
    DeckError
        Values are not positive, or a fracture energy is too small.
    """
    onset, values, power = (1.0,) * 3, (1.0,) * 3, 1.0
    criterion = evolution_type = softening = mixed_mode = 0
    table: tuple[float, ...] = ()
    if damage is not None:
        onset = directions(damage.onset, dimension)
        if min(onset) <= 0:
            raise DeckError(damage.source, f"*DAMAGE INITIATION: onset values must be positive, found {min(onset):g}")
        criterion = _CRITERIA[damage.criterion]
        evolution = damage.evolution
        if evolution is not None:
            values, power = _evolution_values(evolution, dimension), evolution.power
            evolution_type = _EVOLUTIONS.index(evolution.type)
            softening = _SOFTENINGS.index(evolution.softening)
            mixed_mode = _MIXED_MODES.index(evolution.mixed_mode)
            if evolution.softening == "TABULAR":
                table = evolution.values
            if evolution.type == "ENERGY" and thickness > 0:
                _check_toughness(damage, evolution, moduli, onset, values, thickness, dimension)
    viscosity, max_degradation = limits
    return (
        built_in.reals(
            "traction_separation",
            modulus=moduli,
            onset=onset,
            evolution=values,
            power=power,
            viscosity=viscosity,
            max_degradation=max_degradation,
            table=table,
        ),
        built_in.integers(
            "traction_separation",
            criterion=criterion,
            evolution=evolution_type,
            softening=softening,
            mixed_mode=mixed_mode,
        ),
    )


def directions(values: tuple[float, ...], dimension: int) -> Triple:
    """Return values of the normal and both shear directions; in the plane the third is unused and may be left out."""
    normal, first, second = (*values, 0.0, 0.0)[:3]
    return normal, first, first if dimension == 2 else second


def _evolution_values(evolution: DamageEvolution, dimension: int) -> Triple:
    if not evolution.mixed_mode:
        first, second = (*evolution.values, 0.0)[:2]
        return first, second, 0.0
    values = directions(evolution.values, dimension)
    if evolution.mixed_mode == "BK":
        # one fracture energy for both shear directions
        values = values[0], values[1], values[1]
    if min(values) <= 0:
        message = f"*DAMAGE EVOLUTION: fracture energies must be positive, found {min(values):g}"
        raise DeckError(evolution.source, message)
    return values


def _check_toughness(
    damage: Damage,
    evolution: DamageEvolution,
    moduli: Triple,
    onset: Triple,
    values: Triple,
    thickness: float,
    dimension: int,
) -> None:
    """Raise DeckError unless in each pure mode the fracture energy exceeds the
    elastic energy at the onset of damage.
    """
    names = ("normal", "first shear", "second shear")
    for k in range(dimension):
        strength = onset[k] * (moduli[k] if damage.criterion not in ("MAXS", "QUADS") else 1.0)
        stored = 0.5 * strength**2 * thickness / moduli[k]
        energy = values[k] if evolution.mixed_mode else values[0]
        if energy <= stored:
            message = (
                f"*DAMAGE EVOLUTION: the fracture energy {energy:g} of the {names[k]} mode must exceed the elastic "
                f"energy at the onset of damage, {stored:g}"
            )
            raise DeckError(evolution.source, message)


def cohesive_block(building: Building, group: ElementGroup) -> ElementBlock:
    """Build the block of a group of cohesive elements. Raises DeckError."""
    kind, section = COHESIVE[group.type], group.section
    assert isinstance(section, CohesiveSection)
    routine, variables = cohesive_routine(building.model, group, section), cohesive_variables(section, kind)
    # damage that depends on the mode mix
    return nodal_block(building, group, kind, routine, variables, unsymmetric=True)
