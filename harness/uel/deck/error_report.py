# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Collector of the problems of a deck, so that one reading reports all of them."""

from __future__ import annotations

import difflib
from collections.abc import Container, Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import TypeVar

from uel.errors import DeckError, Source, all_of

MOST_REPORTED = 50
_LONGEST_WORD = 80
"""Characters of the longest word for which a suggestion is searched; the longest keyword has half as many."""


Entry = TypeVar("Entry")


class Problems:
    """Errors and warnings of one deck, without repetitions."""

    def __init__(self) -> None:
        self._errors: dict[tuple[Source, str], DeckError] = {}
        self._of_materials: dict[str, list[DeckError]] = {}
        self._warnings: dict[str, None] = {}
        self._differences: dict[str, None] = {}

    def add(self, source: Source, message: str) -> None:
        """Record an error."""
        self._errors.setdefault((source, message), DeckError(source, message))

    def warn(self, source: Source, message: str) -> None:
        """Record a warning."""
        self._warnings.setdefault(f"{source}: {message}")

    def differ(self, source: Source, message: str) -> None:
        """Record that Abaqus treats this deck differently; the run is not affected."""
        self._differences.setdefault(f"{source}: {message}")

    @contextmanager
    def gather(self) -> Iterator[None]:
        """Record a DeckError raised in the body, so that reading continues with the next block."""
        try:
            yield
        except DeckError as error:
            self._errors.setdefault((error.source, str(error)), error)

    @contextmanager
    def gather_of(self, material: str) -> Iterator[None]:
        """Record a DeckError raised in the body for a material; it counts only if the material is used."""
        try:
            yield
        except DeckError as error:
            self._of_materials.setdefault(material, []).append(error)

    def settle(self, used: Container[str]) -> list[str]:
        """Count the errors of materials that are used; return the names of others that have errors."""
        for material in [name for name in self._of_materials if name in used]:
            for error in self._of_materials.pop(material):
                self._errors.setdefault((error.source, str(error)), error)
        return list(self._of_materials)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings in the order in which they were recorded."""
        return tuple(self._warnings)

    @property
    def differences(self) -> tuple[str, ...]:
        """Differences from Abaqus, in the order in which they were recorded."""
        return tuple(self._differences)

    @property
    def has_errors(self) -> bool:
        """Whether there is an error so far."""
        return bool(self._errors)

    def check(self) -> None:
        """Raise one DeckError with all recorded errors, if there are any."""
        errors = list(self._errors.values())
        if errors:
            shown = errors[:MOST_REPORTED]
            if len(errors) > MOST_REPORTED:
                shown.append(DeckError(errors[MOST_REPORTED].source, f"and {len(errors) - MOST_REPORTED} more errors"))
            raise all_of(shown)


def nearest(word: str, known: Iterable[str]) -> str:
    """Return the ending '; did you mean X?' for a misspelt word, '' if no known word is near."""
    if len(word) > _LONGEST_WORD:
        return ""
    matches = difflib.get_close_matches(word, list(known), n=1, cutoff=0.6)
    return f"; did you mean {matches[0]}?" if matches else ""


def look_up(known: Mapping[str, Entry], name: str, kind: str, source: Source) -> Entry:
    """Return the entry of a name. Raises DeckError, which suggests the nearest known name."""
    if name not in known:
        raise DeckError(source, f"unknown {kind} {name}{nearest(name, known)}")
    return known[name]
