# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Independence of the calling order."""

from __future__ import annotations

from uel.check.finding import Finding, failed, passed
from uel.check.shuffle import ORDERS, advice_on_order
from uel.check.subject import Subject


def check(subject: Subject) -> Finding:
    """Turn the result of `uel check --shuffle` into a finding."""
    order = subject.order
    if order.passed:
        return passed(f"{order.calls} calls in {ORDERS} random orders return the same bits")
    advice = advice_on_order(order, ours=subject.advice_is_ours).removeprefix(f"{order.type}: ")
    return failed(order.first if order.refusal is None else str(order.refusal), advice)
