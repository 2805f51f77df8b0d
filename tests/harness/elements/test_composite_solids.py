# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*SOLID SECTION, COMPOSITE: bricks with layers, element by element and in decks."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from reference_cells import affine, patch_of, unit_cell
from small_decks import body_lines

from uel.elements import Flags, Request
from uel.errors import DeckError, Source
from uel.model.element_types import CONTINUUM, LAYERED
from uel.model.mesh import ElementGroup
from uel.model.properties import (
    CompositeSection,
    Elastic,
    ElasticType,
    Material,
    Orientation,
    Plastic,
    SectionControls,
    SolidLayer,
    SolidSection,
)

HERE = Path(__file__).parents[1]
SOURCE = Source("test.inp", 7)
CONSTANTS = {
    # no contraction across the layers: the stress along them is that of plane stress
    "P": (9000.0, 800.0, 500.0, 0.2, 0.0, 0.0, 90.0, 80.0, 70.0),
    "Q": (4000.0, 1500.0, 300.0, 0.3, 0.0, 0.0, 200.0, 60.0, 50.0),
}
"""E1, E2, E3, nu12, nu13, nu23, G12, G13, G23."""
ISOTROPIC = Elastic(ElasticType.ISOTROPIC, (1000.0, 0.3), SOURCE)


def material(name="P", elastic=None, **options):
    elastic = elastic or Elastic(ElasticType.ENGINEERING_CONSTANTS, CONSTANTS[name], SOURCE)
    return Material(name, SOURCE, elastic, **options)


def stiffness(constants):
    """(6, 6) of engineering constants, components 11, 22, 33, 12, 13, 23 (Jones, Mechanics of Composite Materials)."""
    e1, e2, e3, nu12, nu13, nu23, *shear = constants
    compliance = np.diag([1 / e1, 1 / e2, 1 / e3, *(1 / g for g in shear)])
    compliance[0, 1] = compliance[1, 0] = -nu12 / e1
    compliance[0, 2] = compliance[2, 0] = -nu13 / e1
    compliance[1, 2] = compliance[2, 1] = -nu23 / e2
    return np.linalg.inv(compliance)


PAIRS = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]


def tensor_of(strain):
    """(3, 3) of components with engineering shear strains."""
    found = np.zeros((3, 3))
    for value, (i, j) in zip(strain, PAIRS, strict=True):
        found[i, j] = found[j, i] = value if i == j else value / 2
    return found


def stress_of(constants, strain, axes):
    """(3, 3) in global directions of a strain (3, 3) of a material whose directions are the rows of axes."""
    local = axes @ strain @ axes.T
    components = [local[i, j] * (1 if i == j else 2) for i, j in PAIRS]
    stress = stiffness(constants) @ components
    found = np.zeros((3, 3))
    for value, (i, j) in zip(stress, PAIRS, strict=True):
        found[i, j] = found[j, i] = value
    return axes.T @ found @ axes


