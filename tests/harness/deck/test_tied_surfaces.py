# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*TIE of meshes that do not match, and of the two sides of a sector with cyclic symmetry."""

import numpy as np
import pytest
from contact_decks import YOUNG, Box
from reference_cells import nodes_of
from scipy.spatial.transform import Rotation
from small_decks import body_lines

from uel.deck import read_deck
from uel.errors import DeckError
from uel.model.element_types import BUILT_IN


def read(tmp_path, text):
    (tmp_path / "deck.inp").write_text(text)
    return read_deck(tmp_path / "deck.inp")


# ------------------------------------------------------------ meshes that do not match


def tied(lower, upper, steps, *, tie="TYPE=NODE TO SURFACE", model=""):
    """UPPER, whose lower side is the first surface, on LOWER."""
    lines = ["*HEADING", "two bodies", *lower.lines(), *upper.lines(), "*MATERIAL, NAME=M", f"*ELASTIC\n{YOUNG}, 0.3"]
    return (
        "\n".join([*lines, f"*TIE, NAME=T, {tie}\nUPPER_LOW, LOWER_HIGH", model, *steps]).replace("\n\n", "\n") + "\n"
    )


def boxes(kind, lower, upper, gap=0.0):
    """Two boxes of height 1 with so many elements along their common side."""
    flat = len(lower) == 1
    low, high = ((0, 0), (2, 1)) if flat else ((0, 0, 0), (2, 1, 1))
    raised = np.array([0] * len(lower) + [1 + gap])
    return (
        Box("LOWER", kind, low, high, (*lower, 1)),
        Box("UPPER", kind, low + raised, high + raised, (*upper, 2), first=1001),
    )


GRADIENT = 1e-3 * np.array([[1.0, 0.4, -0.2], [0.3, -0.7, 0.5], [-0.6, 0.2, 0.8]])


@pytest.mark.parametrize(
    ("kind", "lower", "upper"), [("CPE4", (2,), (6,)), ("C3D8", (2, 1), (4, 3)), ("CPS4", (1,), (1,))]
)
def test_patch(run_deck, kind, lower, upper):
    """Where each face of the second surface is cut by the first one, displacements are continuous: any state of
    constant strain passes.
    """
    bodies = boxes(kind, lower, upper)
    d = bodies[0].nodes.shape[1]
    given = []
    for body in bodies:
        outer = (body.nodes <= 1e-9) | (body.nodes >= [*([2, 1, 2][: d - 1]), 2])
        for node in np.flatnonzero(outer.any(axis=1)).tolist():
            if body is bodies[1] and body.nodes[node, -1] <= 1.0:
                continue
            u = GRADIENT[:d, :d] @ body.nodes[node]
            given += [f"{body.first + node}, {k + 1}, {k + 1}, {u[k]!r}" for k in range(d)]
    step = "\n".join(["*STEP\n*STATIC\n1., 1.", "*BOUNDARY", *given, "*OUTPUT, FIELD\n*END STEP"])
    result = run_deck(tied(*bodies, [step.replace("np.float64(", "").replace(")", "")]))
    x = result.mesh().points
    expected = x[:, :d] @ GRADIENT[:d, :d].T
    np.testing.assert_allclose(result.field("U")[:, :d], expected, atol=1e-12)


@pytest.mark.parametrize(("kind", "lower", "upper"), [("CPE4", (3,), (5,)), ("C3D8", (2, 3), (3, 2))])
def test_linear_fields(tmp_path, kind, lower, upper):
    """The nodes of any mesh follow a linear field of the second surface exactly."""
    (tmp_path / "deck.inp").write_text(tied(*boxes(kind, lower, upper), ["*STEP\n*STATIC\n1., 1.\n*END STEP"]))
    model = read_deck(tmp_path / "deck.inp")
    points = model.mesh.coordinates
    assert len(model.equations) == np.prod([n + 1 for n in upper]) * (len(upper) + 1)
    for equation in model.equations:
        (first, dof, one), *others = equation.terms
        assert one == 1.0
        assert {k for _, k, _ in others} == {dof}
        shares = np.array([-share for _, _, share in others])
        assert shares.sum() == pytest.approx(1.0, abs=1e-12)
        assert (shares > 0.0).all()
        np.testing.assert_allclose(shares @ points[[node for node, _, _ in others]], points[first], atol=1e-9)


