# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A deck for the insertion: its text, its solids, and the names of its sets.

Instances of a part have one mesh. The first instance represents all of them: a cut through it cuts the part.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uel.deck.error_report import Problems, nearest
from uel.deck.keywords import KEYWORDS
from uel.deck.language.blocks import Block
from uel.deck.language.lexer import read_passages
from uel.deck.language.structure import Structure, sort_blocks
from uel.deck.materials.material import leave_out_unused
from uel.deck.mesh.flatten import FlatMesh, Owner
from uel.deck.mesh.groups import node_indices
from uel.deck.mesh.local_mesh import ElementRun
from uel.deck.sections.solids import SECTION_KEYWORDS
from uel.errors import DeckError, Source, UsageError
from uel.insertion.cut import Cells, Solids, mask_of
from uel.model.arrays import IntArray
from uel.model.element_types import BUILT_IN, FAMILIES, ContinuumType, Family
from uel.usersub.layout import element_layouts


@dataclass(frozen=True, slots=True)
class Run:
    """Elements of one *ELEMENT or *ELGEN line: positions and nodes in the model.

    family  family of solids, None for other elements
    face    family of elements that may be on faces of the solids, None for others
    """

    owner: Owner
    run: ElementRun
    positions: IntArray
    nodes: IntArray
    family: Family | None
    face: Family | None


