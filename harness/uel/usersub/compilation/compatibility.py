# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Extensions of Abaqus' Fortran compiler that gfortran refuses, written in standard Fortran in a copy of the file.

Only what has a single meaning is changed, at the lines that the compiler names; the user's file stays as it is.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final


def _error(message: str) -> re.Pattern[str]:
    """Compile the pattern of an error of gfortran, among warnings: location, lines that it shows, message."""
    location = r"^(?P<file>[^\n]+?):(?P<line>\d+):(?P<column>\d+):\n(?:(?!.*(?:Error|Warning):).*\n)*?"
    return re.compile(f"{location}Error: {message}", re.MULTILINE)


_COMPARED_LOGICALS: Final = _error(
    r"Logicals at \(1\) must be compared with \.(?:n?eqv)\. instead of (?P<operator>\S+)$"
)
_IMPORTED_TWICE: Final = _error(
    r"'(?P<name>\w+)' of module '(?P<module>\w+)', imported at \(1\), "
    r"is also the name of the current program unit$"
)
_REAL_BOUND: Final = _error(
    r"(?:Expecting a scalar INTEGER expression at \(1\), found REAL|"
    r"Expression at \(1\) must be of INTEGER type, found REAL|"
    r"Bad array specification for an explicitly shaped array at \(1\))$"
)
_OWN_RESULT: Final = _error(
    r"'(?P<name>\w+)' at \(1\) is the name of a recursive function and so refers to the result variable\."
)
_UNTYPED: Final = _error(r"Symbol '\w+' at \(1\) has no IMPLICIT type$")
_MIXED_SIGN: Final = _error(r"'b' argument of 'sign' intrinsic at \(1\) must be the same type and kind as 'a'$")
_CAPITAL_DIRECTIVE: Final = _error(
    r"invalid preprocessing directive #(?P<name>(?i:include|define|undef|ifn?def|if|elif|else|endif))$"
)
_SINGLE_QUOTES: Final = _error(r"#include expects \"FILENAME\" or <FILENAME>$")
_SIGN: Final = re.compile(r"\bsign\s*\(", re.IGNORECASE)
_END_OF_FUNCTION: Final = re.compile(r"^\s*end\s*(?:function\b.*)?(?:!.*)?$", re.IGNORECASE)
_BARE_PARAMETER: Final = re.compile(r"^(\s*)parameter\s+([a-z]\w*\s*=[^!]*?)\s*$", re.IGNORECASE)
_CONSTANT: Final = re.compile(
    r"[-+]?(?:(?P<whole>\d+)|(?P<single>\d*\.?\d*(?:e[-+]?\d+)?)|(?P<double>\d*\.?\d*d[-+]?\d+))", re.IGNORECASE
)
_TYPES: Final = {"whole": "integer", "single": "real", "double": "double precision"}
_NAME: Final = re.compile(r"(?<![\w.])[a-z]\w*", re.IGNORECASE)
_REAL_NUMBER: Final = re.compile(r"(?<!\w)\d+\.\d*(?:[de][-+]?\d+)?|(?<!\w)\d+[de][-+]?\d+", re.IGNORECASE)
_DECLARED: Final = re.compile(r"\w\s*(?=\()")
LONGEST: Final = 132
"""Columns of a line that is compiled."""
_SPELLINGS: Final = {".eq.": (".eq.", "=="), "==": (".eq.", "=="), ".ne.": (".ne.", "/="), "/=": (".ne.", "/=")}
_STANDARD: Final = {".eq.": ".eqv.", "==": ".eqv.", ".ne.": ".neqv.", "/=": ".neqv."}
_WEAKER: Final = re.compile(r"\.(and|or|eqv|neqv)\.", re.IGNORECASE)


@dataclass(frozen=True)
class Repair:
    """Bare name of a file, line from 1, the change of its text (None if it stays), and a note on what is changed."""

    file: str
    line: int
    apply: Callable[[str], str | None]
    note: str


def repairs(errors: str) -> Iterator[Repair]:
    """Yield repairs of what gfortran refuses in a file, from its messages."""
    for pattern, change, note in _REPAIRS:
        for match in pattern.finditer(errors):
            groups = match.groupdict()
            lower = groups.get("name", "").lower()
            apply = partial(change, match)
            yield Repair(Path(match["file"]).name, int(match["line"]), apply, note.format(**groups, lower=lower))


def edit_line(text: str, line: int, change: Callable[[str], str | None]) -> str | None:
    """Return the text with a changed line (from 1); None without this line, or without a change of it."""
    lines = text.splitlines(keepends=True)
    changed = change(lines[line - 1]) if 1 <= line <= len(lines) else None
    if changed is None or changed == lines[line - 1]:
        return None
    lines[line - 1] = changed
    return "".join(lines)


