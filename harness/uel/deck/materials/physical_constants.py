# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*PHYSICAL CONSTANTS."""

from __future__ import annotations

from collections.abc import Iterable

from uel.deck.language.blocks import Block
from uel.deck.language.table import Keyword, Kind, Option, Where, ignored
from uel.model.model import PhysicalConstants


def read_physical_constants(blocks: Iterable[Block]) -> PhysicalConstants:
    """Return the constants of the last *PHYSICAL CONSTANTS, or the defaults without one. Raises DeckError."""
    found = PhysicalConstants()
    for block in blocks:
        if block.name != "PHYSICAL CONSTANTS":
            continue
        found = PhysicalConstants(block.options.real("ABSOLUTE ZERO", 0.0), block.options.real("STEFAN BOLTZMANN", 0.0))
        if found.stefan_boltzmann < 0:
            raise block.error(f"STEFAN BOLTZMANN={found.stefan_boltzmann:g} must not be negative")
    return found


KEYWORDS = (
    Keyword(
        "PHYSICAL CONSTANTS",
        "Constants that *RADIATE, *SRADIATE and *CRADIATE, and *KAPPA, need.",
        Where.MODEL,
        (
            Option("ABSOLUTE ZERO", Kind.REAL, "on the scale of the temperatures (0)"),
            Option("STEFAN BOLTZMANN", Kind.REAL, "constant of radiation"),
            *ignored("UNIVERSAL GAS CONSTANT", "LIGHT SPEED", "SPL REFERENCE PRESSURE"),
        ),
    ),
)
