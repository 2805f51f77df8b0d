# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Linear perturbation procedures: *FREQUENCY, *BUCKLE, *STEADY STATE DYNAMICS, *MODAL DYNAMIC, and *STATIC in a step
with PERTURBATION.
"""

from __future__ import annotations

import math

from uel.deck.language.blocks import Block, Row
from uel.deck.language.table import Keyword, Option, Where, ignored, one_of, refused
from uel.deck.steps.prescribed import Prescription
from uel.model.modal import FrequencyRange
from uel.model.perturbations import (
    Buckle,
    Frequency,
    ModalDynamic,
    ModalSteadyState,
    StaticPerturbation,
    SteadyState,
    SubspaceSteadyState,
)

_POINTS, _MOST_POINTS = 20, 100_000
"""Default and largest number of frequencies of an interval; the largest number of increments too."""


def read_static_perturbation(block: Block) -> StaticPerturbation:
    """Read *STATIC of a step with PERTURBATION. Raises DeckError for another procedure."""
    if block.name != "STATIC":
        raise block.error(
            "not supported in a step with PERTURBATION; expected *STATIC, *FREQUENCY, *BUCKLE, *STEADY STATE DYNAMICS "
            "or *MODAL DYNAMIC"
        )
    if any(block.options.has(name) for name in ("DIRECT", "RIKS", "STABILIZE")):
        raise block.error("DIRECT, RIKS and STABILIZE have no meaning in a step with PERTURBATION")
    return StaticPerturbation()


def _read_frequency(block: Block, _: Prescription) -> Frequency:
    row = block.only_row()
    number, lowest, highest = 0, -math.inf, math.inf
    if row is not None:
        number = row.integer(0, "number of eigenvalues", 0)
        lowest = row.real(1, "lowest frequency", lowest)
        highest = row.real(2, "highest frequency", highest)
        if any(not row.blank(index) for index in range(3, len(row))):
            raise row.error("a shift point and sizes of blocks are not supported")
    if number < 0 or not (number or math.isfinite(highest)):
        raise block.error("needs a number of eigenvalues, or a highest frequency")
    if lowest >= highest:
        raise block.error(f"the lowest frequency {lowest:g} is not below the highest, {highest:g}")
    by_mass = block.options.text("NORMALIZATION") == "MASS"
    return Frequency(number=number, lowest=lowest, highest=highest, by_mass=by_mass)


def _read_buckle(block: Block, _: Prescription) -> Buckle:
    row = block.required_row("the number of eigenvalues")
    lanczos = block.options.text("EIGENSOLVER") == "LANCZOS"
    row.at_most(5 if lanczos else 4)
    number, lowest = row.integer(0, "number of eigenvalues"), -math.inf
    if number < 1:
        raise row.error(f"number of eigenvalues {number} must be positive")
    if lanczos:
        lowest = row.real(1, "lowest eigenvalue", lowest)
    highest = row.real(2 if lanczos else 1, "highest eigenvalue", math.inf)
    if lowest >= highest:
        raise row.error(f"the lowest eigenvalue {lowest:g} is not below the highest, {highest:g}")
    return Buckle(number=number, lowest=lowest, highest=highest)


def _read_steady_state(block: Block, _: Prescription) -> SteadyState:
    options = block.options
    kinds = [name for name in ("DIRECT", "SUBSPACE PROJECTION", "MODE BASED") if options.has(name)]
    if len(kinds) > 1:
        raise block.error(f"{' and '.join(kinds)} exclude each other")
    direct, projected = kinds == ["DIRECT"], kinds == ["SUBSPACE PROJECTION"]
    undamped = options.flag("REAL ONLY")
    if undamped and not (direct or projected):
        raise block.error("REAL ONLY needs DIRECT or SUBSPACE PROJECTION; without *MODAL DAMPING modes are not damped")
    # modal procedures divide the ranges at natural frequencies by default
    natural = (options.text("INTERVAL") or ("RANGE" if direct else "EIGENFREQUENCY")) == "EIGENFREQUENCY"
    logarithmic = options.text("FREQUENCY SCALE") == "LOGARITHMIC"
    rows = block.required_rows("a frequency, or the limits of a range of frequencies")
    ranges = tuple(_read_range(row, logarithmic=logarithmic, natural=natural) for row in rows)
    kind = SteadyState if direct else SubspaceSteadyState if projected else ModalSteadyState
    return kind(ranges=ranges, natural=natural, undamped=undamped)


def _read_range(row: Row, *, logarithmic: bool, natural: bool) -> FrequencyRange:
    """Read a frequency range from a data line. Raises DeckError."""
    row.at_most(5 if natural else 4)
    lowest, highest = row.real(0, "lower limit of the frequency range"), row.real(1, "upper limit", 0.0)
    number = row.integer(2, "number of points", _POINTS)
    bias = row.real(3, "bias parameter", 0.0) or (3.0 if natural else 1.0)
    factor = row.real(4, "frequency scale factor", 1.0)
    if lowest < 0 or (lowest == 0 and logarithmic and highest):
        raise row.error(f"frequency {lowest:g} must be positive (from 0 on with FREQUENCY SCALE=LINEAR)")
    if highest and highest <= lowest:
        raise row.error(f"the upper limit {highest:g} is not above the lower one, {lowest:g}")
    if bias < 0:
        raise row.error(f"bias parameter {bias:g} must be positive")
    if factor <= 0:
        raise row.error(f"frequency scale factor {factor:g} must be positive")
    if number > _MOST_POINTS:
        raise row.error(f"number of points {number} is above {_MOST_POINTS}")
    return FrequencyRange(lowest, highest, number if number > 1 else _POINTS, bias, factor, logarithmic)


def _read_modal_dynamic(block: Block, _: Prescription) -> ModalDynamic:
    row = block.required_row("the time increment and the period")
    row.at_most(2)
    increment, period = row.real(0, "time increment"), row.real(1, "period")
    if not 0 < increment <= period:
        raise row.error(f"expected 0 < time increment <= period, found {increment:g} and {period:g}")
    if period / increment > _MOST_POINTS:
        raise row.error(f"the period has more than {_MOST_POINTS} increments")
    return ModalDynamic(initial=increment, period=period, minimum=increment, maximum=increment)


PERTURBATIONS = (
    (
        Keyword(
            "FREQUENCY",
            "Natural frequencies about the state at the end of the last general step.",
            Where.STEP,
            (
                one_of("EIGENSOLVER", "how", ("LANCZOS",), default="LANCZOS", refused=("SUBSPACE", "AMS")),
                one_of(
                    "NORMALIZATION",
                    "of the shapes: largest displacement, or generalized mass, of one",
                    ("DISPLACEMENT", "MASS"),
                    default="DISPLACEMENT",
                ),
                *ignored("ACOUSTIC COUPLING", "NUMBER INTERVAL", "SIM"),
                *refused(
                    *("BIAS", "DAMPING PROJECTION", "NSET", "PROPERTY EVALUATION", "RESIDUAL MODES", "USER BOUNDARY"),
                    *("INTERNAL MODES", "TOL"),
                ),
            ),
            "number of eigenvalues, lowest and highest frequency (cycles per time)",
        ),
        _read_frequency,
    ),
    (
        Keyword(
            "BUCKLE",
            "Loads, as factors of those of the step, at which the state at the end of the last general step becomes "
            "unstable, by the initial stress matrix of built-in solids, shells, beams, trusses and SPRINGA and the "
            "stiffness of pressures. The tractions of COH elements do not turn; elements with temperatures, and user "
            "elements, are refused.",
            Where.STEP,
            (
                one_of(
                    "EIGENSOLVER",
                    "what the data line has, not how the eigenvalues are found",
                    ("SUBSPACE", "LANCZOS"),
                    default="SUBSPACE",
                ),
            ),
            "number of eigenvalues, highest eigenvalue, vectors, iterations; with LANCZOS number, lowest and highest "
            "eigenvalue, block size, steps. Vectors, iterations, block size and steps do not count",
        ),
        _read_buckle,
    ),
    (
        Keyword(
            "STEADY STATE DYNAMICS",
            "Response to harmonic loads, about the state at the end of the last general step. By modes the supports "
            "are those of *FREQUENCY, and reactions leave out the damping.",
            Where.STEP,
            (
                Option("DIRECT", doc="by the matrices of the model, not by modes of an earlier *FREQUENCY"),
                one_of(
                    "SUBSPACE PROJECTION",
                    "by the matrices of the model, at each frequency, acting on modes alone",
                    ("ALL FREQUENCIES",),
                    refused=("CONSTANT", "EIGENFREQUENCY", "PROPERTY CHANGE", "RANGE"),
                    bare="ALL FREQUENCIES",
                ),
                one_of(
                    "MODE BASED",
                    "by modes, each for itself, which is the default",
                    ("CONVENTIONAL",),
                    refused=("SPECTRAL",),
                    bare="CONVENTIONAL",
                ),
                one_of("FREQUENCY SCALE", "of the points of a range", ("LOGARITHMIC", "LINEAR"), default="LOGARITHMIC"),
                one_of(
                    "INTERVAL",
                    "what the points divide: the range (default with DIRECT), or the intervals between the natural "
                    "frequencies in it (default without)",
                    ("RANGE", "EIGENFREQUENCY"),
                    refused=("SPREAD",),
                ),
                Option("REAL ONLY", doc="leave damping out"),
                *ignored("FRICTION DAMPING"),
                *refused("DAMPING CHANGE", "STIFFNESS CHANGE"),
            ),
            "lowest and highest frequency (cycles per time; 0: the lowest alone), number of points (20), bias (1; 3 "
            "with INTERVAL=EIGENFREQUENCY), and with that a factor of the points inside the range (1)",
        ),
        _read_steady_state,
    ),
    (
        Keyword(
            "MODAL DYNAMIC",
            "Response over time by modes of an earlier *FREQUENCY, exact for loads that are linear in each increment. "
            "It starts at rest, or with the initial velocities.",
            Where.STEP,
            (
                one_of(
                    "CONTINUE", "starts where the step before ends", ("NO",), default="NO", refused=("YES",), bare="YES"
                ),
            ),
            "time increment, period",
        ),
        _read_modal_dynamic,
    ),
)
"""Keywords of procedures that are always linear perturbations, and their readers."""
