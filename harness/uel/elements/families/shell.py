# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in conventional shells for the driver (fortran/host/elements/shell/shell.f90).

Sections of shells, which continuum shells have too.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from uel.elements.block import ElementBlock
from uel.elements.building import Building, begin_surface_axes, nodal_block
from uel.elements.families.solid import HOURGLASS_FRACTION, history_names
from uel.elements.materials.library import (
    define_material,
    global_compliance,
    history_values,
    linearity,
    shear_modulus,
    state_variables,
    user_outputs,
)
from uel.elements.node_normals import LARGEST_ANGLE, mean_normals
from uel.elements.routine import VALUES_OF_AXES, Linearity, PointAxes, Routine
from uel.elements.simpson import simpson
from uel.errors import DeckError
from uel.model.arrays import FloatArray, IntArray, flat_rows
from uel.model.element_types import ContinuumShellType, ShellType, Tensor
from uel.model.mesh import ElementGroup, full_name
from uel.model.model import Model
from uel.model.properties import ShellLayer, ShellSection
from uel.model.records import PointVariables
from uel.usersub import Library, _binding, built_in

SLENDERNESS: Final = 0.25e-4
"""Default slenderness factor of the transverse shear stiffness (Analysis User's Guide, Shell section behavior)."""

OPPOSITE_ANGLE: Final = 160.0
"""Degrees between a normal of the deck and that of an element above which Abaqus turns the element over."""

ROTATIONAL_FRACTION: Final = 0.00375
"""Rotational hourglass stiffness over the shear modulus, r_theta (Abaqus Analysis User's Guide, Section controls)."""

DRILLING: Final = 1e-3
"""Stiffness against drilling over that of transverse shear; with more, coarse meshes of thin warped shells lock."""


@dataclass(frozen=True, slots=True)
class SectionPoints:
    """Section points from SNEG to SPOS: place and weight (length), layer from 0, number in the layer from 1."""

    place: FloatArray
    weight: FloatArray
    layer: np.ndarray
    number: np.ndarray


def shell_routine(
    model: Model, group: ElementGroup, kind: ShellType, section: ShellSection, library: Library
) -> Routine:
    """Build the routine of a shell group. Raises DeckError."""
    check_section(group, section)
    dynamic = any(step.procedure.inertia for step in model.steps)
    points = section_points(section)
    forces = 12 * kind.nodes if dynamic else 0
    of_points = kind.points * len(points.place) * len(built_in.variables("section"))
    axes = PointAxes(of_points + forces, kind.points, False, section.orientation) if section.orientation else None
    hidden = forces + (VALUES_OF_AXES * kind.points if axes else 0) + 3 * kind.nodes
    stiffness = section_stiffness(section, points)
    shear = section.shear or shear_stiffness(section, stiffness)
    layers, common = define_section(section, points, kind.points, library)
    drilling = _drilling_of_reduced(section) if kind.hourglass_control else DRILLING * (shear[0] + shear[1]) / 2
    return replace(
        common,
        address=_binding.address_of("shell"),
        jtype=kind.nodes,
        svars=of_points + hidden,
        hidden=hidden,
        props=built_in.reals(
            "shell",
            **section_properties(section, points, shear, hourglass_modulus(kind, section, stiffness)),
            drilling=drilling,
            middle=-section.offset * section.thickness,
            hourglass=_hourglass_moduli(kind, section),
        ),
        jprops=built_in.integers(
            "shell",
            family=kind.family.number,
            points=kind.points,
            sections=len(points.place),
            oriented=axes is not None,
            layers=layers,
        ),
        axes=axes,
    )


