# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Stresses between the plies at a free edge: laminate theory, and the page against runs."""

import re
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from uel.paper.study.free_edge import (
    BRICKS,
    FINE,
    LAYUPS,
    LOADS,
    SHOWN,
    WIDTH,
    EdgeCase,
    cut,
    finest,
    laminate_means,
    mean_tractions,
    profile_of,
    shared,
)

PAGE = Path(__file__).parents[2] / "fortran" / "free_edge.md"


@pytest.mark.parametrize("load", LOADS)
@pytest.mark.parametrize("layup", LAYUPS)
def test_tractions_balance_the_stresses_of_laminate_theory(layup: str, load: str, tmp_path: Path) -> None:
    """The shears over half of the width hold the outer ply; the normal stress has no resultant.

    Laminate theory is that of a wide strip. This one has an eighth of its width next to the edges, whose plies are free
    to contract: cooled, it shortens a little differently.
    """
    means = mean_tractions(profile_of(EdgeCase(layup, load, 1), tmp_path), WIDTH)
    expected = laminate_means(layup, load)
    scale = np.abs(expected).max()
    tolerance = (0.01 if load == "stretched" else 0.02) * scale
    assert [means["TS"], means["TT"]] == pytest.approx(expected, abs=tolerance)
    assert abs(means["TN"]) < 1e-6 * scale


def test_laminate_theory_of_a_cross_ply() -> None:
    """By hand, Pipes and Pagano's plies [0/90]: no contraction of their own, sigma_y of the outer ply."""
    ratio, stretch = 0.21 * 14.48 / 137.9, 1e-3
    q11, q22 = (modulus / (1 - 0.21 * ratio) for modulus in (137.9e3, 14.48e3))
    q12 = 0.21 * q22
    contraction = -2 * q12 * stretch / (q11 + q22)
    shear, across = laminate_means("0/90", "stretched")
    assert abs(shear) < 1e-12
    assert across == pytest.approx(-(q12 * stretch + q22 * contraction) / WIDTH)


def page() -> dict[tuple[str, str, str], list[float]]:
    """Numbers of the page by laminate, load and stress."""
    rows = re.findall(r"^\| \[(.*?)\]s \| (\w+) \| (\w+) \| (.*) \|$", PAGE.read_text("utf-8"), re.MULTILINE)
    return {
        (layup, load, stress): [float(cell.removesuffix(" %")) for cell in cells.split(" | ")]
        for layup, load, stress, cells in rows
    }


def test_what_the_page_says_of_its_numbers() -> None:
    rows = page()
    assert list(rows) == [(*key, stress) for key in product(LAYUPS, LOADS) for stress in SHOWN[key]]
    for (_, _, stress), (_, *errors) in rows.items():
        ours, averages = np.abs(errors[::2]), np.abs(errors[1::2])
        assert len(ours) == len(BRICKS)
        assert ours[0] < 10.0 and ours[-1] < 2.0
        assert list(ours) == sorted(ours, reverse=True)
        if stress != "TN":
            assert 50.0 < averages[0] < 75.0 and 15.0 < averages[-1] < 35.0


@pytest.mark.parametrize(
    ("layup", "load"), [pytest.param(*key, marks=[pytest.mark.long] * (key != ("+-45", "cooled"))) for key in SHOWN]
)
def test_page_has_what_runs_give(layup: str, load: str, tmp_path: Path) -> None:
    exact = finest(layup, load, tmp_path)
    case = EdgeCase(layup, load, BRICKS[0])
    found = cut(case, tmp_path), shared(case, tmp_path).means()
    assert FINE == 12
    for stress in SHOWN[layup, load]:
        value, *errors = page()[layup, load, stress]
        assert exact[stress] == pytest.approx(value, rel=2e-3)
        assert [100 * (means[stress] / exact[stress] - 1) for means in found] == pytest.approx(errors[:2], abs=0.2)
