# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Enhanced hourglass control: exact bending, the published forces of a brick, and what it does not go with."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from small_decks import body_lines

import uel
from uel.elements import build_blocks
from uel.errors import DeckError, Source
from uel.model.mesh import Mesh
from uel.model.model import Model
from uel.model.properties import Elastic, ElasticType, HybridFormulation, Material, SectionControls, UserMaterial

SOURCE = Source("test.inp", 1)
POINTS = Path(__file__).with_name("points.f")
SQUARE = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
CUBE = np.vstack([SQUARE - np.eye(3)[2], SQUARE + np.eye(3)[2]])
ENHANCED = SectionControls(enhanced=True)
GRID = [np.array(values) for values in ([0.0, 1.0, 4.0], [-0.3, 0.1, 0.4], [-0.2, 0.3, 0.5])]


def rectangles(dimension):
    """Nodes and elements of 2 x 2 (x 2) rectangles or bricks of different sizes."""
    axes = GRID[:dimension]
    nodes = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, dimension)
    step = 3 ** np.arange(dimension - 1, -1, -1)
    first = np.stack(np.meshgrid(*[[0, 1]] * dimension, indexing="ij"), axis=-1).reshape(-1, dimension) @ step
    corners = (((CUBE if dimension == 3 else SQUARE)[:, :dimension] + 1) / 2).astype(int) @ step
    return np.pad(nodes, ((0, 0), (0, 3 - dimension))), first[:, None] + corners


@pytest.mark.parametrize("element_type", ["CPS4R", "CPE4R"])
def test_rectangles_with_enhanced_control_bend_exactly(forces_of, element_type):
    """u = (xy, -x^2/2 - m y^2/2) is bending by E11 = y alone, with m = nu and E, in plane strain nu/(1 - nu) and
    E/(1 - nu^2): no force within, and the energy of the beam."""
    young, nu = 1000.0, 0.3
    ratio, modulus = (nu, young) if element_type == "CPS4R" else (nu / (1 - nu), young / (1 - nu**2))
    nodes, elements = rectangles(2)
    x, y, _ = nodes.T
    u = np.column_stack([x * y, -(x**2 + ratio * y**2) / 2])
    force, _, energy = forces_of(element_type, nodes, elements=elements, young=young, nu=nu, controls=ENHANCED)(u)
    assert energy[1] + energy[5] == pytest.approx(modulus / 2 * 4 * (0.4**3 + 0.3**3) / 3, rel=1e-12)
    np.testing.assert_allclose(force[(x > 0) & (x < 4)], 0.0, atol=1e-10)
    np.testing.assert_allclose(force[:, 1], 0.0, atol=1e-10)


def test_far_from_the_axis_the_control_is_that_of_plane_strain(control_of):
    radius = 1e7
    u = np.random.default_rng(4).normal(size=(4, 2))
    (plane, _), (round_, _) = (
        control_of(name, SQUARE[:, :2] + [shift, 0.0], None)(u) for name, shift in (("CPE4R", 0.0), ("CAX4R", radius))
    )
    np.testing.assert_allclose(round_ / (2 * np.pi * radius), plane, rtol=1e-5, atol=1e-6 * abs(plane).max())


