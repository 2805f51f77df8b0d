# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in continuum elements with NLGEOM: rotations, stretches, tangents, and what UMAT gets."""

from itertools import pairwise

import numpy as np
import pytest
from differences import check_uniform_tangent
from moving_element import AXISYMMETRIC, NODES, SPACE, SQUARE, TYPES, MovingElement, turn
from reference_cells import unit_cell

from uel.errors import DistortionError, Source
from uel.model.element_types import CONTINUUM
from uel.model.mesh import ElementGroup
from uel.model.properties import Elastic, ElasticType, Material, Plastic, SolidSection, UserMaterial

SOURCE = Source("test.inp", 1)
E = 1000.0


@pytest.fixture
def element(solid_group, bound, load, call):
    def element(element_type, *, nu=0.3, group=None, user=None, **material):
        nodes = NODES.get(element_type, SQUARE)
        elastic = Elastic(ElasticType.ISOTROPIC, (E, nu), SOURCE)
        group = group or solid_group(element_type, np.arange(len(nodes))[None], 1.0, elastic=elastic, **material)
        return MovingElement(*bound(group, nodes, load(user)), nodes, call)

    return element


@pytest.mark.parametrize("element_type", TYPES)
def test_stress_and_forces_turn_with_the_body(element, element_type):
    """A stretched element turned by 150 degrees in three increments: exact, for the rule of Hughes and Winget is."""
    solid = element(element_type)
    stretch = np.array([[1.01, 0.004, 0], [0.002, 0.995, 0], [0, 0, 1.0]])
    forces, before = solid.move(stretch)
    at_start = solid.values()[0]
    n = len(at_start) // 2
    for k in (1, 2, 3):
        rotation = turn(k * np.radians(50))
        turned, report = solid.move(rotation @ stretch)
    np.testing.assert_allclose(turned, forces @ rotation[: solid.dimension, : solid.dimension].T, atol=1e-10)
    np.testing.assert_allclose(report.energy, before.energy, atol=1e-12)

    def full(values):
        shear = values[[3]] if n == 4 else values[3:6]
        (xy, *others), (x, y, z) = shear, values[:3]
        xz, yz = others or (0, 0)
        return np.array([[x, xy, xz], [xy, y, yz], [xz, yz, z]])

    expected = rotation @ full(at_start[n:]) @ rotation.T
    np.testing.assert_allclose(full(solid.values()[0][n:]), expected, atol=1e-10)


@pytest.mark.parametrize("element_type", TYPES)
def test_stretch_in_increments(element, element_type):
    """Strains add up by the lengths in the middle, sum of 2 (l_1 - l_0)/(l_1 + l_0), close to the logarithm; nu = 0."""
    solid = element(element_type, nu=0.0)
    stretches, strain = np.linspace(1, 1.5, 6), 0.0
    for before, after in pairwise(stretches):
        forces, _ = solid.move(np.diag([after, 1, 1]))
        strain += 2 * (after - before) / (after + before)
    assert strain == pytest.approx(np.log(1.5), rel=2e-3)
    points = solid.values()
    n = points.shape[1] // 2
    np.testing.assert_allclose(points[:, 0], strain, rtol=1e-12)
    np.testing.assert_allclose(points[:, n], E * strain, rtol=1e-12)
    # work of the forces on a further stretch is stress times volume times its strain: forces have the virtual work
    # principle in the deformed shape
    rate = np.zeros_like(forces)
    rate[:, 0] = solid.nodes[:, 0]
    if element_type in SPACE:
        volume = unit_cell(CONTINUUM[element_type].family.cell)[1]
    elif len(solid.nodes) == 3:
        volume = 0.45
    else:
        x, y = solid.nodes[:4, 0], solid.nodes[:4, 1]
        volume = 0.5 * abs(x @ np.roll(y, -1) - y @ np.roll(x, -1))
    assert -(forces * rate).sum() == pytest.approx(E * strain * volume, rel=1e-10)


