# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*CREEP, LAW=USER: CREEP against *CREEP, an independent integration of its law, differences, and its arguments."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from differences import asymmetry_along_a_path
from small_decks import body_lines

from uel.elements import Flags
from uel.errors import DeckError, KernelError, Source
from uel.model.properties import Creep, Elastic, ElasticType, Material

HERE = Path(__file__).parent
SOURCE = Source("deck.inp", 15)
YOUNG, NU, VISCO = 1000.0, 0.3, 21
CREEP = """      SUBROUTINE CREEP(DECRA,DESWA,STATEV,SERD,EC,ESW,P,QTILD,
     1 TEMP,DTEMP,PREDEF,DPRED,TIME,DTIME,CMNAME,LEXIMP,LEND,
     2 COORDS,NSTATV,NOEL,NPT,LAYER,KSPT,KSTEP,KINC)
      INCLUDE 'ABA_PARAM.INC'
      CHARACTER*80 CMNAME
      DIMENSION DECRA(5),DESWA(5),STATEV(*),PREDEF(*),DPRED(*),
     1 TIME(3),EC(2),ESW(2),COORDS(*)
{}
      END
"""
NORTON = """      DECRA(1) = 1.D-6*QTILD**3*DTIME
      IF (LEXIMP .EQ. 1) DECRA(5) = 3.D-6*QTILD**2*DTIME"""
HARDENING = """      DECRA(1) = 1.D-5*QTILD**3*EXP(-60*EC(2))*(1 + 0.004*P)*DTIME
      DECRA(2) = -60*DECRA(1)
      DECRA(4) = 1.D-5*QTILD**3*EXP(-60*EC(2))*0.004*DTIME
      DECRA(5) = 3.D-5*QTILD**2*EXP(-60*EC(2))*(1 + 0.004*P)*DTIME"""
"""Slower as it goes on, and faster under pressure."""
CUBE = np.array([[x, y, z] for z in (0.0, 1.0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))])
CELLS = {"C3D8": CUBE, "C3D8R": CUBE, "C3D8I": CUBE, "C3D4": CUBE[[0, 1, 3, 4]]}
CELLS |= dict.fromkeys(("CPE4", "CPE4R", "CPS4", "CAX4", "CPS4I"), CUBE[:4, :2] + [0.5, 0.0])
CELLS |= {"CPS3": CUBE[:3, :2]}
BY_USER = "*CREEP, LAW=USER"


def deck(element_type, law, *, step="", procedure="*VISCO\n0.5, 2.", held="", more="", load=""):
    """Nodes of the lower side stay, the others are pulled up, each by another displacement."""
    nodes = CELLS[element_type]
    lines = body_lines(element_type, nodes, [range(len(nodes))])
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=STUFF", "1.", "*MATERIAL, NAME=STUFF", "*DENSITY", "1e-6"]
    lines += ["*ELASTIC", f"{YOUNG}, {NU}", law, more, f"*STEP{step}", procedure, load]
    pulled = [f"{k}, 2, 2, {0.03 + 0.002 * k}" if x[1] > 0 else f"{k}, 1, {len(x)}" for k, x in enumerate(nodes, 1)]
    lines += ["*BOUNDARY", *pulled] if not held else [held]
    lines += ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "U, RF", "*ENERGY OUTPUT", "*OUTPUT, FIELD"]
    return "\n".join(line for line in [*lines, "*ELEMENT OUTPUT", "S, SDV", "*END STEP"] if line) + "\n"


@pytest.fixture
def run_with_creep(run_deck):
    def run_with_creep(text, body=NORTON, more=""):
        return run_deck(text, CREEP.format(body) + more)

    return run_with_creep


@pytest.mark.sample(3)
@pytest.mark.parametrize("procedure", ["*VISCO\n0.5, 2.", "*VISCO, CETOL=1e-3\n0.02, 2."])
@pytest.mark.parametrize("step", ["", ", NLGEOM"])
@pytest.mark.parametrize("element_type", CELLS)
def test_norton_of_creep_is_that_of_the_deck(run_with_creep, element_type, step, procedure):
    """The same forces, energies, increments and iterations."""
    found = run_with_creep(deck(element_type, BY_USER, step=step, procedure=procedure))
    expected = run_with_creep(deck(element_type, "*CREEP\n1e-6, 3., 0.", step=step, procedure=procedure))
    assert max(expected.history["ALLCD"]) > 0.01 * max(expected.history["ALLIE"])
    largest = max(abs(np.array(values)).max() for name, values in expected.history.items() if name.startswith("RF"))
    for name, values in expected.history.items():
        scale = largest if name.startswith("RF") else max(expected.history["ALLIE"])
        np.testing.assert_allclose(found.history[name], values, rtol=1e-9, atol=1e-9 * scale, err_msg=name)
    assert [row.total_iterations for row in found.status] == [row.total_iterations for row in expected.status]


