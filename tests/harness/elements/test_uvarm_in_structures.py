# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""UVARM at the points of trusses, beams, membranes and shells (User Subroutines Guide, UVARM)."""

from pathlib import Path

import numpy as np
import pytest
from point_routines import getvrm, usdfld, uvarm
from shell_decks import ShellDeck
from truss_decks import LENGTH, PULL, truss

from uel.errors import KernelError
from uel.model.element_types import MEMBRANE, SHELL

HERE = Path(__file__).parents[1]
SINGLE = 1e-6
"""Field output has single precision."""
ELASTIC = "*ELASTIC\n1000., {nu}\n*USER OUTPUT VARIABLES\n{count}"
TURN = "*ORIENTATION, NAME=O\n0.8, 0.6, 0., -0.6, 0.8, 0.\n3, 0.\n"
STEP = """*STEP{options}
*STATIC, DIRECT
0.5, 1.
{data}
*OUTPUT, FIELD
*ELEMENT OUTPUT
{output}
*END STEP
"""


@pytest.fixture
def run_with_uvarm(run_deck):
    def run_with_uvarm(text, body="", more=""):
        return run_deck(text, (uvarm(body) if body else "") + more)

    return run_with_uvarm


def arguments(moved):
    """Of any element in the second of two increments of half a unit of time."""
    return {
        "TIME(1) + 10*TIME(2) + 100*DTIME": 0.5 + 5 + 50,
        "NUVARM + 100*NOEL + 10000*KSTEP + 100000*KINC": moved + 210000,
        "ICHAR(CMNAME(1:1))": 77,
    }


def lines(expressions):
    """The values of the second increment."""
    body = "\n".join(f"UVAR({k}) = {expression}" for k, expression in enumerate(expressions, 1))
    return f"IF (KINC .EQ. 2) THEN\n{body}\nEND IF"


def matrix_entries(name, matrix):
    return {f"{name}({i + 1},{j + 1})": matrix[i, j] for i in range(3) for j in range(3)}


def roll(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])


