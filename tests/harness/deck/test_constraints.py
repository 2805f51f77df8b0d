# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*MPC, *COUPLING, *RIGID BODY and *TIE: runs whose results are known, and what is wrong with them."""

import itertools

import numpy as np
import pytest

from uel.errors import DeckError
from uel.model.properties import SectionControls

# two squares side by side with nodes of their own on the common edge: 2, 3 and 5, 8; stretched along x, nu = 0.3
SQUARES = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
5, 1., 0.
6, 2., 0.
7, 2., 1.
8, 1., 1.
*ELEMENT, TYPE=CPS4, ELSET=LEFT
1, 1, 2, 3, 4
*ELEMENT, TYPE=CPS4, ELSET=RIGHT
2, 5, 6, 7, 8
*SOLID SECTION, ELSET=LEFT, MATERIAL=M
*SOLID SECTION, ELSET=RIGHT, MATERIAL=M
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*NSET, NSET=A, UNSORTED
2, 3
*NSET, NSET=B, UNSORTED
5, 8
*SURFACE, NAME=SA, TYPE=ELEMENT
LEFT, S2
*SURFACE, NAME=SB, TYPE=NODE
B
%s
*BOUNDARY
1, 1, 2
4, 1
*STEP
*STATIC
1., 1.
*BOUNDARY
6, 1, 1, 0.02
7, 1, 1, 0.02
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=ALL
U
*END STEP
"""


@pytest.fixture
def last_displacements(run_deck):
    def last_displacements(text):
        history = run_deck(text).history
        return {name: float(history[name][-1]) for name in history if name.startswith("U")}

    return last_displacements


def at(found, component, node):
    return next(value for name, value in found.items() if name.startswith(f"{component}[") and f"{node}]" in name[-3:])


@pytest.mark.parametrize(
    "constraint",
    [
        "*MPC\nTIE, A, B",
        "*MPC\nPIN, 2, 5\nTIE, 3, 8",
        "*TIE, NAME=T\nSA, SB",
        "*TIE, NAME=T, POSITION TOLERANCE=0.1\nSB, SA",
        "*EQUATION\n2\nA, 1, 1., B, 1, -1.\n2\nA, 2, 1., B, 2, -1.",
    ],
)
def test_two_squares_become_one(last_displacements, constraint):
    """Uniaxial stress: u1 = 0.01 x, u2 = -0.003 y."""
    found = last_displacements(SQUARES % constraint)
    for node, (x, y) in zip(range(1, 9), [(0, 0), (1, 0), (1, 1), (0, 1), (1, 0), (2, 0), (2, 1), (1, 1)], strict=True):
        assert at(found, "U1", node) == pytest.approx(0.01 * x, abs=1e-9)
        assert at(found, "U2", node) == pytest.approx(-0.003 * y, abs=1e-9)


def test_a_node_in_the_middle_of_an_edge(last_displacements):
    """Two small squares against a large one: with LINEAR the node between them keeps to its edge; uniform stress."""
    deck = """*NODE, NSET=ALL
