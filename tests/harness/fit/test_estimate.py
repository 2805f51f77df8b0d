# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Least squares of `uel fit`, on curves that are formulas."""

from collections.abc import Callable, Sequence

import numpy as np
import pytest
from scipy.stats import t as student

from uel.errors import UelError
from uel.fit.curve import Measurement
from uel.fit.estimate import CONVERGED, Fit, fit_curve
from uel.fit.uncertainty import LEVEL
from uel.fit.variables import Variable
from uel.output.pictures.column import Column

X = np.linspace(0.05, 2.0, 40)
A, B = Variable("A", 0.5, 1.5, 8.0), Variable("B", 0.2, 0.5, 5.0)
Formula = Callable[[np.ndarray], np.ndarray]


def fitted(
    y: np.ndarray, formula: Formula, variables: Sequence[Variable] = (A, B), limit: int = 60
) -> tuple[Fit, list[str]]:
    measured, told = Measurement(X, y, (Column("U", 1.0), Column("F", 1.0))), list[str]()
    return fit_curve(measured, variables, lambda ps: [formula(p) for p in ps], limit=limit, tell=told.append), told


def saturating(p: np.ndarray) -> np.ndarray:
    return np.asarray(p[0] * (1.0 - np.exp(-X / p[1])))


def test_exact_curve() -> None:
    found, told = fitted(saturating(np.array([3.0, 0.8])), saturating)
    assert found.ended == CONVERGED
    # differences with steps of some per cent; the residual itself vanishes at the solution
    assert found.values == pytest.approx([3.0, 0.8], rel=1e-3)
    assert found.deviation < 1e-3
    assert "off by" in told[0]
    assert told[0].startswith("A = 1.5, B = 0.5: ")
    # y is proportional to A, so that its change for each part of A is y itself
    assert found.sensitivity[:, 0] == pytest.approx(found.curve, rel=0.05)
    assert found.start == pytest.approx(saturating(np.array([1.5, 0.5])), rel=1e-12)


def test_local_minima_of_a_curve_with_teeth() -> None:
    """Its derivative changes its sign every tenth of the value; the search goes on where something is better."""
    shape = saturating(np.array([1.0, 0.8]))

    def toothed(p: np.ndarray) -> np.ndarray:
        return np.asarray(p[0] * (1.0 + 0.03 * np.sin(2.0 * np.pi * np.log(p[0] / 3.0) / 0.1)) * shape)

    y = 3.0 * shape + np.random.default_rng(5).normal(0.0, 0.15, len(X))
    found, _ = fitted(y, toothed, [Variable("A", 0.5, 3.5, 8.0)])
    assert found.ended == CONVERGED
    assert found.values[0] == pytest.approx(3.0, rel=0.02)


def test_interval_of_a_factor() -> None:
    # theory: the factor of a known curve has the standard error s/sqrt(sum of its squares), n - 1 degrees of freedom
    shape = saturating(np.array([1.0, 0.8]))
    y = 3.0 * shape + np.random.default_rng(5).normal(0.0, 0.03, len(X))
    found, _ = fitted(y, lambda p: p[0] * shape, [A])
    value = float(y @ shape / (shape @ shape))
    error = np.sqrt(np.sum((y - value * shape) ** 2) / (len(X) - 1) / (shape @ shape))
    reach = student.ppf(0.5 + 0.5 * LEVEL, len(X) - 1) * error
    assert found.values[0] == pytest.approx(value, rel=1e-4)
    # the search is in the logarithm, with one-sided differences
    assert found.certainty.intervals[0] == pytest.approx([value - reach, value + reach], rel=0.1 * reach / value)


def test_intervals_hold_the_truth_as_often_as_they_say() -> None:
    truth, generator, hits = np.array([3.0, 0.8]), np.random.default_rng(11), 0
    for _ in range(60):
        found, _ = fitted(saturating(truth) + generator.normal(0.0, 0.05, len(X)), saturating)
        hits += int(np.sum((found.certainty.intervals[:, 0] <= truth) & (truth <= found.certainty.intervals[:, 1])))
    # 95 % of 120 are 114, with a standard deviation of 2.4 for independent ones
    assert 106 <= hits < 120


def test_bounds_are_kept() -> None:
    found, _ = fitted(saturating(np.array([20.0, 0.8])), saturating)
    assert found.values[0] == pytest.approx(A.high, rel=1e-3)
    assert found.values[0] <= A.high


def test_variable_without_effect() -> None:
    found, _ = fitted(saturating(np.array([3.0, 0.8])), lambda p: saturating(np.array([p[0], 0.8])))
    assert found.values[0] == pytest.approx(3.0, rel=1e-3)
    assert found.certainty.intervals[1, 0] < 1e-90
    assert found.certainty.intervals[1, 1] > 1e90
    assert found.certainty.correlation[0, 1] == 0.0


def test_variables_that_cannot_be_told_apart() -> None:
    y = 3.0 * X + np.random.default_rng(3).normal(0.0, 0.01, len(X))
    found, _ = fitted(y, lambda p: p[0] * p[1] ** 1.01 * X + 1e-3 * p[1] * X**2)
    assert abs(found.certainty.correlation[0, 1]) > 0.9


def test_limit_of_runs() -> None:
    asked: list[int] = []

    def formula(p: np.ndarray) -> np.ndarray:
        asked.append(1)
        return saturating(p)

    found, _ = fitted(saturating(np.array([3.0, 0.8])), formula, limit=7)
    assert found.ended == "the limit of 7 runs"
    assert len(asked) == 6
    # better than the start
    assert found.deviation < np.sqrt(np.mean((found.start - saturating(np.array([3.0, 0.8]))) ** 2))
    with pytest.raises(UelError, match="2 runs do not suffice for one step of the search: expected at least 3"):
        fitted(saturating(np.array([3.0, 0.8])), saturating, limit=2)


def test_more_points_than_variables() -> None:
    many = [Variable(f"P{k}", 0.5, 1.0, 2.0) for k in range(len(X))]
    with pytest.raises(UelError, match="40 points for 40 parameters: expected more points than parameters"):
        fitted(X, saturating, many)
