# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in beams for the driver (fortran/host/elements/beam/beam.f90), their directions and loads."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from uel.elements.block import ElementBlock
from uel.elements.building import Building, nodal_block
from uel.elements.families.beam_points import SectionPoints, section_points, section_tensor
from uel.elements.families.beam_profiles import SHEAR_FACTORS, Profile, profile_of
from uel.elements.families.solid import history_names, history_of
from uel.elements.materials.library import (
    define_material,
    state_variables,
    user_outputs,
)
from uel.elements.node_normals import mean_normals
from uel.elements.routine import PARALLEL, Linearity, Routine
from uel.errors import DeckError, Source, unsupported
from uel.model.arrays import FloatArray, flat_rows
from uel.model.element_types import LINE2, BeamType, Tensor
from uel.model.mesh import ElementGroup, Mesh
from uel.model.model import Model
from uel.model.properties import BeamSection
from uel.model.records import PointVariables
from uel.model.steps import ElementLoad, LoadKind
from uel.usersub import Library, _binding, built_in

SLENDERNESS: Final = 0.25
"""Default slenderness compensation factor (Analysis User's Guide, Choosing a beam element)."""

QUADRATIC_SLENDERNESS: Final = 1e-4
"""Factor of the slenderness compensation in second-order elements."""

SMALLEST_SINE: Final = 1.745328e-3
"""Sine of 0.1 degrees, below which direction n1 is that of the axis."""

_WHOLE: Final = {
    2: ("SF1", "SF2", "SM1", "SE1", "SE2", "SK1"),
    3: (*("SF1", "SF2", "SF3", "SM1", "SM2", "SM3"), *("SE1", "SE2", "SE3", "SK1", "SK2", "SK3")),
}
"""Forces and strains of the section by the dimension: axial, shear along 2 and 1; about 1 and 2, twist."""


def beam_routine(model: Model, group: ElementGroup, kind: BeamType, section: BeamSection, library: Library) -> Routine:
    """Build the routine of a beam group. Raises DeckError."""
    _check(model, group, kind, section, library)
    profile = profile_of(section, kind.dimension)
    dynamic = any(step.procedure.inertia for step in model.steps)
    points = section_points(section, kind.dimension) if section.integrated else None
    sections = len(profile.points) if points is None else len(points.area)
    states = kind.points * max(1, sections) * len(_names(section, profile, kind))
    hidden = (2 * len(kind.dofs(0)) * kind.nodes if dynamic else 0) + 9 * (kind.points + _mass_points(kind))
    shear = section.shear or (SHEAR_FACTORS[section.profile] * section.shear_modulus * profile.area,) * 2
    stiffness = section_stiffness(section, profile, shear)
    if points is not None:
        by_points = [0, 3, 4, 5] if section_tensor(section, kind.dimension) is Tensor.TORSION else [0, 3, 4]
        stiffness[np.ix_(by_points, by_points)] = 0.0
    found = Routine(
        address=_binding.address_of("beam"),
        jtype=kind.nodes,
        mcrd=kind.dimension,
        svars=states + hidden,
        hidden=hidden,
        density=built_in.position("beam", "density"),
        props=built_in.reals(
            "beam",
            density=section.density,
            slenderness=_compensation(section, profile, kind),
            centroid=profile.centroid,
            shear_centre=profile.shear_centre,
            young=section.young,
            stiffness=stiffness,
            mass=section_mass(profile, isotropic=section.isotropic, plane=kind.dimension == 2),
            points=_values_of_points(profile, points),
        ),
        jprops=built_in.integers(
            "beam", family=kind.family.number, points=kind.points, sections=sections, mass_points=_mass_points(kind)
        ),
        linear=True,
        forces=Linearity.KNOWN,
        stores=True,
        free=tuple(range(1, kind.dimension + 1)),
        turns=True,
    )
    return found if points is None else _with_material(found, kind, section, sections, library)


def _values_of_points(profile: Profile, points: SectionPoints | None) -> list[float]:
    """Return the values of the section points for PROPS."""
    if points is None:
        return [value for point in profile.points for value in point[1:]]
    found: list[float] = np.column_stack([points.place, points.area, points.lever]).ravel().tolist()
    return found


def _with_material(found: Routine, kind: BeamType, section: BeamSection, sections: int, library: Library) -> Routine:
    """Complete the routine for a section over which its material is integrated. Raises DeckError."""
    material = section.material
    assert material is not None
    tensor = section_tensor(section, kind.dimension)
    outputs = user_outputs(material, library)
    number = define_material(material, None, tensor, section.source, library, outputs=outputs)
    return replace(
        found,
        material=number,
        tensor=int(tensor),
        history=history_of(material, kind.points * sections, outputs=outputs),
        statev=state_variables(material),
        outputs=outputs,
        linear=False,
        forces=Linearity.UNKNOWN,
        stores=False,
    )


