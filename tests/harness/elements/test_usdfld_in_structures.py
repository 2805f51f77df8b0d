# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""USDFLD, GETVRM and *ELASTIC, DEPENDENCIES= in trusses and shells."""

from pathlib import Path

import numpy as np
import pytest
from point_routines import getvrm, usdfld
from shell_decks import ShellDeck

from uel.model.element_types import SHELL

HERE = Path(__file__).parents[1]


@pytest.fixture
def run_with_usdfld(run_deck):
    def run_with_usdfld(text, body="", more=""):
        return run_deck(text, usdfld(body) + more)

    return run_with_usdfld


TRUSS = """*NODE, NSET=ALL
1, 1., 0.{z}
2, 4., 4.{z}
*ELEMENT, TYPE={type}, ELSET=E
7, 1, 2
*SOLID SECTION, ELSET=E, MATERIAL=STUFF
2.
*MATERIAL, NAME=STUFF
{material}
*BOUNDARY
1, 1, 3
2, 2, 3
*STEP{options}
*STATIC, DIRECT
0.25, 1.
{step}
*OUTPUT, FIELD
*ELEMENT OUTPUT
E, S, PE, PEEQ, SDV
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=ALL
U, RF
*END STEP
"""
LENGTH, AREA = 5.0, 2.0
SINGLE = 1e-6
"""Field output has single precision."""
FIELD = "*ELASTIC, DEPENDENCIES=1\n1000., 0.5, , 0.\n500., 0.5, , 1.\n*USER DEFINED FIELD\n*DEPVAR\n2"
PULL = "*BOUNDARY\n2, 1, 1, 0.6"


def truss(material=FIELD, *, type="T2D2", step=PULL, options=""):
    return TRUSS.format(type=type, z="" if type == "T2D2" else ", 0.", material=material, step=step, options=options)


def along(result, name, count=4):
    """A variable of the only element in each increment."""
    return np.array([float(result.field(name, increment=k)[0]) for k in range(1, count + 1)])


@pytest.mark.parametrize("type", ["T2D2", "T3D2"])
def test_damage_by_the_largest_strain(run_with_usdfld, type):
    """The example of USDFLD in the User Subroutines Guide: the field is the largest strain so far, at the start of the
    increment. A force F along the bar: strain = F/(A E(field))."""
    rows = "2000., 0.3, 0., 0.\n1500., 0.3, 0., 0.01\n1200., 0.3, 0., 0.02\n1000., 0.3, 0., 0.04"
    material = f"*ELASTIC, DEPENDENCIES=1\n{rows}\n*USER DEFINED FIELD\n*DEPVAR\n1"
    body = f"{getvrm('E')}\nFIELD(1) = MAX(ABS(ARRAY(1)), STATEV(1))\nSTATEV(1) = FIELD(1)"
    # the roller lets the node move along x, which is 3/5 of the direction of the bar
    found = run_with_usdfld(truss(material, type=type, step="*CLOAD\n2, 1, 48."), body)
    strains, largest = [0.0], 0.0
    for k in range(1, 5):
        largest = max(largest, abs(strains[-1]))
        modulus = np.interp(largest, [0, 0.01, 0.02, 0.04], [2000, 1500, 1200, 1000])
        strains.append(12 * k / (3 / 5) / AREA / modulus)
    np.testing.assert_allclose(along(found, "E11"), strains[1:], rtol=SINGLE)
    np.testing.assert_allclose(along(found, "SDV1"), np.maximum.accumulate(strains)[:-1], rtol=SINGLE)
    np.testing.assert_allclose(found.history["U1[ALL:2]"], np.array(strains[1:]) * LENGTH / (3 / 5), rtol=SINGLE)