def about(axis, degrees):
    """Rows: the global directions turned about one of them, 1, 2 or 3."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    i, j = axis % 3, (axis + 1) % 3
    axes = np.eye(3)
    axes[i, i] = axes[j, j] = c
    axes[i, j], axes[j, i] = s, -s
    return axes


def along(direction):
    """An orientation whose direction 3 is the stack direction, so that the angles of layers are about it."""
    return Orientation("O", np.roll(np.eye(3), -direction, axis=0), SOURCE, normal=3)


def laminate(direction=3, points=3):
    """Three layers at angles, the second one of another material."""
    o = along(direction)
    return CompositeSection(
        "ALL",
        (
            SolidLayer(0.3, points, material("P"), o, 30.0),
            SolidLayer(0.6, points, material("Q"), o, -45.0),
            SolidLayer(0.1, points, material("P"), o),
        ),
        direction,
        SOURCE,
    )


@pytest.fixture
def solid(bound, load, call):
    """Forces (nodes, 3), matrix, energy and the block by displacements of some elements."""

    def solid(element_type, section, nodes, elements=None, *, nlgeom=False):
        elements = np.arange(len(nodes))[None] if elements is None else elements
        group = ElementGroup(element_type, 101 + np.arange(len(elements)), elements, "", section, None, SOURCE)
        block, matrix = bound(group, nodes, load(None))
        now = replace(call, flags=Flags(1, nlgeom))

        def evaluate(u):
            residual = np.zeros(u.size)
            matrix.data[:] = 0
            report = block.evaluate(now, u.ravel(), u.ravel(), residual, matrix.data)
            return -residual.reshape(u.shape), matrix.toarray(), report.energy, block

        return evaluate

    return solid


def one_layer(points, splits=(1.0,), orientation=None, direction=3, **options):
    layers = tuple(SolidLayer(t, points, material(**options), orientation) for t in splits)
    return CompositeSection("ALL", layers, direction, SOURCE)


def test_types():
    """Bricks with displacements alone (Analysis User's Guide, Solid elements)."""
    assert set(LAYERED) == {"C3D8", "C3D8R", "C3D8I", "C3D20", "C3D20R"}


@pytest.mark.parametrize("element_type", ["C3D8", "C3D8I"])
@pytest.mark.parametrize("direction", [1, 2, 3])
@pytest.mark.parametrize("splits", [(1.0,), (2.0, 5.0, 1.0)])
def test_layers_of_one_material_are_the_element_without(solid, element_type, direction, splits):
    """Simpson's rule is exact for what is quadratic across a parallelepiped, as the two points of Gauss are."""
    nodes, _ = affine("hexahedron")
    axes = about(2, 25) @ about(3, 40)
    o = Orientation("O", axes, SOURCE)
    _, plain, *_ = solid(element_type, SolidSection("ALL", material(), o, 1.0, SOURCE), nodes)(0 * nodes)
    _, found, *_ = solid(element_type, one_layer(3, splits, o, direction), nodes)(0 * nodes)
    np.testing.assert_allclose(found, plain, atol=1e-9 * abs(plain).max())


@pytest.mark.parametrize("element_type", LAYERED)
@pytest.mark.parametrize("direction", [1, 2, 3])
def test_patch_of_macneal_and_harder(solid, element_type, direction):
    """u = 1e-3 (2 x + y + z)/2 and so on, E 1e6, nu 0.25: all strains 1e-3, stresses 2000 and 400, whatever the
    layers of the material are. One point across a layer is not enough: forces are quadratic there."""
    nodes, elements = patch_of(CONTINUUM[element_type].family.cell)
    elastic = Elastic(ElasticType.ISOTROPIC, (1e6, 0.25), SOURCE)
    section = one_layer(3, (1.0, 2.0), None, direction, elastic=elastic)
    u = 1e-3 * nodes @ np.array([[2, 1, 1], [1, 2, 1], [1, 1, 2]]) / 2
    force, matrix, energy, block = solid(element_type, section, nodes, elements)(u)
    block.commit()
    state = block.state(0).svars.reshape(-1, 12)
    np.testing.assert_allclose(state, np.tile([1e-3] * 6 + [2000] * 3 + [400] * 3, (len(state), 1)), rtol=1e-9)
    inside = ((nodes > 0) & (nodes < 1)).all(axis=1)
    assert abs(force[inside]).max(initial=0) < 1e-9 * abs(force).max()
    np.testing.assert_allclose(matrix @ u.ravel(), force.ravel(), atol=1e-8 * abs(force).max())
    assert energy[1] == pytest.approx(0.5e-3 * (3 * 2000 + 3 * 400), rel=1e-9)


@pytest.mark.parametrize("element_type", LAYERED)
@pytest.mark.parametrize("direction", [1, 2, 3])
def test_rigid_motions_cost_nothing(solid, element_type, direction):
    """Of the matrix; and a rotation by 70 degrees with NLGEOM, with which strains are those of the increment's middle
    but in C3D8I."""
    nodes, elements = patch_of(CONTINUUM[element_type].family.cell)
    # the elements of the patch have their third direction in all directions
    layers = [(1.0, "P", about(1, 30)), (2.0, "Q", about(2, 50)), (0.5, "P", about(3, 70))]
    layers = tuple(SolidLayer(t, 3, material(name), Orientation("O", axes, SOURCE)) for t, name, axes in layers)
    section = CompositeSection("ALL", layers, direction, SOURCE)
    _, matrix, *_ = solid(element_type, section, nodes, elements)(0 * nodes)
    x, y, z = nodes.T
    o = 0 * x
    turns = [np.column_stack(c).ravel() for c in ([o, -z, y], [z, o, -x], [-y, x, o])]
    rigid = np.array([*(np.tile(e, len(nodes)) for e in np.eye(3)), *turns])
    np.testing.assert_allclose(matrix @ rigid.T, 0, atol=1e-9 * abs(matrix).max())
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-9 * abs(matrix).max())
    assert np.linalg.matrix_rank(matrix, tol=1e-9 * abs(matrix).max()) == nodes.size - 6
    turned = nodes @ (about(2, 50) @ about(3, 70)) + [1.0, 2.0, 3.0]
    force, *_ = solid(element_type, section, nodes, elements, nlgeom=True)(turned - nodes)
    np.testing.assert_allclose(force, 0, atol=1e-9 * abs(matrix).max())


