# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Damage of traction-separation materials, and section controls."""

from __future__ import annotations

from dataclasses import replace

from harness.deck.blocks import Block, Row
from harness.deck.error_report import Problems
from harness.deck.table import NAME, Keyword, Kind, Option, Where, ignored, one_of, refused
from harness.model.element_types import HOURGLASS_CONTROLLED
from harness.model.properties import Damage, DamageEvolution, SectionControls


def extend_damage(damage: Damage | None, block: Block) -> Damage:
    """The damage of a material with what one more keyword says of it."""
    if block.name == "DAMAGE INITIATION":
        if damage is not None:
            raise block.error(f"one criterion is supported; the material has one already, at {damage.source}")
        first, second, third = _values(block, 2, 3, "onset value")
        return Damage(block.options.text("CRITERION"), (first, second, third), block.source)
    if damage is None:
        raise block.error("does not follow *DAMAGE INITIATION")
    if block.name == "DAMAGE EVOLUTION":
        if damage.evolution is not None:
            raise block.error(f"the material has one already, at {damage.evolution.source}")
        return replace(damage, evolution=_read_evolution(block))
    if damage.evolution is None:
        raise block.error("does not follow *DAMAGE EVOLUTION")
    row = _only_row(block)
    row.at_most(1)
    viscosity = row.real(0, "viscosity")
    if viscosity < 0:
        raise row.error(f"viscosity {viscosity:g} must not be negative")
    return replace(damage, viscosity=viscosity)


def _read_evolution(block: Block) -> DamageEvolution:
    options = block.options
    kind, softening, mixed = (options.text(name) for name in ("TYPE", "SOFTENING", "MIXED MODE BEHAVIOR"))
    power = options.real("POWER", 1.0)
    if mixed:
        if kind == "DISPLACEMENT":
            raise block.error(f"MIXED MODE BEHAVIOR={mixed} goes with TYPE=ENERGY")
        if not options.given("POWER"):
            raise block.error(f"MIXED MODE BEHAVIOR={mixed} needs POWER")
        if power <= 0:
            raise block.error(f"POWER={power:g} must be positive")
        values = _values(block, 2, 3, "fracture energy")
        if mixed == "BK" and values[2] not in (0.0, values[1]):
            message = f"shear fracture energies {values[1]:g} and {values[2]:g}: BK has one for both directions"
            raise _only_row(block).error(message)
        return DamageEvolution(kind, softening, mixed, values, power, block.source)
    if options.given("POWER"):
        raise block.error("POWER goes with MIXED MODE BEHAVIOR")
    if kind == "DISPLACEMENT" and softening == "EXPONENTIAL":
        values = _values(block, 2, 2, "displacement or exponential law parameter")
    else:
        values = _values(block, 1, 1, "displacement" if kind == "DISPLACEMENT" else "fracture energy")
    if values[0] <= 0:
        what = "displacement at failure" if kind == "DISPLACEMENT" else "fracture energy"
        raise _only_row(block).error(f"{what} {values[0]:g} must be positive")
    return DamageEvolution(kind, softening, mixed, values, power, block.source)


def _only_row(block: Block) -> Row:
    rows = list(block.rows())
    if len(rows) != 1:
        raise block.error("needs one data line; dependence on temperature is not supported")
    return rows[0]


def _values(block: Block, least: int, most: int, what: str) -> tuple[float, ...]:
    """`most` values of the only data line, zero where they are left out."""
    row = _only_row(block)
    if not least <= len(row) <= most:
        expected = str(most) if least == most else f"{least} or {most}"
        message = f"{len(row)} values, expected {expected}; dependence on temperature is not supported"
        raise row.error(message)
    return tuple(row.real(index, what, 0.0) for index in range(most))


def read_controls(blocks: list[Block], problems: Problems) -> dict[str, SectionControls]:
    """Section controls by name."""
    found: dict[str, SectionControls] = {}
    for block in blocks:
        if block.name == "SECTION CONTROLS":
            with problems.gather():
                name = block.options.text("NAME")
                if name in found:
                    raise block.error(f"{name} is defined already")
                found[name] = _read_controls(block)
    return found


