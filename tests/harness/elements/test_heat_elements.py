# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Heat transfer elements, with heat by tables, UMATHT and HETVAL, there and in coupled elements, by theory."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bars import bar, column, held
from differences import differences
from reference_cells import patch_of
from small_decks import body_lines

import uel
from uel.elements import Flags
from uel.errors import ConvergenceError, DeckError, KernelError, Source
from uel.model.element_types import BUILT_IN, COUPLED, HEAT
from uel.model.mesh import ElementGroup
from uel.model.properties import Material, SolidSection, UserMaterial

HERE = Path(__file__).parent
SOURCE = Source("test.inp", 1)
K, DENSITY, CAPACITY, THICKNESS = 3.0, 2.0, 0.7, 0.5
CONDUCTIVITY, STORES = f"*CONDUCTIVITY\n{K}\n", f"*DENSITY\n{DENSITY}\n*SPECIFIC HEAT\n{CAPACITY}\n"
STEADY, TRANSIENT = "*HEAT TRANSFER, STEADY STATE\n1., 1.", "*HEAT TRANSFER\n0.1, 1., 0.1, 0.1"
CONTROLS = "*CONTROLS, PARAMETERS=FIELD, FIELD=GLOBAL\n1e-9"
PATCHES = [name if name[-1] in "48" else pytest.param(name, marks=pytest.mark.long) for name in HEAT]
FLOWS = "*USER MATERIAL, TYPE=THERMAL, UNSYMM, CONSTANTS=4\n"


def deck(element_type, mesh, material, step, *, procedure=STEADY, before=""):
    lines = [*body_lines(element_type, *mesh), "*SOLID SECTION, ELSET=BODY, MATERIAL=M", f"{THICKNESS}"]
    lines += ["*MATERIAL, NAME=M", material.strip()]
    if element_type in COUPLED:
        lines += ["*ELASTIC\n1000., 0.3"]
        step = f"*BOUNDARY\nALL, 1, {mesh[0].shape[1]}\n{step}"
    lines += [before.strip() or "**", "*STEP, INC=1000", procedure, CONTROLS, step.strip() or "**"]
    lines += ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "NT, RFL", "*OUTPUT, FIELD", "*END STEP", ""]
    return "\n".join(lines)


@pytest.mark.parametrize("element_type", PATCHES)
@pytest.mark.parametrize("user", [None, "flows.f"])
def test_patch_of_a_linear_temperature(run_deck, element_type, user):
    """Any temperature that varies linearly is steady, about an axis one that varies along it; the first moment of the
    heat at the nodes is conductivity x gradient x volume."""
    kind = HEAT[element_type]
    nodes, elements = patch_of(kind.family.cell)
    nodes = nodes[:, : kind.dimension]
    gradient = np.array([0.0 if kind.axisymmetric else 2.0, -1.0, 0.5])[: kind.dimension]
    outside = np.flatnonzero(((abs(nodes) < 1e-9) | (abs(nodes - 1) < 1e-9)).any(axis=1))
    material = f"{FLOWS}{K}, 0., {CAPACITY}, 0." if user else CONDUCTIVITY
    result = run_deck(
        deck(element_type, (nodes, elements), material, held(outside, 5.0 + nodes[outside] @ gradient)),
        user and HERE / user,
    )
    count = len(nodes)
    np.testing.assert_allclose(column(result.history, "NT11", count)[-1], 5.0 + nodes @ gradient, rtol=1e-10)
    volume = np.pi if kind.axisymmetric else THICKNESS if kind.dimension == 2 else 1.0
    heat = column(result.history, "RFL11", count)[-1]
    np.testing.assert_allclose(nodes.T @ heat, K * gradient * volume, rtol=1e-9, atol=1e-9)
    for k, slope in enumerate(gradient, start=1):
        np.testing.assert_allclose(result.field(f"HFL{k}"), -K * slope, rtol=1e-9, atol=1e-9)


TYPES = [
    *("DC2D4", "DCAX4", "C3D8T", "CAX4RT"),
    *(pytest.param(name, marks=pytest.mark.long) for name in ("DC3D8", "CPE4T", "CAX4T", "CPE4RT", "C3D8RT")),
]


