# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in bricks with layers for the driver, and their directions.

In Fortran they are in fortran/host/elements/solid/solid.f90.

Integration points are those of Gauss along the layers and of Simpson across each, or its middle (Analysis User's Guide,
Solid elements, Defining composite solid elements). Section points of an integration point follow each other, from the
first layer on.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from uel.elements.block import ElementBlock
from uel.elements.building import Building, nodal_block
from uel.elements.directions import first_element, undefined_directions
from uel.elements.families.solid import (
    OF_FIRST_TANGENT,
    hourglass_stiffness,
    is_enhanced,
    numbered,
    section_depth,
    solid_of,
    warn_of_enhanced,
)
from uel.elements.materials.library import (
    define_material,
    history_values,
    linearity,
    state_variables,
)
from uel.elements.routine import VALUES_OF_AXES, Linearity, PointAxes, Routine
from uel.elements.simpson import simpson
from uel.errors import DeckError, unsupported
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import ContinuumType
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.orientation_axes import UndefinedDirectionsError
from uel.model.properties import CompositeSection, Orientation, SolidLayer, materials_of
from uel.model.records import PointVariables
from uel.usersub import Library, _binding, built_in

ALONG: Final = 1e-6
"""Length below which the projection of a unit vector on a layer has no direction."""


@dataclass(frozen=True, slots=True)
class LayerPoints:
    """Points of an element: parent coordinates (points, 3), weights (points,), and NPT, LAYER and KSPT (points, 3)."""

    parent: FloatArray
    weight: FloatArray
    number: IntArray


def layer_points(kind: ContinuumType, section: CompositeSection) -> LayerPoints:
    """Return all points of an element with layers."""
    along, weights = np.polynomial.legendre.leggauss(round(kind.points ** (1 / 3)))
    across, heights, layers = _across(section)
    stack = section.direction - 1
    first, second = (axis for axis in range(3) if axis != stack)
    count, sections = len(along), len(across)
    # the first direction is counted first, then the second, as in elements without layers
    j, i, k = (index.ravel() for index in np.indices((count, count, sections)))
    parent = np.zeros((len(i), 3))
    parent[:, first], parent[:, second], parent[:, stack] = along[i], along[j], across[k]
    number = np.column_stack([i + count * j + 1, layers[k]])
    return LayerPoints(parent, weights[i] * weights[j] * heights[k], number)


def _across(section: CompositeSection) -> tuple[FloatArray, FloatArray, IntArray]:
    """Return places from -1 to 1 and weights of section points, and their LAYER and KSPT."""
    total = sum(layer.thickness for layer in section.layers)
    bottom, places, weights, numbers = -1.0, [], [], []
    for number, layer in enumerate(section.layers, 1):
        height = 2 * layer.thickness / total
        at, weight = simpson(layer.points)
        places.append(bottom + height * at)
        weights.append(height * weight)
        numbers += [(number, point) for point in range(1, layer.points + 1)]
        bottom += height
    return np.concatenate(places), np.concatenate(weights), np.array(numbers)


def composite_routine(
    model: Model, group: ElementGroup, kind: ContinuumType, section: CompositeSection, library: Library
) -> Routine:
    """Build the routine of a group of bricks with layers. Raises DeckError."""
    _check(group, section)
    reduced, dynamic = kind.hourglass_control, any(step.procedure.inertia for step in model.steps)
    hourglass = hourglass_stiffness(kind, section, kind.tensor) if reduced else 0.0
    enhanced = reduced and is_enhanced(section)
    warn_of_enhanced(model, group, kind, library, "tangents of the layers")
    materials = materials_of(section)
    statev = max(map(state_variables, materials))
    numbers = [
        define_material(
            layer.material, layer.orientation, kind.tensor, section.source, library, local=True, room=statev
        )
        for layer in section.layers
    ]
    points = layer_points(kind, section)
    family = _binding.define_rule(kind.family.number, points.parent, points.weight, reduced=reduced)
    count = len(points.weight)
    values = statev + max(history_values(material) - state_variables(material) for material in materials)
    of_points, forces = count * 2 * len(kind.components), 2 * kind.dimension * kind.nodes if dynamic else 0
    orientation = section.layers[0].orientation or Orientation("", np.eye(3), section.source)
    axes = PointAxes(of_points + forces, count, False, orientation)
    hidden = forces + VALUES_OF_AXES * count + kind.modes + (2 if enhanced else 0)
    layers = np.column_stack([np.array(numbers)[points.number[:, 1] - 1], points.number])
    known = all(linearity(material) is Linearity.KNOWN for material in materials)
    return Routine(
        address=_binding.address_of("solid"),
        jtype=kind.nodes,
        mcrd=kind.dimension,
        svars=of_points + hidden,
        hidden=hidden,
        density=built_in.position("composite", "density"),
        props=built_in.reals(
            "composite", depth=section_depth(kind, section), density=materials[0].density, hourglass=hourglass
        ),
        jprops=built_in.integers(
            "composite",
            family=family,
            points=count,
            direct=kind.direct,
            enhanced=OF_FIRST_TANGENT if enhanced else 0,
            mass_points=kind.mass_points,
            modes=kind.modes,
            pressures=0,
            layers=layers,
        ),
        family=family,
        material=numbers[0],
        tensor=int(kind.tensor),
        history=(values, count if values > 1 else 1),
        statev=statev,
        turns=True,
        linear=values == 1,
        forces=Linearity.KNOWN if known else Linearity.UNKNOWN,
        # the energy of hourglass control is another one
        stores=not kind.hourglass_control,
        free=(1, 2, 3),
        axes=axes,
    )


