# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Elements whose forces are linear in the displacements: they are called once, then replaced by their matrices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from uel.elements import BlockReport, Call, Contributor, ElementBlock, Motion, Request
from uel.errors import ElementError
from uel.model.arrays import FloatArray

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


class LinearElements:
    """The blocks of a system whose elements are linear.

    In a static step with small displacements they are called in the first pass; after that a pass adds -K U, with K
    the AMATRX of that call, once some elements of the block have been seen to have these forces. Their state is brought
    up to date when it is read, or needed by a pass that calls them; at the end of each increment if they have other
    energies than that of K (hourglass control), or are linear only because the user says so, which is verified then.
    """

    def __init__(self, blocks: Sequence[ElementBlock], entries: int) -> None:
        """Select the linear blocks of the system, in any order; entries: of its matrix."""
        self._blocks = [block for block in blocks if block.linear and block.matrix_entries <= MOST_ENTRIES]
        self._matrices: dict[int, FloatArray] = {}
        self._data = np.zeros(entries)
        self._behind: Behind | None = None
        self._unread: Behind | None = None

    def applies(self, call: Call, motion: Motion | None, nrhs: int) -> bool:
        """Return whether a pass may use the matrices in place of the elements, once they are known.

        Parameters
        ----------
        call, motion, nrhs
            As in `System.evaluate`.
        """
        flags = call.flags
        return (
            bool(self._blocks)
            and flags.procedure in STATIC
            and not (flags.nlgeom or flags.linear)
            and flags.request in (Request.NORMAL, Request.RESIDUAL)
            and (motion is None and nrhs == 1 and call.predefined is None)
            and not any(block.is_loaded(call.distributed) for block in self._blocks)
        )

    @property
    def known(self) -> bool:
        """Whether the matrices are known."""
        return len(self._matrices) == len(self._blocks)

    def __contains__(self, block: object) -> bool:
        return any(one is block for one in self._blocks)

    def learn(
        self, block: ElementBlock, call: Call, u: FloatArray, du: FloatArray, residual: FloatArray, data: FloatArray
    ) -> BlockReport:
        """Run a normal pass over a block, and keep its matrices if its forces are linear;
        arguments and result as in `ElementBlock.evaluate`.
        """
        report, matrices = block.evaluate_apart(call, u, du, residual)
        block.add_matrices(matrices, data)
        if id(block) in self._matrices:
            return report
        # the user's elements are not called again: they are verified at the end of each increment
        if block.assumed_linear or not len(matrices) or block.has_forces_of(matrices, call):
            block.add_matrices(matrices, self._data)
            self._matrices[id(block)] = matrices
        else:
            self._blocks = [other for other in self._blocks if other is not block]
        return report

    def rebind(self, entries: int) -> None:
        """Add the stored matrices into a new pattern with this number of entries."""
        self._data = np.zeros(entries)
        for block in self._blocks:
            if id(block) in self._matrices:
                block.add_matrices(self._matrices[id(block)], self._data)

    def relearn(self, call: Call, u: FloatArray) -> None:
        """Compute the matrices in the state at the end of an increment, if they apply to the call; states stay."""
        if not self.applies(call, None, 1):
            return
        for block in self._blocks:
            zero = np.zeros_like(u)
            self.learn(block, call, u, zero, zero.copy(), np.zeros_like(self._data))

    def forces(self, block: ElementBlock, call: Call, u: FloatArray, residual: FloatArray) -> BlockReport:
        """Add -K U of a block to residual (n,); see `ElementBlock.linear_pass`."""
        return block.linear_pass(self._matrices[id(block)], call, u, residual)

    def fill(self, data: FloatArray) -> None:
        """Set the CSR values (nnz,) to the matrices of all linear elements."""
        np.copyto(data, self._data)

    def passed(self, call: Call, u: FloatArray, du: FloatArray, *, spared: bool) -> None:
        """Record the end of a pass over all elements; spared: the linear ones were not called."""
        if call.flags.request is Request.NORMAL:
            self._behind = Behind(call, u.copy(), du.copy()) if spared else None

    def catch_up(self) -> FloatArray:
        """Call the elements that cannot wait at the end of an increment, and return their ENERGY (8,),
        which the pass lacks.

        Raises
        ------
        ElementError
            An element that the user says is linear is not.
        KernelError
            An element fails.
        """
        behind, self._behind = self._behind, None
        self._unread, energy = behind, np.zeros(8)
        if behind is None:
            return energy
        for block in self._blocks:
            if block.can_wait:
                continue
            called = np.zeros_like(behind.u)
            report = block.evaluate(behind.call, behind.u, behind.du, called, None)
            energy += report.energy
            if block.assumed_linear:
                self._verify(block, behind, called)
        return energy

    def waits(self, block: Contributor) -> bool:
        """Return whether the state of a block is older than the end of the last increment."""
        return self._unread is not None and any(one is block and one.can_wait for one in self._blocks)

    def bring_up(self) -> None:
        """Call the elements that wait for their state at the end of the last increment.

        Raises
        ------
        KernelError
            An element fails.
        """
        for block in [block for block in self._blocks if self.waits(block)]:
            unread = self._unread
            assert unread is not None
            block.evaluate(unread.call, unread.u, unread.du, np.zeros_like(unread.u), None)
            block.commit()
        self._unread = None

    def _verify(self, block: ElementBlock, behind: Behind, called: FloatArray) -> None:
        """Compare the forces of a block with those of its matrices."""
        expected = np.zeros_like(called)
        report = self.forces(block, behind.call, behind.u, expected)
        if np.abs(called - expected).max() <= TOLERANCE * report.largest.max():
            return
        matrices = self._matrices[id(block)]
        row, entry, found, linear = block.largest_deviation(matrices, behind.call, behind.u, behind.du)
        message = f"is not linear: RHS({entry}) is {found:g}, its first AMATRX times U gives {linear:g}"
        hint = f"run without --linear {block.group.type}"
        label = int(block.group.labels[row])
        raise ElementError(label, block.group.type, f"{message} ({behind.call.place}); {hint}")
