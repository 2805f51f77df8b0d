# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Sets, generated nodes and elements, and element sections."""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from uel.errors import DeckError
from uel.model.model import Model
from uel.model.properties import UserProperty

Read = Callable[[str], Model]
FLAT = Path(__file__).with_name("flat.inp").read_text()
CAE = Path(__file__).with_name("cae.inp").read_text()
END = """\
*SOLID SECTION, ELSET=EALL, MATERIAL=M
*MATERIAL, NAME=M
*ELASTIC
1000.
*STEP
*STATIC
*END STEP
"""


def test_generated_mesh(read: Read) -> None:
    """A 4 x 2 mesh from six keywords; node 11 + 100 j + i at (i / 2, j)."""
    model = read(f"""\
*NODE
11, 0., 0.
15, 2., 0.
211, 0., 2.
215, 2., 2.
*NGEN, NSET=BOTTOM
11, 15
*NGEN, NSET=TOP
211, 215, 1
*NFILL, NSET=ALL
BOTTOM, TOP, 2, 100
*ELEMENT, TYPE=CPE4
1, 11, 12, 112, 111
*ELGEN, ELSET=EALL
1, 4, 1, 1, 2, 100, 10
{END}""")
    assert_array_equal(model.mesh.labels, [*range(11, 16), *range(111, 116), *range(211, 216)])
    x, y = np.meshgrid(np.arange(5) / 2, np.arange(3.0))
    assert_allclose(model.mesh.coordinates, np.stack([x, y, 0 * x], axis=2).reshape(-1, 3))
    assert_array_equal(model.nsets["ALL"], range(15))
    (group,) = model.groups
    assert_array_equal(group.labels, [1, 2, 3, 4, 11, 12, 13, 14])
    assert_array_equal(group.nodes[-1], [8, 9, 14, 13])
    assert_array_equal(model.elsets["EALL"], range(8))


def test_system(read: Read) -> None:
    """Origin (1, 2, 0), local x along global y, local y along -x; a second *SYSTEM without data ends it."""
    nodes = "*SYSTEM\n1., 2., 0., 1., 3., 0.\n0., 2., 0.\n*NODE\n1, 0., 0., 5.\n2, 3., 1.\n"
    nodes += (
        "*SYSTEM\n1., 1.\n*NODE\n3, 1., 2.\n*SYSTEM\n*NODE\n4, 0., 9.\n*ELEMENT, TYPE=CPE4, ELSET=EALL\n1, 1, 2, 3, 4\n"
    )
    model = read(nodes + END)
    assert_allclose(model.mesh.coordinates, [[1, 2, 5], [0, 5, 0], [2, 3, 0], [0, 9, 0]], atol=1e-12)


def test_properties_left_out_at_the_end_of_a_line_are_zero(read: Read) -> None:
    model = read(FLAT.replace("<half>, 1.E6, 1.D-3, 3, -4\n", "<half>, 1.E6\n"))
    section = next(group.section for group in model.groups if group.type == "U2")
    assert isinstance(section, UserProperty)
    assert_array_equal(section.values, [10.0, 1e6, 0.0])
    assert_array_equal(section.integers, [0, 0])
    assert any("2 values where U2 takes 5" in warning and "are zero" in warning for warning in model.warnings)


def test_properties_beyond_those_of_the_type_are_left_out(read: Read) -> None:
    model = read(FLAT.replace("3, -4\n", "3, -4, 5\n"))
    section = next(group.section for group in model.groups if group.type == "U2")
    assert isinstance(section, UserProperty)
    assert_array_equal(section.integers, [3, -4])
    assert any("6 values where U2 takes 5" in warning and "not passed to it" in warning for warning in model.warnings)


def test_a_line_has_eight_properties(read: Read) -> None:
    """The manual's form of the data lines: what a line leaves out is zero, and the next line begins with the ninth."""
    text = FLAT.replace("Properties=3, I Properties=2", "Properties=9, I Properties=2")
    assert text != FLAT
    model = read(text.replace("<half>, 1.E6, 1.D-3, 3, -4\n", "<half>, 1.E6, 1.D-3,\n5., 3, -4\n"))
    section = next(group.section for group in model.groups if group.type == "U2")
    assert isinstance(section, UserProperty)
    assert_array_equal(section.values, [10.0, 1e6, 1e-3, 0, 0, 0, 0, 0, 5.0])
    assert_array_equal(section.integers, [3, -4])
    (warning,) = (warning for warning in model.warnings if "eight" in warning)
    assert re.search(r"deck.inp:36: \*UEL PROPERTY: a line has eight values; .* values 4 to 8, are zero$", warning)


