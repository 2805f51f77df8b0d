# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A block of like elements bound to the Fortran driver."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.elements.call import NOTHING, BlockReport, Call, CurrentPass, Distributed, Motion
from uel.elements.contributor import Contributor
from uel.elements.driver_arrays import NO_LOADS, fields_of, loads_of
from uel.elements.fields import FIELD_NAMES, field_of
from uel.elements.finite_values import Watch
from uel.elements.initial_state import InitialState
from uel.elements.lflags import Flags, Request
from uel.elements.mistakes import Mistakes
from uel.elements.routine import Linearity, Routine
from uel.elements.user_variables import UserVariables
from uel.model.arrays import FloatArray, IntArray
from uel.model.energies import PLASTIC
from uel.model.mesh import ElementGroup, full_name
from uel.model.records import ElementState, PointVariables
from uel.model.restart import Saved
from uel.usersub import Library, _binding
from uel.usersub.exchange import BlockArrays, LoadArrays, Outcome, UnknownFields
from uel.usersub.faults import Entries, Guards

MOST_INTERRUPTED: Final = 5
"""Passes in a row that several threads may abandon for a pass on one thread."""

_NO_MATRIX = np.zeros(1)
_AT_REST = Motion(np.zeros(1), np.zeros(1))


class ElementBlock(Contributor):
    """Elements of one group: their committed and trial state, and one pass over them.

    unknowns     (local node, dof) in the order of U and RHS; REFERENCE is the reference node of the section
    unsymmetric  False: (A + A^T)/2 is assembled
    first        position of the first element of the group in the model
    rows         (m,) elements of the group on this rank, ascending
    parallel     several threads may call the elements at the same time
    strict       a write outside an array is an error, otherwise a warning
    zeros        an entry of RHS or AMATRX that is not set gives a warning and is zero from then on, otherwise an error
    variables    description of SVARS, None if unknown; STATEV and UVAR follow those of a point of a built-in element
    """

    def __init__(
        self,
        group: ElementGroup,
        coordinates: FloatArray,
        unknowns: tuple[tuple[int, int], ...],
        routine: Routine,
        library: Library,
        *,
        unsymmetric: bool,
        variables: PointVariables | None,
        strict: bool = True,
        zeros: bool = False,
    ) -> None:
        self.group = group
        self.unknowns = unknowns
        self.unsymmetric = unsymmetric
        self.variables = variables
        self._coordinates = coordinates
        self._routine = routine
        self._library = library
        self.first = 0
        self.rows = np.arange(len(group.labels))
        self._size = len(group.labels)
        self.parallel = False
        self._interrupted = 0
        self._mistakes = Mistakes(group, routine, len(unknowns), library, strict=strict, zeros=zeros)
        m, n = len(group.labels), len(unknowns)
        svars = np.zeros((m, routine.svars))
        energy = np.zeros((m, 8))
        history = np.zeros((m, routine.history[1], routine.history[0]))
        self._arrays = BlockArrays(
            labels=group.labels.astype(np.int32),
            jprops=routine.jprops.astype(np.int32),
            equations=np.zeros((m, n), dtype=np.int32),
            map=np.zeros((m, n, n), dtype=np.int32),
            props=np.ascontiguousarray(routine.props, dtype=np.float64),
            coords=np.ascontiguousarray(coordinates[group.nodes, : routine.mcrd]),
            svars=svars,
            svars_trial=svars.copy(),
            energy=energy,
            energy_trial=energy.copy(),
            history=history,
            history_trial=history.copy(),
        )
        self._uvar = UserVariables(routine.uvarm, routine, library, m) if routine.uvarm else None
        self._last: Call | None = None
        self._end = np.zeros(0)
        self._watch = Watch(group, library)
        of = np.array([0 if routine.forceless else field_of(dof) + 1 for _, dof in unknowns], dtype=np.int32)
        self._unknown_fields = UnknownFields(of, len(FIELD_NAMES))
        self._forces = np.zeros(len(FIELD_NAMES), dtype=np.int64)
        self._all_terms = np.full(n, -1.0)
        dofs = [dof for _, dof in unknowns]
        # number, from 1, of the first unknown of the same dof
        self._first = np.array([(dofs.index(dof) + 1) * (dof in routine.free) for dof in dofs], dtype=np.int32)

    @property
    def nodes(self) -> IntArray:
        """Nodes (m, k) of the elements."""
        return self.group.nodes

    @property
    def names(self) -> list[str]:
        """Names (m,) of the elements."""
        return [full_name(self.group.instance, label) for label in self.group.labels.tolist()]

    @property
    def reference(self) -> int:
        """Reference node of the section, which has unknowns of all elements; -1 without one."""
        return self.group.reference

    @property
    def initial(self) -> InitialState:
        """Setter of the initial state of the elements."""
        return InitialState(self.group, self._arrays, self._routine, self._library)

    @property
    def elastic(self) -> bool:
        """Whether, in small displacements, the state of its built-in elements is linear in the displacements."""
        return self._routine.linear

    @property
    def viscous_change(self) -> float:
        """Largest change of the viscous strain rate in the last pass, times the time increment, or 0."""
        column = self._routine.viscous
        return 0.0 if column < 0 else float(self._arrays.history_trial[..., column].max(initial=0.0))

    @property
    def linear(self) -> bool:
        """Whether, at rest and in small displacements, the forces of its elements are AMATRX times U."""
        return self._routine.forces is not Linearity.UNKNOWN

    @property
    def assumed_linear(self) -> bool:
        """Whether only the user says that its elements are linear."""
        return self._routine.forces is Linearity.ASSUMED

    @property
    def can_wait(self) -> bool:
        """Whether linear elements can be left out at the end of an increment whose state is not read."""
        known = self._routine.forces is Linearity.KNOWN and self._routine.stores
        return known and self._uvar is None

    @property
    def matrix_entries(self) -> int:
        """Entries of the AMATRX of all elements."""
        return len(self.group.labels) * len(self.unknowns) ** 2

    def is_loaded(self, distributed: Distributed | None) -> bool:
        """Return whether one of the elements has a distributed load."""
        return distributed is not None and bool(self.holds(distributed.elements).any())

    def holds(self, elements: IntArray) -> NDArray[np.bool_]:
        """Return the mask of the elements (positions in the model) that are in this block on this rank."""
        mask = self.in_group(elements)
        return mask if len(self.rows) == self._size else mask & np.isin(elements - self.first, self.rows)

    def in_group(self, elements: IntArray) -> NDArray[np.bool_]:
        """Return the mask of the elements (positions in the model) that belong to this group, on any rank."""
        mask: NDArray[np.bool_] = (elements >= self.first) & (elements < self.first + self._size)
        return mask

    def rows_of(self, elements: IntArray) -> IntArray:
        """Return rows, from 0, of elements (positions in the model) that are in this block."""
        rows: IntArray = elements - self.first
        return rows if len(self.rows) == self._size else np.searchsorted(self.rows, rows)

    def owners(self, ranks: IntArray) -> IntArray:
        """Return the ranks (m,) that call the elements, from those (elements,) of all elements of the model."""
        owners: IntArray = ranks[self.first + self.rows]
        return owners

    def keep(self, rows: IntArray) -> None:
        """Keep only these elements, those of this rank, before `number`.

        Parameters
        ----------
        rows
            Elements of the group, from 0, ascending.
        """
        self.group = self.group.take(rows)
        self.rows, self._arrays = rows, self._arrays.of(rows)
        self._watch, self._mistakes.group = Watch(self.group, self._library), self.group
        if self._uvar is not None:
            self._uvar.keep(rows)

    def locate(self, indptr: NDArray[np.int32], indices: NDArray[np.int32]) -> None:
        """Locate the entries of the element matrices in a CSR pattern."""
        self.bind(self._equations, _binding.scatter_map(self._equations, indptr, indices))

    def bind(self, equations: NDArray[np.int32], scatter: NDArray[np.int32]) -> None:
        """Bind the block to the unknowns of the system.

        Parameters
        ----------
        equations
            (m, unknowns) number of each unknown of each element in the system, from 0.
        scatter
            (m, unknowns, unknowns) position in the CSR values of each entry of the element matrix (row, column), from
            0.
        """
        self._arrays = replace(
            self._arrays,
            equations=np.ascontiguousarray(equations + 1, dtype=np.int32),
            # the driver walks AMATRX by columns
            map=np.ascontiguousarray(scatter.transpose(0, 2, 1) + 1, dtype=np.int32),
        )
        fields = self._unknown_fields
        self._forces = len(equations) * np.bincount(fields.of, minlength=fields.number + 1)[1:]
        # unknowns within elements are displacements
        self._forces[0] += len(equations) * self._routine.internal

    def split(self, *, strict: bool = True, coordinates: FloatArray | None = None) -> list[ElementBlock]:
        """Split the block into unbound blocks of one element, in the committed state, for calls in any order.

        Parameters
        ----------
        strict
            A write outside an array is an error, otherwise a warning.
        coordinates
            Coordinates (nodes of the model, 3) in place of those of the model.

        Returns
        -------
        list[ElementBlock]
            In the order of the elements; changes of their states do not affect this block.
        """
        return [self.part(np.array([k]), coordinates, strict=strict) for k in range(len(self.group.labels))]

    def part(self, rows: IntArray, coordinates: FloatArray | None = None, *, strict: bool = True) -> ElementBlock:
        """Return an unbound block of some of the elements (rows from 0), in their committed state; see `split`."""
        part = ElementBlock(
            self.group.take(rows),
            self._coordinates if coordinates is None else coordinates,
            self.unknowns,
            self._routine,
            self._library,
            unsymmetric=self.unsymmetric,
            variables=self.variables,
            strict=strict,
        )
        part.first = self.first + int(self.rows[rows[0]])
        for name in ("svars", "energy", "history"):
            getattr(part._arrays, name)[:] = getattr(self._arrays, name)[rows]
        return part

    def contribute(self, now: CurrentPass) -> BlockReport:
        """Run one pass. In a linear step RHS of built-in elements is left out: their loads are added elsewhere."""
        added = now.columns if self.group.definition or not now.call.flags.linear else np.zeros_like(now.columns)
        return self.evaluate(now.call, now.u, now.du, added, now.data, now.motion)

    def evaluate(
        self,
        call: Call,
        u: FloatArray,
        du: FloatArray,
        residual: FloatArray,
        matrix: FloatArray | None,
        motion: Motion | None = None,
    ) -> BlockReport:
        """Run one pass: add RHS into residual and AMATRX into matrix.

        SVARS on entry are always the committed ones; those returned are kept for `commit` if LFLAGS(3) is 1 or 6, or
        asks for initial stresses.

        Parameters
        ----------
        call
            Arguments common to all elements.
        u, du
            (n,) estimate of the end of the increment, and the increment, of all unknowns of the system.
        residual
            (n,) or (NRHS, n), changed in place: its rows take the columns of RHS. RHS is left out if LFLAGS(3) asks for
            a matrix only (2, 3, 4).
        matrix
            (nnz,) CSR values of the system, changed in place; None: AMATRX is ignored.
        motion
            V and A (n,); zero without it.

        Returns
        -------
        BlockReport
            Sums over the elements of the block.

        Raises
        ------
        KernelError
            An element fails; residual and matrix are then incomplete.
        CallLimitError
            A call does not return within its limit.
        """
        if not len(self.group.labels):
            return NOTHING
        motion, columns = motion or _AT_REST, np.atleast_2d(residual)
        outcome = _binding.evaluate(
            self._routine.called,
            self._arrays,
            self._options(call, assemble=matrix is not None),
            call.moment,
            (u, du, motion.velocity, motion.acceleration),
            self._loads(call.distributed),
            fields_of(self.group, self._routine, call.predefined),
            self._floor(call),
            self._unknown_fields,
            columns,
            _NO_MATRIX if matrix is None else matrix,
        )
        if call.flags.request is not Request.RESIDUAL:
            # a residual alone may be that of half the increment, or of a line search
            self._last = call
            if self._uvar is not None:
                self._uvar.move(call, u, self._arrays, self.unknowns)
            if self._routine.outputs:
                self._end = u.copy()
        self._count_interrupted(outcome)
        self._mistakes.check(outcome, len(columns), call)
        self._watch.pnewdt(call, outcome.pnewdt)
        energy, damage = outcome.energy, 0.0
        if self._routine.damages:
            damage, energy[PLASTIC] = float(energy[PLASTIC]), 0.0
        return self._report(outcome, energy, damage, call)

    def _count_interrupted(self, outcome: Outcome) -> None:
        """Stop using threads after several interrupted passes in a row, each of which repeats work."""
        self._interrupted = self._interrupted + 1 if outcome.alone else 0
        if self._interrupted == MOST_INTERRUPTED:
            self.parallel = False
            self._library.warn(
                f"elements of type {self.group.type} are called by one thread from now on: in "
                f"{MOST_INTERRUPTED} passes in a row one of them sent a message, used shared arrays or failed, which "
                "one thread has to repeat"
            )

    def evaluate_unassembled(
        self, call: Call, u: FloatArray, du: FloatArray, residual: FloatArray
    ) -> tuple[BlockReport, FloatArray]:
        """Run `evaluate`, but return AMATRX unassembled: (m, unknowns, unknowns), columns first."""
        assembled = self._arrays
        matrices = np.zeros(assembled.map.shape)
        unassembled = np.arange(1, matrices.size + 1, dtype=np.int32).reshape(matrices.shape)
        self._arrays = replace(assembled, map=unassembled)
        try:
            return self.evaluate(call, u, du, residual, matrices.reshape(-1)), matrices
        finally:
            self._arrays = assembled

    def add_matrices(self, matrices: FloatArray, data: FloatArray) -> None:
        """Add element matrices, as `evaluate_unassembled` returns them, to the CSR values (nnz,) of the system."""
        if len(matrices):
            _binding.add_matrices(matrices, self._arrays.map, data)

    def linear_pass(self, matrices: FloatArray, call: Call, u: FloatArray, residual: FloatArray) -> BlockReport:
        """Run a pass with stored matrices in place of the elements, which are not called.

        Parameters
        ----------
        matrices
            Of the elements, as `evaluate_unassembled` returns them.
        call
            Only its `flux_floor` is used.
        u
            (n,) all unknowns of the system.
        residual
            (n,), to which the forces, minus the matrices times U, are added.

        Returns
        -------
        BlockReport
            As from `evaluate`, without PNEWDT; ENERGY(2) if it is the only energy of the elements, otherwise none.
        """
        if not len(self.group.labels):
            return NOTHING
        outcome = _binding.linear_pass(
            matrices, self._arrays.equations, self._first, u, self._floor(call), self._unknown_fields, residual
        )
        energy = outcome.energy if self.can_wait else np.zeros(8)
        return self._report(outcome, energy, 0.0, call)

    def _report(self, outcome: Outcome, energy: FloatArray, damage: float, call: Call) -> BlockReport:
        # inertia forces, which are in RHS too, are terms of their own
        own = 2 * self._forces if self._routine.massive and call.flags.dynamic else self._forces
        return BlockReport.of(outcome, own, energy, damage)

    def _floor(self, call: Call) -> FloatArray:
        """Return, for each unknown, the force above which an entry of RHS is a term of the average flux."""
        return self._all_terms if call.flux_floor is None else call.flux_floor[self._unknown_fields.of - 1]

    def _loads(self, distributed: Distributed | None) -> LoadArrays:
        """Return the loads on the elements of the block."""
        if distributed is None:
            return NO_LOADS
        mine = self.holds(distributed.elements)
        return loads_of(distributed, mine, self.rows_of(distributed.elements[mine]), len(self.group.labels))

    def stress_matrix(self, call: Call, u: FloatArray, added: FloatArray, matrix: FloatArray) -> None:
        """Add the initial stress matrix into matrix, if the elements have one.

        Parameters
        ----------
        call
            Its request is BASE_STRESS or ADDED_STRESS.
        u, added
            (n,) unknowns of the system, and the perturbation.
        matrix
            (nnz,) CSR values of the system, changed in place.

        Raises
        ------
        KernelError
            A user material fails.
        """
        if self._routine.turns:
            self.evaluate(call, u, added, np.zeros_like(u), matrix)

    def artificial_mass(self, call: Call, unknowns: int, matrix: FloatArray) -> None:
        """Add the mass matrix for unit density into matrix, if the elements have a density.

        Parameters
        ----------
        call
            Arguments of the step; its request is replaced.
        unknowns
            Number of unknowns of the system.
        matrix
            (nnz,) CSR values of the system, changed in place: mass over density, thus volumes (length^3).
        """
        density = self._routine.density
        if density < 0:
            return
        arrays, props = self._arrays, self._arrays.props.copy()
        props[density] = 1.0
        self._arrays = replace(arrays, props=props)
        zero = np.zeros(unknowns)
        try:
            self.evaluate(call.asking(Request.MASS), zero, zero, zero.copy(), matrix)
        finally:
            self._arrays = arrays

    def bare_loop(self, call: Call, u: FloatArray, du: FloatArray, residual: FloatArray) -> None:
        """Call the elements in a plain Fortran loop over the block, to measure the highest possible speed.

        Nothing is checked, AMATRX is discarded, and loads, fields, V and A are zero. SVARS and ENERGY become the trial
        state. XIT ends the process.

        Parameters
        ----------
        call
            Arguments common to all elements; its loads and fields are not used.
        u, du
            (n,) as in `evaluate`.
        residual
            (n,), to which RHS is added.
        """
        _binding.bare_loop(self._routine.called, self._arrays, call.moment, u, du, residual)

    def _options(self, call: Call, *, assemble: bool) -> tuple[bool, bool, Guards, Entries, bool]:
        symmetric = not (self.unsymmetric or (call.unsymmetric and self.group.definition))
        # routines and the host initialise what they save in the first calls
        parallel = self.parallel and self._last is not None and call.flags.request is not Request.OUTPUT_VARIABLES
        return symmetric, assemble, self._mistakes.guards, self._mistakes.entries, parallel

    def begin_stressed(self, call: Call, u: FloatArray, residual: FloatArray) -> None:
        """Pass the stresses of `initial.set_stress` to the material, and commit the resulting state.

        Parameters
        ----------
        call
            Arguments at the start of the analysis; only the procedure of LFLAGS is used.
        u
            (n,) at the start of the analysis.
        residual
            (n,) from which the nodal forces of the stresses are subtracted.

        Raises
        ------
        KernelError
            An element is inside out.
        """
        flags = Flags(call.flags.procedure, request=Request.INITIAL_STRESSES)
        self.evaluate(replace(call, flags=flags), u, np.zeros_like(u), residual, None)
        self._keep_trial()

    def commit(self) -> None:
        """Commit the state of the last normal call at the end of a converged increment, then call UVARM.

        Raises KernelError if UVARM ends the analysis.
        """
        self._keep_trial()
        arrays = self._arrays
        self._watch.state(self._last, arrays.svars, arrays.energy)
        if self._uvar is not None and self._last is not None:
            self._uvar.call(self._last, self.group, arrays)
        elif self._routine.outputs and self._last is not None:
            zero = np.zeros_like(self._end)
            self.evaluate(self._last.asking(Request.OUTPUT_VARIABLES), self._end, zero, zero, None)
            arrays.history[:] = arrays.history_trial

    def _keep_trial(self) -> None:
        """Copy the trial state to the committed state."""
        arrays = self._arrays
        arrays.svars[:] = arrays.svars_trial
        arrays.energy[:] = arrays.energy_trial
        arrays.history[:] = arrays.history_trial

    def kept(self) -> Saved:
        """Return the committed state, not copied, in the order of the elements of this block."""
        arrays = self._arrays
        uvar = {} if self._uvar is None else {"uvar": self._uvar.values}
        return {"svars": arrays.svars, "energy": arrays.energy, "history": arrays.history, **uvar}

    def resume(self, saved: Saved) -> None:
        """Restore the state that `kept` returned. Raises ValueError if shapes differ."""
        own = self.kept()
        if {name: np.shape(array) for name, array in own.items()} != {name: np.shape(a) for name, a in saved.items()}:
            raise ValueError(f"elements of type {self.group.type}")
        for name, array in own.items():
            array[:] = saved[name]
        self._keep_committed()

    def _keep_committed(self) -> None:
        """Copy the committed state to the trial state."""
        arrays = self._arrays
        arrays.svars_trial[:], arrays.energy_trial[:] = arrays.svars, arrays.energy
        arrays.history_trial[:] = arrays.history

    def state(self, index: int) -> ElementState:
        """Return the committed state, copied.

        Parameters
        ----------
        index
            Number of the group in the model, from 0.
        """
        arrays = self._arrays
        return self._state(index, self._extended(arrays.svars, arrays.history), arrays.energy)

    def trial(self, index: int) -> ElementState:
        """Return the trial state of the last pass that stores one, copied.

        Parameters
        ----------
        index
            Number of the group in the model, from 0.
        """
        arrays = self._arrays
        svars = self._extended(arrays.svars_trial, arrays.history_trial)
        return self._state(index, svars, arrays.energy_trial)

    def _state(self, index: int, svars: FloatArray, energy: FloatArray) -> ElementState:
        return ElementState(index, svars, energy.copy(), self.variables, self._routine.damages)

    def _extended(self, svars: FloatArray, history: FloatArray) -> FloatArray:
        """Return a copy of SVARS without the hidden ones; STATEV and UVAR follow those of each point."""
        svars = svars[:, : svars.shape[1] - self._routine.hidden]
        kept, points = self._routine.outputs + self._routine.statev, self._routine.history[1]
        parts = [history[:, :, history.shape[2] - kept :]] if kept else []
        if self._uvar is not None:
            parts.append(self._uvar.values)
            points = self._uvar.values.shape[1]
        if not parts:
            return svars.copy()
        of_points = np.concatenate([svars.reshape(len(svars), points, svars.shape[1] // points), *parts], axis=2)
        return of_points.reshape(len(svars), points * of_points.shape[2])
