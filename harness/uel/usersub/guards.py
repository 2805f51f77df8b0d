# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Values in memory that a user element must not read: guards around its arrays, RHS and AMATRX on entry."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Final

import numpy as np

from uel.model.arrays import FloatArray
from uel.usersub import _binding

UNSET: Final = "UNSET"
"""Name of what RHS and AMATRX hold before each call."""

ARRAYS: Final = _binding.ARRAYS
"""Names of the arrays with guards."""


AS_GOOD_AS_ZERO: Final = 1e-300
"""Value of a guard if reading it is tolerated; a zero written there is still noticed."""


def set_guard_values(values: Mapping[str, float]) -> FloatArray:
    """Set other values of guards until the enclosing `guard_values` ends; return the former ones.

    values: by name, one of ARRAYS for the guards around that array, or UNSET; others are unchanged. The former values
    are in the order of ARRAYS, then UNSET. Raises ValueError for an unknown name, with all values unchanged.
    """
    names = [*ARRAYS, UNSET]
    positions = {names.index(name): value for name, value in values.items()}
    # exchanging any value returns the present one
    before = np.zeros(len(names))
    _binding.exchange_guard_values(before)
    chosen = before.copy()
    chosen[list(positions)] = list(positions.values())
    _binding.exchange_guard_values(chosen)
    return before


@contextmanager
def room(entries: int) -> Iterator[None]:
    """Lengthen the guard after each array, so that a write far beyond one does not reach the next.

    Parameters
    ----------
    entries
        Fewest entries of such a guard within the context. By default a guard has the size of its array, but at least
        100 and at most 20,000 entries.
    """
    before = _binding.exchange_room(entries)
    try:
        yield
    finally:
        _binding.exchange_room(before)


@contextmanager
def guard_values(values: Mapping[str, float]) -> Iterator[None]:
    """Set other values of guards within the context, by name as in `set_guard_values`.

    A guard detects a write only if it changes the bits of the guard.
    """
    before = set_guard_values(values)
    try:
        yield
    finally:
        _binding.exchange_guard_values(before)
