# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Command `uel report`: gather what is known about a job and write its page."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from uel.deck import read_deck
from uel.errors import UelError
from uel.model.model import Model
from uel.output.files.dat_file import echo, read_deck_path, read_parameters
from uel.output.files.msg_file import read_times
from uel.output.formats import read_remarks
from uel.output.outcome import duration, largest_load
from uel.output.results import Result
from uel.report.model_tables import Table, element_table, property_tables, step_table
from uel.report.page import Content, write_page
from uel.report.pictures import pictures

_SOLVER: Final = re.compile(
    r"LINEAR SOLVER: (\d+) FACTORISATIONS.* CPU TIME \(SEC\) = (\S+); (\d+) SOLUTIONS, CPU TIME \(SEC\) = (\S+)"
)
_FILES: Final = (".sta", ".msg", ".dat", "_history.csv", "_interface.csv", ".pvd")


def report(job: Path, path: Path | None = None) -> Path:
    """Write the page of a job.

    Parameters
    ----------
    job
        Name of a job that has run, completely or not, with its folder.
    path
        The page, an HTML file that holds its pictures; None: JOB.html.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    UelError
        There is no such job.
    """
    result = Result(job)
    deck = _Deck.of(result)
    tables: list[Table] = []
    if deck.model is not None:
        tables = [element_table(deck.model), step_table(deck.model, result.status), *property_tables(deck.model)]
    content = Content(
        job=result.job,
        heading=deck.model.heading if deck.model is not None else "",
        completed=result.completed,
        facts=_facts(result),
        errors=read_remarks(result.file(".msg"), "ERROR"),
        warnings=result.warnings,
        notes=deck.notes,
        tables=tables,
        times=_times(result),
        pictures=list(pictures(result)),
        deck=deck.path,
        lines=deck.lines,
        files=[result.file(ending).name for ending in _FILES if result.file(ending).exists()],
    )
    return write_page(content, path or result.file(".html"))


def _facts(result: Result) -> list[str]:
    """Collect the facts that a reader wants first."""
    facts = [str(result.counts)]
    if load := largest_load(result):
        facts.append(load)
    times = read_times(result.file(".msg"))
    if times is not None:
        facts.append(f"time: {duration(times[1])}")
    return facts


def _times(result: Result) -> list[tuple[str, str]]:
    """Split the processor time by its use; empty for a run that did not write it."""
    times = read_times(result.file(".msg"))
    if times is None:
        return []
    counts, seconds = [0, 0], [0.0, 0.0]
    for note in read_remarks(result.file(".msg"), "NOTE"):
        if match := _SOLVER.search(note):
            for k in range(2):
                counts[k] += int(match[2 * k + 1])
                seconds[k] += float(match[2 * k + 2])
    rest = max(times[0] - sum(seconds), 0.0)
    return [
        (f"linear solver, {counts[0]} factorisations", _share(seconds[0], times[0])),
        (f"linear solver, {counts[1]} solutions", _share(seconds[1], times[0])),
        ("elements, assembly, output and the rest", _share(rest, times[0])),
        ("processor time in all", duration(times[0])),
        ("wall-clock time", duration(times[1])),
    ]


def _share(seconds: float, whole: float) -> str:
    return f"{duration(seconds)} ({seconds / whole:.0%})" if whole > 0.0 else duration(seconds)


@dataclass(frozen=True, slots=True)
class _Deck:
    """The deck of a job: its path, its model and lines as far as they can be read, and what is to be said of that."""

    path: Path | None
    model: Model | None
    lines: list[str]
    notes: list[str]

    @classmethod
    def of(cls, result: Result) -> _Deck:
        """Read the deck that the .dat file names."""
        path = read_deck_path(result.file(".dat"))
        if path is None:
            return cls(None, None, [], [f"{result.file('.dat').name} does not name the deck of the job."])
        try:
            model = read_deck(path, read_parameters(result.file(".dat")))
            lines = path.read_text("utf-8", errors="replace").splitlines()
        except (UelError, OSError) as error:
            return cls(path, None, [], [f"The deck cannot be read any more: {error}"])
        printed = result.file(".dat").read_text("utf-8", errors="replace")
        notes = (
            [] if echo(path) in printed else [f"{path.name} has changed since the run: tables show it as it is now."]
        )
        return cls(path, model, lines, notes)
