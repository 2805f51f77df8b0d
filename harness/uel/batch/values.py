# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Values that a user gives to the parameters of a deck."""

from __future__ import annotations

import math


def value_of(text: str) -> float:
    """Convert a text to a number, whole where it is written so; ValueError if it is none, or not finite."""
    if "_" in text:
        raise ValueError
    try:
        return int(text)
    except ValueError:
        value = float(text)
    if not math.isfinite(value):
        raise ValueError
    return value
