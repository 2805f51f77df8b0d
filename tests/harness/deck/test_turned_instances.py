# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Vectors that a part gives turn with its instance: the same body is given flat, with all its vectors turned."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import uel
from uel.deck import read_deck

AXIS, ANGLE = np.array([1.0, 2.0, -0.5]), 70.0
TURN = Rotation.from_rotvec(np.radians(ANGLE) * AXIS / np.linalg.norm(AXIS)).as_matrix()
SHIFT = np.array([3.0, -1.0, 2.0])
FORCE = np.array([1.0, -2.0, 0.5])


def moved(points):
    """Translation, then rotation about an axis through the origin (Keywords Guide, *INSTANCE)."""
    return (np.asarray(points, dtype=float) + SHIFT) @ TURN.T


def line(vector, *before):
    return ", ".join([*map(str, before), *(repr(float(x)) for x in vector)]) + "\n"


def deck(body, *, turned, outside=""):
    """A body of one part, placed by *INSTANCE, or flat; body: text by a function of points and one of directions."""
    root, last = "1", "2"
    if turned:
        text = (
            "*PART, NAME=P\n"
            + body(np.asarray, np.asarray)
            + "*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n"
        )
        text += line(SHIFT) + line([*np.zeros(3), *AXIS, ANGLE]) + "*END INSTANCE\n*END ASSEMBLY\n"
        root, last = "I.1", "I.2"
    else:
        text = body(moved, lambda directions: np.asarray(directions, dtype=float) @ TURN.T)
    loads = "".join(line([force], last, dof) for dof, force in enumerate(FORCE, start=1))
    step = f"*STEP\n*STATIC\n1., 1.\n*CLOAD\n{loads}*OUTPUT, FIELD\n*NODE OUTPUT\nU\n*END STEP\n"
    return text + outside + f"*BOUNDARY\n{root}, 1, 6\n" + step


def beam(n1):
    def body(points, directions):
        nodes = points([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0]])
        text = "*NODE\n" + "".join(line(x, k) for k, x in enumerate(nodes, start=1))
        text += "*ELEMENT, TYPE=B31, ELSET=ALL\n1, 1, 2\n*BEAM SECTION, ELSET=ALL, MATERIAL=M, SECTION=RECT\n1., 4.\n"
        # blank stands for 0, 0, -1, which a flat deck cannot leave out
        return text + (line(directions(n1 or [0.0, 0.0, -1.0])) if n1 or points is moved else "")

    return body


def general(points, directions):
    text = beam([0.0, 1.0, 0.0])(points, directions).replace("*BEAM SECTION", "*BEAM GENERAL SECTION")
    return text.replace(", MATERIAL=M", "") + "1000., 400.\n"


def by_node(points, directions):
    """An additional node gives n1."""
    text = beam([0.0, 1.0, 0.0])(points, directions).replace("1, 1, 2\n", "1, 1, 2, 3\n")
    return text + "*NODE\n" + line(points([[5.0, 0.0, 2.0]])[0], 3)


def with_normals(points, directions):
    """*NODE gives n2."""
    text, n2 = beam(None)(points, directions), directions([0.0, np.cos(0.3), np.sin(0.3)])
    rows = text.splitlines(keepends=True)
    rows[1:3] = [f"{row.rstrip()}, {line(n2)}" for row in rows[1:3]]
    return "".join(rows)


