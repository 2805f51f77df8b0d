# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Sensitivity to mesh, increments, stiffness, strength, sampling, integration rule, stabilisation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path

import numpy as np

from uel.delamination.oscillation import total_variation
from uel.model.arrays import FloatArray
from uel.output.pictures.plots import Curve, Panel, grid
from uel.paper.reproduce.advice import (
    SETTLED,
    Curves,
    Point,
    on_choice,
    on_increments,
    on_lengths,
    on_stiffness,
    on_strength,
)
from uel.paper.reproduce.cases import QUICK_SIZES, PaperCase
from uel.paper.reproduce.runs import Runs
from uel.paper.study.cases import STIFFNESSES
from uel.paper.study.rows import damage_variation

CONSISTENT = ("consistent", "inf")
METHODS = (("standard", "1e6"), ("paper", "1e8"), CONSISTENT)
"""Element and stiffness of the rows: the standard one at the stiffness that the paper would choose."""
VARIATION = "variation of the traction (MPa)"
"""Total variation of the loading mode's traction, process zone and bonded part, the largest of all moments."""
HEAD = (
    *("peak load (N), in small increments", "load at the end (N)", VARIATION, "toughness spent that turns back"),
    *("iterations", "cutbacks", "end"),
)


@dataclass(frozen=True, slots=True)
class Study:
    """Study of one parameter.

    title, parameter  heading, and the parameter with its unit
    variants  value as shown and case, by label of the curve
    number    values as numbers for the plot; None where they are names
    advise    what follows for a user, from the numbers of the curves
    """

    title: str
    parameter: str
    variants: dict[str, list[tuple[str, PaperCase]]]
    number: bool
    advise: Callable[[Curves], str]

    def cases(self) -> list[PaperCase]:
        """Return all its cases."""
        return [case for pairs in self.variants.values() for _, case in pairs]


def cases(*, coarse: bool) -> list[PaperCase]:
    """List the cases of all parameters, whose peak loads are compared."""
    return list(dict.fromkeys(case for study in studies(coarse=coarse) for case in study.cases()))


def _bases(problem: str, methods: Sequence[tuple[str, str]], *, coarse: bool) -> dict[str, PaperCase]:
    return {
        f"{problem.upper()}, {element} {stiffness}": PaperCase(problem, "0/0", element, stiffness, coarse=coarse)
        for element, stiffness in methods
    }


def _possible(element: str, *, coarse: bool) -> set[str]:
    """Return the stiffnesses of an element; at 1e12 the standard one takes thousands of iterations."""
    without = {"consistent": set[str](), "paper": {"inf"}, "standard": {"inf", "1e12"} if coarse else {"inf"}}
    return set(STIFFNESSES) - without[element]


def _divided(case: PaperCase, increments: int) -> PaperCase:
    return case if increments == case.increment_count else replace(case, increments=increments)


def studies(*, coarse: bool) -> list[Study]:
    """List all parameters; with `coarse`, around the coarse meshes, with fewer values, most in one specimen."""
    dcb, enf = (_bases(problem, METHODS, coarse=coarse) for problem in ("dcb", "enf"))
    sizes = {"dcb": (0.5, 0.25, 0.125, 0.0625), "enf": (1.0, 0.5, 0.25, 0.125)}
    kept = sizes | ({"dcb": (sizes["dcb"][1], QUICK_SIZES["dcb"])} if coarse else {})
    divisions = (25, 50) if coarse else (25, 50, 100, 200)
    factors = (0.1, 1.0, 10.0) if coarse else (0.1, 0.3, 1.0, 3.0, 10.0)
    both = dcb | enf
    shown = dcb if coarse else both
    return [
        Study(
            "Mesh",
            "length of the elements (mm)",
            {label: [(f"{s:.3g}", case.sized(s)) for s in kept[case.problem]] for label, case in shown.items()},
            number=True,
            advise=on_lengths,
        ),
        Study(
            "Increments",
            "number of increments",
            {label: [(str(n), _divided(case, n)) for n in divisions] for label, case in dcb.items()},
            number=True,
            advise=on_increments,
        ),
        Study(
            "Stiffness",
            "stiffness (N/mm³)",
            {
                f"{problem.upper()}, {element}": [
                    (name, PaperCase(problem, "0/0", element, name, coarse=coarse))
                    for name in STIFFNESSES
                    if name in _possible(element, coarse=coarse)
                ]
                for problem in ("dcb", "enf")
                for element in ("standard", "paper", "consistent")
            },
            number=False,
            advise=on_stiffness,
        ),
        Study(
            "Strength",
            "factor of both strengths",
            {
                label: [(f"{f:g}", replace(case, strength=f)) for f in (0.5, 1.0, 1.5)]
                for label, case in both.items()
                if "consistent" in label
            },
            number=True,
            advise=on_strength,
        ),
        Study(
            "Place where the bulk stress is taken",
            "sampling",
            {
                label: [(name, replace(case, sampling=k)) for k, name in enumerate(("middle", "face", "Gauss point"))]
                for label, case in shown.items()
                if "standard" not in label
            },
            number=False,
            advise=partial(on_choice, default="middle"),
        ),
        Study(
            "Integration rule",
            "rule",
            {
                label: [(name, replace(case, newton_cotes=k)) for k, name in ((False, "Gauss"), (True, "Newton-Cotes"))]
                for label, case in (shown | _bases("dcb", [("standard", "1e8")], coarse=coarse)).items()
            },
            number=False,
            advise=partial(on_choice, default="Gauss"),
        ),
        Study(
            "Stabilisation",
            "factor of beta by (21)",
            {
                label: [(f"{f:g}", replace(case, beta=f)) for f in factors]
                for label, case in shown.items()
                if "standard" not in label
            },
            number=True,
            advise=partial(on_choice, default="1"),
        ),
    ]


