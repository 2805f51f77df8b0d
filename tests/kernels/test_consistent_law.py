# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The consistent stabilised law: t(w; history) + beta w = p, T = t(w), in U4."""

import numpy as np
import pytest

STIFFNESSES = [1.0e4, 1.0e12, 0.0]
STATES = ("elastic", "softening", "sliding", "closed", "failed", "mixed", "unloading")
TURNED = {"ANGLE BOTTOM": 30.0, "ANGLE TOP": -55.0}
GIVEN = {"BETAN": 6.0e4, "BETAT": 2.0e4, "GAMMABOT": 0.3}
OPTIONS = {
    "as computed": {},
    "newton-cotes": {"INTEGRATION": 1},
    "given beta": GIVEN,
    "face": {"SAMPLING": 1, **GIVEN},
    "gauss point": {"SAMPLING": 2},
    "plane strain": {"PLANE": 1},
}


def rigid(alpha):
    """Properties of the consistent law with a stiffness, 0 for an infinite one."""
    return {"ALPHAN": alpha, "ALPHAT": alpha, "CLOSURE": 1}


def vectors(state, normal, tangential):
    """Two state variables as (points, 2) in (tau, n)."""
    return np.transpose([state[tangential], state[normal]])


def trial(reference, interface, ply, u, options):
    """p and beta of both points."""
    plane, rule = options.get("PLANE", 0) == 1, options.get("INTEGRATION", 0)
    elasticity = [reference.elasticity(ply, options.get(f"ANGLE {side}", 0.0), plane) for side in ("BOTTOM", "TOP")]
    points = [reference.trial_traction(interface.eight, u, options, s, elasticity) for s in reference.POINTS[rule]]
    return np.array([p for p, *_ in points]), points[0][2]


@pytest.mark.parametrize("alpha", STIFFNESSES)
@pytest.mark.parametrize("ratio", [1.0, 2.5])
@pytest.mark.parametrize("name", OPTIONS)
def test_law_at_its_own_separation(element, interface, reference, law, ply, alpha, ratio, name):
    """t(w) + beta w = p with the paper's equations for t, in every state that loads from scratch."""
    options = {**OPTIONS[name], **TURNED}
    values = {**rigid(alpha), "ALPHAT": ratio * alpha}
    law = {**law, **values}
    for state in ("elastic", "softening", "failed"):
        u = interface.displacements(8, *interface.states[state], seed=5)
        item = element(4, interface.eight, **values, **options)
        item.advance(u)
        p, beta = trial(reference, interface, ply, u, options)
        w, traction = vectors(item.state, "WN", "WT"), vectors(item.state, "TN", "TT")
        for k in (0, 1):
            # p is what it is to rounding; from w, t follows to rounding times alpha
            rtol, atol = 1e-9, 1e-11 * abs(p[k]).max()
            np.testing.assert_allclose(traction[k] + beta * w[k], p[k], rtol=rtol, atol=atol)
            if p[k, 1] > 0 and np.hypot(*w[k]) > 0:
                rounding = 1e-15 * alpha * abs(w[k]).max()
                np.testing.assert_allclose(
                    traction[k], reference.law_traction(law, w[k]), rtol=1e-8, atol=rounding + 1e-7
                )


@pytest.mark.parametrize("name", OPTIONS)
@pytest.mark.parametrize("alpha", STIFFNESSES[:-1])
def test_before_the_onset_it_is_the_papers_element(element, interface, name, alpha):
    """Equation (16), with its tangent."""
    strong = {"SIGMAMAX": 1e5, "TAUMAX": 1e5, "GIC": 1e8, "GIIC": 1e8}
    for state in ("elastic", "softening", "closed", "sliding"):
        # the paper's damage starts where alpha g reaches the strength
        u = min(1.0, 5e6 / alpha) * interface.displacements(8, *interface.states[state], seed=5)
        values = {**OPTIONS[name], **strong, "ALPHAN": alpha, "ALPHAT": 0.5 * alpha}
        two = [element(4, interface.eight, CLOSURE=closure, **values) for closure in (2, 1)]
        (paper, paper_tangent), (ours, tangent) = (item.advance(u) for item in two)
        np.testing.assert_allclose(ours, paper, rtol=1e-11, atol=1e-11 * abs(paper).max())
        np.testing.assert_allclose(tangent, paper_tangent, atol=1e-12 * abs(tangent).max())
        for variable in ("TN", "TT", "SN", "ST", "SEPN", "SEPT", "DAMAGE"):
            np.testing.assert_allclose(two[1].state[variable], two[0].state[variable], rtol=1e-9, err_msg=variable)


