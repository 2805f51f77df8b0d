# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Curves from the CSV files of test machines and spreadsheets."""

from pathlib import Path

import pytest

from uel.errors import UelError
from uel.output.pictures.column import Column, read_column
from uel.output.pictures.measured_curve import read_curve


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
    x, y = read_curve(file, (Column("displacement"), Column("force")))
    assert (list(x), list(y)) == ([0.5, 1.5], [2.0, -40.0])


def test_columns_by_name(tmp_path: Path) -> None:
    """As in the history of another job."""
    file = tmp_path / "test.csv"
    file.write_text("step,time,U2[TIP],RF2[TIP]\n1,0.1,0.5,2\n1,0.2,1.5,3\n")
    x, y = read_curve(file, (Column("u2[tip]"), Column("RF2[TIP]")))
    assert (list(x), list(y)) == ([0.5, 1.5], [2.0, 3.0])


@pytest.mark.parametrize(
    "head, axes, x, y",
    [
        ("2*U2[TIP], RF2[TIP]", ("U2[TIP]", "RF2[TIP]"), [0.25, 0.5], [2.0, 3.0]),
        ("2*U2[TIP], -rf2[tip]\nmm, N", ("U2[TIP]", "RF2[TIP]"), [0.25, 0.5], [-2.0, -3.0]),
        ("2*U2[TIP], force", ("U2[TIP]", "RF2[TIP]"), [0.25, 0.5], [2.0, 3.0]),
        ("RF2[TIP], 2*U2[TIP]", ("U2[TIP]", "RF2[TIP]"), [1.0, 1.5], [0.5, 1.0]),
        ("2*U2[TIP], RF2[END]", ("U2[MIDDLE]", "RF2[TIP]"), [0.5, 1.0], [2.0, 3.0]),
        ("U2[TIP], RF2[TIP]", ("4*U2[TIP]", "-RF2[TIP]"), [2.0, 4.0], [-2.0, -3.0]),
        ("opening, force", ("2*U2[TIP]", "RF2[TIP]"), [0.5, 1.0], [2.0, 3.0]),
    ],
)
def test_factors_of_the_head(tmp_path: Path, head: str, axes: tuple[str, str], x: list[float], y: list[float]) -> None:
    """As `uel fit` reads them: the test measured twice the displacement of the end."""
    file = tmp_path / "test.csv"
    file.write_text(f"{head}\n0.5, 2\n1, 3\n")
    found = read_curve(file, [read_column(name) for name in axes])
    assert [values.tolist() for values in found] == [x, y]


def test_lines_without_numbers(tmp_path: Path) -> None:
    file = tmp_path / "test.csv"
    file.write_text("u,F\n1,2\n3,\n")
    with pytest.raises(UelError, match=r"test\.csv:3: expected numbers in columns 1 and 2"):
        read_curve(file)
    file.write_text("u,F\nnan,1\n")
    with pytest.raises(UelError, match="no line with two numbers; expected a displacement and a load"):
        read_curve(file)
