# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Mises plasticity: *PLASTIC and *CYCLIC HARDENING."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block
from uel.deck.language.table import Keyword, Kind, Option, Where, one_of, refused
from uel.model.arrays import FloatArray
from uel.model.properties import Plastic

MOST_BACKSTRESSES = 10
"""Largest NUMBER BACKSTRESSES of Abaqus; fortran/host/materials/library.f90 has it too."""


def extend_plastic(plastic: Plastic | None, block: Block, problems: Problems) -> Plastic:
    """Return the plasticity extended by one keyword. Raises DeckError."""
    if block.name == "PLASTIC":
        return _read_plastic(block, problems)
    if plastic is None or not plastic.combined:
        raise block.error("does not follow *PLASTIC, HARDENING=COMBINED")
    if block.options.flag("PARAMETERS"):
        row = block.required_row("the size of the yield surface, Q and b")
        row.at_most(3)
        size, growth, rate = (
            row.real(index, quantity) for index, quantity in enumerate(("size of the yield surface", "Q", "b"))
        )
        if min(size, size + growth) <= 0 or rate < 0:
            message = f"size {size:g}, Q = {growth:g}, b = {rate:g}: expected size > 0, size + Q > 0 and b >= 0"
            raise row.error(message)
        extended = replace(plastic, table=np.array([[size, 0.0]]), growth=(growth, rate))
    else:
        extended = replace(plastic, table=_read_table(block, "size of the yield surface"), growth=(0.0, 0.0))
    first, initial = extended.table[0, 0], plastic.table[0, 0]
    if first != initial:
        message = f"*CYCLIC HARDENING: the yield surface begins with {first:g}, not with the {initial:g} of *PLASTIC"
        problems.warn(block.source, f"{message} ({plastic.source})")
    return extended


def _read_plastic(block: Block, problems: Problems) -> Plastic:
    options = block.options
    hardening = options.text("HARDENING")
    if hardening == "COMBINED":
        return _read_combined(block, problems)
    if other := next((name for name in ("DATA TYPE", "NUMBER BACKSTRESSES") if options.has(name)), ""):
        raise block.error(f"{other} goes with HARDENING=COMBINED")
    if hardening == "USER":
        return _read_user(block)
    if options.has("PROPERTIES"):
        raise block.error("PROPERTIES goes with HARDENING=USER")
    table = _read_table(block, "yield stress")
    if hardening == "ISOTROPIC":
        return Plastic(table, block.source)
    if len(table) != 2:
        message = f"HARDENING=KINEMATIC needs two data lines, found {len(table)}"
        raise block.error(f"{message}; they give the modulus of the linear hardening")
    modulus = (table[1, 0] - table[0, 0]) / table[1, 1]
    if modulus < 0:
        raise block.error("HARDENING=KINEMATIC: the yield stress must not decrease")
    return Plastic(table[:1], block.source, np.array([[modulus, 0.0]]))


def _read_user(block: Block) -> Plastic:
    count = block.options.integer("PROPERTIES", 0)
    if count < 0:
        raise block.error(f"PROPERTIES={count}: expected a number of 0 or more")
    values = [value for row in block.rows() for value in row.reals("property")]
    if len(values) != count:
        raise block.error(f"PROPERTIES={count}, but the data lines have {len(values)}")
    return Plastic(np.zeros((0, 2)), block.source, user=np.array(values))


def _read_combined(block: Block, problems: Problems) -> Plastic:
    if block.options.text("DATA TYPE") != "PARAMETERS":
        message = (
            "HARDENING=COMBINED is supported with DATA TYPE=PARAMETERS: how Abaqus fits C and gamma to tests (DATA"
        )
        raise block.error(f"{message} TYPE=HALF CYCLE, its default, and STABILIZED) is not documented")
    count = block.options.integer("NUMBER BACKSTRESSES", 1)
    if not 1 <= count <= MOST_BACKSTRESSES:
        raise block.error(f"NUMBER BACKSTRESSES={count}: expected a number from 1 to {MOST_BACKSTRESSES}")
    entries = block.entries(problems.warn)
    if len(entries) > 2 * count + 1:
        raise block.dependent(
            f"{len(entries)} values, but yield stress and C, gamma of {count} backstresses are {2 * count + 1}"
        )
    if not entries:
        raise block.error("needs a data line")
    size = entries[0][0].positive(0, "yield stress")
    values = [row.real(index, "C or gamma", 0.0) for row, index in entries[1:]]
    if len(values) < 2 * count - 1:
        raise block.error(f"{len(values)} values after the yield stress, expected C and gamma of {count} backstresses")
    backstresses = np.array([*values, 0.0][: 2 * count]).reshape(-1, 2)
    if backstresses.min() < 0:
        raise block.error(f"C and gamma must not be negative, found {backstresses.min():g}")
    return Plastic(np.array([[size, 0.0]]), block.source, backstresses, combined=True)


def _read_table(block: Block, quantity: str) -> FloatArray:
    """Read rows of a stress and the plastic strain, which begins at zero. Raises DeckError."""
    table: list[tuple[float, float]] = []
    for row in block.required_rows():
        if len(row) > 2:
            raise row.dependent(f"expected only {quantity} and plastic strain")
        table.append((row.positive(0, quantity), row.real(1, "plastic strain", 0.0)))
        if (table[-1][1] != 0) if len(table) == 1 else (table[-1][1] <= table[-2][1]):
            raise row.error("plastic strains must begin at zero and increase")
    return np.array(table)


KEYWORDS = (
    Keyword(
        "PLASTIC",
        "Mises plasticity with isotropic hardening; or, in continuum elements and UELMAT, with linear kinematic or "
        "combined hardening: the rate of a backstress is 2/3 C times that of the plastic strain, less gamma times the "
        "backstress and the rate of the equivalent plastic strain. With gamma the stiffness is unsymmetric. With "
        "HARDENING=USER UHARD gives the yield stress in continuum elements and UELMAT.",
        Where.MODEL,
        (
            one_of(
                "HARDENING",
                "hardening",
                ("ISOTROPIC", "KINEMATIC", "COMBINED", "USER"),
                default="ISOTROPIC",
                refused=("JOHNSON COOK",),
            ),
            one_of(
                "DATA TYPE",
                "of HARDENING=COMBINED, which needs it",
                ("PARAMETERS",),
                refused=("HALF CYCLE", "STABILIZED"),
            ),
            Option("NUMBER BACKSTRESSES", Kind.INTEGER, "of HARDENING=COMBINED, 1 to 10 (1)"),
            Option("PROPERTIES", Kind.INTEGER, "number of constants of UHARD, with HARDENING=USER (0)"),
            *refused("DEPENDENCIES", "RATE", "SCALESTRESS"),
        ),
        "yield stress, plastic strain, two lines with HARDENING=KINEMATIC; yield stress, C1, gamma1, C2, gamma2, ..., "
        "eight per line (COMBINED); constants of UHARD, eight per line (USER)",
    ),
    Keyword(
        "CYCLIC HARDENING",
        "Size of the yield surface of *PLASTIC, HARDENING=COMBINED, which is constant without it.",
        Where.MODEL,
        (
            Option("PARAMETERS", doc="the size grows by Q (1 - exp(-b equivalent plastic strain))"),
            *refused("DEPENDENCIES", "PROPERTIES", "RATE", "USER"),
        ),
        "size, equivalent plastic strain; or size, Q, b (PARAMETERS)",
    ),
)
