# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Kept states for *RESTART: NAME_restart/stepN_incrementM.npz, each with the whole state.

A file holds the numbered arrays of the state, and a tree in JSON that refers to them: the format, the decks of the
model, and the state. It gets its name when it is complete, so that a killed run leaves complete files. Digests of the
arrays are in the tree, and the digest of the tree is beside it: a file that has changed by a bit is refused.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import struct
import zlib
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final
from zipfile import BadZipFile, is_zipfile

import numpy as np
from numpy.lib.npyio import NpzFile

from uel.errors import UelError
from uel.model.arrays import FloatArray
from uel.model.records import StateKept
from uel.model.restart import DeckPart, KeptState
from uel.output.schedule import find_written

FORMAT: Final = 3
"""Version of the files, to be increased when their content or its meaning changes."""

_NAME: Final = re.compile(r"step(\d+)_increment(\d+)\.npz")
_ARRAY: Final = "array"

_UNREADABLE: Final = (
    *(OSError, EOFError, BadZipFile, zlib.error, struct.error, ValueError, KeyError, IndexError, TypeError),
    *(AttributeError, NotImplementedError, RuntimeError, MemoryError, OverflowError, SyntaxError),
)
"""Exceptions of zipfile and numpy for a file that is no archive of arrays."""


def folder_of(stem: Path) -> Path:
    """Return the folder of the states of a job; stem: its folder and name."""
    return stem.with_name(f"{stem.name}_restart")


class StateFiles:
    """Writer of the states of a job.

    Parameters
    ----------
    stem
        Folder and name of the job. States of an earlier job of this name are removed.
    decks
        Decks of its model.
    """

    def __init__(self, stem: Path, decks: Sequence[DeckPart]) -> None:
        self._folder = folder_of(stem)
        self._decks = [asdict(part) for part in decks]
        self._last = (0, Path())
        shutil.rmtree(self._folder, ignore_errors=True)

    def write(self, record: StateKept) -> None:
        """Write a state; at any time the last one or the one before it exists."""
        self._folder.mkdir(parents=True, exist_ok=True)
        arrays: list[FloatArray] = []
        moment = {"step": record.step, "increment": record.increment}
        tree = {"format": FORMAT, **moment, "decks": self._decks, "analysis": _numbered(record.analysis, arrays)}
        text = np.frombuffer(
            json.dumps(tree | {"digests": [array_digest(array) for array in arrays]}).encode(), np.uint8
        )
        check = np.array(array_digest(text))
        path = self._folder / f"step{record.step}_increment{record.increment:04d}.npz"
        unfinished = self._folder / "unfinished.tmp"
        try:
            with unfinished.open("wb") as file:
                np.savez(file, tree=text, check=check, **_named(arrays))
                if record.overlay:
                    # remove the state before, now that this one is on the disk
                    file.flush()
                    os.fsync(file.fileno())
            unfinished.replace(path)
        except OSError as error:
            unfinished.unlink(missing_ok=True)
            error.filename = str(path)
            raise
        step, last = self._last
        if record.overlay and step == record.step:
            last.unlink(missing_ok=True)
        self._last = record.step, path


