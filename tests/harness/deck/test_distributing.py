# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*DISTRIBUTING: the average motion, tributary areas, and cubes that a reference node pulls and turns."""

import numpy as np
import pytest

from uel.deck.constraints.distributing import METHODS, average_motion
from uel.deck.mesh.surfaces import tributary_areas
from uel.errors import DeckError
from uel.model.element_types import HEX8, HEX20, QUAD4, TET10

RIGID = np.array([0.3, -0.2, 0.5]), np.array([1e-3, -2e-3, 3e-3])


def moved(places, about):
    """Displacements of a rigid body."""
    displacement, rotation = RIGID
    return displacement + np.cross(rotation, places - about)


@pytest.mark.parametrize("seed", range(3))
def test_rigid_body_takes_its_reference_node_along(seed):
    rng = np.random.default_rng(seed)
    places, weights, reference = rng.normal(size=(7, 3)), rng.uniform(0.1, 1.0, 7), rng.normal(size=3)
    motion = average_motion(places, weights, reference)
    u = moved(places, reference)
    assert np.einsum("inj,nj->i", motion.displacement, u) == pytest.approx(RIGID[0])
    assert np.einsum("inj,nj->i", motion.rotation, u) == pytest.approx(RIGID[1])
    assert motion.axes == 3


def test_forces_are_in_balance_with_those_of_the_reference_node():
    """The coefficients of a displacement are the forces of the nodes under a unit force there."""
    rng = np.random.default_rng(4)
    places, reference = rng.normal(size=(5, 3)), np.array([2.0, 0.0, -1.0])
    motion = average_motion(places, np.ones(5), reference)
    for unit, (forces, moments) in enumerate(zip(motion.displacement, motion.rotation, strict=True)):
        axis = np.eye(3)[unit]
        assert forces.sum(axis=0) == pytest.approx(axis)
        assert np.cross(places - reference, forces).sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-13)
        assert moments.sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-13)
        assert np.cross(places - reference, moments).sum(axis=0) == pytest.approx(axis)


@pytest.mark.parametrize(
    ("places", "axes"),
    [([[1e3, 2.0, 3.0], [1e3, 2.0, 4.0], [1e3, 2.0, 6.0]], 2), ([[1e3, 2.0, 3.0]] * 3, 0)],
    ids=["line", "point"],
)
def test_nodes_without_inertia(places, axes):
    motion = average_motion(np.array(places), np.ones(3), np.array([1e3, 2.0, 3.0]))
    assert motion.axes == axes
    assert motion.rotation[2] == pytest.approx(np.zeros((3, 3)), abs=1e-12)


@pytest.mark.parametrize(("method", "half"), [("UNIFORM", 1.0), ("LINEAR", 0.5), ("QUADRATIC", 0.75), ("CUBIC", 0.5)])
def test_methods(method, half):
    """Abaqus Analysis User's Guide, Coupling constraints: 1, 1 - s, 1 - s^2, 1 - 3 s^2 + 2 s^3."""
    assert METHODS[method](np.array([0.0, 0.5])).tolist() == [1.0, half]


