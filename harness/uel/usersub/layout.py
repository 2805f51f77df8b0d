# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Meaning of the properties and state variables of the project's own elements, read from fortran/abaqus/layout.f90.

fortran/README.md holds what `markdown` returns.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import Final

import numpy as np

from uel.errors import UsageError
from uel.model.arrays import IntArray
from uel.model.records import PointVariables
from uel.usersub.built import path_of_layout

MARKER: Final = "delamination_layout_version"
"""Symbol of a library that holds these elements."""

PLANE: Final = 2
"""Dimension of elements in the plane."""

RULES: Final = {
    "positive": "> 0",
    "not_negative": ">= 0, default 0",
    "below_one": ">= 0 and < 1, default 0",
    "up_to_one": "0 to 1, default 0",
    "estimated": ">= 0, -2 or, in a self-contained element, -1, default 0",
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
    dimension 2 or 3
    nodes     number of nodes
    reals     PROPS
    integers  JPROPS
    variables SVARS of an integration point
    own       SVARS of the element as a whole, after those of its points
    points    number of integration points
    faces     nodes, from 0, of the bottom and the top face of an interface element: left, right, middle; in space
              counter-clockwise seen from the top, corners and then middles
    meaning   what the element is
    """

    jtype: int
    dimension: int
    nodes: int
    reals: tuple[Item, ...]
    integers: tuple[Item, ...]
    variables: tuple[Item, ...]
    own: tuple[Item, ...]
    points: int
    faces: tuple[tuple[int, ...], tuple[int, ...]]
    meaning: str

    @property
    def svars(self) -> int:
        """Number of SVARS, VARIABLES= of *USER ELEMENT."""
        return self.points * len(self.variables) + len(self.own)

    @property
    def unsymmetric(self) -> bool:
        """True if its *USER ELEMENT needs UNSYMM, without which Abaqus takes the symmetric part of AMATRX.

        All interface elements do: the consistent tangent of softening in mixed mode, the derivative of the rotation
        with NLGEOM, and the traction of the solids are unsymmetric. A standard element with TANGENT 1 and small
        displacements has a symmetric matrix, which UNSYMM does not change.
        """
        return bool(self.faces[0])


@cache
def element_layouts() -> dict[int, ElementLayout]:
    """Return every element type of the project by its JTYPE."""
    return read_layouts(path_of_layout().read_text(encoding="utf-8"))


def without_user(name: str) -> str:
    """Return what a type Un is in a job without a user's file, in words; '' for a type that is built in."""
    number = name[1:] if name[:1] == "U" else ""
    if not number.isdecimal():
        return ""
    layout = element_layouts().get(int(number))
    if layout is None:
        known = ", ".join(f"U{number}" for number in element_layouts())
        return f"no --user was given: name the file that has {name}; this project itself has {known}"
    where = "the plane" if layout.dimension == PLANE else "space"
    own = f"{layout.meaning} ({layout.nodes} nodes in {where})"
    return f"no --user was given, so {name} is that of this project: {own}; another {name} needs its file, by --user"


def read_layouts(text: str) -> dict[int, ElementLayout]:
    """Read the element types by their JTYPE from the text of a layout.f90."""
    tables = _tables(text)
    layouts = {}
    for fields, meaning in tables["elements"]:
        jtype, family, dimension, nodes, points, *_ = map(int, fields)
        faces = next((_faces(row) for row, _ in tables["faces"] if int(row[0]) == jtype), ((), ()))
        layouts[jtype] = ElementLayout(
            jtype=jtype,
            dimension=dimension,
            nodes=nodes,
            reals=_reals(_of_family(tables["reals"], family)),
            integers=_integers(_of_family(tables["integers"], family)),
            variables=_variables(tables[_variables_table(dimension, bool(any(faces)))]),
            own=_variables(tables["own_variables"]) if 0 < sum(map(len, faces)) < nodes else (),
            points=points,
            faces=faces,
            meaning=meaning,
        )
    return layouts


def check_law_uses(jtype: int, given: Mapping[str, float], law: int) -> None:
    """Raise UsageError for a property, given by name, that the law of a number ignores."""
    layout = element_layouts()[jtype]
    for item in layout.reals:
        laws = re.search(r"\(LAW ([\d, ]+)\)", item.meaning)
        # 0 is the default, LAW 1
        if laws and given.get(item.name) and str(law or 1) not in laws[1].split(", "):
            raise UsageError(f"{item.name}: LAW {law or 1} ignores it; LAW {laws[1].replace(', ', ' or ')} has it")
    if given.get("ETA") and given.get("POWER"):
        raise UsageError("POWER: ignored where ETA is not 0; give one of the two")


def variables(jtype: int) -> PointVariables | None:
    """Return the meaning of the SVARS of an element type of the project, None if it has no such type."""
    layout = element_layouts().get(jtype)
    if layout is None:
        return None
    names = tuple(item.name for item in layout.variables)
    bottom, top = layout.faces
    if not bottom:
        # a quad may lie in a model in space
        outline = tuple(range(layout.nodes)) if layout.dimension == 2 else ()
        return PointVariables("continuum", names, layout.points, outline=outline)
    return PointVariables("interface", names, layout.points, bottom=bottom, top=top)


def is_continuum(jtype: int, integers: IntArray) -> bool:
    """Report whether elements of a type of the project, with these JPROPS, are continuum ones that store no stress."""
    layout = element_layouts().get(jtype)
    if layout is None or layout.faces[0]:
        return False
    face = next(item.position for item in layout.integers if item.name == "FACE")
    return len(integers) < face or not integers[face - 1]


def shares_stress(jtype: int, integers: IntArray) -> bool:
    """Report whether elements of a type of the project, with these JPROPS, store stress for others, or take it."""
    layout = element_layouts().get(jtype)
    if layout is None:
        return False
    # interface elements that take it have the numbers of their neighbours
    takes = any(item.name == "OFFSETBOTTOM" for item in layout.integers)
    return takes or not (layout.faces[0] or is_continuum(jtype, integers))


def markdown() -> str:
    """Return the tables of every element type."""
    return "\n".join(_markdown_lines())


def _markdown_lines() -> Iterator[str]:
    for layout in element_layouts().values():
        counts = f"NODES={layout.nodes}, PROPERTIES={len(layout.reals)}, I PROPERTIES={len(layout.integers)}"
        counts += f", VARIABLES={layout.svars}" + ", UNSYMM" * layout.unsymmetric
        yield from (f"### U{layout.jtype}: {layout.meaning}", "", counts, "")
        yield from _table("PROPS", "unit", [(i, i.unit) for i in layout.reals])
        yield from _table("JPROPS", "", [(i, "") for i in layout.integers])
        title = f"SVARS of each of {layout.points} points"
        yield from _table(title, "unit", [(i, i.unit) for i in layout.variables])
        if layout.own:
            before = layout.points * len(layout.variables)
            own = [replace(item, position=before + item.position) for item in layout.own]
            yield from _table("SVARS of the element", "unit", [(i, i.unit) for i in own])


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

_NUMBER = re.compile(r"integer, parameter, public :: (\w+) = (\w+(?: \+ \w+)*)(?: *!.*)?$")
_TABLE = re.compile(r"type\((\w+_item)\), parameter, public :: (\w+)\((?:(\d+):)?(\d+)\) = \[ &$")
_ROW = re.compile(r"(\w+_item)\((.*)\)(?:, &|\])(?: !< (.*))?$")


def _tables(text: str) -> dict[str, Rows]:
    """Read the rows of each table, with numbers for names; ValueError if a table lacks rows that it announces."""
    numbers: dict[str, int] = {}
    tables: dict[str, Rows] = {}
    announced: dict[str, int] = {}
    rows: Rows = []
    first = 1

    def value(field: str) -> str:
        if not all(part in numbers for part in field.split(" + ")) or field in RULES:
            return field
        return str(sum(numbers[part] for part in field.split(" + ")))

    for line in map(str.strip, text.splitlines()):
        if match := _TABLE.match(line):
            rows = tables[match[2]] = []
            first = int(match[3] or 1)
            announced[match[2]] = int(match[4]) - first + 1
        elif match := _ROW.match(line):
            fields = [value(field) for field in re.sub(r"[][]", "", match[2]).split(", ")]
            if int(fields[0]) != len(rows) + first:
                raise ValueError(f"position {fields[0]} in row {len(rows) + first}: {line}")
            rows.append((fields, match[3] or ""))
        elif line.startswith("!< ") and rows and not rows[-1][1]:
            rows[-1] = (rows[-1][0], line.removeprefix("!< "))
        elif match := _NUMBER.match(line):
            parts = match[2].split(" + ")
            numbers[match[1]] = sum(numbers[part] if part in numbers else int(part) for part in parts)
    if {name: len(rows) for name, rows in tables.items()} != announced:
        raise ValueError("a table of the layout does not have the number of rows it announces")
    return tables


def _of_family(rows: Rows, family: int) -> Rows:
    """Return the properties that a family has, in the order and with the positions of its decks."""
    members = [row for row in rows if int(row[0][1]) & family]
    return [([str(n), *fields[2:]], text) for n, (fields, text) in enumerate(members, start=1)]


def _variables_table(dimension: int, interface: bool) -> str:
    """Name the table of the variables of a point."""
    if not interface:
        return "continuum_variables" if dimension == 2 else "brick_variables"
    return "interface_variables" if dimension == 2 else "surface_variables"


def _faces(fields: list[str]) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Return the nodes of the bottom and the top face from a row of `faces`."""
    nodes = np.array(fields[2:], dtype=int).reshape(-1, 2, 4)  # corners, in space midside nodes; bottom, top
    bottom, top = (tuple((side[side > 0] - 1).tolist()) for side in (nodes[:, 0], nodes[:, 1]))
    return bottom, top


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
