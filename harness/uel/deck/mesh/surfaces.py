# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*SURFACE: nodes for constraints, faces for loads. Surfaces are read on use."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from uel.deck.error_report import nearest
from uel.deck.language.blocks import Block, Row
from uel.deck.language.table import NAME, Keyword, Kind, Option, Where, ignored, one_of, refused
from uel.deck.mesh.flatten import FlatMesh
from uel.errors import DeckError, Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import (
    LINE2,
    LINE3,
    QUAD4,
    QUAD8,
    TRI3,
    TRI6,
    CohesiveType,
    ContinuumType,
    Face,
    Family,
    RigidType,
    SolidType,
    SurfaceType,
)
from uel.model.mesh import ElementGroup

_CORNERS = np.array([[-1.0, 1.0, 1.0, -1.0], [-1.0, -1.0, 1.0, 1.0]])
_GAUSS = _CORNERS.T / np.sqrt(3.0)
ANALYTICAL = ("SEGMENTS", "CYLINDER", "REVOLUTION")
_QUADRATIC = {
    LINE3.number: [1 / 4] * 2 + [1 / 2],
    TRI6.number: [1 / 12] * 3 + [1 / 4] * 3,
    QUAD8.number: [1 / 16] * 4 + [3 / 16] * 4,
}
"""Fractions of the area of a quadratic face, by node."""


@dataclass(frozen=True, slots=True)
class _Line:
    """Data line of a surface: positions of elements and their face, or nodes."""

    members: IntArray
    face: str
    row: Row


def _keys(lines: Sequence[_Line], every: Sequence[_Line]) -> IntArray:
    """Return the numbers of faces or nodes of lines, concatenated; every: all lines of the comparison."""
    codes = {face: k for k, face in enumerate(sorted({line.face for line in every}))}
    keys = [line.members * len(codes) + codes[line.face] for line in lines]
    return np.concatenate([np.zeros(0, dtype=np.int64), *keys])


def _chosen(lines: Sequence[_Line], chosen: NDArray[np.bool_]) -> list[_Line]:
    """Return the lines restricted by a mask of their faces or nodes, in the order of `_keys`."""
    ends = np.cumsum([len(line.members) for line in lines])[:-1]
    parts = np.split(chosen, ends)
    return [replace(line, members=line.members[part]) for line, part in zip(lines, parts, strict=True)]


def _merged(lines: Sequence[_Line]) -> list[_Line]:
    """Return the lines of a surface as disjoint sets: each without the members of earlier ones."""
    keys = _keys(lines, lines)
    first = np.zeros(len(keys), dtype=bool)
    first[np.unique(keys, return_index=True)[1]] = True
    return _chosen(lines, first) if lines else []


def _combined(block: Block) -> list[tuple[str, Source]]:
    """Return names and locations of the surfaces of COMBINE. Raises DeckError."""
    how = block.options.text("COMBINE")
    names = [(row.name(k, "surface"), row.source) for row in block.rows() for k in range(len(row))]
    if not names or (how != "UNION" and len(names) != 2):
        expected = "the names of surfaces" if how == "UNION" else "the names of two surfaces"
        raise block.error(f"COMBINE={how} takes {expected}, found {len(names)}")
    return names


