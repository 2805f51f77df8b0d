# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Flattening of parts and instances to one mesh: nodes, elements, sets and element groups of the whole model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block
from uel.deck.language.definitions import read_definitions
from uel.deck.language.numbers import LARGEST_INTEGER, is_integer
from uel.deck.language.structure import Structure
from uel.deck.mesh.generation import GENERATORS
from uel.deck.mesh.local_mesh import LocalMesh, Members
from uel.deck.mesh.placement import IDENTITY, Placement, read_placement
from uel.deck.sections.user_elements import Definitions, read_user_element
from uel.errors import DeckError, Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.mesh import Mesh, full_name
from uel.model.properties import UserElement

ROOT = ""


@dataclass(slots=True)
class Owner:
    """One instance, or the root: its mesh, its blocks, and where its nodes and elements are in the whole model."""

    name: str
    mesh: LocalMesh
    blocks: list[Block]
    placement: Placement
    nodes: IntArray
    points: FloatArray
    node_offset: int = 0
    elements: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    element_offset: int = 0

    def find_nodes(self, labels: IntArray) -> IntArray:
        """Return indices in the whole model, -1 for nodes that do not exist."""
        return _find(self.nodes, labels, self.node_offset)

    def find_elements(self, labels: IntArray) -> IntArray:
        """Return positions in the whole model, -1 for elements that do not exist."""
        return _find(self.elements, labels, self.element_offset)


def _find(sorted_labels: IntArray, labels: IntArray, offset: int) -> IntArray:
    if not len(sorted_labels):
        return np.full(len(labels), -1)
    position = np.minimum(np.searchsorted(sorted_labels, labels), len(sorted_labels) - 1)
    return np.where(sorted_labels[position] == labels, position + offset, -1)


