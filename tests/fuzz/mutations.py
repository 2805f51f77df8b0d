# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Damage to a deck: what editors, scripts, mail and hurried hands do to one, and a little worse."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from random import Random

from harness.deck.keywords import KEYWORDS
from harness.deck.table import Keyword, Kind

NUMBERS = (
    *("", "0", "-1", "1", "-0.", "1e400", "-1e400", "1e308", "1e-320", "NaN", "inf", "-Infinity", "1d5", "1.E", "."),
    *("2147483647", "2147483648", "999999999", "10000000", "1000000", "99999999999999999999", "1_000", "0x1F", "1,5"),
    *("٣", "½", "1 2", "--3", "+", "1e", "True", "1.5", "-7", "3.", "1e5", "1e-300"),
)
WORDS = ("", "X", "ALL", "1", "A.B", "A.1", "..", '"', '"a b"', "=", "<x>", "<", "é", "名前", "x" * 300, "*", "**")
TEXTS = (
    "\t",
    "\u00a0",
    "\ufeff",
    "é",
    "\u2028",
    "\0",
    "\x0c",
    "😀",
    "\x1b[31m",
    "%s",
    "{0}",
    "\\",
    "'",
    '"',
    "<a>",
    "**",
)
FILES = ("deck.inp", ".", "..", "/", "/dev/zero", "/dev/stdin", "nowhere.inp", "", "~", "x" * 300, "a\0b")
_NUMBER = re.compile(r"(?<![\w.])[-+]?\d+\.?\d*(?:[EeDd][-+]?\d+)?")
_NAME = re.compile(r"[A-Za-z_][\w-]{2,}")

Lines = list[str]
Mutation = Callable[[Random, Lines, Sequence[Lines]], None]


def _keyword_lines(lines: Lines) -> list[int]:
    return [index for index, line in enumerate(lines) if line.startswith("*") and not line.startswith("**")]


def _data_lines(lines: Lines) -> list[int]:
    return [index for index, line in enumerate(lines) if line and not line.startswith("*")]


def _block(random: Random, lines: Lines) -> slice:
    """A keyword line with its data lines."""
    heads = _keyword_lines(lines) or [0]
    which = random.randrange(len(heads))
    return slice(heads[which], heads[which + 1] if which + 1 < len(heads) else len(lines))


