# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel reproduce`: run what is missing, draw the figures, decide on the statements, write the page."""

from __future__ import annotations

import csv
import os
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table as TerminalTable

from harness.delamination.beams import BRANCH
from harness.delamination.materials import PLY_0, TABLE_2
from harness.delamination.reproduce import convergence, curves, drawings, figures, findings, sensitivity
from harness.delamination.reproduce.cases import (
    ELEMENTS,
    LONGER,
    PROBLEMS,
    Case,
    comparator_cases,
    longer_cases,
    paper_cases,
    secant_cases,
)
from harness.delamination.reproduce.claims import Verdict, judge, read_claims
from harness.delamination.reproduce.findings import Evidence
from harness.delamination.reproduce.page import Content, Table, number, write_page
from harness.delamination.reproduce.patch_cases import PatchCase, patch_cases
from harness.delamination.reproduce.runs import AnyCase, Runs, run_cases
from harness.delamination.specimens import CRACK
from harness.errors import UelError

PARTS = ("law", "patch", *PROBLEMS, "sensitivity")


def reproduce(
    parts: Sequence[str], folder: Path, *, quick: bool, console: Console, workers: int | None = None
) -> list[Verdict]:
    """Run the command.

    Parameters
    ----------
    parts
        Of PARTS; none means all.
    folder
        Gets the pictures, `claims.csv`, the page `index.html` and the runs; what it holds is not run again.
    quick
        Coarser meshes.
    console
        Gets progress and verdicts.
    workers
        Number of processes, one for each core by default.

    Returns
    -------
    list[Verdict]
        The statements that the parts decide on.

    Raises
    ------
    UelError
        There is no such part.
    """
    for part in parts:
        if part not in PARTS:
            raise UelError(f"no case '{part}'; there are {', '.join(PARTS)}")
    chosen = [part for part in PARTS if not parts or part in parts]
    place = folder / ("quick" if quick else "full")
    runs = run_cases(_cases(chosen, quick=quick), place, workers or os.cpu_count() or 1, console)
    evidence = Evidence(runs, quick)
    verdicts = [judge(claim, evidence) for claim in read_claims() if set(claim.cases) <= set(chosen)]
    content = Content(
        _how(chosen, quick=quick),
        _figures(chosen, runs, place, quick=quick),
        verdicts,
        _tables(chosen, evidence, place),
    )
    page = write_page(content, place / "index.html")
    _write_csv(verdicts, place / "claims.csv")
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
            cases += [case for study in sensitivity.studies(coarse=quick) for case in study.cases()]
    return list({case.name: case for case in cases}.values())


def _how(parts: Sequence[str], *, quick: bool) -> list[str]:
    mesh = "the coarser meshes and increments of --quick" if quick else "the full meshes"
    return [
        f"Made by uel reproduce ({', '.join(parts)}) on {mesh}. Every number below is computed from the runs.",
        "Elements: standard is U2, stabilised the paper's method in U4 (damage at the displacement jump), consistent "
        "is U4 with CLOSURE 1. Runs keep Abaqus' default tolerances; where Newton's method stops, the harness searches "
        "downhill (uel run --fallback), where the paper raised the tolerances up to a hundredfold.",
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
                (words, runs.deck(PatchCase(shape, "0/0", "stabilised", moved)))
                for words, moved in (("straight interface", False), ("perturbed interface", True))
            ]
            zoom = (0.45, 0.5, 0.15) if shape == "horizontal" else None
            drawn[figure] = drawings.draw_square(squares, folder / f"figure_{int(figure):02d}.png", zoom)
    beams = {"dcb": ("7", (32.0, 44.0)), "enf": ("12", (30.0, 42.0)), "frmm": ("17", (32.0, 44.0))}
    for problem in (part for part in parts if part in PROBLEMS):
        case = Case(problem, "0/0", "stabilised", "1e8", coarse=quick)
        figure, tip = beams[problem]
        drawn[figure] = drawings.draw_beam(runs.deck(case), folder / f"figure_{int(figure):02d}.png", tip)
        drawn |= figures.problem_figures(runs, problem, coarse=quick, folder=folder)
        if problem == "dcb":
            cross = Case(problem, "0/90", "stabilised", "1e8", coarse=quick)
            drawn["1"] = drawings.draw_domain(runs.deck(cross), folder / "figure_01.png")
    return drawn


def _tables(parts: Sequence[str], evidence: Evidence, folder: Path) -> list[Table]:
    tables = [_parameters()]
    problems = [part for part in parts if part in PROBLEMS]
    if problems:
        tables.append(_theory(problems, evidence))
        lines = [
            line for part in problems for line in convergence.curve_rows(evidence.runs, part, coarse=evidence.coarse)
        ]
        tables.append(Table("[0/90]: ours and COH2D4", convergence.CURVES_TEXT, convergence.CURVES_HEAD, lines))
    if "frmm" in parts:
        tables.append(_mode_ratios(evidence))
    if "dcb" in parts:
        lines = convergence.rows(evidence.runs, coarse=evidence.coarse)
        tables.append(
            Table("Double cantilever beam [0/90]: ours and COH2D4", convergence.TEXT, convergence.HEAD, lines)
        )
    if "sensitivity" in parts:
        for study in sensitivity.studies(coarse=evidence.coarse):
            rows = [
                [label, value, *sensitivity.cells(evidence.runs[case])]
                for label, pairs in study.variants.items()
                for value, case in pairs
            ]
            name = study.title.split()[0].lower()
            picture = sensitivity.draw(study, evidence.runs, folder / f"sensitivity_{name}.png")
            head = ("specimen, element", study.parameter, *sensitivity.HEAD)
            text = f"{study.advice} {sensitivity.spread(study, evidence.runs)}"
            tables.append(Table(f"Sensitivity: {study.title.lower()}", text, head, rows, picture))
    tables.append(_ends(evidence.runs))
    return tables


