# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Calls of user elements that are watched: what they change of their inputs, and what their local variables hold."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Final

import numpy as np

from harness.usersub import _binding

NAMES: Final = (
    *("RHS", "AMATRX", "SVARS", "ENERGY", "NDOFEL", "NRHS", "NSVARS", "PROPS", "NPROPS", "COORDS", "MCRD", "NNODE"),
    *("U", "DU", "V", "A", "JTYPE", "TIME", "DTIME", "KSTEP", "KINC", "JELEM", "PARAMS", "NDLOAD", "JDLTYP", "ADLMAG"),
    *("PREDEF", "NPREDF", "LFLAGS", "MLVARX", "DDLMAG", "MDLOAD", "PNEWDT", "JPROPS", "NJPROP", "PERIOD"),
    "MATERIALLIB",
)
"""Arguments of UEL, and the last of UELMAT, in Abaqus' order."""


@dataclass(frozen=True, slots=True)
class Change:
    """An argument whose entry (from 1) has another value after a call than before; there may be more such entries."""

    argument: str
    entry: int
    before: float
    after: float


@contextmanager
def watched_inputs() -> Iterator[Callable[[], list[Change]]]:
    """Watch the calls of elements; what it gives returns the changes of inputs since it was called last."""

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
def beyond_jprops(number: int) -> Iterator[None]:
    """Let a number lie behind the last entry of JPROPS."""
    with watched_inputs():
        _binding.fill_beyond(number)
        try:
            yield
        finally:
            _binding.fill_beyond(0)


@contextmanager
def local_variables(number: float) -> Iterator[None]:
    """Let local variables of elements that are given no value hold a number, as far as they are on the stack."""
    with watched_inputs():
        _binding.fill_stack(number)
        try:
            yield
        finally:
            _binding.fill_stack(None)
