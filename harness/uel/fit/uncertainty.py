# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Certainty of fitted variables: intervals, correlations, bounds, and whether the residuals are noise.

The residuals r (n,) are model less measurement, and J (n, k) their derivatives for the coordinates of the variables.
The test of the residuals is that of J. Durbin and G.S. Watson, Biometrika 37 (1950) 409, against neighbours that go
together, with d = sum (r_i+1 - r_i)^2/sum r_i^2. A fit leaves (1 - J J^+) e of independent errors e: random ones give
the distribution of d, in place of the bounds of their tables.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.linalg import orth
from scipy.stats import monte_carlo_test
from scipy.stats import t as student

from uel.fit.variables import Variable, coordinates, values_at
from uel.model.arrays import FloatArray, IntArray

LEVEL: Final = 0.95
"""Level of the confidence intervals."""
ALARM: Final = 0.01
"""Probability with which residuals that are noise are taken for others."""
DRAWS: Final = 9999
"""Random errors; their number leaves 0.1 % of uncertainty in a probability of 1 %."""
NEAR: Final = 0.01
"""Distance from a bound, as part of the range, within which a search may stop that the bound holds up."""
ROUNDING: Final = 1e-6
"""Residuals, as part of the scale of the measurement, below which they are rounding."""


@dataclass(frozen=True, slots=True)
class Uncertainty:
    """Certainty of variables (k).

    intervals    (k, 2) confidence intervals, as long as the errors of the points are independent; from 0 or so to
                 1e100 where nothing depends on the variable; NaN of a variable at its bound
    correlation  (k, k) of the variables, 0 beside the diagonal for one at its bound
    bounds       (k,) -1 at the lower bound, 1 at the upper one, 0 between them
    statistic    d of Durbin and Watson, NaN where the residuals are rounding
    probability  that noise has a d as small as that, 1 where the residuals are rounding
    """

    intervals: FloatArray
    correlation: FloatArray
    bounds: IntArray
    statistic: float
    probability: float

    @property
    def noise(self) -> bool:
        """True if the residuals may be noise."""
        return self.probability >= ALARM


def assess(
    variables: Sequence[Variable],
    point: FloatArray,
    residual: FloatArray,
    slopes: FloatArray,
    information: FloatArray,
    gradient: FloatArray,
    freedom: int,
) -> Uncertainty:
    """Assess a fit.

    Parameters
    ----------
    variables, point
        The variables, and their coordinates (k,) at the solution.
    residual, slopes
        r (n,) and J (n, k), in the order in which neighbours are compared, as part of the scale of the measurement.
    information, gradient
        (k, k) and (k,) second and first derivatives of the negative log-likelihood: J'J/s^2, J'r/s^2 of least squares.
    freedom
        Degrees of freedom.
    """
    everything = covariance_of(information)
    bounds = _bounds(variables, point, -np.where(np.isfinite(everything), everything, 0.0) @ gradient)
    free = bounds == 0
    inner = np.ix_(free, free)
    covariance = np.diag(np.full(len(point), np.inf))
    covariance[inner] = covariance_of(information[inner])
    spread = np.sqrt(np.diag(covariance))
    half = half_widths(covariance, freedom)
    low, high = (
        values_at(variables, np.array([_limited(v, at) for v, at in zip(variables, ends, strict=True)]))
        for ends in (point - half, point + half)
    )
    intervals = np.column_stack([low, high])
    intervals[~free] = np.nan
    correlation = np.eye(len(point))
    known = np.isfinite(spread) & (spread > 0.0) & free
    inner = np.ix_(known, known)
    correlation[inner] = covariance[inner] / np.outer(spread[known], spread[known])
    return Uncertainty(intervals, correlation, bounds, *noise_test(residual, slopes[:, free]))


def covariance_of(information: FloatArray) -> FloatArray:
    """Return the covariance (k, k) of the variables; infinite for those on which nothing depends."""
    covariance = np.diag(np.full(len(information), np.inf))
    size = np.sqrt(np.diag(information))
    moving = size > 1e-9 * size.max(initial=0.0)
    inner = np.ix_(moving, moving)
    # correlated variables may differ in size
    scale = np.outer(size[moving], size[moving])
    covariance[inner] = np.linalg.pinv(information[inner] / scale, hermitian=True) / scale
    return covariance


def half_widths(covariance: FloatArray, freedom: int) -> FloatArray:
    """Return the half-widths (k,) of the confidence intervals of the coordinates."""
    return np.asarray(student.ppf(0.5 * (1.0 + LEVEL), freedom) * np.sqrt(np.diag(covariance)))


def noise_test(residual: FloatArray, slopes: FloatArray) -> tuple[float, float]:
    """Return d of Durbin and Watson, and the probability that noise has one as small as that.

    Slopes (n, k) are those of the free variables. NaN and 1 where the residuals are rounding.
    """
    directions = orth(slopes)

    def rest(errors: FloatArray) -> FloatArray:
        return np.asarray(errors - (errors @ directions) @ directions.T)

    def neighbours(errors: FloatArray, axis: int) -> FloatArray:
        return np.asarray(np.sum(np.diff(errors, axis=axis) ** 2, axis=axis) / np.sum(errors**2, axis=axis))

    # what a search that ends early leaves is no misfit
    left = rest(residual)
    if np.sqrt(np.mean(left**2)) < ROUNDING:
        return np.nan, 1.0
    generator = np.random.default_rng(1950)
    found = monte_carlo_test(
        left,
        lambda size: rest(np.asarray(generator.standard_normal(size))),
        neighbours,
        n_resamples=DRAWS,
        batch=1000,
        alternative="less",
    )
    return float(found.statistic), float(found.pvalue)


def _bounds(variables: Sequence[Variable], point: FloatArray, step: FloatArray) -> IntArray:
    """Return -1, 0 or 1 for each variable: at the lower bound, at none, at the upper one.

    At a bound means near it, and that the next step (k,) would cross it.
    """
    low, high = (coordinates(variables, name) for name in ("low", "high"))
    near = NEAR * (high - low)
    below = (point - low <= near) & (point + step <= low)
    above = (high - point <= near) & (point + step >= high)
    return np.asarray(above.astype(int) - below.astype(int))


def _limited(variable: Variable, coordinate: float) -> float:
    """Return a coordinate whose value is a number: beyond a factor of 1e100 nothing is known."""
    middle = variable.coordinate(variable.start)
    return float(np.clip(coordinate, middle - 230.0, middle + 230.0))
