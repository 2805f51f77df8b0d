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
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from uel.errors import CompileError
from uel.files import read_whole
from uel.usersub.compilation import argument_ranks, cache, linker
from uel.usersub.compilation.cache import Built
from uel.usersub.compilation.compatibility import Repair, hidden_types, repairs
from uel.usersub.compilation.diagnostics import first_error
from uel.usersub.compilation.headers import HEADERS
from uel.usersub.compilation.languages import (
    FIXED,
    FORTRAN,
    FREE,
    LANGUAGES,
    SANITIZED,
    SILENT,
    Language,
    is_free_form,
    language_of,
    linking,
)
from uel.usersub.compilation.units import with_open_bounds, without_implicit

_SEARCH_VARIABLES: Final = (
    *("CPATH", "C_INCLUDE_PATH", "CPLUS_INCLUDE_PATH", "LIBRARY_PATH", "COMPILER_PATH", "GCC_EXEC_PREFIX"),
)
"""Environment variables that change where compilers look for files."""
_INCLUDE = re.compile(r"^\s*#?\s*include\s*['\"<]([^'\">]+)['\">]", re.IGNORECASE | re.MULTILINE)
_ASSUMED_SIZE: Final = re.compile(r"assumed[- ]size array '(\w+)'", re.IGNORECASE)
_EXTENSION: Final = "an extension of Abaqus' compiler, written in standard Fortran in a copy"

Flags = Mapping[Language, tuple[str, ...]]
"""Flags of every compiler, besides those of its language."""


def build(
    files: Sequence[Path],
    include: Sequence[Path] = (),
    *,
    zero_locals: bool = False,
    debug: bool = False,
    sanitized: bool = False,
) -> Built:
    """Compile the files, in this order, to a shared library; include: folders besides those of the sources.

    zero_locals: uninitialised local variables of Fortran are zero. debug: with run-time checks, and NaN in such
    variables unless they are zero; sanitized: also with AddressSanitizer. Raises CompileError with the compiler's
    first error.
    """
    began = time.time()
    compilers = {language_of(file): language_of(file).program(file) for file in files}
    folders = _folders(files, include)
    headers, texts, sources = _scan(files, folders)
    flags = {language: _flags(language, zero_locals, debug, sanitized) for language in LANGUAGES}
    forms = [str(is_free_form(file, _read(file))) for file in files]
    options = [flag for more in flags.values() for flag in more]
    name = f"{files[0].stem}-{_key(compilers.values(), [*options, *forms, *texts])}"
    cached = cache.find(name, folders)
    if cached is not None:
        return cached
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        library, notes = _compile(files, folders, headers, sources, work, flags, open_bounds=debug)
        read = {Path(name) for rule in work.glob("*.d") for name in cache.dependencies(_read(rule))}
        # copies in the compiler's folder stand for known files
        read = {file for file in read if not (work / file).is_relative_to(work)}
        if any(file.stat().st_mtime > began for file in read):
            # nobody knows which version of a file the compiler saw if it was changed meanwhile
            return cache.keep_for_now(name, library, notes)
        source_files = {file.resolve() for paths in sources.values() for file in paths}
        return cache.keep(name, library, notes, [file for file in read if file.resolve() not in source_files], folders)


def digest_of_sources(files: Sequence[Path], include: Sequence[Path] = ()) -> str:
    """Return the digest of the files and their INCLUDEs, the same on any machine; arguments as for `build`."""
    _, texts, _ = _scan(files, _folders(files, include))
    return hashlib.sha256("\0".join(texts).encode()).hexdigest()


def _flags(language: Language, zero_locals: bool, debug: bool, sanitized: bool) -> tuple[str, ...]:
    """Return the additional flags of the compiler of a language."""
    checks = (*language.checks, *(SANITIZED if sanitized else ())) if debug else ()
    # C without checks leaves memory as it is, as its compiler does for Abaqus
    zeros = (language.zeros,) if zero_locals and (debug or language is FORTRAN) else ()
    # gfortran reports constants passed for arrays although no warnings are requested
    return (*checks, *zeros, *(() if language is FORTRAN else (SILENT,)))


