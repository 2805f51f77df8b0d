# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Traction of the initial stress of the solids at each face of the new elements."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.steps.initial import read_initial_stresses
from uel.elements.interfaces.initial_tractions import NAMES, PLANE_NAMES, InitialStresses, components
from uel.errors import DeckError
from uel.insertion.assembly import Deck
from uel.insertion.directions import Pair
from uel.insertion.sections import Faces, Sections
from uel.model.arrays import FloatArray
from uel.model.element_types import BUILT_IN, ContinuumType
from uel.model.properties import SolidSection

_DIGITS = 9
"""Digits of the largest traction to which others are alike: those of faces of one direction differ by rounding."""
_BALANCED = 1e-6
"""Difference of the tractions on both sides, as a share of the largest stress, that is rounding of a deck."""


class InitialTractions:
    """Tractions of the initial stresses of a deck."""

    def __init__(self, deck: Deck, sections: Sections) -> None:
        problems = Problems()
        self._deck = deck
        self._sections = sections
        # a part has one set of properties: `uel run` refuses instances that differ
        self._entries = [
            replace(entry, elements=deck.element_of[entry.elements])
            for entry in read_initial_stresses(deck.structure.root, deck.flat, problems)
        ]
        self._flat = deck.solids.cells[0].family.dimension == 2
        problems.check()

    @property
    def names(self) -> tuple[str, ...]:
        """Properties that have the values of `at`."""
        return PLANE_NAMES if self._flat else NAMES

    def at(self, sides: Pair) -> FloatArray:
        """Return the tractions (faces, 3 or 2) at faces below and above.

        Raises DeckError where the two differ, or those of one side are not known.
        """
        below, above = (self._of_side(faces) for faces in sides)
        apart = np.linalg.norm(above - below, axis=1)
        largest = max(np.linalg.norm(each, axis=1).max(initial=0.0) for each in (below, above))
        row = int(apart.argmax())
        if apart[row] > _BALANCED * largest:
            first, second = (self._sections.name(faces, row) for faces in sides)
            values = " and ".join(f"({', '.join(f'{value:g}' for value in each[row])})" for each in (below, above))
            raise DeckError(
                self._entries[0].source,
                f"the initial stresses of elements {first} and {second} have the tractions {values} on the interface "
                "between them; expected the same on both sides, as in equilibrium",
            )
        found = components(below, sides[0].normals, None if self._flat else sides[0].directions)
        size = abs(found).max(initial=0.0)
        return np.asarray(np.round(found / size, _DIGITS) * size + 0.0) if size else found

    def _of_side(self, faces: Faces) -> FloatArray:
        """Return the tractions (k, 3) along x, y and z."""
        deck, sections = self._deck, self._sections
        tractions = np.zeros((len(faces.numbers), 3))
        for number, type, rows in sections.kinds(faces.numbers):
            part = faces.take(rows)
            kind = BUILT_IN.get(type.name)
            tensor = kind.tensor if isinstance(kind, ContinuumType) else None
            stresses = InitialStresses.of(self._entries, deck.positions[deck.solids.element[part.numbers]], tensor)
            if stresses.source is None:
                continue
            section = sections.section(number, type) if number >= 0 else "it has no section"
            if not isinstance(section, SolidSection):
                reason = section if isinstance(section, str) else "its directions vary from layer to layer"
                name = sections.name(part, 0)
                raise DeckError(
                    stresses.source, f"the traction of the initial stress of element {name} is not known: {reason}"
                )
            axes = sections.stress_axes(number, section, part)
            tractions[rows] = stresses.tractions(axes, part.normals)
        return tractions
