# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Contact in finite sliding: derivatives, rotations, and bodies that slide over many faces, by closed forms."""

import numpy as np
import pytest
from contact_decks import Box, step, total, two_boxes
from contact_points import SOURCE, Points, rotation_of

from uel.contact.block import SLIPPING, STICKING
from uel.deck.contact.sliding_surfaces import make_pieces
from uel.model.contact import ContactProperty, SlidingPair


def arc(count=6, radius=4.0):
    """Nodes of a part of a circle and lines between them, outward normals upward."""
    angle = np.linspace(2.4, 0.7, count + 1)
    nodes = radius * np.stack([np.cos(angle), np.sin(angle) - 1, 0 * angle], axis=1)
    return nodes, [np.stack([np.arange(1, count + 1), np.arange(count)], axis=1)]


def dome(count=3):
    """Nodes of a curved roof of quadrilaterals, two of which are cut into triangles."""
    x, y = np.meshgrid(np.arange(count + 1.0), np.arange(count + 1.0), indexing="ij")
    nodes = np.stack([x, y, 0.1 * np.sin(x) * np.cos(2 * y)], axis=-1).reshape(-1, 3)
    n = np.arange((count + 1) ** 2).reshape(count + 1, count + 1)
    four = np.stack([n[:-1, :-1], n[1:, :-1], n[1:, 1:], n[:-1, 1:]], axis=-1).reshape(-1, 4)
    cut = four[3:5]
    return nodes, [np.delete(four, [3, 4], axis=0), np.concatenate([cut[:, :3], cut[:, [0, 2, 3]]])]


def pair_of(dimension, rng, *, stiffness=None, friction=0.0, smooth=0.2, height=0.0):
    """Five points near a curved surface, with coordinates of all nodes."""
    main, faces = arc() if dimension == 2 else dome()
    count = 5
    points = np.zeros((count, 3))
    if dimension == 2:
        angle = rng.uniform(0.9, 2.2, count)
        points[:, :2] = (4.0 + height) * np.stack([np.cos(angle), np.sin(angle)], axis=1) - [0, 4.0]
    else:
        points[:, :2] = rng.uniform(0.1, 2.9, (count, 2))
        points[:, 2] = 0.1 * np.sin(points[:, 0]) * np.cos(2 * points[:, 1]) + height
    surface = ContactProperty("P", SOURCE, stiffness=stiffness, friction=friction)
    secondary = len(main) + np.arange(count)
    pieces = make_pieces(faces, main, smooth, 0.1)
    pair = SlidingPair("(A,B)", surface, SOURCE, dimension, secondary, (), pieces, rng.uniform(0.5, 1.5, count), 10.0)
    return pair, np.concatenate([main, points])


@pytest.mark.sample(3)
@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("stiffness", [None, 40.0])
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("moved", [0.003, 0.1])
def test_matrix_by_differences(call, dimension, stiffness, friction, moved):
    """Points that stick (moved little) and slip (moved far)."""
    rng = np.random.default_rng(5)
    for _ in range(2):
        pair, coordinates = pair_of(dimension, rng, stiffness=stiffness, friction=friction, height=-0.2)
        points = Points(call, pair, coordinates, range(1, dimension + 1))
        start = 0.01 * rng.normal(size=points.size)
        start[points.multipliers] = rng.uniform(0.5, 1.0, points.size - points.multipliers.start)
        found = points.check_matrix(start, moved * rng.normal(size=points.size))
        if not friction and dimension == 3:
            np.testing.assert_allclose(found, found.T, atol=1e-12 * np.abs(found).max())