def procedure_of(element_type, given):
    return given.replace("HEAT TRANSFER", "COUPLED TEMPERATURE-DISPLACEMENT") if element_type in COUPLED else given


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("user", [None, "flows.f"])
def test_conductivity_that_grows_with_the_temperature(run_deck, element_type, user):
    """k (1 + b T): T + b T^2/2 is linear along a bar (Kirchhoff), at the nodes of linear elements exactly."""
    b, hot = 0.8, 2.0
    nodes, elements, along = bar(element_type, 4)
    material = f"{FLOWS}{K}, {b}, 0., 0." if user else f"*CONDUCTIVITY\n{K}, 0.\n{K * (1 + b * hot)}, {hot}"
    ends = np.flatnonzero((along == 0) | (along == 1))
    text = deck(
        *(element_type, (nodes, elements), material, held(ends, hot * along[ends])),
        procedure=procedure_of(element_type, STEADY),
    )
    result = run_deck(text, user and HERE / user)
    found = column(result.history, "NT11", len(nodes))[-1]
    np.testing.assert_allclose(found + 0.5 * b * found**2, (hot + 0.5 * b * hot**2) * along, rtol=1e-6, atol=1e-9)
    if user:
        # the whole derivative is in the matrix
        assert sum(line.total_iterations for line in result.status) <= 6


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("user", [None, "flows.f"])
def test_a_wave_of_heat_decays(run_deck, element_type, user):
    """sin(pi x) decays in increments h by 1/(1 + rate h); the rate is that of nodes at distances of d, with the heat
    stored at the nodes."""
    count, h = 8, 0.1
    nodes, elements, along = bar(element_type, count)
    material = f"{FLOWS}{K}, 0., {CAPACITY}, 0.\n*DENSITY\n{DENSITY}" if user else CONDUCTIVITY + STORES
    ends = np.flatnonzero((along == 0) | (along == 1))
    start = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\n"
    start += "".join(f"{k + 1}, {float(np.sin(np.pi * x))!r}\n" for k, x in enumerate(along.tolist()))
    text = deck(
        *(element_type, (nodes, elements), material, held(ends, 0 * ends)),
        procedure=procedure_of(element_type, TRANSIENT),
        before=start,
    )
    found = column(run_deck(text, user and HERE / user).history, "NT11", len(nodes))[-1]
    cosine = np.cos(np.pi / count)
    rate = 2 * K / (DENSITY * CAPACITY) * count**2 * (1 - cosine)
    np.testing.assert_allclose(found, np.sin(np.pi * along) / (1 + rate * h) ** 10, rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize("element_type", ["DC2D4", "DC2D8", "CPE4T", "DC3D20"])
def test_specific_heat_is_that_of_the_end_of_the_increment(run_deck, element_type):
    """c = 1 + T/1000 and 100 per volume in one increment: (1 + T/1000) T = 100; the integral of c would give 95.4."""
    bars = element_type.endswith(("4", "4T"))
    mesh = bar(element_type, 1)[:2] if bars else patch_of(BUILT_IN[element_type].family.cell)
    material = "*CONDUCTIVITY\n1.\n*DENSITY\n1.\n*SPECIFIC HEAT\n1., 0.\n1.2, 200.\n"
    loads = "*DFLUX\nBODY, BF, 100."
    text = deck(element_type, mesh, material, loads, procedure=procedure_of(element_type, "*HEAT TRANSFER\n1., 1."))
    found = column(run_deck(text).history, "NT11", len(mesh[0]))[-1]
    np.testing.assert_allclose(found, 500 * (np.sqrt(1.4) - 1), rtol=1e-6)


@pytest.mark.parametrize("element_type", ["DC2D4", "DC2D8", "DCAX4", "CPE4T"])
def test_heat_that_melts(run_deck, element_type):
    """All of it warms alike: the heat of each increment is density x (specific heat at its end x change + change of the
    molten part x latent heat), as residuals of a public job of Abaqus have it (harness/uel/procedures/fidelity.md)."""
    mesh = patch_of("quad8") if element_type == "DC2D8" else bar(element_type, 1)[:2]
    material = f"{CONDUCTIVITY}*DENSITY\n{DENSITY}\n*SPECIFIC HEAT\n0.5, 1.\n1.5, 3.\n*LATENT HEAT\n4., 2., 2.5\n"
    material += "*HEAT GENERATION\n*DEPVAR\n8"
    text = deck(
        *(element_type, mesh, material, "*FIELD, VARIABLE=1, AMPLITUDE=FULL\nALL, 20.\n*FIELD, VARIABLE=2\nALL, 0."),
        procedure=procedure_of(element_type, "*HEAT TRANSFER, DELTMX=100.\n0.1, 1., 1e-4, 0.1"),
        before="*AMPLITUDE, NAME=FULL\n0., 1., 1., 1.",
    )
    history = run_deck(text, HERE / "generates.f").history
    found = column(history, "NT11", len(mesh[0]))
    # 0.5 below 1, 1.5 above 3, linear in between
    capacity = 0.5 * np.clip(found, 1.0, 3.0)
    energy = capacity * np.diff(found, axis=0, prepend=0.0)
    energy += 4.0 * np.diff(np.clip((found - 2.0) / 0.5, 0, 1), axis=0, prepend=0.0)
    sizes = np.diff(history["time"], prepend=0.0)[:, None]
    np.testing.assert_allclose(DENSITY * energy, 20.0 * sizes + 0 * found, rtol=1e-6)
    assert found.max() > 3.0


@pytest.mark.parametrize("element_type", TYPES)
def test_a_source_that_falls_with_temperature_makes_a_hyperbolic_cosine(run_deck, element_type):
    """a - b T by HETVAL, one end at 0, insulated at the other: a/b (1 - cosh(m (1 - s))/cosh(m)), m^2 = b/k; four times
    as exact with half the element length."""
    errors = []
    a, b = 6.0, 12.0
    for count in (8, 16):
        nodes, elements, along = bar(element_type, count)
        ends = np.flatnonzero(along == 0)
        fields = f"*FIELD, VARIABLE=1\nALL, {a}\n*FIELD, VARIABLE=2\nALL, {b}\n"
        text = deck(
            *(
                element_type,
                (nodes, elements),
                f"{CONDUCTIVITY}*HEAT GENERATION\n*DEPVAR\n8",
                fields + held(ends, 0 * ends),
            ),
            procedure=procedure_of(element_type, STEADY),
        )
        result = run_deck(text, HERE / "generates.f")
        # linear, and FLUX(2) is in the matrix
        assert [line.total_iterations for line in result.status] == [1]
        m = np.sqrt(b / K)
        expected = a / b * (1 - np.cosh(m * (1 - along)) / np.cosh(m))
        errors.append(abs(column(result.history, "NT11", len(nodes))[-1] - expected).max())
    assert errors[0] < 5e-3
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)


