# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""User elements for the driver, which calls UEL or UELMAT."""

from __future__ import annotations

from typing import Final

from uel.elements.block import ElementBlock
from uel.elements.building import Building
from uel.elements.families.solid import history_of
from uel.elements.materials.library import define_material, linearity
from uel.elements.routine import Linearity, Routine
from uel.errors import DeckError
from uel.model.element_types import Tensor
from uel.model.mesh import ElementGroup
from uel.model.properties import UserElement, UserProperty
from uel.usersub import Library

TENSORS: Final = {
    "PSTRESS": Tensor.PLANE_STRESS,
    "PSTRAIN": Tensor.PLANE_STRAIN,
    "TWOD": Tensor.PLANE_STRAIN,
    "THREED": Tensor.SOLID,
}
"""TENSOR= of *USER ELEMENT; TWOD has the components of plane strain."""

MOST_POINTS: Final = 64
"""Points of a plastic material per user element if *USER ELEMENT does not give INTEGRATION=."""


def user_block(building: Building, group: ElementGroup) -> ElementBlock:
    """Build the block of a group of user elements. Raises DeckError."""
    section, definition, library = group.section, group.definition, building.library
    assert isinstance(section, UserProperty)
    assert definition is not None
    _check_counts(group, definition, section)
    address = _user_address(group, section, library)
    # COORDS has COORDINATES= of *USER ELEMENT, or more if dofs 1-3 show that the element has a higher dimension
    mcrd = max(definition.coordinates, *(dof for _, dof in definition.dofs if dof <= 3), 1)
    material, tensor, history = 0, 0, (1, 1)
    assumed = group.type.upper() in building.linear
    forces = Linearity.ASSUMED if assumed else Linearity.UNKNOWN
    free: tuple[int, ...] = ()
    if section.material is not None:
        tensor = _tensor(definition, section)
        material = define_material(section.material, section.orientation, tensor, section.source, library)
        history = history_of(section.material, definition.integration or MOST_POINTS)
        if library.is_continuum(definition.number, section.integers):
            forces, free = linearity(section.material), tuple(range(1, mcrd + 1))
    routine = Routine(
        address=address,
        jtype=definition.number,
        mcrd=mcrd,
        svars=definition.variables,
        props=section.values,
        jprops=section.integers,
        material=material,
        tensor=int(tensor),
        history=history,
        forces=forces,
        stores=forces is Linearity.KNOWN,
        free=free,
    )
    variables = library.variables(definition.number) or definition.point_variables
    return ElementBlock(
        group,
        building.model.mesh.coordinates,
        definition.dofs,
        routine,
        library,
        unsymmetric=definition.unsymmetric,
        variables=variables,
        strict=building.strict,
        zeros=building.zeros,
    )


def _tensor(definition: UserElement, section: UserProperty) -> Tensor:
    tensor = TENSORS.get(definition.tensor.upper())
    if tensor is None:
        raise DeckError(
            definition.source,
            f"*USER ELEMENT, TYPE=U{definition.number} needs TENSOR={'|'.join(TENSORS)}, "
            f"because *UEL PROPERTY ({section.source}) names a material",
        )
    return tensor


def _check_counts(group: ElementGroup, definition: UserElement, section: UserProperty) -> None:
    for given, wanted, what, option in (
        (len(section.values), definition.properties, "real properties", "PROPERTIES"),
        (len(section.integers), definition.integer_properties, "integer properties", "I PROPERTIES"),
    ):
        if given != wanted:
            raise DeckError(
                section.source,
                f"*UEL PROPERTY for {section.elset} gives {given} {what}, "
                f"but *USER ELEMENT, TYPE={group.type} ({definition.source}) has {option}={wanted}",
            )
    if group.nodes.shape[1] != definition.nodes:
        raise DeckError(
            group.source,
            f"elements of type {group.type} have {group.nodes.shape[1]} nodes, "
            f"but *USER ELEMENT ({definition.source}) has NODES={definition.nodes}",
        )


def _user_address(group: ElementGroup, section: UserProperty, library: Library) -> int:
    address, entry = (library.uel, "UEL") if section.material is None else (library.uelmat, "UELMAT")
    if address is not None:
        return address
    reason = "" if section.material is None else f", because *UEL PROPERTY for {section.elset} names a material"
    where = library.name or "this job"
    raise DeckError(group.source, f"elements of type {group.type} need {entry}{reason}; {where} has {library.contents}")
