# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reason why a rank ended, in a file beside those of the job, for the ranks that no longer hear from it.

MPI waits for ever for a rank that has ended. The processes that watch the other ranks see the file and end them.
"""

from __future__ import annotations

import time
from contextlib import suppress
from pathlib import Path
from typing import Final

_PATIENCE: Final = 20.0
"""Seconds that rank 0 has to end the job before the other ranks leave that to `mpiexec`."""


def write_reason(stem: Path, token: str, reason: str) -> None:
    """Write why this rank ended, unless another rank has written its reason; token: name of the run, from `Ranks`."""
    with suppress(OSError), _path(stem, token).open("x", encoding="utf-8", errors="replace") as file:
        file.write(reason + "\n")


def read_reason(stem: Path, token: str) -> str:
    """Return the reason why a rank ended; '' if none has ended, or if there are no ranks."""
    if not token:
        return ""
    with suppress(OSError):
        text = _path(stem, token).read_text("utf-8", errors="replace")
        # without its end the line is still being written
        return text.removesuffix("\n") if text.endswith("\n") else ""
    return ""


def remove_reason(stem: Path, token: str) -> None:
    """Remove the file after rank 0 has printed the reason."""
    if not token:
        return
    with suppress(OSError):
        _path(stem, token).unlink(missing_ok=True)


def await_end(stem: Path, token: str) -> None:
    """Wait until rank 0 has printed the reason: `mpiexec` ends all ranks as soon as one has ended."""
    until = time.monotonic() + _PATIENCE
    while time.monotonic() < until and _path(stem, token).exists():
        time.sleep(0.1)


def _path(stem: Path, token: str) -> Path:
    return stem.with_name(f"{stem.name}.{token}")