def beam_variables(section: BeamSection, kind: BeamType, routine: Routine) -> PointVariables:
    """Describe the state variables of a beam group."""
    profile = profile_of(section, kind.dimension)
    numbers = [number for number, *_ in profile.points]
    # where a material is integrated, all section points are there, in the order of their numbers
    places = [number - 1 for number in numbers] if section.integrated else range(len(numbers))
    sections = max(1, int(routine.jprops[built_in.position("beam", "sections", "jprops")]))
    return PointVariables(
        "continuum",
        (*_names(section, profile, kind), *history_names(routine)),
        kind.points * sections,
        sections=sections,
        whole=_WHOLE[kind.dimension],
        numbers=tuple(zip(numbers, places, strict=True)),
    )


def _names(section: BeamSection, profile: Profile, kind: BeamType) -> tuple[str, ...]:
    """Return the names of the variables of a section point, then of its section."""
    components: tuple[str, ...] = ("11",) if profile.points else ()
    quantities = ["E", "S"]
    plastic = section.material is not None and section.material.plastic is not None
    if section.integrated and section_tensor(section, kind.dimension) is Tensor.TORSION:
        components = "11", "12"
    if plastic:
        quantities.append("PE")
    of_point = [quantity + component for quantity in quantities for component in components]
    return (*of_point, *(("PEEQ",) if plastic else ()), *_WHOLE[kind.dimension])


def _mass_points(kind: BeamType) -> int:
    return kind.family.full_points


def _compensation(section: BeamSection, profile: Profile, kind: BeamType) -> tuple[float, float]:
    """Return the factors by which slenderness reduces the shear stiffness along 2 and 1,
    over the squared element length.
    """
    factor = SLENDERNESS if section.slenderness is None else section.slenderness
    if kind.family is not LINE2:
        factor *= QUADRATIC_SLENDERNESS
    first, second, _ = profile.inertia
    of_second = factor * profile.area / (12 * second) if kind.dimension == 3 else 0.0
    return factor * profile.area / (12 * first), of_second


def section_stiffness(section: BeamSection, profile: Profile, shear: tuple[float, ...]) -> FloatArray:
    """Return the (6, 6) stiffness: SF1, SF2, SF3, SM1, SM2, SM3 by their strains."""
    first, second, product = profile.inertia
    stiffness = np.diag([section.young * profile.area, *shear, 0.0, 0.0, section.shear_modulus * profile.torsion])
    stiffness[3:5, 3:5] = section.young * np.array([[first, -product], [-product, second]])
    return stiffness


def section_mass(profile: Profile, *, isotropic: bool, plane: bool) -> FloatArray:
    """Return (6, 6) mass per length and density for translations and rotations of the nodes along and about t, 1, 2.

    isotropic: the same rotary inertia about all directions, with the centre of mass at the nodes (ROTARY INERTIA).
    """
    first, second, product = profile.inertia
    if isotropic:
        return np.diag([profile.area] * 3 + [first if plane else first + second] * 3)
    x, y = profile.centroid
    # displacements of the centroid by rotations of the section
    lever = np.array([[0.0, y, -x], [-y, 0.0, 0.0], [x, 0.0, 0.0]])
    about = np.array([[first + second, 0.0, 0.0], [0.0, first, -product], [0.0, -product, second]])
    to_centroid = np.hstack([np.eye(3), lever])
    mass: FloatArray = profile.area * to_centroid.T @ to_centroid
    mass[3:, 3:] += about
    return mass


def start_directions(model: Model, group: ElementGroup, kind: BeamType, section: BeamSection) -> FloatArray:
    """Return (m, values) directions t, 1, 2 at the integration points, then at those of the mass. Raises DeckError."""
    points = kind.points, _mass_points(kind)
    parts = [local_axes(group, kind, section, model.mesh.coordinates, count)[0] for count in points]
    return flat_rows(np.concatenate(parts, axis=1))


