# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Columns of the history with a factor."""

import numpy as np
import pytest

from uel.errors import UsageError
from uel.output.pictures.column import Column, read_column


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
    assert Column("u2[top]", -2.0).find(history, "job").tolist() == [-6.0, -8.0]
    with pytest.raises(UsageError, match=r"job: no column 'U2\[BOTTOM\]'; expected one of time, U2\[TOP\]$"):
        Column("U2[BOTTOM]").find(history, "job")


def test_a_set_of_nodes() -> None:
    """The sum of forces; a displacement that all nodes have."""
    history = {
        "increment": np.array([1.0, 2.0]),
        "U2[END:3]": np.array([0.1, 0.2]),
        "U2[END:7]": np.array([0.1, 0.2]),
        "U1[END:3]": np.array([0.1, 0.2]),
        "U1[END:7]": np.array([0.1, 0.3]),
        "RF2[END:3]": np.array([1.0, 2.0]),
        "RF2[END:7]": np.array([3.0, 5.0]),
    }
    assert Column("U2[end]", 2.0).find(history, "job").tolist() == [0.2, 0.4]
    for name in ("RF2[END]", "sum of RF2[END]"):
        assert read_column(f"-{name}").find(history, "job").tolist() == [-4.0, -7.0]
    assert Column("RF2[END:7]").find(history, "job").tolist() == [3.0, 5.0]
    with pytest.raises(
        UsageError, match=r"job: U1\[END\] differs from node to node; expected one, such as U1\[END:3\]$"
    ):
        Column("U1[END]").find(history, "job")
    known = r"U2\[END\] \(U2\[END:3\] to U2\[END:7\]\), U1\[END\] \(.*\), RF2\[END\] \(RF2\[END:3\] to RF2\[END:7\]\)$"
    with pytest.raises(UsageError, match=f"no column 'RF1\\[END\\]'; expected one of {known}"):
        Column("RF1[END]").find(history, "job")


def test_a_sum_is_named_as_runs_tell_it() -> None:
    assert Column("sum of RF2[END]").names("RF2[end]")
    assert Column("RF2[END]").names("Sum of RF2[END]")
