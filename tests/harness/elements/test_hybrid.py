# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Hybrid elements: their pressure as an unknown, closed forms of incompressible bodies, refusals.

With other materials, whose pressure is eliminated, they are among the types of the tests of all continuum elements.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hybrid_bodies import INNER, OUTER, cube, cylinder, radial
from moving_element import turn
from reference_cells import affine, patch_of
from scipy.integrate import quad
from small_decks import body_lines

from uel.assembly import DofMap
from uel.elements import Flags, build_blocks
from uel.errors import DeckError, SingularMatrixError, Source
from uel.model.dofs import PRESSURE
from uel.model.element_types import CONTINUUM, HYBRID
from uel.model.mesh import ElementGroup, Mesh
from uel.model.model import Model
from uel.model.properties import (
    CreepLaw,
    Elastic,
    ElasticType,
    HybridFormulation,
    Hyperelastic,
    Material,
    Network,
    Plastic,
    Potential,
    SolidSection,
    UserMaterial,
)

HERE = Path(__file__).parent
SOURCE = Source("test.inp", 1)
YOUNG = 3.0
FIXED = {name: kind for name, kind in HYBRID.items() if not kind.hourglass_control}


def rubber(potential, *coefficients, order=1, compliances=(0.0,)):
    law = Hyperelastic(potential, order, coefficients, compliances, SOURCE)
    return Material("M", SOURCE, hyperelastic=law)


ELASTIC = Material("M", SOURCE, Elastic(ElasticType.ISOTROPIC, (YOUNG, 0.5), SOURCE))
MOONEY = rubber(Potential.MOONEY_RIVLIN, 0.5, 0.2)
SOFT = rubber(Potential.MOONEY_RIVLIN, 0.5, 0.2, compliances=(0.4,))
QUARTIC = rubber(Potential.POLYNOMIAL, 0.5, 0.2, 0.03, 0.02, 0.01, order=2, compliances=(0.4, 0.7))
CHAINS = rubber(Potential.ARRUDA_BOYCE, 0.9, 2.3, compliances=(0.4,))
MATERIALS = {"elastic": ELASTIC, "mooney": MOONEY, "soft": SOFT, "quartic": QUARTIC, "chains": CHAINS}


