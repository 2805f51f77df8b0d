# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*SHELL SECTION and *TRANSVERSE SHEAR STIFFNESS: what they give, and what is refused."""

import re

import numpy as np
import pytest

import uel
from uel.deck import read_deck
from uel.errors import DeckError

DECK = """\
*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
*ELEMENT, TYPE={type}, ELSET=ALL
1, 1, 2, 3, 4
*MATERIAL, NAME=M
{material}
*MATERIAL, NAME=N
*ELASTIC, TYPE=LAMINA
100., 10., 0.3, 5., 5., 4.
*ORIENTATION, NAME=O
1., 0., 0., 0., 1., 0.
3, 0.
*ORIENTATION, NAME=USER, SYSTEM=USER
{section}
{more}*STEP{step}
*{procedure}
{data}*END STEP
"""
GENERAL = "*SHELL GENERAL SECTION, ELSET=ALL, MATERIAL=M\n0.5"
HOMOGENEOUS = "*SHELL SECTION, ELSET=ALL, MATERIAL=M\n0.5"


@pytest.fixture
def deck(tmp_path):
    def deck(
        section=HOMOGENEOUS,
        *,
        type="S4R",
        material="*ELASTIC\n100., 0.3",
        more="",
        step="",
        procedure="STATIC",
        data="",
    ):
        file = tmp_path / "shell.inp"
        values = {"type": type, "material": material, "section": section, "more": more, "step": step}
        file.write_text(DECK.format(**values, procedure=procedure, data=data))
        return file

    return deck


def test_homogeneous(deck):
    section = read_deck(deck()).groups[0].section
    assert [(layer.thickness, layer.points, layer.material.name, layer.angle) for layer in section.layers] == [
        (0.5, 5, "M", 0.0)
    ]
    assert (section.offset, section.gauss, section.orientation, section.shear) == (0.0, False, None, ())


def test_general_section(deck):
    """The layers are those of *SHELL SECTION with the default section points."""
    options = "ELSET=ALL, COMPOSITE, OFFSET=SNEG, SYMMETRIC"
    plain = f"*SHELL SECTION, {options}\n0.2, 3, M, 30.\n0.1, 3, M, -10."
    general = f"*SHELL GENERAL SECTION, {options}\n0.2, , M, 30.\n0.1, , M, -10."
    for pair in ((plain, general), (HOMOGENEOUS, GENERAL)):
        one, other = (read_deck(deck(given)).groups[0].section for given in pair)
        layers = [
            [(layer.thickness, layer.points, layer.material.name, layer.angle) for layer in section.layers]
            for section in (one, other)
        ]
        assert layers[0] == layers[1]
        assert (one.offset, one.gauss) == (other.offset, other.gauss)


def test_composite(deck):
    section = (
        read_deck(
            deck(
                "*SHELL SECTION, ELSET=ALL, COMPOSITE, ORIENTATION=O, OFFSET=SNEG, LAYUP=L, SYMMETRIC\n"
                "0.1, , N, 45., PLY-1\n0.2, 5, M\n*TRANSVERSE SHEAR STIFFNESS\n3., 4., 1., 0."
            )
        )
        .groups[0]
        .section
    )
    assert [(layer.thickness, layer.points, layer.material.name, layer.angle) for layer in section.layers] == [
        (0.1, 3, "N", 45.0),
        (0.2, 5, "M", 0.0),
        (0.2, 5, "M", 0.0),
        (0.1, 3, "N", 45.0),
    ]
    assert section.thickness == pytest.approx(0.6)
    assert (section.offset, section.orientation.name, section.orientation.normal) == (-0.5, "O", 3)
    assert (section.shear, section.slenderness) == ((3.0, 4.0, 1.0), 0.0)


