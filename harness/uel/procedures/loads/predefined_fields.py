# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Distributed loads on user elements, and predefined fields, through the steps.

Both vary as *CLOAD does: `variation.py` has their values at a time, `Loads` in `nodal.py` how they continue from step
to step. A field that a step removes (OP=NEW) returns to its initial value. With USER, UTEMP and then UFIELD define the
values at the end of each attempt. `harness/uel/elements/driver_arrays.py` makes the argument PREDEF of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from operator import itemgetter
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from uel.elements import Distributed, Predefined
from uel.model.arrays import FloatArray, IntArray
from uel.model.dofs import TEMPERATURE
from uel.model.mesh import Mesh
from uel.model.model import Model
from uel.model.restart import Saved
from uel.model.steps import PRESSURE_STRESS, Load, Step
from uel.model.user_values import GivesValues, UserValues
from uel.procedures.loads.nodal import Loads, Slots
from uel.procedures.loads.variation import Variation

Times = tuple[float, float]
"""Step and total time."""
Coordinates = Callable[[IntArray], FloatArray]
"""Coordinates (k, 3) of nodes at the start of the increment."""


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
            temperatures = [entry for entry in model.initial_temperatures if entry.dof == TEMPERATURE]
            starts += [replace(entry, dof=0) for entry in temperatures]
        count = max([*numbers, *(start.dof for start in starts)], default=-1) + 1
        if model.diffusive:
            # temperature first, equivalent pressure stress last
            count = max(count, 1) + 1
        self._initial = np.zeros(count * len(model.mesh.labels))
        self._nodes = _Grid(len(model.mesh.labels), count)
        for start in starts:
            self._initial[self._nodes.find(start.nodes, self._row(start.dof))] = start.value
        self._fields = Loads(self._nodes, self._initial)
        self._by_user = np.zeros(len(self._nodes), dtype=bool)
        self._mesh = model.mesh
        self._reached: list[tuple[float, FloatArray]] = [(0.0, self._initial)]

    def _row(self, number: int) -> int:
        """Return the row of a field: that of the equivalent pressure stress is the last one."""
        return self._nodes.fields - 1 if number == PRESSURE_STRESS else number

    def start_step(self, step: Step, total_time: float) -> StepConditions:
        """Take over a step's entries; total_time is that at the end of the previous step."""
        fields = [replace(entry, dof=self._row(entry.dof)) for entry in step.fields]
        if step.new_distributed:
            self._active[:] = False
        for entry in step.distributed:
            self._active[self._slots.find(entry.elements, entry.kind)] = True
        if step.new_fields:
            self._by_user[:] = False
        for field in fields:
            self._by_user[self._nodes.find(field.nodes, field.dof)] = field.user
        return StepConditions(
            self._slots.owners[self._active],
            self._slots.kinds[self._active],
            np.flatnonzero(self._active),
            self._loads.take(_as_loads(step), step.new_distributed, step, total_time),
            self._fields.take(fields, step.new_fields, step, total_time),
            self._nodes,
            # temperature is the first field
            self._initial[: self._nodes.nodes],
            UserFields(step.number, self._mesh, self._nodes, np.flatnonzero(self._by_user), self._reached),
        )

    def in_perturbation(self, step: Step, total_time: float) -> Distributed | None:
        """Return loads of the base state, with those of a perturbation step as increments."""
        active = self._active.copy()
        for entry in step.distributed:
            active[self._slots.find(entry.elements, entry.kind)] = True
        base, added = self._loads.reached(total_time), self._loads.in_perturbation(_as_loads(step))
        return _distributed(self._slots.owners[active], self._slots.kinds[active], base[active], added[active])

    def initial(self) -> Predefined | None:
        """Return the fields before the first step; None if the model has none."""
        if not len(self._nodes):
            return None
        values = self._initial.reshape(self._nodes.fields, self._nodes.nodes)
        return Predefined(values, np.zeros_like(values), self._initial[: self._nodes.nodes])

    def kept(self) -> Saved:
        """Return the fields that UTEMP and UFIELD have set."""
        reached = self._reached if self._by_user.any() else []
        return {"reached": [list(one) for one in reached]}

    def resume(self, saved: Saved) -> None:
        """Restore what `kept` returned. Raises ValueError if the model has other fields."""
        reached = [(time, values) for time, values in saved["reached"]]
        if any(len(values) != len(self._initial) for _, values in reached):
            raise ValueError("predefined fields")
        if reached:
            self._reached[:] = reached

    def conclude(self, step_time: float) -> None:
        """End the step before its period."""
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
class UserFields:
    """Fields that UTEMP and UFIELD define in one step.

    slots    (k,) numbers of (node, field)
    reached  total times and all fields at the ends of increments, ascending; the last ones may belong to attempts
    """

    step: int
    mesh: Mesh
    grid: _Grid
    slots: IntArray
    reached: list[tuple[float, FloatArray]]

    def replace(
        self,
        values: FloatArray,
        before: FloatArray,
        increment: int,
        end: Times,
        user: GivesValues,
        coordinates: Coordinates,
    ) -> None:
        """Write the values of the routines into values (n,); before: values at the start of the increment."""
        nodes, numbers = self.slots % self.grid.nodes, self.slots // self.grid.nodes
        routines: tuple[Literal["UTEMP", "UFIELD"], ...] = ("UTEMP", "UFIELD")
        for routine, chosen in zip(routines, (numbers == 0, numbers > 0), strict=True):
            if not chosen.any():
                continue
            slots, at = self.slots[chosen], nodes[chosen]
            numbered = np.stack([self.mesh.labels[at], numbers[chosen]], axis=1).astype(np.int32)
            temperatures = np.stack([values[at], values[at] - before[at]], axis=1)
            moment = self.step, increment, end
            request = UserValues(routine, *moment, numbered, coordinates(at), values[slots], temperatures)
            values[slots] = user.user_values(request)

    def at(self, total_time: float) -> FloatArray | None:
        """Return all fields at the end of an increment, None if they are not known."""
        return next((values for time, values in reversed(self.reached) if time == total_time), None)

    def keep(self, start: float, end: float, values: FloatArray) -> None:
        """Store the fields at the end of an attempt, which may be in the middle of an increment, and at its start."""
        earlier = [known for known in self.reached if known[0] <= start][-1:]
        others = [known for known in self.reached if known[0] > start and known[0] != end]
        self.reached[:] = sorted([*earlier, *others, (end, values)], key=itemgetter(0))


