# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*PLASTIC, HARDENING=USER: UHARD against tables, yield stresses by rate and temperature, its arguments."""

from dataclasses import replace

import numpy as np
import pytest
from differences import differences
from moving_element import turn
from reference_cells import unit_cell
from small_decks import body_lines

from uel.elements import Flags
from uel.errors import DeckError, KernelError, Source
from uel.model.element_types import COUPLED
from uel.model.mesh import ElementGroup
from uel.model.properties import Elastic, ElasticType, Expansion, Material, Orientation, Plastic, SolidSection

YOUNG, NU, SIZE, SLOPE, VISCOSITY = 1000.0, 0.3, 5.0, 80.0, 2.0
CUBE = np.array([[x, y, z] for z in (0.0, 1.0) for x, y in ((0, 0), (1.2, 0), (1, 1), (0, 1))])
UHARD = """      SUBROUTINE UHARD(SYIELD,HARD,EQPLAS,EQPLASRT,TIME,DTIME,TEMP,
     1 DTEMP,NOEL,NPT,LAYER,KSPT,KSTEP,KINC,CMNAME,NSTATV,STATEV,
     2 NUMFIELDV,PREDEF,DPRED,NUMPROPS,PROPS)
      INCLUDE 'ABA_PARAM.INC'
      CHARACTER*80 CMNAME
      DIMENSION HARD(3),STATEV(NSTATV),TIME(*),PREDEF(NUMFIELDV),
     1 DPRED(*),PROPS(*)
{}
      END
"""
LINES = """      SYIELD = PROPS(1) + PROPS(2)*EQPLAS + PROPS(3)*EQPLASRT
      HARD(1) = PROPS(2)
      HARD(2) = PROPS(3)"""
LINEAR = UHARD.format(LINES)
SOFTENING = 0.03
WARM = UHARD.format(
    f"""{LINES}
      SYIELD = SYIELD - {SOFTENING}D0*(TEMP + DTEMP)
      HARD(3) = -{SOFTENING}D0"""
)
BY_USER = f"*PLASTIC, HARDENING=USER, PROPERTIES=3\n{SIZE}, {SLOPE}, 0."
TABLE = f"*PLASTIC\n{SIZE}, 0.\n{SIZE + SLOPE}, 1."
PULLED = "*BOUNDARY\nALL, 2\n1, 1\n4, 1\n2, 1, 1, 0.03\n3, 1, 1, 0.05\n"
CELLS = {"C3D8": CUBE, "C3D8R": CUBE, "C3D8H": CUBE, "C3D8I": CUBE, "C3D4": CUBE[[0, 1, 3, 4]]}
CELLS |= dict.fromkeys(("CPE4", "CPE4R", "CPE4I", "CPS4", "CPS4I", "CAX4"), CUBE[:4, :2])
CELLS |= {"CPS3": CUBE[:3, :2], "CPE3": CUBE[:3, :2]}
WARM_CELLS = {"C3D8RT": CUBE, "C3D8T": CUBE, "CPS3T": CUBE[:3, :2]}


def deck(element_type, plastic, *, step="", procedure="*STATIC\n0.25, 1., 0.25, 0.25", held=PULLED, more="", load=""):
    nodes = (CELLS | WARM_CELLS).get(element_type, CUBE)
    lines = body_lines(element_type, nodes, [range(len(nodes))])
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=STUFF", "1.", "*MATERIAL, NAME=STUFF", "*DENSITY", "1e-6"]
    if element_type in COUPLED:
        lines += ["*CONDUCTIVITY", "1.", "*SPECIFIC HEAT", "1."]
    lines += ["*ELASTIC", f"{YOUNG}, {NU}", plastic, more, f"*STEP{step}", procedure, load, held.strip()]
    lines += ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "U, RF", "*ENERGY OUTPUT", "*OUTPUT, FIELD"]
    return "\n".join(line for line in [*lines, "*ELEMENT OUTPUT", "S, SDV", "*END STEP"] if line) + "\n"


