# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*USER DEFINED FIELD by USDFLD and *ELASTIC, DEPENDENCIES=: one element of unit size is stretched to 0.04.

In four increments, and sheared in its plane too where a deck says so.
"""

from pathlib import Path

import numpy as np
import pytest
from point_routines import getvrm, usdfld, uvarm

from uel.errors import DeckError, UelError

SQUARE = "1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1."
CUBE = SQUARE.replace(".\n", "., 0.\n") + ", 0.\n5, 0., 0., 1.\n6, 1., 0., 1.\n7, 1., 1., 1.\n8, 0., 1., 1."
DECK = """*NODE, NSET=ALL
{nodes}
*ELEMENT, TYPE={type}, ELSET=E
7, {connectivity}
*ORIENTATION, NAME=TURNED
0.8, 0.6, 0., -0.6, 0.8, 0.
*SOLID SECTION, ELSET=E, MATERIAL=STUFF{orientation}
*MATERIAL, NAME=STUFF
{material}
*BOUNDARY
1, 1, 3
4, 1
{initial}
*STEP
{procedure}
0.25, 1., 0.25, 0.25
*BOUNDARY
2, 1, 1, 0.04
3, 1, 1, 0.04
{step}
*END STEP
"""
FIELD = "*ELASTIC, DEPENDENCIES=1\n1000., 0., , 0.\n500., 0., , 1.\n*USER DEFINED FIELD\n*DEPVAR\n2"
UMAT = f"""      INCLUDE '{Path(__file__).parents[1] / "umat.inc"}'
      STATEV(2) = 10*STATEV(1) + PREDEF(1) + DPRED(1)
      DDSDDE = 0
      DO K = 1, NTENS
        DDSDDE(K,K) = PROPS(1)
      END DO
      STRESS = STRESS + PROPS(1)*DSTRAN
      END