def with_normals(groups: tuple[ElementGroup, ...], mesh: Mesh) -> tuple[ElementGroup, ...]:
    """Return groups with normals n2 of beams in space at their nodes, where these differ from the elements' own.

    The approximate n1 is the vector from the first node to an additional one, or that of the section. At a node n2 is
    the direction that *NODE gives, or the mean of those of all beams there that are within 20 degrees
    (Analysis User's Guide, Beam element cross-section orientation).
    """
    beams = [
        k for k, group in enumerate(groups) if isinstance(group.built_in, BeamType) and group.built_in.dimension == 3
    ]
    if not beams:
        return groups
    own = [_own_directions(groups[k], mesh.coordinates) for k in beams]
    nodes = np.concatenate([groups[k].nodes.ravel() for k in beams])
    found = mean_normals(nodes, np.concatenate([n2.reshape(-1, 3) for _, n2 in own]), mesh.normals)
    made, first = list(groups), 0
    for k, (n1, n2) in zip(beams, own, strict=True):
        mine = found[first : first + groups[k].nodes.size].reshape(n2.shape)
        first += groups[k].nodes.size
        # a turn about n1 leaves the directions, which are normal to the axis; without own ones any normal counts
        alike = np.where(n2.any(axis=-1), np.einsum("mkd,mkd->mk", n2, mine), 1.0 - mine.any(axis=-1))
        turn = np.abs(np.einsum("mkd,mkd->mk", n1, mine))
        if groups[k].orienting is not None or (turn > PARALLEL).any() or (alike <= SMALLEST_SINE).any():
            made[k] = replace(groups[k], n2=mine)
    return tuple(made)


