# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Flatten parts and instances to one mesh: nodes, elements, sets and element groups of the model."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block, Row
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
    """Instance, or the root: its mesh, its blocks, and the positions of its nodes and elements in the model."""

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
        """Return indices in the model, -1 for undefined nodes."""
        return _find(self.nodes, labels, self.node_offset)

    def find_elements(self, labels: IntArray) -> IntArray:
        """Return positions in the model, -1 for undefined elements."""
        return _find(self.elements, labels, self.element_offset)


def _find(sorted_labels: IntArray, labels: IntArray, offset: int) -> IntArray:
    if not len(sorted_labels):
        return np.full(len(labels), -1)
    position = np.minimum(np.searchsorted(sorted_labels, labels), len(sorted_labels) - 1)
    return np.where(sorted_labels[position] == labels, position + offset, -1)


class FlatMesh:
    """Mesh of the model, with names as in steps."""

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

    def blocks(self, *names: str) -> Iterator[tuple[Block, Owner]]:
        """Yield the keywords of these names, with the instance or root that has them."""
        return ((block, owner) for owner in self.owners for block in owner.blocks if block.name in names)

    def one_node(self, name: str, label: str, location: Row | Block, owner: str = ROOT) -> int:
        """Return the index of a single node; label: option or entry that names it. Raises DeckError."""
        nodes = self.nodes(name, location.source, owner)
        if len(nodes) != 1:
            raise location.error(f"{label} has {len(nodes)} nodes, expected one")
        return int(nodes[0])

    @property
    def element_count(self) -> int:
        """Number of elements, whose positions begin at 0."""
        return sum(len(owner.elements) for owner in self.owners)

    def owner_of(self, position: int) -> Owner:
        """Return the instance, or the root, of the element at a position."""
        owners = (owner for owner in reversed(self.owners) if len(owner.elements))
        return next(owner for owner in owners if owner.element_offset <= position)

    def element_name(self, position: int) -> str:
        """Return the label of an element, with its instance if any."""
        owner = self.owner_of(position)
        return full_name(owner.name, int(owner.elements[position - owner.element_offset]))

    @property
    def root(self) -> LocalMesh:
        """Mesh of the nodes, elements and sets that belong to no instance."""
        return self._owners[ROOT].mesh

    def nodes(self, name: str, source: Source, owner: str = ROOT) -> IntArray:
        """Return the node indices of a label, a set, INSTANCE.label or INSTANCE.SET. Raises DeckError."""
        return self._resolve("NSET", name, source, owner)

    def elements(self, name: str, source: Source, owner: str = ROOT) -> IntArray:
        """Return the element positions of a label, a set, INSTANCE.label or INSTANCE.SET. Raises DeckError."""
        return self._resolve("ELSET", name, source, owner)

    def _resolve(self, kind: str, name: str, source: Source, owner: str) -> IntArray:
        outer, _, label = (owner, "", name.split(".", maxsplit=1)[0]) if is_integer(name) else name.rpartition(".")
        instance = outer.rpartition(".")[2]
        if (outer or is_integer(name)) and is_integer(label) and instance in self._owners:
            scope = self._owners[instance]
            find = scope.find_nodes if kind == "NSET" else scope.find_elements
            position = find(np.array([min(int(label), LARGEST_INTEGER)]))
            if position[0] < 0:
                raise DeckError(source, f"{'node' if kind == 'NSET' else 'element'} {name} is not defined")
            return position
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
        """Move the nodes of the model by (n, 3)."""
        self.mesh = replace(self.mesh, coordinates=self.mesh.coordinates + change)

    def _make_mesh(self) -> Mesh:
        points, names, normals = [], [], []
        for owner in self.owners:
            points.append(owner.placement.move(owner.points))
            own_normals = np.zeros_like(owner.points)
            if owner.mesh.normals:
                own_normals[np.searchsorted(owner.nodes, list(owner.mesh.normals))] = list(owner.mesh.normals.values())
            normals.append(owner.placement.turn(own_normals))
            names += [owner.name] * len(owner.nodes)
        labels = np.concatenate([owner.nodes for owner in self.owners])
        all_normals = np.concatenate(normals)
        return Mesh(labels, np.concatenate(points), tuple(names), all_normals if all_normals.any() else None)

    def _resolve_sets(self, kind: str) -> dict[str, IntArray]:
        """Return the sets of the model; warn of undefined labels and drop them."""
        sets = {}
        for owner in self.owners:
            for name, members in owner.mesh.sets(kind).items():
                positions = [self._resolve_members(kind, owner, name, entry) for entry in members]
                union = np.concatenate(positions) if positions else np.zeros(0, dtype=np.int64)
                if kind == "NSET" and name in owner.mesh.unsorted:
                    union = union[np.sort(np.unique(union, return_index=True)[1])]
                elif not (union[1:] > union[:-1]).all():
                    union = np.unique(union)
                sets[f"{owner.name}.{name}" if owner.name else name] = union
        return sets

    def _resolve_members(self, kind: str, owner: Owner, name: str, entry: Members) -> IntArray:
        scope = self._owners[entry.instance] if entry.instance else owner
        positions = scope.find_nodes(entry.labels) if kind == "NSET" else scope.find_elements(entry.labels)
        missing = entry.labels[positions < 0]
        if len(missing):
            item = "node" if kind == "NSET" else "element"
            more = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
            self._problems.warn(entry.source, f"set {name}: {item} {missing[0]}{more} does not exist and is left out")
        return positions[positions >= 0]


def _definitions(blocks: list[Block], outer: Definitions, problems: Problems) -> dict[str, UserElement]:
    """Return the user elements of blocks, with those of the enclosing scope."""
    return {
        **outer,
        **read_definitions(blocks, "USER ELEMENT", partial(read_user_element, problems=problems), problems, "TYPE"),
    }
