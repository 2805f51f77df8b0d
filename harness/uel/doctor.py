# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel doctor`: what this installation consists of, what of it works, and what to do about the rest."""

from __future__ import annotations

import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum
from importlib import import_module, metadata
from pathlib import Path
from typing import Final

from uel import data_files
from uel.errors import UelError
from uel.running import sanitizer

DISTRIBUTION: Final = "uel"
AGAIN: Final = "install it again: pip install . in the project's folder, or pip install with the wheel"
_EXTRA: Final = re.compile(r"""extra\s*==\s*['"]([\w.-]+)['"]""")
_NAME: Final = re.compile(r"[\w.-]+")
_LINES: Final = {
    ".f": "      subroutine uel\n      end\n",
    ".c": "void uel_(void)\n{}\n",
    ".cpp": 'extern "C"\nvoid uel_() {}\n',
}
"""Two lines in each language with an entry point of Abaqus, by the ending of the file."""

_NO_LIBRARY: Final = "cannot open shared object file"
_RUNTIME: Final = "apt install libgfortran5 libgomp1, dnf install libgfortran libgomp"
"""System packages of Fortran's libraries: user routines share these, and the units of files, with the host."""
_BEFORE: Final = {"python-mumps": "apt install libmumps-seq-dev libopenblas0-serial, and then "}
"""Commands to run before a package can be installed."""


class State(Enum):
    """State of a part of the installation."""

    WORKS = "ok"
    ABSENT = "absent"  # most uses do not need it
    BROKEN = "broken"


@dataclass(frozen=True, slots=True)
class Finding:
    """A part of the installation: what it is, what is known of it, and what to do where that does not work."""

    part: str
    state: State
    result: str
    advice: str = ""


def report(tell: Callable[[str], None]) -> bool:
    """Tell all findings, in lines that can be copied into a question; returns whether nothing is broken."""
    broken = []
    for finding in examine():
        tell(f"{finding.state.value:7} {finding.part}: {finding.result}")
        if finding.state is not State.WORKS:
            tell(f"{'':7} -> {finding.advice}")
        if finding.state is State.BROKEN:
            broken.append(finding.part)
    tell(f"broken: {', '.join(broken)}" if broken else "nothing is broken; what is absent is optional")
    return not broken


def examine() -> Iterator[Finding]:
    """Yield all findings, in the order in which a user needs them to be right."""
    yield _program()
    yield from _packages()
    try:
        # the parts below need these packages
        import uel.solver.linear  # noqa: PLC0415
        import uel.usersub  # noqa: F401, PLC0415
    except (ImportError, UelError) as error:
        advice = _RUNTIME if _NO_LIBRARY in str(error) else AGAIN
        yield Finding("compiled host", State.BROKEN, str(error), advice)
        return
    yield _own_elements()
    yield _decks()
    yield from _compilers()
    yield _run_time_checks()
    yield _cache()
    yield from _solvers()
    yield from _extras()


def release() -> str:
    """Return the version of this program; '' where it is not installed as a package."""
    try:
        return metadata.version(DISTRIBUTION)
    except metadata.PackageNotFoundError:
        return ""


def _program() -> Finding:
    system = f"Python {platform.python_version()} ({sys.executable}), {platform.system()} {platform.machine()}"
    cores = f"{len(os.sched_getaffinity(0))} cores"
    if version := release():
        return Finding("uel", State.WORKS, f"{version}, {system}, {cores}")
    return Finding("uel", State.BROKEN, f"not installed as a package; {system}", AGAIN)


def _required() -> list[tuple[str, str]]:
    """List the packages that the metadata name, each with its extra; '' for indispensable ones."""
    try:
        lines = metadata.requires(DISTRIBUTION) or []
    except metadata.PackageNotFoundError:
        return []
    names = [match[0] for match in map(_NAME.match, lines) if match]
    extras = [match[1] if match else "" for match in map(_EXTRA.search, lines)]
    return list(zip(names, extras, strict=True))


def _packages() -> Iterator[Finding]:
    for name, extra in _required():
        if extra:
            continue
        try:
            import_module(name.replace("-", "_"))
            yield Finding(name, State.WORKS, metadata.version(name))
        except (ImportError, metadata.PackageNotFoundError) as error:
            yield Finding(name, State.BROKEN, str(error), f"pip install --force-reinstall {name}")


