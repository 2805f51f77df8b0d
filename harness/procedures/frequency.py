# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*FREQUENCY: natural frequencies about the state at the end of the last general step.

Elements are asked for the stiffness (LFLAGS(3) = 2) and the mass (4) alone, LFLAGS(1) = 41 and LFLAGS(4) = 1, with U of
the base state; loads and prescribed values of the step are not there. Nothing of the step goes on into the next one.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from scipy import sparse

from harness.assembly import Constraints, System
from harness.elements import Call
from harness.errors import DeckError
from harness.model.arrays import FloatArray
from harness.model.model import Model
from harness.model.procedures import Frequency
from harness.model.records import AttemptStarted, ModesFound, ModeShape, Noted, Record, Solution, StepDone
from harness.model.steps import Step
from harness.procedures.state import State
from harness.procedures.static import MASS, UserRoutines, choose_solver
from harness.solver.eigen import Pair, UnstableError, lowest_eigenvalues

STIFFNESS = 2
"""LFLAGS(3) of a call for the stiffness alone."""

FIRST = 10
"""Eigenvalues that are looked for first where their number is not given."""

_LAST_DISPLACEMENT = 3


class FrequencyStep:
    """One step of natural frequencies."""

    def __init__(
        self,
        system: System,
        model: Model,
        step: Step,
        procedure: Frequency,
        state: State,
        solver: str,
        user: UserRoutines,
    ) -> None:
        self._system = system
        self._step = step
        self._procedure = procedure
        self._state = state
        self._user = user
        unknowns = state.boundaries.in_perturbation(step)
        self._constraints = Constraints(system, unknowns, model.equations, state.boundaries.sources)
        self._solver = choose_solver(solver, self._constraints)

    @property
    def reached(self) -> tuple[tuple[float, float], float, int, int]:
        """As that of a static step; no time passes."""
        return (0.0, self._state.total_time), 0.0, self._step.number, 1

    def run(self) -> Iterator[Record]:
        """The modes, lowest first. Raises KernelError, SingularMatrixError, DeckError."""
        step, procedure, total = self._step, self._procedure, self._state.total_time
        yield Noted(f"LINEAR SOLVER {self._solver.name.upper()}: {self._solver.reason}")
        yield AttemptStarted(step.number, 1, 1, 0.0, total, procedure.period)
        self._user.external_database(1, 0, (0.0, total), procedure.period, step.number, 1)
        values, vectors = self._modes()
        rate = np.sign(values) * np.sqrt(np.abs(values))
        frequency = rate / (2 * math.pi)
        inside = (frequency >= procedure.lowest) & (frequency <= procedure.highest)
        values, frequency, vectors = values[inside], frequency[inside], vectors[:, inside]
        shapes, masses = self._scaled(vectors)
        self._user.external_database(2, 0, (0.0, total), procedure.period, step.number, 1)
        yield ModesFound(step.number, total, values, frequency, masses)
        for mode, shape in enumerate(shapes):
            size = procedure.period
            measures = {"EIGVAL": float(values[mode]), "EIGFREQ": float(frequency[mode]), "GM": float(masses[mode])}
            solution = self._solution(shape, measures)
            at = float(frequency[mode])
            yield ModeShape(step.number, mode + 1, 1, 0, at, at, size, solution)
        yield StepDone(step.number, 1, 0, 1)

    def _modes(self) -> tuple[FloatArray, FloatArray]:
        """Eigenvalues, and vectors (n, k) of all unknowns: as many as asked for, or more than the frequencies hold."""
        pattern = self._constraints.reduced_indptr, self._constraints.reduced_indices
        pair = Pair(*pattern, self._matrix(STIFFNESS), self._matrix(MASS))
        if not np.any(pair.mass):
            raise DeckError(self._step.source, "*FREQUENCY: no element has mass (*DENSITY, *MASS, LFLAGS(3) = 4)")
        size = len(pair)
        count = self._procedure.number or min(FIRST, size)
        while True:
            try:
                values, vectors = lowest_eigenvalues(pair, count, self._solver)
            except UnstableError:
                message = "the base state is far from stable, or a part without mass is not held"
                raise DeckError(self._step.source, f"*FREQUENCY finds no eigenvalues: {message}") from None
            highest = (2 * math.pi * self._procedure.highest) ** 2
            if self._procedure.number or len(values) < count or values[-1] > highest or count == size:
                none = np.zeros(len(self._constraints.prescribed))
                return values, np.array([self._constraints.expand(vector, none) for vector in vectors.T]).T
            count = min(2 * count, size)

    def _matrix(self, request: int) -> FloatArray:
        """CSR values of the symmetric part of a matrix of the free unknowns."""
        step, state = self._step, self._state
        period = self._procedure.period
        call = Call(
            lflags=(self._procedure.lflag, int(step.nlgeom), request, 1, 0),
            step=step.number,
            increment=1,
            step_time=0.0,
            total_time=state.total_time,
            time_increment=period,
            period=period,
            predefined=state.predefined,
        )
        evaluation = self._system.evaluate(call, state.displacement, np.zeros_like(state.displacement))
        assert evaluation.data is not None
        constraints, data = self._constraints, self._constraints.reduce(evaluation.data)
        # a matrix whose entries are their own positions, transposed
        positions = sparse.csr_array((np.arange(len(data)), constraints.reduced_indices, constraints.reduced_indptr))
        symmetric: FloatArray = 0.5 * (data + data[positions.T.tocsr().data])
        return symmetric

    def _scaled(self, vectors: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Shapes (k, n) of the normalization asked for, and their generalized masses."""
        displacements = self._system.dofs.dof <= _LAST_DISPLACEMENT
        factors = np.ones(vectors.shape[1])
        for mode, vector in enumerate(vectors.T):
            measured = vector[displacements] if np.any(vector[displacements]) else vector
            largest = measured[np.argmax(np.abs(measured))]
            factors[mode] = np.sign(largest) if self._procedure.by_mass else 1.0 / largest
        return (vectors * factors).T, factors**2

    def _solution(self, shape: FloatArray, measures: dict[str, float]) -> Solution:
        dofs, zero = self._system.dofs, np.zeros_like(shape)
        return Solution(
            node=dofs.node,
            dof=dofs.dof,
            displacement=shape,
            reaction=zero,
            load=zero,
            velocity=zero,
            acceleration=zero,
            energies=measures,
            elements=(),
        )
