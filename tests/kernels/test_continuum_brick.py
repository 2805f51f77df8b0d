# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The continuum brick U9: patch test, the built-in bricks, plies, plasticity, beams."""

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from uel.errors import KernelError, Source
from uel.model.properties import Elastic, ElasticType, Material, Plastic

SOURCE = Source("test.inp", 1)
STEEL = Material("STEEL", SOURCE, Elastic(ElasticType.ISOTROPIC, (2.0e5, 0.3), SOURCE))
RUBBER = Material("RUBBER", SOURCE, Elastic(ElasticType.ISOTROPIC, (10.0, 0.4999), SOURCE))
YIELDING = Material("YIELDING", SOURCE, STEEL.elastic, Plastic(np.array([[200.0, 0.0], [260.0, 0.02]]), SOURCE))
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float)
DISTORTED = CORNERS * [1.2, 0.9, 0.7] + 0.12 * np.random.default_rng(3).uniform(-1, 1, (8, 3))
FORMULATIONS = {"plain": 0, "modes": 1, "mean volume": 2}
BUILT_IN = {1: "C3D8I", 2: "C3D8"}
every = pytest.mark.parametrize("formulation", FORMULATIONS.values(), ids=FORMULATIONS)
# patch of seven distorted bricks in a unit cube: MacNeal and Harder, Finite Elements in Analysis and Design 1 (1985) 3
INNER = np.array(
    [
        [0.249, 0.342, 0.192],
        [0.826, 0.288, 0.288],
        [0.850, 0.649, 0.263],
        [0.273, 0.750, 0.230],
        [0.320, 0.186, 0.643],
        [0.677, 0.305, 0.683],
        [0.788, 0.693, 0.644],
        [0.165, 0.745, 0.702],
    ]
)
PATCH = np.vstack([CORNERS, INNER])
# the inner brick, and one on each face of the cube
FACES = [(0, 1, 2, 3), (7, 6, 5, 4), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)]
BRICKS = [tuple(range(8, 16)), *(tuple(face) + tuple(8 + node for node in face) for face in FACES)]
PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


def lame(young, nu):
    """lambda and mu."""
    return young * nu / (1 + nu) / (1 - 2 * nu), young / 2 / (1 + nu)


def strain_matrices(coordinates):
    """(8, 6, 24) strains by displacements at the 2 x 2 x 2 Gauss points, xi first, and Jacobians."""
    signs = 2 * CORNERS - 1
    found = []
    for zeta, eta, xi in itertools.product((-1, 1), repeat=3):
        at = np.array([xi, eta, zeta]) / np.sqrt(3)
        factors = 1 + signs * at
        by_parent = np.stack([signs[:, i] * np.prod(np.delete(factors, i, 1), axis=1) / 8 for i in range(3)], axis=1)
        jacobian = coordinates.T @ by_parent
        gradient = by_parent @ np.linalg.inv(jacobian)
        b = np.zeros((6, 24))
        for row, (i, j) in enumerate(PAIRS):
            b[row, i::3] += gradient[:, j]
            if i != j:
                b[row, j::3] += gradient[:, i]
        found.append((b, np.linalg.det(jacobian)))
    return [np.array(part) for part in zip(*found, strict=True)]


@every
def test_patch(element, reference, formulation):
    """Constant strain on distorted bricks: exact stress everywhere, no residual at the inner nodes."""
    gradient = 1e-3 * np.array([[1.0, 0.4, -0.3], [0.7, -0.5, 0.2], [0.1, 0.6, 0.8]])
    strain = (gradient + gradient.T) / 2
    first, second = lame(2.0e5, 0.3)
    stress = first * np.trace(strain) * np.eye(3) + 2 * second * strain
    residual = np.zeros((16, 3))
    volume = 0.0
    for brick in BRICKS:
        nodes = PATCH[list(brick)]
        item = element(9, nodes, FORMULATION=formulation, material=STEEL)
        u = nodes @ gradient.T
        rhs, tangent = item.advance(u)
        residual[list(brick)] += rhs.reshape(8, 3)
        np.testing.assert_allclose(tangent @ u.ravel(), -rhs, atol=1e-11 * abs(rhs).max())
        axes = reference.ply_axes(nodes)
        for name, expected in (("E", strain), ("S", stress)):
            turned = axes @ expected @ axes.T
            np.testing.assert_allclose(
                reference.tensors(item.state, name), [turned] * 8, atol=1e-11 * abs(expected).max()
            )
        volume += item.energy[1] / (0.5 * np.sum(stress * strain))
    assert volume == pytest.approx(1.0, rel=1e-12)
    assert abs(residual[8:]).max() < 1e-12 * abs(residual[:8]).max()


