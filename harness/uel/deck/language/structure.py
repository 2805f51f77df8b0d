# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Sort blocks by scope: model, parts, assembly, instances and steps."""

from __future__ import annotations

from dataclasses import dataclass, field

from uel.deck.error_report import Problems, nearest
from uel.deck.language.blocks import Block
from uel.deck.language.table import NAME, Keyword, Kind, Option, Support, Where, ignored, refused, unquote
from uel.errors import DeckError, Source

_ENDS = {"END PART": "PART", "END ASSEMBLY": "ASSEMBLY", "END INSTANCE": "INSTANCE", "END STEP": "STEP"}
_IN_PARTS = {
    *("NODE", "ELEMENT", "NSET", "ELSET", "NGEN", "NFILL", "NCOPY", "ELGEN", "EQUATION", "SYSTEM"),
    *("USER ELEMENT", "UEL PROPERTY", "SOLID SECTION", "COHESIVE SECTION", "ORIENTATION"),
    *("BEAM SECTION", "BEAM GENERAL SECTION", "MEMBRANE SECTION", "SHELL SECTION", "SHELL GENERAL SECTION"),
    *("DISTRIBUTION", "HOURGLASS STIFFNESS", "TRANSVERSE SHEAR STIFFNESS", "SPRING", "DASHPOT", "MASS", "SURFACE"),
    *("MPC", "COUPLING", "KINEMATIC", "DISTRIBUTING", "KINEMATIC COUPLING", "RIGID BODY", "TIE", "TRANSFORM"),
}
_OUTER = {"PART": "", "ASSEMBLY": "", "INSTANCE": "ASSEMBLY", "STEP": ""}


@dataclass(slots=True)
class Scope:
    """Blocks between a keyword such as *PART and its *END PART, without those of nested scopes."""

    head: Block
    blocks: list[Block] = field(default_factory=list)

    @property
    def name(self) -> str:
        """NAME= of the keyword."""
        return self.head.options.text("NAME")


@dataclass(slots=True)
class Structure:
    """Sorted blocks of a deck. `root` has the data of the model and of the assembly."""

    root: list[Block] = field(default_factory=list)
    assembly: Scope | None = None
    parts: dict[str, Scope] = field(default_factory=dict)
    instances: dict[str, Scope] = field(default_factory=dict)
    steps: list[Scope] = field(default_factory=list)
    ignored: list[tuple[str, Source]] = field(default_factory=list)

    @property
    def materials(self) -> frozenset[str]:
        """Names in MATERIAL= options, and all words on data lines of sections, which may have layers."""
        scopes = *self.parts.values(), *self.instances.values()
        blocks = [*self.root, *(block for scope in scopes for block in scope.blocks)]
        names = {block.options.values.get("MATERIAL", "") for block in blocks}
        rows = (row for block in blocks if block.name.endswith("SECTION") for row in block.rows())
        return frozenset(names.union(unquote(field) for row in rows for field in row.fields))

    @property
    def of_instances(self) -> dict[str, list[Block]]:
        """Blocks of each instance: those of its part, then its own."""
        return {
            name: [*self.parts[scope.head.options.text("PART")].blocks, *scope.blocks]
            for name, scope in self.instances.items()
        }


def read_heading(blocks: list[Block]) -> str:
    """Return the first line of the *HEADING keywords of a deck, '' without any."""
    return next((line for block in blocks if block.name == "HEADING" for line in block.lines if line), "")


def sort_blocks(blocks: list[Block], problems: Problems) -> Structure:
    """Sort the blocks of a deck; errors of nesting go to `problems`."""
    structure = Structure()
    open_scopes: list[Scope] = []
    for block in blocks:
        with problems.gather():
            _place(block, structure, open_scopes, problems)
    for scope in open_scopes:
        problems.add(scope.head.source, f"*{scope.head.name} without *END {scope.head.name}")
    _check_instances(structure, problems)
    return structure


