# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Separations, tractions, damage and forces of the interface elements against the paper's equations."""

import numpy as np
import pytest

STATES = ("elastic", "softening", "sliding", "closed", "failed", "mixed")
OPTIONS = [
    {},
    {"INTEGRATION": 1},
    {"SAMPLING": 1},
    {"SAMPLING": 2},
    {"SAMPLING": 1, "INTEGRATION": 1},
    {"SAMPLING": 2, "INTEGRATION": 1},
    {"BETAN": 4.0e3, "BETAT": 6.0e3, "GAMMABOT": 0.3},
    {"GAMMABOT": 0.3},
]


def separations(reference, interface, u, rule):
    """(tau, n) at both points from displacements of the four nodes; and the frame and length."""
    axes, length = reference.frame(*interface.edge)
    shapes = [((1 - s) / 2, (1 + s) / 2) for s in reference.POINTS[rule]]
    return [axes @ (left * (u[3] - u[0]) + right * (u[2] - u[1])) for left, right in shapes], axes, length


def nodal_forces(tractions, axes, length, thickness, points):
    """Forces on the four nodes: the top is pulled down, the bottom up, by the tractions."""
    forces = np.zeros((4, 2))
    for traction, s in zip(tractions, points, strict=True):
        force = 0.5 * length * thickness * axes.T @ traction
        forces += np.outer([(1 - s) / 2, (1 + s) / 2, -(1 + s) / 2, -(1 - s) / 2], force)
    return forces.ravel()


@pytest.mark.parametrize("state", STATES)
@pytest.mark.parametrize("rule", [0, 1])
def test_standard(element, interface, reference, law, rule, state):
    item = element(2, interface.four, INTEGRATION=rule)
    u = interface.displacements(4, *interface.states[state], seed=3)
    rhs, _ = item.advance(u)
    gaps, axes, length = separations(reference, interface, u, rule)
    damage = [reference.damage(law, g) for g in gaps]
    tractions = [reference.standard_traction(law, g, d) for g, d in zip(gaps, damage, strict=True)]
    found = item.state
    np.testing.assert_allclose(np.transpose([found["SEPT"], found["SEPN"]]), gaps, rtol=1e-12)
    np.testing.assert_allclose(found["DAMAGE"], damage, rtol=1e-12)
    np.testing.assert_allclose(np.transpose([found["TT"], found["TN"]]), tractions, rtol=1e-11, atol=1e-11)
    np.testing.assert_array_equal([found["SN"], found["ST"]], 1)
    expected = nodal_forces(tractions, axes, length, law["THICKNESS"], reference.POINTS[rule])
    np.testing.assert_allclose(rhs, expected, rtol=1e-11, atol=1e-11)
    middle, half = interface.edge.mean(axis=0), 0.5 * (interface.edge[1] - interface.edge[0])
    places = [middle + s * half for s in reference.POINTS[rule]]
    np.testing.assert_allclose(np.transpose([found["X"], found["Y"]]), places, rtol=1e-14)


def bulk_stress(reference, interface, u, elasticity, sampling, s):
    """Stress of the bottom and the top quad for the place s."""
    stress = []
    for side in (0, 1):
        nodes = slice(4 * side, 4 * side + 4)
        place = reference.sampling_place(sampling, s, side)
        strain = reference.strain_matrix(interface.eight[nodes], *place)[0] @ u[nodes].ravel()
        stress.append(elasticity[side] @ strain)
    return np.array(stress)


