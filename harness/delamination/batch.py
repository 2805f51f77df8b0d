# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs of many decks on several processes, whose entries are kept: an interrupted batch resumes where it stopped."""

from __future__ import annotations

import hashlib
import inspect
import json
import shutil
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from dataclasses import asdict, dataclass
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from typing import Generic, Protocol, Self, TypeVar

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

import harness.elements
import harness.procedures
import harness.solver
from harness.errors import ConvergenceError
from harness.job import run
from harness.output import Result
from harness.usersub.built import path_of_amalgam


class Deck(Protocol):
    """A deck that a batch runs."""

    @property
    def name(self) -> str:
        """Name of the deck `NAME.inp`, of its folder and of its entry."""

    def files(self) -> dict[str, str]:
        """The deck and the files that it includes, by name."""


class StoredRow:
    """What a `Store` keeps of a run: base of dataclasses of numbers and texts."""

    __slots__ = ()

    def to_json(self) -> dict[str, object]:
        """Values by name, in types of JSON."""
        return asdict(self)  # type: ignore[call-overload, no-any-return]

    @classmethod
    def from_json(cls, values: Mapping[str, object]) -> Self:
        """Entry of the values that `to_json` gave."""
        return cls(**values)


DeckT = TypeVar("DeckT", bound=Deck)
EntryT = TypeVar("EntryT", bound=StoredRow)
T = TypeVar("T")


class Store(Generic[EntryT]):
    """The measured entries of all decks in one file, each with a fingerprint of what it was computed from.

    Parameters
    ----------
    path
        The file, whole at every moment.
    decode
        The entry whose `to_json` gave the mapping.
    """

    def __init__(self, path: Path, decode: Callable[[Mapping[str, object]], EntryT]) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        self._path = path
        self._decode = decode
        self._entries: dict[str, dict[str, object]] = {}
        if path.exists():
            self._entries = json.loads(path.read_text(encoding="utf-8"))

    def get(self, deck: Deck) -> EntryT | None:
        """Entry of a deck; None if there is none, or if the deck, the elements or the solver have changed since."""
        entry = self._entries.get(deck.name)
        if entry is None or entry["fingerprint"] != fingerprint(deck):
            return None
        row = entry["row"]
        assert isinstance(row, dict)
        return self._decode(row)

    def put(self, deck: Deck, entry: EntryT) -> None:
        """Keep an entry."""
        self._entries[deck.name] = {"fingerprint": fingerprint(deck), "row": entry.to_json()}
        new = self._path.with_suffix(".new")
        new.write_text(json.dumps(self._entries, indent=1, sort_keys=True) + "\n", encoding="utf-8")
        new.replace(self._path)


def fingerprint(deck: Deck) -> str:
    """Digest of a deck with all its files, and of the sources of the elements and of the solution procedure."""
    digest = hashlib.sha256(_sources())
    for name, content in sorted(deck.files().items()):
        digest.update(f"{name}\n{content}".encode())
    return digest.hexdigest()[:16]


@cache
def _sources() -> bytes:
    """Digest of the sources at the first call: a batch continues with what it has imported."""
    digest = hashlib.sha256(path_of_amalgam().read_bytes())
    for package in (harness.elements, harness.procedures, harness.solver):
        # __path__ of an editable installation is not a folder
        for file in sorted(Path(inspect.getfile(package)).parent.rglob("*.py")):
            digest.update(file.read_bytes())
    return digest.digest()


@dataclass(frozen=True, slots=True)
class RunOutcome:
    """A run and how it ended: `stopped` says why it stopped early, empty for a run that finished."""

    result: Result
    stopped: str
    seconds: float


def run_deck(deck: Deck, folder: Path, *, fallback: bool, fields: bool = False) -> RunOutcome:
    """Write a deck, run it.

    Parameters
    ----------
    deck
        The deck.
    folder
        Gets a folder of the deck's name with the deck and all that a job writes.
    fallback
        Search downhill where Newton's method fails, as `uel run --fallback`.
    fields
        Keep the field output, fifty times as large as the rest, which tables and profiles do not need.
    """
    place = folder / deck.name
    place.mkdir(parents=True, exist_ok=True)
    for name, content in deck.files().items():
        (place / name).write_text(content, encoding="ascii")
    started, stopped = time.perf_counter(), ""
    try:
        run(place / f"{deck.name}.inp", output_dir=place, fallback=fallback)
    except ConvergenceError as error:
        stopped = str(error)
    if not fields:
        shutil.rmtree(place / f"{deck.name}_vtu", ignore_errors=True)
    return RunOutcome(Result(place / deck.name), stopped, time.perf_counter() - started)


def run_all(
    function: Callable[[DeckT, Path], T], decks: Sequence[DeckT], folder: Path, workers: int
) -> Iterator[tuple[DeckT, T]]:
    """Call `function(deck, folder)` on several processes; yields each deck with its value as it ends.

    If the caller stops early, runs that have begun are finished.
    """
    # a fresh process: what a Fortran library keeps and where it writes is its process's own
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        futures: dict[Future[T], DeckT] = {pool.submit(function, deck, folder): deck for deck in decks}
        try:
            for future in as_completed(futures):
                yield futures[future], future.result()
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def complete(
    decks: Sequence[DeckT],
    store: Store[EntryT],
    function: Callable[[DeckT, Path], EntryT],
    folder: Path,
    *,
    workers: int,
    console: Console,
    describe: Callable[[EntryT], str],
) -> dict[DeckT, EntryT]:
    """Entries of all decks, in their order; those not in the store are computed and kept.

    Parameters
    ----------
    decks, store
        The decks wanted, and the entries there are.
    function, folder, workers
        As in `run_all`.
    console, describe
        Gets a progress bar, and a line for each deck that ends: its name and what `describe` says about the entry.
    """
    known = {deck: entry for deck in decks if (entry := store.get(deck)) is not None}
    missing = [deck for deck in decks if deck not in known]
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console) as progress:
        task = progress.add_task("runs", total=len(decks), completed=len(known))
        for deck, entry in run_all(function, missing, folder, workers):
            store.put(deck, entry)
            known[deck] = entry
            progress.print(f"{deck.name}: {describe(entry)}", highlight=False)
            progress.advance(task)
    return {deck: known[deck] for deck in decks}