@pytest.mark.parametrize("angle", [0.0, 35.0])
def test_patch_of_plies(element, reference, angle):
    """The same with plies, in prisms, which lie alike: a distorted patch of quads between two planes."""
    plane = np.array(
        [[0, 0], [0.24, 0], [0.24, 0.12], [0, 0.12], [0.04, 0.02], [0.18, 0.03], [0.16, 0.08], [0.08, 0.08]]
    )
    quads = [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 6, 7]]
    nodes = np.vstack([np.pad(plane, ((0, 0), (0, 1))), np.pad(plane, ((0, 0), (0, 1)), constant_values=0.07)])
    gradient = 1e-3 * np.random.default_rng(4).normal(size=(3, 3))
    for formulation in FORMULATIONS.values():
        residual = np.zeros_like(nodes)
        states = []
        for quad in quads:
            brick = [*quad, *(8 + node for node in quad)]
            item = element(9, nodes[brick], ANGLE=angle, FORMULATION=formulation)
            residual[brick] += item.advance(nodes[brick] @ gradient.T)[0].reshape(8, 3)
            states.append(reference.tensors(item.state, "S"))
        np.testing.assert_allclose(
            states, np.broadcast_to(states[0][0], (5, 8, 3, 3)), atol=1e-10 * np.abs(states).max()
        )
        # nodes on the two planes carry the stress on them: in pairs they carry none
        inner = residual[[4, 5, 6, 7]] + residual[[12, 13, 14, 15]]
        assert abs(inner).max() < 1e-12 * abs(residual).max()


@pytest.mark.parametrize("angle", [0.0, 40.0])
def test_forces_are_integrals_of_the_stress(element, reference, angle):
    """-RHS = sum over the Gauss points of B^T D B u det J, with D of the ply turned from its compliance."""
    item = element(9, DISTORTED, ANGLE=angle)
    u = 1e-3 * np.random.default_rng(1).normal(size=24)
    rhs, _ = item.advance(u)
    axes = reference.ply_axes(DISTORTED, angle)
    force = np.zeros(24)
    stresses = reference.tensors(item.state, "S")
    for k, (b, jacobian) in enumerate(zip(*strain_matrices(DISTORTED), strict=True)):
        strain = np.zeros((3, 3))
        for (i, j), value in zip(PAIRS, b @ u, strict=True):
            strain[i, j] = strain[j, i] = value / (1 if i == j else 2)
        local = axes @ strain @ axes.T
        np.testing.assert_allclose(reference.tensors(item.state, "E")[k], local, atol=1e-11 * abs(local).max())
        stress = reference.ply_stress(local)
        np.testing.assert_allclose(stresses[k], stress, atol=1e-11 * abs(stress).max())
        whole = axes.T @ stress @ axes
        force += jacobian * b.T @ [whole[pair] for pair in PAIRS]
    np.testing.assert_allclose(-rhs, force, atol=1e-11 * abs(force).max())


@pytest.mark.parametrize("formulation", BUILT_IN)
@pytest.mark.parametrize("material", [STEEL, RUBBER, YIELDING], ids=lambda material: material.name)
def test_same_as_the_built_in_brick(element, built_in, reference, formulation, material):
    """C3D8I and C3D8, over two increments."""
    item = element(9, DISTORTED, FORMULATION=formulation, material=material)
    other = built_in(BUILT_IN[formulation], DISTORTED, material)
    rng = np.random.default_rng(1)
    turn = reference.ply_axes(DISTORTED)
    for _ in range(2):
        u = 4e-3 * rng.normal(size=24)
        for method in ("evaluate", "advance"):
            (rhs, tangent), (expected, matrix) = (getattr(brick, method)(u) for brick in (item, other))
            np.testing.assert_allclose(rhs, expected, atol=1e-9 * abs(expected).max())
            np.testing.assert_allclose(tangent, matrix, atol=1e-9 * abs(matrix).max())
        stress = reference.tensors(other.state, "S")
        np.testing.assert_allclose(
            turn.T @ reference.tensors(item.state, "S") @ turn, stress, atol=1e-8 * abs(stress).max()
        )
    if material is YIELDING:
        assert item.energy[1] > 0.5 * u @ tangent @ u


