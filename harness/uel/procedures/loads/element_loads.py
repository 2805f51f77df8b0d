# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Loads of a step: concentrated loads, and distributed loads on built-in elements as nodal forces.

Pressures in a model with NLGEOM are not nodal forces but follower loads: their faces are called in each iteration.

Magnitudes of distributed loads vary as those of *CLOAD do, for each element and type of load; *DLOAD and *DSLOAD have
their own OP=. DLOAD defines nonuniform loads at each point of the face or volume, from the magnitudes in the deck: no
amplitude acts on them, nor that of the step (User Subroutines Guide, DLOAD).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from uel.assembly import System
from uel.elements import FIELD_NAMES, BlockReport, Distributed, FollowerBlock
from uel.elements.loads.followers import SHELL_PRESSURE
from uel.elements.loads.vectors import unit_forces
from uel.errors import DeckError
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import ShellType
from uel.model.model import Model
from uel.model.steps import ElementLoad, Load, LoadKind, LoadType, Step
from uel.model.user_values import GivesValues, UserValues
from uel.procedures.loads.heat import HeatLoads, StepHeat
from uel.procedures.loads.nodal import Loads, Slots
from uel.procedures.loads.variation import ScaledUnknowns, Variation


@dataclass(frozen=True, slots=True)
class FactorTimes:
    """Load factor at the end of an increment, a small difference of it, and its change in the increment."""

    end: float
    difference: float
    change: float


@dataclass(frozen=True, slots=True)
class _ShellTerms:
    """Loads normal to shells, which count in the average force.

    forces  (n, slots) nodal forces for unit magnitudes
    terms   (slots,) number of terms of each load in the average, 0 if it does not act or is on other elements
    """

    forces: sparse.csc_array
    terms: IntArray

    def at(self, magnitudes: FloatArray, floor: float) -> BlockReport:
        """Return the report for magnitudes (slots,); floor: forces below it are left out of the average."""
        forces = abs(self.forces.data) * np.abs(np.repeat(magnitudes, np.diff(self.forces.indptr)))
        here = np.repeat(self.terms > 0, np.diff(self.forces.indptr))
        counted = here & (forces > floor)
        values, field = np.zeros(len(FIELD_NAMES)), FIELD_NAMES.index("force")
        count = np.zeros(len(FIELD_NAMES), dtype=np.int64)
        flux, largest, entries, above = values.copy(), values.copy(), count.copy(), count.copy()
        flux[field], largest[field] = forces[counted].sum(), forces[here].max(initial=0.0)
        above[field] = SHELL_PRESSURE * np.count_nonzero(counted)
        entries[field] = self.terms.sum()
        return BlockReport(flux, above, np.inf, np.zeros(8), 0.0, largest, entries)