@pytest.mark.parametrize("type", ["T2D2", "T3D2"])
@pytest.mark.parametrize("options", ["", ", NLGEOM"])
def test_arguments_in_trusses(run_with_usdfld, type, options):
    """In the third increment; there are no directions in trusses (User Subroutines Guide, USDFLD)."""
    shift = 0.45 if options else 0.0
    expressions = {
        "TIME(1) + 10*TIME(2) + 100*DTIME": 0.5 + 5 + 25,
        "NFIELD + 10*NSTATV + 100*NOEL + 1000*KSTEP + 10000*KINC": 31721,
        "NDI + 10*NSHR + 100*NPT + 1000*LAYER + 10000*KSPT": 11101,
        "COORD(1) + 100*COORD(2) + 1E4*COORD(3)": (5 + shift) / 2 + 200,
        "CELENT": np.hypot(3 + shift, 4),
        "SUM(ABS(DIRECT)) + SUM(ABS(T))": 0,
        "ICHAR(CMNAME(1:1)) + 1000*ICHAR(ORNAME(1:1))": 32083,
    }
    for expression, expected in expressions.items():
        found = run_with_usdfld(truss(type=type, options=options), f"IF (KINC .EQ. 3) STATEV(1) = {expression}")
        assert along(found, "SDV1")[2] == pytest.approx(expected, rel=SINGLE), expression


@pytest.mark.parametrize("type", ["T2D2", "T3D2"])
@pytest.mark.parametrize(
    ("name", "components", "flags"),
    [("E", [1], ["YES", "N/A"]), ("S", [1], ["YES", "N/A"]), ("SINV", [1, 1, -1 / 3, 1], []), ("SDV", [1], [])],
)
def test_getvrm_in_trusses(run_with_usdfld, type, name, components, flags):
    """What the point has at the start of the last increment: strain 0.054, stress 54; SDV1 counts the increments."""
    body = f"{getvrm(name)}\nSTATEV(2) = 0\nDO K = 1, 7\nSTATEV(2) = STATEV(2) + K*ARRAY(K)\nEND DO"
    tests = "".join(f"\nIF (FLGRAY({k}) .NE. '{flag}') CALL XIT" for k, flag in enumerate(flags, 1))
    body += f"{tests}\nSTATEV(1) = STATEV(1) + 1\nIF (KINC .EQ. 4 .AND. JRCD .NE. 0) CALL XIT"
    found = run_with_usdfld(truss(type=type), body)
    strain = 0.75 * 0.6 * (3 / 5) / LENGTH
    scale = {"E": strain, "S": 1000 * strain, "SINV": 1000 * strain, "SDV": 3.0}[name]
    expected = scale * np.dot(components, np.arange(1, len(components) + 1))
    # the state variable itself is the second one, 0 at the start of the first increment
    expected += 2 * along(found, "SDV2")[2] if name == "SDV" else 0.0
    assert along(found, "SDV2")[3] == pytest.approx(expected, rel=SINGLE)


def test_plastic_strain_in_trusses(run_with_usdfld):
    """Yield stress 30, constant: beyond the strain 0.03 the rest is plastic."""
    body = f"{getvrm('PE')}\nSTATEV(1) = ARRAY(1) + 10*ARRAY(7)\nSTATEV(2) = JRCD"
    found = run_with_usdfld(truss(FIELD + "\n*PLASTIC\n30., 0."), body)
    strains = 0.6 * (3 / 5) / LENGTH * np.array([0.25, 0.5, 0.75, 1])
    np.testing.assert_allclose(along(found, "S11"), np.minimum(1000 * strains, 30), rtol=SINGLE)
    plastic = np.maximum(strains - 0.03, 0)
    np.testing.assert_allclose(along(found, "PE11"), plastic, atol=SINGLE)
    np.testing.assert_allclose(along(found, "SDV1")[1:], 11 * plastic[:3], atol=SINGLE)


