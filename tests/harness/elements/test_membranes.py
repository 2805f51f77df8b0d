# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Membranes: against elements in plane stress, rotations, tangents, closed forms of a balloon and a drum, refusals."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from differences import differences
from moving_element import turn
from reference_cells import affine, integral, patch_of, share_of_nodes
from small_decks import body_lines

from uel.elements import Flags, Request, build_blocks
from uel.errors import ConvergenceError, DeckError, KernelError, Source
from uel.model.element_types import MEMBRANE
from uel.model.mesh import ElementGroup, Mesh
from uel.model.model import Model
from uel.model.properties import Elastic, ElasticType, Material, MembraneSection, Orientation, UserMaterial

HERE = Path(__file__).parent
SOURCE = Source("test.inp", 7)
YOUNG, NU, THICKNESS = 1000.0, 0.3, 0.2
ELASTIC = Material("M", SOURCE, Elastic(ElasticType.ISOTROPIC, (YOUNG, NU), SOURCE))
LAMINA = Material("M", SOURCE, Elastic(ElasticType.LAMINA, (YOUNG, 100.0, NU, 60.0, 50.0, 40.0), SOURCE))


def warped(element_type):
    """An element in space: sheared, distorted, and no plane."""
    nodes, _ = affine(MEMBRANE[element_type].family.cell)
    nodes = nodes + 0.03 * np.random.default_rng(1).standard_normal(nodes.shape)
    x, y = nodes.T
    return np.column_stack([x, y, 0.1 * x**2 - 0.2 * x * y + 0.3 * y]) @ turn(0.7)


@pytest.fixture
def element(bound, load, call):
    """An element of a material: its block, the call, and the matrix of the unknowns of its nodes."""

    def element(element_type, nodes, material=ELASTIC, *, nlgeom=False, user=None, orientation=None, poisson=0.5):
        options = {"hourglass": 3.0} if MEMBRANE[element_type].hourglass_control else {}
        section = MembraneSection("ALL", material, orientation, THICKNESS, poisson, SOURCE, **options)
        count = np.arange(len(nodes))
        group = ElementGroup(element_type, np.array([7]), count[None], "", section, None, SOURCE)
        block, matrix = bound(group, nodes, load(user))
        return block, replace(call, flags=Flags(1, nlgeom), unsymmetric=True), matrix

    return element


@pytest.mark.parametrize("material", [ELASTIC, LAMINA], ids=["isotropic", "lamina"])
@pytest.mark.parametrize("element_type", MEMBRANE)
def test_in_a_plane_they_are_plane_stress(element, solid_group, bound, load, call, element_type, material):
    """The matrix of small displacements is that of the CPS element; the directions are turned by 30 degrees."""
    plane = element_type.replace("M3D", "CPS")
    nodes, _ = affine(MEMBRANE[element_type].family.cell)
    nodes = np.pad(nodes + 0.03 * np.random.default_rng(2).standard_normal(nodes.shape), ((0, 0), (0, 1)))
    orientation = Orientation("O", turn(np.radians(30.0)).T, SOURCE, normal=3)
    n = len(nodes)
    found, matrices = {}, {}
    for name in (element_type, plane):
        if name == plane:
            group = solid_group(name, np.arange(n)[None], THICKNESS, elastic=material.elastic, orientation=orientation)
            hourglass = 3.0 if element_type == "M3D4R" else 0.0
            group = replace(group, section=replace(group.section, hourglass=hourglass))
            block, matrix = bound(group, nodes, load(None))
            now, places = call, np.arange(2 * n)
        else:
            block, now, matrix = element(name, nodes, material, orientation=orientation)
            places = np.delete(np.arange(3 * n), np.arange(2, 3 * n, 3))
        u = np.zeros(len(matrix.toarray()))
        u[places] = 1e-3 * np.random.default_rng(3).standard_normal(2 * n)
        block.evaluate(now, u, u, np.zeros(len(u)), matrix.data)
        block.commit()
        state, points = block.state(0).svars, MEMBRANE[element_type].points
        # E11 E22 E12 S11 S22 S12, and in plane stress E33 and S33 after 22
        values = state.reshape(points, -1)
        found[name] = values if name == element_type else values[:, [0, 1, 3, 4, 5, 7]]
        matrices[name] = matrix.toarray()[np.ix_(places, places)]
        across = matrix.toarray()[2::3] if name == element_type else None
        if across is not None and element_type != "M3D4R":
            np.testing.assert_allclose(across, 0.0, atol=1e-12)
    np.testing.assert_allclose(matrices[element_type], matrices[plane], atol=1e-11 * abs(matrices[plane]).max())
    np.testing.assert_allclose(found[element_type], found[plane], atol=1e-12)