@pytest.mark.parametrize(
    ("given", "points"), [("", 3), ("\n*HOURGLASS STIFFNESS\n2.", 3)], ids=["default", "hourglass"]
)
def test_gauss(deck, given, points):
    text = f"*SHELL SECTION, ELSET=ALL, MATERIAL=M, SECTION INTEGRATION=GAUSS, OFFSET=0.25\n0.5{given}"
    section = read_deck(deck(text)).groups[0].section
    assert (section.gauss, section.layers[0].points, section.offset) == (True, points, 0.25)
    assert section.hourglass == (2.0 if given else 0.0)


COMPOSITE = "*SHELL SECTION, ELSET=ALL, COMPOSITE\n"


@pytest.mark.parametrize(
    ("section", "message"),
    [
        ("*SHELL SECTION, ELSET=ALL\n1.", "expected either MATERIAL= or COMPOSITE, with the material of each layer"),
        ("*SHELL SECTION, ELSET=ALL, MATERIAL=M, COMPOSITE\n1., 3, M", "expected either MATERIAL= or COMPOSITE"),
        ("*SHELL SECTION, ELSET=ALL, MATERIAL=M", "needs a data line with the thickness, and only one"),
        ("*SHELL SECTION, ELSET=ALL, MATERIAL=M\n1.\n2.", "needs a data line with the thickness, and only one"),
        (COMPOSITE, "needs a data line with the thickness for each layer"),
        ("*SHELL SECTION, ELSET=ALL, MATERIAL=M\n0.", "thickness 0 must be positive"),
        ("*SHELL SECTION, ELSET=ALL, MATERIAL=M\n1., 4", "4 section points: expected an odd number from 3 to 249"),
        (
            "*SHELL SECTION, ELSET=ALL, MATERIAL=M, SECTION INTEGRATION=GAUSS\n1., 0",
            "0 section points: expected a number from 1 to 250",
        ),
        ("*SHELL SECTION, ELSET=ALL, MATERIAL=M\n1., 5, N", "3 entries, expected at most 2"),
        (COMPOSITE + "1., 3, X", "unknown material X"),
        (COMPOSITE + "1., 3", "material is missing"),
        ("*SHELL SECTION, ELSET=ALL, MATERIAL=M, OFFSET=TOP\n1.", "OFFSET=TOP: expected a number, SPOS or SNEG"),
        ("*SHELL SECTION, ELSET=ALL, MATERIAL=M, NODAL THICKNESS\n1.", "NODAL THICKNESS"),
        ("*SHELL SECTION, ELSET=ALL, MATERIAL=M, DENSITY=1.\n1.", "DENSITY"),
        (HOMOGENEOUS + "\n*TRANSVERSE SHEAR STIFFNESS", "needs a data line with K11, K22, K12"),
        (
            HOMOGENEOUS + "\n*TRANSVERSE SHEAR STIFFNESS\n1., 1., 2.",
            "K11 = 1, K22 = 1, K12 = 2: expected a positive definite stiffness",
        ),
        (
            HOMOGENEOUS + "\n*TRANSVERSE SHEAR STIFFNESS\n1., 1., 0., -1.",
            "slenderness factor -1 must not be negative",
        ),
        ("*TRANSVERSE SHEAR STIFFNESS\n1., 1.\n" + HOMOGENEOUS, r"does not follow \*SHELL SECTION"),
        ("*HOURGLASS STIFFNESS\n1.\n" + HOMOGENEOUS, r"does not follow \*SOLID SECTION or \*SHELL SECTION"),
        (
            "*SOLID SECTION, ELSET=ALL, MATERIAL=M\n1.",
            r"element set ALL holds elements of type S4R, which take \*SHELL SECTION",
        ),
    ],
)
def test_mistakes(deck, section, message):
    with pytest.raises(DeckError, match=r"(?m)shell\.inp:\d+: .*" + message):
        read_deck(deck(section))


@pytest.mark.parametrize(
    ("material", "message"),
    [
        ("*DENSITY\n1.", r"material M has no \*ELASTIC or \*USER MATERIAL, which elements of type S4R need"),
        ("*ELASTIC, TYPE=TRACTION\n1., 1., 1.", r"\*ELASTIC, TYPE=TRACTION is not .* S4R .*; supported: cohesive"),
    ],
)
def test_materials_that_shells_do_not_take(deck, material, message, tmp_path):
    with pytest.raises(DeckError, match=message):
        uel.run(deck(material=material), output_dir=tmp_path)


