# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in beams, element by element: sections, rigid-body motion, rank, tangent, section forces, mass, directions."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from uel.elements import Flags, Request
from uel.elements.families.beam import SLENDERNESS, section_mass
from uel.elements.families.beam_profiles import SHEAR_FACTORS, profile_of, rectangle_torsion
from uel.errors import DeckError, Source
from uel.model.element_types import BEAM
from uel.model.mesh import ElementGroup
from uel.model.procedures import Static
from uel.model.properties import BeamSection
from uel.model.steps import Step

SOURCE = Source("test.inp", 7)
E, G, DENSITY = 1000.0, 400.0, 3.0
TYPES = tuple(BEAM)
PLANE = tuple(name for name, kind in BEAM.items() if kind.dimension == 2)
SPACE = tuple(name for name, kind in BEAM.items() if kind.dimension == 3)
LINEAR = tuple(name for name, kind in BEAM.items() if kind.nodes == 2)
# l, h, b1, b2, t1, t2, t3: unequal flanges, and nodes that are not at the centroid
UNEQUAL = BeamSection("ALL", "I", (0.3, 1.2, 0.8, 0.5, 0.06, 0.05, 0.04), E, G, DENSITY, SOURCE, (0.2, 0.1, -1.0))
RECT = BeamSection("ALL", "RECT", (0.4, 0.7), E, G, DENSITY, SOURCE, (0.2, 0.1, -1.0))
ENDS = np.array([[0.3, -0.2, 0.4], [2.1, 0.9, 1.3]])


def nodes_of(element_type, ends=ENDS, bow=0.0):
    """(nodes, 3) of one element between two ends, in the plane z = 0 if it is planar; bow: of the middle node."""
    kind = BEAM[element_type]
    x = ends * [1, 1, kind.dimension == 3]
    if kind.nodes == 2:
        return x
    return np.array([x[0], x.mean(axis=0) + np.array([-bow, bow, 0.0]), x[1]])


@pytest.fixture
def beam(bound, load, call):
    """Force, tangent and energies of one beam by its unknowns, and its block."""

    def beam(element_type, section, x, *, large=False):
        kind = BEAM[element_type]
        group = ElementGroup(element_type, np.array([1]), np.arange(kind.nodes)[None], "", section, None, SOURCE)
        steps = (Step(1, "Step-1", Static(), SOURCE, nlgeom=True),) if large else ()
        block, matrix = bound(group, x, load(None), steps)
        used = np.array([6 * node + dof - 1 for node in range(kind.nodes) for dof in kind.dofs(node)])

        def evaluate(u, *, request=Request.NORMAL, nlgeom=False):
            whole = np.zeros(6 * kind.nodes)
            whole[used] = np.ravel(u)
            residual = np.zeros_like(whole)
            matrix.data[:] = 0
            report = block.evaluate(replace(call, flags=Flags(1, nlgeom, request)), whole, whole, residual, matrix.data)
            return -residual[used], matrix.toarray()[np.ix_(used, used)], report.energy

        def stress(call, u, du):
            matrix.data[:] = 0
            block.stress_matrix(call, u, du, matrix.data)
            return matrix.toarray()[np.ix_(used, used)]

        evaluate.block = block
        evaluate.unknowns = len(used)
        evaluate.stress = stress
        return evaluate

    return beam


def values_of(evaluate):
    """Variables of the section points of the only element, by their names: (points,)."""
    evaluate.block.commit()
    state = evaluate.block.state(0)
    names = state.variables.names
    return dict(zip(names, state.svars.reshape(-1, len(names)).T, strict=True))


def motion(element_type, x, displacement, rotation):
    """Unknowns of fields of the place, (3,) each."""
    found = [np.concatenate([displacement(p), rotation(p)]) for p in x]
    dofs = np.array(BEAM[element_type].dofs(0)) - 1
    return np.array(found)[:, dofs].ravel()


