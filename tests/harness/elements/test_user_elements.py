# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The block driver with small user elements: what they are given, and what becomes of what they return."""

import numpy as np
import pytest


@pytest.fixture
def springs(load, user_group, bound):
    """Two springs of stiffness 10 in a row, on three nodes."""
    group = user_group(np.array([[0, 1], [1, 2]]), ((0, 1), (1, 1)), properties=(10.0,))
    coordinates = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]])
    return bound(group, coordinates, load("spring.f"))


def test_residual_matrix_and_sums(springs, call):
    block, matrix = springs
    residual, u = np.zeros(3), np.array([0.0, 0.1, 0.3])
    report = block.evaluate(call, u, u, residual, matrix.data)
    np.testing.assert_allclose(residual, [1, 1, -2], rtol=1e-15)
    np.testing.assert_array_equal(matrix.toarray(), [[10, -10, 0], [-10, 20, -10], [0, -10, 10]])
    assert report.flux[0] == pytest.approx(1 + 1 + 2 + 2)
    assert report.flux_count.tolist() == [4, 0, 0, 0, 0]
    assert report.energy[1] == pytest.approx(0.5 * 10 * (0.1**2 + 0.2**2))


def test_state_variables_start_from_the_committed_ones(springs, call):
    block, matrix = springs
    residual, u = np.zeros(3), np.array([0.0, 0.1, 0.3])
    for _ in range(3):
        block.evaluate(call, u, u, residual, matrix.data)
    assert block.state(0).svars.ravel().tolist() == [0, 0]
    block.commit()
    np.testing.assert_allclose(block.state(0).svars.ravel(), [0.1, 0.2], rtol=1e-15)