def pulled(element_type):
    """The nodes of one side stay, the others are pulled away, each by another displacement."""
    nodes = (CELLS | WARM_CELLS)[element_type]
    left = [k + 1 for k in range(len(nodes)) if nodes[k, 0] == 0]
    lines = ["*BOUNDARY", *(f"{k}, 1, {nodes.shape[1]}" for k in left)]
    right = [k + 1 for k in range(len(nodes)) if nodes[k, 0] > 0]
    return "\n".join([*lines, *(f"{k}, 1, 1, {0.04 + 0.005 * k}" for k in right), "2, 2, 2, 0.02"])


@pytest.mark.sample(3)
@pytest.mark.parametrize("step", ["", ", NLGEOM"])
@pytest.mark.parametrize("element_type", CELLS)
def test_a_line_of_uhard_is_a_line_of_the_table(run_deck, element_type, step):
    """The same forces, energies and iterations: CPS4 has a return of its own for tables."""
    found = run_deck(deck(element_type, BY_USER, step=step, held=pulled(element_type)), LINEAR)
    expected = run_deck(deck(element_type, TABLE, step=step, held=pulled(element_type)))
    assert max(expected.history["ALLPD"]) > 0.0
    largest = max(abs(np.array(values)).max() for name, values in expected.history.items() if name.startswith("RF"))
    for name, values in expected.history.items():
        scale = largest if name.startswith("RF") else max(expected.history["ALLIE"])
        np.testing.assert_allclose(found.history[name], values, rtol=1e-6, atol=1e-6 * scale, err_msg=name)
    assert [row.total_iterations for row in found.status] == [row.total_iterations for row in expected.status]


BAR = "*BOUNDARY\n1, 1, 3\n4, 1\n5, 1\n8, 1\n2, 2, 3\n4, 3\n3, 3\n{}"


@pytest.mark.parametrize("procedure", ["*STATIC\n0.2, 1., 0.2, 0.2", "*VISCO\n0.2, 1., 0.2, 0.2"])
def test_a_yield_stress_that_depends_on_the_rate(run_deck, procedure):
    """A bar at a constant rate: E (e - p) = s + h p + n dp/dt, by backward Euler in each increment."""
    straight = np.array([[x, y, z] for z in (0.0, 1.0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))])
    CELLS["bar"] = straight
    ends = "".join(f"{k}, 1, 1, 0.02\n" for k in (2, 3, 6, 7))
    by_user = BY_USER.replace(" 0.", f" {VISCOSITY}")
    text = deck("bar", by_user, procedure=procedure, held=BAR.format(ends)).replace("TYPE=bar", "TYPE=C3D8")
    del CELLS["bar"]
    result = run_deck(text, LINEAR)
    force = sum(np.array(result.history[f"RF1[ALL:{k}]"]) for k in (2, 3, 6, 7))
    plastic, step = 0.0, 0.2
    for k, value in enumerate(force):
        trial = YOUNG * (0.02 * step * (k + 1) - plastic)
        growth = max(trial - SIZE - SLOPE * plastic, 0.0) / (YOUNG + SLOPE + VISCOSITY / step)
        plastic += growth
        assert value == pytest.approx(trial - YOUNG * growth, rel=1e-6)
    # the tangent has the rate too: one iteration finds the new increment, a second one confirms it
    assert max(row.total_iterations for row in result.status) <= 3


COUPLED_STEP = "*COUPLED TEMPERATURE-DISPLACEMENT{}\n0.5, 1., 0.5, 0.5"


