# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Coupled temperature-displacement elements: conduction and storage of heat by theory, stresses as without heat."""

import numpy as np
import pytest
from bars import column, held
from small_decks import body_lines

from uel.errors import DeckError
from uel.model.element_types import COUPLED

CONDUCTIVITY, DENSITY, HEAT, THICKNESS = 3.0, 2.0, 0.7, 0.5
MATERIAL = f"""*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*CONDUCTIVITY
{CONDUCTIVITY}
*DENSITY
{DENSITY}
*SPECIFIC HEAT
{HEAT}
"""
# four quadrilaterals around a node off the middle of a square of side 2; triangles are their halves
PLANE = np.array([[0, 0], [1, 0], [2, 0], [0, 1], [1.2, 0.7], [2, 1], [0, 2], [1, 2], [2, 2.0]])
QUADS = np.array([[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]])
SIDES = [[0, 1], [1, 2], [2, 3], [3, 0]]
TETRAHEDRON_SIDES = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]]
CUBE_SIDES = [*SIDES, [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]]


def with_middles(nodes, elements, sides):
    """The mesh with a node in the middle of each edge."""
    edges, inverse = np.unique(np.sort(elements[:, sides].reshape(-1, 2)), axis=0, return_inverse=True)
    middles = len(nodes) + inverse.reshape(len(elements), -1)
    return np.vstack([nodes, nodes[edges].mean(axis=1)]), np.hstack([elements, middles])


def mesh(element_type):
    """Nodes, elements and number of corner nodes of a square plate or a cube of side 2."""
    kind = COUPLED[element_type]
    if kind.dimension == 2:
        nodes, elements, sides = PLANE, QUADS, SIDES
        if kind.nodes == 3:
            elements = np.vstack([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]])
    else:
        nodes = np.vstack([np.hstack([PLANE, np.full((9, 1), z)]) for z in (0.0, 0.9, 2.0)])
        plane = np.vstack([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]]) if kind.nodes == 6 else QUADS
        elements = np.vstack([np.hstack([plane + 9 * k, plane + 9 * (k + 1)]) for k in range(2)])
        nodes[13, 2] = 1.2
        sides = CUBE_SIDES
        if kind.corners == 4:
            sides = TETRAHEDRON_SIDES
            split = [[0, 1, 3, 4], [1, 2, 3, 6], [4, 6, 5, 1], [4, 7, 6, 3], [1, 3, 4, 6]]
            nodes, elements = (
                2 * np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]),
                split,
            )
            nodes, elements = nodes.astype(float), np.array(elements)
    corners = len(nodes)
    if kind.nodes > kind.corners:
        nodes, elements = with_middles(nodes, elements, sides)
    return nodes, elements, corners


def deck(element_type, nodes, elements, step, *, material=MATERIAL, procedure=""):
    """A deck of one body with history output of temperatures, heat, displacements and forces at all nodes."""
    procedure = procedure or "*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE\n1., 1."
    lines = [
        *body_lines(element_type, nodes, elements),
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M",
        f"{THICKNESS}",
        material.strip(),
        "*STEP, INC=1000",
        procedure,
        step,
    ]
    lines += ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "NT, RFL, U, RF", "*END STEP", ""]
    return "\n".join(lines)


HELD = "*BOUNDARY\nALL, 1, 3\n"


def body_volume(element_type):
    """Of the plate, the cube, or the cylinder of radius and height 2."""
    if COUPLED[element_type].axisymmetric:
        return np.pi * 2.0**2 * 2.0
    return 4.0 * THICKNESS if COUPLED[element_type].dimension == 2 else 8.0


@pytest.mark.parametrize("element_type", COUPLED)
def test_patch_of_a_linear_temperature(run_deck, element_type):
    """Any temperature that varies linearly is steady, about an axis one that varies along it; the first moment of the
    heat at the nodes is conductivity x gradient x volume."""
    nodes, elements, corners = mesh(element_type)
    dimension = nodes.shape[1]
    gradient = np.array([0.0 if COUPLED[element_type].axisymmetric else 2.0, -1.0, 0.5])[:dimension]
    outside = np.flatnonzero(((nodes[:corners] == 0) | (nodes[:corners] == 2)).any(axis=1))
    step = HELD + held(outside, 5.0 + nodes[outside] @ gradient)
    history = run_deck(deck(element_type, nodes, elements, step)).history
    temperature = column(history, "NT11", corners)[-1]
    np.testing.assert_allclose(temperature, 5.0 + nodes[:corners] @ gradient, rtol=1e-12)
    heat = column(history, "RFL11", corners)[-1]
    moment = CONDUCTIVITY * gradient * body_volume(element_type)
    np.testing.assert_allclose(nodes[:corners].T @ heat, moment, rtol=1e-11, atol=1e-11)
    assert heat.sum() == pytest.approx(0.0, abs=1e-11 * abs(heat).sum())


