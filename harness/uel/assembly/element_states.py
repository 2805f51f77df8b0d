# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Element states of an increment, copied only when they are read."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import overload

from uel.errors import UelError
from uel.model.records import ElementState


class States(Sequence[ElementState]):
    """The states of all blocks at the end of an increment, copied when they are first read.

    Parameters
    ----------
    read
        Updates all blocks and returns copies of their states.
    read_one
        Returns a copy of the state of one block, or None if the block has to be updated first.
    current
        Returns whether the system is still at the end of that increment.

    Raises
    ------
    UelError
        They are first read after the end of the next increment.
    """

    def __init__(
        self,
        read: Callable[[], tuple[ElementState, ...]],
        read_one: Callable[[int], ElementState | None],
        current: Callable[[], bool],
    ) -> None:
        self._read, self._read_one, self._current = read, read_one, current
        self._states: tuple[ElementState, ...] | None = None

    def _all(self) -> tuple[ElementState, ...]:
        if self._states is None:
            if not self._current():
                raise UelError("element states have to be read before the next increment ends")
            self._states = self._read()
        return self._states

    def __len__(self) -> int:
        return len(self._all())

    @overload
    def __getitem__(self, index: int) -> ElementState: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[ElementState, ...]: ...

    def __getitem__(self, index: int | slice) -> ElementState | tuple[ElementState, ...]:
        if self._states is None and isinstance(index, int) and self._current():
            state = self._read_one(index)
            if state is not None:
                return state
        return self._all()[index]
