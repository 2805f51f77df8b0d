# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compiler diagnostics of the user's files: certain mistakes, and suspicions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from uel.check.finding import Finding, Verdict, failed, not_applicable
from uel.check.subject import Subject
from uel.errors import CompileError
from uel.usersub import Suspicion, is_source, suspicions

MOST: Final = 5
"""Number of warnings shown; the JSON file has all."""

ADVICE: Final = (
    "The compiler is certain that these lines are wrong whenever they are executed. `uel run --debug` stops at the "
    "first one that is."
)


def check(subject: Subject) -> Finding:
    """Check that the compiler is certain of no mistake."""
    recording = subject.recording
    if not recording.user or not all(map(is_source, recording.user)):
        return not_applicable("there are no user sources to compile")
    try:
        found = suspicions(recording.user, (recording.model.deck.resolve().parent,))
    except CompileError as error:
        return not_applicable(f"with all warnings on it does not compile: {error}")
    certain = [one for one in found if one.certain]
    told = [one for one in found if not one.certain]
    entries = tuple(map(str, found))
    if certain:
        return failed(_listed(certain), ADVICE, entries=entries)
    message = f"nothing certain; worth a look:\n{_listed(told)}" if told else "no warnings"
    return Finding(Verdict.PASSED, message, entries=entries)


def _listed(found: Sequence[Suspicion]) -> str:
    more = f"\nand {len(found) - MOST} more" if len(found) > MOST else ""
    return "\n".join(map(str, found[:MOST])) + more