MATERIAL = "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.25\n"
CUBE = [[x, y, z] for z in (0.0, 1.0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
FIBRES = "*MATERIAL, NAME=M\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n1000., 100., 50., 0.3, 0.2, 0.25, 40., 30.\n20.\n"


def brick(orientation):
    def body(points, directions):
        nodes = points(CUBE)
        order = [1, 3, 4, 5, 6, 7, 2, 8]
        text = "*NODE\n" + "".join(line(x, k) for k, x in zip(order, nodes, strict=True))
        text += f"*ELEMENT, TYPE=C3D8, ELSET=ALL\n1, {', '.join(map(str, order))}\n"
        text += orientation(points) + "*SOLID SECTION, ELSET=ALL, MATERIAL=M, ORIENTATION=O\n"
        return text

    return body


def rectangular(points):
    # a, b and the origin c are points, so that they move too
    return (
        "*ORIENTATION, NAME=O\n"
        + line(points([[1.0, 0.5, 0.2], [0.0, 1.0, 0.3], [0.1, 0.1, 0.0]]).ravel())
        + "3, 20.\n"
    )


def cylindrical(points):
    return "*ORIENTATION, NAME=O, SYSTEM=CYLINDRICAL\n" + line(points([[3.0, 1.0, 0.0], [3.0, 1.5, 1.0]]).ravel())


def coupled(points, directions):
    """The loaded node 2 moves as the mean of the top."""
    text = brick(rectangular)(points, directions).replace(", 2, 8\n", ", 9, 8\n").replace("\n2, ", "\n9, ")
    text += "*NODE\n" + line(points([[0.4, 0.5, 2.0]])[0], 2) + "*SURFACE, NAME=TOP\nALL, S2\n"
    return text + "*COUPLING, CONSTRAINT NAME=C, REF NODE=2, SURFACE=TOP\n*DISTRIBUTING\n"


HELD = "*BOUNDARY\n{0}3, 1, 3\n{0}4, 1, 3\n{0}5, 1, 3\n"
CASES = {
    "n1": (beam([0.0, 1.0, 0.0]), MATERIAL),
    "oblique n1": (beam([0.0, 0.6, 0.8]), MATERIAL),
    "default n1": (beam(None), MATERIAL),
    "n1 of a general section": (general, ""),
    "additional node": (by_node, MATERIAL),
    "normals of nodes": (with_normals, MATERIAL),
    "orientation": (brick(rectangular), FIBRES),
    "cylindrical orientation": (brick(cylindrical), FIBRES),
    "distributing coupling": (coupled, FIBRES),
}


@pytest.mark.parametrize("name", CASES)
def test_as_flat(tmp_path, name):
    body, material = CASES[name]
    found = []
    for turned in (False, True):
        path = tmp_path / f"{'part' if turned else 'flat'}.inp"
        held = HELD.format("I." if turned else "") if material is FIBRES else ""
        path.write_text(deck(body, turned=turned, outside=material + held))
        found.append(uel.run(path, output_dir=tmp_path).field("U"))
    # one system of equations, but for the rounding of the places
    np.testing.assert_allclose(found[1], found[0], rtol=1e-7, atol=1e-9 * np.abs(found[0]).max())


UPRIGHT = """*PART, NAME=P
*NODE
1, 0., 0., 0.
2, 50., 0., 0.
3, 100., 0., 0.
*ELEMENT, TYPE=B32, ELSET=ALL
1, 1, 2, 3
*BEAM SECTION, ELSET=ALL, MATERIAL=M, SECTION=RECT
1., 4.
0., 0., -1.
*END PART
*ASSEMBLY, NAME=A
*INSTANCE, NAME=I, PART=P
0., 0., 0.
0., 0., 0., 1., 0., 0., 90.
*END INSTANCE
*END ASSEMBLY
*MATERIAL, NAME=M
*ELASTIC
2e5, 0.3
*BOUNDARY
I.1, 1, 6
*STEP
*STATIC
1., 1.
*CLOAD
I.3, 2, 1.
*OUTPUT, FIELD
*NODE OUTPUT
U
*END STEP
"""


def test_flat_beam_stands_upright(tmp_path):
    """It is turned by 90 degrees about its axis; the deflection is F L^3/(3 E I) + F L/(k G A), by Timoshenko."""
    (tmp_path / "beam.inp").write_text(UPRIGHT)
    # the width of 1 is along n1, which is y after the turn
    shear = 2e5 / 2.6
    expected = 100.0**3 / (3 * 2e5 * 4 * 1.0**3 / 12) + 100.0 / (0.85 * shear * 4)
    deflection = uel.run(tmp_path / "beam.inp", output_dir=tmp_path).field("U")[2, 1]
    # slenderness compensation of the shear stiffness: less than the whole part of shear, 8e-5
    assert deflection == pytest.approx(expected, rel=1e-4)


def test_springs_along_global_axes_are_told(run_deck):
    def body(points, directions):
        text = beam([0.0, 1.0, 0.0])(points, directions)
        return text + "*ELEMENT, TYPE=SPRING1, ELSET=S\n2, 2\n*SPRING, ELSET=S\n1\n5.\n"

    warnings = run_deck(deck(body, turned=True, outside=MATERIAL)).warnings
    assert any("dofs 1 are those of the global axes, which do not turn with instance I" in text for text in warnings)


@pytest.mark.parametrize(
    ("constraint", "told"),
    [
        ("*KINEMATIC\n1, 2\n", True),
        ("*KINEMATIC\n1, 3\n", False),
        ("*KINEMATIC\n", False),
        ("*DISTRIBUTING\n4, 5\n", True),
        ("*DISTRIBUTING\n4, 6\n", False),
    ],
)
def test_some_dofs_of_a_coupling_are_told(tmp_path, constraint, told):
    def body(points, directions):
        return coupled(points, directions).replace("*DISTRIBUTING\n", constraint)

    path = tmp_path / "coupling.inp"
    for turned in (True, False):
        path.write_text(deck(body, turned=turned, outside=FIBRES + HELD.format("I." if turned else "")))
        warnings = " ".join(read_deck(path).warnings)
        assert ("are those of the global axes, which do not turn with instance I" in warnings) == (told and turned)
