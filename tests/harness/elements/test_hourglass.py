# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Elements of one integration point: hourglass control, and forces as Abaqus has them, by results of public codes."""

import numpy as np
import pytest
from scipy.optimize import approx_fprime

from uel.elements.families.solid import HOURGLASS_FRACTION
from uel.errors import Source
from uel.model.element_types import CONTINUUM
from uel.model.properties import SectionControls

SOURCE = Source("test.inp", 1)
SQUARE = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
CUBE = np.vstack([SQUARE - np.eye(3)[2], SQUARE + np.eye(3)[2]])
SKEWED = np.array([[1.0, 0, 0], [2.1, 0.1, 0], [1.9, 1.2, 0], [0.9, 1, 0]])
WARPED = np.array(
    [
        *([0.0, 0, 0], [1.2, 0.1, -0.05], [1.1, 1, 0.1], [-0.1, 0.9, 0]),
        *([0.05, -0.05, 1], [1.15, 0, 1.2], [1, 1.1, 1.1], [-0.05, 1, 0.9]),
    ]
)
TYPES = ["CPS4R", "CPE4R", "CAX4R", "C3D8R"]
ENHANCED = SectionControls(enhanced=True)


def volume_and_means(nodes):
    """Change of the volume with the displacements (nodes, directions), and means of the shape functions over it: of a
    brick, or of a ring with four nodes."""
    dimension = {4: 2, 8: 3}[len(nodes)]
    signs = CUBE[:, :dimension] if dimension == 3 else SQUARE[:, :2]
    change, means, volume = np.zeros(signs.shape), np.zeros(len(nodes)), 0.0
    for point in signs / np.sqrt(3):
        factors = (1 + signs * point) / 2
        functions = factors.prod(axis=1)
        slopes = signs / 2 * functions[:, None] / factors
        jacobian = nodes[:, :dimension].T @ slopes
        radius = 1 / (2 * np.pi) if dimension == 3 else functions @ nodes[:, 0]
        part = np.linalg.det(jacobian) * 2 * np.pi * radius
        change += part * slopes @ np.linalg.inv(jacobian)
        if dimension == 2:
            change[:, 0] += part * functions / radius
        means += part * functions
        volume += part
    return change, means / volume


def test_square_cps4r_as_in_abaqus(forces_of):
    """A public code has the results of Abaqus 2018 for square CPS4R, E 3e7, nu 0.3, to 5e-11 where the stiffness
    of a pattern of unit length is a quarter of 0.005 G = 57692 times twice the thickness, whatever the size."""
    pattern = np.array([1.0, -1, 1, -1]) / 2
    for size in (1.0, 0.01):
        _, tangent, _ = forces_of("CPS4R", size * SQUARE, young=3e7)(np.zeros((4, 2)))
        for direction in (0, 1):
            assert pattern @ tangent[direction::2, direction::2] @ pattern == pytest.approx(57692.3077 / 2, rel=1e-9)


def test_brick_in_tension_as_in_abaqus(forces_of):
    """Abaqus 2024, one C3D8R of 0.075 x 0.1 x 0.002: U2 = -7.9849e-4.

    The public source of it gives no more. With one end clamped, 0.002 at the other and nu 0.3 our former stiffness had
    given the -1.4885e-4 that is on record for it, and RF1 was 0.29093/0.26935 times that of Abaqus; both hold in all
    digits.
    """
    nodes = (CUBE + 1) / 2 * [0.075, 0.1, 0.002]
    _, tangent, _ = forces_of("C3D8R", nodes)(np.zeros((8, 3)))
    u = np.zeros((8, 3))
    u[[1, 2, 5, 6], 0] = 0.002
    free = np.flatnonzero(np.outer(nodes[:, 0] > 0, [False, True, True]))
    u.ravel()[free] = np.linalg.solve(tangent[np.ix_(free, free)], -(tangent @ u.ravel())[free])
    np.testing.assert_allclose(u[:, 1] * [0, -1, 1, 0, 0, -1, 1, 0], -7.9849e-4 * (nodes[:, 0] > 0), atol=0.5e-8)
    former = 0.29093 / 0.288221953  # E of the public source over 2e5, by the former RF1
    force = (tangent @ u.ravel())[3] * former * 200
    assert force == pytest.approx(0.26935, abs=1e-5)


