# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Newton's method alone: the decks of the study, and a row of fortran/newton.md."""

import re
from pathlib import Path

import numpy as np
import pytest

from uel.paper.study.newton import SPECIMENS, TIMES, NewtonDeck, Row, run_row

PAGE = (Path(__file__).parents[2] / "fortran/newton.md").read_text(encoding="utf-8")
PACED = {"VISCOSITY": 3e-4, "PACING": 1.0}


def of_page(run: str) -> list[list[str]]:
    """Counts and changes of the rows of a run on the page."""
    lines = [line.strip("|") for line in PAGE.splitlines() if line.startswith("| ")]
    rows = [[cell.strip() for cell in line.split("|")] for line in lines]
    return [row for row in rows if row[2] == run]


def test_changes_are_those_of_the_loads():
    reference = Row(50, 0, 60, 1.0, np.array([1.0, 4.0, 1.0]))
    row = Row(50, 0, 60, 1.0, np.array([1.0, 5.0, 0.75]))
    assert row.changes(reference) == pytest.approx((0.25, -0.25, 0.125))
    assert row.cells(reference) == ["50", "0", "60", "+25.00 %", "-25.00 %", "+12.50 %"]
    assert Row(9, 5, 60, 0.5, row.loads).cells(reference)[3] == "stops at 50%"


def percent(cell: str) -> float:
    """A relative change of the page."""
    return float(re.sub(r"[ %]", "", cell)) / 100


def test_the_page_has_every_deck_and_what_its_text_says():
    for run in ("VISCOSITY=3e-4 PACING=1", "VISCOSITY=1e-4 PACING=1", "fall-back"):
        assert [row[0] for row in of_page(run)] == [name for name in SPECIMENS for _ in range(3)]
    rows = of_page("VISCOSITY=1e-4 PACING=1")
    assert sorted(int(row[4]) for row in rows)[-2:] == [8, 14]
    assert sum(abs(percent(row[7])) <= 5e-3 for row in rows) == 13
    assert sum(abs(percent(row[6])) <= 5e-3 for row in rows) == 9
    assert (min(int(row[3]) for row in rows), max(int(row[3]) for row in rows)) == (61, 1615)
    assert max(percent(row[7]) for row in of_page("VISCOSITY=3e-4 PACING=1") if row[:2] != ["mmb_20", "1 mm"]) == 0.025
    assert max(int(row[4]) for row in of_page("VISCOSITY=1e-4")) == 153


@pytest.mark.long
def test_a_row_of_the_page(tmp_path):
    reference = run_row(NewtonDeck("enf", 0.5), tmp_path, fallback=True)
    row = run_row(NewtonDeck("enf", 0.5, PACED, "paced"), tmp_path, fallback=False)
    assert len(reference.loads) == len(row.loads) == len(TIMES)
    (known,) = (cells for cells in of_page("VISCOSITY=3e-4 PACING=1") if cells[:2] == ["enf", "0.5 mm"])
    # counts may differ by an iteration or two on another processor, loads hardly
    assert row.cutbacks <= int(known[4]) + 2
    assert row.changes(reference) == pytest.approx([percent(cell) for cell in known[6:]], abs=5e-4)
