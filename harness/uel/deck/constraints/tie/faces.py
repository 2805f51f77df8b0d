# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Faces of tied surfaces: of solids, rigid elements, shells and membranes, and edges of shells.

`nearest_points` projects nodes onto them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from uel.deck.language.blocks import Row
from uel.deck.mesh.flatten import Owner
from uel.deck.mesh.surfaces import Surfaces, face_family
from uel.errors import DeckError
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import (
    LINE2,
    LINE3,
    QUAD4,
    QUAD8,
    TRI3,
    TRI6,
    Family,
    ShellType,
)
from uel.model.mesh import ElementGroup
from uel.model.properties import ShellSection

FACE: Final = 2
"""Dimension of a face in space; an edge has 1."""

LINEAR: Final = {(1, 2): LINE2, (2, 3): TRI3, (2, 4): QUAD4}
"""Families between corners, by dimension and number of corners."""


@dataclass(frozen=True, slots=True)
class TiedFaces:
    """Nodes (f, k) of the faces of a surface, by family, and half of the shell thickness."""

    nodes: dict[Family, IntArray]
    half_thickness: float

    @property
    def dimension(self) -> int:
        """Dimension of the faces: 1 for lines, 2 for areas."""
        return next(iter(self.nodes)).dimension

    @property
    def quadratic(self) -> bool:
        """Whether faces have midside nodes."""
        return any(family.nodes > family.corners for family in self.nodes)

    @property
    def corners(self) -> TiedFaces:
        """Linear faces with the same corners."""
        faces: dict[Family, list[IntArray]] = {}
        for family, nodes in self.nodes.items():
            faces.setdefault(LINEAR[family.dimension, family.corners], []).append(nodes[:, : family.corners])
        return TiedFaces({family: np.concatenate(arrays) for family, arrays in faces.items()}, self.half_thickness)

    def edge(self, points: FloatArray) -> float:
        """Return the median length of the edges."""
        lengths = []
        for family, nodes in self.nodes.items():
            corners = points[nodes[:, : family.corners]]
            lengths.append(np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).ravel())
        return float(np.median(np.concatenate(lengths)))


def read_faces(surfaces: Surfaces, row: Row, column: int, owner: Owner) -> TiedFaces | None:
    """Read the faces of the surface in a column of a *TIE data line, None for a surface of nodes.

    Raises DeckError for unsupported faces, and for a surface with faces and edges.
    """
    name, faces, half = row.name(column, "surface"), dict[Family, list[IntArray]](), 0.0
    if surfaces.of_nodes(name, row.source, owner.name) is not None:
        return None
    for group, rows, local, source in surfaces.facets(name, row.source, owner.name):
        family = face_family(group, local)
        if family not in (LINE2, LINE3, TRI3, TRI6, QUAD4, QUAD8):
            raise DeckError(source, f"*TIE: faces of elements of type {group.type} are not supported")
        faces.setdefault(family, []).append(group.nodes[rows][:, list(local)])
        if family.dimension == FACE:
            # edges are within the thickness, faces are offset by it
            half = max(half, _half_thickness(group))
    if len({family.dimension for family in faces}) > 1:
        raise row.error(f"surface {name} has faces and edges; expected a surface of one kind")
    return TiedFaces({family: np.concatenate(arrays) for family, arrays in faces.items()}, half)


def _half_thickness(group: ElementGroup) -> float:
    """Return the larger distance of a shell side from the nodes; 0 for other elements."""
    section = group.section
    if not isinstance(group.built_in, ShellType) or not isinstance(section, ShellSection):
        return 0.0
    return sum(layer.thickness for layer in section.layers) * (0.5 + abs(section.offset))
