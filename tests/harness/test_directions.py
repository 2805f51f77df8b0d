# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Directions that differ from point to point, in whole jobs: *ORIENTATION by systems, *DISTRIBUTION and ORIENT.

A ring under inner pressure, wound around: cylindrically orthotropic, in plane strain. Its radial displacement is
A r^k + B r^-k with k^2 = C22/C11 (S.G. Lekhnitskii, Anisotropic Plates, 1968, section 28; C in plane strain).
"""

from pathlib import Path

import numpy as np
import pytest
from small_decks import body_lines

from uel.errors import DeckError, KernelError

HERE = Path(__file__).parent
CARRIED = HERE / "elements" / "carried.f"
INNER, OUTER, PRESSURE = 1.0, 2.0, 3.0
C11, C12, C22, C66 = 300.0, 90.0, 1200.0, 120.0
"""Radial, mixed, circumferential, shear stiffness; that along the axis has no part in plane strain."""
CENTRE = np.array([5.0, -3.0])
ALONG, AROUND = 8, 6


def ring():
    """Nodes and quadratic elements of a quarter, numbered across the thickness first."""
    nodes, elements = {}, []
    r, angle = np.linspace(INNER, OUTER, 2 * ALONG + 1), np.linspace(0, np.pi / 2, 2 * AROUND + 1)
    square = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    for j in range(AROUND):
        for i in range(ALONG):
            places = [(2 * i + a, 2 * j + b) for a, b in square]
            elements.append([nodes.setdefault(place, len(nodes)) for place in places])
    points = np.array([[r[i] * np.cos(angle[j]), r[i] * np.sin(angle[j])] for i, j in nodes])
    return points, np.array(elements), list(nodes)


NODES, ELEMENTS, PLACES = ring()
ELASTIC = f"*ELASTIC, TYPE=ORTHOTROPIC\n{C11}, {C12}, {C22}, 0., 0., 500., {C66}, 100.\n100.\n"
ORIENT = """      SUBROUTINE ORIENT(T,NOEL,NPT,LAYER,KSPT,COORDS,BASIS,
     1 ORNAME,NNODES,CNODES,JNNUM)
      INCLUDE 'ABA_PARAM.INC'
      CHARACTER*80 ORNAME
      DIMENSION T(3,3),COORDS(3),BASIS(3,3),CNODES(3,NNODES)
      DIMENSION JNNUM(NNODES)
{}
      END
