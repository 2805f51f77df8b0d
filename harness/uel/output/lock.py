# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Name of a job, and the lock file (NAME.lck) that prevents a second run with the same name."""

from __future__ import annotations

import errno
import fcntl
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from uel.errors import UelError, UsageError


def job_stem(job: str, folder: str | Path | None) -> Path:
    """Return folder and name of a job. Raises UsageError for an invalid name."""
    if not job or job in (".", "..") or "/" in job or "\0" in job:
        raise UsageError(
            f"'{job}' cannot be a job name: expected a file name without folders (--output-dir takes the folder)"
        )
    return Path(folder or ".") / job


class LockedError(UelError):
    """Another process runs a job of this name in this folder."""


@contextmanager
def locked(stem: Path, *, wait: bool = False) -> Iterator[None]:
    """Lock STEM.lck in the block; if another process has locked it, wait, or raise LockedError.

    The system releases the lock when the process ends in any way; a leftover file is not locked.
    """
    path = stem.with_name(stem.name + ".lck")
    descriptor = _open(path, 0 if wait else fcntl.LOCK_NB)
    try:
        yield
    finally:
        path.unlink(missing_ok=True)
        os.close(descriptor)


def _open(path: Path, how: int) -> int:
    """Open the file and lock it; how: LOCK_NB to wait for nobody."""
    while True:
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | how)
            # the process that held it may have removed the file in the meantime
            if not path.exists() or not os.path.samestat(os.fstat(descriptor), path.stat()):
                os.close(descriptor)
                continue
        except BlockingIOError:
            owner = os.read(descriptor, 200).decode(errors="replace").strip() or "another process"
            os.close(descriptor)
            message = f"a job of this name runs in this folder: {path} is held by {owner}"
            raise LockedError(f"{message}; give another --job or --output-dir") from None
        except OSError as error:
            # a file system without locks gives no protection
            if error.errno not in (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP):
                os.close(descriptor)
                raise
        with suppress(OSError):  # who has it is a help only, and the disk may be full
            os.ftruncate(descriptor, 0)
            os.write(descriptor, f"process {os.getpid()} on {socket.gethostname()}\n".encode())
        return descriptor
