# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The local solves: how many steps they take."""

import ctypes

import numpy as np
import pytest

SOURCES = (
    *("core/kinds", "core/limit", "core/status", "core/root", "core/small_matrix"),
    *("law_properties", "cohesive/parameters", "cohesive/shear"),
    "cohesive/state",
    *("cohesive/mode_mix", "cohesive/bilinear", "cohesive/exponential", "cohesive/multilinear", "cohesive/ppr"),
    *("cohesive/fatigue", "cohesive/rate", "cohesive/law", "cohesive/friction", "cohesive/local_equation"),
    *("cohesive/fatigue_local_solve", "cohesive/ppr_local_solve", "cohesive/local_solve"),
)


@pytest.fixture(scope="module")
def solves(compiled):
    """The compiled `local_solve_steps`."""
    return compiled("local_solve_steps", SOURCES).local_solve_steps


@pytest.mark.parametrize("law, mean, most", [(1, 3.0, 20), (2, 3.0, 20), (3, 5.0, 20), (5, 3.0, 20), (6, 3.0, 20)])
def test_steps_of_the_local_solve(solves, law, mean, most):
    """A bilinear law is a straight line in x where beta is the same in both modes: Newton's method lands on the root.

    One of several lines is straight between its corners.

    The bounds leave room above what a count over 1e6 states gave once a step onto the root was kept: 2.2 and 3.9.
    """
    count, rng = 20000, np.random.default_rng(1)
    angles = rng.uniform(0, np.pi / 2, count)
    trials = rng.uniform(0, 300, count)[:, None] * np.column_stack([np.sin(angles), np.cos(angles), 0 * angles])
    histories = rng.choice([0.0, 1.0], count) * rng.uniform(0, 1, count)
    beta = np.array([1e5, 1e5])
    found = [ctypes.c_int() for _ in range(4)]
    pointers = [array.ctypes.data_as(ctypes.c_void_p) for array in (np.ascontiguousarray(trials), histories, beta)]
    solves(law, count, *pointers, *map(ctypes.byref, found))
    searches, total, largest, unsolved = (number.value for number in found)
    assert searches > count / 4
    assert unsolved == 0
    assert total / searches <= mean, total / searches
    assert largest <= most
