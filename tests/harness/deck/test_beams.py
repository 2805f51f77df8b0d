# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*BEAM SECTION and *BEAM GENERAL SECTION: what they give, and what is refused."""

import numpy as np
import pytest

import uel
from uel.deck import read_deck
from uel.elements.families.beam import local_axes
from uel.errors import DeckError
from uel.report.model_tables import property_tables

DECK = """\
*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
*ELEMENT, TYPE={type}, ELSET=ALL
1, 1, 2{extra}
*MATERIAL, NAME=M
{material}
{section}
*STEP{step}
*{procedure}
{data}*END STEP
"""
SECTION = "*BEAM SECTION, ELSET=ALL, MATERIAL=M, SECTION="
GENERAL = "*BEAM GENERAL SECTION, ELSET=ALL"
RECT = SECTION + "RECT\n0.2, 0.3"
CONSTANTS = GENERAL + "\n1., 2., 0., 3., 4.\n\n100., 40."


@pytest.fixture
def deck(tmp_path):
    def deck(
        section=RECT,
        *,
        type="B31",
        extra="",
        material="*ELASTIC\n100., 0.25",
        step="",
        procedure="STATIC",
        data="",
    ):
        file = tmp_path / "beam.inp"
        values = {"type": type, "extra": extra, "material": material, "section": section, "step": step}
        file.write_text(DECK.format(**values, procedure=procedure, data=data))
        return file

    return deck


def section_of(file):
    return read_deck(file).groups[0].section


TURNED = """\
*NODE
1, 0., 0., 0.{first}
2, 1., 0., 0.{second}
3, 2., 0., 0.
4, 5., 1., -1.
5, 5., 0., 0.
*ELEMENT, TYPE=B31, ELSET=A
1, 1, 2{node}
*ELEMENT, TYPE=B31, ELSET=B
2, 2, 3
*MATERIAL, NAME=M
*ELASTIC
100., 0.25
*BEAM SECTION, ELSET=A, MATERIAL=M, SECTION=RECT
0.2, 0.3
0., 0., -1.
*BEAM SECTION, ELSET=B, MATERIAL=M, SECTION=RECT
0.2, 0.3
{n1}
*STEP
*STATIC
*END STEP
"""


def directions(tmp_path, *, angle=0.0, first="", second="", node=""):
    """Angle of n2 from y at the middle of both elements, in degrees; n1 of the second section is turned from -z."""
    n1 = f"0., {np.sin(np.radians(angle))}, {-np.cos(np.radians(angle))}"
    (tmp_path / "turned.inp").write_text(TURNED.format(n1=n1, first=first, second=second, node=node))
    model = read_deck(tmp_path / "turned.inp")
    found = []
    for group in model.groups:
        axes, _, _ = local_axes(group, group.built_in, group.section, model.mesh.coordinates, 1)
        t, n1, n2 = axes[0, 0]
        np.testing.assert_allclose(n1, np.cross(n2, t), atol=1e-12)
        np.testing.assert_allclose(t, [1, 0, 0], atol=1e-12)
        found.append(np.degrees(np.arctan2(n2[2], n2[1])))
    return found


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        # within 20 degrees the joint has the mean
        ({"angle": 10.0}, (2.5, 7.5)),
        ({"angle": 30.0}, (0.0, 30.0)),
        # direction cosines of *NODE, of any length, take its place
        ({"angle": 10.0, "second": ", 0., 0., 2."}, (45.0, 50.0)),
        ({"first": ", 0., 0., 1.", "second": ", 0., 0., 1."}, (90.0, 45.0)),
        # an additional node takes the place of n1 of the section; 45 degrees are too many for a mean
        ({"node": ", 4"}, (45.0, 0.0)),
        ({"node": ", 4", "angle": 50.0}, (46.25, 48.75)),
    ],
)
def test_normals_at_nodes(tmp_path, given, expected):
    """Analysis User's Guide, Beam element cross-section orientation; in between they are interpolated."""
    np.testing.assert_allclose(directions(tmp_path, **given), expected, atol=1e-9)