class Element:
    """One element: displacements of its nodes, then its pressures."""

    def __init__(self, element_type, material, library, call, *, nlgeom=True):
        self.kind = HYBRID[element_type]
        nodes, _ = affine(self.kind.family.cell)
        if self.kind.axisymmetric:
            nodes = nodes + np.array([2.0, 0])
        self.nodes = nodes
        options = {"hourglass": 0.01} if self.kind.hourglass_control else {}
        section = SolidSection("ALL", material, None, 1.5, SOURCE, **options)
        count = np.arange(len(nodes))
        group = ElementGroup(element_type, np.array([7]), count[None], "", section, None, SOURCE)
        places = np.pad(nodes, ((0, 0), (0, 3 - nodes.shape[1])))
        self.mesh = Mesh(count + 1, places, ("",) * len(nodes))
        model = Model(Path("test.inp"), "", self.mesh, (group,), ())
        (self.block,) = build_blocks(model, library)
        n = len(self.block.unknowns)
        self.block.bind(np.arange(n, dtype=np.int32)[None], np.arange(n * n, dtype=np.int32).reshape(1, n, n))
        self.call = replace(call, flags=Flags(1, nlgeom))
        self.size, self.of_nodes = n, nodes.size

    def evaluate(self, u, before=None):
        residual, matrix = np.zeros(self.size), np.zeros(self.size**2)
        report = self.block.evaluate(self.call, u, u if before is None else u - before, residual, matrix)
        return -residual, matrix.reshape(self.size, self.size), report

    def moved(self, f):
        """Unknowns of x = F X without a pressure."""
        d = self.nodes.shape[1]
        u = np.zeros(self.size)
        u[: self.of_nodes] = (self.nodes @ (np.asarray(f)[:d, :d] - np.eye(d)).T).ravel()
        return u

    @property
    def stress(self):
        """(points, components)."""
        state = self.block.state(0)
        values = state.svars.reshape(self.kind.points, -1)
        return values[:, values.shape[1] // 2 :]


@pytest.fixture
def element(load, call):
    def element(element_type, material, *, user=None, **options):
        return Element(element_type, material, load(user), call, **options)

    return element


def test_pressures_of_the_element_library():
    """Abaqus Elements Guide: constant in first-order elements and C3D10H, linear in the others of second order."""
    found = {name: kind.pressures for name, kind in HYBRID.items()}
    assert {name for name, count in found.items() if count == 1} == {
        *("CPE3H", "CPE4H", "CPE4RH", "CAX3H", "CAX4H", "CAX4RH"),
        # linear in Abaqus, which does not publish how
        "C3D4H",
        *("C3D6H", "C3D8H", "C3D8RH", "C3D10H"),
    }
    assert {name for name, count in found.items() if count == 3} == {
        *("CPE6H", "CPE8H", "CPE8RH", "CAX6H", "CAX8H", "CAX8RH"),
    }
    assert {name for name, count in found.items() if count == 4} == {"C3D15H", "C3D20H", "C3D20RH"}


@pytest.mark.parametrize("name", ["mooney", "soft"])
@pytest.mark.parametrize("element_type", HYBRID)
def test_matrix_is_the_derivative_of_the_residual(element, element_type, name):
    """Of displacements and pressures, in random ones; it is symmetric."""
    solid = element(element_type, MATERIALS[name])
    random = np.random.default_rng(3)
    # elements of one point leave out how hourglass modes change their mean strain: a uniform deformation has none
    u = solid.moved(np.eye(3) + 0.2 * random.standard_normal((3, 3)))
    if element_type in FIXED:
        u += 0.05 * random.standard_normal(u.size)
    if solid.kind.axisymmetric and element_type not in FIXED:
        u = solid.moved(np.diag([1.2, 0.9, 1.0]))
        u[: solid.of_nodes : 2] = 0.2 * solid.nodes[:, 0]
    u[solid.of_nodes :] = 0.3 * random.standard_normal(solid.size - solid.of_nodes)
    _, matrix, _ = solid.evaluate(u)
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-12 * abs(matrix).max())
    step = 1e-6
    for d in random.standard_normal((4, u.size)):
        slope = (solid.evaluate(u + step * d)[0] - solid.evaluate(u - step * d)[0]) / (2 * step)
        np.testing.assert_allclose(slope, matrix @ d, atol=2e-7 * abs(matrix).max())


@pytest.mark.parametrize("compliance", [0.0, 0.4])
@pytest.mark.parametrize("element_type", ["CPE4H", "CAX8H", "C3D8H", "C3D10H"])
def test_matrix_with_networks(element, element_type, compliance):
    """In an increment after another, in which they have flowed."""
    laws = CreepLaw.HYPERBOLIC, CreepLaw.BERGSTROM_BOYCE
    constants = (0.3, 2.0, 1.2), (0.5, 2.0, -0.7, 0.05)
    networks = tuple(Network(0.3, law, of, SOURCE) for law, of in zip(laws, constants, strict=True))
    soft = rubber(Potential.NEO_HOOKE, 0.7, compliances=(compliance,))
    solid = element(element_type, replace(soft, networks=networks))
    solid.call = replace(solid.call, flags=Flags(21, nlgeom=True))
    random = np.random.default_rng(3)
    before = 0.05 * random.standard_normal(solid.size)
    solid.evaluate(before)
    solid.block.commit()
    u = before + 0.05 * random.standard_normal(solid.size)
    _, matrix, _ = solid.evaluate(u, before)
    for d in random.standard_normal((3, u.size)):
        slope = (solid.evaluate(u + 1e-6 * d, before)[0] - solid.evaluate(u - 1e-6 * d, before)[0]) / 2e-6
        np.testing.assert_allclose(slope, matrix @ d, atol=2e-7 * abs(matrix).max())


@pytest.mark.parametrize("name", ["quartic", "chains", "elastic"])
def test_matrix_of_other_materials(element, name):
    """U with a fourth power and with a logarithm; in small displacements linear elasticity."""
    solid = element("C3D20RH", MATERIALS[name], nlgeom=name != "elastic")
    random = np.random.default_rng(4)
    u = 0.05 * random.standard_normal(solid.size)
    _, matrix, _ = solid.evaluate(u)
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-12 * abs(matrix).max())
    for d in random.standard_normal((4, u.size)):
        slope = (solid.evaluate(u + 1e-6 * d)[0] - solid.evaluate(u - 1e-6 * d)[0]) / 2e-6
        np.testing.assert_allclose(slope, matrix @ d, atol=2e-7 * abs(matrix).max())


