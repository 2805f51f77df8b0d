# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Damage to a deck: what editors, scripts, mail and hurried users do to one, and a little worse."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from random import Random

from uel.deck.keywords import KEYWORDS
from uel.deck.language.table import Keyword, Kind

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
ODD_FILES = ("pipe", "socket", "loop", "nowhere", "folder")
"""Names without a regular file behind them: a trial finds these next to its deck."""
FILES = (
    *("deck.inp", ".", "..", "/", "/dev/zero", "/dev/stdin", "nowhere.inp", "", "~", "x" * 300, "a\0b", *ODD_FILES),
    *("/dev/random", "/dev/full", "/dev/null", "/dev/tty", "/proc/kmsg", "/proc/kcore", "/proc/self/mem", "/dev/fd/0"),
    *("/proc/self/fd/0", "/proc/self/cwd/deck.inp", "folder/../deck.inp", "part.inc", "part.inc/x", "%00", "C:\\a.inp"),
)
EXPRESSIONS = (
    *("1/0", "9**9**9", "9**9**9**9", "10.**400", "-x", "'a'*9", "'a'*9999999", "(" * 300, "x", "1e400", "sqrt(-1.)"),
    *(
        "1 if 1 else 2",
        "int(1e400)",
        "pow(0.,-1.)",
        "pow(9,9e9)",
        "10**64*10**64",
        "min()",
        "floor(1e999)",
        "atan2(1.)",
    ),
    *("2.5", "3", "9" * 1500, "-" * 1500 + "1", "+".join(["x"] * 700), "x*x*x*x*x*x", "1<<99999999", "[0]*999999999"),
    *("'%999999999d' % 1", "f'{1:999999999}'", "{}", "lambda: 1", "x.y", "x[0]", "(1).__class__", "'<y>'", "1e5**64"),
    *(
        "abs(" * 90 + "1" + ")" * 90,
        "9**9**x",
        "int('9'*4000)",
        "max(1,2,)",
        "1j",
        "~5",
        "not x",
        "x = 2",
        "pi",
        "PI*2",
    ),
    *("__import__('os')", "exp(709)*exp(709)", "0.**-1", "-8.**(1./3)", "9**64**64", "2**-64", "1//0.", "5 % 0", "x@x"),
)
_NUMBER = re.compile(r"(?<![\w.])[-+]?\d+\.?\d*(?:[EeDd][-+]?\d+)?")
_NAME = re.compile(r"[A-Za-z_][\w-]{2,}")

ALL_KEYWORDS = tuple(KEYWORDS.values())

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
    """A line occurs twice, or a hundred times."""
    index = random.randrange(len(lines))
    lines[index:index] = [lines[index]] * random.choice((1, 1, 2, 100))


