# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in elements with temperatures for the driver: coupled temperature-displacement and heat transfer elements.

They are in fortran/host/elements/heat/coupled.f90 and host/elements/heat/conduction.f90.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uel.elements.block import ElementBlock
from uel.elements.building import Building
from uel.elements.families.solid import (
    check_radii,
    continuum_block,
    history_of,
    numbered,
    output_variables,
    section_depth,
    solid_of,
    solid_routine,
    solid_section,
)
from uel.elements.materials.library import define_thermal, define_user_field, directions, state_variables
from uel.elements.routine import Routine
from uel.errors import DeckError
from uel.model.arrays import FloatArray
from uel.model.dofs import TEMPERATURE
from uel.model.element_types import HeatType
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.properties import Material
from uel.model.records import PointVariables
from uel.usersub import Library, _binding, _materials, built_in


def coupled_block(building: Building, group: ElementGroup) -> ElementBlock:
    """Build the block of a group of solids with temperatures. Raises DeckError."""
    model, library, kind = building.model, building.library, solid_of(group)
    material = solid_section(group).material
    _check_thermal(model, group, material)
    if material.user_thermal is not None and kind.points != kind.thermal_points:
        _warn_of_reduced(model, group, library)
    solid = solid_routine(model, group, library)
    define_thermal(solid.material, material, library)
    hidden = (kind.dimension + 1) * kind.thermal_points
    routine = replace(
        solid,
        address=_binding.address_of("coupled"),
        svars=solid.svars + hidden,
        hidden=solid.hidden + hidden,
        jprops=built_in.integers(
            "coupled", solid.jprops, heat_points=kind.thermal_points, heat_family=kind.family.linear.number
        ),
        initial_temperatures=_initial_temperatures(model) if material.expansion is not None else None,
    )
    # Abaqus stores the matrix of coupled steps as unsymmetric, UNSYMM or not (Analysis User's Guide, Fully coupled
    # thermal-stress analysis), as thermal expansion and the heat terms of UMAT need
    unsymmetric = material.user is not None or material.expansion is not None or _is_unsymmetric(material)
    temperatures = tuple((node, TEMPERATURE) for node in range(kind.corners))
    return continuum_block(building, group, routine, temperatures, unsymmetric=unsymmetric)


def _initial_temperatures(model: Model) -> FloatArray:
    """Return initial temperatures of all nodes (nodes,), zero by default."""
    temperatures = np.zeros(len(model.mesh.labels))
    for entry in model.initial_temperatures:
        if entry.dof == TEMPERATURE:
            temperatures[entry.nodes] = entry.value
    return temperatures


def _warn_of_reduced(model: Model, group: ElementGroup, library: Library) -> None:
    """Warn, once per type, of UMATHT in elements with more points for heat than for stresses, as Abaqus does."""
    if group is next(other for other in model.groups if other.type == group.type):
        message = f"elements of type {group.type} have more points for heat than for stresses"
        advice = "UMATHT should not be used there if plastic dissipation couples displacements and temperatures"
        library.warn(f"{group.source}: {message}; {advice}")


def heat_block(building: Building, group: ElementGroup) -> ElementBlock:
    """Build the block of a group of heat transfer elements. Raises DeckError."""
    model, library, kind, section = building.model, building.library, group.built_in, solid_section(group)
    assert isinstance(kind, HeatType)
    material = section.material
    if kind.axisymmetric:
        check_radii(model, group)
    _check_thermal(model, group, material)
    number = _materials.define_empty_material()
    define_thermal(number, material, library)
    define_user_field(number, material, directions(section.orientation), library)
    routine = Routine(
        address=_binding.address_of("heat"),
        jtype=kind.nodes,
        mcrd=kind.dimension,
        svars=(kind.dimension + 1) * kind.points,
        hidden=kind.points,
        props=built_in.reals("flow", depth=section_depth(kind, section)),
        jprops=built_in.integers("flow", family=kind.family.number, points=kind.points, direct=kind.direct),
        family=kind.family.number,
        material=number,
        history=history_of(material, kind.points),
        statev=state_variables(material),
        uvarm=output_variables(section, kind.points, library),
    )
    return ElementBlock(
        group,
        model.mesh.coordinates,
        tuple((node, TEMPERATURE) for node in range(kind.nodes)),
        routine,
        library,
        unsymmetric=_has_unsymmetric_flow(material),
        variables=_variables(kind, routine),
    )


def _variables(kind: HeatType, routine: Routine) -> PointVariables:
    names = tuple(f"HFL{component}" for component in kind.components)
    names = *names, *numbered("SDV", routine.statev)
    if routine.uvarm is not None:
        names = *names, *numbered("UVARM", routine.uvarm.count)
    return PointVariables("continuum", names, kind.points)


def _has_unsymmetric_flow(material: Material) -> bool:
    """Return whether UMATHT gives an unsymmetric matrix; that of *CONDUCTIVITY
    leaves out its slope without displacements.
    """
    return material.user_thermal is not None and material.user_thermal.unsymmetric


def _is_unsymmetric(material: Material) -> bool:
    """Return whether heat conduction beside displacements has an unsymmetric matrix,
    as it depends on the temperature.
    """
    return _has_unsymmetric_flow(material) or (material.user_thermal is None and len(material.conductivity) > 1)


def _check_thermal(model: Model, group: ElementGroup, material: Material) -> None:
    """Raise DeckError if the material lacks what elements with temperatures need to store heat."""
    if not any(step.procedure.stores_heat for step in model.steps):
        return
    stores = material.user_thermal is not None or bool(len(material.specific_heat))
    for keyword, given in (("*DENSITY", bool(material.density)), ("*SPECIFIC HEAT", stores)):
        if not given:
            message = f"material {material.name} has no {keyword}, which elements of type {group.type} need"
            raise DeckError(material.source, message)
