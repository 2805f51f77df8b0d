# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*FREQUENCY: natural frequencies about the state at the end of the last general step.

Elements are called only for the stiffness (LFLAGS(3) = 2) and the mass (4), with LFLAGS(1) = 41; loads and prescribed
values of the step have no effect.
"""

from __future__ import annotations

import math

import numpy as np

from uel.elements import Request
from uel.errors import DeckError
from uel.model.arrays import FloatArray
from uel.model.perturbations import Frequency
from uel.model.records import ModesFound, ModeShape, Record
from uel.procedures.linear.modes import Modes
from uel.procedures.linear.perturbation import PerturbationStep
from uel.procedures.step_setting import Setting
from uel.solver.eigen import Pair, UnstableError, lowest_eigenvalues

TRANSLATIONS = (1, 2, 3)
"""Dofs of translations."""

FIRST = 10
"""Number of eigenvalues that are computed first if the deck does not give it."""


class FrequencyStep(PerturbationStep):
    """Step of natural frequencies."""

    def __init__(self, setting: Setting, procedure: Frequency) -> None:
        super().__init__(setting)
        self._procedure = procedure
        self._matrices: dict[Request, FloatArray] = {}

    def _solve(self) -> list[Record]:
        """Compute the modes, lowest first."""
        step, procedure = self._step, self._procedure
        values, vectors = self._modes()
        frequency = np.sign(values) * np.sqrt(np.abs(values)) / (2 * math.pi)
        inside = (frequency >= procedure.lowest) & (frequency <= procedure.highest)
        values, frequency, vectors = values[inside], frequency[inside], vectors[:, inside]
        shapes, masses = self._scaled(vectors)
        self._modes_for_later = self._kept(values, masses, shapes)
        records: list[Record] = [ModesFound(step.number, self._state.total_time, values, frequency, masses)]
        for mode, shape in enumerate(shapes):
            at, size = float(frequency[mode]), procedure.period
            measures = {"EIGVAL": float(values[mode]), "EIGFREQ": at, "GM": float(masses[mode])}
            records.append(ModeShape(step.number, mode + 1, 1, 0, at, at, size, self._solution(shape, measures)))
        return records

    def _modes(self) -> tuple[FloatArray, FloatArray]:
        """Return eigenvalues, and vectors (n, k) of all unknowns: the requested number, or beyond the range."""
        pattern = self._constraints.reduced_indptr, self._constraints.reduced_indices
        pair = Pair(*pattern, self._matrix(Request.STIFFNESS), self._matrix(Request.MASS))
        if not np.any(pair.mass):
            raise DeckError(self._step.source, "*FREQUENCY: no element has mass (*DENSITY, *MASS, LFLAGS(3) = 4)")
        size = len(pair)
        count = self._procedure.number or min(FIRST, size)
        while True:
            try:
                values, vectors = lowest_eigenvalues(pair, count, self._solver)
            except UnstableError:
                message = "the base state is far from stable, or a part without mass is unconstrained"
                raise DeckError(self._step.source, f"*FREQUENCY finds no eigenvalues: {message}") from None
            highest = (2 * math.pi * self._procedure.highest) ** 2
            if self._procedure.number or len(values) < count or values[-1] > highest or count == size:
                return values, self._modes_of(vectors)
            count = min(2 * count, size)

    def _matrix(self, request: Request) -> FloatArray:
        """Return the CSR values of the symmetric part of a matrix of the free unknowns; store that of all unknowns."""
        evaluation = self._pass(request)
        assert evaluation.data is not None
        self._matrices[request] = evaluation.data.copy()
        return self._symmetric(evaluation.data)

    def _kept(self, values: FloatArray, masses: FloatArray, shapes: FloatArray) -> Modes:
        """Collect the modes for later steps."""
        along = np.array([self._system.dofs.dof == dof for dof in TRANSLATIONS], dtype=float)
        products = []
        for request, vectors in ((Request.STIFFNESS, shapes), (Request.MASS, np.vstack([shapes, along]))):
            rows = [self._system.product(self._matrices[request], vector) for vector in vectors]
            products.append(np.array(rows).reshape(vectors.shape))
        stiffness, inertia = products
        count = len(values)
        arrays = values, masses, shapes, stiffness, inertia[:count], inertia[count:]
        return Modes(self._step.number, self._constraints, *arrays)

    def _scaled(self, vectors: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the shapes (k, n) with the requested normalization, and their generalized masses."""
        largest = self._largest(vectors)
        factors = np.sign(largest) if self._procedure.by_mass else 1.0 / largest
        return (vectors * factors).T, factors**2
