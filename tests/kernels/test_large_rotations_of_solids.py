# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Continuum elements with NLGEOM: strains are those of the displacements less the rotation of the middle."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from uel.errors import Source
from uel.model.properties import Elastic, ElasticType, Material, Plastic

NLGEOM = (1, 1, 0, 0)
SOURCE = Source("test.inp", 1)
STEEL = Material("STEEL", SOURCE, Elastic(ElasticType.ISOTROPIC, (2.0e5, 0.3), SOURCE))
YIELDING = Material("YIELDING", SOURCE, STEEL.elastic, Plastic(np.array([[200.0, 0.0], [260.0, 0.02]]), SOURCE))
QUAD = np.array([[0.0, 0.0], [1.1, 0.2], [0.9, 1.3], [-0.2, 0.8]])
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float)
BRICK = CORNERS * [1.2, 0.9, 0.7] + 0.1 * np.random.default_rng(3).uniform(-1, 1, (8, 3))
CASES = {
    "plane stress": (1, {}),
    "plane strain": (1, {"PLANE": 1}),
    "plain": (9, {"ANGLE": 25.0}),
    "modes": (9, {"FORMULATION": 1, "ANGLE": 25.0}),
    "mean volume": (9, {"FORMULATION": 2}),
}
every = pytest.mark.parametrize("case", CASES)


def place_of(jtype):
    """Original coordinates."""
    return QUAD if jtype == 1 else BRICK


def turn(dim, degrees):
    """A rotation: about an axis that is no direction of anything."""
    if dim == 2:
        return Rotation.from_euler("z", degrees, degrees=True).as_matrix()[:2, :2]
    return Rotation.from_rotvec(np.deg2rad(degrees) * np.array([0.6, -0.48, 0.64])).as_matrix()


def deformed(jtype, size, seed):
    """Displacements of about this strain."""
    return size * np.random.default_rng(seed).normal(size=place_of(jtype).shape)


@every
def test_no_force_under_rigid_motions(element, case):
    """By 180 degrees in 50 increments, and far away."""
    jtype, values = CASES[case]
    coordinates = place_of(jtype)
    dim = coordinates.shape[1]
    item = element(jtype, coordinates, **values)
    stiffness = abs(item.evaluate(np.zeros(coordinates.size))[1]).max()
    for degrees in np.linspace(0, 180, 51)[1:]:
        rhs = item.advance((coordinates - 3.0) @ turn(dim, degrees).T - coordinates, flags=NLGEOM)[0]
        assert abs(rhs).max() <= 1e-9 * stiffness
    # energies of a strain of 1e-12
    assert abs(item.energy).max() <= 1e-24 * stiffness


@every
@pytest.mark.parametrize("material", [None, YIELDING], ids=["ply", "yielding"])
def test_tangent(element, reference, case, material):
    jtype, values = CASES[case]
    coordinates = place_of(jtype)
    q = turn(coordinates.shape[1], 50.0)
    item = element(jtype, coordinates, material=material, **values)
    item.advance((coordinates + deformed(jtype, 5e-3, 1)) @ q.T - coordinates, flags=NLGEOM)
    u = (coordinates + deformed(jtype, 2e-2, 2)) @ q.T - coordinates
    tangent = item.evaluate(u, flags=NLGEOM)[1]
    differences = -reference.central_differences(lambda x: item.evaluate(x, flags=NLGEOM)[0], u.ravel(), step=1e-6)
    assert abs(tangent - differences).max() <= 1e-7 * abs(tangent).max()
    np.testing.assert_allclose(tangent, tangent.T, atol=1e-11 * abs(tangent).max())


@every
@pytest.mark.parametrize("material", [None, YIELDING], ids=["ply", "yielding"])
def test_an_element_that_turns_while_it_deforms(element, case, material):
    """Forces turn along; strains, stresses and energies are those without the rotation."""
    jtype, values = CASES[case]
    coordinates = place_of(jtype)
    dim = coordinates.shape[1]
    still, turned = (element(jtype, coordinates, material=material, **values) for _ in range(2))
    for k in range(4):
        q, u = turn(dim, 45.0 * (k + 1)), deformed(jtype, 5e-3, 7 + k)
        force = still.advance(u, flags=NLGEOM)[0].reshape(-1, dim)
        found = turned.advance((coordinates + u) @ q.T - coordinates, flags=NLGEOM)[0].reshape(-1, dim)
        np.testing.assert_allclose(found, force @ q.T, atol=1e-9 * abs(force).max())
    for variable in still.state:
        scale = abs(still.state[variable]).max()
        np.testing.assert_allclose(turned.state[variable], still.state[variable], atol=1e-9 * scale)
    np.testing.assert_allclose(turned.energy, still.energy, rtol=1e-9)


@every
def test_forces_are_the_derivative_of_the_energy(element, reference, case):
    """Of the strain energy, from the origin to large strains, and in equilibrium on the deformed element."""
    jtype, values = CASES[case]
    coordinates = place_of(jtype)
    dim = coordinates.shape[1]
    u = ((coordinates + deformed(jtype, 5e-2, 4)) @ turn(dim, 70.0).T - coordinates).ravel()

    def energy(x):
        item = element(jtype, coordinates, **values)
        item.advance(x, flags=NLGEOM)
        return item.energy[1:2]

    force = element(jtype, coordinates, **values).evaluate(u, flags=NLGEOM)[0]
    np.testing.assert_allclose(
        -reference.central_differences(energy, u, step=1e-5)[0], force, atol=1e-7 * abs(force).max()
    )
    now, nodal = coordinates + u.reshape(-1, dim), force.reshape(-1, dim)
    assert abs(nodal.sum(axis=0)).max() <= 1e-12 * abs(force).max()
    assert abs(now.T @ nodal - nodal.T @ now).max() <= 1e-12 * abs(force).max()