@dataclass(slots=True)
class StepLoads:
    """Loads of one step; `increment` is the current one.

    shape   number of unknowns
    nlgeom  DLOAD gets the current coordinates of its points
    """

    step: int
    shape: int
    nlgeom: bool
    concentrated: Variation
    distributed: tuple[_StepElementLoads, ...]
    user: GivesValues
    heat: StepHeat
    system: System
    increment: int = 0

    @property
    def curves(self) -> tuple[ScaledUnknowns, ...]:
        """Loads that vary along an amplitude."""
        return (*self.concentrated.curves, *(curve for load in self.distributed for curve in load.magnitudes.curves))

    @property
    def follower(self) -> bool:
        """True if there are follower loads."""
        return any(load.follower for load in self.distributed)

    @property
    def by_user(self) -> bool:
        """True if DLOAD defines any load, on any rank."""
        return any(load.by_user for load in self.distributed)

    def at(self, step_time: float, total_time: float) -> FloatArray:
        """Return the loads (n,) at a time, without those by DLOAD."""
        concentrated = self.concentrated.at(step_time, total_time)
        if not self.distributed:
            return concentrated
        return concentrated + self.system.sum(self._on_elements(step_time, total_time))

    def terms(self, times: tuple[float, float], floor: FloatArray) -> tuple[BlockReport, ...]:
        """Return the loads on shells of this rank that count in the average force, at a step and a total time."""
        loads = (load for load in self.distributed if load.shells.terms.any())
        force = float(floor[FIELD_NAMES.index("force")])
        return tuple(load.shells.at(load.magnitudes.at(*times), force) for load in loads)

    def _on_elements(self, step_time: float, total_time: float) -> FloatArray:
        """Return the nodal forces (n,) of the loads on the elements of this rank."""
        values = np.zeros(self.shape)
        for load in self.distributed:
            values += load.points.forces @ load.magnitudes.at(step_time, total_time)[load.points.slot]
        return values

    def by_dload(self, time: tuple[float, float], u: FloatArray) -> FloatArray:
        """Return the nodal forces (n,) of loads by DLOAD at a step and total time and displacements u (n,)."""
        return self.system.sum(self.system.agree(lambda: self._by_dload(time, u)))

    def _by_dload(self, time: tuple[float, float], u: FloatArray) -> FloatArray:
        values = np.zeros(self.shape)
        for load in self.distributed:
            if len(load.chosen):
                magnitudes = np.zeros(len(load.points.slot))
                points = load.points.arguments(load.chosen, u if self.nlgeom else None)
                magnitudes[load.chosen] = self._dload_magnitudes(
                    time, *points, load.reference[load.points.slot[load.chosen]]
                )
                values += load.points.forces @ magnitudes
        return values

    def _dload_magnitudes(
        self, time: tuple[float, float], numbers: NDArray[np.int32], coords: FloatArray, reference: FloatArray
    ) -> FloatArray:
        """Return the magnitudes (k,) by DLOAD."""
        # calls before the first increment count as part of it
        moment = self.step, max(self.increment, 1), time
        return self.user.user_values(UserValues("DLOAD", *moment, numbers, coords, reference))

    def with_faces(
        self,
        others: Distributed | None,
        start: tuple[float, float],
        end: tuple[float, float],
        u: FloatArray,
        factor: FactorTimes | None = None,
    ) -> Distributed | None:
        """Return the loads of an increment between these step and total times: on elements, follower loads, heat.

        u (n,) are the displacements at which DLOAD is called. factor: DLOAD gets a load factor instead of the step
        time; only then the changes of its loads in the increment are known.
        """
        by_user = self.system.agree(lambda: self._on_faces_by_dload(end, u, factor)) if self.by_user else None
        parts = [part for part in (others, self._on_faces(start, end), by_user, self.heat.between(start, end)) if part]
        if len(parts) < 2:
            return parts[0] if parts else None
        return Distributed(
            np.concatenate([part.elements for part in parts]),
            np.concatenate([part.kinds for part in parts]),
            np.concatenate([part.end for part in parts]),
            np.concatenate([part.increment for part in parts]),
        )

    def _on_faces(self, start: tuple[float, float], end: tuple[float, float]) -> Distributed | None:
        if not any(len(load.faces) for load in self.distributed):
            return None
        faces = np.concatenate([load.faces for load in self.distributed])
        after = np.concatenate([load.magnitudes.at(*end)[load.slots] for load in self.distributed])
        before = np.concatenate([load.magnitudes.at(*start)[load.slots] for load in self.distributed])
        order = np.argsort(faces)
        return Distributed(faces[order], np.ones_like(faces), after[order], (after - before)[order])

    def _on_faces_by_dload(
        self, end: tuple[float, float], u: FloatArray, factor: FactorTimes | None
    ) -> Distributed | None:
        """Return a load for each point of the faces whose pressure DLOAD defines."""
        parts = []
        for load in self.distributed:
            for faces in load.dload_faces:
                points = faces.arguments(u if self.nlgeom else np.zeros_like(u))
                change = np.zeros(len(faces.reference))
                if factor is None:
                    after = self._dload_magnitudes(end, *points, faces.reference)
                else:
                    nearby = self._dload_magnitudes((factor.end - factor.difference, end[1]), *points, faces.reference)
                    after = self._dload_magnitudes((factor.end, end[1]), *points, faces.reference)
                    change = factor.change / factor.difference * (after - nearby)
                parts.append(faces.distributed(after, change))
        if not parts:
            return None
        order = np.argsort(np.concatenate([part.elements for part in parts]), kind="stable")
        return Distributed(
            *(
                np.concatenate([getattr(part, name) for part in parts])[order]
                for name in ("elements", "kinds", "end", "increment")
            )
        )


