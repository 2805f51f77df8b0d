# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in plane elements: patch test, rigid body, tangent."""

import numpy as np
import pytest
from reference_cells import patch_of

from uel.elements import Request
from uel.errors import KernelError, Source
from uel.model.element_types import CONTINUUM
from uel.model.properties import Elastic, ElasticType, Orientation, Plastic

E, NU, THICKNESS = 1000.0, 0.3, 2.0
STRAIN = np.array([0.01, -0.004, 0.006])
TYPES = [name for name, kind in CONTINUUM.items() if kind.dimension == 2 and not kind.axisymmetric]


@pytest.fixture
def patch(solid_group, bound, load):
    """Nodes, block and matrix of a unit square in distorted elements."""

    def patch(element_type, **material):
        nodes, elements = patch_of(CONTINUUM[element_type].family.cell)
        coordinates = np.column_stack([nodes, np.zeros(len(nodes))])
        return nodes, *bound(solid_group(element_type, elements, THICKNESS, **material), coordinates, load(None))

    return patch


def displacement(nodes, strain):
    e11, e22, e12 = strain
    return (nodes @ np.array([[e11, e12 / 2], [e12 / 2, e22]])).ravel()


def plane_modulus(element_type):
    """Textbook plane stress and plane strain matrices (Zienkiewicz, The Finite Element Method)."""
    if element_type.startswith("CPS"):
        return E / (1 - NU**2) * np.array([[1, NU, 0], [NU, 1, 0], [0, 0, (1 - NU) / 2]])
    factor = E / ((1 + NU) * (1 - 2 * NU))
    return factor * np.array([[1 - NU, NU, 0], [NU, 1 - NU, 0], [0, 0, (1 - 2 * NU) / 2]])


@pytest.mark.parametrize("element_type", TYPES)
def test_constant_strain_is_reproduced(patch, call, element_type):
    nodes, block, matrix = patch(element_type)
    u = displacement(nodes, STRAIN)
    residual = np.zeros(u.size)
    report = block.evaluate(call, u, u, residual, matrix.data)
    block.commit()
    points = block.state(0).svars.reshape(-1, 8)
    stress = plane_modulus(element_type) @ STRAIN
    np.testing.assert_allclose(points[:, [0, 1, 3]], np.tile(STRAIN, (len(points), 1)), rtol=1e-12)
    np.testing.assert_allclose(points[:, [4, 5, 7]], np.tile(stress, (len(points), 1)), rtol=1e-12)
    if element_type.startswith("CPS"):
        np.testing.assert_allclose(points[:, 2], -NU / E * (stress[0] + stress[1]), rtol=1e-12)
    else:
        np.testing.assert_allclose(points[:, 6], NU * (stress[0] + stress[1]), rtol=1e-12)
    # no force on the inner nodes, and K u = -RHS because the element is linear
    inside = ((nodes > 0) & (nodes < 1)).all(axis=1)
    assert inside.any()
    assert abs(residual.reshape(-1, 2)[inside]).max() < 1e-13
    np.testing.assert_allclose(matrix @ u, -residual, atol=1e-12)
    assert report.energy[1] == pytest.approx(0.5 * stress @ STRAIN * THICKNESS, rel=1e-12)
    assert report.energy[5] == pytest.approx(0.0, abs=1e-20)


