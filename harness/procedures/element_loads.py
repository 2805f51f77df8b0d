# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""All loads of a step: concentrated ones, and distributed ones on built-in elements as nodal forces.

Pressures in a model with NLGEOM are not nodal forces: the faces that they act on are called in each iteration.

Magnitudes of distributed loads vary as those of *CLOAD do, for each element and type of load; *DLOAD and *DSLOAD have
their own OP=. Nonuniform loads have the magnitudes that DLOAD gives at each point of the face or volume.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from harness.assembly import System
from harness.elements import Distributed, FollowerBlock
from harness.elements.load_vectors import unit_forces
from harness.errors import DeckError
from harness.model.arrays import FloatArray, IntArray
from harness.model.model import Model
from harness.model.steps import ElementLoad, Load, Step
from harness.model.user_values import GivesValues, UserValues
from harness.parallel.ranks import Ranks
from harness.procedures.heat_loads import HeatLoads, StepHeat
from harness.procedures.loads import Loads, ScaledUnknowns, Slots, Variation


@dataclass(slots=True)
class StepLoads:
    """Loads of one step; `increment` is the one for which they are needed."""

    step: int
    concentrated: Variation
    distributed: tuple[_StepElementLoads, ...]
    user: GivesValues
    heat: StepHeat
    ranks: Ranks
    increment: int = 0

    @property
    def curves(self) -> tuple[ScaledUnknowns, ...]:
        """Loads that vary along an amplitude."""
        return (*self.concentrated.curves, *(curve for load in self.distributed for curve in load.magnitudes.curves))

    @property
    def turning(self) -> bool:
        """Whether there are loads that follow faces."""
        return any(len(load.faces) for load in self.distributed)

    @property
    def by_user(self) -> bool:
        """Whether DLOAD gives any of them."""
        return any(len(load.by_user) for load in self.distributed)

    def at(self, step_time: float, total_time: float) -> FloatArray:
        """Loads (n,) at a time."""
        concentrated = self.concentrated.at(step_time, total_time)
        if not self.distributed:
            return concentrated
        return concentrated + self.ranks.sum(self.ranks.agree(lambda: self._on_elements(step_time, total_time)))

    def _on_elements(self, step_time: float, total_time: float) -> FloatArray:
        """Nodal forces (n,) of the loads on the elements of this rank."""
        values = np.zeros(self.distributed[0].points.forces.shape[0])
        for load in self.distributed:
            magnitudes = load.magnitudes.at(step_time, total_time)[load.points.slot]
            if len(load.by_user):
                places, coords = load.points.places[load.by_user], load.points.coords[load.by_user]
                time, given = (step_time, total_time), magnitudes[load.by_user]
                asked = UserValues("DLOAD", self.step, self.increment, time, places, coords, given)
                magnitudes[load.by_user] = self.user.user_values(asked)
            values += load.points.forces @ magnitudes
        return values

    def with_faces(
        self, others: Distributed | None, start: tuple[float, float], end: tuple[float, float]
    ) -> Distributed | None:
        """What acts in an increment between these step and total times: on elements, on faces that it follows, heat."""
        parts = [part for part in (others, self._on_faces(start, end), self.heat.between(start, end)) if part]
        if len(parts) < 2:
            return parts[0] if parts else None
        return Distributed(
            np.concatenate([part.elements for part in parts]),
            np.concatenate([part.kinds for part in parts]),
            np.concatenate([part.end for part in parts]),
            np.concatenate([part.increment for part in parts]),
        )

    def _on_faces(self, start: tuple[float, float], end: tuple[float, float]) -> Distributed | None:
        if not self.turning:
            return None
        places = np.concatenate([load.faces for load in self.distributed])
        after = np.concatenate([load.magnitudes.at(*end)[load.slots] for load in self.distributed])
        before = np.concatenate([load.magnitudes.at(*start)[load.slots] for load in self.distributed])
        order = np.argsort(places)
        return Distributed(places[order], np.ones_like(places), after[order], (after - before)[order])


@dataclass(frozen=True, slots=True)
class _StepElementLoads:
    """Distributed loads of one step.

    by_user       points whose magnitude DLOAD gives
    faces, slots  positions of faces among the elements, after those of the model, and numbers of their magnitudes
    """

    points: _Points
    magnitudes: Variation
    by_user: IntArray
    faces: IntArray
    slots: IntArray


class AllLoads:
    """Loads through the steps."""

    def __init__(self, system: System, model: Model) -> None:
        """Integrate the nodal forces of distributed loads once. Raises DeckError."""
        self._concentrated = Loads(system.dofs)
        self._ranks = system.ranks
        on_elements = [load for step in model.steps for load in step.element_loads]
        on_surfaces = [load for step in model.steps for load in step.surface_loads]
        self._elements = _ElementLoads(system, on_elements, surface=False)
        self._surfaces = _ElementLoads(system, on_surfaces, surface=True)
        self._heat = HeatLoads(system, model)

    def start_step(self, step: Step, total_time: float, user: GivesValues) -> StepLoads:
        """Take over a step's loads; total_time is that at the end of the previous step. Raises DeckError."""
        for entry in step.element_loads:
            if entry.type.jltyp and user.dload is None:
                raise DeckError(entry.source, "*DLOAD: nonuniform loads need DLOAD, which the job does not have")
        distributed = (
            self._elements.start_step(step.element_loads, step.new_distributed, step, total_time),
            self._surfaces.start_step(step.surface_loads, step.new_surface_loads, step, total_time),
        )
        found = tuple(load for load in distributed if load is not None)
        heat = self._heat.start_step(step, total_time)
        concentrated = self._concentrated.start_step(step, total_time)
        return StepLoads(step.number, concentrated, found, user, heat, self._ranks)

    def in_perturbation(self, step: Step) -> FloatArray:
        """Forces (n,) of a perturbation step, which do not outlast it."""
        forces = self._concentrated.in_perturbation(step.loads)
        return forces + self._elements.unlasting(step.element_loads) + self._surfaces.unlasting(step.surface_loads)

    def conclude(self, step_time: float) -> None:
        """The step ends before its period."""
        for loads in (self._concentrated, self._elements.loads, self._surfaces.loads):
            loads.conclude(step_time)
        self._heat.conclude(step_time)


