# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*SELECT EIGENMODES, *MODAL DAMPING and *BASE MOTION, for modal procedures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from uel.deck.language.blocks import Block, Row
from uel.deck.language.table import Keyword, Kind, Option, Where, one_of, refused
from uel.deck.steps.prescribed import HARMONIC, Prescription
from uel.errors import DeckError
from uel.model.amplitude import UserAmplitude
from uel.model.arrays import FloatArray
from uel.model.modal import BaseMotion, DampingKind, ModalDamping, Motion, Superposition
from uel.model.procedures import Procedure

_NAMES = ("SELECT EIGENMODES", "MODAL DAMPING", "BASE MOTION")
_LAST_TRANSLATION = 3


def with_modes(procedure: Procedure, blocks: Sequence[Block], prescription: Prescription) -> Procedure:
    """Return the procedure of a step with the data of its modal keywords. Raises DeckError if it has no modes."""
    keywords = {name: [block for block in blocks if block.name == name] for name in _NAMES}
    if not procedure.modal:
        for block in (block for same_keyword in keywords.values() for block in same_keyword):
            raise block.error("is for *MODAL DYNAMIC, and *STEADY STATE DYNAMICS without DIRECT")
        return procedure
    superposition = Superposition(
        damping=tuple(_read_damping(block) for block in keywords["MODAL DAMPING"]),
        base=tuple(_read_base(block, prescription, procedure) for block in keywords["BASE MOTION"]),
    )
    for block in keywords["SELECT EIGENMODES"]:
        selected, by_frequency = _read_selection(block)
        superposition = replace(superposition, selected=selected, by_frequency=by_frequency)
    _check_damping(superposition.damping, procedure)
    return replace(procedure, superposition=superposition)


def _check_damping(dampings: Sequence[ModalDamping], procedure: Procedure) -> None:
    """Raise DeckError if a kind of damping is repeated, or unsupported by the procedure."""
    seen: dict[DampingKind, ModalDamping] = {}
    for damping in dampings:
        message = ""
        if damping.kind in seen:
            message = f"{damping.kind} is given already, at {seen[damping.kind].source}"
        elif damping.kind not in procedure.damping:
            takes = f"takes {' and '.join(procedure.damping)}" if procedure.damping else "has that of the elements"
            message = f"{damping.kind} is not for this step, {procedure.title}, which {takes}"
        if message:
            raise DeckError(damping.source, f"*MODAL DAMPING: {message}")
        seen[damping.kind] = damping


def _read_selection(block: Block) -> tuple[FloatArray, bool]:
    """Read ranges (k, 2) of modes or frequencies, and whether they are frequencies. Raises DeckError."""
    by_frequency = block.options.text("DEFINITION") == "FREQUENCY RANGE"
    generate = block.options.flag("GENERATE")
    if by_frequency and generate:
        raise block.error("GENERATE is for DEFINITION=MODE NUMBERS")
    ranges: list[tuple[float, float]] = []
    for row in block.required_rows():
        if by_frequency:
            row.at_most(2)
            lowest, highest = row.real(0, "lowest frequency"), row.real(1, "highest frequency")
            if highest < lowest:
                raise row.error(f"the highest frequency {highest:g} is below the lowest, {lowest:g}")
            ranges.append((lowest, highest))
        else:
            numbers = _generated(row) if generate else (_mode(row, index) for index in range(len(row)))
            ranges += [(number, number) for number in numbers]
    return np.array(ranges, dtype=float), by_frequency


def _generated(row: Row) -> Iterator[int]:
    """Yield the modes of a line of GENERATE: first, last, increment (1). Raises DeckError."""
    row.at_most(3)
    first, last, step = _mode(row, 0), _mode(row, 1), row.integer(2, "increment", 1) or 1
    if last < first or step < 1:
        raise row.error(f"expected first and last mode and a positive increment, found {first}, {last}, {step}")
    yield from range(first, last + 1, step)


def _mode(row: Row, index: int) -> int:
    number = row.integer(index, "mode")
    if number < 1:
        raise row.error(f"mode {number} must be positive")
    return number


