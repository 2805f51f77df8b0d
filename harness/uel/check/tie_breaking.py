# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Ties between values equal up to round-off: messages name the same one on every processor."""

from __future__ import annotations

from typing import Final

import numpy as np

from uel.model.arrays import FloatArray

EQUAL: Final = 1e-6
"""Relative difference up to which two values are equal."""


def exceeds(value: float, largest: float) -> bool:
    """Return whether a value exceeds the largest so far by more than round-off."""
    return value > (1.0 + EQUAL) * largest


def first_largest(values: FloatArray) -> int:
    """Return the index, in the flattened array, of the first of the largest values (none of them negative)."""
    flat = values.ravel()
    return int(np.argmax(flat >= (1.0 - EQUAL) * flat.max()))


def ranked(values: FloatArray) -> list[int]:
    """Return the indices of values (n,) in descending order, stable for equal ones."""
    remaining, ranking = np.argsort(-values, kind="stable").tolist(), []
    while remaining:
        same = [index for index in remaining if values[index] >= (1.0 - EQUAL) * values[remaining[0]]]
        ranking += sorted(same)
        remaining = remaining[len(same) :]
    return ranking
