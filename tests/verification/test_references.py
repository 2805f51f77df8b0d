# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Every deck of abaqus_inputs against the values of its reference.toml and the tables of its page."""

import re
import tempfile
from collections.abc import Callable, Collection
from functools import cache
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from reference_values import Reference, read_references

from uel.errors import ConvergenceError
from uel.output import Result
from uel.paper import growth_measures, measures
from uel.paper.decks import FOLDER
from uel.running.job import run
from uel.solver.options import SolverOptions

FOLDERS = sorted(path.parent for path in FOLDER.glob("*/reference.toml"))


def by_deck() -> list:
    cases = []
    for folder in FOLDERS:
        references, long, *_ = read_references(folder)
        for (deck, against), group in groupby(references, key=lambda reference: (reference.deck, reference.against)):
            name = f"{folder.name}/{deck.name}" + (f" against {against.name}" if against else "")
            marks = [pytest.mark.long] if long & {deck, against} else []
            cases.append(pytest.param(list(group), id=name, marks=marks))
    return cases


@pytest.fixture(scope="module")
def runner():
    """Runs a deck once."""
    searching = {folder for folder in FOLDERS if read_references(folder).fallback}
    unsettled = {deck for folder in FOLDERS for deck in read_references(folder).unsettled}
    with tempfile.TemporaryDirectory() as folder:

        @cache
        def result(deck: Path) -> Result:
            try:
                return run(deck, output_dir=folder, solver=SolverOptions(fallback=deck.parent in searching))
            except ConvergenceError:
                if deck not in unsettled:
                    raise
                return Result(Path(folder) / deck.stem)

        yield result


@pytest.mark.parametrize("references", by_deck())
def test_reference_values(references: list[Reference], runner) -> None:
    deck = references[0].deck
    if not runner(deck).completed:
        assert deck in read_references(deck.parent).unsettled
        # what is said of the end is not to be had, the peak is
        assert differences(deck, runner(deck), ["peak (N) at (mm)"]) == []
        return
    wrong = []
    for reference in references:
        measured = reference.measure(runner)
        if not abs(measured - reference.value) <= reference.tolerance:
            wrong.append(
                f"{reference.quantity}: {measured:.7g} {reference.unit}, expected {reference.value:.7g} "
                f"+- {reference.tolerance:.2g} ({reference.kind}: {reference.source})"
            )
    if references[0].against is None:
        wrong += differences(references[0].deck, runner(references[0].deck))
    assert not wrong, "\n".join(wrong)


class Column(NamedTuple):
    """A figure in a table of a page, and how far a run may be from it: in proportion, or in units of the figure.

    All processors iterate to Abaqus' tolerance of the residual, 5e-3, and go on from there. Where attempts are given
    up, as where a point fails, rounding decides on how many, and each makes several increments of one: `jumping` times
    as far.
    """

    measure: Callable[[Result], float]
    relative: float
    absolute: float = 0.0
    jumping: float = 1.0


def at_first_peak(values: Callable[[Result], np.ndarray]) -> Callable[[Result], float]:
    """The value where the load first falls by a twentieth afterwards: behind the crack's way it rises again."""

    def value(result: Result) -> float:
        load = measures.load(result)
        fallen = np.flatnonzero(load < 0.95 * np.maximum.accumulate(load))
        return float(values(result)[load[: fallen[0] if fallen.size else None].argmax()])

    return value


PEAK = Column(measures.peak_load, 2e-3)
END = Column(measures.final_load, 5e-3)
DISSIPATED = Column(lambda result: measures.dissipated(result)[-1], 5e-3)
COLUMNS: dict[str, tuple[Column, ...]] = {
    "peak (N)": (PEAK,),
    "peak (N) at (mm)": (
        Column(at_first_peak(measures.load), 2e-3),
        Column(at_first_peak(measures.displacement), 0.02),
    ),
    "at 3 mm (N)": (END,),
    "at the end (N)": (END,),
    "load at 4.4 mm (N)": (END,),
    "off beam theory after the peak": (Column(measures.theory_deviation, 0.1, 1e-3, 3.0),),
    "dissipated / (G_Ic width growth)": (Column(measures.dissipation_ratio, 5e-3),),
    "dissipated by damage (N mm)": (DISSIPATED,),
    "dissipated (N mm)": (DISSIPATED,),
    "work - stored - dissipated": (Column(measures.energy_error, 0.1, 1e-3, 3.0),),
    "total variation of t_n (MPa)": (Column(measures.traction_variation, 0.02, 0.0, 3.0),),
    "increments, given up": (Column(measures.increments, 0.1, 0.0, 3.0), Column(measures.cutbacks, 0.1, 2.0, 3.0)),
    "mm in 1000 cycles": (Column(lambda result: 1e3 * growth_measures.steady_rate(result), 0.01),),
    "exponent": (Column(growth_measures.growth_exponent, 0.01),),
    "iterations": (Column(measures.iterations, 0.1, 0.0, 3.0),),
}


