# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Write the Fortran module abaqus_layout, the tables of properties, state variables and element types.

The build calls it. It refuses entries of properties.toml that it does not understand, so that what else reads the file
need not.
"""

from __future__ import annotations

import argparse
import sys
import textwrap
import tomllib
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

Row = Mapping[str, Any]

KEYS = {
    "ranges": {"permitted", "expected"},
    "families": {"meaning", "variables"},
    "reals": {"name", "elements", "unit", "range", "meaning"},
    "integers": {"name", "elements", "meaning"},
    "variables": {"prefix", "items"},
    "items": {"name", "unit", "meaning"},
    "elements": {"type", "meaning", "family", "dimension", "nodes", "points"},
}
"""What an entry of each table has to have."""

MORE_KEYS = {
    "families": {"own"},
    "reals": {"symbol", "default", "laws", "part"},
    "integers": {"symbol", "highest", "values", "default", "laws"},
    "elements": {"bottom", "top", "solids"},
}
"""What it may have."""

CORNERS = {(3, 3): 3, (3, 6): 3}
"""Corners of a face by dimension and number of nodes where they are not four, or all nodes of a line."""

HEAD = """\
! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Every property of PROPS and JPROPS, every variable of SVARS and every element type. Written by generate_layout.py
!> from properties.toml: edit that, not this file.
!>
!> A row of `reals` or `integers` tells the families of elements that have it; its position in the deck is the number of
!> rows up to it that the family has.
module abaqus_layout
  use core_kinds, only: dp
  use cohesive_law_properties, only: law_properties
  implicit none(type, external)
  private
  public :: law_properties_of

  !> A real property of the elements of these families.
  type, public :: real_item
    integer :: row
    integer :: families
    character(len={name}) :: name
    integer :: rule                !< one of the ranges below
  end type real_item

  !> An integer property and its lowest and highest value.
  type, public :: integer_item
    integer :: row
    integer :: families
    character(len={name}) :: name
    integer :: lowest, highest
  end type integer_item

  !> An element type Un: variables of each of its points and of the whole element, properties of each kind.
  type, public :: element_item
    integer :: jtype, family, dimension, nodes, points, variables, own, reals, integers
  end type element_item

  !> The nodes of an interface element on its bottom and top face; 0 where there is none. In the plane left to right,
  !> the middle last, in space counter-clockwise seen from the top, first the corners, then the midside nodes of the
  !> edges that begin there.
  type, public :: faces_item
    integer :: jtype
    integer :: solids(2)           !< number of nodes of its own solids, the bottom one first; 0 without
    integer :: bottom(4), top(4)
    integer :: bottom_middles(4), top_middles(4)
  end type faces_item

  integer, parameter, public :: any_integer = huge(1)