def swap_lines(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """Two lines are swapped."""
    one, other = (random.randrange(len(lines)) for _ in range(2))
    lines[one], lines[other] = lines[other], lines[one]


def drop_block(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A keyword is missing with its data."""
    del lines[_block(random, lines)]


def double_block(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A keyword occurs twice."""
    block = _block(random, lines)
    lines[block.start : block.start] = lines[block]


def move_block(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A keyword is in another place."""
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
    """A number changes, or becomes something else."""
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
    """A field of a line is dropped, doubled, swapped or replaced."""
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
    """A name, of a set for example, differs in one place."""
    index = random.randrange(len(lines))
    found = list(_NAME.finditer(lines[index]))
    if found:
        match = random.choice(found)
        others = _NAME.findall(random.choice(lines))
        name = random.choice((*WORDS, *others, match[0].lower(), f"{match[0]}x", match[0][1:], match[0][::-1]))
        lines[index] = f"{lines[index][: match.start()]}{name}{lines[index][match.end() :]}"


def damage_keyword(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """An option of a keyword line is lost, doubled, misspelt, or changed, or the keyword is another one."""
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
            fields[0] = f"*{random.choice(ALL_KEYWORDS).name}"
        case "option":
            fields.append(_option(random, random.choice(ALL_KEYWORDS)))
    lines[index] = ",".join(fields)


def any_keyword(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A keyword that the reader knows, with some of its options and data lines of any kind."""
    keyword = random.choice(ALL_KEYWORDS)
    options = [option for option in keyword.options if option.required or random.random() < 0.3]
    head = ", ".join([f"*{keyword.name}", *(_option(random, keyword, option.name) for option in options)])
    words = [*_NAME.findall(random.choice(lines)), *("1", "2", "3", "1."), *random.sample(NUMBERS + WORDS, 3)]
    data = [", ".join(random.choices(words, k=random.randint(1, 9))) for _ in range(random.randint(0, 3))]
    index = random.choice([*_keyword_lines(lines), len(lines)])
    lines[index:index] = [head, *data]


def _option(random: Random, keyword: Keyword, name: str | None = None) -> str:
    """An option of a keyword, usually with a value of the right kind."""
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
    """An included file that includes itself, is not a regular file, or never ends."""
    lines.insert(random.randint(0, len(lines)), f"*INCLUDE, INPUT={random.choice(FILES)}")


def long_line(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A line without end."""
    index = random.randrange(len(lines))
    piece = random.choice(("1,", "x", "*", ",", '"', "<", " ", "(", "1.5, ", "-", "="))
    lines[index] += piece * random.choice((1000, 100_000))


def odd_text(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """Characters that do not belong in a deck."""
    index = random.randrange(len(lines))
    place = random.randint(0, len(lines[index]))
    lines[index] = lines[index][:place] + random.choice(TEXTS) + lines[index][place:]


def tabs(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """Tabs instead of blanks and after commas."""
    lines[:] = [line.replace(" ", "\t") for line in lines]


def parameter(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A parameter with an odd expression instead of a number."""
    statements = [f"x = {random.choice(EXPRESSIONS)}" for _ in range(random.choice((1, 1, 2, 60)))]
    lines[0:0] = ["*PARAMETER", *statements]
    candidates = _data_lines(lines)
    index = random.choice(candidates)
    lines[index] = _NUMBER.sub("<x>", lines[index], count=1)


def continue_line(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A line continues on the next one, or seems to."""
    index = random.randrange(len(lines))
    commas = [place for place, character in enumerate(lines[index]) if character == ","]
    if commas:
        cut = random.choice(commas) + random.randint(0, 1)
        between = random.choice(((), (), (), ("",), ("** between",), (",",), ("*",)))
        lines[index : index + 1] = [lines[index][:cut], *between, lines[index][cut:]]


def join_lines(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A line break is lost."""
    index = random.randrange(len(lines))
    lines[index : index + 2] = ["".join(lines[index : index + 2])]


def relabel(random: Random, lines: Lines, corpus: Sequence[Lines]) -> None:
    """A node or element number changes wherever it occurs, up to values that do not fit in 32 bits."""
    candidates = [index for index in _data_lines(lines) if lines[index].lstrip()[:1].isdigit()]
    if not candidates:
        return
    old = lines[random.choice(candidates)].split(",")[0].strip()
    near = random.choice((10**9, 2**31, 2**32, 2**53, 2**63, 10**7))
    new = random.choice((str(near + random.randint(-2, 2)), f"{old}e0", f"{old}.", f"+{old}", f"0{old}", f"{old}.5"))
    pattern = re.compile(rf"(?<![\w.+-]){re.escape(old)}(?![\w.])")
    for index in candidates:
        lines[index] = pattern.sub(new, lines[index])


LINE_MUTATIONS: tuple[Mutation, ...] = (
    *(drop_line, double_line, swap_lines, drop_block, double_block, move_block, empty_block, foreign_block),
    *(change_number, change_number, change_number, change_field, change_field, rename, rename, damage_keyword),
    *(damage_keyword, any_keyword, any_keyword, any_keyword, include, long_line, odd_text, tabs, parameter),
    *(continue_line, join_lines, relabel),
)
ENCODINGS = ("utf-8",) * 12 + ("utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "latin-1", "cp1252", "utf-32")


def grow_tree(random: Random, files: dict[str, Lines]) -> None:
    """Move blocks of lines into separate files and include these in their place; some includes form a cycle."""
    for number in range(random.choice((1, 1, 2, 3, 6))):
        lines = files[random.choice(list(files))]
        start = random.randint(0, len(lines))
        stop = random.choice((start, len(lines), random.randint(start, len(lines))))
        name = random.choice((f"part{number}.inc", f"sub/part{number}.inc", f"sub/a b{number}.inc", f"é{number}.inc"))
        head = random.choice(("*INCLUDE, INPUT={}", "*include,input={}", '*INCLUDE, INPUT="{}"', "*INCLUDE,\nINPUT={}"))
        heads = [head.format(name)] * random.choice((1, 1, 1, 2))
        files[name] = lines[start:stop]
        lines[start:stop] = [line for text in heads for line in text.split("\n")]
    if random.random() < 0.2:
        one, other = (random.choice(list(files)) for _ in range(2))
        files[one].insert(random.randint(0, len(files[one])), f"*INCLUDE, INPUT={other}")


def encode(random: Random, lines: Lines) -> bytes:
    """The bytes of a file: truncated, or with other line ends or encodings, or with byte order marks in odd places."""
    end = random.choice(("\n",) * 12 + ("\r\n", "\r", "\n\n", "\n\r"))
    raw = end.join(lines).encode(random.choice(ENCODINGS), "replace")
    if random.random() < 0.05:
        raw = raw[: random.randint(0, len(raw))]
    if random.random() < 0.03 and raw:
        place = random.randrange(len(raw))
        raw = raw[:place] + random.randbytes(random.randint(1, 8)) + raw[place + 1 :]
    if random.random() < 0.03:
        raw = random.choice((b"\xef\xbb\xbf", b"\xff\xfe", b"\xfe\xff", b"\xef\xbb", b"\xef\xbb\xbf" * 2)) + raw
    return raw


def mutate(random: Random, files: dict[str, str], deck: str, corpus: Sequence[Lines]) -> dict[str, bytes]:
    """The files of a deck, one of them with one to four kinds of damage, some spread over more files."""
    included = [name for name in files if name != deck]
    damaged = random.choice(included) if included and random.random() < 0.2 else deck
    lines = files[damaged].split("\n")
    for _ in range(random.choice((1, 1, 1, 2, 2, 3, 4))):
        random.choice(LINE_MUTATIONS)(random, lines, corpus)
        lines = lines or [""]
    tree = {damaged: lines}
    if random.random() < 0.1:
        grow_tree(random, tree)
    whole = {name: text.encode() for name, text in files.items()}
    return whole | {name: encode(random, part) for name, part in tree.items()}
