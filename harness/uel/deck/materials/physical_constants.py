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
    constants = PhysicalConstants()
    for block in (block for block in blocks if block.name == "PHYSICAL CONSTANTS"):
        zero, radiation = block.options.real("ABSOLUTE ZERO", 0.0), block.not_negative("STEFAN BOLTZMANN", 0.0)
        constants = PhysicalConstants(zero, radiation)
    return constants


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