def line3(r):
    return np.array([r * (r - 1) / 2, r * (r + 1) / 2, 1 - r**2])


def triangle6(r, s):
    t = 1 - r - s
    return np.array([t * (2 * t - 1), r * (2 * r - 1), s * (2 * s - 1), 4 * r * t, 4 * r * s, 4 * s * t])


def quad8(r, s):
    corners = [(1 + r * a) * (1 + s * b) * (r * a + s * b - 1) / 4 for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    along, across = (1 - r**2) / 2, (1 - s**2) / 2
    return np.array([*corners, along * (1 - s), across * (1 + r), along * (1 + s), across * (1 - r)])


@pytest.mark.parametrize(
    ("kind", "cell", "face", "functions"),
    [
        ("CPE8", "quad8", 3, line3),
        ("CPE6", "triangle6", 2, line3),
        ("C3D10", "tetra10", 3, triangle6),
        ("C3D20R", "hexahedron20", 2, quad8),
        ("C3D15", "wedge15", 1, triangle6),
        ("C3D15", "wedge15", 4, quad8),
    ],
)
def test_faces_with_middle_nodes(tmp_path, kind, cell, face, functions):
    """Nodes on curved faces have the shares of their shape functions.

    (O.C. Zienkiewicz, R.L. Taylor, The Finite Element Method: quadratic line, triangle and serendipity quadrilateral.)
    """
    family = BUILT_IN[kind].family
    nodes = nodes_of(cell)
    d, local = nodes.shape[1], family.faces[face - 1]
    rng = np.random.default_rng(1)
    nodes[family.corners :] += 0.05 * rng.standard_normal(nodes[family.corners :].shape)
    natural = rng.uniform(0.05, 0.4, (6, d - 1))
    expected = np.array([functions(*place) for place in natural])
    points = expected @ nodes[list(local)]
    lines = [*body_lines(kind, nodes, [range(len(nodes))]), "*NODE, NSET=FREE"]
    lines += [", ".join(map(repr, [100 + k, *x])) for k, x in enumerate(points.tolist())]
    lines += ["*ELEMENT, TYPE=MASS, ELSET=POINTS", *(f"{200 + k}, {100 + k}" for k in range(len(points)))]
    lines += [
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M",
        "",
        "*MATERIAL, NAME=M\n*ELASTIC\n1., 0.",
        "*MASS, ELSET=POINTS\n1.",
    ]
    lines += [f"*SURFACE, NAME=FACE\nBODY, S{face}", "*SURFACE, NAME=DOTS, TYPE=NODE\nFREE"]
    lines += ["*TIE, NAME=T, POSITION TOLERANCE=1e-6\nDOTS, FACE", "*STEP\n*STATIC\n1., 1.\n*END STEP"]
    (tmp_path / "deck.inp").write_text("\n".join(lines) + "\n")
    equations = read_deck(tmp_path / "deck.inp").equations
    assert len(equations) == len(points) * d
    for k, shares in enumerate(expected):
        for equation in equations[k * d : (k + 1) * d]:
            found = np.zeros(len(nodes))
            for node, _, share in equation.terms[1:]:
                found[node] -= share
            np.testing.assert_allclose(found[list(local)], shares, atol=1e-7)


PULL = "*STEP\n*STATIC\n1., 1.\n*BOUNDARY\nUPPER_TOP, 2, 2, 0.01\n*OUTPUT, FIELD\n*END STEP"


def test_both_sides_held(run_deck, tmp_path):
    """A line of symmetry through both bodies: its nodes are held on both surfaces, and the ties say nothing more."""
    held = "*BOUNDARY\nLOWER_BOTTOM, 2\nLOWER_LEFT, 1\nUPPER_LEFT, 1"
    result = run_deck(tied(*boxes("CPS4", (2,), (6,)), [PULL], tie="TYPE=SURFACE TO SURFACE", model=held))
    np.testing.assert_allclose(result.field("S22"), YOUNG * 0.005, rtol=1e-9)
    text = " ".join((tmp_path / "deck.dat").read_text().split())
    assert "*TIE: nodes follow means of the main surface over their faces, which pass constant stress" in text


@pytest.mark.parametrize("adjust", ["YES", "NO"])
def test_gap_within_the_tolerance(run_deck, adjust):
    """ADJUST=YES, the default, closes a gap without strain; else the bodies move as if there was none."""
    held = "*BOUNDARY\nLOWER_BOTTOM, 2\nLOWER_LEFT, 1"
    tie = "TYPE=NODE TO SURFACE" + ("" if adjust == "YES" else ", ADJUST=NO")
    result = run_deck(tied(*boxes("CPS4", (2,), (6,), gap=1e-3), [PULL], tie=tie, model=held))
    height = 2.001 if adjust == "YES" else 2.0
    np.testing.assert_allclose(result.field("S22"), YOUNG * 0.01 / height, rtol=1e-9)


# ------------------------------------------------------------ cyclic symmetry

SECTORS, RINGS, CUTS = 9, 3, 4
ANGLE = 2 * np.pi / SECTORS


def annulus(sectors, *, layers=1, centre=False):
    """Nodes (n, 3), elements, and node numbers (rings, cuts, layers) of some sectors, whose sides are spirals.

    All sectors close, with common nodes. `centre`: triangles fill the hole, in the plane.
    """
    closed = sectors == SECTORS
    count = sectors * CUTS + (not closed)
    radius = 1.0 + np.arange(RINGS + 1) / RINGS
    angle = np.arange(count) * ANGLE / CUTS
    r, phi, z = np.meshgrid(radius, angle, np.arange(layers + 1) * 0.5, indexing="ij")
    phi = phi + 0.4 * (r - 1.0) + 0.3 * z
    nodes = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1).reshape(-1, 3)
    numbers = np.arange(len(nodes)).reshape(r.shape)
    following = np.roll(numbers, -1, axis=1) if closed else numbers[:, 1:]
    own = numbers if closed else numbers[:, :-1]
    around = [own[:-1], own[1:], following[1:], following[:-1]]
    if layers:
        around = [part[:, :, k : k + layers] for k in (0, 1) for part in around]
    elements = np.stack([part[..., :layers] if layers else part[..., 0] for part in around], axis=-1)
    elements = elements.reshape(-1, len(around))
    triangles = []
    if centre:
        nodes = np.concatenate([nodes, np.zeros((1, 3))])
        inner = zip(own[0, :, 0].tolist(), following[0, :, 0].tolist(), strict=True)
        triangles = [[len(nodes) - 1, a, b] for a, b in inner]
    return nodes, elements, numbers, triangles


