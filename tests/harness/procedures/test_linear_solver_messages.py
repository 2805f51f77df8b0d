# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the message file says of the linear solver."""

from uel.procedures.step_setting import SolverTimes
from uel.solver.linear import Effort


def test_times_of_a_step() -> None:
    """Not those of the steps before it."""
    effort = Effort(5, 2, 0, 7, 0.25, 0.125)
    times = SolverTimes(effort)
    effort.factorisations += 46
    effort.in_part += 41
    effort.solutions += 61
    effort.factorising += 1.5
    effort.solving += 0.125
    said = (
        "LINEAR SOLVER: 46 FACTORISATIONS, 41 ONLY WHERE THE MATRIX HAD CHANGED{}, CPU TIME (SEC) = 1.5; "
        "61 SOLUTIONS, CPU TIME (SEC) = 0.125"
    )
    assert times.note().message == said.format("")
    effort.refused += 1
    assert times.note().message == said.format(", 1 OF WHICH HAD TO BE REPEATED IN FULL")
