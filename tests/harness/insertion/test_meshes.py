# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of other programs, and the command itself."""

import subprocess
import sys

import meshio
import numpy as np
import pytest
from solid_grids import LAW, grid

from uel.cli import main
from uel.deck.reader import read_deck
from uel.errors import UsageError
from uel.insertion.meshes import read_mesh
from uel.model.element_types import CONTINUUM

STRONG = ("SIGMAMAX=30", "TAUMAX=60", "GIC=10", "GIIC=10")


def gmsh_file(path, mesh, groups, faces=()):
    """Write a mesh as Gmsh does: physical groups of solids by a number for each, and of edges or faces.

    groups: (elements,) name of each; faces: name, nodes of each cell, shape.
    """
    points = np.zeros((len(mesh.nodes), 3))
    points[:, : mesh.nodes.shape[1]] = mesh.nodes
    names = list(dict.fromkeys(groups))
    dimension = mesh.family.dimension
    cells = [(mesh.family.cell, mesh.elements)]
    tags = [np.array([1 + names.index(name) for name in groups])]
    field_data = {name: np.array([1 + k, dimension]) for k, name in enumerate(names)}
    for k, (name, nodes, shape) in enumerate(faces, start=1):
        cells.append((shape, np.array(nodes)))
        tags.append(np.full(len(nodes), k))
        field_data[name] = np.array([k, dimension - 1])
    data = {"gmsh:physical": tags, "gmsh:geometrical": tags}
    meshio.write(path, meshio.Mesh(points, cells, cell_data=data, field_data=field_data), file_format="gmsh22")


def layers(kind="CPS4", counts=(3, 2)):
    mesh = grid(kind, counts, tuple(map(float, counts)))
    return mesh, np.where(mesh.cell[:, -1] == 0, "LOW", "HIGH").tolist()


def test_physical_groups_of_gmsh_become_sets(tmp_path):
    mesh, groups = layers()
    gmsh_file(tmp_path / "m.msh", mesh, groups, [("left side", [[0, 4], [4, 8]], "line")])
    lines = read_mesh(tmp_path / "m.msh", ())
    deck = tmp_path / "m.inp"
    deck.write_text("\n".join([*lines, *SECTION, "*STEP", "*STATIC", "*END STEP"]))
    model = read_deck(deck)
    assert {name: len(found) for name, found in model.elsets.items()} == {"LOW": 3, "HIGH": 3}
    assert model.mesh.labels[model.nsets["LEFT_SIDE"]].tolist() == [1, 5, 9]
    assert np.array_equal(model.mesh.coordinates[:, :2], mesh.nodes)
    assert {group.type for group in model.groups} == {"CPS4"}


SECTION = ["*SOLID SECTION, ELSET=LOW, MATERIAL=M", "1.", "*SOLID SECTION, ELSET=HIGH, MATERIAL=M", "1."]
SECTION += ["*MATERIAL, NAME=M", "*ELASTIC", "1e4, 0.3"]


def test_names_of_groups_need_no_quotes(tmp_path):
    """In Abaqus blanks of a name without quotes do not count, and a name begins with a letter or an underscore."""
    mesh, _ = layers()
    groups = np.where(mesh.cell[:, -1] == 0, "ply 1 (0°)", "90").tolist()
    gmsh_file(tmp_path / "m.msh", mesh, groups)
    lines = read_mesh(tmp_path / "m.msh", ())
    assert [line for line in lines if "ELSET=" in line] == ["*ELSET, ELSET=PLY_1__0__", "*ELSET, ELSET=_90"]


def test_two_groups_that_would_be_one_set(tmp_path):
    mesh, groups = layers()
    gmsh_file(tmp_path / "m.msh", mesh, [{"LOW": "ply 1", "HIGH": "Ply_1"}[name] for name in groups])
    with pytest.raises(UsageError, match=r"m\.msh: groups 'ply 1' and 'Ply_1' are both PLY_1 in a deck; rename one"):
        read_mesh(tmp_path / "m.msh", ())