def composite_variables(kind: ContinuumType, section: CompositeSection, routine: Routine) -> PointVariables:
    """Describe the state variables of a group of bricks with layers."""
    names = tuple(f"{letter}{component}" for letter in "ES" for component in kind.components)
    points = int(routine.jprops[built_in.position("composite", "points", "jprops")])
    return PointVariables("continuum", (*names, *numbered("SDV", routine.statev)), points, sections=section.sections)


def layer_axes(
    model: Model, group: ElementGroup, kind: ContinuumType, section: CompositeSection, family: int
) -> FloatArray:
    """Compute directions (m, points, 3, 3) of the layers at all points, in rows. Raises DeckError."""
    points = layer_points(kind, section)
    nodes = model.mesh.coordinates[group.nodes]
    _, shapes, slopes = _binding.integration_rule(family, len(points.weight), kind.nodes, kind.dimension)
    tangents = np.einsum("mkd,pka->mpad", nodes, slopes)
    first, second = section.direction % 3, (section.direction + 1) % 3
    normal = np.cross(tangents[:, :, first], tangents[:, :, second])
    size = np.linalg.norm(normal, axis=-1, keepdims=True)
    # an element without volume is reported when it is called
    normal /= np.where(size > 0, size, 1.0)
    places = np.einsum("pk,mkd->mpd", shapes, nodes)
    found = np.empty((*places.shape, 3))
    elements = first_element(model, group) + np.arange(len(nodes))
    for number, layer in enumerate(section.layers, 1):
        here = points.number[:, 1] == number
        axes = _directions(group, layer, elements, nodes, places[:, here])
        if layer.angle is not None:
            axes = _turned(group, layer, axes, normal[:, here])
        found[:, here] = axes
    return found


def _directions(
    group: ElementGroup, layer: SolidLayer, elements: IntArray, nodes: FloatArray, places: FloatArray
) -> FloatArray:
    """Compute directions (m, points, 3, 3) of the orientation of a layer. Raises DeckError."""
    orientation, shape = layer.orientation, (*places.shape, 3)
    if orientation is None:
        return np.broadcast_to(np.eye(3), shape)
    if orientation.system is None:
        return np.broadcast_to(orientation.axes, shape)
    try:
        return orientation.system.axes(elements, nodes, places)
    except UndefinedDirectionsError as error:
        raise undefined_directions(group, orientation, error) from None


def _turned(group: ElementGroup, layer: SolidLayer, axes: FloatArray, normal: FloatArray) -> FloatArray:
    """Turn the directions of a layer of elements, see `turned_directions`. Raises DeckError."""
    try:
        return turned_directions(layer, axes, normal)
    except UndefinedDirectionsError as error:
        assert layer.orientation is not None
        label = group.labels[error.row[0]]
        name = layer.orientation.name
        raise DeckError(
            layer.orientation.source, f"*ORIENTATION, NAME={name}: {error}; it is not in element {label}"
        ) from None


def turned_directions(layer: SolidLayer, axes: FloatArray, normal: FloatArray) -> FloatArray:
    """Project the directions of an orientation on a layer and turn them about its normal.

    An angle of zero leaves directions as they are where none of the orientation can be the normal.

    Parameters
    ----------
    layer
        With an angle and its orientation.
    axes
        (m, points, 3, 3) directions of the orientation, in rows.
    normal
        (m, points, 3) unit vectors in the stack direction.

    Returns
    -------
    (m, points, 3, 3) directions of the layer, in rows.

    Raises
    ------
    UndefinedDirectionsError
        The direction about which angles are is not the closest one to the stack direction.
    """
    orientation = layer.orientation
    assert orientation is not None
    assert layer.angle is not None
    # the direction that is projected, the next one, and that of the normal
    rolled = np.roll(axes, -orientation.normal, axis=-2)
    cosine = np.einsum("mpad,mpd->mpa", rolled, normal)
    upright = normal * np.sign(cosine[..., 2:])
    along = rolled[:, :, 0] - upright * np.einsum("mpd,mpd->mp", rolled[:, :, 0], upright)[..., None]
    size = np.linalg.norm(along, axis=-1)
    lying = np.argwhere((np.abs(cosine[..., 2:]) < np.abs(cosine[..., :2])).any(axis=-1) | (size < ALONG))
    if len(lying) and layer.angle == 0:
        return axes
    if len(lying):
        message = f"direction {orientation.normal}, about which the angles of layers are, must be the closest one to"
        raise UndefinedDirectionsError(tuple(lying[0].tolist()), f"{message} the stack direction")
    along /= size[..., None]
    next_one = np.cross(upright, along)
    c, s = np.cos(np.radians(layer.angle)), np.sin(np.radians(layer.angle))
    turned = np.stack([c * along + s * next_one, c * next_one - s * along, upright], axis=-2)
    return np.asarray(np.roll(turned, orientation.normal, axis=-2))


def _check(group: ElementGroup, section: CompositeSection) -> None:
    """Raise DeckError for layers of different density."""
    if len({material.density for material in materials_of(section)}) > 1:
        raise unsupported(section.source, "*DENSITY that differs from layer to layer", f"elements of type {group.type}")


def composite_block(building: Building, group: ElementGroup) -> ElementBlock:
    """Build the block of a group of bricks with layers. Raises DeckError."""
    kind, section = solid_of(group), group.section
    assert isinstance(section, CompositeSection)
    routine = composite_routine(building.model, group, kind, section, building.library)
    block = nodal_block(building, group, kind, routine, composite_variables(kind, section, routine))
    block.initial.begin_axes(layer_axes(building.model, group, kind, section, routine.family))
    return block
