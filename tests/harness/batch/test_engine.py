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

from uel.batch import engine
from uel.batch.engine import Store, StoredRow, complete
from uel.batch.progress import BatchProgress, clock, time_left


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


def test_progress_of_runs_that_take_long() -> None:
    """Minutes between two ends, small runs first: the time left goes by the work, on a terminal and in a log."""
    now = [1000.0]
    said = []
    for terminal in (True, False):
        console = Console(
            file=io.StringIO(), force_terminal=terminal, width=120, color_system=None, get_time=lambda: now[0]
        )
        with BatchProgress(console, total=5, known=1, work=1.0 + 1.0 + 8.0 + 2.0, workers=2) as shown:
            for minutes, work, line in ((5.0, 1.0, "a"), (5.0, 1.0, ""), (40.0, 8.0, "c"), (10.0, 2.0, "d")):
                now[0] += 60.0 * minutes
                shown.ended(work, line)
                shown._progress.refresh()
        assert isinstance(console.file, io.StringIO)
        said.append(console.file.getvalue())
    for text in said:
        assert "2 of 5, 0:55:00 left: a" in text
        assert "4 of 5, 0:10:00 left: c" in text
        assert "5 of 5, 0:00:00 left: d" in text
    # the bar: two of what is left, then one, then none
    assert "2/5 2 running 0:05:00 left 0:55:00" in said[0]
    assert "5/5 0 running 1:00:00 left 0:00:00" in said[0]


def test_progress_with_nothing_to_run() -> None:
    console = Console(file=io.StringIO(), force_terminal=True, width=120, color_system=None)
    with BatchProgress(console, total=4, known=4, work=0.0, workers=2):
        pass
    assert isinstance(console.file, io.StringIO)
    assert "4/4 0 running 0:00:00 left 0:00:00" in console.file.getvalue()


def test_time_left() -> None:
    assert time_left(60.0, 0.0, 5.0) is None
    assert time_left(60.0, 2.0, 5.0) == 150.0
    assert time_left(60.0, 1.0, 100.0) is None
    assert time_left(60.0, 1.0, 99.0) == 5940.0
    assert time_left(60.0, 0.0, 0.0) == 0.0
    assert [clock(None), clock(3725.4), clock(-1.0)] == ["-:--:--", "1:02:05", "0:00:00"]


def test_sources_of_all_that_computes_results(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """From the deck to the records: each package between the errors and the output."""
    layers = tomllib.loads((Path(__file__).parents[3] / "pyproject.toml").read_text())["tool"]["importlinter"][
        "contracts"
    ]
    below_job = layers[0]["layers"][layers[0]["layers"].index("uel.running") + 1 :]
    expected = {name for layer in below_job for name in layer.split(" | ")} - {"uel.output", "uel.errors"}
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
