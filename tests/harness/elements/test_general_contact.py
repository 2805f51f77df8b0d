# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""General contact: bodies that touch without being told where, by closed forms."""

import numpy as np
import pytest
from contact_decks import YOUNG, Box, plane, step, total, two_boxes

THICKNESS = 1.5
HELD = "*BOUNDARY\nLOWER_BOTTOM, 2\nLOWER_LEFT, 1\nUPPER_LEFT, 1"
PAIR = "*CONTACT PAIR, INTERACTION=TOUCH, SMALL SLIDING\nUPPER_LOW, LOWER_HIGH"
GENERAL = "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*CONTACT PROPERTY ASSIGNMENT\n , , TOUCH"
NAMED = "*CONTACT\n*CONTACT INCLUSIONS\nUPPER_LOW, LOWER_HIGH\n*CONTACT PROPERTY ASSIGNMENT\n , , TOUCH"


def touching(*args, general=GENERAL, **kwargs):
    """A deck of two boxes with general contact in place of a pair."""
    return two_boxes(*args, **kwargs).replace(PAIR, general)


def pressed(by):
    return step("1., 1.", f"*BOUNDARY\nUPPER_TOP, 2, 2, -{by}")


@pytest.mark.parametrize("general", [GENERAL, NAMED], ids=["exterior", "named"])
@pytest.mark.parametrize("lower", [2, 3, 5])
def test_patch_test(run_deck, general, lower):
    """Uniaxial stress in plane strain, E strain / (1 - nu^2), on meshes that do not match."""
    result = run_deck(touching(*plane(lower=lower, upper=3), [HELD, pressed(0.02)], general=general))
    stress = -YOUNG * 0.01 / (1 - 0.3**2)
    np.testing.assert_allclose(result.field("S22"), stress, rtol=1e-10)
    np.testing.assert_allclose(result.field("S11"), 0.0, atol=1e-10 * abs(stress))
    assert "hard contact is enforced exactly" in result.file(".dat").read_text()


@pytest.mark.parametrize(("along", "error"), [(2, 1e-10), (3, 0.01)])
def test_patch_of_bricks(run_deck, along, error):
    """On matching meshes, and on others as well as the samples of a face integrate."""
    lower = Box("LOWER", "C3D8", (0, 0, 0), (2, 3, 1), (along, 3, 1))
    upper = Box("UPPER", "C3D8", (0, 0, 1), (2, 3, 3), (2, 3, 2), first=1001)
    held = "*BOUNDARY\nLOWER_BOTTOM, 3\nLOWER_LEFT, 1\nUPPER_LEFT, 1\nLOWER_FRONT, 2\nUPPER_FRONT, 2"
    result = run_deck(touching(lower, upper, [held, step("1., 1.", "*BOUNDARY\nUPPER_TOP, 3, 3, -0.03")]))
    np.testing.assert_allclose(result.field("S33"), -YOUNG * 0.01, rtol=error)
    assert total(result, "RF3", "UPPER_TOP")[-1] == pytest.approx(-YOUNG * 0.01 * 6, rel=error)


def test_three_bodies_in_a_row(run_deck):
    """Columns of height 1 with nu = 0 and a gap of 0.01 above the second one: E (0.05 - 0.01) / 3."""
    boxes = plane(lower=2, upper=3)
    third = Box("THIRD", "CPE4", (0, 2.01), (2, 3.01), (2, 1), first=2001)
    press = step("0.5, 1.", "*BOUNDARY\nTHIRD_TOP, 2, 2, -0.05\nTHIRD_LEFT, 1")
    result = run_deck(
        touching(*boxes, [HELD, press], nu=0.0).replace("*MATERIAL", "\n".join([*third.lines(), "*MATERIAL"]))
    )
    np.testing.assert_allclose(result.field("S22"), -YOUNG * 0.04 / 3, rtol=1e-9)


