# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Every argument of user routines with its value in every kind of step, as the Abaqus User Subroutines Guide says.

A square of side 1 is held in step 1, which takes a time of 1, and stretched by 0.02 in step 2, in two increments of
0.5, or one of 1 (*GEOSTATIC); values are those of the last call in its last increment.
"""

import re
from functools import cache
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pytest

import uel
from uel.errors import DeckError
from uel.usersub.library import ENTRY_POINTS

HERE = Path(__file__).parent
PAGE = Path(uel.__file__).parent / "usersub" / "calls.md"
DECK = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*NSET, NSET=RIGHT
2, 3
*NSET, NSET=END
3
*ELEMENT, TYPE={type}, ELSET=E
7, 1, 2, 3, 4
*ORIENTATION, NAME=TURNED, LOCAL DIRECTIONS=2
0.8, 0.6, 0., -0.6, 0.8, 0.
3, 0.
1., 0., 0.
0.6, 0.8, 0.
*SOLID SECTION, ELSET=E, MATERIAL=STUFF, ORIENTATION=TURNED
0.5
*MATERIAL, NAME=STUFF
{material}
*DENSITY
2.
*AMPLITUDE, NAME=GIVEN, DEFINITION=USER, PROPERTIES=2, VARIABLES=1
5., 6.
*INITIAL CONDITIONS, TYPE=TEMPERATURE
ALL, 20.
*INITIAL CONDITIONS, TYPE=FIELD
ALL, 4.
{initial}*STEP{first}
{begin}
1., 1.
*BOUNDARY
ALL, 1, 2
ALL, 11, 11, 20.
*END STEP
*STEP{options}
{procedure}
*BOUNDARY, OP=NEW
ALL, 2
1, 1
4, 1
ALL, 11, 11, 20.
{loads}*OUTPUT, HISTORY, SENSOR, NAME=PLACE, OP=ADD
*NODE OUTPUT, NSET=END
{sensor}
*END STEP
"""
SPRING = """*NODE, NSET=ALL
1, 1.
2, 3.
*USER ELEMENT, TYPE=U5, NODES=2, COORDINATES=1, PROPERTIES=1, I PROPERTIES=1, VARIABLES=1
{dof}
*ELEMENT, TYPE=U5, ELSET=E
7, 1, 2
*UEL PROPERTY, ELSET=E
10., 3
{initial}*STEP{first}
{begin}
1., 1.
*BOUNDARY
ALL, {dof}
*END STEP
*STEP{options}
{procedure}
*BOUNDARY, OP=NEW
1, {dof}
2, {dof}, {dof}, 0.02
{loads}*END STEP
"""
USERS = """*BOUNDARY, USER, OP=NEW
RIGHT, 1, 1, 0.02
*DLOAD
E, BXNU, 4.
*CLOAD, AMPLITUDE=GIVEN
1, 2, 3.
"""
BY_DECK = "*BOUNDARY, OP=NEW\nRIGHT, 1, 1, 0.02\n"
HEATED = """*BOUNDARY, USER, OP=NEW
RIGHT, 11, 11, 0.02
*CFLUX, AMPLITUDE=GIVEN
1, 11, 3.
"""
FIELD = "*FIELD, USER\nALL, 6.\n"
VARY = f"*TEMPERATURE, USER\nALL, 60.\n{FIELD}"
ELASTIC = "*ELASTIC\n1000., 0.\n*USER DEFINED FIELD\n*DEPVAR\n1\n*USER OUTPUT VARIABLES\n3"
RUBBER = "*HYPERELASTIC, USER, TYPE=COMPRESSIBLE, PROPERTIES=2\n0.5, 0.4\n*DEPVAR\n1"
THERMAL = "\n*CONDUCTIVITY\n1.\n*SPECIFIC HEAT\n1."
TISSUE = "*ANISOTROPIC HYPERELASTIC, USER, FORMULATION=INVARIANT, LOCAL DIRECTIONS=2, TYPE=COMPRESSIBLE, PROPERTIES=2\n"
TISSUE += "0.5, 0.4\n*DEPVAR\n1"
STEPS = {
    "static": ("*STATIC\n0.5, 1., 0.5, 0.5", ""),
    "fixed": ("*STATIC, DIRECT\n0.5, 1.", ""),
    "large": ("*STATIC\n0.5, 1., 0.5, 0.5", ", NLGEOM"),
    "damped": ("*STATIC, STABILIZE\n0.5, 1., 0.5, 0.5", ""),
    "path": ("*STATIC, RIKS\n0.5, 1., 0.5, 0.5, 1.", ""),
    "large path": ("*STATIC, RIKS\n0.5, 1., 0.5, 0.5, 1.", ", NLGEOM"),
    "visco": ("*VISCO\n0.5, 1., 0.5, 0.5", ""),
    "large visco": ("*VISCO\n0.5, 1., 0.5, 0.5", ", NLGEOM"),
    "geostatic": ("*GEOSTATIC", ""),
    "large geostatic": ("*GEOSTATIC", ", NLGEOM"),
    "dynamic": ("*DYNAMIC, NOHAF\n0.5, 1., 0.5, 0.5", ""),
    "large dynamic": ("*DYNAMIC, DIRECT, NOHAF\n0.5, 1.", ", NLGEOM"),
}
COUPLED_STEPS = {
    f"{large}coupled{name}": (f"*COUPLED TEMPERATURE-DISPLACEMENT{steady}\n0.5, 1., 0.5, 0.5", ", NLGEOM" * bool(large))
    for large in ("", "large ")
    for name, steady in (("", ""), (" steady", ", STEADY STATE"))
}
HEAT_STEPS = {
    "heat": ("*HEAT TRANSFER\n0.5, 1., 0.5, 0.5", ""),
    "heat steady": ("*HEAT TRANSFER, STEADY STATE\n0.5, 1., 0.5, 0.5", ""),
}
# the factor of these is found: they take no routine that gives values by time
PATHS = tuple(name for name in STEPS if "path" in name)
TIMED = tuple(name for name in STEPS if "path" not in name)
LARGE = tuple(name for name in TIMED if "large" in name)
AT_ONCE = *(name for name in STEPS if "visco" in name or "dynamic" in name), "coupled", "large coupled"
LINEAR = {
    "static perturbation": ("*STATIC", ", PERTURBATION"),
    "frequency": ("*FREQUENCY\n1,", ""),
    "harmonic": ("*STEADY STATE DYNAMICS, DIRECT\n0.01", ""),
    "buckle": ("*BUCKLE\n1,", ""),
}
POINT = 3