@dataclass(frozen=True, slots=True)
class Opinion:
    """Opinion of the compilers on files that compile.

    warnings    their text
    undeclared  gfortran's text when no name gets a type from its first letter
    texts       of all files read, by bare name
    free        bare names of those in free form
    """

    warnings: str
    undeclared: str
    texts: Mapping[str, str]
    free: frozenset[str]


def listen(files: Sequence[Path], include: Sequence[Path] = ()) -> Opinion:
    """Compile files as `build` does, with all warnings, and discard the result. Raises CompileError."""
    folders = _folders(files, include)
    supply, _, sources = _scan(files, folders)
    free = frozenset(file.name for file in files if is_free_form(file, _read(file)))
    with tempfile.TemporaryDirectory() as work:
        flags = {language: language.warnings for language in LANGUAGES}
        _, _, warnings = _objects(files, folders, supply, sources, Path(work), flags)
        undeclared = _without_implicit_types(files, folders, supply, Path(work))
    texts = _texts(sources)
    return Opinion(warnings, undeclared, texts, free)


def _without_implicit_types(
    files: Sequence[Path], folders: Sequence[Path], supply: Mapping[str, str | Path], work: Path
) -> str:
    """Return gfortran's messages on copies without IMPLICIT statements; work has the module files."""
    copies, texts = _supplied(supply, work / "declared")
    for path, text in texts.items():
        path.write_text(without_implicit(text, free=path.suffix.lower() == ".f90"), encoding="latin-1")
    messages = ""
    for file in files:
        if language_of(file) is FORTRAN:
            text = _read(file)
            free = is_free_form(file, text)
            (copies / file.name).write_text(without_implicit(text, free=free), encoding="latin-1")
            search = [f"-I{folder}" for folder in (copies, *folders, work)]
            options = ("-fsyntax-only", "-fimplicit-none", "-fmax-errors=0", f"-J{copies}", SILENT)
            command = [FORTRAN.compiler, *FORTRAN.flags, *(FREE if free else FIXED), *options, *search, file.name]
            messages += _run(command, copies).stderr
    return messages


def _folders(files: Sequence[Path], include: Sequence[Path]) -> list[Path]:
    return list(dict.fromkeys([*(f.resolve().parent for f in files), *(p.resolve() for p in include)]))


def _read(file: Path) -> str:
    try:
        text = read_whole(file).decode("latin-1")
    except OSError as error:
        raise CompileError(file, f"cannot be read: {error.strerror}") from None
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _texts(sources: Mapping[str, Sequence[Path]]) -> dict[str, str]:
    """Return the texts of files by bare name."""
    return {name: _read(paths[0]) for name, paths in sources.items()}


def _key(compilers: Iterable[str], texts: Sequence[str]) -> str:
    """Hash what a result depends on, as far as that is known before compiling."""
    versions = [
        subprocess.run([compiler, "-dumpfullversion"], capture_output=True, text=True, check=False).stdout
        for compiler in compilers
    ]
    flags = [*FIXED, *FREE, *linker.FLAGS, *(flag for language in LANGUAGES for flag in language.flags)]
    search = [f"{name}={os.environ.get(name)}" for name in _SEARCH_VARIABLES]
    rules = [
        _read(Path(__file__).with_name(name)) for name in ("compatibility.py", "argument_ranks.py", "diagnostics.py")
    ]
    machine = [platform.machine(), linker.bundled_lapack(), *search]
    content = [*versions, *flags, *machine, *rules, *HEADERS.values(), *texts]
    return hashlib.sha256("\0".join(content).encode()).hexdigest()[:16]