"""


def deck(orientation, *, step="", material=ELASTIC, type="CPE8R"):
    """The quarter between planes of symmetry, with pressure on its inner edge."""
    connectivity = ELEMENTS if "8" in type else ELEMENTS[:, :4]
    lines = [*body_lines(type, NODES + CENTRE, connectivity), "*ELSET, ELSET=INSIDE, GENERATE"]
    lines += [f"1, {len(ELEMENTS)}, {ALONG}"]
    for name, column in (("LOW", 1), ("LEFT", 0)):
        chosen = np.flatnonzero(abs(NODES[:, column]) < 1e-9) + 1
        lines += [f"*NSET, NSET={name}", *(str(k) for k in chosen)]
    lines += [orientation, "*SOLID SECTION, ELSET=BODY, MATERIAL=WOUND, ORIENTATION=O", "1."]
    lines += ["*MATERIAL, NAME=WOUND", material.rstrip(), f"*STEP{step}", "*STATIC", "1., 1.", "*BOUNDARY"]
    lines += ["LOW, 2", "LEFT, 1", "*DLOAD", f"INSIDE, P4, {PRESSURE}"]
    lines += ["*OUTPUT, FIELD", "*ELEMENT OUTPUT", "S, E", "*NODE OUTPUT", "U", "*END STEP", ""]
    return "\n".join(lines)


def exact(r):
    """Radial displacement at a radius."""
    k = np.sqrt(C22 / C11)
    powers = np.array([k, -k])
    # radial stress -p inside, 0 outside
    rows = [[(C11 * q + C12) * radius ** (q - 1) for q in powers] for radius in (INNER, OUTER)]
    a = np.linalg.solve(rows, [-PRESSURE, 0.0])
    return a @ r ** powers[:, None]


CYLINDRICAL = f"*ORIENTATION, NAME=O, SYSTEM=CYLINDRICAL\n{CENTRE[0]}, {CENTRE[1]}, 0., {CENTRE[0]}, {CENTRE[1]}, 1."
BY_USER = "*ORIENTATION, NAME=O, SYSTEM=USER"
RADIAL = f"""      T(1,1) = 7*(COORDS(1) - {CENTRE[0]})
      T(2,1) = 7*(COORDS(2) - ({CENTRE[1]}))
      T(1,2) = -T(2,1) + T(1,1)
      T(2,2) = T(1,1) + T(2,1)"""


def test_a_wound_ring(run_deck):
    """By its theory: quadratic elements, h/r = 1/16, and reduced integration."""
    result = run_deck(deck(CYLINDRICAL))
    u, r = result.field("U")[:, :2], np.linalg.norm(NODES, axis=1)
    np.testing.assert_allclose((u * NODES).sum(axis=1) / r, exact(r), rtol=1e-3)
    stress = result.field("S11")
    assert np.argmin(stress) % ALONG == 0
    assert stress.min() > -PRESSURE


@pytest.mark.parametrize("step", ["", ", NLGEOM"])
def test_orient_gives_the_same_directions(run_deck, step):
    """T need not be normalised, nor the second direction normal to the first."""
    expected = run_deck(deck(CYLINDRICAL, step=step))
    found = run_deck(deck(BY_USER, step=step), ORIENT.format(RADIAL))
    for name in ("U", "S11", "S22", "S12"):
        np.testing.assert_allclose(found.field(name), expected.field(name), rtol=1e-10, atol=1e-12, err_msg=name)


def test_distributions_by_element(run_deck):
    """Points by element as angles by element; at the points of elements they are a little off."""
    middle = NODES[ELEMENTS[:, :4]].mean(axis=1)
    angles = np.degrees(np.arctan2(middle[:, 1], middle[:, 0]))
    points = ["*DISTRIBUTION TABLE, NAME=T", "coord3d, Coord3D", "*DISTRIBUTION, NAME=D, LOCATION=ELEMENT, TABLE=T"]
    points += [", 1., 0., 0., 0., 1., 0."]
    points += [f"{k}, {c}, {s}, 0., {-s}, {c}, 0." for k, (c, s) in enumerate(middle, 1)]
    points += ["*ORIENTATION, NAME=O", "D", "3, 0."]
    turns = ["*DISTRIBUTION TABLE, NAME=T", "ANGLE", "*DISTRIBUTION, NAME=D, LOCATION=ELEMENT, TABLE=T"]
    turns += [f", {angles[0]}", *(f"{k}, {angle}" for k, angle in enumerate(angles, 1) if k > 1)]
    turns += ["*ORIENTATION, NAME=O", "1., 0., 0., 0., 1., 0.", "3, D"]
    by_points, by_turns = run_deck(deck("\n".join(points))), run_deck(deck("\n".join(turns)))
    for name in ("U", "S11", "S22", "S12"):
        np.testing.assert_allclose(by_points.field(name), by_turns.field(name), rtol=1e-9, atol=1e-12, err_msg=name)
    u, r = by_points.field("U")[:, :2], np.linalg.norm(NODES, axis=1)
    # directions at the ends of an element are off by 7.5 degrees
    np.testing.assert_allclose((u * NODES).sum(axis=1) / r, exact(r), rtol=0.1)


SETS = """*ELSET, ELSET=ALL, GENERATE
1, {last}
*DISTRIBUTION TABLE, NAME=T
ANGLE
*DISTRIBUTION, NAME=D, LOCATION=ELEMENT, TABLE=T
, 0.
ALL, 30.
{last}, 30.
*ORIENTATION, NAME=O
1., 0., 0., 0., 1., 0.
3, D"""


def test_a_distribution_of_equal_values_is_none(run_deck):
    found = run_deck(deck(SETS.format(last=len(ELEMENTS))))
    expected = run_deck(deck("*ORIENTATION, NAME=O\n1., 0., 0., 0., 1., 0.\n3, 30."))
    for name in ("U", "S11", "S22", "S12"):
        np.testing.assert_allclose(found.field(name), expected.field(name), rtol=1e-9, atol=1e-12, err_msg=name)


@pytest.mark.parametrize("step", ["", ", NLGEOM"])
def test_directions_by_element_in_incompatible_modes(run_deck, step):
    """The same everywhere: what one orientation gives, of which the constants are turned beforehand."""
    found = run_deck(deck(SETS.format(last=len(ELEMENTS)), step=step, type="CPE4I"))
    expected = run_deck(deck("*ORIENTATION, NAME=O\n1., 0., 0., 0., 1., 0.\n3, 30.", step=step, type="CPE4I"))
    for name in ("U", "S11", "S22", "S12"):
        np.testing.assert_allclose(found.field(name), expected.field(name), rtol=1e-9, atol=1e-12, err_msg=name)


@pytest.mark.parametrize("step", ["", ", NLGEOM"])
def test_umat_in_the_directions_of_each_point(run_deck, step):
    """With the stiffness of the ring, in radial directions: the same as the built-in material."""
    matrix = np.zeros((4, 4))
    matrix[:2, :2] = [[C11, C12], [C12, C22]]
    matrix[2, 2], matrix[3, 3] = 500.0, C66
    values = [f"{value}" for value in matrix.ravel()]
    lines = [", ".join(values[:8]), ", ".join(values[8:])]
    material = "\n".join(["*USER MATERIAL, CONSTANTS=16", *lines, "*DEPVAR", "39"])
    found = run_deck(deck(CYLINDRICAL, step=step, material=material), CARRIED.read_text().replace("../", f"{HERE}/"))
    expected = run_deck(deck(CYLINDRICAL, step=step))
    for name in ("U", "S11", "S22", "S12"):
        np.testing.assert_allclose(found.field(name), expected.field(name), rtol=1e-8, atol=1e-10, err_msg=name)


def test_arguments_of_orient(run_deck, tmp_path):
    """Of the calls at the start of the analysis, after UEXTERNALDB; one for each point."""
    body = """      WRITE(6,'(A,6I4,1X,A)') 'ORIENT', NOEL, NPT, LAYER, KSPT, NNODES, JNNUM(NNODES), TRIM(ORNAME)
      WRITE(6,'(A,12F10.5)') 'ORIENT', COORDS, CNODES(:,NNODES), BASIS(1,:), BASIS(2,2), BASIS(3,3), T(1,1)
      T(1,1) = 1
      T(2,2) = 1"""
    database = """      SUBROUTINE UEXTERNALDB(LOP,LRESTART,TIME,DTIME,KSTEP,KINC)
      INCLUDE 'ABA_PARAM.INC'
      DIMENSION TIME(2)
      WRITE(6,'(A,I2)') 'ORIENT after', LOP
      END
