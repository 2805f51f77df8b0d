# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Convergence checks of all fields after an iteration."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import astuple, dataclass, field

import numpy as np
from numpy.typing import NDArray

from uel.assembly import Constraints, DofMap, System
from uel.elements import FIELD_NAMES, VOLUME
from uel.model.arrays import FloatArray, IntArray, first_largest
from uel.model.contact import CONTACT
from uel.model.controls import Controls, FieldControls
from uel.model.couplings import COUPLING, CouplingErrors
from uel.model.dofs import ROTATIONS, dof_in_deck
from uel.model.mesh import Mesh
from uel.model.records import Convergence, FieldCheck, Largest
from uel.model.restart import Saved
from uel.procedures.general.average_flux import FluxHistory, spatial_average
from uel.procedures.general.convergence import FieldMeasures, estimated_correction, judge
from uel.procedures.general.incrementation import Cutback, judge_rate, out_of_iterations
from uel.solver.newton import Iterate

CONTROLLED_AS = dict(
    zip(
        (name for name in FIELD_NAMES if name not in (VOLUME, CONTACT, COUPLING)),
        ("DISPLACEMENT", "ROTATION", "PORE FLUID PRESSURE", "ELECTRICAL POTENTIAL", "TEMPERATURE", "CONCENTRATION"),
        strict=True,
    )
)
"""FIELD= of *CONTROLS by field."""


Positions = IntArray | slice
"""Positions of a field's entries in a vector; a slice if that is all of it, which is much faster."""


@dataclass(slots=True)
class FieldChecker:
    """Checks of one field: its unknowns, its controls, and the results of earlier iterations and increments.

    unknowns   unknowns of the field
    free       positions of its free unknowns in the reduced vector
    average    its time average flux in the last check, or that of another field if it is `converted`
    """

    number: int
    controls: FieldControls
    unknowns: Positions
    free: Positions
    history: FluxHistory
    residuals: list[float] = field(default_factory=list)
    flux: float = 0.0
    peak: float = 0.0
    average: float = 0.0
    converted: bool = False

    @property
    def name(self) -> str:
        """Name of the field."""
        return FIELD_NAMES[self.number]


