# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The figures of the paper that show results: 4, 6, 8 to 11, 13 to 16, 18 to 20. Figure 2 is `uel law`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from uel.delamination.beams import RIGID_ROOT, growth
from uel.delamination.law_report import Exploration, explore
from uel.output.pictures.plots import Curve, Panel, grid
from uel.paper.patches import COLLINEAR, PLIES
from uel.paper.reproduce.cases import AROUND, ELEMENTS, LAYUPS, MOMENTS, SHOWN, PaperCase
from uel.paper.reproduce.patch_cases import METHODS, NODES, PatchCase
from uel.paper.reproduce.runs import Profile, Run, Runs

X = "$X_1$ [mm]"
TRACTIONS = {"TN": "Normal traction [MPa]", "TT": "Tangential traction [MPa]", "LOST": "Damage $d$ of (9)"}
CLOSE = {"dcb": (0.0, 4.0), "enf": (-4.0, 4.0), "frmm": (-3.0, 3.0)}
"""Ranges of the zooms (mm)."""


def front(profile: Profile) -> float:
    """Return the place of the front: the last point with a damage of one half or more, or the first point (mm)."""
    damaged = profile["LOST"] >= 0.5
    return float(profile["X"][damaged].max()) if damaged.any() else float(profile["X"].min())


def draw_law(folder: Path) -> Path:
    """Draw figure 2: both tractions over both separations, at the softest of the stiffnesses, where the rise shows."""
    properties = ["ALPHAN=1e4", "ALPHAT=1e4"]
    asked = Exploration(properties, surface=True, job="figure_02", output_dir=folder, units=("mm", "MPa"))
    _, files = explore(asked)
    return files[-1]


def draw_horizontal_patch(runs: Runs, folder: Path) -> Path:
    """Draw figure 4: normal traction along a straight and a perturbed horizontal interface."""
    cases = [PatchCase("horizontal", "0/0", "standard", moved) for moved in (False, True)]
    return grid(
        [[replace(_patch_panel(runs, case), y_range=(-1500.0, -500.0)) for case in cases]], folder / "figure_04.png"
    )


def draw_inclined_patch(runs: Runs, folder: Path) -> Path:
    """Draw figure 6: normal traction along the inclined interface, on straight, rounded and moved nodes."""
    rows = [[_patch_panel(runs, PatchCase("inclined", p, "standard", *nodes)) for p in PLIES] for nodes in NODES]
    return grid(rows, folder / "figure_06.png", share_y=True)


def _patch_panel(runs: Runs, case: PatchCase) -> Panel:
    curves = []
    for element in METHODS:
        run = runs.patch(replace(case, element=element))
        curves.append(Curve(element, run.profile["X"], run.traction, "marked"))
    straight = "straight interface" if case.decimals == COLLINEAR else f"coordinates to {case.decimals} decimals"
    return Panel(f"[{case.layup}], {'perturbed interface' if case.moved else straight}", curves, X, TRACTIONS["TN"])


def draw_loads(runs: Runs, base: PaperCase, path: Path) -> Path:
    """Draw figures 8, 13, 18: load over displacement; a row for each layup, a column for each element.

    Theory stands below [0/0], COH2D4 with its own criterion and, where it has been run, beside all elements.
    """
    rows = []
    for layup in LAYUPS:
        compared = [*_theory(base.problem)] if layup == "0/0" else []
        built_in = replace(base, layup=layup, element="COH2D4", stiffness="1e6")
        if built_in in runs:
            compared.append(_sparse("COH2D4 1e6, its own criterion", runs[built_in]))
        row = []
        for element in ELEMENTS:
            chosen = [
                (stiffness, runs[replace(base, layup=layup, element=element, stiffness=stiffness)])
                for stiffness in SHOWN
            ]
            curves = [Curve(f"{stiffness} N/mm³", run.displacement, run.load) for stiffness, run in chosen]
            row.append(Panel(f"[{layup}], {element}", [*curves, *compared], "Displacement [mm]", "Load [N]"))
        rows.append(row)
    return grid(rows, path, share_y=True)


