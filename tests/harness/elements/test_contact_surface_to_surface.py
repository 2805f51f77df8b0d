# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Contact of surface to surface in finite sliding: derivatives, rotations, bodies that slide, and edges."""

import numpy as np
import pytest
from contact_decks import YOUNG, Box, step, total, two_boxes
from contact_points import SOURCE, Points, rotation_of

from uel.deck.contact.sliding_surfaces import filled, make_pieces
from uel.deck.mesh.smooth_parts import smooth_parts
from uel.model.contact import ContactProperty, SurfacePair

SURFACES = "TYPE=SURFACE TO SURFACE"


def strip(dimension, rng, *, upward, height):
    """Nodes and faces of a curved strip, whose mesh is not regular, with normals up or down."""
    if dimension == 2:
        x = np.array([0.0, 0.9, 2.1, 2.9]) if upward else np.array([0.35, 1.2, 2.6])
        y = height - 0.05 * (x - 1.5) ** 2 + 0.01 * rng.normal(size=len(x))
        nodes = np.stack([x, y, 0 * x], axis=1)
        lines = np.stack([np.arange(1, len(x)), np.arange(len(x) - 1)], axis=1)
        return nodes, [lines if upward else lines[:, ::-1]]
    # the lower one is larger
    axis = np.array([0.0, 0.9, 2.1]) if upward else np.array([0.3, 1.1, 1.8])
    x, y = np.meshgrid(axis, axis, indexing="ij")
    z = height - 0.03 * (x - 1) ** 2 - 0.02 * x * y + 0.01 * rng.normal(size=x.shape)
    nodes = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    n = np.arange(9).reshape(3, 3)
    four = np.stack([n[:-1, :-1], n[1:, :-1], n[1:, 1:], n[:-1, 1:]], axis=-1).reshape(-1, 4)
    faces = [four[1:], np.stack([four[0, :3], four[0, [0, 2, 3]]])]
    return nodes, faces if upward else [part[:, ::-1] for part in faces]


def pair_of(dimension, rng, *, stiffness=None, friction=0.0, overlap=0.1):
    """A strip above another one, with coordinates of all nodes."""
    main, main_faces = strip(dimension, rng, upward=True, height=0.0)
    upper, faces = strip(dimension, rng, upward=False, height=-overlap)
    coordinates = np.concatenate([main, upper])
    faces = [part + len(main) for part in faces]
    parts = smooth_parts(faces, coordinates)
    own = make_pieces(faces, coordinates, 0.0, 0.0, parts.corners)
    pair = SurfacePair(
        name="(A,B)",
        property=ContactProperty("P", SOURCE, stiffness=stiffness, friction=friction),
        source=SOURCE,
        dimension=dimension,
        secondary=parts.nodes,
        faces=parts.corners,
        main=make_pieces(main_faces, coordinates, 0.0, 0.0),
        areas=np.ones(len(parts.nodes)),
        length=10.0,
        own=own,
        corners=filled(parts.corners),
        depths=np.ones(own.nodes.shape),
        deepest=np.full(len(own.nodes), np.inf),
    )
    return pair, coordinates


@pytest.mark.sample(3)
@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("stiffness", [None, 40.0])
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("moved", [0.003, 0.03])
def test_matrix_by_differences(call, dimension, stiffness, friction, moved):
    """Points that stick (moved little) and slip (moved far); without friction the matrix is symmetric."""
    rng = np.random.default_rng(5)
    pair, coordinates = pair_of(dimension, rng, stiffness=stiffness, friction=friction)
    points = Points(call, pair, coordinates, range(1, dimension + 1))
    start = 0.01 * rng.normal(size=points.size)
    start[points.multipliers] = rng.uniform(0.5, 1.0, points.size - points.multipliers.start)
    found = points.check_matrix(start, moved * rng.normal(size=points.size))
    if not friction:
        np.testing.assert_allclose(found, found.T, atol=1e-12 * np.abs(found).max())


