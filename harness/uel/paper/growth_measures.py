# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures of delaminations that grow, from their tips or fronts in the last step."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from uel.model.arrays import FloatArray
from uel.output import Result
from uel.output.pictures.front import DAMAGE, fronts
from uel.output.pictures.tips import tips
from uel.paper.literature import CIRCLE_CRACK

START: Final = 4.0
"""Growth before the process zone has its final shape (mm)."""
SETTLED: Final = 1.2
"""The same of the circular delamination (mm)."""
REST: Final = 1.0
"""Length at the end that the process zone ahead of the tip may reach (mm)."""
PLATEAU: Final = (15.0, 30.0)
"""Growth in which bridging fibres have their final length (mm)."""
SPACING: Final = 4
"""Increments with field output over which a rate is taken: a tip passes elements in small waves."""


@dataclass(frozen=True, slots=True)
class Growth:
    """Tip of a delamination in the increments with field output.

    cycles   (n,) total time
    length   (n,) damaged length
    release  (n, 2) G_I, G_II
    """

    cycles: FloatArray
    length: FloatArray
    release: FloatArray

    def between(self, low: float, high: float) -> Growth:
        """Return the part in which the length is between two values."""
        rows = (self.length > low) & (self.length < high)
        return Growth(self.cycles[rows], self.length[rows], self.release[rows])

    @property
    def rate(self) -> float:
        """Slope of the length over the cycles."""
        return float(np.polyfit(self.cycles, self.length, 1)[0])

    @property
    def line(self) -> tuple[FloatArray, FloatArray]:
        """Energy release rates and growth over SPACING increments, (n,) each."""
        grown = self.length[SPACING:] - self.length[:-SPACING]
        total = self.release.sum(axis=1)
        return np.sqrt(total[SPACING:] * total[:-SPACING]), grown / (self.cycles[SPACING:] - self.cycles[:-SPACING])


def growth(result: Result) -> Growth:
    """Return the growth of the first tip in the last step."""
    found = [tip for tip in tips(result, DAMAGE) if tip.step == result.status[-1].step and tip.line == tip.number == 1]
    rows = np.array([(tip.time, tip.length, *tip.release) for tip in found])
    return Growth(rows[:, 0], rows[:, 1], rows[:, 2:])


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
