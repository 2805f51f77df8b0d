# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Faults in a pass over a block of elements, and how they are handled (fortran/host/driver/driver.f90)."""

from __future__ import annotations

from enum import IntEnum


class Guards(IntEnum):
    """Effect on a pass of a write outside an array."""

    STOP = 0
    NOTICE = 1
    SEARCH = 2
    IGNORE = 3


class Entries(IntEnum):
    """Effect on a pass of an entry of RHS or AMATRX that is not set."""

    STOP = 0
    NOTICE = 1
    ZERO = 2


class Fault(IntEnum):
    """Fault in a pass over a block."""

    NONE = 0
    LEFT = 1
    OUTSIDE = 2
    UNSET = 3
    NOT_FINITE = 4
    ENDLESS = 5
    DISTORTED = 6
