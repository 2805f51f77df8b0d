# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*ORIENTATION with NLGEOM: the directions of the material turn with it, for built-in materials and for UMAT."""

from itertools import pairwise

import numpy as np
import pytest
from differences import check_uniform_tangent
from moving_element import AXISYMMETRIC, NODES, SPACE, SQUARE, TYPES, MovingElement, turn
from scipy.linalg import polar
from scipy.spatial.transform import Rotation

from uel.errors import DeckError, DistortionError, Source
from uel.model.element_types import CONTINUUM
from uel.model.mesh import ElementGroup
from uel.model.procedures import Static
from uel.model.properties import Elastic, ElasticType, Material, Orientation, Plastic, SolidSection, UserMaterial
from uel.model.steps import Step

SOURCE = Source("test.inp", 1)
PLY = (1200.0, 300.0, 200.0, 0.3, 0.25, 0.4, 150.0, 120.0, 90.0)
"""E1, E2, E3, nu12, nu13, nu23, G12, G13, G23."""
PLANE_AXES = turn(np.radians(30)).T
SPACE_AXES = Rotation.from_euler("zxz", [25, 40, -65], degrees=True).as_matrix().T
COMPONENTS = {3: [0, 1, 3], 4: [0, 1, 2, 3], 6: list(range(6))}
STRETCHES = (1.03, 0.99, 1.0)


def axes_of(element_type):
    """Directions, in rows: in the plane or in space."""
    return SPACE_AXES if CONTINUUM[element_type].dimension == 3 else PLANE_AXES


def stiffness(tensor):
    """(k, k) of the ply along its axes: plane stress 11, 22, 12; plane strain 11, 22, 33, 12; or all."""
    e1, e2, e3, nu12, nu13, nu23, *shear = PLY
    compliance = np.diag([1 / e1, 1 / e2, 1 / e3, *(1 / np.array(shear))])
    compliance[0, 1] = compliance[1, 0] = -nu12 / e1
    compliance[0, 2] = compliance[2, 0] = -nu13 / e1
    compliance[1, 2] = compliance[2, 1] = -nu23 / e2
    kept = COMPONENTS[tensor]
    if tensor == 3:
        return np.linalg.inv(compliance[np.ix_(kept, kept)])
    return np.linalg.inv(compliance)[np.ix_(kept, kept)]


@pytest.fixture
def element(bound, load, call):
    def element(element_type, *, user=False, plastic=None, axes=None, hourglass=0.0):
        nodes = NODES.get(element_type, SQUARE)
        tensor = int(CONTINUUM[element_type].tensor)
        if user:
            constants = UserMaterial(stiffness(tensor).ravel(), False, SOURCE)
            material = Material("M", SOURCE, user=constants, state_variables=3 * tensor + 27)
        elif plastic is not None:
            material = Material("M", SOURCE, Elastic(ElasticType.ISOTROPIC, (1000.0, 0.3), SOURCE), plastic)
        else:
            material = Material("M", SOURCE, Elastic(ElasticType.ENGINEERING_CONSTANTS, PLY, SOURCE))
        orientation = Orientation("O", axes_of(element_type) if axes is None else axes, SOURCE)
        section = SolidSection("ALL", material, orientation, 1.0, SOURCE, hourglass=hourglass or float(user))
        group = ElementGroup(element_type, np.array([1]), np.arange(len(nodes))[None], "", section, None, SOURCE)
        step = Step(1, "Step-1", Static(), SOURCE, nlgeom=True)
        return MovingElement(*bound(group, nodes, load("carried.f" if user else None), steps=(step,)), nodes, call)

    return element


def stretch(axes, stretches=STRETCHES):
    """Deformation gradient of a stretch along directions, which are rows."""
    return axes.T @ np.diag(stretches) @ axes


def in_state(direct, n):
    """Components of a state from the direct ones, of n in the plane (4) or in space (6)."""
    return np.array([*direct, *np.zeros(n - 3)])