def _own_directions(group: ElementGroup, coordinates: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return (m, nodes, 3) n1 and n2 of elements at their nodes, from their approximate n1; zero where undefined."""
    kind, section = group.built_in, group.section
    assert isinstance(kind, BeamType) and isinstance(section, BeamSection)
    x = coordinates[group.nodes]
    slopes = [[-0.5, 0.5]] * 2 if kind.nodes == 2 else [[-1.5, 2, -0.5], [-0.5, 0, 0.5], [0.5, -2, 1.5]]
    t = _units(np.einsum("mjd,kj->mkd", x, np.array(slopes)))
    given = np.tile(section.n1, (len(x), 1))
    if group.orienting is not None:
        along = coordinates[group.orienting] - x[:, 0]
        given = np.where(group.orienting[:, None] >= 0, along, given)
    n2 = np.cross(t, _units(given)[:, None])
    n2 = _units(np.where(np.linalg.norm(n2, axis=-1, keepdims=True) > SMALLEST_SINE, n2, 0.0))
    return np.cross(n2, t), n2


def _units(vectors: FloatArray) -> FloatArray:
    size = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.where(size > 0, size, 1.0))


def local_axes(
    group: ElementGroup, kind: BeamType, section: BeamSection, coordinates: FloatArray, points: int
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return directions t, 1, 2 in rows (m, points, 3, 3), lengths (m, points) and places (m, points, 3) of points.

    The approximate n1 gives n2 = t x n1, unless the elements have it at their nodes, then n1 = n2 x t (Analysis User's
    Guide, Beam element cross-section orientation). Raises DeckError where an element has no length, or n1 or n2 is
    along the axis.
    """
    weights, shapes, slopes = _binding.integration_rule(kind.family.number, points, kind.nodes, 1)
    x = coordinates[group.nodes[:, list(kind.order)]]
    if kind.dimension == 2:
        x = x * [1.0, 1.0, 0.0]
    tangents = np.einsum("mkd,pk->mpd", x, slopes[:, :, 0])
    sizes = np.linalg.norm(tangents, axis=-1)
    if (lost := np.argwhere(~(sizes > 0))).size:
        raise _error(group, int(lost[0, 0]), group.source, "has no length; its nodes must follow each other")
    t = tangents / sizes[:, :, None]
    if group.n2 is None:
        given = np.array(section.n1 if kind.dimension == 3 else (0.0, 0.0, -1.0))
        n2, what = np.cross(t, given / np.linalg.norm(given)), "n1 = ({:g}, {:g}, {:g})".format(*section.n1)
        source, advice = section.source, "give another approximate n1 on the second data line"
    else:
        n2 = np.einsum("mkd,pk->mpd", group.n2[:, list(kind.order)], shapes)
        n2 -= np.einsum("mpd,mpd->mp", n2, t)[:, :, None] * t
        what = "n1 of its additional node, or n2 of its nodes"
        source, advice = group.source, "give another node, or other direction cosines on *NODE"
    sines = np.linalg.norm(n2, axis=-1)
    if (along := np.argwhere(~(sines > SMALLEST_SINE))).size:
        raise _error(group, int(along[0, 0]), source, f"lies along {what}; {advice}")
    n2 = n2 / sines[:, :, None]
    axes = np.stack([t, np.cross(n2, t), n2], axis=2)
    return axes, sizes * weights, np.einsum("mkd,pk->mpd", coordinates[group.nodes[:, list(kind.order)]], shapes)


def beam_forces(
    group: ElementGroup, kind: BeamType, rows: np.ndarray, load: ElementLoad, coordinates: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Compute for beams the forces that `unit_forces` of vectors.py returns: they act on the line of the nodes."""
    section = group.section
    assert isinstance(section, BeamSection)
    points = _mass_points(kind)
    axes, lengths, places = (values[rows] for values in local_axes(group, kind, section, coordinates, points))
    _, shapes, _ = _binding.integration_rule(kind.family.number, points, kind.nodes, 1)
    in_order = np.argsort(kind.order)
    direction = np.array(load.type.direction)
    force = axes.swapaxes(-1, -2) @ direction if load.type.kind is LoadKind.LOCAL_LINE else direction
    per_length = 1.0
    if load.type.kind in (LoadKind.BODY, LoadKind.GRAVITY):
        per_length = profile_of(section, kind.dimension).area
    if load.type.kind is LoadKind.GRAVITY:
        check_density(section, load.source, "GRAV")
        per_length *= section.density
    force = per_length * lengths[:, :, None] * np.broadcast_to(force, places.shape)
    shapes = shapes[:, in_order]
    return np.einsum("pk,mpd->mpkd", shapes, force[..., : kind.dimension]), places, shapes


def check_density(section: BeamSection, source: Source, what: str) -> None:
    """Raise DeckError if beams have no density."""
    if section.density:
        return
    if section.material is None:
        needed, owner = "DENSITY=", f"*BEAM GENERAL SECTION ({section.source})"
    else:
        needed, owner = "*DENSITY", f"material {section.material.name}"
    raise DeckError(source, f"{what} needs {needed}, which {owner} does not have")


def _check(model: Model, group: ElementGroup, kind: BeamType, section: BeamSection, library: Library) -> None:
    """Raise DeckError for what beams do not support, and warn, once for a section, of what they leave out."""
    nonlinear = next((step for step in model.steps if step.nlgeom), None)
    dynamic = any(step.procedure.inertia for step in model.steps)
    profile = profile_of(section, kind.dimension)
    _check_material(group, kind, section)
    if nonlinear is not None and dynamic and any(profile.centroid) and not section.isotropic:
        where = f"elements of type {group.type} whose centroid is beside their nodes"
        instead = "ROTARY INERTIA=ISOTROPIC leaves the offset out"
        raise unsupported(nonlinear.source, "*DYNAMIC with NLGEOM", where, instead=instead)
    if nonlinear is not None and section.poisson and group is next(g for g in model.groups if g.section is section):
        message = f"POISSON={section.poisson:g}: the area of beams does not change with their strain"
        library.warn(f"{section.source}: {message}")
    if dynamic:
        check_density(section, section.source, f"*DYNAMIC with elements of type {group.type}")
    first, second, product = profile.inertia
    if kind.dimension == 3 and not (first > 0 and second > 0 and first * second > product**2):
        message = f"I11 = {first:g}, I12 = {product:g}, I22 = {second:g}: beams in space need I11 I22 > I12^2"
        raise DeckError(section.source, message)


def _check_material(group: ElementGroup, kind: BeamType, section: BeamSection) -> None:
    """Raise DeckError for what beams of UMAT do not support."""
    if not section.integrated or section.material is None or section.material.user is None:
        return
    elements = f"elements of type {group.type}"
    if not section.shear:
        message = f"{elements} with *USER MATERIAL need *TRANSVERSE SHEAR STIFFNESS after *BEAM SECTION"
        raise DeckError(section.source, message)
    if kind.dimension == 3 and section_tensor(section, 3) is Tensor.UNIAXIAL:
        where = f"{elements} with SECTION={section.profile}"
        reason = "their torsion needs the shear modulus of *ELASTIC"
        raise unsupported(section.source, "*USER MATERIAL", where, reason=reason)


def _error(group: ElementGroup, row: int, source: Source, message: str) -> DeckError:
    return DeckError(source, f"element {group.labels[row]} (type {group.type}) {message}")


def beam_block(building: Building, group: ElementGroup) -> ElementBlock:
    """Build the block of a group of beams. Raises DeckError."""
    model, kind, section = building.model, group.built_in, group.section
    assert isinstance(kind, BeamType)
    assert isinstance(section, BeamSection)
    routine = beam_routine(model, group, kind, section, building.library)
    # moments in space are no derivatives by the rotation vector
    turns = kind.dimension == 3 and any(step.nlgeom for step in model.steps)
    block = nodal_block(building, group, kind, routine, beam_variables(section, kind, routine), unsymmetric=turns)
    block.initial.set_last(start_directions(model, group, kind, section))
    return block
