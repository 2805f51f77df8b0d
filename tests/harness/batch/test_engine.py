# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The engine of batches and studies."""

import io
import tomllib
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

import pytest
from rich.console import Console

from harness.batch import engine
from harness.batch.engine import Store, StoredRow, complete


@dataclass(frozen=True)
class Deck:
    """A deck of a text."""

    name: str
    text: str = ""

    def files(self) -> dict[str, str]:
        return {self.name: self.text}


@dataclass(frozen=True)
class Length(StoredRow):
    """What is kept of a deck."""

    length: int


DECKS = [Deck("a", "1"), Deck("b", "22"), Deck("c", "333"), Deck("none")]


def test_decks_are_run_once_and_kept(tmp_path: Path) -> None:
    """In threads; one that has no entry in the end is run again."""
    ran: list[str] = []

    def measure(deck: Deck, folder: Path) -> Length | None:
        assert folder == tmp_path
        ran.append(deck.name)
        return Length(len(deck.text)) if deck.text else None

    def batch(decks: list[Deck]) -> tuple[dict[Deck, Length], str]:
        console = Console(file=io.StringIO(), force_terminal=True, width=120, color_system=None)
        store = Store(tmp_path / "rows.json", Length.from_json)
        found = complete(
            decks,
            store,
            measure,
            tmp_path,
            workers=2,
            console=console,
            describe=lambda e: f"[{e.length}]",
            threads=True,
        )
        assert isinstance(console.file, io.StringIO)
        return found, console.file.getvalue()

    found, said = batch(DECKS)
    assert found == {DECKS[0]: Length(1), DECKS[1]: Length(2), DECKS[2]: Length(3)}
    assert sorted(ran) == ["a", "b", "c", "none"]
    assert "b: [2]" in said
    assert "4/4" in said
    assert "2 running" in said
    assert "0 running" in said
    ran.clear()
    changed = [Deck("a", "1"), Deck("b", "55555"), *DECKS[2:]]
    found, said = batch(changed)
    assert found[changed[1]] == Length(5)
    assert sorted(ran) == ["b", "none"]


def test_sources_of_all_that_computes_results(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """From the deck to the records: each package between the errors and the output."""
    layers = tomllib.loads((Path(__file__).parents[3] / "pyproject.toml").read_text())["tool"]["importlinter"][
        "contracts"
    ]
    below_job = layers[0]["layers"][layers[0]["layers"].index("harness.job") + 1 :]
    expected = {name for layer in below_job for name in layer.split(" | ")} - {"harness.output", "harness.errors"}
    assert {package.__name__ for package in engine._PACKAGES} == expected
    before = engine.fingerprint(DECKS[0])
    package = tmp_path / "batch_sources"
    package.mkdir()
    (package / "__init__.py").write_text("changed = True\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(engine, "_PACKAGES", (*engine._PACKAGES, import_module("batch_sources")))
    engine._sources.cache_clear()
    try:
        assert engine.fingerprint(DECKS[0]) != before
    finally:
        monkeypatch.undo()
        engine._sources.cache_clear()
    assert engine.fingerprint(DECKS[0]) == before
