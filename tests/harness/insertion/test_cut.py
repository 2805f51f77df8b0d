# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The cut of random meshes: volumes, orientation, manifoldness, and which nodes are doubled."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from solid_grids import grid

from uel.insertion.connectivity import element_nodes, face_nodes, face_normals, interface_types, recommended
from uel.insertion.cut import Cells, Solids, cut
from uel.model.element_types import CONTINUUM, FAMILIES

KINDS = ("CPS3", "CPS4", "CPS6", "CPS8", "C3D4", "C3D6", "C3D8", "C3D10", "C3D15", "C3D20")


def solids_of(mesh):
    points = np.zeros((len(mesh.nodes), 3))
    points[:, : mesh.nodes.shape[1]] = mesh.nodes
    return Solids(points, [Cells(mesh.family, np.arange(len(mesh.elements)), mesh.elements)])


def a_mesh(kind, seed=0):
    dimension = CONTINUUM[kind].family.dimension
    return grid(kind, (3, 3, 2)[:dimension], (3.0, 2.0, 2.0)[:dimension], 0.2, seed)


def volumes(family, points, elements):
    """Areas or volumes: pyramids of signed volume over triangles of the faces, with the tip in the middle."""
    corners = points[elements[:, : family.corners]]
    total = np.zeros(len(elements))
    middle = corners.mean(axis=1)
    for face in family.faces:
        around = [node for node in face if node < family.corners]
        if family.dimension == 2:
            a, b = (corners[:, node] - middle for node in around)
            total += 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
        else:
            centre = corners[:, around].mean(axis=1) - middle
            for one, two in zip(around, around[1:] + around[:1], strict=True):
                a, b = corners[:, one] - middle, corners[:, two] - middle
                total += np.einsum("ij,ij->i", centre, np.cross(a, b)) / 6.0
    return total


def parts_at(node, mesh, pairs, solids, cuts):
    """Solids around a node that hang together, found by walking from one to the next."""
    around = {k for k, element in enumerate(mesh.elements) if node in element}
    links = {k: set() for k in around}
    for (a, b), separated in zip(solids.element[pairs], cuts, strict=True):
        if not separated and a in around and b in around:
            shared = set(mesh.elements[a]) & set(mesh.elements[b])
            if node in shared:
                links[a].add(b)
                links[b].add(a)
    parts = []
    while around:
        part, todo = set(), [min(around)]
        while todo:
            each = todo.pop()
            if each not in part:
                part.add(each)
                todo += links[each]
        around -= part
        parts.append(part)
    return parts


@pytest.mark.parametrize("kind", ["CPS3", "CPS8", "C3D6", "C3D10", "C3D20"])
@settings(max_examples=5)
@given(data=st.data())
def test_nodes_are_doubled_where_the_solids_around_them_fall_apart(kind, data):
    mesh = a_mesh(kind)
    solids = solids_of(mesh)
    cuts = np.array(data.draw(st.lists(st.booleans(), min_size=len(solids.pairs), max_size=len(solids.pairs))))
    after = cut(solids, cuts)
    changed = after.cells[0].nodes
    old = np.concatenate([np.arange(len(mesh.nodes)), after.origins])
    assert np.array_equal(old[changed], mesh.elements)
    for node in range(len(mesh.nodes)):
        parts = parts_at(node, mesh, solids.pairs, solids, cuts)
        numbers = [{int(changed[k][mesh.elements[k] == node][0]) for k in part} for part in parts]
        assert all(len(one) == 1 for one in numbers)
        assert len(set.union(*numbers)) == len(parts)
        assert min(set.union(*numbers)) == node