def prepared(element, interface, state, seed, **values):
    """The element with a history, and displacements of the state."""
    # a soft law starts to soften at larger separations
    scale = 3.0 if values["ALPHAN"] == STIFFNESSES[0] else 1.0
    item = element(4, interface.eight, **values)
    if state == "elastic":
        return item, 0.05 * interface.displacements(8, *interface.states["softening"], seed)
    if state == "unloading":
        u = scale * interface.displacements(8, *interface.states["softening"], seed)
        item.advance(u)
        return item, 0.6 * u
    item.advance(scale * interface.displacements(8, (0.0021, 0.0007), (0.0019, 0.0008), seed + 100))
    return item, scale * interface.displacements(8, *interface.states[state], seed)


@pytest.mark.sample(3)
@pytest.mark.parametrize("state", STATES)
@pytest.mark.parametrize("alpha", STIFFNESSES)
def test_tangent(element, interface, reference, alpha, state):
    variants = [*OPTIONS.values(), {"VISCOSITY": 0.3}, {"VISCOSITY": 0.3, **GIVEN}, {"ALPHAT": 3 * alpha, **TURNED}]
    variants += [{"VISCOSITY": 0.3, "PACING": 1}]
    for variant in variants:
        for seed in range(2):
            item, u = prepared(element, interface, state, seed, **{**rigid(alpha), **variant})
            tangent = item.evaluate(u)[1]
            if state == "failed" and "VISCOSITY" not in variant:
                assert not tangent.any()
                continue
            differences = -reference.central_differences(lambda x, item=item: item.evaluate(x)[0], u.ravel(), step=4e-6)
            assert abs(tangent).max() > 0
            assert abs(tangent - differences).max() <= 1e-9 * abs(tangent).max()


@pytest.mark.parametrize("alpha", STIFFNESSES)
def test_states_are_what_their_names_say(element, interface, alpha):
    """The battery above sees every branch."""
    damage, closed = {}, {}
    for state in STATES:
        item, u = prepared(element, interface, state, 0, **rigid(alpha))
        before = item.state["DAMAGE"]
        item.advance(u)
        damage[state] = (before, item.state["DAMAGE"])
        closed[state] = item.state["TN"] < 0
    for state in ("softening", "sliding"):
        assert (damage[state][1] > damage[state][0]).all() and (damage[state][1] < 1).all()
    for state in ("closed", "unloading"):
        np.testing.assert_array_equal(damage[state][0], damage[state][1])
        assert (damage[state][0] > 0).all()
    np.testing.assert_array_equal(damage["elastic"][1], 0)
    assert (damage["failed"][1] == 1).all()
    assert damage["mixed"][1].max() == 1
    assert closed["closed"].all() and closed["sliding"].all()
    assert closed["mixed"].any() and not closed["softening"].any()


@pytest.mark.sample(3)
@pytest.mark.parametrize("alpha", STIFFNESSES)
@pytest.mark.parametrize("degrees", [0, 17, 45, 80, 90])
def test_law_is_recovered_and_its_area_is_the_fracture_energy(element, interface, reference, law, alpha, degrees):
    """Quads that only part: T over w is the law, and both energy measures fulfil G_I/G_Ic + G_II/G_IIc = 1."""
    item = element(4, interface.eight, **rigid(alpha))
    law = {**law, **rigid(alpha)}
    direction = np.array([np.sin(np.radians(degrees)), np.cos(np.radians(degrees))])
    w, traction = [np.zeros(2)], [np.zeros(2)]
    for gap in np.concatenate([np.geomspace(1e-6, 1e-3, 60), np.linspace(1e-3, 0.04, 600)]):
        item.advance(interface.apart(*(gap * direction)))
        w.append(vectors(item.state, "WN", "WT")[0])
        traction.append(vectors(item.state, "TN", "TT")[0])
    w, traction = np.array(w), np.array(traction)
    for separation, found in zip(w[1::20], traction[1::20], strict=True):
        if np.hypot(*separation) > 0:
            rounding = 1e-15 * alpha * abs(separation).max()
            np.testing.assert_allclose(found, reference.law_traction(law, separation), rtol=1e-8, atol=rounding + 1e-8)
    area = 0.5 * ((traction[1:] + traction[:-1]) * np.diff(w, axis=0)).sum(axis=0)
    np.testing.assert_allclose(area[1] / law["GIC"] + area[0] / law["GIIC"], 1, rtol=2e-3)
    state = item.state
    np.testing.assert_allclose(state["DISSI"] / law["GIC"] + state["DISSII"] / law["GIIC"], 1, rtol=1e-12)
    np.testing.assert_array_equal(state["DAMAGE"], 1)
    assert not item.evaluate(interface.apart(*(0.04 * direction)))[0].any()