def test_more_than_eight_properties_in_a_line(read: Read) -> None:
    text = FLAT.replace("Properties=3, I Properties=2", "Properties=7, I Properties=2")
    model = read(text.replace("1.D-3, 3, -4\n", "1.D-3, 4., 5., 6., 7., 3, -4\n"))
    section = next(group.section for group in model.groups if group.type == "U2")
    assert isinstance(section, UserProperty)
    assert_array_equal(section.values, [10.0, 1e6, 1e-3, 4, 5, 6, 7])
    assert any("all 9 of this one are used" in warning for warning in model.warnings)


def test_properties_one_to_a_line(read: Read) -> None:
    """The second line begins with the ninth property, which the element does not have."""
    with pytest.raises(DeckError, match=r"33 values where U2 takes 5 \(.*\); a line has eight values"):
        read(FLAT.replace("<half>, 1.E6, 1.D-3, 3, -4\n", "<half>\n1.E6\n1.D-3\n3\n-4\n"))


def test_comment_at_the_end_of_data_lines(read: Read) -> None:
    """What follows ** is left out, with one warning; in an expression of *PARAMETER it is a power."""
    plain = read(FLAT)
    text = FLAT.replace("half = width/2", "half = width **2/40")
    text = text.replace("3, -4\n", "3, -4,   **layers, angle\n").replace("1, 2, 3, 4\n", "1, 2, 3, 4 **first\n")
    model = read(text)
    for group, other in zip(model.groups, plain.groups, strict=True):
        assert_array_equal(group.nodes, other.nodes)
        assert isinstance(group.section, UserProperty) and isinstance(other.section, UserProperty)
        assert_array_equal(group.section.values, other.section.values)
        assert_array_equal(group.section.integers, other.section.integers)
    assert sum("counts as a comment" in warning for warning in model.warnings) == 1
    assert len(model.warnings) == len(plain.warnings) + 1


def test_ncopy(read: Read) -> None:
    """The translation comes before the rotation, here by 90 degrees about z."""
    text = "*NODE, NSET=OLD\n1, 1., 0.\n2, 2., 0.\n3, 2., 1.\n"
    text += "*NCOPY, CHANGE NUMBER=10, OLD SET=OLD, NEW SET=NEW, SHIFT\n1., 0., 0.\n0., 0., 0., 0., 0., 1., 90.\n"
    model = read(text + f"*ELEMENT, TYPE=CPS3, ELSET=EALL\n1, 1, 2, 3\n{END}")
    assert_allclose(model.mesh.coordinates[3:], [[0, 2, 0], [0, 3, 0], [-1, 3, 0]], atol=1e-15)
    assert_array_equal(model.nsets["NEW"], [3, 4, 5])


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("*NGEN\n11, 15, 3\n", r"deck.inp:8: \*NGEN: the increment 3 does not lead from node 11 to node 15"),
        ("*NGEN\n11, 16\n", r"deck.inp:8: node 16 is not defined"),
        ("*NFILL\nA, B, 0\n", r"deck.inp:8: \*NFILL: 0 intervals cannot be filled"),
        ("*NFILL, BIAS=2.\nA, B, 2\n", r"deck.inp:7: \*NFILL: option BIAS is not supported"),
        ("*NFILL\nA, C, 2\n", r"deck.inp:8: unknown node set C"),
        ("*NFILL\nA, B, 2, 2000000000\n", r"deck.inp:8: \*NFILL: generates node numbers outside 1 to"),
        ("*NSET, NSET=C\n11, 15\n*NFILL\nA, C, 2\n", r"deck.inp:10: \*NFILL: the sets hold 1 and 2 nodes"),
        ("*ELGEN\n7, 2\n", r"deck.inp:8: element 7 is not defined"),
        ("*ELGEN\n1, 0\n", r"deck.inp:8: \*ELGEN: 0 elements in one direction cannot be generated"),
        ("*ELGEN\n1, 3, 1, -1\n", r"deck.inp:8: \*ELGEN: generates element or node numbers outside 1 to"),
        (
            "*NSET, NSET=C, GENERATE\n1, 2000000000, 1\n",
            r"deck.inp:8: \*NSET: 2000000000 numbers are too many: at most 10000000 can be generated in total",
        ),
        ("*NSET, NSET=C, GENERATE\n1, 6000000\n1, 6000000\n", r"deck.inp:9: \*NSET: 6000000 numbers are too many"),
        (
            "*NODE\n2000011, 9.\n*NGEN\n11, 2000011\n",
            r"deck.inp:10: \*NGEN: 2000000 nodes are too many: at most 1000000 can be",
        ),
        ("*NFILL\nA, B, 2000000\n", r"deck.inp:8: \*NFILL: 1999999 nodes are too many: at most 1000000 can be"),
        ("*ELGEN\n1, 2000001\n", r"deck.inp:8: \*ELGEN: 2000000 elements are too many: at most 1000000 can be"),
        ("*NCOPY, OLD SET=A, CHANGE NUMBER=5\n", r"deck.inp:7: \*NCOPY needs the option SHIFT"),
    ],
)
def test_what_cannot_be_generated(read: Read, lines: str, message: str) -> None:
    text = "*NODE, NSET=A\n11, 0., 0.\n*NODE, NSET=B\n15, 2., 0.\n"
    text += "*ELEMENT, TYPE=CPS3, ELSET=EALL\n1, 11, 15, 11\n"
    with pytest.raises(DeckError, match=message):
        read(text + lines + END)


