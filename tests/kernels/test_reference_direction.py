# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""DIRECTION1 to 3: the direction whose projection on the face is s, from which the angles of the plies are measured."""

import numpy as np
import pytest
from neighbours import Sandwich
from scipy.spatial.transform import Rotation
from solid_pairs import OWNING, geometry
from space import faces, frames, nodes_of, opened, points_of, stress_of

from uel.errors import KernelError
from uel.usersub.layout import element_layouts

OBLIQUE = (-0.7, 2.1, 0.4)
ANGLES = {"ANGLE BOTTOM": 30.0, "ANGLE TOP": -55.0}
RIGID = {"ALPHAN": 0.0, "ALPHAT": 0.0, "CLOSURE": 3, "BETAN": -1.0, "BETAT": -1.0}
STRONG = {"SIGMAMAX": 1e4, "TAUMAX": 1e4, "GIC": 1e3, "GIIC": 1e3}
IN_SPACE = [jtype for jtype in OWNING if element_layouts()[jtype].dimension == 3]
TURN = Rotation.from_rotvec(np.deg2rad(130.0) * np.array([0.6, -0.48, 0.64])).as_matrix()
SMALL, NLGEOM = (1, 0, 0, 0), (1, 1, 0, 0)


def directed(direction):
    """The properties of a direction."""
    return {f"DIRECTION{k}": float(value) for k, value in enumerate(direction, 1)}


def vectors(state, name):
    """(points, 3) components (s, n, t) of SEP, T or W."""
    return np.stack([state[f"{name}{i}"] for i in "SNT"], axis=-1)


@pytest.mark.parametrize("surface", ["sloping", "warped"])
@pytest.mark.parametrize("jtype", [8, 12])
def test_s_is_the_projection_of_the_direction(element, jtype, surface):
    coordinates = nodes_of(jtype, surface)
    item = element(jtype, coordinates, **directed(OBLIQUE))
    gap = np.array([1e-4, 2e-4, 3e-4])
    item.advance(opened(jtype, gap, 0))
    expected = frames(coordinates, jtype, points_of(jtype, 0), OBLIQUE) @ gap
    np.testing.assert_allclose(vectors(item.state, "SEP"), expected, rtol=1e-12)


@pytest.mark.parametrize("angle", [0.0, 35.0])
@pytest.mark.parametrize("jtype", [8, 12])
def test_angles_of_plies_are_from_the_direction(element, jtype, angle):
    """A rigid interface between like plies has the traction of their stress, by a ply law in numpy."""
    coordinates = nodes_of(jtype, "warped")
    angles = {"ANGLE BOTTOM": angle, "ANGLE TOP": angle}
    item = element(jtype, coordinates, **{**RIGID, **STRONG, **angles, **directed(OBLIQUE)})
    gradient = 1e-3 * np.random.default_rng(2).normal(size=(3, 3))
    item.advance(coordinates @ gradient.T)
    stress = stress_of(gradient, coordinates, jtype, angle, OBLIQUE)
    rows = frames(coordinates, jtype, points_of(jtype, 0), OBLIQUE)
    expected = np.einsum("pid,de,pe->pi", rows, stress, rows[:, 1])
    np.testing.assert_allclose(vectors(item.state, "T"), expected, rtol=1e-9, atol=1e-9 * abs(expected).max())


@pytest.mark.parametrize("flags", [SMALL, NLGEOM], ids=["small", "nlgeom"])
@pytest.mark.parametrize("jtype", IN_SPACE)
def test_a_model_turned_with_its_direction(element, jtype, flags):
    """Forces turn along; all that is measured in the frame of the face stays, between unlike plies too.

    Without a direction s would be that of another x.
    """
    rng = np.random.default_rng(jtype)
    nodes = geometry(jtype, rng, curved=0.03)
    layout = element_layouts()[jtype]
    bottom, top = (list(face) for face in layout.faces)
    values = {**ANGLES, "CLOSURE": 3, "ALPHAN": 0.0, "ALPHAT": 0.0, "BETAN": -1.0, "BETAT": -1.0, "FRICTION": 0.3}
    # along an edge, which is never along the normal
    direction = nodes[bottom[1]] - nodes[bottom[0]] + 0.3 * (nodes[bottom[2]] - nodes[bottom[0]])
    still = element(jtype, nodes, **{**values, **directed(direction)})
    turned = element(jtype, nodes @ TURN.T, **{**values, **directed(TURN @ direction)})
    for size in (1e-3, 6e-3, 2e-3, 2e-2):
        u = 2e-5 * rng.normal(size=nodes.shape)
        u[layout.solids[0] :] += size * np.array([0.6, -0.3, 0.8])
        u[top] = u[bottom] + size * np.array([0.6, -0.3, 0.8])
        force = still.advance(u, flags=flags)[0].reshape(-1, 3)
        found = turned.advance(u @ TURN.T, flags=flags)[0].reshape(-1, 3)
        np.testing.assert_allclose(found, force @ TURN.T, atol=1e-8 * abs(force).max())
    assert still.state["DAMAGE"].max() > 0.1
    for name in still.state.keys() - set("XYZ"):
        scale = abs(still.state[name]).max()
        np.testing.assert_allclose(turned.state[name], still.state[name], rtol=1e-8, atol=1e-8 * scale, err_msg=name)


