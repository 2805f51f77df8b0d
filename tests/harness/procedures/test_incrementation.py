# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Increment sizes against sequences of Abaqus status files and the control parameters' definitions."""

import csv
import gzip
from itertools import groupby
from pathlib import Path

import numpy as np
import pytest

from uel.model.controls import TimeControls
from uel.model.procedures import HeatTransfer, Static, Visco
from uel.procedures.general import incrementation
from uel.procedures.general.incrementation import (
    Accuracy,
    Cutback,
    IncrementControl,
    judge_rate,
    out_of_iterations,
    pnewdt_cutback,
)

DATA = Path(__file__).parents[2] / "data"
DEFAULT = TimeControls()
FREE = incrementation.UNTOUCHED


def sizes(procedure, events, start=0.0, first=None):
    """Sizes tried; events are iterations of a converged attempt, or a Cutback."""
    control = IncrementControl(procedure, DEFAULT)
    time, tried = start, []
    for event in events:
        size = control.attempt(time)
        tried.append(size)
        if isinstance(event, Cutback):
            control.cut_back(event)
        else:
            time += size
            control.converged(event, FREE)
    return tried


def test_growth_after_two_easy_increments():
    """Equilibrium iterations 7, 4, 2 of an Abaqus run: same, same, times 1.5."""
    tried = sizes(Static(0.1, 10.0, 1e-5, 10.0), [7, 4, 2, 1])
    assert tried == pytest.approx([0.1, 0.1, 0.1, 0.15])


def test_sizes_around_a_cutback_of_a_public_status_file():
    """Abaqus 2025, contact: equilibrium iterations 3, 3, U, 4, 4, 3, 3, 8; the largest increment is 0.5."""
    cut = Cutback(DEFAULT.d_f, "")
    tried = sizes(Static(0.5, 100.0, 1e-3, 0.5), [3, 3, cut, 4, 4, 3, 3, 8])
    printed = [0.5, 0.5, 0.5, 0.1250, 0.1875, 0.2812, 0.4219, 0.5]
    assert tried == pytest.approx(printed, rel=3e-4)


def test_sizes_at_the_smallest_increment_of_a_public_status_file():
    """Abaqus 2025: U at 4.953e-4, then 13, 4, 4, 8 iterations, and 16 without convergence in the last 2.15e-5."""
    period = 1.0
    start = period - (1.238e-4 + 1e-4 + 1e-4 + 1.5e-4 + 2.15e-5)
    control = IncrementControl(Static(4.953e-4, period, 1e-4, 0.5), DEFAULT)
    time = start
    printed = [4.953e-4, 1.238e-4, 1e-4, 1e-4, 1.5e-4, 2.15e-5]
    assert control.attempt(time) == pytest.approx(printed[0], rel=1e-3)
    control.cut_back(Cutback(DEFAULT.d_f, ""))
    for iterations, size in zip([13, 4, 4, 8], printed[1:5], strict=True):
        assert control.attempt(time) == pytest.approx(size, rel=1e-3)
        time += size
        control.converged(iterations, FREE)
    assert control.attempt(time) == pytest.approx(printed[5], rel=5e-3)
    assert control.cut_back(out_of_iterations(16, DEFAULT)) == (0.0, incrementation.BELOW_MINIMUM)


PRINTED_CHANGES = """
596. 65.3 43.2 41.8 40.5 39.0 36.8 34.9 33.2 37.6 37.5 37.9 38.2 38.3 37.2 35.7 34.3 38.2 36.2 34.2 32.3 37.5 34.9 32.5
36.6 33.9 31.5 36.4 32.9 29.0 33.8 30.1 26.7 34.5 30.1 26.4 35.6 32.3 29.3 35.5 31.6 28.1 34.8 31.5 29.0 36.3
"""
"""Largest change of temperature of each attempt of Amirisfahani/ThermalAbaqus, Job-1.msg (Abaqus 2017)."""

