# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in shells, element by element: rigid-body motion, rank, tangent, section, directors, hourglass modes, mass."""

from dataclasses import replace

import numpy as np
import pytest
from shell_decks import values_of

from uel.elements import Request, build_blocks
from uel.elements.families.shell import directors, section_points, section_stiffness, shear_stiffness
from uel.elements.threads import known_routines
from uel.errors import DeckError, KernelError, Source
from uel.model.element_types import SHELL
from uel.model.mesh import ElementGroup, Mesh
from uel.model.model import Model
from uel.model.properties import (
    Elastic,
    ElasticType,
    Material,
    Orientation,
    Plastic,
    SectionControls,
    ShellLayer,
    ShellSection,
    UserMaterial,
)

SOURCE = Source("test.inp", 7)
E, NU, T = 1000.0, 0.3, 0.2
G = E / (2 * (1 + NU))
TYPES = tuple(SHELL)
WARPED = np.array(
    [
        *([0.0, 0, 0], [2.1, 0.2, 0.3], [1.8, 1.9, -0.2], [-0.1, 1.4, 0.25]),
        *([1.05, 0.15, 0.4], [2.0, 1.1, 0.2], [0.9, 1.7, 0.1], [-0.1, 0.8, 0.3]),
    ]
)
"""Corners, then nodes near the middles of sides."""
CORNERS = np.array([[0.0, 0, 0], [2.1, 0.2, 0], [1.8, 1.9, 0], [-0.1, 1.4, 0]])
FLAT = np.vstack([CORNERS, (CORNERS + np.roll(CORNERS, -1, axis=0)) / 2])
SPURIOUS = {"S8R": 1, "S4R": 1}
"""Modes of an element alone that cost nothing and are no rigid motions: for 48 unknowns there are 32 strains at the
integration points and 9 drilling strains. Rotations of S4R that swirl about its middle, without curvature, cost nothing
in Abaqus either (test_shell_hourglass.py); neighbours do not share them."""
STEEL = Material("M", SOURCE, Elastic(ElasticType.ISOTROPIC, (E, NU), SOURCE), density=5.0)
# E1, E2, nu12, G12, G13, G23
PLY = Material("PLY", SOURCE, Elastic(ElasticType.LAMINA, (1000.0, 50.0, 0.25, 30.0, 30.0, 20.0), SOURCE))
USER = Material("USER", SOURCE, user=UserMaterial(np.ones(1), False, SOURCE))
LAMINATE = tuple(ShellLayer(t, 3, PLY, angle) for t, angle in ((0.05, 0.0), (0.1, 45.0), (0.07, -30.0)))


ONE = (ShellLayer(T, 5, STEEL),)


def shell_section(layers=ONE, *, orientation=None, offset=0.0, gauss=False, **options):
    return ShellSection("ALL", tuple(layers), orientation, offset, gauss, SOURCE, **options)


def group_of(element_type, section, nodes=None):
    nodes = np.arange(SHELL[element_type].nodes)[None] if nodes is None else nodes
    return ElementGroup(element_type, 1 + np.arange(len(nodes)), nodes, "", section, None, SOURCE)


@pytest.fixture
def shell(response):
    """Force, tangent and energies of a shell by its unknowns, node by node."""

    def shell(element_type, section, x, nodes=None):
        x = x[: SHELL[element_type].nodes] if nodes is None else x
        return response(group_of(element_type, section, nodes), x)

    return shell


def rigid_motions(x):
    """(6, unknowns) displacements and rotations of three translations and three rotations."""
    found = []
    for axis in np.eye(3):
        found.append(np.hstack([np.tile(axis, (len(x), 1)), np.zeros((len(x), 3))]).ravel())
        found.append(np.hstack([np.cross(axis, x), np.tile(axis, (len(x), 1))]).ravel())
    return np.array(found)