def test_no_plastic_strain_in_elastic_trusses(run_with_usdfld):
    found = run_with_usdfld(
        truss(), f"{getvrm('SINV')}\n{getvrm('PE')}\nSTATEV(1) = ARRAY(1) + ARRAY(7)\nSTATEV(2) = JRCD"
    )
    np.testing.assert_array_equal(along(found, "SDV1"), 0)
    np.testing.assert_array_equal(along(found, "SDV2"), 1)


def test_modulus_of_temperature_in_trusses(run_with_usdfld):
    """The mean of the temperatures of the nodes, 40 at the end."""
    table = "*ELASTIC\n1000., 0.3, 0.\n600., 0.3, 80."
    found = run_with_usdfld(truss(table, step=PULL + "\n*TEMPERATURE\n1, 20.\n2, 60."))
    part = np.array([0.25, 0.5, 0.75, 1])
    np.testing.assert_allclose(along(found, "S11"), (1000 - 5 * 40 * part) * part * 0.6 * (3 / 5) / LENGTH)


def test_sdvini_in_trusses(run_with_usdfld):
    sdvini = """      SUBROUTINE SDVINI(STATEV,COORDS,NSTATV,NCRDS,NOEL,NPT,LAYER,KSPT)
      INCLUDE 'ABA_PARAM.INC'
      DIMENSION STATEV(NSTATV),COORDS(NCRDS)
      STATEV(1) = COORDS(1) + 10*COORDS(2) + 100*NPT
      END
"""
    text = truss().replace("*STEP", "*INITIAL CONDITIONS, TYPE=SOLUTION, USER\n*STEP")
    found = run_with_usdfld(text, "STATEV(2) = STATEV(1)", sdvini)
    np.testing.assert_allclose(along(found, "SDV2"), 2.5 + 20 + 100)


TYPES = tuple(SHELL)
THICKNESS = 0.4
GRADED = "*ELASTIC, DEPENDENCIES=1\n{0}, 0.25, , -1.\n{1}, 0.25, , 1.\n*USER DEFINED FIELD\n*DEPVAR\n2"
STEP = """*STEP{options}
*STATIC, DIRECT
{times}
{data}
*OUTPUT, FIELD
*NODE OUTPUT
U
*ELEMENT OUTPUT
S, SF, SDV, E
*END STEP"""


def plate(element_type, section, material, data, *, options="", times="1., 1.", before=""):
    """One square of 2 x 2 whose nodes all have prescribed motions."""
    deck = ShellDeck(element_type, 1, 1, lambda a, b: (2 * a, 2 * b, 0.0), section, material, before)
    return deck.text(STEP.format(options=options, data=data, times=times))


def motion(element_type, function, dofs=(1, 2, 3, 4, 5, 6)):
    """*BOUNDARY of all nodes; function: displacements and rotations at the coordinates of a node."""
    deck = ShellDeck(element_type, 1, 1, lambda a, b: (2 * a, 2 * b, 0.0), "", "")
    rows = [
        f"{node}, {dof}, {dof}, {function(*place)[dof - 1]:.17g}"
        for node, place in enumerate(deck.coordinates, 1)
        for dof in dofs
    ]
    return "\n".join(["*BOUNDARY", *rows])


