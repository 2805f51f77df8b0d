# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Random decks of other programs: `uel insert` refuses them, or they run with the displacements of the uncut one."""

import insertions
import pytest


@pytest.mark.sample(20)
@pytest.mark.parametrize("seed", range(1, 201))
def test_a_deck_is_refused_with_its_place_or_runs(seed):
    outcome, case = insertions.try_case(seed)
    assert not outcome.startswith("WRONG"), (outcome, case)


def test_what_is_wrong_is_seen(monkeypatch):
    """Elements a thousand times softer, and a traceback."""
    seed = next(seed for seed in range(1, 200) if insertions.Maker(seed).case().element in insertions.STANDARD
                and insertions.try_case(seed)[0].startswith("runs, U"))  # fmt: skip
    monkeypatch.setattr(insertions, "STIFF", 1e3)
    assert insertions.try_case(seed)[0].startswith("WRONG: U")
    monkeypatch.setattr(insertions, "insert", None)
    assert "TypeError" in insertions.try_case(seed)[0]