1, 0., 0.
2, 2., 0.
3, 2., 2.
4, 0., 2.
5, 2., 0.5
6, 3., 0.
7, 3., 0.5
8, 3., 2.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
2, 2, 6, 7, 5
3, 5, 7, 8, 3
*SOLID SECTION, ELSET=E, MATERIAL=M
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*MPC
LINEAR, 5, 2, 3
*BOUNDARY
1, 1, 2
4, 1
*STEP
*STATIC
1., 1.
*BOUNDARY
6, 1, 1, 0.03
7, 1, 1, 0.03
8, 1, 1, 0.03
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=ALL
U
*END STEP
"""
    found = last_displacements(deck)
    assert at(found, "U1", 5) == pytest.approx(0.02)
    assert at(found, "U2", 5) == pytest.approx(-0.003 * 0.5)


BEAM = """*NODE, NSET=ALL
1, 0., 0.
2, 2., 0.
3, 2., 1.
4, 0., 1.
5, 1., 0.
6, 2., 0.5
7, 1., 1.
8, 0., 0.5
9, 3., 0.7
*NSET, NSET=END
2, 3, 6
*ELEMENT, TYPE=CPS8R, ELSET=BEAM
1, 1, 2, 3, 4, 5, 6, 7, 8
*SOLID SECTION, ELSET=BEAM, MATERIAL=M
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*SURFACE, NAME=FACE
BEAM, S2
%s
*BOUNDARY
1, 1
4, 1
8, 1, 2
*STEP%s
*STATIC
1., 1.
*CLOAD
9, 6, 1.
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=ALL
U
*END STEP
"""


@pytest.mark.parametrize(
    "constraint",
    [
        "*COUPLING, CONSTRAINT NAME=C, REF NODE=9, SURFACE=FACE\n*KINEMATIC\n1, 6",
        "*COUPLING, CONSTRAINT NAME=C, REF NODE=9, SURFACE=FACE\n*KINEMATIC",
        "*COUPLING, CONSTRAINT NAME=C, REF NODE=9, SURFACE=FACE\n*DISTRIBUTING",
        "*SURFACE, NAME=S, TYPE=NODE\nEND\n*COUPLING, CONSTRAINT NAME=C, REF NODE=9, SURFACE=S\n*DISTRIBUTING",
        "*KINEMATIC COUPLING, REF NODE=9\nEND, 1, 2",
        "*RIGID BODY, REF NODE=9, PIN NSET=END",
        "*MPC\nBEAM, END, 9",
    ],
)
def test_moment_on_an_end_that_stays_plane(last_displacements, constraint):
    """Pure bending: theta = M L/(E I), u1 = -theta (y - 1/2), u2 = theta L/2 at the axis, I = 1/12; the reference node
    turns with the end: u1 = -theta (0.7 - 0.5), u2 = theta (L/2 + 1).
    """
    found = last_displacements(BEAM % (constraint, ""))
    theta = 2.0 / (1000.0 / 12)
    assert at(found, "UR3", 9) == pytest.approx(theta)
    assert at(found, "U1", 3) == pytest.approx(-theta / 2)
    assert at(found, "U2", 6) == pytest.approx(theta)
    assert at(found, "U1", 9) == pytest.approx(-0.2 * theta)
    assert at(found, "U2", 9) == pytest.approx(2 * theta)


def test_a_rigid_cube_turns_about_its_reference_node(last_displacements):
    """u = theta x r in space, for a cube that is rigid as a whole."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1.0]])
    reference, theta = np.array([2.0, -1.0, 0.5]), np.array([1e-3, -2e-3, 3e-3])
    nodes = "".join(f"{k + 1}, {x}, {y}, {z}\n" for k, (x, y, z) in enumerate(corners.tolist()))
    prescribed = "".join(f"9, {dof}, {dof}, {value}\n" for dof, value in zip((4, 5, 6), theta.tolist(), strict=True))
    found = last_displacements(
        f"*NODE, NSET=ALL\n{nodes}9, 2., -1., 0.5\n*ELEMENT, TYPE=C3D8, ELSET=E\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"
        "*SOLID SECTION, ELSET=E, MATERIAL=M\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n"
        "*RIGID BODY, REF NODE=9, ELSET=E\n*BOUNDARY\n9, 1, 3\n*STEP\n*STATIC\n1., 1.\n"
        f"*BOUNDARY\n{prescribed}*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU\n*END STEP\n"
    )
    for k, corner in enumerate(corners):
        expected = np.cross(theta, corner - reference)
        values = [at(found, f"U{i}", k + 1) for i in (1, 2, 3)]
        assert values == pytest.approx(expected.tolist(), abs=1e-12)


