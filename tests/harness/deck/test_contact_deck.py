# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*CONTACT PAIR, *SURFACE INTERACTION, *SURFACE BEHAVIOR, *FRICTION: what is read, what is refused, anchor points."""

import numpy as np
import pytest

from uel.deck.contact.anchor_points import find_anchors
from uel.deck.contact.sliding_surfaces import make_pieces
from uel.errors import DeckError
from uel.model.contact import SlidingPair

DECK = """\
*HEADING
*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
11, 0., 1.1
12, 1., 1.1
13, 1., 2.
14, 0., 2.
21, 5., 5.
*ELEMENT, TYPE=CPE4, ELSET=LOW
1, 1, 2, 3, 4
*ELEMENT, TYPE=CPE4, ELSET=UP
2, 11, 12, 13, 14
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*SOLID SECTION, ELSET=LOW, MATERIAL=M
2.
*SOLID SECTION, ELSET=UP, MATERIAL=M
2.
*SURFACE, NAME=MAIN
LOW, S3
*SURFACE, NAME=SEC
UP, S1
*SURFACE, NAME=POINTS, TYPE=NODE
11, 0.5
12,
*SURFACE INTERACTION, NAME=TOUCH
1.,
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD
*FRICTION
0.3,
*CONTACT PAIR, INTERACTION=TOUCH, SMALL SLIDING
SEC, MAIN
*STEP
*STATIC
*BOUNDARY
1, 1, 2
*END STEP
"""
PAIR = "*CONTACT PAIR, INTERACTION=TOUCH, SMALL SLIDING\nSEC, MAIN\n"


def test_pair(read):
    (pair,) = read(DECK).contacts
    assert pair.name == "(SEC,MAIN)"
    assert pair.dimension == 2
    assert pair.property.stiffness is None
    assert pair.property.friction == 0.3
    np.testing.assert_array_equal(pair.nodes[:, 0], [4, 5])
    np.testing.assert_allclose(pair.clearances, 0.1)
    np.testing.assert_allclose(pair.normals, [[0, 1, 0]] * 2, atol=1e-15)
    np.testing.assert_allclose(pair.areas, 2.0 / 2)
    # the shares make the anchor points, which are opposite the nodes
    for row, shares, x in zip(pair.nodes, pair.shares, (0.0, 1.0), strict=True):
        places = read(DECK).mesh.coordinates[row[1:]]
        np.testing.assert_allclose(-shares[1:] @ places, [x, 1, 0], atol=1e-15)
    assert pair.length == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("friction", "tolerance", "slip"),
    [("", 0.005, 0.0), (", SLIP TOL=0.1", 0.1, 0.0), (", ELASTIC SLIP=0.02", 0.005, 0.02)],
)
def test_elastic_slip(read, friction, tolerance, slip):
    (pair,) = read(DECK.replace("*FRICTION\n", f"*FRICTION{friction}\n")).contacts
    assert (pair.property.slip_tolerance, pair.property.elastic_slip) == (tolerance, slip)


@pytest.mark.parametrize(
    ("behavior", "stiffness", "clearance"),
    [
        ("*SURFACE BEHAVIOR", None, 0.0),
        ("*SURFACE BEHAVIOR, DIRECT", None, 0.0),
        ("*SURFACE BEHAVIOR, PENALTY\n100.", 100.0, 0.0),
        ("*SURFACE BEHAVIOR, PENALTY=LINEAR\n100., 0.01, 0.5", 50.0, 0.01),
        ("*SURFACE BEHAVIOR, PENALTY=NONLINEAR\n100., 0.01, 0.5", 50.0, 0.01),
        ("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n70.", 70.0, 0.0),
    ],
)
def test_behavior(read, behavior, stiffness, clearance):
    (pair,) = read(DECK.replace("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD", behavior)).contacts
    assert pair.property.stiffness == stiffness
    assert pair.property.clearance == clearance
    assert pair.property.initial == (0.01 if "NONLINEAR" in behavior else 1.0)


@pytest.mark.parametrize("kind", ["", "=NONLINEAR"])
def test_penalty_without_a_stiffness_is_exact_with_a_warning(read, kind):
    model = read(DECK.replace("PRESSURE-OVERCLOSURE=HARD", f"PENALTY{kind}"))
    assert model.contacts[0].property.stiffness is None
    assert any("deck.inp:32: *SURFACE BEHAVIOR: PENALTY without a stiffness is enforced" in w for w in model.warnings)