@dataclass(frozen=True, slots=True)
class StepConditions:
    """Conditions of one step: active loads, and the variations of loads and fields."""

    elements: IntArray
    kinds: IntArray
    slots: NDArray[np.int64]
    loads: Variation
    fields: Variation
    grid: _Grid
    initial: FloatArray
    by_user: UserFields

    def at(
        self, start: Times, end: Times, increment: int, user: GivesValues, coordinates: Coordinates
    ) -> tuple[Distributed | None, Predefined | None]:
        """Return loads and fields of an increment between these step and total times.

        coordinates: returns those of nodes, for UTEMP and UFIELD.
        """
        predefined = None
        distributed = self.distributed(start, end)
        if len(self.grid):
            shape = self.grid.fields, self.grid.nodes
            values, before = self.fields.at(*end), self.fields.at(*start)
            if len(self.by_user.slots):
                values, before = self._with_user(values, before, (start, end), increment, user, coordinates)
            predefined = Predefined(values.reshape(shape), (values - before).reshape(shape), self.initial)
        return distributed, predefined

    @property
    def loaded(self) -> bool:
        """True if there are loads on user elements."""
        return bool(len(self.elements))

    def distributed(self, start: Times, end: Times) -> Distributed | None:
        """Return the loads of an increment between these step and total times."""
        values, before = self.loads.at(*end)[self.slots], self.loads.at(*start)[self.slots]
        return _distributed(self.elements, self.kinds, values, values - before)

    def _with_user(
        self,
        values: FloatArray,
        before: FloatArray,
        times: tuple[Times, Times],
        increment: int,
        user: GivesValues,
        coordinates: Coordinates,
    ) -> tuple[FloatArray, FloatArray]:
        """Return the fields at the end and at the start of an increment, including those by the routines."""
        (_, start), (_, end) = times
        known = self.by_user.at(start)
        before = before if known is None else known
        if start == end:
            return before, before
        self.by_user.replace(values, before, increment, times[1], user, coordinates)
        self.by_user.keep(start, end, values)
        return values, before


def _as_loads(step: Step) -> list[Load]:
    """Return the distributed loads, as `Loads` takes them."""
    return [Load(e.elements, e.kind, e.magnitude, e.amplitude, e.source) for e in step.distributed]


def _distributed(elements: IntArray, kinds: IntArray, end: FloatArray, increment: FloatArray) -> Distributed | None:
    """Return the loads as elements get them; None if there are none."""
    if not len(elements):
        return None
    uniform = kinds > 0  # UEL itself sets the magnitude of type UnNU
    return Distributed(elements, kinds, np.where(uniform, end, 0.0), np.where(uniform, increment, 0.0))
