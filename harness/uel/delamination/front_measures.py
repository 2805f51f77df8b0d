# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures of delaminations in 3D from fronts, loads and energies: three estimates of the energy release rate."""

from __future__ import annotations

import numpy as np

from uel.model.arrays import FloatArray
from uel.output import Result
from uel.output.pictures.front import Front, fronts

GROWN = 0.5
"""Distance from the initial crack tip beyond which a front counts as grown (mm)."""


LOADED = {"LEVER": (-1.0, 1.0), "MIDSPAN": (-1.0, 1.0), "TOP": (1.0, 2.0)}
"""Node sets under load, as in `uel.delamination.plate_specimens`: sign of the load along z; number of loaded ends."""


def load(result: Result) -> FloatArray:
    """Return the load (N) in the loading direction, by increment."""
    name = next(name for name in LOADED if _columns(result, "RF3", name))
    total: FloatArray = np.sum([result.history[column] for column in _columns(result, "RF3", name)], axis=0)
    return LOADED[name][0] * total


def displacement(result: Result) -> FloatArray:
    """Return the work-conjugate displacement of the load (mm), by increment: for a DCB the opening."""
    name = next(name for name in LOADED if _columns(result, "U3", name))
    sign, ends = LOADED[name]
    return sign * ends * result.history[_columns(result, "U3", name)[0]]


def _columns(result: Result, variable: str, name: str) -> list[str]:
    return [column for column in result.history if column.startswith((f"{variable}[{name}]", f"{variable}[{name}:"))]


def last_front(result: Result) -> Front:
    """Return the longest front of the last increment that has one."""
    all_fronts = fronts(result)
    return max(
        (front for front in all_fronts if front.time == all_fronts[-1].time), key=lambda front: len(front.coordinates)
    )


def grown_fronts(result: Result, crack: float) -> list[Front]:
    """Return the fronts that have grown from the initial crack tip at x = `crack` (mm)."""
    return [front for front in fronts(result) if front.coordinates[:, 0].min() > crack + GROWN]


def dissipated_release(result: Result, crack: float, width: float) -> float:
    """Return the energy dissipated per unit of new crack area (N/mm), over the second half of the crack growth.

    Parameters
    ----------
    result
        Result of a beam with one front, initially at x = `crack` (mm).
    crack, width
        Length of the initial crack, and width of the model (mm).
    """
    times, positions = mean_fronts(result, crack)
    begin = int(np.argmax(positions > 0.5 * (positions[0] + positions[-1])))
    spent = np.interp(times[[begin, -1]], result.history["time"], result.history["ALLPD"])
    return float(np.diff(spent)[0] / (width * (positions[-1] - positions[begin])))


def compliance_release(result: Result, crack: float, width: float) -> float:
    """Return the energy release rate P^2/(2 B) dC/da (N/mm), averaged over the second half of the crack growth.

    Parameters as for `dissipated_release`.
    """
    times, positions = mean_fronts(result, crack)
    deflection, force = (
        np.interp(times, result.history["time"], values) for values in (displacement(result), load(result))
    )
    second_half = positions > 0.5 * (positions[0] + positions[-1])
    fit = np.polynomial.Polynomial.fit(positions[second_half], (deflection / force)[second_half], 2).deriv()
    return float((force[second_half] ** 2 / (2.0 * width) * fit(positions[second_half])).mean())


def mean_fronts(result: Result, crack: float) -> tuple[FloatArray, FloatArray]:
    """Return times and mean x (mm) of the grown fronts."""
    grown = grown_fronts(result, crack)
    return np.array([front.time for front in grown]), np.array([front.coordinates[:, 0].mean() for front in grown])
