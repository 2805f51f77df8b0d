# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Our element and the built-in one in the [0/90] specimens: how the mesh brings their loads together.

The consistent law acts on a separation w of its own. What it leaves of the displacement jump g, Nitsche's gap
g - w = (T - <sigma>)/beta, works on the mean stress in the complete form, and its energy counts it: the law dissipates
what the specimen gives, and the loads of both elements agree on any mesh. What is left shrinks with the gap, that is
with 1/beta, which by (21) is the height of the quads.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from uel.paper.reproduce.cases import PaperCase
from uel.paper.reproduce.curves import curve_distance
from uel.paper.reproduce.runs import Run, Runs

MESHES = ((4, 1.0), (4, 10.0), (8, 1.0), (8, 3.0))
"""Rows of quads over the height of an arm and factor of beta, of the curves that are compared."""
CURVES_TEXT = (
    "Standard and consistent element with the criterion of Benzeggagh and Kenane, 1e6 N/mm³, over the whole load "
    "curve, snaps included, and up to 98 % of the displacement at the peak. Distances are over the peak load. Finer "
    "quads and a larger beta make the gap smaller that Nitsche's method leaves between unlike plies."
)
CURVES_HEAD = (
    *(
        "specimen",
        "rows an arm",
        "factor of beta",
        "standard: peak load (N)",
        "consistent: peak load (N)",
        "difference",
    ),
    *("largest distance of the curves", "before the peak"),
)
STRETCH = (4.0, 7.9)
"""Displacements of steady growth (mm)."""
GROWN = 40.0
"""Points behind this place have failed in steady growth (mm)."""
TEXT = (
    "Standard and consistent element with the criterion of Benzeggagh and Kenane, 1e6 N/mm³, in steady growth. The gap "
    "(T - <sigma>)/beta between the separation that the law sees and the displacement jump does work; the complete "
    "form has it in its energy, so that the law dissipates what the specimen gives. Last column: load ~ (energy "
    "release rate)^(3/4) at equal displacement, from the energies alone."
)
HEAD = (
    *("elements (mm)", "rows an arm", "factor of beta", "weights"),
    *("standard: mean load (N)", "consistent: mean load (N)", "difference"),
    *(
        "energy given over dissipated, standard",
        "consistent",
        "dissipated at failed points (N/mm), standard",
        "consistent",
    ),
    "difference by these energies",
)


@dataclass(frozen=True, slots=True)
class Steady:
    """A run in steady growth.

    load   mean over STRETCH (N)
    share  energy that the specimen gives, work less stored energy, over what the interface dissipates
    spent  energy dissipated at a failed point, the mean (N/mm)
    """

    load: float
    share: float
    spent: float


def curves(problem: str, *, coarse: bool) -> list[tuple[PaperCase, PaperCase]]:
    """Return pairs of the standard and the consistent element on finer quads and with a larger beta.

    With `coarse`, on one mesh.
    """
    base = PaperCase(problem, "0/90", "standard_bk", "1e6", coarse=coarse)
    built_in = [(replace(base, rows=rows), factor) for rows, factor in (MESHES[:1] if coarse else MESHES)]
    return [(case, replace(case, element="consistent_bk", beta=factor)) for case, factor in built_in]


def curve_rows(runs: Runs, problem: str, *, coarse: bool) -> list[list[str]]:
    """Format the lines of the table of the curves."""
    lines = []
    for built_in, case in curves(problem, coarse=coarse):
        one, other = runs[built_in], runs[case]
        peaks = one.peak[0], other.peak[0]
        before = 0.98 * min(one.peak[1], other.peak[1])
        lines.append(
            [
                *(problem.upper(), str(case.rows), f"{case.beta:g}"),
                *(f"{peaks[0]:.2f}", f"{peaks[1]:.2f}", f"{peaks[1] / peaks[0] - 1.0:+.2%}"),
                *(f"{curve_distance(other, one, last):.2%}" for last in (np.inf, before)),
            ]
        )
    return lines


def pairs(*, coarse: bool) -> list[tuple[PaperCase, PaperCase]]:
    """Return pairs of the standard and the consistent element on equal meshes; the latter with a larger beta and equal
    weights too.

    With `coarse`, on one mesh with beta and weights by (21) and (22).
    """
    base = PaperCase("dcb", "0/90", "standard_bk", "1e6", coarse=coarse)
    ours = replace(base, element="consistent_bk")
    if coarse:
        return [(base, ours)]
    size = base.element_size
    built_in = [replace(base, rows=rows).sized(s) for s, rows in ((2.0 * size, 4), (size, 4), (size, 8), (size, 16))]
    # beta is given with the weight, so that it stays that of (21) with the weights (22)
    variants = [replace(ours, beta=10.0), replace(ours, beta=1.0001, weight=0.5)]
    return [*((case, replace(case, element=ours.element)) for case in built_in), *((base, case) for case in variants)]


def steady(run: Run) -> Steady:
    """Return the loads and energies of a run."""
    history = run.history
    stretch = np.linspace(*STRETCH, 200)
    given = history["ALLWK"] - history["ALLSE"]
    # ALLDMD and ALLCD are those of the built-in elements
    spent = np.sum([history[name] for name in ("ALLPD", "ALLVD", "ALLDMD", "ALLCD") if name in history], axis=0)
    ends = [float(np.interp(STRETCH[k], run.displacement[1:], values)) for values in (given, spent) for k in (0, 1)]
    profile = run.profiles[-1]
    failed = (profile["DAMAGE"] >= 1.0) & (profile["X"] > GROWN)
    return Steady(
        load=float(np.interp(stretch, run.displacement, run.load).mean()),
        share=(ends[1] - ends[0]) / (ends[3] - ends[2]),
        spent=float((profile["DISSI"] + profile["DISSII"])[failed].mean()),
    )


def expected(ours: Steady, built_in: Steady) -> float:
    """Return the relative difference of the loads that the energies explain.

    At equal displacements the load of a slender specimen goes with the energy release rate to the power 3/4: with
    displacement ~ P a^3 and G ~ P^2 a^2, P^4 ~ G^3/displacement^2.
    """
    return float((ours.share * ours.spent / (built_in.share * built_in.spent)) ** 0.75 - 1.0)


def load_difference(ours: Steady, built_in: Steady) -> float:
    """Return the relative difference of the mean loads in steady growth."""
    return ours.load / built_in.load - 1.0


def rows(runs: Runs, *, coarse: bool) -> list[list[str]]:
    """Format the lines of the table."""
    lines = []
    for built_in, case in pairs(coarse=coarse):
        one, other = steady(runs[built_in]), steady(runs[case])
        lines.append(
            [
                *(f"{case.element_size:.4g}", str(case.rows), f"{case.beta:.3g}"),
                "equal" if case.weight else "(22)",
                *(f"{one.load:.2f}", f"{other.load:.2f}", f"{load_difference(other, one):+.2%}"),
                *(f"{one.share:.4f}", f"{other.share:.4f}", f"{one.spent:.4f}", f"{other.spent:.4f}"),
                f"{expected(other, one):+.2%}",
            ]
        )
    return lines
