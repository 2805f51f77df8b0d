# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel fit` and `uel fit-sn`."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from uel.cli.run_options import add_run_options, settings_of
from uel.cli.values import NOT_NEGATIVE, positive

if TYPE_CHECKING:
    from uel.fit.estimate import Fit


def add_fit(fit: argparse.ArgumentParser) -> None:
    """Add the options of `uel fit`."""
    fit.description = (
        "Runs the deck with other values until its curve is the measured one, in the sense of least squares. An "
        "interrupted fit resumes where it stopped."
    )
    fit.epilog = (
        "Written: DECK_fit.csv with values, confidence intervals and correlations, DECK_fit_curve.csv and DECK_fit.png "
        "with the curves and their derivatives. "
        "Exit code: 0 the search has converged; 1 it has not, or a run cannot be compared; 2 wrong usage; 3 it has, "
        "but with a value at its bound or residuals that are not noise: the column `note` of DECK_fit.csv says which."
    )
    fit.add_argument("deck", type=Path, metavar="DECK.inp", help="deck of the model")
    fit.add_argument(
        "curve",
        type=Path,
        metavar="CURVE.csv",
        help="two columns, whose names are those of the history: x, which rises, y; or a Paris line, G and RATE: "
        "energy release rate and growth per cycle, for a deck in the plane with FATIGUE",
    )
    fit.add_argument(
        "variables",
        nargs="+",
        metavar="NAME=LOW:HIGH",
        help="parameters of the deck's *PARAMETER, or properties of the project's interface elements, with "
        "bounds; NAME=LOW:START:HIGH chooses the start",
    )
    for axis in "xy":
        fit.add_argument(
            f"--{axis}", metavar="COLUMN", help=f"column of the history that is {axis}, such as U2[TOP], 2*U2[TOP]"
        )
    fit.add_argument(
        "--after",
        type=NOT_NEGATIVE,
        metavar="LENGTH",
        help="growth of the crack that is left out of a Paris line, while its process zone forms (0)",
    )
    fit.add_argument(
        "-o", "--output-dir", type=Path, default=Path("fit"), metavar="DIR", help="folder of the output (fit)"
    )
    fit.add_argument("--runs", type=positive, default=40, metavar="N", help="largest number of runs (40)")
    fit.add_argument("--cpus", type=positive, metavar="N", help="runs at a time (one for each core)")
    fit.add_argument("--quiet", action="store_true", help="print errors only")
    fit.set_defaults(function=fit_parameters, of_runs=add_run_options(fit))


def fit_parameters(options: argparse.Namespace) -> int:
    """Run `uel fit`."""
    from uel.fit.command import fit  # noqa: PLC0415

    result = fit(
        options.deck,
        options.curve,
        options.variables,
        options.output_dir,
        settings_of(options),
        x=options.x,
        y=options.y,
        after=options.after,
        limit=options.runs,
        workers=options.cpus,
        quiet=options.quiet,
    )
    return _code(result)


def add_fit_sn(fit: argparse.ArgumentParser) -> None:
    """Add the options of `uel fit-sn`."""
    fit.description = (
        "Fits ENDURANCE, BRITTLENESS and EXPONENT of FATIGUE to measured lives under a constant traction, in the "
        "logarithm, without a deck."
    )
    fit.epilog = (
        "Written: POINTS_fit.csv with values, confidence intervals and correlations, POINTS_fit_curve.csv and "
        "POINTS_fit.png with lives and their derivatives. Exit codes are those of `uel fit`."
    )
    fit.add_argument(
        "points",
        type=Path,
        metavar="POINTS.csv",
        help="columns S (greatest traction over strength) and CYCLES to failure; and R (load ratio, 0 without), B "
        "(share of mode II, 0 without), RUNOUT (1 where the test ended without failure)",
    )
    fit.add_argument(
        "variables",
        nargs="+",
        metavar="NAME=LOW:HIGH",
        help="of ENDURANCE, BRITTLENESS and EXPONENT, those that are fitted, with bounds; others are as by default",
    )
    fit.add_argument(
        "-o", "--output-dir", type=Path, default=Path("fit"), metavar="DIR", help="folder of the output (fit)"
    )
    fit.add_argument("--quiet", action="store_true", help="print errors only")
    fit.set_defaults(function=fit_lives)


def fit_lives(options: argparse.Namespace) -> int:
    """Run `uel fit-sn`."""
    from uel.fit.command import fit_sn  # noqa: PLC0415

    return _code(fit_sn(options.points, options.variables, options.output_dir, quiet=options.quiet))


def _code(result: Fit) -> int:
    """Return the exit code of a fit."""
    return 0 if result.reliable else 3 if result.converged else 1
