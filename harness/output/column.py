# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A column of the history times a factor, as `uel plot` and `uel fit` take it, and the heads of measured curves."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

from harness.errors import UsageError
from harness.model.arrays import FloatArray

_TERM = re.compile(r"\s*(?:([-+]?\d*\.?\d*(?:[eE][-+]?\d+)?)\s*\*\s*|([-+]))?([A-Za-z].*?)\s*")


@dataclass(frozen=True, slots=True)
class Column:
    """A column of the history times a factor: `2*U2[LOAD_TOP]`, `-RF2[MIDSPAN]`."""

    name: str
    factor: float = 1.0

    def __str__(self) -> str:
        signs = {1.0: "", -1.0: "-"}
        return signs.get(self.factor, f"{self.factor:g}*") + self.name

    def names(self, name: str) -> bool:
        """Whether a column has this name; upper and lower case are the same."""
        return name.upper() == self.name.upper()

    def find(self, history: Mapping[str, FloatArray]) -> FloatArray | None:
        """Its values times the factor, one for each row; None if the history does not have the column."""
        for name, values in history.items():
            if self.names(name):
                return self.factor * values
        return None


def read_column(text: str) -> Column:
    """Column of a word such as `2*U2[LOAD_TOP]`; raises UsageError."""
    match = _TERM.fullmatch(text)
    try:
        if match is None:
            raise ValueError
        factor = float(match[1]) if match[1] is not None else float(f"{match[2] or ''}1")
        if not math.isfinite(factor) or factor == 0.0:
            raise ValueError
    except ValueError:
        raise UsageError(
            f"'{text}': expected a column of the history, with a factor or a sign before it, such as 2*U2[TOP]"
        ) from None
    return Column(match[3], factor)
