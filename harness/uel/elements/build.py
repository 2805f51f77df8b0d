# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Construction of blocks from the model's element groups, with the checks that need no call."""

from __future__ import annotations

from collections.abc import Collection
from difflib import get_close_matches
from typing import Final

import numpy as np

from uel.elements.block import ElementBlock
from uel.elements.directions import start_axes
from uel.elements.families.beam import beam_routine, beam_variables, start_directions
from uel.elements.families.cohesive import cohesive_routine, cohesive_variables
from uel.elements.families.composite import composite_routine, composite_variables, layer_axes
from uel.elements.families.continuum_shell import continuum_shell_routine, stack_directions
from uel.elements.families.coupled import (
    coupled_routine,
    has_unsymmetric_flow,
    heat_routine,
    heat_variables,
    is_unsymmetric,
)
from uel.elements.families.discrete import discrete_routine, discrete_unknowns, discrete_variables
from uel.elements.families.generalised import generalised_routine
from uel.elements.families.mass_diffusion import (
    depends_on_concentration,
    mass_diffusion_routine,
    mass_diffusion_variables,
)
from uel.elements.families.membrane import membrane_routine, membrane_variables
from uel.elements.families.piezoelectric import piezoelectric_routine, piezoelectric_variables
from uel.elements.families.shell import check_normals, directors, shell_routine, shell_variables
from uel.elements.families.solid import history_of, solid_routine, solid_variables
from uel.elements.fields import REFERENCE
from uel.elements.formulations import check_support, formulation_of
from uel.elements.materials.hybrid import has_unsymmetric_pressure, pressure_unknowns
from uel.elements.materials.library import (
    define_material,
    has_unsymmetric_tangent,
    linearity,
)
from uel.elements.routine import Linearity, Routine
from uel.errors import DeckError, all_of, unsupported
from uel.model.arrays import flat_rows
from uel.model.dofs import CONCENTRATION, POTENTIAL, PRESSURE, TEMPERATURE
from uel.model.element_types import (
    BUILT_IN,
    PLANES,
    BeamType,
    CohesiveType,
    ContinuumShellType,
    ContinuumType,
    DiscreteType,
    HeatType,
    MembraneType,
    RigidType,
    ShellType,
    SurfaceType,
    Tensor,
)
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.properties import (
    BeamSection,
    CohesiveSection,
    CompositeSection,
    Material,
    MembraneSection,
    ShellSection,
    SolidSection,
    UserElement,
    UserProperty,
    materials_of,
)
from uel.model.records import PointVariables
from uel.usersub import Library

TENSORS: Final = {
    "PSTRESS": Tensor.PLANE_STRESS,
    "PSTRAIN": Tensor.PLANE_STRAIN,
    "TWOD": Tensor.PLANE_STRAIN,
    "THREED": Tensor.SOLID,
}
"""TENSOR= of *USER ELEMENT; TWOD has the components of plane strain."""


def build_blocks(
    model: Model, library: Library, *, strict: bool = True, zeros: bool = False, linear: Collection[str] = ()
) -> list[ElementBlock]:
    """Build the blocks of all elements of a model.

    Parameters
    ----------
    model
        The whole deck.
    library
        The loaded user routines.
    strict
        A write of a user element outside an array is an error, otherwise a warning.
    zeros
        An entry of RHS or AMATRX that a user element does not set gives a warning and is zero, otherwise it is an
        error.
    linear
        Types of user elements that the user says are linear.

    Returns
    -------
    list[ElementBlock]
        One per group of the model, in the same order.

    Raises
    ------
    DeckError
        Names all places of groups that cannot be built.
    """
    blocks: list[ElementBlock] = []
    errors: dict[str, DeckError] = {}
    for group in model.groups:
        try:
            blocks.append(_block_of(model, group, library, strict=strict, zeros=zeros, linear=linear))
        except DeckError as error:
            errors.setdefault(str(error), error)
        except MemoryError:
            raise _too_large(group) from None
    if errors:
        raise all_of(list(errors.values()))
    return blocks


