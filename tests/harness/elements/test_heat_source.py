# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""RPL, DRPLDT, DRPLDE and DDSDDT of UMAT, and HETVAL after it, in coupled temperature-displacement elements."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from differences import differences
from moving_element import turn
from reference_cells import unit_cell
from small_decks import body_lines

from uel.elements import Flags
from uel.errors import Source
from uel.model.element_types import CONTINUUM, COUPLED
from uel.model.mesh import ElementGroup
from uel.model.properties import Expansion, Material, Orientation, SolidSection, UserMaterial

HERE = Path(__file__).parent
SOURCE = Source("test.inp", 1)
CONDUCTIVITY, THICKNESS, SIDE = 3.0, 0.5, 0.4
"""Of a bar of length 1 along direction 1, about an axis along 2; its section is SIDE by SIDE, or THICKNESS."""


def bar(element_type, count):
    """Nodes and elements of a bar along direction 1, or 2 about an axis; corners along it are sorted."""
    kind = (CONTINUUM | COUPLED)[element_type]
    quadratic = kind.nodes > 2**kind.dimension
    x = np.linspace(0.0, 1.0, count * (2 if quadratic else 1) + 1)
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    if kind.dimension == 3:
        square = np.array([[*corner, z] for z in (0, 1) for corner in square])
    if quadratic:
        sides = [[0, 1], [1, 2], [2, 3], [3, 0]]
        if kind.dimension == 3:
            sides += [[4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]]
        square = np.vstack([square, square[sides].mean(axis=1)])
    nodes, elements = {}, []
    for k in range(count):
        places = np.array(square, dtype=float)
        places[:, 0] = np.interp(places[:, 0], [0, 1], x[[k * (len(x) - 1) // count, (k + 1) * (len(x) - 1) // count]])
        places[:, 1:] *= SIDE
        if kind.axisymmetric:
            # turned by a right angle
            places = np.stack([SIDE - places[:, 1], places[:, 0]], axis=1)
        elements.append([nodes.setdefault(tuple(np.round(place, 9)), len(nodes)) for place in places])
    return np.array(list(nodes)), np.array(elements)


def deck(element_type, mesh, material, step, *, procedure, options=""):
    """A deck of one body, with temperatures, heat, displacements and forces at all nodes."""
    lines = [*body_lines(element_type, *mesh), "*SOLID SECTION, ELSET=BODY, MATERIAL=M", f"{THICKNESS}"]
    if COUPLED.get(element_type) and COUPLED[element_type].hourglass_control:
        lines += ["*HOURGLASS STIFFNESS", "1."]
    lines += ["*MATERIAL, NAME=M", material, f"*STEP{options}, INC=1000", procedure, step]
    lines += ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "NT, RFL, U, RF", "*OUTPUT, FIELD", "*END STEP", ""]
    return "\n".join(lines)


STEADY = "*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE\n1., 1."
THERMAL = {"conductivity": np.array([[CONDUCTIVITY, 0.0]]), "specific_heat": np.array([[0.7, 0.0]])}
HEAT = f"*CONDUCTIVITY\n{CONDUCTIVITY}\n*DENSITY\n2.\n*SPECIFIC HEAT\n0.7\n"


def generating(*, a=0.0, b=0.0, c=0.0, d=0.0, nu=0.3, couplings=(1, 1, 1)):
    """The material of heat.f."""
    values = ", ".join(map(str, (1000.0, nu, a, b, c, d, *couplings[:2])))
    return f"{HEAT}*USER MATERIAL, CONSTANTS=9\n{values}\n{couplings[2]}\n*DEPVAR\n2"


def last(history, name, count):
    """(nodes,) of a nodal variable, NaN at nodes without it."""
    return np.array([history.get(f"{name}[ALL:{k}]", [np.nan])[-1] for k in range(1, count + 1)])


def held(nodes, ends, *, dof=11, value=0.0):
    """*BOUNDARY that holds all displacements, and a dof at nodes."""
    dimension = nodes.shape[1]
    return f"*BOUNDARY\nALL, 1, {dimension}\n" + "".join(f"{k + 1}, {dof}, {dof}, {value!r}\n" for k in ends)


BARS = [name for name, kind in COUPLED.items() if kind.corners == 2**kind.dimension]


@pytest.mark.sample(3)
@pytest.mark.parametrize("element_type", BARS)
@pytest.mark.parametrize("procedure", [STEADY, "*COUPLED TEMPERATURE-DISPLACEMENT\n1e6, 1e7"])
def test_a_constant_source_makes_a_parabola(run_deck, element_type, procedure):
    """Both ends at 0: T = a s (1 - s)/(2 k) at the nodes, and all heat leaves through the ends."""
    nodes, elements = bar(element_type, 5)
    along = nodes[:, int(COUPLED[element_type].axisymmetric)]
    corners = np.unique(elements[:, : COUPLED[element_type].corners])
    ends = [k for k in corners if along[k] in (0.0, 1.0)]
    text = deck(element_type, (nodes, elements), generating(a=7.0), held(nodes, ends), procedure=procedure)
    history = run_deck(text, HERE / "heat.f").history
    s = along[corners]
    found = last(history, "NT11", len(nodes))[corners]
    np.testing.assert_allclose(found, 7.0 * s * (1 - s) / (2 * CONDUCTIVITY), rtol=1e-5, atol=1e-12)
    section = {2: THICKNESS * SIDE, 3: SIDE**2}[nodes.shape[1]]
    if COUPLED[element_type].axisymmetric:
        section = np.pi * SIDE**2
    heat = last(history, "RFL11", len(nodes))[corners].sum()
    assert heat == pytest.approx(-7.0 * section, rel=1e-5)


@pytest.mark.parametrize("element_type", ["CPE4T", "CPE4RT", "C3D8T", "CPE8T", "CAX4T"])
def test_a_source_that_falls_with_temperature_makes_a_hyperbolic_cosine(run_deck, element_type):
    """One end at 1: T = cosh(m (1 - s))/cosh(m), m^2 = b/k; four times as exact with half the element length."""
    errors = []
    for count in (8, 16):
        nodes, elements = bar(element_type, count)
        along = nodes[:, int(COUPLED[element_type].axisymmetric)]
        corners = np.unique(elements[:, : COUPLED[element_type].corners])
        ends = [k for k in corners if along[k] == 0.0]
        text = deck(element_type, (nodes, elements), generating(b=12.0), held(nodes, ends, value=1.0), procedure=STEADY)
        result = run_deck(text, HERE / "heat.f")
        found, m = last(result.history, "NT11", len(nodes))[corners], np.sqrt(12.0 / CONDUCTIVITY)
        errors.append(abs(found - np.cosh(m * (1 - along[corners])) / np.cosh(m)).max())
        # linear, and DRPLDT is in the matrix
        assert [line.total_iterations for line in result.status] == [1]
    assert errors[0] < 5e-3
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)


def test_the_heat_capacity_and_the_source_by_backward_euler(run_deck):
    """Without conduction all of it warms alike: rho c dT/dt = a - b T, in increments of h."""
    nodes, elements = bar("CPE4T", 1)
    procedure = "*COUPLED TEMPERATURE-DISPLACEMENT\n0.1, 1."
    text = deck("CPE4T", (nodes, elements), generating(a=7.0, b=2.0), held(nodes, []), procedure=procedure)
    history = run_deck(text, HERE / "heat.f").history
    expected = 3.5 * (1 - (1 + 2.0 * 0.1 / 1.4) ** -np.arange(1.0, 11.0))
    np.testing.assert_allclose(history["NT11[ALL:1]"][-10:], expected, rtol=1e-9)


def test_umat_gets_the_temperatures_of_the_nodes(run_deck):
    """At the start of the second increment, and their change: means over the points of what is linear."""
    nodes, elements = bar("CPE4T", 1)
    warm = "".join(f"{k + 1}, 11, 11, {6.0 * x[0] + 2.0}\n" for k, x in enumerate(nodes))
    text = deck(
        "CPE4T",
        (nodes, elements),
        generating(),
        "*BOUNDARY\nALL, 1, 2\n" + warm,
        procedure=STEADY.replace("1., 1.", "0.5, 1., 0.5, 0.5"),
    )
    result = run_deck(text, HERE / "heat.f")
    assert result.field("SDV1") == pytest.approx([2.5])
    assert result.field("SDV2") == pytest.approx([2.5])


def test_temperatures_without_a_coupled_element_do_nothing(run_deck):
    """In *STATIC with CPE4 RPL, DRPLDT, DRPLDE and DDSDDT are ignored."""
    mesh = bar("CPE4", 1)
    step = "*BOUNDARY\n1, 1, 2\n4, 1\n2, 1, 1, 0.1\n3, 1, 1, 0.1"
    plain, heated = (
        run_deck(deck("CPE4", mesh, generating(**more), step, procedure="*STATIC\n1., 1."), HERE / "heat.f").history
        for more in ({}, {"a": 5.0, "b": 7.0, "c": 9.0})
    )
    np.testing.assert_array_equal(last(plain, "U2", 4), last(heated, "U2", 4))


TANGENTS = ["CPE3T", "CPE4T", "CPE4RT", "CPE8T", "CPS4T", "CPS8RT", "CAX4T", "CAX8RT"]
TANGENTS += ["C3D4T", "C3D6T", "C3D8T", "C3D10T", "C3D20RT"]
TANGENTS += ["CPE8HT", "CAX4HT", "C3D8HT", "C3D20RHT"]


@pytest.mark.parametrize("element_type", TANGENTS)
@pytest.mark.parametrize(("lflag", "angle"), [(71, None), (72, None), (72, 30.0)])
def test_tangent_is_the_derivative_of_the_residual(load, bound, call, element_type, lflag, angle):
    """Of a distorted element that is strained, warm and expands: central differences of what is quadratic are exact."""
    kind = COUPLED[element_type]
    if kind.corners != 2**kind.dimension:
        nodes = unit_cell(kind.family.cell)[0]
    else:
        nodes, elements = bar(element_type, 1)
        nodes = nodes[elements[0]]
    random = np.random.default_rng(5)
    nodes = nodes + 0.05 * random.uniform(-1, 1, nodes.shape) + 0.1
    constants = np.array([1000.0, 0.3, 7.0, 2.0, 11.0, 3.0, 1.0, 1.0, 1.0])
    given = UserMaterial(constants, False, SOURCE)
    expansion = Expansion(np.array([[0.0, 0.02, 0.03, 0.01, 0.02, 0.0, 0.0]]), 0.0, SOURCE)
    material = Material("M", SOURCE, user=given, state_variables=2, density=2.0, expansion=expansion, **THERMAL)
    # UMAT in global directions, or in turned ones
    orientation = None if angle is None else Orientation("O", turn(np.radians(angle)).T, SOURCE)
    section = SolidSection("ALL", material, orientation, THICKNESS, SOURCE, hourglass=1.0)
    group = ElementGroup(element_type, np.array([101]), np.arange(kind.nodes)[None], "", section, None, SOURCE)
    block, matrix = bound(group, nodes, load("heat.f"))
    call = replace(call, flags=Flags(lflag), unsymmetric=True)
    used = np.array([11 * node + dof - 1 for node, dof in block.unknowns])
    u, n = np.zeros(matrix.shape[0]), matrix.shape[0]
    u[used] = random.uniform(-0.1, 0.1, len(used))
    u[10::11] += 2.0 * (u[10::11] != 0)
    du = 0.3 * u
    block.evaluate(call, u, du, np.zeros(n), matrix.data)
    difference = differences(block, call, u, du, used)
    found = matrix.toarray()[np.ix_(used, used)]
    np.testing.assert_allclose(found, difference, rtol=1e-7, atol=1e-8 * abs(found).max())
    thermal = np.array([dof for _, dof in block.unknowns]) == 11
    assert abs(found[np.ix_(thermal, ~thermal)]).max() > 0.1
    assert abs(found[np.ix_(~thermal, thermal)]).max() > 0.1


EXACT = "*CONTROLS, PARAMETERS=FIELD, FIELD=GLOBAL\n1e-11"
YOUNG, LENGTH, TOUGHNESS = 200.0, 0.2, 0.5


def fractured(*, couplings=1):
    """The material of phase.f: the analogy needs a conductivity of 1."""
    heat = "*CONDUCTIVITY\n1.\n*DENSITY\n1.\n*SPECIFIC HEAT\n1.\n"
    return f"{heat}*USER MATERIAL, CONSTANTS=4\n{YOUNG}, {LENGTH}, {TOUGHNESS}, {couplings}\n*DEPVAR\n1"


def pulled(element_type, *, couplings=1, options=""):
    """A bar of two elements that is pulled to a strain of 0.1 and let go, in ten increments."""
    nodes, elements = bar(element_type, 2)
    axis = 2 if COUPLED[element_type].axisymmetric else 1
    along = nodes[:, axis - 1]
    lines = [f"{k + 1}, {axis}\n" for k in range(len(nodes)) if along[k] == 0.0]
    # nothing moves aside with nu = 0
    lines += [f"ALL, {dof}\n" for dof in range(1, nodes.shape[1] + 1) if dof != axis]
    lines += [f"{k + 1}, {axis}, {axis}, 0.1\n" for k in range(len(nodes)) if along[k] == 1.0]
    step = "*BOUNDARY, AMPLITUDE=UPDOWN\n" + "".join(lines)
    text = deck(
        element_type,
        (nodes, elements),
        fractured(couplings=couplings),
        step,
        procedure=STEADY.replace("1., 1.", "0.1, 1., 0.1, 0.1"),
        options=options,
    )
    return nodes, along, text.replace("*STEP", "*AMPLITUDE, NAME=UPDOWN\n0., 0., 0.5, 1., 1., 0.\n*STEP", 1)


@pytest.mark.parametrize("element_type", ["CPE4T", "CPE8T", "CPS4T", "CPS8RT", "CAX4T", "C3D8T", "C3D20RT"])
@pytest.mark.parametrize("user", ["phase.f", "phase_hetval.f"])
def test_phase_field_of_a_uniform_bar(run_deck, element_type, user):
    """phi = 2 H l/(Gc + 2 H l), H = E e^2/2 at the largest strain so far, and the stress (1 - phi)^2 E e."""
    nodes, along, text = pulled(element_type)
    if user == "phase_hetval.f":
        text = text.replace("*DEPVAR\n1", "*HEAT GENERATION\n*DEPVAR\n3")
        # without DRPLDE and DDSDDT Newton's method comes to its end slowly
        text = text.replace("*OUTPUT, HISTORY", f"{EXACT}\n*OUTPUT, HISTORY")
    history = run_deck(text, HERE / user).history
    strain = 0.1 * np.concatenate([np.linspace(0.2, 1.0, 5), np.linspace(0.8, 0.0, 5)])
    energy = np.maximum.accumulate(0.5 * YOUNG * strain**2)
    phase = 2 * energy * LENGTH / (TOUGHNESS + 2 * energy * LENGTH)
    stress = (1 - phase) ** 2 * YOUNG * strain
    np.testing.assert_allclose(history["NT11[ALL:1]"][-10:], phase, rtol=1e-9)
    axis = 2 if COUPLED[element_type].axisymmetric else 1
    right = [f"RF{axis}[ALL:{k + 1}]" for k in range(len(nodes)) if along[k] == 1.0]
    section = {2: THICKNESS * SIDE, 3: SIDE**2}[nodes.shape[1]]
    if COUPLED[element_type].axisymmetric:
        section = np.pi * SIDE**2
    force = sum(np.array(history[name][-10:]) for name in right)
    np.testing.assert_allclose(force, section * stress, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("element_type", ["CPE4T", "CPS8RT", "C3D8T"])
def test_couplings_in_the_tangent_make_newton_quadratic(run_deck, element_type):
    """A force of 0.8 of the largest in one increment: with DRPLDE and DDSDDT in a few iterations, without in many."""
    # the stress E e/(1 + s)^2, s = E e^2 l/Gc, is largest where s = 1/3
    strain = np.sqrt(0.1 * TOUGHNESS / (YOUNG * LENGTH))
    stress = YOUNG * strain / (1 + 0.1) ** 2
    iterations = []
    for couplings in (1, 0):
        nodes, along, text = pulled(element_type, couplings=couplings)
        ends = [k for k in range(len(nodes)) if along[k] == 1.0]
        moved = "".join(f"{k + 1}, 1, 1, 0.1\n" for k in ends)
        # all ends go with one, which takes the force
        tied = "".join(f"*EQUATION\n2\n{k + 1}, 1, 1., {ends[0] + 1}, 1, -1.\n" for k in ends[1:])
        section = THICKNESS * SIDE if nodes.shape[1] == 2 else SIDE**2
        force = f"*CLOAD\n{ends[0] + 1}, 1, {section * stress}\n"
        text = (
            text.replace(moved, "")
            .replace("*OUTPUT, HIST", f"{force}*OUTPUT, HIST")
            .replace("*AMPLI", f"{tied}*AMPLI", 1)
        )
        text = text.replace(", AMPLITUDE=UPDOWN", "").replace("0.1, 1., 0.1, 0.1", "1., 1.")
        result = run_deck(text, HERE / "phase.f")
        assert result.history[f"U1[ALL:{ends[0] + 1}]"][-1] == pytest.approx(strain, rel=2e-3)
        iterations.append(sum(line.total_iterations for line in result.status))
    assert iterations[0] <= 6
    assert iterations[1] >= 2 * iterations[0]
