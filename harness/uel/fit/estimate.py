# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Least squares between a measured curve and runs, with what the runs near the solution say about its certainty."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import t as student

from uel.errors import UelError
from uel.fit.curve import Measurement
from uel.fit.variables import Variable
from uel.model.arrays import FloatArray

STEP = 0.05
"""Relative step of the differences: far above the teeth that single failing points give to a curve."""
TOLERANCE = 3e-3
"""Relative change of the parameters, and of the sum of squares, at which the search ends."""
LOOK = 2.0
"""Distance, as part of the half-width of the confidence interval, at which a search that has converged looks for
smaller differences: the teeth of a curve make local minima."""
MOST_LOOK = 0.5
"""Half-width, in the logarithm, from which on a variable is so uncertain that nothing is looked for."""
LEVEL = 0.95
"""Level of the confidence intervals."""

CONVERGED = "converged"
"""Reasons why the search ended, if it has converged."""

Curves = Callable[[Sequence[FloatArray]], list[FloatArray]]
"""Curves (n,) of runs with these values (k,) of the variables, several at a time."""


@dataclass(frozen=True, slots=True)
class Fit:
    """A fitted curve.

    values       (k,) of the variables
    intervals    (k, 2) confidence intervals, as long as the errors of the points are independent; from 0 or so to
                 1e100 where the curve does not depend on the variable
    sensitivity  (n, k) change of the curve for each variable, as part of its value
    correlation  (k, k) of the variables
    curve, start (n,) fitted curve, and that of the start
    deviation    root of the mean square between curve and measurement
    ended        why the search ended
    """

    values: FloatArray
    intervals: FloatArray
    sensitivity: FloatArray
    correlation: FloatArray
    curve: FloatArray
    start: FloatArray
    deviation: float
    ended: str


class _SpentError(Exception):
    """Error of a search for which no runs are left."""


class _Search:
    """Residuals and their derivatives for the logarithms of the variables, from runs made side by side."""

    def __init__(
        self,
        measured: Measurement,
        variables: Sequence[Variable],
        curves: Curves,
        limit: int,
        tell: Callable[[str], None],
    ) -> None:
        self._measured, self._variables, self._curves, self._tell = measured, variables, curves, tell
        self._bounds = tuple(np.log([getattr(v, name) for v in variables]) for name in ("low", "high"))
        self._left = limit
        self._scale = float(np.abs(measured.y).max())
        self._known: dict[bytes, tuple[FloatArray, FloatArray]] = {}
        self.best: FloatArray | None = None
        self._least = np.inf

    def residual(self, logarithms: FloatArray) -> FloatArray:
        """Return the differences (n,), as part of the largest measured value."""
        return self._at(logarithms)[0]

    def jacobian(self, logarithms: FloatArray) -> FloatArray:
        """Return the derivatives (n, k) of the residuals."""
        return self._at(logarithms)[1]

    def look_around(self, distances: FloatArray) -> FloatArray | None:
        """Return a point with smaller squares than the best one, at distances (k,) on both sides.

        None without any, or without enough runs.
        """
        assert self.best is not None
        steps = [row for row in np.diag(distances) if row.any()]
        points = [np.clip(self.best + sign * row, *self._bounds) for row in steps for sign in (-1.0, 1.0)]
        if self._left < len(points):
            return None
        self._left -= len(points)
        curves = self._curves([np.exp(point) for point in points])
        squares = [float(np.sum(((curve - self._measured.y) / self._scale) ** 2)) for curve in curves]
        least = int(np.argmin(squares)) if squares else -1
        return points[least] if squares and squares[least] < self._least else None

    def uncertainty(self) -> tuple[FloatArray, FloatArray]:
        """Return the covariance (k, k) at the best point, and the half-widths (k,) of the confidence intervals."""
        assert self.best is not None
        residual, slopes = self._at(self.best)
        freedom = len(residual) - len(self.best)
        covariance = _covariance(slopes, float(residual @ residual) / freedom)
        return covariance, student.ppf(0.5 * (1.0 + LEVEL), freedom) * np.sqrt(np.diag(covariance))

    def _at(self, logarithms: FloatArray) -> tuple[FloatArray, FloatArray]:
        key = logarithms.tobytes()
        if key not in self._known:
            if self._left <= len(logarithms):
                raise _SpentError
            self._left -= 1 + len(logarithms)
            low, high = self._bounds
            size = np.minimum(STEP, 0.5 * (high - low))
            steps = np.where(logarithms + size <= high, size, -size)
            points = [logarithms, *(logarithms + row for row in np.diag(steps))]
            base, *moved = self._curves([np.exp(point) for point in points])
            residual = (base - self._measured.y) / self._scale
            slopes = np.column_stack([(curve - base) / step for curve, step in zip(moved, steps, strict=True)])
            self._known[key] = residual, slopes / self._scale
            if (squares := float(residual @ residual)) < self._least:
                self.best, self._least = logarithms.copy(), squares
            named = zip(self._variables, np.exp(logarithms), strict=True)
            off = np.sqrt(squares / len(residual))
            self._tell(f"{', '.join(f'{v.name} = {value:.6g}' for v, value in named)}: off by {off:.2%} of the peak")
        return self._known[key]


