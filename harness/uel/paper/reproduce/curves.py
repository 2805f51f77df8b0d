# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Numbers that decide on the paper's statements, from load curves, energies and iterations. See findings.py."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

import numpy as np

from uel.delamination.beams import branch_deviation
from uel.model.arrays import FloatArray
from uel.paper.reproduce.cases import LAYUPS, PROBLEMS, SHOWN, PaperCase, secant_cases
from uel.paper.reproduce.findings import Evidence
from uel.paper.reproduce.runs import Run

COMPARED = {"enf": ("standard", "paper", "consistent", "COH2D4"), "frmm": ("paper", "COH2D4")}
"""Elements whose peak loads of [0/90] at 1e6 are compared, by specimen."""


def compared(problem: str, *, coarse: bool) -> list[PaperCase]:
    """Return the cases of a specimen whose peak loads are compared."""
    return [PaperCase(problem, "0/90", element, "1e6", coarse=coarse) for element in COMPARED.get(problem, ())]


def theory_distance(evidence: Evidence, problem: str, element: str, stiffnesses: Sequence[str] = SHOWN) -> float:
    """Return the largest distance from corrected beam theory on the growth branch, relative.

    The branch lies between the lengths of a sharp crack that `beams.BRANCH` gives.
    """
    return max(abs(value) for value in _branch(evidence, problem, element, stiffnesses))


def theory_mean(evidence: Evidence, problem: str, element: str, stiffnesses: Sequence[str] = SHOWN) -> float:
    """Return the mean relative distance from corrected beam theory in growth, the largest over the stiffnesses."""
    return max(float(np.mean(np.abs(_branch(evidence, problem, element, [stiffness])))) for stiffness in stiffnesses)


def _branch(evidence: Evidence, problem: str, element: str, stiffnesses: Iterable[str]) -> list[float]:
    distances: list[float] = []
    for stiffness in stiffnesses:
        run = evidence.run(problem, "0/0", element, stiffness)
        distances += branch_deviation(problem, run.displacement, run.load).tolist()
    return distances


def curve_distance(one: Run, other: Run, last: float = np.inf) -> float:
    """Return the largest distance of two load curves over the largest load, up to a displacement.

    Across a jump of the load the distance to the curve counts, not to its value at the same displacement, which the
    increments decide.
    """
    peak = other.peak[0]
    inside = one.displacement <= last
    scale = np.array([other.displacement[-1], peak])
    points = np.column_stack([one.displacement[inside], one.load[inside]]) / scale
    line = np.column_stack([other.displacement, other.load]) / scale
    return float(max(to_line(point, line) for point in points))


def to_line(point: FloatArray, line: FloatArray) -> float:
    """Return the distance of a point (2,) from a line of straight pieces through the points (n, 2)."""
    start, along = line[:-1], np.diff(line, axis=0)
    squares = np.maximum(np.sum(along**2, axis=1), 1e-300)
    share = np.clip(np.sum((point - start) * along, axis=1) / squares, 0.0, 1.0)
    return float(np.sqrt(np.min(np.sum((start + share[:, None] * along - point) ** 2, axis=1))))


def methods_distance(evidence: Evidence, problem: str, layups: Sequence[str] = ("0/0", "0/90")) -> float:
    """Return the largest distance of the load curves of the standard and the paper's element at equal stiffness."""
    return max(
        curve_distance(evidence.run(problem, layup, "paper", s), evidence.run(problem, layup, "standard", s))
        for layup in layups
        for s in SHOWN
    )


def methods_peak_difference(evidence: Evidence, problem: str, layup: str, element: str) -> float:
    """Return the relative difference of an element's peak load at 1e6 from the standard element's, with its sign."""
    peaks = [evidence.peak(PaperCase(problem, layup, name, "1e6")) for name in (element, "standard")]
    return peaks[0] / peaks[1] - 1.0


def comparator_distance(
    evidence: Evidence, problem: str, layup: str, element: str, stiffness: str = "1e6", last: float = np.inf
) -> float:
    """Return the largest distance of an element's load curve from COH2D4's over the peak load, up to `last` (mm)."""
    built_in = evidence.run(problem, layup, "COH2D4", "1e6")
    return curve_distance(evidence.run(problem, layup, element, stiffness), built_in, last)


def peak_difference(evidence: Evidence, problem: str, layup: str, element: str, stiffness: str = "1e6") -> float:
    """Return the relative difference of an element's peak load from COH2D4's, without its sign."""
    built_in = evidence.peak(PaperCase(problem, layup, "COH2D4", "1e6"))
    return abs(evidence.peak(PaperCase(problem, layup, element, stiffness)) / built_in - 1.0)


def single_iterations(evidence: Evidence) -> float:
    """Return the share of increments with secant and relaxed residual that converge in one iteration, at 1e6."""
    case = next(case for case in secant_cases() if case.tolerance and case.stiffness == "1e6")
    lines = [line for line in evidence.case(case).status if not line.cutback]
    return sum(line.total_iterations == 1 for line in lines) / len(lines)


def secant_reach(evidence: Evidence, stiffnesses: Sequence[str] = ("1e6", "1e8"), *, relaxed: bool) -> float:
    """Return the smallest share of the displacement that the secant reaches in small increments, at the stiffnesses.

    With `relaxed`, with a residual a hundred times the default.
    """
    cases = [case for case in secant_cases() if case.increments and (case.tolerance is not None) == relaxed]
    runs = [evidence.case(case) for case in cases if case.stiffness in stiffnesses]
    return min(float(run.displacement[-1]) / run.case.displacement for run in runs)


def smallest_increment(evidence: Evidence, *, secant: bool) -> float:
    """Return the smallest increment over the one asked for, at 1e6 and 1e8: with secant or consistent tangent."""
    cases = [case for case in secant_cases() if not case.increments]
    runs = [evidence.case(case if secant else replace(case, secant=False, tolerance=None)) for case in cases]
    return min(
        line.time_increment * run.case.increment_count for run in runs for line in run.status if not line.cutback
    )


def iterations_ratio(evidence: Evidence) -> float:
    """Return the iterations of the paper's element over the standard one's, all specimens, layups and stiffnesses."""
    totals = {"paper": 0, "standard": 0}
    for problem, layup, stiffness in itertools.product(PROBLEMS, LAYUPS, SHOWN):
        for element in totals:
            totals[element] += evidence.run(problem, layup, element, stiffness).entry.iterations
    return totals["paper"] / totals["standard"]


def energy_error(evidence: Evidence, problem: str, element: str, stiffnesses: Sequence[str] = SHOWN) -> float:
    """Return the largest `missing_energy` at the stiffnesses, without its sign, [0/0]."""
    return max(abs(missing_energy(evidence.run(problem, "0/0", element, stiffness))) for stiffness in stiffnesses)


def missing_energy(run: Run) -> float:
    """Return the external work less stored and dissipated energy at the end, over the external work."""
    history = run.history
    work = history["ALLWK"][-1]
    # ALLDMD and ALLCD are those of the built-in elements
    spent = sum(history[name][-1] for name in ("ALLPD", "ALLVD", "ALLDMD", "ALLCD") if name in history)
    return float((work - history["ALLSE"][-1] - spent) / work)


MEASURES: dict[str, Callable[..., float]] = {
    function.__name__: function
    for function in (
        *(
            theory_distance,
            theory_mean,
            methods_distance,
            methods_peak_difference,
            comparator_distance,
            peak_difference,
        ),
        *(single_iterations, secant_reach, smallest_increment, iterations_ratio, energy_error),
    )
}
