# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compile a user's Fortran as Abaqus does, once: results are kept by content in the user's cache folder."""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

from harness.errors import CompileError
from harness.usersub import linker
from harness.usersub.headers import HEADERS
from harness.usersub.mending import COMPARED_LOGICALS, compare_logicals

SUFFIXES: Final = (".f", ".for", ".f90")

FLAGS: Final = (
    *("-c", "-O2", "-fPIC", "-ffp-contract=off", "-w", "-fdiagnostics-color=never"),
    *("-cpp", "-std=legacy", "-fdec", "-fno-range-check", "-fno-realloc-lhs"),
    # locals on the stack and not kept from call to call, as Abaqus' -auto has it, automatic arrays too: on the heap a
    # write behind one ends the process later on
    *("-frecursive", "-fstack-arrays"),
)
FIXED: Final = ("-ffixed-form", "-ffixed-line-length-132")
FREE: Final = ("-ffree-form", "-ffree-line-length-none")

_INCLUDE = re.compile(r"^\s*#?\s*include\s*['\"<]([^'\">]+)['\">]", re.IGNORECASE | re.MULTILINE)
_FREEFORM = re.compile(r"^[!cC*](?:DIR|DEC)\$\s*FREEFORM", re.IGNORECASE | re.MULTILINE)
_LOCATION = re.compile(r"^(?P<file>.+?):(?P<line>\d+):(?P<column>\d+):")
_ERROR = re.compile(r"(?:Fatal )?Error: ")


def build(files: Sequence[Path], include: Sequence[Path] = ()) -> Path:
    """Shared library of the files, compiled in their order; include: folders besides the sources' own.

    Raises CompileError with the compiler's first error.
    """
    compiler = shutil.which("gfortran")
    if compiler is None:
        raise CompileError(
            files[0],
            "gfortran is needed to compile it and is not installed (apt install gfortran, dnf install gcc-gfortran)",
        )
    folders = list(dict.fromkeys([*(f.resolve().parent for f in files), *(p.resolve() for p in include)]))
    headers, texts, sources = _scan(files, folders)
    key = _key(compiler, texts)
    target = cache_folder() / f"{files[0].stem}-{key}.so"
    if not target.exists():
        with tempfile.TemporaryDirectory() as work:
            _compile(compiler, files, folders, headers, sources, Path(work), target)
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


def is_free_form(file: Path) -> bool:
    """True for .f90, and for a file that an Intel directive declares to be in free form."""
    return file.suffix.lower() == ".f90" or bool(_FREEFORM.search(_read(file)))


def _read(file: Path) -> str:
    return file.read_text(encoding="latin-1")


def _key(compiler: str, texts: Sequence[str]) -> str:
    version = subprocess.run([compiler, "-dumpfullversion"], capture_output=True, text=True, check=False).stdout
    parts = [version, *FLAGS, *FIXED, *FREE, *linker.FLAGS, *HEADERS.values(), *texts]
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
                supply[name] = found
            elif header is not None:
                supply[name] = header
    named: dict[str, list[Path]] = {}
    for file in sorted(seen):
        named.setdefault(file.name, []).append(file)
    return supply, texts, named


def _matches(name: str, folders: Sequence[Path]) -> Iterator[Path]:
    """Files of that name, whatever its case."""
    for folder in folders:
        if (folder / name).is_file():
            yield folder / name
    for folder in folders:
        yield from (p for p in sorted(folder.iterdir()) if p.name.lower() == name.lower() and p.is_file())


def _compile(
    compiler: str,
    files: Sequence[Path],
    folders: Sequence[Path],
    supply: dict[str, str | Path],
    sources: dict[str, list[Path]],
    work: Path,
    target: Path,
) -> None:
    headers = work / "include"
    for name, content in supply.items():
        path = headers / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content if isinstance(content, str) else _read(content), encoding="latin-1")
    search = [f"-I{folder}" for folder in (*folders, headers)]
    objects: list[Path] = []
    notes: list[str] = []
    for number, file in enumerate(files):
        form = FREE if is_free_form(file) else FIXED
        output = work / f"{number}.o"
        command = [compiler, *FLAGS, *form, *search, f"-J{work}", "-o", str(output)]
        notes += _compile_one(command, file, sources, work / f"mended{number}")
        objects.append(output)
    shared = work / target.name
    libraries = linker.lapack_flags(objects)
    _run([compiler, *linker.FLAGS, *map(str, objects), *libraries, "-o", str(shared)], files[0])
    # another process may write the same file: a rename replaces it in one step
    notes_of(target).write_text("".join(f"{note}\n" for note in notes), encoding="utf-8")
    partial = target.with_suffix(f".{os.getpid()}")
    shutil.move(shared, partial)
    partial.replace(target)


def notes_of(library: Path) -> Path:
    """File beside a compiled library with what was changed to compile it, a line each."""
    return library.with_suffix(".notes")


def _compile_one(command: Sequence[str], file: Path, sources: dict[str, list[Path]], folder: Path) -> list[str]:
    """Compile a file; what gfortran refuses of Abaqus' compiler is mended in copies in the folder. Returns what was."""
    copies: dict[str, str] = {}
    notes: list[str] = []
    while True:
        errors = _errors([*command, f"-I{folder}", str(folder / file.name if copies else file)])
        if errors is None:
            return notes
        changed = False
        for found in COMPARED_LOGICALS.finditer(errors):
            name, line, operator = Path(found["file"]).name, int(found["line"]), found["operator"]
            if len(sources.get(name, [])) != 1:
                continue
            text = copies.get(name) or _read(sources[name][0])
            mended = compare_logicals(text, line, int(found["column"]), operator)
            if mended is not None:
                copies[name], changed = mended, True
                notes.append(f"{name}, line {line}: logicals compared with {operator}, in the copy .eqv. or .neqv.")
        if not changed:
            raise CompileError(file, first_error(errors))
        copies.setdefault(file.name, _read(file))
        folder.mkdir(exist_ok=True)
        for name, text in copies.items():
            (folder / name).write_text(text, encoding="latin-1")


def _errors(command: Sequence[str]) -> str | None:
    """What the compiler says; None if it is content."""
    environment = os.environ | {"LC_ALL": "C"}
    result = subprocess.run(command, capture_output=True, text=True, errors="replace", env=environment, check=False)
    return result.stderr if result.returncode else None


def _run(command: Sequence[str], file: Path) -> None:
    errors = _errors(command)
    if errors is not None:
        raise CompileError(file, first_error(errors))


def first_error(output: str) -> str:
    """The compiler's first error: sentence, place, and the source line with its column marked."""
    place: re.Match[str] | None = None
    context: list[str] = []
    for line in output.splitlines():
        found = _ERROR.match(line)
        if found is None:
            location = _LOCATION.match(line)
            place, context = (location, []) if location else (place, [*context, line] if line.strip() else context)
            continue
        sentence = f"does not compile: {line[found.end() :].replace(' at (1)', '')}"
        if place is None:
            return sentence
        where = f"{Path(place['file']).name}, line {place['line']}, column {place['column']}"
        return "\n".join([f"{sentence} ({where})", *context])
    return f"does not compile or link:\n{output.strip()}"
