# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The double cantilever beam of U3 without the derivative of the damage in AMATRX (TANGENT 1)."""

import shutil
from pathlib import Path

import pytest

import uel
from uel.errors import ConvergenceError
from uel.output import Result
from uel.paper.decks import FOLDER

INTEGERS = "0., 1, 2, 0, 0, 0, -5000, -4000"


@pytest.mark.long
def test_it_converges_too_slowly(tmp_path: Path) -> None:
    for path in (FOLDER / "dcb").glob("*.inp"):
        shutil.copy(path, tmp_path)
    deck = tmp_path / "dcb_u3_1e8.inp"
    text = deck.read_text()
    assert text.count(INTEGERS) == 1
    deck.write_text(text.replace(INTEGERS, "0., 1, 2, 0, 0, 1, -5000, -4000"))
    with pytest.raises(ConvergenceError, match=r"LESS THAN THE MINIMUM|TOO MANY ATTEMPTS"):
        uel.run(deck, output_dir=tmp_path)
    # regression: 760 increments when it was written, where the whole analysis takes 156 with the consistent tangent
    assert len(Result(tmp_path / "dcb_u3_1e8").status) > 3 * 156
