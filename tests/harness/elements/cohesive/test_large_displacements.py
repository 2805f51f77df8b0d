# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Cohesive elements with NLGEOM: rotations of any size, tangent, agreement with small displacements."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from uel.elements import Flags

TYPES = ("COH2D4", "COH3D6", "COH3D8")


@pytest.fixture
def large(layer):
    """An element whose calls have NLGEOM."""

    def large(element_type, **options):
        item = layer(element_type, **options)
        item.call = replace(item.call, flags=Flags(1, nlgeom=True))
        return item

    return large


def turned(item, angle):
    """Rotation matrix about an axis that lies anyhow, in the plane about the third one."""
    if item.dimension == 2:
        c, s = np.cos(angle), np.sin(angle)
        return np.array([[c, -s], [s, c]])
    axis = np.array([0.5, -0.3, 0.8])
    return Rotation.from_rotvec(angle * axis / np.linalg.norm(axis)).as_matrix()


def rotated(item, u, rotation):
    """Displacements of the element that is displaced by u, and then turned as a whole."""
    x = item.coordinates
    return ((x + u.reshape(x.shape)) @ rotation.T - x).ravel()


@pytest.mark.parametrize("gap", [0.0, 0.1])
@pytest.mark.parametrize("element_type", TYPES)
def test_no_force_in_a_rotation(large, element_type, gap):
    """By 180 degrees in 50 increments; forces are compared with stiffness times length."""
    item = large(element_type, gap=gap)
    size = 1e4 * item.area * abs(item.coordinates).max()
    for k in range(1, 51):
        residual = item.evaluate(rotated(item, np.zeros(item.coordinates.size), turned(item, k * np.pi / 50)))
        assert abs(residual).max() < 1e-9 * size
        item.block.commit()
    assert abs(item.state()[:, item.dimension : 3 * item.dimension]).max() < 1e-10


@pytest.mark.parametrize("element_type", TYPES)
def test_turned_as_a_whole_while_it_opens(large, element_type):
    """Tractions in the element's axes, damage and energies are those without the rotation; forces turn with it."""
    still, moved = large(element_type), large(element_type)
    n = still.dimension
    far = np.array([0.006, 0.004, -0.003])[:n]
    for k in range(1, 21):
        opened = still.displacements(k / 20 * far)
        rotation = turned(still, k / 20 * 2.0)
        forces = still.evaluate(opened).reshape(-1, n)
        again = moved.evaluate(rotated(moved, opened, rotation)).reshape(-1, n)
        np.testing.assert_allclose(again, forces @ rotation.T, atol=1e-9 * abs(forces).max())
        np.testing.assert_allclose(moved.report.energy, still.report.energy, rtol=1e-9, atol=1e-15)
        still.block.commit()
        moved.block.commit()
    np.testing.assert_allclose(moved.state()[:, n:], still.state()[:, n:], rtol=1e-7, atol=1e-12)
    assert 0 < still.value("DAMAGE") < 1


@pytest.mark.parametrize("gap", [0.0, 0.1])
@pytest.mark.parametrize("element_type", TYPES)
def test_tangent(large, element_type, gap):
    """AMATRX against central differences, turned by 40 degrees, opened, slid and twisted, beyond the onset."""
    item = large(element_type, gap=gap)
    n = item.dimension
    rng = np.random.default_rng(4)
    item.move(np.array([0.004, 0.003, -0.002])[:n], steps=20)
    separations = np.array([0.006, 0.004, -0.003])[:n] * (1 + 0.1 * rng.random((len(item.pairs), 1)))
    u = rotated(
        item, item.displacements(separations) + 1e-3 * rng.normal(size=item.coordinates.size), turned(item, 0.7)
    )
    item.evaluate(u)
    matrix = item.matrix.toarray()
    step = 1e-7
    shifts = step * np.eye(len(u))
    differences = np.array([(item.evaluate(u - h) - item.evaluate(u + h)) / (2 * step) for h in shifts]).T
    np.testing.assert_allclose(matrix, differences, atol=1e-6 * abs(matrix).max())


@pytest.mark.parametrize("element_type", TYPES)
def test_small_displacements(layer, large, element_type):
    """The same forces to the order of the displacements over the length."""
    small, finite = layer(element_type), large(element_type)
    u = 1e-6 * np.random.default_rng(5).normal(size=small.coordinates.size)
    forces = small.evaluate(u)
    np.testing.assert_allclose(finite.evaluate(u), forces, atol=3e-6 * abs(forces).max())