@pytest.fixture
def point(material_point):
    def point(tensor, body):
        law = Creep(False, 0.0, 0.0, 0.0, SOURCE, user=True)
        material = Material("M", SOURCE, Elastic(ElasticType.ISOTROPIC, (YOUNG, NU), SOURCE), creep=law)
        source = f"      INCLUDE '{HERE / 'point.f'}'\n{CREEP.format(body)}"
        respond = material_point(material, tensor, user=source, unsymmetric=True)
        respond.call = replace(respond.call, flags=Flags(VISCO), unsymmetric=True)
        return respond

    return point


def pass_time(respond, begin, end):
    respond.call = replace(respond.call, step_time=end, total_time=end, time_increment=end - begin)


@pytest.mark.parametrize("tensor", ["PSTRESS", "PSTRAIN", "THREED"])
def test_consistent_tangent(point, tensor):
    """With the pressure it is not symmetric."""
    assert asymmetry_along_a_path(point(tensor, HARDENING), pass_time) > 1e-3


def test_relaxation_by_backward_euler(point):
    """At a constant shear strain: q = 3 G (e0 - e), e' = A q^3 exp(-60 e), each increment solved by bisection."""
    respond, strain = point("THREED", HARDENING), 0.05
    shear, creep = YOUNG / (2 * (1 + NU)), 0.0
    for k, size in enumerate([0.1, 0.5, 2.0]):
        pass_time(respond, float(k), k + size)
        stress, _ = respond(strain * np.eye(6)[3])
        respond.block.commit()
        low, high = creep, strain / np.sqrt(3)
        for _ in range(200):
            middle = (low + high) / 2
            q = 3 * shear * (strain / np.sqrt(3) - middle)
            slow = middle - creep < 1e-5 * q**3 * np.exp(-60 * middle) * size
            low, high = (middle, high) if slow else (low, middle)
        creep = low
        assert np.sqrt(3) * stress[3] == pytest.approx(3 * shear * (strain / np.sqrt(3) - creep), rel=1e-9)
        np.testing.assert_allclose(np.delete(stress, 3), 0, atol=1e-9)


PRINT = """      IF (NPT .EQ. 1) THEN
      WRITE(6,'(A,9I6,1X,A)') 'GIVEN ', KSTEP, KINC, LEND, LEXIMP,
     1 NOEL, NPT, LAYER, KSPT, NSTATV, TRIM(CMNAME)
      WRITE(6,'(A,9F14.8)') 'GIVEN ', TIME, DTIME, TEMP, DTEMP,
     1 PREDEF(1), DPRED(1), SERD
      WRITE(6,'(A,12E18.10)') 'GIVEN ', EC, ESW, P, QTILD,
     1 (COORDS(I),I=1,3), STATEV(1), SUM(ABS(DECRA)+ABS(DESWA))
      END IF
      STATEV(1) = STATEV(1) + 1
"""
BAR = "*BOUNDARY, OP=NEW\n1, 1, 3\n4, 1\n5, 1\n8, 1\n2, 2, 3\n5, 2\n6, 2\n4, 3\n3, 3\n"
FIELDS = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 20.\n*INITIAL CONDITIONS, TYPE=FIELD\nALL, 4."


@pytest.mark.parametrize("options", ["", ", NLGEOM"])
def test_arguments_of_creep(run_with_creep, tmp_path, options):
    """A bar is stretched at once in *STATIC, where materials do not creep, and held in two increments of *VISCO: first
    all values of the start of the increment with LEND = 0, then those of its end with LEND = 1."""
    ends = "".join(f"{k}, 1, 1, 0.02\n" for k in (2, 3, 6, 7))
    first = deck(
        "C3D8", BY_USER, procedure="*STATIC\n1., 1.", held=BAR + ends, more=f"*DEPVAR\n1\n{FIELDS}", step=options
    )
    load = "*TEMPERATURE\nALL, 60.\n*FIELD\nALL, 6.\n"
    text = f"{first}*STEP{options}\n*VISCO\n0.5, 1.\n{load}*OUTPUT, FIELD\n*ELEMENT OUTPUT\nS, CEEQ\n*END STEP\n"
    found = run_with_creep(text.replace("S, CEEQ", "S"), PRINT + NORTON)
    lines = [line.split()[1:] for line in (tmp_path / "deck.dat").read_text().splitlines() if "GIVEN " in line]
    calls = list(zip(lines[::3], lines[1::3], lines[2::3], strict=True))
    assert {call[0][0] for call in calls} == {"2"}
    stresses = [float(found.field("S11", step=2, increment=k)[0]) for k in (1, 2)]
    # by the middle of the increment with NLGEOM
    strain = 0.02 / 1.01 if options else 0.02
    start, before = YOUNG * strain, 0.0
    for increment, stress in enumerate(stresses, 1):
        of_increment = [call for call in calls if call[0][1] == str(increment)]
        creep = strain - stress / YOUNG
        for lend, (given, q, strains) in ((0, (0, start, (before, before))), (-1, (1, stress, (before, creep)))):
            names, times, values = of_increment[0] if lend == 0 else of_increment[-1]
            assert names == ["2", str(increment), str(given), "1", "1", "1", "1", "1", "1", "STUFF"]
            end = 0.5 * increment
            # in *VISCO fields act at once
            np.testing.assert_allclose(np.array(times, float), [end, 1 + end, end, 0.5, 60, 0, 6, 0, 0], atol=1e-8)
            values = np.array(values, float)
            np.testing.assert_allclose(values[:2], strains, rtol=1e-5, atol=1e-9)
            assert (values[2:4] == 0).all()
            np.testing.assert_allclose(values[4:6], [-q / 3, q], rtol=1e-5)
            place = np.full(3, 0.5 - 0.5 / 3**0.5)
            stretched = place * [1.02 if options else 1, 1, 1]
            np.testing.assert_allclose(values[6], stretched[0], rtol=1e-6)
            assert values[9] == increment - 1
            assert values[10] == 0
        start, before = stress, creep


