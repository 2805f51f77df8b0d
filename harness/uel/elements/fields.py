# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fields of equilibrium: degrees of freedom that Abaqus checks together."""

from __future__ import annotations

from typing import Final

from uel.model.contact import CONTACT
from uel.model.couplings import COUPLING
from uel.model.model import CONCENTRATION, dof_in_deck

FIELD_NAMES: Final = (
    *("force", "moment", "pore", "electrical", "temperature", "concentration"),
    *(VOLUME := "volume", CONTACT, COUPLING),
)
"""Names of the fields; their numbers index the arrays by field."""

PRESSURE: Final = 101
"""Number of the first pressure of hybrid elements among the unknowns of an element: more than any dof of Abaqus."""

REFERENCE: Final = -1
"""Local number, among the nodes of an element, of the reference node of its section."""

MULTIPLIER: Final = 201
"""Number of the multiplier of a contact point among the unknowns of its block."""

COUPLED: Final = 301
"""Number of the first multiplier of a distributing coupling among the unknowns of its block."""


def field_of(dof: int) -> int:
    """Return the field of a degree of freedom: 1-3 force, 4-7 moment, 8 pore pressure, 9 electrical, 11 to 30
    temperature, CONCENTRATION concentration. Of unknowns that belong to no node, pressures of hybrid elements are
    volume, multipliers of contact points contact, those of distributing couplings coupling.

    Parameters
    ----------
    dof
        As Abaqus numbers it.

    Returns
    -------
    int
        Index into FIELD_NAMES.
    """
    if dof == CONCENTRATION:
        return 5
    dof = dof_in_deck(dof)
    for last, field in ((3, 0), (7, 1), (8, 2), (9, 3), (PRESSURE - 1, 4), (MULTIPLIER - 1, 6), (COUPLED - 1, 7)):
        if dof <= last:
            return field
    return 8
