# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A measured Paris line, growth over the energy release rate, and that of a run with FATIGUE."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from uel.deck import read_deck
from uel.errors import DeckError, UelError, UsageError
from uel.fit.curve import Points
from uel.fit.logarithmic import LogarithmicMeasurement
from uel.model.arrays import FloatArray
from uel.model.properties import UserProperty
from uel.output import Result
from uel.output.pictures.column import Column
from uel.output.pictures.growth import SPACING, growth
from uel.usersub.layout import PLANE, element_layouts

RELEASE: Final = Column("G")
"""Energy release rate, the sum of GI and GII of `uel front`."""
RATE: Final = Column("RATE")
"""Growth per cycle, as `uel front` names it."""
FEWEST: Final = 3
"""Rates of a run that make a line."""
EDGE: Final = 1e-6
"""Part of an energy release rate by which a file may round it."""


@dataclass(frozen=True, slots=True)
class ParisLine(LogarithmicMeasurement):
    """A measured Paris line.

    x      (n,) energy release rates, rising
    y      (n,) logarithm of the growth
    after  growth of the crack in the step of cycles that is left out
    """

    after: float = 0.0

    def of_result(self, result: Result, job: str) -> FloatArray:
        """Return the logarithms of the growth (n,) of a run at x, on a line between its increments.

        G falls or rises in the run, once the process zone has formed: what comes before its largest or smallest value
        is left out.

        Raises
        ------
        UelError
            The run has no tip in the plane, or several, no growth, or no such G as the points.
        """
        whole = growth(result)
        if len(whole.length):
            whole = whole.between(whole.length[0] + self.after, np.inf)
        release, rate = whole.line
        if len(release):
            falls = release[-1] < np.median(release)
            first = int(np.argmax(release) if falls else np.argmin(release))
            release, rate = release[first:], rate[first:]
        growing = rate > 0.0
        release, rate = self.columns[0].factor * release[growing], self.columns[1].factor * rate[growing]
        if len(release) < FEWEST:
            raise UelError(
                f"{job}: {len(release)} rates of growth over {SPACING} increments with field output each, expected at "
                f"least {FEWEST}: more cycles, or a smaller FREQUENCY"
            )
        low, high = release.min(), release.max()
        if self.x[0] < low * (1.0 - EDGE) or self.x[-1] > high * (1.0 + EDGE):
            raise UelError(
                f"{job}: the crack grows at {self.columns[0]} from {low:.4g} to {high:.4g}, the measured points are "
                f"from {self.x[0]:.4g} to {self.x[-1]:.4g}: leave points out, or change the load or number of cycles"
            )
        order = np.argsort(release)
        return np.asarray(np.interp(np.log(self.x), np.log(release[order]), np.log(rate[order])))


def paris_line(points: Points, after: float) -> ParisLine:
    """Return points as a Paris line, in the order of G.

    Raises
    ------
    UsageError
        The first column is not G, or a factor is negative.
    DeckError
        A point is not above 0.
    """
    release, rate = points.columns
    if not release.names(RELEASE.name):
        raise UsageError(f"'{release}': expected G, the energy release rate, over which RATE is measured")
    if min(release.factor, rate.factor) < 0.0:
        raise UsageError(f"'{release}', '{rate}': expected factors above 0")
    for values, source in zip(points.values, points.sources, strict=True):
        if not values.min() > 0.0:
            raise DeckError(source, f"expected numbers above 0, found {values[0]:g}, {values[1]:g}")
    x, y = points.values[np.argsort(points.values[:, 0], kind="stable")].T
    named = replace(release, name=RELEASE.name), replace(rate, name=RATE.name)
    return ParisLine(x, np.log(y), named, after)


def check_cycles(deck: Path) -> None:
    """Check that the last step of a deck is one of cycles of elements in the plane.

    Raises UsageError if not, and DeckError if the deck cannot be read.
    """
    model = read_deck(deck)
    for group in model.groups:
        layout = None if group.definition is None else element_layouts().get(group.definition.number)
        if layout is None or layout.dimension != PLANE or not isinstance(group.section, UserProperty):
            continue
        position = next((item.position for item in layout.integers if item.name == "FATIGUE"), 0)
        if position and 0 < group.section.integers[position - 1] <= len(model.steps):
            return
    raise UsageError(
        f"{deck}: RATE is growth per cycle: expected interface elements in the plane with FATIGUE, the step from which "
        "time is the number of cycles"
    )
