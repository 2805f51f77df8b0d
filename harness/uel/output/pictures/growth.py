# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Growth of a delamination in the plane under cycles, from its tip in the step of cycles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from uel.errors import UelError
from uel.model.arrays import FloatArray
from uel.output.pictures.front import DAMAGE
from uel.output.pictures.tips import tips
from uel.output.results import Result

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
    """Return the growth of the delamination in the last step.

    Raises
    ------
    UelError
        The job has no interface elements in the plane that have a damage, or several tips in the last step.
    """
    step = result.status[-1].step
    last = [tip for tip in tips(result, DAMAGE) if tip.step == step]
    count = len({(tip.line, tip.number) for tip in last})
    if count > 1:
        raise UelError(f"{result.file('.pvd')}: {count} tips of delaminations in step {step}, expected one")
    rows = np.array([(tip.time, tip.length, *tip.release) for tip in last]).reshape(-1, 4)
    return Growth(rows[:, 0], rows[:, 1], rows[:, 2:])