def test_a_node_passes_to_another_face_before_its_samples(call):
    """Its slip then depends on nodes that none of its samples touch."""
    rng = np.random.default_rng(5)
    pair, coordinates = pair_of(3, rng, stiffness=40.0, friction=0.3)
    points = Points(call, pair, coordinates, range(1, 4))
    block, upper = points.block, np.unique(pair.secondary)
    # faces of the lower strip meet at x = 0.9; the last nodes of the upper one pass there, samples are 0.09 behind
    start, du = np.zeros((2, *coordinates.shape))
    start[upper, 0], du[upper, 0] = 0.895 - 1.8, 0.01
    still = np.zeros(points.size)
    points.evaluate(points.first, still, still)
    points.evaluate(points.second, start.ravel(), start.ravel())
    block.commit()
    points.evaluate(points.first, start.ravel(), still)
    beyond = np.flatnonzero(coordinates[:, 0] > 2.0)
    assert not np.isin(block.nodes, beyond).any()
    points.evaluate(points.second, (start + du).ravel(), du.ravel())
    last = np.isin(block.secondary, upper[coordinates[upper, 0] > 1.7])
    touches = last & (block.output[1] > 0.0)
    assert touches.any()
    assert np.isin(block.nodes[touches], beyond).any(axis=1).all()


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("dimension", [2, 3])
def test_bodies_that_turn(call, dimension, friction):
    """Both surfaces turn together by 143 degrees: clearances stay, and forces, their sum zero, turn with them."""
    rng = np.random.default_rng(7)
    pair, coordinates = pair_of(dimension, rng, stiffness=40.0, friction=friction)
    points = Points(call, pair, coordinates, range(1, dimension + 1))
    block, places, d = points.block, coordinates[:, :dimension], dimension
    slid = np.zeros_like(places)
    slid[np.unique(pair.secondary)] = 0.02 * rng.normal(size=(len(np.unique(pair.secondary)), d))
    still = np.zeros(points.size)
    points.evaluate(points.first, still, still)
    points.evaluate(points.second, slid.ravel(), slid.ravel())
    block.commit()
    # samples of the slid surfaces
    points.evaluate(points.first, slid.ravel(), still)
    before = points.evaluate(points.second, slid.ravel(), still)[0].reshape(-1, d)
    clearances = block.output[0]
    block.commit()
    assert np.abs(before).max() > 0.5
    turn, steps, last = 0.0, 4, slid
    for _ in range(steps):
        turn += 2.5 / steps
        rotation = rotation_of(turn, d)
        now = (places + slid) @ rotation.T - places
        points.evaluate(points.first, last.ravel(), still)
        forces = points.evaluate(points.second, now.ravel(), (now - last).ravel())[0].reshape(-1, d)
        block.commit()
        last = now
        np.testing.assert_allclose(block.output[0], clearances, atol=1e-11)
    np.testing.assert_allclose(forces, before @ rotation.T, atol=1e-10)
    np.testing.assert_allclose(forces.sum(axis=0), 0.0, atol=1e-11)
    if not friction:
        moments = np.einsum("np,nq->pq", places + last, forces)
        np.testing.assert_allclose(moments, moments.T, atol=1e-10)


# ------------------------------------------------------------ bodies that slide


def test_stress_stays_constant_while_a_body_slides(run_deck):
    """A block, pressed by 0.01 without friction, slides over faces of another size: always -E 0.01 with nu = 0.

    The lower body is as stiff as rigid: all of its nodes are held.
    """
    lower, upper = (
        Box("LOWER", "CPE4", (0, 0), (6, 1), (9, 1)),
        Box("UPPER", "CPE4", (0.3, 1), (2.3, 2), (5, 1), 1001),
    )
    held = "*BOUNDARY\nLOWER_BOTTOM, 1, 2\nLOWER_TOP, 1, 2"
    press = step("1., 1.", "*BOUNDARY\nUPPER_LEFT, 1\nUPPER_TOP, 2, 2, -0.01")
    slide = step("0.1, 1., 1e-6, 0.1", "*BOUNDARY\nUPPER_LEFT, 1, 1, 3.3", options=", INC=50")
    result = run_deck(two_boxes(lower, upper, [held, press, slide], pair=SURFACES, nu=0.0))
    on_top = np.isin(result.mesh().point_data["NODE"], upper.numbers[:, 0])
    for increment in range(1, 11):
        np.testing.assert_allclose(result.field("CPRESS", increment)[on_top], YOUNG * 0.01, rtol=1e-9)


