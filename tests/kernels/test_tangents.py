# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""AMATRX of every kernel against differences of RHS."""

import numpy as np
import pytest

STATES = ("elastic", "softening", "sliding", "closed", "failed", "mixed", "unloading")
GIVEN = {"BETAN": 4.0e3, "BETAT": 6.0e3, "GAMMABOT": 0.3}
STANDARD = {
    "gauss": {},
    "newton-cotes": {"INTEGRATION": 1},
    "viscous": {"VISCOSITY": 0.3},
}
EIGHT = {
    **STANDARD,
    "given beta": GIVEN,
    "face": {"SAMPLING": 1, **GIVEN},
    "gauss point": {"SAMPLING": 2},
    "newton-cotes at the face": {"INTEGRATION": 1, "SAMPLING": 1},
    "plane strain, turned plies": {"PLANE": 1, "ANGLE BOTTOM": 30.0, "ANGLE TOP": -55.0},
}


def prepared(element, interface, jtype, state, seed, **values):
    """The element with a history, and displacements of the state."""
    coordinates = interface.four if jtype < 4 else interface.eight
    item = element(jtype, coordinates, **values)
    if state == "unloading":
        u = interface.displacements(len(coordinates), *interface.states["softening"], seed)
        item.advance(u)
        return item, 0.6 * u
    # a little damage at both points, well below what the softening states cause
    item.advance(interface.displacements(len(coordinates), (0.0021, 0.0007), (0.0019, 0.0008), seed + 100))
    return item, interface.displacements(len(coordinates), *interface.states[state], seed)


def assert_tangent(item, u, reference, rtol):
    tangent = item.evaluate(u)[1]
    differences = -reference.central_differences(lambda x: item.evaluate(x)[0], u.ravel(), step=4e-6)
    assert np.abs(tangent).max() > 0
    assert np.abs(tangent - differences).max() <= rtol * np.abs(tangent).max()
    return tangent


@pytest.mark.parametrize("state", STATES)
@pytest.mark.parametrize("variant", STANDARD)
def test_standard(element, interface, reference, variant, state):
    for seed in range(3):
        item, u = prepared(element, interface, 2, state, seed, **STANDARD[variant])
        if state == "failed" and "VISCOSITY" not in STANDARD[variant]:
            assert not item.evaluate(u)[1].any()
            continue
        tangent = assert_tangent(item, u, reference, 1e-7)
        if state in ("elastic", "closed", "unloading"):
            np.testing.assert_allclose(tangent, tangent.T, atol=1e-12 * abs(tangent).max())


@pytest.mark.parametrize("state", STATES)
@pytest.mark.parametrize("variant", EIGHT)
def test_stabilised_eight_nodes(element, interface, reference, variant, state):
    for seed in range(3):
        item, u = prepared(element, interface, 4, state, seed, **EIGHT[variant])
        if state == "failed" and "VISCOSITY" not in EIGHT[variant]:
            assert not item.evaluate(u)[1].any()
            continue
        assert_tangent(item, u, reference, 1e-7)


def test_states_are_what_their_names_say(element, interface):
    """The battery above sees every branch of the law."""
    for jtype in (2, 4):
        damage, closed = {}, {}
        for state in STATES:
            item, u = prepared(element, interface, jtype, state, 0)
            before = item.state["DAMAGE"]
            item.advance(u)
            damage[state] = (before, item.state["DAMAGE"])
            closed[state] = item.state["TN"] < 0
        for state in ("softening", "sliding"):
            assert (damage[state][1] > damage[state][0]).all() and (damage[state][1] < 1).all()
        for state in ("elastic", "closed", "unloading"):
            np.testing.assert_array_equal(damage[state][0], damage[state][1])
            assert (damage[state][0] > 0).all()
        assert (damage["failed"][1] == 1).all()
        assert damage["mixed"][1].max() == 1
        assert closed["closed"].all() and closed["sliding"].all()
        assert closed["mixed"].any() and not closed["softening"].any()


@pytest.mark.parametrize("jtype", [2, 4])
@pytest.mark.parametrize("state", STATES)
def test_secant(element, interface, jtype, state):
    """With fixed damage the traction is homogeneous in the displacements: RHS = -AMATRX u. Equation (24)."""
    item, u = prepared(element, interface, jtype, state, 1, TANGENT=1)
    rhs, tangent = item.evaluate(u)
    scale = abs(tangent).max() * abs(u).max() + 1e-300
    np.testing.assert_allclose(tangent @ u.ravel(), -rhs, atol=1e-12 * scale)
    if jtype == 2:
        np.testing.assert_allclose(tangent, tangent.T, atol=1e-14 * abs(tangent).max())
    else:
        consistent, u = prepared(element, interface, jtype, state, 1)
        np.testing.assert_array_equal(consistent.evaluate(u)[0], rhs)


def test_consistent_tangent_is_unsymmetric_in_mixed_softening_only(element, interface):
    def asymmetry(left, right):
        item = element(2, interface.four)
        tangent = item.evaluate(interface.displacements(4, left, right, 0))[1]
        return abs(tangent - tangent.T).max() / abs(tangent).max()

    assert asymmetry((0.0, 0.003), (0.0, 0.004)) < 1e-12
    assert asymmetry((0.004, 0.0), (0.006, 0.0)) < 1e-12
    assert asymmetry((0.004, 0.003), (0.006, 0.004)) > 1e-3


@pytest.mark.parametrize("plane", [0, 1])
def test_continuum(element, reference, plane):
    coordinates = [[0.0, 0.0], [1.1, 0.2], [0.9, 1.3], [-0.2, 0.8]]
    item = element(1, coordinates, PLANE=plane)
    u = 1e-3 * np.random.default_rng(0).normal(size=8)
    item.advance(0.3 * u)
    tangent = assert_tangent(item, u, reference, 1e-7)
    np.testing.assert_allclose(tangent, tangent.T, atol=1e-12 * abs(tangent).max())
    assert np.linalg.matrix_rank(tangent, tol=1e-9 * abs(tangent).max()) == 5
