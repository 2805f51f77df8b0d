# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Properties and nodes of U4, U6, U8 and U12 that are not those of the solids beside them: `uel run` says so."""

import re

import numpy as np
import pytest

from uel.deck.reader import read_deck
from uel.delamination.kernels import uel_property
from uel.elements.interfaces.neighbour_data import compare
from uel.elements.interfaces.neighbour_solids import OBLIQUE
from uel.errors import DeckError
from uel.running.job import run
from uel.usersub.layout import element_layouts

PLY = {"E1": 138e3, "E2": 10.5e3, "E3": 10.5e3, "NU12": 0.3, "NU13": 0.3, "NU23": 0.45, "G12": 6.3e3}
PLY_3D = PLY | {"G13": 6.3e3, "G23": 3.5e3}
LAW = {"SIGMAMAX": 30.0, "TAUMAX": 60.0, "GIC": 0.26, "GIIC": 1.002}
ELASTIC = "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n138000., 10500., 10500., 0.3, 0.3, 0.45, 6300., 6300.\n3500."
FORMULATIONS = {
    kind: {"FORMULATION BOTTOM": number, "FORMULATION TOP": number}
    for kind, number in (("CPS4", 0), ("CPE4", 2), ("C3D8I", 1), ("U1", 0))
}
"""Properties beside solids of a type."""
SQUARE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])


def interface_lines(jtype, nodes, plies, **values):
    """Definition, element 3 and properties of an interface element."""
    layout = element_layouts()[jtype]
    sides = {f"{name} {side}": value for name, value in plies.items() for side in ("BOTTOM", "TOP")}
    return [
        f"*USER ELEMENT, TYPE=U{jtype}, NODES={layout.nodes}, COORDINATES={layout.dimension}, UNSYMM, "
        f"PROPERTIES={len(layout.reals)}, I PROPERTIES={len(layout.integers)}, VARIABLES={layout.svars}",
        "1, 2, 3" if layout.dimension == 3 else "1, 2",
        f"*ELEMENT, TYPE=U{jtype}, ELSET=INTERFACE",
        "3, " + ", ".join(map(str, nodes)),
        *uel_property(
            jtype, "INTERFACE", {**({"THICKNESS": 1.0} if layout.dimension == 2 else {}), **LAW, **sides, **values}
        ),
    ]


def quads(kind="CPE4", orientation="", section="1.", nodes=range(1, 9), step="", **values):
    """Two quads, elements 1 and 2, of nodes 1 to 4 and 5 to 8, with U4 between them."""
    lines = [
        "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n5, 0., 1.\n6, 1., 1.\n7, 1., 2.\n8, 0., 2.",
        "9, 0., -1.\n10, 1., -1.",
        f"*ELEMENT, TYPE={kind}, ELSET=SOLIDS\n1, 1, 2, 3, 4\n2, 5, 6, 7, 8",
        *interface_lines(4, nodes, PLY, **{"PLANE": 1} | FORMULATIONS[kind] | values),
        f"*MATERIAL, NAME=PLY\n{ELASTIC}",
        f"*SOLID SECTION, ELSET=SOLIDS, MATERIAL=PLY{', ORIENTATION=O' if orientation else ''}\n{section}",
        orientation,
        "*BOUNDARY\n1, 1, 2\n2, 2\n9, 1, 2\n10, 1, 2",
        f"*STEP\n*STATIC\n1., 1.\n*BOUNDARY\n8, 2, 2, 1e-4\n7, 2, 2, 1e-4\n{step}\n*END STEP",
    ]
    return re.sub(r"\n+", "\n", "\n".join(lines) + "\n")


