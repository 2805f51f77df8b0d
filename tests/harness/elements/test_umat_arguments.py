# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Every argument of UMAT with its value, in every kind of step that has displacements.

A square is stretched by 0.02 in two increments; values are those of the last call in the second one, in point 3 of
element 7 (Abaqus User Subroutines Guide, UMAT); *GEOSTATIC takes one increment. In linear steps UMAT is called in the
base state alone, where nothing changes. DDSDDE and what couples stress and heat are zero on entry, which the guide
leaves open.
"""

from pathlib import Path

import numpy as np
import pytest

import uel

HERE = Path(__file__).parents[1]
UMAT = f"""      INCLUDE '{HERE}/umat.inc'
      IF (KINC .EQ. {{increment}} .AND. JSTEP(1) .EQ. {{step}} .AND.
     1 NPT .EQ. 3) THEN
      WRITE(6,'(A,11I5,1X,A)') 'GOT INTEGERS ', NDI, NSHR, NTENS, NSTATV,
     1 NPROPS, NOEL, NPT, LAYER, KSPT, JSTEP(1), KINC, TRIM(CMNAME)
      CALL TELL('JSTEP', DBLE(JSTEP), 4)
      CALL TELL('STRESS', STRESS, NTENS)
      CALL TELL('STATEV', STATEV, NSTATV)
      CALL TELL('ENERGY', (/ SSE, SPD, SCD /), 3)
      CALL TELL('PNEWDT', (/ PNEWDT /), 1)
      CALL TELL('STRAN', STRAN, NTENS)
      CALL TELL('DSTRAN', DSTRAN, NTENS)
      CALL TELL('TIME', (/ TIME(1), TIME(2), DTIME /), 3)
      CALL TELL('FIELDS', (/ TEMP, DTEMP, PREDEF(1), DPRED(1) /), 4)
      CALL TELL('PROPS', PROPS, NPROPS)
      CALL TELL('COORDS', COORDS, 3)
      CALL TELL('DROT', DROT, 9)
      CALL TELL('CELENT', (/ CELENT /), 1)
      CALL TELL('DFGRD0', DFGRD0, 9)
      CALL TELL('DFGRD1', DFGRD1, 9)
      CALL TELL('DDSDDE', RESHAPE(DDSDDE, (/ NTENS**2 /)), NTENS**2)
      CALL TELL('HEAT', (/ RPL, DDSDDT(1:NTENS), DRPLDE(1:NTENS), DRPLDT /),
     1 2*NTENS + 2)
      END IF
      DDSDDE = 0
      DO I = 1, NDI
        DDSDDE(I,I) = PROPS(1)
      END DO
      DO I = NDI + 1, NTENS
        DDSDDE(I,I) = PROPS(1)/2
      END DO
      STRESS = STRESS + MATMUL(DDSDDE, DSTRAN)
      STATEV(1) = KINC
      STATEV(2) = 7
      SSE = 0.5D0*PROPS(1)*(STRAN(1) + DSTRAN(1))**2
      SPD = 3
      SCD = 4
      RPL = 0
      DDSDDT = 0
      DRPLDE = 0
      DRPLDT = 0
      END
      SUBROUTINE TELL(NAME, VALUES, COUNT)
      INCLUDE 'ABA_PARAM.INC'
      INTEGER COUNT
      CHARACTER*(*) NAME
      DIMENSION VALUES(COUNT)
      WRITE(6,'(A,1X,16E24.16)') 'GOT '//NAME, VALUES
      END
