# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the properties and state variables of the project's own elements mean, read from fortran/abaqus/layout.f90.

fortran/README.md holds what `markdown` returns.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Final

from harness.model.records import PointVariables
from harness.usersub.amalgam import path_of_layout

MARKER: Final = "delamination_layout_version"
"""Symbol of a library that holds these elements."""

RULES: Final = {
    "positive": "> 0",
    "not_negative": ">= 0, default 0",
    "below_one": ">= 0 and < 1, default 0",
    "up_to_one": "0 to 1, default 0",
    "estimated": ">= 0 or, in U4 and U6, -1, default 0",
    "exponent": "0 or >= 0.5, default 0",
    "above_one": "0 or > 1, default 0",
    "any_value": "any, default 0",
}


@dataclass(frozen=True, slots=True)
class Item:
    """A property or state variable: position from 1, name, unit ('' for an option), permitted range, meaning."""

    position: int
    name: str
    unit: str
    permitted: str
    meaning: str


@dataclass(frozen=True, slots=True)
class ElementLayout:
    """An element type Un of the project.

    jtype     n
    nodes     number of nodes
    reals     PROPS
    integers  JPROPS
    variables SVARS of an integration point
    points    number of integration points
    meaning   what the element is
    """

    jtype: int
    nodes: int
    reals: tuple[Item, ...]
    integers: tuple[Item, ...]
    variables: tuple[Item, ...]
    points: int
    meaning: str

    @property
    def svars(self) -> int:
        """Number of SVARS, VARIABLES= of *USER ELEMENT."""
        return self.points * len(self.variables)


@cache
def element_layouts() -> dict[int, ElementLayout]:
    """Every element type of the project by its JTYPE."""
    tables = _tables(path_of_layout().read_text(encoding="utf-8"))
    integers = {1: "continuum_integers", 3: "four_node_integers"}
    integers |= {2: "standard_integers", 5: "standard_integers", 4: "eight_node_integers", 6: "eight_node_integers"}
    layouts = {}
    for fields, meaning in tables["elements"]:
        jtype, nodes, _, reals, _, svars = map(int, fields)
        variables = _variables(tables["continuum_variables" if jtype == 1 else "interface_variables"])
        layouts[jtype] = ElementLayout(
            jtype=jtype,
            nodes=nodes,
            reals=_reals(tables["reals"])[:reals],
            integers=_integers(tables[integers[jtype]]),
            variables=variables,
            points=svars // len(variables),
            meaning=meaning,
        )
    return layouts


def variables(jtype: int) -> PointVariables | None:
    """Meaning of the SVARS of an element type of the project, None if it has no such type."""
    layout = element_layouts().get(jtype)
    if layout is None:
        return None
    names = tuple(item.name for item in layout.variables)
    if jtype == 1:
        return PointVariables("continuum", names, layout.points, outline=(0, 1, 2, 3))
    edges: dict[int, tuple[tuple[int, ...], tuple[int, ...]]] = {
        4: ((3, 2), (4, 5)),
        5: ((0, 1, 4), (3, 2, 5)),
        6: ((3, 2, 6), (8, 9, 12)),
    }
    bottom, top = edges.get(jtype, ((0, 1), (3, 2)))
    return PointVariables("interface", names, layout.points, bottom=bottom, top=top)


def markdown() -> str:
    """Tables of every element type."""
    return "\n".join(_markdown_lines())


def _markdown_lines() -> Iterator[str]:
    for layout in element_layouts().values():
        counts = f"NODES={layout.nodes}, PROPERTIES={len(layout.reals)}, I PROPERTIES={len(layout.integers)}"
        yield from (f"### U{layout.jtype}: {layout.meaning}", "", f"{counts}, VARIABLES={layout.svars}", "")
        yield from _table("PROPS", "unit", [(i, i.unit) for i in layout.reals])
        yield from _table("JPROPS", "", [(i, "") for i in layout.integers])
        title = f"SVARS of each of {layout.points} points"
        yield from _table(title, "unit", [(i, i.unit) for i in layout.variables])


def _table(title: str, unit: str, rows: list[tuple[Item, str]]) -> Iterator[str]:
    ranged = any(item.permitted for item, _ in rows)
    columns = [title, "name", *([unit] if unit else []), *(["permitted"] if ranged else []), "meaning"]
    yield "| " + " | ".join(columns) + " |"
    yield "|" + "---|" * len(columns)
    for item, text in rows:
        cells = [str(item.position), item.name]
        cells += [*([text] if unit else []), *([item.permitted] if ranged else []), item.meaning]
        yield "| " + " | ".join(cells) + " |"
    yield ""


Rows = list[tuple[list[str], str]]

_POSITION = re.compile(r"integer, parameter, public :: ([pjv]_\w+) = (\d+)$")
_TABLE = re.compile(r"type\((\w+_item)\), parameter, public :: (\w+)\((\d+)\) = \[ &$")
_ROW = re.compile(r"(\w+_item)\((.*)\)(?:, &|\]) !< (.*)$")


def _tables(text: str) -> dict[str, Rows]:
    """Rows of each table, positions put in as numbers; ValueError where a table does not hold what it announces."""
    positions: dict[str, str] = {}
    tables: dict[str, Rows] = {}
    announced: dict[str, int] = {}
    rows: Rows = []
    for line in map(str.strip, text.splitlines()):
        if match := _POSITION.match(line):
            positions[match[1]] = match[2]
        elif match := _TABLE.match(line):
            rows = tables[match[2]] = []
            announced[match[2]] = int(match[3])
        elif match := _ROW.match(line):
            fields = [positions.get(field, field) for field in match[2].split(", ")]
            if int(fields[0]) != len(rows) + 1:
                raise ValueError(f"position {fields[0]} in row {len(rows) + 1}: {line}")
            rows.append((fields, match[3]))
    if {name: len(rows) for name, rows in tables.items()} != announced:
        raise ValueError("a table of the layout has another number of rows than it announces")
    return tables


def _reals(rows: Rows) -> tuple[Item, ...]:
    return tuple(Item(int(p), name[1:-1], unit[1:-1], RULES[rule], text) for (p, name, unit, rule), text in rows)


def _integers(rows: Rows) -> tuple[Item, ...]:
    items = []
    for (position, name, lowest, highest), text in rows:
        permitted = "any" if highest == "any_integer" else lowest if lowest == highest else f"{lowest} to {highest}"
        items.append(Item(int(position), name[1:-1], "", permitted, text))
    return tuple(items)


def _variables(rows: Rows) -> tuple[Item, ...]:
    return tuple(Item(int(p), name[1:-1], unit[1:-1], "", text) for (p, name, unit), text in rows)