def define_section(
    section: ShellSection, points: SectionPoints, along: int, library: Library
) -> tuple[IntArray, Routine]:
    """Define the materials of the section, and return material, layer and point in the layer of each section point,
    with their part of a routine.

    along: integration points of the surface.
    """
    materials = {layer.material.name: layer.material for layer in section.layers}
    statev = max(map(state_variables, materials.values()))
    outputs = max(user_outputs(material, library) for material in materials.values())
    place, plane = section.source, Tensor.PLANE_STRESS
    numbers = {
        name: define_material(
            material, section.orientation, plane, place, library, local=True, room=statev, outputs=outputs
        )
        for name, material in materials.items()
    }
    of_layers = np.array([numbers[layer.material.name] for layer in section.layers])
    # UVAR and STATEV are behind what any of the materials has of other values
    values = (
        outputs + statev + max(history_values(material) - state_variables(material) for material in materials.values())
    )
    known = all(linearity(material) is Linearity.KNOWN for material in materials.values())
    common = Routine(
        address=0,
        jtype=0,
        mcrd=3,
        svars=0,
        density=built_in.position("section", "density"),
        props=np.zeros(0),
        jprops=np.zeros(0, dtype=np.int64),
        material=next(iter(numbers.values())),
        tensor=int(Tensor.PLANE_STRESS),
        history=(values, along * len(points.place) if values > 1 else 1),
        statev=statev,
        outputs=outputs,
        linear=values == 1,
        forces=Linearity.KNOWN if known else Linearity.UNKNOWN,
        free=(1, 2, 3),
        turns=True,
    )
    return np.column_stack([of_layers[points.layer], points.layer + 1, points.number]).ravel(), common


def section_properties(
    section: ShellSection, points: SectionPoints, shear: tuple[float, ...], stiffness: FloatArray
) -> dict[str, ArrayLike]:
    """Return the values of PROPS that all shells have."""
    angles = np.radians([section.layers[k].angle for k in points.layer.tolist()])
    return {
        "thickness": section.thickness,
        "density": section.density,
        "shear": shear,
        "slenderness": SLENDERNESS if section.slenderness is None else section.slenderness,
        "stiffness": stiffness,
        "points": np.column_stack([points.place, points.weight, angles]),
    }


def shell_variables(section: ShellSection, kind: ShellType | ContinuumShellType, routine: Routine) -> PointVariables:
    """Describe the state variables of a group of shells, conventional or continuum shells."""
    sections = sum(layer.points for layer in section.layers)
    names = built_in.variables("section")
    whole = names[names.index("SF1") :]
    names = *names, *history_names(routine)
    return PointVariables("continuum", names, kind.points * sections, sections=sections, whole=whole)


def directors(model: Model, group: ElementGroup) -> FloatArray:
    """Compute (m, nodes, 3) directors of a shell group at its nodes: unit normals.

    At a node it is the mean of the normals there of all shells whose normal is within 20 degrees of that of the element
    (Analysis User's Guide, Defining the initial geometry of conventional shell elements). The normal of an element
    without area is zero. Normals of the deck take the place of the mean.
    """
    x, nodes, normals, first = model.mesh.coordinates, [], [], 0
    mine = slice(0, 0)
    for other in model.groups:
        if not isinstance(other.built_in, ShellType):
            continue
        family = other.built_in.family
        slopes = _binding.slopes_at_nodes(family.number, family.nodes)
        area = np.cross(*np.einsum("mkd,pka->ampd", x[other.nodes], slopes))
        size = np.linalg.norm(area, axis=-1, keepdims=True)
        normals.append((area / np.where(size > 0, size, 1.0)).reshape(-1, 3))
        nodes.append(other.nodes.ravel())
        if other is group:
            mine = slice(first, first + other.nodes.size)
        first += other.nodes.size
    found = mean_normals(np.concatenate(nodes), np.concatenate(normals), model.mesh.normals)
    return np.asarray(found[mine].reshape(*group.nodes.shape, 3))


def check_normals(model: Model, group: ElementGroup, kind: ShellType, library: Library) -> None:
    """Warn of normals of the deck far from those of the elements. Raises DeckError where they oppose them."""
    if model.mesh.normals is None:
        return
    given = model.mesh.normals[group.nodes]
    size = np.linalg.norm(given, axis=-1)
    slopes = _binding.slopes_at_nodes(kind.family.number, kind.nodes)
    area = np.cross(*np.einsum("mkd,pka->ampd", model.mesh.coordinates[group.nodes], slopes))
    scale = size * np.linalg.norm(area, axis=-1)
    cosine = np.where(scale > 0, np.einsum("mkd,mkd->mk", given, area), 1.0) / np.where(scale > 0, scale, 1.0)
    for limit, fatal in ((np.cos(np.radians(OPPOSITE_ANGLE)), True), (np.cos(np.radians(LARGEST_ANGLE)), False)):
        far = np.argwhere(cosine < limit)
        if not len(far):
            continue
        row, place = far[0].tolist()
        angle = np.degrees(np.arccos(max(float(cosine[row, place]), -1.0)))
        what = f"the normal of node {model.mesh.name(int(group.nodes[row, place]))} is {angle:.0f} degrees from that of"
        message = f"{what} element {full_name(group.instance, int(group.labels[row]))} (type {group.type})"
        if fatal:
            raise DeckError(group.source, f"{message}; Abaqus would turn the element over: number its nodes backwards")
        more = f", and {len(far) - 1} more" if len(far) > 1 else ""
        library.warn(f"{group.source}: {message}{more}")