def plane(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


ANGLE = float(np.radians(60))
FROM_X = np.degrees(np.arctan2(0.6, 0.8))
"""Angle of the orientation."""


def rolled(coordinates, dofs):
    """*BOUNDARY that turns nodes by an angle about x."""
    text = "*BOUNDARY\n"
    for node, x in enumerate(coordinates, 1):
        u = [*(roll(ANGLE) @ x - x), ANGLE, 0.0, 0.0]
        text += "".join(f"{node}, {dof}, {dof}, {u[dof - 1]:.17g}\n" for dof in range(1, dofs + 1))
    return text.rstrip()


def flat(coordinates, dofs):
    return "*BOUNDARY\n" + "\n".join(f"{node}, 1, {dofs}" for node in range(1, len(coordinates) + 1))


@pytest.mark.parametrize("element_type", SHELL)
@pytest.mark.parametrize("options", ["", ", NLGEOM"])
def test_arguments_in_shells(run_with_uvarm, element_type, options):
    """All section points of both layers; DIRECT and COORD are those at the end of the increment."""
    large = bool(options)
    turned = roll(ANGLE if large else 0.0)
    for side, layer, number, degrees, height in (("SNEG", 1, 1, 30, -0.2), ("SPOS", 2, 5, -10, 0.2)):
        axes = plane(FROM_X + degrees)
        expressions = {
            "LAYER + 100*KSPT + 1000*NDI + 10000*NSHR": layer + 100 * number + 12000,
            "NPT": (SHELL[element_type].points + 1) / 2,
            "ICHAR(ORNAME(1:1))": 79,
            f"COORD(3)*{float(turned[1, 1])!r}D0-COORD(2)*{float(turned[2, 1])!r}D0": height,
            **matrix_entries("DIRECT", turned @ axes),
            **matrix_entries("T", axes),
        }
        expressions |= arguments(len(expressions) + 3 + 100)
        section = "*SHELL SECTION, ELSET=SHELL, COMPOSITE, ORIENTATION=O\n0.1, 3, M, 30.\n0.3, 5, M, -10."
        material = ELASTIC.format(nu=0.25, count=len(expressions))
        deck = ShellDeck(element_type, 1, 1, lambda a, b: (2 * a, 2 * b, 0.0), section, material, TURN)
        data = (rolled if large else flat)(deck.coordinates, 6)
        text = deck.text(STEP.format(options=options, data=data, output="S, UVARM"))
        if element_type.startswith("S3"):
            expressions.pop(next(name for name in expressions if "NOEL" in name))
        found = run_with_uvarm(text, lines(expressions))
        for k, (expression, value) in enumerate(expressions.items(), 1):
            values = found.field(f"UVARM{k}_{side}")
            np.testing.assert_allclose(values, value, rtol=SINGLE, atol=SINGLE, err_msg=expression)


def test_arguments_in_continuum_shells(run_with_uvarm):
    """A plate of thickness 0.4 of two layers, turned about its normal, that is stretched: place, directions, stress."""
    corners = [(x, y, z) for z in (0.0, 0.4) for x, y in ((0, 0), (2, 0), (2, 2), (0, 2))]
    nodes = "\n".join(f"{k}, {x}, {y}, {z}" for k, (x, y, z) in enumerate(corners, 1))
    for side, layer, number, degrees, height in (("SNEG", 1, 1, 30, 0.0), ("SPOS", 2, 5, -10, 0.4)):
        axes = plane(FROM_X + degrees)
        expressions = {
            "LAYER + 100*KSPT + 1000*NDI + 10000*NSHR": layer + 100 * number + 12000,
            "COORD(3)": height,
            **matrix_entries("T", axes),
        }
        expressions |= arguments(len(expressions) + 3 + 1 + 100)
        own = lines(expressions).replace("END IF", f"{getvrm('S')}\nUVAR(NUVARM) = ARRAY(1)\nEND IF")
        text = f"*NODE, NSET=ALL\n{nodes}\n*ELEMENT, TYPE=SC8R, ELSET=E\n1, 1, 2, 3, 4, 5, 6, 7, 8\n{TURN}"
        text += (
            "*SHELL SECTION, ELSET=E, COMPOSITE, ORIENTATION=O\n0.1, 3, M, 30.\n0.3, 5, M, -10.\n*MATERIAL, NAME=M\n"
        )
        text += ELASTIC.format(nu=0.25, count=len(expressions) + 1) + "\n"
        held = "*BOUNDARY\nALL, 2, 3\n" + "".join(f"{k}, 1, 1, {1e-3 * x}\n" for k, (x, *_) in enumerate(corners, 1))
        found = run_with_uvarm(text + STEP.format(options="", data=held, output="S, UVARM"), own)
        for k, (expression, value) in enumerate(expressions.items(), 1):
            np.testing.assert_allclose(
                found.field(f"UVARM{k}_{side}"), value, rtol=SINGLE, atol=SINGLE, err_msg=expression
            )
        stress = found.field(f"UVARM{len(expressions) + 1}_{side}")
        np.testing.assert_allclose(stress, found.field(f"S11_{side}"), rtol=SINGLE)


SQUARE = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1, 0, 0], [2, 1, 0], [1, 2, 0], [0, 1, 0]], dtype=float)
SHEET = """*NODE, NSET=ALL
{nodes}
*ELEMENT, TYPE={type}, ELSET=E
1, {connectivity}
{before}*MEMBRANE SECTION, ELSET=E, MATERIAL=M, ORIENTATION=O
0.2
*MATERIAL, NAME=M
{material}
"""


def sheet(element_type, material):
    kind = MEMBRANE[element_type]
    corners = [0, 1, 2, 4, 5, 7] if kind.nodes in (3, 6) else range(8)
    nodes = SQUARE[list(corners)[: kind.nodes]]
    if kind.nodes == 6:
        nodes = SQUARE[[0, 1, 3, 4, 0, 7]]
        nodes[4] = [1, 1, 0]
    text = SHEET.format(
        nodes="\n".join(f"{k}, " + ", ".join(map(str, x)) for k, x in enumerate(nodes.tolist(), 1)),
        type=element_type,
        connectivity=", ".join(map(str, range(1, len(nodes) + 1))),
        before=TURN,
        material=material,
    )
    return text, nodes


