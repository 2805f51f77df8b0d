# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in elements in space, elements of one point with hourglass stiffness, and masses."""

from dataclasses import replace

import numpy as np
import pytest
from reference_cells import CUBE, affine, integral, nodes_of, patch_of
from scipy.linalg import eigh

from uel.elements import Request
from uel.elements.families.solid import HOURGLASS_FRACTION
from uel.errors import KernelError, Source
from uel.model.element_types import CONTINUUM
from uel.model.properties import Elastic, ElasticType, Orientation, Plastic
from uel.usersub import _binding

SOURCE = Source("test.inp", 1)
MATERIAL = Elastic(ElasticType.ISOTROPIC, (1e6, 0.25), SOURCE)
TYPES = [name for name, kind in CONTINUUM.items() if kind.dimension == 3]


@pytest.fixture
def patch(solid_group, bound, load):
    def patch(element_type, **material):
        nodes, elements = patch_of(CONTINUUM[element_type].family.cell)
        material = {"elastic": MATERIAL} | material
        return nodes, *bound(solid_group(element_type, elements, 1.0, **material), nodes, load(None))

    return patch


@pytest.mark.parametrize("element_type", TYPES)
def test_patch_of_macneal_and_harder(patch, call, element_type):
    """u = 1e-3 (2 x + y + z)/2 and so on: all strains 1e-3, direct stresses 2000, shear stresses 400."""
    nodes, block, matrix = patch(element_type)
    u = (1e-3 * nodes @ np.array([[2, 1, 1], [1, 2, 1], [1, 1, 2]]) / 2).ravel()
    residual = np.zeros(u.size)
    report = block.evaluate(call, u, u, residual, matrix.data)
    block.commit()
    points = block.state(0).svars.reshape(-1, 12)
    np.testing.assert_allclose(points, np.tile([1e-3] * 6 + [2000] * 3 + [400] * 3, (len(points), 1)), rtol=1e-10)
    inside = ((nodes > 0) & (nodes < 1)).all(axis=1)
    assert abs(residual.reshape(-1, 3)[inside]).max(initial=0) < 1e-10 * abs(residual).max()
    np.testing.assert_allclose(matrix @ u, -residual, atol=1e-9)
    # energy of 3 direct and 3 shear components in the unit cube, none of it artificial
    assert report.energy[1] == pytest.approx(0.5e-3 * (3 * 2000 + 3 * 400), rel=1e-10)
    assert report.energy[5] < 1e-20


@pytest.mark.parametrize("element_type", TYPES)
def test_only_rigid_bodies_are_free(patch, call, element_type):
    nodes, block, matrix = patch(element_type)
    n = nodes.size
    block.evaluate(call, np.zeros(n), np.zeros(n), np.zeros(n), matrix.data)
    k = matrix.toarray()
    x, y, z = nodes.T
    o = 0 * x
    turns = [np.column_stack(c).ravel() for c in ([o, -z, y], [z, o, -x], [-y, x, o])]
    rigid = np.array([*(np.tile(e, len(nodes)) for e in np.eye(3)), *turns])
    np.testing.assert_allclose(k @ rigid.T, 0, atol=1e-9 * abs(k).max())
    np.testing.assert_allclose(k, k.T, atol=1e-9 * abs(k).max())
    assert np.linalg.matrix_rank(k, tol=1e-9 * abs(k).max()) == n - 6


@pytest.mark.parametrize("element_type", TYPES)
def test_modes_of_a_single_element(solid_group, bound, load, call, element_type):
    """None beside the rigid ones but in two types.

    C3D20R has six: 8 points times 6 strains for 60 unknowns. C3D6 has one: its 2 points lie on the line through the
    middles of both triangles, and see no twist of these against each other. It needs a neighbour, which stops it.

    Hybrid elements have five strains of shape at each point, and as many of volume as functions of the pressure:
    8 x 5 + 4 of C3D20RH for 60 unknowns, 4 x 5 + 1 of C3D10H for 30, 2 x 5 + 1 of C3D6H for 18.
    """
    kind = CONTINUUM[element_type]
    nodes, _ = affine(kind.family.cell)
    block, matrix = bound(solid_group(element_type, np.arange(len(nodes))[None], 1.0), nodes, load(None))
    n = nodes.size
    block.evaluate(call, np.zeros(n), np.zeros(n), np.zeros(n), matrix.data)
    k = matrix.toarray()
    free = {"C3D20R": 12, "C3D6": 7, "C3D20RH": 16, "C3D10H": 9, "C3D10MH": 9, "C3D6H": 7}.get(element_type, 6)
    assert np.linalg.matrix_rank(k, tol=1e-9 * abs(k).max()) == n - free


