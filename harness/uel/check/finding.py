# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Result of a check."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Verdict(StrEnum):
    """Outcome of a check."""

    PASSED = "passed"
    FAILED = "failed"
    NOT_APPLICABLE = "not applicable"


class Conclusion(StrEnum):
    """Outcome of all checks: of one element type, or of all."""

    PASSED = "passed"
    FAILED = "failed"
    NOTHING = "nothing looked at"


@dataclass(frozen=True, slots=True)
class Finding:
    """Outcome of one check for one element type.

    message  finding and deviation; for a failure with element, state and entries
    figure   checked number, explained in the message; None if there is none
    limit    of the figure
    entries  of the element's arrays that are wrong, as 'AMATRX(1,2)'
    advice   what to change; '' unless the check failed
    """

    verdict: Verdict
    message: str
    figure: float | None = None
    limit: float | None = None
    entries: tuple[str, ...] = ()
    advice: str = ""


def passed(message: str, figure: float | None = None, limit: float | None = None) -> Finding:
    """Return the finding of a passed check; parameters are entries of `Finding`."""
    return Finding(Verdict.PASSED, message, figure, limit)


def not_applicable(reason: str) -> Finding:
    """Return the finding of a check that does not apply; reason: why, and a deck to which it applies."""
    return Finding(Verdict.NOT_APPLICABLE, reason)


def failed(
    message: str,
    advice: str,
    *,
    figure: float | None = None,
    limit: float | None = None,
    entries: tuple[str, ...] = (),
) -> Finding:
    """Return the finding of a failed check; parameters are entries of `Finding`."""
    return Finding(Verdict.FAILED, message, figure, limit, entries, advice)
