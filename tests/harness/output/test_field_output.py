# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest
from reference_cells import nodes_of

from uel.errors import Source
from uel.model.element_types import CONTINUUM
from uel.model.mesh import ElementGroup, Mesh
from uel.model.model import Model
from uel.model.properties import UserElement, UserProperty
from uel.model.records import ElementState, IncrementDone, PointVariables, Record, Solution
from uel.output.cells import cells_of
from uel.output.files.field_output import FieldFiles, read_field_mesh
from uel.usersub.layout import element_layouts, variables

Records = Callable[..., Iterator[Record]]


def last(records: Iterator[Record]) -> IncrementDone:
    return [record for record in records if isinstance(record, IncrementDone)][-1]


def test_continuum_and_interface_are_in_one_file(model: Model, records: Records, tmp_path: Path) -> None:
    """SVARS are 100 x element + position: means over the points are known."""
    FieldFiles(tmp_path / "job.pvd", model).write(last(records(model)), last=True)
    mesh = meshio.read(tmp_path / "job_vtu" / "step1_increment0004.vtu")
    assert [(block.type, block.data.tolist()) for block in mesh.cells] == [
        ("quad", [[0, 1, 2, 3], [4, 5, 6, 7]]),
        ("line", [[3, 2]]),
    ]
    assert mesh.points[:, 1].tolist() == [0, 0, 1, 1, 1, 1, 2, 2]
    assert mesh.point_data["U"][:, 1].tolist() == [0, 0, 1, 1, 1, 1, 2, 2]
    assert mesh.point_data["RF"][:, 1].tolist() == [-1, -1, 0, 0, 0, 0, 0, 0]
    assert mesh.point_data["NODE"].tolist() == list(range(1, 9))
    continuum, interface = mesh.cell_data["S11"]
    assert continuum.tolist() == [100 + 1 + 6, 200 + 1 + 6]
    assert np.isnan(interface).all()
    continuum, interface = mesh.cell_data["DAMAGE"]
    assert np.isnan(continuum).all()
    assert interface.tolist() == [1100 + 6 + 3.5]
    assert [block.tolist() for block in mesh.cell_data["ELEMENT"]] == [[1, 2], [11]]
    assert "X" not in mesh.cell_data


@pytest.mark.parametrize(
    ("nodes", "solid", "kind"),
    [
        (2, False, "line"),
        (3, False, "triangle"),
        (4, False, "quad"),
        (6, False, "triangle6"),
        (8, False, "quad8"),
        (4, True, "tetra"),
        (6, True, "wedge"),
        (8, True, "hexahedron"),
        (10, True, "tetra10"),
        (15, True, "wedge15"),
        (20, True, "hexahedron20"),
    ],
)
def test_user_elements_are_drawn_by_their_number_of_nodes(nodes: int, solid: bool, kind: str) -> None:
    group = group_of(np.arange(2 * nodes).reshape(2, nodes))
    cells = cells_of(group, None, solid=solid)
    assert cells.type == kind
    assert cells.nodes.tolist() == group.nodes.tolist()
    assert cells.element.tolist() == [0, 1]


@pytest.mark.parametrize(
    ("jtype", "kind"), [(34, "line"), (66, "line3"), (404, "triangle"), (1010, "triangle6"), (8, "quad"), (12, "quad8")]
)
def test_interfaces_are_drawn_by_their_bottom_face(jtype: int, kind: str) -> None:
    """Three nodes are a line in the plane, a triangle in space."""
    known = element_layouts()[jtype]
    source = Source("deck.inp", 1)
    definition = UserElement(jtype, known.nodes, (), source, coordinates=known.dimension)
    group = replace(group_of(np.arange(2 * known.nodes).reshape(2, -1)), definition=definition)
    cells = cells_of(group, variables(jtype), solid=known.dimension == 3)
    assert cells.type == kind
    assert cells.nodes.tolist() == group.nodes[:, list(known.faces[0])].tolist()


VTK_EDGES = {
    # ends of the edges whose middles follow the corners (VTK's file formats)
    **{"triangle6": [(0, 1), (1, 2), (2, 0)], "quad8": [(0, 1), (1, 2), (2, 3), (3, 0)]},
    "tetra10": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
    "wedge15": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
    "hexahedron20": [
        *((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)),
        *((0, 4), (1, 5), (2, 6), (3, 7)),
    ],
}


@pytest.mark.parametrize("name", CONTINUUM)
def test_built_in_elements_are_drawn_as_cells_of_vtk(name: str, tmp_path: Path) -> None:
    """The file has the nodes of the element in the order of VTK: corners, then the middles of its edges."""
    cell = CONTINUUM[name].family.cell
    points = nodes_of(cell)
    group = replace(group_of(np.arange(len(points))[None]), type=name, definition=None)
    cells = cells_of(group, None, solid=points.shape[1] == 3)
    drawn = meshio.Mesh(np.pad(points, ((0, 0), (0, 3 - points.shape[1]))), [(cells.type, cells.nodes)])
    meshio.vtu.write(tmp_path / "cell.vtu", drawn)
    (block,) = meshio.read(tmp_path / "cell.vtu").cells
    assert block.type == cell
    corners = len(points) - len(VTK_EDGES.get(cell, []))
    x = points[block.data[0]]
    np.testing.assert_array_equal(x[:corners], points[:corners])
    middles = [x[list(edge)].mean(axis=0) for edge in VTK_EDGES.get(cell, [])]
    np.testing.assert_allclose(x[corners:], np.reshape(middles, (-1, points.shape[1])))


