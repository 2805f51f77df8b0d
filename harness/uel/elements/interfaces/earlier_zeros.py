# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks from before zeros meant the recommended element: properties of U4, U6, U8 and U12 that then meant the paper's.

Such a deck has VARIABLES without room for beta and gamma, which came with the new meaning, and no value that was
refused before.
"""

from __future__ import annotations

from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.properties import UserProperty
from uel.usersub import Library
from uel.usersub.layout import element_layouts


def warn_of_earlier_zeros(model: Model, library: Library) -> None:
    """Warn once of the first elements whose zeros probably have their earlier meaning."""
    for group in model.groups if library.is_own else ():
        if text := _warning(group):
            library.warn(text)
            return


def _warning(group: ElementGroup) -> str:
    """Return what to write instead; '' if the zeros have their present meaning."""
    definition, section = group.definition, group.section
    layout = element_layouts().get(definition.number) if definition is not None else None
    if definition is None or layout is None or not layout.own or not isinstance(section, UserProperty):
        return ""
    if definition.variables >= layout.svars:
        return ""
    given = {
        item.name: float(values[item.position - 1])
        for items, values in ((layout.reals, section.values), (layout.integers, section.integers))
        for item in items
        if item.position <= len(values)
    }
    closure, betas = given.get("CLOSURE", 0.0), {name: given.get(name, 0.0) for name in ("BETAN", "BETAT")}
    consistent = not given.get("ALPHAN") or given.get("FRICTION")
    if not given.get("LAW") or closure == 2.0 or -2.0 in betas.values() or (closure == 0.0 and consistent):
        return ""  # was refused
    ways = [] if closure else ["CLOSURE = 2 for the paper's law (0 is the consistent law now)"]
    zeros = [name for name, value in betas.items() if value == 0.0]
    if zeros and -1.0 not in betas.values():
        ways.append(f"{' = '.join(zeros)} = -2 for equation (21) (0 is the local eigenvalues now)")
    if not ways:
        return ""
    return (
        f"{section.source}: {group.type} with VARIABLES={definition.variables} is from before zeros meant the "
        f"recommended element: write {' and '.join(ways)}; or VARIABLES={layout.svars} if the deck is to take what "
        "zeros mean now"
    )
