# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Content of memory that a user element must not read: the guards around its arrays, RHS and AMATRX on entry."""

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
    """Let guards hold other values until the `guard_values` around the call ends.

    Parameters
    ----------
    values
        New values by name: one of ARRAYS for the guards around that array, or UNSET. The others keep theirs.

    Returns
    -------
    FloatArray
        Their old values, in the order of ARRAYS, then UNSET.

    Raises
    ------
    ValueError
        A name is unknown; all guards keep their values.
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
        Fewest entries of such a guard within the context. By itself a guard has as many as its array, but at least 100
        and at most 20,000.
    """
    before = _binding.exchange_room(entries)
    try:
        yield
    finally:
        _binding.exchange_room(before)


@contextmanager
def guard_values(values: Mapping[str, float]) -> Iterator[None]:
    """Let guards hold other values, then restore the old ones.

    A guard reports a write only where it changes the bits of the guard.

    Parameters
    ----------
    values
        As in `set_guard_values`.
    """
    before = set_guard_values(values)
    try:
        yield
    finally:
        _binding.exchange_guard_values(before)
