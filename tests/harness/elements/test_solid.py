# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in plane elements: patch test, rigid body, tangent."""

import numpy as np
import pytest

E, NU, THICKNESS = 1000.0, 0.3, 2.0
# an irregular quadrilateral patch of unit square with one inner node, as four quadrilaterals
NODES = np.array([[0, 0], [0.5, 0], [1, 0], [0, 0.5], [0.6, 0.45], [1, 0.4], [0, 1], [0.4, 1], [1, 1]], dtype=float)
QUADS = np.array([[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]])
TRIANGLES = np.concatenate([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]])
STRAIN = np.array([0.01, -0.004, 0.006])
TYPES = ["CPS3", "CPS4", "CPE3", "CPE4"]


@pytest.fixture
def patch(solid_group, bound, load):
    def patch(element_type, **material):
        nodes = TRIANGLES if element_type.endswith("3") else QUADS
        coordinates = np.column_stack([NODES, np.zeros(len(NODES))])
        return bound(solid_group(element_type, nodes, THICKNESS, **material), coordinates, load(None))

    return patch


def displacement(strain):
    e11, e22, e12 = strain
    return (NODES @ np.array([[e11, e12 / 2], [e12 / 2, e22]])).ravel()


def plane_modulus(element_type):
    """Textbook plane stress and plane strain matrices (Zienkiewicz, The Finite Element Method)."""
    if element_type.startswith("CPS"):
        return E / (1 - NU**2) * np.array([[1, NU, 0], [NU, 1, 0], [0, 0, (1 - NU) / 2]])
    factor = E / ((1 + NU) * (1 - 2 * NU))
    return factor * np.array([[1 - NU, NU, 0], [NU, 1 - NU, 0], [0, 0, (1 - 2 * NU) / 2]])


@pytest.mark.parametrize("element_type", TYPES)
def test_constant_strain_is_reproduced(patch, call, element_type):
    block, matrix = patch(element_type)
    residual, u = np.zeros(18), displacement(STRAIN)
    report = block.evaluate(call, u, u, residual, matrix.data)
    block.commit()
    points = block.state(0).svars.reshape(-1, 8)
    stress = plane_modulus(element_type) @ STRAIN
    np.testing.assert_allclose(points[:, [0, 1, 3]], np.tile(STRAIN, (len(points), 1)), rtol=0, atol=1e-16)
    np.testing.assert_allclose(points[:, [4, 5, 7]], np.tile(stress, (len(points), 1)), rtol=1e-13)
    if element_type.startswith("CPS"):
        np.testing.assert_allclose(points[:, 2], -NU / E * (stress[0] + stress[1]), rtol=1e-12)
    else:
        np.testing.assert_allclose(points[:, 6], NU * (stress[0] + stress[1]), rtol=1e-12)
    # no force on the inner node, and K u = -RHS because the element is linear
    assert abs(residual[8:10]).max() < 1e-13
    np.testing.assert_allclose(matrix @ u, -residual, atol=1e-12)
    assert report.energy[1] == pytest.approx(0.5 * stress @ STRAIN * THICKNESS, rel=1e-13)


@pytest.mark.parametrize("element_type", TYPES)
def test_rank(patch, call, element_type):
    """Three rigid body motions and no other mode without energy."""
    block, matrix = patch(element_type)
    block.evaluate(call, np.zeros(18), np.zeros(18), np.zeros(18), matrix.data)
    k = matrix.toarray()
    x, y = NODES.T
    rigid = np.array([np.tile([1, 0], 9), np.tile([0, 1], 9), np.column_stack([-y, x]).ravel()])
    np.testing.assert_allclose(k @ rigid.T, 0, atol=1e-11)
    assert np.linalg.matrix_rank(k, tol=1e-8 * abs(k).max()) == 15
    np.testing.assert_array_equal(k, k.T)