@pytest.mark.parametrize(
    ("step", "procedure"),
    [
        (", AMPLITUDE=RAMP", COUPLED_STEP.format("")),
        ("", COUPLED_STEP.format(", STEADY STATE")),
        (", NLGEOM", COUPLED_STEP.format(", STEADY STATE")),
        ("", "*STATIC\n0.5, 1., 0.5, 0.5"),
        (", NLGEOM", "*STATIC\n0.5, 1., 0.5, 0.5"),
        ("", "*STATIC, RIKS\n0.5, 1., 0.5, 0.5, 1."),
        ("", "*VISCO\n0.5, 1., 0.5, 0.5"),
        ("", "*DYNAMIC, NOHAF\n0.5, 1., 0.5, 0.5"),
    ],
)
@pytest.mark.parametrize("element_type", ["C3D8R", "CPS3"])
def test_arguments_of_uhard(run_deck, tmp_path, element_type, step, procedure):
    """The first call of the second increment of a step has the values at its start, at the plastic strain before it."""
    if "COUPLED" in procedure:
        element_type += "T"
    body = f"""      IF (KINC .EQ. 2) THEN
      WRITE(6,'(A,8I4,1X,A)') 'UHARD ', NOEL, NPT, LAYER, KSPT,
     1 KSTEP, KINC, NSTATV, NUMFIELDV, TRIM(CMNAME)
      WRITE(6,'(A,I4,14F12.6)') 'UHARD ', NUMPROPS, PROPS(1),
     1 PROPS(2), PROPS(3), SYIELD, HARD(1), HARD(2), HARD(3),
     2 TIME(1), TIME(2), DTIME, TEMP, DTEMP, PREDEF(1), DPRED(1)
      WRITE(6,'(A,4E16.8)') 'UHARD ', EQPLAS, EQPLASRT, STATEV(1),
     1 STATEV(2)
      END IF
{LINES}
      STATEV(1) = STATEV(1) + 1
      STATEV(2) = EQPLAS"""
    more = "*DEPVAR\n2\n*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 20.\n*INITIAL CONDITIONS, TYPE=FIELD\nALL, 4."
    load = "" if "RIKS" in procedure else "*TEMPERATURE\nALL, 60.\n*FIELD\nALL, 6."
    if "COUPLED" in procedure:
        load = "*FIELD\nALL, 6.\n*BOUNDARY\nALL, 11, 11, 60."
    held = pulled(element_type) if "RIKS" not in procedure else pulled(element_type).replace("2, 2, 2, 0.02", "2, 2")
    text = deck(
        element_type,
        BY_USER.replace(" 0.", f" {VISCOSITY}"),
        step=step,
        procedure=procedure,
        more=more,
        load=load,
        held=held,
    )
    run_deck(text, UHARD.format(body))
    dat = (tmp_path / "deck.dat").read_text().splitlines()
    printed = [line.split()[1:] for line in dat if line.lstrip().startswith("UHARD ")]
    first, second, third = printed[:3]
    assert first == ["1", "1", "1", "1", "1", "2", "2", "1", "STUFF"]
    # in *VISCO and *DYNAMIC fields act at once
    varied = [60.0, 0.0, 6.0, 0.0] if "VISCO" in procedure or "DYNAMIC" in procedure else [40.0, 20.0, 5.0, 1.0]
    varied = varied if load else [20.0, 0.0, 4.0, 0.0]
    assert second[0] == "3"
    numbers = [float(number) for number in second[1:]]
    assert numbers[:7] == [SIZE, SLOPE, VISCOSITY, 0.0, 0.0, 0.0, 0.0]
    assert numbers[10:] == pytest.approx(varied)
    if "RIKS" not in procedure:
        assert numbers[7:10] == pytest.approx([0.5, 0.5, 0.5])
    plastic, rate, counted, kept = (float(number) for number in third)
    assert plastic > 0.0
    # the call for initial accelerations counts too
    calls = 2.0 if "DYNAMIC" in procedure else 1.0
    assert (rate, counted) == (0.0, calls)
    assert kept == pytest.approx(plastic)
    rows = np.array([[float(number) for number in row] for row in printed[2::3]])
    step_of = numbers[9]
    np.testing.assert_allclose(rows[:, 1] * step_of, rows[:, 0] - plastic, atol=1e-7)
    assert (rows[:, 1] > 0).any()
    assert (rows[:, 2] == calls).all()


def test_a_yield_stress_that_falls_with_the_temperature(run_deck):
    """A bar that is warmed while it is pulled: E (e - p) = s + h p - a T, at the end of each increment."""
    straight = np.array([[x, y, z] for z in (0.0, 1.0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))])
    ends = "".join(f"{k}, 1, 1, 0.02\n" for k in (2, 3, 6, 7)) + "ALL, 11, 11, 50.\n"
    procedure = "*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE\n0.2, 1., 0.2, 0.2"
    text = deck("C3D8T", BY_USER, procedure=procedure, held=BAR.format(ends))
    text = text.replace(
        "\n".join(body_lines("C3D8T", CUBE, [range(8)])), "\n".join(body_lines("C3D8T", straight, [range(8)]))
    )
    result = run_deck(text, WARM)
    force = sum(np.array(result.history[f"RF1[ALL:{k}]"]) for k in (2, 3, 6, 7))
    plastic = 0.0
    for k, value in enumerate(force, start=1):
        plastic += max(YOUNG * (0.004 * k - plastic) - SIZE - SLOPE * plastic + SOFTENING * 10 * k, 0.0) / (
            YOUNG + SLOPE
        )
        assert value == pytest.approx(YOUNG * (0.004 * k - plastic), rel=1e-6)
    assert plastic > 0.01