@pytest.mark.parametrize("given", [{"first": ", 1., 0., 0.", "second": ", 1., 0., 0."}, {"node": ", 5"}])
def test_normal_along_the_axis(tmp_path, given):
    values = {"first": "", "second": "", "node": ""} | given
    (tmp_path / "turned.inp").write_text(TURNED.format(n1="0., 0., -1.", **values))
    message = r"turned\.inp:\d+: element 1 \(type B31\) lies along n1 of its additional node, or n2 of its nodes"
    with pytest.raises(DeckError, match=message):
        uel.run(tmp_path / "turned.inp", output_dir=tmp_path)


def test_section(deck):
    section = section_of(deck(RECT + "\n0., 1., -1.\n5, 5", material="*ELASTIC\n100., 0.25\n*DENSITY\n7."))
    assert (section.profile, section.dimensions, section.n1) == ("RECT", (0.2, 0.3), (0.0, 1.0, -1.0))
    assert (section.young, section.shear_modulus, section.density) == (100.0, pytest.approx(40.0), 7.0)
    assert (section.material.name, section.isotropic, section.shear, section.slenderness) == ("M", False, (), None)


@pytest.mark.parametrize("line", ["", "\n", "\n0., 0., 0."])
def test_default_direction(deck, line):
    assert section_of(deck(RECT + line)).n1 == (0.0, 0.0, -1.0)


def test_general_section(deck):
    section = section_of(deck(CONSTANTS.replace("ELSET=ALL", "ELSET=ALL, DENSITY=7., ROTARY INERTIA=ISOTROPIC")))
    assert (section.profile, section.dimensions) == ("GENERAL", (1.0, 2.0, 0.0, 3.0, 4.0))
    assert (section.young, section.shear_modulus, section.density) == (100.0, 40.0, 7.0)
    assert (section.material, section.isotropic) == (None, True)


@pytest.mark.parametrize(
    ("line", "shear", "slenderness"),
    [
        ("5., 6., 0.", (5.0, 6.0), 0.0),
        ("5.", (5.0, 5.0), None),
        (", 6., 0.5", (6.0, 6.0), 0.5),
        ("0., 0., 0.1", (), 0.1),
    ],
)
def test_shear_stiffness(deck, line, shear, slenderness):
    for text in (RECT, CONSTANTS):
        section = section_of(deck(f"{text}\n*TRANSVERSE SHEAR STIFFNESS\n{line}"))
        assert (section.shear, section.slenderness) == (shear, slenderness)


