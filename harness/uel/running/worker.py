# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Process that isolation.py starts to call MODULE.main(arguments).

    python -m uel.running.worker PARENT DESCRIPTOR MODULE ARGUMENT ...

It notes on the slate that it has finished, since user code may end a process with exit code 0.
"""

from __future__ import annotations

import ctypes
import gc
import os
import signal
import sys
from collections.abc import Sequence
from importlib import import_module
from importlib.util import LazyLoader, find_spec, module_from_spec
from typing import Final

from uel.errors import tell_error
from uel.interrupts import held, raise_interrupts
from uel.running import sanitizer
from uel.shared_progress import keep_slate, open_slate

_PRCTL = getattr(ctypes.CDLL(None), "prctl", None)
_PR_SET_PDEATHSIG = 1
"""Linux: option of prctl that sends a signal to a process whose parent has ended."""

_POSTPONED: Final = ("f2py", "testing")
"""Parts of numpy that no job uses; scipy would load them, in a tenth of the time in which a job starts."""


def end_with(parent: int) -> None:
    """Let the system end this process when the one that watches it has ended."""
    if _PRCTL is not None:
        _PRCTL(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        # the parent had ended before it could be watched
        os._exit(1)


def postpone(package: str, parts: Sequence[str]) -> None:
    """Load parts of a package when an attribute of them is first read, not when they are imported."""
    parent = import_module(package)
    for part in parts:
        name = f"{package}.{part}"
        spec = None if name in sys.modules else find_spec(name)
        if spec is not None and spec.loader is not None:
            spec.loader = LazyLoader(spec.loader)
            module = sys.modules[name] = module_from_spec(spec)
            spec.loader.exec_module(module)
            # found as an attribute of the package it is not imported, which would load it
            setattr(parent, part, module)


def work(descriptor: int, module: str, arguments: Sequence[str]) -> int:
    """Call the function, with the location of user code on the slate; return the exit code."""
    slate = open_slate(descriptor)
    keep_slate(slate)
    sanitizer.stop_preloading()
    try:
        raise_interrupts()
        with held():  # an interrupt within an import may come out as another error
            gc.disable()
            postpone("numpy", _POSTPONED)
            import_module("uel.usersub").share_slate(descriptor)
            command = import_module(module)
            import_module("uel.running.job")
            # modules stay to the end: collections during the imports would take a fifth of their time
            gc.freeze()
            gc.enable()
        code: int = command.main(arguments)
    except KeyboardInterrupt as interrupt:
        tell_error(str(interrupt))
        code = 1
    slate.finished = 1 + code
    return code


if __name__ == "__main__":
    end_with(int(sys.argv[1]))
    sys.exit(work(int(sys.argv[2]), sys.argv[3], sys.argv[4:]))
