# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""U10, the stabilised interface in space that shares the stress of U9 bricks: as U8, and its complaints about them."""

import numpy as np
import pytest
from lines import BRIDGING, TABLE
from neighbours import BOTTOM, FACES, INTERFACE, Sandwich, numberings

from uel.errors import KernelError, Source
from uel.model.properties import Elastic, ElasticType, Material

SOURCE = Source("test.inp", 1)
YOUNG, NU = 8.0e4, 0.3
METAL = Material("METAL", SOURCE, Elastic(ElasticType.ISOTROPIC, (YOUNG, NU), SOURCE))
ISOTROPIC = {
    f"{name} {side}": value
    for side in ("BOTTOM", "TOP")
    for names, value in (
        (("E1", "E2", "E3"), YOUNG),
        (("NU12", "NU13", "NU23"), NU),
        (("G12", "G13", "G23"), YOUNG / 2.6),
    )
    for name in names
}
FACE = np.array([[0.0, 0.0, 0.0], [1.1, -0.15, 0.1], [0.8, 1.1, 0.25], [0.05, 1.2, 0.15]])
BETA = {"BETAN": 6.0e4, "BETAT": 8.0e4}
RIGID = {"ALPHAN": 0.0, "ALPHAT": 0.0, "CLOSURE": 1, **BETA}
# no damage: the traction is <sigma>.n + beta g
STRONG = {**RIGID, "BETAN": 1e6, "BETAT": 1e6, "SIGMAMAX": 1e4, "TAUMAX": 1e4, "GIC": 1e3, "GIIC": 1e3}
OPTIONS = {
    "paper": {},
    "nodal": {"INTEGRATION": 1},
    "face": {"SAMPLING": 1},
    "face, nodal": {"SAMPLING": 1, "INTEGRATION": 1},
    "Gauss point": {"SAMPLING": 2},
    "given": {**BETA, "GAMMABOT": 0.3},
    "BK, viscous": {"LAW": 2, "ETA": 1.45, "VISCOSITY": 0.5},
    "consistent": {"CLOSURE": 1, **BETA},
    "consistent, exponential": {"LAW": 3, "CLOSURE": 1, "BETAN": 2e5, "BETAT": 2e5, "FRICTION": 0.4},
    "consistent, PPR": {"LAW": 4, "SHAPEN": 3.0, "CLOSURE": 1, "BETAN": 2e5, "BETAT": 2e5, "FRICTION": 0.4},
    "consistent, bridging": {**BRIDGING, "CLOSURE": 1, "BETAN": 2e5, "BETAT": 2e5, "FRICTION": 0.4},
    "table": TABLE,
    "rigid": {**RIGID, "SAMPLING": 1, "INTEGRATION": 1},
    "rigid, viscous": {**RIGID, "VISCOSITY": 0.5, "FRICTION": 0.3},
}
GAPS = {
    "elastic": (2e-4, -2e-4, 3e-4),
    "softening": (4e-3, -3e-3, 4e-3),
    "sliding": (4e-3, 5e-3, -1.5e-3),
    "closed": (3e-4, 2e-4, -2e-3),
    "failed": (5e-2, 2e-2, 4e-2),
}
every_option = pytest.mark.parametrize("options", OPTIONS.values(), ids=OPTIONS)


@pytest.fixture(autouse=True)
def start_of_analysis(library):
    """UEXTERNALDB empties the shared module."""
    library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)


def places(skew=0.0):
    """Nodes of two bricks with the interface between them; those off it are moved by `skew` against the prism."""
    noise = skew * np.random.default_rng(6).normal(size=(2, 4, 3))
    return np.vstack([FACE - [0.1, 0, 0.8] + noise[0], FACE, FACE, FACE + [0, 0.1, 0.9] + noise[1]])