@pytest.mark.parametrize("angle", [None, 30.0])
@pytest.mark.parametrize("element_type", ["CPE4T", "CPS4T", "CAX4T", "C3D8T", "C3D8RT", "C3D8HT"])
def test_tangent_with_the_temperature(load, bound, call, element_type, angle):
    """Of a distorted element that flows and expands, by central differences, in any directions of the material."""
    kind, random, source = COUPLED[element_type], np.random.default_rng(5), Source("test.inp", 1)
    nodes = unit_cell(kind.family.cell)[0]
    nodes = nodes + 0.05 * random.uniform(-1, 1, nodes.shape) + 0.1
    material = Material(
        "STUFF",
        source,
        elastic=Elastic(ElasticType.ISOTROPIC, (YOUNG, NU), source),
        plastic=Plastic(np.zeros((0, 2)), source, user=np.array([SIZE, SLOPE, VISCOSITY])),
        expansion=Expansion(np.array([[0.0, 1e-4, 1e-4, 1e-4, 0.0, 0.0, 0.0]]), 0.0, source),
        conductivity=np.array([[3.0, 0.0]]),
        specific_heat=np.array([[0.7, 0.0]]),
        density=2.0,
    )
    orientation = None if angle is None else Orientation("O", turn(np.radians(angle)).T, source)
    section = SolidSection("ALL", material, orientation, 0.5, source, hourglass=1.0)
    group = ElementGroup(element_type, np.array([101]), np.arange(kind.nodes)[None], "", section, None, source)
    block, matrix = bound(group, nodes, load(WARM))
    call = replace(call, flags=Flags(72), unsymmetric=True)
    used = np.array([11 * node + dof - 1 for node, dof in block.unknowns])
    thermal = np.array([dof for _, dof in block.unknowns]) == 11
    u, n = np.zeros(matrix.shape[0]), matrix.shape[0]
    u[used] = random.uniform(-0.05, 0.05, len(used))
    u[used[thermal]] += 20.0
    block.evaluate(call, u, u, np.zeros(n), matrix.data)
    found = matrix.toarray()[np.ix_(used, used)]
    difference = differences(block, call, u, u, used, 1e-6)
    np.testing.assert_allclose(found, difference, atol=1e-6 * abs(found).max())
    by_temperature = np.ix_(~thermal, thermal)
    atol = 1e-5 * abs(found[by_temperature]).max()
    np.testing.assert_allclose(found[by_temperature], difference[by_temperature], atol=atol)


@pytest.mark.parametrize("element_type", ["CPE4", "C3D8"])
def test_an_increment_begins_elastically_after_one_with_plastic_strain(solid_group, bound, load, call, element_type):
    """Its stress is the yield stress but for rounding, which would choose the tangent otherwise."""
    nodes = np.pad(CELLS[element_type], ((0, 0), (0, 3 - CELLS[element_type].shape[1])))
    plastic = Plastic(np.zeros((0, 2)), Source("test.inp", 1), user=np.array([SIZE, SLOPE, 0.0]))
    group = solid_group(element_type, np.arange(len(nodes))[None], 1.0, plastic=plastic)
    block, matrix = bound(group, nodes, load(LINEAR))
    size, random = matrix.shape[0], np.random.default_rng(5)

    def tangent(u, du):
        matrix.data[:] = 0.0
        block.evaluate(call, u, du, np.zeros(size), matrix.data)
        return matrix.toarray()

    still = np.zeros(size)
    elastic = tangent(still, still)
    for u in random.uniform(-0.1, 0.1, (10, size)):
        assert abs(tangent(u, u) - elastic).max() > 0.1 * abs(elastic).max()
        block.commit()
        np.testing.assert_allclose(tangent(u, still), elastic, atol=1e-9 * abs(elastic).max())