"""
STRAINS = np.array([0.01, 0.02, 0.03, 0.04])


@pytest.fixture
def run_with_usdfld(run_deck):
    def run_with_usdfld(material, body="", *, type="CPS4", routine=usdfld, more="", **parts):
        solid = type.startswith("C3D")
        given = {"orientation": "", "initial": "", "step": "", "procedure": "*STATIC, DIRECT"} | parts
        text = DECK.format(
            nodes=CUBE if solid else SQUARE,
            type=type,
            connectivity=", ".join(map(str, range(1, 9 if solid else 5))),
            material=material,
            **given,
        )
        return run_deck(text, routine(body) + more)

    return run_with_usdfld


def along(result, name):
    """A field variable of the element in each increment."""
    return np.array([float(result.field(name, increment=k)[0]) for k in range(1, len(STRAINS) + 1)])


@pytest.mark.parametrize(
    ("field", "moduli"),
    [
        ("TIME(1)+DTIME", [875, 750, 625, 500]),
        ("2*KINC-3", [1000, 500, 500, 500]),  # constant beyond the table
    ],
)
def test_constants_are_those_of_the_field(run_with_usdfld, field, moduli):
    np.testing.assert_allclose(along(run_with_usdfld(FIELD, f"FIELD(1) = {field}"), "S11"), moduli * STRAINS)


@pytest.mark.parametrize(("name", "scale"), [("E", 10.0), ("S", 0.01)])
def test_getvrm_gives_the_start_of_the_increment(run_with_usdfld, name, scale):
    """Field = scale x strain, or stress, of the increment before; modulus = 1000 - 500 field."""
    result = run_with_usdfld(FIELD, f"{getvrm(name)}\nFIELD(1) = {scale}*ARRAY(1)\nIF (JRCD .NE. 0) CALL XIT")
    expected, last = [], 0.0
    for strain in STRAINS:
        expected.append((1000 - 500 * min(scale * last, 1)) * strain)
        last = strain if name == "E" else expected[-1]
    np.testing.assert_allclose(along(result, "S11"), expected)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        # uniaxial stress s: Mises and Tresca s, pressure -s/3, third invariant s
        ("SINV", [1, 1, -1 / 3, 1]),
        # plastic strain p along the axis, and -p/2 across; in axes turned by the angle of 3, 4, 5
        ("PE", [0.64 - 0.18, 0.36 - 0.32, -0.5, 2 * -0.48 * 1.5, 0, 0, 1]),
    ],
)
def test_invariants_and_plastic_strains(run_with_usdfld, name, expected):
    """In UVARM of the last increment: a strain of 0.04 with a yield stress of 20, constant, and a modulus of 1000."""
    elastic = "*ELASTIC\n1000., 0.\n*PLASTIC\n20., 0.\n*USER OUTPUT VARIABLES\n9"
    turned = "IF (ORNAME .NE. 'TURNED') CALL XIT"
    body = f"{turned}\n{getvrm(name)}\nUVAR(1:7) = ARRAY(1:7)\nUVAR(8) = JRCD\nUVAR(9) = DIRECT(2,1)"
    result = run_with_usdfld(elastic, body, routine=uvarm, orientation=", ORIENTATION=TURNED")
    found = np.array([result.field(f"UVARM{k}")[0] for k in range(1, 10)])
    scale = 20 if name == "SINV" else 0.02
    np.testing.assert_allclose(found[: len(expected)], scale * np.array(expected), rtol=5e-3, atol=1e-3 * scale)
    np.testing.assert_allclose(found[7:], [0, 0.6])


def test_state_variables_are_kept_once_an_increment(run_with_usdfld):
    body = f"{getvrm('SDV')}\nSTATEV(2) = ARRAY(1)"
    result = run_with_usdfld(FIELD, body + "\nSTATEV(1) = STATEV(1) + 1\nFIELD(1) = 0.5*MOD(STATEV(1),2.D0)")
    np.testing.assert_allclose(along(result, "SDV1"), [1, 2, 3, 4])
    np.testing.assert_allclose(along(result, "SDV2"), [0, 1, 2, 3])
    np.testing.assert_allclose(along(result, "S11"), [750, 1000, 750, 1000] * STRAINS)


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("TIME(1) + 10*TIME(2) + 100*DTIME", [25, 27.75, 30.5, 33.25]),
        ("NFIELD + 10*NSTATV + 100*NOEL + 1000*KSTEP + 10000*KINC", [11721, 21721, 31721, 41721]),
        ("NDI + 10*NSHR + 100*LAYER + 1000*KSPT", [1112] * 4),
        # the mean over the four points
        ("NPT + 10*COORD(1) + 100*COORD(2) + 1000*CELENT", [1057.5] * 4),
        ("DIRECT(1,1) + 10*DIRECT(2,1) + 100*DIRECT(1,2) + 1000*T(3,3)", [1000 + 0.8 + 6 - 60] * 4),
        ("ICHAR(CMNAME(1:1)) + 1000*ICHAR(ORNAME(1:1))", [84083] * 4),
    ],
)
def test_arguments(run_with_usdfld, expression, expected):
    result = run_with_usdfld(FIELD, f"STATEV(1) = {expression}", orientation=", ORIENTATION=TURNED")
    np.testing.assert_allclose(along(result, "SDV1"), expected)


def test_umat_gets_field_and_state(run_with_usdfld):
    material = "*USER MATERIAL, CONSTANTS=1\n100.\n*DEPVAR\n2\n*USER DEFINED FIELD"
    result = run_with_usdfld(material, "FIELD(1) = 0.5*KINC\nSTATEV(1) = STATEV(1) + 1", more=UMAT)
    np.testing.assert_allclose(along(result, "SDV1"), [1, 2, 3, 4])
    np.testing.assert_allclose(along(result, "SDV2"), [10.5, 21, 31.5, 42])
    np.testing.assert_allclose(along(result, "S11"), 100 * STRAINS)


@pytest.mark.parametrize(
    ("type", "dependent", "constant"),
    [
        ("CPE4", "\n100., 0.1, , 0.\n300., 0., , 1.", "\n250., 0.025"),
        ("CPS4", "\n100., 0.1, , 0.\n300., 0.3, , 1.", "\n250., 0.25"),
        (
            "CPS4",
            ", TYPE=LAMINA\n9e3, 300., 0.2, 100., 100., 80., , 0.\n5e3, 700., 0.4, 300., 100., 80., , 1.",
            ", TYPE=LAMINA\n6e3, 600., 0.35, 250., 100., 80.",
        ),
        (
            "C3D8",
            ", TYPE=ENGINEERING CONSTANTS\n9e3, 800., 500., 0.2, 0.1, 0.3, 90., 80.\n70., , 0.\n"
            "5e3, 400., 700., 0.4, 0.3, 0.1, 50., 40.\n30., , 1.",
            ", TYPE=ENGINEERING CONSTANTS\n6e3, 500., 650., 0.35, 0.25, 0.15, 60., 50.\n40.",
        ),
    ],
)
def test_each_type_is_that_with_the_constants_between(run_with_usdfld, type, dependent, constant):
    """At a field of 0.75, in turned axes and with shear."""
    more = {
        "type": type,
        "orientation": ", ORIENTATION=TURNED",
        "step": "*BOUNDARY\n3, 2, 2, 0.03" + "\n2, 3\n4, 3" * (type == "C3D8"),
    }
    head, data = dependent.split("\n", 1)
    found = run_with_usdfld(f"*ELASTIC{head}, DEPENDENCIES=1\n{data}\n*USER DEFINED FIELD", "FIELD(1) = 0.75", **more)
    names = ["S11", "S22", "S33", "S12", "E33"]
    values = [found.field(name) for name in names]
    energy = found.history["ALLSE"][-1]
    expected = run_with_usdfld(f"*ELASTIC{constant}", **more)
    for name, value in zip(names, values, strict=True):
        np.testing.assert_allclose(value, expected.field(name), rtol=1e-9, atol=1e-12, err_msg=name)
    assert energy == pytest.approx(expected.history["ALLSE"][-1], rel=1e-9)


def test_a_table_of_temperature_and_two_fields(run_with_usdfld):
    """E = 100 + T + 10 f1 + 100 f2 on a grid: linear in each between its values."""
    rows = [f"{100 + t + 10 * f + 100 * g}, 0., {t}, {f}, {g}" for g in (0, 1) for f in (0, 2) for t in (0, 40)]
    table = "*ELASTIC, DEPENDENCIES=2\n" + "\n".join(rows)
    fields = "*TEMPERATURE\nALL, 40.\n*FIELD, VARIABLE=1\nALL, 2.\n*FIELD, VARIABLE=2\nALL, 0.5"
    part = np.array([0.25, 0.5, 0.75, 1.0])
    np.testing.assert_allclose(
        along(run_with_usdfld(table, step=fields), "S11"), (100 + part * (40 + 20 + 50)) * STRAINS
    )


def test_plasticity_with_a_modulus_of_temperature(run_with_usdfld):
    table = "*ELASTIC\n1000., 0., 0.\n600., 0., 80.\n*PLASTIC\n20., 0."
    part = np.array([0.25, 0.5, 0.75, 1.0])
    expected = np.minimum((1000 - 400 * part) * STRAINS, 20.0)
    # Newton's method leaves a residual of this size
    np.testing.assert_allclose(along(run_with_usdfld(table, step="*TEMPERATURE\nALL, 80."), "S11"), expected, rtol=5e-3)


def test_pnewdt_below_one_abandons_the_attempt(run_with_usdfld):
    with pytest.raises(UelError, match="FIXED TIME INCREMENT IS TOO LARGE"):
        run_with_usdfld(FIELD, "IF (KINC .EQ. 2) PNEWDT = 0.5")


@pytest.mark.parametrize(
    ("body", "message"),
    [
        (
            "IF (KINC .EQ. 2) CALL XIT",
            r"element 7 \(type CPS4\): USDFLD at integration point 1 stopped the .* \(step 1, increment 2",
        ),
        pytest.param(
            "FIELD(1) = SQRT(-1.D0*KINC)", "USDFLD sets a field variable to NaN or infinity", marks=pytest.mark.nan
        ),
    ],
)
def test_ends_of_the_analysis(run_with_usdfld, body, message):
    with pytest.raises(UelError, match=message):
        run_with_usdfld(FIELD, body)


def test_constants_between_definite_ones_may_not_be(run_with_usdfld):
    """nu12**2 < E1/E2 at both ends of the table, and not half-way."""
    rows = "1000., 10., 9., 9., 9., 9., , 0.\n1000., 1000., 0., 9., 9., 9., , 1."
    message = r"element 7 .*\*ELASTIC: the constants at integration point 1, interpolated .* are not positive definite"
    with pytest.raises(UelError, match=message):
        run_with_usdfld(f"*ELASTIC, TYPE=LAMINA, DEPENDENCIES=1\n{rows}\n*USER DEFINED FIELD", "FIELD(1) = 0.5")


@pytest.mark.parametrize(
    ("material", "message"),
    [
        (
            "*ELASTIC, DEPENDENCIES=1\n9., 0., , 0.\n8., 0., , 0.",
            r"deck.inp:14: \*ELASTIC: the temperature and fields are those of an earlier line",
        ),
        ("*ELASTIC, DEPENDENCIES=1\n9., 0., , 0., 1.", r"deck.inp:13: \*ELASTIC: 5 entries, expected at most 4"),
        ("*ELASTIC\n9., 0., 0.\n-9., 0., 1.", r"deck.inp:14: \*ELASTIC: E = -9, nu = 0: expected E > 0"),
        ("*ELASTIC, DEPENDENCIES=7\n9., 0., , 0.", r"deck.inp:12: \*ELASTIC: 10 values take 2 lines, found 1"),
        ("*ELASTIC, DEPENDENCIES=-1\n9., 0.", r"DEPENDENCIES=-1: expected a number from 0"),
        (
            "*ELASTIC, TYPE=ORTHOTROPIC, DEPENDENCIES=1\n9., 0.",
            r"dependence on temperature and fields is supported for ENGINEERING CONSTANTS, ISOTROPIC, LAMINA, not",
        ),
        (
            "*ELASTIC, TYPE=LAMINA, DEPENDENCIES=1\n9., 9., 0., 9., 9., 9., , 0.\n9., 9., 4., 9., 9., 9., , 1.",
            r"deck.inp:12: \*ELASTIC, TYPE=LAMINA: the stiffness is not positive definite",
        ),
    ],
)
def test_what_is_wrong_in_a_table_is_named(run_with_usdfld, material, message):
    with pytest.raises(DeckError, match=message):
        run_with_usdfld(material)


def test_it_needs_usdfld(run_with_usdfld):
    message = r"deck.inp:15: \*USER DEFINED FIELD: material STUFF needs USDFLD; .* has no user routine"
    with pytest.raises(DeckError, match=message):
        run_with_usdfld(FIELD, routine=lambda _: "      SUBROUTINE OTHER\n      END\n")


HEAT = "\n*CONDUCTIVITY\n1.\n*SPECIFIC HEAT\n1.\n*DENSITY\n1."
WARMED = {"initial": "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 20.", "step": "ALL, 11, 11, 100."}
COUPLED = WARMED | {"procedure": "*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE"}


@pytest.mark.parametrize("element_type", ["CPE4T", "CPS4T"])
@pytest.mark.parametrize(
    ("elastic", "body"), [(FIELD, "FIELD(1) = TIME(1)+DTIME"), ("*ELASTIC\n1000., 0., 20.\n500., 0., 100.", "")]
)
def test_coupled_elements_have_fields(run_with_usdfld, element_type, elastic, body):
    """The modulus falls from 1000 to 500 as the field goes to 1, or the temperature from 20 to 100."""
    result = run_with_usdfld(elastic + HEAT, body, type=element_type, **COUPLED)
    np.testing.assert_allclose(along(result, "S11"), [875, 750, 625, 500] * STRAINS)


def test_fields_reach_hetval_in_heat_elements(run_with_usdfld):
    """Field = temperature at the start of the increment, which is the heat per volume: reactions take it up."""
    hetval = """      SUBROUTINE HETVAL(CMNAME,TEMP,TIME,DTIME,STATEV,FLUX,PREDEF,DPRED)
      INCLUDE 'ABA_PARAM.INC'
      CHARACTER*80 CMNAME
      DIMENSION TEMP(2),STATEV(*),PREDEF(*),TIME(2),FLUX(2),DPRED(*)
      FLUX(1) = PREDEF(1)
      END