def test_wall_of_a_cylinder_bends_in_one_element(run_deck):
    """A force Q per length around the end of a long cylinder moves it by Q/(2 beta^3 D), beta^4 = 3 (1 - nu^2)/(R t)^2
    (S. Timoshenko, S. Woinowsky-Krieger, Theory of Plates and Shells, 1959, 115). CAX4R has one point across the wall,
    so that all of its bending stiffness is that of the hourglass control."""
    young, nu, radius, thickness, count = 1000.0, 0.3, 100.0, 1.0, 60
    beta = (3 * (1 - nu**2)) ** 0.25 / np.sqrt(radius * thickness)
    rigidity = young * thickness**3 / (12 * (1 - nu**2))
    z = np.linspace(0.0, 6.0 / beta, count + 1)
    nodes = np.array([(r, height) for height in z for r in (radius - thickness / 2, radius + thickness / 2)])
    elements = np.array([[0, 1, 3, 2]]) + 2 * np.arange(count)[:, None]
    lines = [*body_lines("CAX4R", nodes, elements), "*SOLID SECTION, ELSET=BODY, MATERIAL=M, CONTROLS=C"]
    lines += ["*SECTION CONTROLS, NAME=C, HOURGLASS=ENHANCED", "*MATERIAL, NAME=M", f"*ELASTIC\n{young}, {nu}"]
    lines += ["*STEP\n*STATIC\n1., 1.", f"*BOUNDARY\n{2 * count + 1}, 1, 2\n{2 * count + 2}, 1, 2"]
    half = np.pi * radius  # half of a force of one per length
    lines += [f"*CLOAD\n1, 1, {half}\n2, 1, {half}", "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU\n*END STEP"]
    history = run_deck([*lines, ""]).history
    found = (history["U1[ALL:1]"][-1] + history["U1[ALL:2]"][-1]) / 2
    # thin: of the order of the thickness over the radius
    assert found == pytest.approx(1 / (2 * beta**3 * rigidity), rel=0.02)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_bricks_with_enhanced_control_bend_exactly(forces_of, axis):
    """Bending by E11 = y alone, the section bent as well: u = (xy, -x^2/2 - nu (y^2 - z^2)/2, -nu y z)."""
    young, nu = 1000.0, 0.3
    nodes, elements = rectangles(3)
    x, y, z = nodes[:, np.roll([0, 1, 2], -axis)].T
    u = np.column_stack([x * y, -(x**2 + nu * (y**2 - z**2)) / 2, -nu * y * z])[:, np.roll([0, 1, 2], axis)]
    force, _, energy = forces_of("C3D8R", nodes, elements=elements, young=young, nu=nu, controls=ENHANCED)(u)
    second_moment = np.ptp(z) * (y.max() ** 3 - y.min() ** 3) / 3
    assert energy[1] + energy[5] == pytest.approx(young / 2 * np.ptp(x) * second_moment, rel=1e-12)
    inside = (x > x.min()) & (x < x.max())
    np.testing.assert_allclose(force[inside], 0.0, atol=1e-9)


def test_enhanced_control_of_a_brick_as_published(control_of):
    """Forces Q of the hourglass displacements q of a brick (T. Belytschko, L.P. Bindeman, Computer Methods in Applied
    Mechanics and Engineering 105 (1993) 225), those of h_1 = yz, h_2 = zx, h_3 = xy, h_4 = xyz over 8."""
    young, nu = 1000.0, 0.3
    shear, lengths = young / (2 * (1 + nu)), np.array([2.0, 0.7, 0.4])
    signs = CUBE
    patterns = np.array(
        [signs[:, 1] * signs[:, 2], signs[:, 2] * signs[:, 0], signs[:, 0] * signs[:, 1], signs.prod(1)]
    )
    q = np.random.default_rng(1).normal(size=(3, 4))
    edges = 4 * lengths  # sums of signs times coordinates
    forces = np.zeros((3, 4))
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3

        def h(a, b):
            c = 3 - a - b
            return edges[c] / 3 if a != b else edges[(a + 1) % 3] * edges[(a + 2) % 3] / edges[a] / 3

        forces[i, i] = shear * ((h(j, j) + h(k, k)) * q[i, i] + h(i, j) * q[j, j] + h(i, k) * q[k, k])
        for m in (j, k):
            forces[i, m] = 2 * shear / (1 - nu) * (h(i, i) * q[i, m] + nu * h(i, m) * q[m, i])
        forces[i, 3] = 2 * shear * (1 + nu) / 3 * h(i, i) * q[i, 3]
    # displacements q times the patterns have hourglass displacements 8 q over 8
    force, _ = control_of("C3D8R", CUBE / 2 * lengths, None, young=young, nu=nu)((q @ patterns).T)
    np.testing.assert_allclose(force, (forces @ patterns).T / 8, rtol=1e-12)


def test_enhanced_control_warns_once_for_a_section(solid_group, load):
    library = load(None)
    group = solid_group("CPS4R", np.arange(4)[None], 1.0)
    group = replace(group, section=replace(group.section, controls=ENHANCED))
    others = (replace(group, labels=np.array([7])), solid_group("CPS4", np.arange(4)[None], 1.0))
    mesh = Mesh(np.arange(1, 5), SQUARE, ("",) * 4)
    build_blocks(Model(Path("test.inp"), "", mesh, (group, *others), ()), library)
    (warning,) = [message.text for message in library.messages()]
    assert "test.inp:7: *SECTION CONTROLS, HOURGLASS=ENHANCED: the published method" in warning
    assert "no results of Abaqus to compare with" in warning


PLY = Elastic(ElasticType.LAMINA, (1000.0, 500.0, 0.3, 200.0, 200.0, 200.0), SOURCE)
USER = Material("M", SOURCE, user=UserMaterial(np.array([1.0]), False, SOURCE, HybridFormulation.INCOMPRESSIBLE))