@pytest.mark.parametrize("element_type", [name for name in LAYERED if not CONTINUUM[name].incompatible])
@pytest.mark.parametrize("direction", [1, 2, 3])
@pytest.mark.parametrize("points", [1, 3])
def test_uniform_strain_is_that_of_laminate_theory(solid, element_type, direction, points):
    """Forces on the faces are mean stresses times area: thicknesses are in proportion to those of the section.
    Incompatible modes would let the layers stretch in different ways."""
    nodes, _ = unit_cell(CONTINUUM[element_type].family.cell)
    nodes = nodes * [2.0, 3.0, 0.5]
    strain = tensor_of([1e-3, -2e-3, 5e-4, 3e-3, 0.0, 0.0])
    section = laminate(direction, points)
    # C3D8 shares the volume strain, which is uniform here
    force, _, energy, block = solid(element_type, section, nodes)(nodes @ strain)
    turns = [about(3, layer.angle or 0.0) @ layer.orientation.axes for layer in section.layers]
    stresses = [stress_of(CONSTANTS[x.material.name], strain, a) for x, a in zip(section.layers, turns, strict=True)]
    mean = sum(x.thickness * s for x, s in zip(section.layers, stresses, strict=True))
    volume = 3.0
    np.testing.assert_allclose(force.T @ nodes, mean * volume, rtol=1e-9, atol=1e-9 * abs(mean).max())
    assert energy[1] == pytest.approx(0.5 * volume * np.sum(mean * strain), rel=1e-9)
    block.commit()
    state = block.state(0).svars.reshape(1, -1, 3 * points, 12)
    for number, (axes, stress) in enumerate(zip(turns, stresses, strict=True)):
        local = axes @ stress @ axes.T
        expected = [local[i, j] for i, j in PAIRS]
        here = state[:, :, number * points : (number + 1) * points, 6:].reshape(-1, 6)
        np.testing.assert_allclose(here, np.tile(expected, (len(here), 1)), rtol=1e-9, atol=1e-9)


def bending_stiffness(section, thickness):
    """D11 about the middle of a laminate whose relative thicknesses have the sum 1."""
    bottom, found = -thickness / 2, 0.0
    for layer in section.layers:
        top = bottom + thickness * layer.thickness
        axes = about(3, layer.angle or 0.0)
        q11 = stress_of(CONSTANTS[layer.material.name], tensor_of([1, 0, 0, 0, 0, 0]), axes)[0, 0]
        found += q11 * (top**3 - bottom**3) / 3
        bottom = top
    return found


@pytest.mark.parametrize("element_type", ["C3D20", "C3D20R"])
def test_bending_is_that_of_laminate_theory(solid, element_type):
    """u = k x z, w = -k x^2/2: a curvature alone, and a strain across the layers of which no stress comes. Its energy
    has D11, with the stiffness of plane stress."""
    nodes, _ = unit_cell("hexahedron20")
    nodes = (nodes - [0, 0, 0.5]) * [2.0, 3.0, 0.5]
    x, _, z = nodes.T
    k = 0.01
    u = np.column_stack([k * x * z, 0 * x, -k * x**2 / 2])
    section = laminate()
    _, _, energy, _ = solid(element_type, section, nodes)(u)
    assert energy[1] == pytest.approx(0.5 * bending_stiffness(section, 0.5) * k**2 * 6.0, rel=1e-9)


@pytest.mark.parametrize("options", [{}, {"hourglass": 3.0}, {"controls": SectionControls(enhanced=True)}])
def test_one_layer_of_one_point(solid, options):
    """C3D8R, with its hourglass control: the same as without layers."""
    nodes, _ = affine("hexahedron")
    nodes[6] += [0.3, 0.2, -0.1]
    section = replace(one_layer(1, elastic=ISOTROPIC), **options)
    plain = SolidSection("ALL", material(elastic=ISOTROPIC), None, 1.0, SOURCE, **options)
    u = 0.01 * np.random.default_rng(3).uniform(-1, 1, nodes.shape)
    found, expected = (solid("C3D8R", given, nodes)(u) for given in (section, plain))
    for one, other in zip(found[:3], expected[:3], strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9 * abs(other).max())


