# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Paris lines of `uel fit`: the file, and the line of a run."""

import csv
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import t as student

from uel.cli import main
from uel.errors import DeckError, UelError, UsageError
from uel.fit import paris_line as module
from uel.fit.curve import read_points
from uel.fit.estimate import fit_curve
from uel.fit.outcome import write_tables
from uel.fit.paris_line import ParisLine, check_cycles, paris_line
from uel.fit.variables import Variable
from uel.output.pictures.column import Column
from uel.output.pictures.growth import Growth

FATIGUE = Path(__file__).parents[3] / "abaqus_inputs" / "fatigue"
EXPONENT, AT_ONE = 7.0, 1e-3


def points(folder: Path, text: str, x: str | None = None) -> ParisLine:
    (folder / "paris.csv").write_text(text)
    return paris_line(read_points(folder / "paris.csv", x, None), 0.0)


def held_apart(first: float = 0.2, forming: int = 5) -> Growth:
    """Growth of a crack whose G falls as its length, and whose line is a power; at first the process zone forms."""
    length = np.linspace(0.0, 10.0, 201)
    release = first * (1.0 + length) ** -0.5
    middle = 0.5 * (length[1:] + length[:-1])
    rate = AT_ONE * (first * (1.0 + middle) ** -0.5) ** EXPONENT
    # while it forms G rises, and the crack grows faster
    release[:forming] *= 0.9
    rate[:forming] *= 10.0
    cycles = np.concatenate([[0.0], np.cumsum(np.diff(length) / rate)])
    return Growth(cycles, length, np.column_stack([0.75 * release, 0.25 * release]))


def line_of(monkeypatch: pytest.MonkeyPatch, measured: ParisLine, grown: Growth) -> np.ndarray:
    monkeypatch.setattr(module, "growth", lambda _: grown)
    return measured.of_result(None, "job")  # type: ignore[arg-type]


def test_points_in_any_order_with_repetitions(tmp_path: Path) -> None:
    found = points(tmp_path, "G, rate\n0.2, 1e-3\n0.1, 1e-5\n0.2, 2e-3\n0.15, 1e-4\n")
    assert found.x.tolist() == [0.1, 0.15, 0.2, 0.2]
    assert np.exp(found.y) == pytest.approx([1e-5, 1e-4, 1e-3, 2e-3])
    assert list(map(str, found.columns)) == ["G", "RATE"]


def test_growth_of_a_run_at_the_points(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # in J/m^2 and mm per 1000 cycles
    measured = points(tmp_path, "1000*G, 1000*RATE\n70, 1\n100, 1\n130, 1\n150, 1\n")
    # what happens before the process zone has formed does not count
    found = line_of(monkeypatch, measured, held_apart())
    # chords of a convex line over four increments
    assert np.exp(found) == pytest.approx(1e3 * AT_ONE * (1e-3 * measured.x) ** EXPONENT, rel=0.01)


def test_rising_energy_release_rate(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    grown = held_apart(forming=0)
    backwards = Growth(grown.cycles[-1] - grown.cycles[::-1], grown.length, grown.release[::-1])
    measured = points(tmp_path, "G, RATE\n0.07, 1\n0.1, 1\n0.15, 1\n")
    expected = line_of(monkeypatch, measured, grown)
    assert line_of(monkeypatch, measured, backwards) == pytest.approx(expected, abs=1e-9)


def test_beginning_is_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    measured = points(tmp_path, "G, RATE\n0.07, 1\n0.1, 1\n0.15, 1\n")
    late = ParisLine(measured.x, measured.y, measured.columns, after=2.0)
    # G is 0.2/sqrt(3) from there on
    with pytest.raises(UelError, match=r"job: the crack grows at G from 0\.06\d+ to 0\.11\d+, the measured"):
        line_of(monkeypatch, late, held_apart())


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (
            "0.05, 1\n0.1, 1\n0.15, 1\n",
            r"job: the crack grows at G from 0\.060\d+ to 0\.17\d+, the measured points are from 0\.05 to 0\.15: leave",
        ),
        ("0.1, 1\n0.15, 1\n0.25, 1\n", r"the measured points are from 0\.1 to 0\.25: leave points out, or change the"),
    ],
)
def test_points_beyond_the_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, rows: str, message: str) -> None:
    with pytest.raises(UelError, match=message):
        line_of(monkeypatch, points(tmp_path, f"G, RATE\n{rows}"), held_apart())


