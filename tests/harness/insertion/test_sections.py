# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Elastic constants and directions that inserted elements take from sections: curved plies, layers, turned parts."""

import re

import numpy as np
import pytest
from solid_grids import LAW, grid, inserted

import uel
from uel.deck.reader import read_deck
from uel.elements.interfaces.neighbour_data import compare
from uel.errors import DeckError, UsageError
from uel.usersub.layout import element_layouts

PLY = (9.0e3, 8.0e4, 7.0e3, 0.05, 0.25, 0.3, 4.0e3, 3.0e3, 5.0e3)
"""E1, E2, E3, nu12, nu13, nu23, G12, G13, G23: fibres along 2, which is around the axis of a cylinder."""
STRONG = ("SIGMAMAX=1e6", "TAUMAX=1e6", "GIC=1e9", "GIIC=1e9")
STEP = ["*STEP", "*STATIC", "1., 1."]


def ply(name="PLY", constants=PLY):
    """*MATERIAL of engineering constants."""
    words = list(map(repr, constants))
    return [f"*MATERIAL, NAME={name}", "*ELASTIC, TYPE=ENGINEERING CONSTANTS", ", ".join(words[:8]), words[8]]


def halves(kind="C3D8", counts=(2, 2, 2), axis=-1):
    """A block with the sets LOW and HIGH along an axis."""
    mesh = grid(kind, counts, tuple(map(float, counts)))
    low = mesh.cell[:, axis] == 0
    mesh.sets = {"LOW": low, "HIGH": ~low}
    return mesh


def deck(folder, mesh, *lines, step=(), name="deck.inp"):
    path = folder / name
    path.write_text("\n".join([*mesh.lines(), *lines, *STEP, *step, "*END STEP"]) + "\n")
    return path


def properties(path, element, **wanted):
    """Properties by name of each group of inserted elements, and what the insertion says."""
    output = path.with_name("out.inp")
    done = inserted(path, output, wanted.pop("values", LAW), **(wanted or {"between": [("LOW", "HIGH")]}))
    layout = element_layouts()[int(element[1:])]
    of_solids = {item.name: item.position - 1 for item in layout.reals if item.name.endswith((" BOTTOM", " TOP"))}
    model = read_deck(output)
    # what is written agrees with its solids
    assert [each for each in compare(model, model.groups) if each.wrong] == []
    groups = [group for group in model.groups if group.type == element]
    return [{name: group.section.values[k] for name, k in of_solids.items()} for group in groups], done


def stiffness(constants):
    """(6, 6) of 11, 22, 33, 12, 13, 23."""
    e1, e2, e3, nu12, nu13, nu23, g12, g13, g23 = constants
    compliance = np.diag([1 / e1, 1 / e2, 1 / e3, 1 / g12, 1 / g13, 1 / g23])
    for i, j, value in ((0, 1, nu12 / e1), (0, 2, nu13 / e1), (1, 2, nu23 / e2)):
        compliance[i, j] = compliance[j, i] = -value
    return np.linalg.inv(compliance)


def stress(constants, axes, strain):
    """(3, 3) stress in global components by a strain (3, 3); axes of the material in rows."""
    local = axes @ strain @ axes.T
    pairs = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    values = stiffness(constants) @ [local[i, j] * (1 if i == j else 2) for i, j in pairs]
    found = np.zeros((3, 3))
    for (i, j), value in zip(pairs, values, strict=True):
        found[i, j] = found[j, i] = value
    return axes.T @ found @ axes


def arc(counts=(4, 2, 2)):
    """A quarter of a cylinder about the y axis, of two plies."""
    mesh = halves(counts=counts)
    angle, radius = np.pi / 2 * mesh.nodes[:, 0] / counts[0], 5.0 + mesh.nodes[:, 2]
    mesh.nodes = np.column_stack([radius * np.sin(angle), mesh.nodes[:, 1], radius * np.cos(angle)])
    return mesh