def fit_curve(
    measured: Measurement,
    variables: Sequence[Variable],
    curves: Curves,
    *,
    limit: int,
    tell: Callable[[str], None],
) -> Fit:
    """Fit the variables, on logarithmic scales: a trust-region method within the bounds, derivatives by differences.

    Parameters
    ----------
    measured, variables
        More points than variables.
    curves
        Makes runs.
    limit
        Largest number of runs.
    tell
        Gets a line for each step of the search.

    Raises
    ------
    UelError
        A run cannot be compared, the limit does not suffice for one step, or there are too few points.
    """
    count, unknowns = len(measured.x), len(variables)
    if count <= unknowns:
        raise UelError(f"{count} points for {unknowns} parameters: expected more points than parameters")
    search = _Search(measured, variables, curves, limit, tell)
    start, low, high = (np.log([getattr(v, name) for v in variables]) for name in ("start", "low", "high"))
    begin: FloatArray | None = start
    try:
        while begin is not None:
            solution = least_squares(
                search.residual, begin, search.jacobian, bounds=(low, high), xtol=TOLERANCE, ftol=TOLERANCE, gtol=1e-12
            )
            ended = CONVERGED if solution.success else solution.message
            _, half = search.uncertainty()
            begin = search.look_around(np.where(half < MOST_LOOK, LOOK * half, 0.0)) if solution.success else None
    except _SpentError:
        ended = f"the limit of {limit} runs"
    if search.best is None:
        raise UelError(f"{limit} runs do not suffice for one step of the search: expected at least {unknowns + 1}")
    residual, slopes = search.residual(search.best), search.jacobian(search.best)
    scale = float(np.abs(measured.y).max())
    covariance, half = search.uncertainty()
    values, spread = np.exp(search.best), np.sqrt(np.diag(covariance))
    # beyond a factor of 1e100 nothing is known
    width = np.exp(np.minimum(half, 230.0))
    known = np.isfinite(spread) & (spread > 0.0)
    correlation = np.eye(unknowns)
    inner = np.ix_(known, known)
    correlation[inner] = covariance[inner] / np.outer(spread[known], spread[known])
    return Fit(
        values=values,
        intervals=np.column_stack([values / width, values * width]),
        sensitivity=slopes * scale,
        correlation=correlation,
        curve=measured.y + residual * scale,
        start=measured.y + search.residual(start) * scale,
        deviation=float(np.sqrt(residual @ residual / count)) * scale,
        ended=ended,
    )


def _covariance(slopes: FloatArray, variance: float) -> FloatArray:
    """Return the covariance (k, k) of the variables; infinite for those on which nothing depends."""
    covariance = np.diag(np.full(slopes.shape[1], np.inf))
    moving = np.linalg.norm(slopes, axis=0) > 1e-9
    inner = slopes[:, moving]
    covariance[np.ix_(moving, moving)] = variance * np.linalg.pinv(inner.T @ inner)
    return covariance
