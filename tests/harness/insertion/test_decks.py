# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What becomes of a deck's text, sets, loads and constraints; U4 and the like take properties from its sections."""

import re

import numpy as np
import pytest
from solid_grids import LAW, grid, inserted

from uel.deck.reader import read_deck
from uel.errors import DeckError, UsageError

END = ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "1.", "*MATERIAL, NAME=M", "*ELASTIC", "1e4, 0.3"]
STEP = ["*STEP", "*STATIC", "1., 1."]


def strip(kind="CPS4", counts=(3, 2)):
    """Rows of solids with the sets LOW and HIGH, and LEFT and RIGHT of nodes."""
    mesh = grid(kind, counts, tuple(map(float, counts)))
    low = mesh.cell[:, -1] == 0
    mesh.sets = {"LOW": low, "HIGH": ~low}
    mesh.node_sets = {"LEFT": mesh.end(0, 0), "RIGHT": mesh.end(0, 1)}
    return mesh


def deck(folder, mesh, model=(), step=(), name="deck.inp"):
    path = folder / name
    path.write_text("\n".join([*mesh.lines(), *END, *model, *STEP, *step, "*END STEP"]) + "\n")
    return path


def insert_between(path, *values, **options):
    output = path.with_name("out.inp")
    inserted(path, output, [*LAW, *values], between=[("LOW", "HIGH")], **options)
    return output


def labels(model, nodes):
    return sorted(model.mesh.labels[nodes].tolist())


def test_text_that_need_not_change_stays(tmp_path):
    path = deck(tmp_path, strip(), ["** my remark", "*BOUNDARY", "LEFT ,1,  2"], ["*CLOAD", "3, 2, 1.0"])
    lines = insert_between(path).read_text().splitlines()
    old = path.read_text().splitlines()
    changed = [line for line in old if line not in lines]
    # the elements of the upper row
    assert changed == ["4, 5, 6, 10, 9", "5, 6, 7, 11, 10", "6, 7, 8, 12, 11"]
    rest = iter(lines)
    # in their order
    assert all(line in rest for line in old if line not in changed)


def test_sets_and_boundary_conditions_hold_the_doubles_and_loads_do_not(tmp_path):
    step = ["*BOUNDARY", "LEFT, 1, 2", "7, 2, 2, 0.5", "*CLOAD", "RIGHT, 1, 6.", "6, 2, 1."]
    path = deck(tmp_path, strip(), step=step)
    before, after = read_deck(path), read_deck(insert_between(path))
    assert labels(before, before.nsets["LEFT"]) == [1, 5, 9]
    assert labels(after, after.nsets["LEFT"]) == [1, 5, 9, 13]
    assert labels(after, after.nsets["RIGHT"]) == [4, 8, 12, 16]
    held = {(label, b.dof) for b in after.steps[0].boundaries for label in after.mesh.labels[b.nodes].tolist()}
    assert held == {(1, 1), (5, 1), (9, 1), (13, 1), (1, 2), (5, 2), (9, 2), (13, 2), (7, 2), (15, 2)}
    for model in (before, after):
        loaded = [(label, b.dof) for b in model.steps[0].loads for label in model.mesh.labels[b.nodes].tolist()]
        assert loaded == [(4, 1), (8, 1), (12, 1), (6, 2)]


def test_sets_of_the_nodes_of_elements_follow_their_elements(tmp_path):
    path = deck(tmp_path, strip(), ["*NSET, NSET=ABOVE, ELSET=HIGH"])
    path.write_text(path.read_text().replace("*END STEP", "*CLOAD\nABOVE, 2, 1.\n*END STEP"))
    after = read_deck(insert_between(path))
    assert labels(after, after.nsets["ABOVE"]) == [9, 10, 11, 12, 13, 14, 15, 16]
    assert labels(after, after.steps[0].loads[0].nodes) == [9, 10, 11, 12, 13, 14, 15, 16]
    # where these elements are separated, too, the load is still that of eight nodes
    inserted(path, path.with_name("all.inp"), inside=["BODY"])
    after = read_deck(path.with_name("all.inp"))
    assert len(after.nsets["ABOVE"]) == 12
    assert len(after.steps[0].loads[0].nodes) == 8


def test_surfaces_of_nodes_get_the_doubles(tmp_path):
    model = ["*SURFACE, NAME=S, TYPE=NODE", "LEFT", "7", "*NODE", "100, 9., 9."]
    model += ["*COUPLING, CONSTRAINT NAME=C, REF NODE=100, SURFACE=S", "*KINEMATIC", "1, 1"]
    after = read_deck(insert_between(deck(tmp_path, strip(), model)))
    assert labels(after, [equation.terms[0][0] for equation in after.equations]) == [1, 5, 7, 9, 101, 103]