def _too_large(group: ElementGroup) -> DeckError:
    given = group.definition
    source, cause = (given.source, f" (VARIABLES={given.variables})") if given else (group.source, "")
    return DeckError(source, f"not enough memory for {len(group.labels)} elements of type {group.type}{cause}")


def _block_of(
    model: Model, group: ElementGroup, library: Library, *, strict: bool, zeros: bool, linear: Collection[str]
) -> ElementBlock:
    kind = group.built_in
    formulation = formulation_of(model, group)
    if formulation is None:
        near = get_close_matches(group.type.upper(), BUILT_IN, n=1)
        raise unsupported(
            group.source, f"element type {group.type}", instead=f"did you mean {near[0]}?" if near else ""
        )
    check_support(model, group, formulation)
    if group.definition is not None:
        assumed = group.type.upper() in linear
        return _user_block(model, group, group.definition, library, strict=strict, zeros=zeros, assumed=assumed)
    match kind:
        case HeatType():
            return _heat_block(model, group, kind, library)
        case ShellType() | ContinuumShellType() | MembraneType() | BeamType():
            return _structural_block(model, group, kind, library)
        case ContinuumType():
            return _solid_block(model, group, kind, library)
        case CohesiveType():
            return _cohesive_block(model, group, kind, library)
        case DiscreteType() | RigidType():
            return _discrete_block(model, group, library)
    raise AssertionError


def _user_block(
    model: Model,
    group: ElementGroup,
    definition: UserElement,
    library: Library,
    *,
    strict: bool,
    zeros: bool,
    assumed: bool,
) -> ElementBlock:
    section = group.section
    if not isinstance(section, UserProperty):
        raise DeckError(section.source, f"user elements ({group.type}) need *UEL PROPERTY")
    _check_counts(group, definition, section)
    address = _user_address(group, section, library)
    # COORDS has COORDINATES= of *USER ELEMENT, or more if dofs 1-3 show that the element has a higher dimension
    mcrd = max(definition.coordinates, *(dof for _, dof in definition.dofs if dof <= 3), 1)
    material, tensor, history = 0, 0, (1, 1)
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
        model.mesh.coordinates,
        definition.dofs,
        routine,
        library,
        unsymmetric=definition.unsymmetric,
        variables=variables,
        strict=strict,
        zeros=zeros,
    )


MOST_POINTS: Final = 64
"""Points of a plastic material per user element if *USER ELEMENT does not give INTEGRATION=."""


def _nodal_block(
    model: Model,
    group: ElementGroup,
    kind: ContinuumType | CohesiveType | ShellType | MembraneType | BeamType,
    routine: Routine,
    library: Library,
    variables: PointVariables | None,
    *,
    unsymmetric: bool = False,
) -> ElementBlock:
    """Build a block whose unknowns are dofs of its nodes. It is unsymmetric also if the tangent of a material is."""
    return ElementBlock(
        group,
        model.mesh.coordinates,
        tuple((node, dof) for node in range(kind.nodes) for dof in kind.dofs(node)),
        routine,
        library,
        unsymmetric=unsymmetric or any(map(has_unsymmetric_tangent, materials_of(group.section))),
        variables=variables,
    )


def _composite_block(
    model: Model, group: ElementGroup, kind: ContinuumType, section: CompositeSection, library: Library
) -> ElementBlock:
    _check_nodes(group, kind.nodes)
    routine = composite_routine(model, group, kind, section, library)
    block = _nodal_block(model, group, kind, routine, library, composite_variables(kind, section, routine))
    block.initial.begin_axes(layer_axes(model, group, kind, section, routine.family))
    return block