@pytest.fixture(scope="module")
def calls(tmp_path_factory):
    """Calls of a run: their routine, (KSTEP, KINC, NOEL, NPT), and arguments by name."""

    @cache
    def calls(procedure, options, loads, material=ELASTIC, *, deck=DECK, **changed):
        folder = tmp_path_factory.mktemp("told")
        given = {"material": material, "type": "CPE4", "begin": "*STATIC", "sensor": "U1", "initial": "", "dof": 1}
        given |= {"first": "" if "PERTURBATION" in options else options}
        given |= {"procedure": procedure, "options": options, "loads": loads} | changed
        text = deck.format(**given)
        (folder / "told.inp").write_text(text)
        uel.run(folder / "told.inp", HERE / "told.f", output_dir=folder)
        found = []
        for line in (folder / "told.dat").read_text().splitlines():
            word, _, rest = line.strip().partition(" ")
            if word == "CALL":
                routine, *place = rest.split()
                found.append((routine, tuple(map(int, place)), {}))
            elif word == "TOLD":
                name, *values = rest.split()
                found[-1][2][name] = np.array(values, dtype=float)
            elif word == "NAMED":
                name, _, value = rest.partition(" <")
                found[-1][2][name] = value.removesuffix(">")
        return tuple((routine, place, MappingProxyType(given)) for routine, place, given in found)

    return calls


def in_step(calls, kind, material=ELASTIC):
    given = (STEPS | COUPLED_STEPS | HEAT_STEPS)[kind]
    if kind in PATHS:
        return calls(*given, BY_DECK, material)
    if kind in TIMED:
        return calls(*given, USERS + VARY, material)
    begin = given[0].partition("\n")[0]
    if kind in COUPLED_STEPS:
        return calls(*given, USERS + FIELD, material + THERMAL, type="CPE4T", begin=begin)
    return calls(*given, HEATED + FIELD, material + THERMAL, type="DC2D4", begin=begin, sensor="NT11")


def last(calls, routine, place=None):
    """Arguments of the last call of a routine, at a place."""
    return [given for name, at, given in calls if name == routine and place in (None, at)][-1]


def check(found, expected):
    """All arguments, and no others; names fill 80 characters."""
    assert sorted(found) == sorted(expected)
    for name, value in expected.items():
        if isinstance(value, str):
            assert found[name] == value.ljust(80), name
        else:
            np.testing.assert_allclose(found[name], np.atleast_1d(value), rtol=1e-9, atol=1e-12, err_msg=name)


