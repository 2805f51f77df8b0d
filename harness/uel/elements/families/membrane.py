# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in membranes for the driver (fortran/host/elements/shell/membrane.f90)."""

from __future__ import annotations

from uel.elements.block import ElementBlock
from uel.elements.building import Building, begin_surface_axes, nodal_block
from uel.elements.families.solid import history_names, history_of, hourglass_stiffness, is_prestressed
from uel.elements.materials.library import (
    define_material,
    linearity,
    state_variables,
    user_outputs,
)
from uel.elements.routine import VALUES_OF_AXES, PointAxes, Routine
from uel.model.element_types import MembraneType, Tensor
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.properties import MembraneSection
from uel.model.records import PointVariables
from uel.usersub import Library, _binding, built_in


def membrane_routine(
    model: Model, group: ElementGroup, kind: MembraneType, section: MembraneSection, library: Library
) -> Routine:
    """Build the routine of a membrane group. Raises DeckError."""
    material, orientation = section.material, section.orientation
    dynamic = any(step.procedure.inertia for step in model.steps)
    hourglass = hourglass_stiffness(kind, section, Tensor.PLANE_STRESS) if kind.hourglass_control else 0.0
    outputs, prestressed = user_outputs(material, library), is_prestressed(model, group, material)
    number = define_material(
        material,
        orientation,
        Tensor.PLANE_STRESS,
        section.source,
        library,
        local=True,
        prestressed=prestressed,
        outputs=outputs,
    )
    of_points = kind.points * len(built_in.variables("membrane"))
    forces = 6 * kind.nodes if dynamic else 0
    axes = PointAxes(of_points + forces, kind.points, False, orientation) if orientation else None
    hidden = forces + (VALUES_OF_AXES * kind.points if axes else 0)
    history = history_of(material, kind.points, prestressed=prestressed, outputs=outputs)
    return Routine(
        address=_binding.address_of("membrane"),
        jtype=kind.nodes,
        mcrd=3,
        svars=of_points + hidden,
        hidden=hidden,
        density=built_in.position("membrane", "density"),
        props=built_in.reals(
            "membrane",
            thickness=section.thickness,
            density=material.density,
            hourglass=hourglass,
            poisson=section.poisson,
        ),
        jprops=built_in.integers(
            "membrane",
            family=kind.family.number,
            points=kind.points,
            mass_points=kind.family.full_points,
            oriented=axes is not None,
        ),
        family=kind.family.number,
        material=number,
        tensor=int(Tensor.PLANE_STRESS),
        history=history,
        statev=state_variables(material),
        outputs=outputs,
        linear=history[0] == 1,
        forces=linearity(material, prestressed=prestressed),
        # the energy of hourglass control is another one
        stores=not kind.hourglass_control,
        free=(1, 2, 3),
        axes=axes,
        stress=(3, 4, 5),
        turns=True,
    )


def membrane_variables(kind: MembraneType, routine: Routine) -> PointVariables:
    """Describe the state variables of a membrane group."""
    return PointVariables("continuum", (*built_in.variables("membrane"), *history_names(routine)), kind.points)


def membrane_block(building: Building, group: ElementGroup) -> ElementBlock:
    """Build the block of a group of membranes. Raises DeckError."""
    kind, section = group.built_in, group.section
    assert isinstance(kind, MembraneType)
    assert isinstance(section, MembraneSection)
    routine = membrane_routine(building.model, group, kind, section, building.library)
    block = nodal_block(building, group, kind, routine, membrane_variables(kind, routine))
    begin_surface_axes(building, group, kind, block, routine)
    return block
