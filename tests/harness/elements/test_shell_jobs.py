# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Shells in whole jobs: patch tests, the obstacle course, loads, UMAT, vibration and output.

Figures of the obstacle course: R.H. MacNeal, R.L. Harder, Finite Elements in Analysis and Design 1 (1985) 3; the
pinched cylinder with end diaphragms: T. Belytschko and others, Computer Methods in Applied Mechanics and Engineering 51
(1985) 221.
"""

import re
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from shell_decks import ShellDeck

from uel.model.element_types import SHELL

TYPES = tuple(SHELL)
STEP = "*STEP\n*STATIC\n{}\n*OUTPUT, FIELD\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=P\nU\nRF\n*END STEP"
ISOTROPIC = "*ELASTIC\n{}, {}"


def section(thickness, more=""):
    return f"*SHELL SECTION, ELSET=SHELL, MATERIAL=M{more}\n{thickness}"


@pytest.fixture
def run_shell(run_deck):
    def run_shell(deck, data, sets, *, user=None, step=STEP):
        return run_deck(deck.text(step.format(data), sets), user)

    return run_shell


@pytest.fixture
def deflection(run_shell):
    """The largest magnitude of a displacement of set P at the end of a job."""

    def deflection(deck, data, sets, dof):
        history = run_shell(deck, data, sets).history
        return max(abs(values[-1]) for name, values in history.items() if name.startswith(f"U{dof}[P"))

    return deflection


# the patch of MacNeal and Harder: a mesh of 3 x 3 cells whose inner nodes are theirs
PATCH = {
    (1, 1): (0.04 / 0.24 - 1 / 3, 0.02 / 0.12 - 1 / 3),
    (2, 1): (0.18 / 0.24 - 2 / 3, 0.03 / 0.12 - 1 / 3),
    (2, 2): (0.16 / 0.24 - 2 / 3, 0.08 / 0.12 - 2 / 3),
    (1, 2): (0.08 / 0.24 - 1 / 3, 0.08 / 0.12 - 2 / 3),
}


def solve_patch(run_shell, element_type, *, bending, skew=0.0, moved=PATCH, thickness=0.001):
    """Displacements inside, those of MacNeal and Harder there, and errors of stresses over the largest stress."""
    deck = ShellDeck(
        element_type,
        3,
        3,
        lambda a, b: (0.24 * a + skew * b, 0.12 * b, 0.0),
        section(thickness),
        ISOTROPIC.format(1e6, 0.25),
        moved=moved,
    )
    x, y, _ = deck.coordinates.T
    u = np.zeros((len(x), 6))
    if bending:
        u[:, 2] = 1e-3 * (x**2 + x * y + y**2) / 2
        u[:, 3], u[:, 4] = 1e-3 * (y + x / 2), -1e-3 * (x + y / 2)
    else:
        u[:, 0], u[:, 1] = 1e-3 * (x + y / 2), 1e-3 * (y + x / 2)
    edge = sorted({node - 1 for end in (0, 3) for node in deck.side(i=end) + deck.side(j=end)})
    inner = [k for k in range(len(x)) if k not in edge]
    dofs = (1, 2, 3, 4, 5) if bending else (1, 2, 3, 4, 5, 6)
    data = "*BOUNDARY\n" + "\n".join(f"{k + 1}, {dof}, {dof}, {u[k, dof - 1]:.17g}" for k in edge for dof in dofs)
    result = run_shell(deck, data, {"P": [k + 1 for k in inner]})
    found = np.array([[result.history[f"U{i}[P:{k + 1}]"][-1] for i in (1, 2, 3)] for k in inner])
    top = 1000 * thickness * np.array([2 / 3, 2 / 3, 0.2]) if bending else np.array([4000 / 3, 4000 / 3, 400.0])
    stresses = [
        (sign * result.field(f"{name}_{side}") - value) / top.max()
        for side, sign in (("SPOS", -1 if bending else 1), ("SNEG", 1))
        for name, value in zip(("S11", "S22", "S12"), top, strict=True)
    ]
    return found, u[inner, :3], np.array(stresses)


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("bending", [False, True])
def test_patch(run_shell, element_type, bending):
    """The displacements of MacNeal and Harder at the edges give theirs inside, and their stresses everywhere.

    S8R bends exactly in parallelograms only: its functions have no square of the coordinates in other quadrilaterals.
    """
    other = {"skew": 0.07, "moved": {}} if bending and element_type == "S8R" else {}
    found, expected, stresses = solve_patch(run_shell, element_type, bending=bending, **other)
    np.testing.assert_allclose(found, expected, rtol=1e-7, atol=1e-14)
    np.testing.assert_allclose(stresses, 0, atol=1e-6)


@pytest.mark.parametrize("thickness", [0.001, 0.02])
def test_patch_that_eight_nodes_fail(run_shell, thickness):
    """What shells.md says of the patch of MacNeal and Harder in bending."""
    found, expected, stresses = solve_patch(run_shell, "S8R", bending=True, thickness=thickness)
    page = (Path(__file__).parents[3] / "harness" / "uel" / "elements" / "families" / "shells.md").read_text()
    displacement, stress = re.search(rf"\| {thickness} \| ([\d.]+) % \| ([\d.]+) % \|", page).groups()
    assert 100 * abs(found - expected).max() / abs(expected).max() == pytest.approx(float(displacement), abs=0.06)
    assert 100 * abs(stresses).max() == pytest.approx(float(stress), abs=0.6)


@pytest.mark.parametrize("element_type", ["S4", "S4R", "S3", "S8R"])
@pytest.mark.parametrize(("dof", "exact"), [(1, 3e-5), (2, 0.1081), (3, 0.4321)])
def test_straight_cantilever(deflection, element_type, dof, exact):
    """6 x 1 elements: extension, bending in the plane and out of it; triangles of constant strain lock in the plane.

    S4R bends in its plane by hourglass modes, exactly with the enhanced control, if little resists drilling: a node has
    not the same rotation in both elements.
    """
    given = section(0.1)
    if element_type == "S4R" and dof == 2:
        controls = "*SECTION CONTROLS, NAME=BENDS, HOURGLASS=ENHANCED\n*SHELL SECTION, CONTROLS=BENDS,"
        given = given.replace("*SHELL SECTION,", controls) + "\n*HOURGLASS STIFFNESS\n, , , 1e-3"
    deck = ShellDeck(element_type, 6, 1, lambda a, b: (6 * a, 0.2 * b, 0.0), given, ISOTROPIC.format(1e7, 0.3))
    end = deck.side(i=6)
    loads = [f"{node}, {dof}, {share!r}" for node, share in zip(end, deck.shares(end), strict=True)]
    data = "\n".join(["*BOUNDARY", "FIX, 1, 6", "*CLOAD", *loads])
    found = deflection(deck, data, {"P": end, "FIX": deck.side(i=0)}, dof)
    assert found < 1.01 * exact
    assert found > {"S3": 0.02 if dof == 2 else 0.95}.get(element_type, 0.97) * exact


def scordelis(element_type, n):
    radius, length = 25.0, 50.0

    def place(a, b):
        angle = np.radians(40 * a)
        return radius * np.sin(angle), b * length / 2, radius * np.cos(angle)

    deck = ShellDeck(element_type, n, n, place, section(0.25), "*ELASTIC\n4.32e8, 0.\n*DENSITY\n360.")
    sets = {"P": [deck.node(n, n)], "RIGID": deck.side(j=0), "MIDDLE": deck.side(j=n), "CROWN": deck.side(i=0)}
    return (
        deck,
        "*BOUNDARY\nRIGID, 1\nRIGID, 3\nMIDDLE, YSYMM\nCROWN, XSYMM\n*DLOAD\nSHELL, GRAV, 1., 0., 0., -1.",
        sets,
        3,
    )


def cylinder(element_type, n):
    radius, length = 300.0, 600.0

    def place(a, b):
        return radius * np.sin(np.pi / 2 * a), b * length / 2, radius * np.cos(np.pi / 2 * a)

    deck = ShellDeck(element_type, n, n, place, section(3.0), ISOTROPIC.format(3e6, 0.3))
    sets = {"P": [deck.node(0, n)], "RIGID": deck.side(j=0), "MIDDLE": deck.side(j=n)}
    sets |= {"X": deck.side(i=0), "Z": deck.side(i=n)}
    data = "*BOUNDARY\nRIGID, 1\nRIGID, 3\nMIDDLE, YSYMM\nX, XSYMM\nZ, ZSYMM\n*CLOAD\nP, 3, -0.25"
    return deck, data, sets, 3


def hemisphere(element_type, n):
    def place(a, b):
        around, up = np.pi / 2 * a, np.radians(72 * b)
        return 10 * np.cos(up) * np.cos(around), 10 * np.cos(up) * np.sin(around), 10 * np.sin(up)

    deck = ShellDeck(element_type, n, n, place, section(0.04), ISOTROPIC.format(6.825e7, 0.3))
    sets = {"P": [deck.node(0, 0)], "Q": [deck.node(n, 0)], "TOP": [deck.node(0, n)]}
    sets |= {"Y": deck.side(i=0), "X": deck.side(i=n)}
    return deck, "*BOUNDARY\nY, YSYMM\nX, XSYMM\nTOP, 3\n*CLOAD\nP, 1, 1.\nQ, 2, -1.", sets, 1


def twisted(element_type, n, dof):
    def place(a, b):
        angle, across = np.pi / 2 * a, 1.1 * (b - 0.5)
        return 12 * a, across * np.cos(angle), across * np.sin(angle)

    deck = ShellDeck(element_type, n, n // 6, place, section(0.32), ISOTROPIC.format(29e6, 0.22))
    end = deck.side(i=n)
    loads = "\n".join(f"{node}, {dof}, {part!r}" for node, part in zip(end, deck.shares(end), strict=True))
    sets = {"P": [end[len(end) // 2]], "FIX": deck.side(i=0)}
    return deck, f"*BOUNDARY\nFIX, 1, 6\n*CLOAD\n{loads}", sets, dof


@pytest.mark.parametrize(
    ("element_type", "problem", "exact", "low", "high"),
    [
        ("S4", scordelis("S4", 8), 0.3024, 0.99, 1.01),
        ("S4", cylinder("S4", 16), 1.8248e-5, 0.92, 1.0),
        ("S4", hemisphere("S4", 8), 0.094, 0.98, 1.0),
        ("S4R", hemisphere("S4R", 16), 0.094, 0.99, 1.01),
        ("S4", twisted("S4", 12, 3), 5.424e-3, 0.98, 1.0),
        ("S4", twisted("S4", 12, 2), 1.754e-3, 0.98, 1.0),
        # softer than S4, whose modes bend exactly in the plane: 1.061 on 12 x 2
        ("S4R", twisted("S4R", 24, 2), 1.754e-3, 0.99, 1.02),
        ("S3", scordelis("S3", 16), 0.3024, 0.95, 1.01),
        ("S3", hemisphere("S3", 16), 0.094, 0.85, 1.0),
        ("S3R", twisted("S3R", 12, 3), 5.424e-3, 0.97, 1.0),
        ("S8R", scordelis("S8R", 4), 0.3024, 0.99, 1.01),
        ("S8R", cylinder("S8R", 8), 1.8248e-5, 0.97, 1.0),
        ("S8R", hemisphere("S8R", 8), 0.094, 0.98, 1.0),
        ("S8R", twisted("S8R", 6, 3), 5.424e-3, 0.99, 1.0),
        ("S8R", twisted("S8R", 6, 2), 1.754e-3, 0.99, 1.0),
        ("S3", twisted("S3", 24, 2), 1.754e-3, 0.92, 1.0),
    ],
    ids=lambda value: value[0].kind + str(value[0].n) if isinstance(value, tuple) else None,
)
def test_obstacle_course(deflection, element_type, problem, exact, low, high):
    """Within a few percent of the published displacement, on meshes on which others publish their elements."""
    assert low < deflection(*problem) / exact < high


PROBLEMS = {
    "Scordelis-Lo roof": scordelis,
    "pinched cylinder": cylinder,
    "hemisphere with a hole": hemisphere,
    "twisted beam, out of its plane": partial(twisted, dof=3),
    "twisted beam, in its plane": partial(twisted, dof=2),
}


def rows_of_the_page():
    """Problem, published displacement, cells along the first side, ratios of S4, S4R, S3 and S8R."""
    page = Path(__file__).parents[3] / "harness" / "uel" / "elements" / "families" / "shells.md"
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in page.read_text().splitlines() if "x" in line]
    name, exact = "", 0.0
    for what, mesh, *ratios in (row for row in rows if len(row) == 6 and row[1][:1].isdigit()):
        if what:
            name, _, number = what.rpartition(", ")
            exact = float(number)
        yield name, exact, int(mesh.split(" x ")[0]), [float(ratio) for ratio in ratios]


@pytest.mark.long
@pytest.mark.parametrize(("name", "exact", "n", "ratios"), list(rows_of_the_page()))
def test_page(deflection, name, exact, n, ratios):
    """The table of shells.md, to its last digit."""
    for element_type, ratio in zip(("S4", "S4R", "S3", "S8R"), ratios, strict=True):
        found = deflection(*PROBLEMS[name](element_type, n)) / exact
        assert found == pytest.approx(ratio, abs=0.0006), element_type


@pytest.mark.long
@pytest.mark.parametrize("element_type", ["S4", "S3"])
@pytest.mark.parametrize(("problem", "exact"), [(scordelis, 0.3024), (cylinder, 1.8248e-5), (hemisphere, 0.094)])
def test_obstacle_course_on_a_fine_mesh(deflection, element_type, problem, exact):
    found = deflection(*problem(element_type, 48)) / exact
    assert {"S4": 0.985, "S3": 0.96}[element_type] < found < 1.01


def test_lamina_of_a_public_job_of_abaqus(run_shell):
    """A square of S4, one lamina at 30 degrees, is pulled.

    The figures are those of "2 UMAT planestress orthotropic/ABAQUS.msg" of SaschaGolod/SomeBasicV-UMAT on GitHub.
    """
    lamina = "*ELASTIC, TYPE=LAMINA\n181000., 10300., 0.28, 7170., 7170., 3812.\n*FAIL STRESS\n1., 1., 1., 1., 1."
    layer = "*SHELL SECTION, ELSET=SHELL, COMPOSITE\n0.1, 3, M, 30.\n*TRANSVERSE SHEAR STIFFNESS\n5100., 5100., 0."
    deck = ShellDeck("S4", 25, 25, lambda a, b: (50 * a, 50 * b, 0.0), layer, lamina)
    sets = {"P": [676], "FIX": deck.side(i=0), "END": deck.side(i=25)}
    result = run_shell(deck, "*BOUNDARY\nFIX, 1, 6\nEND, 1, 1, 5.", sets)
    text = result.file(".msg").read_text()
    assert float(re.search(r"AVERAGE FORCE +(\S+)", text)[1]) == pytest.approx(99.2, rel=2e-3)
    assert result.history["U2[P]"][-1] == pytest.approx(-7.52, abs=0.005)
    assert re.search(r"LARGEST INCREMENT OF DISP. +-7.52 +AT NODE +676 +DOF  2", text)
    assert re.search(r"LARGEST INCREMENT OF ROTATION +\S+ +AT NODE +652 +DOF  6", text)


@pytest.mark.parametrize("element_type", TYPES)
def test_loads(run_shell, element_type):
    """Reactions of a clamped, tilted plate: pressure along its normal, both surfaces, body force and gravity."""
    normal = np.cross([2, 0, 1], [0, 3, 0])
    area, unit = np.linalg.norm(normal), normal / np.linalg.norm(normal)
    deck = ShellDeck(
        element_type,
        2,
        2,
        lambda a, b: (2 * a, 3 * b, a),
        section(0.5),
        "*ELASTIC\n1000., 0.3\n*DENSITY\n4.",
        before="*SURFACE, NAME=UP\nSHELL, SPOS\n*SURFACE, NAME=DOWN\nSHELL, SNEG\n",
    )
    # elements whose first edge is on the side along (2, 0, 1)
    deck.before += f"*ELSET, ELSET=FIRST\n{'1, 3' if element_type.startswith('S3') else '1, 2'}\n"
    deck.before += "*SURFACE, NAME=EDGE\nFIRST, E1\n"
    length = np.sqrt(5)
    cases = {
        "*DLOAD\nSHELL, P, 7.": 7 * area * unit,
        "*DSLOAD\nUP, P, 7.": -7 * area * unit,
        "*DSLOAD\nDOWN, P, 7.": 7 * area * unit,
        "*DSLOAD\nUP, TRVEC, 3., 0., 1., 0.": 3 * area * np.array([0, 1, 0]),
        "*DLOAD\nSHELL, BX, 2.": 2 * 0.5 * area * np.array([1, 0, 0]),
        "*DLOAD\nSHELL, GRAV, 9., 0., 0., -1.": 9 * 4 * 0.5 * area * np.array([0, 0, -1]),
        "*DSLOAD\nEDGE, EDSHR, 7.": 7 * np.array([2, 0, 1]),
        "*DLOAD\nFIRST, EDNOR1, 7.": 7 * length * np.array([0, 1, 0]),
        "*DSLOAD\nEDGE, EDTRA, 7.": -7 * length * unit,
        "*DSLOAD, FOLLOWER=NO\nEDGE, EDLD, 7., 3., 0., 4.": 7 * length * np.array([0.6, 0, 0.8]),
        "*DLOAD\nFIRST, EDLD1, 7., 3., 0., 4.": 7 * length * np.array([0.6, 0, 0.8]),
    }
    for data, force in cases.items():
        history = run_shell(deck, f"*BOUNDARY\nP, 1, 6\n{data}", {"P": deck.side(i=0)}).history
        found = [sum(v[-1] for k, v in history.items() if k.startswith(f"RF{i}[P")) for i in (1, 2, 3)]
        np.testing.assert_allclose(found, -force, atol=1e-9)


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize(("face", "kind"), [("E1", "KINEMATIC"), ("SPOS", "DISTRIBUTING")])
def test_coupling_to_a_surface(run_shell, element_type, face, kind):
    """An edge, or the whole shell, follows the rotation of a node: a rigid motion, without reaction."""
    deck = ShellDeck(element_type, 2, 1, lambda a, b: (a, b, 0.2 * a), section(0.1), ISOTROPIC.format(1000.0, 0.3))
    deck.before = (
        "*NODE, NSET=REF\n99, 0.3, 0.1, 0.5\n*ELSET, ELSET=FIRST\n1,\n"
        f"*SURFACE, NAME=S\nFIRST, {face}\n*COUPLING, CONSTRAINT NAME=C, REF NODE=REF, SURFACE=S\n*{kind}\n"
    )
    turn = np.array([0.01, -0.02, 0.03])
    lines = [f"REF, {i}, {i}, {value!r}" for i, value in zip((4, 5, 6), turn.tolist(), strict=True)]
    expected = np.cross(turn, deck.coordinates - [0.3, 0.1, 0.5])
    nodes = range(1, len(expected) + 1)
    history = run_shell(deck, "\n".join(["*BOUNDARY", "REF, 1, 3", *lines]), {"P": nodes}).history
    found = np.array([[history[f"U{i}[P:{k}]"][-1] for i in (1, 2, 3)] for k in nodes])
    np.testing.assert_allclose(found, expected, atol=1e-9)


@pytest.mark.parametrize("element_type", TYPES)
def test_vibration_of_a_supported_plate(run_shell, element_type):
    """omega = 2 pi^2/a^2 sqrt(D/(rho t)) (S. Timoshenko, Vibration Problems in Engineering, 1937, section 70)."""
    n = 12
    deck = ShellDeck(
        element_type, n, n, lambda a, b: (10 * a, 10 * b, 0.0), section(0.1), "*ELASTIC\n1000., 0.3\n*DENSITY\n4."
    )
    sets = {"X": deck.side(i=0) + deck.side(i=n), "Y": deck.side(j=0) + deck.side(j=n)}
    step = "*STEP\n*FREQUENCY\n1\n*BOUNDARY\nX, 1, 4\nX, 6\nY, 1, 3\nY, 5, 6\n*END STEP"
    found = run_shell(deck, "", sets, step=step).history["EIGFREQ"][-1]
    stiffness = 1000 * 0.1**3 / 12 / (1 - 0.3**2)
    exact = np.pi / 100 * np.sqrt(stiffness / 0.4)
    # triangles of a regular mesh are stiffer than squares
    assert found == pytest.approx(exact, rel=0.05 if element_type.startswith("S3") else 0.01)


UMAT = """\
      include '{here}/umat.inc'
      real*8 e, nu
      integer i, j
      e = props(1)
      nu = props(2)
      ddsdde = 0
      ddsdde(1,1) = e/(1-nu**2)
      ddsdde(2,2) = ddsdde(1,1)
      ddsdde(1,2) = nu*ddsdde(1,1)
      ddsdde(2,1) = ddsdde(1,2)
      ddsdde(3,3) = e/2/(1+nu)
      do i = 1, ntens
        do j = 1, ntens
          stress(i) = stress(i) + ddsdde(i,j)*dstran(j)
        end do
      end do
      sse = 0.5d0*dot_product(stress, stran + dstran)
      statev(1) = ndi
      statev(2) = nshr
      statev(3) = ntens
      statev(4) = noel
      statev(5) = npt
      statev(6) = layer
      statev(7) = kspt
      statev(8:10) = coords
      statev(11) = celent
      statev(12) = drot(1,1) + drot(2,2) + drot(3,3)
      statev(13) = dfgrd1(1,1) + dfgrd1(2,2) + dfgrd1(3,3)
      end
