# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The process that isolation.py starts, to call MODULE.main(words).

    python -m uel.running.worker PARENT DESCRIPTOR MODULE WORD ...

It notes on the slate that it has finished: user code may end a process with the exit code of success.
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
"""Linux: a signal for a process whose parent has ended."""

_POSTPONED: Final = ("f2py", "testing")
"""Parts of numpy that no job uses; scipy would load them with all others, in a tenth of the time that a job starts."""


def end_with(parent: int) -> None:
    """Let the system end this process when the one that watches it has ended."""
    if _PRCTL is not None:
        _PRCTL(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        # too late for a signal
        os._exit(1)


def postpone(package: str, parts: Sequence[str]) -> None:
    """Let parts of a package be loaded where something of them is first read, not where they are imported."""
    parent = import_module(package)
    for part in parts:
        name = f"{package}.{part}"
        spec = None if name in sys.modules else find_spec(name)
        if spec is not None and spec.loader is not None:
            spec.loader = LazyLoader(spec.loader)
            module = sys.modules[name] = module_from_spec(spec)
            spec.loader.exec_module(module)
            # an `import` would look into the module, which loads it; whoever finds it here does not import it
            setattr(parent, part, module)


def work(descriptor: int, module: str, words: Sequence[str]) -> int:
    """Call the function, and show on the slate where user code is; returns the exit code."""
    slate = open_slate(descriptor)
    keep_slate(slate)
    sanitizer.forget()
    try:
        raise_interrupts()
        with held():  # an interrupt within an import may come out as another error
            gc.disable()
            postpone("numpy", _POSTPONED)
            import_module("uel.usersub").share_slate(descriptor)
            command = import_module(module)
            import_module("uel.running.job")
            # modules stay to the end; to look for memory to collect within the imports takes a fifth of their time
            gc.freeze()
            gc.enable()
        code: int = command.main(words)
    except KeyboardInterrupt as interrupt:
        tell_error(str(interrupt))
        code = 1
    slate.finished = 1 + code
    return code


if __name__ == "__main__":
    end_with(int(sys.argv[1]))
    sys.exit(work(int(sys.argv[2]), sys.argv[3], sys.argv[4:]))