class Checker:
    """Convergence checks of the increments of one step.

    length   characteristic length of elements with rotations, which converts moments to forces; 0 without rotations
    convert  CONVERT SDI: severe discontinuity iterations may end an increment
    """

    def __init__(
        self,
        dofs: DofMap,
        constraints: Constraints,
        controls: Controls,
        histories: Sequence[FluxHistory],
        length: float = 0.0,
        *,
        convert: bool = True,
    ) -> None:
        self._dofs = dofs
        self._length = length
        self._constraints = constraints
        self._free = constraints.free
        self._time = controls.time
        self._start: list[float] = []
        self.fields = []
        self._controls, self._convert_sdi = controls, convert
        self._last_severe = 0
        volume = FIELD_NAMES.index(VOLUME)
        self._pressures = np.flatnonzero(dofs.field[self._free] == volume)
        for number in np.unique(dofs.field[dofs.field < volume]):
            chosen = controls.fields.get(CONTROLLED_AS[FIELD_NAMES[number]], controls.default)
            unknowns = _positions(dofs.field == number)
            free = _positions(dofs.field[self._free] == number)
            history = histories[number].next_step(chosen)
            self.fields.append(FieldChecker(int(number), chosen, unknowns, free, history))

    @property
    def flux_floor(self) -> FloatArray:
        """Element nodal forces (fields,) that do not count in the average flux in the next increment.

        From the second increment of a step on, forces that count as zero beside the time average of the largest force
        are left out: message files of Abaqus on a cube in uniaxial tension show the average of the other entries. All
        forces count while the largest one is small beside its time average: so do heat fluxes of a cube after a first
        peak, until they reach a tenth of it.
        """
        floor = np.full(len(FIELD_NAMES), -1.0)
        for checked in self.fields:
            floor[checked.number] = checked.history.floor(checked.controls)
        return floor

    def start(self, state: Iterate, *, extrapolated: bool) -> None:
        """Begin an attempt with the state before the first solve.

        If it is an extrapolation, its residual enters the estimate of the correction in iteration 1.
        """
        self._last_severe = 0
        for checked in self.fields:
            checked.residuals = []
        self._start = [_largest(state.r_q, checked.free) if extrapolated else 0.0 for checked in self.fields]

    def check(self, state: Iterate) -> tuple[FieldCheck, ...]:
        """Check all fields after an iteration, then volumes, distributing couplings and contact."""
        if is_severe(state):
            self._last_severe = state.iteration
            for checked in self.fields:
                # the rate of convergence is measured from here on
                checked.residuals = checked.residuals[-1:]
        for checked in self.fields:
            self._take_flux(checked, state)
        self._convert()
        checks = tuple(self._check(k, checked, state) for k, checked in enumerate(self.fields))
        if len(self._pressures):
            checks = (*checks, self._check_volume(state))
        if state.evaluation.coupling is not None:
            checks = (*checks, self._check_coupling(state, state.evaluation.coupling))
        return (*checks, self._check_contact(state)) if state.evaluation.contact else checks

    def find_cutback(self, iteration: int, checks: Sequence[FieldCheck]) -> Cutback | None:
        """Return a cutback after these checks, None to continue iterating.

        iteration: number of iterations since the last severe discontinuity.
        """
        # checks of volume, couplings and contact come after those of the fields
        for checked, check in zip(self.fields, checks, strict=False):
            if check.verdict is Convergence.NOT_ACHIEVED:
                tolerance = checked.controls.r_n * check.time_average_flux
                cutback = judge_rate(iteration, checked.residuals, tolerance, self._time)
                if cutback is not None:
                    return cutback
        return out_of_iterations(iteration, self._time)

    def assumed_zero_flux(self, checks: Sequence[FieldCheck]) -> Iterator[FieldCheck]:
        """Yield checks that pass as zero flux only because of Abaqus' initial time average flux."""
        for checked, check in zip(self.fields, checks, strict=False):
            controls = checked.controls
            assumed = checked.history.has_no_estimate(controls) and not checked.converted
            unbalanced = abs(check.residual.value) > controls.r_n * check.average_flux > 0.0
            if check.verdict is Convergence.ZERO_FLUX and assumed and unbalanced:
                yield check

    def negligible_force(self) -> float:
        """Return the largest residual accepted without a correction (R_l) in every field with flux; 0 before any."""
        fluxes = [(field.history.flux_so_far, field.controls.r_l) for field in self.fields]
        return min((r_l * flux for flux, r_l in fluxes if flux > 0.0), default=0.0)

    def time_averages(self) -> dict[str, float]:
        """Return the time average flux of each field after the last check."""
        return {field.name: field.average for field in self.fields}

    def largest_ratio(self, residual: FloatArray, tolerances: Mapping[str, float]) -> float:
        """Return the largest ratio of residual to tolerance over the fields with a tolerance."""
        reduced = self._constraints.reduce_vector(residual)
        ratios = [0.0]
        for checked in self.fields:
            largest = _largest(reduced, checked.free)
            if checked.name in tolerances and largest:
                tolerance = tolerances[checked.name]
                ratios.append(largest / tolerance if tolerance else math.inf)
        return max(ratios)

    def converged(self) -> None:
        """Include the last fluxes in the time average."""
        for checked in self.fields:
            if not checked.converted:
                checked.history = checked.history.converged(checked.flux, checked.controls, checked.peak)

    def kept(self) -> Saved:
        """Return the flux histories of the step by field."""
        return {checked.name: list(astuple(checked.history)) for checked in self.fields}

    def resume(self, saved: Saved) -> None:
        """Restore what `kept` returned."""
        for checked in self.fields:
            checked.history = FluxHistory(*saved[checked.name])

    def histories(self, before: Sequence[FluxHistory]) -> list[FluxHistory]:
        """Return the flux histories by field number, at the end of the step."""
        after = list(before)
        for checked in self.fields:
            after[checked.number] = checked.history
        return after

    def _take_flux(self, checked: FieldChecker, state: Iterate) -> None:
        """Update the average flux of a field after an iteration, and its time average."""
        checked.peak = float(state.evaluation.largest[checked.number])
        checked.flux = spatial_average(state.evaluation, checked.number, checked.history)
        checked.average, checked.converted = checked.history.average(checked.flux, checked.controls), False

    def _convert(self) -> None:
        """Use moments over a length as the average force if forces count as zero beside them; and the reverse.

        Otherwise forces that are rounding errors of moments would be compared with themselves. According to Abaqus, the
        field conversion ratio scales the relationship between two active fields when one is of negligible magnitude;
        message files have FROM MOMENT FIELD. Inferred are the length, that of elements with rotations, and the
        condition: no increment had forces, and they count as zero by the criterion for zero flux.
        """
        force, moment = (next((c for c in self.fields if c.name == name), None) for name in ("force", "moment"))
        if force is None or moment is None or not self._length:
            return
        for checked, other, length in ((force, moment, 1 / self._length), (moment, force, self._length)):
            controls = checked.controls
            if other.converted or not other.history.step_has_flux(other.flux, other.controls):
                continue
            average = controls.c_f * length * other.average
            if checked.history.has_no_estimate(controls) and checked.flux <= controls.eps * average:
                checked.average, checked.converted = average, True

    def _check(self, k: int, checked: FieldChecker, state: Iterate) -> FieldCheck:
        time_average = checked.average
        residual = self._find(state.r_q, checked.free, self._free)
        increment = self._find(state.du, checked.unknowns)
        correction = self._find(state.ddu, checked.unknowns)
        previous = checked.residuals[-1] if checked.residuals else self._start[k]
        checked.residuals.append(abs(residual.value))
        check = FieldMeasures(
            q=checked.flux,
            q_time=time_average,
            r=abs(residual.value),
            r_previous=previous or None,
            du=abs(increment.value),
            c=abs(correction.value),
            iteration=max(state.iteration - self._last_severe, 1),
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
            converted=checked.converted,
        )

    def _check_volume(self, state: Iterate) -> FieldCheck:
        """Check that the volume changes of hybrid elements by displacements and by pressure agree.

        Abaqus' volumetric strain compatibility tolerance for hybrid solids.
        """
        chosen = state.r_q[self._pressures]
        k = int(first_largest(np.abs(chosen)))
        nothing = Largest(0.0, -1, 0)
        largest = Largest(float(chosen[k]), -1, 0, self._dofs.element(int(self._free[self._pressures[k]])))
        verdict = _verdict(state, fulfilled=abs(largest.value) <= self._controls.volume)
        return FieldCheck(VOLUME, 0.0, 0.0, largest, nothing, nothing, verdict)

    def _check_coupling(self, state: Iterate, errors: CouplingErrors) -> FieldCheck:
        """Check that reference nodes move with the nodes of their distributing couplings.

        Abaqus' displacement and rotation compatibility tolerances.
        """
        displacement, rotation = Largest(*errors.displacement, 0), Largest(*errors.rotation, 0)
        controls, nothing = self._controls, Largest(0.0, -1, 0)
        within = displacement.value <= controls.coupling and rotation.value <= controls.coupling_rotation
        verdict = _verdict(state, fulfilled=within)
        return FieldCheck(COUPLING, 0.0, 0.0, displacement, nothing, rotation, verdict)

    def _check_contact(self, state: Iterate) -> FieldCheck:
        """Check penetrations and contact forces.

        Penetrations must be small beside the largest increment of displacement, forces of points that opened or closed
        beside the time average force. With CONVERT SDI=NO no iteration passes that changes the status of a point.
        """
        pairs, controls, nothing = state.evaluation.contact, self._controls, Largest(0.0, -1, 0)
        penetration = _worst(Largest(*changes.penetration, 0, changes.pair) for changes in pairs)
        force = _worst(Largest(*changes.force, 0, changes.pair) for changes in pairs)
        field = next(checked for checked in self.fields if checked.name == "force")
        verdict = Convergence.CONVERGED
        if abs(penetration.value) > controls.contact * _largest(state.du, field.unknowns):
            verdict = Convergence.NOT_ACHIEVED
        elif is_severe(state) and not (
            self._convert_sdi and abs(force.value) <= controls.contact_force * field.average
        ):
            verdict = Convergence.CORRECTION_TOO_LARGE
        return FieldCheck(CONTACT, 0.0, 0.0, penetration, nothing, force, verdict)

    def _find(self, vector: FloatArray, positions: Positions, unknowns: IntArray | None = None) -> Largest:
        """Return the largest entry of a vector among positions; `unknowns` gives the unknown of each position."""
        chosen = vector[positions]
        if not len(chosen):
            return Largest(0.0, -1, 0)
        k = int(first_largest(np.abs(chosen)))
        position = k if isinstance(positions, slice) else int(positions[k])
        unknown = position if unknowns is None else int(unknowns[position])
        return Largest(float(chosen[k]), int(self._dofs.node[unknown]), dof_in_deck(int(self._dofs.dof[unknown])))