def test_layers_of_one_point_bend(solid):
    """u = k x z: in the middle of C3D8R it is a curvature alone, whose energy has D11 of laminate theory."""
    nodes, _ = unit_cell("hexahedron")
    nodes = (nodes - 0.5) * [2.0, 3.0, 0.5]
    k, section = 0.01, laminate()
    u = np.column_stack([k * nodes[:, 0] * nodes[:, 2], 0 * nodes[:, 0], 0 * nodes[:, 0]])
    _, _, energy, _ = solid("C3D8R", section, nodes)(u)
    assert energy[1] == pytest.approx(0.5 * bending_stiffness(section, 0.5) * k**2 * 6.0, rel=1e-9)


@pytest.mark.parametrize("element_type", ["C3D20", "C3D20R"])
@pytest.mark.parametrize("direction", [1, 2, 3])
def test_one_element_for_each_layer(solid, element_type, direction):
    """Where the strains are linear across the layers, their energy is that of elements of one layer each."""
    random = np.random.default_rng(2)
    first, second = (axis for axis in range(3) if axis != direction - 1)

    def motion(x):
        height = x[:, [direction - 1]]
        linear, twisted = x @ slopes, height * x[:, [first, second]]
        return linear + np.column_stack([twisted, 0 * height[:, 0]]) @ mixed

    slopes, mixed = 1e-3 * random.uniform(-1, 1, (3, 3)), 1e-3 * random.uniform(-1, 1, (3, 3))
    nodes, _ = unit_cell("hexahedron20")
    section = laminate(direction)
    *_, energy, _ = solid(element_type, section, nodes)(motion(nodes))
    total, bottom = 0.0, 0.0
    for layer in section.layers:
        own = nodes.copy()
        own[:, direction - 1] = bottom + layer.thickness * own[:, direction - 1]
        axes = about(3, layer.angle or 0.0) @ layer.orientation.axes
        alone = SolidSection("ALL", layer.material, Orientation("O", axes, SOURCE), 1.0, SOURCE)
        *_, part, _ = solid(element_type, alone, own)(motion(own))
        total += part[1]
        bottom += layer.thickness
    assert energy[1] == pytest.approx(total, rel=1e-9)


@pytest.mark.parametrize("element_type", LAYERED)
def test_tangent_is_the_derivative_of_the_forces(solid, element_type):
    """One layer of which yields."""
    cell = CONTINUUM[element_type].family.cell
    nodes, _ = affine(cell)
    plastic = Plastic(np.array([[1.0, 0.0], [50.0, 0.5]]), SOURCE)
    layers = (
        SolidLayer(1.0, 3, material("S", ISOTROPIC, plastic=plastic), None),
        SolidLayer(2.0, 1, material("Q"), along(3), 20.0),
    )
    evaluate = solid(element_type, CompositeSection("ALL", layers, 3, SOURCE), nodes)
    random = np.random.default_rng(4)
    u = 5e-3 * random.uniform(-1, 1, nodes.shape) + nodes @ tensor_of([4e-3, 0, 0, 6e-3, 0, 0])
    _, matrix, *_ = evaluate(u)
    step, found = 1e-6, np.zeros_like(matrix)
    for k in range(u.size):
        d = np.zeros(u.size)
        d[k] = step
        ends = [evaluate(u + sign * d.reshape(u.shape))[0].ravel() for sign in (1, -1)]
        found[:, k] = (ends[0] - ends[1]) / (2 * step)
    np.testing.assert_allclose(found, matrix, atol=1e-6 * abs(matrix).max())


def test_mass(bound, load, call):
    """That of the element without layers."""
    nodes, _ = affine("hexahedron")
    masses = []
    for section in (
        SolidSection("ALL", material(density=5.0), None, 1.0, SOURCE),
        one_layer(3, (1.0, 2.0), None, density=5.0),
    ):
        group = ElementGroup("C3D8", np.array([1]), np.arange(8)[None], "", section, None, SOURCE)
        block, matrix = bound(group, nodes, load(None))
        block.evaluate(call.asking(Request.MASS), np.zeros(24), np.zeros(24), np.zeros(24), matrix.data)
        masses.append(matrix.toarray())
    np.testing.assert_allclose(masses[1], masses[0], rtol=1e-12)