@pytest.mark.parametrize("element_type", MEMBRANE)
def test_rotation(element, element_type):
    """In one increment, of elements that are no plane: no force, no strain."""
    nodes = warped(element_type)
    block, now, matrix = element(element_type, nodes, nlgeom=True)
    u = (nodes @ (turn(0.9) - np.eye(3)).T + [1.0, 2.0, 3.0]).ravel()
    force = np.zeros(u.size)
    report = block.evaluate(now, u, u, force, matrix.data)
    block.commit()
    np.testing.assert_allclose(force, 0.0, atol=1e-12 * YOUNG)
    np.testing.assert_allclose(block.state(0).svars, 0.0, atol=1e-12 * YOUNG)
    assert report.energy[[1, 5]] == pytest.approx(0.0, abs=1e-14)


@pytest.mark.parametrize("poisson", [0.5, 0.0])
@pytest.mark.parametrize("element_type", MEMBRANE)
def test_tangent_of_large_displacements(element, element_type, poisson):
    """It is the symmetric part of the derivative of the forces, in an increment from a stretched state."""
    nodes = warped(element_type)
    block, now, matrix = element(element_type, nodes, LAMINA, nlgeom=True, poisson=poisson)
    random = np.random.default_rng(4)
    start = (nodes @ (turn(0.4) @ np.diag([1.1, 1.3, 0.9]) - np.eye(3)).T).ravel()
    block.evaluate(now, start, start, np.zeros(start.size), matrix.data)
    block.commit()
    matrix.data[:] = 0
    du = 0.05 * random.standard_normal(start.size)
    block.evaluate(now, start + du, du, np.zeros(start.size), matrix.data)
    expected = differences(block, now, start + du, du, np.arange(start.size), step=1e-6)
    expected = (expected + expected.T) / 2
    np.testing.assert_allclose(matrix.toarray(), expected, atol=1e-7 * abs(expected).max())