@pytest.mark.parametrize("element_type", [name for name in COUPLED if not name.startswith("CPS")])
def test_heat_that_a_warm_body_stores(run_deck, element_type):
    """All of it warms by 1 in the increment h: the heat is density x specific heat x volume / h."""
    nodes, elements, corners = mesh(element_type)
    step = HELD + held(range(corners), np.ones(corners))
    procedure = "*COUPLED TEMPERATURE-DISPLACEMENT\n0.25, 0.25"
    history = run_deck(deck(element_type, nodes, elements, step, procedure=procedure)).history
    heat = column(history, "RFL11", corners)[-1]
    assert heat.sum() == pytest.approx(DENSITY * HEAT * body_volume(element_type) / 0.25)
    # a temperature to which each corner adds its part
    assert (heat > 0).all()


@pytest.mark.parametrize("element_type", ["CPE4T", "CPS4RT", "C3D8T"])
def test_warming_is_backward_euler_with_heat_at_the_corners(run_deck, element_type):
    """A rod, one end at 1 from 0 on: C dT/dt = G (1 - T), G = k A/L, C = rho c A L/2 with heat at corners."""
    plane = np.array([[0, 0], [2, 0], [2, 1], [0, 1.0]])
    cube = np.array([[*x, z] for z in (0.0, 1.0) for x in plane])
    nodes = cube if element_type == "C3D8T" else plane
    h, left = 0.1, np.flatnonzero(nodes[:, 0] == 0)
    procedure = f"*COUPLED TEMPERATURE-DISPLACEMENT\n{h}, {10 * h}"
    step = HELD + held(left, np.ones(len(left)))
    history = run_deck(deck(element_type, nodes, np.array([range(len(nodes))]), step, procedure=procedure)).history
    rate = 2 * CONDUCTIVITY / (DENSITY * HEAT * 2.0**2)
    expected = 1 - (1 + rate * h) ** -np.arange(1, 11)
    for node in np.flatnonzero(nodes[:, 0] == 2):
        np.testing.assert_allclose(history[f"NT11[ALL:{node + 1}]"][-10:], expected, rtol=1e-12)


def test_heat_flows_through_the_present_shape(run_deck):
    """A strip stretched from 1 to 1.5 and as wide as before conducts 1/1.5 of the heat, and stores as much."""
    nodes = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
    stretch = "*BOUNDARY\nALL, 2\n1, 1\n4, 1\n2, 1, 1, 0.5\n3, 1, 1, 0.5\n"
    step = stretch + held([0, 3], [0, 0]) + held([1, 2], [1, 1])
    text = deck("CPE4T", nodes, np.array([[0, 1, 2, 3]]), step)
    small = run_deck(text).history
    large = run_deck(text.replace("INC=1000", "INC=1000, NLGEOM")).history
    flow = CONDUCTIVITY * THICKNESS
    assert small["RFL11[ALL:2]"][-1] == pytest.approx(flow / 2)
    assert large["RFL11[ALL:2]"][-1] == pytest.approx(flow / 2 / 1.5)


def test_stresses_are_those_of_the_element_without_temperatures(run_deck):
    nodes, elements, corners = mesh("CPE4T")
    pull = "*BOUNDARY\n1, 1, 2\n4, 1\n7, 1\n3, 1, 1, 0.02\n6, 1, 1, 0.02\n9, 1, 1, 0.02\n"
    warm = run_deck(deck("CPE4T", nodes, elements, pull + held(range(corners), nodes[:, 0]))).history
    plain = run_deck(deck("CPE4", nodes, elements, pull, procedure="*STATIC\n1., 1.")).history
    # the forces of the elastic ones are those of their matrices, which rounds otherwise
    for name in ("U1", "U2", "RF1", "RF2"):
        np.testing.assert_allclose(column(warm, name, 9), column(plain, name, 9), rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize(
    ("material", "procedure", "message"),
    [
        (
            "*CONDUCTIVITY\n3.0",
            "",
            r"deck.inp:\d+: material M has no \*CONDUCTIVITY or \*USER MATERIAL, TYPE=THERMAL, which .* CPE4T need",
        ),
        ("*SPECIFIC HEAT\n0.7", "*COUPLED TEMPERATURE-DISPLACEMENT\n1., 1.", r"material M has no \*SPECIFIC HEAT"),
        ("*DENSITY\n2.0", "*COUPLED TEMPERATURE-DISPLACEMENT\n1., 1.", r"material M has no \*DENSITY"),
        (
            "",
            "*STATIC\n1., 1.",
            r"\*STATIC is not supported for elements of type CPE4T.*; supported: \*COUPLED TEMPERATURE-DISPLACEMENT",
        ),
        (
            "",
            "*HEAT TRANSFER, STEADY STATE\n1., 1.",
            r"\*HEAT TRANSFER is not supported for elements of type CPE4T.*; supported: \*COUPLED",
        ),
    ],
)
def test_what_is_missing_is_named(run_deck, material, procedure, message):
    nodes = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
    given = MATERIAL.replace(material + "\n", "") if material else MATERIAL
    text = deck("CPE4T", nodes, np.array([[0, 1, 2, 3]]), HELD, material=given, procedure=procedure)
    with pytest.raises(DeckError, match=message):
        run_deck(text)