def test_surface_of_nodes(read):
    """Areas are given, 1 unless they are; the elastic slip is that of the faces of the main surface."""
    (pair,) = read(DECK.replace("SEC, MAIN", "POINTS, MAIN")).contacts
    np.testing.assert_allclose(pair.areas, [0.5, 1.0])
    assert pair.length == pytest.approx(1.0)


def test_nodes_without_elements(read):
    text = DECK.replace("12,\n*SURFACE INT", "21,\n*SURFACE INT").replace("SEC, MAIN", "POINTS, MAIN")
    with pytest.raises(DeckError, match=r"deck\.inp:36: .*node 21 of surface POINTS belongs to no element with displ"):
        read(text)


def test_faces_without_area(read):
    text = DECK.replace("3, 1., 1.", "3, 0., 1.")
    with pytest.raises(DeckError, match=r"deck\.inp:24: .*the face of element 1 in surface MAIN has no area"):
        read(text)


BRICKS = """\
*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 1., 1., 1.
11, 1., 1., 1.1
12, 1., 1., 3.
*ELEMENT, TYPE=C3D8, ELSET=LOW
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=T3D2, ELSET=BAR
2, 11, 12
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*SOLID SECTION, ELSET=LOW, MATERIAL=M
*SOLID SECTION, ELSET=BAR, MATERIAL=M
1.
*SURFACE, NAME=MAIN
LOW, S2
*SURFACE, NAME=POINTS, TYPE=NODE
11,
*SURFACE INTERACTION, NAME=TOUCH
*CONTACT PAIR, INTERACTION=TOUCH, SMALL SLIDING
POINTS, MAIN
*STEP
*STATIC
*END STEP
"""


def test_faces_with_coincident_corners(read):
    """A node above the corner of a quadrilateral where two of its nodes are in the same place."""
    with pytest.raises(DeckError, match=r"deck\.inp:28: .*no tangent plane for node 11; faces with coincident corners"):
        read(BRICKS)
    with pytest.raises(DeckError, match=r"deck\.inp:28: .*no tangent plane at node 7; faces with coincident corners"):
        read(BRICKS.replace(", SMALL SLIDING", ""))


def test_area_of_a_node(read):
    with pytest.raises(DeckError, match=r"deck\.inp:28: \*SURFACE: area -0.5 must be positive"):
        read(DECK.replace("11, 0.5", "11, -0.5").replace("SEC, MAIN", "POINTS, MAIN"))


def test_nodes_beside_the_main_surface_are_left_out_with_a_warning(read):
    model = read(DECK.replace("12, 1., 1.1", "12, 1.5, 1.1"))
    np.testing.assert_array_equal(model.contacts[0].nodes[:, 0], [4])
    assert any("node 12 of SEC will not touch MAIN: no normal of MAIN goes through it" in w for w in model.warnings)


def test_interactions_that_no_pair_uses_are_listed(read):
    other = "*SURFACE INTERACTION, NAME=OTHER\n*SURFACE BEHAVIOR, NO SEPARATION\n*CONTACT DAMPING\n0.1\n"
    model = read(DECK.replace(PAIR, other + PAIR))
    assert [name for name, _ in model.ignored] == ["SURFACE INTERACTION", "SURFACE BEHAVIOR", "CONTACT DAMPING"]


def test_damage_of_a_material_and_of_a_property(read):
    """Each belongs to the keyword before it."""
    damage = "*DAMAGE INITIATION, CRITERION=QUADS\n{0}., {0}.\n*DAMAGE EVOLUTION, TYPE=DISPLACEMENT\n{0}.\n"
    other = f"*MATERIAL, NAME=OTHER\n*ELASTIC, TYPE=TRACTION\n1., 1.\n{damage.format(3)}"
    bond = f"*COHESIVE BEHAVIOR\n5., 6.\n{damage.format(4)}*DAMAGE STABILIZATION\n0.1\n"
    (pair,) = read(DECK.replace("*SOLID", f"{other}*SOLID", 1).replace("*FRICTION\n0.3,\n", bond)).contacts
    cohesion = pair.property.cohesion
    assert cohesion.stiffness == (5.0, 6.0)
    assert (cohesion.damage.criterion, cohesion.damage.onset, cohesion.damage.viscosity) == (
        "QUADS",
        (4.0, 4.0, 0.0),
        0.1,
    )
    assert cohesion.damage.evolution.values == (4.0,)


def test_convert_sdi_goes_on(read):
    step = "*STEP\n*STATIC\n*END STEP\n"
    text = DECK + step + step.replace("*STEP", "*STEP, CONVERT SDI=NO", 1) + step
    assert [entry.convert_sdi for entry in read(text).steps] == [True, True, False, False]


