# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""CompDam's double cantilever beam with two laws, when it is opened."""

import re
from pathlib import Path

import pytest

from uel.paper.bridged_beam import bridged_beam, bridged_shells
from uel.running.job import run

PAGE = Path(__file__).parents[2] / "abaqus_inputs" / "fatigue" / "README.md"
COMPDAM = 2.352
"""nasa/CompDam_DGD, examples/interlaminar/test_DCB_3D_fatigue_expected.py (N)."""


def load(text: str, component: int, folder: Path) -> float:
    """Return the load at the end of the first step."""
    deck = folder / "beam.inp"
    deck.write_text(text)
    history = run(deck, output_dir=folder, quiet=True).history
    return float(sum(values[-1] for name, values in history.items() if name.startswith(f"RF{component}[TOP")))


def loads_of_page(row: str) -> list[float]:
    found = re.search(rf"^\| {re.escape(row)} \| ([^|]*) \|$", PAGE.read_text("utf-8"), re.MULTILINE)
    return [float(number) for number in re.findall(r"\d\.\d+", found[1])]


def test_continuum_shells_have_the_load_of_compdam(tmp_path: Path) -> None:
    found = load(bridged_shells(), 3, tmp_path)
    assert found == pytest.approx(COMPDAM, rel=0.01)
    # regression
    assert loads_of_page("`SC8R`, 6, NLGEOM, as in CompDam") == [pytest.approx(found, abs=1e-3)]


@pytest.mark.parametrize(("row", "quads", "rows"), [("`CPS4I`, 4", "CPS4I", 4), ("`CPE4I`, 8", "CPE4I", 8)])
def test_quads_of_the_page(row: str, quads: str, rows: int, tmp_path: Path) -> None:
    opening, _, _ = bridged_beam(rows=rows, quads=quads).partition("*STEP, INC=10000")
    # regression
    assert loads_of_page(row) == [pytest.approx(load(opening, 2, tmp_path), abs=1e-3)]