class Surfaces:
    """Surfaces of the model, by their names in the scope of use."""

    def __init__(self, flat: FlatMesh, groups: Sequence[ElementGroup]) -> None:
        self._flat = flat
        self._groups = groups
        self._starts = np.cumsum([0, *(len(group.labels) for group in groups)])
        self._blocks: dict[str, tuple[str, Block]] = {}
        for owner in flat.owners:
            for block in owner.blocks:
                if block.name == "SURFACE":
                    name = block.options.text("NAME")
                    self._blocks[f"{owner.name}.{name}" if owner.name else name] = (owner.name, block)

    def locate(self, name: str, source: Source, owner: str) -> tuple[str, Block]:
        """Return scope and keyword of a surface. Raises DeckError."""
        local = name.split(".")
        candidates = [f"{owner}.{name}" if owner else name, ".".join(local[-2:]), local[-1]]
        key = next((candidate for candidate in candidates if candidate in self._blocks), None)
        if key is None:
            raise DeckError(source, f"unknown surface {name}{nearest(name, self._blocks)}")
        return self._blocks[key]

    def kind(self, name: str, source: Source, owner: str = "") -> str:
        """Return the TYPE of a surface, for COMBINE of its surfaces. Raises DeckError."""
        scope, block = self.locate(name, source, owner)
        if not block.options.has("COMBINE"):
            return block.options.text("TYPE")
        self._lines(name, source, owner)
        first, at = _combined(block)[0]
        return self.kind(first, at, scope)

    def profile(self, name: str, source: Source, owner: str) -> tuple[str, Block, float] | None:
        """Return scope, keyword and fillet radius of an analytical rigid surface, None for another type."""
        scope, block = self.locate(name, source, owner)
        kind = block.options.text("TYPE")
        if kind not in ANALYTICAL:
            return None
        if kind != "SEGMENTS":
            raise block.error("is not supported in contact; of analytical rigid surfaces TYPE=SEGMENTS is")
        return scope, block, block.not_negative("FILLET RADIUS", 0.0)

    def _lines(self, name: str, source: Source, owner: str, within: tuple[Source, ...] = ()) -> list[_Line]:
        """Return the disjoint lines of a surface of elements or nodes. Raises DeckError."""
        scope, block = self.locate(name, source, owner)
        if block.source in within:
            raise block.error("combines itself")
        if block.options.has("COMBINE"):
            members = [self._lines(member, at, scope, (*within, block.source)) for member, at in _combined(block)]
            lines = self._combine(block, members)
            if not any(len(line.members) for line in lines):
                self._flat.warn(block.source, f"*SURFACE: {name} is empty")
            return lines
        kind = block.options.text("TYPE")
        if kind not in ("ELEMENT", "NODE"):
            raise DeckError(source, f"surface {name} ({block.source}) is of TYPE={kind}, which constraints cannot use")
        find, faces = (self._flat.nodes, False) if kind == "NODE" else (self._flat.elements, True)
        return _merged(
            [
                _Line(find(row.name(0, "set"), row.source, scope), row.name(1, "face") if faces else "", row)
                for row in block.rows()
            ]
        )

    @staticmethod
    def _combine(block: Block, members: list[list[_Line]]) -> list[_Line]:
        how, lines = block.options.text("COMBINE"), [line for member in members for line in member]
        if len({bool(line.face) for line in lines}) > 1:
            raise block.error("combines surfaces of elements and of nodes; expected one kind")
        if how == "UNION":
            return _merged(lines)
        first, second = (_keys(member, lines) for member in members)
        return _chosen(members[0], np.isin(first, second) == (how == "INTERSECTION"))

    def nodes(self, name: str, source: Source, owner: str = "") -> IntArray:
        """Return the node indices of a surface, ascending. Raises DeckError if it or a face is unknown."""
        if self.kind(name, source, owner) == "NODE":
            parts = [line.members for line in self._lines(name, source, owner)]
        else:
            facets = self.facets(name, source, owner)
            parts = [group.nodes[rows][:, list(local)].ravel() for group, rows, local, _ in facets]
        return np.unique(np.concatenate([np.zeros(0, dtype=np.int64), *parts]))

    def shares(self, name: str, source: Source, owner: str = "") -> tuple[IntArray, FloatArray]:
        """Return the nodes of a surface, ascending, and their tributary areas or lengths (1 on a surface of nodes)."""
        nodes = self.nodes(name, source, owner)
        if self.kind(name, source, owner) == "NODE":
            return nodes, np.ones(len(nodes))
        areas = np.zeros(len(nodes))
        for group, rows, local, _ in self.facets(name, source, owner):
            family, faces = face_family(group, local), group.nodes[rows][:, list(local)]
            assert family is not None
            np.add.at(areas, np.searchsorted(nodes, faces), tributary_areas(family, self._flat.mesh.coordinates[faces]))
        return nodes, areas

    def faces(self, name: str, source: Source) -> list[tuple[IntArray, str, Source]]:
        """Return the elements (positions) and their face (S1, ...) of each line of a surface. Raises DeckError."""
        lines = self._lines(name, source, "")
        if self.kind(name, source) == "NODE":
            location = self.locate(name, source, "")[1].source
            raise DeckError(source, f"surface {name} ({location}) has no faces of elements")
        return [(line.members, line.face, line.row.source) for line in lines]

    def facets(
        self, name: str, source: Source, owner: str = ""
    ) -> Iterator[tuple[ElementGroup, IntArray, Face, Source]]:
        """Yield the faces of a surface: a group, rows of it, the local nodes of their face, the location.
        Raises DeckError.
        """
        for line in self._lines(name, source, owner):
            for k, members in self._by_group(line.members):
                local = face_nodes(self._groups[k], line.face, line.row.source, "SURFACE")
                yield self._groups[k], members - self._starts[k], local, line.row.source

    def of_nodes(self, name: str, source: Source, owner: str = "") -> list[tuple[IntArray, float]] | None:
        """Return the nodes of each line of a surface of nodes, and their area; None for a surface of faces."""
        lines = self._lines(name, source, owner)
        if self.kind(name, source, owner) != "NODE":
            return None
        return [(line.members, line.row.positive(1, "area", 1.0)) for line in lines]

    def by_group(self, elements: IntArray) -> Iterator[tuple[ElementGroup, IntArray]]:
        """Yield the elements, by their positions in the model, group by group."""
        return ((self._groups[k], members) for k, members in self._by_group(elements))

    def nodes_of(self, elements: IntArray) -> set[int]:
        """Return the nodes of elements, by their positions in the model."""
        nodes = [self._groups[k].nodes[own - self._starts[k]].ravel() for k, own in self._by_group(elements)]
        return set(np.unique(np.concatenate([np.zeros(0, dtype=np.int64), *nodes])).tolist())

    def _by_group(self, elements: IntArray) -> Iterator[tuple[int, IntArray]]:
        groups = np.searchsorted(self._starts, elements, side="right") - 1
        return ((k, elements[groups == k]) for k in np.unique(groups).tolist())


