# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures of the runs of the benchmarks of the literature, from the front and the history."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from uel.delamination import front_measures
from uel.delamination.front_measures import displacement, last_front, load
from uel.output import Result
from uel.output.pictures.front import fronts
from uel.paper import literature


def mid_width_loads(result: Result) -> dict[float, float]:
    """Load (N) by the crack length (mm) of the benchmark, which is that of the front in the middle of the width.

    The front is straight at first: the load at the initial length is the largest one.
    """
    curve = 2.0 * load(result)
    lengths, loads = [], []
    for front in fronts(result):
        middle = np.argmin(front.coordinates[:, 1])
        lengths.append(front.coordinates[middle, 0])
        loads.append(np.interp(front.time, result.history["time"], curve))
    known = [length for length in literature.DCB_CRITICAL if lengths[0] < length < lengths[-1]]
    values = np.interp(known, lengths, loads)
    return {literature.DCB_CRACK: float(curve.max())} | dict(zip(known, values.tolist(), strict=True))


def loads_at_openings(result: Result) -> dict[float, float]:
    """Load (N) at the displacements of the benchmark that were reached, by its crack length (mm)."""
    opening, curve = 0.5 * displacement(result), 2.0 * load(result)
    return {
        length: float(np.interp(critical, opening, curve))
        for length, (critical, _) in literature.DCB_CRITICAL.items()
        if critical <= opening[-1]
    }


def loads_at_compliances(result: Result) -> dict[float, float]:
    """Load (N) at the compliances of the benchmark that were reached, by its crack length (mm).

    A straight crack of that length has this compliance, whatever the shape of the front and of its process zone.
    """
    opening, curve = 0.5 * displacement(result), 2.0 * load(result)
    # a running crack: before the largest load the compliance is that of the initial length
    grown = slice(int(curve.argmax()), None)
    compliances = np.maximum.accumulate(opening[grown] / curve[grown])
    critical = {length: moved / force for length, (moved, force) in literature.DCB_CRITICAL.items()}
    return {
        length: float(np.interp(compliance, compliances, curve[grown]))
        for length, compliance in critical.items()
        if compliances[0] <= compliance <= compliances[-1]
    }


def mid_width_deviation(result: Result) -> float:
    """Return the largest relative deviation of `mid_width_loads` from the benchmark."""
    loads = mid_width_loads(result)
    return max(abs(load / literature.DCB_CRITICAL[length][1] - 1.0) for length, load in loads.items())


def opening_deviation(result: Result) -> float:
    """Return the largest relative deviation of `loads_at_openings` from the benchmark."""
    loads = loads_at_openings(result)
    return max(abs(load / literature.DCB_CRITICAL[length][1] - 1.0) for length, load in loads.items())


def compliance_deviation(result: Result) -> float:
    """Return the largest relative deviation of `loads_at_compliances` from the benchmark."""
    loads = loads_at_compliances(result)
    return max(abs(load / literature.DCB_CRITICAL[length][1] - 1.0) for length, load in loads.items())


def thumbnail(result: Result) -> float:
    """Return the distance (mm) by which the front is ahead in the middle of the width, at the end."""
    return float(np.ptp(last_front(result).coordinates[:, 0]))


def front_release(result: Result) -> float:
    """Return the mean of the energy release rate along the front (N/mm), at the end."""
    return float(last_front(result).releases.sum(axis=1).mean())


def dissipated_release(result: Result) -> float:
    """Return the energy dissipated per area that the mean front has covered (N/mm), over the second half of its way."""
    return front_measures.dissipated_release(result, literature.DCB_CRACK, 0.5 * literature.DCB_WIDTH)


def compliance_release(result: Result) -> float:
    """Return the energy release rate P^2/(2 B) dC/da of the mean front (N/mm), over the second half of its way."""
    return front_measures.compliance_release(result, literature.DCB_CRACK, 0.5 * literature.DCB_WIDTH)


def first_mode_mix(result: Result) -> float:
    """Return G_II/G where the crack has just begun to grow: on the first front."""
    releases = fronts(result)[0].releases.mean(axis=0)
    return float(releases[1:].sum() / releases.sum())


def circle_radii(result: Result) -> list[tuple[float, float, float]]:
    """Return the radius of the front (mm), load and corrected closed form (N), by increment of the field output."""
    rows = []
    times, distances, loads = result.history["time"], displacement(result), load(result)
    for front in fronts(result):
        radius = float(np.hypot(*front.coordinates[:, :2].T).mean())
        force = 4.0 * float(np.interp(front.time, times, loads))
        opening = 0.5 * float(np.interp(front.time, times, distances))
        # the clamped plate of the same compliance
        clamped = np.sqrt(16.0 * np.pi * literature.circle_bending() * opening / force)
        rows.append((radius, force, literature.circle_load() * float(np.sqrt(radius / clamped))))
    return rows


def circle_deviation(result: Result) -> float:
    """Return the relative deviation of the load from the closed form, at the end."""
    return circle_radii(result)[-1][1] / literature.circle_load() - 1.0


def corrected_circle_deviation(result: Result) -> float:
    """Return the largest relative deviation from the closed form with the rim's compliance, once 2 mm are covered."""
    grown = [row for row in circle_radii(result) if row[0] > literature.CIRCLE_CRACK + 2.0]
    return max(abs(load / corrected - 1.0) for _, load, corrected in grown)


def circle_roundness(result: Result) -> float:
    """Return the largest less smallest radius of the front at the end (mm)."""
    return float(np.ptp(np.hypot(*last_front(result).coordinates[:, :2].T)))


MEASURES: dict[str, Callable[[Result], float]] = {
    function.__name__: function
    for function in (
        *(
            mid_width_deviation,
            opening_deviation,
            compliance_deviation,
            thumbnail,
            front_release,
            dissipated_release,
            compliance_release,
            first_mode_mix,
        ),
        *(circle_deviation, corrected_circle_deviation, circle_roundness),
    )
}