@pytest.mark.parametrize("element_type", MEMBRANE)
@pytest.mark.parametrize("options", ["", ", NLGEOM"])
def test_arguments_in_membranes(run_with_uvarm, element_type, options):
    large = bool(options)
    turned, axes = roll(ANGLE if large else 0.0), plane(FROM_X)
    expressions = {
        "LAYER + 100*KSPT + 1000*NDI + 10000*NSHR": 12101,
        "ICHAR(ORNAME(1:1))": 79,
        f"COORD(3)*{float(turned[1, 1])!r}D0-COORD(2)*{float(turned[2, 1])!r}D0": 0.0,
        "NPT": (MEMBRANE[element_type].points + 1) / 2,
        **matrix_entries("DIRECT", turned @ axes),
        **matrix_entries("T", axes),
    }
    expressions |= arguments(len(expressions) + 3 + 100)
    text, nodes = sheet(element_type, ELASTIC.format(nu=0.25, count=len(expressions)))
    data = (rolled if large else flat)(nodes, 3)
    found = run_with_uvarm(text + STEP.format(options=options, data=data, output="S, UVARM"), lines(expressions))
    for k, (expression, value) in enumerate(expressions.items(), 1):
        values = found.field(f"UVARM{k}")
        np.testing.assert_allclose(values, value, rtol=SINGLE, atol=SINGLE, err_msg=expression)


BEAM = """*NODE, NSET=ALL
1, 0., 0., 0.
2, 2., 0., 0.
*ELEMENT, TYPE={type}, ELSET=E
1, 1, 2
*BEAM SECTION, ELSET=E, SECTION=RECT, MATERIAL=M
0.4, 0.8
0., 0., -1.
*MATERIAL, NAME=M
{material}
"""


@pytest.mark.parametrize(("element_type", "ntens", "point"), [("B31", 11, 25), ("B21", 1, 5)])
@pytest.mark.parametrize("options", ["", ", NLGEOM"])
def test_arguments_in_beams(run_with_uvarm, element_type, ntens, point, options):
    """Of a beam along x that turns about z: direction 1 is -z, the section point is the last one along 2."""
    c, s = (np.cos(ANGLE), np.sin(ANGLE)) if options else (1.0, 0.0)
    t, first = np.array([c, s, 0]), np.array([0, 0, -1.0])
    axes = np.column_stack([t, first, np.cross(t, first)])
    expressions = {
        "LAYER + 100*KSPT + 10000*NPT": 10001 + 100 * point,
        "NDI + 10*NSHR": ntens,
        f"COORD(2)*{float(c)!r}D0-COORD(1)*{float(s)!r}D0": 0.4,
        "ICHAR(ORNAME(1:1))": 32,
        **matrix_entries("DIRECT", axes),
        **matrix_entries("T", np.eye(3)),
    }
    expressions |= arguments(len(expressions) + 3 + 100)
    turn = (2 * np.array([np.cos(ANGLE) - 1, np.sin(ANGLE)])).tolist()
    data = f"*BOUNDARY\n1, 1, 5\n2, 3, 5\n1, 6, 6, {ANGLE!r}\n2, 6, 6, {ANGLE!r}\n"
    data += f"2, 1, 1, {turn[0]!r}\n2, 2, 2, {turn[1]!r}"
    data = data if options else "*BOUNDARY\nALL, 1, 6"
    text = BEAM.format(type=element_type, material=ELASTIC.format(nu=0.25, count=len(expressions)))
    found = run_with_uvarm(text + STEP.format(options=options, data=data, output="S, UVARM"), lines(expressions))
    for k, (expression, value) in enumerate(expressions.items(), 1):
        values = found.field(f"UVARM{k}_SP{point}")
        np.testing.assert_allclose(values, value, rtol=SINGLE, atol=SINGLE, err_msg=expression)


def pulled(element_type, material, *, options="", data=PULL):
    return truss(element_type, material) + STEP.format(options=options, data=data, output="E, S, UVARM")


