# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*AMPLITUDE."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block
from uel.deck.language.definitions import read_definitions
from uel.deck.language.table import INPUT, NAME, Keyword, Kind, Option, Where, one_of, refused
from uel.deck.sections.user_elements import MOST_VALUES, read_count
from uel.model.amplitude import Amplitude, AmplitudeType, UserAmplitude
from uel.model.arrays import FloatArray


def read_amplitudes(blocks: list[Block], problems: Problems) -> dict[str, Amplitude]:
    """Read the amplitudes of *AMPLITUDE, by name."""
    return read_definitions(blocks, "AMPLITUDE", _read_amplitude, problems)


def _read_amplitude(block: Block) -> Amplitude:
    options = block.options
    name = options.text("NAME")
    spaced = options.text("DEFINITION") == "EQUALLY SPACED"
    if not spaced and (options.has("FIXED INTERVAL") or options.has("BEGIN")):
        raise block.error("FIXED INTERVAL and BEGIN are for DEFINITION=EQUALLY SPACED")
    kind = AmplitudeType.TABULAR if spaced else AmplitudeType(options.text("DEFINITION"))
    total, absolute = options.text("TIME") == "TOTAL TIME", options.text("VALUE") == "ABSOLUTE"
    if kind is AmplitudeType.USER:
        properties, variables = _read_user(block)
        return UserAmplitude(name, kind, properties, block.source, total, absolute, variables=variables)
    if options.has("PROPERTIES") or options.has("VARIABLES"):
        raise block.error("PROPERTIES and VARIABLES are for DEFINITION=USER")
    readers = {AmplitudeType.PERIODIC: _read_periodic, AmplitudeType.DECAY: _read_decay}
    data = _read_spaced(block) if spaced else readers.get(kind, _read_pairs)(block)
    if kind is AmplitudeType.SMOOTH_STEP and len(data) < 2:
        raise block.error("SMOOTH STEP needs at least two points")
    return Amplitude(name, kind, data, block.source, total, absolute, _read_smoothing(block, kind))


def _read_smoothing(block: Block, kind: AmplitudeType) -> float | None:
    """Read SMOOTH of a table, None if it is left out. Raises DeckError."""
    if not block.options.has("SMOOTH"):
        return None
    smoothing = block.options.real("SMOOTH", 0.0)
    if kind is not AmplitudeType.TABULAR:
        raise block.error("SMOOTH is for DEFINITION=TABULAR and EQUALLY SPACED")
    if not 0 <= smoothing <= 0.5:
        raise block.error(f"SMOOTH={smoothing:g}: expected 0 to 0.5")
    return smoothing


def _read_user(block: Block) -> tuple[FloatArray, int]:
    """Read the properties for UAMP, and the number of its state variables. Raises DeckError."""
    count = read_count(block, "PROPERTIES", 0, 0, MOST_VALUES)
    values = [value for row in block.rows() for value in row.reals("property")]
    if len(values) != count:
        raise block.error(f"PROPERTIES={count}, but the data lines have {len(values)}")
    return np.array(values), read_count(block, "VARIABLES", 1, 1, MOST_VALUES)


def _read_pairs(block: Block) -> FloatArray:
    values: list[float] = []
    for row in block.required_rows():
        before = values[-2] if len(values) % 2 == 0 and values else None
        values += row.reals("time or value")
        times = ([] if before is None else [before]) + values[len(values) - len(row) :: 2]
        if len(row) % 2:
            raise row.error("expected pairs of time and value")
        if any(later <= earlier for earlier, later in pairwise(times)):
            raise row.error("times must increase")
    return np.array(values).reshape(-1, 2)


def _read_spaced(block: Block) -> FloatArray:
    """Read times and values of a curve with values at equal intervals. Raises DeckError."""
    interval, begin = block.options.real("FIXED INTERVAL", 0.0), block.options.real("BEGIN", 0.0)
    if interval <= 0:
        raise block.error("DEFINITION=EQUALLY SPACED needs a positive FIXED INTERVAL")
    values = [value for row in block.required_rows() for value in row.reals("value")]
    return np.column_stack([begin + interval * np.arange(len(values)), values])


def _read_decay(block: Block) -> FloatArray:
    """Read rows (A0, A), (t0, td). Raises DeckError."""
    row = block.required_rows()[0]
    row.at_most(4)
    values = [row.real(index, quantity, 0.0) for index, quantity in enumerate(("A0", "A", "t0", "td"))]
    if values[3] <= 0:
        raise row.error(f"decay time td = {values[3]:g} must be positive")
    return np.array(values).reshape(2, 2)


def _read_periodic(block: Block) -> FloatArray:
    """Read rows (omega, t0), (A0, 0), then (An, Bn). Raises DeckError."""
    rows = block.required_rows()
    terms = rows[0].integer(0, "number of terms")
    head = [rows[0].real(index, quantity, 0.0) for index, quantity in ((1, "omega"), (2, "t0"), (3, "A0"))]
    values = [value for row in rows[1:] for value in row.reals("coefficient")]
    if len(values) % 2:
        values.append(0.0)
    # terms beyond the number are nothing if they are zero
    if len(values) < 2 * terms or any(values[2 * terms :]):
        raise rows[0].error(
            f"expected the coefficients of {terms} terms, as this line says, found {len(values) / 2:g} A, B"
        )
    return np.array([head[0], head[1], head[2], 0.0, *values[: 2 * terms]]).reshape(-1, 2)


KEYWORDS = (
    Keyword(
        "AMPLITUDE",
        "Factor of loads and prescribed values over time.",
        Where.ANY,
        (
            NAME,
            one_of(
                "DEFINITION",
                "kind of curve",
                ("TABULAR", "EQUALLY SPACED", "SMOOTH STEP", "PERIODIC", "DECAY", "USER"),
                default="TABULAR",
                refused=(
                    *("ACTUATOR", "BUBBLE", "FILM", "MODULATED", "PSD DEFINITION", "RAMP"),
                    *("SOLUTION DEPENDENT", "SPECTRUM"),
                ),
            ),
            one_of("TIME", "which time", ("STEP TIME", "TOTAL TIME"), default="STEP TIME", refused=("NORMALIZED",)),
            one_of("VALUE", "what the values are", ("RELATIVE", "ABSOLUTE"), default="RELATIVE"),
            INPUT,
            Option("PROPERTIES", Kind.INTEGER, "number of properties that UAMP gets (0), with DEFINITION=USER"),
            Option("VARIABLES", Kind.INTEGER, "number of state variables of UAMP (1), with DEFINITION=USER"),
            Option("FIXED INTERVAL", Kind.REAL, "time between values, with DEFINITION=EQUALLY SPACED"),
            Option("BEGIN", Kind.REAL, "time of the first value (0), with DEFINITION=EQUALLY SPACED"),
            Option(
                "SMOOTH",
                Kind.REAL,
                "fraction of each interval of a table that Abaqus rounds where time derivatives are needed, those of "
                "displacements and velocities in *DYNAMIC (0.25): there corners stay, and another value than 0 is "
                "refused; elsewhere it has no effect",
            ),
            *refused("SHIFTX", "SHIFTY", "SCALEX", "SCALEY"),
        ),
        "TABULAR, SMOOTH STEP: time, value pairs; PERIODIC: number of terms, omega, t0, A0; A1, B1, A2, B2 and so on; "
        "DECAY: A0, A, t0, td; EQUALLY SPACED: values; USER: properties",
    ),
)
