# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rewrite a deck in other units, or with other node and element numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random

from uel.deck.error_report import Problems
from uel.deck.keywords import KEYWORDS
from uel.deck.language.blocks import Block, Row
from uel.deck.language.lexer import read_blocks

Dimension = tuple[int, int, int]
"""Exponents of length, mass and time."""

ONE: Dimension = (0, 0, 0)
LENGTH: Dimension = (1, 0, 0)
TIME: Dimension = (0, 0, 1)
FREQUENCY: Dimension = (0, 0, -1)
SPEED: Dimension = (1, 0, -1)
FORCE: Dimension = (1, 1, -2)
ENERGY: Dimension = (2, 1, -2)
POWER: Dimension = (2, 1, -3)
STRESS: Dimension = (-1, 1, -2)
STIFFNESS: Dimension = (-2, 1, -2)
"""Of an interface: stress over length."""
TOUGHNESS: Dimension = (0, 1, -2)
DENSITY: Dimension = (-3, 1, 0)
CONDUCTIVITY: Dimension = (1, 1, -3)
SPECIFIC_HEAT: Dimension = (2, 0, -2)

_DATA: dict[str, Sequence[Dimension]] = {
    "NODE": (ONE, LENGTH, LENGTH, LENGTH),
    "SOLID SECTION": (LENGTH,),
    "COHESIVE SECTION": (LENGTH, LENGTH),
    "DAMAGE INITIATION": (STRESS,) * 3,
    "DAMAGE EVOLUTION": (TOUGHNESS,) * 3,
    "CLOAD": (ONE, ONE, FORCE),
    "DENSITY": (DENSITY,),
    "CONDUCTIVITY": (CONDUCTIVITY,),
    "SPECIFIC HEAT": (SPECIFIC_HEAT,),
    "AMPLITUDE": (TIME, ONE) * 4,
    **dict.fromkeys(("STATIC", "DYNAMIC", "HEAT TRANSFER", "COUPLED TEMPERATURE-DISPLACEMENT"), (TIME,) * 4),
}
"""Dimensions of the fields of data lines."""
_ELASTIC: dict[str, Sequence[Dimension]] = {
    "ISOTROPIC": (STRESS,),
    "LAMINA": (STRESS, STRESS, ONE, STRESS, STRESS, STRESS),
    "TRACTION": (STRESS,) * 3,
}
_WITHOUT = {
    *("ELEMENT", "NSET", "ELSET", "MATERIAL", "USER ELEMENT", "STEP", "END STEP", "CONTROLS", "OUTPUT", "NODE OUTPUT"),
    *("ELEMENT OUTPUT", "ENERGY OUTPUT", "NODE PRINT", "EL PRINT", "SECTION CONTROLS", "FREQUENCY"),
    *("INITIAL CONDITIONS", "HEADING", "RESTART", "PREPRINT"),
}
"""Keywords whose data have no dimension of length, mass or time here."""
_LARGEST_DISPLACEMENT = 3


@dataclass(frozen=True)
class Units:
    """The units of length, mass and time of a deck, measured in the new ones; the name is for reports."""

    name: str
    length: float
    mass: float
    time: float

    def factor(self, dimension: Dimension) -> float:
        """Factor for a number of this dimension."""
        length, mass, time = dimension
        return self.length**length * self.mass**mass * self.time**time


SAME = Units("mm, t, s", 1.0, 1.0, 1.0)


@dataclass(frozen=True)
class Labels:
    """New node and element numbers by the old ones; missing ones stay."""

    nodes: Mapping[int, int]
    elements: Mapping[int, int]


def permuted(deck: Path, seed: int) -> Labels:
    """The numbers of a deck, permuted."""
    random = Random(seed)

    def permute(name: str) -> dict[int, int]:
        old = [int(row.fields[0]) for block in blocks(deck) if block.name == name for row in block.rows()]
        new = list(old)
        random.shuffle(new)
        return dict(zip(old, new, strict=True))

    return Labels(permute("NODE"), permute("ELEMENT"))


def blocks(deck: Path) -> list[Block]:
    """Keyword blocks of a deck, included files in their place."""
    problems = Problems()
    found = read_blocks(deck, KEYWORDS, problems)
    problems.check()
    return found


def rewrite(
    deck: Path, units: Units = SAME, labels: Labels | None = None, properties: Mapping[str, Sequence[Dimension]] = {}
) -> str:
    """Text of the deck as one file, in other units and with other numbers.

    properties: dimensions of *UEL PROPERTY by element set. KeyError for a keyword whose data have no known dimensions.
    """
    given = labels or Labels({}, {})
    return "".join(f"{line}\n" for block in blocks(deck) for line in _lines(block, units, given, properties))


def _lines(block: Block, units: Units, labels: Labels, properties: Mapping[str, Sequence[Dimension]]) -> Iterator[str]:
    options = dict(block.options.values)
    options.pop("INPUT", None)
    generated = options.pop("GENERATE", None)
    yield ", ".join([f"*{block.name}", *(f"{name}={value}" for name, value in options.items())])
    if block.name == "HEADING":
        yield from block.lines
        return
    start = 0
    for row in block.all_rows():
        fields = list(row.fields)
        if generated:
            first, last, *step = (int(field) for field in fields)
            fields = [str(label) for label in range(first, last + 1, *step)]
        renamed = _with_labels(block.name, fields, labels)
        dimensions = _dimensions(block, row, properties)[start:]
        if block.name == "UEL PROPERTY":
            # eight values to a line
            start += 8
        values = [
            repr(float(field) * units.factor(dimensions[k])) if k < len(dimensions) and dimensions[k] != ONE else field
            for k, field in enumerate(renamed)
        ]
        for begin in range(0, max(len(values), 1), 8):
            yield ", ".join(values[begin : begin + 8]) + ("," if generated or block.name == "ELEMENT" else "")


def _dimensions(block: Block, row: Row, properties: Mapping[str, Sequence[Dimension]]) -> Sequence[Dimension]:
    if block.name in _WITHOUT:
        return ()
    if block.name == "ELASTIC":
        return _ELASTIC[block.options.text("TYPE")]
    if block.name == "UEL PROPERTY":
        return properties[block.options.text("ELSET")]
    if block.name == "BOUNDARY":
        displacement = not row.blank(3) and int(row.fields[1]) <= _LARGEST_DISPLACEMENT
        return (ONE, ONE, ONE, LENGTH) if displacement else ()
    return _DATA[block.name]


def _with_labels(name: str, fields: list[str], labels: Labels) -> list[str]:
    """Fields with the new numbers where they are node or element numbers."""

    def new(field: str, numbers: Mapping[int, int]) -> str:
        return str(numbers.get(int(field), int(field))) if field.isdigit() else field

    match name:
        case "ELEMENT":
            return [new(fields[0], labels.elements), *(new(field, labels.nodes) for field in fields[1:])]
        case "NSET":
            return [new(field, labels.nodes) for field in fields]
        case "ELSET":
            return [new(field, labels.elements) for field in fields]
        case "NODE" | "BOUNDARY" | "CLOAD" | "INITIAL CONDITIONS":
            return [*(new(field, labels.nodes) for field in fields[:1]), *fields[1:]]
    return fields
