# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Watched calls of user elements: changes of inputs, contents of local variables."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Final

import numpy as np

from uel.usersub import _binding

NAMES: Final = (
    *("RHS", "AMATRX", "SVARS", "ENERGY", "NDOFEL", "NRHS", "NSVARS", "PROPS", "NPROPS", "COORDS", "MCRD", "NNODE"),
    *("U", "DU", "V", "A", "JTYPE", "TIME", "DTIME", "KSTEP", "KINC", "JELEM", "PARAMS", "NDLOAD", "JDLTYP", "ADLMAG"),
    *("PREDEF", "NPREDF", "LFLAGS", "MLVARX", "DDLMAG", "MDLOAD", "PNEWDT", "JPROPS", "NJPROP", "PERIOD"),
    "MATERIALLIB",
)
"""Arguments of UEL, and the last of UELMAT, in Abaqus' order."""

SURROUNDED: Final = tuple(name for name in NAMES if name not in _binding.ARRAYS)
"""Arguments that have room around them while they are watched; the others always have guards."""

_MARK: Final = -559038737.0
"""Values around them when writes are looked for: nothing that an element would write, as integer or as real."""


@dataclass(frozen=True, slots=True)
class Change:
    """First entry (from 1) of an argument that a call has changed."""

    argument: str
    entry: int
    before: float
    after: float


@contextmanager
def watched_inputs() -> Iterator[Callable[[], list[Change]]]:
    """Watch the calls of elements; yields a function that returns the changes of inputs since its last call."""

    def changes() -> list[Change]:
        entries, values = _binding.take_changes()
        return [Change(NAMES[k], int(entries[k]), *map(float, values[k])) for k in np.flatnonzero(entries).tolist()]

    changes()
    before = _binding.watch_inputs(True)
    try:
        yield changes
    finally:
        _binding.watch_inputs(before)


@contextmanager
def around(values: Mapping[str, float]) -> Iterator[None]:
    """Surround arguments with numbers in calls of elements.

    Parameters
    ----------
    values
        Number by the name of the argument, one of SURROUNDED; around an integer argument, its integer part. What
        surrounds the others stays: 0, or the number of an `around` outside this one.
    """
    with watched_inputs():
        before = {name: _binding.exchange_around(NAMES.index(name), value) for name, value in values.items()}
        try:
            yield
        finally:
            for name, value in before.items():
                _binding.exchange_around(NAMES.index(name), value)


@contextmanager
def writes_outside() -> Iterator[Callable[[], dict[str, int]]]:
    """Watch the calls; yields a function that returns the arguments outside which they wrote, and the entry, from 1."""

    def found() -> dict[str, int]:
        return {NAMES[k]: entry for k, entry in _binding.take_outside().items()}

    with around(dict.fromkeys(SURROUNDED, _MARK)):
        found()
        yield found


@contextmanager
def local_variables(number: float) -> Iterator[None]:
    """Let uninitialised local variables of elements hold a number, as far as they are on the stack.

    Parameters
    ----------
    number
        Fills half a mebibyte of the stack before each call, as REAL*8. Such contexts do not nest: the end of an inner
        one ends the outer one too.
    """
    with watched_inputs():
        _binding.fill_stack(number)
        try:
            yield
        finally:
            _binding.fill_stack(None)
