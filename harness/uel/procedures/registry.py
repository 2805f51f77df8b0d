# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Registry of the runs of steps: the only file that depends on the procedure of a step.

It assembles a general step from a path and parts. A new procedure is registered like those below.
"""

from __future__ import annotations

from functools import singledispatch

from uel.model.perturbations import (
    Buckle,
    Frequency,
    ModalDynamic,
    ModalSteadyState,
    StaticPerturbation,
    SteadyState,
    SubspaceSteadyState,
)
from uel.model.procedures import Diffusive, Dynamic, Geostatic, Procedure, Static, Visco
from uel.procedures.context import StepContext
from uel.procedures.general.diffusive import LimitedChange
from uel.procedures.general.dynamic import ImplicitIntegration
from uel.procedures.general.increments import GeneralStep
from uel.procedures.general.load_factor import EnergyPath, RiksPath
from uel.procedures.general.path import TimePath
from uel.procedures.general.stabilized import ViscousForces
from uel.procedures.general.step_parts import Part
from uel.procedures.general.visco import ViscousStrain
from uel.procedures.linear.buckle import BuckleStep
from uel.procedures.linear.frequency import FrequencyStep
from uel.procedures.linear.modal import ModalDynamicStep
from uel.procedures.linear.perturbation import PerturbationStep
from uel.procedures.linear.steady_state import ModalSteadyStateStep, SteadyStateStep, SubspaceSteadyStateStep
from uel.procedures.step_setting import Setting, StepRun


@singledispatch
def run_of(procedure: Procedure, setting: Setting) -> StepRun:
    """Return the run of a step of this procedure; `run_of.register` adds that of another class.

    Parameters
    ----------
    procedure
        Procedure of the step; its class chooses the run.
    setting
        System, model and state of the run. The state takes over the step's prescribed values and loads.

    Returns
    -------
    StepRun
        Its `run` yields the records of the step.

    Raises
    ------
    DeckError
        The procedure does not support an option of the step, or the step is over-constrained.
    TypeError
        Nothing is registered for the class.
    """
    raise TypeError(f"no run is registered for {type(procedure).__name__}")


@run_of.register
def _(procedure: Static | Visco | Geostatic, setting: Setting) -> StepRun:
    if procedure.riks is not None:
        context = StepContext(setting)
        return GeneralStep(context, RiksPath(context, procedure.riks))
    if setting.solver.energy_control:
        context = StepContext(setting)
        return GeneralStep(context, EnergyPath(context))
    context = StepContext(setting, fallback=setting.solver.fallback)
    parts = (ViscousStrain(context, procedure.tolerance),) if isinstance(procedure, Visco) else ()
    return _in_time(context, *parts, fallback=setting.solver.fallback)


@run_of.register
def _(procedure: Dynamic, setting: Setting) -> StepRun:
    context = StepContext(setting)
    return _in_time(context, ImplicitIntegration(context, procedure))


@run_of.register
def _(procedure: Diffusive, setting: Setting) -> StepRun:
    context = StepContext(setting, fallback=setting.solver.fallback)
    return _in_time(context, LimitedChange(context, procedure), fallback=setting.solver.fallback)


@run_of.register
def _(_: StaticPerturbation, setting: Setting) -> StepRun:
    return PerturbationStep(setting)


@run_of.register
def _(procedure: Frequency, setting: Setting) -> StepRun:
    return FrequencyStep(setting, procedure)


@run_of.register
def _(procedure: Buckle, setting: Setting) -> StepRun:
    return BuckleStep(setting, procedure)


@run_of.register
def _(procedure: SteadyState, setting: Setting) -> StepRun:
    return SteadyStateStep(setting, procedure)


@run_of.register
def _(procedure: SubspaceSteadyState, setting: Setting) -> StepRun:
    return SubspaceSteadyStateStep(setting, procedure)


@run_of.register
def _(procedure: ModalSteadyState, setting: Setting) -> StepRun:
    return ModalSteadyStateStep(setting, procedure)


@run_of.register
def _(procedure: ModalDynamic, setting: Setting) -> StepRun:
    return ModalDynamicStep(setting, procedure)


def _in_time(context: StepContext, *parts: Part, fallback: bool = False) -> GeneralStep:
    """Build a step of time increments, with damping if it has STABILIZE."""
    damping = context.step.procedure.stabilize
    if damping is not None:
        parts = (*parts, ViscousForces(context, damping))
    return GeneralStep(context, TimePath(context, parts, fallback=fallback), parts)
