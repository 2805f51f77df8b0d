# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in continuum elements for the driver, and the meaning of their state variables."""

from __future__ import annotations

from typing import Final

import numpy as np

from uel.elements.block import ElementBlock
from uel.elements.building import Building
from uel.elements.directions import first_element, initial_axes
from uel.elements.materials.hybrid import has_unsymmetric_pressure, pressure_unknowns
from uel.elements.materials.library import (
    define_material,
    directions,
    has_unsymmetric_tangent,
    history_values,
    linearity,
    shear_modulus,
    state_variables,
    viscous_change,
)
from uel.elements.routine import VALUES_OF_AXES, OutputVariables, PointAxes, Routine
from uel.errors import DeckError
from uel.model.dofs import PRESSURE
from uel.model.element_types import HYBRID, ContinuumType, MembraneType, SolidType, Tensor
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.properties import (
    CompositeSection,
    ElasticType,
    Hyperelastic,
    Material,
    MembraneSection,
    Orientation,
    ShellSection,
    SolidSection,
    materials_of,
)
from uel.model.records import PointVariables
from uel.usersub import Library, _binding, built_in

HOURGLASS_FRACTION: Final = 0.005
"""Hourglass stiffness parameter over the shear modulus (Abaqus Analysis User's Guide, Section controls)."""

OF_MATERIAL: Final = 1
OF_FIRST_TANGENT: Final = 2
"""`enhanced` of JPROPS: source of the moduli of the enhanced hourglass control."""

_TOO_SOFT: Final = "; the stiffness of small strains is too soft for large ones"

SMALLEST_RADIUS: Final = 1e-9
"""Radius, over the largest one of a group, below which a node lies on the axis."""


def solid_section(group: ElementGroup) -> SolidSection:
    """Return the section of a group of solids or heat transfer elements."""
    assert isinstance(group.section, SolidSection)
    return group.section


def solid_of(group: ElementGroup) -> ContinuumType:
    """Return the type of a group of continuum elements, with temperatures or without."""
    kind = group.built_in
    assert isinstance(kind, ContinuumType)
    return kind


def section_depth(kind: SolidType, section: SolidSection | CompositeSection | ShellSection) -> float:
    """Return the factor from area to volume: the thickness in the plane, 2 pi about an axis,
    to be multiplied by the radius.
    """
    if kind.axisymmetric:
        return 2 * np.pi
    return section.thickness if isinstance(section, SolidSection) and kind.dimension == 2 else 1.0