def rigid_motions(element_type, x):
    """Translations and rotations of the space of a type, in rows."""
    found = []
    for axis in np.eye(3):
        found.append(motion(element_type, x, lambda p, a=axis: a, lambda p: np.zeros(3)))
        found.append(motion(element_type, x, lambda p, a=axis: np.cross(a, p), lambda p, a=axis: a))
    if BEAM[element_type].dimension == 3:
        return np.array(found)
    # along x and y, and about z
    return np.array([found[0], found[2], found[5]])


def test_torsion_of_rectangles():
    """J/(a b^3), b the shorter side (S. Timoshenko, J. Goodier, Theory of Elasticity, 1951, article 94, table 4)."""
    for ratio, expected in ((1, 0.1406), (1.5, 0.196), (2, 0.229), (3, 0.263), (4, 0.281), (10, 0.312)):
        # the table is rounded
        assert rectangle_torsion(ratio, 1.0) / ratio == pytest.approx(expected, abs=6e-4)
        assert rectangle_torsion(1.0, ratio) == pytest.approx(rectangle_torsion(ratio, 1.0))


def constants(inside, size, count=1500):
    """Area, centroid and second moments of a region of the square of a size, by counting the cells of a grid."""
    at = ((np.arange(count) + 0.5) / count - 0.5) * size
    x, y = np.meshgrid(at, at)
    x, y = x[inside(x, y)], y[inside(x, y)]
    cell = (size / count) ** 2
    centre = np.array([x.mean(), y.mean()])
    x, y = x - centre[0], y - centre[1]
    return cell * len(x), centre, cell * np.array([(y**2).sum(), (x**2).sum(), (x * y).sum()])


def i_shape(x, y):
    """UNEQUAL, with the web up to the middle of the flanges."""
    low, high, b1, b2, t1, t2, t3 = -0.3, 0.9, 0.8, 0.5, 0.06, 0.05, 0.04
    bottom = (abs(x) < b1 / 2) & (y > low) & (y < low + t1)
    top = (abs(x) < b2 / 2) & (y < high) & (y > high - t2)
    return bottom | top | ((abs(x) < t3 / 2) & (y > low) & (y < high))


SHAPES = {
    "RECT": ((0.4, 0.7), lambda x, y: (abs(x) < 0.2) & (abs(y) < 0.35), 0.0),
    "CIRC": ((0.5,), lambda x, y: np.hypot(x, y) < 0.5, 0.0),
    "PIPE": ((0.5, 0.02), lambda x, y: (np.hypot(x, y) < 0.5) & (np.hypot(x, y) > 0.48), 0.0),
    "BOX": (
        (0.8, 0.6, *(0.02,) * 4),
        lambda x, y: (abs(x) < 0.4) & (abs(y) < 0.3) & ~((abs(x) < 0.38) & (abs(y) < 0.28)),
        0.0,
    ),
    "I": (UNEQUAL.dimensions, i_shape, 0.03),
}


@pytest.mark.parametrize("profile", SHAPES)
def test_section_constants(profile):
    """Those of the region itself, but for the squared thickness of thin walls, and for I where web and flange meet."""
    dimensions, inside, overlap = SHAPES[profile]
    found = profile_of(replace(RECT, profile=profile, dimensions=dimensions), 3)
    area, centre, inertia = constants(inside, 2.0)
    assert found.area == pytest.approx(area, rel=5e-3 + overlap)
    np.testing.assert_allclose(found.centroid, centre, atol=2e-3 + overlap)
    np.testing.assert_allclose(found.inertia, inertia, rtol=5e-3 + overlap, atol=1e-4)


