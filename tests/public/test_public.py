# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Public user elements, unmodified, from the folder of checkouts that the environment variable UEL_PUBLIC names."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

import measure  # noqa: E402 (a script beside this file)

FOLDER = os.environ.get("UEL_PUBLIC", "")


@pytest.mark.long
@pytest.mark.skipif(not FOLDER, reason="UEL_PUBLIC names no folder of public user elements")
@pytest.mark.parametrize("name", [name for name, row in measure.rows().items() if "grade" in row])
def test_row_agrees(name):
    absent = measure.missing(Path(FOLDER), measure.rows()[name])
    if absent:
        pytest.skip(f"{FOLDER} has no {measure.rows()[name]['folder']}/{absent[0]}")
    command = [sys.executable, str(HERE / "table.py"), FOLDER, name]
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
        if "grade" in row:
            assert "quantity" in row or "status" in row


def test_files_that_are_not_there_are_named():
    name, row = next(iter(measure.rows().items()))
    assert measure.missing(HERE, row) == [row["deck"], *row["sources"]], name
