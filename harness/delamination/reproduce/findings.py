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

from harness.delamination.beams import branch_deviation
from harness.delamination.materials import TABLE_2
from harness.delamination.oscillation import total_variation
from harness.delamination.reproduce.cases import AROUND, LAYUPS, MOMENTS, PROBLEMS, Case, secant_cases
from harness.delamination.reproduce.runs import Profile, Run, Runs
from harness.delamination.specimens import ARMS
from harness.delamination.study.rows import STRENGTHS, at_tenths, bonded_part, damage_variation
from harness.delamination.theory import frmm_mode_ratio
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


def variation(
    evidence: Evidence,
    problem: str,
    layup: str,
    element: str,
    tractions: Sequence[str],
    stiffnesses: Sequence[str] = ("1e8",),
    *,
    perturbed: bool = False,
    ever: bool = False,
) -> float:
    """Total variation of a traction over that of the consistent method on the structured mesh, the largest.

    1 is a profile that rises and falls as the consistent method's, 1.05 one that adds a twentieth of ups and downs.

    Parameters
    ----------
    problem, layup, element, tractions, stiffnesses, perturbed
        Runs and tractions; stiffnesses are compared each with its own.
    ever
        At every tenth of the displacement in place of the moment of the figures.
    """
    found = []
    for stiffness in stiffnesses:
        profiles, smooth = (
            _profiles(run, ever=ever)
            for run in (
                evidence.run(problem, layup, element, stiffness, perturbed=perturbed),
                evidence.run(problem, layup, "consistent", stiffness),
            )
        )
        for name in tractions:
            # a run that stopped has fewer
            pairs = zip(profiles, smooth, strict=False)
            found += [_varies(one, name) / max(_varies(other, name), STRENGTHS[name]) for one, other in pairs]
    return max(found)


def _profiles(run: Run, *, ever: bool) -> list[Profile]:
    return run.bonded if ever else [bonded_part(moment(run))]


def _varies(profile: Profile, name: str) -> float:
    return max(total_variation(profile[name]), STRENGTHS[name])


def smallest_variation(
    evidence: Evidence, problem: str, layup: str, element: str, tractions: Sequence[str], *, ever: bool = False
) -> float:
    """The smallest among the tractions of `variation` at 1e8: all of them oscillate."""
    return min(variation(evidence, problem, layup, element, [name], ever=ever) for name in tractions)


def variation_gain(
    evidence: Evidence, problem: str, layup: str, tractions: Sequence[str], *, ever: bool = False
) -> float:
    """What the stabilised method adds to the smooth variation on the perturbed mesh, over what the standard one adds.

    At 1e8. Real variation, which bumps cause, is in both.
    """
    stabilised, standard = (
        variation(evidence, problem, layup, element, tractions, perturbed=True, ever=ever) - 1.0
        for element in ("stabilised", "standard")
    )
    return max(stabilised, 0.0) / standard if standard > 0.0 else np.inf


def damage_turns(
    evidence: Evidence,
    problem: str,
    layup: str,
    element: str,
    stiffness: str = "1e8",
    *,
    ever: bool = False,
    whole: bool = False,
) -> float:
    """Largest departure of the damage from a steady fall to 0: total variation over its largest value, less 1.

    Without the sign: damage that turns back varies more, damage that nowhere falls to 0 varies less. Up to as far ahead
    of the failed part as the figures show, or along the `whole` interface. `ever` as above.
    """
    run = evidence.run(problem, layup, element, stiffness)
    profiles = at_tenths(run.profiles) if ever else [moment(run)]
    damages = [profile["DAMAGE"] if whole else damage_near_tip(profile, problem) for profile in profiles]
    return max(abs(damage_variation(damage) - 1.0) for damage in damages)


def damage_near_tip(profile: Profile, problem: str) -> FloatArray:
    """Damage up to the end of the figures' stretch, counted from the first point that has not failed."""
    tip = float(bonded_part(profile)["X"][0])
    return profile["DAMAGE"][profile["X"] <= tip + AROUND[problem][1]]


