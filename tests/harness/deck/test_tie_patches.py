# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surface-to-surface ties pass constant stress and constant heat flux between faces of any kinds that do not match.

Exact values: a column under a uniform pressure p has S = p along it, and displacements linear in the coordinates; both
elements have these exactly, so that only the tie can make an error. Tolerance: rounding of the solution.
"""

import itertools

import numpy as np
import pytest

from uel.deck import read_deck
from uel.model.element_types import BUILT_IN

YOUNG, PULL = 1000.0, 5.0

HEX = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
QUAD = [(0, 0), (1, 0), (1, 1), (0, 1)]
CELLS = {
    "quad": [[0, 1, 2, 3]],
    "triangle": [[0, 1, 2], [0, 2, 3]],
    "hexahedron": [[0, 1, 2, 3, 4, 5, 6, 7]],
    "tetrahedron": [[0, 1, 2, 6], [0, 2, 3, 6], [0, 5, 1, 6], [0, 4, 5, 6], [0, 3, 7, 6], [0, 7, 4, 6]],
    # two ends are triangles, or all sides but these are on the surfaces
    "wedge": [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]],
    "lying wedge": [[0, 5, 1, 3, 6, 2], [0, 4, 5, 3, 7, 6]],
}
EDGES = {
    "quad": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "triangle": [(0, 1), (1, 2), (2, 0)],
    "hexahedron": [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)],
    "tetrahedron": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
    "wedge": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
}
SPACE = {
    "C3D8": "hexahedron",
    "C3D20": "hexahedron",
    "C3D4": "tetrahedron",
    "C3D10": "tetrahedron",
    "C3D6": "wedge",
    "C3D15": "wedge",
    "C3D6 lying": "lying wedge",
    "C3D15 lying": "lying wedge",
}
PLANE = {"CPS4": "quad", "CPS8": "quad", "CPS3": "triangle", "CPS6": "triangle"}
ROUND = {"CAX4": "quad", "CAX8": "quad", "CAX6": "triangle"}


class Column:
    """Boxes of a regular mesh, cut into cells; `sides` (elements by face) are those on the plane of the last axis."""

    def __init__(self, name, kind, cell, low, high, counts, first, skew=0.0):
        self.name, self.kind, self.first = name, kind.split()[0], first
        axes = [np.linspace(a, b, n + 1) for a, b, n in zip(low, high, counts, strict=True)]
        self.low, self.high, self.numbers, self.rows = low[-1], high[-1], {}, []
        family = BUILT_IN[self.kind].family
        edges = EDGES[cell.split()[-1]][: family.nodes - family.corners]
        # cells that are not rectangles: lines inside the mesh are inclined, sides are straight
        for index in itertools.product(*(range(n) for n in counts)):
            corners = []
            for corner in HEX if len(counts) == 3 else QUAD:
                at = np.array([axis[i + k] for axis, i, k in zip(axes, index, corner, strict=True)])
                inside = 0 < index[0] + corner[0] < counts[0]
                share = (at[1] - low[1]) / (high[1] - low[1]) - 0.5
                at[0] += skew * inside * share * (len(counts) == 3)
                corners.append(at)
            for part in CELLS[cell]:
                places = [corners[k] for k in part]
                places += [(places[a] + places[b]) / 2 for a, b in edges]
                self.rows.append([self._number(x) for x in places])
        self.nodes = np.array(list(self.numbers))
        self.faces = family.faces

    def _number(self, place):
        return self.numbers.setdefault(tuple(np.round(place, 12).tolist()), self.first + len(self.numbers))

    def chosen(self, test):
        return [self.first + k for k in np.flatnonzero(test(self.nodes)).tolist()]

    def lines(self, *, section="1."):
        name = self.name
        lines = [f"*NODE, NSET={name}"]
        lines += [", ".join([str(self.first + k), *map(repr, x)]) for k, x in enumerate(self.nodes.tolist())]
        lines.append(f"*ELEMENT, TYPE={self.kind}, ELSET={name}")
        for k, row in enumerate(self.rows):
            words = list(map(str, [self.first + k, *row]))
            lines += [", ".join(words[:12]) + ("," if len(words) > 12 else "")]
            lines += [", ".join(words[12:])] if len(words) > 12 else []
        for end, level in (("LOW", self.low), ("HIGH", self.high)):
            lines.append(f"*SURFACE, NAME={name}_{end}")
            for k, row in enumerate(self.rows):
                at = np.abs(self.nodes[np.array(row) - self.first][:, -1] - level) < 1e-9
                lines += [f"{self.first + k}, S{n}" for n, face in enumerate(self.faces, 1) if at[list(face)].all()]
            lines += [f"*NSET, NSET={name}_{end}"]
            lines += [f"{k}," for k in self.chosen(lambda x, level=level: np.abs(x[:, -1] - level) < 1e-9)]
        return [*lines, f"*SOLID SECTION, ELSET={name}, MATERIAL=M", section]


def columns(second, main, cells, counts, **shape):
    flat = len(counts[0]) == 2
    low, high = [1.0, 0.0, 0.0][-3:], [2.0, 1.0, 1.0]
    if flat:
        low, high = low[:2], high[:2]
    up = np.eye(len(low))[-1]
    section = "1." if flat else ""
    upper = Column("UPPER", second, cells[second], (low + up).tolist(), (high + up).tolist(), counts[0], 5001, **shape)
    lower = Column("LOWER", main, cells[main], low, high, counts[1], 1, **shape)
    return upper, lower, [*lower.lines(section=section), *upper.lines(section=section)]


def pulled(second, main, cells, counts, tie="", options="", **shape):
    """UPPER, whose nodes are tied, on LOWER, pulled at its upper end, with nu = 0.3."""
    _, lower, lines = columns(second, main, cells, counts, **shape)
    d = len(counts[0])
    lines += ["*MATERIAL, NAME=M", f"*ELASTIC\n{YOUNG}, 0.3", f"*TIE, NAME=T{tie}\nUPPER_LOW, LOWER_HIGH"]
    lines += [f"*BOUNDARY\nLOWER_LOW, {d}"]
    if not second.startswith("CAX"):
        # three nodes of the lower end stop rigid motions
        at = lower.chosen(lambda x: np.abs(x[:, -1]) < 1e-9)
        near = [k for k in at if np.allclose(lower.nodes[k - 1][:-1], [1.0, 0.0][: d - 1])]
        lines += [f"{near[0]}, 1, {d - 1}"]
        if d == 3:
            other = [k for k in at if np.allclose(lower.nodes[k - 1][:-1], [1.0, 1.0])]
            lines += [f"{other[0]}, 1"]
    lines += [f"*STEP{options}\n*STATIC\n1., 1.\n*DSLOAD\nUPPER_HIGH, P, {-PULL}\n*OUTPUT, FIELD\n*END STEP"]
    return "\n".join(line for line in lines if line) + "\n"


def check(result, d, rtol=1e-10):
    stress = result.field("S33" if d == 3 else "S22")
    np.testing.assert_allclose(stress, PULL, rtol=rtol)
    x = result.mesh().points
    np.testing.assert_allclose(result.field("U")[:, d - 1], x[:, d - 1] * PULL / YOUNG, atol=rtol * PULL / YOUNG)


@pytest.mark.sample(5)
@pytest.mark.parametrize("main", SPACE)
@pytest.mark.parametrize("second", SPACE)
def test_constant_stress_in_space(run_deck, second, main):
    """Two by two faces on three by one."""
    check(run_deck(pulled(second, main, SPACE, ((2, 2, 1), (3, 1, 1)))), 3)


@pytest.mark.parametrize(("second", "main"), [("C3D8", "C3D20"), ("C3D10", "C3D8"), ("C3D20", "C3D4")])
def test_constant_stress_across_faces_that_are_no_parallelograms(run_deck, second, main):
    """Edges are inclined to each other. Shape functions are no polynomials there: the integrals are good to 1e-5."""
    check(run_deck(pulled(second, main, SPACE, ((2, 2, 1), (3, 1, 1)), skew=0.2)), 3, rtol=1e-5)


@pytest.mark.parametrize("main", PLANE)
@pytest.mark.parametrize("second", PLANE)
def test_constant_stress_in_the_plane(run_deck, second, main):
    for counts in (((3, 1), (2, 1)), ((2, 1), (5, 1))):
        check(run_deck(pulled(second, main, PLANE, counts)), 2)


@pytest.mark.parametrize("main", ROUND)
@pytest.mark.parametrize("second", ROUND)
def test_constant_stress_about_an_axis(run_deck, second, main):
    """A hollow cylinder, whose tractions count with the radius."""
    check(run_deck(pulled(second, main, ROUND, ((3, 1), (2, 1)))), 2)


@pytest.mark.parametrize("tolerance", [0.01, 0.3, 10.0])
@pytest.mark.parametrize("tie", ["", ", TYPE=NODE TO SURFACE"])
def test_faces_are_followed_whatever_the_tolerance(run_deck, tie, tolerance):
    """Three elements on two, stretched along the tie: u1 = 0.01 x, S11 = 10."""
    upper, lower, lines = columns("CPS4", "CPS4", PLANE, ((3, 1), (2, 1)))
    lines += [f"*MATERIAL, NAME=M\n*ELASTIC\n{YOUNG}, 0.", f"*TIE, NAME=T, POSITION TOLERANCE={tolerance}{tie}"]
    lines += ["UPPER_LOW, LOWER_HIGH", "*BOUNDARY\nLOWER_LOW, 2"]
    given = []
    for body in (upper, lower):
        ends = body.chosen(lambda x: np.abs(x[:, 0] - 1.5) > 0.5 - 1e-9)
        ends = [k for k in ends if body is lower or body.nodes[k - body.first][1] > 1.5]
        given += [f"{k}, 1, 1, {0.01 * body.nodes[k - body.first][0]!r}" for k in ends]
    lines += ["*STEP\n*STATIC\n1., 1.\n*BOUNDARY", *given, "*OUTPUT, FIELD\n*END STEP"]
    result = run_deck("\n".join(lines).replace("np.float64(", "").replace(")", "") + "\n")
    np.testing.assert_allclose(result.field("S11"), 10.0, atol=1e-9)


@pytest.mark.parametrize(("second", "main"), [("C3D8", "C3D20"), ("C3D10", "C3D8"), ("C3D8", "C3D6")])
def test_constant_stress_with_nlgeom(run_deck, second, main):
    """Both columns have the same stress and stretch, whatever the mesh."""
    text = pulled(second, main, SPACE, ((2, 2, 1), (3, 1, 1)), options=", NLGEOM").replace(f"P, {-PULL}", "P, -100.")
    result = run_deck(text)
    stress = result.field("S33")
    np.testing.assert_allclose(stress, stress[0], rtol=1e-6)
    x, u = result.mesh().points, result.field("U")[:, 2]
    np.testing.assert_allclose(u, x[:, 2] * u.max() / 2.0, atol=1e-6)
    assert u.max() > 0.15


HEAT = {"DC2D4": "quad", "DC2D8": "quad", "DC2D6": "triangle", "CPS4T": "quad", "CPS8T": "quad"}


@pytest.mark.parametrize(
    ("second", "main"),
    [*itertools.product(["DC2D4", "DC2D8", "DC2D6"], repeat=2), *itertools.product(["CPS4T", "CPS8T"], repeat=2)],
)
def test_constant_flux(run_deck, second, main):
    """Temperatures 0 and 200 at the ends: linear between them. Of CPS8T only the corners have temperatures."""
    upper, lower, lines = columns(second, main, HEAT, ((3, 1), (2, 1)))
    material = "*MATERIAL, NAME=M\n*CONDUCTIVITY\n1.5"
    coupled = second.endswith("T")
    if coupled:
        material += f"\n*ELASTIC\n{YOUNG}, 0."
        lines += ["*INITIAL CONDITIONS, TYPE=TEMPERATURE\nUPPER, 0.\nLOWER, 0."]
        lines += ["*BOUNDARY\nUPPER_HIGH, 1, 2\nLOWER_LOW, 1, 2"]
    lines += [material, "*TIE, NAME=T\nUPPER_LOW, LOWER_HIGH"]
    procedure = "*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE" if coupled else "*HEAT TRANSFER, STEADY STATE"
    hot = [f"{k}, 11, 11, 200." for k in upper.chosen(lambda x: x[:, 1] > 2 - 1e-9)]
    cold = [f"{k}, 11, 11, 0." for k in lower.chosen(lambda x: x[:, 1] < 1e-9)]
    lines += [f"*STEP\n{procedure}\n1., 1.\n*BOUNDARY", *hot, *cold, "*OUTPUT, FIELD\n*NODE OUTPUT\nNT, U\n*END STEP"]
    result = run_deck(lines)
    found, y = result.field("NT11"), result.mesh().points[:, 1]
    corners = np.isin(np.arange(len(y)), _corners(upper, lower)) if coupled else np.ones(len(y), dtype=bool)
    np.testing.assert_allclose(found[corners], 100.0 * y[corners], atol=1e-8)


def _corners(upper, lower):
    """Positions of the corners of elements: LOWER comes first."""
    found = []
    for body, start in ((lower, 0), (upper, len(lower.nodes))):
        count = BUILT_IN[body.kind].family.corners
        found += [start + number - body.first for row in body.rows for number in row[:count]]
    return np.array(found)


@pytest.mark.parametrize("tie", ["", ", TYPE=NODE TO SURFACE"])
@pytest.mark.parametrize(("second", "main"), [("C3D20", "C3D10"), ("C3D8", "C3D15 lying"), ("C3D4", "C3D20")])
def test_linear_fields(tmp_path, second, main, tie):
    """All equations hold for a linear field: rigid motions and constant strain pass the tie."""
    text = pulled(second, main, SPACE, ((2, 2, 1), (3, 1, 1)), tie=tie, skew=0.2)
    (tmp_path / "deck.inp").write_text(text)
    model = read_deck(tmp_path / "deck.inp")
    field = model.mesh.coordinates @ np.array([[0.1, 0.4, -0.2], [0.3, -0.7, 0.5], [-0.6, 0.2, 0.8]])
    assert len(model.equations) > 20
    for equation in model.equations:
        assert sum(factor * field[node, dof - 1] for node, dof, factor in equation.terms) == pytest.approx(
            0.0, abs=1e-9
        )


@pytest.mark.parametrize(("adjust", "height"), [("YES", 2.2), ("NO", 2.0)])
def test_adjust(run_deck, adjust, height):
    """Nodes at a distance of 0.2 are moved onto the main surface, without strain: the upper column becomes longer."""
    text = pulled("CPS4", "CPS4", PLANE, ((3, 1), (2, 1)), tie=f", POSITION TOLERANCE=0.3, ADJUST={adjust}")
    second = text.index("*NODE, NSET=UPPER")
    nodes = text[second:].split("*ELEMENT", 1)[0]
    lifted = "\n".join(
        ", ".join([*line.split(", ")[:2], repr(float(line.split(", ")[2]) + 0.2)]) if line[0] == "5" else line
        for line in nodes.splitlines()
    )
    result = run_deck(text.replace(nodes, lifted + "\n"))
    np.testing.assert_allclose(result.field("S22"), PULL, atol=1e-9)
    top = result.field("U")[:, 1].max()
    assert top == pytest.approx(height * PULL / YOUNG, rel=1e-9)
    points = result.mesh().points
    assert np.sort(np.unique(np.round(points[:, 1], 9))).tolist() == [0.0, 1.0, *([1.2] if adjust == "NO" else []), 2.2]


# ------------------------------------------------------------ surfaces around corners, and curved ones


class Grid:
    """Quadrilaterals of a part of a regular mesh; `place` maps (x, y) of the mesh."""

    def __init__(self, name, kind, cells, first, place=lambda x, y: (x, y)):
        self.name, self.kind, self.first, self.numbers, self.rows = name, kind, first, {}, []
        half = [(0.5, 0), (1, 0.5), (0.5, 1), (0, 0.5)] if kind.endswith("8") else []
        for x, y, size in cells:
            corners = [(x + a * size[0], y + b * size[1]) for a, b in [*QUAD, *half]]
            self.rows.append(
                [self.numbers.setdefault(tuple(np.round(p, 9)), first + len(self.numbers)) for p in corners]
            )
        self.mesh = np.array(list(self.numbers))
        self.nodes = np.array([place(*p) for p in self.mesh])

    def lines(self, on):
        """on: mesh places (n, 2) on the surface, which is made of the faces all of whose nodes are."""
        name, chosen = self.name, on(self.mesh)
        lines = ["*NODE", *(f"{self.first + k}, {x!r}, {y!r}" for k, (x, y) in enumerate(self.nodes.tolist()))]
        lines.append(f"*ELEMENT, TYPE={self.kind}, ELSET={name}")
        lines += [", ".join(map(str, [self.first + k, *row])) for k, row in enumerate(self.rows)]
        lines.append(f"*SURFACE, NAME={name}_ON")
        for k, row in enumerate(self.rows):
            corners = np.array(row[:4]) - self.first
            for face in range(4):
                ends = corners[[face, (face + 1) % 4]]
                # an edge from one side of a corner to another is not on it
                if chosen[ends].all() and on(self.mesh[ends].mean(axis=0)[None])[0]:
                    lines.append(f"{self.first + k}, S{face + 1}")
        return [*lines, f"*SOLID SECTION, ELSET={name}, MATERIAL=M\n1."]


@pytest.mark.parametrize("order", ["OUT_ON, IN_ON", "IN_ON, OUT_ON"])
@pytest.mark.parametrize(("inner", "outer"), list(itertools.product(["CPE4", "CPE8"], repeat=2)))
def test_inclusion_with_corners(run_deck, inner, outer, order):
    """A square of 2 by 2 elements in a frame of 3 for each of its sides: any constant strain passes.

    A node at a corner has forces of both sides.
    """
    squares = {
        "IN": (inner, [(1 + i / 2, 1 + j / 2, (1 / 2, 1 / 2)) for i in range(2) for j in range(2)], 1),
        "OUT": (
            outer,
            [(i / 3, j / 3, (1 / 3, 1 / 3)) for i in range(9) for j in range(9) if not 3 <= i < 6 or not 3 <= j < 6],
            5001,
        ),
    }
    grids = [Grid(name, *given) for name, given in squares.items()]
    lines = [line for grid in grids for line in grid.lines(lambda x: np.isclose(np.abs(x - 1.5).max(axis=1), 0.5))]
    lines += [f"*MATERIAL, NAME=M\n*ELASTIC\n{YOUNG}, 0.3\n*TIE, NAME=T\n{order}", "*STEP\n*STATIC\n1., 1.\n*BOUNDARY"]
    strain = 1e-3 * np.array([[1.0, 0.4], [0.3, -0.7]])
    for k, x in enumerate(grids[1].nodes):
        if np.isclose(np.abs(x - 1.5).max(), 1.5):
            lines += [f"{5001 + k}, {d + 1}, {d + 1}, {u!r}" for d, u in enumerate((strain @ x).tolist())]
    result = run_deck([*lines, "*OUTPUT, FIELD\n*END STEP"])
    np.testing.assert_allclose(result.field("U")[:, :2], result.mesh().points[:, :2] @ strain.T, atol=1e-14)


@pytest.mark.parametrize("order", ["OUT_ON, IN_ON", "IN_ON, OUT_ON"])
def test_tube_of_two_layers(run_deck, order):
    """Radial displacements of a tube under internal pressure, by Lame's solution in plane strain.

    Eight quadratic faces of a quarter on eleven: 2e-5 is what a few elements of second order leave.
    """

    def ring(name, low, count, first):
        cells = [(low + i / 8, j / count, (1 / 8, 1 / count)) for i in range(4) for j in range(count)]
        quarter = np.pi / 2
        return Grid(name, "CPE8", cells, first, lambda r, t: (r * np.cos(quarter * t), r * np.sin(quarter * t)))

    grids = [ring("IN", 1.0, 8, 1), ring("OUT", 1.5, 11, 5001)]
    lines = [line for grid in grids for line in grid.lines(lambda x: np.isclose(x[:, 0], 1.5))]
    lines += ["*SURFACE, NAME=BORE", *(f"{1 + k}, S4" for k in range(8))]
    lines += [f"*MATERIAL, NAME=M\n*ELASTIC\n{YOUNG}, 0.3\n*TIE, NAME=T\n{order}\n*BOUNDARY"]
    for grid in grids:
        for level, dof in ((0.0, 2), (1.0, 1)):
            lines += [f"{grid.first + k}, {dof}" for k in np.flatnonzero(np.isclose(grid.mesh[:, 1], level)).tolist()]
    result = run_deck([*lines, "*STEP\n*STATIC\n1., 1.\n*DSLOAD\nBORE, P, 10.\n*OUTPUT, FIELD\n*END STEP"])
    x, u = result.mesh().points[:, :2], result.field("U")[:, :2]
    r = np.hypot(*x.T)
    # S11 = A - B/r^2, A = p a^2/(b^2 - a^2), B = A b^2, with a = 1, b = 2
    a, b = 10.0 / 3.0, 40.0 / 3.0
    wanted = 1.3 / YOUNG * (0.4 * a * r + b / r)
    np.testing.assert_allclose(np.einsum("nd,nd->n", u, x) / r, wanted, rtol=2e-5)