def _own_elements() -> Finding:
    part = "the project's elements"
    try:
        entries = _entry_points([])
    except (UelError, OSError) as error:
        advice = "set TMPDIR to a folder that can be written and from which libraries are loaded (not mounted noexec)"
        return Finding(part, State.BROKEN, str(error), advice)
    return Finding(part, State.WORKS, f"{', '.join(entries)}; they need no compiler")


def _decks() -> Finding:
    part = "decks and manual"
    if (data_files.FOLDER / "abaqus_inputs").is_dir():
        return Finding(part, State.WORKS, str(data_files.FOLDER))
    return Finding(part, State.ABSENT, f"not in {data_files.FOLDER}", AGAIN)


def _entry_points(lines: list[tuple[str, str]]) -> tuple[str, ...]:
    """Compile files with these endings and texts, load the library and return its user routines."""
    from uel.usersub import load  # noqa: PLC0415

    with tempfile.TemporaryDirectory() as folder:
        files = []
        for suffix, text in lines:
            file = Path(folder) / f"two_lines{suffix}"
            file.write_text(text)
            # a file that is newer than its library is never cached, so that the compiler works each time
            os.utime(file, (time.time() + 3600.0,) * 2)
            files.append(file)
        library = load(files, job="doctor", output_dir=Path(folder))
        library.close()
    return library.entry_points


def _compilers() -> Iterator[Finding]:
    from uel.usersub.compilation.languages import LANGUAGES  # noqa: PLC0415

    for language in LANGUAGES:
        purpose = f"--user with {', '.join(language.suffixes)}"
        program = shutil.which(language.compiler)
        if program is None:
            yield Finding(language.compiler, State.ABSENT, f"not found; {purpose} needs it", language.install)
            continue
        asked = subprocess.run([program, "-dumpfullversion"], capture_output=True, text=True, check=False)
        version = f"{asked.stdout.strip()} ({program})"
        try:
            _entry_points([(language.suffixes[0], _LINES[language.suffixes[0]])])
            yield Finding(language.compiler, State.WORKS, f"{version} compiles, and the result loads")
        except (UelError, OSError) as error:
            result = f"{version}: two lines do not compile or load: {' '.join(str(error).split())}"
            yield Finding(language.compiler, State.BROKEN, result, f"{language.install}; {purpose} needs it")


def _run_time_checks() -> Finding:
    try:
        sanitizer.environment()
    except sanitizer.NoSanitizerError as error:
        return Finding("AddressSanitizer", State.ABSENT, str(error), "uel run --debug works without it")
    return Finding("AddressSanitizer", State.WORKS, "starts, for uel run --debug")


def _cache() -> Finding:
    from uel.usersub.compilation.cache import cache_folder  # noqa: PLC0415

    part, folder = "cache of compiled files", cache_folder()
    if folder is not None:
        try:
            with tempfile.TemporaryFile(dir=folder):
                return Finding(part, State.WORKS, str(folder))
        except OSError:
            pass
    result = f"{folder or 'none'} (cannot be written, or others can write there): each run compiles again"
    return Finding(part, State.ABSENT, result, "set XDG_CACHE_HOME to a folder of your own")


def _solvers() -> Iterator[Finding]:
    from uel.solver.linear.choice import SOLVERS, available  # noqa: PLC0415

    for row in available():
        part, distribution = f"linear solver {row.name}", SOLVERS[row.name].distribution
        if row.installed:
            yield Finding(part, State.WORKS, f"{distribution} {row.version}")
        else:
            yield Finding(part, State.ABSENT, row.note, f"{_BEFORE.get(distribution, '')}pip install {distribution}")


def _extras() -> Iterator[Finding]:
    """Look for optional packages, except linear solvers."""
    from uel.solver.linear.choice import SOLVERS  # noqa: PLC0415

    solvers = {solver.distribution for solver in SOLVERS.values()}
    for name, extra in _required():
        if extra and name not in solvers:
            try:
                yield Finding(name, State.WORKS, metadata.version(name))
            except metadata.PackageNotFoundError:
                yield Finding(name, State.ABSENT, f"not installed; the extra [{extra}] has it", f"pip install {name}")
