# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*STEADY STATE DYNAMICS, DIRECT: (K - w^2 M + i (w C + S)) u = p for one angular frequency w after another.

Elements are asked, at each frequency, for the stiffness K (LFLAGS(3) = 2), the mass M (4), and the viscous and the
structural damping C and S (3, with LFLAGS(7) = 1 and 2), with LFLAGS(1) = 95 and the frequency in TIME(1) (User
Subroutines Guide, UEL, "Direct steady-state analysis"; Theory Guide, "Direct steady-state dynamic analysis"). Loads and
prescribed values have a real and an imaginary part; their amplitudes are functions of frequency.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TypeVar

import numpy as np

from harness.elements import Call, Damping, Request
from harness.model.arrays import ComplexArray, FloatArray
from harness.model.perturbations import SteadyState
from harness.model.records import HarmonicResponse, Record, Solution
from harness.model.steps import Boundary, ElementLoad, Load, Step
from harness.procedures.perturbation import PerturbationStep
from harness.procedures.step_setting import Setting
from harness.solver.harmonic import ComplexSolver
from harness.solver.linear import LinearSolver

Entry = TypeVar("Entry", Boundary, Load, ElementLoad)


class SteadyStateStep(PerturbationStep):
    """One step of harmonic responses, each an increment."""

    def __init__(self, setting: Setting, procedure: SteadyState) -> None:
        self._procedure = procedure
        self._complex: ComplexSolver | None = None
        super().__init__(setting)

    def _choose_solver(self, name: str) -> LinearSolver:
        if self._procedure.undamped:
            return super()._choose_solver(name)
        constraints = self._constraints
        self._complex = ComplexSolver(
            name,
            constraints.reduced_indptr,
            constraints.reduced_indices,
            coordinates=constraints.coordinates,
            name_of=constraints.name_of,
        )
        self._complex.real.effort = self._state.effort
        return self._complex.real

    @property
    def _frequency(self) -> float:
        """Frequency of the increment, cycles per time."""
        return self._procedure.frequencies[self._increment - 1]

    def _increments(self) -> Iterator[Record]:
        for increment in range(1, len(self._procedure.frequencies) + 1):
            self._increment = increment
            yield from self._increment_by(self._solve)

    def _solve(self) -> list[Record]:
        """The response at the frequency of the increment."""
        constraints, frequency = self._constraints, self._frequency
        rate = 2j * math.pi * frequency
        data = self._dynamic_stiffness(rate)
        load = self._given(self._state.loads.in_perturbation)
        prescribed = self._given(self._state.boundaries.perturbations)[constraints.prescribed]
        held = _by_parts(constraints.expand, np.zeros(len(constraints.free), dtype=np.complex128), prescribed)
        missing = _by_parts(constraints.reduce_vector, load - self._system.matrix(data) @ held)
        found = held + _by_parts(constraints.expand, self._solution_of(data, missing), np.zeros_like(prescribed))
        reaction = _by_parts(constraints.reactions, load - self._system.matrix(data) @ found)
        response = found, rate * found, rate**2 * found, reaction, load
        real = self._part(*(np.ascontiguousarray(values.real) for values in response))
        imaginary = self._part(*(np.ascontiguousarray(values.imag) for values in response))
        size, place = self._procedure.period, (self._step.number, self._increment, 1, 1)
        return [HarmonicResponse(*place, frequency, frequency, size, replace(real, imaginary=imaginary))]

    def _dynamic_stiffness(self, rate: complex) -> ComplexArray:
        """(nnz,) CSR values of K + rate C + rate^2 M + i S over all unknowns."""
        data = self._matrix(Request.STIFFNESS) + rate**2 * self._matrix(Request.MASS)
        if not self._procedure.undamped:
            viscous, structural = (
                self._matrix(Request.DAMPING, kind) for kind in (Damping.VISCOUS, Damping.STRUCTURAL)
            )
            data += rate * viscous + 1j * structural
        return data

    def _matrix(self, request: Request, damping: Damping = Damping.NONE) -> FloatArray:
        """(nnz,) CSR values of a matrix of the elements in the base state."""
        call, at = self._call(request).asking(request, damping), self._state.displacement
        evaluation = self._system.evaluate(call, at, np.zeros_like(at))
        assert evaluation.data is not None
        return evaluation.data.copy()

    def _call(self, request: Request) -> Call:
        return replace(super()._call(request), step_time=self._frequency)

    def _given(self, read: Callable[[Step], FloatArray]) -> ComplexArray:
        """Loads or prescribed values (n,) at the frequency."""
        return read(_part_of(self._step, self._frequency)) + 1j * read(
            _part_of(self._step, self._frequency, imaginary=True)
        )

    def _solution_of(self, data: ComplexArray, missing: ComplexArray) -> ComplexArray:
        """Free unknowns (n_q,)."""
        reduced = _by_parts(self._constraints.reduce, data)
        if self._complex is not None:
            return self._complex.solve(reduced, missing)
        self._solver.factorise(reduced.real)
        return _by_parts(self._solver.solve, missing)

    def _part(
        self,
        displacement: FloatArray,
        velocity: FloatArray,
        acceleration: FloatArray,
        reaction: FloatArray,
        load: FloatArray,
    ) -> Solution:
        """The real or the imaginary part."""
        return replace(
            self._solution(displacement, {}),
            velocity=velocity,
            acceleration=acceleration,
            reaction=self._system.dofs.in_global(reaction),
            load=self._system.dofs.in_global(load),
            elements=self._elements(displacement),
        )


def _by_parts(linear: Callable[..., FloatArray], *values: ComplexArray) -> ComplexArray:
    """A linear function of complex values; its next call may overwrite the result."""
    real = linear(*(np.ascontiguousarray(value.real) for value in values)).copy()
    return real + 1j * linear(*(np.ascontiguousarray(value.imag) for value in values))


def _part_of(step: Step, frequency: float, *, imaginary: bool = False) -> Step:
    """The step with the real or the imaginary part of what it gives, at the frequency."""

    def part(entries: tuple[Entry, ...]) -> tuple[Entry, ...]:
        return tuple(_at(entry, frequency) for entry in entries if entry.imaginary == imaginary)

    return replace(
        step,
        boundaries=part(step.boundaries),
        loads=part(step.loads),
        element_loads=part(step.element_loads),
        surface_loads=part(step.surface_loads),
    )


def _at(entry: Entry, frequency: float) -> Entry:
    """The entry with the magnitude that its amplitude gives at the frequency."""
    if entry.amplitude is None:
        return entry
    factor = entry.amplitude.value(frequency, frequency)
    return replace(entry, magnitude=factor if entry.amplitude.absolute else entry.magnitude * factor)
