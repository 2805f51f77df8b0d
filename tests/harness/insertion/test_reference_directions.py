# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""DIRECTION1 to 3 of inserted elements: one set of properties for a curved laminate, and the tractions of its plies."""

import itertools
import re

import numpy as np
import pytest
from solid_grids import LAW, grid, inserted

import uel
from uel.deck.reader import read_deck
from uel.elements.interfaces.neighbour_data import compare
from uel.errors import DeckError, UsageError
from uel.usersub.layout import element_layouts

CARBON = (138e3, 10.5e3, 10.5e3, 0.3, 0.3, 0.45, 6.3e3, 6.3e3, 3.5e3)
"""E1, E2, E3, nu12, nu13, nu23, G12, G13, G23."""
ALONG_2 = (10.5e3, 138e3, 10.5e3, 0.3 * 10.5 / 138, 0.45, 0.3, 6.3e3, 3.5e3, 6.3e3)
"""The same with the fibres along 2."""
STRONG = ("SIGMAMAX=1e6", "TAUMAX=1e6", "GIC=1e9", "GIIC=1e9")
LEG, RADIUS, HEIGHT = 6.0, 5.0, 1.0
PLIES = {
    0: {
        "LEG1": ("RECTANGULAR", "1., 0., 0., 0., 1., 0."),
        "ARC": ("CYLINDRICAL", "0., 0., 0., 0., 0., 1.", "3, 90."),
        "LEG2": ("RECTANGULAR", "0., 1., 0., 1., 0., 0."),
    },
    90: {
        "LEG1": ("RECTANGULAR", "0., 0., 1., 1., 0., 0."),
        "ARC": ("CYLINDRICAL", "0., 0., 0., 0., 0., 1.", "2, 90."),
        "LEG2": ("RECTANGULAR", "0., 0., 1., 0., 1., 0."),
    },
    30: {
        "LEG1": ("RECTANGULAR", "0., -1., 0., 1., 0., 0.", "1, 30."),
        "ARC": ("CYLINDRICAL", "0., 0., 0., 0., 0., 1.", "1, 30."),
        "LEG2": ("RECTANGULAR", "1., 0., 0., 0., 1., 0.", "1, 30."),
    },
}
"""System, points and rotation of *ORIENTATION in each part of an angle bracket, by the angle of its fibres from around
the corner towards the axis: along 1, at 30 degrees along 2."""


def material(constants=CARBON, name="PLY"):
    words = list(map(repr, constants))
    return [f"*MATERIAL, NAME={name}", "*ELASTIC, TYPE=ENGINEERING CONSTANTS", ", ".join(words[:8]), words[8]]


def bracket(kind, layup, turn=None):
    """Lines of an angle bracket: legs along x and y, and between them a quarter of a cylinder about z.

    Plies are counted from outside; `turn` is a rotation of the whole about the origin.
    """
    turn = np.eye(3) if turn is None else turn
    mesh = grid(kind, (11, len(layup), 2), (11.0, float(len(layup)), 2.0))
    along, radius = mesh.nodes[:, 0], RADIUS + HEIGHT * (len(layup) - mesh.nodes[:, 1])
    angle = np.clip((along - 3.0) / 5.0, 0.0, 1.0) * np.pi / 2
    before, after = np.minimum(along - 3.0, 0.0) / 3.0 * LEG, np.maximum(along - 8.0, 0.0) / 3.0 * LEG
    x, y = radius * np.sin(angle) + before, after - radius * np.cos(angle)
    mesh.nodes = np.column_stack([x, y, mesh.nodes[:, 2]]) @ turn.T
    parts = {"LEG1": mesh.cell[:, 0] < 3, "LEG2": mesh.cell[:, 0] >= 8}
    parts["ARC"] = ~(parts["LEG1"] | parts["LEG2"])
    mesh.sets = {f"PLY{k}": mesh.cell[:, 1] == k for k in range(len(layup))}
    lines = []
    for (k, fibre), (name, part) in itertools.product(enumerate(layup), parts.items()):
        mesh.sets[f"P{k}_{name}"] = part & (mesh.cell[:, 1] == k)
        system, points, *rotation = PLIES[fibre][name]
        turned = np.array(list(map(float, points.split(",")))).reshape(2, 3) @ turn.T
        lines += [f"*ORIENTATION, NAME=O{k}_{name}, SYSTEM={system}", ", ".join(f"{v:.15g}" for v in turned.ravel())]
        lines += [*rotation, f"*SOLID SECTION, ELSET=P{k}_{name}, MATERIAL=PLY, ORIENTATION=O{k}_{name}"]
    return mesh, lines


