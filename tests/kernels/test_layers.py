# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Standard elements whose faces are apart, such as an adhesive: rotation, equilibrium, patch test, tangent."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from solid_pairs import frames_at, geometry

from uel.errors import KernelError
from uel.usersub.layout import element_layouts

ALPHA_N, ALPHA_T = 2.0e4, 1.0e4
STIFF = {"ALPHAN": ALPHA_N, "ALPHAT": ALPHA_T}
STRONG = {"SIGMAMAX": 1e6, "TAUMAX": 1e6, "GIC": 1e9, "GIIC": 1e9}
THICKNESS = 0.3
LINEAR, NLGEOM = (1, 0, 0, 0), (1, 1, 0, 0)
OWNER = {2: 4, 5: 6, 7: 8, 11: 12, 13: 404, 14: 1010}
"""Type with solids whose geometry a standard one takes."""
STABILISED = [jtype for jtype, layout in element_layouts().items() if layout.faces[0] and jtype not in OWNER]
every = pytest.mark.parametrize("jtype", OWNER)
rules = pytest.mark.parametrize("rule", [0, 1])


def layer_nodes(jtype, thickness=THICKNESS, uneven=0.2):
    """Nodes of a layer in a random direction, curved or warped, whose thickness varies and slants."""
    layout, owner = element_layouts()[jtype], OWNER[jtype]
    rng = np.random.default_rng(jtype)
    solids = geometry(owner, rng, curved=0.05)
    nodes = np.zeros((layout.nodes, layout.dimension))
    normal = frames_at(owner, solids)[1]
    for side, (own, face) in enumerate(zip(layout.faces, element_layouts()[owner].faces, strict=True)):
        apart = normal + uneven * rng.uniform(-1, 1, size=(len(face), layout.dimension))
        nodes[list(own)] = solids[list(face)] + (side - 0.5) * thickness * apart
    return nodes


def turn(dim, angle):
    """A rotation about an axis that is no direction of anything."""
    axis = np.array([0.6, -0.48, 0.64]) if dim == 3 else np.array([0.0, 0.0, 1.0])
    return Rotation.from_rotvec(angle * axis).as_matrix()[:dim, :dim]


def spins(dim):
    """Skew matrices: infinitesimal rotations about every axis."""
    for i, j in [(0, 1), (0, 2), (1, 2)] if dim == 3 else [(0, 1)]:
        spin = np.zeros((dim, dim))
        spin[i, j], spin[j, i] = -1.0, 1.0
        yield spin


def moments(places, forces):
    """Moments of nodal forces about the origin; in the plane one."""
    return np.array([np.sum(forces * (places @ spin.T)) for spin in spins(places.shape[1])])


@every
@rules
def test_no_force_in_a_small_rigid_motion(element, jtype, rule):
    """A translation opens nothing at all. In a rotation by theta the jump of the displacements would be theta times the
    thickness: rounding is compared with that.
    """
    nodes = layer_nodes(jtype)
    item = element(jtype, nodes, INTEGRATION=rule, **STIFF, **STRONG)
    dim = nodes.shape[1]
    assert not item.evaluate(np.tile(np.linspace(1e3, -2e3, dim), (len(nodes), 1)))[0].any()
    theta = 1e-3
    for spin in spins(dim):
        rhs, _ = item.advance(theta * (nodes + 100.0) @ spin.T)
        assert abs(rhs).max() < 1e-10 * ALPHA_N * theta * THICKNESS
        assert abs(item.state["TN"]).max() < 1e-10 * ALPHA_N * theta * THICKNESS


@every
@rules
def test_no_force_in_large_rotations(element, jtype, rule):
    """By 180 degrees in 50 increments, and far away."""
    nodes = layer_nodes(jtype)
    item = element(jtype, nodes, INTEGRATION=rule, **STIFF)
    for angle in np.linspace(0, np.pi, 51)[1:]:
        rhs, _ = item.advance((nodes - 3.0) @ turn(nodes.shape[1], angle).T - nodes, flags=NLGEOM)
        assert abs(rhs).max() < 1e-10 * ALPHA_N
    assert not item.state["DAMAGE"].any()