def solid_routine(model: Model, group: ElementGroup, library: Library) -> Routine:
    """Build the routine of a group of solids. Raises DeckError."""
    kind, section = solid_of(group), solid_section(group)
    material = section.material
    if kind.axisymmetric:
        check_radii(model, group)
    dynamic = any(step.procedure.inertia for step in model.steps)
    local = _local_orientation(model, section)
    hourglass = 0.0
    if kind.hourglass_control:
        hourglass = hourglass_stiffness(kind, section, kind.tensor)
        if is_enhanced(section):
            _check_enhanced(kind, section)
    tangent = f"DDSDDE of UMAT (material {material.name})" if _of_tangent(kind, section) else ""
    warn_of_enhanced(model, group, kind, library, tangent)
    _warn_of_unpublished(model, group, kind, library)
    prestressed = is_prestressed(model, group, material)
    number = define_material(
        material,
        section.orientation,
        kind.tensor,
        section.source,
        library,
        hybrid=kind.pressures > 0,
        local=local is not None,
        prestressed=prestressed,
    )
    enhanced = _enhanced_moduli(kind, section)
    pressures = pressure_unknowns(kind, material)
    unknowns = kind.dimension * kind.nodes + pressures
    forces = 2 * unknowns if dynamic else 0
    of_points = kind.points * 2 * len(kind.components)
    axes = PointAxes(of_points + forces, kind.points, kind.dimension == 2, local) if local is not None else None
    moduli = 2 if enhanced == OF_FIRST_TANGENT else 0
    hidden = forces + (VALUES_OF_AXES * kind.points if axes else 0) + kind.modes + moduli
    return Routine(
        address=_binding.address_of("solid"),
        jtype=kind.nodes,
        mcrd=kind.dimension,
        svars=of_points + hidden,
        hidden=hidden,
        density=built_in.position("solid", "density"),
        internal=kind.modes,
        massive=bool(material.density),
        props=built_in.reals(
            "solid", depth=section_depth(kind, section), density=material.density, hourglass=hourglass
        ),
        jprops=built_in.integers(
            "solid",
            family=kind.family.number,
            points=kind.points,
            direct=kind.direct,
            enhanced=enhanced,
            mass_points=kind.mass_points,
            modes=kind.modes,
            pressures=kind.pressures,
        ),
        family=kind.family.number,
        material=number,
        tensor=int(kind.tensor),
        history=history_of(material, kind.points, prestressed=prestressed),
        statev=state_variables(material),
        viscous=viscous_change(material),
        uvarm=output_variables(section, kind.points, library),
        turns=True,
        linear=history_values(material) == 1 and material.hyperelastic is None,
        forces=linearity(material, prestressed=prestressed),
        # the energy of hourglass control is another one, and that of a pressure is not in the matrix
        stores=not kind.hourglass_control and not pressures,
        # along the radius it strains the circumference
        free=(2,) if kind.axisymmetric else tuple(range(1, kind.dimension + 1)),
        stress=_places_of_stress(kind),
        axes=axes,
    )


def _places_of_stress(kind: ContinuumType) -> tuple[int, ...]:
    """Return the places of the components in Abaqus' element library: 11, 22, 12 in plane stress, which has no 33."""
    names = kind.components
    return tuple(
        len(names) + k for k, name in enumerate(names) if not (kind.tensor is Tensor.PLANE_STRESS and name == "33")
    )


def is_prestressed(model: Model, group: ElementGroup, material: Material) -> bool:
    """Return whether the group has an initial stress that a built-in material must store."""
    first = first_element(model, group)
    last = first + len(group.labels)
    given = (entry.elements for entry in model.initial_stresses)
    return material.user is None and any(((elements >= first) & (elements < last)).any() for elements in given)


def _local_orientation(model: Model, section: SolidSection) -> Orientation | None:
    """Return the orientation if the material is in the directions of each point, which turn with it under NLGEOM,
    else None.

    Otherwise its constants are turned to global axes once.
    """
    orientation = section.orientation
    if orientation is None:
        return None
    turns = any(step.nlgeom for step in model.steps)
    return orientation if turns or orientation.system is not None or section.material.user is not None else None


def solid_variables(group: ElementGroup, routine: Routine) -> PointVariables:
    """Describe the state variables of a group of solids."""
    kind = solid_of(group)
    names = tuple(f"{letter}{component}" for letter in "ES" for component in kind.components)
    names = *names, *numbered("SDV", routine.statev)
    if routine.uvarm is not None:
        names = *names, *numbered("UVARM", routine.uvarm.count)
    return PointVariables("continuum", names, kind.points)


def check_radii(model: Model, group: ElementGroup) -> None:
    """Check that nodes of axisymmetric elements are on one side of the axis or, within rounding, on it."""
    radii = model.mesh.coordinates[group.nodes, 0]
    wrong = np.argwhere(radii < -SMALLEST_RADIUS * abs(radii).max(initial=0.0))
    if len(wrong):
        row, column = wrong[0]
        label = model.mesh.labels[group.nodes[row, column]]
        message = (
            f"element {group.labels[row]} (type {group.type}): node {label} is at the radius {radii[row, column]:g}"
        )
        raise DeckError(group.source, f"{message}; coordinate 1 of axisymmetric elements must not be negative")