@pytest.mark.parametrize("name", ["mooney", "soft", "elastic"])
@pytest.mark.parametrize("element_type", HYBRID)
def test_rotation(element, element_type, name):
    """No forces, no stresses and no change of volume in a rotation, which in a step of one increment is a large one."""
    solid = element(element_type, MATERIALS[name])
    if solid.kind.axisymmetric:
        # a translation along the axis
        u = np.zeros(solid.size)
        u[1 : solid.of_nodes : 2] = 2.0
    else:
        u = solid.moved(turn(0.9))
    forces, _, report = solid.evaluate(u)
    np.testing.assert_allclose(forces, 0, atol=1e-13)
    assert report.energy[1] == pytest.approx(0, abs=1e-14)


@pytest.mark.parametrize("element_type", HYBRID)
def test_pressure_alone(element, element_type):
    """Its stress is S11 = S22 = S33; forces are the pressure times the derivatives of the volume, as K says."""
    solid = element(element_type, ELASTIC, nlgeom=False)
    u = np.zeros(solid.size)
    u[solid.of_nodes] = 2.0
    forces, matrix, _ = solid.evaluate(u)
    solid.block.commit()
    stress = solid.stress
    np.testing.assert_allclose(stress[:, 3:], 0, atol=1e-14)
    np.testing.assert_allclose(stress[:, :3], stress[0, 0])
    np.testing.assert_allclose(forces[: solid.of_nodes], matrix[: solid.of_nodes, solid.of_nodes] * 2.0, atol=1e-14)
    # of an expansion, the mean volume strain is the trace: of the axes of the element, and around its axis
    directions = solid.nodes.shape[1] + solid.kind.axisymmetric
    expansion = np.pad(solid.nodes.ravel(), (0, solid.size - solid.of_nodes))
    assert (matrix @ expansion)[solid.of_nodes] == pytest.approx(directions, rel=1e-12)


@pytest.mark.parametrize("nu", [0.3, 0.4999, 0.5])
@pytest.mark.parametrize(
    ("element_type", "error"), [("CAX4H", 3e-3), ("CAX4RH", 3e-3), ("CAX8H", 3e-5), ("CAX8RH", 3e-5)]
)
def test_thick_cylinder(run_deck, element_type, error, nu):
    """Lame: u = (1 + nu) p a^2/(E (b^2 - a^2)) ((1 - 2 nu) r + b^2/r); incompressible as well as compressible.

    (S.P. Timoshenko, J.N. Goodier, Theory of Elasticity, section 28, in plane strain.) The error is that of eight
    elements: a quarter of it with twice as many in first order.
    """
    lines, nodes = cylinder(element_type, f"*ELASTIC\n{YOUNG}, {nu}", load=["*DLOAD", "FIRST, P4, 0.1"])
    result = run_deck(lines)
    r = nodes[:, 0]
    expected = (1 + nu) * 0.1 * INNER**2 / (YOUNG * (OUTER**2 - INNER**2)) * ((1 - 2 * nu) * r + OUTER**2 / r)
    np.testing.assert_allclose(radial(result.history, nodes, "U"), expected, rtol=error)
    assert [row.iterations for row in result.status] == [1]


def test_inflated_cylinder(run_deck):
    """neo-Hooke of any large strain: p = mu integral of (l^2 - l^-2)/r dr, l = r/R, r^2 = R^2 + c.

    (R.W. Ogden, Non-linear Elastic Deformations, 1984, section 5.3.) The inside moves to twice its radius.
    """
    mu, stretch = 1.4, 2.0
    load = ["*BOUNDARY", f"INSIDE, 1, 1, {(stretch - 1) * INNER}"]
    material = f"*HYPERELASTIC, NEO HOOKE\n{mu / 2}, 0."
    lines, nodes = cylinder("CAX8H", material, step="*STEP, NLGEOM", static="*STATIC\n0.25, 1., 1e-4, 0.25", load=load)
    result = run_deck(lines)
    r = nodes[:, 0]
    change = (stretch**2 - 1) * INNER**2
    now = np.sqrt(r**2 + change)
    np.testing.assert_allclose(r + radial(result.history, nodes, "U"), now, rtol=1e-5)

    def slope(at):
        squared = at**2 / (at**2 - change)
        return mu * (squared - 1 / squared) / at

    pressure, _ = quad(slope, now.min(), now.max())
    # reactions of the whole circumference, over the inside of the moved slice
    force = radial(result.history, nodes, "RF").sum()
    assert force / (2 * np.pi * now.min() * 0.2) == pytest.approx(pressure, rel=2e-3)