@pytest.mark.parametrize("lengths", [(0.075, 0.1, 0.002), (1.0, 1.0, 1.0)])
def test_brick_stiffness_goes_by_the_direction(control_of, lengths):
    """Abaqus 2024: a node's force per hourglass displacement of its own is 0.004714 G V/L^2, L the length along it."""
    shear = 8.0
    nodes = (CUBE + 1) / 2 * lengths
    force = control_of("C3D8R", nodes, HOURGLASS_FRACTION * shear)
    x, y, z = CUBE.T
    for pattern in (x * y, y * z, z * x, x * y * z):
        for direction, length in enumerate(lengths):
            u = np.outer(pattern, np.eye(3)[direction])
            expected = 0.004714 * shear * np.prod(lengths) / length**2 * u
            np.testing.assert_allclose(force(u)[0], expected, rtol=1e-12, atol=1e-12 * abs(expected).max())


# Abaqus/Standard R2018x, C3D8RT, E 2e11, nu 0.25, NLGEOM: reactions with the default hourglass stiffness less those
# with the parameter 1, of nodes that move by (0.012, -0.007, 0.009) times x y of the parent cube. Source: the file
# verification/abaqus/b533_hex8_c3d8rt_finite_hourglass_nodal.csv of github.com/cooperliu101/fuelsim
ABAQUS_CUBE = {
    0: [165927117.68 - 161528390.0109968, 158962465.52 - 161528389.9935852, 163328829.0933334 - 160029783.341581],
    1: [-164036541.2 + 159601610.0110874, 162188653.2 - 159601610.0064676, 155204978.2666667 - 158531176.6583512],
    2: [-157039153.52 + 161528389.988777, -164147111.28 + 161528390.0065468, 164467144.0266667 - 161100216.675084],
    7: [156912441.2 - 161528389.9884602, -158835753.2 + 161528389.9932684, -166060784.9333333 + 162598823.3419883],
}
ABAQUS_WARPED = {
    0: [
        158555011.1828712 - 154352820.9006599,
        224575695.2886463 - 227810780.6688047,
        198124845.9806131 - 194351661.950354,
    ],
    1: [
        -267643627.5991601 + 263856050.9721652,
        234426157.3490353 - 231505429.6359793,
        173100216.1108363 - 176504949.3197713,
    ],
    2: [
        -164690473.2031524 + 168873327.7279883,
        -260784543.0529242 + 257560828.9827411,
        210248039.3612851 - 206489430.1966299,
    ],
    7: [
        263513676.9424806 - 267963139.1201339,
        -213095207.5621243 + 216490914.4984291,
        -181885966.5560543 + 177914339.9481534,
    ],
}


@pytest.mark.parametrize(("nodes", "reactions"), [((CUBE + 1) / 2, ABAQUS_CUBE), (WARPED, ABAQUS_WARPED)])
def test_c3d8r_with_nlgeom_as_in_abaqus(forces_of, nodes, reactions):
    default = forces_of("C3D8R", nodes, young=2e11, nu=0.25, nlgeom=True)
    weak = forces_of("C3D8R", nodes, young=2e11, nu=0.25, nlgeom=True, hourglass=1.0)
    u = np.outer(CUBE[:, 0] * CUBE[:, 1], [0.012, -0.007, 0.009])
    force = default(u)[0] - weak(u)[0]
    # reactions have sixteen digits, which leaves nine of their difference
    np.testing.assert_allclose(
        force[list(reactions)], list(reactions.values()), rtol=1e-9, atol=1e-9 * abs(force).max()
    )


