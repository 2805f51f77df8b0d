# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""All checks on all user element types of a deck."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from harness.check.checks import CHECKS, Check
from harness.check.finding import Finding, Verdict, failed, not_applicable
from harness.check.recording import record
from harness.check.shuffle import shuffle_recording
from harness.check.subject import Subject, subject_of
from harness.errors import KernelError, UelError
from harness.usersub import ARRAYS, UNSET, marks

LENIENT: Final = {UNSET: 0.0, **dict.fromkeys(ARRAYS, 1e-300)}
"""Entries not set are zero, and guards as good as zero, so that one mistake does not hide all others."""


@dataclass(frozen=True, slots=True)
class TypeReport:
    """Findings on one element type, by the name of the check; states: how many were tried."""

    type: str
    elements: int
    states: int
    findings: dict[str, Finding]


@dataclass(frozen=True, slots=True)
class Examination:
    """Outcome of all checks.

    increments  of the deck that were run; stopped says why these are fewer than asked for
    """

    deck: Path
    user: tuple[Path, ...]
    increments: int
    stopped: str
    seed: int
    types: tuple[TypeReport, ...]

    @property
    def passed(self) -> bool:
        """No check failed."""
        verdicts = [finding.verdict for report in self.types for finding in report.findings.values()]
        return Verdict.FAILED not in verdicts


def examine(
    deck: Path, user: Path | Sequence[Path] = (), *, seed: int = 1, increments: int = 3, skip: Collection[str] = ()
) -> Examination:
    """Run the first increments of a deck and check every user element type in it.

    skip: names of checks that are left out. Raises UelError where nothing can be checked: the deck or the user's file
    is wrong, the first call of the elements fails, or the deck has no user elements.
    """
    files = (user,) if isinstance(user, Path) else tuple(user)
    known = [check.name for check in CHECKS]
    for name in skip:
        if name not in known:
            raise UelError(f"no check is called '{name}'; there are {', '.join(known)}")
    with marks(LENIENT):
        recording = record(deck, files, increments, strict=False)
        users = {group.type for group in recording.model.groups if group.definition is not None}
        if not users:
            raise UelError(f"{deck}: no elements of a type defined by *USER ELEMENT, which are what is checked")
        types = []
        for order in shuffle_recording(recording, seed, strict=False).types:
            if order.type in users:
                with subject_of(recording, order.type, order, seed) as subject:
                    types.append(_examine_type(subject, skip))
    return Examination(deck, files, recording.increments, recording.stopped, seed, tuple(types))


def _examine_type(subject: Subject, skip: Collection[str]) -> TypeReport:
    findings = {check.name: _run(check, subject) for check in CHECKS if check.name not in skip}
    return TypeReport(subject.type, subject.elements, len(subject.all_states), findings)


def _run(check: Check, subject: Subject) -> Finding:
    if check.calls and not subject.states:
        return not_applicable(f"no call of an element by itself returns: {subject.refusal}")
    try:
        return check.function(subject)
    except KernelError as error:
        if not subject.random:
            return not_applicable("the element ends the analysis at all displacements that are not those of the run")
        advice = "The element ended a call that this check makes: it has to return from small changes of its arguments."
        return failed(str(error), advice)
