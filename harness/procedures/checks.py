# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""From an iterate to the convergence checks of all fields."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from harness.assembly import Constraints, DofMap
from harness.elements import FIELD_NAMES
from harness.model.arrays import FloatArray, IntArray, first_largest
from harness.model.records import FieldCheck, Largest, Verdict
from harness.model.steps import Controls, FieldControls
from harness.procedures.acceptance import INITIAL_FLUX, Check, FluxHistory, estimated_correction, judge
from harness.procedures.incrementation import Abandoned, judge_rate, out_of_iterations
from harness.solver.newton import Iterate

CONTROLLED_AS = dict(
    zip(
        FIELD_NAMES,
        ("DISPLACEMENT", "ROTATION", "PORE FLUID PRESSURE", "ELECTRICAL POTENTIAL", "TEMPERATURE"),
        strict=True,
    )
)
"""FIELD= of *CONTROLS by field."""


Positions = IntArray | slice
"""Where in a vector the entries of a field are; a slice where they are all of it, which is much quicker."""


@dataclass(slots=True)
class FieldChecker:
    """Checks of one field: where its unknowns are, its controls, and what earlier iterations and increments gave.

    unknowns  unknowns of the field
    free      positions of its free unknowns in the reduced vector
    """

    number: int
    controls: FieldControls
    unknowns: Positions
    free: Positions
    history: FluxHistory
    residuals: list[float] = field(default_factory=list)
    flux: float = 0.0
    peak: float = 0.0

    @property
    def name(self) -> str:
        """Name of the field."""
        return FIELD_NAMES[self.number]


