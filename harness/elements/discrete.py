# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in trusses, springs, masses and rigid elements: what the driver calls for them."""

from __future__ import annotations

from typing import Final

import numpy as np

from harness.elements.materials import refuse_fields, refuse_user_hardening, refuse_viscous
from harness.elements.routine import Routine
from harness.errors import DeckError
from harness.model.element_types import DISCRETE, DiscreteKind, RigidType
from harness.model.mesh import ElementGroup, is_in_space
from harness.model.model import Model
from harness.model.properties import ElasticType, MassSection, RigidSection, SolidSection, SpringSection
from harness.model.records import PointVariables
from harness.usersub import _binding

_STATES: Final = {DiscreteKind.TRUSS: 4, DiscreteKind.AXIAL_SPRING: 2, DiscreteKind.SPRING: 2, DiscreteKind.MASS: 2}
"""SVARS of an element."""


def discrete_unknowns(model: Model, group: ElementGroup) -> tuple[tuple[int, int], ...]:
    """(local node, dof) of each unknown; a mass and SPRINGA have the displacements of the model's dimension."""
    section = group.section
    if isinstance(section, SpringSection) and section.dofs:
        return tuple(enumerate(section.dofs))
    rigid = group.built_in if isinstance(group.built_in, RigidType) else None
    kind = rigid or DISCRETE[group.type]
    dimension = kind.dimension
    if (
        rigid is None
        and _kind_of(group) is not DiscreteKind.TRUSS
        and not is_in_space(model.mesh.coordinates, model.groups)
    ):
        dimension = 2
    return tuple((node, dof) for node in range(group.nodes.shape[1]) for dof in range(1, dimension + 1))


def discrete_routine(model: Model, group: ElementGroup, unknowns: int) -> Routine:
    """What the driver calls for a group. Raises DeckError."""
    kind = _kind_of(group)
    dynamic = any(step.procedure.inertia for step in model.steps)
    hidden = 2 * unknowns if dynamic else 0
    return Routine(
        address=_binding.address_of("discrete"),
        jtype=kind,
        mcrd=unknowns // 2 if kind in (DiscreteKind.TRUSS, DiscreteKind.AXIAL_SPRING) else 3,
        svars=_STATES[kind] + hidden,
        hidden=hidden,
        density=2 if kind is DiscreteKind.TRUSS else -1,
        props=_properties(group, dynamic=dynamic),
        turns=kind in (DiscreteKind.TRUSS, DiscreteKind.AXIAL_SPRING),
        jprops=np.zeros(0, dtype=np.int64),
        forceless=isinstance(group.section, RigidSection),
    )


def discrete_variables(group: ElementGroup) -> PointVariables | None:
    """Meaning of the state variables: strain and stress of a truss; those of springs have no name in Abaqus' output."""
    if _kind_of(group) is not DiscreteKind.TRUSS:
        return None
    return PointVariables("continuum", ("E11", "S11", "PE11", "PEEQ"), 1)


def _kind_of(group: ElementGroup) -> DiscreteKind:
    """To the driver the nodes of rigid elements are masses of zero, which have no forces."""
    return DISCRETE[group.type].kind if group.type in DISCRETE else DiscreteKind.MASS


def _properties(group: ElementGroup, *, dynamic: bool) -> np.ndarray:
    section = group.section
    if isinstance(section, MassSection | RigidSection):
        return np.array([section.mass if isinstance(section, MassSection) else 0.0])
    if isinstance(section, SpringSection):
        return section.table
    if not isinstance(section, SolidSection):
        raise DeckError(section.source, f"elements of type {group.type} need *SOLID SECTION")
    material = section.material
    refuse_fields(material, f"elements of type {group.type}")
    refuse_viscous(material, f"elements of type {group.type}")
    refuse_user_hardening(material, f"elements of type {group.type}")
    if material.elastic is None or material.elastic.type is not ElasticType.ISOTROPIC:
        message = f"elements of type {group.type} need *ELASTIC, TYPE=ISOTROPIC (material {material.name})"
        raise DeckError(section.source, message)
    if dynamic and not material.density:
        message = f"material {material.name} has no *DENSITY, which elements of type {group.type} need in *DYNAMIC"
        raise DeckError(material.source, message)
    if material.plastic is not None and len(material.plastic.backstresses):
        message = f"elements of type {group.type} support isotropic hardening only (material {material.name})"
        raise DeckError(material.plastic.source, f"*PLASTIC: {message}")
    table = np.zeros(0) if material.plastic is None else material.plastic.table.ravel()
    return np.array([section.thickness, material.elastic.constants[0], material.density, *table])