def test_traction_of_a_curved_ply_is_that_of_its_stress(tmp_path):
    """Traction is the stress of a homogeneous strain in the middle of a face times the normal, which no angle but the
    right one gives: the fibres run at 25 degrees around the cylinder."""
    mesh = arc()
    gradient = 1e-3 * np.array([[1.0, 0.4, -0.2], [0.3, -0.5, 0.1], [0.2, 0.1, 0.6]])
    loads = [
        f"{k}, {d + 1}, {d + 1}, {float(v)!r}" for k, x in enumerate(mesh.nodes, 1) for d, v in enumerate(gradient @ x)
    ]
    path = deck(
        tmp_path,
        mesh,
        *ply(),
        "*ORIENTATION, NAME=AROUND, SYSTEM=CYLINDRICAL",
        "0., 0., 0., 0., 1., 0.",
        "1, 25.",
        "*SOLID SECTION, ELSET=BODY, MATERIAL=PLY, ORIENTATION=AROUND",
        step=["*BOUNDARY", *loads, "*OUTPUT, FIELD", "*NODE OUTPUT", "U"],
    )
    done = inserted(path, tmp_path / "cut.inp", STRONG, between=[("LOW", "HIGH")])
    assert list(done.kinds) == ["U8"] and done.warnings == ()
    result = uel.run(tmp_path / "cut.inp", output_dir=tmp_path, quiet=True)
    profile = result.interface()
    group = next(group for group in read_deck(tmp_path / "cut.inp").groups if group.type == "U8")
    assert len(profile["TN"]) == 4 * 8
    model = read_deck(tmp_path / "cut.inp")
    groups = [group for group in model.groups if group.type == "U8"]
    faces = {label: row[4:8] for group in groups for label, row in zip(group.labels, group.nodes, strict=True)}
    strain = 0.5 * (gradient + gradient.T)
    for row in range(len(profile["TN"])):
        corners = model.mesh.coordinates[faces[int(profile["element"][row])]]
        normal = np.cross(corners[2] - corners[0], corners[3] - corners[1])
        normal /= np.linalg.norm(normal)
        middle = corners.mean(axis=0)
        radial = np.array([middle[0], 0.0, middle[2]]) / np.hypot(middle[0], middle[2])
        hoop = np.cross([0.0, 1.0, 0.0], radial)
        c, s = np.cos(np.radians(25.0)), np.sin(np.radians(25.0))
        axes = np.array([radial, c * hoop + s * np.eye(3)[1], c * np.eye(3)[1] - s * hoop])
        traction = stress(PLY, axes, strain) @ normal
        assert profile["TN"][row] == pytest.approx(traction @ normal, rel=1e-6)
        shear = np.linalg.norm(traction - (traction @ normal) * normal)
        # angles have four decimals
        assert np.hypot(profile["TS"][row], profile["TT"][row]) == pytest.approx(shear, rel=1e-5)
    assert group.section.values[0] == 0.0  # ALPHAN: rigid


def test_each_angle_has_its_properties(tmp_path):
    """In the plane the angle is that from x: each face of an arc has its own."""
    mesh = halves("CPS4", (3, 2))
    angle, radius = np.pi / 2 * (1.0 - mesh.nodes[:, 0] / 3.0), 5.0 + mesh.nodes[:, 1]
    mesh.nodes = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    lamina = ["*MATERIAL, NAME=PLY", "*ELASTIC, TYPE=LAMINA", "9e4, 8e3, 0.3, 4e3, 4e3, 3e3"]
    around = ["*ORIENTATION, NAME=AROUND, SYSTEM=CYLINDRICAL", "0., 0., 0., 0., 0., 1."]
    section = ["*SOLID SECTION, ELSET=BODY, MATERIAL=PLY, ORIENTATION=AROUND", "1."]
    found, _ = properties(deck(tmp_path, mesh, *lamina, *around, *section), "U4")
    assert sorted(each["ANGLE BOTTOM"] for each in found) == pytest.approx([15.0, 45.0, 75.0])
    assert all(each["ANGLE BOTTOM"] == each["ANGLE TOP"] and each["E1 TOP"] == 9e4 for each in found)