def test_angle_turns_the_ply_in_the_brick(element):
    """A prism turned about the z axis by -30 degrees with ANGLE = 0 is one with ANGLE = 30, seen from elsewhere."""
    nodes = CORNERS * [1.2, 0.9, 0.7] + np.tile(0.1 * np.random.default_rng(0).normal(size=(4, 3)) * [1, 1, 0], (2, 1))
    for formulation in FORMULATIONS.values():
        u = 1e-3 * np.random.default_rng(2).normal(size=(8, 3))
        turn = Rotation.from_euler("z", -30, degrees=True).as_matrix()
        straight = element(9, nodes, ANGLE=30.0, FORMULATION=formulation).evaluate(u)[0].reshape(8, 3)
        turned = element(9, nodes @ turn.T, FORMULATION=formulation).evaluate(u @ turn.T)[0].reshape(8, 3)
        np.testing.assert_allclose(turned @ turn, straight, atol=1e-11 * abs(straight).max())
        other = element(9, nodes, FORMULATION=formulation).evaluate(u)[0].reshape(8, 3)
        assert abs(other - straight).max() > 0.01 * abs(straight).max()


@every
@pytest.mark.parametrize("material", [None, YIELDING], ids=["ply", "yielding"])
def test_tangent(element, reference, formulation, material):
    values = {"FORMULATION": formulation, "ANGLE": 25.0, "material": material}
    item = element(9, DISTORTED, **values)
    u = 2e-3 * np.random.default_rng(0).normal(size=24)
    item.advance(0.3 * u)
    tangent = item.evaluate(u)[1]
    differences = -reference.central_differences(lambda x: item.evaluate(x)[0], u, step=1e-6)
    assert abs(tangent - differences).max() <= 1e-7 * abs(tangent).max()
    np.testing.assert_allclose(tangent, tangent.T, atol=1e-11 * abs(tangent).max())
    assert np.linalg.matrix_rank(tangent, tol=1e-9 * abs(tangent).max()) == 18
    if material is None:
        assert item.energy[1] == pytest.approx(0.09 * 0.5 * u @ tangent @ u, rel=1e-10)


@every
def test_linear_rigid_motions_give_no_force(element, formulation):
    item = element(9, DISTORTED, FORMULATION=formulation)
    for axis in np.eye(3):
        for motion in (np.tile(axis, (8, 1)), np.cross(axis, DISTORTED)):
            rhs, tangent = item.evaluate(1e2 * motion)
            assert abs(rhs).max() <= 1e-11 * 1e2 * abs(tangent).max()


class Mesh:
    """Bricks, those of the project or built-in ones, without a deck: force and matrix of all nodes."""

    def __init__(self, make, nodes, bricks):
        self.nodes, self.bricks = nodes, bricks
        self.items = [make(nodes[list(brick)]) for brick in bricks]

    def matrix(self):
        """Stiffness at zero displacements."""
        total = np.zeros((self.nodes.size,) * 2)
        for item, brick in zip(self.items, self.bricks, strict=True):
            dofs = np.add.outer(3 * np.array(brick), range(3)).ravel()
            total[np.ix_(dofs, dofs)] += item.evaluate(np.zeros(24))[1]
        return total

    def solve(self, fixed, load):
        """Displacements (nodes, 3) under a load (nodes, 3)."""
        free = np.repeat(~fixed, 3)
        u = np.zeros(free.size)
        u[free] = np.linalg.solve(self.matrix()[np.ix_(free, free)], load.ravel()[free])
        return u.reshape(-1, 3)


def cantilever(shift):
    """Six bricks along 6 x 0.2 x 0.1; the sections between them lean by so much."""
    layers = [[x, y, z] for x in range(7) for y, z in ((0, 0), (0.2, 0), (0.2, 0.1), (0, 0.1))]
    nodes = np.array(layers, dtype=float)
    inner = (nodes[:, 0] > 0) & (nodes[:, 0] < 6)
    nodes[inner, 0] += shift * np.sign(nodes[inner, 1] - 0.1) * (-1) ** nodes[inner, 0]
    # numbered so that 1-2-3-4 is the face z = 0
    bricks = [[k, k + 4, k + 5, k + 1, k + 3, k + 7, k + 6, k + 2] for k in range(0, 24, 4)]
    return nodes, bricks