@pytest.mark.parametrize("element_type", AXISYMMETRIC)
@pytest.mark.parametrize("direction", [0, 1])
def test_stretch_of_axisymmetric_elements(element, element_type, direction):
    """As above along the radius, which stretches the circumference as well, or along the axis."""
    solid = element(element_type, nu=0.0)
    stretches, strain = np.linspace(1, 1.5, 6), 0.0
    for before, after in pairwise(stretches):
        forces, _ = solid.move(np.diag([after, 1, 1] if direction == 0 else [1, after, 1]))
        strain += 2 * (after - before) / (after + before)
    assert strain == pytest.approx(np.log(1.5), rel=2e-3)
    points = solid.values()
    expected = [strain, 0, strain] if direction == 0 else [0, strain, 0]
    np.testing.assert_allclose(points[:, :3], np.tile(expected, (len(points), 1)), rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(points[:, 4:7], E * points[:, :3], rtol=1e-12, atol=1e-12)
    now = solid.nodes[:, :2] + solid.u.reshape(-1, 2)
    # of the cross-section about the axis, by the sides of its polygon (P. Guldin)
    r, z = now[: 3 if len(now) == 3 else 4].T
    following, above = np.roll(r, -1), np.roll(z, -1)
    volume = np.pi / 3 * ((r * above - following * z) * (r + following)).sum()
    rate = now * np.eye(2)[direction]
    work = E * strain * (2 if direction == 0 else 1) * volume
    assert -(forces * rate).sum() == pytest.approx(work, rel=1e-10)


@pytest.mark.parametrize("element_type", ["CPE3", "CPE4", "CPE4R", "CPE4I", "CPE4IH", *SPACE, *AXISYMMETRIC])
def test_tangent_at_the_start_of_an_increment(element, element_type):
    solid = element(element_type)
    about = element_type in AXISYMMETRIC
    solid.move(np.array([[1.05, 0.0 if about else 0.1, 0], [0.02, 0.98, 0], [0, 0, 1.0]]))
    check_uniform_tangent(solid, about=about)


def test_plastic_strain_turns_with_the_body(element):
    """Yielded, turned by 90 degrees, unloaded along the turned direction: no stress is left in the other one."""
    plastic = Plastic(np.array([[5.0, 0.0], [6.0, 0.1]]), SOURCE)
    straight, turned = element("C3D8", plastic=plastic), element("C3D8", plastic=plastic)
    for body in (straight, turned):
        body.move(np.diag([1.03, 1, 1]))
    quarter = turn(np.pi / 2)
    turned.move(quarter @ np.diag([1.03, 1, 1]))
    straight.move(np.diag([1.025, 1, 1]))
    turned.move(quarter @ np.diag([1.025, 1, 1]))
    a, b = straight.values()[0], turned.values()[0]
    np.testing.assert_allclose(b[[7, 6, 8]], a[[6, 7, 8]], rtol=1e-9)


def user_element(element, element_type):
    """An element of the compressible neo-Hookean material of neohooke.f, with its constants."""
    mu, lame = 3.0, 5.0
    material = Material("M", SOURCE, user=UserMaterial(np.array([mu, lame]), False, SOURCE), state_variables=9)
    nodes = NODES.get(element_type, SQUARE)
    section = SolidSection("ALL", material, None, 1.0, SOURCE, hourglass=1.0)
    group = ElementGroup(element_type, np.array([1]), np.arange(len(nodes))[None], "", section, None, SOURCE)
    return element(element_type, group=group, user="neohooke.f"), mu, lame


def neo_hookean(f, mu, lame):
    det = np.linalg.det(f)
    return (mu * (f @ f.T - np.eye(3)) + lame * np.log(det) * np.eye(3)) / det


@pytest.mark.parametrize("element_type", AXISYMMETRIC)
def test_user_material_gets_the_stretch_around_the_axis(element, element_type):
    """F33 = r/R; sheared along the axis as well."""
    solid, mu, lame = user_element(element, element_type)
    solid.move(np.array([[1.1, 0, 0], [0, 1, 0], [0, 0, 1]]))
    f = np.array([[1.2, 0, 0], [0.3, 0.9, 0], [0, 0, 1.2]])
    solid.move(f)
    stress = neo_hookean(f, mu, lame)
    for point in solid.values():
        np.testing.assert_allclose(point[4:8], stress[[0, 1, 2, 0], [0, 1, 2, 1]], rtol=1e-12)


def test_an_axisymmetric_element_must_not_cross_the_axis(element):
    solid = element("CAX3")
    with pytest.raises(DistortionError, match="crosses the axis at its integration point 1 "):
        solid.evaluate(np.tile([-2.0, 0.0], 3))


@pytest.mark.parametrize("element_type", ["CPE4", "CPE3"])
def test_user_material_gets_deformation_gradient_and_rotation(element, element_type):
    """Simple shear 0.4, then a turn: J sigma = mu (F F^T - 1) + lambda ln J."""
    solid, mu, lame = user_element(element, element_type)
    shear = np.array([[1.1, 0.4, 0], [0, 1, 0], [0, 0, 1]])
    solid.move(shear)
    rotation = turn(0.3)
    solid.move(rotation @ shear)
    f = rotation @ shear
    stress = neo_hookean(f, mu, lame)
    point = solid.values()[0]
    np.testing.assert_allclose(point[4:8], stress[[0, 1, 2, 0], [0, 1, 2, 1]], rtol=1e-12)
    np.testing.assert_allclose(point[8:17].reshape(3, 3).T, rotation, atol=1e-12)
