# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Link a user's objects, with LAPACK if they need it; STOP and errors of libgfortran become an end of the call."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Final

_STOPS: Final = ("stop_string", "stop_numeric", "error_stop_string", "error_stop_numeric", "exit_i4")
_ERRORS: Final = ("runtime_error_at", "runtime_error", "os_error_at")

_FINDINGS: Final = [f"{verb}{size}" for verb in ("load", "store") for size in ("1", "2", "4", "8", "16", "_n")]

FLAGS: Final = (
    "-shared",
    "-Wl,-Bsymbolic",
    # they end the process; the host's versions end the call (fortran/host/guards/stops.c, runtime_errors.c)
    *(f"-Wl,--wrap=_gfortran_{name}" for name in (*_STOPS, *_ERRORS)),
    # so does what AddressSanitizer finds (sanitizer.c)
    *(f"-Wl,--wrap=__asan_report_{finding}_noabort" for finding in _FINDINGS),
    # and so does exit in C
    *(f"-Wl,--wrap={name}" for name in ("exit", "_exit", "_Exit", "quick_exit")),
)

_PREFIX: Final = "scipy_"
"""Prefix of scipy's OpenBLAS before each name."""


def lapack_flags(objects: Sequence[Path], compiler: str) -> list[str]:
    """Return the flags with which this compiler links the objects, which use plain names, with LAPACK and BLAS.

    The system's libraries are used if they exist, else the OpenBLAS in scipy's wheel, whose names have a prefix:
    the references in the objects are then renamed.
    """
    undefined = {name for file in objects for name in _symbols("-u", file)}
    bundled = _bundled_openblas()
    if bundled is None:
        return _system_lapack(compiler) if undefined & {f"{routine}_" for routine in _COMMON} else []
    offered = {name.removeprefix(_PREFIX) for name in _symbols("-D", bundled) if name.startswith(_PREFIX)}
    needed = sorted(undefined & offered)
    if not needed:
        return []
    if system := _system_lapack(compiler):
        return system
    renames = [f"--redefine-sym={name}={_PREFIX}{name}" for name in needed]
    for file in objects:
        subprocess.run(["objcopy", *renames, str(file)], check=True)
    return [str(bundled), f"-Wl,-rpath,{bundled.parent}"]


_COMMON: Final = (
    *("dgesv", "dgetrf", "dgetri", "dgetrs", "dgemm", "dgemv", "dsyev", "dgeev", "dgesvd", "dposv", "dpotrf"),
)
"""Routines that indicate the use of LAPACK if no list of its names is available."""


def _system_lapack(compiler: str) -> list[str]:
    for flags in (["-llapack", "-lblas"], ["-lopenblas"]):
        command = [compiler, "-shared", "-o", "/dev/null", *flags]
        if subprocess.run(command, capture_output=True, check=False).returncode == 0:
            return flags
    return []


def _bundled_openblas() -> Path | None:
    spec = find_spec("scipy")
    if spec is None or spec.origin is None:
        return None
    folder = Path(spec.origin).parent.parent / "scipy.libs"
    return next(iter(sorted(folder.glob("libscipy_openblas-*"))), None)


def bundled_lapack() -> str:
    """Return the path of the library that replaces the system's LAPACK if there is none; '' without one."""
    return str(_bundled_openblas() or "")


def _symbols(option: str, file: Path) -> Iterator[str]:
    output = subprocess.run(["nm", option, str(file)], capture_output=True, text=True, check=False).stdout
    yield from re.findall(r"(\w+)$", output, re.MULTILINE)


def undefined_routine(message: str) -> str:
    """Return the message of the dynamic linker in terms of the user."""
    match = re.search(r"undefined symbol: (\w+)", message)
    if match is None:
        return f"cannot be loaded: {message}"
    name = match[1].removesuffix("_").upper()
    return f"refers to {name}, which neither the file nor Abaqus' utility routines define"