PROCEDURES = [
    ("DC2D4", "*HEAT TRANSFER, STEADY STATE"),
    ("DC2D4", "*HEAT TRANSFER"),
    ("CPE4T", "*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE"),
    ("CPE4T", "*COUPLED TEMPERATURE-DISPLACEMENT"),
    ("DC2D4", "*COUPLED TEMPERATURE-DISPLACEMENT"),
]
REDUCED = ("CPE4RT", "*COUPLED TEMPERATURE-DISPLACEMENT")
FIELDS = "*AMPLITUDE, NAME=RISES\n0., 1., 1., 5."


def given_to(run_deck, element_type, procedure, material, user):
    """A run of four increments of a square whose temperature is 2 + 3 x + t (1 + 5 x), its field 3 + 12 t."""
    nodes, elements, along = bar(element_type, 1)
    start = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\n"
    start += "".join(f"{k + 1}, {2 + 3 * x}\n" for k, x in enumerate(along))
    start += "*INITIAL CONDITIONS, TYPE=FIELD, VARIABLE=1\nALL, 3.\n"
    # which generates.f reads
    start += "*INITIAL CONDITIONS, TYPE=FIELD, VARIABLE=2\nALL, 0.\n"
    field = "*FIELD, VARIABLE=1, AMPLITUDE=RISES\nALL, 3.\n"
    # from the initial temperature to the one at the end
    ramp = "*AMPLITUDE, NAME=LEFT\n0., 2., 1., 3.\n*AMPLITUDE, NAME=RIGHT\n0., 5., 1., 11.\n"
    warm = "".join(
        f"*BOUNDARY, AMPLITUDE={'RIGHT' if x else 'LEFT'}\n{k + 1}, 11, 11, 1.\n" for k, x in enumerate(along)
    )
    text = deck(
        *(element_type, (nodes, elements), material, field + warm),
        procedure=f"{procedure}\n0.25, 1., 0.25, 0.25",
        before=ramp + FIELDS + "\n" + start,
    )
    return run_deck(text, HERE / user)