def user_quads(tensor="PSTRAIN", thickness=1.0, **values):
    """The same with U1, whose stresses are those of UELMAT."""
    solids = [
        f"*USER ELEMENT, TYPE=U1, NODES=4, COORDINATES=2, PROPERTIES=1, I PROPERTIES=2, VARIABLES=32, INTEGRATION=4, "
        f"TENSOR={tensor}",
        "1, 2",
        "*ELEMENT, TYPE=U1, ELSET=SOLIDS",
    ]
    properties = f"*UEL PROPERTY, ELSET=SOLIDS, MATERIAL=PLY\n{thickness}, {int(tensor == 'PSTRAIN')}, 0"
    text = quads(section="", **FORMULATIONS["U1"] | values).replace(
        "*ELEMENT, TYPE=CPE4, ELSET=SOLIDS", "\n".join(solids)
    )
    return text.replace("*SOLID SECTION, ELSET=SOLIDS, MATERIAL=PLY", properties)


def bricks(axes=None, turned=0.0, **values):
    """Two bricks, elements 1 and 2, with U8 between them; axes of their *ORIENTATION, all turned about y."""
    c, s = np.cos(turned), np.sin(turned)
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    corners = np.vstack([SQUARE + np.array([0.0, 0.0, height]) for height in (0.0, 1.0, 1.0, 2.0)]) @ turn.T
    orientation = (
        [] if axes is None else ["*ORIENTATION, NAME=O", ", ".join(f"{x:.9g}" for x in (axes @ turn.T).ravel())]
    )
    lines = [
        "*NODE",
        *(f"{k}, {x:.12g}, {y:.12g}, {z:.12g}" for k, (x, y, z) in enumerate(corners, 1)),
        "*ELEMENT, TYPE=C3D8I, ELSET=SOLIDS",
        *("1, 1, 2, 3, 4, 5, 6, 7, 8", "2, 9, 10, 11, 12, 13, 14, 15, 16"),
        *interface_lines(8, range(1, 17), PLY_3D, **FORMULATIONS["C3D8I"] | values),
        f"*MATERIAL, NAME=PLY\n{ELASTIC}",
        f"*SOLID SECTION, ELSET=SOLIDS, MATERIAL=PLY{', ORIENTATION=O' if orientation else ''}",
        *orientation,
        "*STEP\n*STATIC\n1., 1.\n*END STEP",
    ]
    return "\n".join(lines) + "\n"


def compared(folder, text):
    """Findings with their weight and their line of the deck."""
    path = folder / "deck.inp"
    path.write_text(text)
    model = read_deck(path)
    lines = path.read_text().splitlines()
    return [(each.message, each.wrong, lines[each.source.line - 1]) for each in compare(model, model.groups)]