def double_quotes(text: str, line: int) -> str | None:
    """Put double quotes around the file of an #include; None without single ones in the line."""
    return edit_line(text, line, partial(re.sub, r"^(\s*#\s*include\s*)'([^'\"]+)'", r'\1"\2"'))


def lower_directive(text: str, line: int, name: str) -> str | None:
    """Write a preprocessor directive in lower case; None without it in the line."""
    return edit_line(text, line, partial(re.sub, rf"^(\s*#\s*){name}\b", lambda match: match[1] + name.lower()))


def sign_of_one_kind(text: str, line: int, column: int) -> str | None:
    """Give the second argument of SIGN, around a column (from 1), the kind of the first one.

    None if the call is not on one line. Only the sign of the second argument matters.
    """

    def change(row: str) -> str | None:
        for call in reversed(list(_SIGN.finditer(row, 0, column))):
            end = _unmatched(row, range(call.end(), len(row)), ")", "(")
            if end is None or end < column - 1:
                continue
            commas = (k for k in range(call.end(), end) if row[k] == "," and _balanced(row[call.end() : k]))
            if (comma := next(commas, None)) is None:
                return None
            return f"{row[: comma + 1]}real({row[comma + 1 : end]}, kind({row[call.end() : comma]})){row[end:]}"
        return None

    return edit_line(text, line, change)


def _balanced(text: str) -> bool:
    return text.count("(") == text.count(")")


def name_result(text: str, line: int, name: str) -> str | None:
    """Add RESULT to a function that calls itself in a line; None if its head is not one plain line.

    Within the function its name means a call if arguments follow, and the result otherwise.
    """
    lines = text.splitlines(keepends=True)
    head = re.compile(rf"^(?!\s*end)[^!'\"]*\bfunction\s+{name}\s*\([^()]*\)(?=\s*(?:!.*)?$)", re.IGNORECASE)
    first = next((number for number in range(min(line, len(lines)) - 1, -1, -1) if head.match(lines[number])), None)
    result = f"{name}_result"
    if first is None or result in text:
        return None
    lines[first] = head.sub(lambda match: f"{match[0]} result({result})", lines[first])
    for number in range(first + 1, len(lines)):
        if _END_OF_FUNCTION.match(lines[number].rstrip()):
            return "".join(lines)
        lines[number] = re.sub(rf"\b{name}\b(?!\s*\()", result, lines[number], flags=re.IGNORECASE)
    return None


def integer_bound(text: str, line: int) -> str | None:
    """Convert array bounds of a declaration, which may be real, to integers; None without one."""

    def change(row: str) -> str:
        converted, end = "", 0
        for match in _DECLARED.finditer(row):
            last = _unmatched(row, range(match.end() + 1, len(row)), ")", "(")
            if match.end() < end or last is None:
                continue
            converted += row[end : match.end() + 1] + "".join(map(_integer, _bounds(row[match.end() + 1 : last])))
            end = last
        return converted + row[end:]

    return edit_line(text, line, change)


def _bounds(text: str) -> Iterator[str]:
    """Yield the bounds between parentheses, and the commas and colons that separate them."""
    start = 0
    for column, character in enumerate(text):
        if character in ",:" and _balanced(text[start:column]):
            yield from (text[start:column], character)
            start = column + 1
    yield text[start:]


def _integer(bound: str) -> str:
    """Put int() around a bound that names or numbers may make real, unless it has one."""
    bare = bound.strip()
    real = _NAME.search(bare) or _REAL_NUMBER.search(bare)
    return f"int({bare})" if real and "=" not in bare and not bare.startswith("int(") else bound


TYPED: Final = "PARAMETER without parentheses, whose names have the types of their constants; the copy declares them"


def hidden_types(text: str, file: str) -> Iterator[Repair]:
    """Yield repairs of what gfortran reads differently from Abaqus' compiler: PARAMETER without parentheses.

    There the constant gives its name a type, not the first letter, by which NU = 0.3D0 would be 0. Names that are
    declared somewhere in the file are left alone.
    """
    for line, row in enumerate(text.splitlines(), 1):
        for name, kind, _ in _bare_constants(row) or ():
            implicit_integer = name[0].lower() in "ijklmn"
            declared = rf"^(?!\s*[c*!])[^!\n]*\b(?:real|double\s*precision|integer)\b[^!\n]*\b{name}\b"
            if implicit_integer != (kind == "integer") and not re.search(declared, text, re.IGNORECASE | re.MULTILINE):
                yield Repair(file, line, partial(type_constants, line=line), TYPED)
                break


