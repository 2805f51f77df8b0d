# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Sizes of increments, and cutbacks of attempts.

Abaqus Analysis User's Guide, "Commonly used control parameters" and "Convergence criteria for nonlinear problems".
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from uel.model.controls import TimeControls
from uel.model.procedures import Procedure
from uel.model.restart import Saved

DIVERGING = "THE SOLUTION APPEARS TO BE DIVERGING. CONVERGENCE IS JUDGED UNLIKELY."
TOO_SLOW = "THE RATE OF CONVERGENCE IS VERY SLOW. CONVERGENCE IS JUDGED UNLIKELY."
TOO_MANY_ITERATIONS = "THE SOLUTION FAILS TO CONVERGE IN THE MAXIMUM NUMBER OF EQUILIBRIUM ITERATIONS ALLOWED."

DISCONTINUOUS = "SUBDIVISION AFTER {} ITERATIONS FOR SEVERE DISCONTINUITIES"

DISTORTED = "ELEMENTS ARE DISTORTING EXCESSIVELY. CONVERGENCE IS JUDGED UNLIKELY."

BELOW_MINIMUM = "TIME INCREMENT REQUIRED IS LESS THAN THE MINIMUM SPECIFIED"
TOO_MANY_ATTEMPTS = "TOO MANY ATTEMPTS MADE FOR THIS INCREMENT"
FIXED_TOO_LARGE = "FIXED TIME INCREMENT IS TOO LARGE"
TOO_MANY_INCREMENTS = "TOO MANY INCREMENTS NEEDED TO COMPLETE THE STEP"

UNTOUCHED = 1e10
"""Smallest PNEWDT that counts as the large value on entry, which no user element has set."""

_END = 1e-6
"""Remainder of the step over the increment that is added to it, because sums of increments round."""

_ROUNDING = 1e-12
"""Rounding of a sum of increments, relative to it."""


@dataclass(frozen=True, slots=True)
class Cutback:
    """Cutback of an attempt for a `reason`, in Abaqus' words, to `factor` times the increment.

    cause  addition to the error that ends the job if no attempt is left; '' for none
    """

    factor: float
    reason: str
    cause: str = ""


ALIKE = 1e-6
"""Relative difference of residuals that counts as none.

If two states alternate, their residuals differ only by rounding, which must not decide how the attempt ends. This
counts as divergence: Abaqus cuts the increment to a quarter (abaqus_inputs/dcb_3d)."""


def judge_rate(iteration: int, residuals: Sequence[float], tolerance: float, controls: TimeControls) -> Cutback | None:
    """Return a cutback for a field whose residual is too large, None to continue iterating.

    Parameters
    ----------
    iteration
        i, from 1.
    residuals
        Largest residual of each iteration so far, r_1 to r_i.
    tolerance
        R_n q~.

    Returns
    -------
    Cutback | None
        From iteration I_0 on: if the residuals of two iterations in a row are not below that of the one before. From
        I_R on: if more than I_C iterations are needed at the rate of convergence of the last iteration.
    """
    if iteration >= controls.i_0 and len(residuals) > 2 and min(residuals[-2:]) > (1.0 - ALIKE) * residuals[-3]:
        return Cutback(controls.d_f, DIVERGING)
    if iteration >= controls.i_r and len(residuals) > 1:
        needed = math.inf
        if residuals[-1] < residuals[-2] and tolerance > 0.0:
            needed = iteration + math.log(tolerance / residuals[-1]) / math.log(residuals[-1] / residuals[-2])
        if needed > controls.i_c:
            return Cutback(controls.d_c, TOO_SLOW)
    return None


def out_of_iterations(iteration: int, controls: TimeControls) -> Cutback | None:
    """Return the cutback after iteration I_C."""
    return Cutback(controls.d_c, TOO_MANY_ITERATIONS) if iteration >= controls.i_c else None


def too_discontinuous(severe: int, controls: TimeControls, *, convert: bool) -> Cutback | None:
    """Return the cutback after I_S severe discontinuity iterations, I_S^c with CONVERT SDI=YES."""
    most = controls.i_s_c if convert else controls.i_s
    return Cutback(controls.d_s, DISCONTINUOUS.format(severe)) if severe >= most else None


@dataclass(frozen=True, slots=True)
class Accuracy:
    """Accuracy of the integration over time in an increment.

    measure    error over its tolerance; above 1 the increment is too large
    complaint  message of Abaqus in that case
    """

    measure: float
    complaint: str


def pnewdt_cutback(pnewdt: float) -> Cutback | None:
    """Return a cutback if a user element requests a smaller increment, PNEWDT < 1."""
    if pnewdt >= 1.0:
        return None
    return Cutback(pnewdt, f"A USER ELEMENT REQUESTS A SMALLER TIME INCREMENT, PNEWDT = {pnewdt:.4g}")


