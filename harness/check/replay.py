# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Make the calls of a recorded run again, element by element in any order, and keep what each element returns."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from harness.check.recording import Commit, External, Pass, Recording, opened
from harness.elements import Block, build_blocks
from harness.errors import KernelError
from harness.model.arrays import FloatArray, IntArray
from harness.usersub import Library

Order = Callable[[int], IntArray]
"""From the number of elements to their positions (in Abaqus' order) in the order of calling; asked for every pass."""


def abaqus_order(count: int) -> IntArray:
    """Ascending element numbers, as Abaqus calls user elements on one thread."""
    return np.arange(count)


@dataclass(frozen=True, slots=True)
class Results:
    """What the elements returned in one pass.

    values    RHS, AMATRX, SVARS, ENERGY and PNEWDT of all elements, one behind the other; see Elements.entry
    called    (elements,) whether the element has been called
    refusals  errors by element position; the elements of such a type are not called again
    """

    made: Pass
    values: FloatArray
    called: NDArray[np.bool_]
    refusals: dict[int, KernelError]


class Elements:
    """All elements of a model, each in a block of its own; positions are those in Abaqus' order.

    types, names  of each element; a name is the number, or INSTANCE.number
    starts        (elements + 1,) first entry of each element in Results.values
    """

    def __init__(self, recording: Recording, library: Library) -> None:
        self._blocks: list[Block] = []
        self._equations: list[IntArray] = []
        for block, equations in zip(build_blocks(recording.model, library), recording.equations, strict=True):
            self._blocks += block.split()
            self._equations += list(equations)
        # columns of RHS
        self._columns = max((event.nrhs for event in recording.events if isinstance(event, Pass)), default=1)
        self._sizes = [_sizes(block, self._columns) for block in self._blocks]
        self.starts = np.cumsum([0, *(sum(sizes.values()) for sizes in self._sizes)])
        self.types = np.array([block.group.type for block in self._blocks])
        self.names = [_name(block) for block in self._blocks]
        for block in self._blocks:
            # unknowns of its own: what it returns is not added to anything, and AMATRX is not made symmetric
            n = len(block.unknowns)
            block.unsymmetric = True
            by_columns = np.arange(n * n, dtype=np.int32)
            block.bind(np.arange(n, dtype=np.int32)[None], by_columns.reshape(1, n, n).transpose(0, 2, 1))

    def __len__(self) -> int:
        return len(self._blocks)

    def entry(self, position: int, index: int) -> str:
        """Name of an entry of Results.values of an element, counted from its first: 'RHS(3)', 'AMATRX(1,2)'."""
        sizes, n = self._sizes[position], len(self._blocks[position].unknowns)
        firsts = dict(zip(sizes, np.cumsum([0, *sizes.values()]).tolist(), strict=False))
        array = max((name for name in sizes if sizes[name] and firsts[name] <= index), key=firsts.__getitem__)
        index -= firsts[array]
        if array == "PNEWDT":
            return array
        if array == "AMATRX" or (array == "RHS" and index >= n):
            column, row = divmod(index, n)
            return f"{array}({row + 1},{column + 1})"
        return f"{array}({index + 1})"

    def evaluate(self, position: int, made: Pass, values: FloatArray) -> None:
        """Call one element as in a pass of the recorded run; fills its entries of `values`. Raises KernelError."""
        block, equations = self._blocks[position], self._equations[position]
        n = len(block.unknowns)
        # -0.0 + x has the bits of x for every x
        residual, matrix = np.full((self._columns, n), -0.0), np.full(n * n, -0.0)
        report = block.evaluate(
            made.call,
            made.u[equations],
            made.du[equations],
            residual[0] if made.nrhs == 1 else residual,
            matrix if made.matrix else None,
            made.motion and made.motion.at(equations),
        )
        state = block.trial(0)
        values[self.starts[position] : self.starts[position + 1]] = np.concatenate(
            [residual.ravel(), matrix, state.svars[0], state.energy[0], [report.pnewdt]]
        )

    def commit(self) -> None:
        """End of a converged increment."""
        for block in self._blocks:
            block.commit()


def replay(recording: Recording, order: Order) -> Iterator[tuple[Elements, Results]]:
    """Make all calls again with freshly loaded user routines; yields each pass, whose `made` is that of the run."""
    with opened(recording.model, recording.user) as library:
        elements = Elements(recording, library)
        refused: set[str] = set()
        for event in recording.events:
            match event:
                case Commit():
                    elements.commit()
                case External(lop, lrestart, time, dtime, step, increment):
                    library.external_database(lop, lrestart, time, dtime, step, increment)
                case Pass():
                    results = _replay_pass(elements, event, order(len(elements)), refused)
                    # the next error is to be explained by its own message
                    library.messages()
                    yield elements, results


def _replay_pass(elements: Elements, made: Pass, order: IntArray, refused: set[str]) -> Results:
    values = np.zeros(elements.starts[-1])
    called = np.zeros(len(elements), dtype=np.bool_)
    refusals: dict[int, KernelError] = {}
    for position in order.tolist():
        kind = str(elements.types[position])
        if kind in refused:
            continue
        try:
            elements.evaluate(position, made, values)
            called[position] = True
        except KernelError as error:
            refused.add(kind)
            refusals[position] = error
    return Results(made, values, called, refusals)


def _sizes(block: Block, columns: int) -> dict[str, int]:
    """Entries of each array of an element in Results.values, in their order there."""
    n, state = len(block.unknowns), block.trial(0)
    return {"RHS": columns * n, "AMATRX": n * n, "SVARS": state.svars.shape[1], "ENERGY": 8, "PNEWDT": 1}


def _name(block: Block) -> str:
    label, instance = int(block.group.labels[0]), block.group.instance
    return f"{instance}.{label}" if instance else str(label)
