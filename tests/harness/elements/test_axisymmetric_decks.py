# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks of axisymmetric elements: cylinders against theory, loads and their totals, UMAT, and what is refused."""

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad
from small_decks import body_lines

from uel.errors import ConvergenceError, DeckError
from uel.model.element_types import CONTINUUM, COUPLED

TYPES = [name for name in CONTINUUM if name.startswith("CAX")]
INNER, OUTER, PRESSURE, YOUNG, DENSITY = 1.0, 2.0, 10.0, 1000.0, 3.0

UMAT = Path(__file__).with_name("components.f")

DLOAD = """      SUBROUTINE DLOAD(F,KSTEP,KINC,TIME,NOEL,NPT,LAYER,KSPT,
     1     COORDS,JLTYP,SNAME)
      INCLUDE 'ABA_PARAM.INC'
      CHARACTER*80 SNAME
      DIMENSION TIME(2),COORDS(3)
      F = JLTYP + 3*COORDS(2)
      END
"""


def strip(element_type, count, height, inner=INNER, outer=OUTER):
    """Nodes and elements between two radii, `count` quadrilaterals or twice as many triangles along the radius."""
    nodes_each = (CONTINUUM | COUPLED)[element_type].nodes
    fine = 2 if nodes_each > 4 else 1
    rows = fine + 1
    radii, heights = np.linspace(inner, outer, fine * count + 1), np.linspace(0, height, rows)
    nodes = np.array([[r, z] for r in radii for z in heights])
    first = fine * rows * np.arange(count)[:, None]
    corners = [0, fine * rows, fine * rows + fine, fine]
    middles = [rows, 2 * rows + 1, rows + 2, 1]
    patterns = {
        3: [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]],
        4: [corners],
        6: [[*corners[:3], middles[0], middles[1], rows + 1], [*corners[:1], *corners[2:], rows + 1, *middles[2:]]],
        8: [corners + middles],
    }
    used, elements = np.unique(np.concatenate([first + p for p in patterns[nodes_each]]), return_inverse=True)
    return nodes[used], elements.reshape(-1, nodes_each)