# of point 3, before it moves
PLACE = np.array([0.5 - 0.5 / 3**0.5, 0.5 + 0.5 / 3**0.5, 0.0])
# columns are the directions of the material, which Fortran prints one after the other
DIRECT = [0.8, 0.6, 0.0, -0.6, 0.8, 0.0, 0.0, 0.0, 1.0]
AXES = {"DIRECT": DIRECT, "T": DIRECT, "ORNAME": "TURNED", "CMNAME": "STUFF"}
SECTION = {"LAYER": 1, "KSPT": 1, "NDI": 3, "NSHR": 1}


def stretch(kind):
    return np.array([1.02 if "large" in kind else 1.0, 1.0, 1.0])


def size(kind):
    """Of the increments."""
    return 1.0 if "geostatic" in kind else 0.5


def place(kind, *of):
    """KSTEP and KINC, and two more numbers."""
    return 2, round(1 / size(kind)), *of


def kept(kind):
    """10 KSTEP + KINC of the increment before."""
    return 21 if size(kind) < 1 else 11


def start(kind):
    """TIME at the start of the increment, and DTIME."""
    return {"TIME": [1 - size(kind), 2 - size(kind)], "DTIME": size(kind)}


def section(kind):
    """Points for heat have no stresses."""
    return SECTION | ({"NDI": 0, "NSHR": 0} if kind in HEAT_STEPS else {})


@pytest.mark.parametrize("kind", [*TIMED, *COUPLED_STEPS, *HEAT_STEPS])
def test_usdfld(calls, kind):
    found = dict(last(in_step(calls, kind), "USDFLD", place(kind, 7, POINT)))
    assert found.pop("PNEWDT") > 1
    expected = {
        "FIELD": 6.0,
        "STATEV": kept(kind),
        "CELENT": np.sqrt(stretch(kind)[0]),
        "COORD": PLACE * stretch(kind),
    }
    check(found, expected | AXES | section(kind) | start(kind))


@pytest.mark.parametrize("kind", [*TIMED, *COUPLED_STEPS, *HEAT_STEPS])
def test_uvarm(calls, kind):
    found = last(in_step(calls, kind), "UVARM", place(kind, 7, POINT))
    check(found, {"NUVARM": 3, "COORD": PLACE * stretch(kind)} | AXES | section(kind) | start(kind))


@pytest.mark.parametrize("kind", PATHS)
def test_points_along_a_path(calls, kind):
    """TIME is the arc length; the displacements are the load factor times 0.02, and fields stay."""
    found = in_step(calls, kind)
    steps = [given for name, (step, *_), given in found if name == "UEXTERNALDB" and step == 2]
    begun = [given for given in steps if given["LOP"] == 1][-1]
    increments = [at[1] for name, at, _ in found if name == "UEXTERNALDB" and at[0] == 2]
    for routine in ("USDFLD", "UVARM"):
        given = dict(last(found, routine, (2, max(increments), 7, POINT)))
        np.testing.assert_allclose(given.pop("TIME"), begun["TIME"])
        np.testing.assert_allclose(given.pop("DTIME"), begun["DTIME"])
        moved = given.pop("COORD")
        np.testing.assert_allclose(moved[1:], PLACE[1:])
        assert (moved[0] > PLACE[0]) == ("large" in kind)
        expected = AXES | SECTION
        if routine == "UVARM":
            expected |= {"NUVARM": 3}
        else:
            assert given.pop("PNEWDT") > 1
            expected |= {"FIELD": 4.0, "STATEV": 20 + max(increments) - 1, "CELENT": np.sqrt(moved[0] / PLACE[0])}
        check(given, expected)


def field(kind):
    """The field and its increment at the end: in *VISCO, *DYNAMIC and transient coupled steps it acts at once."""
    return {"FIELDV": 6.0, "FIELDVINC": 0.0 if kind in AT_ONCE else 2 * size(kind)}


def committed(kind):
    """Calls of which STATEV holds the count: one of each increment before, and that for initial accelerations."""
    return round(1 / size(kind)) + ("dynamic" in kind)


J = 1.02
HYPERELASTIC = {"TEMP": 60.0, "CMNAME": "STUFF", "INCMPFLAG": 0, "PROPS": [0.5, 0.4]}