def drop_line(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A line is missing."""
    del lines[random.randrange(len(lines))]


def double_line(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A line is there twice, or a hundred times."""
    index = random.randrange(len(lines))
    lines[index:index] = [lines[index]] * random.choice((1, 1, 2, 100))


def swap_lines(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """Two lines have changed places."""
    one, other = (random.randrange(len(lines)) for _ in range(2))
    lines[one], lines[other] = lines[other], lines[one]


def drop_block(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A keyword is missing with its data."""
    del lines[_block(random, lines)]


def double_block(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A keyword is there twice."""
    block = _block(random, lines)
    lines[block.start : block.start] = lines[block]


def move_block(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A keyword stands elsewhere."""
    block = _block(random, lines)
    moved = lines[block]
    del lines[block]
    index = random.randint(0, len(lines))
    lines[index:index] = moved


def empty_block(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A keyword without its data."""
    block = _block(random, lines)
    del lines[block.start + 1 : block.stop]


def foreign_block(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A keyword of another deck."""
    other = random.choice(corpus)
    block = other[_block(random, other)][:200]
    index = random.choice([*_keyword_lines(lines), len(lines)])
    lines[index:index] = block


def change_number(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A number is another one, or none."""
    candidates = _data_lines(lines) if random.random() < 0.8 else _keyword_lines(lines)
    if not candidates:
        return
    index = random.choice(candidates)
    found = list(_NUMBER.finditer(lines[index]))
    if found:
        match = random.choice(found)
        value = random.choice((*NUMBERS, f"-{match[0]}", f"{match[0]}0000", str(random.randint(-9, 99))))
        lines[index] = f"{lines[index][: match.start()]}{value}{lines[index][match.end() :]}"


def change_field(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A field of a line is dropped, doubled, exchanged, or another one."""
    index = random.randrange(len(lines))
    fields = lines[index].split(",")
    one, other = (random.randrange(len(fields)) for _ in range(2))
    match random.choice(("drop", "double", "swap", "word", "number", "many", "comma")):
        case "drop":
            del fields[one]
        case "double":
            fields.insert(one, fields[one])
        case "swap":
            fields[one], fields[other] = fields[other], fields[one]
        case "word":
            fields[one] = random.choice(WORDS)
        case "number":
            fields[one] = random.choice(NUMBERS)
        case "many":
            fields += [fields[one]] * 50
        case "comma":
            fields.append("")
    lines[index] = ",".join(fields)


def rename(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A name, of a set for example, is another one in one place."""
    index = random.randrange(len(lines))
    found = list(_NAME.finditer(lines[index]))
    if found:
        match = random.choice(found)
        others = _NAME.findall(random.choice(lines))
        name = random.choice((*WORDS, *others, match[0].lower(), f"{match[0]}x", match[0][1:], match[0][::-1]))
        lines[index] = f"{lines[index][: match.start()]}{name}{lines[index][match.end() :]}"


def damage_keyword(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """An option of a keyword line is lost, doubled, misspelt, or one that the keyword may take elsewhere."""
    heads = _keyword_lines(lines)
    if not heads:
        return
    index = random.choice(heads)
    fields = lines[index].split(",")
    place = random.randrange(len(fields))
    match random.choice(("lose", "double", "cut", "value", "other", "option")):
        case "lose":
            del fields[place]
        case "double":
            fields.append(fields[place])
        case "cut":
            fields[place] = fields[place][: random.randint(0, len(fields[place]))]
        case "value":
            fields[place] = f"{fields[place].split('=')[0]}={random.choice(WORDS + NUMBERS)}"
        case "other":
            fields[0] = f"*{random.choice(list(KEYWORDS.values())).name}"
        case "option":
            fields.append(_option(random, random.choice(list(KEYWORDS.values()))))
    lines[index] = ",".join(fields)


def any_keyword(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A keyword that the reader knows, with some of its options and data lines of any kind."""
    keyword = random.choice(list(KEYWORDS.values()))
    options = [option for option in keyword.options if option.required or random.random() < 0.3]
    head = ", ".join([f"*{keyword.name}", *(_option(random, keyword, option.name) for option in options)])
    words = [*_NAME.findall(random.choice(lines)), *("1", "2", "3", "1."), *random.sample(NUMBERS + WORDS, 3)]
    data = [", ".join(random.choices(words, k=random.randint(1, 9))) for _ in range(random.randint(0, 3))]
    index = random.choice([*_keyword_lines(lines), len(lines)])
    lines[index:index] = [head, *data]


def _option(random: Random, keyword: Keyword, name: str | None = None) -> str:
    """An option of a keyword with a value of its kind, mostly."""
    options = [option for option in keyword.options if name in (None, option.name)]
    if not options:
        return random.choice(WORDS)
    option = random.choice(options)
    values = {
        Kind.FLAG: (None, None, "YES", "NO", "X"),
        Kind.SWITCH: (None, "YES", "NO", "ON"),
        Kind.NAME: ("ALL", "A", "U1", "CPS4", "C3D8", *WORDS),
        Kind.INTEGER: ("1", "2", *NUMBERS),
        Kind.REAL: ("1.", "0.5", *NUMBERS),
        Kind.CHOICE: (*option.choices, *option.refused, "X"),
        Kind.FILE: FILES,
    }
    value = random.choice(values[option.kind])
    return option.name if value is None else f"{option.name}={value}"


def include(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A file that includes itself, is none, or has no end."""
    lines.insert(random.randint(0, len(lines)), f"*INCLUDE, INPUT={random.choice(FILES)}")


def long_line(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A line without end."""
    index = random.randrange(len(lines))
    piece = random.choice(("1,", "x", "*", ",", '"', "<", " ", "(", "1.5, ", "-", "="))
    lines[index] += piece * random.choice((1000, 100_000))


def odd_text(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """Characters that do not belong into a deck."""
    index = random.randrange(len(lines))
    place = random.randint(0, len(lines[index]))
    lines[index] = lines[index][:place] + random.choice(TEXTS) + lines[index][place:]


def tabs(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """Tabs for blanks and behind commas."""
    lines[:] = [line.replace(" ", "\t") for line in lines]


def parameter(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A parameter with an odd expression in place of a number."""
    expressions = ("1/0", "9**9**9", "10.**400", "-x", "'a'*9", "(" * 300, "x", "1e400", "sqrt(-1.)", "1 if 1 else 2")
    expressions += ("int(1e400)", "pow(0.,-1.)", "10**64*10**64", "min()", "floor(1e999)", "atan2(1.)", "2.5", "3")
    lines[0:0] = ["*PARAMETER", f"x = {random.choice(expressions)}"]
    candidates = _data_lines(lines)
    index = random.choice(candidates)
    lines[index] = _NUMBER.sub("<x>", lines[index], count=1)


LINE_MUTATIONS: tuple[Mutation, ...] = (
    *(drop_line, double_line, swap_lines, drop_block, double_block, move_block, empty_block, foreign_block),
    *(change_number, change_number, change_number, change_field, change_field, rename, rename, damage_keyword),
    *(damage_keyword, any_keyword, any_keyword, any_keyword, include, long_line, odd_text, tabs, parameter),
)


def mutate(random: Random, text: str, corpus: Sequence[Lines]) -> bytes:
    """A deck with one to four kinds of damage, as bytes; some are cut off, or have other line ends."""
    lines = text.split("\n")
    for _ in range(random.choice((1, 1, 1, 2, 2, 3, 4))):
        random.choice(LINE_MUTATIONS)(random, lines, corpus)
        lines = lines or [""]
    end = random.choice(("\n",) * 12 + ("\r\n", "\r", "\n\n"))
    encoding = random.choice(("utf-8",) * 12 + ("utf-8-sig", "utf-16", "latin-1"))
    raw = end.join(lines).encode(encoding, "replace")
    if random.random() < 0.05:
        raw = raw[: random.randint(0, len(raw))]
    if random.random() < 0.03 and raw:
        place = random.randrange(len(raw))
        raw = raw[:place] + random.randbytes(random.randint(1, 8)) + raw[place + 1 :]
    return raw