@pytest.mark.parametrize("dimension", [2, 3])
def test_points_that_do_not_move_on_stick_after_an_increment_with_slip(call, dimension):
    """Their elastic slip is the largest one but for rounding, which would choose the status otherwise."""
    rng = np.random.default_rng(6)
    slipped = 0
    for _ in range(20):
        pair, coordinates = pair_of(dimension, rng, stiffness=40.0, friction=0.3, height=-0.2)
        points = Points(call, pair, coordinates, range(1, dimension + 1))
        u, still = 0.1 * rng.normal(size=points.size), np.zeros(points.size)
        points.evaluate(points.first, still, still)
        points.evaluate(points.second, u, u)
        points.block.commit()
        slipping = points.block.kept()["status"] == SLIPPING
        slipped += np.count_nonzero(slipping)
        points.evaluate(points.first, u, still)
        points.evaluate(points.second, u, still)
        points.block.commit()
        assert (points.block.kept()["status"][slipping] == STICKING).all()
    assert slipped > 50


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize(("dimension", "smooth"), [(2, 0.2), (2, 0.0), (3, 0.0)])
def test_bodies_that_turn(call, dimension, smooth, friction):
    """Both surfaces turn together, by any angle: clearances stay, forces turn, and so do elastic slips."""
    rng = np.random.default_rng(7)
    pair, coordinates = pair_of(dimension, rng, stiffness=40.0, friction=friction, height=-0.1, smooth=smooth)
    points = Points(call, pair, coordinates, range(1, dimension + 1))
    block, places, d = points.block, coordinates[:, :dimension], dimension
    slid = np.zeros_like(places)
    slid[pair.secondary] = 0.02 * rng.normal(size=(5, d))
    still = np.zeros(points.size)
    points.evaluate(points.first, still, still)
    before = points.evaluate(points.second, slid.ravel(), slid.ravel())[0].reshape(-1, d)
    clearances = block.output[0]
    block.commit()
    assert np.abs(before).max() > 1.0
    turn, steps, last = 0.0, 4, slid
    for _ in range(steps):
        turn += 2.5 / steps
        rotation = rotation_of(turn, d)
        now = (places + slid) @ rotation.T - places
        points.evaluate(points.first, last.ravel(), still)
        forces = points.evaluate(points.second, now.ravel(), (now - last).ravel())[0].reshape(-1, d)
        block.commit()
        last = now
        np.testing.assert_allclose(block.output[0], clearances, atol=1e-12)
    np.testing.assert_allclose(forces, before @ rotation.T, atol=1e-11)
    np.testing.assert_allclose(forces.sum(axis=0), 0.0, atol=1e-11)
    if friction or smooth:
        # friction acts on the main surface below a penetrating node, and a force at a rounded node on the face
        return
    moments = np.einsum("np,nq->pq", places + last, forces)
    np.testing.assert_allclose(moments, moments.T, atol=1e-10)


# ------------------------------------------------------------ bodies that slide


PAIR = "TYPE=NODE TO SURFACE"
PENALTY = "*SURFACE BEHAVIOR, PENALTY\n1e5"


def of_step(result, number, values):
    """Values at the ends of the increments of a step."""
    return values[result.history["step"] == number]


@pytest.mark.sample(5)
@pytest.mark.parametrize("nlgeom", ["", ", NLGEOM"])
@pytest.mark.parametrize("behavior", ["*FRICTION\n0.3,", "", f"{PENALTY}\n*FRICTION\n0.3,"])
@pytest.mark.parametrize("pair", [PAIR, "TYPE=SURFACE TO SURFACE"])
def test_block_slides_over_many_faces(run_deck, pair, behavior, nlgeom):
    """Under a load N over 16 faces of a body whose nodes are all held: mu N where it slips, and back."""
    lower, upper = (
        Box("LOWER", "CPE4", (0, 0), (10, 1), (20, 1)),
        Box("UPPER", "CPE4", (0.3, 1), (1.3, 2), (2, 1), 1001),
    )
    loads = "*CLOAD\n" + "\n".join(f"{number}, 2, -10." for number in upper.numbers[:, -1])
    press = step("1., 1.", loads, "*BOUNDARY\nUPPER_LEFT, 1", options=nlgeom)
    output = "*NODE OUTPUT, NSET=UPPER_LEFT\nU, RF1\n*NODE OUTPUT, NSET=LOWER_TOP\nRF2"
    slide = [
        step("0.05, 1., 1e-6, 0.05", f"*BOUNDARY\nUPPER_LEFT, 1, 1, {to}", options=", INC=200", output=output)
        for to in (8.0, 0.0)
    ]
    held = "*BOUNDARY\nLOWER_BOTTOM, 1, 2\nLOWER_TOP, 1, 2"
    result = run_deck(two_boxes(lower, upper, [held, press, *slide], pair=pair, behavior=behavior))
    friction = 0.3 * 30.0 if "FRICTION" in behavior else 0.0
    found = total(result, "RF1", "UPPER_LEFT")
    np.testing.assert_allclose(of_step(result, 2, found), friction, atol=2e-3 * 9)
    # the first increments back may still stick
    np.testing.assert_allclose(of_step(result, 3, found)[2:], -friction, atol=2e-3 * 9)
    # what is held holds all of it
    np.testing.assert_allclose(
        of_step(result, 2, total(result, "RF2", "LOWER_BOTTOM", "LOWER_TOP"))[-1], 30.0, rtol=1e-3
    )


