# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rows of a matrix distributed over the ranks, assembled from the part of each rank."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray, IntArray
from uel.parallel.ranks import Ranks
from uel.solver.linear.linear_solver import Pattern


class DistributedRows:
    """Distributed rows of a matrix: sums of the parts of all ranks, on the rank that owns the row.

    order            (n,) unknowns by owner; rows and columns are numbered in this order
    first            number of the first row of this rank
    indptr, indices  CSR pattern of its rows, int32, columns ascending
    """

    def __init__(self, ranks: Ranks, pattern: Pattern, owners: IntArray) -> None:
        """Do the symbolic work; owners: (n,) rank of each unknown, the same array on all ranks."""
        n = pattern.size
        self._ranks = ranks
        self.order = np.argsort(owners, kind="stable")
        number = np.empty(n, dtype=np.int64)
        number[self.order] = np.arange(n)
        owned = np.bincount(owners, minlength=ranks.size)
        self.first = int(owned[: ranks.rank].sum())
        rows = pattern.rows
        # unknowns without an element on this rank have a diagonal entry only, as has one of a spring to the ground
        used = (np.diff(pattern.indptr) > 1)[rows] | (rows == pattern.indices)
        entries = np.flatnonzero(used)
        target = owners[rows[entries]]
        by_target = np.argsort(target, kind="stable")
        self._sent, target = entries[by_target], target[by_target]
        self._ends = np.searchsorted(target, np.arange(1, ranks.size))
        keys = number[rows[self._sent]] * n + number[pattern.indices[self._sent]]
        received = ranks.exchange(np.split(keys, self._ends))
        entries_here = np.unique(np.concatenate(received))
        self._incoming = np.array([len(part) for part in received])
        self._positions = [np.searchsorted(entries_here, part) for part in received]
        row = entries_here // max(n, 1) - self.first
        self.indptr = np.searchsorted(row, np.arange(owned[ranks.rank] + 1)).astype(np.int32)
        self.indices: NDArray[np.int32] = (entries_here % max(n, 1)).astype(np.int32)

    def assemble(self, data: FloatArray) -> FloatArray:
        """Return the values of the rows of this rank: the parts (nnz,) of the ranks, added in order."""
        values = np.zeros(len(self.indices))
        parts = self._ranks.exchange_known(np.split(data[self._sent], self._ends), self._incoming)
        for positions, part in zip(self._positions, parts, strict=True):
            values[positions] += part
        return values