@dataclass(slots=True)
class _Points:
    """Points of faces and volumes that loads act on.

    forces  (n, points) nodal forces for magnitudes of one
    slot    (points,) number of the magnitude, jltyp (points,) as LoadType has it
    places  (points, 3) element number, point, JLTYP; coords (points, 3)
    """

    forces: sparse.csr_array
    slot: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    places: NDArray[np.int32] = field(default_factory=lambda: np.zeros((0, 3), dtype=np.int32))
    coords: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))


class _ElementLoads:
    """Distributed loads on built-in elements.

    loads  a magnitude for each element and type of load
    """

    def __init__(self, system: System, entries: Sequence[ElementLoad], *, surface: bool) -> None:
        self._types = list(dict.fromkeys(entry.type for entry in entries))
        self._slots = Slots([(entry.elements, self._types.index(entry.type)) for entry in entries])
        self.loads = Loads(self._slots)
        self._active = np.zeros(len(self._slots), dtype=bool)
        parts: list[_Points] = []
        loaded = (block for block in system.loaded if isinstance(block, FollowerBlock) and block.acts)
        faces = [block for block in loaded if block.surface == surface]
        turning = {block.load for block in faces}
        for entry in {entry.type: entry for entry in entries}.values():
            if entry.type not in turning:
                parts += self._points_of(system, entry)
        none = np.zeros(0, dtype=np.int64)
        self._faces = np.concatenate([none, *(block.first + block.rows for block in faces)])
        slots = [self._slots.find(block.elements, self._types.index(block.load)) for block in faces]
        self._face_slots = np.concatenate([none, *slots])
        self._points = _Points(sparse.csr_array((len(system), 0)))
        if parts:
            self._points = _Points(
                sparse.csr_array(sparse.hstack([part.forces for part in parts], format="csr")),
                np.concatenate([part.slot for part in parts]),
                np.concatenate([part.places for part in parts]),
                np.concatenate([part.coords for part in parts]),
            )

    def start_step(
        self, entries: Sequence[ElementLoad], new: bool, step: Step, total_time: float
    ) -> _StepElementLoads | None:
        """Loads of a step; None if the model has none."""
        if not len(self._slots):
            return None
        if new:
            self._active[:] = False
        for entry in entries:
            self._active[self._slots.find(entry.elements, self._types.index(entry.type))] = True
        loads = self._as_loads(entries)
        by_user = np.flatnonzero((self._points.places[:, 2] > 0) & self._active[self._points.slot])
        varying = self.loads.take(loads, new, step, total_time)
        return _StepElementLoads(self._points, varying, by_user, self._faces, self._face_slots)

    def unlasting(self, entries: Sequence[ElementLoad]) -> FloatArray:
        """Forces (n,) of entries of a perturbation step."""
        magnitudes = self.loads.in_perturbation(self._as_loads(entries))
        return np.asarray(self._points.forces @ magnitudes[self._points.slot])

    def _as_loads(self, entries: Sequence[ElementLoad]) -> list[Load]:
        return [Load(e.elements, self._types.index(e.type), e.magnitude, e.amplitude, e.source) for e in entries]

    def _points_of(self, system: System, entry: ElementLoad) -> list[_Points]:
        """Points of the elements that have loads of the entry's type, block by block."""
        chosen = np.flatnonzero(self._slots.kinds == self._types.index(entry.type))
        found = []
        for block in system.blocks:
            mine = chosen[block.holds(self._slots.places[chosen])]
            if not len(mine):
                continue
            rows = block.places_of(self._slots.places[mine])
            forces, coords = unit_forces(block.group, rows, entry, system.dofs.mesh.coordinates)
            elements, points, _, dimension = forces.shape
            local = list(entry.type.face) or list(range(block.group.nodes.shape[1]))
            nodes = block.group.nodes[rows][:, local]
            unknowns = system.dofs.find(nodes[:, None, :, None], np.arange(1, dimension + 1))
            columns = np.arange(elements * points).reshape(elements, points, 1, 1)
            where = np.broadcast_to(unknowns, forces.shape).ravel(), np.broadcast_to(columns, forces.shape).ravel()
            matrix = sparse.csr_array((forces.ravel(), where), shape=(len(system), elements * points))
            labels = np.repeat(block.group.labels[rows], points)
            numbers = np.tile(np.arange(1, points + 1), elements)
            places = np.stack([labels, numbers, np.full(len(labels), entry.type.jltyp)], axis=1).astype(np.int32)
            found.append(_Points(matrix, np.repeat(mine, points), places, coords.reshape(-1, 3)))
        return found
