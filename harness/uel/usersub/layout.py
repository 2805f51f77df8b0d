# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Element types of the project with their properties and state variables, read from fortran/properties.toml.

The build makes the Fortran module abaqus_layout of the same file, and checks it. fortran/README.md has the tables that
`markdown` returns.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, Final

from uel.errors import UsageError
from uel.model.arrays import IntArray
from uel.model.properties import UserProperty
from uel.model.records import PointVariables
from uel.usersub.own_kernels import path_of_properties

MARKER: Final = "delamination_layout_version"
"""Symbol of a library that holds these elements."""

PLANE: Final = 2
"""Dimension of elements in the plane."""


@dataclass(frozen=True, slots=True)
class Item:
    """Property or state variable.

    position  in PROPS, in JPROPS, or among the SVARS of a point or of the element; from 1
    unit      '' for an option
    permitted values of a property
    meaning   in words, with what 0 stands for and with `laws`
    required  True for a property without a default
    laws      values of LAW that use it; () if all do
    default   what 0 stands for; '' if that is 0
    """

    position: int
    name: str
    unit: str
    permitted: str
    meaning: str
    required: bool = False
    laws: tuple[int, ...] = ()
    default: str = ""


@dataclass(frozen=True, slots=True)
class ElementLayout:
    """Element type Un of the project.

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
    family    what all elements with these properties and variables are
    solids    number of nodes of its own solids below and above; () without
    tensor    value of TENSOR of a continuum element, '' of others
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
    family: str
    solids: tuple[int, ...]
    tensor: str

    @property
    def svars(self) -> int:
        """Number of SVARS, VARIABLES= of *USER ELEMENT."""
        return self.points * len(self.variables) + len(self.own)

    def named(self, section: UserProperty) -> dict[str, float]:
        """Return the properties of a section by name; those that the deck leaves out are 0."""
        return {
            item.name: float(values[item.position - 1]) if item.position <= len(values) else 0.0
            for items, values in ((self.reals, section.values), (self.integers, section.integers))
            for item in items
        }

    @property
    def corners(self) -> int:
        """Number of corners of each face of an interface element."""
        if self.dimension == PLANE:
            return 2
        return 3 if len(self.faces[0]) in (3, 6) else 4

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
    return read_layouts(path_of_properties().read_text(encoding="utf-8"))


def without_user(name: str) -> str:
    """Describe a type Un in a job without a user's file; '' for a built-in type."""
    number = name[1:] if name[:1] == "U" else ""
    if not number.isdecimal():
        return ""
    layout = element_layouts().get(int(number))
    if layout is None:
        types = ", ".join(f"U{number}" for number in element_layouts())
        return f"no --user was given: name the file that has {name}; this project itself has {types}"
    where = "the plane" if layout.dimension == PLANE else "space"
    kind = f"{layout.meaning} ({layout.nodes} nodes in {where})"
    return f"no --user was given, so {name} is that of this project: {kind}; another {name} needs its file, by --user"


def read_layouts(text: str) -> dict[int, ElementLayout]:
    """Element types by their JTYPE from the text of a properties.toml."""
    data = tomllib.loads(text)
    layouts = {}
    for row in data["elements"]:
        jtype, family = int(row["type"][1:]), data["families"][row["family"]]
        reals, integers = (
            [each for each in data[table] if row["family"] in _families(each["elements"], data["sets"])]
            for table in ("reals", "integers")
        )
        points, own = (data["variables"][family[key]]["items"] if key in family else [] for key in ("variables", "own"))
        layouts[jtype] = ElementLayout(
            jtype=jtype,
            dimension=row["dimension"],
            nodes=row["nodes"],
            reals=tuple(_real(n, each, data["ranges"]) for n, each in enumerate(reals, start=1)),
            integers=tuple(_integer(n, each) for n, each in enumerate(integers, start=1)),
            variables=_variables(points),
            own=_variables(own),
            points=row["points"],
            faces=(_from_zero(row.get("bottom", ())), _from_zero(row.get("top", ()))),
            meaning=row["meaning"],
            family=family["meaning"],
            solids=tuple(row.get("solids", ())),
            tensor="" if "bottom" in row else "PSTRESS" if row["dimension"] == PLANE else "THREED",
        )
    return layouts


def check_law_uses(jtype: int, values: Mapping[str, float], law: int) -> None:
    """Raise UsageError for a property that the law of this number ignores; values by name."""
    layout = element_layouts()[jtype]
    for item in layout.reals:
        # 0 is the default, LAW 1
        if item.laws and values.get(item.name) and (law or 1) not in item.laws:
            *others, last = map(str, item.laws)
            known = f"{', '.join(others)} or {last}" if others else last
            raise UsageError(f"{item.name}: LAW {law or 1} ignores it; LAW {known} has it")
    if values.get("ETA") and values.get("POWER"):
        raise UsageError("POWER: ignored where ETA is not 0; give one of the two")


