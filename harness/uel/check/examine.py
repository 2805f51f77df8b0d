# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""All checks on all user element types of a deck."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from uel.check.checks import CHECKS, Check
from uel.check.finding import Conclusion, Finding, Verdict, failed, not_applicable
from uel.check.progress import Progress, Running, no_progress
from uel.check.recording import Recording, record_leniently
from uel.check.shuffle import TypeVerdict, shuffle_recording
from uel.check.subject import Subject, subject_of
from uel.errors import CallLimitError, KernelError, UelError
from uel.usersub import ARRAYS, AS_GOOD_AS_ZERO, UNSET, guard_values

LENIENT: Final = {UNSET: 0.0, **dict.fromkeys(ARRAYS, AS_GOOD_AS_ZERO)}
"""Entries that are not set are zero, and guards almost zero, so that one mistake does not hide all others."""

IDLE: Final = "RHS and AMATRX are zero at every state tried"
IDLE_ADVICE: Final = (
    "Look for entries of AMATRX and RHS that are set to zero and never filled, for a factor that is zero (a misspelt "
    "variable, a property that *UEL PROPERTY does not give), and for a request, LFLAGS(3) = 1, that is not answered. "
    "If the deck does not load these elements, take one in which they resist something."
)

ENDLESS: Final = (
    "A call did not return in time (--call-limit): look for a loop that ends only when something converges, give it a "
    "largest number of iterations, and return PNEWDT < 1 if that is not enough."
)


@dataclass(slots=True)
class TypeReport:
    """Findings on one element type so far, by the name of the check; states: how many were tried."""

    type: str
    elements: int
    states: int = 0
    findings: dict[str, Finding] = field(default_factory=dict)

    @property
    def conclusion(self) -> Conclusion:
        """Conclusion: failed if any check failed; passed if, of the checks made, one that judges forces applied."""
        verdicts = {name: finding.verdict for name, finding in self.findings.items()}
        if Verdict.FAILED in verdicts.values():
            return Conclusion.FAILED
        decisive = [verdicts[check.name] for check in CHECKS if check.forces and check.name in verdicts]
        return Conclusion.PASSED if Verdict.PASSED in (decisive or verdicts.values()) else Conclusion.NOTHING

    @property
    def looked_at(self) -> tuple[str, ...]:
        """Names of the checks that applied."""
        return tuple(name for name, finding in self.findings.items() if finding.verdict is not Verdict.NOT_APPLICABLE)

    @property
    def unseen(self) -> str:
        """Reason why nothing was looked at, as a sentence; '' if something was."""
        if self.conclusion is not Conclusion.NOTHING:
            return ""
        reasons = [
            self.findings[check.name].message for check in CHECKS if check.forces and check.name in self.findings
        ]
        return f"{self.type}: nothing was looked at: {reasons[0] if reasons else 'all checks were left out'}"


@dataclass(frozen=True, slots=True)
class Examination:
    """Outcome of all checks.

    increments  of the deck that were run; stopped says why the run ended early
    warnings    about the deck
    """

    deck: Path
    user: tuple[Path, ...]
    increments: int
    stopped: str
    seed: int
    types: list[TypeReport]
    warnings: tuple[str, ...] = ()

    @property
    def conclusion(self) -> Conclusion:
        """Worst conclusion of all types: a failure, then one of which nothing was looked at."""
        conclusions = {report.conclusion for report in self.types}
        worst = Conclusion.FAILED, Conclusion.NOTHING, Conclusion.PASSED
        return next((conclusion for conclusion in worst if conclusion in conclusions), Conclusion.NOTHING)

    @property
    def passed(self) -> bool:
        """True if no check failed, and every type was looked at."""
        return self.conclusion is Conclusion.PASSED


def examine(
    deck: Path,
    user: Path | Sequence[Path] = (),
    *,
    seed: int = 1,
    increments: int = 3,
    skip: Collection[str] = (),
    progress: Progress = no_progress,
) -> Examination:
    """Run the first increments of a deck and check every user element type in it.

    Parameters
    ----------
    deck
        Deck with user elements.
    user
        User files in the order of compilation; none: the elements of the project.
    seed
        Of random orders of calls and random displacements.
    increments
        Largest number of increments.
    skip
        Names of checks to leave out.
    progress
        Called at the start of each task, with the findings so far.

    Raises UelError if nothing can be checked: the deck or the user file is wrong, the first call of the elements fails,
    the deck has no user elements, or a name to skip is unknown.
    """
    files = (user,) if isinstance(user, Path) else tuple(user)
    known = [check.name for check in CHECKS]
    for name in skip:
        if name not in known:
            raise UelError(f"unknown check '{name}'; expected one of {', '.join(known)}")
    checks = [check for check in CHECKS if check.name not in skip]
    with guard_values(LENIENT):
        progress(Running("the run of the deck"), None)
        recording = record_leniently(deck, files, increments)
        users = {group.type for group in recording.model.groups if group.definition is not None}
        if not users:
            raise UelError(f"{deck}: nothing to check: no elements of a type defined by *USER ELEMENT")
        progress(Running("calls of all elements in random orders"), None)
        orders = [order for order in shuffle_recording(recording, seed, strict=False).types if order.type in users]
        types: list[TypeReport] = []
        warnings = recording.model.warnings
        outcome = Examination(deck, files, recording.increments, recording.stopped, seed, types, warnings)
        for order in orders:
            types.append(TypeReport(order.type, order.elements))
            _examine_type(recording, order, checks, outcome, progress)
    return outcome


def _examine_type(
    recording: Recording, order: TypeVerdict, checks: Sequence[Check], outcome: Examination, progress: Progress
) -> None:
    """Fill the last report. After a call that does not return, the remaining checks are not made."""
    report = outcome.types[-1]
    running = CHECKS[0].name
    progress(Running(f"calls of {order.type} at states of the run and random ones", running), outcome)
    try:
        with subject_of(recording, order.type, order, outcome.seed) as subject:
            report.states = len(subject.all_states)
            for check in checks:
                running = check.name
                progress(Running(f"the check '{running}' of {order.type}", running), outcome)
                report.findings[running] = _run(check, subject, report.findings)
    except CallLimitError as error:
        report.findings[running] = failed(str(error), ENDLESS)
        for check in checks:
            missed = not_applicable(f"not run, because a call did not return in '{running}', which comes first")
            report.findings.setdefault(check.name, missed)


def _run(check: Check, subject: Subject, before: Mapping[str, Finding]) -> Finding:
    explained = before.get(check.unless)
    if explained is not None and explained.verdict is Verdict.FAILED:
        return not_applicable(f"it tells nothing while '{check.unless}' fails")
    if check.calls and not subject.states:
        return not_applicable(
            f"no element returns from a call by itself: {subject.refusal}; fix that, or take a deck in which one does"
        )
    if check.forces and subject.idle:
        reported = any(other.forces and other.name in before for other in CHECKS)
        return not_applicable(IDLE) if reported else failed(IDLE, IDLE_ADVICE)
    try:
        return check.function(subject)
    except KernelError as error:
        if not subject.random:
            return not_applicable(
                "the element ends the analysis at all displacements other than those of the run: take a deck in "
                "which it may move, and does not need calls of other elements"
            )
        advice = "The element ended a call that this check made: it has to return if its arguments change a little."
        return failed(str(error), advice)
