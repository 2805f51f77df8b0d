# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""How pages are compared with what their commands print now."""

import re
from collections.abc import Callable

import pytest

NUMBER = re.compile(r"-?\d+\.\d+(?:[eE][-+]\d+)?|-?\d+[eE][-+]\d+")

DURATION = re.compile(r" in (?:less than |\d+ min )?[\d.]+ s$", re.MULTILINE)
"""How long a run took, which no run repeats."""


def same(found: str, expected: str, tolerance: float = 1e-6) -> None:
    """The texts are the same but for what another processor or compiler may round otherwise.

    How long a number is and where lines of a table break follow from that. Numbers agree to the tolerance, or to a unit
    of the last digit printed; what is below 1e-9 is rounding.
    """
    found, expected = (DURATION.sub("", text) for text in (found, expected))
    words, others = (re.sub(r"[\s\u2500-\u257f]+", " ", NUMBER.sub("NUMBER", text)) for text in (found, expected))
    assert words == others
    for one, other in zip(NUMBER.findall(found), NUMBER.findall(expected), strict=True):
        digits, _, exponent = min(one, other, key=len).lower().partition("e")
        unit = 10.0 ** (int(exponent or 0) - len(digits.partition(".")[2]))
        assert float(one) == pytest.approx(float(other), rel=tolerance, abs=max(1.01 * unit, 1e-9)), f"{one}, {other}"


@pytest.fixture
def assert_same() -> Callable[..., None]:
    return same
