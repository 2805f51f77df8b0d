# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*ORIENTATION of every system and definition, with *DISTRIBUTION, for two elements in a row, 11 and 12."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.testing import assert_allclose

from uel.errors import DeckError
from uel.model.arrays import FloatArray
from uel.model.model import Model
from uel.model.properties import SolidSection

Read = Callable[[str], Model]

MESH = """*NODE
1, 0., 0.
2, 1., 0.
3, 3., 0.
4, 0., 1.
5, 1., 1.
6, 3., 2.
*ELEMENT, TYPE=CPE4, ELSET=ALL
11, 1, 2, 5, 4
12, 2, 3, 6, 5
"""
SECTION = "*SOLID SECTION, ELSET=ALL, MATERIAL=M, ORIENTATION=O\n1.\n"
MATERIAL = "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*STEP\n*STATIC\n1., 1.\n*END STEP\n"
DISTRIBUTED = """*DISTRIBUTION TABLE, NAME=T
{labels}
*DISTRIBUTION, NAME=D, LOCATION=ELEMENT, TABLE=T
{data}
*ORIENTATION, NAME=O
{lines}
"""
POINTS = "COORD3D, COORD3D"


def flat(orientation: str) -> str:
    return f"{MESH}{orientation}\n{SECTION}{MATERIAL}"


def instance(orientation: str, placement: str) -> str:
    part = f"*PART, NAME=P\n{MESH}{orientation}\n{SECTION}*END PART\n"
    return f"{part}*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n{placement}\n*END INSTANCE\n*END ASSEMBLY\n{MATERIAL}"


def axes_at(model: Model, places: FloatArray) -> FloatArray:
    """Directions (elements, places, 3, 3) at the same places of both elements."""
    group = model.groups[0]
    assert isinstance(group.section, SolidSection)
    orientation = group.section.orientation
    assert orientation is not None
    count = len(group.labels)
    if orientation.system is None:
        return np.broadcast_to(orientation.axes, (count, len(places), 3, 3))
    nodes = model.mesh.coordinates[group.nodes]
    return orientation.system.axes(np.arange(count), nodes, np.broadcast_to(places, (count, len(places), 3)))


PLACE = np.array([[3.0, 4.0, 0.0]])


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        # c is the origin: a along 1, b in the plane of 1 and 2
        (", SYSTEM=RECTANGULAR\n0., 2., 0., -1., 1., 0.", [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]),
        # a along 3, b in the plane of 3 and 1
        (", SYSTEM=Z RECTANGULAR\n0., 0., 2., 0., 3., 1.", [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]),
        # 1 radial, 2 around the axis from a to b, 3 along it
        (", SYSTEM=CYLINDRICAL\n0., 0., 0., 0., 0., 2.", [[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]]),
        (", SYSTEM=CYLINDRICAL\n0., 0., 5., 0., 0., 2.", [[0.6, 0.8, 0], [0.8, -0.6, 0], [0, 0, -1]]),
        # 1 radial, 2 around the axis from a to b, 3 along the meridian
        (", SYSTEM=SPHERICAL\n0., 0., 0., 0., 5., 0.", [[0.6, 0.8, 0], [0, 0, -1], [-0.8, 0.6, 0]]),
        # by nodes: along 2 to 5, and 4 on the side of direction 2; the origin of all coordinates, or node 2
        (", DEFINITION=NODES\n5, 4, 2", [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]),
        (", DEFINITION=NODES\n4, 2", [[0, 1, 0], [1, 0, 0], [0, 0, -1]]),
        (", DEFINITION=NODES, SYSTEM=CYLINDRICAL\n1, 2", [[0, 1, 0], [0, 0, 1], [1, 0, 0]]),
        # an additional rotation about axis 1 of a cylindrical system
        (", SYSTEM=CYLINDRICAL\n0., 0., 0., 0., 0., 1.\n1, 90.", [[0.6, 0.8, 0], [0, 0, 1], [0.8, -0.6, 0]]),
        (", SYSTEM=CYLINDRICAL\n0., 0., 0., 0., 0., 1.\n, 90.", [[0.6, 0.8, 0], [0, 0, 1], [0.8, -0.6, 0]]),
    ],
)
def test_systems(read: Read, lines: str, expected: list[list[float]]) -> None:
    model = read(flat(f"*ORIENTATION, NAME=O{lines}"))
    assert_allclose(axes_at(model, PLACE)[:, 0], [expected, expected], atol=1e-15)


