# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Convergence of an iteration: the criteria of Abaqus/Standard for one field, as pure functions.

Abaqus Analysis User's Guide, "Convergence criteria for nonlinear problems". What the guide leaves open (which mean,
which residual the estimate of the correction uses) is inferred from message files of Abaqus, as the tests show.
"""

from __future__ import annotations

from dataclasses import dataclass

from uel.model.controls import FieldControls
from uel.model.records import Convergence

INITIAL_FLUX = 1e-2
"""Time average flux of Abaqus before there is any flux in the first step (*CONTROLS, q_0)."""

SMALL_PEAK = 0.1
"""Ratio of the largest element force to its time average. Below it all forces are terms of the average flux; from it on
those below `FluxHistory.floor` are not."""


@dataclass(frozen=True, slots=True)
class FieldMeasures:
    """Measures for the convergence of one field in one iteration; all values are magnitudes.

    q, q_time   average flux and its time average
    r           largest residual; r_previous that of the previous iteration, in iteration 1 that of the extrapolated
                start, None without an extrapolation
    du, c       largest increment and largest correction
    iteration   from 1
    """

    q: float
    q_time: float
    r: float
    r_previous: float | None
    du: float
    c: float
    iteration: int


def residual_tolerance(check: FieldMeasures, controls: FieldControls, i_p: int) -> float:
    """Return the tolerance of the residual: R_n q~, and R_P q~ after I_P iterations."""
    return (controls.r_n if check.iteration <= i_p else controls.r_p) * check.q_time


def estimated_correction(check: FieldMeasures) -> float | None:
    """Return the correction expected of one more iteration, c r_i / r_(i-1); None without an earlier residual."""
    if not check.r_previous:
        return None
    return check.c * check.r / check.r_previous


def judge(check: FieldMeasures, controls: FieldControls, i_p: int) -> Convergence:
    """Return the verdict on one field.

    Parameters
    ----------
    check
        Fluxes, residuals, increment and correction.
    controls
        R_n, C_n, R_P, eps, C_eps, R_l of the field.
    i_p
        Iterations after which R_P replaces R_n.
    """
    zero = controls.eps * check.q_time
    if check.q <= zero and (check.r <= zero or check.c <= controls.c_eps * check.du):
        return Convergence.ZERO_FLUX
    if check.r <= controls.r_l * check.q_time:
        # Abaqus prints later iterations as converged, even if the correction is as large as the increment
        return Convergence.LINEAR if check.iteration == 1 else Convergence.CONVERGED
    if check.r > residual_tolerance(check, controls, i_p):
        return Convergence.NOT_ACHIEVED
    allowed = controls.c_n * check.du
    if check.c <= allowed:
        return Convergence.CONVERGED
    estimate = estimated_correction(check)
    if estimate is not None and estimate <= allowed:
        return Convergence.ACCEPTED_ESTIMATE
    return Convergence.CORRECTION_TOO_LARGE


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