@pytest.mark.parametrize("state", STATES)
@pytest.mark.parametrize("options", OPTIONS, ids=lambda options: " ".join(f"{k}={v}" for k, v in options.items()))
def test_stabilised_eight_nodes(element, interface, reference, law, ply, options, state):
    angles = {"ANGLE BOTTOM": 30.0, "ANGLE TOP": -55.0}
    plane = options.get("INTEGRATION", 0)
    item = element(4, interface.eight, PLANE=plane, **angles, **options)
    u = interface.displacements(8, *interface.states[state], seed=5)
    rhs, _ = item.advance(u)

    rule, sampling = options.get("INTEGRATION", 0), options.get("SAMPLING", 0)
    gaps, axes, length = separations(reference, interface, u[list(interface.owned)], rule)
    elasticity = [reference.elasticity(ply, angle, plane == 1) for angle in angles.values()]
    norms = [np.linalg.norm(d, 2) for d in elasticity]
    areas = [reference.shoelace(interface.eight[:4]), reference.shoelace(interface.eight[4:])]
    gamma, _ = reference.weights(norms, areas, length)
    if "GAMMABOT" in options:
        gamma = np.array([options["GAMMABOT"], 1 - options["GAMMABOT"]])
    computed = 2 * length * (gamma**2 * norms / areas).sum()
    beta = np.array([options.get("BETAT", computed), options.get("BETAN", computed)])
    damage, tractions, stabilisation = [], [], []
    for s, g in zip(reference.POINTS[rule], gaps, strict=True):
        bulk = reference.traction_of_stress(axes, gamma @ bulk_stress(reference, interface, u, elasticity, sampling, s))
        damage.append(reference.damage(law, g))
        traction, s_matrix = reference.stabilised_traction(law, g, damage[-1], bulk, beta)
        tractions.append(traction)
        stabilisation.append(s_matrix)
    found = item.state
    np.testing.assert_allclose(found["DAMAGE"], damage, rtol=1e-12)
    np.testing.assert_allclose(np.transpose([found["ST"], found["SN"]]), stabilisation, rtol=1e-11)
    np.testing.assert_allclose(np.transpose([found["TT"], found["TN"]]), tractions, rtol=1e-10, atol=1e-9)
    expected = np.zeros((8, 2))
    expected[list(interface.owned)] = nodal_forces(
        tractions, axes, length, law["THICKNESS"], reference.POINTS[rule]
    ).reshape(4, 2)
    np.testing.assert_allclose(rhs, expected.ravel(), rtol=1e-10, atol=1e-9)


def test_beta_of_the_papers_patch(element, ply):
    """Equation (21) for the 10 x 10 patch of section 4.1, [0/0], quads of 0.1: |D|/h = 1.21e6 N/mm^3."""
    quads = 0.1 * np.array([[0, -1], [1, -1], [1, 0], [0, 0], [0, 0], [1, 0], [1, 1], [0, 1]])
    item = element(4, quads)
    item.advance(np.zeros(16))
    stabilisation, stiffness = item.state["SN"][0], 2.0e4
    beta = stiffness * stabilisation / (1 - stabilisation)
    # equal quads: gamma = 1/2, beta = |D| length/area; |D| is E11/(1 - nu12^2 E22/E11) but for the coupling by nu12
    assert beta == pytest.approx(1.21e6, rel=2e-3)


def test_stiff_limit_is_the_trial_traction(element, interface):
    """alpha to infinity: T = <sigma>.n + beta g, Nitsche's method (remark 6), and S vanishes."""
    u = interface.displacements(8, (1e-9, -2e-9), (2e-9, -1e-9), seed=1)
    item = element(4, interface.eight, ALPHAN=1e18, ALPHAT=1e18, SIGMAMAX=1e12, TAUMAX=1e12, GIC=1e12, GIIC=1e12)
    item.advance(u)
    softer = element(4, interface.eight, ALPHAN=1e12, ALPHAT=1e12, SIGMAMAX=1e9, TAUMAX=1e9, GIC=1e12, GIIC=1e12)
    softer.advance(u)
    assert (item.state["SN"] < 1e-11).all()
    np.testing.assert_allclose(item.state["TN"], softer.state["TN"], rtol=1e-5)