@pytest.mark.parametrize(("element_type", "procedure"), PROCEDURES)
def test_what_umatht_is_given(run_deck, element_type, procedure):
    """In the last of four increments; means over the points of what is linear."""
    material = f"*DENSITY\n1.\n*DEPVAR\n20\n{FLOWS}{K}, 0., {CAPACITY}, 0."
    result = given_to(run_deck, element_type, procedure, material, "flows.f")
    expected = {
        **{"SDV1": 2 + 1.5 + 0.75 * 3.5, "SDV2": 0.25 * 3.5},  # TEMP of the start, DTEMP
        **{"SDV3": 8.0, "SDV4": 0.0},  # DTEMDX of the end
        **{"SDV5": 1.0, "SDV6": 1.0, "SDV7": 0.25},  # TIME of the end, DTIME
        **{"SDV8": 12.0, "SDV9": 3.0},  # PREDEF of the start, DPRED
        **{"SDV10": 2, "SDV11": 20, "SDV12": 4},  # NTGRD, NSTATV, NPROPS
        **{"SDV13": 0.5, "SDV14": 0.2},  # COORDS
        **{"SDV15": 102.5, "SDV16": 11, "SDV17": 14},  # NOEL and NPT, LAYER and KSPT, KSTEP and KINC
        **{"SDV18": CAPACITY * 0.75 * 3.5, "SDV19": -K * 6.75},  # U and FLUX of the start
        "SDV20": 4,  # increments, not iterations
    }
    for name, value in expected.items():
        np.testing.assert_allclose(result.field(name), value, rtol=1e-9, atol=1e-9, err_msg=name)


def test_umatht_has_the_state_of_the_only_stress_point(run_deck):
    """Where heat has four points and stress one, each call has its own temperature, and what the call before left in
    STATEV: those that stay are of point 4."""
    material = f"*DENSITY\n1.\n*DEPVAR\n20\n{FLOWS}{K}, 0., {CAPACITY}, 0."
    result = given_to(run_deck, *REDUCED, material, "flows.f")
    x, y = 0.5 + np.sqrt(1 / 12), 0.4 * (0.5 + np.sqrt(1 / 12))
    expected = {
        **{"SDV1": 2 + 3 * x + 0.75 * (1 + 5 * x), "SDV2": 0.25 * (1 + 5 * x)},  # TEMP of the start, DTEMP
        **{"SDV3": 8.0, "SDV4": 0.0, "SDV13": x, "SDV14": y},  # DTEMDX, COORDS
        "SDV15": 104,  # NOEL and NPT
        **{"SDV18": CAPACITY * 0.75 * (1 + 5 * x), "SDV19": -K * 6.75},  # U and FLUX of the start
        "SDV20": 4 * 4,  # increments and points
    }
    for name, value in expected.items():
        np.testing.assert_allclose(result.field(name), value, rtol=1e-9, atol=1e-9, err_msg=name)


