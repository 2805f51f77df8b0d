# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*BEAM SECTION and *BEAM GENERAL SECTION, with *TRANSVERSE SHEAR STIFFNESS after them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from uel.deck.error_report import look_up
from uel.deck.language.blocks import Block, Row
from uel.deck.language.table import Keyword, Kind, Option, Where, ignored, one_of, refused
from uel.elements.families.beam_points import DEFAULT_POINTS
from uel.elements.materials.library import shear_modulus
from uel.model.element_types import Tensor
from uel.model.properties import BeamSection, ElasticType, Material

BEAM_KEYWORDS: Final = ("BEAM SECTION", "BEAM GENERAL SECTION")

_DIMENSIONS: Final = {
    "RECT": ("a", "b"),
    "CIRC": ("radius",),
    "PIPE": ("outside radius", "wall thickness"),
    "BOX": ("a", "b", "t1", "t2", "t3", "t4"),
    "I": ("l", "h", "b1", "b2", "t1", "t2", "t3"),
    "GENERAL": ("A", "I11", "I12", "I22", "J"),
}
"""Entries of the first data line."""

_MAY_VANISH: Final = ("l", "I12", "I22")


def read_beam_section(block: Block, materials: Mapping[str, Material], dimension: int) -> BeamSection:
    """Read the section of beams in a plane (2) or in space (3). Raises DeckError."""
    options, rows = block.options, list(block.all_rows())
    general, profile = block.name == "BEAM GENERAL SECTION", options.text("SECTION")
    if not rows:
        raise block.error(f"needs a data line with {', '.join(_DIMENSIONS[profile])}")
    expected = 3 if general or profile in DEFAULT_POINTS else 2
    if len(rows) > expected:
        raise rows[expected].error(f"a data line more than the {expected} of SECTION={profile}")
    dimensions = _read_dimensions(rows[0], profile)
    material, density = None, 0.0
    if general:
        young, shear = _read_moduli(block, rows[2] if len(rows) > 2 else None)
        density = block.not_negative("DENSITY", 0.0)
    else:
        material = look_up(materials, options.text("MATERIAL"), "material", block.source)
        young, shear = 0.0, 0.0
        if material.elastic is not None and material.elastic.type is ElasticType.ISOTROPIC:
            young, shear = material.elastic.constants[0], shear_modulus(material.elastic, Tensor.SOLID)
        density = material.density
        if len(rows) > 2:
            _check_points(rows[2], profile, dimension)
    return BeamSection(
        options.text("ELSET"),
        profile,
        dimensions,
        young,
        shear,
        density,
        block.source,
        _read_n1(rows[1]) if len(rows) > 1 else (0.0, 0.0, -1.0),
        material,
        isotropic=options.text("ROTARY INERTIA") == "ISOTROPIC",
        poisson=options.real("POISSON", 0.0),
    )


def _read_dimensions(row: Row, profile: str) -> tuple[float, ...]:
    names = _DIMENSIONS[profile]
    # the last two entries of GENERAL are for beams with open sections
    row.at_most(len(names) + (2 if profile == "GENERAL" else 0))
    dimensions = {name: row.real(k, name, 0.0 if name in _MAY_VANISH else None) for k, name in enumerate(names)}
    for name, value in dimensions.items():
        if name not in _MAY_VANISH and not value > 0:
            raise row.error(f"{name} = {value:g} must be positive")
    if profile == "PIPE" and dimensions["wall thickness"] >= dimensions["outside radius"]:
        raise row.error("the wall thickness must be less than the outside radius")
    if profile == "BOX":
        if len({dimensions[f"t{k}"] for k in range(1, 5)}) > 1:
            raise row.error("walls of different thickness are not supported")
        if 2 * dimensions["t1"] >= min(dimensions["a"], dimensions["b"]):
            raise row.error("the walls are thicker than the box")
    if profile == "I" and dimensions["t1"] + dimensions["t2"] >= dimensions["h"]:
        raise row.error("the flanges are thicker than the section is high (h)")
    return tuple(dimensions.values())


def _read_n1(row: Row) -> tuple[float, float, float]:
    row.at_most(3)
    n1 = row.real(0, "n1", 0.0), row.real(1, "n1", 0.0), row.real(2, "n1", 0.0)
    return n1 if any(n1) else (0.0, 0.0, -1.0)