def _scan(
    files: Sequence[Path], folders: Sequence[Path]
) -> tuple[dict[str, str | Path], list[str], dict[str, list[Path]]]:
    """Follow INCLUDE lines.

    Returns the files to supply by the name that a line uses (Abaqus' headers; files whose name differs in case, as
    in sources from Windows), all texts that the result depends on, and the files by bare name.
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
            included = next(_matches(name, [file.resolve().parent, *folders]), None)
            if included is None:
                _refuse_devices(file, name, [file.resolve().parent, *folders])
            header = HEADERS.get(name.replace("\\", "/").rpartition("/")[2].lower())
            if included is not None:
                pending.append(included)
            # an absolute name needs no search, and the file is the user's
            supplied = None if Path(name).is_absolute() else included or header
            if supplied is not None:
                supply[name] = supplied
    named: dict[str, list[Path]] = {}
    for file in sorted(seen):
        named.setdefault(file.name, []).append(file)
    return supply, texts, named


def _refuse_devices(file: Path, name: str, folders: Sequence[Path]) -> None:
    """Refuse what is not a file: the compiler would wait for a pipe, and read some devices without end."""
    for folder in folders:
        if (folder / name).exists() and not (folder / name).is_dir():
            raise CompileError(file, f"includes {name}, which is not a file")


def _matches(name: str, folders: Sequence[Path]) -> Iterator[Path]:
    """Yield the files of that name, which may include folders, in any case."""
    for folder in folders:
        if (folder / name).is_file():
            yield folder / name
    parts = [part for part in name.lower().replace("\\", "/").split("/") if part not in ("", ".")]
    for folder in folders:
        entries = [folder]
        for part in parts:
            within = [entry for entry in entries if entry.is_dir()]
            entries = (
                [entry / ".." for entry in within] if part == ".." else [p for e in within for p in _named(e, part)]
            )
        yield from (entry for entry in entries if entry.is_file())


def _named(folder: Path, name: str) -> list[Path]:
    """Return the entries of a folder with that name, given in lower case."""
    return [entry for entry in sorted(folder.iterdir()) if entry.name.lower() == name]


def _compile(
    files: Sequence[Path],
    folders: Sequence[Path],
    supply: dict[str, str | Path],
    sources: dict[str, list[Path]],
    work: Path,
    flags: Flags,
    *,
    open_bounds: bool,
) -> tuple[Path, list[str]]:
    """Build the library in the folder work, with notes for the user; the compilers list beside it what they read."""
    objects, notes, messages = _objects(files, folders, supply, sources, work, flags, open_bounds=open_bounds)
    notes += dict.fromkeys(argument_ranks.constants_for_arrays(messages, _texts(sources)))
    library = work / "user.so"
    language, libraries = linking([language_of(file) for file in files])
    libraries += linker.lapack_flags(objects, language.compiler)
    linked = _run([language.compiler, *linker.FLAGS, *map(str, objects), *libraries, "-o", str(library)], work)
    if linked.returncode:
        raise CompileError(files[0], first_error(linked.stderr, {}))
    return library, notes


def _objects(
    files: Sequence[Path],
    folders: Sequence[Path],
    supply: dict[str, str | Path],
    sources: dict[str, list[Path]],
    work: Path,
    flags: Flags,
    *,
    open_bounds: bool = False,
) -> tuple[list[Path], list[str], str]:
    """Compile object files; also return what was changed to compile them, and the compilers' output."""
    headers, texts = _supplied(supply, work / "include")
    for path, text in texts.items():
        path.write_text(text, encoding="latin-1")
    search = [f"-I{folder}" for folder in (*folders, headers)]
    objects: list[Path] = []
    notes: list[str] = []
    messages = ""
    for number, file in enumerate(files):
        language = language_of(file)
        output = work / f"{number}.o"
        command = [language.compiler, *language.flags, *flags[language], *search, "-o", str(output)]
        command += ["-MD", "-MF", f"{number}.d"]
        if language is FORTRAN:
            command += [*(FREE if is_free_form(file, _read(file)) else FIXED), f"-J{work}"]
        compile_ = _compile_opened if language is FORTRAN and open_bounds else _compile_file
        noted, output_text = compile_(command, file, sources, work / f"changed{number}")
        notes += noted
        messages += output_text
        objects.append(output)
    return objects, notes, messages