def test_equations_join_the_doubles_on_the_same_side(tmp_path):
    """Left and right end move alike, as in a periodic cell: above the interface as below it."""
    model = ["*NODE", "100, 9., 9.", "*EQUATION"]
    model += [line for left in (1, 5, 9) for line in ("3", f"{left}, 1, 1., {left + 3}, 1, -1.", "100, 1, 1.")]
    model += ["*MPC", "PIN, 6, 7"]
    after = read_deck(insert_between(deck(tmp_path, strip(), model)))
    pairs = sorted(tuple(after.mesh.labels[[node for node, _, _ in e.terms]].tolist()) for e in after.equations)
    assert len(pairs) == 4 + 2 * 2
    assert (1, 4, 100) in pairs and (9, 12, 100) in pairs
    assert (5, 8, 100) in pairs and (101, 104, 100) in pairs
    assert {pair for pair in pairs if len(pair) == 2} == {(6, 7), (102, 103)}


def test_equations_between_sets_are_written_out(tmp_path):
    model = ["*EQUATION", "2", "LEFT, 1, 1., RIGHT, 1, -1."]
    after = read_deck(insert_between(deck(tmp_path, strip(), model)))
    pairs = sorted(tuple(after.mesh.labels[[node for node, _, _ in e.terms]].tolist()) for e in after.equations)
    assert pairs == [(1, 4), (5, 8), (9, 12), (13, 16)]


def test_initial_conditions_hold_for_the_doubles(tmp_path):
    model = ["*INITIAL CONDITIONS, TYPE=TEMPERATURE", "6, 20.", "LEFT, 10."]
    after = read_deck(insert_between(deck(tmp_path, strip(), model)))
    found = {label: value.value for value in after.initial_temperatures for label in labels(after, value.nodes)}
    assert found == {6: 20.0, 14: 20.0, 1: 10.0, 5: 10.0, 9: 10.0, 13: 10.0}


def test_included_files_come_into_the_deck(tmp_path):
    mesh = strip()
    lines = mesh.lines()
    cut = next(k for k, line in enumerate(lines) if line.startswith("*ELEMENT"))
    (tmp_path / "nodes.inp").write_text("\n".join(lines[1:cut]) + "\n")
    (tmp_path / "rest.inp").write_text("\n".join(lines[cut:]) + "\n")
    path = tmp_path / "deck.inp"
    path.write_text(
        "\n".join(["*NODE, INPUT=nodes.inp, NSET=ALL", "*INCLUDE, INPUT=rest.inp", *END, *STEP, "*END STEP"])
    )
    output = tmp_path / "elsewhere" / "out.inp"
    output.parent.mkdir()
    inserted(path, output, between=[("LOW", "HIGH")])
    assert "** *INCLUDE, INPUT=rest.inp" in output.read_text()
    after = read_deck(output)
    assert labels(after, after.nsets["ALL"]) == list(range(1, 17))
    assert len(after.elsets["INTERFACE"]) == 3


def test_generated_elements_are_written_out_where_they_change(tmp_path):
    lines = ["*NODE, NSET=LOWEST", "1, 0., 0.", "4, 3., 0.", "*NGEN, NSET=LOWEST", "1, 4", "*NODE", "9, 0., 2."]
    lines += ["12, 3., 2.", "*NGEN, NSET=TOP", "9, 12", "*NFILL", "LOWEST, TOP, 2, 4", "*ELEMENT, TYPE=CPS4"]
    lines += ["1, 1, 2, 6, 5", "*ELGEN, ELSET=BODY", "1, 3, 1, 1, 2, 4, 3", "*ELSET, ELSET=LOW, GENERATE", "1, 3"]
    lines += ["*ELSET, ELSET=HIGH, GENERATE", "4, 6", *END, *STEP, "*END STEP"]
    path = tmp_path / "deck.inp"
    path.write_text("\n".join(lines) + "\n")
    before, after = read_deck(path), read_deck(insert_between(path))
    assert len(after.elsets["BODY"]) == len(before.elsets["BODY"]) == 6
    high = next(group for group in after.groups if group.type == "CPS4").nodes[3:]
    assert set(labels(after, np.unique(high))) == {*range(9, 13), *range(13, 17)}
    # the nodes come after those that are generated, and *NFILL finds its sets as they were
    assert len(after.mesh.labels) == 16