def _read_controls(block: Block) -> SectionControls:
    options = block.options
    degradation = options.real("MAX DEGRADATION", 1.0)
    if not 0 < degradation <= 1:
        raise block.error(f"MAX DEGRADATION={degradation:g}: expected a number above 0, up to 1")
    viscosity = options.real("VISCOSITY", 0.0) if options.given("VISCOSITY") else None
    if viscosity is not None and viscosity < 0:
        raise block.error(f"VISCOSITY={viscosity:g} must not be negative")
    deletion = options.flag("ELEMENT DELETION") or not options.given("ELEMENT DELETION")
    enhanced = options.text("HOURGLASS") == "ENHANCED"
    row = next(block.rows(), None)
    # "any data given on the data line will be ignored" where it is enhanced (Abaqus Keywords Guide)
    factor = 1.0 if row is None or enhanced else row.real(0, "factor of the hourglass stiffness", 1.0)
    if factor <= 0:
        raise block.error(f"factor {factor:g} of the hourglass stiffness must be positive")
    return SectionControls(deletion, degradation, viscosity, enhanced, factor)


DAMAGE = (
    Keyword(
        "DAMAGE INITIATION",
        "Onset of damage in a traction-separation response.",
        Where.MODEL,
        (
            one_of(
                "CRITERION",
                "criterion",
                ("MAXS", "QUADS", "MAXE", "QUADE"),
                required=True,
                refused=(
                    *("DUCTILE", "FLD", "FLSD", "HASHIN", "HASHIN-ROTEM", "HYSTERESIS ENERGY", "JOHNSON COOK"),
                    *("LARC05", "MAXPE", "MAXPS", "MK", "MSFLD", "SHEAR", "USER"),
                ),
            ),
            *ignored("TOLERANCE"),
            *refused("ALPHA", "DEPENDENCIES", "NAME", "PROPERTIES"),
        ),
        "normal, first shear and second shear stress or strain at the onset",
    ),
    Keyword(
        "DAMAGE EVOLUTION",
        "Evolution of damage after its onset.",
        Where.MODEL,
        (
            one_of("TYPE", "what is given", ("DISPLACEMENT", "ENERGY"), required=True, refused=("HYSTERESIS ENERGY",)),
            one_of("SOFTENING", "softening", ("LINEAR", "EXPONENTIAL"), default="LINEAR", refused=("TABULAR",)),
            one_of("MIXED MODE BEHAVIOR", "fracture energy in mixed mode", ("BK", "POWER LAW"), refused=("TABULAR",)),
            one_of(
                "MODE MIX RATIO",
                "measure of the mode mix",
                ("ENERGY",),
                default="ENERGY",
                refused=("ACCUMULATED ENERGY", "TRACTION"),
            ),
            Option("POWER", Kind.REAL, "exponent of MIXED MODE BEHAVIOR"),
            *ignored("DEGRADATION"),
            *refused("DEPENDENCIES", "FAILURE INDEX"),
        ),
        "displacement from onset to failure, exponential law parameter; or fracture energy; or those of the normal, "
        "first shear and second shear mode",
    ),
    Keyword(
        "DAMAGE STABILIZATION",
        "Viscosity of the damage; that of the section controls takes precedence.",
        Where.MODEL,
        data="relaxation time of the damage",
    ),
)

KEYWORDS = (
    *DAMAGE,
    Keyword(
        "SECTION CONTROLS",
        "Deletion, largest damage and viscosity of cohesive elements; hourglass control of "
        f"{', '.join(HOURGLASS_CONTROLLED)} and those with temperatures. STIFFNESS is that of *HOURGLASS STIFFNESS. "
        "ENHANCED is the assumed strain stabilization of Belytschko and Bindeman (1991, 1993), with which rectangles "
        "and bricks bend exactly; that Abaqus has the same numbers is inferred from its manual, which names the "
        "method, and a warning says so. It needs *ELASTIC, TYPE=ISOTROPIC with constant values, and is not available "
        "for axisymmetric elements.",
        Where.MODEL,
        (
            NAME,
            Option("ELEMENT DELETION", Kind.SWITCH, "delete failed elements, unless they are in compression (YES)"),
            Option("MAX DEGRADATION", Kind.REAL, "largest damage (1)"),
            Option("VISCOSITY", Kind.REAL, "relaxation time of the damage (0)"),
            one_of(
                "HOURGLASS",
                "hourglass control",
                ("STIFFNESS", "ENHANCED"),
                default="STIFFNESS",
                refused=("COMBINED", "RELAX STIFFNESS", "VISCOUS"),
            ),
            *ignored("DISTORTION CONTROL", "KINEMATIC SPLIT", "LENGTH RATIO", "SECOND ORDER ACCURACY"),
        ),
        "factor of the hourglass stiffness with STIFFNESS (1); factors of shells and of Abaqus/Explicit, not read",
    ),
)
