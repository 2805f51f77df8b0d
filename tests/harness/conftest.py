# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Run decks that tests write."""

from collections.abc import Callable, Iterable
from itertools import count
from pathlib import Path

import pytest

import uel
from uel.output.results import Result

RunDeck = Callable[..., Result]


@pytest.fixture
def run_deck(tmp_path: Path) -> RunDeck:
    """Write a deck, a text or lines, and run it; options as those of `uel.run`.

    User routines are a file, or the text of one in fixed form. Messages call the deck deck.inp, unless the job has
    another name. The first deck and those with a name run in the folder of the test, each further one in a folder of
    its own: a result reads its files when it is asked, and a later job must not have replaced them.
    """
    numbers = count(1)

    def run_deck(
        deck: str | Iterable[str], user: Path | str | None = None, *, name: str | None = None, **options: object
    ) -> Result:
        number = 1 if name else next(numbers)
        folder = tmp_path if number == 1 else tmp_path / f"run{number}"
        folder.mkdir(exist_ok=True)
        file = folder / f"{name or 'deck'}.inp"
        file.write_text(deck if isinstance(deck, str) else "\n".join(deck) + "\n", encoding="utf-8")
        if isinstance(user, str):
            text, user = user, folder / "user.f"
            user.write_text(text, encoding="utf-8")
        return uel.run(file, user, output_dir=folder, **options)

    return run_deck
