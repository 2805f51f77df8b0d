# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Program units of a Fortran text: their dummy arguments, the names they use, and declarations as in Fortran 66."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final

_TYPE: Final = r"(?:integer|real|double\s*precision|complex|logical|character)"
_HEAD: Final = re.compile(
    rf"^(?:(?:recursive|pure|elemental|{_TYPE}(?:\s*\*\s*\d+|\s*\([^()]*\))?)\s+)*(?:subroutine|function)\s+\w+\s*"
    r"(?:\(([^()]*)\))?",
    re.IGNORECASE,
)
_DECLARATION: Final = re.compile(rf"^(?:dimension|{_TYPE})\b", re.IGNORECASE)
_SPECIFICATION: Final = re.compile(
    rf"^(?:dimension|parameter|common|data|save|external|intrinsic|equivalence|{_TYPE})\b(?!\s*=)", re.IGNORECASE
)
_CALL: Final = re.compile(r"^(?:if\s*\(.*\)\s*)?(?:call|read)\b", re.IGNORECASE)
_ASSIGNMENT: Final = re.compile(r"^(?:do\s+(?:\d+\s+)?)?\w+\s*(?:\([^=]*\)\s*)?=(?!=)", re.IGNORECASE)
_IMPLICIT: Final = re.compile(r"^implicit\s+(?!none)", re.IGNORECASE)
_NAME: Final = re.compile(r"(?<![\w.%])[a-z]\w*", re.IGNORECASE)
_STRING: Final = re.compile(r"'[^'\n]*'|\"[^\"\n]*\"")


@dataclass(slots=True)
class Unit:
    """A subroutine or function from its first line on.

    dummies   names of its arguments, in lower case like all names
    names     number of occurrences of each name
    declared  names in declarations
    integers  names in declarations of integers
    read      names whose value is used: neither assigned, nor an argument of CALL
    """

    first: int
    dummies: frozenset[str]
    names: Counter[str] = field(default_factory=Counter)
    declared: set[str] = field(default_factory=set)
    integers: set[str] = field(default_factory=set)
    read: set[str] = field(default_factory=set)

    def single(self, name: str) -> bool:
        """Return whether a name occurs once and outside declarations."""
        return self.names[name] == 1 and name not in self.declared and name not in self.dummies


def units(text: str, *, free: bool) -> list[Unit]:
    """Return the subroutines and functions in the order of the text; lines count from 1."""
    units: list[Unit] = []
    for lines, statement in statements(text, free=free):
        if head := _HEAD.match(statement):
            dummies = frozenset(name.strip().lower() for name in (head[1] or "").split(",") if name.strip())
            units.append(Unit(lines[0], dummies))
        elif units:
            unit, names = units[-1], [name.lower() for name in _NAME.findall(statement)]
            unit.names.update(names)
            if _SPECIFICATION.match(statement):
                unit.declared.update(names)
                if names[0] == "integer":
                    unit.integers.update(names)
            elif not _CALL.match(statement):
                unit.read.update(names[1:] if _ASSIGNMENT.match(statement) else names)
    return units


def unit_at(units: list[Unit], line: int) -> Unit | None:
    """Return the unit that contains a line."""
    return next((unit for unit in reversed(units) if unit.first <= line), None)


def with_open_bounds(text: str, *, free: bool, but: frozenset[str] = frozenset()) -> str:
    """Write * for a last bound of 1 of dummy arrays, Fortran 66's notation for any size.

    but: names that stay as they are, in lower case.
    """
    rows = text.splitlines(keepends=True)
    dummies: frozenset[str] = frozenset()
    for lines, statement in statements(text, free=free):
        if head := _HEAD.match(statement):
            dummies = frozenset(name.strip().lower() for name in (head[1] or "").split(",")) - but
        elif dummies and _DECLARATION.match(statement):
            for line in lines:
                rows[line - 1] = _opened(rows[line - 1], dummies)
    return "".join(rows)


def _opened(row: str, names: frozenset[str]) -> str:
    def change(match: re.Match[str]) -> str:
        return f"{match[1]}*{match[3]}" if match[2].lower() in names else match[0]

    return re.sub(r"((?<![\w*])([a-z]\w*)\s*\((?:[^()]*,)?\s*)1(\s*\))", change, row, flags=re.IGNORECASE)


def without_implicit(text: str, *, free: bool) -> str:
    """Remove IMPLICIT statements other than IMPLICIT NONE; line numbers do not change."""
    rows = text.splitlines(keepends=True)
    for lines, statement in statements(text, free=free):
        if _IMPLICIT.match(statement):
            for line in lines:
                rows[line - 1] = "\n"
    return "".join(rows)


def statements(text: str, *, free: bool) -> Iterator[tuple[list[int], str]]:
    """Yield statements with the numbers of their lines (from 1): continuation joined, comments and strings left out."""
    lines: list[int] = []
    statement, continued = "", False
    for number, row in enumerate(text.splitlines(), 1):
        code = _STRING.sub("''", row).partition("!")[0]
        if (not free and row[:1] in "cC*dD#") or not code.strip() or code.lstrip().startswith("#"):
            continue
        more = continued if free else _continues(code)
        if not more and lines:
            yield lines, statement.strip()
            lines, statement = [], ""
        continued = free and code.rstrip().endswith("&")
        lines.append(number)
        statement += " " + (code.strip().strip("&") if free else _body(code))
    if lines:
        yield lines, statement.strip()


def _continues(row: str) -> bool:
    """Return whether a line of fixed form continues the one before it."""
    if row.startswith("\t"):
        return row[1:2].isdigit() and row[1] != "0"
    return len(row) > 5 and not row[:5].strip() and "\t" not in row[:6] and row[5] not in " 0"


def _body(row: str) -> str:
    """Strip label and continuation character from a fixed-form line."""
    if row.startswith("\t"):
        return row[2:].strip() if _continues(row) else row[1:].strip()
    return row[6:].strip() if "\t" not in row[:6] else row.strip()