def sector_deck(nodes, elements, numbers, triangles, *, kind, place, loads, held, nlgeom, cyclic):
    """place: turns and shifts the whole; loads (force, node) and held nodes by their numbers."""
    turn, shift = place
    lines = body_lines(kind, nodes @ turn.T + shift, elements)
    if triangles:
        lines += ["*ELEMENT, TYPE=CPS3, ELSET=BODY"]
        lines += [", ".join(map(str, [5001 + k, *(n + 1 for n in row)])) for k, row in enumerate(triangles)]
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "1.", "*MATERIAL, NAME=M", f"*ELASTIC\n{YOUNG}, 0.3"]
    if cyclic:
        # sides of the sector by the nodes on them
        for name, side in (("FIRST", numbers[:, 0]), ("LAST", numbers[:, -1])):
            chosen = [*side.ravel().tolist(), *([len(nodes) - 1] if triangles else [])]
            lines += [f"*NSET, NSET={name}", *(f"{k + 1}," for k in chosen)]
            lines.append(f"*SURFACE, NAME={name}, TYPE=NODE\n{name}")
        ends = np.concatenate([shift, shift + turn[:, 2] * 3.0]).tolist()
        lines += ["*TIE, NAME=T, CYCLIC SYMMETRY\nLAST, FIRST", f"*CYCLIC SYMMETRY MODEL, N={SECTORS}"]
        lines.append(", ".join(map(repr, ends if kind == "C3D8" else ends[:2])))
    dofs = 3 if kind == "C3D8" else 2
    lines += ["*BOUNDARY", *(f"{k + 1}, 1, {dofs}" for k in held)] if held else []
    lines += [f"*STEP{', NLGEOM' if nlgeom else ''}\n*STATIC\n0.5, 1.", "*CLOAD"]
    lines += [
        f"{node + 1}, {k + 1}, {float(value)!r}"
        for force, node in loads
        for k, value in enumerate((turn @ force)[:dofs])
    ]
    return "\n".join([*lines, "*OUTPUT, FIELD\n*END STEP"]) + "\n"


SKEW = Rotation.from_rotvec([0.5, -0.8, 0.3]).as_matrix(), np.array([3.0, -2.0, 1.0])
IN_PLANE = np.eye(3), np.array([3.0, -2.0, 0.0])


