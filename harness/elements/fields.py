# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fields of equilibrium: degrees of freedom that Abaqus checks together."""

from __future__ import annotations

from typing import Final

FIELD_NAMES: Final = ("force", "moment", "pore", "electrical", "temperature")
"""Names of the fields; their numbers index the arrays by field."""


def field_of(dof: int) -> int:
    """Field of a degree of freedom: 1-3 force, 4-7 moment, 8 pore pressure, 9 electrical, 11 and up temperature.

    Parameters
    ----------
    dof
        As Abaqus numbers it.

    Returns
    -------
    int
        Index into FIELD_NAMES.
    """
    for last, field in ((3, 0), (7, 1), (8, 2), (9, 3)):
        if dof <= last:
            return field
    return 4