def of_stretch(routine, j):
    """What tells of the deformation, diag(j, 1, 1): invariants of C, without the change of volume, and of the fibers.

    ZETA is A1 A2, of the directions of the fibers before the deformation.
    """
    invariants = (2 + j**2) * j ** (-2 / 3), (1 + 2 * j**2) * j ** (-4 / 3), j
    if routine == "UHYPER":
        return dict(zip(("BI1", "BI2", "AJ"), invariants, strict=True))
    first = np.array([0.8, 0.6, 0.0])
    second = 0.6 * first + 0.8 * np.array([-0.6, 0.8, 0.0])
    c = np.diag([j**2, 1, 1]) * j ** (-2 / 3)
    pairs = ((first, first), (first, second), (second, second))
    of_fibers = [value for a, b in pairs for value in (a @ c @ b, a @ c @ c @ b)]
    return {"AINV": [*invariants, *of_fibers], "ZETA": first @ second, "NFIBERS": 2, "IHYBFLAG": 0}


@pytest.mark.parametrize("kind", [*LARGE, "large coupled", "large coupled steady"])
@pytest.mark.parametrize("routine", ["UHYPER", "UANISOHYPER_INV"])
def test_hyperelasticity(calls, routine, kind):
    """In coupled steps the temperature is that of the nodes."""
    found = last(in_step(calls, kind, {"UHYPER": RUBBER}.get(routine, TISSUE)), routine)
    expected = HYPERELASTIC | ({"TEMP": 20.0} if kind in COUPLED_STEPS else {})
    check(found, of_stretch(routine, J) | {"STATEV": committed(kind)} | expected | field(kind))


@pytest.mark.parametrize("kind", LINEAR)
@pytest.mark.parametrize("routine", ["UHYPER", "UANISOHYPER_INV"])
def test_hyperelasticity_in_linear_steps(calls, routine, kind):
    """In the base state, the end of step 1, in which nothing is strained."""
    loads = "*CLOAD\nRIGHT, 1, -1.\n" * (kind != "frequency")
    found = calls(*LINEAR[kind], loads, {"UHYPER": RUBBER}.get(routine, TISSUE), first=", NLGEOM")
    begun = next(k for k, (name, at, _) in enumerate(found) if name == "UEXTERNALDB" and at == (2, 1, 0, 0))
    expected = {"STATEV": 1} | HYPERELASTIC | {"TEMP": 20.0, "FIELDV": 4.0, "FIELDVINC": 0.0}
    check(last(found[begun:], routine), expected | of_stretch(routine, 1.0))


@pytest.mark.parametrize("routine", ["UHYPER", "UANISOHYPER_INV"])
def test_hyperelasticity_along_a_path(calls, routine):
    """The stretch is that of the load factor; fields stay."""
    calls_of_path = in_step(calls, "large path", {"UHYPER": RUBBER}.get(routine, TISSUE))
    found = last(calls_of_path, routine)
    j = (found["AJ"] if routine == "UHYPER" else found["AINV"][2:3])[0]
    assert j > 1
    increments = [at[1] for name, at, _ in calls_of_path if name == "UEXTERNALDB" and at[0] == 2]
    expected = {"TEMP": 20.0, "FIELDV": 4.0, "FIELDVINC": 0.0, "STATEV": max(increments)}
    check(found, of_stretch(routine, j) | HYPERELASTIC | expected)


def moved(kind):
    """Of nodes at the start of the increment, as far as the step accounts for it."""
    return 0.02 * (1 - size(kind)) if "large" in kind else 0.0


@pytest.mark.parametrize("kind", TIMED)
def test_utemp(calls, kind):
    """The temperature of the deck at the end of the increment."""
    found = last(in_step(calls, kind), "UTEMP", place(kind, 0, 3))
    check(found, {"TEMP": 60, "NSECPT": 1, "TIME": [1, 2], "COORDS": [1 + moved(kind), 1, 0]})


@pytest.mark.parametrize("kind", [*TIMED, *COUPLED_STEPS, *HEAT_STEPS])
def test_ufield(calls, kind):
    """And that of UTEMP, with its increment; without predefined temperatures zero."""
    found = last(in_step(calls, kind), "UFIELD", place(kind, 0, 2))
    temperature = [0, 0] if kind not in TIMED else [60, 0 if kind in AT_ONCE else 40 * size(kind)]
    expected = {"FIELD": 6, "KFIELD": 1, "NSECPT": 1, "TIME": [1, 2], "NFIELD": 1, "COORDS": [1 + moved(kind), 0, 0]}
    check(found, expected | {"TEMP": temperature[0], "DTEMP": temperature[1]})


