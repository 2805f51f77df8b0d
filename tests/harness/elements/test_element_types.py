# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The table of element types and the functions and rules of the host that belong to its families."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from reference_cells import EDGES, FACES, SQUARE, integral, monomials, nodes_of, shape_of, unit_cell

from uel.elements import build_blocks
from uel.errors import KernelError
from uel.model.element_types import BUILT_IN, CONTINUUM, COUPLED, FAMILIES, MODIFIED, ContinuumType, DiscreteKind
from uel.model.mesh import Mesh
from uel.model.model import Model
from uel.usersub import _binding

KNOWN = [family for family in FAMILIES.values() if family.number]
RULES = sorted(
    {(family.cell, family.full_points) for family in KNOWN}
    | {(kind.family.cell, points) for kind in CONTINUUM.values() for points in (kind.points, kind.body_points)}
    | {(kind.family.cell, kind.thermal_points) for kind in COUPLED.values()}
)
DEGREES = {
    # polynomials that a number of points integrates exactly, in each direction of cells with parallel faces
    **{("triangle", 1): 1, ("triangle", 3): 2, ("triangle", 6): 4, ("tetra", 1): 1, ("tetra", 4): 2, ("tetra", 15): 5},
    # of wedges along the triangles and across
    **{("wedge", 2): (1, 3), ("wedge", 6): (2, 3), ("wedge", 9): (2, 5), ("wedge", 18): (4, 5)},
    **{(shape, n**d): 2 * n - 1 for shape, d in (("line", 1), ("quad", 2), ("hexahedron", 3)) for n in (1, 2, 3)},
}


def family_of(cell):
    return next(family for family in KNOWN if family.cell == cell)


def rule_of(cell, points):
    family = family_of(cell)
    return _binding.integration_rule(family.number, points, family.nodes, family.dimension)


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
    shape = shape_of(cell)
    degree = DEGREES[shape, points]
    if shape == "wedge":
        in_plane, along = degree
        tried = [(*p, q) for p in monomials(2, in_plane, total=True) for q in range(along + 1)]
    else:
        tried = monomials(places.shape[1], degree, total=shape in ("triangle", "tetra"))
    for powers in tried:
        assert weights @ (places**powers).prod(axis=1) == pytest.approx(integral(cell, powers), rel=1e-12, abs=1e-13)


@pytest.mark.parametrize("cell", [family.cell for family in KNOWN if family.dimension > 1])
def test_faces(cell):
    """Corners are those of Abaqus' faces, round in either direction; middles lie between the corners of their edges."""
    family, nodes = family_of(cell), nodes_of(cell)
    assert len(family.faces) == len(FACES[shape_of(cell)])
    for face, expected in zip(family.faces, FACES[shape_of(cell)], strict=True):
        of_face = family.face_family(face)
        corners, middles = face[: of_face.corners], face[of_face.corners :]
        start = corners.index(expected[0])
        forwards = corners[start:] + corners[:start]
        assert expected in (forwards, (forwards[0], *forwards[:0:-1]))
        edges = EDGES[shape_of(of_face.cell)] if middles else []
        assert (len(middles) > 0) == (family.nodes > family.corners)
        for middle, (a, b) in zip(middles, edges, strict=True):
            np.testing.assert_allclose(nodes[middle], (nodes[corners[a]] + nodes[corners[b]]) / 2)


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
    nodes = np.column_stack([SQUARE, np.zeros(4)])
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
    assert sorted(DiscreteKind) == [1, 2, 3, 4, 5, 6, 7]


@pytest.mark.parametrize("element_type", MODIFIED)
def test_modified_elements_say_once_what_they_are(solid_group, load, element_type):
    plain = CONTINUUM[element_type.replace("M", "")]
    x = 1.0 + unit_cell(plain.family.cell)[0]
    x = np.column_stack([x, np.zeros((len(x), 3 - x.shape[1]))])
    names = (element_type, element_type, plain.name)
    first, other, last = (solid_group(name, np.arange(len(x))[None], 1.0) for name in names)
    groups = (first, replace(other, labels=np.array([7])), replace(last, labels=np.array([8])))
    library = load(None)
    build_blocks(Model(Path("test.inp"), "", Mesh(np.arange(len(x)), x, ("",) * len(x)), groups, ()), library)
    (warning,) = [message.text for message in library.messages()]
    same = "the interpolation, the pressure and the mass" if plain.pressures else "the interpolation and the mass"
    assert f"test.inp:7: elements of type {element_type} have {same} of {plain.name} here" in warning
    assert replace(CONTINUUM[element_type], name=plain.name, modified=False) == plain