@dataclass(frozen=True, slots=True)
class _DloadFaces:
    """Faces with follower pressures by DLOAD.

    rows       (k,) rows of the block
    reference  (k * points,) magnitudes in the deck
    """

    block: FollowerBlock
    rows: IntArray
    reference: FloatArray

    def arguments(self, u: FloatArray) -> tuple[NDArray[np.int32], FloatArray]:
        """Return element number, point and JLTYP of the points, and their coordinates at displacements u (n,)."""
        labels, coords = self.block.group.labels[self.rows], self.block.points(self.rows, u)
        return _numbered(labels, self.block.points_of_face, self.block.load), coords.reshape(-1, 3)

    def distributed(self, end: FloatArray, increment: FloatArray) -> Distributed:
        """Return a load for each point, with magnitudes and increments (k * points,)."""
        count = self.block.points_of_face
        elements = np.repeat(self.block.first + self.block.rows[self.rows], count)
        return Distributed(elements, np.tile(np.arange(1, count + 1), len(self.rows)), end, increment)


def _numbered(labels: IntArray, points: int, load: LoadType) -> NDArray[np.int32]:
    """Return element number, point and JLTYP (k * points, 3)."""
    numbers = np.tile(np.arange(1, points + 1), len(labels))
    repeated = np.repeat(labels, points)
    return np.stack([repeated, numbers, np.full(len(repeated), load.jltyp)], axis=1).astype(np.int32)


@dataclass(frozen=True, slots=True)
class _StepElementLoads:
    """Distributed loads of one step.

    follower      whether there are follower loads, on any rank
    by_user       whether DLOAD defines any magnitude, on any rank
    chosen        points whose magnitude DLOAD defines
    reference     magnitudes by number as in the deck, for DLOAD
    dload_faces   faces with follower pressures by DLOAD
    shells        loads on shells, in the average force
    faces, slots  positions of other faces among the elements, after those of the model, and numbers of their magnitudes
    """

    points: _Points
    magnitudes: Variation
    follower: bool
    by_user: bool
    chosen: IntArray
    reference: FloatArray
    dload_faces: tuple[_DloadFaces, ...]
    faces: IntArray
    slots: IntArray
    shells: _ShellTerms


