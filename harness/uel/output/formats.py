# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Numbers, notes and warnings in Abaqus' format, and text files that a killed run leaves readable."""

from __future__ import annotations

import math
import os
import re
import textwrap
from collections.abc import Iterable, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path


def engineering(value: float) -> str:
    """Format six digits and an exponent that is a multiple of three, as .msg has errors of contact: 442.915E-03."""
    if value == 0.0:
        return "0.00000"
    exponent = 3 * (int(f"{value:.5e}".partition("e")[2]) // 3)
    return f"{value / 10.0**exponent:#.6g}E{exponent:+03d}"


def general(value: float, width: int = 11, digits: int = 3) -> str:
    """Format as Fortran's `1PGw.d`, with which the .msg and .dat files are written.

    A number that rounds into [0.1, 10**digits) has `digits` significant digits and four blanks instead of the
    exponent; any other has one digit more and an exponent.
    """
    if not math.isfinite(value):
        return f"{'NaN' if math.isnan(value) else ('Infinity' if value > 0 else '-Infinity'):>{width}}"
    if value == 0.0:
        return f"{0.0:{width - 4}.{digits - 1}f}    "
    exponent = int(f"{value:.{digits - 1}e}".partition("e")[2])
    if -1 <= exponent < digits:
        return f"{value:#{width - 4}.{digits - 1 - exponent}f}    "
    return _scientific(value, width, digits)


def exponential(value: float, width: int = 15, digits: int = 7) -> str:
    """Format as Fortran's `1PEw.d`, as .dat prints values at nodes: one digit before the point, d behind it."""
    if not math.isfinite(value):
        return general(value, width)
    # zero has no sign
    return _scientific(value + 0.0, width, digits)


def _scientific(value: float, width: int, digits: int) -> str:
    mantissa, _, power = f"{value:.{digits}e}".partition("e")
    return f"{mantissa}{'' if len(power) > 3 else 'E'}{power}".rjust(width)


def status_number(value: float, digits: int) -> str:
    """Format as C's `%#.<digits>g`, with which the .sta file is written; zero has one digit more than C gives it."""
    return f"{0.0:.{digits}f}" if value == 0.0 else f"{value:#.{digits}g}"


def program() -> str:
    """Return name and version for the head of every file."""
    try:
        return f"uel {version('uel')}"
    except PackageNotFoundError:
        return "uel"


class TextFile:
    """Text file that replaces an older one of the same name; each `write` reaches the system at once.

    So a killed run leaves all texts; the last one may be cut within a line, which readers ignore.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_APPEND, 0o666)

    def write(self, text: str) -> None:
        """Append text; nothing if the disk has no space for all of it."""
        data = memoryview(text.encode(errors="replace"))
        written = 0
        try:
            while written < len(data):
                written += os.write(self._descriptor, data[written:])
        except OSError as error:
            if written:
                os.ftruncate(self._descriptor, os.fstat(self._descriptor).st_size - written)
            error.filename = str(self._path)
            raise

    def write_lines(self, text: str) -> None:
        """Append text whose last line may lack its end."""
        self.write(text if text.endswith("\n") else f"{text}\n")

    def close(self) -> None:
        """Close the file."""
        os.close(self._descriptor)


def write_numbers(path: Path, names: Sequence[str], rows: Iterable[tuple[Sequence[object], Sequence[float]]]) -> None:
    """Write a CSV table: in each row what identifies it, then numbers with nine digits."""
    file = TextFile(path)
    file.write(",".join(names) + "\n")
    for identity, values in rows:
        file.write(",".join([*map(str, identity), *(f"{value:.9g}" for value in values)]) + "\n")
    file.close()


def read_remarks(path: Path, kind: str) -> list[str]:
    """Read the remarks of a kind in a file, each on one line; none if there is no such file."""
    if not path.exists():
        return []
    remarks = re.findall(
        rf"^ \*\*\*{kind}: (.*\n(?: {{{len(kind) + 6}}}\S.*\n)*)", path.read_text("utf-8", "replace"), re.M
    )
    return [" ".join(text.split()) for text in remarks]


def remark(kind: str, text: str) -> str:
    """Format a note, warning or error (`kind` NOTE, WARNING, ERROR) with lines as long as Abaqus', indented below it.

    Abaqus prints notes and warnings in upper case; names and paths keep theirs.
    """
    head = f" ***{kind}: "
    lines = textwrap.wrap(text, 80 - len(head), break_long_words=False, break_on_hyphens=False) or [""]
    return "\n".join([head + lines[0], *(" " * len(head) + line for line in lines[1:])]) + "\n"