def opened(gap, seed, strain=2e-5):
    """Displacements that part the bricks by a gap, with a random strain of them and of the gap."""
    rng = np.random.default_rng(seed)
    u = strain * rng.normal(size=(16, 3))
    gaps = np.array(gap) * (1 + 0.1 * rng.normal(size=(4, 3)))
    u[8:12] = u[4:8] + gaps
    u[12:] += gap
    return u


@every_option
@pytest.mark.parametrize("state", GAPS)
def test_same_as_sixteen_nodes(element, options, state):
    """Plies between parallel faces: traction, state, energies and forces of U8, over two increments."""
    eight = element(8, places(), **{"ANGLE BOTTOM": 30.0, "ANGLE TOP": 30.0}, **options)
    ten = Sandwich(element, 10, places(), solids={"ANGLE": 30.0}, **options)
    for u in (opened((-1e-3, 1e-3, 1.5e-3), 1), opened(GAPS[state], 2)):
        forces = eight.advance(u, dtime=0.3)[0]
        found = ten.advance(u, dtime=0.3)[0]
        np.testing.assert_allclose(found, forces, atol=1e-9 * abs(forces).max() + 1e-10)
        for name, values in ten.state.items():
            np.testing.assert_allclose(values, eight.state[name], rtol=1e-8, atol=1e-9, err_msg=name)
        np.testing.assert_allclose(ten.energy, eight.energy, rtol=1e-8, atol=1e-12)


@pytest.mark.parametrize("sampling", [0, 1, 2])
def test_any_face_of_any_brick(element, sampling):
    """Distorted bricks of an isotropic material in all their 24 numberings, so that each face is the interface."""
    options = {"SAMPLING": sampling, "CLOSURE": 1, **BETA}
    coordinates, u = places(0.1), opened(GAPS["softening"], 3)
    forces = element(8, coordinates, **options, **ISOTROPIC).evaluate(u)[0]
    seen = set()
    ways = numberings(10)
    for k, order in enumerate(ways):
        orders = (order, ways[(5 * k + 3) % len(ways)])
        ten = Sandwich(element, 10, coordinates, orders=orders, material=METAL, **options)
        seen.add(tuple(solid.block.group.section.integers[-1].item() for solid in ten.solids))
        np.testing.assert_allclose(ten.evaluate(u)[0], forces, atol=1e-10 * abs(forces).max())
    assert {face for pair in seen for face in pair} == set(range(1, 1 + len(FACES[10])))


def test_beta_and_gamma(element):
    """(21) and (22) with volumes and the area of the interface: S of the paper's closure is that of U8."""
    coordinates = places(0.1)
    coordinates[12:, 2] += 1.0
    eight = element(8, coordinates, **ISOTROPIC)
    ten = Sandwich(element, 10, coordinates, material=METAL)
    u = opened(GAPS["elastic"], 4)
    eight.advance(u)
    ten.advance(u)
    for name in ("SN", "ST"):
        np.testing.assert_allclose(ten.state[name], eight.state[name], rtol=1e-10)
        assert (ten.state[name] > 0.1).all() and (ten.state[name] < 1).all()


def test_linear_rigid_motions_give_no_force(element):
    coordinates = places(0.1)
    ten = Sandwich(element, 10, coordinates, SAMPLING=1)
    for axis in np.eye(3):
        for motion in (np.tile(axis, (16, 1)), np.cross(axis, coordinates)):
            rhs, tangent = ten.evaluate(1e2 * motion)
            assert abs(rhs).max() <= 1e-11 * 1e2 * 2e5
            assert abs(tangent @ motion.ravel()).max() <= 1e-11 * abs(tangent).max()


