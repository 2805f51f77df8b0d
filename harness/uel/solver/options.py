# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Options of a job for solving the equations."""

from __future__ import annotations

from dataclasses import dataclass

from uel.errors import UsageError


@dataclass(frozen=True, slots=True, kw_only=True)
class SolverOptions:
    """Options for solving the equations of a job; the defaults are those of Abaqus.

    Parameters
    ----------
    linear_solver
        Linear solver, see `uel solvers`.
    fallback
        Descent search where Newton's method fails, before the increment is cut back; Abaqus has no such option.
    energy_control
        Trace snap-backs: an increment ends where it has dissipated a given energy, and the load factor of a step is
        part of the solution. Not with `fallback`, which prescribes the load.

    Raises
    ------
    UsageError
        Both `fallback` and `energy_control` are true.
    """

    linear_solver: str = "auto"
    fallback: bool = False
    energy_control: bool = False

    def __post_init__(self) -> None:
        if self.fallback and self.energy_control:
            raise UsageError("fallback keeps the load, which energy_control looks for: expected one of them")
