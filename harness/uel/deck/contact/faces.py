# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Faces in general contact: exterior faces, faces of surfaces, and their bodies.

The number of a face is the position of its element times the largest number of sides, plus its side.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from scipy import sparse

from uel.deck.contact.contact_sides import Facets
from uel.deck.mesh.flatten import FlatMesh
from uel.deck.mesh.surfaces import Surfaces
from uel.errors import DeckError, Source
from uel.model.arrays import IntArray
from uel.model.element_types import (
    BeamType,
    CohesiveType,
    DiscreteKind,
    DiscreteType,
    Face,
    RigidType,
    ShellType,
    SolidType,
)
from uel.model.mesh import ElementGroup

_SIDES = 8
"""Stride of the face numbers of elements, at least the number of sides of an element."""


class ContactFaces:
    """Faces of the elements of these groups, and of surfaces."""

    def __init__(self, flat: FlatMesh, groups: Sequence[ElementGroup], surfaces: Surfaces) -> None:
        self._size, self._groups, self._surfaces = len(flat.mesh.coordinates), groups, surfaces
        self._starts = np.cumsum([0, *(len(group.labels) for group in groups)])

    def of_surface(self, name: str, source: Source) -> IntArray:
        """Return the faces of a surface, ascending. Raises DeckError."""
        kind = self._surfaces.kind(name, source)
        if kind != "ELEMENT":
            message = (
                f"surface {name} is of TYPE={kind}; expected faces of elements, or *CONTACT PAIR in place of *CONTACT"
            )
            raise DeckError(source, f"*CONTACT: {message}")
        of_group = {id(group): k for k, group in enumerate(self._groups)}
        numbers = [np.zeros(0, dtype=np.int64)]
        for group, rows, local, _ in self._surfaces.facets(name, source):
            numbers.append(self._numbers(of_group[id(group)], rows, _sides_of(group).index(local)))
        return np.unique(np.concatenate(numbers))

    def exterior(self) -> IntArray:
        """Return the exterior faces, ascending: free faces of solids, and both sides of shells and rigid elements."""
        covering = [
            (k, side, np.sort(group.nodes[:, list(local)], axis=1))
            for k, group in enumerate(self._groups)
            if isinstance(group.built_in, SolidType | CohesiveType)
            for side, local in enumerate(_sides_of(group))
        ]
        numbers = [
            self._numbers(k, np.arange(len(group.labels)), side)
            for k, group in enumerate(self._groups)
            if isinstance(group.built_in, ShellType | RigidType)
            for side in range(2)
        ]
        if covering:
            width = max(nodes.shape[1] for _, _, nodes in covering)
            every = [np.pad(nodes, ((0, 0), (0, width - nodes.shape[1])), constant_values=-1) for *_, nodes in covering]
            _, index, counts = np.unique(np.concatenate(every), axis=0, return_inverse=True, return_counts=True)
            alone = np.split(counts[index.ravel()] == 1, np.cumsum([len(nodes) for nodes in every])[:-1])
            numbers += [
                self._numbers(k, np.flatnonzero(free), side)
                for (k, side, _), free in zip(covering, alone, strict=True)
                if isinstance(self._groups[k].built_in, SolidType)
            ]
        return np.unique(np.concatenate([np.zeros(0, dtype=np.int64), *numbers]))

    @property
    def without(self) -> list[str]:
        """Types of beams and trusses, which have no faces."""
        kinds = [(group.type, group.built_in) for group in self._groups]
        return sorted(
            {
                name
                for name, kind in kinds
                if isinstance(kind, BeamType) or (isinstance(kind, DiscreteType) and kind.kind is DiscreteKind.TRUSS)
            }
        )

    def bodies(self, faces: IntArray) -> tuple[IntArray, IntArray]:
        """Return (f,) body of each face, numbered from 1 by first elements, and (f,) 1 where it is rigid.

        Elements with common nodes are one body; beams, trusses, springs and the like do not connect bodies.
        """
        connected = [group.nodes for group in self._groups if not isinstance(group.built_in, BeamType | DiscreteType)]
        first = np.concatenate([np.repeat(nodes[:, 0], nodes.shape[1]) for nodes in connected])
        second = np.concatenate([nodes.ravel() for nodes in connected])
        graph = sparse.coo_array((np.ones(len(first)), (first, second)), shape=(self._size, self._size))
        from scipy.sparse.csgraph import connected_components  # noqa: PLC0415 (few decks have contact)

        component = connected_components(graph, directed=False)[1]
        _, order = np.unique(component[first], return_index=True)
        rank = np.zeros(int(component.max()) + 1, dtype=np.int64)
        rank[component[first[np.sort(order)]]] = np.arange(1, len(order) + 1)
        bodies, rigid = np.zeros(len(faces), dtype=np.int64), np.zeros(len(faces), dtype=np.int64)
        for k, chosen in self._by_group(faces):
            group = self._groups[k]
            bodies[chosen] = rank[component[group.nodes[self._rows(k, faces[chosen]), 0]]]
            rigid[chosen] = isinstance(group.built_in, RigidType)
        return bodies, rigid

    def facets(self, faces: IntArray, source: Source) -> Iterator[Facets]:
        """Yield the faces as `Surfaces.facets` does; source: in the deck, for messages."""
        for k, chosen in self._by_group(faces):
            sides = faces[chosen] % _SIDES
            for side in np.unique(sides).tolist():
                rows = self._rows(k, faces[chosen][sides == side])
                yield self._groups[k], rows, _sides_of(self._groups[k])[side], source

    def _numbers(self, group: int, rows: IntArray, side: int) -> IntArray:
        return np.asarray((self._starts[group] + rows) * _SIDES + side)

    def _rows(self, group: int, faces: IntArray) -> IntArray:
        return np.asarray(faces // _SIDES - self._starts[group])

    def _by_group(self, faces: IntArray) -> Iterator[tuple[int, IntArray]]:
        groups = np.searchsorted(self._starts, faces // _SIDES, side="right") - 1
        for k in np.unique(groups).tolist():
            yield k, np.flatnonzero(groups == k)


def _sides_of(group: ElementGroup) -> list[Face]:
    """Return the local nodes of the faces of elements; for shells and rigid elements the two sides, then edges."""
    kind = group.built_in
    if isinstance(kind, SolidType):
        return list(kind.family.faces)
    if isinstance(kind, ShellType):
        return [*kind.sides.values(), *kind.edges.values()]
    if isinstance(kind, RigidType):
        return list(kind.sides.values())
    return [kind.bottom, kind.top] if isinstance(kind, CohesiveType) else []
