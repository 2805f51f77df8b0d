# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A keyword with its options and data lines, and the typed reading of one data line."""

from __future__ import annotations

import bisect
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Final, TypeVar

from uel.deck.language.abaqus_names import ABAQUS_KEYWORDS
from uel.deck.language.numbers import read_integer, read_real
from uel.deck.language.table import Keyword, Options, split_fields, unquote
from uel.errors import DeckError, Source

ValueT = TypeVar("ValueT", int, float)


class Place:
    """A keyword or a data line, with errors about it."""

    __slots__ = ()

    def error(self, message: str) -> DeckError:
        """Make an error at this place."""
        raise NotImplementedError

    def unsupported(self, what: str, supported: Iterable[str] = ()) -> DeckError:
        """Make the error for what is not supported; it names what is."""
        listed = ", ".join(supported)
        return self.error(f"{what} is not supported{f' (supported: {listed})' if listed else ''}")

    def dependent(self, message: str) -> DeckError:
        """Make the error for values beyond the constants, where Abaqus has temperatures."""
        return self.error(f"{message}; dependence on temperature is not supported")


@dataclass(frozen=True, slots=True)
class Row(Place):
    """One data line: its fields without those that are empty at its end.

    What reads a field takes its position, from 0, and what it is, for the message of the DeckError that it raises.
    """

    keyword: str
    fields: tuple[str, ...]
    source: Source

    def __len__(self) -> int:
        return len(self.fields)

    def blank(self, index: int) -> bool:
        """Return whether the field is empty or beyond the end."""
        return index >= len(self.fields) or not self.fields[index]

    def text(self, index: int, what: str) -> str:
        """Return a required field as written. Raises DeckError if it is missing."""
        if self.blank(index):
            raise self.error(f"{what} is missing")
        return self.fields[index]

    def name(self, index: int, what: str) -> str:
        """Return a required name, in the spelling in which names are compared. Raises DeckError if it is missing."""
        return unquote(self.text(index, what))

    def real(self, index: int, what: str, default: float | None = None) -> float:
        """Return a real number, or the default for an empty field. Raises DeckError."""
        return self._number(read_real, index, what, default)

    def integer(self, index: int, what: str, default: int | None = None) -> int:
        """Return an integer, or the default for an empty field. Raises DeckError."""
        return self._number(read_integer, index, what, default)

    def _number(self, read: Callable[[str], ValueT], index: int, what: str, default: ValueT | None) -> ValueT:
        if default is not None and self.blank(index):
            return default
        try:
            return read(self.text(index, what))
        except ValueError as error:
            raise self.error(f"{what}: {error}") from None

    def reals(self, what: str) -> list[float]:
        """Return all fields as real numbers; an empty one is zero. Raises DeckError."""
        return [self.real(index, what, 0.0) for index in range(len(self.fields))]

    def at_most(self, count: int) -> None:
        """Refuse more than `count` fields."""
        if len(self.fields) > count:
            raise self.error(f"{len(self.fields)} entries, expected at most {count}")

    def error(self, message: str) -> DeckError:
        """Make an error at this line. A line that looks like a keyword line may have lost its asterisk:
        the message says so.
        """
        first = unquote(self.fields[0]) if self.fields else ""
        hint = f"; is the * of *{first} missing?" if first in ABAQUS_KEYWORDS else ""
        return DeckError(self.source, f"*{self.keyword}: {message}{hint}")


PER_LINE: Final = 8
"""Values of a data line, where a keyword takes any number of them."""


@dataclass(slots=True)
class Block(Place):
    """One keyword with its options and data lines; line numbers are kept beside.

    comments  lines between them, where the keyword has names in comments, without the asterisks
    """

    keyword: Keyword
    options: Options
    source: Source
    lines: list[str] = field(default_factory=list)
    comments: list[tuple[str, Source]] = field(default_factory=list)
    _numbers: list[int] = field(default_factory=list)
    _files: list[str] = field(default_factory=list)
    _starts: list[int] = field(default_factory=list)

    @property
    def name(self) -> str:
        """Keyword name."""
        return self.keyword.name

    def extend(self, lines: list[str], file: str, first: int) -> None:
        """Add data lines of a file that follow each other, the first with this number."""
        if not self._files or self._files[-1] != file:
            self._files.append(file)
            self._starts.append(len(self.lines))
        self.lines += lines
        self._numbers += range(first, first + len(lines))

    def trim(self) -> None:
        """Drop blank lines at the end."""
        while self.lines and not self.lines[-1]:
            self.lines.pop()
            self._numbers.pop()

    def clear(self) -> None:
        """Drop the data lines."""
        self.lines, self._numbers, self._files, self._starts = [], [], [], []

    def source_of(self, index: int) -> Source:
        """Return the place of a data line in the deck."""
        return Source(self._files[bisect.bisect_right(self._starts, index) - 1], self._numbers[index])

    def row(self, index: int) -> Row:
        """Return one data line, cut into fields."""
        fields = split_fields(self.lines[index])
        while fields and not fields[-1]:
            fields.pop()
        return Row(self.name, tuple(fields), self.source_of(index))

    def rows(self) -> Iterator[Row]:
        """Yield the data lines that are not blank."""
        return (self.row(index) for index, line in enumerate(self.lines) if line.strip(", \t"))

    def entries(self, warn: Callable[[Source, str], None]) -> list[tuple[Row, int]]:
        """Return row and position in it of values that are written eight to a line:
        each line but the last counts eight.

        warn: gets told of a line with fewer that is not the last, whose other entries are zero, and of one with more,
        all of which are used.
        """
        rows = list(self.rows())
        places: list[tuple[Row, int]] = []
        for row in rows:
            count = len(row) if row is rows[-1] else max(PER_LINE, len(row))
            if len(row) < count:
                left_out = f"values {len(places) + len(row) + 1} to {len(places) + count}"
                warn(row.source, f"*{self.name}: a line has eight values; those missing here, {left_out}, are zero")
            elif count > PER_LINE:
                warn(row.source, f"*{self.name}: a line has eight values; all {count} of this one are used")
            places += [(row, index) for index in range(count)]
        return places

    def all_rows(self) -> Iterator[Row]:
        """Yield all data lines, including blank ones, which stand for defaults."""
        return (self.row(index) for index in range(len(self.lines)))

    def only_row(self) -> Row | None:
        """Return the only data line of a keyword, None if it is left out. Raises DeckError if there are several."""
        rows = list(self.all_rows())
        if len(rows) > 1:
            raise rows[1].error("a second data line, expected only one")
        return rows[0] if rows else None

    def error(self, message: str) -> DeckError:
        """Make an error at the keyword line."""
        return DeckError(self.source, f"*{self.name}: {message}")
