# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A curve that was measured, from a CSV file as test machines and spreadsheets write it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from harness.errors import UelError
from harness.model.arrays import FloatArray


def read_curve(path: Path, names: Sequence[str] = ()) -> tuple[FloatArray, FloatArray]:
    """Abscissae and ordinates of a measured curve.

    Parameters
    ----------
    path
        Lines of numbers with commas, semicolons, tabs or blanks between them. Lines before the first one that has two
        numbers are a head; a point is the decimal mark, or a comma where semicolons or tabs separate the numbers.
    names
        Of the two columns; the first two columns if the head does not have both names.

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
    columns = (0, 1)
    for number, line in enumerate(path.read_text("utf-8-sig", errors="replace").splitlines(), 1):
        cells = _cells(line)
        if not any(cells):
            continue
        values = [_number(cells[k]) if k < len(cells) else None for k in columns]
        if values[0] is not None and values[1] is not None:
            rows.append((values[0], values[1]))
        elif rows:
            raise UelError(f"{path}:{number}: expected numbers in columns {columns[0] + 1} and {columns[1] + 1}")
        elif len(names) == 2 and all(name in cells for name in names):
            columns = (cells.index(names[0]), cells.index(names[1]))
    if not rows:
        raise UelError(f"{path}: no line with two numbers; expected a displacement and a load in each line")
    table = np.array(rows)
    return table[:, 0].copy(), table[:, 1].copy()


def _cells(line: str) -> list[str]:
    """Cells of a line; a comma is a decimal mark where something else separates."""
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