def _sparse(label: str, run: Run) -> Curve:
    """Thin a load curve to some 25 points, the peak among them."""
    chosen = np.union1d(np.arange(0, len(run.load), max(1, len(run.load) // 25)), run.peak_index)
    return Curve(label, run.displacement[chosen], run.load[chosen], "points")


def _theory(problem: str) -> list[Curve]:
    corrected, plain = growth(problem), growth(problem, RIGID_ROOT)
    return [
        Curve("corrected beam theory", *corrected.with_origin(), "reference"),
        Curve("LEFM, no end correction", *plain.with_origin(), "reference"),
    ]


def draw_profiles(runs: Runs, base: PaperCase, names: Sequence[str], path: Path) -> Path:
    """Draw figures 9, 11, 14, 16, 19, 20: tractions and damage by stiffness; a column for each element."""
    moment = MOMENTS[base.problem, base.layup]
    middle = front(runs[replace(base, element="standard", stiffness="1e6")].at(moment))
    rows = []
    for name in names:
        row = []
        for element in ELEMENTS:
            profiles = {
                stiffness: runs[replace(base, element=element, stiffness=stiffness)].at(moment) for stiffness in SHOWN
            }
            curves = [_curve(f"{stiffness} N/mm³", profile, name) for stiffness, profile in profiles.items()]
            row.append(_profile_panel(element, curves, name, middle, AROUND[base.problem]))
        rows.append(row)
    return grid(rows, path, share_y=True)


def draw_perturbed(runs: Runs, base: PaperCase, name: str, path: Path) -> Path:
    """Draw figures 10, 15: traction on the perturbed mesh; below, close to the front."""
    moment = MOMENTS[base.problem, base.layup]
    rows: list[list[Panel]] = [[], []]
    middle = front(runs[replace(base, element="standard")].at(moment))
    for element in ELEMENTS:
        profile = runs[replace(base, element=element, perturbed=True)].at(moment)
        plain = runs[replace(base, element=element)].at(moment)
        curves = [_curve("perturbed mesh", profile, name), _curve("structured mesh", plain, name)]
        for row, stretch in zip(rows, (AROUND, CLOSE), strict=True):
            row.append(_profile_panel(element, curves, name, middle, stretch[base.problem]))
    return grid(rows, path, share_y=True)


def _curve(label: str, profile: Profile, name: str) -> Curve:
    return Curve(label, profile["X"], profile[name])


def _profile_panel(
    title: str, curves: Sequence[Curve], name: str, middle: float, stretch: tuple[float, float]
) -> Panel:
    low, high = middle + stretch[0], middle + stretch[1]
    # points outside the range shown would stretch the ordinates
    cut = []
    for curve in curves:
        x, y = np.asarray(curve.x), np.asarray(curve.y)
        inside = (x >= low) & (x <= high)
        cut.append(replace(curve, x=x[inside], y=y[inside]))
    return Panel(title, cut, X, TRACTIONS[name], (low, high))


def problem_figures(runs: Runs, problem: str, *, coarse: bool, folder: Path) -> dict[str, Path]:
    """Draw all result figures of a specimen, by the paper's numbers."""
    base = PaperCase(problem, "0/0", "paper", "1e8", coarse=coarse)
    cross = replace(base, layup="0/90")

    def at(number: int) -> Path:
        return folder / f"figure_{number:02d}.png"

    drawn: dict[str, dict[int, Callable[[], Path]]] = {
        "dcb": {
            8: lambda: draw_loads(runs, base, at(8)),
            9: lambda: draw_profiles(runs, base, ("TN", "LOST"), at(9)),
            10: lambda: draw_perturbed(runs, base, "TN", at(10)),
            11: lambda: draw_profiles(runs, cross, ("TN", "LOST"), at(11)),
        },
        "enf": {
            13: lambda: draw_loads(runs, base, at(13)),
            14: lambda: draw_profiles(runs, base, ("TT", "LOST"), at(14)),
            15: lambda: draw_perturbed(runs, base, "TT", at(15)),
            16: lambda: draw_profiles(runs, cross, ("TT", "LOST"), at(16)),
        },
        "frmm": {
            18: lambda: draw_loads(runs, base, at(18)),
            19: lambda: draw_profiles(runs, base, ("TN", "TT"), at(19)),
            20: lambda: draw_profiles(runs, cross, ("TN", "TT"), at(20)),
        },
    }
    return {str(number): draw() for number, draw in drawn[problem].items()}
