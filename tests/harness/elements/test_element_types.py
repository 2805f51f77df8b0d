# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The table of element types and the functions and rules of the host that belong to its families."""

from dataclasses import replace
from itertools import product
from math import factorial

import numpy as np
import pytest

from harness.errors import KernelError
from harness.model.element_types import BUILT_IN, CONTINUUM, COUPLED, FAMILIES, ContinuumType, DiscreteKind
from harness.usersub import _binding

SIMPLEX = np.vstack([np.zeros(3), np.eye(3)])
SQUARE = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
# corners in the parent coordinates and edges with a middle, numbered from 0 as in Abaqus
CELLS = {
    "line": ([[-1], [1]], []),
    "line3": ([[-1], [1]], [(0, 1)]),
    "triangle": (SIMPLEX[:3, :2], []),
    "triangle6": (SIMPLEX[:3, :2], [(0, 1), (1, 2), (2, 0)]),
    "quad": (SQUARE, []),
    "quad8": (SQUARE, [(0, 1), (1, 2), (2, 3), (3, 0)]),
    "tetra": (SIMPLEX, []),
    "hexahedron": ([(*corner, r) for r in (-1, 1) for corner in SQUARE], []),
    "hexahedron20": (
        [(*corner, r) for r in (-1, 1) for corner in SQUARE],
        [
            *((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)),
            *((0, 4), (1, 5), (2, 6), (3, 7)),
        ],
    ),
}
KNOWN = [family for family in FAMILIES.values() if family.number]
RULES = sorted(
    {(family.cell, family.full_points) for family in KNOWN}
    | {(kind.family.cell, points) for kind in CONTINUUM.values() for points in (kind.points, kind.body_points)}
    | {(kind.family.cell, kind.thermal_points) for kind in COUPLED.values()}
)
DEGREES = {
    # polynomials that a number of points integrates exactly, in each direction of cells with parallel faces
    **{("triangle", 1): 1, ("triangle", 3): 2, ("triangle", 6): 4, ("tetra", 1): 1},
    **{(shape, n**d): 2 * n - 1 for shape, d in (("line", 1), ("quad", 2), ("hexahedron", 3)) for n in (1, 2, 3)},
}


def family_of(cell):
    return next(family for family in KNOWN if family.cell == cell)


def shape_of(cell):
    return cell.rstrip("0123456789")


def nodes_of(cell):
    corners, edges = CELLS[cell]
    corners = np.array(corners, dtype=float)
    return np.vstack([corners, *(corners[list(edge)].mean(axis=0) for edge in edges)])


def rule_of(cell, points):
    family = family_of(cell)
    return _binding.integration_rule(family.number, points, family.nodes, family.dimension)


def integral(cell, powers):
    """Of a product of powers of the parent coordinates over the cell."""
    if shape_of(cell) in ("triangle", "tetra"):
        return np.prod([factorial(power) for power in powers]) / factorial(sum(powers) + len(powers))
    return np.prod([(1 - (-1) ** (power + 1)) / (power + 1) for power in powers])


def monomials(dimension, degree, *, total):
    return [p for p in product(range(degree + 1), repeat=dimension) if not total or sum(p) <= degree]


@pytest.mark.parametrize(("cell", "points"), RULES)
def test_functions_interpolate_polynomials(cell, points):
    """Values and slopes at the points: linear functions in all families, quadratic ones where edges have middles."""
    nodes = nodes_of(cell)
    _, shapes, slopes = rule_of(cell, points)
    places = shapes @ nodes
    family = family_of(cell)
    degree = 2 if family.nodes > family.corners else 1
    for powers in monomials(family.dimension, degree, total=True):
        np.testing.assert_allclose(shapes @ (nodes**powers).prod(axis=1), (places**powers).prod(axis=1), atol=1e-14)
        for axis, power in enumerate(powers):
            lower = np.array(powers) - np.eye(family.dimension, dtype=int)[axis]
            expected = power * (places ** np.maximum(lower, 0)).prod(axis=1)
            np.testing.assert_allclose(slopes[:, :, axis] @ (nodes**powers).prod(axis=1), expected, atol=2e-14)