@pytest.mark.parametrize("element_type", TYPES)
def test_a_block_turned_while_stretched(element, element_type):
    """Along the fibres and across, then by 150 degrees in three increments: the stresses are those of the strains
    along the directions, 2 (l_1 - l_0)/(l_1 + l_0), and the forces turn."""
    solid, axes = element(element_type), axes_of(element_type)
    forces, before = solid.move(stretch(axes))
    for k in (1, 2, 3):
        rotation = turn(k * np.radians(50))
        if solid.dimension == 3:
            rotation = Rotation.from_rotvec(k * np.radians(50) * np.array([2.0, -1.0, 2.0]) / 3).as_matrix()
        turned, report = solid.move(rotation @ stretch(axes))
    tensor = int(CONTINUUM[element_type].tensor)
    strain = 2 * (np.array(STRETCHES) - 1) / (np.array(STRETCHES) + 1)
    along = in_state(strain, 6)[COMPONENTS[tensor]]
    found = solid.values()
    n = found.shape[1] // 2
    places = [0, 1, 3] if tensor == 3 else slice(None)
    np.testing.assert_allclose(found[:, n:][:, places], np.tile(stiffness(tensor) @ along, (len(found), 1)), atol=1e-9)
    np.testing.assert_allclose(found[:, :n][:, places], np.tile(along, (len(found), 1)), atol=1e-12)
    np.testing.assert_allclose(turned, forces @ rotation[: solid.dimension, : solid.dimension].T, atol=1e-9)
    np.testing.assert_allclose(report.energy, before.energy, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("element_type", AXISYMMETRIC)
def test_an_axisymmetric_ply(element, element_type):
    """Fibres at 30 degrees to the radius; stretched along the radius, and so around, and along the axis."""
    solid = element(element_type)
    solid.move(np.diag([1.02, 0.99, 1.02]))
    strain = 2 * (np.array([1.02, 0.99, 1.02]) - 1) / (np.array([1.02, 0.99, 1.02]) + 1)
    local = PLANE_AXES @ np.diag(strain) @ PLANE_AXES.T
    along = np.array([local[0, 0], local[1, 1], local[2, 2], 2 * local[0, 1]])
    found = solid.values()
    np.testing.assert_allclose(found[:, :4], np.tile(along, (len(found), 1)), rtol=1e-10)
    np.testing.assert_allclose(found[:, 4:], np.tile(stiffness(4) @ along, (len(found), 1)), rtol=1e-10)


@pytest.mark.parametrize("element_type", ["CPE4", "C3D8"])
def test_rotation_and_stretch_in_the_same_increments(element, element_type):
    """By a right angle: what they do to each other is of the second order in the size of the increments."""
    axes, strains = axes_of(element_type), []
    for count in (8, 16):
        solid = element(element_type)
        for k in range(1, count + 1):
            grown = 1 + (np.array(STRETCHES) - 1) * k / count
            solid.move(turn(k / count * np.pi / 2) @ stretch(axes, grown))
        strains.append(solid.values()[0])
    n = len(strains[0]) // 2
    expected = in_state(np.log(STRETCHES), n)
    coarse, fine = (abs(found[:n] - expected).max() for found in strains)
    assert coarse < 0.02 * abs(expected).max()
    # a halved increment; the midpoint rule for the logarithm is of second order as well
    assert coarse / fine == pytest.approx(4, rel=0.1)


@pytest.mark.parametrize("element_type", ["CPS4", "CPE4", "CPE4R", "C3D8", "C3D8R", "C3D10"])
def test_umat_sees_the_numbers_of_the_straight_block(element, element_type):
    """One block is stretched and sheared twice, the other is turned in between: STRESS, STRAN, DSTRAN are the same.

    DROT is the identity, DFGRD0 and DFGRD1 have the components of F along the directions of their time, which turn by
    the rotation of the polar decomposition of the gradient of each increment (Theory Guide, State storage).
    """
    axes = axes_of(element_type)
    first, second = (
        np.array([[a, b, 0], [0.01, c, 0], [0, 0, 1.0]]) for a, b, c in ((1.02, 0.03, 1), (1.05, 0.01, 0.98))
    )
    straight, turned = element(element_type, user=True), element(element_type, user=True)
    rotation = turn(np.radians(70))
    if straight.dimension == 3:
        rotation = Rotation.from_rotvec([0.8, -0.4, 0.9]).as_matrix()
    straight.move(first)
    turned.move(first)
    turned.move(rotation @ first)
    straight.move(second)
    turned.move(rotation @ second)
    a, b = straight.values()[0], turned.values()[0]
    n, tensor = 2 * len(CONTINUUM[element_type].components), int(CONTINUUM[element_type].tensor)
    np.testing.assert_allclose(b[:n], a[:n], atol=1e-9)
    np.testing.assert_allclose(b[n:][: 3 * tensor], a[n:][: 3 * tensor], atol=1e-9)
    drot, *gradients = b[n + 3 * tensor :].reshape(3, 3, 3).transpose(0, 2, 1)
    np.testing.assert_array_equal(drot, np.eye(3))
    then = axes @ polar(first)[0].T @ rotation.T
    f = rotation @ second
    now = then @ polar(f @ np.linalg.inv(rotation @ first))[0].T
    np.testing.assert_allclose(gradients, [then @ rotation @ first @ then.T, now @ f @ now.T], atol=1e-12)


@pytest.mark.parametrize("user", [False, True], ids=["elastic", "umat"])
@pytest.mark.parametrize("element_type", ["CPE3", "CPE4", "CPE4R", *SPACE, *AXISYMMETRIC])
def test_tangent_of_a_turned_ply(element, element_type, user):
    about = element_type in AXISYMMETRIC
    solid = element(element_type, user=user)
    first = np.array([[1.05, 0.0 if about else 0.1, 0], [0.02, 0.98, 0], [0, 0, 1.0]])
    solid.move(first if about else turn(0.7) @ first)
    check_uniform_tangent(solid, about=about)


def test_plastic_strain_is_along_the_directions(element):
    """Yielded, turned by 90 degrees, unloaded: as the straight block, in the directions of the material."""
    plastic = Plastic(np.array([[5.0, 0.0], [6.0, 0.1]]), SOURCE)
    straight, turned = (element("C3D8", plastic=plastic) for _ in range(2))
    quarter = turn(np.pi / 2)
    for body in (straight, turned):
        body.move(stretch(SPACE_AXES, (1.03, 1, 1)))
    turned.move(quarter @ stretch(SPACE_AXES, (1.03, 1, 1)))
    straight.move(stretch(SPACE_AXES, (1.025, 1, 1)))
    turned.move(quarter @ stretch(SPACE_AXES, (1.025, 1, 1)))
    np.testing.assert_allclose(turned.values()[0], straight.values()[0], atol=1e-9)
    # it has yielded: uniaxial strain is stiffer
    assert straight.values()[0][6] < 0.8 * 0.025 * 1000 * 0.7 / (1.3 * 0.4)


def test_isotropic_stretches_in_many_directions_add_up_to_the_logarithm(element):
    """Strains along directions of no account for the material: sum of 2 (l_1 - l_0)/(l_1 + l_0) along axis 1."""
    solid, strain = element("CPE4"), 0.0
    for before, after in pairwise(np.linspace(1, 1.5, 6)):
        solid.move(np.diag([after, 1, 1]))
        strain += 2 * (after - before) / (after + before)
    expected = PLANE_AXES @ np.diag([strain, 0, 0]) @ PLANE_AXES.T
    np.testing.assert_allclose(solid.values()[0][:2], np.diag(expected)[:2], rtol=1e-12)
    np.testing.assert_allclose(solid.values()[0][3], 2 * expected[0, 1], rtol=1e-12)


@pytest.mark.parametrize("element_type", ["CPE4", "C3D8"])
def test_directions_turn_with_the_spin(element, element_type):
    """Simple shear 1 in small increments: by half of it, 28.65 degrees, where the whole gradient turns by 26.57."""
    solid, count = element(element_type, user=True), 50
    for k in range(1, count + 1):
        solid.move([[1, k / count, 0], [0, 1, 0], [0, 0, 1]])
    f = np.array([[1, 1, 0], [0, 1, 0], [0, 0, 1.0]])
    now = axes_of(element_type) @ turn(-0.5).T
    found = solid.values()[0][-9:].reshape(3, 3).T
    np.testing.assert_allclose(found, now @ f @ now.T, atol=1e-4)


def test_half_a_turn_in_one_increment_is_too_much(element):
    solid = element("CPE4")
    solid.move(np.eye(3))
    with pytest.raises(DistortionError, match=r"element 1 \(type CPE4\)"):
        solid.move(turn(np.pi))


def test_directions_out_of_the_plane_are_refused(element):
    message = r"test.inp:1: \*ORIENTATION, NAME=O: element 1 \(type CPE4\), integration point 1: direction 3 must be"
    with pytest.raises(DeckError, match=message):
        element("CPE4", axes=SPACE_AXES)
