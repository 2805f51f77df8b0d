# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The numbers that decide on the paper's statements, by the names that statements.toml gives them.

Each function takes what was run (`Evidence`) and the arguments of a statement, and gives one number. Where a statement
speaks of several runs the number is the one that is worst for it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from uel.delamination.materials import TABLE_2
from uel.delamination.oscillation import total_variation
from uel.delamination.specimens import ARMS
from uel.delamination.theory import frmm_mode_ratio
from uel.model.arrays import FloatArray
from uel.paper.measures import rice_ratio
from uel.paper.reproduce.cases import AROUND, BK, MOMENTS, PROBLEMS, PaperCase
from uel.paper.reproduce.runs import Profile, Run, Runs
from uel.paper.study.rows import STRENGTHS, bonded_part, damage_variation


@dataclass(frozen=True, slots=True)
class Evidence:
    """Runs on which the findings rest, and whether they are on the coarser meshes."""

    runs: Runs
    coarse: bool

    def run(self, problem: str, layup: str, element: str, stiffness: str, *, perturbed: bool = False) -> Run:
        """Run of a delamination test."""
        return self.runs[PaperCase(problem, layup, element, stiffness, perturbed, self.coarse)]

    def peak(self, case: PaperCase) -> float:
        """Return the peak load (N) of a case on these meshes, in small increments where the command has run these."""
        return self.runs.peak(replace(case, coarse=self.coarse))

    def case(self, case: PaperCase) -> Run:
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
    """Return the total variation of a traction over that of the consistent element on the structured mesh, the largest.

    1 is a profile that rises and falls as the consistent element's, 1.05 one that adds a twentieth of ups and downs.

    Parameters
    ----------
    problem, layup, element, tractions, stiffnesses, perturbed
        Runs and tractions; stiffnesses are compared each with its own.
    ever
        At every moment of which there is a profile, in place of that of the figures.
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
    """Return the smallest among the tractions of `variation` at 1e8: all of them oscillate."""
    return min(variation(evidence, problem, layup, element, [name], ever=ever) for name in tractions)


def variation_gain(
    evidence: Evidence, problem: str, layup: str, tractions: Sequence[str], *, ever: bool = False
) -> float:
    """Return the variation that the paper's element adds on the perturbed mesh, over what the standard one adds.

    At 1e8. Real variation, which bumps cause, is in both.
    """
    paper, standard = (
        variation(evidence, problem, layup, element, tractions, perturbed=True, ever=ever) - 1.0
        for element in ("paper", "standard")
    )
    return max(paper, 0.0) / standard if standard > 0.0 else np.inf


def damage_turns(
    evidence: Evidence,
    problem: str,
    layup: str,
    element: str,
    stiffness: str = "1e8",
    *,
    perturbed: bool = False,
    ever: bool = False,
    whole: bool = False,
) -> float:
    """Return the largest departure of the damage (9) from a steady fall: variation over largest value, less 1.

    Without the sign: damage that turns back varies more, damage that nowhere falls to 0 varies less. Up to as far ahead
    of the failed part as the figures show, or along the `whole` interface. `perturbed` and `ever` as above.
    """
    run = evidence.run(problem, layup, element, stiffness, perturbed=perturbed)
    profiles = run.profiles if ever else [moment(run)]
    damages = [profile["LOST"] if whole else damage_near_tip(profile, problem) for profile in profiles]
    return max(abs(damage_variation(damage) - 1.0) for damage in damages)


def damage_near_tip(profile: Profile, problem: str) -> FloatArray:
    """Return the damage (9) up to the end of the figures' stretch, counted from the first point that has not failed."""
    tip = float(bonded_part(profile)["X"][0])
    return profile["LOST"][profile["X"] <= tip + AROUND[problem][1]]


def profile_distance(
    evidence: Evidence, problem: str, layup: str, elements: Sequence[str], traction: str, pair: Sequence[str]
) -> float:
    """Return the largest distance of a traction's profiles at two stiffnesses in the figures, over the strength."""
    found = []
    for element in elements:
        one, other = (moment(evidence.run(problem, layup, element, stiffness)) for stiffness in pair)
        other_there = np.interp(one["X"], other["X"], other[traction])
        found.append(float(np.abs(one[traction] - other_there).max()) / STRENGTHS[traction])
    return max(found)


def moment(run: Run) -> Profile:
    """Return the profile at the moment that the figures show."""
    return run.at(MOMENTS[run.case.problem, run.case.layup])


def oscillation_place(evidence: Evidence, problem: str, layup: str, element: str) -> float:
    """Return the distance (mm) of the standard element's worst kink in normal traction from its change of sign.

    The kink is the largest change between neighbouring points of the distance from the paper's element's profile.
    """
    profile = moment(evidence.run(problem, layup, element, "1e8"))
    smooth = moment(evidence.run(problem, layup, "consistent", "1e8"))
    rest = profile["TN"] - np.interp(profile["X"], smooth["X"], smooth["TN"])
    kink = profile["X"][1:][np.abs(np.diff(rest)).argmax()]
    return float(abs(kink - sign_change(smooth)))


def sign_change(profile: Profile) -> float:
    """Return the place where the normal traction turns from tension ahead of the crack to compression (mm)."""
    peak = int(profile["TN"].argmax())
    return float(profile["X"][peak + int(np.argmax(profile["TN"][peak:] < 0.0))])


def peak_traction_ratio(
    evidence: Evidence, problem: str, layup: str, elements: Sequence[str], pair: Sequence[str]
) -> float:
    """Return the largest tangential traction at the first stiffness over that at the second, as in the figures."""
    found = []
    for element in elements:
        low, high = (
            float(np.abs(moment(evidence.run(problem, layup, element, stiffness))["TT"]).max()) for stiffness in pair
        )
        found.append(low / high)
    return max(found)


