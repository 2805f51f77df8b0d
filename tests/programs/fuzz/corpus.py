# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks to damage: all decks of some folders, with the files they include."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path, PurePath
from random import Random

from mutations import mutate

DECK = "deck.inp"
"""Name of the damaged deck, by which it may include itself."""
_INPUT = re.compile(r"INPUT\s*=\s*\"?([^\",\s]+)", re.IGNORECASE)
_STEP = re.compile(r"^\*\s*STEP\b", re.IGNORECASE | re.MULTILINE)
_USUAL_SIZE = 5000
"""Characters; larger decks are drawn less often, since their trials take longer."""
SHARE_OF_RUNS = 0.1
"""Of the trials; the other decks are only read, which takes a tenth of the time."""


@dataclass(frozen=True)
class Deck:
    """A deck and the files it includes, by the names it uses for them; the deck itself is DECK."""

    path: Path
    files: dict[str, str]

    @property
    def weight(self) -> float:
        """Weight with which the deck is drawn."""
        return (1.0 + sum(map(len, self.files.values())) / _USUAL_SIZE) ** -2


@dataclass(frozen=True)
class Case:
    """Files of a damaged deck by their names, the deck from which they come, and whether it is run beyond reading."""

    path: Path
    files: dict[str, bytes]
    runs: bool


class Corpus:
    """All decks of some folders."""

    def __init__(self, folders: Sequence[Path]) -> None:
        paths = sorted({path for folder in folders for path in _deck_files(folder)})
        self.decks = [Deck(path, dict(_files(path))) for path in paths]
        self._weights = list(accumulate(deck.weight for deck in self.decks))
        self._lines = [deck.files[DECK].split("\n") for deck in self.decks]

    def case(self, seed: int, number: int) -> Case:
        """One trial; the same for the same seed and number."""
        random = Random(f"{seed}/{number}")
        (deck,) = random.choices(self.decks, cum_weights=self._weights)
        return Case(deck.path, mutate(random, deck.files, DECK, self._lines), random.random() < SHARE_OF_RUNS)


def _deck_files(folder: Path) -> Iterator[Path]:
    """Files with a step: the others are included by them."""
    for path in [folder] if folder.is_file() else folder.rglob("*"):
        if path.suffix.lower() == ".inp" and path.is_file() and _STEP.search(_read(path)):
            yield path


def _files(path: Path) -> Iterator[tuple[str, str]]:
    text = _read(path)
    yield DECK, text
    pending = _INPUT.findall(text)
    seen: set[str] = set()
    while pending:
        name = pending.pop()
        inside = not PurePath(name).is_absolute() and ".." not in PurePath(name).parts
        if name not in seen and inside and (path.parent / name).is_file():
            seen.add(name)
            found = _read(path.parent / name)
            pending += _INPUT.findall(found)
            yield name, found


def _read(path: Path) -> str:
    raw = path.read_bytes()
    try:
        return raw.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError:
        return raw.decode("latin-1").replace("\r\n", "\n")
