# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surface-to-surface ties pass constant stress and constant heat flux between faces of any kinds that do not match.

Exact values: a column under a uniform pressure p has S = p along it, and displacements linear in the coordinates; both
elements have these exactly, so that only the tie can make an error. Tolerance: rounding of the solution.
"""

import itertools

import numpy as np
import pytest

import harness
from harness.deck import read_deck
from harness.model.element_types import BUILT_IN

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


@pytest.fixture
def run(tmp_path):
    def run(text):
        (tmp_path / "deck.inp").write_text(text)
        return harness.run(tmp_path / "deck.inp", output_dir=tmp_path)

    return run


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
def test_constant_stress_in_space(run, second, main):
    """Two by two faces on three by one."""
    check(run(pulled(second, main, SPACE, ((2, 2, 1), (3, 1, 1)))), 3)


@pytest.mark.parametrize(("second", "main"), [("C3D8", "C3D20"), ("C3D10", "C3D8"), ("C3D20", "C3D4")])
def test_constant_stress_across_faces_that_are_no_parallelograms(run, second, main):
    """Edges are inclined to each other. Shape functions are no polynomials there: the integrals are good to 1e-5."""
    check(run(pulled(second, main, SPACE, ((2, 2, 1), (3, 1, 1)), skew=0.2)), 3, rtol=1e-5)


@pytest.mark.parametrize("main", PLANE)
@pytest.mark.parametrize("second", PLANE)
def test_constant_stress_in_the_plane(run, second, main):
    for counts in (((3, 1), (2, 1)), ((2, 1), (5, 1))):
        check(run(pulled(second, main, PLANE, counts)), 2)


@pytest.mark.parametrize("main", ROUND)
@pytest.mark.parametrize("second", ROUND)
def test_constant_stress_about_an_axis(run, second, main):
    """A hollow cylinder, whose tractions count with the radius."""
    check(run(pulled(second, main, ROUND, ((3, 1), (2, 1)))), 2)


@pytest.mark.parametrize("tolerance", [0.01, 0.3, 10.0])
@pytest.mark.parametrize("tie", ["", ", TYPE=NODE TO SURFACE"])
def test_faces_are_followed_whatever_the_tolerance(run, tie, tolerance):
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
    result = run("\n".join(lines).replace("np.float64(", "").replace(")", "") + "\n")
    np.testing.assert_allclose(result.field("S11"), 10.0, atol=1e-9)


@pytest.mark.parametrize(("second", "main"), [("C3D8", "C3D20"), ("C3D10", "C3D8"), ("C3D8", "C3D6")])
def test_constant_stress_with_nlgeom(run, second, main):
    """Both columns have the same stress and stretch, whatever the mesh."""
    text = pulled(second, main, SPACE, ((2, 2, 1), (3, 1, 1)), options=", NLGEOM").replace(f"P, {-PULL}", "P, -100.")
    result = run(text)
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
def test_constant_flux(run, second, main):
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
    result = run("\n".join(lines) + "\n")
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
def test_adjust(run, adjust, height):
    """Nodes at a distance of 0.2 are moved onto the main surface, without strain: the upper column becomes longer."""
    text = pulled("CPS4", "CPS4", PLANE, ((3, 1), (2, 1)), tie=f", POSITION TOLERANCE=0.3, ADJUST={adjust}")
    second = text.index("*NODE, NSET=UPPER")
    nodes = text[second:].split("*ELEMENT", 1)[0]
    lifted = "\n".join(
        ", ".join([*line.split(", ")[:2], repr(float(line.split(", ")[2]) + 0.2)]) if line[0] == "5" else line
        for line in nodes.splitlines()
    )
    result = run(text.replace(nodes, lifted + "\n"))
    np.testing.assert_allclose(result.field("S22"), PULL, atol=1e-9)
    top = result.field("U")[:, 1].max()
    assert top == pytest.approx(height * PULL / YOUNG, rel=1e-9)
    points = result.mesh().points
    assert np.sort(np.unique(np.round(points[:, 1], 9))).tolist() == [0.0, 1.0, *([1.2] if adjust == "NO" else []), 2.2]