@pytest.mark.parametrize("element_type", ["S3", "S4", "S8R"])
def test_tangent_with_backstresses(shell, element_type):
    """Unsymmetric, as backstresses with a recall term make it: against central differences, in a second increment."""
    plastic = Plastic(np.array([[5.0, 0.0]]), SOURCE, np.array([[400.0, 100.0]]), combined=True)
    layers = (ShellLayer(T, 5, replace(STEEL, plastic=plastic)),)
    x, random, step = FLAT[: SHELL[element_type].nodes], np.random.default_rng(3), 1e-6
    evaluate = shell(element_type, shell_section(layers), x)
    start, change = 0.05 * random.normal(size=(2, 6 * len(x)))
    evaluate(start)
    evaluate.block.commit()
    _, tangent, _ = evaluate(start + change, change)
    expected = np.empty_like(tangent)
    for k, h in enumerate(step * np.eye(len(start))):
        up, down = (evaluate(start + change + d, change + d)[0] for d in (h, -h))
        expected[:, k] = (up - down) / (2 * step)
    assert abs(tangent - tangent.T).max() > 1e-3 * abs(tangent).max()
    np.testing.assert_allclose(tangent, expected, atol=1e-6 * abs(tangent).max())


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("layers", [ONE, LAMINATE], ids=["one", "laminate"])
def test_rigid_motions_are_all_that_cost_nothing(shell, element_type, layers):
    """Six modes without energy, and the matrix is symmetric: warped elements too, with any offset."""
    x = WARPED[: SHELL[element_type].nodes]
    force, k, _ = shell(element_type, shell_section(layers, offset=0.3), x)(np.zeros(6 * len(x)))
    assert not force.any()
    np.testing.assert_allclose(k, k.T, atol=1e-12 * abs(k).max())
    np.testing.assert_allclose(k @ rigid_motions(x).T, 0, atol=1e-11 * abs(k).max())
    scale = np.sqrt(np.diag(k))
    values = np.linalg.eigvalsh(k / np.outer(scale, scale))
    assert (values < 1e-10).sum() == 6 + SPURIOUS.get(element_type, 0)


def test_membrane_mode_of_a_rectangle(shell):
    """That of plane elements (N. Bicanic, E. Hinton, Int. J. Num. Meth. Engng 14 (1979) 1545); the nodes turn too."""
    x = np.array([[2.0 * a, b, 0] for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0))])
    a, b = x[:, 0] / 2, x[:, 1]
    u = np.zeros((8, 6))
    u[:, 0], u[:, 1] = a * (1 - 3 * b**2) / 2, -b * (1 - 3 * a**2)
    u[:, 5] = 3 * a * b * (1 / 2 + 1 / 2)
    force, k, _ = shell("S8R", shell_section(), x)(u)
    np.testing.assert_allclose(force, 0, atol=1e-12 * abs(k).max())


def test_modes_of_one_element_are_none_of_two(shell):
    """Neighbours cannot share what costs nothing in a single S8R."""
    x = np.array([[i, j, 0.0] for j in (0, 0.5, 1) for i in (0, 0.5, 1, 1.5, 2) if j != 0.5 or i % 1 == 0])
    nodes = [[0, 2, 10, 8, 1, 6, 9, 5], [2, 4, 12, 10, 3, 7, 11, 6]]
    _, k, _ = shell("S8R", shell_section(), x, np.array(nodes))(np.zeros(6 * len(x)))
    scale = np.sqrt(np.diag(k))
    values = np.linalg.eigvalsh(k / np.outer(scale, scale))
    assert (values < 1e-10).sum() == 6


