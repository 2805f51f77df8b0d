# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Restart: resume the step of a kept state.

A kept state has no prescribed values, loads and amplitudes: these follow from the deck, the total times at which steps
began, and the state at the start of the last one.
"""

from __future__ import annotations

import numpy as np

from uel.assembly import System
from uel.errors import UelError
from uel.model.model import Model
from uel.model.restart import Resumption
from uel.procedures.general.increments import GeneralStep
from uel.procedures.registry import run_of
from uel.procedures.state import ARRAYS, BegunStep, ConvergedState
from uel.procedures.step_setting import Setting, UserRoutines
from uel.solver.options import SolverOptions

ANOTHER_MODEL = "{0}: the state of the old job is of another model: {1} differ"


def resume(
    resumed: Resumption, system: System, model: Model, state: ConvergedState, user: UserRoutines, solver: SolverOptions
) -> GeneralStep:
    """Resume the step of a kept state, after a call of UEXTERNALDB with LOP=4.

    Parameters
    ----------
    resumed
        The kept state.
    system, model, state
        System, model and state at the start of the analysis; system and state are changed.
    user, solver
        As for `run_steps`.

    Returns
    -------
    GeneralStep
        The step, after the increment of the state.

    Raises
    ------
    UelError
        The state belongs to another model, or a user routine ends the analysis.
    """
    saved = resumed.analysis
    for name in ARRAYS:
        if not np.isfinite(saved["state"][name]).all():
            raise UelError(f"{resumed.file}: the state of the old job holds numbers that are not finite: {name}")
    step = model.steps[saved["step"] - 1]
    begun = [BegunStep(*one) for one in saved["state"]["begun"]]
    times = saved["step_time"], saved["state"]["total_time"]
    user.external_database(4, 0, times, 0.0, saved["step"], saved["increment"])
    try:
        system.resume(saved["system"])
        for one in begun[:-1]:
            state.repeat(model.steps[one.number - 1], one, user)
        state.return_to(saved["beginning"], begun[-1].total_time)
        if not step.procedure.inertia:
            state.come_to_rest()
        # only steps in time without a search keep states
        in_time = SolverOptions(linear_solver=solver.linear_solver)
        running = run_of(step.procedure, Setting(system, model, step, state, user, in_time))
        assert isinstance(running, GeneralStep)
        running.resume(saved)
    except ValueError as error:
        raise UelError(ANOTHER_MODEL.format(resumed.file, error)) from None
    return running
