# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Procedures of general steps, and the table of all procedures, with the linear ones of `perturbations`.

Defaults are those of the Abaqus Keywords Guide; zero or blank means the default.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from uel.deck.language.blocks import Block, Row
from uel.deck.language.structure import Scope
from uel.deck.language.table import Keyword, Kind, Option, Where, ignored, one_of, refused
from uel.deck.steps.modal import with_modes
from uel.deck.steps.perturbations import PERTURBATIONS, read_static_perturbation
from uel.deck.steps.prescribed import Prescription
from uel.model.procedures import (
    CoupledTemperatureDisplacement,
    Diffusive,
    Dynamic,
    Geostatic,
    HeatTransfer,
    Integrator,
    MassDiffusion,
    Procedure,
    Riks,
    Stabilize,
    Static,
    Visco,
)

SMALLEST_FRACTION = 1e-5

_HHT = {"HHT-TF": -0.05, "HHT-MD": -0.41421}
_INTEGRATORS = {"TRANSIENT FIDELITY": "HHT-TF", "MODERATE DISSIPATION": "HHT-MD", "QUASI-STATIC": "BWE"}
_LARGEST = {"TRANSIENT FIDELITY": 0.01, "MODERATE DISSIPATION": 0.1, "QUASI-STATIC": 1.0}
"""Largest increment as a fraction of the period."""

Times = tuple[float, float, float, float, bool]
"""The first entries of `Procedure`."""

HALF_INCREMENT_FACTOR = 1e4
"""HALFINC SCALE FACTOR of a model without contact."""


def read_procedure(scope: Scope, prescription: Prescription) -> Procedure:
    """Read the procedure of a step. Raises DeckError if it has none or several."""
    readers = {keyword.name: read for keyword, read in PROCEDURES}
    blocks = [block for block in scope.blocks if block.name in readers]
    if not blocks:
        raise scope.head.error("the step has no procedure such as *STATIC")
    if len(blocks) > 1:
        raise blocks[1].error(f"the step has a procedure already, at {blocks[0].source}")
    always_linear = [keyword.name for keyword, _ in PERTURBATIONS]
    if scope.head.options.flag("PERTURBATION") and blocks[0].name not in always_linear:
        return with_modes(read_static_perturbation(blocks[0]), scope.blocks, prescription)
    return with_modes(readers[blocks[0].name](blocks[0], prescription), scope.blocks, prescription)


def _read_times(block: Block, *, largest: float = 1.0, direct: bool = False, along_path: bool = False) -> Times:
    """Read increments and period; largest: default of the largest increment over the period. Raises DeckError."""
    row = block.only_row()
    entries = [0.0] * 4
    if row is not None:
        names = ("initial increment", "period", "smallest increment", "largest increment")
        entries = [row.real(index, name, 0.0) for index, name in enumerate(names)]
        if min(entries) < 0:
            raise row.error("increments and period must not be negative")
    period = entries[1] or 1.0
    initial = entries[0] or period * (1.0 if direct else min(largest, 1.0))
    if initial > period:
        assert row is not None
        raise row.error(f"initial increment {initial:g} exceeds the period {period:g}")
    if direct:
        return initial, period, initial, initial, True
    minimum = entries[2] or min(initial, SMALLEST_FRACTION * period)
    maximum = entries[3] or (math.inf if along_path else max(largest * period, initial))
    if not minimum <= initial <= maximum:
        assert row is not None
        range_text = f"{minimum:g} to {maximum:g}"
        raise row.error(f"initial increment {initial:g} is outside the smallest and largest increment, {range_text}")
    return initial, period, minimum, maximum, False


def _read_static(block: Block, prescription: Prescription) -> Static:
    along_path = block.options.flag("RIKS")
    row = block.only_row()
    if row is not None:
        row.at_most(8 if along_path else 4)
    times = _read_times(block, direct=block.options.flag("DIRECT"), along_path=along_path)
    stabilize = _read_stabilize(block)
    if along_path and stabilize is not None:
        raise block.error("RIKS and STABILIZE exclude each other")
    return Static(*times, _read_riks(row, prescription) if along_path else None, stabilize=stabilize)


def _read_stabilize(block: Block) -> Stabilize | None:
    options = block.options
    if not options.has("STABILIZE"):
        extra = next((name for name in ("FACTOR", "ALLSDTOL") if options.has(name)), None)
        if extra is not None:
            raise block.error(f"{extra} needs STABILIZE")
        return None
    fraction, factor = options.real("STABILIZE", 0.0), options.real("FACTOR", 0.0)
    # with FACTOR damping is adaptive only with ALLSDTOL
    limit = options.real("ALLSDTOL", 0.0 if factor else Stabilize().limit)
    if fraction <= 0 or min(factor, limit) < 0:
        raise block.error("STABILIZE must be positive, FACTOR and ALLSDTOL not negative")
    return Stabilize(fraction, factor, limit)