def parts(folder, model=(), step=(), second="0., 5."):
    lines = ["*PART, NAME=P", *strip().lines(), "*SOLID SECTION, ELSET=BODY, MATERIAL=M", "1.", "*END PART"]
    lines += ["*ASSEMBLY, NAME=A", "*INSTANCE, NAME=ONE, PART=P", "*END INSTANCE"]
    lines += ["*INSTANCE, NAME=TWO, PART=P", second, "*END INSTANCE"] if second else []
    lines += ["*NSET, NSET=END, INSTANCE=ONE", "LEFT", "*NSET, NSET=END, INSTANCE=TWO", "6", *model, "*END ASSEMBLY"]
    path = folder / "deck.inp"
    path.write_text("\n".join([*lines, *END[2:], *STEP, *step, "*END STEP"]) + "\n")
    return path


def test_a_part_is_cut_in_all_its_instances(tmp_path):
    step = ["*BOUNDARY", "END, 1, 1", "TWO.RIGHT, 2, 2", "TWO.7, 1", "*CLOAD", "ONE.RIGHT, 1, 3.", "END, 2, 1."]
    path = parts(tmp_path, step=step)
    before, after = read_deck(path), read_deck(insert_between(path))
    names = lambda model, nodes: sorted(model.mesh.name(node) for node in nodes)  # noqa: E731
    assert names(after, after.nsets["END"]) == ["ONE.1", "ONE.13", "ONE.5", "ONE.9", "TWO.14", "TWO.6"]
    assert names(after, after.nsets["TWO.RIGHT"]) == ["TWO.12", "TWO.16", "TWO.4", "TWO.8"]
    held = {(name, b.dof) for b in after.steps[0].boundaries for name in names(after, b.nodes)}
    assert {("TWO.7", 1), ("TWO.15", 1), ("TWO.16", 2), ("ONE.13", 1), ("TWO.14", 1)} <= held
    for model in (before, after):
        loaded = sorted((name, b.dof) for b in model.steps[0].loads for name in names(model, b.nodes))
        assert loaded == [
            ("ONE.1", 2), ("ONE.12", 1), ("ONE.4", 1), ("ONE.5", 2), ("ONE.8", 1), ("ONE.9", 2), ("TWO.6", 2)
        ]  # fmt: skip
    assert len(after.elsets["ONE.INTERFACE"]) == len(after.elsets["TWO.INTERFACE"]) == 3


def test_sets_are_found_by_part_instance_or_alone(tmp_path):
    path = parts(tmp_path)
    outputs = [
        inserted(path, tmp_path / "out.inp", between=[(f"{owner}LOW", f"{owner}HIGH")]) for owner in ("", "P.", "TWO.")
    ]
    assert {done.elements for done in outputs} == {3}


def test_plies_are_those_of_the_sections_or_those_named(tmp_path):
    mesh = strip(counts=(3, 4))
    mesh.sets = {f"P{k}": mesh.cell[:, 1] == k for k in range(4)}
    path = deck(tmp_path, mesh)
    text = path.read_text().replace(
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n1.\n",
        "".join(f"*SOLID SECTION, ELSET=P{k}, MATERIAL=M\n1.\n" for k in range(4)),
    )
    path.write_text(text)
    every = inserted(path, tmp_path / "all.inp", plies=())
    assert (every.elements, every.doubled) == (9, 12)
    assert [(lower.partition(" ")[0], upper.partition(" ")[0], n) for lower, upper, n in every.plies] == [
        ("P0", "P1", 3), ("P1", "P2", 3), ("P2", "P3", 3)
    ]  # fmt: skip
    assert every.warnings == ()
    some = inserted(path, tmp_path / "some.inp", plies=("P3", "P2", "P1"))
    assert (some.elements, some.doubled) == (6, 8)
    assert some.lines("I")[0] == "--plies: cut between P3 and P2: 3 faces"
    after = read_deck(tmp_path / "some.inp")
    group = next(group for group in after.groups if group.type == "U4")
    x = after.mesh.coordinates[group.nodes]
    # the first ply is below, so the normal points from P3 to P2
    assert np.all(x[:, :4, 1].mean(axis=1) > x[:, 4:, 1].mean(axis=1))


@pytest.mark.parametrize(("kind", "counts", "faces"), [("CPS4", (4, 2), 4), ("C3D8", (4, 1, 2), 4)])
def test_plies_that_are_cut_across_are_said(tmp_path, kind, counts, faces):
    """Two plies, whose sections change half-way: their cuts meet there, and the sets of whole plies avoid that."""
    mesh = strip(kind, counts)
    left = mesh.cell[:, 0] < 2
    low = mesh.cell[:, -1] == 0
    mesh.sets |= {"LL": low & left, "LR": low & ~left, "HL": ~low & left, "HR": ~low & ~left}
    path = deck(tmp_path, mesh)
    sections = "".join(f"*SOLID SECTION, ELSET={name}, MATERIAL=M\n1.\n" for name in ("LL", "LR", "HL", "HR"))
    path.write_text(path.read_text().replace("*SOLID SECTION, ELSET=BODY, MATERIAL=M\n1.\n", sections))
    done = inserted(path, tmp_path / "out.inp", plies=())
    (warning,) = done.warnings
    expected = rf"--plies: cuts between sections meet at {faces} faces, the first between elements \d+ and \d+"
    assert re.match(expected, warning)
    lines = done.lines("INTERFACE")
    assert re.match(r"--plies: cut between LL \(.*deck.inp:\d+\) and LR \(.*deck.inp:\d+\): 1 face$", lines[1])
    assert [n for _, _, n in done.plies] == [1, 2, 2, 1]
    whole = inserted(path, tmp_path / "out.inp", plies=("LOW", "HIGH"))
    assert whole.warnings == () and whole.plies == (("LOW", "HIGH", 4),)


