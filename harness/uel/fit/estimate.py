# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Least squares between a measured curve and runs, with what the runs near the solution say about its certainty."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from uel.errors import UelError
from uel.fit.curve import Measurement
from uel.fit.uncertainty import ROUNDING, Uncertainty, assess, covariance_of, half_widths
from uel.fit.variables import Variable, coordinates, values_at
from uel.model.arrays import FloatArray

STEP = 0.05
"""Relative step of the differences: far above the teeth that single failing points give to a curve."""
TOLERANCE = 3e-3
"""Relative change of the parameters, and of the sum of squares, at which the search ends."""
LOOK = 2.0
"""Distance, as part of the half-width of the confidence interval, at which a search that has converged looks for
smaller differences: the teeth of a curve make local minima."""
MOST_LOOK = 0.5
"""Half-width, in the coordinate, from which on a variable is so uncertain that nothing is looked for."""
CONVERGED = "converged"
"""Reasons why the search ended, if it has converged."""

Curves = Callable[[Sequence[FloatArray]], list[FloatArray]]
"""Curves (n,) of runs with these values (k,) of the variables, several at a time."""


@dataclass(frozen=True, slots=True)
class Fit:
    """A fitted curve.

    values       (k,) of the variables
    certainty    how certain they are, if the search has converged
    sensitivity  (n, k) change of the curve for each variable, in its coordinate
    curve, start (n,) fitted curve, and that of the start
    deviation    root of the mean square between curve and measurement
    ended        why the search ended
    """

    values: FloatArray
    certainty: Uncertainty
    sensitivity: FloatArray
    curve: FloatArray
    start: FloatArray
    deviation: float
    ended: str

    @property
    def converged(self) -> bool:
        """True if the search has converged."""
        return self.ended == CONVERGED

    @property
    def reliable(self) -> bool:
        """True if the intervals hold: the search has converged between the bounds, and left noise."""
        return self.converged and self.certainty.noise and not self.certainty.bounds.any()


class _SpentError(Exception):
    """Error of a search for which no runs are left."""


class _Search:
    """Residuals and their derivatives for the coordinates of the variables, from runs made side by side."""

    def __init__(
        self,
        measured: Measurement,
        variables: Sequence[Variable],
        curves: Curves,
        limit: int,
        tell: Callable[[str], None],
    ) -> None:
        self._measured, self._variables, self._curves, self._tell = measured, variables, curves, tell
        self._bounds = tuple(coordinates(variables, name) for name in ("low", "high"))
        self._left = limit
        self._scale = measured.scale
        self._known: dict[bytes, tuple[FloatArray, FloatArray]] = {}
        self.best: FloatArray | None = None
        self._least = np.inf

    def residual(self, point: FloatArray) -> FloatArray:
        """Return the differences (n,), as part of the scale of the measurement."""
        return self._at(point)[0]

    def jacobian(self, point: FloatArray) -> FloatArray:
        """Return the derivatives (n, k) of the residuals."""
        return self._at(point)[1]

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
        curves = self._curves([values_at(self._variables, point) for point in points])
        squares = [float(np.sum(((curve - self._measured.y) / self._scale) ** 2)) for curve in curves]
        least = int(np.argmin(squares)) if squares else -1
        return points[least] if squares and squares[least] < self._least else None

    def likelihood(self) -> tuple[FloatArray, FloatArray, int]:
        """Return second (k, k) and first (k,) derivatives of the negative log-likelihood, and degrees of freedom."""
        assert self.best is not None
        residual, slopes = self._at(self.best)
        freedom = len(residual) - len(self.best)
        variance = max(float(residual @ residual) / freedom, ROUNDING**2)
        return slopes.T @ slopes / variance, slopes.T @ residual / variance, freedom

    def _at(self, point: FloatArray) -> tuple[FloatArray, FloatArray]:
        key = point.tobytes()
        if key not in self._known:
            if self._left <= len(point):
                raise _SpentError
            self._left -= 1 + len(point)
            low, high = self._bounds
            size = np.minimum(STEP, 0.5 * (high - low))
            steps = np.where(point + size <= high, size, -size)
            points = [point, *(point + row for row in np.diag(steps))]
            base, *moved = self._curves([values_at(self._variables, point) for point in points])
            residual = (base - self._measured.y) / self._scale
            slopes = np.column_stack([(curve - base) / step for curve, step in zip(moved, steps, strict=True)])
            self._known[key] = residual, slopes / self._scale
            if (squares := float(residual @ residual)) < self._least:
                self.best, self._least = point.copy(), squares
            named = zip(self._variables, values_at(self._variables, point), strict=True)
            off = self._measured.distance(float(np.sqrt(squares / len(residual))) * self._scale)
            self._tell(f"{', '.join(f'{v.name} = {value:.6g}' for v, value in named)}: {off}")
        return self._known[key]


def fit_curve(
    measured: Measurement,
    variables: Sequence[Variable],
    curves: Curves,
    *,
    limit: int,
    tell: Callable[[str], None],
) -> Fit:
    """Fit the variables, in their coordinates: a trust-region method within the bounds, derivatives by differences.

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
    start, low, high = (coordinates(variables, name) for name in ("start", "low", "high"))
    begin: FloatArray | None = start
    try:
        while begin is not None:
            solution = least_squares(
                search.residual, begin, search.jacobian, bounds=(low, high), xtol=TOLERANCE, ftol=TOLERANCE, gtol=1e-12
            )
            ended = CONVERGED if solution.success else solution.message
            information, _, freedom = search.likelihood()
            half = half_widths(covariance_of(information), freedom)
            begin = search.look_around(np.where(half < MOST_LOOK, LOOK * half, 0.0)) if solution.success else None
    except _SpentError:
        ended = f"the limit of {limit} runs"
    if search.best is None:
        raise UelError(f"{limit} runs do not suffice for one step of the search: expected at least {unknowns + 1}")
    residual, slopes = search.residual(search.best), search.jacobian(search.best)
    scale = measured.scale
    return Fit(
        values=values_at(variables, search.best),
        certainty=assess(variables, search.best, residual, slopes, *search.likelihood()),
        sensitivity=slopes * scale,
        curve=measured.y + residual * scale,
        start=measured.y + search.residual(start) * scale,
        deviation=float(np.sqrt(residual @ residual / count)) * scale,
        ended=ended,
    )
