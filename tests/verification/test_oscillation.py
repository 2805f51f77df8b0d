# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The oscillation index measures what its definition says, on profiles whose index is known."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import ellipe

from uel.delamination.oscillation import (
    cancelled,
    error_index,
    oscillation_index,
    raw_index,
    smooth_variation,
    surface_index,
    surface_variation,
    total_variation,
    turns,
)
from uel.model.arrays import FloatArray

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


SIZE, TURN = 20.0, np.radians(15.0)


def front(places: FloatArray, angle: float) -> FloatArray:
    """A process zone that runs at an angle to the y axis through the middle of a square of 20."""
    along = (places[..., 0] - SIZE / 2) * np.cos(angle) + (places[..., 1] - SIZE / 2) * np.sin(angle)
    values: FloatArray = np.interp(along, [-5.0, -2.0, 1.0, 5.0], [0.0, 60.0, -10.0, 0.0])
    return values


def square(points: int, *, turned: float = 0.0, moved: float = 0.0) -> FloatArray:
    """Points of a square of 20: lines across leaning by an angle, fading out at the ends; or moved at random.

    moved  in distances between points
    """
    x, y = np.meshgrid(np.linspace(0.0, SIZE, points), np.linspace(0.0, SIZE, points))
    lean = np.tan(turned) * np.minimum(1.0, np.minimum(x, SIZE - x) / 4.0)
    places = np.stack([x + lean * (y - SIZE / 2), y], axis=-1)
    shift = moved * SIZE / (points - 1) * np.random.default_rng(15).uniform(-1.0, 1.0, places.shape)
    shift[:, [0, -1], 0] = shift[[0, -1], :, 1] = 0.0
    return np.asarray(places + shift)


SURFACES = {
    "aligned": square(81),
    "fine": square(161),
    "turned": square(81, turned=TURN),
    "moved": square(81, moved=0.03),
    "irregular": square(81, turned=TURN, moved=0.25),
}


@pytest.mark.parametrize("angle", [0.0, 7.0, 15.0])
@pytest.mark.parametrize("mesh", SURFACES)
def test_smooth_front_has_the_same_variation_on_any_mesh(mesh: str, angle: float) -> None:
    # up by 60, down by 70, up by 10, over a front of 20/cos(angle)
    places, turn = SURFACES[mesh], np.radians(angle)
    variation = surface_variation(places, front(places, turn), SIZE)
    # its corners lie between the points, of which there are 12 on the steepest flank
    assert variation == pytest.approx(140.0 / np.cos(turn), rel=0.03)


def test_smooth_front_has_index_1_against_finer_points() -> None:
    fine = square(161)[:-1, :-1]
    coarse = fine.reshape(80, 2, 80, 2, 2).mean(axis=(1, 3))
    for turn in (0.0, TURN):
        real = front(fine, turn).reshape(80, 2, 80, 2).mean(axis=(1, 3))
        assert surface_index(coarse, front(coarse, turn), real, STRENGTH, SIZE) == pytest.approx(1.0, abs=0.02)


def test_field_along_the_front_is_the_profile() -> None:
    rng = np.random.default_rng(7)
    profile, x, y = rng.normal(size=50), np.cumsum(rng.uniform(0.1, 1.0, 50)), np.linspace(0.0, 8.0, 9)
    places = np.stack(np.meshgrid(x, y), axis=-1)
    field = np.tile(profile, (9, 1))
    expected = total_variation(profile)
    assert surface_variation(places, field, 8.0) == pytest.approx(expected, rel=1e-12)
    real = np.tile(np.linspace(0.0, 70.0, 50), (9, 1))
    index = surface_index(places, field, real, STRENGTH, 8.0)
    assert index == pytest.approx(oscillation_index(profile, real[0], STRENGTH), rel=1e-12)
    # neither the order of rows and columns nor the place of the surface matters
    c, s = np.cos(0.7), np.sin(0.7)
    for other, values in (
        (places[::-1], field[::-1]),
        (places[:, ::-1], field[:, ::-1]),
        (np.swapaxes(places, 0, 1), field.T),
        (places @ np.array([[c, s], [-s, c]]) + 3.0, field),
    ):
        assert surface_variation(other, values, 8.0) == pytest.approx(expected, rel=1e-11)


@pytest.mark.parametrize("amplitude", [0.5, 2.0])
def test_checkerboard(amplitude: float) -> None:
    # slopes of 2 A/h both ways at every corner of a cell; on lines across that lean, 2 A/h along and, across,
    # (2 A -+ tan 2 A)/h as the diagonal connects equals or not: the sides are h and h/cos long
    cells = 40
    x, y = np.meshgrid(np.arange(cells + 1.0), np.arange(cells + 1.0))
    field = amplitude * (-1.0) ** (x + y)
    area, slope = float(cells**2), 2.0 * amplitude
    for lean in (0.0, np.tan(TURN)):
        places = np.stack([x + lean * y, y], axis=-1)
        expected = slope * 0.5 * (np.hypot(1.0, 1.0 - lean) + np.hypot(1.0, 1.0 + lean)) * area
        assert surface_variation(places, field, 1.0) == pytest.approx(expected, rel=1e-12)
    # on a smooth front the slopes along it add to those of the front and lessen them in turns
    places = 0.5 * np.stack([x, y], axis=-1)
    smooth = front(places, 0.0)
    index = surface_index(places, smooth + field, smooth, STRENGTH, SIZE)
    steps, change = np.diff(smooth[0]), 2.0 * amplitude
    variation = np.mean([np.hypot(steps + sign * change, change) for sign in (1.0, -1.0)], axis=0).sum()
    assert index == pytest.approx(variation / 140.0, rel=1e-12)


def test_noise_on_a_surface() -> None:
    # differences to two neighbours share a point: variances 3 and 1 along the diagonals, whose mean length is this
    places, deviation = square(201), 0.3
    noise = np.random.default_rng(3).normal(0.0, deviation, places.shape[:2])
    mean = np.sqrt(2.0 / np.pi) * np.sqrt(3.0) * ellipe(2.0 / 3.0) * deviation / 0.1
    assert surface_variation(places, noise, 1.0) == pytest.approx(mean * SIZE**2, rel=0.01)