def test_run_without_growth(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    measured = points(tmp_path, "G, RATE\n0.07, 1\n0.1, 1\n0.15, 1\n")
    none = Growth(np.zeros(0), np.zeros(0), np.zeros((0, 2)))
    still = Growth(np.arange(9.0), np.ones(9), np.full((9, 2), 0.1))
    for grown in (none, still):
        with pytest.raises(
            UelError, match=r"job: 0 rates of growth over 4 increments with field output each, expected"
        ):
            line_of(monkeypatch, measured, grown)


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        ("GI, RATE\n1, 2\n2, 3\n3, 4\n", UsageError, r"'GI': expected G, the energy release rate, over which RATE"),
        ("G, -RATE\n1, 2\n2, 3\n3, 4\n", UsageError, r"'G', '-RATE': expected factors above 0"),
        ("G, RATE\n1, 2\n2, 0\n3, 4\n", DeckError, r"paris\.csv:3: expected numbers above 0, found 2, 0"),
    ],
)
def test_wrong_points(tmp_path: Path, text: str, error: type[UelError], message: str) -> None:
    with pytest.raises(error, match=message):
        points(tmp_path, text)


def test_deck_has_to_count_cycles(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(FATIGUE)
    check_cycles(Path("dcb.inp"))
    text = Path("dcb.inp").read_text()
    # FATIGUE is the last property, before the next keyword
    static, count = re.subn(r", 2\n\*ELSET", ", 0\n*ELSET", text)
    assert count == 1
    (tmp_path / "static.inp").write_text(static)
    with pytest.raises(UsageError, match=r"static\.inp: RATE is growth per cycle: expected interface elements in the"):
        check_cycles(tmp_path / "static.inp")


def test_option_that_only_a_paris_line_has(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "curve.csv").write_text("U1[END], RF1[END]\n1, 2\n2, 3\n3, 4\n")
    assert main(["fit", "deck.inp", str(tmp_path / "curve.csv"), "A=1:2", "--after", "2"]) == 2
    assert "--after 2: expected a curve of RATE, the growth of a crack, over G" in capsys.readouterr().err


def test_what_a_fit_says_is_in_the_logarithm() -> None:
    line = ParisLine(np.ones(3), np.zeros(3), (Column("G"), Column("RATE")))
    assert line.distance(np.log(1.25)) == "off by a factor of 1.25"
    assert line.spread(np.log(1.25)) == "standard deviation from the measured RATE: a factor of 1.25"
    assert line.change(np.log(1.25)) == "changes RATE by up to 25.00%"


def test_fit_of_a_power(tmp_path: Path) -> None:
    """The line ln RATE = ln C + m ln G is linear in ln C: the interval of C is that of a mean, for a known m."""
    release = np.geomspace(0.1, 0.2, 12)
    noise = np.random.default_rng(3).normal(0.0, 0.2, len(release))
    line = ParisLine(release, np.log(1e-3 * release**EXPONENT) + noise, (Column("G"), Column("RATE")))
    variable = Variable("C", 1e-4, 2e-4, 1e-2)
    found = fit_curve(
        line,
        [variable],
        lambda values: [np.log(value[0] * release**EXPONENT) for value in values],
        limit=40,
        tell=lambda _: None,
    )
    reach = student.ppf(0.975, len(release) - 1) * noise.std(ddof=1) / np.sqrt(len(release))
    assert found.values[0] == pytest.approx(1e-3 * np.exp(noise.mean()), rel=1e-3)
    assert np.log(found.certainty.intervals[0] / found.values[0]) == pytest.approx([-reach, reach], rel=1e-3)
    write_tables(tmp_path / "x_fit", [variable], line, found)
    with (tmp_path / "x_fit_curve.csv").open(newline="") as file:
        first = next(csv.DictReader(file))
    assert float(first["measured RATE"]) == pytest.approx(1e-3 * 0.1**EXPONENT * np.exp(noise[0]))
    assert float(first["fitted RATE"]) == pytest.approx(found.values[0] * 0.1**EXPONENT)
    assert float(first["C d/dC"]) == pytest.approx(1.0)
