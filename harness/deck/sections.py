# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*SOLID SECTION and *UEL PROPERTY, made for the element type they are used with."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from harness.deck.blocks import Block
from harness.deck.catalogue import look_up
from harness.deck.numbers import LARGEST_INTEGER
from harness.deck.problems import Problems
from harness.deck.user_elements import ElementType
from harness.errors import DeckError
from harness.model.properties import Material, Orientation, SolidSection, UserElement, UserProperty

ENTRIES = 8
"""Entries of a data line."""

SECTION_KEYWORDS = {"SOLID SECTION", "UEL PROPERTY"}


def make_section(
    block: Block,
    kind: ElementType,
    materials: Mapping[str, Material],
    orientations: Mapping[str, Orientation],
    problems: Problems,
) -> SolidSection | UserProperty:
    """The section a keyword gives to elements of a type; DeckError where the two do not go together."""
    options = block.options
    elset = options.text("ELSET")
    wanted = "UEL PROPERTY" if kind.definition else "SOLID SECTION"
    if block.name != wanted:
        raise block.error(f"element set {elset} holds elements of type {kind.name}, which take *{wanted}")
    name = options.text("MATERIAL")
    material = look_up(materials, name, "material", block.source) if name else None
    name = options.text("ORIENTATION")
    orientation = look_up(orientations, name, "orientation", block.source) if name else None
    if kind.definition:
        return _user_property(block, kind.definition, material, orientation, problems)
    assert material is not None
    if material.elastic is None and material.user is None:
        raise block.error(f"material {material.name} has no *ELASTIC and no *USER MATERIAL")
    return SolidSection(elset, material, orientation, _thickness(block), block.source)


def _thickness(block: Block) -> float:
    rows = list(block.rows())
    thickness = rows[0].real(0, "thickness", 1.0) if rows else 1.0
    if thickness == 0:
        return 1.0
    if thickness < 0:
        raise rows[0].error(f"thickness {thickness:g} must be positive")
    return thickness


def _user_property(
    block: Block,
    definition: UserElement,
    material: Material | None,
    orientation: Orientation | None,
    problems: Problems,
) -> UserProperty:
    rows = list(block.rows())
    entries = [(row, index) for row in rows for index in range(len(row))]
    reals, integers = definition.properties, definition.integer_properties
    wanted = reals + integers
    if len(entries) != wanted:
        announced = f"PROPERTIES={reals}" + (f", I PROPERTIES={integers}" if integers else "")
        message = f"{len(entries)} values where U{definition.number} takes {wanted} ({announced})"
        if len(entries) > wanted or len(rows) != math.ceil(wanted / ENTRIES):
            raise block.error(message)
        # a line has eight entries, those left out are zero
        problems.warn(block.source, f"*{block.name}: {message}; the others are zero")
        entries = [(row, index) for row in rows for index in range(ENTRIES)][:wanted]
    values = [row.real(index, f"property {index + 1}", 0.0) for row, index in entries[:reals]]
    whole = []
    for row, index in entries[reals:]:
        value = row.real(index, "integer property", 0.0)
        if value != int(value) or abs(value) > LARGEST_INTEGER:
            raise DeckError(row.source, f"*{block.name}: integer property {row.fields[index]} is not an integer")
        whole.append(int(value))
    return UserProperty(
        block.options.text("ELSET"),
        block.source,
        np.array(values, dtype=np.float64),
        np.array(whole, dtype=np.int64),
        material,
        orientation,
    )