def type_constants(text: str, line: int) -> str | None:
    """Give the names of a PARAMETER without parentheses the types of their constants.

    None if it is not one line of plain constants.
    """
    if _continued(text.splitlines(), line):
        return None

    def change(row: str) -> str | None:
        constants = _bare_constants(row.rstrip("\r\n"))
        kinds: dict[str, list[str]] = {}
        for name, kind, _ in constants or ():
            kinds.setdefault(kind, []).append(name)
        typed = "; ".join(f"{kind} {', '.join(names)}" for kind, names in kinds.items())
        values = ", ".join(f"{name}={value}" for name, _, value in constants or ())
        changed = f"{row[: len(row) - len(row.lstrip())]}{typed}; parameter ({values})"
        return f"{changed}\n" if constants and len(changed) <= LONGEST else None

    return edit_line(text, line, change)


def _bare_constants(row: str) -> list[tuple[str, str, str]] | None:
    """Return the name, type and constant of each entry of a PARAMETER without parentheses; None for any other line."""
    match = _BARE_PARAMETER.match(row.partition("!")[0])
    if match is None:
        return None
    entries = []
    for entry in match[2].split(","):
        name, _, value = (part.strip() for part in entry.partition("="))
        constant = _CONSTANT.fullmatch(value)
        if constant is None or not value or constant.lastgroup is None or not re.fullmatch(r"[a-z]\w*", name.lower()):
            return None
        entries.append((name, _TYPES[constant.lastgroup], value))
    return entries


def _continued(lines: list[str], line: int) -> bool:
    """Return whether a fixed-form statement continues after a line; in free form that ends with &, not a constant."""
    following = lines[line] if line < len(lines) else ""
    return following[:5] == "     " and following[5:6].strip() not in ("", "0")


def rename_import(text: str, line: int, module: str, name: str) -> str | None:
    """Rename an entity in a plain `use module`, so that the program unit keeps its name; None without such a line."""

    def change(row: str) -> str | None:
        plain = re.fullmatch(rf"\s*use\s+{module}", row.rstrip(), re.IGNORECASE)
        return f"{row.rstrip()}, of_{module} => {name}\n" if plain else None

    return edit_line(text, line, change)


def compare_logicals(text: str, line: int, column: int, operator: str) -> str | None:
    """Write one comparison of logicals as .eqv. or .neqv.; None if that could change its meaning.

    line and column are those of the first operand, from 1. `.eqv.` binds less than `.and.`, `.eq.` more: the comparison
    has to be alone between its parentheses.
    """

    def change(row: str) -> str | None:
        pattern = "|".join(re.escape(spelling) for spelling in _SPELLINGS[operator.lower()])
        match = re.compile(pattern, re.IGNORECASE).search(row, column - 1)
        if match is None or _WEAKER.search(_alone(row, match.start(), match.end()) or ".and."):
            return None
        return f"{row[: match.start()]} {_STANDARD[match[0].lower()]} {row[match.end() :].lstrip(' ')}"

    return edit_line(text, line, change)


def _alone(row: str, start: int, end: int) -> str | None:
    """Return the text between the parentheses around a column; None if they are not on the line."""
    first = _unmatched(row, range(start - 1, -1, -1), "(", ")")
    last = _unmatched(row, range(end, len(row)), ")", "(")
    return None if first is None or last is None else row[first + 1 : last]


def _unmatched(row: str, columns: range, bracket: str, other: str) -> int | None:
    depth = 0
    for column in columns:
        depth += (row[column] == other) - (row[column] == bracket)
        if depth < 0:
            return column
    return None


_REPAIRS: Final[tuple[tuple[re.Pattern[str], Callable[[re.Match[str], str], str | None], str], ...]] = (
    (
        _COMPARED_LOGICALS,
        lambda m, text: compare_logicals(text, int(m["line"]), int(m["column"]), m["operator"]),
        "logicals compared with {operator}; the copy has .eqv. or .neqv.",
    ),
    (
        _IMPORTED_TWICE,
        lambda m, text: rename_import(text, int(m["line"]), m["module"], m["name"]),
        "{name} of module {module} has the name of the program unit that uses it; the copy renames it",
    ),
    (
        _REAL_BOUND,
        lambda m, text: integer_bound(text, int(m["line"])),
        "a real number as an array bound; the copy has int() of it",
    ),
    (
        _OWN_RESULT,
        lambda m, text: name_result(text, int(m["line"]), m["name"]),
        "the function {name} calls itself and has no RESULT; the copy has one",
    ),
    (_UNTYPED, lambda m, text: type_constants(text, int(m["line"])), TYPED),
    (
        _MIXED_SIGN,
        lambda m, text: sign_of_one_kind(text, int(m["line"]), int(m["column"])),
        "SIGN of two kinds of numbers; the copy has one kind",
    ),
    (
        _CAPITAL_DIRECTIVE,
        lambda m, text: lower_directive(text, int(m["line"]), m["name"]),
        "#{name} in capitals; the copy has #{lower}",
    ),
    (
        _SINGLE_QUOTES,
        lambda m, text: double_quotes(text, int(m["line"])),
        "#include with single quotes; the copy has double ones",
    ),
)
"""Errors of gfortran, the changes of the text that avoid them, and notes on these."""