@pytest.mark.parametrize("element_type", TYPES)
def test_rigid_motions_with_directors_of_a_curved_surface(shell, element_type):
    """Neighbours tilt the directors of a facet."""
    count = SHELL[element_type].nodes
    x, nodes = WARPED[:count], np.arange(count)
    match count:
        case 3:
            x, other = np.vstack([x, [-1.0, -1.5, 0.4]]), [3, 1, 0]
        case 4:
            x, other = np.vstack([x, [[-1.0, -1.5, 0.4], [2.2, -1.2, 0.5]]]), [4, 5, 1, 0]
        case _:
            more = [[-1.0, -1.5, 0.4], [2.2, -1.2, 0.5], [0.6, -1.4, 0.6], [2.2, -0.5, 0.5], [-0.5, -0.8, 0.4]]
            x, other = np.vstack([x, more]), [8, 9, 1, 0, 10, 11, 4, 12]
    nodes = np.array([nodes, other])
    _, k, _ = shell(element_type, shell_section(), x, nodes)(np.zeros(6 * len(x)))
    np.testing.assert_allclose(k @ rigid_motions(x).T, 0, atol=1e-11 * abs(k).max())


def turned(x, u, axes):
    """Places and unknowns in other axes (rows)."""
    return x @ axes.T, (u.reshape(-1, 2, 3) @ axes.T).ravel()


@pytest.mark.parametrize("element_type", TYPES)
def test_response_turns_with_the_shell(shell, element_type):
    """An isotropic shell in other directions: the same energy and forces."""
    x = WARPED[: SHELL[element_type].nodes]
    u = 1e-3 * np.random.default_rng(3).normal(size=6 * len(x))
    axes = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    axes *= np.linalg.det(axes)
    force, _, energy = shell(element_type, shell_section(), x)(u)
    other_x, other_u = turned(x, u, axes)
    other, _, other_energy = shell(element_type, shell_section(), other_x)(other_u)
    np.testing.assert_allclose(turned(x, force, axes)[1], other, atol=1e-9 * abs(force).max())
    assert other_energy[1] == pytest.approx(energy[1])
    # what it stores is the work of its forces
    assert energy[1] + energy[5] == pytest.approx(0.5 * u @ force)


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("plastic", [False, True])
def test_tangent_is_the_derivative_of_the_forces(shell, element_type, plastic):
    hardening = Plastic(np.array([[1.0, 0.0], [11.0, 0.1]]), SOURCE) if plastic else None
    section = shell_section([ShellLayer(T, 5, replace(STEEL, plastic=hardening))], offset=0.2)
    x = WARPED[: SHELL[element_type].nodes]
    evaluate, step = shell(element_type, section, x), 1e-7
    u = 3e-3 * np.random.default_rng(7).normal(size=6 * len(x))
    _, k, energy = evaluate(u)
    assert (energy[3] > 1e-3 * energy[1]) == plastic
    found = np.array([evaluate(u + d)[0] - evaluate(u - d)[0] for d in step * np.eye(len(u))]).T / (2 * step)
    np.testing.assert_allclose(k, found, atol=1e-6 * abs(k).max())


def ply_stiffness(angle):
    """(3, 3) transformed reduced stiffness: R.M. Jones, Mechanics of Composite Materials, 1999, equation (2.85)."""
    e1, e2, nu12, g12 = PLY.elastic.constants[:4]
    q11, q22 = e1 / (1 - nu12**2 * e2 / e1), e2 / (1 - nu12**2 * e2 / e1)
    q12, q66 = nu12 * q22, g12
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    found = np.zeros((3, 3))
    found[0, 0] = q11 * c**4 + 2 * (q12 + 2 * q66) * s**2 * c**2 + q22 * s**4
    found[1, 1] = q11 * s**4 + 2 * (q12 + 2 * q66) * s**2 * c**2 + q22 * c**4
    found[0, 1] = (q11 + q22 - 4 * q66) * s**2 * c**2 + q12 * (s**4 + c**4)
    found[2, 2] = (q11 + q22 - 2 * q12 - 2 * q66) * s**2 * c**2 + q66 * (s**4 + c**4)
    found[0, 2] = (q11 - q12 - 2 * q66) * s * c**3 + (q12 - q22 + 2 * q66) * s**3 * c
    found[1, 2] = (q11 - q12 - 2 * q66) * s**3 * c + (q12 - q22 + 2 * q66) * s * c**3
    return np.triu(found) + np.triu(found, 1).T


