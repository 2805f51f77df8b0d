# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The work of the loads is what models store and dissipate: the page of energies, and runs of its smallest models."""

import re
from pathlib import Path

import pytest

from uel.paper.study.energy import COUNTS, Balance, PlaneModel, models, row, run_model

PAGE = Path(__file__).parents[2] / "fortran" / "energy.md"
REQUIRED = 5e-4
"""Share of the work that may be missing where nothing snaps."""
SNAP = 0.03
"""Fall of the load in an increment, over the largest load."""
LONG = ("dcb025 [0/90]", "consistent, inf", "linear")
"""The model whose elements are longer than a third of its process zone."""


def page() -> dict[tuple[str, ...], list[float]]:
    """Shares of the page, missing ones and the fall, by the first cells of a row."""
    found = {}
    for line in PAGE.read_text("utf-8").partition("## Table")[2].splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if re.search(r"\d %$", cells[-1]):
            found[tuple(cells[:3])] = [float(cell.removesuffix(" %")) / 100.0 for cell in cells[3:]]
    return found


def test_the_page_has_every_model() -> None:
    assert list(page()) == [model.cells for model in models()]


def test_nothing_is_missing_where_nothing_snaps() -> None:
    steady = {cells: values for cells, values in page().items() if values[-1] < SNAP}
    assert len(steady) > 20
    for cells, values in steady.items():
        *_, most, _ = values
        assert abs(most) < (REQUIRED if cells != LONG else 1.2 * REQUIRED), cells


def test_a_row_says_where_a_run_stops() -> None:
    cells = row(PlaneModel("dcb", "0/0"), [None, Balance(1e-4, 0.01), None]).split("|")
    assert [cell.strip() for cell in cells[4:8]] == ["stops", "+0.010 %", "stops", "1.0 %"]


def test_large_increments_of_mixed_mode(tmp_path: Path) -> None:
    """Points fail within two increments of fifty."""
    found = run_model(PlaneModel("frmm", "0/0"), 50, tmp_path)
    assert found is not None
    assert abs(found.missing) < 3e-3


@pytest.mark.long
@pytest.mark.parametrize("model", [PlaneModel("dcb", "0/90"), PlaneModel("frmm", "0/0")])
def test_rows_of_the_page(model: PlaneModel, tmp_path: Path) -> None:
    values = page()[model.cells]
    found = run_model(model, COUNTS[0], tmp_path)
    assert found is not None
    # regression
    assert found.missing == pytest.approx(values[0], abs=1e-4)
