# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Values of options."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable

_MANY = 1 << 31
"""Limit above every sensible count."""


def number(words: str, holds: Callable[[float], bool] = math.isfinite) -> Callable[[str], float]:
    """Make a converter of an option to a finite number that meets a condition; words say what is expected."""

    def read(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not (math.isfinite(value) and holds(value)):
            raise argparse.ArgumentTypeError(f"expected {words}, found '{text}'")
        return value

    return read


FINITE = number("a number")


ABOVE_ZERO = number("a number above 0", lambda value: value > 0.0)


NOT_NEGATIVE = number("a number of 0 or more", lambda value: value >= 0.0)


PART = number("a number from 0 to 1", lambda value: 0.0 <= value <= 1.0)


def positive(text: str) -> int:
    """Convert an option to a whole number of 1 or more."""
    return int(
        number("a whole number of 1 or more", lambda value: value >= 1.0 and value == int(value) and value < _MANY)(
            text
        )
    )


def part(text: str) -> tuple[int, int]:
    """Convert an option I/N to part I of N parts."""
    index, _, count = text.partition("/")
    if index.isdecimal() and count.isdecimal() and 1 <= int(index) <= int(count) < _MANY:
        return int(index), int(count)
    raise argparse.ArgumentTypeError(f"expected I/N with I from 1 to N, such as 3/20, found '{text}'")


def assignment(text: str) -> tuple[str, float]:
    """Split the name and value of a parameter in an option."""
    from uel.batch.values import value_of  # noqa: PLC0415 (keeps the other commands quick)

    name, _, value = text.partition("=")
    try:
        return name.strip(), value_of(value)
    except ValueError:
        raise argparse.ArgumentTypeError(f"expected NAME=VALUE with a number, found '{text}'") from None
