# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tables of values: each message with its place, and what is read."""

from pathlib import Path

import pytest

from uel.batch.table import Row, read_table
from uel.batch.values import value_of
from uel.errors import DeckError, UsageError

NAMES = ("length", "count")


@pytest.fixture
def table(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return Path("values.csv")


def read(table: Path, text: str) -> list[Row]:
    table.write_bytes(text.encode())
    return read_table(table, Path("beam.inp"), NAMES)


def test_rows(table: Path) -> None:
    """Blanks, empty lines, quotes, and the marks that Excel writes at the beginning and at the ends of lines."""
    assert read(table, '\ufeffjob, LENGTH ,count\r\n a, 1e-3 ,4\r\n\r\n"b c",-2,"5"\r\n') == [
        Row("a", (("LENGTH", "1e-3"), ("count", "4"))),
        Row("b c", (("LENGTH", "-2"), ("count", "5"))),
    ]
    assert read(table, "count\n1\n") == [Row("", (("count", "1"),))]
    assert read(table, "job\na\n") == [Row("a", ())]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"1: expected names of parameters of beam\.inp, with commas between them"),
        ("length\n", "1: expected a line of values for each run below the line of names"),
        ("length,\n1,2\n", "1: column 2 has no name"),
        ("length,length\n1,2\n", "1: column 2: there is another column 'length'"),
        (
            "\nlenth\n1\n",
            r"2: column 'lenth': beam\.inp defines no parameter of this name; its parameters are length, count; "
            r"did you mean length\?",
        ),
        ("length,count\n1\n", "2: expected a value for each of length, count, found 1 value"),
        ("length,count\n1,2\n1,2,3\n", "3: expected a value for each of length, count, found 3 values"),
        ("length,count\n1,\n", "2: count: expected a number, found ''"),
        ("length,count\n1,2\n1,many\n", "3: count: expected a number, found 'many'"),
        ("length\nnan\n", "2: length: expected a number, found 'nan'"),
        ("job,length\na/b,1\n", "2: job: expected a file name without folders, found 'a/b'"),
        ("job,length\n,1\n", "2: job: expected a file name without folders, found ''"),
        ("job,length\na,1\n\na,2\n", r"4: job: 'a' is also the name of the run of values\.csv:2"),
        ("length\n" + "1" * 200_000 + "\n", "2: not a table of values: field larger than field limit"),
    ],
)
def test_mistakes(table: Path, text: str, message: str) -> None:
    with pytest.raises(DeckError, match=rf"^values\.csv:{message}"):
        read(table, text)


def test_all_mistakes_at_once(table: Path) -> None:
    with pytest.raises(DeckError, match=r"(?s)values\.csv:2: length.*'a'\nvalues\.csv:4: length.*'c'$"):
        read(table, "length\na\n1\nc\n")


def test_table_that_cannot_be_read(table: Path) -> None:
    with pytest.raises(UsageError, match=r"--table values\.csv: No such file or directory"):
        read_table(table, Path("beam.inp"), NAMES)
    with pytest.raises(UsageError, match=r"--table a\0b: .*embedded null"):
        read_table(Path("a\0b"), Path("beam.inp"), NAMES)
    table.mkdir()
    with pytest.raises(UsageError, match=r"--table values\.csv: Is a directory"):
        read_table(table, Path("beam.inp"), NAMES)


@pytest.mark.parametrize(("text", "value"), [("4", 4), (" 4 ", 4), ("-4.", -4.0), ("1e3", 1000.0)])
def test_numbers(text: str, value: float) -> None:
    """Whole where they are written so, as in *PARAMETER."""
    assert (value_of(text), type(value_of(text))) == (value, type(value))


@pytest.mark.parametrize("text", ["", "x", "inf", "nan", "1_000", "1,5", "1e999", "0x10", "9" * 5000])
def test_texts_that_are_no_numbers(text: str) -> None:
    with pytest.raises(ValueError):
        value_of(text)
