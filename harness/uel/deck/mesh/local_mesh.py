# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Nodes, elements and sets of a part, an instance or the root, by label."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from uel.deck.error_report import nearest
from uel.deck.language.blocks import Block, Row
from uel.deck.language.numbers import integer_table, is_integer, read_integer, real_table
from uel.deck.language.table import INPUT, Keyword, Kind, Option, Where, ignored, one_of, refused, split_fields, unquote
from uel.deck.mesh.placement import IDENTITY, read_system
from uel.deck.sections.user_elements import Definitions, ElementType, find_type
from uel.errors import DeckError, Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import BEAM, BUILT_IN

LARGEST_LABEL = 999_999_999
MOST_GENERATED = {"nodes": 1_000_000, "elements": 1_000_000, "numbers": 10_000_000}
"""Largest number of generated items per scope, so that a typing error does not exhaust the memory."""
Point = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Members:
    """Part of a set: labels, their instance ('' for the scope of the set), and their location."""

    instance: str
    labels: IntArray
    source: Source


@dataclass(frozen=True, slots=True)
class ElementRun:
    """Elements of one type from one keyword: labels (m,), node labels (m, nodes), and location of each.

    A negative label is a node of an instance: -1 - its index in the model.
    """

    type: ElementType
    labels: IntArray
    nodes: IntArray
    source: Callable[[int], Source]

    def at(self, rows: IntArray) -> ElementRun:
        """Return the run of the elements in these rows."""
        indices = rows.tolist()
        return ElementRun(self.type, self.labels[rows], self.nodes[rows], lambda index: self.source(indices[index]))


def _rows(run: ElementRun) -> Iterable[tuple[int, list[int]]]:
    """Yield label and nodes of each element."""
    return zip(run.labels.tolist(), run.nodes.tolist(), strict=True)


