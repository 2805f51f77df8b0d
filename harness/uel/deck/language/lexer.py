# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Split the text of a deck and its includes into keyword blocks, and substitute parameters."""

from __future__ import annotations

import bisect
import codecs
import re
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path

from uel.deck.error_report import Problems, nearest
from uel.deck.language.abaqus_names import MATERIAL_KEYWORDS
from uel.deck.language.blocks import Block
from uel.deck.language.expressions import Value, assign, find
from uel.deck.language.table import (
    Keyword,
    Kind,
    Option,
    Options,
    Where,
    abaqus_name,
    compact,
    find_keyword,
    ignored,
    read_options,
    refused,
    split_fields,
)
from uel.errors import DeckError, Source, UsageError
from uel.files import read_whole

# other characters that some programs take for line ends; a message of ours is one line
_BLANKS = dict.fromkeys(map(ord, "\v\f\x1c\x1d\x1e\x85\u2028\u2029"), " ")
_UTF16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
DEEPEST = 20
MOST_INCLUDED = 2000
_COMMENT = re.compile(r"(?<=[\s,])\*\*")
_PARAMETER = re.compile(r"<\s*([A-Za-z_]\w*)\s*>")


def read_blocks(
    deck: Path, keywords: Mapping[str, Keyword], problems: Problems, parameters: Mapping[str, Value] | None = None
) -> list[Block]:
    """Read the keyword blocks of a deck in order, against the keyword table.

    parameters: values in place of those in the deck. Errors in the deck go to `problems`. Raises DeckError if the deck
    cannot be read, UsageError for a parameter that it does not define.
    """
    lexer = _read(deck, keywords, problems, parameters or {})
    defined = list(lexer.parameters)
    for name in lexer.overrides:
        if find(name, lexer.parameters) is None:
            raise UsageError(f"--parameter {name}: {unknown_parameter(name, deck, defined)}")
    return lexer.blocks


@dataclass(frozen=True, slots=True)
class Survey:
    """Files and parameters of a deck.

    files       the deck, then the files that it includes
    parameters  names that it defines, in order
    depends     whether its parameters choose the files
    """

    files: tuple[Path, ...]
    parameters: tuple[str, ...]
    depends: bool


@dataclass(frozen=True, slots=True)
class Passage:
    """Consecutive lines of a deck, unchanged and in the order of reading, included files in place.

    block  keyword of these lines; None for comments and *INCLUDE
    first  index of the first line among the data lines of the block; -1 for its keyword line
    """

    block: Block | None
    first: int
    lines: Sequence[str]


def read_passages(
    files: Sequence[Path], keywords: Mapping[str, Keyword], problems: Problems, made: Mapping[Path, list[str]]
) -> tuple[list[Block], list[Passage]]:
    """Read the keyword blocks and the text of consecutive decks, for a program that rewrites them.

    made: lines of files that are not on the disk. Errors go to `problems`. Raises DeckError if a deck cannot be read.
    """
    lexer = _Lexer(files[-1], keywords, problems, {})
    for file in files:
        lexer.read(made[file] if file in made else _load(file, Source(str(file), 0)), str(file), (file.resolve(),))
    lexer.close()
    return lexer.blocks, lexer.passages


def survey_blocks(deck: Path, keywords: Mapping[str, Keyword], parameters: Mapping[str, Value] | None = None) -> Survey:
    """Return files and parameters of a deck, as far as it can be read. Raises DeckError if it cannot be opened."""
    lexer = _read(deck, keywords, Problems(), parameters or {})
    return Survey((deck, *dict.fromkeys(lexer.included)), tuple(lexer.parameters), lexer.depends)


def unknown_parameter(name: str, deck: Path, defined: Sequence[str]) -> str:
    """Return the message about a parameter that a deck does not define."""
    has = f"its parameters are {', '.join(defined)}{nearest(name, defined)}" if defined else "it has no *PARAMETER"
    return f"{deck} defines no parameter of this name; {has}"