def laminate_stiffness(bottom):
    """(6, 6) A, B and D of classical laminate theory: Jones, equations (4.24) to (4.26)."""
    a, b, d = np.zeros((3, 3, 3))
    for layer in LAMINATE:
        top, q = bottom + layer.thickness, ply_stiffness(layer.angle)
        a, b, d = a + q * (top - bottom), b + q * (top**2 - bottom**2) / 2, d + q * (top**3 - bottom**3) / 3
        bottom = top
    return np.block([[a, b], [b, d]])


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("offset", [0.0, -0.5])
@pytest.mark.parametrize("gauss", [False, True])
def test_laminate(shell, element_type, offset, gauss):
    """Constant strains and curvatures give the forces and moments of classical laminate theory, at each point."""
    section = shell_section(LAMINATE, offset=offset, gauss=gauss)
    x = FLAT[: SHELL[element_type].nodes]
    strains = 1e-3 * np.array([1.0, -0.4, 0.7, 2.0, -1.5, 0.8])
    e, k = ((np.array([[a, c / 2], [c / 2, b]])) for a, b, c in strains.reshape(2, 3))
    u = np.zeros((len(x), 6))
    u[:, :2] = x[:, :2] @ e
    # w = -1/2 x.k.x, with rotations that leave no shear: k11 is the slope of the rotation about 2
    u[:, 2] = -0.5 * np.einsum("ni,ij,nj->n", x[:, :2], k, x[:, :2])
    slope = x[:, :2] @ k
    u[:, 3], u[:, 4] = -slope[:, 1], slope[:, 0]
    evaluate = shell(element_type, section, x)
    evaluate(u)
    expected = laminate_stiffness(-(0.5 + offset) * section.thickness) @ strains
    found = values_of(evaluate, "SF1", "SF2", "SF3", "SM1", "SM2", "SM3")
    np.testing.assert_allclose(found, np.tile(expected, (len(found), 1)), rtol=1e-9)


def test_section_stiffness_is_that_of_laminate_theory():
    section = shell_section(LAMINATE, offset=0.1)
    bottom = -0.6 * section.thickness
    np.testing.assert_allclose(
        section_stiffness(section, section_points(section)), laminate_stiffness(bottom), rtol=1e-12, atol=1e-9
    )


@pytest.mark.parametrize("offset", [0.0, 0.5])
def test_shear_stiffness_of_one_material(offset):
    """5/6 G t: the shear stress is a parabola."""
    k11, k22, k12 = shear_stiffness(
        section := shell_section(offset=offset), section_stiffness(section, section_points(section))
    )
    np.testing.assert_allclose([k11, k22], 5 / 6 * G * T, rtol=1e-12)
    assert abs(k12) < 1e-10 * k11


def test_shear_stiffness_of_a_sandwich():
    """Q S(z)/(I b): the stress in equilibrium with bending, from quadrature of its own on a fine grid."""
    soft = Material("SOFT", SOURCE, Elastic(ElasticType.ISOTROPIC, (1.0, 0.0), SOURCE))
    hard = Material("HARD", SOURCE, Elastic(ElasticType.ISOTROPIC, (100.0, 0.0), SOURCE))
    section = shell_section([ShellLayer(t, 3, m) for t, m in ((0.1, hard), (0.8, soft), (0.1, hard))])
    z = (np.arange(100_000) + 0.5) / 100_000 - 0.5
    young = np.where(abs(z) > 0.4, 100.0, 1.0)
    stiffness = (young * z**2).mean()
    stress = -np.cumsum(young * z) / len(z) / stiffness
    expected = 1 / (stress**2 / (young / 2)).mean()
    k11, k22, k12 = shear_stiffness(section, section_stiffness(section, section_points(section)))
    # the sum is off by half a cell
    np.testing.assert_allclose([k11, k22, k12], [expected, expected, 0], rtol=1e-4, atol=1e-10)


