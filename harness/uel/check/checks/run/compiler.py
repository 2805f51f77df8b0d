# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compiler diagnostics of the user's files: certain mistakes and suspicions."""

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
    """Check that the compiler reports no certain mistake."""
    recording = subject.recording
    if not recording.user or not all(map(is_source, recording.user)):
        return not_applicable("there are no user sources to compile")
    try:
        diagnostics = suspicions(recording.user, (recording.model.deck.resolve().parent,))
    except CompileError as error:
        return not_applicable(f"with all warnings on it does not compile: {error}")
    certain = [entry for entry in diagnostics if entry.certain]
    suspected = [entry for entry in diagnostics if not entry.certain]
    entries = tuple(map(str, diagnostics))
    if certain:
        return failed(_listed(certain), ADVICE, entries=entries)
    message = f"nothing certain; worth a look:\n{_listed(suspected)}" if suspected else "no warnings"
    return Finding(Verdict.PASSED, message, entries=entries)


def _listed(entries: Sequence[Suspicion]) -> str:
    more = f"\nand {len(entries) - MOST} more" if len(entries) > MOST else ""
    return "\n".join(map(str, entries[:MOST])) + more
