# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rows of a matrix that the ranks of a job share out, assembled from the part that each of them has."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray, IntArray
from uel.parallel.ranks import Ranks
from uel.solver.linear.linear_solver import Pattern


class DistributedRows:
    """Sums the parts of the ranks into rows of the matrix, each on the rank that owns it.

    order            (n,) unknowns by owner; rows and columns are numbered in this order
    first            number of the first row of this rank
    indptr, indices  CSR pattern of its rows, int32, columns ascending
    """

    def __init__(self, ranks: Ranks, pattern: Pattern, owners: IntArray) -> None:
        """Symbolic work; owners (n,) has a rank for each unknown, the same array on all ranks."""
        n = pattern.size
        self._ranks = ranks
        self.order = np.argsort(owners, kind="stable")
        number = np.empty(n, dtype=np.int64)
        number[self.order] = np.arange(n)
        owned = np.bincount(owners, minlength=ranks.size)
        self.first = int(owned[: ranks.rank].sum())
        rows = pattern.rows
        # an unknown without an element here has its diagonal entry only, as has one with a spring to the ground
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
        """Values of the rows of this rank from the part (nnz,) of each rank, added in the order of the ranks."""
        values = np.zeros(len(self.indices))
        parts = self._ranks.exchange_known(np.split(data[self._sent], self._ends), self._incoming)
        for positions, part in zip(self._positions, parts, strict=True):
            values[positions] += part
        return values