@pytest.mark.parametrize(
    ("section", "message"),
    [
        (SECTION + "RECT", r"\*BEAM SECTION: needs a data line with a, b"),
        (SECTION + "RECT\n0.2", r"\*BEAM SECTION: b is missing"),
        (SECTION + "RECT\n0.2, 0.", "b = 0 must be positive"),
        (SECTION + "RECT\n0.2, 0.3, 1.", "3 entries, expected at most 2"),
        (RECT + "\n\n5, 5\n1.", "a data line more than the 3 of SECTION=RECT"),
        (RECT + "\n\n5, 7", r"only the default numbers of section points are supported \(5, 5\)"),
        (SECTION + "PIPE\n0.2, 0.2", "the wall thickness must be less than the outside radius"),
        (SECTION + "BOX\n1., 2., 0.1, 0.1, 0.1, 0.2", "walls of different thickness are not supported"),
        (SECTION + "BOX\n1., 2., 0.5, 0.5, 0.5, 0.5", "the walls are thicker than the box"),
        (SECTION + "I\n0., 1., 1., 1., 0.5, 0.5, 0.1", r"the flanges are thicker than the section is high \(h\)"),
        (SECTION + "L\n1., 1., 0.1, 0.1", "SECTION=L"),
        (SECTION + "RECT, LUMPED=NO\n1., 1.", "LUMPED=NO"),
        (RECT + "\n0., 0., 1., 1.", "4 entries, expected at most 3"),
        (GENERAL + "\n1., 2., 0., 3., 4.", "needs a third data line with Young's modulus and the shear modulus"),
        (GENERAL + "\n1., 2., 0., 3., 4.\n\n100., 0.", "E = 100, G = 0: expected positive moduli"),
        (GENERAL + "\n1., 2., 0., 3., 4.\n\n100., 40., 1e-5", "thermal expansion is not supported for beams"),
        (GENERAL + "\n1., 2., 0., 3., 0.\n\n100., 40.", "J = 0 must be positive"),
        (CONSTANTS.replace("ALL", "ALL, DENSITY=-1."), "DENSITY=-1 must not be negative"),
        (CONSTANTS.replace("ALL", "ALL, TAPER"), "TAPER"),
        (RECT + "\n*TRANSVERSE SHEAR STIFFNESS", "needs a data line with K23, K13"),
        (RECT + "\n*TRANSVERSE SHEAR STIFFNESS\n1., -1.", "K23 = 1, K13 = -1 must not be negative"),
        (
            RECT + "\n*TRANSVERSE SHEAR STIFFNESS\n1., 1., -1.",
            "slenderness compensation factor -1 must not be negative",
        ),
        (RECT + "\n*TRANSVERSE SHEAR STIFFNESS\n1., 1., x", "slenderness compensation factor: "),
        (RECT + "\n*TRANSVERSE SHEAR STIFFNESS\n1., 1., SCF", "SCF, a slenderness compensation factor from the moduli"),
        (
            "*TRANSVERSE SHEAR STIFFNESS\n1., 1.\n" + RECT,
            r"does not follow \*SHELL SECTION or \*SHELL GENERAL SECTION or \*BEAM SECTION or \*BEAM GENERAL",
        ),
        (
            "*SOLID SECTION, ELSET=ALL, MATERIAL=M\n1.",
            r"element set ALL holds elements of type B31, which take \*BEAM SECTION",
        ),
    ],
)
def test_mistakes(deck, section, message):
    with pytest.raises(DeckError, match=r"(?m)beam\.inp:\d+: .*" + message):
        read_deck(deck(section))