@pytest.mark.parametrize(("cell", "points"), RULES)
def test_rules_integrate_polynomials(cell, points):
    weights, shapes, _ = rule_of(cell, points)
    places = shapes @ nodes_of(cell)
    simplex = shape_of(cell) in ("triangle", "tetra")
    for powers in monomials(places.shape[1], DEGREES[shape_of(cell), points], total=simplex):
        assert weights @ (places**powers).prod(axis=1) == pytest.approx(integral(cell, powers), rel=1e-12, abs=1e-13)


@pytest.mark.parametrize("cell", [family.cell for family in KNOWN if family.dimension > 1])
def test_faces(cell):
    """Faces lie on the boundary, their middles between their corners; together they are all of it."""
    family, nodes = family_of(cell), nodes_of(cell)
    total = np.zeros(family.dimension)
    for face in family.faces:
        of_face = family.face_family(face)
        assert (of_face.nodes > of_face.corners) == (family.nodes > family.corners)
        x = nodes[list(face)]
        expected = nodes_of(of_face.cell)
        corners = x[: of_face.corners]
        for place, middle in zip(expected[of_face.corners :], x[of_face.corners :], strict=True):
            ends = corners[[k for k in range(of_face.corners) if is_on_edge(place, expected[k], of_face.cell)]]
            np.testing.assert_allclose(middle, ends.mean(axis=0))
        weights, _, slopes = rule_of(of_face.cell, of_face.full_points)
        tangents = np.einsum("kd,pka->pda", x, slopes)
        normal = (
            np.cross(tangents[..., 0], tangents[..., 1]) if family.dimension == 3 else tangents[..., ::-1, 0] * [1, -1]
        )
        area = weights @ normal
        outward = np.sign(area @ (x.mean(axis=0) - nodes.mean(axis=0)))
        assert outward
        total += outward * area
    np.testing.assert_allclose(total, 0, atol=1e-14)


def is_on_edge(middle, corner, cell):
    """Whether a middle is that of an edge that ends in a corner, in the parent coordinates of a face."""
    corners = nodes_of(cell)[: family_of(cell).corners]
    return any(np.allclose(middle, (corner + other) / 2) and not np.allclose(corner, other) for other in corners)


@pytest.mark.parametrize(("family", "points"), [(0, 1), (99, 1), (5, 5), (5, 28), (3, 2)])
def test_rules_that_do_not_exist(family, points):
    with pytest.raises(ValueError, match=f"no family {family} of 4 nodes with {points} integration points"):
        _binding.integration_rule(family, points, 4, 2)


def test_sizes_have_to_agree():
    with pytest.raises(ValueError, match="no family 5 of 8 nodes with 4 integration points"):
        _binding.integration_rule(5, 4, 8, 2)


def unknown_family(kind):
    if isinstance(kind, ContinuumType):
        return replace(kind, family=replace(kind.family, number=99))
    return replace(kind, face=replace(kind.face, number=99))


def test_family_that_the_host_does_not_know(solid_group, bound, load, call, monkeypatch):
    monkeypatch.setitem(BUILT_IN, "CPS4", unknown_family(BUILT_IN["CPS4"]))
    nodes = np.column_stack([SQUARE, np.zeros(4)]).astype(float)
    block, matrix = bound(solid_group("CPS4", np.arange(4)[None], 1.0), nodes, load(None))
    message = r"element 101 \(type CPS4\): .*family 99 with 4 integration points is not known to the host"
    with pytest.raises(KernelError, match=message):
        block.evaluate(call, np.zeros(8), np.zeros(8), np.zeros(8), matrix.data)


def test_every_type_has_its_rules():
    """Whatever a type of the table asks the host for, it has."""
    for kind in (*CONTINUUM.values(), *COUPLED.values()):
        for points in (kind.points, kind.mass_points, kind.body_points, kind.thermal_points):
            weights, _, _ = rule_of(kind.family.cell, points)
            assert len(weights) == points
    assert len({family.number for family in KNOWN}) == len(KNOWN)
    assert sorted(DiscreteKind) == [1, 2, 3, 4, 5]