def theory_distance(evidence: Evidence, problem: str, element: str, stiffnesses: Sequence[str] = ALL) -> float:
    """Largest distance from corrected beam theory on the growth branch, relative.

    The branch lies between the lengths of a sharp crack that `beams.BRANCH` gives.
    """
    return max(abs(value) for value in _branch(evidence, problem, element, stiffnesses))


def theory_mean(evidence: Evidence, problem: str, element: str, stiffnesses: Sequence[str] = ALL) -> float:
    """Mean distance from corrected beam theory on the growth branch, relative, the largest over the stiffnesses."""
    return max(float(np.mean(np.abs(_branch(evidence, problem, element, [stiffness])))) for stiffness in stiffnesses)


def _branch(evidence: Evidence, problem: str, element: str, stiffnesses: Iterable[str]) -> list[float]:
    distances: list[float] = []
    for stiffness in stiffnesses:
        run = evidence.run(problem, "0/0", element, stiffness)
        distances += branch_deviation(problem, run.displacement, run.load).tolist()
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


def methods_peak_difference(evidence: Evidence, problem: str, layup: str, element: str) -> float:
    """Relative difference of an element's peak load at 1e6 from the standard method's, with its sign."""
    peaks = [evidence.run(problem, layup, name, "1e6").peak[0] for name in (element, "standard")]
    return peaks[0] / peaks[1] - 1.0


def comparator_distance(
    evidence: Evidence, problem: str, layup: str, element: str, stiffness: str = "1e6", last: float = np.inf
) -> float:
    """Largest distance of an element's load curve from COH2D4's over the peak load, up to a displacement (mm)."""
    built_in = evidence.run(problem, layup, "COH2D4", "1e6")
    return curve_distance(evidence.run(problem, layup, element, stiffness), built_in, last)


def peak_difference(evidence: Evidence, problem: str, layup: str, element: str, stiffness: str = "1e6") -> float:
    """Relative difference of an element's peak load from COH2D4's, without its sign."""
    built_in = evidence.run(problem, layup, "COH2D4", "1e6").peak[0]
    return abs(evidence.run(problem, layup, element, stiffness).peak[0] / built_in - 1.0)


def single_iterations(evidence: Evidence) -> float:
    """Share of the increments with the secant and the residual 0.5 that converge in one iteration."""
    lines = [line for line in evidence.case(secant_cases()[1]).status if not line.cutback]
    return sum(line.total_iterations == 1 for line in lines) / len(lines)


def secant_reach(evidence: Evidence, which: int) -> float:
    """Share of the displacement that the secant reaches: 0 with the default residual, 1 with 0.5."""
    run = evidence.case(secant_cases()[which])
    return float(run.displacement[-1]) / run.case.displacement


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


def local_error(evidence: Evidence, problem: str, element: str, traction: str, *, ever: bool = False) -> float:
    """Largest distance of a traction from the consistent method's over the strength, ahead of the process zone.

    Both on the perturbed mesh, whose bumps cause variation that is real. `ever` as above.
    """
    found = []
    pairs = (evidence.run(problem, "0/0", name, "1e8", perturbed=True) for name in (element, "consistent"))
    for rough, smooth in zip(*(at_tenths(run.profiles) if ever else [moment(run)] for run in pairs), strict=False):
        start = float(smooth["X"][smooth["DAMAGE"] > 0.0].max(initial=0.0))
        bonded = (rough["DAMAGE"] < 0.5) & (rough["X"] > start)
        rest = rough[traction] - np.interp(rough["X"], smooth["X"], smooth[traction])
        found.append(float(np.abs(rest[bonded]).max(initial=0.0)) / STRENGTHS[traction])
    return max(found)


def closed_stretch(smooth: Profile) -> tuple[float, float]:
    """Where the normal traction is compressive ahead of the crack, to a hundredth of its largest pressure (mm)."""
    pressed = smooth["X"][smooth["TN"] < 0.01 * smooth["TN"].min()]
    return sign_change(smooth), float(pressed.max())


