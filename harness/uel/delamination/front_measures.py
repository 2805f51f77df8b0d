# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures of delaminations in space from fronts, loads and energies: three ways to the energy release rate."""

from __future__ import annotations

import numpy as np

from uel.model.arrays import FloatArray
from uel.output import Result
from uel.output.pictures.front import Front, fronts

GROWN = 0.5
"""Distance from the initial edge beyond which all of a front has left it (mm)."""


LOADED = {"LEVER": (-1.0, 1.0), "MIDSPAN": (-1.0, 1.0), "TOP": (1.0, 2.0)}
"""Node sets under load, as in `uel.delamination.plate_specimens`: their direction along z; ends that move."""


def load(result: Result) -> FloatArray:
    """Load (N), positive the way the specimen is loaded, by increment."""
    name = next(name for name in LOADED if _columns(result, "RF3", name))
    total: FloatArray = np.sum([result.history[column] for column in _columns(result, "RF3", name)], axis=0)
    return LOADED[name][0] * total


def displacement(result: Result) -> FloatArray:
    """Return the displacement (mm) on which the load works, by increment: of a double cantilever beam the opening."""
    name = next(name for name in LOADED if _columns(result, "U3", name))
    sign, ends = LOADED[name]
    return sign * ends * result.history[_columns(result, "U3", name)[0]]


def _columns(result: Result, variable: str, name: str) -> list[str]:
    return [column for column in result.history if column.startswith((f"{variable}[{name}]", f"{variable}[{name}:"))]


def last_front(result: Result) -> Front:
    """Return the longest front of the last increment that has one."""
    found = fronts(result)
    return max((front for front in found if front.time == found[-1].time), key=lambda front: len(front.coordinates))


def grown_fronts(result: Result, crack: float) -> list[Front]:
    """Return the fronts across the specimen that have left the initial edge at `crack` (mm)."""
    return [front for front in fronts(result) if front.coordinates[:, 0].min() > crack + GROWN]


def dissipated_release(result: Result, crack: float, width: float) -> float:
    """Return the energy dissipated per area that the mean front has covered (N/mm), over the second half of its way.

    Parameters
    ----------
    result
        Of a beam with one front, which begins at x = `crack` (mm).
    crack, width
        Length of the initial crack, and width of what is modelled (mm).
    """
    times, places = mean_fronts(result, crack)
    begin = int(np.argmax(places > 0.5 * (places[0] + places[-1])))
    spent = np.interp(times[[begin, -1]], result.history["time"], result.history["ALLPD"])
    return float(np.diff(spent)[0] / (width * (places[-1] - places[begin])))


def compliance_release(result: Result, crack: float, width: float) -> float:
    """Return the energy release rate P^2/(2 B) dC/da of the mean front (N/mm), over the second half of its way.

    Parameters as for `dissipated_release`.
    """
    times, places = mean_fronts(result, crack)
    moved, force = (np.interp(times, result.history["time"], values) for values in (displacement(result), load(result)))
    later = places > 0.5 * (places[0] + places[-1])
    fit = np.polynomial.Polynomial.fit(places[later], (moved / force)[later], 2).deriv()
    return float((force[later] ** 2 / (2.0 * width) * fit(places[later])).mean())


def mean_fronts(result: Result, crack: float) -> tuple[FloatArray, FloatArray]:
    """Return times and mean positions (mm) of the fronts that have left the initial edge."""
    found = grown_fronts(result, crack)
    return np.array([front.time for front in found]), np.array([front.coordinates[:, 0].mean() for front in found])