BOX = np.array([[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0], [0, 0, 0.5], [2, 0, 0.5], [2, 1, 0.5], [0, 1, 0.5]], float)
PLIES = """*ORIENTATION, NAME=O
1., 0., 0., 0., 1., 0.
3, 0.
*ORIENTATION, NAME=T
{0}, {1}, 0., -{1}, {0}, 0.
*SOLID SECTION, ELSET=BODY, COMPOSITE{options}
{layers}
*MATERIAL, NAME=P
*ELASTIC, TYPE=ENGINEERING CONSTANTS
9000., 800., 500., 0.2, 0., 0., 90., 80.
70.
*MATERIAL, NAME=Q
*ELASTIC
1000., 0.
"""
STEP = """*STEP{nlgeom}
*STATIC, DIRECT
0.5, 1.
*BOUNDARY
1, 1, 3
4, 1
5, 1, 2
8, 1
2, 1, 1, 0.02
3, 1, 1, 0.02
6, 1, 1, 0.03
7, 1, 1, 0.03
{more}
*OUTPUT, FIELD
*NODE OUTPUT
U, RF
*ELEMENT OUTPUT
S, E, SDV
*END STEP
"""


def plies(layers, options=", ORIENTATION=O", *, type="C3D8", nlgeom="", more="", before=""):
    lines = "\n".join(body_lines(type, BOX, [range(8)]))
    angle = np.radians(35)
    section = PLIES.format(repr(float(np.cos(angle))), repr(float(np.sin(angle))), options=options, layers=layers)
    return f"{lines}\n{section}{before}{STEP.format(nlgeom=nlgeom, more=more)}"


def test_stack_direction_without_layers(run_deck):
    """As Abaqus/CAE writes it for a section whose orientation has a direction of the stack."""
    found = []
    for option in ("", ", STACK DIRECTION=2"):
        text = plies("1.", f", MATERIAL=P, ORIENTATION=T{option}").replace(", COMPOSITE", "")
        found.append(run_deck(text).field("U").copy())
    np.testing.assert_array_equal(*found)


@pytest.mark.parametrize("element_type", ["C3D8", "C3D8R", "C3D8I"])
def test_large_displacements_of_equal_layers(run_deck, element_type):
    """Uniform stretches and rotations: the same as without layers, whose directions turn in the same way."""
    gradient = np.array([[0.2, 0.3, 0.0], [-0.2, 0.1, 0.1], [0.05, 0.0, -0.1]])
    motion = "\n".join(
        f"{k}, {dof}, {dof}, {value!r}"
        for k, u in enumerate((BOX @ gradient).tolist(), 1)
        for dof, value in enumerate(u, 1)
    )
    found = []
    for layers, options in (("1., 3, P\n2., 3, P", ""), ("1.", ", MATERIAL=P")):
        text = plies(layers, f", ORIENTATION=T{options}", type=element_type, nlgeom=", NLGEOM")
        text = text.replace(", COMPOSITE", "" if options else ", COMPOSITE")
        start, end = text.index("1, 1, 3\n"), text.index("\n*OUTPUT")
        found.append(run_deck(text[:start] + motion + text[end:]).field("RF").copy())
    np.testing.assert_allclose(*found, rtol=1e-6, atol=1e-6 * abs(found[0]).max())


@pytest.mark.parametrize(
    ("given", "same"),
    [
        ("1., 3, P, 35.", "1., 3, P, T"),
        ("1., 3, P, -35.", "1., 3, P, -35., Ply-1"),
        ("0.2, , P, 35.\n0.3, , Q", "2., 1, P, T\n3., 1, Q, O"),
        # without an angle the directions are those of the section
        ("1., 3, P", "1., 3, P, 0."),
    ],
)
def test_lines_that_say_the_same(run_deck, given, same):
    found = [run_deck(plies(layers)).field("U").copy() for layers in (given, same)]
    np.testing.assert_allclose(*found, rtol=1e-6, atol=1e-9)


def test_symmetric(run_deck):
    found = run_deck(plies("1., 1, P, 35.\n2., 3, Q", ", ORIENTATION=O, SYMMETRIC")).field("U").copy()
    expected = run_deck(plies("1., 1, P, 35.\n2., 3, Q\n2., 3, Q\n1., 1, P, 35."))
    np.testing.assert_array_equal(found, expected.field("U"))


