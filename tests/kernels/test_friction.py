# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Coulomb friction on the damaged share of a closed point of the consistent law."""

import numpy as np
import pytest

MU = 0.4
BETA = {"BETAN": 4.0e4, "BETAT": 4.0e4}
SHARP = {**BETA, "BETAT": 2.0e4}
STIFFNESSES = [2.0e4, 1.0e12, 0.0]
EDGE = np.array([[0.3, 0.1], [-0.1, 0.3]]) / np.sqrt(0.1)  # tangent of the edge and its normal


def apart(*gap):
    """Displacements that part the quads by a gap (tau, n) without straining them: p = beta g."""
    u = np.zeros((8, 2))
    u[4:] = np.asarray(gap) @ EDGE
    return u


def rubbing(element, interface, alpha, sliding, **values):
    """An element that slid so far while closed, without friction: damage of the same increment has none."""
    item = element(
        4, interface.eight, **{"ALPHAN": alpha, "ALPHAT": alpha, "CLOSURE": 1, "FRICTION": MU, **BETA, **values}
    )
    item.advance(apart(sliding, -1e-3))
    return item


@pytest.mark.parametrize("alpha", STIFFNESSES)
@pytest.mark.parametrize("way", [1, -1])
def test_failed_point_slides_at_the_coefficient_of_friction(element, interface, alpha, way):
    """And sticks when it turns back: T_tau = p_tau - beta w until it reaches -mu |T_n|."""
    item = rubbing(element, interface, alpha, 0.05 * way)
    assert (item.state["DAMAGE"] == 1).all()
    share = alpha / (alpha + BETA["BETAN"]) if alpha else 1.0
    rubbed, slid = 0.0, item.state["WT"]
    for gap, normal, limit in ((0.06, -2e-3, 1), (0.07, -3e-3, 1), (0.0697, -3e-3, 0), (0.06, -3e-3, -1)):
        item.advance(apart(way * gap, normal))
        pressure = -share * BETA["BETAN"] * normal
        np.testing.assert_allclose(item.state["TN"], -pressure, rtol=1e-10)
        trial = BETA["BETAT"] * way * gap
        np.testing.assert_allclose(item.state["TT"], trial - BETA["BETAT"] * item.state["WT"], rtol=1e-8)
        if limit:
            np.testing.assert_allclose(item.state["TT"], limit * way * MU * pressure, rtol=1e-10)
        else:
            np.testing.assert_array_equal(item.state["WT"], slid)
            assert (abs(item.state["TT"]) < 0.9 * MU * pressure).all()
        rubbed += item.state["TT"] * (item.state["WT"] - slid)
        slid = item.state["WT"]
        np.testing.assert_allclose(item.state["DISSF"], rubbed, rtol=1e-12)
    assert (item.state["DISSF"] > 0).all()
    # it parts, and friction is over
    item.advance(apart(way * 0.06, 1e-3))
    np.testing.assert_array_equal(item.state["TT"], 0)
    np.testing.assert_allclose(item.state["DISSF"], rubbed, rtol=1e-12)


@pytest.mark.parametrize("alpha", STIFFNESSES)
def test_damaged_point_rubs_on_its_damaged_share(element, interface, reference, law, alpha):
    item = rubbing(element, interface, alpha, 0.006)
    law = {**law, "ALPHAN": alpha, "ALPHAT": alpha}
    for gap in (0.008, 0.011, 0.015):
        before = item.state["DAMAGE"]
        item.advance(apart(gap, -1e-3))
        assert (item.state["DAMAGE"] > before).all() and (item.state["DAMAGE"] < 1).all()
        for k in (0, 1):
            w = item.state["WT"][k]
            expected = reference.law_traction(law, np.array([w, 0.0]))[0] - MU * before[k] * item.state["TN"][k]
            np.testing.assert_allclose(item.state["TT"][k], expected, rtol=1e-8, atol=1e-15 * alpha * w)
    # back and forth at the same damage: the law unloads to the origin, friction lags behind by twice its limit
    damage, w = item.state["DAMAGE"], item.state["WT"]
    cohesive = item.state["TT"] + MU * before * item.state["TN"]
    for gap in (0.010, 0.004):
        item.advance(apart(gap, -1e-3))
        np.testing.assert_allclose(item.state["DAMAGE"], damage, rtol=1e-13)
        expected = cohesive * item.state["WT"] / w + MU * damage * item.state["TN"]
        np.testing.assert_allclose(item.state["TT"], expected, rtol=1e-9)


@pytest.mark.parametrize("alpha", STIFFNESSES)
def test_no_friction_where_it_is_open_or_sound(element, interface, alpha):
    paths = {"sound": [(1e-5, -1e-3), (-1e-5, -2e-3)], "open": [(0.004, 1e-3), (0.005, 2e-3), (0.03, 1e-3)]}
    for path in paths.values():
        with_friction, without = (
            element(4, interface.eight, ALPHAN=alpha, ALPHAT=alpha, CLOSURE=1, FRICTION=mu, **BETA) for mu in (MU, 0.0)
        )
        for gap in path:
            for found, expected in zip(with_friction.advance(apart(*gap)), without.advance(apart(*gap)), strict=True):
                np.testing.assert_array_equal(found, expected)
        np.testing.assert_array_equal(with_friction.state["DISSF"], 0)