LAWS = {
    "NEO HOOKE": ("0.7, 0.", lambda i1, i2: (0.7, 0.0)),
    "MOONEY-RIVLIN": ("0.5, 0.2, 0.", lambda i1, i2: (0.5, 0.2)),
    "YEOH": ("0.6, -0.02, 0.003, 0., 0., 0.", lambda i1, i2: (0.6 - 0.04 * (i1 - 3) + 0.009 * (i1 - 3) ** 2, 0.0)),
}


@pytest.mark.parametrize("element_type", ["C3D8H", "C3D8RH"])
@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("stretches", [(0.5,), (2.0,), (1.5, 1.5), (1.6, 0.8)])
def test_incompressible_cube(run_deck, element_type, name, stretches):
    """S11 = 2 (l1^2 - l3^2) (W1 + l2^2 W2), and so for S22, with S33 = 0.

    (R.S. Rivlin, Philosophical Transactions A 241 (1948) 379.)
    """
    values, slopes = LAWS[name]
    result = run_deck(cube(element_type, f"*HYPERELASTIC, {name}\n{values}", stretches))
    a = stretches[0]
    b = stretches[1] if len(stretches) > 1 else a**-0.5
    c = 1 / (a * b)
    first, second = slopes(a**2 + b**2 + c**2, a**-2 + b**-2 + c**-2)
    expected = [2 * (a**2 - c**2) * (first + b**2 * second), 2 * (b**2 - c**2) * (first + a**2 * second), 0.0]
    found = [result.field(f"S{k}{k}")[0] for k in (1, 2, 3)]
    np.testing.assert_allclose(found, expected, atol=1e-7)
    assert result.history["U3[ALL:7]"][-1] == pytest.approx(c - 1, abs=1e-7)


def test_compressible_cube_is_that_of_the_ordinary_element(run_deck):
    """Homogeneous: two elements with the same energy."""
    keyword = "*HYPERELASTIC, MOONEY-RIVLIN\n0.5, 0.2, 0.3"
    hybrid, ordinary = (run_deck(cube(name, keyword, (1.7,))) for name in ("C3D8H", "C3D8"))
    for component in ("S11", "S22"):
        np.testing.assert_allclose(hybrid.field(component), ordinary.field(component), atol=1e-7)


def test_uhyper_of_an_incompressible_material(run_deck):
    """INCMPFLAG is 1, and the result that of the built-in potential; terms of J do not count."""
    user = "*HYPERELASTIC, USER, PROPERTIES=5\n0.5, 0.2, 0.4, 0., 0."
    more = ["*DEPVAR\n9"]
    lines = cube("C3D8H", user, (1.7,), more=more)
    lines[lines.index("S")] = "S, SDV"
    by_user = run_deck(lines, HERE / "potential.f90")
    assert by_user.field("SDV4")[0] == 1
    built_in = run_deck(cube("C3D8H", "*HYPERELASTIC, MOONEY-RIVLIN\n0.5, 0.2, 0.", (1.7,)))
    np.testing.assert_allclose(by_user.field("S11"), built_in.field("S11"), rtol=1e-7)


