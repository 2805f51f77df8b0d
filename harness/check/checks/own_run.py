# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The element gets through the run of the deck."""

from __future__ import annotations

from harness.check.finding import Finding, failed, passed
from harness.check.subject import Subject


def check(subject: Subject) -> Finding:
    """No element of the type ended it."""
    recording = subject.recording
    failure = recording.failure
    if failure is None or failure.element_type != subject.type:
        return passed(f"{recording.increments} increments of the deck")
    advice = (
        "Run the deck with `uel run` and look at the printed messages. NaN mostly comes from a division by zero or "
        "the root of a negative number at a state far from equilibrium: return PNEWDT < 1 there, and Abaqus tries a "
        "smaller increment."
    )
    return failed(str(failure), advice)