@pytest.mark.parametrize("nlgeom", [False, True])
@pytest.mark.parametrize("shape", ["in space", "in the plane", "with a centre"])
def test_sector_is_that_of_the_whole(run_deck, shape, nlgeom):
    """One sector moves as each of the nine of the whole under loads that repeat themselves, radial and round the axis.

    Held is the inner side, or, with a centre, the first node of the outer side of each sector.
    """
    space, centre = shape == "in space", shape == "with a centre"
    kind, place = ("C3D8", SKEW) if space else ("CPS4", IN_PLANE)
    force = np.array([3.0, 6.0, 2.0 if space else 0.0])
    found = []
    for sectors in (1, SECTORS):
        nodes, elements, numbers, triangles = annulus(sectors, layers=int(space), centre=centre)
        loads = []
        for k in range(sectors):
            node = int(numbers[-1, k * CUTS + 2, -1])
            x, y, _ = nodes[node]
            radial = np.array([[x, -y, 0.0], [y, x, 0.0], [0.0, 0.0, np.hypot(x, y)]]) / np.hypot(x, y)
            loads.append((radial @ force, node))
        held = (numbers[-1, ::CUTS] if centre else numbers[0]).ravel().tolist()
        text = sector_deck(
            nodes,
            elements,
            numbers,
            triangles,
            kind=kind,
            place=place,
            loads=loads,
            held=held,
            nlgeom=nlgeom,
            cyclic=sectors == 1,
        )
        result = run_deck(text, name=f"sectors{sectors}")
        own = numbers[:, :CUTS].ravel()
        found.append(result.field("U")[own])
    assert np.abs(found[1]).max() > 1e-3
    np.testing.assert_allclose(found[0], found[1], atol=1e-9 * np.abs(found[1]).max())


def test_modes_of_a_sector_are_refused(run_deck):
    """They differ from sector to sector."""
    nodes, elements, numbers, triangles = annulus(1, layers=0)
    given = {"kind": "CPS4", "place": IN_PLANE, "loads": [], "held": [], "nlgeom": False, "cyclic": True}
    text = sector_deck(nodes, elements, numbers, triangles, **given)
    text = text[: text.index("*STEP")].replace("*ELASTIC", "*DENSITY\n1.\n*ELASTIC")
    message = r"deck\.inp:\d+: \*TIE: CYCLIC SYMMETRY is not supported with \*FREQUENCY \(.*deck\.inp:\d+\)"
    with pytest.raises(DeckError, match=message):
        run_deck(text + "*STEP\n*FREQUENCY\n2,\n*END STEP\n")


MODEL = "*CYCLIC SYMMETRY MODEL, N=9\n3.0, -2.0"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (MODEL, "", r"\*TIE: CYCLIC SYMMETRY needs \*CYCLIC SYMMETRY MODEL"),
        (", CYCLIC SYMMETRY\n", "\n", r"\*CYCLIC SYMMETRY MODEL: no \*TIE has CYCLIC SYMMETRY"),
        (MODEL, f"{MODEL}\n{MODEL}", r"\*CYCLIC SYMMETRY MODEL: the model has one already, at .*deck\.inp:\d+"),
        ("N=9", "N=0", r"\*CYCLIC SYMMETRY MODEL: N=0: expected at least one sector"),
        (MODEL, "*CYCLIC SYMMETRY MODEL, N=9", r"needs a data line with the points a and b of the axis"),
        (
            "N=9",
            "N=8",
            r"no node of the first surface is within .* of the second one; expected surfaces that touch",
        ),
        ("*NSET, NSET=LAST\n", "*NSET, NSET=LAST\n1,\n", r"node 1 is on both surfaces, but not on the axis"),
    ],
)
def test_wrong_sectors(run_deck, old, new, message):
    nodes, elements, numbers, triangles = annulus(1, layers=0)
    given = {"kind": "CPS4", "place": IN_PLANE, "loads": [], "held": [], "nlgeom": False, "cyclic": True}
    text = sector_deck(nodes, elements, numbers, triangles, **given)
    assert old in text
    with pytest.raises(DeckError, match=rf"deck\.inp:\d+: .*{message}"):
        run_deck(text.replace(old, new))


