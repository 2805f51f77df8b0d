# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Restart of an old job: the state that a job continues, and the decks of its model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from uel.deck import part_of, survey_restart
from uel.errors import DeckError, UelError, UsageError
from uel.model.model import Model
from uel.model.restart import DeckPart, Resumption
from uel.output.files.state_files import read_state
from uel.parallel.ranks import Ranks
from uel.solver.options import SolverOptions


def find_state(
    deck: Path, parameters: Mapping[str, float] | None, oldjob: Path, stem: Path
) -> tuple[Resumption, tuple[DeckPart, ...]]:
    """Find the state of an old job that a deck continues.

    *RESTART, READ of the deck names it; without that keyword, the deck of the old job continues its last state.

    Parameters
    ----------
    deck, parameters
        The deck, and values of parameters that replace its own.
    oldjob, stem
        Folder and name of the old job, and of the new one.

    Returns
    -------
    tuple[Resumption, tuple[DeckPart, ...]]
        The state, and the decks that the model comes from.

    Raises
    ------
    UsageError
        Both jobs have the same name, or the deck has no *RESTART, READ and is not that of the old job.
    UelError
        There is no such state, or a deck has changed since.
    DeckError
        A deck cannot be read.
    """
    if oldjob.resolve() == stem.resolve():
        raise UsageError(f"--oldjob {oldjob}: the new job has the same name; give it another one, --job {stem.name}-2")
    read = survey_restart(deck, parameters)
    state = read_state(oldjob) if read is None else read_state(oldjob, read.step, read.increment)
    last = state.decks[-1]
    if read is None and Path(last.path) != deck.resolve():
        message = f"{deck} has no *RESTART, READ, and is not the deck of that job, which is {last.path}"
        raise UsageError(f"--oldjob {oldjob}: {message}")
    if read is None and parameters and dict(parameters) != last.given:
        raise UsageError(f"--oldjob {oldjob}: the deck goes on with the parameters of that job; give none")
    for part in state.decks:
        _check_unchanged(part, oldjob)
    if read is None:
        return Resumption(state.analysis, state.file), state.decks
    return Resumption(state.analysis, state.file, read.end_step), (*state.decks, part_of(deck, parameters, state.step))


def _check_unchanged(part: DeckPart, oldjob: Path) -> None:
    """Raise UelError if a deck has changed since its job ran."""
    try:
        now = part_of(Path(part.path), part.given)
    except (DeckError, OSError) as error:
        raise UelError(f"the model of job {oldjob} comes from {part.path}, which cannot be read: {error}") from None
    if now.digest != part.digest:
        message = "or a file that it includes, has changed since"
        raise UelError(f"the model of job {oldjob} comes from {part.path}, which, {message}: run the old job again")


def refuse_finished(model: Model, resumed: Resumption | None, oldjob: str | Path | None) -> None:
    """Raise UsageError if no step follows the state that a job continues."""
    if resumed is None:
        return
    step, increment = (resumed.analysis[name] for name in ("step", "increment"))
    if not begins_within_step(resumed) and step == len(model.steps):
        message = f"its state after step {step}, increment {increment} is that of the end of the analysis"
        raise UsageError(f"--oldjob {oldjob}: {message}: a deck with *RESTART, READ adds steps")


def refuse_options(resumed: Resumption | None, oldjob: str | Path | None, solver: SolverOptions) -> None:
    """Raise UsageError for options that a restart, or the step it continues, does not take."""
    if resumed is None:
        return
    if solver.fallback:
        reason = "its search compares with the matrix of the start of the analysis, which no state has"
        raise UsageError(
            f"--fallback: {reason}; go on from --oldjob {oldjob} without it, or run the whole analysis with it"
        )
    if solver.energy_control and begins_within_step(resumed):
        step = resumed.analysis["step"]
        message = f"step {step} of --oldjob {oldjob} goes on as it began, in time"
        raise UsageError(f"--control energy: {message}; expected *RESTART, READ with END STEP")


def begins_within_step(resumed: Resumption) -> bool:
    """Return whether a restart begins within a step."""
    return not (resumed.analysis["finished"] or resumed.end_step)


def decks_of(model: Model, parameters: Mapping[str, float] | None, parts: Sequence[DeckPart]) -> Sequence[DeckPart]:
    """Return the decks of a model, which its states name; empty if it keeps no states."""
    if parts or not any(step.restart for step in model.steps):
        return parts
    return (part_of(model.deck, parameters),)


def refuse_on_ranks(oldjob: str | Path | None, ranks: Ranks) -> None:
    """Raise UsageError for a restart on several ranks: a state has all elements in one process."""
    if oldjob is not None and ranks.size > 1:
        raise UsageError(f"--oldjob {oldjob}: a restart does not run on {ranks.size} ranks; run it in one process")
