# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Structured mesh of two arms, one above the other, with pairs of coincident nodes at the interface.

Numbers are readable: line j of nodes counted from below and column i are node stride*j + i, row j of quads and column
i are element stride*j + i, all from 1, with a power of ten as the stride. The interface elements take the row above
the last, so that they come after the quads, and the numbers of both neighbours are a constant offset below theirs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uel.model.arrays import FloatArray, IntArray


@dataclass(frozen=True, slots=True)
class TwoArmMesh:
    """Two arms of quads in common columns.

    x            (nx+1,) abscissas of the columns' edges, ascending (mm)
    lower, upper (ny+1,) ordinates of the node lines of the two arms; lower[-1] = upper[0] is the interface
    first        column (from 0) of the first interface element, behind the crack
    bumps        (nx+1,) vertical offset of both interface lines; zero for a flat interface
    """

    x: FloatArray
    lower: FloatArray
    upper: FloatArray
    first: int
    bumps: FloatArray

    @property
    def columns(self) -> int:
        """Number of columns of quads."""
        return len(self.x) - 1

    @property
    def rows(self) -> tuple[int, int]:
        """Rows of quads of the lower and the upper arm."""
        return len(self.lower) - 1, len(self.upper) - 1

    @property
    def stride(self) -> int:
        """Increment of node and element numbers from one row to the next: a power of ten."""
        return int(10 ** np.ceil(np.log10(self.columns + 2)))

    @property
    def offsets(self) -> tuple[int, int]:
        """Numbers of the quads below and above minus the number of the interface element."""
        above = self.rows[1]
        return -(above + 1) * self.stride, -above * self.stride

    def line(self, number: int) -> IntArray:
        """Return the labels of node line `number`, from 1 at the bottom, left to right."""
        return number * self.stride + np.arange(1, self.columns + 2)

    @property
    def interface_lines(self) -> tuple[IntArray, IntArray]:
        """Labels of the interface nodes of the lower and of the upper arm."""
        return self.line(self.rows[0] + 1), self.line(self.rows[0] + 2)

    @property
    def top_line(self) -> IntArray:
        """Labels of the nodes of the upper arm's upper edge."""
        return self.line(sum(self.rows) + 2)

    def edge(self, column: int) -> IntArray:
        """Return the labels of the nodes of all lines in a column of nodes (0 left, -1 right), bottom to top."""
        return np.array([self.line(number)[column] for number in range(1, sum(self.rows) + 3)])

    def nodes(self) -> tuple[IntArray, FloatArray]:
        """Return the labels (n,) and coordinates (n, 2) of all nodes."""
        heights = np.concatenate([self.lower, self.upper])
        labels, points = [], []
        for number, height in enumerate(heights, start=1):
            y = np.full(len(self.x), height)
            if number - 1 in (self.rows[0], self.rows[0] + 1):
                y = y + self.bumps
            labels.append(self.line(number))
            points.append(np.column_stack([self.x, y]))
        return np.concatenate(labels), np.concatenate(points)

    def quads(self, arm: str) -> IntArray:
        """Return rows of element label and four nodes, counter-clockwise from lower left; arm 'lower' or 'upper'."""
        below, above = self.rows
        # the second line of the interface starts the upper arm: its rows of quads begin one line later
        rows = range(1, below + 1) if arm == "lower" else range(below + 1, below + above + 1)
        shift = 0 if arm == "lower" else 1
        blocks = []
        for row in rows:
            low, high = self.line(row + shift), self.line(row + shift + 1)
            label = row * self.stride + np.arange(1, self.columns + 1)
            blocks.append(np.column_stack([label, low[:-1], low[1:], high[1:], high[:-1]]))
        return np.concatenate(blocks)

    @property
    def interface_labels(self) -> IntArray:
        """Labels of the interface elements, left to right."""
        return (sum(self.rows) + 1) * self.stride + np.arange(self.first + 1, self.columns + 1)

    def interface4(self) -> IntArray:
        """Return rows of label and nodes of four-node interface elements: lower edge left to right, upper edge back."""
        low, high = (line[self.first :] for line in self.interface_lines)
        return np.column_stack([self.interface_labels, low[:-1], low[1:], high[1:], high[:-1]])

    def interface8(self) -> IntArray:
        """Return the rows of label and nodes of eight-node interface elements: the quad below, then the quad above."""
        below = self.quads("lower")[-self.columns :][self.first :, 1:]
        above = self.quads("upper")[: self.columns][self.first :, 1:]
        return np.column_stack([self.interface_labels, below, above])


