# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Numbers that decide on what the paper says of its parameters and in its conclusion. See findings.py."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from harness.delamination.reproduce.basics import swing
from harness.delamination.reproduce.cases import PROBLEMS, Case
from harness.delamination.reproduce.findings import Evidence, moment, theory_distance
from harness.delamination.reproduce.patch_cases import PatchCase


def strength_effect(evidence: Evidence, problem: str, strength: float) -> float:
    """Relative change of the peak load when both strengths are multiplied by a factor; infinite stiffness, [0/0]."""
    peaks = [
        evidence.case(Case(problem, "0/0", "consistent", "inf", strength=factor)).peak[0] for factor in (strength, 1.0)
    ]
    return abs(peaks[0] / peaks[1] - 1.0)


def reach(evidence: Evidence, problems: Sequence[str], element: str, stiffness: str) -> float:
    """Smallest share of the displacement that the runs reach, [0/0]."""
    runs = (evidence.run(problem, "0/0", element, stiffness) for problem in problems)
    return min(float(run.displacement[-1]) / run.case.displacement for run in runs)


def slope_ratio(evidence: Evidence, pair: Sequence[str]) -> float:
    """Slope of the load curve in the first increment at the first stiffness over that at the second, the smallest.

    Standard method, [0/0], all specimens.
    """
    found = []
    for problem in PROBLEMS:
        low, high = (evidence.run(problem, "0/0", "standard", stiffness) for stiffness in pair)
        slopes = [float(run.load[1] / run.displacement[1]) for run in (low, high)]
        found.append(slopes[0] / slopes[1])
    return min(found)


def worst_theory_distance(evidence: Evidence, element: str, stiffness: str) -> float:
    """Largest distance of the load from corrected beam theory on the growth branches of all specimens, relative."""
    return max(theory_distance(evidence, problem, element, [stiffness]) for problem in PROBLEMS)


def kink_distance(evidence: Evidence, problem: str, traction: str) -> float:
    """Distance (mm) of the standard method's worst kink from the last point that is more than half damaged.

    At 1e8, [0/0], at the moment of the figures. The kink is the largest change between neighbouring points of the
    distance from the consistent method's profile, process zones apart: ahead of both.
    """
    rough, smooth = (moment(evidence.run(problem, "0/0", element, "1e8")) for element in ("standard", "consistent"))
    front = max(float(profile["X"][profile["DAMAGE"] >= 0.5].max()) for profile in (rough, smooth))
    ahead = rough["X"] > front
    place = rough["X"][ahead]
    rest = rough[traction][ahead] - np.interp(place, smooth["X"], smooth[traction])
    return float(place[1:][np.abs(np.diff(rest)).argmax()]) - front


def large_beta(evidence: Evidence, beta: float) -> float:
    """Standard deviation of the normal traction on moved nodes over the standard method's, with a large beta."""
    stabilised = evidence.runs.patch(PatchCase("horizontal", "0/0", "stabilised", moved=True, beta=beta))
    standard = evidence.runs.patch(PatchCase("horizontal", "0/0", "standard", moved=True))
    return swing(stabilised.traction) / swing(standard.traction)


MEASURES: dict[str, Callable[..., float]] = {
    function.__name__: function
    for function in (strength_effect, reach, slope_ratio, worst_theory_distance, kink_distance, large_beta)
}