UMAT = "      subroutine umat\n      end\n"
USER = "*USER MATERIAL, CONSTANTS=1\n1."
SHEAR = HOMOGENEOUS + "\n*TRANSVERSE SHEAR STIFFNESS\n1., 1."


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            {"step": ", NLGEOM", "procedure": "DYNAMIC", "material": "*ELASTIC\n1., 0.3\n*DENSITY\n1."},
            r"shell\.inp:\d+: \*DYNAMIC with NLGEOM is not supported for elements of type S4R: their inertia",
        ),
        (
            {"section": "*SHELL SECTION, ELSET=ALL, MATERIAL=M, ORIENTATION=USER\n1."},
            r"shell\.inp:\d+: \*ORIENTATION, SYSTEM=USER is not supported for elements of type S4R \(section at .*\)",
        ),
        ({"material": USER}, r"S4R with \*USER MATERIAL need \*TRANSVERSE SHEAR STIFFNESS after \*SHELL SECTION"),
        (
            {"material": USER, "section": SHEAR},
            r"S4R with \*USER MATERIAL need \*HOURGLASS STIFFNESS after \*SHELL SECTION",
        ),
        (
            {"material": "*ELASTIC\n1., 0.3\n*EXPANSION\n1e-5"},
            r"\*EXPANSION is not supported for elements of type S4R \(material M",
        ),
        (
            {"material": "*ELASTIC\n1., 0.3\n*VISCOELASTIC, TIME=PRONY\n0.5, 0., 1."},
            r"\*VISCOELASTIC is not supported for elements of type S4R",
        ),
        (
            {"procedure": "DYNAMIC", "data": "0.1, 1.\n"},
            r"material M has no \*DENSITY, which elements of type S4R need in \*DYNAMIC",
        ),
        (
            {"data": "1., 1.\n*DLOAD\nALL, GRAV, 1., 0., 0., -1.\n"},
            r"GRAV needs \*DENSITY, which material M does not have",
        ),
        (
            {"data": "1., 1.\n*DLOAD\nALL, BXNU, 1.\n"},
            "load type BXNU on elements of type S4R; loads by DLOAD are not supported there",
        ),
        (
            {"data": "1., 1.\n*DLOAD\nALL, P1, 1.\n"},
            r"elements of type S4R have no face S1 \(faces: SPOS, SNEG, E1, E2, E3, E4\)",
        ),
        (
            {"more": "*SURFACE, NAME=EDGE\nALL, E1\n", "data": "1., 1.\n*DSLOAD\nEDGE, P, 1.\n"},
            r"load type P on face E1 of S4R; expected EDLD, EDNOR, EDSHR, EDTRA",
        ),
        (
            {"more": "*SURFACE, NAME=TOP\nALL, SPOS\n", "data": "1., 1.\n*DSLOAD\nTOP, EDNOR, 1.\n"},
            r"load type EDNOR on face SPOS of S4R; expected P, TRVEC, TRSHR",
        ),
        (
            {"data": "1., 1.\n*DLOAD\nALL, EDMOM1, 1.\n"},
            r"load type EDMOM1 is not supported \(supported: .*; EDLDn, EDNORn, EDSHRn, EDTRAn on shells\)",
        ),
        (
            {"section": "*SHELL GENERAL SECTION, ELSET=ALL\n1., 2., 3."},
            r"expected either MATERIAL= or COMPOSITE, .* on its line; a stiffness matrix is not supported",
        ),
        (
            {"section": GENERAL, "material": "*ELASTIC\n1., 0.\n*PLASTIC\n1."},
            r"shell\.inp:\d+: .*material M is not linear elastic, but the section is linear elastic with constants; ",
        ),
        (
            {"section": GENERAL, "material": "*ELASTIC\n1., 0.3, 0.\n2., 0.3, 100."},
            r"material M depends on temperature or fields, but the section is linear elastic with constants; \*SHELL",
        ),
        ({"data": "1., 1.\n*DLOAD\nALL, EDLD1, 1.\n"}, "EDLD1 needs a direction, entries 4 to 6"),
        (
            {"step": ", NLGEOM", "data": "1., 1.\n*DLOAD\nALL, EDTRA2, 1.\n"},
            r"EDTRA follows the surface, which is not supported with NLGEOM .*; EDLD of \*DSLOAD with FOLLOWER=NO",
        ),
        (
            {"procedure": "BUCKLE", "data": "1\n*DLOAD\nALL, EDNOR2, 1.\n"},
            r"EDNOR follows the surface: its load stiffness is not supported in \*BUCKLE; EDLD of \*DSLOAD with FOLL",
        ),
        ({"data": "1., 1.\n*DLOAD\nALL, BR, 1.\n"}, "load type BR on elements of type S4R, whose body forces are BX"),
    ],
)
def test_refused(deck, options, message, tmp_path):
    user = None
    if options.get("material") == USER:
        user = tmp_path / "none.f"
        user.write_text(UMAT)
    with pytest.raises(DeckError, match=message):
        uel.run(deck(**options), user, output_dir=tmp_path)


