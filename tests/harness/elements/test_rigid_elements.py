# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rigid elements: plates and rollers that press a block, by closed forms and beside analytical rigid surfaces."""

import numpy as np
import pytest
from contact_decks import YOUNG, Box, total

from uel import usersub
from uel.assembly import system_of
from uel.deck import read_deck
from uel.elements import Call, Flags
from uel.errors import DeckError

THICKNESS = 1.5
STRAIN = 1e-3


def tool_of(element_type, nodes, elements, side, reference):
    """Rigid elements of nodes (n, 3) and the surface TOOL on a side of them."""
    lines = ["*NODE", *(f"{70001 + k}, {x!r}, {y!r}, {z!r}" for k, (x, y, z) in enumerate(np.asarray(nodes).tolist()))]
    lines += [f"*NODE, NSET=REF\n90000, {reference}", f"*ELEMENT, TYPE={element_type}, ELSET=TOOL"]
    lines += [", ".join(map(str, [80001 + k, *(70001 + n for n in row)])) for k, row in enumerate(elements)]
    return [*lines, f"*SURFACE, NAME=TOOL\nTOOL, {side}", "*RIGID BODY, REF NODE=REF, ELSET=TOOL"]


def pressed(body, tool, steps, *, pair="", interaction="", held="BODY_BOTTOM, 2\nBODY_LEFT, 1"):
    """A body whose upper side meets a rigid tool."""
    lines = ["*HEADING", "a block under rigid elements", *body.lines(), "*MATERIAL, NAME=M", f"*ELASTIC\n{YOUNG}, 0.3"]
    lines += [*tool, "*SURFACE INTERACTION, NAME=TOUCH", interaction]
    lines += [f"*CONTACT PAIR, INTERACTION=TOUCH{pair}\nBODY_HIGH, TOOL", "*BOUNDARY", held, *steps]
    return "\n".join(line for line in lines if line) + "\n"


def in_body(result, body, name):
    """Field in the elements of the body, which come before the rigid ones."""
    return result.field(name)[: len(body.elements())]


def step_of(procedure, *lines, options=", NLGEOM"):
    output = "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=REF\nU, RF, RM\n*OUTPUT, FIELD"
    return "\n".join([f"*STEP{options}, INC=200\n*STATIC", procedure, *lines, output, "*END STEP"])


def plate(side="SPOS", *, kind="R2D2", backwards=False):
    """Three elements at y = 1 from the right to the left: on the left of this way is the block below them."""
    x = np.array([-0.5, 0.3, 1.7, 3.0])[::-1]
    nodes = np.stack([x, np.ones(4), np.zeros(4)], axis=1)
    elements = np.array([[0, 1], [1, 2], [2, 3]])
    return tool_of(kind, nodes, elements[:, ::-1] if backwards else elements, side, "0., 5.")


DOWN = "*BOUNDARY\nREF, 1\nREF, 6\nREF, 2, 2, {!r}"
PAIRS = ["", ", SMALL SLIDING", ", SMALL SLIDING, TYPE=SURFACE TO SURFACE"]


@pytest.mark.parametrize("pair", PAIRS)
@pytest.mark.parametrize("options", ["", ", NLGEOM"])
def test_plate_on_a_block(run_deck, pair, options):
    """Free to widen: the stress is E times the strain, and the force that on the whole width."""
    body = Box("BODY", "CPS4", (0, 0), (2, 1), (4, 2))
    result = run_deck(pressed(body, plate(), [step_of("1., 1.", DOWN.format(-STRAIN), options=options)], pair=pair))
    # the order of the strain, where it is not small
    near = 2 * STRAIN if options else 1e-9
    np.testing.assert_allclose(in_body(result, body, "S22"), -YOUNG * STRAIN, rtol=near)
    if not options:
        np.testing.assert_allclose(result.field("CPRESS")[body.numbers[:, -1] - 1], YOUNG * STRAIN, rtol=near)
    assert total(result, "RF2", "REF")[-1] == pytest.approx(-YOUNG * STRAIN * 2 * THICKNESS, rel=near)


