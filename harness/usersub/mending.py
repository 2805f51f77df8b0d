# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Extensions of Abaqus' Fortran compiler that gfortran refuses, written in standard Fortran in a copy of the file.

Only what has one meaning is changed, at the places that the compiler names; the user's file stays as it is.
"""

from __future__ import annotations

import re
from typing import Final

COMPARED_LOGICALS: Final = re.compile(
    r"^(?P<file>[^\n]+?):(?P<line>\d+):(?P<column>\d+):\n(?:(?!.*Error:).*\n)*?"
    r"Error: Logicals at \(1\) must be compared with \.(?:n?eqv)\. instead of (?P<operator>\S+)$",
    re.MULTILINE,
)
_SPELLINGS: Final = {".eq.": (".eq.", "=="), "==": (".eq.", "=="), ".ne.": (".ne.", "/="), "/=": (".ne.", "/=")}
_STANDARD: Final = {".eq.": ".eqv.", "==": ".eqv.", ".ne.": ".neqv.", "/=": ".neqv."}
_WEAKER: Final = re.compile(r"\.(and|or|eqv|neqv)\.", re.IGNORECASE)


def compare_logicals(text: str, line: int, column: int, operator: str) -> str | None:
    """The text with one comparison of logicals as .eqv. or .neqv.; None where that could change what it means.

    line and column are those of the first operand, from 1. `.eqv.` binds less than `.and.`, `.eq.` more: the comparison
    has to stand alone between its parentheses.
    """
    lines = text.splitlines(keepends=True)
    if not 1 <= line <= len(lines):
        return None
    row = lines[line - 1]
    pattern = "|".join(re.escape(spelling) for spelling in _SPELLINGS[operator.lower()])
    found = re.compile(pattern, re.IGNORECASE).search(row, column - 1)
    if found is None or _WEAKER.search(_alone(row, found.start(), found.end()) or ".and."):
        return None
    standard = _STANDARD[found[0].lower()]
    lines[line - 1] = f"{row[: found.start()]} {standard} {row[found.end() :].lstrip(' ')}"
    return "".join(lines)


def _alone(row: str, start: int, end: int) -> str | None:
    """What stands between the parentheses around a place; None where they are not in the line."""
    first = _unmatched(row, range(start - 1, -1, -1), "(", ")")
    last = _unmatched(row, range(end, len(row)), ")", "(")
    return None if first is None or last is None else row[first + 1 : last]


def _unmatched(row: str, places: range, wanted: str, other: str) -> int | None:
    depth = 0
    for place in places:
        depth += (row[place] == other) - (row[place] == wanted)
        if depth < 0:
            return place
    return None