@every
def test_small_displacements(element, case):
    """Forces of displacements of 1e-7 of the size are those without NLGEOM to that order."""
    jtype, values = CASES[case]
    coordinates = place_of(jtype)
    item = element(jtype, coordinates, **values)
    u = deformed(jtype, 1e-7, 3)
    linear, finite = item.evaluate(u)[0], item.evaluate(u, flags=NLGEOM)[0]
    np.testing.assert_allclose(finite, linear, atol=1e-6 * abs(linear).max())
    assert abs(finite - linear).max() > 0


@pytest.mark.parametrize(
    ("jtype", "name", "values"),
    [(1, "CPS4", {"THICKNESS": 1.0}), (9, "C3D8", {"FORMULATION": 2})],
)
def test_small_strains_of_built_in_elements(element, built_in, jtype, name, values):
    """Strains of 1e-5, then a rotation by 40 degrees: forces differ by the order of the strain from those of the
    built-in elements, which update Cauchy stress."""
    coordinates = place_of(jtype)
    q = turn(coordinates.shape[1], 40.0)
    strained = deformed(jtype, 1e-5, 6)
    u = (coordinates + strained) @ q.T - coordinates
    item = element(jtype, coordinates, material=STEEL, **values)
    other = built_in(name, coordinates, STEEL)
    for now, before in ((strained, 0 * u), (u, strained)):
        force = item.advance(now, flags=NLGEOM)[0]
        expected = other.advance(now, du=now - before, flags=NLGEOM)[0]
        np.testing.assert_allclose(force, expected, atol=1e-4 * abs(expected).max())


SMALL = 1e-3
"""Displacements over the size of an element."""


@pytest.mark.parametrize("material", [STEEL, YIELDING], ids=lambda material: material.name)
def test_built_in_brick_with_incompatible_modes(element, built_in, reference, material):
    """C3D8I, whose stresses and strains are along the global axes: strained at rest, then turned.

    U9 has small strains, C3D8I those of the deformation gradient: they differ by the order of the strain, SMALL.
    """
    item = element(9, BRICK, FORMULATION=1, material=material)
    other = built_in("C3D8I", BRICK, material)
    before = np.zeros((8, 3))
    for k in range(5):
        u = (BRICK + deformed(9, SMALL / 2 * min(k + 1, 2), 5)) @ turn(3, 35.0 * max(k - 1, 0)).T - BRICK
        rhs, tangent = item.advance(u, flags=NLGEOM)
        expected, matrix = other.advance(u, du=u - before, flags=NLGEOM)
        np.testing.assert_allclose(rhs, expected, atol=5 * SMALL * abs(expected).max())
        if k < 2:
            # the tangent of C3D8I leaves out that the strain rate is that of the middle of a turn
            np.testing.assert_allclose(tangent, matrix, atol=5 * SMALL * abs(matrix).max())
        before = u
    energy = other.energy[[1, 3]].sum()
    assert energy == pytest.approx(item.energy[1], rel=5 * SMALL)
    # the rotation of the middle, where the derivatives of the shape functions are +-1/8
    signs = 2 * CORNERS - 1
    left, _, right = np.linalg.svd((BRICK + u).T @ signs @ np.linalg.inv(BRICK.T @ signs))
    axes = left @ right @ reference.ply_axes(BRICK).T
    for name in "ES":
        found = axes @ reference.tensors(item.state, name) @ axes.T
        np.testing.assert_allclose(reference.tensors(other.state, name), found, atol=5 * SMALL * abs(found).max())


def test_built_in_brick_with_an_orientation(element, built_in, reference):
    """C3D8I of a ply whose *ORIENTATION has the axes of U9: strains and stresses are along them, and turn along.

    As above, to the order of the strain.
    """
    item = element(9, BRICK, FORMULATION=1, ANGLE=25.0)
    other = built_in("C3D8I", BRICK, axes=reference.ply_axes(BRICK, 25.0))
    before = np.zeros((8, 3))
    for degrees in (0.0, 40.0, 130.0):
        u = (BRICK + deformed(9, SMALL, 5)) @ turn(3, degrees).T - BRICK
        rhs = item.advance(u, flags=NLGEOM)[0]
        expected = other.advance(u, du=u - before, flags=NLGEOM)[0]
        np.testing.assert_allclose(rhs, expected, atol=5 * SMALL * abs(expected).max())
        scales = {letter: max(abs(v).max() for name, v in item.state.items() if name[0] == letter) for letter in "ES"}
        for name, values in item.state.items():
            np.testing.assert_allclose(other.state[name], values, atol=5 * SMALL * scales[name[0]])
        before = u


@every
def test_an_element_turned_inside_out_needs_a_smaller_increment(element, library, case):
    jtype, values = CASES[case]
    coordinates = place_of(jtype)
    item = element(jtype, coordinates, label=42, **values)
    mirrored = coordinates * ([-1] + [1] * (coordinates.shape[1] - 1))
    library.messages()
    rhs, tangent = item.evaluate(mirrored - coordinates, flags=NLGEOM)
    assert item.report.pnewdt == 0.25
    assert not rhs.any() and not tangent.any()
    (message,) = library.messages()
    assert message.kind == "warning"
    assert f"U{jtype} element 42: its displacements turn its middle inside out; a smaller inc" in message.text
