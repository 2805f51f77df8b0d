# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Double cantilever beams in space: decks, and variables of the interface at its points in rows and columns."""

from __future__ import annotations

import numpy as np

from uel.delamination.keywords import text
from uel.delamination.plate_specimens import dcb_deck
from uel.delamination.plates import AROUND, Laminate
from uel.model.arrays import FloatArray

Field = dict[str, FloatArray]
"""Variables of the interface by name, at the points in rows and columns."""


def opened(title: str, laminate: Laminate, opening: float, every: int) -> str:
    """Write the deck of a specimen opened by `opening` (mm), which is the step time, in at least 20 increments."""
    static = (0.005 * opening, opening, 1.0e-10, 0.05 * opening)
    return text(dcb_deck(title, laminate, opening / 2, static, every=every))


def field(profile: Field, rows: int) -> Field:
    """Arrange the columns of a profile at the points in rows and columns (2 rows, n/(2 rows)).

    Parameters
    ----------
    profile
        Variables (n,) of the points by name, four points of a face after the other.
    rows
        Number of faces across.
    """
    grid = {}
    for name, column in profile.items():
        points = column.reshape(rows, -1, len(AROUND))
        values = np.empty((2 * rows, 2 * points.shape[1]))
        for k, (j, i) in enumerate(AROUND):
            values[j::2, i::2] = points[..., k]
        grid[name] = values
    return grid


def restricted(finer: Field, factor: int) -> Field:
    """Return the means over the shares of the points of the mesh that is not cut."""
    return {
        name: values.reshape(len(values) // factor, factor, -1, factor).mean(axis=(1, 3))
        for name, values in finer.items()
    }
