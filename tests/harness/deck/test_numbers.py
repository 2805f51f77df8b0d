# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Numbers one by one, and blocks of them."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from uel.deck.language.numbers import integer_table, read_integer, read_real, real_table
from uel.deck.language.table import split_fields


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1", 1.0),
        ("-1.5", -1.5),
        (".5", 0.5),
        ("1.", 1.0),
        ("1.d-3", 1e-3),
        ("2D+3", 2e3),
        ("210e9.0", 210e9),
        ("+1E3", 1e3),
    ],
)
def test_reals(text: str, value: float) -> None:
    assert read_real(text) == value


@pytest.mark.parametrize(
    "text", ["", "1_000", "nan", "inf", "1e", "e5", "1e999", "1 2", "0x10", "1.5.2", "210e9.5", "\u0661"]
)
def test_no_reals(text: str) -> None:
    with pytest.raises(ValueError, match=r"is not a number|is too large"):
        read_real(text)


@pytest.mark.parametrize("text", ["", "1.5", "1e3", "3000000000", "9" * 5000, "\u0661"])
def test_no_integers(text: str) -> None:
    with pytest.raises(ValueError, match=r"is not an integer|is too large"):
        read_integer(text)


BLOCKS = {
    "plain": ["1, 2.5, -3e-2", "4,+5.,.5"],
    "commas at the ends": ["1, 2,", "3, 4, "],
    "integers": ["1, 2", "-3, +4"],
    "one integer is written as a real number": ["1, 2", "3, 4."],
    "one integer has an exponent": ["1, 2", "3, 4e0"],
    "exponents with D": ["1., 2.d0", "3., 4."],
    "two exponents in one spelling": ["1., 210e9.0"],
    "ragged": ["1, 2", "3"],
    "blank line": ["1, 2", "", "3, 4"],
    "blank lines alone": ["", ""],
    "empty": [],
    "empty field": ["1, , 3"],
    "empty first field": [", 1"],
    "two numbers in a field": ["1 2, 3"],
    "not a number": ["nan, 1", "2, 3"],
    "infinite": ["inf, 1"],
    "too large": ["1e999, 1"],
    "too large for an integer": ["3000000000, 1"],
    "too large for 64 bits": ["99999999999999999999, 1"],
    "too small": ["1, 5e-324"],
    "underscore": ["1_000, 2"],
    "hexadecimal": ["0x10, 2"],
    "digits of another script": ["\u0661, 2"],
    "blank of another script": ["1,\u00a02"],
    "comment of other programs": ["1, 2 # 3"],
    "quotes": ['"1", 2'],
}


@pytest.mark.parametrize("lines", BLOCKS.values(), ids=BLOCKS)
def test_block(lines: list[str]) -> None:
    """A block that is read at once holds what its fields hold one by one; one with other spellings is left to them."""
    for read_block, read in ((real_table, read_real), (integer_table, read_integer)):
        try:
            expected = [[read(field) for field in split_fields(line.rstrip(", "))] for line in lines]
        except ValueError:
            expected = []
        found = read_block(lines)
        if found is not None:
            assert_array_equal(found, expected)
            assert found.shape == np.shape(expected)


@pytest.mark.parametrize("name", ["plain", "commas at the ends", "integers", "one integer has an exponent"])
def test_blocks_of_real_numbers_at_once(name: str) -> None:
    assert real_table(BLOCKS[name]) is not None


@pytest.mark.parametrize("name", ["commas at the ends", "integers"])
def test_blocks_of_integers_at_once(name: str) -> None:
    assert integer_table(BLOCKS[name]) is not None


def test_first_column_of_integers() -> None:
    assert_array_equal(integer_table(BLOCKS["plain"], columns=1), [[1], [4]])
    assert integer_table(["2e0, 1.5"], columns=1) is None