def area_of(x):
    """Of a polygon in the plane, by its corners and the middles of its sides, if there are any."""
    px, py = x[: min(len(x), 4), :2].T
    return 0.5 * (px @ np.roll(py, -1) - py @ np.roll(px, -1))


@pytest.mark.parametrize("element_type", ["S4", "S3", "S8R"])
def test_transverse_shear_with_its_slenderness_factor(shell, element_type):
    """Uniform shear strain 13: the force is K/(1 + q A/t^2)."""
    x = FLAT[: SHELL[element_type].nodes]
    section = shell_section(shear=(7.0, 5.0, 1.0), slenderness=0.01)
    u = np.zeros((len(x), 6))
    u[:, 2] = 1e-3 * x[:, 0]
    evaluate = shell(element_type, section, x)
    evaluate(u)
    values = values_of(evaluate, "SF4", "SF5")
    area = area_of(x)
    expected = 1e-3 * np.array([7.0, 1.0]) / (1 + 0.01 * area / T**2)
    np.testing.assert_allclose(values, np.tile(expected, (len(values), 1)), rtol=1e-9)


def test_one_point_with_enhanced_control_has_the_stiffness_of_four(shell):
    """Hourglass modes of S4R are elastic then, as those of S4: elastic shells are the same but for drilling.

    S4 resists drilling at its four points.
    """
    for layers in (ONE, LAMINATE):
        section = shell_section(layers, offset=0.2, controls=SectionControls(enhanced=True), drilling=0.0)
        one, four = (shell(name, section, FLAT)(np.zeros(24))[1] for name in ("S4R", "S4"))
        size = abs(four).max()
        out_of_plane = np.flatnonzero(np.isin(np.arange(24) % 6, [2, 3, 4]))
        difference = four - one
        np.testing.assert_allclose(difference[out_of_plane], 0, atol=1e-10 * size)
        values = np.linalg.eigvalsh(difference)
        assert values[0] > -1e-10 * size
        assert (values > 1e-10 * size).sum() == 4
        assert values[-1] < 1e-2 * size


def test_hourglass_stiffness_of_the_deck(shell):
    """r_F G, r_theta G and a factor of the drilling stiffness; factors of *SECTION CONTROLS scale the defaults."""
    nothing = replace(STEEL, elastic=Elastic(ElasticType.ISOTROPIC, (2.0, 0.0), SOURCE))
    layers = [ShellLayer(T, 5, nothing)]
    ways = (
        shell_section(layers),
        shell_section(layers, hourglass=0.005, hourglass_rotation=0.00375),
        shell_section(layers, controls=SectionControls(hourglass=3.0, hourglass_rotation=2.0)),
        shell_section(layers, hourglass=0.015, hourglass_rotation=0.0075),
        shell_section(layers, drilling=2.0),
    )
    default, same, scaled, other, drilled = (shell("S4R", way, FLAT)(np.zeros(24))[1] for way in ways)
    np.testing.assert_allclose(default, same, atol=1e-12)
    np.testing.assert_allclose(scaled, other, atol=1e-12)
    assert np.linalg.norm(scaled - default) > 1e-3 * np.linalg.norm(default)
    assert np.linalg.matrix_rank(drilled - default, tol=1e-9) == 4


def test_in_plane_bending_of_a_rectangle(shell):
    """Exact, as beam theory: u = x y, v = -x^2/2 - nu y^2/2 stores E/2 t times the integral of y^2."""
    x = np.array([[-2.0, -0.5, 0], [2, -0.5, 0], [2, 0.5, 0], [-2, 0.5, 0]])
    u = np.zeros((4, 6))
    u[:, 0], u[:, 1], u[:, 5] = x[:, 0] * x[:, 1], -(x[:, 0] ** 2 + NU * x[:, 1] ** 2) / 2, -x[:, 0]
    *_, energy = shell("S4", shell_section(), x)(1e-3 * u)
    assert energy[1] == pytest.approx(1e-6 * E * T / 2 * 4 / 12)