def _solid_block(model: Model, group: ElementGroup, kind: ContinuumType, library: Library) -> ElementBlock:
    if isinstance(group.section, CompositeSection):
        return _composite_block(model, group, kind, group.section, library)
    section, coupled = _solid_section(group), kind.coupled
    _check_nodes(group, kind.nodes)
    if coupled:
        routine = coupled_routine(model, group, section, library)
    elif kind.electrical:
        routine = piezoelectric_routine(model, group, section, library)
    elif kind.generalised:
        routine = generalised_routine(model, group, section, library)
    else:
        routine = solid_routine(model, group, section, library)
    # displacements of all nodes, then temperatures of the corners, or potentials of all, or those of the reference node
    unknowns = tuple((node, dof) for node in range(kind.nodes) for dof in range(1, kind.dimension + 1))
    unknowns += tuple((node, TEMPERATURE) for node in range(kind.corners) if coupled)
    unknowns += tuple((node, POTENTIAL) for node in range(kind.nodes) if kind.electrical)
    unknowns += tuple((REFERENCE, dof) for dof in PLANES if kind.generalised)
    unknowns += tuple((kind.nodes, PRESSURE + k) for k in range(pressure_unknowns(kind, section.material)))
    unsymmetric = has_unsymmetric_tangent(section.material) or has_unsymmetric_pressure(kind, section.material)
    block = ElementBlock(
        group,
        model.mesh.coordinates,
        unknowns,
        routine,
        library,
        # Abaqus stores the matrix of coupled steps as unsymmetric, UNSYMM or not (Analysis User's Guide, Fully coupled
        # thermal-stress analysis), as thermal expansion and the heat terms of UMAT need
        unsymmetric=unsymmetric or (coupled and _interacts(section.material)),
        variables=piezoelectric_variables(group) if kind.electrical else solid_variables(group, routine),
    )
    if routine.axes is not None:
        block.initial.begin_axes(start_axes(model, group, kind, routine.axes.orientation, library))
    return block


def _interacts(material: Material) -> bool:
    """Return whether temperatures change stresses, or the heat flux depends on them."""
    return material.user is not None or material.expansion is not None or is_unsymmetric(material)


def _heat_block(model: Model, group: ElementGroup, kind: HeatType, library: Library) -> ElementBlock:
    section = _solid_section(group)
    _check_nodes(group, kind.nodes)
    diffusive = model.diffusive
    if diffusive:
        routine, variables = mass_diffusion_routine(model, group, kind, section), mass_diffusion_variables(kind)
    else:
        routine = heat_routine(model, group, kind, section, library)
        variables = heat_variables(kind, routine)
    dof = CONCENTRATION if diffusive else TEMPERATURE
    return ElementBlock(
        group,
        model.mesh.coordinates,
        tuple((node, dof) for node in range(kind.nodes)),
        routine,
        library,
        unsymmetric=(depends_on_concentration if diffusive else has_unsymmetric_flow)(section.material),
        variables=variables,
    )


def _solid_section(group: ElementGroup) -> SolidSection:
    if not isinstance(group.section, SolidSection):
        raise DeckError(group.section.source, f"elements of type {group.type} need *SOLID SECTION")
    return group.section


def _cohesive_block(model: Model, group: ElementGroup, kind: CohesiveType, library: Library) -> ElementBlock:
    section = group.section
    if not isinstance(section, CohesiveSection):
        raise DeckError(section.source, f"elements of type {group.type} need *COHESIVE SECTION")
    _check_nodes(group, kind.nodes)
    routine, variables = cohesive_routine(model, group, section), cohesive_variables(section, kind)
    # damage that depends on the mode mix
    return _nodal_block(model, group, kind, routine, library, variables, unsymmetric=True)


def _structural_block(
    model: Model,
    group: ElementGroup,
    kind: ShellType | ContinuumShellType | MembraneType | BeamType,
    library: Library,
) -> ElementBlock:
    if isinstance(kind, BeamType):
        return _beam_block(model, group, kind, library)
    if isinstance(kind, MembraneType):
        return _membrane_block(model, group, kind, library)
    if isinstance(kind, ContinuumShellType):
        return _continuum_shell_block(model, group, kind, library)
    return _shell_block(model, group, kind, library)


