# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Columns of the history with a factor."""

import numpy as np
import pytest

from harness.errors import UsageError
from harness.output.column import Column, read_column


@pytest.mark.parametrize(
    "text, name, factor",
    [
        ("U2[TOP]", "U2[TOP]", 1.0),
        ("-RF2[MIDSPAN]", "RF2[MIDSPAN]", -1.0),
        (" 2*U2[TOP] ", "U2[TOP]", 2.0),
        ("-1.5e-3 * ALLWK", "ALLWK", -1.5e-3),
        ("+time", "time", 1.0),
    ],
)
def test_columns(text: str, name: str, factor: float) -> None:
    assert read_column(text) == Column(name, factor)
    assert read_column(str(read_column(text))) == read_column(text)


@pytest.mark.parametrize("text", ["", "  ", "2*", "0*U2[TOP]", "1e999*U2[TOP]", "-"])
def test_words_that_are_no_columns(text: str) -> None:
    with pytest.raises(UsageError, match="expected a column of the history"):
        read_column(text)


def test_values_of_a_column() -> None:
    history = {"time": np.array([1.0, 2.0]), "U2[TOP]": np.array([3.0, 4.0])}
    found = Column("u2[top]", -2.0).find(history)
    assert found is not None
    assert found.tolist() == [-6.0, -8.0]
    assert Column("U2[BOTTOM]").find(history) is None
