# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Interfaces between eight-node quads: U5 with six nodes, U6 with sixteen, on straight and on curved edges."""

from itertools import pairwise, product

import numpy as np
import pytest
from scipy.linalg import eigh

from uel.errors import KernelError
from uel.usersub import layout

STATES = ("elastic", "softening", "sliding", "closed", "failed", "mixed", "unloading")
GAUSS = {
    0: (np.array([-1, 0, 1]) * np.sqrt(0.6), np.array([5, 8, 5]) / 9),
    1: (np.array([-1, 0, 1]), np.array([1, 4, 1]) / 3),
}
SIX = [3, 2, 9, 8, 6, 12]  # nodes of U5 among those of U6 (left and right as in U4)
EDGES = {5: ([0, 1, 4], [3, 2, 5]), 6: ([3, 2, 6], [8, 9, 12])}
STANDARD = {"gauss": {}, "newton-cotes": {"INTEGRATION": 1}, "viscous": {"VISCOSITY": 0.3}}
STABILISED = {
    **STANDARD,
    "given beta": {"BETAN": 4.0e3, "BETAT": 6.0e3, "GAMMABOT": 0.3},
    "local beta, face": {"BETAN": -1, "SAMPLING": 1},
    "gauss point": {"SAMPLING": 2, "PLANE": 1, "ANGLE BOTTOM": 30.0, "ANGLE TOP": -55.0},
    "consistent": {"CLOSURE": 1, "BETAN": -1},
    "consistent, rigid": {"CLOSURE": 1, "ALPHAN": 0.0, "ALPHAT": 0.0, "SAMPLING": 1},
}


def with_middles(corners):
    """Nodes of an eight-node quad with straight edges."""
    return np.vstack([corners, (corners + np.roll(corners, -1, axis=0)) / 2])


def nodes_of(interface, jtype, bend=0.0):
    """Coordinates of U5 or U6; `bend` moves the middle of the interface across it."""
    sides = np.vstack([with_middles(interface.eight[:4]), with_middles(interface.eight[4:])])
    sides[[6, 12]] += bend * np.array([-0.3, 0.9])
    return sides if jtype == 6 else sides[SIX]


def displacements(interface, jtype, left, right, seed):
    """Random displacements with about the given separations (tau, n) at both ends and between them in the middle."""
    rng = np.random.default_rng(seed)
    bottom, top = EDGES[jtype]
    u = 1e-3 * rng.normal(size=(16 if jtype == 6 else 6, 2))
    tau = np.diff(interface.edge, axis=0)[0] / np.linalg.norm(np.diff(interface.edge, axis=0))
    gaps = np.array([left, right, 0.7 * np.array(left) + 0.3 * np.array(right)]) * (1 + 0.05 * rng.normal(size=(3, 2)))
    u[top] = u[bottom] + gaps @ np.array([tau, [-tau[1], tau[0]]])
    return u


def prepared(element, interface, jtype, state, seed, bend=0.0, **values):
    """The element with a history, and displacements of the state."""
    item = element(jtype, nodes_of(interface, jtype, bend), **values)
    if state == "unloading":
        u = displacements(interface, jtype, *interface.states["softening"], seed)
        item.advance(u)
        return item, 0.6 * u
    item.advance(displacements(interface, jtype, (0.0021, 0.0007), (0.0019, 0.0008), seed + 100))
    return item, displacements(interface, jtype, *interface.states[state], seed)


@pytest.mark.parametrize("state", STATES)
@pytest.mark.parametrize(("jtype", "variant"), [*((5, name) for name in STANDARD), *((6, name) for name in STABILISED)])
def test_tangent(element, interface, reference, jtype, variant, state):
    values = (STANDARD if jtype == 5 else STABILISED)[variant]
    # seeds that leave no point within a step of a kink
    for seed, bend in ((3, 0.0), (1, 0.05)):
        item, u = prepared(element, interface, jtype, state, seed, bend, **values)
        tangent = item.evaluate(u)[1]
        differences = -reference.central_differences(lambda x, item=item: item.evaluate(x)[0], u.ravel(), step=4e-7)
        assert tangent.any() or state == "failed"
        assert np.abs(tangent - differences).max() <= 1e-7 * np.abs(tangent).max()