@pytest.mark.parametrize("alpha", STIFFNESSES)
def test_strength_is_reached_at_any_stiffness(element, interface, law, alpha):
    item = element(4, interface.eight, **rigid(alpha))
    peak = 0.0
    for gap in np.linspace(0, 0.004, 1001):
        item.advance(interface.apart(0.0, gap))
        peak = max(peak, item.state["TN"].max())
    assert law["SIGMAMAX"] * (1 - 5e-3) < peak <= law["SIGMAMAX"] * (1 + 1e-12)


@pytest.mark.parametrize("alpha", STIFFNESSES)
def test_damage_is_the_dissipated_fraction_in_mode_one(element, interface, law, alpha):
    item = element(4, interface.eight, **rigid(alpha))
    onset = law["SIGMAMAX"] / alpha if alpha else 0.0
    for gap in np.linspace(0.0, 0.025, 61)[1:]:
        item.advance(interface.apart(0.0, gap))
        np.testing.assert_allclose(item.state["DISSI"] / law["GIC"], item.state["DAMAGE"], rtol=1e-12, atol=1e-12)
    assert item.state["WN"].min() > onset


def test_infinite_stiffness_is_the_limit(element, interface):
    """Tractions and damage differ by beta/alpha; beta is 1e5 N/mm^3."""
    path = [interface.displacements(8, *interface.states[s], seed=4) for s in ("elastic", "softening", "sliding")]
    path += [0.3 * path[1], interface.displacements(8, *interface.states["closed"], seed=4)]
    for alpha, rtol in ((1e6, 2e-1), (1e8, 2e-3), (1e12, 2e-7)):
        item = element(4, interface.eight, **rigid(alpha))
        limit = element(4, interface.eight, **rigid(0.0))
        for u in path:
            forces, expected = item.advance(u)[0], limit.advance(u)[0]
            np.testing.assert_allclose(forces, expected, atol=rtol * abs(expected).max())
            np.testing.assert_allclose(item.state["DAMAGE"], limit.state["DAMAGE"], atol=rtol)


def test_rigid_before_onset(element, interface):
    """Infinite stiffness: Nitsche's method (remark 6), T = p, no separation, S = 0."""
    item = element(4, interface.eight, **rigid(0.0))
    for state in ("elastic", "closed"):
        u = 0.01 * interface.displacements(8, *interface.states[state], seed=1)
        item.advance(u)
        for variable in ("WN", "WT", "DAMAGE", "SN", "ST", "DISSI", "DISSII"):
            np.testing.assert_array_equal(item.state[variable], 0, err_msg=variable)
        assert item.energy[[1, 3, 4]].tolist() == [0, 0, 0]


