# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Replay of the calls of a recorded run, element by element in any order, with the results of each element."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uel.assembly import Contributors
from uel.check.recording import Commit, External, Pass, Recording, opened
from uel.check.single import Single, entry
from uel.errors import KernelError
from uel.model.arrays import FloatArray, IntArray
from uel.procedures import set_initial_states
from uel.usersub import Library

Order = Callable[[int], IntArray]
"""Function from the number of elements to their positions (in Abaqus' order) in calling order, called in every pass."""


def abaqus_order(count: int) -> IntArray:
    """Return elements in ascending order, in which Abaqus calls user elements on one thread."""
    return np.arange(count)


@dataclass(frozen=True, slots=True)
class Results:
    """Results of the elements in one pass.

    values    RHS, AMATRX, SVARS, ENERGY and PNEWDT of all elements, one after the other; see Elements.entry
    called    (elements,) whether the element has been called
    refusals  errors by element position; the elements of such a type are not called again
    """

    made: Pass
    values: FloatArray
    called: NDArray[np.bool_]
    refusals: dict[int, KernelError]


class Elements:
    """All elements of a model, each in a separate block; positions are those in Abaqus' order.

    types, names  of each element; a name is the number, or INSTANCE.number
    starts        (elements + 1,) first entry of each element in Results.values
    """

    def __init__(self, recording: Recording, library: Library, *, strict: bool = True) -> None:
        self.singles: list[Single] = []
        self.equations: list[IntArray] = []
        self.library = library
        blocks = Contributors.of(recording.model, library, strict=strict).elements
        for block, equations in zip(blocks, recording.equations, strict=True):
            self.singles += [Single(element) for element in block.split(strict=strict)]
            self.equations += list(equations)
        # columns of RHS
        self._columns = max((event.nrhs for event in recording.events if isinstance(event, Pass)), default=1)
        sizes = [self._columns * n + n * n + svars + 8 + 1 for n, svars in map(self._lengths, range(len(self)))]
        self.starts = np.cumsum([0, *sizes])
        self.types = np.array([single.block.group.type for single in self.singles])
        self.names = [single.name for single in self.singles]

    def __len__(self) -> int:
        return len(self.singles)

    def entry(self, position: int, index: int) -> str:
        """Name an entry of Results.values of an element, counted from its first: 'RHS(3)', 'AMATRX(1,2)'."""
        n, svars = self._lengths(position)
        return entry(index, n, self._columns, svars)

    def evaluate(self, position: int, made: Pass, values: FloatArray) -> None:
        """Call one element as in a pass of the recorded run; fills its entries of `values`. Raises KernelError."""
        equations = self.equations[position]
        motion = made.motion and made.motion.at(equations)
        returned = self.singles[position].evaluate(
            made.call, made.u[equations], made.du[equations], motion, matrix=made.matrix, nrhs=made.nrhs
        )
        values[self.starts[position] : self.starts[position + 1]] = returned.flat(self._columns)

    def _lengths(self, position: int) -> tuple[int, int]:
        """Return the unknowns and SVARS of an element."""
        block = self.singles[position].block
        return len(block.unknowns), block.trial(0).svars.shape[1]

    def commit(self) -> None:
        """Commit the state at the end of a converged increment."""
        for single in self.singles:
            single.block.commit()


def replay(
    recording: Recording, order: Order, *, strict: bool = True
) -> Generator[tuple[Elements, Results], None, None]:
    """Repeat all calls with newly loaded user routines; yields each pass, whose `made` is that of the run.

    strict: an element that writes outside an array is refused.
    """
    with opened(recording.model, recording.user, recording.build) as library:
        elements = Elements(recording, library, strict=strict)
        refused: set[str] = set()
        for event in recording.events:
            match event:
                case Commit():
                    elements.commit()
                case External(lop, lrestart, time, dtime, step, increment):
                    library.external_database(lop, lrestart, time, dtime, step, increment)
                    if lop == 0:
                        blocks = [single.block for single in elements.singles]
                        set_initial_states(blocks, recording.model, library)
                case Pass():
                    results = _replay_pass(elements, event, order(len(elements)), refused)
                    # the next error gets its own message
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
