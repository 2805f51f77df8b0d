# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of the degrees of freedom: those of Abaqus, and others for unknowns that a deck cannot name."""

from __future__ import annotations

from typing import Final

DISPLACEMENTS: Final = range(1, 4)
"""Displacements of a node."""

ROTATIONS: Final = range(4, 7)
"""Rotations of a node."""

WARPING: Final = 7
"""Warping of a beam."""

PORE_PRESSURE: Final = 8
"""Pore pressure."""

POTENTIAL: Final = 9
"""Electrical potential."""

TEMPERATURE: Final = 11
"""First of the dofs that are temperatures."""

LAST_TEMPERATURE: Final = 30
"""Last of the dofs that are temperatures."""

CONCENTRATION: Final = 31
"""Normalized concentration, in a deck dof 11, which is a temperature elsewhere."""

FIRST_LOCAL: Final = 40
"""Local displacements and rotations of nodes with *TRANSFORM are the dofs FIRST_LOCAL + 1 to FIRST_LOCAL + 6."""

PRESSURE: Final = 101
"""First pressure of hybrid elements among the unknowns of an element: more than any dof of a node."""

MULTIPLIER: Final = 201
"""Multiplier of a contact point among the unknowns of its pair."""

COUPLED: Final = 301
"""First multiplier of a distributing coupling among the unknowns of its pairs of nodes."""


def is_local(dof: int) -> bool:
    """Return whether a dof is along a direction of *TRANSFORM."""
    return FIRST_LOCAL < dof <= FIRST_LOCAL + ROTATIONS[-1]


def dof_in_deck(dof: int) -> int:
    """Return the dof as the deck numbers it."""
    if dof == CONCENTRATION:
        return TEMPERATURE
    return dof - FIRST_LOCAL if is_local(dof) else dof