def written(folder, mesh, lines, step=(), constants=CARBON):
    path = folder / "deck.inp"
    text = [*mesh.lines(), *lines, *material(constants), "*STEP", "*STATIC", "1., 1.", *step, "*END STEP"]
    path.write_text("\n".join(text) + "\n")
    return path


def groups_of(path, values=LAW, **wanted):
    """Properties by name of each group of inserted elements, in the order of the deck; they agree with the solids."""
    output = path.with_name("cut.inp")
    inserted(path, output, values, **wanted)
    model = read_deck(output)
    assert compare(model, model.groups) == []
    found = []
    for group in model.groups:
        if group.type.startswith("U"):
            reals = element_layouts()[int(group.type[1:])].reals
            found.append({item.name: float(group.section.values[item.position - 1]) for item in reals})
    return found


def direction(values):
    return [values[f"DIRECTION{k}"] for k in (1, 2, 3)]


def stress(constants, axes, strain):
    """(3, 3) stress in global components by a strain (3, 3); axes of the material in rows."""
    e1, e2, e3, nu12, nu13, nu23, g12, g13, g23 = constants
    compliance = np.diag([1 / e1, 1 / e2, 1 / e3, 1 / g12, 1 / g13, 1 / g23])
    for i, j, value in ((0, 1, nu12 / e1), (0, 2, nu13 / e1), (1, 2, nu23 / e2)):
        compliance[i, j] = compliance[j, i] = -value
    local = axes @ strain @ axes.T
    pairs = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    values = np.linalg.solve(compliance, [local[i, j] * (1 if i == j else 2) for i, j in pairs])
    found = np.zeros((3, 3))
    for (i, j), value in zip(pairs, values, strict=True):
        found[i, j] = found[j, i] = value
    return axes.T @ found @ axes


def test_a_bracket_needs_a_set_of_properties_for_each_pair_of_plies(tmp_path):
    """Not for each face: legs and corner alike, with angles from the axis of the corner; [0/90/90/0]."""
    mesh, lines = bracket("C3D8", (0, 90, 90, 0))
    found = groups_of(written(tmp_path, mesh, lines), plies=("PLY0", "PLY1", "PLY2", "PLY3"))
    assert [direction(each) for each in found] == [[0.0, 0.0, 1.0]] * 3
    # fibres around the corner are across the axis
    angles = {(each["ANGLE BOTTOM"], each["ANGLE TOP"]) for each in found}
    assert angles == {(90.0, 0.0), (0.0, 0.0), (0.0, 90.0)}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"ANGLE TOP": 20.0}, r"E1 TOP = 138000 at ANGLE TOP = 20, but the C3D8 element \d+ above"),
        # the second leg is normal to x
        (
            {"DIRECTION1": 1.0, "DIRECTION3": 0.0},
            r"DIRECTION1 to DIRECTION3 = 1, 0, 0, \d\S* degrees from its normal",
        ),
        ({"DIRECTION1": 1.0}, r"E1 BOTTOM = 138000 at ANGLE BOTTOM = 90, but the C3D8 element \d+ below"),
    ],
)
def test_other_directions_are_found_before_a_run(tmp_path, changes, message):
    """By the comparison of `uel run` with the directions of the solids, in the corner and on the legs."""
    mesh, lines = bracket("C3D8", (0, 90))
    inserted(written(tmp_path, mesh, lines), tmp_path / "cut.inp", between=[("PLY0", "PLY1")])
    model = read_deck(tmp_path / "cut.inp")
    assert compare(model, model.groups) == []
    positions = {item.name: item.position - 1 for item in element_layouts()[8].reals}
    for group in model.groups:
        if group.type == "U8":
            for name, value in changes.items():
                group.section.values[positions[name]] = value
    findings = compare(model, model.groups)
    assert any(each.wrong and re.search(message, each.message) for each in findings)


