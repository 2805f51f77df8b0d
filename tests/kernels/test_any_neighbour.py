# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Stabilised interfaces between solids of every kind: their traction is the stress that the solids compute themselves.

The solids are the built-in elements, which are tested on their own; all formulations that Abaqus has for a shape occur.
"""

import numpy as np
import pytest
from solid_pairs import (
    built_in_names,
    cases,
    face_of_solid,
    frames_at,
    geometry,
    parent_nodes,
    plane_of,
    ply_axes,
    solid_nodes,
)

from uel.errors import KernelError
from uel.usersub.layout import element_layouts

STRONG = {"SIGMAMAX": 3e4, "TAUMAX": 6e4, "GIC": 1e6, "GIIC": 1e6, "ALPHAN": 0.0, "ALPHAT": 0.0}
TRACTIONS = {2: ("TT", "TN"), 3: ("TS", "TN", "TT")}
BETA = {"BETAN": 3e5, "BETAT": 2e5}
ALL = pytest.mark.parametrize(("jtype", "below", "above"), cases())


@pytest.fixture
def pair(element, built_in):
    """Make an element of the complete form and the solids beside it: pair(jtype, below, above, nodes, NAME=value)."""

    def make(jtype, below, above, nodes, **values):
        options = {**STRONG, "CLOSURE": 3, "BETAN": -1, "BETAT": -1}
        options |= {"FORMULATION BOTTOM": below, "FORMULATION TOP": above}
        if nodes.shape[1] == 2:
            options |= {"PLANE": plane_of(jtype, below), "THICKNESS": 1.0}
        solids = [
            built_in(name, nodes[part], axes=ply_axes(jtype, nodes))
            for name, part in zip(built_in_names(jtype, below, above), solid_nodes(jtype), strict=True)
        ]
        return element(jtype, nodes, **{**options, **values}), solids

    return make


def tractions(item, dim):
    """(points, dim) committed tractions."""
    return np.column_stack([item.state[name] for name in TRACTIONS[dim]])


def tensor(state, dim):
    """(points, dim, dim) stresses of a built-in element in the global axes of the plane, or in those of the ply."""
    entries = {(0, 0): "S11", (1, 1): "S22", (2, 2): "S33", (0, 1): "S12", (0, 2): "S13", (1, 2): "S23"}
    found = np.zeros((len(state["S11"]), dim, dim))
    for (i, j), name in entries.items():
        if max(i, j) < dim:
            found[:, i, j] = found[:, j, i] = state[name]
    return found


def global_stress(solid, jtype, nodes):
    """(points, dim, dim) stresses of a built-in element in global axes."""
    dim = nodes.shape[1]
    local, axes = tensor(solid.state, dim), ply_axes(jtype, nodes)
    return local if axes is None else np.einsum("ai,pab,bj->pij", axes, local, axes)


def middle_point(jtype):
    """Integration point in the middle of the face, or any one where the tractions of all are alike."""
    layout = element_layouts()[jtype]
    return {3: 1}.get(layout.points, 0) if layout.dimension == 2 else {7: 6, 9: 8}.get(layout.points, 0)


def integration_points(dim, nodes, count):
    """Parent coordinates of the integration points of Abaqus' elements, in its order."""
    if is_product(dim, nodes):
        line = {1: [0.0], 2: [-(3**-0.5), 3**-0.5], 3: [-(0.6**0.5), 0.0, 0.6**0.5]}[round(count ** (1 / dim))]
        return np.array([[line[k] for k in index[::-1]] for index in np.ndindex(*(len(line),) * dim)])
    triangle = {1: [[1 / 3, 1 / 3]], 3: [[1 / 6, 1 / 6], [2 / 3, 1 / 6], [1 / 6, 2 / 3]]}
    if dim == 2:
        return np.array(triangle[count])
    if nodes in (4, 10):
        a, b = (5 - 5**0.5) / 20, (5 + 3 * 5**0.5) / 20
        return np.full((1, 3), 0.25) if count == 1 else np.array([[a, a, a], [b, a, a], [a, b, a], [a, a, b]])
    heights = {2: [-(3**-0.5), 3**-0.5], 9: [-(0.6**0.5), 0.0, 0.6**0.5]}[count]
    return np.array([[*point, height] for height in heights for point in triangle[count // len(heights)]])


def monomials(dim, nodes, count):
    """Powers of as many monomials as there are integration points."""
    if is_product(dim, nodes):
        return np.array(list(np.ndindex(*(round(count ** (1 / dim)),) * dim)))
    linear = np.vstack([np.zeros((1, dim), dtype=int), np.eye(dim, dtype=int)])
    if dim == 3 and nodes in (6, 15):
        flat = linear[:1] if count == 2 else linear[:3]
        return np.array([[*power[:2], k] for k in range(2 if count == 2 else 3) for power in flat])
    return linear[:count]


def is_product(dim, nodes):
    """Whether a solid is a quad or a brick."""
    return nodes in {2: (4, 8), 3: (8, 20)}[dim]


def on_face(jtype, side, values):
    """Mean of the polynomial through the values at the integration points of a solid, where SAMPLING 0 takes them."""
    layout = element_layouts()[jtype]
    dim, nodes = layout.dimension, layout.solids[side]
    corners = parent_nodes(dim, nodes)[0][face_of_solid(jtype, side)]
    linear = nodes <= {2: 4, 3: 8}[dim]
    shares = {2: 0.5 + 0.5 * 3**-0.5, 3: 2 / 3, 4: None}[len(corners)]
    middle = corners.mean(axis=0)
    if linear:
        places = [middle]
    elif len(corners) == 4:
        places = middle + 3**-0.5 * (corners - middle)
    else:
        places = [
            shares * corner + (1 - shares) * np.delete(corners, k, 0).mean(axis=0) for k, corner in enumerate(corners)
        ]
    powers = monomials(dim, nodes, len(values))
    at_points = np.prod(integration_points(dim, nodes, len(values))[:, None] ** powers, axis=2)
    factors = np.mean([np.prod(place**powers, axis=1) for place in places], axis=0) @ np.linalg.inv(at_points)
    return np.einsum("p,pij->ij", factors, values)


@ALL
@pytest.mark.parametrize("sampling", [0, 1, 2])
def test_patch(pair, jtype, below, above, sampling):
    """A constant strain in distorted solids: the tractions are those of its stress."""
    rng = np.random.default_rng(jtype + 7 * below + 31 * above)
    nodes = geometry(jtype, rng, flat=True, curved=0.04)
    dim = nodes.shape[1]
    item, solids = pair(jtype, below, above, nodes, SAMPLING=sampling)
    u = nodes @ (1e-4 * rng.normal(size=(dim, dim))).T
    item.advance(u)
    solids[0].advance(u[solid_nodes(jtype)[0]])
    stress = global_stress(solids[0], jtype, nodes)[0]
    frame = frames_at(jtype, nodes)
    found = tractions(item, dim)
    expected = np.broadcast_to(frame @ stress @ frame[1], found.shape)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-10 * abs(stress).max())


@ALL
def test_traction_is_that_of_the_solids(pair, jtype, below, above):
    """Any displacements that do not open the face of solids with parallel edges."""
    rng = np.random.default_rng(jtype + 7 * below + 31 * above)
    nodes = geometry(jtype, rng, affine=True, height=0.7)
    dim = nodes.shape[1]
    item, solids = pair(jtype, below, above, nodes, GAMMABOT=0.3, **BETA)
    u = 1e-4 * rng.normal(size=nodes.shape)
    bottom, top = element_layouts()[jtype].faces
    u[list(top)] = u[list(bottom)]
    item.advance(u)
    frame, expected = frames_at(jtype, nodes), 0.0
    for side, (solid, weight) in enumerate(zip(solids, (0.3, 0.7), strict=True)):
        solid.advance(u[solid_nodes(jtype)[side]])
        stress = on_face(jtype, side, global_stress(solid, jtype, nodes))
        expected = expected + weight * frame @ stress @ frame[1]
    found = tractions(item, dim)[middle_point(jtype)]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * abs(expected).max())


def assembled(pair, jtype, below, above, nodes, **values):
    """Matrix of an interface and the solids beside it, and that of the interface alone."""
    item, solids = pair(jtype, below, above, nodes, **values)
    _, own = item.advance(np.zeros(nodes.size))
    matrix, dim = own.copy(), nodes.shape[1]
    for solid, part in zip(solids, solid_nodes(jtype), strict=True):
        rows = np.arange(part.start * dim, part.stop * dim)
        matrix[np.ix_(rows, rows)] += solid.evaluate(np.zeros(solid.n))[1]
    return matrix, own


@ALL
@pytest.mark.parametrize("integration", [0, 1])
@pytest.mark.parametrize("sampling", [0, 1, 2])
def test_bonded_solids_are_stable(pair, jtype, below, above, sampling, integration):
    """Flat and tall, distorted and curved: no displacements have less energy than none, but for rounding."""
    rng = np.random.default_rng(jtype + 7 * below + 31 * above)
    for height in (0.03, 0.3, 1.0, 8.0):
        nodes = geometry(jtype, rng, height=height, curved=min(0.02, 0.3 * height), random=0.2)
        matrix, own = assembled(pair, jtype, below, above, nodes, SAMPLING=sampling, INTEGRATION=integration)
        np.testing.assert_allclose(own, own.T, rtol=0, atol=1e-12 * abs(own).max())
        values = np.linalg.eigvalsh(0.5 * (matrix + matrix.T))
        assert values[0] > -1e-13 * values[-1]


@ALL
def test_rigid_motion(pair, jtype, below, above):
    nodes = geometry(jtype, np.random.default_rng(jtype))
    item, _ = pair(jtype, below, above, nodes)
    dim = nodes.shape[1]
    turn = np.array([[0.0, -0.3, 0.2], [0.3, 0.0, -0.5], [-0.2, 0.5, 0.0]])[:dim, :dim]
    force, _ = item.evaluate(nodes @ turn.T + 0.7)
    scale = abs(item.evaluate(nodes @ (turn + turn.T + np.eye(dim)).T)[0]).max()
    assert abs(force).max() < 1e-11 * scale


@ALL
@pytest.mark.parametrize("flags", [(1, 0, 0, 0), (1, 1, 0, 0)], ids=["linear", "NLGEOM"])
def test_tangent(pair, jtype, below, above, flags):
    """Against central differences while the interface softens."""
    rng = np.random.default_rng(jtype + 7 * below)
    nodes = geometry(jtype, rng, curved=0.02)
    law = {"ALPHAN": 2e4, "ALPHAT": 3e4, "SIGMAMAX": 30.0, "TAUMAX": 60.0, "GIC": 0.26, "GIIC": 1.002}
    item, _ = pair(jtype, below, above, nodes, **law)
    u = 1e-5 * rng.normal(size=nodes.shape)
    upper = solid_nodes(jtype)[1]
    u[upper] += 0.006 * frames_at(jtype, nodes)[1] + 0.004 * frames_at(jtype, nodes)[0]
    _, matrix = item.evaluate(u, flags=flags)
    step, found = 1e-7, np.empty_like(matrix)
    for k in range(u.size):
        change = np.zeros(u.size)
        change[k] = step
        ahead, behind = (item.evaluate(u.ravel() + sign * change, flags=flags)[0] for sign in (1, -1))
        found[:, k] = -(ahead - behind) / (2 * step)
    item.advance(u, flags=flags)
    assert ((item.state["DAMAGE"] > 0) & (item.state["DAMAGE"] < 1)).all()
    np.testing.assert_allclose(found, matrix, rtol=0, atol=2e-6 * abs(matrix).max())


@pytest.mark.parametrize(
    ("jtype", "values", "message"),
    [
        (8, {"FORMULATION BOTTOM": 4}, r"U8 element 42: JPROPS\(6\) FORMULATION BOTTOM = 4: expected 0 to 3"),
        (
            404,
            {"FORMULATION TOP": 1},
            r"JPROPS\(7\) FORMULATION TOP = 1: a tetrahedron of 4 nodes does not have it; expected 0 ",
        ),
        (6, {"FORMULATION BOTTOM": 2}, r"FORMULATION BOTTOM = 2: a quad of 8 nodes does not have it; expected 0 or 3"),
        (1515, {"FORMULATION TOP": 3}, "FORMULATION TOP = 3: a wedge of 15 nodes does not have it; expected 0"),
    ],
)
def test_formulations_that_a_solid_does_not_have(element, jtype, values, message):
    nodes = geometry(jtype, np.random.default_rng(1))
    item = element(jtype, nodes, label=42, **values)
    with pytest.raises(KernelError, match=message):
        item.evaluate(np.zeros(nodes.size))


@pytest.mark.parametrize("jtype", [33, 404, 606, 1010, 806])
def test_solids_that_are_inside_out(element, jtype):
    nodes = geometry(jtype, np.random.default_rng(1))
    item = element(jtype, nodes * np.array([1.0, -1.0, 1.0])[: nodes.shape[1]], label=42)
    name = {33: "triangle", 404: "tetrahedron", 606: "wedge", 1010: "tetrahedron", 806: "brick"}[jtype]
    with pytest.raises(KernelError, match=f"U{jtype} element 42: bottom {name} is inside out"):
        item.evaluate(np.zeros(nodes.size))
