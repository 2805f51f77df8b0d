# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Interfaces in space: between faces of four nodes (U7) and eight (U11), with their own bricks (U8, U12)."""

import numpy as np
import pytest
from lines import BRIDGING, TABLE
from reference import serendipity
from scipy.spatial.transform import Rotation
from space import (
    FACE,
    QUADRATIC,
    STANDARD,
    SURFACES,
    bottom_of,
    frames,
    nodes_of,
    opened,
    points_of,
    stress_of,
    top_of,
    weights_of,
)

from uel.errors import KernelError

LAWS = {
    "bilinear": {"LAW": 1},
    "BK": {"LAW": 2, "ETA": 1.45},
    "exponential": {"LAW": 3, "POWER": 1.3},
    "PPR": {"LAW": 4, "SHAPEN": 3.0, "SHAPET": 2.5},
    "bridging": BRIDGING,
    "table": TABLE,
}
BETA = {"BETAN": 6.0e4, "BETAT": 6.0e4}
RIGID = {"ALPHAN": 0.0, "ALPHAT": 0.0, "CLOSURE": 1}
# U7; U8 with the paper's closure, with the consistent law, with an infinite stiffness
ELEMENTS = {
    "standard": (7, {}),
    "viscous": (7, {"VISCOSITY": 0.4}),
    "nodal": (7, {"INTEGRATION": 1}),
    "paper": (8, {}),
    "paper, viscous, face": (8, {"VISCOSITY": 0.4, "SAMPLING": 1, "ANGLE TOP": 40.0}),
    "consistent": (8, {"CLOSURE": 1, **BETA, "ANGLE BOTTOM": -25.0}),
    "consistent, direction": (8, {"CLOSURE": 1, **BETA, "DIRECTION1": 0.2, "DIRECTION2": -1.0, "DIRECTION3": 0.3}),
    "consistent, beta apart": (8, {"CLOSURE": 1, "BETAN": 9.0e4, "BETAT": 5.0e4, "SAMPLING": 2, "GAMMABOT": 0.3}),
    "consistent, viscous, friction": (8, {"CLOSURE": 1, **BETA, "VISCOSITY": 0.4, "FRICTION": 0.4}),
    "rigid": (8, {**RIGID, **BETA, "FRICTION": 0.3, "INTEGRATION": 1}),
    "rigid, viscous, local beta": (8, {**RIGID, "BETAN": -1.0, "BETAT": -1.0, "VISCOSITY": 0.4}),
    "quadratic, standard": (11, {}),
    "quadratic, viscous, nodal": (11, {"VISCOSITY": 0.4, "INTEGRATION": 1}),
    "quadratic, paper": (12, {"INTEGRATION": 1, "SAMPLING": 1, "ANGLE TOP": 40.0}),
    "quadratic, consistent, viscous, friction": (12, {"CLOSURE": 1, **BETA, "VISCOSITY": 0.4, "FRICTION": 0.4}),
    "quadratic, rigid": (12, {**RIGID, "BETAN": -1.0, "BETAT": -1.0, "SAMPLING": 2, "FRICTION": 0.3}),
}
COMPONENTS = ("S", "N", "T")


def vectors(state, name):
    """(points, 3) components (s, n, t) of SEP, T or W."""
    return np.stack([state[f"{name}{i}"] for i in COMPONENTS], axis=-1)


GAPS = {
    "elastic": (2e-4, 3e-4, -2e-4),
    "softening": (4e-3, 4e-3, -3e-3),
    "sliding": (4e-3, -1.5e-3, 5e-3),
    "closed": (3e-4, -2e-3, 2e-4),
    "nearly failed": (1.0e-2, 9e-3, -6e-3),
}