def test_torsion_of_walls():
    """Open and closed sections (R. Bredt; S. Timoshenko, Strength of Materials II, 1956, sections 53 and 57)."""
    slit = profile_of(UNEQUAL, 3)
    high = 1.2 - 0.03 - 0.025
    assert slit.torsion == pytest.approx((0.8 * 0.06**3 + 0.5 * 0.05**3 + high * 0.04**3) / 3)
    box = profile_of(replace(RECT, profile="BOX", dimensions=SHAPES["BOX"][0]), 3)
    assert box.torsion == pytest.approx(4 * (0.78 * 0.58) ** 2 * 0.02 / (2 * (0.78 + 0.58)))
    pipe = profile_of(replace(RECT, profile="PIPE", dimensions=(0.5, 0.02)), 3)
    assert pipe.torsion == pytest.approx(2 * np.pi * 0.49**3 * 0.02)
    circle = profile_of(replace(RECT, profile="CIRC", dimensions=(0.5,)), 3)
    assert circle.torsion == pytest.approx(np.pi * 0.5**4 / 2)


@pytest.mark.parametrize("section", [RECT, UNEQUAL], ids=["RECT", "I"])
@pytest.mark.parametrize("element_type", TYPES)
def test_rigid_motions_are_all_that_cost_nothing(beam, element_type, section):
    x = nodes_of(element_type, bow=0.2)
    evaluate = beam(element_type, section, x)
    force, k, _ = evaluate(np.zeros(evaluate.unknowns))
    assert not force.any()
    rigid = rigid_motions(element_type, x)
    np.testing.assert_allclose(k, k.T, atol=1e-12 * abs(k).max())
    np.testing.assert_allclose(k @ rigid.T, 0, atol=1e-11 * abs(k).max())
    scale = np.sqrt(np.diag(k))
    values = np.linalg.eigvalsh(k / np.outer(scale, scale))
    assert (values < 1e-10).sum() == len(rigid)


@pytest.mark.parametrize("element_type", TYPES)
def test_tangent_is_the_derivative_of_the_forces(beam, element_type):
    evaluate = beam(element_type, UNEQUAL, nodes_of(element_type, bow=0.2))
    u = 1e-3 * np.random.default_rng(3).normal(size=evaluate.unknowns)
    force, k, energy = evaluate(u)
    step = 1e-3
    found = np.array([evaluate(u + d)[0] - evaluate(u - d)[0] for d in step * np.eye(len(u))]).T / (2 * step)
    np.testing.assert_allclose(k, found, atol=1e-9 * abs(k).max())
    # what it stores is the work of its forces
    assert energy[1] == pytest.approx(0.5 * u @ force)


@pytest.mark.parametrize("element_type", PLANE)
def test_large_displacements(beam, element_type):
    """Forces are the derivatives of the energy, the tangent that of the forces; a large turn costs nothing."""
    x = nodes_of(element_type, bow=0.2)
    evaluate = beam(element_type, UNEQUAL, x)
    u = 0.3 * np.random.default_rng(3).normal(size=evaluate.unknowns)
    force, k, _ = evaluate(u, nlgeom=True)
    step = 1e-5
    pairs = [(evaluate(u + d, nlgeom=True), evaluate(u - d, nlgeom=True)) for d in step * np.eye(len(u))]
    np.testing.assert_allclose(k, k.T, atol=1e-12 * abs(k).max())
    slopes = np.array([one[0] - other[0] for one, other in pairs]).T / (2 * step)
    np.testing.assert_allclose(k, slopes, atol=1e-7 * abs(k).max())
    work = np.array([one[2][1] - other[2][1] for one, other in pairs]) / (2 * step)
    np.testing.assert_allclose(force, work, atol=1e-7 * abs(force).max())
    angle = 2.5
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    turned = motion(element_type, x, lambda p: turn @ p - p + [3.0, -1.0, 0.0], lambda p: np.array([0, 0, angle]))
    force, _, energy = evaluate(turned, nlgeom=True)
    np.testing.assert_allclose(force, 0, atol=1e-10 * abs(k).max())
    assert energy[1] == pytest.approx(0, abs=1e-20 * abs(k).max())


