# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Axisymmetric elements in small displacements: constant states, modes without energy, masses, what they refuse.

Direction 1 is the radius, 2 the axis; all forces and masses are those of the whole circumference.
"""

from dataclasses import replace

import numpy as np
import pytest

from uel.elements import Request
from uel.elements.families.solid import HOURGLASS_FRACTION
from uel.errors import DeckError, Source
from uel.model.element_types import CONTINUUM
from uel.model.properties import Elastic, ElasticType, Orientation, Plastic

E, NU, DENSITY = 1000.0, 0.3, 3.0
TYPES = [name for name in CONTINUUM if name.startswith("CAX")]
# an irregular patch of quadrilaterals around one inner node
PATCH = np.array([[0, 0], [0.5, 0], [1, 0], [0, 0.5], [0.6, 0.45], [1, 0.4], [0, 1], [0.4, 1], [1, 1]], dtype=float)
QUADS = np.array([[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]])
TRIANGLES = np.concatenate([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]])
SINGLE = np.array([[0.0, 0], [1, 0.1], [1.2, 0.9], [0.1, 1]])


def with_middles(nodes, corners):
    """Nodes and elements with a node in the middle of each edge."""
    sides = np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1)
    edges, inverse = np.unique(np.sort(sides.reshape(-1, 2)), axis=0, return_inverse=True)
    return np.vstack([nodes, nodes[edges].mean(axis=1)]), np.hstack(
        [corners, len(nodes) + inverse.reshape(sides.shape[:2])]
    )


def patch_of(element_type):
    """Nodes and elements of the patch."""
    count = CONTINUUM[element_type].nodes
    nodes, elements = PATCH, TRIANGLES if count in (3, 6) else QUADS
    return with_middles(nodes, elements) if count > 4 else (nodes, elements)


def single(element_type):
    """Nodes and the one element."""
    count = CONTINUUM[element_type].nodes
    corners = 3 if count in (3, 6) else 4
    nodes, elements = SINGLE[:corners], np.arange(corners)[None]
    return with_middles(nodes, elements) if count > 4 else (nodes, elements)


@pytest.fixture
def ring(solid_group, bound, load):
    """Nodes, block and matrix of a body about the axis, with a thickness that must not count."""

    def ring(element_type, mesh, *, inner=0.0, **material):
        nodes, elements = mesh
        nodes = nodes + np.array([inner, 0.0])
        group = solid_group(element_type, elements, 7.0, **material)
        group = replace(
            group, section=replace(group.section, material=replace(group.section.material, density=DENSITY))
        )
        return nodes, *bound(group, np.column_stack([nodes, np.zeros(len(nodes))]), load(None))

    return ring


def evaluate(block, matrix, call, u):
    residual = np.zeros(u.size)
    matrix.data[:] = 0
    report = block.evaluate(call, u, u, residual, matrix.data)
    return residual, report


def volume(inner):
    """Of the patch about the axis."""
    return np.pi * ((inner + 1) ** 2 - inner**2)


@pytest.mark.parametrize("inner", [0.0, 2.0])
@pytest.mark.parametrize("element_type", TYPES)
def test_constant_states_are_reproduced(ring, call, element_type, inner):
    """u = (a r, b z + c): strains a, b and a around the axis, stresses in equilibrium, so no force inside."""
    nodes, block, matrix = ring(element_type, patch_of(element_type), inner=inner)
    a, b = 0.01, -0.004
    u = (nodes * [a, b] + [0, 0.7]).ravel()
    residual, report = evaluate(block, matrix, call, u)
    block.commit()
    strain = np.array([a, b, a, 0])
    lame, shear = E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU))
    stress = lame * strain[:3].sum() * np.array([1, 1, 1, 0]) + 2 * shear * strain
    points = block.state(0).svars.reshape(-1, 8)
    np.testing.assert_allclose(points, np.tile([*strain, *stress], (len(points), 1)), rtol=1e-12, atol=1e-12)
    r, z = nodes.T
    forces = -residual.reshape(-1, 2)
    inside = (r > inner) & (r < inner + 1) & (z > 0) & (z < 1)
    assert inside.any()
    np.testing.assert_allclose(forces[inside], 0, atol=1e-12 * abs(forces).max())
    np.testing.assert_allclose(matrix @ u, -residual, atol=1e-10)
    assert report.energy[1] == pytest.approx(0.5 * stress @ strain * volume(inner), rel=1e-12)
    # the end is held by the axial stress over its area
    assert forces[z == 1, 1].sum() == pytest.approx(stress[1] * volume(inner), rel=1e-12)


@pytest.mark.parametrize("element_type", TYPES)
def test_only_the_translation_along_the_axis_is_free(ring, call, element_type):
    nodes, block, matrix = ring(element_type, patch_of(element_type))
    residual, _ = evaluate(block, matrix, call, np.tile([0, 0.3], len(nodes)))
    np.testing.assert_allclose(residual, 0, atol=1e-10)
    k = matrix.toarray()
    np.testing.assert_allclose(k, k.T, atol=1e-12 * abs(k).max())
    assert np.linalg.matrix_rank(k, tol=1e-9 * abs(k).max()) == len(k) - 1


@pytest.mark.parametrize("element_type", TYPES)
def test_orientation_has_direction_3_around_the_axis(ring, call, element_type):
    """Fibres along the axis, which is direction 1; without contraction each stress is its modulus times its strain."""
    source, moduli = Source("test.inp", 1), np.array([2000.0, 500.0, 800.0])
    ply = Elastic(ElasticType.ENGINEERING_CONSTANTS, (*moduli, 0.0, 0.0, 0.0, 300.0, 300.0, 300.0), source)
    axes = np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    mesh, turned = patch_of(element_type), Orientation("TURNED", axes, source)
    nodes, block, matrix = ring(element_type, mesh, inner=2.0, elastic=ply, orientation=turned)
    a, b = 0.01, -0.004
    _, report = evaluate(block, matrix, call, (nodes * [a, b]).ravel())
    block.commit()
    strain = np.array([b, a, a])
    points = block.state(0).svars.reshape(-1, 8)
    expected = [*strain, 0, *(moduli * strain), 0]
    np.testing.assert_allclose(points, np.tile(expected, (len(points), 1)), rtol=1e-12, atol=1e-12)
    assert report.energy[1] == pytest.approx(0.5 * moduli @ strain**2 * volume(2.0), rel=1e-12)


@pytest.mark.parametrize("element_type", TYPES)
def test_plastic_tangent(ring, call, element_type):
    """AMATRX against central differences of RHS."""
    plastic = Plastic(np.array([[5.0, 0.0], [8.0, 0.02]]), Source("test.inp", 1))
    nodes, block, matrix = ring(element_type, patch_of(element_type), plastic=plastic)
    rng = np.random.default_rng(1)
    u = (nodes * [0.01, -0.02]).ravel() + 2e-3 * rng.normal(size=nodes.size)
    _, report = evaluate(block, matrix, call, u)
    tangent, step = matrix.toarray(), 1e-7
    for d in rng.normal(size=(4, u.size)):
        slope = (
            (evaluate(block, matrix, call, u - step * d)[0] - evaluate(block, matrix, call, u + step * d)[0]) / step / 2
        )
        np.testing.assert_allclose(slope, tangent @ d, atol=1e-5 * abs(tangent).max())
    assert report.energy[3] > 0.1 * report.energy[1]


@pytest.mark.parametrize(
    ("element_type", "free"), [("CAX3", 2), ("CAX4", 1), ("CAX4R", 2), ("CAX6", 1), ("CAX8", 1), ("CAX8R", 2)]
)
def test_modes_of_a_single_element(ring, call, element_type, free):
    """Beside the translation: one point does not feel a tilt about it, 2 x 2 no (x (3 y^2 - 1), -y (3 x^2 - 1))."""
    nodes, block, matrix = ring(element_type, single(element_type), inner=1.0)
    evaluate(block, matrix, call, np.zeros(nodes.size))
    k = matrix.toarray()
    assert np.linalg.matrix_rank(k, tol=1e-9 * abs(k).max()) == len(k) - free


@pytest.mark.parametrize("nu", [0.0, 0.49999])
def test_bending_of_cax4_does_not_lock(ring, call, nu):
    """u = (x y, 0), x from the middle, far from the axis, where the state is plane: with a third of E11 = y taken from
    each direction, as in C3D8, the energy G (2/3 y^2 + x^2/2) over a square of side 2."""
    square = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
    elastic = Elastic(ElasticType.ISOTROPIC, (E, nu), Source("test.inp", 1))
    radius = 1e6
    _, block, matrix = ring("CAX4", (square, np.arange(4)[None]), inner=radius, elastic=elastic)
    u = np.column_stack([square[:, 0] * square[:, 1], np.zeros(4)]).ravel()
    _, report = evaluate(block, matrix, call, u)
    shear = E / (2 * (1 + nu))
    assert report.energy[1] == pytest.approx(2 * np.pi * radius * shear * (2 / 3 + 1 / 2) * 4 / 3, rel=1e-5)


def test_hourglass_energy_of_cax4r(ring, call):
    """u1 = x y from the middle of a square of side 2, as that of CPE4R with the volume 4 times 2 pi radius."""
    square = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
    _, block, matrix = ring("CAX4R", (square, np.arange(4)[None]), inner=1e6)
    u = np.column_stack([square[:, 0] * square[:, 1], np.zeros(4)]).ravel()
    _, report = evaluate(block, matrix, call, u)
    shear = E / (2 * (1 + NU))
    assert report.energy[5] == pytest.approx(0.5 * HOURGLASS_FRACTION * shear * 4 * 2 * np.pi * 1e6 / 2, rel=1e-5)


@pytest.mark.parametrize("element_type", TYPES)
def test_mass(ring, call, element_type):
    """Of a motion along the axis all of it; its parts at the nodes, lumped in straight elements, have the first moment
    of the mass about the axis, density times the integral of 2 pi r^2."""
    nodes, block, matrix = ring(element_type, patch_of(element_type), inner=2.0)
    zero = np.zeros(nodes.size)
    block.evaluate(call.asking(Request.MASS), zero, zero, zero.copy(), matrix.data)
    mass = matrix.toarray()
    along = np.tile([0.0, 1.0], len(nodes))
    assert along @ mass @ along == pytest.approx(DENSITY * volume(2.0), rel=1e-12)
    by_node = (mass @ along)[1::2]
    assert by_node @ nodes[:, 0] == pytest.approx(DENSITY * 2 * np.pi * (3**3 - 2**3) / 3, rel=1e-12)
    if CONTINUUM[element_type].nodes <= 4:
        np.testing.assert_allclose(mass, np.diag(np.diag(mass)))


@pytest.mark.parametrize("element_type", TYPES)
def test_frequency_of_a_thin_ring(ring, call, element_type):
    """A ring that grows as a whole: angular frequency sqrt(E/density)/radius (S. Timoshenko, Vibration Problems in
    Engineering)."""
    elastic = Elastic(ElasticType.ISOTROPIC, (E, 0.0), Source("test.inp", 1))
    nodes, block, matrix = ring(element_type, patch_of(element_type), inner=500.0, elastic=elastic)
    matrices = []
    zero = np.zeros(nodes.size)
    for request in (2, 4):
        matrix.data[:] = 0
        block.evaluate(call.asking(Request(request)), zero, zero, zero.copy(), matrix.data)
        matrices.append(matrix.toarray())
    growth = np.tile([1.0, 0.0], len(nodes))
    square = (growth @ matrices[0] @ growth) / (growth @ matrices[1] @ growth)
    assert np.sqrt(square) == pytest.approx(np.sqrt(E / DENSITY) / 500.5, rel=1e-5)


@pytest.mark.parametrize("radius", [-0.2, -1e-6])
def test_nodes_beyond_the_axis_are_refused(ring, radius):
    plane = np.array([[radius, 0.0], [1, 0], [1, 1], [0, 1]])
    message = rf"test.inp:7: element 101 \(type CAX4\): node 1 is at the radius {radius:g}; coordinate 1"
    with pytest.raises(DeckError, match=message):
        ring("CAX4", (plane, np.arange(4)[None]))


def test_rounding_puts_no_node_beyond_the_axis(ring, call):
    plane = np.array([[-1e-15, 0.0], [1, 0], [1, 1], [0, 1]])
    nodes, block, matrix = ring("CAX4", (plane, np.arange(4)[None]))
    assert evaluate(block, matrix, call, (nodes * 0.01).ravel())[1].energy[1] > 0