def test_angles_are_about_the_normal_of_the_layer(run_deck):
    """An orientation that is tilted against the layers is projected on them if the layer has an angle, only then."""
    tilted = "*ORIENTATION, NAME=L\n0.8, 0., 0.6, 0., 1., 0.\n3, 0.\n"
    flat = run_deck(plies("1., 3, P, 35.")).field("U").copy()
    projected = (
        run_deck(plies("1., 3, P, 35.", ", ORIENTATION=L").replace("*SOLID", tilted + "*SOLID", 1)).field("U").copy()
    )
    np.testing.assert_allclose(projected, flat, rtol=1e-6, atol=1e-9)
    kept = run_deck(plies("1., 3, P", ", ORIENTATION=L").replace("*SOLID", tilted + "*SOLID", 1)).field("U").copy()
    alone = (
        plies("1.", ", MATERIAL=P, ORIENTATION=L").replace(", COMPOSITE", "").replace("*SOLID", tilted + "*SOLID", 1)
    )
    np.testing.assert_allclose(kept, run_deck(alone).field("U"), rtol=1e-6, atol=1e-9)


UMAT = f"""      INCLUDE '{HERE / "umat.inc"}'
      DDSDDE = 0
      DO K = 1, NTENS
        DDSDDE(K,K) = PROPS(1)
      END DO
      STRESS = STRESS + MATMUL(DDSDDE, DSTRAN)
      STATEV(1) = NPT
      STATEV(2) = LAYER
      STATEV(3) = KSPT
      STATEV(4:6) = COORDS
      STATEV(7) = CELENT
      STATEV(8) = NSTATV
      STATEV(9) = PREDEF(1) + DPRED(1)
      END
"""
USDFLD = f"""      INCLUDE '{HERE / "usdfld.inc"}'
      FIELD(1) = LAYER + 10*KSPT + 100*ICHAR(ORNAME(1:1))
      STATEV(10) = DIRECT(2,1)
      END
"""


@pytest.mark.parametrize("direction", [1, 2, 3])
def test_arguments_of_user_routines(run_deck, tmp_path, direction):
    """At the first and the last section point; the mean of the four points along the layers is their middle."""
    user = "*MATERIAL, NAME=U\n*USER MATERIAL, CONSTANTS=1\n100.\n*DEPVAR\n10\n*USER DEFINED FIELD\n"
    other = "*MATERIAL, NAME=V\n*USER MATERIAL, CONSTANTS=1\n100.\n*DEPVAR\n12\n*USER DEFINED FIELD\n"
    turned = "3, 0." if direction == 3 else "1, 0." if direction == 1 else "2, 0."
    layers = "1., 1, U, 30.\n3., 3, V, T"
    text = plies(layers, f", ORIENTATION=O, STACK DIRECTION={direction}", before=user + other)
    text = text.replace("3, 0.", turned, 1)
    (tmp_path / "user.f").write_text(UMAT + USDFLD)
    found = run_deck(text, user=tmp_path / "user.f")
    size = BOX.max(axis=0)
    for side, layer, kspt, place in (("SNEG", 1, 1, 1 / 8), ("SPOS", 2, 3, 1.0)):
        middle = size / 2
        middle[direction - 1] = place * size[direction - 1]
        name = "O" if layer == 1 else "T"
        expected = [2.5, layer, kspt, *middle, 1.0, 10 if layer == 1 else 12, layer + 10 * kspt + 100 * ord(name)]
        for k, value in enumerate(expected, 1):
            np.testing.assert_allclose(found.field(f"SDV{k}_{side}"), value, rtol=1e-6, err_msg=f"{k} {side}")
    # of the first direction of the material along y: 30 degrees about an axis, or 35 about z
    first = {1: 0.0, 2: 0.0, 3: 0.5}[direction]
    np.testing.assert_allclose(found.field("SDV10_SNEG"), first, atol=1e-6)
    np.testing.assert_allclose(found.field("SDV10_SPOS"), np.sin(np.radians(35)), rtol=1e-6)


def test_layers_of_a_field_are_layers_of_a_material(run_deck, tmp_path):
    table = "*MATERIAL, NAME=F\n*ELASTIC, DEPENDENCIES=1\n500., 0.2, , 1.\n900., 0.4, , 3.\n*USER DEFINED FIELD\n"
    (tmp_path / "user.f").write_text(
        USDFLD.replace("LAYER + 10*KSPT + 100*ICHAR(ORNAME(1:1))", "LAYER").replace(
            "      STATEV(10) = DIRECT(2,1)\n", ""
        )
    )
    one = run_deck(plies("1., 3, F\n1., 3, F\n2., 3, F", before=table), user=tmp_path / "user.f").field("U").copy()
    constants = "".join(f"*MATERIAL, NAME=F{k}\n*ELASTIC\n{300 + 200 * k}., {0.1 + 0.1 * k}\n" for k in (1, 2, 3))
    other = run_deck(plies("1., 3, F1\n1., 3, F2\n2., 3, F3", before=constants))
    np.testing.assert_allclose(one, other.field("U"), rtol=1e-6, atol=1e-9)