"""
DECK = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*NSET, NSET=RIGHT
2, 3
*ELEMENT, TYPE={type}, ELSET=E
7, 1, 2, 3, 4
*SOLID SECTION, ELSET=E, MATERIAL=SOFT
0.5
*MATERIAL, NAME=SOFT
*USER MATERIAL, CONSTANTS=2
100., 5.
*DEPVAR
2
*DENSITY
2.
*CONDUCTIVITY
1.
*SPECIFIC HEAT
1.
{initial}*STEP{options}
{procedure}
*BOUNDARY
ALL, 2
1, 1
4, 1
RIGHT, 1, 1, 0.02
{given}*END STEP
{after}"""
FIELDS = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 20.\n*INITIAL CONDITIONS, TYPE=FIELD\nALL, 4.\n"
VARY = "*TEMPERATURE\nALL, 60.\n*FIELD\nALL, 6.\n"
RAMPED, AT_ONCE = [40.0, 20.0, 5.0, 1.0], [60.0, 0.0, 6.0, 0.0]
# procedure, options, temperature and field at the start, each with its change; procedure type key
GENERAL = {
    "static": ("*STATIC\n0.5, 1., 0.5, 0.5", "", RAMPED, 1),
    "fixed": ("*STATIC, DIRECT\n0.5, 1.", "", RAMPED, 2),
    "large": ("*STATIC\n0.5, 1., 0.5, 0.5", ", NLGEOM", RAMPED, 1),
    "damped": ("*STATIC, STABILIZE\n0.5, 1., 0.5, 0.5", "", RAMPED, 1),
    "visco": ("*VISCO\n0.5, 1., 0.5, 0.5", "", AT_ONCE, 21),
    "large visco": ("*VISCO\n0.5, 1., 0.5, 0.5", ", NLGEOM", AT_ONCE, 21),
    "dynamic": ("*DYNAMIC, NOHAF\n0.5, 1., 0.5, 0.5", "", AT_ONCE, 11),
    "large dynamic": ("*DYNAMIC, DIRECT, NOHAF\n0.5, 1.", ", NLGEOM", AT_ONCE, 12),
}


@pytest.fixture
def told(tmp_path):
    """Values by name, of the last call in an increment of a step."""

    def told(increment, step, **parts):
        given = {"type": "CPE4", "initial": FIELDS, "options": "", "given": VARY, "after": ""} | parts
        (tmp_path / "square.inp").write_text(DECK.format(**given))
        (tmp_path / "umat.f").write_text(UMAT.format(increment=increment, step=step))
        uel.run(tmp_path / "square.inp", tmp_path / "umat.f", output_dir=tmp_path)
        lines = (tmp_path / "square.dat").read_text().splitlines()
        found = {}
        for line in lines:
            if line.lstrip().startswith("GOT "):
                _, name, *values = line.split()
                found[name] = values
        numbers = {name: np.array(values, dtype=float) for name, values in found.items() if name != "INTEGERS"}
        assert numbers.pop("PNEWDT") > 1
        return numbers | {"INTEGERS": found["INTEGERS"]}

    return told


SOFT = ["3", "1", "4", "2", "2", "7", "3", "1", "1"]
"""NDI, NSHR, NTENS, NSTATV, NPROPS, NOEL, NPT, LAYER, KSPT."""
SAME = {"PROPS": [100, 5], "DROT": np.eye(3).ravel(), "DDSDDE": np.zeros(16), "HEAT": np.zeros(10)}
LOW, HIGH = 0.5 - 0.5 / np.sqrt(3), 0.5 + 0.5 / np.sqrt(3)


def check(found, step, increment, expected):
    """All arguments, and no others."""
    assert found.pop("INTEGERS") == [*SOFT, str(step), str(increment), "SOFT"]
    expected = SAME | expected
    assert sorted(found) == sorted(expected)
    for name, values in expected.items():
        np.testing.assert_allclose(found[name], values, rtol=1e-9, atol=1e-12, err_msg=name)


def gradient(stretch):
    return np.diag([stretch, 1.0, 1.0]).ravel()


def stretched(start, change, *, large, length=None):
    """Arguments that tell a strain along 1 and its change in the increment; length: at its start and its end."""
    before, after = length if large else (1.0, 1.0)
    return {
        "STRESS": [100 * start, 0, 0, 0],
        "STRAN": [start, 0, 0, 0],
        "DSTRAN": [change, 0, 0, 0],
        # the point, and the length of the element, now
        "COORDS": [LOW * after, HIGH, 0.0],
        "CELENT": [np.sqrt(after)],
        "DFGRD0": gradient(before),
        "DFGRD1": gradient(after),
    }


def second(large):
    """The second of two equal increments: strains of large ones are sums over the length in the middle of each."""
    before, change = (0.01 / 1.005, 0.01 / 1.015) if large else (0.01, 0.01)
    found = stretched(before, change, large=large, length=(1.01, 1.02))
    return found | {"STATEV": [1, 7], "ENERGY": [50 * before**2, 3, 4], "TIME": [0.5, 0.5, 0.5]}


@pytest.mark.parametrize("kind", GENERAL)
def test_in_general_steps(told, kind):
    procedure, options, fields, key = GENERAL[kind]
    found = told(2, 1, procedure=procedure, options=options)
    large = bool(options)
    check(found, 1, 2, second(large) | {"JSTEP": [1, key, large, 0], "FIELDS": fields})


