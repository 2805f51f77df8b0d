# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Static steps whose load factor is unknown: *STATIC, RIKS, and energy control.

The step goes from the state at its start, load factor (LPF) 0, to what it prescribes, LPF 1: forces and displacements
are P_0 + LPF (P_ref - P_0). The length of the path takes the place of time in the sizes of increments and in what
elements are told.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator
from dataclasses import replace

from harness.assembly import System
from harness.errors import DeckError
from harness.model.arrays import FloatArray
from harness.model.model import Model
from harness.model.records import Noted, Record
from harness.model.steps import Boundary, ElementLoad, Load, Step
from harness.procedures.incrementation import IncrementControl
from harness.procedures.state import State
from harness.procedures.static import Reached, StaticStep, UserRoutines
from harness.solver.arclength import ArcLength
from harness.solver.dissipation import Dissipation
from harness.solver.newton import Iterate
from harness.solver.path import Control, PathFollower, PathIncrement, PathIterate

EXTRAPOLATED = 0.01
"""Fraction of the last increment that an increment starts from: it tells the elements which way they go."""

ROUNDING = 1e-12
"""A load factor this close to 1 is 1."""

REMAINDER = 1e-6
"""A rest of the load factor below this fraction of an increment is joined to it."""


class PathStep(StaticStep):
    """One step along a path.

    nrhs   NRHS of its passes
    scale  step time at LPF = 1
    """

    nrhs = 1
    scale = 1.0

    def __init__(self, system: System, model: Model, step: Step, state: State, solver: str, user: UserRoutines) -> None:
        """Raises DeckError where an amplitude governs what the step prescribes."""
        super().__init__(system, model, step, state, solver, user)
        entries: tuple[Boundary | Load | ElementLoad, ...]
        entries = (*step.boundaries, *step.loads, *step.element_loads, *step.surface_loads)
        source = next((entry.source for entry in entries if entry.amplitude), step.source)
        if self._prescribed.curves or self._load.curves or self._amplitudes.courses:
            raise DeckError(source, "an amplitude has no meaning in a step whose load factor is part of the solution")
        if self._load.turning:
            message = (
                "pressures that turn with the surface (NLGEOM) are not supported in a step whose load factor is unknown"
            )
            raise DeckError(step.source, message)
        if len(state.boundaries.by_user) or self._load.by_user:
            raise DeckError(step.source, "DISP and DLOAD have no meaning in a step whose load factor is unknown")
        assert state.constraints is not None and state.solver is not None
        self._control = IncrementControl(replace(step.procedure, period=math.inf), step.controls.time)
        self._follower = PathFollower(system, state.constraints, state.solver)
        period, unknowns = step.procedure.period, state.boundaries.unknowns
        self._prescribed_rate = (self._prescribed.at(period, 0.0) - state.displacement)[unknowns]
        self._loads = state.load, self._load.at(period, 0.0)
        self._fading = self._released.at(0.0, 0.0), self._released.at(period, 0.0)
        self._factor, self._length = 0.0, 0.0
        self._last: tuple[FloatArray, float, float] | None = None

    @abstractmethod
    def _control_of(self, given: PathIncrement, size: float) -> Control:
        """What fixes the load factor in an increment."""

    @property
    def _times(self) -> tuple[float, float]:
        return self._time, self._start + self._length

    def _begin(self, increment: int, size: float) -> tuple[Iterator[Iterate], bool]:
        guess = None
        if self._last is not None:
            last, factor, length = self._last
            part = EXTRAPOLATED * size / length
            guess = part * last, part * factor
        end = self._length + size
        load, released = self._loads_at(self._factor)
        given = PathIncrement(
            call=self._call(increment, size, end, self._start + end),
            displacement=self._state.displacement,
            guess=guess,
            load=load + released,
            load_rate=self._loads[1] - self._loads[0] + self._fading[1] - self._fading[0],
            prescribed_rate=self._prescribed_rate,
            nrhs=self.nrhs,
        )
        return self._follower.iterates(given, self._control_of(given, size)), guess is not None

    def _loads_at(self, factor: float) -> tuple[FloatArray, FloatArray]:
        """Loads and fading reactions."""
        (load, full), (released, rest) = self._loads, self._fading
        return load + factor * (full - load), released + factor * (rest - released)

    def _reach(self, last: Iterate, size: float) -> Reached:
        assert isinstance(last, PathIterate)
        self._last = last.increment, last.factor, size
        self._factor += last.factor
        if abs(self._factor - 1.0) < ROUNDING:
            self._factor = 1.0
        self._length += size
        self._time = self._factor * self.scale
        load, released = self._loads_at(self._factor)
        change = last.factor * self.scale
        return Reached(load, released, self._time, self._start + self._length, change, self._factor)


class RiksStep(PathStep):
    """*STATIC, RIKS. Where the step gives no end, it ends with its last increment."""

    nrhs = 2

    def __init__(self, system: System, model: Model, step: Step, state: State, solver: str, user: UserRoutines) -> None:
        super().__init__(system, model, step, state, solver, user)
        assert step.procedure.riks is not None
        self._riks = step.procedure.riks
        self._arc = ArcLength()
        self._monitored = -1
        if self._riks.node >= 0:
            self._monitored = int(system.dofs.find(self._riks.node, self._riks.dof))
            if self._monitored < 0:
                name = system.dofs.mesh.name(self._riks.node)
                raise DeckError(
                    step.source, f"*STATIC, RIKS ends with dof {self._riks.dof} of node {name}, which no element uses"
                )
        self._crossed = False

    def _finished(self) -> bool:
        if self._crossed:
            return True
        endless = self._riks.largest_factor is None and self._monitored < 0
        return endless and self._increment == self._step.increments

    def _control_of(self, given: PathIncrement, size: float) -> Control:
        self._arc.length = size / self._step.procedure.period
        return self._arc

    def _reach(self, last: Iterate, size: float) -> Reached:
        before = self._state.displacement
        reached = super()._reach(last, size)
        assert reached.load_factor is not None
        self._arc.converged(last.increment, reached.size)
        largest = self._riks.largest_factor
        self._crossed = largest is not None and reached.load_factor >= largest
        if self._monitored >= 0:
            u = float(before[self._monitored])
            to_go, way = self._riks.value - u, float(last.increment[self._monitored])
            self._crossed = self._crossed or (way != 0.0 and 0.0 <= to_go / way <= 1.0)
        return reached


class EnergyStep(PathStep):
    """A step under energy control, up to LPF = 1; sizes of increments are those of *STATIC."""

    def __init__(self, system: System, model: Model, step: Step, state: State, solver: str, user: UserRoutines) -> None:
        super().__init__(system, model, step, state, solver, user)
        self.scale = step.procedure.period
        assert state.constraints is not None
        self._energy = Dissipation(state.constraints)

    def run(self) -> Iterator[Record]:
        """Records of the step, the first of which says how it runs."""
        yield Noted("ENERGY CONTROL: THE STEP TIME FOLLOWS FROM THE DISSIPATED ENERGY AND FALLS IN SNAP-BACKS")
        yield from super().run()

    def _finished(self) -> bool:
        return self._factor >= 1.0

    def _control_of(self, given: PathIncrement, size: float) -> Control:
        state, share, left = self._state, size / self.scale, 1.0 - self._factor
        if share < left <= share * (1.0 + REMAINDER):
            share = left
        self._energy.start(given, state.external, state.reaction, size=share, left=left)
        return self._energy
