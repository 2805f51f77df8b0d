# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Overconstraints: prescribed values of unknowns that constraints determine too.

Abaqus warns of zero pivots and continues. A step here continues while both values agree; the reaction of such a value
is the whole force there.
"""

from __future__ import annotations

from collections.abc import Iterator

from uel.assembly import Constraints
from uel.model.records import Warned

OVERCONSTRAINED = (
    "OVERCONSTRAINT: NODE {}, DOF {} IS PRESCRIBED{}, AND THE CONSTRAINT AT {} GIVES IT A VALUE TOO. THE RUN GOES ON "
    "WHILE BOTH ARE THE SAME"
)
OTHERS = ", LIKE {} MORE UNKNOWNS"


def warn_overconstrained(constraints: Constraints) -> Iterator[Warned]:
    """Yield one warning of all overconstraints of a step."""
    overconstraints = constraints.overconstraints
    if overconstraints:
        unknown, source = overconstraints[0]
        others = OTHERS.format(len(overconstraints) - 1) if len(overconstraints) > 1 else ""
        yield Warned(OVERCONSTRAINED.format(*constraints.name(unknown), others, source))