@pytest.mark.parametrize("direction", [1, 2])
@pytest.mark.parametrize("shift", [0.0, 0.1])
def test_slender_cantilever(element, built_in, direction, shift):
    """The beam of MacNeal and Harder, 6 x 0.2 x 0.1, E = 1e7, nu = 0.3: as C3D8I and C3D8 on any mesh; six bricks with
    incompatible modes bend as the beam (P l^3/(3 E I) + 1.2 P l/(G A)) within 3 %, without them they hardly bend."""
    material = Material("BEAM", SOURCE, Elastic(ElasticType.ISOTROPIC, (1e7, 0.3), SOURCE))
    nodes, bricks = cantilever(shift)
    tip, fixed = nodes[:, 0] == 6, nodes[:, 0] == 0
    load = np.zeros_like(nodes)
    load[tip, direction] = 0.25
    found = {}
    for formulation, name in BUILT_IN.items():
        mine = Mesh(lambda xyz, f=formulation: element(9, xyz, FORMULATION=f, material=material), nodes, bricks)
        theirs = Mesh(lambda xyz, n=name: built_in(n, xyz, material), nodes, bricks)
        u, expected = mine.solve(fixed, load), theirs.solve(fixed, load)
        np.testing.assert_allclose(u, expected, atol=1e-9 * abs(expected).max())
        found[formulation] = u[tip, direction].mean()
    height, width = (0.2, 0.1) if direction == 1 else (0.1, 0.2)
    beam = 6**3 / (3 * 1e7 * width * height**3 / 12) + 1.2 * 6 / (1e7 / 2.6 * 0.02)
    if shift == 0:
        assert found[1] == pytest.approx(beam, rel=0.03)
    assert found[2] < 0.5 * beam


def test_uneven_response_of_the_material_needs_equilibrium_of_the_modes(element, reference):
    """A yielding brick in bending: the modes take several passes, and the tangent is that of the condensed force."""
    nodes = CORNERS * [2.0, 1.0, 0.5]
    item = element(9, nodes, FORMULATION=1, material=YIELDING)
    x, _, z = nodes.T
    for curvature in (4e-3, 1e-2, 2e-2):
        u = curvature * np.column_stack([x * (z - 0.25), 0 * x, -(x**2) / 2])
        tangent = item.evaluate(u)[1]
        differences = -reference.central_differences(lambda w: item.evaluate(w)[0], u.ravel(), step=1e-7)
        assert abs(tangent - differences).max() <= 1e-6 * abs(tangent).max()
        item.advance(u)
    stress = reference.tensors(item.state, "S")
    # the modes see to it that the stress across the brick is small where the fibres yield
    assert abs(stress[:, 0, 0]).min() > 190 and abs(stress[:, 2, 2]).max() < 0.1 * abs(stress[:, 0, 0]).max()


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"FORMULATION": 3}, r"U9 element 42: JPROPS\(1\) FORMULATION = 3: expected 0 to 2"),
        ({"FACE": 7}, r"U9 element 42: JPROPS\(2\) FACE = 7: expected 0 to 6"),
        ({"ANGLE": np.inf}, r"U9 element 42: PROPS\(1\) ANGLE = .*: expected a finite value"),
        ({"definition": {"tensor": "PSTRAIN"}}, r"U9 element 42: the material has fewer than six .*use TENSOR=THREED"),
        ({"definition": {"variables": 95}}, r"U9 element 42: .*VARIABLES = 95: expected at least 96"),
    ],
)
def test_bad_properties(element, values, message):
    with pytest.raises(KernelError, match=message):
        element(9, CORNERS, label=42, **values).evaluate(np.zeros(24))


@pytest.mark.nan
def test_modes_without_equilibrium_need_a_smaller_increment(element, library):
    item = element(9, CORNERS, label=42, FORMULATION=1)
    library.messages()
    rhs, tangent = item.evaluate(np.full(24, np.nan))
    assert item.report.pnewdt == 0.25
    assert not rhs.any() and not tangent.any()
    (message,) = library.messages()
    assert message.kind == "warning"
    assert "U9 element 42: its incompatible modes are not in equilibrium; a smaller increment is needed" in message.text


@every
def test_bad_geometry(element, formulation):
    for order in ([3, 2, 1, 0, 7, 6, 5, 4], [0, 1, 2, 3, 0, 1, 2, 3]):
        with pytest.raises(KernelError, match=r"U9 element 42: brick is inside out or degenerate.*; it is -?0?\."):
            element(9, CORNERS[order], label=42, FORMULATION=formulation).evaluate(np.zeros(24))
