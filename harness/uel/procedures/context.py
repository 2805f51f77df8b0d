# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Context of a general step, shared by its path and parts: prescribed values, loads, constraints, checks, calls."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from uel.assembly import Constraints, RotatingConstraints
from uel.elements import Call, Flags
from uel.errors import DeckError
from uel.model.arrays import FloatArray, IntArray
from uel.procedures.general.convergence_checks import Checker, length_of_moments
from uel.procedures.general.unconstrained import UnconstrainedSolver
from uel.procedures.step_setting import (
    Setting,
    SolverTimes,
    call_disp,
    choose_solver,
    choose_step_solver,
    displaced_coordinates,
)
from uel.solver.linear import LinearSolver, StepSolver
from uel.solver.newton import DependentLoads


class StepContext:
    """Data of a general step that do not depend on its procedure.

    start       total time at the start of the step
    step_time   step time at the start of the increment; the total time is in the state
    increment   number of the current increment
    times_of_solver  times of the linear solver in this step
    beginning   arrays of the state at the start of the step, on which its prescribed values and loads depend
    choice      name of the linear solver and reason for it; '' if that of the last step is kept
    advice      sentence that names a faster solver; '' if there is none
    """

    constraints: Constraints
    solver: StepSolver

    def __init__(self, setting: Setting, *, fallback: bool = False) -> None:
        """Begin the step with its prescribed values and loads; symbolic work is repeated only if these differ.

        Raises DeckError.
        """
        self.system, self.step, self.state, self.user = setting.system, setting.step, setting.state, setting.user
        system, step, state, user = self.system, self.step, self.state, self.user
        self.beginning = {name: getattr(state, name) for name in ("displacement", "reaction", "unbalanced")}
        begun = state.begin_step(step, system.dofs, user)
        self.prescribed, self.load, self.released = begun.values, begun.loads, begun.released
        self.conditions, self.amplitudes = begun.conditions, begun.amplitudes
        if len(state.boundaries.by_user) and user.disp is None:
            source = state.boundaries.sources[int(state.boundaries.by_user[0])]
            raise DeckError(source, "*BOUNDARY, USER needs DISP, which the job does not have")
        for field in step.fields:
            routine, address = ("UFIELD", user.ufield) if field.dof else ("UTEMP", user.utemp)
            if field.user and address is None:
                keyword = "FIELD" if field.dof else "TEMPERATURE"
                raise DeckError(field.source, f"*{keyword}, USER needs {routine}, which the job does not have")
        self.choice = self.advice = ""
        self.times_of_solver = SolverTimes(state.effort)
        self._constrain(setting, fallback=fallback)
        length = length_of_moments(system, setting.model.mesh)
        self.checker = Checker(
            system.dofs, self.constraints, step.controls, state.flux, length, convert=step.convert_sdi
        )
        self.solver.negligible = self.checker.negligible_force
        self.start, self.step_time, self.increment = state.total_time, 0.0, 0

    def _constrain(self, setting: Setting, *, fallback: bool) -> None:
        """Set the constraints and the linear solver of the step, reusing those of the last one if they match."""
        state, equations = self.state, setting.model.equations
        arms = setting.model.arms if self.step.nlgeom else ()
        constraints, solver, start = state.constraints, state.solver, self.beginning["displacement"]
        if constraints is None or solver is None or not constraints.matches(self.unknowns, equations, arms, start):
            arguments = self.system, self.unknowns, equations, state.boundaries.sources
            constraints = RotatingConstraints(*arguments, arms, start) if arms else Constraints(*arguments)
            choose = partial(choose_step_solver, setting.solver.linear_solver, constraints, state.effort)
            if solver is not None:
                solver.release()
            tolerant = partial(UnconstrainedSolver, renew=_renewing(setting, constraints))
            # the descent search handles a singular matrix itself
            solver = choose() if fallback else choose(tolerant)
            self.advice = solver.advice
            self.choice = f"LINEAR SOLVER {solver.name.upper()}: {solver.reason}"
            state.majoriser.use(self.system, constraints, choose)
        self.constraints, self.solver = constraints, solver
        state.use(constraints, solver)

    @property
    def unknowns(self) -> IntArray:
        """Prescribed unknowns."""
        return self.state.boundaries.unknowns

    @property
    def times(self) -> tuple[float, float]:
        """Step and total time at the start of the increment."""
        return self.step_time, self.state.total_time

    def load_at(self, step_time: float, u: FloatArray | None = None) -> FloatArray:
        """Return loads and fading forces (n,); loads by DLOAD at displacements u (n,), by default the state's."""
        return self.loads_at(step_time, u) + self.released.at(step_time, self.start + step_time)

    def loads_at(self, step_time: float, u: FloatArray | None = None) -> FloatArray:
        """Return the loads (n,) without fading forces, as in `load_at`."""
        time = step_time, self.start + step_time
        steady = self.load.at(*time)
        return steady + self.load.by_dload(time, self._at(u)) if self.load.by_user else steady

    def steady_at(self, step_time: float) -> FloatArray:
        """Return loads and fading forces (n,) without loads by DLOAD."""
        total = self.start + step_time
        return self.load.at(step_time, total) + self.released.at(step_time, total)

    def _at(self, u: FloatArray | None) -> FloatArray:
        return self.state.displacement if u is None else u

    def dependent_loads(self, end: float, u: FloatArray) -> DependentLoads:
        """Return the loads by DLOAD and the loads on elements at a step time and displacements u (n,)."""
        time, start = (end, self.start + end), self.times
        on_elements = self.conditions.distributed(start, time)
        return DependentLoads(self.load.by_dload(time, u), self.load.with_faces(on_elements, start, time, u))

    def prescribed_at(self, step_time: float) -> FloatArray:
        """Return the prescribed values (n,), including those by DISP."""
        time = step_time, self.start + step_time
        values, by_user = self.prescribed.at(*time), self.state.boundaries.by_user
        if len(by_user):
            moment, size = (self.step.number, self.increment, time), step_time - self.step_time
            dofs, u = self.system.dofs, self._displacement
            values[by_user] = call_disp(self.user, dofs, by_user, values[by_user], moment, size, u)
        return values

    def coordinates(self, nodes: IntArray) -> FloatArray:
        """Return coordinates (k, 3) of nodes at the start of the increment; with NLGEOM those of displaced nodes."""
        return displaced_coordinates(self.system.dofs, nodes, self._displacement)

    @property
    def _displacement(self) -> FloatArray | None:
        """Displacements (n,) for the coordinates of user routines; None: original coordinates, without NLGEOM."""
        return self.state.displacement if self.step.nlgeom else None

    def call(self, size: float, step_time: float, total_time: float, u: FloatArray | None = None) -> Call:
        """Return the arguments of the passes of an increment that ends at these times; u as in `load_at`."""
        step, end = self.step, (step_time, total_time)
        distributed, predefined = self.conditions.at(
            self.times, end, max(self.increment, 1), self.user, self.coordinates
        )
        return Call(
            flags=Flags.of(step),
            step=step.number,
            # calls before the first increment count as part of it
            increment=max(self.increment, 1),
            step_time=step_time,
            total_time=total_time,
            time_increment=size,
            period=step.procedure.period,
            params=step.procedure.params,
            unsymmetric=step.procedure.unsymmetric,
            distributed=self.load.with_faces(distributed, self.times, end, self._at(u)),
            predefined=predefined,
            flux_floor=self.checker.flux_floor,
            load_terms=self.load.terms(end, self.checker.flux_floor),
        )


def _renewing(setting: Setting, constraints: Constraints) -> Callable[[], LinearSolver | None]:
    """Return a function that chooses another linear solver if the pattern of the constraints has changed."""
    pattern = constraints.reduced_indices

    def renew() -> LinearSolver | None:
        nonlocal pattern
        if pattern is constraints.reduced_indices:
            return None
        pattern = constraints.reduced_indices
        return choose_solver(setting.solver.linear_solver, constraints, setting.state.effort)

    return renew
