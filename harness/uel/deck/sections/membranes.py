# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*MEMBRANE SECTION."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from uel.deck.language.blocks import Block
from uel.deck.language.definitions import named
from uel.deck.language.table import Keyword, Kind, Option, Where, refused
from uel.deck.sections.shells import surface_material
from uel.model.properties import Material, MembraneSection, Orientation, SectionControls

MEMBRANE_KEYWORD: Final = "MEMBRANE SECTION"

_INCOMPRESSIBLE: Final = 0.5


def read_membrane_section(
    block: Block,
    materials: Mapping[str, Material],
    orientations: Mapping[str, Orientation],
    controls: SectionControls,
) -> MembraneSection:
    """Read the section of membranes. Raises DeckError."""
    material = surface_material(block, block.options.text("MATERIAL"), materials)
    orientation = named(block, "ORIENTATION", orientations)
    poisson = block.options.real("POISSON", _INCOMPRESSIBLE)
    if not -1 <= poisson <= _INCOMPRESSIBLE:
        raise block.error(f"POISSON={poisson:g}: expected a number from -1 to {_INCOMPRESSIBLE:g}")
    row = block.required_row("the thickness")
    row.at_most(1)
    thickness = row.positive(0, "thickness")
    return MembraneSection(
        block.options.text("ELSET"), material, orientation, thickness, poisson, block.source, controls
    )


KEYWORDS = (
    Keyword(
        "MEMBRANE SECTION",
        "Section of membranes. Directions are those of *SHELL SECTION, and turn with the surface under NLGEOM; there "
        "the thickness changes by -nu/(1 - nu) times the logarithmic strain of the area, nu being POISSON.",
        Where.MODEL,
        (
            Option("ELSET", Kind.NAME, "element set", required=True),
            Option("MATERIAL", Kind.NAME, "material", required=True),
            Option("CONTROLS", Kind.NAME, "section controls"),
            Option("ORIENTATION", Kind.NAME, "orientation of the section"),
            Option("POISSON", Kind.REAL, "Poisson's ratio of the thickness under NLGEOM (0.5)"),
            *refused("DENSITY", "MEMBRANE THICKNESS", "NODAL THICKNESS"),
        ),
        "thickness",
    ),
)