@every
@rules
@pytest.mark.parametrize("flags", [LINEAR, NLGEOM])
@pytest.mark.parametrize("size", [1e-4, 0.02])
def test_forces_are_in_equilibrium(element, jtype, rule, flags, size):
    """Neither a resultant nor a moment: the couple of the tractions on faces apart is held, when failing too."""
    nodes = layer_nodes(jtype)
    item = element(jtype, nodes, INTEGRATION=rule, **STIFF)
    u = size * np.random.default_rng(3).normal(size=nodes.shape)
    forces = item.advance(u, flags=flags)[0].reshape(nodes.shape)
    places = nodes + u if flags == NLGEOM else nodes
    assert (item.state["DAMAGE"] > 0).any() == (size > 0.01)
    np.testing.assert_allclose(forces.sum(axis=0), 0, atol=1e-11 * abs(forces).max())
    np.testing.assert_allclose(moments(places, forces), 0, atol=1e-10 * abs(forces).max())


@every
@rules
@pytest.mark.parametrize("flags", [LINEAR, NLGEOM])
@pytest.mark.parametrize("size", [1e-4, 0.02])
def test_tangent(element, reference, jtype, rule, flags, size):
    """Against differences, in any direction of the displacements; symmetric while elastic."""
    nodes = layer_nodes(jtype)
    item = element(jtype, nodes, INTEGRATION=rule, **STIFF)
    rng = np.random.default_rng(4)
    item.advance(0.9 * size * rng.normal(size=nodes.shape), flags=flags)
    u = size * rng.normal(size=nodes.shape).ravel()
    tangent = item.evaluate(u, flags=flags)[1]
    ways = rng.normal(size=(5, u.size)) / np.sqrt(u.size)
    found = reference.central_differences(
        lambda s: item.evaluate(u + s @ ways, flags=flags)[0], np.zeros(len(ways)), step=4e-6
    )
    np.testing.assert_allclose(tangent @ ways.T, -found, rtol=0, atol=2e-7 * abs(tangent).max())
    if size < 0.01:
        np.testing.assert_allclose(tangent, tangent.T, rtol=0, atol=1e-12 * abs(tangent).max())


@every
@rules
def test_small_displacements_are_the_limit_of_large_ones(element, jtype, rule):
    nodes = layer_nodes(jtype)
    item = element(jtype, nodes, INTEGRATION=rule, **STIFF)
    u = 1e-7 * np.random.default_rng(5).normal(size=nodes.shape)
    small, large = (item.evaluate(u, flags=flags)[0] for flags in (LINEAR, NLGEOM))
    # the error is of the order of the displacements over the length, which is about 1
    np.testing.assert_allclose(large, small, rtol=0, atol=3e-6 * abs(small).max())


class Strip:
    """Layers in a row or a field, of unequal sizes and one thickness, turned out of the axes of the deck.

    nodes     (nodes, dimension): bottom, then top
    elements  nodes of each
    """

    def __init__(self, element, jtype, **values):
        dim = element_layouts()[jtype].dimension
        x = np.array([0.0, 0.7, 1.6, 2.0])
        if dim == 2:
            grid = np.column_stack([x, np.zeros(4)])
            cells = [[k, k + 1, k + 5, k + 4] for k in range(3)]
        else:
            grid = np.array([[a, b, 0.0] for b in (0.0, 0.8, 1.1) for a in x])
            quads = [[4 * j + k, 4 * j + k + 1, 4 * j + k + 5, 4 * j + k + 4] for j in range(2) for k in range(3)]
            cells = [[*quad, *(np.array(quad) + 12)] for quad in quads]
        self.axes = turn(dim, 0.5)
        self.flat = np.vstack([grid, grid + THICKNESS * np.eye(dim)[-1]])
        self.nodes = self.flat @ self.axes.T
        self.elements = cells
        self.items = [element(jtype, self.nodes[cell], **values) for cell in cells]

    def forces(self, u):
        """Nodal forces on the strip, in its own axes, after an increment."""
        total = np.zeros_like(self.nodes)
        for item, cell in zip(self.items, self.elements, strict=True):
            total[cell] -= item.advance(u[cell])[0].reshape(-1, u.shape[1])
        return total @ self.axes