@pytest.mark.parametrize("alpha", [1.0e4, 1.0e12, 0.0])
def test_unloading_is_secant_to_the_origin(element, interface, alpha):
    item = element(4, interface.eight, **rigid(alpha))
    u = interface.displacements(8, *interface.states["softening"], seed=2)
    rhs, _ = item.advance(u)
    damage, w, dissipated = item.state["DAMAGE"], item.state["WN"], item.energy[3]
    for factor in (0.7, 0.2, 0.9, 0.0, 1.0):
        unloaded, _ = item.advance(factor * u)
        np.testing.assert_allclose(unloaded, factor * rhs, rtol=1e-12, atol=1e-12 * abs(rhs).max())
        np.testing.assert_allclose(item.state["WN"], factor * w, rtol=1e-12)
        np.testing.assert_allclose(item.state["DAMAGE"], damage, rtol=1e-13)
        assert item.energy[3] == pytest.approx(dissipated, rel=1e-12)
    fresh = element(4, interface.eight, **rigid(alpha))
    np.testing.assert_allclose(item.evaluate(1.2 * u)[0], fresh.evaluate(1.2 * u)[0], rtol=1e-11)


@pytest.mark.parametrize("alpha", STIFFNESSES)
def test_contact(element, interface, reference, ply, alpha):
    """Closed where p_n < 0: T_n = p_n alpha_n/(alpha_n + beta_n) at any damage; a failed point carries no shear."""
    item = element(4, interface.eight, **rigid(alpha))
    item.advance(interface.displacements(8, *interface.states["failed"], seed=0))
    u = interface.displacements(8, (0.01, -0.002), (0.01, -0.002), seed=0)
    item.advance(u)
    p, beta = trial(reference, interface, ply, u, {})
    assert (p[:, 1] < 0).all()
    share = alpha / (alpha + beta[1]) if alpha else 1.0
    np.testing.assert_allclose(item.state["TN"], share * p[:, 1], rtol=1e-10)
    np.testing.assert_allclose(item.state["WN"], (1 - share) * p[:, 1] / beta[1], rtol=1e-9, atol=1e-15)
    np.testing.assert_array_equal(item.state["TT"], 0)
    np.testing.assert_allclose(item.state["WT"], p[:, 0] / beta[0], rtol=1e-10)
    assert (item.state["DAMAGE"] == 1).all()


@pytest.mark.parametrize("alpha", [1.0e6, 0.0])
def test_traction_is_continuous_where_it_closes(element, interface, alpha):
    item = element(4, interface.eight, **rigid(alpha), VISCOSITY=0.2)
    item.advance(interface.apart(0.005, 0.004), dtime=0.1)
    gaps = np.linspace(0.002, -0.002, 401)
    forces = np.array([item.evaluate(interface.apart(0.005, gap), dtime=0.1)[0] for gap in gaps])
    tangents = abs(item.evaluate(interface.apart(0.005, -0.001), dtime=0.1)[1]).max()
    assert abs(np.diff(forces, axis=0)).max() < 8 * tangents * 1e-5


@pytest.mark.parametrize("pacing", [0, 1])
@pytest.mark.parametrize("alpha", [2.0e4, 1.0e12, 0.0])
def test_viscous_overstress(element, interface, reference, law, ply, alpha, pacing):
    """T = t(w) + VISCOSITY k r dw/dt in opening, k the slope of softening in mode I, r = 1 - D_old or, paced, 1."""
    item = element(4, interface.eight, **rigid(alpha), VISCOSITY=0.4, PACING=pacing)
    law = {**law, **rigid(alpha)}
    slope = reference.softening_slopes(law)[1]
    before, damage = np.zeros((2, 2)), np.zeros(2)
    for gap, dtime in ((0.004, 0.1), (0.006, 0.05), (0.011, 0.2)):
        u = interface.apart(0.3 * gap, gap)
        item.advance(u, dtime=dtime)
        w, traction = vectors(item.state, "WN", "WT"), vectors(item.state, "TN", "TT")
        p, beta = trial(reference, interface, ply, u, {})
        np.testing.assert_allclose(traction + beta * w, p, rtol=1e-9)
        for k in (0, 1):
            overstress = 0.4 * slope * (1.0 if pacing else 1 - damage[k]) * (w[k] - before[k]) / dtime
            expected = reference.law_traction(law, w[k]) + overstress
            np.testing.assert_allclose(traction[k], expected, rtol=1e-7, atol=1e-15 * alpha)
        before, damage = w, item.state["DAMAGE"]
    assert (item.state["DISSV"] > 0).all()
    assert (item.state["DMAX"] == damage).all()
    # no time, no damage
    item.advance(interface.apart(0.0, 0.02), dtime=0.0)
    np.testing.assert_array_equal(item.state["DAMAGE"], damage)