@pytest.mark.parametrize(
    "mistake",
    [
        (", SMALL SLIDING", ", SMOOTH=0.5", "35: SMOOTH=0.5 must be at least 0 and less than 0.5"),
        (", SMALL SLIDING", ", EXTENSION ZONE=0.3", "35: EXTENSION ZONE=0.3 must be from 0 to 0.2"),
        (", SMALL SLIDING", ", SMALL SLIDING, TIED", "35: .*option TIED is not supported"),
        ("SEC, MAIN", "SEC", "36: expected the secondary and the main surface; contact with itself is not supported"),
        ("SEC, MAIN", "SEC, MAIN, M", "36: 3 entries, expected at most 2"),
        ("SEC, MAIN", "SEC, MAINE", "36: unknown surface MAINE; did you mean MAIN"),
        ("SEC, MAIN", "MAIN, POINTS", "36: the main surface POINTS is made of nodes; expected faces of elements"),
        ("SEC, MAIN", "MAIN, MAIN", "36: node 3 is on both surfaces, MAIN and MAIN"),
        ("LOW, S3", "LOW, S1", "36: no node of SEC faces MAIN: normals of MAIN go through none of them"),
        ("LOW, S3", "", "36: surface MAIN has no faces"),
        ("INTERACTION=TOUCH, S", "INTERACTION=TOUCHY, S", "35: unknown surface interaction TOUCHY; did you mean TOUCH"),
        ("SLIDING\n", "SLIDING, ADJUST=-1.\n", "35: ADJUST=-1 must not be negative"),
        ("SLIDING\n", "SLIDING, ADJUST=NOSET\n", "35: .*NOSET"),
        ("=HARD", "=TABULAR", "32: PRESSURE-OVERCLOSURE=TABULAR is not supported .supported: HARD, LINEAR"),
        ("=HARD", "=HARD, NO SEPARATION", "32: option NO SEPARATION is not supported"),
        ("=HARD", "=HARD, AUGMENTED LAGRANGE", "32: option AUGMENTED LAGRANGE is not supported"),
        ("=HARD", "=HARD, PENALTY\n, 0.1", "32: expected the stiffness, .*that of Abaqus depends on the elements"),
        (
            "=HARD",
            "=HARD, PENALTY=NONLINEAR\n1., 0., 1., 0.1",
            "33: other ratios of PENALTY=NONLINEAR than the default",
        ),
        ("=HARD", "=LINEAR", "32: expected the stiffness, pressure per overclosure, on the data line$"),
        ("=HARD", "=LINEAR, DIRECT\n1.", "32: DIRECT and a stiffness exclude each other"),
        ("=HARD", "=LINEAR\n-1.", "33: stiffness -1 must be positive"),
        ("=HARD", "=LINEAR\n1., 2.", "33: 2 entries, expected at most 1"),
        ("=HARD", "=HARD, PENALTY\n1., 0., 0.", "33: scale factor 0 must be positive"),
        ("=HARD", "=HARD, PENALTY\n1., -1.", "33: clearance at zero pressure -1 must not be negative"),
        ("0.3,\n*C", "-0.3,\n*C", "34: friction coefficient -0.3 must not be negative"),
        ("0.3,\n*C", "0.3, 1.\n*C", "34: a coefficient that depends on slip rate, pressure or fields is not supported"),
        ("*FRICTION\n0.3,\n", "*FRICTION\n", "33: expected the friction coefficient on the data line"),
        (
            "SMALL SLIDING",
            "GEOMETRIC CORRECTION=ROUND",
            "35: GEOMETRIC CORRECTION is supported between surfaces in fini",
        ),
        ("SMALL SLIDING", "TYPE=SURF, GEOMETRIC CORRECTION=ROUND", "35: unknown surface smoothing ROUND"),
        (
            "*FRICTION\n",
            "*SURFACE SMOOTHING, NAME=R\nSEC, , CIRCLE, 0., 0.\n",
            "34: correction CIRCLE is not known; expe",
        ),
        (
            "*FRICTION\n",
            "*SURFACE SMOOTHING, NAME=R\nSEC, , SPHERICAL, 0.\n",
            "34: 1 numbers of a spherical correction, exp",
        ),
        (
            "*FRICTION\n",
            f"*SURFACE SMOOTHING, NAME=R\nSEC, , TOROIDAL{', 0.' * 7}\n",
            "34: the two points on the axis are in",
        ),
        (
            "*FRICTION\n",
            "*SURFACE, NAME=BARE\n*SURFACE SMOOTHING, NAME=R\nBARE, , SPHERICAL, 0., 0., 0.\n",
            "35: surface BARE has no faces",
        ),
        ("*FRICTION", "*FRICTION, ROUGH", "33: option ROUGH is not supported"),
        ("*FRICTION", "*FRICTION, TAUMAX=3.", "33: option TAUMAX is not supported"),
        ("*FRICTION", "*FRICTION, SLIP TOLERANCE=0.", "33: SLIP TOLERANCE=0 must be positive"),
        (
            "*FRICTION\n0.3",
            "*COHESIVE BEHAVIOR\n*DAMAGE INITIATION, CRITERION=MAXS\n1.",
            "33: expected the stiffnesses, .*de",
        ),
        ("*FRICTION\n0.3", "*COHESIVE BEHAVIOR\n1.", "34: 1 values, expected 2 or 3; dependence on temperature is not"),
        ("*FRICTION\n0.3", "*COHESIVE BEHAVIOR\n1., 0.", "34: stiffness 0 must be positive"),
        (
            "*FRICTION\n0.3",
            "*COHESIVE BEHAVIOR, REPEATED CONTACTS\n1., 1.",
            "33: option REPEATED CONTACTS is not supported",
        ),
        (
            "*FRICTION\n0.3",
            "*COHESIVE BEHAVIOR, ELIG=CURRENT CONTACTS\n1., 1.",
            "33: .*CURRENT CONTACTS is not supported",
        ),
        ("*FRICTION\n0.3", "*DAMAGE INITIATION, CRITERION=MAXS\n1., 1.", "33: does not follow .COHESIVE BEHAVIOR"),
        (
            "*FRICTION\n0.3",
            "*COHESIVE BEHAVIOR\n1., 1.\n*DAMAGE INITIATION, CRITERION=MAXE\n1., 1.",
            "35: CRITERION=MAXE is not one of what it follows; expected MAXS, QUADS, MAXU, QUADU",
        ),
        (
            "1000., 0.3\n",
            "1000., 0.3\n*DAMAGE INITIATION, CRITERION=MAXU\n1., 1.\n",
            "19: .*expected MAXS, QUADS, MAXE, QUADE",
        ),
        (
            "0.3\n*SOLID",
            "0.3\n*NSET, NSET=A\n1\n*DAMAGE INITIATION, CRITERION=MAXS\n1., 1.\n*SOLID",
            "21: .*not follow .MAT",
        ),
        ("*FRICTION", "*CONTACT DAMPING", "33: is not supported, but a contact pair uses TOUCH .deck.inp:35"),
        ("*STATIC", "*STATIC, RIKS", "37: .CONTACT PAIR .deck.inp:36. is not supported with .STATIC, RIKS"),
        ("*STATIC", "*DYNAMIC\n0.1, 1.", "37: .CONTACT PAIR .deck.inp:36. is not supported with .DYNAMIC"),
        ("*STEP\n", "*STEP, PERTURBATION\n", "37: .CONTACT PAIR .deck.inp:36. is not supported with .STEP, PERT"),
        ("*STATIC", "*FREQUENCY\n3", "37: .CONTACT PAIR .deck.inp:36. is not supported with .FREQUENCY"),
    ],
    ids=lambda mistake: mistake[2][:40],
)
def test_mistakes(refuse, mistake):
    refuse(DECK, mistake)