def history_of(material: Material, points: int, *, prestressed: bool = False, outputs: int = 0) -> tuple[int, int]:
    """Return values per point and points of the material history of an element,
    which may have an initial stress and UVAR.
    """
    values = history_values(material, prestressed=prestressed) + outputs
    return values, points if values > 1 else 1


def hourglass_stiffness(
    kind: ContinuumType | MembraneType, section: SolidSection | CompositeSection | MembraneSection, tensor: Tensor
) -> float:
    """Return the total stiffness parameter, by default from the mean shear modulus of the layers; 0 if the hourglass
    control is not of total stiffness. Raises DeckError.
    """
    check_one_control(section)
    if section.hourglass or is_enhanced(section):
        return section.hourglass
    moduli = []
    for material in materials_of(section):
        what = "*USER MATERIAL" if material.hyperelastic is None else f"*{material.hyperelastic.keyword}"
        if material.elastic is None:
            enhanced = isinstance(material.hyperelastic, Hyperelastic)
            need = "need HOURGLASS=ENHANCED of *SECTION CONTROLS, or" if enhanced else "need"
            reason = "" if material.hyperelastic is None else _TOO_SOFT
            message = (
                f"elements of type {kind.name} with {what} {need} *HOURGLASS STIFFNESS after *{kind.section}{reason}"
            )
            raise DeckError(section.source, message)
        moduli.append(shear_modulus(material.elastic, tensor))
    weights = [layer.thickness for layer in section.layers] if isinstance(section, CompositeSection) else None
    return float(section.controls.hourglass * HOURGLASS_FRACTION * np.average(moduli, weights=weights))


def is_enhanced(section: SolidSection | CompositeSection | MembraneSection) -> bool:
    """Return whether the hourglass control is ENHANCED, the default with *HYPERELASTIC (Keywords Guide,
    *SECTION CONTROLS).
    """
    if section.controls.enhanced is not None:
        return section.controls.enhanced
    by_default = isinstance(section, SolidSection) and isinstance(section.material.hyperelastic, Hyperelastic)
    return by_default and not section.hourglass


def check_one_control(section: SolidSection | CompositeSection | MembraneSection) -> None:
    """Raise DeckError if two keywords give the hourglass control."""
    controls = section.controls
    if section.hourglass and (controls.enhanced or controls.hourglass != 1):
        what = "HOURGLASS=ENHANCED" if controls.enhanced else "a factor of the hourglass stiffness"
        raise DeckError(
            section.source, f"*HOURGLASS STIFFNESS and *SECTION CONTROLS with {what}: expected only one of them"
        )


def _check_enhanced(kind: ContinuumType, section: SolidSection) -> None:
    """Raise DeckError if there is no enhanced hourglass control for the material."""
    material, elastic = section.material, section.material.elastic
    if isinstance(material.hyperelastic, Hyperelastic) or _of_tangent(kind, section):
        return
    if elastic is None or elastic.type is not ElasticType.ISOTROPIC or elastic.table is not None:
        message = f"*SECTION CONTROLS, HOURGLASS=ENHANCED is not supported for material {material.name}"
        raise DeckError(section.source, f"{message}; expected *ELASTIC, TYPE=ISOTROPIC with constant values")


def _enhanced_moduli(kind: ContinuumType, section: SolidSection) -> int:
    """Return `enhanced` of JPROPS: 0 without the enhanced hourglass control, else the source of its moduli."""
    if not (kind.hourglass_control and is_enhanced(section)):
        return 0
    return OF_FIRST_TANGENT if _of_tangent(kind, section) else OF_MATERIAL


def _of_tangent(kind: ContinuumType, section: SolidSection) -> bool:
    """Return whether the moduli follow from the tangent of UMAT alone, and it is all of the element's stiffness."""
    return section.material.user is not None and not pressure_unknowns(kind, section.material)