class Deck:
    """Text of a deck, and the mesh of the first instance of each part.

    runs     elements of these instances
    solids   their solids; `numbers` (elements,): number of the solid, -1 for other elements
    """

    def __init__(self, files: Sequence[Path], made: dict[Path, list[str]]) -> None:
        problems = Problems()
        self.file = files[-1]
        self.blocks, self.passages = read_passages(files, KEYWORDS, problems, made)
        self.structure: Structure = sort_blocks(self.blocks, problems)
        leave_out_unused(self.structure, problems)
        problems.check()
        self.flat = FlatMesh(self.structure, problems)
        problems.check()
        self.warnings = problems.warnings
        self.owners = self.flat.owners
        self.part_of = {name: scope.head.options.text("PART") for name, scope in self.structure.instances.items()}
        self._map_instances()
        self._read_elements()
        self._read_sections()

    @property
    def start(self) -> Source:
        """First line, for errors without another location."""
        return Source(str(self.file), 1)

    def _map_instances(self) -> None:
        """Map nodes and elements of the model to those of the first instance of their part. Raises DeckError."""
        self.node_of = np.arange(len(self.flat.mesh.labels))
        self.element_of = np.arange(sum(len(owner.elements) for owner in self.owners))
        self.first: dict[str, Owner] = {}
        for owner in self.owners:
            first = self.first.setdefault(self.part_of.get(owner.name, ""), owner)
            if first is owner:
                continue
            for kind in ("nodes", "elements"):
                labels, first_labels = getattr(owner, kind), getattr(first, kind)
                if not np.array_equal(labels, first_labels):
                    scope = self.structure.instances[owner.name]
                    raise scope.head.error(
                        f"{owner.name} has other {kind} than {first.name}, an instance of the same part: expected "
                        "the mesh in the part alone, or one instance"
                    )
            self.node_of[owner.node_offset :][: len(owner.nodes)] = first.node_offset + np.arange(len(owner.nodes))
            self.element_of[owner.element_offset :][: len(owner.elements)] = first.element_offset + np.arange(
                len(owner.elements)
            )

    def _read_elements(self) -> None:
        self.runs: list[Run] = []
        runs = [(owner, run) for owner in self.first.values() for run in owner.mesh.runs if len(run.labels)]
        # an element of the assembly with nodes of instances is in no part
        families = [None if np.any(run.nodes < 0) else _solid_family(run) for _, run in runs]
        # plane elements in a mesh of bricks, Gmsh's groups of faces, are no solids
        dimension = max((family.dimension for family in families if family), default=0)
        for (owner, run), family in zip(runs, families, strict=True):
            solid = family if family and family.dimension == dimension else None
            nodes = self.node_of[node_indices(owner, run)]
            face = _face_family(run, dimension - 1)
            self.runs.append(Run(owner, run, owner.find_elements(run.labels), nodes, solid, face))
        count = 0
        self.numbers = np.full(len(self.element_of), -1)
        indices: list[IntArray] = []
        rows: dict[int, list[tuple[IntArray, IntArray]]] = {}
        for family in {run_data.family.number: run_data.family for run_data in self.runs if run_data.family}.values():
            for index, run_data in enumerate(self.runs):
                if run_data.family is family:
                    indices.append(np.full(len(run_data.nodes), index))
                    numbers = count + np.arange(len(run_data.nodes))
                    count += len(run_data.nodes)
                    self.numbers[run_data.positions] = numbers
                    rows.setdefault(family.number, []).append((numbers, run_data.nodes))
        cells = [
            Cells(
                next(f for f in FAMILIES.values() if f.number == number),
                *map(np.concatenate, zip(*entries, strict=True)),
            )
            for number, entries in rows.items()
        ]
        self.run_index = np.concatenate([*indices, np.zeros(0, dtype=np.int64)])
        self.positions = np.zeros(count, dtype=np.int64)
        self.positions[self.numbers[self.numbers >= 0]] = np.flatnonzero(self.numbers >= 0)
        self.solids = Solids(self.flat.mesh.coordinates, cells)
        if not count:
            raise DeckError(self.start, "the mesh has no solids, between which elements could be inserted")
        if not self.solids.manifold:
            names = ", ".join(self.name(number) for number in self.solids.shared_by_three().tolist())
            last = int(self.solids.shared_by_three().max())
            raise self.error(last, f"elements {names} share a face, which can belong to two elements at most")

    def _read_sections(self) -> None:
        """Read the section of each solid, -1 for none, and the section keywords."""
        self.section_blocks: list[tuple[Owner, Block]] = []
        self.sections = np.full(self.solids.count, -1)
        self._sectioned = np.zeros(len(self.element_of), dtype=bool)
        for owner in self.first.values():
            for block in owner.blocks:
                if block.name in SECTION_KEYWORDS:
                    elements = self.flat.elements(block.options.text("ELSET"), block.source, owner.name)
                    self._sectioned[elements] = True
                    numbers = self.numbers[self.element_of[elements]]
                    self.sections[numbers[numbers >= 0]] = len(self.section_blocks)
                    self.section_blocks.append((owner, block))

    def lacks_section(self, positions: IntArray) -> NDArray[np.bool_]:
        """Return the mask of elements without a section."""
        return ~self._sectioned[positions]

    def surface_names(self) -> list[str]:
        """Return the names of all surfaces."""
        return list(self._surfaces())

    def owner_of_node(self, index: int) -> Owner:
        """Return the owner of a node."""
        return next(o for o in reversed(self.owners) if len(o.nodes) and o.node_offset <= index)

    def name(self, number: int) -> str:
        """Return the label of a solid, with its instance."""
        return self.flat.element_name(int(self.positions[number]))

    def run_of(self, number: int) -> tuple[Run, int]:
        """Return the run of a solid, and its row in it."""
        run = self.runs[self.run_index[number]]
        return run, int(np.flatnonzero(run.positions == self.positions[number])[0])

    def error(self, number: int, message: str) -> DeckError:
        """Return an error at a solid: 'element 7 (C3D10)', then the message."""
        run, row = self.run_of(number)
        return DeckError(run.run.source(row), f"element {self.name(number)} ({run.run.type.name}): {message}")

    def solids_of(self, name: str, option: str) -> IntArray | None:
        """Return the solids of an element set, None for an unknown set. Raises UsageError where it has no solids."""
        key = self._key(name, self.flat.elsets, option)
        if key is None:
            return None
        numbers = self.numbers[self.element_of[self.flat.elsets[key]]]
        numbers = np.unique(numbers[numbers >= 0])
        if not len(numbers):
            raise UsageError(f"{option}: element set {name} has no solids")
        return numbers

    def nodes_of(self, name: str, option: str) -> IntArray | None:
        """Return the nodes of a node set, None for an unknown set."""
        key = self._key(name, self.flat.nsets, option)
        return None if key is None else np.unique(self.node_of[self.flat.nsets[key]])

    def surface(self, name: str, option: str) -> tuple[Owner, Block] | None:
        """Return the *SURFACE of a name, and its owner."""
        blocks = self._surfaces()
        key = self._key(name, blocks, option)
        return None if key is None else blocks[key]

    def faces_of(self, owner: Owner, block: Block) -> NDArray[np.bool_]:
        """Return the mask of the faces of solids in a *SURFACE of elements."""
        mask = np.zeros(len(self.solids.element), dtype=bool)
        if block.options.has("COMBINE"):
            raise block.error("a combined surface is not supported here; expected one of sets or elements and faces")
        for row in block.rows():
            elements = self.flat.elements(row.name(0, "set"), row.source, owner.name)
            numbers = self.numbers[self.element_of[elements]]
            side = row.name(1, "face")
            if side[:1] != "S" or not side[1:].isdecimal():
                raise row.error(f"{side} is not a face of a solid (S1, S2, ...)")
            inside = mask_of(numbers[numbers >= 0], self.solids.count)
            mask |= inside[self.solids.element] & (self.solids.side == int(side[1:]) - 1)
        return mask

    def _surfaces(self) -> dict[str, tuple[Owner, Block]]:
        surfaces = [(owner, block) for owner in self.owners for block in owner.blocks if block.name == "SURFACE"]
        return {
            (f"{owner.name}." if owner.name else "") + block.options.text("NAME"): (owner, block)
            for owner, block in surfaces
        }

    def unknown(self, option: str, kind: str, name: str, *known: Iterable[str]) -> UsageError:
        """Return the error for a name that the deck does not define."""
        names = list(dict.fromkeys(name for names in known for name in names))
        listed = ", ".join(names[:20]) + (", ..." if len(names) > 20 else "") if names else "none"
        return UsageError(f"{option}: the mesh has no {kind} {name} (it has: {listed}){nearest(name.upper(), names)}")

    def _key(self, name: str, known: Container[str], option: str) -> str | None:
        """Return the name of a set in the model, from SET, INSTANCE.SET, PART.SET, or SET of a single part."""
        name = " ".join(name.replace('"', "").upper().split())
        if name in known:
            return name
        scope, _, local = name.rpartition(".")
        owners = [owner.name for key, owner in self.first.items() if owner.name and scope in ("", key)]
        matches = [f"{owner}.{local}" for owner in owners if f"{owner}.{local}" in known]
        if len(matches) > 1:
            raise UsageError(f"{option}: {name} is in several parts: write one of {', '.join(matches)}")
        return matches[0] if matches else None


def _face_family(run: ElementRun, dimension: int) -> Family | None:
    """Return the family of shells, membranes, rigid and other elements of a dimension; None for other elements."""
    kind = None if run.type.definition else BUILT_IN[run.type.name]
    family: Family | None = getattr(kind, "family", None)
    if family is None or family.dimension != dimension:
        return None
    # the midside node of a beam is not its last node
    return family if dimension == 2 or family.nodes == 2 else None


def _solid_family(run: ElementRun) -> Family | None:
    """Return the family of solids of a run: built-in ones, or U1 and U9 of the project; None for other elements."""
    if run.type.definition is None:
        kind = BUILT_IN[run.type.name]
        return kind.family if isinstance(kind, ContinuumType) else None
    layout = element_layouts().get(run.type.definition.number)
    # U1 of another code may be an interface element: expect UELMAT
    if layout is None or any(layout.faces) or not run.type.definition.integration or layout.nodes != run.type.nodes:
        return None
    return FAMILIES[layout.dimension, layout.nodes]
