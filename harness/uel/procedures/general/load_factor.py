# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Paths of static steps whose load factor is unknown: *STATIC, RIKS, and energy control.

The load factor (LPF) is 0 at the start of the step and 1 at the loads and displacements that it prescribes: these are
P_0 + LPF (P_ref - P_0). The length of the path replaces time in the sizes of increments and in the arguments of
elements.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from uel.errors import DeckError
from uel.model.arrays import FloatArray
from uel.model.procedures import Riks
from uel.model.records import FieldCheck, Noted, Record
from uel.model.steps import Boundary, ElementLoad, Load
from uel.procedures.context import StepContext
from uel.procedures.general.incrementation import IncrementControl
from uel.procedures.general.path import Path, Reached
from uel.procedures.loads.element_loads import FactorTimes
from uel.solver.energy_control import Dissipation
from uel.solver.newton import DependentLoads, Iterate
from uel.solver.path import Control, PathFollower, PathIncrement, PathIterate
from uel.solver.riks import ArcLength

EXTRAPOLATED = 0.01
"""Fraction of the last increment with which an increment starts, so that elements get a direction."""

ROUNDING = 1e-12
"""Difference from 1 below which a load factor is set to 1."""

NEARBY = 1e-4
"""Difference of the load factor for the derivative of loads by DLOAD, exact if they are proportional to it."""

REMAINDER = 1e-6
"""Remainder of the load factor over an increment that is added to it."""


class LoadFactorPath(Path):
    """Increments along a path on which the load factor is one more unknown.

    nrhs   NRHS of its passes
    scale  step time at LPF = 1
    """

    nrhs = 1
    scale = 1.0

    def __init__(self, context: StepContext) -> None:
        """Start the path. Raises DeckError if loads or prescribed values have amplitudes."""
        step, state = context.step, context.state
        super().__init__(context, IncrementControl(replace(step.procedure, period=math.inf), step.controls.time))
        _check(context)
        self._follower = PathFollower(context.system, context.constraints, context.solver)
        period = step.procedure.period
        self._u_ref = (context.prescribed.at(period, 0.0) - state.displacement)[context.unknowns]
        # the load of the state includes loads by DLOAD
        start = context.load.at(0.0, 0.0) if context.load.by_user else state.load
        self._loads = start, context.load.at(period, 0.0)
        self._fading = context.released.at(0.0, 0.0), context.released.at(period, 0.0)
        self._factor, self._length = 0.0, 0.0
        self._on_elements = context.load.by_user or context.load.follower or context.conditions.loaded
        self._last: tuple[FloatArray, float, float] | None = None

    @abstractmethod
    def _control_of(self, increment: PathIncrement, size: float) -> Control:
        """Return the equation that fixes the load factor in an increment."""

    def begin(self, size: float) -> tuple[Iterator[Iterate], bool]:
        """Begin at the start state, or a little further in the direction of the last increment."""
        context, guess = self._context, None
        if self._last is not None:
            du, lam, length = self._last
            part = EXTRAPOLATED * size / length
            guess = part * du, part * lam
        elif self._on_elements:
            # the change of these loads gives the load per unit of the factor
            guess = np.zeros_like(context.state.displacement), EXTRAPOLATED * size / context.step.procedure.period
        end = self._length + size
        context.load.increment = context.increment
        load, released = self._loads_at(self._factor)
        increment = PathIncrement(
            call=context.call(size, end, context.start + end),
            u=context.state.displacement,
            guess=guess,
            f_ext=load + released,
            f_ref=self._loads[1] - self._loads[0] + self._fading[1] - self._fading[0],
            u_ref=self._u_ref,
            dependent=partial(self._dependent_loads, context.start + end) if self._on_elements else None,
            nrhs=self.nrhs,
        )
        return self._follower.iterates(increment, self._control_of(increment, size)), guess is not None

    def _dependent_loads(self, total_time: float, u: FloatArray, lam: float) -> DependentLoads:
        """Return loads on elements, follower loads and loads by DLOAD, at displacements u (n,).

        lam  change of the load factor in the increment
        """
        context, period, load = self._context, self._context.step.procedure.period, self._context.load
        before, after = self._factor, self._factor + lam
        times = (before * period, context.state.total_time), (after * period, total_time)
        others = context.conditions.distributed(*times)
        if not load.by_user:
            return DependentLoads(np.zeros_like(u), load.with_faces(others, *times, u))
        # DLOAD gets the load factor instead of the step time; its loads need not be proportional to it
        nearby = load.by_dload((after - NEARBY, total_time), u)
        distributed = load.with_faces(others, *times, u, FactorTimes(after, NEARBY, lam))
        f_ext = load.by_dload((after, total_time), u)
        return DependentLoads(f_ext, distributed, lam / NEARBY * (f_ext - nearby))

    def _loads_at(self, factor: float) -> tuple[FloatArray, FloatArray]:
        """Return loads and fading forces (n,) at a load factor."""
        (load, full), (released, rest) = self._loads, self._fading
        return load + factor * (full - load), released + factor * (rest - released)

    def reach(self, last: Iterate, size: float, checks: Sequence[FieldCheck]) -> Reached:
        """Update the load factor and the length of the path."""
        assert isinstance(last, PathIterate)
        self._last = last.du, last.lam, size
        self._factor += last.lam
        if abs(self._factor - 1.0) < ROUNDING:
            self._factor = 1.0
        self._length += size
        self._context.step_time = step_time = self._factor * self.scale
        load, released = self._loads_at(self._factor)
        if self._context.load.by_user:
            time = self._factor, self._context.start + self._length
            load = load + self._context.load.by_dload(time, self._context.state.displacement + last.du)
        change = last.lam * self.scale
        return Reached(load, released, step_time, self._context.start + self._length, change, self._factor)