class LocalMesh:
    """Nodes, elements and sets of one scope, from *NODE, *ELEMENT, *NSET, *ELSET and the generating keywords.

    The last definition of a node or element counts (Abaqus Analysis User's Guide, "Node definition", "Element
    definition"), with a warning if an earlier one differs.
    """

    def __init__(
        self,
        definitions: Definitions,
        warn: Callable[[Source, str], None],
        instances: Mapping[str, LocalMesh] | None = None,
    ) -> None:
        self._warn = warn
        self.definitions = definitions
        self.instances = instances or {}
        # coordinates of all definitions, and the index of the last one of each node
        self._points = array("d")
        self._definition_of: dict[int, int] = {}
        self.normals: dict[int, Point] = {}
        # additional nodes of beams, for n1, by element; numbers as in ElementRun
        self.orienting: dict[int, int] = {}
        self.runs: list[ElementRun] = []
        self.run_of: dict[int, int] = {}
        self.nsets: dict[str, list[Members]] = {}
        self.elsets: dict[str, list[Members]] = {}
        self.unsorted: set[str] = set()
        self.assembly = ""
        self.system = IDENTITY
        self._generated = dict.fromkeys(MOST_GENERATED, 0)
        # index in the model of a node of an instance; FlatMesh sets it before it reads the root
        self.find_instance_node: Callable[[str, int], int | None] = lambda instance, label: None

    def reserve(self, count: int, kind: str, row: Row) -> None:
        """Count generated 'nodes', 'elements' or 'numbers'. Raises DeckError if there are too many."""
        self._generated[kind] += count
        if self._generated[kind] > MOST_GENERATED[kind]:
            raise row.error(f"{count} {kind} are too many: at most {MOST_GENERATED[kind]} can be generated in total")

    def add_nodes(self, labels: IntArray, points: FloatArray, source: Callable[[int], Source]) -> None:
        """Add nodes."""
        first = len(self._points) // 3
        new = dict(zip(labels.tolist(), range(first, first + len(labels)), strict=True))
        again = new.keys() & self._definition_of.keys()
        if again or len(new) < len(labels):
            seen = {label: self._coordinates_of(label) for label in again}
            for index, (label, point) in enumerate(zip(labels.tolist(), map(tuple, points.tolist()), strict=True)):
                if seen.setdefault(label, point) != point:
                    self._warn(
                        source(index), f"node {label} is defined again, with other coordinates; this definition counts"
                    )
                seen[label] = point
        self._definition_of.update(new)
        self._points.frombytes(points.tobytes())

    def add_elements(self, run: ElementRun) -> None:
        """Add elements."""
        labels = run.labels.tolist()
        last = {label: index for index, label in enumerate(labels)}
        for label in last.keys() & self.orienting.keys():
            del self.orienting[label]
        again = last.keys() & self.run_of.keys()
        if again or len(last) < len(labels):
            known: dict[int, tuple[ElementType, list[int]]] = {}
            for k in {self.run_of[label] for label in again}:
                earlier = self.runs[k]
                known |= {label: (earlier.type, nodes) for label, nodes in _rows(earlier) if label in again}
                self.runs[k] = earlier.at(np.flatnonzero(~np.isin(earlier.labels, run.labels)))
            self._tell_changes(run, known)
            run = run.at(np.array(sorted(last.values())))
        self.run_of.update(dict.fromkeys(last, len(self.runs)))
        self.runs.append(run)

    def _tell_changes(self, run: ElementRun, known: dict[int, tuple[ElementType, list[int]]]) -> None:
        """Warn of elements that differ from an earlier definition; known: type and nodes of these."""
        for index, (label, nodes) in enumerate(_rows(run)):
            if known.setdefault(label, (run.type, nodes)) != (run.type, nodes):
                self._warn(run.source(index), f"element {label} is defined again, differently; this definition counts")
            known[label] = run.type, nodes

    def add_to_set(self, sets: dict[str, list[Members]], name: str, members: Iterable[Members]) -> None:
        """Extend a set, if it has a name."""
        if name:
            sets.setdefault(name, []).extend(members)

    def read_node(self, block: Block) -> None:
        """Read *NODE."""
        labels, values, source = _read_nodes(block)
        points, normals = values[:, :3], values[:, 3:]
        if self.system is not IDENTITY:
            points, normals = self.system.move(points), self.system.turn(normals)
        self.add_nodes(labels, points, source)
        nonzero = normals.any(axis=1)
        self.normals.update(zip(labels[nonzero].tolist(), map(tuple, normals[nonzero].tolist()), strict=True))
        self.add_to_set(self.nsets, block.options.text("NSET"), [Members("", labels, block.source)])

    def read_system(self, block: Block) -> None:
        """Read *SYSTEM."""
        self.system = read_system(block)

    def read_element(self, block: Block) -> None:
        """Read *ELEMENT."""
        name = block.options.text("ELSET")
        self.add_to_set(self.elsets, name, [])
        kind = find_type(block.options.text("TYPE"), self.definitions, block.source)
        labels, nodes, lines = self.connectivity(block, kind)
        self.add_elements(ElementRun(kind, labels, nodes, lambda index: block.source_of(lines[index])))
        of_line = dict(zip(lines.tolist(), labels.tolist(), strict=True))
        for index, text in _orienting_nodes(block, kind).items():
            self.orienting[of_line[index]] = self._node_reference(block, text, block.source_of(index))
        self.add_to_set(self.elsets, name, [Members("", labels, block.source)])

    def read_set(self, block: Block) -> None:
        """Read *NSET or *ELSET."""
        nodal = block.name == "NSET"
        sets = self.sets(block.name)
        name = block.options.text(block.name)
        self.add_to_set(sets, name, [])
        if nodal and block.options.flag("UNSORTED"):
            self.unsorted.add(name)
        if nodal and block.options.has("ELSET"):
            elements = self.find_set("ELSET", block.options.text("ELSET"), block.source)
            self.add_to_set(sets, name, self._nodes_of(elements))
        instance = block.options.text("INSTANCE")
        if instance and instance not in self.instances:
            raise block.error(f"unknown instance {instance}{nearest(instance, self.instances)}")
        if block.options.flag("GENERATE"):
            ranges = [self._range(block.row(index)) for index, line in enumerate(block.lines) if line.strip(", ")]
            self.add_to_set(sets, name, [Members(instance, labels, block.source) for labels in ranges])
        else:
            self.add_to_set(sets, name, self._listed(block, instance))

    def find_set(self, kind: str, name: str, source: Source) -> list[Members]:
        """Return the members of a node set ('NSET') or element set ('ELSET'), or of INSTANCE.NAME. Raises DeckError."""
        sets = self.sets(kind)
        if name in sets:
            return sets[name]
        instance, dot, local = name.rpartition(".")
        if dot and instance == self.assembly and local in sets:
            return sets[local]
        instance = instance.rpartition(".")[2]
        if dot and instance in self.instances and local in self.instances[instance].sets(kind):
            members = self.instances[instance].sets(kind)[local]
            return [replace(entry, instance=instance) for entry in members]
        known = [*sets, *(f"{key}.{inner}" for key, mesh in self.instances.items() for inner in mesh.sets(kind))]
        kind_name = "node set" if kind == "NSET" else "element set"
        raise DeckError(source, f"unknown {kind_name} {name}{nearest(name, known)}")

    def sets(self, kind: str) -> dict[str, list[Members]]:
        """Return the node sets ('NSET') or element sets ('ELSET')."""
        return self.nsets if kind == "NSET" else self.elsets

    def node_labels(self, name: str, source: Source) -> IntArray:
        """Return the labels of a node set of this scope in ascending order, or of one node by its number."""
        if is_integer(name):
            return np.array([int(name.split(".", maxsplit=1)[0])])
        members = self.find_set("NSET", name, source)
        labels = [entry.labels for entry in members if not entry.instance]
        return np.unique(np.concatenate(labels)) if labels else np.zeros(0, dtype=np.int64)

    def nodes(self) -> tuple[IntArray, FloatArray]:
        """Return the labels of all nodes in ascending order, and their coordinates (n, 3)."""
        labels = sorted(self._definition_of)
        points = np.array(self._points).reshape(-1, 3)[[self._definition_of[label] for label in labels]]
        return np.array(labels, dtype=np.int64), points

    def point(self, label: int, source: Source) -> Point:
        """Return the coordinates of a node. Raises DeckError if it is not defined."""
        if label not in self._definition_of:
            raise DeckError(source, f"node {label} is not defined")
        return self._coordinates_of(label)

    def _coordinates_of(self, label: int) -> Point:
        start = 3 * self._definition_of[label]
        x, y, z = self._points[start : start + 3]
        return x, y, z

    def element(self, label: int, source: Source) -> tuple[ElementType, IntArray]:
        """Return type and node labels of an element. Raises DeckError if it is not defined."""
        if label not in self.run_of:
            raise DeckError(source, f"element {label} is not defined")
        run = self.runs[self.run_of[label]]
        return run.type, run.nodes[int(np.flatnonzero(run.labels == label)[0])]

    def _nodes_of(self, elements: list[Members]) -> list[Members]:
        nodes = []
        for entry in elements:
            mesh = self.instances[entry.instance] if entry.instance else self
            labels = [run.nodes[np.isin(run.labels, entry.labels)].ravel() for run in mesh.runs]
            if labels:
                nodes.append(replace(entry, labels=np.unique(np.concatenate(labels))))
        return nodes

    def _listed(self, block: Block, instance: str) -> list[Members]:
        """Return labels and set names of the data lines of *NSET and *ELSET."""
        tokens = [token for line in block.lines for token in line.split(",")]
        try:
            if any("_" in token for token in tokens):
                raise ValueError
            labels = [int(token) for token in tokens if token.strip()]
            if not labels or max(labels) <= LARGEST_LABEL:
                return [Members(instance, np.array(labels, dtype=np.int64), block.source)]
        except ValueError:
            pass
        members: list[Members] = []
        for row in block.rows():
            for index in range(len(row)):
                if not row.blank(index):
                    members += self._member(block.name, unquote(row.fields[index]), instance, row.source)
        return members

    def _range(self, row: Row) -> IntArray:
        """Return the labels of a GENERATE line: first, last, increment (1), negative in some public decks."""
        first = row.integer(0, "first number")
        last = row.integer(1, "last number", first)
        step = row.integer(2, "increment", 1)
        if step == 0 or (last - first) * step < 0 or min(first, last) < 1:
            raise row.error(f"cannot generate from {first} to {last} in steps of {step}")
        self.reserve((last - first) // step + 1, "numbers", row)
        if max(first, last) > LARGEST_LABEL:
            raise row.error(f"{max(first, last)} is not a node or element number (1 to {LARGEST_LABEL})")
        return np.arange(first, last + (1 if step > 0 else -1), step, dtype=np.int64)

    def _member(self, kind: str, token: str, instance: str, source: Source) -> list[Members]:
        if is_integer(token):
            return [Members(instance, np.array([_label(token, source)]), source)]
        owner, dot, label = token.rpartition(".")
        owner = owner.rpartition(".")[2]
        if dot and is_integer(label) and owner in self.instances:
            return [Members(owner, np.array([_label(label, source)]), source)]
        return self.find_set(kind, f"{instance}.{token}" if instance else token, source)

    def connectivity(self, block: Block, kind: ElementType) -> tuple[IntArray, IntArray, IntArray]:
        """Return labels, node labels and data line of each element."""
        table = integer_table(block.lines)
        if table is not None and table.shape[1] == kind.nodes + 1 and 0 < table.min() <= table.max() <= LARGEST_LABEL:
            return table[:, 0], table[:, 1:], np.arange(len(table))
        labels: list[int] = []
        nodes: list[list[int]] = []
        lines: list[int] = []
        entries: list[int] = []
        orienting = _orienting_nodes(block, kind)
        for index, line in enumerate(block.lines):
            fields = _entries(line)
            if not fields:
                continue
            if index in orienting:
                fields.pop()
            source = block.source_of(index)
            if not entries:
                lines.append(index)
            before = len(entries)
            entries += [self._node_reference(block, field, source) for field in fields]
            if len(entries) > kind.nodes + 1:
                raise DeckError(
                    block.source_of(lines[-1]), _wrong_count(entries[0], kind, (before or len(entries)) - 1)
                )
            if len(entries) == kind.nodes + 1:
                labels.append(_label(str(entries[0]), source))
                nodes.append(entries[1:])
                entries = []
        if entries:
            raise DeckError(block.source_of(lines[-1]), _wrong_count(entries[0], kind, len(entries) - 1))
        shape = (len(labels), kind.nodes)
        return np.array(labels, dtype=np.int64), np.array(nodes, dtype=np.int64).reshape(shape), np.array(lines)

    def _node_reference(self, block: Block, text: str, source: Source) -> int:
        """Return the label of a node of this scope, or the negative code of INSTANCE.label. Raises DeckError."""
        if is_integer(text):
            return _label(text, source)
        instance, dot, label = unquote(text).rpartition(".")
        instance = instance.rpartition(".")[2]
        if dot and is_integer(label) and instance in self.instances:
            index = self.find_instance_node(instance, int(label))
            if index is None:
                raise DeckError(source, f"node {unquote(text)} is not defined")
            return -1 - index
        raise DeckError(source, f"*{block.name}: '{text}' is not a node number")


def _entries(line: str) -> list[str]:
    """Return the entries of a line without trailing blank ones."""
    fields = split_fields(line)
    while fields and not fields[-1]:
        fields.pop()
    return fields


def _orienting_nodes(block: Block, kind: ElementType) -> dict[int, str]:
    """Return the additional node of beams in space, for n1, by the index of the line."""
    if kind.name not in BEAM or BEAM[kind.name].dimension == 2:
        return {}
    numbered = ((index, _entries(line)) for index, line in enumerate(block.lines))
    return {index: fields[-1] for index, fields in numbered if len(fields) == kind.nodes + 2}


def _wrong_count(element: int, kind: ElementType, nodes: int) -> str:
    return f"element {element} has {nodes} nodes, but {kind.name} needs {kind.nodes}"


def _label(text: str, source: Source) -> int:
    try:
        label = read_integer(text)
    except ValueError as error:
        raise DeckError(source, str(error)) from None
    if not 0 < label <= LARGEST_LABEL:
        raise DeckError(source, f"{label} is not a node or element number (1 to {LARGEST_LABEL})")
    return label


def _read_nodes(block: Block) -> tuple[IntArray, FloatArray, Callable[[int], Source]]:
    """Read labels, (n, 6) coordinates and direction cosines of the normal, and the location of each."""
    # integers first: as a real number, 2e0 would be a label
    labels = integer_table(block.lines, columns=1)
    if labels is not None and 0 < labels.min() <= labels.max() <= LARGEST_LABEL:
        table = real_table(block.lines)
        if table is not None and table.shape[1] <= 7:
            points = np.zeros((len(table), 6))
            points[:, : table.shape[1] - 1] = table[:, 1:]
            return labels[:, 0], points, block.source_of
    rows = list(block.rows())
    label_array = np.array([_label(row.text(0, "node number"), row.source) for row in rows], dtype=np.int64)
    points = np.zeros((len(rows), 6))
    names = [f"{quantity} {k}" for quantity in ("coordinate", "direction cosine") for k in (1, 2, 3)]
    for index, row in enumerate(rows):
        row.at_most(7)
        points[index] = [row.real(column, name, 0.0) for column, name in enumerate(names, 1)]
    return label_array, points, lambda index: rows[index].source


TAKES_NODES = Option("NSET", Kind.NAME, "set that takes the nodes")
TAKES_ELEMENTS = Option("ELSET", Kind.NAME, "set that takes the elements")
_GENERATE = Option("GENERATE", doc="data lines are first, last, increment, negative where last is the smaller")
_INSTANCE = Option("INSTANCE", Kind.NAME, "instance the labels belong to")

KEYWORDS = (
    Keyword(
        "NODE",
        "Define nodes by coordinates.",
        Where.MODEL,
        (TAKES_NODES, one_of("SYSTEM", "R: rectangular", ("R",), refused=("C", "S")), INPUT),
        "node, x, y, z, direction cosines of the normal (of shells; n2 of beams in space)",
    ),
    Keyword(
        "ELEMENT",
        "Define elements by their nodes.",
        Where.MODEL,
        (
            Option("TYPE", Kind.NAME, f"Un; or built in: {', '.join(BUILT_IN)}", required=True),
            TAKES_ELEMENTS,
            INPUT,
            *refused("FILE", "OFFSET", "SOLID ELEMENT NUMBERING"),
        ),
        "element, nodes; continued on further lines where a line ends before the last node; beams in space with "
        "an additional node that gives n1 on one line",
    ),
    Keyword(
        "NSET",
        "Define or extend a node set.",
        Where.MODEL,
        (
            Option("NSET", Kind.NAME, "set", required=True),
            _GENERATE,
            Option("ELSET", Kind.NAME, "take the nodes of these elements"),
            _INSTANCE,
            Option("UNSORTED", doc="keep the order, which matters in *EQUATION"),
            INPUT,
            *ignored("INTERNAL"),
        ),
        "nodes and node sets",
    ),
    Keyword(
        "ELSET",
        "Define or extend an element set.",
        Where.MODEL,
        (
            Option("ELSET", Kind.NAME, "set", required=True),
            _GENERATE,
            _INSTANCE,
            INPUT,
            *ignored("INTERNAL", "UNSORTED"),
        ),
        "elements and element sets",
    ),
)
