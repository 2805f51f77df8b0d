# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runner of the cases of the study and their references, which keeps their rows."""

from __future__ import annotations

from pathlib import Path

from uel.batch.engine import Store
from uel.paper.run_deck import run_deck
from uel.paper.study.cases import SOLUTIONS, StudyCase
from uel.paper.study.reference import FOLDER, ReferenceRun, real_profiles, reference_of
from uel.paper.study.rows import StudyRow, measure


def row_store(folder: Path) -> Store[StudyRow]:
    """Return the rows by the name of their case, in rows.json."""
    return Store(folder / "rows.json", StudyRow.from_json)


def reference_store(folder: Path) -> Store[ReferenceRun]:
    """Open the store of the references that have run, by name, in references.json."""
    return Store(folder / "references.json", ReferenceRun.from_json)


def run_case(case: StudyCase, folder: Path) -> StudyRow:
    """Run the deck of a case in a folder of its name below `folder`, and measure the results.

    The reference has to have run, in its folder beside `folder`.
    """
    fallback, _ = SOLUTIONS[case.solution]
    outcome = run_deck(case, folder, fallback=fallback)
    real = real_profiles(reference_of(case), folder.parent / FOLDER)
    return measure(case, outcome.result, outcome.stopped, outcome.seconds, real)