@pytest.mark.parametrize("element_type", TYPES)
def test_mass(shell, element_type):
    """Density times volume in each direction; rotary inertia of the thickness about the nodes' surface."""
    x = FLAT[: SHELL[element_type].nodes]
    _, mass, _ = shell(element_type, shell_section(offset=0.5), x)(np.zeros(6 * len(x)), request=Request.MASS)
    found = mass.reshape(len(x), 6, len(x), 6).sum(axis=(0, 2))
    whole = 5.0 * T * area_of(x)
    expected = np.diag([whole] * 3 + [whole * (T**2 / 12 + T**2 / 4)] * 3)
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-14)
    if element_type == "S8R":
        # the moment of inertia is that of the area: its corners alone would have a negative mass
        u = np.zeros((len(x), 6))
        u[:, 2] = x[:, 0]
        px, py = CORNERS[:, 0], CORNERS[:, 1]
        cross = px * np.roll(py, -1) - np.roll(px, -1) * py
        second = (cross * (px**2 + px * np.roll(px, -1) + np.roll(px, -1) ** 2)).sum() / 12
        assert u.ravel() @ mass @ u.ravel() == pytest.approx(5.0 * T * second)
    else:
        assert not (mass - np.diag(np.diag(mass))).any()


def test_directors_are_means_within_20_degrees():
    """Three facets around an edge: the second is tilted by 10 degrees, the third by 90."""
    c, s = np.cos(np.radians(10)), np.sin(np.radians(10))
    x = np.array([[0, 0, 0], [0, 1, 0], [-1, 1, 0], [-1, 0, 0], [c, 1, s], [c, 0, s], [0, 0, -1], [0, 1, -1.0]])
    nodes = np.array([[0, 1, 2, 3], [5, 4, 1, 0], [0, 6, 7, 1]])
    group = group_of("S4", shell_section(), nodes)
    mesh = Mesh(np.arange(1, 9), x, ("",) * 8)
    found = directors(Model("test.inp", "", mesh, (group,), ()), group)
    half = [-np.sin(np.radians(5)), 0, np.cos(np.radians(5))]
    np.testing.assert_allclose(found[0], [half, half, [0, 0, 1], [0, 0, 1]], atol=1e-12)
    np.testing.assert_allclose(found[1], [[-s, 0, c], [-s, 0, c], half, half], atol=1e-12)
    np.testing.assert_allclose(found[2], np.tile([1, 0, 0], (4, 1)), atol=1e-12)


def test_normals_of_the_deck_are_directors(load):
    """They take the place of means in all elements at a node; far ones get a warning, opposite ones an error."""
    nodes = np.array([[0, 1, 2, 3]])
    group = group_of("S4", shell_section(), nodes)
    normals = np.zeros((4, 3))
    normals[1] = [0.0, 0.6, 1.8]
    mesh = Mesh(np.arange(1, 5), CORNERS, ("",) * 4, normals)
    model = Model("test.inp", "", mesh, (group,), ())
    unit = np.array([0.0, 0.6, 1.8]) / np.hypot(0.6, 1.8)
    np.testing.assert_allclose(directors(model, group)[0], [[0, 0, 1], unit, [0, 0, 1], [0, 0, 1]], atol=1e-15)
    library = load(None)
    build_blocks(model, library)
    assert not library.messages()
    normals[1:3] = [0.0, 1.0, 1.0]
    build_blocks(model, library)
    (warning,) = [message.text for message in library.messages()]
    message = "test.inp:7: the normal of node 2 is 45 degrees from that of element 1 (type S4), and 1 more"
    assert message in warning
    normals[3] = [0.1, 0.0, -1.0]
    message = r"test.inp:7: the normal of node 4 is 174 degrees from that of element 1 \(type S4\); Abaqus would turn"
    with pytest.raises(DeckError, match=message):
        build_blocks(model, library)