@pytest.mark.parametrize("element_type", ["T2D2", "T3D2"])
@pytest.mark.parametrize("options", ["", ", NLGEOM"])
def test_arguments_in_trusses(run_with_uvarm, element_type, options):
    """There are no directions in trusses (User Subroutines Guide, UVARM)."""
    expressions = {
        "NDI + 10*NSHR + 100*NPT + 1000*LAYER + 10000*KSPT": 11101,
        "COORD(1) + 100*COORD(2) + 1E4*COORD(3)": (5 + (0.6 if options else 0.0)) / 2 + 200,
        "SUM(ABS(DIRECT)) + SUM(ABS(T))": 0,
        "ICHAR(ORNAME(1:1))": 32,
    }
    expressions |= arguments(len(expressions) + 3 + 100)
    text = pulled(element_type, ELASTIC.format(nu=0.5, count=len(expressions)), options=options)
    found = run_with_uvarm(text, lines(expressions))
    for k, (expression, value) in enumerate(expressions.items(), 1):
        assert found.field(f"UVARM{k}") == pytest.approx(value, rel=SINGLE), expression


def strained(element_type, material):
    """A deck in which the only element has the strain 0.02 along x at the end, and its names behind a variable."""
    if element_type in SHELL:
        section = "*SHELL SECTION, ELSET=SHELL, COMPOSITE\n0.2, 3, M, 0.\n0.2, 3, M, 0."
        deck = ShellDeck(element_type, 1, 1, lambda a, b: (2 * a, 2 * b, 0.0), section, material)
        data = "*BOUNDARY\n" + "\n".join(
            f"{k}, 1, 1, {float(0.02 * x[0])!r}\n{k}, 3, 6" + ("" if x[1] else f"\n{k}, 2")
            for k, x in enumerate(deck.coordinates, 1)
        )
        return deck.text(STEP.format(options="", data=data, output="S, UVARM")), "_SPOS"
    if element_type in MEMBRANE:
        text, nodes = sheet(element_type, material)
        text = text.replace(", ORIENTATION=O", "")
        data = "*BOUNDARY\n" + "\n".join(
            f"{k}, 1, 1, {float(0.02 * x[0])!r}\n{k}, 3" + ("" if x[1] else f"\n{k}, 2") for k, x in enumerate(nodes, 1)
        )
        return text + STEP.format(options="", data=data, output="S, UVARM"), ""
    if element_type.startswith("B"):
        text = BEAM.format(type=element_type, material=material)
        data = "*BOUNDARY\n1, 1, 6\n2, 2, 6\n2, 1, 1, 0.04"
        return text + STEP.format(options="", data=data, output="S, UVARM"), "_SP1"
    return pulled(element_type, material, data=f"*BOUNDARY\n2, 1, 1, {0.02 * LENGTH / 0.6!r}"), ""


EACH = ["S4", "S4R", "S3", "S8R", "M3D4", "M3D4R", "M3D6", "B21", "B31", "T2D2", "T3D2"]
POINTS = {name: kind.points for kinds in (SHELL, MEMBRANE) for name, kind in kinds.items()}
PLASTIC = "*ELASTIC\n1000., 0.\n*PLASTIC\n10., 0.\n*USER OUTPUT VARIABLES\n8"


@pytest.mark.parametrize("element_type", EACH)
@pytest.mark.parametrize("name", ["E", "S", "SINV", "PE"])
def test_getvrm_has_the_end_of_the_increment(run_with_uvarm, element_type, name):
    """A strain of 0.02 along x with a yield stress of 10, constant, and a modulus of 1000: half of it is plastic."""
    text, side = strained(element_type, PLASTIC)
    found = run_with_uvarm(text, f"{getvrm(name)}\nUVAR(1:7) = ARRAY(1:7)\nUVAR(8) = JRCD")
    values = np.array([float(found.field(f"UVARM{k}{side}")[0]) for k in range(1, 9)])
    assert values[7] == 0
    index, expected = {
        "E": ([0], [0.02]),
        "S": ([0], [10]),
        "SINV": ([0, 1, 2, 3], [10, 10, -10 / 3, 10]),
        "PE": ([0, 6], [0.01, 0.01]),
    }[name]
    # free sides are in equilibrium to the criterion of the run
    np.testing.assert_allclose(values[index], expected, rtol=1e-5)


