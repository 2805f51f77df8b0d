# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The descent search on energies of one or two unknowns in place of elements."""

import numpy as np
import pytest

from uel.assembly import Evaluation
from uel.elements import Call, Flags
from uel.errors import SingularMatrixError
from uel.model.controls import LineSearchControls
from uel.solver import descent
from uel.solver.descent import Descent, Majoriser
from uel.solver.newton import Increment

CALL = Call(Flags(1), 1, 1, 1.0, 1.0, 1.0, 1.0)


class Landscape:
    """System, constraints and linear solver in one: unknowns without constraints in a given energy."""

    prescribed = np.zeros(0, dtype=np.int64)
    arms = ()

    def __init__(self, gradient, hessian, n):
        self._gradient, self._hessian = gradient, hessian
        self.free, self.indices = np.arange(n), np.tile(np.arange(n), n)
        self.passes = []

    def evaluate(self, call, u, du, *, matrix=True, motion=None):
        self.passes.append(call.flags.request)
        data = np.array(self._hessian(*u), dtype=float).ravel() if matrix else None
        residual = -np.array(self._gradient(*u), dtype=float)
        return Evaluation(residual, data, np.abs(residual), np.ones(1, dtype=np.int64), np.inf, np.zeros(8))

    def product(self, data, vector):
        return data.reshape(len(self.free), -1) @ vector

    def expand(self, dq, dprescribed):
        return dq

    def satisfy(self, start, increment):
        return increment

    def update(self, u, residual, increment, weight):
        pass

    def project(self, direction):
        return direction

    def reduce_vector(self, vector):
        return vector

    def prescribed_residual(self, data, dprescribed):
        return np.zeros(len(self.free))

    def reduce(self, data):
        return data

    reduce_tangent = reduce

    def factorise(self, data):
        self._factorised = data.copy().reshape(len(self.free), -1)
        if np.linalg.det(self._factorised) == 0.0:
            raise SingularMatrixError("node", 1)

    def solve(self, rhs):
        return np.linalg.solve(self._factorised, rhs)


def search(gradient, hessian, start, stiff, *, iterations=60, tolerance=1e-8):
    """Iterates from `start` until the residual is small; K_0 = `stiff`."""
    start = np.array(start, dtype=float)
    land = Landscape(gradient, hessian, len(start))
    majoriser = Majoriser()
    majoriser.use(land, land, lambda: Landscape(gradient, hessian, len(start)))
    majoriser.keep(np.array(stiff, dtype=float).ravel())
    solver = Descent(land, land, land, LineSearchControls(), majoriser)
    zero = np.zeros_like(start)
    found = []
    for state in solver.iterates(Increment(CALL, start, None, np.zeros(0), zero)):
        found.append(state)
        if np.abs(state.r_q).max() < tolerance or state.iteration == iterations:
            return found, solver, land
    raise AssertionError


@pytest.mark.parametrize("start", [0.1, 0.5, 0.9, -0.01])
def test_out_of_a_hollow_between_two_wells(start):
    """(x^2 - 1)^2/4: around 0 the tangent is negative and Newton's method climbs to the top."""
    states, solver, _ = search(lambda x: [x**3 - x], lambda x: [3 * x**2 - 1], [start], [[2.0]])
    assert start + states[-1].du[0] == pytest.approx(np.sign(start), abs=1e-6)
    assert bool(solver.reason) == (start**2 < 1 / 3)


def test_banana_valley():
    """Rosenbrock's function, minimum at (1, 1); reference: Rosenbrock, The Computer Journal 3 (1960) 175-184."""
    states, _, _ = search(
        lambda x, y: [-2 * (1 - x) - 400 * x * (y - x**2), 200 * (y - x**2)],
        lambda x, y: [[2 - 400 * (y - 3 * x**2), -400 * x], [-400 * x, 200]],
        [-1.2, 1.0],
        [[1330.0, 480.0], [480.0, 200.0]],
    )
    assert states[-1].du == pytest.approx([2.2, 0.0], abs=1e-6)