def _supplied(supply: Mapping[str, str | Path], folder: Path) -> tuple[Path, dict[Path, str]]:
    """Make a folder, within another one, where INCLUDE lines find the supplied files; return paths and texts too."""
    # deep enough that names with .. stay within
    upwards = max((name.count("..") for name in supply), default=0)
    folder = folder.joinpath(*["below"] * upwards)
    folder.mkdir(parents=True)
    texts = {folder / name: text if isinstance(text, str) else _read(text) for name, text in supply.items()}
    for path in texts:
        path.parent.mkdir(parents=True, exist_ok=True)
    return folder, texts


def _compile_opened(
    command: Sequence[str], file: Path, sources: dict[str, list[Path]], folder: Path
) -> tuple[list[str], str]:
    """Compile a file with open bounds, except those of arrays used as a whole, which the compiler names."""
    text = _read(file)
    free = is_free_form(file, text)
    closed: frozenset[str] = frozenset()
    while True:
        opened = with_open_bounds(text, free=free, but=closed)
        try:
            return _compile_file(command, file, sources, folder, {file.name: opened} if opened != text else None)
        except CompileError as error:
            declared = closed | {name.lower() for name in _ASSUMED_SIZE.findall(str(error))}
            if declared == closed:
                return _compile_file(command, file, sources, folder)
            closed = declared


def _compile_file(
    command: Sequence[str],
    file: Path,
    sources: dict[str, list[Path]],
    folder: Path,
    changed_texts: Mapping[str, str] | None = None,
) -> tuple[list[str], str]:
    """Compile a file; changed texts, by bare name, are compiled as copies in the folder.

    Extensions of Abaqus' compiler that gfortran refuses are changed there. Returns the changes and the output.
    The compiler runs beside the folder: it takes module files of the current folder before those just made.
    """
    copies = dict(changed_texts or {})
    notes: list[str] = []
    messages = ""
    if language_of(file) is FORTRAN:
        for repair in hidden_types(_read(file), file.name):
            _repair(repair, sources, copies, notes)
    while True:
        if copies:
            copies.setdefault(file.name, _read(file))
            folder.mkdir(exist_ok=True)
        for name, text in copies.items():
            (folder / name).write_text(text, encoding="latin-1")
        source = folder / file.name if copies else file.resolve()
        compiled = _run([*command, f"-I{folder}", str(source)], folder.parent)
        errors = compiled.stderr
        if not compiled.returncode:
            # what the compiler says of the user's text counts
            messages = messages or errors
        proposed = repairs(errors) if compiled.returncode else argument_ranks.zeros_for_arrays(errors)
        changed = [_repair(repair, sources, copies, notes) for repair in proposed]
        if not compiled.returncode and not any(changed):
            return notes, messages
        if not any(changed):
            raise CompileError(file, first_error(errors, _texts(sources)))


def _repair(repair: Repair, sources: dict[str, list[Path]], copies: dict[str, str], notes: list[str]) -> bool:
    """Change the copy of a file, made first if there is none; returns whether that was possible."""
    if len(sources.get(repair.file, [])) != 1:
        return False
    changed = repair.apply(copies.get(repair.file) or _read(sources[repair.file][0]))
    if changed is None:
        return False
    copies[repair.file] = changed
    notes.append(f"{_EXTENSION}: {repair.file}, line {repair.line}: {repair.note}")
    return True


def _run(command: Sequence[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a compiler in a folder; its messages are in English."""
    return subprocess.run(
        command,
        cwd=folder,
        capture_output=True,
        text=True,
        errors="replace",
        env=os.environ | {"LC_ALL": "C"},
        check=False,
    )