@pytest.mark.parametrize(
    ("family", "expected"),
    [
        (HEX8, [0.25] * 4),
        (HEX20, [1 / 16] * 4 + [3 / 16] * 4),
        (QUAD4, [0.5] * 2),
        (TET10, [1 / 24] * 3 + [1 / 8] * 3),
    ],
    ids=["brick", "quadratic brick", "quad", "quadratic tetrahedron"],
)
def test_tributary_areas(family, expected):
    face = family.faces[0]
    corners = np.array([[0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [1.0, 1.0, 2.0], [0.0, 1.0, 2.0]])
    kind = family.face_family(face)
    places = np.concatenate([corners[: kind.corners], np.full((len(face) - kind.corners, 3), np.nan)])
    assert tributary_areas(kind, places) == pytest.approx(expected)


def test_tributary_areas_of_a_trapezium():
    """Parallel sides 2 and 1, height 1: the nodes of the longer side have 5/12 each, by the integral of 1 - y."""
    places = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    areas = tributary_areas(HEX8.face_family(HEX8.faces[0]), places)
    assert areas[:2].sum() == pytest.approx(5 / 6)
    assert areas.sum() == pytest.approx(1.5)


CUBE = """*NODE, NSET=ALL
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
9, 0.5, 0.5, 1.5
*ELEMENT, TYPE=C3D8, ELSET=E
1, 1, 2, 3, 4, 5, 6, 7, 8
*SOLID SECTION, ELSET=E, MATERIAL=M
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*SURFACE, NAME=TOP
E, S2
*COUPLING, CONSTRAINT NAME=C, REF NODE=9, SURFACE=TOP
*DISTRIBUTING
{rotations}
*BOUNDARY
1, 1, 3
2, 1, 3
3, 1, 3
4, 1, 3
*STEP
*STATIC
1., 1.
{load}
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=ALL
U, RF
*END STEP
"""


@pytest.fixture
def values_at_end(run_deck):
    """Values at the end: a function of the variable and the node, None where there is none."""

    def values_at_end(load, rotations="", changes=()):
        deck = CUBE.format(load=load, rotations=rotations)
        for old, new in changes:
            assert old in deck
            deck = deck.replace(old, new)
        history = run_deck(deck).history
        last = {(name.split("[")[0], int(name[-2])): float(history[name][-1]) for name in history if name.endswith("]")}
        return lambda name, node: last.get((name, node))

    return values_at_end


@pytest.mark.parametrize(
    "load", ["*CLOAD\n9, 3, 10.", "*BOUNDARY\n9, 3, 3, 0.01"], ids=["force", "prescribed displacement"]
)
def test_reference_node_pulls_a_cube(values_at_end, load):
    """Without Poisson's ratio a bar: u = F L/(E A); the reference node, whose dofs come first, may be prescribed."""
    value = values_at_end(load)
    for node in (5, 6, 7, 8, 9):
        assert value("U3", node) == pytest.approx(0.01)
    assert sum(value("RF3", node) for node in (1, 2, 3, 4)) == pytest.approx(-10.0)
    if "BOUNDARY" in load:
        assert value("RF3", 9) == pytest.approx(10.0)


def test_all_dofs_of_the_reference_node_prescribed(values_at_end):
    """The top moves as it says on average, and its reactions are those of the bottom about the reference node."""
    given = dict(zip((1, 2, 3, 4, 5, 6), (1e-3, -2e-3, 3e-3, 1e-3, 2e-3, -1e-3), strict=True))
    value = values_at_end("*BOUNDARY\n" + "\n".join(f"9, {dof}, {dof}, {given[dof]}" for dof in given))
    top = np.array([[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1.0]])
    u = np.array([[value(f"U{k}", node) for k in (1, 2, 3)] for node in (5, 6, 7, 8)])
    reference = np.array([0.5, 0.5, 1.5])
    motion = average_motion(top, np.ones(4), reference)
    assert np.einsum("inj,nj->i", motion.displacement, u) == pytest.approx([given[k] for k in (1, 2, 3)])
    assert np.einsum("inj,nj->i", motion.rotation, u) == pytest.approx([given[k] for k in (4, 5, 6)])
    forces = np.array([[value(f"RF{k}", node) for k in (1, 2, 3)] for node in (1, 2, 3, 4, 9)])
    assert forces.sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-9)
    bottom = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    moment = np.cross(bottom - reference, forces[:4]).sum(axis=0) + [value(f"RM{k}", 9) for k in (1, 2, 3)]
    assert moment == pytest.approx(np.zeros(3), abs=1e-9)


def test_released_rotation_leaves_the_displacements_coupled(values_at_end):
    """Dof 4 alone: the others of the reference node's rotations do not exist, and its displacements are averages."""
    value = values_at_end("*CLOAD\n9, 3, 10.", rotations="4")
    assert value("U3", 9) == pytest.approx(0.01)
    assert value("UR1", 9) is not None
    assert value("UR2", 9) is None


def test_nodes_on_a_line_are_warned_of(values_at_end, tmp_path):
    values_at_end("*CLOAD\n9, 3, 10.", changes=[("*SURFACE, NAME=TOP\nE, S2", "*SURFACE, NAME=TOP, TYPE=NODE\n5\n6")])
    message = "*DISTRIBUTING: its nodes lie on a line, about which no moment is passed on"
    assert message in " ".join((tmp_path / "deck.dat").read_text().split())


def test_radius_of_influence(values_at_end, tmp_path):
    """The reference node stands above a corner, and the next ones are too far away: the corner carries all."""
    changes = [("9, 0.5, 0.5, 1.5", "9, 0., 0., 1.5"), ("SURFACE=TOP\n", "SURFACE=TOP, INFLUENCE RADIUS=0.6\n")]
    value = values_at_end("*CLOAD\n9, 1, 10.", changes=changes)
    assert value("U1", 9) == pytest.approx(value("U1", 5))
    assert value("U1", 9) > value("U1", 7) > 0.0
    message = "*DISTRIBUTING: all its nodes are in one place, about which no moment is passed on"
    assert message in " ".join((tmp_path / "deck.dat").read_text().split())


def test_axisymmetric_elements_are_refused(run_deck):
    deck = "*NODE\n1, 1., 0.\n2, 2., 0.\n3, 2., 1.\n4, 1., 1.\n9, 1., 2.\n*ELEMENT, TYPE=CAX4, ELSET=E\n1, 1, 2, 3, 4\n"
    deck += "*SOLID SECTION, ELSET=E, MATERIAL=M\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n*SURFACE, NAME=TOP\nE, S3\n"
    deck += "*COUPLING, CONSTRAINT NAME=C, REF NODE=9, SURFACE=TOP\n*DISTRIBUTING\n*STEP\n*STATIC\n1., 1.\n*END STEP\n"
    with pytest.raises(DeckError, match=r"deck.inp:16: \*DISTRIBUTING: is not supported for axisymmetric elements"):
        run_deck(deck)