@pytest.mark.parametrize(("side", "backwards"), [("SNEG", True), ("SNEG", False), ("SPOS", True)])
def test_sides(run_deck, side, backwards):
    """The positive normal is on the left of the way from node 1 to 2; the other side of the plate touches nothing."""
    body = Box("BODY", "CPS4", (0, 0), (2, 1), (4, 2))
    result = run_deck(
        pressed(body, plate(side, backwards=backwards), [step_of("1., 1.", DOWN.format(-STRAIN), options="")])
    )
    touches = side == "SNEG" and backwards
    force = -YOUNG * STRAIN * 2 * THICKNESS if touches else 0.0
    assert total(result, "RF2", "REF")[-1] == pytest.approx(force, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("pair", PAIRS)
def test_plate_on_a_ring(run_deck, pair):
    """About the axis: the stress E strain on the whole circle."""
    body = Box("BODY", "CAX4", (0, 0), (2, 1), (4, 2))
    result = run_deck(
        pressed(body, plate(kind="RAX2"), [step_of("1., 1.", DOWN.format(-STRAIN), options="")], pair=pair)
    )
    np.testing.assert_allclose(in_body(result, body, "S22"), -YOUNG * STRAIN, rtol=1e-9)
    assert total(result, "RF2", "REF")[-1] == pytest.approx(-YOUNG * STRAIN * np.pi * 2**2, rel=1e-9)


@pytest.mark.parametrize("pair", PAIRS)
@pytest.mark.parametrize("kind", ["R3D4", "R3D3"])
def test_plate_on_a_cuboid(run_deck, kind, pair):
    """Uniaxial stress; the plate's nodes are round it clockwise from above, so that SPOS looks down."""
    body = Box("BODY", "C3D8", (0, 0, 0), (2, 1, 1), (3, 2, 2))
    nodes = [[-1, -1, 1], [-1, 2, 1], [3, 2, 1], [3, -1, 1.0]]
    elements = [[0, 1, 2, 3]] if kind == "R3D4" else [[0, 1, 2], [0, 2, 3]]
    push = f"*BOUNDARY\nREF, 1, 2\nREF, 4, 6\nREF, 3, 3, {-STRAIN}"
    held = "BODY_BOTTOM, 3\nBODY_LEFT, 1\nBODY_FRONT, 2"
    tool = tool_of(kind, nodes, elements, "SPOS", "0., 0., 5.")
    result = run_deck(pressed(body, tool, [step_of("1., 1.", push, options="")], pair=pair, held=held))
    # surface to surface is exact in space only where faces match
    near = 1e-2 if "SURFACE" in pair else 1e-9
    np.testing.assert_allclose(in_body(result, body, "S33"), -YOUNG * STRAIN, rtol=near)
    assert total(result, "RF3", "REF")[-1] == pytest.approx(-YOUNG * STRAIN * 2, rel=near)


RADIUS, FRICTION = 2.0, 0.3
ACROSS = np.linspace(0.0, 6.0, 25)


def polygon(count):
    """A roller of as many elements in half a turn, counterclockwise, whose middle is 2 above the block."""
    angles = np.linspace(-np.pi, 0.0, count + 1)
    nodes = np.stack([3.0 + RADIUS * np.cos(angles), RADIUS * np.sin(angles) + 3.0, 0 * angles], axis=1)
    return tool_of("R2D2", nodes, [[k, k + 1] for k in range(count)], "SNEG", "3., 3.")


def test_roller(run_deck):
    """Pressed down and turned, it slips with a moment mu R times the normal forces, as an analytical surface does.

    The corners of a polygon stand out of the chord by 4e-6 of the radius.
    """
    press = step_of("0.5, 1.", "*BOUNDARY\nREF, 1\nREF, 6\nREF, 2, 2, -0.04")
    turn = step_of("0.1, 1., 1e-5, 0.1", "*BOUNDARY\nREF, 6, 6, -0.8")
    body = Box("BODY", "CPE4", (0, 0), (6, 1), (24, 4))
    circle = ["*NODE, NSET=REF\n90000, 3., 3.", "*SURFACE, NAME=TOOL, TYPE=SEGMENTS", "START, 5., 3."]
    circle += ["CIRCL, 3., 1., 3., 3.", "CIRCL, 1., 3., 3., 3.", "*RIGID BODY, ANALYTICAL SURFACE=TOOL, REF NODE=REF"]
    found = []
    for tool in (polygon(512), circle):
        text = pressed(
            body,
            tool,
            [press, turn],
            interaction=f"*FRICTION\n{FRICTION},",
            held="BODY_BOTTOM, 1, 2\nBODY_RIGHT, 1",
        )
        result = run_deck(text)
        moment, pull, push = (total(result, name, "REF")[-1] for name in ("RM3", "RF1", "RF2"))
        pressure = result.field("CPRESS")[body.numbers[:, -1] - 1]
        normal = (pressure * np.gradient(ACROSS) * THICKNESS).sum()
        assert normal > 10.0
        assert moment == pytest.approx(-FRICTION * RADIUS * normal, rel=1e-2)
        found.append([moment, pull, push])
    assert found[0] == pytest.approx(found[1], rel=1e-2)


def test_no_forces_in_averages(tmp_path):
    """The average force is that of the other elements, without entries of zero."""
    body = Box("BODY", "CPS4", (0, 0), (2, 1), (4, 2))
    text = pressed(body, plate(), [step_of("1., 1.", DOWN.format(-STRAIN))])
    (tmp_path / "deck.inp").write_text(text)
    model = read_deck(tmp_path / "deck.inp")
    system = system_of(model, usersub.load(None, job="deck", output_dir=tmp_path))
    call = Call(Flags(1), step=1, increment=1, step_time=1.0, total_time=1.0, time_increment=1.0, period=1.0)
    u = 1e-3 * np.random.default_rng(1).standard_normal(len(system))
    found = system.evaluate(call, u, u)
    assert found.entries.tolist()[0] == found.flux_count.tolist()[0] == 8 * 4 * 2


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("BODY_HIGH, TOOL", "TOOL, BODY_HIGH", r"surface TOOL is rigid \(R2D2\); expected it as the main surface"),
        (", ELSET=TOOL\n*SURF", ", PIN NSET=REF\n*SURF", r"have no section: no \*RIGID BODY refers to it"),
        ("80001, 70001, 70002", "80001, 70001, 70002, 70003", "element 80001 has 3 nodes, but R2D2 needs 2"),
        ("*BOUNDARY\nREF, 1\n", "*DLOAD\nTOOL, P1, 1.\n*BOUNDARY\nREF, 1\n", r"load type P1 on elements of type R2D2"),
        ("TOOL, SPOS", "TOOL, S1", r"elements of type R2D2 have no face S1 \(faces: SNEG, SPOS\)"),
    ],
)
def test_what_is_refused(run_deck, old, new, message):
    body = Box("BODY", "CPS4", (0, 0), (2, 1), (4, 2))
    text = pressed(body, plate(), [step_of("1., 1.", DOWN.format(-STRAIN))])
    assert old in text
    with pytest.raises(DeckError, match=rf"deck\.inp:\d+: .*{message}"):
        run_deck(text.replace(old, new))