PRINTED_SIZES = [
    *(10.0, 0.713, *[0.4643] * 7, *[0.5598] * 8, *[0.6536] * 4, *[0.8083] * 3, *[0.9952] * 3, *[1.263] * 3),
    *(*[1.743] * 3, *[2.612] * 3, *[3.918] * 3, *[5.344] * 3, *[7.596] * 3, 10.47),
]
"""Their time increments, Job-1.sta; most attempts took one iteration, whose response was linear."""


def test_sizes_by_the_largest_change_of_temperature_of_a_public_status_file():
    """DELTMX=50: growth by 40/change after three increments of one size with changes up to 37.5.

    After increment 34, which took two iterations, it is D_D = 1.5 as that is less than 40/26.4.

    The first attempt was not linear, so D_L does not hold growth back. The changes are printed with three digits.
    """
    control = IncrementControl(HeatTransfer(10.0, 5000.0, 0.05, 100.0, largest_change=50.0), DEFAULT)
    time, tried = 0.0, []
    for k, change in enumerate(map(float, PRINTED_CHANGES.split())):
        tried.append(control.attempt(time))
        accuracy = Accuracy(change / 50.0, "")
        # printed with two iterations from the second attempt at a larger increment than 1.743 on
        cutback = control.too_inaccurate(accuracy, linear=0 < k < 33)
        if cutback is not None:
            control.cut_back(cutback)
            continue
        time += tried[-1]
        control.converged(1, FREE, accuracy=accuracy)
    # each growth adds the rounding of a change, up to 1.5e-3
    np.testing.assert_allclose(tried, PRINTED_SIZES, rtol=5e-3)


def test_sizes_of_creep_of_a_public_message_file():
    """Abaqus (lelimaa/Abaqus_WELL_, Job-1.msg, steps 5 and 7): 1, 1, 1, 2, 4, ... 1024 s.

    One iteration each; the differences of creep strain, below 1e-22, are nothing beside CETOL = 0.01.
    """
    control = IncrementControl(Visco(1.0, 3e5, 1e-5, 1e5, tolerance=0.01), DEFAULT)
    time, tried = 0.0, []
    for _ in range(13):
        tried.append(control.attempt(time))
        accuracy = Accuracy(1e-20, "")
        assert control.too_inaccurate(accuracy, linear=True) is None
        time += tried[-1]
        control.converged(1, FREE, accuracy=accuracy)
    assert tried == pytest.approx([1.0, 1.0, *2.0 ** np.arange(11)])


def test_last_increment_of_a_public_status_file_meets_the_period():
    """Abaqus 2025: period 7.9, largest increment 0.5, easy throughout: 0.1, 0.1, 0.15, ... 0.5, last 0.4875."""
    control = IncrementControl(Static(0.1, 7.9, 1e-3, 0.5), DEFAULT)
    time, tried = 0.0, []
    while not control.finished(time):
        tried.append(control.attempt(time))
        time += tried[-1]
        control.converged(1, FREE)
    assert len(tried) == 19
    assert tried[:6] == pytest.approx([0.1, 0.1, 0.15, 0.225, 0.3375, 0.5])
    assert tried[-1] == pytest.approx(0.4875)


def test_sequences_of_the_public_status_files():
    """Every run of tests/data starts at its largest increment or is fixed: sizes change only to meet the period."""
    with gzip.open(DATA / "abaqus_increments.csv.gz", "rt") as file:
        rows = list(csv.DictReader(file))
    compared = 0
    for _, group in groupby(rows, key=lambda row: (row["run"], row["step"])):
        lines = list(group)
        printed = [float(line["time_increment"]) for line in lines]
        period = float(lines[-1]["step_time"])
        tried = sizes(
            Static(printed[0], period, 1e-9, printed[0]), [int(line["equilibrium_iterations"]) for line in lines]
        )
        assert tried == pytest.approx(printed, rel=1e-3)
        compared += len(lines)
    assert compared == 3994


