# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Numbers that decide on what the paper says about its parameters and in its conclusion. See findings.py."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from uel.delamination.oscillation import total_variation
from uel.paper.reproduce.basics import swing
from uel.paper.reproduce.cases import PROBLEMS, PaperCase
from uel.paper.reproduce.curves import theory_distance
from uel.paper.reproduce.findings import Evidence, closed_stretch, moment, profile_distance, variation
from uel.paper.reproduce.patch_cases import PatchCase
from uel.paper.study.rows import STRENGTHS, bonded_part


def strength_effect(evidence: Evidence, problem: str, strength: float) -> float:
    """Return the relative change of the peak load by a factor on both strengths; infinite stiffness, [0/0]."""
    peaks = [
        evidence.peak(PaperCase(problem, "0/0", "consistent", "inf", strength=factor)) for factor in (strength, 1.0)
    ]
    return abs(peaks[0] / peaks[1] - 1.0)


def reach(evidence: Evidence, problems: Sequence[str], element: str, stiffnesses: Sequence[str]) -> float:
    """Return the smallest share of the displacement that the runs reach, [0/0]."""
    runs = (evidence.run(problem, "0/0", element, stiffness) for problem in problems for stiffness in stiffnesses)
    return min(float(run.displacement[-1]) / run.case.displacement for run in runs)


def slope_ratio(evidence: Evidence, pair: Sequence[str]) -> float:
    """Return the initial slope of the load curve at the first stiffness over that at the second, the smallest.

    Standard element, [0/0], all specimens.
    """
    found = []
    for problem in PROBLEMS:
        low, high = (evidence.run(problem, "0/0", "standard", stiffness) for stiffness in pair)
        slopes = [float(run.load[1] / run.displacement[1]) for run in (low, high)]
        found.append(slopes[0] / slopes[1])
    return min(found)


def worst_theory_distance(evidence: Evidence, element: str, stiffness: str) -> float:
    """Return the largest relative distance from corrected beam theory on the growth branches of all specimens."""
    return max(theory_distance(evidence, problem, element, [stiffness]) for problem in PROBLEMS)


def kink_distance(evidence: Evidence, problem: str, traction: str) -> float:
    """Return the distance (mm) of the standard element's worst kink from the last point that is more than half damaged.

    At 1e8, [0/0], at the moment of the figures. The kink is the largest change between neighbouring points of the
    distance from the consistent element's profile, process zones apart: ahead of both.
    """
    rough, smooth = (moment(evidence.run(problem, "0/0", element, "1e8")) for element in ("standard", "consistent"))
    front = max(float(profile["X"][profile["LOST"] >= 0.5].max()) for profile in (rough, smooth))
    ahead = rough["X"] > front
    place = rough["X"][ahead]
    rest = rough[traction][ahead] - np.interp(place, smooth["X"], smooth[traction])
    return float(place[1:][np.abs(np.diff(rest)).argmax()]) - front


def large_beta(evidence: Evidence, beta: float) -> float:
    """Return the deviation of the normal traction on moved nodes over the standard element's, with a large beta."""
    paper = evidence.runs.patch(PatchCase("horizontal", "0/0", "paper", moved=True, beta=beta))
    standard = evidence.runs.patch(PatchCase("horizontal", "0/0", "standard", moved=True))
    return swing(paper.traction) / swing(standard.traction)


def contrast(evidence: Evidence) -> float:
    """Compare the standard element's deviation on moved nodes at 1e8 in both directions to that with soft sliding."""
    soft = PatchCase("horizontal", "0/0", "standard", moved=True)
    return swing(evidence.runs.patch(replace(soft, shear=soft.normal)).traction) / swing(
        evidence.runs.patch(soft).traction
    )


def soft_difference(evidence: Evidence) -> float:
    """Return the largest distance of both elements' tractions at 1e4 over that at 1e8, [0/0], over all specimens."""
    found = []
    for problem, kind in PROBLEMS.items():
        for name in kind.modes:
            apart = []
            for stiffness in ("1e4", "1e8"):
                one, other = (
                    moment(evidence.run(problem, "0/0", element, stiffness)) for element in ("standard", "paper")
                )
                apart.append(float(np.abs(one[name] - other[name]).max()))
            found.append(apart[0] / apart[1])
    return max(found)


