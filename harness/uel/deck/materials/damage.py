# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Damage of traction-separation responses, of materials and in contact."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from uel.deck.language.blocks import Block, Row
from uel.deck.language.table import Keyword, Kind, Option, Where, ignored, one_of, refused
from uel.model.damage import Damage, DamageEvolution

OF_MATERIALS: Final = ("MAXS", "QUADS", "MAXE", "QUADE")
"""Criteria of materials: stresses or strains."""

OF_SURFACES: Final = ("MAXS", "QUADS", "MAXU", "QUADU")
"""Criteria of contact properties: stresses or separations."""


def extend_damage(damage: Damage | None, block: Block, criteria: tuple[str, ...]) -> Damage:
    """Return the damage extended by one keyword; criteria: those allowed. Raises DeckError."""
    if block.name == "DAMAGE INITIATION":
        if damage is not None:
            raise block.error(f"one criterion is supported; there is one already, at {damage.source}")
        criterion = block.options.text("CRITERION")
        if criterion not in criteria:
            raise block.error(f"CRITERION={criterion} is not one of what it follows; expected {', '.join(criteria)}")
        first, second, third = _values(block, 2, 3, "onset value")
        return Damage(criterion, (first, second, third), block.source)
    if damage is None:
        raise block.error("does not follow *DAMAGE INITIATION")
    if block.name == "DAMAGE EVOLUTION":
        return replace(damage, evolution=_read_evolution(block))
    if damage.evolution is None:
        raise block.error("does not follow *DAMAGE EVOLUTION")
    row = _only_row(block)
    row.at_most(1)
    return replace(damage, viscosity=row.not_negative(0, "viscosity"))


def _read_evolution(block: Block) -> DamageEvolution:
    options = block.options
    kind, softening, mixed = (options.text(name) for name in ("TYPE", "SOFTENING", "MIXED MODE BEHAVIOR"))
    power = options.real("POWER", 1.0)
    if mixed:
        if softening == "TABULAR":
            raise block.error(f"MIXED MODE BEHAVIOR={mixed} goes with SOFTENING=LINEAR or EXPONENTIAL")
        if kind == "DISPLACEMENT":
            raise block.error(f"MIXED MODE BEHAVIOR={mixed} goes with TYPE=ENERGY")
        if not options.has("POWER"):
            raise block.error(f"MIXED MODE BEHAVIOR={mixed} needs POWER")
        if power <= 0:
            raise block.error(f"POWER={power:g} must be positive")
        values = _values(block, 2, 3, "fracture energy")
        if mixed == "BK" and values[2] not in (0.0, values[1]):
            message = f"shear fracture energies {values[1]:g} and {values[2]:g}: BK has one for both directions"
            raise _only_row(block).error(message)
        return DamageEvolution(kind, softening, mixed, values, power, block.source)
    if options.has("POWER"):
        raise block.error("POWER goes with MIXED MODE BEHAVIOR")
    if softening == "TABULAR":
        if kind != "DISPLACEMENT":
            raise block.error("SOFTENING=TABULAR goes with TYPE=DISPLACEMENT")
        return DamageEvolution(kind, softening, mixed, _read_table(block), power, block.source)
    if kind == "DISPLACEMENT" and softening == "EXPONENTIAL":
        values = _values(block, 2, 2, "displacement or exponential law parameter")
    else:
        values = _values(block, 1, 1, "displacement" if kind == "DISPLACEMENT" else "fracture energy")
    if values[0] <= 0:
        what = "displacement at failure" if kind == "DISPLACEMENT" else "fracture energy"
        raise _only_row(block).error(f"{what} {values[0]:g} must be positive")
    return DamageEvolution(kind, softening, mixed, values, power, block.source)


def _read_table(block: Block) -> tuple[float, ...]:
    """Read alternating displacements after the onset and damages. Raises DeckError."""
    table: list[float] = []
    for row in block.rows():
        if len(row) > 2:
            raise row.error("expected damage and displacement; dependence on mode mix or temperature is not supported")
        damage, displacement = row.real(0, "damage", 0.0), row.real(1, "displacement", 0.0)
        if not table and displacement:
            raise row.error(f"the first displacement, from the onset on, is 0, found {displacement:g}")
        if table and displacement <= table[-2]:
            raise row.error(f"displacement {displacement:g} must exceed that of the line before, {table[-2]:g}")
        if not (table[-1] if table else 0.0) <= damage <= 1:
            raise row.error(f"damage {damage:g} must be from that of the line before, or 0, to 1")
        table += displacement, damage
    if len(table) < 4:
        raise block.error("SOFTENING=TABULAR needs two or more lines of damage and displacement")
    return tuple(table)


def _only_row(block: Block) -> Row:
    rows = list(block.rows())
    if len(rows) != 1:
        raise block.dependent("needs one data line")
    return rows[0]


def _values(block: Block, least: int, most: int, quantity: str) -> tuple[float, ...]:
    """Return `most` values of the only data line; missing ones are zero. Raises DeckError."""
    row = _only_row(block)
    if not least <= len(row) <= most:
        expected = str(most) if least == most else f"{least} or {most}"
        raise row.dependent(f"{len(row)} values, expected {expected}")
    return tuple(row.real(index, quantity, 0.0) for index in range(most))


KEYWORDS = (
    Keyword(
        "DAMAGE INITIATION",
        "Onset of damage in a traction-separation response, of a material or in contact.",
        Where.MODEL,
        (
            one_of(
                "CRITERION",
                "criterion",
                (*OF_MATERIALS, *OF_SURFACES[2:]),
                required=True,
                refused=(
                    *("DUCTILE", "FLD", "FLSD", "HASHIN", "HASHIN-ROTEM", "HYSTERESIS ENERGY", "JOHNSON COOK"),
                    *("LARC05", "MAXPE", "MAXPS", "MK", "MSFLD", "SHEAR", "USER"),
                ),
            ),
            *ignored("TOLERANCE"),
            *refused("ALPHA", "DEPENDENCIES", "NAME", "PROPERTIES"),
        ),
        "normal, first shear and second shear stress, or strain (MAXE, QUADE), or separation in contact (MAXU, QUADU)",
    ),
    Keyword(
        "DAMAGE EVOLUTION",
        "Evolution of damage after its onset.",
        Where.MODEL,
        (
            one_of("TYPE", "what is given", ("DISPLACEMENT", "ENERGY"), required=True, refused=("HYSTERESIS ENERGY",)),
            one_of("SOFTENING", "softening", ("LINEAR", "EXPONENTIAL", "TABULAR"), default="LINEAR"),
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
        "displacement from onset to failure, exponential law parameter; or lines of damage and displacement after the "
        "onset (TABULAR); or fracture energy; or those of the normal, first shear and second shear mode",
    ),
    Keyword(
        "DAMAGE STABILIZATION",
        "Viscosity of the damage; that of the section controls takes precedence.",
        Where.MODEL,
        data="relaxation time of the damage",
    ),
)