def deck(element_type, mesh, step, *, material=f"*ELASTIC\n{YOUNG}, 0.3", options="", procedure="*STATIC\n1., 1."):
    nodes, elements = mesh
    lines = body_lines(element_type, nodes, elements)
    # a thickness that must not count
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "7.", "*MATERIAL, NAME=M", material, "*DENSITY", f"{DENSITY}"]
    for name, chosen in (("BOTTOM", nodes[:, 1] == 0), ("TOP", nodes[:, 1] == nodes[:, 1].max())):
        lines += [f"*NSET, NSET={name}", *(str(k + 1) for k in np.flatnonzero(chosen))]
    lines += [f"*STEP{options}", procedure, step, "*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "U, RF, NT, RFL"]
    return "\n".join([*lines, "*OUTPUT, FIELD", "*ELEMENT OUTPUT", "S, E, SDV", "*END STEP", ""])


def column(result, name, count):
    """(nodes,) of a nodal variable at the end."""
    return np.array([result.history[f"{name}[ALL:{k}]"][-1] for k in range(1, count + 1)])


def inner_face(element_type, elements):
    """Element and *DLOAD type of the face on the inner radius."""
    return (len(elements) // 2 + 1, "P3") if elements.shape[1] in (3, 6) else (1, "P4")


LAME = [("CAX3", 1.5), ("CAX4", 1.9), ("CAX4R", 1.9), ("CAX6", 2.5), ("CAX8", 3.8), ("CAX8R", 3.8)]


@pytest.mark.parametrize(("element_type", "order"), LAME)
def test_thick_walled_cylinder_under_pressure(run_deck, element_type, order):
    """G. Lame: u = (1 + nu) p a^2/(E (b^2 - a^2)) ((1 - 2 nu) r + b^2/r), held along the axis; order of the error."""
    nu, a, b = 0.3, INNER, OUTER
    scale = (1 + nu) * PRESSURE * a**2 / (YOUNG * (b**2 - a**2))
    errors = []
    for count in (4, 8):
        nodes, elements = mesh = strip(element_type, count, 1.0 / count)
        element, face = inner_face(element_type, elements)
        result = run_deck(deck(element_type, mesh, f"*BOUNDARY\nALL, 2\n*DLOAD\n{element}, {face}, {PRESSURE}"))
        exact = scale * ((1 - 2 * nu) * nodes[:, 0] + b**2 / nodes[:, 0])
        errors.append(abs(column(result, "U1", len(nodes)) / exact - 1).max())
    # those of one or 2 x 2 points are exact at the nodes of this mesh
    assert errors[1] < 1e-12 or np.log2(errors[0] / errors[1]) > order
    assert errors[1] < 0.02
    # the whole stress in the middle of the outermost element, within its change over an element
    r = 0.5 * (nodes[elements[-1, 0], 0] + b)
    hoop = PRESSURE * a**2 / (b**2 - a**2) * (1 + b**2 / r**2)
    assert np.ravel(result.field("S33"))[-1] == pytest.approx(hoop, rel=0.06)
    assert np.ravel(result.field("S22"))[-1] == pytest.approx(2 * nu * PRESSURE * a**2 / (b**2 - a**2), rel=0.06)


def test_incompressible_cylinder_does_not_lock(run_deck):
    """The same with nu = 0.4999 in CAX4."""
    nodes, _ = mesh = strip("CAX4", 8, 0.125)
    text = deck("CAX4", mesh, f"*BOUNDARY\nALL, 2\n*DLOAD\n1, P4, {PRESSURE}", material=f"*ELASTIC\n{YOUNG}, 0.4999")
    exact = 1.4999 * PRESSURE / (YOUNG * 3) * (2e-4 * nodes[:, 0] + 4 / nodes[:, 0])
    np.testing.assert_allclose(column(run_deck(text), "U1", len(nodes)), exact, rtol=2e-3)


@pytest.mark.parametrize(("element_type", "counts", "error"), [("CAX4", (4, 8), 1.5e-3), ("CAX8R", (4,), 1e-4)])
def test_tube_that_is_blown_up(run_deck, element_type, counts, error):
    """R.S. Rivlin, Phil. Trans. A 242 (1949) 173: r^2 = R^2 + c in an incompressible tube, so that p is the integral of
    mu ((r/R)^2 - (R/r)^2)/r dr, and r that of the start plus 0.3 on the inside; bulk modulus 1e4 mu."""
    growth = 1.3**2 - INNER**2

    def slope(start):
        square = start**2 + growth
        return (square / start**2 - start**2 / square) * start / square

    pressure, _ = quad(slope, INNER, OUTER)
    material = "*USER MATERIAL, CONSTANTS=2\n1., 1e4\n*DEPVAR\n9"
    errors = []
    for count in counts:
        step = f"*CONTROLS, PARAMETERS=FIELD\n1e-6, 1.\n*BOUNDARY\nALL, 2\n*DLOAD\n1, P4, {pressure!r}"
        mesh = strip(element_type, count, 1.0 / count)
        text = deck(
            element_type, mesh, step, material=material, options=", NLGEOM", procedure="*STATIC, DIRECT\n0.1, 1."
        )
        errors.append(abs(column(run_deck(text, UMAT.with_name("neohooke.f")), "U1", 1)[0] / 0.3 - 1))
    assert errors[-1] < error
    assert len(errors) == 1 or errors[0] / errors[1] > 3.5


@pytest.mark.sample(3)
@pytest.mark.parametrize("element_type", TYPES)
def test_pressure_and_body_forces_have_their_totals(run_deck, element_type):
    """Over the circumference: pressure x area on the inner cylinder and the upper end, body force x volume; the moment
    of the latter about the axis is that of a force at each radius."""
    nodes, elements = mesh = strip(element_type, 1, 0.5)
    element, face = inner_face(element_type, elements)
    upper = {3: "P2", 6: "P2"}.get(elements.shape[1], "P3")
    held = "*BOUNDARY\nALL, 1, 2\n"
    volume = np.pi * (OUTER**2 - INNER**2) * 0.5
    first = (OUTER**3 - INNER**3) / 3 / ((OUTER**2 - INNER**2) / 2)
    for load, total in (
        (f"*DLOAD\n{element}, {face}, 4.", (4 * 2 * np.pi * INNER * 0.5, 0)),
        (f"*DLOAD\n{element}, {upper}, 4.", (0, -4 * np.pi * (OUTER**2 - INNER**2))),
        ("*DLOAD\nBODY, BZ, 4.", (0, 4 * volume)),
        ("*DLOAD\nBODY, BR, 4.", (4 * volume, 0)),
        ("*DLOAD\nBODY, GRAV, 9.8, 0., -1.", (0, -9.8 * DENSITY * volume)),
    ):
        result = run_deck(deck(element_type, mesh, held + load))
        found = -np.array([column(result, name, len(nodes)) for name in ("RF1", "RF2")])
        np.testing.assert_allclose(found.sum(axis=1), total, rtol=1e-12, atol=1e-12, err_msg=load)
        # three points of a quadratic triangle do not take forces over the radius exactly
        if "BODY" in load and element_type != "CAX6":
            np.testing.assert_allclose(found @ nodes[:, 0], np.array(total) * first, rtol=1e-12, atol=1e-12)


def test_pressure_of_a_surface(run_deck):
    mesh = strip("CAX8R", 1, 0.5)
    text = deck("CAX8R", mesh, f"*BOUNDARY\nALL, 1, 2\n*DSLOAD\nBORE, P, {PRESSURE}")
    text = text.replace("*STEP", "*SURFACE, NAME=BORE\nBODY, S4\n*STEP")
    assert -column(run_deck(text), "RF1", 8).sum() == pytest.approx(PRESSURE * 2 * np.pi * INNER * 0.5)


def test_body_force_of_dload_along_the_axis(run_deck, tmp_path):
    """JLTYP is 2; F = 2 + 3 z over the height 0.5."""
    (tmp_path / "dload.f").write_text(DLOAD)
    text = deck("CAX4", strip("CAX4", 1, 0.5), "*BOUNDARY\nALL, 1, 2\n*DLOAD\nBODY, BZNU")
    total = np.pi * (OUTER**2 - INNER**2) * (2 * 0.5 + 3 * 0.5**2 / 2)
    assert -column(run_deck(text, tmp_path / "dload.f"), "RF2", 4).sum() == pytest.approx(total)


def test_umat_gets_components_in_their_order(run_deck):
    """u = (a r + c, b z + d r) on one point: strains 11, 22, 33 (around the axis), 12; CELENT from the area alone."""
    nodes, _ = mesh = strip("CAX4R", 1, 0.5)
    a, b, c, d = 0.01, -0.004, 0.003, 0.002
    u = np.column_stack([a * nodes[:, 0] + c, b * nodes[:, 1] + d * nodes[:, 0]])
    held = "".join(f"{k}, {dof}, {dof}, {float(u[k - 1, dof - 1])!r}\n" for k in range(1, 5) for dof in (1, 2))
    material = "*USER MATERIAL, CONSTANTS=0\n*DEPVAR\n6"
    text = deck("CAX4R", mesh, "*BOUNDARY\n" + held, material=material)
    result = run_deck(text.replace("*MATERIAL, NAME=M", "*HOURGLASS STIFFNESS\n1.\n*MATERIAL, NAME=M"), UMAT)
    # the mean of c/r over the volume is c (b - a)/((b^2 - a^2)/2)
    strain = np.array([a, b, a + c / 1.5, d])
    found = [float(np.ravel(result.field(f"SDV{k}"))[0]) for k in range(1, 7)]
    np.testing.assert_allclose(found, [*strain, 431, np.sqrt(0.5)], rtol=1e-12)
    for k, name in enumerate(("11", "22", "33", "12")):
        assert np.ravel(result.field(f"S{name}"))[0] == pytest.approx(10 ** (k + 1) * strain[k], rel=1e-12)


@pytest.mark.parametrize("element_type", TYPES)
def test_bar_that_is_drawn_out(run_deck, element_type):
    """A solid cylinder to 1.5 of its length in ten increments with NLGEOM: strains add up along the axis and around it,
    the force is E times strain times the area that is left."""
    nodes, _ = mesh = strip(element_type, 2, 1.0, inner=0.0, outer=1.0)
    step = "*BOUNDARY\nBOTTOM, 2\nTOP, 2, 2, 0.5\n1, 1\n2, 1"
    procedure, nu = "*STATIC, DIRECT\n0.1, 1.", 0.3
    result = run_deck(deck(element_type, mesh, step, options=", NLGEOM", procedure=procedure))
    lengths = np.linspace(1, 1.5, 11)
    parts = 2 * np.diff(lengths) / (lengths[1:] + lengths[:-1])
    # nu times the strain is 2 (r_0 - r_1)/(r_0 + r_1) in each increment
    radius = np.prod((1 - nu * parts / 2) / (1 + nu * parts / 2))
    force = YOUNG * parts.sum() * np.pi * radius**2
    top = nodes[:, 1] == 1
    assert column(result, "RF2", len(nodes))[top].sum() == pytest.approx(force, rel=1e-4)
    assert force == pytest.approx(YOUNG * np.log(1.5) * np.pi * 1.5 ** (-2 * nu), rel=2e-3)
    np.testing.assert_allclose(column(result, "U1", len(nodes)), (radius - 1) * nodes[:, 0], rtol=1e-4, atol=1e-9)


def test_stabilisation_has_the_mass_of_the_ring(run_deck):
    """A free ring under a force along the axis: the artificial mass of unit density resists, u = F dt/(factor mass)."""
    mesh = strip("CAX4", 1, 0.5)
    step = "*CLOAD\nTOP, 2, 1."
    result = run_deck(deck("CAX4", mesh, step, procedure="*STATIC, STABILIZE, FACTOR=2., DIRECT\n1., 1."))
    mass = np.pi * (OUTER**2 - INNER**2) * 0.5
    weights = (OUTER + 2 * INNER) / 6, (2 * OUTER + INNER) / 6
    mean = np.average(column(result, "U2", 4), weights=[weights[0], weights[0], weights[1], weights[1]])
    assert mean == pytest.approx(2.0 / (2 * mass), rel=1e-6)


def test_heat_through_a_pipe(run_deck):
    """Conduction between two radii: 2 pi k h (T_a - T_b)/ln(b/a)."""
    nodes, _ = mesh = strip("CAX8T", 6, 0.5)
    corners = [k for k, (_, z) in enumerate(nodes, start=1) if z != 0.25]
    inside, outside = ([k for k in corners if nodes[k - 1, 0] == r] for r in (INNER, OUTER))
    held = [f"{k}, 11, 11, 100." for k in inside] + [f"{k}, 11, 11, 20." for k in outside]
    text = deck(
        "CAX8T",
        mesh,
        "\n".join(["*BOUNDARY", "ALL, 1, 2", *held]),
        procedure="*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE\n1., 1.",
    )
    text = text.replace("*DENSITY", "*CONDUCTIVITY\n3.\n*DENSITY")
    result = run_deck(text)
    flow = sum(result.history[f"RFL11[ALL:{k}]"][-1] for k in inside)
    assert flow == pytest.approx(2 * np.pi * 3 * 0.5 * 80 / np.log(2), rel=2e-3)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            ("TYPE=CAX4", "TYPE=COHAX4"),
            r"element type COHAX4 of Abaqus is not supported here; the nearest are .*CAX4",
        ),
        (("TYPE=CAX4", "TYPE=CAX4I"), r"element type CAX4I of Abaqus is not supported"),
        (("TYPE=CAX4", "TYPE=CGAX4"), r"element type CGAX4 of Abaqus is not supported"),
        (("1, 1.0, 0.0", "1, -1.0, 0.0"), r"deck.inp:7: element 1 \(type CAX4\): node 1 is at the radius -1"),
        (("BODY, BZ", "BODY, BX"), r"load type BX on elements of type CAX4, whose body forces are BR, BZ"),
        (("TYPE=CAX4", "TYPE=CPE4"), r"load type BZ on elements of type CPE4, whose body forces are BX, BY"),
        (("BODY, BZ", "BODY, CENTRIF"), r"load type CENTRIF is not supported"),
        (("BODY, BZ", "BODY, P5"), r"elements of type CAX4 have no face S5"),
        (("*ELASTIC\n1000.0, 0.3", "*ELASTIC, TYPE=LAMINA\n1., 1., 0., 1., 1., 1."), "LAMINA is not .* plane stress"),
    ],
)
def test_what_is_wrong_is_named(run_deck, change, message):
    text = deck("CAX4", strip("CAX4", 1, 0.5), "*BOUNDARY\nALL, 1, 2\n*DLOAD\nBODY, BZ, 1.")
    assert change[0] in text
    with pytest.raises(DeckError, match=message):
        run_deck(text.replace(*change))


def test_an_element_that_is_pushed_over_the_axis_is_named(run_deck):
    text = deck("CAX4", strip("CAX4", 1, 0.5), "*BOUNDARY\nALL, 2\nALL, 1, 1, -4.", options=", NLGEOM")
    with pytest.raises(ConvergenceError, match=r"element 1 .*: crosses the axis at its integration point 1"):
        run_deck(text)