def test_diverging_from_i_0():
    growing = [1.0, 2.0, 3.0]
    assert judge_rate(3, growing, 1e-3, DEFAULT) is None
    assert judge_rate(4, [1.0, 1.0, 2.0, 1.5], 1e-3, DEFAULT) == Cutback(0.25, incrementation.DIVERGING)
    # two states that take turns
    for last in (1.0, 1.0 + 1e-9, 1.0 - 1e-9):
        assert judge_rate(4, [1.0, 2.0, last], 1e-3, DEFAULT) == Cutback(0.25, incrementation.DIVERGING)
    assert judge_rate(4, [1.0, 1.0, 2.0, 0.9], 1e-3, DEFAULT) is None
    assert judge_rate(4, [1.0, 1.0, 2.0, 1.5], 1e-3, TimeControls(i_0=8)) is None


@pytest.mark.parametrize(("ratio", "slow"), [(0.3, False), (0.5, True), (1.0, True)])
def test_logarithmic_rate_from_i_r(ratio, slow):
    """r_8 = 0.01, tolerance 1e-6: 8 + ln(1e-4)/ln(ratio) iterations: 15.7 for 0.3, 21.3 for 0.5; I_C = 16."""
    residuals = [1.0] * 6 + [0.01 / ratio, 0.01]
    expected = Cutback(0.5, incrementation.TOO_SLOW) if slow else None
    assert 8 + np.log(1e-4) / np.log(0.3) < 16 < 8 + np.log(1e-4) / np.log(0.5)
    assert judge_rate(8, residuals, 1e-6, DEFAULT) == expected
    assert judge_rate(7, residuals[1:], 1e-6, DEFAULT) is None


def test_iterations_are_limited_to_i_c():
    assert out_of_iterations(15, DEFAULT) is None
    assert out_of_iterations(16, DEFAULT) == Cutback(0.5, incrementation.TOO_MANY_ITERATIONS)


def test_hard_increment_makes_the_next_smaller():
    assert sizes(Static(0.1, 1.0, 1e-5, 1.0), [11, 5]) == pytest.approx([0.1, 0.075])
    assert sizes(Static(0.1, 1.0, 0.09, 1.0), [11, 5]) == pytest.approx([0.1, 0.09])


def test_i_a_cutbacks_are_allowed():
    """A public job with I_A = 12 ended in its 13th attempt; the default of 5 cutbacks gives 6 attempts."""
    control = IncrementControl(Static(1.0, 1.0, 1e-9, 1.0), DEFAULT)
    tried = []
    error = ""
    while not error:
        tried.append(control.attempt(0.0))
        _, error = control.cut_back(Cutback(0.25, ""))
    assert tried == pytest.approx([0.25**k for k in range(6)])
    assert error == incrementation.TOO_MANY_ATTEMPTS


def test_fixed_increments_do_not_change_and_do_not_cut_back():
    procedure = Static(0.3, 1.0, 1e-5, 0.1, direct=True)
    assert sizes(procedure, [1, 1, 20, 1]) == pytest.approx([0.3, 0.3, 0.3, 0.1])
    control = IncrementControl(procedure, DEFAULT)
    control.attempt(0.0)
    assert control.cut_back(Cutback(0.25, "")) == (0.0, incrementation.FIXED_TOO_LARGE)


@pytest.mark.parametrize(("pnewdt", "following"), [(1.2, 0.12), (5.0, 0.4), (FREE, 0.1), (1.0, 0.1)])
def test_pnewdt_above_one_lets_the_increment_grow(pnewdt, following):
    control = IncrementControl(Static(0.1, 1.0, 1e-5, 0.4), DEFAULT)
    control.attempt(0.0)
    control.converged(2, pnewdt)
    assert control.attempt(0.1) == pytest.approx(following)


def test_pnewdt_below_one_is_the_factor_of_the_cutback():
    assert pnewdt_cutback(0.6).factor == 0.6
    assert pnewdt_cutback(1.0) is None