@pytest.mark.parametrize("rule", [0, 1])
@pytest.mark.parametrize("state", ["elastic", "softening", "sliding", "closed", "failed"])
def test_standard_element(element, interface, reference, law, state, rule):
    """Separations, damage, tractions and forces point by point, on a curved edge."""
    xy = nodes_of(interface, 5, bend=0.05)
    item = element(5, xy, INTEGRATION=rule)
    u = displacements(interface, 5, *interface.states[state], seed=3)
    rhs, _ = item.advance(u)
    bottom, top = EDGES[5]
    expected, found = np.zeros((6, 2)), item.state
    for k, (s, weight) in enumerate(zip(*GAUSS[rule], strict=True)):
        shape = np.array([s * (s - 1) / 2, s * (s + 1) / 2, 1 - s * s])
        slope = np.array([s - 0.5, s + 0.5, -2 * s]) @ xy[bottom]
        tau = slope / np.linalg.norm(slope)
        axes = np.array([tau, [-tau[1], tau[0]]])
        gap = axes @ (shape @ (u[top] - u[bottom]))
        damage = reference.damage(law, gap)
        traction = reference.standard_traction(law, gap, damage)
        np.testing.assert_allclose([found["X"][k], found["Y"][k]], shape @ xy[bottom], rtol=1e-13)
        np.testing.assert_allclose([found["SEPT"][k], found["SEPN"][k]], gap, rtol=1e-11)
        np.testing.assert_allclose([found["TT"][k], found["TN"][k]], traction, rtol=1e-10, atol=1e-11)
        assert found["DAMAGE"][k] == pytest.approx(damage, rel=1e-11)
        force = weight * np.linalg.norm(slope) * law["THICKNESS"] * axes.T @ traction
        expected[bottom] += np.outer(shape, force)
        expected[top] -= np.outer(shape, force)
    np.testing.assert_allclose(rhs, expected.ravel(), rtol=1e-10, atol=1e-10)


def affine_quads():
    """Two parallelograms, in which eight nodes hold every quadratic displacement."""
    low = np.array([[-0.2, -0.7], [0.7, -0.4], [1.0, 0.5], [0.1, 0.2]])
    high = np.array([[0.1, 0.2], [1.0, 0.5], [0.9, 1.4], [0.0, 1.1]])
    return np.vstack([with_middles(low), with_middles(high)])


NITSCHE = {"ALPHAN": 1e18, "ALPHAT": 1e18, "SIGMAMAX": 1e12, "TAUMAX": 1e12, "GIC": 1e22, "GIIC": 1e22}


ON_THE_FACE = [{}, {"SAMPLING": 1}, {"BETAN": -1, "INTEGRATION": 1}, {"CLOSURE": 1}]


# the stress of a Gauss point inside the quad is that on the face only where it is constant
@pytest.mark.parametrize(("degree", "values"), [*product((1, 2), ON_THE_FACE), (1, {"SAMPLING": 2})], ids=str)
def test_consistency(element, interface, reference, ply, law, degree, values):
    """T = sigma.n where the separation is T/alpha (constant stress), or 0 with alpha = 1e18 (linear stress)."""
    xy = affine_quads()
    stiffness = reference.elasticity(ply, 0.0, False)
    rng = np.random.default_rng(2)
    linear, square = 1e-5 * rng.normal(size=(2, 2)), 1e-5 * rng.normal(size=(2, 2, 2))
    square = (square + square.transpose(0, 2, 1)) * (degree == 2)
    u = xy @ linear.T + np.einsum("ijk,aj,ak->ai", square, xy, xy) / 2
    axes, _ = reference.frame(*interface.edge)

    def traction(place):
        slope = linear + square @ place
        strain = np.array([slope[0, 0], slope[1, 1], slope[0, 1] + slope[1, 0]])
        return reference.traction_of_stress(axes, stiffness @ strain)

    if degree == 1:
        u[8:] += traction(xy[3]) / [law["ALPHAT"], law["ALPHAN"]] @ axes
    item = element(6, xy, **(NITSCHE if degree == 2 else {}), **values)
    item.advance(u)
    places = np.transpose([item.state["X"], item.state["Y"]])
    found = np.transpose([item.state["TT"], item.state["TN"]])
    expected = np.array([traction(place) for place in places])
    np.testing.assert_allclose(found, expected, rtol=1e-8, atol=1e-8 * abs(expected).max())
    assert (np.ptp(expected, axis=0) > 0.01).all() == (degree == 2)


@pytest.mark.parametrize("values", [{}, {"CLOSURE": 1, "BETAN": -1}], ids=str)
@pytest.mark.parametrize("jtype", [5, 6])
def test_rigid_motion_gives_no_force(element, interface, jtype, values):
    nodes = nodes_of(interface, jtype, bend=0.05)
    item = element(jtype, nodes, **(values if jtype == 6 else {}))
    turn = np.array([[0.0, -1e-3], [1e-3, 0.0]])
    assert abs(item.evaluate(nodes @ turn.T + [0.3, -0.2])[0]).max() < 1e-9  # stresses of 1e5 x 1e-3 cancel