"""


@pytest.mark.parametrize("element_type", ["S4", "S4R", "S3", "S8R"])
def test_umat(run_shell, element_type):
    """Its arguments at each section point; a laminate of it does what elastic layers do."""
    layers = "\n*SHELL SECTION, ELSET=SHELL, COMPOSITE\n0.2, 3, M, 30.\n0.4, 5, M, -10."
    user = UMAT.format(here=Path(__file__).parents[1])
    given = {
        "elastic": ("*ELASTIC\n1000., 0.3", ""),
        "user": (
            "*USER MATERIAL, CONSTANTS=2\n1000., 0.3\n*DEPVAR\n13",
            f"\n*TRANSVERSE SHEAR STIFFNESS\n{5 / 6 * 0.6 * 1000 / 2.6}, {5 / 6 * 0.6 * 1000 / 2.6}"
            f"\n*HOURGLASS STIFFNESS\n{0.005 * 1000 / 2.6}",
        ),
    }
    found = {}
    for name, (material, more) in given.items():
        deck = ShellDeck(element_type, 1, 1, lambda a, b: (2 * a, b, 0.0), layers.strip() + more, material)
        data = "*BOUNDARY\nFIX, 1, 6\n*CLOAD\nP, 3, 0.01\nP, 1, 0.1"
        sets = {"P": deck.side(i=1), "FIX": deck.side(i=0)}
        found[name] = run_shell(deck, data, sets, user=user if name == "user" else None)
    # the enhanced and hourglass modes of UMAT are those of a Poisson's ratio of zero
    for dof in (1, 3):
        one, other = (found[name].history[f"U{dof}[P:2]"][-1] for name in ("user", "elastic"))
        assert one == pytest.approx(other, rel=1e-6 if element_type == "S3" else 0.05)
    points = SHELL[element_type].points
    # of second-order elements CELENT is half of the typical length (User Subroutines Guide, UMAT)
    length = np.sqrt(2.0 if element_type != "S3" else 1.0) / (2 if element_type == "S8R" else 1)
    expected = [2, 1, 3, None, (points + 1) / 2, None, None, None, None, None, length, 3, 3]
    for side, layer, number, z in (("SNEG", 1, 1, -0.3), ("SPOS", 2, 5, 0.3)):
        expected[5:7], expected[9] = [layer, number], z
        for k, value in enumerate(expected, 1):
            if value is not None:
                np.testing.assert_allclose(found["user"].field(f"SDV{k}_{side}"), value, rtol=1e-12, err_msg=str(k))
    labels = found["user"].field("SDV4_SNEG")
    np.testing.assert_allclose(labels, np.arange(1, len(labels) + 1))
    # the mean of the points is that of the corners
    middle = [[1, 0.5]] if element_type != "S3" else [[4 / 3, 1 / 3], [2 / 3, 2 / 3]]
    places = np.column_stack([found["user"].field(f"SDV{k}_SPOS") for k in (8, 9)])
    np.testing.assert_allclose(places, middle, rtol=1e-12)


def test_print(run_shell):
    """*EL PRINT: stresses at the first and last section point, section forces once for each point."""
    deck = ShellDeck("S4R", 1, 1, lambda a, b: (a, b, 0.0), section(0.5), ISOTROPIC.format(100.0, 0.0))
    step = STEP.replace("*OUTPUT, FIELD", "*EL PRINT\nS, SF\n*OUTPUT, FIELD")
    data = "*BOUNDARY\nFIX, 1, 6\nEND, 1, 1, 0.01\nEND, 2, 4\nEND, 5, 5, 0.02\nEND, 6"
    result = run_shell(deck, data, {"P": [1], "END": deck.side(i=1), "FIX": deck.side(i=0)}, step=step)
    lines = [line.split() for line in result.file(".dat").read_text().splitlines()]
    rows = [line for line in lines if line[:2] == ["1", "1"]]
    assert ["ELEMENT", "PT", "SEC", "FOOT-", "S11", "S22", "S12"] in lines
    assert ["ELEMENT", "PT", "FOOT-", "SF1", "SF2", "SF3", "SF4", "SF5", "SM1", "SM2", "SM3"] in lines
    assert [line[2] for line in rows if len(line) == 6] == ["1", "5"]
    # strain 0.01 and curvature 0.02
    np.testing.assert_allclose([float(line[3]) for line in rows if len(line) == 6], [1 - 0.5, 1 + 0.5], rtol=1e-3)
    forces = next(line for line in rows if len(line) == 10)
    np.testing.assert_allclose([float(forces[2]), float(forces[7])], [0.5, 100 * 0.5**3 / 12 * 0.02], rtol=1e-3)
