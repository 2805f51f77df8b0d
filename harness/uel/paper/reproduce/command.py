# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel reproduce`: run what is missing, draw the figures, decide on the statements, write the page."""

from __future__ import annotations

import csv
import os
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.progress import track
from rich.table import Table as TerminalTable

from uel.errors import UsageError
from uel.paper.reproduce import convergence, curves, drawings, figures, sensitivity
from uel.paper.reproduce.cases import PROBLEMS, PaperCase, comparator_cases, longer_cases, paper_cases, secant_cases
from uel.paper.reproduce.findings import Evidence
from uel.paper.reproduce.page import Content, number, write_page
from uel.paper.reproduce.patch_cases import PatchCase, patch_cases
from uel.paper.reproduce.runs import AnyCase, Runs, run_cases
from uel.paper.reproduce.statements import JudgedStatement, judge, read_statements
from uel.paper.reproduce.tables import all_tables

PARTS = ("law", "patch", *PROBLEMS, "sensitivity")


def reproduce(
    parts: Sequence[str], folder: Path, *, quick: bool, console: Console, workers: int | None = None
) -> list[JudgedStatement]:
    """Run the command.

    Parameters
    ----------
    parts
        Of PARTS; none means all.
    folder
        Gets the pictures, `statements.csv`, the page `index.html` and the runs; runs that it has are not repeated.
    quick
        Coarser meshes.
    console
        Gets progress and verdicts.
    workers
        Number of processes, one for each core by default.

    Returns
    -------
    list[JudgedStatement]
        The statements that the parts decide on.

    Raises
    ------
    UsageError
        There is no such part.
    """
    for part in parts:
        if part not in PARTS:
            raise UsageError(f"no case '{part}'; expected one of {', '.join(PARTS)}")
    chosen = [part for part in PARTS if not parts or part in parts]
    place = folder / ("quick" if quick else "full")
    runs = run_cases(
        _cases(chosen, quick=quick),
        place,
        workers or os.cpu_count() or 1,
        console,
        peaks=_peaks(chosen, quick=quick),
    )
    evidence = Evidence(runs, quick)
    decided = [statement for statement in read_statements() if set(statement.cases) <= set(chosen)]
    shown = track(decided, "statements", console=console, disable=not console.is_terminal)
    verdicts = [judge(statement, evidence) for statement in shown]
    content = Content(
        _how(chosen, quick=quick),
        _figures(chosen, runs, place, quick=quick),
        verdicts,
        all_tables(chosen, evidence, place),
    )
    page = write_page(content, place / "index.html")
    _write_csv(verdicts, place / "statements.csv")
    console.print(_summary(verdicts))
    console.print(f"page: {page}", highlight=False, soft_wrap=True)
    return verdicts


def _cases(parts: Sequence[str], *, quick: bool) -> list[AnyCase]:
    cases: list[AnyCase] = []
    for part in parts:
        if part == "patch":
            cases += patch_cases()
        elif part in PROBLEMS:
            cases += paper_cases(part, coarse=quick) + comparator_cases(part, coarse=quick)
            cases += [case for pair in convergence.curves(part, coarse=quick) for case in pair]
        if part == "dcb":
            cases += secant_cases(coarse=quick)
            cases += [case for pair in convergence.pairs(coarse=quick) for case in pair]
        if part == "frmm":
            cases += longer_cases(coarse=quick)
        if part == "sensitivity":
            cases += sensitivity.cases(coarse=quick)
    return list({case.name: case for case in cases}.values())


def _peaks(parts: Sequence[str], *, quick: bool) -> list[PaperCase]:
    """Return the cases whose peak loads are compared."""
    cases = [case for part in parts for case in curves.compared(part, coarse=quick)]
    return cases + (sensitivity.cases(coarse=quick) if "sensitivity" in parts else [])


def _how(parts: Sequence[str], *, quick: bool) -> list[str]:
    mesh = "the coarser meshes and increments of --quick" if quick else "the full meshes"
    return [
        f"Made by uel reproduce ({', '.join(parts)}) on {mesh}. Every number below is computed from the runs.",
        "Elements: standard is U2, paper the paper's in U4 (CLOSURE 2, damage at the displacement jump), "
        "consistent is U4 with CLOSURE 3, the complete form; both with beta by (21), but in the patch tests with the "
        "paper's, and local eigenvalues in the consistent one. Runs keep Abaqus' default tolerances; where Newton's "
        "method stops, the harness searches downhill (uel run --fallback), where the paper raised the tolerances up "
        "to a hundredfold.",
        "The paper's figures are not part of this page, and its text gives neither the moments of its profiles nor the "
        "ranges of its axes: ours show the whole softening branch, and profiles at a moment of steady growth.",
    ]


def _figures(parts: Sequence[str], runs: Runs, folder: Path, *, quick: bool) -> dict[str, Path]:
    drawn: dict[str, Path] = {}
    if "law" in parts:
        drawn["2"] = figures.draw_law(folder)
    if "patch" in parts:
        drawn["4"] = figures.draw_horizontal_patch(runs, folder)
        drawn["6"] = figures.draw_inclined_patch(runs, folder)
        for figure, shape in (("3", "horizontal"), ("5", "inclined")):
            squares = [
                (words, runs.deck(PatchCase(shape, "0/0", "paper", moved)))
                for words, moved in (("straight interface", False), ("perturbed interface", True))
            ]
            zoom = (0.45, 0.5, 0.15) if shape == "horizontal" else None
            drawn[figure] = drawings.draw_square(squares, folder / f"figure_{int(figure):02d}.png", zoom)
    beams = {"dcb": ("7", (32.0, 44.0)), "enf": ("12", (30.0, 42.0)), "frmm": ("17", (32.0, 44.0))}
    for problem in (part for part in parts if part in PROBLEMS):
        case = PaperCase(problem, "0/0", "paper", "1e8", coarse=quick)
        figure, tip = beams[problem]
        drawn[figure] = drawings.draw_beam(runs.deck(case), folder / f"figure_{int(figure):02d}.png", tip)
        drawn |= figures.problem_figures(runs, problem, coarse=quick, folder=folder)
        if problem == "dcb":
            cross = PaperCase(problem, "0/90", "paper", "1e8", coarse=quick)
            drawn["1"] = drawings.draw_domain(runs.deck(cross), folder / "figure_01.png")
    return drawn


def _write_csv(verdicts: Sequence[JudgedStatement], path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["id", "section", "figure", "number", "value", "wanted", "reproduced"])
        for verdict in verdicts:
            statement = verdict.statement
            words = [statement.id, statement.section, statement.figure, statement.number.text]
            writer.writerow([*words, f"{verdict.value:.6g}", statement.limits, "yes" if verdict.reproduced else "no"])


def _summary(verdicts: Sequence[JudgedStatement]) -> TerminalTable:
    good = sum(verdict.reproduced for verdict in verdicts)
    table = TerminalTable("statement", "our number", "wanted", "verdict", title=f"{good} of {len(verdicts)} reproduced")
    for verdict in verdicts:
        word = "reproduced" if verdict.reproduced else "NOT REPRODUCED"
        table.add_row(verdict.statement.id, number(verdict.value), verdict.statement.limits, word)
    return table
