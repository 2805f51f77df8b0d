# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Keyword blocks of the project's elements, from the layout that is compiled into them."""

from __future__ import annotations

from collections.abc import Mapping

from uel.delamination.keywords import captions, keyword, wrapped
from uel.elements.interfaces.neighbour_solids import formulation_of
from uel.model.element_types import BUILT_IN, ContinuumType
from uel.usersub.layout import element_layouts


def user_element(jtype: int, **options: str | int) -> list[str]:
    """Write *USER ELEMENT of an element type, with UNSYMM where necessary and further options."""
    layout = element_layouts()[jtype]
    counts: dict[str, str | int] = {"TYPE": f"U{jtype}", "NODES": layout.nodes, "COORDINATES": layout.dimension}
    counts |= {"PROPERTIES": len(layout.reals), "I_PROPERTIES": len(layout.integers), "VARIABLES": layout.svars}
    flags = ["UNSYMM"] if layout.unsymmetric else []
    return [keyword("USER ELEMENT", *flags, **counts, **options), ", ".join("123"[: layout.dimension])]


def uel_property(jtype: int, elset: str, values: Mapping[str, float], **options: str) -> list[str]:
    """Write *UEL PROPERTY with properties by name, 0 by default; those of other element types are ignored.

    Integers follow the reals on the same lines, eight per line, with their names in comments.
    """
    layout = element_layouts()[jtype]
    names = [item.name for item in (*layout.reals, *layout.integers)]
    reals = [float(values.get(item.name, 0.0)) for item in layout.reals]
    integers = [int(values.get(item.name, 0)) for item in layout.integers]
    return [*captions(names), keyword("UEL PROPERTY", ELSET=elset, **options), *wrapped([*reals, *integers])]


def formulations(solids: str) -> dict[str, float]:
    """Return FORMULATION BOTTOM and TOP of an element between built-in solids of a type."""
    kind = BUILT_IN[solids]
    number = float(formulation_of(kind)) if isinstance(kind, ContinuumType) else 0.0
    return {f"FORMULATION {side}": number for side in ("BOTTOM", "TOP")}


def state_labels(jtype: int, *names: str) -> list[str]:
    """SDV labels of variables of the first integration point of an element type, by name."""
    return [f"SDV{item.position}" for item in element_layouts()[jtype].variables if item.name in names]