def warn_of_enhanced(
    model: Model, group: ElementGroup, kind: ContinuumType, library: Library, tangent: str = ""
) -> None:
    """Warn, once per section, of the basis of the enhanced hourglass control; tangent: the source of its moduli."""
    section = group.section
    assert isinstance(section, SolidSection | CompositeSection)
    if not (is_enhanced(section) and kind.hourglass_control):
        return
    if group is next(other for other in model.groups if other.section is section):
        message = "*SECTION CONTROLS, HOURGLASS=ENHANCED: the published method that Abaqus' manual names"
        if tangent:
            message += f", with the isotropic part of the first {tangent}"
        known = "there are no results of Abaqus to compare with"
        if isinstance(section, SolidSection) and section.material.hyperelastic is not None:
            known = "the rule was chosen by one public job of Abaqus, whose deformation gradients it meets to 0.03"
        library.warn(f"{section.source}: {message}; {known}")


def _warn_of_unpublished(model: Model, group: ElementGroup, kind: ContinuumType, library: Library) -> None:
    """Warn, once per type, of elements whose formulation in Abaqus is not published, and name the one used here."""
    if group is not next(other for other in model.groups if other.type == group.type):
        return
    if kind.modified:
        plain = kind.name.replace("M", "")
        same = "the interpolation, the pressure and the mass" if kind.pressures else "the interpolation and the mass"
        difference = f"have {same} of {plain} here; that of Abaqus is not published, and differs on coarse meshes"
    elif kind is HYBRID["C3D4H"]:
        linear = "how Abaqus has a linear one is not published"
        difference = f"have a constant pressure here, so that a mesh of them alone is too stiff; {linear}"
    else:
        return
    library.warn(f"{group.source}: elements of type {kind.name} {difference}")


def output_variables(section: SolidSection, points: int, library: Library) -> OutputVariables | None:
    """Return UVARM of a material; None if the job has none: then only its variables are left out."""
    material = section.material
    if not material.output_variables or library.uvarm is None:
        return None
    axes, name = directions(section.orientation)
    return OutputVariables(
        library.uvarm, (material.name, name), axes, points, material.output_variables, material.plastic is not None
    )


def history_names(routine: Routine) -> tuple[str, ...]:
    """Return the names of the output variables in the history of a point."""
    return *numbered("UVARM", routine.outputs), *numbered("SDV", routine.statev)


def numbered(name: str, count: int) -> tuple[str, ...]:
    """Return this many names of variables, numbered from 1."""
    return tuple(f"{name}{number}" for number in range(1, count + 1))


def solid_block(building: Building, group: ElementGroup) -> ElementBlock:
    """Build the block of a group of continuum elements. Raises DeckError."""
    return continuum_block(building, group, solid_routine(building.model, group, building.library))


def continuum_block(
    building: Building,
    group: ElementGroup,
    routine: Routine,
    more: tuple[tuple[int, int], ...] = (),
    *,
    unsymmetric: bool = False,
    variables: PointVariables | None = None,
) -> ElementBlock:
    """Build the block of a routine of continuum elements: displacements, then further unknowns, then pressures.

    unsymmetric: their matrix is, even if that of the material is not; variables: other ones than those of solids.
    """
    kind, section = solid_of(group), solid_section(group)
    material = section.material
    unknowns = tuple((node, dof) for node in range(kind.nodes) for dof in range(1, kind.dimension + 1)) + more
    unknowns += tuple((kind.nodes, PRESSURE + k) for k in range(pressure_unknowns(kind, material)))
    block = ElementBlock(
        group,
        building.model.mesh.coordinates,
        unknowns,
        routine,
        building.library,
        unsymmetric=unsymmetric or has_unsymmetric_tangent(material) or has_unsymmetric_pressure(kind, material),
        variables=variables or solid_variables(group, routine),
    )
    if routine.axes is not None:
        axes = initial_axes(building.model, group, kind, routine.axes.orientation, building.library)
        block.initial.begin_axes(axes)
    return block