@pytest.mark.parametrize("element_type", ["C3D8H", "C3D20RH", "C3D10H", "CPE4H", "CPE8RH"])
def test_patch_of_an_incompressible_material(run_deck, element_type):
    """Distorted elements under an isochoric linear displacement of their outer nodes.

    One side carries no load, so that S22 = 0 there and everywhere: that is what sets the pressure.
    """
    kind = HYBRID[element_type]
    nodes, elements = patch_of(kind.family.cell)
    d = kind.dimension
    strain = np.diag([2e-3, -2e-3, 0.0][:d]) if d == 2 else np.diag([2e-3, -1e-3, -1e-3])
    low, high = nodes.min(axis=0), nodes.max(axis=0)
    lines = body_lines(element_type, nodes, elements)
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "1.", "*MATERIAL, NAME=M", f"*ELASTIC\n{YOUNG}, 0.5"]
    lines += ["*STEP", "*STATIC", "1., 1.", "*BOUNDARY"]
    free = 1
    for number, x in enumerate(nodes, start=1):
        for k in range(d):
            on_side = np.isclose(x[k], low[k]) or (k != free and np.isclose(x[k], high[k]))
            if on_side:
                lines.append(f"{number}, {k + 1}, {k + 1}, {strain[k, k] * x[k]}")
    lines += ["*OUTPUT, FIELD", "*ELEMENT OUTPUT", "S, E", "*END STEP"]
    result = run_deck(lines)
    shear = YOUNG / 3
    full = np.zeros(3)
    full[:d] = np.diag(strain)
    expected = 2 * shear * (full - full[free])
    for k in range(3):
        np.testing.assert_allclose(result.field(f"S{k + 1}{k + 1}"), expected[k], atol=1e-11)


@pytest.mark.parametrize(("element_type", "ordinary"), [("C3D8H", "C3D8"), ("CAX4H", "CAX4"), ("C3D4H", "C3D4")])
def test_eliminated_constant_pressure_is_the_mean_volume_strain(forces_of, element_type, ordinary):
    """In first order Abaqus' ordinary elements have it too: the same matrix.

    But in plane strain, where those put the difference of the volume strains into two directions, not three.
    """
    nodes, _ = affine(CONTINUUM[ordinary].family.cell)
    nodes = np.pad(nodes + 2.0, ((0, 0), (0, 3 - nodes.shape[1])))
    u = 1e-3 * np.random.default_rng(2).standard_normal(nodes.shape)
    forces, matrix, _ = forces_of(element_type, nodes, nu=0.49)(u)
    wanted, expected, _ = forces_of(ordinary, nodes, nu=0.49)(u)
    np.testing.assert_allclose(matrix, expected, atol=1e-12 * abs(expected).max())
    np.testing.assert_allclose(forces, wanted, atol=1e-12 * abs(wanted).max())


@pytest.mark.parametrize("element_type", ["CPE4H", "CPE8H", "C3D20H", "CAX8H", "C3D10H"])
def test_eliminated_pressure_is_that_of_the_unknown_one(element, forces_of, element_type):
    """Elasticity with nu < 1/2: the matrix of nu = 1/2 with the compliance of the volume, its pressures eliminated."""
    nu = 0.49
    bulk, shear = YOUNG / (3 * (1 - 2 * nu)), YOUNG / (2 * (1 + nu))
    stiff = Material("M", SOURCE, Elastic(ElasticType.ISOTROPIC, (3 * shear, 0.5), SOURCE))
    solid = element(element_type, stiff, nlgeom=False)
    n = solid.of_nodes
    _, matrix, _ = solid.evaluate(np.zeros(solid.size))
    # the mean of the products of the functions is found from a hyperelastic element, whose compliance D/2 is 1/bulk
    law = rubber(Potential.NEO_HOOKE, shear / 2, compliances=(2 / bulk,))
    _, other, _ = element(element_type, law).evaluate(np.zeros(solid.size))
    expected = matrix[:n, :n] - matrix[:n, n:] @ np.linalg.solve(other[n:, n:], matrix[n:, :n])
    nodes = np.pad(solid.nodes, ((0, 0), (0, 3 - solid.nodes.shape[1])))
    _, found, _ = forces_of(element_type, nodes, young=YOUNG, nu=nu)(np.zeros_like(nodes))
    thickness = 1.5 if solid.kind.dimension == 2 and not solid.kind.axisymmetric else 1.0
    np.testing.assert_allclose(thickness * found, expected, atol=1e-11 * abs(expected).max())


def by_umat(formulation, compliance):
    constants = UserMaterial(np.array([0.7, compliance, float(formulation)]), False, SOURCE, formulation)
    return Material("M", SOURCE, user=constants)


