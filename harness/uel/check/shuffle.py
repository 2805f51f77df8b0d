# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Dependence of elements on the calling order.

Abaqus calls user elements by ascending number on one thread, and in no fixed order on several threads or processes.
The calls of a run are repeated in a new random order in every pass, and each element has to return the same bits.
Results of elements are compared, not their sums, whose round-off depends on the order. Concurrent calls are not tested.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np
from rich.console import Group
from rich.table import Table
from rich.text import Text

from uel.check.recording import Pass, Recording, record
from uel.check.replay import Elements, Results, abaqus_order, replay
from uel.elements import Request
from uel.errors import KernelError

ORDERS: Final = 3
"""Replays with random orders."""

THREADS: Final = "run on one thread and in one process (no cpus= above 1)"


@dataclass(slots=True)
class TypeVerdict:
    """Outcome for one element type.

    elements   of this type in the model
    calls      number of calls compared
    different  names of the elements whose results depend on the order
    first      the first difference, as a sentence
    refusal    error with which an element ended a call, None if none did
    """

    type: str
    elements: int
    calls: int = 0
    different: set[str] = field(default_factory=set)
    first: str = ""
    refusal: KernelError | None = None

    @property
    def passed(self) -> bool:
        """True if every call gave the same bits."""
        return self.refusal is None and not self.different

    @property
    def verdict(self) -> str:
        """Outcome in a few words."""
        if self.refusal is not None:
            return "refused, depends on the order"
        if self.different:
            return f"depends on the order ({len(self.different)} of {self.elements} elements)"
        return "the same in any order"


@dataclass(frozen=True, slots=True)
class Shuffled:
    """Outcome of the check; seed is that of the random orders."""

    recording: Recording
    seed: int
    types: tuple[TypeVerdict, ...]

    @property
    def passed(self) -> bool:
        """True if no element depends on the order, and the run converged for all increments asked for."""
        return self.recording.ending is None and all(kind.passed for kind in self.types)


def shuffle(deck: Path, user: Sequence[Path] = (), *, seed: int = 1, increments: int = 3) -> Shuffled:
    """Replay the first increments of a deck in random orders. Raises UelError if they fail in Abaqus' order."""
    return shuffle_recording(record(deck, user, increments), seed)


def shuffle_recording(recording: Recording, seed: int, *, strict: bool = True) -> Shuffled:
    """Replay a run in random orders; strict: an element that writes outside an array is refused."""
    ordered = [results for _, results in replay(recording, abaqus_order, strict=strict)]
    verdicts: dict[str, TypeVerdict] = {}
    for group in recording.model.groups:
        verdicts.setdefault(group.type, TypeVerdict(group.type, 0)).elements += len(group.labels)
    for number in range(1, ORDERS + 1):
        random = np.random.default_rng([seed, number])
        for expected, (elements, results) in zip(
            ordered, replay(recording, random.permutation, strict=strict), strict=True
        ):
            _compare(elements, expected, results, f"random order {number}", verdicts)
    return Shuffled(recording, seed, tuple(verdicts.values()))


def _compare(
    elements: Elements, expected: Results, results: Results, order: str, verdicts: dict[str, TypeVerdict]
) -> None:
    call = results.made.call
    where = f"step {call.step}, increment {call.increment}"
    for position, error in results.refusals.items():
        verdict = verdicts[str(elements.types[position])]
        verdict.refusal = verdict.refusal or error
    # a static analysis asks for the mass matrix but does not use it
    if call.flags.request is not Request.MASS:
        for kind, count in zip(*np.unique(elements.types[results.called], return_counts=True), strict=True):
            verdicts[str(kind)].calls += int(count)
    # compare bits, so that -0.0 and NaN are distinguished too
    unequal = np.flatnonzero(expected.values.view(np.int64) != results.values.view(np.int64))
    positions, firsts = np.unique(np.searchsorted(elements.starts, unequal, side="right") - 1, return_index=True)
    for position, index in zip(positions.tolist(), unequal[firsts].tolist(), strict=True):
        if not results.called[position]:
            continue
        verdict = verdicts[str(elements.types[position])]
        verdict.different.add(elements.names[position])
        if not verdict.first:
            entry = elements.entry(position, index - int(elements.starts[position]))
            values = f"{expected.values[index]:.17g} in Abaqus' order, {results.values[index]:.17g} in {order}"
            verdict.first = f"element {elements.names[position]}, {where}: {entry} is {values}"


def report(outcome: Shuffled) -> Group:
    """Return the table of verdicts with advice about failures."""
    recording = outcome.recording
    passes = sum(isinstance(event, Pass) and event.call.flags.request is not Request.MASS for event in recording.events)
    title = f"{recording.model.deck.name}: {ORDERS} random orders (seed {outcome.seed}) against Abaqus' order"
    caption = f"increments: {recording.increments}; calls of each element in each order: {passes}"
    table = Table("type", "elements", "calls compared", "verdict", "first difference", title=title, caption=caption)
    for kind in outcome.types:
        first = kind.first if kind.refusal is None else f"element {kind.refusal.element} ended the analysis, see below"
        table.add_row(kind.type, str(kind.elements), str(kind.calls), kind.verdict, Text(first))
    lines = [f"The run ended early: {recording.stopped}"] if recording.stopped else []
    lines += [str(kind.refusal) for kind in outcome.types if kind.refusal is not None]
    lines += [advice_on_order(kind, ours=not recording.user) for kind in outcome.types if not kind.passed]
    return Group(table, *(Text(line) for line in lines))


def advice_on_order(kind: TypeVerdict, *, ours: bool) -> str:
    """Advise on an element that depends on the order; ours: whether it is one of the project's."""
    if kind.refusal is None:
        return (
            f"{kind.type}: something outlives a call and is not in SVARS: look for SAVE, COMMON, module variables, and "
            "local variables with an initial value in their declaration (which are saved); keep in SVARS what the "
            f"element has to remember. Until then {THREADS}."
        )
    advice = (
        f"{kind.type}: it depends on what calls of other elements leave: give those elements lower "
        f"numbers, and {THREADS}."
    )
    replacement = {"U3": "U4", "U10": "U8"}.get(kind.type) if ours else None
    return f"{advice} {replacement} is the same element without this dependence." if replacement else advice
