# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A number passed where a routine expects an array: the routine then reads something else after it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Final

from harness.usersub.diagnostics import warnings_of

HINT: Final = "the routine also reads the memory after it, which holds something else: pass an array"

_RANK: Final = re.compile(r"Rank mismatch in argument '(\w+)' at \(1\) \(rank-(?:\d+) and scalar\)")
_ARGUMENT: Final = re.compile(r"[\s(,]*[-+]?(?:\.?\d|([a-z]\w*)\s*[,)])", re.IGNORECASE)


def array_wanted(message: str) -> str | None:
    """Name of the array argument for which, by gfortran's message, a single value is passed."""
    found = _RANK.search(message)
    return found and found[1]


def is_constant(text: str, line: int, column: int) -> bool:
    """Whether a number, or the name of a PARAMETER, is at a line and column (from 1), or after it."""
    rows = text.splitlines()
    found = _ARGUMENT.match(rows[line - 1], column - 1) if 1 <= line <= len(rows) else None
    if found is None or found[1] is None:
        return found is not None
    named = re.compile(rf"^\s*[^!c*\n]*\bparameter\b[^!\n]*\b{found[1]}\s*=", re.IGNORECASE)
    return any(map(named.match, rows))


def constants_for_arrays(output: str, texts: Mapping[str, str]) -> Iterator[str]:
    """Sentences on what gfortran's output says about constants; texts of the files by bare name.

    The memory after a variable may be what is meant; after a constant come other constants.
    """
    for file, line, column, message, _ in warnings_of(output):
        argument, text = array_wanted(message), texts.get(file, "")
        if argument and is_constant(text, line, column):
            source = " ".join(text.splitlines()[line - 1].split())
            yield (
                f"{file}, line {line}: a constant is passed for the argument '{argument}', which is an array: "
                f"{source} ({HINT})"
            )