@pytest.mark.parametrize("formulation", HybridFormulation)
@pytest.mark.parametrize("element_type", ["C3D8H", "C3D20RH", "CPE4H", "CAX8H"])
def test_tangent_with_umat(element, element_type, formulation):
    """It is the derivative of the forces in each formulation; with a pressure that is eliminated too."""
    solid = element(element_type, by_umat(formulation, 0.05), user="hybrid.f")
    random = np.random.default_rng(6)
    u = 0.05 * random.standard_normal(solid.size)
    _, matrix, _ = solid.evaluate(u)
    assert (solid.size > solid.of_nodes) == (formulation is HybridFormulation.INCOMPRESSIBLE)
    for d in random.standard_normal((4, u.size)):
        slope = (solid.evaluate(u + 1e-6 * d)[0] - solid.evaluate(u - 1e-6 * d)[0]) / 2e-6
        np.testing.assert_allclose(slope, matrix @ d, atol=2e-7 * abs(matrix).max())


def coupled_moduli(skew):
    """DDSDDE that couples volume and shape, (6, 6), with a positive definite symmetric part."""
    random = np.random.default_rng(1).standard_normal((6, 6))
    moduli = 10 * np.eye(6) + (random + random.T) / 2 + skew * (random - random.T)
    moduli[:3, :3] += 8
    return moduli


@pytest.mark.parametrize(("skew", "unsymm"), [(1.0, True), (0.0, False)])
@pytest.mark.parametrize("element_type", HYBRID)
def test_whole_tangent_of_umat(element, element_type, skew, unsymm):
    """An unsymmetric DDSDDE, and the projection of the pressure with a symmetric one, are in the matrix as they are."""
    moduli = coupled_moduli(skew)
    law = Material("M", SOURCE, user=UserMaterial(moduli.T.ravel(), unsymm, SOURCE))
    solid = element(element_type, law, user="linear_umat.f", nlgeom=False)
    random = np.random.default_rng(6)
    _, matrix, _ = solid.evaluate(np.zeros(solid.size))
    changes = random.standard_normal((4, solid.size))
    if solid.kind.hourglass_control:
        changes = [solid.moved(np.eye(3) + gradient) for gradient in random.standard_normal((4, 3, 3))]
    for d in changes:
        np.testing.assert_allclose(solid.evaluate(d)[0], matrix @ d, atol=1e-12 * abs(matrix).max() * abs(d).max())
    if skew and element_type not in FIXED:
        assert abs(matrix - matrix.T).max() > 0.02 * abs(matrix).max()