@pytest.mark.parametrize("nlgeom", [False, True], ids=["small", "NLGEOM"])
@pytest.mark.parametrize("element_type", ["B21", "B22", "B31", "B32"])
def test_initial_stress_matrix(beam, call, element_type, nlgeom):
    """A perturbation has the matrix of the state that it leads to; with NLGEOM it is a part of the tangent."""
    x = nodes_of(element_type, bow=0.2)
    evaluate = beam(element_type, UNEQUAL, x, large=nlgeom)
    n = evaluate.unknowns
    size = 6 * len(x)
    used = np.array([6 * node + dof - 1 for node in range(len(x)) for dof in BEAM[element_type].dofs(node)])

    def stress(request, u, du):
        whole, change = np.zeros(size), np.zeros(size)
        whole[used], change[used] = u, du
        return evaluate.stress(replace(call, flags=Flags(1, nlgeom, request)), whole, change)

    random = np.random.default_rng(4)
    at = 0.1 * random.normal(size=n) if nlgeom else np.zeros(n)
    du = random.normal(size=n)
    added = stress(Request.ADDED_STRESS, at, du)
    base = stress(Request.BASE_STRESS, at + du * 1e-5, np.zeros(n)) - stress(Request.BASE_STRESS, at, np.zeros(n))
    if not nlgeom:
        np.testing.assert_allclose(added, 1e5 * base, atol=1e-9 * abs(added).max())
    translation = np.zeros(n)
    translation[:: len(BEAM[element_type].dofs(0))] = 1.0
    np.testing.assert_allclose(added @ translation, 0, atol=1e-9 * abs(added).max())
    if nlgeom:
        tangent = evaluate(at, nlgeom=True)[1]
        part = stress(Request.BASE_STRESS, at, np.zeros(n))
        # what is left of the tangent goes through the strains of the points alone
        values = np.linalg.svd(tangent - part, compute_uv=False)
        strains = BEAM[element_type].points * (6 if BEAM[element_type].dimension == 3 else 3)
        np.testing.assert_allclose(values[strains:], 0, atol=1e-10 * values[0])
        assert np.linalg.svd(part, compute_uv=False)[0] > 1e-3 * values[0]


def turned_by(x, u, turn, shift):
    """Unknowns after displacements and rotation vectors u, and then a rotation and a translation of all."""
    u = u.reshape(-1, 6)
    moved = turn.apply(x + u[:, :3]) + shift - x
    return np.hstack([moved, (turn * Rotation.from_rotvec(u[:, 3:])).as_rotvec()]).ravel()


@pytest.mark.parametrize("turn", [[0.3, -0.2, 0.5], [2.0, 1.0, -1.5], [0.0, 3.1, 0.0]])
@pytest.mark.parametrize("element_type", ["B31", "B32"])
def test_rotation_of_all_changes_nothing(beam, element_type, turn):
    """In space, forces and moments of a bent and twisted beam turn with it, and it stores as much."""
    x = nodes_of(element_type, bow=0.2)
    evaluate, turn = beam(element_type, UNEQUAL, x), Rotation.from_rotvec(turn)
    u = 0.4 * np.random.default_rng(3).normal(size=6 * len(x))
    force, _, energy = evaluate(u, nlgeom=True)
    other, _, other_energy = evaluate(turned_by(x, u, turn, np.array([1.0, -2.0, 3.0])), nlgeom=True)
    np.testing.assert_allclose(other, turn.apply(force.reshape(-1, 3)).ravel(), atol=1e-12 * abs(force).max())
    assert other_energy[1] == pytest.approx(energy[1], rel=1e-10)