def test_axis_of_one_point(run_deck):
    nodes, elements, numbers, triangles = annulus(1)
    given = {"kind": "C3D8", "place": SKEW, "loads": [], "held": [], "nlgeom": False, "cyclic": True}
    text = sector_deck(nodes, elements, numbers, triangles, **given)
    line = next(line for line in text.splitlines() if line.startswith("3.0, -2.0, 1.0, "))
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: .*points a and b of the axis are the same"):
        run_deck(text.replace(line, "3.0, -2.0, 1.0, 3.0, -2.0, 1.0"))


APART = ("CPS4", (2,), (6,), 0.5)


@pytest.mark.parametrize("kind", ["ELEMENT", "NODE"])
def test_surfaces_apart(run_deck, kind):
    """No node is within 5 % of the edge of a main face, or of the distance of its nodes, which are 1."""
    text = tied(*boxes(*APART), [PULL])
    if kind == "NODE":
        text = text.replace("LOWER_HIGH, S3", "LOWER_TOP").replace("NAME=LOWER_HIGH\n", "NAME=LOWER_HIGH, TYPE=NODE\n")
    message = (
        r"no node of the first surface is within 0\.05 of the second one; expected surfaces that touch, or a larger"
    )
    with pytest.raises(DeckError, match=rf"deck\.inp:\d+: \*TIE: {message} POSITION TOLERANCE"):
        run_deck(text)


@pytest.mark.parametrize(
    ("option", "message"),
    [
        ("TIED NSET=UPPER_BOTTOM, POSITION TOLERANCE=1.", "POSITION TOLERANCE and TIED NSET exclude each other"),
        ("TIED NSET=NONE", "unknown node set NONE"),
        ("TIED NSET=UPPER_TOP", r"\*TIE: no node of the first surface is in TIED NSET"),
    ],
)
def test_wrong_options(run_deck, option, message):
    with pytest.raises(DeckError, match=message):
        run_deck(tied(*boxes(*APART), [PULL], tie=option))


@pytest.mark.parametrize("tie", ["TYPE=NODE TO SURFACE", "TYPE=SURFACE TO SURFACE"])
def test_nodes_far_away_stay_untied(run_deck, tmp_path, tie):
    """The lower surface reaches beyond the upper one: its node 6 is free, as without the tie (nu = 0)."""
    lower = Box("LOWER", "CPS4", (0, 0), (2, 1), (2, 1))
    upper = Box("UPPER", "CPS4", (0, 1), (1, 2), (1, 1), first=1001)
    held = "*BOUNDARY\nLOWER_BOTTOM, 1, 2\nUPPER_TOP, 1"
    text = tied(lower, upper, [PULL], tie=tie, model=held).replace("UPPER_LOW, LOWER_HIGH", "LOWER_HIGH, UPPER_LOW")
    found = run_deck(text)
    untied = next(k for k, x in enumerate(lower.nodes) if x.tolist() == [2.0, 1.0]) + 1
    message = f"*TIE: nodes of the first surface farther than 0.05 from the second one stay untied: {untied}"
    assert any(warning.endswith(message) for warning in found.warnings)
    assert any("stay untied" in line for line in (tmp_path / "deck.dat").read_text().splitlines())
    moved = found.field("U")
    # the other two nodes are tied: one mesh with common nodes gives the same
    joined = text.replace(f"*TIE, NAME=T, {tie}\nLOWER_HIGH, UPPER_LOW", "*MPC\nTIE, 1001, 2\nTIE, 1003, 4")
    assert joined != text
    np.testing.assert_allclose(moved, run_deck(joined).field("U"), atol=1e-12)


@pytest.mark.parametrize("gap", [0.5, 500.0])
def test_tied_nset(run_deck, gap):
    """Its nodes are tied whatever their distance, and no others."""
    held = "*BOUNDARY\nLOWER_BOTTOM, 2\nLOWER_LEFT, 1"
    result = run_deck(tied(*boxes(*APART[:3], gap), [PULL], tie="TIED NSET=UPPER_BOTTOM, ADJUST=NO", model=held))
    np.testing.assert_allclose(result.field("S22"), YOUNG * 0.005, rtol=1e-9)