def closed_variation(evidence: Evidence, problem: str, element: str) -> float:
    """As `variation`, of the normal traction on the perturbed mesh at 1e8 where it is compressive, [0/0]."""
    smooth = moment(evidence.run(problem, "0/0", "consistent", "1e8"))
    rough = moment(evidence.run(problem, "0/0", element, "1e8", perturbed=True))
    low, high = closed_stretch(smooth)
    one, other = (
        total_variation(profile["TN"][(profile["X"] >= low) & (profile["X"] <= high)]) for profile in (rough, smooth)
    )
    return one / other


def closed_error(evidence: Evidence, problem: str, element: str) -> float:
    """Mean distance of the normal traction on the perturbed mesh from the structured one's, over the strength.

    At 1e8, in the compressive stretch of the consistent method, which is the reference too.
    """
    smooth = moment(evidence.run(problem, "0/0", "consistent", "1e8"))
    rough = moment(evidence.run(problem, "0/0", element, "1e8", perturbed=True))
    low, high = closed_stretch(smooth)
    inside = (rough["X"] >= low) & (rough["X"] <= high)
    rest = rough["TN"] - np.interp(rough["X"], smooth["X"], smooth["TN"])
    return float(np.abs(rest[inside]).mean()) / STRENGTHS["TN"]


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
        # ALLDMD and ALLCD are those of the built-in elements
        spent = sum(history[name][-1] for name in ("ALLPD", "ALLVD", "ALLDMD", "ALLCD") if name in history)
        rest = work - history["ALLSE"][-1] - spent
        found.append(abs(float(rest / work)))
    return max(found)


def mode_ratio(evidence: Evidence, element: str, stiffness: str = "1e6") -> float:
    """G_I/G_II of the fixed-ratio specimen, [0/0], from the tractions, at the moment of the figures.

    Both by Rice's integral around the process zone, minus the integral of traction times the slope of the separation
    along the interface. What single points have dissipated scatters by a quarter, as the crack runs in small jumps.
    """
    profile = moment(evidence.run("frmm", "0/0", element, stiffness))
    rates = []
    for traction, separation in (("TN", np.maximum(profile["SEPN"], 0.0)), ("TT", profile["SEPT"])):
        mean = 0.5 * (profile[traction][1:] + profile[traction][:-1])
        rates.append(-float(np.sum(mean * np.diff(separation))))
    return rates[0] / rates[1]


def theory_mode_ratio(evidence: Evidence, element: str, stiffness: str = "1e6") -> float:
    """G_I/G_II of the fixed-ratio specimen by corrected beam theory, for a crack up to the first bonded point."""
    profile = moment(evidence.run("frmm", "0/0", element, stiffness))
    return frmm_mode_ratio(ARMS, float(bonded_part(profile)["X"][0]))


def toughness(evidence: Evidence, problem: str, element: str, stiffness: str = "1e6") -> float:
    """Mean over failed points of the shares of both toughnesses that damage has dissipated, (11): 1."""
    profile = evidence.run(problem, "0/0", element, stiffness).profiles[-1]
    failed = profile["DAMAGE"] >= 1.0
    spent = profile["DISSI"] / TABLE_2.toughness_1 + profile["DISSII"] / TABLE_2.toughness_2
    return float(spent[failed].mean())


MEASURES: dict[str, Callable[..., float]] = {
    function.__name__: function
    for function in (
        *(variation, smallest_variation, variation_gain, damage_turns, theory_distance, theory_mean, methods_distance),
        methods_peak_difference,
        *(
            profile_distance,
            oscillation_place,
            peak_traction_ratio,
            local_error,
            closed_variation,
            closed_error,
            process_zone,
        ),
        *(iterations_ratio, energy_error, mode_ratio, toughness, comparator_distance, peak_difference),
        *(single_iterations, secant_reach),
    )
}