def _check(context: StepContext) -> None:
    """Raise DeckError if loads or prescribed values are not proportional to the load factor."""
    step = context.step
    entries: tuple[Boundary | Load | ElementLoad, ...]
    entries = (*step.boundaries, *step.loads, *step.element_loads, *step.surface_loads)
    source = next((entry.source for entry in entries if entry.amplitude), step.source)
    if context.prescribed.curves or context.load.curves or context.amplitudes.curves:
        raise DeckError(source, "an amplitude has no meaning in a step whose load factor is part of the solution")
    if len(context.state.boundaries.by_user):
        # TIME of DISP has no load factor (User Subroutines Guide)
        raise DeckError(step.source, "DISP has no meaning in a step whose load factor is unknown")


class RiksPath(LoadFactorPath):
    """Path of *STATIC, RIKS. A step without a limit ends with its last increment."""

    nrhs = 2

    def __init__(self, context: StepContext, riks: Riks) -> None:
        super().__init__(context)
        self._riks = riks
        self._arc = ArcLength(context.system.dofs.of_nodes)
        self._monitored = -1
        if riks.node >= 0:
            dofs = context.system.dofs
            self._monitored = int(dofs.find(riks.node, riks.dof))
            if self._monitored < 0:
                name = dofs.mesh.name(riks.node)
                raise DeckError(
                    context.step.source,
                    f"*STATIC, RIKS: no element uses dof {riks.dof} of node {name}, which is to end the step",
                )
        self._crossed = False

    @property
    def finished(self) -> bool:
        """True if the limit of the step, or its last increment, is reached."""
        if self._crossed:
            return True
        endless = self._riks.largest_factor is None and self._monitored < 0
        return endless and self._context.increment == self._context.step.increments

    def _control_of(self, increment: PathIncrement, size: float) -> Control:
        self._arc.length = size / self._context.step.procedure.period
        return self._arc

    def reach(self, last: Iterate, size: float, checks: Sequence[FieldCheck]) -> Reached:
        """Return the end of the increment, and note whether it crosses the limit of the step."""
        before = self._context.state.displacement
        reached = super().reach(last, size, checks)
        assert reached.load_factor is not None
        self._arc.converged(last.du, reached.size)
        largest = self._riks.largest_factor
        self._crossed = largest is not None and reached.load_factor >= largest
        if self._monitored >= 0:
            u = float(before[self._monitored])
            remaining, change = self._riks.value - u, float(last.du[self._monitored])
            self._crossed = self._crossed or (change != 0.0 and 0.0 <= remaining / change <= 1.0)
        return reached


class EnergyPath(LoadFactorPath):
    """Path of energy control, up to LPF = 1; sizes of increments are those of *STATIC."""

    def __init__(self, context: StepContext) -> None:
        super().__init__(context)
        if self._on_elements:
            message = "loads on user elements, those that follow the surface and those of DLOAD are not supported"
            raise DeckError(context.step.source, f"{message} with --control energy")
        self.scale = context.step.procedure.period
        self._energy = Dissipation(context.constraints)

    def start(self) -> Iterable[Record]:
        """Return a note on the control of the step."""
        yield Noted("ENERGY CONTROL: THE STEP TIME FOLLOWS FROM THE DISSIPATED ENERGY AND FALLS IN SNAP-BACKS")

    @property
    def finished(self) -> bool:
        """True if the full load is reached."""
        return self._factor >= 1.0

    def _control_of(self, increment: PathIncrement, size: float) -> Control:
        state, share, left = self._context.state, size / self.scale, 1.0 - self._factor
        if share < left <= share * (1.0 + REMAINDER):
            share = left
        self._energy.start(increment, state.external, state.reaction, size=share, left=left)
        return self._energy
