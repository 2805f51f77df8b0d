# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A run of a deck that is made here, in this process, and how it ended."""

from __future__ import annotations

import shutil
import time
from dataclasses import dataclass
from pathlib import Path

from uel.batch.engine import Deck
from uel.errors import ConvergenceError, NotFiniteError
from uel.output import Result
from uel.running.job import run
from uel.solver.options import SolverOptions


@dataclass(frozen=True, slots=True)
class RunOutcome:
    """A run and how it ended: `stopped` says why it stopped early, empty for a run that finished."""

    result: Result
    stopped: str
    seconds: float


def run_deck(deck: Deck, folder: Path, *, fallback: bool, fields: bool = False) -> RunOutcome:
    """Write a deck, run it.

    Parameters
    ----------
    deck
        The deck, with the texts of its files.
    folder
        Gets a folder of the deck's name with the deck and all that a job writes.
    fallback
        Search downhill where Newton's method fails, as `uel run --fallback`.
    fields
        Keep the field output, fifty times as large as the rest, which tables and profiles do not need.
    """
    place = folder / deck.name
    place.mkdir(parents=True, exist_ok=True)
    for name, content in deck.files().items():
        (place / name).write_text(content, encoding="ascii")
    started, stopped = time.perf_counter(), ""
    try:
        run(place / f"{deck.name}.inp", output_dir=place, solver=SolverOptions(fallback=fallback))
    except (ConvergenceError, NotFiniteError) as error:
        # a model with a beta below its bound diverges until an element overflows
        stopped = str(error)
    if not fields:
        shutil.rmtree(place / f"{deck.name}_vtu", ignore_errors=True)
    return RunOutcome(Result(place / deck.name), stopped, time.perf_counter() - started)
