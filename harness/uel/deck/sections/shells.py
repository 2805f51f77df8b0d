# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*SHELL SECTION, *SHELL GENERAL SECTION and *TRANSVERSE SHEAR STIFFNESS."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final, Literal

from uel.deck.error_report import look_up
from uel.deck.language.blocks import Block, Row
from uel.deck.language.definitions import named
from uel.deck.language.numbers import read_real
from uel.deck.language.table import Keyword, Kind, Option, Where, ignored, one_of, refused
from uel.model.properties import Material, Orientation, SectionControls, ShellLayer, ShellSection

SHELL_KEYWORDS: Final = ("SHELL SECTION", "SHELL GENERAL SECTION")

MOST_POINTS: Final = 250
"""Section points of a layer."""
_SIDES: Final = {"SPOS": 0.5, "SNEG": -0.5}
_DEFAULT_POINTS: Final = {("SIMPSON", False): 5, ("SIMPSON", True): 3, ("GAUSS", False): 3, ("GAUSS", True): 2}
"""Default number of section points by rule and COMPOSITE (Abaqus Keywords Guide, *SHELL SECTION)."""


def read_shell_section(
    block: Block,
    materials: Mapping[str, Material],
    orientations: Mapping[str, Orientation],
    controls: SectionControls,
) -> ShellSection:
    """Read the section of shells. Raises DeckError."""
    options, rows = block.options, list(block.rows())
    composite = options.flag("COMPOSITE")
    orientation = named(block, "ORIENTATION", orientations)
    if composite == options.has("MATERIAL"):
        more = "; a stiffness matrix is not supported" if block.name == "SHELL GENERAL SECTION" else ""
        raise block.error(f"expected either MATERIAL= or COMPOSITE, with the material of each layer on its line{more}")
    if not rows or (len(rows) > 1 and not composite):
        raise block.error(
            "needs a data line with the thickness" + (" for each layer" if composite else ", and only one")
        )
    default = _DEFAULT_POINTS[_rule(block), composite]
    layers = [_read_layer(block, row, materials, default) for row in rows]
    if options.flag("SYMMETRIC"):
        layers += layers[::-1]
    stack = options.text("STACK DIRECTION")
    if stack == "ORIENTATION" and orientation is None:
        raise block.error("STACK DIRECTION=ORIENTATION needs ORIENTATION=")
    return ShellSection(
        options.text("ELSET"),
        tuple(layers),
        orientation,
        _offset(block),
        _rule(block) == "GAUSS",
        block.source,
        controls,
        stack=None if stack == "ORIENTATION" else int(stack),
        poisson=_poisson(block),
        modulus=block.positive("THICKNESS MODULUS", 0.0),
    )


def _poisson(block: Block) -> float | Literal["ELASTIC"] | None:
    """Read Poisson's ratio of the section, None for the default. Raises DeckError."""
    text = block.options.text("POISSON")
    if not text:
        return None
    if text == "ELASTIC":
        return "ELASTIC"
    try:
        value = read_real(text)
    except ValueError:
        value = math.nan
    if not -1 < value <= 0.5:
        raise block.error(f"POISSON={text}: expected a number from -1 to 0.5, or ELASTIC")
    return value


def _rule(block: Block) -> str:
    """Return the rule through the thickness; Simpson's rule is exact for linear elastic sections."""
    return block.options.text("SECTION INTEGRATION") if block.name == "SHELL SECTION" else "SIMPSON"


def _offset(block: Block) -> float:
    text = block.options.text("OFFSET") or "0"
    try:
        return _SIDES[text] if text in _SIDES else read_real(text)
    except ValueError:
        raise block.error(f"OFFSET={text}: expected a number, SPOS or SNEG") from None


def _read_layer(block: Block, row: Row, materials: Mapping[str, Material], default: int) -> ShellLayer:
    thickness = row.positive(0, "thickness")
    if block.name == "SHELL GENERAL SECTION":
        # the second entry of a layer is not used
        row.at_most(4 if block.options.flag("COMPOSITE") else 1)
        points = default
    else:
        points = row.integer(1, "number of section points", default)
    simpson = _rule(block) == "SIMPSON"
    if not 1 <= points <= MOST_POINTS or (simpson and (points < 3 or points % 2 == 0)):
        expected = f"an odd number from 3 to {MOST_POINTS - 1}" if simpson else f"a number from 1 to {MOST_POINTS}"
        raise row.error(f"{points} section points: expected {expected}")
    if not block.options.flag("COMPOSITE"):
        row.at_most(2)
        return ShellLayer(thickness, points, surface_material(block, block.options.text("MATERIAL"), materials))
    # the fifth is the name of the layer
    row.at_most(5)
    return ShellLayer(
        thickness,
        points,
        surface_material(block, row.name(2, "material"), materials),
        row.real(3, "orientation angle", 0.0),
    )


