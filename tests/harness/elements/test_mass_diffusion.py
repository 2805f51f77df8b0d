# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*MASS DIFFUSION in heat transfer elements, by theory: closed forms of J = -s D (grad phi + kappa_s grad ln(theta -
theta_Z) + kappa_p grad p), phi = c/s (Abaqus Theory Guide, Mass diffusion analysis)."""

from dataclasses import replace
from math import erfc
from pathlib import Path

import numpy as np
import pytest
from bars import bar, column, held
from differences import differences
from reference_cells import patch_of
from small_decks import body_lines

from uel.elements import Flags, Predefined
from uel.errors import DeckError, KernelError, Source
from uel.model.dofs import CONCENTRATION
from uel.model.element_types import BUILT_IN, HEAT
from uel.model.mesh import ElementGroup
from uel.model.procedures import MassDiffusion
from uel.model.properties import Diffusivity, Material, SolidSection
from uel.model.steps import Step

HERE = Path(__file__).parent
SOURCE = Source("test.inp", 1)
D, S, THICKNESS = 3.0, 0.4, 0.5
PLAIN = f"*DIFFUSIVITY\n{D}\n*SOLUBILITY\n{S}"
STEADY, TRANSIENT = "*MASS DIFFUSION, STEADY STATE\n1., 1.", "*MASS DIFFUSION\n0.1, 1., 0.1, 0.1"
CONTROLS = "*CONTROLS, PARAMETERS=FIELD, FIELD=CONCENTRATION\n1e-9"
LONG = pytest.mark.long
PATCHES = [name if name in ("DC2D4", "DCAX4", "DC3D8") else pytest.param(name, marks=LONG) for name in HEAT]
LINEAR = ["DC2D4", "DCAX4", pytest.param("DC3D8", marks=LONG)]


def deck(element_type, mesh, step, *, material=PLAIN, procedure=STEADY, before="", section=""):
    lines = [*body_lines(element_type, *mesh), f"*SOLID SECTION, ELSET=BODY, MATERIAL=M{section}", f"{THICKNESS}"]
    lines += ["*MATERIAL, NAME=M", material.strip(), before.strip() or "**"]
    lines += ["*STEP, INC=1000, AMPLITUDE=STEP", procedure, CONTROLS, step.strip() or "**"]
    lines += ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "NNC, RFL, CFL", "*OUTPUT, FIELD", "*END STEP", ""]
    return "\n".join(lines)


def given(keyword, values):
    return f"*{keyword}\n" + "".join(f"{k}, {float(v)!r}\n" for k, v in enumerate(values, start=1))


def outside(nodes):
    return np.flatnonzero(((abs(nodes) < 1e-9) | (abs(nodes - 1) < 1e-9)).any(axis=1))


@pytest.mark.parametrize("element_type", PATCHES)
def test_patch_of_a_linear_concentration(run_deck, element_type):
    """Any normalized concentration that varies linearly is steady, about an axis one that varies along it; the first
    moment of the solute that enters the nodes is s D x gradient x volume."""
    kind = HEAT[element_type]
    nodes, elements = patch_of(kind.family.cell)
    nodes = nodes[:, : kind.dimension]
    gradient = np.array([0.0 if kind.axisymmetric else 2.0, -1.0, 0.5])[: kind.dimension]
    phi = 5.0 + nodes @ gradient
    result = run_deck(deck(element_type, (nodes, elements), held(outside(nodes), phi[outside(nodes)])))
    np.testing.assert_allclose(column(result.history, "NNC11", len(nodes))[-1], phi, rtol=1e-10)
    volume = np.pi if kind.axisymmetric else THICKNESS if kind.dimension == 2 else 1.0
    entering = column(result.history, "RFL11", len(nodes))[-1]
    np.testing.assert_allclose(nodes.T @ entering, S * D * gradient * volume, rtol=1e-9, atol=1e-9)
    for k, slope in enumerate(gradient, start=1):
        np.testing.assert_allclose(result.field(f"MFL{k}"), -S * D * slope, rtol=1e-9, atol=1e-9)


ANISOTROPIC = "*DIFFUSIVITY, TYPE=ANISO\n3., 0.5, 2., 0.4, -0.3, 1."
TENSOR = np.array([[3.0, 0.5, 0.4], [0.5, 2.0, -0.3], [0.4, -0.3, 1.0]])


@pytest.mark.parametrize(
    "element_type", ["DC2D4", "DC3D8", *(pytest.param(n, marks=LONG) for n in ("DC2D6", "DC3D10"))]
)
@pytest.mark.parametrize("orthotropic", [False, True])
def test_diffusivity_with_directions(run_deck, element_type, orthotropic):
    """Of a material whose direction 1 is along (0.6, 0.8, 0): the flux is along these directions in the output."""
    kind = HEAT[element_type]
    nodes, elements = patch_of(kind.family.cell)
    nodes = nodes[:, : kind.dimension]
    gradient = np.array([2.0, -1.0, 0.5])[: kind.dimension]
    tensor = np.diag(np.diag(TENSOR)) if orthotropic else TENSOR
    material = "*DIFFUSIVITY, TYPE=ORTHO\n3., 2., 1." if orthotropic else ANISOTROPIC
    text = deck(
        *(element_type, (nodes, elements), held(outside(nodes), nodes[outside(nodes)] @ gradient)),
        material=f"{material}\n*SOLUBILITY\n{S}",
        section=", ORIENTATION=TURNED",
        before="*ORIENTATION, NAME=TURNED\n0.6, 0.8, 0., -0.8, 0.6, 0.",
    )
    result = run_deck(text)
    axes = np.array([[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])[: kind.dimension, : kind.dimension]
    flux = -S * tensor[: kind.dimension, : kind.dimension] @ axes @ gradient
    np.testing.assert_allclose(column(result.history, "NNC11", len(nodes))[-1], nodes @ gradient, atol=1e-10)
    for k, value in enumerate(flux, start=1):
        np.testing.assert_allclose(result.field(f"MFL{k}"), value, rtol=1e-9)
    volume = THICKNESS if kind.dimension == 2 else 1.0
    entering = column(result.history, "RFL11", len(nodes))[-1]
    np.testing.assert_allclose(nodes.T @ entering, -volume * axes.T @ flux, rtol=1e-9)


@pytest.mark.parametrize("element_type", LINEAR)
def test_a_wave_decays(run_deck, element_type):
    """sin(pi x) decays in increments h by 1/(1 + rate h); the rate is that of nodes at distances of d, with the solute
    stored at the nodes. The solubility cancels out."""
    count, h = 8, 0.01
    nodes, elements, along = bar(element_type, count)
    ends = np.flatnonzero((along == 0) | (along == 1))
    start = given("INITIAL CONDITIONS, TYPE=CONCENTRATION", np.sin(np.pi * along))
    procedure = f"*MASS DIFFUSION\n{h}, {10 * h}"
    result = run_deck(deck(element_type, (nodes, elements), held(ends, 0 * ends), procedure=procedure, before=start))
    rate = 2 * D * count**2 * (1 - np.cos(np.pi / count))
    expected = np.sin(np.pi * along) / (1 + rate * h) ** 10
    np.testing.assert_allclose(column(result.history, "NNC11", len(nodes))[-1], expected, rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize("element_type", ["DC2D4", pytest.param("DC2D8", marks=LONG)])
def test_the_front_behind_a_surface(run_deck, element_type):
    """erfc(x/(2 sqrt(D t))) behind a surface at 1, as long as the other end does not matter (Crank, The Mathematics of
    Diffusion, 2.14); half the error with half the increments, which are the larger part of it."""
    errors = []
    for increments in (10, 20):
        nodes, elements, _ = bar("DC2D4", 30)
        nodes = nodes.copy()
        if element_type == "DC2D8":
            nodes, elements = with_middles(nodes, elements)
        along = nodes[:, 0]
        surface = np.flatnonzero(along == 0)
        time = 0.01 / D
        procedure = f"*MASS DIFFUSION\n{time / increments!r}, {time!r}"
        result = run_deck(deck(element_type, (nodes, elements), held(surface, 1.0 + 0 * surface), procedure=procedure))
        expected = np.array([erfc(x / (2 * np.sqrt(D * time))) for x in along])
        errors.append(abs(column(result.history, "NNC11", len(nodes))[-1] - expected).max())
    assert errors[0] < 0.03
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.15)


def with_middles(nodes, elements):
    """The same with nodes in the middles of the edges."""
    sides = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    edges, inverse = np.unique(np.sort(elements[:, sides].reshape(-1, 2)), axis=0, return_inverse=True)
    middles = len(nodes) + inverse.reshape(len(elements), -1)
    return np.vstack([nodes, nodes[edges].mean(axis=1)]), np.hstack([elements, middles])


def test_two_layers(run_deck):
    """Steady permeation: the normalized concentration is continuous, the concentration jumps with the solubility; the
    flux is its difference over the sum of length/(s D)."""
    nodes, elements, along = bar("DC2D4", 5)
    ends = np.flatnonzero((along == 0) | (along == 1))
    text = deck("DC2D4", (nodes, elements), held(ends, along[ends]))
    other = "*ELSET, ELSET=FIRST\n1, 2\n*ELSET, ELSET=OTHER\n3, 4, 5\n*SOLID SECTION, ELSET=OTHER, MATERIAL=N\n0.5\n"
    text = text.replace("*SOLID SECTION, ELSET=BODY", other + "*SOLID SECTION, ELSET=FIRST")
    text = text.replace("*STEP", "*MATERIAL, NAME=N\n*DIFFUSIVITY\n0.5\n*SOLUBILITY\n2.\n*STEP", 1)
    result = run_deck(text)
    resistance = 0.4 / (S * D), 0.6 / (2.0 * 0.5)
    flux = 1 / sum(resistance)
    expected = np.interp(along, [0, 0.4, 1], [0, flux * resistance[0], 1])
    np.testing.assert_allclose(column(result.history, "NNC11", len(nodes))[-1], expected, rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(result.field("MFL1"), -flux, rtol=1e-9)
    solubility = np.array([S, S, 2.0, 2.0, 2.0])
    middles = np.array([expected[element].mean() for element in elements])
    np.testing.assert_allclose(result.field("CONC").reshape(5, -1).mean(axis=1), solubility * middles, rtol=1e-9)


SOLUBLE = "*SOLUBILITY\n0.4, 0.\n1.2, 10."


# the mean of 1 + x^2 over the last coordinate, linear between the nodes of linear elements
CONSERVED = {"DC2D4": 1.08, "DCAX4": 1.34375, "DC2D8": 1 + 0.16 / 3}


@pytest.mark.parametrize("element_type", ["DCAX4", *(pytest.param(name, marks=LONG) for name in ("DC2D4", "DC2D8"))])
def test_solute_is_conserved(run_deck, element_type):
    """With a diffusivity of the concentration, while the solubility changes with the temperature: what is inside is
    what was there and what has entered."""
    if element_type == "DC2D8":
        nodes, elements = with_middles(*bar("DC2D4", 4)[:2])
    else:
        nodes, elements, _ = bar(element_type, 4)
    start = given("INITIAL CONDITIONS, TYPE=CONCENTRATION", 1.0 + nodes[:, -1] ** 2)
    text = deck(
        *(element_type, (nodes, elements), "*TEMPERATURE, AMPLITUDE=WARM\nALL, 10.\n*CFLUX\n1, , 0.3"),
        material=f"*DIFFUSIVITY\n0.05, 0.\n0.2, 2.\n{SOLUBLE}",
        procedure="*MASS DIFFUSION, DCMAX=0.2\n0.01, 1., 1e-5, 0.2",
        before=f"*AMPLITUDE, NAME=WARM\n0., 0., 1., 1.\n{start}",
    )
    result = run_deck(text)
    kind = BUILT_IN[element_type]
    points = HEAT[element_type].points
    # field output has the means of the points
    inside, volume = (points * float(result.field(name).sum()) for name in ("ISOL", "IVOL"))
    assert volume == pytest.approx(0.16 * np.pi if kind.axisymmetric else 0.4 * THICKNESS)
    assert inside == pytest.approx(0.4 * CONSERVED[element_type] * volume + 0.3, rel=1e-7)
    changes = np.diff(column(result.history, "NNC11", len(nodes)), axis=0)
    assert len(changes) > 5
    assert abs(changes).max() <= 0.2 + 1e-12


def equilibrium(run_deck, count, material, phi, before, step, first=2.0):
    """Largest error of a bar that is closed but for one end, where it has the right normalized concentration."""
    nodes, elements, along = bar("DC2D4", count)
    ends = np.flatnonzero(along == 0)
    fields = {name: given(name, values(along)) for name, values in step.items()}
    text = deck(
        *("DC2D4", (nodes, elements), held(ends, phi(along[ends])) + "".join(fields.values())),
        material=material,
        before=before + given("INITIAL CONDITIONS, TYPE=CONCENTRATION", first + 0 * along),
    )
    result = run_deck(text)
    np.testing.assert_allclose(column(result.history, "RFL11", len(nodes))[-1], 0.0, atol=1e-9)
    return abs(column(result.history, "NNC11", len(nodes))[-1] - phi(along)).max()


ZERO = "*PHYSICAL CONSTANTS, ABSOLUTE ZERO=-3.\n"


def warm(x):
    return 2.0 + 4.0 * x


def pressed(x):
    return 0.5 - 1.5 * x


CLOSED = {
    # kappa_s 0.7: phi + 0.7 ln(theta - theta_Z) is constant; two points integrate the gradient to the fourth order
    "soret": (
        f"*DIFFUSIVITY\n{D}\n*KAPPA, TYPE=TEMP\n0.7\n*SOLUBILITY\n{S}",
        lambda x: 2 - 0.7 * np.log((warm(x) + 3) / 5),
        16.0,
    ),
    # kappa_s = 0.5 c: phi (theta - theta_Z)^(0.5 s) is
    "soret of concentration": (
        f"*DIFFUSIVITY\n{D}\n*KAPPA\n0., 0.\n5., 10.\n*SOLUBILITY\n{S}",
        lambda x: 2 * ((warm(x) + 3) / 5) ** (-0.5 * S),
        4.0,
    ),
    # kappa_p = 0.5 c, as of hydrogen in a metal: phi exp(0.5 s p) is
    "pressure of concentration": (
        f"*DIFFUSIVITY\n{D}\n*KAPPA, TYPE=PRESS\n0., 0.\n5., 10.\n*SOLUBILITY\n{S}",
        lambda x: 2 * np.exp(-0.5 * S * (pressed(x) - 0.5)),
        4.0,
    ),
}


@pytest.mark.parametrize("name", CLOSED)
def test_equilibrium_of_what_drives_the_diffusion(run_deck, name):
    """Nothing flows; the error falls by the factor of the order with half the element length."""
    material, phi, factor = CLOSED[name]
    driving = {"TEMPERATURE": warm, "PRESSURE STRESS": pressed}
    if "pressure" not in name:
        driving.pop("PRESSURE STRESS")
    errors = [equilibrium(run_deck, count, material, phi, ZERO, driving) for count in (4, 8)]
    assert errors[0] < 5e-3
    assert errors[0] / errors[1] == pytest.approx(factor, rel=0.06)


def test_equilibrium_of_fick(run_deck):
    """The concentration is constant, whatever the solubility: here at the nodes exactly, as s phi is quadratic."""
    material = f"*DIFFUSIVITY, LAW=FICK\n{D}\n{SOLUBLE}"
    error = equilibrium(
        run_deck, 3, material, lambda x: 2 * (0.4 + 0.08 * 2) / (0.4 + 0.08 * warm(x)), "", {"TEMPERATURE": warm}
    )
    assert error < 1e-12


def test_equilibrium_in_a_linear_pressure(run_deck):
    """A constant kappa_p: phi + kappa_p p is constant, at the nodes exactly; the pressure is the initial one."""
    material = f"*DIFFUSIVITY\n{D}\n*KAPPA, TYPE=PRESS\n0.7\n*SOLUBILITY\n{S}"
    along = bar("DC2D4", 3)[2]
    start = given("INITIAL CONDITIONS, TYPE=PRESSURE STRESS", pressed(along))
    assert equilibrium(run_deck, 3, material, lambda x: 2 - 0.7 * (pressed(x) - 0.5), start, {}) < 1e-12


def test_the_pressure_factor_of_fick(run_deck):
    """-D (grad c + s kappa_p grad p): c exp(s kappa p) with kappa_p = kappa c is constant, as by the general law."""
    errors = []
    for law in ("FICK", "GENERAL"):
        material = f"*DIFFUSIVITY, LAW={law}\n{D}\n*KAPPA, TYPE=PRESS\n0., 0.\n5., 10.\n*SOLUBILITY\n{S}"
        phi = CLOSED["pressure of concentration"][1]
        errors.append(equilibrium(run_deck, 4, material, phi, "", {"TEMPERATURE": warm, "PRESSURE STRESS": pressed}))
    assert errors[0] == pytest.approx(errors[1], rel=1e-6)


def test_diffusivity_that_grows_with_the_concentration(run_deck):
    """D (1 + b c): phi + b s phi^2/2 is linear along a bar (Kirchhoff), at the nodes exactly."""
    b, most = 0.8, 2.0
    nodes, elements, along = bar("DC2D4", 4)
    ends = np.flatnonzero((along == 0) | (along == 1))
    material = f"*DIFFUSIVITY\n{D}, 0.\n{D * (1 + b * S * most)}, {S * most}\n*SOLUBILITY\n{S}"
    result = run_deck(deck("DC2D4", (nodes, elements), held(ends, most * along[ends]), material=material))
    found = column(result.history, "NNC11", len(nodes))[-1]
    expected = (most + 0.5 * b * S * most**2) * along
    np.testing.assert_allclose(found + 0.5 * b * S * found**2, expected, rtol=1e-6, atol=1e-9)
    # the whole derivative is in the matrix
    assert sum(line.total_iterations for line in result.status) <= 6


def test_a_table_of_concentration_and_temperature(run_deck):
    """Linear between its values: with c = 1 and a temperature of 5, and constant beyond them: of 30."""
    rows = "1., 0., 0.\n3., 2., 0.\n2., 0., 10.\n6., 4., 10.\n"
    nodes, elements, along = bar("DC2D4", 1)
    step = held(np.arange(4), 1.0 / S + 1e-6 * (along - 0.5))
    for temperature, diffusivity in ((5.0, 0.5 * (2.0 + 3.0)), (30.0, 3.0)):
        text = deck(
            *("DC2D4", (nodes, elements), f"{step}*TEMPERATURE\nALL, {temperature}"),
            material=f"*DIFFUSIVITY\n{rows}*SOLUBILITY\n{S}",
        )
        np.testing.assert_allclose(run_deck(text).field("MFL1"), -S * diffusivity * 1e-6, rtol=1e-6)


@pytest.mark.parametrize("on_surface", [False, True])
def test_fluxes_of_dflux(run_deck, on_surface):
    """s D phi(1) = 2 (TEMP + 2 PRESS - 3 phi(1)); FLUX(2) is in the matrix."""
    nodes, elements, along = bar("DC2D4", 3)
    load = "*DSFLUX\nEND, SNU, 2." if on_surface else "*DFLUX\n3, S2NU, 2."
    step = f"{held(np.flatnonzero(along == 0), [0, 0])}*TEMPERATURE\nALL, 1.\n*PRESSURE STRESS\nALL, 0.25\n{load}"
    result = run_deck(deck("DC2D4", (nodes, elements), step, before="*SURFACE, NAME=END\n3, S2"), HERE / "solute.f")
    expected = 3.0 / (S * D + 6.0) * along
    np.testing.assert_allclose(column(result.history, "NNC11", len(nodes))[-1], expected, rtol=1e-9, atol=1e-12)
    assert [line.total_iterations for line in result.status] == [1]


def test_disp_is_told_the_dof_of_the_deck(run_deck):
    nodes, elements, _ = bar("DC2D4", 1)
    result = run_deck(deck("DC2D4", (nodes, elements), "*BOUNDARY, USER\nALL, 11"), HERE / "solute.f")
    np.testing.assert_allclose(column(result.history, "NNC11", 4)[-1], 11.0)


def test_equations_between_concentrations(run_deck):
    """Nodes 3 and 4, in the middle of a bar, are tied to its end, so that its second half has no gradient."""
    nodes, elements, _ = bar("DC2D4", 2)
    before = "*EQUATION\n2\n3, 11, 1., 5, 11, -1.\n2\n4, 11, 1., 6, 11, -1."
    result = run_deck(deck("DC2D4", (nodes, elements), held([0, 1, 4, 5], [0, 0, 2, 2]), before=before))
    expected = [0, 0, 2, 2, 2, 2]
    np.testing.assert_allclose(column(result.history, "NNC11", 6)[-1], expected, atol=1e-12)


def test_output(run_deck):
    """Fields, and what .dat and .msg say."""
    nodes, elements, along = bar("DC2D4", 1)
    text = deck(
        *(
            "DC2D4",
            (nodes, elements),
            f"{held(np.arange(4), along)}*NODE PRINT\nNNC11, RFL11\n*EL PRINT\nMFL, CONC, ISOL",
        ),
        procedure="*MASS DIFFUSION, DCMAX=5.\n0.5, 1., 0.1, 1.",
    )
    result = run_deck(text.replace("FIELD=CONCENTRATION\n1e-9", "FIELD=CONCENTRATION\n0.125"))
    np.testing.assert_allclose(result.field("NNC11").ravel(), along)
    printed, messages = result.file(".dat").read_text(), " ".join(result.file(".msg").read_text().split())
    assert "NNC11          RFL11" in printed
    assert "MFL1        MFL2        CONC        ISOL" in printed
    assert "NT11" not in printed
    for words in (
        "MAXIMUM CONCENTRATION CHANGE IN AN INCREMENT IS 5.00",
        "CRITERION FOR RESIDUAL CONC. FLUX FOR A NONLINEAR PROBLEM 0.125",
        "AVERAGE CONC. FLUX",
    ):
        assert words in messages


def test_a_step_may_end_at_the_steady_state(run_deck):
    """END=SS: where no normalized concentration changes faster than 0.01; the next step starts there."""
    nodes, elements, along = bar("DC2D4", 4)
    procedure = "*MASS DIFFUSION, END=SS\n0.05, 100., , , 0.01"
    text = deck("DC2D4", (nodes, elements), held(np.flatnonzero(along == 0), [1, 1]), procedure=procedure)
    result = run_deck(f"{text}*STEP, INC=1000\n{procedure}\n*END STEP\n")
    assert [line.step for line in result.status if line.step == 2] == [2]
    history = column(result.history, "NNC11", len(nodes))
    rates = abs(np.diff(history[np.array(result.history["step"]) == 1], axis=0)).max(axis=1) / 0.05
    assert rates[-1] < 0.01 < rates[-2]
    assert len(rates) > 5


TANGENTS = ["DC2D3", "DC2D4", "DC2D8", "DCAX3", "DCAX6", "DC3D4", "DC3D6", "DC3D20"]


@pytest.mark.parametrize("element_type", TANGENTS)
@pytest.mark.parametrize("fick", [False, True])
@pytest.mark.parametrize("steady", [False, True])
def test_tangent_is_the_derivative_of_the_residual(load, bound, call, element_type, fick, steady):
    """Of an element in gradients of temperature and pressure, all of whose constants depend on the concentration."""
    kind = HEAT[element_type]
    nodes, elements = patch_of(kind.family.cell)
    nodes = nodes[elements[0]] + 0.1
    points = np.array([[0.0, 0.0], [50.0, 0.0], [0.0, 9.0], [50.0, 9.0]])
    factors = np.column_stack([[0.1, 2.0, 0.3, 5.0], points])
    tensors = np.array([1.0, 9.0, 2.0, 20.0])[:, None, None] * TENSOR
    nothing = np.zeros((0, 3))
    law = Diffusivity(tensors, points, fick, True, SOURCE, nothing if fick else factors, factors)
    material = Material("M", SOURCE, diffusivity=law, solubility=np.array([[0.4, 0.0], [1.2, 9.0]]))
    section = SolidSection("ALL", material, None, THICKNESS, SOURCE)
    group = ElementGroup(element_type, np.array([101]), np.arange(kind.nodes)[None], "", section, None, SOURCE)
    procedure = MassDiffusion(steady=steady)
    block, matrix = bound(group, nodes, load(None), (Step(1, "S", procedure, SOURCE),))
    random, n = np.random.default_rng(5), matrix.shape[0]
    temperature, pressure = random.uniform(2.0, 7.0, kind.nodes), random.uniform(-1.0, 1.0, kind.nodes)
    fields = Predefined(np.stack([temperature, pressure]), 0.1 * np.stack([temperature, pressure]), temperature)
    call = replace(call, flags=Flags(procedure.lflag), predefined=fields)
    used = np.array([CONCENTRATION * node + dof - 1 for node, dof in block.unknowns])
    u = np.zeros(n)
    u[used] = random.uniform(1.0, 2.0, len(used))
    du = 0.3 * u
    block.evaluate(call, u, du, np.zeros(n), matrix.data)
    difference = differences(block, call, u, du, used)
    found = matrix.toarray()[np.ix_(used, used)]
    # the flux is of third order in the concentration: what is left is of the step
    np.testing.assert_allclose(found, difference, rtol=1e-6, atol=1e-6 * abs(found).max())
    assert abs(found - found.T).max() > 1e-3 * abs(found).max()


def one(**options):
    nodes, elements, along = bar("DC2D4", 1)
    step = options.pop("step", held(np.arange(4), along))
    return deck("DC2D4", (nodes, elements), step, **options)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            one(material="*DIFFUSIVITY\n1."),
            r"inp:\d+: material M has no \*SOLUBILITY, which elements of type DC2D4 need",
        ),
        (
            one(material="*SOLUBILITY\n1."),
            r"inp:\d+: material M has no \*DIFFUSIVITY, which elements of type DC2D4 need",
        ),
        (one(material="*DIFFUSIVITY\n-1."), r"inp:\d+: \*DIFFUSIVITY: the diffusivity must be positive"),
        (one(material="*DIFFUSIVITY, TYPE=ANISO\n1., 2., 1.,0.,0., 1."), r"\*DIFFUSIVITY: D must be positive definite"),
        (one(material="*DIFFUSIVITY"), r"\*DIFFUSIVITY: needs a data line with the diffusivity"),
        (one(material="*DIFFUSIVITY\n1.,2.,3.,4."), r"\*DIFFUSIVITY: 4 entries, expected at most 3"),
        (one(material="*DIFFUSIVITY\n1., 2.\n2., 2."), r"concentration and temperature are those of an earlier line"),
        (one(material="*DIFFUSIVITY, DEPENDENCIES=1\n1."), r"\*DIFFUSIVITY: option DEPENDENCIES is not supported"),
        (
            one(material=f"{PLAIN}\n*USER DEFINED FIELD"),
            r"\*USER DEFINED FIELD is not supported for elements of type DC2D4",
        ),
        (one(material="*SOLUBILITY\n0."), r"\*SOLUBILITY: solubility 0 must be positive"),
        (one(material="*KAPPA\n1."), r"inp:\d+: \*KAPPA: does not follow \*DIFFUSIVITY"),
        (
            one(material="*DIFFUSIVITY, LAW=FICK\n1.\n*KAPPA\n1."),
            r"\*KAPPA: TYPE=TEMP and \*DIFFUSIVITY, LAW=FICK \(.*inp:\d+\) exclude each other",
        ),
        (
            one(material="*DIFFUSIVITY\n1.\n*KAPPA, TYPE=PRESS\n1.\n*KAPPA, TYPE=PRESS\n1."),
            r"\*KAPPA: TYPE=PRESS is given already, at .*inp:\d+",
        ),
        (
            one(material=f"{ANISOTROPIC}\n*SOLUBILITY\n1."),
            r"inp:\d+: \*DIFFUSIVITY that is not isotropic needs ORIENTATION on \*SOLID SECTION \(.*inp:\d+\)",
        ),
        (
            one(section=", ORIENTATION=O", before="*ORIENTATION, NAME=O, SYSTEM=CYLINDRICAL\n0., 0., 0., 0., 0., 1."),
            r"inp:\d+: \*ORIENTATION with directions that differ from point to point is not supported",
        ),
        (
            one(section=", ORIENTATION=O", before="*ORIENTATION, NAME=O\n0., 0., 1., 0., 1., 0."),
            r"inp:\d+: \*ORIENTATION, NAME=O: direction 3 must be normal to the plane of the elements",
        ),
        (
            one() + "*STEP\n*HEAT TRANSFER, STEADY STATE\n1., 1.\n*END STEP\n",
            r"inp:\d+: \*HEAT TRANSFER is not supported in a job with \*MASS DIFFUSION, where dof 11 is",
        ),
        (
            one(material=f"{PLAIN}\n*ELASTIC\n1., 0.").replace("=DC2D4", "=CPE4"),
            r"inp:\d+: \*MASS DIFFUSION is not supported for elements of type CPE4",
        ),
        (one(step="*FILM\n1, F2, 1., 1."), r"inp:\d+: \*FILM exchanges heat, which \*MASS DIFFUSION has none of"),
        (
            one(procedure="*HEAT TRANSFER, STEADY STATE\n1., 1.", step="*PRESSURE STRESS\nALL, 1."),
            r"inp:\d+: \*PRESSURE STRESS is for \*MASS DIFFUSION",
        ),
        *(
            (
                one(
                    procedure="*HEAT TRANSFER, STEADY STATE\n1., 1.",
                    before=f"*INITIAL CONDITIONS, TYPE={kind}\nALL, 1.",
                ),
                rf"inp:\d+: \*INITIAL CONDITIONS, TYPE={kind} is for \*MASS DIFFUSION",
            )
            for kind in ("CONCENTRATION", "PRESSURE STRESS")
        ),
        (
            one(before="*INITIAL CONDITIONS, TYPE=CONCENTRATION, FILE=old"),
            r"inp:\d+: \*INITIAL CONDITIONS: FILE is for TYPE=TEMPERATURE and TYPE=FIELD",
        ),
        (one(step="*PRESSURE STRESS, FILE=old"), r"\*PRESSURE STRESS: option FILE is not supported"),
        (one(procedure="*MASS DIFFUSION, DCMAX=-1."), r"inp:\d+: \*MASS DIFFUSION: DCMAX=-1 must not be negative"),
        (
            one(procedure="*MASS DIFFUSION, END=SS\n1., 1."),
            r"\*MASS DIFFUSION: END=SS needs a positive rate of concentration change, entry 5 of the data line",
        ),
        (one(step="*DFLUX\n1, S2NU, 1."), r"inp:\d+: \*DFLUX: nonuniform loads need DFLUX; .* has UEL"),
    ],
)
def test_what_does_not_fit_is_refused(run_deck, text, message):
    with pytest.raises(DeckError, match=message):
        run_deck(text)


def test_user_elements(run_deck):
    text = one().replace("*STEP", "*USER ELEMENT, TYPE=U1, NODES=1\n11\n*ELEMENT, TYPE=U1, ELSET=U\n9, 1\n*STEP", 1)
    text = text.replace("*STEP", "*UEL PROPERTY, ELSET=U\n*STEP", 1)
    with pytest.raises(DeckError, match=r"inp:\d+: \*MASS DIFFUSION is not supported for user elements"):
        run_deck(text)


def test_temperatures_below_absolute_zero(run_deck):
    text = one(material=f"*DIFFUSIVITY\n1.\n*KAPPA\n1.\n*SOLUBILITY\n1.\n{ZERO}", step="*TEMPERATURE\nALL, -3.")
    message = r"the temperature -3.000E\+00 at integration point 1 is not above absolute zero, -3.000E\+00"
    with pytest.raises(KernelError, match=message):
        run_deck(text)
