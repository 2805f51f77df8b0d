# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""INITIALN, INITIALT and INITIALS: the traction of the initial stress of the solids that an element owns."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from solid_pairs import OWNING, frames_at, geometry, solid_nodes

from uel.usersub.layout import element_layouts

RIGID = {"ALPHAN": 0.0, "ALPHAT": 0.0, "BETAN": -1.0, "BETAT": -1.0}
STRONG = {"SIGMAMAX": 1e4, "TAUMAX": 1e4, "GIC": 1e3, "GIIC": 1e3}
TRACTION = (4.0, -7.0, 2.5)
"""Along s (t in the plane), n and t."""
SMALL, NLGEOM = (1, 0, 0, 0), (1, 1, 0, 0)


def initial(jtype, factor=1.0):
    """The properties, and the components in the order of the frame."""
    dimension = element_layouts()[jtype].dimension
    names = ("INITIALT", "INITIALN") if dimension == 2 else ("INITIALS", "INITIALN", "INITIALT")
    values = factor * np.array(TRACTION[:dimension])
    return dict(zip(names, values.tolist(), strict=True)), values


def tractions(item):
    """(points, components) in the order of the frame."""
    return np.stack([item.state[f"T{name}"] for name in ("TN" if "TS" not in item.state else "SNT")], axis=-1)


def turn(dimension):
    """A rotation by 50 degrees."""
    vector = np.deg2rad(50.0) * (np.array([0.0, 0.0, 1.0]) if dimension == 2 else np.array([0.6, -0.48, 0.64]))
    return Rotation.from_rotvec(vector).as_matrix()[:dimension, :dimension]


@pytest.mark.parametrize("closure", [1, 2, 3])
@pytest.mark.parametrize("jtype", OWNING)
def test_a_bond_at_rest_has_the_traction(element, jtype, closure):
    """Without displacements: T is the initial one, its resultant pulls at both solids, and the matrix is as without."""
    nodes = geometry(jtype, np.random.default_rng(jtype), flat=True)
    stiffness = {"ALPHAN": 1e8, "ALPHAT": 1e8} if closure == 2 else {}
    values, expected = initial(jtype)
    item = element(jtype, nodes, **{**RIGID, **stiffness, **STRONG, **values, "CLOSURE": closure})
    plain = element(jtype, nodes, **{**RIGID, **stiffness, **STRONG, "CLOSURE": closure})
    force, matrix = item.evaluate(np.zeros_like(nodes))
    np.testing.assert_allclose(matrix, plain.evaluate(np.zeros_like(nodes))[1], rtol=1e-12, atol=1e-6)
    item.advance(np.zeros_like(nodes))
    # the paper's element takes the share 1 - S of the stress, which a high stiffness makes nearly 1
    tolerance = 1e-2 if closure == 2 else 1e-9
    np.testing.assert_allclose(tractions(item), np.tile(expected, (item.points, 1)), rtol=tolerance)
    below, above = (force.reshape(nodes.shape)[part].sum(axis=0) for part in solid_nodes(jtype))
    np.testing.assert_allclose(above, -below, atol=1e-10 * abs(below).max())
    pulled = -frames_at(jtype, nodes) @ above
    np.testing.assert_allclose(pulled / np.linalg.norm(pulled), expected / np.linalg.norm(expected), atol=tolerance)


@pytest.mark.parametrize("jtype", OWNING)
def test_it_turns_with_the_body(element, jtype):
    """A rigid rotation with NLGEOM leaves the components, and turns the forces."""
    nodes = geometry(jtype, np.random.default_rng(jtype), curved=0.02)
    values, _ = initial(jtype)
    rotation = turn(nodes.shape[1])
    still, turned = (element(jtype, nodes, **{**RIGID, **STRONG, **values, "CLOSURE": 3}) for _ in range(2))
    force = still.advance(np.zeros_like(nodes), flags=NLGEOM)[0].reshape(nodes.shape)
    found = turned.advance(nodes @ rotation.T - nodes, flags=NLGEOM)[0].reshape(nodes.shape)
    np.testing.assert_allclose(found, force @ rotation.T, atol=1e-9 * abs(force).max())
    np.testing.assert_allclose(tractions(turned), tractions(still), rtol=1e-9)


@pytest.mark.parametrize("flags", [SMALL, NLGEOM], ids=["small", "nlgeom"])
@pytest.mark.parametrize("jtype", [4, 6, 8, 12, 34, 608])
def test_tangent(element, jtype, flags):
    """Check an opened, damaged element against central differences."""
    rng = np.random.default_rng(jtype)
    nodes = geometry(jtype, rng)
    values, _ = initial(jtype)
    item = element(jtype, nodes, **{**RIGID, **values, "CLOSURE": 3, "LAW": 2, "ETA": 1.4})
    u = 1e-5 * rng.normal(size=nodes.shape)
    u[solid_nodes(jtype)[1]] += 6e-3 * np.array([0.3, 1.0, 0.3])[: nodes.shape[1]] @ frames_at(jtype, nodes)
    item.advance(0.9 * u, flags=flags)
    _, tangent = item.evaluate(u, flags=flags)
    step = 1e-7
    for along in np.eye(u.size):
        down, up = (item.evaluate(u + sign * step * along.reshape(u.shape), flags=flags)[0] for sign in (-1.0, 1.0))
        np.testing.assert_allclose((down - up) / (2.0 * step), tangent @ along, atol=1e-5 * abs(tangent).max())
    assert item.state["DAMAGE"].max() > 0.1


def test_more_than_the_strength_opens_the_bond(element):
    """A bond at rest under an initial traction above its strength is damaged; one below it is not."""
    nodes = geometry(4, np.random.default_rng(4), flat=True)
    for normal, damaged in ((29.9, False), (30.1, True)):
        item = element(4, nodes, **{**RIGID, "CLOSURE": 3, "INITIALN": normal})
        item.advance(np.zeros_like(nodes))
        assert (item.state["DAMAGE"].max() > 0.0) == damaged