def test_unloading_and_compression(element):
    """Along the secant, with all of the damage; a failed interface carries pressure alone."""
    ten = Sandwich(element, 10, places(), **BETA)
    u = opened(GAPS["softening"], 2, 0.0)
    rhs, _ = ten.advance(u)
    damage = ten.state["DAMAGE"]
    assert (damage > 0.05).all() and (damage < 1).all()
    for factor in (0.6, 0.2, 0.9):
        np.testing.assert_allclose(ten.advance(factor * u)[0], factor * rhs, atol=1e-11 * abs(rhs).max())
        np.testing.assert_array_equal(ten.state["DAMAGE"], damage)
    ten.advance(opened(GAPS["failed"], 3, 0.0))
    ten.advance(opened((1e-3, 2e-3, -2e-3), 4, 0.0))
    assert (ten.state["DAMAGE"] == 1).all() and (ten.state["TN"] < 0).all()
    assert not ten.state["TS"].any() and not ten.state["TT"].any()


@pytest.mark.parametrize("formulation", [0, 1, 2])
@pytest.mark.parametrize("sampling", [0, 1, 2])
def test_patch_with_interface(element, formulation, sampling):
    """Uniform strain of distorted bricks, rigid interface: its forces are those of sigma.n, as the bricks have them."""
    coordinates = places(0.1)
    coordinates[4:12, 2] = 0.2 * coordinates[4:12, 0] - 0.1 * coordinates[4:12, 1]  # a plane
    gradient = 1e-3 * np.random.default_rng(2).normal(size=(3, 3))
    u = coordinates @ gradient.T
    options = {**STRONG, "SAMPLING": sampling}
    ten = Sandwich(element, 10, coordinates, solids={"FORMULATION": formulation}, material=METAL, **options)
    force = ten.advance(u)[0].reshape(-1, 3)
    strain = (gradient + gradient.T) / 2
    stress = YOUNG / (1 + NU) * (strain + NU / (1 - 2 * NU) * np.trace(strain) * np.eye(3))
    normal = np.array([-0.2, 0.1, 1.0]) / np.linalg.norm([-0.2, 0.1, 1.0])
    shear = stress @ normal - (normal @ stress @ normal) * normal
    np.testing.assert_allclose(ten.state["TN"], normal @ stress @ normal, rtol=1e-9)
    np.testing.assert_allclose(np.hypot(ten.state["TS"], ten.state["TT"]), np.linalg.norm(shear), rtol=1e-9)
    np.testing.assert_allclose(force[4:8], -force[8:12], atol=1e-12 * abs(force).max())
    area = np.cross(coordinates[6] - coordinates[4], coordinates[7] - coordinates[5]) / 2
    np.testing.assert_allclose(force[8:12].sum(axis=0), -stress @ area, rtol=1e-9)


@pytest.mark.parametrize("sampling", [0, 1])
def test_stress_at_the_face_has_the_incompatible_modes(element, sampling):
    """A brick in pure bending, below: no stress across the interface, but by its nodes alone there is one."""
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    coordinates = np.vstack([square - [0, 0, 0.5], square, square, square - [0, 0, -0.5]])
    x, _, z = coordinates.T
    curvature = 1e-3
    u = np.zeros((16, 3))
    u[:8, 0] = curvature * (x[:8] - 0.5) * (z[:8] + 0.25)
    u[8:12] = u[4:8]
    traction = {}
    for formulation in (0, 1):
        options = {**STRONG, "SAMPLING": sampling, "GAMMABOT": 1 - 1e-12}
        ten = Sandwich(element, 10, coordinates, solids={"FORMULATION": formulation}, material=METAL, **options)
        ten.advance(u)
        traction[formulation] = abs(ten.state["TN"]).max()
    stress = YOUNG * curvature * 0.25
    assert traction[0] > 0.3 * stress
    assert traction[1] < 1e-6 * stress