@pytest.mark.parametrize("alpha", STIFFNESSES)
def test_a_paced_point_that_has_failed_carries_nothing(element, interface, alpha):
    """The overstress, which does not fade before failure, is gone from the increment after it on."""
    item = element(4, interface.eight, **rigid(alpha), VISCOSITY=0.4, PACING=1)
    for gap in (0.01, 0.05):
        item.advance(interface.apart(0.0, gap), dtime=0.1)
        assert (item.state["TN"] > 0).all()
    assert (item.state["DAMAGE"] == 1).all()
    item.advance(interface.apart(0.0, 0.06), dtime=0.1)
    assert not item.state["TN"].any()


@pytest.mark.parametrize(
    ("values", "dtime", "growth"),
    [
        ({"VISCOSITY": 0.03, "PACING": 1}, 0.08, 0.03 / 0.3 / 0.08),
        ({"VISCOSITY": 0.03, "PACING": 1}, 0.5, 1.0),
        ({"VISCOSITY": 0.03, "PACING": 1}, 0.02, None),
        ({"VISCOSITY": 0.03, "PACING": 1}, 0.0, None),
        ({"VISCOSITY": 0.03}, 0.08, None),
        ({"PACING": 1}, 0.08, None),
    ],
)
def test_pacing_limits_the_growth_of_increments(element, interface, values, dtime, growth):
    """Where damage grows, the next increment is 10/3 of VISCOSITY, or as long as this one; below 1 it would end."""
    item = element(4, interface.eight, **rigid(0.0), **values)
    item.advance(interface.apart(0.0, 0.004), dtime=0.1)
    item.evaluate(interface.apart(0.0, 0.006), dtime=dtime)
    pnewdt = item.report.pnewdt
    if growth is None:
        assert pnewdt > 1e30
    else:
        assert pnewdt > 1 and pnewdt == pytest.approx(growth, rel=2e-6)
    # where it does not grow, none
    item.evaluate(interface.apart(0.0, 0.003), dtime=dtime)
    assert item.report.pnewdt > 1e30


@pytest.mark.parametrize("alpha", STIFFNESSES)
@pytest.mark.parametrize(("viscosity", "pacing"), [(0.0, 0), (0.05, 0), (0.05, 1)])
def test_energies_sum_up_to_the_work_on_the_separation(element, interface, alpha, viscosity, pacing):
    """Stored + damage + viscous = work of T over w; the viscous part by backward Euler, the rest by trapezia, which err
    in the increments that hold onset, failure and the turn of the path: by 60 MPa times half of one, 2e-4 mm."""
    item = element(4, interface.eight, **rigid(alpha), VISCOSITY=viscosity, PACING=pacing)
    length, thickness = np.linalg.norm(np.diff(interface.edge, axis=0)), 2.0
    steps = [(0.3 * g, g) for g in (*np.linspace(0, 0.012, 60)[1:], *np.linspace(0.012, 0, 10)[1:])]
    steps += [(g, 0.5 * g) for g in np.linspace(0, 0.05, 250)[1:]]
    work, before, traction = 0.0, np.zeros((2, 2)), np.zeros((2, 2))
    for gap in steps:
        viscous = item.state["DISSV"]
        item.advance(interface.apart(*gap), dtime=0.02)
        w, new = vectors(item.state, "WN", "WT"), vectors(item.state, "TN", "TT")
        overstress = (item.state["DISSV"] - viscous).sum()
        if viscosity == 0:
            work += 0.5 * ((traction + new) * (w - before)).sum()
        else:
            work += overstress
        before, traction = w, new
        energy = item.energy * 2 / (length * thickness)
        if viscosity == 0:
            assert energy[1] + energy[3] == pytest.approx(work, abs=4 * 60 * 1e-4)
            assert energy[4] == 0
        else:
            assert energy[4] == pytest.approx(work, rel=1e-12)
            assert overstress >= 0
    assert energy[3] == pytest.approx((item.state["DISSI"] + item.state["DISSII"]).sum(), rel=1e-12)
    assert energy[3] > 0.4


