# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A table of values for the parameters of a deck, with a row for each run."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from uel.batch.values import value_of
from uel.deck.error_report import Problems
from uel.deck.language.expressions import find
from uel.deck.language.lexer import unknown_parameter
from uel.errors import DeckError, Source, UsageError
from uel.files import read_whole
from uel.output.lock import job_stem

JOB: Final = "job"
"""Column with the names of the runs."""


@dataclass(frozen=True, slots=True)
class Row:
    """Values of a run.

    job     its name, '' if the table gives none
    values  names of parameters, and the texts of their values
    """

    job: str
    values: tuple[tuple[str, str], ...]


def read_table(path: Path, deck: Path, parameters: Sequence[str]) -> list[Row]:
    """Read the rows of a table: names of parameters in the first line, with commas between, then a line for each run.

    Parameters
    ----------
    path
        The table. Its column `job`, if it has one, has names for the runs.
    deck, parameters
        The deck that runs with the values, and the names of its parameters.

    Raises
    ------
    DeckError
        With file:line for each of the first 50 lines where a name is unknown, a value is missing or not a number, or
        a job has a name that cannot be one or that another one has.
    UsageError
        The table cannot be read.
    """
    problems = Problems()
    lines = read_cells(path, f"--table {path}")
    start, names = next(lines, (Source(str(path), 1), []))
    with problems.gather():
        _check_names(start, names, deck, parameters)
    problems.check()
    rows: list[Row] = []
    sources: dict[str, Source] = {}
    for source, cells in lines:
        with problems.gather():
            rows.append(_row(source, names, cells, sources))
    problems.check()
    if not rows:
        raise DeckError(start, "expected a line of values for each run below the line of names")
    return rows


def read_cells(path: Path, name: str) -> Iterator[tuple[Source, list[str]]]:
    """Yield the cells of the lines of a CSV file that are not empty, with their lines.

    Raises UsageError, with the name for the file, if it cannot be read, and DeckError if it is no table.
    """
    try:
        text = read_whole(path).decode("utf-8-sig", errors="replace")
    except OSError as error:
        raise UsageError(f"{name}: {error.strerror or type(error).__name__}") from None
    except ValueError as error:
        raise UsageError(f"{name}: {error}") from None
    reader = csv.reader(io.StringIO(text, newline=""), skipinitialspace=True)
    try:
        for cells in reader:
            if any(cell.strip() for cell in cells):
                yield Source(str(path), reader.line_num), [cell.strip() for cell in cells]
    except csv.Error as error:
        raise DeckError(Source(str(path), reader.line_num), f"not a table of values: {error}") from None


def _check_names(source: Source, names: Sequence[str], deck: Path, parameters: Sequence[str]) -> None:
    if not names:
        raise DeckError(source, f"expected names of parameters of {deck}, with commas between them")
    known = dict.fromkeys(parameters, 0)
    for number, name in enumerate(names, 1):
        if not name:
            raise DeckError(source, f"column {number} has no name")
        if name in names[: number - 1]:
            raise DeckError(source, f"column {number}: there is another column '{name}'")
        if name != JOB and find(name, known) is None:
            raise DeckError(source, f"column '{name}': {unknown_parameter(name, deck, parameters)}")


def _row(source: Source, names: Sequence[str], cells: Sequence[str], sources: dict[str, Source]) -> Row:
    """Read the row of a line; sources: of the jobs so far, to which this one is added. Raises DeckError."""
    if len(cells) != len(names):
        count = "1 value" if len(cells) == 1 else f"{len(cells)} values"
        raise DeckError(source, f"expected a value for each of {', '.join(names)}, found {count}")
    row = dict(zip(names, cells, strict=True))
    job = row.pop(JOB, "")
    if JOB in names:
        _check_job(source, job, sources)
    for name, text in row.items():
        try:
            value_of(text)
        except ValueError:
            raise DeckError(source, f"{name}: expected a number, found '{text}'") from None
    return Row(job, tuple(row.items()))


def _check_job(source: Source, job: str, sources: dict[str, Source]) -> None:
    try:
        job_stem(job, None)
    except UsageError:
        raise DeckError(source, f"{JOB}: expected a file name without folders, found '{job}'") from None
    if job in sources:
        raise DeckError(source, f"{JOB}: '{job}' is also the name of the run of {sources[job]}")
    sources[job] = source