@pytest.mark.parametrize("jtype", [2, 4])
def test_unloading_is_secant_and_damage_never_heals(element, interface, jtype):
    nodes = 4 if jtype == 2 else 8
    item = element(jtype, interface.four if jtype == 2 else interface.eight)
    u = interface.displacements(nodes, *interface.states["softening"], seed=2)
    rhs, _ = item.advance(u)
    damage = item.state["DAMAGE"]
    dissipated = item.energy[3]
    for factor in (0.7, 0.2, 0.9, 0.0):
        unloaded, _ = item.advance(factor * u)
        np.testing.assert_allclose(unloaded, factor * rhs, rtol=1e-12, atol=1e-12)
        np.testing.assert_array_equal(item.state["DAMAGE"], damage)
        assert item.energy[3] == pytest.approx(dissipated, rel=1e-14)
    fresh = element(jtype, interface.four if jtype == 2 else interface.eight)
    np.testing.assert_allclose(item.evaluate(1.2 * u)[0], fresh.evaluate(1.2 * u)[0], rtol=1e-12)


def test_closed_interface_keeps_its_normal_stiffness(element, interface, law):
    """A failed interface carries pressure and no shear; equation (8) with <delta_n> = 0."""
    item = element(2, interface.four)
    item.advance(interface.displacements(4, *interface.states["failed"], seed=0))
    assert (item.state["DAMAGE"] == 1).all()
    item.advance(interface.displacements(4, (0.01, -0.002), (0.01, -0.002), seed=0))
    np.testing.assert_allclose(item.state["TN"], law["ALPHAN"] * item.state["SEPN"], rtol=1e-14)
    assert (item.state["TN"] < 0).all()
    np.testing.assert_array_equal(item.state["TT"], 0)


def test_contact_of_the_stabilised_element_follows_the_trial_traction(element, interface, law):
    """Open by g_n > 0, but pressed together by the bulk stress: closed, so the normal part is not damaged."""
    item = element(4, interface.eight, BETAN=1.0e3, BETAT=1.0e3)
    item.advance(interface.displacements(8, *interface.states["failed"], seed=0))
    tau = np.diff(interface.edge, axis=0)[0] / np.hypot(*np.diff(interface.edge, axis=0)[0])
    normal = np.array([-tau[1], tau[0]])
    # uniform strain along n alone, and a small opening
    u = (-1e-2 * interface.eight @ normal)[:, None] * normal
    u[4:] += 1e-3 * normal
    item.advance(u)
    assert (item.state["SEPN"] > 0).all()
    assert (item.state["DAMAGE"] == 1).all()
    assert (item.state["TN"] < 0).all()
    np.testing.assert_allclose(item.state["SN"], 1.0e3 / (law["ALPHAN"] + 1.0e3), rtol=1e-14)
    np.testing.assert_array_equal(item.state["TT"], 0)


def test_viscosity_is_backward_euler(element, interface, reference, law):
    """d_v' = (d - d_v)/viscosity over increments of different duration; none changes it in no time."""
    item = element(2, interface.four, VISCOSITY=0.4)
    u = interface.displacements(4, *interface.states["softening"], seed=2)
    gaps, _, _ = separations(reference, interface, u, 0)
    target = np.array([reference.damage(law, g) for g in gaps])
    acting = np.zeros(2)
    for dtime in (0.1, 0.0, 0.5, 1.0e-9):
        item.advance(u, dtime=dtime)
        acting = (0.4 * acting + dtime * target) / (0.4 + dtime)
        np.testing.assert_allclose(item.state["DAMAGE"], acting, rtol=1e-12)
        np.testing.assert_allclose(item.state["DMAX"], target, rtol=1e-12)
    tractions = [reference.standard_traction(law, g, d) for g, d in zip(gaps, acting, strict=True)]
    np.testing.assert_allclose(item.state["TN"], np.array(tractions)[:, 1], rtol=1e-12)


@pytest.mark.parametrize("jtype", [2, 4])
def test_rigid_motion_gives_no_force(element, interface, jtype):
    nodes = interface.four if jtype == 2 else interface.eight
    item = element(jtype, nodes)
    turn = np.array([[0.0, -1e-3], [1e-3, 0.0]])
    rhs, _ = item.evaluate(nodes @ turn.T + [0.3, -0.2])
    assert abs(rhs).max() < 1e-10  # stresses of 1e5 x 1e-3 cancel to rounding
    translated, _ = item.evaluate(np.tile([0.3, -0.2], (len(nodes), 1)))
    assert abs(translated).max() < 1e-10
