# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Average flux of a field, such as the average force, in space and over the increments of a step.

Abaqus Analysis User's Guide, "Convergence criteria for nonlinear problems". What the guide leaves open is inferred from
message files of Abaqus, as the tests show.
"""

from __future__ import annotations

from dataclasses import dataclass

from uel.assembly import Evaluation
from uel.model.controls import FieldControls

INITIAL_FLUX = 1e-2
"""Time average flux of Abaqus before there is any flux in the first step (*CONTROLS, q_0)."""

SMALL_PEAK = 0.1
"""Ratio of the largest element force to its time average. Below it all forces are terms of the average flux; from it on
those below `FluxHistory.floor` are not."""


def spatial_average(evaluation: Evaluation, number: int, history: FluxHistory) -> float:
    """Return the average flux q of a field, by its number, in an iteration: of the moduli of the element forces.

    Those below the floor are left out where the largest one is high enough.
    """
    leaves_out = history.leaves_out(float(evaluation.largest[number]))
    count = (evaluation.flux_count if leaves_out else evaluation.entries)[number]
    return float(evaluation.flux[number] / count) if count else 0.0


@dataclass(frozen=True, slots=True)
class FluxHistory:
    """Converged average fluxes of one field in a step.

    The time average is the plain mean over the increments of the step, the current one included, that carry flux;
    increments of zero flux are skipped. Before any flux it is `initial`. `peaks` sums the largest
    element forces.
    """

    initial: float = INITIAL_FLUX
    total: float = 0.0
    count: int = 0
    peaks: float = 0.0

    def average(self, q: float, controls: FieldControls) -> float:
        """Return the time average flux that includes an average flux q of the current increment."""
        if controls.q_u > 0.0:
            return controls.q_u
        if self._carries(q, controls):
            return (self.total + q) / (self.count + 1)
        return self._mean()

    def converged(self, q: float, controls: FieldControls, peak: float = 0.0) -> FluxHistory:
        """Return the history after an increment that converged with average flux q and largest element force `peak`."""
        if not self._carries(q, controls):
            return self
        return FluxHistory(self.initial, self.total + q, self.count + 1, self.peaks + peak)

    def floor(self, controls: FieldControls) -> float:
        """Return the element nodal force below which it counts as zero in the next increment; -1 before any flux."""
        return controls.eps_l * self.peaks / self.count if self.count else -1.0

    def leaves_out(self, peak: float) -> bool:
        """Return whether element forces below the floor are left out of the average, if the largest force is `peak`."""
        return self.count > 0 and peak >= SMALL_PEAK * self.peaks / self.count

    def next_step(self, controls: FieldControls) -> FluxHistory:
        """Return the history at the start of the next step: q_0 of the controls if set, else the time average."""
        return FluxHistory(controls.q_0 if controls.q_0 > 0.0 else self._mean())

    @property
    def flux_so_far(self) -> float:
        """Time average flux of the converged increments, or of the step before; 0 without any flux."""
        return self._mean() if self.count or self.initial != INITIAL_FLUX else 0.0

    def has_no_estimate(self, controls: FieldControls) -> bool:
        """Return whether the time average is only INITIAL_FLUX: no flux so far, and the controls set none."""
        return not (self.count or controls.q_0 or controls.q_u) and self.initial == INITIAL_FLUX

    def step_has_flux(self, q: float, controls: FieldControls) -> bool:
        """Return whether the current increment, with average flux q, or an earlier one of the step has flux."""
        return self.count > 0 or self._carries(q, controls)

    def _mean(self) -> float:
        return self.total / self.count if self.count else self.initial

    def _carries(self, q: float, controls: FieldControls) -> bool:
        return q > controls.eps * self._mean()