def test_expansion_of_a_layer(run_deck):
    """Both layers are as stiff and stretch alike: their forces balance, and the strain is the weighted mean."""
    before = "*MATERIAL, NAME=H\n*ELASTIC\n1000., 0.\n*EXPANSION\n1e-3\n"
    text = plies("1., 3, H\n3., 3, Q", before=before, more="*TEMPERATURE\nALL, 10.")
    text = "\n".join(line for line in text.split("\n") if not line.endswith((", 0.02", ", 0.03")))
    # the sides stay plane and parallel
    text = text.replace("*STEP", "*EQUATION\n2\n2, 1, 1., 6, 1, -1.\n2\n3, 1, 1., 7, 1, -1.\n*STEP", 1)
    text = text.replace("1, 1, 3\n", "ALL, 2, 3\n1, 1\n", 1).replace("4, 1\n5, 1, 2\n8, 1\n", "4, 1\n5, 1\n8, 1\n")
    found = run_deck(text)
    np.testing.assert_allclose(found.field("E11_SPOS"), 0.01 / 4, rtol=1e-5)
    np.testing.assert_allclose(found.field("S11_SNEG"), 1000 * (0.01 / 4 - 0.01), rtol=1e-5)


def test_gravity_and_print(run_deck):
    """A force of density times volume; *EL PRINT has the points at which the stresses are, as with shells."""
    text = plies(
        "1., 3, Q\n3., 1, Q", more="*DLOAD\nBODY, GRAV, 10., 0., 0., -1.\n*EL PRINT, POSITION=AVERAGED AT NODES\nS"
    )
    text = text.replace("1000., 0.\n", "1000., 0.\n*DENSITY\n2.\n")
    found = run_deck(text)
    assert found.field("RF")[:, 2].sum() == pytest.approx(2 * 10 * 1.0, rel=1e-6)
    lines = [line.split() for line in found.file(".dat").read_text().splitlines()]
    assert {line[2] for line in lines if line[:1] == ["1"] and len(line) == 9} == {"1", "4"}


CLAMPED = "*BOUNDARY\n1, 1, 3\n4, 1, 3\n5, 1, 3\n8, 1, 3\n"


@pytest.mark.parametrize(
    "step",
    [f"*STEP\n*FREQUENCY\n3,\n{CLAMPED}*END STEP\n", f"*STEP\n*BUCKLE\n2,\n{CLAMPED}*CLOAD\n2, 1, -1.\n*END STEP\n"],
)
def test_modes_of_equal_layers(run_deck, step):
    """Those of the element without layers."""
    found = []
    for layers, options in (("1., 3, Q\n2., 3, Q", ""), ("1.", ", MATERIAL=Q")):
        text = plies(layers, options).replace("1000., 0.\n", "1000., 0.\n*DENSITY\n2.\n")
        text = text.replace(", COMPOSITE", "" if options else ", COMPOSITE")
        found.append(run_deck(text[: text.index("*STEP")] + step).history["EIGVAL"].copy())
    np.testing.assert_allclose(*found, rtol=1e-8)


