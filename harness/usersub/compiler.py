# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compile a user's files as Abaqus does, once: results are kept in the user's cache folder."""

from __future__ import annotations

import hashlib
import os
import platform
import re
import subprocess
import tempfile
import time
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Final

from harness.errors import CompileError
from harness.files import read_whole
from harness.usersub import cache, linker, mending
from harness.usersub.cache import Built
from harness.usersub.diagnostics import first_error
from harness.usersub.headers import HEADERS
from harness.usersub.languages import FIXED, FORTRAN, FREE, LANGUAGES, ZERO_LOCALS, is_free_form, language_of, linking
from harness.usersub.mending import Repair, hidden_types, repairs

_SEARCH_VARIABLES: Final = (
    *("CPATH", "C_INCLUDE_PATH", "CPLUS_INCLUDE_PATH", "LIBRARY_PATH", "COMPILER_PATH", "GCC_EXEC_PREFIX"),
)
"""What changes where compilers look for files."""
_INCLUDE = re.compile(r"^\s*#?\s*include\s*['\"<]([^'\">]+)['\">]", re.IGNORECASE | re.MULTILINE)


def build(files: Sequence[Path], include: Sequence[Path] = (), *, zero_locals: bool = False) -> Built:
    """Shared library of the files, compiled in their order; include: folders besides the sources' own.

    zero_locals: local variables of Fortran that are given no value are zero. Raises CompileError with the compiler's
    first error.
    """
    began = time.time()
    compilers = {language_of(file): language_of(file).program(file) for file in files}
    folders = list(dict.fromkeys([*(f.resolve().parent for f in files), *(p.resolve() for p in include)]))
    headers, texts, sources = _scan(files, folders)
    flags = (ZERO_LOCALS,) if zero_locals else ()
    forms = [str(is_free_form(file, _read(file))) for file in files]
    name = f"{files[0].stem}-{_key(compilers.values(), [*flags, *forms, *texts])}"
    found = cache.find(name, folders)
    if found is not None:
        return found
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        library, notes = _compile(files, folders, headers, sources, work, flags)
        read = {Path(name) for rule in work.glob("*.d") for name in cache.dependencies(_read(rule))}
        # copies in the compiler's folder stand for files that are known
        read = {file for file in read if not (work / file).is_relative_to(work)}
        if any(file.stat().st_mtime > began for file in read):
            # nobody knows what the compiler has seen of a file that was changed meanwhile
            return cache.keep_for_now(name, library, notes)
        known = {file.resolve() for paths in sources.values() for file in paths}
        return cache.keep(name, library, notes, [file for file in read if file.resolve() not in known], folders)


def _read(file: Path) -> str:
    try:
        text = read_whole(file).decode("latin-1")
    except OSError as error:
        raise CompileError(file, f"cannot be read: {error.strerror}") from None
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _key(compilers: Iterable[str], texts: Sequence[str]) -> str:
    """What a result depends on as far as it is known before compiling, hashed."""
    versions = [
        subprocess.run([compiler, "-dumpfullversion"], capture_output=True, text=True, check=False).stdout
        for compiler in compilers
    ]
    flags = [*FIXED, *FREE, *linker.FLAGS, *(flag for language in LANGUAGES for flag in language.flags)]
    found_through = [f"{name}={os.environ.get(name)}" for name in _SEARCH_VARIABLES]
    repairs_text = _read(Path(mending.__file__))
    machine = [platform.machine(), linker.bundled_lapack(), *found_through]
    parts = [*versions, *flags, *machine, repairs_text, *HEADERS.values(), *texts]
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:16]


def _scan(
    files: Sequence[Path], folders: Sequence[Path]
) -> tuple[dict[str, str | Path], list[str], dict[str, list[Path]]]:
    """Follow INCLUDE lines.

    Returns the files to supply by the name that a line uses (Abaqus' headers; files whose name differs in case, as
    they may where a source comes from Windows), all texts that the result depends on, and the files by bare name.
    """
    supply: dict[str, str | Path] = {}
    texts: list[str] = []
    seen: set[Path] = set()
    pending = list(files)
    while pending:
        file = pending.pop()
        if file.resolve() in seen:
            continue
        seen.add(file.resolve())
        text = _read(file)
        texts += [file.name, text]
        for name in _INCLUDE.findall(text):
            found = next(_matches(name, [file.resolve().parent, *folders]), None)
            if found is None:
                _refuse_devices(file, name, [file.resolve().parent, *folders])
            header = HEADERS.get(name.replace("\\", "/").rpartition("/")[2].lower())
            if found is not None:
                pending.append(found)
            # an absolute name is where it says or nowhere, and what is there belongs to the user
            given = None if Path(name).is_absolute() else found or header
            if given is not None:
                supply[name] = given
    named: dict[str, list[Path]] = {}
    for file in sorted(seen):
        named.setdefault(file.name, []).append(file)
    return supply, texts, named


