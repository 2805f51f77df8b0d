# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""From elements to a system of equations: numbering, sparsity, scatter, constraints."""

from harness.assembly.constraints import Constraints
from harness.assembly.dofs import DofMap
from harness.assembly.system import Evaluation, System
from harness.assembly.tolerant import TolerantSystem
from harness.assembly.turning import TurningConstraints

__all__ = ["Constraints", "DofMap", "Evaluation", "System", "TolerantSystem", "TurningConstraints"]
