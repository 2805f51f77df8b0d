# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Jobs where a displacement of a node that follows a reference node is prescribed, or a rotation has no effect."""

import numpy as np
import pytest
from bent_beams import COUPLING, LENGTH, YOUNG, beam, last, step

import uel
from uel.errors import DeckError

ANGLE = 0.7


def rigid(*loads, increments=6):
    """The start of a beam, 0.5 high, follows node 900, which is held at (-3, 4); the rest goes with it."""
    coupled = COUPLING.replace("END\n*COUPLING", "START\n*COUPLING")
    lines = beam("CPS8R", reference=(-3.0, 4.0), constraint=coupled, held="")
    return [*lines, *step("*BOUNDARY", "900, 1, 2", *loads, increments=increments)]


def displacement(x, angle):
    """That of a place that turns about node 900."""
    arm = np.array(x) - [-3.0, 4.0]
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * arm[0] - s * arm[1], s * arm[0] + c * arm[1]]) - arm


def test_a_displacement_that_drives_a_rotation(run_deck):
    """Node 1 at the origin goes to where a turn by 40 degrees brings it along 1; all else turns too, without stress."""
    moved = displacement((0.0, 0.0), ANGLE)
    result = run_deck(rigid(f"1, 1, 1, {float(moved[0])!r}"))
    assert last(result, "UR3") == pytest.approx(ANGLE, abs=1e-9)
    np.testing.assert_allclose(result.field("U")[0, :2], moved, atol=1e-9)
    np.testing.assert_allclose(result.field("S11"), 0, atol=1e-7 * YOUNG)
    assert "OVERCONSTRAINT" not in result.file(".msg").read_text()


def test_a_displacement_that_is_consistent(run_deck):
    """Node and reference node are both driven, to the end of the same turn: Abaqus warns and goes on."""
    moved = displacement((0.0, 0.0), 0.1)
    given = f"1, 1, 1, {moved[0]:.7g}", "900, 6, 6, 0.1"
    result = run_deck(rigid(*given, increments=1))
    np.testing.assert_allclose(result.field("U")[0, :2], moved, atol=1e-5)
    assert "OVERCONSTRAINT: NODE 1, DOF 1 IS PRESCRIBED, AND THE CONSTRAINT AT" in " ".join(
        result.file(".msg").read_text().split()
    )


def test_a_displacement_that_contradicts(run_deck):
    """Half way the cosine of a linear angle is not half of that at the end."""
    moved = displacement((0.0, 0.0), ANGLE)
    message = r"deck\.inp:\d+: over-constrained: node 1, dof 1 is prescribed at .*inp:\d+, .* \(step 1, increment 1\)"
    with pytest.raises(DeckError, match=message):
        run_deck(rigid(f"1, 1, 1, {float(moved[0])!r}", f"900, 6, 6, {ANGLE!r}"))


def test_a_displacement_out_of_reach(run_deck):
    """Node 1 is 5 from node 900: it cannot go to the right by 9."""
    with pytest.raises(uel.errors.UelError, match="no position of it gives the prescribed displacements"):
        run_deck(rigid("1, 1, 1, 9.", increments=1))


@pytest.mark.parametrize("loads", [("*BOUNDARY", "900, 2, 2, 4."), ("*CLOAD", "900, 2, 0.5")], ids=["driven", "loaded"])
def test_a_plane_of_symmetry(run_deck, loads):
    """A beam in space bends in a plane: nodes of its end are held across it, or the reference node is."""
    reference, held = [LENGTH, 0.25, 0.25], ["*BOUNDARY", "900, 3, 3", "900, 4, 5"]
    lines = beam("C3D8I", reference=reference, held="START, 1, 3")
    expected = run_deck([*lines, *step(*held, *loads)], name="reference")
    found = run_deck([*lines, *step("*BOUNDARY", "END, 3, 3", *loads)])
    # bending to some degrees changes nothing for the sides of this beam: its Poisson number is zero
    np.testing.assert_allclose(found.field("U"), expected.field("U"), atol=1e-7 * LENGTH)
    assert last(found, "RF2") == pytest.approx(last(expected, "RF2"), rel=1e-7, abs=1e-9)
    assert "OVERCONSTRAINT" in found.file(".msg").read_text()


def line_of_nodes(*loads, **options):
    """The two lower nodes of the end of a beam in space follow a node between them."""
    constraint = "*NSET, NSET=EDGE\n{}, {}\n" + COUPLING.replace("NSET\nEND", "NSET\nEDGE").replace(
        "TYPE=NODE\nEND", "TYPE=NODE\nEDGE"
    )
    lines = beam("C3D8I", reference=[LENGTH, 0.0, 0.25], held="START, 1, 3")
    start = lines.index("*NSET, NSET=END") + 1
    bottom = [int(node) for node in lines[start : start + 4]][::2]
    lines = beam("C3D8I", reference=[LENGTH, 0.0, 0.25], held="START, 1, 3", constraint=constraint.format(*bottom))
    return [*lines, *step(*loads, **options)], bottom


def test_a_rotation_without_effect(run_deck):
    """It stays zero, and the edge has the force as if it were on its nodes.

    Abaqus gets zero pivots there, and arbitrary rotations.
    """
    lines, bottom = line_of_nodes("*CLOAD", "900, 2, -0.2")
    found = run_deck(lines)
    assert found.completed
    assert last(found, "UR3") == 0.0
    halves = [f"{node}, 2, -0.1" for node in bottom]
    without = beam("C3D8I", reference=[LENGTH, 0.0, 0.25], held="START, 1, 3", constraint="")
    expected = run_deck([*without, *step("*CLOAD", *halves)], name="halves")
    # nodes of the edge move alike, for there is no load across the plane
    np.testing.assert_allclose(found.field("U")[:-1], expected.field("U")[:-1], atol=1e-8 * LENGTH)


def test_a_moment_without_effect(run_deck):
    lines, _ = line_of_nodes("*CLOAD", "900, 6, 0.1")
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: a moment acts on reference node 900 about the line on which"):
        run_deck(lines)