def test_face_whose_area_is_lost_in_rounding(tmp_path):
    """A node so far away that the sides of its face are parallel in floating-point numbers: a node is tied within the
    tolerance, or stays untied with a warning.
    """
    lower, upper = boxes("C3D8", (1, 1), (1, 1))
    tie = "TYPE=NODE TO SURFACE, POSITION TOLERANCE=0.01, ADJUST=NO"
    text = tied(lower, upper, ["*STEP\n*STATIC\n*END STEP"], tie=tie)
    far = text.replace("\n8, 2.0, 1.0, 1.0", "\n8, 2147483647., 1.0, 1.0")
    assert far != text
    model = read(tmp_path, far)
    points, nodes = model.mesh.coordinates, set()
    for equation in model.equations:
        (first, dof, _), *others = equation.terms
        nodes.add(first)
        at = -sum(share * points[node, dof - 1] for node, _, share in others)
        assert at == pytest.approx(points[first, dof - 1], abs=0.01)
    untied = 4 - len(nodes)
    assert sum("stay untied" in warning for warning in model.warnings) == (untied > 0)


@pytest.mark.parametrize(
    ("node", "place", "x"), [(2, "0.0, 0.0", "1e6"), (4, "0.0, 1.0", "1e8"), (6, "2.0, 0.0", "-1e6")]
)
def test_needle_of_a_face(tmp_path, node, place, x):
    """A side of the main face is a million times as long as the others: no integral is an error."""
    lower, upper = boxes("C3D8", (1, 1), (2, 2))
    text = tied(lower, upper, ["*STEP\n*STATIC\n*END STEP"], tie="TYPE=SURFACE TO SURFACE")
    needle = text.replace(f"\n{node}, {place}, 1.0", f"\n{node}, {x}, {place.split(', ')[1]}, 1.0")
    assert needle != text
    assert read(tmp_path, needle).equations


# ------------------------------------------------------------ shells

SHELL = """*NODE
1, 0., 0., 0.
2, 2., 0., 0.
3, 2., 1., 0.
4, 0., 1., 0.
11, 0., 0., 0.1
12, 1.5, 0., 0.1
13, 1.5, 1., 0.1
14, 0., 1., 0.1
15, 0., 0., 1.1
16, 1.5, 0., 1.1
17, 1.5, 1., 1.1
18, 0., 1., 1.1
*ELEMENT, TYPE=S4, ELSET=PLATE
1, 1, 2, 3, 4
*ELEMENT, TYPE=%s, ELSET=BODY
2, %s
*SHELL SECTION, ELSET=PLATE, MATERIAL=M
0.2
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*SURFACE, NAME=S_PLATE
PLATE, SPOS
*SURFACE, NAME=S_BODY
BODY, %s
%s
*TIE, NAME=T%s
%s
*STEP%s
*STATIC
1., 1.
*END STEP
"""
SOLID = "C3D8", "11, 12, 13, 14, 15, 16, 17, 18", "S1", "*SOLID SECTION, ELSET=BODY, MATERIAL=M"
PLATE = "S4", "11, 12, 13, 14", "SNEG", "*SHELL SECTION, ELSET=BODY, MATERIAL=M\n0.02"


@pytest.mark.parametrize("order", ["S_BODY, S_PLATE", "S_PLATE, S_BODY"])
@pytest.mark.parametrize("body", [SOLID, PLATE], ids=["solid", "shell"])
def test_shells_are_tied_by_their_sides(tmp_path, body, order):
    """Half of the thickness away. Beside a shell nodes turn with it: its rigid motion is one of the tied body.

    Nodes tied to a solid follow its displacements, and their rotations stay free.
    """
    model = read(tmp_path, SHELL % (*body, ", POSITION TOLERANCE=0.05", order, ""))
    points = model.mesh.coordinates
    spin = np.array([0.3, -0.2, 0.5])
    field = np.concatenate([np.cross(spin, points), np.broadcast_to(spin, points.shape)], axis=1)
    main_turns = body is PLATE or order == "S_BODY, S_PLATE"
    if not main_turns:
        field = np.concatenate([np.broadcast_to(spin, points.shape), 0 * points], axis=1)
    tied = 4 if order == "S_BODY, S_PLATE" else 2
    assert len(model.equations) == tied * (6 if body is PLATE else 3)
    for equation in model.equations:
        assert sum(c * field[node, dof - 1] for node, dof, c in equation.terms) == pytest.approx(0.0, abs=1e-12)
    adjusted = [warning for warning in model.warnings if "nodes beside shells stay where they are" in warning]
    assert len(adjusted) == (body is PLATE)
    untied = [warning for warning in model.warnings if "stay untied: 2, 3" in warning]
    assert len(untied) == (order == "S_PLATE, S_BODY")