@pytest.mark.parametrize("size", [0.01, 0.1, 0.5])
@pytest.mark.parametrize("element_type", ["B31", "B32"])
def test_large_rotations_in_space(beam, element_type, size):
    """The tangent is the derivative of the forces, these do the work that is stored, and are in equilibrium."""
    x = nodes_of(element_type, bow=0.2)
    evaluate, n = beam(element_type, UNEQUAL, x, large=True), len(x)
    u = size * np.random.default_rng(8).normal(size=6 * n)
    force, k, _ = evaluate(u, nlgeom=True)
    step = 1e-6
    pairs = [(evaluate(u + d, nlgeom=True), evaluate(u - d, nlgeom=True)) for d in step * np.eye(6 * n)]
    slopes = np.array([one[0] - other[0] for one, other in pairs]).T / (2 * step)
    np.testing.assert_allclose(k, slopes, atol=1e-6 * abs(k).max())
    # work of the moments: on spins about the global axes
    for node in range(n):
        for axis in range(6):
            ends = []
            for sign in (1, -1):
                moved = u.reshape(n, 6).copy()
                if axis < 3:
                    moved[node, axis] += sign * step
                else:
                    spin = Rotation.from_rotvec(sign * step * np.eye(3)[axis - 3])
                    moved[node, 3:] = (spin * Rotation.from_rotvec(moved[node, 3:])).as_rotvec()
                ends.append(evaluate(moved.ravel(), nlgeom=True)[2][1])
            assert force[6 * node + axis] == pytest.approx(
                (ends[0] - ends[1]) / (2 * step), abs=1e-6 * abs(force).max()
            )
    forces, moments = force.reshape(n, 2, 3).swapaxes(0, 1)
    np.testing.assert_allclose(forces.sum(axis=0), 0, atol=1e-12 * abs(force).max())
    arms = x + u.reshape(n, 6)[:, :3]
    np.testing.assert_allclose(
        moments.sum(axis=0) + np.cross(arms, forces).sum(axis=0), 0, atol=1e-11 * abs(force).max()
    )


@pytest.mark.parametrize("element_type", [*PLANE, "B31", "B32"])
def test_small_displacements_are_the_limit_of_large_ones(beam, element_type):
    evaluate = beam(element_type, UNEQUAL, nodes_of(element_type, bow=0.2))
    nothing = np.zeros(evaluate.unknowns)
    linear, tangent = evaluate(nothing)[1], evaluate(nothing, nlgeom=True)[1]
    np.testing.assert_allclose(tangent, linear, atol=1e-12 * abs(linear).max())


@pytest.mark.parametrize("element_type", SPACE)
def test_response_turns_with_the_beam(beam, element_type):
    """A beam in other directions, with its n1: the same energy and forces."""
    x = nodes_of(element_type, bow=0.2)
    axes = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    axes *= np.linalg.det(axes)
    u = 1e-3 * np.random.default_rng(3).normal(size=6 * len(x))
    force, _, energy = beam(element_type, UNEQUAL, x)(u)
    turned = replace(UNEQUAL, n1=tuple(axes @ UNEQUAL.n1))
    other, _, other_energy = beam(element_type, turned, x @ axes.T)((u.reshape(-1, 3) @ axes.T).ravel())
    np.testing.assert_allclose((force.reshape(-1, 3) @ axes.T).ravel(), other, atol=1e-10 * abs(force).max())
    assert other_energy[1] == pytest.approx(energy[1])


def frame(x, n1):
    """t, n1 and n2 of the manual: n2 = t x n1, then n1 = n2 x t."""
    t = (x[-1] - x[0]) / np.linalg.norm(x[-1] - x[0])
    n2 = np.cross(t, n1)
    n2 /= np.linalg.norm(n2)
    return t, np.cross(n2, t), n2