TRUSS = """\
*HEADING
a bar that turns about the centre of an arc
*NODE
900, 0., 1.
901, 0., 10.
{nodes}
*NSET, NSET=HELD, GENERATE
1, {last}
*NSET, NSET=TIP
901,
*NSET, NSET=CENTRE
900,
*ELEMENT, TYPE=T2D2, ELSET=BAR
900, 900, 901
*ELEMENT, TYPE=CPE4, ELSET=RING
{elements}
*SOLID SECTION, ELSET=BAR, MATERIAL=SOFT
2.
*SOLID SECTION, ELSET=RING, MATERIAL=M
1.
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*MATERIAL, NAME=SOFT
*ELASTIC
500., 0.
*SURFACE, NAME=OUT
RING, S3
*SURFACE, NAME=POINT, TYPE=NODE
901,
*SURFACE INTERACTION, NAME=TOUCH
*FRICTION
{friction},
*CONTACT PAIR, INTERACTION=TOUCH
POINT, OUT
*BOUNDARY
HELD, 1, 2
"""


@pytest.mark.sample(2)
@pytest.mark.parametrize("friction", [0.25, 0.0])
def test_point_slides_round_an_arc(run_deck, friction):
    """A stretched bar pulls its end onto an arc of radius 10; the end is moved by 8 in x, to 53 degrees.

    With phi from the vertical and the tension N of the bar, equilibrium with a normal force L along the bar and
    friction mu L across it gives RF = mu N / (cos phi + mu sin phi) along x, and without friction no force and no work.
    On the faces of the arc, 3.3 degrees each, normals differ by up to 0.6 of half of that from the bar, but not in the
    mean.
    """
    count, radius = 40, 10.0
    angle = np.linspace(np.pi - 0.4, 0.4, count + 1)
    rings = np.stack([r * np.stack([np.cos(angle), np.sin(angle)], axis=1) for r in (9.5, radius)])
    nodes = "\n".join(f"{k + 1}, {x!r}, {y!r}" for k, (x, y) in enumerate(rings.reshape(-1, 2).tolist()))
    outer = count + 1
    # side 3 is the outer one
    elements = "\n".join(f"{k}, {k}, {k + 1}, {k + 1 + outer}, {k + outer}" for k in range(1, count + 1))
    model = TRUSS.format(nodes=nodes, elements=elements, last=2 * outer, friction=friction)
    output = "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=TIP\nU, RF\n*NODE OUTPUT, NSET=CENTRE\nRF\n*OUTPUT, FIELD"
    stretch = "*STEP, NLGEOM\n*STATIC\n1., 1.\n*BOUNDARY\nCENTRE, 2, 2, -1.\nCENTRE, 1\nTIP, 1\n"
    slide = "*STEP, NLGEOM, INC=1000\n*STATIC\n0.01, 1., 1e-7, 0.01\n*BOUNDARY\nTIP, 1, 1, 8.\n"
    result = run_deck(model + "".join(f"{text}{output}\n*END STEP\n" for text in (stretch, slide)))
    x, y = (of_step(result, 2, total(result, name, "TIP")) for name in ("U1", "U2"))
    force = of_step(result, 2, total(result, "RF1", "TIP"))
    tension = np.hypot(*(of_step(result, 2, total(result, name, "CENTRE")) for name in ("RF1", "RF2")))
    phi = np.arctan2(x, y + radius)
    wanted = friction * tension / (np.cos(phi) + friction * np.sin(phi))
    # no further inside than the middles of the faces
    place, deepest = np.hypot(x, y + radius), radius * np.cos(0.5 * (angle[0] - angle[1]))
    assert deepest - 1e-9 <= place.min() < place.max() <= radius
    assert tension.min() > 90.0
    slipping = slice(5, None)
    np.testing.assert_allclose(force[slipping], wanted[slipping], atol=0.02 * tension.max() / np.cos(phi[-1]))
    work = np.trapezoid(force[slipping] - wanted[slipping], x[slipping])
    assert abs(work) < 1e-3 * tension.max() * x[-1]