@pytest.mark.parametrize(
    ("layers", "options", "more", "message"),
    [
        ("1., 3, P", ", MATERIAL=P", {}, r":\d+: \*SOLID SECTION: expected either MATERIAL= or COMPOSITE"),
        ("", "", {}, r"\*SOLID SECTION: COMPOSITE needs a data line for each layer"),
        ("1., 2, P", "", {}, r"2 section points: expected an odd number from 1 to 249"),
        ("0., 1, P", "", {}, r"thickness 0 must be positive"),
        ("1., 1", "", {}, r"material is missing"),
        ("1., 1, X", "", {}, r":18: unknown material X"),
        ("1., 1, P, X", "", {}, r":18: unknown orientation X"),
        ("1., 1, P, 30.", "", {}, r"an angle is measured from the ORIENTATION of the section, which is not given"),
        ("1., 1, P, 30., A, 4", ", ORIENTATION=O", {}, r"6 entries, expected at most 5"),
        ("1., 1, P", ", STACK DIRECTION=ORIENTATION", {}, r"STACK DIRECTION=ORIENTATION is not supported"),
        (
            "1., 1, P, 30.",
            ", ORIENTATION=T",
            {},
            r"\*ORIENTATION, NAME=T: direction 1, about which the angles of layers are, must be the closest one to the "
            r"stack direction; it is not in element 1",
        ),
        (
            "1., 1, P",
            "",
            {"type": "C3D8H"},
            r"COMPOSITE is not supported for elements of type C3D8H; expected C3D8, C3D8R, C3D20, C3D20R, C3D8I",
        ),
        (
            "1., 1, Q\n1., 1, D",
            "",
            {"before": "*MATERIAL, NAME=D\n*ELASTIC\n9., 0.\n*DENSITY\n1.\n"},
            r"\*DENSITY that differs from layer to layer is not supported for elements of type C3D8",
        ),
        (
            "1., 1, D",
            "",
            {"before": "*MATERIAL, NAME=D\n*ELASTIC\n9., 0.\n*VISCOELASTIC, TIME=PRONY\n0.1, 0., 1.\n"},
            r"\*VISCOELASTIC is not supported for elements of type C3D8 with layers",
        ),
        (
            "1., 1, D",
            "",
            {"before": "*MATERIAL, NAME=D\n*ELASTIC\n9., 0.\n*USER OUTPUT VARIABLES\n1\n"},
            r"\*USER OUTPUT VARIABLES is not supported for elements of type C3D8 with layers \(material D",
        ),
        (
            "1., 1, D",
            "",
            {"before": "*MATERIAL, NAME=D\n*HYPERELASTIC, NEO HOOKE\n1., 0.1\n"},
            r"\*HYPERELASTIC is not supported for elements of type C3D8 with layers",
        ),
        (
            "1., 1, P, Z",
            "",
            {"before": "*ORIENTATION, NAME=Z, SYSTEM=USER\n"},
            r"\*ORIENTATION, SYSTEM=USER is not supported for elements of type C3D8 with layers",
        ),
        (
            "1., 1, P",
            "",
            {"before": "*INITIAL CONDITIONS, TYPE=STRESS\nBODY, 1., 1., 1., 0., 0., 0.\n"},
            r"TYPE=STRESS is not supported for elements of type C3D8 with layers",
        ),
    ],
)
def test_what_is_wrong_is_named(run_deck, layers, options, more, message):
    with pytest.raises(DeckError, match=message):
        run_deck(plies(layers, options, **more))


def test_umat_in_elements_of_one_point_needs_hourglass_stiffness(run_deck):
    text = plies("1., 1, U", type="C3D8R", before="*MATERIAL, NAME=U\n*USER MATERIAL, CONSTANTS=1\n1.\n")
    message = r"elements of type C3D8R with \*USER MATERIAL need \*HOURGLASS STIFFNESS after \*SOLID SECTION"
    with pytest.raises(DeckError, match=message):
        run_deck(text)


def test_two_hourglass_controls(run_deck):
    text = plies("1., 1, P\n*HOURGLASS STIFFNESS\n1.", ", CONTROLS=C", type="C3D8R")
    text = text.replace("*MATERIAL", "*SECTION CONTROLS, NAME=C, HOURGLASS=ENHANCED\n*MATERIAL", 1)
    with pytest.raises(DeckError, match=r"\*HOURGLASS STIFFNESS and \*SECTION CONTROLS with HOURGLASS=ENHANCED"):
        run_deck(text)


def test_an_angle_of_zero_needs_no_normal(run_deck):
    """The direction about which angles are lies in the layer, as in the public deck 1Element-UMAT."""
    found = run_deck(plies("1., 3, P, 0.", ", ORIENTATION=O, STACK DIRECTION=1")).field("U").copy()
    np.testing.assert_array_equal(found, run_deck(plies("1., 3, P, O", ", STACK DIRECTION=1")).field("U"))


def test_dynamic_needs_density(run_deck):
    text = plies("1., 1, P").replace("*STATIC, DIRECT\n0.5, 1.", "*DYNAMIC, DIRECT, NOHAF\n0.5, 1.")
    with pytest.raises(
        DeckError, match=r"material P has no \*DENSITY, which elements of type C3D8 with layers need in \*DYNAMIC"
    ):
        run_deck(text)
