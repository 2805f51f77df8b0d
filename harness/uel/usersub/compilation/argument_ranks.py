# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Constants passed to array arguments, where the routine reads other data behind the constant."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import partial
from typing import Final

from uel.usersub.compilation.compatibility import LONGEST, Repair, edit_line
from uel.usersub.compilation.diagnostics import warnings_of

HINT: Final = "the routine also reads the memory after it, which holds something else: pass an array"

_RANK: Final = re.compile(r"Rank mismatch in argument '(\w+)' at \(1\) \(rank-(?:\d+) and scalar\)")
_ARGUMENT: Final = re.compile(r"[\s(,]*[-+]?(?:\.?\d|([a-z]\w*)\s*[,)])", re.IGNORECASE)


_ZERO: Final = r"[-+]?(?:0+\.?0*|\.0+)(?:[de][-+]?\d+)?"
_ZERO_ARGUMENT: Final = re.compile(rf"(?P<before>[\s(,]*)(?P<value>{_ZERO}|[a-z]\w*)(?=\s*[,)])", re.IGNORECASE)

_ENOUGH: Final = 100
"""Zeros in place of one: more than the coordinates of a point, for which codes pass it."""


def array_argument(message: str) -> str | None:
    """Return the name of the array argument to which, by gfortran's message, a scalar is passed."""
    match = _RANK.search(message)
    return match and match[1]


def is_constant(text: str, line: int, column: int) -> bool:
    """Return whether a number or the name of a PARAMETER is at or behind a line and column (from 1)."""
    rows = text.splitlines()
    match = _ARGUMENT.match(rows[line - 1], column - 1) if 1 <= line <= len(rows) else None
    if match is None or match[1] is None:
        return match is not None
    named = re.compile(rf"^\s*[^!c*\n]*\bparameter\b[^!\n]*\b{match[1]}\s*=", re.IGNORECASE)
    return any(map(named.match, rows))


def constants_for_arrays(output: str, texts: Mapping[str, str]) -> Iterator[str]:
    """Yield messages about constants passed to arrays, from gfortran's output; texts: sources by file name.

    The memory after a variable may be intended; after a constant there are other constants. Zeros are repaired.
    """
    for file, line, column, message, _ in warnings_of(output):
        argument, text = array_argument(message), texts.get(file, "")
        if argument and is_constant(text, line, column) and pass_zeros(text, line, column) is None:
            source = " ".join(text.splitlines()[line - 1].split())
            yield (
                f"{file}, line {line}: a constant is passed for the argument '{argument}', which is an array: "
                f"{source} ({HINT})"
            )


def zeros_for_arrays(output: str) -> Iterator[Repair]:
    """Yield repairs that pass an array of zeros for the constant zero.

    Routines that take a point, such as the centre of an element, are called so. The memory after the constant in Abaqus
    is unknown, but zeros are intended.
    """
    for file, line, column, message, _ in warnings_of(output):
        if argument := array_argument(message):
            note = f"zero is passed for the argument '{argument}', which is an array; the copy passes an array of zeros"
            yield Repair(file, line, partial(pass_zeros, line=line, column=column), note)


def pass_zeros(text: str, line: int, column: int) -> str | None:
    """Replace the constant zero at or behind a column by an array of zeros; None if there is none."""

    def change(row: str) -> str | None:
        match = _ZERO_ARGUMENT.match(row, column - 1)
        if match is None or not _is_zero(match["value"], text):
            return None
        changed = f"{row[: match.start('value')]}spread({match['value']},1,{_ENOUGH}){row[match.end() :]}"
        return changed if len(changed.rstrip()) <= LONGEST else None

    return edit_line(text, line, change)


def _is_zero(value: str, text: str) -> bool:
    """Return whether a number, or each PARAMETER of that name, is zero."""
    if not value[0].isalpha():
        return True
    defined = re.compile(rf"^\s*[^!c*\n]*\bparameter\b[^!\n]*\b{value}\s*=\s*([^,)\n]*)", re.IGNORECASE | re.MULTILINE)
    values = defined.findall(text)
    return bool(values) and all(re.fullmatch(_ZERO, each.strip(), re.IGNORECASE) for each in values)