def section_points(section: ShellSection) -> SectionPoints:
    """Return the section points; those of Simpson's rule are on both sides of the surfaces where layers meet."""
    bottom = -(0.5 + section.offset) * section.thickness
    places, weights = [], []
    for layer in section.layers:
        if section.gauss:
            at, weight = np.polynomial.legendre.leggauss(layer.points)
            at, weight = (1 + at) / 2, weight / 2
        else:
            at, weight = simpson(layer.points)
        places.append(bottom + layer.thickness * at)
        weights.append(layer.thickness * weight)
        bottom += layer.thickness
    counts = [layer.points for layer in section.layers]
    layers = np.repeat(np.arange(len(counts)), counts)
    numbers = np.concatenate([np.arange(1, count + 1) for count in counts])
    return SectionPoints(np.concatenate(places), np.concatenate(weights), layers, numbers)


def section_stiffness(section: ShellSection, points: SectionPoints) -> FloatArray:
    """Return (6, 6) forces and moments of the elastic section by membrane strains and curvatures;
    layers of UMAT add zero.
    """
    found = np.zeros((6, 6))
    moduli = [_layer_modulus(layer) for layer in section.layers]
    for place, weight, layer in zip(points.place, points.weight, points.layer.tolist(), strict=True):
        found += weight * np.kron([[1, place], [place, place**2]], moduli[layer])
    return found


def shear_stiffness(section: ShellSection, stiffness: FloatArray) -> tuple[float, float, float]:
    """Compute K11, K22 and K12 of elastic layers.

    The shear stress is in equilibrium with the bending stress that a moment alone has, whose slope is the shear force:
    no other moment and no force changes along the direction. Its energy is that of the forces by 1/K.
    """
    by_force = np.asarray(np.linalg.inv(stiffness)[:, [3, 4]], dtype=np.float64)
    bottom = -(0.5 + section.offset) * section.thickness
    flexibility, below = np.zeros((2, 2)), np.zeros((2, 2))
    # the energy is of the fourth order in the place
    at, weights = np.polynomial.legendre.leggauss(3)
    for layer in section.layers:
        modulus, compliance = _layer_modulus(layer), _shear_compliance(layer)
        for place, weight in zip((1 + at) / 2 * layer.thickness, weights / 2 * layer.thickness, strict=True):
            stress = below - _bending_force(modulus, by_force, bottom, bottom + place)
            flexibility += weight * stress.T @ compliance @ stress
        below = below - _bending_force(modulus, by_force, bottom, bottom + layer.thickness)
        bottom += layer.thickness
    found = np.linalg.inv(flexibility)
    return float(found[0, 0]), float(found[1, 1]), float(found[0, 1])


def _bending_force(modulus: FloatArray, strains: FloatArray, start: float, end: float) -> FloatArray:
    """Return (13 or 23, force) change of the in-plane force of a part of a layer along directions 1 and 2."""
    forces = modulus @ (strains[:3] * (end - start) + strains[3:] * (end**2 - start**2) / 2)
    return np.array([[forces[0, 0], forces[2, 1]], [forces[2, 0], forces[1, 1]]])


def hourglass_modulus(kind: ShellType | ContinuumShellType, section: ShellSection, stiffness: FloatArray) -> FloatArray:
    """Return the (6, 6) elastic stiffness of the section for enhanced modes and the enhanced hourglass control.

    Raises DeckError.
    """
    user = any(layer.material.user is not None for layer in section.layers)
    if kind.hourglass_control and user and not section.hourglass:
        message = f"elements of type {kind.name} with *USER MATERIAL need *HOURGLASS STIFFNESS after *SHELL SECTION"
        raise DeckError(section.source, message)
    if not user and not (kind.hourglass_control and section.hourglass):
        return stiffness * (section.controls.hourglass if kind.hourglass_control else 1.0)
    # that of a Poisson's ratio of zero; of the shear modulus, S4 needs no more than that it is there
    shear, middle = (section.hourglass or 1.0) / HOURGLASS_FRACTION, -section.offset * section.thickness
    second = section.thickness**3 / 12 + section.thickness * middle**2
    parts = [[section.thickness, section.thickness * middle], [section.thickness * middle, second]]
    return np.asarray(np.kron(parts, shear * np.diag([2.0, 2.0, 1.0])), dtype=np.float64)