def test_perturbation_of_umat(run_deck):
    """A linear job: one iteration, and the same displacements in a perturbation step, without UNSYMM."""
    rows = coupled_moduli(0.0).T.ravel()
    law = [", ".join(f"{value:.17g}" for value in rows[k : k + 8]) for k in range(0, 36, 8)]
    lines = ["*NODE"]
    places = [(x, y, z) for z in range(2) for y in range(2) for x in range(3)]
    lines += [f"{k}, {x + 0.2 * y * z}, {y}, {z + 0.1 * x * y}" for k, (x, y, z) in enumerate(places, start=1)]
    lines += ["*ELEMENT, TYPE=C3D8H, ELSET=ALL", "1, 1, 2, 5, 4, 7, 8, 11, 10", "2, 2, 3, 6, 5, 8, 9, 12, 11"]
    lines += ["*SOLID SECTION, ELSET=ALL, MATERIAL=M", "*MATERIAL, NAME=M", "*USER MATERIAL, CONSTANTS=36", *law]
    lines += ["*NSET, NSET=HELD", "1, 4, 7, 10", "*BOUNDARY", "HELD, 1, 3"]
    load = ["*CLOAD", "12, 1, 0.3", "12, 3, 0.5", "*OUTPUT, FIELD", "*NODE OUTPUT", "U", "*END STEP"]
    found = []
    for begin in (["*STEP", "*STATIC", "1., 1."], ["*STEP, PERTURBATION", "*STATIC"]):
        result = run_deck([*lines, *begin, *load], HERE / "linear_umat.f")
        assert [row.iterations for row in result.status] == [1]
        found.append(result.field("U")[-1])
    np.testing.assert_allclose(found[1], found[0], rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("formulation", HybridFormulation)
def test_cube_of_umat(run_deck, formulation):
    """As the built-in potential in all formulations, which STRESS(NTENS+1) and DDSDDE follow."""
    compliance = 0.0 if formulation is HybridFormulation.INCOMPRESSIBLE else 0.05
    constants = f"0.7, {compliance}, {formulation.value}"
    keyword = f"*USER MATERIAL, CONSTANTS=3, HYBRID FORMULATION={formulation.name}\n{constants}"
    user = run_deck(cube("C3D8H", keyword, (1.7,)), HERE / "hybrid.f")
    built_in = run_deck(cube("C3D8H", f"*HYPERELASTIC, NEO HOOKE\n0.7, {compliance}", (1.7,)))
    np.testing.assert_allclose(user.field("S11"), built_in.field("S11"), rtol=1e-7)
    np.testing.assert_allclose(user.field("S22"), built_in.field("S22"), atol=1e-7)


def test_ordinary_elements_have_no_formulation(run_deck):
    """STRESS is not extended there."""
    keyword = "*USER MATERIAL, CONSTANTS=3, HYBRID FORMULATION=TOTAL\n0.7, 0.05, 0"
    user = run_deck(cube("C3D8", keyword, (1.7,)), HERE / "hybrid.f")
    built_in = run_deck(cube("C3D8", "*HYPERELASTIC, NEO HOOKE\n0.7, 0.05", (1.7,)))
    np.testing.assert_allclose(user.field("S11"), built_in.field("S11"), rtol=1e-7)


@pytest.mark.parametrize("element_type", ["CPE8H", "C3D8H", "C3D20RH"])
def test_eliminated_pressure_of_a_plastic_material(element, element_type):
    """Its tangent, and the energies of a linear response: half the work of the forces."""
    elastic = Elastic(ElasticType.ISOTROPIC, (YOUNG, 0.45), SOURCE)
    plastic = Plastic(np.array([[0.05, 0.0], [0.1, 0.1]]), SOURCE)
    solid = element(element_type, Material("M", SOURCE, elastic, plastic), nlgeom=False)
    random = np.random.default_rng(7)
    u = 0.1 * random.standard_normal(solid.size)
    _, matrix, report = solid.evaluate(u)
    assert report.energy[3] > 0
    for d in random.standard_normal((4, u.size)):
        slope = (solid.evaluate(u + 1e-6 * d)[0] - solid.evaluate(u - 1e-6 * d)[0]) / 2e-6
        np.testing.assert_allclose(slope, matrix @ d, atol=1e-6 * abs(matrix).max())
    forces, _, report = solid.evaluate(1e-6 * u)
    assert report.energy[1] == pytest.approx(0.5 * forces @ (1e-6 * u), rel=1e-9)
    assert report.energy[3] == pytest.approx(0, abs=1e-9 * report.energy[1])


def test_a_pressure_without_an_equation_is_named(run_deck):
    """All sides of an incompressible body are held: its pressure is anything."""
    lines = cube("C3D8H", "*HYPERELASTIC, NEO HOOKE\n0.7, 0.", ())
    lines[lines.index("*OUTPUT, FIELD")] = "*BOUNDARY\nALL, 1, 3\n*OUTPUT, FIELD"
    with pytest.raises(SingularMatrixError, match="singular system matrix at node of element 1, pressure, dof 1"):
        run_deck(lines)


def test_tetrahedron_says_what_it_is(run_deck):
    """Abaqus' element library: hybrid with linear pressure."""
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    lines = body_lines("C3D4H", corners, [range(4)])
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "", "*MATERIAL, NAME=M", "*HYPERELASTIC, NEO HOOKE\n0.7, 0.1"]
    lines += ["*STEP, NLGEOM", "*STATIC", "*BOUNDARY", "1, 1, 3", "2, 2, 3", "3, 3", "4, 3, 3, 0.1", "*END STEP"]
    result = run_deck(lines)
    (warning,) = [text for text in result.warnings if "C3D4H" in text]
    assert "elements of type C3D4H have a constant pressure here, so that a mesh of them alone is too stiff" in warning