def _read_riks(row: Row | None, prescription: Prescription) -> Riks:
    """Read the end of a step with RIKS: entries 5 to 8 of its data line. Raises DeckError."""
    if row is None:
        return Riks()
    largest = row.real(4, "largest load proportionality factor", 0.0) or None
    if row.blank(5):
        if len(row) > 5:
            raise row.error("a dof and a displacement need a node")
        return Riks(largest)
    node = prescription.flat.one_node(row.name(5, "node"), row.fields[5], row)
    return Riks(largest, node, row.integer(6, "dof"), row.real(7, "displacement"))


def _read_visco(block: Block, _: Prescription) -> Visco:
    tolerance = block.not_negative("CETOL", 0.0)
    # without a tolerance increments are fixed
    times = _read_times(block, direct=block.options.flag("DIRECT") or not tolerance)
    return Visco(*times, tolerance=tolerance or math.inf)


def _read_geostatic(_block: Block, _: Prescription) -> Geostatic:
    return Geostatic(minimum=1.0, direct=True)


def _read_dynamic(block: Block, _: Prescription) -> Dynamic:
    options = block.options
    application = options.text("APPLICATION")
    integrator = options.text("TIME INTEGRATOR") or _INTEGRATORS[application]
    times = _read_times(block, largest=_LARGEST[application], direct=options.flag("DIRECT"))
    transient = application == "TRANSIENT FIDELITY"
    initial = options.flag("INITIAL") if options.has("INITIAL") else transient
    force = options.real("HAFTOL", 0.0)
    factor = options.real("HALFINC SCALE FACTOR", HALF_INCREMENT_FACTOR if transient else math.inf)
    if min(force, factor) < 0:
        raise block.error("HAFTOL and HALFINC SCALE FACTOR must not be negative")
    if options.flag("NOHAF"):
        force, factor = 0.0, math.inf
    common = Dynamic(*times, initial_acceleration=initial, half_increment=factor, half_force=force)
    if integrator == "BWE":
        if any(map(options.has, ("ALPHA", "BETA", "GAMMA"))):
            raise block.error("ALPHA, BETA and GAMMA are for the integrators HHT-TF and HHT-MD, not for backward Euler")
        return replace(common, alpha=0.0, beta=1.0, gamma=1.0, integrator=Integrator.BACKWARD_EULER)
    alpha = options.real("ALPHA", _HHT[integrator])
    if not -0.5 <= alpha <= 0.0:
        raise block.error(f"ALPHA={alpha:g} is outside -0.5 to 0")
    beta = options.real("BETA", (1.0 - alpha) ** 2 / 4.0)
    gamma = options.real("GAMMA", 0.5 - alpha)
    if beta <= 0 or gamma < 0.5:
        raise block.error(f"BETA={beta:g} must be positive and GAMMA={gamma:g} at least 0.5")
    return replace(common, alpha=alpha, beta=beta, gamma=gamma)


_DIFFUSIVE: tuple[type[Diffusive], ...] = (HeatTransfer, CoupledTemperatureDisplacement, MassDiffusion)


def _read_diffusive(block: Block, _: Prescription) -> Diffusive:
    options = block.options
    kind = next(kind for kind in _DIFFUSIVE if kind.keyword == block.name)
    steady = options.flag("STEADY STATE")
    largest_change = block.not_negative(kind.limit, 0.0)
    # without a largest change a transient step has fixed increments
    fixed = not steady and not largest_change
    end_change, row = 0.0, block.only_row()
    if options.known("END") and options.text("END") == "SS":
        end_change = row.real(4, f"rate of {kind.unknown} change", 0.0) if row is not None else 0.0
        if end_change <= 0:
            raise block.error(f"END=SS needs a positive rate of {kind.unknown} change, entry 5 of the data line")
    return kind(
        *_read_times(block, direct=fixed),
        steady=steady,
        largest_change=largest_change or math.inf,
        end_change=end_change,
        stabilize=_read_stabilize(block) if options.known("STABILIZE") else None,
    )


_TIMES = "initial increment, period (1), smallest increment, largest increment"
_DIRECT = Option("DIRECT", doc="fixed increments")
_HEAT = (
    Option("STEADY STATE", doc="no storage of heat: time is a scale for loads"),
    Option(
        "DELTMX",
        Kind.REAL,
        "largest change of temperature in an increment; without it increments are fixed",
    ),
)
_STABILIZE = (
    Option(
        "STABILIZE",
        Kind.REAL,
        "viscous forces on the masses of built-in elements; fraction of energy that they dissipate at first",
        bare="0.0002",
    ),
    Option("FACTOR", Kind.REAL, "damping factor in place of the fraction"),
    Option("ALLSDTOL", Kind.REAL, "largest ratio of ALLSD to ALLSE (0.05; 0 with FACTOR: no limit)", bare="0.05"),
    one_of("CONTINUE", "factors of the step before", ("NO",), default="NO", refused=("YES",), bare="YES"),
)

