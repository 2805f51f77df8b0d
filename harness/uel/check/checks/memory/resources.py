# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Files that each call leaves open and memory that it does not free."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Final

from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed, not_applicable, passed
from uel.check.subject import Subject
from uel.usersub import allocated

CALLS: Final = 100
"""Number of equal calls that are compared, after as many during which one-off files and memory are obtained."""

ROUNDS: Final = 4
"""Number of comparisons: a table that grows now and then does not grow in each."""

LEAST: Final = 16
"""Bytes of the smallest allocation."""

_OPEN: Final = Path("/dev/fd")
"""Lists the open files of this process."""


def check(subject: Subject) -> Finding:
    """Check that equal calls change neither the number of open files nor the allocated memory."""
    if not _OPEN.is_dir():
        return not_applicable("the system does not say which files are open")
    state = subject.states[-1]
    _call(state)
    opened: list[list[str]] = []
    for _ in range(ROUNDS):
        files = _files()
        _call(state)
        opened.append(sorted(name for number, name in _files().items() if number not in files))
    allocations: list[int] = []
    for _ in range(ROUNDS):
        bytes_ = allocated()
        _call(state)
        allocations.append(allocated() - bytes_)
    fewest = min(opened, key=len)
    if len(fewest) >= CALLS:
        message = f"{state}: {CALLS} equal calls leave {len(fewest)} files open, {fewest[0]} among them"
        return failed(message, "CLOSE what a call opens; open files that all calls use in UEXTERNALDB, once.")
    if min(allocations) >= CALLS * LEAST:
        message = f"{state}: {CALLS} equal calls allocate {min(allocations)} bytes that they do not free"
        return failed(message, "DEALLOCATE (free, delete) what a call allocates, or allocate it once and keep it.")
    return passed(f"{CALLS} equal calls leave no file open and no memory allocated")


def _call(state: ElementState) -> None:
    for _ in range(CALLS):
        state.evaluate()


def _files() -> dict[int, str]:
    """Open files by their numbers; the one that reads this list is closed again."""
    files = {}
    for entry in _OPEN.iterdir():
        with suppress(OSError):
            files[int(entry.name)] = str(entry.readlink())
    return files
