# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""AddressSanitizer for debug builds of user files: a process that loads its runtime before all else."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from uel.errors import UelError

_COMPILERS: Final = ("gfortran", "gcc")
_LIBRARY: Final = "libasan.so"
_PRELOAD: Final = "LD_PRELOAD"
_OPTIONS: Final = "ASAN_OPTIONS"

_SETTINGS: Final = (
    # the process continues after a finding, which ends the call (fortran/host/guards/sanitizer.c), and each one counts
    *("halt_on_error=0", "suppress_equal_pcs=0", "detect_leaks=0"),
    # signals are the host's (fortran/host/guards/protect.c)
    *("handle_segv=0", "handle_sigbus=0", "handle_abort=0", "handle_sigill=0", "handle_sigfpe=0", "use_sigaltstack=0"),
    # a library is loaded once for each job of the process, and Python's own libraries are not under test
    *("detect_odr_violation=0", "alloc_dealloc_mismatch=0", "allocator_may_return_null=1"),
    # nobody reads where memory was allocated, and recording it takes most of the time
    *("symbolize=0", "malloc_context_size=0", "quarantine_size_mb=16"),
)

NOT_USED: Final = (
    "without AddressSanitizer, which detects reads and writes outside arrays of unknown size (props(*)) and the use "
    "of freed memory: {reason}"
)
_MISSING: Final = "{compiler} has no libasan (apt install gcc, dnf install libasan)"


class NoSanitizerError(UelError):
    """AddressSanitizer cannot be used here; the message says why."""


def applies_to(user: Sequence[Path]) -> bool:
    """Report whether any of the user's files is to be compiled."""
    return any(file.suffix.lower() != ".so" for file in user)


def environment() -> Mapping[str, str]:
    """Return the environment of a process with the runtime of the installed compiler. Raises NoSanitizerError."""
    preload = ":".join(filter(None, (str(_runtime()), os.environ.get(_PRELOAD))))
    settings = ":".join(filter(None, (*_SETTINGS, os.environ.get(_OPTIONS))))
    variables = os.environ | {_PRELOAD: preload, _OPTIONS: settings}
    # under a memory limit or with another memory layout the runtime ends the process or does not load
    trial = [sys.executable, "-S", "-c", "import ctypes; ctypes.CDLL(None).__asan_init"]
    tried = subprocess.run(trial, env=variables, capture_output=True, text=True, errors="replace", check=False)
    if tried.returncode or tried.stderr:
        said = (tried.stderr.strip() or f"exit code {tried.returncode}").splitlines()
        raise NoSanitizerError(NOT_USED.format(reason=f"it does not start here ({said[0].strip('= ')})"))
    return variables


def stop_preloading() -> None:
    """Remove the runtime from LD_PRELOAD: processes that this one starts, such as compilers, do not need it."""
    first, _, others = os.environ.get(_PRELOAD, "").partition(":")
    if _LIBRARY in Path(first).name:
        del os.environ[_PRELOAD]
        if others:
            os.environ[_PRELOAD] = others


def _runtime() -> Path:
    """Find the shared library of the runtime."""
    compiler = next(filter(None, map(shutil.which, _COMPILERS)), "")
    asked = [compiler, f"-print-file-name={_LIBRARY}"]
    answer = subprocess.run(asked, capture_output=True, text=True, check=False).stdout.strip() if compiler else ""
    file = Path(answer)
    if file.is_absolute() and file.is_file():
        with file.open("rb") as stream:
            begin = stream.read(1000)
        # some systems have a linker script here, which names the library
        named = re.search(rb"/[^\s()]+", begin)
        if begin.startswith(b"\x7fELF"):
            return file.resolve()
        if named:
            return Path(os.fsdecode(named[0]))
    raise NoSanitizerError(NOT_USED.format(reason=_MISSING.format(compiler=Path(compiler or _COMPILERS[0]).name)))