def _read_moduli(block: Block, row: Row | None) -> tuple[float, float]:
    if row is None:
        raise block.error("needs a third data line with Young's modulus and the shear modulus")
    young, shear = row.real(0, "Young's modulus"), row.real(1, "shear modulus")
    if not (young > 0 and shear > 0):
        raise row.error(f"E = {young:g}, G = {shear:g}: expected positive moduli")
    row.at_most(4)
    if row.real(2, "coefficient of thermal expansion", 0.0):
        raise row.error("thermal expansion is not supported for beams")
    return young, shear


def _check_points(row: Row, profile: str, dimension: int) -> None:
    default = DEFAULT_POINTS[profile][dimension - 2]
    row.at_most(len(default))
    points = tuple(row.integer(k, "number of section points", count) for k, count in enumerate(default))
    if points != default:
        expected = ", ".join(map(str, default))
        raise row.error(f"only the default numbers of section points are supported ({expected})")


def read_beam_shear(block: Block) -> tuple[tuple[float, ...], float | None]:
    """Read K23 and K13 (empty: of the profile) and the slenderness factor (None: default). Raises DeckError."""
    row = block.required_rows("K23, K13")[0]
    row.at_most(3)
    if not row.blank(2) and row.name(2, "slenderness compensation factor") == "SCF":
        raise row.error("SCF, a slenderness compensation factor from the moduli, is not supported; give its value")
    second, first = row.real(0, "K23", 0.0), row.real(1, "K13", 0.0)
    if second < 0 or first < 0:
        raise row.error(f"K23 = {second:g}, K13 = {first:g} must not be negative")
    slenderness = None if row.blank(2) else row.not_negative(2, "slenderness compensation factor")
    # a missing or zero value equals the other one
    return (second or first, first or second) if second or first else (), slenderness


_COMMON: Final = (
    Option("ELSET", Kind.NAME, "element set", required=True),
    one_of("LUMPED", "lumped mass in modal procedures", ("YES",), default="YES", refused=("NO",)),
    one_of(
        "ROTARY INERTIA",
        "ISOTROPIC: the same about all directions, and without the offset of the centroid",
        ("EXACT", "ISOTROPIC"),
        default="EXACT",
    ),
    Option("POISSON", Kind.REAL, "Poisson's ratio of the area, which does not change here: a warning with NLGEOM (0)"),
)
_SECTIONS: Final = ("RECT", "CIRC", "PIPE", "BOX", "I")
_MORE: Final = ("ARBITRARY", "HEX", "L", "TRAPEZOID", "THICK PIPE")
_DATA: Final = (
    "RECT: a, b; CIRC: radius; PIPE: outside radius, wall thickness; BOX: a, b, t1, t2, t3, t4 (equal); "
    "I: l, h, b1, b2, t1, t2, t3"
)

KEYWORDS = (
    Keyword(
        "BEAM SECTION",
        "Section of beams of isotropic, linear elastic material, or of one that is integrated over the section points: "
        "*PLASTIC with isotropic hardening, *USER MATERIAL, *EXPANSION, *ELASTIC of temperature and fields, *USER "
        "DEFINED FIELD. Temperatures are the same over the section, whatever TEMPERATURE is.",
        Where.MODEL,
        (
            *_COMMON,
            Option("MATERIAL", Kind.NAME, "material", required=True),
            one_of("SECTION", "profile", _SECTIONS, required=True, refused=(*_MORE, "ELBOW")),
            *ignored("TEMPERATURE"),
        ),
        f"{_DATA}; then approximate n1, in a part in its axes, blank for 0, 0, -1 (beams in a plane always have this "
        "one); then numbers of section points, which must be the default ones",
    ),
    Keyword(
        "BEAM GENERAL SECTION",
        "Section of beams with its moduli; nothing depends on the temperature ZERO.",
        Where.MODEL,
        (
            *_COMMON,
            Option("DENSITY", Kind.REAL, "mass per volume"),
            one_of(
                "SECTION",
                "profile, or section constants (GENERAL)",
                ("GENERAL", *_SECTIONS),
                default="GENERAL",
                refused=(*_MORE, "MESHED", "NONLINEAR GENERAL"),
            ),
            *ignored("ZERO"),
            *refused("DEPENDENCIES", "MATERIAL", "TAPER"),
        ),
        f"GENERAL: A, I11, I12, I22, J; {_DATA}; then approximate n1, blank for 0, 0, -1; then Young's modulus, shear "
        "modulus",
    ),
)
