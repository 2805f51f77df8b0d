# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Progress of a process that calls user code, for the one that watches it: where it is, and that it has finished.

Both share its memory, so that it can be read whatever state the process is in, and after it has gone.
"""

from __future__ import annotations

import ctypes
import mmap
import os
import tempfile
from enum import IntEnum

BUILT_IN = "element"
"""The host's name for the routine of a built-in element (fortran/host/driver/element.f90)."""


class Within(IntEnum):
    """User code that runs."""

    NONE = 0
    CALL = 1
    LOADING = 2


class Slate(ctypes.Structure):
    """The memory, laid out as `struct slate` of fortran/host/guards/protect.c, and what Python adds.

    calls     of user routines so far
    within    one of Within
    left      number of calls that did not end by returning
    location  element, step, increment, iteration of the current call, or of the last one that was left
    routine   its name
    reason    why it was left, or why the process ends
    finished  1 + exit code of a process that ended by itself
    token     what all ranks of a job know it by, '' without ranks
    """

    _fields_ = (
        ("calls", ctypes.c_int64),
        ("within", ctypes.c_int32),
        ("left", ctypes.c_int32),
        ("location", ctypes.c_int32 * 4),
        ("routine", ctypes.c_char * 16),
        ("reason", ctypes.c_char * 256),
        ("finished", ctypes.c_int32),
        ("token", ctypes.c_char * 16),
    )

    calls: int
    within: int
    left: int
    finished: int
    token: bytes

    def where(self) -> str:
        """Describe the current call, or the last one left, with the reason; '' without either."""
        if self.within != Within.CALL and not self.left:
            return ""
        element, step, increment, iteration = self.location
        routine = self.routine.decode(errors="replace").strip()
        # a built-in element has no routine of the user's
        of = f"in {routine} {element}" if routine == BUILT_IN else f"in {routine} for element {element}"
        call = f"{of}, step {step}, increment {increment}, iteration {iteration}"
        reason = self.reason.decode(errors="replace")
        return f"{call}: {reason}" if reason else call


def new_slate() -> tuple[int, Slate]:
    """Create memory to share; return the descriptor of its file, which has no name, and the slate."""
    if hasattr(os, "memfd_create"):
        descriptor = os.memfd_create("uel")
    else:
        descriptor, name = tempfile.mkstemp()
        os.unlink(name)  # noqa: PTH108
    os.ftruncate(descriptor, ctypes.sizeof(Slate))
    return descriptor, open_slate(descriptor)


def open_slate(descriptor: int) -> Slate:
    """Map the memory that a descriptor stands for."""
    return Slate.from_buffer(mmap.mmap(descriptor, ctypes.sizeof(Slate)))


def own_slate() -> Slate | None:
    """Return the slate of this process, or None if nobody watches it."""
    return _own[0] if _own else None


def keep_slate(slate: Slate) -> None:
    """Say that it is that of this process."""
    _own[:] = [slate]


_own: list[Slate] = []
