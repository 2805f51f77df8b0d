# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Finite values of SVARS, ENERGY and PNEWDT."""

from __future__ import annotations

from uel.check.finding import Finding, failed, passed
from uel.check.subject import Subject


def check(subject: Subject) -> Finding:
    """Check that SVARS, ENERGY and PNEWDT are finite in all iterations of the run, for all elements of the type."""
    if not subject.not_finite:
        return passed("SVARS, ENERGY and PNEWDT are finite in all iterations of the run")
    advice = (
        "The run goes on with it, and the damage shows later: NaN in SVARS enters all further increments, ENERGY goes "
        "into the energies of the model, and no comparison notices PNEWDT. Look for 0/0 without deformation, the root "
        "or logarithm of a negative number, and a local variable without a value."
    )
    return failed(subject.not_finite, advice)