def test_state_variables_and_calls_of_each_increment(run_with_creep):
    """Each call gets STATEV of the start of the increment; those of the last one stay."""
    result = run_with_creep(
        deck("CPE4", BY_USER, more="*DEPVAR\n1"), "      STATEV(1) = STATEV(1) + LEND + 1\n" + NORTON
    )
    np.testing.assert_array_equal(result.field("SDV1"), 8.0)


def test_usdfld_before_creep(run_with_creep):
    """The field of USDFLD, and its STATEV: the rate grows with both."""
    usdfld = f"""      INCLUDE '{HERE.parent / "usdfld.inc"}'
      FIELD(1) = 2
      STATEV(1) = 3
      END
"""
    more = "*DEPVAR\n1\n*USER DEFINED FIELD"
    body = """      A = 1.D-6*PREDEF(1)*STATEV(1)
      DECRA(1) = A*QTILD**3*DTIME
      DECRA(5) = 3*A*QTILD**2*DTIME"""
    found = run_with_creep(deck("C3D8", BY_USER, more=more), body, usdfld)
    expected = run_with_creep(deck("C3D8", "*CREEP\n6e-6, 3., 0."))
    np.testing.assert_allclose(found.history["RF2[ALL:1]"], expected.history["RF2[ALL:1]"], rtol=1e-9)


def test_creep_writes_outside_decra(run_with_creep):
    result = run_with_creep(deck("CPE4", BY_USER), NORTON + "\n      DECRA(6) = 1")
    message = "element 1: CREEP writes outside DECRA: entry 6 of 5 (5) at integration point 1; the run goes on"
    assert any(message in warning for warning in result.warnings)


def test_swelling_needs_a_keyword(run_with_creep):
    """*SWELLING, LAW=USER, says that CREEP gives DESWA (Abaqus Keywords Guide); it is not supported."""
    result = run_with_creep(deck("CPE4", BY_USER), NORTON + "\n      DESWA(1) = 1.D-3*DTIME")
    warnings = [warning for warning in result.warnings if "CREEP gives DESWA, which has no effect" in warning]
    assert len(warnings) == 1
    expected = run_with_creep(deck("CPE4", BY_USER))
    np.testing.assert_array_equal(result.history["RF2[ALL:1]"], expected.history["RF2[ALL:1]"])
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: \*SWELLING"):
        run_with_creep(deck("CPE4", BY_USER, more="*SWELLING, LAW=USER"))


@pytest.mark.parametrize(
    ("body", "message"),
    [
        pytest.param(
            "      DECRA(1) = SQRT(-1.D0 - QTILD)",
            "CREEP gives DECRA.1. = .* at QTILD = .*; expected 0 or more, and numbers in DECRA",
            marks=pytest.mark.nan,
        ),
        ("      DECRA(1) = -1.D-6*QTILD", "CREEP gives DECRA.1. = -.* at QTILD = .*; expected 0 or more"),
        ("      IF (NPT .EQ. 3) CALL XIT\n" + NORTON, "CREEP at integration point 3 stopped the analysis"),
    ],
)
def test_creep_ends_the_analysis(run_with_creep, body, message):
    with pytest.raises(KernelError, match=rf"element 1 \(type CPE4\).*{message}"):
        run_with_creep(deck("CPE4", BY_USER), body)


def test_a_job_without_creep(run_with_creep, run_deck, tmp_path):
    message = r"deck\.inp:\d+: \*CREEP, LAW=USER: material STUFF needs CREEP; .* has no user routine"
    (tmp_path / "nothing.f").write_text("      SUBROUTINE NOTHING\n      END\n")
    with pytest.raises(DeckError, match=message):
        run_deck(deck("C3D8", BY_USER), tmp_path / "nothing.f")
