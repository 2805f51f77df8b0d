# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel fit`: run a deck with changing parameters until its curve is the measured one."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from uel.batch.command import batch
from uel.batch.runs import Settings
from uel.errors import UelError, UsageError, tell
from uel.fit.curve import Measurement, measured_curve, read_points
from uel.fit.estimate import Fit, fit_curve
from uel.fit.lives import check_properties, fit_lives, read_lives
from uel.fit.outcome import draw, summary, write_tables
from uel.fit.paris_line import RATE, check_cycles, paris_line
from uel.fit.variables import Variable, prepare_deck, read_variables
from uel.model.arrays import FloatArray
from uel.output import Result

RUNS = "runs"
"""Folder of the runs in that of the fit, as `uel batch` fills it."""


def fit(
    deck: Path,
    curve: Path,
    words: Sequence[str],
    folder: Path,
    settings: Settings,
    *,
    limit: int,
    x: str | None = None,
    y: str | None = None,
    after: float | None = None,
    workers: int | None = None,
    quiet: bool = False,
) -> Fit:
    """Run the command.

    Parameters
    ----------
    deck, curve
        The deck, and the CSV file of the measured curve.
    words
        Variables, such as GIC=0.1:0.5.
    folder
        Gets the runs, NAME_fit.csv, NAME_fit_curve.csv and NAME_fit.png.
    settings
        User files and options of the runs.
    limit
        Largest number of runs.
    x, y
        Columns of the history that the curve's are, or G and RATE of a Paris line; by default what the file says.
    after
        Growth of the crack that is left out of a Paris line.
    workers
        Runs at a time; one for each core by default.
    quiet
        Only errors are printed.

    Raises
    ------
    UelError
        UsageError and DeckError for what is wrong with the words, the curve or the deck; UelError for a run that cannot
        be compared.
    Interrupted
        By a signal; the same command continues.
    """
    variables = read_variables(words)
    points = read_points(curve, x, y)
    measured: Measurement
    if points.columns[1].names(RATE.name):
        measured = paris_line(points, after or 0.0)
        check_cycles(deck)
    elif after is None:
        measured = measured_curve(points)
    else:
        raise UsageError(f"--after {after:g}: expected a curve of RATE, the growth of a crack, over G")
    runs = _Runs(prepare_deck(deck, variables, folder), variables, measured, folder, settings, workers)
    say = (lambda _: None) if quiet else tell
    result = fit_curve(measured, variables, runs.curves, limit=limit, tell=say)
    stem = folder / f"{deck.stem}_fit"
    write_tables(stem, variables, measured, result)
    draw(stem.with_suffix(".png"), variables, measured, result)
    for line in summary(variables, measured, result, f"{result.ended} after {runs.count} runs"):
        say(line)
    say(f"{stem}.csv, {stem}_curve.csv, {stem}.png")
    return result


def fit_sn(path: Path, words: Sequence[str], folder: Path, *, quiet: bool = False) -> Fit:
    """Fit the S-N line of CF20 to points, without a deck.

    Parameters
    ----------
    path
        The CSV file of the points.
    words
        Variables, such as ENDURANCE=0.1:0.5.
    folder
        Gets NAME_fit.csv, NAME_fit_curve.csv and NAME_fit.png.
    quiet
        Only errors are printed.

    Raises
    ------
    UelError
        UsageError and DeckError for what is wrong with the words or the points; UelError for too few failures.
    """
    variables = [replace(variable, name=variable.name.upper()) for variable in read_variables(words)]
    check_properties(variables)
    measured = read_lives(path)
    result = fit_lives(measured, variables)
    folder.mkdir(parents=True, exist_ok=True)
    stem = folder / f"{path.stem}_fit"
    write_tables(stem, variables, measured, result)
    draw(stem.with_suffix(".png"), variables, measured, result)
    runouts = int(measured.runout.sum())
    ended = f"{result.ended}: {len(measured.x) - runouts} failures, {runouts} runouts"
    for line in summary(variables, measured, result, ended) if not quiet else []:
        tell(line)
    if not quiet:
        tell(f"{stem}.csv, {stem}_curve.csv, {stem}.png")
    return result


class _Runs:
    """Runner of a fit, whose runs are rows of one batch: what has run before is not repeated."""

    def __init__(
        self,
        deck: Path,
        variables: Sequence[Variable],
        measured: Measurement,
        folder: Path,
        settings: Settings,
        workers: int | None,
    ) -> None:
        self._deck, self._variables, self._measured = deck, variables, measured
        self._folder, self._settings, self._workers = folder / RUNS, settings, workers
        self._rows: list[list[str]] = []

    @property
    def count(self) -> int:
        """Runs so far."""
        return len(self._rows)

    def curves(self, points: Sequence[FloatArray]) -> list[FloatArray]:
        """Return the curves of runs with these values, at the x of the measured one."""
        first = len(self._rows)
        self._rows += [[f"fit-{first + k:03d}", *map(repr, map(float, p))] for k, p in enumerate(points, 1)]
        self._folder.mkdir(parents=True, exist_ok=True)
        table = self._folder / "values.csv"
        with table.open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerows([["job", *(variable.name for variable in self._variables)], *self._rows])
        batch([self._deck], self._folder, self._settings, table=table, workers=self._workers, quiet=True)
        return [self._curve(row) for row in self._rows[first:]]

    def _curve(self, row: Sequence[str]) -> FloatArray:
        job = row[0]
        named = ", ".join(f"{v.name} = {float(text):.6g}" for v, text in zip(self._variables, row[1:], strict=True))
        try:
            return self._measured.of_result(Result(self._folder / job / job), f"{job} ({named})")
        except UelError as error:
            helps = "narrower bounds" if "--fallback" in self._settings.options else "narrower bounds or --fallback"
            error.add_note(f"what it printed is in {self._folder / job / job}.log; {helps} may help")
            raise