def _shell_block(model: Model, group: ElementGroup, kind: ShellType, library: Library) -> ElementBlock:
    section = group.section
    if not isinstance(section, ShellSection):
        raise DeckError(section.source, f"elements of type {group.type} need *SHELL SECTION")
    _check_nodes(group, kind.nodes)
    routine = shell_routine(model, group, kind, section, library)
    # moments are no derivatives by rotation vectors
    turns = any(step.nlgeom for step in model.steps)
    variables = shell_variables(section, kind, routine)
    block = _nodal_block(model, group, kind, routine, library, variables, unsymmetric=turns)
    check_normals(model, group, kind, library)
    block.initial.set_last(flat_rows(directors(model, group)))
    _begin_surface_axes(model, group, kind, block, routine, library)
    return block


def _continuum_shell_block(
    model: Model, group: ElementGroup, kind: ContinuumShellType, library: Library
) -> ElementBlock:
    section = group.section
    if not isinstance(section, ShellSection):
        raise DeckError(section.source, f"elements of type {group.type} need *SHELL SECTION")
    _check_nodes(group, kind.nodes)
    routine = continuum_shell_routine(model, group, kind, section, library)
    block = _nodal_block(model, group, kind, routine, library, shell_variables(section, kind, routine))
    block.initial.set_last(stack_directions(model, group, kind, section, library))
    _begin_surface_axes(model, group, kind, block, routine, library)
    return block


def _membrane_block(model: Model, group: ElementGroup, kind: MembraneType, library: Library) -> ElementBlock:
    section = group.section
    if not isinstance(section, MembraneSection):
        raise DeckError(section.source, f"elements of type {group.type} need *MEMBRANE SECTION")
    _check_nodes(group, kind.nodes)
    routine = membrane_routine(model, group, kind, section, library)
    block = _nodal_block(model, group, kind, routine, library, membrane_variables(kind, routine))
    _begin_surface_axes(model, group, kind, block, routine, library)
    return block


def _begin_surface_axes(
    model: Model,
    group: ElementGroup,
    kind: SurfaceType | ContinuumShellType,
    block: ElementBlock,
    routine: Routine,
    library: Library,
) -> None:
    """Set the initial directions of *ORIENTATION at the points of shells or membranes. Raises DeckError."""
    if routine.axes is not None:
        axes = start_axes(model, group, kind, routine.axes.orientation, library)
        # the direction that is projected, the next one, and that closest to the normal
        block.initial.begin_axes(np.roll(axes, -routine.axes.orientation.normal, axis=-2))


def _beam_block(model: Model, group: ElementGroup, kind: BeamType, library: Library) -> ElementBlock:
    section = group.section
    if not isinstance(section, BeamSection):
        raise DeckError(section.source, f"elements of type {group.type} need *BEAM SECTION")
    _check_nodes(group, kind.nodes)
    routine = beam_routine(model, group, kind, section, library)
    # moments in space are no derivatives by the rotation vector
    turns = kind.dimension == 3 and any(step.nlgeom for step in model.steps)
    variables = beam_variables(section, kind, routine)
    block = _nodal_block(model, group, kind, routine, library, variables, unsymmetric=turns)
    block.initial.set_last(start_directions(model, group, kind, section))
    return block


def _discrete_block(model: Model, group: ElementGroup, library: Library) -> ElementBlock:
    unknowns = discrete_unknowns(model, group)
    routine = discrete_routine(model, group, len(unknowns), library)
    return ElementBlock(
        group,
        model.mesh.coordinates,
        unknowns,
        routine,
        library,
        unsymmetric=False,
        variables=discrete_variables(group, routine),
    )


def _check_nodes(group: ElementGroup, nodes: int) -> None:
    if group.nodes.shape[1] != nodes:
        raise DeckError(group.source, f"elements of type {group.type} have {nodes} nodes, found {group.nodes.shape[1]}")


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
