# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Single element, called separately."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uel.elements import Call, ElementBlock, Motion
from uel.model.arrays import FloatArray
from uel.model.mesh import full_name


@dataclass(frozen=True, slots=True)
class Returned:
    """Output of one element: RHS (NRHS, n), AMATRX (n, n), SVARS, ENERGY (8,), PNEWDT."""

    rhs: FloatArray
    amatrx: FloatArray
    svars: FloatArray
    energy: FloatArray
    pnewdt: float

    def flat(self, columns: int) -> FloatArray:
        """Return all values one after the other, as `entry` counts them; RHS is padded to this number of columns."""
        padding = np.zeros((columns - len(self.rhs), self.rhs.shape[1]))
        arrays = [self.rhs, padding, self.amatrx.T]
        return np.concatenate([array.ravel() for array in arrays] + [self.svars, self.energy, [self.pnewdt]])


def first_difference(expected: Returned, returned: Returned) -> str:
    """Name the first entry whose bits differ, in a sentence; '' if there is none."""
    columns, n = expected.rhs.shape
    values = expected.flat(columns), returned.flat(columns)
    unequal = np.flatnonzero(values[0].view(np.int64) != values[1].view(np.int64))
    if not len(unequal):
        return ""
    index = int(unequal[0])
    return f"{entry(index, n, columns, len(expected.svars))} is {values[0][index]:.10g}, then {values[1][index]:.10g}"


def entry(index: int, n: int, columns: int, svars: int) -> str:
    """Name an entry of Returned.flat, counted from 0: 'RHS(3)', 'AMATRX(1,2)'."""
    for array, size in (("RHS", columns * n), ("AMATRX", n * n), ("SVARS", svars), ("ENERGY", 8), ("PNEWDT", 1)):
        if index < size or array == "PNEWDT":
            break
        index -= size
    if array == "PNEWDT":
        return array
    if array == "AMATRX" or (array == "RHS" and index >= n):
        column, row = divmod(index, n)
        return f"{array}({row + 1},{column + 1})"
    return f"{array}({index + 1})"


class Single:
    """Element in a separate block, with local unknowns."""

    def __init__(self, block: ElementBlock) -> None:
        n = len(block.unknowns)
        self.block = block
        # what it returns is not added to anything, and AMATRX is not made symmetric
        block.unsymmetric = True
        by_columns = np.arange(n * n, dtype=np.int32)
        block.bind(np.arange(n, dtype=np.int32)[None], by_columns.reshape(1, n, n).transpose(0, 2, 1))

    @property
    def name(self) -> str:
        """Number of the element, or INSTANCE.number."""
        group = self.block.group
        return full_name(group.instance, int(group.labels[0]))

    @property
    def svars(self) -> FloatArray:
        """State variables (nsvars,) at the start of the increment."""
        return np.asarray(self.block.state(0).svars[0])

    @property
    def energy(self) -> FloatArray:
        """ENERGY (8,) at the start of the increment."""
        return np.asarray(self.block.state(0).energy[0])

    def twin(self, *, strict: bool) -> Single:
        """Copy the element in its committed state; calls of the copy do not affect this one."""
        return Single(self.block.split(strict=strict)[0])

    def placed(self, coordinates: FloatArray) -> Single:
        """Copy the element in its committed state, with new coordinates (nodes of the model, 3)."""
        return Single(self.block.split(strict=False, coordinates=coordinates)[0])

    def evaluate(
        self, call: Call, u: FloatArray, du: FloatArray, motion: Motion | None, *, matrix: bool = True, nrhs: int = 1
    ) -> Returned:
        """Call the element with local U, DU, V and A (n,); AMATRX is zero unless requested. Raises KernelError."""
        n = len(self.block.unknowns)
        # -0.0 + x has the bits of x for every x
        residual, values = np.full((nrhs, n), -0.0), np.full(n * n, -0.0)
        report = self.block.evaluate(
            call, u, du, residual[0] if nrhs == 1 else residual, values if matrix else None, motion
        )
        state = self.block.trial(0)
        return Returned(residual, values.reshape(n, n).T, state.svars[0], state.energy[0], report.pnewdt)
