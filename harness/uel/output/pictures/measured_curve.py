# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measured curve, from a CSV file as test machines and spreadsheets write it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from uel.errors import UelError, UsageError
from uel.model.arrays import FloatArray
from uel.output.pictures.column import Column, read_column


def read_curve(path: Path, axes: Sequence[Column] = ()) -> tuple[FloatArray, FloatArray]:
    """Read abscissae and ordinates of a measured curve.

    Parameters
    ----------
    path
        Lines of numbers with commas, semicolons, tabs or blanks between them. Lines before the first one that has two
        numbers are a head; a point is the decimal mark, or a comma where semicolons or tabs separate the numbers.
    axes
        Columns of the history for abscissae and ordinates. The file's columns of these names are read; the first two if
        the head does not have both. A factor in the head, such as 2*U2[TIP], is replaced by that of the axis.

    Returns
    -------
    x, y
        One value for each line of numbers.

    Raises
    ------
    UelError
        A line has no two numbers, with file and line; or there are none at all.
    """
    rows: list[tuple[float, float]] = []
    columns, scales = [0, 1], [1.0, 1.0]
    for number, line in enumerate(path.read_text("utf-8-sig", errors="replace").splitlines(), 1):
        cells = _cells(line)
        if not any(cells):
            continue
        values = [_number(cells[k]) if k < len(cells) else None for k in columns]
        if values[0] is not None and values[1] is not None:
            rows.append((values[0], values[1]))
        elif rows:
            raise UelError(f"{path}:{number}: expected numbers in columns {columns[0] + 1} and {columns[1] + 1}")
        else:
            named = [_find_axis(cells, axis) for axis in axes]
            if axes and all(named):
                columns = [column[0] for column in named if column]
            for k, column in enumerate(named):
                if column and column[0] == columns[k]:
                    scales[k] = column[1]
    if not rows:
        raise UelError(f"{path}: no line with two numbers; expected a displacement and a load in each line")
    x, y = (scale * values for scale, values in zip(scales, np.array(rows).T, strict=True))
    return x, y


def _find_axis(cells: Sequence[str], axis: Column) -> tuple[int, float] | None:
    """Find the cell of a head that names an axis, and the factor from its values to those of the axis."""
    for k, cell in enumerate(cells):
        try:
            column = read_column(cell)
        except UsageError:
            continue
        if axis.names(column.name):
            return k, axis.factor / column.factor
    return None


def _cells(line: str) -> list[str]:
    """Return the cells of a line; a comma is a decimal mark where something else separates."""
    for separator in (";", "\t"):
        if separator in line:
            return [cell.strip().strip('"').replace(",", ".") for cell in line.split(separator)]
    return [cell.strip().strip('"') for cell in (line.split(",") if "," in line else line.split())]


def _number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if np.isfinite(value) else None
