# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The numbers that decide on the paper's statements, by the names that claims.toml gives them.

Each function takes what was run (`Evidence`) and the arguments of a claim, and gives one number. Where a claim speaks
of several runs the number is the one that is worst for it.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from harness.delamination.materials import TABLE_2
from harness.delamination.oscillation import raw_index
from harness.delamination.reproduce.beams import growth
from harness.delamination.reproduce.cases import LAYUPS, MOMENTS, PROBLEMS, Case
from harness.delamination.reproduce.runs import Profile, Run, Runs
from harness.delamination.study.rows import STRENGTHS, at_tenths, damage_variation
from harness.model.arrays import FloatArray

ALL = ("1e4", "1e6", "1e8")


@dataclass(frozen=True, slots=True)
class Evidence:
    """What was run, and whether on the coarser meshes."""

    runs: Runs
    coarse: bool

    def run(self, problem: str, layup: str, element: str, stiffness: str, *, perturbed: bool = False) -> Run:
        """Run of a delamination test."""
        return self.runs[Case(problem, layup, element, stiffness, perturbed, self.coarse)]

    def case(self, case: Case) -> Run:
        """Run of a case on these meshes."""
        return self.runs[replace(case, coarse=self.coarse)]


def index(
    evidence: Evidence,
    problem: str,
    layup: str,
    element: str,
    tractions: Sequence[str],
    stiffnesses: Sequence[str] = ("1e8",),
    *,
    perturbed: bool = False,
) -> float:
    """Largest oscillation index of the tractions, over all stiffnesses and tenths of the displacement."""
    found = [
        raw_index(profile[name], STRENGTHS[name])
        for stiffness in stiffnesses
        for profile in evidence.run(problem, layup, element, stiffness, perturbed=perturbed).bonded
        for name in tractions
    ]
    return max(found)


def smallest_index(
    evidence: Evidence, problem: str, layup: str, element: str, tractions: Sequence[str], *, perturbed: bool = False
) -> float:
    """The smallest among the tractions of each one's largest oscillation index at 1e8: all of them oscillate."""
    return min(index(evidence, problem, layup, element, [name], perturbed=perturbed) for name in tractions)


def index_gain(
    evidence: Evidence, problem: str, layup: str, tractions: Sequence[str], *, perturbed: bool = False
) -> float:
    """Spurious variation (index less 1) of the stabilised method at 1e8 over that of the standard one."""
    stabilised, standard = (
        index(evidence, problem, layup, element, tractions, perturbed=perturbed) - 1.0
        for element in ("stabilised", "standard")
    )
    return stabilised / standard if standard > 0.0 else np.inf


def damage_turns(
    evidence: Evidence,
    problem: str,
    layup: str,
    element: str,
    stiffnesses: Sequence[str] = ("1e8",),
) -> float:
    """Largest total variation of the damage over its largest value, less 1: what comes and goes again."""
    found = [
        damage_variation(profile["DAMAGE"]) - 1.0
        for stiffness in stiffnesses
        for profile in at_tenths(evidence.run(problem, layup, element, stiffness).profiles)
    ]
    return max(found)


def theory_distance(evidence: Evidence, problem: str, element: str, stiffnesses: Sequence[str] = ALL) -> float:
    """Largest distance from corrected beam theory on the growth branch, relative.

    The branch lies between the lengths of a sharp crack that BRANCH gives.
    """
    return max(abs(value) for value in _branch(evidence, problem, element, stiffnesses))


def theory_mean(evidence: Evidence, problem: str, element: str, stiffnesses: Sequence[str] = ALL) -> float:
    """Mean distance from corrected beam theory on the growth branch, relative, the largest over the stiffnesses."""
    return max(float(np.mean(np.abs(_branch(evidence, problem, element, [stiffness])))) for stiffness in stiffnesses)


BRANCH = {"dcb": (36.0, 60.0), "enf": (38.0, 48.5), "frmm": (36.0, 44.0)}
"""Lengths of a sharp crack between which the growth branch is compared (mm): before, the process zone forms, which
rounds the peak, and is longest in mode II; after, it meets the load at mid-span or the clamp."""