def test_umatht_with_reduced_integration_warns_once(run_deck):
    """Abaqus 2023 says so in a .dat file: SpringNuance/Hydrogen-Embrittlement-Subroutine-Aachen, "3. Professor
    Aravas's code"."""
    text = one("CPE4RT", f"{FLOWS}1., 0., 0., 0.", procedure=procedure_of("CPE4T", STEADY))
    messages = " ".join(run_deck(text, HERE / "flows.f").file(".msg").read_text().split())
    warning = "elements of type CPE4RT have more points for heat than for stresses; UMATHT should not be used there"
    assert messages.count(warning) == 1


def test_increments_of_a_public_message_file(run_deck):
    """Abaqus 2023, CAX4RT with UMAT and UMATHT (SpringNuance/Hydrogen-Embrittlement-Subroutine-Aachen, "3. Professor
    Aravas's code"): hydrogen in traps and in the lattice of a cylinder, whose surface has 1e-5, 2e-5, ... from 1e-3
    before. Printed are the largest other changes, those of the next node, then of the one behind it. The job's change
    of shape is left out; it ends increments with residuals of 5e-3."""
    radii = [*(5e-5 * np.arange(60)), 3.003e-3]
    nodes = np.array([(r, z) for z in (0.0, 7.5e-5) for r in radii])
    elements = np.array([[0, 1, 62, 61]]) + np.arange(60)[:, None]
    unit = 2.08372e21
    traps = f"407., {10**20.93 / unit!r}, {2.8e10 * unit / 8.46e28!r}, 11.8449e5"
    lines = [
        *body_lines("CAX4RT", nodes, elements),
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M",
        "*HOURGLASS STIFFNESS\n1.",
    ]
    lines += ["*MATERIAL, NAME=M\n*DENSITY\n1.\n*DEPVAR\n1", f"*USER MATERIAL, CONSTANTS=4, UNSYMM\n{traps}"]
    lines += ["*USER MATERIAL, TYPE=THERMAL, CONSTANTS=1\n5e-4", "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 1e-3"]
    lines += ["*AMPLITUDE, NAME=RISES, TIME=TOTAL TIME\n0., 0., 1e-3, 1.", "*NSET, NSET=SURFACE\n61, 122"]
    controls = "*CONTROLS, PARAMETERS=FIELD, FIELD=TEMPERATURE\n1e-9, , 1e-9"
    sizes = [1e-8, 1e-8, 1e-8, 2e-8, 4e-8]
    for size in sizes:
        lines += ["*STEP", f"*COUPLED TEMPERATURE-DISPLACEMENT\n{size}, {size}", "*BOUNDARY\nALL, 1, 2"]
        lines += ["*BOUNDARY, AMPLITUDE=RISES\nSURFACE, 11, 11, 1.", controls]
        lines += ["*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nNT", "*END STEP"]
    found = column(run_deck([*lines, ""], HERE / "traps.f").history, "NT11", 122)
    found = np.vstack([np.full(122, 1e-3), found[-len(sizes) :]])
    changes = np.diff(found[:, :60], axis=0)
    places = abs(changes).argmax(axis=1)
    assert places.tolist() == [59, 59, 59, 58, 58]
    printed = [2.685e-4, 1.500e-4, 8.871e-5, -9.519e-5, -9.179e-5]
    np.testing.assert_allclose(changes[np.arange(len(sizes)), places], printed, rtol=1e-3)


@pytest.mark.parametrize(("element_type", "procedure"), PROCEDURES)
def test_what_hetval_is_given(run_deck, element_type, procedure):
    material = f"{CONDUCTIVITY}{STORES}*DEPVAR\n8\n*HEAT GENERATION"
    result = given_to(run_deck, element_type, procedure, material, "generates.f")
    expected = {
        **{"SDV1": 3.5 + 3.5, "SDV2": 0.25 * 3.5},  # TEMP of the end, its increment
        **{"SDV3": 1.0, "SDV4": 1.0, "SDV5": 0.25},  # TIME of the end, DTIME
        **{"SDV6": 15.0, "SDV7": 3.0},  # PREDEF of the end, DPRED
        "SDV8": 4,
    }
    for name, value in expected.items():
        np.testing.assert_allclose(result.field(name), value, rtol=1e-9, atol=1e-9, err_msg=name)


