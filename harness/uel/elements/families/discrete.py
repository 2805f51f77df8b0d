# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in trusses, springs, dashpots, masses and rigid elements for the driver.

In fortran/host trusses are in host/elements/beam/truss.f90, the others in host/elements/beam/discrete.f90.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from uel.elements.block import ElementBlock
from uel.elements.building import Building
from uel.elements.families.solid import numbered, output_variables
from uel.elements.materials.library import (
    define_truss_material,
    history_values,
    state_variables,
)
from uel.elements.routine import OutputVariables, Routine
from uel.model.element_types import DISCRETE, LINE2, DiscreteKind, RigidType, Tensor
from uel.model.mesh import ElementGroup, is_in_space
from uel.model.model import Model
from uel.model.properties import MassSection, RigidSection, SolidSection, SpringSection
from uel.model.records import PointVariables
from uel.usersub import Library, _binding, built_in

_STATES: Final = 2
"""SVARS of an element that is no truss."""
_AXIAL: Final = (DiscreteKind.AXIAL_SPRING, DiscreteKind.AXIAL_DASHPOT)


def discrete_unknowns(model: Model, group: ElementGroup) -> tuple[tuple[int, int], ...]:
    """Return (local node, dof) of each unknown. Masses, SPRINGA and DASHPOTA have the
    displacements of the model's dimension.
    """
    section = group.section
    if isinstance(section, SpringSection) and section.dofs:
        return tuple(enumerate(section.dofs))
    if isinstance(group.built_in, RigidType):
        dimension = group.built_in.dimension
    elif _kind_of(group) is DiscreteKind.TRUSS or is_in_space(model.mesh.coordinates, model.groups):
        dimension = DISCRETE[group.type].dimension
    else:
        dimension = 2
    return tuple((node, dof) for node in range(group.nodes.shape[1]) for dof in range(1, dimension + 1))


def discrete_routine(model: Model, group: ElementGroup, unknowns: int, library: Library) -> Routine:
    """Build the routine of a group. Raises DeckError."""
    kind = _kind_of(group)
    dynamic = any(step.procedure.inertia for step in model.steps)
    hidden = 2 * unknowns if dynamic else 0
    if kind is DiscreteKind.TRUSS:
        return _truss_routine(group, unknowns, hidden, library)
    section = group.section
    assert isinstance(section, MassSection | RigidSection | SpringSection)
    if isinstance(section, SpringSection):
        props = built_in.reals("spring", table=section.table)
    else:
        props = built_in.reals("mass", value=section.mass if isinstance(section, MassSection) else 0.0)
    return Routine(
        address=_binding.address_of("discrete"),
        jtype=kind,
        mcrd=unknowns // 2 if kind in _AXIAL else 3,
        svars=_STATES + hidden,
        hidden=hidden,
        props=props,
        turns=kind is DiscreteKind.AXIAL_SPRING,
        jprops=np.zeros(0, dtype=np.int64),
        forceless=isinstance(section, RigidSection),
    )


def _kind_of(group: ElementGroup) -> DiscreteKind:
    """Return the kind of a group. To the driver the nodes of rigid elements are masses of zero,
    which have no forces.
    """
    return DISCRETE[group.type].kind if group.type in DISCRETE else DiscreteKind.MASS


def _truss_routine(group: ElementGroup, unknowns: int, hidden: int, library: Library) -> Routine:
    section = group.section
    assert isinstance(section, SolidSection)
    material = section.material
    statev = state_variables(material)
    return Routine(
        address=_binding.address_of("truss"),
        jtype=2,
        mcrd=unknowns // 2,
        svars=len(built_in.variables("truss")) + hidden,
        hidden=hidden,
        density=built_in.position("truss", "density"),
        props=built_in.reals("truss", area=section.thickness, density=material.density),
        turns=True,
        jprops=built_in.integers("truss", family=LINE2.number),
        material=define_truss_material(material, library),
        tensor=int(Tensor.UNIAXIAL),
        # one value stands for no history: plastic strains are in SVARS
        history=(history_values(material) if material.user else 1 + statev, 1),
        statev=statev,
        family=LINE2.number,
        uvarm=_output_variables(section, library),
    )


def _output_variables(section: SolidSection, library: Library) -> OutputVariables | None:
    """Return the UVARM of trusses, which have no directions of a material."""
    found = output_variables(section, 1, library)
    return found and replace(found, axes=np.zeros((3, 3)))


def discrete_variables(group: ElementGroup, routine: Routine) -> PointVariables | None:
    """Describe the state variables: strain and stress of a truss; None for others,
    which have no name in Abaqus' output.
    """
    if _kind_of(group) is not DiscreteKind.TRUSS:
        return None
    outputs = () if routine.uvarm is None else numbered("UVARM", routine.uvarm.count)
    return PointVariables("continuum", (*built_in.variables("truss"), *numbered("SDV", routine.statev), *outputs), 1)


def discrete_block(building: Building, group: ElementGroup) -> ElementBlock:
    """Build the block of a group of trusses, springs, dashpots, masses or rigid elements. Raises DeckError."""
    model, library = building.model, building.library
    unknowns = discrete_unknowns(model, group)
    routine = discrete_routine(model, group, len(unknowns), library)
    variables = discrete_variables(group, routine)
    return ElementBlock(
        group, model.mesh.coordinates, unknowns, routine, library, unsymmetric=False, variables=variables
    )