def test_set_of_sets_and_of_elements(read: Read) -> None:
    sets = "*NSET, NSET=BOTH\nBOTTOM, top, 3\n*NSET, NSET=CRACK, ELSET=INTERFACE\n*ELSET, ELSET=ALL\nBULK, 101\n"
    model = read(FLAT.replace("*MATERIAL", sets + "*MATERIAL"))
    assert_array_equal(model.nsets["BOTH"], [0, 1, 2, 6, 7])
    assert_array_equal(model.nsets["CRACK"], [2, 3, 4, 5])
    assert_array_equal(model.elsets["ALL"], [0, 1, 2])


def test_set_is_extended(read: Read) -> None:
    model = read(FLAT.replace("*MATERIAL", "*NSET, NSET=TOP\n1, 7\n*MATERIAL"))
    assert_array_equal(model.nsets["TOP"], [0, 6, 7])


def test_unsorted_set_keeps_its_order(read: Read) -> None:
    """The order counts where an equation pairs the nodes of two sets."""
    sets = "*NSET, NSET=A, UNSORTED\n3, 1, 3\n*EQUATION\n2\nA, 1, 1., TOP, 1, -1.\n"
    model = read(FLAT.replace("*MATERIAL", sets + "*MATERIAL"))
    assert_array_equal(model.nsets["A"], [2, 0])
    assert [equation.terms for equation in model.equations] == [
        ((2, 1, 1.0), (6, 1, -1.0)),
        ((0, 1, 1.0), (7, 1, -1.0)),
    ]


def test_unsorted_set_is_generated_downwards(read: Read) -> None:
    """Public decks of Abaqus pair such sets with others in multi-point constraints."""
    model = read(FLAT.replace("*MATERIAL", "*NSET, NSET=A, UNSORTED, GENERATE\n7, 1, -3\n2, 2, -1\n*MATERIAL"))
    assert_array_equal(model.nsets["A"], [6, 3, 0, 1])


def test_members_that_do_not_exist_are_warned_of(read: Read) -> None:
    model = read(FLAT.replace("7, 8,\n", "7, 8, 98, 99\n"))
    assert_array_equal(model.nsets["TOP"], [6, 7])
    assert model.warnings == ("deck.inp:27: set TOP: node 98 and 1 more does not exist and is left out",)


def test_part_without_instance_is_warned_of(read: Read) -> None:
    model = read(CAE.replace("*Assembly,", "*Part, name=Spare\n*Node\n1, 0., 0.\n*End Part\n*Assembly,"))
    assert model.warnings == ("deck.inp:32: part SPARE has no instance and is left out",)


def test_mesh_within_an_instance(read: Read) -> None:
    """Abaqus/CAE writes independent instances like this: an empty part, the mesh in the instance."""
    start, end = CAE.index("*Node\n"), CAE.index("*End Part")
    mesh = CAE[start:end]
    text = CAE.replace(mesh, "").replace("part=Plate\n*End Instance", "part=Plate\n" + mesh + "*End Instance", 1)
    text = text.replace("90.\n*End Instance", "90.\n" + mesh + "*End Instance")
    assert_allclose(read(text).mesh.coordinates, read(CAE).mesh.coordinates)


def test_references_through_the_assembly(read: Read) -> None:
    text = CAE.replace("Plate-1.Set-1, ENCASTRE", "Assembly.Plate-1.Set-1, ENCASTRE\nAssembly.Set-1, 2")
    model = read(text)
    assert [entry.nodes.tolist() for entry in model.boundaries] == [[0], [0], [0, 3, 5]]


def test_same_node_in_the_same_place_twice(read: Read) -> None:
    assert len(read(FLAT.replace("*MATERIAL", "*NODE\n3, 1., 1.\n*MATERIAL")).mesh.labels) == 8


