# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""From the model's element groups to blocks, with the checks that need no call."""

from __future__ import annotations

from difflib import get_close_matches
from typing import Final

import numpy as np

from harness.elements.block import Block, OutputVariables, Procedure
from harness.elements.materials import Tensor, define_material, history_values
from harness.errors import DeckError
from harness.model.mesh import ElementGroup
from harness.model.model import Model
from harness.model.properties import Material, SolidSection, UserElement, UserProperty
from harness.model.records import PointVariables
from harness.usersub import Library, _binding

BUILT_IN: Final = {
    "CPS3": (3, 1, Tensor.PLANE_STRESS),
    "CPS4": (4, 4, Tensor.PLANE_STRESS),
    "CPS8": (8, 9, Tensor.PLANE_STRESS),
    "CPS8R": (8, 4, Tensor.PLANE_STRESS),
    "CPE3": (3, 1, Tensor.PLANE_STRAIN),
    "CPE4": (4, 4, Tensor.PLANE_STRAIN),
    "CPE8": (8, 9, Tensor.PLANE_STRAIN),
    "CPE8R": (8, 4, Tensor.PLANE_STRAIN),
}
"""Built-in elements: nodes, integration points, state of stress."""

TENSORS: Final = {
    "PSTRESS": Tensor.PLANE_STRESS,
    "PSTRAIN": Tensor.PLANE_STRAIN,
    "TWOD": Tensor.PLANE_STRAIN,
    "THREED": Tensor.SOLID,
}
"""TENSOR= of *USER ELEMENT; TWOD has the components of plane strain."""

POINT_NAMES: Final = ("E11", "E22", "E33", "E12", "S11", "S22", "S33", "S12")
"""SVARS of a point of a built-in element."""


def build_blocks(model: Model, library: Library, *, strict: bool = True) -> list[Block]:
    """One block per group of the model, in the same order. Raises DeckError.

    strict: a user element that writes outside an array is an error, else a warning.
    """
    blocks = []
    for group in model.groups:
        if group.definition is not None:
            blocks.append(_user_block(model, group, group.definition, library, strict=strict))
        elif group.type.upper() in BUILT_IN:
            blocks.append(_built_in_block(model, group, library))
        else:
            known = ", ".join(BUILT_IN)
            near = get_close_matches(group.type.upper(), BUILT_IN, n=1)
            hint = f"; did you mean {near[0]}?" if near else ""
            raise DeckError(group.source, f"element type {group.type} is not supported (built in are {known}){hint}")
    return blocks


def _user_block(model: Model, group: ElementGroup, definition: UserElement, library: Library, *, strict: bool) -> Block:
    section = group.section
    if not isinstance(section, UserProperty):
        raise DeckError(section.source, f"*SOLID SECTION cannot be used for user elements ({group.type})")
    _check_counts(group, definition, section)
    address = _user_address(group, section, library)
    # COORDS holds what *USER ELEMENT asks for, or more where dofs 1-3 say that the element is of higher dimension
    mcrd = max(definition.coordinates, *(dof for _, dof in definition.dofs if dof <= 3), 1)
    material, tensor, history = 0, 0, (1, 1)
    if section.material is not None:
        tensor = _tensor(definition, section)
        material = define_material(section.material, section.orientation, tensor, section.source, library)
        history = _history(section.material, definition.integration or MOST_POINTS)
    procedure = Procedure(
        address=address,
        jtype=definition.number,
        mcrd=mcrd,
        svars=definition.variables,
        props=section.values,
        jprops=section.integers,
        material=material,
        tensor=int(tensor),
        history=history,
    )
    variables = library.variables(definition.number)
    return Block(
        group,
        model.mesh.coordinates,
        definition.dofs,
        procedure,
        library,
        unsymmetric=definition.unsymmetric,
        variables=variables,
        strict=strict,
    )


MOST_POINTS: Final = 64
"""Points of a plastic material per user element where *USER ELEMENT does not give INTEGRATION=."""


def _history(material: Material, points: int) -> tuple[int, int]:
    values = history_values(material)
    return values, points if values > 1 else 1


def _output_variables(material: Material, points: int, library: Library) -> OutputVariables | None:
    """UVARM of a material; None where the job has none, which leaves out the variables alone."""
    if not material.output_variables or library.uvarm is None:
        return None
    return OutputVariables(library.uvarm, material.name, points, material.output_variables)


def _numbered(name: str, count: int) -> tuple[str, ...]:
    return tuple(f"{name}{number}" for number in range(1, count + 1))


def _built_in_block(model: Model, group: ElementGroup, library: Library) -> Block:
    section = group.section
    nodes, points, tensor = BUILT_IN[group.type.upper()]
    if not isinstance(section, SolidSection):
        raise DeckError(section.source, f"*UEL PROPERTY cannot be used for elements of type {group.type}")
    if group.nodes.shape[1] != nodes:
        raise DeckError(group.source, f"elements of type {group.type} have {nodes} nodes, found {group.nodes.shape[1]}")
    nonlinear = next((step for step in model.steps if step.nlgeom), None)
    if nonlinear is not None:
        raise DeckError(nonlinear.source, f"NLGEOM is not supported with elements of type {group.type}")
    procedure = Procedure(
        address=_binding.solid_address(),
        jtype=nodes,
        mcrd=2,
        svars=points * len(POINT_NAMES),
        props=np.array([section.thickness]),
        jprops=np.zeros(0, dtype=np.int64),
        material=define_material(section.material, section.orientation, tensor, section.source, library),
        tensor=int(tensor),
        history=_history(section.material, points),
        statev=section.material.state_variables if section.material.user is not None else 0,
        uvarm=_output_variables(section.material, points, library),
    )
    unknowns = tuple((node, dof) for node in range(nodes) for dof in (1, 2))
    names = *POINT_NAMES, *_numbered("SDV", procedure.statev)
    if procedure.uvarm is not None:
        names = *names, *_numbered("UVARM", procedure.uvarm.count)
    variables = PointVariables("continuum", names, points, outline=tuple(range(nodes)))
    return Block(
        group,
        model.mesh.coordinates,
        unknowns,
        procedure,
        library,
        # the elastic and the plastic tangent are symmetric
        unsymmetric=section.material.user is not None and section.material.user.unsymmetric,
        variables=variables,
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
    found = ", ".join(library.entry_points) or "no user routine"
    where = library.name or "this job"
    raise DeckError(group.source, f"elements of type {group.type} need {entry}{reason}; {where} has {found}")