PROCEDURES: tuple[tuple[Keyword, Callable[[Block, Prescription], Procedure]], ...] = (
    (
        Keyword(
            "STATIC",
            "Static stress analysis.",
            Where.STEP,
            (
                _DIRECT,
                Option("RIKS", doc="the load factor is part of the solution; increments are arc lengths"),
                *_STABILIZE,
                *refused("ADIABATIC", "FULLY PLASTIC", "LONG TERM"),
            ),
            f"{_TIMES}; with RIKS also the largest load proportionality factor, and a node, its dof and the "
            "displacement that ends the step",
        ),
        _read_static,
    ),
    (
        Keyword(
            "VISCO",
            "Static stress analysis on a real time scale: *CREEP and *VISCOELASTIC are active.",
            Where.STEP,
            (
                Option(
                    "CETOL",
                    Kind.REAL,
                    "largest change of a creep or viscous strain rate in an increment times its length; without it "
                    "increments are fixed",
                ),
                _DIRECT,
                *refused("CREEP", "FACTOR", "STABILIZE", "ALLSDTOL", "CONTINUE"),
            ),
            _TIMES,
        ),
        _read_visco,
    ),
    (
        Keyword(
            "GEOSTATIC",
            "Equilibrium of initial stresses with the loads of the step, in one increment. Displacements that are left "
            "show how far the stresses were from it.",
            Where.STEP,
            refused("UTOL", "HEAT"),
        ),
        _read_geostatic,
    ),
    (
        Keyword(
            "DYNAMIC",
            "Dynamic analysis by implicit integration.",
            Where.STEP,
            (
                _DIRECT,
                one_of(
                    "APPLICATION",
                    "sets the integrator and the largest increment: 1/100, 1/10 and all of the period",
                    ("TRANSIENT FIDELITY", "MODERATE DISSIPATION", "QUASI-STATIC"),
                    default="TRANSIENT FIDELITY",
                ),
                one_of(
                    "TIME INTEGRATOR",
                    "Hilber, Hughes and Taylor with alpha -0.05 or -0.41421, or backward Euler",
                    ("HHT-TF", "HHT-MD", "BWE"),
                ),
                Option("ALPHA", Kind.REAL, "-0.5 to 0: numerical damping"),
                Option("BETA", Kind.REAL, "of the integrator, (1 - alpha)^2/4"),
                Option("GAMMA", Kind.REAL, "of the integrator, 1/2 - alpha"),
                Option("INITIAL", Kind.SWITCH, "compute accelerations at the start; YES for transient fidelity"),
                Option("HAFTOL", Kind.REAL, "tolerance of the half-increment residual, a force"),
                Option("HALFINC SCALE FACTOR", Kind.REAL, "the same over the time average force (10000)"),
                Option("NOHAF", doc="no half-increment residual"),
                *ignored("IMPACT", "INCREMENTATION"),
                *refused("ADIABATIC", "EXPLICIT", "SUBSPACE", "SINGULAR MASS", "NONLINEAR MODE"),
            ),
            _TIMES,
        ),
        _read_dynamic,
    ),
    (
        Keyword(
            "HEAT TRANSFER",
            "Uncoupled heat transfer, for user elements with dof 11 and up.",
            Where.STEP,
            (*_HEAT, one_of("END", "end of a transient step", ("PERIOD", "SS")), *refused("MXDEM")),
            f"{_TIMES}; rate of temperature change that ends a step with END=SS",
        ),
        _read_diffusive,
    ),
    (
        Keyword(
            "MASS DIFFUSION",
            "Diffusion of one material through another, in heat transfer elements: dof 11 is the normalized "
            "concentration.",
            Where.STEP,
            (
                Option("STEADY STATE", doc="nothing is stored: time is a scale for loads"),
                Option(
                    "DCMAX",
                    Kind.REAL,
                    "largest change of a normalized concentration in an increment; without it increments are fixed",
                ),
                one_of("END", "end of a transient step", ("PERIOD", "SS")),
            ),
            f"{_TIMES}; rate of change of normalized concentrations that ends a step with END=SS",
        ),
        _read_diffusive,
    ),
    (
        Keyword(
            "COUPLED TEMPERATURE-DISPLACEMENT",
            "Temperatures and displacements together, for user elements with dof 11 and up, CPE4T, C3D8T and so on.",
            Where.STEP,
            (
                *_HEAT,
                *_STABILIZE,
                one_of("CREEP", "no material here creeps: accepted and without effect", ("NONE",)),
                *ignored("CETOL"),
                *refused("ELECTRICAL"),
            ),
            _TIMES,
        ),
        _read_diffusive,
    ),
    *PERTURBATIONS,
)
"""Keywords and their readers, which get the block and the prescription, and raise DeckError."""

KEYWORDS = tuple(keyword for keyword, _ in PROCEDURES)