@pytest.mark.parametrize("kind", [*TIMED, *COUPLED_STEPS])
def test_dload(calls, kind):
    """At the end of the increment; JLTYP of BX is 1. F is that of the deck: no ramp acts on it."""
    calls = in_step(calls, kind)
    found = last(calls, "DLOAD", place(kind, 7, POINT))
    check(found, OF_DLOAD | {"TIME": [1.0, 2.0], "COORDS": PLACE * stretch(kind)})
    assert last(calls, "DLOAD", (2, 1, 7, POINT))["F"] == 4.0


OF_DLOAD = {"F": 4.0, "LAYER": 1, "KSPT": 1, "JLTYP": 1, "SNAME": ""}


@pytest.mark.parametrize("kind", PATHS)
def test_dload_along_a_path(calls, kind):
    """TIME(1) is the load factor, here the displacement over 0.02, TIME(2) the length of the path in all steps."""
    found = calls(*STEPS[kind], BY_DECK + "*DLOAD\nE, BXNU, 4.\n")
    increments = max(at[1] for name, at, _ in found if name == "DLOAD")
    begun = last(found, "UEXTERNALDB", (2, increments, 0, 0))
    given = dict(last(found, "DLOAD", (2, increments, 7, POINT)))
    factor, total = given.pop("TIME")
    assert factor > 0.5
    assert total == begun["TIME"][1]
    check(given, OF_DLOAD | {"COORDS": PLACE * [1 + 0.02 * factor * ("large" in kind), 1, 1]})


@pytest.mark.parametrize("large", ["", ", NLGEOM"])
@pytest.mark.parametrize("kind", ["static perturbation", "harmonic", "buckle"])
def test_dload_in_linear_steps(calls, kind, large):
    """About a base state in which the square is stretched by 0.02; a frequency takes the place of the step time."""
    stretched = "*BOUNDARY\nALL, 2\n1, 1\n4, 1\nALL, 11, 11, 20.\nRIGHT, 1, 1, 0.02\n*END"
    deck = DECK.replace("*BOUNDARY\nALL, 1, 2\nALL, 11, 11, 20.\n*END", stretched, 1)
    found = calls(*LINEAR[kind], "*DLOAD\nE, BXNU, -4.\n", deck=deck, first=large)
    given = last(found, "DLOAD", (2, 1, 7, POINT))
    expected = {"F": -4.0, "TIME": [0.01 if kind == "harmonic" else 0.0, 1.0], "COORDS": PLACE * [1.02, 1, 1]}
    check(given, OF_DLOAD | expected | ({} if large else {"COORDS": PLACE}))


@pytest.mark.parametrize("kind", [*TIMED, *COUPLED_STEPS, *HEAT_STEPS])
def test_disp(calls, kind):
    """TIME is the step and the total time at the end, and the time increment; COORDS with NLGEOM that of the start."""
    found = last(in_step(calls, kind), "DISP", place(kind, 0, 3))
    check(
        found,
        {
            "U": [0.02, 0, 0],
            "TIME": [1.0, 2.0, size(kind)],
            "JDOF": 11 if kind in HEAT_STEPS else 1,
            "COORDS": [1 + moved(kind), 1, 0],
        },
    )


@pytest.mark.parametrize("kind", [*TIMED, *COUPLED_STEPS, *HEAT_STEPS])
def test_uamp(calls, kind):
    """The sensor has its value at the end of the last increment, a temperature that falls from 20, or at once, or a
    displacement; in LFLAGSINFO are no initialization, a regular increment, no cutbacks, and the step."""
    found = last(in_step(calls, kind), "UAMP")
    before = 2 - size(kind)
    expected = {"AMPNAME": "GIVEN", "TIME": [1.0, 2.0], "AMPVALUEOLD": before, "DT": size(kind), "PROPS": [5, 6]}
    expected |= {"SVARS": before, "LFLAGSINFO": [0, 1, 0, 2], "SENSORNAMES": "PLACE"}
    sensor = {"heat": 0.02, "heat steady": 10.01}.get(kind, 0.02 * (before - 1))
    check(found, expected | {"SENSORVALUES": sensor})


def calls_of_uexternaldb(found):
    """LOP, TIME, DTIME, KSTEP and KINC of all calls."""
    return [
        (int(given["LOP"][0]), *given["TIME"].tolist(), float(given["DTIME"][0]), *place[:2])
        for name, place, given in found
        if name == "UEXTERNALDB"
    ]


BEFORE_STEP_2 = [
    *[(0, 0, 0, 0, 1, 0), (5, 0, 0, 0, 1, 0), (1, 0, 0, 1, 1, 1), (2, 1, 1, 1, 1, 1), (6, 1, 1, 0, 1, 1)],
    (5, 0, 1, 0, 2, 0),
]


