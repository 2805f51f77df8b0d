# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The guide does what it says: its files, its changes to them, and the outputs of its commands."""

import re
from math import exp, hypot

import guide
import pytest
from scipy.optimize import brentq


@pytest.fixture(autouse=True)
def empty_folder(tmp_path, monkeypatch):
    """Where the guide's files are written, and its commands run."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", guide.COLUMNS)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("1, 0.7000000000000001 N", "1,  0.6999999999999999 N", True),
        ("-4000.6282298041378", "-4000.6282298041442", True),
        ("-4000.6282298041378", "-4000.6482298041442", False),
        ("3.2e-17", "8.1e-16", True),
        ("1.2e-05", "1.3e-05", True),
        ("1.2e-05", "1.5e-05", False),
        ("│ a │ is 0.7000000000000001 │\n│   │ N │", "│ a │ is 0.7 N │", True),
        ("0.25 of 3", "0.26 of 3", True),
        ("0.25 of 3", "0.27 of 3", False),
        ("0.25 of 3", "0.25 of 4", False),
        ("0.25 of 3", "0.25 of 3.0", False),
        ("3 cutbacks in less than 0.1 s\n", "3 cutbacks in 12 s\n", True),
    ],
)
def test_texts_are_compared(one, other, same, assert_same):
    if same:
        assert_same(one, other)
    else:
        with pytest.raises(AssertionError):
            assert_same(one, other)


@pytest.mark.nan
def test_guide_is_as_its_commands_say(assert_same):
    text = guide.GUIDE.read_text("utf-8")
    assert_same(guide.replay(text), text)
    assert text.count("│ FAILED") == 6 + 5 + 4 + 2 + 1


def test_result_of_the_guide_is_that_of_theory():
    """Two bars with N = E A e exp(-e/e0) that meet at (200 + u, 170): their horizontal forces are in balance."""

    def force(x, y, length):
        strain = (hypot(x, y) - length) / length
        magnitude = 70000.0 * 10.0 * strain * exp(-strain / 0.1)
        return magnitude * x / hypot(x, y), magnitude * y / hypot(x, y)

    def both(u):
        return force(200.0 + u, 170.0, 250.0), force(-300.0 + u, 170.0, hypot(300.0, 150.0))

    u = brentq(lambda u: sum(horizontal for horizontal, _ in both(u)), -20.0, 20.0)
    *_, u1, rf2 = re.findall(r"^1,4,1\.0,(\S+),(\S+)$", guide.GUIDE.read_text("utf-8"), re.MULTILINE)[0]
    assert float(u1) == pytest.approx(u, rel=1e-3)
    assert float(rf2) == pytest.approx(sum(vertical for _, vertical in both(u)), rel=1e-4)


def test_output_that_is_stale_is_replaced():
    stale = "```text note.txt\none\n```\n```diff note.txt\n-one\n+two\n```\n```console\n$ cat note.txt\none\n```\n"
    assert guide.replay(stale) == stale.replace("$ cat note.txt\none", "$ cat note.txt\ntwo")


def test_change_of_lines_that_are_not_there():
    with pytest.raises(ValueError, match="these lines are there 0 times:\nthree"):
        guide.replay("```text note.txt\none\n```\n```diff note.txt\n-three\n+two\n```\n")