def test_data_that_agree_are_not_mentioned(tmp_path):
    assert compared(tmp_path, quads()) == []
    assert compared(tmp_path, quads("CPS4", PLANE=0)) == []
    # constants that plane stress does not use
    assert compared(tmp_path, quads("CPS4", PLANE=0, **{"E3 TOP": 0.0, "NU13 TOP": 0.0, "NU23 BOTTOM": 0.1})) == []
    # the nodes of a side may begin elsewhere; digits that a data sheet rounds
    assert compared(tmp_path, quads(**{"E1 BOTTOM": 138.4e3, "NU12 TOP": 0.305})) == []
    assert compared(tmp_path, bricks()) == []


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0])
@pytest.mark.parametrize("turned", [0.0, 0.4])
def test_plies_that_are_turned(tmp_path, angle, turned):
    """Axis 1 at ANGLE from s: of the deck in *ORIENTATION, of the element in a property."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    axes = np.array([[c, s, 0.0], [-s, c, 0.0]])
    same = {"ANGLE BOTTOM": angle, "ANGLE TOP": angle}
    assert compared(tmp_path, bricks(axes, turned, **same)) == []
    orientation = f"*ORIENTATION, NAME=O\n{c:.9g}, {s:.9g}, 0., {-s:.9g}, {c:.9g}, 0."
    assert compared(tmp_path, quads(orientation=orientation, **same)) == []
    for text in (
        bricks(axes, turned, **same | {"ANGLE TOP": angle + 20.0}),
        quads(orientation=orientation, **same | {"ANGLE TOP": angle + 20.0}),
    ):
        ((message, wrong, _),) = compared(tmp_path, text)
        assert wrong and re.search(rf"at ANGLE TOP = {angle + 20:g}, but the C.* element 2 above", message)


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0])
@pytest.mark.parametrize("turned", [0.0, 0.4, 1.5])
def test_plies_that_are_turned_from_a_direction(tmp_path, angle, turned):
    """At ANGLE from the projection of y, whatever the normal; of a direction in the plane of y and the normal alike."""
    c, s = np.cos(np.radians(90.0 + angle)), np.sin(np.radians(90.0 + angle))
    axes = np.array([[c, s, 0.0], [-s, c, 0.0]])
    same = {"ANGLE BOTTOM": angle, "ANGLE TOP": angle}
    leaning = {"DIRECTION1": 3.0 * np.sin(turned), "DIRECTION2": 2.0, "DIRECTION3": 3.0 * np.cos(turned)}
    for direction in ({"DIRECTION2": 1.0}, {"DIRECTION2": -0.3}, leaning):
        assert compared(tmp_path, bricks(axes, turned, **same, **direction)) == []
        other = same | {"ANGLE TOP": angle + 20.0}
        ((message, wrong, _),) = compared(tmp_path, bricks(axes, turned, **other, **direction))
        assert wrong and re.search(rf"at ANGLE TOP = {angle + 20:g}, but the C.* element 2 above", message)


def test_a_direction_along_the_normal(tmp_path):
    """The element would refuse it: said once, before the run."""
    found = compared(tmp_path, bricks(DIRECTION1=0.02, DIRECTION3=-1.0))
    ((message, wrong, line),) = [each for each in found if "DIRECTION" in each[0]]
    expected = "U8 element 3: DIRECTION1 to DIRECTION3 = 0.02, 0, -1, 1.15 degrees from its normal; expected at least 5"
    assert wrong and message == expected and line.startswith("*UEL PROPERTY")
    assert compared(tmp_path, bricks(DIRECTION1=0.1, DIRECTION3=-1.0)) == []


def tilted(angle, about, degrees):
    """Axes 1 and 2 of a ply at an angle from x whose normal is turned from z about a direction in its plane."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    x, y = np.cos(np.radians(about)), np.sin(np.radians(about))
    k = np.array([[0.0, 0.0, y], [0.0, 0.0, -x], [-y, x, 0.0]])
    turn = np.eye(3) + np.sin(np.radians(degrees)) * k + (1.0 - np.cos(np.radians(degrees))) * k @ k
    return np.array([[c, s, 0.0], [-s, c, 0.0]]) @ turn.T


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0])
@pytest.mark.parametrize("about", [0.0, 45.0, 90.0])
def test_plies_that_are_inclined(tmp_path, angle, about):
    """Up to the angle at which `uel insert` writes them axes are those of the element, beyond it they are not."""
    same = {"ANGLE BOTTOM": angle, "ANGLE TOP": angle}
    for tilt in (0.1, 0.2, 0.3, 0.4, 0.999 * OBLIQUE):
        assert compared(tmp_path, bricks(tilted(angle, about, tilt), **same)) == []
    # about its fibre a ply is almost isotropic
    if abs(np.sin(np.radians(about - angle))) < 0.5:
        return
    for tilt in (2.0, -2.0):
        (first, *others) = compared(tmp_path, bricks(tilted(angle, about, tilt), **same))
        assert first[1] and len(others) == 1 and others[0][1]
        assert re.search(rf"U8 element 3: .*ANGLE BOTTOM = {angle:g}, but the C3D8I element 1 below", first[0])