@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=10)
@given(seed=st.integers(0, 2**31), share=st.floats(0.0, 1.0))
def test_volume_orientation_and_manifoldness_stay(kind, seed, share):
    mesh = a_mesh(kind, seed)
    solids = solids_of(mesh)
    cuts = np.random.default_rng(seed).random(len(solids.pairs)) < share
    after = cut(solids, cuts)
    points = np.concatenate([solids.points, solids.points[after.origins]])
    assert np.array_equal(
        volumes(mesh.family, points, after.cells[0].nodes), volumes(mesh.family, solids.points, mesh.elements)
    )
    result = Solids(points, after.cells)
    assert result.manifold
    # a face stays shared unless it is cut and one of its nodes is doubled
    doubled = np.isin(solids.nodes[solids.pairs[:, 0]], after.origins).any(axis=1)
    separate = {tuple(pair) for pair in solids.pairs[cuts & doubled].tolist()}
    shared = {tuple(pair) for pair in result.pairs.tolist()}
    assert shared <= {tuple(pair) for pair in solids.pairs.tolist()}
    assert {tuple(pair) for pair in solids.pairs[~cuts].tolist()} <= shared
    assert len(shared & separate) + len(separate - shared) == len(separate)


def test_a_cross_of_two_cuts_makes_four_nodes_of_one():
    mesh = grid("CPS4", (2, 2), (2.0, 2.0))
    solids = solids_of(mesh)
    after = cut(solids, np.ones(len(solids.pairs), dtype=bool))
    assert after.copies(9) == {1: [9], 3: [10], 4: [11, 12, 13], 5: [14], 7: [15]}


def test_a_t_junction_makes_three_nodes_of_one():
    mesh = grid("CPS4", (2, 2), (2.0, 2.0))
    solids = solids_of(mesh)
    # between the rows, and between the two elements of the upper one
    rows = mesh.cell[solids.element[solids.pairs]][:, :, 1]
    after = cut(solids, (rows[:, 0] != rows[:, 1]) | np.all(rows == 1, axis=1))
    assert {node: len(copies) for node, copies in after.copies(9).items()} == {3: 1, 4: 2, 5: 1, 7: 1}


@pytest.mark.parametrize("kind", ["CPS4", "CPS8", "C3D8", "C3D20"])
def test_the_nodes_at_the_end_of_a_cut_stay_whole(kind):
    mesh = a_mesh(kind)
    solids = solids_of(mesh)
    low, high = (mesh.cell[solids.element[solids.pairs[:, side]]] for side in (0, 1))
    last = mesh.cell.shape[1] - 1
    cuts = (low[:, last] != high[:, last]) & (np.minimum(low, high)[:, last] == 0) & (low[:, 0] < 2)
    after = cut(solids, cuts)
    on_cut = np.unique(solids.nodes[solids.pairs[cuts, 0]][:, : solids.sizes[0]])
    ahead = np.unique(mesh.elements[mesh.cell[:, 0] == 2])
    assert set(after.origins.tolist()) == set(on_cut.tolist()) - set(ahead.tolist())


def test_bodies_that_touch_at_a_node_are_not_separated_there():
    nodes = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1], [2, 1], [2, 2], [1, 2], [3, 1], [3, 2]])
    elements = np.array([[0, 1, 2, 3], [2, 4, 5, 6], [4, 7, 8, 5]])
    points = np.column_stack([nodes, np.zeros(len(nodes))])
    solids = Solids(points, [Cells(CONTINUUM["CPS4"].family, np.arange(3), elements)])
    after = cut(solids, np.ones(len(solids.pairs), dtype=bool))
    assert sorted(after.copies(9)) == [4, 5]
    assert after.cells[0].nodes[0].tolist() == [0, 1, 2, 3]
    assert after.cells[0].nodes[1][0] == 2


