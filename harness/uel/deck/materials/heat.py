# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Options of *MATERIAL for heat: *CONDUCTIVITY, *SPECIFIC HEAT, *LATENT HEAT and *HEAT GENERATION."""

from __future__ import annotations

import numpy as np

from uel.deck.language.blocks import Block
from uel.deck.language.table import Keyword, Where, one_of, refused
from uel.model.arrays import FloatArray


def read_by_temperature(block: Block, quantity: str) -> FloatArray:
    """Read rows (k, 2) of a positive value and the temperature, which ascends. Raises DeckError."""
    table: list[tuple[float, float]] = []
    for row in block.required_rows(f"the {quantity}"):
        row.at_most(2)
        table.append((row.positive(0, quantity), row.real(1, "temperature", 0.0)))
        if len(table) > 1 and table[-1][1] <= table[-2][1]:
            raise row.error(f"temperature {table[-1][1]:g} is not above that of the line before, {table[-2][1]:g}")
    return np.array(table)


def read_latent_heat(block: Block) -> FloatArray:
    """Read rows (k, 3) of the latent heat, the solidus and the liquidus temperature above it. Raises DeckError."""
    table = []
    for row in block.required_rows("the latent heat, the solidus and the liquidus temperature"):
        row.at_most(3)
        values = [row.positive(0, "latent heat"), row.real(1, "solidus"), row.real(2, "liquidus")]
        if values[2] <= values[1]:
            raise row.error(f"liquidus {values[2]:g} is not above the solidus, {values[1]:g}")
        table.append(values)
    return np.array(table)


KEYWORDS = (
    Keyword(
        "CONDUCTIVITY",
        "Thermal conductivity.",
        Where.MODEL,
        (one_of("TYPE", "symmetry", ("ISO",), refused=("ORTHO", "ANISO")), *refused("DEPENDENCIES", "PORE FLUID")),
        "conductivity, temperature; linear in between",
    ),
    Keyword("HEAT GENERATION", "HETVAL gives the heat that the material generates.", Where.MODEL),
    Keyword(
        "LATENT HEAT",
        "Heat that melting takes, evenly between two temperatures.",
        Where.MODEL,
        data="latent heat per mass, solidus temperature, liquidus temperature",
    ),
    Keyword(
        "SPECIFIC HEAT",
        "Specific heat per mass; that at the end of an increment holds for all of it, as in Abaqus.",
        Where.MODEL,
        refused("DEPENDENCIES", "PORE FLUID"),
        "specific heat, temperature; linear in between",
    ),
)
