# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A short run of the fuzzer, and that it sees what it is there for."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import uel
from uel.deck.keywords import KEYWORDS
from uel.deck.language.table import Support
from uel.errors import DeckError

HERE = Path(__file__).parent
PROGRAMS = HERE.parent / "programs" / "fuzz"
DECKS = sorted((PROGRAMS / "decks").glob("*.inp"))
OWN_DECKS = (HERE.parents[1] / "abaqus_inputs", HERE.parent)
REASONS = {
    "resumed": r"resumed.inp:3: \*RESTART, READ: the model is that of an earlier job",
    "user-routines": r"user-routines.inp:\d+: \*USER MATERIAL: material MECHANICAL needs UMAT",
}
"""Why a deck for the fuzzer does not run by itself."""
DECK = HERE.parent / "harness" / "deck" / "flat.inp"
BROKEN = """\
import os, sys, time
import fuzz, trial
fuzz.SECONDS = fuzz.WAIT = 1

def broken(case, folder):
    number = int(folder.name)
    if number == 0:
        while True: pass
    if number == 1:
        time.sleep(100)
    if number == 2:
        os.abort()
    if number == 3:
        os._exit(3)
    try:
        bytearray(fuzz.BYTES)
    except MemoryError:
        return "too much memory", ""
    return "runs", ""

trial.run = broken
sys.exit(fuzz.main())
"""


def fuzz(*arguments):
    command = [sys.executable, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_each_keyword_that_is_read_is_damaged():
    texts = [path.read_text() for folder in OWN_DECKS for path in folder.rglob("*.inp")]
    used = {"".join(name.split()).upper() for text in texts for name in re.findall(r"(?m)^\*([A-Za-z][^,\n]*)", text)}
    assert {name for name, keyword in KEYWORDS.items() if keyword.support is Support.READ} <= used


@pytest.mark.parametrize("deck", DECKS, ids=lambda deck: deck.stem)
def test_decks_to_damage_are_sound(tmp_path, deck):
    """Damage to a deck that is refused anyway would reach nothing behind the place of its error."""
    if deck.stem in REASONS:
        with pytest.raises(DeckError, match=REASONS[deck.stem]):
            uel.run(deck, output_dir=tmp_path)
    else:
        assert uel.run(deck, output_dir=tmp_path).completed


@pytest.mark.nan
@pytest.mark.parametrize("count", [500, pytest.param(50_000, marks=pytest.mark.long)])
def test_damaged_decks_run_or_end_with_an_error_that_names_the_place(tmp_path, count):
    result = fuzz(PROGRAMS / "fuzz.py", "--count", count, "--seed", 20, "--output", tmp_path / "findings")
    assert result.returncode == 0, result.stdout + result.stderr
    assert f"{count} trials of" in result.stdout
    assert not (tmp_path / "findings").exists()


def test_findings_are_seen_and_kept(tmp_path, monkeypatch):
    """A process that ends is replaced, and the trials go on."""
    script = tmp_path / "broken.py"
    script.write_text(BROKEN)
    monkeypatch.setenv("PYTHONPATH", str(PROGRAMS), prepend=os.pathsep)
    result = fuzz(script, "--count", 6, "--output", tmp_path / "findings", DECK)
    assert result.returncode == 1, result.stdout + result.stderr
    for line in ("2 too much memory", "2 timeout", "1 exit code -6", "1 exit code 3"):
        assert f"{line}\n" in result.stdout
    kept = {path.name: {file.name for file in path.iterdir()} for path in (tmp_path / "findings").iterdir()}
    assert kept.keys() == {f"1-{number}" for number in (0, 2, 3, 4)}
    assert all({"deck.inp", "finding.txt"} <= files for files in kept.values())


def test_one_trial_is_made_again():
    result = fuzz(PROGRAMS / "fuzz.py", "--case", 7, DECK)
    assert result.returncode == 0, result.stderr
    assert result.stdout.startswith(f"{DECK}\nrefused\n")
