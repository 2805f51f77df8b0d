# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Interfaces of quadratic elements in space: U11 between faces of eight nodes, U12 with its own bricks of 20 nodes.

What they share with U7 and U8 is in test_interfaces_in_space.py.
"""

import numpy as np
import pytest
from lines import BRIDGING, TABLE
from reference import gauss, serendipity_strain
from reference_cells import EDGES, SQUARE_EDGES, share_of_nodes, with_middles
from reference_cells import nodes_of as cell_nodes
from space import FACE, bottom_of, frames, nodes_of, opened, points_of, stress_of

from uel.errors import KernelError

HEXAHEDRON = cell_nodes("hexahedron20")
RIGID = {"ALPHAN": 0.0, "ALPHAT": 0.0, "CLOSURE": 1}
STRONG = {"SIGMAMAX": 1e4, "TAUMAX": 1e4, "GIC": 1e3, "GIIC": 1e3}
LAWS = {
    "bilinear": {"LAW": 1},
    "BK": {"LAW": 2, "ETA": 1.45},
    "exponential": {"LAW": 3, "POWER": 1.3},
    "PPR": {"LAW": 4, "SHAPEN": 3.0, "SHAPET": 2.5},
    "bridging": BRIDGING,
    "table": TABLE,
}


def bricks(height=(0.8, 0.9), skew=1.0):
    """Two parallelepipeds on a skew face, in which 20 nodes hold every quadratic displacement."""
    along, across = np.array([1.0, 0.1 * skew, 0.2 * skew]), np.array([-0.2 * skew, 0.9, 0.1 * skew])
    face = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) @ [along, across]
    down, up = np.array([0.1 * skew, -0.2 * skew, -height[0]]), np.array([0.2 * skew, 0.1 * skew, height[1]])
    halves = np.vstack([face + down, face]), np.vstack([face, face + up])
    return np.vstack([with_middles(corners, EDGES["hexahedron"]) for corners in halves])


@pytest.mark.parametrize("rule", [0, 1])
def test_constant_traction_on_the_nodes(element, rule):
    """The consistent forces of an eight-node face: those of the corners pull back, with Newton-Cotes too."""
    coordinates = nodes_of(11, "flat", 0.0)
    item = element(11, coordinates, INTEGRATION=rule)
    force = item.evaluate(opened(11, [0.0, 0.0, 1e-4], 0))[0].reshape(-1, 3)
    # 2 N/mm^2 on 1 mm^2
    np.testing.assert_allclose(force[bottom_of(11), 2], 2.0 * np.array(share_of_nodes("quad8")), rtol=1e-12)


@pytest.mark.parametrize("rule", [0, 1])
@pytest.mark.parametrize("values", [RIGID, {"SAMPLING": 1, **RIGID}, {"ALPHAN": 1e18, "ALPHAT": 1e18}], ids=str)
def test_quadratic_displacements(element, values, rule):
    """T = sigma.n at every point where the stress is linear, in parallelepipeds."""
    coordinates = bricks()
    rng = np.random.default_rng(2)
    linear, square = 1e-4 * rng.normal(size=(3, 3)), 1e-4 * rng.normal(size=(3, 3, 3))
    square += square.transpose(0, 2, 1)
    u = coordinates @ linear.T + np.einsum("ijk,aj,ak->ai", square, coordinates, coordinates) / 2
    strong = STRONG if values.get("CLOSURE") == 1 else {"SIGMAMAX": 1e12, "TAUMAX": 1e12, "GIC": 1e22, "GIIC": 1e22}
    item = element(12, coordinates, INTEGRATION=rule, **{**values, **strong})
    item.advance(u)
    axes = frames(coordinates, 12, [(0.0, 0.0)])[0]
    places = np.transpose([item.state[i] for i in "XYZ"])
    expected = [axes @ stress_of(linear + square @ place, coordinates, 12, 0.0) @ axes[1] for place in places]
    found = np.transpose([item.state[f"T{i}"] for i in "SNT"])
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())
    assert (np.ptp(expected, axis=0) > 0.1 * np.abs(expected).max()).all()


def of_plane(jtype):
    """Nodes of U5 or U6 that the nodes of a strip stand for, and where across the strip they are."""
    if jtype == 5:
        order = [0, 1, 1, 0, 3, 2, 2, 3, 4, 1, 4, 0, 5, 2, 5, 3]
        return np.array(order), np.array([0, 0, 1, 1, 0, 0, 1, 1, 0, 0.5, 1, 0.5, 0, 0.5, 1, 0.5])
    order = [np.flatnonzero((place[[0, 2]] == FACE).all(axis=1))[0] for place in HEXAHEDRON]
    return np.concatenate([order, np.add(order, 8)]), np.tile((HEXAHEDRON[:, 1] + 1) / 2, 2)


def strip_of(jtype):
    """U5 or U6 with a curved edge: coordinates in the plane, and nodes above the interface."""
    left, right, middle = np.array([0.0, 0.0]), np.array([1.1, 0.3]), np.array([0.53, 0.2])
    if jtype == 5:
        return np.array([left, right, right, left, middle, middle]), [2, 3, 5]
    low = with_middles([[0.1, -0.6], [1.2, -0.5], right, left], SQUARE_EDGES)
    high = with_middles([left, right, [1.0, 0.8], [0.0, 0.7]], SQUARE_EDGES)
    low[6] = high[4] = middle
    return np.vstack([low, high]), list(range(8, 16))


def plies():
    """The same plies for U6 in plane strain, fibres along the edge, and for U12: axes 2 and 3 change their names."""
    plane, space = {"PLANE": 1}, {}
    for side in ("BOTTOM", "TOP"):
        constants = {"E2": 1.05e4, "E3": 9e3, "NU12": 0.3, "NU13": 0.25, "NU23": 0.4, "G12": 4e3}
        plane |= {f"{key} {side}": value for key, value in constants.items()}
        plane[f"ANGLE {side}"] = np.rad2deg(np.arctan2(0.3, 1.1))
        # nu32/E3 = nu23/E2
        constants = {"E2": 9e3, "E3": 1.05e4, "NU12": 0.25, "NU13": 0.3, "NU23": 0.4 * 9e3 / 1.05e4, "G13": 4e3}
        space |= {f"{key} {side}": value for key, value in constants.items()}
    return plane, space


@pytest.mark.parametrize("rule", [0, 1])
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("plane", "space", "closure"), [(5, 11, 2), (6, 12, 2), (6, 12, 1)])
def test_strip_is_the_plane_element(element, plane, space, closure, law, rule):
    """A strip of width 1 that does not move across it: U11 as U5, U12 as U6 in plane strain."""
    shared = {**LAWS[law], "INTEGRATION": rule, "VISCOSITY": 0.3}
    of_quads, of_bricks = ({}, {}) if plane == 5 else plies()
    if plane == 6:
        shared |= {"CLOSURE": closure, "BETAN": 6e4, "BETAT": 8e4}
    flat, top = strip_of(plane)
    order, across = of_plane(plane)
    thin = element(plane, flat, **{**shared, **of_quads, "THICKNESS": 1.0})
    strip = element(space, np.column_stack([flat[order, 0], across, flat[order, 1]]), **{**shared, **of_bricks})
    rng = np.random.default_rng(4)
    for gap in ((1e-3, 5e-4), (4e-3, 3e-3), (7e-3, -1e-3), (9e-3, 8e-3)):
        u = 2e-5 * rng.normal(size=flat.shape)
        u[top] += gap
        force = thin.advance(u, dtime=0.1)[0].reshape(-1, 2)
        found = strip.advance(np.column_stack([u[order, 0], 0 * across, u[order, 1]]), dtime=0.1)[0].reshape(-1, 3)
        summed = np.zeros_like(force)
        np.add.at(summed, order, found[:, [0, 2]])
        np.testing.assert_allclose(summed, force, atol=1e-9 * abs(force).max())
        np.testing.assert_allclose(strip.energy, thin.energy, rtol=1e-9, atol=1e-13)
    # points of U5 and U6 from left to right
    column = np.rint(1 + points_of(11, 1)[:, 0]).astype(int)
    np.testing.assert_allclose(strip.state["DAMAGE"], thin.state["DAMAGE"][column], rtol=1e-9)
    assert thin.state["DAMAGE"].min() > 0.1


@pytest.mark.parametrize(("jtype", "closure"), [(11, 2), (12, 2), (12, 1)])
def test_fracture_energy(element, law, jtype, closure):
    """Opened evenly to failure, an element dissipates G_Ic at every point of its area."""
    item = element(jtype, nodes_of(jtype, "flat", 0.0), **({"CLOSURE": closure} if jtype == 12 else {}))
    for gap in np.linspace(0, 0.03, 11)[1:]:
        item.advance(opened(jtype, [0.0, 0.0, gap], 0))
    np.testing.assert_allclose(item.state["DISSI"], law["GIC"], rtol=1e-11)
    assert item.energy[3] == pytest.approx(law["GIC"], rel=1e-11)
    np.testing.assert_array_equal(item.state["DAMAGE"], 1)


@pytest.mark.parametrize("jtype", [11, 12])
def test_residual_alone(element, jtype):
    """LFLAGS(3) = 5: the same forces, no matrix, and no trace of the call in the state."""
    item = element(jtype, nodes_of(jtype, "warped"))
    u = opened(jtype, [4e-3, 3e-3, 5e-3], 1, 2e-5)
    item.advance(0.5 * u)
    before, (force, matrix) = item.state["DMAX"].copy(), item.evaluate(u)
    alone = item.evaluate(u, request=5)
    np.testing.assert_array_equal(alone[0], force)
    assert matrix.any() and not alone[1].any()
    item.evaluate(0.5 * u)
    item.evaluate(u, request=5)
    item.block.commit()
    np.testing.assert_array_equal(item.state["DMAX"], before)


def smallest_eigenvalue(element, height, points, share=1.0, **values):
    """Over the largest, of the symmetric part of two bricks on a rigid interface; share: of beta from BETAN = -1."""
    coordinates, zero = bricks((height, height), skew=0.0), np.zeros(120)
    item = element(12, coordinates, BETAN=-1, BETAT=-1, ALPHAN=1e6, ALPHAT=1e6)
    item.advance(zero)
    beta = {f"BETA{i}": share * 1e6 * item.state[f"S{i}"][0] / (1 - item.state[f"S{i}"][0]) for i in "NT"}
    stiff = {"ALPHAN": 1e18, "ALPHAT": 1e18, "SIGMAMAX": 1e12, "TAUMAX": 1e12, "GIC": 1e12, "GIIC": 1e12}
    whole = element(12, coordinates, **beta, **stiff, **values).evaluate(zero)[1]
    stiffness = np.zeros((6, 6))
    for i, j in enumerate([(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]):
        unit = np.zeros((3, 3))
        unit[j] = 1.0
        stiffness[:, i] = stress_of(unit, coordinates, 12, 0.0)[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    for nodes in (slice(0, 20), slice(20, 40)):
        rows = slice(3 * nodes.start, 3 * nodes.stop)
        for point, weight in zip(*gauss(points, 3), strict=True):
            b, jacobian = serendipity_strain(HEXAHEDRON, coordinates[nodes], point)
            whole[rows, rows] += weight * np.linalg.det(jacobian) * b.T @ stiffness @ b
    eigenvalues = np.linalg.eigvalsh(whole + whole.T)
    return eigenvalues[0] / eigenvalues[-1]


@pytest.mark.parametrize("height", [0.25, 1.0, 2.0, 3.0])
def test_coercivity_beside_reduced_integration(element, height):
    """BETAN = -1 beside C3D20, and beside C3D20R, which has six modes without energy: the statements of laws.md."""
    assert min(smallest_eigenvalue(element, height, 3, SAMPLING=sampling) for sampling in (0, 1)) > -1e-12
    assert (smallest_eigenvalue(element, height, 2) > -1e-12) == (height < 3.0)
    assert smallest_eigenvalue(element, height, 2, 2.0) > -1e-12
    assert smallest_eigenvalue(element, height, 2, 100.0, SAMPLING=1) < -1e-9


def moved(node, place):
    """A change of the coordinates."""
    return lambda xyz: xyz.__setitem__(node, place)


@pytest.mark.parametrize(
    ("jtype", "change", "message"),
    [
        (11, moved(slice(None), 0.0), "U11 element 42: the interface has no length or area"),
        (
            11,
            moved(15, [0.01, 0.5, 0.0]),
            "U11 element 42: the faces are apart, and the top one does not lie above the bottom one",
        ),
        # a middle between the quarter point and the corner folds the edge back
        (11, moved([8, 12], [0.05, 0.0, 0.0]), "U11 element 42: .*folds back on itself"),
        (
            12,
            moved(28, [0.5, 0.01, 0]),
            "U12 .* nodes 21, 22, 23, 24 must lie on 5, 6, 7, 8, and the middle nodes on each other",
        ),
        (12, moved([12, 28], [0.05, 0.0, 0.0]), "U12 element 42: .*folds back on itself"),
        (12, moved(slice(0, 4), [[0, 0, 3], [1, 0, 3], [1, 1, 3], [0, 1, 3]]), "U12 element 42: bottom brick is"),
        (12, moved(36, [0.0, 0.0, -0.9]), "U12 element 42: top brick is inside out"),
    ],
)
@pytest.mark.parametrize("estimate", [-2, -1])
def test_geometry(element, jtype, change, message, estimate):
    coordinates = nodes_of(jtype, "flat", 0.0)
    change(coordinates)
    item = element(jtype, coordinates, label=42, **({"BETAN": estimate} if jtype == 12 else {}))
    with pytest.raises(KernelError, match=message):
        item.evaluate(np.zeros(item.n))


@pytest.mark.parametrize(
    ("jtype", "values", "message"),
    [
        (11, {"SIGMAMAX": 0.0}, r"U11 element 42: PROPS\(3\) SIGMAMAX = 0.*positive"),
        (11, {"TANGENT": 2}, r"U11 element 42: JPROPS\(3\) TANGENT = 2: expected 0 to 1"),
        (11, {"ALPHAN": 0.0, "ALPHAT": 0.0}, r"U11 element 42: .* ALPHAN = 0.*expected a positive"),
        (11, {"GIC": 0.0225}, r"U11 element 42: PROPS\(5\) GIC = .*too brittle"),
        (12, {"BETAN": -3.0}, r"U12 element 42: .* BETAN = -3.*, or -1 in a self-contained element"),
        (12, {"CLOSURE": 4}, r"U12 element 42: JPROPS\(2\) CLOSURE = 4: expected 0 to 3"),
        (
            12,
            {"FRICTION": 0.1},
            r"U12 element 42: .* FRICTION = 0.1.*: without the consistent law .CLOSURE = 1 or 3., expected 0",
        ),
        (12, {"CLOSURE": 1, "BETAN": 1.0, "BETAT": 1.0}, r"U12 element 42: .*: beta = 1.0.*, too small"),
        (12, {"NU12 TOP": 4.0}, r"U12 element 42: PROPS\(30\) NU12 TOP = 4.*not positive definite"),
        (12, {"G23 TOP": 0.0}, r"U12 element 42: PROPS\(35\) G23 TOP = 0.*: expected a positive value"),
    ],
    ids=str,
)
def test_properties(element, jtype, values, message):
    item = element(jtype, nodes_of(jtype, "warped"), label=42, **values)
    with pytest.raises(KernelError, match=message):
        item.evaluate(np.zeros(item.n))