def stretched_and_bent(strain, curvature):
    """Strain 11 of the middle surface, and its change along the normal."""

    def at(x, _y, _z):
        return strain * x, 0, -curvature * x**2 / 2, 0, curvature * x, 0

    return at


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("strain, curvature", [(0.01, 0.0), (0.0, 0.02), (0.01, 0.02)])
def test_modulus_that_is_graded_through_the_thickness(run_with_usdfld, element_type, strain, curvature):
    """E = 1000 + 400 z/(t/2): forces are integrals of E/(1 - nu^2) (e + z k), exact by Simpson's rule."""
    section = f"*SHELL SECTION, ELSET=SHELL, MATERIAL=M\n{THICKNESS}, 3"
    data = motion(element_type, stretched_and_bent(strain, curvature))
    found = run_with_usdfld(
        plate(element_type, section, GRADED.format(600, 1400), data), f"FIELD(1) = COORD(3)/{THICKNESS / 2}"
    )
    t, mean, slope = THICKNESS, 1000 / (1 - 0.25**2), 400 / (THICKNESS / 2) / (1 - 0.25**2)
    force = mean * t * strain + slope * t**3 / 12 * curvature
    moment = slope * t**3 / 12 * strain + mean * t**3 / 12 * curvature
    scale = mean * t * 0.01
    for name, value in (("SF1", force), ("SF2", 0.25 * force), ("SM1", moment), ("SM2", 0.25 * moment), ("SF3", 0)):
        np.testing.assert_allclose(found.field(name), value, rtol=SINGLE, atol=SINGLE * scale, err_msg=name)
    top = (1000 + 400) / (1 - 0.25**2) * (strain + curvature * t / 2)
    np.testing.assert_allclose(found.field("S11_SPOS"), top, rtol=SINGLE)


@pytest.mark.parametrize("element_type", ["S4", "S4R", "S3", "S8R"])
def test_layers_of_a_field_are_layers_of_a_material(run_with_usdfld, element_type):
    """USDFLD gives each layer its field; the same laminate of materials with these constants."""
    lamina = "*ELASTIC, TYPE=LAMINA{}\n{}"
    rows = {
        1: "9e3, 300., 0.2, 100., 100., 80.",
        2: "7e3, 500., 0.3, 200., 100., 80.",
        3: "5e3, 700., 0.4, 300., 100., 80.",
    }
    table = lamina.format(", DEPENDENCIES=1", "\n".join(f"{rows[k]}, , {k}." for k in (1, 3)))
    layers = "*SHELL SECTION, ELSET=SHELL, COMPOSITE\n0.1, 3, {}, 30.\n0.2, 3, {}, -45.\n0.1, 3, {}, 90."
    shear = "\n*TRANSVERSE SHEAR STIFFNESS\n30., 30."
    data = motion(element_type, lambda x, y, _z: (0.01 * x * y, 0.02 * y**2, 0.05 * x * y, 0.03 * y, 0.01 * x * y, 0))
    one = run_with_usdfld(
        plate(element_type, layers.format("M", "M", "M") + shear, f"{table}\n*USER DEFINED FIELD", data),
        "FIELD(1) = LAYER",
    )
    names = [f"{name}_{side}" for name in ("S11", "S22", "S12") for side in ("SNEG", "SPOS")]
    names += ["SF1", "SF2", "SF3", "SM1", "SM2", "SM3"]
    values = [one.field(name) for name in names]
    constants = "".join(f"*MATERIAL, NAME=M{k}\n{lamina.format('', row)}\n" for k, row in rows.items())
    layers = layers.format("M1", "M2", "M3")
    other = run_with_usdfld(plate(element_type, layers + shear, lamina.format("", rows[1]), data, before=constants))
    for name, value in zip(names, values, strict=True):
        np.testing.assert_allclose(value, other.field(name), rtol=SINGLE, atol=SINGLE, err_msg=name)


TURN = "*ORIENTATION, NAME=O\n0.8, 0.6, 0., -0.6, 0.8, 0.\n3, 0.\n"
OBLIQUE = "*SHELL SECTION, ELSET=SHELL, COMPOSITE, ORIENTATION=O\n0.1, 3, M, 30.\n0.3, 5, M, -10."


