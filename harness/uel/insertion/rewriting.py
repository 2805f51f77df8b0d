# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Text of a deck with a cut mesh; unchanged lines stay, with their comments.

Where a node is duplicated:

- elements: solids on the other side of the cut get the new node, and so do adjacent interface elements;
- node sets, and surfaces of nodes, get the new nodes too: boundary conditions and constraints apply to both;
- concentrated loads, fluxes and films stay on the old node, so that the load is not doubled; loads on the nodes of an
  element set stay on one node of these elements;
- *EQUATION and *MPC are repeated for each duplicate of the first node, which is eliminated; their other nodes are
  replaced by the duplicates on the same side;
- springs, masses and trusses stay on the old node.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from uel.deck.constraints.equations import TERM_FIELDS
from uel.deck.language.blocks import Block, Row
from uel.deck.language.numbers import is_integer
from uel.deck.language.table import compact, split_fields, unquote
from uel.deck.mesh.flatten import Owner
from uel.deck.mesh.generation import KEYWORDS as GENERATING
from uel.deck.sections.user_elements import find_type
from uel.delamination.keywords import PER_LINE, keyword, wrapped
from uel.insertion.assembly import Deck
from uel.insertion.cut import Cut
from uel.model.arrays import IntArray
from uel.model.mesh import full_name

_NODAL = ("BOUNDARY", "INITIAL CONDITIONS", "TEMPERATURE", "FIELD", "PRESSURE STRESS", "KINEMATIC COUPLING")
"""Keywords whose data lines begin with a node or node set, and apply to its duplicates."""
_LOADS = ("CLOAD", "CFLUX", "CECHARGE", "CFILM", "CRADIATE")
_NODE_BLOCKS = ("NODE", *(entry.name for entry in GENERATING if entry.name != "ELGEN"))
_LOADED = "-OLD"
"""Suffix of the names of sets of old nodes."""


@dataclass(slots=True)
class Edits:
    """Changes of the text, by block identity.

    lines   replacement of a data line, by its index in the block
    blocks  replacement of a block
    after   lines after the block
    """

    lines: dict[tuple[int, int], list[str]] = field(default_factory=dict)
    blocks: dict[int, list[str]] = field(default_factory=dict)
    after: dict[int, list[str]] = field(default_factory=dict)

    def append(self, block: Block, lines: Sequence[str]) -> None:
        """Add lines after a block."""
        self.after.setdefault(id(block), []).extend(lines)