@pytest.mark.parametrize("alpha", STIFFNESSES)
def test_an_increment_begins_with_sticking_after_one_with_sliding(element, interface, alpha):
    """Its shear is the friction but for rounding, which would choose the tangent otherwise."""
    for gap in np.random.default_rng(5).uniform((0.06, -2e-3), (0.07, -1e-3), (50, 2)):
        item = rubbing(element, interface, alpha, 0.05)
        item.advance(apart(*gap))
        sticking = item.evaluate(apart(gap[0] - 1e-4, gap[1]))[1]
        sliding = item.evaluate(apart(gap[0] + 1e-4, gap[1]))[1]
        assert abs(sliding - sticking).max() > 1e-3 * abs(sticking).max()
        tangent = item.evaluate(apart(*gap))[1]
        np.testing.assert_allclose(tangent, sticking, atol=1e-8 * abs(sticking).max())


@pytest.mark.parametrize("alpha", STIFFNESSES)
@pytest.mark.parametrize("values", [{}, SHARP, {"VISCOSITY": 0.02}, {"BETAN": 0.0, "BETAT": 0.0, "ANGLE TOP": 40.0}])
@pytest.mark.parametrize(
    ("sliding", "gap", "sticks"),
    [
        (0.05, (0.06, -1e-3), False),
        (0.05, (0.04999, -1e-3), True),
        (0.012, (0.016, -1e-3), False),
        (0.012, (0.01199, -1e-3), True),
        (0.012, (-0.004, -2e-3), False),
        (-0.012, (-0.014, -2e-3), False),
    ],
)
def test_tangent(element, interface, reference, alpha, values, sliding, gap, sticks):
    item = rubbing(element, interface, alpha, sliding, **values)
    slid = item.state["WT"]
    u = apart(*gap) + 1e-6 * np.random.default_rng(3).normal(size=(8, 2))
    tangent = item.evaluate(u)[1]
    differences = -reference.central_differences(lambda x: item.evaluate(x)[0], u.ravel(), step=2e-6)
    assert abs(tangent - differences).max() <= 1e-8 * abs(tangent).max()
    item.advance(u)
    assert (item.state["WT"] == slid).all() == sticks


@pytest.mark.parametrize("alpha", STIFFNESSES)
def test_energies_sum_up_to_the_work_on_the_separation(element, interface, alpha):
    """Stored + damage + friction = work of T over w; friction by backward Euler, the rest by trapezia, which err in the
    increments that hold the onset and the failure: by the strength times half of an increment, 60 MPa x 2e-4 mm, of 1
    N/mm and more. Damage dissipates G_IIc to rounding."""
    item = element(4, interface.eight, ALPHAN=alpha, ALPHAT=alpha, CLOSURE=1, FRICTION=MU, **BETA)
    path = [*np.linspace(0, 0.015, 60)[1:], *np.linspace(0.015, -0.02, 90)[1:], *np.linspace(-0.02, 0.04, 90)[1:]]
    work, before, cohesive, friction = np.zeros(2), np.zeros(2), np.zeros(2), 0.0
    for sliding in path:
        rubbed, sound = item.state["DISSF"], item.state["DAMAGE"] == 0
        item.advance(apart(sliding, -1e-3))
        w, step = item.state["WT"], item.state["DISSF"] - rubbed
        moved = w != before
        friction = np.divide(step, w - before, out=np.zeros(2), where=moved)
        new = np.where(moved | sound, item.state["TT"] - friction, cohesive)
        work += 0.5 * (cohesive + new) * (w - before) + step
        before, cohesive = w, new
        assert (step >= 0).all()
    state = item.state
    contact = 0.5 * state["TN"] * state["WN"]
    length, thickness = np.linalg.norm(np.diff(interface.edge, axis=0)), 2.0
    energy = item.energy * 2 / (length * thickness)
    assert energy[1] + energy[3] == pytest.approx((work + contact).sum(), abs=2 * 60 * 2e-4)
    assert energy[3] == pytest.approx((state["DISSII"] + state["DISSF"]).sum(), rel=1e-12)
    np.testing.assert_allclose(state["DISSII"], 1.002, rtol=1e-12)
    assert (state["DISSF"] > 0.1).all()


@pytest.mark.parametrize("alpha", STIFFNESSES)
@pytest.mark.parametrize("viscosity", [0.0, 1.0])
def test_a_point_that_closes_has_the_damage_of_its_shear(element, interface, alpha, viscosity):
    """With G_IIc < G_Ic the law of pure shear is weaker than that of the mode mix in which the point opened.

    Closing takes the opening away. From then on the damage is that of the shear, though friction holds the point; if it
    were not, the point would slide on when it is pushed back, and friction would give energy.
    """
    weak = {"LAW": 2, "ETA": 3.5, "GIC": 0.8, "GIIC": 0.2, "SIGMAMAX": 30.0, "TAUMAX": 30.0}
    values = {**weak, "ALPHAN": alpha, "ALPHAT": alpha, "CLOSURE": 1, "FRICTION": MU, **BETA, "VISCOSITY": viscosity}
    item = element(4, interface.eight, **values)
    for gap in ((4e-3, 1.4e-3), (8.5e-3, 2.9e-3)):
        item.advance(apart(*gap))
    opened = item.state
    assert (opened["DAMAGE"] > 0).all() and (opened["DAMAGE"] < 1).all()
    item.advance(apart(8.5e-3, -5e-2))
    closed = item.state
    assert (closed["DAMAGE"] > opened["DAMAGE"] + 0.01).all()
    for tau in (7e-3, 5e-3, 2e-3, -2e-3):
        before = item.state
        item.advance(apart(tau, -2e-2))
        rubbed = item.state["DISSF"] - before["DISSF"]
        assert (rubbed >= -1e-12).all()
        assert (item.state["WT"] <= before["WT"] * (1 + 1e-12)).all()
