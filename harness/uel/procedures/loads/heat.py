# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Heat loads on faces, volumes and nodes through the steps.

Fluxes and sink temperatures vary as *CLOAD does; a film coefficient without FILM AMPLITUDE, and an
emissivity, are constant from the start of the step on (Abaqus Keywords Guide, *FILM, *RADIATE).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from uel.assembly import System
from uel.elements import Distributed
from uel.model.arrays import FloatArray, IntArray
from uel.model.model import Model
from uel.model.steps import HeatLoad, HeatLoadType, Load, Step
from uel.procedures.loads.nodal import Loads, Slots
from uel.procedures.loads.variation import Variation


@dataclass(frozen=True, slots=True)
class StepHeat:
    """Active heat loads of one step.

    elements      (k,) positions among the elements, after those of the model
    values        (k,) numbers of the fluxes or sink temperatures among all magnitudes
    coefficients  (k,) numbers of the film coefficients or emissivities, -1 for a flux
    variations    variations of the magnitudes, keyword by keyword
    """

    elements: IntArray
    values: IntArray
    coefficients: IntArray
    variations: tuple[Variation, ...]

    def between(self, start: tuple[float, float], end: tuple[float, float]) -> Distributed | None:
        """Return the loads of an increment between these step and total times, as elements get them; or None."""
        if not len(self.elements):
            return None
        both = self.coefficients >= 0
        elements = np.concatenate([self.elements, self.elements[both]])
        slots = np.concatenate([self.values, self.coefficients[both]])
        kinds = np.concatenate([np.ones(len(both), dtype=np.int64), np.full(both.sum(), 2)])
        after, before = self._at(end)[slots], self._at(start)[slots]
        order = np.argsort(elements, kind="stable")
        return Distributed(elements[order], kinds[order], after[order], (after - before)[order])

    def _at(self, times: tuple[float, float]) -> FloatArray:
        return np.concatenate([np.zeros(0), *(variation.at(*times) for variation in self.variations)])


class HeatLoads:
    """Heat loads through the steps: magnitudes by keyword, as each has its own OP=."""

    def __init__(self, system: System, model: Model) -> None:
        self._blocks = system.contributors.heat
        entries = [entry for step in model.steps for entry in step.heat_loads]
        self._keywords = list(dict.fromkeys(entry.type.keyword for entry in entries))
        self._all = [_KeywordLoads([e for e in entries if e.type.keyword == keyword]) for keyword in self._keywords]

    def start_step(self, step: Step, total_time: float) -> StepHeat:
        """Take over a step's entries; total_time is that at the end of the previous step."""
        variations = []
        for keyword, loads in zip(self._keywords, self._all, strict=True):
            of_keyword = [entry for entry in step.heat_loads if entry.type.keyword == keyword]
            variations.append(loads.take(of_keyword, keyword in step.new_heat_loads, step, total_time))
        first = np.cumsum([0, *(len(loads.slots) for loads in self._all)])
        elements, values, coefficients = [], [], []
        for block in self._blocks:
            k = self._keywords.index(block.load.keyword)
            slots, active = self._all[k].find(block.places, block.load, 0)
            second = np.full(len(slots), -1)
            if block.load.exchanges:
                second = first[k] + self._all[k].find(block.places, block.load, 1)[0]
            elements.append((block.first + block.rows)[active])
            values.append(first[k] + slots[active])
            coefficients.append(second[active])
        none = np.zeros(0, dtype=np.int64)
        return StepHeat(
            np.concatenate([none, *elements]),
            np.concatenate([none, *values]),
            np.concatenate([none, *coefficients]),
            tuple(variations),
        )

    def conclude(self, step_time: float) -> None:
        """End the step before its period."""
        for loads in self._all:
            loads.magnitudes.conclude(step_time)


class _KeywordLoads:
    """Loads of one keyword: a magnitude for each node or face and type, two for films and radiation."""

    def __init__(self, entries: Sequence[HeatLoad]) -> None:
        self._types = list(dict.fromkeys(entry.type for entry in entries))
        pairs = [(e.places, self._kind(e.type, part)) for e in entries for part in range(1 + e.type.exchanges)]
        self.slots = Slots(pairs)
        self.magnitudes = Loads(self.slots)
        self._active = np.zeros(len(self.slots), dtype=bool)

    def _kind(self, load: HeatLoadType, part: int) -> int:
        return 2 * self._types.index(load) + part

    def find(self, owners: IntArray, load: HeatLoadType, part: int) -> tuple[IntArray, IntArray]:
        """Return the numbers of the magnitudes on nodes or faces, and whether each is active."""
        slots = self.slots.find(owners, self._kind(load, part))
        return slots, self._active[slots]

    def take(self, entries: Sequence[HeatLoad], new: bool, step: Step, total_time: float) -> Variation:
        """Take over entries of a step; new: those of earlier steps are removed."""
        if new:
            self._active[:] = False
        loads = [] if new else list(self._replaced(entries))
        for entry in entries:
            for part in range(1 + entry.type.exchanges):
                self._active[self.slots.find(entry.places, self._kind(entry.type, part))] = True
            loads.append(Load(entry.places, self._kind(entry.type, 0), entry.magnitude, entry.amplitude, entry.source))
        varying = self.magnitudes.take([*loads, *self._coefficients(entries)], new, step, total_time)
        return self._at_once(varying, entries)

    def _replaced(self, entries: Sequence[HeatLoad]) -> Iterator[Load]:
        """Yield zero loads for films and radiation of earlier steps that these entries replace."""
        for entry in entries:
            for load in self._types if entry.type.exchanges else ():
                if load.number and replace(load, number=0) == replace(entry.type, number=0):
                    slots = self.slots.find_some(entry.places, self._kind(load, 0))
                    slots = slots[self._active[slots]]
                    owners = self.slots.owners[slots]
                    for part in range(2):
                        kind = self._kind(load, part)
                        self._active[self.slots.find(owners, kind)] = False
                        yield Load(owners, kind, 0.0, None, entry.source)

    def _coefficients(self, entries: Sequence[HeatLoad]) -> list[Load]:
        exchanges = [entry for entry in entries if entry.type.exchanges]
        return [Load(e.places, self._kind(e.type, 1), e.coefficient, e.film_amplitude, e.source) for e in exchanges]

    def _at_once(self, varying: Variation, entries: Sequence[HeatLoad]) -> Variation:
        """Apply coefficients without an amplitude at once: they do not ramp."""
        base, slope = varying.base.copy(), varying.slope.copy()
        for load in self._coefficients(entries):
            if load.amplitude is None:
                slots = self.slots.find(load.nodes, load.dof)
                base[slots], slope[slots] = base[slots] + slope[slots], 0.0
        return replace(varying, base=base, slope=slope)
