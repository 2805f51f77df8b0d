# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The runs of a batch: decks, or rows of a table of values for one deck."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

from uel import usersub
from uel.batch.table import Row, read_table
from uel.batch.values import value_of
from uel.deck import Survey, survey_deck
from uel.errors import DeckError, UsageError
from uel.files import read_whole

ENDING: Final = ".inp"
"""Ending of decks in a folder, in any case."""


@dataclass(frozen=True, slots=True)
class BatchRun:
    """A run of a batch.

    name    of the job and of its folder
    deck    the deck
    values  names of parameters, and texts of their values
    inputs  names, and digests or texts, of all that its results depend on, as they were when the batch began
    """

    name: str
    deck: Path
    values: tuple[tuple[str, str], ...]
    inputs: tuple[tuple[str, str], ...]

    def files(self) -> dict[str, str]:
        """Return the inputs on which its results depend, by name."""
        return dict(self.inputs)


@dataclass(frozen=True, slots=True)
class Settings:
    """Settings of the runs of a batch.

    user        user files
    options     words of the command `uel run` on which results depend
    call_limit  seconds that a call of a user routine may take
    """

    user: Sequence[Path] = ()
    options: Sequence[str] = ()
    call_limit: float = 0.0

    @property
    def debug(self) -> bool:
        """True if the user files are compiled with run-time checks."""
        return "--debug" in self.options


def list_runs(paths: Sequence[Path], table: Path | None, settings: Settings) -> list[BatchRun]:
    """List the runs, in the order of the decks or of the rows; the user files are compiled once for all of them.

    Parameters
    ----------
    paths
        Decks, and folders all of whose decks run: their files .inp but those that another one includes.
    table
        Values for the parameters of the deck, of which there is one then.
    settings
        User files and options of the runs.

    Raises
    ------
    UsageError
        There is no such deck, folder or table, or two decks have one name.
    DeckError
        The table is wrong, or its deck cannot be read.
    CompileError
        The user files do not compile.
    """
    digest, survey_of = cache(_digest), cache(_survey)
    decks = list(dict.fromkeys(deck for path in paths for deck in _decks(path, survey_of)))

    @cache
    def code(folder: Path) -> str:
        debug = settings.debug
        return usersub.compile_ahead(settings.user, deck=folder / "deck", zero_locals=not debug, debug=debug)

    def run(name: str, deck: Path, survey: Survey, row: Row) -> BatchRun:
        inputs = {f"{number} {file.name}": digest(file) for number, file in enumerate(survey.files)}
        inputs |= {"user": code(deck.parent), "values": repr(row.values), "options": repr(settings.options)}
        return BatchRun(name, deck, row.values, tuple(inputs.items()))

    if table is None:
        _check_names(decks)
        return [run(deck.stem, deck, survey_of(deck), Row("", ())) for deck in decks]
    if len(decks) != 1:
        raise UsageError(f"--table {table}: expected one deck, found {len(decks)}")
    (deck,) = decks
    survey = survey_deck(deck)
    return [
        run(row.job or f"{deck.stem}-{number}", deck, _with_values(deck, survey, row), row)
        for number, row in enumerate(read_table(table, deck, survey.parameters), 1)
    ]


def _decks(path: Path, survey: Callable[[Path], Survey]) -> list[Path]:
    """Return a deck, or those of a folder. Raises UsageError."""
    if not path.is_dir():
        if not path.exists():
            raise UsageError(f"{path}: no such deck or folder")
        return [path]
    files = sorted(file for file in path.iterdir() if file.suffix.lower() == ENDING and file.is_file())
    included = {file.resolve() for deck in files for file in survey(deck).files[1:]}
    decks = [deck for deck in files if deck.resolve() not in included]
    if not decks:
        raise UsageError(f"{path}: the folder has no decks; expected files that end in {ENDING}")
    return decks


def _survey(deck: Path) -> Survey:
    """Call `survey_deck`; for a deck that cannot be read, return the deck alone: its run says why."""
    try:
        return survey_deck(deck)
    except DeckError:
        return Survey((deck,), (), False)


def _with_values(deck: Path, survey: Survey, row: Row) -> Survey:
    """Survey of the deck with the values of a row."""
    if not survey.depends:
        return survey
    return survey_deck(deck, {name: value_of(text) for name, text in row.values})


def _check_names(decks: Iterable[Path]) -> None:
    """Raise UsageError if two decks have one name."""
    known: dict[str, Path] = {}
    for deck in decks:
        other = known.setdefault(deck.stem, deck)
        if other != deck:
            raise UsageError(f"{other} and {deck}: two decks have one name, and would write into one folder")


def _digest(file: Path) -> str:
    """Return the digest of a file; '' if it cannot be read."""
    try:
        return hashlib.sha256(read_whole(file)).hexdigest()
    except (OSError, ValueError):
        return ""