def test_all_elements_of_a_set(tmp_path):
    done = inserted(deck(tmp_path, strip()), tmp_path / "out.inp", inside=["BODY"])
    assert done.elements == 7
    # six quads of four nodes share nothing any more
    assert done.doubled == 6 * 4 - 12


def test_along_a_node_set_with_an_initial_crack(tmp_path):
    mesh = strip(counts=(4, 2))
    middle = np.isclose(mesh.nodes[:, 1], 1.0)
    mesh.node_sets |= {"MID": middle, "CRACK": middle & (mesh.nodes[:, 0] < 2.5)}
    done = inserted(deck(tmp_path, mesh), tmp_path / "out.inp", nodes=["MID"], crack=["CRACK"])
    assert (done.elements, done.crack, done.doubled) == (2, 2, 5)


def test_a_crack_alone_needs_no_properties(tmp_path):
    path = deck(tmp_path, strip("C3D10", (1, 1, 2)))
    done = inserted(path, tmp_path / "out.inp", (), between=[("LOW", "HIGH")], crack=["LOW"])
    assert (done.kinds, done.elements, done.crack, done.doubled) == ({}, 0, 2, 9)
    assert done.lines("INTERFACE") == ["no elements, 2 faces of an initial crack, 9 nodes doubled"]
    read_deck(tmp_path / "out.inp")


def test_along_a_surface_whose_elements_are_below(tmp_path):
    mesh = strip()
    path = deck(tmp_path, mesh, ["*SURFACE, NAME=FACE", "HIGH, S1"])
    inserted(path, tmp_path / "out.inp", surfaces=["FACE"])
    after = read_deck(tmp_path / "out.inp")
    group = next(group for group in after.groups if group.type == "U4")
    x = after.mesh.coordinates[group.nodes]
    assert np.all(x[:, :4, 1].mean(axis=1) > x[:, 4:, 1].mean(axis=1))


def test_a_cross_is_the_same_in_one_go_and_in_two(tmp_path):
    """The interface elements of the first go follow their solids in the second one."""
    mesh = strip(counts=(4, 2))
    mesh.sets |= {"WEST": mesh.cell[:, 0] < 2, "EAST": mesh.cell[:, 0] >= 2}
    path = deck(tmp_path, mesh)
    for element in ("U4", "U2"):
        values = [*LAW, *(["ALPHAN=1e6"] if element == "U2" else [])]
        both = [("LOW", "HIGH"), ("WEST", "EAST")]
        once = inserted(path, tmp_path / "once.inp", values, between=both, element=element)
        first = inserted(path, tmp_path / "one.inp", values, between=both[:1], element=element)
        second = inserted(
            tmp_path / "one.inp", tmp_path / "two.inp", values, between=both[1:], element=element, elset="CROSS"
        )
        assert once.doubled == first.doubled + second.doubled == 5 + (1 + 2 + 1)
        meshes = []
        for name in ("once", "two"):
            model = read_deck(tmp_path / f"{name}.inp")
            # elements by the places of their nodes, and how many solids have each node
            solid = next(group for group in model.groups if group.type == "CPS4").nodes
            share = np.bincount(solid.ravel(), minlength=len(model.mesh.labels))
            rows = [row for group in model.groups if group.type == element for row in group.nodes]
            meshes.append(sorted((model.mesh.coordinates[row].tolist(), share[row].tolist()) for row in rows))
        assert meshes[0] == meshes[1]
        assert len(meshes[0]) == 6