def test_property_of_some_surfaces(run_deck):
    """The last line counts: a stiffness k in series with two columns of height 1, p (2/E + 1/k) = 0.02."""
    assigned = f"{NAMED}\nUPPER_LOW, LOWER_HIGH, SOFT"
    soft = "*SURFACE INTERACTION, NAME=SOFT\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n2000."
    text = touching(*plane(), [HELD, pressed(0.02)], nu=0.0, general=f"{soft}\n{assigned}")
    pressure = 0.02 / (2 / YOUNG + 1 / 2000.0)
    result = run_deck(text)
    assert total(result, "RF2", "UPPER_TOP")[-1] == pytest.approx(-pressure * 2 * THICKNESS, rel=1e-9)
    assert "hard contact is enforced exactly" not in result.file(".dat").read_text()


def test_overlap_at_the_start(run_deck):
    """One of 0.01 is closed without strain; one that is deeper than SEARCH BELOW=0.005 is pressed apart: E h / 2.

    A gap of 0.01 is closed by SEARCH ABOVE=0.02.
    """
    steps = [HELD, step("0.25, 1.", "*BOUNDARY\nUPPER_TOP, 2")]
    data = "*CONTACT INITIALIZATION DATA, NAME=START, SEARCH {} \n{}\n*CONTACT INITIALIZATION ASSIGNMENT\n , , START"
    assert np.abs(total(run_deck(touching(*plane(gap=-0.01), steps, nu=0.0)), "RF2", "UPPER_TOP")).max() < 1e-12
    kept = touching(*plane(gap=-0.01), steps, nu=0.0, general=data.format("BELOW=0.005", GENERAL))
    found = total(run_deck(kept), "RF2", "UPPER_TOP")
    np.testing.assert_allclose(found[1:], -YOUNG * 0.01 / 2 * 2 * THICKNESS, rtol=1e-9)
    closed = touching(*plane(gap=0.01), [HELD, pressed(0.02)], general=data.format("ABOVE=0.02", GENERAL), nu=0.0)
    # the upper body is 1.01 high
    pressure = 0.02 / (2.01 / YOUNG)
    assert total(run_deck(closed), "RF2", "UPPER_TOP")[-1] == pytest.approx(-pressure * 2 * THICKNESS, rel=1e-9)