TURN = np.array([[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]]) / 3.0


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("fibre", [0, 90, 30])
@pytest.mark.parametrize(("kind", "element"), [("C3D8I", "U8"), ("C3D20", "U12")])
def test_tractions_are_those_of_the_curved_plies(tmp_path, kind, element, fibre, turned):
    """In a homogeneous strain, in each component: normal, along the axis (s), and around the corner (t).

    The normal is within a degree of x on one leg; shears do not jump there.
    """
    turn = TURN if turned else np.eye(3)
    mesh, lines = bracket(kind, (fibre, fibre), turn)
    gradient = 1e-3 * np.array([[1.0, 0.4, -0.2], [0.3, -0.5, 0.1], [0.2, 0.1, 0.6]])
    loads = [
        f"{k}, {d + 1}, {d + 1}, {float(v)!r}" for k, x in enumerate(mesh.nodes, 1) for d, v in enumerate(gradient @ x)
    ]
    step = ["*BOUNDARY", *loads, "*OUTPUT, FIELD", "*NODE OUTPUT", "U"]
    path = written(tmp_path, mesh, lines, step, ALONG_2 if fibre == 30 else CARBON)
    (values,) = groups_of(path, STRONG, between=[("PLY0", "PLY1")])
    axis = turn[:, 2]
    np.testing.assert_allclose(direction(values), axis, atol=1e-11)
    profile = uel.run(tmp_path / "cut.inp", output_dir=tmp_path, quiet=True).interface()
    assert [profile[f"DIRECTION{k}"][0] for k in (1, 2, 3)] == direction(values)
    model = read_deck(tmp_path / "cut.inp")
    (group,) = (group for group in model.groups if group.type == element)
    bottom = group.nodes[:, list(element_layouts()[int(element[1:])].faces[0])[:4]]
    corners = dict(zip(group.labels.tolist(), model.mesh.coordinates[bottom], strict=True))
    strain = 0.5 * (gradient + gradient.T)
    for row, label in enumerate(profile["element"].astype(int).tolist()):
        # curved faces have other normals beside their middle
        if element == "U12" and profile["point"][row] != 9:
            continue
        face = corners[label]
        normal = np.cross(face[2] - face[0], face[3] - face[1])
        normal /= np.linalg.norm(normal)
        around = np.cross(normal, axis)
        # the normal is inwards, and the bracket runs from leg 1 to leg 2
        c, s = np.cos(np.radians(fibre)), np.sin(np.radians(fibre))
        first = c * np.cross(normal, axis) + s * axis
        axes = np.array([first, np.cross(normal, first), normal])
        traction = stress(CARBON, axes, strain) @ normal
        for name, way in (("TN", normal), ("TS", axis), ("TT", around)):
            # angles have four decimals
            assert profile[name][row] == pytest.approx(traction @ way, rel=1e-5, abs=1e-5 * np.linalg.norm(traction))


def block(counts=(2, 2, 2), axis=0):
    mesh = grid("C3D8", counts, tuple(map(float, counts)))
    mesh.sets = {"LOW": mesh.cell[:, axis] == 0, "HIGH": mesh.cell[:, axis] == 1}
    return mesh


FLAT = [
    "*ORIENTATION, NAME=O",
    "0., 1., 0., 0., 0., 1.",
    "3, 20.",
    "*SOLID SECTION, ELSET=BODY, MATERIAL=PLY, ORIENTATION=O",
]


def test_x_along_the_normal_of_a_flat_laminate(tmp_path):
    """Then s is z, as in Abaqus, and t is -y: fibres at 20 degrees from y to z are at -70 degrees."""
    (found,) = groups_of(written(tmp_path, block(), FLAT), between=[("LOW", "HIGH")])
    assert direction(found) == [0.0, 0.0, 0.0]
    assert found["ANGLE BOTTOM"] == -70.0


