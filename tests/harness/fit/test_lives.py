# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""S-N points of `uel fit-sn`: the closed form, least squares, runouts, and how often the intervals hold the truth."""

import csv
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.stats import binom, linregress, norm
from scipy.stats import t as student

from uel.cli import main
from uel.errors import DeckError, UelError, UsageError
from uel.fit.estimate import Fit
from uel.fit.lives import DEFAULTS, Lives, check_properties, fit_lives, log_life, read_lives
from uel.fit.uncertainty import LEVEL
from uel.fit.variables import Variable
from uel.output.pictures.column import Column

ENDURANCE, BRITTLENESS = Variable("ENDURANCE", 0.05, 0.2, 0.8), Variable("BRITTLENESS", 0.2, 0.9, 3.0)
EXPONENT = Variable("EXPONENT", -0.9, 1.0, 60.0)
TRUE = {"ENDURANCE": 0.25, "BRITTLENESS": 0.8, "EXPONENT": 0.0}
LEVELS = np.repeat([0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9], 3)
RATIO, SCATTER, END = 0.1, 0.4, 2e6


def lives(seed: int, end: float = np.inf, **values: float) -> Lives:
    """Points with the logarithmic scatter, of tests that end after so many cycles."""
    none = np.zeros(len(LEVELS))
    properties = {name.lower(): value for name, value in {**TRUE, **values}.items()}
    y = log_life(LEVELS, none + RATIO, none, **properties)
    y += np.random.default_rng(seed).normal(0.0, SCATTER, len(LEVELS))
    late = y > np.log(end)
    return Lives(LEVELS, np.minimum(y, np.log(end)), (Column("S"), Column("CYCLES")), none + RATIO, none, late)


def holds(found: Fit, names: tuple[str, ...] = ("ENDURANCE", "BRITTLENESS")) -> list[bool]:
    return [low <= TRUE[name] <= high for name, (low, high) in zip(names, found.certainty.intervals, strict=True)]


@pytest.mark.parametrize(("ratio", "shear"), [(-1.0, 0.0), (0.1, 0.0), (0.5, 1.0), (0.1, 0.3)])
def test_endurance_limit(ratio: float, shear: float) -> None:
    """Without EXPONENT, E = 2 e/(e + 1 + R (e - 1)) has 10^7 cycles but for the damage at the static strength."""
    e = 0.2 * (1.0 - 0.42 * shear)
    limit = 2.0 * e / (e + 1.0 + ratio * (e - 1.0))
    slope = -7.0 * 0.95 / np.log10(limit)
    at = np.array([limit])
    found = log_life(at, np.array([ratio]), np.array([shear]), endurance=0.2, brittleness=0.95, exponent=0.0)
    assert np.exp(found) == pytest.approx(1e7 * (1.0 - limit ** (slope + 1.0)), rel=1e-12)


def test_least_squares_are_a_straight_line_of_the_logarithms() -> None:
    """Below the static strength ln N = ln 10^7 - 7 BRITTLENESS ln 10 - b ln S: two parameters, linear regression."""
    points = lives(3, BRITTLENESS=2.0)
    found = fit_lives(points, [ENDURANCE, Variable("BRITTLENESS", 0.2, 1.0, 5.0)])
    corrected = points.y - np.log1p(-(points.x ** (1.0 - 7.0 * found.values[1] / np.log10(limit_of(found.values[0])))))
    line = linregress(np.log(points.x), corrected)
    assert -line.slope == pytest.approx(-7.0 * found.values[1] / np.log10(limit_of(found.values[0])), rel=2e-3)
    assert line.intercept == pytest.approx(np.log(1e7) - 7.0 * found.values[1] * np.log(10.0), rel=2e-3)
    # BRITTLENESS is the intercept
    reach = student.ppf(0.5 + 0.5 * LEVEL, len(LEVELS) - 2) * line.intercept_stderr / (7.0 * np.log(10.0))
    low, high = found.certainty.intervals[1]
    assert 0.5 * (high - low) == pytest.approx(reach, rel=0.03)


def limit_of(endurance: float) -> float:
    return float(2.0 * endurance / (endurance + 1.0 + RATIO * (endurance - 1.0)))


def test_intervals_hold_the_truth_as_often_as_they_say(monkeypatch: pytest.MonkeyPatch) -> None:
    # the test of the residuals is none of this one
    monkeypatch.setattr("uel.fit.uncertainty.DRAWS", 9)
    count = 200
    hits = np.sum([holds(fit_lives(lives(seed), [ENDURANCE, BRITTLENESS])) for seed in range(count)], axis=0)
    low, high = binom.ppf([5e-4, 1.0 - 5e-4], count, LEVEL)
    assert ((low <= hits) & (hits <= high)).all(), hits