@pytest.mark.parametrize("kind", [*TIMED, *COUPLED_STEPS, *HEAT_STEPS])
def test_uexternaldb(calls, kind):
    """LOP is the one of the guide."""
    h, ends = size(kind), []
    for k in range(1, round(1 / h) + 1):
        ends += [(1, k * h - h, 1 + k * h - h, h, 2, k), (2, k * h, 1 + k * h, h, 2, k)]
    rows = calls_of_uexternaldb(in_step(calls, kind))
    assert rows == [*BEFORE_STEP_2, *ends, (6, 1, 2, 0, *place(kind)), (3, 1, 2, 0, *place(kind))]


@pytest.mark.parametrize("kind", LINEAR)
def test_uexternaldb_in_linear_steps(calls, kind):
    """One increment, in which no time passes."""
    loads = {"frequency": "", "buckle": "*CLOAD\nRIGHT, 1, -1.\n"}.get(kind, "*CLOAD\nRIGHT, 1, 1.\n")
    rows = calls_of_uexternaldb(calls(*LINEAR[kind], loads))
    # DTIME is the time increment that Abaqus prints for linear perturbation steps
    ends = [(1, 0, 1, 1e-36, 2, 1), (2, 0, 1, 1e-36, 2, 1)]
    assert rows == [*BEFORE_STEP_2, *ends, (6, 0, 1, 0, 2, 1), (3, 0, 1, 0, 2, 1)]


@pytest.mark.parametrize("kind", PATHS)
def test_uexternaldb_along_a_path(calls, kind):
    """TIME and DTIME are the arc length; the step ends where the load factor is one."""
    rows = calls_of_uexternaldb(in_step(calls, kind))
    assert rows[:6] == BEFORE_STEP_2
    ends = [(1, 0, 1, 0.5, 2, 1), (2, 0.5, 1.5, 0.5, 2, 1), (1, 0.5, 1.5, 0.5, 2, 2), (2, 1, 2, 0.5, 2, 2)]
    assert np.array(rows[6:]) == pytest.approx(np.array([*ends, (6, 1, 2, 0, 2, 2), (3, 1, 2, 0, 2, 2)]), rel=1e-6)


@pytest.mark.parametrize("kind", LINEAR)
def test_linear_steps(calls, kind):
    """USDFLD is called in the base state, the end of step 1, in which no time passes; no other routine is."""
    procedure, options = LINEAR[kind]
    loads = {"frequency": "", "buckle": "*CLOAD\nRIGHT, 1, -1.\n"}.get(kind, "*CLOAD\nRIGHT, 1, 1.\n")
    found = calls(procedure, options, loads)
    assert {name for name, (step, *_), _ in found if step == 2} == {"USDFLD", "UEXTERNALDB"}
    given = dict(last(found, "USDFLD", (2, 1, 7, POINT)))
    assert given.pop("PNEWDT") > 1
    # the frequency in place of the time
    expected = {"TIME": [0.01 if kind == "harmonic" else 0.0, 1.0], "DTIME": 0.0}
    check(given, {"FIELD": 4.0, "STATEV": 11, "CELENT": 1.0, "COORD": PLACE} | expected | AXES | SECTION)


@pytest.mark.parametrize("large", ["", ", NLGEOM"])
@pytest.mark.parametrize("kind", ["static perturbation", "buckle"])
def test_disp_in_linear_steps(calls, kind, large):
    """U is the change, COORDS those of the base state, in which the square is stretched by 0.02; no time passes."""
    stretched = "*BOUNDARY\nALL, 2\n1, 1\n4, 1\nALL, 11, 11, 20.\nRIGHT, 1, 1, 0.02\n*END"
    deck = DECK.replace("*BOUNDARY\nALL, 1, 2\nALL, 11, 11, 20.\n*END", stretched, 1)
    # node 2 stays free to buckle
    given = "*BOUNDARY, OP=NEW, USER\n3, 1, 1, -0.03\n"
    found = last(calls(*LINEAR[kind], given, deck=deck, first=large), "DISP", (2, 1, 0, 3))
    check(found, {"U": [-0.03, 0, 0], "TIME": [0, 1, 0], "JDOF": 1, "COORDS": [1.02 if large else 1, 1, 0]})


def test_disp_in_a_harmonic_response(calls):
    with pytest.raises(DeckError, match=r"told.inp:\d+: values of DISP are not supported in a harmonic response"):
        calls(*LINEAR["harmonic"], "*BOUNDARY, OP=NEW, USER\nRIGHT, 1, 1, 0.02\n")


