# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What memory holds that a user element has not to look at: the guards around its arrays, RHS and AMATRX on entry."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Final

import numpy as np

from harness.usersub import _binding

UNSET: Final = "UNSET"
"""Name of what RHS and AMATRX hold before each call."""

ARRAYS: Final = _binding.ARRAYS
"""Names of the arrays with guards."""


AS_GOOD_AS_ZERO: Final = 1e-300
"""What a guard holds where reading it is tolerated; a zero that is written there is still noticed."""


def set_guard_values(values: Mapping[str, float]) -> None:
    """Let guards hold other values until the `guard_values` around the call ends."""
    held = np.zeros(len(ARRAYS) + 1)
    _binding.exchange_guard_values(held)
    for name, value in values.items():
        held[[*ARRAYS, UNSET].index(name)] = value
    _binding.exchange_guard_values(held)


@contextmanager
def room(entries: int) -> Iterator[None]:
    """Let the guard behind each array have so many entries, so that a write far beyond one does not reach the next."""
    before = _binding.exchange_room(entries)
    try:
        yield
    finally:
        _binding.exchange_room(before)


@contextmanager
def guard_values(values: Mapping[str, float]) -> Iterator[None]:
    """Let guards of some arrays (by their names in ARRAYS), or UNSET, hold other values, and give back what they held.

    A guard reports a write only where it changes the bits of the guard.
    """
    names = [*ARRAYS, UNSET]
    # an exchange with anything tells what is there
    held = np.zeros(len(names))
    _binding.exchange_guard_values(held)
    chosen = held.copy()
    for name, value in values.items():
        chosen[names.index(name)] = value
    _binding.exchange_guard_values(chosen)
    try:
        yield
    finally:
        _binding.exchange_guard_values(held)