@pytest.mark.parametrize(
    ("element_type", "keyword", "options", "message"),
    [
        ("C3D8", "*HYPERELASTIC, NEO HOOKE\n0.7, 0.", {}, "D1 = 0 is not supported .*; supported: hybrid elements"),
        ("C3D8H", "*HYPERELASTIC, YEOH\n0.7, 0., 0., 0., 1., 0.", {}, "expected that the other D are zero too"),
        ("C3D8", "*ELASTIC\n3., 0.5", {}, "nu = 0.5 is not supported .* C3D8 .*; supported: hybrid elements"),
        (
            "C3D8H",
            "*ELASTIC\n3., 0.5\n*PLASTIC\n1., 0.",
            {},
            r"nu = 0.5 beside \*PLASTIC is not supported .*; expected nu < 0.5",
        ),
        ("C3D8H", "*ELASTIC\n3., 0.5\n*EXPANSION\n1e-5", {}, r"nu = 0.5 beside \*EXPANSION is not supported"),
        ("C3D8H", "*ELASTIC\n3., 0.5, 0.\n4., 0.4, 1.", {}, r"nu = 0.5 beside \*ELASTIC with dependence on temp"),
        ("C3D8H", "*HYPERELASTIC, NEO HOOKE\n0.7, 0.", {"step": "*STEP"}, r"\*HYPERELASTIC .* with NLGEOM"),
        (
            "C3D8",
            "*HYPERELASTIC, USER, PROPERTIES=1\n1.",
            {},
            "USER without TYPE=COMPRESSIBLE is not supported for elements of type C3D8 .*; supported: hybrid elements",
        ),
        (
            "C3D8",
            "*USER MATERIAL, CONSTANTS=1, HYBRID FORMULATION=INCOMPRESSIBLE\n1.",
            {},
            "HYBRID FORMULATION=INCOMPRESSIBLE is not supported for .* C3D8 .*; supported: hybrid elements",
        ),
        ("C3D8IH", "*ELASTIC\n3., 0.5", {}, r"nu = 0.5 is not supported for elements of type C3D8IH \(material M"),
    ],
)
def test_refusals(run_deck, element_type, keyword, options, message):
    with pytest.raises(DeckError, match=rf"deck\.inp:\d+: .*{message}"):
        run_deck(cube(element_type, keyword, (1.1,), **options))


def test_tolerance_of_the_volumes(run_deck):
    """*CONTROLS, PARAMETERS=CONSTRAINTS: with a loose one the first correction passes where 1e-5 needs another."""
    texts = []
    for tolerance in ("", "*CONTROLS, PARAMETERS=CONSTRAINTS\n0.9"):
        lines = cube("C3D8H", "*HYPERELASTIC, NEO HOOKE\n0.7, 0.", (1.3,), static="*STATIC\n1., 1.")
        lines[lines.index("1e-9, 1e-9")] = f"1., 1.\n{tolerance}".rstrip()
        texts.append(run_deck(lines).file(".msg").read_text())
    assert "VOLUMETRIC STRAIN COMPATIBILITY TOLERANCE FOR HYBRID SOLIDS       1.000E-05" in texts[0]
    assert "VOLUMETRIC STRAIN COMPATIBILITY TOLERANCE FOR HYBRID SOLIDS       0.900" in texts[1]
    assert texts[0].count("EQUATIONS HAVE NOT CONVERGED") > 0
    assert "EQUATIONS HAVE NOT CONVERGED" not in texts[1]
    assert "LARGEST VOLUMETRIC STRAIN ERROR" in texts[0]
    assert "IN HYBRID ELEMENT 1" in texts[0]


def test_unknowns_of_elements_come_last(element):
    solid = element("C3D20H", MOONEY)
    assert solid.block.unknowns[-4:] == tuple((20, PRESSURE + k) for k in range(4))
    dofs = DofMap.build(solid.mesh, [solid.block])
    np.testing.assert_array_equal(dofs.equations_of(solid.block), [np.arange(64)])
    np.testing.assert_array_equal(dofs.node[-4:], 20)
    np.testing.assert_allclose(dofs.coordinates[-4:], np.tile(solid.nodes.mean(axis=0), (4, 1)))
    assert dofs.name(60) == ("of element 7, pressure", 1)
    assert dofs.name(3) == ("2", 1)