@pytest.mark.parametrize("jtype", [2, 7])
@rules
@pytest.mark.parametrize("angle", [0.0, 1e-4])
def test_patch(element, jtype, rule, angle):
    """Uniform tension and shear, with a small rotation of the whole: the tractions are ALPHA times the jump.

    Nodes inside carry the tractions on their share of a face. At an end there is the force across the layer that a body
    of this thickness h under the shear stress T has there, by the symmetry of stress: T h per width, half of it on each
    face. The forces at both ends hold the couple of the tractions.
    """
    strip = Strip(element, jtype, INTEGRATION=rule, **STIFF, **STRONG)
    dim = strip.nodes.shape[1]
    jump = np.array([3e-4, -2e-4, 5e-4])[[0, 2] if dim == 2 else [0, 1, 2]]
    top = np.arange(len(strip.nodes)) >= len(strip.nodes) // 2
    spin = angle * np.array(next(iter(spins(dim))))
    u = np.where(top[:, None], jump @ strip.axes.T, 0.0) + strip.nodes @ spin.T
    forces = strip.forces(u)
    traction = np.append(ALPHA_T * jump[:-1], ALPHA_N * jump[-1])
    for item in strip.items:
        if dim == 2:
            np.testing.assert_allclose(item.state["TT"], traction[0], rtol=1e-9)
        else:
            both = np.hypot(item.state["TS"], item.state["TT"])
            np.testing.assert_allclose(both, np.hypot(*traction[:2]), rtol=1e-9)
        np.testing.assert_allclose(item.state["TN"], traction[-1], rtol=1e-9)
    width = 2.0 if dim == 2 else 1.0
    flat, length = strip.flat, 2.0
    # shares of the nodes of a face along x, and y
    shares = np.array([0.35, 0.8, 0.65, 0.2])[np.searchsorted([0.0, 0.7, 1.6, 2.0], flat[:, 0])]
    across = np.ones(len(flat))
    if dim == 3:
        across = np.array([0.4, 0.55, 0.15])[np.searchsorted([0.0, 0.8, 1.1], flat[:, 1])]
    expected = np.outer(np.where(top, 1.0, -1.0) * shares * across * width, traction)
    # end forces of the complementary shear: on lines x = 0 and x = length, and on those of y
    ends = (flat[:, 0] == length).astype(float) - (flat[:, 0] == 0.0)
    pairs = ends * across * width * traction[0]
    if dim == 3:
        ends = (flat[:, 1] == 1.1).astype(float) - (flat[:, 1] == 0.0)
        pairs += ends * shares * traction[1]
    expected[:, -1] += 0.5 * THICKNESS * pairs
    np.testing.assert_allclose(forces, expected, rtol=0, atol=1e-9 * abs(expected).max())


def test_bending_shears_nothing(element):
    """A sandwich that bends to a radius 1/k: u = (-k x y, k x^2/2) has no shear strain, and opens nothing.

    Elements with midside nodes follow it in every point, those without in their mean: their lines are straight.
    """
    k = 1e-3
    for jtype, x in ((2, [0.0, 1.0]), (5, [0.0, 1.0, 0.5])):
        bottom, top = (np.column_stack([x, np.full(len(x), y)]) for y in (-0.5 * THICKNESS, 0.5 * THICKNESS))
        layout = element_layouts()[jtype]
        nodes = np.zeros((layout.nodes, 2))
        for own, face in zip(layout.faces, (bottom, top), strict=True):
            nodes[list(own)] = face
        item = element(jtype, nodes, **STIFF, **STRONG)
        item.advance(np.column_stack([-k * nodes[:, 0] * nodes[:, 1], 0.5 * k * nodes[:, 0] ** 2]))
        limit = 1e-10 * ALPHA_T * k * THICKNESS
        assert abs(item.state["TN"]).max() < limit
        assert abs(item.state["TT"].mean()) < limit
        assert jtype == 2 or abs(item.state["TT"]).max() < limit