def test_a_whole_ring_has_one_set_of_properties(tmp_path):
    """Angles are from the axis of the cylinder, not from x, whose projection changes its sense."""
    mesh = halves(counts=(8, 1, 2))
    angle, radius = 2 * np.pi * (mesh.nodes[:, 0] - 0.01) / 8.5, 5.0 + mesh.nodes[:, 2]
    mesh.nodes = np.column_stack([radius * np.sin(angle), mesh.nodes[:, 1], radius * np.cos(angle)])
    around = ["*ORIENTATION, NAME=AROUND, SYSTEM=CYLINDRICAL", "0., 0., 0., 0., 1., 0."]
    section = ["*SOLID SECTION, ELSET=BODY, MATERIAL=PLY, ORIENTATION=AROUND"]
    found, _ = properties(deck(tmp_path, mesh, *ply(), *around, *section), "U8")
    assert [each["ANGLE BOTTOM"] for each in found] == [90.0]


def test_angles_of_a_distribution(tmp_path):
    lines = ["*DISTRIBUTION TABLE, NAME=T", "ANGLE", "*DISTRIBUTION, NAME=D, LOCATION=ELEMENT, TABLE=T"]
    lines += [", 20.", "HIGH, -50.", "1, 70."]
    lines += ["*ORIENTATION, NAME=O", "1., 0., 0., 0., 1., 0.", "3, D"]
    path = deck(tmp_path, halves(), *ply(), *lines, "*SOLID SECTION, ELSET=BODY, MATERIAL=PLY, ORIENTATION=O")
    found, _ = properties(path, "U8")
    assert sorted((each["ANGLE BOTTOM"], each["ANGLE TOP"]) for each in found) == [(20.0, -50.0), (70.0, -50.0)]


LAYERS = ["1., 1, A, 10.", "1., 1, B, 20.", "1., 1, C, 30."]


@pytest.mark.parametrize(
    ("direction", "angles"),
    # s is x, and z where the normal is x; n x s is -z, -y and y
    [(1, (-60.0, -80.0)), (2, (30.0, 10.0)), (3, (30.0, 10.0))],
)
def test_the_layer_at_the_interface_counts(tmp_path, direction, angles):
    """Below, the last layer in the stack direction, above it the first one; angles about the direction across."""
    materials = [line for name, e in (("A", 1e4), ("B", 2e4), ("C", 3e4)) for line in ply(name, (e, e, *PLY[2:]))]
    path = deck(
        tmp_path,
        halves(axis=direction - 1),
        *materials,
        *["*ORIENTATION, NAME=O", "1., 0., 0., 0., 1., 0.", f"{direction}, 0."],
        f"*SOLID SECTION, ELSET=BODY, COMPOSITE, ORIENTATION=O, STACK DIRECTION={direction}",
        *LAYERS,
    )
    ((found,), _) = properties(path, "U8")
    output = tmp_path / "out.inp"
    model = read_deck(output)
    assert compare(model, model.groups) == []
    assert (found["E1 BOTTOM"], found["E1 TOP"]) == (3e4, 1e4)
    assert (found["ANGLE BOTTOM"], found["ANGLE TOP"]) == angles
    # the materials of other layers are not those at the interface
    for old, new, name in (("1., 1, C", "1., 1, A", "A"), ("1., 1, A", "1., 1, B", "B")):
        changed = tmp_path / "changed.inp"
        changed.write_text(output.read_text().replace(old, new))
        model = read_deck(changed)
        (first,) = compare(model, model.groups)
        assert first.wrong and re.search(rf"U8 element \d+: E\d .* but the C3D8 .* \(material {name}\)$", first.message)