@pytest.mark.parametrize("element_type", TYPES)
def test_rank(patch, call, element_type):
    """Three rigid body motions and no other mode without energy."""
    nodes, block, matrix = patch(element_type)
    n, zero = nodes.size, np.zeros(nodes.size)
    block.evaluate(call, zero, zero, zero.copy(), matrix.data)
    k = matrix.toarray()
    x, y = nodes.T
    rigid = np.array([np.tile([1, 0], n // 2), np.tile([0, 1], n // 2), np.column_stack([-y, x]).ravel()])
    np.testing.assert_allclose(k @ rigid.T, 0, atol=1e-10)
    assert np.linalg.matrix_rank(k, tol=1e-8 * abs(k).max()) == n - 3
    np.testing.assert_allclose(k, k.T, rtol=0, atol=1e-12 * abs(k).max())


@pytest.mark.parametrize("element_type", TYPES)
def test_plastic_tangent(patch, call, element_type):
    """AMATRX against central differences of RHS."""
    table = np.array([[5.0, 0.0], [8.0, 0.02]])
    nodes, block, matrix = patch(element_type, plastic=Plastic(table, Source("test.inp", 1)))
    rng = np.random.default_rng(1)
    n = nodes.size
    u = displacement(nodes, STRAIN) + 2e-3 * rng.normal(size=n)

    def residual(u):
        r = np.zeros(n)
        block.evaluate(call, u, u, r, None)
        return r

    report = block.evaluate(call, u, u, np.zeros(n), matrix.data)
    step = 1e-7
    differences = np.array([(residual(u + h) - residual(u - h)) / (2 * step) for h in step * np.eye(n)]).T
    np.testing.assert_allclose(matrix.toarray(), -differences, atol=1e-6 * abs(matrix.data).max())
    # it does yield: energy is dissipated
    assert report.energy[3] > 0.1 * report.energy[1]


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.4999])
def test_bending_of_cpe4_does_not_lock(solid_group, bound, load, call, nu):
    """u1 = xy on a square of side 2, whose mean volume strain is 0: E11 = y/2, E22 = -y/2, 2 E12 = x, energy 4/3 G."""
    elastic = Elastic(ElasticType.ISOTROPIC, (1000.0, nu), Source("test.inp", 1))
    square = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    block, matrix = bound(solid_group("CPE4", np.array([[0, 1, 2, 3]]), 1.0, elastic=elastic), square, load(None))
    u = np.array([1.0, 0, -1, 0, 1, 0, -1, 0])
    report = block.evaluate(call, u, u, np.zeros(8), matrix.data)
    assert report.energy[1] == pytest.approx(4 / 3 * 1000 / (2 * (1 + nu)), rel=1e-9)


@pytest.mark.parametrize("element_type, turned", [("CPS4", [0, 3, 2, 1]), ("CPE4", [0, 2, 1, 3]), ("CPS3", [0, 2, 1])])
def test_inside_out(solid_group, bound, load, call, element_type, turned):
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    block, matrix = bound(solid_group(element_type, np.array([turned]), 1.0), square, load(None))
    with pytest.raises(
        KernelError, match=rf"element 101 \(type {element_type}\): .*inside out at its integration point"
    ):
        block.evaluate(call, np.zeros(8), np.zeros(8), np.zeros(8), matrix.data)


def test_calls_for_other_matrices_leave_nothing(patch, call):
    """Mass and damping calls get zeros, and the state stays."""
    nodes, block, matrix = patch("CPS4")
    u = displacement(nodes, STRAIN)
    block.evaluate(call.asking(Request.MASS), u, u, np.zeros(u.size), matrix.data)
    block.commit()
    assert not matrix.data.any()
    assert not block.state(0).svars.any()


@pytest.mark.parametrize("element_type", ["CPS4", "CPE3"])
@pytest.mark.parametrize("normal", [1.0, -1.0])
def test_orientation_turns_material_and_output(patch, call, element_type, normal):
    """The material is drawn in its own direction 1: stress along it, in local components; the rest is equilibrium."""
    source, angle = Source("test.inp", 1), 0.6
    c, s = np.cos(angle), np.sin(angle)
    axes = np.array([[c, s, 0], [-normal * s, normal * c, 0], [0, 0, normal]])
    e1, e2, nu12, g12 = 2000.0, 500.0, 0.3, 300.0
    ply = Elastic(ElasticType.ENGINEERING_CONSTANTS, (e1, e2, e2, nu12, 0.0, 0.0, g12, g12, g12), source)
    nodes, block, matrix = patch(element_type, elastic=ply, orientation=Orientation("TURNED", axes, source))
    local = np.array([[1 / e1, 0.01 / 2], [0.01 / 2, -nu12 / e1]])
    u = (nodes @ (axes[:2, :2].T @ local @ axes[:2, :2])).ravel()
    report = block.evaluate(call, u, u, np.zeros(u.size), matrix.data)
    block.commit()
    points = block.state(0).svars.reshape(-1, 8)
    expected = [1 / e1, -nu12 / e1, 0, 0.01, 1, 0, 0, 0.01 * g12]
    np.testing.assert_allclose(points, np.tile(expected, (len(points), 1)), atol=1e-12)
    assert report.energy[1] == pytest.approx(0.5 * (1 / e1 + 0.01**2 * g12) * THICKNESS, rel=1e-12)
    assert report.energy[3] == pytest.approx(0, abs=1e-12)
