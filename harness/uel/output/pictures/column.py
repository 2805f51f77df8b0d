# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Column of the history times a factor, for `uel plot`, `uel fit` and the heads of measured curves."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from uel.errors import UsageError
from uel.model.arrays import FloatArray
from uel.model.nodal_variables import COMPONENTS
from uel.output.pictures.load_curve import COLUMN, FORCES, move_as_one

_TERM = re.compile(r"\s*(?:([-+]?\d*\.?\d*(?:[eE][-+]?\d+)?)\s*\*\s*|([-+]))?([A-Za-z].*?)\s*")
_SUM = "SUM OF "
"""Prefix of the name of a sum in messages and pictures."""


@dataclass(frozen=True, slots=True)
class Column:
    """A column of the history times a factor: `2*U2[LOAD_TOP]`, `-RF2[MIDSPAN]`.

    If the history has a column for each node of a set, a name without a node, `RF2[END]`, is the sum of their forces,
    or their displacement if they move as one.
    """

    name: str
    factor: float = 1.0

    def __str__(self) -> str:
        signs = {1.0: "", -1.0: "-"}
        return signs.get(self.factor, f"{self.factor:g}*") + self.name

    def names(self, name: str) -> bool:
        """Return whether a column has this name, in upper or lower case."""
        return name.upper().removeprefix(_SUM) == self.name.upper().removeprefix(_SUM)

    def find(self, history: Mapping[str, FloatArray], where: str) -> FloatArray:
        """Return the column's values times the factor, one for each row.

        Raises
        ------
        UsageError
            `where`, the history, does not have the column; or the nodes of a set do not move as one.
        """
        nodes: dict[str, FloatArray] = {}
        for name, values in history.items():
            if self.names(name):
                return self.factor * values
            match = COLUMN.fullmatch(name)
            if match and match["node"] and self.names(_of_set(match)):
                nodes[name] = values
        if not nodes:
            raise UsageError(f"{where}: no column '{self.name}'; expected one of {column_names(history)}")
        component = self.name.upper().removeprefix(_SUM).partition("[")[0]
        if COMPONENTS.get(component, ("", 0))[0] in FORCES:
            total: FloatArray = self.factor * np.sum([*nodes.values()], axis=0)
            return total
        if not move_as_one(nodes.values()):
            raise UsageError(
                f"{where}: {self.name} differs from node to node; expected one, such as {next(iter(nodes))}"
            )
        return self.factor * next(iter(nodes.values()))


def column_names(history: Mapping[str, FloatArray]) -> str:
    """List the columns of a history for messages; for the nodes of a set, its name, first and last node."""
    names: dict[str, list[str]] = {}
    for name in history:
        if name not in ("step", "increment"):
            match = COLUMN.fullmatch(name)
            names.setdefault(_of_set(match) if match and match["node"] else name, []).append(name)
    return ", ".join(
        key if dofs == [key] else f"{key} ({dofs[0]}{f' to {dofs[-1]}' if len(dofs) > 1 else ''})"
        for key, dofs in names.items()
    )


def _of_set(match: re.Match[str]) -> str:
    return f"{match['component']}[{match['set']}]"


def read_column(text: str) -> Column:
    """Parse a column such as `2*U2[LOAD_TOP]`. Raises UsageError."""
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