def tables(page: str) -> list[tuple[str, dict[str, str]]]:
    """Rows of tables whose first column names decks: each deck with the cells by the names of their columns."""
    found, header = [], []
    for line in page.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")] if line.startswith("|") else []
        if not cells:
            header = []
        elif not header:
            header = cells
        elif header[0] == "deck":
            for deck in re.findall(r"`(\w+\.inp)`", cells[0]):
                found.append((deck, dict(zip(header[1:], cells[1:], strict=True))))
    return found


def differences(deck: Path, result: Result, columns: Collection[str] = tuple(COLUMNS)) -> list[str]:
    """What the page of a deck says otherwise than a run of it; '74 to 84' holds what several processors give."""
    wrong = []
    jumps = measures.cutbacks(result) > 0
    for name, cells in tables((deck.parent / "README.md").read_text(encoding="utf-8")):
        for column in cells.keys() & set(columns) if name == deck.name else ():
            share = 0.01 if "%" in cells[column] else 1.0
            parts = re.split(r", | at ", cells[column])
            for part, figure in zip(parts, COLUMNS[column], strict=True):
                texts = re.findall(r"-?\d+\.?\d*", part)
                digit = share * 10.0 ** -len(texts[0].partition(".")[2])
                printed = [share * float(text) for text in texts]
                scatter = max(figure.relative * abs(printed[-1]), figure.absolute) * (figure.jumping if jumps else 1.0)
                scatter += 0.5 * digit
                measured = figure.measure(result)
                if not printed[0] - scatter <= measured <= printed[-1] + scatter:
                    wrong.append(f"README.md: {column}: {cells[column]}, measured: {measured:.7g}")
    return wrong


def test_page_that_says_something_else(tmp_path: Path, runner) -> None:
    deck = FOLDER / "cohesive" / "coh2d4_bk.inp"
    page = (deck.parent / "README.md").read_text(encoding="utf-8")
    assert differences(deck, runner(deck)) == []
    (tmp_path / "README.md").write_text(page.replace("`coh3d8_bk.inp` | 0.11137 |", "`coh3d8_bk.inp` | 0.11235 |"))
    (message,) = differences(tmp_path / deck.name, runner(deck))
    assert re.match(r"README.md: dissipated by damage \(N mm\): 0.11235, measured: 0.1113", message)


def test_columns_of_pages_are_known() -> None:
    """Texts beside the figures: a formula, the place of a stress; beam theory on the growth branch: `uel reproduce`."""
    known = {*COLUMNS, "formula", "bulk stress of", "off beam theory"}
    pages = [path.read_text(encoding="utf-8") for path in FOLDER.glob("*/README.md")]
    rows = [cells for page in pages for _, cells in tables(page)]
    assert len(rows) > 100
    assert {column for cells in rows for column in cells} - known <= {"mean", "standard deviation", "lowest", "highest"}


@pytest.mark.parametrize("folder", sorted({path.parent for path in FOLDER.rglob("*.inp")}), ids=lambda path: path.name)
def test_every_deck_has_a_page_and_a_value(folder: Path) -> None:
    assert (folder / "README.md").exists()
    references, long, *_ = read_references(folder)
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
        (
            'unit = "N"',
            'unit = "N"\nagainst = "b.inp"',
            "peak_load: no comparison of that name; expected one of curve_dist",
        ),
    ],
)
def test_bad_references_are_refused(tmp_path: Path, old: str, new: str, message: str) -> None:
    (tmp_path / "reference.toml").write_text(VALUE)
    assert read_references(tmp_path).values[0].tolerance == pytest.approx(0.1)
    (tmp_path / "reference.toml").write_text(VALUE.replace(old, new))
    with pytest.raises(ValueError, match=message):
        read_references(tmp_path)