@every
def test_traction_does_not_depend_on_the_thickness(element, jtype):
    """A jump gives the same traction whatever lies between the faces: alpha is E/h by the user."""
    found = []
    for thickness in (0.0, 1e-9, 0.1, 0.3):
        nodes = layer_nodes(jtype, thickness, uneven=0.0)
        top = np.isin(np.arange(len(nodes)), element_layouts()[jtype].faces[1])
        item = element(jtype, nodes, **STIFF, **STRONG)
        item.advance(np.where(top[:, None], 1e-4 * np.arange(1, 1 + nodes.shape[1]), 0.0))
        found.append([item.state[name] for name in ("TN", "TT")])
    np.testing.assert_allclose(found[1:], [found[0]] * 3, rtol=1e-6, atol=1e-9)


SQUARE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
UP = np.array([0.0, 0.0, 0.3])


@pytest.mark.parametrize(
    ("jtype", "nodes", "message"),
    [
        (
            2,
            [[0, 0], [1, 0], [1, -0.2], [0, -0.2]],
            r"U2 element 42: the faces are apart, and the top one does not lie above the bottom one, node by node; at "
            r"point 1 it is -0?\.2.* above it and 0\.?0* aside: expected more above than aside",
        ),
        (2, [[0, 0], [1, 0], [1.3, 0.2], [0.3, 0.2]], r"does not lie above.* 0?\.2.* above it and 0?\.3.* aside"),
        (2, [[0, 0], [1, 0], [0.6, 0.4], [0.4, 0.4]], r"turned against each other, or too different in size.*point 1"),
        (7, [*SQUARE, *(np.roll(SQUARE, -1, axis=0) + UP)], "does not lie above the bottom one"),
        (7, [*SQUARE, *(np.roll(SQUARE, -1, axis=0) + 5 * UP)], "turned against each other.*number their nodes alike"),
        (7, [*SQUARE, *(SQUARE[[0, 3, 2, 1]] + UP)], "no length or area"),
        (7, [*SQUARE, *(SQUARE - UP)], r"does not lie above.*it is -0?\.3.* above"),
    ],
)
def test_wrong_orders_of_the_nodes_are_refused(element, jtype, nodes, message):
    item = element(jtype, np.asarray(nodes, dtype=float), label=42)
    with pytest.raises(KernelError, match=message):
        item.evaluate(np.zeros(item.n))


@pytest.mark.parametrize("jtype", STABILISED)
def test_stabilised_elements_refuse_a_thickness(element, library, jtype):
    """They name the element, the distance, and the elements that take it."""
    library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)
    layout = element_layouts()[jtype]
    owner = {3: 4, 10: 8}.get(jtype, jtype)
    nodes = geometry(owner, np.random.default_rng(1), flat=True, affine=True)
    nodes[element_layouts()[owner].solids[0] :] += 0.3 * frames_at(owner, nodes)[1]
    if owner != jtype:
        places = np.zeros((layout.nodes, layout.dimension))
        for own, face in zip(layout.faces, element_layouts()[owner].faces, strict=True):
            places[list(own)] = nodes[list(face)]
        nodes = places
    item = element(jtype, nodes, label=42)
    message = (
        rf"U{jtype} element 42: the two faces of the interface do not coincide: .* they are .* apart, expected at "
    )
    message += "most .*, since the stress of the solids .*: a layer with a thickness needs a standard element"
    with pytest.raises(KernelError, match=message):
        item.evaluate(np.zeros(item.n))