@pytest.mark.parametrize("kind", ["CPS3", "CPS4", "CPS6", "CPS8", "C3D4", "C3D6", "C3D8", "C3D10", "C3D15", "C3D20"])
def test_cells_become_the_elements_with_their_nodes(tmp_path, kind):
    mesh, groups = layers(kind, (2, 2, 2)[: CONTINUUM[kind].family.dimension])
    gmsh_file(tmp_path / "m.msh", mesh, groups)
    lines = read_mesh(tmp_path / "m.msh", ())
    deck = tmp_path / "m.inp"
    deck.write_text("\n".join([*lines, *SECTION, "*STEP", "*STATIC", "*END STEP"]))
    model = read_deck(deck)
    assert {group.type for group in model.groups} == {kind}
    assert np.array_equal(np.concatenate([group.nodes for group in model.groups]), mesh.elements)


def test_solids_are_those_asked_for_and_clockwise_faces_are_turned(tmp_path):
    mesh, groups = layers("CPS8")
    order = [0, 3, 2, 1, 7, 6, 5, 4]
    mesh.elements = mesh.elements[:, order]
    gmsh_file(tmp_path / "m.msh", mesh, groups)
    lines = read_mesh(tmp_path / "m.msh", ["cpe8r"])
    first = lines.index("*ELEMENT, TYPE=CPE8R") + 1
    found = np.array([[int(word) for word in line.split(",")] for line in lines[first : first + 6]])
    assert np.array_equal(found[:, 1:] - 1, mesh.elements[:, order])


def test_other_formats_and_named_sets_of_meshio(tmp_path):
    mesh, _ = layers()
    points = np.column_stack([mesh.nodes, np.zeros(len(mesh.nodes))])
    meshio.write(tmp_path / "m.vtk", meshio.Mesh(points, [("quad", mesh.elements)]))
    assert sum(line.startswith("*ELEMENT") for line in read_mesh(tmp_path / "m.vtk", ())) == 1


ERRORS = [
    ("missing.msh", None, "cannot read .*missing.msh: No such file"),
    ("broken.msh", "no mesh", "cannot read the mesh .*broken.msh: "),
    ("what.xyz", "1 2 3", "cannot read the mesh .*what.xyz: Could not deduce file format"),
]


@pytest.mark.parametrize(("name", "content", "message"), ERRORS)
def test_files_that_are_no_meshes(tmp_path, name, content, message):
    if content is not None:
        (tmp_path / name).write_text(content)
    with pytest.raises(UsageError, match=message):
        read_mesh(tmp_path / name, ())


@pytest.mark.parametrize(
    ("cells", "types", "message"),
    [
        ([("line", [[0, 1]])], (), "has no triangles, quadrilaterals or solids"),
        ([("triangle", [[0, 1, 4]])], (), "do not lie in a plane z = constant, and it has no solids"),
        ([("pyramid", [[0, 1, 2, 3, 4]])], (), "cells of type pyramid, for which there is no element .*: tetra, "),
        ([("triangle", [[0, 1, 2]])], ("S4R",), "--solids S4R: expected continuum elements"),
    ],
)
def test_meshes_without_elements(tmp_path, cells, types, message):
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 1]])
    file = tmp_path / "m.vtk"
    meshio.write(file, meshio.Mesh(points, [(name, np.array(data)) for name, data in cells]))
    with pytest.raises(UsageError, match=message):
        read_mesh(file, types)


def test_gmsh_is_told_how_to_leave_out_middle_nodes(tmp_path):
    points = np.random.default_rng(1).random((9, 3)) * [1, 1, 0]
    meshio.write(tmp_path / "m.vtu", meshio.Mesh(points, [("quad9", np.arange(9)[None])]))
    with pytest.raises(UsageError, match=r"cells of type quad9.*Mesh\.SecondOrderIncomplete = 1"):
        read_mesh(tmp_path / "m.vtu", ())


