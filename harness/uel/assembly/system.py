# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The assembled system: sparsity and scatter maps once per mesh, one pass over the blocks per evaluation."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from uel.assembly.dofs import DofMap
from uel.assembly.element_states import States
from uel.assembly.linear_elements import LinearElements
from uel.contact import ContactBlock
from uel.elements import (
    FIELD_NAMES,
    BlockReport,
    Call,
    DistributingBlock,
    ElementBlock,
    FollowerBlock,
    HeatLoadBlock,
    Motion,
    Request,
)
from uel.errors import ElementError
from uel.model.arrays import ComplexArray, FloatArray, IntArray
from uel.model.contact import ContactChanges
from uel.model.couplings import CouplingErrors
from uel.model.mesh import Mesh
from uel.model.model import Equation
from uel.model.records import ElementState
from uel.model.restart import Saved
from uel.parallel.partition import owners_of
from uel.parallel.ranks import ALONE, FAILURES, Ranks
from uel.usersub import _binding


@dataclass(frozen=True, slots=True)
class Evaluation:
    """Outcome of one pass over all elements.

    residual    (n,) sum of RHS: external minus internal force
    data        (nnz,) CSR values of the matrix, None if not asked for; overwritten by the next pass that asks for it
    flux        (fields,) sum of |element nodal force| by field, as FIELD_NAMES orders them, and of loads that are terms
                of the average flux
    flux_count  (fields,) number of terms in it, those above the call's floor
    pnewdt      smallest PNEWDT an element returned
    energy      (8,) sum of ENERGY; that of linear elements that were not called is added by `System.commit`
                The residual and all sums are those of all ranks, the matrix is the part of this rank's elements.
    load        (n,) sum of column 2 of RHS, increments of the loads that elements apply; None unless NRHS = 2
    damage      dissipated by the damage of built-in elements
    largest     (fields,) largest |element nodal force|
    entries     (fields,) number of element nodal forces, and what the loads count as
    contact     what the iteration changed in each contact pair
    coupling    errors of distributing couplings, None without any
    """

    residual: FloatArray
    data: FloatArray | None
    flux: FloatArray
    flux_count: IntArray
    pnewdt: float
    energy: FloatArray
    load: FloatArray | None = None
    damage: float = 0.0
    largest: FloatArray = field(default_factory=lambda: np.zeros(len(FIELD_NAMES)))
    entries: IntArray = field(default_factory=lambda: np.zeros(len(FIELD_NAMES), dtype=np.int64))
    contact: tuple[ContactChanges, ...] = ()
    coupling: CouplingErrors | None = None


LOADED: Final = (FollowerBlock, HeatLoadBlock)
"""Blocks of loads."""