@pytest.mark.parametrize("viscosity", [0.0, 0.5])
def test_energies_sum_up_to_the_work(element, interface, viscosity):
    """Trapezoidal work of the nodal forces = stored + dissipated, to 0.5 %: the trapezoidal rule errs in increments
    that hold an onset or a failure."""
    item = element(5, nodes_of(interface, 5, bend=0.05), VISCOSITY=viscosity)
    rng = np.random.default_rng(4)
    corners = [np.zeros((6, 2))]
    for _ in range(4):
        ends = rng.uniform((-0.01, 0.002), (0.01, 0.015), (3, 2, 2))
        corners += [*(displacements(interface, 5, *pair, 7) for pair in ends), np.zeros((6, 2))]
    path = [a + f * (b - a) for a, b in pairwise(corners) for f in np.linspace(0, 1, 31)[1:]]
    for work in item.follow(path):
        assert sum(item.energy[[1, 3, 4]]) == pytest.approx(work, rel=5e-3, abs=1e-4)
    assert item.energy[3] > 0 and (item.energy[4] > 0) == (viscosity > 0)


@pytest.mark.parametrize("closure", [2, 1])
@pytest.mark.parametrize("jtype", [5, 6])
def test_fracture_energy(element, interface, law, jtype, closure):
    """Opened evenly to failure, an element dissipates G_Ic at every point of its area."""
    values = {"CLOSURE": closure} if jtype == 6 else {}
    item = element(jtype, nodes_of(interface, jtype), **values)
    tau = np.diff(interface.edge, axis=0)[0] / np.linalg.norm(np.diff(interface.edge, axis=0))
    u = np.zeros((item.n // 2, 2))
    top = EDGES[5][1] if jtype == 5 else range(8, 16)
    for gap in np.linspace(0, 0.03, 11)[1:]:
        u[top] = gap * np.array([-tau[1], tau[0]])
        item.advance(u)
    np.testing.assert_allclose(item.state["DISSI"], law["GIC"], rtol=1e-11)
    area = np.linalg.norm(np.diff(interface.edge, axis=0)) * law["THICKNESS"]
    assert item.energy[3] == pytest.approx(law["GIC"] * area, rel=1e-11)
    np.testing.assert_array_equal(item.state["DAMAGE"], 1)


CORNERS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
PARENT = np.vstack([CORNERS, (CORNERS + np.roll(CORNERS, -1, axis=0)) / 2])


def monomials(x, y):
    """What the eight shape functions span, and its derivatives."""
    values = [1, x, y, x * y, x * x, y * y, x * x * y, x * y * y]
    return np.array([values, [0, 1, 0, y, 2 * x, 0, 2 * x * y, y * y], [0, 0, 1, x, 0, 2 * y, x * x, 2 * x * y]])


def strain_matrix(xy, xi, eta):
    """B (3, 16) and Jacobian of an eight-node quad, from the monomials."""
    coefficients = np.linalg.inv(np.array([monomials(*p)[0] for p in PARENT]))
    by_parent = monomials(xi, eta)[1:] @ coefficients
    jacobian = by_parent @ xy
    by_x, by_y = np.linalg.solve(jacobian, by_parent)
    b = np.zeros((3, 16))
    b[0, 0::2], b[1, 1::2] = by_x, by_y
    b[2, 0::2], b[2, 1::2] = by_y, by_x
    return b, jacobian


def expected_lambda(reference, xy, side, d):
    """Largest eigenvalue of the normal traction without rigid displacements; and area and length of the face."""
    energy, face, area, length = np.zeros((16, 16)), np.zeros((16, 16)), 0.0, 0.0
    for s, weight in zip(*GAUSS[0], strict=True):
        for t, other in zip(*GAUSS[0], strict=True):
            b, jacobian = strain_matrix(xy, s, t)
            energy += weight * other * np.linalg.det(jacobian) * b.T @ d @ b
            area += weight * other * np.linalg.det(jacobian)
        b, jacobian = strain_matrix(xy, s, side)
        axes, slope = reference.frame([0, 0], jacobian[0])
        on_face = np.array([reference.traction_of_stress(axes, column) for column in (d @ b).T]).T
        face += weight * slope * np.outer(on_face[1], on_face[1])
        length += weight * slope
    kept = np.linalg.eigh(energy)[1][:, 3:]
    return eigh(kept.T @ face @ kept, kept.T @ energy @ kept, eigvals_only=True)[-1], area, length


@pytest.mark.parametrize("bend", [0.0, 0.05])
def test_beta(element, interface, reference, ply, bend):
    """(21) and (22), and the local eigenvalue problem, against a dense solution."""
    xy, angles = nodes_of(interface, 6, bend), {"ANGLE BOTTOM": 0.0, "ANGLE TOP": 37.0}
    d = [reference.elasticity(ply, angle, False) for angle in angles.values()]
    norms = np.array([np.linalg.norm(c, 2) for c in d])
    sides = zip((xy[:8], xy[8:]), (1, -1), d, strict=True)
    lam, areas, lengths = np.transpose([expected_lambda(reference, *side) for side in sides])
    np.testing.assert_allclose(lengths[0], lengths[1], rtol=1e-13)
    for estimate, per_side in ((-2, norms * lengths / areas), (-1, lam)):
        item = element(6, xy, BETAN=estimate, ALPHAN=1e6, ALPHAT=1e6, **angles)
        item.advance(np.zeros(32))
        s = item.state["SN"]
        np.testing.assert_allclose(1e6 * s / (1 - s), 2 * per_side.prod() / per_side.sum(), rtol=1e-9)


def test_names():
    for jtype, (bottom, top) in EDGES.items():
        names = layout.variables(jtype)
        assert (names.kind, names.points, names.bottom, names.top) == ("interface", 3, tuple(bottom), tuple(top))


@pytest.mark.parametrize(
    ("jtype", "values", "message"),
    [
        (5, {"SIGMAMAX": 0.0}, r"U5 element 42: PROPS\(4\) SIGMAMAX = 0.*positive"),
        (5, {"TANGENT": 2}, r"U5 element 42: JPROPS\(3\) TANGENT = 2: expected 0 to 1"),
        (5, {"ALPHAN": 0.0, "ALPHAT": 0.0}, r"U5 element 42: .* ALPHAN = 0.*expected a positive"),
        (5, {"GIC": 0.0225}, r"U5 element 42: PROPS\(6\) GIC = .*too brittle"),
        (6, {"BETAN": -3.0}, r"U6 element 42: .* BETAN = -3.*, or -1 in a self-contained element"),
        (6, {"CLOSURE": 4}, r"U6 element 42: JPROPS\(2\) CLOSURE = 4: expected 0 to 3"),
        (6, {"GIC": 0.0225}, r"U6 element 42: PROPS\(6\) GIC = .*too brittle"),
        (6, {"CLOSURE": 1, "BETAN": 1.0, "BETAT": 1.0}, r"U6 element 42: .*: beta = 1.0.*, too small"),
        (6, {"NU12 TOP": 4.0}, r"U6 element 42: .* NU12 TOP = 4.*not positive definite"),
    ],
    ids=str,
)
def test_properties(element, interface, jtype, values, message):
    item = element(jtype, nodes_of(interface, jtype), label=42, **values)
    with pytest.raises(KernelError, match=message):
        item.evaluate(np.zeros(item.n))


def moved(node, x, y):
    """A change of the coordinates of U6."""
    return lambda xy: xy.__setitem__(node, [x, y])


@pytest.mark.parametrize("estimate", [-2, -1])
@pytest.mark.parametrize(
    ("jtype", "change", "message"),
    [
        (5, lambda xy: xy.__setitem__(slice(None), xy[0]), "U5 element 42: the interface has no length"),
        (5, lambda xy: xy.__setitem__(5, xy[5] + 0.01), "U5 element 42: .* top one does not lie above the bottom one"),
        (
            6,
            lambda xy: xy.__setitem__([6, 12], 0.9 * xy[2] + 0.1 * xy[3]),
            "U6 element 42: the interface has no length",
        ),
        (
            6,
            moved(8, 0.1, 0.25),
            "U6 element 42: the two faces .* node 9 must lie on 4 and 10 on 3, and the middle nodes",
        ),
        (6, lambda xy: xy.__setitem__(slice(0, 2), xy[:2] + np.array([0, 3])), "U6 element 42: bottom quad is inside"),
        (6, moved(14, 0.9, 3.0), "U6 element 42: top quad is inside out"),
    ],
)
def test_geometry(element, interface, jtype, change, message, estimate):
    xy = nodes_of(interface, jtype)
    change(xy)
    item = element(jtype, xy, label=42, **({"BETAN": estimate} if jtype == 6 else {}))
    with pytest.raises(KernelError, match=message):
        item.evaluate(np.zeros(item.n))
