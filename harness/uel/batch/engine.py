# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs of many decks, several at a time, whose entries are kept: an interrupted batch resumes where it stopped."""

from __future__ import annotations

import hashlib
import inspect
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor, as_completed
from dataclasses import asdict
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from typing import Final, Generic, Protocol, Self, TypeVar

from rich.console import Console

import uel.assembly
import uel.contact
import uel.deck
import uel.elements
import uel.model
import uel.parallel
import uel.procedures
import uel.solver
import uel.usersub
from uel.batch.progress import BatchProgress
from uel.usersub.own_kernels import path_of_amalgam


class Deck(Protocol):
    """A deck that a batch runs, and what its results depend on beside the sources of the harness."""

    @property
    def name(self) -> str:
        """Name of the deck `NAME.inp`, of its folder and of its entry."""

    def files(self) -> dict[str, str]:
        """Return the deck and the files that it includes, by name: their texts, or digests of them."""


class StoredRow:
    """Row that a `Store` keeps of a run: base of dataclasses of numbers and texts."""

    __slots__ = ()

    def to_json(self) -> dict[str, object]:
        """Return the values by name, in types of JSON."""
        return asdict(self)  # type: ignore[call-overload, no-any-return]

    @classmethod
    def from_json(cls, values: Mapping[str, object]) -> Self:
        """Create an entry from the values that `to_json` gave."""
        return cls(**values)


DeckT = TypeVar("DeckT", bound=Deck)
DeckT_contra = TypeVar("DeckT_contra", bound=Deck, contravariant=True)
EntryT = TypeVar("EntryT", bound=StoredRow)
T = TypeVar("T")


class Keeper(Protocol[DeckT_contra, EntryT]):
    """Keeper of the entries of runs."""

    def get(self, deck: DeckT_contra, /) -> EntryT | None:
        """Return the entry of a deck; None if it has to run."""

    def put(self, deck: DeckT_contra, entry: EntryT, /) -> None:
        """Keep an entry."""


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
        self._path = path
        self._decode = decode
        self._entries: dict[str, dict[str, object]] = {}
        if path.exists():
            self._entries = json.loads(path.read_text(encoding="utf-8"))

    def get(self, deck: Deck) -> EntryT | None:
        """Return the entry of a deck; None if there is none, or if the deck or the sources have changed since."""
        entry = self._entries.get(deck.name)
        if entry is None or entry["fingerprint"] != fingerprint(deck):
            return None
        row = entry["row"]
        assert isinstance(row, dict)
        return self._decode(row)

    def put(self, deck: Deck, entry: EntryT) -> None:
        """Keep an entry."""
        self._entries[deck.name] = {"fingerprint": fingerprint(deck), "row": entry.to_json()}
        self._path.parent.mkdir(parents=True, exist_ok=True)
        new = self._path.with_suffix(".new")
        new.write_text(json.dumps(self._entries, indent=1, sort_keys=True) + "\n", encoding="utf-8")
        new.replace(self._path)


def fingerprint(deck: Deck) -> str:
    """Return the digest of a deck with all its files, and of the sources that its results depend on."""
    digest = hashlib.sha256(_sources())
    for name, content in sorted(deck.files().items()):
        digest.update(f"{name}\n{content}".encode())
    return digest.hexdigest()[:16]


_PACKAGES: Final = (
    *(uel.assembly, uel.contact, uel.deck, uel.elements, uel.model, uel.procedures, uel.solver),
    *(uel.parallel, uel.usersub),
)
"""Packages that determine a run, from the deck to the records."""


@cache
def _sources() -> bytes:
    """Return the digest of the sources at the first call: a batch continues with what it has imported."""
    digest = hashlib.sha256(path_of_amalgam().read_bytes())
    for package in _PACKAGES:
        # __path__ of an editable installation is not a folder
        for file in sorted(Path(inspect.getfile(package)).parent.rglob("*.py")):
            digest.update(file.read_bytes())
    return digest.digest()


def run_all(
    function: Callable[[DeckT, Path], T], decks: Sequence[DeckT], folder: Path, workers: int, *, threads: bool = False
) -> Iterator[tuple[DeckT, T]]:
    """Call `function(deck, folder)` in several processes; yields each deck with its value as it ends.

    threads: in threads of this process, for a function that starts a process itself. If the caller stops early, runs
    that have begun are finished.
    """
    with _pool(workers, threads=threads) as pool:
        futures: dict[Future[T], DeckT] = {pool.submit(function, deck, folder): deck for deck in decks}
        try:
            for future in as_completed(futures):
                yield futures[future], future.result()
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _pool(workers: int, *, threads: bool) -> Executor:
    if threads:
        return ThreadPoolExecutor(workers)
    # a fresh process: what a Fortran library keeps and where it writes is its process's own
    return ProcessPoolExecutor(workers, mp_context=get_context("spawn"))


def complete(
    decks: Sequence[DeckT],
    store: Keeper[DeckT, EntryT],
    function: Callable[[DeckT, Path], EntryT | None],
    folder: Path,
    *,
    workers: int,
    console: Console,
    describe: Callable[[EntryT], str],
    work: Callable[[DeckT], float] = lambda _: 1.0,
    threads: bool = False,
) -> dict[DeckT, EntryT]:
    """Return the entries of all decks, in their order; those not in the store are computed and kept.

    A deck is left out for which the function returns None: it has not run to an end.

    Parameters
    ----------
    decks, store
        The requested decks, and the entries that exist.
    function, folder, workers, threads
        As in `run_all`.
    console, describe
        Gets a progress bar, and a line for each deck that ends: its name and what `describe` says about the entry.
    work
        Returns the work for a deck, in any unit, from which the remaining time is estimated.
    """
    known = {deck: entry for deck in decks if (entry := store.get(deck)) is not None}
    missing = [deck for deck in decks if deck not in known]
    with BatchProgress(console, len(decks), len(known), sum(map(work, missing)), workers) as progress:
        runs = run_all(function, missing, folder, workers, threads=threads)
        for deck, entry in runs:
            if entry is not None:
                store.put(deck, entry)
                known[deck] = entry
            progress.ended(work(deck), f"{deck.name}: {describe(entry)}" if entry is not None else "")
    return {deck: known[deck] for deck in decks if deck in known}