def test_offset_to_nodes(read: Read) -> None:
    """Local nodes of each element: from its first node, or the third, to the second."""
    model = read(flat("*ORIENTATION, NAME=O, DEFINITION=OFFSET TO NODES\n2, 3"))
    assert_allclose(axes_at(model, PLACE)[:, 0], [np.eye(3), np.eye(3)], atol=1e-15)
    model = read(flat("*ORIENTATION, NAME=O, DEFINITION=OFFSET TO NODES\n4, 1, 3"))
    s = np.sqrt(0.2)
    expected = [[[-1, 0, 0], [0, -1, 0], [0, 0, 1]], [[-2 * s, -s, 0], [s, -2 * s, 0], [0, 0, 1]]]
    assert_allclose(axes_at(model, PLACE)[:, 0], expected, atol=1e-15)


def test_distribution_of_points(read: Read) -> None:
    """The default for what no line names; a number overrides its set."""
    data = ", 1., 0., 0., 0., 1., 0.\nALL, 0., 1., 0., -1., 0., 0.\n12, 0., 0., 1., 0., 1., 0."
    model = read(flat(DISTRIBUTED.format(labels=POINTS, data=data, lines="D")))
    first = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]
    assert_allclose(axes_at(model, PLACE)[:, 0], [first, [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]], atol=1e-15)
    model = read(flat(DISTRIBUTED.format(labels=POINTS, data=data.replace("ALL", "11"), lines="D\n1, 90.")))
    assert_allclose(axes_at(model, PLACE)[0, 0], [[0, 1, 0], [0, 0, 1], [1, 0, 0]], atol=1e-15)
    model = read(flat(DISTRIBUTED.format(labels=POINTS, data=", 0., 1., 0., -1., 0., 0.", lines="D")))
    assert_allclose(axes_at(model, PLACE)[:, 0], [first, first], atol=1e-15)


def test_distribution_of_angles_about_a_cylinder(read: Read) -> None:
    given = DISTRIBUTED.format(labels="ANGLE", data=", 0.\n12, 90.", lines="0., 0., 0., 0., 0., 1.\n1, D")
    model = read(flat(given.replace("NAME=O", "NAME=O, SYSTEM=CYLINDRICAL")))
    expected = [[[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]], [[0.6, 0.8, 0], [0, 0, 1], [0.8, -0.6, 0]]]
    assert_allclose(axes_at(model, PLACE)[:, 0], expected, atol=1e-15)


PLACEMENT = "2., 0., 0.\n2., 0., 0., 2., 0., 1., 90."
"""Shifted along x, then turned about the axis x = 2, y = 0."""


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        (", SYSTEM=RECTANGULAR\n1., 0., 0., 0., 1., 0.", [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]),
        # its axis is at x = 2, y = 0
        (", SYSTEM=CYLINDRICAL\n0., 0., 0., 0., 0., 2.", [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]),
        (", DEFINITION=NODES\n2, 4, 1", [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]),
        (", DEFINITION=OFFSET TO NODES\n2, 4", [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]),
    ],
)
def test_directions_of_an_instance_move_with_it(read: Read, lines: str, expected: list[list[float]]) -> None:
    model = read(instance(f"*ORIENTATION, NAME=O{lines}", PLACEMENT))
    assert_allclose(axes_at(model, np.array([[2.0, 5.0, 0.0]]))[0, 0], expected, atol=1e-15)