def test_angles_of_layers_are_those_of_plain_sections(tmp_path):
    """A layer with an angle gives the properties of a section whose orientation is turned by it."""
    orientation = ["*ORIENTATION, NAME=O", "1., 0.2, 0., 0., 1., 0.", "3, 5."]
    layers = ["*SOLID SECTION, ELSET=LOW, COMPOSITE, ORIENTATION=O", "1., 1, PLY, 60.", "2., 3, PLY, 30."]
    layers += ["*SOLID SECTION, ELSET=HIGH, COMPOSITE, ORIENTATION=O", "1., 1, PLY, -20.", "2., 3, PLY, 30."]
    plain = []
    for name, angle in (("LOW", 30.0), ("HIGH", -20.0)):
        plain += [f"*ORIENTATION, NAME={name}", "1., 0.2, 0., 0., 1., 0.", f"3, {5.0 + angle}"]
        plain += [f"*SOLID SECTION, ELSET={name}, MATERIAL=PLY, ORIENTATION={name}"]
    ((of_layers,), _) = properties(deck(tmp_path, halves(), *ply(), *orientation, *layers), "U8")
    ((of_plain,), _) = properties(deck(tmp_path, halves(), *ply(), *plain), "U8")
    assert of_layers == pytest.approx(of_plain)


def test_an_interface_across_the_layers_has_no_layer(tmp_path):
    orientation = ["*ORIENTATION, NAME=O", "1., 0., 0., 0., 1., 0.", "3, 0."]
    section = ["*SOLID SECTION, ELSET=BODY, COMPOSITE, ORIENTATION=O", *LAYERS]
    lines = [*ply("A"), *ply("B"), *ply("C"), *orientation, *section]
    message = r"the interface runs across the layers of element 1 \(\*SOLID SECTION at .*deck.inp:\d+\); give E1_BOTTOM"
    path = deck(tmp_path, halves(axis=0), *lines)
    with pytest.raises(UsageError, match=message):
        properties(path, "U8")
    values = [f"{name}_{side}=1" for side in ("BOTTOM", "TOP") for name in ("E1", "E2", "E3", "G12", "G13", "G23")]
    properties(path, "U8", values=[*LAW, *values])
    model = read_deck(tmp_path / "out.inp")
    (reason, _) = [each.message for each in compare(model, model.groups)]
    assert re.search(r"constants are not compared with .*: the interface runs across its layers$", reason)


def tilted(degrees):
    """An orientation whose axis 3 is so far from z."""
    c, s = float(np.cos(np.radians(degrees))), float(np.sin(np.radians(degrees)))
    return ["*ORIENTATION, NAME=O", f"{c!r}, 0., {-s!r}, 0., 1., 0."]


def test_an_oblique_axis_is_refused_or_said(tmp_path):
    section = ["*SOLID SECTION, ELSET=BODY, MATERIAL=PLY, ORIENTATION=O"]
    message = r"no axis of the material is normal to the whole interface: at element 1 the closest one is 3 degrees off"
    with pytest.raises(UsageError, match=message):
        properties(deck(tmp_path, halves(), *ply(), *tilted(3.0), *section), "U8")
    _, done = properties(deck(tmp_path, halves(), *ply(), *tilted(0.2), *section), "U8")
    (warning,) = done.warnings
    assert re.match(
        r".*deck.inp:\d+: the axis across the ply is not quite normal to the interface: .* 0.2 deg", warning
    )
    _, done = properties(deck(tmp_path, halves(), *ply(), *tilted(0.001), *section), "U8")
    assert done.warnings == ()


