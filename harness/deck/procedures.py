# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The procedure of a step: *STATIC, *DYNAMIC, *FREQUENCY, *STEADY STATE DYNAMICS, *HEAT TRANSFER and so on.

Defaults are those of the Abaqus Keywords Guide; zero or blank stands for the default everywhere.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from harness.deck.blocks import Block, Row
from harness.deck.prescribed import Prescription
from harness.deck.structure import Scope
from harness.model.perturbations import Frequency, StaticPerturbation, SteadyState
from harness.model.procedures import (
    CoupledTemperatureDisplacement,
    Dynamic,
    HeatTransfer,
    Integrator,
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

_ALWAYS_LINEAR = "FREQUENCY", "STEADY STATE DYNAMICS"
"""Procedures of steps that are linear perturbations, whether these say so or not."""

_POINTS, _MOST_POINTS = 20, 100_000
"""Frequencies of a range: where their number is not given, and how many there can be."""

HALF_INCREMENT_FACTOR = 1e4
"""HALFINC SCALE FACTOR of a model without contact."""


def read_procedure(scope: Scope, prescription: Prescription) -> Procedure:
    """The procedure of a step; DeckError where it has none or several."""
    blocks = [block for block in scope.blocks if block.name in _READERS]
    if not blocks:
        raise scope.head.error("the step has no procedure such as *STATIC")
    if len(blocks) > 1:
        raise blocks[1].error(f"the step has a procedure already, at {blocks[0].source}")
    if scope.head.options.flag("PERTURBATION") and blocks[0].name not in _ALWAYS_LINEAR:
        return _read_perturbation(blocks[0])
    return _READERS[blocks[0].name](blocks[0], prescription)


def _read_perturbation(block: Block) -> StaticPerturbation:
    if block.name != "STATIC":
        raise block.error("is no procedure of a step with PERTURBATION: *STATIC, *FREQUENCY, *STEADY STATE DYNAMICS")
    if any(block.options.given(name) for name in ("DIRECT", "RIKS", "STABILIZE")):
        raise block.error("DIRECT, RIKS and STABILIZE have no meaning in a step with PERTURBATION")
    return StaticPerturbation()


def _only_row(block: Block) -> Row | None:
    rows = list(block.all_rows())
    if len(rows) > 1:
        raise rows[1].error("a second data line, where one is read")
    return rows[0] if rows else None


def _read_times(block: Block, *, largest: float = 1.0, direct: bool = False, along_path: bool = False) -> Times:
    """Increments and period of the data line; `largest` increment as a fraction of the period."""
    row = _only_row(block)
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
    row = _only_row(block)
    if row is not None:
        row.at_most(8 if along_path else 4)
    times = _read_times(block, direct=block.options.flag("DIRECT"), along_path=along_path)
    stabilize = _read_stabilize(block)
    if along_path and stabilize is not None:
        raise block.error("RIKS and STABILIZE exclude each other")
    return Static(*times, _read_riks(row, prescription) if along_path else None, stabilize=stabilize)


def _read_stabilize(block: Block) -> Stabilize | None:
    options = block.options
    if not options.given("STABILIZE"):
        extra = next((name for name in ("FACTOR", "ALLSDTOL") if options.given(name)), None)
        if extra is not None:
            raise block.error(f"{extra} needs STABILIZE")
        return None
    fraction, factor = options.real("STABILIZE", 0.0), options.real("FACTOR", 0.0)
    # damping with a given factor is not adapted unless that is asked for
    limit = options.real("ALLSDTOL", 0.0 if factor else Stabilize().limit)
    if fraction <= 0 or min(factor, limit) < 0:
        raise block.error("STABILIZE must be positive, FACTOR and ALLSDTOL not negative")
    return Stabilize(fraction, factor, limit)


def _read_riks(row: Row | None, prescription: Prescription) -> Riks:
    """Where a step with RIKS ends: entries 5 to 8 of its data line."""
    if row is None:
        return Riks()
    largest = row.real(4, "largest load proportionality factor", 0.0) or None
    if row.blank(5):
        if len(row) > 5:
            raise row.error("a dof and a displacement need a node")
        return Riks(largest)
    nodes = prescription.flat.nodes(row.name(5, "node"), row.source)
    if len(nodes) != 1:
        raise row.error(f"{row.fields[5]} has {len(nodes)} nodes, where one is monitored")
    return Riks(largest, int(nodes[0]), row.integer(6, "dof"), row.real(7, "displacement"))


def _read_visco(block: Block, _: Prescription) -> Visco:
    return Visco(*_read_times(block, direct=block.options.flag("DIRECT")))


def _read_dynamic(block: Block, _: Prescription) -> Dynamic:
    options = block.options
    application = options.text("APPLICATION")
    integrator = options.text("TIME INTEGRATOR") or _INTEGRATORS[application]
    times = _read_times(block, largest=_LARGEST[application], direct=options.flag("DIRECT"))
    transient = application == "TRANSIENT FIDELITY"
    initial = options.flag("INITIAL") if options.given("INITIAL") else transient
    force = options.real("HAFTOL", 0.0)
    factor = options.real("HALFINC SCALE FACTOR", HALF_INCREMENT_FACTOR if transient else math.inf)
    if min(force, factor) < 0:
        raise block.error("HAFTOL and HALFINC SCALE FACTOR must not be negative")
    if options.flag("NOHAF"):
        force, factor = 0.0, math.inf
    common = Dynamic(*times, initial_acceleration=initial, half_increment=factor, half_force=force)
    if integrator == "BWE":
        if any(map(options.given, ("ALPHA", "BETA", "GAMMA"))):
            raise block.error("ALPHA, BETA and GAMMA are of the integrators HHT-TF and HHT-MD, not of backward Euler")
        return replace(common, alpha=0.0, beta=1.0, gamma=1.0, integrator=Integrator.BACKWARD_EULER)
    alpha = options.real("ALPHA", _HHT[integrator])
    if not -0.5 <= alpha <= 0.0:
        raise block.error(f"ALPHA={alpha:g} is outside -0.5 to 0")
    beta = options.real("BETA", (1.0 - alpha) ** 2 / 4.0)
    gamma = options.real("GAMMA", 0.5 - alpha)
    if beta <= 0 or gamma < 0.5:
        raise block.error(f"BETA={beta:g} must be positive and GAMMA={gamma:g} at least 0.5")
    return replace(common, alpha=alpha, beta=beta, gamma=gamma)


def _read_heat_transfer(block: Block, _: Prescription) -> HeatTransfer:
    options = block.options
    steady = options.flag("STEADY STATE")
    largest_change = options.real("DELTMX", 0.0)
    if largest_change < 0:
        raise block.error(f"DELTMX={largest_change:g} must not be negative")
    # without a largest change of temperature a transient step has fixed increments
    fixed = not steady and not largest_change
    end_change, row = 0.0, _only_row(block)
    if options.known("END") and options.text("END") == "SS":
        end_change = row.real(4, "rate of temperature change", 0.0) if row is not None else 0.0
        if end_change <= 0:
            raise block.error("END=SS needs a positive rate of temperature change, entry 5 of the data line")
    kind = HeatTransfer if block.name == HeatTransfer.keyword else CoupledTemperatureDisplacement
    return kind(
        *_read_times(block, direct=fixed),
        steady=steady,
        largest_change=largest_change or math.inf,
        end_change=end_change,
        stabilize=_read_stabilize(block) if options.known("STABILIZE") else None,
    )


def _read_frequency(block: Block, _: Prescription) -> Frequency:
    row = _only_row(block)
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


_READERS: dict[str, Callable[[Block, Prescription], Procedure]] = {
    "STATIC": _read_static,
    "VISCO": _read_visco,
    "DYNAMIC": _read_dynamic,
    "FREQUENCY": _read_frequency,
    "STEADY STATE DYNAMICS": _read_steady_state,
    "HEAT TRANSFER": _read_heat_transfer,
    "COUPLED TEMPERATURE-DISPLACEMENT": _read_heat_transfer,
}
