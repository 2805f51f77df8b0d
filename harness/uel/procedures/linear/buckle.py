# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*BUCKLE: factors of the loads of the step at which the base state becomes unstable.

(K + lambda D) v = 0, where K is the stiffness of the base state with its stresses, and D the initial stress matrix of
the stresses due to the loads of the step, with their load stiffness (Abaqus Analysis User's Guide, "Eigenvalue buckling
prediction"). Only symmetric parts are used. The base state is that at the end of the last general step.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uel.elements import Request
from uel.errors import DeckError
from uel.model.arrays import FloatArray
from uel.model.perturbations import Buckle
from uel.model.records import BucklingFactors, BucklingMode, Record, Warned
from uel.procedures.linear.perturbation import PerturbationStep
from uel.procedures.step_setting import Setting
from uel.solver.buckling import smallest_factors
from uel.solver.eigen import Pair, UnstableError

UNSTABLE = "the base state is not stable: its loads are above the buckling load, or its stiffness is not symmetric"

FREE_EDGE = (
    "THE LOAD STIFFNESS OF PRESSURES IS NOT SYMMETRIC, FOR THEY FOLLOW A FACE WITH A FREE EDGE, AND ONLY ITS SYMMETRIC "
    "PART COUNTS. *CLOAD AND TRVEC WITH FOLLOWER=NO KEEP THEIR DIRECTION"
)

UNSYMMETRIC = 1e-6
"""Limit relative to the largest entry of D: rounding is smaller."""


class BuckleStep(PerturbationStep):
    """Step of eigenvalue buckling prediction."""

    def __init__(self, setting: Setting, procedure: Buckle) -> None:
        super().__init__(setting)
        self._procedure = procedure
        self._remarks: list[Record] = []

    def _solve(self) -> list[Record]:
        """Compute the modes, in ascending order of the magnitude of their loads."""
        step, procedure = self._step, self._procedure
        values, vectors = self._buckle()
        inside = (values >= procedure.lowest) & (values <= procedure.highest)
        values, vectors = values[inside], vectors[:, inside]
        shapes = (vectors / self._largest(vectors)).T if len(values) else vectors.T
        records: list[Record] = [*self._remarks, BucklingFactors(step.number, self._state.total_time, values)]
        for mode, (factor, shape) in enumerate(zip(values.tolist(), shapes, strict=True), start=1):
            solution = self._solution(shape, {"EIGVAL": factor})
            records.append(BucklingMode(step.number, mode, 1, 0, factor, factor, procedure.period, solution))
        return records

    def _buckle(self) -> tuple[FloatArray, FloatArray]:
        """Return the eigenvalues, and vectors (n, k) of all unknowns."""
        evaluation = self._pass(Request.NORMAL)
        assert evaluation.data is not None
        data = evaluation.data.copy()
        stiffness = self._symmetric(data)
        change = self._response(data, stiffness, self._loads(self._step))
        load_stiffness = self._load_stiffness()
        added = self._symmetric(self._stress_matrix(change) + load_stiffness)
        skew = self._constraints.reduce(load_stiffness) - self._symmetric(load_stiffness)
        if np.abs(skew).max(initial=0.0) > UNSYMMETRIC * np.abs(added).max(initial=0.0):
            self._remarks.append(Warned(FREE_EDGE))
        if not np.any(added):
            raise DeckError(self._step.source, "*BUCKLE: the loads of the step cause no stress")
        if not self._step.nlgeom and np.any(stress := self._symmetric(self._stress_matrix())):
            stiffness += stress
            self._solver.factorise(stiffness)
        pattern = self._constraints.reduced_indptr, self._constraints.reduced_indices
        try:
            values, vectors = smallest_factors(Pair(*pattern, stiffness, -added), self._procedure.number, self._solver)
        except UnstableError:
            raise DeckError(self._step.source, f"*BUCKLE finds no eigenvalues: {UNSTABLE}") from None
        return values, self._modes_of(vectors)

    def _load_stiffness(self) -> FloatArray:
        """Return the CSR values (nnz,) of the load stiffness of follower loads of the step."""
        system, step = self._system, self._step
        data, zero = np.zeros(len(system.indices)), np.zeros(len(system))
        call = self._call(Request.STIFFNESS)
        flags = replace(call.flags, nlgeom=True)
        for block in system.contributors.followers:
            time = self._step_time, self._state.total_time
            loads = self._state.loads.on_faces(block, step, self._user, self._increment, time, self._state.displacement)
            block.evaluate(replace(call, flags=flags, distributed=loads), zero, zero, zero.copy(), data)
        return data