def structured_share(evidence: Evidence, problems: Sequence[str] = tuple(PROBLEMS)) -> float:
    """Return the variation of the standard element's traction, structured over perturbed mesh, 1e8, [0/0].

    The largest of the specimens and tractions, at the moment of the figures.
    """
    return max(
        variation(evidence, problem, "0/0", "standard", [name])
        / variation(evidence, problem, "0/0", "standard", [name], perturbed=True)
        for problem in problems
        for name in PROBLEMS[problem].modes
    )


def soft_variation(evidence: Evidence, problems: Sequence[str] = tuple(PROBLEMS)) -> float:
    """Return the variation of the standard element's tractions at 1e4, [0/0], largest of specimens and moments."""
    return max(
        variation(evidence, problem, "0/0", "standard", PROBLEMS[problem].modes, ["1e4"], ever=True)
        for problem in problems
    )


def contact_share(evidence: Evidence) -> float:
    """Return the variation of the standard element's t_n on the perturbed mesh, compressive part over the rest.

    Each over that of the consistent element on the structured mesh; DCB, 1e8, [0/0], at the moment of the figures.
    """
    smooth = moment(evidence.run("dcb", "0/0", "consistent", "1e8"))
    rough = moment(evidence.run("dcb", "0/0", "standard", "1e8", perturbed=True))
    low, high = closed_stretch(smooth)
    tip = float(bonded_part(smooth)["X"][0])
    grown = []
    for start, end in ((low, high), (tip, low)):
        parts = [p["TN"][(p["X"] >= start) & (p["X"] <= end)] for p in (rough, smooth)]
        grown.append(total_variation(parts[0]) / total_variation(parts[1]))
    return grown[0] / grown[1]


def mixed_mode_error(evidence: Evidence) -> float:
    """Return the distance of the standard element's profiles, 1e4 to 1e6, FRMM over the largest other, [0/0]."""
    apart = {
        problem: max(
            profile_distance(evidence, problem, "0/0", ["standard"], name, ["1e4", "1e6"]) for name in kind.modes
        )
        for problem, kind in PROBLEMS.items()
    }
    return apart["frmm"] / max(apart["dcb"], apart["enf"])


def early_damage(evidence: Evidence) -> float:
    """Return the largest traction over its strength in the FRMM at 1e4, standard element, [0/0], as in the figures."""
    profile = moment(evidence.run("frmm", "0/0", "standard", "1e4"))
    return max(float(np.abs(profile[name]).max()) / STRENGTHS[name] for name in ("TN", "TT"))


def zone_share(evidence: Evidence, strength: float) -> float:
    """Count the points in the DCB's process zone with multiplied strengths, over those without; infinite stiffness."""
    counts = []
    for factor in (strength, 1.0):
        damage = moment(evidence.case(PaperCase("dcb", "0/0", "consistent", "inf", strength=factor)))["SOFTENED"]
        counts.append(np.count_nonzero((damage > 0.0) & (damage < 1.0)))
    return counts[0] / counts[1]


def newton_cotes_gain(evidence: Evidence) -> float:
    """Return the largest variation of the standard element's t_n, Gauss over Newton-Cotes points, DCB, 1e8."""
    gauss = PaperCase("dcb", "0/0", "standard", "1e8")
    worst = []
    for case in (gauss, replace(gauss, newton_cotes=True)):
        worst.append(max(total_variation(profile["TN"]) for profile in evidence.case(case).bonded))
    return worst[0] / worst[1]


def stiff_load(evidence: Evidence, problems: Sequence[str]) -> float:
    """Return the relative change of the paper's element's peak load from 1e8 to 1e12, the largest, [0/0]."""
    peaks = [[evidence.peak(PaperCase(p, "0/0", "paper", s)) for s in ("1e8", "1e12")] for p in problems]
    return max(abs(high / low - 1.0) for low, high in peaks)


MEASURES: dict[str, Callable[..., float]] = {
    function.__name__: function
    for function in (
        *(strength_effect, reach, slope_ratio, worst_theory_distance, kink_distance, large_beta, contrast),
        *(soft_difference, structured_share, soft_variation, contact_share, mixed_mode_error, early_damage, zone_share),
        *(newton_cotes_gain, stiff_load),
    )
}
