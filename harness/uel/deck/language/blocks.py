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


class DeckLine:
    """Keyword line or data line, with factories for errors that refer to it."""

    __slots__ = ()

    def error(self, message: str) -> DeckError:
        """Return an error at this line."""
        raise NotImplementedError

    def unsupported(self, feature: str, supported: Iterable[str] = ()) -> DeckError:
        """Return the error for an unsupported feature; it lists the supported ones."""
        listed = ", ".join(supported)
        return self.error(f"{feature} is not supported{f' (supported: {listed})' if listed else ''}")

    def dependent(self, message: str) -> DeckError:
        """Return the error for extra values, where Abaqus expects temperatures."""
        return self.error(f"{message}; dependence on temperature is not supported")


@dataclass(frozen=True, slots=True)
class Row(DeckLine):
    """One data line: its fields, without trailing empty ones.

    A reader of a field takes its index, from 0, and the name of its quantity for the message of a DeckError.
    """

    keyword: str
    fields: tuple[str, ...]
    source: Source

    def __len__(self) -> int:
        return len(self.fields)

    def blank(self, index: int) -> bool:
        """Return whether the field is empty or beyond the end."""
        return index >= len(self.fields) or not self.fields[index]

    def text(self, index: int, quantity: str) -> str:
        """Return a required field as written. Raises DeckError if it is missing."""
        if self.blank(index):
            raise self.error(f"{quantity} is missing")
        return self.fields[index]

    def name(self, index: int, quantity: str) -> str:
        """Return a required name, normalized for comparison. Raises DeckError if it is missing."""
        return unquote(self.text(index, quantity))

    def real(self, index: int, quantity: str, default: float | None = None) -> float:
        """Return a real number, or the default for an empty field. Raises DeckError."""
        return self._number(read_real, index, quantity, default)

    def positive(self, index: int, quantity: str, default: float | None = None) -> float:
        """Return a real number above zero, or the default for an empty field. Raises DeckError."""
        value = self.real(index, quantity, default)
        if value <= 0:
            raise self.error(f"{quantity} {value:g} must be positive")
        return value

    def not_negative(self, index: int, quantity: str, default: float | None = None) -> float:
        """Return a real number from zero on, or the default for an empty field. Raises DeckError."""
        value = self.real(index, quantity, default)
        if value < 0:
            raise self.error(f"{quantity} {value:g} must not be negative")
        return value

    def integer(self, index: int, quantity: str, default: int | None = None) -> int:
        """Return an integer, or the default for an empty field. Raises DeckError."""
        return self._number(read_integer, index, quantity, default)

    def _number(self, read: Callable[[str], ValueT], index: int, quantity: str, default: ValueT | None) -> ValueT:
        if default is not None and self.blank(index):
            return default
        try:
            return read(self.text(index, quantity))
        except ValueError as error:
            raise self.error(f"{quantity}: {error}") from None

    def reals(self, quantity: str) -> list[float]:
        """Return all fields as real numbers; an empty one is zero. Raises DeckError."""
        return [self.real(index, quantity, 0.0) for index in range(len(self.fields))]

    def at_most(self, count: int) -> None:
        """Refuse more than `count` fields."""
        if len(self.fields) > count:
            raise self.error(f"{len(self.fields)} entries, expected at most {count}")

    def error(self, message: str) -> DeckError:
        """Return an error at this line, with a hint if a keyword line seems to lack its asterisk."""
        first = unquote(self.fields[0]) if self.fields else ""
        hint = f"; is the * of *{first} missing?" if first in ABAQUS_KEYWORDS else ""
        return DeckError(self.source, f"*{self.keyword}: {message}{hint}")


PER_LINE: Final = 8
"""Values per data line of keywords that take any number of values."""


@dataclass(slots=True)
class Block(DeckLine):
    """One keyword with its options and data lines.

    comments  comment lines without the asterisks, of keywords that read names from them
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
        """Add consecutive data lines of a file; first: number of the first one."""
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
        """Return the location of a data line in the deck."""
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
        """Return row and index of each value of a list with eight values per line.

        warn: called for a line but the last with fewer values, which is filled with zeros, and for one with more.
        """
        rows = list(self.rows())
        entries: list[tuple[Row, int]] = []
        for row in rows:
            count = len(row) if row is rows[-1] else max(PER_LINE, len(row))
            if len(row) < count:
                missing = f"values {len(entries) + len(row) + 1} to {len(entries) + count}"
                warn(row.source, f"*{self.name}: a line has eight values; those missing here, {missing}, are zero")
            elif count > PER_LINE:
                warn(row.source, f"*{self.name}: a line has eight values; all {count} of this one are used")
            entries += [(row, index) for index in range(count)]
        return entries

    def all_rows(self) -> Iterator[Row]:
        """Yield all data lines; blank ones mean defaults."""
        return (self.row(index) for index in range(len(self.lines)))

    def required_rows(self, content: str = "") -> list[Row]:
        """Return the data lines that are not blank. Raises DeckError if there are none."""
        rows = list(self.rows())
        if not rows:
            raise self.error(f"needs a data line{content and ' with '}{content}")
        return rows

    def required_row(self, content: str) -> Row:
        """Return the only data line. Raises DeckError if there is none, or if there are several."""
        row = self.only_row()
        if row is None:
            raise self.error(f"needs a data line with {content}")
        return row

    def positive(self, option: str, default: float) -> float:
        """Return the real value of an option, above zero if the line has it. Raises DeckError."""
        value = self.options.real(option, default)
        if self.options.has(option) and value <= 0:
            raise self.error(f"{option}={value:g} must be positive")
        return value

    def not_negative(self, option: str, default: float) -> float:
        """Return the real value of an option, from zero on if the line has it. Raises DeckError."""
        value = self.options.real(option, default)
        if self.options.has(option) and value < 0:
            raise self.error(f"{option}={value:g} must not be negative")
        return value

    def only_row(self) -> Row | None:
        """Return the only data line, None without one. Raises DeckError if there are several."""
        rows = list(self.all_rows())
        if len(rows) > 1:
            raise rows[1].error("a second data line, expected only one")
        return rows[0] if rows else None

    def error(self, message: str) -> DeckError:
        """Return an error at the keyword line."""
        return DeckError(self.source, f"*{self.name}: {message}")