@pytest.mark.parametrize(
    ("material", "message"),
    [
        ("*DENSITY\n1.", r"material M has no \*ELASTIC or \*USER MATERIAL, which elements of type B31 need"),
        ("*ELASTIC, TYPE=LAMINA\n1., 1., 0.3, 1., 1., 1.", r"\*ELASTIC, TYPE=LAMINA is not supported for .* B31"),
        ("*HYPERELASTIC, NEO HOOKE\n1., 0.1", r"\*HYPERELASTIC is not supported for elements of type B31"),
        ("*ELASTIC\n1., 0.3\n*VISCOELASTIC, TIME=PRONY\n0.5, 0.5, 1.", r"\*VISCOELASTIC is not supported for .* B31"),
        (
            "*ELASTIC\n1., 0.3\n*PLASTIC, HARDENING=USER, PROPERTIES=1\n1.",
            r"\*PLASTIC, HARDENING=USER is not supported for elements of type B31",
        ),
        (
            "*ELASTIC\n1., 0.3\n*PLASTIC, HARDENING=KINEMATIC\n1., 0.\n2., 1.",
            r"\*PLASTIC with kinematic or combined hardening is not supported for elements of type B31 \(material M",
        ),
        (
            "*ELASTIC\n1., 0.3\n*DAMAGE INITIATION, CRITERION=MAXS\n1., 1., 1.",
            r"\*DAMAGE INITIATION is not supported for elements of type B31 .*; supported: cohesive elements",
        ),
        ("*ELASTIC\n1., 0.7", r"\*ELASTIC"),
    ],
)
def test_materials_that_beams_do_not_take(deck, material, message, tmp_path):
    with pytest.raises(DeckError, match=message):
        uel.run(deck(material=material), output_dir=tmp_path)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            {"step": ", NLGEOM", "procedure": "DYNAMIC", "data": "0.1, 1.\n", "material": "*ELASTIC\n1.\n*DENSITY\n1."},
            r"\*DYNAMIC with NLGEOM is not supported for elements of type B31: their inertia is that of small",
        ),
        (
            {"type": "B21", "step": ", NLGEOM", "data": "1., 1.\n*DLOAD\nALL, P2, 1.\n"},
            r"a force along a local direction of a beam follows it, which is not supported with NLGEOM \(.*:12\)",
        ),
        (
            {"procedure": "BUCKLE", "data": "1\n*DLOAD\nALL, P1, 1.\n"},
            r"beam\.inp:\d+: a force along a local direction of a beam follows it; its load stiffness for \*BUCKLE",
        ),
        (
            {
                "type": "B21",
                "step": ", NLGEOM",
                "procedure": "DYNAMIC",
                "data": "0.1, 1.\n",
                "section": SECTION + "I\n0., 1., 1., 1., 0.1, 0.1, 0.1",
                "material": "*ELASTIC\n1., 0.3\n*DENSITY\n1.",
            },
            r"NLGEOM is not supported for elements of type B21 whose centroid is beside their nodes; ROTARY INERTIA",
        ),
        (
            {"procedure": "DYNAMIC", "data": "0.1, 1.\n"},
            r"\*DYNAMIC with elements of type B31 needs \*DENSITY, which material M does not have",
        ),
        (
            {"section": CONSTANTS, "data": "1., 1.\n*DLOAD\nALL, GRAV, 1., 0., 0., -1.\n"},
            r"GRAV needs DENSITY=, which \*BEAM GENERAL SECTION \(.*beam\.inp:10\) does not have",
        ),
        (
            {"data": "1., 1.\n*DLOAD\nALL, PYNU, 1.\n"},
            r"PYNU on elements of type B31 is not supported \(supported: BX, BY, BZ, PX, PY, PZ, P1, P2, GRAV\)",
        ),
        (
            {"type": "B21", "data": "1., 1.\n*DLOAD\nALL, P1, 1.\n"},
            r"load type P1 on elements of type B21 is not supported \(supported: BX, BY, PX, PY, P2, GRAV\)",
        ),
        (
            {"data": "1., 1.\n*DSLOAD\nS, P, 1.\n", "section": RECT + "\n*SURFACE, NAME=S\nALL, S1"},
            r"\*SURFACE: elements of type B31 have no face S1 \(faces: none\)",
        ),
        ({"type": "B21", "extra": ", 3"}, r"element 1 has 3 nodes, but B21 needs 2"),
        ({"extra": ", 9"}, r"beam\.inp:\d+: element 1 uses node 9, which is not defined"),
        ({"extra": ", 3, 2"}, r"element 1 has 4 nodes, but B31 needs 2"),
        (
            {"extra": ", 3\n*ELGEN, ELSET=ALL\n1, 2, 1, 1"},
            r"\*ELGEN: element 1 has an additional node that gives n1, which cannot be generated here",
        ),
    ],
)
def test_refused(deck, options, message, tmp_path):
    with pytest.raises(DeckError, match=message):
        uel.run(deck(**options), output_dir=tmp_path)


def test_section_of_another_kind_of_element(deck):
    with pytest.raises(DeckError, match=r"element set ALL holds elements of type T3D2, which take \*SOLID SECTION"):
        read_deck(deck(type="T3D2"))


@pytest.mark.parametrize(
    ("section", "rows"),
    [
        (
            RECT,
            [
                ("profile", "RECT", "0.2, 0.3"),
                ("n1", "0, 0, -1", "approximate"),
                ("E", "100", "*ELASTIC, TYPE=ISOTROPIC"),
                ("nu", "0.25", ""),
            ],
        ),
        (
            CONSTANTS,
            [
                ("profile", "GENERAL", "1, 2, 0, 3, 4"),
                ("n1", "0, 0, -1", "approximate"),
                ("E", "100", ""),
                ("G", "40", ""),
            ],
        ),
    ],
)
def test_report(deck, section, rows):
    (table,) = property_tables(read_deck(deck(section)))
    assert table.rows == rows
