# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*EXPANSION: thermal expansion of a material."""

from __future__ import annotations

from typing import Final

import numpy as np

from uel.deck.language.blocks import Block
from uel.deck.language.table import Keyword, Kind, Option, Where, one_of, refused
from uel.model.properties import Expansion

COUNTS: Final = {"ISO": 1, "ORTHO": 3, "ANISO": 6}
"""Coefficients of each TYPE."""


def read_expansion(block: Block) -> Expansion:
    """Read the expansion coefficients by temperature. Raises DeckError."""
    kind = block.options.text("TYPE")
    count = COUNTS[kind]
    table: list[list[float]] = []
    for row in block.required_rows("the expansion coefficients"):
        row.at_most(count + 1)
        values = [row.real(k, "expansion coefficient") for k in range(count)]
        temperature = row.real(count, "temperature", 0.0)
        if table and temperature <= table[-1][0]:
            raise row.error(f"temperature {temperature:g} is not above that of the line before, {table[-1][0]:g}")
        direct = values * 3 if kind == "ISO" else values
        table.append([temperature, *direct, *[0.0] * (6 - len(direct))])
    return Expansion(np.array(table), block.options.real("ZERO", 0.0), block.source)


KEYWORDS = (
    Keyword(
        "EXPANSION",
        "Thermal expansion of continuum elements and beams from the initial temperature on (*INITIAL CONDITIONS): by "
        "*TEMPERATURE, or by their own temperatures. Beside *HYPERELASTIC of TYPE=ISO.",
        Where.MODEL,
        (
            one_of("TYPE", "symmetry, in the directions of *ORIENTATION", tuple(COUNTS), default="ISO"),
            Option("ZERO", Kind.REAL, "temperature of no thermal strain, where coefficients depend on it (0)"),
            *refused("DEPENDENCIES", "FIELD", "PORE FLUID", "USER"),
        ),
        "coefficient, or those of 11, 22, 33, or of 11, 22, 33, 12, 13, 23 (engineering strains); temperature; linear "
        "in between",
    ),
)
