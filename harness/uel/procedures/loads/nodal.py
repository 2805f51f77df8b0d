# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Prescribed values and concentrated loads of each step, and how they continue from step to step.

`variation.py` has their values at a time.

Abaqus Analysis User's Guide, "Prescribed conditions: overview", "Amplitude curves", *BOUNDARY, *CLOAD:

- without an amplitude a value ramps from where the previous step ended (RAMP), or acts at once (STEP), as
  AMPLITUDE= of *STEP says; prescribed displacements and rotations always ramp;
- with an amplitude it is the magnitude times the amplitude, or the amplitude itself (VALUE=ABSOLUTE);
- in later steps that do not mention it, it keeps its final value, or continues along an amplitude in total time;
- FIXED holds a value as it is at the start of the step;
- TYPE=VELOCITY prescribes the rate, by default constant over the step, and continues in later steps;
- OP=NEW removes what the step does not mention: a load, and the reaction of a released degree of freedom, fade over
  the step (RAMP) or vanish at once (STEP).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from uel.assembly import DofMap
from uel.errors import Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.dofs import dof_in_deck
from uel.model.steps import Boundary, InitialValue, Load, Step
from uel.procedures.loads.variation import PrescribedRate, ScaledUnknowns, Variation

_LAST_ROTATION = 7
"""Dofs 1 to 7 are displacements, rotations and warping."""


def find_unknowns(dofs: Unknowns, entry: Boundary | Load | InitialValue) -> tuple[IntArray, IntArray]:
    """Return the unknowns of an entry, and the nodes where no element uses its dof."""
    unknowns = dofs.find(entry.nodes, entry.dof)
    return unknowns[unknowns >= 0], entry.nodes[unknowns < 0]


def initial_values(dofs: DofMap, entries: Sequence[InitialValue]) -> FloatArray:
    """Return the values (n,) of *INITIAL CONDITIONS; later entries replace earlier ones."""
    values = np.zeros(len(dofs))
    for entry in entries:
        values[find_unknowns(dofs, entry)[0]] = entry.value
    return values


class Boundaries:
    """Prescribed degrees of freedom through the steps."""

    def __init__(self, dofs: DofMap, model_data: Sequence[Boundary]) -> None:
        """Start with `model_data`: *BOUNDARY before the first step, all of them zero."""
        self._dofs = dofs
        self._active = np.zeros(len(dofs), dtype=bool)
        self._curves: tuple[ScaledUnknowns, ...] = ()
        self._rates: tuple[PrescribedRate, ...] = ()
        self._period = 1.0
        self._by_user = np.zeros(len(dofs), dtype=bool)
        self.sources: dict[int, Source] = {}
        for entry in model_data:
            self._activate(entry)

    @property
    def unknowns(self) -> IntArray:
        """Prescribed unknowns of the current step, ascending."""
        return np.flatnonzero(self._active)

    @property
    def by_user(self) -> IntArray:
        """Unknowns whose values DISP defines."""
        return np.flatnonzero(self._active & self._by_user)

    def start_step(self, step: Step, displacement: FloatArray, total_time: float = 0.0) -> Variation:
        """Take over a step's entries; displacement (n,) and total time are those at the end of the previous step."""
        if step.new_boundary:
            self._active[:] = False
            self._curves, self._rates = (), ()
            self.sources.clear()
        base, slope = displacement.copy(), np.zeros_like(displacement)
        curves = [curve for curve in self._curves if curve.amplitude.total_time]
        rates = [rate.continued(self._period, displacement, total_time) for rate in self._rates]
        for entry in step.boundaries:
            unknowns = self._activate(entry)
            curves = [curve.without(unknowns) for curve in curves]
            rates = [rate.without(unknowns) for rate in rates]
            base[unknowns], slope[unknowns] = 0.0, 0.0
            if entry.velocity:
                # the default is always a velocity that acts at once
                start = displacement[unknowns]
                rates.append(PrescribedRate(unknowns, entry.magnitude, entry.amplitude, start, total_time))
            elif entry.fixed:
                base[unknowns] = displacement[unknowns]
            elif entry.amplitude is not None:
                curves.append(ScaledUnknowns(unknowns, entry.magnitude, entry.amplitude))
            elif step.amplitude == "RAMP" or dof_in_deck(entry.dof) <= _LAST_ROTATION:
                base[unknowns] = displacement[unknowns]
                slope[unknowns] = entry.magnitude - displacement[unknowns]
            else:
                base[unknowns] = entry.magnitude
        for curve in curves:
            base[curve.unknowns] = 0.0
        self._curves, self._rates = tuple(curves), tuple(rates)
        self._period = step.procedure.period
        return Variation(base, slope, self._period, self._curves, self._rates)

    def in_perturbation(self, step: Step) -> IntArray:
        """Return the prescribed unknowns of a perturbation step, ascending; later steps do not keep them."""
        active = np.zeros_like(self._active) if step.new_boundary else self._active.copy()
        for entry in step.boundaries:
            active[find_unknowns(self._dofs, entry)[0]] = True
        return np.flatnonzero(active)

    def perturbations(self, step: Step) -> FloatArray:
        """Return the prescribed changes (n,) of a perturbation step."""
        values = np.zeros(len(self._dofs))
        for entry in step.boundaries:
            values[find_unknowns(self._dofs, entry)[0]] = 0.0 if entry.fixed else entry.magnitude
        return values

    def perturbed_by_user(self, step: Step) -> IntArray:
        """Return the unknowns (k,) whose changes DISP defines in a perturbation step, ascending."""
        by_user = [find_unknowns(self._dofs, entry)[0] for entry in step.boundaries if entry.user]
        return np.unique(np.concatenate([np.zeros(0, dtype=np.int64), *by_user]))

    def conclude(self, step_time: float) -> None:
        """End the step before its period."""
        self._period = step_time

    def _activate(self, entry: Boundary) -> IntArray:
        unknowns, _ = find_unknowns(self._dofs, entry)
        self._active[unknowns] = True
        self._by_user[unknowns] = entry.user
        self.sources.update(dict.fromkeys(unknowns.tolist(), entry.source))
        return unknowns


