# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""From the model's element groups to blocks, with the checks that need no call."""

from __future__ import annotations

from harness.elements.block import Block, Procedure
from harness.errors import DeckError
from harness.model.mesh import ElementGroup
from harness.model.model import Model
from harness.model.properties import UserElement, UserProperty
from harness.usersub import Library


def build_blocks(model: Model, library: Library) -> list[Block]:
    """One block per group of the model, in the same order. Raises DeckError."""
    return [_block(model, group, library) for group in model.groups]


def _block(model: Model, group: ElementGroup, library: Library) -> Block:
    definition, section = group.definition, group.section
    if definition is None or not isinstance(section, UserProperty):
        raise DeckError(group.source, f"element type {group.type} is not supported")
    _check_counts(group, definition, section)
    address = _user_address(group, section, library)
    # COORDS holds what *USER ELEMENT asks for, or more where dofs 1-3 say that the element is of higher dimension
    mcrd = max(definition.coordinates, *(dof for _, dof in definition.dofs if dof <= 3), 1)
    procedure = Procedure(
        address=address,
        jtype=definition.number,
        mcrd=mcrd,
        svars=definition.variables,
        props=section.values,
        jprops=section.integers,
    )
    return Block(
        group,
        model.mesh.coordinates,
        definition.dofs,
        procedure,
        library,
        unsymmetric=definition.unsymmetric,
        variables=library.variables(definition.number),
    )


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
    found = ", ".join(library.entry_points) or "no user routine"
    where = library.name or "this job"
    raise DeckError(group.source, f"elements of type {group.type} need {entry}{reason}; {where} has {found}")
