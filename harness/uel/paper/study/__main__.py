# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m uel.paper.study`: run the rows that are missing, write the table, print what it shows."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from uel.batch.engine import complete
from uel.errors import UelError
from uel.paper.study.cases import StudyCase, all_cases, select
from uel.paper.study.criteria import check
from uel.paper.study.options import study_parser
from uel.paper.study.reference import FOLDER, ReferenceRun, reference_of, run_reference
from uel.paper.study.rows import StudyRow
from uel.paper.study.runner import reference_store, row_store, run_case
from uel.paper.study.tables import csv_table, markdown_tables, verdict_table


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit code: 0 if all rows are complete, 1 if interrupted, 2 on wrong usage."""
    description = (
        "Run delamination specimens with the standard, the paper's and the consistent element, and compare them."
    )
    parser = study_parser("uel.paper.study", description, "study", resumes=True)
    parser.add_argument(
        "--only",
        nargs="+",
        default=[],
        metavar="WORD",
        help="rows with these words, such as: enf 0/0 1e6 1e8 consistent perturbed; words of one kind are alternatives",
    )
    parser.add_argument(
        "--page", type=Path, help="file of the table, with the same as .csv beside it (study.md in the output folder)"
    )
    parser.add_argument("--kept", action="store_true", help="run nothing: write the table of the rows kept so far")
    options = parser.parse_args(arguments)
    console = Console()
    try:
        cases = select(all_cases(), options.only)
        store = row_store(options.output_dir)
        kept = {case: row for case in cases if (row := store.get(case)) is not None}
        rows = kept if options.kept else _rows(cases, options.output_dir, options.workers, console)
    except UelError as error:
        print(f"study: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("study: interrupted; the rows done so far are kept", file=sys.stderr)
        return 1
    verdicts = check(rows)
    page: Path = options.page or options.output_dir / "study.md"
    page.write_text(markdown_tables(rows, verdicts), encoding="utf-8")
    page.with_suffix(".csv").write_text(csv_table(rows), encoding="utf-8")
    console.print(verdict_table(verdicts))
    console.print(f"table: {page}, {page.with_suffix('.csv')}", highlight=False)
    return 0


def _rows(cases: Sequence[StudyCase], folder: Path, workers: int, console: Console) -> dict[StudyCase, StudyRow]:
    """Return the rows of all cases, in their order; those not in the folder are computed, after their references."""
    missing = [case for case in cases if row_store(folder).get(case) is None]
    complete(
        list(dict.fromkeys(map(reference_of, missing))),
        reference_store(folder),
        run_reference,
        folder / FOLDER,
        workers=workers,
        console=console,
        describe=_reference_end,
    )
    return complete(
        cases,
        row_store(folder),
        run_case,
        folder / "runs",
        workers=workers,
        console=console,
        describe=_end,
    )


def _reference_end(run: ReferenceRun) -> str:
    return f"reference, {run.stopped or 'finished'}"


def _end(row: StudyRow) -> str:
    end = "finished" if row.finished else f"stopped at {row.reached:.0%}"
    counts = f"{row.increments} increments, {row.iterations} iterations, {row.cutbacks} cutbacks"
    return f"{end}, {counts}, peak {row.peak_load:.2f} N"


if __name__ == "__main__":
    sys.exit(main())