def _refuse_devices(file: Path, name: str, folders: Sequence[Path]) -> None:
    """The compiler would wait for a pipe, and never come to the end of some devices."""
    for folder in folders:
        if (folder / name).exists() and not (folder / name).is_dir():
            raise CompileError(file, f"includes {name}, which is not a file")


def _matches(name: str, folders: Sequence[Path]) -> Iterator[Path]:
    """Files of that name, which may have folders in it; whatever its case."""
    for folder in folders:
        if (folder / name).is_file():
            yield folder / name
    parts = [part for part in name.lower().replace("\\", "/").split("/") if part not in ("", ".")]
    for folder in folders:
        found = [folder]
        for part in parts:
            within = [entry for entry in found if entry.is_dir()]
            found = [entry / ".." for entry in within] if part == ".." else [p for e in within for p in _named(e, part)]
        yield from (entry for entry in found if entry.is_file())


def _named(folder: Path, name: str) -> list[Path]:
    """What a folder holds of that name, given in lower case."""
    return [entry for entry in sorted(folder.iterdir()) if entry.name.lower() == name]


def _compile(
    files: Sequence[Path],
    folders: Sequence[Path],
    supply: dict[str, str | Path],
    sources: dict[str, list[Path]],
    work: Path,
    flags: Sequence[str],
) -> tuple[Path, list[str]]:
    """Library in the folder work, and what was changed to compile it; beside it the compilers list what they read."""
    # deep enough for names that go upwards to stay within
    upwards = max((name.count("..") for name in supply), default=0)
    headers = work.joinpath("include", *["below"] * upwards)
    headers.mkdir(parents=True)
    for name, content in supply.items():
        path = headers / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content if isinstance(content, str) else _read(content), encoding="latin-1")
    search = [f"-I{folder}" for folder in (*folders, headers)]
    objects: list[Path] = []
    notes: list[str] = []
    for number, file in enumerate(files):
        language = language_of(file)
        output = work / f"{number}.o"
        command = [language.compiler, *language.flags, *search, "-o", str(output), "-MD", "-MF", f"{number}.d"]
        if language is FORTRAN:
            command += [*(FREE if is_free_form(file, _read(file)) else FIXED), *flags, f"-J{work}"]
        notes += _compile_one(command, file, sources, work / f"mended{number}")
        objects.append(output)
    library = work / "user.so"
    language, libraries = linking([language_of(file) for file in files])
    libraries += linker.lapack_flags(objects, language.compiler)
    errors = _errors([language.compiler, *linker.FLAGS, *map(str, objects), *libraries, "-o", str(library)], work)
    if errors is not None:
        raise CompileError(files[0], first_error(errors, {}))
    return library, notes


def _compile_one(command: Sequence[str], file: Path, sources: dict[str, list[Path]], folder: Path) -> list[str]:
    """Compile a file; what gfortran refuses of Abaqus' compiler is mended in copies in the folder. Returns what was.

    The compiler runs beside the folder: it takes module files of the current folder before those just made.
    """
    copies: dict[str, str] = {}
    notes: list[str] = []
    if language_of(file) is FORTRAN:
        for repair in hidden_types(_read(file), file.name):
            _mend(repair, sources, copies, notes)
        _write(copies, folder)
    while True:
        source = folder / file.name if copies else file.resolve()
        errors = _errors([*command, f"-I{folder}", str(source)], folder.parent)
        if errors is None:
            return notes
        changed = [_mend(repair, sources, copies, notes) for repair in repairs(errors)]
        if not any(changed):
            texts = {name: _read(paths[0]) for name, paths in sources.items()}
            raise CompileError(file, first_error(errors, texts))
        copies.setdefault(file.name, _read(file))
        _write(copies, folder)


def _mend(repair: Repair, sources: dict[str, list[Path]], copies: dict[str, str], notes: list[str]) -> bool:
    """Change the copy of a file, which is made where there is none; whether that could be done."""
    if len(sources.get(repair.file, [])) != 1:
        return False
    mended = repair.apply(copies.get(repair.file) or _read(sources[repair.file][0]))
    if mended is None:
        return False
    copies[repair.file] = mended
    notes.append(f"{repair.file}, line {repair.line}: {repair.note}")
    return True


def _write(copies: dict[str, str], folder: Path) -> None:
    """Put copies into their folder."""
    if copies:
        folder.mkdir(exist_ok=True)
    for name, text in copies.items():
        (folder / name).write_text(text, encoding="latin-1")


def _errors(command: Sequence[str], folder: Path) -> str | None:
    """What the compiler says, run in a folder; None if it is content."""
    result = subprocess.run(
        command,
        cwd=folder,
        capture_output=True,
        text=True,
        errors="replace",
        env=os.environ | {"LC_ALL": "C"},
        check=False,
    )
    return result.stderr if result.returncode else None