@pytest.mark.parametrize(
    "constraint, message",
    [
        (
            "*MPC\nSLIDER, 2, 5",
            r"deck.inp:28: \*MPC: type SLIDER is not supported \(supported: TIE, PIN, LINEAR, BEAM\)",
        ),
        ("*MPC\nTIE, 2", r":28: \*MPC: TIE takes 2 nodes or node sets, found 1"),
        ("*MPC\nTIE, A, ALL", r":28: \*MPC: the node sets have different sizes \(2, 8\)"),
        ("*MPC\nLINEAR, 2, 5, 5", r":28: \*MPC: LINEAR needs two nodes in different places"),
        ("*KINEMATIC", r":27: \*KINEMATIC: does not follow \*COUPLING"),
        (
            "*COUPLING, CONSTRAINT NAME=C, REF NODE=1, SURFACE=SX\n*KINEMATIC",
            r":27: unknown surface SX",
        ),
        ("*RIGID BODY, REF NODE=A, PIN NSET=B", r":27: \*RIGID BODY: REF NODE=A has 2 nodes, expected one"),
        ("*RIGID BODY, REF NODE=1", r":27: \*RIGID BODY: needs ELSET, PIN NSET, TIE NSET or ANALYTICAL SURFACE"),
        ("*KINEMATIC COUPLING, REF NODE=1\nA, 3, 1", r":28: \*KINEMATIC COUPLING: dofs 3 to 1: expected 1 to 6"),
        (
            "*NSET, NSET=C\n1\n*SURFACE, NAME=SC, TYPE=NODE\nC\n*TIE, NAME=T\nSC, SB",
            r"no node of the first surface is within 0\.05 of the second one",
        ),
        ("*SURFACE, NAME=SC\nLEFT, S7\n*TIE, NAME=T\nSC, SB", r":28: \*SURFACE: elements of type CPS4 have no face S7"),
        ("*SURFACE, NAME=SC, TYPE=USER\n*TIE, NAME=T\nSC, SB", "TYPE=USER, which constraints cannot use"),
        ("*DISTRIBUTING", r":27: \*DISTRIBUTING: does not follow \*COUPLING"),
        (
            "*COUPLING, CONSTRAINT NAME=C, REF NODE=1, SURFACE=SA, INFLUENCE RADIUS=0.5\n*DISTRIBUTING",
            r":27: \*COUPLING: couples no node",
        ),
        (
            "*SURFACE, NAME=S, TYPE=NODE\n2\n*COUPLING, CONSTRAINT NAME=C, REF NODE=1, SURFACE=S\n"
            "*DISTRIBUTING, WEIGHTING METHOD=LINEAR",
            r":30: \*DISTRIBUTING: WEIGHTING METHOD=LINEAR gives all nodes the weight 0",
        ),
    ],
)
def test_what_is_wrong_is_named(last_displacements, constraint, message):
    with pytest.raises(DeckError, match=message):
        last_displacements(SQUARES % constraint)


MOVED = "*CLOAD\n9, 6, 1.\n"
FOLLOW = [
    "*COUPLING, CONSTRAINT NAME=C, REF NODE=9, SURFACE=FACE\n*KINEMATIC\n1, 2",
    "*KINEMATIC COUPLING, REF NODE=9\nEND, 1, 2",
    "*RIGID BODY, REF NODE=9, PIN NSET=END",
    "*MPC\nBEAM, END, 9",
]


@pytest.mark.parametrize("constraint", FOLLOW)
def test_a_reference_node_that_does_not_turn_has_large_displacements(last_displacements, constraint):
    """The end of the bar moves as it would if its nodes were prescribed themselves."""
    given = "*BOUNDARY\n%s, 1, 1, 0.9\n%s, 2, 2, 0.4\n"
    found = last_displacements((BEAM % (constraint, ", NLGEOM")).replace(MOVED, given % (9, 9) + "9, 6\n"))
    expected = last_displacements((BEAM % ("", ", NLGEOM")).replace(MOVED, given % ("END", "END")))
    for node, dof in itertools.product(range(1, 9), (1, 2)):
        assert at(found, f"U{dof}", node) == pytest.approx(at(expected, f"U{dof}", node), abs=1e-9)


SECOND = "*STEP, NLGEOM\n*STATIC\n1., 1.\n%s*END STEP\n"


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("9, 6\n", "*BOUNDARY, OP=NEW\n1, 1\n4, 1\n8, 1, 2\n9, 1, 2\n"),
        ("9, 6\n", "*BOUNDARY\n9, 6, 6, 0.1\n"),
        ("9, 6\n", "*BOUNDARY, USER\n9, 6\n"),
        ("9, 1\n", "*BOUNDARY\n9, 6\n"),
        ("9, 6, 6, 0.1\n", ""),
    ],
)
def test_a_rotation_is_held_at_zero_in_each_step(last_displacements, first, second):
    """Where only some displacements follow, whose directions would turn."""
    text = (BEAM % (FOLLOW[0].replace("1, 2", "1, 1"), ", NLGEOM")).replace(
        MOVED, "*BOUNDARY\n" + first
    ) + SECOND % second
    message = r"expected \*BOUNDARY to hold dofs 6 of the reference node 9 at zero in each step"
    with pytest.raises(DeckError, match=r"a constraint with rotations is not supported with NLGEOM .*; " + message):
        last_displacements(text)