@pytest.mark.parametrize("options", ["", ", NO ROTATION"])
def test_offset_with_nlgeom(tmp_path, options):
    text = SHELL % (*SOLID, f", POSITION TOLERANCE=0.05{options}", "S_BODY, S_PLATE", ", NLGEOM")
    warned = [w for w in read(tmp_path, text).warnings if "follow its rotations as small ones, also with NLGEOM" in w]
    assert len(warned) == (not options)


def test_thickness_does_not_count(tmp_path):
    text = SHELL % (*SOLID, ", POSITION TOLERANCE=0.05, NO THICKNESS", "S_BODY, S_PLATE", "")
    with pytest.raises(DeckError, match=r"\*TIE: no node of the first surface is within 0\.05 of the second one"):
        read(tmp_path, text)


def test_edges_of_shells(tmp_path):
    """The edge of a plate follows that of another one, at its points."""
    body = "S4", "14, 13, 17, 18", "E1", "*SHELL SECTION, ELSET=BODY, MATERIAL=M\n0.02"
    text = SHELL % (*body, ", POSITION TOLERANCE=0.15, ADJUST=NO", "S_BODY, S_PLATE", "")
    model = read(tmp_path, text.replace("PLATE, SPOS", "PLATE, E3"))
    shares = {(e.terms[0][0], e.terms[0][1]): {(n, d): -c for n, d, c in e.terms[1:]} for e in model.equations}
    assert len(shares) == 12
    # node 13, at x = 1.5 of an edge from 2 to 0; 0.1 above it, it turns with it about y
    row = shares[6, 1]
    assert row[2, 1] == pytest.approx(0.75)
    assert row[3, 1] == pytest.approx(0.25)
    assert row[2, 5] == pytest.approx(0.075)


def test_edges_that_coincide(tmp_path):
    """The thickness of plates lies across their faces: it neither closes a gap of edges nor calls for a warning."""
    body = "S4", "2, 3, 17, 16", "E1", "*SHELL SECTION, ELSET=BODY, MATERIAL=M\n0.2"
    text = SHELL % (*body, "", "S_BODY, S_PLATE", "")
    text = text.replace("PLATE, SPOS", "PLATE, E2").replace("2, 2, 3, 17, 16", "2, 12, 13, 17, 16")
    touching = text.replace("12, 1.5, 0., 0.1", "12, 2., 0., 0.").replace("13, 1.5, 1., 0.1", "13, 2., 1., 0.")
    assert [warning for warning in read(tmp_path, touching).warnings if "*TIE" in warning] == []
    apart = text.replace("12, 1.5, 0., 0.1", "12, 2.09, 0., 0.").replace("13, 1.5, 1., 0.1", "13, 2.09, 1., 0.")
    with pytest.raises(DeckError, match=r"\*TIE: no node of the first surface is within 0\.05 of the second one"):
        read(tmp_path, apart)


def test_gap_of_solids_with_nlgeom(tmp_path):
    """A gap that ADJUST=NO leaves keeps its direction in space: two blocks that turn together are strained."""
    lower, upper = boxes(*APART)
    step = "*STEP, NLGEOM\n*STATIC\n1., 1.\n*END STEP"
    text = tied(lower, upper, [step], tie="TIED NSET=UPPER_BOTTOM, ADJUST=NO", model="*BOUNDARY\nLOWER_BOTTOM, 1, 2")
    message = "*TIE: the gap between the surfaces does not turn with them: it resists large rotations"
    assert any(message in warning for warning in read(tmp_path, text).warnings)
    assert not any(message in warning for warning in read(tmp_path, text.replace(", NLGEOM", "")).warnings)
    assert not any(message in warning for warning in read(tmp_path, text.replace("ADJUST=NO", "ADJUST=YES")).warnings)


def test_faces_and_edges_in_one_surface(tmp_path):
    text = SHELL % (*SOLID, "", "S_BODY, S_PLATE", "")
    message = r"\*TIE: surface S_PLATE has faces and edges; expected a surface of one kind"
    with pytest.raises(DeckError, match=message):
        read(tmp_path, text.replace("PLATE, SPOS", "PLATE, SPOS\nPLATE, E3"))


# ------------------------------------------------------------ cohesive elements with a mesh of their own

K = 500.0
"""Traction per separation of a layer without thickness."""