class System:
    """All blocks of a model on one numbering of unknowns.

    blocks   of its elements
    loaded   faces under loads that follow them, and what heat enters: called where loads act, and no elements
    contacts its contact pairs, whose points do not count as elements either
    coupled  its distributing couplings, whose pairs of nodes do not
    dofs     what each unknown is
    indptr   (n + 1,) row starts of the matrix, int32
    indices  (nnz,) columns, ascending in each row, int32; every diagonal entry is there and the pattern is symmetric.
             Both are new arrays in a pass that asks for a matrix and in which contact points slide to other faces
    """

    def __init__(
        self,
        mesh: Mesh,
        blocks: Sequence[ElementBlock],
        equations: Sequence[Equation] = (),
        contacts: Sequence[ContactBlock] = (),
        coupled: Sequence[DistributingBlock] = (),
        *,
        spare_linear: bool = False,
        ranks: Ranks = ALONE,
    ) -> None:
        """Assemble blocks of a model with this mesh, these constraints, contact pairs and distributing couplings.

        This rank keeps a part of the elements.

        spare_linear: do not call linear elements again. Raises UsageError if several ranks cannot share the elements.
        """
        self.ranks = ranks
        self.contacts, self.coupled = tuple(contacts), tuple(coupled)
        self.blocks = tuple(block for block in blocks if not isinstance(block, LOADED))
        self.loaded = tuple(block for block in blocks if isinstance(block, LOADED))
        self.dofs = DofMap.build(mesh, (*self.blocks, *self.contacts, *self.coupled), equations)
        if ranks.size > 1:
            self._keep_own()
        self._of_elements = tuple(blocks)
        for pair in self.contacts:
            pair.number(self.dofs.find, self.dofs.equations_of(pair)[:, -1])
        self._bind()
        self._committed = 0
        self._last: Evaluation | None = None
        self._linear = LinearElements(self.blocks if spare_linear else (), len(self.indices))

    def _keep_own(self) -> None:
        """Keep the elements of this rank, and faces on them."""
        owners = self.ranks.tell(lambda: owners_of([block.group.nodes for block in self.blocks], self.ranks.size))
        for block in (*self.blocks, *self.loaded):
            elements = block.elements if isinstance(block, LOADED) else block.first + block.rows
            # what enters nodes is that of rank 0
            found = np.zeros(len(block.rows), dtype=np.int64) if elements is None else owners[elements]
            block.keep(np.flatnonzero(found == self.ranks.rank))

    def _bind(self) -> None:
        """Build the pattern, in new arrays, and bind all blocks to it."""
        bound: tuple[ElementBlock | DistributingBlock, ...] = (*self._of_elements, *self.coupled)
        numbers = [self.dofs.equations_of(block) for block in bound]
        couplings = [pair.couplings() for pair in self.contacts]
        self.indptr, self.indices = build_pattern(len(self.dofs), [*numbers, *couplings])
        self.of_elements = np.zeros(len(self.dofs), dtype=np.bool_)
        for equation_numbers in numbers:
            self.of_elements[equation_numbers] = True
        for block, equation_numbers in zip(bound, numbers, strict=True):
            block.bind(equation_numbers, _binding.scatter_map(equation_numbers, self.indptr, self.indices))
        for pair in self.contacts:
            pair.bind(self.indptr, self.indices)
        self._data = np.zeros(len(self.indices))

    def __len__(self) -> int:
        return len(self.dofs)

    def evaluate(
        self,
        call: Call,
        u: FloatArray,
        du: FloatArray,
        *,
        matrix: bool = True,
        nrhs: int = 1,
        motion: Motion | None = None,
    ) -> Evaluation:
        """Call every element once, block by block in the calling order of Abaqus.

        In a linear step RHS is what the loads on user elements cause; loads on built-in elements are added elsewhere.

        Parameters
        ----------
        call
            Arguments common to all elements.
        u, du
            (n,) estimate of the end of the increment, and the increment; both include prescribed values.
        matrix
            Whether AMATRX is wanted.
        nrhs
            NRHS: 1, or 2 for the arc length method.
        motion
            V and A of all unknowns; None: the model is at rest.

        Returns
        -------
        Evaluation
            Sums over all elements.

        Raises
        ------
        KernelError
            An element fails.
        CallLimitError
            A call does not return within its limit.
        """
        own = partial(self._evaluate_own, call, u, du, matrix=matrix, nrhs=nrhs, motion=motion)
        evaluation = self._evaluate_all(own, nrhs)
        if call.flags.request is Request.NORMAL:
            self._last = evaluation
        return evaluation

    def _evaluate_own(
        self, call: Call, u: FloatArray, du: FloatArray, *, matrix: bool, nrhs: int, motion: Motion | None
    ) -> Evaluation:
        """Sum over the elements of this rank; arguments and errors as in `evaluate`."""
        columns = np.zeros((nrhs, len(self.dofs)))
        tracked = [pair.track(call, u, du, matrix=matrix) for pair in self.contacts]
        if not all(tracked):
            self._bind()
            self._linear.rebind(len(self.indices))
        data = self._data if matrix else None
        linear = self._linear
        applies = linear.applies(call, motion, nrhs)
        spared = applies and linear.known
        if not spared:
            linear.bring_up()
        if data is not None and spared:
            linear.fill(data)
        elif data is not None:
            data.fill(0.0)
        reports: list[BlockReport] = [*call.load_terms]
        for block in self.blocks:
            kept = columns if block.group.definition or not call.flags.linear else np.zeros_like(columns)
            if spared and block in linear:
                report = linear.forces(block, call, u, columns[0])
            elif applies and data is not None and block in linear:
                report = linear.learn(block, call, u, du, columns[0], data)
            else:
                report = block.evaluate(call, u, du, kept if nrhs > 1 else kept[0], data, motion)
            reports.append(report)
        distributed = call.distributed
        for entered in self.loaded if distributed is not None else ():
            assert distributed is not None
            report = entered.evaluate(call, u, du, columns if nrhs > 1 else columns[0], data, motion)
            reports.append(entered.as_terms(report, distributed))
        energy = sum((report.energy for report in reports), np.zeros(8))
        damage = float(sum(report.damage for report in reports))
        load = columns[1] if nrhs > 1 else None
        linear.passed(call, u, du, spared=spared)
        for pair in self.contacts:
            pair.evaluate(call, u, du, columns[0], data)
            energy += pair.energies[0]
            damage += pair.energies[1]
        for coupled in self.coupled:
            coupled.evaluate(call, u, du, columns[0], data)
        contact = tuple(pair.trial_changes for pair in self.contacts)
        coupling = next((coupled.errors for coupled in self.coupled), None)
        fields = len(FIELD_NAMES)
        return Evaluation(
            columns[0],
            data,
            sum((report.flux for report in reports), np.zeros(fields)),
            sum((report.flux_count for report in reports), np.zeros(fields, dtype=np.int64)),
            # NaN, which .msg warns of, asks for nothing
            min((report.pnewdt for report in reports if report.pnewdt <= np.inf), default=np.inf),
            energy,
            load,
            damage,
            np.max([np.zeros(fields), *(report.largest * np.ones(fields) for report in reports)], axis=0),
            sum((report.entries for report in reports), np.zeros(fields, dtype=np.int64)),
            contact,
            coupling,
        )

    def _evaluate_all(self, act: Callable[[], Evaluation], nrhs: int) -> Evaluation:
        """Sum over the elements of all ranks; act: returns the sums of this one. The matrix stays distributed.

        The ranks exchange one array, that of the sums, in which each has a place for what is not a sum.
        """
        if self.ranks.size == 1:
            return act()
        failure: Exception | None = None
        fields = len(FIELD_NAMES)
        own = Evaluation(np.zeros(len(self)), None, np.zeros(fields), np.zeros(fields, np.int64), np.inf, np.zeros(8))
        own = replace(own, load=np.zeros(len(self)) if nrhs > 1 else None)
        try:
            own = act()
        except FAILURES as error:
            failure = error
        extremes = np.array([failure is not None, -own.pnewdt, *own.largest], dtype=np.float64)
        loads = [] if own.load is None else [own.load]
        counts = own.flux_count.astype(np.float64), own.entries.astype(np.float64)
        parts = [own.residual, *loads, own.flux, counts[0], own.energy, np.array([own.damage]), counts[1]]
        total = self.ranks.sum(np.concatenate([*parts, self.ranks.apart(extremes)]))
        residual, *loads, flux, count, energy, damage, entries, found = np.split(
            total, np.cumsum([len(part) for part in parts])
        )
        failed, refused, *largest = found.reshape(self.ranks.size, -1).max(axis=0)

        def raise_it() -> None:
            if failure is not None:
                raise failure

        if failed:
            self.ranks.agree(raise_it, self._calling_order)
        return Evaluation(
            residual,
            own.data,
            flux,
            count.astype(np.int64),
            -float(refused),
            energy,
            loads[0] if loads else None,
            float(damage[0]),
            np.array(largest),
            entries.astype(np.int64),
        )

    def _calling_order(self, error: Exception) -> float:
        """Return the position in the model of the element that an error names; infinite if it names none."""
        if isinstance(error, ElementError):
            for block in self.blocks:
                found = np.flatnonzero(block.group.labels == error.element)
                if block.group.type == error.element_type and len(found):
                    return float(block.first + block.rows[found[0]])
        return math.inf

    def artificial_mass(self, call: Call) -> FloatArray:
        """Return the mass of the built-in elements that have an artificial one, for unit density.

        Parameters
        ----------
        call
            Of the step; its request is replaced.

        Returns
        -------
        FloatArray
            (nnz,) CSR values in a new array: mass over density, thus volumes (length^3).
        """
        data = np.zeros(len(self.indices))
        for block in self.blocks:
            block.artificial_mass(call, len(self), data)
        return data

    def stress_matrix(self, call: Call, u: FloatArray, added: FloatArray | None = None) -> FloatArray:
        """Return the initial stress matrix: the stiffness of stresses that turn with the material.

        Parameters
        ----------
        call
            Of the step; its request is replaced.
        u
            (n,) unknowns of the base state.
        added
            (n,) a perturbation, whose stresses count; None: those of the base state do.

        Returns
        -------
        FloatArray
            (nnz,) CSR values in a new array.

        Raises
        ------
        KernelError
            A user material fails.
        """
        data = np.zeros(len(self.indices))
        request = Request.BASE_STRESS if added is None else Request.ADDED_STRESS
        for block in self.blocks:
            block.stress_matrix(call.asking(request), u, np.zeros_like(u) if added is None else added, data)
        return data

    def commit(self) -> None:
        """Commit the state of the last normal pass at the end of a converged increment.

        Raises
        ------
        ElementError
            An element that is linear only because the user says so is not.
        KernelError
            UVARM ends the analysis.
        """
        self._committed += 1
        energy = self.ranks.sum(self.ranks.agree(self._commit_own, self._calling_order))
        if self._last is not None:
            self._last.energy[:] += energy

    def _commit_own(self) -> FloatArray:
        """Commit the elements of this rank, and return ENERGY (8,) of those that the last pass spared."""
        energy = self._linear.catch_up()
        for block in (*self.blocks, *self.loaded):
            if not self._linear.waits(block):
                block.commit()
        for pair in self.contacts:
            pair.commit()
        return energy

    def viscous_change(self) -> float:
        """Return the largest change of a viscous strain rate in the increment times its length, by the last pass."""
        return float(
            self.ranks.largest(np.array([max((block.viscous_change for block in self.blocks), default=0.0)]))[0]
        )

    def states(self) -> States:
        """Return the committed states of all elements.

        Returns
        -------
        States
            A state for each block. They have to be read, if at all, before the next increment ends.
        """
        increment = self._committed
        return States(self._read_states, self._read_state, lambda: self._committed == increment)

    def _read_states(self) -> tuple[ElementState, ...]:
        self.ranks.ask()
        return self.share_states()

    def _read_state(self, index: int) -> ElementState | None:
        """Return the state of one block, or None if it takes a call of the elements or other ranks to read it."""
        block = self.blocks[index]
        return None if self.ranks.size > 1 or self._linear.waits(block) else block.state(index)

    def share_states(self) -> tuple[ElementState, ...]:
        """Collect the states of all ranks; rank 0 asks the others to do so when it reads them. Raises KernelError."""
        self.ranks.agree(self._linear.bring_up, self._calling_order)
        own = [(block.rows, block.state(k)) for k, block in enumerate(self.blocks)]
        if self.ranks.size == 1:
            return tuple(state for _, state in own)
        return tuple(map(_joined, zip(*self.ranks.collect(own), strict=True)))

    def contact_fields(self) -> dict[str, FloatArray]:
        """Return contact variables (nodes,) by Abaqus name at the end of the increment,
        NaN at nodes without a contact point.

        A node of several pairs has those of the one where its clearance is smallest.
        """
        if not self.contacts:
            return {}
        nodes = np.concatenate([block.secondary for block in self.contacts])
        clearance, pressure = (np.concatenate([block.output[k] for block in self.contacts]) for k in range(2))
        # directions of friction: one in the plane
        shear = np.concatenate([np.pad(block.output[2], ((0, 0), (0, 2)))[:, :2] for block in self.contacts])
        order = np.argsort(-clearance, kind="stable")
        found = {}
        for name, values in (
            ("COPEN", clearance),
            ("CPRESS", pressure),
            ("CSHEAR1", shear[:, 0]),
            ("CSHEAR2", shear[:, 1]),
        ):
            found[name] = np.full(len(self.dofs.mesh.labels), np.nan)
            found[name][nodes[order]] = values[order]
        for block in self.contacts:
            for name, values in block.bonds.items():
                of_nodes = found.setdefault(name, np.full(len(self.dofs.mesh.labels), np.nan))
                of_nodes[block.secondary] = np.fmax(of_nodes[block.secondary], values)
        return found

    def kept(self) -> Saved:
        """Return the committed states of all elements and of loads on their faces, not copied. Raises KernelError."""
        self._linear.bring_up()
        return {
            "blocks": [block.kept() for block in self.blocks],
            "faces": [[face.key, face.elements, face.kept()] for face in self._faces],
            "contacts": [pair.kept() for pair in self.contacts],
            "coupled": [coupled.kept() for coupled in self.coupled],
            "linear": self._linear.known,
        }

    def resume(self, saved: Saved) -> None:
        """Restore the state that `kept` returned. Raises ValueError if it is not of these elements."""
        if len(saved["blocks"]) != len(self.blocks):
            raise ValueError("groups of elements")
        if len(saved["contacts"]) != len(self.contacts):
            raise ValueError("contact pairs")
        if len(saved["coupled"]) != len(self.coupled):
            raise ValueError("distributing couplings")
        for block, own in zip(self.blocks, saved["blocks"], strict=True):
            block.resume(own)
        for pair, own in zip(self.contacts, saved["contacts"], strict=True):
            pair.resume(own)
        for coupled, own in zip(self.coupled, saved["coupled"], strict=True):
            coupled.resume(own)
        if self.contacts:
            self._bind()
        for key, elements, own in saved["faces"]:
            for face in self._faces:
                if face.key == key:
                    face.resume_some(elements, own)

    def relearn(self, call: Call, u: FloatArray, saved: Saved) -> None:
        """Compute the matrices of linear elements if the system had them when `saved` was kept.

        Parameters
        ----------
        call, u
            Of the end of the increment.
        saved
            What `kept` returned.

        Raises
        ------
        KernelError
            An element fails.
        """
        if saved["linear"]:
            self._linear.relearn(call, u)

    @property
    def _faces(self) -> list[FollowerBlock]:
        return [block for block in self.loaded if isinstance(block, FollowerBlock)]

    def product(self, data: FloatArray, vector: FloatArray) -> FloatArray:
        """Compute K x, with the parts of K of all ranks.

        Parameters
        ----------
        data
            (nnz,) CSR values of K.
        vector
            x: (n,).

        Returns
        -------
        FloatArray
            (n,).
        """
        return self.ranks.sum(np.asarray(self.matrix(data) @ vector))

    def matrix(self, data: FloatArray | ComplexArray) -> sparse.csr_array:
        """Return the matrix with these CSR values, on several ranks the part of this one's elements.

        Parameters
        ----------
        data
            (nnz,) real or complex, in the pattern of the system.

        Returns
        -------
        sparse.csr_array
            (n, n); it shares the values.
        """
        return sparse.csr_array((data, self.indices, self.indptr), shape=(len(self), len(self)))


def _joined(parts: tuple[tuple[IntArray, ElementState], ...]) -> ElementState:
    """Join the states of a group on each rank, which come with their rows in the group."""
    rows = np.argsort(np.concatenate([rows for rows, _ in parts]))
    state = parts[0][1]
    svars, energy = (np.concatenate(one)[rows] for one in zip(*((s.svars, s.energy) for _, s in parts), strict=True))
    return replace(state, svars=svars, energy=energy)


def build_pattern(n: int, numbers: Sequence[NDArray[np.int32]]) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Build the sparsity pattern of the assembled matrix.

    numbers holds, per block, the (m, k) unknowns of its elements. Returns row starts and columns.
    """
    pattern = sparse.csr_array(sparse.eye_array(n, dtype=np.bool_))
    for number in numbers:
        elements, unknowns = number.shape
        starts = np.arange(0, number.size + 1, unknowns)
        incidence = sparse.csr_array((np.ones(number.size, dtype=np.bool_), number.ravel(), starts), (elements, n))
        # unlike a list of all entries of all elements it takes no more memory than the pattern
        pattern = pattern + incidence.T @ incidence
    pattern.sort_indices()
    return pattern.indptr.astype(np.int32), pattern.indices.astype(np.int32)