@pytest.mark.sample(2)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", ELEMENTS)
@pytest.mark.parametrize("state", GAPS)
def test_tangent(element, reference, name, law, state):
    """AMATRX is the derivative of RHS, with a history of another direction; differences have an error of 1e-8.

    Along each unknown, of the many of quadratic elements along some random directions.
    """
    jtype, options = ELEMENTS[name]
    rng = np.random.default_rng(5)
    for surface, seed in (("flat", 1), ("warped", 2)):
        coordinates = nodes_of(jtype, surface)
        item = element(jtype, coordinates, **{**LAWS[law], **options})
        before = np.array([-2e-3, 1.5e-3, 2.5e-3]) * (1 + 0.1 * rng.normal(size=(4, 3)))
        item.advance(opened(jtype, before, seed, 2e-5))
        u = opened(jtype, np.array(GAPS[state]) * (1 + 0.1 * rng.normal(size=(4, 3))), seed + 10, 2e-5).ravel()
        along = rng.normal(size=(6, u.size)) / np.sqrt(u.size) if jtype in QUADRATIC else np.eye(u.size)
        tangent = item.evaluate(u)[1]
        differences = -reference.central_differences(
            lambda x, u=u, a=along, e=item: e.evaluate(u + x @ a)[0], np.zeros(len(along)), step=2e-7
        )
        assert np.abs(tangent).max() > 0
        assert np.abs(tangent @ along.T - differences).max() <= 1e-7 * np.abs(tangent).max()


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", ELEMENTS)
def test_nothing_depends_on_the_frame(element, name, law):
    """The whole turned about n: forces turn along, damage and energies stay.

    Plies are alike in all directions of the surface.
    """
    jtype, options = ELEMENTS[name]
    options = {key: value for key, value in options.items() if "ANGLE" not in key}
    if jtype not in STANDARD:
        for side in ("BOTTOM", "TOP"):
            options |= {
                f"E1 {side}": 1.05e4,
                f"NU13 {side}": 0.3,
                f"NU23 {side}": 0.3,
                f"G13 {side}": 5e3,
                f"G23 {side}": 5e3,
            }
            options |= {f"G12 {side}": 1.05e4 / 2.6}
    rng = np.random.default_rng(8)
    coordinates = nodes_of(jtype, "flat")
    path = [
        opened(jtype, np.array(gap) * (1 + 0.1 * rng.normal(size=(4, 3))), 3, 2e-5)
        for gap in ((-2e-3, 1e-3, 1e-3), GAPS["softening"], GAPS["sliding"], (5e-3, -1e-3, -4e-3), GAPS["closed"])
    ]
    still = element(jtype, coordinates, **{**LAWS[law], **options})
    forces = [still.advance(u)[0].reshape(-1, 3) for u in path]
    for angle in (90.0, 37.0, 181.0):
        turn = Rotation.from_euler("z", angle, degrees=True).as_matrix()
        turned = element(jtype, coordinates @ turn.T, **{**LAWS[law], **options})
        for u, force in zip(path, forces, strict=True):
            found = turned.advance(u @ turn.T)[0].reshape(-1, 3)
            np.testing.assert_allclose(found, force @ turn.T, atol=1e-9 * abs(force).max())
        np.testing.assert_allclose(turned.state["DAMAGE"], still.state["DAMAGE"], rtol=1e-9)
        np.testing.assert_allclose(turned.energy, still.energy, rtol=1e-8, atol=1e-12)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", ELEMENTS)
def test_turning_shear_at_constant_resultant_does_no_damage(element, name, law):
    """The history of the damage is a scalar."""
    jtype, options = ELEMENTS[name]
    options = {key: value for key, value in options.items() if key not in ("VISCOSITY", "FRICTION")}
    # s is x
    options = {key: value for key, value in options.items() if not key.startswith("DIRECTION")}
    item = element(jtype, nodes_of(jtype, "flat", 0.0), **{**LAWS[law], **options})
    item.advance(opened(jtype, np.array([5e-3, 0.0, 2e-3]), 0))
    damage = item.state["DAMAGE"]
    assert (damage > 0.05).all() and (damage < 1).all()
    for angle in np.deg2rad([40, 100, 190, 300]):
        gap = [5e-3 * np.cos(angle), 5e-3 * np.sin(angle), 2e-3]
        item.advance(opened(jtype, gap, 0))
        np.testing.assert_allclose(item.state["DAMAGE"], damage, rtol=1e-10)
        shear = vectors(item.state, "T")[:, [0, 2]]
        # x, y, z are s, -t, n: the surface lies in the plane z = 0
        direction = np.array([np.cos(angle), np.sin(angle)])
        expected = np.linalg.norm(shear, axis=1)[:, None] * direction
        np.testing.assert_allclose(shear, expected, atol=1e-9 * abs(shear).max())