def _shear_integrals(section: ShellSection) -> FloatArray:
    """Return (2,) integrals of G and of G z^2 over the thickness,
    with shear modulus G and z from the surface of the nodes.

    With layers of UMAT the modulus is that of *HOURGLASS STIFFNESS over 0.005.
    """
    bottom = -(0.5 + section.offset) * section.thickness
    found = np.zeros(2)
    for layer in section.layers:
        elastic, top = layer.material.elastic, bottom + layer.thickness
        modulus = section.hourglass / HOURGLASS_FRACTION
        if elastic is not None and layer.material.user is None:
            modulus = shear_modulus(elastic, Tensor.PLANE_STRESS)
        found += modulus * np.array([layer.thickness, (top**3 - bottom**3) / 3])
        bottom = top
    return found


def _hourglass_moduli(kind: ShellType, section: ShellSection) -> FloatArray:
    """Return (2,) moduli of the membrane and of the rotations in the total stiffness of S4R; zero for other controls.

    They are in fortran/host/elements/shell/hourglass.f90.
    """
    controls = section.controls
    if not kind.hourglass_control or controls.enhanced:
        return np.zeros(2)
    integrals = _shear_integrals(section)
    membrane = section.hourglass * section.thickness or controls.hourglass * HOURGLASS_FRACTION * integrals[0]
    rotations = controls.hourglass_rotation * 48 * ROTATIONAL_FRACTION * integrals[1]
    if section.hourglass_rotation:
        rotations = 4 * section.hourglass_rotation * section.thickness**3
    return np.array([membrane, rotations])


def _drilling_of_reduced(section: ShellSection) -> float:
    """Return D of fortran/host/elements/shell/hourglass.f90: a sixth of the in-plane shear stiffness of the section."""
    return float(section.drilling * _shear_integrals(section)[0] / 6)


def _layer_modulus(layer: ShellLayer) -> FloatArray:
    """Return the (3, 3) stiffness in plane stress, along the directions of the section; zero for UMAT."""
    compliance = global_compliance(layer.material, None, Tensor.PLANE_STRESS)
    if compliance is None:
        return np.zeros((3, 3))
    places = [0, 1, 3]
    turn = _strain_turn(layer.angle)
    return np.asarray(turn.T @ np.linalg.inv(compliance[np.ix_(places, places)]) @ turn, dtype=np.float64)


def _shear_compliance(layer: ShellLayer) -> FloatArray:
    """Return (2, 2) strains 13, 23 by stresses, along the directions of the section."""
    compliance = global_compliance(layer.material, None, Tensor.PLANE_STRESS)
    assert compliance is not None
    c, s = np.cos(np.radians(layer.angle)), np.sin(np.radians(layer.angle))
    turn = np.array([[c, s], [-s, c]])
    return np.asarray(turn.T @ compliance[4:, 4:] @ turn)


def _strain_turn(degrees: float) -> FloatArray:
    """Return the (3, 3) matrix that turns strains 11, 22, 12 (engineering) to axes at an angle."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]])


def check_section(group: ElementGroup, section: ShellSection) -> None:
    """Raise DeckError if layers of UMAT leave the transverse shear stiffness unknown."""
    if any(layer.material.user is not None for layer in section.layers) and not section.shear:
        message = (
            f"elements of type {group.type} with *USER MATERIAL need *TRANSVERSE SHEAR STIFFNESS after *SHELL SECTION"
        )
        raise DeckError(section.source, message)


def shell_block(building: Building, group: ElementGroup) -> ElementBlock:
    """Build the block of a group of shells. Raises DeckError."""
    model, kind, section = building.model, group.built_in, group.section
    assert isinstance(kind, ShellType)
    assert isinstance(section, ShellSection)
    routine = shell_routine(model, group, kind, section, building.library)
    # moments are no derivatives by rotation vectors
    turns = any(step.nlgeom for step in model.steps)
    block = nodal_block(building, group, kind, routine, shell_variables(section, kind, routine), unsymmetric=turns)
    check_normals(model, group, kind, building.library)
    block.initial.set_last(flat_rows(directors(model, group)))
    begin_surface_axes(building, group, kind, block, routine)
    return block
