# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Sentences of `uel fit` where a model cannot follow: residuals that are not noise, bounds, searches that end early."""

import csv
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import binom

from uel.fit.curve import Measurement
from uel.fit.estimate import Fit, fit_curve
from uel.fit.outcome import summary, write_tables
from uel.fit.uncertainty import ALARM, noise_test
from uel.fit.variables import Variable
from uel.output.pictures.column import Column

X = np.linspace(0.05, 2.0, 40)
A, B = Variable("A", 0.5, 1.5, 8.0), Variable("B", 0.2, 0.5, 5.0)
TRUE = np.array([3.0, 0.8])
COLUMNS = Column("U", 1.0), Column("F", 1.0)
Formula = Callable[[np.ndarray], np.ndarray]


def saturating(p: np.ndarray) -> np.ndarray:
    return np.asarray(p[0] * (1.0 - np.exp(-X / p[1])))


def bilinear(p: np.ndarray) -> np.ndarray:
    """Rise to A within B, then nothing: another model of much the same curve."""
    return np.asarray(p[0] * np.minimum(X / p[1], 1.0))


def noisy(seed: int, deviation: float = 0.05) -> np.ndarray:
    return saturating(TRUE) + np.random.default_rng(seed).normal(0.0, deviation, len(X))


def fitted(y: np.ndarray, formula: Formula, variables: Sequence[Variable] = (A, B), limit: int = 90) -> Fit:
    measured = Measurement(X, y, COLUMNS)
    return fit_curve(measured, variables, lambda ps: [formula(p) for p in ps], limit=limit, tell=lambda _: None)


def told(y: np.ndarray, found: Fit, variables: Sequence[Variable] = (A, B)) -> str:
    return "\n".join(summary(variables, Measurement(X, y, COLUMNS), found, found.ended))


def test_wrong_model_is_told() -> None:
    y = noisy(1)
    found = fitted(y, bilinear)
    assert found.converged
    assert not found.reliable
    text = told(y, found)
    assert "the residuals are not noise: neighbours along U go together (Durbin-Watson " in text
    assert "The model cannot follow the measurement, or its errors depend on each other" in text
    assert text.count(", not reliable; ") == 2


def test_right_model_is_not_suspected() -> None:
    y = noisy(1)
    found = fitted(y, saturating)
    assert found.reliable
    assert "not noise" not in told(y, found)
    assert "not reliable" not in told(y, found)


def test_wrong_model_is_told_whatever_the_noise() -> None:
    alarms = [not fitted(noisy(seed), bilinear).certainty.noise for seed in range(20)]
    assert all(alarms)


def test_false_alarms_are_as_rare_as_they_should_be(monkeypatch: pytest.MonkeyPatch) -> None:
    count = 600
    monkeypatch.setattr("uel.fit.uncertainty.DRAWS", 999)
    slopes = np.column_stack([saturating(np.array([1.0, 0.8])), X * np.exp(-X / 0.8)])
    generator = np.random.default_rng(7)
    alarms = sum(noise_test(generator.normal(0.0, 0.05, len(X)), slopes)[1] < ALARM for _ in range(count))
    # a test at the level of 1 % leaves these bounds once in a thousand times
    assert binom.ppf(5e-4, count, ALARM) <= alarms <= binom.ppf(1.0 - 5e-4, count, ALARM)


def test_rounding_is_no_misfit() -> None:
    y = saturating(TRUE)
    assert fitted(y, saturating).reliable


def test_early_end_leaves_nothing_to_trust() -> None:
    y = noisy(1)
    found = fitted(y, saturating, limit=7)
    assert not found.converged
    text = told(y, found)
    assert "the search has not converged: values and intervals are not reliable; allow more runs" in text
    assert text.count(", not reliable; ") == 2


