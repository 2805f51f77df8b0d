# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*CONTACT and the keywords that follow it: which surfaces touch, in which roles, and what is refused."""

import numpy as np
import pytest

from uel.errors import DeckError

# three squares, one on the other, the third one above a gap
DECK = """\
*HEADING
*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
11, 0., 1.
12, 1., 1.
13, 1., 2.
14, 0., 2.
21, 0., 2.1
22, 1., 2.1
23, 1., 3.
24, 0., 3.
*ELEMENT, TYPE=CPE4, ELSET=ONE
1, 1, 2, 3, 4
*ELEMENT, TYPE=CPE4, ELSET=TWO
2, 11, 12, 13, 14
*ELEMENT, TYPE=CPE4, ELSET=THREE
3, 21, 22, 23, 24
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*ELSET, ELSET=ALL
ONE, TWO, THREE
*SOLID SECTION, ELSET=ALL, MATERIAL=M
2.
*SURFACE, NAME=A
ONE, S3
*SURFACE, NAME=B
TWO, S1
*SURFACE, NAME=C
TWO, S3
*SURFACE, NAME=D
THREE, S1
*SURFACE, NAME=POINTS, TYPE=NODE
11,
*SURFACE INTERACTION, NAME=DRY
*FRICTION
0.3,
*SURFACE INTERACTION, NAME=SOFT
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
100.,
*CONTACT
*CONTACT INCLUSIONS, ALL EXTERIOR
*CONTACT PROPERTY ASSIGNMENT
 , , DRY
*STEP
*STATIC
*BOUNDARY
1, 1, 2
*END STEP
"""
DOMAIN = DECK[DECK.index("*CONTACT\n") : DECK.index("*STEP\n")]


def pairs(read, domain):
    """Name, property and smallest and largest height of the secondary nodes of each pair."""
    model = read(DECK.replace(DOMAIN, domain))
    return [
        (
            pair.name.replace("General_Contact_Faces_", ""),
            pair.property.name,
            *np.round(model.mesh.coordinates[pair.secondary, 1][[0, -1]], 3).tolist(),
        )
        for pair in model.contacts
    ]


def test_properties_from_a_file(read, tmp_path):
    (tmp_path / "properties.inp").write_text(" , , DRY\n")
    given = f"*CONTACT PROPERTY ASSIGNMENT, INPUT={tmp_path / 'properties.inp'}\n"
    assert pairs(read, DOMAIN.replace("*CONTACT PROPERTY ASSIGNMENT\n , , DRY\n", given)) == pairs(read, DOMAIN)


def test_all_exterior(read):
    """A body is secondary to all whose elements come before; a body that is alone with itself is not."""
    model = read(DECK)
    assert pairs(read, DOMAIN) == [("(2,1)", "DRY", 1.0, 2.0), ("(3,1+2)", "DRY", 2.1, 3.0)]
    (first, second) = model.contacts
    # four sides, whose ends have corners of their own
    np.testing.assert_array_equal(np.bincount(first.secondary)[4:8], 2)
    assert first.own.nodes.shape == (4, 3)
    np.testing.assert_allclose(first.deepest, 0.5)
    assert first.length == pytest.approx(1.0)
    # of both bodies the four sides
    assert second.main.nodes.shape == (8, 3)
    assert first.keyword == "CONTACT"
    assert any("45: *CONTACT INCLUSIONS: contact of a body with itself, between ALL" in text for text in model.warnings)
    assert any("44: *CONTACT: hard contact is enforced exactly" in text for text in model.warnings)


def test_named_surfaces(read):
    assert pairs(read, "*CONTACT\n*CONTACT INCLUSIONS\nA, B\nD, C\n") == [
        ("(2,1)", "", 1.0, 1.0),
        ("(3,2)", "", 2.1, 2.1),
    ]


def test_exclusions_and_properties(read):
    domain = DOMAIN.replace("*CONTACT PROP", "*CONTACT EXCLUSIONS\nA, B\n*CONTACT PROP") + "C, D, SOFT\n"
    found = pairs(read, domain)
    # the lower side of the second body may still touch other sides of the first one
    assert [(name, surface) for name, surface, *_ in found] == [
        ("(2,1)", "DRY"),
        ("(2,1)", "DRY"),
        ("(3,1+2)", "DRY"),
        ("(3,1+2)", "DRY"),
        ("(3,2)", "SOFT"),
    ]
    assert found[-1][2:] == (2.1, 2.1)
    assert pairs(read, "*CONTACT\n*CONTACT INCLUSIONS\nA, B\n, D\n*CONTACT EXCLUSIONS\nD, A\nB, A\n")[0][0] == "(3,1+2)"


def test_contact_pairs_and_ties_keep_their_surfaces(read):
    pair = "*CONTACT PAIR, INTERACTION=SOFT, SMALL SLIDING\nB, A\n"
    tie = "*TIE, NAME=T, POSITION TOLERANCE=0.2, ADJUST=NO\nD, C\n"
    named = "*CONTACT\n*CONTACT INCLUSIONS\nA, B\nC, D\n"
    model = read(DECK.replace(DOMAIN, f"{pair}{named}"))
    assert [one.name for one in model.contacts] == ["(B,A)", "(General_Contact_Faces_3,General_Contact_Faces_2)"]
    model = read(DECK.replace(DOMAIN, f"{tie}{named}"))
    assert [one.name for one in model.contacts] == ["(General_Contact_Faces_2,General_Contact_Faces_1)"]