@pytest.mark.parametrize("element_type", [name for name in TYPES if CONTINUUM[name].nodes > CONTINUUM[name].corners])
def test_quadratic_displacements(solid_group, bound, load, call, element_type):
    """Strains, point by point, of u = (x^2, x y + z^2, y z); their energy to the rule of the points."""
    family, points = CONTINUUM[element_type].family, CONTINUUM[element_type].points
    nodes, scale = affine(family.cell)
    block, matrix = bound(solid_group(element_type, np.arange(family.nodes)[None], 1.0), nodes, load(None))
    x, y, z = nodes.T
    u = 1e-3 * np.column_stack([x * x, x * y + z * z, y * z]).ravel()
    residual = np.zeros(u.size)
    report = block.evaluate(call, u, u, residual, matrix.data)
    block.commit()
    weights, shapes, _ = _binding.integration_rule(family.number, points, family.nodes, 3)
    x, y, z = (shapes @ nodes).T
    strain = 1e-3 * np.column_stack([2 * x, x, y, y, 0 * x, 3 * z])
    values = block.state(0).svars.reshape(points, 12)
    np.testing.assert_allclose(values[:, :6], strain, rtol=1e-11, atol=1e-15)
    assert report.energy[1] == pytest.approx(0.5 * scale * weights @ (strain * values[:, 6:]).sum(axis=1), rel=1e-11)
    np.testing.assert_allclose(matrix @ u, -residual, atol=1e-12 * abs(residual).max())


@pytest.mark.parametrize("element_type", TYPES)
def test_plastic_tangent(patch, call, element_type):
    """AMATRX against central differences of RHS."""
    nodes, block, matrix = patch(element_type, plastic=Plastic(np.array([[900.0, 0.0], [1500.0, 0.02]]), SOURCE))
    rng = np.random.default_rng(1)
    u = (nodes @ np.diag([4e-3, -2e-3, 1e-3])).ravel() + 1e-4 * rng.normal(size=nodes.size)

    def residual(u):
        r = np.zeros(u.size)
        block.evaluate(call, u, u, r, None)
        return r

    report = block.evaluate(call, u, u, np.zeros(u.size), matrix.data)
    step, direction = 1e-8, rng.normal(size=(u.size, 4))
    differences = np.array([(residual(u + step * d) - residual(u - step * d)) / (2 * step) for d in direction.T]).T
    np.testing.assert_allclose(matrix @ direction, -differences, atol=1e-5 * abs(matrix.data).max())
    assert report.energy[3] > 0.1 * report.energy[1]


def test_bending_of_a_nearly_incompressible_hexahedron_does_not_lock(solid_group, bound, load, call):
    """u1 = x y on a cube of side 2: E11 = y less a third of it in each direction, 2 E12 = x; energy G (16/9 + 4/3)."""
    nu = 0.49999
    elastic = Elastic(ElasticType.ISOTROPIC, (1000.0, nu), SOURCE)
    nodes = 2 * CUBE - 1
    block, matrix = bound(solid_group("C3D8", np.arange(8)[None], 1.0, elastic=elastic), nodes, load(None))
    u = np.column_stack([nodes[:, 0] * nodes[:, 1], np.zeros(8), np.zeros(8)]).ravel()
    report = block.evaluate(call, u, u, np.zeros(24), matrix.data)
    # deviator of E11 = y: y (2/3, -1/3, -1/3); G times its square is 2/3 G y^2, and G x^2/2; integrals of x^2, y^2: 8/3
    assert report.energy[1] == pytest.approx(1000 / (2 * (1 + nu)) * (2 / 3 + 1 / 2) * 8 / 3, rel=1e-6)


@pytest.mark.parametrize("element_type", ["CPS4R", "CPE4R", "C3D8R"])
def test_hourglass_energy(solid_group, bound, load, call, element_type):
    """u1 = x y on a square or cube of side 2, without strain in its middle.

    Gradients of each of the d directions are 1/2 of the corners' signs over 2^(d - 1), their squares sum up to 1/2^d.
    In the plane Abaqus has volume, squares of both directions and the mean hourglass displacement, 1 here; in space
    0.2357, volume, squares of the direction and the sum of the hourglass displacement, 8 (test_hourglass.py).
    """
    d = CONTINUUM[element_type].dimension
    nodes = (2 * CUBE - 1)[: 2**d] * [1, 1, d - 2]
    block, matrix = bound(solid_group(element_type, np.arange(2**d)[None], 1.0), nodes, load(None))
    u = np.outer(nodes[:, 0] * nodes[:, 1], np.eye(d)[0]).ravel()
    report = block.evaluate(call, u, u, np.zeros(u.size), matrix.data)
    shear, volume = 1000 / 2.6, 2**d
    factor = 2 if d == 2 else 0.2357 * 8**2
    assert report.energy[5] == pytest.approx(0.5 * HOURGLASS_FRACTION * shear * volume * factor / 2**d, rel=1e-12)
    assert report.energy[1] == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(u @ (matrix @ u) / 2, report.energy[5], rtol=1e-12)


