# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Run decks that tests write."""

from collections.abc import Callable, Iterable
from pathlib import Path

import pytest

import uel
from uel.output.results import Result

RunDeck = Callable[..., Result]


@pytest.fixture
def run_deck(tmp_path: Path) -> RunDeck:
    """Write a deck, a text or lines, and run it in the folder of the test.

    User routines are a file, or the text of one in fixed form. Messages call the deck deck.inp, unless the job has
    another name; the other options are those of `uel.run`.
    """

    def run_deck(
        deck: str | Iterable[str], user: Path | str | None = None, *, name: str = "deck", **options: object
    ) -> Result:
        file = tmp_path / f"{name}.inp"
        file.write_text(deck if isinstance(deck, str) else "\n".join(deck) + "\n", encoding="utf-8")
        if isinstance(user, str):
            text, user = user, tmp_path / "user.f"
            user.write_text(text, encoding="utf-8")
        return uel.run(file, user, output_dir=tmp_path, **options)

    return run_deck