def _branch(evidence: Evidence, problem: str, element: str, stiffnesses: Iterable[str]) -> list[float]:
    curve = growth(problem)
    distances: list[float] = []
    for stiffness in stiffnesses:
        run = evidence.run(problem, "0/0", element, stiffness)
        inside = curve.between(*BRANCH[problem])
        distances += inside.deviation(run.displacement, run.load).tolist()
    return distances


def curve_distance(one: Run, other: Run, last: float = np.inf) -> float:
    """Largest distance of two load curves over the largest load, up to a displacement; across a jump of the load, the
    distance to the curve, not to its value at the same displacement, which the increments decide."""
    peak = other.peak[0]
    inside = one.displacement <= last
    scale = np.array([other.displacement[-1], peak])
    points = np.column_stack([one.displacement[inside], one.load[inside]]) / scale
    line = np.column_stack([other.displacement, other.load]) / scale
    return float(max(to_line(point, line) for point in points))


def to_line(point: FloatArray, line: FloatArray) -> float:
    """Distance of a point (2,) from a line of straight pieces through the points (n, 2)."""
    start, along = line[:-1], np.diff(line, axis=0)
    squares = np.maximum(np.sum(along**2, axis=1), 1e-300)
    share = np.clip(np.sum((point - start) * along, axis=1) / squares, 0.0, 1.0)
    return float(np.sqrt(np.min(np.sum((start + share[:, None] * along - point) ** 2, axis=1))))


def methods_distance(evidence: Evidence, problem: str, layups: Sequence[str] = ("0/0", "0/90")) -> float:
    """Largest distance of the load curves of the standard and the stabilised method at equal stiffness."""
    return max(
        curve_distance(evidence.run(problem, layup, "stabilised", s), evidence.run(problem, layup, "standard", s))
        for layup in layups
        for s in ALL
    )


def profile_distance(
    evidence: Evidence, problem: str, layup: str, elements: Sequence[str], traction: str, pair: Sequence[str]
) -> float:
    """Largest distance of a traction's profiles at two stiffnesses, at the moment of the figures, over the strength."""
    found = []
    for element in elements:
        one, other = (moment(evidence.run(problem, layup, element, stiffness)) for stiffness in pair)
        other_there = np.interp(one["X"], other["X"], other[traction])
        found.append(float(np.abs(one[traction] - other_there).max()) / STRENGTHS[traction])
    return max(found)


def moment(run: Run) -> Profile:
    """Profile at the moment that the figures show."""
    return run.at(MOMENTS[run.case.problem, run.case.layup])


def oscillation_place(evidence: Evidence, problem: str, layup: str, element: str) -> float:
    """Distance (mm) of the standard method's worst kink in the normal traction from the point where it changes sign.

    The kink is the largest change between neighbouring points of the distance from the stabilised method's profile.
    """
    profile = moment(evidence.run(problem, layup, element, "1e8"))
    smooth = moment(evidence.run(problem, layup, "consistent", "1e8"))
    rest = profile["TN"] - np.interp(profile["X"], smooth["X"], smooth["TN"])
    kink = profile["X"][1:][np.abs(np.diff(rest)).argmax()]
    return float(abs(kink - sign_change(smooth)))


def sign_change(profile: Profile) -> float:
    """Place where the normal traction turns from tension ahead of the crack to compression (mm)."""
    peak = int(profile["TN"].argmax())
    return float(profile["X"][peak + int(np.argmax(profile["TN"][peak:] < 0.0))])


def peak_traction_ratio(
    evidence: Evidence, problem: str, layup: str, elements: Sequence[str], pair: Sequence[str]
) -> float:
    """Largest tangential traction at the first stiffness over that at the second, at the moment of the figures."""
    found = []
    for element in elements:
        low, high = (
            float(np.abs(moment(evidence.run(problem, layup, element, stiffness))["TT"]).max()) for stiffness in pair
        )
        found.append(low / high)
    return max(found)


