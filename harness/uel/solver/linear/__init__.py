# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Linear solvers: LAPACK's band solver, PARDISO, MUMPS, SuperLU; several ranks together."""

from uel.solver.linear.choice import Availability, available, choose
from uel.solver.linear.linear_solver import Effort, LinearSolver, Pattern, StepSolver
from uel.solver.linear.rank_solver import RankSolver, with_ranks

__all__ = [
    "Availability",
    "Effort",
    "LinearSolver",
    "Pattern",
    "RankSolver",
    "StepSolver",
    "available",
    "choose",
    "with_ranks",
]