def test_block_slides_in_space(run_deck):
    """Diagonally over the edges of square faces of a body whose nodes are all held: mu N against the motion."""
    lower = Box("LOWER", "C3D8", (0, 0, 0), (4, 4, 1), (6, 6, 1))
    upper = Box("UPPER", "C3D8", (0.2, 0.3, 1), (1.2, 1.3, 2), (1, 1, 1), 1001)
    loads = "*CLOAD\n" + "\n".join(f"{number}, 3, -5." for number in upper.numbers[..., -1].ravel())
    press = step("1., 1.", loads, "*BOUNDARY\nUPPER, 1, 2".replace("UPPER", "ABOVE"))
    slide = step(
        "0.1, 1., 1e-6, 0.1",
        "*BOUNDARY\nABOVE, 1, 1, 2.4\nABOVE, 2, 2, 1.8",
        options=", INC=100",
        output="*NODE OUTPUT, NSET=ABOVE\nU, RF",
    )
    model = "*NSET, NSET=BELOW, GENERATE\n1, 98\n*NSET, NSET=ABOVE, GENERATE\n1001, 1008"
    held = "*BOUNDARY\nBELOW, 1, 3"
    result = run_deck(two_boxes(lower, upper, [held, press, slide], pair=PAIR, behavior="*FRICTION\n0.3,", model=model))
    for name, share in (("RF1", 0.8), ("RF2", 0.6)):
        found = of_step(result, 2, total(result, name, "ABOVE"))
        np.testing.assert_allclose(found, 0.3 * 20.0 * share, rtol=2e-3)


def test_ring_slides_along_a_shaft(run_deck):
    """A ring with an interference of 0.01 slides over 8 faces of a held shaft: mu times what it presses."""
    shaft, ring = (
        Box("LOWER", "CAX4", (1, 0), (2, 8), (1, 16)),
        Box("UPPER", "CAX4", (1.99, 1.2), (3, 2.2), (2, 2), 1001),
    )
    text = two_boxes(
        shaft,
        ring,
        [
            "*BOUNDARY\nLOWER_LEFT, 1, 2\nLOWER_RIGHT, 1, 2",
            step("1., 1.", "*BOUNDARY\nUPPER_TOP, 2"),
            step(
                "0.1, 1., 1e-6, 0.1",
                "*BOUNDARY\nUPPER_TOP, 2, 2, 4.",
                output="*NODE OUTPUT, NSET=LOWER_RIGHT\nRF",
                options=", INC=100",
            ),
        ],
        pair=PAIR,
        behavior="*FRICTION\n0.2,",
        model="*SURFACE, NAME=OUTSIDE\nLOWER, S2\n*SURFACE, NAME=INSIDE\nUPPER_INNER, S4\n*ELSET, ELSET=UPPER_INNER\n"
        "1001, 1003",
    ).replace("UPPER_LOW, LOWER_HIGH", "INSIDE, OUTSIDE")
    result = run_deck(text)
    pull, pressed = (
        of_step(result, 2, total(result, *what)) for what in (("RF2", "UPPER_TOP"), ("RF1", "LOWER_RIGHT"))
    )
    assert (pressed > 10.0).all()
    np.testing.assert_allclose(pull, 0.2 * pressed, rtol=5e-3)