def local_error(evidence: Evidence, problem: str, element: str, traction: str, *, ever: bool = False) -> float:
    """Return a traction's largest distance from the consistent element's over strength, ahead of the process zone.

    Both on the perturbed mesh, whose bumps cause variation that is real. `ever` as above.
    """
    found = []
    pairs = (evidence.run(problem, "0/0", name, "1e8", perturbed=True) for name in (element, "consistent"))
    for rough, smooth in zip(*(run.profiles if ever else [moment(run)] for run in pairs), strict=False):
        start = float(smooth["X"][smooth["LOST"] > 0.0].max(initial=0.0))
        bonded = (rough["LOST"] < 0.5) & (rough["X"] > start)
        rest = rough[traction] - np.interp(rough["X"], smooth["X"], smooth[traction])
        found.append(float(np.abs(rest[bonded]).max(initial=0.0)) / STRENGTHS[traction])
    return max(found)


def closed_stretch(smooth: Profile) -> tuple[float, float]:
    """Find where the normal traction is compressive ahead of the crack, to a hundredth of its largest pressure (mm)."""
    pressed = smooth["X"][smooth["TN"] < 0.01 * smooth["TN"].min()]
    return sign_change(smooth), float(pressed.max())


def closed_variation(evidence: Evidence, problem: str, element: str) -> float:
    """Return the `variation` of the normal traction on the perturbed mesh at 1e8 where it is compressive, [0/0]."""
    smooth = moment(evidence.run(problem, "0/0", "consistent", "1e8"))
    rough = moment(evidence.run(problem, "0/0", element, "1e8", perturbed=True))
    low, high = closed_stretch(smooth)
    one, other = (
        total_variation(profile["TN"][(profile["X"] >= low) & (profile["X"] <= high)]) for profile in (rough, smooth)
    )
    return one / other


def closed_error(evidence: Evidence, problem: str, element: str) -> float:
    """Return the mean distance of the normal traction, perturbed from structured mesh, over the strength.

    At 1e8, in the compressive stretch of the consistent element, which is the reference too.
    """
    smooth = moment(evidence.run(problem, "0/0", "consistent", "1e8"))
    rough = moment(evidence.run(problem, "0/0", element, "1e8", perturbed=True))
    low, high = closed_stretch(smooth)
    inside = (rough["X"] >= low) & (rough["X"] <= high)
    rest = rough["TN"] - np.interp(rough["X"], smooth["X"], smooth["TN"])
    return float(np.abs(rest[inside]).mean()) / STRENGTHS["TN"]


def process_zone(evidence: Evidence) -> float:
    """Count elements in the process zone (0 < damage < 1), fewest of the specimens, [0/0], 1e6, paper's element."""
    counts = []
    for problem in PROBLEMS:
        damage = moment(evidence.run(problem, "0/0", "paper", "1e6"))["LOST"]
        counts.append(float(np.count_nonzero((damage > 0.0) & (damage < 1.0))) / 2.0)
    return min(counts)


def mode_ratio(evidence: Evidence, element: str, stiffness: str = "1e6", problem: str = "frmm") -> float:
    """Return G_I/G_II of a fixed-ratio specimen, [0/0], from the tractions, at the moment of the figures."""
    return rice_ratio(moment(evidence.run(problem, "0/0", element, stiffness)))


def crack_length(evidence: Evidence, element: str, stiffness: str = "1e6", problem: str = "frmm") -> float:
    """Return the length (mm) of the crack up to the first bonded point, [0/0], at the moment of the figures."""
    return float(bonded_part(moment(evidence.run(problem, "0/0", element, stiffness)))["X"][0])


def theory_mode_ratio(evidence: Evidence, element: str, stiffness: str = "1e6", problem: str = "frmm") -> float:
    """Return G_I/G_II of a fixed-ratio specimen by corrected beam theory, for a crack of `crack_length`."""
    return frmm_mode_ratio(ARMS, crack_length(evidence, element, stiffness, problem))


def mode_two_share(evidence: Evidence, problem: str, layup: str, element: str, stiffness: str = "1e6") -> float:
    """Return the share of mode II in the energy that failed points have dissipated, at the end."""
    profile = evidence.run(problem, layup, element, stiffness).profiles[-1]
    failed = profile["DAMAGE"] >= 1.0
    one, two = (float(profile[name][failed].sum()) for name in ("DISSI", "DISSII"))
    return two / (one + two)


def criteria_apart(evidence: Evidence, problem: str, layup: str, element: str) -> float:
    """Return the toughness of Benzeggagh and Kenane at that share by the runs' exponent, over (11), less 1."""
    share = mode_two_share(evidence, problem, layup, element)
    one, two = TABLE_2.toughness_1, TABLE_2.toughness_2
    by_power = one + (two - one) * float(share**BK)
    return by_power * ((1.0 - share) / one + share / two) - 1.0


def toughness(evidence: Evidence, problem: str, element: str, stiffness: str = "1e6") -> float:
    """Return the mean over failed points of the shares of both toughnesses that damage has dissipated, (11): 1."""
    profile = evidence.run(problem, "0/0", element, stiffness).profiles[-1]
    failed = profile["DAMAGE"] >= 1.0
    spent = profile["DISSI"] / TABLE_2.toughness_1 + profile["DISSII"] / TABLE_2.toughness_2
    return float(spent[failed].mean())


MEASURES: dict[str, Callable[..., float]] = {
    function.__name__: function
    for function in (
        *(variation, smallest_variation, variation_gain, damage_turns, profile_distance, oscillation_place),
        *(peak_traction_ratio, local_error, closed_variation, closed_error, process_zone, mode_ratio, toughness),
        *(mode_two_share, criteria_apart),
    )
}
