# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Calls of one element that the checks change and repeat."""

from __future__ import annotations

from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from uel.check.recording import Pass
from uel.check.single import Returned, Single, first_difference
from uel.elements import Call, Motion, Request
from uel.errors import KernelError
from uel.model.arrays import FloatArray
from uel.model.procedures import Dynamic

DYNAMIC: Final = tuple(Dynamic(direct=direct).lflag for direct in (False, True))
"""LFLAGS(1) of *DYNAMIC: V and A follow U."""

CHANGES: Final = 1e-3, 1.0, 1e3, -1e-3, -1.0, -1e3
"""Change of a state variable that shows whether something depends on it."""


@dataclass(frozen=True, slots=True)
class ElementState:
    """Arguments of a call of one element in its state at the start of the increment.

    u, du, motion  (n,) of the element: estimate of the end of the increment, the increment, velocity and acceleration
    origin         where the state comes from, for messages
    inertia        in dynamics V and A follow where U is changed
    """

    single: Single
    call: Call
    u: FloatArray
    du: FloatArray
    motion: Motion
    nrhs: int
    origin: str
    inertia: bool = True

    def __str__(self) -> str:
        return f"element {self.single.name}, {self.origin}"

    def evaluate(self, *, matrix: bool = True) -> Returned:
        """Make the call. Raises KernelError."""
        return self.single.evaluate(self.call, self.u, self.du, self.motion, matrix=matrix, nrhs=self.nrhs)

    def influence(self, surroundings: AbstractContextManager[None], expected: Returned) -> str:
        """Describe an effect of the surroundings of the call on its results, in a sentence; '' for none."""
        with surroundings:
            try:
                return first_difference(expected, self.evaluate())
            except KernelError as error:
                return str(error)

    def moved(self, shift: FloatArray) -> ElementState:
        """Move the end of the increment: shift (n,) is added to U and DU; in dynamics V and A follow."""
        rates = self._rates()
        motion = Motion(self.motion.velocity + rates[0] * shift, self.motion.acceleration + rates[1] * shift)
        return replace(self, u=self.u + shift, du=self.du + shift, motion=motion)

    def moved_on(self, shift: FloatArray) -> ElementState:
        """Return a further increment, shift (n,), from the end of this one; the element state is that at its start."""
        return replace(self.moved(shift), du=shift)

    def carried(self, shift: FloatArray) -> ElementState:
        """Return the state with U + shift (n,) from the start."""
        return replace(self, u=self.u + shift)

    def part(self, fraction: float) -> ElementState:
        """Return the state at this fraction of the increment of displacements."""
        return replace(self, u=self.u - (1.0 - fraction) * self.du, du=fraction * self.du)

    def settled(self) -> ElementState:
        """Return the next increment with zero displacement increments."""
        still = replace(self, single=self.single.twin(strict=False))
        still.evaluate()
        still.single.block.commit()
        return replace(still, du=np.zeros_like(self.u))

    def later(self) -> ElementState:
        """Repeat the motion one increment later: in the first one an element may use constants as its state."""
        call = self.call
        return self.called(
            increment=call.increment + 1,
            step_time=call.step_time + call.time_increment,
            total_time=call.total_time + call.time_increment,
        )

    def quiet(self) -> ElementState:
        """Drop velocities and accelerations in a dynamic step; else return the state itself."""
        if not self.dynamic:
            return self
        zero = Motion(np.zeros(len(self.u)), np.zeros(len(self.u)))
        return replace(self, motion=zero, inertia=False)

    def still(self) -> ElementState:
        """Return the state at the start of the increment, at rest and without loads on the element."""
        zero = Motion(np.zeros(len(self.u)), np.zeros(len(self.u)))
        return replace(self.part(0.0), motion=zero).called(distributed=None)

    def called(self, **changes: Any) -> ElementState:
        """Change common arguments of all elements, fields of Call."""
        return replace(self, call=replace(self.call, **changes))

    def asked(self, request: Request) -> ElementState:
        """Return the state with another LFLAGS(3)."""
        return replace(self, call=self.call.asking(request))

    @property
    def dynamic(self) -> bool:
        """V and A follow U."""
        return self.call.flags.procedure in DYNAMIC

    def with_svars(self, svars: FloatArray) -> ElementState:
        """Return the state with other state variables (nsvars,) at the start of the increment."""
        single = self.single.twin(strict=False)
        single.block.initial.initialise(np.array([0]), svars)
        return replace(self, single=single)

    def depends_on(self, chosen: np.ndarray) -> bool:
        """Return whether RHS changes with these state variables (nsvars,) on entry. Raises KernelError."""
        expected = self.evaluate(matrix=False).rhs
        for value in CHANGES:
            try:
                rhs = self.with_svars(self.single.svars + value * chosen).evaluate(matrix=False).rhs
            except KernelError:
                return True
            if not np.array_equal(rhs, expected):
                return True
        return False

    def strictly(self) -> ElementState:
        """Return the state with a copy of the element for which a write outside an array is an error."""
        return replace(self, single=self.single.twin(strict=True))

    def _rates(self) -> tuple[float, float]:
        """Return the derivatives of V and A by U."""
        call = self.call
        if not (self.dynamic and self.inertia and call.time_increment):
            return 0.0, 0.0
        _, beta, gamma = call.params
        return gamma / (beta * call.time_increment), 1.0 / (beta * call.time_increment**2)


def state_of(single: Single, made: Pass, equations: np.ndarray) -> ElementState:
    """Return a call of the run, with a copy of the element as it is now."""
    call = made.call
    n = len(equations)
    motion = made.motion.at(equations) if made.motion else Motion(np.zeros(n), np.zeros(n))
    origin = f"step {call.step}, increment {call.increment}, iteration {call.iteration}"
    return ElementState(
        single.twin(strict=False), call, made.u[equations], made.du[equations], motion, made.nrhs, origin
    )
