# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Numbers as Abaqus prints them: the expected texts stand in public .msg and .sta files of Abaqus 2018 and 2023."""

import csv
import gzip
import math
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from uel.output.formats import TextFile, exponential, general, status_number

DATA = Path(__file__).parents[2] / "data"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "   0.00    "),
        (1.0, "   1.00    "),
        (0.346, "  0.346    "),
        (100.0, "   100.    "),
        (-749.0, "  -749.    "),
        (12.2, "   12.2    "),
        (1.027e3, "  1.027E+03"),
        (-5.576e-3, " -5.576E-03"),
        (3.838e-16, "  3.838E-16"),
        (-1.364e4, " -1.364E+04"),
    ],
)
def test_numbers_of_the_message_file(value: float, text: str) -> None:
    assert general(value) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (999.6, "  9.996E+02"),
        (0.09996, "  0.100    "),
        (1.5e-120, "  1.500-120"),
        (math.nan, "        NaN"),
        (-math.inf, "  -Infinity"),
    ],
)
def test_numbers_at_the_edges_are_those_of_fortran(value: float, text: str) -> None:
    """As gfortran prints them with 1PG11.3; rounding decides between the two forms."""
    assert general(value) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (7.3531e-4, "  7.3531E-04"),
        (-4.6698e-3, " -4.6698E-03"),
        (0.0, "   0.000    "),
        (5000.0, "   5000.    "),
        (1.4706e8, "  1.4706E+08"),
        (0.25, "  0.2500    "),
    ],
)
def test_numbers_of_the_tables(value: float, text: str) -> None:
    assert general(value, 12, 4) == text


@given(st.floats(-1e300, 1e300, allow_subnormal=False))
def test_printed_numbers_keep_their_digits_and_their_width(value: float) -> None:
    text = general(value, 12, 4)
    assert len(text) == 12
    assert float(re.sub(r"(?<=\d)([+-]\d{3})$", r"E\1", text)) == pytest.approx(value, rel=5.01e-4, abs=0.0)


def test_numbers_of_every_status_line_of_abaqus_are_printed_alike() -> None:
    """Regression: 3994 lines of public status files, as printed."""
    with gzip.open(DATA / "abaqus_increments.csv.gz", "rt") as file:
        rows = list(csv.DictReader(file))
    wrong = [
        row[name]
        for row in rows
        for name, digits in (("total_time", 3), ("step_time", 3), ("time_increment", 4))
        if status_number(float(row[name]), digits) != row[name]
    ]
    assert len(rows) == 3994
    assert wrong == []


def test_a_text_file_replaces_an_older_one_and_is_written_at_once(tmp_path: Path) -> None:
    path = tmp_path / "job.msg"
    path.write_text("an older job, longer than the new one")
    file = TextFile(path)
    file.write("new\n")
    assert path.read_text() == "new\n"
    file.close()


@pytest.mark.parametrize(
    ("value", "text"),
    [
        # importAbaqusDat of GIBBON shows such lines
        (-5.0, " -5.0000000E+00"),
        (-1.1555553, " -1.1555553E+00"),
        (0.0, "  0.0000000E+00"),
        (-0.0, "  0.0000000E+00"),
        (1.5e-100, "  1.5000000-100"),
        (math.inf, "       Infinity"),
    ],
)
def test_values_at_nodes(value: float, text: str) -> None:
    assert exponential(value) == text