def _parameters() -> Table:
    rows = [
        ["E11, E22 = E33", f"{PLY_0.e1:g}, {PLY_0.e2:g} N/mm²"],
        ["G12 = G13, G23", f"{PLY_0.g12:g}, {PLY_0.g23:g} N/mm²"],
        ["nu12 = nu13, nu23", "0.3, 0.51"],
        ["alpha_n, alpha_tau", "1e4, 1e6, 1e8 N/mm³"],
        ["G_Ic, G_IIc", f"{TABLE_2.toughness_1:g}, {TABLE_2.toughness_2:g} N/mm"],
        ["sigma_max, tau_max", f"{TABLE_2.strength_normal:g}, {TABLE_2.strength_shear:g} N/mm²"],
    ]
    return Table("Tables 1 and 2: HTA/6376C", "As the decks have them.", ("parameter", "value"), rows)


def _theory(problems: Sequence[str], evidence: Evidence) -> Table:
    head = (
        *("specimen", "element", "largest distance from corrected beam theory", "mean distance", "energy missing"),
        *("toughness of failed points", "G_I/G_II from the tractions", "by corrected beam theory"),
    )
    rows = []
    for problem in problems:
        for element in ELEMENTS:
            ratios = ["", ""]
            if problem == "frmm":
                measures = (findings.mode_ratio, findings.theory_mode_ratio)
                ratios = [number(measure(evidence, element)) for measure in measures]
            shares = (
                curves.theory_distance(evidence, problem, element),
                curves.theory_mean(evidence, problem, element),
                curves.energy_error(evidence, problem, element),
            )
            spent = findings.toughness(evidence, problem, element)
            rows.append([problem.upper(), element, *(f"{share:.2%}" for share in shares), number(spent), *ratios])
    text = (
        "[0/0], worst of 1e4, 1e6, 1e8 N/mm³; toughness and ratio at 1e6. Growth branch: where a sharp crack would be "
        + ", ".join(f"{low:g} to {high:g} mm ({name.upper()})" for name, (low, high) in BRANCH.items())
        + " long. Energy missing: work less stored less dissipated, over the work. G_I/G_II by Rice's integral "
        "around the process zone; that of beams is 4/3 without corrections of their ends."
    )
    return Table("Theory", text, head, rows)


def _mode_ratios(evidence: Evidence) -> Table:
    head = ("initial crack (mm)", "crack (mm)", "G_I/G_II from the tractions", "off corrected beam theory", "off 4/3")
    rows = []
    for case in (Case("frmm", "0/0", "consistent", "1e6"), *longer_cases(coarse=evidence.coarse)):
        measures = (findings.crack_length, findings.mode_ratio, findings.theory_mode_ratio)
        length, ratio, theory = (measure(evidence, case.element, problem=case.problem) for measure in measures)
        start = LONGER.get(case.problem, CRACK)
        rows.append(
            [
                f"{start:g}",
                f"{length:.1f}",
                f"{ratio:.3f}",
                f"{ratio / theory - 1.0:+.1%}",
                f"{ratio * 0.75 - 1.0:+.1%}",
            ]
        )
    text = (
        "[0/0], consistent method at 1e6 N/mm³, the paper's specimen and longer ones of the same height. 4/3 is the "
        "ratio of plain beams. Arms of 1.55 mm turn at the crack's end, in mode I more than in mode II, which counts "
        "for the less the longer the crack."
    )
    return Table("Mode ratio of the fixed-ratio specimen", text, head, rows)


def _ends(runs: Runs) -> Table:
    head = ("run", "increments", "iterations", "cutbacks", "seconds", "end")
    rows = [
        [
            case.name,
            *(str(count) for count in (entry.increments, entry.iterations, entry.cutbacks)),
            f"{entry.seconds:.1f}",
            entry.stopped or "finished",
        ]
        for case, entry in runs.entries().items()
    ]
    return Table("Runs", "Iterations include those of attempts given up.", head, rows)


def _write_csv(verdicts: Sequence[Verdict], path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["id", "section", "figure", "number", "value", "wanted", "reproduced"])
        for verdict in verdicts:
            claim = verdict.claim
            words = [claim.id, claim.section, claim.figure, claim.number.text]
            writer.writerow([*words, f"{verdict.value:.6g}", claim.limits, "yes" if verdict.reproduced else "no"])


def _summary(verdicts: Sequence[Verdict]) -> TerminalTable:
    good = sum(verdict.reproduced for verdict in verdicts)
    table = TerminalTable("statement", "our number", "wanted", "verdict", title=f"{good} of {len(verdicts)} reproduced")
    for verdict in verdicts:
        word = "reproduced" if verdict.reproduced else "NOT REPRODUCED"
        table.add_row(verdict.claim.id, number(verdict.value), verdict.claim.limits, word)
    return table