@pytest.mark.parametrize("degrees", [0.2, 0.499])
def test_what_is_written_for_an_oblique_axis_agrees_with_its_solids(tmp_path, degrees):
    """A ply with E1/G = 22 couples extension with shear by 1 % at 0.14 degrees."""
    carbon = ply(constants=(138e3, 10.5e3, 10.5e3, 0.3, 0.3, 0.45, 6.3e3, 6.3e3, 3.5e3))
    section = ["*SOLID SECTION, ELSET=BODY, MATERIAL=PLY, ORIENTATION=O"]
    _, done = properties(deck(tmp_path, halves(), *carbon, *tilted(degrees), *section), "U8")
    assert len(done.warnings) == 1


@pytest.mark.parametrize(
    ("orientation", "message", "said"),
    [
        (
            ["*ORIENTATION, NAME=O, SYSTEM=USER"],
            "orientation O is that of ORIENT",
            "orientation O: its directions are those of ORIENT$",
        ),
        (
            ["*ORIENTATION, NAME=O, SYSTEM=CYLINDRICAL", "0.5, 0.5, 0., 0.5, 0.5, 1."],
            "orientation O: element 1: it is on the polar axis",
            "orientation O: it is on the polar axis in element 1$",
        ),
        (
            ["*ORIENTATION, NAME=O, DEFINITION=OFFSET TO NODES", "1, 2, 9"],
            "orientation O: local node 9 of 8",
            "orientation O: local node 9 of 8$",
        ),
    ],
)
def test_directions_that_are_not_known(tmp_path, orientation, message, said):
    section = "*SOLID SECTION, ELSET=BODY, MATERIAL=PLY, ORIENTATION=O"
    with pytest.raises(UsageError, match=rf"{message} \(\*SOLID SECTION at .*deck.inp:\d+\)"):
        properties(deck(tmp_path, halves(), *ply(), *orientation, section), "U8")
    # constants that are given do
    values = [f"{name}_{side}=1" for side in ("BOTTOM", "TOP") for name in ("E1", "E2", "E3", "G12", "G13", "G23")]
    found, _ = properties(deck(tmp_path, halves(), *ply(), *orientation, section), "U8", values=[*LAW, *values])
    assert len(found) == 1
    model = read_deck(tmp_path / "out.inp")
    reasons = [each.message for each in compare(model, model.groups)]
    assert len(reasons) == 2
    assert re.match(
        r"U8 element 9: its elastic constants are not compared with those of the C3D8 element 1", reasons[0]
    )
    assert re.search(said, reasons[0])


def parts(folder, turn, material):
    section = "*SOLID SECTION, ELSET=BODY, MATERIAL=PLY, ORIENTATION=O"
    lines = ["*PART, NAME=P", *halves().lines(), *tilted(0.0), section, "*END PART"]
    lines += ["*ASSEMBLY, NAME=A", "*INSTANCE, NAME=ONE, PART=P", "*END INSTANCE"]
    lines += ["*INSTANCE, NAME=TWO, PART=P", "0., 0., 9.", f"0., 0., 9., 0., 0., 10., {turn}", "*END INSTANCE"]
    path = folder / "deck.inp"
    path.write_text("\n".join([*lines, "*END ASSEMBLY", *material, *STEP, "*END STEP"]) + "\n")
    return path


def test_a_turned_instance_has_other_angles(tmp_path):
    """The angle is from the projection of the global x axis, so one *UEL PROPERTY of the part cannot serve both."""
    found, _ = properties(parts(tmp_path, 180.0, ply()), "U8")
    assert {each["ANGLE TOP"] for each in found} == {0.0}
    steel = ["*MATERIAL, NAME=PLY", "*ELASTIC", "1e4, 0.3"]
    assert properties(parts(tmp_path, 30.0, steel), "U8")[1].kinds.keys() == {"U8"}
    message = r"deck.inp:\d+: \*INSTANCE: instance TWO is turned against ONE, so .* 30 in TWO and 0 in ONE, for which"
    with pytest.raises(DeckError, match=message):
        properties(parts(tmp_path, 30.0, ply()), "U8")