def test_plies_whose_angle_is_rounded(tmp_path):
    """50.3 for 50: E1 along the axis is less than 1 % smaller."""
    c, s = np.cos(np.radians(50.0)), np.sin(np.radians(50.0))
    solid = bricks(np.array([[c, s, 0.0], [-s, c, 0.0]]), **{"ANGLE BOTTOM": 50.0, "ANGLE TOP": 50.3})
    for text in (solid, quads(**{"ANGLE BOTTOM": 0.3, "ANGLE TOP": -0.3})):
        assert compared(tmp_path, text) == []
    ((message, wrong, _),) = compared(tmp_path, quads(**{"ANGLE TOP": 2.0}))
    # E1 along x is 2.3 % smaller
    assert wrong and re.search(r"E1 TOP = 138000 at ANGLE TOP = 2, but the CPE4 element 2 above .* has 134831", message)
    ((message, wrong, _),) = compared(tmp_path, quads(**{"ANGLE TOP": 1.0}))
    assert wrong and re.search(r": ANGLE TOP = 1, but the CPE4 element 2 above .* along other axes$", message)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (
            {"E1 BOTTOM": 13.8e3},
            r"U4 element 3: E1 BOTTOM = 13800 at ANGLE BOTTOM = 0, but the CPE4 element 1 below \(.*deck.inp:\d+\) has "
            r"138000 there \(material PLY\)$",
        ),
        ({"G12 TOP": 5e3}, r"G12 TOP = 5000 at ANGLE TOP = 0, but the CPE4 element 2 above .* has 6300 there"),
        ({"NU23 TOP": 0.3}, r"NU23 TOP = 0.3 at .* has 0.45 there"),
        ({"E3 BOTTOM": 138e3}, r"E3 BOTTOM = 138000 at .* has 10500 there"),
    ],
)
def test_moduli_that_differ_are_wrong(tmp_path, values, message):
    ((found, wrong, line),) = compared(tmp_path, quads(**values))
    assert re.search(message, found)
    assert wrong and line.startswith("*UEL PROPERTY")


def test_axes_that_differ_from_element_to_element(tmp_path):
    """Circles about a point far to the left and below run at 30 degrees through the middle of the interface."""
    far = 1e4
    place = f"{0.5 - far * np.sin(np.radians(30.0)):.9g}, {1.0 + far * np.cos(np.radians(30.0)):.9g}"
    orientation = f"*ORIENTATION, NAME=O, SYSTEM=CYLINDRICAL\n{place}, 0., {place}, 1."
    # axis 1 is radial
    assert compared(tmp_path, quads(orientation=orientation, **{"ANGLE BOTTOM": -60.0, "ANGLE TOP": 120.0})) == []
    ((message, wrong, _),) = compared(tmp_path, quads(orientation=orientation, **{"ANGLE BOTTOM": -60.0}))
    assert wrong and re.search(r"E1 TOP = 138000 at ANGLE TOP = 0, but the CPE4 element 2 above", message)


def test_axes_of_user_bricks_are_not_known(tmp_path):
    """U9 has its material along its own faces: one warning for each side, and none for an isotropic material."""
    layout = element_layouts()[9]
    solids = [
        f"*USER ELEMENT, TYPE=U9, NODES=8, COORDINATES=3, PROPERTIES=4, I PROPERTIES=2, VARIABLES={layout.svars}, "
        "INTEGRATION=8, TENSOR=THREED",
        "1, 2, 3",
        "*ELEMENT, TYPE=U9, ELSET=SOLIDS",
    ]
    properties = "*UEL PROPERTY, ELSET=SOLIDS, MATERIAL=PLY\n0., 0., 0., 0., 1, 0"
    text = bricks().replace("*ELEMENT, TYPE=C3D8I, ELSET=SOLIDS", "\n".join(solids))
    text = text.replace("*SOLID SECTION, ELSET=SOLIDS, MATERIAL=PLY", properties)
    found = compared(tmp_path, text)
    assert [wrong for _, wrong, _ in found] == [False, False]
    assert re.match(
        r"U8 element 3: its elastic constants are not compared with those of the U9 element 1 below "
        r"\(.*deck.inp:\d+\): UELMAT may have directions of its own$",
        found[0][0],
    )
    found = compared(tmp_path, text.replace(ELASTIC, "*ELASTIC\n138000., 0.3"))
    assert len(found) == 2 and all(wrong and "E2 " in message for message, wrong, _ in found)


