# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Distribution of the elements of a system over the ranks of a job; a single process has all of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

import numpy as np

from uel.assembly.contributors import Contributors
from uel.assembly.evaluation import Evaluation
from uel.elements import FIELD_NAMES
from uel.errors import ElementError
from uel.model.arrays import FloatArray, IntArray
from uel.model.records import ElementState
from uel.parallel.partition import owners_of
from uel.parallel.ranks import FAILURES, Ranks

_T = TypeVar("_T")


class Sharing:
    """Distribution of the contributors of a model over the ranks, each of which keeps a part."""

    def __init__(self, contributors: Contributors, ranks: Ranks) -> None:
        """Begin with all contributors; `keep_own` drops those of other ranks."""
        self.ranks, self._contributors = ranks, contributors

    def keep_own(self) -> None:
        """Keep the elements of this rank and their loads. Raises UsageError if they cannot be distributed."""
        ranks, contributors = self.ranks, self._contributors
        if ranks.size == 1:
            return
        owners = ranks.on_rank_0(lambda: owners_of([block.nodes for block in contributors.elements], ranks.size))
        for block in contributors.shared:
            block.keep(np.flatnonzero(block.owners(owners) == ranks.rank))

    def agree(self, act: Callable[[], _T]) -> _T:
        """Call a function on each rank; raise the first error in calling order on all of them."""
        return self.ranks.agree(act, self._calling_order)

    def sum(self, values: FloatArray) -> FloatArray:
        """Sum an array over the ranks, see `Ranks.sum`."""
        return self.ranks.sum(values)

    def largest(self, value: float) -> float:
        """Return the largest value over the ranks."""
        return float(self.ranks.largest(np.array([value]))[0])

    def evaluate(self, act: Callable[[], Evaluation], unknowns: int, nrhs: int) -> Evaluation:
        """Sum the evaluations of all ranks, with `act` for this one; the matrix stays distributed.

        The ranks sum one array, in which each of them has entries for values that are not sums.
        """
        if self.ranks.size == 1:
            return act()
        failure: Exception | None = None
        fields = len(FIELD_NAMES)
        own = Evaluation(np.zeros(unknowns), None, np.zeros(fields), np.zeros(fields, np.int64), np.inf, np.zeros(8))
        own = replace(own, load=np.zeros(unknowns) if nrhs > 1 else None)
        try:
            own = act()
        except FAILURES as error:
            failure = error
        extremes = np.array([failure is not None, -own.pnewdt, *own.largest], dtype=np.float64)
        loads = [] if own.load is None else [own.load]
        counts = own.flux_count.astype(np.float64), own.entries.astype(np.float64)
        parts = [own.residual, *loads, own.flux, counts[0], own.energy, np.array([own.damage]), counts[1]]
        total = self.sum(np.concatenate([*parts, self.ranks.stacked(extremes)]))
        residual, *loads, flux, count, energy, damage, entries, extremes = np.split(
            total, np.cumsum([len(part) for part in parts])
        )
        failed, minus_pnewdt, *largest = extremes.reshape(self.ranks.size, -1).max(axis=0)

        def raise_own() -> None:
            if failure is not None:
                raise failure

        if failed:
            self.agree(raise_own)
        return Evaluation(
            residual,
            own.data,
            flux,
            count.astype(np.int64),
            -float(minus_pnewdt),
            energy,
            loads[0] if loads else None,
            float(damage[0]),
            np.array(largest),
            entries.astype(np.int64),
        )

    def states(self) -> tuple[ElementState, ...]:
        """Collect the states of all elements on rank 0."""
        own = [(block.rows, block.state(k)) for k, block in enumerate(self._contributors.elements)]
        if self.ranks.size == 1:
            return tuple(state for _, state in own)
        return tuple(map(_joined, zip(*self.ranks.gather(own), strict=True)))

    def _calling_order(self, error: Exception) -> float:
        """Return the position in the model of the element that an error names; infinity if it names none."""
        if isinstance(error, ElementError):
            for block in self._contributors.elements:
                rows = np.flatnonzero(block.group.labels == error.element)
                if block.group.type == error.element_type and len(rows):
                    return float(block.first + block.rows[rows[0]])
        return math.inf


def _joined(parts: tuple[tuple[IntArray, ElementState], ...]) -> ElementState:
    """Join the parts of the state of a group from all ranks, each with its rows in the group."""
    rows = np.argsort(np.concatenate([rows for rows, _ in parts]))
    state = parts[0][1]
    svars, energy = (np.concatenate(one)[rows] for one in zip(*((s.svars, s.energy) for _, s in parts), strict=True))
    return replace(state, svars=svars, energy=energy)
