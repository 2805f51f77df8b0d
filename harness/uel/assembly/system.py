# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Assembled system: pattern and scatter maps once per mesh, one pass over the blocks per evaluation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from uel.assembly.contributors import Contributors
from uel.assembly.dofs import DofMap
from uel.assembly.element_states import States
from uel.assembly.evaluation import Evaluation
from uel.assembly.sharing import Sharing
from uel.contact import nodal_fields
from uel.elements import BlockReport, Call, Contributor, CurrentPass, Motion, Request
from uel.model.arrays import ComplexArray, FloatArray
from uel.model.mesh import Mesh
from uel.model.model import Equation, Model
from uel.model.records import ElementState
from uel.model.restart import Saved
from uel.parallel.ranks import ALONE, Ranks
from uel.usersub import Library

_T = TypeVar("_T")


class System:
    """All contributors of a model with one numbering of unknowns.

    blocks   blocks of elements
    dofs     node and dof of each unknown
    indptr   (n + 1,) row starts of the matrix, int32
    indices  (nnz,) columns, ascending in each row, int32. The pattern is symmetric and has all diagonal entries. A pass
             with a matrix in which contact points slide to other faces replaces both arrays
    """

    def __init__(
        self,
        mesh: Mesh,
        contributors: Contributors,
        equations: Sequence[Equation] = (),
        *,
        ranks: Ranks = ALONE,
    ) -> None:
        """Assemble the contributors of a model with this mesh and these constraints; this rank keeps a part of them.

        Raises UsageError if several ranks cannot share the elements.
        """
        self.sharing = Sharing(contributors, ranks)
        self.contributors, self.blocks = contributors, tuple(contributors.elements)
        self.dofs = DofMap.build(mesh, contributors, equations)
        self.sharing.keep_own()
        for contributor in contributors:
            contributor.number(self.dofs.find, self.dofs.equations_of(contributor))
        self._bind()
        self._committed = 0

    @property
    def ranks(self) -> Ranks:
        """Ranks of the job, for the linear solver; other code needs only `sum` and `agree`."""
        return self.sharing.ranks

    def sum(self, values: FloatArray) -> FloatArray:
        """Sum the contributions of all ranks, see `Sharing.sum`."""
        return self.sharing.sum(values)

    def agree(self, act: Callable[[], _T]) -> _T:
        """Call a function on each rank, see `Sharing.agree`."""
        return self.sharing.agree(act)

    def _bind(self) -> None:
        """Build the pattern in new arrays, and the positions of all contributors in it."""
        couplings = [contributor.couplings() for contributor in self.contributors]
        self.indptr, self.indices = build_pattern(len(self.dofs), couplings)
        for contributor in self.contributors:
            contributor.locate(self.indptr, self.indices)
        self._data = np.zeros(len(self.indices))

    @property
    def of_elements(self) -> NDArray[np.bool_]:
        """Mask (n,) of the unknowns of elements and distributing couplings."""
        mask = np.zeros(len(self.dofs), dtype=np.bool_)
        for contributor in (*self.blocks, *self.contributors.couplings):
            mask[contributor.couplings()] = True
        return mask

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

        In a linear step RHS has the loads on user elements alone; loads on built-in elements are added elsewhere.

        Parameters
        ----------
        call
            Arguments common to all elements.
        u, du
            (n,) estimate of the end of the increment, and the increment; both include prescribed values.
        matrix
            Request AMATRX.
        nrhs
            NRHS: 1, or 2 for the arc length method.
        motion
            V and A of all unknowns; None: at rest.

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
        now = CurrentPass(call, u, du, np.zeros((nrhs, len(self))), self._data if matrix else None, motion)
        return self.sharing.evaluate(partial(self._evaluate_own, now), len(self), nrhs)

    def _evaluate_own(self, now: CurrentPass) -> Evaluation:
        """Sum over the contributors of this rank; errors as in `evaluate`."""
        tracked = [contributor.track(now) for contributor in self.contributors]
        if not all(tracked):
            self._bind()
            now = replace(now, data=self._data)
        if now.data is not None:
            now.data.fill(0.0)
        reports = self._contribute(now)
        return Evaluation.of([*now.call.load_terms, *reports], now.columns, now.data)

    def _contribute(self, now: CurrentPass) -> list[BlockReport]:
        """Run one pass, whose matrix is zero so far, over all contributors."""
        return [contributor.contribute(now) for contributor in self.contributors]

    def artificial_mass(self, call: Call) -> FloatArray:
        """Return the artificial mass matrix of built-in elements, for unit density.

        Parameters
        ----------
        call
            Arguments of the step; the request is replaced.

        Returns
        -------
        FloatArray
            (nnz,) CSR values in a new array: mass over density (length^3).
        """
        data = np.zeros(len(self.indices))
        for block in self.blocks:
            block.artificial_mass(call, len(self), data)
        return data

    def stress_matrix(self, call: Call, u: FloatArray, added: FloatArray | None = None) -> FloatArray:
        """Return the initial stress matrix (geometric stiffness): stresses rotate with the material.

        Parameters
        ----------
        call
            Arguments of the step; the request is replaced.
        u
            (n,) unknowns of the base state.
        added
            (n,) perturbation whose stresses are used; None: those of the base state.

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
        KernelError
            UVARM ends the analysis.
        """
        self._committed += 1
        self.agree(self._commit_own)

    def _commit_own(self) -> None:
        """Commit the contributors of this rank."""
        for contributor in self.contributors:
            contributor.commit()

    def viscous_change(self) -> float:
        """Return the largest change of a viscous strain rate in the last pass, times the increment of time."""
        return self.sharing.largest(max((block.viscous_change for block in self.blocks), default=0.0))

    def states(self) -> States:
        """Return the committed states of all elements.

        Returns
        -------
        States
            A state for each block, to be read before the next increment ends.
        """
        increment = self._committed
        return States(self._read_states, self._read_state, lambda: self._committed == increment)

    def _read_states(self) -> tuple[ElementState, ...]:
        self.ranks.call_helpers()
        return self.share_states()

    def _read_state(self, index: int) -> ElementState | None:
        """Return the state of one block, or None if other ranks have a part of it."""
        return None if self.ranks.size > 1 else self.blocks[index].state(index)

    def share_states(self) -> tuple[ElementState, ...]:
        """Gather the states of all ranks on rank 0; all ranks call this. Raises KernelError."""
        return self.sharing.states()

    def contact_fields(self) -> dict[str, FloatArray]:
        """Return contact variables (nodes,), see `uel.contact.nodal_fields`."""
        return nodal_fields(self.contributors.contacts, len(self.dofs.mesh.labels))

    @property
    def obstacle(self) -> str:
        """Reason why *RESTART, WRITE cannot keep states; '' if it can."""
        return "several processes run the job" if self.ranks.size > 1 else ""

    def kept(self) -> Saved:
        """Return the committed states of all contributors, not copied, for *RESTART. Raises KernelError."""
        contributors = self.contributors
        return {
            "blocks": [block.kept() for block in self.blocks],
            "faces": [[face.key, face.elements, face.kept()] for face in contributors.followers],
            "contacts": [pair.kept() for pair in contributors.contacts],
            "coupled": [coupled.kept() for coupled in contributors.couplings],
        }

    def resume(self, saved: Saved) -> None:
        """Restore a state that `kept` returned. Raises ValueError if it belongs to another model."""
        contributors = self.contributors
        kinds: list[tuple[str, str, Sequence[Contributor]]] = [
            ("blocks", "groups of elements", self.blocks),
            ("contacts", "contact pairs", contributors.contacts),
            ("coupled", "distributing couplings", contributors.couplings),
        ]
        for key, what, own in kinds:
            if len(saved[key]) != len(own):
                raise ValueError(what)
        for key, _, own in kinds:
            for contributor, state in zip(own, saved[key], strict=True):
                contributor.resume(state)
        if contributors.contacts:
            self._bind()
        # later steps of a restart may load other faces
        for key, elements, state in saved["faces"]:
            for face in contributors.followers:
                if face.key == key:
                    face.resume_some(elements, state)

    def restore_matrices(self, call: Call, u: FloatArray, saved: Saved) -> None:
        """Compute the matrices of linear elements again if the system had them when `saved` was kept: none here.

        Parameters
        ----------
        call, u
            Arguments and unknowns (n,) at the end of the increment.
        saved
            Result of `kept`.

        Raises
        ------
        KernelError
            An element fails.
        """

    def product(self, data: FloatArray, vector: FloatArray) -> FloatArray:
        """Compute K x with the sum of the parts of K of all ranks.

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
        return self.sum(np.asarray(self.matrix(data) @ vector))

    def matrix(self, data: FloatArray | ComplexArray) -> sparse.csr_array:
        """Return the matrix with these CSR values; on several ranks, the part of the elements of this rank.

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


def system_of(model: Model, library: Library, *, strict: bool = True) -> System:
    """Assemble the system of a model in one process; errors as in `build_blocks`.

    strict: writes of user elements outside their arrays are errors.
    """
    return System(model.mesh, Contributors.of(model, library, strict=strict), model.equations)


def build_pattern(n: int, numbers: Sequence[NDArray[np.int32]]) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Build the sparsity pattern of the assembled matrix.

    numbers: for each block, the unknowns (m, k) of its elements. Returns row starts and columns.
    """
    pattern = sparse.csr_array(sparse.eye_array(n, dtype=np.bool_))
    for number in numbers:
        elements, unknowns = number.shape
        starts = np.arange(0, number.size + 1, unknowns)
        incidence = sparse.csr_array((np.ones(number.size, dtype=np.bool_), number.ravel(), starts), (elements, n))
        # takes no more memory than the pattern, unlike a list of the entries of all elements
        pattern = pattern + incidence.T @ incidence
    pattern.sort_indices()
    return pattern.indptr.astype(np.int32), pattern.indices.astype(np.int32)
