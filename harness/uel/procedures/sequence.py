# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Sequence of the steps of a model."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from uel.assembly import DofMap, System
from uel.elements import Call, Flags, Request
from uel.errors import ConvergenceError, SingularMatrixError
from uel.model.model import Model
from uel.model.records import Noted, Record, StepStarted, Warned
from uel.model.restart import Resumption
from uel.model.steps import Boundary, Load, Step
from uel.procedures.loads.initial_states import set_initial_states, set_initial_stresses
from uel.procedures.loads.nodal import find_unknowns
from uel.procedures.registry import run_of
from uel.procedures.resuming import resume
from uel.procedures.state import ConvergedState
from uel.procedures.step_setting import Setting, StepRun, UserRoutines
from uel.solver.options import SolverOptions


def run_steps(
    system: System,
    model: Model,
    user: UserRoutines,
    solver: SolverOptions = SolverOptions(),
    *,
    resumed: Resumption | None = None,
) -> Iterator[Record]:
    """Run all steps of a model, or those that follow a kept state.

    Parameters
    ----------
    system
        The assembled model, in its initial state.
    model
        Its steps, prescribed values and equations.
    user
        The loaded library of user routines: UEXTERNALDB is called at the start and end of the analysis, of each step
        and of each increment.
    solver
        Options for solving the equations.
    resumed
        Kept state to continue from; None: the initial state.

    Yields
    ------
    Record
        In chronological order; records that precede an error are yielded before it is raised.

    Raises
    ------
    ConvergenceError
        The attempts, the increments, or the smallest increment are exhausted.
    KernelError, SingularMatrixError, DeckError
        From the elements, the linear solver, and over-constrained models.
    UelError
        The kept state belongs to another model.
    """
    state = ConvergedState.start(system, model)
    running: StepRun | None = None
    following = model.steps
    if resumed is None:
        yield from _begin(system, model, state, user)
    try:
        if resumed is not None:
            step = model.steps[resumed.analysis["step"] - 1]
            running = general = resume(resumed, system, model, state, user, solver)
            following = model.steps[step.number :]
            if resumed.end_step or general.finished:
                general.end(early=not general.finished)
            else:
                yield StepStarted(step.number)
                yield from general.run()
                user.external_database(6, 0, *general.reached)
        for step in following:
            yield StepStarted(step.number)
            yield from _unused(system.dofs, "*BOUNDARY", step.boundaries)
            yield from _unused(system.dofs, "*CLOAD", step.loads)
            user.external_database(5, 0, (0.0, state.total_time), 0.0, step.number, 0)
            if step is model.steps[0]:
                _mass_pass(system, step)
            yield from map(Noted, step.notes)
            if not (step.procedure.inertia or step.procedure.linear):
                state.come_to_rest()
            setting = Setting(system, model, step, state, user, solver)
            running = run_of(step.procedure, setting)
            modes = yield from running.run()
            if modes is not None:
                state.keep_modes(modes)
            user.external_database(6, 0, *running.reached)
    except ConvergenceError:
        if running is not None:
            user.external_database(3, 0, *running.reached)
        raise
    except SingularMatrixError as error:
        raise error.in_step(step.source) from None
    if running is not None:
        user.external_database(3, 0, *running.reached)


def _begin(system: System, model: Model, state: ConvergedState, user: UserRoutines) -> Iterator[Record]:
    """Begin the analysis in the initial state of the model."""
    user.external_database(0, 0, (0.0, 0.0), 0.0, 1, 0)
    system.agree(lambda: set_initial_states(system.blocks, model, user))
    forces = yield from set_initial_stresses(system, model, state, user)
    if forces is not None:
        state.hold(forces)
    yield from _unused(system.dofs, "*BOUNDARY", model.boundaries)


def _mass_pass(system: System, step: Step) -> None:
    """Call user elements for the mass matrix, as Abaqus does at the start; the results are not used.

    The calls belong to increment 1, but no time passes.
    """
    procedure = step.procedure
    call = Call(
        # not a call of a linear step, even if the first step is linear
        replace(Flags.of(step, Request.MASS), linear=False),
        step=step.number,
        increment=1,
        step_time=0.0,
        total_time=0.0,
        time_increment=0.0,
        period=procedure.period,
        unsymmetric=procedure.unsymmetric,
    )
    zero = np.zeros(len(system))
    system.evaluate(call, zero, zero, matrix=False)


def _unused(dofs: DofMap, keyword: str, entries: Sequence[Boundary] | Sequence[Load]) -> Iterator[Warned]:
    """Warn of entries at degrees of freedom that no element uses, which have no effect."""
    for entry in entries:
        _, nodes = find_unknowns(dofs, entry)
        if len(nodes):
            others = f" and {len(nodes) - 1} more" if len(nodes) > 1 else ""
            name = dofs.mesh.name(int(nodes[0]))
            yield Warned(
                f"{entry.source}: {keyword} has no effect: no element uses dof {entry.dof} of node {name}{others}"
            )