def test_heat_that_crosses_a_contact(read):
    """It counts in steps with temperatures alone."""
    deck = DECK.replace("*FRICTION\n0.3", "*GAP CONDUCTANCE\n1., 0.\n*GAP HEAT GENERATION\n1.")
    read(deck)
    message = r"deck\.inp:33: heat that crosses .* \(\*COUPLED TEMP.*inp:39\); without this line none crosses it"
    with pytest.raises(DeckError, match=message):
        read(deck.replace("*STATIC", "*COUPLED TEMPERATURE-DISPLACEMENT"))


def test_misplaced_and_repeated_properties(read):
    with pytest.raises(DeckError, match=r"deck\.inp:37: \*FRICTION: does not follow \*SURFACE INTERACTION"):
        read(DECK.replace(PAIR, f"{PAIR}*FRICTION\n0.1\n"))
    with pytest.raises(DeckError, match=r"deck\.inp:37: .*TOUCH is defined already, at deck\.inp:30"):
        read(DECK.replace(PAIR, f"{PAIR}*SURFACE INTERACTION, NAME=TOUCH\n"))


@pytest.mark.parametrize("element_type", ["CPE8", "S4"])
def test_faces_that_are_not_linear_ones_of_solids(read, element_type):
    nodes = (
        "*NODE\n31, 0., 5.\n32, 1., 5.\n33, 1., 6.\n34, 0., 6.\n35, 0.5, 5.\n36, 1., 5.5\n37, 0.5, 6.\n38, 0., 5.5\n"
    )
    numbers = ", ".join(map(str, range(31, 39 if element_type == "CPE8" else 35)))
    section = "SHELL" if element_type == "S4" else "SOLID"
    extra = f"*ELEMENT, TYPE={element_type}, ELSET=MORE\n3, {numbers}\n"
    extra += f"*{section} SECTION, ELSET=MORE, MATERIAL=M\n1.\n"
    text = DECK.replace("LOW, S3", f"MORE, {'SPOS' if element_type == 'S4' else 'S3'}")
    message = (
        f"faces of elements of type {element_type} are not supported in contact pairs; expected linear ones of solids"
    )
    with pytest.raises(DeckError, match=message):
        read(text.replace("*MATERIAL", nodes + extra + "*MATERIAL"))


