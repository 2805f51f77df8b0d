# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Text of Abaqus keyword blocks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from uel.model.arrays import FloatArray, IntArray

PER_LINE = 8


def number(value: float) -> str:
    """Format a real number with up to twelve digits and a point or an exponent; -0 as 0."""
    text = f"{value + 0.0:.12g}"
    return text if any(mark in text for mark in ".en") else text + "."


def keyword(name: str, *flags: str, **options: str | int) -> str:
    """Write a keyword line: parameters, then flags; an underscore in a parameter's name becomes a blank."""
    words = [f"{key.replace('_', ' ')}={value}" for key, value in options.items()]
    return ", ".join([f"*{name}", *words, *flags])


def table(rows: Iterable[Iterable[float]]) -> list[str]:
    """Write data lines, integers as integers and reals as reals."""
    return [", ".join(str(item) if isinstance(item, int) else number(item) for item in row) for row in rows]


def wrapped(values: Sequence[float]) -> list[str]:
    """Write data lines of at most eight values."""
    return table(values[k : k + PER_LINE] for k in range(0, len(values), PER_LINE))


def captions(names: Sequence[str]) -> list[str]:
    """Write a comment line with the names of the values for each data line of `wrapped`."""
    return ["** " + ", ".join(names[k : k + PER_LINE]) for k in range(0, len(names), PER_LINE)]


def node_block(labels: IntArray, coordinates: FloatArray) -> list[str]:
    """Write *NODE."""
    rows = zip(labels.tolist(), coordinates.tolist(), strict=True)
    return ["*NODE", *table([label, *point] for label, point in rows)]


def node_set(name: str, labels: IntArray, *, generate: bool = False) -> list[str]:
    """Write *NSET by labels; with `generate` by first, last and difference where they are equidistant."""
    steps = np.unique(np.diff(labels))
    if generate and len(steps) == 1:
        return [keyword("NSET", "GENERATE", NSET=name), *table([(int(labels[0]), int(labels[-1]), int(steps[0]))])]
    return [keyword("NSET", NSET=name), *wrapped(labels.tolist())]


def integer_table(rows: IntArray) -> str:
    """Write data lines of integers, as *ELEMENT, INPUT= reads them."""
    return "".join(", ".join(map(str, row)) + "\n" for row in rows.tolist())


def element_block(kind: str, name: str, nodes: IntArray, first: int) -> list[str]:
    """Write *ELEMENT of a type, into an element set, numbered from `first`."""
    numbered = np.column_stack([np.arange(first, first + len(nodes)), nodes])
    return [keyword("ELEMENT", TYPE=kind, ELSET=name), *integer_table(numbered).splitlines()]


def text(lines: Iterable[str]) -> str:
    """Join lines to the text of a file."""
    return "\n".join(lines) + "\n"
