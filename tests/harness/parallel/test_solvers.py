# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The linear solvers of several ranks against dense algebra."""

import json
from pathlib import Path

import pytest
from mpiexec import NEEDED, installed, run

pytestmark = NEEDED

NEEDS = {"substructures": "mkl", "cluster": "mkl", "petsc": "petsc4py"}
"""Distribution that each solver of all ranks needs."""
TOGETHER = [name for name, needed in NEEDS.items() if installed(needed)]
SINGULAR = {"an unknown without stiffness": "of 4", "free": "of "}
"""Systems, and the unknown in the message."""
ROUNDING = 1e-12
"""Of the solution; the condition number is below 1e3."""


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """What each solver does with each system on three ranks, of which the first and the last share nothing."""
    words = [Path(__file__).with_name("solve_on_ranks.py"), *TOGETHER, "superlu"]
    code, output, errors = run(3, words, tmp_path_factory.mktemp("systems"))
    assert (errors, code) == ("", 0)
    return json.loads(output)


def test_solutions_of_dense_algebra(found):
    for name, systems in found.items():
        for title, end in systems.items():
            assert end["solver"] == name
            assert title in SINGULAR or end["error"] < ROUNDING, (name, title)


def test_ranks_without_a_change_keep_their_factors(found):
    titles = "symmetric, then changed on the last rank", "symmetric, then unsymmetric"
    counts = {name: [found[name][title]["in part"] for title in titles] for name in TOGETHER}
    assert counts == {name: [1, 0] if name == "substructures" else [0, 0] for name in TOGETHER}


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[] if name in TOGETHER else pytest.mark.skip(f"{NEEDS[name]} is not installed"))
        for name in NEEDS
    ],
)
def test_rank_0_takes_over_singular_matrices(found, name):
    assert [title for title, end in found[name].items() if end["refused"]] == list(SINGULAR)


@pytest.mark.parametrize(("title", "unknown"), SINGULAR.items())
def test_free_unknowns_are_named(found, title, unknown):
    for systems in found.values():
        assert f"singular system matrix at node {unknown}" in systems[title]["singular"]
