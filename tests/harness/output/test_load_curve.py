# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The load-displacement curve that is found in a history."""

import numpy as np
import pytest

from uel.output.pictures.load_curve import load_curve

N = 4
RAMP = np.arange(1.0, N + 1.0)
STILL = np.zeros(N)
HEAD = {"step": np.ones(N), "increment": RAMP, "time": RAMP / N}


def found(**columns):
    """The curve in a history, whose columns are given with __ for [ and a : for _ in the place."""
    named = {f"{name.replace('__', '[').replace('_', ':')}]": values for name, values in columns.items()}
    return load_curve({**HEAD, **named})


def test_the_force_that_works_and_not_the_one_that_holds():
    curve = found(U2__CLAMP=STILL, RF2__CLAMP=-9.0 * RAMP, U2__TIP=0.1 * RAMP, RF2__TIP=3.0 * RAMP)
    assert (curve.x_name, curve.y_name) == ("U2[TIP]", "RF2[TIP]")
    assert curve.y == pytest.approx(3.0 * RAMP)
    assert curve.peak == N - 1
    assert curve.increment[curve.peak] == N


def test_force_and_displacement_of_one_component_belong_together():
    curve = found(U1__TIP=5.0 * RAMP, U2__TIP=0.1 * RAMP, RF2__TIP=RAMP)
    assert (curve.x_name, curve.y_name) == ("U2[TIP]", "RF2[TIP]")
    assert found(U1__TIP=5.0 * RAMP, RF2__TIP=RAMP) is None
    assert found(NT11__TIP=RAMP, RFL11__TIP=RAMP) is None


@pytest.mark.parametrize("sign", [1.0 - 1e-12, 1.0 + 1e-12])
def test_of_equal_ones_the_first(sign):
    """Both arms of a double cantilever beam: rounding does not choose."""
    arms = {"U2__TOP": RAMP, "RF2__TOP": RAMP, "U2__LOW": -sign * RAMP, "RF2__LOW": -sign * RAMP}
    assert found(**arms).y_name == "RF2[TOP]"


def test_set_that_moves_as_one_has_the_sum():
    columns = {"U1__TIP_1": RAMP, "RF1__TIP_1": 2.0 * RAMP, "U1__TIP_2": RAMP, "RF1__TIP_2": 3.0 * RAMP}
    curve = found(**columns)
    assert (curve.x_name, curve.y_name) == ("U1[TIP]", "sum of RF1[TIP]")
    assert curve.y == pytest.approx(5.0 * RAMP)
    turned = found(**{**columns, "U1__TIP_2": 2.0 * RAMP})
    assert (turned.x_name, turned.y_name) == ("U1[TIP:2]", "RF1[TIP:2]")


def test_concentrated_load_and_moment():
    assert found(U1__TIP=RAMP, RF1__TIP=STILL, CF1__TIP=RAMP).y_name == "CF1[TIP]"
    assert found(UR3__TIP=RAMP, RM3__TIP=RAMP).x_name == "UR3[TIP]"


def test_load_factor_where_the_history_has_no_force():
    columns = {"U1[A]": 0.1 * RAMP, "U2[A]": RAMP}
    assert load_curve({**HEAD, **columns}) is None
    curve = load_curve({**HEAD, **columns, "LPF": RAMP})
    assert (curve.x_name, curve.y_name) == ("U2[A]", "LPF")


def test_largest_load_may_be_negative_and_before_the_end():
    force = np.array([-1.0, -3.0, -2.0, 1.0])
    curve = found(U1__TIP=-RAMP, RF1__TIP=force)
    assert curve.peak == 1


def test_rows_without_values_are_left_out():
    """A step that does not ask for the columns leaves their cells empty."""
    gap = np.array([1.0, np.nan, 3.0, np.nan])
    curve = found(U1__TIP=gap, RF1__TIP=gap)
    assert list(curve.increment) == [1.0, 3.0]
    assert load_curve({name: np.zeros(0) for name in HEAD}) is None
    assert found(U1__TIP=np.full(N, np.nan), RF1__TIP=np.full(N, np.nan)) is None
