# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Line searches on functions of the scale alone."""

import pytest

from uel.model.controls import LineSearchControls
from uel.solver.linesearch import REFINEMENTS, descend, search


def scales(g, **controls):
    return search(g, g(0.0), g(1.0), LineSearchControls(**{"n_ls": 5, **controls}))


def test_a_good_correction_is_taken_as_it_is():
    assert scales(lambda s: 1.0 - 0.8 * s) == (1.0, (1.0,))


def test_overshoot_is_cut_to_the_root():
    """g = 1 - 4 s: the secant through both ends meets the root 1/4."""
    assert scales(lambda s: 1.0 - 4.0 * s) == (0.25, (1.0, 0.25))


def test_curved_component_is_bracketed():
    """g = 1 - 8 s^3, root 1/2; ends with |g| <= 0.01, one end of the interval does not stay for ever."""
    best, tried = scales(lambda s: 1.0 - 8.0 * s**3, f_s=0.01, eta_s=1e-3, n_ls=20)
    assert best == pytest.approx(0.5, abs=1e-3)
    assert len(tried) < 10


def test_longer_steps_only_up_to_s_max():
    def g(s):
        return 1.0 - 0.1 * s

    assert scales(g) == (1.0, (1.0,))
    assert scales(g, s_max=4.0) == (4.0, (1.0, 4.0))
    assert scales(g, s_max=20.0) == (pytest.approx(10.0), (1.0, pytest.approx(10.0)))


def test_smallest_scale():
    best, tried = scales(lambda s: 1.0 - 1e6 * s, s_min=0.01)
    assert min(tried) == 0.01
    assert best == 0.01


def test_number_of_evaluations_and_change_of_scale_end_the_search():
    def g(s):
        return 1.0 - 1e3 * s**9

    assert len(scales(g, n_ls=3, f_s=1e-9, eta_s=1e-9)[1]) == 4
    assert len(scales(g, n_ls=50, f_s=1e-9, eta_s=0.5)[1]) < len(scales(g, n_ls=50, f_s=1e-9, eta_s=1e-9)[1])


def test_a_correction_that_goes_uphill_is_not_searched():
    assert scales(lambda s: -1.0 + 3.0 * s) == (1.0, (1.0,))


def test_descent_takes_a_good_scale_at_once():
    assert descend(lambda s: 1.0 - 0.8 * s, 1.0) == (1.0, (1.0,))


def test_descent_lengthens_the_step_and_then_finds_the_root():
    """g = 1 - s/10: 1 and 4 are still downhill, 16 is too far, the secant through 4 and 16 meets the root."""
    assert descend(lambda s: 1.0 - 0.1 * s, 1.0) == (pytest.approx(10.0), (1.0, 4.0, 16.0, pytest.approx(10.0)))


def test_descent_down_an_endless_slope_takes_the_longest_step():
    assert descend(lambda s: 1.0 + s, 1.0) == (64.0, (1.0, 4.0, 16.0, 64.0))


def test_descent_backs_off_where_an_element_refuses():
    assert descend(lambda s: None if s > 0.3 else 1.0 - 3.0 * s, 1.0) == (0.25, (1.0, 0.5, 0.25))


def test_descent_keeps_what_is_downhill_if_nothing_is_small():
    """g jumps from 2 to -2 at s = 1.6: no |g| < g(0); the bracket ends at its lower side."""
    scale, tried = descend(lambda s: 2.0 if s < 1.6 else -2.0, 1.0)
    assert 1.0 <= scale < 1.6
    assert len(tried) == 2 + REFINEMENTS


def test_descent_without_a_downhill_scale_finds_none():
    scale, tried = descend(lambda s: -5.0, 1.0)
    assert scale == 0.0
    assert len(tried) == 1 + REFINEMENTS
