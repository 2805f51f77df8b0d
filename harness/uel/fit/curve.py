# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measured points, and the curve of a run at their x."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uel.batch.table import read_cells
from uel.errors import DeckError, Source, UelError
from uel.model.arrays import FloatArray
from uel.output import Result
from uel.output.pictures.column import Column, read_column


@dataclass(frozen=True, slots=True)
class Measurement:
    """Measured points.

    x, y     values (n,), x rising
    columns  what they are in the results of a run; here the history
    """

    x: FloatArray
    y: FloatArray
    columns: tuple[Column, Column]

    @property
    def logarithmic(self) -> bool:
        """True if x and y are shown on logarithmic scales."""
        return False

    @property
    def beside(self) -> dict[str, FloatArray]:
        """Columns of the table beside x and y, by name."""
        return {}

    @property
    def marks(self) -> dict[str, NDArray[np.bool_]]:
        """Points (n,) of each kind in a picture, by its name."""
        return {"measured": np.ones(len(self.x), dtype=bool)}

    @property
    def parts(self) -> list[slice]:
        """Points that a line joins."""
        return [slice(None)]

    @property
    def difference(self) -> str:
        """Name of a difference of two y."""
        return f"change of {self.columns[1]}"

    @property
    def scale(self) -> float:
        """Largest measured value, of which residuals are a part."""
        return float(np.abs(self.y).max())

    def distance(self, deviation: float) -> str:
        """Say how far a curve is from the measured one, by the root of the mean square."""
        return f"off by {deviation / self.scale:.2%} of the peak"

    def spread(self, deviation: float) -> str:
        """Describe the root of the mean square between the fitted curve and the measured one."""
        return f"standard deviation from the measured curve {deviation:.4g}"

    def change(self, largest: float) -> str:
        """Describe the largest change of the curve by a variable."""
        return f"moves the curve by up to {largest:.3g}"

    def written(self, values: FloatArray) -> FloatArray:
        """Return values (n,) such as y in the measure of the file."""
        return values

    def of_result(self, result: Result, job: str) -> FloatArray:
        """Return the values of a run (n,) at x. Raises UelError if it cannot be compared."""
        return self.of_run(result.history, job)

    def of_run(self, history: Mapping[str, FloatArray], job: str) -> FloatArray:
        """Return the values of a run (n,) at x, from a start at (0, 0) on.

        Raises
        ------
        UelError
            The run does not have the columns, does not reach the last x, or its x does not rise.
        """
        x, y = (np.concatenate([[0.0], column.find(history, job)]) for column in self.columns)
        # what comes after the last x does not count
        stop = 1 + int(np.argmax(x >= self.x[-1])) if x.max() >= self.x[-1] else len(x)
        x, y = x[:stop], y[:stop]
        if not np.all(np.diff(x) > 0.0):
            raise UelError(
                f"{job}: {self.columns[0]} does not rise from increment to increment: expected a column that does, "
                "such as time"
            )
        # the end of a step is rounded
        if x[-1] < self.x[-1] - 1e-6 * abs(self.x[-1]):
            raise UelError(
                f"{job}: the run ends at {self.columns[0]} = {x[-1]:.6g}, the measured curve at {self.x[-1]:.6g}"
            )
        return np.asarray(np.interp(self.x, x, y))


@dataclass(frozen=True, slots=True)
class Points:
    """Points of a file.

    values   (n, 2)
    columns  what they are in the results of a run
    sources  where each point is
    """

    values: FloatArray
    columns: tuple[Column, Column]
    sources: Sequence[Source]


def read_points(path: Path, x: str | None, y: str | None) -> Points:
    """Read points from a CSV file: a line of two names, then lines of two numbers.

    Parameters
    ----------
    path
        The file.
    x, y
        Columns of the results that correspond to its columns; None: the names in the file.

    Raises
    ------
    UsageError
        The file cannot be read, or a column has no such name.
    DeckError
        With file:line where a line is not as expected.
    """
    rows: list[list[float]] = []
    sources: list[Source] = []
    names: list[str] = []
    for source, words in read_cells(path, str(path)):
        if len(words) != 2:
            raise DeckError(source, f"expected two columns, found {len(words)}")
        if not names:
            names = words
        else:
            rows.append(_numbers(source, words))
            sources.append(source)
    if len(rows) < 3:
        raise DeckError(Source(str(path), 1), f"expected a line of two names and at least 3 points, found {len(rows)}")
    return Points(np.array(rows), (read_column(x or names[0]), read_column(y or names[1])), sources)


def measured_curve(points: Points) -> Measurement:
    """Return points as a curve over a column of the history. Raises DeckError where x does not rise."""
    x, y = points.values.T
    for before, after, source in zip(x[:-1], x[1:], points.sources[1:], strict=True):
        if not after > before:
            raise DeckError(source, f"{points.columns[0]} has to rise: {after:g} after {before:g}")
    return Measurement(x, y, points.columns)


def _numbers(source: Source, words: list[str]) -> list[float]:
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        raise DeckError(source, f"expected two numbers, found '{', '.join(words)}'") from None
    if not all(map(math.isfinite, numbers)):
        raise DeckError(source, f"expected finite numbers, found '{', '.join(words)}'")
    return numbers
