# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*RESTART: when states are written, where a restart resumes, and the model of a restart deck.

The model is that of the earlier job; a restart deck adds steps, amplitudes and sets (Abaqus Analysis User's Guide,
"Restarting an analysis").
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block
from uel.deck.language.lexer import read_blocks, survey_blocks
from uel.deck.language.structure import Structure, sort_blocks
from uel.deck.language.table import Keyword, Kind, Option, Where, refused
from uel.files import read_whole
from uel.model.restart import DeckPart, RestartRead, RestartWrite

MAY_BE_ADDED = ("AMPLITUDE", "NSET", "ELSET")
"""Model data of a restart deck."""


def find_restart(
    deck: Path, keywords: Mapping[str, Keyword], parameters: Mapping[str, float] | None
) -> RestartRead | None:
    """Return the *RESTART, READ of a deck, None without; `read_deck` reports other errors of the deck.

    Raises DeckError if the deck cannot be read or has several, UsageError for an undefined parameter.
    """
    blocks = read_blocks(deck, keywords, Problems(), parameters)
    reads = [block for block in blocks if block.name == "RESTART" and block.options.flag("READ")]
    for again in reads[1:]:
        raise again.error(f"*RESTART, READ is there already, at {reads[0].source}")
    return _read(reads[0]) if reads else None


def digest_of(deck: Path, keywords: Mapping[str, Keyword], parameters: Mapping[str, float] | None) -> str:
    """Return the hash of a deck and of the files that it includes. Raises DeckError if it cannot be read."""
    digest = hashlib.sha256()
    for file in survey_blocks(deck, keywords, parameters).files:
        digest.update(hashlib.sha256(read_whole(file)).digest())
    return digest.hexdigest()


def join_parts(
    parts: Sequence[DeckPart], blocks: list[Block], keywords: Mapping[str, Keyword], problems: Problems
) -> tuple[Structure, tuple[RestartWrite | None, ...]]:
    """Join the decks of a restart; return when each step writes its state.

    Parameters
    ----------
    parts
        The decks; empty without a restart.
    blocks
        Blocks of the last deck.
    keywords
        The keyword table.
    problems
        Receives errors.

    Returns
    -------
    tuple[Structure, tuple[RestartWrite | None, ...]]
        Model data and steps of all decks; None: the step writes no states.
    """
    model, requests = Structure(), list[RestartWrite | None]()
    earlier = [read_blocks(Path(part.path), keywords, problems, part.given) for part in parts[:-1]]
    for number, own_blocks in enumerate([*earlier, blocks]):
        part = sort_blocks(own_blocks, problems)
        current = _in_force(part.root, requests[-1] if requests else None, problems)
        if number:
            _check_added(part, problems)
            stay = parts[number].steps
            del model.steps[stay:], requests[stay:]
            requests[-1:] = [current]
        for scope in part.steps:
            current = _in_force(scope.blocks, current, problems)
            requests.append(current)
        if number:
            model.root += part.root
            model.steps += part.steps
            model.ignored += part.ignored
        else:
            model = part
    return model, tuple(requests)


def refuse_reading(structure: Structure, problems: Problems) -> None:
    """Report *RESTART, READ as an error, for a run without the old job."""
    for block in structure.root:
        if block.name == "RESTART" and block.options.flag("READ"):
            problems.add(block.source, "*RESTART, READ: the model is that of an earlier job, uel run --oldjob NAME")


def _check_added(part: Structure, problems: Problems) -> None:
    """Report the keywords that a restart deck may not add to the model."""
    allowed = (*MAY_BE_ADDED, "HEADING", "PARAMETER", "RESTART")
    scopes = [*part.parts.values(), *part.instances.values()]
    for block in [*part.root, *(scope.head for scope in scopes)]:
        if block.name not in allowed:
            names = ", ".join(f"*{name}" for name in MAY_BE_ADDED)
            message = f"*{block.name}: the model is that of the old job, to which a restart deck adds only {names}"
            problems.add(block.source, message)


def _in_force(blocks: list[Block], current: RestartWrite | None, problems: Problems) -> RestartWrite | None:
    """Return the *RESTART, WRITE in force after these blocks."""
    for block in blocks:
        if block.name == "RESTART":
            with problems.gather():
                current = _written(block, current, problems)
    return current


def _written(block: Block, current: RestartWrite | None, problems: Problems) -> RestartWrite | None:
    """Return the *RESTART, WRITE of a block, the current one without. Raises DeckError."""
    options = block.options
    if not (options.flag("READ") or options.flag("WRITE")):
        raise block.error("expected READ or WRITE")
    if not options.flag("WRITE"):
        return current
    frequency, intervals = options.integer("FREQUENCY", 1), options.integer("NUMBER INTERVAL", 0)
    if frequency < 0:
        raise block.error(f"FREQUENCY={frequency} must not be negative")
    if intervals < 1 and options.has("NUMBER INTERVAL"):
        raise block.error(f"NUMBER INTERVAL={intervals} must be positive")
    if intervals and options.has("FREQUENCY"):
        raise block.error("FREQUENCY and NUMBER INTERVAL exclude each other")
    if intervals and options.flag("TIME MARKS"):
        message = "*RESTART: increments do not end at the times; the first one that reaches a time is kept instead"
        problems.warn(block.source, message)
    return RestartWrite(frequency, intervals, options.flag("OVERLAY"))


def _read(block: Block) -> RestartRead:
    """Read *RESTART, READ of a block. Raises DeckError."""
    options = block.options
    numbers = [options.integer(name, 0) if options.has(name) else None for name in ("STEP", "INC")]
    for name, number in zip(("STEP", "INC"), numbers, strict=True):
        if number is not None and number < 1:
            raise block.error(f"{name}={number} must be positive")
    step, increment = numbers
    if increment is not None and step is None:
        raise block.error("INC needs STEP")
    return RestartRead(step, increment, options.flag("END STEP"), block.source)


KEYWORDS = (
    Keyword(
        "RESTART",
        "Keep states from which a later job resumes (WRITE), in the folder JOB_restart; or resume (READ): the model is "
        "that of the old job, `uel run --oldjob`, to which this deck adds amplitudes, sets and steps. Without END STEP "
        "the step that READ names is completed first. See harness/uel/procedures/restart.md.",
        Where.ANY,
        (
            Option("WRITE", doc="keep states, from this step on; before the first step, in all of them"),
            Option("FREQUENCY", Kind.INTEGER, "every k-th increment (1), and the last one of the step; 0 never"),
            Option("NUMBER INTERVAL", Kind.INTEGER, "... the first one in or after each of so many parts of the step"),
            Option("TIME MARKS", Kind.SWITCH, "whether increments end at these times, which they do not"),
            Option("OVERLAY", doc="only the last state of a step stays"),
            Option("READ", doc="resume the analysis of the old job"),
            Option("STEP", Kind.INTEGER, "its step (the last one that has a state)"),
            Option("INC", Kind.INTEGER, "increment of the step (the last one that has a state)"),
            Option("END STEP", doc="the step ends there"),
            *refused("CYCLE", "ITERATION", "INTERVAL", "SINGLE FILE"),
        ),
    ),
)
