# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Languages of user routines: which compiler takes a file, and with which flags."""

from __future__ import annotations

import re
import shutil
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from uel.errors import CompileError


@dataclass(frozen=True)
class Language:
    """A language: endings of its files in lower case, its compiler, flags, and how to get and to link it.

    checks   flags of a debug build: run-time checks, and conspicuous values in uninitialised variables
    zeros    flag with which uninitialised local variables are zero, not what an earlier call has left
    warnings flags with which the compiler reports what it suspects
    runtime  libraries that the objects need if another language's compiler links them
    """

    suffixes: tuple[str, ...]
    compiler: str
    flags: tuple[str, ...]
    checks: tuple[str, ...]
    zeros: str
    warnings: tuple[str, ...]
    install: str
    runtime: tuple[str, ...]

    def program(self, file: Path) -> str:
        """Return the path of the compiler; CompileError, with how to get it, where it is missing."""
        path = shutil.which(self.compiler)
        if path is None:
            message = f"compiling it needs {self.compiler}, which is not installed ({self.install})"
            raise CompileError(file, message)
        return path


# -g1: messages about the end of a call give its line
_COMMON: Final = ("-c", "-O2", "-g1", "-fPIC", "-ffp-contract=off", "-fdiagnostics-color=never")
SILENT: Final = "-w"
"""Flag of all compilers: no warnings."""
_DEBUG: Final = ("-g", "-Og", "-fno-omit-frame-pointer", "-fsignaling-nans")
_C_DEBUG: Final = (
    *_DEBUG,
    "-ftrivial-auto-var-init=pattern",
    # a finding is a trap in the code, which needs no library
    *("-fsanitize=bounds,null,vla-bound", "-fsanitize-undefined-trap-on-error"),
)
_C_ZEROS: Final = "-ftrivial-auto-var-init=zero"
_WARNINGS: Final = ("-Wall", "-Wextra", "-Wno-unused-variable", "-Wno-unused-function", "-Wno-unused-but-set-variable")
_C_WARNINGS: Final = (*_WARNINGS, "-Wno-unused-parameter", "-Wno-sign-compare", "-Wno-misleading-indentation")
FORTRAN: Final = Language(
    (".f", ".for", ".f90"),
    "gfortran",
    (
        *_COMMON,
        *("-cpp", "-std=legacy", "-fdec", "-fno-range-check"),
        # locals on the stack and not kept from call to call, as with Abaqus' -auto; automatic arrays too: on the heap,
        # a write beyond one ends the process later on
        *("-frecursive", "-fstack-arrays"),
    ),
    (
        *_DEBUG,
        # not recursion: the mark of a procedure left through XIT would stay
        "-fcheck=bounds,do,mem,pointer,bits",
        *("-finit-real=snan", "-finit-integer=-1431655766", "-finit-logical=true", "-finit-derived"),
    ),
    "-finit-local-zero",
    (
        *_WARNINGS,
        # argument lists are Abaqus'; the rest is style
        *("-Wno-unused-dummy-argument", "-Wno-unused-parameter", "-Wno-unused-label", "-Wno-tabs"),
        *("-Wno-compare-reals", "-Wno-missing-include-dirs", "-Wconversion-extra", "-fmax-errors=0"),
    ),
    "apt install gfortran, dnf install gcc-gfortran",
    ("-lgfortran",),
)
SANITIZED: Final = (
    *("-fsanitize=address", "-fsanitize-recover=address"),
    # always inline, with functions that fortran/host/guards/sanitizer.c replaces
    "--param=asan-instrumentation-with-call-threshold=2000000000",
)
"""Flags of all compilers for a debug build with AddressSanitizer."""
C: Final = Language(
    (".c",), "gcc", (*_COMMON, "-x", "c"), _C_DEBUG, _C_ZEROS, _C_WARNINGS, "apt install gcc, dnf install gcc", ()
)
CPP: Final = Language(
    (".cpp", ".cc", ".cxx"),
    "g++",
    (*_COMMON, "-x", "c++"),
    _C_DEBUG,
    _C_ZEROS,
    _C_WARNINGS,
    "apt install g++, dnf install gcc-c++",
    ("-lstdc++",),
)
LANGUAGES: Final = (FORTRAN, C, CPP)
SUFFIXES: Final = tuple(suffix for language in LANGUAGES for suffix in language.suffixes)

FIXED: Final = ("-ffixed-form", "-ffixed-line-length-132")
FREE: Final = ("-ffree-form", "-ffree-line-length-none")
_FREEFORM = re.compile(r"^(?:[cC*]|[ \t]*!)(?:DIR|DEC)\$\s*FREEFORM", re.IGNORECASE | re.MULTILINE)
_ENVIRONMENT: Final = "abaqus_v6.env"
_ENVIRONMENT_FREE = re.compile(
    r"^[ \t]*compile_fortran\s*=(?:(?!^\s*\w+\s*=).)*?[\s'\"](?:[-/]free|-ffree-form)\b", re.DOTALL | re.MULTILINE
)


def is_source(file: Path) -> bool:
    """Return whether a file of user routines needs compiling.

    Parameters
    ----------
    file
        Judged by its ending, one of SUFFIXES in any case; it need not exist.
    """
    return file.suffix.lower() in SUFFIXES


def language_of(file: Path) -> Language:
    """Return the language of a file by its ending, which is one of SUFFIXES in any case."""
    return next(language for language in LANGUAGES if file.suffix.lower() in language.suffixes)


def linking(languages: Collection[Language]) -> tuple[Language, list[str]]:
    """Return the language whose compiler links objects of these languages, and the libraries that the others need."""
    used = [language for language in LANGUAGES if language in languages]
    return used[0], [flag for language in used[1:] for flag in language.runtime]


def is_free_form(file: Path, text: str) -> bool:
    """Report free form: .f90, an Intel directive in the text that declares it, or Abaqus' environment file.

    That is the one beside the file, if its compile_fortran has the option -free.
    """
    if file.suffix.lower() == ".f90" or _FREEFORM.search(text):
        return True
    environment = file.resolve().parent / _ENVIRONMENT
    if not environment.is_file():
        return False
    lines = environment.read_text(encoding="latin-1").splitlines()
    return bool(_ENVIRONMENT_FREE.search("\n".join(line.partition("#")[0] for line in lines)))