def test_elastic_constants_come_from_the_sections(tmp_path):
    mesh = strip("C3D8", (2, 2, 2))
    path = tmp_path / "deck.inp"
    lines = [*mesh.lines(), "*SOLID SECTION, ELSET=LOW, MATERIAL=PLY, ORIENTATION=TURNED"]
    lines += [
        "*SOLID SECTION, ELSET=HIGH, MATERIAL=STEEL",
        "*ORIENTATION, NAME=TURNED",
        "1., 0., 0., 0., 1., 0.",
        "3, 30.",
    ]
    lines += ["*MATERIAL, NAME=PLY", "*ELASTIC, TYPE=ENGINEERING CONSTANTS", "9., 8., 7., 0.1, 0.2, 0.3, 4., 5.", "6."]
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "26., 0.3", *STEP, "*END STEP"]
    path.write_text("\n".join(lines) + "\n")
    after = read_deck(insert_between(path, "E1_TOP=27"))
    section = next(group for group in after.groups if group.type == "U8").section
    bottom = [9, 8, 7, 0.1, 0.2, 0.3, 4, 5, 6, 30]
    top = [27, 26, 26, 0.3, 0.3, 0.3, 10, 10, 10, 0]
    assert section.values.tolist()[16:36] == pytest.approx([*bottom, *top])
    assert not section.values[36:].any()


def test_constants_are_renamed_where_another_axis_is_normal_to_the_interface(tmp_path):
    """A laminate stacked along y, with its fibres along x: the axes 1, 2, 3 of the ply are 1, 3, 2 of the material."""
    mesh = grid("C3D8", (2, 2, 2), (2.0, 2.0, 2.0))
    mesh.sets = {"LOW": mesh.cell[:, 1] == 0, "HIGH": mesh.cell[:, 1] == 1}
    path = tmp_path / "deck.inp"
    lines = [*mesh.lines(), "*SOLID SECTION, ELSET=BODY, MATERIAL=PLY", "*MATERIAL, NAME=PLY"]
    lines += ["*ELASTIC, TYPE=ENGINEERING CONSTANTS", "9., 8., 7., 0.1, 0.2, 0.3, 4., 5.", "6.", *STEP, "*END STEP"]
    path.write_text("\n".join(lines) + "\n")
    after = read_deck(insert_between(path))
    section = next(group for group in after.groups if group.type == "U8").section
    # nu_32 = nu_23 E_3/E_2
    ply = [9, 7, 8, 0.2, 0.1, 0.3 * 7 / 8, 5, 4, 6, 0]
    assert section.values.tolist()[16:36] == pytest.approx([*ply, *ply])
    assert not section.values[36:].any()


def test_thickness_and_state_of_stress_come_from_the_solids(tmp_path):
    path = deck(tmp_path, strip("CPE4"))
    path.write_text(path.read_text().replace("MATERIAL=M\n1.", "MATERIAL=M\n2.5"))
    section = next(g for g in read_deck(insert_between(path)).groups if g.type == "U4").section
    assert section.values[0] == 2.5
    # LAW, CLOSURE, PLANE, INTEGRATION, SAMPLING, TANGENT, FORMULATION BOTTOM and TOP: those of CPE4; CRACKED, PACING,
    # FATIGUE
    assert section.integers.tolist() == [1, 0, 1, 0, 0, 0, 2, 2, 0, 0, 0]
    # BETAN, BETAT: zeros are the recommendation
    assert section.values[12:14].tolist() == [0.0, 0.0]


def test_each_pair_of_sections_has_its_set(tmp_path):
    mesh = strip(counts=(3, 3))
    mesh.sets = {f"P{k}": mesh.cell[:, 1] == k for k in range(3)}
    path = deck(tmp_path, mesh)
    sections = "".join(f"*SOLID SECTION, ELSET=P{k}, MATERIAL={m}\n1.\n" for k, m in enumerate("MMN"))
    text = path.read_text().replace("*SOLID SECTION, ELSET=BODY, MATERIAL=M\n1.\n", sections)
    path.write_text(text.replace("*STEP", "*MATERIAL, NAME=N\n*ELASTIC\n2e4, 0.3\n*STEP", 1))
    inserted(path, tmp_path / "out.inp", plies=())
    after = read_deck(tmp_path / "out.inp")
    assert {name: len(after.elsets[name]) for name in after.elsets if name.startswith("INTER")} == {
        "INTERFACE-1": 3, "INTERFACE-2": 3, "INTERFACE": 6
    }  # fmt: skip


def test_a_material_that_nothing_uses_stays(tmp_path):
    path = deck(tmp_path, strip())
    spare = "*MATERIAL, NAME=SPARE\n*CONCRETE\n1., 2.\n"
    path.write_text(path.read_text().replace("*STEP", f"{spare}*STEP", 1))
    inserted(path, tmp_path / "out.inp", between=[("LOW", "HIGH")])
    assert spare in (tmp_path / "out.inp").read_text()


