# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reason why a rank ended, in a file beside those of the job, for the ranks that it does not talk to any more.

MPI waits for a rank that has ended without end. Those that watch the ranks see the file, and end theirs.
"""

from __future__ import annotations

import time
from contextlib import suppress
from pathlib import Path
from typing import Final

_PATIENCE: Final = 20.0
"""Seconds that rank 0 has to end the job before the others let `mpiexec` do so."""


def leave_word(stem: Path, token: str, reason: str) -> None:
    """Say why this rank ended, unless another one has; token: by which the ranks know this run."""
    with suppress(OSError), _path(stem, token).open("x", encoding="utf-8", errors="replace") as file:
        file.write(reason + "\n")


def read_word(stem: Path, token: str) -> str:
    """Read the reason why a rank ended, '' if none has, or if there are no ranks."""
    if not token:
        return ""
    with suppress(OSError):
        text = _path(stem, token).read_text("utf-8", errors="replace")
        # the line is complete
        return text.removesuffix("\n") if text.endswith("\n") else ""
    return ""


def forget_word(stem: Path, token: str) -> None:
    """Remove the file: rank 0 has told the reason."""
    if not token:
        return
    with suppress(OSError):
        _path(stem, token).unlink(missing_ok=True)


def await_end(stem: Path, token: str) -> None:
    """Wait until rank 0 has told it: `mpiexec` ends all ranks when one of them has gone."""
    until = time.monotonic() + _PATIENCE
    while time.monotonic() < until and _path(stem, token).exists():
        time.sleep(0.1)


def _path(stem: Path, token: str) -> Path:
    return stem.with_name(f"{stem.name}.{token}")