@pytest.mark.parametrize(("dofs", "wanted"), [("1, 2", "4, 5, 6"), ("2, 2", "4, 6"), ("3, 3", "4, 5"), ("4, 6", "")])
def test_rotations_that_matter_in_space(last_displacements, dofs, wanted):
    """A rotation about an axis leaves displacements along it as they are."""
    corners = (
        "1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n4, 0., 1., 0.\n5, 0., 0., 1.\n6, 1., 0., 1.\n7, 1., 1., 1.\n"
    )
    text = f"*NODE, NSET=ALL\n{corners}8, 0., 1., 1.\n9, 0.5, 0.5, 2.\n*NSET, NSET=TOP\n5, 6, 7, 8\n"
    text += "*ELEMENT, TYPE=C3D8, ELSET=E\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*SOLID SECTION, ELSET=E, MATERIAL=M\n"
    text += "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n*BOUNDARY\n1, 1, 3\n2, 1, 3\n3, 1, 3\n4, 1, 3\n"
    text += f"*KINEMATIC COUPLING, REF NODE=9\nTOP, {dofs}\n*STEP, NLGEOM\n*STATIC\n1., 1.\n%s*OUTPUT, HISTORY\n"
    text += "*NODE OUTPUT, NSET=ALL\nU\n*END STEP\n"
    if wanted:
        with pytest.raises(DeckError, match=rf"expected \*BOUNDARY to hold dofs {wanted} of the reference node 9"):
            last_displacements(text % "")
        held = "".join(f"9, {dof}\n" for dof in wanted.split(", "))
        found = last_displacements(text % f"*BOUNDARY\n{held}9, {dofs[0]}, {dofs[0]}, 0.2\n")
        assert at(found, f"U{dofs[0]}", 6) == pytest.approx(0.2)
    else:
        last_displacements(text % "")


def test_hourglass_stiffness_of_a_section(read):
    """*HOURGLASS STIFFNESS belongs to the section before it."""
    text = SQUARES % ""
    model = read(text.replace("*MATERIAL", "*HOURGLASS STIFFNESS\n7.5\n*MATERIAL", 1))
    assert [group.section.hourglass for group in model.groups] == [0.0, 7.5]
    with pytest.raises(DeckError, match=r"\*HOURGLASS STIFFNESS: does not follow \*SOLID SECTION"):
        read(text.replace("*SOLID", "*HOURGLASS STIFFNESS\n7.5\n*SOLID", 1))


CONTROLLED = SQUARES.replace("MATERIAL=M", "MATERIAL=M, CONTROLS=C", 1) % ""


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("*SECTION CONTROLS, NAME=C", SectionControls()),
        ("*SECTION CONTROLS, NAME=C, HOURGLASS=STIFFNESS\n2.5, 1., 1.", SectionControls(enhanced=False, hourglass=2.5)),
        # the data line is not read, as in Abaqus
        ("*SECTION CONTROLS, NAME=C, HOURGLASS=ENHANCED\n2.5, 1., 1.", SectionControls(enhanced=True)),
    ],
)
def test_section_controls_of_a_solid_section(read, line, expected):
    model = read(CONTROLLED.replace("*MATERIAL", f"{line}\n*MATERIAL", 1))
    assert [group.section.controls for group in model.groups] == [expected, SectionControls()]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        (
            "*SECTION CONTROLS, NAME=C, HOURGLASS=VISCOUS",
            r"HOURGLASS=VISCOUS is not supported \(supported: STIFF",
        ),
        ("*SECTION CONTROLS, NAME=C, HOURGLASS=COMBINED", r"HOURGLASS=COMBINED is not supported"),
        ("*SECTION CONTROLS, NAME=C, HOURGLASS=RELAX STIFFNESS", r"HOURGLASS=RELAX STIFFNESS is not supported"),
        ("*SECTION CONTROLS, NAME=C\n-1.", r"factor -1 of the hourglass stiffness must be positive"),
        ("*SECTION CONTROLS, NAME=C\n0.", r"factor 0 of the hourglass stiffness must be positive"),
        ("*SECTION CONTROLS, NAME=OTHER", r"unknown section controls C"),
    ],
)
def test_wrong_section_controls_of_a_solid_section(read, line, message):
    with pytest.raises(DeckError, match=r"deck.inp:\d+: .*" + message):
        read(CONTROLLED.replace("*MATERIAL", f"{line}\n*MATERIAL", 1))
