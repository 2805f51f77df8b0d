# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Linear perturbation procedures: *FREQUENCY, *BUCKLE, *STEADY STATE DYNAMICS, and *STATIC in a step with
PERTURBATION.
"""

from __future__ import annotations

import math

import numpy as np

from harness.deck.blocks import Block, Row
from harness.deck.prescribed import Prescription
from harness.deck.table import Keyword, Option, Where, ignored, one_of, refused
from harness.model.perturbations import Buckle, Frequency, StaticPerturbation, SteadyState

_POINTS, _MOST_POINTS = 20, 100_000
"""Frequencies of a range: where their number is not given, and how many there can be."""


def read_static_perturbation(block: Block) -> StaticPerturbation:
    """*STATIC of a step with PERTURBATION. Raises DeckError for another procedure."""
    if block.name != "STATIC":
        raise block.error(
            "not supported in a step with PERTURBATION; expected *STATIC, *FREQUENCY, *BUCKLE or *STEADY STATE DYNAMICS"
        )
    if any(block.options.given(name) for name in ("DIRECT", "RIKS", "STABILIZE")):
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
    row = block.only_row()
    if row is None:
        raise block.error("needs a data line with the number of eigenvalues")
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
    logarithmic = block.options.text("FREQUENCY SCALE") == "LOGARITHMIC"
    frequencies = [frequency for row in block.rows() for frequency in _read_range(row, logarithmic=logarithmic)]
    if not frequencies:
        raise block.error("needs a data line with a frequency, or the limits of a range of frequencies")
    return SteadyState(frequencies=tuple(frequencies), undamped=block.options.flag("REAL ONLY"))


def _read_range(row: Row, *, logarithmic: bool) -> list[float]:
    """Frequencies of a data line, closer to the ends of the range the larger the bias parameter."""
    row.at_most(4)
    lowest, highest = row.real(0, "lower limit of the frequency range"), row.real(1, "upper limit", 0.0)
    number, bias = row.integer(2, "number of points", _POINTS), row.real(3, "bias parameter", 1.0) or 1.0
    if lowest < 0 or (lowest == 0 and logarithmic and highest):
        raise row.error(f"frequency {lowest:g} must be positive (from 0 on with FREQUENCY SCALE=LINEAR)")
    if not highest:
        return [lowest]
    if highest <= lowest:
        raise row.error(f"the upper limit {highest:g} is not above the lower one, {lowest:g}")
    if bias < 0:
        raise row.error(f"bias parameter {bias:g} must be positive")
    if number > _MOST_POINTS:
        raise row.error(f"number of points {number} is above {_MOST_POINTS}")
    # Abaqus Analysis User's Guide, "Direct-solution steady-state dynamic analysis", the bias parameter
    place = np.linspace(-1.0, 1.0, number if number > 1 else _POINTS)
    place = 0.5 + 0.5 * np.sign(place) * np.abs(place) ** (1.0 / bias)
    inside = lowest * (highest / lowest) ** place if logarithmic else lowest + (highest - lowest) * place
    return [lowest, *inside[1:-1].tolist(), highest]


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
            "unstable, by the initial stress matrix of built-in solids, shells, trusses and SPRINGA and the load "
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
            "Response to harmonic loads, about the state at the end of the last general step.",
            Where.STEP,
            (
                Option("DIRECT", doc="by the matrices of the model, not by its modes", required=True),
                one_of("FREQUENCY SCALE", "of the points of a range", ("LOGARITHMIC", "LINEAR"), default="LOGARITHMIC"),
                one_of(
                    "INTERVAL",
                    "what the points divide",
                    ("RANGE",),
                    default="RANGE",
                    refused=("EIGENFREQUENCY", "SPREAD"),
                ),
                Option("REAL ONLY", doc="leave damping out"),
                *ignored("FRICTION DAMPING"),
                *refused("SUBSPACE PROJECTION", "DAMPING CHANGE", "STIFFNESS CHANGE"),
            ),
            "lowest and highest frequency (cycles per time; 0: the lowest alone), number of points (20), bias (1)",
        ),
        _read_steady_state,
    ),
)
"""Keywords of steps that are linear perturbations, whether these say so or not, and their readers."""