def test_moduli_of_bricks(tmp_path):
    ((found, wrong, _),) = compared(tmp_path, bricks(**{"G23 TOP": 6.3e3}))
    assert wrong and re.search(r"U8 element 3: G23 TOP = 6300 at .* C3D8I element 2 above .* has 3500 there", found)


@pytest.mark.parametrize(("kind", "plane"), [("CPE4", 0), ("CPS4", 1)])
def test_the_other_state_of_stress_is_wrong(tmp_path, kind, plane):
    found = compared(tmp_path, quads(kind, PLANE=plane))
    assert [wrong for _, wrong, _ in found] == [True, True]
    mine, theirs = ("plane stress", "plane strain") if plane == 0 else ("plane strain", "plane stress")
    assert re.match(
        rf"U4 element 3: PLANE = {plane}, {mine}, but the {kind} element 1 below .* is in {theirs}$", found[0][0]
    )


def test_another_thickness_is_doubtful(tmp_path):
    """A groove along the sides makes the interface narrower."""
    found = compared(tmp_path, quads(section="20."))
    assert [wrong for _, wrong, _ in found] == [False, False]
    assert re.match(r"U4 element 3: THICKNESS = 1, but the CPE4 element 1 below .* has a thickness of 20$", found[0][0])


@pytest.mark.parametrize(("tensor", "plane"), [("PSTRAIN", 1), ("PSTRESS", 0)])
def test_state_of_stress_and_thickness_of_user_solids(tmp_path, tensor, plane):
    assert compared(tmp_path, user_quads(tensor, PLANE=plane)) == []
    found = compared(tmp_path, user_quads(tensor, PLANE=1 - plane))
    names = ("plane stress", "plane strain")
    assert [wrong for _, wrong, _ in found] == [True, True]
    assert re.match(
        rf"U4 element 3: PLANE = {1 - plane}, {names[1 - plane]}, but the U1 element 1 below .* is in {names[plane]}$",
        found[0][0],
    )
    found = compared(tmp_path, user_quads(tensor, 20.0, PLANE=plane))
    assert [wrong for _, wrong, _ in found] == [False, False]
    assert re.match(r"U4 element 3: THICKNESS = 1, but the U1 element 1 below .* has a thickness of 20$", found[0][0])


def test_nodes_of_another_row_are_wrong(tmp_path):
    ((found, wrong, line),) = compared(tmp_path, quads(nodes=(9, 10, 3, 4, 5, 6, 7, 8)))
    assert wrong and line == "3, 9, 10, 3, 4, 5, 6, 7, 8"
    assert found == (
        "U4 element 3: its nodes 1 to 4 are 9, 10, 3, 4, but CPE4 element 1 below, on its bottom face, has 1, 2, 3, 4; "
        "expected the nodes of the solid"
    )


def test_meshes_that_do_not_fit_are_doubtful_and_rigid_bodies_are_not_mentioned(tmp_path):
    triangles = quads().replace("1, 1, 2, 3, 4\n", "1, 1, 2, 9, 4\n", 1)
    ((found, wrong, _),) = compared(tmp_path, triangles)
    assert not wrong and found.endswith(
        "its nodes 1 to 4 are 1, 2, 3, 4, but no solid has these nodes: the meshes do not fit"
    )
    assert compared(tmp_path, quads().replace("1, 1, 2, 3, 4\n", "", 1)) == []


def test_a_job_is_refused_with_all_reasons(tmp_path):
    deck = tmp_path / "deck.inp"
    deck.write_text(quads(nodes=(9, 10, 3, 4, 5, 6, 7, 8), **{"E1 TOP": 13.8e3}))
    with pytest.raises(DeckError, match=r"deck.inp:\d+: U4 element 3: its nodes 1 to 4 are 9, 10, 3, 4") as caught:
        run(deck, output_dir=tmp_path)
    assert any("E1 TOP = 13800" in note for note in caught.value.__notes__)