ERRORS = [
    ({"between": [("LOW", "HIHG")]}, {}, r"--between: the mesh has no element set HIHG .*did you mean HIGH\?"),
    ({"between": [("LOW", "BODY")]}, {}, "--between LOW BODY: element 1 is in both sets"),
    ({"between": [("LOW", "CORNER")]}, {}, "--between LOW CORNER: no two solids share a face there"),
    ({"nodes": ["LEFT"]}, {}, "--nodes LEFT: no two solids share a face there"),
    ({"nodes": ["LOW"]}, {}, "--nodes: the mesh has no node set LOW"),
    ({"surfaces": ["S"]}, {}, "--surface: the mesh has no surface S"),
    ({"surfaces": ["POINTS"]}, {}, r"--surface POINTS: expected a surface of elements .*deck.inp:\d+"),
    ({"surfaces": ["BOTH"]}, {}, r"deck.inp:\d+: \*SURFACE: a combined surface is not supported here"),
    ({"inside": ["CORNER"]}, {}, "--all CORNER: no two solids share a face there"),
    ({"plies": ("LOW", "BODY")}, {}, "--plies: element 1 is in LOW and in BODY"),
    ({"plies": ()}, {}, "--plies: the deck has no two sections of solids"),
    ({}, {}, "say where: --between"),
    ({"crack": ["LEFT"]}, {}, "--crack LEFT: none of the faces that are cut is there"),
    ({"crack": ["NOWHERE"]}, {}, "--crack: the mesh has no node set, element set or surface NOWHERE"),
    ({}, {"element": "U9"}, "--element U9: expected one of COH2D4, "),
    ({}, {"element": "U3"}, "--element U3: .*U3 knows its neighbours by their numbers"),
    (
        {},
        {"element": "U7"},
        r"deck.inp:\d+: element \d+ \(CPS4\): has a face of 2 nodes there; U7 fits between faces of 4",
    ),
    ({}, {"elset": "LOW"}, "--elset LOW: the deck has an element set of this name"),
    ({}, {"solids": ["CPE4"]}, "--solids is for meshes"),
    ({}, {"values": ["SIGMAMAX=1"]}, "U4 needs TAUMAX=VALUE, GIC=VALUE, GIIC=VALUE"),
    ({}, {"values": [*LAW, "STRENGTH=1"]}, "U4 has no property STRENGTH"),
    ({}, {"values": [*LAW, "GIC=1"]}, "GIC is given twice"),
    ({}, {"values": [*LAW[1:], "SIGMAMAX=stone"]}, "SIGMAMAX=stone: expected NAME=VALUE with a number"),
    ({}, {"values": [*LAW[1:], "SIGMAMAX=-1"]}, "SIGMAMAX=-1: expected a value above 0"),
    ({}, {"element": "U2"}, "U2 needs ALPHAN=VALUE: a stiffness, which only stabilised elements can do without"),
    ({}, {"values": [*LAW, "LAW=1", "ETA=2"]}, "ETA: LAW 1 ignores it; LAW 2, 3, 5 or 6 has it"),
    ({}, {"values": [*LAW, "SHAPEN=2"]}, "SHAPEN: LAW 1 ignores it; LAW 4 has it"),
]


@pytest.mark.parametrize(("wanted", "options", "message"), ERRORS)
def test_errors(tmp_path, wanted, options, message):
    mesh = strip()
    mesh.sets["CORNER"] = (mesh.cell == [2, 1]).all(axis=1)
    surfaces = ["*SURFACE, NAME=POINTS, TYPE=NODE", "LEFT", "*SURFACE, NAME=BOTH, COMBINE=UNION", "FACE"]
    path = deck(tmp_path, mesh, surfaces)
    if "crack" in wanted or options:
        wanted = {"between": [("LOW", "HIGH")], **wanted}
    if message.startswith("--between LOW CORNER"):
        path.write_text(path.read_text().replace("*ELSET, ELSET=LOW\n1\n2\n3", "*ELSET, ELSET=LOW\n1"))
    with pytest.raises((UsageError, DeckError), match=message):
        inserted(path, tmp_path / "out.inp", **wanted, **options)
    assert not (tmp_path / "out.inp").exists()


def test_what_has_no_interface_element_is_refused_with_its_number(tmp_path):
    path = deck(tmp_path, strip())
    path.write_text(path.read_text().replace("TYPE=CPS4", "TYPE=DC2D4"))
    with pytest.raises(
        DeckError, match=r"deck.inp:1: the mesh has no solids, between which elements could be inserted"
    ):
        insert_between(path)
    axisymmetric = deck(tmp_path, strip("CAX4"))
    with pytest.raises(DeckError, match=r"element 1 \(CAX4\): is axisymmetric, and no interface element here is"):
        insert_between(axisymmetric)


