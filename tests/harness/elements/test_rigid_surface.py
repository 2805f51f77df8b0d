# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Analytical rigid surfaces: derivatives, and punches, cylinders and rollers by closed forms."""

import numpy as np
import pytest
from contact_decks import YOUNG, Box, total
from contact_points import SOURCE, Points

from uel.model.contact import ContactProperty, RigidProfile, SlidingPair

THICKNESS = 1.5
REDUCED = YOUNG / (1 - 0.3**2)


# ------------------------------------------------------------ derivatives

PROFILE = RigidProfile(
    reference=0,
    middle=np.array([[-2.0, 1.0], [0.0, 0.0], [2.0, 1.0]]),
    half=np.array([[-1.0, 0.2], [np.pi / 2, 0.6], [-1.0, -0.2]]),
    radius=np.array([0.0, 1.0, 0.0]),
    free=np.array([[True, False], [False, False], [False, True]]),
)


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("stiffness", [None, 40.0])
@pytest.mark.parametrize("moved", [0.003, 0.1])
def test_matrix_by_differences(call, stiffness, friction, moved):
    """Four points in front of lines and an arc, that stick (moved little) and slip (moved far)."""
    rng = np.random.default_rng(5)
    coordinates = np.array([[0.3, -0.4, 0], [-2.2, 0.8, 0], [-0.2, 0.8, 0], [0.3, 0.75, 0], [1.9, 0.8, 0]])
    surface = ContactProperty("P", SOURCE, stiffness=stiffness, friction=friction)
    pair = SlidingPair("(A,B)", surface, SOURCE, 2, np.arange(1, 5), (), PROFILE, np.linspace(0.5, 1.5, 4), 10.0)
    points = Points(call, pair, coordinates, (1, 2, 6))
    start = 0.02 * rng.normal(size=points.size)
    # the reference node turns
    start[2] = 0.05
    start[points.multipliers] = rng.uniform(0.5, 1.0, points.size - points.multipliers.start)
    found = points.check_matrix(start, moved * rng.normal(size=points.size))
    if not friction:
        np.testing.assert_allclose(found, found.T, atol=1e-12 * np.abs(found).max())


def test_node_at_the_centre_of_an_arc(call):
    """Inside a hollow arc of radius 2 every point is opposite its centre: the clearance is the radius."""
    hollow = RigidProfile(
        reference=0,
        middle=np.zeros((1, 2)),
        half=np.array([[-np.pi / 2, -1.0]]),
        radius=np.array([2.0]),
        free=np.ones((1, 2), dtype=bool),
    )
    surface = ContactProperty("P", SOURCE)
    pair = SlidingPair("(A,B)", surface, SOURCE, 2, np.array([1]), (), hollow, np.ones(1), 10.0)
    points = Points(call, pair, np.array([[0.0, 5.0, 0.0], [0.0, 0.0, 0.0]]), (1, 2, 6))
    still = np.zeros(points.size)
    residual, matrix = points.evaluate(points.first, still, still)
    np.testing.assert_allclose(points.block.output[0], 2.0)
    assert np.isfinite(matrix).all()
    np.testing.assert_array_equal(residual, 0.0)


# ------------------------------------------------------------ closed forms


def block_and(profile, steps, across, *, reference="0., 10.", interaction="", held="", element_type="CPE4"):
    """The right half of a block, x = 0 in its middle, whose upper side y = 0 an analytical surface meets."""
    body = Box("BODY", element_type, (0, 0), (1, 1), (len(across) - 1, len(across) - 1))
    depth = -across[::-1]
    body.nodes = np.stack(np.meshgrid(across, depth, indexing="ij"), axis=-1).reshape(-1, 2)
    lines = ["*HEADING", "a block under a rigid surface", *body.lines(), "*MATERIAL, NAME=M", f"*ELASTIC\n{YOUNG}, 0.3"]
    lines += [f"*NODE, NSET=REF\n90000, {reference}", "*SURFACE, NAME=TOOL, TYPE=SEGMENTS", *profile]
    lines += ["*RIGID BODY, ANALYTICAL SURFACE=TOOL, REF NODE=REF", "*SURFACE INTERACTION, NAME=TOUCH", interaction]
    lines += ["*CONTACT PAIR, INTERACTION=TOUCH\nBODY_HIGH, TOOL", "*BOUNDARY\nBODY_BOTTOM, 2\nBODY_LEFT, 1", held]
    text = "\n".join([line for line in lines if line] + [step_of(*step) for step in steps]) + "\n"
    return body, text


def step_of(procedure, *lines, options=""):
    output = "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=REF\nU, RF, RM\n*OUTPUT, FIELD"
    return "\n".join([f"*STEP, NLGEOM, INC=200{options}\n*STATIC", procedure, *lines, output, "*END STEP"])


ACROSS = np.concatenate([np.arange(0, 1.55, 0.1), 1.5 + np.geomspace(0.12, 18.5, 14)])


def at_top(result, body, name):
    """Field at the nodes of the upper side, from x = 0."""
    numbers = result.mesh().point_data["NODE"]
    return result.field(name)[[int(np.flatnonzero(numbers == number)[0]) for number in body.numbers[:, -1]]]