class IncrementControl:
    """Increment sizes of one step, automatic or direct.

    The sequence of a step is: `attempt`, then either `cut_back` and the next `attempt`, or `converged`.
    """

    def __init__(self, procedure: Procedure, controls: TimeControls) -> None:
        self._procedure = procedure
        self._controls = controls
        self._size = procedure.initial if procedure.direct else min(procedure.initial, procedure.maximum)
        self._easy = 0
        self._measures: list[tuple[float, float]] = []
        self._max_growth = float(getattr(controls, procedure.growth))
        self._whole: tuple[float, float] | None = None
        # response of the last attempt that converged, and of all of them so far
        self._linear = self._always_linear = True
        self.in_parts = False
        self.attempts = 0

    def kept(self) -> Saved:
        """Return the data for the sizes of later increments, for *RESTART; no increment is in parts."""
        measures = [list(pair) for pair in self._measures]
        return {"size": self._size, "easy": self._easy, "measures": measures, "linear": self._always_linear}

    def resume(self, saved: Saved) -> None:
        """Restore what `kept` returned."""
        self._size, self._easy, self._always_linear = saved["size"], saved["easy"], saved["linear"]
        self._measures = [(measure, size) for measure, size in saved["measures"]]

    def part(self, end: float) -> bool:
        """Divide the current increment, up to step time `end`, into parts sized by `cut_back`; False if not allowed.

        Increments after `end` have the size of the whole one again. If a part fails, the rest is one increment.
        """
        if self._procedure.direct or self._whole:
            return False
        self._whole, self.in_parts = (end, self._size), True
        return True

    def attempt(self, step_time: float) -> float:
        """Return the size of the next attempt from `step_time`; the last increment ends at the period."""
        self.attempts += 1
        if self._whole and self._complete(step_time, self._whole[0]):
            self._size, self._whole, self.in_parts = self._whole[1], None, False
        self._size = self.next_size(step_time)
        return self._size

    def next_size(self, step_time: float) -> float:
        """Return the size of an increment from `step_time`; 0 at the end of the step."""
        end, size = self._procedure.period, self._size
        if self._whole:
            end, size = (end, self._whole[1]) if self._complete(step_time, self._whole[0]) else (self._whole[0], size)
        left = end - step_time
        return max(left, 0.0) if left <= size * (1.0 + _END) else size

    def cut_back(self, cutback: Cutback) -> tuple[float, str]:
        """Return the size of the next attempt after a failed one and ''; 0 and an error if the job ends.

        I_A cutbacks are allowed, thus I_A + 1 attempts.
        """
        self._measures = []
        if self._procedure.direct:
            return 0.0, FIXED_TOO_LARGE
        if self.attempts > self._controls.i_a:
            return 0.0, TOO_MANY_ATTEMPTS
        if self.in_parts and self._whole and self._size < self._whole[1]:
            self._size, self.in_parts = self._whole[1], False
            return self._size, ""
        self._size *= cutback.factor
        if self._size < self._procedure.minimum:
            return 0.0, BELOW_MINIMUM
        return self._size, ""

    def too_inaccurate(self, accuracy: Accuracy | None, *, linear: bool) -> Cutback | None:
        """Return a cutback if the integration over time is too inaccurate, unless increments are fixed.

        linear: the response was linear in this attempt, which has converged.
        """
        self._linear, self._always_linear = linear, self._always_linear and linear
        if accuracy is None or accuracy.measure <= 1.0 or self._procedure.direct:
            return None
        return Cutback(self._controls.d_a / accuracy.measure, accuracy.complaint)

    def converged(
        self,
        iterations: int,
        pnewdt: float,
        *,
        searched: bool = False,
        accuracy: Accuracy | None = None,
        disturbed: bool = False,
    ) -> None:
        """Choose the size of the next increment.

        Parameters
        ----------
        iterations
            Equilibrium iterations of the attempt that converged.
        pnewdt
            Smallest PNEWDT of its last iteration: if set and above 1, the ratio of the next increment to this one.
        searched
            The descent search took part, so that the number of iterations does not matter.
        accuracy
            Accuracy of the integration over time; if measured, it determines the growth.
        disturbed
            There were more than I_J severe discontinuity iterations, I_J^c with CONVERT SDI=YES.
        """
        # a cutback does not reset the count: Abaqus grows right after one if the converged attempts were easy
        self._easy = self._easy + 1 if iterations <= self._controls.i_g and not disturbed else 0
        self.attempts = 0
        if self._procedure.direct or self.in_parts:
            return
        if iterations > self._controls.i_l and not searched:
            self._size *= self._controls.d_b
        elif 1.0 < pnewdt < UNTOUCHED:
            self._size *= pnewdt
        elif accuracy is not None:
            self._size *= self._growth_by_accuracy(accuracy.measure)
        elif self._easy >= 2:
            self._size *= min(self._controls.d_d, self._max_growth)
        self._size = min(max(self._size, self._procedure.minimum), self._procedure.maximum)

    def _growth_by_accuracy(self, measure: float) -> float:
        """Return D_G over the measure if the last I_T measures, scaled to this size, are at most W_G; else 1.

        It is at most D_M, or D_D if the response was not linear. A step that was linear in all attempts keeps its
        matrix, thus its size, unless the growth is at least D_L D_M.
        """
        controls = self._controls
        self._measures = [*self._measures, (measure, self._size)][-controls.i_t :]
        largest = max(earlier * self._size / size for earlier, size in self._measures)
        if len(self._measures) < controls.i_t or largest > controls.w_g:
            return 1.0
        most = self._max_growth if self._linear else min(self._max_growth, controls.d_d)
        growth = most if measure == 0.0 else min(most, controls.d_g / measure)
        return growth if growth >= (controls.d_l * most if self._always_linear else 1.0) else 1.0

    def finished(self, step_time: float) -> bool:
        """Return whether the period is reached."""
        return self._complete(step_time, self._procedure.period)

    @staticmethod
    def _complete(step_time: float, end: float) -> bool:
        return step_time >= end * (1.0 - _ROUNDING)