def test_an_element_that_owns_its_solids_needs_their_nodes_and_constants(tmp_path):
    with pytest.raises(DeckError, match=r"element \d+ \(CPS3\): U4 owns the solids .*, which need 4 and 4 nodes"):
        insert_between(deck(tmp_path, strip("CPS3")), element="U4")
    path = deck(tmp_path, strip())
    path.write_text(
        path.read_text().replace("*ELASTIC\n1e4, 0.3", "*ELASTIC, TYPE=ORTHOTROPIC\n" + "1., " * 8 + "\n1.")
    )
    with pytest.raises(UsageError, match=r"U4 owns .*material M has \*ELASTIC, TYPE=ORTHOTROPIC .*E1_BOTTOM=VALUE"):
        insert_between(path)
    path = deck(tmp_path, strip("C3D8", (2, 2, 2)))
    path.write_text(path.read_text().replace("*ELASTIC\n1e4, 0.3", "*HYPERELASTIC, NEO HOOKE\n1., 0."))
    given = [f"{name}_BOTTOM=1" for name in ("E1", "E2", "G12")]
    with pytest.raises(UsageError, match=r"U8 owns .*; give G13_BOTTOM=VALUE, G23_BOTTOM=VALUE and"):
        insert_between(path, *given)


def test_a_user_element_that_nobody_knows_is_refused_at_a_doubled_node(tmp_path):
    model = ["*USER ELEMENT, TYPE=U77, NODES=2, COORDINATES=2", "1, 2", "*ELEMENT, TYPE=U77", "70, 5, 6"]
    with pytest.raises(DeckError, match=r"deck.inp:\d+: element 70 \(U77\) has a node that is doubled"):
        insert_between(deck(tmp_path, strip(), model))


def test_an_element_of_the_assembly_at_a_doubled_node_of_an_instance_is_refused(tmp_path):
    model = ["*ELEMENT, TYPE=CPS3", "70, ONE.5, ONE.9, TWO.1"]
    with pytest.raises(DeckError, match=r"deck.inp:\d+: element 70 \(CPS3\) has a node that is doubled; nodes of inst"):
        insert_between(parts(tmp_path, model))


def test_sides_of_different_thickness_are_named(tmp_path):
    path = deck(tmp_path, strip())
    sections = "*SOLID SECTION, ELSET=LOW, MATERIAL=M\n1.\n*SOLID SECTION, ELSET=HIGH, MATERIAL=M\n2.\n"
    path.write_text(path.read_text().replace("*SOLID SECTION, ELSET=BODY, MATERIAL=M\n1.\n", sections))
    message = r"U4 needs THICKNESS=VALUE: the sections on its sides have 1 \(.*deck.inp:\d+\) and 2 \(.*deck.inp:\d+\)"
    with pytest.raises(UsageError, match=message):
        insert_between(path)
    mixed = strip()
    lines = mixed.lines()
    first = lines.index("*ELEMENT, TYPE=CPS4, ELSET=BODY")
    lines.insert(first + 4, "*ELEMENT, TYPE=CPE4, ELSET=BODY")
    path.write_text("\n".join([*lines, *END, *STEP, "*END STEP"]) + "\n")
    message = r"U4 needs PLANE=0 .*: its sides differ or do not say it \(.*deck.inp:\d+\) and \(.*deck.inp:\d+\)"
    with pytest.raises(UsageError, match=message):
        insert_between(path)


def test_a_face_of_three_solids_has_its_place(tmp_path):
    lines = ["*ELEMENT, TYPE=CPS4", "70, 1, 2, 6, 5"]
    message = r"deck.inp:\d+: element 70 \(CPS4\): elements 1, 70, 2 share a face, which can belong to two"
    with pytest.raises(DeckError, match=message):
        insert_between(deck(tmp_path, strip(), lines))


def test_a_set_of_several_parts_names_the_option(tmp_path):
    path = parts(tmp_path, second="")
    text = path.read_text()
    part = text[: text.index("*ASSEMBLY")]
    other = part.replace("NAME=P", "NAME=Q")
    instance = "*INSTANCE, NAME=ONE, PART=P\n*END INSTANCE\n"
    text = other + text.replace(instance, f"{instance}*INSTANCE, NAME=THREE, PART=Q\n*END INSTANCE\n")
    path.write_text(text.replace("*NSET, NSET=END, INSTANCE=TWO\n6\n", ""))
    with pytest.raises(UsageError, match=r"--between: LOW is in several parts: write one of ONE.LOW, THREE.LOW"):
        insert_between(path)


GROUPS = ["*ELEMENT, TYPE=CPS4, ELSET=CUT", "70, {cut}", "*ELEMENT, TYPE=CPS4, ELSET=OUTER", "71, {outer}"]


