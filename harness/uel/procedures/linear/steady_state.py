# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*STEADY STATE DYNAMICS: response to harmonic loads at each of several angular frequencies w.

DIRECT solves (K - w^2 M + i (w C + S)) u = p. Elements are called, at each frequency, for the stiffness K (LFLAGS(3) =
2), the mass M (4), and the viscous and the structural damping C and S (3, with LFLAGS(7) = 1 and 2), with LFLAGS(1) =
95 and the frequency in TIME(1) (User Subroutines Guide, UEL, "Direct steady-state analysis"; Theory Guide, "Direct
steady-state dynamic analysis"). SUBSPACE PROJECTION solves it for u = sum of phi_i q_i, where phi_i are modes of
*FREQUENCY. Without either, each mode has its own equation (Theory Guide, "Steady-state linear dynamic analysis"),
m_i (w_i^2 (1 + i s_i) - w^2 + 2 i xi_i w_i w) q_i = phi_i^T p.

Loads and prescribed values have a real and an imaginary part; their amplitudes are functions of frequency. Energies are
means over a period, half of 1/2 u^H K u and 1/2 w^2 u^H M u (`harness/uel/procedures/fidelity.md`).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from uel.elements import Damping, Request
from uel.errors import DeckError
from uel.model.arrays import ComplexArray, FloatArray
from uel.model.modal import Motion
from uel.model.perturbations import ModalSteadyState, SteadyState, SubspaceSteadyState
from uel.model.records import HarmonicResponse, Record, Solution
from uel.model.steps import Step
from uel.procedures.linear.linear_loads import step_at
from uel.procedures.linear.modal import ModalStep
from uel.procedures.linear.perturbation import PerturbationStep
from uel.procedures.step_setting import Setting
from uel.solver.harmonic import ComplexSolver
from uel.solver.linear import LinearSolver


@dataclass(frozen=True, slots=True)
class Response:
    """Amplitudes (n,) of the response at a frequency.

    displacement, reaction  u and the forces at prescribed unknowns
    elastic                 K u
    inertial                M times the acceleration, -w^2 M u
    """

    displacement: ComplexArray
    reaction: ComplexArray
    elastic: ComplexArray
    inertial: ComplexArray


@dataclass(frozen=True, slots=True)
class Matrices:
    """CSR values (nnz,) of matrices of all unknowns at a frequency.

    dynamic          K + i w C - w^2 M + i S
    stiffness, mass  K and M
    """

    dynamic: ComplexArray
    stiffness: FloatArray
    mass: FloatArray


class HarmonicStep(PerturbationStep, ABC):
    """Step of harmonic responses, one increment per frequency; subclasses define the solution."""

    _procedure: SteadyState

    def _increments(self) -> Iterator[Record]:
        modes = self._state.modes
        if self._procedure.natural and modes is None:
            message = (
                f"*{self._procedure.keyword}, INTERVAL=EIGENFREQUENCY needs a *FREQUENCY step before it in the same job"
            )
            raise DeckError(self._step.source, message)
        frequencies = self._procedure.frequencies(modes.frequencies if modes is not None else np.zeros(0))
        for increment, frequency in enumerate(frequencies, start=1):
            self._increment, self._frequency = increment, frequency
            yield from self._increment_by(self._solve)

    def _solve(self) -> list[Record]:
        """Compute the response at the frequency of the increment."""
        frequency = self._frequency
        rate = 2j * math.pi * frequency
        load = self._complex_amplitudes(self._loads)
        response = self._response_to(load, rate)
        u = response.displacement
        amplitudes = u, rate * u, rate**2 * u, response.reaction, load
        real = self._part(*(np.ascontiguousarray(values.real) for values in amplitudes))
        imaginary = self._part(*(np.ascontiguousarray(values.imag) for values in amplitudes))
        real = replace(real, energies=self._energies(response))
        size, numbers = self._procedure.period, (self._step.number, self._increment, 1, 1)
        return [HarmonicResponse(*numbers, frequency, frequency, size, replace(real, imaginary=imaginary))]

    @abstractmethod
    def _response_to(self, load: ComplexArray, rate: complex) -> Response:
        """Return the response to loads (n,); rate: i w."""

    def _energies(self, response: Response) -> dict[str, float]:
        """Return the mean strain energy and kinetic energy over a period."""

        def mean(forces: ComplexArray) -> float:
            # 1/2 of the energy, times 1/2 for the mean of a product of two harmonics
            return 0.25 * float(np.vdot(response.displacement, self._state.signs * forces).real)

        return {"ALLSE": mean(response.elastic), "ALLKE": -mean(response.inertial)}

    def _matrices(self, rate: complex) -> Matrices:
        """Return the matrices at a frequency; rate: i w."""
        stiffness, mass = self._matrix(Request.STIFFNESS), self._matrix(Request.MASS)
        dynamic = stiffness + rate**2 * mass
        if not self._procedure.undamped:
            viscous, structural = (
                self._matrix(Request.DAMPING, kind) for kind in (Damping.VISCOUS, Damping.STRUCTURAL)
            )
            dynamic += rate * viscous + 1j * structural
        return Matrices(dynamic, stiffness, mass)

    def _with_forces(self, u: ComplexArray, forces: ComplexArray, matrices: Matrices, rate: complex) -> Response:
        """Return the response with displacements u (n,) due to forces (n,); rate: i w."""
        dynamic, elastic, inertial = (
            self._system.matrix(data) @ u for data in (matrices.dynamic, matrices.stiffness, matrices.mass)
        )
        return Response(u, _by_parts(self._constraints.reactions, forces - dynamic), elastic, rate**2 * inertial)

    def _matrix(self, request: Request, damping: Damping = Damping.NONE) -> FloatArray:
        """Return CSR values (nnz,) of a matrix of the elements in the base state."""
        call, at = self._call(request).asking(request, damping), self._state.displacement
        evaluation = self._system.evaluate(call, at, np.zeros_like(at))
        assert evaluation.data is not None
        return (self._by_spins(evaluation.data) if request is Request.STIFFNESS else evaluation.data).copy()

    @property
    def _step_time(self) -> float:
        return self._frequency

    def _complex_amplitudes(self, read: Callable[[Step], FloatArray]) -> ComplexArray:
        """Return complex loads or prescribed values (n,) at the frequency; read: returns those of a step."""
        at = self._frequency, self._frequency
        return read(step_at(self._step, at)) + 1j * read(step_at(self._step, at, imaginary=True))

    def _part(
        self,
        displacement: FloatArray,
        velocity: FloatArray,
        acceleration: FloatArray,
        reaction: FloatArray,
        load: FloatArray,
    ) -> Solution:
        """Return the real or the imaginary part of the solution."""
        return replace(
            self._solution(displacement, {}),
            velocity=velocity,
            acceleration=acceleration,
            reaction=self._system.dofs.in_global(reaction),
            load=self._system.dofs.in_global(load),
            elements=self._elements(displacement),
        )


class SteadyStateStep(HarmonicStep):
    """Step of harmonic responses by the matrices of the model."""

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

    def _response_to(self, load: ComplexArray, rate: complex) -> Response:
        constraints, matrices = self._constraints, self._matrices(rate)
        data = matrices.dynamic
        prescribed = self._complex_amplitudes(self._state.boundaries.perturbations)[constraints.prescribed]
        u_p = _by_parts(constraints.expand, np.zeros(len(constraints.free), dtype=np.complex128), prescribed)
        rhs = _by_parts(constraints.reduce_vector, load - self._system.matrix(data) @ u_p)
        u = u_p + _by_parts(constraints.expand, self._solve_free(data, rhs), np.zeros_like(prescribed))
        for part in (u.real, u.imag):
            constraints.refuse_contradictions(part, f"step {self._step.number}")
        return self._with_forces(u, load, matrices, rate)

    def _solve_free(self, data: ComplexArray, rhs: ComplexArray) -> ComplexArray:
        """Solve for the free unknowns (n_q,)."""
        solver = self._solver
        reduced = _by_parts(self._constraints.reduce, data)
        if self._complex is not None:
            return self._complex.solve(reduced, rhs)
        solver.factorise(reduced.real)
        return _by_parts(solver.solve, rhs)


class ModalHarmonicStep(ModalStep, HarmonicStep):
    """Step of harmonic responses by modes; subclasses define their amplitudes."""

    def __init__(self, setting: Setting, procedure: SubspaceSteadyState | ModalSteadyState) -> None:
        self._procedure = procedure
        super().__init__(setting)

    def _with_base(self, load: ComplexArray, rate: complex) -> ComplexArray:
        """Add the loads of the motion of the supports to loads (n,)."""
        total = load.copy()
        for motion in self._superposition.base:
            part = 1j if motion.imaginary else 1.0
            accelerates = rate ** _DERIVATIVES[motion.motion]
            acceleration = part * accelerates * motion.value(self._frequency, self._frequency)
            total -= acceleration * self._modes.rigid[motion.dof - 1]
        return total

    def _largest_terms(self, rate: complex) -> FloatArray:
        """Return the scale (modes,) of the difference w_i^2 - w^2."""
        scale: FloatArray = np.abs(self._modes.values) + abs(rate) ** 2
        return scale

    def _check_distance(self, distance: FloatArray) -> None:
        """Raise DeckError at the natural frequency of an undamped mode."""
        if np.any(distance <= NEAR):
            message = f"{self._frequency:g} cycles per time is a natural frequency of a mode without damping"
            raise DeckError(self._step.source, f"*{self._procedure.keyword}: {message}")


class SubspaceSteadyStateStep(ModalHarmonicStep):
    """Step of harmonic responses by the matrices of the model, projected on modes."""

    def _response_to(self, load: ComplexArray, rate: complex) -> Response:
        matrices, shapes = self._matrices(rate), self._modes.shapes
        matrix = self._system.matrix(matrices.dynamic)
        forces = self._with_base(load, rate)
        projected = shapes @ (matrix @ shapes.T)
        # scaled to unit diagonals, except near a natural frequency
        scale = np.sqrt(self._modes.masses * self._largest_terms(rate))
        self._check_distance(np.linalg.svd(projected / np.outer(scale, scale), compute_uv=False))
        return self._with_forces(np.linalg.solve(projected, shapes @ forces) @ shapes, forces, matrices, rate)


class ModalSteadyStateStep(ModalHarmonicStep):
    """Step of harmonic responses by uncoupled modes."""

    def _response_to(self, load: ComplexArray, rate: complex) -> Response:
        modes, forces = self._modes, self._with_base(load, rate)
        stiffness = modes.values * (1 + 1j * self._superposition.structural(self._numbers, modes.omega))
        viscous = self._superposition.viscous(self._numbers, modes.omega)
        dynamic = stiffness + rate * viscous + rate**2
        self._check_distance(np.abs(dynamic) / self._largest_terms(rate))
        amplitude = modes.shapes @ forces / (modes.masses * dynamic)
        elastic, inertial = amplitude @ modes.stiffness, rate**2 * (amplitude @ modes.inertia)
        reaction = _by_parts(self._constraints.reactions, forces - (elastic + inertial))
        return Response(amplitude @ modes.shapes, reaction, elastic, inertial)


_DERIVATIVES = {Motion.DISPLACEMENT: 2, Motion.VELOCITY: 1, Motion.ACCELERATION: 0}

NEAR = 1e-10
"""Difference of squared frequencies, over their sum, that counts as rounding."""


def _by_parts(linear: Callable[..., FloatArray], *values: ComplexArray) -> ComplexArray:
    """Apply a linear function to complex values; its next call may overwrite the result."""
    real = linear(*(np.ascontiguousarray(value.real) for value in values)).copy()
    return real + 1j * linear(*(np.ascontiguousarray(value.imag) for value in values))