def test_sdvini(calls):
    """At all points, before the first step."""
    found = calls(*STEPS["static"], USERS + VARY, initial="*INITIAL CONDITIONS, TYPE=SOLUTION, USER\n")
    steps = [k for k, (name, place, _) in enumerate(found) if name == "UEXTERNALDB" and place[0] == 1]
    begun = [(name, place) for name, place, _ in found[steps[0] : steps[1]]]
    assert begun[1:] == [("SDVINI", (0, 0, 7, point)) for point in (1, 2, 3, 4)]
    given = last(found, "SDVINI", (0, 0, 7, POINT))
    check(given, {"STATEV": 0, "COORDS": PLACE[:2], "LAYER": 1, "KSPT": 1})


CODES = {"fixed": 2, "visco": 21, "geostatic": 61, "dynamic": 11, "large dynamic": 12, "heat": 33, "heat steady": 31}
CODES |= {"large visco": 21, "large geostatic": 61, "coupled": 73, "coupled steady": 71}
CODES |= {f"large {kind}": CODES[kind] for kind in ("coupled", "coupled steady")}
BETA, GAMMA = 0.275625, 0.55


def motion(h, changes):
    """V and A at the end of increments h by Newmark's formulas, from rest."""
    v = a = 0.0
    for change in changes:
        before, a = a, change / (BETA * h**2) - v / (BETA * h) - (0.5 / BETA - 1) * a
        v += h * ((1 - GAMMA) * before + GAMMA * a)
    return v, a


@pytest.mark.parametrize("kind", [*TIMED, *COUPLED_STEPS, *HEAT_STEPS])
def test_uel(calls, kind):
    """In the last call with LFLAGS(3) = 1, of a spring whose end is moved; loads and fields are those of its deck."""
    thermal = kind in COUPLED_STEPS or kind in HEAT_STEPS
    given = (STEPS | COUPLED_STEPS | HEAT_STEPS)[kind]
    begin = given[0].partition("\n")[0] if thermal else "*STATIC"
    start = "*INITIAL CONDITIONS, TYPE=FIELD\nALL, 4.\n"
    start += "" if thermal else "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 20.\n"
    loads = "*DLOAD\nE, U2, 4.\n" + (FIELD if thermal else VARY)
    found = calls(*given, loads, deck=SPRING, dof=11 if thermal else 1, begin=begin, initial=start)
    found = dict(last(found, "UEL", place(kind, 7, 1)))
    assert found.pop("PNEWDT") > 1
    h = size(kind)
    # what acts at once does not change in the second increment: there loads and fields, here temperatures too
    constant = kind in AT_ONCE or kind in ("coupled", "large coupled", "heat")
    part = 0.0 if constant else h
    v, a = motion(h, [0.01, 0.01]) if "dynamic" in kind else (0.0, 0.0)
    temperature = [0, 0] if thermal else [60, 40 * part]
    check(
        found,
        {
            **{
                "SVARS": kept(kind),
                "ENERGY": [0, kept(kind), 0, 0, 0, 0, 0, 0],
                "NRHS": 1,
                "PROPS": 10,
                "COORDS": [1, 3],
            },
            **{"U": [0, 0.02], "DU": [0, 0.0 if constant and thermal else 0.02 * h], "V": [0, v], "A": [0, a]},
            **{"JTYPE": 5, "TIME": [1, 2], "DTIME": h, "PERIOD": 1, "JPROPS": 3, "MLVARX": 2, "MDLOAD": 1},
            **{"JDLTYP": 2, "ADLMAG": 4, "DDLMAG": 4 * part, "PREDEF": [*temperature, 6, 2 * part] * 2},
            "PARAMS": [-0.05, BETA, GAMMA] if "dynamic" in kind else [0, 0, 0],
            "LFLAGS": [CODES.get(kind, 1), "large" in kind, 1, 0, 0, 0, 0],
        },
    )


SPRINGS = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 20.\n*INITIAL CONDITIONS, TYPE=FIELD\nALL, 4.\n"
"""What the fields of the spring start from."""
OF_SPRING = {"PROPS": 10, "COORDS": [1, 3], "JTYPE": 5, "JPROPS": 3, "MLVARX": 2, "MDLOAD": 1, "JDLTYP": 2}
OF_SPRING |= {"V": [0, 0], "A": [0, 0], "PARAMS": [0, 0, 0]}
REQUESTS = {
    "static perturbation": {(1, 0): 0.0, (100, 0): 0.05},
    "frequency": {(2, 0): 0.0, (4, 0): 0.0},
    "harmonic": {(2, 0): 0.0, (4, 0): 0.0, (3, 1): 0.0, (3, 2): 0.0},
}
"""LFLAGS(3) and (7) of the calls in a linear step, with DU of node 2."""