@pytest.mark.parametrize("element_type", [name for name in MEMBRANE if name != "M3D4R"])
def test_matrix_of_a_stress(element, element_type):
    """In a plane it is that of the gradients, t S11 times the integral of N,1 N,1, along each direction alike: it gives
    t S11 times the area for a slope of one. At rest, S11 is that of the displacements."""
    cell = MEMBRANE[element_type].family.cell
    nodes, change = affine(cell)
    area = change * integral(cell, (0, 0))
    nodes = np.pad(nodes, ((0, 0), (0, 1)))
    block, now, matrix = element(element_type, nodes)
    u = np.column_stack([1e-3 * nodes[:, 0], -NU * 1e-3 * nodes[:, 1], 0 * nodes[:, 0]]).ravel()
    now = replace(now, flags=Flags(1, False, Request.BASE_STRESS))
    block.stress_matrix(now, u, 0 * u, matrix.data)
    found = matrix.toarray()
    for direction in np.eye(3):
        for k, expected in enumerate((THICKNESS * YOUNG * 1e-3 * area, 0.0)):
            slope = np.outer(nodes[:, k], direction).ravel()
            assert slope @ found @ slope == pytest.approx(expected, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("element_type", MEMBRANE)
def test_patch(run_deck, element_type):
    """Distorted elements in a uniform strain, by the displacements of their outer nodes."""
    nodes, elements = patch_of(MEMBRANE[element_type].family.cell)
    gradient = np.array([[1e-3, 4e-4], [-2e-4, 5e-4]])
    outside = np.flatnonzero(((abs(nodes) < 1e-9) | (abs(nodes - 1) < 1e-9)).any(axis=1))
    lines = body_lines(element_type, np.pad(nodes, ((0, 0), (0, 1))), elements)
    lines += [f"*MEMBRANE SECTION, ELSET=BODY, MATERIAL=M\n{THICKNESS}", f"*MATERIAL, NAME=M\n*ELASTIC\n{YOUNG}, {NU}"]
    lines += ["*STEP\n*STATIC\n*BOUNDARY\nALL, 3"]
    for k in outside:
        lines += [f"{k + 1}, {dof + 1}, {dof + 1}, {float(u)!r}" for dof, u in enumerate(gradient @ nodes[k])]
    result = run_deck([*lines, "*OUTPUT, FIELD\n*ELEMENT OUTPUT\nS, E\n*NODE OUTPUT\nU\n*END STEP\n"])
    e1, e2, shear = gradient[0, 0], gradient[1, 1], gradient[0, 1] + gradient[1, 0]
    modulus = YOUNG / (1 - NU**2)
    expected = modulus * (e1 + NU * e2), modulus * (e2 + NU * e1), YOUNG / (2 * (1 + NU)) * shear
    for name, value in zip(("S11", "S22", "S12"), expected, strict=True):
        np.testing.assert_allclose(result.field(name), value, rtol=1e-6, err_msg=name)
    found = result.field("U")[:, :2]
    np.testing.assert_allclose(found, nodes @ gradient.T, atol=1e-9)


def octant(pieces, *, middles):
    """An eighth of a unit sphere in triangles."""
    places, elements = {}, []

    def node(*weights):
        return places.setdefault(weights, len(places))

    for i in range(pieces):
        for j in range(pieces - i):
            k = pieces - i - j
            corners = [[(i, j, k), (i + 1, j, k - 1), (i, j + 1, k - 1)]]
            corners += [[(i + 1, j, k - 1), (i + 1, j + 1, k - 2), (i, j + 1, k - 1)]] if k > 1 else []
            for three in corners:
                found = [tuple(2 * weight for weight in corner) for corner in three]
                if middles:
                    found += [
                        tuple((a + b) // 2 for a, b in zip(found[m], found[(m + 1) % 3], strict=True)) for m in range(3)
                    ]
                elements.append([node(*weights) for weights in found])
    nodes = np.array(list(places), dtype=float)
    # angles are those of the weights
    nodes = np.sin(np.pi / 4 * nodes / pieces)
    return nodes / np.linalg.norm(nodes, axis=1, keepdims=True), elements


def balloon(element_type, pieces, material, pressure, *, poisson="", more=""):
    """An eighth of a balloon of radius 1 under a pressure, which acts on the current faces."""
    nodes, elements = octant(pieces, middles=element_type == "M3D6")
    # outward normals
    a, b, c = nodes[elements[0][:3]]
    if np.cross(b - a, c - a) @ a < 0:
        elements = [[e[0], e[2], e[1], *([e[5], e[4], e[3]] if len(e) == 6 else [])] for e in elements]
    lines = body_lines(element_type, nodes, elements)
    lines += [f"*MEMBRANE SECTION, ELSET=BODY, MATERIAL=M{poisson}\n{THICKNESS}", f"*MATERIAL, NAME=M\n{material}"]
    lines += ["*STEP, NLGEOM, INC=100", "*STATIC\n0.05, 1., 1e-5, 0.05", "*BOUNDARY"]
    lines += [f"{k}, {dof}" for k, x in enumerate(nodes, 1) for dof in (1, 2, 3) if abs(x[dof - 1]) < 1e-9]
    lines += [f"*DLOAD\nBODY, P, {pressure}", "*OUTPUT, FIELD", "*ELEMENT OUTPUT\nS, E, SDV", "*NODE OUTPUT\nU"]
    return "\n".join([*lines, more, "*END STEP\n"]), nodes


def radii(result, nodes):
    """Distances of the nodes from the middle at the end."""
    return np.linalg.norm(nodes + result.field("U"), axis=1)


@pytest.mark.parametrize(("element_type", "pieces", "error"), [("M3D3", 8, 6e-3), ("M3D6", 4, 1e-3)])
def test_inflated_balloon(run_deck, element_type, pieces, error):
    """Cauchy stress S = E/(1 - nu) ln l in both directions, thickness T/l^2, radius R l: p = 2 S T/(R l^3).

    The pressure is that of l = 1.15; the largest one is at l = exp(1/3). The error is that of the mesh.
    """
    stretch = 1.15
    stress = YOUNG / (1 - NU) * np.log(stretch)
    pressure = 2 * stress * THICKNESS / stretch**3
    text, nodes = balloon(element_type, pieces, f"*ELASTIC\n{YOUNG}, {NU}", pressure)
    result = run_deck(text)
    np.testing.assert_allclose(radii(result, nodes).mean(), stretch, rtol=error)
    assert result.field("S11").mean() == pytest.approx(stress, rel=10 * error)


def test_balloon_of_rubber(run_deck):
    """p = 2 mu T/R (1/l - 1/l^7), incompressible neo-Hooke (R.W. Ogden, Non-linear Elastic Deformations, 1984)."""
    stretch, mu = 1.25, 10.0
    pressure = 2 * mu * THICKNESS * (1 / stretch - stretch**-7)
    text, nodes = balloon("M3D6", 4, f"*USER MATERIAL, CONSTANTS=1\n{mu}\n*DEPVAR\n2", pressure)
    result = run_deck(text, user=HERE / "balloon.f")
    np.testing.assert_allclose(radii(result, nodes).mean(), stretch, rtol=2e-3)
    assert result.field("S22").mean() == pytest.approx(mu * (stretch**2 - stretch**-4), rel=1e-2)
    # DFGRD1(3,3) is the change of the thickness, NDI 2 and NSHR 1
    np.testing.assert_allclose(result.field("SDV1"), 1.0, rtol=1e-6)
    np.testing.assert_allclose(result.field("SDV2"), 12.0)


STRESSED = f"*USER MATERIAL, CONSTANTS=2\n{YOUNG}, {NU}"
AXES = "*ORIENTATION, NAME=O\n0., 0., 1., 1., 0., 0.\n3, 0.\n*STEP"
"""Direction 1 is normal to the sheet, though 3 is said to be."""
SHEET = """*NODE, NSET=ALL
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 2., 0.
4, 0., 2., 0.
*NSET, NSET=END
2, 3
*ELEMENT, TYPE={type}, ELSET=BODY
1, 1, 2, 3, 4
*MEMBRANE SECTION, ELSET=BODY, MATERIAL=M{section}
{thickness}
*MATERIAL, NAME=M
{material}
*STEP{options}
{procedure}
*BOUNDARY
1, 1, 3
2, 2, 3
3, 3
4, 1
4, 3
{load}
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=ALL
U, RF
*OUTPUT, FIELD
*ELEMENT OUTPUT
S, E
*END STEP
"""


def sheet(
    *,
    type="M3D4",
    section="",
    thickness=THICKNESS,
    material=f"*ELASTIC\n{YOUNG}, {NU}\n*DENSITY\n2.",
    options="",
    procedure="*STATIC",
    load="END, 1, 1, 0.1",
):
    return SHEET.format(
        type=type,
        section=section,
        thickness=thickness,
        material=material,
        options=options,
        procedure=procedure,
        load=load,
    )


@pytest.mark.parametrize(("type", "poisson"), [("M3D4", 0.5), ("M3D4", 0.3), ("M3D4R", 0.0)])
def test_thickness_follows_the_area(run_deck, type, poisson):
    """Pulled to twice its length: S11 = E ln 2, the width becomes 2^-nu times it, and the thickness
    (area)^(-p/(1 - p)) with the Poisson's ratio p of the section (Abaqus Theory Guide, Membrane elements)."""
    text = sheet(
        type=type,
        section=f", POISSON={poisson}",
        options=", NLGEOM, INC=1000",
        procedure="*STATIC\n0.05, 1., 0.05, 0.05",
        load="END, 1, 1, 1.",
    )
    result = run_deck(text)
    width = 2 * 2**-NU
    thickness = THICKNESS * (width * 2 / 2) ** (-poisson / (1 - poisson))
    expected = YOUNG * np.log(2) * width * thickness
    # strains of 20 increments, each at its middle
    assert sum(result.history[f"RF1[ALL:{k}]"][-1] for k in (2, 3)) == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("material", ["elastic", "plastic", "umat"])
def test_initial_stress(run_deck, material):
    """A sheet of 2 x 2 elements that is stretched by an initial stress s, whose middle is pushed along the normal by a
    force F: it deflects by w = F/(4 k), k from the gradients, t s N,1 N,1 in 4 elements of side a: 4 t s (2/3) in all.

    The deflection is small: there is no more tension by it.
    """
    stress, force, side = 5.0, 1e-4, 0.5
    elastic = f"*ELASTIC\n{YOUNG}, {NU}"
    given = {"elastic": elastic, "plastic": f"{elastic}\n*PLASTIC\n10., 0.", "umat": STRESSED}
    nodes = [[side * i, side * j, 0.0] for j in range(3) for i in range(3)]
    elements = [[k, k + 1, k + 4, k + 3] for k in (0, 1, 3, 4)]
    lines = body_lines("M3D4", nodes, elements)
    lines += ["*NSET, NSET=EDGE\n1, 2, 3, 4, 6, 7, 8, 9"]
    lines += [f"*MEMBRANE SECTION, ELSET=BODY, MATERIAL=M\n{THICKNESS}", f"*MATERIAL, NAME=M\n{given[material]}"]
    lines += [f"*INITIAL CONDITIONS, TYPE=STRESS\nBODY, {stress}, {stress}, 0.", "*STEP, NLGEOM\n*STATIC"]
    lines += ["*BOUNDARY\nEDGE, 1, 3", f"*CLOAD\n5, 3, {force}", "*OUTPUT, FIELD\n*NODE OUTPUT\nU"]
    lines += ["*ELEMENT OUTPUT\nS", "*END STEP\n"]
    result = run_deck(lines, user=HERE / "keeps.f" if material == "umat" else None)
    # integrals of N,1^2 + N,2^2 over a square element: 2/3 for each corner, whatever its side
    stiffness = 4 * THICKNESS * stress * 2 / 3
    np.testing.assert_allclose(result.field("U")[4], [0, 0, force / stiffness], rtol=1e-3, atol=1e-9)
    np.testing.assert_allclose(result.field("S11"), stress, rtol=1e-4)


def test_initial_state_by_user(run_deck, tmp_path):
    """SIGINI and SDVINI at the four points: NTENS 3, three coordinates, which UMAT keeps."""
    source = tmp_path / "user.f"
    source.write_text(
        (HERE / "keeps.f").read_text()
        + """      SUBROUTINE SIGINI(SIGMA,COORDS,NTENS,NCRDS,NOEL,NPT,LAYER,KSPT,LREBAR,NAMES)
      INCLUDE 'ABA_PARAM.INC'
      DIMENSION SIGMA(NTENS),COORDS(NCRDS)
      CHARACTER*80 NAMES(2)
      SIGMA = (/NTENS, NCRDS, NPT/)
      END
      SUBROUTINE SDVINI(STATEV,COORDS,NSTATV,NCRDS,NOEL,NPT,LAYER,KSPT)
      INCLUDE 'ABA_PARAM.INC'
      DIMENSION STATEV(NSTATV),COORDS(NCRDS)
      STATEV(1) = COORDS(1) + 10*COORDS(2)
      END
"""
    )
    initial = "*INITIAL CONDITIONS, TYPE=STRESS, USER\n*INITIAL CONDITIONS, TYPE=SOLUTION, USER"
    text = sheet(material=f"{STRESSED}\n*DEPVAR\n1\n{initial}", load="ALL, 1, 3").replace("S, E", "S, E, SDV")
    result = run_deck(text, user=source)
    # means over the points
    found = [float(result.field(name)[0]) for name in ("S11", "S22", "S12", "SDV1")]
    np.testing.assert_allclose(found, [3.0, 3.0, 2.5, 0.5 + 10.0], rtol=1e-6)


def test_plastic_sheet(run_deck):
    """Uniaxial tension beyond the yield stress: linear hardening by 0.1 E."""
    hardening = f"*ELASTIC\n{YOUNG}, {NU}\n*PLASTIC\n10., 0.\n110., 1."
    result = run_deck(sheet(material=hardening, load="END, 1, 1, 0.05"))
    # s = 10 + 100 (e - s/E)
    assert result.field("S11")[0] == pytest.approx((10 + 100 * 0.05) / (1 + 100 / YOUNG), rel=1e-3)


def test_elasticity_by_usdfld(run_deck, tmp_path):
    """E is halved by the field, which is NDI - 1 here."""
    source = tmp_path / "user.f"
    include = HERE.parent / "usdfld.inc"
    source.write_text(f"      INCLUDE '{include}'\n      FIELD(1) = NDI - 1\n      END\n")
    rows = f"*ELASTIC, DEPENDENCIES=1\n{YOUNG}, {NU}, , 0.\n{YOUNG / 2}, {NU}, , 1.\n*USER DEFINED FIELD\n*DEPVAR\n1"
    result = run_deck(sheet(material=rows), user=source)
    assert result.field("S11")[0] == pytest.approx(0.1 * YOUNG / 2, rel=1e-6)


@pytest.mark.parametrize("element_type", MEMBRANE)
def test_loads_and_mass(run_deck, element_type):
    """Nodal forces of P along the normal, of gravity and of BX in an undistorted cell: shares of thickness and area;
    the mass, lumped or consistent, gives the same force in an acceleration."""
    cell = MEMBRANE[element_type].family.cell
    nodes, change = affine(cell)
    area = change * integral(cell, (0, 0))
    nodes = np.pad(nodes, ((0, 0), (0, 1)))
    n = len(nodes)
    lines = body_lines(element_type, nodes, [range(n)])
    lines += [f"*MEMBRANE SECTION, ELSET=BODY, MATERIAL=M\n{THICKNESS}", f"*MATERIAL, NAME=M\n*ELASTIC\n{YOUNG}, {NU}"]
    lines += ["*DENSITY\n2.", "*SURFACE, NAME=BACK\nBODY, SNEG", "*STEP\n*STATIC\n*BOUNDARY\nALL, 1, 3"]
    lines += ["*DLOAD\nBODY, P, 3.\nBODY, GRAV, 5., 0., 1., 0.\nBODY, BX, 7.", "*DSLOAD\nBACK, P, 4."]
    lines += ["*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nRF\n*END STEP\n"]
    result = run_deck(lines)
    found = [[-result.history[f"RF{dof}[ALL:{k}]"][-1] for dof in (1, 2, 3)] for k in range(1, n + 1)]
    expected = np.outer(area * share_of_nodes(cell), [7.0 * THICKNESS, 2.0 * 5.0 * THICKNESS, 7.0])
    np.testing.assert_allclose(found, expected, atol=1e-9)


@pytest.mark.parametrize(
    ("element_type", "count", "error"), [("M3D4", 8, 2e-2), ("M3D4R", 8, 2e-2), ("M3D8R", 4, 1e-3)]
)
def test_drum(run_deck, element_type, count, error):
    """A square membrane that is stretched alike in both directions: f = sqrt(2 s/rho)/(2 a) (Rayleigh, The Theory of
    Sound, section 199). The sides of the mesh are those of the stretched sheet; M3D4 lumps its mass."""
    side, strain, density = 1.0, 1e-3, 2.0
    quadratic = element_type == "M3D8R"
    steps = count * (2 if quadratic else 1)
    places, elements = {}, []
    for j in range(count):
        for i in range(count):
            corners = [(0, 0), (1, 0), (1, 1), (0, 1)] + ([(0.5, 0), (1, 0.5), (0.5, 1), (0, 0.5)] if quadratic else [])
            scale = steps // count
            elements.append(
                [places.setdefault((round((i + a) * scale), round((j + b) * scale)), len(places)) for a, b in corners]
            )
    nodes = np.pad(np.array(list(places), dtype=float) * side / steps, ((0, 0), (0, 1)))
    lines = body_lines(element_type, nodes, elements)
    lines += [f"*MEMBRANE SECTION, ELSET=BODY, MATERIAL=M\n{THICKNESS}", f"*MATERIAL, NAME=M\n*ELASTIC\n{YOUNG}, {NU}"]
    edge = np.flatnonzero(((abs(nodes[:, :2]) < 1e-9) | (abs(nodes[:, :2] - side) < 1e-9)).any(axis=1))
    lines += [f"*DENSITY\n{density}", "*NSET, NSET=EDGE", *map(str, edge + 1)]
    # without a stress nothing resists along the normal
    lines += ["*STEP, NLGEOM\n*STATIC\n1., 1.\n*BOUNDARY\nALL, 3"]
    lines += [f"{k + 1}, {dof}, {dof}, {float(strain * nodes[k, dof - 1])!r}" for k in edge for dof in (1, 2)]
    lines += ["*END STEP", "*STEP\n*FREQUENCY\n1\n*BOUNDARY, OP=NEW\nEDGE, 1, 3\n*END STEP\n"]
    result = run_deck(lines)
    stress = YOUNG / (1 - NU) * np.log1p(strain)
    expected = np.sqrt(2 * stress / density) / (2 * side * (1 + strain))
    assert result.history["EIGFREQ"][-1] == pytest.approx(expected, rel=error)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (sheet(section=", POISSON=0.6"), r"deck\.inp:10: \*MEMBRANE SECTION: POISSON=0.6: expected a number from -1"),
        (sheet(thickness="-1."), r"deck\.inp:11: .*thickness -1 must be positive"),
        (sheet(thickness="1., 5"), r"deck\.inp:11: \*MEMBRANE SECTION: 2 entries, expected at most 1"),
        (sheet(type="S4"), r"holds elements of type S4, which take \*SHELL SECTION"),
        (sheet(section=", NODAL THICKNESS"), r"NODAL THICKNESS is not supported"),
        (
            sheet(material="*HYPERELASTIC, NEO HOOKE\n1., 0.1"),
            r"\*HYPERELASTIC is not supported for elements of type M3D4 ",
        ),
        (
            sheet(material="*ELASTIC, TYPE=TRACTION\n1., 1., 1."),
            r"TYPE=TRACTION is not supported .* supported: cohesive",
        ),
        (
            sheet(material=f"*ELASTIC\n{YOUNG}, {NU}\n*CREEP\n1e-9, 3., 0.", procedure="*VISCO, CETOL=1.\n1., 1."),
            r"\*CREEP is not supported for elements of type M3D4",
        ),
        (
            sheet(load="*DLOAD\n1, P1, 2."),
            r"elements of type M3D4 have no face S1 \(faces: SPOS, SNEG\)",
        ),
        (sheet(load="*DLOAD\n1, EDNOR1, 2."), r"elements of type M3D4 have no face E1 \(faces: SPOS, SNEG\)"),
        (sheet(load="*DLOAD\n1, BXNU, 2."), r"loads by DLOAD are not supported there"),
        (
            sheet(material=f"*ELASTIC\n{YOUNG}, {NU}", procedure="*DYNAMIC\n0.1, 1."),
            r"material M has no \*DENSITY, which elements of type M3D4 need in \*DYNAMIC \(section at .*deck\.inp:10\)",
        ),
        (
            sheet(type="M3D4R", section=", CONTROLS=C").replace(
                "*MATERIAL,", "*SECTION CONTROLS, NAME=C, HOURGLASS=ENHANCED\n*MATERIAL,"
            ),
            r"HOURGLASS=ENHANCED is not supported for elements of type M3D4R",
        ),
        (
            sheet(type="M3D4R", material="*USER MATERIAL, CONSTANTS=1\n1.\n*DEPVAR\n2"),
            r"M3D4R with \*USER MATERIAL need \*HOURGLASS STIFFNESS after \*MEMBRANE SECTION",
        ),
        (sheet(thickness=""), r"deck\.inp:10: \*MEMBRANE SECTION: needs a data line with the thickness"),
        (
            sheet(section=", ORIENTATION=O").replace("*STEP", "*ORIENTATION, NAME=O, SYSTEM=USER\n*STEP"),
            r"\*ORIENTATION, SYSTEM=USER is not supported for elements of type M3D4",
        ),
        (
            sheet(material=f"*ELASTIC\n{YOUNG}, {NU}\n*EXPANSION\n1e-5"),
            r"\*EXPANSION is not supported for elements of type M3D4 \(material M",
        ),
    ],
)
def test_what_is_refused(run_deck, text, message):
    with pytest.raises(DeckError, match=message):
        run_deck(text, user=HERE / "balloon.f")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "3, 1., 2., 0.",
            "3, 0.1, 0.1, 0.",
            "the membrane has no area or is folded at its integration point 4; its nodes",
        ),
        ("*STEP", AXES, r"\*ORIENTATION: the axis that is projected is normal to the membrane at integration point 1"),
        ("END, 1, 1, 0.1", "END, 1, 1, -1.", "turns inside out at its integration point 1"),
    ],
)
def test_shapes_that_end_the_job(run_deck, old, new, message):
    text = sheet(section=", ORIENTATION=O" if new == AXES else "", options=", NLGEOM", procedure="*STATIC\n1., 1., 1.")
    with pytest.raises((KernelError, ConvergenceError), match=rf"element 1 \(type M3D4\).*({message})"):
        run_deck(text.replace(old, new, 1))