TANGENTS = ["DC2D3", "DC2D4", "DC2D8", "DCAX3", "DCAX6", "DC3D4", "DC3D6", "DC3D8", "DC3D20"]


COUPLED_TANGENTS = ["CPE8T", "CAX4T", "CPS4RT", "CAX3T", "C3D6T"]


@pytest.mark.parametrize("element_type", TANGENTS)
def test_matrix_of_heat_transfer_leaves_out_changes_of_the_material(load, bound, call, element_type):
    """It is symmetric; K(T) times T is the heat that is conducted, C(T) times the change the heat that is stored.

    Four iterations of a public job of Abaqus show it (harness/uel/procedures/fidelity.md).
    """
    kind = BUILT_IN[element_type]
    nodes, elements = patch_of(kind.family.cell)
    nodes = nodes[elements[0]] + 0.1
    tables = {"conductivity": np.array([[3.0, -9.0], [5.0, 9.0]]), "specific_heat": np.array([[0.7, -9.0], [2.0, 9.0]])}
    section = SolidSection("ALL", Material("M", SOURCE, density=2.0, **tables), None, THICKNESS, SOURCE)
    group = ElementGroup(element_type, np.array([101]), np.arange(kind.nodes)[None], "", section, None, SOURCE)
    matrices, forces = [], []
    used = 11 * np.arange(len(nodes)) + 10
    for lflag in (31, 33):
        block, matrix = bound(group, nodes, load(None))
        u = np.zeros(matrix.shape[0])
        u[used] = np.random.default_rng(5).uniform(1.0, 2.0, len(used))
        residual = np.zeros_like(u)
        block.evaluate(replace(call, flags=Flags(lflag), unsymmetric=True), u, 0.3 * u, residual, matrix.data)
        matrices.append(matrix.toarray()[np.ix_(used, used)])
        forces.append(-residual[used])
    conducted, stored = matrices[0], matrices[1] - matrices[0]
    np.testing.assert_allclose(conducted, conducted.T, rtol=1e-12, atol=1e-12 * abs(conducted).max())
    np.testing.assert_allclose(conducted @ u[used], forces[0], rtol=1e-9, atol=1e-12 * abs(forces[0]).max())
    np.testing.assert_allclose(stored @ (0.3 * u[used]), forces[1] - forces[0], rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(
    ("lflag", "user", "element_type"),
    [
        *((lflag, "flows.f", name) for lflag in (33, 31) for name in [*TANGENTS, *COUPLED_TANGENTS]),
        *((33, None, name) for name in COUPLED_TANGENTS),
    ],
)
def test_tangent_is_the_derivative_of_the_residual(load, bound, call, element_type, lflag, user):
    """Of an element that is warm: central differences of what is quadratic are exact."""
    kind = BUILT_IN[element_type]
    nodes, elements = patch_of(kind.family.cell)
    nodes = nodes[elements[0]] + 0.1
    tables = {"conductivity": np.array([[3.0, -9.0], [5.0, 9.0]]), "specific_heat": np.array([[0.7, -9.0], [2.0, 9.0]])}
    given = UserMaterial(np.array([3.0, 0.2, 0.7, 0.4]), True, SOURCE)
    material = Material("M", SOURCE, density=2.0, **tables, user_thermal=given if user else None)
    if element_type in COUPLED:
        elastic = uel.model.properties.Elastic(uel.model.properties.ElasticType.ISOTROPIC, (1000.0, 0.3), SOURCE)
        material = replace(material, elastic=elastic)
    section = SolidSection("ALL", material, None, THICKNESS, SOURCE)
    group = ElementGroup(element_type, np.array([101]), np.arange(kind.nodes)[None], "", section, None, SOURCE)
    block, matrix = bound(group, nodes, load(user))
    code = lflag + 40 if element_type in COUPLED else lflag
    call = replace(call, flags=Flags(code), unsymmetric=True)
    used = np.array([11 * node + dof - 1 for node, dof in block.unknowns if dof == 11])
    random, n = np.random.default_rng(5), matrix.shape[0]
    u = np.zeros(n)
    u[used] = random.uniform(1.0, 2.0, len(used))
    du = 0.3 * u
    block.evaluate(call, u, du, np.zeros(n), matrix.data)
    difference = differences(block, call, u, du, used)
    found = matrix.toarray()[np.ix_(used, used)]
    np.testing.assert_allclose(found, difference, rtol=1e-7, atol=1e-8 * abs(found).max())
    assert abs(found - found.T).max() > 1e-3 * abs(found).max()


def one(element_type="DC2D4", material=CONDUCTIVITY, **options):
    nodes, elements, along = bar(element_type, 1)
    return deck(element_type, (nodes, elements), material, held(np.arange(len(nodes)), along), **options)


@pytest.mark.parametrize(
    ("text", "user", "message"),
    [
        (
            one(material=f"{FLOWS}1., 0., 0., 0."),
            None,
            r"deck.inp:\d+: \*USER MATERIAL, TYPE=THERMAL: material M needs UMATHT; .* has UEL",
        ),
        (
            one(material=f"{CONDUCTIVITY}*HEAT GENERATION"),
            "flows.f",
            r"deck.inp:\d+: \*HEAT GENERATION: material M needs HETVAL; .* has UMATHT",
        ),
        (
            one(material=f"{FLOWS}1., 0., 0., 0.\n*HEAT GENERATION"),
            "flows.f",
            r"\*HEAT GENERATION beside \*USER MATERIAL, TYPE=THERMAL is not supported",
        ),
        (one(material="*DENSITY\n1."), None, r"material M has no \*CONDUCTIVITY or .*, which .* DC2D4 need"),
        (one(procedure=TRANSIENT), None, r"material M has no \*DENSITY, which elements of type DC2D4 need"),
        (
            one(procedure="*STATIC\n1., 1."),
            None,
            r"DC2D4.*supported: \*HEAT TRANSFER, \*COUPLED TEMPERATURE-DISPLACEMENT, \*MASS DIFFUSION",
        ),
    ],
)
def test_what_is_missing_is_named(run_deck, text, user, message):
    with pytest.raises(DeckError, match=message):
        run_deck(text, user and HERE / user)


def test_nodes_across_the_axis(run_deck):
    text = one("DCAX4").replace("\n1, 0.4, 0.0\n", "\n1, -0.4, 0.0\n")
    with pytest.raises(DeckError, match=r"element 1 \(type DCAX4\): node 1 is at the radius -0.4"):
        run_deck(text)


@pytest.mark.parametrize(
    ("material", "user", "message"),
    [
        (f"{FLOWS}1., 0., 0., -1.", "flows.f", r"element 1 \(type DC2D4\): UMATHT at integration point 1 stopped"),
        (
            f"{CONDUCTIVITY}*HEAT GENERATION",
            "generates.f",
            r"element 1 \(type DC2D4\): HETVAL at integration point 1 stopped the analysis \(XIT\)",
        ),
    ],
)
def test_xit(run_deck, material, user, message):
    text = one(material=material)
    if user == "generates.f":
        text = text.replace("=M\n", "=STOPS\n")
    with pytest.raises(KernelError, match=message):
        run_deck(text, HERE / user)


def test_a_write_outside_flux_is_reported(run_deck):
    text = one(material=f"{CONDUCTIVITY}*HEAT GENERATION").replace("=M\n", "=BEYOND\n")
    messages = " ".join(run_deck(text, HERE / "generates.f").file(".msg").read_text().split())
    assert "element 1: HETVAL writes outside FLUX: entry 3 of 2 (2) at integration point 1" in messages


def test_umatht_cuts_the_increment_back(run_deck):
    """PNEWDT = 0.5 in every call, until the increment would be smaller than the step allows."""
    text = one(material=f"{FLOWS}1., 0., 0., 2000.", procedure="*HEAT TRANSFER, STEADY STATE\n1., 1., 0.25, 1.")
    with pytest.raises(ConvergenceError, match="TIME INCREMENT REQUIRED IS LESS THAN THE MINIMUM"):
        run_deck(text, HERE / "flows.f")