def _read_damping(block: Block) -> ModalDamping:
    options = block.options
    kinds = [options.text("VISCOUS"), *(name for name in ("RAYLEIGH", "STRUCTURAL") if options.flag(name))]
    kinds += ["FRACTION OF CRITICAL DAMPING"] if options.has("MODAL") else []
    kinds = [name for name in kinds if name]
    if len(kinds) > 1:
        raise block.error(f"{' and '.join(kinds)} exclude each other")
    kind = DampingKind(kinds[0] if kinds else DampingKind.CRITICAL)
    by_frequency = options.text("DEFINITION") == "FREQUENCY RANGE"
    names = ("alpha", "beta") if kind is DampingKind.RAYLEIGH else (f"damping ({kind.lower()})",)
    ranges: list[tuple[float, ...]] = []
    factors: list[tuple[float, ...]] = []
    for row in block.required_rows():
        ranges.append((row.real(0, "frequency"),) if by_frequency else _read_modes(row))
        begin = 1 if by_frequency else 2
        row.at_most(begin + len(names))
        factors.append(tuple(row.real(begin + index, name, 0.0) for index, name in enumerate(names)))
        if by_frequency and len(ranges) > 1 and ranges[-1] <= ranges[-2]:
            raise row.error("frequencies must increase")
        if min(factors[-1]) < 0:
            raise row.error("damping must not be negative")
    return ModalDamping(kind, np.array(ranges), np.array(factors), block.source, by_frequency)


def _read_modes(row: Row) -> tuple[float, float]:
    """Read the first and last mode. Raises DeckError."""
    first = _mode(row, 0)
    last = row.integer(1, "last mode", 0) or first
    if last < first:
        raise row.error(f"the last mode {last} is before the first, {first}")
    return first, last


def _read_base(block: Block, prescription: Prescription, procedure: Procedure) -> BaseMotion:
    options = block.options
    dof, motion = options.integer("DOF", 0), Motion(options.text("TYPE"))
    if not 1 <= dof <= _LAST_TRANSLATION:
        raise block.error(f"DOF={dof}: supports move along 1, 2 or 3; their rotation is not supported")
    if motion not in procedure.base_motions:
        message = f"TYPE={motion} over time, a table without acceleration at its points, is not supported"
        raise block.error(f"{message}; TYPE=ACCELERATION is")
    amplitude = prescription.amplitude(block)
    assert amplitude is not None  # the option is required
    if isinstance(amplitude, UserAmplitude):
        raise block.error("an amplitude by UAMP is not supported here")
    scale = options.real("SCALE", 1.0)
    return BaseMotion(dof, motion, amplitude, scale, block.source, options.flag("IMAGINARY"))


_DEFINITION = one_of(
    "DEFINITION", "what the data lines name", ("MODE NUMBERS", "FREQUENCY RANGE"), default="MODE NUMBERS"
)

KEYWORDS = (
    Keyword(
        "SELECT EIGENMODES",
        "Modes of *FREQUENCY that respond in a step by modes; without it all of them.",
        Where.STEP,
        (_DEFINITION, Option("GENERATE", doc="data lines are first mode, last mode, increment")),
        "modes; or lowest and highest frequency (cycles per time)",
    ),
    Keyword(
        "MODAL DAMPING",
        "Damping of modes of *FREQUENCY in *MODAL DYNAMIC and *STEADY STATE DYNAMICS; without it they have none.",
        Where.STEP,
        (
            one_of("VISCOUS", "what is given", ("FRACTION OF CRITICAL DAMPING", "RAYLEIGH"), refused=("COMPOSITE",)),
            one_of("MODAL", "older spelling of VISCOUS", ("DIRECT",), refused=("COMPOSITE",)),
            Option("RAYLEIGH", doc="older spelling of VISCOUS=RAYLEIGH"),
            Option("STRUCTURAL", doc="damping in proportion to the internal force, in *STEADY STATE DYNAMICS"),
            _DEFINITION,
        ),
        "first and last mode (first), or frequency in cycles per time, between which values are linear; then the "
        "fraction of critical damping, or alpha and beta (RAYLEIGH), or the structural damping",
    ),
    Keyword(
        "BASE MOTION",
        "Translation of all supports in a step by modes; displacements in the output are those relative to it.",
        Where.STEP,
        (
            Option("DOF", Kind.INTEGER, "global direction, 1 to 3", required=True),
            Option("AMPLITUDE", Kind.NAME, "amplitude, over time or frequency", required=True),
            Option("SCALE", Kind.REAL, "factor of the amplitude (1)"),
            one_of("TYPE", "what moves so", ("ACCELERATION", "VELOCITY", "DISPLACEMENT"), default="ACCELERATION"),
            *HARMONIC,
            *refused("BASE NAME", "LOAD CASE"),
        ),
        data="",
    ),
)