@pytest.mark.parametrize("start", [(0.31, 0.02), (-0.1, 2.9), (7.0, 0.4)])
def test_energy_falls_in_every_iteration_of_the_search(start):
    """Two softening unknowns on a soft foundation: cos(x - 0.3) + cos y + 0.2 cos(x - y) + (x^2 + y^2)/40."""

    def energy(x, y):
        return np.cos(x - 0.3) + np.cos(y) + 0.2 * np.cos(x - y) + (x**2 + y**2) / 40

    def gradient(x, y):
        coupling = 0.2 * np.sin(x - y)
        return [0.05 * x - np.sin(x - 0.3) - coupling, 0.05 * y - np.sin(y) + coupling]

    def hessian(x, y):
        c = 0.2 * np.cos(x - y)
        return [[0.05 - np.cos(x - 0.3) - c, c], [c, 0.05 - np.cos(y) - c]]

    states, solver, _ = search(gradient, hessian, start, 1.45 * np.eye(2))
    assert solver.reason
    assert np.abs(states[-1].r_q).max() < 1e-8
    energies = [energy(*(state.du + start)) for state in states[solver.since - 1 :]]
    assert (np.diff(energies) < 1e-15).all()
    # a minimum, not a saddle
    assert np.linalg.eigvalsh(hessian(*(states[-1].du + start))).min() > 0


def test_short_steps_mix_the_matrix_with_that_of_the_start(monkeypatch):
    """sqrt(x^2 + e^2) is straight beyond e: the tangent e^2/x^3 tends to zero, and c to a million times the way."""
    e = 1e-3

    def descend():
        return search(
            lambda x: [x / np.hypot(x, e)], lambda x: [e**2 / np.hypot(x, e) ** 3], [1.0], [[1 / e]], iterations=40
        )[0]

    states = descend()
    assert 1.0 + states[-1].du[0] == pytest.approx(0.0, abs=1e-6)
    assert len(states) < 40
    monkeypatch.setattr(descent, "SHORT", 0.0)
    assert len(descend()) > len(states)


def test_iterates_that_circle_go_on_from_their_mean(monkeypatch):
    """Three springs that soften from e on and fail at f, with a force that works on closed paths (M is unsymmetric)."""
    arms = np.array([[0.0, 0.9], [0.9, 1.0], [-0.2, 0.1]])
    begin, end = np.array([0.2, 0.4, 0.8]), np.array([0.6, 1.0, 1.2])
    circulating, load = np.array([[0.1, -0.3], [0.2, 0.3]]), np.array([-0.5, -1.0])

    def gradient(*x):
        w = np.abs(arms @ x)
        force = np.where(w < begin, w, np.clip(begin * (end - w) / (end - begin), 0.0, None)) * np.sign(arms @ x)
        return arms.T @ force + circulating @ x - load

    def hessian(*x):
        w = np.abs(arms @ x)
        slope = np.where(w < begin, 1.0, np.where(w < end, -begin / (end - begin), 0.0))
        return arms.T * slope @ arms + circulating

    start, stiff = [2.2, -0.7], [[1.0, 0.8], [0.8, 2.1]]
    states, solver, _ = search(gradient, hessian, start, stiff)
    assert solver.reason
    assert np.abs(states[-1].r_q).max() < 1e-8
    monkeypatch.setattr(descent, "CIRCLING", 0.0)
    states, *_ = search(gradient, hessian, start, stiff)
    assert np.abs(states[-1].r_q).max() > 0.05
    np.testing.assert_allclose(states[-1].du, states[-4].du)


def test_trial_passes_ask_for_the_residual_alone():
    _, _, land = search(lambda x: [x**3 - x], lambda x: [3 * x**2 - 1], [0.1], [[2.0]])
    assert set(land.passes) == {1, 5}