def test_another_expansion_is_wrong_where_the_temperature_changes(tmp_path):
    """Heated, a free block has tractions from -4 to 28 MPa with U4 that does not expand, where 0 is right."""
    expanding = f"{ELASTIC}\n*EXPANSION, TYPE=ORTHO\n1e-6, 2e-5, 3e-5"
    heated = quads(step="*TEMPERATURE\n8, 100.").replace(ELASTIC, expanding)
    deck = tmp_path / "deck.inp"
    deck.write_text(heated)
    expected = (
        r"U4 element 3: EXPANSION1 TOP = 0, but the CPE4 element 2 above .* has 1e-06 there .*temperature changes"
    )
    with pytest.raises(DeckError, match=expected):
        run(deck, output_dir=tmp_path)
    assert compared(tmp_path, heated.replace("8, 100.", "9, 100.")) == []
    given = {f"EXPANSION{k} {side}": a for side in ("BOTTOM", "TOP") for k, a in ((1, 1e-6), (2, 2e-5), (3, 3e-5))}
    agreeing = quads(step="*TEMPERATURE\n8, 100.", **given).replace(ELASTIC, expanding)
    assert compared(tmp_path, agreeing) == []


@pytest.mark.parametrize(("kind", "mine", "wrong"), [("C3D8R", 1, True), ("C3D8", 1, False), ("C3D8I", 3, True)])
def test_another_formulation(tmp_path, kind, mine, wrong):
    """Ahead of a crack tractions are 43.3, -7.7, +6.1, -5.8, -6.6 MPa beside C3D8R with that of full integration."""
    names = ["full integration", "incompatible modes", "the mean volume strain", "reduced integration"]
    theirs = {"C3D8R": 3, "C3D8": 2, "C3D8I": 1}[kind]
    text = bricks(**{"FORMULATION BOTTOM": mine, "FORMULATION TOP": theirs}).replace("C3D8I", kind)
    ((found, weight, _),) = compared(tmp_path, text)
    assert weight == wrong
    assert re.match(
        rf"U8 element 3: FORMULATION BOTTOM = {mine}, {names[mine]}, but the {kind} element 1 below .* has "
        rf"{names[theirs]}; expected {theirs}$",
        found,
    )


def test_a_job_with_another_formulation_is_refused(tmp_path):
    deck = tmp_path / "deck.inp"
    deck.write_text(bricks().replace("C3D8I", "C3D8R"))
    with pytest.raises(DeckError, match="U8 element 3: FORMULATION BOTTOM = 1, incompatible modes, but the C3D8R"):
        run(deck, output_dir=tmp_path)


def test_doubts_are_warnings(tmp_path):
    deck = tmp_path / "deck.inp"
    deck.write_text(quads(section="20."))
    result = run(deck, output_dir=tmp_path)
    assert any(re.search(r"deck.inp:\d+: U4 element 3: THICKNESS = 1", text) for text in result.warnings)


def test_elements_say_once_that_their_temperature_changes(tmp_path):
    """In Abaqus nobody else does. Here the plies do not expand either, and the job runs."""
    deck = tmp_path / "deck.inp"
    deck.write_text(quads(step="*TEMPERATURE\n8, 100.").replace("*STATIC\n1.,", "*STATIC\n0.5,"))
    result = run(deck, output_dir=tmp_path)
    found = [text for text in result.warnings if "temperature" in text]
    assert len(found) == 1
    assert re.search(
        r"U4 element 3: the temperature of its node 8 changes by 50.*, to 50.*, and its solids do not expand: "
        r"give EXPANSION1 BOTTOM to EXPANSION3 TOP if the plies do",
        found[0],
    )
    # a temperature that stays
    initial = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\n8, 100.\n"
    deck.write_text(deck.read_text().replace("*STEP", f"{initial}*STEP", 1))
    assert not any("temperature" in text for text in run(deck, output_dir=tmp_path).warnings)
