# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Shells with NLGEOM, element by element: rigid rotations, tangent, work, equilibrium, small displacements."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from test_shells import LAMINATE, ONE, SOURCE, STEEL, TYPES, WARPED, T, group_of, shell_section

from uel.elements import Flags
from uel.model.element_types import SHELL
from uel.model.procedures import Static
from uel.model.properties import Plastic, ShellLayer
from uel.model.steps import Step


@pytest.fixture
def shell(bound, load, call):
    """Force, tangent and energies of a shell with NLGEOM, or without, by its unknowns, node by node."""

    def shell(element_type, section, *, large=True):
        x = WARPED[: SHELL[element_type].nodes]
        steps = (Step(1, "Step-1", Static(), SOURCE, nlgeom=large),)
        block, matrix = bound(group_of(element_type, section), x, load(None), steps)
        now = replace(call, flags=Flags(1, nlgeom=large))

        def evaluate(u):
            residual, u = np.zeros(6 * len(x)), np.asarray(u, dtype=float).ravel()
            matrix.data[:] = 0
            report = block.evaluate(now, u, u, residual, matrix.data)
            return -residual, matrix.toarray(), report.energy

        return evaluate

    return shell


def displaced(x, u, turn, shift):
    """Unknowns after displacements and rotations u, and then a rotation and a translation of all."""
    u = u.reshape(-1, 6)
    moved = turn.apply(x + u[:, :3]) + shift - x
    return np.hstack([moved, (turn * Rotation.from_rotvec(u[:, 3:])).as_rotvec()]).ravel()


TURNS = [Rotation.from_rotvec(vector) for vector in ([0.3, -0.2, 0.5], [2.0, 1.0, -1.5], [0.0, 3.1, 0.0])]


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("turn", TURNS)
def test_rotation_of_all_changes_nothing(shell, element_type, turn):
    """Forces and moments of a deformed shell turn with it, and it stores as much."""
    evaluate, x = shell(element_type, shell_section(LAMINATE, offset=0.3)), WARPED[: SHELL[element_type].nodes]
    u = 0.05 * np.random.default_rng(3).normal(size=6 * len(x))
    force, _, energy = evaluate(u)
    other, _, other_energy = evaluate(displaced(x, u, turn, np.array([1.0, -2.0, 3.0])))
    found = turn.apply(force.reshape(-1, 3)).ravel()
    np.testing.assert_allclose(other, found, atol=1e-12 * abs(force).max())
    np.testing.assert_allclose(other_energy, energy, rtol=1e-10, atol=1e-12 * energy[1])
    rigid, _, rigid_energy = evaluate(displaced(x, np.zeros_like(u), turn, np.ones(3)))
    np.testing.assert_allclose(rigid, 0, atol=1e-12 * abs(force).max())
    assert abs(rigid_energy).max() < 1e-12 * energy[1]


@pytest.mark.parametrize("element_type", TYPES)
def test_forces_and_moments_are_in_equilibrium(shell, element_type):
    x = WARPED[: SHELL[element_type].nodes]
    u = 0.1 * np.random.default_rng(4).normal(size=(len(x), 6))
    force = shell(element_type, shell_section())(u)[0].reshape(-1, 6)
    scale = abs(force).max()
    np.testing.assert_allclose(force[:, :3].sum(axis=0), 0, atol=1e-12 * scale)
    moment = np.cross(x + u[:, :3], force[:, :3]).sum(axis=0) + force[:, 3:].sum(axis=0)
    np.testing.assert_allclose(moment, 0, atol=1e-12 * scale)


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("size", [0.0, 0.05, 0.3])
@pytest.mark.parametrize("plastic", [False, True])
def test_tangent_is_the_derivative_of_the_forces(shell, element_type, size, plastic):
    hardening = Plastic(np.array([[1.0, 0.0], [11.0, 0.1]]), SOURCE) if plastic else None
    evaluate = shell(element_type, shell_section([ShellLayer(T, 5, replace(STEEL, plastic=hardening))], offset=0.2))
    x = WARPED[: SHELL[element_type].nodes]
    u = displaced(x, size * np.random.default_rng(7).normal(size=6 * len(x)), TURNS[0], np.zeros(3))
    _, k, _ = evaluate(u)
    step = 1e-6
    found = np.array([evaluate(u + d)[0] - evaluate(u - d)[0] for d in step * np.eye(len(u))]).T / (2 * step)
    np.testing.assert_allclose(k, found, atol=1e-6 * abs(k).max())


@pytest.mark.parametrize("element_type", TYPES)
def test_forces_do_the_work_that_is_stored(shell, element_type):
    """Moments do work on spins, which differ from changes of rotation vectors: dR = spin R."""
    evaluate, x = shell(element_type, shell_section(ONE)), WARPED[: SHELL[element_type].nodes]
    random = np.random.default_rng(5)
    u = 0.1 * random.normal(size=(len(x), 6)) + [0, 0, 0, 0.5, -1.0, 0.7]
    force = evaluate(u)[0].reshape(-1, 6)
    step = 1e-6
    change = random.normal(size=(len(x), 6))
    stored = []
    for sign in (1, -1):
        spins = Rotation.from_rotvec(sign * step * change[:, 3:])
        moved = u + sign * step * change
        moved[:, 3:] = (spins * Rotation.from_rotvec(u[:, 3:])).as_rotvec()
        energy = evaluate(moved)[2]
        stored.append(energy[1] + energy[5])
    assert (stored[0] - stored[1]) / (2 * step) == pytest.approx((force * change).sum(), rel=1e-6)


@pytest.mark.parametrize("element_type", TYPES)
def test_small_displacements_are_those_without_nlgeom(shell, element_type):
    large, small = (shell(element_type, shell_section(LAMINATE), large=large) for large in (True, False))
    u = 1e-7 * np.random.default_rng(6).normal(size=6 * SHELL[element_type].nodes)
    (force, k, _), (other, other_k, _) = large(u), small(u)
    np.testing.assert_allclose(force, other, atol=1e-6 * abs(other).max())
    np.testing.assert_allclose(k, other_k, atol=1e-6 * abs(other_k).max())
