# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""System that calls linear elements once and then uses their matrices."""

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
"""Largest difference of forces from AMATRX U, over the largest force in the block."""

MOST_ENTRIES: Final = 2**31 - 1
"""Largest number of entries of the matrices of a block that the driver can number."""


@dataclass(frozen=True, slots=True)
class KeptPass:
    """Last normal pass, in which linear elements were not called."""

    call: Call
    u: FloatArray
    du: FloatArray


class LinearShortcut(System):
    """System that calls linear elements once.

    The first pass of a static step with small displacements calls them; later passes add -K U with the AMATRX K of that
    call, after the forces of some elements of the block have been compared with it. The state of the elements is
    updated when it is read or when a pass calls them. Elements with other energies than that of K (hourglass control),
    and those that the user declares linear, are called at the end of each increment, which verifies the latter.
    """

    def __init__(
        self, mesh: Mesh, contributors: Contributors, equations: Sequence[Equation] = (), *, ranks: Ranks = ALONE
    ) -> None:
        """Assemble the contributors; arguments and errors as in `System`."""
        # AMATRX of each linear block, None before the first call
        self._matrices: dict[ElementBlock, FloatArray | None] = {}
        super().__init__(mesh, contributors, equations, ranks=ranks)
        blocks = (block for block in self.blocks if block.linear and block.matrix_entries <= MOST_ENTRIES)
        self._matrices = dict.fromkeys(blocks)
        self._last: Evaluation | None = None
        self._kept_pass: KeptPass | None = None
        self._pending: KeptPass | None = None
        self._missing_energy = np.zeros(8)

    def _bind(self) -> None:
        """Bind as `System` does, and add the known matrices into the new pattern."""
        super()._bind()
        self._known_data = np.zeros(len(self.indices))
        for block, matrices in self._matrices.items():
            if matrices is not None:
                block.add_matrices(matrices, self._known_data)

    def evaluate(self, call: Call, u: FloatArray, du: FloatArray, **options: Any) -> Evaluation:
        """Evaluate as `System` does; `commit` adds the energy of elements that were not called.

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
        """Run one pass, with matrices in place of linear elements if all are known and the pass may use them."""
        call, data, applies = now.call, now.data, self._applies(now)
        replaced = applies and self._known
        if not replaced:
            self._update_pending()
        elif data is not None:
            np.copyto(data, self._known_data)
        reports = []
        for block in self.blocks:
            matrices = self._matrices.get(block)
            if replaced and matrices is not None:
                report = block.linear_pass(matrices, call, now.u, now.columns[0])
            elif applies and data is not None and block in self._matrices:
                report = self._store_matrices(block, now)
            else:
                report = block.contribute(now)
            reports.append(report)
        reports += [contributor.contribute(now) for contributor in self.contributors.others]
        if call.flags.request is Request.NORMAL:
            self._kept_pass = KeptPass(call, now.u.copy(), now.du.copy()) if replaced else None
        return reports

    def _applies(self, now: CurrentPass) -> bool:
        """Return whether a pass may use matrices in place of linear elements."""
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

    def _store_matrices(self, block: ElementBlock, now: CurrentPass) -> BlockReport:
        """Run a normal pass over a block, and store its matrices if its forces are linear."""
        call = now.call
        report, matrices = block.evaluate_unassembled(call, now.u, now.du, now.columns[0])
        if now.data is not None:
            block.add_matrices(matrices, now.data)
        if self._matrices[block] is not None:
            return report
        # elements that the user declares linear are verified at the end of each increment
        if block.assumed_linear or not len(matrices) or has_forces_of(block, matrices, call):
            block.add_matrices(matrices, self._known_data)
            self._matrices[block] = matrices
        else:
            del self._matrices[block]
        return report

    def commit(self) -> None:
        """Commit as `System` does, and add the energy of elements that were not called to the last evaluation.

        Raises
        ------
        ElementError
            An element that the user declares linear is not.
        KernelError
            UVARM ends the analysis.
        """
        super().commit()
        energy = self.sum(self._missing_energy)
        if self._last is not None:
            self._last.energy[:] += energy

    def _commit_own(self) -> None:
        """Commit the contributors of this rank, except elements whose update is pending."""
        self._missing_energy = self._call_at_end()
        for contributor in self.contributors:
            if not self._is_pending(contributor):
                contributor.commit()

    def _call_at_end(self) -> FloatArray:
        """Call the linear elements that cannot wait; return their ENERGY (8,), which the evaluation lacks."""
        kept_pass, self._kept_pass = self._kept_pass, None
        self._pending, energy = kept_pass, np.zeros(8)
        if kept_pass is None:
            return energy
        for block, matrices in self._matrices.items():
            if block.can_wait:
                continue
            called = np.zeros_like(kept_pass.u)
            report = block.evaluate(kept_pass.call, kept_pass.u, kept_pass.du, called, None)
            energy += report.energy
            if block.assumed_linear and matrices is not None:
                _verify(block, matrices, kept_pass, called)
        return energy

    def _is_pending(self, contributor: Contributor) -> bool:
        """Return whether a contributor has not been updated to the end of the last increment."""
        return self._pending is not None and any(one is contributor and one.can_wait for one in self._matrices)

    def _update_pending(self) -> None:
        """Update elements whose update is pending to the end of the last increment. Raises KernelError."""
        pending = self._pending
        for block in self._matrices:
            if pending is not None and block.can_wait:
                block.evaluate(pending.call, pending.u, pending.du, np.zeros_like(pending.u), None)
                block.commit()
        self._pending = None

    def _read_state(self, index: int) -> ElementState | None:
        """Return the state of one block, also None if its update is pending."""
        return None if self._is_pending(self.blocks[index]) else super()._read_state(index)

    def share_states(self) -> tuple[ElementState, ...]:
        """Update all elements, and gather the states of all ranks as `System` does."""
        self.agree(self._update_pending)
        return super().share_states()

    def kept(self) -> Saved:
        """Return the committed states as `System` does, and whether matrices are known. Raises KernelError."""
        self._update_pending()
        return {**super().kept(), "linear": self._known}

    def restore_matrices(self, call: Call, u: FloatArray, saved: Saved) -> None:
        """Compute the matrices at the end of an increment if the system had them when `saved` was kept.

        States do not change. Raises KernelError.
        """
        now = CurrentPass(call, u, np.zeros_like(u), np.zeros((1, len(u))), None)
        if saved["linear"] and self._applies(now):
            for block in list(self._matrices):
                self._store_matrices(block, now)


def _verify(block: ElementBlock, matrices: FloatArray, kept_pass: KeptPass, called: FloatArray) -> None:
    """Raise ElementError if the forces of a block differ from those of its matrices."""
    expected = np.zeros_like(called)
    report = block.linear_pass(matrices, kept_pass.call, kept_pass.u, expected)
    if np.abs(called - expected).max() <= TOLERANCE * report.largest.max():
        return
    row, entry, rhs, linear = largest_deviation(block, matrices, kept_pass.call, kept_pass.u, kept_pass.du)
    message = f"is not linear: RHS({entry}) is {rhs:g}, its first AMATRX times U gives {linear:g}"
    hint = f"run without --linear {block.group.type}"
    label = int(block.group.labels[row])
    raise ElementError(label, block.group.type, f"{message} ({kept_pass.call.place}); {hint}")
