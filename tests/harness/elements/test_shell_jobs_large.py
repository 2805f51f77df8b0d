# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Shells with NLGEOM in whole jobs: elastica, rolling up, published shells, rotations and pressures that turn.

Figures: K.Y. Sze, X.H. Liu, S.H. Lo, Finite Elements in Analysis and Design 40 (2004) 1551, at the largest load of each
problem; they come from S4R of Abaqus on fine meshes.
"""

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_bvp
from shell_decks import ShellDeck
from test_shell_jobs import UMAT

from uel.model.element_types import SHELL

TYPES = tuple(SHELL)
LIGHT = [pytest.param(name, marks=[pytest.mark.long] if name == "S8R" else []) for name in TYPES]
"""Elements of eight nodes take ten times as long as those of four."""
STEP = """\
*STEP, NLGEOM, INC=200
*STATIC
{first}, 1., 1e-6
{data}
*OUTPUT, FIELD
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=P
U
RF
*END STEP"""


def section(thickness):
    return f"*SHELL SECTION, ELSET=SHELL, MATERIAL=M\n{thickness}"


@pytest.fixture
def ends(run_deck):
    """Displacements (and reactions) of set P at the end of a job, by name."""

    def ends(deck, data, sets, *, first=0.1):
        result = run_deck(deck.text(STEP.format(first=first, data=data), sets))
        assert result.completed
        return {name: values[-1] for name, values in result.history.items()}

    return ends


def cantilever(element_type, n):
    """10 x 1 x 0.1, E = 1.2e6 and nu = 0, clamped at x = 0."""
    deck = ShellDeck(element_type, n, 1, lambda a, b: (10 * a, b, 0.0), section(0.1), "*ELASTIC\n1.2e6, 0.")
    return deck, {"P": deck.side(i=n), "FIX": deck.side(i=0)}


def end_loads(deck, side, dof, load):
    """*CLOAD of a load that is distributed over a side."""
    rows = [f"{node}, {dof}, {load * share!r}" for node, share in zip(side, deck.shares(side), strict=True)]
    return "\n".join(["*CLOAD", *rows])


def elastica(load):
    """Shortening and deflection of a beam of length 1 by a force at its end, over EI: EI angle'' = -P cos(angle)."""
    at = np.linspace(0, 1, 201)
    found = solve_bvp(
        lambda _, y: np.array([y[1], -load * np.cos(y[0]), np.cos(y[0]), np.sin(y[0])]),
        lambda start, end: np.array([start[0], end[1], start[2], start[3]]),
        at,
        np.array([at, 1 - at, at, at**2]),
        tol=1e-8,
    )
    assert found.success
    return 1 - found.y[2, -1], found.y[3, -1]


@pytest.mark.parametrize("element_type", LIGHT)
def test_end_force(ends, element_type):
    """16 elements: within 0.2 % of the elastica; Sze and others have 3.286 and 6.698."""
    deck, sets = cantilever(element_type, 16)
    found = ends(deck, "*BOUNDARY\nFIX, 1, 6\n" + end_loads(deck, sets["P"], 3, 4.0), sets)
    short, deflection = elastica(4.0)
    for node in sets["P"]:
        assert -found[f"U1[P:{node}]"] == pytest.approx(10 * short, rel=2e-3)
        assert found[f"U3[P:{node}]"] == pytest.approx(10 * deflection, rel=2e-3)


@pytest.mark.sample(2)
@pytest.mark.parametrize("element_type", ["S4", "S8R"])
def test_load_on_an_edge_that_does_not_turn(ends, element_type):
    """That of the elastica, per length of the edge of 1."""
    deck, sets = cantilever(element_type, 16)
    deck.before = "*ELSET, ELSET=LAST\n16,\n*SURFACE, NAME=EDGE\nLAST, E2\n"
    found = ends(deck, "*BOUNDARY\nFIX, 1, 6\n*DSLOAD, FOLLOWER=NO\nEDGE, EDLD, 4., 0., 0., 1.", sets)
    assert found[f"U3[P:{sets['P'][0]}]"] == pytest.approx(10 * elastica(4.0)[1], rel=2e-3)


@pytest.mark.sample(2)
@pytest.mark.parametrize("element_type", LIGHT)
def test_end_moment_rolls_up_a_strip(ends, element_type):
    """To half a circle: a moment pi EI/L about a fixed axis."""
    deck, sets = cantilever(element_type, 16)
    moment = np.pi * 100 / 10
    found = ends(deck, "*BOUNDARY\nFIX, 1, 6\n" + end_loads(deck, sets["P"], 5, -moment), sets)
    for node in sets["P"]:
        assert -found[f"UR2[P:{node}]"] == pytest.approx(np.pi, rel=1e-3)
        assert -found[f"U1[P:{node}]"] == pytest.approx(10, rel=1e-3)
        # a polygon of 16 sides is 0.16 % less high
        assert found[f"U3[P:{node}]"] == pytest.approx(20 / np.pi, rel=3e-3)


@pytest.mark.parametrize("element_type", TYPES)
def test_prescribed_rotation_moves_a_strip_without_force(ends, element_type):
    """About an axis in space, by 150 degrees: the clamped side is on the axis."""
    deck, sets = cantilever(element_type, 4)
    axis = np.array([0.0, 1.0, 0.0])
    vector = np.radians(150) * axis
    rows = [f"FIX, {i}, {i}, {value!r}" for i, value in zip((4, 5, 6), vector.tolist(), strict=True)]
    nodes = range(1, len(deck.coordinates) + 1)
    found = ends(deck, "\n".join(["*BOUNDARY", "FIX, 1, 3", *rows]), sets | {"P": nodes})
    for node, place in zip(nodes, deck.coordinates, strict=True):
        turned = [np.cos(vector[1]) * place[0], place[1], -np.sin(vector[1]) * place[0]]
        moved = [found[f"U{i}[P:{node}]"] for i in (1, 2, 3)]
        np.testing.assert_allclose(moved, turned - place, atol=1e-6)
        # EI = 100 over the length of 10
        assert max(abs(found[f"{name}{i}[P:{node}]"]) for name in ("RF", "RM") for i in (1, 2, 3)) < 1e-4


@pytest.mark.parametrize("element_type", ["S4", "S3", "S8R"])
@pytest.mark.parametrize("load", ["*DLOAD\nSHELL, P, -1e-4", "*DSLOAD\nUP, P, 1e-4"])
def test_pressure_turns_with_the_shell(ends, element_type, load):
    """A strip that is turned by 90 degrees: the reactions are the pressure times the area, along its normal now."""
    deck, sets = cantilever(element_type, 2)
    deck.before = "*SURFACE, NAME=UP\nSHELL, SPOS\n"
    data = f"*BOUNDARY\nFIX, 1, 4\nFIX, 6\nFIX, 5, 5, {np.pi / 2!r}\n{load}"
    found = ends(deck, data, sets | {"P": sets["FIX"]})
    force = [sum(value for name, value in found.items() if name.startswith(f"RF{i}[P")) for i in (1, 2, 3)]
    # the normal was 3; the moment of 5e-3 bends the strip by 2e-4
    np.testing.assert_allclose(force, [1e-3, 0, 0], atol=1e-6)


@pytest.mark.parametrize("element_type", ["S4", "S4R"])
def test_umat(run_deck, element_type):
    """A strip that stands up: COORDS are where the section points are now, and what turns with the element does not."""
    user = UMAT.format(here=Path(__file__).parents[1])
    more = "\n*TRANSVERSE SHEAR STIFFNESS\n32., 32.\n*HOURGLASS STIFFNESS\n2."
    material = "*USER MATERIAL, CONSTANTS=2\n1000., 0.3\n*DEPVAR\n13"
    deck = ShellDeck(element_type, 1, 1, lambda a, b: (2 * a, b, 0.0), section(0.1) + more, material)
    data = f"*BOUNDARY\nFIX, 1, 4\nFIX, 6\nFIX, 5, 5, {-np.pi / 2!r}"
    result = run_deck(deck.text(STEP.format(first=0.1, data=data), {"P": [1], "FIX": deck.side(i=0)}), user)
    # the middle, and half of the thickness along the normal, which was 3 and is -1 now; traces of DROT and DFGRD1
    expected = {8: -0.05, 9: 0.5, 10: 1.0, 12: 3.0, 13: 3.0}
    for k, value in expected.items():
        np.testing.assert_allclose(result.field(f"SDV{k}_SPOS"), value, atol=1e-6, err_msg=str(k))
    np.testing.assert_allclose(result.field("S11_SPOS"), 0, atol=1e-4)


def slit_plate(element_type, n):
    """An annular plate with a slit, one of whose sides is lifted by 0.8 per length: W of both ends of it."""
    m = n // 8

    def place(a, b):
        angle, radius = 2 * np.pi * a, 6 + 4 * b
        return radius * np.cos(angle), radius * np.sin(angle), 0.0

    deck = ShellDeck(element_type, n, m, place, section(0.03), "*ELASTIC\n2.1e7, 0.")
    side = deck.side(i=0)
    data = "*BOUNDARY\nFIX, 1, 6\n" + end_loads(deck, side, 3, 0.8 * 4)
    names = f"U3[P:{side[0]}]", f"U3[P:{side[-1]}]"
    return deck, data, {"P": [side[0], side[-1]], "FIX": deck.side(i=n)}, names, (13.891, 17.528)


def pinched_hemisphere(element_type, n):
    """A hemisphere with a hole of 18 degrees, two forces of 400 in and two out: U inward and outward."""

    def place(a, b):
        along, up = np.radians(90 * a), np.radians(72 * b)
        return 10 * np.cos(up) * np.cos(along), 10 * np.cos(up) * np.sin(along), 10 * np.sin(up)

    deck = ShellDeck(element_type, n, n, place, section(0.04), "*ELASTIC\n6.825e7, 0.3")
    out, inward = deck.node(0, 0), deck.node(n, 0)
    data = f"*BOUNDARY\nYS, YSYMM\nXS, XSYMM\n{out}, 3\n*CLOAD\n{out}, 1, 200.\n{inward}, 2, -200."
    sets = {"P": [out, inward], "YS": deck.side(i=0), "XS": deck.side(i=n)}
    return deck, data, sets, (f"U1[P:{out}]", f"U2[P:{inward}]"), (4.067, -8.178)


PROBLEMS = {"slit annular plate": slit_plate, "pinched hemisphere": pinched_hemisphere}


@pytest.mark.sample(2)
@pytest.mark.parametrize(("problem", "n"), [("slit annular plate", 24), ("pinched hemisphere", 16)])
def test_published_shells_on_coarse_meshes(ends, problem, n):
    deck, data, sets, names, exact = PROBLEMS[problem]("S4R", n)
    found = ends(deck, data, sets, first=0.05)
    np.testing.assert_allclose([found[name] for name in names], exact, rtol=0.05)


def rows_of_the_page():
    """Problem, element type, cells along the first side and ratios of shells.md."""
    page = Path(__file__).parents[3] / "harness" / "uel" / "elements" / "families" / "shells.md"
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in page.read_text().splitlines()]
    for row in rows:
        if len(row) == 5 and row[0] in PROBLEMS:
            yield row[0], row[1], int(row[2].split(" x ")[0]), [float(row[3]), float(row[4])]


@pytest.mark.long
@pytest.mark.parametrize(("problem", "element_type", "n", "ratios"), list(rows_of_the_page()))
def test_page(ends, problem, element_type, n, ratios):
    """The table of shells.md, to its last digit."""
    deck, data, sets, names, exact = PROBLEMS[problem](element_type, n)
    found = ends(deck, data, sets, first=0.05)
    np.testing.assert_allclose(np.array([found[name] for name in names]) / exact, ratios, atol=6e-4)


HELD = "*BOUNDARY\nALL, 6\nX, 3\nX, 5\nY, 3\nY, 4\nCORNER, 1, 2\nSIDE, 2"


@pytest.mark.sample(3)
@pytest.mark.parametrize(("element_type", "error"), [("S4", 0.01), ("S4R", 0.01), ("S3", 0.06), ("S8R", 0.01)])
@pytest.mark.parametrize("base", [0.0, 0.6])
def test_buckling_of_a_supported_plate(run_deck, element_type, error, base):
    """4 pi^2 D/b^2 along one side (S.P. Timoshenko, Theory of Elastic Stability, plates); a preload counts."""
    n, side, thickness = 16, 10.0, 0.1
    deck = ShellDeck(
        element_type, n, n, lambda a, b: (side * a, side * b, 0.0), section(thickness), "*ELASTIC\n1000., 0.3"
    )
    critical = 4 * np.pi**2 * 1000 * thickness**3 / 12 / (1 - 0.3**2) / side**2

    def loads(force):
        ends = ((0, 1), (n, -1))
        return "\n".join(end_loads(deck, deck.side(i=i), 1, sign * force * side) for i, sign in ends)

    sets = {"X": deck.side(j=0) + deck.side(j=n), "Y": deck.side(i=0) + deck.side(i=n), "CORNER": [1]}
    sets |= {"SIDE": [deck.node(n, 0)]}
    step = f"*STEP\n*BUCKLE\n1\n{HELD}\n{loads(1.0)}\n*END STEP"
    if base:
        step = f"*STEP\n*STATIC\n1., 1.\n{HELD}\n{loads(base * critical)}\n*END STEP\n" + step.replace(f"{HELD}\n", "")
    factor = run_deck(deck.text(step, sets)).history["EIGVAL"][-1]
    assert factor == pytest.approx((1 - base) * critical, abs=error * critical)