def two_arms(x: FloatArray, height: float, rows: int, crack: float, bump: float = 0.0) -> TwoArmMesh:
    """Mesh two arms of equal height.

    Parameters
    ----------
    x
        Abscissas of the columns' edges (mm), one of them at the crack tip.
    height, rows
        Height of one arm (mm) and its number of rows of quads.
    crack
        Length of the initial crack (mm), 0 for none.
    bump
        Vertical offset of the interface nodes (mm), alternately up and down.
    """
    ordinates = np.linspace(0.0, height, rows + 1)
    first = int(np.argmin(np.abs(x - crack)))
    bumps = np.where(np.arange(len(x)) % 2 == 0, bump, -bump)
    return TwoArmMesh(x, ordinates, height + ordinates, first, bumps)


def refined(mesh: TwoArmMesh, factor: int) -> TwoArmMesh:
    """Divide every quad into factor x factor quads; the interface keeps its shape, bumps included."""
    x, lower, upper, bumps = (cut(values, factor) for values in (mesh.x, mesh.lower, mesh.upper, mesh.bumps))
    return TwoArmMesh(np.round(x, 9), lower, upper, factor * mesh.first, bumps)


def cut(values: FloatArray, factor: int, axis: int = 0) -> FloatArray:
    """Refine values at grid lines along an axis by linear interpolation, `factor` intervals in place of one."""
    last = values.shape[axis] - 1
    along = np.arange(factor * last + 1) / factor
    interval = np.minimum(along.astype(int), last - 1)
    weight = (along - interval).reshape([-1 if k == axis else 1 for k in range(values.ndim)])
    return np.asarray(values.take(interval, axis) * (1.0 - weight) + values.take(interval + 1, axis) * weight)


def graded_columns(start: float, end: float, size: float, ratio: float, largest: float) -> FloatArray:
    """Return edges from `start` to `end` (mm), in either direction, with spacing `size` growing by `ratio` to
    `largest`.

    The spacing is scaled to fit the length.
    """
    if start == end:
        return np.array([start])
    length, step = abs(end - start), size
    sizes: list[float] = []
    while sum(sizes) < length:
        step = min(step * ratio, largest)
        sizes.append(step)
    # drop the last column if that scales the others less
    if len(sizes) > 1 and sum(sizes) - length > 0.5 * sizes[-1]:
        sizes.pop()
    edges = start + np.concatenate([[0.0], np.cumsum(sizes)]) * ((end - start) / sum(sizes))
    # the sum is exact only on some processors
    edges[-1] = end
    return edges


def crack_columns(
    length: float, fine: tuple[float, float], size: float, ratio: float, largest: tuple[float, float]
) -> FloatArray:
    """Return edges from 0 to `length` (mm): spacing `size` in the interval `fine`, graded towards both ends.

    The spacing grows by `ratio` per column to the `largest` of each end.
    """
    begin, end = fine
    middle = np.linspace(begin, end, round((end - begin) / size) + 1)
    left = graded_columns(begin, 0.0, size, ratio, largest[0])[::-1]
    right = graded_columns(end, length, size, ratio, largest[1])
    edges = np.concatenate([left[:-1], middle, right[1:]])
    # rounded to the six decimals of a deck, so that the deck and the builder agree
    return np.round(edges, 6)