# Abaqus/Standard R2018x, reactions at prescribed displacements and temperatures, small strains and NLGEOM: CAX4RT of
# E 1e6, nu 0.25, thermal expansion 1e-5, and C3D8RT of E 2e11, nu 0.25, 1.2e-5; one increment. Sources: files of
# verification/abaqus of github.com/cooperliu101/fuelsim
PULLED = np.array([[0.01, 0.02], [0.03, -0.01], [0.06, 0.07], [-0.02, 0.05]])
MOVED = np.array(
    [
        *([0, 0, 0], [0.048, -0.008, 0.012], [0.068, 0.036, -0.016], [-0.016, 0.044, 0.008]),
        *([0.012, -0.02, 0.056], [0.04, 0.016, 0.04], [0.092, 0.064, 0.072], [-0.032, 0.028, 0.044]),
    ]
)
WARMED = [60.0, 110, 145, 85, 170, 130, 215, 155]
REACTIONS = {
    "b90_cax4rt_small_probe_nodes.csv": (
        ("CAX4R", SKEWED, PULLED, [0, 20, -10, 10], False, 1e6, 1e-5),
        [
            *(-251831.25074078768, -434184.21347830538, 574550.30204230896, -417368.81428589218),
            *(421632.94786962291, 533453.91976255248, -349312.48029726575, 318099.10800164513),
        ],
    ),
    "b91_cax4rt_finite_probe_nodes.csv": (
        ("CAX4R", SKEWED, PULLED, [0, 20, 10, -10], True, 1e6, 1e-5),
        [
            *(-268023.69038200204, -444330.47818168812, 598429.3821974484, -438933.02574795717),
            *(453124.5026945548, 550881.64319270302, -357302.07479732024, 332381.86073694221),
        ],
    ),
    "b533_hex8_c3d8rt_finite_hourglass_nodal.csv, regular_general_default": (
        ("C3D8R", (CUBE + 1) / 2, MOVED, WARMED, True, 2e11, 1.2e-5),
        [
            *(-6811198441.068876, -5944485610.697646, -5865310880.984424),
            *(6045070284.343933, -5290890596.747858, -5677706046.011765),
            *(6728532221.174256, 5797419635.473593, -5773397224.898906),
            *(-6216788445.804361, 5098314837.705553, -5772191832.122588),
            *(-6598360998.844698, -5791884817.328156, 5559821800.846502),
            *(6264347322.51061, -5142731971.490073, 5732498773.348143),
            *(6783104134.636327, 5984729327.167261, 5906806191.508652),
            *(-6194706076.947187, 5289529195.917328, 5889479218.314385),
        ],
    ),
    "b533_hex8_c3d8rt_finite_hourglass_nodal.csv, warped_general_default": (
        ("C3D8R", WARPED, MOVED, WARMED, True, 2e11, 1.2e-5),
        [
            *(-5303216005.047455, -7243920329.679159, -6099994579.014953),
            *(6589997288.910837, -5532237125.748165, -6049635629.617105),
            *(6363182878.471865, 7496710420.895963, -6226981933.838955),
            *(-4976630205.72449, 5129159608.851549, -6167712053.452451),
            *(-6796813974.91538, -6889388551.195924, 6058361011.338406),
            *(5787008811.119968, -5305354754.637147, 6172151602.753355),
            *(5195640801.887179, 7292444984.555061, 6178725757.984918),
            *(-6859169594.702524, 5052585746.957823, 6135085823.846786),
        ],
    ),
}


@pytest.mark.parametrize("source", REACTIONS)
def test_reactions_as_in_abaqus(forces_of, source):
    """Those of the mean temperature, which is a pressure, are taken off."""
    (element_type, nodes, u, warmed, nlgeom, young, expansion), reactions = REACTIONS[source]
    change, means = volume_and_means(nodes + nlgeom * np.pad(u, ((0, 0), (0, 3 - u.shape[1]))))
    pressure = young / (1 - 2 * 0.25) * expansion * (means @ warmed)
    force, _, _ = forces_of(element_type, nodes, young=young, nu=0.25, nlgeom=nlgeom)(u)
    expected = np.reshape(reactions, u.shape) + pressure * change
    np.testing.assert_allclose(force, expected, rtol=0, atol=1e-12 * abs(expected).max())


def shape(element_type):
    if element_type == "C3D8R":
        return WARPED
    return SKEWED


