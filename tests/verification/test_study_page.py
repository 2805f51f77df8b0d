# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The table of the documentation, `fortran/study.md` with `study.csv`, is what the study gives."""

import csv
from dataclasses import fields
from pathlib import Path

import pytest

from uel.paper.measures import peak_load
from uel.paper.run_deck import run_deck
from uel.paper.study.blend import Beam, described
from uel.paper.study.cases import SOLUTIONS, StudyCase, all_cases
from uel.paper.study.criteria import check
from uel.paper.study.rows import StudyRow, measure
from uel.paper.study.tables import csv_table, markdown_tables

PAGE = Path(__file__).parents[2] / "fortran" / "study.md"
# regression: quick rows
SAMPLE = (
    StudyCase("frmm", "0/0", "1e6", "standard", "structured", "fallback"),
    StudyCase("frmm", "0/0", "inf", "consistent", "perturbed", "fallback"),
)


def committed() -> dict[str, dict[str, str]]:
    """Lines of the table by the name of their case."""
    with PAGE.with_suffix(".csv").open(encoding="utf-8") as file:
        lines = list(csv.DictReader(file))
    names = ("specimen", "layup", "stiffness", "element", "mesh", "solution", "law")
    return {StudyCase(*(line[name] for name in names)).name: line for line in lines}


@pytest.mark.parametrize("case", SAMPLE, ids=lambda case: case.name)
def test_sample_of_the_table(case: StudyCase, tmp_path: Path) -> None:
    fallback, _ = SOLUTIONS[case.solution]
    outcome = run_deck(case, tmp_path, fallback=fallback)
    row = measure(case, outcome.result, outcome.stopped, outcome.seconds, []).to_json()
    line = committed()[case.name]
    assert line["stopped"] == row["stopped"] == ""
    for name in ("increments", "cutbacks", "snaps"):
        assert int(line[name]) == row[name]
    # another compiler rounds otherwise, and one iteration more or less in an increment is converged as well
    assert int(line["iterations"]) == pytest.approx(row["iterations"], rel=0.1)
    for name in ("peak_load", "final_load", "raw_n", "raw_t", "peak_n", "peak_t", "damage_variation"):
        assert float(line[name]) == pytest.approx(row[name], rel=2e-3), name


@pytest.mark.long
def test_a_share_of_the_secant_matrix_carries_newtons_method_past_a_snap(tmp_path: Path) -> None:
    alone, helped = (run_deck(Beam("inf", "perturbed", share), tmp_path, fallback=False) for share in (0.0, 0.05))
    assert alone.stopped and "stops at" in described(alone)
    assert not helped.stopped and "stops at" not in described(helped)
    # the same equilibria: the row with the fall-back
    row = committed()[StudyCase("dcb", "0/0", "inf", "consistent", "perturbed", "fallback").name]
    assert peak_load(helped.result) == pytest.approx(float(row["peak_load"]), rel=5e-3)


def test_table_holds_every_row() -> None:
    assert list(committed()) == [case.name for case in all_cases()]


def test_page_says_what_the_rows_say() -> None:
    """The text of the page follows from the rows, its verdicts and digests too: no run is made, on no processor."""
    lines = committed()
    kinds = {"str": str, "int": int, "float": float}
    rows = {
        case: StudyRow(
            **{field.name: kinds[str(field.type)](lines[case.name][field.name]) for field in fields(StudyRow)}
        )
        for case in all_cases()
    }
    assert csv_table(rows) == PAGE.with_suffix(".csv").read_text(encoding="utf-8")
    assert markdown_tables(rows, check(rows)) == PAGE.read_text(encoding="utf-8")