def gmsh(folder, *lines, cut="70, {cut}"):
    """Two bricks as Gmsh writes them, with groups of faces as plane elements and of edges as trusses."""
    mesh = strip("C3D8", (1, 1, 2))
    model = read_deck(deck(folder, mesh))
    faces = {}
    for group in model.groups:
        for number, nodes in zip(group.labels, group.nodes, strict=True):
            faces[int(number)] = model.mesh.labels[nodes].tolist()
    # the top of the lower one, and the side of the upper one that has two of its nodes
    upper = faces[2]
    words = {"cut": ", ".join(map(str, faces[1][4:])), "outer": f"{upper[0]}, {upper[1]}, {upper[5]}, {upper[4]}"}
    edges = ["*ELEMENT, TYPE=T3D2, ELSET=EDGE", f"72, {upper[0]}, {upper[1]}"]
    return deck(folder, mesh, [line.format(**words) for line in (*GROUPS, *lines)] + edges), upper


def test_groups_of_faces_and_edges_of_a_mesh(tmp_path):
    """On the cut both sides have the face: it stays. Elsewhere a face goes with its solid."""
    path, upper = gmsh(tmp_path)
    output = tmp_path / "out.inp"
    done = inserted(path, output, between=[("LOW", "HIGH")])
    assert done.kinds == {"U8": 1}
    (warning,) = done.warnings
    assert re.match(
        r".*deck.inp:\d+: 1 elements CPS4 without a section, such as element 70, are on faces that", warning
    )
    blocks = re.findall(r"^\*ELEMENT, .*\n((?:[^*].*\n)*)", output.read_text(), re.MULTILINE)
    lines = [list(map(int, line.split(","))) for line in "".join(blocks).splitlines()]
    rows = {number: nodes for number, *nodes in lines}
    new = rows[2]
    assert new[:4] != upper[:4] and new[4:] == upper[4:]
    assert rows[71] == [new[0], new[1], new[5], new[4]]
    assert set(rows[70]) == set(upper[:4])
    assert rows[72] == upper[:2]


def test_a_shell_on_a_face_that_is_cut_is_refused(tmp_path):
    path, _ = gmsh(
        tmp_path, "*ELEMENT, TYPE=S4, ELSET=SHELL", "80, {cut}", "*SHELL SECTION, ELSET=SHELL, MATERIAL=M", "0.1"
    )
    message = (
        r"deck.inp:\d+: element 80 \(S4\) has a node that is doubled; .*: it lies on no face, or on one that is cut"
    )
    with pytest.raises(DeckError, match=message):
        insert_between(path)


def test_springs_stay_on_the_old_node(tmp_path):
    model = ["*ELEMENT, TYPE=SPRING1, ELSET=SPRINGS", "70, 5", "*SPRING, ELSET=SPRINGS", "1", "3."]
    after = read_deck(insert_between(deck(tmp_path, strip(), model)))
    assert labels(after, next(g for g in after.groups if g.type == "SPRING1").nodes.ravel()) == [5]


def test_a_tie_to_a_surface_that_is_cut_is_told(tmp_path):
    model = ["*SURFACE, NAME=MAIN", "BODY, S4", "*NODE", "100, 3., 1.", "*SURFACE, NAME=SECOND, TYPE=NODE", "100"]
    model += ["*TIE, NAME=T", "SECOND, MAIN"]
    path = deck(tmp_path, strip(), model)
    done = inserted(path, tmp_path / "out.inp", between=[("LOW", "HIGH")])
    assert any("*TIE: nodes of MAIN are doubled" in line for line in done.lines("INTERFACE"))


def test_faces_that_cannot_open_get_no_element(tmp_path):
    mesh = strip(counts=(3, 3))
    inner = np.all((mesh.nodes > 0.5) & (mesh.nodes < 2.5), axis=1)
    mesh.node_sets["INNER"] = inner & (mesh.nodes[:, 1] < 1.5)
    with pytest.raises(UsageError, match="no face gets an element: nothing there can open"):
        inserted(deck(tmp_path, mesh), tmp_path / "out.inp", nodes=["INNER"])


def test_triangles_of_solids_get_the_element_of_abaqus_when_asked(tmp_path):
    path = deck(tmp_path, strip("C3D4", (1, 1, 2)))
    done = inserted(path, tmp_path / "out.inp", [*LAW, "ALPHAN=1e6"], between=[("LOW", "HIGH")], element="COH3D6")
    assert done.elements == 2
    assert done.warnings == ()
    lines = (tmp_path / "out.inp").read_text().splitlines()
    assert (
        "*COHESIVE SECTION, CONTROLS=INTERFACE, ELSET=INTERFACE, MATERIAL=INTERFACE, RESPONSE=TRACTION SEPARATION"
        in lines
    )
    first = lines.index("*ELEMENT, TYPE=COH3D6, ELSET=INTERFACE")
    assert all(len(line.split(",")) == 7 for line in lines[first + 1 : first + 3])