def test_block_slides_over_an_edge(run_deck):
    """A block that is wider than the body below touches it on its upper side alone, over 1.5 - 0.5 t.

    The first increment, which nothing is extrapolated to, has the samples of the start: the others are exact.
    """
    lower, upper = (
        Box("LOWER", "CPE4", (0, 0), (2, 1), (3, 1)),
        Box("UPPER", "CPE4", (0.5, 1), (3, 2), (4, 1), first=1001),
    )
    slide = step(
        "0.25, 1.",
        "*BOUNDARY\nLOWER_ALL, 1, 2\nUPPER_ALL, 2, 2, -0.01\nUPPER_ALL, 1, 1, 0.5",
        output="*NODE OUTPUT, NSET=LOWER_TOP\nRF",
    )
    model = "*NSET, NSET=LOWER_ALL, GENERATE\n1, 8\n*NSET, NSET=UPPER_ALL, GENERATE\n1001, 1010"
    behavior = "*SURFACE BEHAVIOR, PENALTY\n1e3"
    result = run_deck(touching(lower, upper, [slide], behavior=behavior, model=model))
    time = result.history["time"][1:]
    force = total(result, "RF2", "LOWER_TOP")[1:]
    np.testing.assert_allclose(force, 1e3 * 0.01 * time * THICKNESS * (1.5 - 0.5 * time), rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(total(result, "RF1", "LOWER_TOP"), 0.0, atol=1e-12)


@pytest.mark.parametrize("nlgeom", ["", ", NLGEOM"])
def test_block_slides_with_friction(run_deck, nlgeom):
    """Under a load N over ten faces: mu N against the motion."""
    lower, upper = (
        Box("LOWER", "CPE4", (0, 0), (6, 1), (12, 1)),
        Box("UPPER", "CPE4", (0.3, 1), (1.3, 2), (3, 1), 1001),
    )
    loads = "*CLOAD\n" + "\n".join(f"{number}, 2, -10." for number in upper.numbers[:, -1])
    press = step("1., 1.", loads, "*BOUNDARY\nUPPER_LEFT, 1", options=nlgeom)
    output = "*NODE OUTPUT, NSET=UPPER_LEFT\nRF1"
    slide = step("0.05, 1., 1e-6, 0.05", "*BOUNDARY\nUPPER_LEFT, 1, 1, 4.5", options=", INC=100", output=output)
    held = "*BOUNDARY\nLOWER_BOTTOM, 1, 2\nLOWER_TOP, 1, 2"
    result = run_deck(touching(lower, upper, [held, press, slide], behavior="*FRICTION\n0.3,"))
    found = total(result, "RF1", "UPPER_LEFT")[result.history["step"] == 2]
    np.testing.assert_allclose(found, 0.3 * 40.0, rtol=2e-3)


def test_rigid_elements_are_main(run_deck):
    """A block on a rigid line (R2D2), which is main: the force on the reference node is that on the block."""
    upper = Box("UPPER", "CPE4", (0, 0), (2, 1), (3, 1), first=1001)
    lower = Box("LOWER", "CPE4", (0, -6), (2, -5), (1, 1))
    rigid = "*NODE, NSET=REF\n2001, 1., -1.\n*NODE\n2002, -1., 0.\n2003, 3., 0.\n*ELEMENT, TYPE=R2D2, ELSET=LINE\n"
    rigid += "2001, 2002, 2003\n*RIGID BODY, ELSET=LINE, REF NODE=2001"
    press = step(
        "1., 1.",
        "*BOUNDARY\nREF, 1, 2\nREF, 6\nLOWER_ALL, 1, 2\nUPPER_TOP, 2, 2, -0.01\nUPPER_LEFT, 1",
        output="*NODE OUTPUT, NSET=REF\nRF",
    )
    model = f"{rigid}\n*NSET, NSET=LOWER_ALL, GENERATE\n1, 4"
    result = run_deck(touching(lower, upper, [press], nu=0.0, model=model))
    assert total(result, "RF2", "REF")[-1] == pytest.approx(YOUNG * 0.01 * 2 * THICKNESS, rel=1e-9)


def test_thin_plates_touch_where_they_face(run_deck):
    """Three plates, of elements ten times as long as high, in a stack: each touches the next one, and none through it.

    The middle one is wider, so that sides of the plates are not level.
    """
    lower, middle, upper = (
        Box("LOWER", "CPE4", (0, 0), (4, 0.1), (4, 1)),
        Box("UPPER", "CPE4", (-0.35, 0.1), (4.2, 0.2), (5, 1), first=1001),
        Box("THIRD", "CPE4", (0, 0.2), (4, 0.3), (3, 1), first=2001),
    )
    steps = [
        "*BOUNDARY\nLOWER_BOTTOM, 1, 2\nLOWER_TOP, 1\nUPPER_TOP, 1\nUPPER_BOTTOM, 1\nTHIRD_BOTTOM, 1",
        step("0.5, 1.", "*BOUNDARY\nTHIRD_TOP, 1\nTHIRD_TOP, 2, 2, -0.003"),
    ]
    for behavior in ("", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e6"):
        text = touching(lower, middle, steps, nu=0.0, behavior=behavior)
        result = run_deck(text.replace("*MATERIAL", "\n".join([*upper.lines(), "*MATERIAL"]), 1))
        stiffness = 1e6 if behavior else np.inf
        pressure = 0.003 / (0.3 / YOUNG + 2 / stiffness)
        force = total(result, "RF2", "LOWER_BOTTOM")[-1]
        # the ends of the middle plate bend the stress there
        assert force == pytest.approx(4 * THICKNESS * pressure, rel=0.05)
        opened = result.field("COPEN")
        assert np.nanmin(opened) > -1e-3
