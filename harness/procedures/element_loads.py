# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""All loads of a step: concentrated ones, and distributed ones on built-in elements as nodal forces.

Magnitudes of distributed loads vary as those of *CLOAD do, for each element and type of load; *DLOAD and *DSLOAD have
an OP= of their own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from harness.assembly import System
from harness.elements.load_vectors import unit_forces
from harness.model.arrays import FloatArray
from harness.model.model import Model
from harness.model.steps import ElementLoad, Load, Step
from harness.procedures.loads import Curve, Loads, Slots, Variation


@dataclass(frozen=True, slots=True)
class StepLoads:
    """Loads of one step: nodal ones, and nodal forces (n, magnitudes) per magnitude of distributed ones."""

    concentrated: Variation
    distributed: tuple[tuple[sparse.csr_array, Variation], ...]

    @property
    def curves(self) -> tuple[Curve, ...]:
        """What varies along an amplitude."""
        return (*self.concentrated.curves, *(curve for _, varying in self.distributed for curve in varying.curves))

    def at(self, step_time: float, total_time: float) -> FloatArray:
        """Loads (n,) at a time."""
        values = self.concentrated.at(step_time, total_time)
        for forces, varying in self.distributed:
            values = values + forces @ varying.at(step_time, total_time)
        return values


class AllLoads:
    """Loads through the steps."""

    def __init__(self, system: System, model: Model) -> None:
        """Integrate the nodal forces of distributed loads once. Raises DeckError."""
        self._concentrated = Loads(system.dofs)
        self._elements = _ElementLoads(system, [load for step in model.steps for load in step.element_loads])
        self._surfaces = _ElementLoads(system, [load for step in model.steps for load in step.surface_loads])

    def start_step(self, step: Step, total_time: float) -> StepLoads:
        """Take over a step's loads; total_time is that at the end of the previous step."""
        distributed = (
            self._elements.start_step(step.element_loads, step.new_distributed, step, total_time),
            self._surfaces.start_step(step.surface_loads, step.new_surface_loads, step, total_time),
        )
        return StepLoads(
            self._concentrated.start_step(step, total_time), tuple(load for load in distributed if load is not None)
        )


class _ElementLoads:
    """Distributed loads on built-in elements; a magnitude for each element and type of load."""

    def __init__(self, system: System, entries: Sequence[ElementLoad]) -> None:
        self._types = list(dict.fromkeys(entry.type for entry in entries))
        self._slots = Slots([(entry.elements, self._types.index(entry.type)) for entry in entries])
        self._loads = Loads(self._slots)
        self._forces = sparse.csr_array((len(system), len(self._slots)))
        for entry in {entry.type: entry for entry in entries}.values():
            self._forces = self._forces + self._unit_forces(system, entry)

    def start_step(
        self, entries: Sequence[ElementLoad], new: bool, step: Step, total_time: float
    ) -> tuple[sparse.csr_array, Variation] | None:
        """Nodal forces per magnitude and the course of the magnitudes; None without any."""
        if not len(self._slots):
            return None
        loads = [Load(e.elements, self._types.index(e.type), e.magnitude, e.amplitude, e.source) for e in entries]
        return self._forces, self._loads.take(loads, new, step, total_time)

    def _unit_forces(self, system: System, entry: ElementLoad) -> sparse.csr_array:
        """(n, magnitudes) of the elements that have loads of the entry's type."""
        kind = self._types.index(entry.type)
        chosen = np.flatnonzero(self._slots.kinds == kind)
        found = sparse.csr_array((len(system), len(self._slots)))
        for block in system.blocks:
            mine = chosen[(self._slots.places[chosen] >= block.first)]
            mine = mine[self._slots.places[mine] < block.first + len(block.group.labels)]
            if not len(mine):
                continue
            rows = self._slots.places[mine] - block.first
            forces = unit_forces(block.group, rows, entry, system.dofs.mesh.coordinates)
            local = list(entry.type.face) or list(range(block.group.nodes.shape[1]))
            nodes = block.group.nodes[rows][:, local]
            unknowns = system.dofs.find(nodes[:, :, None], np.arange(1, forces.shape[2] + 1))
            columns = np.broadcast_to(mine[:, None, None], unknowns.shape)
            shape = found.shape
            found = found + sparse.csr_array((forces.ravel(), (unknowns.ravel(), columns.ravel())), shape=shape)
        return found