CONTROLS = [(name, controls) for name in TYPES for controls in (SectionControls(), ENHANCED)]
CONTROLS.remove(("CAX4R", ENHANCED))


@pytest.mark.parametrize(("element_type", "controls"), CONTROLS)
def test_rank(forces_of, element_type, controls):
    """Nothing but rigid motions costs no energy: three in the plane, six in space; of an axisymmetric element the
    motion along the axis, and a tilt about its point, which hourglass control leaves to the other elements."""
    nodes = shape(element_type)
    _, tangent, _ = forces_of(element_type, nodes, controls=controls)(np.zeros((len(nodes), 3)))
    rigid = {"CAX4R": 2, "C3D8R": 6}.get(element_type, 3)
    assert np.linalg.matrix_rank(tangent, tol=1e-9 * abs(tangent).max()) == len(tangent) - rigid


@pytest.mark.parametrize("nlgeom", [False, True])
@pytest.mark.parametrize(("element_type", "controls"), CONTROLS)
def test_linear_displacements_are_free(forces_of, element_type, controls, nlgeom):
    nodes = shape(element_type)
    u = nodes @ np.array([[0.1, 0.05, 0.02], [-0.03, 0.08, 0.01], [0.02, 0.04, -0.1]])
    _, _, energy = forces_of(element_type, nodes, controls=controls, nlgeom=nlgeom)(u)
    assert energy[1] > 1
    assert energy[5] == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize(("element_type", "controls"), [pair for pair in CONTROLS if pair[0] != "CAX4R"])
def test_energy_does_not_change_with_a_rotation(forces_of, element_type, controls):
    nodes = shape(element_type)
    solid = forces_of(element_type, nodes, controls=controls, nlgeom=True)
    rng = np.random.default_rng(5)
    u = np.column_stack([rng.normal(size=(len(nodes), 2)), np.zeros(len(nodes))]) * 0.1
    c, s = np.cos(2.0), np.sin(2.0)
    rotation = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    before = solid(u)[2][5]
    assert before > 1e-3
    assert solid((nodes + u) @ rotation - nodes)[2][5] == pytest.approx(before, rel=1e-12)
    if controls.enhanced:
        # nor with a rotation of the element before it
        assert forces_of(element_type, nodes @ rotation, controls=controls)(u @ rotation)[2][5] == pytest.approx(
            forces_of(element_type, nodes, controls=controls)(u)[2][5], rel=1e-12
        )


@pytest.mark.parametrize("nlgeom", [False, True])
@pytest.mark.parametrize(("element_type", "controls"), CONTROLS)
def test_force_and_tangent_are_derivatives_of_the_energy(forces_of, control_of, element_type, controls, nlgeom):
    """To ENERGY(6), which is ALLAE."""
    nodes = shape(element_type)
    parameter, dimension = None if controls.enhanced else 7.0, CONTINUUM[element_type].dimension
    u = np.random.default_rng(7).normal(size=(len(nodes), dimension)) * 0.1
    options = {"controls": controls} if controls.enhanced else {"hourglass": parameter}
    solid = forces_of(element_type, nodes, nlgeom=nlgeom, **options)
    alone = control_of(element_type, nodes, parameter, nlgeom=nlgeom)
    force, tangent = alone(u)

    def energy(v):
        return solid(v.reshape(u.shape))[2][5]

    def forces(v):
        return alone(v.reshape(u.shape))[0].ravel()

    np.testing.assert_allclose(approx_fprime(u.ravel(), energy, 1e-7), force.ravel(), atol=2e-6 * abs(force).max())
    np.testing.assert_allclose(approx_fprime(u.ravel(), forces, 1e-7), tangent, atol=1e-5 * abs(tangent).max())


def test_factor_of_the_stiffness(forces_of):
    pattern = np.outer(SQUARE[:, 0] * SQUARE[:, 1], [1.0, 0.0])
    energies = [
        forces_of("CPE4R", SQUARE, controls=SectionControls(hourglass=factor))(pattern)[2][5] for factor in (1, 2.5)
    ]
    assert energies[1] == pytest.approx(2.5 * energies[0], rel=1e-12)
