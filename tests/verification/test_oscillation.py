# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The oscillation index measures what its definition says, on profiles whose index is known."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from harness.delamination.oscillation import (
    cancelled,
    error_index,
    oscillation_index,
    raw_index,
    smooth_variation,
    total_variation,
    turns,
)
from harness.model.arrays import FloatArray

STRENGTH = 60.0


def rise_and_fall(points: int) -> FloatArray:
    """A process zone: up to the strength, down to the other sign, back to zero; total variation 60 + 70 + 10."""
    return np.interp(np.linspace(0.0, 1.0, points), [0.0, 0.25, 0.5, 1.0], [0.0, 60.0, -10.0, 0.0])


def zigzag(points: int) -> FloatArray:
    """1 and -1 in turns: the two integration points of every element differ."""
    return np.where(np.arange(points) % 2 == 0, 1.0, -1.0)


@pytest.mark.parametrize("points", [101, 1001])
def test_smooth_profiles_have_index_1_on_any_mesh(points: int) -> None:
    for profile in (rise_and_fall(points), np.linspace(5.0, -3.0, points), np.full(points, 7.0)):
        assert raw_index(profile, STRENGTH) == pytest.approx(1.0, abs=1e-13)


@pytest.mark.parametrize("amplitude", [0.5, 2.0, 10.0])
def test_zigzag_within_elements_counts_twice_its_amplitude_at_every_point(amplitude: float) -> None:
    points = 401
    profile = rise_and_fall(points) + amplitude * zigzag(points)
    # each of 400 steps of the smooth profile has 2 A added or taken away
    steps = np.abs(np.diff(rise_and_fall(points)) + amplitude * np.diff(zigzag(points)))
    assert smooth_variation(profile) == pytest.approx(140.0, rel=0.03)
    assert raw_index(profile, STRENGTH) == pytest.approx(steps.sum() / 140.0, rel=0.03)
    if amplitude > 0.6:  # every step turns
        assert steps.sum() == pytest.approx(400 * 2.0 * amplitude, rel=1e-3)


def test_oscillation_over_the_bonded_part_alone() -> None:
    # 20 waves of 3 MPa beyond the process zone: 40 flanks of 6 MPa, on slopes that rise by 10 MPa in all
    x = np.linspace(0.0, 1.0, 4001)
    waves = np.where(x > 0.5, 3.0 * np.sin(2.0 * np.pi * (x - 0.5) / 0.025), 0.0)
    profile = rise_and_fall(4001) + waves
    # the smooth profile stays 3 MPa inside the turns of the process zone, which do not oscillate: the index errs high
    assert 140.0 - 4 * 3.0 < smooth_variation(profile) < 140.0
    assert raw_index(profile, STRENGTH) == pytest.approx((140.0 - 10.0 + 240.0) / 140.0, rel=0.1)


def test_noise_on_a_monotone_profile() -> None:
    # independent noise of standard deviation s: E|difference| = 2 s/sqrt(pi), far above the steps of 0.03
    noise = np.random.default_rng(3).normal(0.0, 0.5, 2001)
    variation = 2000 * 2.0 * 0.5 / np.sqrt(np.pi)
    profile = np.linspace(0.0, 60.0, 2001) + noise
    assert smooth_variation(profile) == pytest.approx(60.0, rel=0.05)
    assert raw_index(profile, STRENGTH) == pytest.approx(variation / 60.0, rel=0.05)


def test_round_off_of_a_mode_that_is_not_loaded_does_not_count() -> None:
    noise = np.random.default_rng(4).normal(0.0, 1e-6, 500)
    assert raw_index(noise, STRENGTH) == pytest.approx(1.0, abs=1e-4)
    assert raw_index(noise, 1e-6) > 10.0


def test_worse_oscillation_has_a_larger_index() -> None:
    profiles = [rise_and_fall(401) + a * zigzag(401) for a in (0.0, 0.5, 1.0, 2.0, 4.0, 8.0)]
    indices = [raw_index(profile, STRENGTH) for profile in profiles]
    assert indices == sorted(indices)
    assert len(set(indices)) == len(indices)


