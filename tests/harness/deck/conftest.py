# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Write a deck and read it."""

from collections.abc import Callable
from pathlib import Path

import pytest

from harness.deck import read_deck
from harness.model.model import Model

Read = Callable[[str], Model]


@pytest.fixture
def read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Read:
    """Read a deck given as text; messages call it deck.inp."""
    monkeypatch.chdir(tmp_path)

    def read_text(text: str) -> Model:
        Path("deck.inp").write_text(text, encoding="utf-8", newline="")
        return read_deck(Path("deck.inp"))

    return read_text