class Checker:
    """Convergence checks of the increments of one step."""

    def __init__(
        self, dofs: DofMap, constraints: Constraints, controls: Controls, histories: Sequence[FluxHistory]
    ) -> None:
        self._dofs = dofs
        self._constraints = constraints
        self._free = constraints.free
        self._time = controls.time
        self._start: list[float] = []
        self.fields = []
        for number in np.unique(dofs.field):
            chosen = controls.fields.get(CONTROLLED_AS[FIELD_NAMES[number]], controls.default)
            unknowns = _positions(dofs.field == number)
            free = _positions(dofs.field[self._free] == number)
            history = histories[number].next_step(chosen)
            self.fields.append(FieldChecker(int(number), chosen, unknowns, free, history))

    @property
    def flux_floor(self) -> FloatArray:
        """(fields,) element nodal forces that are no terms of the average flux in the next increment.

        From the second increment of a step on those are left out that count as zero beside the time average of the
        largest one: in printed iterations of a cube that is pulled along one axis, the average is that of the other
        entries alone. All are terms where the largest one is small beside its time average: the heat fluxes of a cube
        with a first peak are, until a tenth is reached.
        """
        floor = np.full(len(FIELD_NAMES), -1.0)
        for checked in self.fields:
            floor[checked.number] = checked.history.floor(checked.controls)
        return floor

    def start(self, state: Iterate, *, extrapolated: bool) -> None:
        """Begin an attempt with the state before the first solve.

        Its residual serves the estimate of the correction in iteration 1, but only where it is an extrapolation.
        """
        for checked in self.fields:
            checked.residuals = []
        self._start = [_largest(state.reduced, checked.free) if extrapolated else 0.0 for checked in self.fields]

    def check(self, state: Iterate) -> tuple[FieldCheck, ...]:
        """Checks of all fields after an iteration."""
        return tuple(self._check(k, checked, state) for k, checked in enumerate(self.fields))

    def give_up(self, iteration: int, checks: Sequence[FieldCheck]) -> Abandoned | None:
        """Whether the attempt is to be abandoned after these checks, none of which need have failed."""
        for checked, check in zip(self.fields, checks, strict=True):
            if check.verdict is Verdict.NOT_ACHIEVED:
                tolerance = checked.controls.r_n * check.time_average_flux
                abandoned = judge_rate(iteration, checked.residuals, tolerance, self._time)
                if abandoned is not None:
                    return abandoned
        return out_of_iterations(iteration, self._time)

    def accepted_as_zero(self, checks: Sequence[FieldCheck]) -> Iterator[FieldCheck]:
        """Checks of which it is Abaqus' initial time average flux alone that accepts them, not the flux there is."""
        for checked, check in zip(self.fields, checks, strict=True):
            controls, history = checked.controls, checked.history
            assumed = not (history.count or controls.q_0 or controls.q_u) and history.initial == INITIAL_FLUX
            left = abs(check.residual.value) > controls.r_n * check.average_flux > 0.0
            if check.verdict is Verdict.ZERO_FLUX and assumed and left:
                yield check

    def time_averages(self) -> dict[str, float]:
        """Time average flux of each field after the last check."""
        return {field.name: field.history.average(field.flux, field.controls) for field in self.fields}

    def largest_ratio(self, residual: FloatArray, tolerances: Mapping[str, float]) -> float:
        """Largest residual over its tolerance, of the fields that have one."""
        reduced = self._constraints.reduce_vector(residual)
        ratios = [0.0]
        for checked in self.fields:
            largest = _largest(reduced, checked.free)
            if checked.name in tolerances and largest:
                tolerance = tolerances[checked.name]
                ratios.append(largest / tolerance if tolerance else math.inf)
        return max(ratios)

    def converged(self) -> None:
        """Take the last fluxes into the time average."""
        for checked in self.fields:
            checked.history = checked.history.converged(checked.flux, checked.controls, checked.peak)

    def histories(self, before: Sequence[FluxHistory]) -> list[FluxHistory]:
        """Flux histories by field number, at the end of the step."""
        after = list(before)
        for checked in self.fields:
            after[checked.number] = checked.history
        return after

    def _check(self, k: int, checked: FieldChecker, state: Iterate) -> FieldCheck:
        evaluation = state.evaluation
        checked.peak = float(evaluation.largest[checked.number])
        leaves_out = checked.history.leaves_out(checked.peak)
        count = (evaluation.flux_count if leaves_out else evaluation.entries)[checked.number]
        checked.flux = float(evaluation.flux[checked.number] / count) if count else 0.0
        time_average = checked.history.average(checked.flux, checked.controls)
        residual = self._find(state.reduced, checked.free, self._free)
        increment = self._find(state.increment, checked.unknowns)
        correction = self._find(state.correction, checked.unknowns)
        previous = checked.residuals[-1] if checked.residuals else self._start[k]
        checked.residuals.append(abs(residual.value))
        check = Check(
            q=checked.flux,
            q_time=time_average,
            r=abs(residual.value),
            r_previous=previous or None,
            du=abs(increment.value),
            c=abs(correction.value),
            iteration=state.iteration,
        )
        return FieldCheck(
            field=checked.name,
            average_flux=checked.flux,
            time_average_flux=time_average,
            residual=residual,
            increment=increment,
            correction=correction,
            verdict=judge(check, checked.controls, self._time.i_p),
            estimated_correction=estimated_correction(check),
        )

    def _find(self, vector: FloatArray, positions: Positions, unknowns: IntArray | None = None) -> Largest:
        """Largest entry of a vector among positions; `unknowns` gives the unknown of each position."""
        chosen = vector[positions]
        if not len(chosen):
            return Largest(0.0, -1, 0)
        k = int(first_largest(np.abs(chosen)))
        position = k if isinstance(positions, slice) else int(positions[k])
        unknown = position if unknowns is None else int(unknowns[position])
        return Largest(float(chosen[k]), int(self._dofs.node[unknown]), int(self._dofs.dof[unknown]))


def _positions(mask: NDArray[np.bool_]) -> Positions:
    return slice(None) if mask.all() else np.flatnonzero(mask)


def _largest(vector: FloatArray, positions: Positions) -> float:
    return float(np.abs(vector[positions]).max(initial=0.0))