def read_state(stem: Path, step: int | None = None, increment: int | None = None) -> KeptState:
    """Read a state of a job.

    Parameters
    ----------
    stem
        Folder and name of the job.
    step, increment
        Step and increment at the end of which it was kept; None: the last one.

    Returns
    -------
    KeptState
        Content of its file.

    Raises
    ------
    UelError
        There is no such state, or its file is damaged, renamed or of another version.
    """
    folder = folder_of(stem)
    kept_states = sorted(
        (int(name[1]), int(name[2])) for path in folder.glob("*.npz") if (name := _NAME.fullmatch(path.name))
    )
    if not kept_states:
        where = f"in {folder}; a warning in {stem}.dat says where it has no effect"
        raise UelError(f"{stem}: the job has kept no state; *RESTART, WRITE keeps them, {where}")
    step = kept_states[-1][0] if step is None else step
    moment = kept_states[find_written(folder, "state", kept_states, step, -1 if increment is None else increment)]
    path = folder / f"step{moment[0]}_increment{moment[1]:04d}.npz"
    if not is_zipfile(path):
        raise UelError(f"{path} is damaged, or is not a state of a job: it is no archive of arrays")
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            tree, version = _tree(file)
            if version == FORMAT:
                arrays = _arrays(file, tree)
                decks = tuple(DeckPart(**part) for part in tree["decks"])
                kept = KeptState(tree["step"], tree["increment"], decks, _filled(tree["analysis"], arrays), str(path))
    except _UNREADABLE as error:
        raise UelError(f"{path} is damaged, or is not a state of a job: {_reason(error)}") from None
    if version != FORMAT:
        raise UelError(f"{path} has format {version}; this version of uel reads format {FORMAT}: run the old job again")
    if (kept.step, kept.increment) != moment:
        raise UelError(f"{path} is the state of step {kept.step}, increment {kept.increment}: it has been renamed")
    return kept


def _tree(file: NpzFile) -> tuple[dict[str, Any], Any]:
    """Return the tree of a file, and its format. Raises ValueError if it has changed."""
    text = file["tree"]
    tree = json.loads(text.tobytes())
    if not isinstance(tree, dict) or "format" not in tree:
        raise ValueError("its tree is none of a state")
    if "check" in file.files and file["check"].tolist() != array_digest(text):
        raise ValueError("its tree is not what was written")
    if "check" not in file.files and tree["format"] == FORMAT:
        raise ValueError("the check of its tree is missing")
    return tree, tree["format"]


def _arrays(file: NpzFile, tree: dict[str, Any]) -> list[FloatArray]:
    """Return the arrays of a file. Raises ValueError if they have changed."""
    names = {f"{_ARRAY}{k}" for k in range(len(tree["digests"]))}
    members = set(file.files) - {"tree", "check"}
    if members != names:
        other, kind = (names - members, "is missing") if names - members else (members - names, "does not belong to it")
        raise ValueError(f"{min(other)} {kind}")
    arrays = []
    for k, digest in enumerate(tree["digests"]):
        array = file[f"{_ARRAY}{k}"]
        if array_digest(array) != digest:
            raise ValueError(f"{_ARRAY}{k} is not what was written")
        arrays.append(array)
    return arrays


def array_digest(array: np.ndarray) -> str:
    """Return a digest of type, shape and bytes of an array."""
    digest = hashlib.blake2b(f"{array.dtype.str} {array.shape}".encode(), digest_size=16)
    digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()


def _reason(error: BaseException) -> str:
    return " ".join(str(error).split())[:200] or type(error).__name__


def _named(arrays: Sequence[FloatArray]) -> dict[str, Any]:
    return {f"{_ARRAY}{k}": array for k, array in enumerate(arrays)}


def _numbered(value: Any, arrays: list[FloatArray]) -> Any:
    """Replace the arrays of a part of a state by numbers, and append them to the list."""
    match value:
        case np.ndarray():
            arrays.append(value)
            return {_ARRAY: len(arrays) - 1}
        case dict():
            return {name: _numbered(part, arrays) for name, part in value.items()}
        case list() | tuple():
            return [_numbered(part, arrays) for part in value]
        case np.generic():
            return value.item()
        case _:
            return value


def _filled(value: Any, arrays: Sequence[FloatArray]) -> Any:
    """Invert `_numbered`; tuples have become lists."""
    match value:
        case dict() if value.keys() == {_ARRAY}:
            return arrays[value[_ARRAY]]
        case dict():
            return {name: _filled(part, arrays) for name, part in value.items()}
        case list():
            return [_filled(part, arrays) for part in value]
        case _:
            return value