@pytest.mark.parametrize("closure", [2, 1])
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("integration", [0, 1])
def test_strip_is_the_plane_element(element, law, closure, integration):
    """A strip of width 1 that does not move across it: U7 as U2, U8 as U4 in plane strain, fibres along s.

    Across the strip both points of a column are alike. The axes 2 and 3 of a ply change their names.
    """
    shared = {**LAWS[law], "INTEGRATION": integration, "VISCOSITY": 0.3}
    bricks = {**shared, "CLOSURE": closure, "BETAN": 6e4, "BETAT": 8e4}
    cases = [(2, 7, shared, shared)] if closure == 2 else []
    quads = {**bricks, "PLANE": 1}
    for side in ("BOTTOM", "TOP"):
        plane = dict(zip(("E2", "E3", "NU12", "NU13", "NU23"), (1.05e4, 9e3, 0.3, 0.25, 0.4), strict=True))
        # nu32/E3 = nu23/E2
        space = dict(
            zip(("E2", "E3", "NU12", "NU13", "NU23"), (9e3, 1.05e4, 0.25, 0.3, 0.4 * 9e3 / 1.05e4), strict=True)
        )
        quads |= {f"{key} {side}": value for key, value in plane.items()}
        quads |= {f"G12 {side}": 4e3, f"ANGLE {side}": np.rad2deg(np.arctan2(0.3, 1.1))}
        bricks |= {f"{key} {side}": value for key, value in space.items()} | {f"G13 {side}": 4e3, f"G12 {side}": 5e3}
    cases.append((4, 8, quads, bricks))

    def to_space(values, order, y):
        return np.column_stack([values[order, 0], y, values[order, 1]])

    rng = np.random.default_rng(4)
    below, above = np.array([[0.1, -0.6], [1.2, -0.5]]), np.array([[1.0, 0.8], [0.0, 0.7]])
    edge = np.array([[0.0, 0.0], [1.1, 0.3]])
    for plane, space, of_plane, of_space in cases:
        if plane == 2:
            flat, order = np.vstack([edge, edge[::-1]]), [[0, 1, 1, 0], [3, 2, 2, 3]]
        else:
            flat = np.vstack([below, edge[::-1], edge, above])
            order = [[0, 1, 1, 0], [3, 2, 2, 3], [4, 5, 5, 4], [7, 6, 6, 7]]
        order = np.concatenate(order)
        across = np.tile([0.0, 0.0, 1.0, 1.0], len(order) // 4)
        # y of the plane is z here, and the strip extends along -y to keep the order of the nodes
        thin = element(plane, flat, **{**of_plane, "THICKNESS": 1.0})
        strip = element(space, to_space(flat, order, across), **of_space)
        for gap in ((1e-3, 5e-4), (4e-3, 3e-3), (7e-3, -1e-3), (9e-3, 8e-3)):
            u = 2e-5 * rng.normal(size=flat.shape)
            if plane == 2:
                u[2:] += gap
            else:
                u[4:] += gap
            force = thin.advance(u, dtime=0.1)[0].reshape(-1, 2)
            found = strip.advance(to_space(u, order, 0 * across), dtime=0.1)[0].reshape(-1, 3)
            summed = np.zeros_like(force)
            np.add.at(summed, order, found[:, [0, 2]])
            np.testing.assert_allclose(summed, force, atol=1e-9 * abs(force).max())
            np.testing.assert_allclose(strip.energy, thin.energy, rtol=1e-9, atol=1e-13)
        np.testing.assert_allclose(strip.state["DAMAGE"][:2], thin.state["DAMAGE"], rtol=1e-9)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", ["standard", "viscous", "nodal", "quadratic, standard", "quadratic, viscous, nodal"])
def test_energies_sum_up_to_the_work(element, name, law):
    """Stored, dissipated and viscous energy are the work of the traction, in any direction, to 0.5 %: the trapezoidal
    rule errs in increments that hold an onset or a failure."""
    jtype, options = ELEMENTS[name]
    rng = np.random.default_rng(12)
    item = element(jtype, nodes_of(jtype, "flat"), **{**LAWS[law], **options})
    work, old, before = 0.0, np.zeros((item.n // 3, 3)), np.zeros(item.n)
    gap = np.zeros((4, 3))
    for _ in range(12):
        start, gap = gap, gap + np.array([1.5e-3, 1.5e-3, 1e-3]) * rng.normal(size=(4, 3))
        gap[:, 2] = abs(gap[:, 2])
        for part in np.linspace(0, 1, 31)[1:]:
            u = opened(jtype, start + part * (gap - start), 0)
            force = item.advance(u, dtime=0.2 / 30)[0]
            work -= 0.5 * (force + before) @ (u - old).ravel()
            old, before = u, force
    assert item.energy[3] > 0.01 * work
    np.testing.assert_allclose(item.energy[[1, 3, 4]].sum(), work, rtol=5e-3)
    assert (item.energy[4] > 0) == ("VISCOSITY" in options)


@pytest.mark.parametrize("surface", SURFACES)
@pytest.mark.parametrize("jtype", [7, 8, 11, 12])
def test_rigid_motion(element, jtype, surface):
    """Infinitesimal ones, of any size, open nothing, but for the strain of bricks that a linear rotation has not."""
    coordinates = nodes_of(jtype, surface)
    item = element(jtype, coordinates)
    size = 1e5 * 2e4
    for axis in np.eye(3):
        for motion in (np.tile(axis, (len(coordinates), 1)), np.cross(axis, coordinates)):
            rhs, tangent = item.evaluate(1e2 * motion)
            assert abs(rhs).max() <= 1e-9 * size
            assert abs(tangent @ motion.ravel()).max() <= 1e-11 * abs(tangent).max()


@pytest.mark.parametrize("surface", SURFACES)
@pytest.mark.parametrize(("sampling", "rule"), [(0, 0), (1, 0), (2, 0), (0, 1)])
@pytest.mark.parametrize("angles", [(0.0, 0.0), (30.0, 30.0)])
@pytest.mark.parametrize("jtype", [8, 12])
def test_patch(element, jtype, surface, sampling, rule, angles):
    """Bricks in a constant strain: a rigid interface transmits sigma.n to its nodes as the area of each has it.

    Both sides have the same plies, so one strain has one traction; a skew, sloping or warped surface.
    """
    coordinates = nodes_of(jtype, surface)
    values = {"ANGLE BOTTOM": angles[0], "ANGLE TOP": angles[1], "SAMPLING": sampling, "INTEGRATION": rule, **RIGID}
    strong = {"SIGMAMAX": 1e4, "TAUMAX": 1e4, "GIC": 1e3, "GIIC": 1e3}
    item = element(jtype, coordinates, **{**values, **strong})
    gradient = 1e-3 * np.random.default_rng(2).normal(size=(3, 3))
    force = item.evaluate(coordinates @ gradient.T)[0].reshape(-1, 3)
    stress = stress_of(gradient, coordinates, jtype, angles[0])
    bottom, top = bottom_of(jtype), top_of(jtype)
    expected = np.zeros((len(top), 3))
    for parent, weight in zip(points_of(jtype, rule), weights_of(jtype, rule), strict=True):
        shape, slopes = serendipity(FACE[: len(top)], parent)
        expected += weight * np.outer(shape, stress @ np.cross(*(slopes @ coordinates[top])))
    np.testing.assert_allclose(force[top], -expected, rtol=1e-9, atol=1e-9 * abs(expected).max())
    np.testing.assert_allclose(force[bottom], -force[top], atol=1e-12 * abs(force).max())
    assert not np.delete(force, bottom + top, axis=0).any()


@pytest.mark.parametrize("rule", [0, 1])
@pytest.mark.parametrize(("jtype", "surface"), [(7, "sloping"), (7, "warped"), (11, "sloping"), (11, "warped")])
def test_positions_and_directions(element, jtype, surface, rule):
    """X, Y and Z of the points, and the components of a separation."""
    coordinates = nodes_of(jtype, surface)
    item = element(jtype, coordinates, INTEGRATION=rule)
    gap = np.array([1e-4, 2e-4, 3e-4])
    item.advance(opened(jtype, gap, 0))
    parents, face = points_of(jtype, rule), coordinates[bottom_of(jtype)]
    places = [serendipity(FACE[: len(face)], parent)[0] @ face for parent in parents]
    np.testing.assert_allclose(np.transpose([item.state[i] for i in "XYZ"]), places, rtol=1e-13, atol=1e-15)
    np.testing.assert_allclose(vectors(item.state, "SEP"), frames(coordinates, jtype, parents) @ gap, rtol=1e-12)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_local_directions_are_those_of_abaqus(element, axis):
    """s is the projection of the x axis on the surface; of the z axis where x is normal to it."""
    order = [(1, 2, 0), (2, 0, 1), (0, 1, 2)][axis]
    coordinates = nodes_of(7, "flat", 0.0)[:, np.argsort(order)]
    item = element(7, coordinates)
    normal = np.eye(3)[axis]
    expected = np.eye(3)[2 if axis == 0 else 0]
    gap = 1e-4 * normal + 2e-4 * expected + 3e-4 * np.cross(normal, expected)
    item.advance(opened(7, np.tile(gap, (4, 1)), 0))
    np.testing.assert_allclose(vectors(item.state, "SEP"), np.tile([2e-4, 1e-4, 3e-4], (4, 1)), rtol=1e-12)


@pytest.mark.parametrize("law", ["bilinear", "BK", "PPR"])
@pytest.mark.parametrize("alpha", [2.0e4, 1.0e8, 0.0])
@pytest.mark.parametrize("jtype", [8, 12])
def test_friction_is_a_radial_return(element, jtype, law, alpha):
    """A failed point in contact slides along a path that turns: |T| = mu |T_n|, against the increment of the slip.

    Backward Euler: T points along the increment of w.
    """
    mu = 0.4
    item = element(
        jtype,
        nodes_of(jtype, "flat", 0.0),
        **{**LAWS[law], "ALPHAN": alpha, "ALPHAT": alpha, "CLOSURE": 1, **BETA, "FRICTION": mu},
    )
    item.advance(opened(jtype, np.array([[0.2, 0.0, -1e-3]]), 0))
    assert (item.state["DAMAGE"] == 1).all()
    slid, work = vectors(item.state, "W")[:, [0, 2]], 0.0
    for angle in np.deg2rad([10, 40, 90, 170, 260]):
        # z is n, and y is t: t = n x s
        gap = [0.2 * np.cos(angle), 0.2 * np.sin(angle), -1.5e-3]
        item.advance(opened(jtype, np.array([gap]), 0))
        traction, now = vectors(item.state, "T"), vectors(item.state, "W")[:, [0, 2]]
        shear, step = traction[:, [0, 2]], now - slid
        np.testing.assert_allclose(np.linalg.norm(shear, axis=1), -mu * traction[:, 1], rtol=1e-9)
        along = np.sum(shear * step, axis=1)
        np.testing.assert_allclose(along, np.linalg.norm(shear, axis=1) * np.linalg.norm(step, axis=1), rtol=1e-9)
        work += along
        slid = now
        np.testing.assert_allclose(item.state["DISSF"], work, rtol=1e-9)
    # a small step back sticks
    item.advance(opened(jtype, np.array([[0.2 * np.cos(angle) - 1e-5, 0.2 * np.sin(angle), -1.5e-3]]), 0))
    np.testing.assert_array_equal(vectors(item.state, "W")[:, [0, 2]], slid)


def test_bad_geometry_and_properties(element):
    flat = nodes_of(8, "flat", 0.0)
    upside_down = flat[[0, 3, 2, 1, 4, 7, 6, 5, 8, 11, 10, 9, 12, 15, 14, 13]]
    apart = flat + np.repeat([0.0, 0.01], 8)[:, None]
    seven = nodes_of(7, "flat", 0.0)
    concave = np.where((seven == [1.0, 1.0, 0.0]).all(axis=1, keepdims=True), [0.2, 0.2, 0.0], seven)
    for jtype, coordinates, values, message in (
        (8, upside_down, {}, "U8 element 42: bottom brick is inside out or degenerate"),
        (
            8,
            apart,
            {},
            "the two faces .* do not coincide: nodes 9, 10, 11, 12 must lie on 5, 6, 7, 8; they are 1.0.*E-02 apart",
        ),
        (
            7,
            seven + np.repeat([0.0, 0.01], 4)[:, None],
            {},
            r"U7 element 42: .* top one does not lie above.* it is 1.0.*E-02 above it and 1.41.*E-02 aside",
        ),
        (7, np.zeros((8, 3)), {}, "U7 element 42: the interface has no length"),
        (7, concave, {}, "U7 element 42: .*folds back on itself"),
        (8, flat, {"NU12 TOP": 4.0}, r"PROPS\(30\) NU12 TOP = 4.*not positive definite"),
        (8, flat, {"E3 BOTTOM": 0.0}, r"NU12 BOTTOM .*not positive definite; 0\.0.*must be positive"),
        (8, flat, {"G13 TOP": 0.0}, r"PROPS\(34\) G13 TOP = 0.*: expected a positive value"),
        (8, flat, {"BETAN": -3.0}, "or -1 in a self-contained element"),
        (7, seven, {"ALPHAN": 0.0}, r"PROPS\(1\) ALPHAN = 0"),
    ):
        item = element(jtype, coordinates, label=42, **values)
        with pytest.raises(KernelError, match=message):
            item.evaluate(np.zeros(item.n))


@pytest.mark.parametrize("seed", range(20))
def test_plies_need_a_positive_definite_compliance(element, seed):
    # at the bound: Poisson's ratios in proportion to those at which the least eigenvalue of the compliance is zero
    rng = np.random.default_rng(seed)
    moduli = np.exp(rng.uniform(np.log(5e3), np.log(2e5), 3))
    coupling = np.zeros((3, 3))
    coupling[np.triu_indices(3, 1)] = rng.uniform(-1.0, 1.0, 3)
    # with rows and columns scaled to a unit diagonal it is I - coupling - its transpose
    coupling /= np.linalg.eigvalsh(coupling + coupling.T).max()
    for share, good in ((0.999, True), (1.001, False)):
        nu = share * coupling * np.sqrt(moduli[:, None] / moduli)
        names = {
            "E1": moduli[0],
            "E2": moduli[1],
            "E3": moduli[2],
            "NU12": nu[0, 1],
            "NU13": nu[0, 2],
            "NU23": nu[1, 2],
        }
        item = element(8, nodes_of(8, "flat"), **{f"{name} TOP": value for name, value in names.items()})
        if good:
            item.evaluate(np.zeros(item.n))
        else:
            with pytest.raises(KernelError, match=r"not positive definite; -.*E-.* must be positive"):
                item.evaluate(np.zeros(item.n))