def test_hertz_of_a_rigid_cylinder(run_deck):
    """Half-width b = sqrt(4 P R / (pi E*)), pressure 2 P / (pi b) sqrt(1 - x^2 / b^2).

    K. L. Johnson, Contact Mechanics (1985), section 4.2, with one body rigid. Faces have a length of 0.1.
    """
    radius = 50.0
    x = 20.0
    y = float(radius - np.sqrt(radius**2 - x**2))
    profile = [f"START, {x!r}, {y!r}", f"CIRCL, {-x!r}, {y!r}, 0., {radius!r}"]
    push = ("1., 1.", "*BOUNDARY\nREF, 1\nREF, 6\nREF, 2, 2, -0.05")
    body, text = block_and(profile, [push], ACROSS)
    result = run_deck(text)
    force = -2 * total(result, "RF2", "REF")[-1] / THICKNESS
    half = np.sqrt(4 * force * radius / (np.pi * REDUCED))
    assert 0.7 < half < 1.3
    pressure = at_top(result, body, "CPRESS")
    last = ACROSS[pressure > 0].max()
    assert half - 0.1 <= last <= half + 0.1
    inner = 0.75 * half > ACROSS
    wanted = 2 * force / (np.pi * half) * np.sqrt(1 - (ACROSS[inner] / half) ** 2)
    np.testing.assert_allclose(pressure[inner], wanted, rtol=0.03)


def test_flat_punch(run_deck):
    """Without friction the pressure under a flat punch of half-width a is P / (pi sqrt(a^2 - x^2)).

    K. L. Johnson, Contact Mechanics (1985), section 2.8. Nodes at the edge have a singular pressure and are left out.
    """
    half = 1.45
    push = ("1., 1.", "*BOUNDARY\nREF, 1\nREF, 6\nREF, 2, 2, -0.01")
    body, text = block_and([f"START, {half}, 0.", f"LINE, {-half}, 0."], [push], ACROSS)
    result = run_deck(text)
    force = -2 * total(result, "RF2", "REF")[-1] / THICKNESS
    pressure = at_top(result, body, "CPRESS")
    np.testing.assert_array_equal(pressure > 0, half > ACROSS)
    inner = 0.75 * half > ACROSS
    wanted = force / (np.pi * np.sqrt(half**2 - ACROSS[inner] ** 2))
    np.testing.assert_allclose(pressure[inner], wanted, rtol=0.05)


def test_roller_turned_about_its_reference_node(run_deck):
    """A roller of radius 2 is pressed down and turned: it slips with a moment mu R times the sum of normal forces."""
    radius, friction = 2.0, 0.3
    across = np.linspace(0.0, 6.0, 25)
    profile = ["START, 5., 2.", "CIRCL, 3., 0., 3., 2.", "CIRCL, 1., 2., 3., 2."]
    press = ("0.5, 1.", "*BOUNDARY\nREF, 1\nREF, 6\nREF, 2, 2, -0.04")
    turn = ("0.1, 1., 1e-5, 0.1", "*BOUNDARY\nREF, 6, 6, -0.8")
    body, text = block_and(
        profile,
        [press, turn],
        across,
        reference="3., 2.",
        interaction=f"*FRICTION\n{friction},",
        held="*BOUNDARY\nBODY_BOTTOM, 1\nBODY_RIGHT, 1",
    )
    result = run_deck(text)
    normal = (at_top(result, body, "CPRESS") * np.gradient(across) * THICKNESS).sum()
    moment, pull, push = (total(result, name, "REF")[-1] for name in ("RM3", "RF1", "RF2"))
    assert normal > 10.0
    assert moment == pytest.approx(-friction * radius * normal, rel=1e-6)
    assert -push == pytest.approx(normal, rel=0.02)
    # clockwise, its lower side moves left and drags the block there
    assert pull == pytest.approx(-friction * normal, rel=0.05)


def test_ring_on_a_rigid_plate(run_deck):
    """About the axis: a cylinder under a rigid plate has the stress E strain, and presses with its whole area."""
    across = np.linspace(0.0, 2.0, 5)
    push = ("1., 1.", "*BOUNDARY\nREF, 1\nREF, 6\nREF, 2, 2, -0.002")
    _, text = block_and(["START, 3., 0.", "LINE, -1., 0."], [push], across, reference="0., 0.", element_type="CAX4")
    result = run_deck(text.replace("*STEP, NLGEOM", "*STEP"))
    assert total(result, "RF2", "REF")[-1] == pytest.approx(-YOUNG * 0.001 * np.pi * 2**2, rel=1e-9)
    np.testing.assert_allclose(result.field("S22"), -YOUNG * 0.001, rtol=1e-9)


@pytest.mark.long
def test_roller_that_is_free_to_turn(run_deck):
    """Drawn along a held block with friction, it rolls: no moment, hardly a force, and it turns by way over radius.

    Nodes come into contact one after the other and stick; it turns with the chord of those in contact.
    """
    radius = 2.0
    profile = ["START, 5., 2.", "CIRCL, 3., 0., 3., 2.", "CIRCL, 1., 2., 3., 2."]
    press = ("0.5, 1.", "*BOUNDARY\nREF, 1\nREF, 6\nREF, 2, 2, -0.01")
    draw = (
        "0.05, 1., 1e-6, 0.05",
        "*BOUNDARY, OP=NEW\nREF, 1, 1, 1.\nREF, 2, 2, -0.01\nBODY_BOTTOM, 1, 2\nBODY_RIGHT, 1",
    )
    _, text = block_and(
        profile,
        [press, draw],
        np.linspace(0.0, 6.0, 61),
        reference="3., 2.",
        interaction="*FRICTION\n0.5,",
        held="*BOUNDARY\nBODY_BOTTOM, 1\nBODY_RIGHT, 1",
    )
    result = run_deck(text.replace("BODY_BOTTOM, 1, 2\n", "BODY_BOTTOM, 1, 2\nBODY_LEFT, 1\n"))
    turn, pull, push = (total(result, name, "REF")[-1] for name in ("UR3", "RF1", "RF2"))
    assert push < -1.0
    assert turn == pytest.approx(-1.0 / radius, rel=0.02)
    assert abs(pull) < 0.02 * abs(push)
