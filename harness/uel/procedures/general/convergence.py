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