def rolled(angle):
    """A rotation of the plate by an angle about the axis x through the origin."""

    def at(_x, y, _z):
        return 0, y * (np.cos(angle) - 1), y * np.sin(angle), angle, 0, 0

    return at


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("options", ["", ", NLGEOM"])
def test_arguments_in_shells(run_with_usdfld, element_type, options):
    """In the second increment, of two by which the plate turns by 60 degrees, with NLGEOM: the directions are those at
    the start of the increment, as GETVRM has the state there; COORD is that of the point as it is now."""
    large = bool(options)
    points, area = SHELL[element_type].points, 2.0 if element_type.startswith("S3") else 4.0
    length = np.sqrt(area) / (2 if element_type == "S8R" else 1)
    start, now = (np.radians(30), np.radians(60)) if large else (0, 0)
    turn = np.degrees(np.arctan2(0.6, 0.8))
    for side, layer, number, angle, height in (("SNEG", 1, 1, turn + 30, -0.2), ("SPOS", 2, 5, turn - 10, 0.2)):
        c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        roll = np.array([[1, 0, 0], [0, np.cos(start), -np.sin(start)], [0, np.sin(start), np.cos(start)]])
        plane = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        direct = roll @ plane
        expressions = {
            "NFIELD + 100*KSTEP + 1000*KINC": 2101,
            "NDI + 10*NSHR + 100*LAYER + 1000*KSPT": 12 + 100 * layer + 1000 * number,
            "NPT": (points + 1) / 2,
            "CELENT": length,
            f"COORD(3)*{float(np.cos(now))!r}D0-COORD(2)*{float(np.sin(now))!r}D0": height,
            "ICHAR(CMNAME(1:1)) + 1000*ICHAR(ORNAME(1:1))": 79077,
            "SUM(ABS(T(:,3))) + SUM(ABS(T(3,:)))": 2,
            **{f"DIRECT({i + 1},{j + 1})": direct[i, j] for i in range(3) for j in range(3)},
            **{f"T({i + 1},{j + 1})": plane[i, j] for i in range(2) for j in range(2)},
        }
        data = motion(element_type, rolled(np.radians(60) if large else 0))
        lines = [f"STATEV({k}) = {expression}" for k, expression in enumerate(expressions, 1)]
        material = GRADED.format(600, 1400).replace("*DEPVAR\n2", f"*DEPVAR\n{len(lines)}")
        body = "IF (KINC .EQ. 2) THEN\n" + "\n".join(lines) + "\nEND IF"
        found = run_with_usdfld(
            plate(element_type, OBLIQUE, material, data, options=options, times="0.5, 1.", before=TURN), body
        )
        for k, (expression, value) in enumerate(expressions.items(), 1):
            values = found.field(f"SDV{k}_{side}")
            np.testing.assert_allclose(values, value, rtol=SINGLE, atol=SINGLE, err_msg=expression)


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("name", ["E", "S", "SINV", "PE"])
def test_getvrm_in_shells(run_with_usdfld, element_type, name):
    """At the start of the second increment, in the directions of the section points: 11, 22, 33, 12 in these places.
    Yield stress 10, constant: the plate is stretched beyond it, with a Poisson's ratio of 0."""
    material = "*ELASTIC\n1000., 0.\n*PLASTIC\n10., 0.\n*USER DEFINED FIELD\n*DEPVAR\n7"
    section = "*SHELL SECTION, ELSET=SHELL, COMPOSITE\n0.2, 3, M, 0.\n0.2, 3, M, 90."
    data = motion(element_type, lambda x, _y, _z: (0.04 * x, 0, 0, 0, 0, 0), (1, 3, 4, 5, 6)) + "\n1, 2\n2, 2"
    body = f"IF (KINC .NE. 2) RETURN\n{getvrm(name)}\nSTATEV(1:7) = ARRAY(1:7)\nIF (JRCD .NE. 0) CALL XIT"
    if name in ("E", "S"):
        body += "".join(f"\nIF (FLGRAY({k}) .NE. '{f}') CALL XIT" for k, f in ((1, "YES"), (3, "N/A"), (4, "YES")))
    found = run_with_usdfld(plate(element_type, section, material, data, times="0.5, 1."), body)
    for side, along_x, across in (("SNEG", 0, 1), ("SPOS", 1, 0)):
        values = np.array([found.field(f"SDV{k}_{side}") for k in range(1, 8)])
        expected = np.zeros((7, 1))
        if name == "S":
            expected[along_x] = 10
        elif name == "E":
            # plastic strains keep the volume: half of 0.01 across the axis and through the thickness
            expected[along_x], expected[across] = 0.02, -0.005
        elif name == "PE":
            expected[along_x], expected[across], expected[2], expected[6] = 0.01, -0.005, -0.005, 0.01
        else:
            expected[:4, 0] = 10, 10, -10 / 3, 10
        expected = np.broadcast_to(expected, values.shape)
        np.testing.assert_allclose(values, expected, rtol=1e-2, atol=1e-2 * expected.max())


