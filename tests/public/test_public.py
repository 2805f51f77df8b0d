# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Public user elements, unmodified, from the folder of checkouts that the environment variable UEL_PUBLIC names."""

import os
import subprocess
import sys
import tomllib
from pathlib import Path

import check_table
import measure
import pytest
import table

HERE = Path(__file__).parent
PROGRAM = Path(table.__file__)

FOLDER = os.environ.get("UEL_PUBLIC", "")


@pytest.mark.long
@pytest.mark.skipif(not FOLDER, reason="UEL_PUBLIC names no folder of public user elements")
@pytest.mark.parametrize("name", [name for name, row in measure.rows().items() if "grade" in row])
def test_row_agrees(name):
    absent = measure.missing(Path(FOLDER), measure.rows()[name])
    if absent:
        pytest.skip(f"{FOLDER} has no {measure.rows()[name]['folder']}/{absent[0]}")
    command = [sys.executable, str(PROGRAM), FOLDER, name]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr


def test_manifest_is_well_formed():
    """Names are unique, and what a row says of its figure is complete."""
    found = measure.rows()
    assert len(found) == measure.MANIFEST.read_text().count("[[row]]")
    for row in found.values():
        assert {"code", "folder", "sources", "deck"} <= row.keys()
        assert ("expected" in row or "reference" in row) == ("grade" in row) == ("tolerance" in row or "status" in row)
        assert not ("expected" in row and "reference" in row)
        assert row.get("reason", "unknown") in table.REASONS
        assert "reason" in row or "refused" not in row
        if "grade" in row:
            assert "quantity" in row or "status" in row


def test_files_that_are_not_there_are_named():
    name, row = next(iter(measure.rows().items()))
    assert measure.missing(HERE, row) == [row["deck"], *row["sources"]], name


def test_rows_may_stand_behind_options(tmp_path, monkeypatch):
    name, row = next(iter(measure.rows().items()))
    monkeypatch.setattr(sys, "argv", ["table.py", str(tmp_path), "-o", str(tmp_path / "page.md"), name])
    assert table.main() == 1
    page = (tmp_path / "page.md").read_text()
    assert page.splitlines()[-1].startswith(f"| {row['code']} | ")
    assert f"not in the folder: {row['deck']}" in page


def test_long_messages_are_shortened():
    """A refused row is judged by the whole message."""
    outcome = measure.Outcome(error="a | b " * 60 + "C3D8H")
    shown = f"refused: {outcome.error[:297]}...".replace("|", "\\|")
    assert table.verdict({"refused": "C3D8H"}, outcome) == (True, shown)


def test_summary_counts_decks_by_what_stops_them():
    """9 decks of 2 repositories: what is no fault of ours is left out of the share that runs, 3 of 5."""
    reasons = ["", "", "", "unsupported", "time", "solver", "deck", "code", "code"]
    known = {
        str(k): {"folder": str(k % 2)} | ({"reason": reason} if reason else {}) for k, reason in enumerate(reasons)
    }
    outcomes = {name: measure.Outcome(error=row.get("reason", "")) for name, row in known.items()}
    text = table.summary(known, outcomes)
    assert text.startswith("Of 9 decks of 2 repositories 3 run, ")
    assert "3 of 5 run,\n60 %. What stops the others:" in text
    assert "| a fault of the user's code, or a library or compiler it needs | 2 |\n" in text
    assert table.summary({"a": {"folder": "a"}}, {"a": measure.Outcome(error="?")}).count("not known | 1 |") == 1


def test_rows_that_are_checked():
    """One for each pair of sources and deck, with user elements; causes belong to them."""
    chosen = check_table.chosen()
    pairs = {(row["folder"], *row["sources"], row["deck"]) for row in measure.rows().values() if row["sources"]}
    assert 0 < len(chosen) <= len(pairs)
    assert not any("refused" in row for row in chosen.values())
    assert set(tomllib.loads(check_table.CAUSES.read_text())) <= set(chosen)


ROW = {"code": "a code", "folder": "check", "sources": ["quad.f"], "deck": "patch.inp"}


def test_row_of_the_table_of_checks(tmp_path):
    """A deck of this repository in place of a public one."""
    folder = HERE.parent / "harness"
    assert check_table.check(folder, ROW, 60)["error"] == "not in the folder: patch.inp"
    assert check_table.lines(ROW, {"error": "a | b"}, "why") == "| a code | patch.inp | | | a \\| b | why |\n"
    row = ROW | {"sources": [], "deck": "flat_u3.inp", "folder": "abaqus_inputs/patch_horizontal"}
    found = check_table.check(HERE.parents[1], row, 120)
    bulk, interface = check_table.lines(row, found, "why").splitlines()
    assert bulk.startswith("| a code | flat_u3.inp | U1 | ")
    assert bulk.endswith(" |  |  |")
    assert "| **order**: element " in interface
    assert interface.endswith(" | why |")
    assert "not finished after 0.01 s" in check_table.check(HERE.parents[1], row, 0.01)["error"]
