# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""System whose linear elements are called once, then replaced by their matrices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from uel.assembly.contributors import Contributors
from uel.assembly.evaluation import Evaluation
from uel.assembly.system import System
from uel.elements import BlockReport, Call, Contributor, CurrentPass, ElementBlock, Request
from uel.elements.linear_forces import has_forces_of, largest_deviation
from uel.errors import ElementError
from uel.model.arrays import FloatArray
from uel.model.mesh import Mesh
from uel.model.model import Equation
from uel.model.records import ElementState
from uel.model.restart import Saved
from uel.parallel.ranks import ALONE, Ranks

STATIC: Final = (1, 2)
"""LFLAGS(1) of *STATIC, with automatic and with direct increments."""

TOLERANCE: Final = 1e-6
"""Largest part of the forces in a block by which those of an element may differ from its matrix times U."""

MOST_ENTRIES: Final = 2**31 - 1
"""Entries of the matrices of a block that the driver can number."""


@dataclass(frozen=True, slots=True)
class Behind:
    """The last pass that keeps a state, of which the linear elements know nothing yet."""

    call: Call
    u: FloatArray
    du: FloatArray


class LinearShortcut(System):
    """A system that does not call linear elements again.

    In a static step with small displacements they are called in the first pass; after that a pass adds -K U, with K
    the AMATRX of that call, once some elements of the block have been seen to have these forces. Their state is brought
    up to date when it is read, or needed by a pass that calls them; at the end of each increment if they have other
    energies than that of K (hourglass control), or are linear only because the user says so, which is verified then.
    """

    def __init__(
        self, mesh: Mesh, contributors: Contributors, equations: Sequence[Equation] = (), *, ranks: Ranks = ALONE
    ) -> None:
        """Assemble the contributors; arguments and errors as in `System`."""
        # AMATRX of the elements of each linear block, None before the first call
        self._matrices: dict[ElementBlock, FloatArray | None] = {}
        super().__init__(mesh, contributors, equations, ranks=ranks)
        blocks = (block for block in self.blocks if block.linear and block.matrix_entries <= MOST_ENTRIES)
        self._matrices = dict.fromkeys(blocks)
        self._last: Evaluation | None = None
        self._behind: Behind | None = None
        self._unread: Behind | None = None
        self._lacking = np.zeros(8)

    def _bind(self) -> None:
        """Bind as a system does, and add the matrices that are known into the new pattern."""
        super()._bind()
        self._known_data = np.zeros(len(self.indices))
        for block, matrices in self._matrices.items():
            if matrices is not None:
                block.add_matrices(matrices, self._known_data)

    def evaluate(self, call: Call, u: FloatArray, du: FloatArray, **options: Any) -> Evaluation:
        """Evaluate as a system does; `commit` adds the energy of elements that were not called.

        Parameters
        ----------
        call, u, du
            As in `System.evaluate`.
        **options
            `matrix`, `nrhs` and `motion`, as there.

        Returns
        -------
        Evaluation
            Sums over all elements.

        Raises
        ------
        KernelError, CallLimitError
            As in `System.evaluate`.
        """
        evaluation = super().evaluate(call, u, du, **options)
        if call.flags.request is Request.NORMAL:
            self._last = evaluation
        return evaluation

    def _contribute(self, now: CurrentPass) -> list[BlockReport]:
        """Run one pass, with the matrices in place of linear elements if they are known and apply to it."""
        call, data, applies = now.call, now.data, self._applies(now)
        spared = applies and self._known
        if not spared:
            self._bring_up()
        elif data is not None:
            np.copyto(data, self._known_data)
        reports = []
        for block in self.blocks:
            matrices = self._matrices.get(block)
            if spared and matrices is not None:
                report = block.linear_pass(matrices, call, now.u, now.columns[0])
            elif applies and data is not None and block in self._matrices:
                report = self._learn(block, now)
            else:
                report = block.contribute(now)
            reports.append(report)
        reports += [contributor.contribute(now) for contributor in self.contributors.others]
        if call.flags.request is Request.NORMAL:
            self._behind = Behind(call, now.u.copy(), now.du.copy()) if spared else None
        return reports

    def _applies(self, now: CurrentPass) -> bool:
        """Return whether a pass may use the matrices in place of the elements, once they are known."""
        call, flags = now.call, now.call.flags
        return (
            bool(self._matrices)
            and flags.procedure in STATIC
            and not (flags.nlgeom or flags.linear)
            and now.has_forces
            and (now.motion is None and len(now.columns) == 1 and call.predefined is None)
            and not any(block.is_loaded(call.distributed) for block in self._matrices)
        )

    @property
    def _known(self) -> bool:
        """Whether all matrices are known."""
        return all(matrices is not None for matrices in self._matrices.values())

    def _learn(self, block: ElementBlock, now: CurrentPass) -> BlockReport:
        """Run a normal pass over a block, and keep its matrices if its forces are linear."""
        call = now.call
        report, matrices = block.evaluate_unassembled(call, now.u, now.du, now.columns[0])
        if now.data is not None:
            block.add_matrices(matrices, now.data)
        if self._matrices[block] is not None:
            return report
        # the user's elements are not called again: they are verified at the end of each increment
        if block.assumed_linear or not len(matrices) or has_forces_of(block, matrices, call):
            block.add_matrices(matrices, self._known_data)
            self._matrices[block] = matrices
        else:
            del self._matrices[block]
        return report

    def commit(self) -> None:
        """Commit as a system does, and add the energy of elements that were not called to the last evaluation.

        Raises
        ------
        ElementError
            An element that is linear only because the user says so is not.
        KernelError
            UVARM ends the analysis.
        """
        super().commit()
        energy = self.sum(self._lacking)
        if self._last is not None:
            self._last.energy[:] += energy

    def _commit_own(self) -> None:
        """Commit the contributors of this rank, except elements whose state can wait until it is read."""
        self._lacking = self._catch_up()
        for contributor in self.contributors:
            if not self._waits(contributor):
                contributor.commit()

    def _catch_up(self) -> FloatArray:
        """Call the elements that cannot wait at the end of an increment, and return their ENERGY (8,),
        which the pass lacks.
        """
        behind, self._behind = self._behind, None
        self._unread, energy = behind, np.zeros(8)
        if behind is None:
            return energy
        for block, matrices in self._matrices.items():
            if block.can_wait:
                continue
            called = np.zeros_like(behind.u)
            report = block.evaluate(behind.call, behind.u, behind.du, called, None)
            energy += report.energy
            if block.assumed_linear and matrices is not None:
                _verify(block, matrices, behind, called)
        return energy

    def _waits(self, contributor: Contributor) -> bool:
        """Return whether the state of a contributor is older than the end of the last increment."""
        return self._unread is not None and any(one is contributor and one.can_wait for one in self._matrices)

    def _bring_up(self) -> None:
        """Call the elements that wait for their state at the end of the last increment. Raises KernelError."""
        unread = self._unread
        for block in self._matrices:
            if unread is not None and block.can_wait:
                block.evaluate(unread.call, unread.u, unread.du, np.zeros_like(unread.u), None)
                block.commit()
        self._unread = None

    def _read_state(self, index: int) -> ElementState | None:
        """Return the state of one block, None also if it waits."""
        return None if self._waits(self.blocks[index]) else super()._read_state(index)

    def share_states(self) -> tuple[ElementState, ...]:
        """Bring up to date and collect the states of all ranks, as a system does."""
        self.agree(self._bring_up)
        return super().share_states()

    def kept(self) -> Saved:
        """Return the committed states as a system does, and whether matrices are known. Raises KernelError."""
        self._bring_up()
        return {**super().kept(), "linear": self._known}

    def relearn(self, call: Call, u: FloatArray, saved: Saved) -> None:
        """Compute the matrices in the state at the end of an increment, if the system had them when `saved` was kept
        and they apply to the call; states stay. Raises KernelError.
        """
        now = CurrentPass(call, u, np.zeros_like(u), np.zeros((1, len(u))), None)
        if saved["linear"] and self._applies(now):
            for block in list(self._matrices):
                self._learn(block, now)


def _verify(block: ElementBlock, matrices: FloatArray, behind: Behind, called: FloatArray) -> None:
    """Compare the forces of a block with those of its matrices. Raises ElementError."""
    expected = np.zeros_like(called)
    report = block.linear_pass(matrices, behind.call, behind.u, expected)
    if np.abs(called - expected).max() <= TOLERANCE * report.largest.max():
        return
    row, entry, found, linear = largest_deviation(block, matrices, behind.call, behind.u, behind.du)
    message = f"is not linear: RHS({entry}) is {found:g}, its first AMATRX times U gives {linear:g}"
    hint = f"run without --linear {block.group.type}"
    label = int(block.group.labels[row])
    raise ElementError(label, block.group.type, f"{message} ({behind.call.place}); {hint}")
