# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The tables of the page that `uel reproduce` writes."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from uel.delamination.beams import BRANCH, branch_deviation
from uel.delamination.materials import PLY_0, TABLE_2
from uel.delamination.specimens import CRACK
from uel.paper.reproduce import convergence, curves, findings, sensitivity
from uel.paper.reproduce.cases import ELEMENTS, LONGER, PROBLEMS, PaperCase, comparator_cases, longer_cases, paper_cases
from uel.paper.reproduce.findings import Evidence
from uel.paper.reproduce.page import Table, number
from uel.paper.reproduce.runs import Runs


def all_tables(parts: Sequence[str], evidence: Evidence, folder: Path) -> list[Table]:
    """Return the tables of the parts of the command that were run; `folder` gets the pictures of the sensitivities."""
    tables = [_parameters()]
    problems = [part for part in parts if part in PROBLEMS]
    if problems:
        tables += [_theory(problems, evidence), *(_loads(problem, evidence) for problem in problems)]
        lines = [
            line for part in problems for line in convergence.curve_rows(evidence.runs, part, coarse=evidence.coarse)
        ]
        tables.append(
            Table(
                "[0/90]: standard and consistent with one criterion",
                convergence.CURVES_TEXT,
                convergence.CURVES_HEAD,
                lines,
            )
        )
    if "frmm" in parts:
        tables.append(_mode_ratios(evidence))
    if "dcb" in parts:
        lines = convergence.rows(evidence.runs, coarse=evidence.coarse)
        tables.append(
            Table(
                "Double cantilever beam [0/90]: standard and consistent with one criterion",
                convergence.TEXT,
                convergence.HEAD,
                lines,
            )
        )
    if "sensitivity" in parts:
        for study in sensitivity.studies(coarse=evidence.coarse):
            rows = [
                [label, value, *sensitivity.cells(evidence.runs, case)]
                for label, pairs in study.variants.items()
                for value, case in pairs
            ]
            name = study.title.split()[0].lower()
            picture = sensitivity.draw(study, evidence.runs, folder / f"sensitivity_{name}.png")
            head = ("specimen, element", study.parameter, *sensitivity.HEAD)
            text = sensitivity.text(study, evidence.runs)
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


def _loads(problem: str, evidence: Evidence) -> Table:
    head = (
        *("run", "peak (N) at (mm)", "at the end (N)", "off beam theory", "work - stored - dissipated"),
        *("increments", "cutbacks", "iterations"),
    )
    rows = []
    for case in paper_cases(problem, coarse=evidence.coarse) + comparator_cases(problem, coarse=evidence.coarse):
        run = evidence.runs[case]
        apart = branch_deviation(problem, run.displacement, run.load) if case.layup == "0/0" else np.array([np.nan])
        peak, place = run.peak
        rows.append(
            [
                *(case.name, f"{peak:.2f} at {place:.2f}", f"{run.load[-1]:.2f}"),
                "" if np.isnan(apart).any() else f"{np.abs(apart).max():.1%}",
                f"{curves.missing_energy(run):.2%}",
                *(str(count) for count in (run.entry.increments, run.entry.cutbacks, run.entry.iterations)),
            ]
        )
    text = "Off beam theory: the largest distance on the growth branch, [0/0]. Energies over the work."
    return Table(f"Load curves: {PROBLEMS[problem].title}", text, head, rows)


def _mode_ratios(evidence: Evidence) -> Table:
    head = ("initial crack (mm)", "crack (mm)", "G_I/G_II from the tractions", "off corrected beam theory", "off 4/3")
    rows, apart = [], []
    for case in (PaperCase("frmm", "0/0", "consistent", "1e6"), *longer_cases(coarse=evidence.coarse)):
        measures = (findings.crack_length, findings.mode_ratio, findings.theory_mode_ratio)
        length, ratio, theory = (measure(evidence, case.element, problem=case.problem) for measure in measures)
        apart.append(abs(ratio * 0.75 - 1.0))
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
        "[0/0], consistent element at 1e6 N/mm³, the paper's specimen and longer ones of the same height. 4/3 is the "
        "ratio of plain beams. Arms of 1.55 mm turn at the crack's end, in mode I more than in mode II: "
        + nearer_to_beams(apart)
    )
    return Table("Mode ratio of the fixed-ratio specimen", text, head, rows)


def nearer_to_beams(apart: Sequence[float]) -> str:
    """Say whether the distance from plain beams falls with the length of the crack, of distances in this order."""
    falls = all(long < short for short, long in itertools.pairwise(apart))
    return "the longer the crack, the less that counts." if falls else "it does not count for less with a longer crack."


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
    return Table("Runs", "Iterations include those of abandoned attempts.", head, rows)
