# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compile a user's files as Abaqus does, once: results are kept by content in the user's cache folder."""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from harness.errors import CompileError
from harness.usersub import linker
from harness.usersub.diagnostics import first_error
from harness.usersub.headers import HEADERS
from harness.usersub.languages import FIXED, FORTRAN, FREE, LANGUAGES, ZERO_LOCALS, is_free_form, language_of, linking
from harness.usersub.mending import repairs

_INCLUDE = re.compile(r"^\s*#?\s*include\s*['\"<]([^'\">]+)['\">]", re.IGNORECASE | re.MULTILINE)


def build(files: Sequence[Path], include: Sequence[Path] = (), *, zero_locals: bool = False) -> Path:
    """Shared library of the files, compiled in their order; include: folders besides the sources' own.

    zero_locals: local variables of Fortran that are given no value are zero. Raises CompileError with the compiler's
    first error.
    """
    compilers = {language_of(file): language_of(file).program(file) for file in files}
    folders = list(dict.fromkeys([*(f.resolve().parent for f in files), *(p.resolve() for p in include)]))
    headers, texts, sources = _scan(files, folders)
    flags = (ZERO_LOCALS,) if zero_locals else ()
    forms = [str(is_free_form(file, _read(file))) for file in files]
    key = _key(compilers.values(), [*flags, *forms, *texts])
    target = cache_folder() / f"{files[0].stem}-{key}.so"
    if not target.exists():
        with tempfile.TemporaryDirectory() as work:
            _compile(files, folders, headers, sources, Path(work), target, flags)
    return target


def cache_folder() -> Path:
    """Folder of compiled user files, private to the user."""
    base = os.environ.get("XDG_CACHE_HOME")
    folder = (Path(base) if base else Path.home() / ".cache") / "uel-harness"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if os.access(folder, os.W_OK):
            return folder
    except OSError:
        pass
    return Path(tempfile.mkdtemp(prefix="uel-harness-"))


def _read(file: Path) -> str:
    return file.read_text(encoding="latin-1")


def _key(compilers: Iterable[str], texts: Sequence[str]) -> str:
    """Name of a result: what it depends on, hashed."""
    versions = [
        subprocess.run([compiler, "-dumpfullversion"], capture_output=True, text=True, check=False).stdout
        for compiler in compilers
    ]
    flags = [*FIXED, *FREE, *linker.FLAGS, *(flag for language in LANGUAGES for flag in language.flags)]
    parts = [*versions, *flags, *HEADERS.values(), *texts]
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
    target: Path,
    flags: Sequence[str],
) -> None:
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
        command = [language.compiler, *language.flags, *search, "-o", str(output)]
        if language is FORTRAN:
            command += [*(FREE if is_free_form(file, _read(file)) else FIXED), *flags, f"-J{work}"]
        notes += _compile_one(command, file, sources, work / f"mended{number}")
        objects.append(output)
    shared = work / target.name
    language, libraries = linking([language_of(file) for file in files])
    libraries += linker.lapack_flags(objects, language.compiler)
    errors = _errors([language.compiler, *linker.FLAGS, *map(str, objects), *libraries, "-o", str(shared)], work)
    if errors is not None:
        raise CompileError(files[0], first_error(errors, {}))
    # another process may write the same file: a rename replaces it in one step
    notes_of(target).write_text("".join(f"{note}\n" for note in notes), encoding="utf-8")
    partial = target.with_suffix(f".{os.getpid()}")
    shutil.move(shared, partial)
    partial.replace(target)


def notes_of(library: Path) -> Path:
    """File beside a compiled library with what was changed to compile it, a line each."""
    return library.with_suffix(".notes")


def _compile_one(command: Sequence[str], file: Path, sources: dict[str, list[Path]], folder: Path) -> list[str]:
    """Compile a file; what gfortran refuses of Abaqus' compiler is mended in copies in the folder. Returns what was.

    The compiler runs beside the folder: it takes module files of the current folder before those just made.
    """
    copies: dict[str, str] = {}
    notes: list[str] = []
    while True:
        source = folder / file.name if copies else file.resolve()
        errors = _errors([*command, f"-I{folder}", str(source)], folder.parent)
        if errors is None:
            return notes
        changed = False
        for repair in repairs(errors):
            if len(sources.get(repair.file, [])) != 1:
                continue
            mended = repair.apply(copies.get(repair.file) or _read(sources[repair.file][0]))
            if mended is not None:
                copies[repair.file], changed = mended, True
                notes.append(f"{repair.file}, line {repair.line}: {repair.note}")
        if not changed:
            texts = {name: _read(paths[0]) for name, paths in sources.items()}
            raise CompileError(file, first_error(errors, texts))
        copies.setdefault(file.name, _read(file))
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
