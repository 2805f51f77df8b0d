# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The continuum quad: patch test, and the built-in quads of the harness; patch tests with an interface."""

import numpy as np
import pytest

# patch of five distorted quads: MacNeal and Harder, "A proposed standard set of problems to test finite element
# accuracy", Finite Elements in Analysis and Design 1 (1985) 3-20
PATCH_NODES = np.array(
    [[0, 0], [0.24, 0], [0.24, 0.12], [0, 0.12], [0.04, 0.02], [0.18, 0.03], [0.16, 0.08], [0.08, 0.08]]
)
PATCH_QUADS = np.array([[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 6, 7]])
DISTORTED = np.array([[0.0, 0.0], [1.1, 0.2], [0.9, 1.3], [-0.2, 0.8]])
GRADIENT = np.array([[1.0e-3, 0.4e-3], [0.7e-3, -0.5e-3]])


@pytest.mark.parametrize("plane", [0, 1])
def test_patch(element, reference, ply, plane):
    """Constant strain on distorted quads: exact stress everywhere, no residual at the inner nodes."""
    u = PATCH_NODES @ GRADIENT.T
    residual = np.zeros_like(u)
    strain = [GRADIENT[0, 0], GRADIENT[1, 1], GRADIENT[0, 1] + GRADIENT[1, 0]]
    stress = reference.elasticity(ply, 0.0, plane == 1) @ strain
    for nodes in PATCH_QUADS:
        item = element(1, PATCH_NODES[nodes], PLANE=plane)
        rhs, tangent = item.advance(u[nodes])
        residual[nodes] += rhs.reshape(4, 2)
        np.testing.assert_allclose(tangent @ u[nodes].ravel(), -rhs, atol=1e-12 * abs(tangent).max() * 1e-3)
        for name, value in zip(("S11", "S22", "S12"), stress, strict=True):
            np.testing.assert_allclose(item.state[name], value, rtol=1e-11)
        for name, value in zip(("E11", "E22", "E12", "E33"), [*strain, 0.0], strict=True):
            np.testing.assert_allclose(item.state[name], value, rtol=1e-11)
        assert item.state["S33"].any() == (plane == 1)
    assert abs(residual[4:]).max() < 1e-12 * abs(residual[:4]).max()


@pytest.mark.parametrize("plane", [0, 1])
def test_forces_are_integrals_of_the_stress(element, reference, ply, plane):
    """-RHS = sum over 2 x 2 Gauss points of B^T D B u det J, times the thickness of 2."""
    item = element(1, DISTORTED, PLANE=plane)
    u = 1e-3 * np.random.default_rng(1).normal(size=8)
    rhs, _ = item.advance(u)
    elasticity = reference.elasticity(ply, 0.0, plane == 1)
    force = np.zeros(8)
    order = ((-1, -1), (1, -1), (-1, 1), (1, 1))
    for k, (xi, eta) in enumerate(order):
        b, jacobian = reference.strain_matrix(DISTORTED, xi * reference.GAUSS, eta * reference.GAUSS)
        stress = elasticity @ b @ u
        found = [item.state[name][k] for name in ("S11", "S22", "S12")]
        np.testing.assert_allclose(found, stress, rtol=1e-11)
        force += 2.0 * jacobian * b.T @ stress
    np.testing.assert_allclose(-rhs, force, rtol=1e-11)


def test_same_as_the_built_in_quad(element, built_in):
    item = element(1, DISTORTED)
    u = 1e-3 * np.random.default_rng(1).normal(size=8)
    rhs, tangent = item.advance(u)

    other = built_in("CPS4", DISTORTED, thickness=2.0)
    expected, matrix = other.advance(u)
    np.testing.assert_allclose(rhs, expected, rtol=1e-12)
    np.testing.assert_allclose(tangent, matrix, atol=1e-12 * abs(tangent).max())
    for name in ("E11", "E22", "E12", "S11", "S22", "S12", "S33"):
        np.testing.assert_allclose(item.state[name], other.state[name], rtol=1e-11, atol=1e-14)


def test_rigid_motion_gives_no_force(element):
    rhs, _ = element(1, DISTORTED).evaluate(DISTORTED @ [[0.0, 1e-3], [-1e-3, 0.0]] + [0.5, -0.4])
    assert abs(rhs).max() < 1e-10


@pytest.mark.parametrize("jtype", [2, 4])
def test_patch_with_interface(element, interface, reference, law, ply, jtype):
    """Uniform stress through an inclined elastic interface: each body is strained alike and the jump is t/alpha.

    The forces of quads and interface cancel at the interface nodes, for U2 and U4 alike.
    """
    axes, _ = reference.frame(*interface.edge)
    stress = np.array([3.0, 7.0, 2.0])
    strain = np.linalg.solve(reference.elasticity(ply, 0.0, False), stress)
    gradient = np.array([[strain[0], strain[2] / 2], [strain[2] / 2, strain[1]]])
    traction = reference.traction_of_stress(axes, stress)
    jump = axes.T @ (traction / [law["ALPHAT"], law["ALPHAN"]])
    u = interface.eight @ gradient
    u[4:] += jump
    residual = np.zeros((8, 2))
    for nodes in (slice(0, 4), slice(4, 8)):
        residual[nodes] += element(1, interface.eight[nodes]).evaluate(u[nodes])[0].reshape(4, 2)
    if jtype == 2:
        owned = list(interface.owned)
        item = element(2, interface.four)
        residual[owned] += item.advance(u[owned])[0].reshape(4, 2)
    else:
        item = element(4, interface.eight)
        residual += item.advance(u)[0].reshape(8, 2)
    np.testing.assert_allclose(item.state["TN"], traction[1], rtol=1e-11)
    np.testing.assert_allclose(item.state["TT"], traction[0], rtol=1e-11)
    # what is left at nodes 4 and 5 balances the stress on the other sides of their quads: both are opposite
    total = residual[[3, 2]] + residual[[4, 5]]
    outside = np.zeros((2, 2))
    tensor = np.array([[stress[0], stress[2]], [stress[2], stress[1]]])
    for quad, places in ((interface.eight[:4], (3, 2)), (interface.eight[4:], (0, 1))):
        for row, corner in enumerate(places):
            before, after = quad[corner - 1], quad[(corner + 1) % 4]
            for start, finish in ((before, quad[corner]), (quad[corner], after)):
                if {tuple(start), tuple(finish)} == {tuple(p) for p in interface.edge}:
                    continue
                edge = finish - start
                outside[row] += 0.5 * law["THICKNESS"] * tensor @ [edge[1], -edge[0]]
    np.testing.assert_allclose(total, -outside, rtol=1e-11)