"""
    run_deck(deck(BY_USER), ORIENT.format(body) + database)
    dat = (tmp_path / "deck.dat").read_text().splitlines()
    printed = [line.split()[1:] for line in dat if line.lstrip().startswith("ORIENT ")]
    count = 4 * len(ELEMENTS)
    assert printed[0] == ["after", "0"]
    assert printed[1 + 2 * count] == ["after", "5"]
    whole, real = printed[1 : 1 + 2 * count : 2], printed[2 : 2 + 2 * count : 2]
    calls = np.array([words[:6] for words in whole], dtype=int)
    expected = [[e + 1, point, 0, 0, 8, ELEMENTS[e, 7] + 1] for e in range(len(ELEMENTS)) for point in (1, 2, 3, 4)]
    np.testing.assert_array_equal(calls, expected)
    assert {words[6] for words in whole} == {"O"}
    reals = np.array(real, dtype=float)
    np.testing.assert_allclose(reals[:, 3:5], np.repeat((NODES + CENTRE)[ELEMENTS[:, 7]], 4, axis=0), atol=1e-5)
    # the four points are around the middle, the first one near the first node
    middle = NODES[ELEMENTS].mean(axis=1) + CENTRE
    np.testing.assert_allclose(reals[:, :2].reshape(-1, 4, 2).mean(axis=1), middle, atol=0.01)
    first = (NODES + CENTRE)[ELEMENTS[:, 0]]
    np.testing.assert_allclose(reals[::4, :2], middle + (first - middle) / np.sqrt(3), atol=0.02)
    np.testing.assert_array_equal(reals[:, [2, 5]], 0)
    np.testing.assert_array_equal(reals[:, 6:], np.tile([1, 0, 0, 1, 1, 0], (len(reals), 1)))


@pytest.mark.parametrize(
    ("body", "error", "message"),
    [
        ("T(1,1) = 1", DeckError, r"element 1 \(type CPE8R\), integration point 1: ORIENT does not set two directions"),
        ("T(1,1) = 1\nT(3,2) = 1", DeckError, r"element 1 \(type CPE8R\), integration point 1: direction 3 must be"),
        ("IF (NOEL.EQ.7.AND.NPT.EQ.3) CALL XIT", KernelError, r"element 7 .*: ORIENT at integration point 3 stopped"),
        pytest.param(
            "T(1,1) = SQRT(-1 - T(1,1))",
            DeckError,
            "ORIENT does not set two directions",
            marks=pytest.mark.nan,
        ),
    ],
    ids=["one direction", "out of the plane", "xit", "no numbers"],
)
def test_orient_without_directions(run_deck, body, error, message):
    lines = "\n".join("      " + line for line in body.split("\n"))
    with pytest.raises(error, match=message):
        run_deck(deck(BY_USER), ORIENT.format(lines))


def test_orient_writes_outside_t(run_deck):
    result = run_deck(deck(BY_USER), ORIENT.format(RADIAL + "\n      T(1,4) = 1"))
    message = "element 1: ORIENT writes outside T: entry 10 of 9 (3 x 3) at integration point 1; the run goes on"
    assert sum(message in text for text in result.warnings) == 1


def test_a_job_without_orient(run_deck):
    message = r"\*ORIENTATION, NAME=O: SYSTEM=USER needs ORIENT; this project's file has UEL"
    with pytest.raises(DeckError, match=message):
        run_deck(deck(BY_USER))


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (", DEFINITION=OFFSET TO NODES\n2, 9", "local node 9, but elements of type CPE8R have 8 nodes"),
        (
            ", DEFINITION=OFFSET TO NODES\n2, 5",
            r"element 1 \(type CPE8R\), integration point 1: the points a, b and c are",
        ),
        (
            ", SYSTEM=CYLINDRICAL\n0., 0., 0., 1., 0., 0.",
            r"element 1 .*, integration point 1: direction 3 must be normal",
        ),
        (
            ", SYSTEM=CYLINDRICAL\n{0}, {1}, 0., {0}, {1}, 1.",
            r"element 8 .*, integration point 4: it is on the polar axis",
        ),
    ],
    ids=["no such node", "collinear", "out of the plane", "on the axis"],
)
def test_elements_without_directions(run_deck, lines, message):
    """The last axis goes through a point of reduced integration, at 1/sqrt(3) of the quadratic shape."""
    x = (NODES[ELEMENTS[7]] + CENTRE)[:, 0], (NODES[ELEMENTS[7]] + CENTRE)[:, 1]
    a = b = 1 / np.sqrt(3)
    corners = (1 + a * np.array([-1, 1, 1, -1])) * (1 + b * np.array([-1, -1, 1, 1])) / 4
    corners *= a * np.array([-1, 1, 1, -1]) + b * np.array([-1, -1, 1, 1]) - 1
    middles = [(1 - a**2) * (1 - b) / 2, (1 + a) * (1 - b**2) / 2, (1 - a**2) * (1 + b) / 2, (1 - a) * (1 - b**2) / 2]
    shape = np.concatenate([corners, middles])
    place = [repr(float(shape @ values)) for values in x]
    with pytest.raises(DeckError, match=rf"\*ORIENTATION, NAME=O: {message}"):
        run_deck(deck("*ORIENTATION, NAME=O" + lines.format(*place)))


UVARM = """      SUBROUTINE UVARM(UVAR,DIRECT,T,TIME,DTIME,CMNAME,ORNAME,NUVARM,
     1 NOEL,NPT,LAYER,KSPT,KSTEP,KINC,NDI,NSHR,COORD,JMAC,JMATYP,
     2 MATLAYO,LACCFLA)
      INCLUDE 'ABA_PARAM.INC'
      CHARACTER*80 CMNAME,ORNAME
      DIMENSION UVAR(NUVARM),DIRECT(3,3)
      UVAR(1:3) = DIRECT(1,:)
      UVAR(4:6) = DIRECT(2,:)
      END
      INCLUDE '%s'
      STATEV(1:2) = DIRECT(1:2,1)
      STATEV(3) = T(1,2)
      END