def _worst(values: Iterable[Largest]) -> Largest:
    return max(values, key=lambda largest: abs(largest.value))


def _verdict(state: Iterate, *, fulfilled: bool) -> Convergence:
    """Return the verdict on constraint errors after an iteration."""
    if not fulfilled:
        return Convergence.NOT_ACHIEVED
    return Convergence.LINEAR if state.iteration == 1 else Convergence.CONVERGED


def is_severe(state: Iterate) -> bool:
    """Return whether an iteration changed the status of a contact point."""
    return any(changes.count for changes in state.evaluation.contact)


def was_linear(checks: Sequence[FieldCheck]) -> bool:
    """Return whether an increment that these checks accept was linear in all fields with flux."""
    verdicts = {check.verdict for check in checks}
    return Convergence.LINEAR in verdicts and verdicts <= {Convergence.LINEAR, Convergence.ZERO_FLUX}


def length_of_moments(system: System, mesh: Mesh) -> float:
    """Return the characteristic length of elements with rotations: mean distance of consecutive nodes, or 0.

    Abaqus prints a CHARACTERISTIC ELEMENT LENGTH but does not define it: 1 for squares of edge 1, 9.764E-04 for
    hexahedra whose mean edge is 9.771E-04.
    """
    total, count = 0.0, 0.0
    for block in system.blocks:
        if any(dof in ROTATIONS for _, dof in block.unknowns):
            corners = mesh.coordinates[block.group.nodes]
            distances = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
            total, count = total + float(distances.sum()), count + distances.size
    total, count = system.sum(np.array([total, count])).tolist()
    return total / count if count else 0.0


def _positions(mask: NDArray[np.bool_]) -> Positions:
    return slice(None) if mask.all() else np.flatnonzero(mask)


def _largest(vector: FloatArray, positions: Positions) -> float:
    return float(np.abs(vector[positions]).max(initial=0.0))