"""


def main(layout: Callable[[str], str], purpose: str) -> None:
    """Run the command line of a program that writes a module from a table, its layout."""
    parser = argparse.ArgumentParser(description=purpose.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("table", type=Path)
    options = parser.parse_args()
    try:
        options.output.write_text(layout(options.table.read_text(encoding="utf-8")), encoding="utf-8")
    except ValueError as error:
        sys.exit(f"{options.table}: {error}")


def layout(text: str) -> str:
    """Text of the module, from that of properties.toml. Raises ValueError with the entry that is wrong."""
    data = tomllib.loads(text)
    check(data)
    longest = max(len(row["name"]) for row in (*data["reals"], *data["integers"]))
    lines = [HEAD.format(name=longest), *body(data), *law_function(data), "end module abaqus_layout"]
    return "\n".join(lines) + "\n"


def check(data: Row) -> None:
    """Raise ValueError for a missing or unknown key, an unknown name, or a name that is there twice."""
    for table in ("ranges", "families", "variables"):
        for name, row in data[table].items():
            check_keys(f"{table}.{name}", table, row)
    for name, table in data["variables"].items():
        for row in table["items"]:
            check_keys(f"variables.{name} {row.get('name', '')}", "items", row)
    for table in ("reals", "integers", "elements"):
        for row in data[table]:
            check_keys(f"{table} {row.get('name', row.get('type', ''))}", table, row)
    check_sets(data)
    check_properties(data)
    check_elements(data)
    symbols = Counter(symbol for symbol, _ in constants(data))
    for symbol, count in symbols.items():
        if count > 1:
            raise ValueError(f"{symbol}: two entries have this name in Fortran; give one of them another symbol")


def check_sets(data: Row) -> None:
    """Raise ValueError for a set with a name that does not come before it, as Fortran demands."""
    known = list(data["families"])
    for name, parts in data["sets"].items():
        for part in parts:
            check_name(f"sets.{name}", part, known)
        known.append(name)


def check_properties(data: Row) -> None:
    """Raise ValueError for a property with elements, a range or laws that do not exist."""
    known = [*data["families"], *data["sets"]]
    laws = len(laws_of(data))
    for table in ("reals", "integers"):
        for row in data[table]:
            where = f"{table} {row['name']}"
            for name in names_in(row["elements"]):
                check_name(f"{where}: elements", name, known)
            if table == "reals":
                check_name(f"{where}: range", row["range"], data["ranges"])
                check_name(f"{where}: part", row.get("part", "law"), ["law"])
            for law in row.get("laws", ()):
                check_name(f"{where}: laws", law, range(1, laws + 1))


def check_elements(data: Row) -> None:
    """Raise ValueError for a family without such variables, an element out of order, or one of an unknown family."""
    for name, family in data["families"].items():
        for key in ("variables", "own"):
            if key in family:
                check_name(f"families.{name}: {key}", family[key], data["variables"])
    last = 0
    for row in data["elements"]:
        where = f"elements {row['type']}"
        number = row["type"].removeprefix("U")
        if not number.isdecimal() or int(number) <= last:
            raise ValueError(f"{where}: expected U and a number above {last}, the types in the order of their numbers")
        last = int(number)
        check_name(f"{where}: family", row["family"], data["families"])
        owns = "own" in data["families"][row["family"]]
        if owns != ("solids" in row) or (owns and sum(row["solids"]) != row["nodes"]):
            expected = f"expected solids = [nodes below, nodes above], together {row['nodes']}, if it owns any"
            raise ValueError(f"{where}: {expected}")


def check_keys(where: str, table: str, row: Row) -> None:
    """Raise ValueError if a row lacks a key or has an unknown one."""
    needed, more = KEYS[table], MORE_KEYS.get(table, set())
    if missing := needed - row.keys():
        raise ValueError(f"{where}: no {', '.join(sorted(missing))}")
    for key in row:
        check_name(where, key, sorted(needed | more))


def check_name(where: str, name: Any, known: Iterable[Any]) -> None:
    """Raise ValueError for a name that is not among those that are known."""
    if name not in known:
        raise ValueError(f"{where}: '{name}', expected one of {', '.join(map(str, known))}")


def names_in(entry: str | Sequence[str]) -> Sequence[str]:
    """Families and sets of an entry that is one of them or a list."""
    return [entry] if isinstance(entry, str) else entry


def families_in(entry: str | Sequence[str], sets: Row) -> set[str]:
    """Families of an entry that is a family, a set or a list of them."""
    return {
        family for name in names_in(entry) for family in (families_in(sets[name], sets) if name in sets else [name])
    }


def laws_of(data: Row) -> Sequence[str]:
    """Names of the cohesive laws, the values 1, 2, ... of LAW."""
    names: Sequence[str] = next(row["values"] for row in data["integers"] if row["name"] == "LAW")
    return names


def properties_of_law(data: Row) -> list[Row]:
    """Rows of the real properties that describe the cohesive law."""
    return [row for row in data["reals"] if row.get("part") == "law"]


def law_function(data: Row) -> Iterator[str]:
    """Lines of the function that takes the properties of the cohesive law from those of the element."""
    yield "contains"
    yield ""
    yield "  !> The properties of the cohesive law, as in the deck."
    yield "  pure function law_properties_of(values) result(properties)"
    yield "    real(dp), intent(in) :: values(:)   !< by the rows of `reals`"
    yield "    type(law_properties) :: properties"
    yield ""
    for row in properties_of_law(data):
        yield f"    properties%{row['name'].lower()} = values({symbol_of('p', row)})"
    yield "  end function law_properties_of"
    yield ""


def constants(data: Row) -> Iterator[tuple[str, int]]:
    """Name and value of each constant that stands for a row of a table."""
    for table, prefix in (("reals", "p"), ("integers", "j")):
        for number, row in enumerate(data[table], start=1):
            yield symbol_of(prefix, row), number
    for table in data["variables"].values():
        for number, row in enumerate(table["items"], start=1):
            yield symbol_of(table["prefix"], row), number


def symbol_of(prefix: str, row: Row) -> str:
    """Return the Fortran constant for a row of a table."""
    return f"{prefix}_{row.get('symbol', row['name'].lower().replace(' ', '_'))}"


def body(data: Row) -> Iterator[str]:
    """Lines of the constants and tables."""
    yield from ("", "  ! permitted values of a real property")
    yield from (parameter(name, number) for number, name in enumerate(data["ranges"], start=1))
    yield from ("", "  !> What a range asks for, in words.")
    expected = [row["expected"] for row in data["ranges"].values()]
    kind = f"character(len={max(map(len, expected))})"
    yield from table_of(kind, "expectations", [(padded(text, max(map(len, expected))), "") for text in expected])
    yield from ("", "  ! families of elements, and sets of them, which are sums")
    yield from (parameter(name, 2**power) for power, name in enumerate(data["families"]))
    yield from (parameter(name, " + ".join(parts)) for name, parts in data["sets"].items())
    yield from ("", "  ! rows of the tables below")
    yield from (parameter(name, number) for name, number in constants(data))
    yield ""
    yield from table_of("type(real_item)", "reals", [real(row, data) for row in data["reals"]])
    yield ""
    yield from table_of("type(integer_item)", "integers", [integer(row, data) for row in data["integers"]])
    yield from (
        "",
        "  !> Rows of the tables that a family has, in the order of PROPS and JPROPS, a column each; then zeros.",
    )
    yield from (line for table in ("reals", "integers") for line in rows_of_families(table, data))
    yield from ("", "  ! numbers of variables")
    yield from (parameter(f"{name}_variables", len(table["items"])) for name, table in data["variables"].items())
    yield ""
    yield from table_of("type(element_item)", "elements", [element(row, data) for row in data["elements"]])
    yield ""
    yield from table_of("type(faces_item)", "faces", [(faces(row), "") for row in data["elements"]])
    yield ""
    yield "  character(len=*), parameter, public :: names_of_types = &"
    yield f"    '{types(data)}'"
    yield ""


def parameter(name: str, value: int | str) -> str:
    """Line that declares an integer constant."""
    return f"  integer, parameter, public :: {name} = {value}"


def table_of(kind: str, name: str, rows: Sequence[tuple[str, str]]) -> Iterator[str]:
    """Lines of an array constant: rows, each after its meaning."""
    yield f"  {kind}, parameter, public :: {name}({len(rows)}) = [ &"
    for number, (row, meaning) in enumerate(rows, start=1):
        if meaning:
            yield f"    !> {meaning}"
        yield f"    {row}" + (", &" if number < len(rows) else "]")


def rows_of_families(table: str, data: Row) -> Iterator[str]:
    """Lines of the array that has the rows of a table for each family."""
    columns = [
        [
            number
            for number, row in enumerate(data[table], start=1)
            if family in families_in(row["elements"], data["sets"])
        ]
        for family in data["families"]
    ]
    most, name = max(map(len, columns)), f"rows_of_{table}"
    yield f"  integer, parameter, public :: {name}({most}, {len(columns)}) = reshape([ &"
    numbers = ", ".join(str(number) for column in columns for number in column + [0] * (most - len(column)))
    lines = textwrap.wrap(numbers, 120)
    yield from (f"    {line} &" for line in lines[:-1])
    yield f"    {lines[-1]}], [{most}, {len(columns)}])"


def real(row: Row, data: Row) -> tuple[str, str]:
    """Write constructor and meaning of a real property."""
    families = " + ".join(names_in(row["elements"]))
    return f"real_item({symbol_of('p', row)}, {families}, {name_of(row, data)}, {row['range']})", row["meaning"]


def integer(row: Row, data: Row) -> tuple[str, str]:
    """Write constructor and meaning of an integer property."""
    families = " + ".join(names_in(row["elements"]))
    highest = len(row["values"]) if "values" in row else row.get("highest")
    bounds = "-any_integer, any_integer" if highest is None else f"0, {highest}"
    return f"integer_item({symbol_of('j', row)}, {families}, {name_of(row, data)}, {bounds})", row["meaning"]


def name_of(row: Row, data: Row) -> str:
    """Name of a property as a character constant, all of one length."""
    return padded(row["name"], max(len(each["name"]) for each in (*data["reals"], *data["integers"])))


def padded(text: str, length: int) -> str:
    """Text as a character constant of a length: those of an array constant have to be alike."""
    return "'" + text.replace("'", "''").ljust(length + text.count("'")) + "'"


def element(row: Row, data: Row) -> tuple[str, str]:
    """Write constructor and meaning of an element type."""
    family = data["families"][row["family"]]
    variables = [f"{family[key]}_variables" if key in family else 0 for key in ("variables", "own")]
    counts = [row["dimension"], row["nodes"], row["points"], *variables]
    properties = [
        sum(row["family"] in families_in(each["elements"], data["sets"]) for each in data[table])
        for table in ("reals", "integers")
    ]
    fields = [row["type"][1:], row["family"], *counts, *properties]
    return f"element_item({', '.join(map(str, fields))})", row["meaning"]


def faces(row: Row) -> str:
    """Write the constructor of the nodes of the faces."""
    corners = CORNERS.get((row["dimension"], len(row.get("bottom", ()))), 4)
    parts = [slice(corners), slice(corners, None)]
    nodes = [(row.get(side, [])[part] + 4 * [0])[:4] for part in parts for side in ("bottom", "top")]
    return f"faces_item({row['type'][1:]}, {row.get('solids', [0, 0])}, {', '.join(map(str, nodes))})"


def types(data: Row) -> str:
    """Name the element types in a few words: consecutive numbers as a range."""
    numbers = [int(row["type"][1:]) for row in data["elements"]]
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return ", ".join(f"U{run[0]}" if len(run) == 1 else f"U{run[0]} to U{run[-1]}" for run in runs)


if __name__ == "__main__":
    main(layout, __doc__)
