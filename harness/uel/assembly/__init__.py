# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Assembly of elements to a system of equations: numbering, sparsity, scatter, constraints."""

from uel.assembly.constraints import Constraints
from uel.assembly.contributors import Contributors
from uel.assembly.dofs import DofMap
from uel.assembly.evaluation import Evaluation
from uel.assembly.linear_shortcut import LinearShortcut
from uel.assembly.rotating_constraints import RotatingConstraints
from uel.assembly.system import System, system_of
from uel.assembly.tolerant_system import TolerantSystem

__all__ = [
    "Constraints",
    "Contributors",
    "DofMap",
    "Evaluation",
    "LinearShortcut",
    "RotatingConstraints",
    "System",
    "TolerantSystem",
    "system_of",
]
