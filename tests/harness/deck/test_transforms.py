# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*TRANSFORM: a body that is turned, with its supports and loads in turned directions, does what it did before."""

from itertools import product

import numpy as np
import pytest

from uel.errors import DeckError

SQUARE = np.array([[0, 0, 0], [2, 0, 0], [2.2, 1, 0], [0, 1, 0]], dtype=float)
CUBE = np.vstack([SQUARE, SQUARE + np.array([0, 0.1, 1])])
PLANE = np.array([[0.8, 0.6, 0], [-0.6, 0.8, 0], [0, 0, 1]])
SPACE = np.array([[2, 2, 1], [-2, 1, 2], [1, -2, 2]]) / 3
BODIES = {
    "CPS4": (SQUARE, PLANE, "*SOLID SECTION, ELSET=E, MATERIAL=M\n1."),
    "CPE4R": (SQUARE, PLANE, "*SOLID SECTION, ELSET=E, MATERIAL=M\n1."),
    "C3D8": (CUBE, SPACE, "*SOLID SECTION, ELSET=E, MATERIAL=M"),
    "S4": (SQUARE, SPACE, "*SHELL SECTION, ELSET=E, MATERIAL=M\n0.1"),
}
"""Nodes, the directions (rows) of the turned body, and the section."""
HELD = "1, 1, 3\n4, 1\n4, 3\n2, 2, 3\n1, 4, 6\n4, 5\n"
PULLED = "*BOUNDARY\n2, 1, 1, 0.01\n*CLOAD\n3, 1, 2.\n3, 2, -1.\n3, 5, 0.1\n"
STEPS = {
    "static": f"*STEP\n*STATIC\n0.5, 1.\n{PULLED}",
    "large": f"*STEP, NLGEOM\n*STATIC\n0.5, 1.\n*CONTROLS, PARAMETERS=FIELD, FIELD=DISPLACEMENT\n1e-9\n{PULLED}",
    "dynamic": f"*STEP\n*DYNAMIC, NOHAF\n0.1, 0.3\n{PULLED}",
    "released": f"*STEP\n*STATIC\n{PULLED}*END STEP\n*STEP\n*STATIC\n*BOUNDARY, OP=NEW\n{HELD}",
    "perturbation": f"*STEP, PERTURBATION\n*STATIC\n{PULLED}",
    "harmonic": f"*STEP\n*STEADY STATE DYNAMICS, DIRECT\n0.1, 0.2, 2\n{PULLED}",
}


def deck(element_type, step, turned):
    nodes, axes, section = BODIES[element_type]
    if turned:
        nodes = nodes @ axes
    lines = ["*NODE, NSET=ALL", *(f"{k}, {x!r}, {y!r}, {z!r}" for k, (x, y, z) in enumerate(nodes.tolist(), start=1))]
    lines += [f"*ELEMENT, TYPE={element_type}, ELSET=E", "1, " + ", ".join(map(str, range(1, len(nodes) + 1)))]
    lines += [section, "*MATERIAL, NAME=M", "*DENSITY", "0.5", "*ELASTIC", "1000., 0.3"]
    if turned:
        lines += ["*TRANSFORM, NSET=ALL", ", ".join(map(repr, axes[:2].ravel().tolist()))]
    lines += ["*BOUNDARY", HELD + ("5, 3\n" if len(nodes) == 8 else "") + STEPS[step].rstrip()]
    lines += ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "U, UR, RF, RM, CF, CM", "*END STEP", ""]
    return "\n".join(lines)


def vectors(history, name, nodes):
    """(nodes, increments, 3) of a nodal quantity, zero where a node has no such component."""
    some = len(history["time"])
    columns = [
        [history.get(f"{name}{k}[ALL:{node}]", np.zeros(some)) for k in (1, 2, 3)] for node in range(1, nodes + 1)
    ]
    return np.nan_to_num(np.moveaxis(np.array(columns, dtype=float), 1, 2))


@pytest.mark.parametrize(
    ("element_type", "step"), [pair for pair in product(BODIES, STEPS) if pair not in {("S4", "large")}]
)
def test_a_turned_body_does_what_it_did_before(run_deck, element_type, step):
    """Displacements, rotations, reactions and loads turn with it; output has them in global directions."""
    nodes, axes, _ = BODIES[element_type]
    before = run_deck(deck(element_type, step, turned=False)).history
    turned = run_deck(deck(element_type, step, turned=True)).history
    moved = 0
    for name in ("U", "UR", "RF", "RM", "CF", "CM"):
        expected = vectors(before, name, len(nodes))
        found = vectors(turned, name, len(nodes)) @ axes.T
        if step == "harmonic":
            # amplitudes of the components of a vector do not turn, but those here are in phase
            expected, found = np.linalg.norm(expected, axis=-1), np.linalg.norm(found, axis=-1)
        size = np.abs(expected).max()
        moved += size > 0
        np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-7 * max(size, 1e-3), err_msg=name)
    assert moved >= 3