def test_tangent_is_that_of_the_own_nodes(element, reference):
    """AMATRX holds the bulk stress: the derivative by motions that part the bricks without straining them."""
    for options in ({}, {"CLOSURE": 1, **BETA, "FRICTION": 0.4}, {**RIGID, "VISCOSITY": 0.5}):
        ten = Sandwich(element, 10, places(0.1), material=METAL, **options)
        ten.advance(opened((-1e-3, 1e-3, 1.5e-3), 1))
        for gap in ("softening", "sliding"):
            u = opened(GAPS[gap], 2)
            tangent = ten.evaluate(u)[1]
            for axis in np.eye(3):
                for motion in (np.tile(axis, (8, 1)), np.cross(axis, places(0.1)[8:])):
                    along = np.vstack([np.zeros((8, 3)), motion])
                    slope = [ten.evaluate(u + step * along)[0] for step in (-2e-6, -1e-6, 1e-6, 2e-6)]
                    slope = (slope[0] - 8 * slope[1] + 8 * slope[2] - slope[3]) / 12e-6
                    np.testing.assert_allclose(-slope, tangent @ along.ravel(), atol=1e-6 * abs(tangent).max())


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"OFFSETTOP": 5}, r"U10 element 400: JPROPS\(7\) OFFSETTOP = 5: bulk element 405 .*must be a U9 with FACE"),
        ({"faces": (2, 0)}, r"bulk element 12 has not been evaluated before; it must be a U9 with FACE"),
        (
            {"faces": (1, 1)},
            r"JPROPS\(6\) OFFSETBOTTOM = -389: bulk element 11 is not a neighbour: its face 1 does not",
        ),
        (
            {"faces": (2, 4)},
            r"bulk element 12 is not a neighbour: its face 4 does not lie on that face of the interface",
        ),
        ({"OFFSETBOTTOM": -388, "OFFSETTOP": -389}, r"U10 element 400: .*bulk element 12 is not a neighbour"),
        (
            {"BETAN": -1.0},
            r"U10 element 400: PROPS\(12\) BETAN = -1.*zero, a positive value, -2, or -1 in a self-contained element",
        ),
        ({"ALPHAN": 0.0}, r"U10 element 400: PROPS\(1\) ALPHAN = 0.*requires the consistent law"),
        (
            {"CLOSURE": 1, "BETAN": 1.0e3},
            r"U10 element 400: PROPS\(12\) BETAN: beta = 1000.*, too small for the consist",
        ),
    ],
)
def test_wrong_neighbours_and_properties(element, changes, message):
    ten = Sandwich(element, 10, places(), **changes)
    with pytest.raises(KernelError, match=message):
        ten.evaluate(np.zeros((16, 3)))


def test_a_quad_is_no_neighbour(element):
    ten = Sandwich(element, 10, places())
    for solid in ten.solids:
        solid.evaluate(np.zeros((8, 3)))
    element(1, [[0, 0], [1, 0], [1, 1], [0, 1]], label=BOTTOM, FACE=3).evaluate(np.zeros(8))
    with pytest.raises(KernelError, match=r"U10 element 400: .*bulk element 11 is not a neighbour"):
        ten.item.evaluate(np.zeros(24))


def test_brick_not_yet_evaluated_in_this_iteration(element):
    ten = Sandwich(element, 10, places())
    u = opened(GAPS["elastic"], 1)
    ten.evaluate(u)
    ten.solids[0].evaluate(1.001 * u[:8])
    message = (
        rf"U10 element {INTERFACE}: JPROPS\(7\) OFFSETTOP = -388: bulk element 12 has not been evaluated before the "
    )
    with pytest.raises(KernelError, match=message):
        ten.item.evaluate(1.001 * u[ten.owned])


def test_faces_apart(element):
    coordinates = places()
    ten = Sandwich(element, 10, coordinates)
    apart = element(10, (coordinates + np.repeat([0, 0.01], 8)[:, None])[ten.owned], label=INTERFACE)
    with pytest.raises(
        KernelError, match=r"U10 element 400: .* do not coincide: nodes 5, 6, 7, 8 must lie on 1, 2, 3, 4"
    ):
        apart.evaluate(np.zeros(24))