@pytest.mark.parametrize(
    ("element_type", "change", "message"),
    [
        ("CPS4R", {"material": Material("M", SOURCE, PLY)}, r"for material M; expected \*ELASTIC, TYPE=ISOTROPIC with"),
        (
            "C3D8RH",
            {"material": USER},
            r"for material M; expected \*ELASTIC, TYPE=ISOTROPIC with constant values",
        ),
        (
            "CPE4R",
            {"hourglass": 1.0},
            r"\*HOURGLASS STIFFNESS and \*SECTION CONTROLS with HOURGLASS=ENHANCED: expected",
        ),
        (
            "CPE4R",
            {"hourglass": 1.0, "controls": SectionControls(hourglass=2.0)},
            r"\*HOURGLASS STIFFNESS and \*SECTION CONTROLS with a factor of the hourglass stiffness: expected only one",
        ),
    ],
)
def test_what_controls_do_not_go_with(solid_group, bound, load, element_type, change, message):
    nodes = CUBE if element_type == "C3D8RH" else SQUARE
    group = solid_group(element_type, np.arange(len(nodes))[None], 1.0)
    group = replace(group, section=replace(group.section, **({"controls": ENHANCED} | change)))
    with pytest.raises(DeckError, match=r"test.inp:7: .*" + message):
        bound(group, nodes + 2 * np.eye(3)[0], load(None))


