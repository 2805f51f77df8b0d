# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Options of *MATERIAL for heat: *CONDUCTIVITY, *SPECIFIC HEAT, *LATENT HEAT and *HEAT GENERATION."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uel.deck.language.blocks import Block
from uel.deck.language.table import Keyword, Where, one_of, refused
from uel.model.arrays import FloatArray
from uel.model.properties import Material


def extend_heat(material: Material, block: Block) -> Material:
    """Return the material extended by one of these options. Raises DeckError."""
    match block.name:
        case "CONDUCTIVITY":
            return replace(material, conductivity=read_by_temperature(block, "conductivity"))
        case "SPECIFIC HEAT":
            return replace(material, specific_heat=read_by_temperature(block, "specific heat"))
        case "LATENT HEAT":
            return replace(material, latent_heat=_read_latent_heat(block))
        case _:
            return replace(material, heat_generation=block.source)


def read_by_temperature(block: Block, what: str) -> FloatArray:
    """Read rows (k, 2) of a positive value and the temperature, which ascends. Raises DeckError."""
    table: list[tuple[float, float]] = []
    for row in block.rows():
        row.at_most(2)
        table.append((row.real(0, what), row.real(1, "temperature", 0.0)))
        if table[-1][0] <= 0:
            raise row.error(f"{what} {table[-1][0]:g} must be positive")
        if len(table) > 1 and table[-1][1] <= table[-2][1]:
            raise row.error(f"temperature {table[-1][1]:g} is not above that of the line before, {table[-2][1]:g}")
    if not table:
        raise block.error(f"needs a data line with the {what}")
    return np.array(table)


def _read_latent_heat(block: Block) -> FloatArray:
    """Read rows (k, 3) of the latent heat, the solidus and the liquidus temperature above it. Raises DeckError."""
    table = []
    for row in block.rows():
        row.at_most(3)
        values = [row.real(k, what) for k, what in enumerate(("latent heat", "solidus", "liquidus"))]
        if values[0] <= 0:
            raise row.error(f"latent heat {values[0]:g} must be positive")
        if values[2] <= values[1]:
            raise row.error(f"liquidus {values[2]:g} is not above the solidus, {values[1]:g}")
        table.append(values)
    if not table:
        raise block.error("needs a data line with the latent heat, the solidus and the liquidus temperature")
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
