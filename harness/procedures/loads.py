# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Prescribed values and concentrated loads over time, and what of them goes on from step to step.

Abaqus Analysis User's Guide, "Prescribed conditions: overview", "Amplitude curves", *BOUNDARY, *CLOAD:

- without an amplitude a value ramps from where the previous step ended (RAMP), or is there at once (STEP), as
  AMPLITUDE= of *STEP says; prescribed displacements and rotations always ramp;
- with an amplitude it is the magnitude times the curve, or the curve itself (VALUE=ABSOLUTE);
- in later steps that do not give it anew it stays at the end value, or goes on along a curve in total time;
- OP=NEW removes what is not given anew: a load, and the reaction of a released degree of freedom, fade over the step
  (RAMP) or vanish at once (STEP).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from harness.assembly import DofMap
from harness.errors import Source
from harness.model.amplitude import Amplitude
from harness.model.arrays import FloatArray, IntArray
from harness.model.steps import Boundary, Load, Step

_LAST_ROTATION = 7
"""Dofs 1 to 7 are displacements, rotations and warping."""


@dataclass(frozen=True, slots=True)
class Curve:
    """Unknowns whose values are `magnitude` times an amplitude."""

    unknowns: IntArray
    magnitude: float
    amplitude: Amplitude

    def value(self, step_time: float, total_time: float) -> float:
        """Value at a time."""
        factor = self.amplitude.value(step_time, total_time)
        return factor if self.amplitude.absolute else self.magnitude * factor

    def without(self, unknowns: IntArray) -> Curve:
        """The same curve for fewer unknowns."""
        return Curve(self.unknowns[~np.isin(self.unknowns, unknowns)], self.magnitude, self.amplitude)


@dataclass(frozen=True, slots=True)
class Variation:
    """Values of all unknowns over one step: base + slope t/T + curves."""

    base: FloatArray
    slope: FloatArray
    period: float
    curves: tuple[Curve, ...] = ()

    def at(self, step_time: float, total_time: float) -> FloatArray:
        """Values (n,) at a time."""
        values = self.base + self.slope * (step_time / self.period)
        for curve in self.curves:
            values[curve.unknowns] += curve.value(step_time, total_time)
        return values


def find_unknowns(dofs: DofMap, entry: Boundary | Load) -> tuple[IntArray, IntArray]:
    """Unknowns of an entry, and the nodes where no element uses its dof."""
    found = dofs.find(entry.nodes, entry.dof)
    return found[found >= 0], entry.nodes[found < 0]


class Boundaries:
    """Prescribed degrees of freedom through the steps."""

    def __init__(self, dofs: DofMap, model_data: Sequence[Boundary]) -> None:
        """model_data: *BOUNDARY before the first step, all of them zero."""
        self._dofs = dofs
        self._active = np.zeros(len(dofs), dtype=bool)
        self._curves: tuple[Curve, ...] = ()
        self.sources: dict[int, Source] = {}
        for entry in model_data:
            self._activate(entry)

    @property
    def unknowns(self) -> IntArray:
        """Prescribed unknowns of the current step, ascending."""
        return np.flatnonzero(self._active)

    def start_step(self, step: Step, displacement: FloatArray) -> Variation:
        """Take over a step's entries; displacement (n,) is that at the end of the previous step."""
        if step.new_boundary:
            self._active[:] = False
            self._curves = ()
            self.sources.clear()
        base, slope = displacement.copy(), np.zeros_like(displacement)
        curves = [curve for curve in self._curves if curve.amplitude.total_time]
        for entry in step.boundaries:
            unknowns = self._activate(entry)
            curves = [curve.without(unknowns) for curve in curves]
            base[unknowns], slope[unknowns] = 0.0, 0.0
            if entry.amplitude is not None:
                curves.append(Curve(unknowns, entry.magnitude, entry.amplitude))
            elif step.amplitude == "RAMP" or entry.dof <= _LAST_ROTATION:
                base[unknowns] = displacement[unknowns]
                slope[unknowns] = entry.magnitude - displacement[unknowns]
            else:
                base[unknowns] = entry.magnitude
        for curve in curves:
            base[curve.unknowns] = 0.0
        self._curves = tuple(curves)
        return Variation(base, slope, step.procedure.period, self._curves)

    def _activate(self, entry: Boundary) -> IntArray:
        unknowns, _ = find_unknowns(self._dofs, entry)
        self._active[unknowns] = True
        self.sources.update(dict.fromkeys(unknowns.tolist(), entry.source))
        return unknowns


class Loads:
    """Concentrated loads through the steps; several entries of a step at one unknown add up."""

    def __init__(self, dofs: DofMap) -> None:
        self._dofs = dofs
        zero = np.zeros(len(dofs))
        self._previous = Variation(zero, zero, 1.0)

    def start_step(self, step: Step, total_time: float) -> Variation:
        """Take over a step's entries; total_time is that at the end of the previous step."""
        reached = self._previous.at(self._previous.period, total_time)
        given = [(entry, find_unknowns(self._dofs, entry)[0]) for entry in step.loads]
        anew = np.concatenate([np.zeros(0, dtype=np.int64), *(unknowns for _, unknowns in given)])
        curves: list[Curve] = []
        if step.new_loads:
            held, start = np.zeros_like(reached), reached.copy()
        else:
            held = reached.copy()
            curves = [curve.without(anew) for curve in self._previous.curves if curve.amplitude.total_time]
            # those go on by themselves: only the rest is held
            for curve in curves:
                held[curve.unknowns] -= curve.value(0.0, total_time)
            start = held.copy()
        target = held.copy()
        target[anew] = 0.0
        start[anew] = reached[anew]
        for entry, unknowns in given:
            if entry.amplitude is None:
                np.add.at(target, unknowns, entry.magnitude)
            else:
                curves.append(Curve(unknowns, entry.magnitude, entry.amplitude))
                start[unknowns] = 0.0
        if step.amplitude != "RAMP":
            start = target
        self._previous = Variation(start, target - start, step.procedure.period, tuple(curves))
        return self._previous


def released_reactions(reaction: FloatArray, prescribed: IntArray, step: Step) -> Variation:
    """Reactions of degrees of freedom that the step releases: applied as loads that fade.

    reaction (n,) is that at the end of the previous step, prescribed the unknowns prescribed in this one.
    """
    released = reaction.copy()
    released[prescribed] = 0.0
    if step.amplitude != "RAMP":
        released[:] = 0.0
    return Variation(released, -released, step.procedure.period)