# ------------------------------------------------------------ finite sliding


def test_rounded_corners():
    """Three nodes in a row, the first face of length 1, the second one of length 2: 0.2 of both are rounded.

    The parabola goes from (0.8, 0) to (1, 0.4), and in the middle it is halfway between the node and their mean. Where
    its pieces meet, a force goes to the node alone.
    """
    line = [np.array([[0, 1], [1, 2]])]
    nodes = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 2.0, 0.0]])
    pieces = make_pieces(line, nodes, 0.2, 0.1)
    np.testing.assert_array_equal(pieces.nodes[2:], [[1, 0, 2]] * 2)
    np.testing.assert_allclose(pieces.low[:, 0], [-1, -0.6, 0, 1 / (1 + np.sqrt(2))])
    np.testing.assert_allclose(pieces.high[:, 0], [0.6, 1, 1 / (1 + np.sqrt(2)), 1])
    np.testing.assert_allclose(pieces.reach_low[:, 0], [-1.2, -np.inf, -np.inf, -np.inf])
    np.testing.assert_allclose(pieces.reach_high[:, 0], [np.inf, 1.2, np.inf, np.inf])
    for shapes, ends in ((pieces.shapes, [[0.8, 0], [1, 0.4]]), (pieces.loads, [[0.8, 0], [1, 0.4]])):
        for piece, at, wanted in ((2, 0.0, ends[0]), (3, 1.0, ends[1])):
            place = (shapes[piece] @ [1, at, at**2]) @ nodes[pieces.nodes[piece]]
            np.testing.assert_allclose(place[:2], wanted, atol=1e-12)
    middle = (pieces.shapes[2] @ [1, 0.5, 0.25]) @ nodes[pieces.nodes[2]]
    np.testing.assert_allclose(middle[:2], [0.25 * 0.8 + 0.75, 0.25 * 0.4])
    for piece in (2, 3):
        at = pieces.high[2, 0]
        np.testing.assert_allclose(pieces.loads[piece] @ [1, at, at**2], [1, 0, 0], atol=1e-12)


def test_free_edges_of_areas():
    """A square beside a triangle: both reach beyond their free edges by a tenth, without end beyond the common one."""
    pieces = make_pieces([np.array([[0, 1, 2, 3]]), np.array([[1, 4, 2]])], np.zeros((5, 3)), 0.2, 0.1)
    np.testing.assert_allclose(pieces.reach_low, [[-1.2, -1.2], [-np.inf, -0.1]])
    np.testing.assert_allclose(pieces.reach_high, [[np.inf, 1.2], [np.inf, np.inf]])
    np.testing.assert_allclose(pieces.reach_total, [np.inf, 1.1])
    np.testing.assert_array_equal(pieces.ring, [[0, 1], [0, 1]])


def test_finite_sliding_is_the_default(read):
    (pair,) = read(DECK.replace(", SMALL SLIDING", "")).contacts
    assert isinstance(pair, SlidingPair)
    np.testing.assert_array_equal(pair.secondary, [4, 5])
    np.testing.assert_allclose(pair.areas, 2.0 / 2)
    # outward is up, from the right to the left
    np.testing.assert_array_equal(pair.main.nodes[0, :2], [2, 3])
    assert pair.length == pytest.approx(1.0)


@pytest.mark.parametrize(("adjust", "height"), [("ADJUST", 1.1), ("ADJUST=0.2", 1.0), ("ADJUST=TWO", 1.0)])
def test_adjust_in_finite_sliding(read, adjust, height):
    text = DECK.replace("SMALL SLIDING", adjust).replace("*MATERIAL", "*NSET, NSET=TWO\n11, 12\n*MATERIAL")
    np.testing.assert_allclose(read(text).mesh.coordinates[4:6, 1], height)