def test_names_of_a_built_model(load):
    """Unknowns are the displacements of all nodes."""
    nodes = warped("M3D6")
    section = MembraneSection("ALL", ELASTIC, None, THICKNESS, 0.5, SOURCE)
    group = ElementGroup("M3D6", np.array([1]), np.arange(6)[None], "", section, None, SOURCE)
    mesh = Mesh(np.arange(6) + 1, nodes, ("",) * 6)
    (block,) = build_blocks(Model(Path("test.inp"), "", mesh, (group,), ()), load(None))
    assert block.unknowns == tuple((node, dof) for node in range(6) for dof in (1, 2, 3))
    assert block.variables is not None
    assert block.variables.names == ("E11", "E22", "E12", "S11", "S22", "S12")


def test_umat_needs_its_hourglass_stiffness(element):
    """Given, it is taken: the material has no shear modulus."""
    material = Material("M", SOURCE, user=UserMaterial(np.array([10.0]), False, SOURCE), state_variables=2)
    block, now, matrix = element("M3D4R", warped("M3D4R"), material, nlgeom=True, user="balloon.f")
    block.evaluate(now, np.zeros(12), np.zeros(12), np.zeros(12), matrix.data)
    assert np.linalg.matrix_rank(matrix.toarray(), tol=1e-9) == 6
