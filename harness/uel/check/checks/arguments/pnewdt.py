# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""PNEWDT, the requested change of the time increment."""

from __future__ import annotations

from typing import Final

from uel.check.finding import Finding, failed, passed
from uel.check.subject import Subject

UNTOUCHED: Final = 1e30
"""Limit above which PNEWDT is the value on entry."""


def check(subject: Subject) -> Finding:
    """Check that PNEWDT is positive and requests no smaller increment without displacement increments."""
    values: list[float] = []
    for state in subject.all_states:
        value = state.evaluate().pnewdt
        if not value > 0.0:
            advice = (
                "PNEWDT multiplies DTIME: between 0 and 1 it asks for a smaller increment; otherwise do not set it."
            )
            return failed(f"{state}: PNEWDT is {value:g}", advice, figure=value, limit=0.0)
        still = state.part(0.0).evaluate().pnewdt
        if still < 1.0:
            advice = (
                "PNEWDT < 1 abandons the increment. Without displacements in it, a smaller one cannot do better, and "
                "the analysis ends after five attempts. Set PNEWDT < 1 only because of what this increment has done."
            )
            return failed(f"{state}: PNEWDT is {still:g} with DU = 0", advice, figure=still, limit=1.0)
        if value < UNTOUCHED:
            values.append(value)
    if not values:
        return passed(f"never set at {len(subject.all_states)} states")
    return passed(f"from {min(values):g} to {max(values):g} where it is set", min(values), 0.0)
