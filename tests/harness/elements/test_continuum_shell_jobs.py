# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Continuum shells in whole jobs: patch tests, the obstacle course, NLGEOM, loads, UMAT, delamination, and output.

Figures of the obstacle course: R.H. MacNeal, R.L. Harder, Finite Elements in Analysis and Design 1 (1985) 3; the
pinched cylinder with end diaphragms: T. Belytschko and others, Computer Methods in Applied Mechanics and Engineering 51
(1985) 221. With NLGEOM: K.Y. Sze, X.H. Liu, S.H. Lo, Finite Elements in Analysis and Design 40 (2004) 1551.
"""

import re
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from shell_decks import ThickDeck
from test_shell_jobs import PATCH, UMAT

from uel.delamination import theory
from uel.model.element_types import CONTINUUM_SHELL

TYPES = tuple(CONTINUUM_SHELL)
STEP = "*STEP\n*STATIC\n{}\n*OUTPUT, FIELD\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=P\nU\nRF\n*END STEP"
CONTROLS = "\n*CONTROLS, PARAMETERS=FIELD\n1e-4, , , , 1e-4"
LARGE = STEP.replace("*STEP\n*STATIC", f"*STEP, NLGEOM, INC=200\n*STATIC\n0.1, 1., 1e-6{CONTROLS}")
"""The forces of bending are pairs at both faces, large beside those of the load: the default criterion is loose."""
ISOTROPIC = "*ELASTIC\n{}, {}"


def section(thickness, more=""):
    return f"*SHELL SECTION, ELSET=SHELL, MATERIAL=M{more}\n{thickness}"


@pytest.fixture
def run_shell(run_deck):
    def run_shell(deck, data, sets, *, user=None, step=STEP):
        result = run_deck(deck.text(step.format(data), sets), user)
        assert result.completed
        return result

    return run_shell


@pytest.fixture
def deflection(run_shell):
    """Magnitude of the mean displacement of set P, which has nodes of both faces, at the end of a job."""

    def deflection(deck, data, sets, dof, **options):
        history = run_shell(deck, data, sets, **options).history
        return abs(np.mean([values[-1] for name, values in history.items() if name.startswith(f"U{dof}[P")]))

    return deflection


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("bending", [False, True])
def test_patch(run_shell, element_type, bending):
    """The patch of MacNeal and Harder: their displacements at the edges give theirs inside, and their stresses.

    Directors of the edges are those of a thin plate.
    """
    thickness = 0.001
    deck = ThickDeck(
        element_type,
        3,
        3,
        lambda a, b, c: (0.24 * a, 0.12 * b, thickness * (c - 0.5)),
        section(thickness, ", POISSON=0.25"),
        ISOTROPIC.format(1e6, 0.25),
        moved=PATCH,
    )
    x, y, z = deck.coordinates.T
    if bending:
        # the strain across is quadratic in z, and as large as at both faces
        u = 1e-3 * np.column_stack([-z * (x + y / 2), -z * (y + x / 2), (x**2 + x * y + y**2) / 2])
    else:
        across = -0.25 / 0.75 * 2e-3 * z
        u = np.column_stack([1e-3 * (x + y / 2), 1e-3 * (y + x / 2), across])
    edge = sorted({node - 1 for end in (0, 3) for node in deck.line(i=end) + deck.line(j=end)})
    inner = [k for k in range(len(x)) if k not in edge]
    data = "*BOUNDARY\n" + "\n".join(f"{k + 1}, {i + 1}, {i + 1}, {u[k, i]:.17g}" for k in edge for i in range(3))
    result = run_shell(deck, data, {"P": [k + 1 for k in inner]})
    found = np.array([[result.history[f"U{i}[P:{k + 1}]"][-1] for i in (1, 2, 3)] for k in inner])
    np.testing.assert_allclose(found, u[inner], rtol=1e-7, atol=1e-7 * abs(u).max())
    top = 1000 * thickness * np.array([2 / 3, 2 / 3, 0.2]) if bending else np.array([4000 / 3, 4000 / 3, 400.0])
    for side, sign in (("SPOS", -1 if bending else 1), ("SNEG", 1)):
        for name, value in zip(("S11", "S22", "S12"), top, strict=True):
            np.testing.assert_allclose(result.field(f"{name}_{side}"), sign * value, rtol=1e-5)


@pytest.mark.parametrize("element_type", TYPES)
def test_turned(run_shell, element_type):
    """A warped plate of an isotropic material deflects by the same vectors wherever it points."""
    load = np.array([2.0, 1.0, 0.2])

    def found(turn):
        deck = ThickDeck(
            element_type,
            *(2, 2),
            lambda a, b, c: tuple(turn.apply([2 * a, 1.5 * b + 0.2 * a, 0.8 * a * b + 0.1 * c])),
            section(0.1),
            ISOTROPIC.format(1e4, 0.3),
            moved={(1, 1): (0.06, -0.04)},
        )
        forces = "".join(f"\nP, {i + 1}, {value:.17g}" for i, value in enumerate(turn.apply(load)))
        sets = {"P": deck.line(i=2), "FIX": deck.line(i=0)}
        history = run_shell(deck, f"*BOUNDARY\nFIX, 1, 3\n*CLOAD{forces}", sets).history
        return turn.inv().apply([[history[f"U{i}[P:{node}]"][-1] for i in (1, 2, 3)] for node in sets["P"]])

    first = found(Rotation.identity())
    turned = found(Rotation.from_rotvec([0.7, -0.4, 1.1]))
    np.testing.assert_allclose(turned, first, rtol=0, atol=1e-8 * np.abs(first).max())


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize(("dof", "exact"), [(1, 3e-5), (2, 0.1081), (3, 0.4321)])
def test_straight_cantilever(deflection, element_type, dof, exact):
    """6 x 1 elements: extension, bending in the plane and out of it; triangles of constant strain lock in the plane.

    The thickness is free at the clamped end, as that of a conventional shell is.
    """
    place = lambda a, b, c: (6 * a, 0.2 * b, 0.1 * c)  # noqa: E731
    deck = ThickDeck(element_type, 6, 1, place, section(0.1), ISOTROPIC.format(1e7, 0.3))
    start = deck.line(i=0)
    sets = {"P": deck.line(i=6), "FIX": start, "LOW": start[: len(start) // 2]}
    found = deflection(deck, f"*BOUNDARY\nFIX, 1, 2\nLOW, 3\n*CLOAD\nP, {dof}, 0.25", sets, dof)
    assert found < 1.01 * exact
    assert found > (0.02 if element_type == "SC6R" and dof == 2 else 0.97) * exact


def scordelis(element_type, n):
    def place(a, b, c):
        angle, radius = np.radians(40 * a), 25 + 0.25 * (c - 0.5)
        return radius * np.sin(angle), b * 25, radius * np.cos(angle)

    deck = ThickDeck(element_type, n, n, place, section(0.25), "*ELASTIC\n4.32e8, 0.\n*DENSITY\n360.")
    sets = {"P": [deck.node(n, n, k) for k in (0, 1)], "RIGID": deck.line(j=0), "MIDDLE": deck.line(j=n)}
    sets["CROWN"] = deck.line(i=0)
    data = "*BOUNDARY\nRIGID, 1\nRIGID, 3\nMIDDLE, 2\nCROWN, 1\n*DLOAD\nSHELL, GRAV, 1., 0., 0., -1."
    return deck, data, sets, 3


def cylinder(element_type, n):
    def place(a, b, c):
        angle, radius = np.pi / 2 * a, 300 + 3 * (c - 0.5)
        return radius * np.sin(angle), 300 * b, radius * np.cos(angle)

    deck = ThickDeck(element_type, n, n, place, section(3.0), ISOTROPIC.format(3e6, 0.3))
    sets = {"P": [deck.node(0, n, k) for k in (0, 1)], "RIGID": deck.line(j=0), "MIDDLE": deck.line(j=n)}
    sets |= {"X": deck.line(i=0), "Z": deck.line(i=n)}
    return deck, "*BOUNDARY\nRIGID, 1\nRIGID, 3\nMIDDLE, 2\nX, 1\nZ, 3\n*CLOAD\nP, 3, -0.125", sets, 3


def hemisphere(element_type, n, force=1.0):
    def place(a, b, c):
        around, up, radius = np.pi / 2 * a, np.radians(72 * b), 10 + 0.04 * (c - 0.5)
        flat = radius * np.cos(up)
        return flat * np.cos(around), flat * np.sin(around), radius * np.sin(up)

    deck = ThickDeck(element_type, n, n, place, section(0.04), ISOTROPIC.format(6.825e7, 0.3))
    sets = {"P": [deck.node(0, 0, k) for k in (0, 1)], "Q": [deck.node(n, 0, k) for k in (0, 1)]}
    sets |= {"TOP": [deck.node(0, n, 0)], "Y": deck.line(i=0), "X": deck.line(i=n)}
    data = f"*BOUNDARY\nY, 2\nX, 1\nTOP, 3\n*CLOAD\nP, 1, {force / 2!r}\nQ, 2, {-force / 2!r}"
    return deck, data, sets, 1


def twisted(element_type, n, dof):
    def place(a, b, c):
        angle, across, up = np.pi / 2 * a, 1.1 * (b - 0.5), 0.32 * (c - 0.5)
        cos, sin = np.cos(angle), np.sin(angle)
        return 12 * a, across * cos - up * sin, across * sin + up * cos

    m = n // 6
    deck = ThickDeck(element_type, n, m, place, section(0.32), ISOTROPIC.format(29e6, 0.22))
    sets = {"P": [deck.node(n, m // 2, k) for k in (0, 1)], "FIX": deck.line(i=0)}
    shares = {j: 0.5 / m * (0.5 if j in (0, m) else 1) for j in range(m + 1)}
    loads = [f"{deck.node(n, j, k)}, {dof}, {share!r}" for j, share in shares.items() for k in (0, 1)]
    return deck, "\n".join(["*BOUNDARY\nFIX, 1, 3\n*CLOAD", *loads]), sets, dof


@pytest.mark.parametrize(
    ("problem", "exact", "low", "high"),
    [
        (scordelis("SC8R", 8), 0.3024, 0.99, 1.01),
        (cylinder("SC8R", 16), 1.8248e-5, 0.92, 1.0),
        (hemisphere("SC8R", 8), 0.094, 0.98, 1.01),
        (twisted("SC8R", 12, 3), 5.424e-3, 0.98, 1.0),
        (twisted("SC8R", 12, 2), 1.754e-3, 0.97, 1.0),
        (scordelis("SC6R", 16), 0.3024, 0.93, 1.01),
        (hemisphere("SC6R", 16), 0.094, 0.85, 1.0),
        (twisted("SC6R", 12, 3), 5.424e-3, 0.97, 1.0),
    ],
    ids=lambda value: value[0].kind + str(value[0].n) if isinstance(value, tuple) else None,
)
def test_obstacle_course(deflection, problem, exact, low, high):
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
    """Problem, published displacement, cells along the first side, ratios of SC8R and SC6R."""
    page = (Path(__file__).parents[3] / "harness" / "uel" / "elements" / "families" / "continuum-shells.md").read_text()
    name, exact = "", 0.0
    for what, number, mesh, *ratios in re.findall(
        r"^\| (?:([^|]+), ([\d.e-]+))? *\| (\d+) x \d+ \| ([\d.]+) \| ([\d.]+) \|$", page, re.MULTILINE
    ):
        if what:
            name, exact = what, float(number)
        yield name, exact, int(mesh), [float(ratio) for ratio in ratios]


@pytest.mark.long
@pytest.mark.parametrize(("name", "exact", "n", "ratios"), list(rows_of_the_page()))
def test_page(deflection, name, exact, n, ratios):
    """The table of continuum-shells.md, to its last digit."""
    for element_type, ratio in zip(("SC8R", "SC6R"), ratios, strict=True):
        assert deflection(*PROBLEMS[name](element_type, n)) / exact == pytest.approx(ratio, abs=0.0006), element_type


@pytest.mark.parametrize("element_type", TYPES)
def test_large_deflection_of_a_cantilever(run_shell, element_type):
    """Sze and others: 10 x 1 x 0.1 with an end force of 4 moves by 6.698 down and by 3.286 back."""
    n = 10
    deck = ThickDeck(element_type, n, 1, lambda a, b, c: (10 * a, b, 0.1 * c), section(0.1), "*ELASTIC\n1.2e6, 0.")
    end = deck.line(i=n)
    sets = {"P": end, "FIX": deck.line(i=0)}
    history = run_shell(deck, "*BOUNDARY\nFIX, 1, 3\n*CLOAD\nP, 3, 1.", sets, step=LARGE).history
    back, down = (np.mean([history[f"U{i}[P:{node}]"][-1] for node in end]) for i in (1, 3))
    assert down == pytest.approx(6.698, rel=0.01)
    assert back == pytest.approx(-3.286, rel=0.01)


@pytest.mark.long
def test_large_deflection_of_a_hemisphere(run_shell):
    """Sze and others: forces of 400 move their places by 4.067 outward and by 8.178 inward; the shares of
    this mesh are regression."""
    deck, data, sets, _ = hemisphere("SC8R", 16, force=200.0)
    sets |= {"R": sets["P"], "P": sets["P"] + sets["Q"]}
    history = run_shell(deck, data.replace("P, 1,", "R, 1,"), sets, step=LARGE).history
    first, second = deck.node(0, 0, 0), deck.node(16, 0, 0)
    assert history[f"U1[P:{first}]"][-1] == pytest.approx(0.976 * 4.067, rel=2e-3)
    assert history[f"U2[P:{second}]"][-1] == pytest.approx(-0.949 * 8.178, rel=2e-3)


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("nlgeom", [False, True])
def test_loads(run_shell, element_type, nlgeom):
    """Reactions of a tilted block that is held everywhere: pressures on its faces, body force and gravity."""
    normal = np.cross([2, 0, 1], [0, 3, 0])
    area, unit = np.linalg.norm(normal), normal / np.linalg.norm(normal)
    layers = "*SHELL SECTION, ELSET=SHELL, COMPOSITE\n0.1, 3, M\n0.3, 3, LIGHT"
    light = "\n*MATERIAL, NAME=LIGHT\n*ELASTIC\n1000., 0.3\n*DENSITY\n2."
    deck = ThickDeck(
        element_type,
        1,
        1,
        lambda a, b, c: tuple(np.array([2 * a, 3 * b, a]) + 0.4 * c * unit),
        layers,
        "*ELASTIC\n1000., 0.3\n*DENSITY\n4." + light,
    )
    deck.section += "\n*SURFACE, NAME=UP\nSHELL, S2"
    cases = {"*DLOAD\nSHELL, P1, 7.": 7 * area * unit, "*DSLOAD\nUP, P, 7.": -7 * area * unit}
    if not nlgeom:
        cases["*DLOAD\nSHELL, BX, 2."] = 2 * 0.4 * area * np.array([1, 0, 0])
        cases["*DLOAD\nSHELL, GRAV, 9., 0., 0., -1."] = 9 * 2.5 * 0.4 * area * np.array([0, 0, -1])
    if element_type == "SC8R":
        # the side along the first edge, from which the second one points inward
        cases["*DLOAD\nSHELL, P3, 7."] = 7 * 0.4 * np.sqrt(5) * np.array([0, 1, 0])
    step = STEP.replace("*STEP", "*STEP, NLGEOM", 1) if nlgeom else STEP
    for data, force in cases.items():
        history = run_shell(deck, f"*BOUNDARY\nP, 1, 3\n{data}", {"P": range(1, 9)}, step=step).history
        found = [sum(v[-1] for k, v in history.items() if k.startswith(f"RF{i}[P")) for i in (1, 2, 3)]
        np.testing.assert_allclose(found, -force, atol=1e-9)


@pytest.mark.parametrize("element_type", TYPES)
def test_vibration_of_a_supported_plate(run_shell, element_type):
    """omega = 2 pi^2/a^2 sqrt(D/(rho t)) (S. Timoshenko, Vibration Problems in Engineering, 1937, section 70)."""
    n = 12
    material = "*ELASTIC\n1000., 0.3\n*DENSITY\n4."
    deck = ThickDeck(element_type, n, n, lambda a, b, c: (10 * a, 10 * b, 0.1 * c), section(0.1), material)
    sets = {"X": deck.line(i=0) + deck.line(i=n), "Y": deck.line(j=0) + deck.line(j=n)}
    step = "*STEP\n*FREQUENCY\n1\n*BOUNDARY\nX, 2, 3\nY, 1\nY, 3\n*END STEP"
    found = run_shell(deck, "", sets, step=step).history["EIGFREQ"][-1]
    stiffness = 1000 * 0.1**3 / 12 / (1 - 0.3**2)
    exact = np.pi / 100 * np.sqrt(stiffness / 0.4)
    # triangles of a regular mesh are stiffer than squares
    assert found == pytest.approx(exact, rel=0.05 if element_type == "SC6R" else 0.01)


@pytest.mark.parametrize("element_type", TYPES)
def test_free_fall(run_shell, element_type):
    """g t^2/2 of a free plate, which the trapezoidal rule has exactly."""
    deck = ThickDeck(
        element_type, 1, 1, lambda a, b, c: (a, b, 0.1 * c), section(0.1), "*ELASTIC\n1000., 0.3\n*DENSITY\n4."
    )
    step = "*STEP, NLGEOM\n*DYNAMIC, DIRECT, ALPHA=0.\n0.25, 1.\n*DLOAD\nSHELL, GRAV, 10., 0., 0., -1.\n"
    step += "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=P\nU\n*END STEP"
    history = run_shell(deck, "", {"P": range(1, 9)}, step=step).history
    for node in range(1, 9):
        np.testing.assert_allclose(history[f"U3[P:{node}]"][-1], -5, rtol=1e-9)


@pytest.mark.parametrize("element_type", TYPES)
def test_buckling_of_a_column(run_shell, element_type):
    """Euler: pi^2 E I/(4 l^2) of a strip that is held at one end."""
    n = 10
    deck = ThickDeck(element_type, n, 1, lambda a, b, c: (10 * a, b, 0.2 * c), section(0.2), "*ELASTIC\n1000., 0.")
    end = deck.line(i=n)
    sets = {"P": end, "FIX": deck.line(i=0), "ALL": range(1, len(deck.coordinates) + 1)}
    step = "*STEP\n*BUCKLE\n1\n*BOUNDARY\nFIX, 1, 3\nALL, 2\n*CLOAD\nP, 1, -0.25\n*END STEP"
    found = run_shell(deck, "", sets, step=step).history["EIGVAL"][-1]
    assert found == pytest.approx(np.pi**2 * 1000 * 0.2**3 / 12 / 400, rel=0.01 if element_type == "SC8R" else 0.03)


@pytest.mark.parametrize("element_type", TYPES)
def test_umat(run_shell, element_type):
    """Its arguments at each section point; a laminate of it does what elastic layers do."""
    layers = "*SHELL SECTION, ELSET=SHELL, COMPOSITE{}\n0.2, 3, M, 30.\n0.4, 5, M, -10."
    user = UMAT.format(here=Path(__file__).parents[1])
    given = {
        "elastic": ("*ELASTIC\n1000., 0.3", layers.format("")),
        "user": (
            "*USER MATERIAL, CONSTANTS=2\n1000., 0.3\n*DEPVAR\n13",
            layers.format(f", THICKNESS MODULUS={1000 / 1.3}")
            + f"\n*TRANSVERSE SHEAR STIFFNESS\n{5 / 6 * 0.6 * 1000 / 2.6}, {5 / 6 * 0.6 * 1000 / 2.6}"
            f"\n*HOURGLASS STIFFNESS\n{0.005 * 1000 / 2.6}",
        ),
    }
    found = {}
    for name, (material, text) in given.items():
        deck = ThickDeck(element_type, 1, 1, lambda a, b, c: (2 * a, b, 0.6 * c), text, material)
        data = "*BOUNDARY\nFIX, 1, 3\n*CLOAD\nP, 3, 0.005\nP, 1, 0.05"
        sets = {"P": deck.line(i=1), "FIX": deck.line(i=0)}
        found[name] = run_shell(deck, data, sets, user=user if name == "user" else None)
    # the hourglass modes of UMAT are those of a Poisson's ratio of zero
    for dof in (1, 3):
        one, other = (found[name].history[f"U{dof}[P:2]"][-1] for name in ("user", "elastic"))
        assert one == pytest.approx(other, rel=1e-6 if element_type == "SC6R" else 0.05)
    length = np.sqrt(2.0 if element_type == "SC8R" else 1.0)
    expected = [2, 1, 3, None, 1, None, None, None, None, None, length, 3, 3]
    for side, layer, number, z in (("SNEG", 1, 1, 0.0), ("SPOS", 2, 5, 0.6)):
        expected[5:7], expected[9] = [layer, number], z
        for k, value in enumerate(expected, 1):
            if value is not None:
                np.testing.assert_allclose(
                    found["user"].field(f"SDV{k}_{side}"), value, rtol=1e-12, atol=1e-14, err_msg=str(k)
                )
    middle = [[1, 0.5]] if element_type == "SC8R" else [[4 / 3, 1 / 3], [2 / 3, 2 / 3]]
    places = np.column_stack([found["user"].field(f"SDV{k}_SPOS") for k in (8, 9)])
    np.testing.assert_allclose(places, middle, rtol=1e-12)


INTERFACE = """\
*MATERIAL, NAME=GLUE
*ELASTIC, TYPE=TRACTION
1e5, 1e5, 1e5
*DAMAGE INITIATION, CRITERION=QUADS
20., 20., 20.
*DAMAGE EVOLUTION, TYPE=ENERGY
0.3,
*SECTION CONTROLS, NAME=SLOW, VISCOSITY=5e-5
*COHESIVE SECTION, ELSET=GLUE, MATERIAL=GLUE, RESPONSE=TRACTION SEPARATION, CONTROLS=SLOW
"""


def test_double_cantilever_beam(run_deck):
    """Two arms of SC8R with COH3D8 between them: the load of corrected beam theory while the crack grows.

    J.G. Williams, Composites Science and Technology 35 (1989) 367.
    """
    length, start, height, cells, opening = 36.0, 20.0, 1.5, 72, 1.6
    arms = theory.Arms(width=1.0, height=height, e11=120e3, e22=10e3, g12=5e3)
    lamina = "*MATERIAL, NAME=M\n*ELASTIC, TYPE=LAMINA\n120e3, 10e3, 0.3, 5e3, 5e3, 4e3"
    count = 2 * (cells + 1)
    levels = [-height, 0.0, 0.0, height]
    nodes = [(length * i / cells, j, z) for z in levels for j in (0, 1) for i in range(cells + 1)]

    def cell(level, i):
        low = level * count + i + 1
        return [low, low + 1, low + cells + 2, low + cells + 1]

    lines = ["*NODE", *(f"{k}, {x!r}, {y!r}, {z!r}" for k, (x, y, z) in enumerate(nodes, 1))]
    lines += ["*ELEMENT, TYPE=SC8R, ELSET=SHELL"]
    label = 0
    for level in (0, 2):
        for i in range(cells):
            label += 1
            lines.append(", ".join(map(str, [label, *cell(level, i), *cell(level + 1, i)])))
    lines += ["*ELEMENT, TYPE=COH3D8, ELSET=GLUE"]
    for i in range(cells):
        if length * i / cells >= start:
            label += 1
            lines.append(", ".join(map(str, [label, *cell(1, i), *cell(2, i)])))
    ends = {"LOW": [1, cells + 2]}
    ends["HIGH"] = [node + 3 * count for node in ends["LOW"]]
    ends["CLAMP"] = [node + cells for k in range(4) for node in (1 + k * count, 1 + k * count + cells + 1)]
    for name, members in ends.items():
        lines += [f"*NSET, NSET={name}", ", ".join(map(str, members))]
    lines += [lamina, "*SHELL SECTION, ELSET=SHELL, MATERIAL=M", f"{height}, 3", INTERFACE.strip()]
    lines += ["*BOUNDARY", "CLAMP, 1, 3", "*STEP, INC=500", "*STATIC", "0.05, 1., 1e-6, 0.05"]
    lines += ["*BOUNDARY", f"HIGH, 3, 3, {opening / 2}", f"LOW, 3, 3, {-opening / 2}"]
    lines += ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=HIGH", "U", "RF", "*END STEP", ""]
    result = run_deck(lines)
    assert result.completed
    history = result.history
    force = sum(values for name, values in history.items() if name.startswith("RF3"))
    opened = history[f"U3[HIGH:{ends['HIGH'][0]}]"]
    # the onset is sudden, and delayed by the viscosity
    growing = opened > 1.3 * theory.dcb_displacement(arms, start, 0.3)
    assert growing.sum() > 5
    np.testing.assert_allclose(force[growing], theory.dcb_curve(arms, start, 0.3, opened[growing]), rtol=0.03)
