# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Join the kernels to one fixed-form file for Abaqus.

Abaqus compiles user routines from one file, in fixed form with up to 132 columns. The file written here has at most 72
columns and continues lines with a character in column 6, so it means the same at 72 and at 132 columns. Long character
constants become concatenations: broken across lines, they would gain blanks up to the last column, wherever that is.
"""

from __future__ import annotations

import argparse
import re
import textwrap
from collections.abc import Iterator, Sequence
from pathlib import Path

COLUMNS = 72
STATEMENT = 6  # blanks before a statement
CONTINUED = "     &"
LONGEST_PIECE = 40
TITLE = """\
! Cohesive interface elements for Abaqus/Standard, with UEL and, where
! (UELMAT) follows the type, UELMAT:
!
{types}
!
!   abaqus job=NAME user=FILE
!
! Written from the free-form sources of the project; edit those, not
! this file.
"""


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("sources", type=Path, nargs="+")
    options = parser.parse_args()
    options.output.write_text(amalgamate(options.sources))


def amalgamate(sources: Sequence[Path]) -> str:
    """Text of the single file; modules come before what uses them, procedures outside modules last."""
    texts = [path.read_text() for path in sources]
    licence = [line for line in texts[0].splitlines() if line.startswith("! SPDX")]
    lines = [*licence, *TITLE.format(types="\n".join(types_of(texts))).splitlines()]
    for text in in_order(texts):
        lines.append("")
        lines += fixed_form(text)
    return "\n".join(lines) + "\n"


def types_of(texts: Sequence[str]) -> Iterator[str]:
    """Comment lines with each element type and its meaning, from the rows of the layout."""
    for text in texts:
        for meaning, number, family in re.findall(r"^ *!> (.*)\n *element_item\((\d+), (\w+),", text, re.MULTILINE):
            name = f"U{number} (UELMAT)" if family.startswith("continuum") else f"U{number}"
            yield from textwrap.wrap(f"{name}: {meaning}", 70, initial_indent="!   ", subsequent_indent="!     ")


def in_order(texts: Sequence[str]) -> list[str]:
    """Sort the sources so that every module precedes its users."""
    modules = {match[1]: text for text in texts if (match := re.search(r"^module (\w+)$", text, re.MULTILINE))}
    ordered: list[str] = []

    def visit(text: str, users: tuple[str, ...]) -> None:
        if text in users:
            raise ValueError("modules use each other in a circle")
        if text in ordered:
            return
        for used in re.findall(r"^\s*use (\w+)", text, re.MULTILINE):
            visit(modules[used], (*users, text))
        ordered.append(text)

    for text in sorted(texts, key=lambda text: text not in modules.values()):
        visit(text, ())
    return ordered


def fixed_form(text: str) -> Iterator[str]:
    """Fixed-form lines of a free-form source. Comments stand before the statement they are on."""
    statement = ""
    for line in text.splitlines():
        code, comment = split_comment(line)
        if comment and not comment.startswith("! SPDX"):
            yield from commented(comment)
        code = code.strip()
        if not code:
            continue
        statement += code.removeprefix("&").removesuffix("&").strip() + " "
        if not code.endswith("&"):
            yield from broken(plain(statement.strip()))
            statement = ""


def split_comment(line: str) -> tuple[str, str]:
    """Code and comment of a line; a '!' in a character constant starts no comment."""
    quote = ""
    for column, character in enumerate(line):
        if quote:
            quote = "" if character == quote else quote
        elif character in "'\"":
            quote = character
        elif character == "!":
            return line[:column], line[column:].rstrip()
    if quote:
        raise ValueError(f"character constant without end: {line}")
    return line, ""


def commented(comment: str) -> Iterator[str]:
    """Comment lines of at most 72 columns, without quotes: a preprocessor would look for their partners."""
    words = re.sub(r"['\"]", "`", comment.lstrip("!<>").strip()).split()
    line = "!"
    for word in words:
        if len(line) + 1 + len(word) > COLUMNS:
            yield line
            line = "!"
        line += " " + word
    yield line


def plain(statement: str) -> str:
    """Return the statement without what older compilers of Abaqus installations do not know."""
    return "implicit none" if statement.startswith("implicit none") else statement


def broken(statement: str) -> Iterator[str]:
    """Lines of a statement, broken at blanks outside character constants."""
    line = " " * STATEMENT
    for piece in re.findall(r"(?:'[^']*'|\"[^\"]*\"|[^\s'\"])+\s*", statement):
        for part in parts(piece):
            if len((line + part).rstrip()) > COLUMNS:
                yield line.rstrip()
                line = CONTINUED + " "
            if len((line + part).rstrip()) > COLUMNS:
                raise ValueError(f"cannot be broken to {COLUMNS} columns: {part}")
            line += part
    yield line.rstrip()


def parts(piece: str) -> Iterator[str]:
    """Break a piece after commas and brackets, without blanks, and its character constants into concatenations."""
    if len(piece) <= LONGEST_PIECE:
        yield piece
        return
    for part in re.findall(r"'[^']*'[^\s'(,]*[,(]?\s*|[^,('\"]+[,(]?\s*|[,(]\s*", piece):
        text, quote, rest = part[1:].partition("'")
        if part.startswith("'") and len(part) > LONGEST_PIECE:
            pieces = [text[i : i + LONGEST_PIECE] for i in range(0, len(text), LONGEST_PIECE)]
            yield from (f"'{section}' // " for section in pieces[:-1])
            yield f"'{pieces[-1]}{quote}{rest}"
        else:
            yield part


if __name__ == "__main__":
    main()