def test_stresses_above_the_static_yield_stress_do_not_relax_in_no_time(run_deck):
    """The call for initial accelerations of the second step leaves them, as its very short increment does."""
    first = deck("C3D8", BY_USER.replace(" 0.", f" {VISCOSITY}"), held=pulled("C3D8"))
    result = run_deck(
        first
        + "*STEP\n*DYNAMIC, DIRECT, NOHAF\n1.e-9, 1.e-9\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nRF\n*END STEP\n",
        LINEAR,
    )
    force = np.array([result.history[f"RF1[ALL:{k}]"][-2:] for k in (1, 4, 5, 8)])
    np.testing.assert_allclose(force[:, 1], force[:, 0], rtol=1e-6)


def test_state_variables_of_each_increment(run_deck):
    """Each call gets STATEV of the start of the increment; those of the last one stay."""
    text = deck("CPE4", BY_USER, more="*DEPVAR\n1")
    result = run_deck(text, UHARD.format(LINES + "\n      STATEV(1) = STATEV(1) + 1"))
    np.testing.assert_array_equal(result.field("SDV1"), 4.0)


def test_uhard_writes_outside_hard(run_deck):
    result = run_deck(deck("CPE4", BY_USER), UHARD.format(LINES + "\n      HARD(4) = 1"))
    message = "element 1: UHARD writes outside HARD: entry 4 of 3 (3) at integration point 1; the run goes on"
    assert any(message in warning for warning in result.warnings)


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("      SYIELD = 0", "UHARD gives SYIELD = .* at EQPLAS = .*; expected a positive number"),
        pytest.param(
            "      SYIELD = SQRT(-1.D0*PROPS(1))",
            "UHARD gives SYIELD = .*; expected a positive number",
            marks=pytest.mark.nan,
        ),
        ("      IF (NPT .EQ. 3) CALL XIT\n" + LINES, r"UHARD at integration point 3 stopped the analysis"),
    ],
)
def test_uhard_ends_the_analysis(run_deck, body, message):
    with pytest.raises(KernelError, match=rf"element 1 \(type CPE4\).*{message}"):
        run_deck(deck("CPE4", BY_USER), UHARD.format(body))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (deck("C3D8", BY_USER.replace("=3", "=2")), r"PROPERTIES=2, but the data lines have 3"),
        (deck("C3D8", BY_USER.replace("=3", "=-1")), r"PROPERTIES=-1: expected a number of 0 or more"),
        (deck("C3D8", TABLE.replace("*PLASTIC", "*PLASTIC, PROPERTIES=2")), r"PROPERTIES goes with HARDENING=USER"),
        (
            deck(
                "C3D8",
                BY_USER,
                more="*ELEMENT, TYPE=T3D2, ELSET=T\n9, 1, 7\n*SOLID SECTION, ELSET=T, MATERIAL=STUFF\n1.",
            ),
            r"HARDENING=USER is not supported for elements of type T3D2",
        ),
        (
            deck(
                "C3D8",
                BY_USER,
                more="*ELEMENT, TYPE=S4, ELSET=T\n9, 1, 2, 3, 4\n*SHELL SECTION, ELSET=T, MATERIAL=STUFF\n1.",
            ),
            r"HARDENING=USER is not supported for elements of type S4",
        ),
        (
            deck("C3D8", BY_USER) + "*STEP, PERTURBATION\n*STATIC\n*END STEP\n",
            r"\*STATIC, PERTURBATION is not supported for material STUFF with \*PLASTIC, HARDENING=USER",
        ),
    ],
)
def test_what_is_wrong_is_named(run_deck, text, message):
    with pytest.raises(DeckError, match=rf"deck\.inp:\d+: .*{message}"):
        run_deck(text, LINEAR)


def test_a_job_without_uhard(run_deck):
    message = r"deck\.inp:\d+: \*PLASTIC, HARDENING=USER: material STUFF needs UHARD; .* has no user routine"
    with pytest.raises(DeckError, match=message):
        run_deck(deck("C3D8", BY_USER), "      SUBROUTINE NOTHING\n      END\n")