class AllLoads:
    """Loads through the steps."""

    def __init__(self, system: System, model: Model) -> None:
        """Integrate the nodal forces of distributed loads once. Raises DeckError."""
        self._concentrated = Loads(system.dofs)
        self._system = system
        on_elements = [load for step in model.steps for load in step.element_loads]
        on_surfaces = [load for step in model.steps for load in step.surface_loads]
        self._shape = len(system)
        self._elements = _ElementLoads(system, on_elements, surface=False)
        self._surfaces = _ElementLoads(system, on_surfaces, surface=True)
        self._heat = HeatLoads(system, model)

    def start_step(self, step: Step, total_time: float, user: GivesValues) -> StepLoads:
        """Take over a step's loads; total_time is that at the end of the previous step. Raises DeckError."""
        _check_dload(step, user)
        distributed = (
            self._elements.start_step(step.element_loads, step.new_distributed, step, total_time),
            self._surfaces.start_step(step.surface_loads, step.new_surface_loads, step, total_time),
        )
        on_elements = tuple(load for load in distributed if load is not None)
        heat = self._heat.start_step(step, total_time)
        concentrated = self._concentrated.start_step(step, total_time)
        return StepLoads(step.number, self._shape, step.nlgeom, concentrated, on_elements, user, heat, self._system)

    def in_perturbation(
        self, step: Step, user: GivesValues, increment: int, time: tuple[float, float], u: FloatArray
    ) -> FloatArray:
        """Return the forces (n,) of a perturbation step, which later steps do not keep.

        increment, time and u (n,), the displacements of the base state, are for DLOAD. Raises DeckError without it.
        """
        _check_dload(step, user)
        forces = self._concentrated.in_perturbation(step.loads)
        of_elements = self._elements.perturbation_forces(step.element_loads)
        forces += of_elements + self._surfaces.perturbation_forces(step.surface_loads)
        for entry in step.element_loads:
            if entry.type.jltyp:
                numbers, coords, add = self._elements.nonuniform(entry, u if step.nlgeom else None)
                reference = np.full(len(coords), entry.magnitude)
                forces += add(
                    user.user_values(UserValues("DLOAD", step.number, increment, time, numbers, coords, reference))
                )
        return forces

    def on_faces(
        self,
        block: FollowerBlock,
        step: Step,
        user: GivesValues,
        increment: int,
        time: tuple[float, float],
        u: FloatArray,
    ) -> Distributed:
        """Return the loads of a perturbation step on a block of faces; other arguments as in `in_perturbation`."""
        magnitudes, loaded = np.zeros(len(block.elements)), np.zeros(len(block.elements), dtype=bool)
        for entry in step.surface_loads if block.surface else step.element_loads:
            if entry.type == block.load:
                rows = np.searchsorted(block.elements, entry.elements)
                np.add.at(magnitudes, rows, entry.magnitude)
                loaded[rows] = True
        rows = np.flatnonzero(loaded)
        if not block.load.jltyp:
            elements = block.first + block.rows[rows]
            return Distributed(elements, np.ones_like(elements), magnitudes[rows], magnitudes[rows])
        faces = _DloadFaces(block, rows, np.repeat(magnitudes[rows], block.points_of_face))
        points = faces.arguments(u if step.nlgeom else np.zeros_like(u))
        values = user.user_values(UserValues("DLOAD", step.number, increment, time, *points, faces.reference))
        return faces.distributed(values, values)

    def conclude(self, step_time: float) -> None:
        """End the step before its period."""
        for loads in (self._concentrated, self._elements.loads, self._surfaces.loads):
            loads.conclude(step_time)
        self._heat.conclude(step_time)


@dataclass(slots=True)
class _Points:
    """Points of loaded faces and volumes.

    forces   (n, points) nodal forces for unit magnitudes
    moved    (3 points, n) matrix from the displacements of the nodes to those of the points
    slot     (points,) number of the magnitude
    numbers  (points, 3) element number, point, JLTYP
    coords   (points, 3) at the start of the analysis
    terms    (points,) number of terms of the load of the point in the average force
    """

    forces: sparse.csr_array
    moved: sparse.csr_array
    slot: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    numbers: NDArray[np.int32] = field(default_factory=lambda: np.zeros((0, 3), dtype=np.int32))
    coords: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    terms: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))

    def arguments(self, chosen: IntArray, u: FloatArray | None) -> tuple[NDArray[np.int32], FloatArray]:
        """Return numbers (k, 3) of chosen points, and their coordinates at displacements u (n,), or initial ones."""
        coords = self.coords[chosen]
        if u is not None:
            coords = coords + (self.moved @ u).reshape(-1, 3)[chosen]
        return self.numbers[chosen], coords


def _check_dload(step: Step, user: GivesValues) -> None:
    """Raise DeckError if the step needs DLOAD and there is none."""
    for entry in step.element_loads:
        if entry.type.jltyp and user.dload is None:
            raise DeckError(entry.source, "*DLOAD: nonuniform loads need DLOAD, which the job does not have")


