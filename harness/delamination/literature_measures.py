# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures of the runs of the benchmarks of the literature, from the front and the history."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from harness.delamination import literature
from harness.model.arrays import FloatArray
from harness.output import Result
from harness.output.front import Front, fronts


def last_front(result: Result) -> Front:
    """The longest front of the last increment that has one."""
    found = fronts(result)
    return max((front for front in found if front.time == found[-1].time), key=lambda front: len(front.places))


def mid_width_loads(result: Result) -> dict[float, float]:
    """Load (N) by the crack length (mm) of the benchmark, which is that of the front in the middle of the width.

    The front is straight at first: the load at the initial length is the largest one.
    """
    load = 2.0 * _reaction(result)
    lengths, loads = [], []
    for front in fronts(result):
        middle = np.argmin(front.places[:, 1])
        lengths.append(front.places[middle, 0])
        loads.append(np.interp(front.time, result.history["time"], load))
    known = [length for length in literature.DCB_CRITICAL if lengths[0] < length < lengths[-1]]
    values = np.interp(known, lengths, loads)
    return {literature.DCB_CRACK: float(load.max())} | dict(zip(known, values.tolist(), strict=True))


def loads_at_openings(result: Result) -> dict[float, float]:
    """Load (N) at the displacements of the benchmark that were reached, by its crack length (mm)."""
    name = next(name for name in result.history if name.startswith("U3[TOP:"))
    opening, load = result.history[name], 2.0 * _reaction(result)
    return {
        length: float(np.interp(displacement, opening, load))
        for length, (displacement, _) in literature.DCB_CRITICAL.items()
        if displacement <= opening[-1]
    }


def mid_width_deviation(result: Result) -> float:
    """Largest relative deviation of `mid_width_loads` from the benchmark."""
    loads = mid_width_loads(result)
    return max(abs(load / literature.DCB_CRITICAL[length][1] - 1.0) for length, load in loads.items())


def opening_deviation(result: Result) -> float:
    """Largest relative deviation of `loads_at_openings` from the benchmark."""
    loads = loads_at_openings(result)
    return max(abs(load / literature.DCB_CRITICAL[length][1] - 1.0) for length, load in loads.items())


def thumbnail(result: Result) -> float:
    """Distance (mm) by which the front is ahead in the middle of the width, at the end."""
    return float(np.ptp(last_front(result).places[:, 0]))


def front_release(result: Result) -> float:
    """Mean of the energy release rate along the front (N/mm), at the end."""
    return float(last_front(result).releases.sum(axis=1).mean())


def dissipated_release(result: Result) -> float:
    """Energy dissipated per area that the mean front has covered (N/mm), over the second half of its way."""
    times, places = _mean_front(result)
    begin = int(np.argmax(places > 0.5 * (places[0] + places[-1])))
    spent = np.interp(times[[begin, -1]], result.history["time"], result.history["ALLPD"])
    return float(np.diff(spent)[0] / (0.5 * literature.DCB_WIDTH * (places[-1] - places[begin])))


def compliance_release(result: Result) -> float:
    """Energy release rate P^2/(2 B) dC/da of the mean front (N/mm), over the second half of its way."""
    times, places = _mean_front(result)
    history = result.history
    name = next(name for name in history if name.startswith("U3[TOP:"))
    load = np.interp(times, history["time"], 2.0 * _reaction(result))
    compliance = 2.0 * np.interp(times, history["time"], history[name]) / load
    later = places > 0.5 * (places[0] + places[-1])
    fit = np.polynomial.Polynomial.fit(places[later], compliance[later], 2).deriv()
    releases = load[later] ** 2 / (2.0 * literature.DCB_WIDTH) * fit(places[later])
    return float(releases.mean())


def _mean_front(result: Result) -> tuple[FloatArray, FloatArray]:
    """Times and mean positions (mm) of the fronts that have left the initial edge."""
    found = [front for front in fronts(result) if front.places[:, 0].min() > literature.DCB_CRACK + 0.5]
    return np.array([front.time for front in found]), np.array([front.places[:, 0].mean() for front in found])


def first_mode_mix(result: Result) -> float:
    """G_II/G where the crack has just begun to grow: on the first front."""
    releases = fronts(result)[0].releases.mean(axis=0)
    return float(releases[1:].sum() / releases.sum())


def circle_radii(result: Result) -> list[tuple[float, float, float]]:
    """Radius of the front (mm), load and corrected closed form (N), by increment of the field output."""
    rows = []
    history = result.history
    name = next(name for name in history if name.startswith("U3[TOP:"))
    for front in fronts(result):
        radius = float(np.hypot(*front.places[:, :2].T).mean())
        load = 4.0 * float(np.interp(front.time, history["time"], _reaction(result)))
        opening = float(np.interp(front.time, history["time"], history[name]))
        # the clamped plate of the same compliance
        clamped = np.sqrt(16.0 * np.pi * literature.circle_bending() * opening / load)
        rows.append((radius, load, literature.circle_load() * float(np.sqrt(radius / clamped))))
    return rows


def circle_deviation(result: Result) -> float:
    """Relative deviation of the load from the closed form, at the end."""
    return circle_radii(result)[-1][1] / literature.circle_load() - 1.0


def corrected_circle_deviation(result: Result) -> float:
    """Largest relative deviation from the closed form with the compliance of the rim, once the front has moved 2 mm."""
    grown = [row for row in circle_radii(result) if row[0] > literature.CIRCLE_CRACK + 2.0]
    return max(abs(load / corrected - 1.0) for _, load, corrected in grown)


def circle_roundness(result: Result) -> float:
    """Largest less smallest radius of the front at the end (mm)."""
    return float(np.ptp(np.hypot(*last_front(result).places[:, :2].T)))


def _reaction(result: Result) -> FloatArray:
    """Sum of the reactions on TOP (N), by increment."""
    total: FloatArray = np.sum(
        [values for name, values in result.history.items() if name.startswith("RF3[TOP:")], axis=0
    )
    return total


MEASURES: dict[str, Callable[[Result], float]] = {
    function.__name__: function
    for function in (
        *(
            mid_width_deviation,
            opening_deviation,
            thumbnail,
            front_release,
            dissipated_release,
            compliance_release,
            first_mode_mix,
        ),
        *(circle_deviation, corrected_circle_deviation, circle_roundness),
    )
}