def _read(deck: Path, keywords: Mapping[str, Keyword], problems: Problems, parameters: Mapping[str, Value]) -> _Lexer:
    lexer = _Lexer(deck, keywords, problems, parameters)
    start = Source(str(deck), 0)
    lines = _load(deck, start)
    if not any(line and not line.startswith("**") for line in lines):
        raise DeckError(Source(str(deck), 1), "the deck is empty")
    lexer.read(lines, str(deck), (deck.resolve(),))
    lexer.close()
    return lexer


def _load(path: Path, source: Source) -> list[str]:
    """Return the stripped lines of a text file in UTF-8 or Latin-1, with any line end. Raises DeckError."""
    # line 0: the deck itself, which has no location if it cannot be opened; else the location is that of *INCLUDE
    name = str(path) if source.line else "the file"
    try:
        raw = read_whole(path)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise DeckError(source, f"cannot read {name}: {reason}") from None
    except ValueError as error:
        raise DeckError(source, f"cannot read {name}: {error}") from None
    source = source if source.line else Source(source.file, 1)
    if raw.startswith(_UTF16):
        raise DeckError(source, f"{path} is UTF-16 text, which Abaqus does not read: save it as UTF-8")
    if b"\0" in raw:
        raise DeckError(source, f"{path} is a binary file, not a deck")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    lines = text.replace("\r\n", "\n").replace("\r", "\n").translate(_BLANKS).split("\n")
    return [line.strip() for line in lines]


@dataclass(slots=True)
class _Header:
    """Keyword line with its continuation lines, and its location."""

    text: str
    source: Source
    lines: list[str]