@pytest.mark.parametrize("flags", [SMALL, NLGEOM], ids=["small", "nlgeom"])
@pytest.mark.parametrize("formulation", [0, 1, 2])
def test_a_brick_turned_with_its_direction(element, formulation, flags):
    nodes = nodes_of(8, "warped")[:8]
    direction = np.array([0.3, 1.0, -0.2])
    values = {"FORMULATION": formulation, "ANGLE": 25.0}
    still = element(9, nodes, **values, **directed(direction))
    turned = element(9, nodes @ TURN.T, **values, **directed(TURN @ direction))
    u = 1e-3 * np.random.default_rng(4).normal(size=(8, 3))
    force = still.advance(u, flags=flags)[0].reshape(-1, 3)
    found = turned.advance(u @ TURN.T, flags=flags)[0].reshape(-1, 3)
    np.testing.assert_allclose(found, force @ TURN.T, atol=1e-10 * abs(force).max())
    for name in still.state:
        np.testing.assert_allclose(turned.state[name], still.state[name], atol=1e-10 * abs(still.state[name]).max())


def test_bricks_and_the_interface_that_takes_their_stress(element):
    """U10 beside U9 of one direction has the tractions of U8 of that direction.

    Between parallel faces, for the normal of U9 is half-way between them.
    """
    face = faces("sloping")
    nodes = np.vstack([face - [0.1, 0.0, 0.8], face, face, face + np.array([0.0, 0.1, 0.9])])
    u = opened(8, (2e-4, 3e-4, -2e-4), 3, 1e-5)
    given = {**directed(OBLIQUE), "CLOSURE": 2, "BETAN": 2e5, "BETAT": 1e5, "GAMMABOT": 0.5}
    owning = element(8, nodes, **given, **{"ANGLE BOTTOM": 30.0, "ANGLE TOP": 30.0})
    taking = Sandwich(element, 10, nodes, solids={"ANGLE": 30.0, **directed(OBLIQUE)}, **given)
    owning.advance(u)
    taking.advance(u)
    for name in ("SEP", "T"):
        found, expected = vectors(taking.state, name), vectors(owning.state, name)
        np.testing.assert_allclose(found, expected, rtol=1e-10, atol=1e-10 * abs(expected).max())


@pytest.mark.parametrize("jtype", [8, 12])
def test_tangent_with_large_rotations(element, reference, jtype):
    """AMATRX is the derivative of RHS; differences have an error of 1e-8."""
    rng = np.random.default_rng(6)
    nodes = nodes_of(jtype, "warped")
    item = element(jtype, nodes, **{**RIGID, **ANGLES, **directed(OBLIQUE)})
    moved = [
        (nodes + opened(jtype, gap, 3, 2e-5)) @ TURN.T - nodes for gap in ((1e-3, 2e-3, -1e-3), (4e-3, 5e-3, 3e-3))
    ]
    item.advance(moved[0], flags=NLGEOM)
    along = rng.normal(size=(6, nodes.size)) / np.sqrt(nodes.size)
    tangent = item.evaluate(moved[1], flags=NLGEOM)[1]
    differences = -reference.central_differences(
        lambda x: item.evaluate(moved[1].ravel() + x @ along, flags=NLGEOM)[0], np.zeros(len(along)), step=2e-7
    )
    assert abs(tangent @ along.T - differences).max() <= 1e-7 * abs(tangent).max()