@pytest.mark.parametrize("element_type", SPACE)
def test_section_forces_in_space(beam, element_type):
    """Constant strains, curvatures and shear: each force is that of its strain, about the centroid."""
    x = nodes_of(element_type)
    t, n1, n2 = frame(x, RECT.n1)
    strain, second, first, about_1, about_2, twist = strains = 1e-3 * np.array([1.0, 0.6, -0.4, 0.8, -0.5, 0.7])
    length = np.linalg.norm(x[-1] - x[0])

    def along(p):
        return (p - x[0]) @ t

    def rotation(p):
        return along(p) * (twist * t + about_1 * n1 + about_2 * n2)

    def displacement(p):
        s = along(p)
        # the slope of the axis is the shear strain and the rotation of the section: rotation x t
        bent = s**2 / 2 * np.cross(about_1 * n1 + about_2 * n2, t)
        return s * (strain * t + second * n2 + first * n1) + bent

    evaluate = beam(element_type, RECT, x)
    u = motion(element_type, x, displacement, rotation)
    force, _, _ = evaluate(u)
    found = values_of(evaluate)
    a, b = RECT.dimensions
    slender = SLENDERNESS * length**2 * (1.0 if BEAM[element_type].nodes == 2 else 1e-4)
    shear = SHEAR_FACTORS["RECT"] * G * a * b
    stiffness = [
        E * a * b,
        shear / (1 + slender / b**2),
        shear / (1 + slender / a**2),
        E * a * b**3 / 12,
        E * a**3 * b / 12,
        G * rectangle_torsion(a, b),
    ]
    for name, modulus, value in zip(("1", "2", "3"), stiffness[:3], strains[:3], strict=True):
        np.testing.assert_allclose(found[f"SE{name}"], value, rtol=1e-9, err_msg=name)
        np.testing.assert_allclose(found[f"SF{name}"], modulus * value, rtol=1e-9, err_msg=name)
    for name, modulus, value in zip(("1", "2", "3"), stiffness[3:], strains[3:], strict=True):
        np.testing.assert_allclose(found[f"SK{name}"], value, rtol=1e-9, err_msg=name)
        np.testing.assert_allclose(found[f"SM{name}"], modulus * value, rtol=1e-9, err_msg=name)
    # section points 1, 5, 21, 25 are corners: 1 and 5 below (direction 2), 1 and 21 on the side of -1
    corners = np.tile([(-1, -1), (1, -1), (-1, 1), (1, 1)], (BEAM[element_type].points, 1)) * [a / 2, b / 2]
    # a positive SM1 pulls the side of direction 2, a positive SM2 that of -1
    expected = strain + corners[:, 1] * about_1 - corners[:, 0] * about_2
    np.testing.assert_allclose(found["E11"], expected, rtol=1e-9)
    np.testing.assert_allclose(found["S11"], E * expected, rtol=1e-9)
    assert evaluate.block.state(0).variables.numbers == ((1, 0), (5, 1), (21, 2), (25, 3))
    # the axial force acts at the ends
    assert force.reshape(-1, 6)[-1, :3] @ t == pytest.approx(stiffness[0] * strain)


@pytest.mark.parametrize("element_type", PLANE)
def test_section_forces_in_a_plane(beam, element_type):
    """SM1 is about n1 = -z, and positive where it pulls the left of the axis; SF2 points to the left."""
    x = nodes_of(element_type)
    t, _, n2 = frame(x, (0.0, 0.0, -1.0))
    np.testing.assert_allclose(np.cross([0, 0, 1], t), n2)
    curvature, shear = 2e-3, 1e-3

    def displacement(p):
        s = (p - x[0]) @ t
        return (shear * s - curvature * s**2 / 2) * n2

    evaluate = beam(element_type, RECT, x)
    evaluate(motion(element_type, x, displacement, lambda p: np.array([0, 0, -curvature * ((p - x[0]) @ t)])))
    found = values_of(evaluate)
    a, b = RECT.dimensions
    np.testing.assert_allclose(found["SM1"], E * a * b**3 / 12 * curvature, rtol=1e-9)
    np.testing.assert_allclose(found["SE2"], shear, rtol=1e-9)
    np.testing.assert_allclose(found["S11"], np.tile([-1, 1], BEAM[element_type].points) * E * curvature * b / 2)
    assert evaluate.block.state(0).variables.numbers == ((1, 0), (5, 1))


def test_an_unequal_section_bends_about_its_centroid(beam):
    """An axial strain of the centroid gives no moment; nodes beside it turn."""
    x = nodes_of("B21")
    t, _, _ = frame(x, (0.0, 0.0, -1.0))
    evaluate = beam("B21", UNEQUAL, x)
    strain = 1e-3
    evaluate(motion("B21", x, lambda p: strain * ((p - x[0]) @ t) * t, lambda p: np.zeros(3)))
    found = values_of(evaluate)
    np.testing.assert_allclose(found["SF1"], E * profile_of(UNEQUAL, 2).area * strain)
    np.testing.assert_allclose(found["SM1"], 0, atol=1e-12)
    np.testing.assert_allclose(found["S11"], E * strain)


