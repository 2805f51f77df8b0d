# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Files that a user names: read whole, or refused at once where reading might block or never end."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import Final

_MADE_BY_THE_KERNEL: Final = ("/proc/", "/sys/")
"""Folders whose entries look like files: some wait for events, some are as large as the memory."""


def deck_named(path: Path) -> Path:
    """Return the deck that a user names, who may leave out its ending, .inp, as in the name of a job."""
    whole = path.with_name(f"{path.name}.inp") if path.name else path
    return whole if not path.exists() and whole.exists() else path


def read_whole(path: Path) -> bytes:
    """Read the content of a file.

    Raises OSError with a sentence in strerror if there is no such file, or if it is a folder, a pipe, a device or
    made by the kernel; ValueError if no file can have this name.
    """
    _check(path.stat().st_mode)
    if os.path.realpath(path).startswith(_MADE_BY_THE_KERNEL):
        raise OSError(errno.EINVAL, "not a file")
    # does not wait for the other end if a pipe has replaced it
    descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
    with os.fdopen(descriptor, "rb") as file:
        _check(os.fstat(descriptor).st_mode)
        return file.read()


def _check(mode: int) -> None:
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    if not stat.S_ISREG(mode):
        raise OSError(errno.EINVAL, "not a file")