class FlatMesh:
    """The whole mesh, with names resolved as a step sees them."""

    def __init__(self, structure: Structure, problems: Problems) -> None:
        self._problems = problems
        self.warn = problems.warn
        self._owners: dict[str, Owner] = {}
        blocks_of = structure.of_instances
        definitions = _definitions(structure.root, {}, problems)
        definitions_of = {name: _definitions(blocks, definitions, problems) for name, blocks in blocks_of.items()}
        problems.check()
        for name, scope in structure.instances.items():
            self._add_owner(name, blocks_of[name], LocalMesh(definitions_of[name], problems.warn))
            with problems.gather():
                self._owners[name].placement = read_placement(scope.head)
        root = LocalMesh(definitions, problems.warn, {name: owner.mesh for name, owner in self._owners.items()})
        root.assembly = structure.assembly.name if structure.assembly else ""
        root.find_instance_node = self._instance_node
        self._add_owner(ROOT, structure.root, root)
        problems.check()
        self.mesh = self._make_mesh()
        offset = 0
        for owner in self.owners:
            owner.elements, owner.element_offset = np.array(sorted(owner.mesh.run_of), dtype=np.int64), offset
            offset += len(owner.elements)
        self.nsets = self._resolve_sets("NSET")
        self.elsets = self._resolve_sets("ELSET")

    @property
    def owners(self) -> list[Owner]:
        """Instances in their order, then the root."""
        return list(self._owners.values())

    @property
    def element_count(self) -> int:
        """Number of elements, whose positions begin at 0."""
        return sum(len(owner.elements) for owner in self.owners)

    def owner_of(self, position: int) -> Owner:
        """Return the instance, or the root, that has an element, by its position."""
        owners = (owner for owner in reversed(self.owners) if len(owner.elements))
        return next(owner for owner in owners if owner.element_offset <= position)

    def element_name(self, position: int) -> str:
        """Return the number of an element, with its instance if it has one."""
        owner = self.owner_of(position)
        return full_name(owner.name, int(owner.elements[position - owner.element_offset]))

    @property
    def root(self) -> LocalMesh:
        """Mesh of the nodes, elements and sets that belong to no instance."""
        return self._owners[ROOT].mesh

    def nodes(self, name: str, source: Source, owner: str = ROOT) -> IntArray:
        """Return the node indices of a number, a set, INSTANCE.number or INSTANCE.SET.
        Raises DeckError if it is unknown.
        """
        return self._resolve("NSET", name, source, owner)

    def elements(self, name: str, source: Source, owner: str = ROOT) -> IntArray:
        """Return the element positions of a number, a set, INSTANCE.number or INSTANCE.SET.
        Raises DeckError if it is unknown.
        """
        return self._resolve("ELSET", name, source, owner)

    def _resolve(self, kind: str, name: str, source: Source, owner: str) -> IntArray:
        outer, _, label = (owner, "", name.split(".", maxsplit=1)[0]) if is_integer(name) else name.rpartition(".")
        instance = outer.rpartition(".")[2]
        if (outer or is_integer(name)) and is_integer(label) and instance in self._owners:
            place = self._owners[instance]
            find = place.find_nodes if kind == "NSET" else place.find_elements
            found = find(np.array([min(int(label), LARGEST_INTEGER)]))
            if found[0] < 0:
                raise DeckError(source, f"{'node' if kind == 'NSET' else 'element'} {name} is not defined")
            return found
        self._owners[owner].mesh.find_set(kind, name, source)
        sets = self.nsets if kind == "NSET" else self.elsets
        local = name.split(".")
        candidates = [f"{owner}.{name}" if owner else name, ".".join(local[-2:]), local[-1]]
        return next(sets[key] for key in candidates if key in sets)

    def _add_owner(self, name: str, blocks: list[Block], mesh: LocalMesh) -> None:
        readers: dict[str, Callable[[Block], None]] = {
            "NODE": mesh.read_node,
            "SYSTEM": mesh.read_system,
            "ELEMENT": mesh.read_element,
            "NSET": mesh.read_set,
            "ELSET": mesh.read_set,
            **{keyword.name: partial(make, mesh) for keyword, make in GENERATORS},
        }
        for block in blocks:
            if block.name in readers:
                with self._problems.gather():
                    readers[block.name](block)
        offset = sum(len(owner.nodes) for owner in self.owners)
        self._owners[name] = Owner(name, mesh, blocks, IDENTITY, *mesh.nodes(), offset)

    def _instance_node(self, instance: str, label: int) -> int | None:
        index = int(self._owners[instance].find_nodes(np.array([label]))[0])
        return index if index >= 0 else None

    def displace(self, change: FloatArray) -> None:
        """Move the nodes of the whole model by (n, 3)."""
        self.mesh = replace(self.mesh, coordinates=self.mesh.coordinates + change)

    def _make_mesh(self) -> Mesh:
        points, names, normals = [], [], []
        for owner in self.owners:
            points.append(owner.placement.move(owner.points))
            given = np.zeros_like(owner.points)
            if owner.mesh.normals:
                given[np.searchsorted(owner.nodes, list(owner.mesh.normals))] = list(owner.mesh.normals.values())
            normals.append(owner.placement.turn(given))
            names += [owner.name] * len(owner.nodes)
        labels = np.concatenate([owner.nodes for owner in self.owners])
        whole = np.concatenate(normals)
        return Mesh(labels, np.concatenate(points), tuple(names), whole if whole.any() else None)

    def _resolve_sets(self, kind: str) -> dict[str, IntArray]:
        """Return the sets of the whole model; warn of labels that do not exist and leave them out."""
        found = {}
        for owner in self.owners:
            for name, members in owner.mesh.sets(kind).items():
                parts = [self._resolve_members(kind, owner, name, part) for part in members]
                whole = np.concatenate(parts) if parts else np.zeros(0, dtype=np.int64)
                if kind == "NSET" and name in owner.mesh.unsorted:
                    whole = whole[np.sort(np.unique(whole, return_index=True)[1])]
                elif not (whole[1:] > whole[:-1]).all():
                    whole = np.unique(whole)
                found[f"{owner.name}.{name}" if owner.name else name] = whole
        return found

    def _resolve_members(self, kind: str, owner: Owner, name: str, part: Members) -> IntArray:
        place = self._owners[part.instance] if part.instance else owner
        found = place.find_nodes(part.labels) if kind == "NSET" else place.find_elements(part.labels)
        missing = part.labels[found < 0]
        if len(missing):
            what = "node" if kind == "NSET" else "element"
            more = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
            self._problems.warn(part.source, f"set {name}: {what} {missing[0]}{more} does not exist and is left out")
        return found[found >= 0]


def _definitions(blocks: list[Block], outer: Definitions, problems: Problems) -> dict[str, UserElement]:
    """Return the user elements of these blocks, added to those of the enclosing scope."""
    return {
        **outer,
        **read_definitions(blocks, "USER ELEMENT", partial(read_user_element, problems=problems), problems, "TYPE"),
    }