class _ElementLoads:
    """Distributed loads on built-in elements.

    loads  a magnitude for each element and type of load
    """

    def __init__(self, system: System, entries: Sequence[ElementLoad], *, surface: bool) -> None:
        self._types = list(dict.fromkeys(entry.type for entry in entries))
        self._slots = Slots([(entry.elements, self._types.index(entry.type)) for entry in entries])
        self.loads = Loads(self._slots)
        self._active = np.zeros(len(self._slots), dtype=bool)
        self._reference = np.zeros(len(self._slots))
        parts: list[_Points] = []
        faces = [block for block in system.contributors.followers if block.acts and block.surface == surface]
        followers = {block.load for block in faces}
        self._follower_kinds = [k for k, kind in enumerate(self._types) if kind in followers]
        for entry in {entry.type: entry for entry in entries}.values():
            if entry.type not in followers:
                parts += self._points_of(system, entry)
        none = np.zeros(0, dtype=np.int64)
        by_deck = [block for block in faces if not block.load.jltyp]
        self._dload_blocks = [block for block in faces if block.load.jltyp]
        self._faces = np.concatenate([none, *(block.first + block.rows for block in by_deck)])
        slots = [self._slots.find(block.elements, self._types.index(block.load)) for block in by_deck]
        self._face_slots = np.concatenate([none, *slots])
        self._points = _Points(sparse.csr_array((len(system), 0)), sparse.csr_array((0, len(system))))
        if parts:
            self._points = _Points(
                sparse.csr_array(sparse.hstack([part.forces for part in parts], format="csr")),
                sparse.csr_array(sparse.vstack([part.moved for part in parts], format="csr")),
                np.concatenate([part.slot for part in parts]),
                np.concatenate([part.numbers for part in parts]),
                np.concatenate([part.coords for part in parts]),
                np.concatenate([part.terms for part in parts]),
            )
        points = np.flatnonzero(self._points.terms)
        pairs = points, self._points.slot[points]
        shape = len(self._points.terms), len(self._slots)
        of_slots = sparse.csr_array((np.ones(len(points)), pairs), shape=shape)
        self._of_shells = sparse.csc_array(self._points.forces @ of_slots)
        self._shell_terms = np.zeros(len(self._slots), dtype=np.int64)
        self._shell_terms[pairs[1]] = self._points.terms[points]

    def start_step(
        self, entries: Sequence[ElementLoad], new: bool, step: Step, total_time: float
    ) -> _StepElementLoads | None:
        """Start a step and return its loads; None if the model has none."""
        if not len(self._slots):
            return None
        if new:
            self._active[:] = False
        for entry in entries:
            self._active[self._slots.find(entry.elements, self._types.index(entry.type))] = True
        self._set_reference(entries)
        chosen = np.flatnonzero((self._points.numbers[:, 2] > 0) & self._active[self._points.slot])
        varying = self.loads.take(self._as_loads(entries), new, step, total_time)
        by_user = [k for k, kind in enumerate(self._types) if kind.jltyp]
        follower, by_dload = (self._has(kinds) for kinds in (self._follower_kinds, by_user))
        of_step = follower, by_dload, chosen, self._reference.copy(), self._find_dload_faces()
        shells = _ShellTerms(self._of_shells, np.where(self._active, self._shell_terms, 0))
        return _StepElementLoads(self._points, varying, *of_step, self._faces, self._face_slots, shells)

    def _has(self, kinds: list[int]) -> bool:
        """Return whether the step has loads of some types."""
        return bool(np.isin(self._slots.kinds[self._active], kinds).any())

    def _set_reference(self, entries: Sequence[ElementLoad]) -> None:
        """Set the magnitudes that DLOAD gets; those of several entries of a step add up."""
        by_user = [(self._slots.find(e.elements, self._types.index(e.type)), e) for e in entries if e.type.jltyp]
        for slots, _ in by_user:
            self._reference[slots] = 0.0
        for slots, entry in by_user:
            self._reference[slots] += entry.magnitude

    def _find_dload_faces(self) -> tuple[_DloadFaces, ...]:
        """Return the faces on this rank with a load by DLOAD in the step."""
        dload_faces = []
        for block in self._dload_blocks:
            slots = self._slots.find(block.elements, self._types.index(block.load))
            rows = np.flatnonzero(self._active[slots])
            if len(rows):
                reference = np.repeat(self._reference[slots[rows]], block.points_of_face)
                dload_faces.append(_DloadFaces(block, rows, reference))
        return tuple(dload_faces)

    def nonuniform(
        self, entry: ElementLoad, u: FloatArray | None
    ) -> tuple[NDArray[np.int32], FloatArray, Callable[[FloatArray], FloatArray]]:
        """Return the points of DLOAD in a perturbation step, and a function from its magnitudes to forces (n,)."""
        slots = self._slots.find(entry.elements, self._types.index(entry.type))
        chosen = np.flatnonzero(np.isin(self._points.slot, slots) & (self._points.numbers[:, 2] > 0))
        forces = self._points.forces[:, chosen]
        return (*self._points.arguments(chosen, u), lambda magnitudes: np.asarray(forces @ magnitudes))

    def perturbation_forces(self, entries: Sequence[ElementLoad]) -> FloatArray:
        """Return the forces (n,) of entries of a perturbation step."""
        magnitudes = self.loads.in_perturbation(self._as_loads(entries))
        return np.asarray(self._points.forces @ magnitudes[self._points.slot])

    def _as_loads(self, entries: Sequence[ElementLoad]) -> list[Load]:
        """Return the loads with magnitudes in the deck."""
        uniform = (e for e in entries if not e.type.jltyp)
        return [Load(e.elements, self._types.index(e.type), e.magnitude, e.amplitude, e.source) for e in uniform]

    def _points_of(self, system: System, entry: ElementLoad) -> list[_Points]:
        """Return the points of the elements that have loads of the entry's type, block by block."""
        chosen = np.flatnonzero(self._slots.kinds == self._types.index(entry.type))
        points_of_blocks = []
        for block in system.blocks:
            mine = chosen[block.holds(self._slots.owners[chosen])]
            if not len(mine):
                continue
            rows = block.rows_of(self._slots.owners[mine])
            forces, coords, shapes = unit_forces(block.group, rows, entry, system.dofs.mesh.coordinates)
            elements, points, _, dimension = forces.shape
            local = list(entry.type.face) or list(range(block.group.nodes.shape[1]))
            nodes = block.group.nodes[rows][:, local]
            unknowns = system.dofs.find(nodes[:, None, :, None], np.arange(1, dimension + 1))
            columns = np.arange(elements * points).reshape(elements, points, 1, 1)
            where = np.broadcast_to(unknowns, forces.shape).ravel(), np.broadcast_to(columns, forces.shape).ravel()
            matrix = sparse.csr_array((forces.ravel(), where), shape=(len(system), elements * points))
            numbers = _numbered(block.group.labels[rows], points, entry.type)
            # only DLOAD needs the coordinates of the points
            moved = _moved(system, nodes, shapes if entry.type.jltyp else 0.0 * shapes)
            counts = isinstance(block.group.built_in, ShellType) and entry.type.kind is LoadKind.PRESSURE
            terms = np.full(elements * points, counts * SHELL_PRESSURE * 3 * block.group.nodes.shape[1])
            points_of_blocks.append(
                _Points(matrix, moved, np.repeat(mine, points), numbers, coords.reshape(-1, 3), terms)
            )
        return points_of_blocks


def _moved(system: System, nodes: IntArray, shapes: FloatArray) -> sparse.csr_array:
    """Build the matrix (3 elements points, n) of points' displacements from nodes (elements, k), shapes (points, k)."""
    unknowns = system.dofs.find(nodes[:, None, None, :], np.arange(1, 4)[:, None])
    shape = len(nodes), len(shapes), 3, nodes.shape[1]
    values = np.broadcast_to(shapes[:, None, :], shape)
    rows = np.broadcast_to(np.arange(3 * len(nodes) * len(shapes)).reshape(*shape[:3], 1), shape)
    columns = np.broadcast_to(unknowns, shape)
    known = columns >= 0
    size = 3 * len(nodes) * len(shapes), len(system)
    return sparse.csr_array((values[known], (rows[known], columns[known])), shape=size)
