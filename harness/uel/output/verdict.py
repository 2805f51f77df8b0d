# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Verdict of a run that cannot write it itself, because it has not begun or was ended."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from uel.output.files.sta_file import COMPLETED, NOT_COMPLETED, head
from uel.output.formats import TextFile, remark
from uel.output.lock import LockedError, locked

_TEXTS = (".sta", ".msg", ".dat", "_history.csv", "_interface.csv")


def forget_verdict(stem: Path) -> None:
    """Empty STEM.sta and STEM.msg of an earlier run, whose verdict does not apply to the run that begins.

    The other files stay until the deck is read and the routines are compiled, so that an error there loses no results.
    """
    status, message = _files(stem)
    if status.exists():
        TextFile(message).close()
        file = TextFile(status)
        file.write(head())
        file.close()


def close_ended_run(stem: Path, reason: str) -> None:
    """Call `write_verdict` for a run in another process, unless a new run with this name has begun."""
    with suppress(LockedError, OSError), locked(stem):
        write_verdict(stem, reason)


def write_verdict(stem: Path, reason: str) -> None:
    """Write into STEM.sta and STEM.msg that the analysis has not been completed, and why; create no files.

    Cuts off incomplete last lines. Does nothing if the verdict has been written.
    """
    status, message = _files(stem)
    if not status.exists():
        return
    lines = status.read_text("utf-8", errors="replace").splitlines()
    if COMPLETED in lines or NOT_COMPLETED in lines:
        return
    for ending in _TEXTS:
        with suppress(OSError):  # a file that cannot be opened, or whose name is too long
            _cut(stem.with_name(stem.name + ending))
    with status.open("a", encoding="utf-8") as file:
        file.write(f"{' ' * 26}\n{NOT_COMPLETED}\n")
    with message.open("a", encoding="utf-8", errors="replace") as file:
        file.write(remark("ERROR", reason))


def _files(stem: Path) -> tuple[Path, Path]:
    return stem.with_name(f"{stem.name}.sta"), stem.with_name(f"{stem.name}.msg")


def _cut(path: Path) -> None:
    """Cut off an incomplete last line."""
    if not path.exists() or not path.stat().st_size:
        return
    with path.open("r+b") as file:
        end = file.seek(0, os.SEEK_END)
        file.seek(end - 1)
        if file.read() == b"\n":
            return
        start = end
        while start > 0:
            start = max(start - 65536, 0)
            file.seek(start)
            position = file.read(min(65536, end - start)).rfind(b"\n")
            if position >= 0:
                file.truncate(start + position + 1)
                return
        file.truncate(0)
