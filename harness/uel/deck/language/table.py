# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Entries of the keyword table, and the reading of keyword lines against it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from functools import lru_cache

from uel.deck.error_report import nearest
from uel.deck.language.abaqus_names import ABAQUS_KEYWORDS
from uel.deck.language.numbers import read_integer, read_real
from uel.errors import DeckError, Source


class Kind(StrEnum):
    """Type of the value of an option."""

    FLAG = "flag"
    SWITCH = "YES or NO"
    NAME = "name"
    INTEGER = "integer"
    REAL = "real"
    CHOICE = "choice"
    FILE = "file"


class Support(StrEnum):
    """Treatment of a keyword or an option by the reader."""

    READ = "read"
    IGNORED = "cannot change the solution: listed and ignored"
    REFUSED = "refused"


class Where(StrEnum):
    """Part of the deck a keyword belongs to."""

    MODEL = "model"
    STEP = "step"
    ANY = "model or step"


@dataclass(frozen=True, slots=True)
class Option:
    """One option of a keyword line.

    doc       description for `keywords.md`
    required  whether the line must have it
    default   value without the option; '' for none
    choices   values of Kind.CHOICE
    refused   values of Abaqus that are not supported
    bare      value of the option without `=`; '' if a value is required
    """

    name: str
    kind: Kind = Kind.FLAG
    doc: str = ""
    required: bool = False
    default: str = ""
    choices: tuple[str, ...] = ()
    refused: tuple[str, ...] = ()
    support: Support = Support.READ
    bare: str = ""


@dataclass(frozen=True, slots=True)
class Keyword:
    """One keyword.

    doc      description for `keywords.md`
    data     content of the data lines, '' without data lines
    comments content of comments among them, '' where comments are skipped
    support  IGNORED: it cannot change the solution, and is not read
    """

    name: str
    doc: str
    where: Where
    options: tuple[Option, ...] = ()
    data: str = ""
    support: Support = Support.READ
    comments: str = ""


INPUT = Option("INPUT", Kind.FILE, "file that holds the data lines")
NAME = Option("NAME", Kind.NAME, "name", required=True)


def one_of(
    name: str,
    doc: str,
    choices: tuple[str, ...],
    *,
    default: str = "",
    required: bool = False,
    refused: tuple[str, ...] = (),
    bare: str = "",
) -> Option:
    """Make an option whose value is one of these choices; the parameters are entries of `Option`."""
    return Option(name, Kind.CHOICE, doc, required, default, choices, refused, bare=bare)


def refused(*names: str) -> tuple[Option, ...]:
    """Make options that Abaqus has and that would change the solution: they are refused."""
    return tuple(Option(name, support=Support.REFUSED) for name in names)


def ignored(*names: str) -> tuple[Option, ...]:
    """Make options that cannot change the solution: they are ignored."""
    return tuple(Option(name, support=Support.IGNORED) for name in names)


@dataclass(frozen=True, slots=True)
class Options:
    """Options of one keyword line, checked against the table; names are those of the table.

    Each look-up raises LookupError for an option or kind that is not in the table: an error of the reader, not of the
    deck.
    """

    keyword: Keyword
    values: dict[str, str] = field(default_factory=dict)

    def known(self, name: str) -> bool:
        """Return whether the keyword has this option, for code that reads several keywords."""
        return any(option.name == name and option.support is Support.READ for option in self.keyword.options)

    def flag(self, name: str) -> bool:
        """Return whether the flag or switch is on."""
        return (self._value(name, Kind.FLAG, Kind.SWITCH) or "NO") != "NO"

    def has(self, name: str) -> bool:
        """Return whether the option is on the line."""
        return self._value(name, *Kind) is not None

    def text(self, name: str) -> str:
        """Return a name, choice or file; the default, or '', if the option is absent."""
        return self._value(name, Kind.NAME, Kind.CHOICE, Kind.FILE) or ""

    def real(self, name: str, default: float) -> float:
        """Return a real value; `default` if neither the line nor the table gives one."""
        value = self._value(name, Kind.REAL)
        return default if value is None else read_real(value)

    def integer(self, name: str, default: int) -> int:
        """Return an integer value; `default` if neither the line nor the table gives one."""
        value = self._value(name, Kind.INTEGER)
        return default if value is None else read_integer(value)

    def _value(self, name: str, *kinds: Kind) -> str | None:
        """Return the text on the line, or the default of the table; None if there is neither."""
        for option in self.keyword.options:
            if option.name == name and option.kind in kinds and option.support is Support.READ:
                return self.values.get(name)
        raise LookupError(
            f"*{self.keyword.name} has no option {name} of kind {' or '.join(kinds)} in the keyword table"
        )


@lru_cache(4096)
def compact(word: str) -> str:
    """Return a word normalized for comparison: upper case, without blanks."""
    return "".join(word.split()).upper()


def split_fields(line: str) -> list[str]:
    """Split a line at its commas and strip the fields; commas within quotes do not separate."""
    if '"' not in line:
        return [text.strip() for text in line.split(",")]
    fields = [""]
    for number, text in enumerate(re.split(r'("[^"]*")', line)):
        first, *others = [text] if number % 2 else text.split(",")
        fields[-1] += first
        fields += others
    return [field.strip() for field in fields]