def bent(element_type, material, nodes, static="*STATIC\n1., 1.", nlgeom=""):
    """A deck that moves each node of one element by its hourglass patterns and a strain, and asks for the reactions."""
    lines = body_lines(element_type, nodes, [range(len(nodes))])
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M, CONTROLS=C", "0.7" if nodes.shape[1] == 2 else ""]
    lines += ["*SECTION CONTROLS, NAME=C, HOURGLASS=ENHANCED", "*MATERIAL, NAME=M", *material]
    lines += [f"*STEP{nlgeom}", static, "*BOUNDARY"]
    moved = np.random.default_rng(3).normal(size=nodes.shape) / 50
    lines += [f"{k}, {i}, {i}, {x}" for k, row in enumerate(moved, 1) for i, x in enumerate(row, 1)]
    return [*lines, "*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "RF", "*END STEP"]


def reactions(folder, lines, user=None):
    """Reactions (increments, dofs) of a deck."""
    (folder / "bent.inp").write_text("\n".join(lines) + "\n")
    history = uel.run(folder / "bent.inp", user=user, output_dir=folder).history
    return np.array([values for name, values in history.items() if name.startswith("RF")]).T


USER_LINES = ["*DEPVAR", "7", "*USER MATERIAL, CONSTANTS=3", "1000., 0.3, 0."]


@pytest.mark.parametrize(
    ("element_type", "nlgeom"),
    [
        ("CPS4R", ""),  # the thickness does not change by UMAT
        *((name, nlgeom) for name in ("CPE4R", "C3D8R", "CPE4RT", "C3D8RT", "C3D8RH") for nlgeom in ("", ", NLGEOM")),
    ],
)
def test_isotropic_umat_with_enhanced_control_is_elastic(tmp_path, element_type, nlgeom):
    """The isotropic part of an isotropic DDSDDE is all of it: the forces are those of *ELASTIC."""
    nodes = CUBE * [1, 0.6, 0.4] if element_type.startswith("C3") else SQUARE[:, :2] * [1, 0.6]
    heat = ["*CONDUCTIVITY", "1."] if element_type.endswith("T") else []
    static = "*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE\n1., 1." if heat else "*STATIC\n1., 1."
    options = {"static": static, "nlgeom": nlgeom}
    elastic = reactions(tmp_path, bent(element_type, ["*ELASTIC", "1000., 0.3", *heat], nodes, **options))
    user = reactions(tmp_path, bent(element_type, USER_LINES + heat, nodes, **options), POINTS)
    np.testing.assert_allclose(user, elastic, rtol=1e-9, atol=1e-9 * abs(elastic).max())


def test_enhanced_control_keeps_the_moduli_of_the_first_tangent(tmp_path):
    """UMAT is softer after the first increment: a hourglass pattern, which has no strain, grows as it began."""
    source = tmp_path / "softens.f"
    source.write_text(
        f"      include '{POINTS.parent.parent / 'umat.inc'}'\n"
        "      e = 1000\n"
        "      if (time(2) > 0) e = 10\n"
        "      ddsdde = 0\n"
        "      do i = 1, ntens\n"
        "        ddsdde(i,i) = e\n"
        "      end do\n"
        "      ddsdde(3,3) = e/2\n"
        "      stress = stress + matmul(ddsdde, dstran)\n"
        "      end\n"
    )
    lines = bent("CPS4R", ["*USER MATERIAL, CONSTANTS=1", "1."], SQUARE[:, :2], "*STATIC\n0.5, 1., 0.5, 0.5")
    first = lines.index("*BOUNDARY") + 1
    pattern = [f"{k}, 1, 1, {x}" for k, x in enumerate([0.1, -0.1, 0.1, -0.1], 1)]
    lines[first : first + 8] = [*pattern, "ALL, 2, 2"]
    forces = reactions(tmp_path, lines, source)
    np.testing.assert_allclose(forces[-1], 2 * forces[-2], rtol=1e-12, atol=1e-12)
    assert abs(forces[-1]).max() == pytest.approx(1000 * 0.7 / 3 * 0.1, rel=1e-12)


def test_warning_of_enhanced_control_of_a_umat_names_the_tangent(tmp_path):
    lines = bent("CPS4R", USER_LINES, SQUARE[:, :2])
    reactions(tmp_path, lines, POINTS)
    text = " ".join((tmp_path / "bent.msg").read_text().split())
    assert "with the isotropic part of the first DDSDDE of UMAT (material M)" in text


PRINTED = {
    (-0.175, -0.175, 0.375): (0.8898, 1.450, 0.8429, 1.030, -0.0424, -0.0130, -0.0317, -0.0097, -0.1849),
    (-0.175, -0.175, 0.025): (0.8541, 1.526, 0.8541, 1.129, 0.0531, -0.0265, -0.0265, 0.0531, 1.129),
    (-0.175, -0.125, 0.025): (0.7215, 1.975, 0.7215, 0.7079, 0.0551, -0.0714, -0.0714, 0.0551, 0.7079),
    (-0.125, -0.025, 0.175): (0.7240, 1.936, 0.7482, 0.5036, 0.0000, -0.0326, -0.0712, 0.0044, 0.5182),
    (-0.025, 0.175, 0.025): (0.9367, 1.342, 0.8625, 0.4029, -0.0111, -0.0255, -0.0031, 0.0160, -0.2713),
}
"""Middle of an element; DG11, 22, 33, 12, 13, 23, 21, 31, 32 that Abaqus 2020 prints (AkshayJoshi108/HexElVerify,
Job-5-1.dat)."""


@pytest.mark.long
def test_deformation_gradients_of_a_rubber_block(run_deck, tmp_path):
    """A cube of 0.4 in 512 C3D8R of a neo-Hookean material, clamped at one face; the other one moves by 0.2, 0.3, 0.2.

    The largest difference of the entries is 0.028 here, beside the edges of the clamped face, and was 0.13 with the
    initial modulus in the hourglass control; the mean of all entries of the job is 0.003 (regression).
    """
    axis = np.linspace(-0.2, 0.2, 9)
    nodes = np.stack(np.meshgrid(axis, axis, axis + 0.2, indexing="ij"), axis=-1).reshape(-1, 3)
    first = np.array([81 * i + 9 * j + k for i in range(8) for j in range(8) for k in range(8)])
    elements = first[:, None] + np.array([0, 81, 90, 9, 1, 82, 91, 10])
    lines = body_lines("C3D8R", nodes, elements)
    for name, side in (("LOW", -0.2), ("HIGH", 0.2)):
        lines += [f"*NSET, NSET={name}", *map(str, np.flatnonzero(np.isclose(nodes[:, 1], side)) + 1)]
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "*MATERIAL, NAME=M", "*HYPERELASTIC, NEO HOOKE", "100., 0.0008"]
    lines += ["*STEP, NLGEOM", "*STATIC", "1., 1., 1e-05, 1.", "*BOUNDARY", "LOW, 1, 3", "HIGH, 1, 1, 0.2"]
    lines += ["HIGH, 2, 2, 0.3", "HIGH, 3, 3, 0.2", "*OUTPUT, FIELD", "*NODE OUTPUT", "U", "*END STEP", ""]
    result = run_deck(lines)
    message = " ".join((tmp_path / "deck.msg").read_text().split())
    assert "the rule was chosen by one public job of Abaqus, whose deformation gradients it meets to 0.03" in message
    u = result.mesh(-1).point_data["U"]
    signs = np.sign(nodes[elements[0]] - nodes[elements[0]].mean(axis=0))
    for middle, printed in PRINTED.items():
        (k,) = np.flatnonzero(np.isclose(nodes[elements].mean(axis=1), middle).all(axis=1))
        # the mean gradients of the shape functions of a cube of 0.05
        f = np.eye(3) + u[elements[k]].T @ signs / (4 * 0.05)
        found = f[[0, 1, 2, 0, 0, 1, 1, 2, 2], [0, 1, 2, 1, 2, 2, 0, 0, 1]]
        np.testing.assert_allclose(found, printed, rtol=0, atol=0.03)