def test_user_elements_of_another_kind_are_drawn_as_their_nodes() -> None:
    cells = cells_of(group_of(np.array([[0, 1, 2, 3, 4], [4, 5, 6, 7, 8]])), None, solid=False)
    assert cells.type == "vertex"
    assert cells.nodes[:, 0].tolist() == [0, 1, 2, 3, 4, 4, 5, 6, 7, 8]
    assert cells.element.tolist() == [0] * 5 + [1] * 5


def test_an_eight_node_interface_is_drawn_between_its_quads() -> None:
    damage = PointVariables("interface", ("DAMAGE",), 2, bottom=(3, 2), top=(4, 5))
    definition = UserElement(4, 8, (), Source("deck.inp", 1))
    cells = cells_of(replace(group_of(np.arange(8)[None, :]), definition=definition), damage, solid=False)
    assert (cells.type, cells.nodes.tolist()) == ("line", [[3, 2]])


def test_a_solid_model_is_told_by_its_coordinates(model: Model, records: Records, tmp_path: Path) -> None:
    raised = model.mesh.coordinates + np.array([[0.0, 0.0, 1.0]]) * (np.arange(8)[:, None] == 7)
    model = replace(model, mesh=Mesh(model.mesh.labels, raised, model.mesh.instances))
    done = last(records(model))
    unknown = tuple(replace(state, variables=None) for state in done.solution.elements)
    done = replace(done, solution=replace(done.solution, elements=unknown))
    FieldFiles(tmp_path / "job.pvd", model).write(done, last=True)
    assert [block.type for block in read_field_mesh(tmp_path / "job.pvd").cells] == ["tetra"]


def test_other_dofs_have_arrays_of_their_own(model: Model, records: Records, tmp_path: Path) -> None:
    done = last(records(model))
    node, dof = np.append(done.solution.node, [2, 5]), np.append(done.solution.dof, [11, 6])
    more = {name: np.append(getattr(done.solution, name), [20.0, 0.5]) for name in ("displacement", "reaction", "load")}
    done = replace(done, solution=replace(done.solution, node=node, dof=dof, **more))
    FieldFiles(tmp_path / "job.pvd", model).write(done, last=True)
    data = read_field_mesh(tmp_path / "job.pvd").point_data
    assert data["NT11"].tolist() == [0, 0, 20, 0, 0, 0, 0, 0]
    assert data["UR3"].tolist() == [0, 0, 0, 0, 0, 0.5, 0, 0]


def test_no_unfinished_file_is_left(model: Model, records: Records, tmp_path: Path) -> None:
    files = FieldFiles(tmp_path / "job.pvd", model)
    for record in records(model):
        if isinstance(record, IncrementDone):
            files.write(record, last=False)
    assert not list(tmp_path.rglob("*.tmp"))
    assert len(list((tmp_path / "job_vtu").iterdir())) == 4


def group_of(nodes: np.ndarray) -> ElementGroup:
    source = Source("deck.inp", 1)
    labels = np.arange(1, len(nodes) + 1)
    return ElementGroup("U5", labels, nodes, "", UserProperty("ALL", source), None, source)


def test_five_thousand_elements_take_less_than_a_megabyte(model: Model, tmp_path: Path) -> None:
    """A beam of 625 x 8 quads with strains and stresses at four points each, in noise, which compresses worst."""
    columns, rows = 625, 8
    x, y = np.meshgrid(np.linspace(0.0, 150.0, columns + 1), np.linspace(0.0, 3.0, rows + 1))
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    quads = np.stack([first, first + 1, first + columns + 2, first + columns + 1], axis=1)
    count = x.size
    noise = np.random.default_rng(1).standard_normal
    mesh = Mesh(np.arange(count) + 1, np.stack([x.ravel(), y.ravel(), np.zeros(count)], axis=1), ("",) * count)
    names = ("E11", "E22", "E33", "E12", "S11", "S22", "S33", "S12")
    state = ElementState(
        0,
        noise((len(quads), 32)),
        np.zeros((len(quads), 8)),
        PointVariables("continuum", names, 4, outline=(0, 1, 2, 3)),
    )
    node, dof = np.repeat(np.arange(count), 2), np.tile([1, 2], count)
    solution = Solution(node, dof, noise(2 * count), np.zeros(2 * count), np.zeros(2 * count), {}, (state,))
    files = FieldFiles(tmp_path / "job.pvd", replace(model, mesh=mesh, groups=(group_of(quads),)))
    files.write(IncrementDone(1, 1, 1, 1, 0.1, 0.1, 0.1, solution), last=False)
    assert (tmp_path / "job_vtu" / "step1_increment0001.vtu").stat().st_size < 1e6