def text(study: Study, runs: Runs) -> str:
    """Sum up the numbers: advice, and how far the peak loads of a parameter's values lie apart, by curve."""
    curves = {
        label: [
            Point(
                value,
                row(runs, case)[HEAD[0]],
                runs[case].peak[0],
                row(runs, case)[VARIATION],
                float(runs[case].load[1] / runs[case].displacement[1]),
            )
            for value, case in pairs
            if not runs[case].entry.stopped
        ]
        for label, pairs in study.variants.items()
    }
    curves = {label: points for label, points in curves.items() if len(points) > 1}
    if not curves:
        return "Too few of these runs have finished for an advice."
    spread = "; ".join(
        f"{label} {max(point.peak for point in points) / min(point.peak for point in points) - 1.0:.1%}"
        for label, points in curves.items()
    )
    return f"{study.advise(curves)} Peak loads differ by {spread}."


@cache
def row(runs: Runs, case: PaperCase) -> dict[str, float]:
    """Return the numbers of a run: those of HEAD but the last."""
    run = runs[case]
    varies = max(total_variation(profile[name]) for profile in run.bonded for name in case.kind.modes)
    turns = max(damage_variation(profile["SOFTENED"]) for profile in run.profiles) - 1.0
    values = (runs.peak(case), float(run.load[-1]), varies, turns, run.entry.iterations, run.entry.cutbacks)
    return dict(zip(HEAD, values, strict=False))


def cells(runs: Runs, case: PaperCase) -> list[str]:
    """Format a line of the table."""
    run = runs[case]
    peak, last, varies, turns, iterations, cutbacks = row(runs, case).values()
    reached = run.displacement[-1] / run.case.displacement
    end = "finished" if not run.entry.stopped else f"stopped at {reached:.0%}"
    counts = f"{iterations:.0f}", f"{cutbacks:.0f}"
    return [f"{peak:.2f}", f"{last:.2f}", f"{varies:.1f}", f"{max(turns, 0.0):.4f}", *counts, end]


def draw(study: Study, runs: Runs, path: Path) -> Path:
    """Draw peak load and variation of the traction over the parameter: a row of panels for each specimen."""
    rows = []
    for problem in dict.fromkeys(case.problem for case in study.cases()):
        panels = []
        for name in (HEAD[0], VARIATION):
            curves = [
                Curve(
                    label.split(", ")[1],
                    [float(value) if study.number else value for value, _ in pairs],
                    [row(runs, case)[name] for _, case in pairs],
                    "marked",
                )
                for label, pairs in study.variants.items()
                if pairs[0][1].problem == problem
            ]
            heights = _wide([np.asarray(curve.y) for curve in curves]) if name == HEAD[0] else None
            title, words = f"{problem.upper()} [0/0]", name[0].upper() + name[1:]
            panels.append(Panel(title, curves, study.parameter, words, y_range=heights))
        rows.append(panels)
    return grid(rows, path)


def _wide(values: Sequence[FloatArray]) -> tuple[float, float]:
    """Return the range of the ordinate, wide enough that what counts as equal looks equal."""
    low, high = min(map(np.min, values)), max(map(np.max, values))
    half = max(0.55 * (high - low), 2.5 * SETTLED * high)
    return 0.5 * (low + high) - half, 0.5 * (low + high) + half