def test_index_counts_what_the_real_profile_does_not_have() -> None:
    # an interface with bumps: facets carry 5 MPa more and less in turns, in truth
    real = rise_and_fall(401) + 5.0 * zigzag(401)
    assert oscillation_index(real, real, STRENGTH) == 1.0
    assert raw_index(real, STRENGTH) > 20.0
    # a tenth more
    variation = total_variation(real)
    assert variation == pytest.approx(400 * 10.0)
    assert oscillation_index(rise_and_fall(401) + 5.5 * zigzag(401), real, STRENGTH) == pytest.approx(1.1)
    assert error_index(rise_and_fall(401) + 5.5 * zigzag(401), real, STRENGTH) == pytest.approx(1.1)


def test_nothing_cancels_in_the_error_index() -> None:
    # up and down where the real one goes down and up: the same variation, 4 each, and a difference of 8
    profile, real = np.array([0.0, 2.0, 0.0]), np.array([0.0, -2.0, 0.0])
    assert oscillation_index(profile, real, 1.0) == 1.0
    assert error_index(profile, real, 1.0) == 1.0 + 8.0 / 4.0
    # a constant is no variation
    assert error_index(real + 3.0, real, 1.0) == 1.0


def test_a_mode_that_is_not_loaded_is_measured_by_its_strength() -> None:
    profile, real = np.array([0.0, 6.0, 0.0]), np.zeros(3)
    assert oscillation_index(profile, real, STRENGTH) == 1.0 + 12.0 / 60.0
    assert error_index(profile, real, STRENGTH) == 1.0 + 12.0 / 60.0


def test_turns() -> None:
    assert turns(np.array([0.0, 1.0, 1.0, 2.0, 2.0, 1.0, 3.0, 3.0])).tolist() == [0.0, 2.0, 1.0, 3.0]
    assert turns(np.array([4.0, 4.0])).tolist() == [4.0]
    assert turns(np.array([])).tolist() == []
    assert total_variation(np.array([0.0, 2.0, 1.0, 3.0])) == 5.0


def test_a_pair_at_an_end_loses_the_end_alone() -> None:
    for profile, kept in (([1.0, 0.0, 5.0, 2.0], [0.0, 5.0, 2.0]), ([2.0, 5.0, 0.0, 1.0], [2.0, 5.0, 0.0])):
        left, largest = cancelled(np.array(profile), 2)
        assert (left.tolist(), largest) == (kept, 1.0)
    assert cancelled(np.array([0.0, 5.0, 4.0, 9.0]), 2)[0].tolist() == [0.0, 9.0]


@given(st.lists(st.integers(0, 9), min_size=2, max_size=8), st.integers(1, 4))
def test_no_profile_of_as_few_pieces_is_nearer_than_half_of_what_cancelled(values: list[int], pieces: int) -> None:
    profile = np.array(values, dtype=float)
    kept, largest = cancelled(profile, pieces)
    assert len(kept) <= pieces + 1
    assert nearest(profile, pieces) == 0.5 * largest


def nearest(profile: FloatArray, pieces: int) -> float:
    """Least largest distance to a profile of at most so many monotone pieces, by trying all places of the turns."""

    def distance(part: FloatArray, sign: int) -> float:
        """From the nearest rising (1) or falling (-1) profile: half the largest fall or rise."""
        return 0.5 * max([0.0, *(float(sign * (a - b)) for a, b in itertools.combinations(part, 2))])

    best = np.inf
    for cuts in itertools.combinations(range(1, len(profile)), min(pieces, len(profile)) - 1):
        parts = [profile[a:b] for a, b in itertools.pairwise([0, *cuts, len(profile)])]
        for sign in (1, -1):
            best = min(best, max(distance(part, sign * (-1) ** k) for k, part in enumerate(parts)))
    return best