def variables(jtype: int) -> PointVariables | None:
    """Return the meaning of the SVARS of an element type of the project, None for others."""
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
    """Return whether elements of a type of the project, with these JPROPS, are continuum ones that store no stress."""
    layout = element_layouts().get(jtype)
    if layout is None or layout.faces[0]:
        return False
    face = next(item.position for item in layout.integers if item.name == "FACE")
    return len(integers) < face or not integers[face - 1]


def shares_stress(jtype: int, integers: IntArray) -> bool:
    """Return whether elements of a type of the project, with these JPROPS, store stress for others, or read it."""
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
    families: dict[str, list[ElementLayout]] = {}
    for layout in element_layouts().values():
        families.setdefault(layout.family, []).append(layout)
    for family, layouts in families.items():
        yield from (f"### {family[0].upper()}{family[1:]}", "")
        yield from _types(layouts)
        yield from (*(f"    {_user_element(layout)}" for layout in layouts), "")
        one = layouts[0]
        yield from _table("PROPS", "unit", [(i, i.unit) for i in one.reals])
        yield from _table("JPROPS", "", [(i, "") for i in one.integers])
        yield from _table("SVARS of each point", "unit", [(i, i.unit) for i in one.variables])
        if one.own:
            yield from _table("SVARS after those of the points", "unit", [(i, i.unit) for i in one.own])


def _types(layouts: Sequence[ElementLayout]) -> Iterator[str]:
    """Write the table of the element types of a family."""
    interfaces = bool(layouts[0].faces[0])
    columns = ["type", "element", "points", *(["nodes of the bottom face", "of the top face"] if interfaces else [])]
    yield "| " + " | ".join(columns) + " |"
    yield "|" + "---|" * len(columns)
    for layout in layouts:
        faces = [", ".join(str(node + 1) for node in face) for face in layout.faces if face]
        yield "| " + " | ".join([f"U{layout.jtype}", layout.meaning, str(layout.points), *faces]) + " |"
    yield ""


def _user_element(layout: ElementLayout) -> str:
    """Write *USER ELEMENT of a type."""
    text = f"*USER ELEMENT, TYPE=U{layout.jtype}, NODES={layout.nodes}, COORDINATES={layout.dimension}"
    text += f", PROPERTIES={len(layout.reals)}, I PROPERTIES={len(layout.integers)}, VARIABLES={layout.svars}"
    if layout.tensor:
        text += f", INTEGRATION={layout.points}, TENSOR={layout.tensor}"
    return text + ", UNSYMM" * layout.unsymmetric


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


def _families(names: str | Iterable[str], sets: Mapping[str, list[str]]) -> set[str]:
    """Expand families and sets of families, or a list of them."""
    if isinstance(names, str):
        return _families(sets[names], sets) if names in sets else {names}
    return set().union(*(_families(name, sets) for name in names))


def _from_zero(nodes: Iterable[int]) -> tuple[int, ...]:
    return tuple(node - 1 for node in nodes)


def _real(position: int, row: Mapping[str, Any], ranges: Mapping[str, Mapping[str, str]]) -> Item:
    permitted = ranges[row["range"]]["permitted"]
    required = row["range"] == "positive"
    return Item(
        position,
        row["name"],
        row["unit"],
        permitted,
        _meaning(row),
        required,
        laws=tuple(row.get("laws", ())),
        default=row.get("default", ""),
    )


def _integer(position: int, row: Mapping[str, Any]) -> Item:
    highest = len(row["values"]) if "values" in row else row.get("highest")
    permitted = "any" if highest is None else f"0 to {highest}"
    return Item(position, row["name"], "", permitted, _meaning(row), laws=tuple(row.get("laws", ())))


def _meaning(row: Mapping[str, Any]) -> str:
    """Return the meaning of a property, with the laws that use it and what 0 stands for."""
    laws = f" (LAW {', '.join(map(str, row['laws']))})" if "laws" in row else ""
    default = f"; 0: {row['default']}" if "default" in row else ""
    return f"{row['meaning']}{laws}{default}"


def _variables(rows: Iterable[Mapping[str, str]]) -> tuple[Item, ...]:
    return tuple(Item(n, row["name"], row["unit"], "", row["meaning"]) for n, row in enumerate(rows, start=1))
