# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compiled user files in the user's cache folder, each with a list of what the compiler read for it.

An entry is two files: the library, and a list in JSON with the library's hash, the notes on it, and the hash of every
file read, by its path in the search folders. An entry is used only if all hashes agree; one that is damaged, or that
others could have written, is ignored. The list is written last, and its name is the hash of its content, so that
simultaneous processes do not disturb each other.
"""

from __future__ import annotations

import functools
import hashlib
import json
import os
import re
import shutil
import stat
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from uel.files import read_whole

_ABSOLUTE: Final = -1
"""Stand-in for the number of a search folder in an absolute path."""
_MODULES: Final = ("*.mod", "*.smod")
_ESCAPED: Final = re.compile(r"\\([ #\\])|\$(\$)")
_BETWEEN: Final = re.compile(r"(?<!\\)\s+")


@dataclass(frozen=True, slots=True)
class Built:
    """A shared library.

    notes  for the user: what was changed to compile it, and warnings, one sentence each
    read   digest of the user's own files that only the compiler knows it has read, the same on any machine
    """

    library: Path
    notes: tuple[str, ...]
    read: str = ""


def cache_folder() -> Path | None:
    """Return the folder of compiled user files; None if there can be none, or if others could write there."""
    base = Path(os.environ.get("XDG_CACHE_HOME", ""))
    try:
        folder = (base if base.is_absolute() else Path.home() / ".cache") / "uel" / "compiled"
        if not folder.is_absolute():
            return None
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        status = folder.stat()
    except (OSError, RuntimeError):
        return None
    private = status.st_uid == os.geteuid() and not status.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
    return folder if private else None


def find(name: str, folders: Sequence[Path]) -> Built | None:
    """Return the entry none of whose files, in these search folders, has changed since the compiler read it."""
    cache = cache_folder()
    if cache is None:
        return None
    try:
        entries = os.listdir(cache)  # noqa: PTH208 (there may be thousands, and a Path of each takes longer than the rest)
        lists = sorted(file for file in entries if file.startswith(f"{name}-") and file.endswith(".json"))
    except OSError:
        return None
    modules = _modules(folders)
    for file in map(cache.joinpath, lists):
        try:
            text = read_whole(file)
            if file.stem != _stem(name, text):
                continue
            entry, library = json.loads(text), file.with_suffix(".so")
            if entry["modules"] == modules and _digest(library) == entry["library"] and _as_read(entry, folders):
                return Built(library, tuple(map(str, entry["notes"])), _digest_of_user_files(entry))
        except (OSError, ValueError, LookupError, TypeError):
            # damaged, or from another version
            continue
    return None


def keep(name: str, library: Path, notes: Sequence[str], read: Iterable[Path], folders: Sequence[Path]) -> Built:
    """Put a library into the cache, or keep it for this process if that is not possible.

    read: files that it depends on beside those that the name stands for; folders: the search folders, in order.
    """
    entry: dict[str, Any] = {
        "library": _digest(library),
        "modules": _modules(folders),
        "notes": list(notes),
        "read": sorted(set(_hashed(read, folders))),
    }
    text = json.dumps(entry, indent=1)
    stem = _stem(name, text.encode())
    cache = cache_folder()
    if cache is not None:
        try:
            with tempfile.TemporaryDirectory(dir=cache) as folder:
                partial = Path(folder) / "partial"
                shutil.copyfile(library, partial)
                partial.replace(cache / f"{stem}.so")
                partial.write_text(text, encoding="utf-8")
                partial.replace(cache / f"{stem}.json")
            return Built(cache / f"{stem}.so", tuple(notes), _digest_of_user_files(entry))
        except OSError:
            pass
    return keep_for_now(name, library, notes, _digest_of_user_files(entry))


def _digest_of_user_files(entry: dict[str, Any]) -> str:
    """Return the digest of the files of an entry that are in the search folders, and of the modules there."""
    # one may be in several of them, by other names
    user_files = {
        (Path(name).name, digest)
        for folder_number, name, digest in entry["read"]
        if digest and folder_number != _ABSOLUTE
    }
    return hashlib.sha256(json.dumps([entry["modules"], sorted(user_files)]).encode()).hexdigest()


def _stem(name: str, text: bytes) -> str:
    """Return the name of both files of an entry, from its list."""
    return f"{name}-{hashlib.sha256(text).hexdigest()[:16]}"


def keep_for_now(name: str, library: Path, notes: Sequence[str], read: str = "") -> Built:
    """Put a library into a folder that is removed with this process; read: '' if nobody knows, unlike any other."""
    folder = tempfile.mkdtemp(dir=_scratch().name)
    return Built(Path(shutil.copyfile(library, Path(folder) / f"{name}.so")), tuple(notes), read or _digest(library))


@functools.cache
def _scratch() -> tempfile.TemporaryDirectory[str]:
    """Return the folder for libraries that cannot be cached; it is removed at the end of the process."""
    return tempfile.TemporaryDirectory(prefix="uel-")


def dependencies(text: str) -> list[str]:
    """Return the names of the files that a compiler has read, from what it writes with -MD: a rule of make."""
    _, _, names = text.replace("\\\n", " ").partition(": ")
    return [_ESCAPED.sub(r"\1\2", name) for name in _BETWEEN.split(names.strip()) if name]


def _hashed(read: Iterable[Path], folders: Sequence[Path]) -> Iterator[tuple[int, str, str]]:
    """Return search folder by number, name in it, and hash of each file; '' for files that would have come first."""
    for file in read:
        within = [(k, str(file.relative_to(folder))) for k, folder in enumerate(folders) if file.is_relative_to(folder)]
        if not within:
            yield _ABSOLUTE, str(file), _digest(file)
        for folder_number, name in within:
            yield folder_number, name, _digest(file)
            for k, folder in enumerate(folders):
                if not _digest(folder / name):
                    yield k, name, ""


def _as_read(entry: dict[str, Any], folders: Sequence[Path]) -> bool:
    for folder_number, name, digest in entry["read"]:
        file = Path(name) if folder_number == _ABSOLUTE else folders[folder_number] / name
        if _digest(file) != digest:
            return False
    return True


def _digest(file: Path) -> str:
    """Hash a file's content; '' if there is no such file."""
    try:
        return hashlib.sha256(read_whole(file)).hexdigest()
    except (OSError, ValueError):
        return ""


def _modules(folders: Sequence[Path]) -> str:
    """Hash the module files that USE statements can find: compilers do not tell which of them they read."""
    digest = hashlib.sha256()
    for number, folder in enumerate(folders):
        for file in sorted(file for pattern in _MODULES for file in folder.glob(pattern)):
            digest.update(f"{number}/{file.name}/{_digest(file)}\n".encode())
    return digest.hexdigest()