""" % (HERE / "usdfld.inc")
SQUARE = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPE4, ELSET=E
1, 1, 2, 3, 4
*ORIENTATION, NAME=O
1., 0., 0., 0., 1., 0.
3, 20.
*SOLID SECTION, ELSET=E, MATERIAL=M, ORIENTATION=O
1.
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*DEPVAR
3
*USER DEFINED FIELD
*USER OUTPUT VARIABLES
6
*STEP, NLGEOM
*STATIC, DIRECT
0.5, 1.
*BOUNDARY
1, 1, 2
2, 1, 1, -1.
2, 2, 2, 1.
3, 1, 1, -2.
3, 2
4, 1, 1, -1.
4, 2, 2, -1.
*OUTPUT, FIELD
*ELEMENT OUTPUT
SDV, UVARM
*END STEP
"""


def test_directions_in_uvarm_and_usdfld_turn(run_deck):
    """A square turned by a right angle: halfway it is turned by half of it and smaller. UVARM has the end of the
    increment, USDFLD its start."""
    result = run_deck(SQUARE, UVARM)
    now, then = np.radians(20 + 90), np.radians(20 + 45)
    found = [result.field(f"UVARM{k}")[0] for k in range(1, 7)]
    expected = [np.cos(now), -np.sin(now), 0, np.sin(now), np.cos(now), 0]
    np.testing.assert_allclose(found, expected, atol=1e-12)
    found = [result.field(f"SDV{k}")[0] for k in (1, 2, 3)]
    np.testing.assert_allclose(found, [np.cos(then), np.sin(then), -np.sin(then)], atol=1e-12)
