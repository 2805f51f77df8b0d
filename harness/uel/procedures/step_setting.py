# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Setting of the run of a step, and the interface of the run."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from uel.assembly import Constraints, DofMap, System
from uel.model.arrays import FloatArray, IntArray
from uel.model.dofs import dof_in_deck
from uel.model.model import Model
from uel.model.records import Noted, Record
from uel.model.steps import Step
from uel.model.user_values import GivesValues, UserValues
from uel.procedures.linear.modes import Modes
from uel.procedures.state import ConvergedState
from uel.solver.linear import Effort, LinearSolver, Pattern, RankSolver, StepSolver, choose
from uel.solver.options import SolverOptions


class UserRoutines(GivesValues, Protocol):
    """User routines that procedures call.

    sdvini, sigini, orient  addresses, None without the routine
    """

    sdvini: int | None
    sigini: int | None
    orient: int | None

    def external_database(
        self, lop: int, lrestart: int, time: tuple[float, float], dtime: float, step: int, increment: int
    ) -> None:
        """Call UEXTERNALDB if there is one."""


@dataclass(frozen=True, slots=True)
class Setting:
    """Setting of the run of a step.

    state  state at the end of the last step, from which this one continues
    """

    system: System
    model: Model
    step: Step
    state: ConvergedState
    user: UserRoutines
    solver: SolverOptions


class StepRun(Protocol):
    """Run of a step."""

    @property
    def reached(self) -> tuple[tuple[float, float], float, int, int]:
        """Step and total time, no time increment, step and increment, as UEXTERNALDB gets them at the end."""

    def run(self) -> Generator[Record, None, Modes | None]:
        """Run the step, yield its records, and return modes for later steps if it computes any.

        Raises ConvergenceError, KernelError, SingularMatrixError, DeckError.
        """


def choose_solver(name: str, constraints: Constraints, effort: Effort) -> LinearSolver:
    """Return the linear solver for the matrices of free unknowns; name as `uel.solver.linear.choose` takes it.

    effort: the solver adds its work to it.
    """
    solver = choose(
        name,
        constraints.reduced_indptr,
        constraints.reduced_indices,
        coordinates=constraints.coordinates,
        name_of=constraints.name_of,
    )
    solver.effort = effort
    return solver


def choose_step_solver(
    name: str,
    constraints: Constraints,
    effort: Effort,
    wrap: Callable[[LinearSolver], StepSolver] = lambda chosen: chosen,
) -> StepSolver:
    """Choose the solver of a general step as `choose_solver` does, on all ranks; wrap: wraps that linear solver."""
    if constraints.ranks.size == 1:
        return wrap(choose_solver(name, constraints, effort))
    indptr, indices = constraints.reduced_indptr, constraints.reduced_indices
    pattern = Pattern(indptr, indices, constraints.coordinates, constraints.dofs)
    return RankSolver(constraints.ranks, name, pattern, constraints.name_of, effort, wrap)


def displaced_coordinates(dofs: DofMap, nodes: IntArray, displacement: FloatArray | None) -> FloatArray:
    """Return coordinates (k, 3) of nodes, displaced by u (n,) unless it is None."""
    coordinates = dofs.mesh.coordinates[nodes]
    if displacement is None:
        return coordinates
    unknowns = dofs.find(nodes[:, None], np.arange(1, 4))
    return coordinates + np.where(unknowns >= 0, displacement[unknowns], 0.0)


def call_disp(
    user: GivesValues,
    dofs: DofMap,
    unknowns: IntArray,
    values: FloatArray,
    moment: tuple[int, int, tuple[float, float]],
    size: float,
    displacement: FloatArray | None,
) -> FloatArray:
    """Call DISP and return the values (k,) of prescribed unknowns at the end of an increment.

    Parameters
    ----------
    unknowns, values
        (k,) prescribed unknowns, and their values by magnitude and amplitude.
    moment
        Step, increment, and step and total time at its end.
    size
        Increment of time.
    displacement
        (n,) displacements that are added to the coordinates; None: original coordinates.
    """
    nodes = dofs.node[unknowns]
    numbers = np.stack([dofs.mesh.labels[nodes], [dof_in_deck(dof) for dof in dofs.dof[unknowns].tolist()]], axis=1)
    coords = displaced_coordinates(dofs, nodes, displacement)
    return user.user_values(UserValues("DISP", *moment, numbers.astype(np.int32), coords, values, size=size))


class SolverTimes:
    """Times of the linear solver from now on, for a step."""

    def __init__(self, effort: Effort) -> None:
        self._effort, self._before = effort, replace(effort)

    def note(self) -> Noted:
        """Return the times since the start, for the message file."""
        done = self._effort - self._before
        refused = f", {done.refused} OF WHICH HAD TO BE REPEATED IN FULL" if done.refused else ""
        return Noted(
            f"LINEAR SOLVER: {done.factorisations} FACTORISATIONS, {done.in_part} ONLY WHERE THE MATRIX HAD CHANGED"
            f"{refused}, CPU TIME (SEC) = {done.factorising:.3G}; {done.solutions} SOLUTIONS, "
            f"CPU TIME (SEC) = {done.solving:.3G}"
        )