class Rewriting:
    """Editor of a deck for a cut."""

    def __init__(self, deck: Deck, cut: Cut) -> None:
        self._deck, self._cut = deck, cut
        self.edits = Edits()
        self._changed: dict[int, IntArray] = {}
        self._count = len(deck.flat.mesh.labels)
        self._copies = cut.copies(self._count)
        self._doubled = np.zeros(self._count, dtype=bool)
        self._doubled[list(self._copies)] = True
        self._doubled = self._doubled[deck.node_of]
        self._owners = {id(block): owner for owner in deck.first.values() for block in owner.blocks}
        self._order = {id(block): index for index, block in enumerate(deck.blocks)}
        self._number_nodes()

    def _number_nodes(self) -> None:
        """Label the new nodes, from the largest label of their part on."""
        self._labels = np.concatenate([self._deck.flat.mesh.labels, np.zeros(len(self._cut.origins), dtype=np.int64)])
        self._new: dict[str, IntArray] = {}
        for owner in self._deck.first.values():
            inside = self._cut.origins - owner.node_offset
            mine = np.flatnonzero((inside >= 0) & (inside < len(owner.nodes)))
            if len(mine):
                self._labels[self._count + mine] = owner.nodes.max() + 1 + np.arange(len(mine))
                self._new[owner.name] = self._count + mine

    def labels(self, nodes: IntArray) -> IntArray:
        """Return the labels of nodes, old or new."""
        return np.asarray(self._labels[nodes])

    def write_nodes(self) -> None:
        """Write *NODE of the new nodes of each part, after its other nodes."""
        for name, nodes in self._new.items():
            owner = self._owner(name)
            local = owner.points[self._cut.origins[nodes - self._count] - owner.node_offset]
            # all digits: duplicates coincide
            rows = zip(self._labels[nodes].tolist(), local.tolist(), strict=True)
            lines = ["** nodes doubled by uel insert", "*NODE", *(", ".join(map(repr, (n, *x))) for n, x in rows)]
            if any(block.name == "SYSTEM" for block in owner.blocks):
                lines.insert(1, "*SYSTEM")
            self.edits.append(self._last(owner, *_NODE_BLOCKS), lines)

    def write_elements(self, new: dict[int, IntArray]) -> None:
        """Write the new connectivity of elements; new: nodes by element position."""
        self._changed = new
        for owner in self._deck.first.values():
            rows = {
                int(owner.elements[position - owner.element_offset]): nodes
                for position, nodes in new.items()
                if 0 <= position - owner.element_offset < len(owner.elements)
            }
            if not rows:
                continue
            for block in owner.blocks:
                if block.name == "ELEMENT":
                    self._rewrite_element_block(owner, block, rows)
                elif block.name == "ELGEN":
                    self._rewrite_generated(owner, block, rows)

    def _rewrite_element_block(self, owner: Owner, block: Block, new: dict[int, IntArray]) -> None:
        kind = find_type(block.options.text("TYPE"), owner.mesh.definitions, block.source)
        labels, nodes, lines = owner.mesh.connectivity(block, kind)
        ends = [*lines[1:].tolist(), len(block.lines)]
        for row in np.flatnonzero(np.isin(labels, list(new))).tolist():
            connectivity = self._labels[new[int(labels[row])]]
            if len(connectivity) == nodes.shape[1]:
                first = int(lines[row])
                self.edits.lines[id(block), first] = element_lines(int(labels[row]), connectivity)
                for other in range(first + 1, ends[row]):
                    self.edits.lines[id(block), other] = []

    def _rewrite_generated(self, owner: Owner, block: Block, new: dict[int, IntArray]) -> None:
        """Replace *ELGEN by *ELEMENT where generated elements change."""
        sources = {block.source_of(index) for index in range(len(block.lines))}
        runs = [run for run in owner.mesh.runs if len(run.labels) and run.source(0) in sources]
        if not any(np.isin(run.labels, list(new)).any() for run in runs):
            return
        name = block.options.text("ELSET")
        lines = ["** *ELGEN, written out by uel insert"]
        if name:
            masters = [row.fields[0] for row in block.rows()]
            lines += [keyword("ELSET", ELSET=quoted(name)), *masters]
        for run in runs:
            lines.append(keyword("ELEMENT", TYPE=run.type.name, **({"ELSET": quoted(name)} if name else {})))
            for label, nodes in zip(run.labels.tolist(), run.nodes, strict=True):
                connectivity = self._labels[new[label]] if label in new else nodes
                lines += element_lines(label, connectivity)
        self.edits.blocks[id(block)] = lines

    def write_sets(self) -> None:
        """Add the duplicates to the node sets, and write sets of old nodes for loads."""
        loaded = self._rename_loads()
        flat = self._deck.flat
        for owner in self._deck.first.values():
            for name in owner.mesh.nsets:
                key = f"{owner.name}.{name}" if owner.name else name
                members = flat.nsets[key]
                lines: list[str] = []
                blocks = [block for block in owner.blocks if _defines(block, name)]
                follows = all(block.name == "NSET" and block.options.has("ELSET") for block in blocks)
                if key in loaded:
                    present = self._nodes_after(owner, blocks) if follows else None
                    lines += self._set_lines(owner, f"{name}{_LOADED}", self._one_each(members, present))
                doubles = [
                    (int(node), copy)
                    for node in members[self._doubled[members]].tolist()
                    for copy in self._copies[int(self._deck.node_of[node])]
                ]
                if doubles and not follows:
                    lines += self._set_lines(owner, name, doubles)
                if lines:
                    last = [*blocks, *(block for block in owner.blocks if block.name in _NODE_BLOCKS)]
                    self.edits.append(max(last, key=lambda block: self._order[id(block)]), lines)

    def _one_each(self, members: IntArray, present: set[int] | None) -> list[tuple[int, int]]:
        """Return each node with itself or, where a set has only duplicates of it, with one of these."""
        pairs = []
        for node in members.tolist():
            old = int(self._deck.node_of[node])
            nodes = (old, *self._copies.get(old, []))
            pairs.append((node, next((each for each in nodes if present is None or each in present), old)))
        return pairs

    def _nodes_after(self, owner: Owner, blocks: Sequence[Block]) -> set[int]:
        """Return the nodes of *NSET, ELSET= after the cut."""
        elements = [self._deck.flat.elements(b.options.text("ELSET"), b.source, owner.name) for b in blocks]
        positions = self._deck.element_of[np.concatenate(elements)]
        node_set: set[int] = set()
        for run in self._deck.runs:
            for row in np.flatnonzero(np.isin(run.positions, positions)).tolist():
                nodes = self._changed.get(int(run.positions[row]), run.nodes[row])
                node_set |= set(nodes.tolist())
        return node_set

    def _set_lines(self, owner: Owner, name: str, members: Sequence[tuple[int, int]]) -> list[str]:
        """Write *NSET of pairs of an old node, whose instance counts, and the node."""
        lines: list[str] = []
        of: dict[str, list[int]] = {}
        for old, node in members:
            instance_name = self._deck.owner_of_node(old).name
            of.setdefault("" if instance_name == owner.name else instance_name, []).append(int(self._labels[node]))
        for instance, labels in of.items():
            options = {"NSET": quoted(name)} | ({"INSTANCE": quoted(instance)} if instance else {})
            lines += [keyword("NSET", **options), *wrapped(labels)]
        return lines

    def _rename_loads(self) -> set[str]:
        """Move loads on sets with duplicated nodes to sets of the old nodes; return the names of the former."""
        renamed: set[str] = set()
        for block in self._deck.blocks:
            if block.name not in _LOADS:
                continue
            for index, row in _numbered_rows(block):
                name = row.name(0, "node or node set")
                if is_integer(name) or is_integer(name.rpartition(".")[2]):
                    continue
                if self._doubled[self._deck.flat.nodes(name, row.source)].any():
                    key = next(
                        k
                        for k in (name, ".".join(name.split(".")[-2:]), name.split(".")[-1])
                        if k in self._deck.flat.nsets
                    )
                    first = self._first_name(key)
                    renamed.add(first)
                    self.edits.lines[id(block), index] = [", ".join([quoted(f"{name}{_LOADED}"), *row.fields[1:]])]
        return renamed

    def _first_name(self, key: str) -> str:
        """Return the name of a set in the first instance of its part."""
        instance, dot, name = key.rpartition(".")
        first = self._deck.first.get(self._deck.part_of.get(instance, ""))
        return f"{first.name}.{name}" if dot and first is not None else key

    def write_nodal_lines(self) -> None:
        """Repeat data lines of single nodes for their duplicates."""
        for block in self._deck.blocks:
            nodal = block.name in _NODAL or (block.name == "SURFACE" and block.options.text("TYPE") == "NODE")
            if not nodal or (
                block.name == "INITIAL CONDITIONS" and block.options.text("TYPE") in ("SOLUTION", "STRESS")
            ):
                continue
            for index, row in _numbered_rows(block):
                name = row.name(0, "node or node set")
                copies = self._copies_of_label(block, name, row)
                if copies:
                    again = [", ".join([copy, *row.fields[1:]]) for copy in copies]
                    self.edits.lines[id(block), index] = [block.lines[index], *again]

    def _copies_of_label(self, block: Block, name: str, row: Row) -> list[str]:
        """Return the names of the duplicates of a single node, in the style of its data line."""
        instance, _, label = name.rpartition(".")
        if not is_integer(label) and not is_integer(name):
            return []
        # blocks of steps refer to the model
        owner = self._owners.get(id(block), self._deck.owners[-1])
        node = int(self._deck.flat.nodes(name, row.source, owner.name)[0])
        before = f"{instance}." if instance and not is_integer(name) else ""
        return [f"{before}{self._labels[copy]}" for copy in self._copies.get(int(self._deck.node_of[node]), [])]

    def write_equations(self) -> None:
        """Write *EQUATION and *MPC with duplicated nodes."""
        for owner in self._deck.first.values():
            for block in owner.blocks:
                if block.name == "EQUATION":
                    self._equations(owner, block)
                elif block.name == "MPC":
                    for index, row in _numbered_rows(block):
                        sets = [self._nodes(owner, row, k) for k in range(1, len(row))]
                        if any(self._doubled[nodes].any() for nodes in sets):
                            new = [
                                ", ".join([row.fields[0], *(self._reference(owner, *node) for node in nodes)])
                                for nodes in self._tuples(sets)
                            ]
                            self.edits.lines[id(block), index] = new

    def _equations(self, owner: Owner, block: Block) -> None:
        rows = list(_numbered_rows(block))
        while rows:
            index0, head = rows.pop(0)
            count, indices = head.integer(0, "number of terms"), [index0]
            terms: list[tuple[IntArray, tuple[str, ...]]] = []
            while rows and len(terms) < count:
                index, row = rows.pop(0)
                indices.append(index)
                for start in range(0, len(row), TERM_FIELDS):
                    terms.append((self._nodes(owner, row, start), row.fields[start + 1 : start + TERM_FIELDS]))
            if not any(self._doubled[nodes].any() for nodes, _ in terms):
                continue
            lines: list[str] = []
            for nodes in self._tuples([nodes for nodes, _ in terms]):
                lines.append(str(len(terms)))
                lines += [
                    ", ".join([self._reference(owner, *node), *rest])
                    for node, (_, rest) in zip(nodes, terms, strict=True)
                ]
            for index in indices:
                self.edits.lines[id(block), index] = []
            self.edits.lines[id(block), indices[0]] = lines

    def _nodes(self, owner: Owner, row: Row, index: int) -> IntArray:
        return self._deck.flat.nodes(row.name(index, "node or node set"), row.source, owner.name)

    def _tuples(self, sets: Sequence[IntArray]) -> Iterator[list[tuple[int, int]]]:
        """Yield the old and new node of each term, for each node of the first set and each of its duplicates."""
        size = len(sets[0])
        for nodes in zip(*(np.resize(each, size).tolist() for each in sets), strict=True):
            first = int(self._deck.node_of[nodes[0]])
            for number in (first, *self._copies.get(first, [])):
                yield [(nodes[0], number), *((node, self._same_side(node, number)) for node in nodes[1:])]

    def _same_side(self, node: int, other: int) -> int:
        """Return, of a node and its duplicates, the one with solids on the same side as another node."""
        old = int(self._deck.node_of[node])
        candidates = [old, *self._copies.get(old, [])]
        if len(candidates) == 1 or not self._cut.towards[other].any():
            return old
        towards = self._cut.towards[candidates]
        length = np.maximum(np.linalg.norm(towards, axis=1), np.finfo(float).tiny)
        return candidates[int(np.argmax(np.round(towards @ self._cut.towards[other] / length, 12)))]

    def _reference(self, owner: Owner, old: int, node: int) -> str:
        """Return the name of a node in the scope of an owner."""
        instance_name = self._deck.owner_of_node(old).name
        return full_name("" if instance_name == owner.name else instance_name, int(self._labels[node]))

    def _owner(self, name: str) -> Owner:
        return next(owner for owner in self._deck.owners if owner.name == name)

    def _last(self, owner: Owner, *names: str) -> Block:
        """Return the last block of an owner with one of these keywords."""
        return max((block for block in owner.blocks if block.name in names), key=lambda block: self._order[id(block)])

    def after_elements(self, owner: Owner, lines: Sequence[str]) -> None:
        """Add lines after all nodes and elements of an owner."""
        self.edits.append(self._last(owner, *_NODE_BLOCKS, "ELEMENT", "ELGEN"), lines)

    def after_model(self, lines: Sequence[str]) -> None:
        """Add lines at the end of the model data."""
        steps = [index for index, block in enumerate(self._deck.blocks) if block.name == "STEP"]
        last = steps[0] - 1 if steps else -1
        self.edits.append(self._deck.blocks[last], lines)

    def text(self) -> str:
        """Return the deck with all edits."""
        lines: list[str] = []
        edits = self.edits
        last = {id(passage.block): index0 for index0, passage in enumerate(self._deck.passages) if passage.block}
        for index0, passage in enumerate(self._deck.passages):
            block = passage.block
            if block is None:
                lines += passage.lines
                continue
            if id(block) in edits.blocks:
                lines += edits.blocks[id(block)] if passage.first < 0 else []
            elif passage.first < 0:
                lines += _without_input(block, passage.lines)
            else:
                for index, line in enumerate(passage.lines, start=passage.first):
                    lines += edits.lines.get((id(block), index), [line])
            if last[id(block)] == index0:
                lines += edits.after.get(id(block), [])
        return "\n".join(lines) + "\n"


