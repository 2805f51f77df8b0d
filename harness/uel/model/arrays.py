# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Array types used in signatures, and the choice among equal entries."""

import math

import numpy as np
from numpy.typing import NDArray

IntArray = NDArray[np.int64]
FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_EQUAL = 1e-6
"""Entries that differ by this part of the largest magnitude are equal: rounding, which depends on the processor."""


def flat_rows(values: FloatArray) -> FloatArray:
    """Return the values of each row one after the other, (m, k) of (m, ...); m may be 0."""
    return values.reshape(len(values), math.prod(values.shape[1:]))


def first_largest(values: FloatArray) -> IntArray:
    """Return the index of the largest entry along the first axis; of equal ones, the first, on every processor.

    An entry that is not finite counts as the largest.
    """
    finite = np.isfinite(values)
    with np.errstate(invalid="ignore"):
        near = values >= values.max(axis=0) - _EQUAL * np.abs(values).max(axis=0)
    return np.asarray(np.argmax(np.where(finite.all(axis=0), near, ~finite), axis=0))
