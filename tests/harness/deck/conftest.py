# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Write a deck and read it."""

from collections.abc import Callable
from pathlib import Path

import pytest

from uel.deck import read_deck
from uel.errors import DeckError
from uel.model.model import Model

Read = Callable[[str], Model]
Refuse = Callable[[str, tuple[str, str, str]], None]


@pytest.fixture
def read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Read:
    """Read a deck given as text; messages call it deck.inp."""
    monkeypatch.chdir(tmp_path)

    def read_text(text: str) -> Model:
        Path("deck.inp").write_text(text, encoding="utf-8", newline="")
        return read_deck(Path("deck.inp"))

    return read_text


@pytest.fixture
def refuse(read: Read) -> Refuse:
    """Read a deck with a mistake: (old text, new text, 'line: message'), the message as a regular expression."""

    def read_mistake(deck: str, mistake: tuple[str, str, str]) -> None:
        old, new, message = mistake
        assert old in deck
        line, text = message.split(": ", 1)
        with pytest.raises(DeckError, match=rf"(?m)^deck\.inp:{line}: .*{text}"):
            read(deck.replace(old, new, 1))

    return read_mistake
