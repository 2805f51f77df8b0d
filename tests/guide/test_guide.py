# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The guide does what it says: its files, its changes to them, and the outputs of its commands."""

import re
import sys
from math import exp, hypot
from pathlib import Path

import pytest
from scipy.optimize import brentq

sys.path.insert(0, str(Path(__file__).parent))

import guide


@pytest.fixture(autouse=True)
def empty_folder(tmp_path, monkeypatch):
    """Where the guide's files are written, and its commands run."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", guide.COLUMNS)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


def without_rounding(text):
    """The text without what another processor or compiler may round otherwise, and without padding to such numbers."""
    text = re.sub(r"\b\d\.\de[-+]\d\d\b", "TINY", text)
    text = re.sub(r"(\d\.\d{6})\d+", r"\1", text)
    return re.sub(r" +|[━─]+", " ", text)


@pytest.mark.nan
def test_guide_is_as_its_commands_say():
    text = guide.GUIDE.read_text("utf-8")
    assert without_rounding(guide.replay(text)) == without_rounding(text)
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