def test_an_uneven_laminate_across_x(tmp_path):
    """On facets that lean by some tenths of a degree the projection of x has any direction, that of the fibres one."""
    mesh = block((2, 4, 4))
    middle = mesh.nodes[:, 0] == 1.0
    rng = np.random.default_rng(2)
    mesh.nodes[middle, 0] += np.radians(0.15) * rng.uniform(-1.0, 1.0, middle.sum())
    found = groups_of(written(tmp_path, mesh, FLAT), between=[("LOW", "HIGH")])
    assert len(found) <= 3  # roundings of the angle to four decimals
    c, s = np.cos(np.radians(20.0)), np.sin(np.radians(20.0))
    for each in found:
        assert direction(each) == pytest.approx([0.0, c, s], abs=1e-11)
        assert each["ANGLE BOTTOM"] == pytest.approx(0.0, abs=2e-3)


def test_a_laminate_across_the_axis_of_its_orientation(tmp_path):
    """Fibres around an axis that is the normal: no direction is along them, so each face has its angle from x."""
    mesh = block((2, 2, 2), axis=2)
    mesh.nodes += [3.0, 1.0, 0.0]
    around = ["*ORIENTATION, NAME=O, SYSTEM=CYLINDRICAL", "0., 0., 0., 0., 0., 1."]
    path = written(tmp_path, mesh, [*around, FLAT[-1]])
    found = groups_of(path, between=[("LOW", "HIGH")])
    assert [direction(each) for each in found] == [[0.0, 0.0, 0.0]] * 4
    places = itertools.product((3.5, 4.5), (1.5, 2.5))
    expected = sorted(np.degrees(np.arctan2(y, x)) for x, y in places)
    assert sorted(each["ANGLE TOP"] for each in found) == pytest.approx(expected, abs=1e-4)


def two_corners():
    """Two quarters of cylinders that share nothing, about z and about y."""
    lines, nodes, elements = [], 0, 0
    for name, order, axis in (("Z", [0, 1, 2], 2), ("Y", [1, 2, 0], 1)):
        mesh = grid("C3D8", (4, 2, 1), (4.0, 2.0, 1.0))
        angle, radius = np.pi / 8 * mesh.nodes[:, 0], RADIUS + mesh.nodes[:, 1]
        places = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), mesh.nodes[:, 2]])
        # angles run the other way about z, for positive volumes
        places[:, 1] *= -1.0
        places = places[:, order] + (20.0 if name == "Y" else 0.0)
        lines += ["*NODE", *(f"{nodes + k}, {x!r}, {y!r}, {z!r}" for k, (x, y, z) in enumerate(places.tolist(), 1))]
        for word, rows in (("LOW", mesh.cell[:, 1] == 0), ("HIGH", mesh.cell[:, 1] == 1)):
            lines.append(f"*ELEMENT, TYPE=C3D8, ELSET={word}{name}")
            for k in np.flatnonzero(rows).tolist():
                lines.append(f"{elements + k + 1}, " + ", ".join(str(nodes + n + 1) for n in mesh.elements[k].tolist()))
            lines.append(f"*SOLID SECTION, ELSET={word}{name}, MATERIAL=PLY, ORIENTATION={name}")
        a = np.full(3, 20.0) if name == "Y" else np.zeros(3)
        b = a + np.eye(3)[axis]
        lines += [f"*ORIENTATION, NAME={name}, SYSTEM=CYLINDRICAL", ", ".join(map(str, [*a.tolist(), *b.tolist()]))]
        nodes, elements = nodes + len(mesh.nodes), elements + len(mesh.elements)
    return lines


def test_cylinders_about_several_axes(tmp_path):
    """Each has its own direction."""
    path = tmp_path / "deck.inp"
    path.write_text("\n".join([*two_corners(), *material(), "*STEP\n*STATIC\n1., 1.\n*END STEP"]) + "\n")
    found = groups_of(path, between=[("LOWZ", "HIGHZ"), ("LOWY", "HIGHY")])
    assert sorted(map(direction, found)) == [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]][::-1]


