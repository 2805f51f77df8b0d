# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Every deck of abaqus_inputs against the values of its reference.toml."""

import tempfile
from functools import cache
from itertools import groupby
from pathlib import Path

import pytest

from harness.delamination.decks import FOLDER
from harness.delamination.references import Reference, read_references
from harness.job import run
from harness.output import Result

FOLDERS = sorted(path.parent for path in FOLDER.glob("*/reference.toml"))


def by_deck() -> list:
    cases = []
    for folder in FOLDERS:
        references, long, _ = read_references(folder)
        for (deck, against), group in groupby(references, key=lambda reference: (reference.deck, reference.against)):
            name = f"{folder.name}/{deck.name}" + (f" against {against.name}" if against else "")
            marks = [pytest.mark.long] if long & {deck, against} else []
            cases.append(pytest.param(list(group), id=name, marks=marks))
    return cases


@pytest.fixture(scope="module")
def runner():
    """Runs a deck once."""
    searching = {folder for folder in FOLDERS if read_references(folder).fallback}
    with tempfile.TemporaryDirectory() as folder:

        @cache
        def result(deck: Path) -> Result:
            return run(deck, output_dir=folder, fallback=deck.parent in searching)

        yield result


@pytest.mark.parametrize("references", by_deck())
def test_reference_values(references: list[Reference], runner) -> None:
    assert runner(references[0].deck).completed
    wrong = []
    for reference in references:
        measured = reference.measure(runner)
        if not abs(measured - reference.value) <= reference.tolerance:
            wrong.append(
                f"{reference.quantity}: {measured:.7g} {reference.unit}, expected {reference.value:.7g} "
                f"+- {reference.tolerance:.2g} ({reference.kind}: {reference.source})"
            )
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("folder", sorted({path.parent for path in FOLDER.rglob("*.inp")}), ids=lambda path: path.name)
def test_every_deck_has_a_page_and_a_value(folder: Path) -> None:
    assert (folder / "README.md").exists()
    references, long, _ = read_references(folder)
    decks = {path for path in folder.glob("*.inp") if "*STEP" in path.read_text() and "ccx" not in path.name}
    assert {reference.deck for reference in references} == decks
    assert long <= decks
    page = (folder / "README.md").read_text()
    assert [path.name for path in folder.glob("*.inp") if path.name not in page] == []


VALUE = """
[[value]]
decks = ["a.inp"]
quantity = "peak_load"
value = 1.0
relative = 0.1
unit = "N"
why = "because"
kind = "analytic"
source = "a book"
"""


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('why = "because"\n', "", "peak_load: expected decks, .* and relative or absolute"),
        ("relative = 0.1", "relative = 0.1\nabsolute = 0.1", "peak_load: expected decks, .* and relative or absolute"),
        ('kind = "analytic"', 'kind = "guess"', "peak_load: kind 'guess' is none of analytic, paper figure"),
        ('unit = "N"', 'unit = "N"\nagainst = "b.inp"', "peak_load: no comparison of that name; there are curve_dist"),
    ],
)
def test_bad_references_are_refused(tmp_path: Path, old: str, new: str, message: str) -> None:
    (tmp_path / "reference.toml").write_text(VALUE)
    assert read_references(tmp_path).values[0].tolerance == pytest.approx(0.1)
    (tmp_path / "reference.toml").write_text(VALUE.replace(old, new))
    with pytest.raises(ValueError, match=message):
        read_references(tmp_path)
