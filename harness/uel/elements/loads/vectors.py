# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Consistent nodal forces of loads on faces and volumes of built-in elements, in their initial shape."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import numpy as np

from uel.elements.families.beam import beam_forces
from uel.elements.families.solid import section_depth, solid_of
from uel.errors import DeckError, Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import BeamType, ContinuumType, Face, Family, ShellType, SurfaceType
from uel.model.mesh import ElementGroup
from uel.model.properties import CompositeSection, Material, MembraneSection, ShellSection, SolidSection, materials_of
from uel.model.steps import ON_EDGES, ElementLoad, LoadKind
from uel.usersub import _binding

SMALLEST_SINE: Final = 1e-10
"""Sine of the angle between a direction and a face's normal below which the direction has no tangential part."""


def unit_forces(
    group: ElementGroup, rows: IntArray, load: ElementLoad, coordinates: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Compute nodal forces (elements, points, nodes of the face or element,
    dimension) for a magnitude of one at each point.

    rows are elements of the group. Also returns the coordinates of the points (elements, points, 3), and the functions
    (points, nodes) that they follow from. Raises DeckError if the load makes no sense there.
    """
    match group.built_in:
        case ShellType() as kind if load.type.kind in ON_EDGES:
            return _forces_on_edges(group, kind, rows, load, coordinates)
        case SurfaceType() as kind:
            return _forces_on_surfaces(group, kind, rows, load, coordinates)
        case BeamType() as kind:
            return beam_forces(group, kind, rows, load, coordinates)
        case _:
            return _forces_on_solids(group, rows, load, coordinates)


def _forces_on_solids(
    group: ElementGroup, rows: IntArray, load: ElementLoad, coordinates: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    section = group.section
    assert isinstance(section, SolidSection | CompositeSection | ShellSection)
    kind = solid_of(group)
    dimension = kind.dimension
    local = list(load.type.face) or list(range(group.nodes.shape[1]))
    nodes = group.nodes[rows]
    x = coordinates[nodes[:, local], :dimension]
    if load.type.face:
        weights, shapes, derivatives = _face_rule(kind, load.type.face)
    else:
        weights, shapes, derivatives = _rule(kind.family, kind.body_points)
    # (elements, points, dimension, along) derivatives of the position
    tangents = np.einsum("mkd,pka->mpda", x, derivatives)
    scale = section_depth(kind, section)
    if load.type.kind is LoadKind.GRAVITY:
        check_density(materials_of(section), load.source, "GRAV")
        # layers of solids have the same density
        scale *= section.density if isinstance(section, ShellSection) else materials_of(section)[0].density
    if not load.type.face:
        force = np.linalg.det(tangents)[:, :, None] * np.array(load.type.direction)[:dimension]
    else:
        centre = coordinates[nodes, :dimension].mean(axis=1)
        force = _traction(load, _outward(tangents, x.mean(axis=1) - centre))
    places = np.einsum("pk,mkd->mpd", shapes, coordinates[nodes[:, local]])
    if kind.axisymmetric:
        force = places[:, :, :1] * force
    return scale * np.einsum("p,pk,mpd->mpkd", weights, shapes, force), places, shapes


def _forces_on_surfaces(
    group: ElementGroup, kind: SurfaceType, rows: IntArray, load: ElementLoad, coordinates: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    section = group.section
    assert isinstance(section, ShellSection | MembraneSection)
    local = list(load.type.face) or list(range(kind.nodes))
    x = coordinates[group.nodes[rows][:, local]]
    weights, shapes, derivatives = _rule(kind.family, kind.full_points)
    area = _normal(np.einsum("mkd,pka->mpda", x, derivatives))
    if load.type.face:
        force = _traction(load, area)
    else:
        per_area = section.thickness
        if load.type.kind is LoadKind.GRAVITY:
            check_density(materials_of(section), load.source, "GRAV")
            per_area = section.mass
        force = per_area * np.linalg.norm(area, axis=-1, keepdims=True) * np.array(load.type.direction)
    return np.einsum("p,pk,mpd->mpkd", weights, shapes, force), np.einsum("pk,mkd->mpd", shapes, x), shapes


def _forces_on_edges(
    group: ElementGroup, kind: ShellType, rows: IntArray, load: ElementLoad, coordinates: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Compute forces per length: EDSHR along the edge, EDNOR into the shell,
    EDTRA against its normal (Analysis User's Guide).
    """
    local = list(load.type.face)
    x = coordinates[group.nodes[rows]]
    slopes = _binding.slopes_at_nodes(kind.family.number, kind.nodes)[local]
    normals = _normal(np.einsum("mkd,nka->mnda", x, slopes))
    edge = kind.family.face_family(load.type.face)
    weights, shapes, derivatives = _rule(edge, edge.full_points)
    along = np.einsum("mkd,pk->mpd", x[:, local], derivatives[:, :, 0])
    length = np.linalg.norm(along, axis=-1, keepdims=True)
    normal = np.einsum("mkd,pk->mpd", normals, shapes)
    normal = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    match load.type.kind:
        case LoadKind.EDGE_SHEAR:
            force = along
        case LoadKind.EDGE_TRANSVERSE:
            force = -length * normal
        case LoadKind.EDGE_NORMAL:
            force = np.cross(normal, along)
        case _:
            force = length * np.array(load.type.direction)
    places = np.einsum("pk,mkd->mpd", shapes, x[:, local])
    return np.einsum("p,pk,mpd->mpkd", weights, shapes, force), places, shapes


def check_density(materials: Iterable[Material], source: Source, what: str) -> None:
    """Raise DeckError if a material has no density."""
    for material in materials:
        if not material.density:
            raise DeckError(source, f"{what} needs *DENSITY, which material {material.name} does not have")


def outward_sign(group: ElementGroup, row: int, face: tuple[int, ...], coordinates: FloatArray) -> int:
    """Return 1 if the normal by the order of a face's nodes (right of an edge) points out of the element, else -1."""
    kind = solid_of(group)
    dimension = kind.dimension
    nodes = group.nodes[row]
    x = coordinates[nodes[list(face)], :dimension]
    _, _, derivatives = _face_rule(kind, face)
    area = _normal(np.einsum("kd,pka->pda", x, derivatives)).sum(axis=0)
    return 1 if area @ (x.mean(axis=0) - coordinates[nodes, :dimension].mean(axis=0)) > 0 else -1


def _traction(load: ElementLoad, area: FloatArray) -> FloatArray:
    """Return the force per parent area of a load on a face, from the outward normal (..., dimension) times area."""
    if load.type.kind is LoadKind.PRESSURE:
        return -area
    size = np.linalg.norm(area, axis=-1, keepdims=True)
    direction = np.broadcast_to(np.array(load.type.direction)[: area.shape[-1]], area.shape)
    if load.type.kind is LoadKind.SHEAR:
        normal = area / size
        direction = direction - (direction * normal).sum(axis=-1, keepdims=True) * normal
        length = np.linalg.norm(direction, axis=-1, keepdims=True)
        if (length < SMALLEST_SINE).any():
            raise DeckError(load.source, "TRSHR: the direction is normal to the surface")
        direction = direction / length
    traction: FloatArray = size * direction
    return traction


def _outward(tangents: FloatArray, outside: FloatArray) -> FloatArray:
    """Return the outward normal times area (..., dimension) of faces; outside:
    from elements' centres to those of faces.
    """
    area = _normal(tangents)
    outward: FloatArray = area * np.sign((area * outside[:, None, :]).sum(axis=-1, keepdims=True))
    return outward


def _normal(tangents: FloatArray) -> FloatArray:
    """Return the normal times area (..., dimension) of faces, from the derivatives of the position."""
    if tangents.shape[-1] == 1:
        return np.stack([tangents[..., 1, 0], -tangents[..., 0, 0]], axis=-1)
    return np.asarray(np.cross(tangents[..., 0], tangents[..., 1]))


def _face_rule(kind: ContinuumType, face: Face) -> tuple[FloatArray, FloatArray, FloatArray]:
    family = kind.family.face_family(face)
    return _rule(family, family.full_points)


def _rule(family: Family, points: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return weights (points,), shape functions (points, nodes), their derivatives (points, nodes, dimension)."""
    return _binding.integration_rule(family.number, points, family.nodes, family.dimension)