def test_equation_in_a_rotated_instance(read: Read) -> None:
    text = CAE.replace("*End Part", "*Equation\n2\n1, 1, 1., 2, 1, -1.\n*End Part")
    with pytest.raises(
        DeckError, match=r"deck.inp:28: \*EQUATION: is not supported in an instance that is rotated \(PLATE-2"
    ):
        read(text)
    assert read(text.replace(",          90.", ", 0.")).equations[0].terms == ((0, 1, 1.0), (1, 1, -1.0))


def test_dof_lines_of_user_elements(read: Read) -> None:
    """`position, dofs` from that position on; a repeated position is another pass over the nodes."""

    def dofs(lines: str) -> list[tuple[int, int]]:
        model = read(FLAT.replace("Unsymm\n1, 2\n", f"Unsymm\n{lines}\n"))
        definition = model.groups[1].definition
        assert definition is not None
        return [(node + 1, dof) for node, dof in definition.dofs]

    assert dofs("1, 2\n3, 11") == [(1, 1), (1, 2), (2, 1), (2, 2), (3, 11), (4, 11)]
    assert dofs("1, 2\n3,") == [(1, 1), (1, 2), (2, 1), (2, 2)]
    assert dofs("1\n1, 2") == [(1, 1), (2, 1), (3, 1), (4, 1), (1, 2), (2, 2), (3, 2), (4, 2)]
    assert dofs("1\n3, 2\n1, 11\n2,") == [(1, 1), (2, 1), (3, 2), (4, 2), (1, 11)]


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("1, 31", r"deck.inp:10: \*USER ELEMENT: a dof is a number from 1 to 30"),
        ("1, 2\n5, 1", r"deck.inp:11: \*USER ELEMENT: node position 5 of an element of 4 nodes"),
        ("1, 2\n1, 2", r"deck.inp:9: \*USER ELEMENT: dof 2 is listed twice at node 1"),
        ("** nothing", r"deck.inp:9: \*USER ELEMENT: needs a data line with the dofs at the first node"),
        ("x", r"deck.inp:10: \*USER ELEMENT: dof: 'x' is not an integer"),
    ],
)
def test_wrong_dof_lines(read: Read, lines: str, message: str) -> None:
    with pytest.raises(DeckError, match=message):
        read(FLAT.replace("Unsymm\n1, 2\n", f"Unsymm\n{lines}\n"))


def test_long_properties(read: Read) -> None:
    """Reals first, integers right after them, eight values a line; an empty entry is zero."""
    text = FLAT.replace("Properties=3, I Properties=2", "Properties=10, I Properties=3")
    text = text.replace("<half>, 1.E6, 1.D-3, 3, -4\n", "1,2,3,4,5,6,7,8\n9., , 11, 12, 13\n")
    section = read(text).groups[1].section
    assert_array_equal(section.values, [1, 2, 3, 4, 5, 6, 7, 8, 9, 0])  # type: ignore[union-attr]
    assert_array_equal(section.integers, [11, 12, 13])  # type: ignore[union-attr]


REDEFINED = """\
*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
5, 2., 0.
6, 2., 1.
{nodes}*ELEMENT, TYPE=CPS4, ELSET=EALL
1, 1, 2, 3, 4
2, 2, 5, 6, 3
{elements}"""


def test_the_last_definition_counts(read: Read) -> None:
    """Node 6 elsewhere, element 2 as a triangle, then with its nodes in another order: the last one."""
    again = "*ELEMENT, TYPE=CPS3, ELSET=EALL\n2, 2, 5, 6\n3, 2, 6, 3\n*ELEMENT, TYPE=CPS3, ELSET=EALL\n2, 5, 6, 2\n"
    model = read(REDEFINED.format(nodes="*NODE\n6, 2., 1.5\n", elements=again) + END)
    assert_allclose(model.mesh.coordinates[5], [2, 1.5, 0])
    quads, triangles = sorted(model.groups, key=lambda group: group.type, reverse=True)
    assert_array_equal(quads.labels, [1])
    assert dict(zip(triangles.labels.tolist(), triangles.nodes.tolist(), strict=True)) == {2: [4, 5, 1], 3: [1, 5, 2]}
    assert [warning.partition(".inp")[2] for warning in model.warnings] == [
        ":9: node 6 is defined again, with other coordinates; this definition counts",
        ":14: element 2 is defined again, differently; this definition counts",
        ":17: element 2 is defined again, differently; this definition counts",
    ]


def test_the_same_twice_is_said_by_nobody(read: Read) -> None:
    model = read(REDEFINED.format(nodes="*NODE\n6, 2., 1.\n", elements="2, 2, 5, 6, 3\n") + END)
    (quads,) = model.groups
    assert_array_equal(quads.labels, [1, 2])
    assert not model.warnings
