# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in continuum shells for the driver (fortran/host/elements/shell/continuum.f90)."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from uel.elements.block import ElementBlock
from uel.elements.building import Building, begin_surface_axes, nodal_block
from uel.elements.directions import initial_axes
from uel.elements.families.shell import (
    check_section,
    define_section,
    hourglass_modulus,
    section_points,
    section_properties,
    section_stiffness,
    shear_stiffness,
    shell_variables,
)
from uel.elements.materials.library import shear_modulus
from uel.elements.routine import VALUES_OF_AXES, PointAxes, Routine
from uel.errors import DeckError
from uel.model.arrays import FloatArray
from uel.model.element_types import WEDGE6, ContinuumShellType, Tensor
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.properties import ElasticType, ShellSection
from uel.usersub import Library, _binding, built_in

POISSON: Final = 0.5
"""Default Poisson's ratio of the section (Abaqus Keywords Guide, *SHELL SECTION)."""


def continuum_shell_routine(
    model: Model, group: ElementGroup, kind: ContinuumShellType, section: ShellSection, library: Library
) -> Routine:
    """Build the routine of a group of continuum shells. Raises DeckError."""
    check_section(group, section)
    dynamic = any(step.procedure.inertia for step in model.steps)
    # nodes are on both faces
    section = replace(section, offset=0.0)
    points = section_points(section)
    stiffness = section_stiffness(section, points)
    poisson = _poisson(group, section)
    forces = 6 * kind.nodes if dynamic else 0
    of_points = len(points.place) * len(built_in.variables("section"))
    axes = PointAxes(of_points + forces, 1, False, section.orientation) if section.orientation else None
    hidden = forces + (VALUES_OF_AXES if axes else 0) + 1
    layers, common = define_section(section, points, 1, library)
    return replace(
        common,
        address=_binding.address_of("continuum shell"),
        jtype=kind.nodes,
        svars=of_points + hidden,
        hidden=hidden,
        props=built_in.reals(
            "continuum_shell",
            modulus=_thickness_modulus(group, section),
            transverse=poisson / (1 - poisson),
            **section_properties(
                section,
                points,
                section.shear or shear_stiffness(section, stiffness),
                hourglass_modulus(kind, section, stiffness),
            ),
        ),
        jprops=built_in.integers(
            "continuum_shell",
            family=kind.family.number,
            surface=kind.surface.number,
            sections=len(points.place),
            oriented=axes is not None,
            scaled=not section.shear,
            layers=layers,
        ),
        axes=axes,
    )


def stack_directions(
    model: Model, group: ElementGroup, kind: ContinuumShellType, section: ShellSection, library: Library
) -> FloatArray:
    """Return (m, 1) number of the parent coordinate from bottom to top of each element,
    negative if it points to the bottom.

    With STACK DIRECTION=ORIENTATION it is the one closest to the direction of the orientation that is the normal.
    """
    if kind.family is WEDGE6 and section.stack in (1, 2):
        message = f"STACK DIRECTION={section.stack} of elements of type {group.type}; expected 3 or ORIENTATION"
        raise DeckError(section.source, f"*SHELL SECTION: {message}")
    if section.stack is not None:
        return np.full((len(group.labels), 1), float(section.stack))
    assert section.orientation is not None
    normal = initial_axes(model, group, kind, section.orientation, library)[:, 0, section.orientation.normal - 1]
    _, _, slopes = _binding.integration_rule(kind.family.number, 1, kind.nodes, 3)
    along = np.einsum("mkd,ka->mad", model.mesh.coordinates[group.nodes], slopes[0])
    size = np.linalg.norm(along, axis=-1)
    cosine = np.einsum("mad,md->ma", along, normal) / np.where(size > 0, size, 1.0)
    if kind.family is WEDGE6:
        # of a wedge only the third one is across
        cosine[:, :2] = 0
    closest = np.abs(cosine).argmax(axis=1)
    sign = np.where(np.take_along_axis(cosine, closest[:, None], axis=1) < 0, -1.0, 1.0)
    return np.asarray(sign * (1 + closest[:, None]), dtype=np.float64)


def _thickness_modulus(group: ElementGroup, section: ShellSection) -> float:
    """Return the thickness modulus: by default twice the initial shear modulus in the plane,
    for layers its harmonic mean.

    Raises DeckError for UMAT, whose moduli are not known.
    """
    if section.modulus:
        return section.modulus
    flexibility = 0.0
    for layer in section.layers:
        if layer.material.elastic is None:
            message = f"elements of type {group.type} with *USER MATERIAL need THICKNESS MODULUS"
            raise DeckError(section.source, f"*SHELL SECTION: {message} (material {layer.material.name})")
        modulus = shear_modulus(layer.material.elastic, Tensor.PLANE_STRESS)
        flexibility += layer.thickness / (2 * modulus)
    return section.thickness / flexibility


def _poisson(group: ElementGroup, section: ShellSection) -> float:
    """Return Poisson's ratio of the section. Raises DeckError."""
    if section.poisson is None:
        return POISSON
    if section.poisson != "ELASTIC":
        return section.poisson
    elastic = [layer.material.elastic for layer in section.layers]
    ratios = {found.constants[1] for found in elastic if found is not None and found.type is ElasticType.ISOTROPIC}
    if len(ratios) != 1 or any(found is None or found.type is not ElasticType.ISOTROPIC for found in elastic):
        message = f"POISSON=ELASTIC of elements of type {group.type} is supported for one isotropic *ELASTIC"
        raise DeckError(section.source, f"*SHELL SECTION: {message}; expected a number")
    return ratios.pop()


def continuum_shell_block(building: Building, group: ElementGroup) -> ElementBlock:
    """Build the block of a group of continuum shells. Raises DeckError."""
    model, kind, section = building.model, group.built_in, group.section
    assert isinstance(kind, ContinuumShellType)
    assert isinstance(section, ShellSection)
    routine = continuum_shell_routine(model, group, kind, section, building.library)
    block = nodal_block(building, group, kind, routine, shell_variables(section, kind, routine))
    block.initial.set_last(stack_directions(model, group, kind, section, building.library))
    begin_surface_axes(building, group, kind, block, routine)
    return block