"""
    body = f"{getvrm('S')}\nIF (JRCD .NE. 1) CALL XIT\n{getvrm('TEMP')}\nIF (JRCD .NE. 0) CALL XIT"
    output = "\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nRFL"
    given = WARMED | {"procedure": "*HEAT TRANSFER, STEADY STATE", "step": WARMED["step"] + output}
    material = f"*USER DEFINED FIELD\n*HEAT GENERATION{HEAT}"
    result = run_with_usdfld(material, f"{body}\nFIELD(1) = ARRAY(1)", type="DC2D4", more=hetval, **given)
    taken = -sum(result.history[f"RFL11[ALL:{node}]"] for node in range(1, 5))
    np.testing.assert_allclose(taken, [20, 40, 60, 80])


def test_umatht_beside_usdfld_is_refused_in_coupled_elements(run_with_usdfld):
    material = f"*ELASTIC\n1000.\n*USER DEFINED FIELD{HEAT}\n*USER MATERIAL, TYPE=THERMAL, CONSTANTS=1\n1."
    message = r"deck.inp:\d+: \*USER DEFINED FIELD beside \*USER MATERIAL, TYPE=THERMAL is not supported for .* CPE4T"
    with pytest.raises(DeckError, match=message):
        run_with_usdfld(material, type="CPE4T", **COUPLED)