def _place(block: Block, structure: Structure, open_scopes: list[Scope], problems: Problems) -> None:
    keyword = block.keyword
    if keyword.support is Support.IGNORED:
        structure.ignored.append((keyword.name, block.source))
        return
    if not keyword.data and any(block.lines):
        line = next(index for index, text in enumerate(block.lines) if text)
        problems.add(block.source_of(line), f"*{keyword.name} takes no data lines")
    inside = open_scopes[-1].head.name if open_scopes else ""
    if keyword.name in _ENDS:
        _end(block, open_scopes)
    elif keyword.name in _OUTER:
        if inside != _OUTER[keyword.name]:
            _misplaced(block, open_scopes, problems)
        scope = Scope(block)
        open_scopes.append(scope)
        _begin(scope, structure)
    elif inside == "STEP":
        if keyword.where is Where.MODEL:
            raise block.error("model data within a step; it belongs before the first *STEP")
        open_scopes[-1].blocks.append(block)
    elif keyword.where is Where.STEP:
        raise block.error("belongs between *STEP and *END STEP")
    elif structure.steps and keyword.name not in ("AMPLITUDE", "HEADING", "PARAMETER"):
        raise block.error("model data after the first *STEP")
    elif inside in ("", "ASSEMBLY"):
        structure.root.append(block)
    elif keyword.name in _IN_PARTS:
        open_scopes[-1].blocks.append(block)
    else:
        raise block.error(f"does not belong between *{inside} and *END {inside}")


def _begin(scope: Scope, structure: Structure) -> None:
    block = scope.head
    if block.name == "STEP":
        structure.steps.append(scope)
    elif structure.steps:
        raise block.error("model data after the first *STEP")
    elif block.name == "ASSEMBLY":
        if structure.assembly is not None:
            raise block.error(f"the assembly is defined already, at {structure.assembly.head.source}")
        structure.assembly = scope
    else:
        scopes = structure.parts if block.name == "PART" else structure.instances
        if scope.name in scopes:
            raise block.error(f"{scope.name} is defined already, at {scopes[scope.name].head.source}")
        scopes[scope.name] = scope


def _end(block: Block, open_scopes: list[Scope]) -> None:
    opener = _ENDS[block.name]
    if not any(scope.head.name == opener for scope in open_scopes):
        raise block.error(f"no *{opener} to end")
    scope = open_scopes.pop()
    if scope.head.name != opener:
        while open_scopes.pop().head.name != opener:
            pass
        raise DeckError(scope.head.source, f"*{scope.head.name} without *END {scope.head.name}")


def _misplaced(block: Block, open_scopes: list[Scope], problems: Problems) -> None:
    """Report a misplaced scope, and close the open ones, so that reading continues."""
    if open_scopes:
        head = open_scopes[-1].head
        problems.add(head.source, f"*{head.name} without *END {head.name}; *{block.name} follows at {block.source}")
        open_scopes.clear()
    else:
        problems.add(block.source, f"*{block.name} belongs between *ASSEMBLY and *END ASSEMBLY")


def _check_instances(structure: Structure, problems: Problems) -> None:
    for scope in structure.instances.values():
        part = scope.head.options.text("PART")
        # a missing name is reported at the keyword line
        if part and part not in structure.parts:
            problems.add(scope.head.source, f"*INSTANCE: unknown part {part}{nearest(part, structure.parts)}")
    used = {scope.head.options.text("PART") for scope in structure.instances.values()}
    for name, scope in structure.parts.items():
        if name and name not in used:
            problems.warn(scope.head.source, f"part {name} has no instance and is left out")


KEYWORDS = (
    Keyword("HEADING", "Title of the job.", Where.ANY, (*ignored("SPARSE", "UNSYMM"),), "free text"),
    Keyword("PART", "Begin a part.", Where.MODEL, (NAME,)),
    Keyword("END PART", "End a part.", Where.MODEL),
    Keyword("ASSEMBLY", "Begin the assembly.", Where.MODEL, (NAME,)),
    Keyword("END ASSEMBLY", "End the assembly.", Where.MODEL),
    Keyword(
        "INSTANCE",
        "Place a part in the assembly; may hold nodes, elements and sets of its own.",
        Where.MODEL,
        (NAME, Option("PART", Kind.NAME, "part", required=True), *refused("INSTANCE", "LIBRARY")),
        "translation; then two points of an axis and an angle in degrees (rotation follows translation)",
    ),
    Keyword("END INSTANCE", "End an instance.", Where.MODEL),
)
