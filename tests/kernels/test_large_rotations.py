# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Interfaces with NLGEOM: the frame goes with the mid-surface, tractions are per original area.

U3 and U10 are tested with the quads or bricks whose stress they take.
"""

import numpy as np
import pytest
from lines import BRIDGING, TABLE
from neighbours import Sandwich
from scipy.spatial.transform import Rotation
from space import QUADRATIC, bottom_of, nodes_of, top_of

NLGEOM = (1, 1, 0, 0)
LINE = np.array([[0.1, 0.2], [1.0, 0.5]])
CURVED = np.vstack([LINE, [[0.5, 0.42]]])
SQUARE = np.array([[0.0, 0.0, 0.05], [1.1, -0.1, -0.1], [0.9, 1.1, 0.12], [0.05, 0.9, -0.06]])
QUADS = [[0.2, -0.7], [1.2, -0.4], LINE[1], LINE[0], LINE[0], LINE[1], [0.9, 1.4], [-0.1, 1.2]]
BELOW, ABOVE = SQUARE + np.array([0.05, 0.0, -0.8]), SQUARE + np.array([0.0, -0.1, 0.9])


def with_middles(corners, curved):
    """A quad of eight nodes; `curved`: the corner after which the middle is that of the curved line."""
    middles = (corners + np.roll(corners, -1, axis=0)) / 2
    middles[curved] = CURVED[2]
    return np.vstack([corners, middles])


# nodes, and those of the bottom and of the top face
ELEMENTS = {
    2: (LINE[[0, 1, 1, 0]], [0, 1], [3, 2]),
    5: (CURVED[[0, 1, 1, 0, 2, 2]], [0, 1, 4], [3, 2, 5]),
    7: (np.vstack([SQUARE, SQUARE]), [0, 1, 2, 3], [4, 5, 6, 7]),
    4: (np.array(QUADS), [3, 2], [4, 5]),
    6: (np.vstack([with_middles(np.array(QUADS[:4]), 2), with_middles(np.array(QUADS[4:]), 0)]), [3, 2, 6], [8, 9, 12]),
    8: (np.vstack([BELOW, SQUARE, SQUARE, ABOVE]), [4, 5, 6, 7], [8, 9, 10, 11]),
    11: (nodes_of(11, "warped"), bottom_of(11), top_of(11)),
    12: (nodes_of(12, "warped"), bottom_of(12), top_of(12)),
}
ELEMENTS |= {3: ELEMENTS[4], 10: ELEMENTS[8]}
OPTIONS = {"Gauss": {}, "nodes, viscous": {"INTEGRATION": 1, "VISCOSITY": 0.3}, "BK": {"LAW": 2, "ETA": 1.45}}
OPTIONS |= {"bridging": BRIDGING, "table": TABLE}
RIGID = {"CLOSURE": 1, "ALPHAN": 0.0, "ALPHAT": 0.0, "BETAN": -1.0, "BETAT": -1.0, "FRICTION": 0.3}
REDUCED = {f"FORMULATION {side}": 3 for side in ("BOTTOM", "TOP")}
OF_NEIGHBOURS = {"rigid": RIGID, "rigid, viscous, face": {**RIGID, "VISCOSITY": 0.3, "SAMPLING": 1}}
# U3 and U10 do not have the complete form
OF_SOLIDS = {"complete": {**RIGID, "CLOSURE": 3}, "complete, reduced": {**RIGID, **REDUCED, "CLOSURE": 3}}
GIVEN = {"BETAN": 1e5, "BETAT": 1.2e5}  # U3 and U10 know no local eigenvalues
NAMES = {jtype: OPTIONS if jtype in (2, 5, 7, 11) else OPTIONS | OF_NEIGHBOURS for jtype in ELEMENTS}
CASES = [(jtype, name) for jtype in ELEMENTS for name in NAMES[jtype] | (OF_SOLIDS if jtype in (4, 6, 8, 12) else {})]
OPTIONS |= OF_NEIGHBOURS | OF_SOLIDS
every = pytest.mark.parametrize("jtype", ELEMENTS)
options = pytest.mark.parametrize(("jtype", "name"), CASES)


@pytest.fixture
def interface_element(element, library):
    """Make an interface element, with the solids next to it: interface_element(jtype, name of its options)."""
    library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)

    def make(jtype, name=None):
        values = OPTIONS[name] if name else {}
        if jtype not in (3, 10):
            return element(jtype, ELEMENTS[jtype][0], **values)
        given = GIVEN if "BETAN" in values else {}
        return Sandwich(element, jtype, ELEMENTS[jtype][0], **values | given)

    return make


def turn(dim, degrees):
    """A rotation: about an axis that is no direction of anything."""
    if dim == 2:
        return Rotation.from_euler("z", degrees, degrees=True).as_matrix()[:2, :2]
    return Rotation.from_rotvec(np.deg2rad(degrees) * np.array([0.6, -0.48, 0.64])).as_matrix()


def opened(jtype, size, seed):
    """Displacements that open and shear the element by about `size`, and bend its faces."""
    coordinates, bottom, top = ELEMENTS[jtype]
    rng = np.random.default_rng(seed)
    # solids strain by little, or nothing but their stress is seen
    solids = len(coordinates) > 2 * len(top)
    u = (2e-5 if solids else 0.02) * rng.normal(size=coordinates.shape)
    normal = np.array([-0.3, 0.95]) if jtype < 7 else np.array([0.1, 0.0, 1.0])
    gaps = size * (normal + 0.4 * rng.normal(size=(len(top), len(normal))))
    if solids:
        u[len(u) // 2 :] += gaps.mean(axis=0)
        gaps = gaps.mean(axis=0) + 0.02 * (gaps - gaps.mean(axis=0))
    u[top] = u[bottom] + gaps
    return u


def motions(places):
    """Motions that AMATRX at constant stress knows: both solids as one rigid body, and one away from the other."""
    dim = places.shape[1]
    upper = np.repeat([0.0, 1.0], len(places) // 2)[:, None]
    moves = [upper * axis for axis in np.eye(dim)]
    spins = [(0, 1), (0, 2), (1, 2)] if dim == 3 else [(0, 1)]
    for i, j in spins:
        spin = np.zeros((dim, dim))
        spin[i, j], spin[j, i] = -1.0, 1.0
        moves.append(places @ spin.T)
    return np.array([move.ravel() for move in moves])


@options
def test_no_force_under_rigid_motions(interface_element, jtype, name):
    """By 180 degrees in 50 increments, and far away."""
    coordinates = ELEMENTS[jtype][0]
    dim = coordinates.shape[1]
    item = interface_element(jtype, name)
    for degrees in np.linspace(0, 180, 51)[1:]:
        rhs = item.advance((coordinates - 3.0) @ turn(dim, degrees).T - coordinates, flags=NLGEOM)[0]
        assert abs(rhs).max() <= 1e-9 * 3e5
    assert not item.state["DAMAGE"].any()


@options
@pytest.mark.parametrize("size", [5e-4, 4e-3, 8e-3, -1e-3])
def test_tangent(interface_element, reference, jtype, name, size):
    coordinates = ELEMENTS[jtype][0]
    q = turn(coordinates.shape[1], 50.0)
    item = interface_element(jtype, name)
    item.advance((coordinates + opened(jtype, 1e-3, 1)) @ q.T - coordinates, flags=NLGEOM)
    present = (coordinates + opened(jtype, size, 2)) @ q.T
    u = (present - coordinates).ravel()
    along = np.eye(u.size)
    if jtype in QUADRATIC:
        # of many unknowns some random directions
        along = np.random.default_rng(3).normal(size=(6, u.size)) / np.sqrt(u.size)
    elif jtype in (3, 10):
        along = motions(present)
    tangent = item.evaluate(u, flags=NLGEOM)[1]
    differences = -reference.central_differences(
        lambda x: item.evaluate(u + x @ along, flags=NLGEOM)[0], np.zeros(len(along)), step=2e-7
    )
    assert abs(tangent).max() > 0
    assert abs(tangent @ along.T - differences).max() <= 1e-7 * abs(tangent).max()


@options
def test_an_element_that_turns_while_it_opens(interface_element, jtype, name):
    """Forces turn along; damage, tractions in their frame and energies are those without the rotation."""
    coordinates = ELEMENTS[jtype][0]
    dim = coordinates.shape[1]
    still, turned = (interface_element(jtype, name) for _ in range(2))
    for k, size in enumerate((5e-4, 3e-3, 2e-3, 6e-3, -5e-4, 8e-3)):
        q, u = turn(dim, 45.0 * (k + 1)), opened(jtype, size, 7 + k)
        force = still.advance(u, flags=NLGEOM)[0].reshape(-1, dim)
        found = turned.advance((coordinates + u) @ q.T - coordinates, flags=NLGEOM)[0].reshape(-1, dim)
        np.testing.assert_allclose(found, force @ q.T, atol=1e-9 * abs(force).max())
    assert still.state["DAMAGE"].max() > 0.1
    for variable in still.state:
        scale = abs(still.state[variable]).max()
        np.testing.assert_allclose(turned.state[variable], still.state[variable], atol=1e-9 * scale)
    np.testing.assert_allclose(turned.energy, still.energy, rtol=1e-9, atol=1e-14)


@every
def test_forces_are_in_equilibrium(interface_element, jtype):
    """Forces and, about any point, moments on the deformed element."""
    coordinates = ELEMENTS[jtype][0]
    item = interface_element(jtype)
    u = opened(jtype, 5e-3, 3)
    force = item.evaluate(u, flags=NLGEOM)[0].reshape(coordinates.shape)
    size = abs(force).max()
    np.testing.assert_allclose(force.sum(axis=0), 0, atol=1e-11 * size)
    moments = np.einsum("ai,aj->ij", coordinates + u, force)
    np.testing.assert_allclose(moments, moments.T, atol=1e-11 * size)
    assert size > 1


@every
def test_small_displacements(interface_element, jtype):
    """Forces of displacements of 1e-7 of the size are those without NLGEOM to that order."""
    coordinates = ELEMENTS[jtype][0]
    item = interface_element(jtype)
    u = 1e-7 * np.random.default_rng(3).normal(size=coordinates.shape)
    linear, finite = item.evaluate(u)[0], item.evaluate(u, flags=NLGEOM)[0]
    np.testing.assert_allclose(finite, linear, atol=1e-6 * abs(linear).max())
    assert abs(finite - linear).max() > 0


@pytest.mark.parametrize("size", [5e-4, 4e-3, -1e-3])
@pytest.mark.parametrize(("shared", "own"), [(3, 4), (10, 8)])
def test_stress_shared_with_neighbours(element, interface_element, shared, own, size):
    """U3 as U4, U10 as U8, but for the order of the strain: their solids turn by themselves, not with each point."""
    coordinates = ELEMENTS[own][0]
    q = turn(coordinates.shape[1], 70.0)
    u = (coordinates + opened(own, size, 5)) @ q.T - coordinates
    expected = element(own, coordinates).evaluate(u, flags=NLGEOM)[0]
    found = interface_element(shared).evaluate(u, flags=NLGEOM)[0]
    np.testing.assert_allclose(found, expected, atol=2e-3 * abs(expected).max())


@pytest.mark.parametrize("degrees", [10.0, 60.0])
@pytest.mark.parametrize("jtype", [4, 6, 8, 12])
def test_solids_that_turn_apart_have_no_stress(element, jtype, degrees):
    """An open crack: each solid turns as a rigid body, so that nothing acts, in the complete form either."""
    coordinates, _, top = ELEMENTS[jtype]
    half = len(coordinates) // 2
    item = element(jtype, coordinates, **RIGID | {"CLOSURE": 3, "CRACKED": 1})
    q = turn(coordinates.shape[1], degrees)
    hinge = coordinates[top].mean(axis=0)
    u = np.zeros_like(coordinates)
    u[:half] = (coordinates[:half] - hinge) @ q + hinge - coordinates[:half]
    u[half:] = (coordinates[half:] - hinge) @ q.T + hinge - coordinates[half:]
    # and they move apart
    u[half:] += 3.0 * (coordinates[half:].mean(axis=0) - coordinates[:half].mean(axis=0))
    rhs = item.advance(u, flags=NLGEOM)[0]
    assert abs(rhs).max() <= 1e-9 * 3e5
    assert max(abs(item.state[name]).max() for name in item.names if name[0] == "T") <= 1e-9 * 3e5