def surface_material(block: Block, name: str, materials: Mapping[str, Material]) -> Material:
    """Return a material of shells or membranes; in *SHELL GENERAL SECTION it is linear elastic. Raises DeckError."""
    material = look_up(materials, name, "material", block.source)
    depends = material.user_field or (material.elastic is not None and material.elastic.table is not None)
    if block.name == "SHELL GENERAL SECTION" and (material.user or material.plastic or depends):
        fault = "depends on temperature or fields" if depends else "is not linear elastic"
        message = f"material {material.name} {fault}, but the section is linear elastic with constants"
        raise block.error(f"{message}; *SHELL SECTION takes it")
    return material


def read_shear_stiffness(block: Block) -> tuple[tuple[float, float, float], float | None]:
    """Read K11, K22 and K12, and the slenderness factor, None for the default. Raises DeckError."""
    row = block.required_rows("K11, K22, K12")[0]
    row.at_most(4)
    first, second = row.real(0, "K11"), row.real(1, "K22")
    coupling = row.real(2, "K12", 0.0)
    if not (first > 0 and second > 0 and first * second > coupling**2):
        message = f"K11 = {first:g}, K22 = {second:g}, K12 = {coupling:g}: expected a positive definite stiffness"
        raise row.error(message)
    slenderness = None if row.blank(3) else row.not_negative(3, "slenderness factor")
    return (first, second, coupling), slenderness


_SECTION = (
    Option("ELSET", Kind.NAME, "element set", required=True),
    Option("MATERIAL", Kind.NAME, "material"),
    Option("COMPOSITE", doc="a data line for each layer, the first on the side SNEG"),
    Option("CONTROLS", Kind.NAME, "section controls"),
    Option("OFFSET", Kind.NAME, "from the middle surface to the nodes over the thickness, or SPOS or SNEG (0)"),
    Option("ORIENTATION", Kind.NAME, "orientation of the section"),
    one_of(
        "STACK DIRECTION",
        "continuum shells: parent coordinate from SNEG to SPOS, or ORIENTATION: the closest to the axis of the "
        "additional rotation",
        ("3", "1", "2", "ORIENTATION"),
        default="3",
    ),
    Option(
        "POISSON",
        Kind.NAME,
        "continuum shells: nu; the strain across is -nu/(1 - nu) times that of the area where there is no stress "
        "across; ELASTIC: that of *ELASTIC (0.5)",
    ),
    Option("THICKNESS MODULUS", Kind.REAL, "continuum shells: stress across by strain across"),
    Option("SYMMETRIC", doc="the layers again, in reverse"),
    *ignored("LAYUP"),
)
KEYWORDS = (
    Keyword(
        "SHELL SECTION",
        "Section of conventional and continuum shells, integrated in the analysis. Without ORIENTATION direction 1 is "
        "the projection of the global x axis, or of z where x is within 0.1 degrees of the normal. With it, the axis "
        "of its additional rotation is the one closest to the normal, and the next one of 1, 2, 3, 1 is projected. "
        "The thickness of conventional shells stays with NLGEOM, where POISSON changes that of Abaqus. That of "
        "continuum shells is the distance of their faces: places and thicknesses of layers change in proportion, and "
        "OFFSET has no meaning.",
        Where.MODEL,
        (
            *_SECTION,
            one_of("SECTION INTEGRATION", "rule through the thickness", ("SIMPSON", "GAUSS"), default="SIMPSON"),
            *refused("DENSITY", "NODAL THICKNESS", "SHELL THICKNESS", "TEMPERATURE"),
        ),
        "thickness, section points (5; Gauss 3); COMPOSITE: thickness, section points (3; Gauss 2), material, angle of "
        "the layer in degrees, name",
    ),
    Keyword(
        "SHELL GENERAL SECTION",
        "Section of conventional and continuum shells whose stiffness is that of linear elastic materials. It is "
        "*SHELL SECTION with them, of which the default section points have stresses in the output.",
        Where.MODEL,
        (
            *_SECTION,
            *refused("BENDING ONLY", "DENSITY", "DEPENDENCIES", "I PROPERTIES", "MEMBRANE ONLY", "NODAL THICKNESS"),
            *refused("PROPERTIES", "SHELL THICKNESS", "SMEAR ALL LAYERS", "TEMPERATURE", "UNSYMM"),
            *refused("USER", "VARIABLES", "ZERO"),
        ),
        "thickness; COMPOSITE: thickness, an entry without meaning, material, angle of the layer in degrees",
    ),
    Keyword(
        "TRANSVERSE SHEAR STIFFNESS",
        "Transverse shear stiffness of the *SHELL SECTION or *SHELL GENERAL SECTION before, in its directions; shells "
        "of UMAT need it. After "
        "*BEAM SECTION and *BEAM GENERAL SECTION, that of beams: with the length l of the element it becomes "
        "K/(1 + q l^2 A/(12 I)), with I of the bending that goes with the shear; q is 0.25, times 1E-4 in second-order "
        "elements. By "
        "default it is that of the elastic layers in bending about one direction without a moment about the other "
        "(Theory Guide, Transverse shear stiffness in composite shells), 5/6 of the shear modulus times the thickness "
        "where they are alike.",
        Where.MODEL,
        data="K11, K22, K12 (0), slenderness factor q (0.25E-4): the stiffness used is K/(1 + q area/thickness^2); "
        "beams: K23, K13 (one that is left out is the other; both: shear factor of the profile times G A), q",
    ),
)