@pytest.mark.parametrize("section", [RECT, UNEQUAL], ids=["RECT", "I"])
@pytest.mark.parametrize("element_type", TYPES)
def test_mass_of_rigid_motions(beam, element_type, section):
    """Translations: the mass; spin about the axis: the polar moment of inertia about the nodes."""
    x = nodes_of(element_type)
    kind, evaluate = BEAM[element_type], beam(element_type, section, x)
    mass = evaluate(np.zeros(evaluate.unknowns), request=Request.MASS)[1]
    profile = profile_of(section, kind.dimension)
    total = DENSITY * profile.area * np.linalg.norm(x[-1] - x[0])
    translation = motion(element_type, x, lambda p: np.array([0.6, 0.8, 0.0]), lambda p: np.zeros(3))
    assert translation @ mass @ translation == pytest.approx(total)
    if kind.dimension == 3:
        t, _, _ = frame(x, section.n1)
        spin = motion(element_type, x, lambda p: np.zeros(3), lambda p: t)
        polar = sum(profile.inertia[:2]) + profile.area * np.square(profile.centroid).sum()
        assert spin @ mass @ spin == pytest.approx(total / profile.area * polar)
    assert (np.count_nonzero(mass[: len(kind.dofs(0)), -3:]) == 0) == (kind.nodes == 2)


def test_isotropic_rotary_inertia():
    """The same about all directions: I11 + I22 in space, I11 in a plane; without the offset of the centroid."""
    profile = profile_of(UNEQUAL, 3)
    first, second, _ = profile.inertia
    assert (
        section_mass(profile, isotropic=True, plane=False).tolist()
        == np.diag([profile.area] * 3 + [first + second] * 3).tolist()
    )
    assert section_mass(profile, isotropic=True, plane=True)[5, 5] == first
    exact = section_mass(profile, isotropic=False, plane=False)
    assert exact[0, 4] == pytest.approx(profile.area * profile.centroid[1])


@pytest.mark.parametrize(
    ("n1", "ends", "message"),
    [
        ((0.0, 0.0, -1.0), [[0, 0, 0], [0, 0, 1]], r"element 1 \(type B31\) lies along n1 = \(0, 0, -1\); give"),
        ((1.0, 0.0, 0.0), [[1, 1, 1], [1, 1, 1]], r"element 1 \(type B31\) has no length; its nodes must follow"),
    ],
)
def test_directions_that_do_not_exist(beam, n1, ends, message):
    with pytest.raises(DeckError, match=message):
        beam("B31", replace(RECT, n1=n1), np.array(ends, dtype=float))


def test_sections_without_inertia_in_space(beam):
    general = replace(RECT, profile="GENERAL", dimensions=(1.0, 2.0, 3.0, 2.0, 1.0))
    with pytest.raises(DeckError, match=r"I11 = 2, I12 = 3, I22 = 2: beams in space need I11 I22 > I12\^2"):
        beam("B31", general, nodes_of("B31"))


def test_general_section_has_no_section_points(beam):
    """I12: a curvature about one axis gives a moment about the other."""
    general = replace(RECT, profile="GENERAL", dimensions=(1.0, 2.0, 0.5, 3.0, 1.5), n1=(0.0, 0.0, -1.0))
    x = np.array([[0.0, 0, 0], [1.0, 0, 0]])
    evaluate = beam("B31", general, x)
    t, n1, _ = frame(x, general.n1)
    evaluate(motion("B31", x, lambda p: 0.5e-3 * p[0] ** 2 * np.cross(n1, t), lambda p: 1e-3 * p[0] * n1))
    found = values_of(evaluate)
    assert "S11" not in found
    np.testing.assert_allclose([found["SM1"][0], found["SM2"][0]], [E * 2e-3, -E * 0.5e-3])
    assert evaluate.block.state(0).variables.sides == ()
