# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of a deck: single fields in any spelling, or blocks of plain numbers at once."""

from __future__ import annotations

import re
import warnings
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray, IntArray

Number = TypeVar("Number", np.float64, np.int64)

# mantissa, then an exponent with E or D; '210e9.0' is accepted, since it is unambiguous
_REAL = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:[EeDd]([+-]?\d+)(?:\.0*)?)?", re.ASCII)
_INTEGER = re.compile(r"[+-]?\d+(?:\.0*)?", re.ASCII)
LARGEST_INTEGER = 2**31 - 1
LARGEST, SMALLEST = 1e100, 1e-100
"""Sizes of real numbers: their cubes are numbers as well, and so are the reciprocals."""


def read_real(text: str) -> float:
    """Parse a real number. Raises ValueError if the text is not a number, or too large or too small to compute with."""
    match = _REAL.fullmatch(text)
    if match is None:
        raise ValueError(f"'{text}' is not a number")
    value = float(f"{match[1]}e{match[2] or 0}")
    if abs(value) > LARGEST:
        raise ValueError(f"'{text}' is too large: numbers up to {LARGEST:g} are read")
    if 0.0 < abs(value) < SMALLEST:
        raise ValueError(f"'{text}' is too small: numbers from {SMALLEST:g} on, and 0, are read")
    return value


def read_integer(text: str) -> int:
    """Parse an integer, '3.' included. Raises ValueError if the text is not an integer or does not fit 32 bits."""
    if _INTEGER.fullmatch(text) is None:
        raise ValueError(f"'{text}' is not an integer")
    digits = text.split(".", maxsplit=1)[0]
    if len(digits) > 11 or abs(int(digits)) > LARGEST_INTEGER:
        raise ValueError(f"'{text}' is too large for an integer")
    return int(digits)


def is_integer(text: str) -> bool:
    """Return whether the text is spelt as an integer."""
    return _INTEGER.fullmatch(text) is not None


def real_table(lines: list[str]) -> FloatArray | None:
    """Parse a block of plain real numbers to (lines, columns), None unless all lines hold the same number of them."""
    table = _table(lines, np.float64)
    if table is None:
        return None
    sizes = np.abs(table)
    # reading line by line reports a number out of bounds; comparisons with nan are false
    if not (sizes <= LARGEST).all() or ((sizes < SMALLEST) & (sizes > 0.0)).any():
        return None
    return table


def integer_table(lines: list[str], *, columns: int | None = None) -> IntArray | None:
    """Parse a block of plain integers to (lines, columns), None unless all lines hold the same number of them.

    columns: number of columns to read; further entries are not parsed.
    """
    table = _table(lines, np.int64, columns)
    return None if table is None or np.abs(table).max() > LARGEST_INTEGER else table


def _table(lines: list[str], kind: type[Number], columns: int | None = None) -> NDArray[Number] | None:
    if not lines or not all(map(str.isascii, lines)):
        return None
    if lines[0].endswith(","):
        lines = [line.rstrip(", \t") for line in lines]
    with warnings.catch_warnings():
        # of lines without data, and of integers that are written as real numbers
        warnings.simplefilter("error")
        try:
            table = np.loadtxt(
                lines, kind, comments=None, delimiter=",", ndmin=2, usecols=None if columns is None else range(columns)
            )
        except (ValueError, Warning):
            return None
    # blank lines are left out
    return table if len(table) == len(lines) else None
