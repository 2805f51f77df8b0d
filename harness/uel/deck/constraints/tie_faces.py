# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The faces of surfaces that *TIE joins: of solids, rigid elements, shells and membranes, and edges of shells."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from uel.deck.language.blocks import Row
from uel.deck.mesh.flatten import Owner
from uel.deck.mesh.surfaces import Surfaces, family_of_face
from uel.errors import DeckError
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import (
    LINE2,
    LINE3,
    QUAD4,
    QUAD8,
    TRI3,
    TRI6,
    Face,
    Family,
    ShellType,
    SolidType,
    SurfaceType,
)
from uel.model.mesh import ElementGroup
from uel.model.properties import ShellSection

FACE: Final = 2
"""Dimension of a face in space; an edge has 1."""

LINEAR: Final = {(1, 2): LINE2, (2, 3): TRI3, (2, 4): QUAD4}
"""Families between corners, by dimension and number of corners."""


@dataclass(frozen=True, slots=True)
class TiedFaces:
    """Nodes (f, k) of the faces of a surface, by family, and the distance of the sides of its shells from them."""

    nodes: dict[Family, IntArray]
    half_thickness: float

    @property
    def dimension(self) -> int:
        """Dimension of the faces: 1 for lines, 2 for areas."""
        return next(iter(self.nodes)).dimension

    @property
    def quadratic(self) -> bool:
        """Whether faces have nodes between their corners."""
        return any(family.nodes > family.corners for family in self.nodes)

    @property
    def corners(self) -> TiedFaces:
        """The faces between their corners."""
        found: dict[Family, list[IntArray]] = {}
        for family, nodes in self.nodes.items():
            found.setdefault(LINEAR[family.dimension, family.corners], []).append(nodes[:, : family.corners])
        return TiedFaces({family: np.concatenate(parts) for family, parts in found.items()}, self.half_thickness)

    def edge(self, points: FloatArray) -> float:
        """Return the typical length of the edges of the faces: the median."""
        lengths = []
        for family, nodes in self.nodes.items():
            corners = points[nodes[:, : family.corners]]
            lengths.append(np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).ravel())
        return float(np.median(np.concatenate(lengths)))


def read_faces(surfaces: Surfaces, row: Row, column: int, owner: Owner) -> TiedFaces | None:
    """Read the faces of a surface, None for a surface of nodes.

    Parameters
    ----------
    surfaces
        Those of the deck.
    row, column
        The data line of *TIE, and where the surface stands in it.
    owner
        Level of the line.

    Raises
    ------
    DeckError
        A face is of no kind that ties know, or the surface has faces and edges.
    """
    name, found, half = row.name(column, "surface"), dict[Family, list[IntArray]](), 0.0
    if surfaces.of_nodes(name, row.source, owner.name) is not None:
        return None
    for group, rows, local, source in surfaces.facets(name, row.source, owner.name):
        family = _family(group, local)
        if family not in (LINE2, LINE3, TRI3, TRI6, QUAD4, QUAD8):
            raise DeckError(source, f"*TIE: faces of elements of type {group.type} are not supported")
        found.setdefault(family, []).append(group.nodes[rows][:, list(local)])
        if family.dimension == FACE:
            # the thickness of a shell lies across its faces, not along them
            half = max(half, _half_thickness(group))
    if len({family.dimension for family in found}) > 1:
        raise row.error(f"surface {name} has faces and edges; expected a surface of one kind")
    return TiedFaces({family: np.concatenate(parts) for family, parts in found.items()}, half)


def _family(group: ElementGroup, local: Face) -> Family | None:
    kind = group.built_in
    if isinstance(kind, SurfaceType):
        return kind.family if len(local) == kind.nodes else kind.family.face_family(local)
    if isinstance(kind, SolidType):
        return kind.family.face_family(local)
    return family_of_face(group, local)


def _half_thickness(group: ElementGroup) -> float:
    """Return the distance of the farther side of conventional shells from their nodes; 0 for other elements."""
    section = group.section
    if not isinstance(group.built_in, ShellType) or not isinstance(section, ShellSection):
        return 0.0
    return sum(layer.thickness for layer in section.layers) * (0.5 + abs(section.offset))