def unquote(name: str) -> str:
    """Return a name normalized for comparison: without quotes, in upper case, with single blanks."""
    return " ".join(name.replace('"', "").split()).upper()


_REASONS = {
    "CONTACT STABILIZATION": ": it is damping that depends on sizes of the surfaces which Abaqus does not describe",
}
"""Reasons why keywords of Abaqus are not supported, and supported alternatives."""

_ABAQUS = {compact(name): name for name in ABAQUS_KEYWORDS}


def abaqus_name(name: str) -> str:
    """Return the Abaqus keyword of this name, or the only one that begins with it; '' if there is none."""
    word = compact(name)
    matches = [word] if word in _ABAQUS else [full for full in _ABAQUS if word and full.startswith(word)]
    return _ABAQUS[matches[0]] if len(matches) == 1 else ""


def find_keyword(keywords: Mapping[str, Keyword], name: str, source: Source) -> Keyword:
    """Return the keyword of this name, or the only one of Abaqus that begins with it. Raises DeckError."""
    word = compact(name)
    if not word:
        raise DeckError(source, "a keyword line without a keyword; a comment begins with **")
    word = compact(abaqus_name(name)) or word
    if word in keywords:
        return keywords[word]
    if word in _ABAQUS:
        raise DeckError(source, f"*{_ABAQUS[word]} is not supported{_REASONS.get(_ABAQUS[word], '')}")
    known = {keyword.name for keyword in keywords.values()} | ABAQUS_KEYWORDS
    raise DeckError(source, f"unknown keyword *{name.strip()}{nearest(name.strip().upper(), known)}")


def read_options(keyword: Keyword, fields: list[str], source: Source) -> Options:
    """Read the options of a keyword line. Raises DeckError for an unknown, missing, ill-typed or unsupported one."""
    values: dict[str, str] = {}
    for text in fields:
        if not text:
            continue
        name, equals, value = text.partition("=")
        option = _find_option(keyword, name, source)
        if option.support is Support.REFUSED:
            raise DeckError(source, f"*{keyword.name}: option {option.name} is not supported")
        if option.support is Support.READ:
            values[option.name] = _read_value(keyword, option, value.strip() if equals else None, source)
    for option in keyword.options:
        if option.required and option.name not in values:
            raise DeckError(source, f"*{keyword.name} needs the option {option.name}")
        if option.default:
            values.setdefault(option.name, option.default)
    return Options(keyword, values)


def _find_option(keyword: Keyword, name: str, source: Source) -> Option:
    """Return the option of this name, or the only one that begins with it. Raises DeckError."""
    word = compact(name)
    matches = [option for option in keyword.options if word and compact(option.name).startswith(word)]
    exact = [option for option in matches if compact(option.name) == word]
    if exact or len(matches) == 1:
        return (exact or matches)[0]
    if matches:
        names = " or ".join(option.name for option in matches)
        raise DeckError(source, f"*{keyword.name}: option {name.strip()} is ambiguous ({names}); write it out")
    known = [option.name for option in keyword.options if option.support is not Support.REFUSED]
    takes = f"; it takes {', '.join(known)}" if known else "; it takes none"
    hint = nearest(name.strip().upper(), [option.name for option in keyword.options]) or takes
    raise DeckError(source, f"*{keyword.name}: unknown option {name.strip()}{hint}")


def _read_value(keyword: Keyword, option: Option, value: str | None, source: Source) -> str:
    option_text = f"*{keyword.name}, {option.name}"
    if option.kind is Kind.FLAG:
        if value and value.upper() not in ("YES", "NO"):
            raise DeckError(source, f"{option_text} takes no value, found '{value}'")
        return (value or "YES").upper()
    if option.kind is Kind.SWITCH:
        return (
            _choose(option_text, value or "YES", ("YES", "NO", "ON", "OFF"), (), source)
            .replace("ON", "YES")
            .replace("OFF", "NO")
        )
    value = value or option.bare
    # quotes around nothing are none
    if not value or not value.strip('" '):
        raise DeckError(source, f"{option_text} needs a value")
    if option.kind is Kind.CHOICE:
        return _choose(option_text, value, option.choices, option.refused, source)
    if option.kind is Kind.FILE:
        return value.strip('"')
    if option.kind is Kind.NAME:
        return unquote(value)
    try:
        return str(read_integer(value)) if option.kind is Kind.INTEGER else repr(read_real(value))
    except ValueError as error:
        raise DeckError(source, f"{option_text}: {error}") from None


def _choose(option_text: str, value: str, choices: tuple[str, ...], refused: tuple[str, ...], source: Source) -> str:
    word = compact(value.replace('"', ""))
    matches = [choice for choice in choices + refused if compact(choice).startswith(word)]
    exact = [choice for choice in matches if compact(choice) == word]
    if not exact and len(matches) != 1:
        raise DeckError(
            source, f"{option_text}={value}: expected one of {', '.join(choices)}{nearest(value.upper(), choices)}"
        )
    chosen = (exact or matches)[0]
    if chosen in refused:
        raise DeckError(source, f"{option_text}={chosen} is not supported (supported: {', '.join(choices)})")
    return chosen