UMAT = f"""      INCLUDE '{HERE / "umat.inc"}'
      STATEV(2) = 100*NSTATV + 10*STATEV(1) + PREDEF(1) + DPRED(1)
      DDSDDE = 0
      DO K = 1, NTENS
        DDSDDE(K,K) = PROPS(1)
      END DO
      STRESS = STRESS + MATMUL(DDSDDE, DSTRAN)
      END
"""


@pytest.mark.parametrize("element_type", ["S4", "S4R", "S3", "S8R"])
def test_layers_with_other_numbers_of_state_variables(run_with_usdfld, element_type):
    """Of UMAT with USDFLD, 2; and of a plastic layer with USDFLD, 9. Each sees its own."""
    user = "*USER MATERIAL, CONSTANTS=1\n1.\n*DEPVAR\n2\n*USER DEFINED FIELD"
    plastic = "*MATERIAL, NAME=P\n*ELASTIC\n1000., 0.\n*PLASTIC\n5., 0.\n*DEPVAR\n9\n*USER DEFINED FIELD\n"
    section = "*SHELL SECTION, ELSET=SHELL, COMPOSITE\n0.2, 3, M\n0.2, 3, P\n*TRANSVERSE SHEAR STIFFNESS\n9., 9."
    data = motion(element_type, lambda x, _y, _z: (0.02 * x, 0, 0, 0, 0, 0), (1, 3, 4, 5, 6)) + "\n1, 2\n2, 2"
    body = f"""FIELD(1) = 0.5*KINC
STATEV(1) = STATEV(1) + 1
IF (NSTATV .EQ. 9) THEN
{getvrm("PE")}
IF (JRCD .NE. 0) CALL XIT
STATEV(8) = ARRAY(7)
{getvrm("SDV")}
STATEV(9) = ARRAY(1)
END IF"""
    section += "\n*HOURGLASS STIFFNESS\n1."
    found = run_with_usdfld(plate(element_type, section, user, data, times="0.5, 1.", before=plastic), body, UMAT)
    for name, value in (("SDV1_SNEG", 2), ("SDV2_SNEG", 221), ("SDV1_SPOS", 2), ("SDV9_SPOS", 1), ("S11_SNEG", 0.02)):
        np.testing.assert_allclose(found.field(name), value, rtol=SINGLE, err_msg=name)
    np.testing.assert_allclose(found.field("SDV3_SNEG"), 0)
    # the plastic strain after the first increment of 0.01, of which 0.005 are elastic
    np.testing.assert_allclose(found.field("SDV8_SPOS"), 0.005, rtol=1e-2)


def test_a_perturbation_sees_the_fields_of_the_base_state(run_with_usdfld):
    """A truss of modulus 500 by the field 1 of the base state: its displacement under a force of 3 along x."""
    text = truss(step="*CLOAD\n2, 1, 6.") + "*STEP, PERTURBATION\n*STATIC\n*CLOAD\n2, 1, 3.\n*OUTPUT, HISTORY\n"
    found = run_with_usdfld(text + "*NODE OUTPUT, NSET=ALL\nU\n*END STEP\n", "FIELD(1) = 1")
    assert found.history["U1[ALL:2]"][-1] == pytest.approx(3 / (500 * AREA / LENGTH * (3 / 5) ** 2), rel=1e-9)