@pytest.mark.parametrize(
    ("bounds", "side", "asks"),
    [((0.5, 1.0, 2.0), "upper", "more"), ((4.0, 5.0, 8.0), "lower", "less"), ((3.9, 4.0, 4.1), "lower", "less")],
)
def test_bound_that_holds_a_value_up(bounds: tuple[float, float, float], side: str, asks: str) -> None:
    narrow = Variable("A", *bounds)
    y = noisy(1)
    found = fitted(y, saturating, [narrow, B])
    assert found.certainty.bounds.tolist()[0] == (1 if side == "upper" else -1)
    assert np.isnan(found.certainty.intervals[0]).all()
    assert found.certainty.correlation[0, 1] == 0.0
    assert not found.reliable
    text = told(y, found, [narrow, B])
    assert f"A is at its {side} bound: the measurement asks for {asks}. The bound is too narrow, or the model" in text
    assert f", at its {side} bound, no interval; 1 % more of it moves the curve" in text


def test_interval_beside_a_bound_is_that_of_the_other_variable_alone() -> None:
    y = 1.02 * noisy(1)
    held = fitted(y, saturating, [Variable("A", 0.5, 1.5, 3.0), B])
    alone = fitted(y, lambda p: saturating(np.array([held.values[0], p[0]])), [B])
    assert held.certainty.bounds.tolist() == [1, 0]
    assert held.certainty.intervals[1] == pytest.approx(alone.certainty.intervals[0], rel=0.02)


def line(p: np.ndarray) -> np.ndarray:
    return p[0] + p[1] * X


@pytest.mark.parametrize("truth", [-0.3, 0.3])
def test_bound_at_zero(truth: float) -> None:
    variables = Variable("C", 0.0, 0.5, 1.0), Variable("B", 0.2, 0.5, 5.0)
    y = line(np.array([truth, 1.0])) + np.random.default_rng(2).normal(0.0, 0.05, len(X))
    found = fitted(y, line, variables)
    if truth < 0.0:
        assert found.certainty.bounds.tolist() == [-1, 0]
        assert "C is at its lower bound: the measurement asks for less" in told(y, found, variables)
        assert 0.0 <= found.values[0] < 0.01
    else:
        assert found.reliable
        low, high = found.certainty.intervals[0]
        assert low < truth < high
        assert "; 1 % of its range more of it moves the curve by up to" in told(y, found, variables)


def test_intervals_of_variables_on_a_linear_scale() -> None:
    """With a negative value among the bounds, as often as they say."""
    variables = Variable("C", -1.0, 0.5, 1.0), Variable("B", 0.2, 0.5, 5.0)
    truth, generator, hits = np.array([-0.2, 1.0]), np.random.default_rng(11), 0
    for _ in range(60):
        found = fitted(line(truth) + generator.normal(0.0, 0.05, len(X)), line, variables)
        intervals = found.certainty.intervals
        hits += int(np.sum((intervals[:, 0] <= truth) & (truth <= intervals[:, 1])))
    # 95 % of 120 are 114, with a standard deviation of 3.4 for a correlation of 1
    assert 104 <= hits <= 120


def test_table_has_notes(tmp_path: Path) -> None:
    y = noisy(1)

    def notes(found: Fit, variables: Sequence[Variable]) -> list[str]:
        write_tables(tmp_path / "x_fit", variables, Measurement(X, y, COLUMNS), found)
        with (tmp_path / "x_fit.csv").open(newline="") as file:
            return [row["note"] for row in csv.DictReader(file)]

    assert notes(fitted(y, saturating), [A, B]) == ["", ""]
    assert notes(fitted(y, bilinear), [A, B]) == ["residuals are not noise"] * 2
    assert notes(fitted(y, saturating, limit=7), [A, B])[0].startswith("not converged")
    narrow = Variable("A", 0.5, 1.5, 2.9)
    first, second = notes(fitted(y, saturating, [narrow, B]), [narrow, B])
    assert first.endswith("at its upper bound")
    assert second.endswith("another at its bound")
