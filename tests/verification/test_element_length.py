# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Interface elements that are too long for the process zone cost what the guide says."""

import re
from pathlib import Path

import pytest

from uel.paper.study.length import CASES, LengthResult, beam

PAGE = Path(__file__).parents[2] / "fortran" / "stabilised.md"
# beam theory of a sharp crack, 52.32 N: a process zone takes a few per cent off, and nothing can add to it
SHARP = 52.32


def rows() -> dict[str, list[str]]:
    """Rows of the page's table."""
    cells = re.findall(r"^\| (\d[^|]* mm[^|]*) \|(( [^|]+ \|){5})$", PAGE.read_text("utf-8"), re.MULTILINE)
    return {name: [cell.strip() for cell in row.split("|")[:-1]] for name, row, _ in cells}


def compare(found: LengthResult, row: list[str]) -> None:
    """A run against a row. Rounding decides when a point fails: a part of an element's length more or less."""
    assert found.peak == pytest.approx(float(row[0]), rel=5e-3)
    assert found.iterations == pytest.approx(int(row[3]), rel=0.15)
    assert found.warned == (row[4] == "yes")


def test_page_has_every_case() -> None:
    found = rows()
    assert list(found) == list(CASES)
    first = float(found["0.125 mm"][0])
    assert first < SHARP
    for row in found.values():
        # of rounded loads
        assert float(row[1].removesuffix("%")) == pytest.approx(100.0 * (float(row[0]) / first - 1.0), abs=0.08)


def test_elements_of_two_millimetres(tmp_path: Path) -> None:
    found = beam(2.0, 4, tmp_path)
    compare(found, rows()["2 mm"])
    assert found.peak > 1.2 * SHARP
    assert found.warned


@pytest.mark.long
@pytest.mark.parametrize("name", CASES)
def test_rows_of_the_page(name: str, tmp_path: Path) -> None:
    size, quads, at_nodes = CASES[name]
    found = beam(size, quads, tmp_path, at_nodes=at_nodes)
    compare(found, rows()[name])
    assert found.zone == pytest.approx(float(rows()[name][2]), abs=max(0.25, 0.6 * size))
    assert (found.peak < SHARP) == (size <= 0.5)