def test_intervals_with_runouts_hold_the_truth_as_often() -> None:
    """A third of the tests end before the failure."""
    count = 80
    found = [fit_lives(lives(seed, END), [ENDURANCE, BRITTLENESS]) for seed in range(count)]
    assert all(fit.converged for fit in found)
    hits = np.sum([holds(fit) for fit in found], axis=0)
    low, high = binom.ppf([5e-4, 1.0 - 5e-4], count, LEVEL)
    assert ((low <= hits) & (hits <= high)).all(), hits


def test_runouts_have_the_largest_likelihood() -> None:
    """Values from scipy's censored data; the variance here is per degree of freedom, which moves them a little."""
    points = lives(1, END)
    assert points.runout.sum() == 6
    found = fit_lives(points, [ENDURANCE, BRITTLENESS])

    def less_likely(p: np.ndarray) -> float:
        mean = points.computed({**DEFAULTS, "ENDURANCE": np.exp(p[0]), "BRITTLENESS": np.exp(p[1])})
        z = (points.y - mean) / np.exp(p[2])
        return -float(np.sum(np.where(points.runout, norm.logsf(z), norm.logpdf(z) - p[2])))

    begin = np.log([0.2, 0.9, 0.5])
    best = np.exp(minimize(less_likely, begin, method="Nelder-Mead", options={"xatol": 1e-8, "fatol": 1e-8}).x)
    assert found.values == pytest.approx(best[:2], rel=5e-3)
    assert found.deviation == pytest.approx(best[2] * np.sqrt(len(LEVELS) / (len(LEVELS) - 2)), rel=0.05)


def test_runouts_are_neither_failures_nor_nothing() -> None:
    points = lives(1, END)
    found = fit_lives(points, [ENDURANCE, BRITTLENESS]).values
    failed = Lives(points.x, points.y, points.columns, points.ratio, points.shear, np.zeros_like(points.runout))
    assert all(holds(fit_lives(points, [ENDURANCE, BRITTLENESS])))
    # as failures they would make the line steeper there
    assert not all(holds(fit_lives(failed, [ENDURANCE, BRITTLENESS])))
    assert fit_lives(failed, [ENDURANCE, BRITTLENESS]).values[0] < found[0]


def test_exponent_hardly_matters() -> None:
    """It counts near the static strength alone: its interval is wide, or it is at a bound."""
    found = fit_lives(lives(1, EXPONENT=5.0), [ENDURANCE, BRITTLENESS, EXPONENT])
    low, high = found.certainty.intervals[2]
    assert found.certainty.bounds[2] != 0 or high - low > 3.0
    # 1 % of its range, 0.6, moves lives by less than 1 % more of ENDURANCE does
    most = np.abs(found.sensitivity).max(axis=0)
    assert most[2] < 0.5 * most[0]


def test_wrong_model_is_told() -> None:
    """An S-N line that bends, where the model's is straight in the logarithm."""
    points = lives(1)
    bent = points.y + 4.0 * (np.log(points.x) + 0.5) ** 2
    wrong = Lives(points.x, bent, points.columns, points.ratio, points.shear, points.runout)
    assert fit_lives(points, [ENDURANCE, BRITTLENESS]).reliable
    assert not fit_lives(wrong, [ENDURANCE, BRITTLENESS]).certainty.noise