def test_a_mesh_and_its_deck_become_a_model_that_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    mesh, groups = layers("C3D8", (2, 1, 2))
    bottom = mesh.elements[mesh.cell[:, 2] == 0][:, :4]
    top = mesh.elements[mesh.cell[:, 2] == 1][:, 4:]
    gmsh_file(tmp_path / "m.msh", mesh, groups, [("FIX", bottom, "quad"), ("PULL", top, "quad")])
    step = ["*STEP", "*STATIC", "1., 1.", "*BOUNDARY", "FIX, 1, 3", "PULL, 3, 3, 0.001", "*END STEP"]
    (tmp_path / "job.inp").write_text("\n".join([*SECTION, *step]) + "\n")
    # names of plies and values may stand in any order
    assert main(["insert", "m.msh", "job.inp", "--plies", "LOW", "HIGH", *STRONG, "-o", "model.inp"]) == 0
    assert capsys.readouterr().out == (
        "--plies: cut between LOW and HIGH: 2 faces\n2 elements U8 in INTERFACE, 6 nodes doubled\nwritten: model.inp\n"
    )
    assert main(["run", "model.inp", "--quiet"]) == 0


def test_the_command_says_what_is_wrong(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    mesh, groups = layers()
    gmsh_file(tmp_path / "m.msh", mesh, groups)
    both = ["insert", "m.msh", "-o", "out.inp"]
    assert main([*both, "--between", "LOW", "UP", *LAW]) == 2
    assert "--between: the mesh has no element set UP (it has: LOW, HIGH)" in capsys.readouterr().err
    assert main(["insert", "m.msh", *both[1:], "--plies", *LAW]) == 2
    assert "expected one deck, one mesh, or a mesh and then a deck" in capsys.readouterr().err
    assert main([*both, "-b", "LOW", "HIGH", *LAW]) == 2
    assert "U4 needs THICKNESS=VALUE" in capsys.readouterr().err
    assert main([*both, "-b", "LOW", "HIGH", *LAW, "THICKNESS=1"]) == 2
    message = capsys.readouterr().err
    assert "U4 owns the solids on both sides" in message
    assert "element 1 has no section" in message
    assert not (tmp_path / "out.inp").exists()
    constants = [f"{name}_{side}=1" for side in ("BOTTOM", "TOP") for name in ("E1", "E2", "G12")]
    assert main([*both, "-b", "LOW", "HIGH", *LAW, "THICKNESS=1", *constants]) == 0
    assert main(["insert", "out.inp", "-o", "out.inp", "-b", "LOW", "HIGH", *LAW]) == 2
    assert "-o out.inp: is what is read; write to another file" in capsys.readouterr().err
    assert main(["insert", "out.inp", "-o", "no/where.inp", "-b", "LOW", "HIGH", *LAW]) != 0


def test_errors_of_the_deck_come_with_their_line(tmp_path, capsys):
    (tmp_path / "d.inp").write_text("*NODE\n1, 0., 0.\n*ELEMENT, TYPE=CPS4\n1, 1, 2, 3, 4\n*CONTACT CLEARANCE\n")
    assert main(["insert", str(tmp_path / "d.inp"), "-o", str(tmp_path / "o.inp"), "--plies", *LAW]) == 1
    assert "d.inp:5: *CONTACT CLEARANCE is not supported" in capsys.readouterr().err


def test_wedges_of_fifteen_nodes_in_a_process_of_their_own(tmp_path):
    """meshio lacks the dimension of these cells; nothing that other tests import may help."""
    mesh, groups = layers("C3D15", (2, 2, 2))
    gmsh_file(tmp_path / "m.msh", mesh, groups)
    command = ["insert", "m.msh", "--between", "LOW", "HIGH", "SIGMAMAX=30", "TAUMAX=60", "GIC=10", "GIIC=10"]
    command += ["ALPHAN=1e6", "--element", "U14", "-o", "out.inp"]
    done = subprocess.run(
        [sys.executable, "-m", "uel", *command], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert "8 elements U14 in INTERFACE" in done.stdout, done.stderr
