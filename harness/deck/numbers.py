# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Numbers as a deck writes them: one by one with every spelling, or a whole block of plain ones at once."""

from __future__ import annotations

import re

import numpy as np

from harness.model.arrays import FloatArray, IntArray

# mantissa, then an exponent with E or D; '210e9.0' has one reading only, so it is taken
_REAL = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:[EeDd]([+-]?\d+)(?:\.0*)?)?", re.ASCII)
_INTEGER = re.compile(r"[+-]?\d+(?:\.0*)?", re.ASCII)
# float() and int() read these too: 1_000, nan, inf, and digits of other scripts
_NOT_PLAIN = re.compile(r"[_a-df-zA-DF-Z]|[^\x00-\x7f]")
LARGEST_INTEGER = 2**31 - 1
LARGEST, SMALLEST = 1e100, 1e-100
"""Sizes of real numbers: their cubes are numbers as well, and so are the reciprocals."""


def read_real(text: str) -> float:
    """A real number; ValueError where the text is none, or too large or too small to compute with."""
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
    """An integer, '3.' included; ValueError where the text is none or does not fit 32 bits."""
    if _INTEGER.fullmatch(text) is None:
        raise ValueError(f"'{text}' is not an integer")
    digits = text.split(".", maxsplit=1)[0]
    if len(digits) > 11 or abs(int(digits)) > LARGEST_INTEGER:
        raise ValueError(f"'{text}' is too large for an integer")
    return int(digits)


def is_integer(text: str) -> bool:
    """True for the spelling of an integer."""
    return _INTEGER.fullmatch(text) is not None


def real_table(lines: list[str]) -> FloatArray | None:
    """(lines, columns) of a block whose lines all hold the same number of plain numbers, None for any other."""
    tokens = _plain_tokens(lines)
    if not tokens:
        return None
    try:
        table = np.array(list(map(float, tokens)))
    except ValueError:
        return None
    sizes = np.abs(table)
    # a number that is out of bounds is named when the lines are read one by one
    if not (sizes <= LARGEST).all() or ((sizes < SMALLEST) & (sizes > 0.0)).any():
        return None
    return table.reshape(len(lines), -1)


def integer_table(lines: list[str]) -> IntArray | None:
    """(lines, columns) of a block whose lines all hold the same number of plain integers, None for any other."""
    tokens = _plain_tokens(lines)
    if not tokens:
        return None
    try:
        table = np.array(list(map(int, tokens)), dtype=np.int64)
    except (ValueError, OverflowError):
        return None
    return table.reshape(len(lines), -1) if np.abs(table).max() <= LARGEST_INTEGER else None


def _plain_tokens(lines: list[str]) -> list[str]:
    if not lines:
        return []
    if lines[0].endswith(","):
        lines = [line.rstrip(", \t") for line in lines]
    if len({line.count(",") for line in lines}) != 1:
        return []
    text = ",".join(lines)
    return [] if _NOT_PLAIN.search(text) else text.split(",")