class _Lexer:
    """Lexer of the lines of a deck and its includes."""

    def __init__(
        self, deck: Path, keywords: Mapping[str, Keyword], problems: Problems, overrides: Mapping[str, Value]
    ) -> None:
        self.blocks: list[Block] = []
        self.passages: list[Passage] = []
        self.parameters: dict[str, Value] = {}
        self.overrides = overrides
        self.included: list[Path] = []
        self.depends = False
        self._folder = deck.parent
        self._keywords = keywords
        self._problems = problems
        self._open: Block | None = None
        self._discard = False
        self._commented = False
        self._material = ""

    def read(self, lines: list[str], file: str, stack: tuple[Path, ...]) -> None:
        """Read all lines of one file."""
        stars = [index for index, line in enumerate(lines) if line.startswith("*")]
        stars.append(len(lines))
        number = 0
        while number < len(lines):
            line = lines[number]
            if not line.startswith("*"):
                stop = stars[bisect.bisect_left(stars, number)]
                first = len(self._open.lines) if self._open is not None else 0
                self.passages.append(Passage(self._open, first, lines[number:stop]))
                self._data(lines[number:stop], file, number + 1)
                number = stop
                continue
            number += 1
            if line.startswith("**"):
                if self._open is not None and self._open.keyword.comments:
                    self._open.comments.append((line.lstrip("*").strip(), Source(file, number)))
                self.passages.append(Passage(None, 0, [line]))
            else:
                self.close()
                header = _Header(line, Source(file, number), [line])
                number = self._join(header, lines, number)
                with self._gather(header):
                    self._keyword(header, stack)

    def close(self) -> None:
        """End the open block; evaluate the statements of *PARAMETER, for the lines that follow."""
        block = self._open
        if block is None:
            return
        block.trim()
        if block.keyword.name == "PARAMETER":
            for index, line in enumerate(block.lines):
                statement = line.split("#")[0]
                if statement.strip():
                    with self._problems.gather():
                        self._assign(statement, block.source_of(index))
            block.clear()

    def _assign(self, statement: str, source: Source) -> None:
        try:
            name, value = assign(statement, self.parameters)
        except ValueError as error:
            self.parameters.setdefault(statement.partition("=")[0].strip(), 0.0)
            raise DeckError(source, f"*PARAMETER: {error}") from None
        override = find(name, self.overrides)
        if override is not None:
            # a real parameter stays real: with 5 in place of 2. length/2 would be a quotient of integers
            value = float(override) if isinstance(value, float) else override
        self.parameters[name] = value

    def _data(self, lines: list[str], file: str, first: int) -> None:
        """Read consecutive data lines; first: number of the first one."""
        if self._open is None:
            index = next((k for k, line in enumerate(lines) if line), None)
            if index is not None and not self._discard:
                self._problems.add(
                    Source(file, first + index), "data before the first keyword; a comment begins with **"
                )
                self._discard = True
            return
        if self._open.keyword.name not in ("HEADING", "PARAMETER"):
            text = "\n".join(lines)
            if "<" in text or "**" in text:
                lines = [self._plain(line, Source(file, number)) for number, line in enumerate(lines, start=first)]
        self._open.extend(lines, file, first)

    def _plain(self, line: str, source: Source) -> str:
        """Return a data line without trailing comment, with parameters substituted."""
        line = self._uncommented(line, source)
        if "<" in line:
            with self._problems.gather():
                return self._substitute(line, source)
        return line

    def _uncommented(self, line: str, source: Source) -> str:
        """Strip the trailing comment of a data line, as Abaqus does; warn at the first one."""
        comment = _COMMENT.search(line) if "**" in line else None
        if comment is None:
            return line
        if not self._commented:
            self._problems.warn(source, "text after ** in a data line counts as a comment, here and in all later lines")
        self._commented = True
        return line[: comment.start()].rstrip()

    def _substitute(self, line: str, source: Source) -> str:
        def value(match: re.Match[str]) -> str:
            parameter = find(match[1], self.parameters)
            if parameter is None:
                raise DeckError(source, f"parameter <{match[1]}> is not defined")
            return str(parameter)

        return _PARAMETER.sub(value, line)

    def _join(self, header: _Header, lines: list[str], number: int) -> int:
        """Join the continuation lines of a keyword line, and return the number of the line after them."""
        while header.text.endswith(",") and number < len(lines):
            ahead = number
            while ahead < len(lines) - 1 and lines[ahead].startswith("**"):
                ahead += 1
            line = lines[ahead]
            if not self._continues(header.text, line):
                break
            header.text += line
            header.lines += lines[number : ahead + 1]
            number = ahead + 1
        return number

    def _continues(self, header: str, line: str) -> bool:
        """Return whether a line continues a keyword line that ends in a comma, or is a data line."""
        if not line or line.startswith("*"):
            return False
        first = split_fields(line)[0]
        if "=" in first:
            return True
        try:
            keyword = find_keyword(self._keywords, split_fields(header[1:])[0], Source("", 0))
        except DeckError:
            return False
        return any(compact(option.name) == compact(first) for option in keyword.options)

    def _gather(self, header: _Header) -> AbstractContextManager[None]:
        """Return the context that records the errors of a keyword line, for a material those of the material."""
        name = abaqus_name(split_fields(header.text[1:])[0])
        if name in MATERIAL_KEYWORDS and self._material:
            return self._problems.gather_of(self._material)
        if name != "INCLUDE":
            self._material = ""
        return self._problems.gather()

    def _keyword(self, header: _Header, stack: tuple[Path, ...]) -> None:
        """Open the block of a keyword line, or read the file it includes."""
        self._discard, previous, self._open = True, self._open, None
        source = header.source
        text = self._substitute(header.text, source)
        self.depends |= text != header.text and "INPUT" in text.upper()
        fields = split_fields(text[1:])
        try:
            keyword = find_keyword(self._keywords, fields[0], source)
        except DeckError:
            # it may belong to an unused material
            self.passages.append(Passage(None, 0, header.lines))
            raise
        if keyword.name == "INCLUDE":
            self._open = previous
            self.passages.append(Passage(None, 0, [f"** {line}" for line in header.lines]))
            options = read_options(keyword, fields[1:], source)
            names = [option.name for option in keyword.options if option.name in options.values]
            if len(names) != 1:
                problem = "takes one of INPUT and FILE" if names else "needs the option INPUT"
                raise DeckError(source, f"*INCLUDE {problem}")
            self._include(options.text(names[0]), source, stack)
            return
        self._open = Block(keyword, Options(keyword), source)
        self.blocks.append(self._open)
        self.passages.append(Passage(self._open, -1, header.lines))
        # keep a block with a wrong option: a wrong *STEP must not cause errors in all keywords after it
        self._open.options = options = _options(keyword, fields[1:], source)
        if keyword.name == "MATERIAL":
            self._material = options.text("NAME")
        if options.known("INPUT") and options.has("INPUT"):
            self._include(options.text("INPUT"), source, stack)

    def _include(self, name: str, source: Source, stack: tuple[Path, ...]) -> None:
        """Read an included file; the open block stays open, since the file may begin with data lines."""
        try:
            path = self._find(name, stack[-1], source)
            resolved = path.resolve()
        except OSError as error:
            raise DeckError(source, f"cannot read {name}: {error.strerror or type(error).__name__}") from None
        except (ValueError, RuntimeError) as error:
            raise DeckError(source, f"cannot read {name}: {error}") from None
        if resolved in stack:
            loop = " -> ".join(entry.name for entry in (*stack[stack.index(resolved) :], resolved))
            raise DeckError(source, f"include loop: {loop}")
        self.included.append(path)
        if len(stack) > DEEPEST or len(self.included) > MOST_INCLUDED:
            # nested includes can multiply without limit
            limit = f"{MOST_INCLUDED} of them are" if len(stack) <= DEEPEST else f"{DEEPEST} within each other are"
            raise DeckError(source, f"too many included files: {limit} read")
        self.read(_load(path, source), str(path), (*stack, resolved))

    def _find(self, name: str, including: Path, source: Source) -> Path:
        """Return the path of an included file; warn if Abaqus, which searches the current folder only, would fail."""
        here, beside_deck, beside_including = Path(name), self._folder / name, including.parent / name
        if not here.exists():
            in_deck_folder = beside_deck.exists() or not beside_including.exists()
            path = beside_deck if in_deck_folder else beside_including
            if path.exists() and not self._problems.differences:
                # one message is enough: the other files are in the same folder
                there = "beside the deck" if in_deck_folder else "beside the including file"
                advice = f"submit it in {self._folder}" if in_deck_folder else "name it as seen from the deck"
                only = "only in the folder where the job is submitted"
                self._problems.differ(source, f"Abaqus looks for {name} {only}, not {there}: {advice}")
            return path
        if not beside_deck.exists():
            return here
        if not beside_deck.samefile(here):
            self._problems.warn(source, f"{name} is that of the current folder, as in Abaqus, not {beside_deck}")
            return here
        # name it relative to the deck, as messages do
        return beside_deck


def _options(keyword: Keyword, fields: list[str], source: Source) -> Options:
    """Return the options of a keyword; those of an ignored one are not examined."""
    return read_options(keyword, fields, source) if keyword.options or keyword.support == "read" else Options(keyword)


KEYWORDS = (
    Keyword(
        "INCLUDE",
        "Read another file at this place. Abaqus looks for it in the folder where the job is submitted; so does the "
        "harness, and then beside the deck and beside the including file, with a warning in .dat.",
        Where.ANY,
        (
            Option("INPUT", Kind.FILE, "file"),
            Option("FILE", Kind.FILE, "the same, for decks that Abaqus runs although no manual has it"),
            *refused("PASSWORD"),
        ),
    ),
    Keyword(
        "PARAMETER",
        "Define parameters; `<name>` on any later line stands for the value.",
        Where.ANY,
        (*ignored("INDEPENDENT"), *refused("DEPENDENT", "TABLE")),
        "name = arithmetic expression in Python's spelling",
    ),
)