def local_error(evidence: Evidence, problem: str, element: str, traction: str) -> float:
    """Largest distance of a traction on the perturbed mesh from the consistent method's on the structured one.

    Over the strength, at the moment of the figures, from the front of the damage on.
    """
    rough = moment(evidence.run(problem, "0/0", element, "1e8", perturbed=True))
    smooth = moment(evidence.run(problem, "0/0", "consistent", "1e8"))
    bonded = (rough["DAMAGE"] < 0.5) & (rough["X"] > float(smooth["X"][smooth["DAMAGE"] > 0.0].max(initial=0.0)))
    rest = rough[traction] - np.interp(rough["X"], smooth["X"], smooth[traction])
    return float(np.abs(rest[bonded]).max()) / STRENGTHS[traction]


def closed_index(evidence: Evidence, problem: str, element: str) -> float:
    """Oscillation index of the normal traction on the perturbed mesh at 1e8 where it is compressive, [0/0].

    That is the stretch from the change of its sign to where the consistent method's on the structured mesh is back
    at a hundredth of its largest pressure.
    """
    smooth = moment(evidence.run(problem, "0/0", "consistent", "1e8"))
    pressure = smooth["TN"].min()
    ends = smooth["X"][smooth["TN"] < 0.01 * pressure]
    rough = moment(evidence.run(problem, "0/0", element, "1e8", perturbed=True))
    inside = (rough["X"] >= sign_change(smooth)) & (rough["X"] <= ends.max())
    return raw_index(rough["TN"][inside], abs(float(pressure)))


def process_zone(evidence: Evidence, problem: str) -> float:
    """Interface elements in the process zone (0 < damage < 1) at the moment of the figures: the fewest, [0/0], 1e6."""
    run = evidence.run(problem, "0/0", "stabilised", "1e6")
    damage = moment(run)["DAMAGE"]
    return float(np.count_nonzero((damage > 0.0) & (damage < 1.0))) / 2.0


def iterations_ratio(evidence: Evidence) -> float:
    """Iterations of the stabilised method over those of the standard one, all specimens, layups and stiffnesses."""
    totals = {"stabilised": 0, "standard": 0}
    for problem, layup, stiffness in itertools.product(PROBLEMS, LAYUPS, ALL):
        for element in totals:
            totals[element] += evidence.run(problem, layup, element, stiffness).entry.iterations
    return totals["stabilised"] / totals["standard"]


def energy_error(evidence: Evidence, problem: str, element: str, stiffnesses: Sequence[str] = ALL) -> float:
    """External work less stored and dissipated energy at the end, over the external work, [0/0]."""
    found = []
    for stiffness in stiffnesses:
        history = evidence.run(problem, "0/0", element, stiffness).history
        work = history["ALLWK"][-1]
        rest = work - history["ALLSE"][-1] - history["ALLPD"][-1] - history["ALLVD"][-1]
        found.append(abs(float(rest / work)))
    return max(found)


def mode_ratio(evidence: Evidence, element: str, stiffness: str = "1e6") -> float:
    """G_I/G_II of the fixed-ratio specimen from the tractions: what failed points have dissipated in either mode."""
    profile = evidence.run("frmm", "0/0", element, stiffness).at(3.0)
    failed = profile["DAMAGE"] >= 1.0
    return float(profile["DISSI"][failed].sum() / profile["DISSII"][failed].sum())


def toughness(evidence: Evidence, problem: str, element: str, stiffness: str = "1e6") -> float:
    """Mean over failed points of the shares of both toughnesses that damage has dissipated, (11): 1."""
    profile = evidence.run(problem, "0/0", element, stiffness).profiles[-1]
    failed = profile["DAMAGE"] >= 1.0
    spent = profile["DISSI"] / TABLE_2.toughness_1 + profile["DISSII"] / TABLE_2.toughness_2
    return float(spent[failed].mean())


MEASURES: dict[str, Callable[..., float]] = {
    function.__name__: function
    for function in (
        *(index, smallest_index, index_gain, damage_turns, theory_distance, theory_mean, methods_distance),
        *(profile_distance, oscillation_place, peak_traction_ratio, local_error, closed_index, process_zone),
        *(iterations_ratio, energy_error, mode_ratio, toughness),
    )
}