@pytest.mark.parametrize("alpha", STIFFNESSES)
@pytest.mark.parametrize("fraction", [0.0, 0.4])
def test_consistency(element, interface, reference, law, ply, alpha, fraction):
    """A uniform stress and the jump w with t(w) = sigma.n are a solution, at any beta: forces are those of the stress.

    fraction is how far along the softening branch w is.
    """
    values = {**rigid(alpha), "ANGLE BOTTOM": 30.0, "ANGLE TOP": 30.0, "PLANE": 1}
    mode = np.array([0.6, 0.8])
    onset = 1 / np.hypot(*(mode / [law["TAUMAX"], law["SIGMAMAX"]])) / alpha if alpha else 0.0
    length = (1 - fraction) * 0.7 * onset + fraction * 0.02
    w = length * mode
    traction = reference.law_traction({**law, **values}, w) if length > 0 else 20.0 * mode
    # a stress with that traction, the strain it takes in two plies of the same direction
    tensor = interface.axes.T @ np.array([[35.0, traction[0]], [traction[0], traction[1]]]) @ interface.axes
    e = np.linalg.solve(reference.elasticity(ply, 30.0, True), [tensor[0, 0], tensor[1, 1], tensor[0, 1]])
    u = (interface.eight - interface.edge[0]) @ np.array([[e[0], 0.0], [e[2], e[1]]])
    u[4:] += w @ interface.axes
    for given in ({}, GIVEN, {"SAMPLING": 2}, {"SAMPLING": 1, "INTEGRATION": 1}):
        item = element(4, interface.eight, **values, **given)
        item.advance(u)
        np.testing.assert_allclose(vectors(item.state, "TN", "TT"), [traction, traction], rtol=1e-8 + 1e-18 * alpha)
        np.testing.assert_allclose(vectors(item.state, "WN", "WT"), [w, w], rtol=1e-8, atol=1e-12)
        assert (item.state["DAMAGE"] > 0).all() == (fraction > 0)


@pytest.mark.parametrize("alpha", [1.0e4, 0.0])
def test_rigid_motion_gives_no_force(element, interface, alpha):
    item = element(4, interface.eight, **rigid(alpha))
    turn = np.array([[0.0, -1e-3], [1e-3, 0.0]])
    assert abs(item.evaluate(interface.eight @ turn.T + [0.3, -0.2])[0]).max() < 1e-10
    assert abs(item.evaluate(np.tile([0.3, -0.2], (8, 1)))[0]).max() < 1e-10


@pytest.mark.parametrize("alpha", [2.0e4, 1.0e12, 0.0])
def test_secant_matrix_and_its_share(element, interface, alpha):
    """With fixed damage the traction is homogeneous: RHS = -AMATRX u. BLEND mixes, TANGENT 1 is BLEND 1."""
    u = interface.displacements(8, *interface.states["softening"], seed=1)
    exact = element(4, interface.eight, **rigid(alpha)).evaluate(u)
    rhs, secant = element(4, interface.eight, **rigid(alpha), TANGENT=1).evaluate(u)
    np.testing.assert_allclose(secant @ u.ravel(), -rhs, atol=1e-11 * abs(secant).max() * abs(u).max())
    for share in (0.0, 0.3, 1.0):
        forces, blended = element(4, interface.eight, **rigid(alpha), BLEND=share).evaluate(u)
        np.testing.assert_array_equal(forces, exact[0])
        expected = share * secant + (1 - share) * exact[1]
        np.testing.assert_allclose(blended, expected, atol=1e-13 * abs(secant).max())
    assert abs(secant - exact[1]).max() > 0.1 * abs(secant).max()


@pytest.mark.parametrize("jtype", [2, 4])
def test_share_of_the_secant_matrix_with_the_papers_closure(element, interface, jtype):
    nodes = interface.four if jtype == 2 else interface.eight
    u = interface.displacements(len(nodes), *interface.states["softening"], seed=1)
    exact, secant, blended = (
        element(jtype, nodes, **values).evaluate(u)[1] for values in ({}, {"TANGENT": 1}, {"BLEND": 0.3})
    )
    np.testing.assert_allclose(blended, 0.3 * secant + 0.7 * exact, atol=1e-13 * abs(secant).max())
    assert abs(secant - exact).max() > 0.1 * abs(secant).max()
