# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Ties between equal values: a message names the same one on every processor, whatever the last bits are."""

from __future__ import annotations

from typing import Final

import numpy as np

from uel.model.arrays import FloatArray

EQUAL: Final = 1e-6
"""Relative difference up to which two values are equal."""


def exceeds(value: float, largest: float) -> bool:
    """Report whether a value exceeds the largest one so far by more than rounding."""
    return value > (1.0 + EQUAL) * largest


def first_largest(values: FloatArray) -> int:
    """Return the index, in the flattened array, of the first of the largest values (none of them negative)."""
    flat = values.ravel()
    return int(np.argmax(flat >= (1.0 - EQUAL) * flat.max()))


def ranked(values: FloatArray) -> list[int]:
    """Return the indices of values (n,), the largest first; equal ones in their order."""
    remaining, ranking = np.argsort(-values, kind="stable").tolist(), []
    while remaining:
        same = [index for index in remaining if values[index] >= (1.0 - EQUAL) * values[remaining[0]]]
        ranking += sorted(same)
        remaining = remaining[len(same) :]
    return ranking