def test_distribution_in_a_part(read: Read) -> None:
    """Its elements are those of the part, and its points move with the instance; the table is the model's."""
    given = DISTRIBUTED.format(labels=POINTS, data=", 1., 0., 0., 0., 1., 0.\n12, 0., 1., 0., -1., 0., 0.", lines="D")
    table, rest = given.split("*DISTRIBUTION, ")
    model = read(f"{instance('*DISTRIBUTION, ' + rest, PLACEMENT)}".replace("*MATERIAL", f"{table}*MATERIAL"))
    expected = [[[0, 1, 0], [-1, 0, 0], [0, 0, 1]], [[-1, 0, 0], [0, -1, 0], [0, 0, 1]]]
    assert_allclose(axes_at(model, PLACE)[:, 0], expected, atol=1e-15)


def distributed(labels: str = POINTS, data: str = ", 1., 0., 0., 0., 1., 0.", lines: str = "D") -> str:
    return DISTRIBUTED.format(labels=labels, data=data, lines=lines)


ORIENTATION = "*ORIENTATION, NAME=O"


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (distributed(lines="E"), "16: unknown distribution E"),
        (
            distributed("ANGLE", ", 1."),
            "16: .*distribution D has ANGLE; expected one of COORD3D, COORD3D",
        ),
        (
            distributed(lines="1., 0., 0., 0., 1., 0.\n3, D"),
            r"17: \*ORIENTATION: distribution D has COORD3D, COORD3D; expected one of ANGLE",
        ),
        (
            distributed("LENGTH"),
            r"11: \*DISTRIBUTION TABLE: LENGTH is not supported \(supported: COORD3D, COORD3D; ANGLE\)",
        ),
        (distributed().replace("TABLE=T", "TABLE=S"), "13: unknown distribution table S"),
        (distributed(data="11, 1., 0., 0., 0., 1., 0."), r"14: \*DISTRIBUTION: the first data line has the default"),
        (distributed(data="** none"), r"13: \*DISTRIBUTION: the first data line has the default values, after a blank"),
        (distributed(data=", 1., 0., 0., 0., 1., 0.\n13, 1."), "15: element 13 is not defined"),
        (distributed(data=", 1., 0., 0., 0., 1., 0.\nSOME, 1."), "15: .*SOME"),
        (distributed(data=", 1., 0., 0., 0., 1., 0., 3."), r"14: \*DISTRIBUTION: 8 entries, expected at most 7"),
        (distributed(data=", 1., A"), r"14: \*DISTRIBUTION: value: 'A' is not a number"),
        (distributed().replace("LOCATION=ELEMENT", "LOCATION=NODE"), "13: .*LOCATION=NODE is not supported"),
        (
            f"{ORIENTATION}, SYSTEM=CYLINDRICAL\n1., 0., 0., 1.",
            "12: .*the points a and b, which give the polar",
        ),
        (f"{ORIENTATION}\n1., 0., 0., 2.", r"12: \*ORIENTATION: the points a, b and c are collinear"),
        (f"{ORIENTATION}, DEFINITION=NODES\n1, 7, 2", "12: node 7 is not defined"),
        (f"{ORIENTATION}, DEFINITION=NODES\n1", r"12: \*ORIENTATION: node is missing"),
        (
            f"{ORIENTATION}, DEFINITION=OFFSET TO NODES\n2, 0",
            "12: .*local node number 0 must be positive",
        ),
        (f"{ORIENTATION}\n1., 0., 0., 0., 1., 0.\n4, 0.", r"13: \*ORIENTATION: axis 4 is not 1, 2 or 3"),
        (f"{ORIENTATION}\n1., 0., 0., 0., 1., 0.\n3, E", "13: unknown distribution E"),
        (f"{ORIENTATION}, DISPERSION=0.1\n1., 0., 0., 0., 1., 0.", "11: .*DISPERSION is not supported"),
    ],
)
def test_errors(read: Read, lines: str, message: str) -> None:
    with pytest.raises(DeckError, match=rf"(?m)^deck\.inp:{message}"):
        read(flat(lines))