@pytest.mark.parametrize("role", ["SLAVE", "SECONDARY"])
@pytest.mark.parametrize("kind", ["MASTER SLAVE ROLES", "MAIN SECONDARY ROLES"])
def test_roles(read, kind, role):
    named = "*CONTACT\n*CONTACT INCLUSIONS\nA, B\n"
    assert pairs(read, f"{named}*CONTACT FORMULATION, TYPE={kind}\nA, B, {role}\n") == [("(1,2)", "", 1.0, 1.0)]
    assert pairs(read, f"{named}*CONTACT FORMULATION, TYPE={kind}\nB, A, {role}\n")[0][0] == "(2,1)"
    assert pairs(read, f"{named}*CONTACT FORMULATION, TYPE={kind}\nB, A, MASTER\n")[0][0] == "(1,2)"
    assert pairs(read, f"{named}*CONTACT FORMULATION, TYPE={kind}\n, A, MAIN\n")[0][0] == "(1,2)"


def test_gaps_and_overlaps_that_are_closed(read):
    """An overlap is closed by moving secondary nodes, a gap where SEARCH ABOVE says so."""
    deck = DECK.replace("11, 0., 1.\n", "11, 0., 0.9\n")
    assert read(deck).mesh.coordinates[4, 1] == pytest.approx(1.0)
    data = "*CONTACT INITIALIZATION DATA, NAME=START, SEARCH BELOW=0.05, SEARCH ABOVE=0.2\n"
    assignment = "*CONTACT INITIALIZATION ASSIGNMENT\n, , START\n"
    model = read(deck.replace(DOMAIN, f"{data}{DOMAIN}{assignment}"))
    assert model.mesh.coordinates[4, 1] == pytest.approx(0.9)
    np.testing.assert_allclose(model.mesh.coordinates[8:10, 1], 2.0)


def test_elements_without_faces_are_named(read):
    extra = "*ELEMENT, TYPE=T2D2, ELSET=BAR\n9, 21, 24\n*SOLID SECTION, ELSET=BAR, MATERIAL=M\n1.\n"
    warnings = read(DECK.replace("*MATERIAL", f"{extra}*MATERIAL")).warnings
    assert any("elements of type T2D2 have no faces, and touch nothing" in text for text in warnings)


@pytest.mark.parametrize(
    "mistake",
    [
        ("*CONTACT\n", "", "44: .CONTACT INCLUSIONS: does not follow .CONTACT"),
        ("*CONTACT INCLUSIONS, ALL EXTERIOR\n", "", "44: .CONTACT: expected .CONTACT INCLUSIONS"),
        ("EXTERIOR\n", "EXTERIOR\nA, B\n", "46: ALL EXTERIOR takes no data lines"),
        (", ALL EXTERIOR", "", "45: expected two surfaces on the data line"),
        (", ALL EXTERIOR", "\nA, B, C", "46: 3 entries, expected at most 2"),
        (", ALL EXTERIOR", "\nA, BE", "46: unknown surface BE"),
        (", ALL EXTERIOR", "\nC, B", "46: .CONTACT INCLUSIONS: C and B belong to one body; contact of a body with its"),
        (", ALL EXTERIOR", "\nA,", "46: .CONTACT INCLUSIONS: A and A belong to one body"),
        (
            ", ALL EXTERIOR",
            "\nA, POINTS",
            "46: .CONTACT: surface POINTS is of TYPE=NODE; expected faces of elements, or",
        ),
        (", ALL EXTERIOR", "\nA, B\n*CONTACT EXCLUSIONS\nB, A", "44: .CONTACT: no two bodies can touch"),
        (", , DRY", "A, B", "47: what is assigned is missing"),
        (", , DRY", ", , WET", "47: unknown surface interaction WET"),
        (
            "DRY\n*STEP",
            "DRY\n*CONTACT FORMULATION, TYPE=SMALL SLIDING\nA, B\n*STEP",
            "48: .*TYPE=SMALL SLIDING is not sup",
        ),
        (
            "DRY\n*STEP",
            "DRY\n*CONTACT FORMULATION, TYPE=MASTER SLAVE ROLES\nA, B, BALANCED\n*STEP",
            "49: role BALANCED is not supported .supported: MAIN, MASTER, SECONDARY, SLAVE",
        ),
        (
            "DRY\n*STEP",
            "DRY\n*CONTACT INITIALIZATION ASSIGNMENT\n, , START\n*STEP",
            "49: unknown contact initialization START",
        ),
        (
            "*CONTACT\n",
            "*CONTACT INITIALIZATION DATA, NAME=S, SEARCH ABOVE=-1.\n*CONTACT\n",
            "44: SEARCH ABOVE=-1 must not be negative",
        ),
        (
            "*CONTACT\n",
            "*CONTACT INITIALIZATION DATA, NAME=S, INTERFERENCE FIT\n*CONTACT\n",
            "44: .*option INTERFERENCE FIT is not supported",
        ),
        ("*STEP\n", "*CONTACT STABILIZATION\n*STEP\n", "48: .CONTACT STABILIZATION is not supported: it is damping"),
        ("*STATIC", "*DYNAMIC\n0.1, 1.", "48: .CONTACT .deck.inp:44. is not supported with .DYNAMIC"),
    ],
    ids=lambda mistake: mistake[2][:40],
)
def test_mistakes(refuse, mistake):
    refuse(DECK, mistake)


def test_faces_that_are_not_supported(read):
    """Quadratic solids and shells are in the domain too, and cannot be left out silently."""
    extra = "*ELEMENT, TYPE=S4, ELSET=MORE\n9, 1, 2, 3, 4\n*SHELL SECTION, ELSET=MORE, MATERIAL=M\n1.\n"
    with pytest.raises(DeckError, match=r"deck\.inp:48: .*faces of elements of type S4 are not supported in contact"):
        read(DECK.replace("*MATERIAL", f"{extra}*MATERIAL", 1))