# ------------------------------------------------------------ analytical rigid surfaces

RIGID = DECK.replace("SEC, MAIN", "SEC, TOOL").replace(", SMALL SLIDING", "")
RIGID = RIGID.replace(
    "*SURFACE INT",
    "*SURFACE, NAME=TOOL, TYPE=SEGMENTS\nSTART, -1., 1.\nLINE, 0., 1.\nCIRCL, 1., 0., 0., 0.\n"
    "*RIGID BODY, ANALYTICAL SURFACE=TOOL, REF NODE=21\n*SURFACE INT",
    1,
)


def test_profile(read):
    """From the end to the start: the arc from (1, 0) up to (0, 1), then the line to (-1, 1)."""
    (pair,) = read(RIGID).contacts
    profile = pair.main
    assert read(RIGID).mesh.name(profile.reference) == "21"
    np.testing.assert_allclose(profile.middle, [[0, 0], [-0.5, 1]])
    np.testing.assert_allclose(profile.half, [[np.pi / 4, np.pi / 4], [-0.5, 0]])
    np.testing.assert_allclose(profile.radius, [1, 0])
    np.testing.assert_array_equal(profile.free, [[True, False], [False, True]])


def test_fillet(read):
    """A right angle at (1, 0), rounded by a radius of 0.5, and an arc that goes on without an angle."""
    text = RIGID.replace("TYPE=SEGMENTS\n", "TYPE=SEGMENTS, FILLET RADIUS=0.5\n").replace(
        "START, -1., 1.\nLINE, 0., 1.\nCIRCL, 1., 0., 0., 0.\n",
        "START, 3., 0.\nLINE, 1., 0.\nLINE, 1., 2.\nCIRCL, 0., 3., 0., 2.\n",
    )
    profile = read(text).contacts[0].main
    np.testing.assert_allclose(profile.radius, [1, 0, 0.5, 0])
    np.testing.assert_allclose(profile.middle, [[0, 2], [1, 1.25], [1.5, 0.5], [2.25, 0]])
    # about its centre the fillet goes from -90 to -180 degrees, here the other way
    np.testing.assert_allclose(profile.half[1:], [[0, -0.75], [-0.75 * np.pi, np.pi / 4], [0.75, 0]], atol=1e-12)


def test_profile_of_an_instance(read):
    """It moves with its instance, and closes where its last point is its first one."""
    instance = """\
*PART, NAME=BODY
*NODE
11, 0., 1.1
12, 1., 1.1
13, 1., 2.
14, 0., 2.
*ELEMENT, TYPE=CPE4, ELSET=UP
2, 11, 12, 13, 14
*SOLID SECTION, ELSET=UP, MATERIAL=M
2.
*SURFACE, NAME=SEC
UP, S1
*END PART
*PART, NAME=WALL
*END PART
*ASSEMBLY, NAME=A
*INSTANCE, NAME=B, PART=BODY
*END INSTANCE
*INSTANCE, NAME=W, PART=WALL
0., -1., 0.
*NODE, NSET=REF
1, 0., 0., 0.
*SURFACE, NAME=TOOL, TYPE=SEGMENTS
START, 0., 0.
LINE, 2., 0.
LINE, 1., -1.
LINE, 0., 0.
*RIGID BODY, ANALYTICAL SURFACE=TOOL, REF NODE=REF
*END INSTANCE
*END ASSEMBLY
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*SURFACE INTERACTION, NAME=TOUCH
*CONTACT PAIR, INTERACTION=TOUCH
B.SEC, W.TOOL
*STEP
*STATIC
*END STEP
"""
    (pair,) = read(instance).contacts
    np.testing.assert_allclose(pair.main.middle[-1], [1.0, -1.0])
    assert not pair.main.free.any()
    turned = instance.replace("0., -1., 0.\n*NODE", "0., -1., 0.\n0., 0., 0., 1., 0., 0., 180.\n*NODE")
    with pytest.raises(DeckError, match=r"deck\.inp:24: .*its instance is turned out of the plane"):
        read(turned)