def test_points_of_a_file(tmp_path: Path) -> None:
    (tmp_path / "sn.csv").write_text(
        "CYCLES, S, runout, B, R\n1e4, 0.6, 0, 1, 0.1\n2e6, 0.3, 1, 0, 0.1\n9, 0.9, 0, 0, 0.1\n"
    )
    found = read_lives(tmp_path / "sn.csv")
    assert found.x.tolist() == [0.3, 0.9, 0.6]
    assert np.exp(found.y) == pytest.approx([2e6, 9.0, 1e4])
    assert found.shear.tolist() == [0.0, 0.0, 1.0]
    assert found.runout.tolist() == [True, False, False]
    assert found.parts == [slice(0, 2), slice(2, 3)]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"sn\.csv:1: expected a line of names, such as S, CYCLES, and a line for each point"),
        ("S, LIFE\n", r"sn\.csv:1: expected columns S, CYCLES and of R, B, RUNOUT any, found S, LIFE"),
        ("S, CYCLES, S\n", r"sn\.csv:1: expected columns S, CYCLES and of R, B, RUNOUT any"),
        ("S, CYCLES\n0.5\n", r"sn\.csv:2: expected a number for each of S, CYCLES, found 1"),
        ("S, CYCLES\n1.0, 5\n", r"sn\.csv:2: S: expected a number above 0 and below 1, found '1\.0'"),
        ("S, CYCLES\n0.5, 0\n", r"sn\.csv:2: CYCLES: expected a number above 0, found '0'"),
        ("S, CYCLES, R\n0.5, 7, 1\n", r"sn\.csv:2: R: expected a number from -1 to below 1, found '1'"),
        ("S, CYCLES, R\n0.5, 7, -1.5\n", r"sn\.csv:2: R: expected a number from -1 to below 1, found '-1\.5'"),
        ("S, CYCLES, B\n0.5, 7, 1.1\n", r"sn\.csv:2: B: expected a number from 0 to 1, found '1\.1'"),
        ("S, CYCLES, RUNOUT\n0.5, 7, 0.5\n", r"sn\.csv:2: RUNOUT: expected a number 0 or 1, found '0\.5'"),
        ("S, CYCLES\n0.5, nan\n", r"sn\.csv:2: CYCLES: expected a number above 0, found 'nan'"),
    ],
)
def test_wrong_files(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "sn.csv").write_text(text)
    with pytest.raises(DeckError, match=message):
        read_lives(tmp_path / "sn.csv")


@pytest.mark.parametrize(
    ("variable", "message"),
    [
        (Variable("GIC", 0.1, 0.2, 0.3), r"'GIC': S-N points depend on ENDURANCE, BRITTLENESS, EXPONENT"),
        (Variable("ENDURANCE", 0.0, 0.2, 0.3), r"ENDURANCE: expected bounds above 0 and below 1"),
        (Variable("ENDURANCE", 0.1, 0.2, 1.0), r"ENDURANCE: expected bounds above 0 and below 1"),
        (Variable("EXPONENT", -1.0, 0.2, 1.0), r"EXPONENT: expected bounds above -1$"),
    ],
)
def test_wrong_variables(variable: Variable, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        check_properties([variable])


def test_too_few_failures() -> None:
    points = lives(1, 2000.0)
    few = Lives(
        *(values[:8] for values in (points.x, points.y)),
        points.columns,
        *(values[:8] for values in (points.ratio, points.shear, points.runout)),
    )
    with pytest.raises(UelError, match=r"0 failures for 2 properties: expected more failures than properties"):
        fit_lives(few, [ENDURANCE, BRITTLENESS])


def test_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    points = lives(1, END)
    rows = [
        f"{s:g}, {n:.9g}, {int(late)}, {RATIO}\n"
        for s, n, late in zip(points.x, np.exp(points.y), points.runout, strict=True)
    ]
    Path("sn.csv").write_text("S, CYCLES, RUNOUT, R\n" + "".join(rows))
    assert main(["fit-sn", "sn.csv", "endurance=0.05:0.8", "BRITTLENESS=0.2:3"]) == 0
    told = capsys.readouterr().out
    assert "converged: 15 failures, 6 runouts; standard deviation from the measured CYCLES: a factor of 1." in told
    assert re.search(
        r"^ENDURANCE = 0\.2\d+, 95% between 0\.2\d+ and 0\.2\d+; 1 % more of it changes CYCLES by", told, re.M
    )
    with Path("fit/sn_fit.csv").open(newline="") as file:
        found = {row["name"]: row for row in csv.DictReader(file)}
    assert float(found["ENDURANCE"]["lower"]) < 0.25 < float(found["ENDURANCE"]["upper"])
    with Path("fit/sn_fit_curve.csv").open(newline="") as file:
        head, first, *_ = csv.reader(file)
    assert head[:6] == ["S", "R", "B", "RUNOUT", "measured CYCLES", "fitted CYCLES"]
    assert list(map(float, first[:5])) == [0.3, 0.1, 0.0, 1.0, END]
    assert Path("fit/sn_fit.png").read_bytes().startswith(b"\x89PNG")
    # the true value is above these bounds
    assert main(["fit-sn", "sn.csv", "ENDURANCE=0.05:0.2", "BRITTLENESS=0.2:3", "--quiet"]) == 3
    assert capsys.readouterr().out == ""