@pytest.mark.parametrize("jtype", [8, 12])
def test_without_a_direction_s_is_that_of_x(element, jtype):
    """To the bit, so that no result of a flat laminate changes; the length of a direction does not matter."""
    nodes = nodes_of(jtype, "warped")
    items = [
        element(jtype, nodes, **{**ANGLES, **directed(direction)})
        for direction in ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.125, 0.0, 0.0), (3e-200, 0.0, 0.0))
    ]
    u = opened(jtype, (4e-3, 4e-3, -3e-3), 1, 2e-5)
    expected = items[0].advance(u)
    for item in items[1:]:
        for found, array in zip(item.advance(u), expected, strict=True):
            np.testing.assert_array_equal(found, array)
        assert all((item.state[name] == items[0].state[name]).all() for name in item.state)


def around(degrees, half=4.0, radius=10.0):
    """Nodes of U8 on a cylinder about the z axis; n is at so many degrees from x."""
    corners = [(-1, 0), (1, 0), (1, 1), (-1, 1)]
    faces = [
        [
            (r * np.cos(np.deg2rad(degrees + side * half)), r * np.sin(np.deg2rad(degrees + side * half)), z)
            for side, z in corners
        ]
        for r in (radius - 1.0, radius, radius, radius + 1.0)
    ]
    return np.vstack(faces)


def test_no_jump_where_the_normal_is_near_x(element):
    """Around a cylinder about z, a jump along the axis stays along s if the axis is the direction.

    Without one, s is the tangent on both sides of x, in opposite senses, and the axis next to it.
    """
    expected = {True: [1.0] * 5, False: [0.0, 0.0, 1.0, 0.0, 0.0]}
    for given, shares in expected.items():
        direction = directed((0.0, 0.0, 1.0)) if given else {}
        for degrees, share in zip((-20.0, -5.0, 0.0, 5.0, 20.0), shares, strict=True):
            nodes = around(degrees)
            # the points of a flat face have its normal
            u = np.zeros(nodes.shape)
            u[8:, 2] = 1e-4
            item = element(8, nodes, **direction)
            item.advance(u)
            np.testing.assert_allclose(item.state["SEPS"], share * 1e-4, rtol=1e-12, atol=1e-16)
            np.testing.assert_allclose(abs(item.state["SEPT"]), (1 - share) * 1e-4, rtol=1e-12, atol=1e-16)


@pytest.mark.parametrize("jtype", [8, 9, 10, 12, 404])
def test_a_direction_along_the_normal_is_refused(element, library, jtype):
    """At less than five degrees; without a direction x may be along the normal."""
    library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)
    if jtype == 404:
        nodes = geometry(404, np.random.default_rng(1))
        first, second, third = nodes[list(element_layouts()[404].faces[0])]
        normal = np.cross(second - first, third - first)
        normal /= np.linalg.norm(normal)
        beside = (second - first) / np.linalg.norm(second - first)
    else:
        nodes, normal, beside = nodes_of(8 if jtype in (9, 10) else jtype, "flat", 0.0), np.eye(3)[2], np.eye(3)[0]
        nodes = nodes[:8] if jtype == 9 else nodes

    def evaluate(degrees, sense=1.0):
        c, s = np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))
        given = directed(7.0 * sense * (c * normal + s * beside))
        if jtype == 10:
            Sandwich(element, 10, nodes, **given).evaluate(np.zeros(nodes.shape))
        else:
            element(jtype, nodes, label=42, **given).evaluate(np.zeros(nodes.size))

    place = {9: "2", 10: "17"}.get(jtype, "43")
    label = 400 if jtype == 10 else 42
    for degrees, sense in ((0.5, 1.0), (4.99, 1.0), (4.99, -1.0)):
        message = (
            rf"U{jtype} element {label}: PROPS\({place}\) DIRECTION1 to DIRECTION3: too close to the normal of the "
            rf"face to give a direction in it, {degrees}\d*(E-01)? degrees; expected at least 5\.0\d*, as the axis"
        )
        with pytest.raises(KernelError, match=message):
            evaluate(degrees, sense)
    evaluate(5.01)


def test_a_direction_has_to_be_finite(element):
    for name, position in (("DIRECTION1", 43), ("DIRECTION3", 45)):
        item = element(8, nodes_of(8, "flat"), label=42, **{name: np.inf})
        with pytest.raises(
            KernelError, match=rf"U8 element 42: PROPS\({position}\) {name} = .*: expected a finite value"
        ):
            item.evaluate(np.zeros(item.n))
