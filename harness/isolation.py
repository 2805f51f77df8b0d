# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A run in a process of its own: whatever user code does to it, the files are closed and the reason is said."""

from __future__ import annotations

import ctypes
import resource
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import IO, Final

from harness.output.broken import close_broken

SAME_PROCESS: Final = "--same-process"
"""Option of `uel run` and `uel check` for the process that runs."""

_PRCTL = getattr(ctypes.CDLL(None), "prctl", None)
_PR_SET_PDEATHSIG = 1
"""Linux: a signal for a process whose parent has ended."""

_ENDED = 2
"""Exit code with which the Fortran library ends a process; usage errors, which have it too, were found before."""

_GLANCE: Final = 0.2
"""Seconds between two calls of `meanwhile`."""

_REASONS: Final = {
    signal.SIGKILL: "killed, by a user or by the system for lack of memory",
    signal.SIGABRT: "abort, mostly because a user routine wrote outside an array",
    signal.SIGSEGV: "segmentation fault outside a user routine, mostly because one wrote outside an array before",
}


def supervise(words: Sequence[str], stem: Path) -> int:
    """Run `uel` with these words in a process of its own; returns the exit code.

    stem is the folder and name of the job. A run that ends without closing its files gets them closed here.
    """
    code = run_apart(["harness.cli", *words, SAME_PROCESS])
    if code in (0, 1):
        return code
    reason = f"the run was {describe_end(code)}"
    close_broken(stem, reason)
    print(f"uel: {reason}; the output written so far is readable", file=sys.stderr)
    return 1


def run_apart(
    command: Sequence[str], errors: IO[str] | None = None, meanwhile: Callable[[], None] | None = None
) -> int:
    """Run a Python module with arguments in a process that user code may end; returns its exit code, -n for signal n.

    errors: where its messages go, by default to those of this process. meanwhile: is called now and then.
    """
    _take_all_stack()
    process = subprocess.Popen(
        [sys.executable, "-m", *command],
        stderr=errors,
        preexec_fn=_end_with_parent,  # noqa: PLW1509 (takes no lock: one call of the system)
    )
    code = None
    while code is None:
        try:
            code = process.wait(_GLANCE if meanwhile else None)
        except subprocess.TimeoutExpired:
            assert meanwhile is not None
            meanwhile()
        except KeyboardInterrupt:
            # the process gets the signal as well, and ends by itself
            continue
    return code


def _end_with_parent() -> None:
    """Whoever kills this process wants no other one to go on."""
    if _PRCTL is not None:
        _PRCTL(_PR_SET_PDEATHSIG, signal.SIGTERM)


def describe_end(code: int) -> str:
    """Why a process ended, by its exit code: the end of a sentence."""
    if code >= 0:
        who = " by the Fortran library, in an input or output statement of a user routine" if code == _ENDED else ""
        return f"ended{who} (exit code {code})"
    try:
        found = signal.Signals(-code)
    except ValueError:
        return f"ended by signal {-code}"
    return f"ended by {found.name}: {_REASONS.get(found, signal.strsignal(found))}"


def _take_all_stack() -> None:
    """Local arrays of user routines are on the stack; Abaqus runs them with as much of it as the system gives."""
    _, hard = resource.getrlimit(resource.RLIMIT_STACK)
    most = MOST_STACK if hard == resource.RLIM_INFINITY else min(hard, MOST_STACK)
    resource.setrlimit(resource.RLIMIT_STACK, (most, hard))


MOST_STACK: Final = 1 << 28
"""Bytes of stack: finite, so that endless recursion ends soon and is recognised."""
