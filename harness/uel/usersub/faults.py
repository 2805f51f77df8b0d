# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What goes wrong in a pass over a block of elements, and how that is handled (fortran/host/driver/driver.f90)."""

from __future__ import annotations

from enum import IntEnum


class Guards(IntEnum):
    """What a write outside an array does to a pass."""

    STOP = 0
    NOTICE = 1
    SEARCH = 2
    IGNORE = 3


class Entries(IntEnum):
    """What an entry of RHS or AMATRX that is not set does to a pass."""

    STOP = 0
    NOTICE = 1
    ZERO = 2


class Fault(IntEnum):
    """What went wrong in a pass over a block."""

    NONE = 0
    LEFT = 1
    OUTSIDE = 2
    UNSET = 3
    NOT_FINITE = 4
    ENDLESS = 5
    DISTORTED = 6
