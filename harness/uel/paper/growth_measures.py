# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures of delaminations that grow, from their tips or fronts in the last step."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from uel.model.arrays import FloatArray
from uel.output import Result
from uel.output.pictures.front import fronts
from uel.output.pictures.growth import growth
from uel.paper.literature import CIRCLE_CRACK

START: Final = 4.0
"""Growth before the process zone has its final shape (mm)."""
SETTLED: Final = 1.2
"""The same of the circular delamination (mm)."""
REST: Final = 1.0
"""Length at the end that the process zone ahead of the tip may reach (mm)."""
PLATEAU: Final = (15.0, 30.0)
"""Growth in which bridging fibres have their final length (mm)."""


def steady_rate(result: Result) -> float:
    """Return the growth (mm/cycle) between START and the last place."""
    return growth(result).between(START, np.inf).rate


def release_1(result: Result) -> float:
    """Return the mean energy release rate of mode I (N/mm), as `release_2` in mode II."""
    return float(growth(result).between(START, np.inf).release[:, 0].mean())


def release_2(result: Result) -> float:
    """Return the mean energy release rate of mode II between START and the last place (N/mm)."""
    return float(growth(result).between(START, np.inf).release[:, 1].mean())


def growth_exponent(result: Result) -> float:
    """Return the slope of the growth over the energy release rate, in logarithms, from START to REST before the end."""
    whole = growth(result)
    release, rate = whole.between(START, whole.length[-1] - REST).line
    rising = rate > 0.0
    return float(np.polyfit(np.log(release[rising]), np.log(rate[rising]), 1)[0])


def plateau_release(result: Result) -> float:
    """Return the mean energy release rate (N/mm) in PLATEAU."""
    return float(growth(result).between(*PLATEAU).release.sum(axis=1).mean())


def circle_growth(result: Result) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return cycles, mean radius (mm) and mean G (N/mm) of a circular delamination, from SETTLED mm of growth on."""
    rows = np.array(
        [
            (front.time, np.hypot(*front.coordinates[:, :2].T).mean(), front.releases.sum(axis=1).mean())
            for front in fronts(result)
            if front.step == result.status[-1].step and front.line == 1
        ]
    )
    cycles, radius, release = rows[rows[:, 1] > CIRCLE_CRACK + SETTLED].T
    return cycles, radius, release


def circle_rate(result: Result) -> float:
    """Return the growth of the radius (mm/cycle) of a circular delamination."""
    cycles, radius, _ = circle_growth(result)
    return float(np.polyfit(cycles, radius, 1)[0])


def circle_release(result: Result) -> float:
    """Return the mean energy release rate (N/mm) of a circular delamination."""
    return float(circle_growth(result)[2].mean())


MEASURES: Final[dict[str, Callable[[Result], float]]] = {
    function.__name__: function
    for function in (steady_rate, release_1, release_2, growth_exponent, plateau_release, circle_rate, circle_release)
}