class Unknowns(Protocol):
    """Numbering of pairs, such as unknowns by node and dof."""

    def __len__(self) -> int:
        """Return their number."""

    def find(self, nodes: IntArray | int, dof: IntArray | int) -> IntArray:
        """Return the numbers of pairs; -1 for one that does not exist."""


class Loads:
    """Concentrated loads through the steps; entries of a step for the same unknown add up.

    initial: values before the first step, to which removed loads return; zero by default.
    """

    def __init__(self, dofs: Unknowns, initial: FloatArray | None = None) -> None:
        self._dofs = dofs
        self._initial = np.zeros(len(dofs)) if initial is None else initial
        self._previous = Variation(self._initial, np.zeros(len(dofs)), 1.0)

    def start_step(self, step: Step, total_time: float) -> Variation:
        """Take over a step's concentrated loads; total_time is that at the end of the previous step."""
        return self.take(step.loads, step.new_loads, step, total_time)

    def take(self, entries: Sequence[Load], new: bool, step: Step, total_time: float) -> Variation:
        """Take over entries of a step; new: those of earlier steps are removed."""
        reached = self.reached(total_time)
        mentioned = [(entry, find_unknowns(self._dofs, entry)[0]) for entry in entries]
        loaded = np.concatenate([np.zeros(0, dtype=np.int64), *(unknowns for _, unknowns in mentioned)])
        curves: list[ScaledUnknowns] = []
        if new:
            held, start = self._initial.copy(), reached.copy()
        else:
            held = reached.copy()
            curves = [curve.without(loaded) for curve in self._previous.curves if curve.amplitude.total_time]
            # these continue along their amplitudes; only the rest is constant
            for curve in curves:
                held[curve.unknowns] -= curve.value(0.0, total_time)
            start = held.copy()
        target = held.copy()
        target[loaded] = 0.0
        start[loaded] = reached[loaded]
        for entry, unknowns in mentioned:
            if entry.amplitude is None:
                np.add.at(target, unknowns, entry.magnitude)
            else:
                curves.append(ScaledUnknowns(unknowns, entry.magnitude, entry.amplitude))
                start[unknowns] = 0.0
        if step.amplitude != "RAMP":
            start = target
        self._previous = Variation(start, target - start, step.procedure.period, tuple(curves))
        return self._previous

    def reached(self, total_time: float) -> FloatArray:
        """Return the values (n,) at the end of the last general step."""
        return self._previous.at(self._previous.period, total_time)

    def in_perturbation(self, entries: Sequence[Load]) -> FloatArray:
        """Return the values (n,) of a perturbation step; later steps do not keep them."""
        values = np.zeros(len(self._dofs))
        for entry in entries:
            np.add.at(values, find_unknowns(self._dofs, entry)[0], entry.magnitude)
        return values

    def conclude(self, step_time: float) -> None:
        """End the step before its period, with the values reached so far."""
        slope = self._previous.slope * (step_time / self._previous.period)
        self._previous = replace(self._previous, slope=slope, period=step_time)


class Slots:
    """Numbers of pairs (element or node, load type or field), for `Loads`.

    owners, kinds  elements or nodes, and kinds, of the pairs
    """

    def __init__(self, pairs: Sequence[tuple[IntArray, int]]) -> None:
        """Assign a number to each pair: an element or node with a kind; a pair may occur several times."""
        # JDLTYP of a nonuniform load is negative
        self._least = min((kind for _, kind in pairs), default=0)
        self._kinds = 1 + max((kind for _, kind in pairs), default=0) - self._least
        keys = [np.zeros(0, dtype=np.int64), *(self._keys(owners, kind) for owners, kind in pairs)]
        self._sorted = np.unique(np.concatenate(keys))
        self.owners, self.kinds = self._sorted // self._kinds, self._sorted % self._kinds + self._least

    def __len__(self) -> int:
        return len(self._sorted)

    def _keys(self, owners: IntArray | int, kind: IntArray | int) -> IntArray:
        return np.atleast_1d(owners).astype(np.int64) * self._kinds + int(kind) - self._least

    def find(self, owners: IntArray | int, kind: IntArray | int) -> IntArray:
        """Return the numbers of the pairs, which must exist."""
        return np.searchsorted(self._sorted, self._keys(owners, kind))

    def find_some(self, owners: IntArray, kind: int) -> IntArray:
        """Return the numbers of the pairs that exist."""
        numbers = self.find(owners, kind)
        known = numbers < len(self)
        numbers, keys = numbers[known], self._keys(owners, kind)[known]
        return np.asarray(numbers[self._sorted[numbers] == keys])


def fading_forces(reaction: FloatArray, prescribed: IntArray, step: Step, unbalanced: FloatArray) -> Variation:
    """Return forces that fade in a step: reactions of released degrees of freedom, and `unbalanced` ones.

    reaction: (n,) at the end of the previous step. prescribed: unknowns prescribed in this one. unbalanced: forces (n,)
    that balance initial stresses at the start; they fade with any AMPLITUDE= of the step.
    """
    released = reaction.copy()
    released[prescribed] = 0.0
    if step.amplitude != "RAMP":
        released[:] = 0.0
    fading = released + unbalanced
    return Variation(fading, -fading, step.procedure.period)