@pytest.mark.parametrize(
    "mistake",
    [
        ("TYPE=SEGMENTS\n", "TYPE=SEGMENTS, FILLET RADIUS=-1.\n", "30: .*FILLET RADIUS=-1 must not be negative"),
        (
            "TYPE=SEGMENTS\nSTART, -1., 1.",
            "TYPE=SEGMENTS, FILLET RADIUS=0.1\nSTART, -1., 0.",
            "30: .*FILLET RADIUS beside an arc that meets its neighbour at an angle is not supported",
        ),
        (
            "TYPE=SEGMENTS\nSTART, -1., 1.\nLINE, 0., 1.\n",
            "TYPE=SEGMENTS, FILLET RADIUS=1.\nSTART, -0.5, 1.\nLINE, -0.5, 2.\nLINE, 0., 1.\n",
            "30: .*an arc of FILLET RADIUS=1 does not fit between two of its lines",
        ),
        ("TYPE=SEGMENTS", "TYPE=CYLINDER", "30: .*of analytical rigid surfaces TYPE=SEGMENTS is"),
        ("START, -1., 1.\n", "", "30: .*expected START, x, y on the first data line"),
        ("LINE, 0., 1.\nCIRCL, 1., 0., 0., 0.\n", "", "30: .*expected LINE or CIRCL on the second data line"),
        ("LINE, 0., 1.", "PARAB, 0., 1., 1., 1.", "32: .*segment PARAB is not supported .supported: LINE, CIRCL"),
        ("LINE, 0., 1.", "LINE, -1., 1.", "32: .*the segment has no length"),
        (
            "CIRCL, 1., 0., 0., 0.",
            "CIRCL, 1., 0., 0.2, 0.",
            "33: .*the ends of the arc are 1.0198 and 0.8 from its centre",
        ),
        ("CIRCL, 1., 0., 0., 0.", "CIRCL, 0., -1., 0., 0.", "33: .*the arc has 180 degrees; expected less"),
        ("*RIGID BODY, ANALYTICAL SURFACE=TOOL, REF NODE=21\n", "", "30: .*needs .RIGID BODY, ANALYTICAL SURFACE=TOOL"),
        ("REF NODE=21", "REF NODE=POINTS2", "34: .*POINTS2"),
        (
            "INTERACTION=TOUCH",
            "INTERACTION=TOUCH, SMALL SLIDING",
            "40: .*SMALL SLIDING is not supported on the analyti",
        ),
        ("INTERACTION=TOUCH", "INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "40: .*expected NODE TO SURFACE"),
        ("SEC, TOOL", "POINTS, TOOL", "41: .*POINTS has no faces whose length gives the elastic slip"),
    ],
    ids=lambda mistake: mistake[2][:40],
)
def test_mistakes_of_analytical_surfaces(refuse, mistake):
    refuse(RIGID, mistake)


def test_reference_of_several_nodes(read):
    text = RIGID.replace("REF NODE=21", "REF NODE=TWO").replace("*MATERIAL", "*NSET, NSET=TWO\n11, 12\n*MATERIAL")
    with pytest.raises(DeckError, match=r"deck\.inp:36: .*REF NODE=TWO has 2 nodes, expected one"):
        read(text)


def test_profile_in_space(read):
    text = BRICKS.replace(", SMALL SLIDING\nPOINTS, MAIN", "\nPOINTS, TOOL").replace(
        "*SURFACE INT",
        "*SURFACE, NAME=TOOL, TYPE=SEGMENTS\nSTART, 0., 0.\nLINE, 1., 0.\n"
        "*RIGID BODY, ANALYTICAL SURFACE=TOOL, REF NODE=1\n*SURFACE INT",
    )
    with pytest.raises(
        DeckError, match=r"deck\.inp:\d+: .*the analytical rigid surface TOOL is in the plane, POINTS is"
    ):
        read(text)


# ------------------------------------------------------------ anchor points


def circle(count=20, radius=10.0):
    """Nodes on a part of a circle, its edges and their outward normals."""
    angle = np.linspace(0.2, 1.2, count + 1)
    nodes = radius * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    edges = np.stack([np.arange(count), np.arange(1, count + 1)], axis=1)
    middle = nodes[edges].mean(axis=1)
    return nodes, edges, middle / np.linalg.norm(middle, axis=1)[:, None]


@pytest.mark.parametrize("gap", [0.5, 0.0, -0.3])
def test_anchors_of_a_circle(gap):
    """Nodes on rays through nodes: normals there are radial, whatever the faces are, but at the ends."""
    nodes, edges, normals = circle()
    inner = nodes[1:-1]
    points = inner * (1 + gap / 10.0)
    found = find_anchors(points, -inner, [(edges, normals)], nodes)
    assert found.facing.all()
    np.testing.assert_allclose(found.clearances, gap, atol=1e-9)
    np.testing.assert_allclose(found.normals, inner / 10.0, atol=1e-9)
    np.testing.assert_allclose(np.einsum("mk,mkd->md", found.weights, nodes[found.faces]), inner, atol=1e-8)


def test_normals_vary_smoothly():
    """Between the rays too the normal is that of the circle, to the second order of the length of a face."""
    nodes, edges, normals = circle()
    middle = nodes[edges].mean(axis=1)[2:-2] * 1.05
    found = find_anchors(middle, -middle, [(edges, normals)], nodes)
    np.testing.assert_allclose(found.normals, middle / np.linalg.norm(middle, axis=1)[:, None], atol=1e-6)


def test_faces_of_several_kinds_in_space():
    """A quadrilateral and a triangle in an inclined plane; one point beyond them."""
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    flat = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [4, 1, 0]], dtype=float)
    normal = np.array([[0.0, 0.0, 1.0]])
    kinds = [(np.array([[0, 1, 2, 3]]), normal @ turn), (np.array([[1, 4, 2]]), normal @ turn)]
    points = np.array([[0.5, 1.5, 0.7], [3.0, 1.0, -0.2], [2.0, 1.0, 0.1], [3.0, 3.0, 0.1]])
    found = find_anchors(points @ turn, np.zeros_like(points), kinds, flat @ turn)
    np.testing.assert_array_equal(found.facing, [True, True, True, False])
    np.testing.assert_allclose(found.clearances[:3], [0.7, -0.2, 0.1], atol=1e-9)
    np.testing.assert_allclose(found.normals[:3], np.repeat(normal @ turn, 3, axis=0), atol=1e-9)
    places = np.einsum("mk,mkd->md", found.weights, (flat @ turn)[found.faces])[:3] @ turn.T
    np.testing.assert_allclose(places[:, :2], points[:3, :2], atol=1e-8)
    np.testing.assert_allclose(found.weights[:3].sum(axis=1), 1.0)
    # on the edge of both, the first one
    np.testing.assert_array_equal(found.faces[2], [0, 1, 2, 3])