def glued(kind, lower, layer, upper, *, secondary=True):
    """Two boxes on a layer of cohesive elements; it is the secondary side of both ties, or the main one."""
    flat = len(lower) == 1
    bodies = boxes(kind, lower, upper)
    low, high = ((0, 1), (2, 1)) if flat else ((0, 0, 1), (2, 1, 1))
    glue = Box("GLUE", "COH2D4" if flat else "COH3D8", low, high, (*layer, 1), first=5001)
    lines = glue.lines()
    lines[-2:] = ["*COHESIVE SECTION, ELSET=GLUE, MATERIAL=G, RESPONSE=TRACTION SEPARATION", "1., 1.5"]
    ties = [("GLUE_LOW", "LOWER_HIGH"), ("GLUE_HIGH", "UPPER_LOW")]
    for k, tie in enumerate(ties):
        first, second = tie if secondary else tie[::-1]
        lines += [f"*TIE, NAME=T{k}, TYPE=NODE TO SURFACE", f"{first}, {second}"]
    lines += ["*MATERIAL, NAME=G", f"*ELASTIC, TYPE=TRACTION\n{K}, {K}, {K}"]
    held = "*BOUNDARY\nLOWER_BOTTOM, 1, 3\nUPPER_TOP, 1, 3\n" if flat else "*BOUNDARY\nLOWER_BOTTOM, 1, 3\n"
    held = held.replace("3\n", "2\n") if flat else held + "UPPER_TOP, 1, 2\n"
    axis = len(low)
    pull = f"*STEP\n*STATIC\n1., 1.\n{held}*BOUNDARY\nUPPER_TOP, {axis}, {axis}, 0.01\n*OUTPUT, FIELD\n*END STEP\n"
    text = [*bodies[0].lines(), *bodies[1].lines(), *lines, "*MATERIAL, NAME=M", f"*ELASTIC\n{YOUNG}, 0."]
    return "\n".join(text) + "\n" + pull, axis


@pytest.mark.parametrize("secondary", [True, False])
@pytest.mark.parametrize(
    ("kind", "lower", "layer", "upper"),
    [
        ("CPE4", (2,), (2,), (2,)),
        ("CPS4", (2,), (4,), (1,)),
        ("C3D8", (2, 1), (2, 1), (2, 1)),
        ("C3D8", (2, 1), (4, 2), (1, 1)),
    ],
)
def test_cohesive_layer_tied_to_solids(run_deck, kind, lower, layer, upper, secondary):
    """A layer between two bars of length 1: u = s (2/E + 1/K), without Poisson's ratio."""
    if not secondary:
        # the finer side follows
        lower, layer, upper = layer, lower, layer
    text, axis = glued(kind, lower, layer, upper, secondary=secondary)
    result = run_deck(text)
    stress = 0.01 / (2 / YOUNG + 1 / K)
    solids = result.field(f"S{axis}{axis}")
    np.testing.assert_allclose(solids[np.isfinite(solids)], stress, rtol=1e-9)


@pytest.mark.parametrize(("face", "named"), [("S4", "S1, S2"), ("SPOS", "S1, S2")])
def test_other_faces_of_cohesive_elements(tmp_path, face, named):
    text, _ = glued("C3D8", (1, 1), (1, 1), (1, 1))
    (tmp_path / "deck.inp").write_text(text.replace("GLUE_HIGH, S2", f"GLUE_HIGH, {face}"))
    with pytest.raises(DeckError, match=rf"\*SURFACE: elements of type COH3D8 have no face {face} \(faces: {named}\)"):
        read_deck(tmp_path / "deck.inp")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("*STATIC\n1., 1.\n", "*STATIC\n1., 1.\n*DSLOAD\nGLUE_HIGH, P, 1.\n", "load type P on elements of type COH3D8"),
        (
            "*TIE, NAME=T1, TYPE=NODE TO SURFACE\nGLUE_HIGH, UPPER_LOW",
            "*SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nUPPER_LOW, GLUE_HIGH",
            "faces of elements of type COH3D8 are not supported in contact pairs",
        ),
    ],
)
def test_what_cohesive_faces_do_not_take(tmp_path, old, new, message):
    text, _ = glued("C3D8", (1, 1), (1, 1), (1, 1))
    assert old in text
    (tmp_path / "deck.inp").write_text(text.replace(old, new))
    with pytest.raises(DeckError, match=message):
        read_deck(tmp_path / "deck.inp")