def element_lines(label: int, nodes: IntArray) -> list[str]:
    """Write the data lines of an element, at most sixteen numbers on each."""
    words = [str(label), *map(str, nodes.tolist())]
    rows = [", ".join(words[start : start + 2 * PER_LINE]) for start in range(0, len(words), 2 * PER_LINE)]
    return [f"{row}," for row in rows[:-1]] + rows[-1:]


def _numbered_rows(block: Block) -> Iterator[tuple[int, Row]]:
    """Iterate over the data lines that are not blank, with their indices."""
    return ((index, block.row(index)) for index, line in enumerate(block.lines) if line.strip(", \t"))


def _defines(block: Block, name: str) -> bool:
    """Return whether a block adds nodes to a node set."""
    options = [option for option in ("NSET", "NEW SET") if block.options.known(option)]
    return block.name in ("NSET", *_NODE_BLOCKS) and any(block.options.text(option) == name for option in options)


def _without_input(block: Block, lines: Sequence[str]) -> Sequence[str]:
    """Drop INPUT= from a keyword line, whose data lines now follow it."""
    if not (block.options.known("INPUT") and block.options.has("INPUT")):
        return lines
    fields = split_fields("".join(line for line in lines if not line.startswith("**")))
    others = [
        field
        for field in fields
        if not (field and "INPUT".startswith(compact(field.partition("=")[0])) and "=" in field)
    ]
    return [", ".join(others)]


def quoted(name: str) -> str:
    """Write the name of a set as a deck has it, quoted where needed."""
    plain = unquote(name)
    return plain if re.fullmatch(r"[A-Z_][\w.-]*", plain) else f'"{plain}"'
