# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Distributed loads on user elements and predefined fields through the steps, as elements get them.

Both vary as *CLOAD does. A field that a step removes (OP=NEW) goes back to its initial value.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from harness.elements import Distributed, Predefined
from harness.model.arrays import FloatArray, IntArray
from harness.model.model import Model
from harness.model.steps import Load, Step
from harness.procedures.loads import Loads, Slots, Variation

FIRST_TEMPERATURE = 11
"""The dof whose initial value is also that of the predefined field."""


class Conditions:
    """Loads and fields of all steps."""

    def __init__(self, model: Model) -> None:
        entries = [entry for step in model.steps for entry in step.distributed]
        self._slots = Slots([(entry.elements, entry.kind) for entry in entries])
        self._loads = Loads(self._slots)
        self._active = np.zeros(len(self._slots), dtype=bool)
        numbers = [entry.dof for step in model.steps for entry in step.fields]
        starts = list(model.initial_fields)
        if model.steps and not model.steps[0].procedure.temperatures:
            temperatures = [entry for entry in model.initial_temperatures if entry.dof == FIRST_TEMPERATURE]
            starts += [replace(entry, dof=0) for entry in temperatures]
        count = max([*numbers, *(start.dof for start in starts)], default=-1) + 1
        self._initial = np.zeros(count * len(model.mesh.labels))
        self._nodes = _Grid(len(model.mesh.labels), count)
        for start in starts:
            self._initial[self._nodes.find(start.nodes, start.dof)] = start.value
        self._fields = Loads(self._nodes, self._initial)

    def start_step(self, step: Step, total_time: float) -> StepConditions:
        """Take over a step's entries; total_time is that at the end of the previous step."""
        if step.new_distributed:
            self._active[:] = False
        for entry in step.distributed:
            self._active[self._slots.find(entry.elements, entry.kind)] = True
        return StepConditions(
            self._slots.places[self._active],
            self._slots.kinds[self._active],
            np.flatnonzero(self._active),
            self._loads.take(_as_loads(step), step.new_distributed, step, total_time),
            self._fields.take(step.fields, step.new_fields, step, total_time),
            self._nodes,
            # temperature is the first field
            self._initial[: self._nodes.nodes],
        )

    def in_perturbation(self, step: Step, total_time: float) -> Distributed | None:
        """Loads of the base state, with those of a perturbation step as increments, which do not outlast it."""
        active = self._active.copy()
        for entry in step.distributed:
            active[self._slots.find(entry.elements, entry.kind)] = True
        base, added = self._loads.reached(total_time), self._loads.in_perturbation(_as_loads(step))
        return _distributed(self._slots.places[active], self._slots.kinds[active], base[active], added[active])

    def initial(self) -> Predefined | None:
        """Fields before the first step; None if the model has none."""
        if not len(self._nodes):
            return None
        values = self._initial.reshape(self._nodes.fields, self._nodes.nodes)
        return Predefined(values, np.zeros_like(values), self._initial[: self._nodes.nodes])

    def conclude(self, step_time: float) -> None:
        """The step ends before its period."""
        self._loads.conclude(step_time)
        self._fields.conclude(step_time)


@dataclass(frozen=True, slots=True)
class _Grid:
    """Numbers of (node, field), fields one after the other."""

    nodes: int
    fields: int

    def __len__(self) -> int:
        return self.nodes * self.fields

    def find(self, nodes: IntArray | int, field: IntArray | int) -> IntArray:
        return np.asarray(np.asarray(field) * self.nodes + nodes, dtype=np.int64)


@dataclass(frozen=True, slots=True)
class StepConditions:
    """Conditions of one step: the active loads, and how loads and fields vary."""

    elements: IntArray
    kinds: IntArray
    slots: NDArray[np.int64]
    loads: Variation
    fields: Variation
    grid: _Grid
    initial: FloatArray

    def at(self, start: tuple[float, float], end: tuple[float, float]) -> tuple[Distributed | None, Predefined | None]:
        """Loads and fields of an increment between these step and total times."""
        predefined = None
        values, before = self.loads.at(*end)[self.slots], self.loads.at(*start)[self.slots]
        distributed = _distributed(self.elements, self.kinds, values, values - before)
        if len(self.grid):
            shape = self.grid.fields, self.grid.nodes
            values, before = self.fields.at(*end), self.fields.at(*start)
            predefined = Predefined(values.reshape(shape), (values - before).reshape(shape), self.initial)
        return distributed, predefined


def _as_loads(step: Step) -> list[Load]:
    """Distributed loads, as `Loads` takes them."""
    return [Load(e.elements, e.kind, e.magnitude, e.amplitude, e.source) for e in step.distributed]


def _distributed(elements: IntArray, kinds: IntArray, end: FloatArray, increment: FloatArray) -> Distributed | None:
    """The loads as elements get them; None if there are none."""
    if not len(elements):
        return None
    given = kinds > 0  # UEL itself gives the magnitude of type UnNU
    return Distributed(elements, kinds, np.where(given, end, 0.0), np.where(given, increment, 0.0))
