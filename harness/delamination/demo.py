# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A double cantilever beam with the standard and the stabilised element: figures, and a table against beam theory."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from harness.delamination import measures
from harness.delamination.decks import FOLDER
from harness.delamination.materials import TABLE_2
from harness.delamination.specimens import ARMS, CRACK
from harness.delamination.theory import dcb_curve, dcb_load
from harness.errors import FAILURES, tell_failure
from harness.job import run
from harness.output import Result
from harness.output.plots import Curve, load_displacement, profiles

DECKS = {"standard": "dcb_u2_1e8.inp", "stabilised": "dcb_u4_1e8.inp"}
"""Stiffness 1e8 N/mm^3."""
# the process zone and the compressed stretch ahead of it (mm): behind the front of the damage, and before it
AROUND_FRONT = (2.0, 6.0)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the decks, write the figures, print the table; returns the exit code."""
    parser = argparse.ArgumentParser(
        description="Run a double cantilever beam, draw it, compare it with beam theory.",
        epilog="Exit code: 0 all runs have completed; 1 a run has not, and the last lines say why; 2 wrong usage.",
    )
    parser.add_argument("--output-dir", type=Path, default=Path("demo"), help="folder of all files written (demo)")
    known = sorted(path.name for path in (FOLDER / "dcb").glob("dcb_u*.inp"))
    parser.add_argument("decks", nargs="*", metavar="DECK", help=f"of {', '.join(known)} (the two at 1e8)")
    options = parser.parse_args(arguments)
    for deck in options.decks:
        if deck not in known:
            parser.error(f"no deck {deck}; expected one of {', '.join(known)}")
    folder: Path = options.output_dir
    try:
        compare(folder, {Path(deck).stem: deck for deck in options.decks} or DECKS, Console())
    except FAILURES as error:
        tell_failure(error)
        return 1
    return 0


def compare(folder: Path, decks: Mapping[str, str], console: Console) -> None:
    """Run the decks, given with a name for each, write the figures into the folder and print the table."""
    results = {}
    for name, deck in decks.items():
        console.print(f"{deck}: {name}, to 3 mm each arm", highlight=False)
        results[name] = run(FOLDER / "dcb" / deck, output_dir=folder, quiet=not console.is_terminal)
    figures = [draw_load(results, folder / "dcb_load.png"), draw_traction(results, folder / "dcb_traction.png")]
    console.print(summary(results))
    for figure in figures:
        console.print(f"figure: {figure}", highlight=False)


def draw_load(results: dict[str, Result], path: Path) -> Path:
    """Load over the displacement of one arm, with beam theory."""
    end = max(measures.displacement(result)[-1] for result in results.values())
    opening = np.linspace(0.0, end, 400)
    curves = [Curve("beam theory", opening, dcb_curve(ARMS, CRACK, TABLE_2.toughness_1, opening), "reference")]
    for name, result in results.items():
        # the history starts with the first increment
        x, y = (np.concatenate([[0.0], column]) for column in (measures.displacement(result), measures.load(result)))
        curves.append(Curve(name, x, y))
    return load_displacement(curves, path, x_label="Displacement of each arm [mm]")


def draw_traction(results: dict[str, Result], path: Path) -> Path:
    """Normal traction and damage around the front of the damage at the end of the run."""
    rows = {name: result.interface() for name, result in results.items()}
    front = max(float(profile["X"][profile["DAMAGE"] > 0.5].max(initial=CRACK)) for profile in rows.values())
    tractions, damages = [], []
    for name, profile in rows.items():
        near = (profile["X"] > front - AROUND_FRONT[0]) & (profile["X"] < front + AROUND_FRONT[1])
        tractions.append(Curve(name, profile["X"][near], profile["TN"][near]))
        damages.append(Curve(name, profile["X"][near], profile["DAMAGE"][near]))
    return profiles([tractions, damages], path, y_labels=["Normal traction [MPa]", "Damage"])


def summary(results: dict[str, Result]) -> Table:
    """Results of the runs and what they should be."""
    peak = dcb_load(ARMS, CRACK, TABLE_2.toughness_1)
    end = float(measures.beam_theory(next(iter(results.values())))[-1])
    rows: list[tuple[str, str, Callable[[Result], str]]] = [
        ("peak load, N", f"{peak:.2f} (sharp crack)", lambda r: f"{measures.peak_load(r):.2f}"),
        ("load at 3 mm, N", f"{end:.2f}", lambda r: f"{measures.final_load(r):.2f}"),
        ("largest distance after the peak", "", lambda r: f"{measures.theory_deviation(r):.2%}"),
        ("external work, N mm", "", lambda r: f"{r.history['ALLWK'][-1]:.2f}"),
        ("- stored energy, N mm", "", lambda r: f"{r.history['ALLSE'][-1]:.2f}"),
        ("- dissipated energy, N mm", "", lambda r: f"{measures.dissipated(r)[-1]:.2f}"),
        ("= missing, of the work", "0", lambda r: f"{measures.energy_error(r):.2%}"),
        ("crack growth, mm", "", lambda r: f"{measures.crack_growth(r)[-1]:.2f}"),
        ("dissipated / (G_Ic width growth), steady", "1", lambda r: f"{measures.dissipation_ratio(r):.4f}"),
        ("total variation of the traction, MPa", "", lambda r: f"{measures.traction_variation(r):.1f}"),
        ("increments, abandoned attempts", "", lambda r: f"{measures.increments(r)}, {measures.cutbacks(r)}"),
        ("iterations", "", lambda r: f"{measures.iterations(r)}"),
        ("time, s", "", lambda r: "" if r.seconds is None else f"{r.seconds:.1f}"),
    ]
    table = Table("double cantilever beam", "beam theory", *results)
    for label, theory, value in rows:
        table.add_row(label, theory, *(value(result) for result in results.values()))
    return table


if __name__ == "__main__":
    sys.exit(main())