@pytest.mark.parametrize("large", ["", ", NLGEOM"])
@pytest.mark.parametrize("kind", REQUESTS)
def test_uel_in_linear_steps(calls, kind, large):
    """The state is that of the end of step 1, where node 2 has moved by 1; a load of 0.5 moves it 0.05 further."""
    procedure, options = LINEAR[kind]
    pulled = "*BOUNDARY\n1, 1\n*CLOAD\n2, 1, 10.\n*DLOAD\nE, U2, 4.\n*TEMPERATURE\nALL, 60.\n*FIELD\nALL, 6.\n*END"
    deck = SPRING.replace("*BOUNDARY\nALL, {dof}\n*END", pulled)
    deck = deck.replace("*BOUNDARY, OP=NEW\n1, {dof}\n2, {dof}, {dof}, 0.02\n", "")
    loads = {"static perturbation": "*CLOAD\n2, 1, 0.5\n*DLOAD\nE, U2, 3.\n", "harmonic": "*CLOAD\n2, 1, 0.5\n"}
    found = calls(procedure, options, loads.get(kind, ""), deck=deck, first=large, initial=SPRINGS)
    of_step = [(at, dict(given)) for name, at, given in found if name == "UEL" and at[0] == 2]
    assert {(at[-1], int(given["LFLAGS"][6])) for at, given in of_step} == set(REQUESTS[kind])
    added = 3.0 if kind == "static perturbation" else 0.0
    for at, given in of_step:
        assert at[:3] == (2, 1, 7)
        assert given.pop("PNEWDT") > 1
        request, damping = at[-1], given["LFLAGS"][6]
        expected = {
            **{"SVARS": 11, "ENERGY": [0, 11, 0, 0, 0, 0, 0, 0], "NRHS": 1, "U": [0, 1]},
            "DU": [0, REQUESTS[kind][request, damping]],
            **{"TIME": [0.01 if kind == "harmonic" else 0, 1], "DTIME": 0, "PERIOD": 0, "ADLMAG": 4, "DDLMAG": added},
            "PREDEF": [60, 0, 6, 0] * 2,
            "LFLAGS": [{"frequency": 41, "harmonic": 95}.get(kind, 1), bool(large), request, 1, 0, 0, damping],
        }
        check(given, OF_SPRING | expected)


@pytest.mark.parametrize("kind", PATHS)
def test_uel_along_a_path(calls, kind):
    """All loads follow the load factor, which is the displacement of node 2 times the stiffness over the load."""
    deck = SPRING.replace("2, {dof}, {dof}, 0.02\n", "")
    found = calls(*STEPS[kind], "*DLOAD\nE, U2, 4.\n", deck=deck, initial=SPRINGS)
    at, given = [(at, dict(given)) for name, at, given in found if name == "UEL" and at[0] == 2][-1]
    begun = next(told for name, place, told in found if name == "UEXTERNALDB" and place == (*at[:2], 0, 0))
    assert given.pop("PNEWDT") > 1
    load, increment = 10 * given["U"][1], 10 * given["DU"][1]
    assert load > increment > 0
    # the length along the path takes the place of time
    expected = {"TIME": begun["TIME"] + begun["DTIME"], "DTIME": begun["DTIME"], "PERIOD": 1}
    expected |= {"SVARS": 10 * at[0] + at[1] - 1, "ENERGY": [0, 10 * at[0] + at[1] - 1, 0, 0, 0, 0, 0, 0]}
    expected |= {"NRHS": 2, "U": [0, load / 10], "DU": [0, increment / 10, 0, 0], "ADLMAG": load, "DDLMAG": increment}
    expected |= {"PREDEF": [20, 0, 4, 0] * 2, "LFLAGS": [1, "large" in kind, 1, 0, 0, 0, 0]}
    check(given, OF_SPRING | expected)


def test_the_page_names_tests_of_each_routine(load):
    rows = [line.split("|")[1:-1] for line in PAGE.read_text().splitlines() if ".py::" in line]
    library = load(None)
    assert {row[0].strip() for row in rows} == {name for name in ENTRY_POINTS if hasattr(library, name.lower())}
    for file, name in re.findall(r"`(test_\w+\.py)::(test_\w+)`", "".join(map("".join, rows))):
        (path,) = HERE.parent.rglob(file)
        assert f"def {name}(" in path.read_text(), name