def test_faces_that_look_away(read):
    """Of both sides of the lower body the nodes face the upper one alone, though the other one is there too."""
    (pair,) = read(DECK.replace("LOW, S3", "LOW, S1\nLOW, S3")).contacts
    np.testing.assert_allclose(pair.clearances, 0.1)


# ------------------------------------------------------------ surface to surface


def test_mean_clearances(read):
    """Two faces on one that covers the first and a half of the second: shares and areas are those of what is covered.

    With s along the faces, the node in the middle has the weight s up to 1 and 2 - s up to 1.5: area 1/2 + 3/8, times
    the thickness 2; the last one s - 1 up to 1.5: 1/8. The upper side of the lower body falls from 1 to 0.7.
    """
    text = DECK.replace("SMALL SLIDING", "SMALL SLIDING, TYPE=SURFACE TO SURFACE")
    text = text.replace("2, 1., 0.\n3, 1., 1.", "2, 1.5, 0.\n3, 1.5, 0.7").replace(
        "*ELEMENT, TYPE=CPE4, ELSET=LOW", "15, 2., 1.1\n16, 2., 2.\n*ELEMENT, TYPE=CPE4, ELSET=LOW"
    )
    model = read(text.replace("2, 11, 12, 13, 14", "2, 11, 12, 13, 14\n3, 12, 15, 16, 13"))
    (pair,) = model.contacts
    np.testing.assert_array_equal(model.mesh.labels[pair.nodes[:, 0]], [11, 12, 15])
    np.testing.assert_allclose(pair.areas, [2 / 2, 2 * 7 / 8, 2 / 8], rtol=1e-9)
    np.testing.assert_allclose(pair.shares.sum(axis=1), 0.0, atol=1e-12)
    np.testing.assert_allclose(pair.normals, [[0, 1, 0]] * 3, atol=1e-15)
    # first moments of s over the areas
    places = model.mesh.coordinates[pair.nodes]
    means = np.array([(1 / 6) / (1 / 2), (1 / 3 + 11 / 24) / (7 / 8), (1 / 6) / (1 / 8)])
    np.testing.assert_allclose(pair.clearances, 0.1 + 0.2 * means, rtol=1e-9)
    np.testing.assert_allclose(np.einsum("mn,mn->m", pair.shares, places[..., 1]), pair.clearances, atol=1e-12)


def test_surface_of_nodes_is_always_node_to_surface(read):
    text = DECK.replace("SEC, MAIN", "POINTS, MAIN")
    (pair,) = read(text.replace("SMALL SLIDING", "SMALL SLIDING, TYPE=SURFACE TO SURFACE")).contacts
    (other,) = read(text).contacts
    np.testing.assert_array_equal(pair.shares, other.shares)
