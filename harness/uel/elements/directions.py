# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Initial directions of *ORIENTATION at the integration points of elements."""

from __future__ import annotations

import numpy as np

from uel.errors import DeckError
from uel.model.arrays import FloatArray
from uel.model.element_types import ContinuumType, SurfaceType
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.orientation_axes import SystemKind, UndefinedDirectionsError
from uel.model.properties import Orientation
from uel.usersub import Library, _binding


def is_user(orientation: Orientation) -> bool:
    """Return whether ORIENT gives the directions."""
    return orientation.system is not None and orientation.system.kind is SystemKind.USER


def first_element(model: Model, group: ElementGroup) -> int:
    """Return the position in the model of the first element of a group."""
    first = 0
    for other in model.groups:
        if other is group:
            break
        first += len(other.labels)
    return first


def initial_axes(
    model: Model, group: ElementGroup, kind: ContinuumType | SurfaceType, orientation: Orientation, library: Library
) -> FloatArray:
    """Compute initial directions (m, points, 3, 3), in rows; global ones if ORIENT sets them. Raises DeckError."""
    m, system = len(group.labels), orientation.system
    shape = m, kind.points, 3, 3
    if system is None:
        return np.broadcast_to(orientation.axes, shape)
    if is_user(orientation):
        if library.orient is None:
            message = f"SYSTEM=USER needs ORIENT; {library.name} has {library.contents}"
            raise DeckError(orientation.source, f"*ORIENTATION, NAME={orientation.name}: {message}")
        return np.broadcast_to(np.eye(3), shape)
    if system.nodes and max(system.nodes) > kind.nodes:
        message = f"local node {max(system.nodes)}, but elements of type {group.type} have {kind.nodes} nodes"
        raise DeckError(orientation.source, f"*ORIENTATION, NAME={orientation.name}: {message}")
    nodes = model.mesh.coordinates[group.nodes]
    family = kind.family
    _, shapes, _ = _binding.integration_rule(family.number, kind.points, family.nodes, family.dimension)
    elements = first_element(model, group) + np.arange(m)
    try:
        return system.axes(elements, nodes, np.einsum("pk,mkd->mpd", shapes, nodes))
    except UndefinedDirectionsError as error:
        raise undefined_directions(group, orientation, error) from None


def undefined_directions(group: ElementGroup, orientation: Orientation, error: UndefinedDirectionsError) -> DeckError:
    """Return the error for a point without directions; it names the element."""
    element, *point = error.row
    at = f", integration point {point[0] + 1}" if point else ""
    message = f"element {group.labels[element]} (type {group.type}){at}: {error}"
    return DeckError(orientation.source, f"*ORIENTATION, NAME={orientation.name}: {message}")