@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=10)
@given(seed=st.integers(0, 2**31))
def test_interface_elements_lie_between_their_solids(kind, seed):
    mesh = a_mesh(kind, seed)
    rng = np.random.default_rng(seed)
    solids = solids_of(mesh)
    after = cut(solids, np.ones(len(solids.pairs), dtype=bool))
    points = np.concatenate([solids.points, solids.points[after.origins]])
    cells = {mesh.family.number: after.cells[0]}
    flipped = rng.random(len(solids.pairs)) < 0.5
    sides = np.where(flipped[:, None], solids.pairs[:, ::-1], solids.pairs)
    sizes = solids.sizes[sides[:, 0]]
    for size in np.unique(sizes):
        chosen = sides[sizes == size]
        face = FAMILIES[mesh.family.dimension - 1, int(size)]
        both = (mesh.family, mesh.family)
        for element in (each for each in interface_types().values() if each.face is face and each.solids in ((), both)):
            nodes = element_nodes(element, solids, chosen[:, 0], chosen[:, 1], cells)
            bottom, top = nodes[:, list(element.bottom)], nodes[:, list(element.top)]
            assert np.array_equal(points[bottom], points[top])
            assert not np.any(bottom == top)
            for place, side in ((bottom, 0), (top, 1)):
                numbers = solids.element[chosen[:, side]]
                assert all(
                    set(row) <= set(own)
                    for row, own in zip(place, cells[mesh.family.number].nodes[numbers], strict=True)
                )
            corners = points[bottom[:, : face.corners]]
            towards = solids.centroids[solids.element[chosen[:, 1]]] - corners.mean(axis=1)
            assert np.all(np.einsum("ij,ij->i", face_normals(corners), towards) > 0)
            if element.solids:
                half = element.solids[0].nodes
                for part, side in ((nodes[:, :half], 0), (nodes[:, half:], 1)):
                    own = cells[mesh.family.number].nodes[solids.element[chosen[:, side]]]
                    assert np.array_equal(np.sort(part, axis=1), np.sort(own, axis=1))
                    assert_oriented(element.solids[0], points, part)


def assert_oriented(family, points, elements):
    """Positive area or volume in the numbering of the family, and middles in the middles of its edges."""
    x = points[elements]
    if family.dimension == 2:
        # of a triangle two edges, of a quad the diagonals
        e, f = (x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]) if family.corners == 3 else (x[:, 2] - x[:, 0], x[:, 3] - x[:, 1])
        assert np.all(e[:, 0] * f[:, 1] - e[:, 1] * f[:, 0] > 0)
    else:
        # edges of the first face, and that which leaves it
        size = 3 if family.corners == 4 else family.corners // 2
        for k in range(1 if family.corners == 4 else size):
            away = 3 if family.corners == 4 else k + size
            edges = [x[:, node] - x[:, k] for node in ((k + 1) % size, (k + size - 1) % size, away)]
            assert np.all(np.einsum("ij,ij->i", np.cross(edges[0], edges[1]), edges[2]) > 0)
    for face in family.faces:
        corners = sum(node < family.corners for node in face)
        for k, middle in enumerate(face[corners:]):
            a, b = face[k], face[(k + 1) % corners]
            assert np.allclose(x[:, middle], 0.5 * (x[:, a] + x[:, b]), atol=1e-12)


def test_types_that_fit_come_with_the_recommended_one_first():
    quad, brick = CONTINUUM["CPS4"].family, CONTINUUM["C3D20"].family
    line = FAMILIES[1, 2]
    triangle, wedge = CONTINUUM["CPS3"].family, CONTINUUM["C3D6"].family
    assert recommended(line, quad, quad).name == "U4"
    assert recommended(FAMILIES[2, 8], brick, brick).name == "U12"
    assert [recommended(line, *pair).name for pair in ((quad, triangle), (triangle, quad))] == ["U43", "U34"]
    # wedges on each other by quadrilaterals: the standard element
    assert [recommended(FAMILIES[2, size], wedge, wedge).name for size in (3, 4)] == ["U606", "U7"]
    assert recommended(FAMILIES[1, 3], quad, quad).name == "U5"
    assert "U3" not in interface_types()


def test_normals_point_out_of_the_solids():
    solids = solids_of(a_mesh("C3D8"))
    corners = solids.points[face_nodes(solids, np.arange(len(solids.element)))[:, :4]]
    outward = corners.mean(axis=1) - solids.centroids[solids.element]
    assert np.all(np.einsum("ij,ij->i", face_normals(corners), outward) > 0)
