# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Materials that solids have at an interface, and their axes in the middle of each face there."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from uel.elements.directions import first_element, is_user
from uel.elements.families.composite import turned_directions
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import ContinuumType, Tensor
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.orientation_axes import UndefinedDirectionsError
from uel.model.properties import (
    CompositeSection,
    ElasticType,
    Material,
    Orientation,
    SolidLayer,
    SolidSection,
    UserProperty,
)

STACK_FACES: Final = {1: (5, 3), 2: (2, 4), 3: (0, 1)}
"""Faces, from 0, at the first and the last layer of each stack direction: S6 and S4, S3 and S5, S1 and S2."""


@dataclass(frozen=True, slots=True)
class Ply:
    """Material of solids at an interface.

    rows      (k,) of the solids among those that were asked for
    material  with constants of *ELASTIC
    axes      (k, 3, 3) its directions, in rows; (0, 3, 3) where they are not known
    why       they are not known; '' where they are
    """

    rows: IntArray
    material: Material
    axes: FloatArray
    why: str = ""


@dataclass(frozen=True, slots=True)
class SolidFaces:
    """Faces at an interface of solids of one group.

    group    of the solids
    rows     (m,) of the solids in it
    corners  (m, c) nodes of the faces
    outward  (m, 3) unit normals of the faces
    """

    group: ElementGroup
    rows: IntArray
    corners: IntArray
    outward: FloatArray

    def take(self, rows: IntArray) -> SolidFaces:
        """Return the faces in these rows."""
        return SolidFaces(self.group, self.rows[rows], self.corners[rows], self.outward[rows])

    def are(self, number: int) -> np.ndarray:
        """Return the mask of the faces that have this number, from 0, in their solid."""
        kind = self.group.built_in
        assert isinstance(kind, ContinuumType)
        nodes = self.group.nodes[self.rows][:, list(kind.family.faces[number][: self.corners.shape[1]])]
        return np.asarray((np.sort(nodes, axis=1) == np.sort(self.corners, axis=1)).all(axis=1))


def plies_at(model: Model, faces: SolidFaces, tensor: Tensor) -> Iterator[Ply]:
    """Find the materials at faces of solids whose stresses follow from constant elastic moduli."""
    section = faces.group.section
    every = np.arange(len(faces.rows))
    if isinstance(section, CompositeSection):
        first, last = (faces.are(number) for number in STACK_FACES[section.direction])
        for layer, there, upright in (
            (section.layers[0], first, -faces.outward),
            (section.layers[-1], last, faces.outward),
        ):
            rows = np.flatnonzero(there)
            if len(rows) and _is_elastic(layer.material):
                yield _ply(model, faces.take(rows), layer, upright[rows], rows)
        across = np.flatnonzero(~(first | last))
        if len(across):
            yield Ply(across, section.layers[0].material, np.zeros((0, 3, 3)), "the interface runs across its layers")
    elif isinstance(section, SolidSection | UserProperty) and section.material and _is_elastic(section.material):
        isotropic = section.material.elastic and section.material.elastic.type is ElasticType.ISOTROPIC
        if isinstance(section, UserProperty) and tensor is Tensor.SOLID and not isotropic:
            why = "UELMAT may have directions of its own"
            yield Ply(every, section.material, np.zeros((0, 3, 3)), why)
        else:
            layer = SolidLayer(1.0, 1, section.material, section.orientation)
            yield _ply(model, faces, layer, faces.outward, every)


def _is_elastic(material: Material) -> bool:
    """Return whether a material has constant elastic moduli; `find_faults` warns of others."""
    return material.elastic is not None and material.elastic.table is None and material.hyperelastic is None


def _ply(model: Model, faces: SolidFaces, layer: SolidLayer, upright: FloatArray, rows: IntArray) -> Ply:
    """Return the material of a layer with its axes; `upright` is the stack direction (k, 3)."""
    material, orientation = layer.material, layer.orientation
    same = np.broadcast_to(np.eye(3), (len(rows), 3, 3))
    isotropic = material.elastic and material.elastic.type is ElasticType.ISOTROPIC
    if orientation is None or (isotropic and (material.expansion is None or material.expansion.isotropic)):
        return Ply(rows, material, same)
    try:
        axes = _directions(model, faces, orientation)
        if layer.angle is not None:
            axes = turned_directions(layer, axes[:, None], upright[:, None])[:, 0]
    except ValueError as error:
        return Ply(rows, material, same[:0], f"orientation {orientation.name}: {error}")
    return Ply(rows, material, axes)


def stress_axes(model: Model, faces: SolidFaces) -> FloatArray:
    """Return the directions (k, 3, 3), in rows, in which solids have their initial stress.

    Raises ValueError where they are not known.
    """
    section = faces.group.section
    if not isinstance(section, SolidSection):
        raise ValueError("its directions are not known")
    if section.orientation is None:
        return np.broadcast_to(np.eye(3), (len(faces.rows), 3, 3))
    return _directions(model, faces, section.orientation)


def _directions(model: Model, faces: SolidFaces, orientation: Orientation) -> FloatArray:
    """Compute directions (k, 3, 3) of an orientation in the middles of faces.
    Raises ValueError if they are not known.
    """
    system, shape = orientation.system, (len(faces.rows), 3, 3)
    if system is None:
        return np.broadcast_to(orientation.axes, shape)
    if is_user(orientation):
        raise ValueError("its directions are those of ORIENT")
    nodes = faces.group.nodes[faces.rows]
    if system.nodes and max(system.nodes) > nodes.shape[1]:
        raise ValueError(f"local node {max(system.nodes)} of {nodes.shape[1]}")
    place = model.mesh.coordinates
    elements = first_element(model, faces.group) + faces.rows
    try:
        return system.axes(elements, place[nodes], place[faces.corners].mean(axis=1)[:, None])[:, 0]
    except UndefinedDirectionsError as error:
        label = faces.group.labels[faces.rows[error.row[0]]]
        raise ValueError(f"{error} in element {label}") from None
