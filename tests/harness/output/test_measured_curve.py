# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Curves from the CSV files of test machines and spreadsheets."""

from pathlib import Path

import pytest

from harness.errors import UelError
from harness.output.measured_curve import read_curve


@pytest.mark.parametrize(
    "text",
    [
        "0.5,2\n1.5,-4e1\n",
        "u,F\nmm,N\n0.5,2\n1.5,-40\n",
        '"u";"F";"t"\n0,5;2;0\n\n1,5;-40;1\n',
        "\ufeffu\tF\n0,5\t2\n1.5\t-40\n",
        "# of a test\n0.5 2\n1.5   -40\n",
    ],
    ids=["numbers", "names and units", "semicolons", "tabs", "blanks"],
)
def test_separators_and_heads(tmp_path: Path, text: str) -> None:
    file = tmp_path / "test.csv"
    file.write_text(text)
    x, y = read_curve(file, ("displacement", "force"))
    assert (list(x), list(y)) == ([0.5, 1.5], [2.0, -40.0])


def test_columns_by_name(tmp_path: Path) -> None:
    """As in the history of another job."""
    file = tmp_path / "test.csv"
    file.write_text("step,time,U2[TIP],RF2[TIP]\n1,0.1,0.5,2\n1,0.2,1.5,3\n")
    x, y = read_curve(file, ("U2[TIP]", "RF2[TIP]"))
    assert (list(x), list(y)) == ([0.5, 1.5], [2.0, 3.0])


def test_lines_without_numbers(tmp_path: Path) -> None:
    file = tmp_path / "test.csv"
    file.write_text("u,F\n1,2\n3,\n")
    with pytest.raises(UelError, match=r"test\.csv:3: expected numbers in columns 1 and 2"):
        read_curve(file)
    file.write_text("u,F\nnan,1\n")
    with pytest.raises(UelError, match="no line with two numbers; expected a displacement and a load"):
        read_curve(file)