def test_pressure_without_a_face_on_solids(deck):
    section = "*SOLID SECTION, ELSET=ALL, MATERIAL=M\n1."
    text = deck(section, type="CPS4", data="1., 1.\n*DLOAD\nALL, P, 1.\n")
    with pytest.raises(DeckError, match="load type P on elements of type CPS4; expected Pn with the number of a face"):
        read_deck(text)


def test_sdvini(deck, tmp_path):
    user = tmp_path / "state.f"
    user.write_text("      subroutine sdvini\n      end\n" + UMAT)
    more = "*INITIAL CONDITIONS, TYPE=SOLUTION, USER\n"
    text = deck(SHEAR + "\n*HOURGLASS STIFFNESS\n1.", material=USER + "\n*DEPVAR\n1", more=more)
    with pytest.raises(DeckError, match=r"shell\.inp:\d+: SDVINI is not supported for elements of type S4R"):
        uel.run(text, user, output_dir=tmp_path)


def test_nodes_of_an_element(deck):
    with pytest.raises(DeckError, match=re.escape("S3")):
        read_deck(deck(type="S3"))


def test_direction_cosines_turn_with_the_instance(tmp_path):
    """Those of *NODE lines, by *SYSTEM and the rotation of *INSTANCE; a node without them has none."""
    file = tmp_path / "normals.inp"
    file.write_text(
        "*PART, NAME=P\n*SYSTEM\n0., 0., 0., 0., 1., 0.\n*NODE\n1, 0., 0., 0., 1., 0., 0.\n2, 1., 0., 0.\n"
        "*NODE\n3, 1., 1., 0., 0., 0., 2.\n4, 0., 1.\n*ELEMENT, TYPE=S4, ELSET=ALL\n1, 1, 2, 3, 4\n"
        "*SHELL SECTION, ELSET=ALL, MATERIAL=M\n0.5\n*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n"
        "1., 0., 0.\n0., 0., 0., 1., 0., 0., 90.\n*END INSTANCE\n*END ASSEMBLY\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n"
        "*STEP\n*STATIC\n1., 1.\n*END STEP\n"
    )
    # local x is y, which the instance turns to z; z becomes -y
    expected = [[0, 0, 1], [0, 0, 0], [0, -2, 0], [0, 0, 0]]
    np.testing.assert_allclose(read_deck(file).mesh.normals, expected, atol=1e-12)
    file.write_text(file.read_text().replace("1., 0., 0.\n2, 1.", "1., NOT, 0.\n2, 1."))
    with pytest.raises(DeckError, match="direction cosine 2"):
        read_deck(file)