@pytest.mark.parametrize("options", ["", ", NLGEOM"])
def test_in_a_geostatic_step(told, options):
    """One increment from the start to the end."""
    found = told(1, 1, procedure="*GEOSTATIC", options=options)
    large = bool(options)
    expected = stretched(0.0, 0.02 / 1.01 if large else 0.02, large=large, length=(1.0, 1.02))
    expected |= {"STATEV": [0, 0], "ENERGY": [0, 0, 0], "TIME": [0, 0, 1], "FIELDS": [20, 40, 4, 2]}
    check(found, 1, 1, expected | {"JSTEP": [1, 61, large, 0]})


@pytest.mark.parametrize("options", ["", ", NLGEOM"])
def test_along_a_path(told, options):
    """In increment 2 the displacement is the load factor times 0.02: strains, gradients and place are those of it."""
    found = told(2, 1, procedure="*STATIC, RIKS\n0.25, 1., 0.25, 0.25, 1.", options=options, given="")
    large = bool(options)
    change, before = found["DSTRAN"][0], found["STRAN"][0]
    assert change > 0
    # of e = 2 (l - 1)/(l + 1), the strain of the first increment, then of the ratio of the lengths of the second
    length = np.cumprod([(2 + e) / (2 - e) for e in (before, change)])
    # the arc length is the time, in the step and in all
    time = found.pop("TIME")
    assert time[0] == time[1] > 0
    assert time[2] > 0
    expected = stretched(before, change, large=large, length=length)
    expected |= {"JSTEP": [1, 1, large, 0], "STATEV": [1, 7], "ENERGY": [50 * before**2, 3, 4]}
    check(found, 1, 2, expected | {"FIELDS": [20, 0, 4, 0]})


@pytest.mark.parametrize("options", ["", ", NLGEOM"])
@pytest.mark.parametrize(
    ("steady", "temperatures", "key"), [(", STEADY STATE", [40.0, 20.0], 71), ("", [60.0, 0.0], 73)]
)
def test_in_coupled_steps(told, steady, temperatures, key, options):
    """Temperatures are those of the nodes, here held: they go from 20 to 60 at once in a transient step."""
    procedure = f"*COUPLED TEMPERATURE-DISPLACEMENT{steady}\n0.5, 1., 0.5, 0.5"
    found = told(2, 1, type="CPE4T", procedure=procedure, options=options, given="ALL, 11, 11, 60.\n")
    large = bool(options)
    check(found, 1, 2, second(large) | {"JSTEP": [1, key, large, 0], "FIELDS": [*temperatures, 4.0, 0.0]})


@pytest.mark.parametrize("options", ["", ", NLGEOM"])
@pytest.mark.parametrize(
    ("linear", "key", "time"),
    [
        ("*STEP, PERTURBATION\n*STATIC\n{}", 1, 0.0),
        ("*STEP\n*FREQUENCY\n1,\n*BOUNDARY, OP=NEW\n1, 1, 2\n2, 2\n", 41, 0.0),
        ("*STEP\n*STEADY STATE DYNAMICS, DIRECT\n0.01\n*BOUNDARY, OP=NEW\n1, 1, 2\n2, 2\n{}", 95, 0.01),
        ("*STEP\n*BUCKLE\n1,\n*BOUNDARY, OP=NEW\n1, 1, 2\n4, 1, 2\n2, 2\n3, 2\n{}", 1, 0.0),
    ],
)
def test_in_linear_steps(told, linear, key, time, options):
    """The strain of the base state, without a change; no time passes, and a frequency stands in its place."""
    after = linear.format("*CLOAD\n3, 1, -1.\n2, 1, -1.\n") + "*END STEP\n"
    found = told(1, 2, procedure="*STATIC\n0.5, 1., 0.5, 0.5", options=options, after=after)
    large = bool(options)
    strain = 0.01 / 1.005 + 0.01 / 1.015 if large else 0.02
    expected = stretched(strain, 0.0, large=large, length=(1.02, 1.02))
    expected |= {"JSTEP": [2, key, large, 1], "STATEV": [2, 7], "FIELDS": [60.0, 0.0, 6.0, 0.0]}
    # of the second increment: SSE is that of the strain it ends with
    check(found, 2, 1, expected | {"ENERGY": [50 * strain**2, 3, 4], "TIME": [time, 1.0, 0.0]})