def test_directions_of_the_command_line(tmp_path):
    """They hold for all; close to a normal they are refused. With an angle of the command line x is the direction."""
    mesh, lines = bracket("C3D8", (0, 90))
    path, wanted = written(tmp_path, mesh, lines), {"between": [("PLY0", "PLY1")]}
    (found,) = groups_of(path, (*LAW, "DIRECTION1=1", "DIRECTION3=3"), **wanted)[:1]
    assert direction(found) == [1.0, 0.0, 3.0]
    message = (
        r"DIRECTION1=1 DIRECTION2=0 DIRECTION3=0.05: at element \d+ it is 2.86 degrees from the normal of the "
        "interface; expected at least 5"
    )
    with pytest.raises(UsageError, match=message):
        inserted(path, tmp_path / "cut.inp", (*LAW, "DIRECTION1=1", "DIRECTION3=0.05"), **wanted)
    with pytest.raises(UsageError, match="U7 has no property DIRECTION1"):
        inserted(path, tmp_path / "cut.inp", (*LAW, "ALPHAN=1e6", "DIRECTION1=1"), element="U7", **wanted)
    inserted(path, tmp_path / "cut.inp", (*LAW, "ANGLE_BOTTOM=90"), **wanted)
    assert "DIRECTION3" in (tmp_path / "cut.inp").read_text()
    groups = [group for group in read_deck(tmp_path / "cut.inp").groups if group.type == "U8"]
    position = {item.name: item.position - 1 for item in element_layouts()[8].reals}
    for group in groups:
        assert not group.section.values[[position[f"DIRECTION{k}"] for k in (1, 2, 3)]].any()
        assert group.section.values[position["ANGLE BOTTOM"]] == 90.0


def test_isotropic_solids_need_no_direction(tmp_path):
    mesh, lines = bracket("C3D8", (0, 90))
    path = written(tmp_path, mesh, lines)
    path.write_text(re.sub(r"\*ELASTIC, TYPE=ENG.*\n.*\n.*\n", "*ELASTIC\n7e4, 0.3\n", path.read_text()))
    (found,) = groups_of(path, between=[("PLY0", "PLY1")])
    assert direction(found) == [0.0, 0.0, 0.0]


def test_a_cylinder_beside_the_laminate_is_refused(tmp_path):
    """The radial direction of an orientation about another axis is not the normal; the place is that of its section."""
    mesh, lines = bracket("C3D8", (0, 0))
    shifted = [line.replace("0, 0, 0, 0, 0, 1", "0, 0.5, 0, 0, 0.5, 1") for line in lines]
    assert shifted != lines
    path = written(tmp_path, mesh, shifted)
    number = 1 + next(
        k for k, line in enumerate(path.read_text().splitlines()) if line.startswith("*SOLID SECTION, ELSET=P0_ARC")
    )
    message = (
        r"no axis of the material is normal to the whole interface: at element \d+ the closest one is \d\.\d+ degrees "
        rf"off \(\*SOLID SECTION at .*deck.inp:{number}\)"
    )
    with pytest.raises(UsageError, match=message):
        inserted(path, tmp_path / "cut.inp", between=[("PLY0", "PLY1")])


def instances(folder, axis):
    """Two instances of a bracket, the second one turned by 30 degrees about an axis."""
    mesh, lines = bracket("C3D8", (0, 90))
    end = ", ".join(map(str, axis))
    text = ["*PART, NAME=P", *mesh.lines(), *lines, "*END PART", "*ASSEMBLY, NAME=A"]
    text += ["*INSTANCE, NAME=ONE, PART=P", "*END INSTANCE", "*INSTANCE, NAME=TWO, PART=P", "0., 0., 50."]
    text += [f"0., 0., 0., {end}, 30.", "*END INSTANCE", "*END ASSEMBLY", *material()]
    path = folder / "deck.inp"
    path.write_text("\n".join([*text, "*STEP\n*STATIC\n1., 1.\n*END STEP"]) + "\n")
    return path


def test_instances_that_are_turned(tmp_path):
    """About the axis of their cylinder they have one direction and the same angles, about another not."""
    found = groups_of(instances(tmp_path, (0.0, 0.0, 1.0)), between=[("P.PLY0", "P.PLY1")])
    assert {(*direction(each), each["ANGLE BOTTOM"]) for each in found} == {(0.0, 0.0, 1.0, 90.0)}
    with pytest.raises(DeckError, match=r"\*INSTANCE: instance TWO is turned against ONE, so the plies at element"):
        groups_of(instances(tmp_path, (1.0, 0.0, 0.0)), between=[("P.PLY0", "P.PLY1")])