@pytest.mark.parametrize(("axis", "first"), [(3, 0), (1, 1), (2, 2)])
def test_orientation_projects_the_axis_after_the_one_along_the_normal(shell, axis, first):
    """A lamina pulled along its fibres: axis `first` (from 0) of the orientation, whose axis `axis` is the normal."""
    c, s = np.cos(0.7), np.sin(0.7)
    fibre = np.array([c, s, 0])
    axes = np.zeros((3, 3))
    axes[axis - 1], axes[first] = [0, 0, 1], fibre
    axes[(first + 1) % 3] = np.cross([0, 0, 1], fibre)
    section = shell_section([ShellLayer(T, 3, PLY)], orientation=Orientation("O", axes, SOURCE, normal=axis))
    u = np.zeros((4, 6))
    u[:, :2] = 1e-3 * np.outer(CORNERS @ fibre, fibre)[:, :2]
    evaluate = shell("S4", section, FLAT)
    evaluate(u)
    strains = 1e-3 * np.array([1.0, 0, 0])
    found = values_of(evaluate, "E11", "E22", "E12", "S11", "S22", "S12")
    expected = np.concatenate([strains, ply_stiffness(0) @ strains])
    np.testing.assert_allclose(found, np.tile(expected, (len(found), 1)), rtol=1e-9, atol=1e-13)


def test_orientation_along_the_normal(shell):
    section = shell_section(orientation=Orientation("O", np.eye(3)[[2, 0, 1]], SOURCE, normal=3))
    message = r"element 1 \(type S4\): .*the axis that is projected is normal to the shell at integration point 1"
    with pytest.raises(KernelError, match=message):
        shell("S4", section, FLAT)(np.zeros(24))


@pytest.mark.parametrize(
    "x", [np.zeros((4, 3)), FLAT[[0, 2, 1, 3]], np.outer([0, 1, 2, 3], [1.0, 1, 0])], ids=["point", "crossed", "line"]
)
def test_shape_without_area(shell, x):
    message = r"element 1 \(type S4\): .*the shell has no area or is folded at its integration point \d"
    with pytest.raises(KernelError, match=message):
        shell("S4", shell_section(), x)(np.zeros(24))


@pytest.mark.parametrize(("layers", "called"), [(ONE, []), (LAMINATE, []), ((*ONE, ShellLayer(T, 3, USER)), ["UMAT"])])
def test_threads_know_the_routines_of_all_layers(layers, called):
    group = group_of("S4", shell_section(layers, shear=(1.0, 1.0, 0.0)))
    mesh = Mesh(np.arange(1, 5), FLAT, ("",) * 4)
    assert known_routines(Model("test.inp", "", mesh, (group,), ())) == called


def test_plastic_bending(shell, solid_group, bound, load, call):
    """Each section point has the stress of CPS4 at its strain, and the moment is the sum over them."""
    elastic, plastic = STEEL.elastic, Plastic(np.array([[4.0, 0.0], [5.0, 0.1]]), SOURCE)
    section = shell_section([ShellLayer(T, 5, replace(STEEL, plastic=plastic))])
    x = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    curvature = 3 * 4.0 / E / (T / 2)
    u = np.zeros((4, 6))
    u[:, 2], u[:, 4] = -curvature * x[:, 0] ** 2 / 2, curvature * x[:, 0]
    evaluate = shell("S4R", section, x)
    *_, energy = evaluate(u)
    stress, moment = values_of(evaluate, "S11", "SM1").T
    points, expected = section_points(section), []
    for place in points.place:
        group = solid_group("CPS4", np.arange(4)[None], 1.0, elastic=elastic, plastic=plastic)
        block, matrix = bound(group, x, load(None))
        moved = np.column_stack([curvature * place * x[:, 0], np.zeros(4)]).ravel()
        block.evaluate(call, moved, moved, np.zeros(8), matrix.data)
        block.commit()
        state = block.state(0)
        expected.append(state.svars[0, list(state.variables.names).index("S11")])
    np.testing.assert_allclose(stress, expected, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(moment, (points.weight * points.place * expected).sum(), rtol=1e-9)
    assert energy[3] > 0.5 * energy[1]
