# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Units, numbers of nodes and elements, and threads of BLAS do not change results: the short form, and what it sees."""

import subprocess
import sys
from dataclasses import replace

import invariances
import numpy as np
import pytest


@pytest.fixture
def case(tmp_path):
    return {case.name: case for case in invariances.cases(tmp_path)}.__getitem__


SHORT = ("delamination, user elements", "dynamic", "frequency", "large displacements", "coupled", "heat, user elements")
QUICK = "frequency"


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.long] * (name != QUICK)) for name in SHORT])
def test_units_numbers_and_threads(case, tmp_path, name):
    rows = list(invariances.examine(case(name), tmp_path / "runs", seeds=1, threads=(2,)))
    assert len(rows) == 5
    assert [row for row in rows if row[1] > row[2]] == []


@pytest.mark.parametrize("name", [*SHORT[:2], "delamination, COH2D4"])
def test_units_of_powers_of_two_change_no_bit(case, tmp_path, name):
    """What is left of a difference then is an absolute tolerance, not rounding."""
    units = invariances.Units("2^-10 of it", 2.0**-10, 2.0**10, 2.0**4)
    one, other = (
        invariances.solve(case(name), tmp_path / f"run{k}", u) for k, u in enumerate((invariances.SAME, units))
    )
    assert invariances.difference(case(name), one, other, units) == 0.0


def test_differences_are_seen(case, tmp_path):
    beam = case("large displacements")
    one = invariances.solve(beam, tmp_path / "one")
    assert invariances.difference(beam, one, one) == 0.0
    assert invariances.same_bits(one, one)
    moved = one.displacement.copy()
    moved[0, 0] += 1e-9 * np.abs(moved).max()
    other = replace(one, displacement=moved)
    assert invariances.difference(beam, one, other) == pytest.approx(1e-9)
    assert not invariances.same_bits(one, other)
    assert invariances.difference(beam, one, replace(one, iterations=(*one.iterations, 1))) == np.inf
    wrong = invariances.Units("a length that is not what it says", 1e-3, 1.0, 1.0)
    assert invariances.difference(beam, one, one, wrong) > 1.0


@pytest.mark.long
def test_command():
    command = [sys.executable, invariances.__file__, "--seeds", "1", "heat"]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
    assert len(result.stdout.splitlines()) == 7
    assert "in mm, kg, ms (GPa)" in result.stdout