def test_block_slides_over_an_edge(run_deck):
    """Half of a block that is pressed on a body slides off it: the force is that of the part above, and balances.

    All nodes are held, so that a stiffness k gives the pressure k 0.01 over the whole part, 2 - x of the width of 2,
    as far as the region of each node has at least a hundredth of its area above.
    """
    lower, upper = (
        Box("LOWER", "CPE4", (0, 0), (2, 1), (3, 1)),
        Box("UPPER", "CPE4", (0, 1), (2, 2), (4, 1), 1001),
    )
    held = "*BOUNDARY\nLOWER_BOTTOM, 1, 2\nLOWER_TOP, 1, 2\nUPPER_BOTTOM, 2, 2, -0.01\nUPPER_TOP, 2, 2, -0.01"
    slide = step(
        "0.1, 1., 1e-6, 0.1",
        "*BOUNDARY\nUPPER_BOTTOM, 1, 1, 1.3\nUPPER_TOP, 1, 1, 1.3",
        options=", INC=50",
        output="*NODE OUTPUT, NSET=LOWER_TOP\nRF\n*NODE OUTPUT, NSET=UPPER_BOTTOM\nRF",
    )
    text = two_boxes(
        lower,
        upper,
        [slide.replace("*BOUNDARY\n", f"{held}\n", 1)],
        pair=SURFACES,
        nu=0.0,
        behavior="*SURFACE BEHAVIOR, PENALTY\n1e3",
    )
    result = run_deck(text)
    time = result.history["time"][1:]
    wanted = 1e3 * 0.01 * time * 1.5 * (2.0 - 1.3 * time)
    above, below = total(result, "RF2", "UPPER_BOTTOM"), total(result, "RF2", "LOWER_TOP")
    np.testing.assert_allclose(-above[1:], wanted, rtol=1e-9)
    np.testing.assert_allclose(above, -below, rtol=1e-9, atol=1e-12)


def test_corner_of_a_body_in_a_corner_of_another(run_deck):
    """A square in an angle of two walls touches both: each presses as alone, with nu = 0."""
    walls = Box("LOWER", "CPE4", (0, 0), (3, 3), (3, 3))
    block = Box("UPPER", "CPE4", (1, 1), (2, 2), (2, 2), 1001)
    # the walls are the elements below and on the left
    keep = [1, 2, 3, 4, 5, 6, 7, 8, 9]
    keep.remove(5)
    text = two_boxes(
        walls,
        block,
        [
            "*BOUNDARY\nLOWER_BOTTOM, 1, 2\nALL, 1, 2",
            step("1., 1.", "*BOUNDARY\nUPPER_TOP, 2, 2, -0.01\nUPPER_RIGHT, 1, 1, -0.02"),
        ],
        nu=0.0,
        pair=SURFACES,
        model="*NSET, NSET=ALL, GENERATE\n1, 16",
    )
    # cells are counted along y first: the middle one is number 5
    lines = text.replace("5, 6, 10, 11, 7\n", "")
    lines = lines.replace("*SURFACE, NAME=LOWER_HIGH\nLOWER_HIGH, S3", "*SURFACE, NAME=LOWER_HIGH\n2, S2\n4, S3")
    lines = lines.replace(
        "*SURFACE, NAME=UPPER_LOW\nUPPER_LOW, S1", "*SURFACE, NAME=UPPER_LOW\nUPPER_LOW, S1\n1001, S4\n1002, S4"
    )
    (result) = run_deck(lines)
    np.testing.assert_allclose(result.field("S22")[-4:], -YOUNG * 0.01, rtol=1e-9)
    np.testing.assert_allclose(result.field("S11")[-4:], -YOUNG * 0.02, rtol=1e-9)