CYLINDER = """*NODE, NSET=ALL
1, 3., 1.
2, 5., 1.
3, 4., 4.
4, 1., 3.
*ELEMENT, TYPE=CPE4, ELSET=E
1, 1, 2, 3, 4
*SOLID SECTION, ELSET=E, MATERIAL=M
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*NSET, NSET=TURNED
1, 3, 4
*TRANSFORM, NSET=TURNED, TYPE={}
1., 1., 0., 1., 1., 5.
*STEP
*STATIC
1., 1.
*BOUNDARY
1, 1, 2, 0.1
2, 1, 2
4, 1, 1, 0.2
4, 2, 2, 0.3
*CLOAD
3, 1, 10.
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=ALL
U, CF
*END STEP
"""


@pytest.mark.parametrize("kind", ["C", "S"])
def test_directions_about_an_axis(run_deck, kind):
    """1 is radial; 2 is circumferential: the direction 3 of the sphere is -z in the plane of its centre."""
    history = run_deck(CYLINDER.format(kind)).history
    found = {node: [history[f"U{k}[ALL:{node}]"][-1] for k in (1, 2)] for node in range(1, 5)}
    assert found[1] == pytest.approx([0.1, 0.1])
    assert found[2] == pytest.approx([0.0, 0.0])
    assert found[4] == pytest.approx([-0.3, 0.2])
    load = [history[f"CF{k}[ALL:3]"][-1] for k in (1, 2)]
    assert load == pytest.approx([10 / 2**0.5, 10 / 2**0.5])


def test_a_transform_of_a_part_turns_with_its_instance(run_deck):
    """The part is turned by 90 degrees about z: its x axis, along which the support is free, is y."""
    text = (
        "*PART, NAME=P\n"
        + CYLINDER.split("*MATERIAL", maxsplit=1)[0]
        + "*NSET, NSET=TURNED\n1, 3, 4\n*TRANSFORM, NSET=TURNED\n"
    )
    text += "1., 0., 0., 0., 1., 0.\n*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n0., 0., 0.\n"
    text += "0., 0., 0., 0., 0., 1., 90.\n*END INSTANCE\n*NSET, NSET=ALL, INSTANCE=I\n1, 2, 3, 4\n*END ASSEMBLY\n"
    text += "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*STEP\n*STATIC\n1., 1.\n*BOUNDARY\nI.1, 1, 1, 0.1\nI.1, 2\n"
    text += "I.2, 1, 2\nI.4, 1, 2\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU\n*END STEP\n"
    history = run_deck(text).history
    (first,) = [name for name in history if name.startswith("U1[") and name.endswith("I.1]")]
    assert history[first][-1] == pytest.approx(0.0, abs=1e-12)
    assert history[first.replace("U1", "U2")][-1] == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            [("TYPE=C\n", "TYPE=S\n"), ("1., 1., 0., 1., 1., 5.", "3., 1., 0., 3., 1., 5.")],
            r":15: .*node 1 has no directions: it is on the polar axis",
        ),
        ([("1., 1., 0., 1., 1., 5.\n", "")], r":14: \*TRANSFORM: needs a data line with the points a and b"),
        (
            [("1., 1., 0., 1., 1., 5.", "2., 2., 0., 6., 2., 0.")],
            r"\*TRANSFORM: local dof \d of node \d has a part along dof 3",
        ),
        ([("*BOUNDARY", "*BOUNDARY, USER")], r"USER is not supported at nodes with \*TRANSFORM, such as 1"),
        (
            [("*STEP", "*EQUATION\n2\n2, 1, 1., 3, 1, -1.\n*STEP")],
            r"node 3 has a \*TRANSFORM \(.*:14\), which is not supported here",
        ),
        ([("*STEP", "*MPC\nPIN, 3, 2\n*STEP")], r"node 3 has a \*TRANSFORM \(.*:14\), which is not supported here"),
    ],
)
def test_what_is_wrong_is_named(run_deck, changes, message):
    text = CYLINDER.format("C")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    with pytest.raises(DeckError, match=message):
        run_deck(text)


def test_two_values_of_a_local_dof_are_told(run_deck):
    result = run_deck(CYLINDER.format("C").replace("2, 1, 2\n", "2, 1, 2\n1, 2, 2, 0.4\n"))
    assert any("node 1, dof 2 is given the value 0.4 here and the value 0.1" in text for text in result.warnings)


def test_printed_components_are_told(run_deck, tmp_path):
    run_deck(CYLINDER.format("C").replace("*OUTPUT, HISTORY", "*NODE PRINT\nU\n*OUTPUT, HISTORY"))
    text = " ".join((tmp_path / "deck.dat").read_text().split())
    assert "*NODE PRINT: components are global here; in Abaqus they are those of *TRANSFORM without GLOBAL=YES" in text


def test_a_node_on_the_axis_is_told(run_deck):
    """Direction 1 is x there, 2 is y; the directions of others are radial as ever."""
    result = run_deck(CYLINDER.format("C").replace("1., 1., 0., 1., 1., 5.", "3., 1., 0., 3., 1., 5."))
    assert [result.history[f"U{k}[ALL:1]"][-1] for k in (1, 2)] == pytest.approx([0.1, 0.1])
    outward = np.array([-2.0, 2.0]) / 8**0.5
    moved = [result.history[f"U{k}[ALL:4]"][-1] for k in (1, 2)]
    assert moved == pytest.approx(0.2 * outward + 0.3 * np.array([-outward[1], outward[0]]))
    assert any("node 1 is on the polar axis" in warning for warning in result.warnings)