def test_orientation_in_space(patch, call):
    """A material drawn in its direction 1, which is turned in space: local stress 1 there, local strains of the ply."""
    e1, e2, nu12, g12 = 2000.0, 500.0, 0.3, 300.0
    ply = Elastic(ElasticType.ENGINEERING_CONSTANTS, (e1, e2, e2, nu12, nu12, 0.0, g12, g12, 250.0), SOURCE)
    axes, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    axes[2] = np.cross(axes[0], axes[1])
    nodes, block, matrix = patch("C3D8", elastic=ply, orientation=Orientation("TURNED", axes, SOURCE))
    strain = axes.T @ np.diag([1 / e1, -nu12 / e1, -nu12 / e1]) @ axes
    u = (nodes @ strain).ravel()
    block.evaluate(call, u, u, np.zeros(u.size), matrix.data)
    block.commit()
    points = block.state(0).svars.reshape(-1, 12)
    expected = [1 / e1, -nu12 / e1, -nu12 / e1, 0, 0, 0, 1, 0, 0, 0, 0, 0]
    np.testing.assert_allclose(points, np.tile(expected, (len(points), 1)), atol=1e-10)


def test_inside_out(solid_group, bound, load, call):
    nodes = CUBE[[4, 5, 6, 7, 0, 1, 2, 3]]
    block, matrix = bound(solid_group("C3D8", np.arange(8)[None], 1.0), nodes, load(None))
    with pytest.raises(KernelError, match=r"element 101 \(type C3D8\): .*inside out.*as seen from its other side"):
        block.evaluate(call, np.zeros(24), np.zeros(24), np.zeros(24), matrix.data)


DENSITY = 3.0


@pytest.mark.parametrize("element_type", [name for name, kind in CONTINUUM.items() if not kind.axisymmetric])
def test_mass_of_rigid_and_linear_motions(solid_group, bound, load, call, element_type):
    """Translations have the whole mass; a consistent mass is exact for linear velocities, a lumped one is diagonal."""
    kind = CONTINUUM[element_type]
    cell, d = kind.family.cell, kind.dimension
    nodes, scale = affine(cell)
    group = solid_group(element_type, np.arange(kind.nodes)[None], 2.0)
    material = replace(group.section.material, density=DENSITY)
    group = replace(group, section=replace(group.section, material=material))
    block, matrix = bound(group, np.pad(nodes, ((0, 0), (0, 3 - d))), load(None))
    n = kind.nodes * d
    block.evaluate(call.asking(Request.MASS), np.zeros(n), np.zeros(n), np.zeros(n), matrix.data)
    mass = matrix.toarray()
    factor = DENSITY * scale * (2.0 if d == 2 else 1.0)
    for direction in np.eye(d):
        v = np.tile(direction, kind.nodes)
        assert v @ mass @ v == pytest.approx(factor * integral(cell, (0,) * d), rel=1e-12)
    if kind.nodes > kind.corners:
        # parent coordinates are linear in those of the element
        v = np.outer(nodes_of(cell)[:, 0], np.eye(d)[0]).ravel()
        assert v @ mass @ v == pytest.approx(factor * integral(cell, (2, *(0,) * (d - 1))), rel=1e-12)
        assert eigh(mass, eigvals_only=True).min() > 0
    else:
        np.testing.assert_allclose(mass, np.diag(np.diag(mass)))
        np.testing.assert_allclose(np.diag(mass), factor * integral(cell, (0,) * d) / kind.nodes, rtol=1e-12)


def test_frequencies_of_a_cantilever(solid_group, bound, load, call):
    """1.8751^2 and 4.6941^2 times sqrt(E I/(rho A))/L^2 (S. Timoshenko, Vibration Problems in Engineering); a slender
    beam, so that shear and rotatory inertia take less than one percent of the second."""
    length, height, count = 20.0, 0.5, 10
    x = np.linspace(0, length, 2 * count + 1)
    grid = np.array([[a, b, 0.0] for a in x for b in (0, height / 2, height)])
    k = 6 * np.arange(count)[:, None]
    elements = k + np.array([0, 6, 8, 2, 3, 7, 5, 1])
    group = solid_group("CPS8R", elements, 1.0, elastic=Elastic(ElasticType.ISOTROPIC, (1000.0, 0.0), SOURCE))
    material = replace(group.section.material, density=DENSITY)
    block, matrix = bound(replace(group, section=replace(group.section, material=material)), grid, load(None))
    n = 2 * len(grid)
    zero = np.zeros(n)
    matrices = []
    for request in (2, 4):
        matrix.data[:] = 0
        block.evaluate(call.asking(Request(request)), zero, zero, zero.copy(), matrix.data)
        matrices.append(matrix.toarray())
    # the middle node of an element without one has no stiffness
    free = [dof for dof in range(6, n) if matrices[0][dof, dof]]
    values = eigh(*(m[np.ix_(free, free)] for m in matrices), eigvals_only=True)
    theory = np.array([1.87510, 4.69409]) ** 2 * np.sqrt(1000 * height**2 / 12 / DENSITY) / length**2
    assert np.sqrt(values[:2]) == pytest.approx(theory, rel=0.01)