def tributary_areas(family: Family, points: FloatArray) -> FloatArray:
    """Compute the tributary area or length of each node of faces of a family.

    On linear faces it is the integral of the shape function. On quadratic faces, where that is zero or negative at
    corners, it is the area of the parts cut at the midside nodes.

    Parameters
    ----------
    family
        Family of the faces.
    points
        (..., n, 3) coordinates of faces: corners, then midside nodes.

    Returns
    -------
    FloatArray
        (..., n).
    """
    first, second, third = (points[..., k % family.corners, :] for k in range(3))
    areas = np.zeros((*points.shape[:-2], family.corners))
    if family.dimension == 1:
        areas += 0.5 * np.linalg.norm(second - first, axis=-1)[..., None]
    elif family.corners == 3:
        areas += np.linalg.norm(np.cross(second - first, third - first), axis=-1)[..., None] / 6.0
    else:
        for xi, eta in _GAUSS:
            along, across = 1.0 + xi * _CORNERS[0], 1.0 + eta * _CORNERS[1]
            tangents = [0.25 * slopes @ points[..., :4, :] for slopes in (_CORNERS[0] * across, _CORNERS[1] * along)]
            areas += 0.25 * along * across * np.linalg.norm(np.cross(*tangents), axis=-1)[..., None]
    fractions = _QUADRATIC.get(family.number)
    return areas if fractions is None else areas.sum(axis=-1, keepdims=True) * np.array(fractions)


def face_nodes(group: ElementGroup, face: str, source: Source, keyword: str) -> tuple[int, ...]:
    """Return the local nodes of a face of the elements of a group: corners, then midside nodes. Raises DeckError."""
    kind = group.built_in
    faces = {}
    if isinstance(kind, SolidType):
        faces = {f"S{number}": nodes for number, nodes in enumerate(kind.family.faces, start=1)}
    elif isinstance(kind, SurfaceType):
        faces = kind.sides | kind.edges
    elif isinstance(kind, RigidType):
        faces = kind.sides
    elif isinstance(kind, CohesiveType):
        # as faces 1 and 3 of a quadrilateral, 1 and 2 of a brick or wedge (Elements Guide, COH2D4, COH3D6 and COH3D8)
        faces = {"S1": kind.bottom, "S3" if kind.dimension == 2 else "S2": kind.top}
    if face not in faces:
        known = ", ".join(faces) or "none"
        raise DeckError(source, f"*{keyword}: elements of type {group.type} have no face {face} (faces: {known})")
    return faces[face]


def face_family(group: ElementGroup, local: Face) -> Family | None:
    """Return the family of a face, or of an edge of shells; None for elements without faces."""
    kind = group.built_in
    if isinstance(kind, CohesiveType):
        return kind.face
    if isinstance(kind, SurfaceType | RigidType) and len(local) == kind.nodes:
        return kind.family
    return kind.family.face_family(local) if isinstance(kind, SolidType | SurfaceType | RigidType) else None


def linear_face(group: ElementGroup, local: Face) -> Family | None:
    """Return the family of a linear face of continuum or rigid elements, None for others and for quadratic faces."""
    family = face_family(group, local) if isinstance(group.built_in, ContinuumType | RigidType) else None
    return family if family in (LINE2, TRI3, QUAD4) else None


KEYWORDS = (
    Keyword(
        "SURFACE",
        "Define a surface, of which constraints use the nodes. SEGMENTS is an analytical rigid one in the plane or "
        "about the axis of symmetry, with its outward normal on the left of the way along its segments.",
        Where.MODEL,
        (
            NAME,
            one_of(
                "TYPE",
                "what it is made of; constraints use ELEMENT and NODE, contact SEGMENTS too",
                (
                    *("ELEMENT", "NODE", "CUTTING SURFACE", "CYLINDER", "EULERIAN MATERIAL", "REVOLUTION", "SEGMENTS"),
                    *("USER", "XFEM"),
                ),
                default="ELEMENT",
            ),
            Option("FILLET RADIUS", Kind.REAL, "of arcs between lines of an analytical rigid surface"),
            one_of(
                "COMBINE",
                "put surfaces together, a face or node once; DIFFERENCE: the first surface without the second",
                ("UNION", "INTERSECTION", "DIFFERENCE"),
            ),
            *ignored("INTERNAL", "DEFINITION", "TRIM", "NO OFFSET", "NO THICK"),
            *refused("CROP"),
        ),
        "COMBINE: names of surfaces, two but for UNION; or set or element, face (S1, S2, ...; SPOS, SNEG of shells and "
        "rigid elements; E1, E2, ... of shells; S1, S2 of COH3D8; S1, S3 of COH2D4); or node set or node; or START, x, "
        "y, then LINE, x, y or CIRCL, x, y, x and y of the centre",
    ),
)
