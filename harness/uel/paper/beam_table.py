# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Double cantilever beams in a table, with beam theory: `python -m uel.paper.beam_table DECK ...`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table

from uel.delamination.materials import TABLE_2
from uel.delamination.specimens import ARMS, CRACK
from uel.delamination.theory import dcb_load
from uel.errors import FAILURES, tell_failure
from uel.output import Result
from uel.paper import measures
from uel.paper.decks import FOLDER
from uel.running.job import run

SHARP_PEAK = dcb_load(ARMS, CRACK, TABLE_2.toughness_1)
"""Load (N) at which a sharp crack grows: a process zone takes a few per cent off."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the decks and print the table; returns the exit code."""
    parser = argparse.ArgumentParser(
        description="Run decks of abaqus_inputs/dcb and compare them with beam theory.",
        epilog="Exit code: 0 all runs have completed; 1 a run has not, and the last lines say why; 2 wrong usage.",
    )
    parser.add_argument("--output-dir", type=Path, default=Path(), help="folder of the jobs' files (the current one)")
    known = sorted(path.name for path in (FOLDER / "dcb").glob("dcb_u*.inp"))
    parser.add_argument("decks", nargs="+", metavar="DECK", help=f"of {', '.join(known)}")
    options = parser.parse_args(arguments)
    for deck in options.decks:
        if deck not in known:
            parser.error(f"no deck {deck}; expected one of {', '.join(known)}")
    console, results = Console(), {}
    try:
        for deck in options.decks:
            folder = options.output_dir
            results[Path(deck).stem] = run(FOLDER / "dcb" / deck, output_dir=folder, quiet=not console.is_terminal)
    except FAILURES as error:
        tell_failure(error)
        return 1
    console.print(summary(results))
    return 0


def summary(results: Mapping[str, Result]) -> Table:
    """Return the results of runs of the double cantilever beam [0/0], by name, and what they should be."""
    first = next(iter(results.values()))
    end, theory = measures.final_displacement(first), float(measures.beam_theory(first)[-1])
    rows: list[tuple[str, str, Callable[[Result], str]]] = [
        ("peak load, N", f"{SHARP_PEAK:.2f}", lambda r: f"{measures.peak_load(r):.2f}"),
        (f"load at {end:.3g} mm, N", f"{theory:.2f}", lambda r: f"{measures.final_load(r):.2f}"),
        ("off after the peak", "", lambda r: f"{measures.theory_deviation(r):.2%}"),
        ("work, N mm", "", lambda r: f"{r.history['ALLWK'][-1]:.2f}"),
        ("- stored, N mm", "", lambda r: f"{r.history['ALLSE'][-1]:.2f}"),
        ("- dissipated, N mm", "", lambda r: f"{measures.dissipated(r)[-1]:.2f}"),
        ("= missing, of the work", "0", lambda r: f"{measures.energy_error(r):.2%}"),
        ("crack growth, mm", "", lambda r: f"{measures.crack_growth(r)[-1]:.2f}"),
        ("dissipated/(G_Ic growth)", "1", _steady),
        ("normal traction, MPa", "", lambda r: _range(r, "TN")),
        ("- total variation, MPa", "", lambda r: f"{measures.traction_variation(r):.1f}"),
        ("shear traction, MPa", "", lambda r: _range(r, "TT")),
        ("- total variation, MPa", "", lambda r: f"{measures.shear_variation(r):.1f}"),
        ("increments, abandoned", "", lambda r: f"{measures.increments(r)}, {measures.cutbacks(r)}"),
        ("iterations", "", lambda r: f"{measures.iterations(r)}"),
        ("time, s", "", lambda r: "" if r.seconds is None else f"{r.seconds:.1f}"),
    ]
    table = Table("double cantilever beam", "beam theory", *results)
    for label, expected, value in rows:
        table.add_row(label, expected, *(value(result) for result in results.values()))
    return table


def _steady(result: Result) -> str:
    """Format the `dissipation_ratio`, which a run that ended before the crack grew does not have."""
    load = measures.load(result)
    return f"{measures.dissipation_ratio(result):.4f}" if load[-1] < load.max() else ""


def _range(result: Result, column: str) -> str:
    """Return the smallest and largest value along the interface at the end."""
    values = result.interface()[column]
    return f"{values.min():.0f} to {values.max():.0f}"


if __name__ == "__main__":
    sys.exit(main())
