# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The measured curve of `uel fit`, and that of a run at its places."""

from pathlib import Path

import numpy as np
import pytest

from uel.errors import DeckError, UelError, UsageError
from uel.fit.curve import Measurement, measured_curve, read_points
from uel.output.pictures.column import Column


def test_curve_of_a_file(tmp_path: Path) -> None:
    file = tmp_path / "curve.csv"
    file.write_text("\ufeff2*U1[END], RF1[END]\n\n0.1, 1\n0.2,2.5\r\n 0.4 , 2 \n", encoding="utf-8")
    found = measured_curve(read_points(file, None, None))
    assert found.x.tolist() == [0.1, 0.2, 0.4]
    assert found.y.tolist() == [1.0, 2.5, 2.0]
    assert found.columns == (Column("U1[END]", 2.0), Column("RF1[END]", 1.0))
    assert read_points(file, "time", "-RF1[END]").columns == (Column("time", 1.0), Column("RF1[END]", -1.0))


@pytest.mark.parametrize(
    "text, message",
    [
        ("x, y\n1, 2\n2, 3\n", r"curve.csv:1: expected a line of two names and at least 3 points, found 2"),
        ("x, y, z\n", r"curve.csv:1: expected two columns, found 3"),
        ("x, y\n1, 2\n2, b\n3, 4\n", r"curve.csv:3: expected two numbers, found '2, b'"),
        ("x, y\n1, 2\n2, nan\n3, 4\n", r"curve.csv:3: expected finite numbers, found '2, nan'"),
        ("x, y\n1, 2\n3, 3\n2, 4\n", r"curve.csv:4: x has to rise: 2 after 3"),
        ("", r"curve.csv:1: expected a line of two names"),
    ],
)
def test_wrong_files(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "curve.csv").write_text(text)
    with pytest.raises(DeckError, match=message):
        measured_curve(read_points(tmp_path / "curve.csv", None, None))


def test_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"none.csv: No such file"):
        read_points(tmp_path / "none.csv", None, None)


X = np.array([1.0, 2.0, 3.0])
MEASURED = Measurement(X, X, (Column("U", 2.0), Column("F", -1.0)))


def test_run_is_interpolated() -> None:
    # the displacement turns back after the measured curve ends, which does not count
    history = {"U": np.array([1.0, 1.5, 1.0]), "F": np.array([-10.0, -20.0, 5.0])}
    assert MEASURED.of_run(history, "job").tolist() == [5.0, 10.0, 20.0]


@pytest.mark.parametrize(
    "history, message",
    [
        ({"V": X, "F": X, "step": X}, r"job: no column 'U'; expected one of V, F$"),
        ({"U": np.array([0.5, 1.0]), "F": np.zeros(2)}, r"job: the run ends at 2\*U = 2, the measured curve at 3$"),
        ({"U": np.array([0.5, 0.4, 2.0]), "F": np.zeros(3)}, r"job: 2\*U does not rise from increment to increment"),
    ],
)
def test_runs_that_cannot_be_compared(history: dict[str, np.ndarray], message: str) -> None:
    with pytest.raises(UelError, match=message):
        MEASURED.of_run(history, "job")