@pytest.mark.parametrize("element_type", EACH)
def test_variables_stay_where_uvarm_leaves_them(run_with_uvarm, element_type):
    """They come as they were at the end of the increment before; each point is called once an increment."""
    text, side = strained(element_type, ELASTIC.format(nu=0.0, count=1))
    found = run_with_uvarm(text, "UVAR(1) = UVAR(1) + NPT")
    points = POINTS.get(element_type, 1)
    for increment in (1, 2):
        value = float(found.field(f"UVARM1{side}", increment=increment)[0])
        assert value == pytest.approx(increment * (points + 1) / 2)


@pytest.mark.parametrize("element_type", EACH)
def test_uvarm_ends_the_analysis(run_with_uvarm, element_type):
    text, _ = strained(element_type, ELASTIC.format(nu=0.0, count=1))
    message = rf"element 1 \(type {element_type}\): UVARM at integration point 1 stopped the analysis \(XIT\)"
    with pytest.raises(KernelError, match=rf"{message}.*\(step 1, increment 2"):
        run_with_uvarm(text, "IF (KINC .EQ. 2) CALL XIT")


@pytest.mark.parametrize("element_type", EACH)
def test_without_uvarm_its_variables_are_left_out(run_with_uvarm, element_type):
    text, side = strained(element_type, ELASTIC.format(nu=0.0, count=1))
    found = run_with_uvarm(text.replace(", UVARM\n", "\n"), more="      SUBROUTINE NOTHING\n      END\n")
    assert float(found.field(f"S11{side}")[0]) == pytest.approx(20, rel=SINGLE)


@pytest.mark.parametrize("element_type", ["S4", "S3R", "S8R"])
def test_layers_of_other_materials(run_with_uvarm, element_type):
    """Each layer has the variables of its material and its STATEV, and a third one has none."""
    field = "*USER DEFINED FIELD\n*DEPVAR\n{}\n*USER OUTPUT VARIABLES\n{}"
    first = "*ELASTIC\n1000., 0.\n" + field.format(1, 3)
    others = f"*MATERIAL, NAME=N\n*ELASTIC\n100., 0.\n{field.format(4, 1)}\n*MATERIAL, NAME=P\n*ELASTIC\n10., 0.\n"
    section = "*SHELL SECTION, ELSET=SHELL, COMPOSITE\n0.2, 3, M\n0.1, 3, P\n0.2, 3, N"
    deck = ShellDeck(element_type, 1, 1, lambda a, b: (a, b, 0.0), section, first, others)
    data = flat(deck.coordinates, 6)
    text = deck.text(STEP.format(options="", data=data, output="SDV, UVARM"))
    sums = f"{getvrm('SDV')}\nUVAR(NUVARM) = 10*ICHAR(CMNAME(1:1)) + SUM(ARRAY(1:4))"
    found = run_with_uvarm(text, sums, usdfld("STATEV(NSTATV) = STATEV(NSTATV) + 1"))
    expected = {"UVARM3_SNEG": 772, "UVARM1_SNEG": 0, "UVARM1_SPOS": 782, "SDV1_SNEG": 2, "SDV4_SPOS": 2}
    for name, value in expected.items():
        np.testing.assert_allclose(found.field(name), value, err_msg=name)


@pytest.mark.parametrize("element_type", ["S4", "M3D4", "B31", "T3D2"])
def test_the_middle_of_an_increment_is_not_its_end(run_with_uvarm, element_type):
    """*DYNAMIC asks for forces there, for the half-increment residual, once the increment has converged."""
    text, side = strained(element_type, "*DENSITY\n1e-3\n" + ELASTIC.format(nu=0.0, count=2))
    text = text.replace("*STATIC, DIRECT\n0.5, 1.", "*DYNAMIC, HALFINC SCALE FACTOR=1e9\n0.5, 1., 0.5, 0.5")
    found = run_with_uvarm(text, "UVAR(1) = TIME(1) + 10*DTIME\nUVAR(2) = TIME(2)")
    assert float(found.field(f"UVARM1{side}")[0]) == pytest.approx(0.5 + 5)
    assert float(found.field(f"UVARM2{side}")[0]) == pytest.approx(0.5)
