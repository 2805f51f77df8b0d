# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fields of equilibrium: degrees of freedom whose residuals Abaqus checks together."""

from __future__ import annotations

from typing import Final

from uel.model.contact import CONTACT
from uel.model.couplings import COUPLING
from uel.model.dofs import (
    CONCENTRATION,
    COUPLED,
    DISPLACEMENTS,
    MULTIPLIER,
    PORE_PRESSURE,
    POTENTIAL,
    PRESSURE,
    WARPING,
    dof_in_deck,
)

FIELD_NAMES: Final = (
    *("force", "moment", "pore", "electrical", "temperature", "concentration"),
    *(VOLUME := "volume", CONTACT, COUPLING),
)
"""Names of the fields; their numbers index the arrays by field."""

REFERENCE: Final = -1
"""Local node number that stands for the reference node of the section of an element."""

_LAST: Final = (
    (DISPLACEMENTS[-1], FIELD_NAMES.index("force")),
    (WARPING, FIELD_NAMES.index("moment")),
    (PORE_PRESSURE, FIELD_NAMES.index("pore")),
    (POTENTIAL, FIELD_NAMES.index("electrical")),
    (PRESSURE - 1, FIELD_NAMES.index("temperature")),
    (MULTIPLIER - 1, FIELD_NAMES.index(VOLUME)),
    (COUPLED - 1, FIELD_NAMES.index(CONTACT)),
)
"""Last dof of each field, in ascending order."""


def field_of(dof: int) -> int:
    """Return the field of a degree of freedom: 1-3 force, 4-7 moment, 8 pore pressure, 9 electrical, 11 to 30
    temperature, CONCENTRATION concentration.

    Unknowns that belong to no node: pressures of hybrid elements are in the field volume, multipliers of contact points
    in contact, those of distributing couplings in coupling.

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
        return FIELD_NAMES.index("concentration")
    dof = dof_in_deck(dof)
    return next((field for last, field in _LAST if dof <= last), FIELD_NAMES.index(COUPLING))
