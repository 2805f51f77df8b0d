# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Linear solvers: LAPACK's band solver, PARDISO, MUMPS, SuperLU."""

from harness.solver.linear.base import Effort, LinearSolver
from harness.solver.linear.choice import Availability, available, choose

__all__ = ["Availability", "Effort", "LinearSolver", "available", "choose"]
